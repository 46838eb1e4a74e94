//! The whole motion of a tracked ball: fall, impacts and flights as one curve through every sample.
//!
//! Between contacts the flight is known in closed form ([`Air`]), and so are the times of the
//! contacts; their derivatives carry the shift of every later flight, so nothing needs adding for
//! the jumps.
//!
//! A contact takes no time, or some ([`Lasting`]).

use nalgebra::DMatrix;

use super::drag::{Air, Sloped};
use super::dual::Dual;
use super::lasting::{self, Lasting};
use super::places::{DRAG, FLOOR, GRAVITY, SPEED, TIME};
use super::problem::{Bounds, Model};

/// One sample of a series: when, how high, and the square root of its weight over its standard
/// error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    pub(crate) time: f64,
    pub(crate) height: f64,
    pub(crate) weight: f64,
}

/// How the COR may vary from impact to impact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Law {
    /// One COR.
    Constant,
    /// e = e₀ + s (v/v₁ − 1), with v₁ a fixed speed near that of the first impact.
    Linear,
    /// A COR for every impact.
    Each,
}

/// Unknowns, all shared: time and speed of the first impact, floor, G, then k if there is drag, the
/// speed of the floor if it drifts, those of contacts if they take time, then those of the COR.
/// Seen from a floor that drifts evenly the motion is the same.
#[derive(Clone, Debug)]
pub(crate) struct Trajectory<'a> {
    pub(crate) samples: &'a [Sample],
    pub(crate) impacts: usize,
    pub(crate) drag: bool,
    /// The drag where it is not unknown: 0 for none.
    pub(crate) held: f64,
    pub(crate) drift: bool,
    /// Contacts take time; samples, of weight one, have this standard error.
    pub(crate) contact: Option<f64>,
    pub(crate) law: Law,
    /// The speed v₁ of the linear law and of contacts that take time.
    pub(crate) speed: f64,
    /// Where the first impact may be: the time of the start and how far from it.
    pub(crate) first: (f64, f64),
    /// The largest COR.
    pub(crate) high: f64,
}

/// The least k times the range of heights: below it drag does not differ from none.
pub(crate) const LEAST_DRAG: f64 = 1e-7;

/// An impact as the model has it: time of arrival, its speed, COR, each with derivatives by all
/// unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Impact {
    pub(crate) time: Dual,
    pub(crate) arrival: Dual,
    pub(crate) cor: Dual,
    /// How long it lasts, if it takes time.
    pub(crate) lasts: Option<Dual>,
}

impl Impact {
    /// How far the ball is below the floor at a time within the contact; `None` at others.
    fn depth(&self, time: f64) -> Option<Dual> {
        let lasts = self.lasts.as_ref().filter(|lasts| time < self.time.value + lasts.value)?;
        Some(lasting::depth([&self.time, lasts, &self.arrival, &self.cor], time))
    }
}

/// The apex of a flight: when, and how high.
struct Apex {
    time: Dual,
    height: Dual,
}

impl Trajectory<'_> {
    /// Where the unknowns of the COR begin.
    pub(crate) fn first_cor(&self) -> usize {
        DRAG + usize::from(self.drag) + usize::from(self.drift) + self.contact.map_or(0, |_| lasting::UNKNOWNS)
    }

    /// The place of the time of a contact.
    pub(crate) fn contact_place(&self) -> Option<usize> {
        self.lasting().map(|lasting| lasting.place)
    }

    fn lasting(&self) -> Option<Lasting> {
        self.contact.map(|_| Lasting { place: self.first_cor() - lasting::UNKNOWNS, speed: self.speed })
    }

    pub(crate) fn drift_place(&self) -> Option<usize> {
        self.drift.then_some(DRAG + usize::from(self.drag))
    }

    pub(crate) fn drag_place(&self) -> Option<usize> {
        self.drag.then_some(DRAG)
    }

    pub(crate) fn air(&self, values: &[f64]) -> Air {
        Air { gravity: values[GRAVITY], drag: if self.drag { values[DRAG] } else { self.held } }
    }

    fn chain(&self, outer: &Sloped, x: &Dual) -> Dual {
        x.through(outer, Some(GRAVITY), self.drag_place())
    }

    /// The COR of impact `n` (from 0) at which the ball arrives at a speed.
    fn cor(&self, values: &[f64], n: usize, arrival: &Dual) -> Dual {
        let first = self.first_cor();
        let unknown = |j: usize| Dual::unknown(values[j], values.len(), j);
        match self.law {
            Law::Constant => unknown(first),
            Law::Each => unknown(first + n),
            Law::Linear => {
                let excess = arrival.value / self.speed - 1.0;
                let value = values[first] + values[first + 1] * excess;
                let mut cor = arrival.mapped(value, values[first + 1] / self.speed);
                cor.by[first] += 1.0;
                cor.by[first + 1] += excess;
                cor
            }
        }
    }

    /// All impacts, and the apex of each flight: the fall first, then one after each impact.
    fn course(&self, values: &[f64]) -> (Vec<Impact>, Vec<Apex>) {
        let air = self.air(values);
        let unknown = |j: usize| Dual::unknown(values[j], values.len(), j);
        let floor = unknown(FLOOR);
        let (mut time, mut arrival) = (unknown(TIME), unknown(SPEED));
        let (since, height) = air.fallen(arrival.value);
        let since = self.chain(&since, &arrival);
        let mut apexes = vec![Apex { time: time.minus(&since), height: floor.plus(&self.chain(&height, &arrival)) }];
        let mut impacts = Vec::with_capacity(self.impacts);
        for n in 0..self.impacts {
            let cor = self.cor(values, n, &arrival);
            let lasting = self.lasting().map(|lasting| (lasting, lasting.time(values, &arrival)));
            let (cor, lasts) = match lasting {
                Some((lasting, lasts)) => (lasting.cor(values, &cor, &lasts, &arrival), Some(lasts)),
                None => (cor, None),
            };
            let departure = cor.times(&arrival);
            let hop = air.hop(departure.value);
            let rise = self.chain(&hop.rise, &departure);
            let fall = self.chain(&hop.fall, &departure);
            let leaves = lasts.as_ref().map_or_else(|| time.clone(), |lasts| time.plus(lasts));
            let top = leaves.plus(&rise);
            let next = top.plus(&fall);
            let next_arrival = self.chain(&hop.arrival, &departure);
            apexes.push(Apex { time: top, height: floor.plus(&self.chain(&hop.height, &departure)) });
            impacts.push(Impact { time, arrival, cor, lasts });
            (time, arrival) = (next, next_arrival);
        }
        (impacts, apexes)
    }

    /// How far the ball is below the floor at each sample; 0 in flight.
    pub(crate) fn depths(&self, values: &[f64]) -> Vec<f64> {
        let impacts = self.impacts(values);
        let depth = |sample: &Sample| {
            let last = impacts.partition_point(|impact| impact.time.value <= sample.time).checked_sub(1)?;
            impacts[last].depth(sample.time).map(|depth| depth.value)
        };
        self.samples.iter().map(|sample| depth(sample).unwrap_or(0.0)).collect()
    }

    pub(crate) fn impacts(&self, values: &[f64]) -> Vec<Impact> {
        self.course(values).0
    }

    /// Times and heights of the apexes, that of the fall first.
    pub(crate) fn apexes(&self, values: &[f64]) -> Vec<(f64, f64)> {
        self.course(values).1.iter().map(|a| (a.time.value, a.height.value)).collect()
    }
}

impl Model for Trajectory<'_> {
    fn ranges(&self) -> Vec<(Bounds, f64)> {
        let (time, reach) = self.first;
        let mut ranges = vec![
            (Bounds { low: time - reach, high: time + reach }, reach),
            (Bounds { low: 1e-6, high: 1e4 }, 10.0),
            (Bounds { low: -3.0, high: 3.0 }, 0.1),
            (Bounds { low: 1e-6, high: 1e6 }, 1e3),
        ];
        if self.drag {
            ranges.push((Bounds { low: LEAST_DRAG, high: 10.0 }, 0.1));
        }
        if self.drift {
            ranges.push((Bounds { low: -1.0, high: 1.0 }, 0.05));
        }
        if self.contact.is_some() {
            ranges.extend(Lasting::ranges());
        }
        match self.law {
            Law::Constant => ranges.push((Bounds { low: 0.0, high: self.high }, 0.05)),
            Law::Linear => {
                ranges.push((Bounds { low: 0.0, high: self.high }, 0.05));
                ranges.push((Bounds { low: -1.0, high: 1.0 }, 0.05));
            }
            Law::Each => ranges.extend(vec![(Bounds { low: 0.0, high: self.high }, 0.05); self.impacts]),
        }
        ranges
    }

    fn size(&self, _block: usize) -> (usize, usize) {
        (self.samples.len() + self.contact.map_or(0, |_| lasting::BEFORE.len()), 0)
    }

    fn fill(&self, _block: usize, values: &[f64], _own: &[f64], rows: &mut DMatrix<f64>) {
        let air = self.air(values);
        let (impacts, apexes) = self.course(values);
        let n = values.len();
        let mut flight = 0;
        for (i, sample) in self.samples.iter().enumerate() {
            while flight < impacts.len() && sample.time >= impacts[flight].time.value {
                flight += 1;
            }
            let w = sample.weight;
            let below = flight.checked_sub(1).and_then(|last| impacts[last].depth(sample.time));
            let height = if let Some(depth) = below {
                for j in 0..n {
                    rows[(i, j)] = -w * depth.by[j];
                }
                rows[(i, FLOOR)] += w;
                values[FLOOR] - depth.value
            } else {
                let apex = &apexes[flight];
                let drop = air.drop(sample.time - apex.time.value);
                for j in 0..n {
                    rows[(i, j)] = w * (apex.height.by[j] + drop.by[0] * apex.time.by[j]);
                }
                rows[(i, GRAVITY)] -= w * drop.by[1];
                if self.drag {
                    rows[(i, DRAG)] -= w * drop.by[2];
                }
                apex.height.value - drop.value
            };
            let drift = self.drift_place().map_or(0.0, |j| {
                rows[(i, j)] += w * sample.time;
                values[j] * sample.time
            });
            rows[(i, n)] = w * (sample.height - height - drift);
        }
        if let Some((lasting, error)) = self.lasting().zip(self.contact) {
            lasting.fill(values, error, self.samples.len(), rows);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In flight and within contacts alike.
    #[test]
    fn derivatives_are_those_of_the_heights() {
        let samples: Vec<Sample> =
            (0..97).map(|i| Sample { time: 0.0513 * f64::from(i) - 1.0, height: 0.0, weight: 1.0 }).collect();
        let model = Trajectory {
            samples: &samples,
            impacts: 2,
            drag: true,
            held: 0.0,
            drift: true,
            contact: Some(0.01),
            law: Law::Linear,
            speed: 1.4,
            first: (0.0, 0.1),
            high: 1.5,
        };
        let at = vec![0.02, 1.4, 0.01, 1.1, 0.1, 0.02, 0.3, 0.15, 0.3, 0.8, -0.05];
        let rows = |values: &[f64]| {
            let mut rows = DMatrix::zeros(samples.len() + 2, values.len() + 1);
            model.fill(0, values, &[], &mut rows);
            rows
        };
        let exact = rows(&at);
        for j in 0..at.len() {
            let near = [-1e-6, 1e-6].map(|step| {
                let mut near = at.clone();
                near[j] += step;
                rows(&near).column(at.len()).clone_owned()
            });
            for i in 0..samples.len() + 2 {
                let numeric = (near[0][i] - near[1][i]) / 2e-6;
                assert!((numeric - exact[(i, j)]).abs() < 1e-5, "{i}, {j}: {numeric} {}", exact[(i, j)]);
            }
        }
        let lowest = samples.iter().enumerate().map(|(i, s)| -exact[(i, at.len())] - 0.02 * s.time).fold(1.0, f64::min);
        assert!(lowest < -0.05, "no sample within a contact: {lowest}");
    }
}
