//! Models of the same readings beside each other: what each gives, and what speaks for it.

use serde::Serialize;

use crate::bounces::Measured;
use crate::model::Law;

/// What the COR is supposed to depend on, and what else there is beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CorModel {
    /// One COR.
    Constant,
    /// e = e₀ − k v.
    Linear,
    /// A viscoelastic sphere: e = 1 − γ v^(1/5) + (3/5) γ² v^(2/5) ∓ …, as the Padé approximant of Müller and Pöschel (2011).
    Viscoelastic,
    /// A plastic impact: e = C v^(−1/4).
    Plastic,
    /// e = C v^(−p).
    Power,
    /// Straight lines between three or four speeds, never rising.
    Knots,
    /// A COR for every bounce.
    Each,
    /// A height scale that reads too high, by a ball at most.
    Offset,
    /// Rebounds that are read higher on the ball than the release, by a ball at most.
    Rebounds,
    /// Air drag, quadratic in speed.
    Drag,
    /// Contacts that take time, always the same.
    Contact,
}

impl CorModel {
    /// Every model.
    pub const ALL: [Self; 11] = [
        Self::Constant,
        Self::Linear,
        Self::Viscoelastic,
        Self::Plastic,
        Self::Power,
        Self::Knots,
        Self::Each,
        Self::Offset,
        Self::Rebounds,
        Self::Drag,
        Self::Contact,
    ];

    /// Its word in [`ModelChoice::name`].
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Linear => "linear",
            Self::Viscoelastic => "viscoelastic",
            Self::Plastic => "plastic",
            Self::Power => "power",
            Self::Knots => "knots",
            Self::Each => "each",
            Self::Offset => "offset",
            Self::Rebounds => "rebounds",
            Self::Drag => "drag",
            Self::Contact => "contact",
        }
    }
}

/// A model that was tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ModelChoice {
    /// A fixed word: `constant`, `linear`, `viscoelastic`, `plastic`, `power`, `knots`, `each`, `offset`, `rebounds`, `drag`, `contact`,
    /// and `missed`, one rebound that is not in the table; for a series `constant`, `linear`, `each`, and these with `-drag`.
    pub name: String,
    /// What it supposes, for people.
    pub about: String,
    /// The COR it gives; if it has several, their mean; if it depends on speed, that at the middle of the speeds.
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
    /// What is known of the offset or the drag where it came out at the end of its range: a limit, and no error.
    pub limit: Option<Limit>,
    /// The probability of a chi-square as large as it leaves by chance; none for a series, and where the errors are those of the scatter.
    pub p: Option<f64>,
    /// Its Bayesian information criterion less that of the chosen model.
    pub bic: f64,
    /// The same with Akaike's, corrected for few readings; none where there are too few.
    pub aicc: Option<f64>,
    /// The chi-square per reading that it leaves in trials it was not fitted to; none with fewer than two trials.
    pub left_out: Option<f64>,
    /// What it gives under other losses, where those were asked for, and the model itself was or its BIC is less than six above the least. One COR from
    /// heights alone or times alone is an [`Estimate`](crate::Estimate) then.
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
}

impl Misfit {
    /// The BIC where the errors of the readings are taken from their scatter.
    pub(crate) fn by_scatter(self) -> f64 {
        self.readings * (self.chi_square / self.readings).max(1e-300).ln() + self.unknowns * self.readings.ln()
    }

    /// The BIC where the errors are so many times those of the fit.
    pub(crate) fn by_errors(self, times: f64) -> f64 {
        self.chi_square / (times * times) + self.unknowns * self.readings.ln()
    }

    /// The scatter of the readings about the model, in the errors of the fit.
    pub(crate) fn scatter(self) -> f64 {
        (self.chi_square / (self.readings - self.unknowns).max(1.0)).sqrt()
    }
}

/// A model fitted under another loss: the same numbers as by least squares, without errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct UnderLoss {
    /// As [`Loss::name`](crate::Loss::name).
    pub loss: String,
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SpeedCor {
    /// The speed, in m/s.
    pub speed: f64,
    /// The COR there, without unit.
    pub cor: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// How far an unknown may be from the end of its range: 95 %, one-sided, where the chi-square has grown by 2.71.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Limit {
    /// The end of its range that the unknown came out at: metres for an offset, 1/m for drag.
    pub bound: f64,
    /// The limit, in the same unit.
    pub limit: f64,
}

impl ModelChoice {
    pub(crate) fn new(name: &str, about: &str, cor: Measured, bic: f64) -> Self {
        Self {
            name: name.to_owned(),
            about: about.to_owned(),
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

    pub(crate) fn of_series((law, drag): (Law, bool), cor: Measured, bic: f64, chosen: bool) -> Self {
        let (word, about) = match law {
            Law::Constant => ("constant", "one COR"),
            Law::Linear => ("linear", "a COR linear in the speed of impact"),
            Law::Each => ("each", "a COR for every impact"),
        };
        let (suffix, air) = if drag { ("-drag", ", air drag") } else { ("", "") };
        Self { chosen, ..Self::new(&format!("{word}{suffix}"), &format!("{about}{air}"), cor, bic) }
    }
}
