//! The explanation of a plan: effects in and out, coordinates, the method of each mode and its
//! reason, edges.

use std::fmt;

use super::Model;
use crate::error::short;
use crate::{Ball, Contact, Decay, Linear, Quadratic, Scene};
use saltus_bounce::effects::{Buoyancy, Effect as _, LinearDrag, Motion, QuadraticDrag};
use saltus_bounce::friction::Friction;

/// Something that acts on a ball, or on how it bounces, and that a scene may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Effect {
    /// A constant force downwards.
    Gravity,
    /// Drag in proportion to the speed.
    LinearDrag,
    /// Drag in proportion to the square of the speed.
    QuadraticDrag,
    /// Moving air.
    Wind,
    /// The air lifts the ball.
    Buoyancy,
    /// The ball drags air along.
    AddedMass,
    /// Lift by spin.
    Lift,
    /// Spin that the air slows down.
    SpinDecay,
    /// Friction along floors and walls.
    Friction,
    /// Contact that takes time.
    Deformation,
}

/// The drag coefficient of a smooth sphere in air, Reynolds numbers from 10³ to 10⁵.
const DRAG_COEFFICIENT: f64 = 0.47;
/// The coefficient by which friction is tried where a scene has none.
const TRIED_FRICTION: f64 = 0.3;

impl Effect {
    /// All effects.
    pub const ALL: [Self; 10] = [
        Self::Gravity,
        Self::LinearDrag,
        Self::QuadraticDrag,
        Self::Wind,
        Self::Buoyancy,
        Self::AddedMass,
        Self::Lift,
        Self::SpinDecay,
        Self::Friction,
        Self::Deformation,
    ];

    /// The name of the effect.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gravity => "gravity",
            Self::LinearDrag => "linear drag",
            Self::QuadraticDrag => "quadratic drag",
            Self::Wind => "wind",
            Self::Buoyancy => "buoyancy",
            Self::AddedMass => "added mass",
            Self::Lift => "lift by spin",
            Self::SpinDecay => "spin decay",
            Self::Friction => "friction",
            Self::Deformation => "contact that takes time",
        }
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Scene {
    /// Whether the scene names `effect`; gravity is named unless it is zero.
    #[must_use]
    pub fn names(&self, effect: Effect) -> bool {
        let effects = &self.effects;
        match effect {
            Effect::Gravity => self.gravity.value() > 0.0,
            Effect::LinearDrag => effects.linear.is_some(),
            Effect::QuadraticDrag => effects.quadratic.is_some(),
            Effect::Wind => effects.wind.is_some(),
            Effect::Buoyancy => effects.buoyancy,
            Effect::AddedMass => effects.added_mass,
            Effect::Lift => effects.lift.is_some(),
            Effect::SpinDecay => effects.spin_decay.is_some(),
            Effect::Friction => self.floors.iter().any(|floor| floor.friction.coefficient() > 0.0),
            Effect::Deformation => self.contact != Contact::Rigid,
        }
    }

    /// The scene with `effect` left out if it is in, or in with the numbers of a textbook if it is
    /// out.
    ///
    /// # Errors
    /// Why that makes no scene: without gravity nothing comes down, a point without mass has no
    /// drag, and restitution does not come of nothing.
    pub fn toggled(&self, effect: Effect) -> Result<Self, &'static str> {
        let named = self.names(effect);
        if let Some(why) = self.untoggled(effect, named) {
            return Err(why);
        }
        let mut scene = self.clone();
        let effects = &mut scene.effects;
        match effect {
            Effect::Gravity | Effect::Deformation => {}
            Effect::LinearDrag => effects.linear = (!named).then_some(Linear::Viscous),
            Effect::QuadraticDrag => effects.quadratic = (!named).then_some(Quadratic::Coefficient(DRAG_COEFFICIENT)),
            Effect::Wind => effects.wind = None,
            Effect::Buoyancy => effects.buoyancy = !named,
            Effect::AddedMass => effects.added_mass = !named,
            Effect::Lift => effects.lift = (!named).then_some([1.0, 0.0]),
            Effect::SpinDecay => effects.spin_decay = (!named).then_some(Decay::Within(20.0)),
            Effect::Friction => {
                let tried = Friction::rigid(TRIED_FRICTION).unwrap_or(Friction::NONE);
                let friction = if named { Friction::NONE } else { tried };
                scene.floors.iter_mut().for_each(|floor| floor.friction = friction);
            }
        }
        Ok(scene)
    }

    /// The reason why an effect that is `named`, or is not, has to stay so.
    fn untoggled(&self, effect: Effect, named: bool) -> Option<&'static str> {
        let all = |has: fn(&Ball) -> bool| self.balls.iter().all(has);
        let point = !all(|ball| ball.sphere().is_some());
        let spins = self.dimensions > 1 && !all(|ball| ball.spin.is_none());
        match effect {
            Effect::Gravity if named => Some("without it nothing comes down"),
            Effect::Gravity => Some("the scene says there is none"),
            Effect::Deformation if named => Some("restitution comes of it, and the scene gives no other"),
            Effect::Deformation => Some("its stiffness is not known: give [contact]"),
            _ if named => None,
            Effect::Wind => Some("its speed is not known: give `wind` under [air]"),
            Effect::Friction if self.dimensions == 1 => Some("a ball that only moves up and down does not rub"),
            Effect::Friction if self.floors.is_empty() => Some("there is no floor to rub on"),
            Effect::Friction if !all(|ball| ball.radius.is_some()) => {
                Some("it turns the ball, whose radius is not known: give `radius` under [ball]")
            }
            Effect::Friction => None,
            _ if point => Some("the ball's size or mass is not known: give `radius` and `mass` under [ball]"),
            Effect::Lift | Effect::SpinDecay if !spins => Some("the ball does not spin: give `spin` under [ball]"),
            _ => None,
        }
    }

    /// An effect of the scene with its numbers.
    fn with_numbers(&self, effect: Effect) -> String {
        let effects = &self.effects;
        match effect {
            Effect::Gravity => format!("gravity, {} m/s² downwards", self.gravity.value()),
            Effect::LinearDrag => {
                let rate = self.in_turn(|ball| effects.linear_drag(ball).map_or(0.0, LinearDrag::rate));
                format!("linear drag, a = -{rate} /s × v")
            }
            Effect::QuadraticDrag => {
                let k = self.in_turn(|ball| effects.quadratic_drag(ball).map_or(0.0, QuadraticDrag::per_length));
                format!("quadratic drag, a = -{k} /m × |v| v")
            }
            Effect::Wind => {
                let wind = effects.wind.unwrap_or_default();
                let numbers: Vec<String> = wind.iter().map(ToString::to_string).collect();
                format!("wind, ({}) m/s", numbers.join(", "))
            }
            Effect::Buoyancy => {
                let net = |ball: &Ball| effects.buoyancy(ball, self.gravity).map_or(0.0, Buoyancy::net_gravity);
                format!("buoyancy, which leaves {} m/s² of gravity", self.in_turn(net))
            }
            Effect::Friction => {
                let mut numbers: Vec<f64> = self.floors.iter().map(|floor| floor.friction.coefficient()).collect();
                numbers.dedup();
                let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
                format!("friction, coefficient {}", numbers.join(", "))
            }
            Effect::AddedMass => {
                let share = self.in_turn(|ball| super::net(self, ball).1);
                format!("added mass, which leaves {share} of every acceleration")
            }
            Effect::Lift => self.lift(),
            Effect::SpinDecay => match effects.spin_decay {
                Some(Decay::Within(time)) => format!("spin decay, ω' = -ω/({} s)", short(time)),
                Some(Decay::InFlight(c)) => {
                    let rate = self.in_turn(|ball| ball.radius.map_or(0.0, |radius| c / radius));
                    format!("spin decay, ω' = -{rate} /m × |v| ω")
                }
                None => effect.name().to_owned(),
            },
            Effect::Deformation => effect.name().to_owned(),
        }
    }

    /// A number of the balls; where they differ, of each in turn.
    fn in_turn(&self, number: impl Fn(&Ball) -> f64) -> String {
        let numbers: Vec<String> = self.balls.iter().map(|ball| short(number(ball))).collect();
        if numbers.windows(2).all(|pair| pair[0] == pair[1]) {
            numbers.into_iter().next().unwrap_or_default()
        } else {
            format!("({})", numbers.join(", "))
        }
    }

    /// The lift by spin, with how much that is at the start.
    fn lift(&self) -> String {
        let Some([_, saturation]) = self.effects.lift else { return Effect::Lift.name().to_owned() };
        let law = match saturation {
            0.0 => String::new(),
            saturation => {
                let length = self.in_turn(|ball| saturation * ball.radius.unwrap_or(0.0));
                format!(" / (1 + {length} m × |ω × v|/v²)")
            }
        };
        let size = |ball: &Ball| {
            let start = Motion {
                t: 0.0,
                position: ball.lowest(),
                velocity: ball.velocity - self.effects.wind.unwrap_or_default(),
                spin: ball.spin.unwrap_or_default(),
            };
            self.effects.magnus(ball).map_or(0.0, |lift| lift.acceleration(&start).norm())
        };
        let slope = self.in_turn(|ball| self.effects.magnus(ball).map_or(0.0, |lift| lift.slope()));
        format!("lift by spin, a = {slope} × ω × v{law}, {} m/s² at the start", self.in_turn(size))
    }
}

/// The method by which a mode is advanced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Advance {
    /// The motion is a polynomial in time: no step.
    Exact,
    /// A formula gives the motion: no step.
    Formula,
    /// Taylor series, of an order by the tolerance.
    Series,
    /// Steps of this explicit method.
    Explicit(&'static str),
    /// Steps of this method for stiff flows.
    Stiff(&'static str),
}

impl Advance {
    /// Whether no step is taken.
    #[must_use]
    pub const fn is_solved(self) -> bool {
        matches!(self, Self::Exact | Self::Formula)
    }
}

impl fmt::Display for Advance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact => f.write_str("exact arc"),
            Self::Formula => f.write_str("closed form"),
            Self::Series => f.write_str("Taylor series"),
            Self::Explicit(name) => write!(f, "explicit stepper {name}"),
            Self::Stiff(name) => write!(f, "stiff stepper {name}"),
        }
    }
}

/// A mode of a plan and its method.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ModePlan {
    /// The mode.
    pub name: &'static str,
    /// The method by which the mode is advanced.
    pub advance: Advance,
    /// The reason of the choice.
    pub why: &'static str,
    /// The edges that are watched.
    pub edges: Vec<String>,
}

/// The explanation of a plan; written with `{}` it is a page for people.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Explanation {
    /// The model.
    pub model: Model,
    /// The effects the scene names, with their numbers.
    pub named: Vec<String>,
    /// The effects that the scene does not name, and that cost nothing.
    pub left_out: Vec<Effect>,
    /// The coordinates of the state, one entry for each.
    pub coordinates: Vec<String>,
    /// The method by which each mode is advanced.
    pub modes: Vec<ModePlan>,
    /// The relative tolerance of steps; `None` where no step is taken.
    pub tolerance: Option<f64>,
    /// The approximations of the model that matter in this scene.
    pub notes: Vec<String>,
}

impl Explanation {
    pub(super) fn of(scene: &Scene, model: Model, count: usize, modes: Vec<ModePlan>, tolerance: f64) -> Self {
        let (named, left_out): (Vec<Effect>, Vec<Effect>) =
            Effect::ALL.into_iter().partition(|&effect| scene.names(effect));
        let mut unique: Vec<ModePlan> = Vec::new();
        for mode in modes {
            if !unique.contains(&mode) {
                unique.push(mode);
            }
        }
        let steps = unique.iter().any(|mode| !mode.advance.is_solved());
        Self {
            model,
            named: named.into_iter().map(|effect| scene.with_numbers(effect)).collect(),
            left_out,
            coordinates: coordinates(scene, model, count),
            modes: unique,
            tolerance: steps.then_some(tolerance),
            notes: notes(scene, model),
        }
    }
}

/// The names of the coordinates of the state.
fn coordinates(scene: &Scene, model: Model, count: usize) -> Vec<String> {
    let axes: &[&str] = match scene.dimensions {
        1 => &["up"],
        2 => &["x", "up"],
        _ => &["x", "y", "up"],
    };
    let each = |what: &str, list: &[&str]| list.iter().map(|axis| format!("{what} {axis}")).collect::<Vec<_>>();
    let list = match model {
        Model::Ball | Model::Compliant => vec!["height above the floor".to_owned(), "velocity up".to_owned()],
        Model::Flyer => {
            let mut list = [each("position", axes), each("velocity", axes)].concat();
            match count - list.len() {
                0 => {}
                1 => list.push("spin".to_owned()),
                _ => list.extend(each("spin", &["x", "y", "up"])),
            }
            list
        }
        Model::Line => {
            let numbers = |what: &str| (1..=count / 2).map(|n| format!("{what} of ball {n}")).collect::<Vec<_>>();
            [numbers("gap below the place"), numbers("velocity")].concat()
        }
        Model::Cloud | Model::Flock => {
            let of = |what: &str| {
                (1..=scene.balls.len())
                    .flat_map(|n| {
                        each(what, &["x", "y", "up"]).into_iter().map(move |name| format!("{name} of ball {n}"))
                    })
                    .collect::<Vec<_>>()
            };
            let spin = if model == Model::Flock { of("spin") } else { Vec::new() };
            [of("position"), of("velocity"), spin].concat()
        }
    };
    debug_assert_eq!(list.len(), count);
    list
}

/// Approximations of the model that this scene meets.
fn notes(scene: &Scene, model: Model) -> Vec<String> {
    let mut notes = Vec::new();
    let stairs = scene.floors.iter().any(|floor| matches!(floor.shape, super::super::Shape::Stairs { .. }));
    if stairs && scene.balls.iter().any(|ball| ball.radius.is_some()) {
        notes.push("stairs are met by the lowest point of the ball, not by its sides".to_owned());
    }
    if model == Model::Flock {
        notes.push("a ball that comes to rest upon another ends the run: what lies beyond is not modelled".to_owned());
    }
    notes
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "model        {}", self.model)?;
        let none = || "nothing".to_owned();
        let named = if self.named.is_empty() { none() } else { self.named.join("\n             ") };
        writeln!(f, "effects in   {named}")?;
        let out: Vec<&str> = self.left_out.iter().map(|effect| effect.name()).collect();
        writeln!(f, "effects out  {}", if out.is_empty() { none() } else { out.join(", ") })?;
        let count = self.coordinates.len();
        if count <= 9 {
            writeln!(f, "coordinates  {count}: {}", self.coordinates.join(", "))?;
        } else {
            writeln!(f, "coordinates  {count}: {}, ...", self.coordinates[..4].join(", "))?;
        }
        for mode in &self.modes {
            writeln!(f, "mode         {}: {}; {}", mode.name, mode.advance, mode.why)?;
            let edges =
                if mode.edges.is_empty() { "no edge: it is never left".to_owned() } else { mode.edges.join("; ") };
            writeln!(f, "             watches {edges}")?;
        }
        if let Some(tolerance) = self.tolerance {
            writeln!(f, "tolerance    {tolerance:e} of each coordinate per step")?;
        }
        for note in &self.notes {
            writeln!(f, "note         {note}")?;
        }
        Ok(())
    }
}
