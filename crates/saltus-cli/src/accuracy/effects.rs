//! The budget of effects: what each one changes at a target, and what it costs.

use std::fmt::Write;

use saltus_scene::accuracy::{Accuracy, Difference, Target, Toggle};

use super::words::{aim, short, took};
use crate::row::plainly;

pub(super) fn text(toggles: &[Toggle], accuracy: &Accuracy, target: Target) -> String {
    let mut text = format!(
        "\nThe budget of effects at {}: what leaving one out, or putting one in, changes, and what the run costs then.\n\n",
        aim(target)
    );
    // Reasons why there is no run, each with the effects it holds for.
    let mut refusals: Vec<(String, Vec<String>)> = Vec::new();
    let mut runs = String::new();
    for toggle in toggles {
        let name = toggle.to_string();
        let outcome = match &toggle.outcome {
            Ok(outcome) => outcome,
            Err(refused) => {
                let refused = plainly(refused);
                match refusals.iter_mut().find(|(reason, _)| *reason == refused) {
                    Some((_, names)) => names.push(name),
                    None => refusals.push((refused, vec![name])),
                }
                continue;
            }
        };
        let Difference { impacts, position, .. } = outcome.difference;
        let says = match (outcome.difference.meets(target, accuracy.doubt()), toggle.without) {
            (true, true) => "can be left out",
            (true, false) => "would not matter",
            (false, true) => "matters",
            (false, false) => "would matter",
        };
        let _ = writeln!(
            runs,
            "{name:<28} {says:<16} {:>9} {:>9} {:>12}   {}",
            short(impacts),
            short(position),
            outcome.evaluations(),
            took(outcome).unwrap_or_default()
        );
    }
    if !runs.is_empty() {
        let _ = writeln!(text, "{:<45} {:>9} {:>9} {:>12}   time", "", "impacts", "places", "evaluations");
        let _ = writeln!(text, "{:<45} {:>9} {:>9}", "", "s", "m");
        text.push_str(&runs);
    }
    for (reason, names) in refusals {
        let _ = writeln!(text, "not run: {}: {reason}", names.join(", "));
    }
    text
}
