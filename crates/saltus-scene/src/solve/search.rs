//! Finding the numbers with which wishes come true.

use nalgebra::{DMatrix, DVector};

/// A problem: numbers between limits, and the errors of the wishes by them.
pub(super) struct Problem<'a> {
    /// Least and most of each number.
    pub(super) limits: Vec<[f64; 2]>,
    /// The scale of each number: about its size.
    pub(super) sizes: Vec<f64>,
    /// The error of each wish, in units of what it allows; `None` where it does not come to that.
    pub(super) off: &'a dyn Fn(&[f64]) -> Option<Vec<f64>>,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    pub(super) numbers: Vec<f64>,
    pub(super) off: Vec<f64>,
}

impl Found {
    fn cost(&self) -> f64 {
        self.off.iter().map(|off| off * off).sum()
    }

    /// Whether every wish is met as well as numbers can.
    pub(super) fn meets(&self) -> bool {
        self.off.iter().all(|off| off.abs() < MET)
    }
}

/// The error at which a wish counts as met, in units of what it allows: a hundred-millionth of a
/// centimetre or of half a frame.
const MET: f64 = 1e-8;
const MOST_STEPS: usize = 60;

impl Problem<'_> {
    /// The best of what is found from each start.
    pub(super) fn best(&self, starts: &[Vec<f64>]) -> Option<Found> {
        let mut best: Option<Found> = None;
        for start in starts {
            let Some(found) = self.near(start) else { continue };
            if best.as_ref().is_none_or(|best| found.cost() < best.cost()) {
                best = Some(found);
            }
            if best.as_ref().is_some_and(Found::meets) {
                break;
            }
        }
        best
    }

    fn at(&self, numbers: Vec<f64>) -> Option<Found> {
        let off = (self.off)(&numbers)?;
        off.iter().all(|off| off.is_finite()).then_some(Found { numbers, off })
    }

    /// The least squares near a start, by steps of Levenberg and Marquardt that stay between the
    /// limits.
    fn near(&self, start: &[f64]) -> Option<Found> {
        let mut now = self.at(start.to_vec())?;
        let mut damping = 1e-3;
        for _ in 0..MOST_STEPS {
            if now.cost() == 0.0 {
                break;
            }
            let slopes = self.slopes(&now)?;
            let Some(next) = self.step(&now, &slopes, &mut damping) else { break };
            let (gained, small) = (now.cost() - next.cost(), 1e-16 * now.cost());
            now = next;
            if gained <= small {
                break;
            }
        }
        Some(now)
    }

    /// A step that gains, from one that is hardly damped to one that hardly moves.
    fn step(&self, now: &Found, slopes: &DMatrix<f64>, damping: &mut f64) -> Option<Found> {
        let off = DVector::from_column_slice(&now.off);
        let gradient = slopes.tr_mul(&off);
        // A number at a limit whose gradient leads beyond it stays.
        let held = |k: usize| {
            let ([least, most], x) = (self.limits[k], now.numbers[k]);
            (x <= least && gradient[k] > 0.0) || (x >= most && gradient[k] < 0.0)
        };
        let mut normal = slopes.tr_mul(slopes);
        let mut right = -gradient.clone();
        for k in (0..right.len()).filter(|&k| held(k)) {
            normal.row_mut(k).fill(0.0);
            normal.column_mut(k).fill(0.0);
            (normal[(k, k)], right[k]) = (1.0, 0.0);
        }
        for _ in 0..24 {
            let mut damped = normal.clone();
            for k in 0..right.len() {
                damped[(k, k)] += *damping * normal[(k, k)].max(1e-12);
            }
            let step = damped.cholesky().map(|factors| factors.solve(&right));
            let tried = step.and_then(|step| {
                let moved = now.numbers.iter().enumerate().map(|(k, x)| {
                    let [least, most] = self.limits[k];
                    (x + step[k] * self.sizes[k]).clamp(least, most)
                });
                self.at(moved.collect())
            });
            match tried {
                Some(next) if next.cost() < now.cost() => {
                    *damping = (*damping * 0.1).max(1e-14);
                    return Some(next);
                }
                _ => *damping *= 8.0,
            }
        }
        None
    }

    /// The derivatives of the wishes by each number, by differences in units of its size.
    fn slopes(&self, now: &Found) -> Option<DMatrix<f64>> {
        let mut slopes = DMatrix::zeros(now.off.len(), now.numbers.len());
        for k in 0..now.numbers.len() {
            let ([least, most], x, size) = (self.limits[k], now.numbers[k], self.sizes[k]);
            let side = |h: f64| {
                let mut numbers = now.numbers.clone();
                numbers[k] = (x + h).clamp(least, most);
                (numbers[k] != x).then(|| self.at(numbers)).flatten()
            };
            let h = 1e-5 * x.abs().max(1e-2 * size);
            let (up, down) = (side(h), side(-h));
            let (high, low) = (up.as_ref().unwrap_or(now), down.as_ref().unwrap_or(now));
            let between = high.numbers[k] - low.numbers[k];
            if between == 0.0 {
                return None;
            }
            for (row, (high, low)) in high.off.iter().zip(&low.off).enumerate() {
                slopes[(row, k)] = (high - low) / between * size;
            }
        }
        Some(slopes)
    }
}

/// Starts around the numbers themselves: each with fractions and multiples of each number, the
/// numbers themselves first.
pub(super) fn starts(numbers: &[f64], limits: &[[f64; 2]], sizes: &[f64]) -> Vec<Vec<f64>> {
    let mut starts = vec![numbers.to_vec()];
    for k in 0..numbers.len() {
        let [least, most] = limits[k];
        let others: &[f64] = if most.is_finite() {
            &[0.3, 0.6, 0.9]
        } else if least == 0.0 {
            &[0.3, 3.0, 0.05, 20.0]
        } else {
            &[3.0, -3.0, 10.0]
        };
        let with = |start: &Vec<f64>, other: f64| {
            let mut start = start.clone();
            start[k] = if most.is_finite() { other } else { other * sizes[k] };
            start
        };
        let more: Vec<Vec<f64>> =
            starts.iter().flat_map(|start| others.iter().map(|&other| with(start, other))).collect();
        starts.extend(more);
        starts.truncate(200);
    }
    starts
}
