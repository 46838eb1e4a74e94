//! Other models of the same heights and times: a COR that depends on speed, one for every bounce,
//! air drag, a wrong zero of the scale.
//!
//! All are the motion of [`Flight`] with one thing more set free. They are compared by BIC and
//! `AICc`, and by how they do on trials that they were not fitted to.

use rayon::iter::{IntoParallelIterator, IntoParallelRefMutIterator, ParallelIterator};

use crate::elementary::{ln, powf};
use crate::error::FitError;
use crate::finding::{Finding, FindingKind, Missing, Need, Untried};
use crate::model::{Bounds, CorLaw, FOLLOWED, Flight, FlightTrial, LONGEST_CONTACT, Model, READINGS};
use crate::quantity::{self, CorModel, Loss, Measured};
use crate::solve::choice::{Limit, Misfit, ModelChoice, SpeedCor, UnderLoss};
use crate::solve::joint::slope;
use crate::solve::one::identified;
use crate::solve::profile::limit;
use crate::solve::robust;
use crate::solve::successive::{Fitted, fit};
use crate::statistics::{CLEAR, SPARE, TELLING, TREND, WEAK, chi_square_p};

/// Speeds must differ by this factor before a dependence on speed shows beside one COR, and
/// heights before a wrong zero shows.
const SPEEDS: f64 = 2.0;
/// The same for drag, which has a law of its own.
const DRAG_SPEEDS: f64 = 1.6;
/// A wrong zero shows over so many bounces.
const OFFSET_IMPACTS: usize = 4;
/// A COR for every bounce is tried for up to so many.
const BOUNCES: usize = 12;
/// Leaving out each trial in turn is tried for up to so many trials.
const TRIALS: usize = 30;
/// The zero of a scale is off by a ball at most, and this is the largest: a basketball, m.
const LARGEST_BALL: f64 = 0.25;
/// BICs this close are the same: searches end with so much left open, and a difference counts from
/// [`WEAK`] on.
const TIE: f64 = 1e-6;
/// Heights of which one is missing are looked for among so many, and need so many in their trial.
const FEW: usize = 200;
const RUN: usize = 5;
/// The COR is listed at so many speeds.
const LISTED: usize = 25;

/// What the readings are, for the comparison.
pub(crate) struct Readings {
    pub(crate) trials: Vec<FlightTrial>,
    pub(crate) gravity: f64,
    /// The errors were taken from the scatter: only ratios of sums of squares mean something.
    pub(crate) scattered: bool,
    /// As [`Misfit::least`].
    pub(crate) least: f64,
    /// The size of the ball, m, where it is known.
    pub(crate) ball: Option<f64>,
    /// They are heights and times together.
    pub(crate) joint: bool,
    /// The other losses that models are fitted under too that are not out of the question,
    pub(crate) losses: Vec<Loss>,
    /// and this one in any case.
    pub(crate) wanted: Option<CorModel>,
}

/// The models, and what could not be tried.
#[derive(Default)]
pub(crate) struct Compared {
    pub(crate) models: Vec<ModelChoice>,
    /// The kind of reading, where it is one and the error of it may decide.
    pub(crate) kind: Option<quantity::Readings>,
    pub(crate) notes: Vec<Finding>,
    /// Why the model that was asked for is not among them.
    pub(crate) untried: Option<Untried>,
}

/// The speeds of the impacts that the readings tell of, under a law: the slowest, the fastest, how
/// many.
fn impacts(base: &Flight, fitted: &Fitted) -> (f64, f64, usize) {
    let unknowns = &fitted.shared[..base.law.unknowns()];
    let (mut slowest, mut fastest, mut count) = (f64::INFINITY, 0.0f64, 0);
    for (block, trial) in base.trials.iter().enumerate() {
        let last_height = trial.heights.last().map_or(0, |h| h.0);
        let last_moment = trial.moments.last().map_or(0, |m| m.flights + usize::from(m.apex));
        // Without the release nobody knows how fast the ball came to the first contact, and so not
        // the COR there.
        let from = usize::from(trial.release.is_none());
        let to = last_height.max(last_moment);
        if to <= from {
            continue;
        }
        let mut speed = base.first_contact(block, &fitted.shared, &fitted.own[block]).0.abs();
        for contact in 0..to {
            if contact >= from {
                (slowest, fastest) = (slowest.min(speed), fastest.max(speed));
            }
            speed *= base.law.at(contact, speed, unknowns).0;
        }
        count += (to - from).min(trial.heights.len() + trial.moments.len());
    }
    (slowest, fastest, count)
}

/// What is fitted beside one COR, as name, description, model and the COR to start from.
fn rivals(base: &Flight, ball: Option<f64>, (slowest, fastest, count): (f64, f64, usize)) -> Vec<Rival> {
    let factor = fastest / slowest;
    let spans = factor.is_finite() && slowest > 0.0;
    let of = |law| Flight { law, ..base.clone() };
    let mut list = Vec::new();
    let mut push = |name, model| list.push(Rival { name, missing: None, model });
    if spans && factor >= SPEEDS && count >= TREND {
        let (low, high, middle) = (slowest, fastest, (slowest * fastest).sqrt());
        push(CorModel::Linear, of(CorLaw::Linear { low, high }));
        push(CorModel::Viscoelastic, of(CorLaw::Viscoelastic { high }));
        push(CorModel::Plastic, of(CorLaw::Plastic { middle }));
        push(CorModel::Power, of(CorLaw::Power { middle }));
        let knots = if count >= 2 * TREND { 4 } else { 3 };
        let at = |k: usize| slowest * powf(factor, k as f64 / (knots - 1) as f64);
        push(CorModel::Knots, of(CorLaw::Knots((0..knots).map(at).collect())));
    }
    if spans && factor > DRAG_SPEEDS {
        push(CorModel::Drag, Flight { drag: true, ..base.clone() });
    }
    let timed = base.trials.iter().any(|t| !t.moments.is_empty());
    if timed && spans && factor > DRAG_SPEEDS {
        push(CorModel::Contact, Flight { lasting: Some(LONGEST_CONTACT), ..base.clone() });
    }
    let heights = base.trials.iter().any(|t| !t.heights.is_empty());
    if heights && spans && factor >= SPEEDS.sqrt() && count >= OFFSET_IMPACTS {
        let lowest = base.trials.iter().flat_map(|t| &t.heights).map(|h| h.1).fold(f64::INFINITY, f64::min);
        // No ball is higher than where it is let go; the lowest reading may well lie within the
        // error of the zero.
        let high = ball.unwrap_or(LARGEST_BALL).min(0.9 * base.tallest().max(lowest));
        let offset = Flight { offset: Some(Bounds { low: 0.0, high }), ..base.clone() };
        if base.trials.iter().all(|t| t.release.is_some()) {
            let rebounds = Flight { rebounds: true, ..offset.clone() };
            push(CorModel::Rebounds, rebounds);
        }
        push(CorModel::Offset, offset);
    }
    // Times alone do not tell how fast the ball came to the first contact, and so not the COR
    // there.
    let bounces = base.bounces();
    if heights && (2..=BOUNCES).contains(&bounces) {
        push(CorModel::Each, of(CorLaw::Each(bounces)));
    }
    list.extend(missed(base));
    list
}

/// One COR if one rebound is not in the table: those after it count one more. The place that leaves
/// least is one more unknown.
fn missed(base: &Flight) -> Option<Rival> {
    let rows: usize = base.trials.iter().map(|t| t.heights.len()).sum();
    if rows > FEW || base.trials.iter().any(|t| !t.moments.is_empty()) {
        return None;
    }
    let mut best: Option<(f64, Missing, Flight)> = None;
    for (block, trial) in base.trials.iter().enumerate() {
        let of = (base.trials.len() > 1).then_some(block);
        let first = usize::from(trial.release.is_none());
        for (place, &(after, ..)) in
            trial.heights.iter().enumerate().skip(first).filter(|_| trial.heights.len() + 1 >= RUN)
        {
            let mut model = base.clone();
            model.trials[block].heights[place..].iter_mut().for_each(|h| h.0 += 1);
            let Some(fitted) = run(&model, &[0.7], None) else { continue };
            if best.as_ref().is_none_or(|b| fitted.chi_square < b.0) {
                best = Some((fitted.chi_square, Missing { before: after, trial: of }, model));
            }
        }
    }
    best.map(|(_, missing, model)| Rival { name: CorModel::Missed, missing: Some(missing), model })
}

/// A model to be tried.
struct Rival {
    name: CorModel,
    missing: Option<Missing>,
    model: Flight,
}

/// Fits the models, that of one COR first, and returns them with the best first; empty where there
/// is nothing to compare.
pub(crate) fn compare(readings: &Readings, cor: f64) -> Result<Compared, FitError> {
    let mut compared = Compared::default();
    let rows: usize = readings.trials.iter().map(|t| t.heights.len() + t.moments.len()).sum();
    let base = Flight { trials: readings.trials.clone(), gravity: readings.gravity, ..Flight::default() };
    let long = base.bounces() > FOLLOWED;
    if rows > READINGS || long || !(0.01..1.0).contains(&cor) {
        compared.untried = Some(match (rows > READINGS, long) {
            (true, _) => Untried::Readings { most: READINGS },
            (_, true) => Untried::Bounces { most: FOLLOWED },
            _ => Untried::Extreme,
        });
        return Ok(compared);
    }
    let Some(constant) = run(&base, &[cor], None) else { return Ok(compared) };
    let speeds = impacts(&base, &constant);
    let (slowest, fastest, count) = speeds;
    compared.untried = readings.wanted.map(|wanted| Untried::Needs { need: needs(wanted, &base, speeds) });
    if count < TREND || fastest / slowest < SPEEDS {
        compared.notes.push(Finding::note(FindingKind::SpeedNotTried {
            bounces: count,
            factor: (fastest / slowest).max(1.0),
            needs_bounces: TREND,
            needs_factor: SPEEDS,
        }));
    }
    let mut all = vec![Rival { name: CorModel::Constant, missing: None, model: base.clone() }];
    all.extend(rivals(&base, readings.ball, speeds));
    let tried: Result<Vec<_>, FitError> =
        all.into_par_iter().map(|rival| tried(rival, readings, &constant, speeds)).collect();
    let mut list: Vec<Tried> = tried?.into_iter().flatten().collect();
    let Some(reference) = list.iter().find(|m| m.0.chosen).map(|m| (m.0.bic, m.0.aicc)) else { return Ok(compared) };
    for (choice, ..) in &mut list {
        choice.bic -= reference.0;
        choice.aicc = choice.aicc.zip(reference.1).map(|(a, b)| a - b);
    }
    // No ball gains speed at a bounce: a model that needs that is out of the question.
    list.retain(|m| m.0.chosen || m.0.cor.value <= 1.0);
    // Nor does a contact of a ball that bounces last longer than that.
    list.retain(|m| m.0.contact_s.is_none_or(|c| c.value < LONGEST_CONTACT));
    // Models as good as each other stand in the order in which they are tried. (Nothing is added
    // for the sign of zero.)
    let rank = |m: &Tried| (m.0.bic / TIE).round() + 0.0;
    list.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    // Where one COR stands alone there is nothing for the trials to decide.
    let disputed = list.iter().filter(|m| m.0.bic < WEAK).count() > 1;
    for (choice, model, fitted) in list.iter_mut().filter(|m| disputed && m.0.bic < WEAK) {
        choice.left_out = left_out(model, fitted)?;
    }
    let best = list.first().map_or(0.0, |m| m.0.bic);
    let wanted = |choice: &ModelChoice| {
        let asked = readings.wanted.is_some_and(|wanted| wanted == choice.name);
        asked || choice.bic < best + CLEAR && (!choice.chosen || readings.joint)
    };
    list.par_iter_mut().filter(|m| wanted(&m.0)).try_for_each(|(choice, model, fitted)| {
        choice.losses = under_losses(choice, model, fitted, (slowest, fastest), &readings.losses)?;
        Ok(())
    })?;
    compared.models = list.into_iter().map(|m| m.0).collect();
    Ok(compared)
}

/// What a model needs that the readings do not give.
fn needs(wanted: CorModel, base: &Flight, (slowest, fastest, count): (f64, f64, usize)) -> Need {
    let here_factor = (fastest / slowest).max(1.0);
    let speeds = |bounces: Option<usize>, factor: f64| Need::Speeds { bounces, factor, here: count, here_factor };
    let heights = base.trials.iter().any(|t| !t.heights.is_empty());
    let spread = fastest / slowest;
    match wanted {
        CorModel::Each | CorModel::Offset | CorModel::Rebounds if !heights => Need::Heights,
        CorModel::Rebounds if base.trials.iter().any(|t| t.release.is_none()) => Need::Releases,
        CorModel::Contact if base.trials.iter().all(|t| t.moments.is_empty()) => Need::Times,
        CorModel::Each if base.bounces() > BOUNCES => Need::FewBounces { most: BOUNCES },
        CorModel::Drag | CorModel::Contact if spread <= DRAG_SPEEDS => speeds(None, DRAG_SPEEDS),
        CorModel::Offset | CorModel::Rebounds if spread < SPEEDS.sqrt() || count < OFFSET_IMPACTS => {
            speeds(Some(OFFSET_IMPACTS), SPEEDS.sqrt())
        }
        CorModel::Linear | CorModel::Viscoelastic | CorModel::Plastic | CorModel::Power | CorModel::Knots
            if spread < SPEEDS || count < TREND =>
        {
            speeds(Some(TREND), SPEEDS)
        }
        _ => Need::Spare { readings: SPARE },
    }
}

/// A model that was tried: what it is in words, and its fit.
type Tried = (ModelChoice, Flight, Fitted);

/// Fits a model from the fit of one COR, over the speeds of the impacts that one tells of; `None`
/// where it cannot be compared.
fn tried(
    Rival { name, missing, model }: Rival,
    readings: &Readings,
    constant: &Fitted,
    (slowest, fastest, _): (f64, f64, usize),
) -> Result<Option<Tried>, FitError> {
    let mut start = model.law.start(constant.shared[0]);
    start.extend(model.offset.map(|b| 0.1 * b.high));
    start.extend(model.drag.then_some(0.01));
    start.extend(model.lasting.map(|most| 0.1 * most));
    let Some(fitted) = run(&model, &start, Some(&constant.own)).filter(|fitted| fitted.freedom >= SPARE) else {
        return Ok(None);
    };
    let n = used(&model) as f64;
    // The place of a rebound that is missing was looked for too.
    let p = n - fitted.freedom as f64 + if name == CorModel::Missed { 1.0 } else { 0.0 };
    let Readings { scattered, least, .. } = *readings;
    let misfit = Misfit { chi_square: fitted.chi_square, readings: n, unknowns: p, scattered, least };
    let bic = if readings.scattered { misfit.by_scatter() } else { misfit.by_errors(1.0) };
    let cor = if model.law.of_speed() {
        at(&model, &fitted, (slowest * fastest).sqrt())
    } else {
        mean(&fitted, model.law.unknowns())
    };
    let mut choice = ModelChoice::new(name, cor, bic);
    choice.missing = missing;
    choice.misfit = Some(misfit);
    choice.p = chi_square_p(fitted.chi_square, fitted.freedom).filter(|_| !readings.scattered);
    choice.aicc = (n > p + 1.0).then(|| bic - p * ln(n) + 2.0 * p + 2.0 * p * (p + 1.0) / (n - p - 1.0));
    if model.law.of_speed() {
        let (slowest, fastest, _) = impacts(&model, &fitted);
        let speed = |k: usize| slowest * powf(fastest / slowest, k as f64 / (LISTED - 1) as f64);
        let point = |k| {
            let Measured { value: cor, standard_error } = at(&model, &fitted, speed(k));
            SpeedCor { speed: speed(k), cor, standard_error }
        };
        choice.speeds = (0..LISTED).map(point).collect();
    }
    choice.slope = (name == CorModel::Linear).then(|| slope(&fitted, (slowest, fastest)));
    choice.exponent = (name == CorModel::Power).then(|| fitted.measured(1));
    choice.offset_m = model.offset_place().map(|j| fitted.measured(j));
    choice.drag = model.drag_place().map(|j| fitted.measured(j));
    choice.contact_s = model.lasting_place().map(|j| fitted.measured(j));
    if let Some(j) = model.offset_place().or(model.drag_place()).or(model.lasting_place()).filter(|&j| fitted.active[j])
    {
        let found = identified("a limit", limit(&model, &fitted, j))?;
        choice.limit = found.map(|limit| Limit { bound: fitted.shared[j], limit });
    }
    choice.chosen = name == CorModel::Constant;
    Ok(Some((choice, model, fitted)))
}

/// The numbers of a model under other losses.
fn under_losses(
    choice: &ModelChoice,
    model: &Flight,
    fitted: &Fitted,
    (slowest, fastest): (f64, f64),
    losses: &[Loss],
) -> Result<Vec<UnderLoss>, FitError> {
    let cors = model.law.unknowns();
    let mut list = Vec::new();
    for &loss in losses {
        let found = robust::fit(model, loss, &fitted.shared, &fitted.own, false);
        let Some(found) = identified("a model under another loss", found)?.flatten() else { continue };
        let unknown = |j: usize| found.shared[j];
        let cor = if model.law.of_speed() {
            model.law.at(0, (slowest * fastest).sqrt(), &found.shared[..cors]).0
        } else {
            shares(fitted, cors).iter().zip(&found.shared).map(|(share, cor)| share * cor).sum()
        };
        list.push(UnderLoss {
            loss,
            cor,
            slope: choice.slope.map(|_| (unknown(1) - unknown(0)) / (fastest - slowest)),
            exponent: choice.exponent.map(|_| unknown(1)),
            drag: model.drag_place().map(unknown),
            offset_m: model.offset_place().map(unknown),
        });
    }
    Ok(list)
}

/// The COR at a speed, under a law.
fn at(model: &Flight, fitted: &Fitted, speed: f64) -> Measured {
    let (value, _, by) = model.law.at(0, speed, &fitted.shared[..model.law.unknowns()]);
    Measured { value, standard_error: fitted.error_of(&by) }
}

/// Fits one model, from other own unknowns if they are given. One that cannot be fitted, or whose
/// solution does not pass its checks, is no rival.
fn run(model: &Flight, shared: &[f64], own: Option<&Vec<Vec<f64>>>) -> Option<Fitted> {
    let own = own.cloned().unwrap_or_else(|| model.start(shared[0]));
    fit(model, shared, own).ok()
}

/// The readings of blocks that say something.
fn used(model: &Flight) -> usize {
    (0..model.trials.len()).map(|b| model.size(b)).filter(|(m, q)| m > q).map(|(m, _)| m).sum()
}

/// The shares of the CORs in their mean, where each weighs by its own variance.
fn shares(fitted: &Fitted, cors: usize) -> Vec<f64> {
    let weights: Vec<f64> = (0..cors).map(|j| 1.0 / fitted.covariance[(j, j)].max(1e-24)).collect();
    let total: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / total).collect()
}

/// The mean of the CORs.
fn mean(fitted: &Fitted, cors: usize) -> Measured {
    let shares = shares(fitted, cors);
    let value = shares.iter().zip(&fitted.shared).map(|(share, cor)| share * cor).sum();
    Measured { value, standard_error: fitted.error_of(&shares) }
}

/// The chi-square per reading of each trial under the model fitted to the others.
fn left_out(model: &Flight, whole: &Fitted) -> Result<Option<f64>, FitError> {
    let count = model.trials.len();
    if !(2..=TRIALS).contains(&count) || used(model) > TELLING {
        return Ok(None);
    }
    let (mut sum, mut rows) = (0.0, 0);
    for j in 0..count {
        let (mut rest, mut own) = (Flight { supposed: true, ..model.clone() }, whole.own.clone());
        let trial = rest.trials.remove(j);
        let left = own.remove(j);
        let Some(others) = run(&rest, &whole.shared, Some(&own)) else { return Ok(None) };
        let alone =
            Flight { trials: vec![trial], pinned: Some(others.shared.clone()), supposed: true, ..model.clone() };
        if used(&alone) == 0 {
            continue;
        }
        let Some(found) = run(&alone, &others.shared, Some(&vec![left])) else { return Ok(None) };
        (sum, rows) = (sum + found.chi_square, rows + used(&alone));
    }
    Ok((rows > 0).then(|| sum / rows as f64))
}
