//! A simulated motion as text, CSV and JSON.

use std::fmt::Write;

use saltus::nalgebra::Vector2;
use saltus::{Cause, Jump, Run, Stop};
use saltus_bounce::{Ball, Mode};
use serde::Serialize;

use crate::error::Error;
use crate::plan::Plan;

/// The number of the JSON contract.
const SCHEMA: u32 = 1;
/// Of many jumps the text lists the first and the last so many.
const LISTED: (usize, usize) = (20, 3);

pub(crate) struct Motion<'a> {
    pub(crate) plan: &'a Plan,
    /// The interval of samples in s.
    pub(crate) every: Option<f64>,
    /// The rate of samples in 1/s.
    pub(crate) fps: Option<f64>,
    pub(crate) run: &'a Run<Ball>,
}

#[derive(Serialize)]
struct Document {
    schema: u32,
    system: System,
    jumps: Vec<JumpRow>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    samples: Vec<Sample>,
    stop: StopRow,
}

#[derive(Serialize)]
struct System {
    gravity: f64,
    cor: f64,
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
}

#[derive(Serialize)]
struct Side {
    mode: &'static str,
    height: f64,
    velocity: f64,
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
    #[serde(flatten)]
    side: Side,
    says: String,
}

const fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Flight => "flight",
        Mode::Rest => "rest",
    }
}

fn edge_name(jump: &Jump<Ball>) -> &'static str {
    match jump.cause {
        Cause::Zeno => "zeno",
        _ => "floor",
    }
}

fn side(mode: Mode, x: &Vector2<f64>) -> Side {
    // Minus zero is zero to a reader.
    Side { mode: mode_name(mode), height: x[0] + 0.0, velocity: x[1] + 0.0 }
}

impl Motion<'_> {
    /// The jumps as JSON; the contract is written down in docs/simulating.md.
    pub(crate) fn json(&self) -> Result<String, Error> {
        let Self { plan, run, .. } = self;
        let jumps = run.trajectory.jumps();
        let row = |jump: &Jump<Ball>| JumpRow {
            t: jump.t(),
            j: jump.j,
            edge: edge_name(jump),
            before: side(jump.from, &jump.before),
            after: side(jump.to, &jump.after),
        };
        let document = Document {
            schema: SCHEMA,
            system: System {
                gravity: plan.gravity,
                cor: plan.cor.value(),
                height: plan.height,
                velocity: plan.velocity,
            },
            jumps: jumps.iter().map(row).collect(),
            samples: self.samples(),
            stop: StopRow {
                reason: match run.stop {
                    Stop::Time => "time",
                    Stop::Jumps { .. } => "jumps",
                    Stop::Zeno { .. } => "zeno",
                    _ => "other",
                },
                t: run.trajectory.end().seconds(),
                j: jumps.len(),
                side: side(run.mode, &run.state),
                says: run.stop.to_string(),
            },
        };
        Ok(serde_json::to_string_pretty(&document).map_err(Error::new)? + "\n")
    }

    /// The motion on a grid of times, each with how many jumps came before.
    fn samples(&self) -> Vec<Sample> {
        let trajectory = &self.run.trajectory;
        let end = trajectory.end().seconds();
        let step = match (self.every, self.fps) {
            (Some(step), _) => step,
            (None, Some(rate)) => 1.0 / rate,
            (None, None) => return Vec::new(),
        };
        let jumps = trajectory.jumps();
        (0_u32..)
            .map(|k| match self.fps {
                Some(rate) => f64::from(k) / rate,
                None => f64::from(k) * step,
            })
            .take_while(|&t| t <= end)
            .filter_map(|t| {
                let j = jumps.partition_point(|jump| jump.t() <= t);
                Some(Sample { t, j, side: side(trajectory.mode_at(t)?, &trajectory.at(t)?) })
            })
            .collect()
    }

    /// The start, both sides of every jump, the samples and the end, in order of (t, j).
    pub(crate) fn csv(&self) -> String {
        let Self { plan, run, .. } = self;
        let mut rows =
            vec![Sample { t: 0.0, j: 0, side: side(Mode::Flight, &Vector2::new(plan.height, plan.velocity)) }];
        for jump in run.trajectory.jumps() {
            rows.push(Sample { t: jump.t(), j: jump.j - 1, side: side(jump.from, &jump.before) });
            rows.push(Sample { t: jump.t(), j: jump.j, side: side(jump.to, &jump.after) });
        }
        let (end, j) = (run.trajectory.end().seconds(), run.trajectory.jumps().len());
        rows.push(Sample { t: end, j, side: side(run.mode, &run.state) });
        rows.extend(self.samples());
        rows.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.j.cmp(&b.j)));
        rows.dedup_by(|b, a| (a.t, a.j) == (b.t, b.j));
        let mut csv = String::from("time_s,jumps,mode,height_m,velocity_m_per_s\n");
        for Sample { t, j, side: Side { mode, height, velocity } } in rows {
            let _ = writeln!(csv, "{t},{j},{mode},{height},{velocity}");
        }
        csv
    }

    /// The jumps as a table for people.
    pub(crate) fn text(&self) -> String {
        let Self { plan, run, .. } = self;
        let jumps = run.trajectory.jumps();
        let gravity = plan.gravity;
        let mut text = format!(
            "{:>6} {:>14} {:>16} {:>17} {:>13}\n",
            "impact", "time (s)", "before (m/s)", "after (m/s)", "apex (m)"
        );
        let hidden = if jumps.len() > LISTED.0 + LISTED.1 + 1 { LISTED.0..jumps.len() - LISTED.1 } else { 0..0 };
        for (index, jump) in jumps.iter().enumerate() {
            if hidden.contains(&index) {
                if index == hidden.start {
                    let _ = writeln!(text, "{:>6} ({} more)", "...", hidden.len());
                }
                continue;
            }
            if jump.to == Mode::Rest {
                continue;
            }
            let (before, after) = (jump.before[1], jump.after[1]);
            let apex = if gravity > 0.0 { after * after / (2.0 * gravity) } else { f64::INFINITY };
            let _ = writeln!(
                text,
                "{:>6} {:>14.9} {:>16} {:>17} {:>13}",
                jump.j,
                jump.t(),
                figure(before),
                figure(after),
                figure(apex)
            );
        }
        let end = run.trajectory.end().seconds();
        let _ = match jumps.iter().find(|jump| jump.to == Mode::Rest) {
            Some(rest) => writeln!(text, "\nAt rest from {:.9} s; the run ends at {end:.9} s.", rest.t()),
            None => writeln!(text, "\nThe run ends at {end:.9} s, {} at {} m.", moving(run.mode), figure(run.state[0])),
        };
        text
    }
}

const fn moving(mode: Mode) -> &'static str {
    match mode {
        Mode::Flight => "in flight",
        Mode::Rest => "at rest",
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
