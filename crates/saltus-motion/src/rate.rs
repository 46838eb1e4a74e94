//! Frame rates, held as fractions, and the numbering of frames.

use std::fmt;
use std::str::FromStr;

/// The most frames of a motion.
const MOST_FRAMES: f64 = 1e6;

/// Frames per second, a fraction: 24, or 24000/1001 where a catalogue says 23.976.
///
/// ```
/// use saltus_motion::Rate;
/// let film: Rate = "23.976".parse()?;
/// assert_eq!(film, Rate::new(24_000, 1001)?);
/// assert_eq!(film.to_string(), "24000/1001");
/// assert_eq!("24".parse::<Rate>()?.frame(), 1.0 / 24.0);
/// assert!("0".parse::<Rate>().is_err());
/// # Ok::<(), saltus_motion::RateError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    frames: u32,
    seconds: u32,
}

impl Rate {
    /// `frames` in `seconds`.
    ///
    /// # Errors
    /// [`RateError`] unless it is from 1 to 1000 frames per second.
    pub fn new(frames: u32, seconds: u32) -> Result<Self, RateError> {
        let (a, b) = (u64::from(frames), u64::from(seconds));
        if seconds == 0 || a < b || a > 1000 * b {
            return Err(RateError::of(&format!("{frames}/{seconds}")));
        }
        let shared = divisor(frames, seconds);
        Ok(Self { frames: frames / shared, seconds: seconds / shared })
    }

    /// The fraction in lowest terms: frames, and in how many seconds.
    #[must_use]
    pub const fn fraction(self) -> (u32, u32) {
        (self.frames, self.seconds)
    }

    /// Frames per second.
    #[must_use]
    pub fn per_second(self) -> f64 {
        f64::from(self.frames) / f64::from(self.seconds)
    }

    /// The length of a frame in s.
    #[must_use]
    pub fn frame(self) -> f64 {
        f64::from(self.seconds) / f64::from(self.frames)
    }
}

const fn divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { divisor(b, a % b) }
}

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self { frames, seconds: 1 } => write!(f, "{frames}"),
            Self { frames, seconds } => write!(f, "{frames}/{seconds}"),
        }
    }
}

impl FromStr for Rate {
    type Err = RateError;

    /// Reads `24`, `12.5`, `24000/1001`, and `23.976`, `23.98`, `29.97`, `47.952`, `59.94`,
    /// `119.88` as the fractions they stand for.
    fn from_str(text: &str) -> Result<Self, RateError> {
        let bad = || RateError::of(text);
        let text = text.trim();
        let whole = |text: &str| text.trim().parse::<u32>().ok();
        if let Some((frames, seconds)) = text.split_once('/') {
            return Self::new(whole(frames).ok_or_else(bad)?, whole(seconds).ok_or_else(bad)?).map_err(|_| bad());
        }
        let known = match text {
            "23.976" | "23.98" => Some(24),
            "29.97" => Some(30),
            "47.952" | "47.95" => Some(48),
            "59.94" => Some(60),
            "119.88" => Some(120),
            _ => None,
        };
        if let Some(nominal) = known {
            return Self::new(nominal * 1000, 1001);
        }
        let (before, after) = text.split_once('.').unwrap_or((text, ""));
        if after.len() > 4 || !after.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err(bad());
        }
        let scale = 10_u32.pow(u32::try_from(after.len()).map_err(|_| bad())?);
        let part = if after.is_empty() { 0 } else { whole(after).ok_or_else(bad)? };
        let frames = whole(before).and_then(|n| n.checked_mul(scale)).and_then(|n| n.checked_add(part));
        Self::new(frames.ok_or_else(bad)?, scale).map_err(|_| bad())
    }
}

/// An error of a frame rate: the text is none, or none that a motion can be shown at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RateError(String);

impl RateError {
    fn of(text: &str) -> Self {
        Self(format!(
            "'{text}' is not a frame rate: give frames per second from 1 to 1000, such as 24, 25, 29.97 or 24000/1001"
        ))
    }
}

impl fmt::Display for RateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for RateError {}

/// The relation of frames to times: the rate, the number of the first frame, and how many frames a
/// drawing stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frames {
    /// The rate in frames per second.
    pub rate: Rate,
    /// The number of the frame at 0 s.
    pub first: i32,
    /// Whether every drawing stands for two frames.
    pub on_twos: bool,
}

impl Frames {
    /// Frames counted from 0, with a drawing for each.
    #[must_use]
    pub const fn new(rate: Rate) -> Self {
        Self { rate, first: 0, on_twos: false }
    }

    /// The time between two drawings in s: one frame, or two.
    #[must_use]
    pub fn step(self) -> f64 {
        self.rate.frame() * if self.on_twos { 2.0 } else { 1.0 }
    }

    /// Refuses a motion of so many seconds that it has more than a million frames: an hour and more
    /// at 240 frames per second.
    ///
    /// # Errors
    /// [`RateError`], with the longest time that there may be.
    pub fn holds(self, seconds: f64) -> Result<(), RateError> {
        let most = MOST_FRAMES * self.rate.frame();
        if seconds <= most {
            return Ok(());
        }
        Err(RateError(format!(
            "{seconds:.0} s are more than {MOST_FRAMES} frames: end the motion within {most:.0} s, or show fewer frames per second"
        )))
    }

    /// The frame number of `t` in s, with its fraction.
    #[must_use]
    pub fn number(self, t: f64) -> f64 {
        let (frames, seconds) = self.rate.fraction();
        let exact = t * f64::from(frames) / f64::from(seconds);
        // A time that was made from a whole number of frames gives it back.
        let whole = exact.round();
        f64::from(self.first) + if (exact - whole).abs() < 1e-9 * whole.abs().max(1.0) { whole } else { exact }
    }
}
