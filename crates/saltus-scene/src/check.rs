//! What only the whole scene can tell: whether the balls have room, and whether the run has an end.

use std::ops::Range;

use nalgebra::Vector3;

use super::error::{Fault, short};
use super::{Ball, Contact, Floor, Scene, Shape};

/// How far rounding may let things overlap, relative to the numbers involved.
const ROUNDING: f64 = 1e-12;

pub(super) fn scene(scene: &Scene, place: impl Fn(usize) -> Range<usize>, ends: &Range<usize>) -> Result<(), Fault> {
    for (n, ball) in scene.balls.iter().enumerate() {
        for (m, floor) in scene.floors.iter().enumerate() {
            if let Some(says) = blocked(ball, floor) {
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

/// Why the ball cannot start where it does.
fn blocked(ball: &Ball, floor: &Floor) -> Option<String> {
    let (low, centre, r) = (ball.lowest(), ball.centre(), radius(ball));
    let offset = floor.motion.as_ref().map_or(0.0, |motion| motion.offset(0.0));
    // An exact height is compared exactly; a centre only up to the rounding of its radius.
    let slack = ROUNDING * if low == centre { 0.0 } else { centre.z.abs() + r };
    let below = |level: f64, what: &str| {
        (low.z < level - slack).then(|| {
            format!(
                "the ball starts below the {what}, at a height of {} m: the {what} is at {} m there, start at or above it",
                short(low.z),
                short(level)
            )
        })
    };
    match floor.shape {
        Shape::Level { height } => below(height + offset, "floor"),
        Shape::Stairs { top, from, tread, rise, count } => {
            below(top - rise * down(centre.x, from, tread, count), "step")
        }
        Shape::Parabola { curvature, centre: middle, height } => {
            below(height + 0.5 * curvature * (centre.x - middle).powi(2), "curve")
        }
        Shape::Sine { amplitude, wavelength, phase, height } => {
            below(height + amplitude * (std::f64::consts::TAU * centre.x / wavelength + phase).sin(), "curve")
        }
        Shape::Incline { angle, height } => {
            let gap = (centre.z - height) * angle.cos() - centre.x * angle.sin();
            let room = r - ROUNDING * (r + centre.norm());
            (gap < room).then(|| {
                format!("the ball starts inside the incline: its centre is {} m from it, move it to {r} m (its radius) or more", short(gap))
            })
        }
        Shape::Wall { across_y, at, .. } => {
            let gap = (if across_y { centre.y } else { centre.x } - at).abs();
            (gap < r * (1.0 - ROUNDING)).then(|| {
                format!("the ball starts inside the wall: its centre is {} m from it, move it to {r} m (its radius) or more", short(gap))
            })
        }
        Shape::Box { size, height, open } => {
            let from_bottom = centre - Vector3::new(0.0, 0.0, height);
            let room = |half: f64, at: f64| half - at.abs() >= r * (1.0 - ROUNDING);
            let lid = open || size.z - from_bottom.z >= r * (1.0 - ROUNDING);
            let sides = room(0.5 * size.x, centre.x) && (size.y == 0.0 || room(0.5 * size.y, centre.y));
            (!sides || !lid || from_bottom.z < r * (1.0 - ROUNDING)).then(|| {
                format!(
                    "the ball does not start inside the box, which reaches from x = {} m to {} m and from {height} m to {} m up: move it, its radius counted",
                    -0.5 * size.x,
                    0.5 * size.x,
                    height + size.z
                )
            })
        }
    }
}

/// How many steps down the stairs are at x.
fn down(x: f64, from: f64, tread: f64, count: Option<u32>) -> f64 {
    let steps = if x < from { 0.0 } else { ((x - from) / tread).floor() + 1.0 };
    count.map_or(steps, |count| steps.min(f64::from(count)))
}

/// Why the scene may go on for ever.
fn endless(scene: &Scene) -> Option<&'static str> {
    let (balls, floors) = (&scene.balls, &scene.floors);
    let drag = scene.effects.linear.is_some() || scene.effects.quadratic.is_some();
    let elastic = |m: usize| scene.law(0, m).and_then(super::Law::constant).is_some_and(|cor| cor.value() == 1.0);
    if floors.is_empty() {
        Some("there is no floor")
    } else if scene.gravity.value() == 0.0 {
        Some("there is no gravity to bring the ball down")
    } else if balls.len() > 1 {
        Some("there are several balls")
    } else if floors.iter().any(|floor| floor.motion.is_some()) {
        Some("the floor moves")
    } else if scene.dimensions > 1 {
        Some("a ball that moves sideways may slide or roll on")
    } else if scene.contact != Contact::Rigid {
        Some("a contact that takes time dies out ever more slowly")
    } else if !drag && (0..floors.len()).any(elastic) {
        Some("the ball loses nothing")
    } else {
        None
    }
}
