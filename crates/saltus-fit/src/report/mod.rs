//! The report: the verdict, the COR, and everything it rests on, for people and for programs.

mod build;
mod contract;
mod film;
mod groups;
mod lines;
mod motion;
mod numbers;
mod plan;
mod planned;
mod recordings;
mod residual;
mod scene;
mod text;
mod words;

pub(crate) use build::Extras;
pub use contract::{Difference, Group, Report};
pub use motion::{Arc, Motion};
pub use plan::{Plan, Planned, Way};
pub use residual::{Mark, Measure, Point, Residual};
