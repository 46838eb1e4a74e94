//! Numbers that carry a Taylor series, and their arithmetic.

use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use super::{MOST_COEFFICIENTS, Pass, Row};

/// A number that carries the Taylor series of a function of time, a₀ + a₁ s + a₂ s² + …
///
/// Has the arithmetic of `f64`, with `f64` on either side of an operator, and the functions that
/// have a recurrence for their series (R. Moore, *Interval Analysis*, 1966, chapter 11; À. Jorba,
/// M. Zou, Experimental Mathematics 14 (2005) 99, doi:10.1080/10586458.2005.10128904). Only a flow
/// that is given to [`Series::flow`](super::Series::flow) meets one.
///
/// ```
/// use saltus::{Hybrid, Jet, Simulation};
///
/// fn drag<'j>(v: Jet<'j>, k: f64) -> Jet<'j> {
///     -k * v * v.abs()
/// }
/// let (g, k) = (9.8, 0.1_f64);
/// let fall = Hybrid::new()
///     .mode("fall", move |_t, v: &f64| -g - k * v * v.abs())
///     .series("fall", move |_t, [v]| [drag(v, k) - g]);
/// let run = Simulation::of(&fall).tolerance(1e-12).run("fall", 0.0, 0.0..2.0)?;
/// // v = -√(g/k) tanh(√(g k) t)
/// assert!((run.end.state + (g / k).sqrt() * ((g * k).sqrt() * 2.0).tanh()).abs() < 1e-11);
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct Jet<'a>(Number<'a>);

#[derive(Clone, Copy)]
enum Number<'a> {
    Constant(f64),
    /// At a place on the tape, in its row.
    Placed(&'a Pass<'a>, usize, &'a Row),
}

use Number::{Constant, Placed};

impl<'a> Jet<'a> {
    #[inline(always)]
    pub(super) fn at(pass: &'a Pass<'a>, place: usize) -> Self {
        Self(Placed(pass, place, pass.row(place)))
    }

    /// The number itself, without its series: what a flow may decide by.
    #[inline]
    #[must_use]
    pub fn value(self) -> f64 {
        self.coefficient(0)
    }

    #[inline(always)]
    pub(super) fn coefficient(self, k: usize) -> f64 {
        match self.0 {
            Constant(a) if k == 0 => a,
            Constant(_) => 0.0,
            Placed(_, _, row) => row[k % MOST_COEFFICIENTS].get(),
        }
    }

    /// `of` the value of a constant; for another number the next place on the tape, whose
    /// coefficient k is `next(k, a, c)`, where a are its coefficients and c those computed so far
    /// of the result.
    #[inline(always)]
    pub(super) fn function(self, of: impl FnOnce(f64) -> f64, next: impl FnOnce(usize, &Row, &Row) -> f64) -> Self {
        match self.0 {
            Constant(a) => of(a).into(),
            Placed(pass, _, a) => Self::next(pass, |k, c| next(k, a, c)),
        }
    }

    /// The same for two numbers, `of` which both are constants, or `left` or `right` alone is.
    #[inline(always)]
    fn operation(
        self,
        other: Self,
        of: impl FnOnce(f64, f64) -> f64,
        left: impl FnOnce(usize, f64, &Row, &Row) -> f64,
        right: impl FnOnce(usize, &Row, f64) -> f64,
        both: impl FnOnce(usize, &Row, &Row, &Row) -> f64,
    ) -> Self {
        match (self.0, other.0) {
            (Constant(a), Constant(b)) => of(a, b).into(),
            (Constant(a), Placed(pass, _, b)) => Self::next(pass, |k, c| left(k, a, b, c)),
            (Placed(pass, _, a), Constant(b)) => Self::next(pass, |k, _| right(k, a, b)),
            (Placed(pass, _, a), Placed(_, _, b)) => Self::next(pass, |k, c| both(k, a, b, c)),
        }
    }

    /// The number at the next place.
    #[inline(always)]
    fn next(pass: &'a Pass<'a>, coefficient: impl FnOnce(usize, &Row) -> f64) -> Self {
        let (place, k) = (pass.next.get(), pass.k % MOST_COEFFICIENTS);
        pass.next.set(place + 1);
        let row = pass.row(place);
        row[k].set(coefficient(k, row));
        Self(Placed(pass, place, row))
    }

    /// |a|: a or -a, whichever is positive just after the present time. A step ends where it would be the other.
    #[inline]
    #[must_use]
    pub fn abs(self) -> Self {
        let Placed(pass, place, a) = self.0 else { return self.value().abs().into() };
        Self::next(pass, |k, c| {
            // The first coefficient that is not zero decides.
            let leading = (0..k).find(|&j| a[j].get() != 0.0);
            let same = match leading {
                Some(j) => c[j] == a[j],
                None => pass.kinks.sign(place, a[k].get()) > 0.0,
            };
            if same { a[k].get() } else { -a[k].get() }
        })
    }

    /// Gives `self` and `other`, which only hold places as yet, their next coefficients
    /// `next(k, a, c, d)`, where a are those of the number `of` which they are functions, c and d
    /// theirs computed so far.
    #[inline]
    pub(super) fn together(self, other: Self, of: Self, next: impl FnOnce(usize, &Row, &Row, &Row) -> (f64, f64)) {
        if let (Placed(pass, _, c), Placed(_, _, d), Placed(_, _, a)) = (self.0, other.0, of.0) {
            let k = pass.k % MOST_COEFFICIENTS;
            let (first, second) = next(k, a, c, d);
            c[k].set(first);
            d[k].set(second);
        }
    }

    #[inline]
    pub(super) fn square(self) -> Self {
        self.function(|a| a * a, |k, a, _| squared(a, k))
    }
}

impl From<f64> for Jet<'_> {
    /// A constant.
    #[inline]
    fn from(value: f64) -> Self {
        Self(Constant(value))
    }
}

impl std::fmt::Debug for Jet<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} + …", self.value())
    }
}

/// Σ aⱼ bₖ₋ⱼ for j from 0 to k.
#[inline]
pub(super) fn product(a: &Row, b: &Row, k: usize) -> f64 {
    convolved(&a[..=k], &b[..=k])
}

/// Σ aⱼ aₖ₋ⱼ for j from 0 to k.
#[inline]
pub(super) fn squared(a: &Row, k: usize) -> f64 {
    let k = k % MOST_COEFFICIENTS;
    if k == 0 {
        return a[0].get() * a[0].get();
    }
    let half = k.div_ceil(2);
    let inner = 2.0 * dot(&a[1..half], &a[k + 1 - half..k]);
    let middle = if k.is_multiple_of(2) { a[k / 2].get() * a[k / 2].get() } else { 0.0 };
    // The latest coefficient comes last, so that nothing else waits for it.
    (inner + middle) + (2.0 * a[0].get()) * a[k].get()
}

/// Σ j aⱼ bₖ₋ⱼ for j from 1 to `last`, which is at most k.
#[inline]
pub(super) fn weighted(a: &Row, b: &Row, last: usize, k: usize) -> f64 {
    let mut sum = 0.0;
    for (j, (a, b)) in a[..=last].iter().zip(b[k - last..=k].iter().rev()).enumerate().skip(1) {
        sum += j as f64 * a.get() * b.get();
    }
    sum
}

/// Σ aⱼ b₋ⱼ, the second list taken from its end. The outermost numbers are the latest: they come
/// last, so that nothing else waits for them.
#[inline]
pub(super) fn convolved(a: &[Cell<f64>], b: &[Cell<f64>]) -> f64 {
    let ([first, inner @ .., last], [start, within @ .., end]) = (a, b) else { return dot(a, b) };
    let (low, high) = inner.split_at(inner.len() / 2);
    let (late, early) = within.split_at(within.len() - low.len());
    (dot(low, early) + dot(high, late)) + (first.get() * end.get() + last.get() * start.get())
}

#[inline]
fn dot(a: &[Cell<f64>], b: &[Cell<f64>]) -> f64 {
    a.iter().zip(b.iter().rev()).fold(0.0, |sum, (a, b)| sum + a.get() * b.get())
}

/// A constant is the first coefficient of its series, and no other.
#[inline]
fn of_constant(k: usize, a: f64) -> f64 {
    if k == 0 { a } else { 0.0 }
}

impl Add for Jet<'_> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.operation(
            other,
            |a, b| a + b,
            |k, a, b, _| if k == 0 { a + b[0].get() } else { b[k].get() },
            |k, a, b| if k == 0 { a[0].get() + b } else { a[k].get() },
            |k, a, b, _| a[k].get() + b[k].get(),
        )
    }
}

impl Sub for Jet<'_> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.operation(
            other,
            |a, b| a - b,
            |k, a, b, _| if k == 0 { a - b[0].get() } else { -b[k].get() },
            |k, a, b| if k == 0 { a[0].get() - b } else { a[k].get() },
            |k, a, b, _| a[k].get() - b[k].get(),
        )
    }
}

impl Mul for Jet<'_> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        if let (Placed(_, a, _), Placed(_, b, _)) = (self.0, other.0)
            && a == b
        {
            return self.square();
        }
        self.operation(
            other,
            |a, b| a * b,
            |k, a, b, _| a * b[k].get(),
            |k, a, b| a[k].get() * b,
            |k, a, b, _| product(a, b, k),
        )
    }
}

impl Div for Jet<'_> {
    type Output = Self;
    /// From a = c b, of which cₖ b₀ is one term.
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let rest = |k: usize, b: &Row, c: &Row| convolved(&c[..k], &b[1..=k]);
        self.operation(
            other,
            |a, b| a / b,
            |k, a, b, c| (of_constant(k, a) - rest(k, b, c)) / b[0].get(),
            |k, a, b| a[k].get() / b,
            |k, a, b, c| (a[k].get() - rest(k, b, c)) / b[0].get(),
        )
    }
}

impl Neg for Jet<'_> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.function(|a| -a, |k, a, _| -a[k].get())
    }
}

/// The same with `f64` on either side, and in place.
macro_rules! mixed {
    ($($operator:ident $method:ident $assign:ident $in_place:ident;)*) => {$(
        impl $operator<f64> for Jet<'_> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                $operator::$method(self, Self::from(other))
            }
        }
        impl<'a> $operator<Jet<'a>> for f64 {
            type Output = Jet<'a>;
            #[inline(always)]
            fn $method(self, other: Jet<'a>) -> Jet<'a> {
                $operator::$method(Jet::from(self), other)
            }
        }
        impl $assign for Jet<'_> {
            #[inline(always)]
            fn $in_place(&mut self, other: Self) {
                *self = $operator::$method(*self, other);
            }
        }
        impl $assign<f64> for Jet<'_> {
            #[inline(always)]
            fn $in_place(&mut self, other: f64) {
                *self = $operator::$method(*self, Self::from(other));
            }
        }
    )*};
}

mixed! {
    Add add AddAssign add_assign;
    Sub sub SubAssign sub_assign;
    Mul mul MulAssign mul_assign;
    Div div DivAssign div_assign;
}
