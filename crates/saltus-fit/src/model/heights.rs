//! Rebound heights: ln h = a + 2 n L, with an intercept per trial; then h = exp(a + 2 n L) itself,
//! where errors are additive.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::problem::{Bounds, Model};
use crate::elementary::{exp, ln};
use crate::evidence::Height;

/// Heights against the number of contacts. Shared: L = ln e, and on request a trend. Own: a = ln
/// h₀.
///
/// In logarithms, weighted by h/σ, the problem is linear. It is biased by about (σ/h)², since a
/// reading that came out high gets more weight; the heights themselves, with errors that are
/// additive, are fitted from there.
#[derive(Clone, Debug)]
pub(crate) struct Heights {
    /// Fits of many drops share them.
    pub(crate) trials: Arc<Vec<Vec<Height>>>,
    /// The upper bound of L: 0 for a ball that gains no energy.
    pub(crate) high: f64,
    /// Adds an unknown times n²: a COR that changes from bounce to bounce.
    pub(crate) trend: bool,
    /// Fits the logarithms instead of the heights.
    pub(crate) logarithms: bool,
    pub(crate) supposed: bool,
}

impl Model for Heights {
    fn supposed(&self) -> bool {
        self.supposed || self.logarithms
    }

    fn ranges(&self) -> Vec<(Bounds, f64)> {
        let mut ranges = vec![(Bounds { low: -20.0, high: self.high }, 1e3)];
        if self.trend {
            ranges.push((Bounds { low: -1e3, high: 1e3 }, 1e3));
        }
        ranges
    }

    fn size(&self, block: usize) -> (usize, usize) {
        (self.trials[block].len(), 1)
    }

    #[allow(clippy::cast_precision_loss)]
    fn fill(&self, block: usize, shared: &[f64], own: &[f64], rows: &mut DMatrix<f64>) {
        for (i, &(n, height, sigma)) in self.trials[block].iter().enumerate() {
            let n = n as f64;
            let mut predicted = own[0] + 2.0 * n * shared[0];
            if self.trend {
                predicted += n * n * shared[1];
            }
            // Of the logarithm or of the height, the derivative with respect to `predicted` and the
            // residual.
            let (weight, residual) = if self.logarithms {
                (height / sigma, height / sigma * (ln(height) - predicted))
            } else {
                let expected = exp(predicted);
                (expected / sigma, (height - expected) / sigma)
            };
            rows[(i, 0)] = weight;
            rows[(i, 1)] = weight * 2.0 * n;
            if self.trend {
                rows[(i, 2)] = weight * n * n;
            }
            rows[(i, 1 + shared.len())] = residual;
        }
    }
}
