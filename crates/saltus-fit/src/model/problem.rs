//! A least-squares problem in blocks, one for each trial.

use nalgebra::DMatrix;

/// The range an unknown may take. Both ends are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

/// A model of whitened residuals in blocks.
pub(crate) trait Model {
    /// Whether its readings were altered, or are a part of those of a table, to be compared.
    fn supposed(&self) -> bool {
        false
    }
    /// For each shared unknown its range, and how far one step may move it.
    fn ranges(&self) -> Vec<(Bounds, f64)>;
    /// The numbers of rows and of own unknowns of a block.
    fn size(&self, block: usize) -> (usize, usize);
    /// Fills (∂/∂own | ∂/∂shared | observed − predicted), each row divided by its standard error;
    /// `rows` comes zeroed.
    fn fill(&self, block: usize, shared: &[f64], own: &[f64], rows: &mut DMatrix<f64>);
}
