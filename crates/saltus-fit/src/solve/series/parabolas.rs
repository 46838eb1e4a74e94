//! Parabolas of one curvature through the flights, each by itself: the convex fit from which the
//! whole motion starts.
//!
//! Rows aₖ + bₖ (t − cₖ) − ½ G (t − cₖ)², with aₖ, bₖ the flight's own and G shared. Because G is
//! shared, neighbours meet where a straight line is zero, and that is the contact.

use nalgebra::DMatrix;

use super::flights::Flights;
use crate::model::{Bounds, Model};
use crate::solve::least_squares::Failure;
use crate::solve::successive::fit;

/// Samples this near to a contact, in numbers of samples, may be the contact itself.
const GUARD: usize = 1;

struct Parabolas {
    /// For each flight the middle of its time, and its samples.
    flights: Vec<(f64, Vec<(f64, f64)>)>,
}

impl Model for Parabolas {
    fn ranges(&self) -> Vec<(Bounds, f64)> {
        vec![(Bounds { low: -1e9, high: 1e9 }, 1e9)]
    }

    fn size(&self, block: usize) -> (usize, usize) {
        (self.flights[block].1.len(), 2)
    }

    fn fill(&self, block: usize, shared: &[f64], own: &[f64], rows: &mut DMatrix<f64>) {
        let (middle, samples) = &self.flights[block];
        for (i, &(time, height)) in samples.iter().enumerate() {
            let t = time - middle;
            (rows[(i, 0)], rows[(i, 1)], rows[(i, 2)]) = (1.0, t, -0.5 * t * t);
            rows[(i, 3)] = height - own[0] - own[1] * t + 0.5 * t * t * shared[0];
        }
    }
}

/// What the parabolas say of the motion.
#[derive(Clone, Debug)]
pub(super) struct Sketch {
    pub(super) gravity: f64,
    /// The time of each contact.
    pub(super) contacts: Vec<f64>,
    /// The height of the ball there.
    pub(super) floor: f64,
    /// The speed of arrival at the first contact.
    pub(super) speed: f64,
    /// The ratios of speeds at each contact.
    pub(super) cors: Vec<f64>,
}

/// Fits the parabolas.
pub(super) fn sketch(flights: &Flights) -> Result<Sketch, Failure> {
    let pieces = flights.starts.windows(2).enumerate().map(|(n, w)| {
        let (from, to) = (if n > 0 { w[0] + GUARD } else { w[0] }, w[1].saturating_sub(GUARD));
        // A short flight needs every sample.
        let (from, to) = if to >= from + 4 { (from, to) } else { (w[0], w[1]) };
        let samples: Vec<(f64, f64)> = (from..to).map(|i| (flights.times[i], flights.heights[i])).collect();
        let ends = (samples.first().map_or(0.0, |s| s.0), samples.last().map_or(0.0, |s| s.0));
        (0.5 * (ends.0 + ends.1), samples)
    });
    let model = Parabolas { flights: pieces.collect() };
    let start = model.flights.iter().map(|_| vec![0.0, 0.0]).collect();
    let fitted = fit(&model, &[1.0], start)?;
    let gravity = fitted.shared[0];
    if gravity.is_nan() || gravity <= 0.0 {
        return Err(Failure::NotIdentified);
    }
    let at = |n: usize, t: f64| {
        let (a, b, s) = (fitted.own[n][0], fitted.own[n][1], t - model.flights[n].0);
        (a + b * s - 0.5 * gravity * s * s, b - gravity * s)
    };
    let (mut contacts, mut heights, mut cors, mut speed) = (Vec::new(), Vec::new(), Vec::new(), 0.0);
    for n in 0..fitted.own.len() - 1 {
        // The difference of neighbours is linear: found from its values at the two middles.
        let (p, q) = (model.flights[n].0, model.flights[n + 1].0);
        let (d, f) = (at(n, p).0 - at(n + 1, p).0, at(n, q).0 - at(n + 1, q).0);
        let contact = p + (q - p) * d / (d - f);
        if !(p..=q).contains(&contact) {
            return Err(Failure::NotIdentified);
        }
        let (before, after) = (-at(n, contact).1, at(n + 1, contact).1);
        if before.is_nan() || before <= 0.0 {
            return Err(Failure::NotIdentified);
        }
        if n == 0 {
            speed = before;
        }
        contacts.push(contact);
        heights.push(at(n, contact).0);
        cors.push((after / before).clamp(0.01, 2.0));
    }
    let floor = heights.iter().sum::<f64>() / heights.len() as f64;
    Ok(Sketch { gravity, contacts, floor, speed, cors })
}
