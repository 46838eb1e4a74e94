//! `saltus accuracy`: what accuracy costs in a scene.

mod advice;
mod effects;
mod picture;
mod table;
mod words;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args as ClapArgs;
use saltus_bounce::units::Quantity;
use saltus_scene::Scene;
use saltus_scene::accuracy::{Accuracy as Measured, Target, Way};

use crate::error::Error;
use crate::output::{check_picture, say, write};
use crate::parse::{ReportFormat, positive, target};
use crate::scenes::{ending, scene};

/// Show what accuracy costs in a scene.
///
/// Says which setting to take: the cheapest that meets the target, how exact it is, what it costs.
/// To know, it runs the scene by each stepper to ten tolerances, and frame by frame at 24 to 240
/// frames per second, and compares every run with a reference: by formulas where they solve the
/// scene, or else a run to a tolerance two orders tighter, whose own error is estimated.
#[derive(Debug, ClapArgs)]
pub(crate) struct Accuracy {
    /// The scene; `-` for standard input.
    pub(crate) scene: PathBuf,
    /// How exact the run has to be everywhere, such as `1mm`, `0.1ms`, or both; `1mm,1ms` unless
    /// given.
    #[arg(long, value_name = "LENGTH,TIME", value_parser = target, allow_hyphen_values = true)]
    pub(crate) target: Option<Target>,
    /// Show every setting that was tried, not only those that cost least for what they give; JSON
    /// has them all.
    #[arg(long)]
    pub(crate) all: bool,
    /// Draw time against error as SVG.
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot: Option<PathBuf>,
    /// When to stop, such as `4s`; otherwise when the scene says.
    #[arg(long, value_name = "TIME", value_parser = positive(Quantity::Time), allow_hyphen_values = true)]
    pub(crate) until: Option<f64>,
    /// How to write it; docs/trust/accuracy.md describes its JSON.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: ReportFormat,
}

pub(crate) fn run(args: &Accuracy, quiet: bool) -> Result<ExitCode, Error> {
    check_picture(args.plot.as_deref())?;
    if args.plot.as_deref() == Some(Path::new("-")) {
        return Err(Error::new("standard output holds the report: name a file for the picture instead of '-'"));
    }
    let scene = scene(&args.scene, ending(args.until, None))?;
    let name = name(&scene, &args.scene);
    let accuracy = Measured::timed(&scene).map_err(Error::new)?;
    let toggles = accuracy.toggled(&scene);
    let target = args.target.unwrap_or(Target::DEFAULT);
    if let Some(path) = &args.plot {
        write(Some(path), picture::svg(&name, &accuracy, target)?.as_bytes())?;
        say(quiet, &format!("picture: {}", path.display()));
    }
    let text = match args.format {
        ReportFormat::Text => [
            format!("What accuracy costs: {name}\n\n"),
            advice::in_full(&accuracy, target),
            table::text(&accuracy, target, args.all),
            effects::text(&toggles, &accuracy, target),
        ]
        .concat(),
        ReportFormat::Json => accuracy.json(&toggles, target).map_err(Error::new)?,
    };
    write(None, text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// The scene with the cheapest setting that meets the target, and that setting in words.
pub(crate) fn aimed(mut scene: Scene, target: Target) -> Result<(Scene, String), Error> {
    let accuracy = Measured::counted(&scene).map_err(Error::new)?;
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
