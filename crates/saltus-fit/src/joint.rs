//! Heights and times under one motion: do they agree, and if not, what would reconcile them?

use serde::Serialize;

use crate::bounces::Measured;
use crate::diagnose::REJECT;
use crate::error::FitError;
use crate::estimate::{Estimate, Source, identified, with_spread};
use crate::evidence::Evidence;
use crate::least_squares::Bounds;
use crate::model::{CorLaw, Flight, FlightTrial};
use crate::rivals::{FOLLOWED, READINGS, Readings};
use crate::spread::{Apart, across};
use crate::statistics::{NORMAL, chi_square_p};
use crate::successive::{Fitted, fit};

/// After so many drops fitted one by one, a chi-square less probable than this is the end of it.
const MANY: usize = 500;
const HOPELESS: f64 = 1e-9;

/// How well heights and times go together under free flight with one COR.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
    /// A COR that ends at the measured time of the last contact all the same, and the rebounds it would mean.
    pub total_time: Option<TotalTime>,
    /// What gravity would have to be for each flight to reach the measured height in the measured time.
    pub flights: Vec<ImpliedGravity>,
}

/// A contact time beside the one that the measured heights predict by free flight.
#[derive(Clone, Debug, PartialEq, Serialize)]
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

/// The gravity that one flight's height and duration imply: 2h/t² for the fall, 8h/t² for a flight between contacts.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ImpliedGravity {
    /// The trial's place in the table, from 0.
    pub trial: usize,
    /// The number of the contact before the flight; 0 is the fall.
    pub flight: usize,
    /// In m/s².
    pub gravity: f64,
}

/// Why the agreement of a total time validates nothing: one COR always gives it, whatever the heights.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TotalTime {
    /// The time from the release to the last contact, in seconds.
    pub time_s: f64,
    /// The COR that gives it.
    pub cor: f64,
    /// The rebound heights that this COR predicts, in metres.
    pub heights_m: Vec<f64>,
}

/// An explanation tried on a table whose heights and times disagree, and the measurement that would settle it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Hypothesis {
    /// A fixed word: `height-zero`, `cor-per-bounce`, `clock-lag`, `air-drag`, `cor-of-speed`, `missed-contact`.
    pub name: String,
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
    /// The same fit if the readings are worth less than was said.
    pub generous: Option<Generous>,
    /// What to measure to find out.
    pub settle: String,
}

impl Hypothesis {
    /// By name, what it supposes and what settles it, with how well it fits and nothing else known.
    fn of([name, about, settle]: [&str; 3], fitted: &Fitted) -> Self {
        Self {
            name: name.to_owned(),
            about: about.to_owned(),
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
            settle: settle.to_owned(),
        }
    }
}

/// A fit repeated with larger reading errors: twice the heights', and a whole frame (else twice the times').
#[derive(Clone, Debug, PartialEq, Serialize)]
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

/// The joint fit and what it was fitted to.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) estimate: Estimate,
    pub(crate) model: Flight,
    pub(crate) fitted: Fitted,
    /// For each block the trial's place in the table.
    pub(crate) trials: Vec<usize>,
    /// The standard deviation of the COR from drop to drop, where heights and times agree in every drop, but not on one COR for all.
    pub(crate) spread: Option<f64>,
}

impl Joint {
    /// Explanations are tried on one trial in so many.
    pub(crate) fn thinned(&self) -> usize {
        let rows: usize = self.model.trials.iter().map(|t| t.heights.len() + t.moments.len()).sum();
        rows.div_ceil(READINGS).max(1)
    }
}

/// What the variants of the joint model suppose.
#[derive(Clone, Copy, Default)]
struct Suppose {
    offset: bool,
    lag: bool,
    per_bounce: bool,
    drag: bool,
    /// A COR linear in speed, between these speeds.
    slope: Option<(f64, f64)>,
}

/// The sum of squares may have several minima: the lowest that the starts lead to.
fn run(
    trials: &[FlightTrial],
    gravity: f64,
    suppose: Suppose,
    starts: &[f64],
) -> Result<Option<(Flight, Fitted)>, FitError> {
    let mut model =
        Flight { trials: trials.to_vec(), gravity, lag: suppose.lag, drag: suppose.drag, ..Flight::default() };
    if suppose.offset {
        let tallest = model.tallest();
        model.offset = Some(Bounds { low: -tallest, high: 0.9 * tallest });
    }
    if suppose.per_bounce {
        model.law = CorLaw::Each(model.bounces().max(1));
    } else if let Some((low, high)) = suppose.slope {
        model.law = CorLaw::Linear { low, high };
    }
    let extra = usize::from(suppose.offset) + usize::from(model.lag);
    let mut best: Option<(Flight, Fitted)> = None;
    for &e in starts {
        let mut shared = model.law.start(e);
        shared.extend(vec![0.0; extra]);
        shared.extend(suppose.drag.then_some(0.01));
        let own = model.start(e);
        let Some(found) = identified("heights and times together", fit(&model, &shared, own))? else { continue };
        if best.as_ref().is_none_or(|(_, b)| found.chi_square < b.chi_square) {
            best = Some((model.clone(), found));
        }
    }
    Ok(best)
}

/// Fits one COR to heights and times together; `None` where no trial has both.
pub(crate) fn joint(
    evidence: &Evidence,
    gravity: f64,
    sigma_height: f64,
    sigma_time: f64,
) -> Result<Option<Joint>, FitError> {
    let (places, trials): (Vec<usize>, Vec<FlightTrial>) = evidence.joint(sigma_height, sigma_time).into_iter().unzip();
    let bounces = |t: &FlightTrial| t.heights.last().map_or(0, |h| h.0).max(t.moments.last().map_or(0, |m| m.flights));
    if trials.is_empty() || trials.iter().any(|t| bounces(t) > FOLLOWED) {
        return Ok(None);
    }
    let Some((model, fitted)) = run(&trials, gravity, Suppose::default(), &[0.3, 0.55, 0.8, 0.95])? else {
        return Ok(None);
    };
    if fitted.freedom == 0 || fitted.active[0] {
        return Ok(None);
    }
    let about = "heights and times together under free flight with one COR, the release height taken as set";
    let error = fitted.covariance[(0, 0)].sqrt();
    let mut estimate = Estimate::new("joint", about, fitted.shared[0], error, NORMAL);
    estimate.trials = trials.len();
    estimate.chi_square = Some(fitted.chi_square);
    estimate.degrees_of_freedom = Some(fitted.freedom);
    estimate.p = chi_square_p(fitted.chi_square, fitted.freedom);
    let mut joint = Joint { estimate, model, fitted, trials: places, spread: None };
    if joint.estimate.p.is_some_and(|p| p < REJECT)
        && let Some(apart) = apart(&joint)?
        && apart.explains(joint.fitted.chi_square, Source::Stated, REJECT)
        && let Some(across) = across(&apart.cors)
    {
        joint.spread = Some(across.spread);
        joint.estimate = with_spread(joint.estimate, &across);
        joint.estimate.chi_square = Some(apart.chi_square);
        joint.estimate.degrees_of_freedom = Some(apart.freedom);
        joint.estimate.p = chi_square_p(apart.chi_square, apart.freedom);
    }
    Ok(Some(joint))
}

/// Heights and times together, trial by trial; `None` where one of them determines no COR.
fn apart(joint: &Joint) -> Result<Option<Apart>, FitError> {
    let mut found = Apart::default();
    for trial in &joint.model.trials {
        let starts = [joint.fitted.shared[0], 0.5];
        let alone = std::slice::from_ref(trial);
        let Some((_, fitted)) = run(alone, joint.model.gravity, Suppose::default(), &starts)? else { return Ok(None) };
        let cor = fitted.measured(0);
        if fitted.active[0] || !cor.standard_error.is_finite() || cor.standard_error <= 0.0 {
            return Ok(None);
        }
        found.chi_square += fitted.chi_square;
        found.freedom += fitted.freedom;
        // So many drops that are not explained by themselves are not made good by the rest.
        if found.cors.len() > MANY && chi_square_p(found.chi_square, found.freedom).is_some_and(|p| p < HOPELESS) {
            return Ok(None);
        }
        found.cors.push(cor);
    }
    Ok((found.cors.len() > 1).then_some(found))
}

/// The agreement that a joint fit shows.
pub(crate) fn agreement(joint: &Joint, evidence: &Evidence, gravity: f64, frame_rate: Option<f64>) -> Agreement {
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

/// The COR with which contact `last` comes at `time` after a fall of `fall` seconds from `height`: t = fall (1 + 2 (e + e² + …)).
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
pub(crate) fn hypotheses(
    joint: &Joint,
    sigma_height: f64,
    sigma_time: f64,
    frame: Option<f64>,
) -> Result<Vec<Hypothesis>, FitError> {
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
    let cases = [
        (
            Suppose { offset: true, ..Suppose::default() },
            "height-zero",
            "the zero of the height scale is off: heights were read at the wrong point of the ball, or from a line that is not the floor",
            "lay the ball on the floor and read its height on the same scale, the same way",
        ),
        (
            Suppose { per_bounce: true, ..Suppose::default() },
            "cor-per-bounce",
            "every bounce has a COR of its own",
            "repeat the drop from other heights: the COR must depend on the speed in the same way each time",
        ),
        (
            Suppose { lag: true, ..Suppose::default() },
            "clock-lag",
            "the clock was not at its noted time when the ball was let go",
            "film the release itself and count the frames from it",
        ),
        (
            Suppose { drag: true, ..Suppose::default() },
            "air-drag",
            "air drag slows the ball",
            "weigh the ball and measure its diameter: k = 0.28 kg/m\u{b3} x cross-section / mass, or drop a heavier one",
        ),
        (
            Suppose { slope: Some((slowest, speed)), ..Suppose::default() },
            "cor-of-speed",
            "the COR depends on the speed of impact",
            "repeat the drop from other heights: equal speeds must give equal CORs",
        ),
    ];
    for (suppose, name, about, settle) in cases {
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
            ..Hypothesis::of([name, about, settle], &fitted)
        });
    }
    found.extend(missed_contact(joint)?);
    found.sort_by(|a, b| b.p.unwrap_or(0.0).total_cmp(&a.p.unwrap_or(0.0)));
    Ok(found)
}

/// The slope of a COR that is known at two speeds, per m/s.
pub(crate) fn slope(fitted: &Fitted, (low, high): (f64, f64)) -> Measured {
    let apart = high - low;
    let standard_error = fitted.error_of(&[-1.0 / apart, 1.0 / apart]);
    Measured { value: (fitted.shared[1] - fitted.shared[0]) / apart, standard_error }
}

/// Whether the readings of a single trial would agree if one contact had been overlooked, and which.
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
    let place = if after == 0 { "before the first one noted".to_owned() } else { format!("after contact {after}") };
    let about = format!("a contact was overlooked {place}");
    let settle = "listen to the recording, or step through the film, around that time";
    let cor = Some(fitted.measured(0));
    Ok(Some(Hypothesis { cor, ..Hypothesis::of(["missed-contact", &about, settle], &fitted) }))
}

/// Whether heights alone that show a trend would fit one COR if the zero of their scale were off.
pub(crate) fn height_zero(
    evidence: &Evidence,
    (cor, gravity, sigma): (f64, f64, f64),
) -> Result<Option<Hypothesis>, FitError> {
    let trials = Readings::heights(evidence, sigma);
    let long = trials.iter().any(|t| t.heights.last().is_some_and(|h| h.0 > FOLLOWED));
    if long || trials.iter().map(|t| t.heights.len()).sum::<usize>() > READINGS {
        return Ok(None);
    }
    let suppose = Suppose { offset: true, ..Suppose::default() };
    let Some((_, fitted)) = run(&trials, gravity, suppose, &[cor])? else { return Ok(None) };
    if fitted.freedom == 0 {
        return Ok(None);
    }
    let about = "the zero of the height scale is off; from heights alone a COR that changes with speed looks alike";
    let settle = "lay the ball on the floor and read its height on the same scale, the same way";
    let (cor, offset_m) = (Some(fitted.measured(0)), Some(fitted.measured(1)));
    Ok(Some(Hypothesis { cor, offset_m, ..Hypothesis::of(["height-zero", about, settle], &fitted) }))
}

/// The same trial with larger errors.
fn loosened(trial: &FlightTrial, tall: f64, long: f64) -> FlightTrial {
    let mut trial = trial.clone();
    trial.heights.iter_mut().for_each(|h| h.2 *= tall);
    trial.moments.iter_mut().for_each(|m| m.sigma *= long);
    trial.release = trial.release.map(|(h, s)| (h, s.map(|s| s * tall)));
    trial
}
