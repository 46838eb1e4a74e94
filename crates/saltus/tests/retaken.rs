//! Edges of a mode to itself whose resets change nothing: each fall is one jump, however near two
//! of them lie and however coarse the numbers of time are.

use std::f64::consts::PI;

use proptest::prelude::*;
use saltus::{Auto, Coords, Entry, ErrorKind, Hybrid, Polynomial, Simulation, State, Stop};
use saltus_cases::cases;

use crate::methods::methods;

type Counter<'a> = Hybrid<'a, f64>;

fn counter<'a>() -> Counter<'a> {
    Hybrid::new().mode("run", |_t, _x: &f64| 1.0)
}

/// The edges taken, in order.
fn taken(counter: &Counter, stepper: Auto) -> Vec<usize> {
    let run = Simulation::of(counter).stepper(stepper).run("run", 0.0, 0.0..1.0).unwrap();
    assert_eq!(run.end.stop, Stop::Time);
    run.trajectory.jumps().iter().filter_map(saltus::Jump::edge).map(|edge| edge.place).collect()
}

/// A guard is asked in the modes that have its edge only: elsewhere the state is another one.
#[test]
fn a_guard_is_not_asked_in_another_mode() {
    type Either = Coords<2>;
    let fall = |_t: f64, x: &Either| {
        assert_eq!(x.len(), 2, "asked of {x:?}");
        x.get(0)
    };
    let hold = |_t: f64, x: &Either| {
        assert_eq!(x.len(), 1, "asked of {x:?}");
        x.get(0)
    };
    for held in [1e-3, 1e-6, 1e-9, 1e-15, 1e-16, 1e-17, 1e-300] {
        let ball = Hybrid::new()
            .mode("flight", |_t, x: &Either| [x.get(1), -9.81].into())
            .mode("held", |_t, _x| [-1.0].into())
            .edge("flight", "held", fall, move |_t, _x| [held].into())
            .edge("held", "flight", hold, |_t, _x| [0.0, 4.0].into());
        let run = Simulation::of(&ball).run("flight", [1.0, 0.0].into(), 0.0..5.0).unwrap();
        assert_eq!(run.end.stop, Stop::Time);
        assert_eq!(run.trajectory.jumps().len(), 12, "held for {held} s");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(64)))]

    /// sin(ωt + φ) falls once a turn.
    #[test]
    fn a_guard_of_time_falls_once_a_turn(omega in 0.05..6.0_f64, phase in 0.0..2.0 * PI, decades in 1.0..3.5_f64) {
        let end = 10.0_f64.powf(decades);
        let turns = |t: f64| (((omega * t + phase) / PI - 1.0) / 2.0).floor();
        prop_assume!(turns(end * (1.0 - 1e-12)) == turns(end * (1.0 + 1e-12)));
        let wave = counter()
            .edge("run", "run", move |t, _x| (omega * t + phase).sin(), |_t, x| *x)
            .entry(Entry::Wait);
        let run = Simulation::of(&wave).run("run", 0.0, 0.0..end).unwrap();
        prop_assert_eq!(run.end.stop, Stop::Time);
        prop_assert_eq!(run.trajectory.jumps().len() as f64, turns(end) - turns(0.0));
    }

    /// A ball whose reset forgets to turn it round is refused at the impact; where the edge waits,
    /// it falls on and is counted once.
    #[test]
    fn a_reset_that_does_not_turn_the_motion_is_refused(
        kept in 0.01..1.5_f64, height in -3.0..3.0_f64, affine: bool, solved: bool, elsewhere in -10.0..10.0_f64,
    ) {
        let height = 10.0_f64.powf(height);
        let ball = |entry| {
            let ball = Hybrid::new()
                .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.81])
                .edge("flight", "flight", move |_t, x| x[0] - elsewhere, move |_t, x| [x[0], kept * x[1]])
                .entry(entry);
            let ball = if affine { ball.affine() } else { ball };
            if solved { ball.exact("flight", |_t, x| Polynomial::from([*x, [x[1], -9.81], [-4.905, 0.0]])) } else { ball }
        };
        let start = [elsewhere + height, 0.0];
        let impact = (2.0 * height / 9.81).sqrt();
        let refused = Simulation::of(&ball(Entry::Refuse)).run("flight", start, 0.0..3.0 * impact).unwrap_err().error;
        prop_assert_eq!(refused.kind(), ErrorKind::Entry);
        prop_assert!((refused.t() - impact).abs() < 1e-6 * impact, "{refused}");
        let waiting = ball(Entry::Wait);
        let run = Simulation::of(&waiting).run("flight", start, 0.0..3.0 * impact).unwrap();
        prop_assert_eq!((run.end.stop, run.trajectory.jumps().len()), (Stop::Time, 1));
    }

    /// Two guards of time, or of a state, that fall `apart` spacings of numbers from each other:
    /// each once, the earlier one first, or of one instant the one listed first.
    #[test]
    fn falls_a_hair_apart_are_taken_once_each(first in 0.01..0.99_f64, apart in 0_u64..1500, swapped: bool) {
        let second = f64::from_bits(first.to_bits() + apart);
        let order = if swapped && apart > 0 { [1, 0] } else { [0, 1] };
        let [a, b] = if swapped { [second, first] } else { [first, second] };
        let of_time = counter()
            .edge("run", "run", move |t, _x| a - t, |_t, x| *x)
            .entry(Entry::Wait)
            .edge("run", "run", move |t, _x| b - t, |_t, x| *x)
            .entry(Entry::Wait);
        let of_state = counter()
            .edge("run", "run", move |_t, x| a - x, |_t, x| *x)
            .entry(Entry::Wait)
            .edge("run", "run", move |_t, x| b - x, |_t, x| *x)
            .entry(Entry::Wait);
        for counter in [of_time, of_state] {
            for places in methods().map(|method| taken(&counter, method)) {
                prop_assert!(places == order || apart <= 16 && places == [0, 1], "{places:?} instead of {order:?}");
            }
        }
    }

    /// Nor how many there are, and how steep each is beside the others.
    #[test]
    fn many_falls_a_hair_apart_are_taken_once_each(
        first in 0.01..0.9_f64,
        falls in prop::collection::vec((0_u64..100, -8.0..8.0_f64), 3..7),
        near in 1_u64..100,
        of_state: bool,
    ) {
        let mut counter = counter();
        for &(apart, steepness) in &falls {
            let (at, slope) = (f64::from_bits(first.to_bits() + apart % near), 10_f64.powf(steepness));
            let guard = move |t: f64, x: &f64| slope * (at - if of_state { *x } else { t });
            counter = counter.edge("run", "run", guard, |_t, x| *x).entry(Entry::Wait);
        }
        for mut places in methods().map(|method| taken(&counter, method)) {
            places.sort_unstable();
            prop_assert_eq!(places, (0..falls.len()).collect::<Vec<_>>());
        }
    }
}

proptest! {
    /// An edge that changes nothing and goes on falling is refused, wherever the span ends, unless
    /// it waits; then each passage counts.
    #[test]
    fn a_guard_that_falls_on_is_refused_wherever_the_span_ends(
        phase in -1.4..1.4_f64, turns in 0.3..20.0_f64, digits in 5.5..13.0_f64, power in -6..6_i32, affine: bool, waits: bool,
        method in 0..4_usize,
    ) {
        let rate = 10_f64.powi(power);
        let model = Hybrid::new()
            .mode("swing", move |_t, x: &[f64; 2]| [x[1] * rate, -x[0] * rate])
            .edge("swing", "swing", |_t, x| x[0], |_t, x| *x);
        let model = if affine { model.affine() } else { model };
        let model = if waits { model.entry(Entry::Wait) } else { model };
        let (start, end) = ([phase.cos(), -phase.sin()], turns * std::f64::consts::TAU / rate);
        let simulation = Simulation::of(&model).stepper(methods()[method]).tolerance(10_f64.powf(-digits));
        let run = simulation.run("swing", start, 0.0..end).map(|run| run.end.jumps);
        // At angles of 1/4, 5/4, 9/4 turns; away from where the span ends at one.
        let passed = turns - (std::f64::consts::FRAC_PI_2 - phase) / std::f64::consts::TAU;
        prop_assume!((passed - passed.round()).abs() > 1e-2);
        if passed < 0.0 || waits {
            prop_assert_eq!(run.unwrap(), passed.floor().max(-1.0) as usize + usize::from(passed > 0.0));
        } else {
            prop_assert_eq!(run.unwrap_err().error.kind(), ErrorKind::Entry);
        }
    }
}

proptest! {
    /// A guard that leaps has no root that could be spent: it is taken again where it leaps again.
    #[test]
    fn a_guard_that_leaps_is_taken_each_time(
        back in 0.1..3.0_f64, inside in -3..3_i32, outside in -3..3_i32, waits: bool, method in 0..4_usize,
    ) {
        let (inside, outside) = (10_f64.powi(inside), -(10_f64.powi(outside)));
        let model = Hybrid::new()
            .mode("rise", |_t, _x: &f64| 1.0)
            .edge("rise", "rise", move |_t, x| if *x < 2.0 { inside } else { outside }, move |_t, _x| 2.0 - back);
        let model = if waits { model.entry(Entry::Wait) } else { model };
        let run = Simulation::of(&model).stepper(methods()[method]).run("rise", 2.0 - back, 0.0..9.5 * back);
        prop_assert_eq!(run.map(|run| run.end.jumps).map_err(|failed| failed.to_string()), Ok(9));
    }
}
