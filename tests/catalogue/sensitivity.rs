//! Derivatives through jumps.

use std::f64::consts::{PI, TAU};

use saltus::nalgebra::vector;
use saltus::{Dop853, Jump, Linearize, Run, RunOf, Sensitive, Simulation, State, Wrt, saltation};

use crate::report::Report;

#[allow(dead_code)]
#[path = "../tests/sensitivity/models.rs"]
mod models;

use Wrt::{Initial, Parameter};
use models::{Bounce, Dragged, Floor, Phase, Turn, Way};

cases! {
    ball = "sens-ball";
    saltation_on_a_table = "saltation-table";
    drag = "sens-drag";
}

fn run<'a, A: Linearize, const K: usize>(
    case: &mut Report,
    sensitive: &Sensitive<'a, A, K>,
    mode: A::Mode,
    x: A::State,
    end: f64,
) -> RunOf<Sensitive<'a, A, K>> {
    let simulation = Simulation::of(sensitive).stepper(Dop853).tolerance(1e-13).most_steps(100_000);
    let run = simulation.run(mode, sensitive.start(0.0, x), 0.0..end).unwrap();
    case.ran(&run.end.stats);
    run
}

fn impact<M: Copy, E: Copy, S: State>(run: &Run<M, E, S>, n: usize) -> &Jump<M, E, S> {
    run.trajectory.jumps().iter().filter(|jump| jump.edge().is_some()).nth(n - 1).unwrap()
}

/// By the exact parabola and by steps; the values themselves are asked to the last digit of the
/// parabola only.
fn ball(case: &mut Report) {
    let [g, e, h] = case.params(["g", "e", "h"]);
    for exact in [true, false] {
        let ball = Bounce { exact, ..Bounce::new(g, e) };
        let sensitive = Sensitive::of(&ball, [Parameter(1), Parameter(0), Initial(0)]);
        let run = run(case, &sensitive, Phase::Flight, vector![h, 0.0], 5.5);
        let tenth = impact(&run, 10);
        let after = sensitive.after(tenth);
        let sample = run.trajectory.at(2.5).unwrap();
        case.check("t_10", tenth.t());
        case.check("x(2.5)", sample.x[0]);
        case.check("n(2.5)", run.trajectory.jumps().iter().filter(|jump| jump.t() <= 2.5).count() as f64);
        case.check("dvpost10_de", after[0][1]);
        for (k, q) in ["e", "g", "h"].into_iter().enumerate() {
            case.check(&format!("dt10_d{q}"), tenth.after.dt[k]);
            case.check(&format!("dx(2.5)_d{q}"), sample.columns[k][0]);
            case.check(&format!("dv(2.5)_d{q}"), sample.columns[k][1]);
            // At an impact the height is zero whatever q.
            assert!(sensitive.before(tenth)[k][0].abs() < 1e-13 && after[k][0].abs() < 1e-13);
        }
    }
}

fn saltation_on_a_table(case: &mut Report) {
    let [g, a, w, e] = case.params(["g", "A", "w", "e"]);
    let ball = Bounce { amplitude: a, frequency: w, ..Bounce::new(g, e) };
    // The orbit that returns after one period of the table.
    let period = TAU / w;
    let phase = (PI * g * (1.0 - e) / (a * w * w * (1.0 + e))).acos();
    let (t, rebound, height) = (phase / w, 0.5 * g * period, a * phase.sin());
    let jump = saltation(&ball, Phase::Flight, Floor, t, &vector![height, rebound - g * period]).unwrap();
    for (name, place) in [("S11", (0, 0)), ("S12", (0, 1)), ("S21", (1, 0)), ("S22", (1, 1))] {
        case.check(name, jump.state[place]);
    }

    let sensitive = Sensitive::of(&ball, [Initial(0), Initial(1)]);
    let start = sensitive.start(t, vector![height, rebound]);
    let run = Simulation::of(&sensitive).tolerance(1e-12).run(Phase::Flight, start, t..t + 1.5 * period).unwrap();
    case.ran(&run.end.stats);
    let back = impact(&run, 1);
    assert!((back.t() - t - period).abs() < 1e-13);
    let [first, second] = back.after.columns;
    case.check("monodromy_trace", first[0] + second[1]);
    case.check("monodromy_det", first[0] * second[1] - first[1] * second[0]);
}

fn drag(case: &mut Report) {
    let [g, k, e, h] = case.params(["g", "k", "e", "h"]);
    let ball = Dragged { g, k, e, ..Dragged::default() };
    let sensitive = Sensitive::of(&ball, [Parameter(1), Parameter(2), Initial(0), Parameter(0)]);
    let run = run(case, &sensitive, Way::Down, vector![h, 0.0], 6.0);
    let third = run.trajectory.jumps().iter().filter(|jump| jump.edge() == Some(Turn::Floor)).nth(2).unwrap();
    case.check("t_3", third.t());
    case.check("v_pre_3", third.before.x[1]);
    for (k, q) in ["k", "e", "h", "g"].into_iter().enumerate() {
        case.check(&format!("dt3_d{q}"), third.after.dt[k]);
        case.check(&format!("dv3_d{q}"), sensitive.before(third)[k][1]);
    }
}
