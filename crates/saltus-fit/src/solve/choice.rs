//! Models of the same readings beside each other: what each gives, and what speaks for it.

use serde::{Deserialize, Serialize};

use crate::elementary::ln;
use crate::finding::{Gives, Missing};
use crate::model::Law;
use crate::quantity::{CorModel, Loss, Measured};
use crate::statistics::{chi_square_p, variance_ratio_p};

/// A model that was tried.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ModelChoice {
    /// Which one.
    pub name: CorModel,
    /// What it supposes, for people.
    pub about: String,
    /// Which rebound is missing, where the model is that one is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub missing: Option<Missing>,
    /// The COR it gives; if it has several, their mean; if it depends on speed, that at the middle
    /// of the speeds.
    pub cor: Measured,
    /// How the COR changes with speed, per m/s, where it does so along a straight line.
    pub slope: Option<Measured>,
    /// The p of e = C v^(−p), where that is unknown.
    pub exponent: Option<Measured>,
    /// The COR from the slowest impact to the fastest, where it depends on speed.
    pub speeds: Vec<SpeedCor>,
    /// The drag coefficient, per metre, where there is drag.
    pub drag: Option<Measured>,
    /// The height that the scale shows for a ball on the floor, in metres, where it is not zero.
    pub offset_m: Option<Measured>,
    /// The time that a contact takes, in seconds, where it takes any.
    pub contact_s: Option<Measured>,
    /// What is known of the offset or the drag where it came out at the end of its range: a limit,
    /// and no error.
    pub limit: Option<Limit>,
    /// The probability of a chi-square as large as it leaves by chance; none for a series, and
    /// where the errors are those of the scatter.
    pub p: Option<f64>,
    /// Its Bayesian information criterion less that of the chosen model.
    pub bic: f64,
    /// The same with Akaike's, corrected for few readings; none where there are too few.
    pub aicc: Option<f64>,
    /// The chi-square per reading that it leaves in trials it was not fitted to; none with fewer
    /// than two trials.
    pub left_out: Option<f64>,
    /// What it gives under other losses, where those were asked for, and the model itself was or
    /// its BIC is less than six above the least. One COR from heights alone or times alone is an
    /// [`Estimate`](crate::Estimate) then.
    pub losses: Vec<UnderLoss>,
    /// Whether the reported COR is its.
    pub chosen: bool,
    /// What it leaves; none for a series and for ratios.
    #[serde(skip)]
    pub(crate) misfit: Option<Misfit>,
}

/// What a model leaves of so many readings with so many unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Misfit {
    pub(crate) chi_square: f64,
    pub(crate) readings: f64,
    pub(crate) unknowns: f64,
    /// The errors of the readings are those of their scatter.
    pub(crate) scattered: bool,
    /// The chi-square of a reading that rounding alone leaves: a model that leaves less fits no
    /// better.
    pub(crate) least: f64,
}

impl Misfit {
    /// The BIC where the errors of the readings are taken from their scatter.
    pub(crate) fn by_scatter(self) -> f64 {
        self.readings * ln((self.chi_square / self.readings).max(self.least).max(1e-300))
            + self.unknowns * ln(self.readings)
    }

    /// The BIC where the errors are so many times those of the fit.
    pub(crate) fn by_errors(self, times: f64) -> f64 {
        self.chi_square / (times * times) + self.unknowns * ln(self.readings)
    }

    /// The probability that a model with more unknowns leaves so much less than `fewer` does by
    /// chance; none where it has no more.
    pub(crate) fn by_chance(self, fewer: Self) -> Option<f64> {
        let (gain, more) = (fewer.chi_square - self.chi_square, self.unknowns - fewer.unknowns);
        let free = self.readings - self.unknowns;
        let count = |x: f64| Some(x as usize).filter(|n| *n > 0);
        if self.scattered {
            variance_ratio_p(gain / more / (self.chi_square / free).max(self.least), count(more)?, count(free)?)
        } else {
            chi_square_p(gain, count(more)?)
        }
    }

    /// The scatter of the readings about the model, in the errors of the fit.
    pub(crate) fn scatter(self) -> f64 {
        (self.chi_square / (self.readings - self.unknowns).max(1.0)).sqrt()
    }
}

/// A model fitted under another loss: the same numbers as by least squares, without errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct UnderLoss {
    /// As [`Loss::name`](crate::Loss::name).
    pub loss: Loss,
    /// As [`ModelChoice::cor`].
    pub cor: f64,
    /// As [`ModelChoice::slope`].
    pub slope: Option<f64>,
    /// As [`ModelChoice::exponent`].
    pub exponent: Option<f64>,
    /// As [`ModelChoice::drag`].
    pub drag: Option<f64>,
    /// As [`ModelChoice::offset_m`].
    pub offset_m: Option<f64>,
}

/// The COR at one speed of impact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SpeedCor {
    /// The speed, in m/s.
    pub speed: f64,
    /// The COR there, without unit.
    pub cor: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// How far an unknown may be from the end of its range: 95 %, one-sided, where the chi-square has
/// grown by 2.71.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Limit {
    /// The end of its range that the unknown came out at: metres for an offset, 1/m for drag.
    pub bound: f64,
    /// The limit, in the same unit.
    pub limit: f64,
}

impl ModelChoice {
    pub(crate) fn new(name: CorModel, cor: Measured, bic: f64) -> Self {
        Self {
            name,
            about: String::new(),
            missing: None,
            cor,
            slope: None,
            exponent: None,
            speeds: Vec::new(),
            drag: None,
            offset_m: None,
            contact_s: None,
            limit: None,
            p: None,
            bic,
            aicc: None,
            left_out: None,
            losses: Vec::new(),
            chosen: false,
            misfit: None,
        }
    }

    /// What it gives: its COR, or those at the slowest and the fastest impact.
    pub(crate) fn gives(&self) -> Gives {
        match (self.speeds.first(), self.speeds.last()) {
            (Some(slow), Some(fast)) => Gives::Range([slow, fast].map(|at| [at.speed, at.cor])),
            _ => Gives::One(self.cor),
        }
    }
}

/// The name of a model of a recording: the law of its COR, and whether it has drag.
pub(crate) fn of_recording(law: Law, drag: bool) -> CorModel {
    match (law, drag) {
        (Law::Constant, false) => CorModel::Constant,
        (Law::Linear, false) => CorModel::Linear,
        (Law::Each, false) => CorModel::Each,
        (Law::Constant, true) => CorModel::ConstantDrag,
        (Law::Linear, true) => CorModel::LinearDrag,
        (Law::Each, true) => CorModel::EachDrag,
    }
}

#[cfg(test)]
mod tests {
    use super::Misfit;

    #[test]
    fn below_the_rounding_no_model_fits_better() {
        let one = Misfit { chi_square: 12.0, readings: 12.0, unknowns: 1.0, scattered: true, least: 1.0 };
        let more = Misfit { chi_square: 0.1, unknowns: 4.0, ..one };
        assert!(more.by_scatter() > one.by_scatter() && more.by_chance(one).is_some_and(|p| p > 0.01));
        let (one, more) = (Misfit { least: 0.0, ..one }, Misfit { least: 0.0, ..more });
        assert!(more.by_scatter() < one.by_scatter() && more.by_chance(one).is_some_and(|p| p < 1e-6));
    }
}
