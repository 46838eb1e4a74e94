//! What is not a number, or cannot be gone on from, is an error at once: with its kind, mode, edge,
//! time and state.

use proptest::prelude::*;
use saltus::{
    Automaton, Clock, Clocks, Edges, Error, ErrorKind, Hybrid, Limit, Polynomial, Refusal, Simulation, Solution, Stop,
};
use saltus_cases::cases;

/// What a model gives in place of a number, from some time on.
const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// What is bad.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    Flow,
    Guard,
    Reset,
    Refused,
    Beyond,
    Clock,
    LeadsNowhere,
}

/// A tank that fills by 1 L/s from 0, is emptied at 1 L, and leaks by ever shorter cycles in its
/// other mode.
struct Tank {
    bad: Place,
    number: f64,
    from: f64,
    solved: bool,
    clocks: [(Clock, Edge); 1],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Fill,
    Nowhere,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Edge {
    Full,
    Tick,
}

impl Tank {
    fn new(bad: Place, number: f64, from: f64, solved: bool) -> Self {
        let next =
            move |t: f64| Some(if t >= from { if number > 0.0 { t - 1.0 } else { number } } else { t.floor() + 1.0 });
        Self { bad, number, from, solved, clocks: [(Clock::from_fn(next), Edge::Tick)] }
    }
    fn is_bad(&self, place: Place, t: f64) -> bool {
        self.bad == place && t >= self.from
    }
}

impl Automaton for Tank {
    type Mode = Mode;
    type State = [f64; 2];
    type Edge = Edge;

    fn flow(&self, _: Mode, t: f64, _x: &[f64; 2]) -> [f64; 2] {
        [if self.is_bad(Place::Flow, t) { self.number } else { 1.0 }, 0.0]
    }
    fn solution(&self, _: Mode, t: f64, x: &[f64; 2]) -> Solution<Self> {
        if self.solved {
            Solution::Polynomial(Polynomial::from([*x, self.flow(Mode::Fill, t, x)]))
        } else {
            Solution::Steps
        }
    }
    fn edges(&self, _: Mode) -> Edges<'_, Edge> {
        Edges::from([Edge::Full])
    }
    fn guard(&self, _: Edge, t: f64, x: &[f64; 2]) -> f64 {
        if self.is_bad(Place::Guard, t) { f64::NAN } else { x[1].mul_add(0.0, 1.0 - x[0]) * x[1] }
    }
    fn reset(&self, mode: Mode, _: Edge, t: f64, x: &[f64; 2]) -> Result<(Mode, [f64; 2]), Refusal> {
        if self.is_bad(Place::Refused, t) {
            return Err(Refusal::new(format!("no state for {}", self.number)));
        }
        let to = if self.is_bad(Place::LeadsNowhere, t) { Mode::Nowhere } else { mode };
        Ok((to, [if self.is_bad(Place::Reset, t) { self.number } else { 0.0 }, x[1]]))
    }
    fn clocks(&self, _: Mode) -> Clocks<'_, Edge> {
        if self.bad == Place::Clock { Clocks::kept(&self.clocks) } else { Clocks::none() }
    }
    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(Mode, [f64; 2])> {
        Some((limit.mode, [self.number, 1.0]))
    }
    fn validate(&self, mode: Mode, _t: f64, _x: &[f64; 2]) -> Result<(), String> {
        if mode == Mode::Nowhere { Err("there is nothing here: stay".into()) } else { Ok(()) }
    }
}

fn is_placed(error: &Error, mode: &str, edge: Option<&str>, t: impl Fn(f64) -> bool) {
    assert_eq!((error.mode(), error.edge()), (mode, edge), "{error}");
    assert!(t(error.t()), "{error}");
    assert_eq!(error.state().len(), 2, "{error}");
    let sentence = error.to_string();
    assert!(sentence.contains("mode Fill") && sentence.contains("state ["), "{sentence}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(200)))]

    /// Whatever a model gives that is no number, from whichever time: the error says what, where
    /// and when; the run up to it is kept.
    #[test]
    fn what_is_no_number(number in 0..BAD.len(), from in 0.0..20.0_f64, solved: bool) {
        let number = BAD[number];
        let run = |bad| {
            let failed = Simulation::of(&Tank::new(bad, number, from, solved)).run(Mode::Fill, [0.0, 1.0], 0.0..40.0).unwrap_err();
            let jumps = failed.trajectory.jumps().len();
            assert!(jumps as f64 <= failed.error.t() + 1e-9, "{}", failed.error);
            (failed.error, jumps)
        };
        let next = if from.fract() == 0.0 && from > 0.0 { from } else { from.floor() + 1.0 };

        // A solution is asked for where an arc begins, a flow all along.
        let (error, _) = run(Place::Flow);
        prop_assert!(error.kind() == ErrorKind::Flow || solved, "{}", error);
        is_placed(&error, "Fill", if error.kind() == ErrorKind::Flow { None } else { error.edge() }, |t| t >= from - 1.0 - 1e-9 && t <= from + 1.0);

        let (error, _) = run(Place::Guard);
        prop_assert_eq!(error.kind(), ErrorKind::Guard);
        is_placed(&error, "Fill", Some("Full"), |t| t >= from - 1e-9 && t <= from + 1.0);

        for (bad, kind) in [
            (Place::Reset, ErrorKind::Reset),
            (Place::Refused, ErrorKind::Refused),
            (Place::LeadsNowhere, ErrorKind::Model),
        ] {
            let (error, jumps) = run(bad);
            prop_assert_eq!(error.kind(), kind);
            is_placed(&error, "Fill", Some("Full"), |t| (t - next).abs() < 1e-9);
            prop_assert_eq!(jumps, next as usize - 1);
        }
        // A clock that answers infinity has no further tick; any other answer is not after the time
        // it was asked about.
        if number != f64::INFINITY || from > 0.0 {
            let clock = Tank::new(Place::Clock, number, from, solved);
            let failed = Simulation::of(&clock).run(Mode::Fill, [0.0, 1.0], 0.0..40.0).unwrap_err();
            prop_assert_eq!(failed.error.kind(), ErrorKind::Clock);
            is_placed(&failed.error, "Fill", Some("Tick"), |t| t >= from.floor() - 1e-9 && t <= from + 1.0);
        }
    }

    /// What a run is asked for in vain.
    #[test]
    fn what_cannot_be_run(number in 0..BAD.len(), start in -1e3..1e3_f64, back in 1e-9..1e3_f64, other: bool) {
        let number = BAD[number];
        let tank = Tank::new(Place::Beyond, number, 0.0, false);
        let simulation = Simulation::of(&tank);
        let error = |x, span| simulation.run(Mode::Fill, x, span).unwrap_err().error;

        let x = if other { [0.0, number] } else { [number, 1.0] };
        let failed = error(x, start..start + back);
        prop_assert_eq!(failed.kind(), ErrorKind::InitialState);
        is_placed(&failed, "Fill", None, |t| t == start);

        for span in [start..start - back, number..start, number..f64::NAN, start..f64::NAN, start..f64::NEG_INFINITY, 1e301..1e302] {
            let failed = error([0.0, 1.0], span.clone());
            prop_assert_eq!(failed.kind(), ErrorKind::Span, "{:?}", span);
            prop_assert_eq!(failed.state(), &[0.0, 1.0][..]);
            prop_assert!(failed.to_string().contains("start <= end"));
        }
        for wrong in [-number.abs(), 0.0, -back, f64::NAN] {
            let kind = |simulation: Simulation<'_, Tank>| simulation.run(Mode::Fill, [0.0, 1.0], 0.0..1.0).unwrap_err().error.kind();
            prop_assert_eq!(kind(simulation.tolerance(wrong)), ErrorKind::Tolerance);
            prop_assert_eq!(kind(simulation.absolute_tolerance(wrong)), ErrorKind::Tolerance);
            prop_assert_eq!(kind(simulation.first_step(wrong)), ErrorKind::StepLimit);
            prop_assert_eq!(kind(simulation.longest_step(wrong)), ErrorKind::StepLimit);
        }
        // An empty span is a run of no duration.
        let run = simulation.run(Mode::Fill, [0.0, 1.0], start..start).unwrap();
        prop_assert_eq!((run.end.stop, run.end.state, run.trajectory.end().seconds()), (Stop::Time, [0.0, 1.0], start));
    }
}

/// What lies beyond a limit must be a state.
#[test]
fn beyond_a_limit_lies_no_number() {
    for number in BAD {
        let ball = Hybrid::new()
            .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.8])
            .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.5 * x[1]])
            .beyond("flight", "flight", move |_t, _x| [number, 0.0]);
        let failed = Simulation::of(&ball).run("flight", [1.0, 0.0], 0.0..9.0).unwrap_err();
        assert_eq!(failed.error.kind(), ErrorKind::Reset);
        assert!((failed.error.t() - 3.0 * (2.0_f64 / 9.8).sqrt()).abs() < 1e-9, "{}", failed.error);
        assert!(failed.error.to_string().starts_with("Automaton::beyond gave"), "{}", failed.error);
        assert!(failed.trajectory.jumps().len() > 20);
    }
}

/// A mode without edges is never left, and one with a million is.
#[test]
fn from_no_edges_to_a_million() {
    let run = Simulation::of(&Hybrid::new().mode("stay", |_t, _x: &f64| 1.0)).run("stay", 0.0, 0.0..2.0).unwrap();
    assert_eq!((run.end.stop, run.end.state), (Stop::Time, 2.0));

    struct Many;
    impl Automaton for Many {
        type Mode = ();
        type State = f64;
        type Edge = usize;
        fn flow(&self, (): (), _t: f64, _x: &f64) -> f64 {
            1.0
        }
        fn edges(&self, (): ()) -> Edges<'_, usize> {
            Edges::indexed(1_000_000, |i| i)
        }
        fn guard(&self, edge: usize, _t: f64, x: &f64) -> f64 {
            if edge == 654_321 { 0.5 - x } else { 2.0 + (edge as f64) - x }
        }
        fn about(&self, _: usize) -> saltus::About {
            saltus::About::new().affine()
        }
        fn reset(&self, (): (), edge: usize, _t: f64, _x: &f64) -> Result<((), f64), Refusal> {
            Err(Refusal::new(format!("edge {edge} leads nowhere")))
        }
    }
    let failed = Simulation::of(&Many).run((), 0.0, 0.0..1.0).unwrap_err();
    assert_eq!((failed.error.kind(), failed.error.edge()), (ErrorKind::Refused, Some("654321")));
    assert!((failed.error.t() - 0.5).abs() < 1e-12 && failed.error.to_string().contains("leads nowhere"));
}
