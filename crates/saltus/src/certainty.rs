//! Two scales: of certainty, in multiples of a value's noise, and of nearness, in parts of a whole.
//!
//! The noise of a value is what one rounding of each number that it is made from changes it by, or
//! what its samples scatter by. A value of a few times that may be nothing else, one of many more
//! is something. Between them lies what is looked at more closely, stepped again, or doubted.

/// A value made by an operation or two may be off by so many times its noise: each rounds as well.
/// Held by `plastic::no_ball_falls_through_a_floor_that_moves`.
pub(crate) const FEW: f64 = 4.0;

/// A guard or a flow may be off by so many times its noise: its own arithmetic rounds a dozen times
/// or so, and so did that of the jumps before at the same time.
/// Held by `soak::random_scenes_keep_the_laws`.
pub(crate) const ROUNDINGS: f64 = FEW * FEW;

/// A value so many times its noise is beyond it for sure, though a few samples may have shown the
/// noise a few times too small.
/// Held by `sturm::as_many_crossings_as_sturm_counts`.
pub(crate) const SURELY: f64 = ROUNDINGS * FEW;

/// Over a way on which a value changes by so many times its noise, three digits of the change are
/// right.
/// Held by `planted::the_search_finds_each_fall_once`.
pub(crate) const FAR: f64 = SURELY * ROUNDINGS;

/// Two estimates of one value agree if they differ by no more than this part of it; a part of a
/// stretch no larger is near its end.
/// Held by `cross::tests::a_floor_that_lets_go`.
pub(crate) const ROUGHLY: f64 = 0.125;

/// A part of a whole of which three digits stand beside it.
/// Held by `sliding::tangential_exits_do_not_chatter`.
pub(crate) const SMALL: f64 = 1.0 / (1_u64 << 10) as f64;

/// A part beside which six digits stand: midway between the whole and its rounding, and so the
/// length of differences, and what a smooth curve may be off a promised or an interpolated one.
/// Held by `cross::tests::a_floor_that_lets_go`.
pub(crate) const TINY: f64 = SMALL * SMALL;

/// A part beside which nine digits stand: its square is below rounding.
/// Held by `poles::roots_between_poles_are_found`.
pub(crate) const MINUTE: f64 = SMALL * TINY;

/// A part that may be what rounding has left of the whole, after jumps and cancellation.
/// Held by `grazing::what_the_error_of_a_step_decides_is_doubted`.
pub(crate) const NOTHING: f64 = TINY * TINY;
