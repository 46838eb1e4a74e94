//! How a level floor moves.

use saltus_bounce::units::Quantity;
#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::error::Fault;
use super::value::{Angle, At, Frequency, Length, Measure, Pairs, Real, Time};

/// The motion of a level floor about its height.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Motion {
    /// A vibration, amplitude sin(2π frequency t + phase).
    Sine {
        /// The amplitude in m.
        amplitude: f64,
        /// The frequency in Hz.
        frequency: f64,
        /// The phase at t = 0, in rad.
        phase: f64,
    },
    /// A schedule: pairs of a time in s and the height above its own in m, straight between, still
    /// before and after.
    Schedule(Vec<[f64; 2]>),
}

impl Motion {
    /// The time from which the floor is still, in s; `None` if it never is.
    pub(super) fn ends(&self) -> Option<f64> {
        match self {
            Self::Sine { .. } => None,
            Self::Schedule(points) => Some(points.last().map_or(0.0, |last| last[0])),
        }
    }

    /// The greatest speed of the floor, in m/s.
    fn fastest(&self) -> f64 {
        match self {
            Self::Sine { amplitude, frequency, .. } => std::f64::consts::TAU * frequency * amplitude,
            Self::Schedule(points) => {
                let speed = |pair: &[[f64; 2]]| ((pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])).abs();
                points.windows(2).map(speed).fold(0.0, f64::max)
            }
        }
    }

    /// The height of the floor above its own at `t` in s, in m.
    #[must_use]
    pub fn offset(&self, t: f64) -> f64 {
        match self {
            Self::Sine { amplitude, frequency, phase } => {
                amplitude * (std::f64::consts::TAU * frequency * t + phase).sin()
            }
            Self::Schedule(points) => match points.partition_point(|point| point[0] < t) {
                0 => points.first().map_or(0.0, |first| first[1]),
                n if n == points.len() => points[n - 1][1],
                n => {
                    let ([s, low], [e, high]) = (points[n - 1], points[n]);
                    low + (high - low) * ((t - s) / (e - s))
                }
            },
        }
    }
}

/// How a level floor moves: a vibration, or a schedule.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "motion"))]
pub(super) struct MotionTable {
    /// Of a vibration: half of the way between its ends.
    amplitude: Option<At<Measure<Length>>>,
    /// Of a vibration: how often.
    frequency: Option<At<Measure<Frequency>>>,
    /// Of a vibration: its phase at the start; 0 unless given, the floor in the middle and rising.
    phase: Option<At<Measure<Angle>>>,
    /// Pairs of a time and how far the floor is above its height then; straight between, still
    /// before and after.
    schedule: Option<At<Pairs<Measure<Time>, Measure<Length>>>>,
}

impl MotionTable {
    pub(super) fn read(&self, whole: &At<Self>) -> Result<Motion, Fault> {
        let (motion, largest) = (self.motion(whole)?, Quantity::Speed.largest());
        if motion.fastest() <= largest {
            return Ok(motion);
        }
        let fastest = motion.fastest();
        Err(whole.fault(format!(
            "the floor moves at {fastest:.1e} m/s, beyond the speeds that can be right: give a motion of {largest} m/s at most"
        )))
    }

    fn motion(&self, whole: &At<Self>) -> Result<Motion, Fault> {
        match (&self.amplitude, &self.frequency, &self.schedule) {
            (Some(amplitude), Some(frequency), None) => Ok(Motion::Sine {
                amplitude: amplitude.not_negative("an amplitude in m")?,
                frequency: frequency.positive("a frequency in Hz")?,
                phase: self.phase.as_ref().map_or(0.0, At::real),
            }),
            (None, None, Some(at)) if self.phase.is_none() => {
                let points: Vec<[f64; 2]> = at.get().iter().map(|(t, h)| [t.real(), h.real()]).collect();
                if points.len() < 2 {
                    return Err(at.fault("a schedule has fewer than two points: give [[time, height], ...], such as [[\"0 s\", \"0 m\"], [\"1 s\", \"10 cm\"]]"));
                }
                match points.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
                    Some(pair) => Err(at.fault(format!(
                        "the schedule has {} s after {} s: sort its points by time, each time once",
                        pair[1][0], pair[0][0]
                    ))),
                    None => Ok(Motion::Schedule(points)),
                }
            }
            _ => Err(whole.fault(
                "the motion of the floor is not determined: give either `amplitude` and `frequency`, or `schedule`",
            )),
        }
    }
}
