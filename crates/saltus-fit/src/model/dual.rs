//! Values with their derivatives by all unknowns of a fit, carried forward through closed forms.

use nalgebra::DVector;

use super::drag::Sloped;

/// A value and its derivatives by all unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Dual {
    pub(crate) value: f64,
    pub(crate) by: DVector<f64>,
}

impl Dual {
    pub(crate) fn constant(value: f64, unknowns: usize) -> Self {
        Self { value, by: DVector::zeros(unknowns) }
    }

    /// Unknown number `j`.
    pub(crate) fn unknown(value: f64, unknowns: usize, j: usize) -> Self {
        let mut dual = Self::constant(value, unknowns);
        dual.by[j] = 1.0;
        dual
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self { value: self.value + other.value, by: &self.by + &other.by }
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        Self { value: self.value - other.value, by: &self.by - &other.by }
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        Self { value: self.value * other.value, by: &self.by * other.value + &other.by * self.value }
    }

    /// `outer`, a function of this value, G and k, where G and k are the unknowns named (if they are unknown).
    pub(crate) fn through(&self, outer: &Sloped, gravity: Option<usize>, drag: Option<usize>) -> Self {
        let mut by = &self.by * outer.by[0];
        for (place, slope) in [(gravity, outer.by[1]), (drag, outer.by[2])] {
            if let Some(j) = place {
                by[j] += slope;
            }
        }
        Self { value: outer.value, by }
    }
}
