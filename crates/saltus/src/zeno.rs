//! Zeno: when the times between jumps shrink so that infinitely many fit before a limit.

use crate::time::resolution;

/// How many durations are remembered.
const MEMORY: usize = 16;
/// The longest repeating pattern of jumps looked for.
const LONGEST_CYCLE: usize = 4;

/// A duration that is this part of the time elapsed is far from the time's resolution.
const FAR: f64 = 1e6 * f64::EPSILON;
/// A ratio of durations that rounding has not brought below one.
const CLEARLY_BELOW_ONE: f64 = 0.995;

/// Ratios of durations are of one contraction if they differ by no more than this: one that is far below the others is of jumps that rounding keeps from being at
/// one time.
const ALIKE: f64 = 1e-3;

/// Watches the durations between jumps for geometric contraction.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Contraction {
    durations: [f64; MEMORY],
    count: usize,
}

impl Contraction {
    pub(crate) const fn new() -> Self {
        Self { durations: [0.0; MEMORY], count: 0 }
    }

    /// Adds the time since the last jump; jumps at one time are one instant and add nothing.
    #[inline]
    pub(crate) fn push(&mut self, duration: f64) {
        if duration == 0.0 {
            return;
        }
        self.durations[self.count % MEMORY] = duration;
        self.count += 1;
    }

    /// The duration `back` jumps ago, 0 for the last one.
    fn last(&self, back: usize) -> f64 {
        self.durations[(self.count - 1 - back) % MEMORY]
    }

    /// The time from the last jump to the limit, if the durations contract and the next one is shorter than the resolution of the time `elapsed`.
    ///
    /// With a cycle of p jumps the certificate is that the last four ratios d(n)/d(n-p) are alike and all below one; with r the largest
    /// of them and S the last cycle's duration, what remains is at most S r/(1-r).
    ///
    /// Where rounding spoils the durations (`hidden`) before they are as short as that, nothing better can be had later:
    /// the ratios decide if they are clearly below one.
    #[inline]
    pub(crate) fn remaining(&self, elapsed: f64, hidden: bool) -> Option<f64> {
        if self.count == 0 || self.last(0) > FAR * elapsed && !hidden {
            None
        } else if hidden {
            self.certified(f64::INFINITY, CLEARLY_BELOW_ONE)
        } else {
            self.certified(resolution(elapsed), 1.0)
        }
    }

    fn certified(&self, resolution: f64, most: f64) -> Option<f64> {
        let known = self.count.min(MEMORY);
        let bound = |cycle| {
            if known < cycle + 4 {
                return None;
            }
            let ratios = (0..4.max(cycle)).filter(|i| i + cycle < known).map(|i| self.last(i) / self.last(i + cycle));
            let (least, ratio) = ratios.fold((f64::INFINITY, 0.0_f64), |(low, high), r| (low.min(r), high.max(r)));
            if least < ALIKE * ratio {
                return None;
            }
            let last_cycle: f64 = (0..cycle).map(|i| self.last(i)).sum();
            let longest = (0..cycle).map(|i| self.last(i)).fold(0.0, f64::max);
            (ratio < most && longest * ratio < resolution).then(|| last_cycle * ratio / (1.0 - ratio))
        };
        // Each is an upper bound: rise and fall of a ball differ by a rounding, and as a cycle of one would seem to hardly contract.
        (1..=LONGEST_CYCLE).filter_map(bound).reduce(|best, next| if next < 0.5 * best { next } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A time whose resolution is 1e-12 s.
    const LATE: f64 = 5000.0;

    #[test]
    fn a_geometric_series_is_summed() {
        let mut contraction = Contraction::new();
        let mut d = 1.0;
        let mut sum = 0.0;
        while contraction.remaining(LATE, false).is_none() {
            contraction.push(d);
            sum += d;
            d *= 0.8;
        }
        assert!((sum + contraction.remaining(LATE, false).unwrap() - 5.0).abs() < 1e-14);
    }

    #[test]
    fn a_harmonic_series_is_not_zeno() {
        let mut contraction = Contraction::new();
        for n in 1..100_000 {
            contraction.push(1e-3 / f64::from(n));
            assert_eq!(contraction.remaining(LATE, false), None);
        }
    }

    #[test]
    fn a_cascade_is_not_zeno() {
        let mut contraction = Contraction::new();
        for duration in [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] {
            contraction.push(duration);
            assert_eq!(contraction.remaining(LATE, false), None);
        }
    }

    #[test]
    fn jumps_that_are_all_but_at_one_time_are_not_zeno() {
        // Swings of one length but for rounding, and two collisions a rounding apart.
        let mut contraction = Contraction::new();
        for duration in [1.0, 1.0_f64.next_down(), 0.9, 0.1, 1e-17] {
            contraction.push(duration);
            assert_eq!(contraction.remaining(LATE, false), None);
        }
    }

    #[test]
    fn a_cycle_of_two_contracts_as_a_whole() {
        let mut contraction = Contraction::new();
        let mut d = 1.0;
        let mut sum = 0.0;
        for _ in 0..60 {
            for part in [d, 3.0 * d] {
                contraction.push(part);
                sum += part;
            }
            d *= 0.5;
            if let Some(rest) = contraction.remaining(LATE, false) {
                assert!((sum + rest - 8.0).abs() < 1e-12);
                return;
            }
        }
        panic!("not recognised");
    }
}
