//! What accuracy costs in a scene: the same scene by several steppers, to several tolerances, and
//! frame by frame, each against one reference.

use std::fmt;

use saltus::Timing;

pub use super::plan::Way;
use super::plan::{Cost, Effect, Impact, Plan, PlanError, Record, RunError};
pub use super::report::Seconds;
use super::{Scene, Stepper};
use saltus_bounce::effects::Gravity;

/// The tolerances tried.
const TOLERANCES: [f64; 10] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];
/// The tolerance of the reference where no formula solves the scene, and of the run by which its
/// own error is estimated.
const REFERENCE: f64 = 1e-14;
const SECOND: f64 = 1e-13;
/// Frames per second tried.
const RATES: [f64; 5] = [24.0, 30.0, 60.0, 120.0, 240.0];
/// The most evaluations of a run: about a second.
const MOST_EVALUATIONS: u64 = 10_000_000;
/// The number of times at which places and energies are compared.
const TIMES: u32 = 1000;
/// Impacts slower than this share of the fastest are not asked for one by one.
const SLOW: f64 = 1e-3;

/// The difference of one run of a scene from another. Infinite where the other run breaks off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// The largest difference of the times of impacts, in s. Impacts slower than a thousandth of
    /// the fastest are not compared one by one.
    pub impacts: f64,
    /// The largest difference of the heights of apexes between those impacts, in m.
    pub apexes: f64,
    /// The largest difference of the places of the balls at 1001 times from start to end, in m.
    pub position: f64,
    /// The largest difference of the energy halfway between those impacts and at the end, as a
    /// share of its greatest.
    pub energy: f64,
    /// The number of impacts that the run lacks or has in another order.
    pub missed: usize,
}

impl Difference {
    /// The difference of `other` from `reference`, two runs of `scene`.
    #[must_use]
    pub fn between(scene: &Scene, reference: &Record, other: &Record) -> Self {
        let (wanted, got) = (reference.impacts(), other.impacts());
        let fastest = wanted.iter().map(|impact| impact.approach).fold(0.0, f64::max);
        let seen = wanted.iter().rposition(|impact| impact.approach > SLOW * fastest).map_or(0, |last| last + 1);
        let same = |(a, b): &(&Impact, &Impact)| (a.ball, a.with) == (b.ball, b.with);
        let pairs: Vec<(&Impact, &Impact)> = wanted[..seen].iter().zip(&got).take_while(same).collect();
        let impacts = pairs.iter().map(|(a, b)| (a.t - b.t).abs()).fold(0.0, f64::max);
        let until = if seen == wanted.len() { f64::INFINITY } else { wanted[seen].t };
        let balls = 0..reference.balls();

        let mut apexes = 0.0_f64;
        for ball in balls.clone() {
            let tops = reference.apexes(ball);
            let mut others = other.apexes(ball).into_iter();
            for top in tops.iter().take_while(|top| top.t < until) {
                apexes = apexes.max(others.next().map_or(f64::INFINITY, |other| (other.height - top.height).abs()));
            }
        }

        let mut position = 0.0_f64;
        for ball in balls {
            for k in 0..=TIMES {
                let t = reference.until() * f64::from(k) / f64::from(TIMES);
                let place = |record: &Record| record.at(ball, t).map(|moment| moment.position);
                // The end of a run may lie a rounding before the same end of another.
                let gap = match (place(reference), place(other).or_else(|| place_at_end(other, ball, t))) {
                    (Some(a), Some(b)) => (a - b).norm(),
                    _ => f64::INFINITY,
                };
                position = position.max(gap);
            }
        }

        // Halfway between two impacts, by each run's own clock: near an impact a hair of time is
        // all the energy it costs.
        let mut largest = energy(scene, reference, 0.0).abs();
        let mut gap = 0.0_f64;
        let mut compare = |a: f64, b: f64| {
            let (a, b) = (energy(scene, reference, a), energy(scene, other, b));
            largest = largest.max(a.abs());
            gap = gap.max((a - b).abs());
        };
        for pair in pairs.windows(2) {
            compare(0.5 * (pair[0].0.t + pair[1].0.t), 0.5 * (pair[0].1.t + pair[1].1.t));
        }
        compare(reference.until(), other.until().min(reference.until()));
        let energy = if gap == 0.0 { 0.0 } else { gap / largest };
        Self { impacts, apexes, position, energy, missed: seen - pairs.len() }
    }

    /// Whether it is within `target`, even if the reference is off by `doubt`.
    #[must_use]
    pub fn meets(&self, target: Target, doubt: &Self) -> bool {
        self.share(target, doubt) <= 1.0
    }

    /// The error as a share of `target`, if the reference is off by `doubt`: at most 1 if it is
    /// within it. Infinite where an impact is missed.
    #[must_use]
    pub fn share(&self, target: Target, doubt: &Self) -> f64 {
        if self.missed > 0 {
            return f64::INFINITY;
        }
        let time = target.time.map_or(0.0, |most| (self.impacts + doubt.impacts) / most);
        let off = (self.position + doubt.position).max(self.apexes + doubt.apexes);
        time.max(target.length.map_or(0.0, |most| off / most))
    }
}

fn place_at_end(record: &Record, ball: usize, t: f64) -> Option<nalgebra::Vector3<f64>> {
    let end = record.until();
    (t - end <= 1e-12 * t).then(|| record.at(ball, end)).flatten().map(|moment| moment.position)
}

/// The energy of all balls at `t` in J, or in J/kg where the scene gives no mass.
fn energy(scene: &Scene, record: &Record, t: f64) -> f64 {
    let mut sum = 0.0;
    for (ball, n) in scene.balls.iter().zip(0..) {
        let Some(moment) = record.at(n, t) else { return f64::INFINITY };
        let mass = ball.mass.unwrap_or(1.0);
        let turning = ball.inertia * ball.radius.unwrap_or(0.0).powi(2);
        let motion = moment.velocity.norm_squared() + turning * moment.spin.norm_squared();
        sum += mass * (scene.gravity.value() * moment.height() + 0.5 * motion);
    }
    sum
}

/// The accuracy that a run has to have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The error allowed of every place and every apex, in m.
    pub length: Option<f64>,
    /// The error allowed of the time of every impact, in s.
    pub time: Option<f64>,
}

impl Target {
    /// A millimetre and a millisecond.
    pub const DEFAULT: Self = Self { length: Some(1e-3), time: Some(1e-3) };
}

/// A way to run a scene, with its error and its cost.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Trial {
    /// The way.
    pub way: Way,
    /// The outcome, or why there is none.
    pub outcome: Result<Outcome, String>,
}

/// The outcome of a run: its error and its cost.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outcome {
    /// The difference from the reference.
    pub difference: Difference,
    /// The cost in counts.
    pub cost: Cost,
    /// The cost in time on this machine, if it was timed.
    pub timing: Option<Timing>,
}

impl Outcome {
    /// Evaluations of flows and guards.
    #[must_use]
    pub const fn evaluations(&self) -> u64 {
        self.cost.flows + self.cost.guards
    }
}

/// The cost of accuracy in a scene.
///
/// ```
/// use saltus_scene::Scene;
/// use saltus_scene::accuracy::{Accuracy, Target, Way};
/// let toml = "restitution = 0.8\nball = { height = '1 m' }\ndrag = { rate = 0.1, per_length = 0.05 }\nrun = { until = 2.0 }\n";
/// let scene = Scene::parse("drop.toml", toml.as_bytes())?;
/// let accuracy = Accuracy::counted(&scene)?;
/// let best = accuracy.cheapest(Target::DEFAULT).unwrap();
/// let outcome = best.outcome.as_ref().unwrap();
/// assert!(outcome.difference.position <= 1e-3 && outcome.difference.impacts <= 1e-3);
/// assert!(matches!(best.way, Way::Steps { .. }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Accuracy {
    reference: Record,
    by: Way,
    doubt: Difference,
    trials: Vec<Trial>,
}

/// The difference that one effect makes, left out or put in, and its cost.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Toggle {
    /// The effect.
    pub effect: Effect,
    /// Whether it was left out, or put in.
    pub without: bool,
    /// The outcome, or why there is none.
    pub outcome: Result<Outcome, String>,
}

impl fmt::Display for Toggle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", if self.without { "without" } else { "with" }, self.effect)
    }
}

impl Accuracy {
    /// Runs the scene in every way, and times each.
    ///
    /// # Errors
    /// [`AccuracyError`] if the scene has no plan, or its reference does not run to its end.
    pub fn timed(scene: &Scene) -> Result<Self, AccuracyError> {
        Self::of(scene, true)
    }

    /// Runs the scene in every way without timing: the result is the same on every machine.
    ///
    /// # Errors
    /// As for [`timed`](Self::timed).
    pub fn counted(scene: &Scene) -> Result<Self, AccuracyError> {
        Self::of(scene, false)
    }

    fn of(scene: &Scene, timed: bool) -> Result<Self, AccuracyError> {
        let limited = |plan: Plan| plan.most_evaluations(MOST_EVALUATIONS);
        let planned = scene.plan()?;
        let solved = planned.is_solved();
        let base = planned.run()?;
        let until = base.until();
        let by = |way: Way| -> Result<Record, RunError> {
            // The reference may take its time.
            planned.clone().by(way).until(until).run()
        };
        let stepper = planned.stepper().exact();
        let tight = |tolerance: f64| Way::Steps { stepper, tolerance };
        let (way, reference, doubt) = if solved {
            // A hair longer, for what happens at the very end.
            let nudged = nudged(scene).plan()?.until(until * (1.0 + 1e-9)).run()?;
            let doubt = Difference::between(scene, &base, &nudged);
            (Way::Formulas, base, doubt)
        } else {
            let reference = by(tight(REFERENCE))?;
            let doubt = Difference::between(scene, &reference, &by(tight(SECOND))?);
            (tight(REFERENCE), reference, doubt)
        };
        if !reference.end().is_in_time() {
            return Err(RunError::new(format!("the reference breaks off: {}", reference.end())).into());
        }
        let mut accuracy = Self { reference, by: way, doubt, trials: Vec::new() };
        let mut attempt = |plan: &Plan, way: Way| {
            let plan = limited(plan.clone().by(way).until(until));
            let outcome = accuracy.outcome(scene, &plan, timed);
            accuracy.trials.push(Trial { way, outcome });
        };
        if solved {
            attempt(&planned, Way::Formulas);
        }
        let (stepped, expanded) = (scene.steppable(), scene.expandable());
        for stepper in [Stepper::Tsit5, Stepper::Dop853, Stepper::Rodas5p, Stepper::Series] {
            if let Some(plan) = if stepper == Stepper::Series { &expanded } else { &stepped } {
                for tolerance in TOLERANCES {
                    attempt(plan, Way::Steps { stepper, tolerance });
                }
            }
        }
        for rate in RATES {
            attempt(&planned, Way::Frames { rate });
        }
        Ok(accuracy)
    }

    fn outcome(&self, scene: &Scene, plan: &Plan, timed: bool) -> Result<Outcome, String> {
        let record = plan.run().map_err(|error| error.to_string())?;
        if !record.end().is_in_time() {
            return Err(record.end().to_string());
        }
        let difference = Difference::between(scene, &self.reference, &record);
        let timing = timed.then(|| Timing::of(|| plan.run()));
        Ok(Outcome { difference, cost: record.cost(), timing })
    }

    /// The way in which the reference was made, and the reference: by formulas where they solve the
    /// scene, or else to a tolerance two orders tighter than any trial.
    #[must_use]
    pub const fn reference(&self) -> (Way, &Record) {
        (self.by, &self.reference)
    }

    /// The error of the reference itself: its difference from a run to ten times its tolerance.
    /// Where formulas made it, the error is that of rounding: the difference from the scene whose
    /// gravity and velocities are a unit in the last place larger. That is next to nothing, but for
    /// balls that hit each other often.
    #[must_use]
    pub const fn doubt(&self) -> &Difference {
        &self.doubt
    }

    /// Every way that was tried, in order.
    #[must_use]
    pub fn trials(&self) -> &[Trial] {
        &self.trials
    }

    /// The ways that cost least for what they give, from the cheapest to the most exact: none of
    /// the others comes as near to `target` for as few evaluations. Frames are left aside; where
    /// formulas solve the scene, they alone are on it.
    #[must_use]
    pub fn frontier(&self, target: Target) -> Vec<&Trial> {
        if let Some(formulas) = self.trials.iter().find(|trial| matches!(trial.way, Way::Formulas)) {
            return vec![formulas];
        }
        let stepped = self.trials.iter().filter(|trial| !matches!(trial.way, Way::Frames { .. }));
        let point = |trial: &'_ Trial| {
            let outcome = trial.outcome.as_ref().ok()?;
            Some((outcome.evaluations(), outcome.difference.share(target, &self.doubt)))
        };
        let mut points: Vec<_> = stepped.filter_map(|trial| Some((point(trial)?, trial))).collect();
        points.sort_by(|((a, off), _), ((b, than), _)| a.cmp(b).then(off.total_cmp(than)));
        let mut least = f64::INFINITY;
        points.retain(|&((_, off), _)| {
            let nearer = off < least;
            least = least.min(off);
            nearer
        });
        points.into_iter().map(|(_, trial)| trial).collect()
    }

    /// The way that meets `target` with the fewest evaluations, frames left aside; `None` if none
    /// does. Where formulas solve the scene, they do: a run takes them whatever stepper and
    /// tolerance it is given.
    #[must_use]
    pub fn cheapest(&self, target: Target) -> Option<&Trial> {
        let meets =
            |trial: &&Trial| trial.outcome.as_ref().is_ok_and(|outcome| outcome.difference.meets(target, &self.doubt));
        self.frontier(target).into_iter().find(meets)
    }

    /// The cost of a further digit by a stepper: the factor by which the evaluations grow as the
    /// error falls to a tenth, by least squares of the logarithms over the trials whose error
    /// stands clear of the reference's; `None` if there are fewer than three.
    #[must_use]
    pub fn per_digit(&self, by: Stepper) -> Option<f64> {
        let point = |trial: &Trial| match (trial.way, &trial.outcome) {
            (Way::Steps { stepper, .. }, Ok(outcome)) if stepper == by => {
                let Difference { position, missed, .. } = outcome.difference;
                let clear = missed == 0 && position > 1e-12 && position > 10.0 * self.doubt.position && position < 0.1;
                #[allow(clippy::cast_precision_loss)] // a count
                clear.then(|| (-position.log10(), (outcome.evaluations() as f64).log10()))
            }
            _ => None,
        };
        let points: Vec<(f64, f64)> = self.trials.iter().filter_map(point).collect();
        if points.len() < 3 {
            return None;
        }
        let count = points.len() as f64;
        let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / count, y + p.1 / count));
        let (xy, xx) =
            points.iter().fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - x) * (p.1 - y), xx + (p.0 - x).powi(2)));
        (xx > 0.0).then(|| 10_f64.powf(xy / xx))
    }

    /// The difference that each effect makes, and its cost: the scene with it left out or put in,
    /// against the reference, to the tolerance that the plan would choose.
    #[must_use]
    pub fn toggled(&self, scene: &Scene) -> Vec<Toggle> {
        let until = self.reference.until();
        let toggle = |effect: Effect| {
            let plan = |scene: Scene| scene.plan().map_err(|error| error.to_string());
            let plan = scene.toggled(effect).map_err(str::to_owned).and_then(plan);
            let plan = plan.map(|plan| plan.until(until).most_evaluations(MOST_EVALUATIONS));
            let outcome = plan.and_then(|plan| self.outcome(scene, &plan, true));
            Toggle { effect, without: scene.names(effect), outcome }
        };
        Effect::ALL.into_iter().map(toggle).collect()
    }
}

/// The same scene with the rounding of its numbers changed.
fn nudged(scene: &Scene) -> Scene {
    let up = 1.0 + f64::EPSILON;
    let mut nudged = scene.clone();
    if let Ok(gravity) = Gravity::new(up * scene.gravity.value()) {
        nudged.gravity = gravity;
    }
    for ball in &mut nudged.balls {
        ball.velocity *= up;
    }
    nudged
}

/// An error of the comparison: the reason why there is none.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum AccuracyError {
    /// The scene has no plan.
    Plan(PlanError),
    /// The reference failed.
    Run(RunError),
}

impl fmt::Display for AccuracyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan(error) => error.fmt(f),
            Self::Run(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for AccuracyError {}

impl From<PlanError> for AccuracyError {
    fn from(error: PlanError) -> Self {
        Self::Plan(error)
    }
}

impl From<RunError> for AccuracyError {
    fn from(error: RunError) -> Self {
        Self::Run(error)
    }
}
