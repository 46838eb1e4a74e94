//! Linear systems whose matrix is sparse and no narrow band.

use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::Lu;
use faer::{Conj, MatMut};

use crate::sparsity::Sparsity;

/// A band of so many diagonals beside the main one takes as long as its entries by themselves: with
/// entries 32 places from the diagonal, few or many, a step took the same by both; with 64 the band
/// took 1.5 times as long. A choice of cost alone: no result but its rounding changes with it.
const WIDE: usize = 64;

/// A sparse matrix, factored with its columns in an order that fills in little.
pub(super) struct Scattered<'a> {
    pub(super) sparsity: &'a Sparsity,
    /// Of its entries, column by column.
    pub(super) values: Vec<f64>,
    /// None of a matrix that is singular.
    factors: Option<Lu<usize, f64>>,
}

impl<'a> Scattered<'a> {
    /// Whether it takes less time than a band does.
    pub(super) fn is_cheaper(sparsity: &Sparsity) -> bool {
        let (below, above) = sparsity.band();
        below + above >= WIDE
    }

    /// Of zeros.
    pub(super) fn new(sparsity: &'a Sparsity) -> Self {
        Self { sparsity, values: vec![0.0; sparsity.entries()], factors: None }
    }

    pub(super) fn factor(&mut self) {
        let order = self.sparsity.order().filter(|_| self.values.iter().all(|value| value.is_finite()));
        self.factors =
            order.and_then(|order| Lu::try_new_with_symbolic(order.clone(), self.sparsity.with(&self.values)).ok());
    }

    /// The solution for one right-hand side, in its place.
    pub(super) fn solve(&self, mut work: Vec<f64>) -> Vec<f64> {
        match &self.factors {
            Some(factors) => {
                let n = work.len();
                factors.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(&mut work, n, 1));
            }
            None => work.fill(f64::NAN),
        }
        work
    }
}
