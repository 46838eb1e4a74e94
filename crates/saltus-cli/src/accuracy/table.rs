//! The table of settings: error against cost.

use std::fmt::Write;

use saltus_scene::accuracy::{Accuracy, Difference, Outcome, Target, Trial, Way};

use super::words::{impacts, reference, short, took};

/// The settings that cost least for what they give, or all of them, and frame by frame.
pub(super) fn text(accuracy: &Accuracy, target: Target, all: bool) -> String {
    let best = accuracy.cheapest(target);
    let frontier = accuracy.frontier(target);
    let shown = |trial: &&Trial| {
        all || matches!(trial.way, Way::Frames { .. }) || frontier.contains(trial) || best == Some(trial)
    };
    let trials = accuracy.trials();
    let mut rows: Vec<&Trial> = trials.iter().filter(shown).collect();
    let left_out = trials.len() - rows.len();
    if !all {
        // From the cheapest to the most exact, then frames.
        let rank = |trial: &&Trial| frontier.iter().position(|other| other == trial).unwrap_or(usize::MAX);
        rows.sort_by_key(rank);
    }
    let solved = accuracy.reference().0 == Way::Formulas;
    let which = match left_out {
        0 if solved && !all => "formulas".to_owned(),
        0 => "all settings".to_owned(),
        left_out if solved => {
            format!("formulas (--all shows {left_out} settings of steppers, which this scene does not need)")
        }
        left_out => format!("the settings that cost least for what they give (--all shows {left_out} more)"),
    };
    let mut text =
        format!("\nErrors against {}. Shown are {which}, and frame by frame, as games do.\n", reference(accuracy));
    let _ = writeln!(
        text,
        "\n  {:<16} {:>9} {:>9} {:>9} {:>9}   {:>9} {:>11}   time",
        "", "impacts", "apexes", "places", "energy", "steps", "evaluations"
    );
    let _ = writeln!(text, "  {:<16} {:>9} {:>9} {:>9} {:>9}", "", "s", "m", "m", "share");
    let mut last = None;
    for trial in &rows {
        let group = if all { kind(trial.way) } else { framed(trial.way) };
        if last.is_some_and(|last| last != group) {
            text.push('\n');
        }
        last = Some(group);
        let mark = if best == Some(trial) { '>' } else { ' ' };
        line(&mut text, mark, &trial.way.to_string(), &trial.outcome);
    }
    let mut notes = Vec::new();
    if best.is_some() {
        notes.push("> the setting to take");
    }
    if rows.iter().any(|trial| trial.outcome.as_ref().is_ok_and(|outcome| infinite(&outcome.difference))) {
        notes.push("- nothing to compare: what it is of is missing from the run");
    }
    if !notes.is_empty() {
        let _ = writeln!(text, "\n{}", notes.join("; "));
    }
    text
}

/// The word for all settings like this one.
pub(super) const fn kind(way: Way) -> &'static str {
    match way {
        Way::Steps { stepper, .. } => stepper.name(),
        Way::Frames { .. } => framed(way),
        _ => "formulas",
    }
}

const fn framed(way: Way) -> &'static str {
    match way {
        Way::Frames { .. } => "frame by frame",
        _ => "",
    }
}

fn infinite(difference: &Difference) -> bool {
    let Difference { apexes, position, energy, .. } = *difference;
    [impacts(difference), apexes, position, energy].into_iter().any(|value| !value.is_finite())
}

fn line(text: &mut String, mark: char, name: &str, outcome: &Result<Outcome, String>) {
    let outcome = match outcome {
        Ok(outcome) => outcome,
        Err(refused) => {
            let _ = writeln!(text, "{mark} {name:<16} not run: {refused}");
            return;
        }
    };
    let Difference { apexes, position, energy, missed, .. } = outcome.difference;
    let [impacts, apexes, position, energy] = [impacts(&outcome.difference), apexes, position, energy].map(short);
    let _ = write!(
        text,
        "{mark} {name:<16} {impacts:>9} {apexes:>9} {position:>9} {energy:>9}   {:>9} {:>11}   {}",
        outcome.cost.steps,
        outcome.evaluations(),
        took(outcome).unwrap_or_default()
    );
    match missed {
        0 => {}
        1 => text.push_str("; misses an impact"),
        missed => {
            let _ = write!(text, "; misses {missed} impacts");
        }
    }
    text.push('\n');
}
