//! `saltus export`: a scene in, a file for animators out.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args as ClapArgs, ValueEnum};
use saltus_bounce::units::Quantity;
use saltus_motion::{File, Format};

use crate::args::positive;
use crate::error::Error;
use crate::output::{check_new, extension, say, write};
use crate::stage::{Stage, length};
use crate::staging::Staging;

/// Write the motion of a scene for animators: keys, scripts, models, moving pictures.
///
/// Every flight is one exact parabola between two contacts where the format can hold it. Hops shorter than a frame are left out. It ends in one line:
/// how many keys, how far a contact is from a frame, how far the file is from the motion, and by how much squash and stretch depart from it. See
/// docs/motion.md.
#[derive(Debug, ClapArgs)]
pub(crate) struct Export {
    /// The scene; `-` for standard input.
    pub(crate) scene: PathBuf,
    /// What is written; without it, after the extension of the output file.
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) to: Option<ExportFormat>,
    /// Write to a file; `-` for standard output.
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Write the file anew where it exists.
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) shown: Shown,
}

/// How a motion is put on frames and keys.
#[derive(Debug, ClapArgs)]
pub(crate) struct Shown {
    /// The number of the frame at which the motion starts.
    #[arg(long, value_name = "NUMBER", default_value_t = 0, allow_hyphen_values = true, value_parser = clap::value_parser!(i32).range(-1_000_000..=1_000_000))]
    pub(crate) first_frame: i32,
    #[command(flatten)]
    pub(crate) staging: Staging,
    /// How far keys may be from the motion where more than gravity acts.
    #[arg(long, value_name = "LENGTH", value_parser = positive(Quantity::Length), default_value = "0.1mm")]
    pub(crate) tolerance: f64,
}

/// A format for animators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportFormat {
    /// Keys as a table.
    Csv,
    /// A place for every frame as a table.
    CsvFrames,
    /// Keys and frames, for programs.
    Json,
    /// A Python script for Blender 4 and 5.
    Blender,
    /// A Python script for Maya.
    Maya,
    /// Binary glTF: frames first, exact cubics second.
    Glb,
    /// USD as text, a place for every frame.
    Usd,
    /// USD as text with splines, for USD 25.5 and later.
    UsdSplines,
    /// Lottie.
    Lottie,
    /// A moving SVG.
    Svg,
    /// The timing chart, an SVG that stands still: a tick for every frame, contacts and tops marked.
    Chart,
}

impl ExportFormat {
    /// As it is asked for.
    pub(crate) fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// What files of it end in, each format in its own.
    pub(crate) const fn ending(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::CsvFrames => "frames.csv",
            Self::Json => "json",
            Self::Blender => "blender.py",
            Self::Maya => "maya.py",
            Self::Glb => "glb",
            Self::Usd => "usda",
            Self::UsdSplines => "splines.usda",
            Self::Lottie => "lottie.json",
            Self::Svg => "svg",
            Self::Chart => "chart.svg",
        }
    }

    const fn of(self) -> Format {
        match self {
            Self::Csv => Format::Csv,
            Self::CsvFrames => Format::CsvFrames,
            Self::Json => Format::Json,
            Self::Blender => Format::Blender,
            Self::Maya => Format::Maya,
            Self::Glb => Format::Glb,
            Self::Usd => Format::Usd,
            Self::UsdSplines => Format::UsdSplines,
            Self::Lottie => Format::Lottie,
            Self::Svg => Format::Svg,
            Self::Chart => Format::Chart,
        }
    }
}

pub(crate) fn run(args: &Export, quiet: bool) -> Result<ExitCode, Error> {
    let format = format(args)?;
    check_new(args.output.as_deref(), args.force)?;
    let stage = Stage::of(&args.scene, &args.shown.staging, args.shown.first_frame, quiet)?;
    let file = file(&stage, format, args.shown.tolerance)?;
    write(args.output.as_deref(), &file.bytes)?;
    say(quiet, &says(&stage, &file));
    Ok(ExitCode::SUCCESS)
}

/// What is shown as a file.
pub(crate) fn file(stage: &Stage, format: ExportFormat, tolerance: f64) -> Result<File, Error> {
    let Stage { motion, frames, shape, .. } = stage;
    let export = saltus_motion::Export { motion, frames: *frames, tolerance, shape: *shape };
    export.file(format.of()).map_err(Error::new)
}

/// How exact a file is, and how it departs from the scene's motion, in a line.
pub(crate) fn says(stage: &Stage, file: &File) -> String {
    let Stage { motion, frames, shape, says, .. } = stage;
    let mut says = says.clone();
    if let Some(seen) = file.shown {
        if shape.squash > 0.0 || shape.stretch > 0.0 {
            let volume = 100.0 * seen.volume;
            says += &format!("; outline moved by up to {}, volume kept within {volume:.2} %", length(seen.moved));
        }
        if seen.sunk > 1e-5 {
            says += &format!("; the ball is in what it touches by up to {}", length(seen.sunk));
        }
        if seen.added > 0 {
            says += &format!("; {} keys added to its turning, so that none is half a turn from the next", seen.added);
        }
    }
    let (off, miss) = (motion.off_frame(*frames), length(file.miss.height));
    format!("{} keys; farthest contact from a frame: {off:.2} frames; worst height error: {miss}{says}", file.keys)
}

/// The format by name, or by the extension of the file.
fn format(args: &Export) -> Result<ExportFormat, Error> {
    let extension = args.output.as_deref().and_then(extension);
    match (args.to, extension.as_deref()) {
        (Some(format), _) => Ok(format),
        (None, Some("csv")) => Ok(ExportFormat::Csv),
        (None, Some("glb")) => Ok(ExportFormat::Glb),
        (None, Some("usda")) => Ok(ExportFormat::Usd),
        (None, Some("svg")) => Ok(ExportFormat::Svg),
        (None, Some("json" | "py")) => {
            Err(Error::new("several formats go by that extension: say --to json, lottie, blender or maya"))
        }
        (None, Some(other)) => {
            let says = "use .glb, .usda, .svg or .csv, or say --to";
            Err(Error::new(format!("no format goes by the extension '.{other}': {says}")))
        }
        (None, None) => Err(Error::new("say which format, such as --to glb, or name a file, such as -o ball.glb")),
    }
}
