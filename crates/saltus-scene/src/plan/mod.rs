//! From a scene to something that runs: the cheapest model that leaves nothing of the scene out.
//!
//! [`Scene::plan`] chooses it, [`Plan::explain`] gives the choice and its reasons, [`Plan::run`]
//! runs it, and the result is a [`Record`], whatever the model.

mod ball;
mod cloud;
mod compliant;
mod curve;
mod explain;
mod failure;
mod flock;
mod flyer;
mod line;
mod listed;
mod method;
mod outcome;
mod polyline;
mod record;
mod runner;
mod surroundings;
mod view;

use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;

pub use explain::{Advance, Effect, Explanation, ModePlan};
pub use failure::{PlanError, RunError};
pub use method::Way;
pub use outcome::Outcome;
pub use record::{Apex, Cost, End, Event, Impact, Moment, Press, Record, Segment, Sides, With};

use super::{Ball, Contact, Floor, Law, Motion, Scene, Shape, Stepper};
use method::Method;
use runner::{Recording, RunOptions, Runner};

/// The number of jumps after which a run without a limit of its own ends.
const MOST_JUMPS: u32 = 10_000;
/// The number of evaluations of flows and guards after which a run ends, and how many more it has
/// for each jump that it may make: some ten seconds for ten thousand jumps. A contact that takes
/// time has about a thousand.
const EVALUATIONS: u64 = 20_000_000;
const EVALUATIONS_PER_JUMP: u64 = 2_000;
/// The most balls on a line, and the most in the plane or in space.
const MOST_BALLS: usize = 5;
const MOST_IN_SPACE: usize = 5;
/// The relative tolerance of steps, unless the scene gives one.
const TOLERANCE: f64 = 1e-9;
/// The relative tolerance of contacts that take time: they last for a few steps only.
const CONTACT_TOLERANCE: f64 = 1e-12;
/// The models a scene may be run by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Model {
    /// [`Ball`](saltus_bounce::Ball): up and down on a level floor.
    Ball,
    /// [`Flyer`](saltus_bounce::Flyer): one ball among floors and walls.
    Flyer,
    /// [`Compliant`](saltus_bounce::Compliant): up and down on a floor that gives.
    Compliant,
    /// [`Line`](saltus_bounce::Line): several balls on a line.
    Line,
    /// [`Cloud`](saltus_bounce::Cloud): several smooth balls in the plane or in space, of which
    /// none comes to rest.
    Cloud,
    /// [`Flock`](saltus_bounce::Flock): several balls among floors and walls.
    Flock,
}

impl Model {
    /// The name of the model.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball",
            Self::Flyer => "flyer",
            Self::Compliant => "compliant",
            Self::Line => "line",
            Self::Cloud => "cloud",
            Self::Flock => "flock",
        }
    }
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ball => "ball: one, up and down on a level floor",
            Self::Flyer => "flyer: one ball among floors and walls",
            Self::Compliant => "compliant: one ball, up and down on a level floor, with contacts that take time",
            Self::Line => "line: several balls on a line",
            Self::Cloud => "cloud: several smooth balls in the plane or in space",
            Self::Flock => "flock: several balls among floors and walls",
        })
    }
}

/// A scene that can be run.
///
/// ```
/// use saltus_scene::Scene;
/// use saltus_scene::plan::{Advance, Model};
/// let scene = Scene::parse("drop.toml", b"restitution = 0.8\nball = { height = '1 m' }\n")?;
/// let plan = scene.plan()?;
/// let explanation = plan.explain();
/// assert_eq!((explanation.model, explanation.coordinates.len()), (Model::Ball, 2));
/// assert!(explanation.modes.iter().all(|mode| mode.advance == Advance::Exact));
/// let record = plan.until(1.0).run()?;
/// assert_eq!((record.impacts().len(), record.cost().steps), (1, 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Plan {
    runner: Arc<dyn Runner>,
    scene: Arc<Scene>,
    options: RunOptions,
    explanation: Explanation,
}

impl fmt::Debug for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Plan")
            .field("how", &self.options)
            .field("explanation", &self.explanation)
            .finish_non_exhaustive()
    }
}

impl Plan {
    /// The explanation of the plan: what was chosen, and why.
    #[must_use]
    pub const fn explain(&self) -> &Explanation {
        &self.explanation
    }

    /// Ends the run at `t` in s, instead of when the scene says.
    #[must_use]
    pub const fn until(mut self, t: f64) -> Self {
        self.options.until = Some(t);
        self
    }

    /// Ends the run after so many jumps, instead of the scene's number.
    #[must_use]
    pub const fn most_jumps(mut self, count: u32) -> Self {
        self.options.most_jumps = count as usize;
        self
    }

    /// Ends the run after so many evaluations of flows and guards, or a fifth as many steps; 2 ×
    /// 10⁷ and 2000 for each jump that it may make unless set.
    #[must_use]
    pub const fn most_evaluations(mut self, count: u64) -> Self {
        self.options.most_evaluations = count;
        self
    }

    /// The plan with another way to run it.
    pub(super) fn by(mut self, way: Way) -> Self {
        match way {
            Way::Formulas => {}
            Way::Steps { stepper, tolerance } => {
                // A series is a solution of the flow, which pure steps do not ask for.
                (self.options.method, self.options.tolerance, self.options.stepped) =
                    (Method(stepper), tolerance, stepper != Stepper::Series);
            }
            Way::Frames { rate } => self.options.frames = Some(rate),
        }
        self
    }

    /// Whether a formula solves every mode.
    pub(super) const fn is_solved(&self) -> bool {
        self.options.solved
    }

    /// The stepper of the plan where one is needed.
    pub(super) const fn stepper(&self) -> Stepper {
        self.options.method.0
    }

    /// Runs from the scene's start, and records everything.
    ///
    /// # Errors
    /// [`RunError`] if the engine fails, or if nothing ends the run.
    pub fn run(&self) -> Result<Record, RunError> {
        self.run_while(&mut || ControlFlow::Continue(()))
    }

    /// Runs from the scene's start, as [`run`](Self::run); `ask` is called between steps and jumps,
    /// and `Break` ends the run.
    ///
    /// # Errors
    /// As [`run`](Self::run), and where `ask` ended it.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use saltus_scene::Scene;
    /// let scene = Scene::parse("drop.toml", b"restitution = 0.8\nball = { height = '1 m' }\n")?;
    /// let ended = scene.plan()?.run_while(&mut || ControlFlow::Break(()));
    /// assert_eq!(ended.unwrap_err().to_string(), "the run was ended before it was done");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn run_while(&self, ask: &mut dyn FnMut() -> ControlFlow<()>) -> Result<Record, RunError> {
        let Recording { run, until, end, rest } = self.runner.run(&self.options, ask)?;
        Ok(Record { run, scene: Arc::clone(&self.scene), model: self.explanation.model, until, end, rest })
    }

    /// Runs from the scene's start, and keeps the outcome only: many times faster than
    /// [`run`](Self::run) where a formula solves the motion.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn outcome(&self) -> Result<Outcome, RunError> {
        match self.explanation.model {
            // Durations and forces of contacts are taken from the recorded motion.
            Model::Compliant => Ok(Outcome::of(&self.run()?)),
            _ => self.runner.outcome(&self.options),
        }
    }
}

impl Scene {
    /// The cheapest faithful way to run the scene: an exact arc, else a closed form, else an
    /// explicit stepper, else a stiff one.
    ///
    /// # Errors
    /// [`PlanError`] where the scene asks for what no model here has, with its place and what to do
    /// instead; of a scene that was read, with line and column.
    pub fn plan(&self) -> Result<Plan, PlanError> {
        choose(self).map(|chosen| self.planned(chosen)).map_err(|error| error.found(&self.source))
    }

    /// The plan of this scene by a model that steppers can step through, also where the planned one
    /// is solved by formulas; `None` if there is none.
    pub(super) fn steppable(&self) -> Option<Plan> {
        let plan = self.plan().ok()?;
        match plan.explanation.model {
            Model::Ball => Some(self.planned((Model::Flyer, flyer::runner(self).ok()?, None))),
            Model::Flyer => Some(plan),
            _ => (!plan.options.solved).then_some(plan),
        }
    }

    /// The plan of this scene with flights advanced by Taylor series; `None` if none of its modes
    /// is.
    pub(super) fn expandable(&self) -> Option<Plan> {
        let mut scene = self.clone();
        scene.run.stepper = Some(Stepper::Series);
        let plan = scene.plan().ok()?;
        plan.explanation.modes.iter().any(|mode| mode.advance == Advance::Series).then_some(plan)
    }

    fn planned(&self, (model, runner, absolute): Chosen) -> Plan {
        let default = if model == Model::Compliant { CONTACT_TOLERANCE } else { TOLERANCE };
        let tolerance = self.run.tolerance.unwrap_or(default);
        let method = Method::of(self.run.stepper, tolerance);
        let most_jumps = self.run.most_jumps.unwrap_or(MOST_JUMPS) as usize;
        let modes = runner.modes(method);
        let solved = modes.iter().all(|mode| mode.advance.is_solved());
        let explanation = Explanation::of(self, model, runner.coordinates(), modes, tolerance);
        let motions = self.floors.iter().filter_map(|floor| floor.motion.as_ref());
        let options = RunOptions {
            until: self.run.until,
            most_jumps,
            most_evaluations: EVALUATIONS + EVALUATIONS_PER_JUMP * most_jumps as u64,
            method,
            tolerance,
            solved,
            stepped: false,
            frames: None,
            absolute,
            still: motions.filter_map(Motion::ends).fold(0.0, f64::max),
        };
        Plan { runner: Arc::from(runner), scene: Arc::new(self.clone()), options, explanation }
    }
}

type Chosen = (Model, Box<dyn Runner>, Option<f64>);

fn choose(scene: &Scene) -> Result<Chosen, PlanError> {
    if scene.balls.len() > 1 {
        return several(scene);
    }
    if scene.contact != Contact::Rigid {
        let (pressed, contact) = (pressed(scene)?, scene.contact);
        return compliant::runner(pressed, contact).map(|(runner, absolute)| (Model::Compliant, runner, absolute));
    }
    if let Some((vertical, law)) = vertical(scene) {
        return Ok((Model::Ball, ball::runner(vertical, law)?, None));
    }
    Ok((Model::Flyer, flyer::runner(scene)?, None))
}

/// The level floor under the balls of a vertical scene: which, and how high; `None` if there is
/// none or it moves.
fn ground(scene: &Scene) -> Option<(usize, f64)> {
    let level = |(owner, floor): (usize, &Floor)| match floor.shape {
        Shape::Level { height } if floor.motion.is_none() => Some((owner, height)),
        _ => None,
    };
    let all: Option<Vec<(usize, f64)>> = scene.floors.iter().enumerate().map(level).collect();
    all?.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Gravity less buoyancy, and the share of all forces that added mass leaves.
fn net(scene: &Scene, ball: &Ball) -> (f64, f64) {
    let effects = &scene.effects;
    let gravity = effects.buoyancy(ball, scene.gravity).map_or(scene.gravity.value(), |lift| lift.net_gravity());
    let share = match ball.sphere() {
        Some(sphere) if effects.added_mass => 1.0 / (1.0 + 0.5 * effects.density / sphere.density()),
        _ => 1.0,
    };
    (gravity, share)
}

/// The scene as that of a vertical ball, if a formula solves it.
fn vertical(scene: &Scene) -> Option<(ball::Vertical, &Law)> {
    let (gravity, share) = net(scene, &scene.balls[0]);
    if scene.dimensions > 1 || gravity < 0.0 {
        return None;
    }
    let floor = ground(scene)?;
    let (ball, effects) = (&scene.balls[0], &scene.effects);
    let drag = match (effects.linear_drag(ball), effects.quadratic_drag(ball)) {
        (None, None) => ball::Drag::None,
        (Some(linear), None) => ball::Drag::Linear(linear.rate() * share),
        (None, Some(quadratic)) => ball::Drag::Quadratic(quadratic.per_length() * share),
        (Some(_), Some(_)) => return None,
    };
    let (height, velocity) = (ball.lowest().z - floor.1, ball.velocity.z);
    let vertical = ball::Vertical { gravity: gravity * share, drag, floor, height, velocity };
    Some((vertical, scene.law(0, floor.0)?))
}

fn pressed(scene: &Scene) -> Result<compliant::Pressed, PlanError> {
    let refused = |says: &str| PlanError::new("[contact]", says);
    if scene.dimensions > 1 {
        return Err(refused(
            "contact that takes time is simulated up and down only: leave out what moves sideways, or give a restitution",
        ));
    }
    if !flyer::uniform(scene) {
        return Err(refused(
            "contact that takes time is simulated without drag: leave [drag] out, or give a restitution",
        ));
    }
    let (gravity, share) = net(scene, &scene.balls[0]);
    if gravity < 0.0 {
        return Err(PlanError::new("buoyancy", "the ball is lighter than the air and never comes down: leave it out"));
    }
    let ball = &scene.balls[0];
    let floor = ground(scene).ok_or_else(|| {
        refused("contact that takes time needs a level floor that stands still: leave its `motion` out")
    })?;
    let mass = ball.mass.ok_or_else(|| refused("the ball needs a mass: give `mass = \"45 g\"` under [ball]"))?;
    let (height, velocity) = (ball.lowest().z - floor.1, ball.velocity.z);
    Ok(compliant::Pressed { mass: mass / share, gravity: gravity * share, floor, height, velocity })
}

fn several(scene: &Scene) -> Result<Chosen, PlanError> {
    if scene.contact != Contact::Rigid {
        let says = "contact that takes time is simulated for one ball: leave it out, or keep one ball";
        return Err(PlanError::new("[contact]", says));
    }
    if plain(scene) {
        let vertical = scene.dimensions == 1;
        if let Some(u) = line::direction(scene) {
            let floor = if vertical { ground(scene) } else { None };
            return Ok((Model::Line, line::runner(scene, u, floor)?, None));
        }
        if cloud::suffices(scene) {
            return Ok((Model::Cloud, cloud::runner(scene)?, None));
        }
    }
    // On one line they may come to rest upon each other: that is the end of the run, by name. What
    // a floor that moves does to them then is more than their guards resolve.
    let moves = scene.floors.iter().position(|floor| floor.motion.is_some()).filter(|_| scene.dimensions == 1);
    if let Some(owner) = moves {
        let says = "several balls that only move up and down are simulated over floors that stand still: leave `motion` out, or give them a `position` with x";
        return Err(PlanError::floor(owner, says));
    }
    Ok((Model::Flock, flock::runner(scene)?, None))
}

/// Whether nothing acts on several balls but gravity and restitution, on floors that stand still.
fn plain(scene: &Scene) -> bool {
    let names = |effect: Effect| match effect {
        Effect::Gravity => false,
        // What only moves up and down does not rub.
        Effect::Friction => scene.dimensions > 1 && scene.names(Effect::Friction),
        effect => scene.names(effect),
    };
    let rubs = scene.dimensions > 1 && scene.collision_friction.coefficient() > 0.0;
    let spins = scene.balls.iter().any(|ball| ball.spin.is_some());
    let moves = scene.floors.iter().any(|floor| floor.motion.is_some());
    !(Effect::ALL.into_iter().any(names) || rubs || spins || moves)
}

/// The label of a floor: its name, or its kind, with its number where there are several.
fn label(scene: &Scene, owner: usize) -> String {
    let Some(floor) = scene.floors.get(owner) else { return "floor".to_owned() };
    match &floor.name {
        Some(name) => name.clone(),
        None if scene.floors.len() > 1 => format!("{} {}", floor.shape.word(), owner + 1),
        None => floor.shape.word().to_owned(),
    }
}

/// A law refuses a number: the reader has let it through, but the combination is out of its range.
#[allow(clippy::needless_pass_by_value)] // used as a function
fn failed(error: saltus_bounce::ParameterError) -> PlanError {
    PlanError::new("the scene", &error.to_string())
}
