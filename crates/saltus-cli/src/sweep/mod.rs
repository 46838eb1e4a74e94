//! `saltus sweep`: a scene in, a table of many runs out.

mod args;
mod row;
mod table;

use std::fmt;
use std::ops::ControlFlow;
use std::process::ExitCode;

use args::RowFormat;
pub(crate) use args::Sweep;
use rayon::ThreadPoolBuilder;
use row::{Nothing, Rows};
use saltus_scene::{Run, Template};
use serde_json::{Value as Json, json};
use table::Table;

use crate::error::Error;
use crate::output::{extension, say};
use crate::progress::Progress;
use crate::quantity::number;
use crate::simulate::{ending, note, read};
use crate::vary::{self, Variation, Vary};

pub(crate) fn run(args: &Sweep, quiet: bool) -> Result<ExitCode, Error> {
    let format = format(args)?;
    let (name, toml) = read(&args.scene)?;
    let keys = args.vary.keys()?;
    let runs = args.vary.runs()?;
    let template = Template::parse(&name, &toml, &keys).map_err(Error::new)?;
    let runner = Runner { template: &template, vary: &args.vary, end: ending(args.until, args.most_jumps) };

    // What is wrong with the first run is wrong with the sweep, and is said before anything is written.
    let refused = |error: &dyn fmt::Display| Error::new(format!("run 0, {}: {error}", args.vary.says(0)));
    let scene = vary::scene(&template, &args.vary.values(0), runner.end).map_err(|error| refused(&error))?;
    scene.plan().map_err(|error| refused(&error))?;
    if let Some(note) = note(&scene) {
        say(quiet, &note);
    }

    let rows = Rows::new(
        format,
        args.vary.variations.iter().map(Variation::header).collect(),
        args.columns.as_deref(),
        &scene,
    );
    let (mut table, done) = Table::open(args, &rows, &whose(args, &toml, &rows, runs))?;
    if done > 0 {
        say(
            quiet,
            &format!("going on behind run {}: {} of {runs} are to be made", done - 1, runs.saturating_sub(done)),
        );
    }

    let mut pool = ThreadPoolBuilder::new();
    if let Some(threads) = args.threads {
        pool = pool.num_threads(threads.into());
    }
    let pool = pool.build().map_err(|error| Error::new(format!("cannot start that many threads: {error}")))?;
    let mut progress = Progress::new(runs, quiet);
    let mut nothing = (0_u64, None);
    let left = usize::try_from(done).map_err(Error::new)?..usize::try_from(runs).map_err(Error::new)?;
    let ended = pool.install(|| {
        saltus::ensemble(
            left,
            |k| runner.row(&rows, k as u64),
            |k, (row, why)| {
                if let Some(why) = why {
                    nothing.0 += 1;
                    nothing.1.get_or_insert((k, why));
                }
                progress.reached(k as u64 + 1);
                match table.push(&row) {
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
        let values = args.vary.says(first as u64);
        say(quiet, &format!("{count} of {runs} runs came to nothing; the first is run {first}, {values}: {why}"));
    }
    Ok(ExitCode::SUCCESS)
}

/// Makes runs by their numbers.
struct Runner<'a> {
    template: &'a Template<'a>,
    vary: &'a Vary,
    end: Run,
}

impl Runner<'_> {
    /// The row of a run, and why it came to nothing if it did.
    fn row(&self, rows: &Rows, run: u64) -> (String, Option<String>) {
        let values = self.vary.values(run);
        let nothing = |end: &'static str, why: String| Nothing { end, why: why.replace('\n', " ") };
        let came = vary::scene(self.template, &values, self.end)
            .map_err(|error| nothing("refused", vary::refused(&error)))
            .and_then(|scene| scene.plan().map_err(|error| nothing("refused", error.to_string())))
            .and_then(|plan| plan.outcome().map_err(|error| nothing("failed", error.to_string())));
        let row = rows.row(run, &values, &came);
        (row, came.err().map(|nothing| nothing.why))
    }
}

/// What the rows of a file depend on.
fn whose(args: &Sweep, toml: &[u8], rows: &Rows, runs: u64) -> Json {
    json!({
        "saltus": env!("CARGO_PKG_VERSION"),
        "vary": args.vary.texts(),
        "random": args.vary.random,
        "seed": args.vary.random.map(|_| args.vary.seed),
        "runs": runs,
        "until_s": args.until.map(number),
        "most_jumps": args.most_jumps,
        "format": match rows.format { RowFormat::Csv => "csv", RowFormat::Jsonl => "jsonl" },
        "columns": rows.headers(),
        "scene": String::from_utf8_lossy(toml),
    })
}

/// The format by name, or by the extension of the file.
fn format(args: &Sweep) -> Result<RowFormat, Error> {
    let extension = args.output.as_deref().and_then(extension);
    match (args.format, extension.as_deref()) {
        (Some(format), _) => Ok(format),
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
