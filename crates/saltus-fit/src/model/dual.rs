//! Values with their derivatives by all unknowns of a fit, carried forward through closed forms.

use smallvec::SmallVec;

use super::drag::Sloped;

/// Derivatives by all unknowns, of which few fits have more than eight.
pub(crate) type Slopes = SmallVec<[f64; 8]>;

/// A value and its derivatives by all unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Dual {
    pub(crate) value: f64,
    pub(crate) by: Slopes,
}

impl Dual {
    pub(crate) fn constant(value: f64, unknowns: usize) -> Self {
        Self { value, by: SmallVec::from_elem(0.0, unknowns) }
    }

    /// Unknown number `j`.
    pub(crate) fn unknown(value: f64, unknowns: usize, j: usize) -> Self {
        let mut dual = Self::constant(value, unknowns);
        dual.by[j] = 1.0;
        dual
    }

    /// A function of this and another value, with its derivatives by both.
    fn and(&self, other: &Self, value: f64, [by_self, by_other]: [f64; 2]) -> Self {
        let mut by = Slopes::from_slice(&self.by);
        by.iter_mut().zip(&other.by).for_each(|(a, b)| *a = by_self * *a + by_other * b);
        Self { value, by }
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        self.and(other, self.value + other.value, [1.0, 1.0])
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        self.and(other, self.value - other.value, [1.0, -1.0])
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        self.and(other, self.value * other.value, [other.value, self.value])
    }

    /// A function of this value, with its derivative.
    pub(crate) fn mapped(&self, value: f64, slope: f64) -> Self {
        let mut by = Slopes::from_slice(&self.by);
        by.iter_mut().for_each(|by| *by *= slope);
        Self { value, by }
    }

    /// `outer`, a function of this value, G and k, where G and k are the unknowns named (if they
    /// are unknown).
    pub(crate) fn through(&self, outer: &Sloped, gravity: Option<usize>, drag: Option<usize>) -> Self {
        let mut dual = self.mapped(outer.value, outer.by[0]);
        for (place, slope) in [(gravity, outer.by[1]), (drag, outer.by[2])] {
            if let Some(j) = place {
                dual.by[j] += slope;
            }
        }
        dual
    }
}
