//! Bouncing balls.
pub mod units;
