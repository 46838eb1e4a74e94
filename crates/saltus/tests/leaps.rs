//! Guards that leap where their mode is entered: a saw-tooth of time, the pole pieces of a motor.

use proptest::prelude::*;
use saltus::{Clock, Entry, ErrorKind, Hybrid, Simulation, Stop};
use saltus_cases::cases;

use crate::methods::methods;

/// How far a period has come, from 0 to 1, as programs write it.
fn part(form: usize, period: f64, t: f64) -> f64 {
    match form {
        0 => (t / period).fract(),
        1 => t / period - (t / period).floor(),
        2 => (t % period) / period,
        _ => t.rem_euclid(period) / period,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(400)))]

    /// On by a clock, off by a saw-tooth of time, which is by rounding before its leap or behind it
    /// at each tick.
    #[test]
    fn a_modulated_width_is_kept(
        power in -6..=2_i32,
        mantissa in 1.0..10.0_f64,
        duty in prop_oneof![0.001..0.05_f64, 0.05..0.95_f64, 0.95..0.999_f64],
        form in 0..4_usize,
        first in 0..1000_u32,
        method in 0..4_usize,
        waits in any::<bool>(),
        part_of_step in 0.05..1.0_f64,
    ) {
        let period = (mantissa * 10_f64.powi(power)).max(1e-6);
        let (start, count) = (period * f64::from(first), 200_u32);
        let model = Hybrid::new()
            .mode("on", |_, _: &f64| 1.0)
            .mode("off", |_, _| 0.0)
            .switch("on", "off", move |t, _| duty - part(form, period, t))
            .entry(if waits { Entry::Wait } else { Entry::Refuse })
            .switch_at("off", "on", Clock::every(period));
        // To within a period, so that no step goes over a whole one; the run begins in the middle.
        let simulation = Simulation::of(&model).stepper(methods()[method]).longest_step(part_of_step * period);
        let span = start + 0.5 * (1.0 + duty) * period;
        let run = simulation.run("off", 0.0, span..span + f64::from(count) * period).unwrap();
        prop_assert_eq!(run.end.stop, Stop::Time);
        let want = f64::from(count) * duty * period;
        prop_assert!((run.end.state - want).abs() <= 1e-9 * want + 1e-9 * span, "{} {want}", run.end.state);
        prop_assert_eq!(run.trajectory.jumps().len(), 2 * 200);
    }

    /// The same of a guard of the state, from a hair before its leap.
    #[test]
    fn a_leap_of_the_state_is_behind_where_the_flow_leads_over_it(
        turns in 1..1000_u32,
        duty in 0.02..0.98_f64,
        hair in 0..8_u32,
        method in 0..4_usize,
        waits in any::<bool>(),
    ) {
        let mut x = f64::from(turns);
        (0..hair).for_each(|_| x = x.next_down());
        let entry = if waits { Entry::Wait } else { Entry::Refuse };
        let model = Hybrid::new()
            .mode("on", |_, _: &f64| 1.0)
            .mode("off", |_, _| 0.0)
            .switch("on", "off", move |_, x| duty - x.fract())
            .entry(entry);
        let run = Simulation::of(&model).stepper(methods()[method]).first_step(0.9).run("on", x, 0.0..1.5).unwrap();
        prop_assert_eq!((run.end.mode, run.trajectory.jumps().len()), ("off", 1));
        prop_assert!((run.end.state - f64::from(turns) - duty).abs() < 1e-9, "{}", run.end.state);
    }
}

/// What a guard was before the run begins does not matter.
#[test]
fn a_guard_that_has_leapt_as_the_run_starts_is_below_zero() {
    let saw = |entry| {
        let model = Hybrid::new().mode("a", |_, _: &f64| 1.0).mode("b", |_, _| 0.0);
        model.switch("a", "b", |t, _| t.rem_euclid(1.0) - 0.5).entry(entry)
    };
    for method in methods() {
        for start in [0.0, 1.0, 7.0, 1e6] {
            let run = Simulation::of(&saw(Entry::Fire)).stepper(method).run("a", 0.0, start..start + 0.4).unwrap();
            assert_eq!((run.end.mode, run.end.state), ("b", 0.0));
            let refused = Simulation::of(&saw(Entry::Refuse)).stepper(method).run("a", 0.0, start..start + 0.4);
            assert_eq!(refused.unwrap_err().error.kind(), ErrorKind::Entry);
        }
    }
}

/// A guard that is no number before its run begins is below zero for all that.
#[test]
fn a_guard_that_begins_with_the_run_is_below_zero() {
    for start in [0.0, 1.0, 1e3] {
        let model = Hybrid::new().mode("a", |_, _: &f64| 1.0).mode("b", |_, _| 0.0);
        let model = model.switch("a", "b", move |t, _| (t - start).sqrt() - 0.6).entry(Entry::Fire);
        for method in methods() {
            let run = Simulation::of(&model).stepper(method).run("a", 0.0, start..start + 0.3).unwrap();
            assert_eq!((run.end.mode, run.end.state), ("b", 0.0), "{start}");
        }
    }
}
