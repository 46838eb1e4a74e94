//! `saltus accuracy`: what accuracy costs in a scene.

use std::fmt::Write;
use std::process::ExitCode;

use saltus_bounce::scene::accuracy::{Accuracy, Difference, Outcome, Target, Toggle, Trial, Way};
use saltus_bounce::scene::{Scene, Stepper};
use saltus_plot::{Background, Chart, Measure, Stroke};
use serde::Serialize;

use crate::args;
use crate::error::Error;
use crate::output::{check_picture, write};
use crate::row::{Came, Row, Seconds};
use crate::simulate::{ending, scene};

/// The number of the JSON contract.
const SCHEMA: u32 = 1;

pub(crate) fn run(args: &args::Accuracy) -> Result<ExitCode, Error> {
    check_picture(args.plot.as_deref())?;
    let scene = scene(&args.scene, ending(args.until, None))?;
    let accuracy = Accuracy::timed(&scene).map_err(Error::new)?;
    let toggles = accuracy.toggled(&scene);
    if let Some(path) = &args.plot {
        write(Some(path), picture(&accuracy)?.as_bytes())?;
    }
    let target = args.target.unwrap_or(Target::DEFAULT);
    let text = match args.format {
        args::ReportFormat::Text => text(&accuracy, &toggles, target),
        args::ReportFormat::Json => json(&accuracy, &toggles, target)?,
    };
    write(None, text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// The scene with the cheapest setting that meets the target, and that setting in words.
pub(crate) fn aimed(mut scene: Scene, target: Target) -> Result<(Scene, String), Error> {
    let accuracy = Accuracy::counted(&scene).map_err(Error::new)?;
    let best = accuracy.cheapest(target).ok_or_else(|| Error::new(unmet(&accuracy, target)))?;
    if let Way::Steps { stepper, tolerance } = best.way {
        (scene.run.stepper, scene.run.tolerance) = (Some(stepper), Some(tolerance));
    }
    let text = recommended(best, &accuracy, target);
    Ok((scene, text))
}

fn text(accuracy: &Accuracy, toggles: &[Toggle], target: Target) -> String {
    let mut text = String::from("What accuracy costs in this scene.\n\n");
    let doubt = accuracy.doubt();
    let _ = match accuracy.reference().0 {
        Way::Formulas => writeln!(text, "Errors are differences from the solution by formulas."),
        way => writeln!(
            text,
            "Errors are differences from a run by {way}, which is itself off by about {} s and {} m.",
            short(doubt.impacts),
            short(doubt.position)
        ),
    };
    let _ = writeln!(
        text,
        "\n{:<18} {:>9} {:>9} {:>9} {:>9}   {:>9} {:>11}   {:<26}",
        "", "impacts", "apexes", "places", "energy", "steps", "evaluations", "time"
    );
    let _ = writeln!(text, "{:<18} {:>9} {:>9} {:>9} {:>9}", "", "s", "m", "m", "share");
    let mut last = None;
    for trial in accuracy.trials() {
        let kind = kind(trial.way);
        if last.is_some_and(|last| last != kind) {
            text.push('\n');
        }
        last = Some(kind);
        line(&mut text, &trial.way.to_string(), &trial.outcome);
    }
    let _ = writeln!(text, "\n{}", conclusion(accuracy, target));
    effects(&mut text, toggles, accuracy, target);
    text
}

const fn kind(way: Way) -> &'static str {
    match way {
        Way::Steps { stepper, .. } => stepper.name(),
        Way::Frames { .. } => "frame by frame",
        _ => "formulas",
    }
}

fn line(text: &mut String, name: &str, outcome: &Result<Outcome, String>) {
    let outcome = match outcome {
        Ok(outcome) => outcome,
        Err(refused) => {
            let _ = writeln!(text, "{name:<18} not run: {refused}");
            return;
        }
    };
    let Difference { impacts, apexes, position, energy, missed } = outcome.difference;
    let [impacts, apexes, position, energy] = [impacts, apexes, position, energy].map(short);
    let _ = write!(
        text,
        "{name:<18} {impacts:>9} {apexes:>9} {position:>9} {energy:>9}   {:>9} {:>11}   {}",
        outcome.cost.steps,
        outcome.evaluations(),
        took(outcome)
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

fn took(outcome: &Outcome) -> String {
    match outcome.timing {
        None => String::new(),
        Some(timing) => {
            let times = [timing.median, timing.least, timing.greatest].map(|s| 1e6 * s);
            let digits = if times[0] < 9.95 { 1 } else { 0 };
            let [median, least, greatest] = times.map(|us| format!("{us:.digits$}"));
            format!("{median} µs ({least} to {greatest})")
        }
    }
}

/// Two digits; a dash where there is nothing to compare.
fn short(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        value if value.is_finite() => format!("{value:.1e}"),
        _ => "-".to_owned(),
    }
}

/// A length or a time in a unit that fits, to two digits.
fn sized(value: f64, unit: &str) -> String {
    let scales = [(1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n")];
    let fits = scales.iter().find(|(scale, _)| value >= 0.9999 * scale);
    match fits {
        _ if value == 0.0 => format!("0 {unit}"),
        Some((scale, prefix)) => {
            let number = value / scale;
            let digits = if number < 9.95 && (number - number.round()).abs() > 1e-9 { 1 } else { 0 };
            format!("{number:.digits$} {prefix}{unit}")
        }
        None => format!("{value:.0e} {unit}"),
    }
}

fn aim(target: Target) -> String {
    let parts = [target.length.map(|m| sized(m, "m")), target.time.map(|s| sized(s, "s"))];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    parts.join(" and ")
}

fn recommended(best: &Trial, accuracy: &Accuracy, target: Target) -> String {
    let aim = aim(target);
    let way = match best.way {
        Way::Formulas => return format!("{aim} everywhere: formulas solve this scene, and nothing is to be chosen"),
        Way::Steps { stepper, tolerance } => format!("tolerance {tolerance:.0e} by {}", stepper.name()),
        way => way.to_string(),
    };
    let Ok(outcome) = &best.outcome else { return way };
    let Difference { impacts, position, apexes, .. } = outcome.difference;
    let reference = match accuracy.reference().0 {
        Way::Formulas => "the formulas".to_owned(),
        way => format!("a run by {way}"),
    };
    format!(
        "{aim} everywhere: {way}; off by {} and {} at worst, measured against {reference}; {} evaluations",
        sized(position.max(apexes), "m"),
        sized(impacts, "s"),
        outcome.evaluations()
    )
}

fn unmet(accuracy: &Accuracy, target: Target) -> String {
    let doubt = accuracy.doubt();
    format!(
        "no setting is known to meet {}: the reference itself is off by {} and {}; ask for less, or end the run earlier by --until",
        aim(target),
        sized(doubt.position.max(doubt.apexes), "m"),
        sized(doubt.impacts, "s")
    )
}

fn conclusion(accuracy: &Accuracy, target: Target) -> String {
    let Some(best) = accuracy.cheapest(target) else {
        return format!("There is no advice: {}.", unmet(accuracy, target));
    };
    let mut text = recommended(best, accuracy, target);
    if let Ok(outcome) = &best.outcome
        && outcome.timing.is_some()
    {
        let _ = write!(text, ", {}", took(outcome));
    }
    if let Way::Steps { stepper, tolerance } = best.way {
        if let Some(factor) = accuracy.per_digit(stepper) {
            let _ = write!(text, "; each further digit costs × {factor:.2}");
        }
        let name = stepper.name().to_lowercase();
        let _ = write!(text, ".\nIn the scene: `stepper = \"{name}\"` and `tolerance = {tolerance:.0e}` under [run]");
    }
    text.push('.');
    text
}

fn effects(text: &mut String, toggles: &[Toggle], accuracy: &Accuracy, target: Target) {
    let _ = writeln!(
        text,
        "\nThe budget of effects at {}: what leaving one out, or putting one in, changes, and what the run costs then.\n",
        aim(target)
    );
    // Reasons why there is no run, each with the effects it holds for.
    let mut refusals: Vec<(&str, Vec<String>)> = Vec::new();
    for toggle in toggles {
        let name = toggled(toggle);
        match &toggle.outcome {
            Err(refused) => match refusals.iter_mut().find(|(reason, _)| reason == refused) {
                Some((_, names)) => names.push(name),
                None => refusals.push((refused, vec![name])),
            },
            Ok(outcome) => {
                let Difference { impacts, position, .. } = outcome.difference;
                let says = match (outcome.difference.meets(target, accuracy.doubt()), toggle.without) {
                    (true, true) => "can be left out",
                    (true, false) => "is not missed",
                    (false, true) => "matters",
                    (false, false) => "would matter",
                };
                let [impacts, position] = [impacts, position].map(short);
                let _ = writeln!(
                    text,
                    "{name:<28} {says:<16} {impacts:>9} s {position:>9} m  {:>9} evaluations   {}",
                    outcome.evaluations(),
                    took(outcome)
                );
            }
        }
    }
    for (reason, names) in refusals {
        let _ = writeln!(text, "not run: {}; {reason}", names.join(", "));
    }
}

fn toggled(toggle: &Toggle) -> String {
    format!("{} {}", if toggle.without { "without" } else { "with" }, toggle.effect)
}

/// Error over time, both by powers of ten, a line for each stepper and one for frames.
fn picture(accuracy: &Accuracy) -> Result<String, Error> {
    let mut chart =
        Chart::new("What accuracy costs", ("Farthest place off", Measure::Length), ("Time of a run", Measure::Time))
            .caption(&match accuracy.reference().0 {
                Way::Formulas => "Against the solution by formulas".to_owned(),
                way => format!("Against a run by {way}"),
            })
            .both_logarithmic()
            .background(Background::Adaptive);
    let least = 1e-15;
    let mut lines: Vec<(&str, Vec<[f64; 2]>)> = Vec::new();
    for trial in accuracy.trials() {
        let Ok(Outcome { difference, timing: Some(timing), .. }) = &trial.outcome else { continue };
        if !difference.position.is_finite() {
            continue;
        }
        let point = [difference.position.max(least), timing.median];
        match lines.last_mut().filter(|(name, _)| *name == kind(trial.way)) {
            Some((_, points)) => points.push(point),
            None => lines.push((kind(trial.way), vec![point])),
        }
    }
    for (name, points) in &lines {
        chart = chart.line(name, Stroke::polygon(points)).marks(points.iter().copied());
    }
    chart.svg().map_err(Error::new)
}

#[derive(Serialize)]
struct Document {
    schema: u32,
    reference: String,
    reference_error: Errors,
    trials: Vec<Row<Measured>>,
    target: Aim,
    recommended: Option<Recommended>,
    effects: Vec<Row<Measured>>,
}

#[derive(Serialize)]
struct Aim {
    #[serde(skip_serializing_if = "Option::is_none")]
    length_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    time_s: Option<f64>,
}

#[derive(Serialize)]
struct Recommended {
    run: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    stepper: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cost_of_a_digit: Option<f64>,
}

#[derive(Serialize)]
struct Errors {
    impacts_s: Option<f64>,
    apexes_m: Option<f64>,
    places_m: Option<f64>,
    energy_share: Option<f64>,
    impacts_missed: usize,
}

#[derive(Serialize)]
struct Measured {
    error: Errors,
    steps: u64,
    flows: u64,
    guards: u64,
    #[serde(flatten)]
    seconds: Option<Seconds>,
}

/// What breaks off is infinitely far, for which JSON has no number.
fn errors(difference: &Difference) -> Errors {
    let finite = |value: f64| value.is_finite().then_some(value);
    Errors {
        impacts_s: finite(difference.impacts),
        apexes_m: finite(difference.apexes),
        places_m: finite(difference.position),
        energy_share: finite(difference.energy),
        impacts_missed: difference.missed,
    }
}

fn row(run: String, outcome: &Result<Outcome, String>) -> Row<Measured> {
    let came = match outcome {
        Err(refused) => Came::Refused { refused: refused.clone() },
        Ok(outcome) => Came::Measured(Measured {
            error: errors(&outcome.difference),
            steps: outcome.cost.steps,
            flows: outcome.cost.flows,
            guards: outcome.cost.guards,
            seconds: outcome.timing.map(Seconds::from),
        }),
    };
    Row { run, came }
}

fn json(accuracy: &Accuracy, toggles: &[Toggle], target: Target) -> Result<String, Error> {
    let recommended = accuracy.cheapest(target).map(|best| {
        let chosen = match best.way {
            Way::Steps { stepper, tolerance } => Some((stepper, tolerance)),
            _ => None,
        };
        Recommended {
            run: best.way.to_string(),
            stepper: chosen.map(|(stepper, _): (Stepper, f64)| stepper.name().to_lowercase()),
            tolerance: chosen.map(|(_, tolerance)| tolerance),
            cost_of_a_digit: chosen.and_then(|(stepper, _)| accuracy.per_digit(stepper)),
        }
    });
    let document = Document {
        schema: SCHEMA,
        reference: accuracy.reference().0.to_string(),
        reference_error: errors(accuracy.doubt()),
        trials: accuracy.trials().iter().map(|trial| row(trial.way.to_string(), &trial.outcome)).collect(),
        target: Aim { length_m: target.length, time_s: target.time },
        recommended,
        effects: toggles.iter().map(|toggle| row(toggled(toggle), &toggle.outcome)).collect(),
    };
    Ok(serde_json::to_string_pretty(&document).map_err(Error::new)? + "\n")
}
