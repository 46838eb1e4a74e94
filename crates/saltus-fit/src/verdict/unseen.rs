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

/// A share of less than this part of the interval is not named: without it the interval would be shorter by half a per cent.
const NAMED: f64 = 0.1;

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
    let mut shares = Vec::new();
    let zero_m = if has(fits.table, Readings::Heights) { stated.zero() } else { 0.0 };
    if zero_m > 0.0 {
        // Low heights bend the COR over the zero: both ends are fitted.
        let ends = [-NORMAL * zero_m, NORMAL * zero_m].map(|by| shift(&raised(fits.evidence, by)).unwrap_or(0.0));
        let (low, high) = (-ends[0].min(ends[1]).min(0.0), ends[0].max(ends[1]).max(0.0));
        shares.push(([low, high], Widening::Zero { zero_m, share: low.max(high) }));
    }
    let sigma_m = fits.sigma_height.value;
    if let (Some(_), Some(shift)) = (&fits.joint, shift(&released_higher(fits.evidence, sigma_m))) {
        let share = NORMAL * shift.abs();
        shares.push(([share; 2], Widening::Release { sigma_m, share }));
    }
    let (gravity, most_per_m) = (fits.gravity.value, ORDINARY_DRAG);
    if stated.drag.is_none()
        && before.value < 1.0
        && let Some(share) = shift(&without_air(fits.evidence, (gravity, most_per_m), before.value))
    {
        shares.push(([(-share).max(0.0), share.max(0.0)], Widening::Air { most_per_m, share }));
    }
    let side = |n: usize, own: f64| shares.iter().fold(own, |all, (share, _)| all.hypot(share[n]));
    let (below, above) = (side(0, cor.value - cor.low), side(1, cor.high - cor.value));
    judgement.cor = Some(Cor { low: (cor.value - below).max(0.0), high: cor.value + above, ..cor });
    for (_, why) in shares.into_iter().filter(|([low, high], _)| *low > NAMED * below || *high > NAMED * above) {
        judgement.widen(why);
    }
}

/// Notes that the COR is that without the air.
pub(crate) fn drag_held(judgement: &mut Judgement, drag_per_m: f64) {
    if drag_per_m > 0.0 {
        judgement.note(FindingKind::DragHeld { drag_per_m });
    }
}
