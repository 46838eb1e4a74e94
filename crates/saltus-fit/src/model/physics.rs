//! What is known of balls, rulers and places before anything is read.

/// The most drag of an ordinary ball, 1/m: k = ρ `c_d` A/2m of a basketball is 0.022, of a tennis
/// ball 0.020, a squash ball 0.016, a golf ball 0.008, one of steel 0.001.
pub(crate) const ORDINARY_DRAG: f64 = 0.022;

/// The most drag of a ball that is dropped for its bounce, 1/m: of a table-tennis ball, 40 mm and
/// 2.7 g, `c_d` = 0.5.
pub(crate) const LIGHT_DRAG: f64 = 0.14;

/// The most drag of anything that is dropped to see it bounce, 1/m: of a beach ball, 40 cm across
/// and 60 g.
pub(crate) const PHYSICAL_DRAG: f64 = 0.5;

/// No ball is known to keep more of its speed.
pub(crate) const LOSSLESS: f64 = 0.995;
/// Only glass and steel keep more of their speed: readings that agree on more have to show a loss.
pub(crate) const HARDEST: f64 = 0.975;

/// A 95 % interval wider than this says hardly anything: balls of sports keep between half and nine
/// tenths of their speed, and it leaves out less than half of these.
pub(crate) const VAGUE: f64 = 0.25;

/// A lens moves the ends of the path by this part of half the path, as a standard deviation: phones
/// by one to two hundredths of the picture's edge, wide cameras by five and more.
pub(crate) const BEND: f64 = 0.03;
