//! The folder of a sweep: parts of Parquet, each whole or absent, that several may write.
//!
//! `_sweep.json` says whose they are and how many rows each has; whoever begins the folder first
//! says so for all. The package for Python goes on with what the tool began, and the other way
//! round.

use std::fs;
use std::io::{self, Write};
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use saltus_scene::sweep::{Cell, Cells, Column, Identity, PLAN, Sweep, difference, pace, part, parts};
use serde_json::{Value, json};

use super::args::{Share, Sweep as Args};
use super::parquet;
use crate::error::Error;
use crate::output::{builder, say};
use crate::progress::Progress;

/// Makes the parts that are missing.
pub(super) fn run(args: &Args, folder: &Path, sweep: &Sweep<'_>, quiet: bool) -> Result<ExitCode, Error> {
    let parts = Parts::open(folder, sweep, args.chunk)?;
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
    identity: Identity,
    runs: u64,
    chunk: u64,
}

impl<'a> Parts<'a> {
    /// Begins the folder, or goes on with it.
    fn open(folder: &'a Path, sweep: &Sweep<'_>, chunk: Option<u64>) -> Result<Self, Error> {
        let fail = |error: io::Error| Error::writing(folder, &error);
        fs::create_dir_all(folder).map_err(fail)?;
        let (plan, shown) = (folder.join(PLAN), folder.display());
        let identity = Identity::of(sweep).map_err(Error::new)?;
        if !plan.exists() {
            // Parts come after their plan: rows of another layout would stand beside those to come.
            let parts = fs::read_dir(folder).map_err(fail)?.flatten().any(|file| is_part(&file.file_name()));
            if parts && !plan.exists() {
                return Err(Error::new(format!(
                    "'{shown}' has parts and no {PLAN}: it is not known whose; name another folder"
                )));
            }
            let mut whole: Value = serde_json::from_str(identity.said()).map_err(Error::new)?;
            whole["chunk"] = json!(chunk.unwrap_or_else(|| pace(sweep)));
            let text = serde_json::to_string_pretty(&whole).map_err(Error::new)?;
            // Of several that begin the folder the first wins, and all go by it.
            match beside(folder, PLAN, text.as_bytes()).map_err(fail)?.persist_noclobber(&plan) {
                Err(error) if error.error.kind() != io::ErrorKind::AlreadyExists => return Err(fail(error.error)),
                _ => {}
            }
        }
        let text = fs::read_to_string(&plan).map_err(|error| Error::reading(&plan, &error))?;
        let found: Value = serde_json::from_str(&text)
            .map_err(|error| Error::new(format!("'{}' is not as it was written: {error}", plan.display())))?;
        if let Some(how) = difference(identity.said(), &text) {
            return Err(Error::new(format!("'{shown}' holds another sweep: {how}; name another folder")));
        }
        let rows = found["chunk"].as_u64().filter(|rows| *rows > 0);
        let rows = rows.ok_or_else(|| Error::new(format!("'{}' does not say how long parts are", plan.display())))?;
        match chunk {
            Some(chunk) if chunk != rows => {
                Err(Error::new(format!("the parts in '{shown}' have {rows} rows, and not {chunk}")))
            }
            _ => Ok(Self { folder, identity, runs: sweep.runs(), chunk: rows }),
        }
    }

    /// The runs of each part.
    fn all(&self) -> impl Iterator<Item = Range<u64>> + use<> {
        parts(self.runs, self.chunk)
    }

    fn path(&self, rows: &Range<u64>) -> PathBuf {
        self.folder.join(part(rows.start, self.runs))
    }

    /// Whether a part is there and whole; that of another sweep is refused.
    fn has(&self, part: &Range<u64>) -> Result<bool, Error> {
        let path = self.path(part);
        let Some((said, rows)) = parquet::read(&path) else { return Ok(false) };
        if !self.identity.is_of(&said) {
            return Err(Error::new(format!("'{}' belongs to another sweep: name another folder", path.display())));
        }
        Ok(rows == part.end - part.start)
    }

    /// Writes a part under another name, and then gives it its own at once.
    fn put(&self, part: &Range<u64>, headers: &[String], columns: &[Cells]) -> Result<(), Error> {
        let path = self.path(part);
        let bytes = parquet::written(headers, columns, self.identity.said()).map_err(Error::new)?;
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
