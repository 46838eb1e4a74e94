//! The report for people: the verdict first, the COR next, then what it rests on, what contradicts
//! it, what to measure.

use std::fmt::{self, Formatter};

use super::contract::Report;
use super::groups;
use super::lines::{capital, paragraph, section, sentence};
use super::numbers::{digits, duration, figures, length, measured, number, pair, signed};
use super::recordings;
use super::words::{chance, method_short, short, widening};
use crate::compare::explain::{Agreement, Conflict, Generous, Hypothesis};
use crate::quantity::{Measured, Method, Readings, Source, Sourced};
use crate::solve::bounces::BounceCor;
use crate::solve::estimate::Estimate;
use crate::statistics::REJECT;
use crate::verdict::Cor;

/// Tables of more bounces than this are left to the JSON.
const BOUNCES: usize = 12;
/// An interval whose sides differ by less, as a part of it, is even enough.
const LOPSIDED: f64 = 0.1;
/// So many conflicting contacts are shown.
const CONFLICTS: usize = 6;

/// The COR and its standard error, with as many digits as that leaves it: `0.7812 ± 0.0009`.
impl fmt::Display for Cor {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.standard_error {
            Some(error) => f.write_str(&pair(self.value, error)),
            None => write!(f, "{:.3}", self.value),
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write(self, f)
    }
}

/// Writes the report.
fn write(report: &Report, f: &mut Formatter<'_>) -> fmt::Result {
    writeln!(f, "{}: {}", report.table, report.verdict.to_string().to_uppercase())?;
    paragraph(f, 2, 2, &sentence(&report.reason))?;
    if !report.groups.is_empty() {
        return groups::write(report, f);
    }
    if let Some(cor) = &report.cor {
        writeln!(f, "\n  COR  {}", headline(report, cor))?;
        if let Some(text) = lopsided(report, cor) {
            paragraph(f, 7, 7, &text)?;
        }
    }
    bounces(report, f)?;
    recordings::write(report, f)?;
    if report.agreement.as_ref().is_some_and(Agreement::rejected) {
        if let Some(agreement) = &report.agreement {
            disagreement(report, agreement, f)?;
        }
        explanations(report, f)?;
    } else {
        methods(report, f)?;
        explanations(report, f)?;
    }
    allowed(report, f)?;
    if let Some(b) = &report.bootstrap {
        let digits = digits(b.standard_error);
        writeln!(
            f,
            "\nBootstrap of whole trials, {} rounds, seed {}: ± {:.digits$}, 95 % from {:.digits$} to {:.digits$}",
            b.rounds, b.seed, b.standard_error, b.low, b.high
        )?;
    }
    section(f, "Left out or mended", &report.repairs)?;
    let mut mind = report.agreement.as_ref().filter(|a| a.rejected()).map_or_else(Vec::new, |a| caveats(report, a));
    mind.extend(report.warnings.iter().map(|w| capital(w)));
    section(f, "Keep in mind", &mind)?;
    let aside: Vec<String> = report.left_aside.iter().map(ToString::to_string).collect();
    section(f, "Left aside", &aside)?;
    let next: Vec<String> = report.next.iter().map(ToString::to_string).collect();
    section(f, "What would settle it", &next)?;
    if let Some(plan) = &report.plan {
        write!(f, "\n{plan}")?;
    }
    footer(report, f)
}

impl Report {
    /// The COR as the report for people states it, with its interval, in a line; `None` where there
    /// is none.
    ///
    /// ```
    /// let table = saltus_fit::Table::from_heights(&[1.0, 0.64, 0.41])?;
    /// let report = saltus_fit::Fit::new().run(&table)?;
    /// assert!(report.headline().is_some_and(|line| line.contains("95 % interval")));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn headline(&self) -> Option<String> {
        self.cor.as_ref().map(|cor| headline(self, cor))
    }
}

fn headline(report: &Report, cor: &Cor) -> String {
    match cor.standard_error {
        Some(_) if report.agreement.as_ref().is_some_and(Agreement::rejected) => {
            format!("between {:.2} and {:.2}: the table does not settle on one number", cor.low, cor.high)
        }
        Some(error) => {
            let digits = digits(error);
            format!("{}   (95 % interval {:.digits$} to {:.digits$})", pair(cor.value, error), cor.low, cor.high)
        }
        None => format!("at most {:.2}", cor.high),
    }
}

fn cell(cor: Option<Measured>) -> String {
    cor.map_or_else(|| "-".to_owned(), |m| pair(m.value, m.standard_error))
}

/// Why the interval reaches further to one side of the COR, where it does.
fn lopsided(report: &Report, cor: &Cor) -> Option<String> {
    let (below, above) = (cor.value - cor.low, cor.high - cor.value);
    let settled = cor.standard_error.is_some() && !report.agreement.as_ref().is_some_and(Agreement::rejected);
    let even = (above - below).abs() < LOPSIDED * (above + below);
    if !settled || even && report.widened.is_empty() {
        return None;
    }
    let side = match above > below {
        _ if even => "than the scatter of the readings",
        true => "upwards",
        false => "downwards",
    };
    if report.widened.is_empty() {
        return (cor.low <= 0.0).then(|| "The interval ends at 0, below which there is no COR.".to_owned());
    }
    Some(format!(
        "The interval is longer {side}: {}.",
        report.widened.iter().map(widening).collect::<Vec<_>>().join("; ")
    ))
}

/// The COR bounce by bounce, for small tables.
fn bounces(report: &Report, f: &mut Formatter<'_>) -> fmt::Result {
    let list = &report.bounces;
    if list.is_empty() || list.len() > BOUNCES {
        return Ok(());
    }
    let heights = list.iter().any(|b| b.heights.is_some());
    let times = list.iter().any(|b| b.times.is_some());
    writeln!(f)?;
    let mut row = |name: &str, h: &str, t: &str| {
        let mut line = format!("  {name:<10}");
        if heights {
            line.push_str(&format!("  {h:>17}"));
        }
        if times {
            line.push_str(&format!("  {t:>17}"));
        }
        writeln!(f, "{line}")
    };
    row("COR of", "from heights", "from times")?;
    for BounceCor { bounce, heights, times } in list {
        row(&format!("bounce {bounce}"), &cell(*heights), &cell(*times))?;
    }
    let mean = |method: Method| {
        let found = report.estimates.iter().find(|e| e.method == method)?;
        found.value.zip(found.standard_error).map(|(value, standard_error)| Measured { value, standard_error })
    };
    let (h, t) = (mean(Method::HeightsMean), mean(Method::TimesMean));
    if h.is_some() || t.is_some() {
        row("mean", &cell(h), &cell(t))?;
    }
    if list.iter().any(|b| b.bounce == 1 && b.times.is_some()) {
        writeln!(f, "  (bounce 1 from times: the first flight over twice the fall from the release height)")?;
    }
    Ok(())
}

/// The least-squares fits and how well they describe the readings.
fn methods(report: &Report, f: &mut Formatter<'_>) -> fmt::Result {
    let aside = [Method::HeightsMean, Method::TimesMean, Method::Series, Method::SeriesDrag];
    let shown = |e: &&Estimate| !aside.contains(&e.method);
    if !report.estimates.iter().any(|e| shown(&e)) {
        return Ok(());
    }
    writeln!(f, "\nBy method")?;
    for estimate in report.estimates.iter().filter(shown) {
        let (name, loss) = (method_short(estimate.method), estimate.method.loss());
        let value = match (estimate.value, estimate.standard_error) {
            (Some(value), Some(error)) => pair(value, error),
            (Some(value), None) if loss.is_some() => format!("{value:.4}"),
            (Some(value), None) => format!("{value:.3}, at its bound"),
            _ => "-".to_owned(),
        };
        let mut line = format!("  {name:<26}{value:>18}");
        if let (Some(chi_square), Some(freedom), Some(p)) =
            (estimate.chi_square, estimate.degrees_of_freedom, estimate.p)
        {
            line.push_str(&format!("   chi-square {} on {freedom}, p {}", number(chi_square), chance(p)));
        } else if estimate.degrees_of_freedom.is_some_and(|n| n > 0) && estimate.standard_error.is_some() {
            line.push_str("   error from the scatter");
        }
        if estimate.trials > 1 {
            line.push_str(&format!("   {} trials", estimate.trials));
        }
        writeln!(f, "{line}")?;
    }
    Ok(())
}

/// The CORs that tolerances allow.
fn allowed(report: &Report, f: &mut Formatter<'_>) -> fmt::Result {
    let lines: Vec<String> = report
        .allowed
        .iter()
        .map(|a| {
            let shown = |x: f64| if a.readings == Readings::Heights { length(x) } else { duration(x) };
            match a.range {
                Some((low, high)) => format!(
                    "every one of the {} within {}: the COR is from {low:.4} to {high:.4} ({} would be enough for {:.4})",
                    a.readings,
                    shown(a.tolerance),
                    shown(a.smallest),
                    a.cor
                ),
                None => format!(
                    "no single COR explains the {} to within {}; the smallest tolerance that allows one is {}, with {:.4}",
                    a.readings,
                    shown(a.tolerance),
                    shown(a.smallest),
                    a.cor
                ),
            }
        })
        .collect();
    section(f, "At the stated precision", &lines)
}

/// What a joint fit shows when it fails.
fn disagreement(report: &Report, agreement: &Agreement, f: &mut Formatter<'_>) -> fmt::Result {
    let Some(joint) = report.estimates.iter().find(|e| e.method == Method::Joint) else { return Ok(()) };
    writeln!(f, "\nHeights and times together, in free flight with g = {} m/s²", report.gravity.value)?;
    let p = agreement.p.unwrap_or(0.0);
    let text = format!(
        "One COR for all readings would be {:.3}, and is ruled out: chi-square {} on {} degrees of freedom, which chance alone \
         gives with p {}.",
        joint.value.unwrap_or(f64::NAN),
        number(agreement.chi_square),
        agreement.degrees_of_freedom,
        chance(p)
    );
    paragraph(f, 2, 2, &text)?;
    let frames = agreement.conflicts.iter().any(|c| c.frames.is_some());
    writeln!(f, "\n  contact      measured   from the heights          apart")?;
    let mut worst: Vec<_> = agreement.conflicts.iter().collect();
    if worst.len() > CONFLICTS {
        let size = |c: &&Conflict| (c.measured_s - c.predicted_s).abs();
        worst.sort_by(|a, b| size(b).total_cmp(&size(a)));
        worst.truncate(CONFLICTS);
    }
    for conflict in worst {
        let apart = match conflict.frames {
            Some(n) => format!("{n:+.1} frames"),
            None => format!("{:+.3} s", conflict.measured_s - conflict.predicted_s),
        };
        let trial = if report.trials > 1 { format!("  (trial {})", conflict.trial + 1) } else { String::new() };
        writeln!(
            f,
            "  {:<8} {:>9.3} s {:>16.3} s {apart:>14}{trial}",
            conflict.contact, conflict.measured_s, conflict.predicted_s
        )?;
    }
    if let (Some(s), true) = (agreement.largest_conflict_s, frames) {
        let frames = agreement.largest_conflict_frames.unwrap_or(0.0);
        writeln!(f, "  The largest conflict is {s:.3} s, or {frames:.1} frames.")?;
    }
    let implied: Vec<String> =
        agreement.flights.iter().take(CONFLICTS).map(|flight| format!("{:.1}", flight.gravity)).collect();
    if implied.len() > 1 {
        let text = format!(
            "To reach these heights in these times, g would have to be {} m/s² from flight to flight.",
            in_words(&implied)
        );
        paragraph(f, 2, 2, &text)?;
    }
    Ok(())
}

fn in_words(list: &[String]) -> String {
    match list {
        [] => String::new(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

/// Hypotheses: the one worth a measurement in full, the others in a line.
fn explanations(report: &Report, f: &mut Formatter<'_>) -> fmt::Result {
    // The best one may still be rejected at the errors stated; any other must not be.
    let good = report.hypotheses.iter().enumerate().take_while(|(n, h)| *n == 0 && h.fits() || h.p >= Some(REJECT));
    let (good, poor) = report.hypotheses.split_at(good.count());
    if report.hypotheses.is_empty() {
        return Ok(());
    }
    writeln!(f, "\nWhat could explain it")?;
    for hypothesis in good {
        paragraph(f, 2, 4, &format!("- {}", explanation(hypothesis)))?;
        paragraph(f, 4, 4, &format!("To find out: {}.", hypothesis.settle))?;
    }
    let named: Vec<String> = poor
        .iter()
        .map(|h| format!("{} (chi-square {} on {})", short(h.name), number(h.chi_square), h.degrees_of_freedom))
        .collect();
    if !named.is_empty() {
        let verb = if named.len() == 1 { "does" } else { "do" };
        paragraph(f, 2, 4, &format!("- {} {verb} not explain it.", capital(&in_words(&named))))?;
    }
    Ok(())
}

fn explanation(hypothesis: &Hypothesis) -> String {
    let mut text = match (hypothesis.offset_m, hypothesis.lag_s) {
        (Some(offset), _) => {
            let way = if offset.value > 0.0 { "high" } else { "low" };
            format!(
                "The zero of the height scale may be off: if every height is read {} cm too {way}",
                measured(100.0 * offset.value.abs(), 100.0 * offset.standard_error)
            )
        }
        (None, Some(lag)) => {
            format!("The clock may be off at the release, by {} s", signed(lag.value, lag.standard_error))
        }
        (None, None) if hypothesis.cors.is_empty() => {
            let mut text = capital(&hypothesis.about).replacen(" is ", " may be ", 1);
            if let Some(drag) = hypothesis.drag {
                text = format!("Air drag may slow the ball: with k = {} /m", measured(drag.value, drag.standard_error));
            }
            if let Some(slope) = hypothesis.slope {
                text = format!("The COR may depend on speed: by {} per m/s", signed(slope.value, slope.standard_error));
            }
            text
        }
        (None, None) => {
            let cors: Vec<String> = hypothesis.cors.iter().map(|e| format!("{e:.3}")).collect();
            format!("Every bounce may have a COR of its own: with {}", in_words(&cors))
        }
    };
    match hypothesis.cor {
        Some(cor) => text.push_str(&format!(
            ", one COR of {} gives chi-square {} on {} (p {})",
            pair(cor.value, cor.standard_error),
            number(hypothesis.chi_square),
            hypothesis.degrees_of_freedom,
            chance(hypothesis.p.unwrap_or(0.0))
        )),
        None => text.push_str(&format!(
            " chi-square is {} on {} (p {})",
            number(hypothesis.chi_square),
            hypothesis.degrees_of_freedom,
            chance(hypothesis.p.unwrap_or(0.0))
        )),
    }
    if let (Some(generous), true) = (&hypothesis.generous, hypothesis.p.is_some_and(|p| p < REJECT)) {
        text.push_str(&generously(generous));
    }
    text.push('.');
    text
}

fn generously(generous: &Generous) -> String {
    format!(
        ", and if the readings are only good to {} and {}, {} on {} (p {})",
        length(generous.sigma_height),
        duration(generous.sigma_time),
        number(generous.chi_square),
        generous.degrees_of_freedom,
        chance(generous.p.unwrap_or(0.0))
    )
}

/// What must not be concluded from a table whose columns contradict each other.
fn caveats(report: &Report, agreement: &Agreement) -> Vec<String> {
    let mut list = Vec::new();
    let value = |method: Method| report.estimates.iter().find(|e| e.method == method).and_then(|e| e.value);
    if let Some(total) = &agreement.total_time {
        let heights: Vec<String> = total.heights_m.iter().take(4).map(|h| figures(100.0 * h)).collect();
        list.push(format!(
            "That a total time agrees validates nothing: a COR of {:.3} also ends at {:.2} s, with rebounds of {} cm.",
            total.cor,
            total.time_s,
            in_words(&heights)
        ));
        // Rest comes after (1 + e)/(1 − e) falls.
        let fall = report.motions.first().and_then(|m| m.flights.first().map(|a| a.span)).unwrap_or(0.0);
        let rest = |e: f64| fall * (1.0 + e) / (1.0 - e);
        let cors = [Some(total.cor), value(Method::HeightsMean), value(Method::Joint), value(Method::TimesMean)];
        let ends: Vec<f64> = cors.into_iter().flatten().filter(|e| *e < 1.0).map(rest).collect();
        let (first, last) =
            (ends.iter().copied().fold(f64::INFINITY, f64::min), ends.iter().copied().fold(0.0, f64::max));
        if fall > 0.0 && last > first {
            list.push(format!(
                "Do not extrapolate to rest: depending on which COR is believed, the ball rests after {first:.2} s or {last:.2} s."
            ));
        }
    }
    list
}

/// Where the reading errors and gravity come from.
fn footer(report: &Report, f: &mut Formatter<'_>) -> fmt::Result {
    let from = |s: Sourced| match s.source {
        Source::Stated => "stated",
        Source::Table => "from the table",
        Source::FrameRate => "one frame / √12",
        Source::Scatter => "from the scatter",
        Source::Assumed => "assumed",
    };
    let mut parts = Vec::new();
    if let Some(s) = report.sigma_height {
        parts.push(format!("heights ± {} ({})", length(s.value), from(s)));
    }
    if let Some(s) = report.sigma_time {
        parts.push(format!("times ± {} ({})", duration(s.value), from(s)));
    }
    if parts.is_empty() {
        return Ok(());
    }
    parts.push(format!("g = {} m/s² ({})", report.gravity.value, from(report.gravity)));
    writeln!(f)?;
    paragraph(f, 0, 2, &format!("Readings: {}.", parts.join(", ")))
}
