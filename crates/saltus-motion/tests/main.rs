//! Keyframes and the files of them by the crate's public interface, one program.
//! `cargo test -p saltus-motion readers::` runs one file of them.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)] // a test that cannot go on has failed

mod drop;
mod glb;

mod cycle;
mod files;
mod packages;
mod programs;
mod readers;
mod shape;
mod space;
