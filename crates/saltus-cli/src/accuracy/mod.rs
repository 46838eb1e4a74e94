//! `saltus accuracy`: what accuracy costs in a scene.

mod advice;
mod document;
mod effects;
mod picture;
mod table;
mod words;

use std::path::Path;
use std::process::ExitCode;

use saltus_scene::Scene;
use saltus_scene::accuracy::{Accuracy, Target, Way};

use crate::args;
use crate::error::Error;
use crate::output::{check_picture, say, write};
use crate::simulate::{ending, scene};

pub(crate) fn run(args: &args::Accuracy, quiet: bool) -> Result<ExitCode, Error> {
    check_picture(args.plot.as_deref())?;
    if args.plot.as_deref() == Some(Path::new("-")) {
        return Err(Error::new("standard output holds the report: name a file for the picture instead of '-'"));
    }
    let scene = scene(&args.scene, ending(args.until, None))?;
    let name = name(&scene, &args.scene);
    let accuracy = Accuracy::timed(&scene).map_err(Error::new)?;
    let toggles = accuracy.toggled(&scene);
    let target = args.target.unwrap_or(Target::DEFAULT);
    if let Some(path) = &args.plot {
        write(Some(path), picture::svg(&name, &accuracy, target)?.as_bytes())?;
        say(quiet, &format!("picture: {}", path.display()));
    }
    let text = match args.format {
        args::ReportFormat::Text => [
            format!("What accuracy costs: {name}\n\n"),
            advice::in_full(&accuracy, target),
            table::text(&accuracy, target, args.all),
            effects::text(&toggles, &accuracy, target),
        ]
        .concat(),
        args::ReportFormat::Json => document::json(&accuracy, &toggles, target)?,
    };
    write(None, text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// The scene with the cheapest setting that meets the target, and that setting in words.
pub(crate) fn aimed(mut scene: Scene, target: Target) -> Result<(Scene, String), Error> {
    let accuracy = Accuracy::counted(&scene).map_err(Error::new)?;
    let best = accuracy.cheapest(target).ok_or_else(|| Error::new(advice::unmet(&accuracy, target)))?;
    if let Way::Steps { stepper, tolerance } = best.way {
        (scene.run.stepper, scene.run.tolerance) = (Some(stepper), Some(tolerance));
    }
    let text = advice::in_short(best, &accuracy, target);
    Ok((scene, text))
}

/// What the scene is called: its title, or else its file.
fn name(scene: &Scene, path: &Path) -> String {
    match (&scene.picture.title, path.file_stem()) {
        (Some(title), _) => title.clone(),
        (None, Some(stem)) if path != Path::new("-") => stem.to_string_lossy().into_owned(),
        _ => "a scene from standard input".to_owned(),
    }
}
