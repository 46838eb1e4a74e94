//! The unit of length of plotters, which takes whole numbers alone.

/// Grains per px.
pub(crate) const GRAIN: f64 = 100.0;

/// px to grains.
pub(crate) fn grains(px: f64) -> i32 {
    (px * GRAIN).round() as i32
}
