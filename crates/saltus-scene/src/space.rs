//! How many coordinates a scene has: as many as its longest vector.

use std::ops::Range;

use nalgebra::Vector3;

use super::error::Fault;
use super::value::{At, OneOrMany, Real};

/// The number of coordinates, found while reading, and which key settled it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Space {
    dimensions: usize,
    by: Option<&'static str>,
}

impl Space {
    pub(super) fn dimensions(&self) -> usize {
        self.dimensions.max(1)
    }

    /// A key that has this many components.
    fn settle(&mut self, dimensions: usize, key: &'static str, span: Range<usize>) -> Result<(), Fault> {
        match self.by {
            Some(other) if dimensions != self.dimensions => Err(Fault::new(
                span,
                format!(
                    "`{key}` has {dimensions} components, `{other}` has {}: write all vectors of a scene with two, [x, up], or all with three, [x, y, up]",
                    self.dimensions
                ),
            )),
            Some(_) => Ok(()),
            None => {
                (self.dimensions, self.by) = (dimensions, Some(key));
                Ok(())
            }
        }
    }

    /// A vector, if it is one.
    pub(super) fn vector<T>(&mut self, key: &'static str, at: Option<&At<OneOrMany<T>>>) -> Result<(), Fault> {
        match at.map(|at| (at, at.get())) {
            Some((at, OneOrMany::Many(list))) if (2..=3).contains(&list.len()) => {
                self.settle(list.len(), key, at.span())
            }
            Some((at, OneOrMany::Many(list))) => {
                Err(at
                    .fault(format!("`{key}` has {} components: write two, [x, up], or three, [x, y, up]", list.len())))
            }
            Some((_, OneOrMany::One(_))) | None => Ok(()),
        }
    }

    /// Something that has no place on a vertical line.
    pub(super) const fn sideways(&mut self) {
        if self.dimensions < 2 {
            self.dimensions = 2;
        }
    }

    /// The components as (x, y, up); one number is upwards.
    pub(super) fn read<T: Real>(&self, at: &At<OneOrMany<T>>) -> Vector3<f64> {
        match at.get().as_slice() {
            [x, up] => Vector3::new(x.real(), 0.0, up.real()),
            [x, y, up] => Vector3::new(x.real(), y.real(), up.real()),
            [up] => Vector3::new(0.0, 0.0, up.real()),
            _ => Vector3::zeros(),
        }
    }
}
