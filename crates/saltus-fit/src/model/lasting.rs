//! Contacts that take time.
//!
//! A ball that comes at v stays on the floor for T (v/v₁)^(−s). On a linear spring s = 0, for a
//! solid ball (Hertz) s = 1/5. Its weight presses it deeper the slower it comes, so that of a COR e
//! without weight e − κ (1 − e²) w/(1 + w) is left, where w is G times the time of the contact over
//! v: κ is about 0.1 for a spring with a damper, 0.4 where the force is less by a factor on the way
//! up. How a ball is made is not known, and a film hardly shows it: so s is 0.1 ± 0.1 and κ 0.15 ±
//! 0.2 before any reading, each as one row more.

use std::f64::consts::PI;

use nalgebra::DMatrix;

use super::dual::Dual;
use super::places::GRAVITY;
use super::problem::Bounds;
use crate::elementary::{exp, ln, powf, sin_cos};

/// The unknowns of contacts, side by side among all: T, s and κ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lasting {
    pub(super) place: usize,
    /// The speed v₁ at which a contact takes T.
    pub(super) speed: f64,
}

/// How many unknowns contacts have that take time,
pub(crate) const UNKNOWNS: usize = 3;
/// and what is taken for those after the first, with standard errors, before any reading.
pub(crate) const BEFORE: [(f64, f64); 2] = [(0.1, 0.1), (0.15, 0.2)];

/// The range of T, in units of time in which G is one and so is the range of heights.
pub(crate) const LASTING: Bounds = Bounds { low: 1e-4, high: 0.5 };

impl Lasting {
    pub(super) fn ranges() -> [(Bounds, f64); UNKNOWNS] {
        [(LASTING, 0.05), (Bounds { low: -0.5, high: 0.5 }, 0.1), (Bounds { low: -1.0, high: 1.0 }, 0.1)]
    }

    /// How long a contact takes.
    pub(super) fn time(self, values: &[f64], arrival: &Dual) -> Dual {
        let (time, s) = (values[self.place], values[self.place + 1]);
        let faster = ln((arrival.value / self.speed).max(1e-3));
        let growth = exp(-s * faster);
        let mut lasts = arrival.mapped(time * growth, -s * time * growth / arrival.value);
        lasts.by[self.place] += growth;
        lasts.by[self.place + 1] -= faster * time * growth;
        lasts
    }

    /// What the ball's weight leaves of a COR.
    pub(super) fn cor(self, values: &[f64], cor: &Dual, lasts: &Dual, arrival: &Dual) -> Dual {
        let unknown = |j: usize| Dual::unknown(values[j], values.len(), j);
        let (e, v) = (cor.value, arrival.value);
        let weight = unknown(GRAVITY).times(lasts).times(&arrival.mapped(1.0 / v, -1.0 / (v * v)));
        let w = weight.value;
        let weight = weight.mapped(w / (1.0 + w), (1.0 + w).powi(-2));
        let lost = unknown(self.place + 2).times(&cor.mapped(1.0 - e * e, -2.0 * e)).times(&weight);
        let left = cor.minus(&lost);
        if left.value > 1e-3 { left } else { left.mapped(1e-3, 0.0) }
    }

    /// One row for each unknown of which something is known before; samples, of weight one, have
    /// the standard error `error`.
    pub(super) fn fill(self, values: &[f64], error: f64, from: usize, rows: &mut DMatrix<f64>) {
        for (k, (usual, reach)) in BEFORE.into_iter().enumerate() {
            let j = self.place + 1 + k;
            rows[(from + k, j)] = error / reach;
            rows[(from + k, values.len())] = (usual - values[j]) * error / reach;
        }
    }
}

/// How far a ball is below the floor at a time within a contact that lasts `lasts`: at its part x
/// about (v T/π) eˣ sin πx, as on a spring with a damper.
pub(super) fn depth([began, lasts, arrival, cor]: [&Dual; 4], time: f64) -> Dual {
    let e = cor.value.max(1e-9);
    let x = (time - began.value) / lasts.value;
    let (sin, cos) = sin_cos(PI * x);
    let shape = powf(e, x) / PI;
    let scale = arrival.value * lasts.value;
    let by_x = scale * shape * (ln(e) * sin + PI * cos);
    let depth = scale * shape * sin;
    let by_cor = cor.mapped(0.0, depth * x / e);
    let by_speed = arrival.mapped(0.0, lasts.value * shape * sin);
    let by_time = began.mapped(0.0, -by_x / lasts.value);
    lasts.mapped(depth, (depth - x * by_x) / lasts.value).plus(&by_cor).plus(&by_speed).plus(&by_time)
}
