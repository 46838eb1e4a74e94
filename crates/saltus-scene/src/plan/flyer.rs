//! One ball in one to three coordinates, among whatever floors and walls a scene has.

use nalgebra::{SVector, Vector3};
use saltus::{Automaton, Clocks, Coords, Edges, JumpOf, Series, State};

use super::explain::Advance;
use super::listed::{Kin, Listed};
use super::record::{Moment, With};
use super::runner::{BoundModel, Runner};
use super::surroundings::{Around, Surroundings, spread, surroundings};
use super::view::{Collision, SceneEvent, SceneView};
use super::{PlanError, failed, label};
use crate::{Ball, Law, Scene, Stepper};
use saltus_bounce::effects::{
    AddedMass, Buoyancy, Effect, Gravity, LinearDrag, Magnus, QuadraticDrag, SpinDecay, Wind,
};
use saltus_bounce::friction::{Friction, Rebound};
use saltus_bounce::restitution::Restitution;
use saltus_bounce::walls::{Face, Walls};
use saltus_bounce::{Event, Flyer, Grip, Moving, Rolls, Sphere, Stance, Turning};

/// The depth in a wall at which a ball may start for the rounding of its place, for each metre from
/// the origin.
const ROUNDING: f64 = 1e-12;

/// Whether the scene's ball needs a spin.
pub(super) fn spins(scene: &Scene) -> bool {
    let rubs = scene.floors.iter().any(|floor| floor.friction.coefficient() > 0.0);
    scene.dimensions > 1 && (scene.balls[0].spin.is_some() || rubs)
}

/// Whether the only forces are those of gravity and buoyancy.
pub(super) fn uniform(scene: &Scene) -> bool {
    let effects = &scene.effects;
    effects.linear.is_none() && effects.quadratic.is_none() && effects.lift.is_none() && effects.spin_decay.is_none()
}

pub(super) fn runner(scene: &Scene) -> Result<Box<dyn Runner>, PlanError> {
    let ball = &scene.balls[0];
    let spin = ball.spin.unwrap_or_default();
    // One model for each kind of state: the effects that the scene names are chosen at run time,
    // and where there is none but gravity, flights are exact.
    match (scene.dimensions, spins(scene)) {
        (1, _) => smooth::<1, _>(scene, rigid(scene, ball, air(scene)?)?),
        (2, false) => smooth::<2, _>(scene, rigid(scene, ball, air(scene)?)?),
        (2, true) => rough::<2, f64, _>(scene, rigid(scene, ball, spinning_air(scene, ball)?)?, 0.0 - spin.y),
        (_, false) => smooth::<3, _>(scene, rigid(scene, ball, air(scene)?)?),
        (_, true) => rough::<3, Vector3<f64>, _>(scene, rigid(scene, ball, spinning_air(scene, ball)?)?, spin),
    }
}

/// The effects on a ball that drags air along, or on one that does not: half of no air.
pub(super) fn rigid<E>(scene: &Scene, ball: &Ball, effects: E) -> Result<AddedMass<E>, PlanError> {
    let sphere = ball.sphere();
    let unit = Sphere::solid(1.0, 1.0).map_err(failed)?;
    let density = if scene.effects.added_mass && sphere.is_some() { scene.effects.density } else { 0.0 };
    AddedMass::new(&sphere.unwrap_or(unit), density, effects).map_err(failed)
}

fn steady(scene: &Scene, ball: &Ball) -> (Gravity, Option<Buoyancy>) {
    (scene.gravity, scene.effects.buoyancy(ball, scene.gravity))
}

/// The scene's wind in N coordinates.
fn wind<const N: usize, E>(scene: &Scene, effects: E) -> Result<Wind<N, E>, PlanError> {
    Wind::new(position(&scene.effects.wind.unwrap_or_default()), effects).map_err(failed)
}

pub(super) type InWind<const N: usize, E> = (Gravity, Option<Buoyancy>, Wind<N, E>);

type Drags = (Option<LinearDrag>, Option<QuadraticDrag>);

fn air<const N: usize>(scene: &Scene) -> Result<InWind<N, Drags>, PlanError> {
    let (ball, effects) = (&scene.balls[0], &scene.effects);
    let (gravity, buoyancy) = steady(scene, ball);
    Ok((gravity, buoyancy, wind(scene, (effects.linear_drag(ball), effects.quadratic_drag(ball)))?))
}

/// The effects on a ball that spins.
pub(super) type SpinEffects = (Option<LinearDrag>, Option<QuadraticDrag>, Option<Magnus>, Option<SpinDecay>);

pub(super) fn spinning_air<const N: usize>(scene: &Scene, ball: &Ball) -> Result<InWind<N, SpinEffects>, PlanError> {
    let effects = &scene.effects;
    let (gravity, buoyancy) = steady(scene, ball);
    let drag = (effects.linear_drag(ball), effects.quadratic_drag(ball));
    Ok((gravity, buoyancy, wind(scene, (drag.0, drag.1, effects.magnus(ball), effects.spin_decay(ball)))?))
}

/// (x, y, up) as N coordinates.
fn position<const N: usize>(v: &Vector3<f64>) -> SVector<f64, N> {
    SVector::from_fn(|i, _| if i + 1 == N { v.z } else { v[i] })
}

fn smooth<const N: usize, E>(scene: &Scene, effects: E) -> Result<Box<dyn Runner>, PlanError>
where
    E: Effect<N> + Send + Sync + 'static,
{
    let (walls, laws, _) = faces::<N>(scene, 0)?;
    let start = start::<N>(&scene.balls[0]);
    let stance = Stance::Flight { cell: clear(&walls, &start.position)? };
    let view = FloorsView::new(scene, false);
    let flyer = Flyer::new(effects, walls, laws).map_err(crowded)?;
    bound(scene, flyer, view, stance, start)
}

fn rough<const N: usize, S, E>(scene: &Scene, effects: E, spin: S) -> Result<Box<dyn Runner>, PlanError>
where
    S: Turning + Send + Sync + 'static,
    E: Effect<N, S> + Send + Sync + 'static,
    Rolls: Grip<N, S>,
{
    let (walls, laws, grips) = gripped::<N>(scene, 0)?;
    let start = start::<N>(&scene.balls[0]).spinning(spin);
    let stance = Stance::Flight { cell: clear(&walls, &start.position)? };
    let view = FloorsView::new(scene, grips.each.iter().any(|rolls| rolls.friction.coefficient() > 0.0));
    let flyer = Flyer::gripped(effects, walls, laws, grips).map_err(crowded)?;
    bound(scene, flyer, view, stance, start)
}

/// A ball with its start, by Taylor series where the scene asks for them.
fn bound<const N: usize, S, E, G>(
    scene: &Scene,
    flyer: SceneFlyer<N, S, E, G>,
    floors: FloorsView,
    stance: Stance<N>,
    start: Moving<N, S>,
) -> Result<Box<dyn Runner>, PlanError>
where
    S: Turning + Send + Sync + 'static,
    E: Effect<N, S> + Send + Sync + 'static,
    G: Grip<N, S> + Send + Sync + 'static,
{
    let flyer = if scene.run.stepper == Some(Stepper::Series) { flyer.by_series() } else { flyer };
    let walls = Box::new(flyer.walls().clone());
    let (flyer, stance, start) = Model::of(flyer, stance, start)?;
    Ok(BoundModel::boxed(flyer, FlyerView { floors, walls }, stance, start))
}

/// The walls of a ball, with law and grip of each face. Friction turns a ball by its shape and
/// radius, whatever its mass.
pub(super) fn gripped<const N: usize>(scene: &Scene, ball: usize) -> Result<(Surroundings<N>, Laws, Grips), PlanError> {
    let (walls, laws, frictions) = faces::<N>(scene, ball)?;
    let ball = &scene.balls[ball];
    let radius = ball.radius.unwrap_or(1.0);
    let sphere = Sphere::with_inertia(radius, ball.mass.unwrap_or(1.0), ball.inertia).map_err(failed)?;
    let grips = Grips {
        any: Rolls { ball: sphere, friction: Friction::NONE },
        each: frictions.into_iter().map(|friction| Rolls { ball: sphere, friction }).collect(),
    };
    Ok((walls, laws, grips))
}

pub(super) fn start<const N: usize>(ball: &Ball) -> Moving<N> {
    Moving::new(position(&ball.lowest()), position(&ball.velocity))
}

#[allow(clippy::needless_pass_by_value)] // used as a function
pub(super) fn crowded(error: saltus_bounce::ParameterError) -> PlanError {
    PlanError::new("[[floor]]", &format!("the scene has too many walls, {error}"))
}

/// The walls of a ball, and the law and the friction of each face.
fn faces<const N: usize>(scene: &Scene, ball: usize) -> Result<(Surroundings<N>, Laws, Vec<Friction>), PlanError> {
    let walls = surroundings::<N>(scene, &scene.balls[ball])?;
    let owners = walls.owners();
    let each: Vec<Law> = owners.iter().filter_map(|&owner| scene.law(ball, owner).copied()).collect();
    let frictions = owners.iter().map(|&owner| scene.floors[owner].friction).collect();
    Ok((walls, Laws { each }, frictions))
}

/// The cell in which a ball starts at `p`, if it is clear of all walls: a curve may be met by the
/// side of a ball whose lowest point is above it.
pub(super) fn clear<const N: usize>(walls: &Surroundings<N>, p: &SVector<f64, N>) -> Result<usize, PlanError> {
    let cell = walls.cell(p);
    for face in walls.all(cell) {
        let inside = -walls.margin(face, 0.0, p);
        if inside > ROUNDING * (1.0 + p.norm()) {
            let says = format!("the ball starts inside it, {inside:.3e} m deep: start it higher or farther away");
            return Err(PlanError::floor(walls.owner(face), &says));
        }
    }
    Ok(cell)
}

/// The law of each face of a cell.
#[derive(Clone, Debug)]
pub(super) struct Laws {
    each: Vec<Law>,
}

impl Restitution for Laws {
    fn rebound(&self, impact: f64) -> f64 {
        self.each.first().map_or(0.0, |law| law.rebound(impact))
    }
    fn on(&self, face: Face) -> impl Restitution {
        FaceLaw(self.each.get(face.index))
    }
}

/// The law of one face, if there is such a face.
struct FaceLaw<'a>(Option<&'a Law>);

impl Restitution for FaceLaw<'_> {
    fn rebound(&self, impact: f64) -> f64 {
        self.0.map_or(0.0, |law| law.rebound(impact))
    }
}

/// The friction of each face of a cell.
#[derive(Clone, Debug)]
pub(super) struct Grips {
    /// Without friction.
    any: Rolls,
    each: Vec<Rolls>,
}

impl<const N: usize, S: Turning> Grip<N, S> for Grips
where
    Rolls: Grip<N, S>,
{
    fn impact<R: Restitution>(
        &self,
        restitution: &R,
        velocity: SVector<f64, N>,
        spin: S,
        normal: &SVector<f64, N>,
    ) -> Rebound<SVector<f64, N>, S> {
        self.any.impact(restitution, velocity, spin, normal)
    }
    fn on(&self, face: Face) -> impl Grip<N, S> {
        self.each.get(face.index).unwrap_or(&self.any)
    }
    fn slip(&self, velocity: SVector<f64, N>, spin: S, normal: &SVector<f64, N>) -> SVector<f64, N> {
        self.any.slip(velocity, spin, normal)
    }
    fn share(&self) -> f64 {
        self.any.share()
    }
    fn torque(&self, friction: &SVector<f64, N>, normal: &SVector<f64, N>) -> S {
        self.any.torque(friction, normal)
    }
}

/// The name of a stance. What only moves up and down has no way to slide: on a floor it rests.
pub(super) const fn named(stance: Stance<3>, coordinates: usize) -> &'static str {
    match stance {
        Stance::Flight { .. } => "flight",
        Stance::Slide { .. } if coordinates == 1 => "rest",
        Stance::Slide { .. } | Stance::Yield { .. } => "slide",
        Stance::Hold { .. } => "hold",
        Stance::Corner { .. } => "corner",
    }
}

/// Reads a ball among the floors of a scene.
pub(super) struct FloorsView {
    kinds: Vec<&'static str>,
    labels: Vec<String>,
    moves: Vec<bool>,
    rubs: bool,
}

impl FloorsView {
    pub(super) fn new(scene: &Scene, rubs: bool) -> Self {
        Self {
            kinds: scene.floors.iter().map(|floor| floor.shape.word()).collect(),
            labels: (0..scene.floors.len()).map(|n| label(scene, n)).collect(),
            moves: scene.floors.iter().map(|floor| floor.motion.is_some()).collect(),
            rubs,
        }
    }
}

impl FloorsView {
    /// The event of the scene that an event of `ball` is, taken at `p` at time `t`.
    pub(super) fn event_of(&self, walls: &dyn Around, ball: usize, t: f64, p: &[f64], event: Event<3>) -> SceneEvent {
        let one = |edge| SceneEvent { balls: [Some(ball), None], ..SceneEvent::of(edge) };
        match event {
            Event::Meet(face) => {
                let Some((normal, speed)) = walls.met(face, t, p) else { return one("passage") };
                let owner = walls.owner(face);
                let collision = Collision { with: With::Floor(owner), normal, speed };
                SceneEvent { collision: Some(collision), ..one(self.kinds.get(owner).copied().unwrap_or("floor")) }
            }
            Event::Leave(_) => one("lift-off"),
            Event::Stop { .. } => one("stop"),
            Event::Slip(_) => one("slip"),
            Event::Veer { .. } => one("veer"),
            Event::Change => one("schedule"),
            Event::Turn => one("apex"),
        }
    }

    /// The name of an edge of a ball in a list.
    pub(super) fn listed(&self, walls: &dyn Around, event: Event<3>) -> String {
        match event {
            Event::Meet(face) => self.labels.get(walls.owner(face)).cloned().unwrap_or_default(),
            Event::Leave(_) => "lift-off: the floor no longer presses".to_owned(),
            Event::Stop { .. } => "stop: the slip has come to an end".to_owned(),
            Event::Slip(_) => "slip: friction no longer holds".to_owned(),
            Event::Veer { .. } => "veer: the slip has a direction of its own".to_owned(),
            Event::Change => "schedule".to_owned(),
            Event::Turn => "apex: the velocity through the air falls through zero".to_owned(),
        }
    }

    /// The reason why a ball is advanced as it is.
    pub(super) const fn because(stance: Stance<3>, advance: Advance) -> &'static str {
        match (stance, advance) {
            (Stance::Flight { .. }, Advance::Exact) => "forces are the same everywhere and always: a parabola",
            (Stance::Flight { .. }, Advance::Series) => {
                "the air's force depends on the velocity, and the scene asks for its Taylor series"
            }
            (Stance::Flight { .. }, _) => "the air's force depends on the velocity, and no formula solves that",
            (_, Advance::Exact) => "forces along a plane are constant: a parabola",
            (_, Advance::Formula) => "the ball rides on a floor whose motion is known",
            _ => "the force depends on where the ball is or how it moves",
        }
    }

    /// Whether friction acts anywhere, and whether a floor moves.
    pub(super) fn acts(&self) -> (bool, bool) {
        (self.rubs, self.moves.contains(&true))
    }
}

type SceneFlyer<const N: usize, S, E, G> = Flyer<N, S, E, Surroundings<N>, Laws, G>;

/// Place, velocity and spin in space.
const COORDINATES: usize = 9;

/// A ball in any number of coordinates, with or without spin. Directions have zeros in those that
/// it has not.
type Model = Listed<Stance<3>, Event<3>, COORDINATES>;

/// The first N entries of a list that goes on with zeros.
#[inline(always)]
fn cut<const N: usize, const K: usize>(v: &SVector<f64, K>) -> SVector<f64, N> {
    let mut of = [0.0; N];
    of.iter_mut().zip(v.as_slice()).for_each(|(to, from)| *to = *from);
    of.into()
}

#[inline(always)]
fn stance<const N: usize, const K: usize>(stance: Stance<K>) -> Stance<N> {
    match stance {
        Stance::Flight { cell } => Stance::Flight { cell },
        Stance::Slide { face, along } => Stance::Slide { face, along: cut(&along) },
        Stance::Yield { face, push, since } => Stance::Yield { face, push: cut(&push), since },
        Stance::Hold { face } => Stance::Hold { face },
        Stance::Corner { cell, faces } => Stance::Corner { cell, faces },
    }
}

#[inline(always)]
fn event<const N: usize, const K: usize>(event: Event<K>) -> Event<N> {
    match event {
        Event::Meet(face) => Event::Meet(face),
        Event::Leave(face) => Event::Leave(face),
        Event::Stop { face, along } => Event::Stop { face, along: cut(&along) },
        Event::Slip(face) => Event::Slip(face),
        Event::Veer { face, push, since } => Event::Veer { face, push: cut(&push), since },
        Event::Change => Event::Change,
        Event::Turn => Event::Turn,
    }
}

impl<const N: usize, S, E, G> Kin<Stance<3>, Event<3>> for SceneFlyer<N, S, E, G>
where
    S: Turning,
    E: Effect<N, S>,
    G: Grip<N, S>,
{
    fn common(of: Stance<N>) -> Stance<3> {
        stance(of)
    }
    fn own(of: Stance<3>) -> Stance<N> {
        stance(of)
    }
    fn own_edge(of: Event<3>) -> Event<N> {
        event(of)
    }
    fn edges(&self, of: Stance<3>) -> Edges<'_, Event<3>> {
        self.events(of)
    }
    fn clocks(&self, of: Stance<3>) -> Clocks<'_, Event<3>> {
        if Automaton::clocks(self, stance(of)).is_empty() { Clocks::none() } else { Clocks::asked(self, Event::Change) }
    }
    fn expand<X: State>(&self, of: Stance<3>, series: &mut Series<'_, X>) {
        self.expand(stance(of), series);
    }
}

struct FlyerView {
    floors: FloorsView,
    walls: Box<dyn Around>,
}

impl SceneView<Model> for FlyerView {
    type Stepper = saltus::Auto;

    fn linear(&self, x: &Coords<COORDINATES>, _: usize) -> Moment {
        let (position, rest) = x.split_at(self.walls.coordinates());
        let (velocity, spin) = rest.split_at(self.walls.coordinates());
        let spin = match *spin {
            // In the plane, by the right-hand rule.
            [spin] => Vector3::new(0.0, 0.0 - spin, 0.0),
            [x, y, z] => Vector3::new(x, y, z),
            _ => Vector3::zeros(),
        };
        Moment { position: spread(position), velocity: spread(velocity), spin }
    }
    fn mode(&self, stance: Stance<3>, _: usize) -> &'static str {
        named(stance, self.walls.coordinates())
    }
    fn flies(&self, stance: Stance<3>, _: usize) -> bool {
        matches!(stance, Stance::Flight { .. })
    }
    fn rests(&self, stance: Stance<3>, x: &Coords<COORDINATES>) -> bool {
        let Moment { velocity, spin, .. } = self.linear(x, 0);
        let still = velocity.norm() == 0.0 && spin.norm() == 0.0;
        still && !matches!(stance, Stance::Flight { .. }) && !self.floors.acts().1
    }
    fn scene_event(&self, _: &Model, jump: &JumpOf<Model>, event: Event<3>) -> SceneEvent {
        self.floors.event_of(&*self.walls, 0, jump.t(), &jump.before, event)
    }
    fn modes(&self, _: &Model) -> Vec<Stance<3>> {
        let mut modes = vec![Stance::FLIGHT];
        let (rubs, _) = self.floors.acts();
        let mut slip = SVector::zeros();
        slip[0] = if rubs { 1.0 } else { 0.0 };
        for face in self.walls.first() {
            // Risers and passages are not lain on.
            modes.push(Stance::Slide { face, along: slip });
            if rubs {
                modes.push(Stance::Hold { face });
            }
        }
        modes
    }
    fn edge(&self, _: &Model, _: Stance<3>, event: Event<3>) -> String {
        self.floors.listed(&*self.walls, event)
    }
    fn why(&self, stance: Stance<3>, advance: Advance) -> &'static str {
        FloorsView::because(stance, advance)
    }
}
