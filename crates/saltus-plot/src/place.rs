//! Where data stand on the page.

use crate::curve::Affine;

/// The map of a chart's axes to the page.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) x: Affine,
    pub(crate) y: Affine,
    /// The sizes of the units across and up.
    pub(crate) sizes: [f64; 2],
    /// The axes in powers of ten, across and up.
    pub(crate) logarithmic: [bool; 2],
    /// The place across of all lesser values.
    pub(crate) least: Option<f64>,
}

impl Place {
    /// The place in px.
    pub(crate) fn at(&self, [a, b]: [f64; 2]) -> (f64, f64) {
        let a = self.least.map_or(a, |least| a.max(least));
        let scaled = |k: usize, value: f64| if self.logarithmic[k] { (value / self.sizes[k]).log10() } else { value };
        (self.x.at(scaled(0, a)), self.y.at(scaled(1, b)))
    }
}
