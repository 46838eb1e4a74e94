//! Models of one recording weighed against each other, and the errors that they leave to the COR.

use super::{CHOICES, Candidates, Choice, Found};
use crate::elementary::ln;
use crate::model::{BEFORE, Dual, Law, Sample};
use crate::quantity::Measured;
use crate::solve::robust::HUBER;
use crate::statistics::CLEAR;

/// More than so many times the noise from sample to sample is left for something else to explain,
/// such as a drift of the camera.
const UNEXPLAINED: f64 = 1.2;
/// A floor that moves by less than this part of the range, from the first sample to the last,
/// stands still.
const MOVED: f64 = 0.01;

impl Candidates {
    /// The least robust standard deviation that any model leaves.
    fn least(&self) -> f64 {
        self.found.iter().map(|f| f.sigma).fold(f64::INFINITY, f64::min)
    }

    pub(super) fn leaves_more_than_noise(&self) -> bool {
        self.least() > UNEXPLAINED * self.noise
    }

    /// By how much the BIC of `other` is worse, both on the samples that are left to this one; a
    /// drift has to be clearly better.
    pub(super) fn gain(&self, other: &Self) -> f64 {
        let mut other = other.clone();
        if !self.samples.iter().map(|s| s.time).eq(other.samples.iter().map(|s| s.time)) {
            other.samples = self.samples.iter().map(|s| Sample { weight: 1.0, ..*s }).collect();
            if other.fit_all().is_err() {
                return 0.0;
            }
        }
        let sigma = self.least().min(other.least());
        let count = self.samples.len() as f64;
        let n = (count / self.dependence.powi(2)).max(2.0);
        let bic = |of: &Self| {
            let one = |f: &Found| of.bic(f, n, of.loss(f, sigma) / count);
            of.found.iter().map(one).fold(f64::INFINITY, f64::min) + if of.drift { CLEAR } else { 0.0 }
        };
        bic(&other) - bic(self)
    }

    /// By BIC, with the one unknown more that drift is; neighbouring residuals are alike.
    pub(super) fn is_clearly_better_than(&self, other: &Self) -> bool {
        let n = other.samples.len() as f64 / other.dependence.powi(2);
        let gain = 2.0 * n * ln(other.least() / self.least()) - ln(n);
        let span = self.samples.last().map_or(0.0, |s| s.time) - self.samples.first().map_or(0.0, |s| s.time);
        let moves = |f: &Found| {
            let place = self.model(&self.samples, f.choice).drift_place();
            place.is_some_and(|j| (f.fitted.shared[j] * span).abs() > MOVED)
        };
        gain > CLEAR && self.found.iter().all(moves) && 10 * self.samples.len() > 9 * other.samples.len()
    }

    /// BIC and the error of the COR for each model; residuals of neighbours are alike, which counts
    /// as fewer samples.
    pub(super) fn weigh(&mut self) {
        let sigma = self.least();
        let losses: Vec<f64> = self.found.iter().map(|f| self.loss(f, sigma)).collect();
        let best = (0..losses.len()).min_by(|&a, &b| losses[a].total_cmp(&losses[b])).unwrap_or(0);
        let left = self.left(&self.found[best].fitted.shared, self.found[best].choice);
        let clip: Vec<f64> = left.iter().map(|r| r.clamp(-3.0 * sigma, 3.0 * sigma)).collect();
        let own: f64 = clip.iter().map(|r| r * r).sum();
        let with_next: f64 = clip.windows(2).map(|w| w[0] * w[1]).sum();
        let alike = if own > 0.0 { (with_next / own).clamp(0.0, 0.95) } else { 0.0 };
        self.dependence = ((1.0 + alike) / (1.0 - alike)).sqrt();
        let n = (left.len() as f64 / self.dependence.powi(2)).max(2.0);
        for (i, loss) in losses.into_iter().enumerate() {
            self.found[i].bic = self.bic(&self.found[i], n, loss / left.len() as f64);
            self.found[i].cor = self.cor(&self.found[i]);
        }
    }

    /// Huber's loss of all that a model leaves, in standard deviations.
    pub(super) fn loss(&self, found: &Found, sigma: f64) -> f64 {
        self.left(&found.fitted.shared, found.choice).iter().map(|r| huber_loss(r / sigma)).sum()
    }

    /// The BIC of a model whose mean loss is this, from so many independent samples.
    fn bic(&self, found: &Found, samples: f64, loss: f64) -> f64 {
        samples * ln(loss.max(1e-18)) + self.unknowns(found) as f64 * ln(samples)
    }

    /// How many unknowns a model has, but for those of which something is known before.
    pub(super) fn unknowns(&self, found: &Found) -> usize {
        found.fitted.shared.len() - if self.contact { BEFORE.len() } else { 0 }
    }

    /// The COR of a model: the mean over its impacts, each weighing by its own error.
    pub(super) fn cor(&self, found: &Found) -> Measured {
        let impacts = self.model(&self.samples, found.choice).impacts(&found.fitted.shared);
        let weights: Vec<f64> =
            impacts.iter().map(|i| self.measured(found, &i.cor).standard_error.max(1e-9).powi(-2)).collect();
        let total: f64 = weights.iter().sum();
        let mut mean = Dual::constant(0.0, found.fitted.shared.len());
        for (impact, weight) in impacts.iter().zip(&weights) {
            let part = weight / total;
            mean = mean.plus(&impact.cor.mapped(part * impact.cor.value, part));
        }
        self.measured(found, &mean)
    }

    /// A quantity of the model with its standard error.
    pub(super) fn measured(&self, found: &Found, x: &Dual) -> Measured {
        let free = self.samples.len().saturating_sub(self.unknowns(found)).max(1) as f64;
        let scatter = (found.fitted.chi_square / free).max(0.0).sqrt().max(found.sigma);
        Measured { value: x.value, standard_error: found.fitted.error_of(&x.by) * scatter * self.dependence }
    }
}

/// The model with the least BIC over all recordings together; of films of one bounce each one whose
/// drag is no unknown, since a loss in the air and one at the floor look alike there.
pub(crate) fn choose(candidates: &[&Candidates]) -> Choice {
    let total = |choice: &Choice| {
        let one = |c: &&Candidates| {
            let bic = |choice: Choice| c.found.iter().find(|f| f.choice == choice).map(|f| f.bic);
            // A single impact has one law only; drag that is not there is none.
            bic(*choice).or(bic((Law::Constant, choice.1))).or(bic((choice.0, false))).or(bic((Law::Constant, false)))
        };
        candidates.iter().filter_map(one).sum::<f64>()
    };
    let single = candidates.iter().all(|c| c.impacts() == 1);
    let least = CHOICES.iter().filter(|choice| !(single && choice.1)).min_by(|a, b| total(a).total_cmp(&total(b)));
    least.copied().unwrap_or((Law::Constant, false))
}

fn huber_loss(z: f64) -> f64 {
    if z.abs() <= HUBER { z * z } else { 2.0 * HUBER * z.abs() - HUBER * HUBER }
}
