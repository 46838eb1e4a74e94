//! Where a guard first falls through zero: excluded by bounds, isolated by halving, refined to
//! neighbouring times.

pub(crate) mod chebyshev;
mod departure;
mod evidence;
mod leave;
mod looks;
mod powers;
mod probe;
mod proxy;
mod refine;
mod search;

use crate::poly::{Bernstein, Shape};

pub(crate) use chebyshev::{SAMPLES, sample_times};
pub use evidence::{Doubt, Evidence};
pub(crate) use powers::{Fall, FirstFall, Powers};
pub(crate) use probe::AT_START;
use probe::Search;
use proxy::Samples;
pub(crate) use proxy::stay_clear;
pub(crate) use refine::{neighbours, settle};

/// A fall through zero between two neighbouring times: the guard is not negative at `inside` and
/// negative at `outside`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Crossing {
    /// The last time still inside the domain.
    pub inside: f64,
    /// The first time outside.
    pub outside: f64,
    /// The best estimate of the root, within rounding of both: where `inside` lies early by up to a
    /// rounding, this has no bias.
    pub root: f64,
    /// What rounding takes from the root: it lies at `root + rest`, by the guard's values on both
    /// sides.
    pub rest: f64,
    /// Whether the guard leaps there from one value to another, and does not pass zero.
    pub leaps: bool,
}

impl Crossing {
    /// A crossing at the very start.
    pub(crate) const fn at_start(outside: f64) -> Self {
        Self { inside: 0.0, outside, root: 0.0, rest: 0.0, leaps: false }
    }

    /// A crossing just after a given time.
    pub(crate) const fn after(root: f64) -> Self {
        Self { inside: root, outside: root.next_up(), root, rest: 0.0, leaps: false }
    }
}

/// What the guard does at the start of the interval searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Nothing special: a fall that begins with a zero at the start counts.
    Open,
    /// The guard is zero at the start but for rounding because its edge was just taken: that root
    /// is divided out.
    Spent,
    /// The search goes on where an earlier one ended: a guard that is zero here is on the side it
    /// came from.
    Resumed,
}

/// The outcome of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Searched {
    /// The first fall, if there is one.
    pub fall: Option<Crossing>,
    /// What speaks for it.
    pub evidence: Evidence,
    /// Where the guard turns, nearest to zero, where its samples show that.
    pub(crate) turn: Option<Turn>,
}

/// Where a guard turns: up from its least value, or, where it is below zero all along, down from
/// its greatest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turn {
    pub(crate) between: [f64; 2],
    pub(crate) below: bool,
}

impl Turn {
    /// The same in another unit of time.
    pub(crate) fn times(self, unit: f64) -> Self {
        Self { between: self.between.map(|u| u * unit), ..self }
    }
}

impl Searched {
    /// By a formula.
    pub(crate) const fn solved(fall: Option<Crossing>) -> Self {
        Self { fall, evidence: if fall.is_some() { Evidence::Isolated } else { Evidence::Excluded }, turn: None }
    }
}

/// The outcome of a search that could not finish: the guard is not a number at this time, before
/// any fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Undefined(pub f64);

/// The first time in `0..=span` at which `guard` falls from positive or zero to negative.
///
/// On an interval the guard is replaced by its interpolant at nine Chebyshev points, whose tail and
/// two checks away from the nodes bound how far off it is. The interval is halved until the
/// interpolant's Bernstein coefficients, taken with that margin, exclude a fall or show the guard
/// to fall strictly; where the interpolant is too flat for that, down to neighbouring numbers. A
/// root at the start that is spent is divided out, so that it cannot hide the next one. A touch
/// without a change of sign is no fall; a zero on a whole interval falls once, where it ends.
///
/// Guaranteed for guards that are smooth at the scale of the sampling (a feature narrower than
/// about a ninth of `span`, and alone, can be missed); where that could not be established, the
/// [`Evidence`] says so.
///
/// ```
/// use saltus::cross::{Evidence, Start, first_fall};
/// // Two crossings a millionth apart are not one, nor none.
/// let found = first_fall(|s| (s - 0.5) * (s - 0.500_001), 1.0, Start::Open).unwrap();
/// let fall = found.fall.unwrap();
/// assert!((fall.inside - 0.5).abs() < 1e-10 && fall.inside < fall.outside);
/// assert_eq!(found.evidence, Evidence::Isolated);
/// // A root that was just spent is not found again; the next one is.
/// let next = first_fall(|s| s * (1.0 - s), 2.0, Start::Spent).unwrap();
/// assert_eq!(next.fall.unwrap().inside, 1.0);
/// ```
///
/// # Errors
/// [`Undefined`] if the guard is not a number somewhere before its first fall.
pub fn first_fall(mut guard: impl FnMut(f64) -> f64, span: f64, start: Start) -> Result<Searched, Undefined> {
    Search::new(&mut guard, span, 0.0, 0.0).first_fall(start, None)
}

/// The same for a guard of this `value` at the start of a stretch of an arc that began so long
/// `behind` it, where times are `tick` apart.
pub(crate) fn first_fall_on_arc(
    guard: &mut dyn FnMut(f64) -> f64,
    value: f64,
    (behind, span): (f64, f64),
    start: Start,
    tick: f64,
) -> Result<Searched, Undefined> {
    Search { behind, ..Search::new(guard, span, 0.0, tick) }.at_start(value).first_fall(start, None)
}

/// The same for a guard of these `values` at the [`sample_times`] of a step, on whose dense output
/// it bends by `bend`.
pub(crate) fn first_fall_on_step(
    guard: &mut dyn FnMut(f64) -> f64,
    values: &[f64; SAMPLES],
    span: f64,
    start: Start,
    bend: f64,
    tick: f64,
) -> Result<Searched, Undefined> {
    if start != Start::Spent
        && let Ok(samples) = Samples::of(values, 0.0, span)
        && samples.stay_above()
    {
        return Ok(Searched { turn: samples.turn(span), ..Searched::solved(None) });
    }
    Search::new(guard, span, bend, tick).sampled_at(values).first_fall(start, None)
}

/// The same for a guard on a step that is the polynomial `p(s / span)` to within
/// `margin`; where that decides, `guard` is not asked.
pub(crate) fn first_fall_of_polynomial(
    p: &Bernstein,
    margin: f64,
    bend: f64,
    guard: &mut dyn FnMut(f64) -> f64,
    span: f64,
    start: Start,
) -> Result<Searched, Undefined> {
    if start == Start::Spent {
        // Away from the wall only the change counts, and it carries no rounding of the value at the
        // wall.
        let change = p.less_start();
        let margin = change.rounding();
        Search::new(guard, span, bend, 0.0).first_fall(start, Some((change, margin)))
    } else if p.shape(margin) == Shape::Above {
        Ok(Searched::solved(None))
    } else {
        Search::new(guard, span, bend, 0.0).first_fall(start, Some((*p, margin)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fall(guard: impl FnMut(f64) -> f64, span: f64) -> Option<f64> {
        first_fall(guard, span, Start::Open).unwrap().fall.map(|c| c.inside)
    }

    #[test]
    fn a_touch_is_no_fall() {
        assert_eq!(fall(|s| (s - 0.5).powi(2), 1.0), None);
        assert_eq!(fall(|s| (s - 0.3).powi(4), 1.0), None);
        assert_eq!(fall(|s| -(s - 0.5).powi(2), 1.0), None);
    }

    #[test]
    fn a_plateau_falls_once_where_it_ends() {
        let found = fall(
            |s| {
                if s < 0.25 {
                    0.25 - s
                } else if s < 0.75 {
                    0.0
                } else {
                    0.75 - s
                }
            },
            1.0,
        )
        .unwrap();
        assert!((found - 0.75).abs() < 1e-15, "{found}");
    }

    #[test]
    fn a_fall_at_the_start_counts_unless_spent() {
        assert_eq!(fall(|s| -s, 1.0), Some(0.0));
        assert_eq!(first_fall(|s| -s, 1.0, Start::Spent).unwrap().fall, None);
    }

    /// A spent root at any value, as one beyond a leap is, is left where the guard moves from it.
    #[test]
    fn what_stands_below_zero_has_not_fallen_again() {
        for value in [-1.0, -0.1, -1e-9, -1e9] {
            assert_eq!(first_fall(|_| value, 1.0, Start::Spent).unwrap().fall, None);
            let next = first_fall(|s| if s < 0.3 { value } else { 0.7 - s }, 1.0, Start::Spent).unwrap();
            assert_eq!(next.fall.unwrap().inside, 0.7);
        }
    }

    #[test]
    fn undefined_before_the_fall_is_said_and_after_it_is_not() {
        assert!(matches!(first_fall(|s| (0.5 - s).sqrt() + 1.0, 1.0, Start::Open), Err(Undefined(s)) if s > 0.49));
        let found = fall(|s| if s > 0.6 { f64::NAN } else { 0.25 - s }, 1.0);
        assert!((found.unwrap() - 0.25).abs() < 1e-15);
    }

    /// Samples at hand change nothing, be one of them no number.
    #[test]
    fn samples_at_hand_change_nothing() {
        let times = sample_times(0.0, 1.0);
        for hole in times.into_iter().skip(1).chain([2.0]) {
            for bent in [0.1, 1.0, 3.0] {
                let guard = |s: f64| if (s - hole).abs() < 1e-3 { f64::NAN } else { 1.0 - bent * s * (1.0 - s) };
                let at_hand = first_fall_on_step(&mut { guard }, &times.map(guard), 1.0, Start::Open, 0.0, 0.0);
                let asked = first_fall_on_arc(&mut { guard }, guard(0.0), (0.0, 1.0), Start::Open, 0.0);
                assert_eq!(at_hand, asked, "a hole at {hole}, bent by {bent}");
            }
        }
    }

    #[test]
    fn a_fast_guard_gives_its_first_fall() {
        let found = fall(|s| (1000.0 * s + 0.1).sin(), 1.0).unwrap();
        assert!((found - (std::f64::consts::PI - 0.1) / 1000.0).abs() < 1e-15, "{found}");
    }

    proptest! {
        /// A floor h = A sin ωt lets go of a ball where h'' = -g: the gap grows as the cube of
        /// time, and is no step of rounding for long. It is no fall that rounding makes one,
        /// however late the clock and near the floor.
        #[test]
        fn a_floor_that_lets_go(omega in 5.0..300.0_f64, strength in 1.001..3.0_f64, turns in 0.0..5000.0_f64, window in 0.03..1.0_f64) {
            let g = 9.81;
            let amplitude = strength * g / (omega * omega);
            let t = ((1.0_f64 / strength).asin() + 2.0 * std::f64::consts::PI * turns.floor()) / omega;
            let (x, v) = (amplitude * (omega * t).sin(), amplitude * omega * (omega * t).cos());
            let gap = |s: f64| (x + s * (v - 0.5 * g * s)) - amplitude * (omega * (t + s)).sin();
            prop_assume!(gap(0.0) == 0.0);
            let found = fall(gap, window / omega);
            prop_assert!(found.is_none_or(|s| omega * s > 0.02), "{found:?}");
        }

        /// Plant falls and rises in turn, clustered, dyadic or at an end; the first fall is found,
        /// as a polynomial and as a function.
        #[test]
        fn planted_roots(mut roots in prop::collection::vec((0_u32..=64, -3_i32..=3), 1..=6)) {
            roots.sort_unstable();
            let roots: Vec<f64> = roots.iter().map(|&(k, hair)| f64::from(k) / 64.0 + f64::from(hair) * 1e-4).collect();
            let value = |s: f64| roots.iter().map(|r| r - s).product::<f64>();
            // Count the roots at each place: an even group is a touch, an odd one a change of sign.
            let mut sign = 1.0;
            let mut expected = None;
            let mut i = 0;
            while i < roots.len() {
                let same = roots[i..].iter().take_while(|&&r| r == roots[i]).count();
                if same % 2 == 1 {
                    if roots[i] >= 0.0 && roots[i] < 1.0 && sign > 0.0 {
                        expected = Some((roots[i], same));
                        break;
                    }
                    sign = -sign;
                }
                i += same;
            }
            let found = fall(value, 1.0);
            match expected {
                None => prop_assert!(found.is_none(), "{found:?}"),
                Some((root, multiplicity)) => {
                    let tolerance = if multiplicity == 1 { 1e-9 } else { 1e-3 };
                    prop_assert!(found.is_some_and(|s| (s - root).abs() < tolerance), "{found:?} {root}");
                }
            }
        }
    }
}
