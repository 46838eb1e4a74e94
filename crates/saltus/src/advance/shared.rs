//! A step as guards look at it: states on its dense output, made once for all of them.

use smallvec::SmallVec;

use crate::cross::{SAMPLES, sample_times};
use crate::piece::{LONG, horner, horner_each};
use crate::state::State;
use crate::time::Time;

use super::Smooth;

/// The exponent of the largest coordinate of a state that a guard's constant, of an exponent far
/// below it, costs no digits: half of what numbers have, so that the guard is one.
const LARGER: i64 = 511;

/// A step's start, its dense output in powers of time in units of `scale`, and its size, which is
/// that of differences along it.
pub(super) struct Step<'c, S> {
    pub(super) now: Time,
    pub(super) c: &'c [S],
    pub(super) scale: f64,
    pub(super) size: f64,
}

impl<S> Clone for Step<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for Step<'_, S> {}

impl<S: State> Step<'_, S> {
    /// The time `s` after its start.
    pub(super) fn time(&self, s: f64) -> f64 {
        self.now.after(s).seconds()
    }

    /// The state then.
    #[inline(never)] // where guards are searched it is summed up in place
    pub(super) fn at(&self, s: f64) -> S {
        horner(self.c, s / self.scale)
    }
}

/// States on a step at which several guards are asked, made where the first of them asks.
pub(super) struct Shared<'c, S> {
    far: SmallVec<[Far<'c, S>; LONG]>,
    samples: Option<([f64; SAMPLES], [S; SAMPLES])>,
}

impl<'c, S: State> Shared<'c, S> {
    #[inline]
    pub(super) const fn new() -> Self {
        Self { far: SmallVec::new_const(), samples: None }
    }

    /// The coefficients of a dense output from the first power on, each also a power of two larger.
    pub(super) fn far(&mut self, c: &'c [S]) -> &[Far<'c, S>] {
        if self.far.is_empty() {
            self.far.extend(c[1..].iter().map(Far::of));
        }
        &self.far
    }

    /// A guard, asked by time and state, at the times at which a search over a step up to its
    /// `limit` asks first.
    #[inline]
    pub(super) fn values(
        &mut self,
        step: Step<'c, S>,
        limit: f64,
        smooth: Smooth,
        guard: impl Fn(f64, &S) -> f64,
    ) -> [f64; SAMPLES] {
        let (times, states) = self.samples.get_or_insert_with(|| sampled(step, limit, smooth));
        std::array::from_fn(|k| guard(times[k], &states[k]))
    }
}

/// Time and state at the sample times of a step.
#[inline(never)]
fn sampled<S: State>(
    Step { now, c, scale, .. }: Step<'_, S>,
    limit: f64,
    smooth: Smooth,
) -> ([f64; SAMPLES], [S; SAMPLES]) {
    let since = sample_times(0.0, limit);
    let states = horner_each(c, since.map(|s| s / scale));
    (since.map(|s| smooth.within(now.after(s).seconds())), states)
}

/// A state and the same a power of two larger.
pub(super) struct Far<'c, S> {
    x: &'c S,
    /// The size of its largest coordinate.
    size: f64,
    large: S,
}

impl<'c, S: State> Far<'c, S> {
    pub(super) fn of(x: &'c S) -> Self {
        let size = (0..x.len()).fold(0.0, |size: f64, i| size.max(x.get(i).abs()));
        let by = larger(LARGER, size);
        Self { x, size, large: x.with(|i| by * x.get(i)) }
    }

    /// What an affine guard of this `constant` adds to it for the state.
    pub(super) fn less_constant(&self, guard: &dyn Fn(&S) -> f64, constant: f64) -> f64 {
        if self.size == 0.0 {
            return 0.0;
        }
        let far = guard(&self.large) - constant;
        if far.is_finite() {
            let hides = far.abs() < constant.abs();
            return if hides { guard(self.x) - constant } else { far / larger(LARGER, self.size) };
        }
        // A guard that is large itself may have no number there, or a constant beside which this is
        // nothing.
        let by = larger(LARGER / 4, self.size);
        let far = guard(&self.x.with(|i| by * self.x.get(i))) - constant;
        if far.is_finite() && far.abs() >= constant.abs() { far / by } else { guard(self.x) - constant }
    }
}

/// The power of two by which a number of this `size` gets that exponent.
#[inline]
fn larger(exponent: i64, size: f64) -> f64 {
    power_of_two(exponent - exponent_of(size))
}

/// The e of a number from 2ᵉ up to twice that.
#[inline]
fn exponent_of(x: f64) -> i64 {
    (x.to_bits() >> 52 & 0x7ff).cast_signed() - 1023
}

/// 2ᵉ, as far as there is such a number.
#[inline]
fn power_of_two(e: i64) -> f64 {
    f64::from_bits((e.clamp(-1022, 1023) + 1023).cast_unsigned() << 52)
}
