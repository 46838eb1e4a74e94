//! The files that are written, and what each says of itself.

mod blender;
mod gltf;
mod lottie;
mod maya;
mod svg;
mod table;
mod usd;
mod view;

use std::fmt;

use crate::curve::{Curve, Miss};
use crate::motion::{Motion, Track};
use crate::rate::Frames;

/// More frames than this are refused: an hour and more at 240 frames per second.
const MOST_FRAMES: f64 = 1e6;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
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
    /// A binary glTF 2.0 with two animations: frames first, exact cubics second.
    Glb,
    /// USD as text, a place for every frame.
    Usd,
    /// USD as text with splines, for USD 25.5 and later.
    UsdSplines,
    /// Lottie.
    Lottie,
    /// SVG that moves by CSS.
    Svg,
}

impl Format {
    /// Whether its first animation is made of frames, not of exact keys.
    #[must_use]
    pub const fn sampled(self) -> bool {
        matches!(self, Self::CsvFrames | Self::Glb | Self::Usd)
    }
}

/// A file, and how exact it is.
#[derive(Clone, Debug, PartialEq)]
pub struct File {
    /// What is to be written.
    pub bytes: Vec<u8>,
    /// How many keys all balls have together.
    pub keys: usize,
    /// How far it is from the motion: from frame to frame too.
    pub miss: Miss,
}

/// A motion and how it is to be shown.
#[derive(Clone, Copy, Debug)]
pub struct Export<'a> {
    /// The motion, cut and snapped if it is to be.
    pub motion: &'a Motion,
    /// How frames are counted.
    pub frames: Frames,
    /// How far keys may be from a flight in which more than gravity acts, in m; other flights are exact.
    pub tolerance: f64,
}

impl Export<'_> {
    /// The motion as a file.
    ///
    /// # Errors
    /// [`ExportError`] if the motion has more than a million frames, or the format cannot hold its frame rate.
    pub fn file(&self, format: Format) -> Result<File, ExportError> {
        let (end, frame) = (self.motion.end(), self.frames.rate.frame());
        if end / frame > MOST_FRAMES {
            let says = format!("{:.0} frames are too many: end the motion earlier", end / frame);
            return Err(ExportError(says));
        }
        if end <= 0.0 {
            return Err(ExportError("the motion has no length: there is nothing to show".to_owned()));
        }
        let curves = self.curves(format.sampled());
        let bytes = match format {
            Format::Csv | Format::CsvFrames => table::csv(self, &curves).into_bytes(),
            Format::Json => table::json(self, &curves)?.into_bytes(),
            Format::Blender => blender::script(self, &curves).into_bytes(),
            Format::Maya => maya::script(self, &curves)?.into_bytes(),
            Format::Glb => gltf::binary(self, &curves, &self.curves(false))?,
            Format::Usd => usd::samples(self, &curves).into_bytes(),
            Format::UsdSplines => usd::splines(self, &curves).into_bytes(),
            Format::Lottie => lottie::json(self, &curves)?.into_bytes(),
            Format::Svg => svg::animated(self, &curves).into_bytes(),
        };
        let tracks = self.motion.tracks.iter();
        let miss = curves.iter().zip(tracks).map(|(curve, track)| curve.error(track)).fold(Miss::default(), Miss::or);
        Ok(File { bytes, keys: curves.iter().map(|curve| curve.keys.len()).sum(), miss })
    }

    /// A curve for each ball: frames, or keys; on twos always frames.
    fn curves(&self, sampled: bool) -> Vec<Curve> {
        let curve = |track: &Track| {
            if sampled || self.frames.on_twos {
                track.samples(self.frames, true)
            } else {
                track.keys(self.tolerance, self.frames)
            }
        };
        self.motion.tracks.iter().map(curve).collect()
    }

    /// The numbers of the first and the last frame.
    fn range(&self) -> [i64; 2] {
        let first = i64::from(self.frames.first);
        #[allow(clippy::cast_possible_truncation)] // at most a million
        let count = (self.motion.end() / self.frames.rate.frame() - 1e-6).ceil() as i64;
        [first, first + count]
    }
}

/// How far the ground reaches on both sides of the plane of x and up, in m.
fn depth(motion: &Motion) -> f64 {
    let [[left, right], _] = motion.reach();
    let aside =
        |track: &Track| track.stretches.iter().map(|stretch| stretch.at(stretch.end())[1].abs()).fold(0.0, f64::max);
    let balls = motion.tracks.iter().map(|track| aside(track) + 4.0 * track.radius).fold(0.0, f64::max);
    balls.max(0.25 * (right - left))
}

/// Why a motion cannot be written, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportError(String);

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ExportError {}

impl From<serde_json::Error> for ExportError {
    fn from(error: serde_json::Error) -> Self {
        Self(error.to_string())
    }
}
