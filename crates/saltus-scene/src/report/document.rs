//! A run as JSON; the contract is written down in docs/use/simulating.md.

use serde::{Serialize, Serializer};

use super::{Sample, Sampling, Side, View};
use crate::Error;
use crate::plan::{Impact, Record, With};

/// The number of the JSON contract.
const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct Document {
    schema: u32,
    system: System,
    jumps: Vec<JumpRow>,
    impacts: Vec<ImpactRow>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    samples: Vec<Sample>,
    stop: StopRow,
}

#[derive(Serialize)]
struct System {
    model: &'static str,
    balls: usize,
    gravity: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    cor: Option<f64>,
    height: f64,
    velocity: f64,
}

#[derive(Serialize)]
struct JumpRow {
    t: f64,
    j: usize,
    edge: &'static str,
    before: Side,
    after: Side,
    /// The second ball of an impact of two, and all others where all take part.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    others: Vec<Sides>,
}

#[derive(Serialize)]
struct Sides {
    before: Side,
    after: Side,
}

#[derive(Serialize)]
struct ImpactRow {
    t: f64,
    ball: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    floor: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    other: Option<usize>,
    approach: f64,
    rebound: Option<f64>,
    cor: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    duration: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    force: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    deformation: Option<f64>,
}

#[derive(Serialize)]
struct StopRow {
    reason: &'static str,
    t: f64,
    j: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    rest: Option<f64>,
    #[serde(flatten)]
    side: Side,
    says: String,
}

impl Document {
    fn of(record: &Record, sampling: Option<Sampling>) -> Result<Self, Error> {
        let (view, scene, events) = (View::of(record), record.scene(), record.events());
        let end = record.until();
        let mut rows = Vec::with_capacity(events.len());
        for event in &events {
            let side = |n: usize| {
                let sides = &event.sides[n];
                let (before, after) =
                    (view.side(sides.ball, sides.from, &sides.before), view.side(sides.ball, sides.to, &sides.after));
                Sides { before, after }
            };
            let Sides { before, after } = side(0);
            let others = (1..event.sides.len()).map(side).collect();
            rows.push(JumpRow { t: event.t, j: event.j, edge: event.edge, before, after, others });
        }
        Ok(Self {
            schema: SCHEMA,
            system: System {
                model: record.model().name(),
                balls: record.balls(),
                gravity: scene.gravity.value(),
                cor: scene.law(0, 0).and_then(crate::Law::constant).map(saltus_bounce::Cor::value),
                height: scene.balls[0].lowest().z,
                velocity: scene.balls[0].velocity.z,
            },
            jumps: rows,
            impacts: record.impacts().iter().map(impact_row).collect(),
            samples: view.samples(&events, sampling)?,
            stop: StopRow {
                reason: record.end().name(),
                t: end,
                j: events.len(),
                rest: record.rest(),
                side: view.at(0, end).ok_or_else(|| Error::new("the run has no end"))?,
                says: record.end().to_string(),
            },
        })
    }
}

/// The contract of docs/use/simulating.md, without samples.
impl Serialize for Record {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Document::of(self, None).map_err(serde::ser::Error::custom)?.serialize(serializer)
    }
}

impl Record {
    /// The jumps, the impacts and, if asked for, samples as JSON; the contract is written down in
    /// docs/use/simulating.md. Without samples it is what serialising the record gives.
    ///
    /// # Errors
    /// [`Error`] for more than ten million samples.
    ///
    /// ```
    /// use saltus_scene::{Sampling, Scene};
    /// let scene = Scene::parse("drop.toml", b"restitution = 0.5\nball = { height = '1 m' }\n")?;
    /// let json = scene.plan()?.until(1.0).run()?.json(Some(Sampling::Rate(24.0)))?;
    /// let json: serde_json::Value = serde_json::from_str(&json)?;
    /// assert_eq!((&json["schema"], &json["jumps"][0]["edge"]), (&1.into(), &"floor".into()));
    /// assert_eq!(json["samples"].as_array().map(Vec::len), Some(25));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn json(&self, sampling: Option<Sampling>) -> Result<String, Error> {
        Ok(serde_json::to_string_pretty(&Document::of(self, sampling)?).map_err(Error::new)? + "\n")
    }
}

fn impact_row(impact: &Impact) -> ImpactRow {
    let (floor, other) = match impact.with {
        With::Floor(floor) => (Some(floor), None),
        With::Ball(other) => (None, Some(other)),
    };
    ImpactRow {
        t: impact.t,
        ball: impact.ball,
        floor,
        other,
        approach: impact.approach,
        rebound: impact.rebound,
        cor: impact.cor(),
        duration: impact.press.and_then(|press| press.duration),
        force: impact.press.map(|press| press.force),
        deformation: impact.press.map(|press| press.deformation),
    }
}
