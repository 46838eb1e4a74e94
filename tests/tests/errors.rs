//! What a newcomer reads when a run cannot go on.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use saltus::nalgebra::{Vector2, vector};
use saltus::{ErrorKind, Hybrid, Simulation};

type Ball = Hybrid<'static, Vector2<f64>>;

fn ball() -> Ball {
    Hybrid::new().mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.8]).edge(
        "flight",
        "flight",
        |_t, x| x[0],
        |_t, x| vector![0.0, -0.5 * x[1]],
    )
}

fn message(ball: &Ball, mode: &'static str, start: Vector2<f64>, end: f64) -> (ErrorKind, String) {
    let failed = Simulation::of(ball).run(mode, start, 0.0..end).unwrap_err();
    (failed.error.kind(), failed.to_string())
}

#[test]
fn an_entry_refused() {
    let (kind, text) = message(&ball(), "flight", vector![-0.1, 0.0], 1.0);
    assert_eq!(kind, ErrorKind::Entry);
    insta::assert_snapshot!(text, @"the guard of edge flight -> flight (edge 0) is already negative as the mode is entered: correct the state or the reset, or let Automaton::entry answer Wait or Fire (t = 0, mode \"flight\", state [-0.1, 0.0])");
}

#[test]
fn an_unknown_mode() {
    let (kind, text) = message(&ball(), "fligth", vector![1.0, 0.0], 1.0);
    assert_eq!(kind, ErrorKind::UnknownMode);
    insta::assert_snapshot!(text, @"there is no such mode: declare it, or start in and reset to a declared one (t = 0, mode \"fligth\", state [1.0, 0.0])");
}

#[test]
fn a_flow_that_is_not_finite() {
    let automaton = Hybrid::new().mode("fall", |_t, x: &Vector2<f64>| vector![x[1], -x[0].sqrt()]);
    let (kind, text) = message(&automaton, "fall", vector![-1.0, 0.0], 1.0);
    assert_eq!(kind, ErrorKind::Flow);
    insta::assert_snapshot!(text, @"the flow is not finite, however short the step: check it for division by zero or roots of negative numbers near this state (t = 0, mode \"fall\", state [-1.0, 0.0])");
}

#[test]
fn a_guard_that_is_not_a_number_keeps_what_was_before() {
    let automaton = ball().edge("flight", "flight", |_t, x| (x[0] - 0.5).sqrt() + 1.0, |_t, x| *x);
    let failed = Simulation::of(&automaton).run("flight", vector![1.0, 0.0], 0.0..3.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Guard);
    assert_eq!(failed.error.edge(), Some("flight -> flight (edge 1)"));
    // It is undefined from y = 0.5 on, and that is where the error says it is.
    assert!((failed.error.t() - (1.0_f64 / 9.8).sqrt()).abs() < 1e-6, "{}", failed.error);
}

#[test]
fn a_reset_that_is_not_finite() {
    let automaton = Hybrid::new().mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.8]).edge(
        "flight",
        "flight",
        |_t, x| x[0],
        |_t, x| vector![0.0, 1.0 / (x[1] - x[1])],
    );
    let (kind, text) = message(&automaton, "flight", vector![1.0, 0.0], 1.0);
    assert_eq!(kind, ErrorKind::Reset);
    assert!(
        text.contains("the reset of edge flight -> flight (edge 0) gave a state that is not finite (t = 0.4517"),
        "{text}"
    );
}

#[test]
fn a_solution_that_blows_up() {
    let automaton = Hybrid::new().mode("grow", |_t, x: &Vector2<f64>| vector![x[0] * x[0], 0.0]);
    let failed = Simulation::of(&automaton).run("grow", vector![1.0, 0.0], 0.0..2.0).unwrap_err();
    assert!(matches!(failed.error.kind(), ErrorKind::StepSize | ErrorKind::Flow), "{}", failed.error);
    assert!((failed.error.t() - 1.0).abs() < 1e-6, "{}", failed.error);
}

#[test]
fn spans_and_tolerances() {
    let ball = ball();
    let simulation = Simulation::of(&ball);
    for span in [1.0..0.0, f64::NAN..1.0, 0.0..f64::NAN] {
        assert_eq!(simulation.run("flight", vector![1.0, 0.0], span).unwrap_err().error.kind(), ErrorKind::Span);
    }
    let failed = Simulation::of(&ball).tolerance(0.0).run("flight", vector![1.0, 0.0], 0.0..1.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Tolerance);
    let failed = simulation.run("flight", vector![f64::NAN, 0.0], 0.0..1.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::InitialState);
}
