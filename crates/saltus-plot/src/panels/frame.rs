//! What the panels of a page and the lane of modes share.

use crate::axis::Axis;
use crate::theme::Type;

/// The layout that all panels share. Lengths are in px.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) ty: Type,
    pub(super) time: Axis,
    /// The size of the unit of time.
    pub(super) second: f64,
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) foot: f64,
}
