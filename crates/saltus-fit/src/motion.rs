//! The fitted motion as parabolas, and where the readings stand beside it.

use serde::Serialize;

use crate::estimate::Kind;
use crate::evidence::{Evidence, TrialEvidence};
use crate::joint::Joint;
use crate::model::{Contacts, Heights};
use crate::residual::{Measure, Point, Residual};

/// The free-flight motion that was fitted to the first trial.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Motion {
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
    /// Builds the motion from its durations: those of the flights between contacts, and the fall before.
    fn of(gravity: f64, cor: f64, release: Option<f64>, first: f64, durations: &[f64]) -> Self {
        let mut motion = Self {
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

/// The motion of each trial that the joint fit describes.
pub(crate) fn of_joint(joint: &Joint, evidence: &Evidence) -> Vec<(usize, Motion)> {
    let g = joint.model.gravity;
    let e = joint.fitted.shared[0];
    let one = |(block, &place): (usize, &usize)| {
        let trial = evidence.trials.get(place)?;
        let (speed, clock) = joint.model.first_contact(block, &joint.fitted.shared, &joint.fitted.own[block]);
        let release = trial.release_height.map(|_| speed * speed / (2.0 * g));
        let durations = geometric(2.0 * speed * e / g, e, contacts(trial) - 1);
        Some((place, Motion::of(g, e, release, clock, &durations)))
    };
    joint.trials.iter().enumerate().filter_map(one).collect()
}

/// The motion of each trial from the fit of its times.
pub(crate) fn of_times(kind: &Kind<Contacts>, evidence: &Evidence, gravity: f64) -> Vec<(usize, Motion)> {
    let e = kind.fitted.shared[0];
    let one = |(trial, own): (&TrialEvidence, &Vec<f64>)| {
        (trial.moments.len() > 2).then(|| {
            let durations = geometric(own[1], e, contacts(trial) - 1);
            let release = trial.release_height.map(|r| r.0);
            (trial.trial, Motion::of(gravity, e, release, own[0], &durations))
        })
    };
    evidence.trials.iter().zip(&kind.fitted.own).filter_map(one).collect()
}

/// The motion of each trial from the fit of its heights, the clock starting at the release.
pub(crate) fn of_heights(kind: &Kind<Heights>, evidence: &Evidence, gravity: f64) -> Vec<(usize, Motion)> {
    let e = kind.fitted.shared[0].exp();
    let one = |(trial, own): (&TrialEvidence, &Vec<f64>)| {
        (trial.heights.len() > 1).then(|| {
            let height = own[0].exp();
            let fall = (2.0 * height / gravity).sqrt();
            let durations = geometric(2.0 * fall * e, e, contacts(trial) - 1);
            (trial.trial, Motion::of(gravity, e, Some(height), fall, &durations))
        })
    };
    evidence.trials.iter().zip(&kind.fitted.own).filter_map(one).collect()
}

/// The points and residuals of every trial that has a motion. Clocks are shifted so that all first contacts coincide.
///
/// A release height that the fit took as set has no residual.
pub(crate) fn beside(
    motions: &[(usize, Motion)],
    evidence: &Evidence,
    (sigma_height, sigma_time): (f64, f64),
    release_is_fitted: bool,
) -> (Vec<Point>, Vec<Residual>) {
    let (mut points, mut residuals) = (Vec::new(), Vec::new());
    let first = motions.first().and_then(|(_, m)| m.contact(1)).unwrap_or(0.0);
    for (place, motion) in motions {
        let Some(trial) = evidence.trials.get(*place) else { continue };
        let shift = first - motion.contact(1).unwrap_or(0.0);
        for &(n, height, sigma) in &trial.heights {
            let sigma = sigma.unwrap_or(sigma_height);
            let label = if n == 0 { "release".to_owned() } else { format!("apex {n}") };
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
                trial: *place,
                label: label.clone(),
                time,
                height,
                sigma_time: apex.map(|m| m.3.unwrap_or(sigma_time)),
                sigma_height: Some(sigma),
            });
            let predicted = match n {
                0 => motion.release_height.filter(|_| release_is_fitted),
                _ => motion.apexes.get(n - 1).copied(),
            };
            if let Some(predicted) = predicted {
                residuals.push(Residual::new(*place, label, Measure::Height, time, (height, predicted), sigma));
            }
        }
        for &(flights, apex, time, sigma) in &trial.moments {
            let sigma = sigma.unwrap_or(sigma_time);
            let number = flights + 1;
            let label = if apex { format!("apex {number}") } else { format!("contact {number}") };
            let predicted = if apex {
                motion.contact(number).zip(motion.contact(number + 1)).map(|(a, b)| 0.5 * (a + b))
            } else {
                motion.contact(number)
            };
            if !apex {
                points.push(Point {
                    trial: *place,
                    label: label.clone(),
                    time: time + shift,
                    height: 0.0,
                    sigma_time: Some(sigma),
                    sigma_height: None,
                });
            }
            if let Some(predicted) = predicted {
                let values = (time + shift, predicted + shift);
                residuals.push(Residual::new(*place, label, Measure::Time, time + shift, values, sigma));
            }
        }
    }
    residuals.sort_by(|a, b| a.trial.cmp(&b.trial).then(a.time.total_cmp(&b.time)));
    points.sort_by(|a, b| a.trial.cmp(&b.trial).then(a.time.total_cmp(&b.time)));
    (points, residuals)
}
