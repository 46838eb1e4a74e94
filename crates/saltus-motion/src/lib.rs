//! Bouncing motion as animation: the fewest keys that are exact, whole frames where they are
//! wanted, and files that animators load.
//!
//! A [`Motion`] is data: for each ball, polynomials in time from contact to contact.
//! [`Motion::cut`] ends the infinitely many last hops, [`Motion::snapped`] moves contacts to whole
//! frames, and an [`Export`] writes it as any [`Format`], with bounds of its error. Lengths are in
//! metres and times in seconds, unless a file has another [`Space`]; places are (x, y, up) of the
//! ball's lowest point, so that 0 is touch.
//!
//! ```
//! use saltus_motion::{Contact, Export, Format, Frames, Motion, Piece, Shape, Snap, Space, Stretch, Track};
//!
//! // One metre down, and up again half as fast.
//! let arc = |start: f64, span: f64, height: f64, speed: f64| Stretch {
//!     contact: (start > 0.0).then(|| Contact::level(2.0 * speed)),
//!     flight: true,
//!     pieces: vec![Piece {
//!         start,
//!         span,
//!         coefficients: vec![[0.0, 0.0, height], [0.0, 0.0, speed], [0.0, 0.0, -4.905]],
//!         spin: Vec::new(),
//!     }],
//! };
//! let fall = (2.0_f64 / 9.81).sqrt();
//! let stretches = vec![arc(0.0, fall, 1.0, 0.0), arc(fall, fall, 0.0, 4.905 * fall)];
//! let ball = Track { name: "ball".into(), radius: 0.02, stretches };
//! let motion = Motion::new("drop", vec![ball], Vec::new())?;
//!
//! let frames = Frames::new("24".parse()?);
//! let exact = Export::new(&motion, frames).file(Format::Csv)?;
//! assert_eq!(exact.keys, 3);
//! assert!(exact.miss.height < 1e-12);
//!
//! let snapped = motion.snapped(Snap::Gravity, frames)?;
//! assert_eq!(snapped.off_frame(frames), 0.0);
//! assert!((snapped.tracks[0].at(0.0)[2] - 9.81 * 11.0_f64.powi(2) / (2.0 * 24.0_f64.powi(2))).abs() < 1e-12);
//!
//! // Two frames on the floor, 30 % shorter there, and 10 % longer in flight, of one volume always.
//! let held = snapped.held(2.0 / 24.0)?;
//! let shape = Shape { squash: 0.3, stretch: 0.1, hold: 2.0 / 24.0 };
//! let shown = Export { shape, ..Export::new(&held, frames) }.file(Format::Glb)?.shown.unwrap_or_default();
//! assert!((shown.least - 0.7).abs() < 1e-4 && shown.sunk < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bound;
mod curve;
mod cycle;
mod dress;
mod ease;
mod flattened;
mod format;
mod motion;
mod rate;
#[cfg(feature = "read")]
pub mod read;
mod shape;
mod shown;
mod snap;
mod space;
mod turn;

pub use bound::Miss;
pub use curve::{Between, Curve, Key};
pub use format::{Export, ExportError, File, Format};
pub use motion::{Contact, Motion, MotionError, Piece, Point, Stretch, Track};
pub use rate::{Frames, Rate, RateError};
pub use shape::{Form, Pose, Shape};
pub use shown::Shown;
pub use snap::Snap;
pub use space::{Space, Unit, Up};
pub use turn::Turn;
