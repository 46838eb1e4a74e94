//! Linear systems whose matrix is a band, by Gaussian elimination with row interchanges.

/// A matrix of n rows whose entries are at most so far below and above the diagonal; once factored,
/// L below it, U above it and the reciprocals of D on it. The matrix is L D U, L and U have ones
/// on their diagonals: what each row waits for in a solution is then one product.
///
/// Interchanges make U reach as far again as L does: of each row there are 2 below + above + 1
/// places. Source: G. Golub, C. Van Loan, *Matrix Computations*, 4th edition, 2013, 4.3.
pub(super) struct Band {
    below: usize,
    above: usize,
    /// By rows, each from `below` places before the diagonal.
    entries: Vec<f64>,
    /// For each column the row that was taken for it.
    pivots: Vec<usize>,
}

impl Band {
    /// Of zeros.
    pub(super) fn new(n: usize, (below, above): (usize, usize)) -> Self {
        Self { below, above, entries: vec![0.0; n * (2 * below + above + 1)], pivots: vec![0; n] }
    }

    /// Where the entry (i, j) is.
    fn at(&self, i: usize, j: usize) -> usize {
        i * (2 * self.below + self.above + 1) + j + self.below - i
    }

    pub(super) fn set(&mut self, i: usize, j: usize, value: f64) {
        let at = self.at(i, j);
        self.entries[at] = value;
    }

    pub(super) fn factor(&mut self) {
        let n = self.pivots.len();
        for k in 0..n {
            let last = (k + self.below).min(n - 1);
            let size = |this: &Self, i: usize| this.entries[this.at(i, k)].abs();
            let pivot = (k + 1..=last).fold(k, |best, i| if size(self, i) > size(self, best) { i } else { best });
            self.pivots[k] = pivot;
            let width = (k + self.below + self.above).min(n - 1) - k;
            if pivot != k {
                let (here, there) = (self.at(k, k), self.at(pivot, k));
                let (upper, lower) = self.entries.split_at_mut(there);
                upper[here..=here + width].swap_with_slice(&mut lower[..=width]);
            }
            let diagonal = self.at(k, k);
            let reciprocal = 1.0 / self.entries[diagonal];
            self.entries[diagonal] = reciprocal;
            self.entries[diagonal + 1..=diagonal + width].iter_mut().for_each(|entry| *entry *= reciprocal);
            for i in k + 1..=last {
                let here = self.at(i, k);
                let (upper, lower) = self.entries.split_at_mut(here);
                let (first, row) = (lower[0], &upper[diagonal + 1..=diagonal + width]);
                lower[1..=width].iter_mut().zip(row).for_each(|(entry, of_row)| *entry -= first * of_row);
                lower[0] = first * reciprocal;
            }
        }
    }

    /// The solution for one right-hand side, in its place.
    pub(super) fn solve(&self, mut work: Vec<f64>) -> Vec<f64> {
        let n = self.pivots.len();
        for k in 0..n {
            let (last, pivot) = ((k + self.below).min(n - 1), self.pivots[k]);
            if pivot != k {
                work.swap(k, pivot);
            }
            let value = work[k];
            let below = work[k + 1..=last].iter_mut().zip(k + 1..);
            below.for_each(|(work, i)| *work -= self.entries[self.at(i, k)] * value);
        }
        for k in (0..n).rev() {
            let diagonal = self.at(k, k);
            let width = (k + self.below + self.above).min(n - 1) - k;
            let row = &self.entries[diagonal + 1..=diagonal + width];
            // The next one last, for which the others have waited.
            let far = row.iter().zip(&work[k + 1..]).rev();
            let value = far.fold(work[k] * self.entries[diagonal], |value, (entry, x)| value - entry * x);
            work[k] = value;
        }
        work
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bands of every width whose diagonal is small, so that rows are interchanged: the solution
    /// gives the right-hand side again, to rounding.
    #[test]
    fn a_band_is_solved_to_rounding() {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let (mut solved, mut singular) = (0, 0);
        for (n, below, above) in (1..=16).flat_map(|n| (0..n).flat_map(move |b| (0..n).map(move |a| (n, b, a)))) {
            let mut band = Band::new(n, (below, above));
            let columns = |i: usize| i.saturating_sub(below)..(i + above + 1).min(n);
            let mut rows = vec![[0.0; 16]; n];
            for (i, row) in rows.iter_mut().enumerate() {
                for j in columns(i) {
                    row[j] = if i == j { 1e-3 * next() } else { next() };
                    band.set(i, j, row[j]);
                }
            }
            let right: Vec<f64> = (0..n).map(|_| next()).collect();
            band.factor();
            let x = band.solve(right.clone());
            let size = x.iter().map(|x| x.abs()).fold(1.0, f64::max);
            if size > 1e6 {
                singular += 1; // to rounding, as some without entries above the diagonal are
                continue;
            }
            solved += 1;
            for (row, right) in rows.iter().zip(right) {
                let left: f64 = row.iter().zip(&x).map(|(entry, x)| entry * x).sum();
                assert!((left - right).abs() <= 1e-14 * size, "{n} {below} {above}: {left} {right} {size}");
            }
        }
        assert!(solved > 4 * singular, "{solved} {singular}");
    }
}
