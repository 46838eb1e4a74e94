//! The linear systems of a step by `Rodas5P`: 1 - hγJ, with the Jacobian J from differences of the
//! flow.

use super::band::Band;
#[cfg(feature = "sparse")]
use super::scattered::Scattered;
use crate::sparsity::{Sparsity, listed};
use crate::state::State;

/// How far the differences for the Jacobian reach, relative to the scale of a coordinate: the cube
/// root of the rounding of a double.
const REACH: f64 = 6.06e-6;
/// A coordinate smaller than this part of the largest may have come to be so by chance.
const BESIDE: f64 = 1e-6;
/// A coordinate that is smaller is moved as if it were so large: differences of it are numbers of
/// full precision.
const LEAST: f64 = f64::MIN_POSITIVE / REACH;

/// Room for the linear systems of up to N coordinates.
pub(super) struct Room<const N: usize> {
    matrix: [[f64; N]; N],
    work: [f64; N],
    order: [usize; N],
}

impl<const N: usize> Room<N> {
    #[inline]
    pub(super) fn new() -> Self {
        Self { matrix: [[0.0; N]; N], work: [0.0; N], order: [0; N] }
    }

    /// Room for `n` of them.
    #[inline]
    pub(super) fn first(&mut self, n: usize) -> Dense<'_> {
        let matrix = &mut self.matrix.as_flattened_mut()[..n * n];
        Dense { matrix, work: &mut self.work[..n], order: &mut self.order[..n] }
    }
}

/// Linear systems that share the matrix 1 - h γ J.
pub(super) enum System<'a> {
    Dense(Dense<'a>),
    Sparse(Sparse<'a>),
}

impl System<'_> {
    /// Writes 1 - h γ J, with J from central differences of the flow, and factors it. A singular
    /// matrix makes every solution infinite or NaN.
    #[inline(always)] // with a dimension known at compile time the loops vanish
    pub(super) fn fill<S: State>(
        &mut self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        (h, gamma): (f64, f64),
    ) {
        let n = x.len();
        let mut sizes = x.with(|i| x.get(i).abs().max((h * slope.get(i)).abs()));
        let largest = (0..n).map(|i| sizes.get(i)).fold(0.0, f64::max);
        let smallest = if largest > 0.0 { BESIDE * largest } else { 1.0 };
        if (0..n).any(|i| sizes.get(i) < smallest) {
            sizes = grown(flow, t, x, slope, h, &sizes, smallest);
        }
        match self {
            Self::Dense(system) => {
                system.fill(flow, t, x, slope, h * gamma, &sizes);
                system.factor();
            }
            Self::Sparse(system) => system.fill(flow, (t, x), slope, h * gamma, &sizes),
        }
    }

    /// The solution for one right-hand side, of which a step asks for eleven. Where the dimension
    /// is known at compile time the loops vanish; in a page it is size that counts.
    #[cfg_attr(target_family = "wasm", inline(never))]
    #[cfg_attr(not(target_family = "wasm"), inline(always))]
    pub(super) fn solve<S: State>(&mut self, right: &S) -> S {
        match self {
            Self::Dense(system) => system.solve(right),
            Self::Sparse(system) => system.solve(right),
        }
    }
}

/// A matrix whose entries have a pattern, solved as a band or, where that costs more, as it is.
pub(super) enum Sparse<'a> {
    Banded(Band, &'a Sparsity),
    #[cfg(feature = "sparse")]
    Scattered(Box<Scattered<'a>>),
}

impl<'a> Sparse<'a> {
    pub(super) fn of(sparsity: &'a Sparsity) -> Self {
        #[cfg(feature = "sparse")]
        if Scattered::is_cheaper(sparsity) {
            return Self::Scattered(Box::new(Scattered::new(sparsity)));
        }
        Self::Banded(Band::new(sparsity.len(), sparsity.band()), sparsity)
    }

    #[inline(never)]
    fn fill<S: State>(&mut self, flow: &mut impl FnMut(f64, &S) -> S, at: (f64, &S), slope: &S, by: f64, sizes: &S) {
        match self {
            Self::Banded(band, sparsity) => {
                by_colours(sparsity, flow, at, slope, sizes, |(i, j), _, slope| {
                    band.set(i, j, unit(i, j) - by * slope);
                });
                band.factor();
            }
            #[cfg(feature = "sparse")]
            Self::Scattered(matrix) => {
                let sparsity = matrix.sparsity;
                by_colours(sparsity, flow, at, slope, sizes, |(i, j), entry, slope| {
                    matrix.values[entry] = unit(i, j) - by * slope;
                });
                matrix.factor();
            }
        }
    }

    #[inline(never)]
    fn solve<S: State>(&self, right: &S) -> S {
        let list = listed(right);
        let solution = match self {
            Self::Banded(band, _) => band.solve(list),
            #[cfg(feature = "sparse")]
            Self::Scattered(matrix) => matrix.solve(list),
        };
        right.with(|i| solution[i])
    }
}

/// A matrix of which every entry may be other than zero.
pub(super) struct Dense<'a> {
    /// By rows; once factored, L below the diagonal, U above it and the reciprocals of the diagonal
    /// of U on it.
    pub(super) matrix: &'a mut [f64],
    pub(super) work: &'a mut [f64],
    /// Which row was taken first, second, …
    pub(super) order: &'a mut [usize],
}

impl Dense<'_> {
    #[inline(always)]
    fn fill<S: State>(&mut self, flow: &mut impl FnMut(f64, &S) -> S, t: f64, x: &S, slope: &S, by: f64, sizes: &S) {
        let n = x.len();
        for j in 0..n {
            let reach = REACH * sizes.get(j);
            let mut probe = |to: f64| (to, flow(t, &x.with(|i| if i == j { to } else { x.get(i) })));
            let (mut above, mut below) = (probe(x.get(j) + reach), probe(x.get(j) - reach));
            if !above.1.is_finite() {
                above = (x.get(j), slope.clone());
            } else if !below.1.is_finite() {
                below = (x.get(j), slope.clone());
            }
            let scale = -by / (above.0 - below.0);
            for i in 0..n {
                self.matrix[i * n + j] = unit(i, j) + scale * (above.1.get(i) - below.1.get(i));
            }
        }
    }

    /// By Gaussian elimination with row interchanges.
    #[inline(always)]
    pub(super) fn factor(&mut self) {
        let n = self.order.len();
        for (i, row) in self.order.iter_mut().enumerate() {
            *row = i;
        }
        for k in 0..n {
            let pivot = (k + 1..n).fold(k, |best, i| {
                if self.matrix[i * n + k].abs() > self.matrix[best * n + k].abs() { i } else { best }
            });
            if pivot != k {
                self.order.swap(k, pivot);
                for j in 0..n {
                    self.matrix.swap(k * n + j, pivot * n + j);
                }
            }
            let reciprocal = 1.0 / self.matrix[k * n + k];
            self.matrix[k * n + k] = reciprocal;
            for i in k + 1..n {
                let factor = self.matrix[i * n + k] * reciprocal;
                self.matrix[i * n + k] = factor;
                for j in k + 1..n {
                    self.matrix[i * n + j] -= factor * self.matrix[k * n + j];
                }
            }
        }
    }

    #[inline(always)]
    pub(super) fn solve<S: State>(&mut self, right: &S) -> S {
        let n = self.order.len();
        for i in 0..n {
            let mut value = right.get(self.order[i]);
            for j in 0..i {
                value -= self.matrix[i * n + j] * self.work[j];
            }
            self.work[i] = value;
        }
        for i in (0..n).rev() {
            let mut value = self.work[i];
            for j in i + 1..n {
                value -= self.matrix[i * n + j] * self.work[j];
            }
            self.work[i] = value * self.matrix[i * n + i];
        }
        right.with(|i| self.work[i])
    }
}

/// Entry (i, j) of 1.
#[inline(always)]
fn unit(i: usize, j: usize) -> f64 {
    if i == j { 1.0 } else { 0.0 }
}

/// Gives each entry of a sparse Jacobian, with its row, its column and which of all it is: of each
/// colour's columns from one difference of the flow.
#[inline(never)]
fn by_colours<S: State>(
    sparsity: &Sparsity,
    flow: &mut impl FnMut(f64, &S) -> S,
    (t, x): (f64, &S),
    slope: &S,
    sizes: &S,
    mut entry: impl FnMut((usize, usize), usize, f64),
) {
    let mut reaches = vec![0.0; x.len()];
    for columns in sparsity.colours() {
        reaches.fill(0.0);
        columns.iter().for_each(|&j| reaches[j] = REACH * sizes.get(j));
        let mut probe = |to: S| (flow(t, &to), to);
        let mut above = probe(x.with(|j| x.get(j) + reaches[j]));
        let mut below = probe(x.with(|j| x.get(j) - reaches[j]));
        if !above.0.is_finite() {
            above = (slope.clone(), x.clone());
        } else if !below.0.is_finite() {
            below = (slope.clone(), x.clone());
        }
        for &j in columns {
            let apart = above.1.get(j) - below.1.get(j);
            let (rows, first) = sparsity.column(j);
            for (k, &i) in rows.iter().enumerate() {
                entry((i, j), first + k, (above.0.get(i) - below.0.get(i)) / apart);
            }
        }
    }
}

/// The `sizes` of coordinates, of which some are so small beside the largest that a step may make
/// them larger: by what the slope changes by over it, up to `smallest`. One that is zero all the
/// same, and has no size of its own, gets that.
#[cold]
fn grown<S: State>(
    flow: &mut impl FnMut(f64, &S) -> S,
    t: f64,
    x: &S,
    slope: &S,
    h: f64,
    sizes: &S,
    smallest: f64,
) -> S {
    let ahead = flow(t, &x.with(|i| x.get(i) + h * slope.get(i)));
    x.with(|i| {
        let bend = (h * (ahead.get(i) - slope.get(i))).abs();
        let grown = if bend > 0.0 { bend.min(smallest) } else { 0.0 };
        match sizes.get(i).max(grown) {
            0.0 => smallest,
            size => size.max(LEAST),
        }
    })
}
