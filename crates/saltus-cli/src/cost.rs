//! What each effect of a scene changes, and what it costs.

use std::fmt::Write;

use saltus::Timing;
use saltus_scene::Scene;
use saltus_scene::accuracy::Seconds;
use saltus_scene::plan::Effect;
use serde::Serialize;

use crate::error::Error;
use crate::row::{Came, Row, plainly};

/// How many impacts and apexes are compared.
const FIRST: usize = 5;
/// How often a run is timed, and after how many seconds it is not timed again.
const REPEATS: usize = 9;
const PATIENCE: f64 = 1.0;
/// How many evaluations of flows and guards a run may take: a few seconds.
const MOST_EVALUATIONS: u64 = 20_000_000;

#[derive(Serialize)]
pub(crate) struct Measured {
    /// The first impact times in s.
    impacts: Vec<f64>,
    /// The first apex heights of the first ball in m.
    apexes: Vec<f64>,
    #[serde(flatten)]
    seconds: Seconds,
    steps: u64,
    flows: u64,
    guards: u64,
    /// Why the run ended, as in the motion's `stop`.
    reason: &'static str,
}

/// The scene as it is, then with each effect toggled.
pub(crate) fn rows(scene: &Scene) -> Result<Vec<Row<Measured>>, Error> {
    let base = measured(scene).map_err(Error::new)?;
    let mut rows = vec![Row { run: "as it is".to_owned(), came: Came::Measured(base) }];
    for effect in Effect::ALL {
        let word = if scene.names(effect) { "without" } else { "with" };
        let came = scene.toggled(effect).map_err(str::to_owned).and_then(|toggled| measured(&toggled));
        let came = came.map_or_else(|refused| Came::Refused { refused }, Came::Measured);
        rows.push(Row { run: format!("{word} {effect}"), came });
    }
    Ok(rows)
}

fn measured(scene: &Scene) -> Result<Measured, String> {
    let plan = scene.plan().map_err(|error| error.to_string())?.most_evaluations(MOST_EVALUATIONS);
    let record = plan.run().map_err(|error| error.to_string())?;
    let timing = Timing::repeated(REPEATS, PATIENCE, || plan.run());
    let cost = record.cost();
    Ok(Measured {
        impacts: record.impacts().iter().take(FIRST).map(|impact| impact.t).collect(),
        apexes: record.apexes(0).iter().take(FIRST).map(|apex| apex.height).collect(),
        seconds: timing.into(),
        steps: cost.steps,
        flows: cost.flows,
        guards: cost.guards,
        reason: record.end().name(),
    })
}

/// The rows as a table: the first as it is, of the others how far they move each impact and each
/// apex.
pub(crate) fn table(rows: &[Row<Measured>]) -> String {
    let mut text = format!(
        "\nWhat each effect changes and costs: of the other runs, how much later the first {FIRST} impacts and how much higher the first {FIRST} apexes are.\nTime is the median of up to {REPEATS} runs (least to greatest).\n"
    );
    let base = rows.iter().find_map(|row| match &row.came {
        Came::Measured(measured) => Some(measured),
        Came::Refused { .. } => None,
    });
    for (n, row) in rows.iter().enumerate() {
        let came = match &row.came {
            Came::Measured(came) => came,
            Came::Refused { refused } => {
                let _ = writeln!(text, "\n{:<32} not run: {}", row.run, plainly(refused));
                continue;
            }
        };
        let Seconds { seconds, seconds_low, seconds_high, .. } = came.seconds;
        let times = [seconds, seconds_low, seconds_high].map(|s| format!("{:.1}", 1e6 * s));
        let [median, low, high] = times;
        let took = format!("{median} µs ({low} to {high})");
        let _ = write!(text, "\n{:<32} {took:<36} {} flows, {} guards", row.run, came.flows, came.guards);
        if came.reason != "time" {
            let _ = write!(text, "; ended by {}", came.reason);
        }
        text.push('\n');
        let of_base = |get: fn(&Measured) -> &[f64]| base.filter(|_| n > 0).map_or(&[][..], get);
        line(&mut text, "impacts s", &came.impacts, of_base(|of| &of.impacts), n > 0);
        line(&mut text, "apexes m", &came.apexes, of_base(|of| &of.apexes), n > 0);
    }
    text
}

/// Numbers as they are, or as differences; one that has nothing to differ from is marked.
fn line(text: &mut String, what: &str, values: &[f64], from: &[f64], differs: bool) {
    let _ = write!(text, "  {what:<10}");
    if values.is_empty() {
        text.push_str(" none");
    }
    for (k, value) in values.iter().enumerate() {
        let _ = match from.get(k).map(|from| value - from) {
            Some(0.0) => write!(text, " {:>13}", "same"),
            Some(by) => write!(text, " {by:>+13.3e}"),
            None if differs => write!(text, " {:>13}", format!("new {value:.6}")),
            None => write!(text, " {value:>13.6}"),
        };
    }
    text.push('\n');
}
