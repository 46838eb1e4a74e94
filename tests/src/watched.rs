//! One flow whose guard is watched.

use saltus::{Edge, Entry, Hybrid, State};

/// A flow and a guard whose crossings in both directions are recorded and change nothing; the mode
/// is `run`, and its first edge the falling one.
pub fn watched<'a, S: State + 'a>(
    flow: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    guard: impl Fn(f64, &S) -> f64 + Send + Sync + Copy + 'a,
) -> Hybrid<'a, S> {
    watched_as(flow, guard, |edge| edge)
}

/// The same, the guard promised to be affine.
pub fn watched_affine<'a, S: State + 'a>(
    flow: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    guard: impl Fn(f64, &S) -> f64 + Send + Sync + Copy + 'a,
) -> Hybrid<'a, S> {
    watched_as(flow, guard, Edge::affine)
}

fn watched_as<'a, S: State + 'a>(
    flow: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    guard: impl Fn(f64, &S) -> f64 + Send + Sync + Copy + 'a,
    about: impl Fn(Edge<'a, S>) -> Edge<'a, S>,
) -> Hybrid<'a, S> {
    let falls = about(Edge::new(guard, |_t, x| x.clone())).entry(Entry::Wait);
    let rises = about(Edge::new(move |t, x| -guard(t, x), |_t, x| x.clone())).entry(Entry::Wait);
    Hybrid::new().mode("run", flow).edge_with("run", "run", falls).edge_with("run", "run", rises)
}
