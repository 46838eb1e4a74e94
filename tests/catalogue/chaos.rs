//! Billiards and a map: what doubles can follow, and for how long.

use saltus::nalgebra::vector;
use saltus::{Hybrid, Jump, Polynomial, Simulation};
use saltus_bounce::effects::Gravity;
use saltus_bounce::walls::{Cuboid, Ground, Round};
use saltus_bounce::{Cor, Flyer, Moving, Stance};

use crate::report::Report;
use crate::samples::Samples;

cases! {
    sinai = "sinai";
    parabola = "parabola";
    doubling_map = "doubling-map";
}

/// Place and velocity at the start of a case.
fn start(case: &Report) -> Moving<2> {
    let [x, y, u, w] = case.params(["x", "y", "u", "w"]);
    Moving::new(vector![x, y], vector![u, w])
}

fn sinai(case: &mut Report) {
    let walls = (
        Cuboid::between(vector![-1.0, -1.0], vector![1.0, 1.0]).unwrap(),
        Round::obstacle(vector![0.0, 0.0], case.param("R")).unwrap(),
    );
    let ball = Flyer::new((), walls, Cor::new(1.0).unwrap()).unwrap();
    let start = start(case);
    let run = Simulation::of(&ball).run(Stance::FLIGHT, start, 0.0..200.0).unwrap();
    case.ran(&run.end.stats);
    let impacts = run.trajectory.jumps();
    for n in [5, 10, 20, 30] {
        let impact = &impacts[n - 1];
        case.check(&format!("t_{n}"), impact.t());
        case.check(&format!("x_{n}"), impact.after.position[0]);
        case.check(&format!("y_{n}"), impact.after.position[1]);
    }
    // What is kept for ever, however wrong the places are.
    let (mut drift, speed) = (0.0_f64, start.velocity.norm());
    let mut watch = Samples::new(&[], &[], |jump: &Jump<_, _, _>| {
        let x: &Moving<2> = &jump.after;
        drift = drift.max((x.velocity.norm() / speed - 1.0).abs());
        assert!(x.position.amax() <= 1.0 + 1e-12 && x.position.norm() >= 0.4 - 1e-12, "{x:?}");
    });
    let simulation = Simulation::of(&ball).most_jumps(10_000);
    let end = simulation.drive(Stance::FLIGHT, start, 0.0..f64::MAX, &mut watch).unwrap();
    case.ran(&end.stats);
    assert_eq!(end.jumps, 10_000);
    case.check("speed_drift", drift);
    // Back after thirty collisions and thirty more: the amplification of rounding is 10^10 by then.
    let there = impacts[29];
    let back = Moving::new(there.before.position, -there.before.velocity);
    let run = Simulation::of(&ball).run(Stance::FLIGHT, back, 0.0..there.t()).unwrap();
    case.ran(&run.end.stats);
    let off = (run.end.state.position - start.position).norm();
    let returned = run.trajectory.jumps().len() == 29 && off < 100.0 * f64::EPSILON * 9.5e9;
    let accepted = "back at the start within 100*eps*amplification(n) after n forward and n reversed collisions";
    case.outcome("reversal", if returned { accepted.into() } else { format!("{off:e} away") });
}

/// Energy, and what separation in parabolic coordinates about the focus keeps.
fn invariants(g: f64, x: &Moving<2>) -> [f64; 2] {
    let ([px, py], [u, w]) = (<[f64; 2]>::from(x.position), <[f64; 2]>::from(x.velocity));
    [0.5 * (u * u + w * w) + g * py, u * (px * w - py * u) + 0.5 * g * px * px]
}

fn parabola(case: &mut Report) {
    let g = case.param("g");
    let ground = Ground::new(|x: f64| 0.5 * (x * x - 1.0), |x| x, |_| 1.0);
    let ball = Flyer::new(Gravity::new(g).unwrap(), ground, Cor::new(1.0).unwrap()).unwrap();
    let start = start(case);
    let [energy, beta] = invariants(g, &start);
    case.check("energy", energy);
    case.check("beta", beta);
    let (mut drift, numbers) = ([0.0_f64; 2], [1, 10, 100, 1000]);
    let mut watch = Samples::new(&numbers, &[], |jump: &Jump<_, _, _>| {
        for (drift, (now, start)) in drift.iter_mut().zip(invariants(g, &jump.after).into_iter().zip([energy, beta])) {
            *drift = drift.max((now / start - 1.0).abs());
        }
    });
    let end = Simulation::of(&ball).most_jumps(100_000).drive(Stance::FLIGHT, start, 0.0..1e6, &mut watch).unwrap();
    case.ran(&end.stats);
    assert_eq!(end.jumps, 100_000);
    for n in numbers {
        case.check(&format!("t_{n}"), watch.jump(n).t());
        case.check(&format!("x_{n}"), watch.jump(n).after.position[0]);
    }
    case.check("rel_drift_energy_1e5", drift[0]);
    case.check("rel_drift_beta_1e5", drift[1]);
}

/// Every operation is exact, so the orbit is that of the binary number it starts from: to the bit,
/// until its digits have run out.
fn doubling_map(case: &mut Report) {
    let map = Hybrid::new()
        .exact("run", |_t, x: &[f64; 2]| Polynomial::from([*x, [1.0, 0.0]]))
        .edge("run", "run", |_t, x| 1.0 - x[0], |_t, x| [0.0, (2.0 * x[1]).rem_euclid(1.0)])
        .affine();
    let run = Simulation::of(&map).run("run", [0.0, case.param("x0")], 0.0..60.0).unwrap();
    case.ran(&run.end.stats);
    let jumps = run.trajectory.jumps();
    for n in [10, 40, 52, 60] {
        case.check(&format!("x_{n}"), jumps[n - 1].after[1]);
    }
    case.check("n_zero", jumps.iter().find(|jump| jump.after[1] == 0.0).unwrap().j as f64);
}
