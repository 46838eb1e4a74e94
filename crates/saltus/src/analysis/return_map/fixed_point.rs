//! Fixed points of return maps: periodic runs and their Floquet multipliers.

use nalgebra::{Complex, DMatrix, DVector, SMatrix};

use super::newton::{Equation, newton};
use super::{Linear, MapError, ReturnMap, Section};
use crate::analysis::linearize::Linearize;
use crate::step::Stepper;

/// A fixed point P(q) = q of a return map: a periodic run.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FixedPoint<const K: usize> {
    /// The coordinates on the section.
    pub q: [f64; K],
    /// How long a period is, in seconds: of as many returns as the map makes.
    pub period: f64,
    /// ∂P/∂q, K × K.
    pub jacobian: SMatrix<f64, K, K>,
    /// The Floquet multipliers, the eigenvalues of ∂P/∂q, the largest first.
    pub multipliers: Vec<Complex<f64>>,
    /// P(q) - q, what rounding leaves.
    pub residual: [f64; K],
}

impl<const K: usize> FixedPoint<K> {
    /// Whether neighbouring runs come closer: all multipliers lie inside the unit circle.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.multipliers.iter().all(|multiplier| multiplier.norm() < 1.0)
    }
}

/// The eigenvalues of a real matrix, the largest first.
pub(super) fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    let nan = || vec![Complex::new(f64::NAN, 0.0); matrix.nrows()];
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return nan();
    }
    let schur = matrix.clone().try_schur(f64::EPSILON, 10_000);
    let mut all = schur.map_or_else(nan, |schur| schur.complex_eigenvalues().as_slice().to_vec());
    all.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
    all
}

impl<A: Linearize, X: Section<A, K>, const K: usize, M: Stepper> ReturnMap<'_, A, X, K, M> {
    /// The fixed point that Newton's method, with exact derivatives, finds from `guess`.
    ///
    /// Steps that lead away, or to where no run returns, are halved. It ends when rounding stops
    /// it: P(q) - q is then within a thousand times of the tolerance of the simulation, usually a
    /// few times.
    ///
    /// An example is at [`Section`].
    ///
    /// # Errors
    /// Those of [`jacobian`](Self::jacobian) at the guess; [`MapError::Singular`] where a
    /// multiplier is one; [`MapError::NoConvergence`].
    pub fn fixed_point(&self, guess: [f64; K]) -> Result<FixedPoint<K>, MapError> {
        let root = newton(DVector::from_column_slice(&guess), |at| {
            let q = std::array::from_fn(|i| at[i]);
            let (linear, jacobian) = self.dense(&q)?;
            let residual = DVector::from_fn(K, |i, _| linear.image.q[i] - q[i]);
            let allowed = self.allowed(&q, &linear.image.q);
            Ok(Equation { residual, allowed, jacobian: jacobian - DMatrix::identity(K, K), found: linear })
        })?;
        Ok(self.orbit(std::array::from_fn(|i| root.at[i]), &root.found))
    }

    /// By how much P(q) - q may be off: what the simulation allows a step.
    pub(super) fn allowed(&self, q: &[f64; K], image: &[f64; K]) -> DVector<f64> {
        let tolerance = self.simulation.options().tolerance;
        DVector::from_fn(K, |i, _| tolerance.absolute + tolerance.relative * q[i].abs().max(image[i].abs()))
    }

    /// The periodic run through `q`.
    pub(super) fn orbit(&self, q: [f64; K], linear: &Linear<A::Edge, K, K>) -> FixedPoint<K> {
        let jacobian = SMatrix::from_fn(|i, k| linear.columns[k][i]);
        let multipliers = eigenvalues(&DMatrix::from_fn(K, K, |i, k| linear.columns[k][i]));
        let residual = std::array::from_fn(|i| linear.image.q[i] - q[i]);
        FixedPoint { q, period: linear.image.duration, jacobian, multipliers, residual }
    }
}
