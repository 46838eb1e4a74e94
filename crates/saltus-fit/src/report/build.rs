//! A report is built once, from what the stages hand on; here findings become its lists of
//! sentences.

use super::contract::Report;
use super::motion::{Motion, beside, of_fits};
use super::residual::{Point, Residual};
use super::scene::as_read;
use super::words::{self, Section};
use crate::compare::Comparison;
use crate::evidence::has;
use crate::finding::{Finding, FindingKind, Severity};
use crate::quantity::{Readings, Sourced};
use crate::solve::bootstrap::Bootstrap;
use crate::solve::choice::ModelChoice;
use crate::solve::estimate::Estimate;
use crate::solve::fits::Fits;
use crate::solve::profile::Profile;
use crate::solve::series::Series;
use crate::solve::tolerance::Allowed;
use crate::verdict::{Judgement, Verdict};

/// The number of the JSON contract: it grows when a field changes its meaning or goes, not when one
/// is added.
const SCHEMA: u32 = 1;
/// More lines of repairs than this are counted, not listed.
const LISTED: usize = 20;
/// The motions of more trials than this are no picture.
const DRAWN: usize = 24;

/// What is computed where it was asked for.
#[derive(Default)]
pub(crate) struct Extras {
    pub(crate) allowed: Vec<Allowed>,
    pub(crate) profiles: Vec<Profile>,
    pub(crate) bootstrap: Option<Bootstrap>,
}

/// The fitted motions, and the readings beside them.
type Drawing = (Vec<Motion>, Vec<Point>, Vec<Residual>);

impl Report {
    /// The report of heights and times.
    pub(crate) fn build(
        fits: &Fits<'_>,
        comparison: Comparison,
        extras: Extras,
        judgement: Judgement,
        ball_m: Option<f64>,
    ) -> Self {
        let (motions, release_is_fitted) = of_fits(fits);
        let (points, residuals) = beside(&motions, fits, release_is_fitted);
        let mut estimates = fits.estimates();
        estimates.extend(comparison.losses);
        let mut models = comparison.compared.models;
        models.iter_mut().for_each(|m| m.about = words::about(m.name, m.missing));
        let mut hypotheses = comparison.hypotheses;
        for hypothesis in &mut hypotheses {
            hypothesis.about = words::supposes(hypothesis, comparison.agreement.is_some());
            hypothesis.settle = words::settles(hypothesis.name).to_owned();
        }
        let reports = |readings| has(fits.table, readings);
        Self {
            sigma_height: reports(Readings::Heights).then_some(fits.sigma_height),
            sigma_time: reports(Readings::Times).then_some(fits.sigma_time),
            estimates: described(estimates),
            bounces: fits.bounces.clone(),
            agreement: comparison.agreement,
            hypotheses,
            models,
            allowed: extras.allowed,
            profiles: extras.profiles,
            bootstrap: extras.bootstrap,
            ball_m,
            ..Self::of(fits, judgement, (motions, points, residuals))
        }
    }

    /// The report of recordings.
    pub(crate) fn build_of_recordings(
        fits: &Fits<'_>,
        series: Series,
        estimates: Vec<Estimate>,
        mut models: Vec<ModelChoice>,
        judgement: Judgement,
    ) -> Self {
        let drawing = series.picture();
        models.iter_mut().for_each(|m| m.about = words::about(m.name, None));
        Self { estimates: described(estimates), models, series: series.tracks, ..Self::of(fits, judgement, drawing) }
    }

    /// The part that all reports have alike.
    fn of(fits: &Fits<'_>, mut judgement: Judgement, (mut motions, points, residuals): Drawing) -> Self {
        let (table, verdict) = (fits.table, judgement.verdict());
        let reason = judgement.leading().map(|place| judgement.findings.remove(place));
        let mut findings = judgement.findings;
        if verdict != Verdict::Trusted {
            findings.retain(|f| !matches!(f.kind, FindingKind::RestsOn { .. }));
        }
        // Doubts before notes, each in the order in which they were found.
        findings.sort_by_key(|f| f.severity == Severity::Note);
        let listed = |section: Section| {
            let of = |f: &&Finding| words::section(&f.kind) == section;
            findings.iter().filter(of).map(Finding::to_string).collect::<Vec<String>>()
        };
        let (warnings, repairs, notes) = (listed(Section::Warnings), listed(Section::Repairs), listed(Section::Notes));
        motions.truncate(DRAWN);
        Self {
            verdict,
            reason: reason.as_ref().map_or_else(String::new, Finding::to_string),
            cor: judgement.cor.filter(|_| verdict != Verdict::Refused),
            trials: table.trials().len(),
            frame_rate: table.metadata.frame_rate,
            findings: reason.into_iter().chain(findings).collect(),
            widened: judgement.widened,
            warnings,
            repairs: shortened(repairs),
            notes,
            left_aside: table.left_aside().to_vec(),
            next: None,
            plan: None,
            files: table.files.clone(),
            pixels: table.metadata.pixels,
            start: as_read(&motions, &points),
            motions,
            residuals,
            points,
            ..Self::empty(table.name(), fits.gravity)
        }
    }

    /// A report that says nothing yet.
    pub(super) fn empty(table: &str, gravity: Sourced) -> Self {
        Self {
            schema: SCHEMA,
            table: table.to_owned(),
            verdict: Verdict::Refused,
            reason: String::new(),
            cor: None,
            trials: 0,
            gravity,
            sigma_height: None,
            sigma_time: None,
            frame_rate: None,
            estimates: Vec::new(),
            bounces: Vec::new(),
            agreement: None,
            hypotheses: Vec::new(),
            models: Vec::new(),
            allowed: Vec::new(),
            profiles: Vec::new(),
            bootstrap: None,
            series: Vec::new(),
            findings: Vec::new(),
            widened: Vec::new(),
            warnings: Vec::new(),
            repairs: Vec::new(),
            notes: Vec::new(),
            left_aside: Vec::new(),
            groups: Vec::new(),
            differences: Vec::new(),
            next: None,
            plan: None,
            files: Vec::new(),
            pixels: false,
            ball_m: None,
            start: None,
            motions: Vec::new(),
            residuals: Vec::new(),
            points: Vec::new(),
        }
    }
}

fn described(mut estimates: Vec<Estimate>) -> Vec<Estimate> {
    estimates.iter_mut().for_each(|e| e.about = words::method_about(e.method).to_owned());
    estimates
}

/// The first lines, and how many more there are.
fn shortened(mut lines: Vec<String>) -> Vec<String> {
    if lines.len() > LISTED {
        let more = lines.len() - LISTED;
        lines.truncate(LISTED);
        lines.push(format!("and {more} more of the kind"));
    }
    lines
}
