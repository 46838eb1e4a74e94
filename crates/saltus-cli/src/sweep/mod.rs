//! `saltus sweep`: a scene in, a table of many runs out.

mod args;
mod row;
mod table;
mod vary;

use std::fmt;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

pub(crate) use args::Sweep;
use args::{MOST_RUNS, RowFormat};
use indicatif::ProgressBar;
use rayon::ThreadPoolBuilder;
use row::{Nothing, Rows};
use saltus_bounce::scene::{Run, Scene, SceneError, Template};
use serde_json::{Value as Json, json};
use table::Table;
use vary::{Plan, Value, Variation};

use crate::error::Error;
use crate::output::say;
use crate::simulate::{ending, note, read};

pub(crate) fn run(args: &Sweep, quiet: bool) -> Result<ExitCode, Error> {
    let format = format(args)?;
    let (name, toml) = read(&args.scene)?;
    let keys: Vec<&str> = args.variations.iter().map(|variation| variation.key.as_str()).collect();
    if let Some(twice) = keys.iter().enumerate().find(|(n, key)| keys[..*n].contains(key)) {
        return Err(Error::new(format!("`{}` varies twice: keep one --vary of it", twice.1)));
    }
    let (plan, runs) = plan(args)?;
    let template = Template::parse(&name, &toml, &keys).map_err(Error::new)?;
    let end = ending(args.until, args.most_jumps);
    let runner = Runner { template: &template, variations: &args.variations, plan: &plan, end };

    // What is wrong with the first run is wrong with the sweep, and is said before anything is written.
    let values = runner.values(0);
    let refused = |error: &dyn fmt::Display| Error::new(format!("run 0, {}: {error}", runner.says(&values)));
    let scene = runner.scene(&values).map_err(|error| refused(&error))?;
    scene.plan().map_err(|error| refused(&error))?;
    if let Some(note) = note(&scene) {
        say(quiet, &note);
    }

    let rows =
        Rows::new(format, args.variations.iter().map(Variation::header).collect(), args.columns.as_deref(), &scene);
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
        let values = runner.says(&runner.values(first as u64));
        say(quiet, &format!("{count} of {runs} runs came to nothing; the first is run {first}, {values}: {why}"));
    }
    Ok(ExitCode::SUCCESS)
}

/// Makes runs by their numbers.
struct Runner<'a> {
    template: &'a Template<'a>,
    variations: &'a [Variation],
    plan: &'a Plan,
    end: Run,
}

impl Runner<'_> {
    fn values(&self, run: u64) -> Vec<Value> {
        self.plan.values(self.variations, run)
    }

    /// The values of a run for a person.
    fn says(&self, values: &[Value]) -> String {
        let pairs = self
            .variations
            .iter()
            .zip(values)
            .map(|(variation, value)| format!("{} = {}", variation.key, value.toml.trim_matches('"')));
        pairs.collect::<Vec<_>>().join(", ")
    }

    fn scene(&self, values: &[Value]) -> Result<Scene, SceneError> {
        let values: Vec<&str> = values.iter().map(|value| value.toml.as_str()).collect();
        self.template.scene(&values, self.end)
    }

    /// The row of a run, and why it came to nothing if it did.
    fn row(&self, rows: &Rows, run: u64) -> (String, Option<String>) {
        let values = self.values(run);
        let nothing = |end: &'static str, why: String| Nothing { end, why: why.replace('\n', " ") };
        let said = |error: &SceneError| {
            [Some(error.message()), error.help()].into_iter().flatten().collect::<Vec<_>>().join(": ")
        };
        let came = self
            .scene(&values)
            .map_err(|error| nothing("refused", said(&error)))
            .and_then(|scene| scene.plan().map_err(|error| nothing("refused", error.to_string())))
            .and_then(|plan| plan.outcome().map_err(|error| nothing("failed", error.to_string())));
        let row = rows.row(run, &values, &came);
        (row, came.err().map(|nothing| nothing.why))
    }
}

/// Which runs there are, and how many.
fn plan(args: &Sweep) -> Result<(Plan, u64), Error> {
    if let Some(count) = args.random {
        return Ok((Plan::Random { seed: args.seed }, count));
    }
    let mut runs = 1_u64;
    for variation in &args.variations {
        let Some(count) = variation.count() else {
            let (key, text) = (&variation.key, &variation.text);
            return Err(Error::new(format!(
                "it is not said how many values `{key}` takes: write --vary {text}:10, or draw them by --random 1000"
            )));
        };
        runs = runs.checked_mul(count).filter(|runs| *runs <= MOST_RUNS).ok_or_else(|| {
            Error::new(format!("the grid has more than {MOST_RUNS} runs: draw some of them by --random 100000"))
        })?;
    }
    Ok((Plan::Grid, runs))
}

/// What the rows of a file depend on.
fn whose(args: &Sweep, toml: &[u8], rows: &Rows, runs: u64) -> Json {
    json!({
        "saltus": env!("CARGO_PKG_VERSION"),
        "vary": args.variations.iter().map(|variation| variation.text.as_str()).collect::<Vec<_>>(),
        "random": args.random,
        "seed": args.random.map(|_| args.seed),
        "runs": runs,
        "until_s": args.until.map(row::number),
        "most_jumps": args.most_jumps,
        "format": match rows.format { RowFormat::Csv => "csv", RowFormat::Jsonl => "jsonl" },
        "columns": rows.headers(),
        "scene": String::from_utf8_lossy(toml),
    })
}

/// The format by name, or by the extension of the file.
fn format(args: &Sweep) -> Result<RowFormat, Error> {
    let extension = args.output.as_deref().and_then(Path::extension).map(|e| e.to_string_lossy().to_lowercase());
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

/// A bar, once a second has passed.
struct Progress {
    bar: Option<ProgressBar>,
    start: Instant,
    runs: u64,
    quiet: bool,
}

impl Progress {
    fn new(runs: u64, quiet: bool) -> Self {
        Self { bar: None, start: Instant::now(), runs, quiet }
    }

    fn reached(&mut self, done: u64) {
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        } else if !self.quiet && self.start.elapsed() > Duration::from_secs(1) {
            self.bar = Some(ProgressBar::new(self.runs).with_position(done));
        }
    }

    fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
