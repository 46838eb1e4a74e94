//! What a table cannot show and the interval must allow for: the zero of its heights, the height of
//! release, the air.
//!
//! Each is a change of the readings, and its share of the error is how far the COR moves when they
//! are fitted anew.

use super::judgement::{Cor, Judgement, NAMED};
use super::whole;
use crate::elementary::hypot;
use crate::error::FitError;
use crate::evidence::follow::BOUNCES;
use crate::evidence::{Evidence, TrialEvidence, has};
use crate::finding::{Finding, FindingKind, Severity, Widening};
use crate::model::{
    LIGHT_DRAG, ORDINARY_DRAG, lowered_at_most, missed, raised, released_higher, rescaled, telling, without_air,
};
use crate::quantity::{Ball, Readings, Source};
use crate::read::Table;
use crate::solve::fits::{Fits, Known};
use crate::statistics::{CLEAR, NORMAL, REPLICATED, student};

/// The ball whose size is not stated, m: a tennis ball, the largest that is read beside a rule
/// without naming where on it.
const USUAL_BALL: f64 = 0.067;

/// Lengths that nobody checked are wrong by this part at most: a ball that moves 20 cm before its
/// rule reads a tenth too high from 2 m away.
const SCALE: f64 = 0.1;

/// The COR without the air is found when it moves by less than this, a thousandth of the best error
/// there is.
const SETTLED: f64 = 1e-7;
/// What drag does to the readings hardly depends on the COR: a round leaves less than a fifth of
/// the error for k h below 0.3, so these are plenty.
const ROUNDS: usize = 30;

/// A rebound that is missing is looked for among so many: more leave readings enough to tell by the
/// comparison of models.
const TRIED: usize = 8;

/// What is stated of what the readings cannot show.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stated {
    /// The size of the ball, m.
    pub(crate) ball: Option<f64>,
    /// The standard error of the zero of the height scale, m.
    pub(crate) sigma_zero: Option<f64>,
    /// The standard error of lengths, as a part of them.
    pub(crate) sigma_scale: Option<f64>,
    /// Drag, 1/m: the readings come without the air where it is stated.
    pub(crate) drag: Option<f64>,
    /// The ball that the table names: its air is allowed for, and no other's.
    pub(crate) named: Option<Ball>,
}

impl Stated {
    /// By how much the zero of heights may be off, m: a ball is read at its bottom, its top or
    /// anywhere between, and the scale may be set by any of these with the ball at rest, so that
    /// readings are too high, or too low, by the ball at most.
    pub(crate) fn zero(self) -> f64 {
        self.sigma_zero.map_or(self.ball.unwrap_or(USUAL_BALL), |sigma| NORMAL * sigma)
    }
}

/// What is known, with the errors of readings that a fit found: altered readings are judged by
/// them.
fn with_errors_of(fits: &Fits<'_>, known: &Known) -> Known {
    Known { sigma_height: Some(fits.sigma_height), sigma_time: Some(fits.sigma_time), ..*known }
}

/// The COR that the readings amount to; none where they do not settle on one.
fn judged(fits: &Fits<'_>) -> Option<Cor> {
    let mut judgement = Judgement::default();
    whole::judge(&mut judgement, fits, None);
    let refused = judgement.findings.iter().any(|f: &Finding| f.severity == Severity::Refusal);
    judgement.cor.filter(|_| !refused)
}

/// The readings as they would be in a vacuum: what drag does to them depends on the COR, which is
/// found with it, round by round.
pub(crate) fn in_a_vacuum(
    table: &Table,
    evidence: Evidence,
    (known, drag): (&Known, f64),
) -> Result<Evidence, FitError> {
    // Speeds before and after a bounce are of no flight through air.
    if table.metadata.speeds {
        return Ok(evidence);
    }
    let few = telling(&evidence);
    let (mut altered, mut before) = (few.clone(), f64::NAN);
    for _ in 0..ROUNDS {
        let Some(cor) = judged(&Fits::of(table, &altered, known, false)?) else { return Ok(evidence) };
        if (cor.value - before).abs() < SETTLED {
            break;
        }
        before = cor.value.min(1.0);
        altered = without_air(&few, (known.gravity.value, drag), before);
    }
    Ok(without_air(&evidence, (known.gravity.value, drag), before))
}

/// Whether the readings are clearly better explained with so much drag than with none.
pub(crate) fn air_shows(table: &Table, evidence: &Evidence, (known, drag): (&Known, f64)) -> Result<bool, FitError> {
    let few = telling(evidence);
    let still = Fits::of(table, &few, known, false)?;
    let same = with_errors_of(&still, known);
    let scattered = [still.sigma_height, still.sigma_time].iter().any(|sigma| sigma.source == Source::Scatter);
    let still = misfit(&Fits::of(table, &few, &same, false)?);
    let altered = in_a_vacuum(table, few, (&same, drag))?;
    let moving = misfit(&Fits::of(table, &altered, &same, false)?);
    let better = |((zero, _), (some, freedom)): ((f64, usize), (f64, usize))| {
        let unit = some / freedom.max(1) as f64;
        if scattered {
            zero - some > student(freedom).powi(2).max(CLEAR) * unit
        } else {
            zero - some > CLEAR * unit.max(1.0)
        }
    };
    Ok(still.zip(moving).is_some_and(better))
}

/// How far shifts reach down and up.
fn range([a, b]: [f64; 2]) -> [f64; 2] {
    [-a.min(b).min(0.0), a.max(b).max(0.0)]
}

/// Widens the interval by what the readings cannot show.
pub(crate) fn allow(judgement: &mut Judgement, fits: &Fits<'_>, (known, stated): (&Known, Stated)) {
    let Some(cor) = judgement.cor.filter(|cor| cor.standard_error.is_some()) else { return };
    let few = telling(fits.evidence);
    let Ok(fits) = &Fits::of(fits.table, &few, known, false) else { return };
    let Some(before) = judged(fits) else { return };
    let shift = |altered: &Evidence| {
        let fits = Fits::of(fits.table, altered, known, false).ok()?;
        Some(judged(&fits)?.value - before.value).filter(|shift| shift.is_finite())
    };
    let mut shares = Vec::new();
    // Speeds are read on no scale of heights.
    let placed = has(fits.table, Readings::Heights) && !fits.table.metadata.speeds;
    let zero_m = if placed { stated.zero() } else { 0.0 };
    if zero_m > 0.0 {
        // Low heights bend the COR over the zero: both ends are fitted.
        let by = zero(fits, known, zero_m);
        let share = range(by.map(|by| shift(&raised(fits.evidence, by)).unwrap_or(0.0)));
        shares.push((share, Widening::Zero { zero_m: by[1].max(-by[0]), share: share[0].max(share[1]) }));
    }
    let part = stated.sigma_scale.map_or(SCALE, |sigma| NORMAL * sigma);
    if fits.joint.is_some() && part > 0.0 {
        let by = scale(fits, known, part);
        let share = range(by.map(|by| shift(&rescaled(fits.evidence, 1.0 + by)).unwrap_or(0.0)));
        shares.push((share, Widening::Scale { part: by[1].max(-by[0]), share: share[0].max(share[1]) }));
    }
    let sigma_m = fits.sigma_height.value;
    if let (Some(_), Some(shift)) = (&fits.joint, shift(&released_higher(fits.evidence, sigma_m))) {
        let share = NORMAL * shift.abs();
        shares.push(([share; 2], Widening::Release { sigma_m, share }));
    }
    if stated.drag.is_none()
        && before.value < 1.0
        && let Some((most_per_m, share)) = air(fits, known, (before.value, stated.named))
    {
        let ball = stated.named;
        shares.push(([(-share).max(0.0), share.max(0.0)], Widening::Air { most_per_m, share, ball }));
    }
    let trials = fits.evidence.trials.len();
    if let Some(drops) = fits.table.metadata.averaged.filter(|_| trials < REPLICATED) {
        let share = NORMAL * BOUNCES * cor.value / (drops * trials.max(1) as f64).sqrt();
        shares.push(([share; 2], Widening::Averages { drops, share }));
    }
    let side = |n: usize, own: f64| shares.iter().fold(own, |all, (share, _)| hypot(all, share[n]));
    let (below, above) = (side(0, cor.value - cor.low), side(1, cor.high - cor.value));
    judgement.cor = Some(Cor { low: (cor.value - below).max(0.0), high: cor.value + above, ..cor });
    for (_, why) in shares.into_iter().filter(|([low, high], _)| *low > NAMED * below || *high > NAMED * above) {
        judgement.widen(why);
    }
    one_missing(judgement, fits, known);
}

/// Contacts that can be read in other ways about as well: the interval takes in the COR of each,
/// and one far outside is a doubt.
pub(crate) fn read_otherwise(judgement: &mut Judgement, fits: &Fits<'_>, known: &Known) {
    if fits.evidence.rivals.is_empty() || fits.times.is_none() {
        return;
    }
    let flights = |trial: &TrialEvidence| trial.moments.last().map_or(0, |m| m.0);
    let mut far = None;
    for trials in &fits.evidence.rivals {
        let evidence = Evidence::supposed(trials.clone());
        let Some(cor) = Fits::of(fits.table, &evidence, known, false).ok().and_then(|fits| judged(&fits)) else {
            continue;
        };
        if far.is_none() && judgement.outside(cor.value) {
            let differs = |(a, b): &(&TrialEvidence, &TrialEvidence)| a.moments != b.moments;
            let pair = trials.iter().zip(&fits.evidence.trials).find(differs);
            far = pair.map(|(other, own)| (cor.value, flights(other), flights(own)));
        }
        judgement.reach(cor.value, cor.value, Widening::Models);
    }
    if let Some((cor, flights, instead_of)) = far {
        judgement.doubt(FindingKind::ReadOtherwise { cor, flights, instead_of });
    }
}

/// Heights that fit as well if a rebound is missing are not known to be without a gap: the interval
/// takes in the COR that they then have.
///
/// Two heights fit everything, and say nothing of it; from four rebounds on the comparison of
/// models looks for the gap.
fn one_missing(judgement: &mut Judgement, fits: &Fits<'_>, known: &Known) {
    let last = fits.evidence.trials.iter().filter_map(|t| t.heights.last()).map(|h| h.0).max().unwrap_or(0);
    let checked = fits.evidence.trials.iter().any(|t| t.heights.len() > 2);
    if !checked || fits.times.is_some() || last > TRIED {
        return;
    }
    let same = Known { sigma_height: Some(fits.sigma_height), ..*known };
    let fit = |evidence: &Evidence| {
        let fits = Fits::of(fits.table, evidence, &same, false).ok()?;
        Some((judged(&fits)?.value, misfit(&fits)?))
    };
    let Some((_, (least, freedom))) = fit(fits.evidence) else { return };
    let reach = if fits.sigma_height.source == Source::Scatter { student(freedom) } else { NORMAL };
    for before in 1..=last {
        if let Some((cor, (chi, _))) = fit(&missed(fits.evidence, before))
            && chi <= least + reach * reach
        {
            judgement.reach(cor, cor, Widening::Models);
        }
    }
}

/// The chi-square over the zero is looked at in even steps from end to end, since it is no parabola
/// where heights are low: together with the halvings of one they part it in a thousand.
const STEPS: u32 = 1024 >> HALVED;
/// The step in which it becomes too large is halved so often: to a thousandth of the ball.
const HALVED: usize = 6;

/// How much lower and higher the heights may be than they were read, m: by `most`, or by less where
/// the chi-square rules it out.
fn zero(fits: &Fits<'_>, known: &Known, most: f64) -> [f64; 2] {
    let same = with_errors_of(fits, known);
    let low = -most.min(lowered_at_most(fits.evidence));
    let few = telling(fits.evidence);
    let at = |by: f64| misfit(&Fits::of(fits.table, &raised(&few, by), &same, false).ok()?);
    let place = |n: u32| low + (most - low) * f64::from(n) / f64::from(STEPS);
    let seen: Option<Vec<(f64, f64)>> = (0..=STEPS).map(|n| Some((place(n), at(place(n))?.0))).collect();
    let (Some(seen), Some(still)) = (seen, at(0.0)) else { return [low, most] };
    let least = seen.iter().map(|s| s.1).fold(still.0, f64::min);
    let allowed = |chi_square: f64| chi_square <= least + unit(fits, still);
    // From what is allowed to its neighbour, which is not.
    let edge = |from: f64, to: f64| {
        let halve = |(inside, outside): (f64, f64), _| {
            let middle = f64::midpoint(inside, outside);
            if at(middle).is_some_and(|found| allowed(found.0)) { (middle, outside) } else { (inside, middle) }
        };
        (0..HALVED).fold((from, to), halve).0
    };
    let inside = |s: &(f64, f64)| allowed(s.1);
    let first = seen.iter().position(inside);
    let last = seen.iter().rposition(inside);
    let step = |n: usize| seen.get(n).map(|s| s.0);
    let down = first.map_or(0.0, |n| n.checked_sub(1).and_then(step).map_or(low, |out| edge(seen[n].0, out)));
    let up = last.map_or(0.0, |n| step(n + 1).map_or(most, |out| edge(seen[n].0, out)));
    // Where every step is too far, what is allowed lies about none.
    match (first, seen.windows(2).find(|pair| pair[0].0 <= 0.0 && pair[1].0 >= 0.0)) {
        (None, Some(pair)) => [edge(0.0, pair[0].0), edge(0.0, pair[1].0)],
        _ => [down.min(0.0), up.max(0.0)],
    }
}

/// By which part lengths may be smaller and larger than they were read, down and up: by `most`, or
/// by less where the chi-square, a parabola over the scale, rules it out.
fn scale(fits: &Fits<'_>, known: &Known, most: f64) -> [f64; 2] {
    let same = with_errors_of(fits, known);
    let at = |by: f64| misfit(&Fits::of(fits.table, &rescaled(fits.evidence, 1.0 + by), &same, false).ok()?);
    match (at(0.0), at(-most), at(most)) {
        (Some(still), Some(small), Some(large)) => {
            let above = |found: (f64, usize)| (found.0 - still.0) / unit(fits, still);
            allowed([(-most, above(small)), (most, above(large))])
        }
        _ => [-most, most],
    }
}

/// What a chi-square may be above its least, 95 %: more where the error of reading is that of the
/// scatter, or too small for it.
fn unit(fits: &Fits<'_>, (chi_square, freedom): (f64, usize)) -> f64 {
    let scattered = [fits.sigma_height, fits.sigma_time].iter().any(|sigma| sigma.source == Source::Scatter);
    let reach = if scattered { student(freedom) } else { NORMAL };
    reach * reach * (chi_square / freedom.max(1) as f64).max(1.0)
}

/// The most drag that the readings allow, and how far it moves the COR.
///
/// That is the drag of the ball that is named; else of the lightest ball, or less where the
/// chi-square, a parabola over the drag, rules it out; that of ordinary balls is always allowed.
fn air(fits: &Fits<'_>, known: &Known, (e, named): (f64, Option<Ball>)) -> Option<(f64, f64)> {
    // In units of one and the same error of reading.
    let same = with_errors_of(fits, known);
    let at = |drag: f64| {
        let altered = in_a_vacuum(fits.table, fits.evidence.clone(), (&same, drag)).ok()?;
        let fits = Fits::of(fits.table, &altered, &same, false).ok()?;
        Some((judged(&fits)?.value, misfit(&fits))).filter(|(cor, _)| cor.is_finite())
    };
    // Nothing keeps more than all of its speed.
    let share = |most: f64, still: f64| Some((most, (at(most)?.0 - still).min(1.0 - e)));
    if let Some(ball) = named {
        return share(ball.drag(), at(0.0)?.0);
    }
    let (still, ordinary, light) = (at(0.0)?, at(ORDINARY_DRAG)?, at(LIGHT_DRAG));
    let most = match (still.1, ordinary.1, light.and_then(|light| light.1)) {
        (Some((zero, freedom)), Some((few, _)), Some((many, _))) => {
            let unit = unit(fits, (zero, freedom));
            let [_, most] = allowed([(ORDINARY_DRAG, (few - zero) / unit), (LIGHT_DRAG, (many - zero) / unit)]);
            most.max(ORDINARY_DRAG)
        }
        _ if light.is_some() => LIGHT_DRAG,
        _ => ORDINARY_DRAG,
    };
    share(most, still.0)
}

/// How far something may be off, down and up from nothing and between two ends, until a chi-square
/// is more than one above its least; it rises by so much from nothing to each end, in units of what
/// is allowed, and is a parabola between.
fn allowed([(p, at_p), (q, at_q)]: [(f64, f64); 2]) -> [f64; 2] {
    let (low, high) = (p.min(q).min(0.0), p.max(q).max(0.0));
    // b x + c x² through both.
    let c = (at_q / q - at_p / p) / (q - p);
    let b = at_p / p - c * p;
    let middle = -0.5 * b / c;
    let best = middle.clamp(low, high);
    let half = (middle * middle + (best * (c * best + b) + 1.0) / c).sqrt();
    if c > 0.0 && half.is_finite() {
        [(middle - half).clamp(low, 0.0), (middle + half).clamp(0.0, high)]
    } else {
        [low, high]
    }
}

/// The chi-square of the fit that the COR rests on, and its degrees of freedom; none where bounces
/// scatter, which no reading error measures.
fn misfit(fits: &Fits<'_>) -> Option<(f64, usize)> {
    if let Some(joint) = &fits.joint {
        return Some((joint.fitted.chi_square, joint.fitted.freedom));
    }
    match (&fits.times, &fits.heights) {
        (Some(times), _) if times.scatter.is_some() => None,
        (Some(times), _) => Some((times.fitted.chi_square, times.fitted.freedom)),
        (None, Some(heights)) => Some((heights.fitted.chi_square, heights.fitted.freedom)),
        (None, None) => None,
    }
}

/// Notes that the COR is that without the air.
pub(crate) fn drag_held(judgement: &mut Judgement, drag_per_m: f64) {
    if drag_per_m > 0.0 {
        judgement.note(FindingKind::DragHeld { drag_per_m });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_chi_square_does_not_rule_out_is_allowed() {
        // (x − best)² / s², less its value at nothing.
        let rise = |best: f64, s: f64| move |x: f64| (x, ((x - best) / s).powi(2) - (best / s).powi(2));
        for (best, s, [low, high]) in [
            (0.02, 0.03, [-0.01, 0.05]),
            (0.05, 0.5, [-0.067, 0.14]),
            (0.0, 0.01, [-0.01, 0.01]),
            (-0.05, 0.1, [-0.067, 0.05]),
            // Beyond an end: all the way to it, and not past nothing.
            (-0.2, 0.05, [-0.067, 0.0]),
            (0.5, 0.05, [0.0, 0.14]),
        ] {
            let rise = rise(best, s);
            let found = allowed([rise(-0.067), rise(0.14)]);
            assert!((found[0] - low).abs() < 1e-9 && (found[1] - high).abs() < 1e-9, "{best} {s}: {found:?}");
            let above = allowed([rise(0.022), rise(0.14)]);
            assert!(above[0] == 0.0 && (above[1] - high).abs() < 1e-3 || best < 0.0, "{best} {s}: {above:?}");
        }
        // What the chi-square does not see is allowed altogether.
        assert_eq!(allowed([(-0.067, 0.0), (0.067, 0.0)]), [-0.067, 0.067]);
    }
}
