//! What is due at one time, as a mode is entered or on the way: in the order listed, and not again
//! where a jump has left it.

use proptest::prelude::*;
use saltus::{Edge, Entry, ErrorKind, Hybrid, Jet, Polynomial, Simulation, Stop};
use saltus_cases::cases;

use crate::methods::methods;

/// What the guard of an edge does as the mode is entered.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Due {
    /// Zero, and goes up.
    Rises,
    /// Zero, and goes down.
    Falls,
    /// Below zero, and taken.
    Fires,
    /// Below zero, and an error.
    Refused,
    /// Below zero, and to be let in.
    Waits,
    /// Above zero.
    Inside,
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1000)))]

    /// Of any list of guards the first that is due is taken, or refused, at once.
    #[test]
    fn what_is_due_on_entry_is_taken_in_the_order_listed(
        list in prop::collection::vec((prop::sample::select(vec![
            Due::Rises, Due::Falls, Due::Fires, Due::Refused, Due::Waits, Due::Inside,
        ]), -3.0..3.0_f64, 1..4_i32), 1..6),
        wall in prop::sample::select(vec![0.0, 1.0, -3.7]),
        power in -6..6_i32,
        method in 0..4_usize,
        affine: bool,
        solved: bool,
    ) {
        let rate = 10_f64.powi(power);
        let mut model = Hybrid::new()
            .mode("start", move |_t, _x: &f64| rate)
            .mode("went", |_t, _x| 0.0);
        if solved {
            model = model.exact("start", move |_t, x| Polynomial::from([*x, rate]));
        }
        for &(due, steepness, order) in &list {
            let by = 10_f64.powf(steepness);
            // Beside a number of its own size a power of a short time is lost; and beside a fall in
            // proportion to time one that takes so much longer than a second.
            let order = if affine || wall != 0.0 || power < -5 { 1 } else { order };
            let (sign, at) = match due {
                Due::Rises => (by, 0.0),
                Due::Falls => (-by, 0.0),
                Due::Inside => (by, by),
                _ => (-by, -by),
            };
            let entry = match due {
                Due::Fires => Entry::Fire,
                Due::Waits => Entry::Wait,
                _ => Entry::Refuse,
            };
            model = model.edge("start", "went", move |_t, x| at + sign * (x - wall).powi(order), |_t, x| *x).entry(entry);
            if affine {
                model = model.affine();
            }
        }
        let run = Simulation::of(&model).stepper(methods()[method]).run("start", wall, 0.0..0.5 / rate);
        let due = list.iter().position(|(due, ..)| matches!(due, Due::Falls | Due::Fires | Due::Refused));
        // What falls as a power of time is taken where that is beyond rounding.
        let late = due.map_or(0.0, |k| if list[k].2 == 1 || affine || wall != 0.0 || power < -5 { 1e-12 } else { 1e-2 });
        match due {
            Some(k) if list[k].0 == Due::Refused => prop_assert_eq!(run.unwrap_err().error.kind(), ErrorKind::Entry),
            Some(k) => {
                let run = run.unwrap();
                let jump = run.trajectory.jumps()[0];
                prop_assert_eq!(jump.edge().map(|edge| edge.place), Some(k));
                prop_assert!(jump.t() * rate <= late, "{}", jump.t() * rate);
            }
            None => prop_assert_eq!(run.unwrap().end.jumps, 0),
        }
    }

    /// A guard that leaps is taken once where it leaps, whatever of the state the reset changes
    /// that does not lead away from there; and again where it leaps again.
    #[test]
    fn a_guard_that_leaps_is_taken_once(
        at in 0.1..0.9_f64,
        [inside, outside] in prop::array::uniform2(-3..3_i32),
        (offset, power) in (prop::sample::select(vec![0.0, 1.0, -1e3, 1e6]), -6..6_i32),
        count in prop::sample::select(vec![0.0, 1.0, 1e-9, -1e6]),
        (of_time, solved, waits) in any::<(bool, bool, bool)>(),
        method in 0..4_usize,
    ) {
        let (inside, outside) = (10_f64.powi(inside), -(10_f64.powi(outside)));
        let rate = 10_f64.powi(power);
        let guard = move |t: f64, x: &[f64; 2]| {
            let at_last = if of_time { t * rate } else { x[0] - offset };
            if at_last < at { inside } else { outside }
        };
        let mut model = Hybrid::new().mode("run", move |_t, _x: &[f64; 2]| [rate, 0.0]);
        if solved {
            model = model.exact("run", move |_t, x| Polynomial::from([*x, [rate, 0.0]]));
        }
        let model = model.edge("run", "run", guard, move |_t, x| [x[0], x[1] + count]);
        let model = if waits { model.entry(Entry::Wait) } else { model };
        let simulation = Simulation::of(&model).stepper(methods()[method]).most_jumps(100);
        let run = simulation.run("run", [offset, 0.0], 0.0..1.0 / rate);
        if waits {
            let run = run.unwrap();
            prop_assert_eq!((run.end.stop, run.end.jumps), (Stop::Time, 1));
            prop_assert!((run.trajectory.jumps()[0].t() * rate - at).abs() < 1e-9);
        } else {
            prop_assert_eq!(run.unwrap_err().error.kind(), ErrorKind::Entry);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1000)))]

    /// Of two edges due at once, the first of which changes nothing that the guards read, both are
    /// taken, in the order listed: the second leads away before the first is found to fall on.
    #[test]
    fn an_edge_due_at_once_is_taken_before_another_is_refused(
        (speed, wall) in (-3.0..3.0_f64, -3.0..3.0_f64),
        steep in prop::array::uniform2(-3.0..3.0_f64),
        entry in prop::sample::select(vec![Entry::Refuse, Entry::Wait, Entry::Fire]),
        (of_time, solved) in any::<(bool, bool)>(),
        start in prop::sample::select(vec![0.0, 0.25, -4.7]),
        method in 0..4_usize,
    ) {
        let [speed, wall] = [speed, wall].map(|power| 10_f64.powf(power));
        let steep = steep.map(|power| 10_f64.powf(power));
        let mut model = Hybrid::new()
            .mode("run", move |_t, _x: &[f64; 2]| [speed, 1.0])
            .mode("away", |_t, _x| [0.0; 2]);
        if solved {
            model = model.exact("run", move |_t, x| Polynomial::from([*x, [speed, 1.0]]));
        }
        let left = move |t: f64, x: &[f64; 2]| if of_time { start + wall / speed - t } else { wall - x[0] };
        let model = model
            .edge("run", "run", move |t, x| steep[0] * left(t, x), |_t, x| [x[0], 0.0])
            .entry(entry)
            .edge("run", "away", move |t, x| steep[1] * left(t, x), |_t, x| *x);
        let simulation = Simulation::of(&model).stepper(methods()[method]).most_jumps(20);
        let run = simulation.run("run", [0.0; 2], start..start + 2.0 * wall / speed).unwrap();
        let places: Vec<_> = run.trajectory.jumps().iter().filter_map(|jump| Some(jump.edge()?.place)).collect();
        prop_assert_eq!(places, [0, 1]);
    }
}

/// How the flow of a fall is given.
#[derive(Clone, Copy, Debug)]
enum By {
    Steps(usize),
    Series,
    Solution,
}

/// Guards of a body that falls from `high` at a speed: each is zero where it comes to `low`, and
/// rounds in its own way.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mark {
    Height,
    Cube,
    Exponential,
    Sine,
    Steepened,
    Energy,
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(2000)))]

    /// Of two guards that are zero at one time, but for rounding, the one listed first is taken.
    #[test]
    fn what_falls_at_one_time_is_taken_in_the_order_listed(
        (high, low) in (0.5..20.0_f64, -0.2..0.8_f64), (speed, gravity) in (-3.0..3.0_f64, 0.5..20.0_f64),
        marks in prop::sample::subsequence(vec![
            Mark::Height, Mark::Cube, Mark::Exponential, Mark::Sine, Mark::Steepened, Mark::Energy,
        ], 2).prop_shuffle(),
        by in prop::sample::select(vec![
            By::Steps(0), By::Steps(1), By::Steps(3), By::Series, By::Solution,
        ]),
        (power, start) in (3..12_i32, prop::sample::select(vec![0.0, 1.0, 1000.0])),
        affine: bool,
    ) {
        // Steps sum up height and speed apart, each with its own roundings.
        let by = if marks.contains(&Mark::Energy) && matches!(by, By::Steps(_)) { By::Series } else { by };
        let low = low * high;
        let (apex, energy) = (high + speed * speed / (2.0 * gravity), speed * speed + 2.0 * gravity * (high - low));
        let guard = move |mark, x: &[f64; 2]| match mark {
            Mark::Height => x[0] - low,
            Mark::Cube => x[0].powi(3) - low.powi(3),
            Mark::Exponential => x[0].exp() - low.exp(),
            Mark::Sine => ((x[0] - low) / (apex - low)).sin(),
            Mark::Steepened => (x[0] - low) * (1.0 + x[1] * x[1]),
            Mark::Energy => energy - x[1] * x[1],
        };
        let model = Hybrid::new()
            .mode("fall", move |_t, x: &[f64; 2]| [x[1], -gravity])
            .mode("first", |_t, _x| [0.0; 2])
            .mode("second", |_t, _x| [0.0; 2]);
        let model = match by {
            By::Steps(_) => model,
            By::Series => model.series("fall", move |t, x: [Jet; 2]| [x[1], 0.0 * t - gravity]),
            By::Solution => {
                model.exact("fall", move |_t, x| Polynomial::from([*x, [x[1], -gravity], [-0.5 * gravity, 0.0]]))
            }
        };
        let edge = |mark| {
            let edge = Edge::new(move |_t, x: &[f64; 2]| guard(mark, x), |_t, x: &[f64; 2]| *x);
            if affine && mark == Mark::Height { edge.affine() } else { edge }
        };
        let model = model.edge_with("fall", "first", edge(marks[0])).edge_with("fall", "second", edge(marks[1]));
        let method = methods()[if let By::Steps(method) = by { method } else { 3 }];
        let run = Simulation::of(&model).stepper(method).tolerance(10.0_f64.powi(-power));
        let run = run.run("fall", [high, speed], start..start + 100.0).unwrap();
        prop_assert_eq!(run.end.mode, "first");
    }
}
