//! The verdict: what the fits amount to, and what speaks against them.

mod judgement;
mod series;
mod single;
mod unseen;
mod weigh;
mod whole;

use crate::compare::Comparison;
use crate::compare::explain::Agreement;
use crate::finding::{Finding, FindingKind};
use crate::quantity::{CorModel, Readings};
use crate::solve::choice::ModelChoice;
use crate::solve::estimate::Estimate;
use crate::solve::fits::{Fits, Known};
use crate::solve::series::Series;
use crate::statistics::median;

pub(crate) use judgement::Judgement;
pub use judgement::{Cor, Verdict};
pub(crate) use unseen::{Stated, air_shows, in_a_vacuum};

/// The remarks on the table as it was read, and what was done to put its readings in order.
fn begun(fits: &Fits<'_>) -> Judgement {
    let table = fits.table;
    let notes = table.notes.iter().map(|note| FindingKind::ReadNote { note: note.clone() });
    let repairs = table.repairs.iter().map(|repair| FindingKind::ReadRepair { repair: repair.clone() });
    let warnings = table.warnings.iter().map(|warning| FindingKind::ReadWarning { warning: warning.clone() });
    let doubts = table.doubts.iter().cloned().map(|doubt| Finding::doubt(FindingKind::ReadDoubt { doubt }));
    let findings = notes.chain(repairs).chain(warnings).map(Finding::note).chain(doubts);
    Judgement { findings: findings.chain(fits.evidence.repairs.iter().cloned()).collect(), ..Judgement::default() }
}

/// Judges heights and times, and the models beside one COR; `wanted` is the model that was asked
/// for.
pub(crate) fn of_readings(
    fits: &Fits<'_>,
    comparison: &mut Comparison,
    wanted: Option<CorModel>,
    (known, stated): (&Known, Stated),
) -> Judgement {
    let mut judgement = begun(fits);
    let agreement = comparison.agreement.as_ref();
    if let (Some(joint), true) = (&fits.joint, agreement.is_some_and(Agreement::rejected))
        && joint.thinned() > 1
    {
        judgement.note(FindingKind::ExplanationsThinned { every: joint.thinned() });
    }
    whole::judge(&mut judgement, fits, agreement);
    if !agreement.is_some_and(Agreement::rejected) {
        unseen::allow(&mut judgement, fits, (known, stated));
        unseen::read_otherwise(&mut judgement, fits, known);
        judgement.doubt_if_vague();
    }
    stated_differs(&mut judgement, fits);
    unseen::drag_held(&mut judgement, stated.drag.unwrap_or(0.0));
    let compared = &mut comparison.compared;
    judgement.findings.append(&mut compared.notes);
    let doubted = weigh::models(&mut judgement, &compared.models);
    if let Some(kind) = compared.kind {
        let sigma = match kind {
            Readings::Heights => fits.sigma_height,
            Readings::Times => fits.sigma_time,
        };
        weigh::error_decides(&mut judgement, &compared.models, (kind, sigma), doubted);
    }
    let air = if wanted.is_none() && stated.drag.is_none() { weigh::air(fits, &compared.models) } else { None };
    if let Some(model) = wanted.or(air.map(|_| CorModel::Drag)) {
        weigh::rest_on(&mut judgement, model, compared);
    }
    if let Some(drag) = air {
        judgement.note(FindingKind::AirShows { drag });
    }
    judgement
}

/// A COR that the writer of a table worked out differs by so much only if it is of other numbers.
const WORKED_OUT: f64 = 0.03;

/// Doubts a COR that is neither that which the table itself works out from the same rows, nor its
/// root, for who forgot it.
fn stated_differs(judgement: &mut Judgement, fits: &Fits<'_>) {
    let mut all: Vec<f64> = fits.table.trials().iter().flat_map(|trial| trial.stated.iter().copied()).collect();
    let Some((cor, stated)) = judgement.cor.zip(median(&mut all)) else { return };
    let near = |e: f64| (e - cor.value).abs() <= WORKED_OUT || (cor.low..=cor.high).contains(&e);
    if !near(stated) && !near(stated.sqrt()) {
        judgement.doubt(FindingKind::StatedDiffers { stated, cor: cor.value });
    }
}

/// Judges the fit of all recordings; with it come the estimates and the models of the report.
pub(crate) fn of_recordings(fits: &Fits<'_>, series: &Series) -> (Judgement, Vec<Estimate>, Vec<ModelChoice>) {
    let mut judgement = begun(fits);
    let pixels = fits.table.metadata.pixels;
    let (estimates, models) = series::judge(&mut judgement, series, (fits.gravity, pixels));
    (judgement, estimates, models)
}
