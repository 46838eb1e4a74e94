//! Contact that takes time, against references and against the rigid limit.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::fmt::Debug;

use proptest::prelude::*;
use saltus::nalgebra::{Vector2, vector};
use saltus::step::Stepper;
use saltus::{Dop853, Rodas5P, Run, Simulation, Stop, Tsit5};
use saltus_bounce::compliant::{Contact, Moment, Stage};
use saltus_bounce::contact::{ContactLaw, Hertz, HuntCrossley, KelvinVoigt};
use saltus_bounce::{Compliant, Cor, Drop};
use saltus_tests::reference::Case;

/// A run by steps that are as exact as they get.
fn tight<L: ContactLaw>(ball: &Compliant<L>, stage: Stage, start: Vector2<f64>, end: f64) -> Run<Compliant<L>> {
    let simulation = Simulation::of(ball).stepper(Dop853).tolerance(1e-14).absolute_tolerance(1e-20);
    simulation.run(stage, start, 0.0..end).unwrap()
}

/// A ball without gravity that touches the floor at t = 0.
fn hit<L: ContactLaw>(mass: f64, law: L, speed: f64, end: f64) -> (Run<Compliant<L>>, Contact) {
    let ball = Compliant::new(mass, 0.0, law).unwrap();
    let run = tight(&ball, Stage::Compression, vector![0.0, -speed], end);
    let contact = ball.contacts(&run.trajectory)[0];
    (run, contact)
}

/// The speed and deformation at lift-off.
fn released<L: ContactLaw>(run: &Run<Compliant<L>>) -> Vector2<f64> {
    run.trajectory.jumps().iter().find(|jump| jump.edge() == Some(Moment::LiftOff)).unwrap().before
}

#[test]
fn hertz() {
    for name in ["hertz-1e3", "hertz-1e9", "hertz-1e12"] {
        let case = Case::named(name);
        let (m, k, v) = (case.param("m"), case.param("k"), case.param("v"));
        let (run, contact) = hit(m, Hertz::new(k).unwrap(), v, 1.0);
        let duration = contact.duration.unwrap();
        case.check("t_release", duration);
        case.check("d_max", contact.deformation);
        case.check("t_max", contact.compression.unwrap());
        case.check("u_out", -released(&run)[1]);
        case.check("F_max", contact.force);
        case.check("separation(1)", run.state[0]);
        case.check("const_A", duration / (m * m / (k * k * v)).powf(0.2));
        case.check("const_2.94", duration * v / contact.deformation);
        assert!(run.stats.steps < 500, "{name}: {:?}", run.stats);
    }
}

#[test]
fn hertz_with_gravity() {
    let case = Case::named("hertz-gravity");
    let [g, m, k, h] = ["g", "m", "k", "h"].map(|name| case.param(name));
    let ball = Compliant::new(m, g, Hertz::new(k).unwrap()).unwrap();
    let (stage, start) = ball.released(h, 0.0);
    let run = tight(&ball, stage, start, 2.5);
    let contacts = ball.contacts(&run.trajectory);
    case.check("t_contact_1", contacts[0].touch);
    case.check("contact_duration", contacts[0].duration.unwrap());
    case.check("penetration_max", contacts[0].deformation);
    let lift_off = run.trajectory.jumps().iter().find(|jump| jump.to == Stage::Rise).unwrap();
    case.check("t_release_1", lift_off.t());
    case.check("t_contact_4", contacts[3].touch);
    let apexes: Vec<_> = run.trajectory.jumps().iter().filter(|j| j.edge() == Some(Moment::Apex)).collect();
    case.check("apex_3", apexes[2].before[0]);
    assert!(run.stats.steps < 500 * contacts.len() as u64, "{:?}", run.stats);
}

#[test]
fn kelvin_voigt() {
    for name in ["kv-soft", "kv-hard", "kv-critical"] {
        let case = Case::named(name);
        let [m, k, c, v] = ["m", "k", "c", "v"].map(|name| case.param(name));
        let law = KelvinVoigt::new(k, c).unwrap();
        case.check("zeta", law.damping_ratio(m));
        let (run, contact) = hit(m, law, v, 1.0);
        case.check("t_max", contact.compression.unwrap());
        case.check("d_max", contact.deformation);
        case.check("B_t_release", contact.duration.unwrap());
        case.check("B_cor", contact.cor.unwrap());
        case.check("B_d_release", -released(&run)[0]);
        assert_eq!((run.stats.steps, run.mode), (0, Stage::Rise));
        let (run, contact) = hit(m, law.with_tension(), v, 1.0);
        if name == "kv-critical" {
            case.check("A_n_release", f64::from(u8::from(contact.duration.is_some())));
            assert_eq!(run.mode, Stage::Restitution);
        } else {
            case.check("A_t_release", contact.duration.unwrap());
            case.check("A_cor", contact.cor.unwrap());
        }
    }
}

#[test]
fn kelvin_voigt_settles() {
    let case = Case::named("kv-settle");
    let [g, m, k, c, h] = ["g", "m", "k", "c", "h"].map(|name| case.param(name));
    let ball = Compliant::new(m, g, KelvinVoigt::new(k, c).unwrap().with_tension()).unwrap();
    let (stage, start) = ball.released(h, 0.0);
    let run = Simulation::of(&ball).run(stage, start, 0.0..5.0).unwrap();
    let contacts = ball.contacts(&run.trajectory);
    case.check("n_contacts", contacts.len() as f64);
    case.check("t_contact_1", contacts[0].touch);
    case.check("x_min_1", -contacts[0].deformation);
    case.check("v_contact_2", -contacts[1].speed);
    case.check("t_contact_2", contacts[1].touch);
    case.check("t_contact_5", contacts[4].touch);
    case.check("t_contact_last", contacts[6].touch);
    case.check("x(5)", run.state[0]);
    case.check("x_static", run.state[0]);
    assert_eq!((run.mode, run.stop, run.stats.steps), (Stage::Lying, Stop::Time, 0));
    assert_eq!((contacts[6].cor, contacts[6].duration), (None, None));
}

#[test]
fn hunt_crossley() {
    for name in ["hunt-crossley", "hunt-crossley-strong"] {
        let case = Case::named(name);
        let [m, k, chi, v] = ["m", "k", "chi", "v"].map(|name| case.param(name));
        let (run, contact) = hit(m, HuntCrossley::new(k, chi).unwrap(), v, 1.0);
        case.check("dim_less_damping", chi * v / k);
        case.check("cor", contact.cor.unwrap());
        case.check("u_out", -released(&run)[1]);
        case.check("d_max", contact.deformation);
        case.check("t_max", contact.compression.unwrap());
        case.check("t_release", contact.duration.unwrap());
        assert!(run.stats.steps < 500, "{name}: {:?}", run.stats);
    }
}

/// What a contact at 10¹² in the law's own unit costs, and how far the COR is from the one announced.
fn stiffest<L: ContactLaw>(law: L, stepper: impl Stepper, tolerance: f64) -> (u64, f64) {
    let ball = Compliant::new(0.1, 0.0, law).unwrap();
    let (stage, start) = ball.released(0.2, -2.0);
    let simulation = Simulation::of(&ball).stepper(stepper).tolerance(tolerance).absolute_tolerance(tolerance * 1e-6);
    let run = simulation.run(stage, start, 0.0..0.21).unwrap();
    let contact = ball.contacts(&run.trajectory)[0];
    let announced = ball.law().collision(0.1, contact.speed).unwrap();
    (run.stats.steps, (contact.cor.unwrap() - announced.cor.value()).abs())
}

/// Every law at 10¹² in its own unit of stiffness: fewer than 500 steps a contact, and the announced COR.
#[test]
fn the_stiffest_contacts() {
    fn each(stepper: impl Stepper + Debug, tolerance: f64, allowed: [u64; 4]) {
        let costs = [
            stiffest(KelvinVoigt::new(1e12, 1e5).unwrap(), stepper, tolerance),
            stiffest(Hertz::new(1e12).unwrap(), stepper, tolerance),
            stiffest(HuntCrossley::new(1e12, 2.5e11).unwrap(), stepper, tolerance),
            stiffest(HuntCrossley::new(1e12, 1e13).unwrap(), stepper, tolerance),
        ];
        println!("{stepper:?} {tolerance:e}: {costs:?}");
        for ((steps, off), allowed) in costs.into_iter().zip(allowed) {
            assert!(steps <= allowed && off <= 20.0 * tolerance + 1e-14, "{stepper:?} {tolerance:e}: {costs:?}");
        }
    }
    each(Tsit5, 1e-6, [0, 30, 30, 60]);
    each(Rodas5P, 1e-6, [0, 40, 40, 80]);
    each(Dop853, 1e-9, [0, 35, 35, 65]);
    each(Tsit5, 1e-9, [0, 100, 100, 200]);
    each(Rodas5P, 1e-9, [0, 130, 140, 280]);
    each(Dop853, 1e-12, [0, 70, 70, 140]);
}

/// The third contact of a ball dropped from 1 m comes later than without deformation, in proportion to the duration of a contact.
#[test]
fn rigid_impacts_are_the_limit() {
    let (g, m) = (9.81, 0.1);
    let late = |k: f64, linear: bool| {
        if linear {
            // ζ is the same at every stiffness, and so is e.
            let law = KelvinVoigt::new(k, 0.1 * (k * m).sqrt()).unwrap();
            let e = law.collision(m, 1.0).unwrap().cor;
            let ball = Compliant::new(m, g, law).unwrap();
            let (stage, start) = ball.released(1.0, 0.0);
            let run = Simulation::of(&ball).run(stage, start, 0.0..4.0).unwrap();
            ball.contacts(&run.trajectory)[2].touch - Drop::new(1.0, g, e).impact_time(3)
        } else {
            let ball = Compliant::new(m, g, Hertz::new(k).unwrap()).unwrap();
            let (stage, start) = ball.released(1.0, 0.0);
            let run = tight(&ball, stage, start, 4.0);
            ball.contacts(&run.trajectory)[2].touch - Drop::new(1.0, g, Cor::new(1.0).unwrap()).impact_time(3)
        }
    };
    for (linear, order) in [(true, 0.5), (false, 0.4)] {
        let delays = [1e4, 1e6, 1e8, 1e10].map(|k| late(k, linear));
        let orders: Vec<_> = delays.windows(2).map(|pair| (pair[0] / pair[1]).log10() / 2.0).collect();
        println!("{delays:?} {orders:?}");
        assert!((orders[2] - order).abs() < 1e-2, "{orders:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    /// The area of the loop is the energy lost, under gravity too; no contact gains energy.
    #[test]
    fn hysteresis(zeta in 0.01..0.9_f64, log_k in 3.0..9.0_f64, h in 0.01..2.0_f64, law in 0..3_u8) {
        fn check<L: ContactLaw>(law: L, h: f64) -> Result<(), TestCaseError> {
            let (m, g) = (0.3, 9.81);
            let ball = Compliant::new(m, g, law).unwrap();
            let (stage, start) = ball.released(h, 0.0);
            let fall = (2.0 * h / g).sqrt();
            let run = tight(&ball, stage, start, 2.0 * fall);
            let contact = ball.contacts(&run.trajectory)[0];
            let Some(cor) = contact.cor else { return Ok(()) };
            prop_assert!(cor <= 1.0);
            let points = ball.hysteresis(&run.trajectory, &contact, 2000);
            let area: f64 = points.windows(2).map(|p| 0.5 * (p[0][1] + p[1][1]) * (p[1][0] - p[0][0])).sum();
            let end = released(&run);
            let lost = 0.5 * m * (contact.speed * contact.speed - end[1] * end[1]) - m * g * end[0];
            prop_assert!((area - lost).abs() < 2e-5 * (0.5 * m * contact.speed * contact.speed), "{area} {lost}");
            prop_assert!(points.iter().all(|p| p[0] >= 0.0 && p[0] <= contact.deformation * (1.0 + 1e-12)));
            prop_assert!(points.iter().all(|p| p[1] <= contact.force * (1.0 + 1e-9)));
            Ok(())
        }
        let (k, m) = (10.0_f64.powf(log_k), 0.3_f64);
        match law {
            0 => check(KelvinVoigt::new(k, 2.0 * zeta * (k * m).sqrt()).unwrap(), h)?,
            1 => check(KelvinVoigt::new(k, 2.0 * zeta * (k * m).sqrt()).unwrap().with_tension(), h)?,
            _ => check(HuntCrossley::new(k, zeta * k).unwrap(), h)?,
        }
    }

    /// A lossy ball flies finitely often, and then lies at the static deformation.
    #[test]
    fn settling(zeta in 0.02..3.0_f64, log_k in 2.0..7.0_f64, h in 0.0..1.0_f64, tension in any::<bool>()) {
        let (k, m, g) = (10.0_f64.powf(log_k), 0.3_f64, 9.81);
        let law = KelvinVoigt::new(k, 2.0 * zeta * (k * m).sqrt()).unwrap();
        let ball = Compliant::new(m, g, if tension { law.with_tension() } else { law }).unwrap();
        let (stage, start) = ball.released(h, 0.0);
        let end = Simulation::of(&ball).drive(stage, start, 0.0..300.0, &mut ()).unwrap();
        prop_assert!(end.mode.is_contact() && end.stop == Stop::Time, "{:?}", end.mode);
        let rest = m * g / k;
        prop_assert!((end.state[0] + rest).abs() <= 1e-12 * rest + 1e-15 && end.state[1].abs() < 1e-12, "{:?}", end.state);
        let run = Simulation::of(&ball).run(stage, start, 0.0..1.0).unwrap();
        let contacts = ball.contacts(&run.trajectory);
        prop_assert!(contacts.windows(2).all(|pair| pair[1].touch > pair[0].touch));
        prop_assert!(contacts.iter().all(|contact| contact.cor.is_none_or(|e| (0.0..=1.0).contains(&e))));
    }
}
