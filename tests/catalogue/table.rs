//! A ball on a table that shakes: periodic orbits, chatter, sticking, lift-off.

use std::f64::consts::{PI, TAU};

use saltus::nalgebra::{Vector2, vector};
use saltus::return_map::{Continuation, Kind, ReturnMap};
use saltus::{JumpOf, RunOf, Simulation};
use saltus_bounce::effects::Gravity;
use saltus_bounce::walls::{Face, Table};
use saltus_bounce::{Cor, Event, Flyer, Moving, Stance};

use crate::report::Report;

#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/table.rs"]
mod example;

cases! {
    period_one = "table-p1";
    bifurcations = "table-bifurcation";
    transient = "table-transient";
    chatter = "table-chatter";
    liftoff = "table-liftoff";
}

type OnTable = Flyer<1, (), Gravity, Table>;

fn on_table(amplitude: f64, w: f64, g: f64, e: f64) -> OnTable {
    Flyer::new(Gravity::new(g).unwrap(), Table::new(amplitude, w).unwrap(), Cor::new(e).unwrap()).unwrap()
}

/// The ball of a case.
fn ball(case: &Report) -> OnTable {
    let [a, w, g, e] = case.params(["A", "w", "g", "e"]);
    on_table(a, w, g, e)
}

/// Thrown up from the table at the case's speed.
fn thrown(case: &mut Report, end: f64) -> RunOf<OnTable> {
    let start = Moving::new(vector![0.0], vector![case.param("v0")]);
    let run = Simulation::of(&ball(case)).run(Stance::FLIGHT, start, 0.0..end).unwrap();
    assert_eq!(run.end.stats.steps, 0);
    case.ran(&run.end.stats);
    run
}

fn meetings(run: &RunOf<OnTable>) -> Vec<JumpOf<OnTable>> {
    run.trajectory.jumps().iter().filter(|jump| matches!(jump.edge(), Some(Event::Meet(_)))).copied().collect()
}

/// By three hundred impacts, and by the return map and its derivative.
fn period_one(case: &mut Report) {
    let [amplitude, w, g, e] = case.params(["A", "w", "g", "e"]);
    let run = thrown(case, 40.0);
    let impacts = meetings(&run);
    let last = &impacts[309];
    let (phase, speed) = ((w * last.t()) % TAU, last.after.velocity[0]);
    case.check("phase_rad", phase);
    case.check("v_post", speed);
    case.check("period", last.time.since(impacts[308].time));
    case.check("gamma", amplitude * w * w / g);
    let [trace, determinant] = multipliers(&on_table(amplitude, w, g, e), [amplitude, w, g], phase, speed);
    case.check("floquet_modulus", determinant.sqrt());
    case.check("floquet_trace", trace);

    let table = example::Table { g, amplitude, omega: w, cor: e };
    let map = ReturnMap::of(Simulation::of(&table), example::Impact { table, periods: 1.0 });
    let orbit = map.fixed_point([1.2, 0.6]).unwrap();
    case.check("phase_rad", orbit.q[0]);
    case.check("v_post", orbit.q[1]);
    case.check("period", orbit.period);
    case.check("floquet_modulus", orbit.multipliers[0].norm());
    case.check("floquet_trace", orbit.jacobian.trace());
}

/// Trace and determinant of the map from impact to impact, in (phase, velocity after it), by
/// central differences of fourth order.
fn multipliers(ball: &OnTable, [amplitude, w, g]: [f64; 3], phase: f64, velocity: f64) -> [f64; 2] {
    let simulation = Simulation::of(ball).most_jumps(1);
    let map = |phase: f64, velocity: f64| {
        let start = Moving::new(vector![amplitude * phase.sin()], vector![velocity]);
        let from = phase / w;
        let run = simulation.run(Stance::FLIGHT, start, from..from + 10.0 / w * TAU).unwrap();
        let impact = &run.trajectory.jumps()[0];
        vector![w * impact.time.since(run.trajectory.start()) + phase, impact.after.velocity[0] * w / g]
    };
    let h = 1e-3;
    let derivative = |f: &dyn Fn(f64) -> Vector2<f64>| (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h);
    let by_phase = derivative(&|d| map(phase + d, velocity));
    let by_velocity = derivative(&|d| map(phase, velocity + d * g / w));
    [by_phase[0] + by_velocity[1], by_phase[0] * by_velocity[1] - by_phase[1] * by_velocity[0]]
}

/// Where the orbits of period n are born, and where they double, as the table is shaken harder: by
/// continuation, and where a multiplier of the known orbit is one or minus one.
fn bifurcations(case: &mut Report) {
    let (e, g, w) = (case.param("e"), 9.81, 50.0);
    for n in 1..=3_u32 {
        let turns = f64::from(n);
        let amplitude = |strength: f64| strength * g / (w * w);
        let table = example::Table { g, amplitude: amplitude(1.2 + 0.05 * turns), omega: w, cor: e };
        let map = ReturnMap::of(Simulation::of(&table).tolerance(1e-13), example::Impact { table, periods: turns });
        let branch = |to| {
            let family = |amplitude| example::Table { amplitude, ..table };
            let guess = [1.0, 0.5 * g * turns * TAU / w];
            Continuation::of(&map, family, 0).follow(guess, table.amplitude, amplitude(to)).unwrap()
        };
        let (down, up) = (branch(0.2), branch(2.0));
        let mut found: Vec<_> = down.bifurcations.iter().chain(&up.bifurcations).collect();
        found.sort_by(|a, b| a.point.parameter.total_cmp(&b.point.parameter));
        let at = |kind| found.iter().find(|found| found.kind == kind).unwrap().point.parameter * w * w / g;
        case.check(&format!("gamma_birth_{n}"), at(Kind::Fold));
        case.check(&format!("gamma_flip_{n}"), at(Kind::PeriodDoubling));

        // The orbit of period n has Γ cos φ = nπ (1 - e)/(1 + e) and leaves with v = nπ g/w.
        let gamma = |phase: f64| turns * PI * (1.0 - e) / (1.0 + e) / phase.cos();
        let of = |phase: f64| {
            let amplitude = amplitude(gamma(phase));
            multipliers(&on_table(amplitude, w, g, e), [amplitude, w, g], phase, turns * PI * g / w)
        };
        let test = |sign: f64| move |[trace, determinant]: [f64; 2]| 1.0 - sign * trace + determinant;
        case.check(&format!("gamma_birth_{n}"), gamma(root(|phase| test(1.0)(of(phase)), -0.01, 0.02)));
        case.check(&format!("gamma_flip_{n}"), gamma(root(|phase| test(-1.0)(of(phase)), 0.6, 1.4)));
    }
}

/// A root between a and b by regula falsi (Illinois).
fn root(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let (mut fa, mut fb) = (f(a), f(b));
    assert!(fa * fb < 0.0, "{fa} {fb}");
    for _ in 0..60 {
        let c = b - fb * (b - a) / (fb - fa);
        let fc = f(c);
        if fc == 0.0 || (c - b).abs() < 1e-13 {
            return c;
        }
        if fc * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (c, fc);
    }
    b
}

fn transient(case: &mut Report) {
    let run = thrown(case, 2.0);
    let impacts = meetings(&run);
    for n in [1, 3, 6, 12] {
        case.check(&format!("t_{n}"), impacts[n - 1].t());
        case.check(&format!("v_post_{n}"), impacts[n - 1].after.velocity[0]);
    }
}

fn chatter(case: &mut Report) {
    let run = thrown(case, 0.5);
    let (impacts, jumps) = (meetings(&run), run.trajectory.jumps());
    case.check("t_3", impacts[2].t());
    case.check("v_post_3", impacts[2].after.velocity[0]);
    let leave = jumps.iter().find(|jump| matches!(jump.edge(), Some(Event::Leave(_)))).unwrap();
    case.check("t_liftoff", leave.t());
    case.check("v_liftoff", leave.after.velocity[0]);
    let land = impacts.iter().find(|jump| jump.t() > leave.t()).unwrap();
    case.check("t_land", land.t());
    case.check("v_pre_land", land.before.velocity[0]);

    let absolute = "bounces slower than 1e-8 m/s rise by less than the rounding of absolute positions: they are not told from sticking";
    case.mark("n_vrel_1e-9", 0.5..40.5, absolute);
    case.mark("t_stick", 3e-12..1e-8, absolute);
    let [a, w] = case.params(["A", "w"]);
    let relative = |jump: &&JumpOf<OnTable>| jump.after.velocity[0] - a * w * (w * jump.t()).cos();
    let fast = impacts.iter().take_while(|jump| relative(jump) >= 1e-9);
    case.check("n_vrel_1e-9", 1.0 + fast.count() as f64);
    let stick = jumps.iter().find(|jump| matches!(jump.to, Stance::Slide { .. })).unwrap();
    case.check("t_stick", stick.t());
}

fn liftoff(case: &mut Report) {
    let [a, w] = case.params(["A", "w"]);
    let ball = ball(case);
    let lying = Moving::new(vector![0.0], vector![a * w]);
    let (stance, start) = ball.lying(Face { cell: 0, index: 0 }, 0.0, lying);
    assert!(matches!(stance, Stance::Slide { .. }));
    let run = Simulation::of(&ball).run(stance, start, 0.0..0.3).unwrap();
    case.ran(&run.end.stats);
    let jumps = run.trajectory.jumps();
    assert!(matches!(jumps[0].edge(), Some(Event::Leave(_))));
    case.check("t_liftoff", jumps[0].t());
    case.check("phase_liftoff", w * jumps[0].t());
    case.check("t_land", jumps[1].t());
    case.check("v_pre_land", jumps[1].before.velocity[0]);
    case.check("v_post_land", jumps[1].after.velocity[0]);
    case.check("t_2", jumps[2].t());
}
