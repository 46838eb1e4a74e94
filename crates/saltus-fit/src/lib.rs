//! The coefficient of restitution (COR), with its uncertainty and an honest verdict, from recorded
//! heights and times of a bouncing ball.
//!
//! A [`Table`] is read from a file, or built from numbers in code; [`Fit`] turns it into a
//! [`Report`]. The report says whether the COR may be trusted, what each method gives, how heights
//! and times go together, and what to measure next where they do not.
//!
//! ```
//! use saltus_fit::{Fit, Table, Verdict};
//!
//! // Impact times read off a sound recording, each to 5 ms.
//! let times = [0.587, 1.549, 2.403, 3.164, 3.845, 4.452, 5.002, 5.497, 5.930, 6.334, 6.687, 7.009];
//! let report = Fit::new().sigma_time(0.005).run(&Table::from_contacts(&times)?)?;
//!
//! let cor = report.cor().expect("twelve contacts determine a COR");
//! assert_eq!(report.verdict(), Verdict::Trusted);
//! assert!((cor.value - 0.8960).abs() < 0.0002);
//! assert!(cor.standard_error.is_some_and(|s| s < 0.0005));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Tests may ask the system what is right.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod compare;
mod elementary;
mod error;
mod evidence;
mod finding;
mod fit;
mod model;
mod orientation;
mod plan;
mod quantity;
// What reading decides by logarithms has steps that no last bit comes near.
#[allow(clippy::disallowed_methods)]
mod read;
mod report;
mod solve;
mod sound;
mod statistics;
mod verdict;
mod word;

pub use compare::explain::{Agreement, Conflict, Generous, Hypothesis, ImpliedGravity, TotalTime};
pub use error::{FitError, TableError};
pub use finding::{
    Air, At, Basis, By, Cause, Change, Doubt, Finding, FindingKind, Gives, Lines, Missing, Named, Need, Note, Pace,
    Parts, Program, Remark, Repair, Severity, Shape, Spot, Untried, Warning, Widening,
};
pub use fit::Fit;
pub use plan::Expected;
pub use quantity::{Ball, CorModel, Explanation, Loss, Measured, Method, Readings, Source, Sourced};
pub use read::{Event, LeftAside, Part, ReadOptions, Reading, Table, Trial, Why};
pub use report::{Arc, Difference, Group, Mark, Measure, Motion, Plan, Planned, Point, Report, Residual, Way};
pub use solve::bootstrap::Bootstrap;
pub use solve::bounces::BounceCor;
pub use solve::choice::{Limit, ModelChoice, SpeedCor, UnderLoss};
pub use solve::estimate::Estimate;
pub use solve::profile::{Profile, ProfilePoint};
pub use solve::series::{Impact, Track, Variant};
pub use solve::tolerance::Allowed;
pub use sound::{Contact, Sound, Wave};
pub use verdict::{Cor, Verdict};
