//! Times at which a flow is not smooth: each is met exactly, and nothing else happens there.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use proptest::prelude::*;
use saltus::{Clock, Dop853, Entry, ErrorKind, Hybrid, Rodas5P, RunOf, Simulation, Tsit5};

/// An input that is constant between its knots.
#[derive(Clone, Debug)]
struct Held {
    knots: Vec<f64>,
    rates: Vec<f64>,
    /// Whether a knot has the value of after it.
    from_right: bool,
}

impl Held {
    fn at(&self, t: f64) -> f64 {
        let place = self.knots.partition_point(|&knot| if self.from_right { knot <= t } else { knot < t });
        self.rates[place]
    }

    /// Its integral from 0 to t.
    fn integral(&self, t: f64) -> f64 {
        let ends = || self.knots.iter().copied().chain([f64::INFINITY]);
        let starts = [0.0].into_iter().chain(self.knots.iter().copied());
        starts.zip(ends()).zip(&self.rates).map(|((a, b), rate)| rate * (b.min(t) - a).max(0.0)).sum()
    }
}

/// Up to a dozen knots, some a hair apart, and what the input is between them.
fn held() -> impl Strategy<Value = Held> {
    let knots = prop::collection::btree_set(1..10_000_u32, 1..12);
    (knots, prop::num::u64::ANY, any::<bool>()).prop_map(|(knots, seed, from_right)| {
        let knots: Vec<f64> = knots.into_iter().map(|k| f64::from(k) * 1e-3).collect();
        let rates = (0..=knots.len() as u64).map(|k| ((seed ^ (k * 0x9e37_79b9)) % 2001) as f64 - 1000.0).collect();
        Held { knots, rates, from_right }
    })
}

type Integrator<'a> = Hybrid<'a, [f64; 2]>;

/// x' = input(t), y' = 1.
fn integrator(input: &Held) -> Integrator<'_> {
    Hybrid::new().mode("run", |t, _x: &[f64; 2]| [input.at(t), 1.0]).stops("run", Clock::at(input.knots.clone()))
}

fn run<'a>(model: &Integrator<'a>, stepper: usize, end: f64) -> RunOf<Integrator<'a>> {
    let simulation = Simulation::of(model);
    match stepper {
        0 => simulation.run("run", [0.0; 2], 0.0..end),
        1 => simulation.stepper(Tsit5).run("run", [0.0; 2], 0.0..end),
        2 => simulation.stepper(Dop853).run("run", [0.0; 2], 0.0..end),
        _ => simulation.stepper(Rodas5P).run("run", [0.0; 2], 0.0..end),
    }
    .unwrap()
}

proptest! {
    /// The integral is exact to rounding by every stepper, whichever side a knot belongs to; steps are
    /// not tried in vain, and no knot is a jump.
    #[test]
    fn an_input_that_switches(input in held(), stepper in 0..4_usize, end in 1e-3..12.0_f64) {
        let model = integrator(&input);
        let run = run(&model, stepper, end);
        let size = 1000.0 * 12.0;
        prop_assert!((run.end.state[0] - input.integral(end)).abs() < 64.0 * f64::EPSILON * size);
        prop_assert!((run.end.state[1] - end).abs() < 1e-11);
        prop_assert_eq!((run.end.stats.jumps, run.end.stats.rejected), (0, 0));
        for &knot in input.knots.iter().filter(|&&knot| knot < end) {
            let off = run.trajectory.at(knot).unwrap()[0] - input.integral(knot);
            prop_assert!(off.abs() < 64.0 * f64::EPSILON * size, "{} at {}", off, knot);
        }
    }

    /// Each crossing of a level is found once, also one at a knot, and none is made up.
    #[test]
    fn crossings_among_stops(input in held(), level in -2000..2000_i32, stepper in 0..4_usize) {
        let level = f64::from(level) + 0.5;
        let crossed = |_t: f64, x: &[f64; 2]| if level > 0.0 { level - x[0] } else { x[0] - level };
        let model = integrator(&input).edge("run", "run", crossed, |_t, x| *x).entry("run", "run", Entry::Wait);
        let mut expected = 0;
        let inside = |t: f64| crossed(t, &[input.integral(t), t]) >= 0.0;
        for pair in [0.0].iter().chain(&input.knots).chain(&[10.0]).collect::<Vec<_>>().windows(2) {
            expected += usize::from(inside(*pair[0]) && !inside(*pair[1]));
        }
        let run = run(&model, stepper, 10.0);
        prop_assert_eq!(run.trajectory.jumps().len(), expected);
        prop_assert!(run.trajectory.doubts().is_empty());
    }

    /// A clock that ticks at the knots loses none, and a run that is paused at a tick goes on to the bit.
    #[test]
    fn clocks_at_stops(input in held()) {
        let model = integrator(&input).clock("run", "run", Clock::at(input.knots.clone()), |_t, x| *x);
        let simulation = Simulation::of(&model);
        let whole = simulation.run("run", [0.0; 2], 0.0..10.0).unwrap();
        prop_assert_eq!(whole.trajectory.jumps().len(), input.knots.len());
        prop_assert!((whole.end.state[0] - input.integral(10.0)).abs() < 1e-9);
        let mut course = simulation.start("run", [0.0; 2], 0.0..10.0).unwrap();
        course.advance(&mut ()).unwrap();
        let resumed = simulation.resume(course.checkpoint()).finish(&mut ()).unwrap();
        prop_assert_eq!(resumed.state, whole.end.state);
    }
}

/// A kink every half second, from before the run to after it, on Taylor series and by steps.
#[test]
fn a_periodic_kink() {
    let triangle = |t: f64| (t - t.round()).abs();
    let model = Hybrid::new()
        .mode("run", move |t, _x: &[f64; 1]| [triangle(t)])
        .series("run", |t, [_]| [(t - t.value().round()).abs()])
        .stops("run", Clock::every(0.5));
    for simulation in [Simulation::of(&model), Simulation::of(&model).stepped()] {
        let run = simulation.run("run", [0.0], -3.25..20.5).unwrap();
        assert!((run.end.state[0] - 5.90625).abs() < 1e-12, "{:?}", run.end.state);
        assert!(run.end.stats.steps <= 110 && run.end.stats.rejected == 0, "{:?}", run.end.stats);
    }
}

/// Only in the mode that has it does a stop end a step.
#[test]
fn a_stop_is_of_its_mode() {
    let model = Hybrid::new()
        .mode("wait", |_t, _x: &f64| 1.0)
        .mode("work", |t, _x| if t > 2.0 { -1.0 } else { 1.0 })
        .edge("wait", "work", |_t, x| 1.0 - x, |_t, x| *x)
        .stops("work", Clock::at([0.5, 2.0]));
    let run = Simulation::of(&model).run("wait", 0.0, 0.0..3.0).unwrap();
    assert!((run.end.state - 1.0).abs() < 1e-13);
    assert_eq!(run.end.stats.rejected, 0);
}

#[test]
fn stops_that_cannot_be() {
    let error = |clock| {
        let model = Hybrid::new().mode("run", |_t, _x: &f64| 1.0).stops("run", clock);
        Simulation::of(&model).run("run", 0.0, 0.0..1.0).unwrap_err().error
    };
    let wrong = error(Clock::at([0.5, 0.25]));
    assert_eq!(wrong.kind(), ErrorKind::Model);
    assert!(wrong.to_string().contains("the stops in \"run\" has a tick at 0.5"), "{wrong}");
    let late = error(Clock::from_fn(|t| Some(t.min(0.5))));
    assert_eq!(late.kind(), ErrorKind::Clock);
    assert!(late.to_string().contains("first stop after"), "{late}");
}
