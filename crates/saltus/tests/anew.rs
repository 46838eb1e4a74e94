//! A reset that gives a coordinate anew leaves it no rounding of what it was before; one that keeps
//! it, or a part of it, does. Nor is a motion that begins on a curved wall judged by the time of
//! the one before.

use proptest::prelude::*;
use saltus::{Clock, Entry, Hybrid, Polynomial, Signal, Simulation, Stop};
use saltus_cases::cases;

use crate::methods::methods;

/// From far away down to 10⁶, and there anew at `small` above the wall, which is 20 s away; then x
/// counts the time.
fn dock(speed: f64, small: f64, exact: bool) -> Hybrid<'static, f64> {
    let model = Hybrid::new()
        .mode("cruise", move |_t, _x: &f64| -speed)
        .edge("cruise", "dock", |_t, x| x - 1e6, move |_t, _x| small)
        .mode("dock", move |_t, _x| -small / 20.0)
        .switch("dock", "end", |_t, x| *x)
        .mode("end", |_t, _x| 1.0);
    if exact { model.exact("dock", move |_t, x| [*x, -small / 20.0].into()) } else { model }
}

/// x' = -k (x - level) for so long, then down by `by` in 10 s.
fn settle_and_cool(k: f64, level: f64, by: f64) -> Hybrid<'static, [f64; 2]> {
    Hybrid::new()
        .mode("settle", move |_t, x: &[f64; 2]| [-k * (x[0] - level), -1.0])
        .edge("settle", "cool", |_t, x| x[1], move |_t, x| [x[0], 0.0])
        .mode("cool", move |_t, _x| [-by / 10.0, 0.0])
        .switch("cool", "end", move |_t, x| x[0] - (level - by))
        .mode("end", |_t, _x| [0.0; 2])
}

/// A puck at the board of a round rink: held for so long, then shot inwards at an `angle` from the
/// middle, reflected by the board ever after. The last coordinate is what is left of the time.
fn puck(turn: f64, angle: f64, guard: fn(&[f64; 5]) -> f64) -> Hybrid<'static, [f64; 5]> {
    let (c, s) = (turn.cos(), turn.sin());
    let v = [-c * angle.cos() - s * angle.sin(), -s * angle.cos() + c * angle.sin()];
    Hybrid::new()
        .mode("held", |_t, _x: &[f64; 5]| [0.0, 0.0, 0.0, 0.0, -1.0])
        .edge("held", "slides", |_t, x| x[4], move |_t, _x| [c, s, v[0], v[1], 0.0])
        .mode("slides", |_t, x| [x[2], x[3], 0.0, 0.0, 0.0])
        .edge(
            "slides",
            "slides",
            move |_t, x| guard(x),
            |_t, x| {
                let n = 2.0 * (x[0] * x[2] + x[1] * x[3]) / (x[0] * x[0] + x[1] * x[1]);
                [x[0], x[1], x[2] - n * x[0], x[3] - n * x[1], 0.0]
            },
        )
}

/// A ray from the rim of a disk of radius `r` at each tick, absorbed where it meets the rim again;
/// it flies as the chord of `angle` to the tangent says, in twice its sine.
fn rays(r: f64, turn: f64, angle: f64, period: f64, exact: bool) -> Hybrid<'static, [f64; 4]> {
    let (c, s) = (turn.cos(), turn.sin());
    let v = [-c * angle.sin() - s * angle.cos(), -s * angle.sin() + c * angle.cos()];
    let straight = |x: &[f64; 4]| [x[2], x[3], 0.0, 0.0];
    let model = Hybrid::new()
        .mode("waits", |_t, _x: &[f64; 4]| [0.0; 4])
        .mode("flies", move |_t, x| straight(x))
        .clock("waits", "flies", Clock::every(period), move |_t, _x| [r * c, r * s, r * v[0], r * v[1]])
        .edge("flies", "waits", move |_t, x| r * r - x[0] * x[0] - x[1] * x[1], |_t, x| *x);
    if exact { model.exact("flies", move |_t, x| Polynomial::from([*x, straight(x)])) } else { model }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(96)))]

    #[test]
    fn a_coordinate_given_anew_has_roundings_of_its_own(
        method in 0..4_usize, far in 7.0..13.0_f64, small in 3.0..12.0_f64, exact: bool,
    ) {
        let (far, small) = (10_f64.powf(far), 10_f64.powf(-small));
        let model = dock(far / 1e7, small, exact);
        let run = Simulation::of(&model).stepper(methods()[method]).run("cruise", far, 0.0..2e7).unwrap();
        let [first, second] = run.trajectory.jumps() else { panic!("{:?}", run.end) };
        let after = second.time.since(first.time);
        // Two times of 10⁷ s, each rounded.
        prop_assert!((after - 20.0).abs() < 1e-7, "{after} s after the reset");
    }

    /// A guard that is zero as its mode is entered, but for rounding, and rises, falls where it
    /// comes down again, however much longer the step, the arc or the span is.
    #[test]
    fn a_rise_from_zero_is_no_fall(
        method in 0..4_usize, size in -3.0..7.0_f64, turn in 0.0..6.3_f64, angle in -3.0..-0.3_f64,
        period in 0.4..2.0_f64, exact: bool,
    ) {
        let (r, angle, period) = (10_f64.powf(size), 10_f64.powf(angle), 10_f64.powf(period));
        let chord = 2.0 * angle.sin();
        let model = rays(r, turn, angle, period, exact);
        let simulation = Simulation::of(&model).stepper(methods()[method]).tolerance(1e-9);
        let run = simulation.run("waits", [0.0; 4], 0.0..8.5 * period).unwrap();
        let flights: Vec<f64> = run.trajectory.jumps().chunks(2).map(|pair| pair[1].time.since(pair[0].time)).collect();
        prop_assert_eq!(flights.len(), 8, "{:?}", run.end);
        for flight in flights {
            prop_assert!((flight - chord).abs() < 1e-8 * period, "{flight} for {chord}");
        }
    }

    /// Also where a limit of the run ended its arc a nanometre before the wall.
    #[test]
    fn a_run_that_goes_on_near_a_wall_meets_it(method in 0..4_usize, far in 9.0..12.0_f64, near in 1.0..3.0_f64) {
        let (far, near) = (10_f64.powf(far), 1e-9 * near);
        let model = dock(far / 1e7, 1.0, false).exact("cruise", move |_t, x| [*x, -far / 1e7].into());
        // A second behind the wall.
        let span = 0.0..1e7 * (1.0 - 1e6 / far) + 21.0;
        let simulation = Simulation::of(&model).stepper(methods()[method]);
        let mut course = simulation.first_step(100.0).start("cruise", far, span.clone()).unwrap();
        prop_assert_eq!(course.advance(&mut ()).unwrap(), None);
        let cut_short = simulation.longest_step(20.0 * (1.0 - near)).most_steps(1);
        let mut course = cut_short.resume(course.checkpoint());
        let cut = course.finish(&mut ()).unwrap();
        prop_assert!(cut.mode == "dock" && cut.state < 2.0 * near, "{cut:?}");
        let whole = simulation.drive("cruise", far, span, &mut ()).unwrap();
        let end = simulation.resume(course.checkpoint()).finish(&mut ()).unwrap();
        prop_assert_eq!((end.mode, end.jumps), (whole.mode, 2));
        prop_assert!((end.state - whole.state).abs() < 1e-8, "{} and {}", end.state, whole.state);
    }

    /// An angle that has turned a whole time is what it was, less a turn: the rounding of a turn.
    #[test]
    fn a_coordinate_that_is_kept_keeps_its_roundings(
        method in 0..4_usize, turn in 1e-3..1e3_f64, rate in 0.1..10.0_f64, turns in 5..40_usize,
    ) {
        let model = Hybrid::new()
            .mode("turns", move |_t, _x: &f64| rate)
            .edge("turns", "turns", move |_t, x| turn - x, move |_t, x| x - turn)
            .edge("turns", "back", |_t, x| *x, |_t, x| *x)
            .mode("back", |_t, _x| 0.0);
        let until = (turns as f64 + 0.75) * turn / rate;
        let run = Simulation::of(&model).stepper(methods()[method]).run("turns", 0.5 * turn, 0.0..until).unwrap();
        prop_assert_eq!((run.end.mode, run.end.jumps), ("turns", turns + 1));
    }

    #[test]
    fn a_relaxation_leaves_a_coordinate_the_roundings_of_its_size(
        k in 2.0..9.0_f64, seconds in 3.0..6.0_f64, level in 1.0..1e3_f64, by in -4.0..0.0_f64,
    ) {
        let (k, seconds, by) = (10_f64.powf(k), 10_f64.powf(seconds), level * 10_f64.powf(by));
        let model = settle_and_cool(k, level, by);
        let run = Simulation::of(&model).run("settle", [0.0, seconds], 0.0..seconds + 100.0).unwrap();
        let [first, second] = run.trajectory.jumps() else { panic!("{:?}", run.end) };
        // What the tolerance leaves of the level is a part of the way.
        let (after, allowed) = (second.time.since(first.time), 10.0 * 1e-4 * level / by);
        prop_assert!((after - 10.0).abs() < 1e-3 + allowed, "{after} s");
    }

    #[test]
    fn a_chord_from_a_curved_wall_ends_at_its_other_end(
        method in 0..4_usize, held in -1.0..6.0_f64, beyond in 0.5..6.0_f64, turn in 0.0..6.0_f64,
        angle in -1.2..1.2_f64, guard in 0..3_usize,
    ) {
        let guards: [fn(&[f64; 5]) -> f64; 3] = [
            |x| 1.0 - x[0].hypot(x[1]),
            |x| 1.0 - x[0] * x[0] - x[1] * x[1],
            |x| (1.0 - x[0] * x[0] - x[1] * x[1]) / (1.0 + x[0] * x[0] + x[1] * x[1]),
        ];
        let (held, chord) = (10_f64.powf(held), 2.0 * angle.cos());
        let model = puck(turn, angle, guards[guard]);
        let span = 0.0..held + 10_f64.powf(beyond);
        let simulation = Simulation::of(&model).stepper(methods()[method]).most_jumps(3);
        let run = simulation.run("held", [turn.cos(), turn.sin(), 0.0, 0.0, held], span.clone()).unwrap();
        let due = if span.end - held < chord { 1 } else { 2 };
        prop_assert!(run.end.jumps >= due, "{:?}", run.end);
        if let [shot, reflected, ..] = run.trajectory.jumps() {
            let after = reflected.time.since(shot.time);
            prop_assert!((after - chord).abs() < 1e-6, "{after} s for {chord} s");
        }
    }

    #[test]
    fn a_toss_from_a_wall_ends_where_it_comes_back(
        method in 0..4_usize, held in -1.0..6.0_f64, beyond in 0.0..3.0_f64, speed in -2.0..2.0_f64,
        back in -3.0..1.0_f64, steep in -1.0..3.0_f64, bounded: bool,
    ) {
        let [held, speed, back, steep] = [held, speed, back, steep].map(|power| 10_f64.powf(power));
        let top = 0.25 * speed * back;
        let guard = move |x: f64| if bounded { (steep * x / top).tanh() } else { (steep.min(8.0) * x / top).exp_m1() };
        let model = Hybrid::new()
            .mode("held", |_t, _x: &[f64; 3]| [0.0, 0.0, -1.0])
            .edge("held", "tossed", |_t, x| x[2], move |_t, _x| [0.0, speed, 0.0])
            .mode("tossed", move |_t, x| [x[1], -2.0 * speed / back, 0.0])
            .edge("tossed", "end", move |_t, x| guard(x[0]), |_t, x| *x)
            .mode("end", |_t, _x| [0.0; 3]);
        let span = 0.0..held + back * (1.0 + 10_f64.powf(beyond));
        let run = Simulation::of(&model).stepper(methods()[method]).run("held", [0.0, 0.0, held], span).unwrap();
        // A guard that the tolerance moves by more than the whole toss may be missed, in a doubt.
        let [tossed, caught] = run.trajectory.jumps() else {
            prop_assert!(!bounded && !run.trajectory.doubts().is_empty(), "{:?}", run.end);
            return Ok(());
        };
        let after = caught.time.since(tossed.time);
        prop_assert!((after / back - 1.0).abs() < 1e-6, "{after} s for {back} s");
    }

    /// Zero but for rounding, on either side, while nothing moves, and then down.
    #[test]
    fn an_edge_that_stays_is_taken_where_its_flow_leads_down(
        level in 1e-3..1e3_f64, spacings in -3..4_i32, stop in 0.5..2.0_f64, method in 0..4_usize, entry in 0..3_usize,
    ) {
        let entry = [Entry::Refuse, Entry::Wait, Entry::Fire][entry];
        let off = f64::from(spacings) * f64::EPSILON * level;
        let input = Signal::held([(0.0, 0.0), (stop, -level)]).unwrap();
        let flow = input.clone();
        let model = Hybrid::new()
            .mode("rests", move |t, _x: &f64| flow.at(t))
            .stops("rests", input.stops())
            .edge("rests", "falls", move |_t, x| x - level, |_t, x| *x)
            .entry(entry)
            .mode("falls", |_t, _x| 0.0);
        let run = Simulation::of(&model).stepper(methods()[method]).run("rests", level + off, 0.0..3.0).unwrap();
        prop_assert_eq!(run.end.stop, Stop::Time);
        let [jump] = run.trajectory.jumps() else { panic!("{off:e}, {:?}", run.end) };
        prop_assert!((jump.t() - stop).abs() < 1e-9, "at {}", jump.t());
    }
}
