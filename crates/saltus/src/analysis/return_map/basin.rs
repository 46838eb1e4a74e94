//! Basins of attraction, by sampling.

use super::{FixedPoint, MapError, ReturnMap, Section};
use crate::analysis::linearize::Linearize;
use crate::step::Stepper;

/// What becomes of a start on the section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fate {
    /// It came within reach of this attractor, by its place in the list, after so many returns.
    Attracted {
        /// Which.
        to: usize,
        /// After how many returns.
        returns: usize,
    },
    /// It did not return to the section: the walker fell, the ball came to rest.
    Lost {
        /// After how many returns.
        returns: usize,
    },
    /// It was still on its way when the returns allowed were over.
    Undecided,
}

impl<A: Linearize, X: Section<A, K>, const K: usize, M: Stepper> ReturnMap<'_, A, X, K, M> {
    /// What becomes of `q` within `most` returns: it is attracted once every coordinate is within
    /// `reach` of that of an attractor.
    ///
    /// `reach` is absolute, one for each coordinate, in its unit; it is the caller's to choose it
    /// inside the neighbourhood that the attractor surely attracts.
    ///
    /// # Errors
    /// Failures of runs, [`MapError::Run`]; a run that does not return is no failure.
    pub fn fate(
        &self,
        q: [f64; K],
        attractors: &[FixedPoint<K>],
        reach: [f64; K],
        most: usize,
    ) -> Result<Fate, MapError> {
        let mut q = q;
        for returns in 0..=most {
            let near = |attractor: &FixedPoint<K>| (0..K).all(|i| (q[i] - attractor.q[i]).abs() <= reach[i]);
            if let Some(to) = attractors.iter().position(near) {
                return Ok(Fate::Attracted { to, returns });
            }
            if returns < most {
                match self.apply(q) {
                    Ok(back) => q = back.q,
                    Err(MapError::NoReturn { .. }) => return Ok(Fate::Lost { returns }),
                    Err(error) => return Err(error),
                }
            }
        }
        Ok(Fate::Undecided)
    }

    /// The [`fate`](Self::fate) of each of `starts`, in their order. With the cargo feature `rayon`
    /// on all cores; the result is the same to the bit.
    ///
    /// # Errors
    /// None for the whole: each start has its own.
    pub fn fates(
        &self,
        starts: &[[f64; K]],
        attractors: &[FixedPoint<K>],
        reach: [f64; K],
        most: usize,
    ) -> Vec<Result<Fate, MapError>>
    where
        A: Sync,
        X: Sync,
        M: Sync,
    {
        let fate = |&q: &[f64; K]| self.fate(q, attractors, reach, most);
        #[cfg(feature = "rayon")]
        return {
            use rayon::prelude::*;
            starts.par_iter().map(fate).collect()
        };
        #[cfg(not(feature = "rayon"))]
        starts.iter().map(fate).collect()
    }
}
