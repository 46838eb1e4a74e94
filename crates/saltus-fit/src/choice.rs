//! Models of the same readings beside each other: what each gives, and what speaks for it.

use serde::Serialize;

use crate::bounces::Measured;
use crate::model::Law;

/// A model that was tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ModelChoice {
    /// A fixed word: `constant`, `linear`, `each`, `offset`, `drag`; for a series `constant`, `linear`, `each`, and these with `-drag`.
    pub name: String,
    /// What it supposes, for people.
    pub about: String,
    /// The COR it gives; if it has several, their mean; if it depends on speed, that at the middle of the speeds.
    pub cor: Measured,
    /// How the COR changes with speed, per m/s, where it does.
    pub slope: Option<Measured>,
    /// The drag coefficient, per metre, where there is drag.
    pub drag: Option<Measured>,
    /// The height that the scale shows for a ball on the floor, in metres, where it is not zero.
    pub offset_m: Option<Measured>,
    /// Its Bayesian information criterion less that of the chosen model.
    pub bic: f64,
    /// The same with Akaike's, corrected for few readings; none where there are too few.
    pub aicc: Option<f64>,
    /// The chi-square per reading that it leaves in trials it was not fitted to; none with fewer than two trials.
    pub left_out: Option<f64>,
    /// Whether the reported COR is its.
    pub chosen: bool,
}

impl ModelChoice {
    pub(crate) fn new(name: &str, about: &str, cor: Measured, bic: f64) -> Self {
        Self {
            name: name.to_owned(),
            about: about.to_owned(),
            cor,
            slope: None,
            drag: None,
            offset_m: None,
            bic,
            aicc: None,
            left_out: None,
            chosen: false,
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
