//! The whole motion of a tracked ball: fall, impacts and flights as one curve through every sample.
//!
//! Between contacts the flight is known in closed form ([`Air`]), and so are the times of the contacts; their derivatives carry the
//! shift of every later flight, so nothing needs adding for the jumps.

use nalgebra::DMatrix;

use super::drag::{Air, Sloped};
use super::dual::Dual;
use crate::least_squares::Bounds;
use crate::successive::Model;

/// One sample of a series: when, how high, and the square root of its weight over its standard error.
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

/// Unknowns, all shared: time and speed of the first impact, floor, G, then k if there is drag, the speed of the floor if it drifts, then those of
/// the COR. Seen from a floor that drifts evenly the motion is the same.
#[derive(Clone, Debug)]
pub(crate) struct Trajectory<'a> {
    pub(crate) samples: &'a [Sample],
    pub(crate) impacts: usize,
    pub(crate) drag: bool,
    pub(crate) drift: bool,
    pub(crate) law: Law,
    /// The speed v₁ of the linear law.
    pub(crate) speed: f64,
    /// Where the first impact may be: the time of the start and how far from it.
    pub(crate) first: (f64, f64),
    /// The largest COR.
    pub(crate) high: f64,
}

pub(crate) const TIME: usize = 0;
pub(crate) const SPEED: usize = 1;
pub(crate) const FLOOR: usize = 2;
pub(crate) const GRAVITY: usize = 3;
const DRAG: usize = 4;

/// The least k times the range of heights: below it drag cannot be told from none.
pub(crate) const LEAST_DRAG: f64 = 1e-7;

/// An impact as the model has it: time, speed of arrival, COR, each with derivatives by all unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Impact {
    pub(crate) time: Dual,
    pub(crate) arrival: Dual,
    pub(crate) cor: Dual,
}

/// The apex of a flight: when, and how high.
struct Apex {
    time: Dual,
    height: Dual,
}

impl Trajectory<'_> {
    /// Where the unknowns of the COR begin.
    pub(crate) fn first_cor(&self) -> usize {
        DRAG + usize::from(self.drag) + usize::from(self.drift)
    }

    pub(crate) fn drift_place(&self) -> Option<usize> {
        self.drift.then_some(DRAG + usize::from(self.drag))
    }

    pub(crate) fn drag_place(&self) -> Option<usize> {
        self.drag.then_some(DRAG)
    }

    pub(crate) fn air(&self, values: &[f64]) -> Air {
        Air { gravity: values[GRAVITY], drag: if self.drag { values[DRAG] } else { 0.0 } }
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
            let departure = cor.times(&arrival);
            let hop = air.hop(departure.value);
            let rise = self.chain(&hop.rise, &departure);
            let fall = self.chain(&hop.fall, &departure);
            let top = time.plus(&rise);
            let next = top.plus(&fall);
            let next_arrival = self.chain(&hop.arrival, &departure);
            apexes.push(Apex { time: top, height: floor.plus(&self.chain(&hop.height, &departure)) });
            impacts.push(Impact { time, arrival, cor });
            (time, arrival) = (next, next_arrival);
        }
        (impacts, apexes)
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
        (self.samples.len(), 0)
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
            let apex = &apexes[flight];
            let drop = air.drop(sample.time - apex.time.value);
            let w = sample.weight;
            for j in 0..n {
                rows[(i, j)] = w * (apex.height.by[j] + drop.by[0] * apex.time.by[j]);
            }
            rows[(i, GRAVITY)] -= w * drop.by[1];
            if self.drag {
                rows[(i, DRAG)] -= w * drop.by[2];
            }
            let drift = self.drift_place().map_or(0.0, |j| {
                rows[(i, j)] += w * sample.time;
                values[j] * sample.time
            });
            rows[(i, n)] = w * (sample.height - apex.height.value + drop.value - drift);
        }
    }
}
