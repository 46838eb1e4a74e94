//! What a run of any scene leaves behind, in one form: where each ball is at any time, what
//! happened, how it ended.

use std::fmt;
use std::ops::{Add, Mul};
use std::sync::Arc;

use nalgebra::Vector3;
use saltus::Stop;

use super::Model;
use crate::Scene;

/// A ball at a moment. Vectors are (x, y, up).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The place of the lowest point, in m; the centre is a radius above.
    pub position: Vector3<f64>,
    /// The velocity in m/s.
    pub velocity: Vector3<f64>,
    /// The spin in rad/s; zero where the scene has none.
    pub spin: Vector3<f64>,
}

impl Moment {
    /// A ball at rest at the origin.
    pub const ZERO: Self = {
        let zero = Vector3::new(0.0, 0.0, 0.0);
        Self { position: zero, velocity: zero, spin: zero }
    };

    /// The height of its lowest point in m.
    #[must_use]
    pub const fn height(&self) -> f64 {
        let [_, _, height] = self.position.data.0[0];
        height
    }
}

impl Add for Moment {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            position: self.position + other.position,
            velocity: self.velocity + other.velocity,
            spin: self.spin + other.spin,
        }
    }
}

impl Mul<f64> for Moment {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { position: self.position * factor, velocity: self.velocity * factor, spin: self.spin * factor }
    }
}

/// A stretch of time in which the motion of a ball is one polynomial: a flight that is solved
/// exactly, or a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// The start in s.
    pub start: f64,
    /// The duration in s.
    pub span: f64,
    /// The name of the ball's mode.
    pub mode: &'static str,
    /// Whether it is in the air.
    pub flight: bool,
    /// cₖ of Σ cₖ (t - start)ᵏ.
    pub coefficients: Vec<Moment>,
}

impl Segment {
    /// The ball `s` seconds after the start.
    #[must_use]
    pub fn at(&self, s: f64) -> Moment {
        self.coefficients.iter().rev().fold(Moment::ZERO, |sum, c| sum * s + *c)
    }

    /// The end in s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.start + self.span
    }
}

/// The other side of an impact: a floor, or another ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum With {
    /// A floor, wall or box of the scene, counted from 0.
    Floor(usize),
    /// Another ball, counted from 0.
    Ball(usize),
}

/// An impact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Impact {
    /// The time of first touch, in s.
    pub t: f64,
    /// The ball, counted from 0.
    pub ball: usize,
    /// The other side of the impact.
    pub with: With,
    /// The speed of approach along the normal just before, in m/s.
    pub approach: f64,
    /// The speed along the normal at which they part, in m/s; `None` if the run ends before.
    pub rebound: Option<f64>,
    /// The force of a contact that takes time; `None` for an instant.
    pub press: Option<Press>,
}

impl Impact {
    /// The effective coefficient of restitution: speed after over speed before; `None` where the
    /// record has not both.
    #[must_use]
    pub fn cor(&self) -> Option<f64> {
        self.rebound.filter(|_| self.approach > 0.0).map(|rebound| rebound / self.approach)
    }
}

/// A contact that takes time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// The time from touch to lift-off, in s; `None` if the ball does not leave.
    pub duration: Option<f64>,
    /// The greatest force, in N.
    pub force: f64,
    /// The greatest deformation, in m.
    pub deformation: f64,
}

/// A jump of the run: an impact, or another change of mode.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// The time in s.
    pub t: f64,
    /// The number of jumps up to this one, which is counted.
    pub j: usize,
    /// The edge: "floor", "wall", "ball", "zeno", "apex", ...
    pub edge: &'static str,
    /// The states before and after, of each ball that takes part.
    pub sides: Vec<Sides>,
}

/// A ball on both sides of a jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    /// The ball, counted from 0.
    pub ball: usize,
    /// The name of the mode before.
    pub from: &'static str,
    /// Just before.
    pub before: Moment,
    /// The name of the mode after.
    pub to: &'static str,
    /// Just after.
    pub after: Moment,
}

/// The top of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apex {
    /// The time in s.
    pub t: f64,
    /// The height of the lowest point, in m.
    pub height: f64,
}

/// The reason why a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum End {
    /// The time asked for was reached, or, where none was, everything has come to rest.
    Time,
    /// The limit on jumps was reached.
    Jumps {
        /// The limit.
        most: usize,
    },
    /// Impacts accumulate at `limit` in s, and the model does not say what lies beyond.
    Zeno {
        /// The limit of the times of the jumps, in s.
        limit: f64,
    },
    /// The limit on steps was reached.
    Steps {
        /// The limit.
        most: u64,
    },
    /// The limit on evaluations of flows and guards was reached.
    Evaluations {
        /// The limit.
        most: u64,
    },
    /// Too many jumps at one time.
    Cascade,
}

impl End {
    pub(super) fn of<E>(stop: &Stop<E>) -> Self {
        match *stop {
            Stop::Jumps { most } => Self::Jumps { most },
            Stop::Zeno { limit } | Stop::Resolution { limit } => Self::Zeno { limit },
            Stop::Steps { most } => Self::Steps { most },
            Stop::Evaluations { most } => Self::Evaluations { most },
            Stop::Cascade { .. } => Self::Cascade,
            _ => Self::Time,
        }
    }

    /// Whether the run came to the end that was asked for.
    #[must_use]
    pub const fn is_in_time(&self) -> bool {
        matches!(self, Self::Time)
    }

    /// The name of the ending, in one word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Jumps { .. } => "jumps",
            Self::Zeno { .. } => "zeno",
            Self::Steps { .. } => "steps",
            Self::Evaluations { .. } => "evaluations",
            Self::Cascade => "cascade",
        }
    }
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time => write!(f, "the end of the span was reached"),
            Self::Jumps { most } => write!(f, "the limit of {most} jumps was reached: allow more, or end by time"),
            Self::Zeno { limit } => write!(
                f,
                "infinitely many impacts come to a limit at {limit:.6} s, and what lies beyond is not modelled for several balls: end the run before"
            ),
            Self::Steps { most } => {
                write!(
                    f,
                    "the limit of {most} steps was reached: end the run earlier, loosen `tolerance`, or allow more by `most_jumps` under [run]"
                )
            }
            Self::Evaluations { most } => write!(
                f,
                "the limit of {most} evaluations was reached: end the run earlier, loosen `tolerance`, or allow more by `most_jumps` under [run]"
            ),
            Self::Cascade => write!(f, "too many jumps happen at one time"),
        }
    }
}

/// The cost of a run, in counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Jumps.
    pub jumps: usize,
    /// Steps, accepted and rejected.
    pub steps: u64,
    /// Evaluations of flows.
    pub flows: u64,
    /// Evaluations of guards.
    pub guards: u64,
}

impl From<saltus::Stats> for Cost {
    fn from(stats: saltus::Stats) -> Self {
        Self { jumps: stats.jumps, steps: stats.steps + stats.rejected, flows: stats.flows, guards: stats.guards }
    }
}

/// A recorded run of one model, whichever it is.
pub(super) trait RecordedRun: Send + Sync {
    fn balls(&self) -> usize;
    fn at(&self, ball: usize, t: f64) -> Option<(&'static str, Moment)>;
    fn before(&self, ball: usize, t: f64) -> Option<Moment>;
    fn segments(&self, ball: usize) -> Vec<Segment>;
    fn events(&self) -> Vec<Event>;
    fn impacts(&self) -> Vec<Impact>;
    fn hysteresis(&self, contact: usize, count: usize) -> Vec<[f64; 2]>;
    fn cost(&self) -> Cost;
    fn doubts(&self) -> Vec<String>;
}

/// A recorded run of a scene. It may be sent between threads and shared; serialised it is the JSON
/// of docs/use/simulating.md.
///
/// ```
/// use saltus_scene::Scene;
/// let scene = Scene::parse("drop.toml", b"restitution = 0.5\nball = { height = '1 m' }\n")?;
/// let record = scene.plan()?.run()?;
/// let rest = record.rest().unwrap();
/// assert!((rest - (2.0 / 9.80665_f64).sqrt() * 3.0).abs() < 1e-12);
/// assert_eq!(record.at(0, rest).unwrap().height(), 0.0);
/// assert_eq!(record.impacts()[0].cor(), Some(0.5));
/// assert!((record.apexes(0)[0].height - 0.25).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Record {
    pub(super) run: Box<dyn RecordedRun>,
    pub(super) scene: Arc<Scene>,
    pub(super) model: Model,
    pub(super) until: f64,
    pub(super) end: End,
    pub(super) rest: Option<f64>,
}

impl fmt::Debug for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { until, end, rest, .. } = self;
        let mut debug = f.debug_struct("Record");
        debug.field("until", until).field("end", end).field("rest", rest).finish_non_exhaustive()
    }
}

impl Record {
    /// The scene that was run.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The model that it was run by.
    #[must_use]
    pub const fn model(&self) -> Model {
        self.model
    }

    /// The number of balls.
    #[must_use]
    pub fn balls(&self) -> usize {
        self.run.balls()
    }

    /// The time reached, in s.
    #[must_use]
    pub const fn until(&self) -> f64 {
        self.until
    }

    /// The reason why the run ended.
    #[must_use]
    pub const fn end(&self) -> End {
        self.end
    }

    /// The time from which everything is at rest, in s, if it is.
    #[must_use]
    pub const fn rest(&self) -> Option<f64> {
        self.rest
    }

    /// A ball at `t` in s, after any jump then; `None` outside the run, or for a ball there is not.
    #[must_use]
    pub fn at(&self, ball: usize, t: f64) -> Option<Moment> {
        self.inside(ball, t).then(|| self.run.at(ball, t)).flatten().map(|(_, moment)| moment)
    }

    /// A ball at `t` in s, before any jump then.
    #[must_use]
    pub fn before(&self, ball: usize, t: f64) -> Option<Moment> {
        self.inside(ball, t).then(|| self.run.before(ball, t)).flatten()
    }

    /// The name of a ball's mode at `t` in s, after any jump then: "flight", "rest", "slide", ...
    #[must_use]
    pub fn mode(&self, ball: usize, t: f64) -> Option<&'static str> {
        self.inside(ball, t).then(|| self.run.at(ball, t)).flatten().map(|(mode, _)| mode)
    }

    fn inside(&self, ball: usize, t: f64) -> bool {
        ball < self.balls() && t <= self.until
    }

    /// The motion of a ball as polynomials in time, in order, up to the end of the run.
    #[must_use]
    pub fn segments(&self, ball: usize) -> Vec<Segment> {
        let mut segments = if ball < self.balls() { self.run.segments(ball) } else { Vec::new() };
        segments.retain(|segment| segment.start < self.until);
        if let Some(last) = segments.last_mut() {
            last.span = last.span.min(self.until - last.start);
        }
        segments
    }

    /// Every jump, in order.
    #[must_use]
    pub fn events(&self) -> Vec<Event> {
        self.run.events()
    }

    /// Every impact, in order.
    #[must_use]
    pub fn impacts(&self) -> Vec<Impact> {
        self.run.impacts()
    }

    /// The tops of the flights of a ball, in order; a start at rest is none.
    #[must_use]
    pub fn apexes(&self, ball: usize) -> Vec<Apex> {
        let mut tops = Tops::default();
        self.segments(ball).iter().filter_map(|segment| tops.next(segment)).collect()
    }

    /// The force in N over the deformation in m through one contact that takes time, counted from
    /// 0, `count` points for each of its stages; empty where there is none.
    #[must_use]
    pub fn hysteresis(&self, contact: usize, count: usize) -> Vec<[f64; 2]> {
        self.run.hysteresis(contact, count)
    }

    /// The places where a crossing may have been missed, in words; empty where none was.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        self.run.doubts()
    }

    /// The cost of the run.
    #[must_use]
    pub fn cost(&self) -> Cost {
        self.run.cost()
    }
}

/// Finds apexes in segments that are given in order.
#[derive(Debug, Default)]
pub(super) struct Tops {
    rising: bool,
    last: Option<f64>,
}

impl Tops {
    /// The apex in the segment, if there is one.
    pub(super) fn next(&mut self, segment: &Segment) -> Option<Apex> {
        if !segment.flight {
            self.rising = false;
            return None;
        }
        let up = |s: f64| segment.at(s).velocity.z;
        let (before, after) = (up(0.0), up(segment.span));
        let turns = (self.rising || before > 0.0) && after <= 0.0;
        self.rising = after > 0.0;
        let s = if turns && before > 0.0 { fall(up, segment.span) } else { 0.0 };
        let t = segment.start + s;
        // Rounding may let a piece that begins on an apex rise to it once more.
        if !turns || self.last.is_some_and(|last| t <= last + 4.0 * f64::EPSILON * t) {
            return None;
        }
        self.last = Some(t);
        Some(Apex { t, height: segment.at(s).height() })
    }
}

/// The time at which `rate` falls from above zero to zero or below within `span`.
fn fall(rate: impl Fn(f64) -> f64, span: f64) -> f64 {
    let (mut low, mut high) = (0.0, span);
    // A parabola's velocity is a line: its zero is found at once.
    let (a, b) = (rate(0.0), rate(span));
    let guess = span * (a / (a - b));
    if rate(guess).abs() <= 4.0 * f64::EPSILON * a.abs().max(b.abs()) {
        return guess;
    }
    for _ in 0..64 {
        let middle = 0.5 * (low + high);
        if rate(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
