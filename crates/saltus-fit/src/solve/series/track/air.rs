//! What the samples cannot show: the little drag of a heavy ball, and what a misfit may hide.

use super::{Candidates, Found};
use crate::model::{Dual, GRAVITY, Law, ORDINARY_DRAG, STANDARD_GRAVITY};
use crate::quantity::Measured;

/// The likelihood over drag is summed at so many values: the integrand is a parabola's exponential over at most a few of its widths.
const POINTS: u32 = 32;

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

    /// Drag in scaled units where gravity is one: k v²/g has no unit, so neither scale nor pixels matter.
    fn scaled(&self, per_metre: f64) -> f64 {
        per_metre * STANDARD_GRAVITY * self.scale.unit.powi(2)
    }

    /// By how much drag that the model leaves out shifts the COR: the drag of an ordinary ball, as far as the samples allow it.
    ///
    /// Any drag from none to [`ORDINARY_DRAG`] is as probable before. The samples weigh it: the loss is a parabola through three values of drag,
    /// and the COR a straight line. `None` where the model has drag of its own.
    pub(super) fn unseen_air(&self, chosen: &Found) -> Option<Measured> {
        if chosen.choice.1 || self.stated {
            return None;
        }
        let most = self.scaled(ORDINARY_DRAG) / chosen.fitted.shared[GRAVITY];
        let start = std::slice::from_ref(&chosen.fitted.shared);
        let with = |part: f64| {
            let held = Self { held: part * most, found: Vec::new(), ..self.clone() };
            let found = held.best(chosen.choice, start).ok().flatten()?;
            let loss = held.loss(&found, chosen.sigma) / self.dependence.powi(2);
            Some((held.cor(&found).value, loss))
        };
        let none = self.loss(chosen, chosen.sigma) / self.dependence.powi(2);
        let (half, full) = (with(0.5)?, with(1.0)?);
        let curve = 2.0 * (full.1 - 2.0 * half.1 + none);
        let slope = full.1 - none - curve;
        let shift = full.0 - chosen.cor.value;
        let weigh = |n: u32| {
            let part = (f64::from(n) + 0.5) / f64::from(POINTS);
            ((-0.5 * (curve * part * part + slope * part)), part)
        };
        let highest = (0..POINTS).map(|n| weigh(n).0).fold(f64::NEG_INFINITY, f64::max);
        let moment = |power: i32| {
            (0..POINTS).map(weigh).map(|(log, part)| (log - highest).exp() * part.powi(power)).sum::<f64>()
        };
        let mean = moment(1) / moment(0);
        let spread = (moment(2) / moment(0) - mean * mean).max(0.0).sqrt();
        let air = Measured { value: shift * mean, standard_error: (shift * spread).abs() };
        (air.value.is_finite() && air.standard_error.is_finite()).then_some(air)
    }

    /// What a pattern as large as what the motion leaves beyond the noise of the samples may do to the COR.
    ///
    /// A bend of size a over a flight of height H changes the speed at its end by the part a/H (a parabola of height H ± a), so the ratio of two
    /// speeds by both parts together, e √((a/H₀)² + (a/H₁)²). It is taken at the worst of the impacts' flights, divided by the root of their number.
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
