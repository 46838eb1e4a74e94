//! Other models of the readings beside one COR.

use super::names::{about, before};
use crate::finding::{Cause, FindingKind, Gives, Need, Untried};
use crate::quantity::{Readings, Source};
use crate::report::numbers::{duration, length, measured, pair};

pub(super) fn words(kind: &FindingKind) -> Option<String> {
    Some(match kind {
        FindingKind::NotCompared { untried: why } => format!("other models are not compared: {}", untried(*why)),
        FindingKind::SpeedNotTried { bounces, factor, needs_bounces, needs_factor } => format!(
            "a COR that depends on speed was not tried: that takes {needs_bounces} bounces (here {bounces}) at speeds that differ by a factor of \
             {needs_factor} (here {factor:.2})"
        ),
        FindingKind::ModelFits { model, missing, bic, better, gives: found } => {
            let how = if *better { "better than" } else { "about as well as" };
            format!("{} fits {how} one COR (BIC {bic:+.1}), with {}", about(*model, *missing), gives(found))
        }
        FindingKind::OneCorFails { causes } => {
            let open = if causes.len() > 1 { "; the readings cannot tell which" } else { "" };
            let causes: Vec<String> = causes.iter().map(cause).collect();
            format!("one COR does not do: {}{open}", causes.join(", or "))
        }
        FindingKind::MeasureZero => {
            "to tell a wrong zero from a dependence on speed, lay the ball on the floor and read its height on the same scale".to_owned()
        }
        FindingKind::ErrorDecides { readings, sigma, model, about_best, about_one, doubted: _ } => {
            let (option, size): (_, fn(f64) -> String) = match readings {
                Readings::Heights => ("--sigma-height", length),
                Readings::Times => ("--sigma-time", duration),
            };
            let (best, one, name) = (size(*about_best), size(*about_one), about(*model, None));
            let stated = |error: &str| format!("{option} {}", error.replace(' ', ""));
            if sigma.source == Source::Scatter {
                format!(
                    "nobody stated how well the {readings} were read, and that decides it: about {name} they scatter by {best}, about one COR by \
                     {one}; if they are no better than that, say so ({}), and one COR is not ruled out",
                    stated(&one)
                )
            } else {
                format!(
                    "the error of reading decides it: with {readings} ± {} one COR is not ruled out; but about {name} they scatter by {best} \
                     only, and if they are as good as that ({}), one COR does not do",
                    size(sigma.value),
                    stated(&best)
                )
            }
        }
        FindingKind::ModelNotFitted { model, untried: why, instead } => {
            let why = why.map_or_else(String::new, |why| format!(": {}", untried(why)));
            let instead = if *instead { "; the COR is that of one COR" } else { "" };
            format!("the model '{model}' cannot be fitted to these readings{why}{instead}")
        }
        FindingKind::ModelMisfit { model, gives: found } => {
            format!("{} was asked for, but does not fit ({})", about(*model, None), gives(found))
        }
        FindingKind::ModelBeaten { model, gives: found } => {
            format!("{} was asked for, but another model fits better ({})", about(*model, None), gives(found))
        }
        FindingKind::ModelNotHeeded => {
            "a series chooses its model by itself: what was asked for is not heeded".to_owned()
        }
        FindingKind::DragNotHeeded => {
            "the drag of the ball is not taken out: without a scale of lengths (--scale), or the frame rate (--fps), nothing tells how fast it flew".to_owned()
        }
        _ => return recordings(kind),
    })
}

/// Of models of a recording.
fn recordings(kind: &FindingKind) -> Option<String> {
    Some(match kind {
        FindingKind::DragNeeded { bic, cor_without } => format!(
            "air drag is needed: without it the BIC is {bic:.0} worse, and the COR would come out as {cor_without:.3}"
        ),
        FindingKind::ContactShows { contact_s, bic, cor_without } => format!(
            "the ball stays {} ms on the floor at the first impact: with impacts that take no time the BIC is {bic:.1} worse, and the COR \
             would come out as {cor_without:.3}",
            measured(1e3 * contact_s.value, 1e3 * contact_s.standard_error)
        ),
        FindingKind::ModelsAlike { bic, model, cor, other, other_cor } if *bic < 0.0 => format!(
            "{} would fit the samples better (BIC {bic:.1}) and give a COR of {other_cor:.3}, but they do not hold it; {} gives one of {cor:.3}",
            about(*other, None),
            about(*model, None)
        ),
        FindingKind::ModelsAlike { bic, model, cor, other, other_cor } => format!(
            "two models fit the samples alike (BIC apart by {bic:.1}): {} gives a COR of {cor:.3}, {} one of {other_cor:.3}",
            about(*model, None),
            about(*other, None)
        ),
        FindingKind::ContactOpen { bic, cor_instant, cor_lasting } => format!(
            "two models fit the samples alike (BIC apart by {bic:.1}): the COR is {cor_instant:.3} if impacts take no time, {cor_lasting:.3} \
             if they do"
        ),
        _ => return None,
    })
}

/// The COR or CORs that a model gives.
pub(super) fn gives(gives: &Gives) -> String {
    match gives {
        Gives::Range([slow, fast]) => {
            format!("{:.3} at {:.2} m/s and {:.3} at {:.2} m/s", slow[1], slow[0], fast[1], fast[0])
        }
        Gives::One(cor) => pair(cor.value, cor.standard_error),
    }
}

fn cause(cause: &Cause) -> String {
    match cause {
        Cause::Speed { gives: Some(found) } => format!("it depends on the speed of impact ({})", gives(found)),
        Cause::Speed { gives: None } => "it depends on the speed of impact (not tried: see the notes)".to_owned(),
        Cause::Drag { gives: found } => format!("air drag slows the ball (COR {})", gives(found)),
        Cause::Offset { offset_m, gives: found } => {
            format!("the height scale reads {:.1} cm too high (COR {})", 100.0 * offset_m, gives(found))
        }
        Cause::Rebounds { offset_m, gives: found } => format!(
            "rebounds are read {:.1} cm higher on the ball than the release (COR {})",
            100.0 * offset_m,
            gives(found)
        ),
        Cause::Contact { contact_s, gives: found } => {
            format!("every contact takes {:.0} ms (COR {})", 1000.0 * contact_s, gives(found))
        }
        Cause::Missed { place, gives: found } => {
            format!("a rebound is missing {} (COR {})", before(*place), gives(found))
        }
        Cause::Each => "it differs from bounce to bounce".to_owned(),
    }
}

fn untried(why: Untried) -> String {
    match why {
        Untried::Unsettled => "they do not settle on one COR to begin with".to_owned(),
        Untried::AddedUp => "the errors of times between contacts add up".to_owned(),
        Untried::Scattering => {
            "the bounces scatter: of their ratios, only 'linear', 'drag' and 'contact' are fitted".to_owned()
        }
        Untried::ScatteringDrops => "the bounces scatter, and drops differ".to_owned(),
        Untried::Apart => "heights and times are of different trials, or there is one flight only".to_owned(),
        Untried::DropsDiffer => "where drops differ, other models would take that for their own".to_owned(),
        Untried::Readings { most } => format!("there are more than {most}"),
        Untried::Bounces { most } => format!("there are more than {most} bounces in a trial"),
        Untried::Extreme => "one COR is not between 0.01 and 1".to_owned(),
        Untried::Needs { need } => match need {
            Need::Heights => "it needs heights".to_owned(),
            Need::Releases => "it needs the height of release of every drop".to_owned(),
            Need::Times => "it needs times".to_owned(),
            Need::FewBounces { most } => format!("it is for up to {most} bounces"),
            Need::Speeds { bounces, factor, here, here_factor } => {
                let bounces = bounces.map_or_else(String::new, |n| format!("{n} "));
                let factor = format!("{factor:.2}").trim_end_matches('0').trim_end_matches('.').to_owned();
                format!(
                    "it needs {bounces}bounces at speeds that differ by a factor of {factor}; here are {here}, at speeds that differ by {here_factor:.2}"
                )
            }
            Need::Spare { readings } => format!("it needs {readings} readings more than it has unknowns"),
        },
    }
}
