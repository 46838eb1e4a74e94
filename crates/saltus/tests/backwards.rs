//! Backwards through jumps: there and back again.

use saltus::nalgebra::{Vector2, vector};
use saltus::{
    About, Automaton, Dop853, Edges, ErrorKind, Hybrid, Invertible, Refusal, Reversed, Simulation, Solution, Stop,
};

const G: f64 = 9.81;
const COR: f64 = 0.7;

/// A ball, by its exact parabola or by steps.
struct Ball {
    exact: bool,
}

impl Automaton for Ball {
    type Mode = ();
    type State = Vector2<f64>;
    type Edge = ();
    fn flow(&self, _: (), _: f64, x: &Vector2<f64>) -> Vector2<f64> {
        vector![x[1], -G]
    }
    fn edges(&self, _: ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn guard(&self, _: (), _: f64, x: &Vector2<f64>) -> f64 {
        x[0]
    }
    fn reset(&self, (): (), _: (), _: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
        Ok(((), vector![0.0, -COR * x[1]]))
    }
    #[inline]
    fn about(&self, _: ()) -> About {
        About::new().affine()
    }
    fn solution(&self, _: (), _: f64, x: &Vector2<f64>) -> Solution<Self> {
        if self.exact {
            Solution::Polynomial([*x, vector![x[1], -G], vector![-0.5 * G, 0.0]].into())
        } else {
            Solution::Steps
        }
    }
}

impl Invertible for Ball {
    fn edges_into(&self, _: ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn image(&self, _: (), _: f64, x: &Vector2<f64>) -> f64 {
        x[0]
    }
    fn undo(&self, _: (), _: f64, x: &Vector2<f64>) -> ((), Vector2<f64>) {
        ((), vector![0.0, -x[1] / COR])
    }
    fn image_affine(&self, _: ()) -> bool {
        true
    }
}

#[test]
fn a_ball_returns_to_where_it_was_dropped() {
    for exact in [true, false] {
        let ball = Ball { exact };
        let start = vector![1.0, 0.0];
        let there = Simulation::of(&ball).stepper(Dop853).tolerance(1e-14).run((), start, 0.0..2.3).unwrap();
        assert_eq!(there.end.stop, Stop::Time);
        let backwards = Reversed::of(&ball);
        let simulation = Simulation::of(&backwards).stepper(Dop853).tolerance(1e-14);
        let back = simulation.run((), there.end.state, Reversed::span(2.3, 0.0)).unwrap();
        assert_eq!(back.end.stop, Stop::Time);
        assert!((back.end.state - start).norm() < 1e-12, "exact {exact}: {:?}", back.end.state - start);

        // The same jumps, turned round.
        let again = backwards.forwards(&back.trajectory);
        assert_eq!(there.trajectory.jumps().len(), 6);
        assert_eq!(again.jumps().len(), 6);
        for (one, other) in there.trajectory.jumps().iter().zip(again.jumps()) {
            assert!((one.t() - other.t()).abs() < 1e-13);
            assert!((one.before - other.before).norm() < 1e-12);
            assert!((one.after - other.after).norm() < 1e-12);
            assert_eq!((one.j, one.edge()), (other.j, other.edge()));
        }
        // And the same arcs in between.
        assert!(again.start().seconds().abs() < 1e-15 && again.end().seconds() == 2.3);
        for k in 0..220 {
            let t = 0.005 + 0.01 * f64::from(k);
            let (one, other) = (there.trajectory.at(t).unwrap(), again.at(t).unwrap());
            assert!((one - other).norm() < 1e-11, "{t}: {one:?} {other:?}");
        }
    }
}

/// Heats towards 30 degrees until 22, cools towards 10 until 20.
struct Thermostat;

impl Automaton for Thermostat {
    type Mode = bool;
    type State = f64;
    type Edge = bool; // on to this mode
    fn flow(&self, heating: bool, _: f64, x: &f64) -> f64 {
        if heating { 30.0 - x } else { 10.0 - x }
    }
    fn edges(&self, heating: bool) -> Edges<'_, bool> {
        Edges::from([!heating])
    }
    fn guard(&self, on: bool, _: f64, x: &f64) -> f64 {
        if on { x - 20.0 } else { 22.0 - x }
    }
    fn reset(&self, _: bool, on: bool, _: f64, x: &f64) -> Result<(bool, f64), Refusal> {
        Ok((on, *x))
    }
}

impl Invertible for Thermostat {
    fn edges_into(&self, heating: bool) -> Edges<'_, bool> {
        Edges::from([heating])
    }
    fn image(&self, on: bool, t: f64, x: &f64) -> f64 {
        self.guard(on, t, x) // what cools has come from 22 degrees and is below; what heats has come from 20 and is above
    }
    fn undo(&self, on: bool, _: f64, x: &f64) -> (bool, f64) {
        (!on, *x)
    }
}

#[test]
fn a_thermostat_runs_backwards() {
    let there = Simulation::of(&Thermostat).stepper(Dop853).tolerance(1e-14).run(true, 21.0, 0.0..3.0).unwrap();
    let backwards = Reversed::of(&Thermostat);
    let simulation = Simulation::of(&backwards).stepper(Dop853).tolerance(1e-14);
    let back = simulation.run(there.end.mode, there.end.state, Reversed::span(3.0, 0.0)).unwrap();
    assert!(back.end.mode);
    assert!((back.end.state - 21.0).abs() < 1e-12, "{}", back.end.state - 21.0);
    assert_eq!(back.trajectory.jumps().len(), there.trajectory.jumps().len());
    for (one, other) in there.trajectory.jumps().iter().rev().zip(back.trajectory.jumps()) {
        assert!((one.t() + other.t()).abs() < 1e-13);
        assert_eq!((one.from, one.to), (other.to, other.from));
    }
}

/// A clock with marks at 0, 1e-8 and 2e-8: forwards and backwards each is met once, in order, and
/// the one at 0 at 0 exactly.
struct Marks;

const MARKS: [f64; 3] = [0.0, 1e-8, 2e-8];

impl Automaton for Marks {
    type Mode = usize; // how many marks have been passed
    type State = f64;
    type Edge = usize;
    fn flow(&self, _: usize, _: f64, _: &f64) -> f64 {
        1.0
    }
    fn edges(&self, passed: usize) -> Edges<'_, usize> {
        if passed < MARKS.len() { Edges::from([passed]) } else { Edges::none() }
    }
    fn guard(&self, mark: usize, _: f64, x: &f64) -> f64 {
        MARKS[mark] - x
    }
    fn reset(&self, _: usize, mark: usize, _: f64, x: &f64) -> Result<(usize, f64), Refusal> {
        Ok((mark + 1, *x))
    }
}

impl Invertible for Marks {
    fn edges_into(&self, passed: usize) -> Edges<'_, usize> {
        if passed > 0 { Edges::from([passed - 1]) } else { Edges::none() }
    }
    fn image(&self, mark: usize, _: f64, x: &f64) -> f64 {
        x - MARKS[mark]
    }
    fn undo(&self, mark: usize, _: f64, x: &f64) -> (usize, f64) {
        (mark, *x)
    }
}

#[test]
fn close_marks_in_order_both_ways() {
    let there = Simulation::of(&Marks).run(0, -1.0, -1.0..1.0).unwrap();
    let backwards = Reversed::of(&Marks);
    let back = Simulation::of(&backwards).run(3, 1.0, Reversed::span(1.0, -1.0)).unwrap();
    let met: Vec<_> = there.trajectory.jumps().iter().map(|jump| jump.edge().unwrap()).collect();
    let unmet: Vec<_> = back.trajectory.jumps().iter().map(|jump| jump.edge().unwrap()).collect();
    assert_eq!((met, unmet), (vec![0, 1, 2], vec![2, 1, 0]));
    for (jump, mark) in back.trajectory.jumps().iter().zip([2e-8, 1e-8, 0.0]) {
        assert!((-jump.t() - mark).abs() < 1e-15, "{} {mark}", jump.t());
    }
    // Starting exactly on a mark is no error either.
    let on = Simulation::of(&backwards).run(1, 0.0, Reversed::span(0.0, -1.0)).unwrap();
    assert_eq!((on.end.mode, on.trajectory.jumps()[0].t()), (0, 0.0));
}

#[test]
fn a_span_that_runs_backwards_is_refused() {
    let forwards_only = Hybrid::new().mode("decay", |_, x: &f64| -x);
    let failed = Simulation::of(&forwards_only).run("decay", 1.0, 1.0..0.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Span);
    assert!(failed.error.to_string().contains("Reversed"), "{}", failed.error);
}
