//! How long the next step may be, from the estimated errors of the last ones.

use crate::state::State;
use crate::step::Stepper;

/// Local error allowed per step: in coordinate i, absolute + relative · max(|xᵢ| before, |xᵢ|
/// after).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tolerance {
    pub(crate) relative: f64,
    pub(crate) absolute: f64,
}

impl Tolerance {
    /// What is allowed in a coordinate of these values.
    #[inline]
    pub(crate) const fn allowed(&self, before: f64, after: f64) -> f64 {
        self.absolute + self.relative * before.abs().max(after.abs())
    }

    /// The mean square of the error in units of what is allowed; at most 1 is good.
    #[inline]
    pub(crate) fn square<S: State>(&self, error: &S, before: &S, after: &S) -> f64 {
        let mut sum = 0.0;
        for i in 0..error.len() {
            let ratio = error.get(i) / self.allowed(before.get(i), after.get(i));
            sum += ratio * ratio;
        }
        #[allow(clippy::cast_precision_loss)]
        let count = error.len().max(1) as f64;
        sum / count
    }

    /// Its root.
    pub(crate) fn norm<S: State>(&self, error: &S, before: &S, after: &S) -> f64 {
        self.square(error, before, after).sqrt()
    }
}

/// A PI controller (E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, IV.2; K.
/// Gustafsson, ACM TOMS 17 (1991) 533), or one that predicts how the error will go on changing and
/// is no bolder than without memory (IV.8; K. Gustafsson, ACM TOMS 20 (1994) 496).
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Controller {
    /// The power of h with which the square of the error shrinks.
    order: f64,
    predictive: bool,
    /// The logarithm of the square of the error accepted last, and the step it was made with.
    previous: f64,
    step: f64,
    rejected: bool,
}

impl Controller {
    const SAFETY: f64 = 0.9;
    pub(crate) const SMALLEST: f64 = 0.2;
    const LARGEST: f64 = 10.0;
    /// The logarithm of the square of 1e-4, below which an error is not remembered.
    const LEAST: f64 = -18.420_680_743_952_367;

    pub(crate) fn new<M: Stepper>(stepper: &M) -> Self {
        let order = 2.0 * stepper.error_order();
        Self { order, predictive: stepper.predictive(), previous: Self::LEAST, step: 0.0, rejected: false }
    }

    /// By which factor to change the step `h` after an error of this `square`, and whether to
    /// accept it: never where it is no number.
    #[inline]
    pub(crate) fn judge(&mut self, square: f64, h: f64) -> (bool, f64) {
        if square <= 1.0 {
            let error = square.max(1e-20).ln();
            let factor = if self.predictive {
                let plain = (-error / self.order).exp();
                if self.step > 0.0 {
                    plain.min(h / self.step * ((self.previous - 2.0 * error) / self.order).exp())
                } else {
                    plain
                }
            } else {
                ((0.4 * self.previous - 0.7 * error) / self.order).exp()
            };
            self.previous = error.max(Self::LEAST);
            self.step = h;
            let most = if self.rejected { 1.0 } else { Self::LARGEST };
            self.rejected = false;
            (true, (Self::SAFETY * factor).clamp(Self::SMALLEST, most))
        } else {
            self.rejected = true;
            let factor =
                if square.is_finite() { Self::SAFETY * (-square.ln() / self.order).exp() } else { Self::SMALLEST };
            (false, factor.clamp(Self::SMALLEST, Self::SAFETY))
        }
    }
}

/// A first step size from the scale of the solution and of its first two derivatives
/// (E. Hairer, S. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*, II.4).
pub(crate) fn first_step<S: State>(
    mut flow: impl FnMut(f64, &S) -> S,
    t: f64,
    x: &S,
    slope: &S,
    tolerance: &Tolerance,
    order: f64,
    longest: f64,
) -> f64 {
    let size = tolerance.norm(x, x, x);
    let speed = tolerance.norm(slope, x, x);
    // A speed that is beyond numbers, in what the tolerance allows, tells no step either.
    let measured = size >= 1e-5 && (1e-5..f64::INFINITY).contains(&speed);
    let guess = if measured { 0.01 * size / speed } else { 1e-6 }.min(longest);
    let ahead = x.with(|i| x.get(i) + guess * slope.get(i));
    let bent = flow(t + guess, &ahead);
    let bend = tolerance.norm(&x.with(|i| bent.get(i) - slope.get(i)), x, x) / guess;
    let most = speed.max(bend);
    let h = if most <= 1e-15 { (guess * 1e-3).max(1e-6) } else { (0.01 / most).powf(1.0 / order) };
    let h = h.min(100.0 * guess).min(longest);
    if h.is_finite() && h > 0.0 { h } else { guess }
}
