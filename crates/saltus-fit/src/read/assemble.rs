//! From rows to trials.

use std::collections::HashMap;

use super::aside::{LeftAside, Part, Why};
use super::cell::{Cell, Fault, clock};
use super::columns::{Columns, Kind};
use super::grid::{lines, shown};
use super::heading::{At, Heading, What};
use super::layout::{Layout, Track, layout, tracks};
use super::order::{in_order, renumbered, summed};
use super::region::Region;
use super::rows::{Row, Rows};
use super::samples;
use super::stray;
use super::units::{Scale, Unit};
use super::vocabulary::Atom;
use super::{Event, Metadata, ReadOptions, Reading, Table, Timed, Trial};
use crate::error::TableError;

/// Gravity by which speeds become heights: any would do, since only their ratios count, m/s².
const GRAVITY: f64 = 9.81;

/// Everything a row needs to become readings.
struct Builder<'a> {
    region: &'a Region<'a>,
    columns: &'a mut Columns,
    layout: Layout,
    /// The columns that tell trials apart, and those that tell what was tried.
    keys: Vec<usize>,
    settings: Vec<usize>,
    trials: Vec<Trial>,
    index: HashMap<String, usize>,
    /// Cells that stood in the row before, where a merged cell leaves the next ones empty.
    merged: HashMap<usize, String>,
    /// The lines of rows of a series without a position.
    missing: Vec<u64>,
    aside: Vec<LeftAside>,
    /// Trials whose times are those of the flights.
    flights: Vec<usize>,
}

/// A reading of a cell: its number in SI units, and its error.
type Found = Option<(f64, Option<f64>)>;

/// Reads a region into trials.
pub(super) fn table(
    region: &Region<'_>,
    columns: &mut Columns,
    mut rows: Rows,
    options: &ReadOptions,
    metadata: Metadata,
) -> Result<Table, TableError> {
    let skipped = filtered(region, &mut rows, options)?;
    if rows.rows.is_empty() {
        if skipped > 0 {
            let wanted: Vec<String> = options.filters.iter().map(|(n, v)| format!("{n} = {v}")).collect();
            return Err(region
                .error(format!("no row has {}", wanted.join(" and ")))
                .help("check the value; without a filter every row is read"));
        }
        return Err(region
            .error("the table has a header and no rows")
            .nothing()
            .help("add the readings below the header"));
    }
    floor(region, columns, &rows, options)?;
    let tracks = tracks(columns);
    let layout = layout(region, columns, &rows, &tracks)?;
    let mut table = Table { metadata, ..Table::default() };
    table.metadata.pixels |= columns.unscaled;
    unscaled(region, columns, layout, options, &mut table.metadata)?;
    if skipped > 0 {
        table.notes.push(format!("{} rows kept and {skipped} left out by the filter", rows.rows.len()));
    }
    table.rows = rows.rows.len();
    let mut builder = Builder {
        region,
        layout,
        keys: Vec::new(),
        settings: Vec::new(),
        columns,
        trials: Vec::new(),
        index: HashMap::new(),
        merged: HashMap::new(),
        missing: Vec::new(),
        aside: rows.aside.clone(),
        flights: Vec::new(),
    };
    builder.keyed();
    let flights = builder.descending(&rows, &tracks)?;
    for (n, row) in rows.rows.iter().enumerate() {
        for track in &tracks {
            builder.row(n, row, track, flights)?;
        }
    }
    builder.finish(options, &tracks, flights, table)
}

/// Keeps the rows that every filter asks for, and counts the others.
fn filtered(region: &Region<'_>, rows: &mut Rows, options: &ReadOptions) -> Result<usize, TableError> {
    let find = |(name, value): &(String, String)| {
        let index = region.header.iter().position(|cell| cell.eq_ignore_ascii_case(name.trim()));
        index.map(|index| (index, value.trim().to_owned())).ok_or_else(|| {
            region
                .error(format!("there is no column '{name}' to filter by"))
                .help(format!("the table has {}", region.header.join(", ")))
        })
    };
    let filters: Vec<(usize, String)> = options.filters.iter().map(find).collect::<Result<_, _>>()?;
    let before = rows.rows.len();
    rows.rows.retain(|row| filters.iter().all(|(index, value)| same(region.cell(row.at, *index), value)));
    Ok(before - rows.rows.len())
}

/// Equal as text, or as numbers.
fn same(cell: &str, value: &str) -> bool {
    cell.eq_ignore_ascii_case(value)
        || matches!((cell.parse::<f64>(), value.parse::<f64>()), (Ok(a), Ok(b)) if (a - b).abs() < f64::EPSILON)
}

/// A row that tells where the floor is gives every scale of heights its zero, and its direction.
fn floor(region: &Region<'_>, columns: &mut Columns, rows: &Rows, options: &ReadOptions) -> Result<(), TableError> {
    let Some((row, column)) = rows.floor else { return Ok(()) };
    let number = |row: usize| match region.view.read(row, column) {
        Cell::Number(m) => Some(m.value),
        _ => None,
    };
    let (Some(zero), Some(first)) = (number(row), rows.rows.iter().find_map(|r| number(r.at))) else {
        return Err(region.view.error(row, column, "the floor is no number").help("write what the scale reads there"));
    };
    let down = options.down.unwrap_or(zero > first);
    for c in columns.columns.iter_mut().filter(|c| c.holds(What::Height)) {
        c.zero = options.zero.unwrap_or(zero);
        c.sign = if down { -1.0 } else { 1.0 };
    }
    columns.notes.push(format!(
        "the scale reads {} at the floor and counts {}",
        region.cell(row, column),
        if down { "downwards" } else { "upwards" }
    ));
    Ok(())
}

/// Heights without a scale: places on a picture need a zero, and a pixel is the error of reading one.
fn unscaled(
    region: &Region<'_>,
    columns: &Columns,
    layout: Layout,
    options: &ReadOptions,
    metadata: &mut Metadata,
) -> Result<(), TableError> {
    if !columns.unscaled || matches!(layout, Layout::Samples { .. }) {
        return Ok(());
    }
    let pixels = |unit: Option<Unit>| unit.is_some_and(|u| u.scale == Scale::Pixels);
    let place =
        columns.values().find(|(_, c, v)| pixels(c.unit) && v.position && c.zero == 0.0 && options.zero.is_none());
    if let Some((index, column, _)) = place {
        let name = shown(&column.heading.text);
        return Err(region
            .header_error(index, format!("'{name}' holds places in pixels: at which is the floor?"))
            .question()
            .help("give what the scale reads at the floor, such as --zero 812, and --y-down if it counts downwards; or a row 'floor'"));
    }
    if columns.values().any(|(_, c, _)| pixels(c.unit)) {
        metadata.sigma_height = metadata.sigma_height.or(Some(1.0));
    }
    Ok(())
}

impl Builder<'_> {
    /// Finds the columns whose cells tell trials apart.
    fn keyed(&mut self) {
        let columns = &self.columns.columns;
        let release = |n: &usize| {
            columns[*n].value().is_some_and(|v| v.at == At::Release && v.trial.is_empty() && v.group.is_empty())
        };
        let all = 0..columns.len();
        // Beside other bounces of the same row the release is one of them.
        let drops = !matches!(self.layout, Layout::Wide);
        self.settings = all
            .clone()
            .filter(|n| columns[*n].kind == Kind::Setting || drops && release(n) && self.columns.values().count() > 1)
            .collect();
        self.keys = all.filter(|n| columns[*n].kind == Kind::Trial || self.settings.contains(n)).collect();
        let sure = self.columns.number().is_none_or(|(_, sure)| sure);
        if !sure
            && matches!(self.layout, Layout::Pairs | Layout::Wide)
            && let Some((n, _)) = self.columns.number()
        {
            self.keys.insert(0, n);
        }
    }

    /// Whether a column of times holds those of flights: within each trial they fall, as the times of contacts cannot.
    fn descending(&mut self, rows: &Rows, tracks: &[Track]) -> Result<bool, TableError> {
        if !matches!(self.layout, Layout::Numbered | Layout::Listed | Layout::Wide) {
            return Ok(false);
        }
        let (mut count, mut falls) = (0, true);
        for track in tracks {
            let mut runs: HashMap<String, Vec<(usize, f64)>> = HashMap::new();
            for (n, row) in rows.rows.iter().enumerate() {
                let nth = track.nth.iter().filter_map(|&c| match self.columns.columns[c].value()?.at {
                    At::Nth(bounce) if self.columns.columns[c].holds(What::Time) => Some((bounce, c)),
                    _ => None,
                });
                let rowed = track.time.map(|c| (row.bounce.unwrap_or(n), c));
                let key = if self.layout == Layout::Wide { n.to_string() } else { self.key(row) };
                for (bounce, column) in nth.chain(rowed) {
                    if let Some((time, _)) = self.number(row.at, column)?.filter(|(time, _)| *time > 0.0) {
                        runs.entry(key.clone()).or_default().push((bounce, time));
                    }
                }
            }
            for run in runs.values_mut() {
                run.sort_by_key(|(bounce, _)| *bounce);
                count = count.max(run.len());
                falls &= run.windows(2).all(|pair| pair[1].1 < pair[0].1);
            }
        }
        // Two times may be given in either order.
        let found = count > 2 && falls;
        if found {
            self.columns.notes.push("the times fall from bounce to bounce: taken as times between contacts".to_owned());
        }
        Ok(found)
    }

    /// What tells the trial of a row from others.
    fn key(&self, row: &Row) -> String {
        let mut key = row.name.clone();
        for &index in &self.keys {
            key.push('\u{1f}');
            key.push_str(self.text(row.at, index));
        }
        key
    }

    /// The text of a cell, or of the merged cell that it is part of.
    fn text(&self, row: usize, column: usize) -> &str {
        match self.region.cell(row, column) {
            "" => self.merged.get(&column).map_or("", String::as_str),
            cell => cell,
        }
    }

    fn row(&mut self, n: usize, row: &Row, track: &Track, flights: bool) -> Result<(), TableError> {
        if matches!(self.layout, Layout::Numbered | Layout::Events { .. } | Layout::Samples { .. }) {
            for index in self.keys.clone() {
                let cell = self.region.cell(row.at, index).to_owned();
                if !cell.is_empty() {
                    self.merged.insert(index, cell);
                }
            }
        }
        match self.layout {
            Layout::Wide => self.wide(row, track, flights),
            Layout::Pairs => self.pair(row, track),
            Layout::Samples { frames } => self.sample(n, row, track, frames),
            Layout::Events { event } => self.event(row, track, event),
            Layout::Numbered => self.numbered(row.bounce.unwrap_or(n), row, track, flights),
            Layout::Listed => {
                let several = !self.keys.is_empty() || !row.name.is_empty();
                let trial = self.trial(row, track)?;
                let count =
                    self.trials[trial].readings.iter().filter(|r| r.event != Event::Release || r.bounce > 0).count();
                let released = self.trials[trial].readings.iter().any(|r| r.event == Event::Release);
                let next = if track.release.is_some() { count + 1 } else { count + usize::from(released) };
                let place = if several { next } else { n + usize::from(track.release.is_some()) };
                self.numbered(place, row, track, flights)
            }
        }
    }

    /// The trial a row belongs to, made at its first row.
    fn trial(&mut self, row: &Row, track: &Track) -> Result<usize, TableError> {
        let key = format!("{}\u{1e}{}", self.key(row), track.label());
        if let Some(&found) = self.index.get(&key) {
            return Ok(found);
        }
        let found = self.push(row, track, "")?;
        self.index.insert(key, found);
        Ok(found)
    }

    fn listed(&self, row: &Row, columns: &[usize]) -> Vec<String> {
        columns.iter().map(|&n| format!("{} {}", self.columns.columns[n].heading.text, self.text(row.at, n))).collect()
    }

    /// A new trial, with its release if a column tells the height of it.
    fn push(&mut self, row: &Row, track: &Track, more: &str) -> Result<usize, TableError> {
        let track_label = track.label();
        let own = self
            .columns
            .columns
            .iter()
            .find(|c| c.value().is_some_and(|v| v.trial == track.trial && !v.trial.is_empty()));
        // A column that is one trial is called as it is written.
        let written = own.map_or(track_label.as_str(), |c| {
            if track.group.is_empty() { c.heading.text.as_str() } else { track_label.as_str() }
        });
        let mut label = self.listed(row, &self.keys);
        let parts = [row.name.as_str(), written, more];
        label.extend(parts.iter().filter(|p| !p.is_empty()).map(|p| (*p).to_owned()));
        let mut setting = self.listed(row, &self.settings);
        let groups = self.settings.iter().filter(|&&n| {
            let column = &self.columns.columns[n];
            // A temperature is a condition of the drop, and no other ball.
            column.kind == Kind::Setting && column.heading.unit.is_none()
        });
        let mut group: Vec<String> = groups.map(|&n| self.text(row.at, n).to_owned()).collect();
        for name in [&row.group, &track.group].into_iter().filter(|name| !name.is_empty()) {
            setting.push(name.clone());
            group.push(name.clone());
        }
        let mut readings = Vec::new();
        if let Some((index, (height, sigma))) = track
            .release
            .map(|n| Ok((n, self.height(row.at, n)?)))
            .transpose()?
            .and_then(|(n, found)| Some((n, found?)))
        {
            let line = self.line(row.at, index);
            readings.push(Reading {
                height: Some(height),
                sigma_height: sigma,
                ..Reading::new(Event::Release, 0, line)
            });
        }
        group.retain(|part| !part.is_empty());
        self.trials.push(Trial {
            label: label.join(", "),
            setting: setting.join(", "),
            group: group.join(", "),
            readings,
            timed: None,
        });
        Ok(self.trials.len() - 1)
    }

    fn line(&self, row: usize, column: usize) -> u64 {
        self.region.view.line(row, column)
    }

    /// The number in a cell in SI units, with its error; `None` if it is empty.
    fn number(&self, row: usize, column: usize) -> Result<Found, TableError> {
        let (view, own) = (self.region.view, &self.columns.columns[column]);
        let cell = view.cell(row, column);
        let timed = own.unit.is_some_and(|u| u.dimension == super::units::Dimension::Time);
        if let Some(seconds) = clock(cell).filter(|_| timed) {
            return Ok(Some((seconds, self.sigma(row, column)?)));
        }
        let wrong = |message: String, help: &str| Err(view.error(row, column, message).help(help));
        let text = shown(cell);
        let measured = match view.read(row, column) {
            Cell::Empty => return Ok(None),
            Cell::Number(measured) => measured,
            Cell::Lost | Cell::Wrong(Fault::NotFinite) => {
                return wrong(format!("'{text}' is not a finite number"), "take the row out");
            }
            Cell::Words => {
                let help = if text.contains(' ') {
                    "write a plain number; the unit belongs in the header or behind the number, and a remark behind a '#'"
                } else {
                    "write a plain number; the unit belongs in the header"
                };
                return wrong(format!("'{text}' is not a number"), help);
            }
            Cell::Wrong(fault) => {
                let (what, help) = faulty(fault);
                return wrong(format!("'{text}' {what}"), help);
            }
        };
        let unit = match (measured.unit, own.unit) {
            (Some(unit), Some(named)) if unit.dimension != named.dimension => {
                return wrong(
                    format!("the unit of '{text}' is not one of {}", named.dimension.noun()),
                    "correct the cell",
                );
            }
            (Some(unit), None) if own.value().and_then(|v| v.what.dimension()).is_some_and(|d| d != unit.dimension) => {
                return wrong(format!("the unit of '{text}' is not the quantity of its column"), "correct the cell");
            }
            (Some(unit), named) => {
                let mixed = named.is_some_and(|named| named.unscaled() != unit.unscaled());
                if mixed && !(unit.unscaled() && named.is_none()) {
                    return wrong(
                        format!("'{text}' is in another kind of unit than its column"),
                        "write all numbers in one unit",
                    );
                }
                unit
            }
            (None, Some(named)) => named,
            (None, None) => {
                return wrong(format!("'{text}' has no unit"), "write it behind the number, or in the header");
            }
        };
        let sigma = match measured.error {
            Some(error) => Some(unit.si(error)),
            None => self.sigma(row, column)?,
        };
        let mut value = unit.si(measured.value);
        if own.holds(What::Height) {
            let zero = own.unit.map_or(own.zero, |named| named.si(own.zero));
            // The difference in the column's own unit is exact where the sum of conversions is not.
            value = if measured.unit.is_none() { unit.si(measured.value - own.zero) } else { value - zero };
            value *= own.sign;
        }
        self.ranged(row, column, value, sigma)
    }

    /// A range has its middle for a reading, and half its width for an error.
    fn ranged(&self, row: usize, column: usize, value: f64, sigma: Option<f64>) -> Result<Found, TableError> {
        let Some(high) = self.columns.one(&Kind::High(column)) else { return Ok(Some((value, sigma))) };
        let Some((top, _)) = self.number(row, high)? else { return Ok(Some((value, sigma))) };
        let half = 0.5 * (top - value);
        if half < 0.0 {
            return Err(self
                .region
                .view
                .error(row, high, "this upper end is below the lower")
                .help("correct the cell"));
        }
        Ok(Some((value + half, sigma.or(Some(half).filter(|half| *half > 0.0)))))
    }

    /// The error that a column states for a reading.
    fn sigma(&self, row: usize, column: usize) -> Result<Option<f64>, TableError> {
        let own = &self.columns.columns[column];
        let spread = || own.heading.spread.and_then(|spread| own.unit.map(|unit| unit.si(spread)));
        let Some(index) = self.columns.one(&Kind::Error(column)) else { return Ok(spread()) };
        match self.region.view.read(row, index) {
            Cell::Empty | Cell::Words => Ok(spread()),
            _ => {
                let sigma = self.number(row, index)?.map(|(value, _)| value);
                // The release is set, and has none.
                if sigma == Some(0.0) && own.value().is_some_and(|v| v.at == At::Release) {
                    return Ok(None);
                }
                match sigma {
                    Some(sigma) if sigma <= 0.0 => Err(self
                        .region
                        .view
                        .error(row, index, "an error must be above zero")
                        .help("leave the cell empty if it is not known")),
                    sigma => Ok(sigma),
                }
            }
        }
    }

    fn required(&self, row: usize, column: usize) -> Result<(f64, Option<f64>), TableError> {
        self.number(row, column)?.ok_or_else(|| self.empty(row, column))
    }

    fn empty(&self, row: usize, column: usize) -> TableError {
        let view = self.region.view;
        match shown(view.cell(row, column)) {
            cell if cell.is_empty() => {
                view.error(row, column, "the cell is empty").help("fill it, or take the row out")
            }
            cell => {
                view.error(row, column, format!("'{cell}' is no reading")).help("write one here, or take the row out")
            }
        }
    }

    /// A height above the floor; a speed as the height that gives it.
    fn height(&self, row: usize, column: usize) -> Result<Found, TableError> {
        let found = self.number(row, column)?;
        if self.columns.columns[column].holds(What::Speed) {
            return Ok(found.map(|(speed, sigma)| {
                (0.5 * speed * speed / GRAVITY, sigma.map(|sigma| sigma * speed.abs() / GRAVITY))
            }));
        }
        if found.is_some_and(|(height, _)| height < 0.0) {
            return Err(self.region.view.error(row, column, "a height below the floor").help(
                "heights count upwards from the floor: give what the scale reads there, such as --zero 2.5, \
                     and --y-down if it counts downwards",
            ));
        }
        Ok(found)
    }

    /// A time; zero after a time above it is one that was not heard.
    fn time(&mut self, trial: usize, row: usize, column: usize) -> Result<Found, TableError> {
        let found = self.number(row, column)?;
        let before = self.trials[trial].readings.iter().filter_map(|r| r.time).fold(0.0, f64::max);
        if found.is_some_and(|(time, _)| time == 0.0) && before > 0.0 {
            let line = self.line(row, column);
            let name = shown(&self.columns.columns[column].heading.text);
            self.aside.push(LeftAside::new(Part::Cell, name, Why::NotHeard).at(line));
            return Ok(None);
        }
        Ok(found)
    }

    fn apex(&mut self, trial: usize, bounce: usize, found: (f64, Option<f64>), line: u64) {
        let event = if bounce == 0 { Event::Release } else { Event::Apex };
        let reading = Reading { height: Some(found.0), sigma_height: found.1, ..Reading::new(event, bounce, line) };
        self.trials[trial].readings.push(reading);
    }

    fn contact(&mut self, trial: usize, bounce: usize, found: (f64, Option<f64>), line: u64) {
        let reading =
            Reading { time: Some(found.0), sigma_time: found.1, ..Reading::new(Event::Contact, bounce, line) };
        self.trials[trial].readings.push(reading);
    }

    /// The readings of a numbered row.
    fn numbered(&mut self, bounce: usize, row: &Row, track: &Track, flights: bool) -> Result<(), TableError> {
        let height = track.height.or(track.speed).or(track.after);
        let used = [height, track.time, track.interval];
        let Some(first) = used.iter().flatten().next().copied() else { return Ok(()) };
        if used.iter().flatten().all(|&c| self.region.cell(row.at, c).is_empty()) {
            return Ok(());
        }
        let trial = self.trial(row, track)?;
        let line = self.line(row.at, first);
        let time = match track.time {
            Some(column) => self.time(trial, row.at, column)?,
            None => None,
        };
        let (time, mut interval) = if flights { (None, time) } else { (time, None) };
        if let Some(column) = track.interval {
            interval = self.number(row.at, column)?;
            if interval.is_some_and(|(time, _)| time < 0.0) {
                return Err(self
                    .region
                    .view
                    .error(row.at, column, "a time between contacts cannot be negative")
                    .help("check the cell"));
            }
        }
        let high = height.map(|column| self.height(row.at, column)).transpose()?.flatten();
        if height.is_some() && (track.time.is_some() && !flights) && bounce == 0 {
            // With both, bounce 0 is the release; bounce n is a contact and the height it rebounds to.
            let (sigma_time, sigma_height) = (time.and_then(|t| t.1), high.and_then(|h| h.1));
            let (time, height) = (time.map(|t| t.0), high.map(|h| h.0));
            self.trials[trial].readings.push(Reading {
                time,
                height,
                sigma_time,
                sigma_height,
                ..Reading::new(Event::Release, 0, line)
            });
            return Ok(());
        }
        if let Some(found) = time {
            self.contact(trial, bounce, found, line);
        }
        if let Some(found) = interval.filter(|(time, _)| *time > 0.0) {
            if bounce == 0 && high.is_some() {
                let column = track.interval.or(track.time).unwrap_or(first);
                return Err(self
                    .region
                    .view
                    .error(row.at, column, "is this the time of the fall, or of a flight? Bounce 0 is the release")
                    .question()
                    .help("leave the cell of the release empty; flight n is the one after contact n"));
            }
            if !self.flights.contains(&trial) {
                self.flights.push(trial);
            }
            self.contact(trial, bounce, found, line);
        }
        if let Some(found) = high {
            self.apex(trial, bounce, found, line);
        }
        Ok(())
    }

    /// Bounces side by side, a row being a trial.
    fn wide(&mut self, row: &Row, track: &Track, flights: bool) -> Result<(), TableError> {
        let more = if self.keys.is_empty() && row.name.is_empty() {
            format!("line {}", self.line(row.at, 0))
        } else {
            String::new()
        };
        let trial = self.push(row, track, &more)?;
        let bounce_of = |column: usize| match self.columns.columns[column].value().map(|v| (v.what, v.at)) {
            Some((what, At::Nth(n))) => Some((what, n)),
            _ => None,
        };
        let mut nth: Vec<(usize, What, usize)> =
            track.nth.iter().filter_map(|&c| bounce_of(c).map(|(w, n)| (n, w, c))).collect();
        nth.sort_by_key(|(n, _, _)| *n);
        let first = nth.iter().filter(|(_, what, _)| *what == What::Time).map(|(n, _, _)| *n).min();
        for (n, what, column) in nth {
            let line = self.line(row.at, column);
            match what {
                What::Time | What::Interval | What::Total => {
                    let Some(found) = self.time(trial, row.at, column)? else { continue };
                    if flights || what == What::Interval {
                        if !self.flights.contains(&trial) {
                            self.flights.push(trial);
                        }
                        self.contact(trial, n, found, line);
                    } else {
                        self.contact(trial, if first == Some(0) { n + 1 } else { n }, found, line);
                    }
                }
                _ => {
                    let Some(found) = self.height(row.at, column)? else { continue };
                    self.apex(trial, n, found, line);
                }
            }
        }
        Ok(())
    }

    /// A drop and its rebound.
    fn pair(&mut self, row: &Row, track: &Track) -> Result<(), TableError> {
        let rebound = track.height.or(track.after).or(track.lost).or(track.interval).or(track.total);
        let before = track.release.or(track.before);
        let Some((before, rebound)) = before.zip(rebound) else {
            return match rebound.or(before) {
                Some(column) if rebound.is_some() => Err(self
                    .region
                    .header_error(
                        column,
                        format!(
                            "beside '{}' the height of release is wanted",
                            shown(&self.columns.columns[column].heading.text)
                        ),
                    )
                    .help("give it in a column such as 'drop height (cm)'")),
                _ => Ok(()),
            };
        };
        let line = self.line(row.at, rebound);
        if matches!(self.region.view.read(row.at, rebound), Cell::Empty) {
            let name = self.columns.columns[rebound].heading.text.clone();
            self.aside.push(LeftAside::new(Part::Cell, shown(&name), Why::Empty).at(line));
            return Ok(());
        }
        let trial = self.push(row, track, &format!("line {line}"))?;
        let (drop, sigma) = self.height(row.at, before)?.ok_or_else(|| self.empty(row.at, before))?;
        if track.release.is_none() {
            self.apex(trial, 0, (drop, sigma), line);
        }
        if Some(rebound) == track.interval || Some(rebound) == track.total {
            let (time, sigma) = self.required(row.at, rebound)?;
            let until_rest = Some(rebound) == track.total;
            self.trials[trial].timed = Some(Timed { until_rest, time, sigma, line });
            return Ok(());
        }
        let (mut height, sigma) = if Some(rebound) == track.lost {
            self.required(row.at, rebound)?
        } else {
            self.height(row.at, rebound)?.ok_or_else(|| self.empty(row.at, rebound))?
        };
        if Some(rebound) == track.lost {
            height = drop - height;
            if height < 0.0 {
                return Err(self
                    .region
                    .view
                    .error(row.at, rebound, "more was lost than there was")
                    .help("correct the cell"));
            }
        }
        self.apex(trial, 1, (height, sigma), line);
        Ok(())
    }

    fn sample(&mut self, n: usize, row: &Row, track: &Track, frames: bool) -> Result<(), TableError> {
        let Some(height) = track.height else { return Ok(()) };
        let line = self.line(row.at, height);
        // Where the ball was not found, programs write words for "not a number".
        let measured = |column: usize| match self.region.view.read(row.at, column) {
            Cell::Lost => Ok(None),
            _ => self.number(row.at, column),
        };
        #[allow(clippy::cast_precision_loss)] // no film has 2^53 frames
        let time = match track.time {
            Some(column) if !frames => measured(column)?.map(|t| t.0),
            _ => self.frame().map(|frame| n as f64 * frame),
        };
        let found = measured(height)?;
        let (Some(time), Some((height, sigma_height))) = (time, found) else {
            self.missing.push(line);
            return Ok(());
        };
        let trial = self.trial(row, track)?;
        let n = self.trials[trial].readings.len();
        let reading =
            Reading { time: Some(time), height: Some(height), sigma_height, ..Reading::new(Event::Sample, n, line) };
        self.trials[trial].readings.push(reading);
        Ok(())
    }

    /// The time between rows that are frames.
    fn frame(&self) -> Option<f64> {
        self.region.frame
    }

    fn event(&mut self, row: &Row, track: &Track, event: usize) -> Result<(), TableError> {
        let (view, region) = (self.region.view, self.region);
        let what = event_of(region, row.at, event)?;
        let trial = self.trial(row, track)?;
        let line = self.line(row.at, event);
        let bounce = self.next_bounce(trial, what);
        let time = track.time.map(|c| self.number(row.at, c)).transpose()?.flatten();
        let high = track.height.or(track.speed).map(|c| self.height(row.at, c)).transpose()?.flatten();
        if let (Event::Contact, Some(index), Some((height, _))) = (what, track.height, high)
            && height != 0.0
        {
            return Err(view
                .error(row.at, index, "a contact is at the height of the floor, zero")
                .help("leave the cell empty; if this is the height after the contact, give it a row 'apex'"));
        }
        let high = high.filter(|_| what != Event::Contact);
        let missing = match what {
            Event::Contact => time.is_none().then_some(("a contact needs a time", track.time)),
            _ => (time.is_none() && high.is_none())
                .then_some(("this row has neither a time nor a height", track.height.or(track.time))),
        };
        if let Some((problem, index)) = missing {
            return Err(view.error(row.at, index.unwrap_or(event), problem).help("fill the cell, or take the row out"));
        }
        self.trials[trial].readings.push(Reading {
            time: time.map(|t| t.0),
            height: high.map(|h| h.0),
            sigma_time: time.and_then(|t| t.1),
            sigma_height: high.and_then(|h| h.1),
            ..Reading::new(what, bounce, line)
        });
        Ok(())
    }

    /// The number of the next event of a trial, its rows being in the order of the events.
    fn next_bounce(&self, trial: usize, event: Event) -> usize {
        let readings = &self.trials[trial].readings;
        let contacts = readings.last().map_or(0, |last| last.bounce);
        match (event, readings.last().map(|last| last.event)) {
            (Event::Release, _) => 0,
            (Event::Contact, _) => contacts + 1,
            // An apex right after an apex or a release: there was a contact between, only nobody noted it.
            (_, Some(Event::Apex | Event::Release)) => contacts + 1,
            _ => contacts,
        }
    }

    /// What remains to be done once all rows are read.
    fn finish(
        self,
        options: &ReadOptions,
        tracks: &[Track],
        flights: bool,
        mut table: Table,
    ) -> Result<Table, TableError> {
        let what = describe(self.layout, self.columns, tracks, flights);
        let Self { region, columns, layout, trials, missing, aside, flights, .. } = self;
        table.notes.insert(0, format!("read as {what}"));
        table.notes.append(&mut columns.notes);
        table.warnings.append(&mut columns.warnings);
        table.left_aside.extend(region.aside.iter().cloned().chain(columns.aside.drain(..)).chain(aside));
        let column = columns.values().find(|(_, _, v)| v.what == What::Time).map_or(0, |(n, _, _)| n);
        let key = columns.number().map_or(column, |(n, _)| n);
        table.metadata.intervals |= !flights.is_empty();
        let summed_up = trials.into_iter().enumerate().map(|(n, t)| (flights.contains(&n), t));
        let (timed, plain): (Vec<_>, Vec<_>) = summed_up.partition(|(flown, _)| *flown);
        for (_, trial) in timed {
            let runs = renumbered(region, vec![trial], key, &mut table.repairs)?;
            for run in runs {
                table.trials.push(summed(region, run)?);
            }
        }
        let plain: Vec<Trial> = plain.into_iter().map(|(_, trial)| trial).collect();
        table.trials.extend(match layout {
            Layout::Numbered => renumbered(region, plain, key, &mut table.repairs)?,
            _ => plain,
        });
        if let Layout::Samples { .. } = layout {
            if !missing.is_empty() {
                table.repairs.push(format!("{}: no position here, left out", lines(&missing)));
            }
            samples::series(region, column, columns.unscaled, options, &mut table)?;
        }
        for trial in &mut table.trials {
            in_order(region, column, trial, matches!(layout, Layout::Listed))?;
        }
        percent(region, columns, &mut table)?;
        stray::warn(region, columns, &table.trials, &mut table.warnings);
        Ok(table)
    }
}

/// Heights in hundredths of the release: it is itself a hundred of them.
fn percent(region: &Region<'_>, columns: &Columns, table: &mut Table) -> Result<(), TableError> {
    let Some((index, column, _)) = columns.values().find(|(_, c, _)| c.unit.is_some_and(|u| u.scale == Scale::Percent))
    else {
        return Ok(());
    };
    for trial in &mut table.trials {
        let bounces: Vec<usize> = trial.readings.iter().map(|r| r.bounce).collect();
        match bounces.as_slice() {
            [0, ..] => {}
            [1] => trial
                .readings
                .insert(0, Reading { height: Some(1.0), ..Reading::new(Event::Release, 0, trial.readings[0].line) }),
            _ => {
                let name = shown(&column.heading.text);
                return Err(region
                    .header_error(
                        index,
                        format!("'{name}' holds hundredths: of the first height, or of the one before?"),
                    )
                    .question()
                    .help("give the row of the release, 100 %, or the heights themselves"));
            }
        }
    }
    Ok(())
}

fn faulty(fault: Fault) -> (&'static str, &'static str) {
    match fault {
        Fault::Comma => (
            "has a comma in a table separated by commas",
            "write a decimal point, or separate the cells by semicolons; write no separators of thousands",
        ),
        Fault::Thousands => ("is not a number", "write no separators of thousands"),
        Fault::NotFinite => ("is not a finite number", "take the row out"),
        Fault::Turned => ("says itself that it is no reading", "take it out, or the remark"),
        Fault::Bound => ("is a bound and no reading", "give what was read, or leave the cell empty"),
    }
}

fn event_of(region: &Region<'_>, row: usize, index: usize) -> Result<Event, TableError> {
    let cell = region.cell(row, index);
    Ok(match cell.to_lowercase().as_str() {
        "release" | "released" | "drop" | "dropped" | "start" => Event::Release,
        "contact" | "impact" | "bounce" | "floor" | "hit" | "touch" | "touchdown" | "ground" => Event::Contact,
        "apex" | "peak" | "top" | "rebound" | "max" | "maximum" => Event::Apex,
        "" => return Err(region.view.error(row, index, "the event is empty").help("write release, contact or apex")),
        _ => {
            let heading = Heading::parse(cell);
            let release = heading.has(Atom::Release) && heading.unknown.is_empty();
            let contact = heading.has(Atom::Impact) && !heading.has(Atom::After) && heading.unknown.is_empty();
            if release {
                return Ok(Event::Release);
            }
            if contact {
                return Ok(Event::Contact);
            }
            return Err(region
                .view
                .error(row, index, format!("the event '{}' is not known", shown(cell)))
                .help("write release (or drop), contact (or impact, bounce), or apex (or peak)"));
        }
    })
}

/// One line on what was recognised.
fn describe(layout: Layout, columns: &Columns, tracks: &[Track], flights: bool) -> String {
    let name = |index: usize| columns.columns[index].heading.text.as_str();
    let first = &tracks[0];
    let several = if tracks.len() > 1 { format!(", in {} columns side by side", tracks.len()) } else { String::new() };
    let (height, time) = (first.height.or(first.after).or(first.speed), first.time);
    let what = match layout {
        Layout::Events { .. } => "events (release, contact, apex)".to_owned(),
        Layout::Numbered | Layout::Listed => {
            let order = if layout == Layout::Numbered {
                "by number of bounces, 0 being the release"
            } else {
                "in order, the first being the release"
            };
            match (time, first.interval, height) {
                (Some(t), _, Some(h)) if !flights => {
                    format!("contact times '{}' and the heights reached after them '{}'", name(t), name(h))
                }
                (Some(t), _, None) if !flights => format!("contact times '{}'", name(t)),
                (t, i, None) => format!("times between contacts '{}'", t.or(i).map_or("", name)),
                (t, i, Some(h)) => match t.or(i) {
                    Some(i) => format!("heights '{}' and times between contacts '{}'", name(h), name(i)),
                    None => format!("heights '{}' {order}", name(h)),
                },
            }
        }
        Layout::Pairs => {
            match (first.release.or(first.before), height.or(first.lost).or(first.interval).or(first.total)) {
                (Some(a), Some(b)) => format!("drops, one a row: '{}' and '{}'", name(a), name(b)),
                _ => "drops, one a row".to_owned(),
            }
        }
        Layout::Wide => "one trial a row, one bounce a column".to_owned(),
        Layout::Samples { frames: false } => {
            format!("a series of heights '{}' in time '{}'", height.map_or("", name), time.map_or("", name))
        }
        Layout::Samples { frames: true } => format!("a series of heights '{}', a frame apart", height.map_or("", name)),
    };
    let speeds = columns.values().any(|(_, _, v)| v.what == What::Speed);
    let as_heights = if speeds { "; a speed v stands for the height v²/2g" } else { "" };
    format!("{what}{several}{as_heights}")
}
