//! Hoppers, runners, walkers, a wheel and a juggler: runs, and the fixed points of their return
//! maps with multipliers.

use saltus::nalgebra::vector;
use saltus::return_map::{ReturnMap, Section, Selection};
use saltus::{Automaton, Coords, Dop853, Hybrid, JumpOf, Linearize, RunOf, Simulation, Stop};

use crate::report::Report;

#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/juggler.rs"]
mod juggler;
#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/slip.rs"]
mod slip;
#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/walker.rs"]
mod walker;
#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/wheel.rs"]
mod wheel;

cases! {
    slip_runner = "slip-stable";
    vertical_hopper = "vertical-hopper";
    rimless_wheel = "rimless-wheel";
    simplest_walker = "walker-long";
    mirror_juggling = "mirror-juggling";
}

/// The jumps by this edge of a run by tight steps.
fn walks<A: Automaton>(
    case: &mut Report,
    walker: &A,
    mode: A::Mode,
    x: A::State,
    edge: A::Edge,
    end: f64,
) -> Vec<JumpOf<A>> {
    let run: RunOf<A> = Simulation::of(walker).stepper(Dop853).tolerance(1e-13).run(mode, x, 0.0..end).unwrap();
    case.ran(&run.end.stats);
    run.trajectory.jumps().iter().filter(|jump| jump.edge() == Some(edge)).cloned().collect()
}

fn slip_runner(case: &mut Report) {
    let [mass, stiffness, leg, angle, g, energy, y0] = case.params(["m", "k", "l0", "al", "g", "E", "y0"]);
    let runner = slip::Runner { mass, stiffness, leg, angle, g };
    let apex = slip::Apex(runner, energy);
    let map = ReturnMap::of(Simulation::of(&runner).tolerance(1e-13), &apex);
    let stride = map.fixed_point([0.95]).unwrap();
    case.check("y_apex_fixed", stride.q[0]);
    case.check("stride_time", stride.period);
    case.check("multiplier", stride.multipliers[0].re);
    let [x, y, speed, fall, _]: [f64; 5] = apex.place(stride.q, runner.parameters());
    case.check("vx_apex", speed);
    let start: Coords<5> = [x, y, speed, fall].into();
    let run = Simulation::of(&runner).stepper(Dop853).tolerance(1e-13).run(slip::Phase::Fall, start, 0.0..1.0).unwrap();
    let jumps = run.trajectory.jumps();
    case.check("stance_time", jumps[1].time.since(jumps[0].time));

    let [x, y, speed, fall, _]: [f64; 5] = apex.place([y0], runner.parameters());
    let apexes = walks(case, &runner, slip::Phase::Fall, [x, y, speed, fall].into(), slip::Phase::Rise, 10.0);
    for n in [1, 2, 10] {
        case.check(&format!("y_{n}"), apexes[n - 1].after[1]);
        case.check(&format!("t_apex_{n}"), apexes[n - 1].t());
    }
}

/// A mass on a springy leg. In flight the state is (height, speed); in stance the ground's impulse
/// is a third coordinate.
fn vertical_hopper(case: &mut Report) {
    let [m, k, l0, g, h] = case.params(["m", "k", "l0", "g", "h"]);
    let push = move |y: f64| k * (l0 - y);
    let hopper = Hybrid::new()
        .mode("flight", move |_, x: &Coords<3>| [x[1], -g].into())
        .mode("stance", move |_, x| [x[1], push(x[0]) / m - g, push(x[0])].into())
        .edge("flight", "stance", move |_, x| x[0] - l0, |_, x| [x[0], x[1], 0.0].into())
        .edge("stance", "flight", move |_, x| l0 - x[0], |_, x| [x[0], x[1]].into());
    let simulation = Simulation::of(&hopper).stepper(Dop853).tolerance(1e-14);
    let run = simulation.run("flight", [h, 0.0].into(), 0.0..800.0).unwrap();
    case.ran(&run.end.stats);
    assert_eq!(run.end.stop, Stop::Time);
    let jumps = run.trajectory.jumps();
    case.check("t_touchdown_1", jumps[0].t());
    case.check("stance_time", jumps[1].t() - jumps[0].t());
    case.check("period", jumps[2].t() - jumps[0].t());
    let middle = 0.5 * (jumps[0].t() + jumps[1].t());
    case.check("y_min", run.trajectory.at(middle).unwrap()[0]);
    // The ground turns the speed round: its impulse is that change of momentum and what gravity
    // takes meanwhile.
    let (down, up) = (jumps[0].before, jumps[1].before);
    let impulse = m * (up[1] - down[1]) + m * g * (jumps[1].t() - jumps[0].t());
    assert!((up[2] / impulse - 1.0).abs() < 1e-12, "{}", up[2] / impulse);
    // The apex after the thousandth stance, from the state at its lift-off.
    let lift = jumps[1999];
    let v = lift.after[1];
    case.check("t_apex_1000", lift.t() + v / g);
    case.check("apex_1000", lift.after[0] + v * v / (2.0 * g));
}

fn rimless_wheel(case: &mut Report) {
    let [g, spoke, half, slope, w0] = case.params(["g", "l", "al", "ga", "w0"]);
    let wheel = wheel::Wheel { g, spoke, half, slope };
    let map = ReturnMap::of(Simulation::of(&wheel).tolerance(1e-13), wheel::Impact(wheel));
    let gait = map.fixed_point([1.2]).unwrap();
    case.check("om_fixed", gait.q[0]);
    case.check("multiplier", gait.multipliers[0].re);
    case.check("period", gait.period);
    let impacts = walks(case, &wheel, (), vector![slope - half, w0], (), 12.0);
    for n in [1, 10] {
        case.check(&format!("om_{n}"), impacts[n - 1].after[1]);
        case.check(&format!("t_{n}"), impacts[n - 1].t());
    }
}

fn simplest_walker(case: &mut Report) {
    let walker = walker::Walker { slope: case.param("ga") };
    let map = ReturnMap::of(Simulation::of(&walker).tolerance(1e-14), walker::HeelStrike);
    let gait = map.fixed_point([0.201, -0.2]).unwrap();
    case.check("theta", gait.q[0]);
    case.check("theta_dot", gait.q[1]);
    case.check("step_time", gait.period);
    case.check("floquet_trace", gait.jacobian.trace());
    case.check("floquet_det", gait.jacobian.determinant());
    let multiplier = gait.multipliers[0];
    case.check("floquet_re", multiplier.re);
    case.check("floquet_im", multiplier.im);
    case.check("floquet_modulus", multiplier.norm());

    let start: [f64; 4] = walker::HeelStrike.place([0.201, -0.2], walker.parameters());
    let strikes = walks(case, &walker, walker::Swing::Behind, start.into(), walker::Event::HeelStrike, 200.0);
    case.check("theta_5", strikes[4].after[0]);
    case.check("theta_dot_5", strikes[4].after[2]);
    case.check("t_5", strikes[4].t());
}

fn mirror_juggling(case: &mut Report) {
    let [g, cor, gain, wanted] = case.params(["g", "e", "kap1", "eta_s"]);
    let juggler = juggler::Juggler { g, cor, gain, wanted };
    let hit = Selection::of((), ((), vector![0.0, 0.0]), [1]).unwrap();
    let steady = ReturnMap::of(Simulation::of(&juggler), hit).fixed_point([5.0]).unwrap();
    case.check("v_fixed", steady.q[0]);
    case.check("multiplier", steady.multipliers[0].re);
    case.check("period", steady.period);
    let hits = walks(case, &juggler, (), vector![0.5, 0.0], (), 100.0);
    for n in [5, 20] {
        case.check(&format!("t_{n}"), hits[n - 1].t());
        case.check(&format!("v_post_{n}"), hits[n - 1].after[1]);
    }
}
