//! What holds across the crates, one program: what the tests share is compiled and linked once, and
//! they run side by side. `cargo test -p saltus-tests floors::` runs one file of them.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)] // a test that cannot go on has failed

// Automata of functions are compiled there, once for all test programs.
use saltus_instances as _;

// The engine: known failures of others, planted roots, runs, derivatives, costs.
mod accumulation;
mod allocations;
mod certificate;
mod derived;
mod ensemble;
mod errors;
mod failures;
mod maps;
mod planted;
mod realtime;
mod running;
mod scheduled;
mod sensitivity;
mod sturm;
mod thresholds;

// Balls and scenes: closed forms, laws, random scenes.
mod accuracy;
mod balls;
mod closed;
mod compliant;
mod exact;
mod flock;
mod floors;
mod laws;
mod line;
mod plans;
mod scenes;
mod soak;

// Tables and the study.
mod fit;
mod fitted;
mod study;

// The house: the graph of imports, the pages and their listings.
mod imports;
mod listings;
mod pages;
