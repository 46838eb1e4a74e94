//! Pictures by the crate's public interface, one program. `cargo test -p saltus-plot runs::` runs
//! one file of them.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)] // a test that cannot go on has failed

// Automata of functions are compiled there, once for all test programs.
use saltus_instances as _;

mod pictures;

mod chart;
mod degenerate;
mod document;
mod raster;
mod runs;
