//! The coefficient of restitution (COR), with its uncertainty and an honest verdict, from recorded heights and times of a
//! bouncing ball.
//!
//! A [`Table`] is read from a file, or built from numbers in code; [`Fit`] turns it into a [`Report`]. The report says whether the
//! COR may be trusted, what each method gives, how heights and times go together, and what to measure next where they do not.
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

mod alone;
mod bootstrap;
mod bounces;
mod choice;
mod conic;
mod diagnose;
mod error;
mod estimate;
mod evidence;
mod fit;
mod joint;
mod least_squares;
mod mend;
mod model;
mod motion;
mod orientation;
mod outliers;
mod profile;
mod ratio;
mod ratios;
mod report;
mod residual;
mod rivals;
mod robust;
mod series;
mod settings;
mod spread;
mod statistics;
mod successive;
mod table;
mod tolerance;
mod weigh;

pub use bootstrap::Bootstrap;
pub use bounces::{BounceCor, Measured};
pub use choice::{CorModel, Limit, ModelChoice, SpeedCor, UnderLoss};
pub use error::{FitError, TableError};
pub use estimate::{Estimate, Source, Sourced};
pub use fit::Fit;
pub use joint::{Agreement, Conflict, Generous, Hypothesis, ImpliedGravity, TotalTime};
pub use motion::{Arc, Motion};
pub use profile::{Profile, ProfilePoint};
pub use report::{Cor, Report, Verdict};
pub use residual::{Measure, Point, Residual};
pub use robust::Loss;
pub use series::{Impact, Track, Variant};
pub use table::{Event, ReadOptions, Reading, Table, Trial};
pub use tolerance::Allowed;
