//! Heights and times together under free flight with a given gravity.

use nalgebra::DMatrix;

use super::contacts::Moment;
use super::heights::Height;
use crate::least_squares::Bounds;
use crate::successive::Model;

/// What one trial offers to the joint fit.
#[derive(Clone, Debug, Default)]
pub(crate) struct FlightTrial {
    /// The height of release as set, and its standard error if it was measured rather than set.
    pub(crate) release: Option<(f64, Option<f64>)>,
    /// When the ball was let go.
    pub(crate) release_time: Option<f64>,
    /// Apexes after at least one contact.
    pub(crate) heights: Vec<Height>,
    /// `flights` counts from the first contact: contact 1 is after 0 flights.
    pub(crate) moments: Vec<Moment>,
}

/// Free flight: v is the speed at the first contact, Eₙ = e₁ … eₙ, hₙ = δ + (v Eₙ)²/2g, t of contact k = a + (2 v/g) Σⱼ₍ⱼ₌₁…ₖ₋₁₎ Eⱼ.
///
/// Shared: e (or one for each bounce), then on request the zero δ of the height scale, and a lag of the clock. Own: v unless the
/// height of release is set, a unless the time of release is known (then a is that time plus v/g, plus the lag).
#[derive(Clone, Debug)]
pub(crate) struct Flight {
    pub(crate) trials: Vec<FlightTrial>,
    pub(crate) gravity: f64,
    /// The number of separate CORs; with one it holds for all bounces.
    pub(crate) cors: usize,
    pub(crate) offset: bool,
    pub(crate) lag: bool,
}

impl Flight {
    /// Whether the speed at the first contact follows from a release height that was set.
    fn speed_is_set(trial: &FlightTrial) -> bool {
        matches!(trial.release, Some((_, None)))
    }

    /// The places of the offset and of the lag among the shared unknowns.
    fn places(&self) -> (Option<usize>, Option<usize>) {
        let offset = self.offset.then_some(self.cors);
        (offset, self.lag.then_some(self.cors + usize::from(self.offset)))
    }

    /// The own unknowns of a trial for a given COR: the speed from release or first height, the clock from the first moment.
    pub(crate) fn start(&self, e: f64) -> Vec<Vec<f64>> {
        let one = |trial: &FlightTrial| {
            let first = trial.heights.first();
            let height = match (trial.release, first) {
                (Some((height, _)), _) => height,
                (None, Some(&(n, h, _))) => h / e.max(0.05).powi(i32::try_from(2 * n).unwrap_or(i32::MAX)),
                (None, None) => match (trial.moments.first(), trial.moments.last()) {
                    (Some(a), Some(b)) if b.flights > a.flights => {
                        let sum: f64 =
                            (a.flights + 1..=b.flights).map(|j| e.powi(i32::try_from(j).unwrap_or(i32::MAX))).sum();
                        let v = (b.time - a.time) * self.gravity / (2.0 * sum.max(1e-6));
                        v * v / (2.0 * self.gravity)
                    }
                    _ => 1.0,
                },
            };
            let speed = (2.0 * self.gravity * height.clamp(1e-9, 1e9)).sqrt();
            let mut own = Vec::new();
            if !Self::speed_is_set(trial) {
                own.push(speed);
            }
            if trial.release_time.is_none() {
                own.push(trial.moments.first().map_or(0.0, |m| m.time));
            }
            own
        };
        self.trials.iter().map(one).collect()
    }

    /// The speed at the first contact and the time of it.
    pub(crate) fn first_contact(&self, block: usize, shared: &[f64], own: &[f64]) -> (f64, f64) {
        let trial = &self.trials[block];
        let (offset, lag) = self.places();
        let delta = offset.map_or(0.0, |n| shared[n]);
        let (speed, rest) = match trial.release {
            Some((height, None)) => ((2.0 * self.gravity * (height - delta).max(0.0)).sqrt(), own),
            _ => (own[0], own.get(1..).unwrap_or(&[])),
        };
        let clock = match trial.release_time {
            Some(time) => time + speed / self.gravity + lag.map_or(0.0, |n| shared[n]),
            None => rest.first().copied().unwrap_or(0.0),
        };
        (speed, clock)
    }

    /// The largest number of contacts that any row looks back on.
    pub(crate) fn bounces(&self) -> usize {
        let heights = self.trials.iter().flat_map(|t| t.heights.iter().map(|h| h.0));
        heights.chain(self.trials.iter().flat_map(|t| t.moments.iter().map(|m| m.flights))).max().unwrap_or(0)
    }
}

/// Eⱼ and Σ Eᵢ with their derivatives with respect to the CORs, bounce by bounce.
#[derive(Clone)]
struct Chain<'a> {
    cors: &'a [f64],
    bounces: usize,
    product: f64,
    product_slope: Vec<f64>,
    sum: f64,
    sum_slope: Vec<f64>,
}

impl<'a> Chain<'a> {
    fn new(cors: &'a [f64]) -> Self {
        let zero = vec![0.0; cors.len()];
        Self { cors, bounces: 0, product: 1.0, product_slope: zero.clone(), sum: 0.0, sum_slope: zero }
    }

    fn advance(&mut self, to: usize) {
        while self.bounces < to {
            let which = self.bounces.min(self.cors.len() - 1);
            let e = self.cors[which];
            for slope in &mut self.product_slope {
                *slope *= e;
            }
            self.product_slope[which] += self.product;
            self.product *= e;
            self.sum += self.product;
            for (sum, product) in self.sum_slope.iter_mut().zip(&self.product_slope) {
                *sum += product;
            }
            self.bounces += 1;
        }
    }
}

impl Model for Flight {
    fn ranges(&self) -> Vec<(Bounds, f64)> {
        let mut ranges = vec![(Bounds { low: 1e-6, high: 2.0 }, 0.1); self.cors];
        let tallest = self.trials.iter().filter_map(|t| t.release.map(|r| r.0)).fold(0.1, f64::max);
        if self.offset {
            ranges.push((Bounds { low: -tallest, high: 0.9 * tallest }, 0.05 * tallest));
        }
        if self.lag {
            ranges.push((Bounds { low: -10.0, high: 10.0 }, 0.1));
        }
        ranges
    }

    fn size(&self, block: usize) -> (usize, usize) {
        let trial = &self.trials[block];
        let measured = matches!(trial.release, Some((_, Some(_))));
        let rows = trial.heights.len() + trial.moments.len() + usize::from(measured);
        let own = usize::from(!Self::speed_is_set(trial)) + usize::from(trial.release_time.is_none());
        (rows, own)
    }

    fn fill(&self, block: usize, shared: &[f64], own: &[f64], rows: &mut DMatrix<f64>) {
        let trial = &self.trials[block];
        let g = self.gravity;
        let (offset, lag) = self.places();
        let delta = offset.map_or(0.0, |n| shared[n]);
        let set = Self::speed_is_set(trial);
        let (speed, clock) = self.first_contact(block, shared, own);
        let (q, last) = (own.len(), own.len() + shared.len());
        let own_clock = trial.release_time.is_none().then_some(q.wrapping_sub(1));
        // A set release height makes the speed depend on the offset: v² = 2 g (h₀ − δ).
        let speed_by_offset = if set { -g / speed.max(1e-12) } else { 0.0 };
        let mut i = 0;
        let mut chain = Chain::new(&shared[..self.cors]);
        let mut height_row = |rows: &mut DMatrix<f64>, chain: &Chain<'_>, height: f64, sigma: f64| {
            let reach = speed * chain.product;
            let by_speed = reach * chain.product / g;
            if !set {
                rows[(i, 0)] = by_speed / sigma;
            }
            for (j, slope) in chain.product_slope.iter().enumerate() {
                rows[(i, q + j)] = reach * speed * slope / g / sigma;
            }
            if let Some(n) = offset {
                rows[(i, q + n)] = (1.0 + by_speed * speed_by_offset) / sigma;
            }
            rows[(i, last)] = (height - delta - reach * reach / (2.0 * g)) / sigma;
            i += 1;
        };
        if let Some((height, Some(sigma))) = trial.release {
            height_row(rows, &chain, height, sigma);
        }
        for &(n, height, sigma) in &trial.heights {
            chain.advance(n);
            height_row(rows, &chain, height, sigma);
        }
        let mut chain = Chain::new(&shared[..self.cors]);
        for moment in &trial.moments {
            chain.advance(moment.flights);
            // The apex that follows contact k is half a flight later: v Eₖ / g.
            let (flights, slopes): (f64, Vec<f64>) = if moment.apex {
                let mut next = chain.clone();
                next.advance(moment.flights + 1);
                (chain.sum + next.sum, chain.sum_slope.iter().zip(&next.sum_slope).map(|(a, b)| a + b).collect())
            } else {
                (2.0 * chain.sum, chain.sum_slope.iter().map(|s| 2.0 * s).collect())
            };
            let mut by_speed = flights / g;
            if trial.release_time.is_some() {
                by_speed += 1.0 / g;
            }
            if !set {
                rows[(i, 0)] = by_speed / moment.sigma;
            }
            if let Some(column) = own_clock {
                rows[(i, column)] = 1.0 / moment.sigma;
            }
            for (j, slope) in slopes.iter().enumerate() {
                rows[(i, q + j)] = speed * slope / g / moment.sigma;
            }
            if let Some(n) = offset {
                rows[(i, q + n)] = by_speed * speed_by_offset / moment.sigma;
            }
            if let (Some(n), true) = (lag, trial.release_time.is_some()) {
                rows[(i, q + n)] = 1.0 / moment.sigma;
            }
            rows[(i, last)] = (moment.time - clock - speed * flights / g) / moment.sigma;
            i += 1;
        }
    }
}
