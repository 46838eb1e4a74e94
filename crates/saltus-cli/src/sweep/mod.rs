//! `saltus sweep`: a scene in, a table of many runs out.

mod args;
mod parquet;
mod parts;
mod table;

use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;

pub(crate) use args::Sweep as SweepArgs;
use rayon::{ThreadPool, ThreadPoolBuilder};
use saltus_scene::sweep::{RowFormat, Sweep};
use saltus_scene::vary::Vary;
use serde_json::{Value as Json, json};
use table::Table;

use crate::error::Error;
use crate::output::{self, extension, say};
use crate::progress::Progress;
use crate::scenes::{ending, note, read};

/// The most runs that a picture shows: a map of them is a few megabytes.
const MOST_DRAWN: u64 = 100_000;

pub(crate) fn run(args: &SweepArgs, quiet: bool) -> Result<ExitCode, Error> {
    let format = format(args)?;
    output::check_apart(args.output.as_deref(), &args.scene)?;
    let (name, toml) = read(&args.scene)?;
    let vary = args.vary.vary()?;
    let end = ending(args.until, args.most_jumps);
    // An error in the first run is one of the sweep, and ends it before anything is written.
    let sweep = Sweep::new(&name, &toml, &vary, end, format, args.columns.as_deref()).map_err(Error::new)?;
    if let Some(note) = note(sweep.first()) {
        say(quiet, &note);
    }
    let runs = sweep.runs();
    let pool = pool(args)?;
    if let Some(folder) = &args.into {
        return pool.install(|| parts::run(args, folder, &sweep, quiet));
    }
    check_plot(args, &sweep)?;
    let whose = whose(args, &toml, &sweep, &vary, format);
    let (mut table, done) = Table::open(args, &sweep, &whose)?;
    if done > 0 {
        say(
            quiet,
            &format!("going on behind run {}: {} of {runs} are to be made", done - 1, runs.saturating_sub(done)),
        );
    }

    let mut rows = if args.plot.is_some() { table.before(&sweep, done)? } else { Vec::new() };
    let mut progress = Progress::new(runs, quiet);
    let mut nothing = (0_u64, None);
    let left = usize::try_from(done).map_err(Error::new)?..usize::try_from(runs).map_err(Error::new)?;
    let ended = pool.install(|| {
        saltus::ensemble(
            left,
            |k| sweep.row(k as u64),
            |k, row| {
                if let Some(why) = &row.why {
                    nothing.0 += 1;
                    nothing.1.get_or_insert_with(|| (k, why.clone()));
                }
                progress.reached(k as u64 + 1);
                let pushed = table.push(&row.text);
                if args.plot.is_some() {
                    rows.push(row);
                }
                match pushed {
                    Ok(()) => ControlFlow::Continue(()),
                    Err(error) => ControlFlow::Break(error),
                }
            },
        )
    });
    progress.clear();
    if let ControlFlow::Break(error) = ended {
        return Err(error);
    }
    table.finish()?;
    if let (count, Some((first, why))) = nothing {
        let values = vary.says(first as u64);
        say(quiet, &format!("{count} of {runs} runs came to nothing; the first is run {first}, {values}: {why}"));
    }
    if let Some(path) = &args.plot {
        let svg = saltus_plot::sweep::svg(&sweep, &rows, args.show.as_deref()).map_err(Error::new)?;
        output::write(Some(path), svg.as_bytes())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The threads of the runs.
fn pool(args: &SweepArgs) -> Result<ThreadPool, Error> {
    let pool = ThreadPoolBuilder::new().num_threads(args.threads.map_or(0, usize::from));
    pool.build().map_err(|error| Error::new(format!("cannot start that many threads: {error}")))
}

/// Refuses a picture that cannot be drawn or written, before any run is made.
fn check_plot(args: &SweepArgs, sweep: &Sweep<'_>) -> Result<(), Error> {
    let Some(plot) = args.plot.as_deref() else { return Ok(()) };
    let dash = Path::new("-");
    if plot == dash && args.output.as_deref().is_none_or(|path| path == dash) {
        return Err(Error::new("the picture and the table cannot both go to standard output: name a file for one"));
    }
    output::check_picture(Some(plot))?;
    output::check_folder(plot)?;
    saltus_plot::sweep::check(sweep, args.show.as_deref()).map_err(Error::new)?;
    match sweep.runs() {
        ..=MOST_DRAWN => Ok(()),
        runs => Err(Error::new(format!(
            "a picture shows {MOST_DRAWN} runs at most, and these are {runs}: vary in fewer steps, or leave out --plot"
        ))),
    }
}

/// The identity of a file: all that its rows depend on.
fn whose(args: &SweepArgs, toml: &[u8], sweep: &Sweep<'_>, vary: &Vary, format: RowFormat) -> Json {
    json!({
        "saltus": env!("CARGO_PKG_VERSION"),
        "vary": vary.texts(),
        "random": vary.random,
        "seed": vary.random.map(|_| vary.seed),
        "runs": sweep.runs(),
        "until_s": args.until.map(|until| until.to_string()),
        "most_jumps": args.most_jumps,
        "format": format.name(),
        "columns": sweep.headers(),
        "scene": String::from_utf8_lossy(toml),
    })
}

/// The format by name, or by the extension of the file.
fn format(args: &SweepArgs) -> Result<RowFormat, Error> {
    let extension = args.output.as_deref().and_then(extension);
    match (args.format, extension.as_deref()) {
        (Some(format), _) => {
            let name = format.name();
            output::check_extension(args.output.as_deref(), name, name, &["csv", "jsonl"])?;
            Ok(format)
        }
        (None, None | Some("csv")) => Ok(RowFormat::Csv),
        (None, Some("jsonl" | "ndjson")) => Ok(RowFormat::Jsonl),
        (None, Some("json")) => {
            Err(Error::new("a sweep is written row by row, an object in each line: use .jsonl, or say --format jsonl"))
        }
        (None, Some(other)) => {
            Err(Error::new(format!("no format goes by the extension '.{other}': use .csv or .jsonl, or say --format")))
        }
    }
}
