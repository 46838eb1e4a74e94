//! The file of a sweep: whole rows are appended to it, and a sweep that was broken off goes on
//! behind the last.
//!
//! Beside `FILE` stands `FILE.sweep`, which says whose rows they are.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use saltus_scene::sweep::{Row, Sweep, difference};
use serde_json::Value;

use super::SweepArgs;
use crate::error::Error;
use crate::output;

/// What is kept back so that not every row is a call of the system, and for how long.
const KEPT: usize = 1 << 16;
const WAIT: Duration = Duration::from_millis(50);

/// Where rows go.
pub(super) struct Table {
    /// The file and its path; `None` for standard output.
    file: Option<(File, PathBuf)>,
    /// Whole rows that are not written yet.
    kept: Vec<u8>,
    written: Instant,
}

impl Table {
    /// Standard output, or the file that is asked for; how many rows of this sweep are in it.
    pub(super) fn open(args: &SweepArgs, sweep: &Sweep<'_>, whose: &Value) -> Result<(Self, u64), Error> {
        let to = |file, kept: String| Self { file, kept: kept.into_bytes(), written: Instant::now() };
        let Some(path) = args.output.as_deref().filter(|path| *path != Path::new("-")) else {
            if args.resume {
                return Err(Error::new("standard output cannot be gone on with: name a file by -o"));
            }
            return Ok((to(None, sweep.header()), 0));
        };
        let fail = |error| Error::writing(path, &error);
        let beside = beside(path);
        let found = fs::metadata(path).ok();
        match found {
            Some(found) if found.is_dir() => {
                return Err(Error::new(format!("'{}' is a folder: name a file in it", path.display())));
            }
            // A device or a pipe is written to and knows nothing of before.
            Some(found) if !found.is_file() => {
                if args.resume {
                    return Err(Error::new(format!("'{}' is no file that can be gone on with", path.display())));
                }
                let file = OpenOptions::new().write(true).open(path).map_err(fail)?;
                return Ok((to(Some((file, path.to_owned())), sweep.header()), 0));
            }
            Some(_) if args.resume => {
                let mut file = OpenOptions::new().read(true).write(true).open(path).map_err(fail)?;
                lock(&file, path)?;
                same(path, &beside, whose)?;
                let done = gone_on(&mut file, path, sweep)?;
                let header = if done.is_none() { sweep.header() } else { String::new() };
                return Ok((to(Some((file, path.to_owned())), header), done.unwrap_or(0)));
            }
            Some(_) if !args.force => {
                let path = path.display();
                return Err(Error::new(format!("'{path}' exists: --resume goes on with it, --force starts anew")));
            }
            Some(_) => {
                lock(&OpenOptions::new().write(true).open(path).map_err(fail)?, path)?;
                // Before its description changes, so that rows of another sweep never stand under
                // this one's.
                fs::remove_file(path).map_err(fail)?;
            }
            None => {}
        }
        let text = serde_json::to_string_pretty(whose).map_err(Error::new)? + "\n";
        output::write(Some(&beside), text.as_bytes())?;
        let file = OpenOptions::new().write(true).create_new(true).open(path).map_err(fail)?;
        lock(&file, path)?;
        Ok((to(Some((file, path.to_owned())), sweep.header()), 0))
    }

    /// The rows that are in the file already.
    pub(super) fn before(&self, sweep: &Sweep<'_>, done: u64) -> Result<Vec<Row>, Error> {
        let Some((_, path)) = self.file.as_ref().filter(|_| done > 0) else { return Ok(Vec::new()) };
        let text = fs::read_to_string(path).map_err(|error| Error::reading(path, &error))?;
        let line = |(run, line): (usize, &str)| {
            sweep.read(&format!("{line}\n")).ok_or_else(|| {
                let path = path.display();
                Error::new(format!("'{path}' was changed since: run {run} is no row of it; --force starts anew"))
            })
        };
        text.lines().skip(sweep.header().lines().count()).enumerate().map(line).collect()
    }

    /// Takes a row; writes when there is enough or it has waited.
    pub(super) fn push(&mut self, row: &str) -> Result<(), Error> {
        self.kept.extend_from_slice(row.as_bytes());
        if self.kept.len() >= KEPT || self.written.elapsed() >= WAIT { self.write() } else { Ok(()) }
    }

    fn write(&mut self) -> Result<(), Error> {
        match &mut self.file {
            Some((file, path)) => file.write_all(&self.kept).map_err(|error| broken_off(path, &error))?,
            None => output::stdout(&self.kept).map(drop)?,
        }
        self.kept.clear();
        self.written = Instant::now();
        Ok(())
    }

    /// Writes the rest.
    pub(super) fn finish(mut self) -> Result<(), Error> {
        self.write()?;
        match &self.file {
            Some((file, path)) if file.metadata().is_ok_and(|found| found.is_file()) => {
                file.sync_all().map_err(|error| broken_off(path, &error))
            }
            _ => Ok(()),
        }
    }
}

/// The rows of a file stay, those of a device are gone.
fn broken_off(path: &Path, error: &io::Error) -> Error {
    let kept = fs::metadata(path).is_ok_and(|found| found.is_file());
    let stays = if kept { "; the whole rows in it stay, and --resume goes on behind them" } else { "" };
    Error::new(format!("{}{stays}", Error::writing(path, error)))
}

/// `FILE.sweep`.
fn beside(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".sweep");
    name.into()
}

/// Two sweeps into one file would tear each other's rows.
fn lock(file: &File, path: &Path) -> Result<(), Error> {
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => {
            Err(Error::new(format!("'{}' is being written to by another sweep: wait for it to end", path.display())))
        }
        // Some file systems know no locks.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(()),
    }
}

/// Refuses a file that another sweep began.
fn same(path: &Path, beside: &Path, whose: &Value) -> Result<(), Error> {
    let unknown = |says: String| {
        let path = path.display();
        Error::new(format!("it is not known which sweep '{path}' belongs to: {says}; --force starts anew"))
    };
    let text =
        fs::read_to_string(beside).map_err(|error| unknown(format!("cannot read '{}': {error}", beside.display())))?;
    serde_json::from_str::<Value>(&text)
        .map_err(|error| unknown(format!("'{}' is not as it was written: {error}", beside.display())))?;
    let Some(how) = difference(&whose.to_string(), &text) else { return Ok(()) };
    let path = path.display();
    Err(Error::new(format!("'{path}' belongs to another sweep: {how}; name another file, or start anew by --force")))
}

/// How many whole rows there are, a torn line behind them cut off; `None` if not even the header is
/// whole.
fn gone_on(file: &mut File, path: &Path, sweep: &Sweep<'_>) -> Result<Option<u64>, Error> {
    let fail = |error| Error::writing(path, &error);
    let header = sweep.header();
    let mut reader = BufReader::new(&mut *file);
    let (mut whole, mut line, mut number) = (0, Vec::new(), 0_u64);
    loop {
        line.clear();
        reader.read_until(b'\n', &mut line).map_err(fail)?;
        if line.last() != Some(&b'\n') {
            break;
        }
        number += 1;
        let run = number - 1 - u64::from(!header.is_empty()).min(number - 1);
        let is_header = number == 1 && !header.is_empty();
        let wanted = if is_header { header.clone() } else { sweep.beginning(run) };
        if !line.starts_with(wanted.as_bytes()) {
            let (path, wanted) = (path.display(), wanted.trim_end());
            return Err(Error::new(format!(
                "'{path}' was changed since: its line {number} does not begin with '{wanted}'; --force starts anew"
            )));
        }
        whole += line.len() as u64;
    }
    drop(reader);
    file.set_len(whole).and_then(|()| file.seek(SeekFrom::Start(whole))).map_err(fail)?;
    Ok(if header.is_empty() { Some(number) } else { number.checked_sub(1) })
}
