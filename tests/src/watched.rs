//! One flow whose guard is watched.

use saltus::{Entry, Hybrid, State};

/// A flow and a guard whose crossings in both directions are recorded and change nothing; the mode
/// is `run`, and its first edge the falling one.
pub fn watched<'a, S: State + 'a>(
    flow: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    guard: impl Fn(f64, &S) -> f64 + Send + Sync + Copy + 'a,
) -> Hybrid<'a, S> {
    Hybrid::new()
        .mode("run", flow)
        .edge("run", "run", guard, |_t, x| *x)
        .edge("run", "run", move |t, x| -guard(t, x), |_t, x| *x)
        .entry("run", "run", Entry::Wait)
}
