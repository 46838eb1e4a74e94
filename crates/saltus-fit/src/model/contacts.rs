//! Contact times: t = a + τ (1 + e + … + eⁿ⁻¹), with a clock and a first flight per trial. Gravity
//! and scale drop out.

use nalgebra::DMatrix;

use super::problem::{Bounds, Model};
use crate::evidence::Moment;

/// Times of contacts (and apexes). Shared: e, and on request a trend. Own: a, τ.
///
/// The times themselves are fitted, not the intervals: neighbouring intervals share a contact, so
/// their errors are correlated. Where each interval was read by itself, it is the times that share
/// their errors, and the intervals are fitted.
#[derive(Clone, Debug)]
pub(crate) struct Contacts {
    /// In ascending order of flights.
    pub(crate) trials: Vec<Vec<Moment>>,
    /// The upper bound of e.
    pub(crate) high: f64,
    /// Adds an unknown m: flight k lasts τ eᵏ (1 + m k (k − 1)/2), a COR that changes from bounce
    /// to bounce. Derivatives are at m = 0.
    pub(crate) trend: bool,
    /// The errors are those of the intervals, which add up along the times.
    pub(crate) added_up: bool,
    pub(crate) supposed: bool,
}

impl Contacts {
    /// A start for the own unknowns: the first contact and flight, extrapolated to the first row
    /// where need be.
    pub(crate) fn start(&self, e: f64) -> Vec<Vec<f64>> {
        let start = |moments: &Vec<Moment>| match (moments.first(), moments.last()) {
            (Some(first), Some(last)) if moments.len() > 1 => {
                let (a, b) = (Sums::at(e, first), Sums::at(e, last));
                let tau = (last.time - first.time) / (b.position - a.position);
                vec![first.time - tau * a.position, tau]
            }
            _ => vec![moments.first().map_or(0.0, |m| m.time), 1.0],
        };
        self.trials.iter().map(start).collect()
    }
}

/// Running sums over flights: Σ eʲ, its derivative, and Σ eʲ j (j − 1)/2.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    flights: usize,
    /// e to the number of flights, and its derivative.
    power: f64,
    slope: f64,
    sum: f64,
    sum_slope: f64,
    trend: f64,
    position: f64,
}

impl Sums {
    fn new() -> Self {
        Self { power: 1.0, ..Self::default() }
    }

    /// The sums over these flights and `next` ones that go on from them.
    #[allow(clippy::cast_precision_loss)] // a table of 2⁵³ flights is none
    fn then(self, e: f64, next: Self) -> Self {
        let before = self.flights as f64;
        // Of m + j flights there are m (m - 1)/2 + m j + j (j - 1)/2 pairs.
        let pairs = next.sum * (0.5 * before * (before - 1.0)) + before * e * next.sum_slope + next.trend;
        Self {
            flights: self.flights + next.flights,
            power: self.power * next.power,
            slope: self.slope * next.power + self.power * next.slope,
            sum: self.sum + self.power * next.sum,
            sum_slope: self.sum_slope + self.slope * next.sum + self.power * next.sum_slope,
            trend: self.trend + self.power * pairs,
            position: self.position,
        }
    }

    /// Goes on to a flight by sums over one, two, four flights and so on, as its number is written
    /// in binary: a great one takes no more than its digits.
    fn advance(&mut self, e: f64, to: usize) {
        let mut step = Self { flights: 1, power: e, slope: 1.0, sum: 1.0, ..Self::default() };
        let mut left = to.saturating_sub(self.flights);
        while left > 0 {
            if left % 2 == 1 {
                *self = self.then(e, step);
            }
            (step, left) = (step.then(e, step), left / 2);
        }
    }

    /// The place of one moment in units of τ.
    fn at(e: f64, moment: &Moment) -> Self {
        let mut sums = Self::new();
        sums.advance(e, moment.flights);
        sums.position = sums.sum + if moment.apex { 0.5 * sums.power } else { 0.0 };
        sums
    }
}

impl Model for Contacts {
    fn supposed(&self) -> bool {
        self.supposed
    }

    fn ranges(&self) -> Vec<(Bounds, f64)> {
        let mut ranges = vec![(Bounds { low: 0.0, high: self.high }, 0.1)];
        if self.trend {
            ranges.push((Bounds { low: -1e3, high: 1e3 }, 1e3));
        }
        ranges
    }

    fn size(&self, block: usize) -> (usize, usize) {
        (self.trials[block].len(), 2)
    }

    fn fill(&self, block: usize, shared: &[f64], own: &[f64], rows: &mut DMatrix<f64>) {
        let (e, tau) = (shared[0], own[1]);
        let mut sums = Sums::new();
        for (i, moment) in self.trials[block].iter().enumerate() {
            sums.advance(e, moment.flights);
            let half = if moment.apex { 0.5 } else { 0.0 };
            let position = sums.sum + half * sums.power;
            let mut predicted = own[0] + tau * position;
            rows[(i, 0)] = 1.0 / moment.sigma;
            rows[(i, 1)] = position / moment.sigma;
            rows[(i, 2)] = tau * (sums.sum_slope + half * sums.slope) / moment.sigma;
            if self.trend {
                rows[(i, 3)] = tau * sums.trend / moment.sigma;
                predicted += tau * sums.trend * shared[1];
            }
            rows[(i, 2 + shared.len())] = (moment.time - predicted) / moment.sigma;
        }
        if self.added_up {
            for (i, pair) in self.trials[block].windows(2).enumerate().rev() {
                let before = rows.row(i) * (pair[0].sigma / pair[1].sigma);
                let mut row = rows.row_mut(i + 1);
                row -= before;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_one_flight_after_the_other() {
        for e in [0.0, 0.3, 0.81, 0.9985, 1.0] {
            let (mut single, mut together) = (Sums::new(), Sums::new());
            for to in [1, 2, 3, 7, 8, 40, 41, 1000, 30_000] {
                while single.flights < to {
                    single = single.then(e, Sums { flights: 1, power: e, slope: 1.0, sum: 1.0, ..Sums::default() });
                }
                together.advance(e, to);
                let of = |s: Sums| [s.power, s.slope, s.sum, s.sum_slope, s.trend];
                let near = |(a, b): (f64, f64)| (a - b).abs() <= 1e-11 * a.abs().max(1e-300);
                assert!(of(single).into_iter().zip(of(together)).all(near), "{e} {to} {single:?} {together:?}");
                let [sum, pairs] = [0.0, 1.0].map(|weigh: f64| {
                    (0..u32::try_from(to).unwrap_or(0))
                        .map(f64::from)
                        .fold(0.0, |sum, k| sum + e.powf(k) * (0.5 * k * (k - 1.0)).powf(weigh))
                });
                assert!(
                    near((sum, together.sum)) && near((pairs, together.trend)),
                    "{e} {to} {sum} {pairs} {together:?}"
                );
            }
        }
    }

    #[test]
    fn a_great_number_of_flights_is_a_few_sums() {
        let mut sums = Sums::new();
        sums.advance(1.0, usize::MAX >> 12);
        assert_eq!((sums.flights, sums.sum), (usize::MAX >> 12, (usize::MAX >> 12) as f64));
    }
}
