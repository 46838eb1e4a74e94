//! What the samples cannot show: the little drag of a heavy ball, the bend of a lens, and what a
//! misfit may hide.

use super::{Candidates, Found};
use crate::elementary::exp;
use crate::model::{BEND, Dual, GRAVITY, LIGHT_DRAG, Law, ORDINARY_DRAG, Sample};
use crate::quantity::{Measured, STANDARD_GRAVITY};
use crate::solve::series::recording::Unseen;
use crate::statistics::NORMAL;

/// The likelihood over drag and bend is summed at so many values of each: the integrand is a
/// parabola's exponential over a few of its widths.
const POINTS: u32 = 32;
/// The sum goes out to so many standard deviations.
const BENDS: f64 = 3.0;

/// The middle of one of the parts that the sum goes over.
fn middle(n: u32) -> f64 {
    (f64::from(n) + 0.5) / f64::from(POINTS)
}

/// A height as it is without a bend that moves the ends of the path by `bend` of half of it; the
/// path goes from 0 to 1.
fn straight(height: f64, bend: f64) -> f64 {
    height - 0.5 * bend * (2.0 * height - 1.0).powi(3)
}

/// The most of something that is allowed where the loss over it is a x² + b x: until it is the
/// square of [`NORMAL`] above its least from nothing on.
fn most_allowed(a: f64, b: f64) -> f64 {
    let best = (-0.5 * b / a).max(0.0);
    let limit = (a * best + b) * best + NORMAL * NORMAL;
    let most = 0.5 * ((b * b + 4.0 * a * limit).sqrt() - b) / a;
    if a > 0.0 { most } else { f64::INFINITY }
}

impl Candidates {
    /// Holds drag at what is stated, 1/m.
    pub(super) fn hold(&mut self, drag: Option<f64>) {
        (self.held, self.stated) = (drag.map_or(0.0, |drag| self.scaled(drag)), drag.is_some());
    }

    /// The drag of one COR with drag, in 1/m.
    pub(super) fn free_drag(&self) -> Option<Measured> {
        let found = self.found.iter().find(|found| found.choice == (Law::Constant, true))?;
        let values = &found.fitted.shared;
        let place = self.model(&self.samples, found.choice).drag_place()?;
        let drag = self.measured(found, &Dual::unknown(values[place], values.len(), place));
        let per_metre = values[GRAVITY] / self.scaled(1.0);
        Some(Measured { value: drag.value * per_metre, standard_error: drag.standard_error * per_metre })
    }

    /// Drag in scaled units where gravity is one: k v²/g has no unit, so neither scale nor pixels
    /// matter.
    fn scaled(&self, per_metre: f64) -> f64 {
        per_metre * STANDARD_GRAVITY * self.scale.unit.powi(2)
    }

    /// By how much the air and the lens may shift the COR, as far as the samples allow it; what is
    /// stated or fitted is left out.
    ///
    /// Any drag from none to [`ORDINARY_DRAG`] is as probable before, and a bend of [`BEND`] at the
    /// ends of the path as one standard deviation. The samples weigh them together: the loss is a
    /// parabola in both, and the COR a plane, through the fits with each held in turn. `None` where
    /// those are not determined.
    pub(super) fn unseen(&self, chosen: &Found) -> Option<Unseen> {
        let free = chosen.choice.1 || self.stated;
        let most = if free { 0.0 } else { self.scaled(ORDINARY_DRAG) / chosen.fitted.shared[GRAVITY] };
        let loss = |of: &Self, found: &Found| of.loss(found, chosen.sigma) / self.dependence.powi(2);
        let none = loss(self, chosen);
        // The loss and the COR with a part of the most drag, and so many bends, beside what they
        // are without.
        let with = |part: f64, bends: f64| {
            let held = if free { self.held } else { part * most };
            let samples = self.samples.iter().map(|s| Sample { height: straight(s.height, bends * BEND), ..*s });
            let held = Self { held, samples: samples.collect(), found: Vec::new(), ..self.clone() };
            let found = held.least_of(chosen.choice, std::slice::from_ref(&chosen.fitted.shared)).ok().flatten()?;
            Some((held.cor(&found).value - chosen.cor.value, loss(&held, &found) - none))
        };
        let (out, back) = (with(0.0, 1.0)?, with(0.0, -1.0)?);
        let (half, full, both) =
            if free { ((0.0, 0.0), (0.0, 0.0), out) } else { (with(0.5, 0.0)?, with(1.0, 0.0)?, with(1.0, 1.0)?) };
        let (curve, bent) = (2.0 * (full.1 - 2.0 * half.1), 0.5 * (out.1 + back.1));
        let (slope, tilt) = (full.1 - curve, 0.5 * (out.1 - back.1));
        let cross = both.1 - full.1 - out.1;
        let shifts = (full.0, 0.5 * (out.0 - back.0));
        let light = if free || self.impacts() > 1 {
            None
        } else {
            // What the lens may hide is the least of the loss over the bend.
            let hidden = 0.25 / (1.0 + bent);
            let part = most_allowed(curve - hidden * cross * cross, slope - 2.0 * hidden * tilt * cross)
                .clamp(1.0, LIGHT_DRAG / ORDINARY_DRAG);
            Some((part * ORDINARY_DRAG, with(part, 0.0)?.0))
        };
        let points = (0..POINTS).flat_map(|n| (0..POINTS).map(move |m| (middle(n), BENDS * (2.0 * middle(m) - 1.0))));
        let weighed: Vec<(f64, f64, f64)> = points
            .map(|(k, b)| {
                let loss = k * (curve * k + slope) + b * (bent * b + tilt) + cross * k * b;
                (-0.5 * (loss + b * b), k * shifts.0, b * shifts.1)
            })
            .collect();
        let highest = weighed.iter().map(|w| w.0).fold(f64::NEG_INFINITY, f64::max);
        let moments = |of: fn(f64, f64) -> f64| {
            let sums = weighed.iter().fold([0.0; 3], |sums, &(log, air, lens)| {
                let (weight, x) = (exp(log - highest), of(air, lens));
                [sums[0] + weight, sums[1] + weight * x, sums[2] + weight * x * x]
            });
            let mean = sums[1] / sums[0];
            Measured { value: mean, standard_error: (sums[2] / sums[0] - mean * mean).max(0.0).sqrt() }
        };
        let unseen = Unseen {
            shift: moments(|air, lens| air + lens),
            air: moments(|air, _| air),
            lens: moments(|_, lens| lens),
            light,
        };
        (unseen.shift.value.is_finite() && unseen.shift.standard_error.is_finite()).then_some(unseen)
    }

    /// What a pattern as large as what the motion leaves beyond the noise of the samples may do to
    /// the COR.
    ///
    /// A bend of size a over a flight of height H changes the speed at its end by the part a/H (a
    /// parabola of height H ± a), so the ratio of two speeds by both parts together, e √((a/H₀)² +
    /// (a/H₁)²). It is taken at the worst of the impacts' flights, divided by the root of their
    /// number.
    pub(super) fn misfit(&self, chosen: &Found, left: &[f64]) -> f64 {
        let rms = (left.iter().map(|r| r * r).sum::<f64>() / left.len() as f64).sqrt();
        let bend = (rms * rms - self.noise * self.noise).max(0.0).sqrt();
        let values = &chosen.fitted.shared;
        let apexes = self.model(&self.samples, chosen.choice).apexes(values);
        let floor = values[crate::model::FLOOR];
        let parts = apexes.windows(2).map(|w| {
            let part = |apex: (f64, f64)| bend / (apex.1 - floor).abs().max(bend);
            part(w[0]).powi(2) + part(w[1]).powi(2)
        });
        let impacts = apexes.len().saturating_sub(1).max(1) as f64;
        chosen.cor.value * (parts.sum::<f64>()).sqrt() / impacts
    }
}
