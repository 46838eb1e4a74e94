//! A flow that is no number beyond its guard: the run comes to the crossing from inside.

use proptest::prelude::*;
use saltus::{About, Automaton, Edges, ErrorKind, FailedOf, Hybrid, Refusal, RunOf, Simulation, Solution, Stop};
use saltus_cases::cases;

use crate::methods::methods;

type Ball<'a> = Hybrid<'a, [f64; 2]>;

/// A ball that is pushed back by stiffness · depthᵖ, where depth is not cut off at zero (NaN
/// outside), or is.
fn ball<'a>(stiffness: f64, power: f64, cut_off: bool) -> Ball<'a> {
    Hybrid::new()
        .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.81])
        .edge("flight", "contact", |_t, x| x[0], |_t, x| [0.0, x[1]])
        .mode("contact", move |_t, x| {
            let depth = if cut_off { (-x[0]).max(0.0) } else { -x[0] };
            [x[1], stiffness * depth.powf(power) - 9.81]
        })
        .edge("contact", "flight", |_t, x| -x[0], |_t, x| *x)
}

fn run<'a>(ball: &'a Ball<'a>, method: usize, tolerance: f64) -> Result<RunOf<Ball<'a>>, Box<FailedOf<Ball<'a>>>> {
    let simulation = Simulation::of(ball).stepper(methods()[method]).tolerance(tolerance);
    simulation.run("flight", [1.0, 0.0], 0.0..4.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(100)))]

    /// The last of the bounces comes as with a force that is defined everywhere, within what both
    /// runs' tolerance leaves open.
    #[test]
    fn a_contact_ends_where_its_force_does(
        method in 0..3_usize,
        digits in 6.0..12.0_f64,
        stiffness in 3.0..6.0_f64,
        power in prop_oneof![Just(1.5), Just(2.5), 0.5..3.0_f64],
    ) {
        let (tolerance, stiffness) = (10_f64.powf(-digits), 10_f64.powf(stiffness));
        let [undefined, defined] = [false, true].map(|cut_off| {
            let ball = ball(stiffness, power, cut_off);
            let run = run(&ball, method, tolerance).unwrap();
            assert_eq!(run.end.stop, Stop::Time);
            run.trajectory.jumps().iter().map(|jump| jump.time.seconds()).collect::<Vec<_>>()
        });
        prop_assert_eq!(undefined.len(), defined.len());
        for (a, b) in undefined.iter().zip(&defined) {
            prop_assert!((a - b).abs() < 1e4 * tolerance, "{a} {b}");
        }
    }
}

/// Where no guard falls there, it is an error: the flow at the time reached.
#[test]
fn a_flow_that_ends_without_a_guard_is_an_error() {
    let root = Hybrid::new().mode("root", |_t, x: &f64| -(x.sqrt()).recip()).terminal("root", |_t, x| x + 1.0);
    let failed = Simulation::of(&root).run("root", 1.0, 0.0..5.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Flow);
    // x^1.5 = 1 - 1.5 t
    assert!((failed.error.t() - 2.0 / 3.0).abs() < 1e-6, "{}", failed.error);
}

/// A line with two edges: one ends the run at `mark`, the other's guard is no number beyond `end`.
struct Line {
    way: usize,
    watched_first: bool,
    mark: f64,
    end: f64,
}

impl Automaton for Line {
    type Mode = ();
    type State = [f64; 2];
    type Edge = bool;

    fn flow(&self, (): (), _t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
        [v, 0.0]
    }
    fn edges(&self, (): ()) -> Edges<'_, bool> {
        Edges::from([self.watched_first, !self.watched_first])
    }
    fn guard(&self, watched: bool, _t: f64, &[x, _]: &[f64; 2]) -> f64 {
        if watched { 1.0 + (self.end - x).sqrt() } else { self.mark - x }
    }
    fn about(&self, _: bool) -> About {
        About::new().terminal()
    }
    fn reset(&self, (): (), _: bool, _t: f64, x: &[f64; 2]) -> Result<((), [f64; 2]), Refusal> {
        Ok(((), *x))
    }
    fn solution(&self, (): (), _t: f64, &[x, v]: &[f64; 2]) -> Solution<Self> {
        match self.way {
            0 => Solution::Steps,
            1 => Solution::Polynomial([[x, v], [v, 0.0]].into()),
            2 => Solution::Formula(|_, (), _, &[x, v]: &[f64; 2], s| [x + v * s, v]),
            _ => Solution::Series(|_, (), series| series.flow(|_t, [_, v]| [v, v * 0.0])),
        }
    }
}

proptest! {
    /// A guard that is no number beyond another's fall does not matter, in whatever order they are
    /// listed; before it the run fails there, with the edge.
    #[test]
    fn a_guard_is_to_be_a_number_up_to_the_first_fall(
        way in 0..4_usize,
        watched_first: bool,
        mark in 0.1..9.0_f64,
        end in 0.1..9.0_f64,
    ) {
        prop_assume!((mark - end).abs() > 1e-9);
        let run = Simulation::of(&Line { way, watched_first, mark, end }).run((), [0.0, 1.0], 0.0..10.0);
        if mark < end {
            prop_assert!((run.unwrap().end.state[0] - mark).abs() < 1e-12);
        } else {
            let error = run.unwrap_err().error;
            prop_assert_eq!((error.kind(), error.edge()), (ErrorKind::Guard, Some("true")));
            prop_assert!(error.t() > end - 1e-12, "{error}");
        }
    }
}
