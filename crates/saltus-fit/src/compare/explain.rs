//! Do heights and times agree, and if not, what would reconcile them?

use serde::{Deserialize, Serialize};

use crate::elementary::exp;
use crate::error::FitError;
use crate::evidence::Evidence;
use crate::model::{FOLLOWED, FlightTrial, READINGS};
use crate::quantity::{Explanation, Measured};
use crate::solve::fits::Fits;
use crate::solve::joint::{Joint, Suppose, run, slope};
use crate::solve::successive::Fitted;
use crate::statistics::{REJECT, chi_square_p};

/// An explanation fits readings worth less than was stated where chance alone gives its chi-square
/// this often: the usual level, above [`REJECT`], since larger errors let almost any explanation
/// pass.
const GENEROUS: f64 = 0.05;

/// How well heights and times go together under free flight with one COR.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Agreement {
    /// The chi-square of the joint fit.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// The probability of one as large by chance.
    pub p: Option<f64>,
    /// The contacts, each with the time that the measured heights predict for it.
    pub conflicts: Vec<Conflict>,
    /// The largest disagreement of a contact time with the measured heights, in seconds.
    pub largest_conflict_s: Option<f64>,
    /// The same in frames of the camera, where the frame rate is known.
    pub largest_conflict_frames: Option<f64>,
    /// A COR that ends at the measured time of the last contact all the same, and the rebounds it
    /// would mean.
    pub total_time: Option<TotalTime>,
    /// What gravity would have to be for each flight to reach the measured height in the measured
    /// time.
    pub flights: Vec<ImpliedGravity>,
}

impl Agreement {
    /// Whether heights and times contradict each other.
    pub(crate) fn rejected(&self) -> bool {
        self.p.is_some_and(|p| p < REJECT)
    }
}

/// A contact time beside the one that the measured heights predict by free flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Conflict {
    /// The trial's place in the table, from 0.
    pub trial: usize,
    /// The number of the contact, from 1.
    pub contact: usize,
    /// The measured time, in seconds.
    pub measured_s: f64,
    /// The time predicted from the measured heights, in seconds.
    pub predicted_s: f64,
    /// Measured less predicted, in frames of the camera.
    pub frames: Option<f64>,
}

/// The gravity that one flight's height and duration imply: 2h/t² for the fall, 8h/t² for a flight
/// between contacts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ImpliedGravity {
    /// The trial's place in the table, from 0.
    pub trial: usize,
    /// The number of the contact before the flight; 0 is the fall.
    pub flight: usize,
    /// In m/s².
    pub gravity: f64,
}

/// Why the agreement of a total time validates nothing: one COR always gives it, whatever the
/// heights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct TotalTime {
    /// The time from the release to the last contact, in seconds.
    pub time_s: f64,
    /// The COR that gives it.
    pub cor: f64,
    /// The rebound heights that this COR predicts, in metres.
    pub heights_m: Vec<f64>,
}

/// An explanation tried on a table whose heights and times disagree, and the measurement that would
/// settle it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Hypothesis {
    /// Which one.
    pub name: Explanation,
    /// What it supposes, for people.
    pub about: String,
    /// The COR under it; none if it has one for each bounce.
    pub cor: Option<Measured>,
    /// The CORs bounce by bounce, where it has several.
    pub cors: Vec<f64>,
    /// The height that the scale shows for a ball on the floor, in metres.
    pub offset_m: Option<Measured>,
    /// The reading of the clock at the release, less the one noted, in seconds.
    pub lag_s: Option<Measured>,
    /// The drag coefficient, in 1/m.
    pub drag: Option<Measured>,
    /// How the COR changes with speed, per m/s.
    pub slope: Option<Measured>,
    /// Its chi-square.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// The probability of a chi-square as large by chance.
    pub p: Option<f64>,
    /// The same fit if the readings are worth less than was stated.
    pub generous: Option<Generous>,
    /// What to measure to find out.
    pub settle: String,
    /// After which contact one was overlooked, where that is what it supposes; 0 is before the
    /// first one noted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub overlooked_after: Option<usize>,
}

impl Hypothesis {
    /// By name, with how well it fits and nothing else known.
    fn of(name: Explanation, fitted: &Fitted) -> Self {
        Self {
            name,
            about: String::new(),
            cor: None,
            cors: Vec::new(),
            offset_m: None,
            lag_s: None,
            drag: None,
            slope: None,
            chi_square: fitted.chi_square,
            degrees_of_freedom: fitted.freedom,
            p: chi_square_p(fitted.chi_square, fitted.freedom),
            generous: None,
            settle: String::new(),
            overlooked_after: None,
        }
    }

    /// Whether it fits, if need be with the readings worth less than was stated.
    pub(crate) fn fits(&self) -> bool {
        let generous = self.generous.as_ref().and_then(|generous| generous.p);
        self.p.is_some_and(|p| p >= REJECT) || generous.is_some_and(|p| p >= GENEROUS)
    }
}

/// A fit repeated with larger reading errors: twice the heights', and a whole frame (else twice the
/// times').
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Generous {
    /// The error of heights, in metres.
    pub sigma_height: f64,
    /// The error of times, in seconds.
    pub sigma_time: f64,
    /// The COR, where there is one.
    pub cor: Option<f64>,
    /// The chi-square.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// The probability of one as large by chance.
    pub p: Option<f64>,
}

/// The agreement that a joint fit shows, where there is one.
pub(crate) fn agreement(fits: &Fits<'_>) -> Option<Agreement> {
    fits.joint.as_ref().map(|joint| of_joint(joint, fits.evidence, fits.gravity.value, fits.frame.map(f64::recip)))
}

/// What could explain heights and times that disagree, or heights that show a trend.
pub(crate) fn hypotheses(fits: &Fits<'_>, agreement: Option<&Agreement>) -> Result<Vec<Hypothesis>, FitError> {
    let (sigma_height, sigma_time) = (fits.sigma_height.value, fits.sigma_time.value);
    match (&fits.joint, agreement) {
        (Some(joint), Some(agreement)) if agreement.rejected() => of_both(joint, sigma_height, sigma_time, fits.frame),
        (Some(_), _) => Ok(Vec::new()),
        (None, _) => {
            let trend = fits.heights.as_ref().filter(|k| k.trend.is_some_and(|p| p < REJECT));
            let Some(kind) = trend else { return Ok(Vec::new()) };
            let one_cor = (exp(kind.fitted.shared[0]), fits.gravity.value, sigma_height);
            Ok(height_zero(fits.evidence, one_cor)?.into_iter().collect())
        }
    }
}

fn of_joint(joint: &Joint, evidence: &Evidence, gravity: f64, frame_rate: Option<f64>) -> Agreement {
    let mut conflicts = Vec::new();
    let mut flights = Vec::new();
    let mut total = None;
    for trial in evidence.trials.iter().filter(|t| joint.trials.binary_search(&t.trial).is_ok()) {
        let height = |n: usize| trial.heights.iter().find(|h| h.0 == n).map(|h| h.1);
        let fall = height(0).map(|h| (2.0 * h / gravity).sqrt());
        let mut clock = match (trial.release_time, fall) {
            (Some(release), Some(fall)) => Some(release + fall),
            _ => trial.contact(1),
        };
        if let (Some(release), Some(contact), Some(h)) = (trial.release_time, trial.contact(1), height(0)) {
            flights.push(ImpliedGravity {
                trial: trial.trial,
                flight: 0,
                gravity: 2.0 * h / (contact - release).powi(2),
            });
        }
        let last = trial.moments.last().map_or(0, |m| m.0 + 1);
        if let (None, Some(release), Some(h), Some(end)) = (&total, trial.release_time, height(0), trial.contact(last))
        {
            total = total_time(end - release, (2.0 * h / gravity).sqrt(), last, h);
        }
        for contact in 1..=last.min(1000) {
            if contact > 1 {
                let flight = height(contact - 1).map(|h| 2.0 * (2.0 * h / gravity).sqrt());
                clock = clock.zip(flight).map(|(t, d)| t + d);
            }
            if let (Some(predicted_s), Some(measured_s)) = (clock, trial.contact(contact)) {
                let frames = frame_rate.map(|f| (measured_s - predicted_s) * f);
                conflicts.push(Conflict { trial: trial.trial, contact, measured_s, predicted_s, frames });
            }
            if let (Some(a), Some(b), Some(h)) = (trial.contact(contact), trial.contact(contact + 1), height(contact)) {
                let gravity = 8.0 * h / (b - a).powi(2);
                flights.push(ImpliedGravity { trial: trial.trial, flight: contact, gravity });
            }
        }
    }
    conflicts.truncate(100);
    flights.truncate(100);
    let size = |c: &Conflict| (c.measured_s - c.predicted_s).abs();
    let largest = conflicts.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
    Agreement {
        chi_square: joint.estimate.chi_square.unwrap_or(joint.fitted.chi_square),
        degrees_of_freedom: joint.estimate.degrees_of_freedom.unwrap_or(joint.fitted.freedom),
        p: joint.estimate.p,
        total_time: total,
        largest_conflict_s: largest.map(size),
        largest_conflict_frames: largest.and_then(|c| c.frames).map(f64::abs),
        conflicts,
        flights,
    }
}

/// The COR with which contact `last` comes at `time` after a fall of `fall` seconds from `height`:
/// t = fall (1 + 2 (e + e² + …)).
fn total_time(time: f64, fall: f64, last: usize, height: f64) -> Option<TotalTime> {
    let last = last.min(1000);
    let flights = |e: f64| (1..last).fold((0.0, 1.0), |(sum, power), _| (sum + power * e, power * e)).0;
    let wanted = (time / fall - 1.0) / 2.0;
    let (mut low, mut high) = (0.0, 1.0);
    if last < 3 || wanted <= flights(low) || wanted >= flights(high) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if flights(middle) < wanted { low = middle } else { high = middle }
    }
    let heights = (1..last).scan(height, |h, _| {
        *h *= low * low;
        Some(*h)
    });
    Some(TotalTime { time_s: time, cor: low, heights_m: heights.take(12).collect() })
}

/// The explanations for a joint fit that failed, best first.
fn of_both(joint: &Joint, sigma_height: f64, sigma_time: f64, frame: Option<f64>) -> Result<Vec<Hypothesis>, FitError> {
    let generous_time = frame.filter(|f| *f > sigma_time).unwrap_or(2.0 * sigma_time);
    let (tall, long) = (2.0, generous_time / sigma_time);
    // What could explain a disagreement shows in some of very many trials as in all.
    let some: Vec<FlightTrial> = joint.model.trials.iter().step_by(joint.thinned()).cloned().collect();
    let trials = &some;
    let loose: Vec<FlightTrial> = trials.iter().map(|t| loosened(t, tall, long)).collect();
    let known_clock = trials.iter().any(|t| t.release_time.is_some());
    let starts = [joint.fitted.shared[0], 0.5];
    let mut found = Vec::new();
    let speed = joint.model.first_contact(0, &joint.fitted.shared, &joint.fitted.own[0]).0;
    let later = i32::try_from(joint.model.bounces().saturating_sub(1)).unwrap_or(i32::MAX);
    let slowest = speed * joint.fitted.shared[0].powi(later).clamp(0.01, 0.9);
    let none = Suppose::default();
    let cases = [
        (Suppose { offset: true, ..none }, Explanation::HeightZero),
        (Suppose { per_bounce: true, ..none }, Explanation::CorPerBounce),
        (Suppose { lag: true, ..none }, Explanation::ClockLag),
        (Suppose { drag: true, ..none }, Explanation::AirDrag),
        (Suppose { slope: Some((slowest, speed)), ..none }, Explanation::CorOfSpeed),
    ];
    for (suppose, name) in cases {
        if suppose.lag && !known_clock || suppose.per_bounce && joint.model.bounces() > 12 {
            continue;
        }
        let Some((model, fitted)) = run(trials, joint.model.gravity, suppose, &starts)? else { continue };
        if fitted.freedom == 0 {
            continue;
        }
        let generous = run(&loose, joint.model.gravity, suppose, &starts[..1])?.map(|(_, f)| Generous {
            sigma_height: tall * sigma_height,
            sigma_time: generous_time,
            cor: (!suppose.per_bounce).then(|| f.shared[usize::from(suppose.slope.is_some())]),
            chi_square: f.chi_square,
            degrees_of_freedom: f.freedom,
            p: chi_square_p(f.chi_square, f.freedom),
        });
        found.push(Hypothesis {
            // A COR that depends on speed is given at the first impact.
            cor: (!suppose.per_bounce).then(|| fitted.measured(usize::from(suppose.slope.is_some()))),
            cors: if suppose.per_bounce { fitted.shared[..model.law.unknowns()].to_vec() } else { Vec::new() },
            offset_m: suppose.offset.then(|| fitted.measured(1)),
            lag_s: suppose.lag.then(|| fitted.measured(1)),
            drag: suppose.drag.then(|| fitted.measured(1)),
            slope: suppose.slope.map(|speeds| slope(&fitted, speeds)),
            generous,
            ..Hypothesis::of(name, &fitted)
        });
    }
    found.extend(missed_contact(joint)?);
    found.sort_by(|a, b| b.p.unwrap_or(0.0).total_cmp(&a.p.unwrap_or(0.0)));
    Ok(found)
}

/// Whether the readings of a single trial would agree if one contact had been overlooked, and
/// which.
fn missed_contact(joint: &Joint) -> Result<Option<Hypothesis>, FitError> {
    let [trial] = joint.model.trials.as_slice() else { return Ok(None) };
    let bounces = joint.model.bounces();
    if bounces > 12 {
        return Ok(None);
    }
    let mut best: Option<(usize, Fitted)> = None;
    for after in 0..=bounces {
        let mut shifted = trial.clone();
        shifted.heights.iter_mut().filter(|h| h.0 > after).for_each(|h| h.0 += 1);
        shifted.moments.iter_mut().filter(|m| m.flights >= after).for_each(|m| m.flights += 1);
        let Some((_, fitted)) =
            run(&[shifted], joint.model.gravity, Suppose::default(), &[joint.fitted.shared[0], 0.7])?
        else {
            continue;
        };
        if best.as_ref().is_none_or(|(_, b)| fitted.chi_square < b.chi_square) {
            best = Some((after, fitted));
        }
    }
    let Some((after, fitted)) = best.filter(|(_, f)| f.freedom > 0) else { return Ok(None) };
    let cor = Some(fitted.measured(0));
    let overlooked_after = Some(after);
    Ok(Some(Hypothesis { cor, overlooked_after, ..Hypothesis::of(Explanation::MissedContact, &fitted) }))
}

/// Whether heights alone that show a trend would fit one COR if the zero of their scale were off.
fn height_zero(evidence: &Evidence, (cor, gravity, sigma): (f64, f64, f64)) -> Result<Option<Hypothesis>, FitError> {
    let trials = FlightTrial::of_heights(evidence, sigma);
    let long = trials.iter().any(|t| t.heights.last().is_some_and(|h| h.0 > FOLLOWED));
    if long || trials.iter().map(|t| t.heights.len()).sum::<usize>() > READINGS {
        return Ok(None);
    }
    let suppose = Suppose { offset: true, ..Suppose::default() };
    let Some((_, fitted)) = run(&trials, gravity, suppose, &[cor])? else { return Ok(None) };
    if fitted.freedom == 0 {
        return Ok(None);
    }
    let (cor, offset_m) = (Some(fitted.measured(0)), Some(fitted.measured(1)));
    Ok(Some(Hypothesis { cor, offset_m, ..Hypothesis::of(Explanation::HeightZero, &fitted) }))
}

/// The same trial with larger errors.
fn loosened(trial: &FlightTrial, tall: f64, long: f64) -> FlightTrial {
    let mut trial = trial.clone();
    trial.heights.iter_mut().for_each(|h| h.2 *= tall);
    trial.moments.iter_mut().for_each(|m| m.sigma *= long);
    trial.release = trial.release.map(|(h, s)| (h, s.map(|s| s * tall)));
    trial
}
