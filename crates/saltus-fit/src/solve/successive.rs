//! Nonlinear least squares by successive bounded linear problems, for unknowns shared by all trials
//! and unknowns of one trial.
//!
//! Each trial is a block of rows with a few unknowns of its own (an intercept, a clock, a speed).
//! Reflections reduce the block to a triangle; its first rows give the own unknowns once the shared
//! ones are known, the others are rows in the shared unknowns alone. Those of all blocks are
//! reduced to one small triangle, which is solved within bounds and a trust region. This is exact,
//! and a million rows cost one pass each step.

use nalgebra::{DMatrix, DVector};

use super::least_squares::{Failure, settle, solve};
use crate::elementary::hypot;
use crate::model::{Bounds, Model};
use crate::quantity::Measured;

/// So many rows at a time are reflected, which a processor keeps close by.
const PANEL: usize = 256;
/// A column of rows this small beside the triangle's diagonal says nothing, nor one this small a
/// part of the least diagonal that counts.
const NOTHING: f64 = 1e-20;
const LEAST: f64 = 1e-120;
const STEPS: usize = 60;
/// A step this small, relative to the unknown, is the last.
const FINE: f64 = 1e-12;
/// A step that lowers the sum of squares by less than this part, and moves the unknowns by less
/// than its root, is the last.
const IDLE: f64 = 1e-13;

/// Block by block, information on the first shared unknown and the shift the block alone would give
/// it.
pub(crate) type Separate = Vec<(f64, f64)>;

/// The minimum of the sum of squares.
#[derive(Clone, Debug)]
pub(crate) struct Fitted {
    pub(crate) shared: Vec<f64>,
    /// The own unknowns of each block.
    pub(crate) own: Vec<Vec<f64>>,
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) active: Vec<bool>,
    pub(crate) chi_square: f64,
    /// Rows less unknowns, over the blocks that have more rows than own unknowns.
    pub(crate) freedom: usize,
    /// For each block, by how much the first shared unknown moves when the block is left out (to
    /// first order).
    pub(crate) influence: Vec<f64>,
    /// For each block, with one shared unknown: its information (1/variance) on that unknown, and
    /// where the block alone would have it, less where all have it.
    pub(crate) separate: Separate,
}

impl Fitted {
    /// The shared unknown `n` with its standard error.
    pub(crate) fn measured(&self, n: usize) -> Measured {
        Measured { value: self.shared[n], standard_error: self.covariance[(n, n)].sqrt() }
    }

    /// The error of a number from its derivatives by the shared unknowns, the first of which they
    /// are.
    pub(crate) fn error_of(&self, by: &[f64]) -> f64 {
        let each = |i: usize| (0..by.len()).map(move |j| (i, j));
        let variance: f64 = (0..by.len()).flat_map(each).map(|(i, j)| by[i] * by[j] * self.covariance[(i, j)]).sum();
        variance.max(0.0).sqrt()
    }
}

/// An upper triangle that rows are reflected into.
struct Triangle {
    width: usize,
    r: Vec<f64>,
}

impl Triangle {
    fn new(width: usize) -> Self {
        Self { width, r: vec![0.0; width * width] }
    }

    /// Reflects rows into the triangle, column by column.
    fn reflect(&mut self, rows: &mut DMatrix<f64>) {
        let w = self.width;
        for from in (0..rows.nrows()).step_by(PANEL) {
            let mut panel = rows.rows_mut(from, PANEL.min(rows.nrows() - from));
            for j in 0..w {
                let here = &mut self.r[j * w..(j + 1) * w];
                let below = panel.column(j).norm_squared();
                // Far below rounding, and far from where a square loses its digits.
                if below.sqrt() <= NOTHING * here[j].max(LEAST) {
                    continue;
                }
                // The reflection of (here | rows) about (1, pivot): the triangle's diagonal stays
                // positive, and nothing cancels.
                let length = hypot(here[j], below.sqrt());
                let head = -below / (here[j] + length);
                let scale = -head / length;
                let (mut pivot, mut rest) = panel.columns_range_pair_mut(j, j + 1..);
                pivot /= head;
                here[j] = length;
                for (here, mut column) in here[j + 1..].iter_mut().zip(rest.column_iter_mut()) {
                    let s = scale * (*here + column.dot(&pivot));
                    *here -= s;
                    column.axpy(-s, &pivot, 1.0);
                }
            }
        }
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.r[i * self.width..(i + 1) * self.width]
    }
}

/// The model linearised at a point.
struct Linear {
    x: DMatrix<f64>,
    y: DVector<f64>,
    /// Block after block, q rows of (own | shared | residual); zeros for a block that has too few
    /// rows.
    tops: Vec<f64>,
    cost: f64,
    rows: usize,
}

/// Minimises the sum of squared residuals from the given start.
pub(crate) fn fit(model: &impl Model, shared: &[f64], own: Vec<Vec<f64>>) -> Result<Fitted, Failure> {
    let ranges = model.ranges();
    let mut trust: Vec<f64> = ranges.iter().map(|r| r.1).collect();
    let mut shared: Vec<f64> = shared.iter().zip(&ranges).map(|(x, (b, _))| x.clamp(b.low, b.high)).collect();
    let sizes: Vec<usize> = own.iter().map(Vec::len).collect();
    let each = own;
    let mut own = each.concat();
    drop(each);
    let mut here = linearise(model, &shared, &own, &sizes)?;
    let whole: Vec<Bounds> = ranges.iter().map(|r| r.0).collect();
    for _ in 0..STEPS {
        let within: Vec<Bounds> = (0..shared.len())
            .map(|j| Bounds {
                low: (whole[j].low - shared[j]).max(-trust[j]),
                high: (whole[j].high - shared[j]).min(trust[j]),
            })
            .collect();
        let step = settle(&here.x, &here.y, &within)?.x;
        let own_step = own_steps(&here, step.as_slice(), &sizes)?;
        let small = |tolerance: f64| (0..shared.len()).all(|j| step[j].abs() <= tolerance * (1.0 + shared[j].abs()));
        let gain = predicted_gain(&here, &step, &sizes);
        if gain <= IDLE * here.cost && small(IDLE.sqrt()) {
            break;
        }
        // Unknowns of one trial may still move where there is no shared one, or it stands at a
        // bound.
        let last = small(FINE) && own.iter().zip(&own_step).all(|(x, d)| d.abs() <= FINE * (1.0 + x.abs()));
        let mut fraction = 1.0;
        let mut accepted = None;
        while fraction > 1e-4 {
            let next: Vec<f64> = (0..shared.len())
                .map(|j| (shared[j] + fraction * step[j]).clamp(whole[j].low, whole[j].high))
                .collect();
            let next_own: Vec<f64> = own.iter().zip(&own_step).map(|(x, d)| x + fraction * d).collect();
            match linearise(model, &next, &next_own, &sizes) {
                Ok(there) if there.cost <= here.cost => {
                    accepted = Some((next, next_own, there));
                    break;
                }
                _ => fraction *= 0.5,
            }
        }
        let Some((next, next_own, there)) = accepted else { break };
        for (j, trust) in trust.iter_mut().enumerate() {
            *trust = if fraction < 1.0 { (fraction * step[j].abs()).max(*trust * 0.25) } else { *trust * 2.0 };
        }
        (shared, own, here) = (next, next_own, there);
        if last {
            break;
        }
    }
    finish(model, shared, &own, &sizes, &here, &whole)
}

/// By how much the linear model promises to lower the sum of squares, own unknowns included.
fn predicted_gain(here: &Linear, step: &DVector<f64>, sizes: &[usize]) -> f64 {
    let mut gain = here.y.norm_squared() - (&here.y - &here.x * step).norm_squared();
    let mut tops = here.tops.as_slice();
    for &q in sizes {
        // The last entries of the top rows are the parts of the residuals that the own unknowns can
        // take away.
        let width = q + step.len() + 1;
        let (top, rest) = tops.split_at(q * width);
        gain += top.chunks_exact(width).map(|row| row[width - 1].powi(2)).sum::<f64>();
        tops = rest;
    }
    gain
}

/// By how much a step in the linear model at a point lowers the sum of squares: a test of one more
/// shared unknown.
pub(crate) fn score_gain(model: &impl Model, shared: &[f64], own: &[Vec<f64>]) -> Result<(f64, f64), Failure> {
    let sizes: Vec<usize> = own.iter().map(Vec::len).collect();
    let here = linearise(model, shared, &own.concat(), &sizes)?;
    let wide = vec![Bounds { low: -1e6, high: 1e6 }; shared.len()];
    let step = settle(&here.x, &here.y, &wide)?.x;
    let gain = predicted_gain(&here, &step, &sizes);
    Ok((gain, here.cost - gain))
}

/// Covariance, activity and influence at the minimum.
fn finish(
    model: &impl Model,
    shared: Vec<f64>,
    own: &[f64],
    sizes: &[usize],
    here: &Linear,
    whole: &[Bounds],
) -> Result<Fitted, Failure> {
    let within: Vec<Bounds> =
        whole.iter().zip(&shared).map(|(b, x)| Bounds { low: b.low - x, high: b.high - x }).collect();
    let last = if model.supposed() { settle } else { solve }(&here.x, &here.y, &within)?;
    // On a bound counts, even where the free minimum is there too: no covariance speaks for both
    // sides.
    let active: Vec<bool> =
        (0..shared.len()).map(|j| shared[j] <= whole[j].low || shared[j] >= whole[j].high).collect();
    let (influence, separate) = influence(model, &shared, own, sizes)?;
    let mut rest = own;
    let split = |&q: &usize| rest.split_off(..q).map_or_else(Vec::new, <[f64]>::to_vec);
    let own = sizes.iter().map(split).collect();
    let freedom = here.rows.saturating_sub(shared.len());
    Ok(Fitted { covariance: last.covariance, active, chi_square: here.cost, freedom, influence, separate, shared, own })
}

/// Reduces every block to a triangle and hands it on: the number of rows, of own unknowns, the
/// triangle, the sum of squares.
///
/// A block with too few rows to say anything is handed on with a zero triangle and no rows.
fn each_block(
    model: &impl Model,
    shared: &[f64],
    own: &[f64],
    sizes: &[usize],
    mut visit: impl FnMut(usize, usize, &Triangle, f64),
) -> Result<(), Failure> {
    let n = shared.len();
    let mut filled = DMatrix::zeros(0, 0);
    let mut triangle = Triangle::new(0);
    let mut start = 0;
    for (block, &q) in sizes.iter().enumerate() {
        let (m, width) = (model.size(block).0, q + n + 1);
        if triangle.width == width {
            triangle.r.fill(0.0);
        } else {
            triangle = Triangle::new(width);
        }
        let own = &own[start..start + q];
        start += q;
        if m <= q {
            visit(0, q, &triangle, 0.0);
            continue;
        }
        if filled.shape() == (m, width) {
            filled.fill(0.0);
        } else {
            filled = DMatrix::zeros(m, width);
        }
        model.fill(block, shared, own, &mut filled);
        let cost = filled.column(width - 1).norm_squared();
        triangle.reflect(&mut filled);
        if !cost.is_finite() || triangle.r.iter().any(|v| !v.is_finite()) {
            return Err(Failure::Malformed);
        }
        visit(m, q, &triangle, cost);
    }
    Ok(())
}

/// One pass over the blocks: residuals, derivatives, own unknowns eliminated.
fn linearise(model: &impl Model, shared: &[f64], own: &[f64], sizes: &[usize]) -> Result<Linear, Failure> {
    let n = shared.len();
    let mut all = Triangle::new(n + 1);
    let mut tops = Vec::with_capacity(own.len() * (n + 2));
    let mut tails = Vec::with_capacity(sizes.len() * (n + 1) * (n + 1));
    let (mut cost, mut rows) = (0.0, 0);
    each_block(model, shared, own, sizes, |m, q, triangle, squares| {
        (cost, rows) = (cost + squares, rows + m.saturating_sub(q));
        tops.extend_from_slice(&triangle.r[..q * triangle.width]);
        (q..triangle.width).for_each(|i| tails.extend_from_slice(&triangle.row(i)[q..]));
    })?;
    all.reflect(&mut DMatrix::from_row_slice(tails.len() / (n + 1), n + 1, &tails));
    let square = DMatrix::from_row_slice(n + 1, n + 1, &all.r);
    Ok(Linear { x: square.columns(0, n).into_owned(), y: square.column(n).into_owned(), tops, cost, rows })
}

/// The steps of the own unknowns that belong to a step of the shared ones, by back substitution.
fn own_steps(here: &Linear, step: &[f64], sizes: &[usize]) -> Result<Vec<f64>, Failure> {
    let n = step.len();
    let mut steps = vec![0.0; sizes.iter().sum()];
    let (mut tops, mut start) = (here.tops.as_slice(), 0);
    for &q in sizes {
        let width = q + n + 1;
        let (top, rest) = tops.split_at(q * width);
        tops = rest;
        let found = &mut steps[start..start + q];
        start += q;
        if top.iter().all(|v| *v == 0.0) {
            continue;
        }
        for i in (0..q).rev() {
            let row = &top[i * width..(i + 1) * width];
            let known: f64 = (i + 1..q).map(|j| row[j] * found[j]).sum();
            let shared: f64 = (0..n).map(|j| row[q + j] * step[j]).sum();
            found[i] = (row[q + n] - known - shared) / row[i];
            if !found[i].is_finite() {
                return Err(Failure::NotIdentified);
            }
        }
    }
    Ok(steps)
}

/// The shift of the first shared unknown when a block is left out, in the linear model at the
/// minimum.
fn influence(
    model: &impl Model,
    shared: &[f64],
    own: &[f64],
    sizes: &[usize],
) -> Result<(Vec<f64>, Separate), Failure> {
    let n = shared.len();
    // Without its only block nothing is left to shift.
    if n == 0 || n > 1 && sizes.len() == 1 {
        return Ok((vec![0.0; sizes.len()], Vec::new()));
    }
    // For each block XᵀX and Xᵀr, one after the other.
    let each = n * (n + 1);
    let mut parts = Vec::with_capacity(each * sizes.len());
    each_block(model, shared, own, sizes, |_, q, triangle, _| {
        for column in 0..=n {
            for j in 0..n {
                parts.push((0..=n).map(|i| triangle.row(q + i)[q + column] * triangle.row(q + i)[q + j]).sum::<f64>());
            }
        }
    })?;
    let mut total = DMatrix::zeros(n, n);
    for part in parts.chunks_exact(each) {
        total += DMatrix::from_column_slice(n, n, &part[..n * n]);
    }
    let shift = |part: &[f64]| {
        if n == 1 {
            let rest = total[(0, 0)] - part[0];
            return if rest > 0.0 { -part[1] / rest } else { 0.0 };
        }
        let rest = &total - DMatrix::from_column_slice(n, n, &part[..n * n]);
        rest.lu().solve(&DVector::from_column_slice(&part[n * n..])).map_or(0.0, |d| -d[0])
    };
    let alone = |part: &[f64]| if part[0] > 0.0 { (part[0], part[1] / part[0]) } else { (0.0, 0.0) };
    let separate = if n == 1 { parts.chunks_exact(each).map(alone).collect() } else { Vec::new() };
    Ok((parts.chunks_exact(each).map(shift).collect(), separate))
}

#[cfg(test)]
mod tests;
