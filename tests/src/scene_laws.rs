//! The laws a random scene has to keep: it is refused with a reason or runs to a named end; nothing
//! sinks through a floor or into another ball; energy is not gained.

use saltus::nalgebra::Vector3;
use saltus_scene::Scene;
use saltus_scene::plan::{End, Moment, Record};

use crate::random_scene::Made;

/// How a scene ended after at most so many evaluations of flows and guards, for the summary; or the
/// law it breaks.
///
/// # Errors
/// The law in words, with the numbers that break it.
pub fn lived(made: &Made, most_evaluations: u64) -> Result<String, String> {
    let scene = match Scene::parse("soak.toml", made.toml.as_bytes()) {
        Ok(scene) => scene,
        Err(error) => return Ok(format!("refused: {}", kind(error.message()))),
    };
    let plan = match scene.plan() {
        Ok(plan) => plan.most_evaluations(most_evaluations),
        Err(error) => return Ok(format!("refused: {}", kind(&error.to_string()))),
    };
    let record = plan.run().map_err(|error| format!("failed: {error}"))?;
    sound(made, &record)?;
    let doubts = if record.doubts().is_empty() { "" } else { ", in doubt" };
    Ok(format!("{}: {}{doubts}", plan.explain().model, ending(record.end())))
}

/// The first line of a message, without its place and numbers.
fn kind(message: &str) -> String {
    let line = message.lines().next().unwrap_or_default();
    let says = line.rsplit_once(": ").map_or(line, |(_, says)| says);
    says.chars().map(|c| if c.is_ascii_digit() { '#' } else { c }).collect()
}

const fn ending(end: End) -> &'static str {
    match end {
        End::Time => "to its end",
        End::Jumps { .. } => "most jumps",
        End::Zeno { .. } => "at rest among others",
        _ => "given up",
    }
}

/// Whether the run keeps to what has to hold.
fn sound(made: &Made, record: &Record) -> Result<(), String> {
    let until = record.until();
    let slack = 1e-9 + 1e3 * made.tolerance;
    let mut last = 0.0;
    for event in record.events() {
        if !(last..=until).contains(&event.t) {
            return Err(format!("an event at {} after one at {last}, in a run until {until}", event.t));
        }
        last = event.t;
        if made.loses {
            let energy = |of: &dyn Fn(&saltus_scene::plan::Sides) -> Moment| -> f64 {
                event.sides.iter().map(|side| made.masses[side.ball] * kinetic(made, side.ball, &of(side))).sum()
            };
            let (before, after) = (energy(&|side| side.before), energy(&|side| side.after));
            if after > before * (1.0 + 1e-9) + 1e-12 {
                return Err(format!("energy rises from {before} to {after} at {} ({})", event.t, event.edge));
            }
        }
    }
    for impact in record.impacts() {
        if !(0.0..=until).contains(&impact.t) || impact.approach < 0.0 {
            return Err(format!("an impact at {} in a run until {until}", impact.t));
        }
    }
    let mut most = vec![f64::INFINITY; record.balls()];
    for t in record.events().iter().map(|event| event.t).filter(|_| record.balls() > 1) {
        apart(record, t, slack)?;
    }
    for step in 0..=64 {
        let t = until * f64::from(step) / 64.0;
        apart(record, t, slack)?;
        let mut total = 0.0;
        for ball in 0..record.balls() {
            let Some(moment) = record.at(ball, t) else {
                return Err(format!("nothing is known of ball {ball} at {t}"));
            };
            if !(moment.position.iter().chain(moment.velocity.iter()).all(|x| x.is_finite())) {
                return Err(format!("ball {ball} is nowhere at {t}"));
            }
            if made.floor.is_some_and(|floor| moment.height() < floor - slack * (1.0 + moment.velocity.norm())) {
                return Err(format!("ball {ball} is at {} at {t}, below the floor", moment.height()));
            }
            total += made.masses[ball] * (kinetic(made, ball, &moment) + made.gravity * moment.height());
        }
        if made.loses {
            let size = made.masses.iter().sum::<f64>() * (1.0 + made.gravity);
            if total > most[0] + slack * (size + most[0].abs()) {
                return Err(format!("energy rises from {} to {total} at {t}", most[0]));
            }
            most[0] = most[0].min(total);
        }
    }
    Ok(())
}

/// Whether no two balls overlap at `t` by more than rounding and steps may leave, which is more the
/// faster they are and the farther away.
fn apart(record: &Record, t: f64, slack: f64) -> Result<(), String> {
    for ball in 1..record.balls() {
        for other in 0..ball {
            let [(a, r, v), (b, q, w)] = [ball, other].map(|ball| {
                let radius = record.scene().balls[ball].radius.unwrap_or_default();
                let moment = record.at(ball, t).unwrap_or(Moment::ZERO);
                (moment.position + Vector3::z() * radius, radius, moment.velocity)
            });
            let deep = r + q - (a - b).norm();
            if deep > slack * (1.0 + v.norm() + w.norm() + a.norm().max(b.norm())) {
                return Err(format!("balls {other} and {ball} overlap by {deep} at {t}"));
            }
        }
    }
    Ok(())
}

/// Kinetic energy for each kilogram.
fn kinetic(made: &Made, ball: usize, moment: &Moment) -> f64 {
    0.5 * (moment.velocity.norm_squared() + made.inertia[ball] * moment.spin.norm_squared())
}
