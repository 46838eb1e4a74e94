//! The tests of the crate by its public interface, one program: what they share is compiled and
//! linked once, and they run side by side. `cargo test -p saltus-fit reading::` runs one file of
//! them; `memory.rs` measures its own process, and is a program of its own.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)] // a test that cannot go on has failed

// Planted readings and files.
mod film;
mod noise;
mod random;
mod typed;
mod written;

// Reading: tables that people handed in, layouts, words, files.
mod abroad;
mod against;
mod around;
mod batches;
mod beside;
mod candidates;
mod conditions;
mod everyday;
mod exported;
mod files;
mod filled;
mod forms;
mod handed;
mod headings;
mod hostile;
mod instruments;
mod kinds;
mod languages;
mod layouts;
mod meant;
mod neighbours;
mod newcomers;
mod old_workbooks;
mod pairs;
mod reading;
mod records;
mod remarks;
mod said;
mod school;
mod sections;
mod sensors;
mod shares;
mod sheets;
mod stand_ins;
mod stated;
mod told;
mod unnamed;
mod unscaled;
mod whence;
mod wording;

// Estimation: what is planted is found, and how far that can be believed.
mod air;
mod coverage;
mod films;
mod laws;
mod models;
mod outliers;
mod physics;
mod plans;
mod planted;
mod recordings;
mod series;
mod sound;
mod stability;
mod study;
mod trust;
mod unseen;

// The house: findings, constants from both sides, stages.
mod bounds;
mod contract;
mod decides;
mod devices;
mod findings;
mod inside;
mod limits;
mod searches;
mod structure;
