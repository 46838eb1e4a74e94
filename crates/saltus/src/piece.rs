//! A stretch of an arc on which the state is one polynomial in time.

use std::array;

use crate::poly::value_and_slope;
use crate::state::State;
use crate::time::Time;

/// Σ cₖ sᵏ, coordinate by coordinate.
#[inline(always)]
pub(crate) fn horner<S: State>(coefficients: &[S], s: f64) -> S {
    match coefficients {
        [c0, c1, c2] => c0.with(|i| (c2.get(i) * s + c1.get(i)) * s + c0.get(i)),
        _ if coefficients.len() > LONG => coefficients[0].with(|i| value_and_slope(coefficients, |c| c.get(i), s).0),
        _ => {
            let [x] = summed(coefficients, [s]);
            x
        }
    }
}

/// The same at several times.
#[inline]
pub(crate) fn horner_each<S: State, const K: usize>(coefficients: &[S], times: [f64; K]) -> [S; K] {
    if coefficients.len() > LONG { times.map(|s| horner(coefficients, s)) } else { summed(coefficients, times) }
}

/// Power by power, side by side: no coordinate and no time waits for itself.
#[inline(always)]
fn summed<S: State, const K: usize>(coefficients: &[S], times: [f64; K]) -> [S; K] {
    let last = coefficients.len() - 1;
    let mut sums: [S; K] = array::from_fn(|_| coefficients[last].clone());
    for c in coefficients[..last].iter().rev() {
        for (sum, s) in sums.iter_mut().zip(times) {
            *sum = c.with(|i| sum.get(i) * s + c.get(i));
        }
    }
    sums
}

/// More coefficients than any stepper's dense output has.
pub(crate) const LONG: usize = 9;

/// A stretch of an arc on which the state is one polynomial in time: a step, or a whole arc that is
/// solved exactly.
///
/// ```
/// use saltus::{Hybrid, Simulation};
/// let decay = Hybrid::new().mode("decay", |_t, x: &f64| -x);
/// let run = Simulation::of(&decay).run("decay", 1.0, 0.0..1.0)?;
/// let pieces: Vec<_> = run.trajectory.pieces(0).collect();
/// let last = pieces.last().unwrap();
/// assert!((last.start().seconds() + last.span() - 1.0).abs() < 1e-15);
/// assert!((last.at(last.span()) - (-1.0_f64).exp()).abs() < 1e-9);
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Debug)]
pub struct Piece<'a, S> {
    start: Time,
    span: f64,
    scale: f64,
    coefficients: &'a [S],
}

impl<S> Clone for Piece<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for Piece<'_, S> {}

impl<'a, S: State> Piece<'a, S> {
    pub(crate) fn new(start: Time, span: f64, scale: f64, coefficients: &'a [S]) -> Self {
        Self { start, span, scale, coefficients }
    }

    /// When the piece starts.
    #[must_use]
    pub const fn start(&self) -> Time {
        self.start
    }

    /// How long it lasts, in seconds.
    #[must_use]
    pub const fn span(&self) -> f64 {
        self.span
    }

    /// The state a time `s` after the start, for 0 ≤ s ≤ span.
    #[inline]
    #[must_use]
    pub fn at(&self, s: f64) -> S {
        horner(self.coefficients, s / self.scale)
    }

    /// The coefficients cₖ of x = Σ cₖ ((t - start)/scale)ᵏ.
    #[must_use]
    pub const fn coefficients(&self) -> &'a [S] {
        self.coefficients
    }

    /// The time unit of the coefficients, in seconds: the step's size, or 1 where the flow is
    /// solved exactly.
    #[must_use]
    pub const fn scale(&self) -> f64 {
        self.scale
    }
}
