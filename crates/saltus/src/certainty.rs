//! One scale of certainty, in multiples of a value's noise.
//!
//! The noise of a value is what one rounding of each number that it is made from changes it by, or
//! what its samples scatter by. A value of a few times that may be nothing else, one of many more
//! is something. Between them lies what is looked at more closely, stepped again, or doubted.

/// A value made by an operation or two may be off by so many times its noise: each rounds as well.
pub(crate) const FEW: f64 = 4.0;

/// A guard or a flow may be off by so many times its noise: its own arithmetic rounds a dozen times
/// or so, and so did that of the jumps before at the same time.
pub(crate) const ROUNDINGS: f64 = FEW * FEW;

/// A value so many times its noise is beyond it for sure, though a few samples may have shown the
/// noise a few times too small.
pub(crate) const SURELY: f64 = ROUNDINGS * FEW;

/// Over a way on which a value changes by so many times its noise, three digits of the change are
/// right.
pub(crate) const FAR: f64 = SURELY * ROUNDINGS;
