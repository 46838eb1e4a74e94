//! The same models under other losses: Huber's, the sum of absolute residuals, and the largest
//! residual.
//!
//! Each step linearises the whole model and solves a conic program within a trust region: for the
//! largest residual as it stands, for the other two its dual, which is smaller. A step that does
//! not lower the loss is tried shorter.

use nalgebra::{DMatrix, DVector};

use super::conic::{Outcome, Program};
use super::least_squares::Failure;
use crate::model::{Bounds, Model};
use crate::quantity::Loss;

/// 95 % efficient where errors are normal (Huber 1964).
pub(crate) const HUBER: f64 = 1.345;
/// A problem with more rows is left to least squares.
pub(crate) const ROWS: usize = 3000;
const STEPS: usize = 25;
/// A loss that differs by less, relatively, is the same.
const SAME: f64 = 1e-9;
/// A loss that comes out as near as this to what the linear model foresaw has no more to lose: what
/// is left is of higher order still.
const LINEAR: f64 = 1e-6;

/// A fit under one of the losses.
#[derive(Clone, Debug)]
pub(crate) struct Robust {
    pub(crate) shared: Vec<f64>,
    pub(crate) own: Vec<Vec<f64>>,
    /// The whitened residuals of each block.
    pub(crate) left: Vec<Vec<f64>>,
    /// The loss: for [`Loss::Largest`] the largest whitened residual.
    pub(crate) loss: f64,
}

impl Loss {
    fn cost(self, left: &DVector<f64>) -> f64 {
        match self {
            Self::Absolute => left.iter().map(|r| r.abs()).sum(),
            Self::Largest => left.amax(),
            Self::Huber => left
                .iter()
                .map(|r| if r.abs() <= HUBER { 0.5 * r * r } else { HUBER * r.abs() - 0.5 * HUBER * HUBER })
                .sum(),
        }
    }

    /// One step: the shift of all unknowns within their limits that makes the loss of the linear
    /// model least.
    fn step(self, x: &DMatrix<f64>, left: &DVector<f64>, limits: &[(f64, f64)]) -> Result<Vec<f64>, Failure> {
        let scale = left.amax().max(1e-12);
        let norms: Vec<f64> = x.column_iter().map(|c| c.amax().max(1e-300)).collect();
        let scaled = limits.iter().zip(&norms).map(|(&(low, high), norm)| (low * norm / scale, high * norm / scale));
        // What lies far beyond all readings limits nothing.
        let limits: Vec<(f64, f64)> = scaled
            .map(|(low, high)| {
                (if low > -1e4 { low } else { f64::NEG_INFINITY }, if high < 1e4 { high } else { f64::INFINITY })
            })
            .collect();
        let entry = |i: usize, j: usize| x[(i, j)] / norms[j];
        let scaled_left = left / scale;
        let program = match self {
            Self::Largest => largest(x.shape(), entry, &scaled_left, &limits),
            Self::Huber => dual(x.shape(), entry, &scaled_left, &limits, HUBER / scale),
            Self::Absolute => dual(x.shape(), entry, &scaled_left, &limits, 0.0),
        };
        let Outcome::Minimum { x, z } = program.minimise()? else { return Err(Failure::Malformed) };
        let step = if self == Self::Largest { x } else { z };
        Ok(step.iter().zip(&norms).map(|(d, norm)| d * scale / norm).collect())
    }
}

/// min ε with |r − X d| ≤ ε and d within its limits; d are its first unknowns.
fn largest(
    (m, n): (usize, usize),
    x: impl Fn(usize, usize) -> f64,
    left: &DVector<f64>,
    limits: &[(f64, f64)],
) -> Program {
    let mut cost = vec![0.0; n];
    cost.push(1.0);
    let mut rows = Vec::with_capacity(2 * (m + n));
    for i in 0..m {
        for sign in [1.0, -1.0] {
            let mut row: Vec<(usize, f64)> =
                (0..n).map(|j| (j, -sign * x(i, j))).filter(|entry| entry.1 != 0.0).collect();
            row.push((n, -1.0));
            rows.push((row, -sign * left[i]));
        }
    }
    for (j, &(low, high)) in limits.iter().enumerate() {
        let sides = [(1.0, high), (-1.0, -low)];
        rows.extend(sides.into_iter().filter(|(_, b)| b.is_finite()).map(|(sign, b)| (vec![(j, sign)], b)));
    }
    Program { squares: vec![0.0; n + 1], cost, rows, equal: 0 }
}

/// The dual of min Σ ρ(r − X d), d within its limits, where ρ has the slope λ = w/δ up to |w| = δ
/// and ±1 beyond; ρ is |w| for δ = 0. It has one unknown for each row and side of a limit, and each
/// row of X once: min ½ δ λᵀλ − rᵀλ + Σ hⱼ μⱼ − Σ lⱼ νⱼ with Xᵀλ = μ − ν, |λ| ≤ 1, μ, ν ≥ 0. Its
/// first multipliers, those of the equalities, are d.
fn dual(
    (m, n): (usize, usize),
    x: impl Fn(usize, usize) -> f64,
    left: &DVector<f64>,
    limits: &[(f64, f64)],
    delta: f64,
) -> Program {
    let mut rows: Vec<(Vec<(usize, f64)>, f64)> =
        (0..n).map(|j| ((0..m).map(|i| (i, x(i, j))).filter(|entry| entry.1 != 0.0).collect(), 0.0)).collect();
    let mut cost: Vec<f64> = left.iter().map(|r| -r).collect();
    rows.extend((0..m).flat_map(|i| [1.0, -1.0].map(|sign| (vec![(i, sign)], 1.0))));
    for (j, &(low, high)) in limits.iter().enumerate() {
        for (sign, price) in [(-1.0, high), (1.0, -low)].into_iter().filter(|(_, price)| price.is_finite()) {
            rows[j].0.push((cost.len(), sign));
            rows.push((vec![(cost.len(), -1.0)], 0.0));
            cost.push(price);
        }
    }
    let mut squares = vec![delta; m];
    squares.resize(cost.len(), 0.0);
    Program { squares, cost, rows, equal: n }
}

/// The model's rows of all blocks as one matrix in (own | shared), and the residuals.
fn whole(
    model: &impl Model,
    sizes: &[(usize, usize)],
    own: &[Vec<f64>],
    shared: &[f64],
) -> (DMatrix<f64>, DVector<f64>) {
    let n = shared.len();
    let (rows, owned) = sizes.iter().fold((0, 0), |a, s| (a.0 + s.0, a.1 + s.1));
    let (mut x, mut left) = (DMatrix::zeros(rows, owned + n), DVector::zeros(rows));
    let (mut row, mut column) = (0, 0);
    for (block, &(m, q)) in sizes.iter().enumerate() {
        // Left aside: it has rows, but none that say anything.
        if m == 0 {
            continue;
        }
        let mut filled = DMatrix::zeros(m, q + n + 1);
        model.fill(block, shared, &own[block], &mut filled);
        x.view_mut((row, column), (m, q)).copy_from(&filled.columns(0, q));
        x.view_mut((row, owned), (m, n)).copy_from(&filled.columns(q, n));
        left.rows_mut(row, m).copy_from(&filled.column(q + n));
        (row, column) = (row + m, column + q);
    }
    (x, left)
}

/// The own and the shared unknowns after a step, the shared ones within their bounds.
fn moved(
    own: &[Vec<f64>],
    shared: &[f64],
    sizes: &[(usize, usize)],
    step: &[f64],
    ranges: &[(Bounds, f64)],
) -> (Vec<Vec<f64>>, Vec<f64>) {
    let mut rest = step;
    let next_own = own
        .iter()
        .zip(sizes)
        .map(|(own, &(_, q))| {
            let (by, after) = rest.split_at(q);
            rest = after;
            if q == 0 { own.clone() } else { own.iter().zip(by).map(|(value, by)| value + by).collect() }
        })
        .collect();
    let next = shared.iter().zip(rest).zip(ranges);
    (next_own, next.map(|((value, by), (bounds, _))| (value + by).clamp(bounds.low, bounds.high)).collect())
}

/// The residuals, block by block.
fn by_block(left: &DVector<f64>, sizes: &[(usize, usize)]) -> Vec<Vec<f64>> {
    let mut rest = left.as_slice();
    let blocks = sizes.iter().map(|&(m, _)| {
        let (block, after) = rest.split_at(m);
        rest = after;
        block.to_vec()
    });
    blocks.collect()
}

/// Minimises the loss from a start, such as the least-squares fit, or over the own unknowns only;
/// `None` for a table with too many rows.
pub(crate) fn fit(
    model: &impl Model,
    loss: Loss,
    shared: &[f64],
    own: &[Vec<f64>],
    pinned: bool,
) -> Result<Option<Robust>, Failure> {
    // Blocks too short to say anything are left aside, as in least squares.
    let sizes: Vec<(usize, usize)> =
        (0..own.len()).map(|b| model.size(b)).map(|(m, q)| if m > q { (m, q) } else { (0, 0) }).collect();
    let rows: usize = sizes.iter().map(|s| s.0).sum();
    let unknowns = shared.len() + sizes.iter().map(|s| s.1).sum::<usize>();
    if rows > ROWS || rows < unknowns || rows * unknowns > 300_000 {
        return Ok(None);
    }
    let ranges = model.ranges();
    let (mut shared, mut own) = (shared.to_vec(), own.to_vec());
    let mut trust = 1.0f64;
    let (mut x, mut left) = whole(model, &sizes, &own, &shared);
    if left.iter().chain(x.iter()).any(|v| !v.is_finite()) {
        return Err(Failure::Malformed);
    }
    for _ in 0..STEPS {
        // Nothing is left to be lowered.
        if left.amax() < 1e-9 {
            break;
        }
        let owned = unknowns - shared.len();
        let mut limits = vec![(f64::NEG_INFINITY, f64::INFINITY); owned];
        limits.extend(shared.iter().zip(&ranges).map(|(v, (b, reach))| {
            ((b.low - v).max(-trust * reach).min(0.0), (b.high - v).min(trust * reach).max(0.0))
        }));
        let mut step = if pinned {
            loss.step(&x.columns(0, owned).into_owned(), &left, &limits[..owned])?
        } else {
            loss.step(&x, &left, &limits)?
        };
        step.resize(unknowns, 0.0);
        let here = loss.cost(&left);
        let foreseen = loss.cost(&(&left - &x * DVector::from_column_slice(&step)));
        let mut accepted = false;
        let mut fraction = 1.0;
        while fraction > 1e-3 {
            let scaled: Vec<f64> = step.iter().map(|by| fraction * by).collect();
            let (next_own, next) = moved(&own, &shared, &sizes, &scaled, &ranges);
            let (there_x, there) = whole(model, &sizes, &next_own, &next);
            if there.iter().chain(there_x.iter()).all(|v| v.is_finite()) && loss.cost(&there) <= here {
                (shared, own, x, left) = (next, next_own, there_x, there);
                accepted = true;
                break;
            }
            fraction *= 0.5;
        }
        // Another step would change nothing: this one did not, or it did what the linear model had
        // foreseen, within the trust region.
        let there = loss.cost(&left);
        let free = fraction == 1.0 && (0..shared.len()).all(|j| step[owned + j].abs() < 0.5 * trust * ranges[j].1);
        if !accepted || here - there <= SAME * (SAME + here) || free && (there - foreseen).abs() <= LINEAR {
            break;
        }
        if fraction < 1.0 {
            trust *= fraction;
        }
    }
    let left_blocks = by_block(&left, &sizes);
    Ok(Some(Robust { shared, own, left: left_blocks, loss: loss.cost(&left) }))
}
