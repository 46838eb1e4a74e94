//! How rows and columns become trials: the layout that explains all columns that are understood.

use std::collections::HashSet;

use super::aside::Why;
use super::cell::Cell;
use super::columns::{Column, Columns, Kind};
use super::grid::shown;
use super::heading::{At, DropHeight, Meaning, Role, What};
use super::phrases::Phrase;
use super::region::Region;
use super::rows::{Row, Rows};
use super::said::shrinks;
use super::sequence::LEVEL;
use super::units::{Dimension, Unit};
use super::vocabulary::{Atom, folded};
use super::words::split;
use crate::error::TableError;
use crate::statistics::median;

/// So many flights that last alike are of no ball.
const EVEN: usize = 9;

/// How the readings of a table lie in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    /// `event,time_s,height_cm`: what happened, row by row.
    Events { event: usize },
    /// `bounce,height_cm` or `bounce,time_s`: numbered rows.
    Numbered,
    /// Rows in the order of the bounces.
    Listed,
    /// `h0_cm,height_cm`: every row is a drop and its rebound.
    Pairs,
    /// `trial,h0_cm,h1_cm,h2_cm`: bounces side by side, a row being a trial.
    Wide,
    /// `time_s,height_cm`: where the ball was.
    Samples { frames: bool },
}

/// The columns of one ball, or trial, side by side with others.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Track {
    pub(super) trial: String,
    pub(super) group: String,
    pub(super) release: Option<usize>,
    pub(super) height: Option<usize>,
    pub(super) time: Option<usize>,
    pub(super) interval: Option<usize>,
    pub(super) total: Option<usize>,
    pub(super) speed: Option<usize>,
    pub(super) before: Option<usize>,
    pub(super) after: Option<usize>,
    pub(super) lost: Option<usize>,
    pub(super) share: Option<usize>,
    /// The height of release that the headings state, m.
    pub(super) drop: Option<f64>,
    /// Columns of numbered bounces.
    pub(super) nth: Vec<usize>,
}

impl Track {
    fn take(&mut self, index: usize, column: &Column) {
        let Some(value) = column.value() else {
            match column.kind {
                Kind::Lost => self.lost = Some(index),
                Kind::Share => self.share = Some(index),
                _ => {}
            }
            return;
        };
        // Hundredths are of the release, wherever that was.
        let drop = value.drop.as_ref().filter(|_| !column.of_hundredths());
        self.drop = self.drop.or(drop.map(DropHeight::metres));
        let slot = match (value.what, value.at) {
            (_, At::Nth(_)) => return self.nth.push(index),
            (What::Height, At::Release | At::Before) => &mut self.release,
            (What::Speed, At::Before | At::Release) => &mut self.before,
            (What::Speed, At::After) => &mut self.after,
            (What::Height | What::Unsaid, _) => &mut self.height,
            (What::Time, _) => &mut self.time,
            (What::Interval, _) => &mut self.interval,
            (What::Total, _) => &mut self.total,
            (What::Speed, At::Row) => &mut self.speed,
        };
        *slot = slot.or(Some(index));
    }

    /// What it has of its own, and from `shared` what it has not.
    fn beside(&self, shared: &Self) -> Self {
        Self {
            release: self.release.or(shared.release),
            drop: self.drop.or(shared.drop),
            time: self.time.or(shared.time),
            interval: self.interval.or(shared.interval),
            before: self.before.or(shared.before),
            ..self.clone()
        }
    }

    /// Whether a column, or its heading, tells the height of release.
    pub(super) fn released(&self) -> bool {
        self.release.is_some() || self.drop.is_some()
    }

    pub(super) fn label(&self) -> String {
        [self.group.as_str(), &self.trial].iter().filter(|p| !p.is_empty()).copied().collect::<Vec<_>>().join(", ")
    }
}

/// The tracks of a table, in the order of their columns.
pub(super) fn tracks(columns: &Columns) -> Vec<Track> {
    let mut shared = Track::default();
    let mut tracks: Vec<Track> = Vec::new();
    for (index, column) in columns.columns.iter().enumerate() {
        let (trial, group) = match column.value() {
            Some(value) if value.role == Role::Error => continue,
            Some(value) => (value.trial.clone(), value.group.clone()),
            None if column.kind == Kind::Share => {
                let group = column.heading.value().map(|value| value.group.clone());
                (column.heading.trial(), group.unwrap_or_default())
            }
            None => (String::new(), String::new()),
        };
        if trial.is_empty() && group.is_empty() {
            shared.take(index, column);
            continue;
        }
        let at = tracks.iter().position(|t| t.trial == trial && t.group == group).unwrap_or_else(|| {
            tracks.push(Track { trial, group, ..Track::default() });
            tracks.len() - 1
        });
        tracks[at].take(index, column);
    }
    if tracks.is_empty() {
        return vec![shared];
    }
    let mut found: Vec<Track> = tracks.iter().map(|track| track.beside(&shared)).collect();
    let own = shared.height.is_some() || shared.speed.is_some() || !shared.nth.is_empty();
    if own {
        found.insert(0, shared);
    }
    found
}

/// The layout of a table.
pub(super) fn layout(
    region: &Region<'_>,
    columns: &Columns,
    rows: &Rows,
    tracks: &[Track],
) -> Result<Layout, TableError> {
    let any = |of: fn(&Track) -> bool| tracks.iter().any(of);
    if let Some(event) = columns.one(&Kind::Event) {
        return Ok(Layout::Events { event });
    }
    if region.frames && any(|t| t.height.is_some()) {
        return Ok(Layout::Samples { frames: true });
    }
    if let Some(error) = velocities(region, columns, rows, tracks) {
        return Err(error);
    }
    let key = columns.number().is_some() || columns.one(&Kind::Label).is_some();
    let sure = columns.number().is_none_or(|(_, sure)| sure);
    let numbered = key && !rows.rows.is_empty() && rows.rows.iter().all(|row| row.bounce.is_some());
    let rowed = any(|t| t.height.is_some() || t.time.is_some() || t.interval.is_some() || t.speed.is_some());
    // Rows that are only counted may be those of a film, whose heights rise and fall.
    let filmed = !sure && !tracks.iter().all(|track| falling_throughout(region, rows, track));
    let alone = |t: &Track| t.height.is_none() && t.before.is_none() && t.nth.is_empty() && !t.released();
    if tracks.iter().all(alone)
        && let Some(error) = evenly_timed(region, columns, rows)
    {
        return Err(error);
    }
    if columns.of_tops() {
        return Ok(if numbered { Layout::Numbered } else { Layout::Listed });
    }
    if any(|t| t.time.is_some() && t.height.is_some()) && (!numbered || filmed) {
        return Ok(Layout::Samples { frames: false });
    }
    // The time until rest tells more than that of the first contact.
    let rests = |t: &Track| t.total.is_some() && t.release.is_some() && t.nth.len() == 1;
    let arrives = tracks.iter().all(|track| arrives(columns, track));
    if any(|t| !t.nth.is_empty()) && !arrives && !tracks.iter().all(rests) {
        return Ok(Layout::Wide);
    }
    if arrives
        || any(|t| {
            t.before.is_some() && t.after.is_some() || t.lost.is_some() || t.share.is_some() || t.total.is_some()
        })
    {
        return Ok(Layout::Pairs);
    }
    let released = any(Track::released);
    let counted = numbered && sure;
    if !released
        && !counted
        && rowed
        && !shrinks(region, columns)
        && let Some(error) = misread(region, columns, rows)
    {
        return Err(error);
    }
    // One height of release for several rows is that of a drop of several bounces; else each row is
    // a drop.
    let constant = numbered && (!sure || released) && one_release(region, columns, rows, tracks);
    if numbered && rowed && (!released || constant) {
        return Ok(Layout::Numbered);
    }
    if counted && let Some(error) = before_the_release(region, columns, rows) {
        return Err(error);
    }
    // Heights that fall below one another are the bounces of one drop.
    let stated = tracks.iter().all(|t| t.drop.is_some() && t.release.is_none());
    let keyed = columns.columns.iter().any(|c| matches!(c.kind, Kind::Trial | Kind::Setting));
    let listed = stated && !key && !keyed && tracks.iter().all(|track| falling(region, columns, rows, track));
    if released && any(|t| t.height.is_some() || t.interval.is_some()) {
        return Ok(if listed { Layout::Listed } else { Layout::Pairs });
    }
    if !rowed && !any(|t| t.after.is_some()) {
        return Err(nothing(region, columns));
    }
    if numbered {
        return Ok(Layout::Numbered);
    }
    match beside(region, columns, rows) {
        Some(error) if !shrinks(region, columns) => Err(error),
        _ => Ok(Layout::Listed),
    }
}

/// A velocity that changes its sign from row to row, beside a time, is that of a ball in flight,
/// and of no bounce.
fn velocities(region: &Region<'_>, columns: &Columns, rows: &Rows, tracks: &[Track]) -> Option<TableError> {
    let moving = |track: &&Track| track.time.is_some() && track.height.is_none();
    let index = tracks.iter().find(moving)?.speed?;
    let number = |row: &Row| region.view.number(row.at, index);
    let signs = || rows.rows.iter().filter_map(number);
    let both = signs().any(|v| v < 0.0) && signs().any(|v| v > 0.0);
    let name = shown(&columns.columns[index].heading.text);
    let message = format!("'{name}' is the velocity of a ball in flight: its heights are wanted");
    let help = "export the position beside the time, such as 'y (m)'; or give the speeds before and after each bounce";
    both.then(|| region.header_error(index, message).question().help(help))
}

/// Bounces that count from the release on have no height before that: where the first comes as
/// high as it was before, one of the two columns is something else.
fn before_the_release(region: &Region<'_>, columns: &Columns, rows: &Rows) -> Option<TableError> {
    let first = rows.rows.first().filter(|row| row.bounce == Some(0))?;
    let number = |n: usize| region.view.number(first.at, n);
    let (before, column, _) = columns.values().find(|(n, _, v)| v.at == At::Release && number(*n).is_some())?;
    let loses = |n: usize| number(n) < number(before);
    let (_, height, _) = columns.values().find(|(n, _, v)| (v.what, v.at) == (What::Height, At::Row) && !loses(*n))?;
    let (name, other) = (shown(&column.heading.text), shown(&height.heading.text));
    let message = format!("bounce 0 is the release: which of '{name}' and '{other}' is its height?");
    let help = format!("choose one by --column '{other}', or count drops of their own in a column 'trial'");
    Some(region.header_error(before, message).question().help(help))
}

/// Whether a track holds the time from release to one contact, the second or a later one, and says
/// that it lasts until then.
fn arrives(columns: &Columns, track: &Track) -> bool {
    let until = |index: usize| {
        let column = &columns.columns[index];
        let timed = column.value().is_some_and(|v| {
            matches!(v.what, What::Time | What::Total) && matches!(v.at, At::Nth(contact) if contact > 1)
        });
        let heading = &column.heading;
        let to = || split(&heading.text).iter().any(|word| word.text == "to");
        let total = column.holds(What::Total);
        timed && (total || heading.has(Atom::Rest) || heading.has(Atom::Release) || to())
    };
    track.release.is_some() && matches!(track.nth.as_slice(), [index] if until(*index))
}

/// No column holds readings of bounces.
fn nothing(region: &Region<'_>, columns: &Columns) -> TableError {
    // Who wrote a row down, in words, is at no fault.
    let numbers = |n: usize| region.numbers(n).next().is_some();
    let find = |fits: &dyn Fn(&Column) -> bool| {
        columns.columns.iter().enumerate().position(|(n, column)| fits(column) && numbers(n))
    };
    let unknown = find(&|c| c.heading.value().is_some() && !c.heading.unknown.is_empty());
    if let Some((index, word)) = unknown.and_then(|n| Some((n, columns.columns[n].heading.unknown.first()?))) {
        return columns.unknown(region, index, word);
    }
    // What is measured in a unit of a length or a time, and is none of a bounce by its words.
    let dimension = |c: &Column| c.heading.unit.map(|unit| unit.dimension);
    let of_another = |c: &Column| {
        let measured = matches!(dimension(c), Some(Dimension::Length | Dimension::Time));
        measured && c.kind == Kind::Aside && c.heading.unknown.is_empty() && !c.heading.turns()
    };
    if let Some(index) = find(&of_another) {
        let name = shown(&columns.columns[index].heading.text);
        return region
            .header_error(index, format!("what does '{name}' hold? By its words no height and no time of a bounce"))
            .question()
            .help("name it by --header, such as 'rebound_cm' or 'air time (s)'; '-' leaves a column aside");
    }
    region
        .error("no column holds heights or times of bounces")
        .nothing()
        .help("a height of release alone tells nothing: give the rebounds, in a column such as 'rebound_cm'")
}

/// Numbers whose name is not understood, beside readings that nothing counts: they may be the
/// heights of release, or other readings.
fn misread(region: &Region<'_>, columns: &Columns, rows: &Rows) -> Option<TableError> {
    let (_, reading, _) = columns.values().find(|(_, _, v)| v.role == Role::Reading)?;
    let dimension = |column: &Column| column.heading.unit.map(|unit| unit.dimension);
    let (index, column) = columns.columns.iter().enumerate().find(|(n, c)| {
        let alike = dimension(c).is_none() || dimension(c) == dimension(reading);
        let numbers = || rows.rows.iter().any(|row| region.view.is_number(row.at, *n));
        c.kind == Kind::Aside && !c.heading.unknown.is_empty() && !c.heading.turns() && alike && numbers()
    })?;
    let (name, word) = (shown(&column.heading.text), shown(column.heading.unknown.first()?));
    let message = format!(
        "what is '{name}'? The word '{word}' is not understood, and '{}' may depend on it",
        shown(&reading.heading.text)
    );
    Some(
        region
            .header_error(index, message)
            .question()
            .help("name it by --header, such as 'drop height (cm)' for heights of release; '-' leaves a column aside; or number the bounces in a column 'bounce'"),
    )
}

/// A list may be of something else than bounces where numbers stand beside it that are not used: a
/// film, or balls that differ.
fn beside(region: &Region<'_>, columns: &Columns, rows: &Rows) -> Option<TableError> {
    let (index, column, _) = columns.values().find(|(_, _, v)| v.role == Role::Reading)?;
    let keyed = columns.one(&Kind::Trial).is_some() || columns.columns.iter().any(|c| c.kind == Kind::Setting);
    let named = column.heading.has(Atom::Impact) || column.heading.has(Atom::Between) || heard(region, columns, rows);
    let other = columns.columns.iter().enumerate().find(|(n, c)| {
        let measures = matches!(c.heading.meaning, Meaning::Aside(Why::Other)) || !c.heading.unknown.is_empty();
        let numbers = || rows.rows.iter().any(|row| region.view.is_number(row.at, *n));
        !keyed && (c.kind == Kind::Aside && measures && !named && numbers() || dates(region, c, *n, rows))
    });
    let (name, other) = (shown(&column.heading.text), shown(&other?.1.heading.text));
    Some(
        region
            .header_error(index, format!("does '{name}' list the bounces of one drop, in order? Beside it stands '{other}'"))
            .question()
            .help(
                "number the bounces in a column 'bounce', or leave the other column out by --header; places of a film are wanted with their \
                 times, or with --fps and 'y' for a name",
            ),
    )
}

/// Times as far apart as one another are those of samples, and not of contacts.
fn evenly_timed(region: &Region<'_>, columns: &Columns, rows: &Rows) -> Option<TableError> {
    let (clock, column, _) = columns.values().find(|(_, _, v)| v.what == What::Time)?;
    let times: Vec<f64> = rows.rows.iter().filter_map(|row| region.time(row.at, clock, Unit::SECOND)).collect();
    let mut apart: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (low, high) = apart.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), t| (low.min(*t), high.max(*t)));
    let even = apart.len() > EVEN && high - low < (1.0 - LEVEL) * median(&mut apart)?;
    let name = shown(&column.heading.text);
    even.then(|| {
        let message = format!("the times of '{name}' are evenly spaced, as those of samples, and no contacts");
        let help = "give the heights of a film beside them, or the times of the contacts alone";
        region.header_error(clock, message).question().help(help)
    })
}

/// Whether the times of the rows are those of sounds, by how loud these are, which stands beside
/// them: but not those of samples, which are as far apart as one another.
fn heard(region: &Region<'_>, columns: &Columns, rows: &Rows) -> bool {
    let loud = |text: &str| split(text).iter().any(|word| Phrase::Sound.is(&folded(&word.text)));
    let Some((clock, _, _)) = columns.values().find(|(_, _, v)| v.what == What::Time) else { return false };
    let times: Vec<f64> = rows.rows.iter().filter_map(|row| region.view.number(row.at, clock)).collect();
    let apart = times.windows(3).any(|three| three[2] - three[1] < LEVEL * (three[1] - three[0]));
    apart && columns.columns.iter().any(|c| c.value().is_none() && loud(&c.heading.text))
}

/// Whether a remark is a day, or a number, that is another in every row: as those of readings that
/// were taken one by one.
fn dates(region: &Region<'_>, column: &Column, index: usize, rows: &Rows) -> bool {
    let dated = |cell: &str| cell.contains(|c: char| c.is_ascii_digit());
    let cells: Vec<&str> = rows.rows.iter().map(|row| region.cell(row.at, index)).collect();
    let apart: HashSet<&str> = cells.iter().copied().collect();
    let note = column.kind == Kind::Aside && matches!(column.heading.meaning, Meaning::Aside(Why::Note));
    note && cells.len() > 1 && apart.len() == cells.len() && cells.into_iter().all(dated)
}

/// Whether bounces are counted up beside one height of release, and the count is of bounces rather
/// than of drops: their heights fall.
fn one_release(region: &Region<'_>, columns: &Columns, rows: &Rows, tracks: &[Track]) -> bool {
    tracks.iter().all(|track| {
        if !track.released() {
            return true;
        }
        let mut several = false;
        let alike = rows.rows.windows(2).all(|pair| {
            let goes_on = pair[1].bounce > pair[0].bounce;
            let same = track.release.is_none_or(|release| {
                region.cell(pair[0].at, release) == region.cell(pair[1].at, release)
                    || region.cell(pair[1].at, release).is_empty()
            });
            several |= goes_on && same;
            !goes_on || same
        });
        several && alike && falling(region, columns, rows, track)
    })
}

/// Whether no height is above the one in the row before.
fn falling_throughout(region: &Region<'_>, rows: &Rows, track: &Track) -> bool {
    let number = |row: &Row| region.view.number(row.at, track.height?);
    let heights: Vec<f64> = rows.rows.iter().filter_map(number).collect();
    heights.windows(2).all(|pair| pair[1] <= pair[0])
}

/// Whether the readings of numbered rows fall from bounce to bounce, as those of one drop do and
/// those of several drops do not.
fn falling(region: &Region<'_>, columns: &Columns, rows: &Rows, track: &Track) -> bool {
    let Some(column) = track.height.or(track.interval) else { return true };
    let Column { zero, sign, .. } = columns.columns[column];
    let number = |row: usize| match region.view.read(row, column) {
        Cell::Number(m) => Some(sign * (m.value - zero)),
        _ => None,
    };
    let follows = |pair: &&[Row]| pair[1].bounce > pair[0].bounce || pair[1].bounce.or(pair[0].bounce).is_none();
    let steps = rows.rows.windows(2).filter(follows);
    let mut ratios: Vec<f64> = steps.filter_map(|pair| Some(number(pair[1].at)? / number(pair[0].at)?)).collect();
    median(&mut ratios).is_none_or(|ratio| ratio < LEVEL)
}
