//! The same for programs: JSON.

use saltus_scene::Stepper;
use saltus_scene::accuracy::{Accuracy, Difference, Outcome, Target, Toggle, Way};
use serde::Serialize;

use super::effects::toggled;
use crate::error::Error;
use crate::row::{Came, Row, Seconds};

/// The number of the JSON contract.
const SCHEMA: u32 = 1;

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

pub(super) fn json(accuracy: &Accuracy, toggles: &[Toggle], target: Target) -> Result<String, Error> {
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
