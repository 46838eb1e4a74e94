//! Return maps against reference values of sixty digits; the models are those of the examples.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/juggler.rs"]
mod juggler;
#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/slip.rs"]
mod slip;
#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/table.rs"]
mod table;
#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/walker.rs"]
mod walker;
#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/wheel.rs"]
mod wheel;

use std::f64::consts::TAU;

use saltus::nalgebra::Vector3;
use saltus::return_map::{Continuation, End, Fate, Kind, MapError, ReturnMap, Section};
use saltus::{Automaton, Edges, Lift, Linearize, Number, Simulation};
use saltus_tests::reference::Case;

#[test]
fn the_simplest_walker() {
    let case = Case::named("walker-long");
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
    // Thirteen digits.
    assert!((gait.q[0] / 0.200_310_900_544_247_08 - 1.0).abs() < 5e-14, "{:?}", gait.q);
    assert!((gait.q[1] / -0.199_832_473_004_952_35 - 1.0).abs() < 5e-14, "{:?}", gait.q);

    let five = map.every(5).apply([0.201, -0.2]).unwrap();
    case.check("theta_5", five.q[0]);
    case.check("theta_dot_5", five.q[1]);
    case.check("t_5", five.duration);
}

#[test]
fn a_spring_mass_runner() {
    let case = Case::named("slip-stable");
    let runner = slip::Runner {
        mass: case.param("m"),
        stiffness: case.param("k"),
        leg: case.param("l0"),
        angle: case.param("al"),
        g: case.param("g"),
    };
    let apex = slip::Apex(runner, case.param("E"));
    let map = || ReturnMap::of(Simulation::of(&runner).tolerance(1e-13), apex);
    let stride = map().fixed_point([0.95]).unwrap();
    case.check("y_apex_fixed", stride.q[0]);
    case.check("stride_time", stride.period);
    case.check("multiplier", stride.multipliers[0].re);
    let [_, _, speed, ..]: [f64; 5] = apex.place(stride.q, [0.0; 2]);
    case.check("vx_apex", speed);
    for n in [1, 2, 10] {
        let back = map().every(n).apply([case.param("y0")]).unwrap();
        case.check(&format!("y_{n}"), back.q[0]);
        case.check(&format!("t_apex_{n}"), back.duration);
    }
}

#[test]
fn a_rimless_wheel() {
    let case = Case::named("rimless-wheel");
    let wheel =
        wheel::Wheel { g: case.param("g"), spoke: case.param("l"), half: case.param("al"), slope: case.param("ga") };
    let map = || ReturnMap::of(Simulation::of(&wheel).tolerance(1e-13), wheel::Impact(wheel));
    let gait = map().fixed_point([1.2]).unwrap();
    case.check("om_fixed", gait.q[0]);
    case.check("multiplier", gait.multipliers[0].re);
    case.check("period", gait.period);
    for n in [1, 10] {
        let back = map().every(n).apply([case.param("w0")]).unwrap();
        case.check(&format!("om_{n}"), back.q[0]);
        case.check(&format!("t_{n}"), back.duration);
    }
}

#[test]
fn a_paddle_juggler() {
    let case = Case::named("mirror-juggling");
    let juggler = juggler::Juggler {
        g: case.param("g"),
        cor: case.param("e"),
        gain: case.param("kap1"),
        wanted: case.param("eta_s"),
    };
    let steady = ReturnMap::of(Simulation::of(&juggler), juggler::Hit).fixed_point([5.0]).unwrap();
    case.check("v_fixed", steady.q[0]);
    case.check("multiplier", steady.multipliers[0].re);
}

fn vibrating(case: &Case, amplitude: f64) -> table::Table {
    table::Table { g: 9.81, amplitude, omega: 50.0, cor: case.param("e") }
}

#[test]
fn a_ball_on_a_vibrating_table() {
    let case = Case::named("table-p1");
    let table = table::Table { omega: case.param("w"), g: case.param("g"), ..vibrating(&case, case.param("A")) };
    let map = ReturnMap::of(Simulation::of(&table), table::Impact { table, periods: 1.0 });
    let orbit = map.fixed_point([1.2, 0.6]).unwrap();
    case.check("phase_rad", orbit.q[0]);
    case.check("v_post", orbit.q[1]);
    case.check("period", orbit.period);
    case.check("floquet_modulus", orbit.multipliers[0].norm());
    case.check("floquet_trace", orbit.jacobian.trace());
    let case = Case::named("saltation-table");
    case.check("monodromy_trace", orbit.jacobian.trace());
    case.check("monodromy_det", orbit.jacobian.determinant());
}

#[test]
fn births_and_period_doublings_on_the_table() {
    let case = Case::named("table-bifurcation");
    for n in 1..=3_u32 {
        let amplitude = |strength: f64| strength * 9.81 / 2500.0;
        let table = vibrating(&case, amplitude(1.2 + 0.05 * f64::from(n)));
        let periods = f64::from(n);
        let map = ReturnMap::of(Simulation::of(&table).tolerance(1e-13), table::Impact { table, periods });
        let branch = |to| {
            let guess = [1.0, 0.5 * 9.81 * periods * TAU / 50.0];
            let family = |amplitude| table::Table { amplitude, ..table };
            Continuation::of(&map, family, 0).follow(guess, table.amplitude, amplitude(to)).unwrap()
        };
        let (down, up) = (branch(0.2), branch(2.0));
        let mut found: Vec<_> = down.bifurcations.iter().chain(&up.bifurcations).collect();
        found.sort_by(|a, b| a.point.parameter.total_cmp(&b.point.parameter));
        let at = |kind| found.iter().find(|found| found.kind == kind).unwrap().point.parameter * 2500.0 / 9.81;
        case.check(&format!("gamma_birth_{n}"), at(Kind::Fold));
        case.check(&format!("gamma_flip_{n}"), at(Kind::PeriodDoubling));
    }
}

#[test]
fn questions_without_an_answer() {
    let wheel = wheel::Wheel { g: 9.81, spoke: 1.0, half: 0.4, slope: 0.001 };
    let map = ReturnMap::of(Simulation::of(&wheel), wheel::Impact(wheel));
    // Too slow for the slope: it falls back and never comes to the next spoke.
    assert!(matches!(map.fixed_point([0.1]), Err(MapError::NoReturn { .. })));
    let family = |slope| wheel::Wheel { slope, ..wheel };
    for (parameter, to) in [(1, 0.1), (0, 0.001), (0, f64::NAN)] {
        let error = Continuation::of(&map, family, parameter).follow([1.0], 0.001, to).unwrap_err();
        assert!(matches!(error, MapError::Question(_)), "{error}");
    }
}

/// x'' = cos ωt - x - 2ζx', a wall at `wall`; beside place and velocity the time since the period began.
#[derive(Clone, Copy, Debug)]
struct Oscillator {
    wall: f64,
    omega: f64,
    damping: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Meets {
    Wall,
    Period,
}

impl Linearize for Oscillator {
    type Parameters = [f64; 1];

    fn parameters(&self) -> [f64; 1] {
        [self.wall]
    }
    fn flow_over<D: Number>(&self, (): (), _: D, [x, v, s]: [D; 3], _: [D; 1]) -> [D; 3] {
        [v, (s * self.omega).cos() - x - v * (2.0 * self.damping), D::one()]
    }
    fn guard_over<D: Number>(&self, meets: Meets, _: D, [x, _, s]: [D; 3], [wall]: [D; 1]) -> D {
        if meets == Meets::Wall { wall - x } else { -s + TAU / self.omega }
    }
    fn reset_over<D: Number>(&self, meets: Meets, _: D, [x, v, s]: [D; 3], _: [D; 1]) -> [D; 3] {
        if meets == Meets::Wall { [x, v * -0.8, s] } else { [x, v, D::zero()] }
    }
}

impl Automaton for Oscillator {
    type Mode = ();
    type State = Vector3<f64>;
    type Edge = Meets;

    fn flow(&self, mode: (), t: f64, x: &Vector3<f64>) -> Vector3<f64> {
        self.flow_at(mode, t, x)
    }
    fn edges(&self, (): ()) -> Edges<Meets> {
        Edges::from([Meets::Wall, Meets::Period])
    }
    fn guard(&self, meets: Meets, t: f64, x: &Vector3<f64>) -> f64 {
        self.guard_at(meets, t, x)
    }
    fn affine(&self, _: Meets) -> bool {
        true
    }
    fn reset(&self, meets: Meets, t: f64, x: &Vector3<f64>) -> ((), Vector3<f64>) {
        ((), self.reset_over(meets, t, x.over(), self.parameters()).into())
    }
}

struct Strobe;

impl Section<Oscillator, 2> for Strobe {
    fn edge(&self) -> Meets {
        Meets::Period
    }
    fn start(&self) -> ((), Vector3<f64>) {
        ((), Vector3::zeros())
    }
    fn place<D: Number>(&self, [x, v]: [D; 2], _: [D; 1]) -> [D; 3] {
        [x, v, D::zero()]
    }
    fn read<D: Number>(&self, _: D, [x, v, _]: [D; 3], _: [D; 1]) -> [D; 2] {
        [x, v]
    }
}

/// The wall comes nearer until the free swing touches it: at the swing's amplitude.
#[test]
fn a_wall_that_is_grazed() {
    let oscillator = Oscillator { wall: 3.0, omega: 0.8, damping: 0.1 };
    let Oscillator { omega, damping, .. } = oscillator;
    let map = ReturnMap::of(Simulation::of(&oscillator).tolerance(1e-12), Strobe);
    let family = |wall| Oscillator { wall, ..oscillator };
    let branch = Continuation::of(&map, family, 0).follow([1.0, 1.0], 3.0, 1.0).unwrap();
    assert_eq!(branch.end, End::Grazing { edge: Meets::Wall });
    let amplitude = 1.0 / (1.0 - omega * omega).hypot(2.0 * damping * omega);
    let last = branch.points.last().unwrap();
    assert!((last.parameter - amplitude).abs() < 1e-9, "{} {amplitude}", last.parameter);
    // Damping alone shrinks areas.
    let product = last.orbit.jacobian.determinant();
    assert!((product - (-2.0 * damping * TAU / omega).exp()).abs() < 1e-10);
}

#[test]
fn fates_of_starts() {
    let wheel = wheel::Wheel { g: 9.81, spoke: 1.0, half: std::f64::consts::FRAC_PI_8, slope: 0.08 };
    let map = ReturnMap::of(Simulation::of(&wheel).most_steps(2000), wheel::Impact(wheel));
    let gait = map.fixed_point([1.2]).unwrap();
    let fates = map.fates(&[[gait.q[0]], [2.0], [0.3]], &[gait], [1e-3], 40);
    let fates: Vec<Fate> = fates.into_iter().map(Result::unwrap).collect();
    assert_eq!((fates[0], fates[2]), (Fate::Attracted { to: 0, returns: 0 }, Fate::Lost { returns: 0 }));
    // Half of the excess of ω² is left after each step: 2.8 of it becomes less than 2e-3 ω.
    assert_eq!(fates[1], Fate::Attracted { to: 0, returns: 11 });
}
