//! Checks of the whole scene: whether the balls have room, and whether the run has an end.

use std::ops::Range;

use super::ball::Ball;
use super::contact::Contact;
use super::error::{Fault, short};
use super::scene::Scene;
use super::{Floor, Shape};

/// The overlap that rounding may make, relative to the numbers involved.
const ROUNDING: f64 = 1e-12;

pub(super) fn scene(scene: &Scene, place: impl Fn(usize) -> Range<usize>, ends: &Range<usize>) -> Result<(), Fault> {
    for (n, ball) in scene.balls.iter().enumerate() {
        for (m, floor) in scene.floors.iter().enumerate() {
            if let Some(says) = floor.blocked(ball) {
                let which = if scene.floors.len() > 1 { format!(" (floor {})", m + 1) } else { String::new() };
                let (wrong, right) = says.split_once(": ").unwrap_or((&says, "move it"));
                return Err(Fault::new(place(n), format!("{wrong}{which}: {right}")));
            }
        }
        for (m, other) in scene.balls[..n].iter().enumerate() {
            let (apart, room) = ((ball.centre() - other.centre()).norm(), radius(ball) + radius(other));
            if apart < room * (1.0 - ROUNDING) || apart == 0.0 {
                let says = format!(
                    "ball {} starts inside ball {}: their centres are {} m apart, move them to {} m or more",
                    n + 1,
                    m + 1,
                    short(apart),
                    short(room)
                );
                return Err(Fault::new(place(n), says));
            }
        }
    }
    if scene.run.until.is_none()
        && scene.run.most_jumps.is_none()
        && let Some(why) = endless(scene)
    {
        let says = format!("nothing ends this run, {why}: say when to stop, with `until = \"5 s\"` under [run]");
        return Err(Fault::new(ends.clone(), says));
    }
    Ok(())
}

fn radius(ball: &Ball) -> f64 {
    ball.radius.unwrap_or(0.0)
}

/// The reason why the scene may go on for ever.
fn endless(scene: &Scene) -> Option<&'static str> {
    let (balls, floors) = (&scene.balls, &scene.floors);
    let holds = |floor: &Floor| !matches!(floor.shape, Shape::Wall { .. });
    let swings = |floor: &Floor| matches!(floor.shape, Shape::Parabola { .. } | Shape::Sine { .. });
    let walls = floors.iter().map(|floor| match floor.shape {
        Shape::Wall { .. } => 1,
        Shape::Box { .. } => 2,
        _ => 0,
    });
    let deep = |floor: &Floor| matches!(floor.shape, Shape::Stairs { count: None, .. });
    let floats =
        |ball: &Ball| scene.effects.buoyancy(ball, scene.gravity).is_some_and(|lift| lift.net_gravity() <= 0.0);
    let drag = scene.effects.linear.is_some() || scene.effects.quadratic.is_some();
    let elastic = |m: usize| {
        let mut laws = (0..balls.len()).filter_map(|n| scene.law(n, m)?.constant());
        laws.any(|cor| cor.value() == 1.0)
    };
    let lasting = |floor: &Floor| floor.motion.as_ref().is_some_and(|motion| motion.ends().is_none());
    if !floors.iter().any(holds) {
        Some("there is no floor")
    } else if scene.gravity.value() == 0.0 {
        Some("there is no gravity to bring the ball down")
    } else if balls.iter().any(floats) {
        Some("the ball is not heavier than the air")
    } else if balls.len() > 1 && scene.dimensions > 1 {
        Some("there are several balls")
    } else if floors.iter().any(lasting) {
        Some("the floor moves for ever")
    } else if scene.dimensions > 1 && floors.iter().any(swings) {
        Some("a ball may swing on a curve for ever")
    } else if scene.dimensions > 1 && walls.sum::<usize>() > 1 {
        Some("a ball may go to and fro between walls for ever")
    } else if scene.dimensions > 1 && floors.iter().any(deep) {
        Some("the stairs have no end")
    } else if scene.contact != Contact::Rigid {
        Some("a contact that takes time dies out ever more slowly")
    } else if !drag && (0..floors.len()).any(elastic) {
        Some("the ball loses nothing")
    } else {
        None
    }
}
