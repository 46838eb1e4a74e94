//! Other explanations of the same readings, and whether trials may share one COR.

mod beside;
pub(crate) mod explain;
pub(crate) mod rivals;
pub(crate) mod settings;

use crate::error::FitError;
use crate::solve::estimate::Estimate;
use crate::solve::fits::Fits;

pub(crate) use beside::Wanted;
use explain::{Agreement, Hypothesis};
use rivals::Compared;

/// What heights and times are beside each other and beside other models.
pub(crate) struct Comparison {
    pub(crate) agreement: Option<Agreement>,
    pub(crate) hypotheses: Vec<Hypothesis>,
    pub(crate) compared: Compared,
    /// The estimates by other losses.
    pub(crate) losses: Vec<Estimate>,
}

/// Compares the kinds of reading with each other, and one COR with other models.
pub(crate) fn all(fits: &Fits<'_>, wanted: &Wanted) -> Result<Comparison, FitError> {
    let agreement = explain::agreement(fits);
    let hypotheses = explain::hypotheses(fits, agreement.as_ref())?;
    let cor = fits.cor().filter(|_| !agreement.as_ref().is_some_and(Agreement::rejected));
    let (compared, losses) = rayon::join(|| beside::models(fits, cor, wanted), || fits.losses(&wanted.losses));
    Ok(Comparison { agreement, hypotheses, compared: compared?, losses: losses? })
}
