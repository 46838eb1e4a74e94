//! A long dense output summed up once near a crossing.

use crate::certainty::MINUTE;
use crate::piece::horner;
use crate::poly::value_and_slope;
use crate::state::State;

/// A state on a dense output after a time, and its slope there: all that counts within rounding of
/// it.
#[derive(Clone)]
pub(super) struct Near<S> {
    pub(super) s: f64,
    pub(super) state: S,
    pub(super) slope: S,
}

impl<S: State> Near<S> {
    #[inline(never)] // once for each kind of state, not for each model and stepper
    pub(super) fn around(c: &[S], scale: f64, s: f64) -> Self {
        let (u, per_second) = (s / scale, 1.0 / scale);
        let mut slope = c[0].clone();
        let state = c[0].with(|i| {
            let (value, rate) = value_and_slope(c, |c| c.get(i), u);
            slope = slope.with(|j| if i == j { rate * per_second } else { slope.get(j) });
            value
        });
        Self { s, state, slope }
    }

    /// The state after a time `s` on the same dense output.
    #[inline]
    pub(super) fn at(&self, c: &[S], scale: f64, s: f64) -> S {
        let by = s - self.s;
        if by.abs() > MINUTE * self.s {
            return Self::far(c, s / scale);
        }
        self.state.with(|i| self.state.get(i) + by * self.slope.get(i))
    }

    #[cold]
    #[inline(never)]
    fn far(c: &[S], u: f64) -> S {
        horner(c, u)
    }

    /// The same around another time within rounding.
    #[inline]
    pub(super) fn moved(&self, c: &[S], scale: f64, s: f64) -> Self {
        Self { s, state: self.at(c, scale, s), slope: self.slope.clone() }
    }
}
