//! Linear least squares with bounds: the one place that speaks to the conic solver, and that trusts
//! it only after checking.
//!
//! The problem is ½ ‖X x − y‖² → min, low ≤ x ≤ high, with whitened rows (each divided by its
//! standard error). A direct factorisation solves it, and finds bound by bound which hold. What is
//! reported is handed to Clarabel too, in residual form: unknowns (x, r), P = diag(0, I), X x + r =
//! y as equalities, the bounds as inequalities.
//!
//! What the solver does not say by itself is settled here: numbers are checked to be finite before
//! and after; columns and right-hand side are scaled to norm one, since the solver's absolute gap
//! accepts wrong answers to small problems; the rank is tested by the condition, since a
//! rank-deficient problem is called solved too; only an accepted status, or optimality conditions
//! that hold, complementarity included, count as solved; and the answer is compared with, and
//! replaced by, that of a direct factorisation on the unknowns that are not at a bound, so its
//! accuracy is that of the factorisation.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, SupportedConeT, ZeroConeT,
};
use nalgebra::{DMatrix, DVector};

use crate::model::Bounds;

/// A whitened problem whose columns are worse conditioned than this determines nothing.
const CONDITION: f64 = 1e8;
/// How far the sums of squares of solver and factorisation may differ, that of the right-hand side
/// being one, before neither is believed.
const AGREE: f64 = 1e-7;
/// A bound this many times further than the free minimum, in scaled units, is left out at first: it
/// would only spoil the scale.
const FAR: f64 = 10.0;

/// The minimum and what it is worth.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    pub(crate) x: DVector<f64>,
    /// (XᵀX)⁻¹ on the unknowns that are not at a bound; zero in the rows and columns of the others.
    pub(crate) covariance: DMatrix<f64>,
    /// Which unknowns are at a bound, as the multipliers tell.
    pub(crate) active: Vec<bool>,
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Failure {
    /// A number of the problem is not finite, or a bound is crossed.
    Malformed,
    /// The rows do not determine the unknowns.
    NotIdentified,
    /// The solver gave no answer that passes the checks.
    Solver(String),
}

/// Minimises ½ ‖X x − y‖² within the bounds, by solver and factorisation.
pub(crate) fn solve(x: &DMatrix<f64>, y: &DVector<f64>, bounds: &[Bounds]) -> Result<Solution, Failure> {
    minimum(x, y, bounds, Scaled::bounded)
}

/// The same for a step on the way to a minimum, and for what is compared and not reported: the
/// solver is asked only where the factorisation alone does not find which bounds hold.
pub(crate) fn settle(x: &DMatrix<f64>, y: &DVector<f64>, bounds: &[Bounds]) -> Result<Solution, Failure> {
    minimum(x, y, bounds, |scaled, free| {
        let none = vec![None; free.0.len()];
        match scaled.violation(&free.0, &none) {
            None => Ok((free, none)),
            Some(_) => scaled.mended(none).or_else(|_| scaled.bounded(free)),
        }
    })
}

/// What finds the minimum within the bounds, given the free one.
type Way = fn(&Scaled, Direct) -> Result<(Direct, Vec<Option<Side>>), Failure>;

fn minimum(x: &DMatrix<f64>, y: &DVector<f64>, bounds: &[Bounds], way: Way) -> Result<Solution, Failure> {
    let (rows, n) = x.shape();
    if y.len() != rows || bounds.len() != n {
        return Err(Failure::Malformed);
    }
    let finite = x.iter().chain(y.iter()).all(|v| v.is_finite());
    if !finite || bounds.iter().any(|b| !b.low.is_finite() || !b.high.is_finite() || b.low > b.high) {
        return Err(Failure::Malformed);
    }
    if n == 0 {
        return Ok(Solution { x: DVector::zeros(0), covariance: DMatrix::zeros(0, 0), active: Vec::new() });
    }
    let column: Vec<f64> = x.column_iter().map(|c| c.norm()).collect();
    if rows < n || column.iter().any(|&c| c <= 0.0 || !c.is_finite()) {
        return Err(Failure::NotIdentified);
    }
    let length = y.norm();
    let length = if length > 0.0 && length.is_finite() { length } else { 1.0 };
    let scaled = Scaled {
        x: DMatrix::from_fn(rows, n, |i, j| x[(i, j)] / column[j]),
        y: y / length,
        low: (0..n).map(|j| bounds[j].low * (column[j] / length)).collect(),
        high: (0..n).map(|j| bounds[j].high * (column[j] / length)).collect(),
    };
    let free = scaled.direct(&vec![None; n]).ok_or(Failure::NotIdentified)?;
    let ((z, inverse), active) = way(&scaled, free)?;
    let mut answer = DVector::from_fn(n, |j, _| z[j] * length / column[j]);
    for j in 0..n {
        // Snap: an unknown at a bound is on it, not 1e-10 beside it.
        answer[j] = match active[j] {
            Some(Side::Low) => bounds[j].low,
            Some(Side::High) => bounds[j].high,
            None => answer[j].clamp(bounds[j].low, bounds[j].high),
        };
    }
    let covariance = DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] / column[i] / column[j]);
    if answer.iter().chain(covariance.iter()).any(|v| !v.is_finite()) {
        return Err(Failure::NotIdentified);
    }
    Ok(Solution { x: answer, covariance, active: active.iter().map(Option::is_some).collect() })
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    Low,
    High,
}

/// A minimum, and (XᵀX)⁻¹ there.
type Direct = (DVector<f64>, DMatrix<f64>);

/// The problem with columns and right-hand side of norm one.
struct Scaled {
    x: DMatrix<f64>,
    y: DVector<f64>,
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Scaled {
    /// The minimum with some unknowns held at a bound, and (XᵀX)⁻¹ on the others, by X = Q R;
    /// `None` where they are not determined.
    ///
    /// R takes sums, products and roots only, and so its bits are the same on every machine. Its
    /// condition ‖R‖ ‖R⁻¹‖ in Frobenius' norm is that of singular values to a factor of n.
    fn direct(&self, held: &[Option<Side>]) -> Option<Direct> {
        let n = self.x.ncols();
        let mut z = DVector::from_fn(n, |j, _| match held[j] {
            Some(Side::Low) => self.low[j],
            Some(Side::High) => self.high[j],
            None => 0.0,
        });
        let mut inverse = DMatrix::zeros(n, n);
        let free: Vec<usize> = (0..n).filter(|&j| held[j].is_none()).collect();
        if free.is_empty() {
            return Some((z, inverse));
        }
        let mut rest = &self.y - &self.x * &z;
        let qr = self.x.select_columns(&free).qr();
        qr.q_tr_mul(&mut rest);
        let r = qr.unpack_r();
        let found = r.solve_upper_triangular(&rest.rows(0, free.len()))?;
        let back = r.solve_upper_triangular(&DMatrix::identity(free.len(), free.len()))?;
        let condition = r.norm() * back.norm();
        if condition.is_nan() || condition >= CONDITION {
            return None;
        }
        for (a, &i) in free.iter().enumerate() {
            z[i] = found[a];
            for (b, &j) in free.iter().enumerate() {
                inverse[(i, j)] = back.row(a).dot(&back.row(b));
            }
        }
        Some((z, inverse))
    }

    fn inside(&self, z: &DVector<f64>, slack: f64) -> bool {
        (0..z.len()).all(|j| z[j] >= self.low[j] - slack && z[j] <= self.high[j] + slack)
    }

    /// The minimum within the bounds: the solver tells which bounds hold, the factorisation gives
    /// the number.
    ///
    /// Where unknowns are nearly dependent the solver's own accuracy leaves the choice of bounds
    /// open; it is then mended bound by bound until the conditions of a minimum hold, which for a
    /// convex problem make it the only one. The two are compared by what they minimise, which is
    /// sharp where the unknowns are not.
    fn bounded(&self, (free, _): Direct) -> Result<(Direct, Vec<Option<Side>>), Failure> {
        let reach = FAR * (1.0 + free.amax());
        // Should the solver give up, the conditions of a minimum still decide alone.
        let (solver, active) = match self.conic(reach).or_else(|_| self.conic(f64::INFINITY)) {
            Ok((z, active)) => (Some(z), active),
            Err(_) => (None, vec![None; free.len()]),
        };
        let (found, active) = self.mended(active)?;
        let ours = self.squares(&found.0);
        let theirs = solver.as_ref().map_or(ours, |solver| self.squares(solver));
        if (ours - theirs).abs() <= AGREE {
            return Ok((found, active));
        }
        Err(Failure::Solver(format!("solver and factorisation leave {theirs:.3e} and {ours:.3e} of 1")))
    }

    /// The minimum with the bounds that hold there, found bound by bound from those of a guess.
    fn mended(&self, mut active: Vec<Option<Side>>) -> Result<(Direct, Vec<Option<Side>>), Failure> {
        for _ in 0..10 + 4 * active.len() {
            let found = self.direct(&active).ok_or(Failure::NotIdentified)?;
            let Some((j, side)) = self.violation(&found.0, &active) else { return Ok((found, active)) };
            active[j] = side;
        }
        Err(Failure::Solver("no choice of bounds satisfies the conditions of a minimum".to_owned()))
    }

    /// The sum of squared residuals; that of the right-hand side is one.
    fn squares(&self, z: &DVector<f64>) -> f64 {
        (&self.x * z - &self.y).norm_squared()
    }

    /// The worst breach of the conditions of a minimum, as the unknown and what to do with it: hold
    /// it at a bound, or let it go.
    fn violation(&self, z: &DVector<f64>, active: &[Option<Side>]) -> Option<(usize, Option<Side>)> {
        let gradient = self.x.transpose() * (&self.x * z - &self.y);
        let outside = |j: usize| {
            let (low, high) = (self.low[j] - z[j], z[j] - self.high[j]);
            let slack = 1e-12 * (1.0 + z[j].abs());
            match active[j] {
                None if low > slack => Some((low / (1.0 + z[j].abs()), j, Some(Side::Low))),
                None if high > slack => Some((high / (1.0 + z[j].abs()), j, Some(Side::High))),
                _ => None,
            }
        };
        let pulling = |j: usize| {
            let pull = match active[j] {
                Some(Side::Low) => -gradient[j],
                Some(Side::High) => gradient[j],
                None => 0.0,
            };
            (pull > 1e-10).then_some((pull, j, None))
        };
        let worst = |a: &(f64, usize, Option<Side>), b: &(f64, usize, Option<Side>)| a.0.total_cmp(&b.0);
        let n = z.len();
        let found = (0..n).filter_map(outside).max_by(worst).or_else(|| (0..n).filter_map(pulling).max_by(worst));
        found.map(|(_, j, side)| (j, side))
    }

    /// The largest part of the gradient, which must vanish up to the multipliers of the bounds, and
    /// these where there is slack.
    fn steepest(&self, z: &DVector<f64>, limits: &[(usize, Side)], multipliers: &[f64]) -> f64 {
        let mut gradient = self.x.transpose() * (&self.x * z - &self.y);
        for (&(j, side), multiplier) in limits.iter().zip(multipliers) {
            gradient[j] += if side == Side::High { *multiplier } else { -multiplier };
        }
        gradient.amax()
    }

    /// Solves by Clarabel with the bounds nearer than `reach`; gives the scaled unknowns and the
    /// bounds that hold.
    fn conic(&self, reach: f64) -> Result<(DVector<f64>, Vec<Option<Side>>), Failure> {
        let (m, n) = self.x.shape();
        let mut entries = Triplets::default();
        for i in 0..m {
            for j in 0..n {
                entries.push(i, j, self.x[(i, j)]);
            }
            entries.push(i, n + i, 1.0);
        }
        let mut right: Vec<f64> = self.y.iter().copied().collect();
        let mut limits = Vec::new();
        for j in 0..n {
            for (side, sign, limit) in [(Side::High, 1.0, self.high[j]), (Side::Low, -1.0, self.low[j])] {
                if limit.abs() <= reach.min(1e12) {
                    entries.push(right.len(), j, sign);
                    right.push(sign * limit);
                    limits.push((j, side));
                }
            }
        }
        let a = entries.matrix(right.len(), n + m);
        let mut squares = Triplets::default();
        (n..n + m).for_each(|i| squares.push(i, i, 1.0));
        let p = squares.matrix(n + m, n + m);
        let mut cones: Vec<SupportedConeT<f64>> = vec![ZeroConeT(m)];
        if !limits.is_empty() {
            cones.push(NonnegativeConeT(limits.len()));
        }
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .tol_gap_abs(1e-11)
            .tol_gap_rel(1e-11)
            .tol_feas(1e-11)
            .build()
            .map_err(|error| Failure::Solver(error.to_string()))?;
        let mut solver = DefaultSolver::new(&p, &vec![0.0; n + m], &a, &right, &cones, settings)
            .map_err(|error| Failure::Solver(error.to_string()))?;
        solver.solve();
        let solution = &solver.solution;
        if solution.x.iter().chain(&solution.z).any(|v| !v.is_finite()) {
            return Err(Failure::Solver(format!("{:?}, with numbers that are not finite", solution.status)));
        }
        let z = DVector::from_fn(n, |j, _| solution.x[j]);
        if !self.inside(&z, 1e-6 * (1.0 + z.amax())) {
            return Err(Failure::Solver("a bound is broken".to_owned()));
        }
        let multipliers = &solution.z[m..];
        match solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => {}
            SolverStatus::InsufficientProgress | SolverStatus::MaxIterations | SolverStatus::NumericalError => {
                let slack = multipliers.iter().zip(&solution.s[m..]).map(|(z, s)| (z * s).abs()).fold(0.0, f64::max);
                if self.steepest(&z, &limits, multipliers) > 1e-6 || slack > 1e-6 {
                    return Err(Failure::Solver(format!("{:?}", solution.status)));
                }
            }
            status => return Err(Failure::Solver(format!("{status:?}"))),
        }
        let mut active = vec![None; n];
        for (k, &(j, side)) in limits.iter().enumerate() {
            let slack = solution.s[m + k];
            if multipliers[k] > slack.max(1e-9) {
                active[j] = Some(side);
            }
        }
        Ok((z, active))
    }
}

/// Entries of a sparse matrix, in any order.
#[derive(Default)]
struct Triplets {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Triplets {
    fn push(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }

    fn matrix(self, rows: usize, columns: usize) -> CscMatrix<f64> {
        CscMatrix::new_from_triplets(rows, columns, self.rows, self.columns, self.values)
    }
}

#[cfg(test)]
mod tests;
