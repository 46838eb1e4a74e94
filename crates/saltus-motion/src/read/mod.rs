//! Exported files read back, as their formats have them, and compared with a motion: with the
//! feature `read`.
//!
//! The readers share no code with the writers.

mod formats;
mod package;

use std::fmt;

use crate::motion::Motion;
use crate::rate::Frames;

/// The extensions of the files that can be read back.
pub const EXTENSIONS: [&str; 7] = ["glb", "usda", "usdz", "json", "lottie", "svg", "csv"];

/// Heights are compared at so many times, and at every contact.
const TIMES: u32 = 4000;

/// A motion of a file.
#[derive(Debug)]
pub struct Reading {
    /// The name of the animation, or of the format.
    pub name: String,
    /// Whether it is made of frames.
    pub sampled: bool,
    /// The balls, one or several.
    pub balls: Vec<Ball>,
}

/// The height of one ball.
pub struct Ball {
    height: Box<dyn Fn(f64) -> f64>,
    /// The radii in a unit of a picture, which has radii and not metres.
    radii: Option<f64>,
    end: f64,
}

/// The distance of the heights of a file from a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Off {
    /// The worst distance in m.
    pub worst: f64,
    /// The time of the worst distance, in s.
    pub at: f64,
    /// The largest depth of a contact below its place, in m.
    pub sunk: f64,
}

/// An error of a file that is not as its format requires.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError(String);

/// The motions in the bytes of a file, by its extension, one of [`EXTENSIONS`].
///
/// ```
/// use saltus_motion::{Contact, Export, Format, Frames, Motion, Piece, Stretch, Track, read::readings};
/// let fall = Piece {
///     start: 0.0,
///     span: 0.4,
///     coefficients: vec![[0.0, 0.0, 1.0], [0.0; 3], [0.0, 0.0, -4.905]],
///     spin: Vec::new(),
/// };
/// let stretches = vec![Stretch { contact: None, flight: true, pieces: vec![fall] }];
/// let motion = Motion::new("fall", vec![Track { name: "ball".into(), radius: 0.02, stretches }], Vec::new())?;
/// let frames = Frames::new("24".parse()?);
/// let file = Export::new(&motion, frames).file(Format::Lottie)?;
/// let read = &readings(&file.bytes, "json")?[0];
/// assert!(read.name == "Lottie" && read.off(&motion, frames).worst < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReadError`] if it is no such file, or has no motion.
pub fn readings(bytes: &[u8], extension: &str) -> Result<Vec<Reading>, ReadError> {
    let text = || std::str::from_utf8(bytes).map_err(|_| ReadError::new("it is no text"));
    match extension {
        "glb" => formats::glb(bytes),
        "usda" => formats::usda(text()?),
        "usdz" => formats::usda(&package::layer(bytes)?),
        "svg" => formats::svg(text()?),
        "csv" => formats::csv(text()?),
        "lottie" => formats::json(&package::animation(bytes)?),
        "json" => formats::json(text()?),
        other => Err(ReadError::new(format!("no file ends in '.{other}'"))),
    }
}

impl Reading {
    /// The time of the last key, in s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.balls.iter().map(|ball| ball.end).fold(0.0, f64::max)
    }

    /// The distance of the heights from those of `motion`, ball by ball.
    #[must_use]
    pub fn off(&self, motion: &Motion, frames: Frames) -> Off {
        let mut found = Off::default();
        for (ball, track) in self.balls.iter().zip(&motion.tracks) {
            // A picture shows by how much the ball is lower than at the start.
            let height = |t: f64| match ball.radii {
                Some(radii) => track.at(0.0)[2] + track.radius * radii * (ball.height)(t),
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
                // Drawings stand: each is looked at while it does, and compared with where the ball
                // was as it was drawn.
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
}

impl fmt::Debug for Ball {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Ball").field("radii", &self.radii).field("end", &self.end).finish_non_exhaustive()
    }
}

impl ReadError {
    fn new(message: impl fmt::Display) -> Self {
        Self(message.to_string())
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ReadError {}
