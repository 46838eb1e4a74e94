//! `saltus check`: an exported file in, how far its heights are from the motion out.

mod package;
mod read;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args as ClapArgs;
use saltus_bounce::units::Quantity;
use saltus_motion::{Export, Format, Frames, Motion};
use saltus_scene::{Stage, length};

use self::read::Reading;
use crate::error::Error;
use crate::output::stdout;
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
    #[arg(long, value_name = "LENGTH", value_parser = positive(Quantity::Length))]
    pub(crate) tolerance: Option<f64>,
}

/// Heights are compared at so many times, and at every contact.
const TIMES: u32 = 4000;
/// What single precision adds to a height, of the size of the picture.
const SINGLE: f64 = 1e-6;
/// Keys are this near to a motion in which more than gravity acts, unless an export says otherwise,
/// in m.
const KEYS: f64 = 1e-4;

pub(crate) fn run(args: &Check, quiet: bool) -> Result<ExitCode, Error> {
    // A file that cannot be read is said before a scene is run.
    let readings = read::readings(&args.file)?;
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
        let Found { worst, at, sunk } = compared(reading, &motion, frames);
        let ends = reading.balls.iter().map(|ball| ball.end).fold(0.0, f64::max);
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

struct Found {
    /// The worst distance in height in m, and when.
    worst: f64,
    at: f64,
    /// How far a contact is below where it should be, at most.
    sunk: f64,
}

fn compared(reading: &Reading, motion: &Motion, frames: Frames) -> Found {
    let mut found = Found { worst: 0.0, at: 0.0, sunk: 0.0 };
    for (ball, track) in reading.balls.iter().zip(&motion.tracks) {
        // A picture shows by how much the ball is lower than at the start.
        let above = ball.from.map_or(0.0, |per_radius| track.radius * per_radius);
        let height = |t: f64| match ball.from {
            Some(_) => track.at(0.0)[2] + above * (ball.height)(t),
            None => (ball.height)(t),
        };
        let mut compare = |t: f64, look: f64, contact: bool| {
            let off = height(look) - track.at(t)[2];
            // A number that is none is as wrong as can be.
            let far = if off.is_finite() { off.abs() } else { f64::INFINITY };
            if far > found.worst {
                (found.worst, found.at) = (far, t);
            }
            if contact {
                found.sunk = found.sunk.max(-off);
            }
        };
        let end = track.end();
        if frames.on_twos {
            // Drawings stand: each is looked at while it does, and compared with where the ball was
            // as it was drawn.
            let drawn = (0_u32..).map(|k| f64::from(k) * frames.step());
            drawn.take_while(|&t| t <= end).for_each(|t| compare(t, t + 0.5 * frames.step(), false));
        } else {
            let times = (0..TIMES).map(|k| end * (f64::from(k) + 0.5) / f64::from(TIMES));
            times.for_each(|t| compare(t, t, false));
            track.contacts().for_each(|t| compare(t, t, true));
        }
    }
    found
}
