//! The one place where findings become sentences.
//!
//! A sentence begins with a small letter and has no full stop: it may stand after the name of its
//! trial, or in a list.

mod aside;
mod models;
mod names;
mod plan;
mod reading;
mod remarks;
mod repairs;
mod verdict;

use std::fmt::{self, Display, Formatter};

use super::numbers::{duration, length};
use crate::finding::{Finding, FindingKind, Widening};

pub(super) use names::{about, loss_words, method_about, method_short, settles, short, supposes};
pub(super) use plan::{brings, every_bounce, way};

/// The list of a report that a finding stands in, where the verdict does not rest on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    /// What was left out or mended before the fit.
    Repairs,
    /// How the table was read, and what was not tried.
    Notes,
    /// What to keep in mind.
    Warnings,
}

/// Where a finding stands.
pub(super) fn section(kind: &FindingKind) -> Section {
    match kind {
        FindingKind::ReadRepair { .. }
        | FindingKind::Pairs { .. }
        | FindingKind::ReleaseAmongContacts
        | FindingKind::ContactMissed { .. }
        | FindingKind::ContactTwice { .. }
        | FindingKind::ContactMisread { .. }
        | FindingKind::RunEnded { .. }
        | FindingKind::HeightLeftOut { .. }
        | FindingKind::TimeLeftOut { .. }
        | FindingKind::SameTime { .. }
        | FindingKind::FramesRestored { .. }
        | FindingKind::Thinned { .. }
        | FindingKind::TurnedOver
        | FindingKind::EndsLeftOut { .. }
        | FindingKind::WildLeftOut { .. } => Section::Repairs,
        FindingKind::ReadNote { .. }
        | FindingKind::ExplanationsThinned { .. }
        | FindingKind::NotCompared { .. }
        | FindingKind::SpeedNotTried { .. }
        | FindingKind::DragNeeded { .. }
        | FindingKind::ContactShows { .. }
        | FindingKind::RestsOn { .. } => Section::Notes,
        _ => Section::Warnings,
    }
}

impl Display for Finding {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if !self.at.name.is_empty() {
            write!(f, "{}: ", self.at.name)?;
        }
        f.write_str(&sentence(self))
    }
}

fn sentence(finding: &Finding) -> String {
    let kind = &finding.kind;
    let words = repairs::words(finding).or_else(|| models::words(kind)).or_else(|| verdict::words(finding));
    // Every kind has words: a test makes one of each.
    words.unwrap_or_default()
}

/// Why the interval reaches further.
pub(super) fn widening(widening: &Widening) -> String {
    match widening {
        Widening::Settings => "it takes in each of the balls, floors or drop heights".to_owned(),
        Widening::Models => "it reaches out to models that fit as well, with another COR".to_owned(),
        Widening::Speeds => "it takes in all that the COR may be under the models that fit".to_owned(),
        Widening::BothModels => "it takes in both models".to_owned(),
        Widening::ImpactTime => "it takes in impacts that take time, and such that take none".to_owned(),
        Widening::EveryImpact => "it takes in the COR of every impact".to_owned(),
        Widening::Zero { zero_m, share } => format!(
            "a zero of the heights off by up to {} (where on the ball were they read?) may move the COR by {share:.3}: read the ball at rest on the floor, and \
             state what is left (--sigma-zero)",
            length(*zero_m)
        ),
        Widening::Scale { part, share } => format!(
            "lengths that are wrong by up to {:.1} % (a ball that moves before its rule, not beside it) may move the COR by {share:.3} where \
             heights meet times: hold the rule where the ball falls, and state what is left (--sigma-scale)",
            100.0 * part
        ),
        Widening::Release { sigma_m, share } => format!(
            "the height of release is known to {} only, which may move the COR by {share:.3}: its own row may state its error",
            length(*sigma_m)
        ),
        Widening::Air { share, ball: Some(ball), .. } => format!(
            "the table names the ball, {ball}, whose air may move the COR by {share:+.3}: --ball {ball} takes the air out of it"
        ),
        Widening::Air { most_per_m, share, ball: None } => format!(
            "which ball it was is not stated, and the air may move the COR by {share:+.3} (if it is light: k = {most_per_m:.3} /m): name the ball (--ball \
             tennis) or its drag (--drag)"
        ),
        Widening::Averages { drops, share } => format!(
            "means, of {drops} readings each as far as it is said, do not show how far drops differ, which may move the COR by {share:.3}: give \
             the drops one by one"
        ),
        Widening::Lens { share } => format!(
            "a lens that bends the picture by a few hundredths may move the COR by {share:.3}: film from further away, with the path in the middle"
        ),
        Widening::Misfit { rms, noise, share } => format!(
            "the motion leaves {rms:.2e} where the samples scatter by {noise:.2e}, and a bend of that size may move the COR by {share:.3}: look at \
             the lens, the scale and the tracking"
        ),
        Widening::SingleImpact { contact_s, lower } => format!(
            "one impact does not show how long it lasts, and a ball that stays {} on the floor would have a COR lower by {lower:.3}",
            duration(*contact_s)
        ),
    }
}

/// A probability for people, with the sign before it.
pub(super) fn chance(p: f64) -> String {
    match p {
        p if p >= 0.0095 => format!("= {p:.2}"),
        p if p >= 0.000_95 => format!("= {p:.3}"),
        p if p > 0.0 => format!("= {p:.0e}"),
        _ => "< 1e-300".to_owned(),
    }
}
