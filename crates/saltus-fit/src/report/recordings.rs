//! The part of the report for people that shows recordings impact by impact, and the models tried
//! on them.

use std::fmt::{self, Formatter};

use super::contract::Report;
use super::lines::paragraph;
use super::numbers::{digits, figures, measured, pair};
use super::words::loss_words;
use crate::solve::choice::{ModelChoice, UnderLoss};
use crate::solve::series::Track;

/// More impacts than this are left to the JSON.
const IMPACTS: usize = 12;
/// More models than this are left to the JSON.
const MODELS: usize = 6;
/// An error that differs by more, as a part of it, is another.
const ANOTHER: f64 = 0.1;

/// Writes the impacts of each recording and the models.
pub(super) fn write(report: &Report, f: &mut Formatter<'_>) -> fmt::Result {
    let several = report.series.len() > 1;
    let impacts = || report.series.iter().flat_map(|t| t.impacts.iter().map(move |i| (t, i)));
    if impacts().next().is_some() {
        writeln!(f, "\n  impact        speed   COR")?;
    }
    for (track, impact) in impacts().take(IMPACTS) {
        let of = if several { format!("(trial {})", track.trial + 1) } else { String::new() };
        let cor = pair(impact.cor.value, impact.cor.standard_error);
        let line = format!("  {:<8}{:>11}   {cor:<16} {of}", impact.bounce, speed(report, track, impact.speed));
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
            writeln!(f, "  {:<46} {cor:>17}   BIC {:>+7.1}{chosen}", model.about, model.bic)?;
            for under in &model.losses {
                let places = digits(model.cor.standard_error);
                let value = format!("{:.places$}", under.cor);
                // Below the value of the line above, whose error takes so much more.
                let gap = places + 5;
                let line = format!(
                    "    {:<44}{value:>width$}{:gap$}   {}",
                    format!("by {}", loss_words(under.loss)),
                    "",
                    beside(under),
                    width = 18 - gap
                );
                writeln!(f, "{}", line.trim_end())?;
            }
        }
    }
    if report.models.len() > 1 && errors_differ(report) {
        let text = "(The \u{b1} of a model follows from the reading errors alone; that of the COR above also from how far trials or readings \
                        are apart beyond them.)";
        paragraph(f, 2, 2, text)?;
    }
    if !report.series.is_empty() {
        writeln!(f)?;
    }
    for track in report.series.iter().take(IMPACTS) {
        paragraph(f, 2, 4, &motion(report, track, several))?;
    }
    if let more @ 1.. = report.series.len().saturating_sub(IMPACTS) {
        writeln!(f, "  and {more} more recordings: see --format json")?;
    }
    Ok(())
}

/// Whether the chosen model has another error than the COR that is reported.
fn errors_differ(report: &Report) -> bool {
    let chosen = report.models.iter().find(|m| m.chosen).map(|m| m.cor.standard_error);
    let reported = report.cor.and_then(|cor| cor.standard_error);
    chosen.zip(reported).is_some_and(|(a, b)| (a - b).abs() > ANOTHER * a.max(b))
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

/// What the recording's lengths are measured in.
fn unit(report: &Report, track: &Track) -> &'static str {
    match (track.in_metres(report.gravity.value), report.pixels) {
        (true, _) => "m",
        (false, true) => "px",
        (false, false) => "units",
    }
}

fn speed(report: &Report, track: &Track, speed: f64) -> String {
    match unit(report, track) {
        "m" => format!("{speed:.2} m/s"),
        unit => format!("{} {unit}/s", figures(speed)),
    }
}

/// Gravity, drag and what is left between motion and samples.
fn motion(report: &Report, track: &Track, several: bool) -> String {
    let unit = unit(report, track);
    let of = if several { format!("Trial {}: ", track.trial + 1) } else { String::new() };
    let gravity = measured(track.gravity.value, track.gravity.standard_error);
    let drag = track.drag.map_or_else(String::new, |drag| {
        let drag = measured(drag.value, drag.standard_error);
        if unit == "units" { format!("; drag k = {drag} per unit") } else { format!("; drag k = {drag} /{unit}") }
    });
    let contact = track.contact.map_or_else(String::new, |contact| {
        format!("; impacts last {} ms", measured(1e3 * contact.value, 1e3 * contact.standard_error))
    });
    let (samples, rms) = (track.samples, figures(track.rms));
    let noise = if several { String::new() } else { format!(" (from sample to sample {})", figures(track.noise)) };
    format!("{of}{samples} samples; gravity {gravity} {unit}/s\u{b2}{drag}{contact}; rms {rms} {unit}{noise}")
}
