//! How a motion is shown: what can be asked of it.

use std::ops::RangeInclusive;
use std::path::Path;

use clap::{Args as ClapArgs, ValueEnum};
use saltus_bounce::units::Quantity;
use saltus_motion::{Frames, Rate, Snap};
use saltus_scene::{Squash, Stage, length};

use crate::error::Error;
use crate::output::say;
use crate::parse::{JUMPS, number, positive};
use crate::scenes::{ended, ending, note, planned, scene};

/// The frame rate unless one is given.
const FILM: &str = "24";
/// The parts of its height that a ball may lose, and by which it may be longer.
const SQUASHES: RangeInclusive<f64> = 0.0..=0.9;
const STRETCHES: RangeInclusive<f64> = 0.0..=2.0;
/// The factors of either: beyond them nothing is visible, or no ball is left.
const FACTORS: RangeInclusive<f64> = 0.001..=1000.0;
/// For how many frames a contact may be held.
const FRAMES: RangeInclusive<u32> = 1..=1000;

/// How a motion is shown.
#[derive(Clone, Debug, ClapArgs)]
pub(crate) struct Staging {
    /// Frames per second, such as `24`, `29.97` or `24000/1001`.
    #[arg(long, value_name = "RATE", default_value = FILM, allow_hyphen_values = true)]
    pub(crate) fps: Rate,
    /// Move every contact to a whole frame, and keep gravity or the heights.
    #[arg(long, value_enum)]
    pub(crate) snap: Option<SnapBy>,
    /// Draw every second frame only, and let it stand for two.
    #[arg(long)]
    pub(crate) on_twos: bool,
    /// Squash the ball in contacts: the part of its height it loses in the fastest one, or `law`
    /// for what a contact that takes time says.
    #[arg(long, value_name = "PART", value_parser = squash, allow_hyphen_values = true)]
    pub(crate) squash: Option<Squash>,
    /// Stretch the ball along its velocity: the part by which it is longer at the greatest speed.
    #[arg(long, value_name = "PART", value_parser = number(STRETCHES), allow_hyphen_values = true)]
    pub(crate) stretch: Option<f64>,
    /// Squash and stretch so many times as much; once unless given.
    #[arg(long, value_name = "FACTOR", value_parser = number(FACTORS), allow_hyphen_values = true)]
    pub(crate) exaggerate: Option<f64>,
    /// Hold each contact for this many frames at least; what comes after is later. Where a contact
    /// is an instant, --squash holds it for 2.
    #[arg(long, value_name = "FRAMES", value_parser = number(FRAMES), allow_hyphen_values = true)]
    pub(crate) hold: Option<u32>,
    /// Show only this hop, from one contact to the next, to be played for ever: in place, in whole
    /// frames, its end its start.
    #[arg(long = "loop", value_name = "HOP", num_args = 0..=1, require_equals = true, default_missing_value = "1", value_parser = number(JUMPS))]
    pub(crate) looped: Option<u32>,
    /// Turn left and right around.
    #[arg(long)]
    pub(crate) mirror: bool,
    /// Set a key at the top of every flight too, to be moved by hand; the motion is the same.
    #[arg(long)]
    pub(crate) apexes: bool,
    /// When to stop, such as `4s`.
    #[arg(long, value_name = "TIME", value_parser = positive(Quantity::Time), allow_hyphen_values = true)]
    pub(crate) until: Option<f64>,
}

/// What stays when contacts move to whole frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SnapBy {
    /// Gravity; heights change.
    Gravity,
    /// Heights; each flight is slower or faster.
    Heights,
}

impl Staging {
    /// The options that may vary from motion to motion, by name.
    pub(crate) const VARIED: [&'static str; 9] =
        ["fps", "snap", "on-twos", "squash", "stretch", "exaggerate", "hold", "loop", "mirror"];

    /// Runs the scene of a file, writes its messages, and stages it.
    pub(crate) fn of(&self, path: &Path, first: i32, quiet: bool) -> Result<Stage, Error> {
        let scene = scene(path, ending(self.until, None))?;
        if let Some(note) = note(&scene) {
            say(quiet, &note);
        }
        let staging = self.staging(first);
        staging.holds(&scene).map_err(Error::new)?;
        let record = planned(&scene, Some(path))?.run().map_err(Error::new)?;
        ended(&record, quiet);
        let stage = staging.stage(&record).map_err(Error::new)?;
        if let Some(drawn) = drawn(&stage) {
            say(quiet, &drawn);
        }
        Ok(stage)
    }

    /// The settings by which a run is shown.
    pub(crate) fn staging(&self, first: i32) -> saltus_scene::Staging {
        let mut staging = saltus_scene::Staging::new(Frames { rate: self.fps, first, on_twos: self.on_twos });
        staging.snap = self.snap.map(|snap| match snap {
            SnapBy::Gravity => Snap::Gravity,
            SnapBy::Heights => Snap::Heights,
        });
        (staging.squash, staging.stretch) = (self.squash, self.stretch.unwrap_or(0.0));
        (staging.exaggerate, staging.hold) = (self.exaggerate.unwrap_or(1.0), self.hold);
        (staging.looped, staging.mirror, staging.apexes) = (self.looped, self.mirror, self.apexes);
        staging
    }

    /// Whether one of [`Staging::VARIED`] is given, to something else than what it is without.
    pub(crate) fn gives(&self, option: &str) -> bool {
        match option {
            "fps" => self.fps.to_string() != FILM,
            "snap" => self.snap.is_some(),
            "on-twos" => self.on_twos,
            "squash" => self.squash.is_some(),
            "stretch" => self.stretch.is_some(),
            "exaggerate" => self.exaggerate.is_some(),
            "hold" => self.hold.is_some(),
            "loop" => self.looped.is_some(),
            "mirror" => self.mirror,
            _ => false,
        }
    }

    /// Sets one of [`Staging::VARIED`] to what would stand behind it.
    pub(crate) fn set(&mut self, option: &str, value: &str) -> Result<(), String> {
        let switch = || value.parse().map_err(|_| format!("'{value}' is neither true nor false"));
        match option {
            "fps" => self.fps = value.parse().map_err(|error: saltus_motion::RateError| error.to_string())?,
            "snap" => self.snap = Some(SnapBy::from_str(value, true)?),
            "on-twos" => self.on_twos = switch()?,
            "mirror" => self.mirror = switch()?,
            "squash" => self.squash = Some(squash(value)?),
            "stretch" => self.stretch = Some(number(STRETCHES)(value)?),
            "exaggerate" => self.exaggerate = Some(number(FACTORS)(value)?),
            "hold" => self.hold = Some(number(FRAMES)(value)?),
            "loop" => self.looped = Some(number(JUMPS)(value)?),
            _ => return Err(format!("'{option}' is no way to show a motion")),
        }
        Ok(())
    }
}

/// A note about radii that the scene does not give.
pub(crate) fn drawn(stage: &Stage) -> Option<String> {
    let radius = length(stage.drawn?);
    Some(format!("the scene gives no radius: drawn with {radius}; set `radius` under [ball]"))
}

fn squash(text: &str) -> Result<Squash, String> {
    match text {
        "law" => Ok(Squash::Law),
        text => number(SQUASHES)(text).map(Squash::Part).map_err(|error| format!("{error}, nor `law`")),
    }
}
