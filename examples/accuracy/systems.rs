//! The systems, each with its question and its reference.

use std::error::Error;

use saltus::nalgebra::{self, Vector2, Vector4, vector};
use saltus::{Dop853, Hybrid, Rodas5P, Run, RunOf, Simulation, State, Tsit5, WorkPrecision};
use saltus_bounce::contact::Hertz;
use saltus_bounce::flight::QuadraticDragFlight;
use saltus_bounce::{Ball, Compliant, Cor, Drop, Mode, Phase};

use crate::dragged::{Dragged, Turn};
use crate::page::Section;
use crate::sweep;

type Answer = Result<Section, Box<dyn Error>>;

/// When it jumps.
fn jump_times<M: Copy, E, S: State>(run: &Run<M, E, S>) -> Vec<f64> {
    run.trajectory.jumps().iter().map(|jump| jump.t()).collect()
}

/// Where it ends.
fn last_state<M: Copy, E, S: State>(run: &Run<M, E, S>) -> Vec<f64> {
    (0..run.end.state.len()).map(|i| run.end.state.get(i)).collect()
}

/// Ten impacts of a ball under gravity alone.
pub(crate) fn ball() -> Answer {
    let (height, gravity, cor) = (1.0, 9.8, Cor::new(0.8)?);
    let drop = Drop::new(height, gravity, cor);
    let exact = (1..=10).map(|n| drop.impact_time(n)).collect();
    let ball = Ball::new(gravity, cor)?;
    let start = (Mode::Flight, Ball::dropped_from(height), 0.0..drop.impact_time(10) + 0.01);
    let mut work = WorkPrecision::known(start, jump_times, exact);
    let simulation = Simulation::of(&ball);
    work.measure("exact arcs", &simulation)?;
    sweep(&mut work, "Tsit5", simulation.stepped().stepper(Tsit5));
    sweep(&mut work, "Dop853", simulation.stepped().stepper(Dop853));
    Ok(Section {
        name: "ball",
        title: "A ball, gravity alone",
        system: "Dropped from 1 m, g = 9.8 m/s², COR 0.8, ten impacts; the error is that of the worst impact time. A parabola is solved, so nothing is to be chosen; what steppers make of it is shown beside it.",
        error: "Worst impact time off (s)",
        reference: "the closed form".to_owned(),
        points: work.points().to_vec(),
    })
}

/// Twenty impacts under quadratic drag: by formula, by steps through smooth modes, and by steps
/// across the kink of v|v|.
pub(crate) fn drag() -> Answer {
    let (height, gravity, k, e) = (10.0, 9.8, 0.1, 0.9);
    let flight = QuadraticDragFlight::new(gravity, k)?;
    let ball = Ball::of(flight, Cor::new(e)?);
    let x = Ball::dropped_from(height);
    let impacts = |run: &RunOf<Ball<QuadraticDragFlight>>| {
        let floor = run.trajectory.jumps().iter().filter(|jump| jump.edge() == Some(saltus_bounce::Turn::Floor));
        floor.take(20).map(|jump| jump.t()).collect::<Vec<f64>>()
    };
    let simulation = Simulation::of(&ball);
    let exact = impacts(&simulation.run(Phase::of(&x), x, 0.0..12.0)?);
    let until = exact[19] + 0.01;
    let mut work = WorkPrecision::known((Phase::of(&x), x, 0.0..until), impacts, exact.clone());
    work.measure("closed form", &simulation)?;
    sweep(&mut work, "Tsit5", simulation.stepped().stepper(Tsit5));
    sweep(&mut work, "Dop853", simulation.stepped().stepper(Dop853));
    let mut points = work.points().to_vec();

    let floor = |run: &RunOf<Dragged>| {
        let jumps = run.trajectory.jumps().iter().filter(|jump| jump.edge() == Some(Turn::Floor));
        jumps.take(20).map(|jump| jump.t()).collect::<Vec<f64>>()
    };
    let smooth = Dragged { gravity, drag: k, cor: e, whole: false };
    let whole = Dragged { whole: true, ..smooth };
    let mut work = WorkPrecision::known((false, [height, 0.0], 0.0..until), floor, exact);
    sweep(&mut work, "series", Simulation::of(&smooth));
    sweep(&mut work, "Dop853, one mode", Simulation::of(&whole).stepped().stepper(Dop853));
    sweep(&mut work, "series, one mode", Simulation::of(&whole));
    points.extend_from_slice(work.points());
    Ok(Section {
        name: "drag",
        title: "Quadratic drag",
        system: "Dropped from 10 m, k = 0.1 /m, COR 0.9, twenty impacts; the error is that of the worst impact time. `Ball` has two smooth modes, rising and falling; with v|v| in one mode a stepper crosses its kink at every apex and pays for it. By series: the flow given over jets; the kink of v|v| they find themselves.",
        error: "Worst impact time off (s)",
        reference: "the closed form".to_owned(),
        points,
    })
}

/// Three contacts of a steel ball by Hertz's law.
pub(crate) fn contact() -> Answer {
    let ball = Compliant::new(0.0289, 9.81, Hertz::new(2.0e10)?)?;
    let (stage, x) = ball.released(0.1, 0.0);
    let until = 0.9;
    let simulation = Simulation::of(&ball).absolute_tolerance(1e-18);
    let tight = simulation.stepper(Dop853).tolerance(1e-14).absolute_tolerance(1e-20);
    let mut work = WorkPrecision::against(&tight, (stage, x, 0.0..until), jump_times)?;
    sweep(&mut work, "Tsit5", simulation.stepper(Tsit5));
    sweep(&mut work, "Dop853", simulation.stepper(Dop853));
    sweep(&mut work, "Rodas5P", simulation.stepper(Rodas5P));
    Ok(Section {
        name: "contact",
        title: "Contact that takes time",
        system: "A steel ball of 28.9 g falls 10 cm on a plate, Hertz's law with 2·10¹⁰ N/m^1.5: three contacts of some 70 µs between flights of 0.3 s. The error is that of the worst time of touch, greatest deformation, lift-off or apex.",
        error: "Worst time off (s)",
        reference: format!("a run by Dop853 to 1e-14, itself off by about {:.0e} s", work.doubt()),
        points: work.points().to_vec(),
    })
}

/// A hundred hops on a spring.
pub(crate) fn hopper() -> Answer {
    let (mass, stiffness, leg, g, start) = (80.0, 2e4, 1.0, 9.81, 1.2_f64);
    let fall = move |_t: f64, x: &Vector2<f64>| [*x, vector![x[1], -g], vector![-0.5 * g, 0.0]].into();
    let hopper = || {
        Hybrid::new()
            .exact("flight", fall)
            .switch("flight", "stance", move |_t, x: &Vector2<f64>| x[0] - leg)
            .affine()
            .mode("stance", move |_t, x| vector![x[1], stiffness / mass * (leg - x[0]) - g])
            .switch("stance", "flight", move |_t, x| leg - x[0])
            .affine()
    };
    let stepped = hopper();
    let expanded = hopper().series("stance", move |_t, [y, v]| [v, stiffness / mass * (leg - y) - g]);
    let (touchdown, omega) = ((2.0 * (start - leg) / g).sqrt(), (stiffness / mass).sqrt());
    let stance = 2.0 / omega * (std::f64::consts::PI - (touchdown * omega).atan());
    let period = 2.0 * touchdown + stance;
    let exact = (0..200).map(|n| {
        let (hop, half) = (f64::from(n / 2), n % 2);
        hop * period + touchdown + if half == 1 { stance } else { 0.0 }
    });
    let exact: Vec<f64> = exact.collect();
    let until = exact[199] + 0.5 * touchdown;
    let mut work = WorkPrecision::known(("flight", vector![start, 0.0], 0.0..until), jump_times, exact);
    let simulation = Simulation::of(&stepped);
    sweep(&mut work, "Tsit5", simulation.stepper(Tsit5));
    sweep(&mut work, "Dop853", simulation.stepper(Dop853));
    sweep(&mut work, "series", Simulation::of(&expanded));
    Ok(Section {
        name: "hopper",
        title: "A vertical hopper",
        system: "80 kg on a leg of 2·10⁴ N/m, a hundred hops; flight is a parabola, stance is stepped. The error is that of the worst touchdown or lift-off.",
        error: "Worst time off (s)",
        reference: "the closed form".to_owned(),
        points: work.points().to_vec(),
    })
}

/// A ball on a table that shakes.
pub(crate) fn table() -> Answer {
    let (g, amplitude, omega, e) = (9.81, 0.01, 50.0_f64, 0.5);
    let table = Hybrid::new()
        .exact("flight", move |_t, x: &Vector2<f64>| [*x, vector![x[1], -g], vector![-0.5 * g, 0.0]].into())
        .edge(
            "flight",
            "flight",
            move |t, x: &Vector2<f64>| x[0] - amplitude * (omega * t).sin(),
            move |t, x| vector![x[0], amplitude * omega * (omega * t).cos() * (1.0 + e) - e * x[1]],
        );
    let start = ("flight", vector![0.1, 0.0], 0.0..1.0);
    let jumps =
        |run: &Run<_, _, _>| -> Vec<f64> { run.trajectory.jumps().iter().take(8).map(|jump| jump.t()).collect() };
    let simulation = Simulation::of(&table);
    let mut work = WorkPrecision::against(&simulation.stepped().stepper(Dop853).tolerance(1e-14), start, jumps)?;
    work.measure("exact arcs", &simulation)?;
    sweep(&mut work, "Tsit5", simulation.stepped().stepper(Tsit5));
    sweep(&mut work, "Dop853", simulation.stepped().stepper(Dop853));
    Ok(Section {
        name: "table",
        title: "A vibrating table",
        system: "y = 1 cm · sin(50/s · t), the ball falls 10 cm onto it, COR 0.5, the first eight impacts; the flight is a parabola, its meeting with a sine is searched for. The error is that of the worst impact time.",
        error: "Worst impact time off (s)",
        reference: format!("a run by Dop853 to 1e-14, itself off by about {:.0e} s", work.doubt()),
        points: work.points().to_vec(),
    })
}

/// A closed orbit about Earth and Moon.
pub(crate) fn arenstorf() -> Answer {
    let mu = 0.012_277_471;
    let orbit = Hybrid::new().mode("orbit", move |_t, s: &Vector4<f64>| {
        let (x, y, u, v) = (s[0], s[1], s[2], s[3]);
        let (a, b) = (x + mu, x - (1.0 - mu));
        let (d1, d2) = (a * a + y * y, b * b + y * y);
        let (p, q) = ((1.0 - mu) / (d1 * d1.sqrt()), mu / (d2 * d2.sqrt()));
        vector![u, v, x + 2.0 * v - p * a - q * b, y - 2.0 * u - (p + q) * y]
    });
    let orbit = orbit.series("orbit", move |_t, [x, y, u, v]| {
        let (a, b) = (x + mu, x - (1.0 - mu));
        let far = y * y;
        let (p, q) = ((1.0 - mu) * (a * a + far).powf(-1.5), mu * (b * b + far).powf(-1.5));
        [u, v, x + 2.0 * v - p * a - q * b, y - 2.0 * u - (p + q) * y]
    });
    let x = vector![0.994, 0.0, 0.0, -2.001_585_106_379_082_5];
    let start = ("orbit", x, 0.0..17.065_216_560_157_96);
    let mut work = WorkPrecision::known(start, last_state, x.iter().copied().collect());
    let simulation = Simulation::of(&orbit);
    sweep(&mut work, "Tsit5", simulation.stepped().stepper(Tsit5));
    sweep(&mut work, "Dop853", simulation.stepped().stepper(Dop853));
    sweep(&mut work, "series", simulation);
    Ok(Section {
        name: "arenstorf",
        title: "The Arenstorf orbit",
        system: "One period of the restricted three-body problem (E. Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*, II.0); no event. The error is the largest coordinate of the distance from the start; what rounding of the data leaves is about 1.5e-11.",
        error: "Largest coordinate off",
        reference: "its start, to which it returns".to_owned(),
        points: work.points().to_vec(),
    })
}

/// A stiff relaxation oscillator.
pub(crate) fn van_der_pol() -> Answer {
    let mu = 1000.0;
    let oscillator =
        Hybrid::new().mode("swing", move |_t, x: &Vector2<f64>| vector![x[1], mu * (1.0 - x[0] * x[0]) * x[1] - x[0]]);
    let start = ("swing", vector![2.0, 0.0], 0.0..2000.0);
    let exact = vec![1.706_167_732_170_483, -0.000_892_809_701_024_797_5];
    let mut work = WorkPrecision::known(start, last_state, exact);
    sweep(&mut work, "Rodas5P", Simulation::of(&oscillator).stepper(Rodas5P));
    Ok(Section {
        name: "van-der-pol",
        title: "Van der Pol's oscillator, stiff",
        system: "μ = 1000 to t = 2000, from (2, 0): the explicit steppers would take millions of steps. The error is the largest coordinate at the end.",
        error: "Largest coordinate off",
        reference: "the value of the test set for initial value problems (F. Mazzia, C. Magherini, release 2.4)"
            .to_owned(),
        points: work.points().to_vec(),
    })
}
