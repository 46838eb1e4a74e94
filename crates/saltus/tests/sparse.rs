//! Patterns of Jacobians: found, colored, solved, and refused where they leave out an entry.

use std::collections::BTreeSet;

use proptest::prelude::*;
use saltus::{Auto, ErrorKind, Hybrid, Rodas5P, Simulation, Sparsity, Vector};
use saltus_cases::cases;

/// The rows of a pattern, each with its own coordinate.
type Rows = Vec<BTreeSet<usize>>;

fn sparsity(rows: &Rows) -> Sparsity {
    Sparsity::rows(rows.iter().map(|row| row.iter().copied()))
}

/// Each coordinate is drawn to a mean of what it reads, and moved by a little of its product.
fn flow(rows: &Rows, t: f64, x: &Vector) -> Vector {
    Vector::from_fn(rows.len(), |i| {
        let (mut sum, mut product) = (0.0, 1e-3);
        for &j in &rows[i] {
            let weight = 0.4 + 0.5 * ((7 * i + 3 * j) as f64).sin();
            (sum, product) = (sum + weight * x[j], product * (0.5 + x[j]));
        }
        100.0 * (sum / rows[i].len() as f64 - x[i]) + t.sin() + product
    })
}

/// Patterns of 1 to 60 coordinates: bands, rings, grids, stars, and entries anywhere.
fn patterns() -> impl Strategy<Value = Rows> {
    let kinds =
        (1_usize..60, 0_usize..5, 0_usize..5, 0_usize..5, prop::collection::vec((0_usize..60, 0_usize..60), 0..40));
    kinds.prop_map(|(n, kind, below, above, anywhere)| {
        let row = |i: usize| -> BTreeSet<usize> {
            let all: Vec<usize> = match kind {
                0 => (i.saturating_sub(below)..=i + above).collect(),
                1 => vec![(i + n - 1) % n, i, (i + 1) % n],
                2 => vec![i.wrapping_sub(7), i.wrapping_sub(1), i, i + 1, i + 7],
                3 => {
                    if i == 0 {
                        (0..n).collect()
                    } else {
                        vec![0, i]
                    }
                }
                _ => anywhere.iter().filter(|(row, _)| *row == i).map(|&(_, j)| j).collect(),
            };
            all.into_iter().filter(|&j| j < n).chain([i]).collect()
        };
        (0..n).map(row).collect()
    })
}

fn start(n: usize) -> Vector {
    Vector::from_fn(n, |i| (1.7 * i as f64).cos())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(200)))]

    /// Whatever the pattern, it is found from a flow that has it.
    #[test]
    fn a_pattern_is_found(rows in patterns(), flat in any::<bool>()) {
        let x = if flat { Vector::from_fn(rows.len(), |_| 0.0) } else { start(rows.len()) };
        prop_assert_eq!(Sparsity::found(&x, |x| flow(&rows, 0.3, x)), sparsity(&rows));
    }

    /// A run by the pattern is the run without one, to within the tolerance.
    #[test]
    fn a_pattern_changes_no_result(rows in patterns()) {
        let hybrid = || {
            let rows = rows.clone();
            Hybrid::new().mode("run", move |t, x: &Vector| flow(&rows, t, x))
                .switch("run", "rest", |t, _x: &Vector| 0.7 - t).mode("rest", |_t, x| x.iter().map(|_| 0.0).collect())
        };
        let run = |hybrid: &Hybrid<'_, Vector>| {
            let run = Simulation::of(hybrid).stepper(Rodas5P).tolerance(1e-8).run("run", start(rows.len()), 0.0..1.0);
            run.unwrap().end
        };
        let (by_pattern, without) = (run(&hybrid().sparse("run", sparsity(&rows))), run(&hybrid()));
        for i in 0..rows.len() {
            prop_assert!((by_pattern.state[i] - without.state[i]).abs() < 1e-6, "{i}");
        }
        prop_assert!(by_pattern.stats.flows <= without.stats.flows + 200);
    }

    /// A pattern that leaves out an entry is an error that names it.
    #[test]
    fn what_is_left_out_is_named(rows in patterns(), which in any::<prop::sample::Index>(), stiff in any::<bool>()) {
        let entries: Vec<_> = rows.iter().enumerate()
            .flat_map(|(i, row)| row.iter().filter(move |&&j| j != i).map(move |&j| (i, j))).collect();
        prop_assume!(!entries.is_empty());
        let (i, j) = entries[which.index(entries.len())];
        let mut less = rows.clone();
        less[i].remove(&j);
        let hybrid = Hybrid::new().mode("run", |t, x: &Vector| flow(&rows, t, x)).sparse("run", sparsity(&less));
        let stepper = if stiff { Auto::from(Rodas5P) } else { Auto::new() };
        let error = Simulation::of(&hybrid).stepper(stepper).run("run", start(rows.len()), 0.0..9.0).unwrap_err().error;
        prop_assert_eq!(error.kind(), ErrorKind::Sparsity);
        let text = error.to_string();
        prop_assert!(text.contains(&format!("leaves out that x{i}' reads x{j}:")), "{text}");
    }
}

#[test]
fn a_pattern_of_another_length_is_an_error() {
    for (n, of) in [(3, 4), (40, 39), (40, 0)] {
        let hybrid = Hybrid::new().mode("run", |_t, x: &Vector| x.clone()).sparse("run", Sparsity::banded(of, 1, 1));
        let error = Simulation::of(&hybrid).run("run", start(n), 0.0..1.0).unwrap_err().error;
        assert_eq!(error.kind(), ErrorKind::Sparsity);
        let text = error.to_string();
        assert!(
            text.starts_with(&format!("the sparsity of the mode has {of} coordinates where the state has {n}:")),
            "{text}"
        );
    }
    // Coordinates that do not exist, of rows.
    let hybrid = Hybrid::new().mode("run", |_t, x: &Vector| x.clone()).sparse("run", Sparsity::rows([[0], [7]]));
    let error = Simulation::of(&hybrid).run("run", start(2), 0.0..1.0).unwrap_err().error;
    assert!(error.to_string().contains("has 8 coordinates where the state has 2"), "{error}");
}

/// A rod of cells: the evaluations of a step do not grow with its length.
#[test]
fn evaluations_do_not_grow_with_the_coordinates() {
    for n in [100, 1000, 5000] {
        let by = (n * n) as f64;
        let heat = move |_t: f64, u: &Vector| {
            Vector::from_fn(n, |i| {
                let at = |j: Option<usize>| j.filter(|&j| j < n).map_or(0.0, |j| u[j]);
                by * (at(i.checked_sub(1)) - 2.0 * u[i] + at(Some(i + 1)))
            })
        };
        let rod = Hybrid::new().mode("heat", heat).sparse("heat", Sparsity::banded(n, 1, 1));
        let start = Vector::from_fn(n, |i| (std::f64::consts::PI * (i + 1) as f64 / (n + 1) as f64).sin());
        let stats = Simulation::of(&rod).stepper(Rodas5P).run("heat", start, 0.0..0.1).unwrap().end.stats;
        assert!(stats.flows <= 19 * (stats.steps + stats.rejected), "{n}: {stats:?}");
        // Found again in as many evaluations as the logarithm of its length asks for.
        let mut asked = 0;
        let x = Vector::from_fn(n, |i| i as f64);
        let found = Sparsity::found(&x, |u| {
            asked += 1;
            heat(0.0, u)
        });
        assert_eq!(found, Sparsity::banded(n, 1, 1));
        assert!(asked <= 8 * (n as f64).log2().ceil() as usize, "{n}: {asked}");
    }
}

/// A grid of 40 by 40 cells, whose band is wide: with the feature `sparse` it is solved as it is,
/// and to the same result.
#[test]
fn a_wide_band_is_solved() {
    let k = 40_usize;
    let n = k * k;
    let neighbours = move |i: usize| {
        let (row, column) = (i / k, i % k);
        let beside = [
            (row > 0, i.wrapping_sub(k)),
            (row + 1 < k, i + k),
            (column > 0, i.wrapping_sub(1)),
            (column + 1 < k, i + 1),
        ];
        beside.into_iter().filter(|(is, _)| *is).map(|(_, j)| j)
    };
    let by = ((k + 1) * (k + 1)) as f64;
    let heat =
        move |_t: f64, u: &Vector| Vector::from_fn(n, |i| by * (neighbours(i).map(|j| u[j]).sum::<f64>() - 4.0 * u[i]));
    let plate = Hybrid::new().mode("heat", heat).sparse("heat", Sparsity::rows((0..n).map(neighbours)));
    // The slowest wave of the plate dies away by itself.
    let wave = |i: usize| (std::f64::consts::PI * (i + 1) as f64 / (k + 1) as f64).sin();
    let start = Vector::from_fn(n, |i| wave(i / k) * wave(i % k));
    let rate = 8.0 * by * (0.5 * std::f64::consts::PI / (k + 1) as f64).sin().powi(2);
    let run = Simulation::of(&plate).stepper(Rodas5P).tolerance(1e-8).run("heat", start.clone(), 0.0..0.1).unwrap();
    for i in 0..n {
        assert!((run.end.state[i] - start[i] * (-0.1 * rate).exp()).abs() < 1e-8, "{i}");
    }
}

/// Coordinates below the smallest normal number have differences all the same.
#[test]
fn what_hardly_is_may_be_moved() {
    let n = 400;
    let heat = move |_t: f64, u: &Vector| {
        Vector::from_fn(n, |i| {
            1e5 * (if i == 0 { 1.0 } else { u[i - 1] } - 2.0 * u[i] + if i + 1 < n { u[i + 1] } else { 0.0 })
        })
    };
    let rod = Hybrid::new().mode("heat", heat).sparse("heat", Sparsity::banded(n, 1, 1));
    let run = Simulation::of(&rod).stepper(Rodas5P).run("heat", Vector::from_fn(n, |_| 0.0), 0.0..1e-3).unwrap();
    assert!((run.end.state[0] - 0.92).abs() < 0.05, "{}", run.end.state[0]);
}
