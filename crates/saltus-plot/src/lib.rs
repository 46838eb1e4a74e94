//! SVG pictures of hybrid motion.
//!
//! A run in one line: [`Panels`] shows the coordinates of any trajectory of the engine against
//! time, [`Phase`] one against another.
//!
//! ```
//! use saltus::{Hybrid, Simulation};
//! use saltus_plot::{Panels, Phase};
//!
//! let ball = Hybrid::new()
//!     .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.81])
//!     .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.8 * x[1]]);
//! let run = Simulation::of(&ball).run("flight", [1.0, 0.0], 0.0..2.0)?;
//! let svg = Panels::of(&run.trajectory).named(["height (m)", "velocity (m/s)"]).svg()?;
//! assert!(svg.contains("height (m)") && svg.contains("Time (s)"));
//! assert!(Phase::of(&run.trajectory, 0, 1).svg()?.starts_with("<svg"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Or data in, text out: a [`HeightTime`] picture takes strokes, measurements, contacts and
//! residuals in seconds and metres, and gives one SVG document. Flights are drawn as what they are:
//! a parabola is one quadratic Bézier curve, not a polyline. The document names itself (`<title>`,
//! `<desc>`, `role="img"`), scales (`viewBox`), follows light and dark surroundings, needs no fonts
//! of its own, and tells lines and marks apart by shape as well as by colour.
//!
//! # Example
//!
//! ```
//! use saltus_plot::{HeightTime, Mark, Measured, Stroke};
//!
//! let fall = (2.0_f64 / 9.8).sqrt();
//! let svg = HeightTime::new("One metre, let go")
//!     .motion("free fall", [Stroke::over_time(0.0, fall, vec![1.0, 0.0, -4.9])])
//!     .measured([Measured::new(0.45, 0.0).time_error(0.01).mark(Mark::Contact)])
//!     .contacts([fall])
//!     .svg()?;
//! assert!(svg.starts_with("<svg") && svg.contains("Height (cm)") && svg.contains("Time (s)"));
//! # Ok::<(), saltus_plot::PlotError>(())
//! ```
//!
//! With the feature `scene` runs of scenes are drawn in one line (`record`), and sweeps of them
//! (`sweep`); with the feature `fit` reports of fits (`fit`).
//!
//! A [`Chart`] shows any two quantities against each other: velocity or energy against time, phase
//! portraits, paths to scale, loops.
//!
//! # Limits
//!
//! Letters are measured with the widths of
//! Helvetica; a much wider face may let neighbouring labels come close. Arcs that together are
//! narrower than 0.3 px are drawn as one stroke.

mod axis;
mod callout;
mod chart;
mod chart_page;
mod coordinate;
mod curve;
mod data;
mod error;
#[cfg(feature = "fit")]
pub mod fit;
mod grain;
mod heading;
mod height_time;
mod map;
mod marks;
mod measure;
mod page;
mod panel;
mod panels;
mod phase;
mod place;
mod polynomial;
#[cfg(feature = "scene")]
pub mod record;
mod residuals;
mod stroke;
mod svg;
#[cfg(feature = "scene")]
pub mod sweep;
mod theme;
mod traced;
mod unit;
mod wave;

pub use chart::{Chart, Disc};
pub use coordinate::Coordinate;
pub use data::{Mark, Measured, Residual};
pub use error::PlotError;
pub use height_time::HeightTime;
pub use map::Map;
pub use measure::Measure;
pub use panels::Panels;
pub use phase::Phase;
pub use stroke::Stroke;
pub use theme::Background;
pub use unit::HeightUnit;
