//! Many runs at once: the same on any number of threads, in order, ended when it is asked.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::ThreadPoolBuilder;
use saltus::nalgebra::{Vector2, vector};
use saltus::{Error, ErrorKind, Hybrid, Simulation, ensemble};

/// A ball with drag that falls from a height of its own; the 17th starts where no number is.
fn last_impact(k: usize) -> Result<[u64; 3], Error> {
    let height = if k == 17 { f64::NAN } else { 1.0 + 0.01 * f64::from(u32::try_from(k).unwrap()) };
    let ball = Hybrid::new()
        .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.81 - 0.1 * x[1].abs() * x[1]])
        .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.8 * x[1]]);
    let run = Simulation::of(&ball).run("flight", vector![height, 0.0], 0.0..1.5).map_err(|failed| failed.error)?;
    let last = run.trajectory.jumps().last().unwrap();
    Ok([last.t().to_bits(), run.end.state[0].to_bits(), run.end.stats.flows])
}

fn on<T: Send>(threads: usize, f: impl FnOnce() -> T + Send) -> T {
    ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(f)
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let all = |threads| {
        on(threads, || {
            let mut rows = Vec::new();
            let done: ControlFlow<()> = ensemble(0..300, last_impact, |k, row| {
                rows.push((k, row.map_err(|error| error.to_string())));
                ControlFlow::Continue(())
            });
            assert!(done.is_continue());
            rows
        })
    };
    let one = all(1);
    assert!(one.iter().map(|(k, _)| *k).eq(0..300));
    assert_eq!(one, all(2));
    assert_eq!(one, all(8));
    // One run fails, and those after it are made all the same.
    let failed: Vec<usize> = one.iter().filter(|(_, row)| row.is_err()).map(|(k, _)| *k).collect();
    assert_eq!(failed, [17]);
    assert_eq!(last_impact(17).unwrap_err().kind(), ErrorKind::InitialState);
    // And they differ: higher balls land later.
    let first = one[0].1.as_ref().unwrap();
    assert!(one[1..17].iter().all(|(_, row)| row.as_ref().unwrap() != first));
}

#[test]
fn it_ends_when_it_is_asked() {
    for threads in [1, 2, 8] {
        let made = AtomicUsize::new(0);
        let mut seen = Vec::new();
        let ended = on(threads, || {
            let run = |k: usize| {
                made.fetch_add(1, Ordering::Relaxed);
                k * k
            };
            ensemble(5..usize::MAX, run, |k, square| {
                seen.push(square);
                if k == 40 { ControlFlow::Break(k) } else { ControlFlow::Continue(()) }
            })
        });
        assert_eq!(ended, ControlFlow::Break(40));
        assert!(seen.iter().copied().eq((5..=40).map(|k| k * k)));
        // What is made in vain is at most a chunk, which doubles from the number of threads.
        let made = made.load(Ordering::Relaxed);
        assert!((36..=2 * 36 + threads).contains(&made), "{made} runs on {threads} threads");
    }
}

#[test]
fn nothing_is_asked_of_an_empty_range() {
    let nothing = |_: usize| panic!("there is no such run");
    let done: ControlFlow<()> = ensemble(3..3, nothing, |_, ()| panic!("there is no such result"));
    assert!(done.is_continue());
}
