//! A recorded run for others: as text, as a table and as JSON; and what accuracy costs, as JSON.

mod accuracy;
mod document;
mod table;
mod text;

use serde::Serialize;

use crate::Error;
use crate::plan::{Event, Model, Moment, Record};

pub use accuracy::Seconds;
pub use table::{Table, Values};

/// The most samples that are taken: a frame each at 1000 frames per second for three hours.
const MOST_SAMPLES: u32 = 10_000_000;

/// The times at which a motion is sampled, from 0 to the end of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// A step in s.
    Every(f64),
    /// A rate in samples per second: the times k/rate for k = 0, 1, ...
    Rate(f64),
}

impl Sampling {
    /// Refuses more than ten million samples of a run that ends at `until` in s; a step that is not
    /// above zero is refused with those that are too short.
    ///
    /// # Errors
    /// [`Error`], with how many there may be.
    pub fn holds(self, until: f64) -> Result<(), Error> {
        let step = self.step();
        if step > 0.0 && until / step <= f64::from(MOST_SAMPLES) {
            return Ok(());
        }
        Err(Error::new(format!("the samples are more than {MOST_SAMPLES}: sample less often, or end the run earlier")))
    }

    fn step(self) -> f64 {
        match self {
            Self::Every(step) => step,
            Self::Rate(rate) => 1.0 / rate,
        }
    }

    fn time(self, k: u32) -> f64 {
        match self {
            Self::Every(step) => f64::from(k) * step,
            Self::Rate(rate) => f64::from(k) / rate,
        }
    }
}

/// A ball at a moment. What a scene has no coordinates for is left out; vectors are [x, up] or [x,
/// y, up].
#[derive(Serialize)]
struct Side {
    #[serde(skip_serializing_if = "Option::is_none")]
    ball: Option<usize>,
    mode: &'static str,
    height: f64,
    velocity: f64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    position: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    velocities: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    spin: Vec<f64>,
}

/// A ball at a time, with how many jumps came before.
#[derive(Serialize)]
struct Sample {
    t: f64,
    j: usize,
    #[serde(flatten)]
    side: Side,
}

/// Minus zero is zero to a reader.
fn plain(value: f64) -> f64 {
    value + 0.0
}

/// Reads a record in the coordinates that its scene has.
struct View<'a> {
    record: &'a Record,
    /// Whether the run keeps a spin.
    spins: bool,
}

impl<'a> View<'a> {
    fn of(record: &'a Record) -> Self {
        let scene = record.scene();
        let rubs = scene.floors.iter().any(|floor| floor.friction.coefficient() > 0.0);
        let spins = match record.model() {
            Model::Flyer => scene.dimensions > 1 && (scene.balls[0].spin.is_some() || rubs),
            Model::Flock => true,
            _ => false,
        };
        Self { record, spins }
    }

    /// The components of a vector that the scene has coordinates for.
    fn components(&self, v: [f64; 3]) -> Vec<f64> {
        match self.record.scene().dimensions {
            1 => Vec::new(),
            2 => vec![plain(v[0]), plain(v[2])],
            _ => v.map(plain).to_vec(),
        }
    }

    fn side(&self, ball: usize, mode: &'static str, moment: &Moment) -> Side {
        let spin = match (self.spins, self.record.scene().dimensions) {
            (false, _) => Vec::new(),
            (true, 2) => vec![0.0 - moment.spin.y],
            (true, _) => moment.spin.iter().copied().map(plain).collect(),
        };
        Side {
            ball: (self.record.balls() > 1).then_some(ball),
            mode,
            height: plain(moment.height()),
            velocity: plain(moment.velocity.z),
            position: self.components(moment.position.into()),
            velocities: self.components(moment.velocity.into()),
            spin,
        }
    }

    fn at(&self, ball: usize, t: f64) -> Option<Side> {
        Some(self.side(ball, self.record.mode(ball, t)?, &self.record.at(ball, t)?))
    }

    /// The motion on a grid of times, each with how many jumps came before.
    fn samples(&self, events: &[Event], sampling: Option<Sampling>) -> Result<Vec<Sample>, Error> {
        let Some(sampling) = sampling else { return Ok(Vec::new()) };
        let end = self.record.until();
        sampling.holds(end)?;
        let mut samples = Vec::new();
        for t in (0_u32..).map(|k| sampling.time(k)).take_while(|&t| t <= end) {
            let j = events.partition_point(|event| event.t <= t);
            for ball in 0..self.record.balls() {
                samples.extend(self.at(ball, t).map(|side| Sample { t, j, side }));
            }
        }
        Ok(samples)
    }
}
