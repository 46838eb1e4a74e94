//! Samples as inputs, against integrals and laws that hold for all samples.

use proptest::prelude::*;
use saltus::{Hybrid, Signal, SignalError, Simulation};

type Samples = Vec<(f64, f64)>;

/// Up to a dozen samples, some of them close together, over at most 10 s.
fn samples() -> impl Strategy<Value = Samples> {
    let times = prop::collection::btree_set(0..10_000_u32, 1..12);
    (times, prop::collection::vec(-5.0..5.0_f64, 12))
        .prop_map(|(times, values)| times.into_iter().map(|t| f64::from(t) * 1e-3 - 4.0).zip(values).collect())
}

fn made(kind: usize, samples: &Samples) -> Signal {
    let samples = samples.iter().copied();
    match kind {
        0 => Signal::held(samples),
        1 => Signal::linear(samples),
        _ => Signal::cubic(samples),
    }
    .unwrap()
}

/// ∫ u dt by Simpson's rule between knots, where u is a polynomial of degree three at most.
fn integral(signal: &Signal, knots: &[f64], from: f64, to: f64) -> f64 {
    let inside = knots.iter().copied().filter(|&knot| knot > from && knot < to);
    let ends: Vec<f64> = [from].into_iter().chain(inside).chain([to]).collect();
    let stretch = |pair: &[f64]| {
        let (a, b) = (pair[0], pair[1]);
        let [start, middle, end] = [a.next_up(), a.midpoint(b), b.next_down()].map(|t| signal.at(t));
        (b - a) * (start + 4.0 * middle + end) / 6.0
    };
    ends.windows(2).map(stretch).sum()
}

proptest! {
    #[test]
    fn a_signal_goes_through_its_samples(kind in 0..3_usize, samples in samples()) {
        let signal = made(kind, &samples);
        for &(t, value) in &samples {
            prop_assert_eq!(signal.at(t), value);
        }
        prop_assert_eq!(signal.at(-1e9), samples[0].1);
        prop_assert_eq!(signal.at(1e9), samples[samples.len() - 1].1);
    }

    /// It stays between its samples, and rises or falls between two as they do.
    #[test]
    fn a_signal_is_monotone_between_samples(kind in 0..3_usize, samples in samples()) {
        let signal = made(kind, &samples);
        for pair in samples.windows(2) {
            let [(a, from), (b, to)] = [pair[0], pair[1]];
            let mut last = from;
            for k in 1..=40 {
                let value = signal.at(a + (b - a) * f64::from(k) / 40.0);
                let step = (value - last) * (to - from).signum();
                prop_assert!(step >= -1e-14, "{} after {}", value, last);
                last = value;
            }
        }
    }

    /// A cubic has one slope to both sides of a knot; that of a parabola's samples, evenly spaced,
    /// is the parabola's to second order.
    #[test]
    fn a_cubic_has_a_slope(samples in samples()) {
        let signal = made(2, &samples);
        for &(t, value) in samples.iter().skip(1).rev().skip(1) {
            let by = 1e-10;
            let [left, right] = [value - signal.at(t - by), signal.at(t + by) - value];
            prop_assert!((left - right).abs() < 1e-11, "{} and {} at {}", left / by, right / by, t);
        }
    }

    #[test]
    fn a_repeated_signal_repeats(kind in 0..3_usize, samples in samples(), pause in 1e-3..5.0_f64, n in -40..40_i32, t in -10.0..10.0_f64) {
        let period = samples[samples.len() - 1].0 - samples[0].0 + pause;
        let signal = made(kind, &samples).repeated(period).unwrap();
        let knots: Vec<f64> = samples.iter().map(|sample| sample.0).collect();
        prop_assume!(knots.iter().all(|knot| ((t - knot) / period - ((t - knot) / period).round()).abs() > 1e-9));
        let later = signal.at(t + f64::from(n) * period);
        prop_assert!((later - signal.at(t)).abs() < 1e-7, "{} and {}", later, signal.at(t));
        for &(t, value) in &samples {
            prop_assert_eq!(signal.at(t), value);
        }
    }

    /// A flow of an input is integrated exactly, with no step in vain, over any span.
    #[test]
    fn an_integral_of_a_signal(kind in 0..3_usize, samples in samples(), repeated in any::<bool>(), from in -6.0..6.0_f64, lasts in 1e-3..12.0_f64) {
        let to = from + lasts;
        let mut signal = made(kind, &samples);
        let mut knots: Vec<f64> = samples.iter().map(|sample| sample.0).collect();
        if repeated {
            let period = knots[knots.len() - 1] - knots[0] + 0.5;
            signal = signal.repeated(period).unwrap();
            knots = (-50..50).flat_map(|n| knots.iter().map(move |knot| f64::from(n).mul_add(period, *knot))).collect();
        }
        let model = Hybrid::new().mode("run", |t, _x: &f64| signal.at(t)).stops("run", signal.stops());
        let run = Simulation::of(&model).run("run", 0.0, from..to).unwrap();
        let exact = integral(&signal, &knots, from, to);
        prop_assert!((run.end.state - exact).abs() < 1e-10, "{} is not {}", run.end.state, exact);
        let stops = knots.iter().filter(|&&knot| knot > from && knot < to).count() as u64;
        if kind < 2 {
            prop_assert!(run.end.stats.rejected <= 2 * (stops + 1), "{:?} with {} stops", run.end.stats, stops);
        }
    }
}

#[test]
fn samples_that_are_no_input() {
    let message = |samples: &[(f64, f64)]| Signal::linear(samples.iter().copied()).unwrap_err();
    assert_eq!(message(&[]), SignalError::Empty);
    assert_eq!(message(&[(0.0, 1.0), (0.0, 2.0)]), SignalError::NotRising { place: 1, times: [0.0, 0.0] });
    assert!(message(&[(0.0, f64::NAN)]).to_string().starts_with("sample 0 is NaN at t = 0"));
    let saw = || Signal::linear([(0.0, 0.0), (1.0, 1.0)]).unwrap();
    assert_eq!(saw().repeated(1.0).unwrap_err(), SignalError::Ends { values: [0.0, 1.0] });
    assert_eq!(saw().repeated(0.5).unwrap_err(), SignalError::Period { period: 0.5, lasts: 1.0 });
    assert!(saw().repeated(f64::NAN).is_err() && saw().repeated(f64::INFINITY).is_err());
    assert!(Signal::held([(0.0, 0.0), (1.0, 1.0)]).unwrap().repeated(1.0).is_ok());
}
