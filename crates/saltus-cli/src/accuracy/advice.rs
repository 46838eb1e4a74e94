//! The advice: which setting to take, how exact it is, what it costs.

use std::fmt::Write;

use saltus_scene::accuracy::{Accuracy, Difference, Target, Trial, Way};

use super::words::{aim, off, reference, took};

/// In a line, for those who run by it.
pub(super) fn in_short(best: &Trial, accuracy: &Accuracy, target: Target) -> String {
    let aim = aim(target);
    let setting = setting(best);
    match &best.outcome {
        Ok(outcome) if best.way != Way::Formulas => format!(
            "{aim} everywhere: {setting}; off by {} at worst, measured against {}; {} evaluations",
            worst(&outcome.difference),
            reference(accuracy),
            outcome.evaluations()
        ),
        _ => format!("{aim} everywhere: {setting}"),
    }
}

/// With everything that speaks for it.
pub(super) fn in_full(accuracy: &Accuracy, target: Target) -> String {
    let doubt = accuracy.doubt();
    let Some(best) = accuracy.cheapest(target) else {
        return format!("There is no advice: {}.\n", unmet(accuracy, target));
    };
    let mut text = format!("{} everywhere: {}.\n", aim(target), setting(best));
    let mut row = |what: &str, says: &str| {
        let _ = writeln!(text, "  {what:<16} {says}");
    };
    let doubted = off(doubt.position.max(doubt.apexes), doubt.impacts);
    let Ok(outcome) = &best.outcome else { return text };
    match best.way {
        Way::Formulas => row("off by", &format!("about {doubted}, by rounding")),
        _ => row(
            "off by at worst",
            &format!(
                "{}, measured against {}, itself off by about {doubted}",
                worst(&outcome.difference),
                reference(accuracy)
            ),
        ),
    }
    let took = took(outcome).map_or_else(String::new, |took| format!(", {took}"));
    row("costs", &format!("{} evaluations{took}", outcome.evaluations()));
    if let Way::Steps { stepper, tolerance } = best.way {
        if let Some(factor) = accuracy.per_digit(stepper) {
            row("a further digit", &format!("costs × {factor:.2} by {}", stepper.name()));
        }
        let name = stepper.name().to_lowercase();
        row("in the scene", &format!("`stepper = \"{name}\"` and `tolerance = {tolerance:.0e}` under [run]"));
    }
    text
}

/// Why there is no advice.
pub(super) fn unmet(accuracy: &Accuracy, target: Target) -> String {
    let doubt = accuracy.doubt();
    let known = match accuracy.reference().0 {
        Way::Formulas => "rounding puts even the solution by formulas off by about",
        _ => "the reference itself is off by about",
    };
    format!(
        "no setting is known to meet {}: {known} {}; ask for less accuracy, or end the run earlier by --until",
        aim(target),
        off(doubt.position.max(doubt.apexes), doubt.impacts)
    )
}

fn setting(best: &Trial) -> String {
    match best.way {
        Way::Formulas => "formulas solve this scene, and nothing is to be chosen".to_owned(),
        Way::Steps { stepper, tolerance } => format!("tolerance {tolerance:.0e} by {}", stepper.name()),
        way => way.to_string(),
    }
}

fn worst(difference: &Difference) -> String {
    let Difference { impacts, apexes, position, .. } = *difference;
    off(position.max(apexes), impacts)
}
