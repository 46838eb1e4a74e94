//! Very short after very long, and late.

use saltus::nalgebra::vector;
use saltus::{Hybrid, Jump, JumpOf, Simulation};
use saltus_bounce::Ball;

use crate::report::Report;
use crate::samples::Samples;
use crate::zeno::{comes_to_rest, dropped, impact, run};

cases! {
    ratio = "ratio-1e12";
    clock = "clock-1ms";
    start_at_a_billion = "t0-1e9";
}

/// Flights of a microsecond at a million seconds keep their digits.
fn ratio(case: &mut Report) {
    let run = dropped(case, 2e6);
    let flight = |n: usize| impact(&run, n + 1).time.since(impact(&run, n).time);
    case.check("t_1", impact(&run, 1).t());
    case.check("v_pre_1", impact(&run, 1).before[1]);
    for n in [1, 3, 6] {
        case.check(&format!("flight_{n}"), flight(n));
    }
    case.check("t_7", impact(&run, 7).t());
    case.check("t_zeno", comes_to_rest(&run).t());
    let v = impact(&run, 6).after[1];
    case.check("apex_6", v * v / (2.0 * case.param("g")));
}

/// x' = 1 from 0, back to 0 at p.
fn ticks(p: f64) -> Hybrid<'static, f64> {
    Hybrid::new()
        .exact("tick", |_t, x: &f64| [*x, 1.0].into())
        .edge("tick", "tick", move |_t, x| p - x, |_t, _x| 0.0)
        .affine()
}

fn clock(case: &mut Report) {
    let (clock, numbers) = (ticks(case.param("p")), [1000, 1_000_000]);
    let mut samples = Samples::new(&numbers, &[], |_: &Jump<_, _, _>| {});
    let end = Simulation::of(&clock).most_jumps(1_000_000).drive("tick", 0.0, 0.0..1e6, &mut samples).unwrap();
    case.ran(&end.stats);
    for n in numbers {
        case.check(&format!("t_{n}"), samples.jump(n).t());
    }
    case.absent("t_1000000000", "the case lets a code stop at a million; a test of its own goes on");
}

#[test]
#[ignore = "a billion events take minutes: run it with --release -- --ignored a_billion_ticks"]
fn a_billion_ticks() {
    let mut report = Report::of("clock-1ms", |case| {
        let clock = ticks(case.param("p"));
        let simulation = Simulation::of(&clock).most_jumps(1_000_000_000);
        let end = simulation.drive("tick", 0.0, 0.0..2e6, &mut ()).unwrap();
        assert_eq!(end.jumps, 1_000_000_000);
        case.check("t_1000000000", end.time.seconds());
    });
    report.absent("t_1000", "another test's");
    report.absent("t_1000000", "another test's");
    assert!(report.faults().is_empty(), "{:?}", report.faults());
}

/// Bounces far below the spacing of doubles at the time they happen.
fn start_at_a_billion(case: &mut Report) {
    let start = vector![0.0, case.param("v0")];
    let run = run(case, start, 1e9..1e9 + 1e-6);
    let since = |jump: &JumpOf<Ball>| jump.time.since(run.trajectory.start());
    case.check("t_1-t0", since(impact(&run, 1)));
    case.check("t_10-t0", since(impact(&run, 10)));
    case.check("t_zeno-t0", since(comes_to_rest(&run)));
    case.outcome("alternative", "relative times correct");
}
