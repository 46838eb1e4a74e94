//! The part of the report for people that shows recordings impact by impact, and the models tried on them.

use std::fmt::{self, Formatter};

use super::Report;
use super::text::{decimals, digits, figures, pair};
use crate::choice::{ModelChoice, UnderLoss};
use crate::series::Track;

/// More impacts than this are left to the JSON.
const IMPACTS: usize = 12;
/// More models than this are left to the JSON.
const MODELS: usize = 6;
/// Gravity within this part of the expected means that heights are in metres and times in seconds.
pub(super) const METRES: f64 = 0.2;

/// Writes the impacts of each recording and the models.
pub(super) fn write(report: &Report, f: &mut Formatter<'_>) -> fmt::Result {
    let several = report.series.len() > 1;
    let impacts = || report.series.iter().flat_map(|t| t.impacts.iter().map(|i| (t.trial, i)));
    if impacts().next().is_some() {
        writeln!(f, "\n  impact        speed   COR")?;
    }
    for (trial, impact) in impacts().take(IMPACTS) {
        let of = if several { format!("(trial {})", trial + 1) } else { String::new() };
        let cor = pair(impact.cor.value, impact.cor.standard_error);
        let line = format!("  {:<8}{:>11}   {cor:<16} {of}", impact.bounce, speed(report, impact.speed));
        writeln!(f, "{}", line.trim_end())?;
    }
    if let more @ 1.. = impacts().count().saturating_sub(IMPACTS) {
        writeln!(f, "  and {more} more: see --format json")?;
    }
    if report.models.len() > 1 {
        writeln!(f, "\nModels, the best first (a greater BIC is worse; by six, clearly)")?;
        let shown = |(n, m): &(usize, &ModelChoice)| *n < MODELS || m.chosen;
        for (_, model) in report.models.iter().enumerate().filter(shown) {
            let chosen = if model.chosen { "   chosen" } else { "" };
            let cor = pair(model.cor.value, model.cor.standard_error);
            writeln!(f, "  {:<44}{cor:>18}   BIC {:>+7.1}{chosen}", model.about, model.bic)?;
            for under in &model.losses {
                let places = digits(model.cor.standard_error);
                let value = format!("{:.places$}", under.cor);
                // Below the value of the line above, whose error takes so much more.
                let gap = places + 5;
                let line = format!(
                    "    {:<42}{value:>width$}{:gap$}   {}",
                    loss(&under.loss),
                    "",
                    beside(under),
                    width = 18 - gap
                );
                writeln!(f, "{}", line.trim_end())?;
            }
        }
    }
    if let [track] = report.series.as_slice() {
        motion(report, track, f)?;
    }
    Ok(())
}

fn loss(name: &str) -> &str {
    match name {
        "huber" => "by Huber's loss",
        "absolute" => "by the sum of |r|",
        _ => "by the largest |r|",
    }
}

/// What a model gives beside a COR under another loss.
fn beside(under: &UnderLoss) -> String {
    let all = [
        under.slope.map(|slope| format!("{slope:+.4} per m/s")),
        under.exponent.map(|p| format!("v^-{p:.3}")),
        under.drag.map(|drag| format!("drag {drag:.4}/m")),
        under.offset_m.map(|offset| format!("zero off by {:.1} mm", 1000.0 * offset)),
    ];
    all.into_iter().flatten().collect()
}

fn metres(report: &Report, track: &Track) -> bool {
    (track.gravity.value / report.gravity.value - 1.0).abs() < METRES
}

fn speed(report: &Report, speed: f64) -> String {
    match report.series.first() {
        Some(track) if metres(report, track) => format!("{speed:.2} m/s"),
        _ => format!("{} /s", figures(speed)),
    }
}

/// Gravity, drag and what is left between motion and samples, for a single recording.
fn motion(report: &Report, track: &Track, f: &mut Formatter<'_>) -> fmt::Result {
    let unit = if metres(report, track) { "m/s\u{b2}" } else { "per s\u{b2}" };
    let (g, error) = (track.gravity.value, track.gravity.standard_error);
    let digits = decimals(0, error);
    write!(f, "\n  {} samples; gravity {g:.digits$} ± {error:.digits$} {unit}", track.samples)?;
    if let Some(drag) = track.drag {
        let per = if metres(report, track) { "/m" } else { " per unit of height" };
        write!(f, "; drag k = {} ± {}{per}", figures(drag.value), figures(drag.standard_error))?;
    }
    let unit = if metres(report, track) { " m" } else { " in the unit of heights" };
    writeln!(f, "; rms {}{unit} (from sample to sample {})", figures(track.rms), figures(track.noise))
}
