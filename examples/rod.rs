//! A rod that a thermostat heats at one end: a stiff flow of thousands of coordinates, each of
//! which reads its neighbours alone.
//!
//! `cargo run --example rod` compares the switches with the exact solution;
//! `cargo run --profile dist --example rod -- cost` times them, and draws `docs/trust/rod.svg`.

use std::error::Error;
use std::f64::consts::PI;
use std::time::Instant;

use saltus::{Hybrid, Rodas5P, Simulation, Sparsity, Vector};
use saltus_examples::growth;

/// The sensor in the middle of the rod switches the heater off at the second of these temperatures,
/// and on at the first.
const SENSOR: [f64; 2] = [0.2, 0.3];

/// A rod of N cells, u' = ∂²u/∂x² over a length of 1 by differences, cold at its right end; the
/// left one is at 1 while the heater is on, else at 0.
fn rod(n: usize) -> Hybrid<'static, Vector> {
    let by = ((n + 1) * (n + 1)) as f64;
    let heat = move |left: f64| {
        move |_t: f64, u: &Vector| {
            Vector::from_fn(u.len(), |i| {
                let before = if i == 0 { left } else { u[i - 1] };
                let behind = if i + 1 == u.len() { 0.0 } else { u[i + 1] };
                by * (before - 2.0 * u[i] + behind)
            })
        }
    };
    let ([low, high], middle) = (SENSOR, n / 2);
    Hybrid::new()
        .mode("on", heat(1.0))
        .mode("off", heat(0.0))
        .sparse("on", Sparsity::banded(n, 1, 1))
        .sparse("off", Sparsity::banded(n, 1, 1))
        .switch("on", "off", move |_t, u| high - u[middle])
        .affine()
        .switch("off", "on", move |_t, u| u[middle] - low)
        .affine()
}

/// When the heater is switched, on the exact solution of the N cells: each of their N waves dies
/// away by itself, and the sensor is a sum of them.
fn exact(n: usize, switches: usize) -> Vec<f64> {
    let h = 1.0 / (n + 1) as f64;
    let place = (n / 2 + 1) as f64 * h;
    let rates: Vec<_> = (1..=n).map(|k| -(2.0 / h * (0.5 * PI * k as f64 * h).sin()).powi(2)).collect();
    let waves: Vec<_> = (1..=n).map(|k| (PI * k as f64 * place).sin()).collect();
    // What of each wave a rod is that falls evenly from 1 to 0.
    let even: Vec<_> = (1..=n).map(|k| h / (0.5 * PI * k as f64 * h).tan()).collect();
    let (mut parts, mut left, mut t, mut found) = (vec![0.0; n], 1.0, 0.0, Vec::new());
    parts.iter_mut().zip(&even).for_each(|(part, even)| *part = -even);
    while found.len() < switches {
        let goal = SENSOR[usize::from(left > 0.0)];
        let off = |s: f64| {
            let sum: f64 = (0..n).map(|k| parts[k] * (rates[k] * s).exp() * waves[k]).sum();
            (left * (1.0 - place) + sum - goal) * if left > 0.0 { 1.0 } else { -1.0 }
        };
        // The sensor first goes on the other way: from where it has turned it is monotonous.
        let (mut before, mut after) = (0.0, 1e-3);
        while off(after) < 0.0 {
            (before, after) = (after, 1.5 * after);
        }
        for _ in 0..60 {
            let middle = f64::midpoint(before, after);
            *(if off(middle) < 0.0 { &mut before } else { &mut after }) = middle;
        }
        t += after;
        found.push(t);
        let change = if left > 0.0 { 1.0 } else { -1.0 };
        left = if left > 0.0 { 0.0 } else { 1.0 };
        for k in 0..n {
            parts[k] = parts[k] * (rates[k] * after).exp() + change * even[k];
        }
    }
    found
}

/// How far the switches of a rod of `n` cells are off the exact ones, and the seconds and steps
/// that a switch took.
fn measured(n: usize, switches: usize) -> Result<[f64; 3], Box<dyn Error>> {
    let rod = rod(n);
    let began = Instant::now();
    let run = Simulation::of(&rod).stepper(Rodas5P).tolerance(1e-7).most_jumps(switches);
    let run = run.run("on", vec![0.0; n].into(), 0.0..f64::INFINITY)?;
    let each = began.elapsed().as_secs_f64() / switches as f64;
    let jumps = run.trajectory.jumps().iter();
    let off = jumps.zip(exact(n, switches)).map(|(jump, exact)| (jump.t() - exact).abs()).fold(0.0, f64::max);
    Ok([off, each, run.end.stats.steps as f64 / switches as f64])
}

fn main() -> Result<(), Box<dyn Error>> {
    if std::env::args().nth(1).as_deref() != Some("cost") {
        for n in [30, 300] {
            let [off, _, steps] = measured(n, 6)?;
            println!("a rod of {n} cells: switches off by {off:.0e} at most, {steps:.0} steps each");
            assert!(off < 1e-6);
        }
        return Ok(());
    }
    let mut points = Vec::new();
    for n in [30, 100, 300, 1000, 3000, 10_000, 30_000] {
        let [off, each, steps] = measured(n, 6)?;
        let step = 1e6 * each / steps;
        println!("{n:6} cells: {:9.2} ms a switch, {steps:.0} steps of {step:.1} µs, off by {off:.0e}", 1e3 * each);
        points.push([(n as f64).log10(), step.log10()]);
    }
    growth("rod", "a step of a heated rod of N cells", ["cells (log₁₀ N)", "time of a step (log₁₀ µs)"], points)?;
    Ok(())
}
