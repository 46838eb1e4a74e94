//! `saltus export`: a scene in, a file for animators out.

use std::process::ExitCode;

use saltus_motion::{Export, Format};

use crate::args::{self, ExportFormat};
use crate::error::Error;
use crate::output::{extension, say, write};
use crate::stage::{Stage, length};

pub(crate) fn run(args: &args::Export, quiet: bool) -> Result<ExitCode, Error> {
    let format = format(args)?;
    let Stage { motion, frames, shape, mut says } = Stage::of(&args.scene, &args.staging, args.first_frame, quiet)?;
    let file = Export { motion: &motion, frames, tolerance: args.tolerance, shape }.file(format).map_err(Error::new)?;
    write(args.output.as_deref(), &file.bytes)?;
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
    let off = motion.off_frame(frames);
    say(
        quiet,
        &format!(
            "{} keys; farthest contact from a frame: {off:.2} frames; worst height error: {}{says}",
            file.keys,
            length(file.miss.height)
        ),
    );
    Ok(ExitCode::SUCCESS)
}

/// The format by name, or by the extension of the file.
fn format(args: &args::Export) -> Result<Format, Error> {
    let extension = args.output.as_deref().and_then(extension);
    let format = match (args.to, extension.as_deref()) {
        (Some(format), _) => format,
        (None, Some("csv")) => ExportFormat::Csv,
        (None, Some("glb")) => ExportFormat::Glb,
        (None, Some("usda")) => ExportFormat::Usd,
        (None, Some("svg")) => ExportFormat::Svg,
        (None, Some("json" | "py")) => {
            return Err(Error::new("several formats go by that extension: say --to json, lottie, blender or maya"));
        }
        (None, Some(other)) => {
            let says = "use .glb, .usda, .svg or .csv, or say --to";
            return Err(Error::new(format!("no format goes by the extension '.{other}': {says}")));
        }
        (None, None) => {
            return Err(Error::new("say which format, such as --to glb, or name a file, such as -o ball.glb"));
        }
    };
    Ok(match format {
        ExportFormat::Csv => Format::Csv,
        ExportFormat::CsvFrames => Format::CsvFrames,
        ExportFormat::Json => Format::Json,
        ExportFormat::Blender => Format::Blender,
        ExportFormat::Maya => Format::Maya,
        ExportFormat::Glb => Format::Glb,
        ExportFormat::Usd => Format::Usd,
        ExportFormat::UsdSplines => Format::UsdSplines,
        ExportFormat::Lottie => Format::Lottie,
        ExportFormat::Svg => Format::Svg,
        ExportFormat::Chart => Format::Chart,
    })
}
