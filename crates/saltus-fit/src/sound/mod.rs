//! A sound of a bouncing ball: the contacts in it, each with its uncertainty, and what else is
//! heard.

mod bounced;
mod chain;
mod ears;
mod fade;
mod onset;
mod pulse;
mod wav;
mod wave;

use std::io::{Read, Seek};
use std::ops::Range;

use saltus_bounce::units::Quantity;

use crate::error::TableError;
use crate::finding::Lines;
pub(crate) use bounced::{Bounced, Unused};
pub(crate) use chain::SURE;
use ears::{Ears, Heard};
pub(crate) use fade::Fade;
pub(crate) use onset::Onset;
pub(crate) use pulse::Pulses;
use wav::Spec;
pub(crate) use wav::is_wav;
use wave::Drawn;
pub use wave::Wave;

/// A recorded sound, and the contacts of a ball in it.
///
/// ```
/// use saltus_fit::{Fit, Sound, Table};
///
/// // Six clicks of 2 ms at 44100 samples a second, each interval 0.8 of the one before.
/// let mut samples = vec![0.0; 88_200];
/// let (mut time, mut flight) = (0.2, 0.4);
/// for _ in 0..6 {
///     let at = (44_100.0 * time) as usize;
///     (0..88).for_each(|k| samples[at + k] = if k % 8 < 4 { 0.5 } else { -0.5 });
///     (time, flight) = (time + flight, 0.8 * flight);
/// }
/// let sound = Sound::of("clicks", 44_100, &samples)?;
/// assert_eq!(sound.drops()[0].len(), 6);
/// let report = Fit::new().run(&Table::from_sound(sound))?;
/// assert!(report.cor().is_some_and(|cor| (cor.value - 0.8).abs() < 0.001));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Limits
/// Contacts closer than 8 ms are one sound. A ball is heard whose rebounds are 4 mm and more at
/// first, and which keeps 0.15 to 0.998 of its speed; at most one contact in a row may be missed.
#[derive(Clone, Debug, PartialEq)]
pub struct Sound {
    name: String,
    part: Range<f64>,
    drops: Vec<Vec<Contact>>,
    /// Of each drop, ln of one over how many as good ones come by chance.
    pub(crate) evidence: Vec<f64>,
    pub(crate) fades: Vec<Fade>,
    pub(crate) unused: Vec<(f64, Unused)>,
    clipped: f64,
    wave: Wave,
}

/// A contact heard in a sound.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// Which one, from 1: one may not be heard.
    pub number: usize,
    /// When, in s from the start of the recording.
    pub time: f64,
    /// The standard error of the time, in s.
    pub sigma: f64,
}

impl Sound {
    /// The part of a recording that a text names, in s: `0.5s..4s`, `2s..`, `..4s`.
    ///
    /// ```
    /// use saltus_fit::Sound;
    /// assert_eq!(Sound::stretch("500ms..4s"), Ok(0.5..4.0));
    /// assert_eq!(Sound::stretch("2s.."), Ok(2.0..f64::INFINITY));
    /// assert!(Sound::stretch("4s..1s").is_err());
    /// ```
    ///
    /// # Errors
    /// A sentence for a text that names none.
    pub fn stretch(text: &str) -> Result<Range<f64>, String> {
        let (from, to) =
            text.split_once("..").ok_or_else(|| format!("'{text}' is no stretch of time, such as 0.5s..4s"))?;
        let end = |text: &str, open: f64| match text.trim() {
            "" => Ok(open),
            text => Quantity::Time.parse(text).map_err(|error| error.to_string()),
        };
        let (from, to) = (end(from, 0.0)?, end(to, f64::INFINITY)?);
        if from >= 0.0 && from < to {
            Ok(from..to)
        } else {
            Err(format!(
                "'{text}' is no stretch of a recording: its end must come after its start, and that no sooner than 0 s"
            ))
        }
    }

    /// Listens to a `part` in s of a WAV file of 8 to 32 bits, integers or floats, of any rate from
    /// 4000 samples a second on and of any number of channels.
    ///
    /// # Errors
    /// [`TableError`] for a file that is no such sound, a part beyond its end, and where no ball is
    /// heard bouncing.
    pub fn read(name: &str, mut file: impl Read + Seek, part: Range<f64>) -> Result<Self, TableError> {
        let start = part.start.max(0.0);
        let begin = |spec| Ears::new(spec, start);
        let ears = wav::frames(name, &mut file, &(start..part.end), begin, |ears, frame| ears.push(frame))?;
        Self::heard(name, start, ears, |around| {
            file.rewind().map_err(|error| wav::unread(name, &error))?;
            let begin = |spec: Spec| (Drawn::new(), spec.rate);
            let (drawn, rate) = wav::frames(name, file, around, begin, |(drawn, _), frame| drawn.frame(frame))?;
            Ok(drawn.wave(around.start, rate.into()))
        })
    }

    /// Listens to samples from -1 to 1 of one channel, `rate` a second.
    ///
    /// # Errors
    /// [`TableError`] for a rate below 4000 a second, and where no ball is heard bouncing.
    pub fn of(name: &str, rate: u32, samples: &[f32]) -> Result<Self, TableError> {
        if !wav::RATES.contains(&rate) {
            let says = format!("a sound of {rate} samples a second is not read");
            return Err(TableError::new(name, says).help("record at 44100 samples a second"));
        }
        let mut ears = Ears::new(Spec { rate, channels: 1, step: f32::EPSILON }, 0.0);
        samples.iter().for_each(|&x| ears.push(&[if x.is_finite() { x } else { 0.0 }]));
        Self::heard(name, 0.0, ears, |around| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            // at the ends of its range it stays there
            let frame = |t: f64| ((t * f64::from(rate)).ceil() as usize).min(samples.len());
            let mut drawn = Drawn::new();
            samples[frame(around.start)..frame(around.end)].iter().for_each(|&x| drawn.frame(&[x]));
            Ok(drawn.wave(around.start, rate.into()))
        })
    }

    /// The sound in which ears hear a ball; `draw` makes the wave of the part around it.
    fn heard(
        name: &str,
        start: f64,
        ears: Ears,
        draw: impl FnOnce(&Range<f64>) -> Result<Wave, TableError>,
    ) -> Result<Self, TableError> {
        let (part, clipped) = (start..start + ears.seconds(), ears.clipped());
        let Heard { onsets, bounced } = ears.heard();
        let Some(Bounced { drops, evidence, unused }) = bounced else {
            return Err(nothing(name, &onsets, &part));
        };
        let contact = |&(n, number): &(usize, usize)| {
            let Onset { time, sigma, .. } = onsets[n];
            Contact { number, time, sigma }
        };
        let unused = unused.into_iter().map(|(n, why)| (onsets[n].time, why)).collect();
        let fades = drops.iter().map(|drop| Fade::of(&onsets, drop)).collect();
        let drops: Vec<Vec<Contact>> = drops.iter().map(|drop| drop.iter().map(contact).collect()).collect();
        let wave = draw(&around(&drops))?;
        Ok(Self { name: name.to_owned(), part, drops, evidence, fades, unused, clipped, wave })
    }

    /// The name of the file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The part of the recording that was listened to, in s.
    #[must_use]
    pub fn part(&self) -> Range<f64> {
        self.part.clone()
    }

    /// The contacts of each drop, in the order of time; at least three in each.
    #[must_use]
    pub fn drops(&self) -> &[Vec<Contact>] {
        &self.drops
    }

    /// The part of all samples that are as large as can be.
    #[must_use]
    pub fn clipped(&self) -> f64 {
        self.clipped
    }

    /// The sound from a little before the first contact to a little after the last, as it is drawn.
    #[must_use]
    pub fn wave(&self) -> &Wave {
        &self.wave
    }
}

/// From a little before the first contact to a little after the last.
fn around(drops: &[Vec<Contact>]) -> Range<f64> {
    /// The part of the time between them.
    const LITTLE: f64 = 0.05;
    let times = || drops.iter().flatten().map(|contact| contact.time);
    let (first, last) = (times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
    let little = LITTLE * (last - first);
    (first - little).max(0.0)..last + little
}

/// What is heard where no ball bounces.
fn nothing(name: &str, onsets: &[Onset], part: &Range<f64>) -> TableError {
    let mut loudest: Vec<&Onset> = onsets.iter().collect();
    loudest.sort_by(|a, b| b.power.total_cmp(&a.power));
    loudest.truncate(Lines::NAMED);
    loudest.sort_by(|a, b| a.time.total_cmp(&b.time));
    let times: Vec<String> = loudest.iter().map(|onset| format!("{:.2} s", onset.time)).collect();
    let heard = match (onsets.len(), times.join(", ")) {
        (0, _) => "nothing stands out from the noise".to_owned(),
        (1, times) => format!("one sound stands out from the noise, at {times}"),
        (count, times) if count <= Lines::NAMED => format!("{count} sounds stand out from the noise, at {times}"),
        (count, times) => format!("{count} sounds stand out from the noise, the loudest at {times}"),
    };
    let long = part.end - part.start;
    let says = format!(
        "no ball is heard bouncing in {long:.2} s of sound: {heard}, and no three or more come ever sooner, as a ball does"
    );
    TableError::new(name, says)
        .help("choose the part with the bounces, such as --listen 0.5s..4s; or record again, in silence, near where the ball falls")
        .nothing()
}
