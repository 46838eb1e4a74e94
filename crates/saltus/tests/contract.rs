//! What the engine asks of a model and promises it: edges, resets that refuse, limits, modes,
//! clocks with derivatives.

use proptest::prelude::*;
use saltus::{About, Automaton, Edge, Edges, Entry, ErrorKind, Hybrid, Limit, Refusal, Simulation, Solution, Stop};

use crate::methods::methods;

/// A rising line with a mark at each integer, watched by as many edges, listed in one of three
/// ways.
struct Ladder {
    count: usize,
    list: Option<Vec<usize>>,
}

impl Automaton for Ladder {
    type Mode = ();
    type State = f64;
    type Edge = usize;

    fn flow(&self, (): (), _t: f64, _x: &f64) -> f64 {
        1.0
    }
    fn solution(&self, (): (), _t: f64, x: &f64) -> Solution<Self> {
        Solution::Polynomial([*x, 1.0].into())
    }
    fn edges(&self, (): ()) -> Edges<'_, usize> {
        match &self.list {
            Some(list) => Edges::kept(list),
            None if self.count > 1000 => Edges::indexed(self.count, |rung| rung),
            None => (0..self.count).collect(),
        }
    }
    fn guard(&self, rung: usize, _t: f64, x: &f64) -> f64 {
        rung as f64 + 0.5 - x
    }
    fn about(&self, _: usize) -> About {
        About::new().affine().entry(Entry::Wait)
    }
    fn reset(&self, (): (), rung: usize, _t: f64, x: &f64) -> Result<((), f64), Refusal> {
        if rung == 1_000_002 { Err(std::fmt::Error.into()) } else { Ok(((), *x)) }
    }
}

/// However many edges there are, and however they are listed, each is taken.
#[test]
fn every_edge_is_watched() {
    for count in [1, 15, 16, 17, 18, 100] {
        for list in [None, Some((0..count).collect())] {
            let ladder = Ladder { count, list };
            let run = Simulation::of(&ladder).run((), 0.0, 0.0..count as f64);
            if ladder.list.is_none() && count > Edges::<()>::INLINE {
                // Collected, they are more than there is room for: said at once, not left out.
                let error = run.unwrap_err().error;
                assert_eq!((error.kind(), error.t()), (ErrorKind::Model, 0.0));
                assert!(error.to_string().starts_with(&format!("{count} edges were collected")), "{error}");
                continue;
            }
            let taken: Vec<_> = run.unwrap().trajectory.jumps().iter().filter_map(saltus::Jump::edge).collect();
            assert_eq!(taken, (0..count).collect::<Vec<_>>());
        }
    }
    // A million by index: the last three.
    let ladder = Ladder { count: 1_000_000, list: None };
    let run = Simulation::of(&ladder).run((), 999_997.0, 999_997.0..1e6).unwrap();
    let taken: Vec<_> = run.trajectory.jumps().iter().filter_map(saltus::Jump::edge).collect();
    assert_eq!(taken, [999_997, 999_998, 999_999]);
}

#[test]
fn a_hybrid_with_many_edges() {
    let ladder = (0..40).fold(Hybrid::new().mode("up", |_t, _x: &f64| 1.0), |ladder, rung| {
        let mark = f64::from(rung) + 0.5;
        ladder.edge("up", "up", move |_t, x| mark - x, move |_t, x| *x).entry(Entry::Wait)
    });
    let run = Simulation::of(&ladder).run("up", 0.0, 0.0..40.0).unwrap();
    let taken: Vec<_> = run.trajectory.jumps().iter().filter_map(|jump| Some(jump.edge()?.place)).collect();
    assert_eq!(taken, (0..40).collect::<Vec<_>>());
}

/// An error of any kind becomes a refusal by `?`, and a failure with time, mode, edge and state.
#[test]
fn a_reset_may_refuse() {
    let ladder = Ladder { count: 1_000_003, list: None };
    let failed = Simulation::of(&ladder).run((), 1_000_000.0, 0.0..9.0).unwrap_err();
    assert_eq!((failed.error.kind(), failed.error.edge()), (ErrorKind::Refused, Some("1000002")));
    assert_eq!((failed.error.t(), failed.error.state()), (2.5, &[1_000_002.5][..]));
    assert_eq!(failed.trajectory.jumps().len(), 2);
}

/// Two balls above one floor, in one mode: which one has come to rest, only the edges can say.
struct Two;

impl Automaton for Two {
    type Mode = [bool; 2]; // lying?
    type State = [f64; 4];
    type Edge = usize;

    fn flow(&self, lies: [bool; 2], _t: f64, x: &[f64; 4]) -> [f64; 4] {
        let fall = |ball: usize| if lies[ball] { 0.0 } else { -9.8 };
        [x[1], fall(0), x[3], fall(1)]
    }
    fn edges(&self, lies: [bool; 2]) -> Edges<'_, usize> {
        (0..2).filter(|&ball| !lies[ball]).collect()
    }
    fn guard(&self, ball: usize, _t: f64, x: &[f64; 4]) -> f64 {
        x[2 * ball]
    }
    fn about(&self, _: usize) -> About {
        About::new().affine()
    }
    fn solution(&self, lies: [bool; 2], t: f64, x: &[f64; 4]) -> Solution<Self> {
        let [_, a, _, b] = self.flow(lies, t, x);
        Solution::Polynomial([*x, [x[1], a, x[3], b], [0.5 * a, 0.0, 0.5 * b, 0.0]].into())
    }
    fn reset(&self, lies: [bool; 2], ball: usize, _t: f64, x: &[f64; 4]) -> Result<([bool; 2], [f64; 4]), Refusal> {
        let mut after = *x;
        (after[2 * ball], after[2 * ball + 1]) = (0.0, -0.5 * x[2 * ball + 1]);
        Ok((lies, after))
    }
    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<([bool; 2], [f64; 4])> {
        let (mut lies, mut x) = (limit.mode, *limit.x);
        for &ball in limit.edges {
            lies[ball] = true;
            (x[2 * ball], x[2 * ball + 1]) = (0.0, 0.0);
        }
        Some((lies, x))
    }
}

#[test]
fn a_limit_says_whose_jumps_accumulated() {
    let rest = |height: f64| 3.0 * (2.0 * height / 9.8_f64).sqrt();
    for heights in [[1.0, 7.0], [7.0, 1.0], [1.0, 1.3]] {
        let run = Simulation::of(&Two).run([false; 2], [heights[0], 0.0, heights[1], 0.0], 0.0..9.0).unwrap();
        assert_eq!((run.end.stop, run.end.mode, run.end.state), (Stop::Time, [true; 2], [0.0; 4]));
        let limits = run.trajectory.jumps().iter().filter(|jump| jump.edge().is_none());
        let limits: Vec<_> = limits.map(|jump| (jump.t(), jump.to)).collect();
        let first = usize::from(heights[1] < heights[0]);
        assert_eq!(limits[0].1, [first == 0, first == 1], "{heights:?}");
        assert!((limits[0].0 - rest(heights[first])).abs() < 1e-9, "{limits:?}");
        assert!((limits[1].0 - rest(heights[1 - first])).abs() < 1e-9, "{limits:?}");
    }
}

/// A mode that a model does not have is found wherever a run is led to it, also beyond a limit.
#[test]
fn modes_are_validated() {
    struct Odd;
    impl Automaton for Odd {
        type Mode = u8;
        type State = [f64; 2];
        type Edge = u8;
        fn flow(&self, _: u8, _t: f64, x: &[f64; 2]) -> [f64; 2] {
            [x[1], -10.0]
        }
        fn edges(&self, mode: u8) -> Edges<'_, u8> {
            Edges::from([mode])
        }
        fn guard(&self, _: u8, _t: f64, x: &[f64; 2]) -> f64 {
            x[0]
        }
        fn reset(&self, mode: u8, _: u8, _t: f64, x: &[f64; 2]) -> Result<(u8, [f64; 2]), Refusal> {
            Ok((if mode == 2 { 2 } else { mode + 2 }, [0.0, -0.5 * x[1]]))
        }
        fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(u8, [f64; 2])> {
            assert_eq!((limit.mode, limit.edges), (2, &[2][..]));
            Some((9, [1.0, 0.0]))
        }
        fn validate(&self, mode: u8, _t: f64, _x: &[f64; 2]) -> Result<(), String> {
            if mode < 5 { Ok(()) } else { Err(format!("{mode} is too high")) }
        }
    }
    let fails = |mode| Simulation::of(&Odd).run(mode, [1.0, 0.0], 0.0..9.0).unwrap_err().error;
    assert_eq!((fails(5).kind(), fails(5).to_string()), (ErrorKind::Model, "5 is too high".into()));
    let error = fails(1).to_string();
    assert!(error.starts_with("the reset of edge 3 leads to mode 5: 5 is too high"), "{error}");
    let error = fails(2);
    let expected = "Automaton::beyond leads to mode 9: 9 is too high";
    assert_eq!((error.kind(), error.to_string()), (ErrorKind::Model, expected.into()));
}

/// A flow that answers up to 2, a guard that answers up to 3, and a reset that answers up to 4.
fn gauge<'a>(ends: f64, marks: f64) -> Hybrid<'a, f64> {
    let up_to = |most: f64, x: f64, value: f64| {
        if x <= most { Ok(value) } else { Err(Refusal::new(format!("{x:.9} is above {most}"))) }
    };
    Hybrid::new()
        .fallible("sure", move |_t, x: &f64| up_to(2.0, *x, 1.0))
        .mode("free", |_t, _x| 1.0)
        .edge_with("sure", "free", Edge::new(move |_t, x| ends - x, |_t, x| *x))
        .edge_with("free", "free", Edge::fallible(move |_t, x| up_to(3.0, *x, 100.0), |_t, x| Ok(*x)))
        .edge_with("free", "free", Edge::fallible(move |_t, x| Ok(marks - x), move |_t, x| up_to(4.0, *x, 0.0)))
}

/// What a run over 2.5 s ends at, or the edge and the words that it fails with, by every stepper.
fn refused(hybrid: &Hybrid<'_, f64>, x: f64) -> [Result<f64, (Option<String>, String)>; 4] {
    let (mode, span) = (if x < 2.0 { "sure" } else { "free" }, x..x + 2.5);
    let run = Simulation::of(hybrid);
    methods().map(|method| {
        let outcome = run.stepper(method).run(mode, x, span.clone()).map(|run| run.end.state);
        outcome.map_err(|failed| {
            assert_eq!(failed.error.kind(), ErrorKind::Refused);
            (failed.error.edge().map(str::to_owned), failed.error.to_string())
        })
    })
}

proptest! {
    /// A closure that may fail fails the run with its own words where the run cannot do without it,
    /// and nowhere else.
    #[test]
    fn closures_refuse_in_their_own_words(start in 0.0..1.9_f64, marks in 2.1..2.9_f64) {
        for outcome in refused(&gauge(f64::INFINITY, marks), start) {
            let (edge, said) = outcome.unwrap_err();
            prop_assert_eq!(edge, None);
            prop_assert!(said.starts_with("the flow refused: 2.0") && said.contains("is above 2 (t = "), "{}", said);
        }
        // An edge where the flow's domain ends is taken.
        for outcome in refused(&gauge(2.0, marks), start) {
            prop_assert_eq!(outcome.map(|x| x < 3.0), Ok(true));
        }
        for outcome in refused(&gauge(2.0, f64::INFINITY), 2.0 + start) {
            let (edge, said) = outcome.unwrap_err();
            prop_assert_eq!(edge.as_deref(), Some("free -> free (edge 0)"));
            prop_assert!(said.starts_with("the guard of edge free -> free (edge 0) refused: 3."), "{}", said);
        }
    }
}

#[cfg(feature = "num-dual")]
mod derivatives {
    use super::*;
    use saltus::{Clock, Clocks, Linearize, Number, Sensitive, Wrt, saltation};

    /// A switched supply: on for a part `duty` of each second, off for the rest; x' = u - x.
    struct Supply {
        duty: f64,
        clocks: [(Clock, bool); 2],
        /// Whether the model says how the duty moves its clock.
        says: bool,
    }

    impl Supply {
        fn new(duty: f64, says: bool) -> Self {
            let (on, off) = (Clock::every(1.0).after(0.0), Clock::every(1.0).after(duty));
            Self { duty, clocks: [(on, true), (off, false)], says }
        }

        /// At the end of n periods from x = 0: each adds what its last part has left, e^-(1-d) -
        /// e^-1.
        fn after(&self, periods: u32) -> (f64, f64) {
            let left: f64 = (0..periods).map(|k| (-f64::from(k)).exp()).sum();
            let e = |s: f64| (-s).exp();
            ((e(1.0 - self.duty) - e(1.0)) * left, e(1.0 - self.duty) * left)
        }
    }

    impl Automaton for Supply {
        type Mode = bool; // on?
        type State = f64;
        type Edge = bool;

        fn flow(&self, on: bool, t: f64, x: &f64) -> f64 {
            self.flow_at(on, t, x)
        }
        fn edges(&self, _: bool) -> Edges<'_, bool> {
            Edges::none()
        }
        fn guard(&self, _: bool, _t: f64, _x: &f64) -> f64 {
            1.0
        }
        fn clocks(&self, _: bool) -> Clocks<'_, bool> {
            Clocks::kept(&self.clocks)
        }
        fn reset(&self, _: bool, to: bool, t: f64, x: &f64) -> Result<(bool, f64), Refusal> {
            Ok((to, self.reset_at(to, t, x)))
        }
    }

    impl Linearize for Supply {
        type Parameters = [f64; 1];
        fn parameters(&self) -> [f64; 1] {
            [self.duty]
        }
        fn flow_over<D: Number>(&self, on: bool, _t: D, x: D, _: [D; 1]) -> D {
            -x + if on { 1.0 } else { 0.0 }
        }
        fn guard_over<D: Number>(&self, _: bool, _t: D, _x: D, _: [D; 1]) -> D {
            D::from(1.0)
        }
        fn reset_over<D: Number>(&self, _: bool, _t: D, x: D, _: [D; 1]) -> D {
            x
        }
        fn tick_over<D: Number>(&self, _: bool, on: bool, t: f64, [duty]: [D; 1]) -> Option<D> {
            self.says.then(|| if on { D::from(t) } else { duty + (t - self.duty).round() })
        }
    }

    /// The duty cycle of a switched supply: the derivative against the closed form and differences.
    #[test]
    fn a_duty_cycle() {
        for duty in [0.1, 0.3, 0.75] {
            let run = |duty: f64| {
                let supply = Supply::new(duty, true);
                Simulation::of(&supply).tolerance(1e-13).run(true, 0.0, 0.0..9.999_999).unwrap().end.state
            };
            let supply = Supply::new(duty, true);
            let sensitive = Sensitive::of(&supply, [Wrt::Parameter(0), Wrt::Initial(0)]);
            let simulation = Simulation::of(&sensitive).tolerance(1e-13);
            let end = simulation.run(true, sensitive.start(0.0, 0.0), 0.0..10.0).unwrap();
            let (x, by_duty) = supply.after(10);
            assert!((end.end.state.x - x).abs() < 1e-10, "{} {x}", end.end.state.x);
            assert!((end.end.state.columns[0] - by_duty).abs() < 1e-10, "{} {by_duty}", end.end.state.columns[0]);
            assert!((end.end.state.columns[1] - (-10.0_f64).exp()).abs() < 1e-10);
            let h = 1e-5;
            let difference = (run(duty + h) - run(duty - h)) / (2.0 * h);
            assert!((end.end.state.columns[0] - difference).abs() < 1e-5, "{} {difference}", end.end.state.columns[0]);
            // The tick moves with the duty, and the saltation says so.
            let jump = saltation(&supply, true, false, 2.0 + duty, &0.5).unwrap();
            assert_eq!((jump.time_by_parameters[0], jump.time_by_state[0]), (1.0, 0.0));
            assert!((jump.parameters[(0, 0)] - 1.0).abs() < 1e-15, "f- less f+ is the supply");
        }
    }

    /// What is not said is not taken for zero.
    #[test]
    fn a_clock_whose_derivative_is_not_said() {
        let supply = Supply::new(0.3, false);
        let by_duty = Sensitive::of(&supply, [Wrt::Parameter(0)]);
        let error = Simulation::of(&by_duty).run(true, by_duty.start(0.0, 0.0), 0.0..3.0).unwrap_err().error;
        assert_eq!((error.kind(), error.t()), (ErrorKind::ClockDerivative, 0.3));
        assert!(error.to_string().contains("Linearize::tick_over"), "{error}");
        assert_eq!(saltation(&supply, true, false, 0.3, &0.5).unwrap_err().kind(), ErrorKind::ClockDerivative);
        // The start moves no clock.
        let by_start = Sensitive::of(&supply, [Wrt::Initial(0)]);
        let end = Simulation::of(&by_start).run(true, by_start.start(0.0, 0.0), 0.0..3.0).unwrap();
        assert!((end.end.state.columns[0] - (-3.0_f64).exp()).abs() < 1e-8);
    }
}

/// What a run leaves behind is as free as its parts: it can be sent, stored and returned, whatever
/// the automaton is.
#[test]
fn what_a_run_leaves_can_be_sent() {
    /// Not `Send`.
    struct Shared(std::rc::Rc<f64>);
    impl Automaton for Shared {
        type Mode = ();
        type State = f64;
        type Edge = ();
        fn flow(&self, (): (), _t: f64, _x: &f64) -> f64 {
            *self.0
        }
        fn edges(&self, (): ()) -> Edges<'_, ()> {
            Edges::none()
        }
        fn guard(&self, (): (), _t: f64, _x: &f64) -> f64 {
            1.0
        }
        fn reset(&self, (): (), (): (), _t: f64, x: &f64) -> Result<((), f64), Refusal> {
            Ok(((), *x))
        }
    }
    fn sent<T: Send + Sync + 'static>(_: &T) {}
    sent(&Simulation::of(&Shared(2.0.into())).run((), 0.0, 0.0..1.0).unwrap());
    let shared = Shared(2.0.into());
    let course = Simulation::of(&shared).start((), 0.0, 0.0..1.0).unwrap();
    sent(&course.checkpoint());
    let run = Simulation::of(&Shared(1.0.into())).run((), 0.0, 0.0..1.0).unwrap();
    let there = std::thread::spawn(move || run.trajectory.at(0.5)).join().unwrap();
    assert!((there.unwrap() - 0.5).abs() < 1e-12);
}

/// Of edges alike each is what it says, whatever is said of the others.
#[test]
fn edges_alike_differ() {
    use saltus::{Edge, Entry};
    for waits in 0..3 {
        let marks = (0..3).fold(Hybrid::new().mode("up", |_t, _x: &f64| 1.0), |up, place| {
            let mark = 1.0 + f64::from(place);
            let edge = Edge::new(move |_t, x: &f64| mark - x, |_t, x| *x).affine();
            up.edge_with("up", "up", if place == waits { edge.entry(Entry::Wait) } else { edge })
        });
        // Begun beyond one mark more than waits: the first that does not wait refuses.
        for beyond in 0..3 {
            let outcome = Simulation::of(&marks).run("up", 0.5 + f64::from(beyond), 0.0..0.25);
            let refused = (0..beyond).find(|&place| place != waits);
            match (outcome, refused) {
                (Ok(_), None) => {}
                (Err(failed), Some(place)) => {
                    assert_eq!(failed.error.kind(), ErrorKind::Entry);
                    assert!(failed.error.edge().unwrap().ends_with(&format!("(edge {place})")), "{}", failed.error);
                }
                (outcome, refused) => panic!("{:?} {refused:?}", outcome.map(|run| run.end.stop)),
            }
        }
    }
}

/// Names that are made as a program runs are names like any other, also beside the same ones
/// written down.
#[test]
fn names_made_as_a_program_runs() {
    for count in [1, 2, 17] {
        let ring = (0..count).fold(Hybrid::new(), |ring, k| {
            let (here, next) = (format!("room {k}"), format!("room {}", (k + 1) % count));
            ring.mode(here.clone(), |_t, _x: &f64| 1.0).edge(here, next, |_t, x| 1.0 - x, |_t, _x| 0.0)
        });
        let start = ring.name("room 0").unwrap();
        let run = Simulation::of(&ring).run(start, 0.0, 0.0..40.5).unwrap();
        assert_eq!((run.end.mode, run.end.stats.jumps), (format!("room {}", 40 % count).as_str(), 40));
        // A name written down is the same one.
        assert_eq!(Simulation::of(&ring).run("room 0", 0.0, 0.0..40.5).unwrap().end.mode, run.end.mode);
        assert_eq!(ring.name("room 99"), None);
    }
}

/// An exact solution that starts elsewhere, or not with the flow, is refused.
#[test]
fn an_exact_solution_of_another_flow_is_refused() {
    let fall = |wrong: usize| {
        Hybrid::new().mode("flight", |_t, x: &[f64; 2]| [x[1], -9.81]).exact("flight", move |_t, x| match wrong {
            0 => [*x, [x[1], -9.81], [-4.905, 0.0]].into(),
            1 => [[0.0, x[1]], [x[1], -9.81], [-4.905, 0.0]].into(),
            _ => [*x, [x[1], -19.62], [-9.81, 0.0]].into(),
        })
    };
    let run = |wrong| Simulation::of(&fall(wrong)).run("flight", [1.0, 1.0], 0.0..1.0).map(|run| run.end.state);
    assert!((run(0).unwrap()[0] + 2.905).abs() < 1e-12);
    for wrong in [1, 2] {
        assert_eq!(run(wrong).unwrap_err().error.kind(), ErrorKind::Series);
    }
}
