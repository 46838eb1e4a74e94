//! What was left out or mended, and why a recording gives no motion.

use super::reading;
use crate::finding::{Finding, FindingKind};

pub(super) fn words(finding: &Finding) -> Option<String> {
    Some(match &finding.kind {
        FindingKind::ReadNote { note } => note.to_string(),
        FindingKind::ReadRepair { repair } => repair.to_string(),
        FindingKind::ReadWarning { warning } => warning.to_string(),
        FindingKind::FallsUpwards { down } => {
            let (way, option) = if *down { ("downwards", "--y-up") } else { ("upwards", "--y-down") };
            format!(
                "the heights are taken to count {way}, as stated, and then the ball falls upwards: it should be {option}"
            )
        }
        FindingKind::ReadDoubt { doubt } => reading::words(doubt),
        FindingKind::Groups { groups, trusted, .. } if trusted == groups => format!("{groups} groups, a COR each"),
        FindingKind::Groups { groups, refused, .. } if refused == groups => {
            format!("none of {groups} groups determines a COR")
        }
        FindingKind::Groups { groups, trusted, .. } => format!("of {groups} groups {trusted} can be trusted: see each"),
        FindingKind::Pairs { heard, apart_s } => format!(
            "the {heard} contacts come in pairs up to {:.1} ms apart, as if each was heard twice: the second of every pair left out",
            1e3 * apart_s
        ),
        FindingKind::ReleaseAmongContacts => {
            "the time 0 is taken as that of the release: the first interval is shorter beside the \
             others than between contacts it would be; if it is a contact, see --no-repair"
                .to_owned()
        }
        FindingKind::ContactMissed { after_s } => {
            format!("a contact was missed after {after_s:.4} s: the later ones were counted on by one")
        }
        FindingKind::ContactTwice { at_s } => {
            format!("the contact at {at_s:.4} s was counted twice: the second was left out")
        }
        FindingKind::ContactMisread { at_s } => {
            format!("the contact at {at_s:.4} s fits neither of its flights (misread?): it was left out")
        }
        FindingKind::RunEnded { at_s, left_out, before } => {
            let which = if *before { "before" } else { "after" };
            let were = if *left_out == 1 { "time was" } else { "times were" };
            format!("nothing {which} {at_s:.4} s follows from the rest, and {left_out} {were} left out")
        }
        FindingKind::HeightLeftOut { height_m } => {
            let what = match finding.at.bounce {
                Some(0) | None => "the release".to_owned(),
                Some(bounce) => format!("bounce {bounce}"),
            };
            format!("the height at {what}, {height_m:.4} m, does not belong to the others: left out")
        }
        FindingKind::TimeLeftOut { time_s } => {
            let contact = finding.at.bounce.unwrap_or(0);
            format!("the time of contact {contact}, {time_s:.4} s, does not belong to the others: left out")
        }
        _ => return samples_of(&finding.kind),
    })
}

/// Of the samples of a recording.
fn samples_of(kind: &FindingKind) -> Option<String> {
    Some(match kind {
        FindingKind::SameTime { samples } => {
            format!("{samples} samples at a time that another sample has: the first of each was used")
        }
        FindingKind::FramesRestored { rate, rounded_s } => format!(
            "the times are those of {rate:.5} frames a second, rounded to {} ms: each frame was given its own time",
            1000.0 * rounded_s
        ),
        FindingKind::Thinned { samples, every } => {
            format!("of {samples} samples one in {every} is used: more would hardly make the COR more certain")
        }
        FindingKind::TurnedOver => {
            "the heights grow downwards (the ball turns sharply at the top): they were turned over".to_owned()
        }
        FindingKind::EndsLeftOut { before, after, brief } => {
            let ends = [(*before, "before the fall"), (*after, "after the last flight")];
            let one = |(n, at): &(usize, &str)| format!("{n} {} {at}", samples(*n));
            let ends: Vec<String> = ends.iter().filter(|end| end.0 > 0).map(one).collect();
            let brief = if *brief { ", or bounced in too few samples" } else { "" };
            format!("{} left out: the ball was held, caught or lay there{brief}", ends.join(" and "))
        }
        FindingKind::WildLeftOut { samples: n } => {
            format!("{n} wild {} left out, far from every flight through their neighbours", samples(*n))
        }
        FindingKind::NoBounce { samples } => {
            format!("there is no bounce in this series of {samples} heights: the ball never falls and rises again")
        }
        FindingKind::TooFewSamples { samples } => format!(
            "this series of {samples} heights has too few samples beside its bounce: a flight needs at least four before and after"
        ),
        FindingKind::MotionUndetermined => {
            "the samples of the flights do not determine a motion: they are too few, too rough, or not of a ball in flight".to_owned()
        }
        FindingKind::NoSamples => "the series is empty".to_owned(),
        _ => return None,
    })
}

fn samples(n: usize) -> &'static str {
    if n == 1 { "sample" } else { "samples" }
}
