//! Which way a series of heights counts: flights are round on the side that is up, and pointed at
//! the floor.

use crate::statistics::median;

/// Samples this far apart are compared; where noise hides the bends, twice as far, and so on up to
/// one in so many of the series.
const STRIDE: usize = 2;
const FARTHEST: usize = 40;
/// The part of the bends that must agree, and how many at least.
const AGREE: f64 = 0.65;
const FEWEST: usize = 3;
/// A ball that moves by less than this part of the range, or this many times the noise, between two
/// samples has no bend to tell.
const MOVES: f64 = 0.02;
const NOISE: f64 = 4.0;

/// The standard deviation of noise, by the median of third differences: they take a parabola away.
pub(crate) fn noise_by_thirds(times: &[f64], heights: &[f64]) -> f64 {
    let mut steps: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
    let Some(usual) = median(&mut steps) else { return 0.0 };
    let even = |w: &[f64]| w.windows(2).all(|p| (p[1] - p[0] - usual).abs() < 0.2 * usual);
    let mut thirds: Vec<f64> = times
        .windows(4)
        .zip(heights.windows(4))
        .filter(|(t, _)| even(t))
        .map(|(_, h)| (h[3] - 3.0 * h[2] + 3.0 * h[1] - h[0]).abs())
        .collect();
    // Var(third difference) = 20 σ²; 1.4826 turns a median of absolute values into a standard
    // deviation.
    median(&mut thirds).map_or(0.0, |m| 1.4826 * m / 20f64.sqrt())
}

/// Whether the ball falls towards greater heights in these recordings, each its times and heights;
/// `None` where they do not tell.
pub(crate) fn falls_upwards(recordings: &[(Vec<f64>, Vec<f64>)]) -> Option<bool> {
    let longest = recordings.iter().map(|r| r.0.len()).max().unwrap_or(0);
    // What lies still bends by its noise alone; but wild samples look like noise.
    let noise: Vec<f64> = recordings.iter().map(|(t, h)| NOISE * noise_by_thirds(t, h)).collect();
    [noise, vec![0.0; recordings.len()]].iter().find_map(|noise| {
        let farther = std::iter::successors(Some(STRIDE), |stride| Some(2 * stride));
        let mut strides = farther.take_while(|&stride| stride == STRIDE || FARTHEST * stride <= longest);
        strides.find_map(|stride| {
            let votes =
                recordings.iter().zip(noise).map(|((times, heights), noise)| bends(times, heights, stride, *noise));
            let (up, down) = votes.fold((0, 0), |(up, down), (a, b)| (up + a, down + b));
            #[allow(clippy::cast_precision_loss)] // counts of samples
            let agree = |part: usize| part >= FEWEST && part as f64 >= AGREE * (up + down) as f64;
            if agree(down) { Some(true) } else { agree(up).then_some(false) }
        })
    })
}

/// How often a series bends downwards, as flights do, and upwards; only where the ball moves by
/// more than `least`.
fn bends(times: &[f64], heights: &[f64], stride: usize, least: f64) -> (usize, usize) {
    let (low, high) = heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &y| (l.min(y), h.max(y)));
    let moves = (MOVES * (high - low)).max(least);
    let (mut flights, mut others) = (0, 0);
    for (t, h) in times.windows(2 * stride + 1).zip(heights.windows(2 * stride + 1)) {
        let (before, after) = (h[stride] - h[0], h[2 * stride] - h[stride]);
        if before.abs().max(after.abs()) > moves {
            let (a, b) = (before * (t[2 * stride] - t[stride]), after * (t[stride] - t[0]));
            flights += usize::from(a > b);
            others += usize::from(a < b);
        }
    }
    (flights, others)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A drop from 0.8 m, three bounces at 0.7, then at rest to the end, with a scatter of `noise`.
    fn recording(samples: u32, noise: f64) -> (Vec<f64>, Vec<f64>) {
        let mut state = 7u64;
        let mut normal = move || {
            let mut uniform = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 40) as f64 / (1u64 << 24) as f64 - 0.5
            };
            (0..12).map(|_| uniform()).sum::<f64>()
        };
        let height = |t: f64| {
            let fall = (1.6f64 / 9.81).sqrt();
            let (mut from, mut lasts) = (fall, 2.0 * 0.7 * fall);
            if t < fall {
                return 0.8 - 0.5 * 9.81 * t * t;
            }
            for _ in 0..3 {
                if t < from + lasts {
                    return 0.5 * 9.81 * (t - from) * (from + lasts - t);
                }
                (from, lasts) = (from + lasts, 0.7 * lasts);
            }
            0.0
        };
        let times: Vec<f64> = (0..samples).map(|n| f64::from(n) / 60.0).collect();
        let heights = times.iter().map(|&t| height(t) + noise * normal()).collect();
        (times, heights)
    }

    #[test]
    fn a_ball_at_rest_does_not_outvote_its_flights() {
        for (samples, noise) in [(100, 0.0), (180, 0.015), (240, 0.01)] {
            let (times, heights) = recording(samples, noise);
            let turned: Vec<f64> = heights.iter().map(|h| -h).collect();
            assert_eq!(falls_upwards(&[(times.clone(), heights)]), Some(false), "{samples} {noise}");
            assert_eq!(falls_upwards(&[(times, turned)]), Some(true), "{samples} {noise}");
        }
    }

    #[test]
    fn a_straight_line_does_not_tell() {
        let times: Vec<f64> = (0..50).map(f64::from).collect();
        assert_eq!(falls_upwards(&[(times.clone(), times)]), None);
    }
}
