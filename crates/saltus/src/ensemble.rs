//! Many runs at once.

use std::ops::{ControlFlow, Range};

/// Makes the runs of `range` and hands what comes of each to `each`, in their order; `each` may end
/// the ensemble.
///
/// `run` is given a number and makes of it whatever is wanted: a parameter, a start, an automaton,
/// a run, and of that run what is to be kept. A run that fails is a value like any other. With the
/// cargo feature `rayon` the runs are made on all cores, or on those of the pool it is called in;
/// what `each` is given, and in which order, is the same to the bit on any number of threads as
/// long as `run` depends on its number alone.
///
/// Results wait for their turn in chunks, which grow from one run for each thread to what takes
/// about a twentieth of a second: so little is in memory at once, and what is slow is handed over
/// soon. When `each` ends the ensemble, some runs beyond may have been made in vain.
///
/// ```
/// use std::ops::ControlFlow;
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Error, Hybrid, Simulation, ensemble};
///
/// // A thousand balls that leave the floor at 1 m/s to 2 m/s, each until its third impact.
/// let third = |k: usize| -> Result<f64, Error> {
///     let ball = Hybrid::new()
///         .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.8])
///         .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.5 * x[1]]);
///     let start = vector![0.0, 1.0 + 1e-3 * k as f64];
///     let run = Simulation::of(&ball).most_jumps(3).run("flight", start, 0.0..10.0).map_err(|failed| failed.error)?;
///     Ok(run.trajectory.end().seconds())
/// };
/// let mut times = Vec::new();
/// let done: ControlFlow<Error> = ensemble(0..1000, third, |_, time| match time {
///     Ok(time) => {
///         times.push(time);
///         ControlFlow::Continue(())
///     }
///     Err(error) => ControlFlow::Break(error),
/// });
/// assert!(done.is_continue());
/// for (k, time) in times.iter().enumerate() {
///     assert!((time - 2.0 * (1.0 + 1e-3 * k as f64) / 9.8 * 1.75).abs() < 1e-9);
/// }
/// ```
pub fn ensemble<T, B>(
    range: Range<usize>,
    run: impl Fn(usize) -> T + Sync,
    mut each: impl FnMut(usize, T) -> ControlFlow<B>,
) -> ControlFlow<B>
where
    T: Send,
{
    #[cfg(feature = "rayon")]
    {
        chunks(range, &run, &mut each)
    }
    #[cfg(not(feature = "rayon"))]
    {
        for k in range {
            each(k, run(k))?;
        }
        ControlFlow::Continue(())
    }
}

#[cfg(feature = "rayon")]
fn chunks<T: Send, B>(
    range: Range<usize>,
    run: &(impl Fn(usize) -> T + Sync),
    each: &mut impl FnMut(usize, T) -> ControlFlow<B>,
) -> ControlFlow<B> {
    use std::time::{Duration, Instant};

    use rayon::prelude::*;

    /// What a chunk may take before the next is no larger, and how large one gets.
    const LONG: Duration = Duration::from_millis(25);
    const LARGEST: usize = 1 << 14;
    /// In how many parts for each thread a chunk is made, so that none waits long for the last of
    /// another.
    const PARTS: usize = 64;

    let threads = rayon::current_num_threads();
    let mut size = threads;
    let mut results = Vec::new();
    let mut start = range.start;
    while start < range.end {
        let end = range.end.min(start.saturating_add(size));
        let clock = Instant::now();
        let part = (end - start).div_ceil(PARTS * threads);
        (start..end).into_par_iter().with_max_len(part).map(run).collect_into_vec(&mut results);
        let took = clock.elapsed();
        for (k, result) in (start..end).zip(results.drain(..)) {
            each(k, result)?;
        }
        if took < LONG {
            size = size.saturating_mul(2).min(LARGEST.max(size));
        }
        start = end;
    }
    ControlFlow::Continue(())
}
