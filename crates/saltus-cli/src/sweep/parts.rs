//! The folder of a sweep: parts of Parquet, each whole or absent, that several may write.
//!
//! `_sweep.json` says whose they are and how many rows each has; whoever begins the folder first
//! says so for all. The package for Python has the same layout, and reads both.

use std::fs;
use std::io::{self, Write};
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use saltus_scene::sweep::{Cell, Cells, Column, Sweep};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::args::{Share, Sweep as Args};
use super::{parquet, table};
use crate::error::Error;
use crate::output::{builder, say};
use crate::progress::Progress;

/// Readers of Parquet pass over names that begin so.
const PLAN: &str = "_sweep.json";
/// The work of one core in a part: no more is lost where a sweep is killed.
const SPELL: Duration = Duration::from_millis(500);
/// The part of that work from which the time of a row is estimated.
const LOOK: Duration = Duration::from_millis(50);
/// Multiples of (√5 - 1)/2, less whole numbers, come near every place soon.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// The most rows of a part: a few megabytes.
const LONGEST: f64 = 50_000.0;

/// Makes the parts that are missing.
pub(super) fn run(
    args: &Args,
    folder: &Path,
    sweep: &Sweep<'_>,
    whose: &Value,
    quiet: bool,
) -> Result<ExitCode, Error> {
    let parts = Parts::open(folder, sweep, whose, args.chunk)?;
    let Share { k, of } = args.part.unwrap_or(Share { k: 1, of: 1 });
    let mut progress =
        Progress::new(parts.all().skip(k - 1).step_by(of).map(|part| part.end - part.start).sum(), quiet);
    let (mut done, mut nothing) = (0, (0_u64, None));
    for part in parts.all().skip(k - 1).step_by(of) {
        if !parts.has(&part)? {
            let columns = made(sweep, part.clone(), |run, why| {
                nothing.0 += 1;
                nothing.1.get_or_insert_with(|| format!("run {run}, {}: {why}", sweep.vary().says(run)));
            })?;
            parts.put(&part, sweep.headers(), &columns)?;
        }
        done += part.end - part.start;
        progress.reached(done);
    }
    progress.clear();
    if let (count, Some(first)) = nothing {
        say(quiet, &format!("{count} runs came to nothing; the first is {first}"));
    }
    let mut missing = 0;
    for part in parts.all() {
        missing += if parts.has(&part)? { 0 } else { part.end - part.start };
    }
    if missing == 0 {
        parts.tidy();
    } else {
        say(quiet, &format!("'{}' lacks {missing} of {} runs: other shares make them", folder.display(), sweep.runs()));
    }
    Ok(ExitCode::SUCCESS)
}

/// The rows of some runs by columns; those that came to nothing are named.
fn made(sweep: &Sweep<'_>, part: Range<u64>, mut nothing: impl FnMut(u64, &str)) -> Result<Vec<Cells>, Error> {
    let mut columns = sweep.columns();
    let why = sweep.headers().iter().position(|header| header == Column::Why.name());
    let runs = usize::try_from(part.start).map_err(Error::new)?..usize::try_from(part.end).map_err(Error::new)?;
    let _: ControlFlow<()> = saltus::ensemble(
        runs,
        |run| sweep.cells(run as u64),
        |run, cells| {
            if let Some(Cell::Word(why)) = why.and_then(|why| cells.get(why)) {
                nothing(run as u64, why);
            }
            columns.iter_mut().zip(cells).for_each(|(column, cell)| column.push(cell));
            ControlFlow::Continue(())
        },
    );
    Ok(columns)
}

/// A folder of parts, and its identity.
struct Parts<'a> {
    folder: &'a Path,
    /// The identity that each part bears.
    said: String,
    hash: String,
    runs: u64,
    chunk: u64,
}

impl<'a> Parts<'a> {
    /// Begins the folder, or goes on with it.
    fn open(folder: &'a Path, sweep: &Sweep<'_>, whose: &Value, chunk: Option<u64>) -> Result<Self, Error> {
        let fail = |error: io::Error| Error::writing(folder, &error);
        fs::create_dir_all(folder).map_err(fail)?;
        let (plan, shown) = (folder.join(PLAN), folder.display());
        let (mut whose, text) = (whose.clone(), whose.to_string());
        let hash: String = Sha256::digest(&text).iter().map(|byte| format!("{byte:02x}")).collect();
        whose["hash"] = json!(hash);
        let said = whose.to_string();
        if !plan.exists() {
            // Parts come after their plan: rows of another layout would stand beside those to come.
            let parts = fs::read_dir(folder).map_err(fail)?.flatten().any(|file| is_part(&file.file_name()));
            if parts && !plan.exists() {
                return Err(Error::new(format!(
                    "'{shown}' has parts and no {PLAN}: it is not known whose; name another folder"
                )));
            }
            whose["chunk"] = json!(chunk.unwrap_or_else(|| pace(sweep)));
            let text = serde_json::to_string_pretty(&whose).map_err(Error::new)?;
            // Of several that begin the folder the first wins, and all go by it.
            match beside(folder, PLAN, text.as_bytes()).map_err(fail)?.persist_noclobber(&plan) {
                Err(error) if error.error.kind() != io::ErrorKind::AlreadyExists => return Err(fail(error.error)),
                _ => {}
            }
        }
        let text = fs::read(&plan).map_err(|error| Error::reading(&plan, &error))?;
        let found: Value = serde_json::from_slice(&text)
            .map_err(|error| Error::new(format!("'{}' is not as it was written: {error}", plan.display())))?;
        if found["hash"] != json!(hash) {
            let how = table::difference(&whose, &found).unwrap_or_else(|| "it was begun in Python".to_owned());
            return Err(Error::new(format!("'{shown}' holds another sweep: {how}; name another folder")));
        }
        let rows = found["chunk"].as_u64().filter(|rows| *rows > 0);
        let rows = rows.ok_or_else(|| Error::new(format!("'{}' does not say how long parts are", plan.display())))?;
        match chunk {
            Some(chunk) if chunk != rows => {
                Err(Error::new(format!("the parts in '{shown}' have {rows} rows, and not {chunk}")))
            }
            _ => Ok(Self { folder, said, hash, runs: sweep.runs(), chunk: rows }),
        }
    }

    /// The runs of each part.
    fn all(&self) -> impl Iterator<Item = Range<u64>> + use<'_> {
        let start = (0..self.runs.div_ceil(self.chunk)).map(|n| n * self.chunk);
        start.map(|start| start..start.saturating_add(self.chunk).min(self.runs))
    }

    fn path(&self, part: &Range<u64>) -> PathBuf {
        let width = self.runs.to_string().len();
        self.folder.join(format!("part-{:0width$}.parquet", part.start))
    }

    /// Whether a part is there and whole; that of another sweep is refused.
    fn has(&self, part: &Range<u64>) -> Result<bool, Error> {
        let path = self.path(part);
        let Some((said, rows)) = parquet::read(&path) else { return Ok(false) };
        let said: Value = serde_json::from_str(&said).unwrap_or_default();
        if said["hash"] != json!(self.hash) {
            return Err(Error::new(format!("'{}' belongs to another sweep: name another folder", path.display())));
        }
        Ok(rows == part.end - part.start)
    }

    /// Writes a part under another name, and then gives it its own at once.
    fn put(&self, part: &Range<u64>, headers: &[String], columns: &[Cells]) -> Result<(), Error> {
        let path = self.path(part);
        let bytes = parquet::written(headers, columns, &self.said).map_err(Error::new)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let written = beside(self.folder, &name, &bytes);
        match written.and_then(|file| file.persist(&path).map_err(|error| error.error)) {
            // Another writer wrote the same, and removed what it took for left over.
            Err(error) if error.kind() == io::ErrorKind::NotFound && path.exists() => Ok(()),
            written => written.map(drop).map_err(|error| Error::writing(&path, &error)),
        }
    }

    /// Removes what writers that were killed have left; who still writes finds the part there.
    fn tidy(&self) {
        let files = fs::read_dir(self.folder).into_iter().flatten().flatten();
        let left = |name: &str| name.starts_with('.') && name.ends_with(".part");
        for file in files.filter(|file| file.file_name().to_str().is_some_and(left)) {
            // Who is gone already is as good as removed.
            let _ = fs::remove_file(file.path());
        }
    }
}

fn is_part(name: &std::ffi::OsStr) -> bool {
    name.to_str().is_some_and(|name| name.starts_with("part-") && name.ends_with(".parquet"))
}

/// A file that is whole on the disk, without its name yet.
fn beside(folder: &Path, name: &str, bytes: &[u8]) -> io::Result<tempfile::NamedTempFile> {
    let prefix = format!(".{name}.");
    let mut file = builder().prefix(&prefix).suffix(".part").tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

/// How many rows are a part, as long as rows take here, at places all over the sweep.
fn pace(sweep: &Sweep<'_>) -> u64 {
    let (runs, mut count, mut place) = (sweep.runs(), 1, 0.0_f64);
    loop {
        place = (place + GOLDEN).fract();
        let start = (place * (runs - count + 1) as f64) as u64;
        let begin = Instant::now();
        (start..start + count).for_each(|run| drop(sweep.cells(run)));
        let took = begin.elapsed();
        if took > LOOK || 2 * count > runs {
            return (count as f64 * SPELL.as_secs_f64() / took.as_secs_f64()).clamp(1.0, LONGEST) as u64;
        }
        count *= 2;
    }
}
