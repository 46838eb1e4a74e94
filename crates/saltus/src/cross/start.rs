//! What a guard that is zero at the start of an arc does first: the one decision there.

/// What a guard that is zero does first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Move {
    /// It rises, with this slope; with none if a higher derivative decides.
    Rises {
        /// Per second.
        slope: f64,
    },
    /// It falls as the power `order` of time, 1 to 3: an odd one leads through zero, an even one
    /// has only touched it.
    Falls {
        /// The first derivative that is not zero.
        order: usize,
    },
    /// No derivative is beyond its noise: it stays.
    Stays,
}

/// Noise is a bound for roundings that add up by chance to a fraction of it, and for a handful of
/// operations within the guard itself: so many times as much decides.
pub(crate) const BEYOND_NOISE: f64 = 8.0;
/// Each stretch looked at is this part of the one before.
const SHORTER: f64 = 1.0 / 8.0;
/// Stretches looked at: from the longest down to 2⁻⁵⁷ of it, below which numbers are stairs.
const STRETCHES: i32 = 19;

/// Derivative k at the start of a stretch, times (stretch / 4)ᵏ, from the changes of the guard after
/// each quarter of it: the weights of a polynomial of degree four, and of the one of degree three
/// through the first three of them, whose difference bounds what both leave out (B. Fornberg,
/// Math. Comp. 51 (1988) 699, doi:10.1090/S0025-5718-1988-0935077-0).
const WEIGHTS: [[[f64; 4]; 2]; 3] = [
    [[4.0, -3.0, 4.0 / 3.0, -0.25], [3.0, -1.5, 1.0 / 3.0, 0.0]],
    [[-26.0 / 3.0, 9.5, -14.0 / 3.0, 11.0 / 12.0], [-5.0, 4.0, -1.0, 0.0]],
    [[9.0, -12.0, 7.0, -1.5], [3.0, -3.0, 1.0, 0.0]],
];

/// What the guard does first: the first derivative along the flow decides that is beyond its noise.
///
/// Each derivative is taken over ever longer stretches, up to `longest`. A stretch bounds it on both
/// sides, by the `noise` of the guard's values over the stretch and by what its polynomial leaves
/// out: a short one is wide for the first, a long one for the second. The bounds of all stretches
/// hold together, until a longer one contradicts the shorter ones: it reaches too far. Last, the
/// noise of the start itself moves a derivative, by `doubt(weights, stretch)` of the changes over
/// quarters of the stretch that bounds it best.
///
/// # Errors
/// That of `changes`.
pub(crate) fn first_move<E>(
    longest: f64,
    mut changes: impl FnMut(f64) -> Result<[f64; 4], E>,
    noise: impl Fn(&[f64; 4]) -> f64,
    mut doubt: impl FnMut(&[f64; 4], f64) -> f64,
) -> Result<Move, E> {
    let mut stretch = longest * SHORTER.powi(STRETCHES);
    let mut bounds = [Bounds::NONE; 3];
    for _ in 0..=STRETCHES {
        let changes = changes(stretch)?;
        if changes.iter().all(|change| change.is_finite()) {
            let noise = noise(&changes);
            for (bounds, weights) in bounds.iter_mut().zip(&WEIGHTS) {
                bounds.narrow(stretch, &changes, noise, weights);
            }
        }
        stretch /= SHORTER;
        for (k, bounds) in bounds.iter_mut().enumerate() {
            bounds.lengthen((1.0 / SHORTER).powi(k as i32 + 1));
        }
    }
    for (k, bounds) in bounds.into_iter().enumerate() {
        let scale = SHORTER.powi(k as i32 + 1);
        if let Some((best, low, high)) = bounds.off_zero() {
            let widths = (stretch * SHORTER / best).powi(k as i32 + 1);
            let doubt = BEYOND_NOISE * doubt(&WEIGHTS[k][0], best) * widths / scale;
            if low > doubt {
                return Ok(Move::Rises { slope: if k == 0 { 2.0 * (low + high) / stretch } else { 0.0 } });
            }
            if high < -doubt {
                return Ok(Move::Falls { order: k + 1 });
            }
        }
    }
    Ok(Move::Stays)
}

/// What stretches show of a derivative.
#[derive(Clone, Copy)]
struct Bounds {
    low: f64,
    high: f64,
    /// The stretch that bounds it best.
    best: f64,
    contradicted: bool,
}

impl Bounds {
    const NONE: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY, best: 0.0, contradicted: false };

    /// Takes what a stretch shows.
    fn narrow(&mut self, stretch: f64, changes: &[f64; 4], noise: f64, [weights, fewer]: &[[f64; 4]; 2]) {
        let sum = |weights: &[f64; 4]| weights.iter().zip(changes).map(|(w, c)| w * c).sum::<f64>();
        let (value, rough) = (sum(weights), sum(fewer));
        let amplified: f64 = weights.iter().map(|w| w.abs()).sum::<f64>() + weights.iter().sum::<f64>().abs();
        let off = BEYOND_NOISE * noise * amplified + 2.0 * (value - rough).abs();
        let (low, high) = (value - off, value + off);
        if self.contradicted || low > self.high || high < self.low {
            self.contradicted = true;
            return;
        }
        if high - low < self.high - self.low {
            self.best = stretch;
        }
        (self.low, self.high) = (self.low.max(low), self.high.min(high));
    }

    /// The same derivative in units of a stretch whose power is `by` times as large.
    fn lengthen(&mut self, by: f64) {
        (self.low, self.high) = (self.low * by, self.high * by);
    }

    /// The bounds, if they are on one side of zero, and the stretch that shows it best.
    fn off_zero(&self) -> Option<(f64, f64, f64)> {
        (self.low > 0.0 || self.high < 0.0).then_some((self.best, self.low, self.high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of(guard: impl Fn(f64) -> f64, longest: f64, noise: f64) -> Move {
        let changes = |h: f64| Ok::<_, ()>([0.25, 0.5, 0.75, 1.0].map(|part| guard(part * h) - guard(0.0)));
        first_move(longest, changes, |_| noise, |_, _| 0.0).unwrap()
    }

    #[test]
    fn the_first_derivative_that_is_not_zero_decides() {
        assert!(matches!(of(|s| s - 5.0 * s * s, 1.0, 1e-16), Move::Rises { slope } if (slope - 1.0).abs() < 1e-9));
        assert_eq!(of(|s| -s.sin(), 10.0, 1e-16), Move::Falls { order: 1 });
        assert_eq!(of(|s| -4.9 * s * s + s * s * s, 1.0, 1e-16), Move::Falls { order: 2 });
        assert_eq!(of(|s| -s * s * s, 1.0, 1e-16), Move::Falls { order: 3 });
        assert_eq!(of(|s| (3.0 * s).sin() - 3.0 * s, 1.0, 1e-16), Move::Falls { order: 3 });
        assert_eq!(of(|_| 0.0, 1.0, 1e-16), Move::Stays);
    }

    #[test]
    fn noise_decides_nothing() {
        let rough = |s: f64| if s == 0.0 { 0.0 } else { 1e-16 * (s.to_bits() as f64).sin() };
        assert_eq!(of(rough, 1.0, 1e-16), Move::Stays);
        assert_eq!(of(|s| rough(s) - 1e-9 * s, 1.0, 1e-16), Move::Falls { order: 1 });
    }

    proptest! {
        /// A rise is found however short it is beside the fall that follows, as long as its slope is
        /// beyond noise at some stretch.
        #[test]
        fn a_low_hop_rises(speed in 1e-7..1.0_f64, pull in 0.1..100.0_f64, longest in 0.01..10.0_f64) {
            let rises = of(|s| s * (speed - pull * s), longest, 1e-17);
            prop_assert!(matches!(rises, Move::Rises { slope } if (slope / speed - 1.0).abs() < 0.5), "{rises:?}");
            prop_assert_eq!(of(|s| -s * (speed - pull * s), longest, 1e-17), Move::Falls { order: 1 });
        }

        /// Stairs of time, wherever the first one ends: a simple fall is simple.
        #[test]
        fn stairs_of_time(t in 1.0..1000.0_f64, omega in 0.1..10.0_f64) {
            let wave = |s: f64| -(omega * ((t + s) - t)).sin();
            prop_assert_eq!(of(wave, 1.0 / omega, omega * f64::EPSILON * t), Move::Falls { order: 1 });
        }
    }
}
