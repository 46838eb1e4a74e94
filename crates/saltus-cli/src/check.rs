//! `saltus check`: an exported file in, how far its heights are from the motion out.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args as ClapArgs;
use saltus_bounce::units::Quantity;
use saltus_motion::read::{EXTENSIONS, Off, Reading, readings};
use saltus_motion::{Export, Format};
use saltus_scene::{Stage, length};

use crate::error::Error;
use crate::output::{extension, stdout};
use crate::parse::positive;
use crate::staging::Staging;

/// Read a file that `saltus export` wrote, and say how far its heights are from the scene's motion.
///
/// The file is read as its format has it, not as it was written: glTF, USD as text, Lottie, both
/// as packages too, SVG, CSV and JSON. Give the options it was exported with. Exit status 1 if a
/// height is farther off than the export says, or than --tolerance.
#[derive(Debug, ClapArgs)]
pub(crate) struct Check {
    /// The file.
    pub(crate) file: PathBuf,
    /// The scene; `-` for standard input.
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) staging: Staging,
    /// How far heights may be from the motion; without it, what the export promised, and what
    /// single precision adds.
    #[arg(long, value_name = "LENGTH", value_parser = positive(Quantity::Length), allow_hyphen_values = true)]
    pub(crate) tolerance: Option<f64>,
}

/// What single precision adds to a height, of the size of the picture.
const SINGLE: f64 = 1e-6;
/// Keys are this near to a motion in which more than gravity acts, unless an export says otherwise,
/// in m.
const KEYS: f64 = 1e-4;

pub(crate) fn run(args: &Check, quiet: bool) -> Result<ExitCode, Error> {
    // A file that cannot be read is an error before a scene is run.
    let readings = read(&args.file)?;
    let Stage { motion, frames, shape, .. } = args.staging.of(&args.scene, 0, quiet)?;
    let export = Export { tolerance: KEYS, shape, ..Export::new(&motion, frames) };
    let [[left, right], [low, high]] = motion.reach();
    let size = (right - left).max(high - low);
    let (mut lines, mut good) = (String::new(), true);
    for reading in &readings {
        if reading.balls.len() != motion.tracks.len() {
            let (file, scene) = (reading.balls.len(), motion.tracks.len());
            return Err(Error::new(format!("'{}' has {file} balls, the scene {scene}", args.file.display())));
        }
        let allowed = match args.tolerance {
            Some(tolerance) => tolerance,
            None => {
                let format = if reading.sampled { Format::CsvFrames } else { Format::Csv };
                export.file(format).map_err(Error::new)?.miss.height + SINGLE * size
            }
        };
        let Off { worst, at, sunk } = reading.off(&motion, frames);
        let ends = reading.end();
        let whole = (ends - motion.end()).abs() <= frames.step();
        let kept = worst <= allowed && whole;
        good &= kept;
        lines += &format!("{}: worst height error {} at {at:.4} s", reading.name, length(worst));
        lines += &match sunk {
            sunk if sunk > allowed => format!("; a contact is {} too low", length(sunk)),
            _ => "; contacts touch".to_owned(),
        };
        if !whole {
            lines += &format!("; it ends at {ends:.4} s, the motion at {:.4} s", motion.end());
        }
        lines += &format!("; {} {}\n", if kept { "within" } else { "not within" }, length(allowed));
    }
    stdout(lines.as_bytes())?;
    Ok(if good { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// What a file holds, after its extension.
fn read(path: &Path) -> Result<Vec<Reading>, Error> {
    let extension = extension(path).unwrap_or_default();
    if extension == "py" {
        return Err(Error::new(
            "a script can only be run by the program it is for: Blender's and Maya's say themselves how near their curves are to the motion",
        ));
    }
    if !EXTENSIONS.contains(&extension.as_str()) {
        let scene = if extension == "toml" { "; `saltus explain` checks a scene" } else { "" };
        return Err(Error::new(format!(
            "'{}' cannot be checked: of what saltus export writes, .{} can be read back{scene}",
            path.display(),
            EXTENSIONS.join(", .")
        )));
    }
    let bytes = fs::read(path).map_err(|error| Error::reading(path, &error))?;
    readings(&bytes, &extension)
        .map_err(|error| Error::new(format!("'{}' cannot be read back: {error}", path.display())))
}
