//! The fitted motion as parabolas, and where the readings stand beside it.

use serde::{Deserialize, Serialize};

use super::residual::{Mark, Measure, Point, Residual};
use crate::elementary::exp;
use crate::evidence::{Evidence, TrialEvidence};
use crate::model::{Contacts, Heights};
use crate::solve::fits::Fits;
use crate::solve::joint::Joint;
use crate::solve::kind::Kind;

/// So many readings are listed beside their motions, those of the first trials: no picture shows
/// more.
const LISTED: usize = 100_000;

/// The free-flight motion that was fitted to a trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Motion {
    /// The trial's place in the table, from 0.
    pub trial: usize,
    /// Gravity, in m/s².
    pub gravity: f64,
    /// The COR of the motion.
    pub cor: f64,
    /// When the ball is let go, in seconds, if the motion begins with a fall.
    pub release_time: Option<f64>,
    /// From which height, in metres.
    pub release_height: Option<f64>,
    /// The times of the contacts, in seconds, ascending.
    pub contacts: Vec<f64>,
    /// The height of the apex after each contact but the last, in metres.
    pub apexes: Vec<f64>,
    /// The flights in order, the fall first if there is one.
    pub flights: Vec<Arc>,
}

/// One flight: height = c₀ + c₁ s + c₂ s², with s the time since its start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Arc {
    /// When it starts, in seconds.
    pub start: f64,
    /// How long it lasts, in seconds.
    pub span: f64,
    /// c₀ in m, c₁ in m/s, c₂ in m/s².
    pub height: [f64; 3],
}

impl Motion {
    /// Builds the motion from its durations: those of the flights between contacts, and the fall
    /// before.
    fn of(trial: usize, [gravity, cor]: [f64; 2], release: Option<f64>, first: f64, durations: &[f64]) -> Self {
        let mut motion = Self {
            trial,
            gravity,
            cor,
            release_time: None,
            release_height: release,
            contacts: vec![first],
            apexes: Vec::new(),
            flights: Vec::new(),
        };
        if let Some(height) = release {
            let span = (2.0 * height / gravity).sqrt();
            motion.release_time = Some(first - span);
            motion.flights.push(Arc { start: first - span, span, height: [height, 0.0, -0.5 * gravity] });
        }
        let mut time = first;
        for &span in durations {
            motion.flights.push(Arc { start: time, span, height: [0.0, 0.5 * gravity * span, -0.5 * gravity] });
            motion.apexes.push(gravity * span * span / 8.0);
            time += span;
            motion.contacts.push(time);
        }
        motion
    }

    /// The time of contact `number`, from 1.
    fn contact(&self, number: usize) -> Option<f64> {
        self.contacts.get(number.checked_sub(1)?).copied()
    }
}

/// The contacts a trial's readings look at: up to the end of the flight of its last apex.
fn contacts(trial: &TrialEvidence) -> usize {
    let apex = trial.heights.iter().map(|h| h.0 + 1).max().unwrap_or(1);
    let moment = trial.moments.iter().map(|m| m.0 + 1 + usize::from(m.1)).max().unwrap_or(1);
    apex.max(moment).clamp(1, 1_000_000)
}

fn geometric(first: f64, ratio: f64, count: usize) -> Vec<f64> {
    std::iter::successors(Some(first), |d| Some(d * ratio)).take(count).collect()
}

/// How many trials there are up to [`LISTED`] readings; one at least.
fn listed(evidence: &Evidence) -> usize {
    let mut read = 0;
    let fits = |trial: &&TrialEvidence| {
        read += trial.heights.len() + trial.moments.len();
        read <= LISTED
    };
    evidence.trials.iter().take_while(fits).count().max(1)
}

/// The motion of each trial that the joint fit describes.
fn of_joint(joint: &Joint, evidence: &Evidence) -> Vec<Motion> {
    let (g, most) = (joint.model.gravity, listed(evidence));
    let e = joint.fitted.shared[0];
    let one = |(block, &place): (usize, &usize)| {
        let trial = evidence.trials.get(place).filter(|_| place < most)?;
        let (speed, clock) = joint.model.first_contact(block, &joint.fitted.shared, &joint.fitted.own[block]);
        let release = trial.release_height.map(|_| speed * speed / (2.0 * g));
        let durations = geometric(2.0 * speed * e / g, e, contacts(trial) - 1);
        Some(Motion::of(place, [g, e], release, clock, &durations))
    };
    joint.trials.iter().enumerate().filter_map(one).collect()
}

/// The motion of each trial from the fit of its times.
fn of_times(kind: &Kind<Contacts>, evidence: &Evidence, gravity: f64) -> Vec<Motion> {
    let e = kind.fitted.shared[0];
    let one = |(trial, own): (&TrialEvidence, &Vec<f64>)| {
        (trial.moments.len() > 2).then(|| {
            let durations = geometric(own[1], e, contacts(trial) - 1);
            let release = trial.release_height.map(|r| r.0);
            Motion::of(trial.trial, [gravity, e], release, own[0], &durations)
        })
    };
    evidence.trials.iter().zip(&kind.fitted.own).take(listed(evidence)).filter_map(one).collect()
}

/// The motion of each trial from the fit of its heights, the clock starting at the release.
fn of_heights(kind: &Kind<Heights>, evidence: &Evidence, gravity: f64) -> Vec<Motion> {
    let e = exp(kind.fitted.shared[0]);
    let one = |(trial, own): (&TrialEvidence, &Vec<f64>)| {
        (trial.heights.len() > 1).then(|| {
            let height = exp(own[0]);
            let fall = (2.0 * height / gravity).sqrt();
            let durations = geometric(2.0 * fall * e, e, contacts(trial) - 1);
            Motion::of(trial.trial, [gravity, e], Some(height), fall, &durations)
        })
    };
    evidence.trials.iter().zip(&kind.fitted.own).take(listed(evidence)).filter_map(one).collect()
}

/// The motion of each trial that is listed, by the fit that the report rests on; and whether the
/// height of release is one of the readings fitted.
pub(super) fn of_fits(fits: &Fits<'_>) -> (Vec<Motion>, bool) {
    let gravity = fits.gravity.value;
    match (&fits.joint, &fits.times, &fits.heights) {
        (Some(joint), _, _) => (of_joint(joint, fits.evidence), false),
        (None, Some(times), _) => (of_times(times, fits.evidence, gravity), false),
        (None, None, Some(heights)) => (of_heights(heights, fits.evidence, gravity), true),
        (None, None, None) => (Vec::new(), false),
    }
}

/// The points and residuals of every trial that has a motion. Clocks are shifted so that all first
/// contacts coincide.
///
/// A release height that the fit took as set has no residual.
pub(super) fn beside(motions: &[Motion], fits: &Fits<'_>, release_is_fitted: bool) -> (Vec<Point>, Vec<Residual>) {
    let (evidence, sigma_height, sigma_time) = (fits.evidence, fits.sigma_height.value, fits.sigma_time.value);
    let (mut points, mut residuals) = (Vec::new(), Vec::new());
    let first = motions.first().and_then(|m| m.contact(1)).unwrap_or(0.0);
    for motion in motions {
        let place = &motion.trial;
        let Some(trial) = evidence.trials.get(*place) else { continue };
        let shift = first - motion.contact(1).unwrap_or(0.0);
        for &(n, height, sigma) in &trial.heights {
            let sigma = sigma.unwrap_or(sigma_height);
            let which = if n == 0 { (Mark::Release, 0) } else { (Mark::Apex, n) };
            let apex = n.checked_sub(1).and_then(|flights| trial.moment(flights, true));
            let read = if n == 0 { trial.release_time } else { apex.map(|m| m.2) };
            let midway = || {
                let measured = trial.contact(n).zip(trial.contact(n + 1)).map(|(a, b)| 0.5 * (a + b));
                let fitted = motion.contact(n).zip(motion.contact(n + 1)).map(|(a, b)| 0.5 * (a + b));
                measured.or(fitted)
            };
            let time = if n == 0 { read.or(motion.release_time) } else { read.or_else(midway) };
            let Some(time) = time.map(|t| t + shift) else { continue };
            points.push(Point {
                sigma_time: apex.map(|m| m.3.unwrap_or(sigma_time)),
                sigma_height: Some(sigma),
                ..Point::new(*place, which, time, height)
            });
            let predicted = match n {
                0 => motion.release_height.filter(|_| release_is_fitted),
                _ => motion.apexes.get(n - 1).copied(),
            };
            if let Some(predicted) = predicted {
                residuals.push(Residual::new(*place, which, Measure::Height, time, (height, predicted), sigma));
            }
        }
        for &(flights, apex, time, sigma) in &trial.moments {
            let sigma = sigma.unwrap_or(sigma_time);
            let number = flights + 1;
            let which = (if apex { Mark::Apex } else { Mark::Contact }, number);
            let predicted = if apex {
                motion.contact(number).zip(motion.contact(number + 1)).map(|(a, b)| 0.5 * (a + b))
            } else {
                motion.contact(number)
            };
            if !apex {
                points.push(Point { sigma_time: Some(sigma), ..Point::new(*place, which, time + shift, 0.0) });
            }
            if let Some(predicted) = predicted {
                let values = (time + shift, predicted + shift);
                residuals.push(Residual::new(*place, which, Measure::Time, time + shift, values, sigma));
            }
        }
    }
    residuals.sort_by(|a, b| a.trial.cmp(&b.trial).then(a.time.total_cmp(&b.time)));
    points.sort_by(|a, b| a.trial.cmp(&b.trial).then(a.time.total_cmp(&b.time)));
    (points, residuals)
}
