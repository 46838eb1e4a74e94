//! `saltus` integrates **hybrid automata**: continuous flow, guards, resets. Every fall of a guard is
//! found that a step's samples show, and none of an affine guard is missed; where rounding or haste
//! may hide one, the run says so; and every run ends, by name.
//!
//! Describe a system with closures ([`Hybrid`]) or as a type ([`Automaton`]), then run it ([`Simulation`]).
//!
//! ```
//! use saltus::nalgebra::{self, Vector2, vector};
//! use saltus::{Hybrid, Simulation};
//!
//! let ball = Hybrid::new()
//!     .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.8])
//!     .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.5 * x[1]])
//!     .mode("rest", |_t, _x| vector![0.0, 0.0])
//!     .beyond("flight", "rest", |_t, _x| vector![0.0, 0.0]);
//! let run = Simulation::of(&ball).run("flight", vector![1.0, 0.0], 0.0..4.0)?;
//!
//! assert_eq!(run.mode, "rest");
//! let rest = run.trajectory.jumps().last().unwrap();
//! assert!((rest.t() - 1.355_261_854_357_877).abs() < 1e-12);
//! # Ok::<(), saltus::Error>(())
//! ```
//!
//! A run is a hybrid arc on hybrid time (t, j): j counts jumps, so several jumps may share one t. At a jump the state has two limits,
//! [`Trajectory::before`] and [`Trajectory::at`].

mod advance;
mod automaton;
mod certificate;
mod clocks;
mod control;
mod copies;
mod course;
pub mod cross;
mod distance;
mod edges;
mod ending;
mod ensemble;
mod error;
mod filippov;
mod frames;
mod hybrid;
#[cfg(feature = "num-dual")]
mod linearize;
mod observe;
mod poly;
mod recent;
#[cfg(feature = "num-dual")]
pub mod return_map;
mod reverse;
mod series;
mod simulation;
mod solution;
mod state;
pub mod step;
mod time;
mod trajectory;
mod work;
mod zeno;

pub use nalgebra;
#[cfg(feature = "num-dual")]
pub use num_dual;

pub use automaton::{About, Automaton, Entry, Limit};
pub use certificate::{Certificate, Tally};
pub use clocks::{Clock, Clocks, Ticking};
pub use course::{Checkpoint, Course};
pub use distance::Closeness;
pub use edges::Edges;
pub use ending::{Ending, Failed, Limits, Run, Stats, Stop};
pub use ensemble::ensemble;
pub use error::{Error, ErrorKind, Refusal};
pub use filippov::{Filippov, Passage, Side, Sides, TwoSided};
pub use frames::frame_by_frame;
pub use hybrid::{Edge, Hybrid, Link};
#[cfg(feature = "num-dual")]
pub use linearize::{Lift, Linearize, Number, Over, Saltation, Sensitive, Tangent, Wrt, saltation};
pub use observe::{Inspection, Observer};
pub use reverse::{Invertible, Reversed};
pub use series::{Jet, Series};
pub use simulation::Simulation;
pub use solution::{Fall, Polynomial, Solution};
pub use state::{Coords, State};
pub use step::{Auto, Dop853, Rodas5P, Tsit5};
pub use time::Time;
pub use trajectory::{Arc, Cause, Jump, Piece, Trajectory};
pub use work::{Timing, WorkPoint, WorkPrecision};
