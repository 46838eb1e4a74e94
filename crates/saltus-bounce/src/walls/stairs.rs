//! Stairs: treads and risers with ends.

use nalgebra::{SVector, Vector2};

use super::{Face, Walls};
use crate::parameter::{ParameterError, finite};

/// Level treads of given heights, with risers between them, for every x: cell k is the air over
/// tread k.
///
/// A cell's faces: 0 its tread, 1 its left end, 2 its right end. An end is a riser below the
/// neighbour's tread and open above it, where a ball passes into the neighbour's cell: so an edge
/// of a tread is met by what comes within rounding of it, and nothing passes through it. A ball
/// that meets the tread and its end at once meets the tread. For points: a ball of radius R needs
/// treads that are not its own width.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::walls::{Face, Stairs, Walls};
/// // Two steps down: treads at 1.0 m, 0.5 m and 0.0 m, with edges at x = 0.3 m and 0.6 m.
/// let stairs = Stairs::new(vec![0.3, 0.6], vec![1.0, 0.5, 0.0])?;
/// let off_the_first = Face { cell: 0, index: 2 };
/// assert_eq!(stairs.leads(off_the_first, 0.0, &vector![0.3, 1.2]), Some(1));
/// let into_the_riser = Face { cell: 1, index: 1 };
/// assert_eq!(stairs.leads(into_the_riser, 0.0, &vector![0.3, 0.8]), None);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stairs {
    edges: Vec<f64>,
    treads: Vec<f64>,
}

impl Stairs {
    /// Treads at the heights `treads`, the first from -∞ to the first of `edges`, the last from the
    /// last of `edges` to ∞; all in m.
    ///
    /// # Errors
    /// [`ParameterError`] unless all is finite, the edges rise, and there is one tread more than
    /// edges.
    pub fn new(edges: Vec<f64>, treads: Vec<f64>) -> Result<Self, ParameterError> {
        for &number in edges.iter().chain(&treads) {
            finite("a place of a step in m", number)?;
        }
        if let Some(pair) = edges.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(ParameterError::new("the edge of the next step", pair[1], "edges in rising order"));
        }
        if treads.len() != edges.len() + 1 {
            let count = treads.len() as f64;
            return Err(ParameterError::new("the number of treads", count, "one tread more than there are edges"));
        }
        Ok(Self { edges, treads })
    }

    /// `count` steps down from height `top`, each `run` long and `rise` high, the first edge at x =
    /// `run`.
    ///
    /// # Errors
    /// [`ParameterError`] unless all is finite and `run` positive.
    pub fn down(count: usize, top: f64, run: f64, rise: f64) -> Result<Self, ParameterError> {
        let edges = (1..=count).map(|k| k as f64 * run).collect();
        Self::new(edges, (0..=count).map(|k| top - k as f64 * rise).collect())
    }

    /// The cell over which x lies.
    #[must_use]
    pub fn cell(&self, x: f64) -> usize {
        self.edges.partition_point(|&edge| edge <= x)
    }
}

impl Walls<2> for Stairs {
    fn cells(&self) -> usize {
        self.treads.len()
    }
    fn faces(&self, _cell: usize) -> usize {
        3
    }
    #[inline]
    fn margin(&self, Face { cell, index }: Face, _: f64, p: &Vector2<f64>) -> f64 {
        match index {
            0 => p[1] - self.treads[cell],
            1 if cell > 0 => p[0] - self.edges[cell - 1],
            2 if cell < self.edges.len() => self.edges[cell] - p[0],
            _ => 1.0, // the outer treads go on for ever
        }
    }
    #[inline]
    fn gradient(&self, Face { index, .. }: Face, _: f64, _: &Vector2<f64>) -> SVector<f64, 2> {
        [Vector2::new(0.0, 1.0), Vector2::new(1.0, 0.0), Vector2::new(-1.0, 0.0)][index.min(2)]
    }
    #[inline]
    fn straight(&self, _: Face) -> bool {
        true
    }
    fn leads(&self, Face { cell, index }: Face, _: f64, p: &Vector2<f64>) -> Option<usize> {
        let next = match index {
            1 => cell.checked_sub(1)?,
            2 => cell + 1,
            _ => return None,
        };
        (p[1] >= *self.treads.get(next)?).then_some(next)
    }
}
