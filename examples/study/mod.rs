//! A study of a bouncing ball, reproduced: four formulas for one recorded motion, what holds of
//! each, and what the film can tell.
//!
//! A squash ball was dropped from 1 m on cement and filmed at 30 frames per second, ten times;
//! `data/squash-on-cement.csv` has the means. The program `study` runs what is here and draws it;
//! `docs/trust/study.md` tells it. Numbers in brackets, as in (8), are those that the study gives
//! its equations.

pub mod equations;
pub mod film;
pub mod keys;
pub mod stages;
pub mod trials;

use saltus_fit::{Fit, ReadOptions, Report, Table};

/// Gravity as the study takes it, in m/s².
pub const GRAVITY: f64 = 9.8;
/// The height of release in m.
pub const DROP: f64 = 1.0;
/// The times of the three contacts in s.
pub const CONTACTS: [f64; 3] = [0.45, 0.85, 1.11];
/// The heights of the two rebounds in m.
pub const REBOUNDS: [f64; 2] = [0.30, 0.10];
/// What the study's last formula gives for the last of the contacts, in s.
pub const MODELLED: f64 = 1.10;
/// What the study takes off the duration of each flight, in s.
pub const EARLY: f64 = 0.01;
/// The radius of a squash ball in m.
pub const RADIUS: f64 = 0.02;

/// The study's table as `saltus fit` reports on it.
///
/// # Errors
/// If the table cannot be read or fitted.
pub fn report() -> Result<Report, Box<dyn std::error::Error>> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("data/squash-on-cement.csv");
    Ok(Fit::new().run(&Table::read(&path, &ReadOptions::default())?)?)
}
