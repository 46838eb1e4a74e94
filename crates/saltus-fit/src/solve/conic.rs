//! Linear and quadratic programs by the conic solver, each answer certified before it is believed.
//!
//! min ½ xᵀ diag(p) x + qᵀ x subject to A x ≤ b, where the first rows may be equalities. The
//! certificate is computed here from the problem itself, not taken from the solver: feasibility,
//! stationarity p∘x + q + Aᵀz = 0, signs and complementary slackness; or, for an infeasible
//! program, Farkas' z ≥ 0 with Aᵀz = 0 and bᵀz < 0. Callers hand over numbers of the order of one.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT};

use super::least_squares::Failure;

/// How far the conditions of a minimum may be missed, relative to the largest number involved.
const CERTAIN: f64 = 1e-5;

/// A program in inequality form.
#[derive(Clone, Debug, Default)]
pub(crate) struct Program {
    /// The diagonal of the quadratic term.
    pub(crate) squares: Vec<f64>,
    pub(crate) cost: Vec<f64>,
    /// Rows a·x ≤ b, as the entries of a, and b.
    pub(crate) rows: Vec<(Vec<(usize, f64)>, f64)>,
    /// So many of the rows, the first, are equalities a·x = b.
    pub(crate) equal: usize,
}

/// What a program comes to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Outcome {
    Minimum {
        x: Vec<f64>,
        /// The multiplier of each row.
        z: Vec<f64>,
    },
    /// No x satisfies the rows.
    Infeasible,
}

impl Program {
    /// Solves and certifies.
    pub(crate) fn minimise(&self) -> Result<Outcome, Failure> {
        let (n, m) = (self.cost.len(), self.rows.len());
        let entries = || self.rows.iter().flat_map(|(row, _)| row.iter().map(|e| e.1));
        let numbers = entries().chain(self.rows.iter().map(|r| r.1)).chain(self.cost.iter().copied());
        if n == 0
            || self.squares.len() != n
            || self.equal > m
            || numbers.chain(self.squares.iter().copied()).any(|v| !v.is_finite())
        {
            return Err(Failure::Malformed);
        }
        let (mut at, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for (i, (row, _)) in self.rows.iter().enumerate() {
            for &(j, value) in row {
                at.push(i);
                columns.push(j);
                values.push(value);
            }
        }
        let a = CscMatrix::new_from_triplets(m, n, at, columns, values);
        let diagonal: Vec<usize> = (0..n).filter(|&j| self.squares[j] != 0.0).collect();
        let squares = diagonal.iter().map(|&j| self.squares[j]).collect();
        let p = CscMatrix::new_from_triplets(n, n, diagonal.clone(), diagonal, squares);
        let b: Vec<f64> = self.rows.iter().map(|r| r.1).collect();
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .build()
            .map_err(|error| Failure::Solver(error.to_string()))?;
        let cones = [ZeroConeT(self.equal), NonnegativeConeT(m - self.equal)];
        let mut solver = DefaultSolver::new(&p, &self.cost, &a, &b, &cones, settings)
            .map_err(|error| Failure::Solver(error.to_string()))?;
        solver.solve();
        let solution = &solver.solution;
        if solution.z.iter().any(|v| !v.is_finite()) {
            return Err(Failure::Solver(format!("{:?}, with numbers that are not finite", solution.status)));
        }
        match solution.status {
            SolverStatus::PrimalInfeasible if self.refuted(&solution.z) => Ok(Outcome::Infeasible),
            SolverStatus::DualInfeasible => Err(Failure::NotIdentified),
            _ if self.optimal(&solution.x, &solution.z) => {
                Ok(Outcome::Minimum { x: solution.x.clone(), z: solution.z.clone() })
            }
            status => Err(Failure::Solver(format!("{status:?}, and the conditions of a minimum do not hold"))),
        }
    }

    /// Aᵀz.
    fn pull(&self, z: &[f64]) -> Vec<f64> {
        let mut pull = vec![0.0; self.cost.len()];
        for ((row, _), z) in self.rows.iter().zip(z) {
            row.iter().for_each(|&(j, a)| pull[j] += a * z);
        }
        pull
    }

    fn optimal(&self, x: &[f64], z: &[f64]) -> bool {
        if x.iter().any(|v| !v.is_finite()) {
            return false;
        }
        let largest = |v: &mut dyn Iterator<Item = f64>| v.fold(1.0, |a: f64, b| a.max(b.abs()));
        let (size, price) = (largest(&mut x.iter().copied()), largest(&mut z.iter().chain(&self.cost).copied()));
        let feasible = self.rows.iter().zip(z).enumerate().all(|(i, ((row, b), &z))| {
            let slack = b - row.iter().map(|&(j, a)| a * x[j]).sum::<f64>();
            let scale = size.max(b.abs());
            if i < self.equal {
                return slack.abs() <= CERTAIN * scale;
            }
            slack >= -CERTAIN * scale && z >= -CERTAIN * price && (slack * z).abs() <= CERTAIN * scale * price
        });
        let pull = self.pull(z);
        feasible
            && (0..x.len()).all(|j| (self.squares[j] * x[j] + self.cost[j] + pull[j]).abs() <= CERTAIN * price * size)
    }

    fn refuted(&self, z: &[f64]) -> bool {
        let size = z.iter().fold(0.0f64, |a, b| a.max(b.abs()));
        let gain: f64 = self.rows.iter().zip(z).map(|((_, b), z)| b * z).sum();
        size > 0.0
            && z[self.equal..].iter().all(|&z| z >= -CERTAIN * size)
            && gain < 0.0
            && self.pull(z).iter().all(|p| p.abs() <= CERTAIN * size.max(gain.abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_programs_come_out() {
        // min x + y, x ≥ 1, y ≥ 2.
        let rows = vec![(vec![(0, -1.0)], -1.0), (vec![(1, -1.0)], -2.0)];
        let program = Program { squares: vec![0.0; 2], cost: vec![1.0; 2], rows, equal: 0 };
        let Ok(Outcome::Minimum { x, .. }) = program.minimise() else { panic!() };
        assert!((x[0] - 1.0).abs() < 1e-7 && (x[1] - 2.0).abs() < 1e-7);
        // min ½ x² − 3 x, x ≤ 2.
        let program = Program { squares: vec![1.0], cost: vec![-3.0], rows: vec![(vec![(0, 1.0)], 2.0)], equal: 0 };
        let Ok(Outcome::Minimum { x, .. }) = program.minimise() else { panic!() };
        assert!((x[0] - 2.0).abs() < 1e-6);
        // min ½ (x² + y²), x + y = 2, whose multiplier is −1.
        let rows = vec![(vec![(0, 1.0), (1, 1.0)], 2.0)];
        let program = Program { squares: vec![1.0; 2], cost: vec![0.0; 2], rows, equal: 1 };
        let Ok(Outcome::Minimum { x, z }) = program.minimise() else { panic!() };
        assert!((x[0] - 1.0).abs() < 1e-7 && (x[1] - 1.0).abs() < 1e-7 && (z[0] + 1.0).abs() < 1e-7);
    }

    #[test]
    fn what_has_no_answer_says_so() {
        let crossed = vec![(vec![(0, 1.0)], 0.0), (vec![(0, -1.0)], -1.0)];
        let program = Program { squares: vec![0.0], cost: vec![1.0], rows: crossed, equal: 0 };
        assert_eq!(program.minimise(), Ok(Outcome::Infeasible));
        let program = Program { squares: vec![0.0], cost: vec![1.0], rows: vec![(vec![(0, 1.0)], 0.0)], equal: 0 };
        assert_eq!(program.minimise(), Err(Failure::NotIdentified));
        let program = Program { squares: vec![0.0], cost: vec![f64::NAN], rows: vec![(vec![(0, 1.0)], 0.0)], equal: 0 };
        assert_eq!(program.minimise(), Err(Failure::Malformed));
    }
}
