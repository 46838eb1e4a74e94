//! Velocity, energy, phase portrait, apex ladder, force over deformation.

use crate::polynomial::value;
use crate::{Chart, Measure, PlotError, Stroke};
use saltus_bounce::effects::Buoyancy;
use saltus_scene::Contact;
use saltus_scene::plan::{Moment, Record, Segment};

use super::height::ground;
use super::title;

/// One coordinate of a segment's motion, by powers of the time since its start.
fn part(segment: &Segment, of: impl Fn(&Moment) -> f64) -> Vec<f64> {
    segment.coefficients.iter().map(of).collect()
}

/// A quantity over time through a segment.
fn over_time(segment: &Segment, y: Vec<f64>) -> Stroke {
    Stroke::new(segment.span, vec![segment.start, 1.0], y)
}

/// The two sides of each jump of a ball, as points.
fn jumps(record: &Record, ball: usize, point: impl Fn(f64, &Moment) -> [f64; 2]) -> Vec<[[f64; 2]; 2]> {
    let events = record.events();
    let sides = events.iter().flat_map(|event| event.sides.iter().map(move |sides| (event.t, sides)));
    let own = sides.filter(|(_, sides)| sides.ball == ball);
    own.map(|(t, sides)| [point(t, &sides.before), point(t, &sides.after)]).collect()
}

/// Whether no ball moves up or down.
fn level(record: &Record) -> bool {
    let rises = |segment: &Segment| segment.coefficients.iter().any(|moment| moment.velocity.z != 0.0);
    let still = |segment: &Segment| segment.span == 0.0 || !rises(segment);
    (0..record.balls()).all(|ball| record.segments(ball).iter().all(still))
}

pub(super) fn velocity(record: &Record) -> Chart {
    let scene = record.scene();
    // Of several balls one velocity is drawn: upwards, unless none of them moves that way.
    let sideways = record.balls() > 1 && level(record);
    let what = if sideways { "Velocity along x" } else { "Velocity" };
    let mut chart = Chart::new(&title(scene), ("Time", Measure::Time), (what, Measure::Speed));
    let axes: &[(&str, usize)] = match (scene.dimensions, record.balls()) {
        (_, 2..) if sideways => &[("along x", 0)],
        (1, _) | (_, 2..) => &[("up", 2)],
        (2, _) => &[("up", 2), ("along x", 0)],
        _ => &[("up", 2), ("along x", 0), ("along y", 1)],
    };
    for ball in 0..record.balls() {
        let segments = record.segments(ball);
        for &(axis, k) in axes {
            let label = match (record.balls(), axes.len()) {
                (1, 1) => String::new(),
                (1, _) => axis.to_owned(),
                _ => scene.ball_name(ball),
            };
            let strokes = segments.iter().map(|segment| over_time(segment, part(segment, |m| m.velocity[k])));
            chart = chart.line(&label, strokes).jumps(jumps(record, ball, |t, m| [t, m.velocity[k]]));
        }
    }
    chart
}

fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    let at = |c: &[f64], k: usize| c.get(k).copied().unwrap_or(0.0);
    (0..a.len().max(b.len())).map(|k| at(a, k) + at(b, k)).collect()
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; (a.len() + b.len()).saturating_sub(1)];
    for (i, a) in a.iter().enumerate() {
        for (k, b) in b.iter().enumerate() {
            product[i + k] += a * b;
        }
    }
    product
}

/// Potential energy, kinetic, and that in the spring of a contact that takes time, of all balls,
/// and their sum; per mass where there is none.
pub(super) fn energy(record: &Record) -> Chart {
    /// The number of straight pieces in which a step of a contact is drawn.
    const PIECES: u32 = 8;
    let scene = record.scene();
    let known = scene.balls.iter().all(|ball| ball.mass.is_some());
    let measure = if known { Measure::Energy } else { Measure::SpecificEnergy };
    let mut kinds: [Vec<Stroke>; 4] = Default::default();
    let all: Vec<Vec<Segment>> = (0..record.balls()).map(|ball| record.segments(ball)).collect();
    // All balls of a run have the same pieces of time.
    for (n, piece) in all[0].iter().enumerate() {
        let (mut potential, mut kinetic) = (Vec::new(), Vec::new());
        for (ball, segments) in scene.balls.iter().zip(&all) {
            let Some(segment) = segments.get(n) else { continue };
            let gravity =
                scene.effects.buoyancy(ball, scene.gravity).map_or(scene.gravity.value(), Buoyancy::net_gravity);
            let mass = ball.mass.unwrap_or(1.0);
            let turning = ball.inertia * ball.radius.unwrap_or(0.0).powi(2);
            let heights: Vec<f64> = segment.coefficients.iter().map(|m| mass * gravity * m.height()).collect();
            potential = sum(&potential, &heights);
            for k in 0..3 {
                let (v, w) = (part(segment, |m| m.velocity[k]), part(segment, |m| m.spin[k]));
                let spin: Vec<f64> = product(&w, &w).iter().map(|c| 0.5 * mass * turning * c).collect();
                let speed: Vec<f64> = product(&v, &v).iter().map(|c| 0.5 * mass * c).collect();
                kinetic = sum(&kinetic, &sum(&speed, &spin));
            }
        }
        let total = sum(&potential, &kinetic);
        if scene.contact != Contact::Rigid {
            // One ball on a level floor, whose spring takes up what is missing.
            let level = scene.floors.first().and_then(|floor| floor.level(0.0, 0.0)).unwrap_or(0.0);
            let height = part(piece, Moment::height);
            let spring = |s: f64| if piece.flight { 0.0 } else { scene.contact.stored(level - value(&height, s)) };
            let times = (0..=PIECES).map(|k| piece.span * f64::from(k) / f64::from(PIECES));
            let points: Vec<_> = times.map(|s| (piece.start + s, value(&total, s), spring(s))).collect();
            kinds[0].extend(Stroke::polygon(&points.iter().map(|&(t, e, spring)| [t, e + spring]).collect::<Vec<_>>()));
            kinds[3].extend(Stroke::polygon(&points.iter().map(|&(t, _, spring)| [t, spring]).collect::<Vec<_>>()));
        } else {
            kinds[0].push(over_time(piece, total));
        }
        kinds[1].push(over_time(piece, potential));
        kinds[2].push(over_time(piece, kinetic));
    }
    let name = if known { "Energy" } else { "Energy per mass" };
    let chart = Chart::new(&title(scene), ("Time", Measure::Time), (name, measure));
    let [total, potential, kinetic, spring] = kinds;
    let ends = |strokes: &[Stroke]| -> Vec<[[f64; 2]; 2]> {
        let point = |(x, y): (f64, f64)| [x, y];
        strokes.windows(2).map(|pair| [point(pair[0].end()), point(pair[1].start())]).collect()
    };
    let jumps = ends(&total);
    let chart = chart.line("total", total).line("potential", potential).line("kinetic", kinetic).jumps(jumps);
    if spring.is_empty() { chart } else { chart.line("in the contact", spring) }
}

/// Velocity over height; an arrow on each of the first arcs.
pub(super) fn phase(record: &Record) -> Result<Chart, PlotError> {
    let scene = record.scene();
    const ARROWS: usize = 6;
    if level(record) {
        return Err(PlotError::Missing(
            "velocity over height needs a ball that moves up or down, and this run has none: draw another kind",
        ));
    }
    let mut chart = Chart::new(&title(scene), ("Height", Measure::Length), ("Velocity", Measure::Speed));
    for ball in 0..record.balls() {
        let label = if record.balls() > 1 { scene.ball_name(ball) } else { String::new() };
        let segments = record.segments(ball);
        let point = |m: &Moment| [m.height(), m.velocity.z];
        let long = segments.iter().filter(|segment| segment.flight && segment.span > 0.02 * record.until());
        let arrows = long.take(ARROWS).map(|segment| {
            let at = |part: f64| point(&segment.at(part * segment.span));
            [at(0.5), at(0.501)].map(|p| p)
        });
        // An arrow points from a little before to the middle.
        let arrows: Vec<_> = arrows.map(|[at, next]| [at, [2.0 * next[0] - at[0], 2.0 * next[1] - at[1]]]).collect();
        let strokes = segments
            .iter()
            .map(|segment| Stroke::new(segment.span, part(segment, Moment::height), part(segment, |m| m.velocity.z)));
        chart = chart.line(&label, strokes).jumps(jumps(record, ball, |_, m| point(m))).arrows(arrows);
    }
    Ok(chart)
}

/// Apex heights above the floor then below the ball, bounce by bounce; a start at rest is bounce 0.
pub(super) fn ladder(record: &Record) -> Result<Chart, PlotError> {
    let scene = record.scene();
    /// Apexes below this part of the first belong to bounces that the picture does not show.
    const LEAST: f64 = 1e-6;
    let mut chart = Chart::new(&title(scene), ("Bounce", Measure::Count), ("Apex", Measure::Length)).logarithmic();
    let mut count = 0;
    for ball in 0..record.balls() {
        let mut heights: Vec<f64> = Vec::new();
        let ground = |t: f64| ground(record, ball, t).unwrap_or(0.0);
        if scene.balls[ball].velocity.z == 0.0 {
            heights.push(scene.balls[ball].lowest().z - ground(0.0));
        }
        let first = usize::from(heights.is_empty());
        heights.extend(record.apexes(ball).iter().map(|apex| apex.height - ground(apex.t)));
        let most = heights.iter().copied().fold(0.0, f64::max);
        let numbers = (0_u32..).map(|n| f64::from(n) + if first == 1 { 1.0 } else { 0.0 });
        let points: Vec<[f64; 2]> =
            numbers.zip(heights).take_while(|&(_, h)| h > LEAST * most).map(|(n, h)| [n, h]).collect();
        count = count.max(points.len());
        let label = if record.balls() > 1 { scene.ball_name(ball) } else { String::new() };
        chart = chart.line(&label, Stroke::polygon(&points)).marks(points);
    }
    if count < 2 {
        return Err(PlotError::Missing(
            "an apex ladder needs two apexes above the floor at least, and this run has fewer: let it run longer, or draw another kind",
        ));
    }
    Ok(chart)
}

/// Force over deformation of the first contacts.
pub(super) fn hysteresis(record: &Record) -> Result<Chart, PlotError> {
    let scene = record.scene();
    const CONTACTS: usize = 3;
    const POINTS: usize = 60;
    let mut chart = Chart::new(&title(scene), ("Deformation", Measure::Length), ("Force", Measure::Force));
    let mut drawn = 0;
    for contact in 0..CONTACTS {
        let points = record.hysteresis(contact, POINTS);
        if points.is_empty() {
            break;
        }
        drawn += 1;
        chart = chart.line(&format!("contact {}", contact + 1), Stroke::polygon(&points));
    }
    if drawn == 0 {
        return Err(PlotError::Missing(
            "force over deformation needs a contact that takes time: give the scene a [contact] with a law such as \"hertz\", or draw another kind",
        ));
    }
    Ok(chart)
}

#[cfg(test)]
mod tests {
    use saltus_scene::Scene;

    use super::*;

    fn run(toml: &str) -> Record {
        Scene::parse("scene", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap()
    }

    /// A ball that is dropped from `h` above what is below it rises to COR² of that, wherever the
    /// floor is.
    #[test]
    fn rungs_are_above_the_floor_that_the_ball_meets() {
        let ball =
            "restitution = 0.5\nball = { position = [0.01, 0.8], velocity = [1e-4, 0] }\nrun = { until = 1.5 }\n";
        for (floor, h) in [
            ("{ height = 0.3 }", 0.5),
            ("[{ height = -0.5 }, { height = -0.2 }]", 1.0),
            ("{ kind = 'stairs', from = 0, tread = 0.3, rise = 0.2, count = 5 }", 1.0),
            ("{ kind = 'stairs', from = -0.5, tread = 0.3, rise = 0.2, count = 5 }", 1.2),
            ("{ kind = 'polyline', points = [[-1, -0.7], [1, -0.7]] }", 1.5),
        ] {
            let chart = ladder(&run(&format!("{ball}floor = {floor}\n"))).unwrap();
            let ends: Vec<f64> = chart.lines[0].1.iter().flat_map(|line| [line.start().1, line.end().1]).collect();
            for (n, power) in [(0, 0), (1, 2)] {
                let due = h * 0.5_f64.powi(power);
                assert!((ends[n] - due).abs() < 1e-9, "{floor}: {ends:?} instead of {due}");
            }
        }
    }

    /// Velocity over height shows arcs, or says that there are none; velocities are drawn upwards
    /// while anything moves up or down.
    #[test]
    fn what_stays_at_its_height_has_no_portrait() {
        let two = |velocity: &str| {
            let ball = |x: f64| format!("{{ mass = 1, radius = 0.01, position = [{x}, 1], velocity = {velocity} }}");
            format!("ball = [{}, {}]\nrun = {{ until = 0.1 }}\n", ball(0.0), ball(1.0))
        };
        for (toml, moves) in [
            (format!("gravity = 0\nrestitution = 1\nfloor = []\n{}", two("[1, 0]")), false),
            (format!("gravity = 0\nrestitution = 1\nfloor = []\n{}", two("[0, 1]")), true),
            (format!("restitution = 1\n{}", two("[0, 0]")), true),
        ] {
            let record = run(&toml);
            assert_eq!(phase(&record).is_ok(), moves, "{toml}");
            assert_eq!(level(&record), !moves, "{toml}");
        }
    }

    /// Of a ball in a contact that takes time the total never rises, and falls no further than what
    /// the damper took: an elastic one keeps it to a hundred thousandth.
    #[test]
    fn the_spring_has_what_the_ball_gives_it() {
        for (law, kept) in [
            ("law = 'kelvin-voigt', stiffness = 1e4, damping = 0", 1.0 - 1e-5),
            ("law = 'kelvin-voigt', stiffness = 1e4, damping = 2", 0.5),
            ("law = 'kelvin-voigt', cor = 0.8, time = 0.01, tension = true", 0.6),
            ("law = 'hertz', stiffness = 1e6", 1.0 - 1e-5),
            ("law = 'hunt-crossley', stiffness = 1e6, cor = 0.8, speed = 4", 0.5),
        ] {
            let toml = format!("contact = {{ {law} }}\nball = {{ mass = 0.1, height = 1 }}\nrun = {{ until = 0.7 }}\n");
            let record = run(&toml);
            assert_eq!(record.impacts().len(), 1);
            let lines = energy(&record).lines;
            let [(_, total), .., (name, spring)] = &lines[..] else { panic!("{} lines", lines.len()) };
            let most = total[0].start().1;
            let ends = || total.iter().flat_map(|stroke| [stroke.start().1, stroke.end().1]);
            let rise = ends().zip(ends().skip(1)).map(|(a, b)| b - a).fold(0.0, f64::max);
            assert!(rise < 1e-6 * most, "{law}: {rise} of {most}");
            let last = total.last().unwrap().end().1;
            assert!(last > kept * most && last <= most * (1.0 + 1e-9), "{law}: {last} of {most}");
            let top = spring.iter().map(|stroke| stroke.end().1).fold(0.0, f64::max);
            assert!(name == "in the contact" && top > 0.7 * most, "{law}: {top} of {most}");
        }
    }
}
