//! The command `saltus`, run as its users run it, one program: what the tests share is compiled and
//! linked once. `cargo test -p saltus-cli sweep::` runs one file of them.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)] // a test that cannot go on has failed

mod tool;

mod accuracy;
mod cli;
mod export;
mod fit;
mod library;
mod parts;
mod ranges;
mod scene;
mod solve;
mod sweep;
