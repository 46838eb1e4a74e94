//! Scenes by the crate's public interface, one program. `cargo test -p saltus-scene ranges::` runs
//! one file of them.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)] // a test that cannot go on has failed

mod ends;
mod numbers;
mod polyline;
mod ranges;
mod records;
mod staging;
mod texts;
