//! A run as a table: regular times, and both limits at each jump.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use proptest::prelude::*;
use saltus::{Clock, Hybrid, Sample, Sampler, Simulation};

type Rows = Vec<Sample<&'static str, f64>>;

/// A saw: x' = 1, back to zero at `top`, and 1 added by a clock.
fn saw(top: f64, kick: f64) -> Hybrid<'static, f64> {
    Hybrid::new()
        .mode("rise", |_t, _x: &f64| 1.0)
        .edge("rise", "rise", move |_t, x| top - x, |_t, _x| 0.0)
        .entry("rise", "rise", saltus::Entry::Fire)
        .clock("rise", "rise", Clock::every(kick), |_t, x| x + 1.0)
}

proptest! {
    /// The rows of an observer are those of the recorded run; each is the state there; ticks and ends
    /// of arcs are there, each once, in the order of hybrid time.
    #[test]
    fn rows_are_the_run(top in 0.3..3.0_f64, kick in 0.1..2.0_f64, ticks in 1..60_u32, from in -3.0..3.0_f64) {
        let dt = f64::from(ticks) / 32.0;
        let (model, end) = (saw(top, kick), from + 5.0);
        let run = Simulation::of(&model).run("rise", 0.0, from..end).unwrap();
        let mut sampler = Sampler::every(dt);
        Simulation::of(&model).drive("rise", 0.0, from..end, &mut sampler).unwrap();
        let rows: Rows = sampler.rows().collect();
        prop_assert_eq!(&rows, &run.trajectory.sampled(dt).rows().collect::<Rows>());
        prop_assert!(rows.windows(2).all(|pair| (pair[0].t, pair[0].j) < (pair[1].t, pair[1].j)));
        for row in &rows {
            let limits = [run.trajectory.at(row.t).unwrap(), run.trajectory.before(row.t).unwrap()];
            let among = run.trajectory.jumps().iter().filter(|jump| jump.t() == row.t).flat_map(|jump| [jump.before, jump.after]);
            prop_assert!(limits.into_iter().chain(among).any(|x| (x - row.state).abs() < 1e-12), "{:?}", row);
        }
        for k in 0.. {
            let t = f64::from(k).mul_add(dt, from);
            if t > end {
                break;
            }
            let mut times: Vec<f64> = rows.iter().map(|row| row.t).filter(|time| (time - t).abs() < 1e-13).collect();
            times.dedup();
            prop_assert_eq!(times.len(), 1, "at {}", t);
        }
        for jump in run.trajectory.jumps() {
            let at = rows.iter().filter(|row| row.t == jump.t() && (row.j == jump.j || row.j + 1 == jump.j));
            prop_assert_eq!(at.map(|row| row.state).collect::<Vec<_>>(), [jump.before, jump.after]);
        }
    }
}

/// Runs without duration, without end, and with a step that is none.
#[test]
fn tables_of_odd_runs() {
    let model = saw(1.0, 0.75);
    let rows = |dt: f64, span: std::ops::Range<f64>| -> usize {
        Simulation::of(&model).most_jumps(10).run("rise", 0.0, span).unwrap().trajectory.sampled(dt).rows().count()
    };
    assert_eq!(rows(0.1, 2.0..2.0), 1);
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(rows(dt, 0.1..0.7), 2);
    }
    let rest = Hybrid::new().mode("rest", |_t, _x: &f64| 0.0);
    let run = Simulation::of(&rest).run("rest", 1.0, 0.0..f64::INFINITY).unwrap();
    assert!(run.trajectory.sampled(0.5).rows().count() < 10_000_100);
}

/// Headings and cells with commas and quotes are quoted.
#[test]
fn a_table_is_csv() {
    let model = Hybrid::new().mode("a, \"b\"", |_t, _x: &[f64; 2]| [1.0, 0.0]);
    let run = Simulation::of(&model).run("a, \"b\"", [0.0, 1e-300], 0.0..1.0).unwrap();
    let text = run.trajectory.sampled(1.0).to_string();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "t (s),j,mode,x0,x1");
    assert!(lines[1].starts_with("0.0,0,\"a, ") && lines[1].ends_with(",0.0,1e-300"), "{text}");
}
