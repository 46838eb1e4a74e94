//! The estimators: least squares and its relatives, one COR by each kind of reading, by both
//! together, and by recordings.

pub(crate) mod bootstrap;
pub(crate) mod bounces;
pub(crate) mod choice;
mod conic;
pub(crate) mod estimate;
pub(crate) mod fits;
pub(crate) mod joint;
pub(crate) mod kind;
pub(crate) mod least_squares;
pub(crate) mod one;
pub(crate) mod outliers;
pub(crate) mod profile;
pub(crate) mod ratio;
mod ratios;
pub(crate) mod robust;
pub(crate) mod series;
pub(crate) mod spread;
pub(crate) mod successive;
pub(crate) mod tolerance;
