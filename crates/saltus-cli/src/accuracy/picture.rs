//! The picture: error across, time up, both by powers of ten; a line for each stepper and one for
//! frames.

use saltus_plot::{Background, Chart, Measure, Stroke};
use saltus_scene::accuracy::{Accuracy, Difference, Target, Trial, Way};

use super::table::kind;
use super::words::{aim, impacts, median, reference, sized};
use crate::error::Error;

/// Errors below this are rounding; zero has no place on an axis by powers of ten.
const LEAST: f64 = 1e-15;

pub(super) fn svg(name: &str, accuracy: &Accuracy, target: Target) -> Result<String, Error> {
    let best = accuracy.cheapest(target);
    let (axis, measure, error, limit) = if of_times(best, target) {
        ("Worst impact time off", Measure::Time, impacts as fn(&Difference) -> f64, target.time.map(|most| (most, "s")))
    } else {
        ("Farthest place off", Measure::Length, length as fn(&Difference) -> f64, target.length.map(|most| (most, "m")))
    };
    let mut chart =
        Chart::new(&format!("What accuracy costs: {name}"), (axis, measure), ("Time of a run", Measure::Time))
            .caption(&format!("Against {}; target {}", reference(accuracy), aim(target)))
            .both_logarithmic()
            .at_least(limit.map_or(LEAST, |(most, _)| LEAST.min(0.1 * most)))
            .background(Background::Adaptive);
    // Errors below that of the reference have no meaning.
    let doubt = error(accuracy.doubt());
    let point = |trial: &Trial| {
        let outcome = trial.outcome.as_ref().ok()?;
        let point = [error(&outcome.difference).max(doubt), outcome.timing?.median];
        point[0].is_finite().then_some(point)
    };
    let mut lines: Vec<(&str, Vec<[f64; 2]>)> = Vec::new();
    let stepped = |trial: &&Trial| trial.way != Way::Formulas;
    for trial in accuracy.trials().iter().filter(stepped) {
        let Some(point) = point(trial) else { continue };
        match lines.last_mut().filter(|(name, _)| *name == kind(trial.way)) {
            Some((_, points)) => points.push(point),
            None => lines.push((kind(trial.way), vec![point])),
        }
    }
    for (name, points) in &lines {
        chart = chart.line(name, Stroke::polygon(points)).dotted(points.iter().copied());
    }
    if let Some((most, unit)) = limit {
        chart = chart.limit(&format!("target {}", sized(most, unit)), most);
    }
    // Formulas are a point, not a line: they are called out even where nothing meets the target.
    let called = best.or_else(|| accuracy.trials().iter().find(|trial| !stepped(trial)));
    if let Some((trial, at)) = called.and_then(|trial| Some((trial, point(trial)?))) {
        chart = chart.callout(&format!("{}: {}", trial.way, median(at[1])), at);
        if !stepped(&trial) {
            chart = chart.marks([at]);
        }
    }
    chart.svg().map_err(Error::new)
}

/// Whether the picture is of times: if the target names no length, or the setting to take comes
/// nearer to its time.
fn of_times(best: Option<&Trial>, target: Target) -> bool {
    match (target.length, target.time, best.map(|best| &best.outcome)) {
        (None, _, _) => true,
        (Some(far), Some(late), Some(Ok(outcome))) => {
            impacts(&outcome.difference) / late > length(&outcome.difference) / far
        }
        _ => false,
    }
}

fn length(off: &Difference) -> f64 {
    // An apex that frames miss leaves the places.
    let apexes = Some(off.apexes).filter(|off| off.is_finite());
    off.position.max(apexes.unwrap_or_default())
}
