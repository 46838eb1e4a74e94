//! What a newcomer reads when a run cannot start, cannot go on, or ends.

use std::ops::{ControlFlow, Range};

use saltus::nalgebra::{Vector2, vector};
use saltus::{
    Automaton, Clock, Coords, Edges, Entry, Error, ErrorKind, Hybrid, JumpOf, Linearize, Number, Observer, Refusal,
    Reversed, Simulation, saltation,
};

type Planar = Hybrid<'static, Vector2<f64>>;
type Line = Hybrid<'static, f64>;

const DROPPED: Vector2<f64> = vector![1.0, 0.0];

fn ball() -> Planar {
    Hybrid::new().mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.8]).edge(
        "flight",
        "flight",
        |_t, x| x[0],
        |_t, x| vector![0.0, -0.5 * x[1]],
    )
}

fn message(ball: &Planar, mode: &'static str, start: Vector2<f64>, end: f64) -> (ErrorKind, String) {
    let failed = Simulation::of(ball).run(mode, start, 0.0..end).unwrap_err();
    (failed.error.kind(), failed.to_string())
}

/// The message without where: a time is good to a few units in its last place.
fn what(error: &Error) -> String {
    error.to_string().split_once(" (t = ").unwrap().0.into()
}

/// Why a run of an automaton with one coordinate does not start.
fn flaw(automaton: &Line) -> String {
    let error = Simulation::of(automaton).run("heat", 20.0, 0.0..1.0).unwrap_err().error;
    assert_eq!(error.kind(), ErrorKind::Model);
    error.to_string()
}

fn heater() -> Line {
    Hybrid::new().mode("heat", |_t, _x: &f64| 1.0).mode("cool", |_t, _x| -1.0)
}

#[test]
fn a_span_that_runs_backwards() {
    let ball = ball();
    let refused = |span: Range<f64>| {
        let error = Simulation::of(&ball).run("flight", DROPPED, span).unwrap_err().error;
        assert_eq!(error.kind(), ErrorKind::Span);
        error.to_string()
    };
    #[allow(clippy::reversed_empty_ranges)] // what is refused
    let text = refused(1.0..0.0);
    insta::assert_snapshot!(text, @"the span 1..0 does not run forwards from a finite time: give start..end with start <= end and a start within 1e300 s; to run backwards, implement Invertible and run Reversed");
    assert!(refused(f64::NAN..1.0).starts_with("the span NaN..1 does not"));
    assert!(refused(0.0..f64::NAN).starts_with("the span 0..NaN does not"));
}

#[test]
fn a_tolerance_that_cannot_be_kept() {
    let ball = ball();
    for simulation in [
        Simulation::of(&ball).tolerance(0.0),
        Simulation::of(&ball).tolerance(f64::NAN),
        Simulation::of(&ball).absolute_tolerance(0.0),
    ] {
        let error = simulation.run("flight", DROPPED, 0.0..1.0).unwrap_err().error;
        assert_eq!(error.kind(), ErrorKind::Tolerance);
    }
    let error = Simulation::of(&ball).tolerance(1e-16).run("flight", DROPPED, 0.0..1.0).unwrap_err();
    insta::assert_snapshot!(error, @"the tolerances (relative 1e-16, absolute 1e-19) cannot be kept: relative must be at least 1e-15 and below 1, absolute finite and above zero");
}

#[test]
fn a_step_that_is_none() {
    let ball = ball();
    let simulation = Simulation::of(&ball);
    for simulation in [
        simulation.longest_step(0.0),
        simulation.longest_step(f64::NAN),
        simulation.first_step(-1.0),
        simulation.first_step(f64::INFINITY),
    ] {
        let error = simulation.run("flight", DROPPED, 0.0..1.0).unwrap_err().error;
        assert_eq!(error.kind(), ErrorKind::StepLimit);
    }
    let error = simulation.longest_step(0.0).run("flight", DROPPED, 0.0..1.0).unwrap_err();
    insta::assert_snapshot!(error, @"a step cannot have this size (longest_step 0): give Simulation::first_step and Simulation::longest_step durations above zero, or leave them out");
}

#[test]
fn an_initial_state_that_is_not_finite() {
    let (kind, text) = message(&ball(), "flight", vector![f64::NAN, 0.0], 1.0);
    assert_eq!(kind, ErrorKind::InitialState);
    insta::assert_snapshot!(text, @r#"the initial state is not finite: give finite coordinates (t = 0, mode "flight", state [NaN, 0.0])"#);
}

#[test]
fn an_entry_refused() {
    let (kind, text) = message(&ball(), "flight", vector![-0.1, 0.0], 1.0);
    assert_eq!(kind, ErrorKind::Entry);
    insta::assert_snapshot!(text, @r#"the guard of edge flight -> flight (edge 0) is already negative as the mode is entered: correct the state or the reset that led to it, or the guard's sign (it is positive while the edge is not due), or let About::entry or Hybrid::entry say Wait or Fire (t = 0, mode "flight", state [-0.1, 0.0])"#);
}

#[test]
fn a_mode_that_is_not_there() {
    let (kind, text) = message(&ball(), "fligth", DROPPED, 1.0);
    assert_eq!(kind, ErrorKind::Model);
    insta::assert_snapshot!(text, @r#"the automaton has no mode "fligth": did you mean "flight"? If not, declare it with Hybrid::mode"#);
    let (_, text) = message(&ball(), "stance", DROPPED, 1.0);
    insta::assert_snapshot!(text, @r#"the automaton has no mode "stance": declare it with Hybrid::mode"#);
}

/// An automaton with a mode that it says it does not have.
struct Stairs;

impl Automaton for Stairs {
    type Mode = u8;
    type State = f64;
    type Edge = u8;
    fn flow(&self, _: u8, _t: f64, _x: &f64) -> f64 {
        1.0
    }
    fn edges(&self, mode: u8) -> Edges<'_, u8> {
        Edges::from([mode])
    }
    fn guard(&self, edge: u8, _t: f64, x: &f64) -> f64 {
        f64::from(edge) + 1.0 - x
    }
    fn reset(&self, _: u8, edge: u8, _t: f64, x: &f64) -> Result<(u8, f64), Refusal> {
        Ok((edge + 1, *x))
    }
    fn validate(&self, mode: u8, _t: f64, _x: &f64) -> Result<(), String> {
        if mode < 2 { Ok(()) } else { Err("there are two modes, 0 and 1".into()) }
    }
}

#[test]
fn a_reset_to_a_mode_that_is_not_there() {
    let failed = Simulation::of(&Stairs).run(0, 0.0, 0.0..5.0).unwrap_err();
    assert_eq!((failed.error.kind(), failed.trajectory.jumps().len()), (ErrorKind::Model, 1));
    insta::assert_snapshot!(what(&failed.error), @"the reset of edge 1 leads to mode 2: there are two modes, 0 and 1");
    let error = Simulation::of(&Stairs).run(2, 0.0, 0.0..5.0).unwrap_err();
    insta::assert_snapshot!(error, @"there are two modes, 0 and 1");
}

/// What is misspelt in a `Hybrid` is found before the run starts, not when an edge is taken.
#[test]
fn names_misspelt() {
    let text = flaw(&heater().edge("heat", "coool", |_t, x| 22.0 - x, |_t, x| *x));
    insta::assert_snapshot!(text, @r#"edge heat -> coool (edge 0) leads to mode "coool", which is not declared: did you mean "cool"? If not, declare it with Hybrid::mode"#);
    let text = flaw(&heater().edge("heat", "rest", |_t, x| 22.0 - x, |_t, x| *x));
    insta::assert_snapshot!(text, @r#"edge heat -> rest (edge 0) leads to mode "rest", which is not declared: declare it with Hybrid::mode"#);
    let text = flaw(&heater().edge("haet", "cool", |_t, x| 22.0 - x, |_t, x| *x));
    insta::assert_snapshot!(text, @r#"mode "haet" has an edge but is not declared: did you mean "heat"? If not, declare it with Hybrid::mode"#);
    let text = flaw(&heater().beyond("heat", "col", |_t, x| *x));
    insta::assert_snapshot!(text, @r#"beyond a limit in "heat" lies mode "col", which is not declared: did you mean "cool"? If not, declare it with Hybrid::mode"#);
    let text = flaw(&heater().clock("heat", "Cool", Clock::every(1.0), |_t, x| *x));
    insta::assert_snapshot!(text, @r#"edge heat -> Cool (edge 0) leads to mode "Cool", which is not declared: did you mean "cool"? If not, declare it with Hybrid::mode"#);
    let text = flaw(&heater().terminal("heating", |_t, x| 22.0 - x));
    insta::assert_snapshot!(text, @r#"mode "heating" has an edge but is not declared: declare it with Hybrid::mode"#);
    let text = flaw(&heater().mode("heat", |_t, _x| 2.0));
    insta::assert_snapshot!(text, @r#"Hybrid::mode says twice what holds in mode "heat": say it once, or give one of them its own name"#);
    let text = flaw(&heater().beyond("het", "cool", |_t, x| *x));
    insta::assert_snapshot!(text, @r#"mode "het" is named but is not declared: did you mean "heat"? If not, declare it with Hybrid::mode"#);
}

#[test]
fn words_about_an_edge_that_is_not_there() {
    let text = flaw(&Line::new().mode("heat", |_t, _x| 1.0).entry(Entry::Fire).affine());
    insta::assert_snapshot!(text, @"Hybrid::entry is about the edge declared last, and there is none with a guard: write it at once after its edge");
    let clocked = heater().edge("heat", "cool", |_t, x| 22.0 - x, |_t, x| *x).clock(
        "heat",
        "heat",
        Clock::every(1.0),
        |_t, x| *x,
    );
    let text = flaw(&clocked.affine());
    insta::assert_snapshot!(text, @"Hybrid::affine is about the edge declared last, and there is none with a guard: write it at once after its edge");
}

#[test]
fn a_way_back_that_is_not_there() {
    let thermostat = heater()
        .edge("cool", "heat", |_t, x| x - 20.0, |_t, x| *x)
        .inverse(|_t, x| x - 20.0, |_t, x| *x)
        .edge("heat", "cool", |_t, x| 22.0 - x, |_t, x| *x);
    let error = Simulation::of(&Reversed::of(&thermostat)).run("heat", 21.0, -1.0..0.0).unwrap_err().error;
    assert_eq!(error.kind(), ErrorKind::Model);
    insta::assert_snapshot!(error, @r#"edge heat -> cool (edge 0) has no inverse, so that a run cannot go backwards into mode "heat": give one with Hybrid::inverse"#);
    let thermostat = thermostat.inverse(|_t, x| 22.0 - x, |_t, x| *x);
    let there = Simulation::of(&thermostat).run("heat", 20.5, 0.0..10.0).unwrap();
    let reversed = Reversed::of(&thermostat);
    let back = Simulation::of(&reversed).run(there.end.mode, there.end.state, Reversed::span(10.0, 0.0)).unwrap();
    assert_eq!((back.end.mode, back.trajectory.jumps().len()), ("heat", there.trajectory.jumps().len()));
    assert!((back.end.state - 20.5).abs() < 1e-9, "{}", back.end.state);
}

#[test]
fn a_flow_with_too_few_coordinates() {
    let automaton = Hybrid::new().mode("stance", |_t, x: &Coords<3>| [-x[0]].into());
    let error = Simulation::of(&automaton).run("stance", [1.0, 2.0].into(), 0.0..1.0).unwrap_err().error;
    assert_eq!(error.kind(), ErrorKind::Dimension);
    insta::assert_snapshot!(error, @r#"the flow gives 1 and the state has 2 coordinates: give both as many in this mode, here and in the resets that lead to it (t = 0, mode "stance", state [1.0, 2.0])"#);
}

#[test]
fn a_flow_that_is_not_finite() {
    let automaton = Hybrid::new().mode("fall", |_t, x: &Vector2<f64>| vector![x[1], -x[0].sqrt()]);
    let (kind, text) = message(&automaton, "fall", vector![-1.0, 0.0], 1.0);
    assert_eq!(kind, ErrorKind::Flow);
    insta::assert_snapshot!(text, @r#"the flow is not finite (x1' = NaN), however short the step: the solution may grow without bound, or the flow divide by zero or take a root of a negative number near this state (t = 0, mode "fall", state [-1.0, 0.0])"#);
}

#[test]
fn a_guard_that_is_not_a_number_keeps_what_was_before() {
    let automaton = ball().edge("flight", "flight", |_t, x| (x[0] - 0.5).sqrt() + 1.0, |_t, x| *x);
    let failed = Simulation::of(&automaton).run("flight", DROPPED, 0.0..3.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Guard);
    assert_eq!(failed.error.edge(), Some("flight -> flight (edge 1)"));
    // It is undefined from y = 0.5 on, and that is where the error says it is.
    assert!((failed.error.t() - (1.0_f64 / 9.8).sqrt()).abs() < 1e-6, "{}", failed.error);
    let automaton = ball().edge("flight", "flight", |_t, x| (x[0] - 2.0).sqrt(), |_t, x| *x);
    let (_, text) = message(&automaton, "flight", DROPPED, 1.0);
    insta::assert_snapshot!(text, @r#"the guard of edge flight -> flight (edge 1) is not a number: define it on the whole domain, or end the mode before (t = 0, mode "flight", state [1.0, 0.0])"#);
}

#[test]
fn a_reset_that_is_not_finite() {
    let automaton = Hybrid::new().mode("flight", |_t, x: &Vector2<f64>| vector![x[1], 0.0]).edge(
        "flight",
        "flight",
        |_t, x| x[0],
        |_t, x| vector![0.0, 1.0 / (x[1] + 2.0)],
    );
    let error = Simulation::of(&automaton).run("flight", vector![1.0, -2.0], 0.0..1.0).unwrap_err().error;
    assert_eq!((error.kind(), error.mode(), error.state()), (ErrorKind::Reset, "\"flight\"", &[0.0, -2.0][..]));
    insta::assert_snapshot!(what(&error), @r#"the reset of edge flight -> flight (edge 0) gave [0.0, inf], which is not finite: check it for division by zero or roots of negative numbers at this state"#);
}

#[test]
fn a_solution_that_blows_up() {
    let automaton = Hybrid::new().mode("grow", |_t, x: &f64| x * x);
    let failed = Simulation::of(&automaton).run("grow", 1.0, 0.0..2.0).unwrap_err();
    assert!(matches!(failed.error.kind(), ErrorKind::StepSize | ErrorKind::Flow), "{}", failed.error);
    assert!((failed.error.t() - 1.0).abs() < 1e-6, "{}", failed.error);
}

#[test]
fn a_step_that_becomes_too_short() {
    let automaton = Hybrid::new().mode("fall", |_t, x: &f64| -1.0 / x);
    let failed = Simulation::of(&automaton).run("fall", 1.0, 0.0..2.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::StepSize);
    assert!((failed.error.t() - 0.5).abs() < 1e-6, "{}", failed.error);
    insta::assert_snapshot!(what(&failed.error), @"the step size fell below the spacing of time: the solution may blow up, or the flow jump: let it jump in time at a stop (Hybrid::stops), in the state between two modes; or time is too coarse for the tolerance: loosen it, or count time from nearer by");
}

/// A ball under a ceiling.
struct Ceiling;

impl Automaton for Ceiling {
    type Mode = ();
    type State = [f64; 2];
    type Edge = ();
    fn flow(&self, (): (), t: f64, x: &[f64; 2]) -> [f64; 2] {
        self.flow_at((), t, x)
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn guard(&self, (): (), t: f64, x: &[f64; 2]) -> f64 {
        self.guard_at((), t, x)
    }
    fn reset(&self, (): (), (): (), t: f64, x: &[f64; 2]) -> Result<((), [f64; 2]), Refusal> {
        Ok(((), self.reset_over((), t, *x, [])))
    }
}

impl Linearize for Ceiling {
    type Parameters = [f64; 0];
    fn parameters(&self) -> [f64; 0] {
        []
    }
    fn flow_over<D: Number>(&self, (): (), _t: D, [_, v]: [D; 2], _: [D; 0]) -> [D; 2] {
        [v, D::from(-8.0)]
    }
    fn guard_over<D: Number>(&self, (): (), _t: D, [y, _]: [D; 2], _: [D; 0]) -> D {
        -(y - 1.0)
    }
    fn reset_over<D: Number>(&self, (): (), _t: D, [y, v]: [D; 2], _: [D; 0]) -> [D; 2] {
        [y, -v]
    }
}

#[test]
fn a_crossing_without_speed_has_no_derivative() {
    let error = saltation(&Ceiling, (), (), 0.5, &[1.0, 0.0]).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Grazing);
    insta::assert_snapshot!(error, @"edge () is crossed without speed (its guard's rate is zero to rounding), where the jump has no derivative: change the initial state or a parameter a little, or run without sensitivities (t = 0.5, mode (), state [1.0, 0.0])");
}

#[test]
fn every_ending_is_a_sentence() {
    let ball = ball();
    let stop = |simulation: Simulation<'_, Planar>, end: f64| {
        simulation.run("flight", DROPPED, 0.0..end).unwrap().end.stop.to_string()
    };
    insta::assert_snapshot!(stop(Simulation::of(&ball), 1.0), @"the end of the span was reached");
    insta::assert_snapshot!(stop(Simulation::of(&ball).most_jumps(3), 1.3), @"the limit of 3 jumps was reached: raise Simulation::most_jumps to go on");
    insta::assert_snapshot!(stop(Simulation::of(&ball).most_steps(3), 1.3), @"the limit of 3 steps was reached: raise Simulation::most_steps to go on; or, where time nearly stands, let no flow jump with the state: give it a mode on each side (Filippov)");
    insta::assert_snapshot!(stop(Simulation::of(&ball).most_evaluations(3), 1.3), @"the limit of 3 evaluations of flows and guards was reached: raise Simulation::most_evaluations to go on; or, where time nearly stands, let no flow jump with the state: give it a mode on each side (Filippov)");
    let zeno = stop(Simulation::of(&ball), 2.0);
    let (text, rest) = zeno.split_once("1.3552618543").unwrap();
    insta::assert_snapshot!(text, @"jumps accumulate at t =");
    insta::assert_snapshot!(rest.trim_start_matches(char::is_numeric), @": say what lies there, to go on, by Automaton::beyond or Hybrid::beyond, in each mode of the jumps (and for derivatives by Linearize::beyond_over)");

    let heater = heater().terminal("heat", |_t, x| 22.0 - x);
    insta::assert_snapshot!(Simulation::of(&heater).run("heat", 20.0, 0.0..5.0).unwrap().end.stop, @"the terminal edge heat -> heat (edge 0) was taken");
    let circle = self::heater().edge("heat", "cool", |_t, x| 22.0 - x, |_t, x| x - 2.0).edge(
        "cool",
        "heat",
        |_t, x| x - 20.0,
        |_t, x| x + 2.0,
    );
    insta::assert_snapshot!(Simulation::of(&circle).run("heat", 20.0, 0.0..5.0).unwrap().end.stop, @"too many jumps at one time, the last by edge heat -> cool (edge 0): let a reset lead away from the guards it meets; where the flows of two modes push against each other, give them a mode that slides between (Filippov)");

    struct Enough;
    impl<A: Automaton> Observer<A> for Enough {
        fn jump(&mut self, _: &JumpOf<A>) -> ControlFlow<()> {
            ControlFlow::Break(())
        }
    }
    let end = Simulation::of(&ball).drive("flight", DROPPED, 0.0..5.0, &mut Enough).unwrap();
    insta::assert_snapshot!(end.stop, @"the observer ended the run");
}

/// A run, and a failure, outlive the automaton that they came from, and what that borrows.
#[test]
fn what_a_run_hands_out_borrows_nothing() {
    fn grown(rate: f64) -> Result<saltus::Run<&'static str, saltus::Link, f64>, Box<dyn std::error::Error>> {
        let growth = Hybrid::new().mode("grow", |_t, x: &f64| rate * x * x);
        Ok(Simulation::of(&growth).run("grow", 1.0, 0.0..2.0)?)
    }
    assert!((grown(0.25).unwrap().end.state - 2.0).abs() < 1e-8);
    assert!(grown(1.0).unwrap_err().to_string().starts_with("the flow"));
}
