//! `saltus` integrates **hybrid automata**: continuous flow, guards, resets. Every fall of a guard
//! is found that a step's samples show, and none of an affine guard is missed; where rounding or
//! haste may hide one, the run says so; and every run ends, by name.
//!
//! Describe a system with closures ([`Hybrid`]) or as a type ([`Automaton`]), then run it
//! ([`Simulation`]).
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
//! assert_eq!(run.end.mode, "rest");
//! let rest = run.trajectory.jumps().last().unwrap();
//! assert!((rest.t() - 1.355_261_854_357_877).abs() < 1e-12);
//! # Ok::<(), saltus::Error>(())
//! ```
//!
//! A run is a hybrid arc on hybrid time (t, j): j counts jumps, so several jumps may share one t.
//! At a jump the state has two limits, [`Trajectory::before`] and [`Trajectory::at`].

mod advance;
mod analysis;
mod automaton;
mod certainty;
mod certificate;
mod checkpoint;
mod control;
mod course;
pub mod cross;
mod ending;
mod ensemble;
mod error;
mod filippov;
mod hybrid;
mod inspection;
mod jump;
mod memory;
mod observe;
mod piece;
mod poly;
mod recent;
mod samples;
mod series;
mod signal;
mod simulation;
mod sparsity;
mod state;
pub mod step;
mod table;
mod ticks;
mod time;
mod trajectory;
mod vector;
mod zeno;

pub use nalgebra;
#[cfg(feature = "num-dual")]
pub use num_dual;
#[cfg(all(feature = "derive", feature = "num-dual"))]
pub use saltus_derive::Lift;
#[cfg(feature = "derive")]
pub use saltus_derive::State;

pub use analysis::distance::Closeness;
pub use analysis::frames::frame_by_frame;
#[cfg(feature = "num-dual")]
pub use analysis::linearize::{
    Lift, Linearize, LinearizeSides, Number, Over, Saltation, Sensitive, Tangent, Wrt, saltation,
};
#[cfg(feature = "num-dual")]
pub use analysis::return_map;
pub use analysis::reverse::{Invertible, Reversed};
pub use analysis::work::{Timing, WorkPoint, WorkPrecision};
pub use automaton::clocks::{Clock, Clocks, Ticking};
pub use automaton::edges::Edges;
pub use automaton::solution::{Fall, Polynomial, Solution};
pub use automaton::{About, Automaton, Entry, Limit};
pub use certificate::{Certificate, CertificateOf, Tally};
pub use checkpoint::{Checkpoint, CheckpointOf};
pub use course::Course;
pub use ending::{Ending, EndingOf, Failed, FailedOf, Limits, Run, RunOf, Stats, Stop};
pub use ensemble::ensemble;
pub use error::{Error, ErrorKind, Refusal};
pub use filippov::{Filippov, Passage, Side, Sides, TwoSided};
pub use hybrid::{Edge, Hybrid, Link};
pub use inspection::{Inspection, InspectionOf};
pub use jump::{Cause, Jump, JumpOf};
pub use observe::Observer;
pub use piece::Piece;
pub use samples::{Sample, Sampler, SamplerOf, SamplingError};
pub use series::{Formula, Jet, Op, Series};
pub use signal::{Signal, SignalError};
pub use simulation::Simulation;
pub use sparsity::Sparsity;
pub use state::{Coords, State, TooMany};
pub use step::{Auto, Dop853, Rodas5P, Tsit5};
pub use table::{JumpTable, JumpTableOf};
pub use time::Time;
pub use trajectory::{Arc, Trajectory, TrajectoryOf};
pub use vector::Vector;
