//! A verdict in the making: the COR so far, and the findings.

use serde::{Deserialize, Serialize};

use crate::finding::{Finding, FindingKind, Severity, Widening};
use crate::model::VAGUE;
use crate::solve::estimate::Estimate;
use crate::statistics::NORMAL;
use crate::word::words;

words! {
    /// Whether the COR may be believed.
    pub enum Verdict {
        /// The readings determine the COR, fit the model, and the methods agree.
        Trusted = "trusted",
        /// A number can be given, but something speaks against it; the reason and the warnings say
        /// what.
        Doubtful = "doubtful",
        /// The readings do not determine a COR.
        Refused = "refused",
    }
}

/// The COR with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Cor {
    /// The COR, without unit.
    pub value: f64,
    /// Its standard error by what the readings show; none where only a limit is known. What they
    /// cannot show is in the interval alone.
    pub standard_error: Option<f64>,
    /// The lower end of the 95 % interval.
    pub low: f64,
    /// The upper end of the 95 % interval.
    pub high: f64,
}

impl Cor {
    /// The COR of an estimate, where it has one with a range.
    pub(crate) fn of(estimate: &Estimate) -> Option<Self> {
        let (value, low, high) = (estimate.value?, estimate.low?, estimate.high?);
        Some(Self { value, standard_error: estimate.standard_error, low, high })
    }

    /// A COR that is known to lie in a range, and no better.
    pub(crate) fn within(value: f64, low: f64, high: f64) -> Self {
        Self { value, standard_error: Some((high - low) / (2.0 * NORMAL)), low, high }
    }

    /// Whether two CORs are surely of two balls: apart, intervals and all, and by more than one
    /// ball changes from drop to drop.
    pub(crate) fn is_apart(&self, other: &Self) -> bool {
        (self.value - other.value).abs() > LEVEL && (self.low > other.high || other.low > self.high)
    }
}

/// A share of less than this part of the interval is not named: without it the interval would be
/// shorter by half a per cent.
pub(crate) const NAMED: f64 = 0.1;

/// Two CORs that differ by less are the same for any purpose.
pub(crate) const SAME: f64 = 0.005;
/// A COR that changes by less, over all speeds, from impact to impact or from drop to drop, may be
/// called one.
pub(crate) const LEVEL: f64 = 0.02;

/// The COR and the findings, as the stages fill them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Judgement {
    pub(crate) cor: Option<Cor>,
    pub(crate) findings: Vec<Finding>,
    /// What the interval takes in beside the error of the COR, each thing once.
    pub(crate) widened: Vec<Widening>,
}

impl Judgement {
    pub(crate) fn note(&mut self, kind: FindingKind) {
        self.findings.push(Finding::note(kind));
    }

    pub(crate) fn doubt(&mut self, kind: FindingKind) {
        self.findings.push(Finding::doubt(kind));
    }

    pub(crate) fn refuse(&mut self, kind: FindingKind) {
        self.findings.push(Finding::refusal(kind));
    }

    /// The interval reaches out to `low` and `high`, for a reason; nothing is done where it holds
    /// both already.
    pub(crate) fn reach(&mut self, low: f64, high: f64, why: Widening) {
        let Some(cor) = &mut self.cor else { return };
        if low < cor.low || high > cor.high {
            (cor.low, cor.high) = (cor.low.min(low).max(0.0), cor.high.max(high));
            self.widen(why);
        }
    }

    /// Whether a rival answers so far outside the interval that reaching out to it would more than
    /// double it: then the interval was that of another question.
    pub(crate) fn outside(&self, rival: f64) -> bool {
        self.cor.is_some_and(|cor| {
            let twice = 2.0 * cor.low - cor.value..=2.0 * cor.high - cor.value;
            !twice.contains(&rival) && (rival - cor.value).abs() > SAME
        })
    }

    /// Doubts a COR whose interval says hardly anything.
    pub(crate) fn doubt_if_vague(&mut self) {
        if let Some(Cor { low, high, .. }) = self.cor.filter(|cor| cor.high - cor.low > VAGUE) {
            self.doubt(FindingKind::Vague { low, high });
        }
    }

    /// The interval takes in something more.
    pub(crate) fn widen(&mut self, why: Widening) {
        if !self.widened.contains(&why) {
            self.widened.push(why);
        }
    }

    fn gravest(&self) -> Severity {
        let any = |severity: Severity| self.findings.iter().any(|f| f.severity == severity);
        if any(Severity::Refusal) {
            Severity::Refusal
        } else if any(Severity::Doubt) {
            Severity::Doubt
        } else {
            Severity::Note
        }
    }

    pub(crate) fn verdict(&self) -> Verdict {
        match (self.gravest(), &self.cor) {
            (Severity::Refusal, _) | (_, None) => Verdict::Refused,
            (Severity::Doubt, _) => Verdict::Doubtful,
            (Severity::Note, _) => Verdict::Trusted,
        }
    }

    /// The place of the finding that the verdict rests on: the first of the gravest, or what a
    /// trusted COR rests on.
    pub(crate) fn leading(&self) -> Option<usize> {
        let gravest = self.gravest();
        let leads = |f: &Finding| match gravest {
            Severity::Note => matches!(f.kind, FindingKind::RestsOn { .. }),
            grave => f.severity == grave,
        };
        self.findings.iter().position(leads)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rival outside twice the interval is another answer if it is so by more than [`SAME`].
    #[test]
    fn a_rival_so_near_is_no_other_answer() {
        let cor = Cor { value: 0.8, standard_error: Some(5e-4), low: 0.799, high: 0.801 };
        let judgement = Judgement { cor: Some(cor), ..Judgement::default() };
        assert!(!judgement.outside(0.803) && judgement.outside(0.81) && !judgement.outside(0.801));
    }
}
