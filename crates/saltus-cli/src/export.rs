//! `saltus export`: a scene in, a file for animators out.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args as ClapArgs;
use saltus_bounce::units::Quantity;
use saltus_motion::{Format, Space, Unit, Up};

use crate::error::Error;
use crate::output::{check_apart, check_extension, check_new, extension, say, write};
use crate::parse::{FIRST_FRAME, number, one_of, positive};
use crate::staging::Staging;

/// Write the motion of a scene for animators: keys, scripts, models, moving pictures.
///
/// Every flight is one exact parabola between two contacts where the format can hold it. Hops
/// shorter than a frame are left out. It ends in one line: how many keys, how far a contact is from
/// a frame, how far the file is from the motion, and by how much squash and stretch depart from it.
/// See docs/use/motion.md.
#[derive(Debug, ClapArgs)]
pub(crate) struct Export {
    /// The scene; `-` for standard input.
    pub(crate) scene: PathBuf,
    /// What is written; without it, after the extension of the output file.
    #[arg(long, value_name = "FORMAT", value_parser = one_of(&Format::ALL, Format::name, Format::about))]
    pub(crate) to: Option<Format>,
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
    #[arg(long, value_name = "NUMBER", default_value_t = 0, allow_hyphen_values = true, value_parser = number(FIRST_FRAME))]
    pub(crate) first_frame: i32,
    #[command(flatten)]
    pub(crate) staging: Staging,
    /// How far keys may be from the motion where more than gravity acts.
    #[arg(long, value_name = "LENGTH", value_parser = positive(Quantity::Length), default_value = "0.1mm", allow_hyphen_values = true)]
    pub(crate) tolerance: f64,
    /// The unit of the file's lengths; a format that has its own refuses any other.
    #[arg(long, value_name = "UNIT", value_parser = one_of(&Unit::ALL, Unit::symbol, Unit::about), default_value = "m")]
    pub(crate) units: Unit,
    /// The axis that is up; without it the format's own: y in USD.
    #[arg(long, value_name = "AXIS", value_parser = one_of(&Up::ALL, Up::name, Up::about))]
    pub(crate) up: Option<Up>,
}

impl Shown {
    /// The unit and the axis of files.
    pub(crate) const fn space(&self) -> Space {
        Space { unit: self.units, up: self.up }
    }
}

pub(crate) fn run(args: &Export, quiet: bool) -> Result<ExitCode, Error> {
    let format = format(args)?;
    format.takes(args.shown.space()).map_err(Error::new)?;
    let endings = Format::ALL.map(last);
    check_extension(args.output.as_deref(), format.name(), last(format), &endings)?;
    check_apart(args.output.as_deref(), &args.scene)?;
    check_new(args.output.as_deref(), args.force)?;
    let mut stage = args.shown.staging.of(&args.scene, args.shown.first_frame, quiet)?;
    stage.space = args.shown.space();
    let file = stage.file(format, args.shown.tolerance).map_err(Error::new)?;
    write(args.output.as_deref(), &file.bytes)?;
    say(quiet, &stage.says(&file));
    Ok(ExitCode::SUCCESS)
}

/// The extension of a format's files: what is behind the last dot of their ending.
fn last(format: Format) -> &'static str {
    let ending = format.ending();
    ending.rsplit_once('.').map_or(ending, |(_, last)| last)
}

/// The format by name, or by the extension of the file.
fn format(args: &Export) -> Result<Format, Error> {
    let extension = args.output.as_deref().and_then(extension);
    match (args.to, extension.as_deref()) {
        (Some(format), _) => Ok(format),
        (None, Some("csv")) => Ok(Format::Csv),
        (None, Some("glb")) => Ok(Format::Glb),
        (None, Some("usda")) => Ok(Format::Usd),
        (None, Some("svg")) => Ok(Format::Svg),
        (None, Some("html" | "htm")) => Ok(Format::Html),
        (None, Some("gltf")) => Ok(Format::Gltf),
        (None, Some("wav")) => Ok(Format::Wav),
        (None, Some("usdz")) => Ok(Format::Usdz),
        (None, Some("lottie")) => Ok(Format::DotLottie),
        (None, Some("json" | "py")) => {
            Err(Error::new("several formats go by that extension: say --to json, lottie, blender or maya"))
        }
        (None, Some(other)) => {
            let says = "use .html, .glb, .gltf, .usda, .usdz, .lottie, .svg, .csv or .wav, or say --to";
            Err(Error::new(format!("no format goes by the extension '.{other}': {says}")))
        }
        (None, None) => Err(Error::new("say which format, such as --to glb, or name a file, such as -o ball.glb")),
    }
}
