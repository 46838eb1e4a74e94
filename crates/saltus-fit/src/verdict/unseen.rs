//! What a table cannot show and the interval must allow for: the zero of its heights, the height of release, the air.
//!
//! Each is a change of the readings, and its share of the error is how far the COR moves when they are fitted anew.

use super::judgement::{Cor, Judgement};
use super::whole;
use crate::evidence::{Evidence, has};
use crate::finding::{Finding, FindingKind, Severity, Widening};
use crate::model::{ORDINARY_DRAG, raised, released_higher, without_air};
use crate::quantity::Readings;
use crate::solve::fits::{Fits, Known};
use crate::statistics::NORMAL;

/// The ball whose size is not stated, m: a tennis ball, the largest that is read beside a rule without naming where on it.
const USUAL_BALL: f64 = 0.067;

/// What is stated of what the readings cannot show.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stated {
    /// The size of the ball, m.
    pub(crate) ball: Option<f64>,
    /// The standard error of the zero of the height scale, m.
    pub(crate) sigma_zero: Option<f64>,
    /// Drag, 1/m: the readings come without the air where it is stated.
    pub(crate) drag: Option<f64>,
}

impl Stated {
    /// A ball is read at its bottom, its top or anywhere between: a rectangle as wide as the ball, whose standard deviation is its width over √12
    /// (Guide to the expression of uncertainty in measurement, 4.3.7).
    pub(crate) fn zero(self) -> f64 {
        self.sigma_zero.unwrap_or(self.ball.unwrap_or(USUAL_BALL) / 12f64.sqrt())
    }
}

/// The COR that the readings amount to; none where they do not settle on one.
pub(crate) fn judged(fits: &Fits<'_>) -> Option<Cor> {
    let mut judgement = Judgement::default();
    whole::judge(&mut judgement, fits, None);
    let refused = judgement.findings.iter().any(|f: &Finding| f.severity == Severity::Refusal);
    judgement.cor.filter(|_| !refused)
}

/// Widens the interval by what the readings cannot show.
pub(crate) fn allow(judgement: &mut Judgement, fits: &Fits<'_>, (known, stated): (&Known, Stated)) {
    let Some(cor) = judgement.cor.filter(|cor| cor.standard_error.is_some()) else { return };
    let Some(before) = judged(fits) else { return };
    let shift = |altered: &Evidence| {
        let fits = Fits::of(fits.table, altered, known, false).ok()?;
        Some(judged(&fits)?.value - before.value).filter(|shift| shift.is_finite())
    };
    let mut even = 0.0f64;
    let mut add = |judgement: &mut Judgement, share: f64, why: Widening| {
        if share > 0.0 {
            even = even.hypot(share);
            judgement.widen(why);
        }
    };
    let heights = has(fits.table, Readings::Heights);
    let zero_m = if heights { stated.zero() } else { 0.0 };
    if zero_m > 0.0
        && let Some(shift) = shift(&raised(fits.evidence, zero_m))
    {
        let share = NORMAL * shift.abs();
        add(judgement, share, Widening::Zero { zero_m, share });
    }
    if let (Some(_), Some(shift)) = (&fits.joint, shift(&released_higher(fits.evidence, fits.sigma_height.value))) {
        let share = NORMAL * shift.abs();
        add(judgement, share, Widening::Release { sigma_m: fits.sigma_height.value, share });
    }
    let (mut lower, mut higher) = (0.0, 0.0);
    if stated.drag.is_none() && before.value < 1.0 {
        let air = (fits.gravity.value, ORDINARY_DRAG);
        if let Some(shift) = shift(&without_air(fits.evidence, air, before.value)) {
            (lower, higher) = ((-shift).max(0.0), shift.max(0.0));
            judgement.widen(Widening::Air { most_per_m: ORDINARY_DRAG, share: shift });
        }
    }
    let below = (cor.value - cor.low).hypot(even).hypot(lower);
    let above = (cor.high - cor.value).hypot(even).hypot(higher);
    judgement.cor = Some(Cor { low: (cor.value - below).max(0.0), high: cor.value + above, ..cor });
}

/// Notes that the COR is that without the air.
pub(crate) fn drag_held(judgement: &mut Judgement, drag_per_m: f64) {
    if drag_per_m > 0.0 {
        judgement.note(FindingKind::DragHeld { drag_per_m });
    }
}
