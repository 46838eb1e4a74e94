//! A scene without the command: run, then handed on as glTF, CSV and SVG, swept, and solved for a
//! wish.
//!
//! `cargo run --example scene` writes its files into a folder for temporary ones, and checks what
//! it says.

use std::error::Error;
use std::fs;

use saltus_motion::{Format, Frames};
use saltus_plot::record;
use saltus_scene::solve::{Clock, Wish, solve};
use saltus_scene::sweep::{RowFormat, Sweep};
use saltus_scene::vary::Vary;
use saltus_scene::{Kind, Run, Sampling, Scene, Staging};

const DROP: &[u8] = b"gravity = 9.81\nrestitution = 0.8\nball = { height = '1 m', radius = '2 cm' }\n";

fn main() -> Result<(), Box<dyn Error>> {
    let run = Scene::parse("drop.toml", DROP)?.plan()?.run()?;
    let stage = Staging::new(Frames::new("24".parse()?)).stage(&run)?;
    let glb = stage.file(Format::Glb, 1e-4)?;
    let table = run.table(Some(Sampling::Rate(24.0)))?;
    let vary = Vary::new(&["restitution=0.5:0.9:5"])?;
    let sweep = Sweep::new("drop.toml", DROP, &vary, Run::default(), RowFormat::Csv, None)?;
    let wishes = [Wish::parse("touch 2 at frame 30", Clock { fps: 24.0, first: 0 })?];
    let solved = solve(Some(("drop.toml", DROP)), &["cor"], &wishes)?;

    let folder = std::env::temp_dir().join("saltus-scene");
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("drop.glb"), &glb.bytes)?;
    fs::write(folder.join("drop.csv"), table.csv())?;
    fs::write(folder.join("drop.svg"), record::svg(&run, Kind::Height)?)?;
    fs::write(folder.join("sweep.csv"), sweep.text())?;
    fs::write(folder.join("solved.toml"), solved.toml()?)?;
    println!("{}; {}; see {}", stage.says(&glb), solved.says(Clock { fps: 24.0, first: 0 })[0], folder.display());

    // At rest after (1 + e)/(1 - e) falls; the second touch is 1 + 2e falls after the start.
    let fall = (2.0_f64 / 9.81).sqrt();
    assert!((run.rest().ok_or("no rest")? - 9.0 * fall).abs() < 1e-9);
    assert!(glb.bytes.starts_with(b"glTF") && glb.miss.height < 0.003 && sweep.text().lines().count() == 6);
    assert!((solved.numbers()[0].1 - 0.5 * (1.25 / fall - 1.0)).abs() < 1e-7);
    Ok(())
}
