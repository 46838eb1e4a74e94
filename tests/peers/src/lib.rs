//! The comparison of saltus with other Rust integrators: what it measures, and how.
//! `docs/trust/comparison.md` has the results.

pub mod machine;
pub mod right;
pub mod speed;
