//! A fall that is isolated, narrowed to neighbouring numbers.

use super::probe::{AT_START, Search};
use super::{Crossing, Doubt, Evidence, Undefined};
use crate::certainty::{FAR, FEW, MINUTE};

/// The fall close to `near`, a root exact but for rounding, between neighbouring numbers.
pub(crate) fn settle(mut guard: impl FnMut(f64) -> f64, near: f64) -> Option<Crossing> {
    // Where rounding hides the guard's sign all around, the given root decides: a ball does
    // not fall through a floor at height one.
    let known = Crossing::after(near);
    let mut step = near.next_up() - near;
    let (mut a, mut b) = (near, near);
    if guard(near) >= 0.0 {
        loop {
            b = a + step;
            if guard(b) < 0.0 {
                break;
            }
            a = b;
            step *= 2.0;
            if b > 2.0 * near {
                return Some(known);
            }
        }
    } else {
        loop {
            a = (b - step).max(0.0);
            if guard(a) >= 0.0 {
                break;
            }
            if a == 0.0 {
                return Some(known);
            }
            b = a;
            step *= 2.0;
        }
    }
    let (a, b) = neighbours(guard, a, b);
    Some(Crossing { inside: a, outside: b, root: near, rest: 0.0, leaps: false })
}

/// Neighbouring numbers within `a..b` between which the guard falls, not negative at `a` and
/// negative at `b`.
pub(crate) fn neighbours(mut guard: impl FnMut(f64) -> f64, mut a: f64, mut b: f64) -> (f64, f64) {
    while a.next_up() < b {
        let middle = 0.5 * (a + b);
        if guard(middle) >= 0.0 { a = middle } else { b = middle }
    }
    (a, b)
}

/// How a guard comes from one side of zero to the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passage {
    /// Through zero: the nearer, the smaller it is.
    Root,
    /// Through infinity: the nearer, the larger it is.
    Pole,
    /// At once, from one value to another.
    Leap,
}

/// How often a fall is looked for around its guess.
const TRIES: usize = 4;

impl Search<'_> {
    /// How the guard changes its sign at a crossing between neighbouring times, by so much; what is
    /// no root is noted.
    pub(super) fn passage(&mut self, &(Crossing { inside, outside, .. }, near): &(Crossing, f64)) -> Passage {
        if near.is_finite() && near <= MINUTE * self.largest {
            return Passage::Root;
        }
        // A root of up to the fourth order has grown fourfold there, and what comes from a pole of
        // the order 1/5 and higher has shrunk as much.
        let by = FAR * (outside - inside).max(self.tick);
        let (before, after) = ((inside - by).max(0.0), outside + by);
        let far = (self.guard)(before).abs() + (self.guard)(after).abs();
        let passage = if near == f64::INFINITY || FEW * far < near && self.largest < FEW * near {
            // Nowhere near its largest, what shrinks so fast is rounding.
            Passage::Pole
        } else if far > FEW * near {
            Passage::Root
        } else {
            Passage::Leap
        };
        if passage != Passage::Root {
            self.weaken(Evidence::doubtful(Doubt::Discontinuous, before, after));
        }
        passage
    }

    /// The fall in `[a, b]`, where the guard is inside at `a` but for rounding, and close to a
    /// `guess` if there is one; and by how much the guard changes there.
    pub(super) fn refined(&mut self, a: f64, b: f64, guess: Option<f64>) -> Result<(Crossing, f64), Undefined> {
        if let Some(guess) = guess
            && let Some([inside, outside]) = self.around(guess, a, b)?
        {
            return self.narrowed(inside, outside);
        }
        let (mut a, mut b) = (a, b);
        let start = self.start()?;
        let leaves = a == 0.0 && (self.spent || start == 0.0 && self.rises_first(b)?);
        if a == 0.0 && !leaves && start >= 0.0 {
            let first = self.value(self.span * AT_START)?;
            if first < 0.0 {
                b = self.span * AT_START;
                if start == 0.0 {
                    return Ok((Crossing::at_start(b), -first));
                }
            }
        }
        if leaves {
            // Rounding may leave the guard negative at a root that it rises from, and after it:
            // begin where it has risen.
            a = 0.5 * b;
            loop {
                let value = self.value(a)?;
                if value > 0.0 {
                    break;
                }
                if a <= b * AT_START {
                    return Ok((Crossing::at_start(a), start.abs() - value));
                }
                a *= 0.5;
            }
            let mut ahead = 2.0 * a;
            while ahead < b && self.value(ahead)? >= 0.0 {
                a = ahead;
                ahead *= 2.0;
            }
            b = ahead.min(b);
        }
        let (above, below) = (self.value(a)?.max(0.0), self.value(b)?);
        self.narrowed((a, above), (b, below))
    }

    /// Two times close to a `guess` of the only fall in `[a, b]` between which the guard falls, and
    /// its values there; nothing if these are not found at once.
    fn around(&mut self, guess: f64, a: f64, b: f64) -> Result<Option<[(f64, f64); 2]>, Undefined> {
        let mut near = (guess, self.value(guess)?);
        let end = self.value(b)?;
        let towards = if near.1 >= 0.0 { 1.0 } else { -1.0 };
        let mut by = (2.0 * near.1 * (b - guess) / end).abs().max(FEW * (guess.next_up() - guess));
        for _ in 0..TRIES {
            let s = guess + towards * by;
            if s <= a || s >= b {
                break;
            }
            let next = (s, self.value(s)?);
            if (next.1 >= 0.0) != (towards > 0.0) {
                return Ok(Some(if towards > 0.0 { [near, next] } else { [next, near] }));
            }
            near = next;
            by *= FEW;
        }
        Ok(None)
    }

    /// The fall between an inner and an outer time at which the guard has these values, and by how
    /// much it changes there. A guess keeps away from both ends by a distance that doubles with
    /// each guess that has not halved the interval, so that at most twice as many are needed as by
    /// halves (`at_most_twice_as_many_values_as_by_halves`).
    fn narrowed(&mut self, inner: (f64, f64), outer: (f64, f64)) -> Result<(Crossing, f64), Undefined> {
        let ((mut a, mut above), (mut b, mut below)) = (inner, outer);
        let (mut guess, mut distance) = ((b * above - a * below) / (above - below), 1.0);
        while a.next_up() < b && b - a > f64::MIN_POSITIVE {
            let width = b - a;
            let least = (distance * (b.next_up() - b)).min(0.5 * width);
            let s = if guess.is_finite() { guess.max(a + least).min(b - least) } else { a + 0.5 * width };
            let value = self.value(s)?;
            if value >= 0.0 {
                guess = interpolated((s, value), (b, below), (a, above));
                (a, above) = (s, value);
            } else {
                guess = interpolated((s, value), (a, above), (b, below));
                (b, below) = (s, value);
            }
            if b - a > 0.5 * width {
                distance *= 2.0;
            }
        }
        let rest = |side: f64| (b - a) * (side / (above - below));
        let (root, rest) = if above <= -below { (a, rest(above)) } else { (b, rest(below)) };
        let rest = if rest.is_finite() { rest } else { 0.0 };
        Ok((Crossing { inside: a, outside: b, root, rest, leaps: false }, above - below))
    }
}

/// Where a guard of these values at its latest time, at the other end of the interval and at the
/// end that the latest has replaced is zero: by inverse quadratic interpolation where that does not
/// turn between them, else the middle (T. Chandrupatla, Adv. Eng. Softw. 28 (1997) 145,
/// doi:10.1016/s0965-9978(96)00051-8).
fn interpolated((x1, f1): (f64, f64), (x2, f2): (f64, f64), (x3, f3): (f64, f64)) -> f64 {
    let (place, part) = ((x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2));
    let turnless = part * part < place && (1.0 - part) * (1.0 - part) < 1.0 - place;
    let along = if turnless {
        f1 / (f2 - f1) * (f3 / (f2 - f3)) + (x3 - x1) / (x2 - x1) * (f1 / (f3 - f1)) * (f2 / (f3 - f2))
    } else {
        0.5
    };
    x1 + along * (x2 - x1)
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use proptest::prelude::*;

    use super::*;

    /// How many values of a guard that falls in 0..=1 are taken: narrowed by interpolation, and by
    /// halves.
    fn counts(guard: impl Fn(f64) -> f64) -> (u32, u32) {
        let count = Cell::new(0);
        let mut counted = |s: f64| {
            count.set(count.get() + 1);
            guard(s)
        };
        let (found, _) =
            Search::new(&mut counted, 1.0, 0.0, 0.0).narrowed((0.0, guard(0.0)), (1.0, guard(1.0))).unwrap();
        assert!(found.inside.next_up() == found.outside);
        assert!(guard(found.inside) >= 0.0 && guard(found.outside) < 0.0);
        let by_interpolation = count.replace(0);
        neighbours(&mut counted, 0.0, 1.0);
        (by_interpolation, count.get())
    }

    proptest! {
        /// Powers flat and steep at the root, what is flatter than any of them, leaps, plateaus of
        /// zeros, and values of any size with the right signs.
        #[test]
        fn at_most_twice_as_many_values_as_by_halves(
            root in 0.001..0.999_f64,
            power in -6_i32..=7,
            shape in 0..6_u32,
            decades in -12_i32..=12,
            odd in 1_u64..,
        ) {
            let steep = 10.0_f64.powi(decades);
            let (interpolated, halves) = counts(|s| {
                let by = root - s;
                let value = by.signum() * by.abs().powf(2.0_f64.powi(power));
                match shape {
                    0 => value,
                    1 => if by >= 0.0 { steep } else { -1.0 },
                    2 => if by >= 0.0 { 0.0 } else { value.min(-f64::MIN_POSITIVE) },
                    3 => if by >= 0.0 { value * steep } else { value.min(-f64::MIN_POSITIVE) },
                    4 => by.signum() * (-1.0 / by.abs()).exp().max(f64::MIN_POSITIVE),
                    _ => by.signum() * 10.0_f64.powi((s.to_bits().wrapping_mul(odd | 1) >> 32) as i32 % 13),
                }
            });
            prop_assert!(interpolated <= 2 * halves, "{interpolated} and {halves}");
        }

        /// A smooth guard that would turn up again a thousandth after its end or later.
        #[test]
        fn a_smooth_fall_takes_few_values(root in 0.05..0.95_f64, apart in 0.001..1.0_f64) {
            let (interpolated, halves) = counts(|s| (root - s) * (1.0 + apart - s) * (s + 1.0));
            prop_assert!(2 * interpolated < halves, "{interpolated} and {halves}");
        }
    }
}
