//! Tables of measured bounces: releases, contacts and apexes, by trial, in SI units.

mod against;
mod alarms;
mod answers;
mod aside;
mod assemble;
mod cell;
mod check;
mod clause;
mod columns;
mod computed;
mod datum;
mod digits;
mod drops;
mod encoding;
mod end;
mod exported;
mod file;
mod filed;
mod foreign;
mod forms;
mod grid;
mod heading;
mod heard;
mod json;
mod judged;
mod kept;
mod lasting;
mod layout;
mod limits;
mod listed;
mod named;
mod old_workbook;
mod open_workbook;
mod options;
mod order;
mod phrases;
mod pool;
mod programs;
mod region;
mod remarks;
mod roles;
mod rows;
mod said;
mod samples;
mod scales;
mod sensed;
mod sequence;
mod sheet;
mod sizes;
mod sports;
mod stamps;
mod strange;
mod stray;
mod text;
mod title;
mod tracks;
mod units;
mod vocabulary;
mod words;
mod workbook;
mod wrapped;
mod written;

use std::borrow::Cow;
use std::io::Read;
use std::path::Path;

pub use aside::{LeftAside, Part, Why};
pub use options::ReadOptions;

use crate::error::TableError;
use crate::finding::{Doubt, Note, Remark, Repair, Warning};
use crate::quantity::Ball;
use crate::sound::Sound;

/// What a reading was taken of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Event {
    /// The ball is let go, at rest, from a known height.
    Release,
    /// The ball touches the floor.
    Contact,
    /// The ball is at the top of a flight.
    Apex,
    /// The ball is somewhere in flight: one row of a series of heights in time.
    Sample,
}

/// One row of a table, in metres and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Reading {
    /// What the reading was taken of.
    pub event: Event,
    /// Which one. A contact counts from 1; an apex bears the number of the contact before it; a
    /// release is 0.
    pub bounce: usize,
    /// When, in seconds on the trial's own clock.
    pub time: Option<f64>,
    /// How high above the floor, in metres.
    pub height: Option<f64>,
    /// The standard error of `time` as the table states it, in seconds.
    pub sigma_time: Option<f64>,
    /// The standard error of `height` as the table states it, in metres.
    pub sigma_height: Option<f64>,
    /// The line of the file, counted from 1 (the position in the list, for a table built in code).
    pub line: u64,
}

impl Reading {
    pub(crate) const fn new(event: Event, bounce: usize, line: u64) -> Self {
        Self { event, bounce, time: None, height: None, sigma_time: None, sigma_height: None, line }
    }
}

/// One drop: its readings, in the order of the events.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trial {
    pub(crate) label: String,
    /// What was tried, such as `ball golf, h0_cm 80`: trials alike in this repeat each other.
    pub(crate) setting: String,
    /// The ball, the surface, the sheet: trials of different groups have CORs of their own.
    pub(crate) group: String,
    /// The ball, where a column of the table names one.
    pub(crate) ball: Option<Ball>,
    pub(crate) readings: Vec<Reading>,
    /// A time from which, with gravity, the rebound follows.
    pub(crate) timed: Option<Timed>,
    /// The CORs that the table itself works out for it.
    pub(crate) stated: Vec<f64>,
    /// What stands in its rows in columns that were left aside and may matter: the name of the
    /// column, the cell.
    pub(crate) beside: Vec<(String, String)>,
    /// The conditions of its rows that are others in every row: the name of the column, the cell.
    pub(crate) conditions: Vec<(String, String)>,
}

/// What a time from which a rebound follows lasts from and to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Span {
    /// The only flight.
    Flight,
    /// From release to this contact, the second or a later one.
    Until(usize),
    /// From release to rest.
    UntilRest,
}

/// The time of a span, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Timed {
    pub(crate) span: Span,
    pub(crate) time: f64,
    pub(crate) sigma: Option<f64>,
    pub(crate) line: u64,
}

impl Trial {
    /// What tells this trial from the others, such as `ball golf, h0_cm 80, trial 3`; empty if the
    /// table holds one trial.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.label
    }

    /// The readings, in the order of the events.
    #[must_use]
    pub fn readings(&self) -> &[Reading] {
        &self.readings
    }
}

/// A table of measured bounces, read and checked.
///
/// ```
/// use saltus_fit::{Event, ReadOptions, Table};
///
/// let csv = b"event,time_s,height_cm\nrelease,0,100\ncontact,0.45,\napex,,30\ncontact,0.95,\n";
/// let table = Table::parse("drop.csv", csv, &ReadOptions::default())?;
/// let apex = table.trials()[0].readings()[2];
/// assert_eq!((apex.event, apex.bounce, apex.height), (Event::Apex, 1, Some(0.3)));
/// # Ok::<(), saltus_fit::TableError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Table {
    pub(crate) name: String,
    pub(crate) trials: Vec<Trial>,
    pub(crate) notes: Vec<Remark<Note>>,
    pub(crate) repairs: Vec<Remark<Repair>>,
    pub(crate) warnings: Vec<Remark<Warning>>,
    pub(crate) left_aside: Vec<LeftAside>,
    pub(crate) doubts: Vec<Doubt>,
    pub(crate) metadata: Metadata,
    pub(crate) zero_rebounds: usize,
    pub(crate) rows: usize,
    /// The names of the files, where there are several.
    pub(crate) files: Vec<String>,
    /// The sounds that were listened to.
    pub(crate) sounds: Vec<Sound>,
}

/// What the table's comments and options state, in SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Metadata {
    pub(crate) frame_rate: Option<f64>,
    pub(crate) gravity: Option<f64>,
    /// The height of release, where no column and no row tells it, m.
    pub(crate) drop: Option<f64>,
    /// The same, as another sheet states it for all of which none states its own.
    pub(crate) noted: Option<f64>,
    pub(crate) sigma_height: Option<f64>,
    pub(crate) sigma_time: Option<f64>,
    /// Heights are in pixels that nobody has given a scale for: one counts as a metre, and only
    /// ratios mean anything.
    pub(crate) pixels: bool,
    /// Each reading is the mean of so many.
    pub(crate) averaged: Option<f64>,
    /// Times are sums of times between contacts.
    pub(crate) intervals: bool,
    /// Heights stand for speeds before and after each bounce.
    pub(crate) speeds: bool,
    /// Heights are ratios to others.
    pub(crate) ratios: bool,
    /// Which way the heights count was stated, and is not to be recognised.
    pub(crate) oriented: bool,
    /// Whether heights were stated to count downwards, where the ball then falls upwards.
    pub(crate) falls_upwards: Option<bool>,
}

impl Table {
    /// Reads a table from a file; its name is the file's name.
    ///
    /// # Errors
    /// [`TableError`] when the file cannot be opened, or for any reason of [`Table::parse`].
    pub fn read(path: &Path, options: &ReadOptions) -> Result<Self, TableError> {
        Self::read_all(&[path], options)
    }

    /// Reads several files into one table: every file adds its trials.
    ///
    /// ```no_run
    /// use saltus_fit::{ReadOptions, Table};
    ///
    /// let table = Table::read_all(&["launch-1.xls", "launch-2.xls"], &ReadOptions::default())?;
    /// # Ok::<(), saltus_fit::TableError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Table::read`], for the first file that has one; when the files state different
    /// gravity; and for no file at all.
    pub fn read_all(paths: &[impl AsRef<Path>], options: &ReadOptions) -> Result<Self, TableError> {
        let read = |path: &Path| {
            let shown = path.display().to_string();
            let name = path.file_name().map_or_else(|| shown.clone(), |n| n.to_string_lossy().into_owned());
            let held = match heard::of_file(path, &shown, options) {
                Some(table) => Held::Sound(Box::new(table?)),
                None => Held::Bytes(Cow::Owned(bytes(path, &shown)?)),
            };
            Ok((shown, name, held))
        };
        Self::joined(paths.iter().map(|path| read(path.as_ref())), options)
    }

    /// Reads several files that are in memory, by name, into one table: every file adds its trials.
    ///
    /// ```
    /// use saltus_fit::{ReadOptions, Table};
    ///
    /// let files: [(&str, &[u8]); 2] = [("a.csv", b"height_cm\n100\n64\n"), ("b.csv", b"height_cm\n100\n65\n")];
    /// assert_eq!(Table::parse_all(&files, &ReadOptions::default())?.trials().len(), 2);
    /// # Ok::<(), saltus_fit::TableError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Table::read_all`], but for files that cannot be opened.
    pub fn parse_all(files: &[(&str, &[u8])], options: &ReadOptions) -> Result<Self, TableError> {
        let files = files.iter().copied();
        let named =
            files.map(|(name, bytes)| Ok((name.to_owned(), name.to_owned(), Held::Bytes(Cow::Borrowed(bytes)))));
        Self::joined(named, options)
    }

    /// One table of files: of each the path for messages, the name and what it holds.
    fn joined<'a>(
        files: impl Iterator<Item = Result<(String, String, Held<'a>), TableError>>,
        options: &ReadOptions,
    ) -> Result<Self, TableError> {
        let mut parts: Vec<(String, Self)> = Vec::new();
        let mut given: Vec<(Cow<'_, [u8]>, String)> = Vec::new();
        let mut repairs: Vec<Remark<Repair>> = Vec::new();
        for file in files {
            let (shown, name, held) = file?;
            let table = match held {
                Held::Sound(table) => {
                    // The same contacts to the last digit are those of the same recording.
                    if let Some((before, _)) = parts.iter().find(|(_, part)| heard::is_same(part, &table)) {
                        repairs.push(Repair::SameFile { file: name, as_file: before.clone() }.into());
                        continue;
                    }
                    *table
                }
                Held::Bytes(bytes) => {
                    if let Some((_, before)) = given.iter().find(|(known, _)| *known == bytes) {
                        repairs.push(Repair::SameFile { file: name, as_file: before.clone() }.into());
                        continue;
                    }
                    let table = file::table(&shown, &bytes, options)?;
                    given.push((bytes, name.clone()));
                    table
                }
            };
            parts.push((name.clone(), Self { name, ..table }));
        }
        if parts.is_empty() {
            return Err(TableError::new("no file", "there is nothing to read").help("name a file"));
        }
        let count = parts.len() + repairs.len();
        let more = if count > 1 { format!(" and {} more", count - 1) } else { String::new() };
        let name = format!("{}{more}", parts[0].0);
        pool::apart(&mut parts);
        let files = if parts.len() > 1 { parts.iter().map(|part| part.0.clone()).collect() } else { Vec::new() };
        let mut table = Self { files, ..pool::join(&name, parts)? };
        table.repairs.append(&mut repairs);
        Ok(table.checked())
    }

    /// Reads a table from bytes; `name` stands in messages.
    ///
    /// Understood are text (CSV with commas, semicolons or tabs; what Tracker, `ImageJ`, Vernier's
    /// and phyphox' programs export; bare numbers, if the options say what they are), workbooks
    /// (`.xlsx`, `.xls`, `.ods`), zip archives of CSV, and sounds (`.wav`, see [`Sound`]).
    /// `docs/use/fitting.md` shows every layout.
    ///
    /// The reader of workbooks may panic over a damaged one. That becomes an error like any other,
    /// but the program's panic hook hears of it first and, as it is by default, prints a line to
    /// standard error; it belongs to the program, and is left as it is.
    ///
    /// # Errors
    /// [`TableError`], with line and column, for a cell that is not a finite number, a height below
    /// the floor, a column that is not known or has no unit, times that run backwards, readings
    /// given twice; and for an empty file.
    pub fn parse(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Self, TableError> {
        Ok(file::table(name, bytes, options)?.checked())
    }

    /// Once all trials are together: what must not be counted is taken out, what was read is noted.
    fn checked(mut self) -> Self {
        self.trials.iter_mut().for_each(|trial| trial.readings.shrink_to_fit());
        self.notes.extend(pool::spelt(&mut self.trials).into_iter().map(Remark::from));
        self.notes.insert(0, Note::Size { rows: self.rows, trials: self.trials.len() }.into());
        check::table(&mut self);
        self
    }

    /// One trial from the heights of its apexes in metres: the height of release first, then each
    /// rebound.
    ///
    /// ```
    /// let table = saltus_fit::Table::from_heights(&[1.0, 0.30, 0.10])?;
    /// assert_eq!(table.trials()[0].readings().len(), 3);
    /// # Ok::<(), saltus_fit::TableError>(())
    /// ```
    ///
    /// # Errors
    /// [`TableError`] when a height is negative or not finite, or there is none.
    pub fn from_heights(heights: &[f64]) -> Result<Self, TableError> {
        Self::from_list("heights", heights, |n, height, line| {
            let event = if n == 0 { Event::Release } else { Event::Apex };
            let below = height.is_sign_negative() && height != 0.0;
            (!below).then_some(Reading { height: Some(height), ..Reading::new(event, n, line) })
        })
    }

    /// One trial from the times of its floor contacts in seconds, on any clock, in ascending order.
    ///
    /// ```
    /// let table = saltus_fit::Table::from_contacts(&[0.587, 1.549, 2.403, 3.164])?;
    /// assert_eq!(table.trials()[0].readings()[3].bounce, 4);
    /// # Ok::<(), saltus_fit::TableError>(())
    /// ```
    ///
    /// # Errors
    /// [`TableError`] when a time is not finite or not later than the one before, or there is none.
    pub fn from_contacts(times: &[f64]) -> Result<Self, TableError> {
        let mut last = f64::NEG_INFINITY;
        Self::from_list("contact times", times, |n, time, line| {
            let ascending = time > last;
            last = time;
            ascending.then_some(Reading { time: Some(time), ..Reading::new(Event::Contact, n + 1, line) })
        })
    }

    fn from_list(
        name: &str,
        values: &[f64],
        mut reading: impl FnMut(usize, f64, u64) -> Option<Reading>,
    ) -> Result<Self, TableError> {
        if values.is_empty() {
            return Err(TableError::new(name, "the list is empty").help("give at least two readings"));
        }
        let mut readings = Vec::with_capacity(values.len());
        for (n, &value) in values.iter().enumerate() {
            let wrong = |what| TableError::new(name, format!("entry {} of the list, {value}, {what}", n + 1));
            if !value.is_finite() {
                return Err(wrong("is not finite"));
            }
            let line = n as u64 + 1;
            readings.push(
                reading(n, value, line)
                    .ok_or_else(|| wrong("is below the floor, or not later than the contact before"))?,
            );
        }
        let trials = vec![Trial { readings, ..Trial::default() }];
        let mut table = Self { name: name.to_owned(), trials, ..Self::default() };
        check::table(&mut table);
        Ok(table)
    }

    /// The table's name: that of its file, without the folder.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The trials, in the order in which the table first mentions them.
    #[must_use]
    pub fn trials(&self) -> &[Trial] {
        &self.trials
    }

    /// How the table was taken; each note has a `Display` form for people.
    #[must_use]
    pub fn notes(&self) -> &[Remark<Note>] {
        &self.notes
    }

    /// What the files hold and was not used, each with its place and the reason.
    #[must_use]
    pub fn left_aside(&self) -> &[LeftAside] {
        &self.left_aside
    }

    /// The frame rate a comment states (`# frame rate: 30`), in frames per second.
    #[must_use]
    pub fn frame_rate(&self) -> Option<f64> {
        self.metadata.frame_rate
    }

    /// The gravity a comment states (`# gravity: 9.8 m/s^2`), in m/s².
    #[must_use]
    pub fn gravity(&self) -> Option<f64> {
        self.metadata.gravity
    }
}

/// What a file holds: a sound is listened to where it is, for it may be long.
enum Held<'a> {
    Bytes(Cow<'a, [u8]>),
    Sound(Box<Table>),
}

fn bytes(path: &Path, shown: &str) -> Result<Vec<u8>, TableError> {
    if path.is_dir() {
        return Err(TableError::new(shown, "this is a directory").help("name files in it, such as tables in CSV"));
    }
    let mut bytes = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(limits::bytes() as u64 + 1).read_to_end(&mut bytes));
    read.map_err(|error| {
        let (message, help) = match error.kind() {
            std::io::ErrorKind::NotFound => ("there is no such file".to_owned(), "check the name and the folder"),
            _ => (format!("the file cannot be read: {error}"), "check that you may read it"),
        };
        TableError::new(shown, message).help(help)
    })?;
    if bytes.len() > limits::bytes() {
        let what = format!("the file is larger than {} MB", limits::bytes() >> 20);
        return Err(TableError::new(shown, what).help("give the table by itself, or thin it out"));
    }
    Ok(bytes)
}
