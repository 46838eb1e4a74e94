//! What accuracy costs, as JSON; the contract is written down in docs/trust/accuracy.md.

use saltus::Timing;
use serde::Serialize;

use crate::Error;
use crate::accuracy::{Accuracy, Difference, Outcome, Target, Toggle, Way};

/// The number of the JSON contract.
const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct Document {
    schema: u32,
    reference: String,
    reference_error: Errors,
    trials: Vec<Row>,
    target: Aim,
    recommended: Option<Recommended>,
    effects: Vec<Row>,
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

/// A run: what was measured, or why there is none.
#[derive(Serialize)]
struct Row {
    run: String,
    #[serde(flatten)]
    measured: Option<Measured>,
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<String>,
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

/// The times of a run by the clock, in s, as reports in JSON have them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Seconds {
    /// The median.
    pub seconds: f64,
    /// The least.
    pub seconds_low: f64,
    /// The greatest.
    pub seconds_high: f64,
}

impl From<Timing> for Seconds {
    fn from(Timing { median, least, greatest, .. }: Timing) -> Self {
        Self { seconds: median, seconds_low: least, seconds_high: greatest }
    }
}

impl From<&Difference> for Errors {
    /// A run that breaks off is infinitely far, for which JSON has no number.
    fn from(difference: &Difference) -> Self {
        let finite = |value: f64| value.is_finite().then_some(value);
        Self {
            impacts_s: finite(difference.impacts),
            apexes_m: finite(difference.apexes),
            places_m: finite(difference.position),
            energy_share: finite(difference.energy),
            impacts_missed: difference.missed,
        }
    }
}

impl Row {
    fn of(run: String, outcome: &Result<Outcome, String>) -> Self {
        let measured = outcome.as_ref().ok().map(|outcome| Measured {
            error: (&outcome.difference).into(),
            steps: outcome.cost.steps,
            flows: outcome.cost.flows,
            guards: outcome.cost.guards,
            seconds: outcome.timing.map(Seconds::from),
        });
        Self { run, measured, refused: outcome.as_ref().err().cloned() }
    }
}

impl Accuracy {
    /// The JSON of the comparison: every setting tried, the one to take for a `target`, and what
    /// each of the effects in `toggles` changes; docs/trust/accuracy.md describes it.
    ///
    /// ```
    /// use saltus_scene::Scene;
    /// use saltus_scene::accuracy::{Accuracy, Target};
    ///
    /// let scene = Scene::parse("drop.toml", b"restitution = 0.8\n[ball]\nheight = \"1 m\"\n")?;
    /// let accuracy = Accuracy::counted(&scene)?;
    /// let json = accuracy.json(&accuracy.toggled(&scene), Target::DEFAULT)?;
    /// let json: serde_json::Value = serde_json::from_str(&json)?;
    /// assert_eq!(json["recommended"]["run"], "formulas");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// None: every number of the comparison has a JSON form.
    pub fn json(&self, toggles: &[Toggle], target: Target) -> Result<String, Error> {
        let recommended = self.cheapest(target).map(|best| {
            let chosen = match best.way {
                Way::Steps { stepper, tolerance } => Some((stepper, tolerance)),
                _ => None,
            };
            Recommended {
                run: best.way.to_string(),
                stepper: chosen.map(|(stepper, _)| stepper.name().to_lowercase()),
                tolerance: chosen.map(|(_, tolerance)| tolerance),
                cost_of_a_digit: chosen.and_then(|(stepper, _)| self.per_digit(stepper)),
            }
        });
        let document = Document {
            schema: SCHEMA,
            reference: self.reference().0.to_string(),
            reference_error: self.doubt().into(),
            trials: self.trials().iter().map(|trial| Row::of(trial.way.to_string(), &trial.outcome)).collect(),
            target: Aim { length_m: target.length, time_s: target.time },
            recommended,
            effects: toggles.iter().map(|toggle| Row::of(toggle.to_string(), &toggle.outcome)).collect(),
        };
        Ok(serde_json::to_string_pretty(&document).map_err(Error::new)? + "\n")
    }
}
