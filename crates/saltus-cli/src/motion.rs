//! A simulated motion as text, CSV and JSON.

use std::fmt::Write;

use saltus_scene::Scene;
use saltus_scene::plan::{Event, Impact, Model, Moment, Record, With};
use serde::Serialize;

use crate::error::Error;
use crate::ground::name;

/// The number of the JSON contract.
const SCHEMA: u32 = 1;
/// Of many impacts the text lists the first and the last so many.
const LISTED: (usize, usize) = (20, 3);
/// The most samples that are written: a frame each at 1000 frames per second for three hours.
const MOST_SAMPLES: u32 = 10_000_000;

pub(crate) struct Motion<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) model: Model,
    /// The interval of samples in s.
    pub(crate) every: Option<f64>,
    /// The rate of samples in 1/s.
    pub(crate) fps: Option<f64>,
    pub(crate) record: &'a Record,
}

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

/// A ball at a moment. What a scene has no coordinates for is left out; vectors are [x, up] or [x, y, up].
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

#[derive(Serialize)]
struct Sample {
    t: f64,
    j: usize,
    #[serde(flatten)]
    side: Side,
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

/// Minus zero is zero to a reader.
fn plain(value: f64) -> f64 {
    value + 0.0
}

impl Motion<'_> {
    /// The components of a vector that the scene has coordinates for.
    fn components(&self, v: [f64; 3]) -> Vec<f64> {
        match self.scene.dimensions {
            1 => Vec::new(),
            2 => vec![plain(v[0]), plain(v[2])],
            _ => v.map(plain).to_vec(),
        }
    }

    fn side(&self, ball: usize, mode: &'static str, moment: &Moment) -> Side {
        let spin = match (self.spins(), self.scene.dimensions) {
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

    /// Whether the run keeps a spin.
    fn spins(&self) -> bool {
        let rubs = self.scene.floors.iter().any(|floor| floor.friction.coefficient() > 0.0);
        match self.model {
            Model::Flyer => self.scene.dimensions > 1 && (self.scene.balls[0].spin.is_some() || rubs),
            Model::Flock => true,
            _ => false,
        }
    }

    /// The jumps and the impacts as JSON; the contract is written down in docs/simulating.md.
    pub(crate) fn json(&self) -> Result<String, Error> {
        let Self { scene, record, .. } = self;
        let events = record.events();
        let end = record.until();
        let mut rows = Vec::with_capacity(events.len());
        for event in &events {
            let side = |n: usize| {
                let sides = &event.sides[n];
                let (before, after) =
                    (self.side(sides.ball, sides.from, &sides.before), self.side(sides.ball, sides.to, &sides.after));
                Sides { before, after }
            };
            let Sides { before, after } = side(0);
            let others = (1..event.sides.len()).map(side).collect();
            rows.push(JumpRow { t: event.t, j: event.j, edge: event.edge, before, after, others });
        }
        let document = Document {
            schema: SCHEMA,
            system: System {
                model: self.model.name(),
                balls: record.balls(),
                gravity: scene.gravity.value(),
                cor: scene.law(0, 0).and_then(saltus_scene::Law::constant).map(saltus_bounce::Cor::value),
                height: scene.balls[0].lowest().z,
                velocity: scene.balls[0].velocity.z,
            },
            jumps: rows,
            impacts: record.impacts().iter().map(impact_row).collect(),
            samples: self.samples(&events)?,
            stop: StopRow {
                reason: record.end().name(),
                t: end,
                j: events.len(),
                rest: record.rest(),
                side: self.sample(0, end).ok_or_else(|| Error::new("the run has no end"))?,
                says: record.end().to_string(),
            },
        };
        Ok(serde_json::to_string_pretty(&document).map_err(Error::new)? + "\n")
    }

    fn sample(&self, ball: usize, t: f64) -> Option<Side> {
        Some(self.side(ball, self.record.mode(ball, t)?, &self.record.at(ball, t)?))
    }

    /// The motion on a grid of times, each with how many jumps came before.
    fn samples(&self, events: &[Event]) -> Result<Vec<Sample>, Error> {
        let end = self.record.until();
        let step = match (self.every, self.fps) {
            (Some(step), _) => step,
            (None, Some(rate)) => 1.0 / rate,
            (None, None) => return Ok(Vec::new()),
        };
        if end / step > f64::from(MOST_SAMPLES) {
            return Err(Error::new(format!(
                "{:.0} samples are more than {MOST_SAMPLES}: give a longer --every, a lower --fps or an earlier --until",
                end / step
            )));
        }
        let times = (0_u32..).map(|k| match self.fps {
            Some(rate) => f64::from(k) / rate,
            None => f64::from(k) * step,
        });
        let mut samples = Vec::new();
        for t in times.take_while(|&t| t <= end) {
            let j = events.partition_point(|event| event.t <= t);
            for ball in 0..self.record.balls() {
                samples.extend(self.sample(ball, t).map(|side| Sample { t, j, side }));
            }
        }
        Ok(samples)
    }

    /// The start, both sides of every jump, the samples and the end, in order of (t, j).
    pub(crate) fn csv(&self) -> Result<String, Error> {
        let Self { scene, record, .. } = self;
        let events = record.events();
        let mut rows = Vec::new();
        for (n, ball) in scene.balls.iter().enumerate() {
            let (position, velocity) = (ball.lowest(), ball.velocity);
            let start = Moment { position, velocity, spin: ball.spin.unwrap_or_default() };
            let mode = events.iter().flat_map(|event| &event.sides).find(|sides| sides.ball == n);
            let mode = mode.map_or_else(|| record.mode(n, 0.0).unwrap_or("flight"), |sides| sides.from);
            rows.push(Sample { t: 0.0, j: 0, side: self.side(n, mode, &start) });
        }
        for event in &events {
            for sides in &event.sides {
                let before = self.side(sides.ball, sides.from, &sides.before);
                rows.push(Sample { t: event.t, j: event.j - 1, side: before });
                rows.push(Sample { t: event.t, j: event.j, side: self.side(sides.ball, sides.to, &sides.after) });
            }
        }
        let end = record.until();
        for ball in 0..record.balls() {
            rows.extend(self.sample(ball, end).map(|side| Sample { t: end, j: events.len(), side }));
        }
        rows.extend(self.samples(&events)?);
        rows.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.j.cmp(&b.j)).then(a.side.ball.cmp(&b.side.ball)));
        rows.dedup_by(|b, a| (a.t, a.j, a.side.ball) == (b.t, b.j, b.side.ball));
        Ok(self.table(&rows))
    }

    fn table(&self, rows: &[Sample]) -> String {
        let (several, spins) = (self.record.balls() > 1, self.spins());
        let (sideways, spin): (&[&str], &[&str]) = match self.scene.dimensions {
            1 => (&[], &[]),
            2 => (&["x"], &["spin_rad_per_s"]),
            _ => (&["x", "y"], &["spin_x_rad_per_s", "spin_y_rad_per_s", "spin_up_rad_per_s"]),
        };
        let mut csv = String::from("time_s,jumps,");
        csv.push_str(if several { "ball,mode" } else { "mode" });
        sideways.iter().for_each(|axis| csv.extend([",", axis, "_m"]));
        csv.push_str(",height_m");
        sideways.iter().for_each(|axis| csv.extend([",velocity_", axis, "_m_per_s"]));
        csv.push_str(",velocity_m_per_s");
        spin.iter().filter(|_| spins).for_each(|name| csv.extend([",", name]));
        csv.push('\n');
        for Sample { t, j, side } in rows {
            let _ = write!(csv, "{t},{j},");
            if let Some(ball) = side.ball {
                let _ = write!(csv, "{ball},");
            }
            csv.push_str(side.mode);
            let last = side.position.len().saturating_sub(1);
            for x in &side.position[..last] {
                let _ = write!(csv, ",{x}");
            }
            let _ = write!(csv, ",{}", side.height);
            for v in &side.velocities[..last] {
                let _ = write!(csv, ",{v}");
            }
            let _ = write!(csv, ",{}", side.velocity);
            for w in &side.spin {
                let _ = write!(csv, ",{w}");
            }
            csv.push('\n');
        }
        csv
    }

    /// The impacts as a table for people.
    pub(crate) fn text(&self) -> String {
        let record = self.record;
        let impacts = record.impacts();
        let named = record.balls() > 1 || self.scene.floors.len() > 1;
        let timed = impacts.iter().any(|impact| impact.press.is_some());
        let width = impacts.iter().map(|impact| self.what(impact).chars().count()).max().unwrap_or(0).max(22);
        let mut text = format!("{:>6} {:>14}", "impact", "time (s)");
        if named {
            let _ = write!(text, "  {:<width$}", "what");
        }
        let _ = write!(text, " {:>16} {:>17}", "before (m/s)", "after (m/s)");
        let _ = if timed {
            writeln!(text, " {:>10} {:>13} {:>13}", "COR", "time (s)", "force (N)")
        } else {
            writeln!(text, " {:>13}", "apex (m)")
        };
        let hidden = if impacts.len() > LISTED.0 + LISTED.1 + 1 { LISTED.0..impacts.len() - LISTED.1 } else { 0..0 };
        let apexes: Vec<_> = (0..record.balls()).map(|ball| record.apexes(ball)).collect();
        for (index, impact) in impacts.iter().enumerate() {
            if hidden.contains(&index) {
                if index == hidden.start {
                    let _ = writeln!(text, "{:>6} ({} more)", "...", hidden.len());
                }
                continue;
            }
            let _ = write!(text, "{:>6} {:>14.9}", index + 1, impact.t);
            if named {
                let _ = write!(text, "  {:<width$}", self.what(impact));
            }
            let rebound = impact.rebound.map_or_else(|| "-".to_owned(), figure);
            let _ = write!(text, " {:>16} {rebound:>17}", figure(-impact.approach));
            let _ = match impact.press {
                Some(press) => writeln!(
                    text,
                    " {:>10} {:>13} {:>13}",
                    impact.cor().map_or_else(|| "-".to_owned(), |cor| format!("{cor:.6}")),
                    press.duration.map_or_else(|| "-".to_owned(), figure),
                    figure(press.force)
                ),
                None => {
                    let next = impacts[index + 1..].iter().find(|next| next.ball == impact.ball);
                    let until = next.map_or(f64::INFINITY, |next| next.t);
                    let apex = apexes[impact.ball].iter().find(|apex| apex.t >= impact.t && apex.t <= until);
                    writeln!(text, " {:>13}", apex.map_or_else(|| "-".to_owned(), |apex| figure(apex.height)))
                }
            };
        }
        let end = record.until();
        match record.rest() {
            Some(rest) => {
                let _ = writeln!(text, "\nAt rest from {rest:.9} s; the run ends at {end:.9} s.");
            }
            None => {
                let _ = write!(text, "\nThe run ends at {end:.9} s");
                for ball in 0..record.balls() {
                    let which =
                        if record.balls() > 1 { format!(", {}", name(self.scene, ball)) } else { String::new() };
                    if let (Some(mode), Some(moment)) = (record.mode(ball, end), record.at(ball, end)) {
                        let _ = write!(text, "{which}, {} at {} m", doing(mode), figure(moment.height()));
                    }
                }
                text.push_str(".\n");
            }
        }
        text
    }

    fn what(&self, impact: &Impact) -> String {
        let on = match impact.with {
            With::Ball(other) => name(self.scene, other),
            With::Floor(floor) => {
                let name = self.scene.floors.get(floor).and_then(|floor| floor.name.clone());
                name.unwrap_or_else(|| format!("floor {}", floor + 1))
            }
            _ => "something".to_owned(),
        };
        if self.record.balls() > 1 { format!("{} on {on}", name(self.scene, impact.ball)) } else { on }
    }
}

fn impact_row(impact: &Impact) -> ImpactRow {
    let (floor, other) = match impact.with {
        With::Floor(floor) => (Some(floor), None),
        With::Ball(other) => (None, Some(other)),
        _ => (None, None),
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

fn doing(mode: &str) -> &str {
    match mode {
        "flight" | "rising" | "falling" | "fall" | "rise" => "in flight",
        "rest" | "lying" => "resting",
        "slide" => "sliding",
        "hold" => "lying or rolling",
        "compression" => "being pressed in",
        "restitution" => "springing back",
        other => other,
    }
}

/// Six decimals where they say something, else powers of ten.
fn figure(value: f64) -> String {
    if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        format!("{:.6}", value + 0.0)
    } else {
        format!("{value:.5e}")
    }
}
