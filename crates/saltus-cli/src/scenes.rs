//! Scenes of commands: read from a file, ended by options, planned and run, with their messages.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use saltus_scene::plan::{End, Plan, Record};
use saltus_scene::{Law, Run, Scene};

use crate::error::Error;
use crate::output::{extension, say};

/// The plan of a scene; an error bears the file's name.
pub(crate) fn planned(scene: &Scene, path: Option<&Path>) -> Result<Plan, Error> {
    scene.plan().map_err(|error| match path {
        Some(path) if path != Path::new("-") && error.in_text().is_none() => {
            Error::new(format!("{}: {error}", path.display()))
        }
        _ => Error::new(error),
    })
}

/// Writes why a run ended, if that is not what was asked for.
pub(crate) fn ended(record: &Record, quiet: bool) {
    let t = record.until();
    let doubts = record.doubts();
    if let Some(first) = doubts.first() {
        let more = match doubts.len() - 1 {
            0 => String::new(),
            more => format!(" (and {more} more like it)"),
        };
        say(quiet, &format!("a jump may have been missed: {first}{more}"));
    }
    match record.end() {
        End::Time => {}
        End::Jumps { most } => {
            say(
                quiet,
                &format!(
                    "stopped after {most} jumps, at {t:.6} s: `most_jumps` under [run], or --most-jumps where a command has it, allows more; --until ends by time"
                ),
            );
        }
        end => say(quiet, &format!("stopped at {t:.6} s: {end}")),
    }
}

/// The end of a run by the options of the command line.
pub(crate) fn ending(until: Option<f64>, most_jumps: Option<u32>) -> Run {
    let mut run = Run::default();
    (run.until, run.most_jumps) = (until, most_jumps);
    run
}

/// The scene of a file or of standard input; the options in `run` go before the settings of the
/// scene.
pub(crate) fn scene(path: &Path, run: Run) -> Result<Scene, Error> {
    let (name, toml) = read(path)?;
    Scene::parse_with(&name, &toml, run).map_err(|error| match extension(path).as_deref() {
        Some("csv" | "tsv" | "xlsx" | "xls" | "zip") => Error::new(format!(
            "'{name}' is a table, not a scene: fit it first, by `saltus fit {name} --scene ball.toml`, and take ball.toml"
        )),
        _ => Error::new(error),
    })
}

/// The text of a scene, from a file or from standard input, and its name.
pub(crate) fn read(path: &Path) -> Result<(String, Vec<u8>), Error> {
    let most = Scene::LARGEST as u64 + 1;
    let mut toml = Vec::new();
    if path == Path::new("-") {
        std::io::stdin().lock().take(most).read_to_end(&mut toml).map_err(Error::new)?;
        return Ok(("standard input".to_owned(), toml));
    }
    let read = File::open(path).and_then(|file| file.take(most).read_to_end(&mut toml));
    read.map_err(|error| Error::reading(path, &error))?;
    Ok((path.to_string_lossy().into_owned(), toml))
}

/// A note about a range, with its source, where a run takes one number of it.
pub(crate) fn note(scene: &Scene) -> Option<String> {
    let law = scene.law(0, 0)?;
    let [low, high] = law.range(0.0);
    let cor = law.constant()?;
    let taken = format!("this run takes {:.4}; `restitution = {{ pick = 0 }}` to `1` takes another", cor.value());
    match law {
        Law::Preset { preset, .. } if low == high => Some(preset.to_string()),
        Law::Preset { preset, .. } => Some(format!("{preset}: {taken}")),
        Law::Range { .. } => Some(format!("COR between {low} and {high}: {taken}")),
        _ => None,
    }
}
