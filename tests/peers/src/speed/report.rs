//! The table of a contest, as Markdown and as JSON.

use serde_json::{Value, json};

use super::contest::{Entry, Events, Problem, Result};
use super::saltus::SERIES;

/// Of each solver and each way to find events, the fastest method; of saltus, which wants the flow
/// over jets for them, Taylor series beside it.
fn best<'a>(entries: &'a [Entry], results: &'a [Option<Result>]) -> Vec<(&'a Entry, Option<&'a Result>)> {
    let mut best: Vec<(&Entry, Option<&Result>)> = Vec::new();
    for (entry, result) in entries.iter().zip(results) {
        let kind = |entry: &Entry| (entry.solver, entry.events, entry.method == SERIES);
        let same = |other: &&mut (&Entry, Option<&Result>)| kind(other.0) == kind(entry);
        let faster = |old: Option<&Result>| {
            result.as_ref().is_some_and(|new| old.is_none_or(|old| new.quartiles[1] < old.quartiles[1]))
        };
        match best.iter_mut().find(same) {
            Some(other) if faster(other.1) => *other = (entry, result.as_ref()),
            Some(_) => {}
            None => best.push((entry, result.as_ref())),
        }
    }
    best
}

fn is_peer(entry: &Entry) -> bool {
    entry.solver != "saltus" && entry.solver != "floor"
}

/// Seconds with three digits.
pub fn time(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 1e-6 => (s * 1e9, "ns"),
        s if s < 1e-3 => (s * 1e6, "µs"),
        s if s < 1.0 => (s * 1e3, "ms"),
        s => (s, "s"),
    };
    let digits = (2.0 - value.log10().floor()).clamp(0.0, 2.0) as usize;
    format!("{value:.digits$} {unit}")
}

/// A ratio with two or three digits.
pub fn ratio(a: f64, b: f64) -> String {
    let ratio = a / b;
    if ratio < 10.0 { format!("{ratio:.2}") } else { format!("{ratio:.0}") }
}

/// The rows of one problem at one bound.
pub fn table(problem: &Problem, bound: f64, results: &[Option<Result>]) -> String {
    let rows = best(&problem.entries, results);
    let median = |result: &Result| result.quartiles[1];
    let fastest = |wanted: &dyn Fn(&Entry) -> bool| {
        rows.iter()
            .filter(|(entry, _)| wanted(entry))
            .filter_map(|(_, result)| result.map(median))
            .min_by(f64::total_cmp)
    };
    let (peer, floor) = (fastest(&is_peer), fastest(&|entry| entry.solver == "floor"));
    let mut text = format!("\n### {}, error at most {bound:e}\n\n", problem.title);
    text += "| solver | method | crossings | rtol = atol | error | flows | CPU time | quartiles | to best peer | to floor |\n";
    text += "|---|---|---|---|---|---|---|---|---|---|\n";
    let mut rows = rows.clone();
    let key = |result: Option<&Result>| result.map_or(f64::INFINITY, median);
    rows.sort_by(|a, b| key(a.1).total_cmp(&key(b.1)));
    for (entry, result) in rows {
        let Entry { solver, method, events, tolerant, .. } = entry;
        let Some(Result { trial, quartiles: [low, middle, high] }) = result else {
            text +=
                &format!("| {solver} | {} | {} | | not in 0.1 s | | | | | |\n", any(*events, method), events.name());
            continue;
        };
        let tolerance = if *tolerant { format!("{:.0e}", trial.tolerance) } else { String::new() };
        let flows = if trial.flows > 0 { trial.flows.to_string() } else { String::new() };
        let against = |other: Option<f64>| other.map_or(String::new(), |other| ratio(*middle, other));
        text += &format!(
            "| {solver} | {method} | {} | {tolerance} | {:.1e} | {flows} | {} | {} to {} | {} | {} |\n",
            events.name(),
            trial.error,
            time(middle / problem.per),
            time(low / problem.per),
            time(high / problem.per),
            against(peer),
            against(floor),
        );
    }
    text
}

/// Which method was tried in vain: any of them.
fn any(events: Events, method: &'static str) -> &'static str {
    if events == Events::Formula { method } else { "any" }
}

pub fn json(problem: &Problem, bound: f64, results: &[Option<Result>]) -> Value {
    let rows = problem.entries.iter().zip(results).map(|(entry, result)| {
        json!({
            "solver": entry.solver,
            "method": entry.method,
            "crossings": entry.events.name(),
            "tolerance": result.as_ref().filter(|_| entry.tolerant).map(|result| result.trial.tolerance),
            "error": result.as_ref().map(|result| result.trial.error),
            "flows": result.as_ref().map(|result| result.trial.flows),
            "seconds": result.as_ref().map(|result| result.quartiles[1]),
            "quartiles": result.as_ref().map(|result| [result.quartiles[0], result.quartiles[2]]),
        })
    });
    json!({ "problem": problem.name, "bound": bound, "rows": rows.collect::<Vec<_>>() })
}
