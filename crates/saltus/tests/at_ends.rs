//! What falls at the very instant at which the span ends, or a clock ticks: it is taken there, and
//! before the tick, however rounding leaves the guard.

use proptest::prelude::*;
use saltus::{Clock, Hybrid, Simulation, Stop};
use saltus_cases::cases;

use crate::methods::methods;

/// x' = `rate`, by steps or solved.
fn tank<'a>(rate: f64, solved: bool) -> Hybrid<'a, f64> {
    let tank = Hybrid::new().mode("full", |_t, _x: &f64| 0.0);
    if solved {
        tank.exact("filling", move |_t, x| [*x, rate].into())
    } else {
        tank.mode("filling", move |_t, _x| rate)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(400)))]

    /// A level that is reached as the span ends, or as a clock ticks that would take it away again,
    /// is reached: in numbers that are exact, and in decimal ones.
    #[test]
    fn a_level_is_reached_as_the_span_ends_or_a_clock_ticks(
        (start, rate, period) in (0..40_i32, 1..6_i32, 1..6_i32),
        unit in prop::sample::select(vec![8, 10]),
        method in 0..4_usize,
        solved: bool,
        ticks: bool,
    ) {
        let of = |count: i32| f64::from(count) / f64::from(unit);
        let (from, flow, until) = (of(7 * start), of(rate), of(period));
        let level = f64::from(7 * start * unit + rate * period) / f64::from(unit * unit);
        let mut model = tank(flow, solved).switch("filling", "full", move |_t, x| level - x);
        if ticks {
            model = model.clock("filling", "filling", Clock::every(until), move |_t, _x| from);
        }
        let end = if ticks { 1.5 * until } else { until };
        let run = Simulation::of(&model).stepper(methods()[method]).run("filling", from, 0.0..end).unwrap();
        prop_assert_eq!(run.end.mode, "full", "{} {:?}", level, run.trajectory.jumps());
        prop_assert!((run.trajectory.jumps()[0].t() - until).abs() < 1e-12 * (1.0 + until));
    }

    /// What touches zero as the span ends, or is above it by more than rounding, does not fall.
    #[test]
    fn what_does_not_fall_at_the_end_is_left(
        method in 0..4_usize,
        solved: bool,
        above in -12.0..-3.0_f64,
        start in 0.0..100.0_f64,
    ) {
        let above = (1.0 + start) * 10_f64.powf(above);
        let level = start + 0.5 + above;
        let model = tank(0.5, solved).switch("filling", "full", move |_t, x| level - x);
        let run = Simulation::of(&model).stepper(methods()[method]).run("filling", start, 0.0..1.0).unwrap();
        prop_assert_eq!(run.end.mode, "filling", "{}", above);
        let touching = tank(0.5, solved).switch("filling", "full", |t, _x| (t - 1.0) * (t - 1.0));
        let run = Simulation::of(&touching).stepper(methods()[method]).run("filling", start, 0.0..1.0).unwrap();
        prop_assert_eq!(run.end.mode, "filling");
    }
}

/// Of two edges that fall as the span ends both are taken, in the order listed.
#[test]
fn both_of_two_that_fall_at_the_end_are_taken() {
    for stepper in methods() {
        let model = Hybrid::new()
            .mode("run", |_t, _x: &f64| 1.0)
            .edge("run", "run", |_t, x: &f64| 1.0 - x, |_t, x| *x)
            .terminal("run", |t, _x: &f64| 1.0 - t);
        for end in [1.0, 1.001] {
            let run = Simulation::of(&model).stepper(stepper).run("run", 0.0, 0.0..end).unwrap();
            assert!(matches!(run.end.stop, Stop::Terminal { .. }) && run.end.jumps == 2, "{:?}", run.end.stop);
        }
    }
}

/// Edges that fall together are taken in the order listed, however long the run was quiet before.
#[test]
fn ties_are_in_order_after_any_quiet() {
    for quiet in [1.0, 1e3, 1e5, 1e7] {
        let mut model = Hybrid::new().mode("rest", |_t, _x: &[f64; 3]| [0.0; 3]).mode("run", |_t, _x| [-1.0; 3]);
        model = model.switch("rest", "run", move |t, _x| quiet - t);
        for k in 0..3 {
            let period = 0.1 * [3.0, 1.0, 2.0][k];
            let again = move |_t: f64, x: &[f64; 3]| std::array::from_fn(|i| if i == k { x[i] + period } else { x[i] });
            model = model.edge("run", "run", move |_t, x| x[k], again);
        }
        let run = Simulation::of(&model).run("rest", [0.6; 3], 0.0..quiet + 7.0).unwrap();
        let taken: Vec<(f64, usize)> =
            run.trajectory.jumps().iter().skip(1).filter_map(|jump| Some((jump.t(), jump.edge()?.place))).collect();
        // All three fall at each multiple of 0.6 s: three jumps that hardly differ in time.
        let mut rounds = 0;
        for three in taken.windows(3).filter(|three| three[2].0 - three[0].0 < 0.01) {
            rounds += 1;
            let places: Vec<usize> = three.iter().map(|(_, place)| *place).collect();
            assert!(places.is_sorted(), "after {quiet} s: {places:?} at {}", three[0].0);
        }
        assert!(rounds >= 10, "{rounds} rounds after {quiet} s: {taken:?}");
    }
}
