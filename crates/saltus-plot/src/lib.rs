//! SVG pictures of hybrid motion.
//!
//! Data in, text out: a [`HeightTime`] picture takes arcs, measurements, contacts and residuals in seconds and metres, and
//! gives one SVG document. Flights are drawn as what they are: a parabola is one quadratic Bézier curve, not a polyline. The
//! document names itself (`<title>`, `<desc>`, `role="img"`), scales (`viewBox`), follows light and dark surroundings, needs no
//! fonts of its own, and tells lines and marks apart by shape as well as by colour.
//!
//! # Example
//!
//! ```
//! use saltus_plot::{Arc, HeightTime, Mark, Measured};
//!
//! let fall = (2.0_f64 / 9.8).sqrt();
//! let svg = HeightTime::new("One metre, let go")
//!     .motion("free fall", [Arc::new(0.0, fall, vec![1.0, 0.0, -4.9])])
//!     .measured([Measured::new(0.45, 0.0).time_error(0.01).mark(Mark::Contact)])
//!     .contacts([fall])
//!     .svg()?;
//! assert!(svg.starts_with("<svg") && svg.contains("Height (cm)") && svg.contains("Time (s)"));
//! # Ok::<(), saltus_plot::PlotError>(())
//! ```
//!
//! A [`Chart`] shows any two quantities against each other: velocity or energy against time, phase portraits, paths to scale, loops.
//!
//! # Limits
//!
//! The floor is at height zero. Letters are measured with the widths of Helvetica; a much wider face may let neighbouring
//! labels come close. Arcs that together are narrower than 0.3 px are drawn as one stroke.

mod axis;
mod callout;
mod chart;
mod chart_page;
mod curve;
mod data;
mod error;
mod heading;
mod height_time;
mod marks;
mod page;
#[cfg(feature = "scene")]
pub mod record;
mod residuals;
mod stroke;
mod svg;
mod theme;
mod unit;

pub use chart::{Chart, Disc, Measure};
pub use data::{Arc, Mark, Measured, Residual};
pub use error::PlotError;
pub use height_time::{Background, HeightTime};
pub use stroke::Stroke;
pub use unit::HeightUnit;
