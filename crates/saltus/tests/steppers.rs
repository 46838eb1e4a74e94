//! The steppers on the problems that the field measures itself by: errors reached, and what they
//! cost.
//!
//! The counts are pinned, so that a change of the methods or of the step control shows here as a
//! change of price.

use saltus::nalgebra::{Vector2, Vector3, Vector4, vector};
use saltus::step::{Dop853, Rodas5P, Stepper, Trial, Tsit5};
use saltus::{Auto, Coords, Entry, Hybrid, RunOf, Simulation, State, Stop};

use crate::methods::methods;

/// Runs the one mode "flow" of `system` with equal relative and absolute tolerance.
fn run<'b, S: State>(
    system: &Hybrid<'b, S>,
    stepper: impl Into<Auto>,
    tolerance: f64,
    x: S,
    end: f64,
) -> RunOf<Hybrid<'b, S>> {
    run_by(system, stepper.into(), tolerance, x, end)
}

/// The same by a method of its own type.
fn run_by<'b, S: State>(
    system: &Hybrid<'b, S>,
    stepper: impl Stepper,
    tolerance: f64,
    x: S,
    end: f64,
) -> RunOf<Hybrid<'b, S>> {
    let simulation = Simulation::of(system).stepper(stepper).tolerance(tolerance).absolute_tolerance(tolerance);
    let run = simulation.run("flow", x, 0.0..end).unwrap();
    assert_eq!(run.end.stop, Stop::Time);
    run
}

/// Steps accepted, steps rejected, flow evaluations.
fn cost<S: State>(run: &RunOf<Hybrid<'_, S>>) -> (u64, u64, u64) {
    (run.end.stats.steps, run.end.stats.rejected, run.end.stats.flows)
}

// --- the Arenstorf orbit ---
//
// (That Dop853 takes the very steps of the program dop853.f under that program's own step control
// is a test beside the method.)
//
// Three bodies in a plane, one without mass, on a closed orbit that passes close by the other two:
// E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, II.0, p. 129.

const PERIOD: f64 = 17.065_216_560_157_964;

fn arenstorf() -> (Hybrid<'static, Vector4<f64>>, Vector4<f64>) {
    let system = Hybrid::new().mode("flow", |_t, x: &Vector4<f64>| {
        let moon = 0.012_277_471;
        let earth = 1.0 - moon;
        let (a, b) = (x[0] + moon, x[0] - earth);
        let pull_a = earth / (a * a + x[1] * x[1]).powf(1.5);
        let pull_b = moon / (b * b + x[1] * x[1]).powf(1.5);
        vector![
            x[2],
            x[3],
            x[0] + 2.0 * x[3] - pull_a * a - pull_b * b,
            x[1] - 2.0 * x[2] - pull_a * x[1] - pull_b * x[1]
        ]
    });
    (system, vector![0.994, 0.0, 0.0, -2.001_585_106_379_082_5])
}

/// After one period: how far from the start, and the cost.
fn orbit(stepper: impl Into<Auto>, tolerance: f64) -> (f64, (u64, u64, u64)) {
    let (system, start) = arenstorf();
    let run = run(&system, stepper, tolerance, start, PERIOD);
    ((run.end.state - start).norm(), cost(&run))
}

#[test]
fn tsit5_on_the_arenstorf_orbit() {
    let pinned = [(1e-7, 2e-3, (266, 21, 1724)), (1e-9, 4e-6, (654, 1, 3932)), (1e-11, 7e-9, (1652, 1, 9920))];
    for (tolerance, bound, counts) in pinned {
        let (error, cost) = orbit(Tsit5, tolerance);
        assert!(error < bound, "{tolerance:e}: {error:e}");
        assert_eq!(cost, counts, "{tolerance:e}");
    }
}

#[test]
fn dop853_on_the_arenstorf_orbit() {
    let pinned = [
        (1e-7, 1e-4, (83, 11, 1379)),
        (1e-9, 2e-6, (138, 19, 2300)),
        (1e-11, 1e-7, (233, 17, 3701)),
        (1e-13, 1e-9, (401, 13, 6173)),
    ];
    for (tolerance, bound, counts) in pinned {
        let (error, cost) = orbit(Dop853, tolerance);
        assert!(error < bound, "{tolerance:e}: {error:e}");
        assert_eq!(cost, counts, "{tolerance:e}");
    }
}

// --- stiff problems ---

#[test]
fn rodas5p_on_van_der_pol() {
    // The problem VDPOL of F. Mazzia, C. Magherini, Test Set for Initial Value Problem Solvers,
    // release 2.4 (2008), in its unscaled form.
    let system =
        Hybrid::new().mode("flow", |_t, x: &Vector2<f64>| vector![x[1], 1e3 * (1.0 - x[0] * x[0]) * x[1] - x[0]]);
    let exact = vector![1.706_167_732_170_469, -0.892_809_701_024_812_5e-3];
    let pinned = [(1e-4, 2e-4, (146, 21)), (1e-6, 2e-6, (357, 16)), (1e-8, 2e-8, (946, 12))];
    for (tolerance, bound, counts) in pinned {
        let run = run(&system, Rodas5P, tolerance, vector![2.0, 0.0], 2000.0);
        let error = (run.end.state - exact).component_div(&exact).amax();
        assert!(error < bound, "{tolerance:e}: {error:e}");
        let (steps, rejected, flows) = cost(&run);
        assert_eq!((steps, rejected), counts, "{tolerance:e}");
        // Nine for the stages and half way, four for the Jacobian, one to see that time does not
        // matter; now and then rounding asks for a second.
        let least = 14 * (steps + rejected) + 2;
        assert!((least..least + least / 100).contains(&flows), "{tolerance:e}: {flows}");
    }
    // The rounding in the Jacobian does not yet show.
    let run = run(&system, Rodas5P, 1e-10, vector![2.0, 0.0], 2000.0);
    assert!((run.end.state - exact).component_div(&exact).amax() < 2e-10, "{:?}", run.end.state);
}

#[test]
fn rodas5p_on_robertson() {
    // The problem ROBER of the same test set, at t = 1e11: three species, and rates over eleven
    // powers of ten.
    let system = Hybrid::new().mode("flow", |_t, x: &Vector3<f64>| {
        let (a, b, c) = (0.04 * x[0], 1e4 * x[1] * x[2], 3e7 * x[1] * x[1]);
        vector![b - a, a - b - c, c]
    });
    let exact = vector![0.208_334_014_970_125_5e-7, 0.833_336_077_033_471_3e-13, 0.999_999_979_166_505];
    let simulation = Simulation::of(&system).stepper(Auto::from(Rodas5P)).tolerance(1e-7).absolute_tolerance(1e-17);
    let run = simulation.run("flow", vector![1.0, 0.0, 0.0], 0.0..1e11).unwrap();
    let error = (run.end.state - exact).component_div(&exact).amax();
    assert!(error < 4e-8, "{error:e}");
    assert!((run.end.state.sum() - 1.0).abs() < 1e-13, "no matter is lost: {:e}", run.end.state.sum() - 1.0);
    assert_eq!((run.end.stats.steps, run.end.stats.rejected), (451, 3));
}

#[test]
fn an_explicit_stepper_pays_for_stiffness() {
    // x' = -1e4 (x - cos t): after the first moment nothing happens fast any more.
    let system = Hybrid::new().mode("flow", |t, x: &f64| -1e4 * (x - t.cos()));
    let (implicit, explicit) = (run(&system, Rodas5P, 1e-6, 0.0, 10.0), run(&system, Tsit5, 1e-6, 0.0, 10.0));
    assert!((implicit.end.state - explicit.end.state).abs() < 1e-5);
    assert!(
        explicit.end.stats.steps > 100 * implicit.end.stats.steps,
        "{:?} {:?}",
        implicit.end.stats,
        explicit.end.stats
    );
}

/// A method that is chosen as a program runs takes its very steps: at either side of the tolerance
/// at which [`Auto`] goes over to another, and where the flow is so stiff that it would leave it.
#[test]
fn a_method_by_name_is_that_method() {
    fn same(method: impl Stepper + Into<Auto>) {
        let system =
            Hybrid::new().mode("flow", |_t, x: &Vector2<f64>| vector![x[1], 1e3 * (1.0 - x[0] * x[0]) * x[1] - x[0]]);
        for tolerance in [1e-5, 1e-9] {
            let (own, named, free) = (
                run_by(&system, method, tolerance, vector![2.0, 0.0], 1.0),
                run(&system, method, tolerance, vector![2.0, 0.0], 1.0),
                run(&system, Auto::new(), tolerance, vector![2.0, 0.0], 1.0),
            );
            assert_eq!((own.end.state, own.end.stats), (named.end.state, named.end.stats));
            assert!(free.end.stats.stiff > 0 && free.end.stats != named.end.stats);
        }
    }
    same(Tsit5);
    same(Dop853);
    same(Rodas5P);
}

// --- what every stepper owes ---

/// An oscillator that carries a clock as its third coordinate. When it passes the middle it is held
/// for a second; only the clock is left then, with its falling rate: two coordinates.
fn two_dimensions() -> Hybrid<'static, Coords<3>> {
    Hybrid::new()
        .mode("free", |_t, x: &Coords<3>| [x[1], -x[0], 1.0].into())
        .mode("held", |_t, x: &Coords<3>| [x[1], -0.5].into())
        .edge("free", "held", |_t, x| x[0], |_t, x| [x[2], 0.5].into())
        .edge("held", "free", |_t, x| x[1], |_t, x| [1.0, 0.0, x[0]].into())
}

#[test]
fn modes_of_different_dimension_suit_every_stepper() {
    fn check(stepper: Auto) {
        let system = two_dimensions();
        let run =
            Simulation::of(&system).stepper(stepper).tolerance(1e-9).run("free", [1.0, 0.0, 0.0].into(), 0.0..6.0);
        let run = run.unwrap();
        // Free for a quarter turn, held for one second (while the clock goes on by a quarter), and
        // so on.
        let quarter = std::f64::consts::FRAC_PI_2;
        let times: Vec<f64> = run.trajectory.jumps().iter().map(|jump| jump.t()).collect();
        let expected = [quarter, quarter + 1.0, 2.0 * quarter + 1.0, 2.0 * quarter + 2.0];
        assert_eq!(times.len(), expected.len(), "{times:?}");
        for (time, expected) in times.into_iter().zip(expected) {
            assert!((time - expected).abs() < 1e-8, "{time} {expected}");
        }
        assert_eq!(run.end.state.len(), 3);
        assert!((run.end.state[2] - (6.0 - 2.0 + 0.5)).abs() < 1e-8, "{:?}", run.end.state);
    }
    methods().into_iter().for_each(check);
}

/// Beside the steps on the way a crossing costs one real step to it, with its dense output (15
/// evaluations of Dop853), and does not shorten the steps after it.
#[test]
fn a_crossing_costs_one_more_step() {
    let oscillator = Hybrid::new()
        .mode("right", |_t, x: &Vector2<f64>| vector![x[1], -x[0]])
        .edge("right", "left", |_t, x| x[0], |_t, x| *x)
        .mode("left", |_t, x| vector![x[1], -x[0]])
        .edge("left", "right", |_t, x| -x[0], |_t, x| *x)
        .affine();
    let run = Simulation::of(&oscillator)
        .stepper(Auto::from(Dop853))
        .tolerance(1e-8)
        .absolute_tolerance(1e-8)
        .most_jumps(1000);
    let run = run.run("right", vector![1.0, 0.0], 0.0..f64::INFINITY).unwrap();
    assert_eq!(cost(&run), (5498, 0, 102_063));
}

#[test]
fn a_ball_comes_to_rest_on_every_stepper() {
    // The last bounces last a billionth of a step, and still begin with the speed of the reset. The
    // air resists with the speed, so the flow is linear and not polynomial in time.
    fn check(stepper: Auto, drag: f64, limits: [f64; 3]) {
        for (kept, limit) in [0.5, 0.7, 0.9].into_iter().zip(limits) {
            let ball = Hybrid::new()
                .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.8 - drag * x[1]])
                .edge("flight", "flight", |_t, x| x[0], move |_t, x| vector![0.0, -kept * x[1]])
                .mode("rest", |_t, _x| vector![0.0, 0.0])
                .beyond("flight", "rest", |_t, _x| vector![0.0, 0.0]);
            let run = Simulation::of(&ball).stepper(stepper).run("flight", vector![1.0, 0.0], 0.0..10.0).unwrap();
            let rest = run.trajectory.jumps().last().unwrap();
            assert_eq!(run.end.mode, "rest");
            assert!((rest.t() - limit).abs() < 1e-8, "drag {drag}, {kept} kept: {}, not {limit}", rest.t());
        }
    }
    let free = [0.5, 0.7, 0.9].map(|kept| (2.0_f64 / 9.8).sqrt() * (1.0 + kept) / (1.0 - kept));
    let resisted = [1.290_252_395_190, 2.297_549_170_119, 6.212_030_408_788]; // by Dop853 at 1e-12 and 1e-14 alike
    for (drag, limits) in [(0.0, free), (0.3, resisted)] {
        methods().into_iter().for_each(|method| check(method, drag, limits));
    }
}

#[test]
fn dense_output_is_as_good_as_the_tolerance() {
    fn check(stepper: impl Into<Auto>, tolerance: f64, bound: f64) {
        let system = Hybrid::new().mode("flow", |t, x: &Vector2<f64>| vector![x[1] - t.sin() * 0.1, -x[0]]);
        let exact = |t: f64| {
            // x'' = -x - 0.1 cos t, from (1, 0).
            let height = t.cos() - 0.05 * t * t.sin();
            let speed = -t.sin() - 0.05 * (t.sin() + t * t.cos());
            vector![height, speed + 0.1 * t.sin()]
        };
        let run = run(&system, stepper, tolerance, vector![1.0, 0.0], 20.0);
        let worst = (0..=2000)
            .map(|i| 0.01 * f64::from(i))
            .map(|t| (run.trajectory.at(t).unwrap() - exact(t)).amax())
            .fold(0.0, f64::max);
        assert!(worst < bound, "{worst:e}");
    }
    check(Tsit5, 1e-8, 1e-6);
    check(Dop853, 1e-8, 1e-6);
    check(Dop853, 1e-12, 1e-10);
    check(Rodas5P, 1e-8, 1e-6);
}

// --- a stepper of one's own ---

/// Heun's method, whose dense output is a straight line.
#[derive(Clone, Copy)]
struct Heun;

impl Stepper for Heun {
    type Stages<S: State> = S;
    type Dense<S: State> = [S; 2];

    fn error_order(&self) -> f64 {
        2.0
    }
    fn trial<S: State>(&self, flow: &mut impl FnMut(f64, &S) -> S, t: f64, x: &S, slope: &S, h: f64) -> Trial<S, S> {
        let ahead = flow(t + h, &x.with(|i| x.get(i) + h * slope.get(i)));
        let end = x.with(|i| x.get(i) + 0.5 * h * (slope.get(i) + ahead.get(i)));
        let error = x.with(|i| 0.5 * h * (ahead.get(i) - slope.get(i)));
        Trial { slope: flow(t + h, &end), end, stages: error }
    }
    fn error<S: State>(&self, _: f64, trial: Trial<&S, &S>, square: impl Fn(&S) -> f64) -> f64 {
        square(trial.stages)
    }
    fn dense<S: State>(&self, _: &mut impl FnMut(f64, &S) -> S, _: f64, x: &S, _: f64, trial: Trial<&S, &S>) -> [S; 2] {
        [x.clone(), x.with(|i| trial.end.get(i) - x.get(i))]
    }
}

#[test]
fn a_dense_output_may_be_a_straight_line() {
    let ball = Hybrid::new()
        .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.81])
        .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.8 * x[1]])
        .affine();
    let run = Simulation::of(&ball).stepper(Heun).tolerance(1e-6).longest_step(1e-3).most_jumps(3);
    let run = run.run("flight", [1.0, 0.0], 0.0..10.0).unwrap();
    let first = (2.0 / 9.81_f64).sqrt();
    for (jump, exact) in run.trajectory.jumps().iter().zip([first, 2.6 * first, 3.88 * first]) {
        assert!((jump.t() - exact).abs() < 1e-4, "{} {exact}", jump.t());
    }
    assert_eq!(run.trajectory.jumps().len(), 3);
    // Sent on downwards, it falls at once from the root that is spent.
    let through = Hybrid::new()
        .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.81])
        .edge("flight", "flight", |_t, x| x[0], |_t, _x| [0.0, -0.1])
        .entry(Entry::Wait)
        .affine();
    let end = Simulation::of(&through).stepper(Heun).tolerance(1e-4).longest_step(1e-3).most_jumps(3);
    let end = end.run("flight", [1.0, 0.0], 0.0..0.6).unwrap();
    assert_eq!((end.end.stop, end.trajectory.jumps().len()), (Stop::Time, 1));
    assert!(end.end.state[0] < 0.0, "{:?}", end.end.state);
}
