//! Where sounds begin: the instants at which the loudness leaps out of what was just before.
//!
//! A sound is gone through in blocks of half a second, of which three are kept: what begins in the
//! middle one is judged by all of them, so that hours take no more memory than seconds.

use super::wav::Spec;
use crate::elementary::{cos, hypot, ln, sin};

/// Loudness is that of so long, s: the click of a contact rises within less than a millisecond.
const GRAIN: f64 = 0.0005;
/// A block, in grains: half a second. Noise that changes is found anew in each.
const BLOCK: usize = 1000;
/// The part of the grains of a block that are quieter than its noise: less than half, for a voice
/// and ringing leave no more silence.
const QUIET: f64 = 0.25;
/// A sound begins where the power is so many times that of the noise and of all grains of the time
/// before (8 dB): ringing that beats rises by less.
const RISE: f32 = 6.0;
/// The time before, in grains: 4 ms.
const BEFORE: usize = 8;
/// The time within which a sound is at its loudest, in grains: 5 ms. What lossy recorders smear
/// ahead of a click is shorter.
const AHEAD: usize = 10;
/// A sound that begins sooner after another belongs to it, in grains: 6 ms.
const DEAD: usize = 12;
/// A sound begins where its wave first has this part of its largest size: what leads up to it
/// through the floor, or by a lossy recorder, is smaller.
const PART: f32 = 0.3;
/// Samples of noise are no larger than this many times its root mean square, but one of thousands.
const LOUDEST_NOISE: f32 = 3.5;
/// What is as large as a sample can be: the largest of 8 bits is 127/128.
const FULL: f32 = 0.99;

/// The beginning of a sound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Onset {
    /// When, s.
    pub(crate) time: f64,
    /// Its standard error, s: from where the wave has left what is before to where it is twice as
    /// large, and no less than a grain is spread.
    pub(crate) sigma: f64,
    /// The mean square of its loudest grain.
    pub(crate) power: f32,
}

impl Onset {
    /// ln of its power.
    pub(super) fn level(&self) -> f64 {
        ln(f64::from(self.power))
    }
}

/// A high-pass filter of second order, by Butterworth.
#[derive(Clone, Copy, Debug, Default)]
struct HighPass {
    input: [f64; 2],
    output: [f64; 2],
}

impl HighPass {
    fn next(&mut self, x: f64, [gain, a1, a2]: [f64; 3]) -> f64 {
        let [x1, x2] = self.input;
        let y = gain * (x - 2.0 * x1 + x2) - a1 * self.output[0] - a2 * self.output[1];
        (self.input, self.output) = ([x, x1], [y, self.output[0]]);
        y
    }
}

/// The coefficients of the filter that leaves what is above `lowest`, Hz, for so many samples a
/// second.
fn coefficients(lowest: f64, rate: f64) -> [f64; 3] {
    let w = std::f64::consts::TAU * lowest / rate;
    let (cos, slope) = (cos(w), sin(w) / std::f64::consts::SQRT_2);
    [(1.0 + cos) / (2.0 * (1.0 + slope)), -2.0 * cos / (1.0 + slope), (1.0 - slope) / (1.0 + slope)]
}

/// Half a second: its samples, filtered, and the power of its grains.
#[derive(Clone, Debug, Default)]
struct Block {
    samples: Vec<f32>,
    power: Vec<f32>,
    noise: Option<f32>,
}

impl Block {
    fn of(samples: Vec<f32>, grain: usize, least: f32) -> Self {
        #[allow(clippy::cast_precision_loss)] // some hundred
        let mean = |grain: &[f32]| grain.iter().map(|x| x * x).sum::<f32>() / grain.len() as f32;
        let power: Vec<f32> = samples.chunks_exact(grain).map(mean).collect();
        let mut sorted = power.clone();
        sorted.sort_unstable_by(f32::total_cmp);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
        let noise = sorted.get((QUIET * sorted.len() as f64) as usize).map(|noise| noise.max(least));
        Self { samples, power, noise }
    }
}

/// What listens above a frequency: frames go in, onsets come out.
pub(super) struct Ear {
    rate: f64,
    start: f64,
    grain: usize,
    /// The power of a rounding of the samples: no noise is less.
    least: f32,
    coefficients: [f64; 3],
    filters: Vec<HighPass>,
    /// The block before, and the one to be judged next.
    blocks: [Block; 2],
    samples: Vec<f32>,
    /// The grain at which the block to be judged begins, and before which no onset is looked for.
    at: usize,
    free: usize,
    pub(super) onsets: Vec<Onset>,
    pub(super) frames: u64,
    /// How many frames have a sample that is as large as can be.
    pub(super) clipped: u64,
}

impl Ear {
    pub(super) fn new(Spec { rate, channels, step }: Spec, start: f64, lowest: f64) -> Self {
        let rate = f64::from(rate);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // rates are from 4000 to 768000
        let grain = (GRAIN * rate).round() as usize;
        Self {
            rate,
            start,
            grain,
            least: step * step / 12.0,
            coefficients: coefficients(lowest, rate),
            filters: vec![HighPass::default(); channels.into()],
            blocks: [Block::default(), Block::default()],
            samples: Vec::with_capacity(BLOCK * grain),
            at: 0,
            free: 0,
            onsets: Vec::new(),
            frames: 0,
            clipped: 0,
        }
    }

    /// Listens to a frame: the power of all channels together, so that none takes another away.
    #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)] // single precision does
    pub(super) fn push(&mut self, frame: &[f32]) {
        let count = self.filters.len() as f64;
        let heard = self.filters.iter_mut().zip(frame).map(|(filter, &x)| filter.next(x.into(), self.coefficients));
        self.samples.push((heard.map(|y| y * y).sum::<f64>() / count).sqrt() as f32);
        self.clipped += u64::from(frame.iter().any(|x| x.abs() >= FULL));
        self.frames += 1;
        if self.samples.len() == BLOCK * self.grain {
            self.turn();
        }
    }

    /// Judges what is left.
    pub(super) fn end(&mut self) {
        self.turn();
        self.turn();
    }

    /// How long the sound is, s.
    #[allow(clippy::cast_precision_loss)] // far below 2^52 frames
    pub(super) fn seconds(&self) -> f64 {
        self.frames as f64 / self.rate
    }

    /// The next block is there: the one before it is judged.
    fn turn(&mut self) {
        let next = Block::of(std::mem::take(&mut self.samples), self.grain, self.least);
        let [last, block] = std::mem::take(&mut self.blocks);
        self.judge(&last, &block, &next);
        self.at += block.power.len();
        self.blocks = [block, next];
    }

    /// Finds the onsets of the middle block.
    fn judge(&mut self, last: &Block, block: &Block, next: &Block) {
        let Some(noise) = [last.noise, block.noise, next.noise].into_iter().flatten().reduce(f32::min) else { return };
        // Of the block before, what is looked at beside the beginning of this one.
        let tail = last.power.len().min(BEFORE + 1);
        let grains = |block: &Block| block.power.len().min(2 * AHEAD);
        let power: Vec<f32> = last.power[last.power.len() - tail..]
            .iter()
            .chain(&block.power)
            .chain(&next.power[..grains(next)])
            .copied()
            .collect();
        let found = self.leaps(&power, tail..tail + block.power.len(), noise);
        let samples: Vec<f32> = last.samples[last.samples.len().saturating_sub(tail * self.grain)..]
            .iter()
            .chain(&block.samples)
            .chain(&next.samples[..grains(next) * self.grain])
            .copied()
            .collect();
        for (k, power) in found {
            let (begins, doubled) = edge(&samples, k * self.grain, self.grain, LOUDEST_NOISE * noise.sqrt());
            #[allow(clippy::cast_precision_loss)] // far below 2^52 frames
            let [from, rise] = [(self.at * self.grain + begins) as f64, (doubled - begins) as f64];
            #[allow(clippy::cast_precision_loss)]
            let time = self.start + (from - (tail * self.grain) as f64) / self.rate;
            let sigma = hypot(0.5 * rise / self.rate, GRAIN / 12.0_f64.sqrt());
            self.onsets.push(Onset { time, sigma, power });
        }
    }

    /// The grains `within` the powers at which sounds begin, and how loud they become. Of two that
    /// begin at one time the much louder one is the sound: a tap through the floor comes before it.
    fn leaps(&mut self, power: &[f32], within: std::ops::Range<usize>, noise: f32) -> Vec<(usize, f32)> {
        let most = |from: usize, to: usize| power[from.min(to)..to].iter().copied().fold(0.0_f32, f32::max);
        let tail = within.start;
        let mut found: Vec<(usize, f32)> = Vec::new();
        for k in within {
            let loud = most(k, (k + AHEAD).min(power.len()));
            let before = most(k.saturating_sub(BEFORE), k).max(noise);
            if loud < RISE * before || power[k] < PART * PART * loud {
                continue;
            }
            let crowded = match found.last() {
                Some(last) => k < last.0 + DEAD,
                None => self.at + k < self.free + tail,
            };
            if crowded {
                let before = found.last().map(|last| last.1).or(self.onsets.last().map(|last| last.power));
                if before.is_none_or(|before| loud <= RISE * before) {
                    continue;
                }
                if found.pop().is_none() {
                    self.onsets.pop();
                }
            }
            found.push((k, loud));
        }
        if let Some((k, _)) = found.last() {
            self.free = (self.at + k + DEAD).saturating_sub(tail);
        }
        found
    }
}

/// Where in the samples a sound begins that begins about `at`, and where it is first twice as large
/// as there: beyond the `noise`, where that is not far below it.
fn edge(samples: &[f32], at: usize, grain: usize, noise: f32) -> (usize, usize) {
    let from = at.saturating_sub(grain);
    let rises = &samples[from..samples.len().min(at + AHEAD * grain)];
    let largest = rises.iter().copied().fold(0.0_f32, f32::max);
    let first = |least: f32| from + rises.iter().position(|&x| x >= least.min(largest)).unwrap_or(0);
    let least = (PART * largest).max(noise);
    (first(least), first(2.0 * least))
}
