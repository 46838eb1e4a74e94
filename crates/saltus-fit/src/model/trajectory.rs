//! The whole motion of a tracked ball: fall, impacts and flights as one curve through every sample.
//!
//! Between contacts the flight is known in closed form ([`Air`]), and so are the times of the contacts; their derivatives carry the
//! shift of every later flight, so nothing needs adding for the jumps.
//!
//! A contact takes no time, or the time T of a linear spring with a damper, which is the same at every speed: half an oscillation, at the part
//! x of which a ball that came at v is below the floor by (v T/π) eˣ sin πx, and leaves at e v.

use std::f64::consts::PI;

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

/// Unknowns, all shared: time and speed of the first impact, floor, G, then k if there is drag, the speed of the floor if it drifts, the time of a
/// contact if it takes any, then those of the COR. Seen from a floor that drifts evenly the motion is the same.
#[derive(Clone, Debug)]
pub(crate) struct Trajectory<'a> {
    pub(crate) samples: &'a [Sample],
    pub(crate) impacts: usize,
    pub(crate) drag: bool,
    pub(crate) drift: bool,
    pub(crate) contact: bool,
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

/// The range of the time of a contact, in units of time in which G is one and so is the range of heights.
pub(crate) const LASTING: Bounds = Bounds { low: 1e-4, high: 0.5 };

/// An impact as the model has it: time of arrival, its speed, COR, each with derivatives by all unknowns.
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
        DRAG + usize::from(self.drag) + usize::from(self.drift) + usize::from(self.contact)
    }

    pub(crate) fn contact_place(&self) -> Option<usize> {
        self.contact.then(|| self.first_cor() - 1)
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
            let leaves = self.contact_place().map_or_else(|| time.clone(), |j| time.plus(&unknown(j)));
            let top = leaves.plus(&rise);
            let next = top.plus(&fall);
            let next_arrival = self.chain(&hop.arrival, &departure);
            apexes.push(Apex { time: top, height: floor.plus(&self.chain(&hop.height, &departure)) });
            impacts.push(Impact { time, arrival, cor });
            (time, arrival) = (next, next_arrival);
        }
        (impacts, apexes)
    }

    /// How far a ball is below the floor at a time within a contact that lasts `lasting`.
    fn pressed(lasting: &Dual, impact: &Impact, time: f64) -> Dual {
        let e = impact.cor.value.max(1e-9);
        let x = (time - impact.time.value) / lasting.value;
        let (sin, cos) = (PI * x).sin_cos();
        let shape = e.powf(x) / PI;
        let scale = impact.arrival.value * lasting.value;
        let by_x = scale * shape * (e.ln() * sin + PI * cos);
        let depth = scale * shape * sin;
        let by_cor = impact.cor.mapped(0.0, depth * x / e);
        let by_speed = impact.arrival.mapped(0.0, lasting.value * shape * sin);
        let by_time = impact.time.mapped(0.0, -by_x / lasting.value);
        let by_lasting = lasting.mapped(depth, (depth - x * by_x) / lasting.value);
        by_lasting.plus(&by_cor).plus(&by_speed).plus(&by_time)
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
        if self.contact {
            ranges.push((LASTING, 0.05));
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
        let lasting = self.contact_place().map(|j| Dual::unknown(values[j], n, j));
        let mut flight = 0;
        for (i, sample) in self.samples.iter().enumerate() {
            while flight < impacts.len() && sample.time >= impacts[flight].time.value {
                flight += 1;
            }
            let w = sample.weight;
            let touching = lasting.as_ref().zip(flight.checked_sub(1).map(|last| &impacts[last]));
            let touching = touching.filter(|(lasting, impact)| sample.time < impact.time.value + lasting.value);
            let height = if let Some((lasting, impact)) = touching {
                let depth = Self::pressed(lasting, impact, sample.time);
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
            drift: true,
            contact: true,
            law: Law::Linear,
            speed: 1.4,
            first: (0.0, 0.1),
            high: 1.5,
        };
        let at = vec![0.02, 1.4, 0.01, 1.1, 0.1, 0.02, 0.3, 0.8, -0.05];
        let rows = |values: &[f64]| {
            let mut rows = DMatrix::zeros(samples.len(), values.len() + 1);
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
            for i in 0..samples.len() {
                let numeric = (near[0][i] - near[1][i]) / 2e-6;
                assert!((numeric - exact[(i, j)]).abs() < 1e-5, "{i}, {j}: {numeric} {}", exact[(i, j)]);
            }
        }
        let lowest = samples.iter().enumerate().map(|(i, s)| -exact[(i, at.len())] - 0.02 * s.time).fold(1.0, f64::min);
        assert!(lowest < -0.05, "no sample within a contact: {lowest}");
    }
}
