//! `saltus fit --each`: many files, each an experiment of its own, a line each.

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};
use serde_json::json;

use super::args;
use crate::error::Error;
use crate::output::{say, write};
use crate::parse::ReportFormat;

/// The names of what stands in a line.
const NAMES: &str = "file,group,cor,standard_error,low,high,verdict,reason\n";

/// Fits every file by itself, several at once; the lines stand in the order of the files.
pub(super) fn run(args: &args::Fit, options: &ReadOptions, fit: &Fit, quiet: bool) -> Result<ExitCode, Error> {
    let start = Instant::now();
    let one = |path: &std::path::PathBuf| -> (String, Option<Verdict>) {
        let report = Table::read(path, options).map_err(Error::data).and_then(|t| fit.run(&t).map_err(Error::data));
        let verdict = report.as_ref().ok().map(Report::verdict);
        let text = match args.format {
            ReportFormat::Text => lines(path, &report),
            ReportFormat::Json => object(path, &report),
        };
        (text, verdict)
    };
    let all: Vec<(String, Option<Verdict>)> = args.tables.par_iter().map(one).collect();
    let names = if args.format == ReportFormat::Text { NAMES } else { "" };
    let text = all.iter().fold(names.to_owned(), |text, (line, _)| text + line);
    write(args.output.as_deref(), text.as_bytes())?;
    let of = |wanted: Option<Verdict>| all.iter().filter(|(_, verdict)| *verdict == wanted).count();
    let [trusted, doubtful, refused] = [Verdict::Trusted, Verdict::Doubtful, Verdict::Refused].map(|v| of(Some(v)));
    let (lasts, count) = (start.elapsed().as_secs_f64(), all.len());
    #[allow(clippy::cast_precision_loss)] // a count of files
    let rate = count as f64 / lasts.max(f64::EPSILON);
    say(
        quiet,
        &format!(
            "{count} tables in {lasts:.2} s, {rate:.0} a second: {trusted} trusted, {doubtful} doubtful, {refused} refused, {} not read",
            of(None)
        ),
    );
    Ok(if args.strict && trusted < count { ExitCode::from(1) } else { ExitCode::SUCCESS })
}

/// A line for each group of a report, or for the reason why there is none.
fn lines(path: &Path, report: &Result<Report, Error>) -> String {
    let file = path.display().to_string();
    let line = |group: &str, cor: [String; 4], verdict: &str, reason: &str| {
        let words = [file.as_str(), group, verdict, reason].map(quoted);
        format!("{},{},{},{},{}\n", words[0], words[1], cor.join(","), words[2], words[3])
    };
    let of = |group: &str, report: &Report| {
        let cor = report.cor().map_or_else(Default::default, |cor| {
            let error = cor.standard_error.map_or_else(String::new, |error| format!("{error:.5}"));
            [format!("{:.5}", cor.value), error, format!("{:.5}", cor.low), format!("{:.5}", cor.high)]
        });
        line(group, cor, &report.verdict().to_string(), report.reason())
    };
    match report {
        Ok(report) if report.groups().is_empty() => of("", report),
        Ok(report) => report.groups().iter().map(|group| of(&group.name, &group.report)).collect(),
        Err(error) => line("", Default::default(), "not read", error.message().lines().next().unwrap_or_default()),
    }
}

/// The report of a file as an object in a line.
fn object(path: &Path, report: &Result<Report, Error>) -> String {
    let file = path.display().to_string();
    let object = match report {
        Ok(report) => json!({ "file": file, "report": report }),
        Err(error) => json!({ "file": file, "error": error.as_data() }),
    };
    format!("{object}\n")
}

/// A cell of a table that commas part.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
