//! Contact that takes time: its cost, its rigid limit, what it loses.

use proptest::prelude::*;
use saltus::nalgebra::Vector2;
use saltus::{Auto, Dop853, Rodas5P, Run, RunOf, Simulation, Stop, Tsit5};
use saltus_bounce::compliant::{Moment, Stage};
use saltus_bounce::contact::{ContactLaw, Hertz, HuntCrossley, KelvinVoigt};
use saltus_bounce::{Compliant, Cor, Drop};
use saltus_cases::cases;

/// A run by steps that are as exact as they get.
fn tight<L: ContactLaw>(ball: &Compliant<L>, stage: Stage, start: Vector2<f64>, end: f64) -> RunOf<Compliant<L>> {
    let simulation = Simulation::of(ball).stepper(Auto::from(Dop853)).tolerance(1e-14).absolute_tolerance(1e-20);
    simulation.run(stage, start, 0.0..end).unwrap()
}

/// The speed and deformation at lift-off.
fn released(run: &Run<Stage, Moment, Vector2<f64>>) -> Vector2<f64> {
    run.trajectory.jumps().iter().find(|jump| jump.edge() == Some(Moment::LiftOff)).unwrap().before
}

/// What a contact at 10¹² in the law's own unit costs, and how far the COR is from the one
/// announced.
fn stiffest<L: ContactLaw>(law: L, stepper: Auto, tolerance: f64) -> (u64, f64) {
    let ball = Compliant::new(0.1, 0.0, law).unwrap();
    let (stage, start) = ball.released(0.2, -2.0);
    let simulation = Simulation::of(&ball).stepper(stepper).tolerance(tolerance).absolute_tolerance(tolerance * 1e-6);
    let run = simulation.run(stage, start, 0.0..0.21).unwrap();
    let contact = ball.contacts(&run.trajectory)[0];
    let announced = ball.law().collision(0.1, contact.speed).unwrap();
    (run.end.stats.steps, (contact.cor.unwrap() - announced.cor.value()).abs())
}

/// Every law at 10¹² in its own unit of stiffness: fewer than 500 steps a contact, and the
/// announced COR.
#[test]
fn the_stiffest_contacts() {
    fn each(stepper: Auto, tolerance: f64, allowed: [u64; 4]) {
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
    each(Tsit5.into(), 1e-6, [0, 30, 30, 60]);
    each(Rodas5P.into(), 1e-6, [0, 40, 40, 80]);
    each(Dop853.into(), 1e-9, [0, 35, 35, 65]);
    each(Tsit5.into(), 1e-9, [0, 100, 100, 200]);
    each(Rodas5P.into(), 1e-9, [0, 130, 140, 280]);
    each(Dop853.into(), 1e-12, [0, 70, 70, 140]);
}

/// The third contact of a ball dropped from 1 m comes later than without deformation, in proportion
/// to the duration of a contact.
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
    #![proptest_config(ProptestConfig { cases: cases(100), failure_persistence: None, ..ProptestConfig::default() })]

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

proptest! {
    /// From any height a recorded run goes on through its contacts, in pieces that their number and
    /// the time ask for.
    #[test]
    fn the_lowest_drops_go_on(height in -16.0..1.0, zeta in 0.01..3.0, tension in any::<bool>()) {
        let (m, k, g, height) = (0.1, 1e4_f64, 9.81, 10f64.powf(height));
        let law = KelvinVoigt::new(k, 2.0 * zeta * (k * m).sqrt()).unwrap();
        let ball = Compliant::new(m, g, if tension { law.with_tension() } else { law }).unwrap();
        let (stage, start) = ball.released(height, 0.0);
        let touch = (2.0 * height / g).sqrt();
        let end = touch + 0.5;
        let run = Simulation::of(&ball).most_steps(5000).run(stage, start, 0.0..end).unwrap();
        prop_assert_eq!(run.end.time.seconds(), end, "{}", run.end.stop);
        let first = ball.contacts(&run.trajectory)[0];
        prop_assert!((first.touch - touch).abs() <= 8.0 * f64::EPSILON * touch, "{first:?}");
        prop_assert!((first.speed - g * touch).abs() <= 8.0 * f64::EPSILON * g * touch, "{first:?}");
    }
}
