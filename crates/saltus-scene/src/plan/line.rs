//! Several balls on one line: stacked over a floor, or side by side without weight.

use nalgebra::Vector3;
use saltus::{Automaton, Coords, Edges, JumpOf};

use super::explain::Advance;
use super::listed::{Kin, Listed};
use super::record::{Moment, With};
use super::runner::{BoundModel, Runner};
use super::view::{Collision, SceneEvent, SceneView};
use super::{MOST_BALLS, PlanError, failed};
use crate::{Law, Scene};
use saltus_bounce::Line;
use saltus_bounce::line::{Contact, Lying, Row};

/// The gap that rounding may leave between touching balls, relative to the numbers involved.
const ROUNDING: f64 = 1e-12;

/// A gap and a velocity of each ball.
const COORDINATES: usize = 2 * MOST_BALLS;

/// Any number of balls on a line.
type Model = Listed<Lying, Contact, COORDINATES>;

impl<const N: usize> Kin<Lying, Contact> for Line<N, Law> {
    fn common(lying: Lying) -> Lying {
        lying
    }
    fn own(lying: Lying) -> Lying {
        lying
    }
    fn own_edge(contact: Contact) -> Contact {
        contact
    }
    fn edges(&self, lying: Lying) -> Edges<'_, Contact> {
        Automaton::edges(self, lying)
    }
}

/// The line that all balls stay on, if they do: upwards in a vertical scene; any other only without
/// weight and without anything to hit.
pub(super) fn direction(scene: &Scene) -> Option<Vector3<f64>> {
    if scene.dimensions == 1 {
        return Some(Vector3::z());
    }
    if scene.gravity.value() != 0.0 || !scene.floors.is_empty() || scene.balls.iter().any(|ball| ball.spin.is_some()) {
        return None;
    }
    let first = scene.balls[0].centre();
    let along = scene.balls.iter().map(|ball| ball.centre() - first).max_by(|a, b| a.norm().total_cmp(&b.norm()))?;
    let u = along / along.norm();
    let on_line = |v: Vector3<f64>, size: f64| (v - u * v.dot(&u)).norm() <= ROUNDING * size;
    let stays = scene
        .balls
        .iter()
        .all(|ball| on_line(ball.centre() - first, along.norm()) && on_line(ball.velocity, ball.velocity.norm()));
    stays.then_some(u)
}

/// Balls that stay on the line along `u`; `floor` is which one is below and how high it is.
pub(super) fn runner(
    scene: &Scene,
    u: Vector3<f64>,
    floor: Option<(usize, f64)>,
) -> Result<Box<dyn Runner>, PlanError> {
    match scene.balls.len() {
        2 => with::<2>(scene, u, floor),
        3 => with::<3>(scene, u, floor),
        4 => with::<4>(scene, u, floor),
        5 => with::<5>(scene, u, floor),
        n => Err(PlanError::new("[[ball]]", &format!("{n} balls are too many: a scene runs with up to {MOST_BALLS}"))),
    }
}

fn with<const N: usize>(
    scene: &Scene,
    u: Vector3<f64>,
    floor: Option<(usize, f64)>,
) -> Result<Box<dyn Runner>, PlanError> {
    let Some(between) = scene.collision else {
        return Err(PlanError::new("[collisions]", "no restitution is given between the balls"));
    };
    let balls = &scene.balls;
    let mut order: [usize; N] = std::array::from_fn(|i| i);
    order.sort_by(|&a, &b| balls[a].centre().dot(&u).total_cmp(&balls[b].centre().dot(&u)));
    let radius = |i: usize| balls[order[i]].radius.unwrap_or(0.0);
    let masses: [f64; N] = std::array::from_fn(|i| balls[order[i]].mass.unwrap_or(1.0));
    let base = floor.map_or(0.0, |(_, height)| height);
    let mut line =
        Line::new(masses, between).and_then(|line| line.with_gravity(scene.gravity.value())).map_err(failed)?;
    if let Some((owner, _)) = floor {
        line = line.on_floor();
        if let Some(law) = scene.law(order[0], owner) {
            line = line.contact(0, *law);
        }
    }
    let lowest = |i: usize| {
        if u == Vector3::z() { balls[order[i]].lowest().z } else { balls[order[i]].centre().dot(&u) - radius(i) }
    };
    let gaps: [f64; N] = std::array::from_fn(|i| {
        if i == 0 {
            return lowest(0) - base;
        }
        let room = 2.0 * radius(i - 1);
        let gap = (lowest(i) - lowest(i - 1)) - room;
        if gap.abs() <= ROUNDING * (lowest(i).abs() + room) { 0.0 } else { gap }
    });
    let velocities: [f64; N] = std::array::from_fn(|i| balls[order[i]].velocity.dot(&u));
    // The lowest point of the ball in place i, if all gaps are closed.
    let mut origins = vec![Moment::ZERO; N];
    let mut places = [0; N];
    let aside = balls[0].centre() - u * balls[0].centre().dot(&u);
    let mut stacked = base;
    for i in 0..N {
        let down = Vector3::z() * radius(i);
        let position = if u == Vector3::z() { aside + u * stacked } else { aside + u * (stacked + radius(i)) - down };
        origins[order[i]] = Moment { position, ..Moment::ZERO };
        places[order[i]] = i;
        stacked += 2.0 * radius(i);
    }
    let view =
        LineView { u, floor: floor.map(|(owner, _)| owner), order: order.into(), places: places.into(), origins };
    let (line, lying, start) = Model::of(line, Lying::NONE, Row { gaps, velocities })?;
    Ok(BoundModel::boxed(line, view, lying, start))
}

/// Reads balls on a line; `order` says which ball is in a place, `places` in which place a ball is.
struct LineView {
    u: Vector3<f64>,
    floor: Option<usize>,
    order: Vec<usize>,
    places: Vec<usize>,
    origins: Vec<Moment>,
}

impl SceneView<Model> for LineView {
    type Stepper = super::method::NoStepper;

    fn balls(&self) -> usize {
        self.order.len()
    }
    fn linear(&self, x: &Coords<COORDINATES>, ball: usize) -> Moment {
        let place = self.places[ball];
        let (gaps, velocities) = x.split_at(self.order.len());
        let along: f64 = gaps[..=place].iter().sum();
        Moment { position: self.u * along, velocity: self.u * velocities[place], spin: Vector3::zeros() }
    }
    fn origin(&self, ball: usize) -> Moment {
        self.origins[ball]
    }
    fn mode(&self, lying: Lying, ball: usize) -> &'static str {
        if self.places[ball] < lying.count() { "rest" } else { "flight" }
    }
    fn flies(&self, lying: Lying, ball: usize) -> bool {
        self.places[ball] >= lying.count()
    }
    fn rests(&self, lying: Lying, _: &Coords<COORDINATES>) -> bool {
        lying.count() == self.order.len()
    }
    fn scene_event(&self, _: &Model, _: &JumpOf<Model>, Contact(contact): Contact) -> SceneEvent {
        let Some(&ball) = self.order.get(contact) else { return SceneEvent::of("wall") };
        match contact.checked_sub(1) {
            None => {
                let collision = Collision { with: With::Floor(self.floor.unwrap_or(0)), normal: self.u, speed: 0.0 };
                SceneEvent { edge: "floor", balls: [Some(ball), None], collision: Some(collision) }
            }
            Some(below) => {
                let other = self.order[below];
                let collision = Collision { with: With::Ball(other), normal: self.u, speed: 0.0 };
                SceneEvent { edge: "ball", balls: [Some(ball), Some(other)], collision: Some(collision) }
            }
        }
    }
    fn modes(&self, _: &Model) -> Vec<Lying> {
        vec![Lying::NONE]
    }
    fn edge(&self, _: &Model, _: Lying, Contact(contact): Contact) -> String {
        match contact.checked_sub(1) {
            None => format!("ball {} meets the floor", self.order[0] + 1),
            Some(below) => format!(
                "ball {} meets ball {}",
                self.order[below] + 1,
                self.order[contact.min(self.order.len() - 1)] + 1
            ),
        }
    }
    fn why(&self, _: Lying, _: Advance) -> &'static str {
        "gravity pulls all alike: each gap is a polynomial of degree two at most"
    }
}
