//! A sound as it is drawn: the lowest and the highest sample of each of some thousand stretches.

/// The most stretches: about one for each pixel of a wide picture.
const MOST: usize = 2048;

/// The lowest and the highest sample of stretches of equal length, in order.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Wave {
    /// When the first stretch begins, s.
    pub start: f64,
    /// How long a stretch is, s.
    pub step: f64,
    /// Lowest and highest of each, from -1 to 1.
    pub stretches: Vec<[f32; 2]>,
}

/// Samples put together to stretches, which grow as there are more.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    stretches: Vec<[f32; 2]>,
    /// Samples in a stretch, and in the last one.
    each: u64,
    last: u64,
}

impl Drawn {
    pub(super) const fn new() -> Self {
        Self { stretches: Vec::new(), each: 1, last: 1 }
    }

    /// Adds a frame: the mean of its channels.
    #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)] // single precision does
    pub(super) fn frame(&mut self, frame: &[f32]) {
        self.push((frame.iter().map(|&x| f64::from(x)).sum::<f64>() / frame.len() as f64) as f32);
    }

    fn push(&mut self, sample: f32) {
        if self.last == self.each {
            if self.stretches.len() == MOST {
                self.stretches = self.stretches.chunks(2).map(|pair| joined(pair[0], pair[pair.len() - 1])).collect();
                self.each *= 2;
            }
            self.stretches.push([sample; 2]);
            self.last = 1;
        } else if let Some(stretch) = self.stretches.last_mut() {
            *stretch = joined(*stretch, [sample; 2]);
            self.last += 1;
        }
    }

    #[allow(clippy::cast_precision_loss)] // far below 2^52 samples
    pub(super) fn wave(self, start: f64, rate: f64) -> Wave {
        Wave { start, step: self.each as f64 / rate, stretches: self.stretches }
    }
}

fn joined(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot go on has failed

    use super::*;

    #[test]
    fn however_long_a_sound_is_its_extremes_are_kept_where_they_are() {
        for count in [1_u32, 2047, 2048, 2049, 4096, 4097, 1_000_003] {
            let mut drawn = Drawn::new();
            let at = count * 2 / 3;
            (0..count).for_each(|k| drawn.push(if k == at { 0.9 } else { -0.1 }));
            let wave = drawn.wave(2.0, 1000.0);
            assert!(
                wave.stretches.len() <= MOST && wave.stretches.len() as f64 * wave.step * 1000.0 >= f64::from(count)
            );
            let highest = wave.stretches.iter().position(|[_, high]| *high == 0.9).unwrap();
            let [from, to] = [highest, highest + 1].map(|n| n as f64 * wave.step * 1000.0);
            assert!((from..to).contains(&f64::from(at)), "{count}: {from} {to}");
        }
    }
}
