//! The contacts for those who make the sound: a table, and a tick for each in a WAV file.

use std::f64::consts::TAU;
use std::fmt::Write;

use super::{Export, ExportError};

/// One row for each contact: ball, frame, time, place, the normal of what is touched, and the speed
/// of approach along it.
pub(super) fn contacts(export: &Export<'_>) -> String {
    let u = export.space.unit.symbol();
    let mut csv = format!("ball,frame,time_s,x_{u},y_{u},height_{u},normal_x,normal_y,normal_up,speed_{u}_per_s\n");
    for hit in hits(export) {
        let _ = write!(csv, "{},{},{}", super::table::quoted(hit.name), export.frames.number(hit.t), hit.t);
        for number in hit.place.iter().chain(&hit.normal).chain([&hit.speed]) {
            let _ = write!(csv, ",{}", number + 0.0);
        }
        csv.push('\n');
    }
    csv
}

struct Hit<'a> {
    ball: usize,
    name: &'a str,
    t: f64,
    place: [f64; 3],
    normal: [f64; 3],
    speed: f64,
}

/// The contacts of all balls in order of time.
fn hits<'a>(export: &'a Export<'_>) -> Vec<Hit<'a>> {
    let tracks = export.motion.tracks.iter().enumerate();
    let mut hits: Vec<Hit<'_>> = tracks
        .flat_map(|(ball, track)| {
            track.stretches.iter().filter_map(move |stretch| {
                let (contact, t) = (stretch.contact?, stretch.start());
                let (normal, speed) = (contact.normal, contact.speed);
                Some(Hit { ball, name: &track.name, t, place: stretch.at(t), normal, speed })
            })
        })
        .collect();
    hits.sort_by(|a, b| a.t.total_cmp(&b.t));
    hits
}

/// Samples in a second: the rate of film sound.
const RATE: u32 = 48_000;
/// A tick dies out by this time constant in s, and is over after so many of them.
const DIES: f64 = 0.004;
const OVER: f64 = 10.0;
/// The pitch of the first ball in Hz; each further ball is a fourth (4/3) higher, five of them at
/// most.
const PITCH: f64 = 1500.0;
const FOURTH: f64 = 4.0 / 3.0;
/// The loudest tick, of full scale.
const LOUDEST: f64 = 0.8;
/// The longest sound in s; a file of it has 350 MB.
const LONGEST: f64 = 3600.0;

/// A tick at the first sample not before each contact, as loud as the contact is fast: mono, 16
/// bits, 48 kHz. Sample 0 is the first frame.
pub(super) fn wav(export: &Export<'_>) -> Result<Vec<u8>, ExportError> {
    let end = export.motion.end() + DIES * OVER;
    if end > LONGEST {
        return Err(ExportError(format!("{end:.0} s of sound are too many: end the motion within an hour")));
    }
    let hits = hits(export);
    let fastest = hits.iter().map(|hit| hit.speed).fold(0.0, f64::max);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // an hour at most
    let sample = |t: f64| (t * f64::from(RATE) - 1e-6).ceil().max(0.0) as usize;
    let mut sound = vec![0.0_f64; sample(end) + 1];
    for hit in hits.iter().filter(|hit| hit.speed > 0.0) {
        let loud = LOUDEST * hit.speed / fastest;
        let pitch = PITCH * FOURTH.powi(i32::try_from(hit.ball.min(4)).unwrap_or(0));
        for (n, out) in sound[sample(hit.t)..].iter_mut().take(sample(DIES * OVER)).enumerate() {
            #[allow(clippy::cast_precision_loss)] // some thousands
            let s = n as f64 / f64::from(RATE);
            // A cosine: the first sample is the loudest, so that the start of a tick is where it
            // is.
            *out += loud * (-s / DIES).exp() * (TAU * pitch * s).cos();
        }
    }
    #[allow(clippy::cast_possible_truncation)] // clamped
    let samples = sound.iter().map(|x| (x.clamp(-1.0, 1.0) * f64::from(i16::MAX)) as i16);
    let data: Vec<u8> = samples.flat_map(i16::to_le_bytes).collect();
    let size = u32::try_from(data.len()).map_err(|_| ExportError("the sound is too long".to_owned()))?;
    let mut file = Vec::with_capacity(44 + data.len());
    file.extend(b"RIFF");
    file.extend((36 + size).to_le_bytes());
    file.extend(b"WAVEfmt ");
    // 16 bytes follow: plain samples, one channel, the rate, bytes a second, bytes and bits a
    // sample.
    file.extend(16_u32.to_le_bytes());
    file.extend([1_u16, 1].map(u16::to_le_bytes).concat());
    file.extend([RATE, 2 * RATE].map(u32::to_le_bytes).concat());
    file.extend([2_u16, 16].map(u16::to_le_bytes).concat());
    file.extend(b"data");
    file.extend(size.to_le_bytes());
    file.extend(data);
    Ok(file)
}
