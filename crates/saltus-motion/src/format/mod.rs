//! The formats of files for animators, each with a sentence about it.

mod blender;
mod chart;
mod flat;
mod gltf;
mod lottie;
mod maya;
mod own;
mod package;
mod player;
mod sound;
mod svg;
mod table;
mod usd;
mod view;

use std::fmt;

use crate::bound::Miss;
use crate::curve::{APART, Between, Curve};
use crate::dress::Dress;
use crate::motion::{Motion, Point, Track};
use crate::rate::Frames;
use crate::shape::Shape;
use crate::shown::Shown;
use crate::space::{Space, Unit};
use crate::turn::Turn;

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
    /// SVG that stands still: a tick for every frame, contacts and tops marked.
    Chart,
    /// A page that plays the motion, frame by frame too, with its keys and contacts; it needs no
    /// network.
    Html,
    /// glTF 2.0 as text, with its buffer in it; otherwise as [`Format::Glb`].
    Gltf,
    /// The contacts as a table.
    Contacts,
    /// A tick at each contact, as loud as it is fast: mono, 16 bits, 48 kHz.
    Wav,
    /// [`Format::Usd`] as a package: a zip archive whose one file is not compressed.
    Usdz,
    /// [`Format::Lottie`] as a package: dotLottie 2, a zip archive with a manifest.
    DotLottie,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 17] = [
        Self::Csv,
        Self::CsvFrames,
        Self::Json,
        Self::Blender,
        Self::Maya,
        Self::Glb,
        Self::Usd,
        Self::UsdSplines,
        Self::Lottie,
        Self::Svg,
        Self::Chart,
        Self::Html,
        Self::Gltf,
        Self::Contacts,
        Self::Wav,
        Self::Usdz,
        Self::DotLottie,
    ];

    /// The name of the format.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::CsvFrames => "csv-frames",
            Self::Json => "json",
            Self::Blender => "blender",
            Self::Maya => "maya",
            Self::Glb => "glb",
            Self::Usd => "usd",
            Self::UsdSplines => "usd-splines",
            Self::Lottie => "lottie",
            Self::Svg => "svg",
            Self::Chart => "chart",
            Self::Html => "html",
            Self::Gltf => "gltf",
            Self::Contacts => "contacts",
            Self::Wav => "wav",
            Self::Usdz => "usdz",
            Self::DotLottie => "dotlottie",
        }
    }

    /// The ending of the names of its files, each format with its own.
    #[must_use]
    pub const fn ending(self) -> &'static str {
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
            Self::Html => "html",
            Self::Gltf => "gltf",
            Self::Contacts => "contacts.csv",
            Self::Wav => "wav",
            Self::Usdz => "usdz",
            Self::DotLottie => "lottie",
        }
    }

    /// A sentence about the format.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Csv => "Keys as a table",
            Self::CsvFrames => "A place for every frame as a table",
            Self::Json => "Keys and frames, for programs",
            Self::Blender => "A Python script for Blender 4 and 5",
            Self::Maya => "A Python script for Maya",
            Self::Glb => "Binary glTF: frames first, exact cubics second",
            Self::Usd => "USD as text, a place for every frame",
            Self::UsdSplines => "USD as text with splines, for USD 25.5 and later",
            Self::Lottie => "Lottie",
            Self::Svg => "A moving SVG",
            Self::Chart => {
                "The timing chart, an SVG that stands still: a tick for every frame, contacts and tops marked"
            }
            Self::Html => "A page that plays the motion, frame by frame too, with its keys and contacts",
            Self::Gltf => "glTF as text, all in one file",
            Self::Contacts => "The contacts as a table: when, where, how fast",
            Self::Wav => "A sound with a tick at each contact, as loud as it is fast",
            Self::Usdz => "USD as a package, a place for every frame",
            Self::DotLottie => "Lottie as a package, dotLottie 2",
        }
    }

    /// Whether an angle goes on over whole turns in it, along a curve.
    const fn counts_turns(self) -> bool {
        matches!(self, Self::Blender | Self::Svg | Self::Lottie | Self::DotLottie | Self::Html)
    }

    /// Whether it shows the plane of x and up.
    const fn is_flat(self) -> bool {
        matches!(self, Self::Svg | Self::Lottie | Self::DotLottie | Self::Html)
    }

    /// Whether it has the form of balls: how they turn, and are squashed and stretched.
    const fn has_form(self) -> bool {
        !matches!(self, Self::Chart | Self::Contacts | Self::Wav)
    }

    /// Whether its first animation is made of frames, not of exact keys.
    #[must_use]
    pub const fn sampled(self) -> bool {
        matches!(self, Self::CsvFrames | Self::Glb | Self::Gltf | Self::Usd | Self::Usdz)
    }
}

/// A file, and how exact it is.
#[derive(Clone, Debug, PartialEq)]
pub struct File {
    /// The content of the file.
    pub bytes: Vec<u8>,
    /// The number of keys of all balls together.
    pub keys: usize,
    /// The largest distance from the motion: between keys and frames too.
    pub miss: Miss,
    /// The departure of the ball's form from a round one, and the keys that its turning needs;
    /// `None` for a round ball that does not turn, and where the file does not have its form.
    pub shown: Option<Shown>,
}

/// The colours of balls, one after the other, and then again; vermilion, blue, green, purple and
/// ochre stay apart for every common kind of colour blindness.
const COLOURS: [[f64; 3]; 5] =
    [[0.85, 0.33, 0.1], [0.04, 0.38, 0.71], [0.0, 0.49, 0.36], [0.63, 0.29, 0.6], [0.72, 0.53, 0.04]];

/// The colour of a ball by its number, its parts from 0 to 1.
const fn colour(ball: usize) -> [f64; 3] {
    COLOURS[ball % COLOURS.len()]
}

/// The colour of a ball in the form of pictures.
fn ink(ball: usize) -> String {
    let [r, g, b] = colour(ball).map(|part| (255.0 * part).round());
    format!("rgb({r},{g},{b})")
}

/// The distance of keys from a motion, in m, unless another is asked for: a dot of a picture that
/// shows 40 cm by 4000 dots.
const TOLERANCE: f64 = 1e-4;

/// The least distance of keys from a motion that may be asked for, as a part of its size: a
/// thousand roundings of it.
const FINEST: f64 = 1e-12;

/// A motion and how it is to be shown.
#[derive(Clone, Copy, Debug)]
pub struct Export<'a> {
    /// The motion, cut and snapped if it is to be.
    pub motion: &'a Motion,
    /// The count of frames.
    pub frames: Frames,
    /// The largest distance of keys from a flight in which more than gravity acts, in m; other
    /// flights are exact.
    pub tolerance: f64,
    /// Squash and stretch; [`Shape::default`] is a ball that stays round.
    pub shape: Shape,
    /// Whether there is a key at the top of every flight, for those who change the motion by hand.
    ///
    /// Cubics stay what they are; straight lines from frame to frame get the top as well; of
    /// drawings that stand the one nearest to the top shows it.
    pub apexes: bool,
    /// The unit and the axis of the file; the errors of [`File`] are in m all the same.
    pub space: Space,
}

/// A ball as it is shown: its place, and its form and turning if they change.
struct Ball<'a> {
    track: &'a Track,
    path: Curve,
    dress: Option<Dress>,
    /// The form in a picture of the plane, where the true one leaves the plane.
    flat: Option<Dress>,
}

/// One of the nested nodes that a ball is in programs that know three dimensions: moved last,
/// turned before, made longer first.
struct Node<'a> {
    name: String,
    /// The place within the node around it, if it stays there.
    still: Point,
    place: Option<&'a Curve>,
    turns: &'a [Turn],
    /// The turning as an angle about y in rad, where that is all, in a format that counts turns.
    about: Option<&'a Curve>,
    scale: Option<&'a Curve>,
}

impl Ball<'_> {
    /// The nodes from the outermost to that of the ball itself, whose middle is its origin: the
    /// path, squash and stretch if there is any, spin.
    fn nodes(&self) -> Vec<Node<'_>> {
        let name = &self.track.name;
        let node = |name: String| Node { name, still: [0.0; 3], place: None, turns: &[], about: None, scale: None };
        let mut nodes = vec![Node { place: Some(&self.path), ..node(name.clone()) }];
        let mut inner = node(format!("{name} shape"));
        inner.still[2] = self.track.radius;
        if let Some(dress) = &self.dress {
            inner.turns = &dress.spin;
            inner.about = dress.about.as_ref();
            if dress.shaped() {
                inner.still[2] = 0.0;
                let (place, scale) = (Some(&dress.offset), Some(&dress.scale));
                nodes.push(Node { place, scale, turns: &dress.aim, ..node(format!("{name} squash")) });
            }
        }
        nodes.push(inner);
        nodes
    }

    /// The departure of what is shown from the motion; `None` for a round ball that does not turn.
    fn shown(&self) -> Option<Shown> {
        let solid = self.dress.as_ref()?.shown(self.track, &self.path, false);
        let Some(flat) = &self.flat else { return Some(solid) };
        // A flat picture has no volume, and its turning is counted already.
        let flat = flat.shown(self.track, &self.path, true);
        Some(solid.or(Shown { volume: 0.0, added: 0, ..flat }))
    }

    /// Whether every drawing stands until the next.
    fn held(&self) -> bool {
        self.path.between == Between::Hold
    }
}

impl<'a> Export<'a> {
    /// A round ball within 0.1 mm of the motion, in metres, with no keys but those it needs: change
    /// what is to be otherwise.
    ///
    /// ```
    /// use saltus_motion::{Export, Frames, Motion, Piece, Stretch, Track};
    /// let piece = Piece { start: 0.0, span: 1.0, coefficients: vec![[0.0, 0.0, 2.0]], spin: Vec::new() };
    /// let stretch = Stretch { contact: None, flight: true, pieces: vec![piece] };
    /// let track = Track { name: "ball".into(), radius: 0.02, stretches: vec![stretch] };
    /// let motion = Motion::new("still", vec![track], Vec::new())?;
    /// let export = Export { apexes: true, ..Export::new(&motion, Frames::new("24".parse()?)) };
    /// assert_eq!(export.tolerance, 1e-4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn new(motion: &'a Motion, frames: Frames) -> Self {
        let (shape, space) = (Shape::default(), Space::default());
        Self { motion, frames, tolerance: TOLERANCE, shape, apexes: false, space }
    }

    /// The motion as a file.
    ///
    /// # Errors
    /// [`ExportError`] if the motion has more than a million frames, the tolerance is finer than
    /// its places, or the format cannot hold its frame rate, the unit or the axis.
    ///
    /// ```
    /// use saltus_motion::{Export, Format, Frames, Motion, Piece, Shape, Space, Stretch, Track, Unit};
    /// let piece = Piece { start: 0.0, span: 1.0, coefficients: vec![[0.0, 0.0, 2.0]], spin: Vec::new() };
    /// let stretch = Stretch { contact: None, flight: true, pieces: vec![piece] };
    /// let track = Track { name: "ball".into(), radius: 0.02, stretches: vec![stretch] };
    /// let motion = Motion::new("still", vec![track], Vec::new())?;
    /// let (frames, space) = (Frames::new("24".parse()?), Space { unit: Unit::Centimetre, up: None });
    /// let export = Export { space, ..Export::new(&motion, frames) };
    /// assert!(String::from_utf8(export.file(Format::Csv)?.bytes)?.starts_with("ball,frame,time_s,x_cm,"));
    /// assert!(export.file(Format::Glb).is_err_and(|error| error.to_string().contains("glTF is in metres")));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn file(&self, format: Format) -> Result<File, ExportError> {
        format.takes(self.space)?;
        if self.space.unit == Unit::Metre {
            return self.written(format);
        }
        // All lengths are scaled at once, so that no writer can forget one.
        let (per, metres) = (self.space.unit.per_metre(), self.space.unit.metres());
        let motion = self.motion.scaled(per);
        let file = Export { motion: &motion, tolerance: self.tolerance * per, ..*self }.written(format)?;
        Ok(File { miss: file.miss.times(metres), shown: file.shown.map(|shown| shown.times(metres)), ..file })
    }

    /// The file, its lengths those of the motion.
    fn written(&self, format: Format) -> Result<File, ExportError> {
        let (end, frame) = (self.motion.end(), self.frames.rate.frame());
        self.frames.holds(end).map_err(|error| ExportError(error.to_string()))?;
        if end < APART * frame {
            return Err(ExportError(format!(
                "the motion lasts {end:.1e} s, less than a hundredth of a frame, and there is nothing to show: let it run longer"
            )));
        }
        self.shape.check().map_err(ExportError)?;
        let [across, up] = self.motion.reach();
        let finest = FINEST * [across, up].as_flattened().iter().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
        if self.tolerance.is_nan() || self.tolerance < finest {
            return Err(ExportError(format!(
                "keys cannot be within {:e} of the motion, whose places are no more exact: give a tolerance of {finest:.0e} or more",
                self.tolerance
            )));
        }
        let balls = self.balls(format, format.sampled());
        // glTF has two animations, and the errors of the file bound both.
        let second = if matches!(format, Format::Glb | Format::Gltf) { self.balls(format, false) } else { Vec::new() };
        let bytes = match format {
            Format::Csv | Format::CsvFrames => table::csv(self, &balls).into_bytes(),
            Format::Json => table::json(self, &balls)?.into_bytes(),
            Format::Blender => blender::script(self, &balls).into_bytes(),
            Format::Maya => maya::script(self, &balls)?.into_bytes(),
            Format::Glb => gltf::binary(self, &balls, &second)?,
            Format::Gltf => gltf::text(self, &balls, &second)?.into_bytes(),
            Format::Usd => usd::samples(self, &balls).into_bytes(),
            Format::UsdSplines => usd::splines(self, &balls).into_bytes(),
            Format::Lottie => lottie::json(self, &balls)?.into_bytes(),
            Format::Svg => svg::animated(self, &balls).into_bytes(),
            Format::Chart => chart::chart(self, &balls).into_bytes(),
            Format::Html => player::page(self, &balls)?.into_bytes(),
            Format::Contacts => sound::contacts(self).into_bytes(),
            Format::Wav => sound::wav(self)?,
            Format::Usdz => package::usdz(&usd::samples(self, &balls))?,
            Format::DotLottie => package::dotlottie(&lottie::json(self, &balls)?)?,
        };
        let both = || balls.iter().chain(&second);
        let miss = both().map(|ball| ball.path.error(ball.track)).fold(Miss::default(), Miss::or);
        let shown = both().filter(|_| format.has_form()).filter_map(Ball::shown);
        let keys = balls.iter().map(|ball| ball.path.keys.len()).sum();
        Ok(File { bytes, keys, miss, shown: shown.reduce(Shown::or) })
    }

    /// The balls as they are shown: by frames, or by keys; on twos always by frames.
    fn balls(&self, format: Format, sampled: bool) -> Vec<Ball<'_>> {
        let form =
            (self.shape.squash > 0.0 || self.shape.stretch > 0.0).then(|| self.motion.form(self.shape, self.frames));
        let ball = |track| {
            let mut path = if sampled || (self.frames.on_twos && format != Format::Chart) {
                Track::samples(track, self.frames, true)
            } else {
                track.keys(self.tolerance, self.frames)
            };
            if self.apexes {
                path = path.topped(track, self.frames);
            }
            let dress = Dress::of(track, form.as_ref(), &path, self.frames, format.counts_turns());
            let flat = dress.as_ref().filter(|_| format.is_flat()).and_then(Dress::flattened);
            Ball { track, path, dress, flat }
        };
        self.motion.tracks.iter().map(ball).collect()
    }

    /// The numbers of the first and the last frame; of a loop the last before the first again.
    fn range(&self) -> [i64; 2] {
        let first = i64::from(self.frames.first);
        #[allow(clippy::cast_possible_truncation)] // at most a million
        let count = (self.motion.end() / self.frames.rate.frame() - 1e-6).ceil() as i64;
        [first, first + count - i64::from(self.motion.loops)]
    }
}

/// The depth of the ground on both sides of the plane of x and up, in m.
fn depth(motion: &Motion) -> f64 {
    let [[left, right], _] = motion.reach();
    let aside =
        |track: &Track| track.stretches.iter().map(|stretch| stretch.at(stretch.end())[1].abs()).fold(0.0, f64::max);
    let balls = motion.tracks.iter().map(|track| aside(track) + 4.0 * track.radius).fold(0.0, f64::max);
    balls.max(0.25 * (right - left))
}

/// An error of an export: why a motion cannot be written, and what to do.
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
