//! A flow that is no number beyond its guard: the run comes to the crossing from inside.

use proptest::prelude::*;
use saltus::{Dop853, ErrorKind, FailedOf, Hybrid, Rodas5P, RunOf, Simulation, Stop, Tsit5};

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
    let simulation = Simulation::of(ball).tolerance(tolerance);
    match method {
        0 => simulation.stepper(Tsit5).run("flight", [1.0, 0.0], 0.0..4.0),
        1 => simulation.stepper(Dop853).run("flight", [1.0, 0.0], 0.0..4.0),
        _ => simulation.stepper(Rodas5P).run("flight", [1.0, 0.0], 0.0..4.0),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

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
