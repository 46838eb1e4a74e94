//! A WAV file, frame by frame: whatever its samples are, they become numbers from -1 to 1.

use std::io::{ErrorKind, Read, Seek};
use std::ops::Range;

use hound::{SampleFormat, WavReader, WavSpec};

use crate::error::TableError;

/// Rates of samples in which a contact has a beginning, 1/s: below, what tells it is not recorded;
/// above, no recorder goes.
pub(super) const RATES: std::ops::RangeInclusive<u32> = 4_000..=768_000;

/// How a file ends that is shorter than it states.
const SHORT: [ErrorKind; 2] = [ErrorKind::UnexpectedEof, ErrorKind::Other];

/// What the file states of itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spec {
    /// Frames in a second.
    pub(super) rate: u32,
    /// Samples in a frame.
    pub(super) channels: u16,
    /// The smallest difference of two samples.
    pub(super) step: f32,
}

/// Whether these are the first bytes of a WAV file.
pub(crate) fn is_wav(bytes: &[u8]) -> bool {
    bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WAVE")
}

/// Hands every frame of a `part` of the sound, in s, to `each`; what the file is goes to `begin`.
pub(super) fn frames<T>(
    name: &str,
    reader: impl Read + Seek,
    part: &Range<f64>,
    begin: impl FnOnce(Spec) -> T,
    each: impl Fn(&mut T, &[f32]),
) -> Result<T, TableError> {
    let wrong = |error: hound::Error| {
        TableError::new(name, format!("the sound cannot be read: {error}")).help("save it as WAV of 16 bits, PCM")
    };
    let mut wav = WavReader::new(reader).map_err(wrong)?;
    let WavSpec { channels, sample_rate: rate, bits_per_sample: bits, sample_format } = wav.spec();
    if !RATES.contains(&rate) || channels == 0 || !(1..=32).contains(&bits) {
        let says = format!("a sound of {rate} samples a second, {channels} channels and {bits} bits is not read");
        return Err(TableError::new(name, says).help("save it at 44100 samples a second, 16 bits, PCM"));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at the ends of its range it stays there
    let [first, last] = [part.start, part.end].map(|t| (t * f64::from(rate)).ceil() as u32);
    if first >= wav.duration() {
        let long = f64::from(wav.duration()) / f64::from(rate);
        let says = format!("the sound is {long:.3} s long: nothing is left to listen to");
        return Err(TableError::new(name, says).help("name a part within it, such as --listen 0.5s..4s"));
    }
    wav.seek(first).map_err(|error| unread(name, &error))?;
    let step = match sample_format {
        SampleFormat::Float => f32::EPSILON,
        SampleFormat::Int => (-f32::from(bits - 1)).exp2(),
    };
    let mut heard = begin(Spec { rate, channels, step });
    let count = u64::from(last.saturating_sub(first)) * u64::from(channels);
    let mut frame = Vec::with_capacity(channels.into());
    let mut take = |sample: f32| {
        // What is no number is silence.
        frame.push(if sample.is_finite() { sample } else { 0.0 });
        if frame.len() == usize::from(channels) {
            each(&mut heard, &frame);
            frame.clear();
        }
    };
    #[allow(clippy::cast_precision_loss)] // what is lost is below single precision
    let done = match sample_format {
        SampleFormat::Float => until_cut(wav.into_samples::<f32>(), count, &mut take),
        SampleFormat::Int => until_cut(wav.into_samples::<i32>(), count, |sample| take(sample as f32 * step)),
    };
    done.map_err(wrong)?;
    Ok(heard)
}

/// A file that cannot be read to its end.
pub(super) fn unread(name: &str, error: &std::io::Error) -> TableError {
    TableError::new(name, format!("the file cannot be read: {error}")).help("check that you may read it")
}

/// Takes so many samples, or as many as there are: a recorder that was switched off leaves fewer
/// than the file states.
fn until_cut<S>(
    samples: impl Iterator<Item = hound::Result<S>>,
    count: u64,
    mut take: impl FnMut(S),
) -> hound::Result<()> {
    for (sample, taken) in samples.zip(0..count) {
        match sample {
            Ok(sample) => take(sample),
            Err(hound::Error::FormatError(_)) if taken > 0 => return Ok(()),
            Err(hound::Error::IoError(error)) if taken > 0 && SHORT.contains(&error.kind()) => return Ok(()),
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
