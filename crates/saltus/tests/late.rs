//! Slides and plastic contacts at late times, where one spacing of time moves what holds them.

use proptest::prelude::*;
use saltus::{Clock, Entry, Filippov, Hybrid, Passage, Side, Sides, Simulation, Stop};
use saltus_cases::cases;

use crate::methods::methods;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(400)))]

    /// A relay under a sine leaves its slide where the drive is stronger than it, once.
    #[test]
    fn a_relay_is_left_once(
        power in 0.0..9.0_f64,
        drive in 1.05..3.0_f64,
        rate in 0.2..100.0_f64,
        surface in prop_oneof![Just(0.0), Just(0.3), -5.0..5.0_f64],
        method in 0..4_usize,
    ) {
        let start = 10_f64.powf(power).floor();
        // A spacing of time is a small part of the drive's turn.
        let rate = rate.min(1e-7 / start.max(1.0) / f64::EPSILON);
        let force = move |t: f64| drive * (rate * (t - start)).sin();
        let relay = Filippov::of(Sides::new(
            move |t, _: &f64| force(t) - 1.0,
            move |t, _: &f64| force(t) + 1.0,
            move |_, x| x - surface,
            |_, _| 1.0,
        ));
        let simulation = Simulation::of(&relay).stepper(methods()[method]);
        let run = simulation.run(Side::Sliding, surface, start..start + 1.5 / rate).unwrap();
        prop_assert_eq!((run.end.stop, run.end.mode), (Stop::Time, Side::Above));
        prop_assert_eq!(run.trajectory.jumps().len(), 1);
        let left = run.trajectory.jumps()[0].time.since(saltus::Time::new(start));
        prop_assert!((left * rate - (1.0 / drive).asin()).abs() < 1e-6, "{left}");
    }

    /// A brake is let go for a while: without a drive nothing moves, with one the slide is left in
    /// the very stop.
    #[test]
    fn a_brake_is_let_go_between_two_stops(
        power in -1.0..9.0_f64,
        from in 1.0..8.0_f64,
        lasts in 0.5..2.0_f64,
        drive in prop_oneof![Just(0.0), 0.1..1.0_f64],
        method in 0..4_usize,
    ) {
        let start = if power < 0.0 { 0.0 } else { 10_f64.powf(power).floor() };
        let (on, off) = (start + from, start + from + lasts);
        let brake = move |t: f64| if t > on && t < off { 0.0 } else { 2.0 };
        let wheel = Filippov::of(
            Sides::new(move |t, _: &f64| drive - brake(t), move |t, _: &f64| drive + brake(t), |_, v| *v, |_, _| 1.0)
                .stops(Clock::at([on, off])),
        );
        let simulation = Simulation::of(&wheel).stepper(methods()[method]);
        let run = simulation.run(Side::Sliding, 0.0, start..start + 20.0).unwrap();
        prop_assert_eq!((run.end.stop, run.end.mode), (Stop::Time, Side::Sliding));
        let passed: Vec<_> = run.trajectory.jumps().iter().filter_map(saltus::Jump::edge).collect();
        if drive == 0.0 {
            prop_assert_eq!(passed, vec![]);
        } else {
            prop_assert_eq!(passed, vec![Passage::LeaveAbove, Passage::FromAbove]);
        }
    }

    /// A ball that does not rebound is let go by a table that shakes, and rests where it lands,
    /// though the table moves on by more than a rounding within each spacing of time.
    #[test]
    fn a_plastic_ball_on_a_table_rests(
        power in 3.0..6.3_f64,
        strength in 1.05..2.0_f64,
        rate in 2.0..8.0_f64,
        cor in prop_oneof![Just(0.0), Just(0.01)],
        part in 0.01..0.1_f64,
        method in 0..4_usize,
    ) {
        let start = 10_f64.powf(power);
        let size = strength * 9.81 / (rate * rate);
        let place = move |t: f64| size * (rate * (t - start)).sin();
        let speed = move |t: f64| size * rate * (rate * (t - start)).cos();
        let force = move |t: f64| -size * rate * rate * (rate * (t - start)).sin();
        let table = Hybrid::new()
            .mode("flies", |_, x: &[f64; 2]| [x[1], -9.81])
            .edge("flies", "flies", move |t, x| x[0] - place(t), move |t, x| {
                [place(t), speed(t) - cor * (x[1] - speed(t))]
            })
            .beyond("flies", "rests", move |t, _| [place(t), speed(t)])
            .mode("rests", move |t, _| [speed(t), force(t)])
            .edge("rests", "flies", move |t, _| 9.81 + force(t), move |t, _| [place(t), speed(t)])
            .entry(Entry::Fire);
        let simulation = Simulation::of(&table).stepper(methods()[method]).longest_step(part).most_jumps(2000);
        let run = simulation.run("rests", [place(start), speed(start)], start..start + 6.0 / rate).unwrap();
        prop_assert_eq!(run.end.stop, Stop::Time);
    }
}

/// A block with drag on a belt that swings is held and let go in turn: of a thousand belts at most
/// five, where a slide has drifted far, have two jumps at one time.
#[test]
fn a_swinging_belt_lets_go_once_a_slide() {
    let (mut seed, count) = (1_u64, cases(1000));
    let mut random = |low: f64, high: f64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((seed >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let mut again = 0;
    for k in 0..count {
        let (grip, rate, drag) = (random(0.3, 1.5), random(0.5, 3.0), random(0.01, 0.5));
        let (swing, digits) = (random(0.3, 2.0), random(5.0, 9.0));
        let belt = Filippov::of(
            Sides::new(
                move |_, v: &f64| -grip - drag * v,
                move |_, v: &f64| grip - drag * v,
                move |t: f64, v| v - swing * (rate * t).sin(),
                |_, _| 1.0,
            )
            .moving(move |t: f64, _| -swing * rate * (rate * t).cos()),
        );
        let simulation = Simulation::of(&belt).stepper(methods()[k as usize % 4]).tolerance(10_f64.powf(-digits));
        let run = simulation.run(Side::Below, -0.3, 0.0..20.0).unwrap();
        assert_eq!(run.end.stop, Stop::Time);
        again += u32::from(run.trajectory.jumps().windows(2).any(|pair| pair[1].t() - pair[0].t() < 1e-4));
    }
    println!("{again} of {count}");
    assert!(again <= 5, "{again} of {count}");
}

/// Which of two edges due at the start comes first does not depend on the unit of time.
#[test]
fn the_unit_of_time_changes_no_order() {
    for power in -6..=15 {
        let second = 10_f64.powi(power);
        let model = Hybrid::new()
            .mode("a", move |_, _: &f64| -1.0 / second)
            .mode("b", |_, _| 0.0)
            .mode("c", |_, _| 0.0)
            .switch("a", "b", |_, x| x - 5.0)
            .switch("a", "c", |_, x| x - 9.0)
            .entry(Entry::Fire);
        assert_eq!(Simulation::of(&model).run("a", 5.0, 0.0..second).unwrap().end.mode, "b", "1e{power}");
    }
}

/// Friction that grows from nothing, in any unit of time, is no error of the flow.
#[test]
fn friction_may_grow_from_nothing() {
    for start in [0.0, 1.0, 1e6, 1e9] {
        for rate in [1.0, 1e-3, 1e-6] {
            let friction = move |t: f64| (rate * (t - start)).sin();
            let belt = Filippov::of(Sides::new(
                move |t, _: &f64| -friction(t),
                move |t, _: &f64| friction(t),
                |_, x| *x,
                |_, _| 1.0,
            ));
            let end = Simulation::of(&belt).run(Side::Sliding, 0.0, start..start + 2.0 / rate).unwrap().end;
            assert_eq!((end.mode, end.state), (Side::Sliding, 0.0));
            let unpushed = Stop::Undetermined { edge: Passage::Unpushed };
            assert!(end.stop == Stop::Time || end.stop == unpushed && end.time.seconds() == start, "{:?}", end.stop);
        }
    }
}
