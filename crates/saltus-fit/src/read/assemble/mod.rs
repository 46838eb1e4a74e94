//! From rows to trials.

mod cells;
mod rows;
mod stated;

use std::cell::OnceCell;
use std::collections::{HashMap, HashSet};

use super::aside::{LeftAside, Part, Why};
use super::columns::{Column, Columns, Kind};
use super::datum::Of;
use super::grid::shown;
use super::heading::{At, Role, What};
use super::lasting;
use super::layout::{Layout, Track, layout, tracks};
use super::order::{in_order, renumbered, rise, summed};
use super::region::Region;
use super::rows::{Row, Rows};
use super::samples;
use super::stray;
use super::units::{Scale, Unit};
use super::vocabulary::Atom;
use super::{Event, Metadata, ReadOptions, Reading, Table, Trial};
use crate::error::TableError;
use crate::finding::{Doubt, Lines, Note, Remark, Repair, Shape};

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
    /// Whether each column, of those that tell what was tried, tells groups apart.
    apart: Vec<bool>,
    /// The rows of the last cells that are not empty, by column: a merged cell leaves the next ones
    /// empty.
    merged: HashMap<usize, usize>,
    /// The lines of rows of a series without a position.
    missing: Vec<u64>,
    aside: Vec<LeftAside>,
    /// Whether most cells of a column are numbers, once one is met that holds words.
    mostly: Vec<OnceCell<bool>>,
    /// Trials whose times are those of the flights.
    flights: Vec<usize>,
    /// The times of rows are those of the tops beside them.
    tops: bool,
    /// The height of a row is the one that was reached after as many bounces as it counts.
    after: bool,
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
    let skipped = rows::filtered(region, &mut rows, options)?;
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
    let mut table = Table { metadata, ..Table::default() };
    table.metadata.pixels |= columns.unscaled;
    if skipped > 0 {
        table.notes.push(Note::Filtered { kept: rows.rows.len(), left_out: skipped }.into());
    }
    table.rows = rows.rows.len();
    table.notes.extend(rows.start.take().map(|name| Note::Start { name }.into()));
    if rows.rounded {
        table.repairs.push(Repair::RoundedNumbers.into());
    }
    let mut tracks = tracks(columns);
    let width = columns.columns.len();
    let mut builder = Builder {
        region,
        layout: Layout::Listed,
        tops: columns.of_tops(),
        keys: Vec::new(),
        settings: Vec::new(),
        apart: vec![true; columns.columns.len()],
        columns,
        trials: Vec::new(),
        index: HashMap::new(),
        merged: HashMap::new(),
        missing: Vec::new(),
        aside: rows.aside.clone(),
        mostly: vec![OnceCell::new(); width],
        flights: Vec::new(),
        after: false,
    };
    if builder.dropped(&rows, &mut tracks, metadata.drop)? {
        table.notes.push(Note::Dropped { height_m: metadata.drop.unwrap_or_default() }.into());
    }
    builder.layout = layout(region, builder.columns, &rows, &tracks)?;
    unscaled(region, builder.columns, builder.layout, options, &mut table.metadata)?;
    builder.after = builder.layout == Layout::Pairs && after(region, builder.columns, &rows)?;
    builder.keyed(&rows, tracks.len());
    if builder.layout == Layout::Pairs {
        builder.trials.reserve_exact(rows.rows.len());
    }
    let flights = builder.descending(&rows, &tracks)?;
    for (n, row) in rows.rows.iter().enumerate() {
        for track in &tracks {
            builder.row(n, row, track, flights)?;
        }
    }
    builder.wanting(&rows);
    let (region, columns) = (builder.region, builder.columns.clone());
    let mut table = builder.finish(options, &tracks, flights, table)?;
    stated::cors(region, &columns, &rows, &mut table.trials);
    if !options.groups.iter().any(|name| name.trim() == "-") {
        stated::beside(region, &columns, &rows, &mut table);
    }
    Ok(table)
}

/// Whether drops of their own count how many bounces lie before the height beside them: what only
/// numbers drops goes up by ones, and starts again at one.
fn after(region: &Region<'_>, columns: &Columns, rows: &Rows) -> Result<bool, TableError> {
    let Some((count, true)) = columns.number() else { return Ok(false) };
    let numbers: Option<Vec<usize>> = rows.rows.iter().map(|row| row.bounce.filter(|n| *n > 0)).collect();
    let Some(numbers) = numbers else { return Ok(false) };
    let goes_on = |pair: &[usize]| pair[1] == 1 || pair[1] == pair[0] || pair[1] == pair[0] + 1;
    let listed = numbers.first() == Some(&1) && numbers.windows(2).all(goes_on);
    let released = columns.values().any(|(_, c, v)| v.at == At::Release && c.heading.has(Atom::Release));
    let mut heights = columns.values().filter(|(_, _, v)| v.what == What::Height && v.at == At::Row);
    let Some((height, column, _)) = heights.next().filter(|_| !listed && released) else { return Ok(false) };
    // A rebound is the first, however often the ball bounced.
    if column.heading.has(Atom::After) || column.heading.has(Atom::Rebound) {
        return Ok(column.heading.has(Atom::After));
    }
    let (count, name) = (shown(&columns.columns[count].heading.text), shown(&column.heading.text));
    let message = format!("'{count}' counts no rows: was '{name}' reached after so many bounces?");
    let help = format!("call it 'height after n bounces (cm)' if it was; leave '{count}' out by --header if not");
    Err(region.header_error(height, message).question().help(help))
}

/// A row that tells where the floor is gives every scale of heights its zero, and its direction.
fn floor(region: &Region<'_>, columns: &mut Columns, rows: &Rows, options: &ReadOptions) -> Result<(), TableError> {
    let touched = rows.floor.or_else(|| touched(region, columns, rows).filter(|_| options.zero.is_none()));
    let stated = region.zero.as_ref().filter(|_| options.zero.is_none());
    let first = |column: usize| rows.rows.iter().find_map(|row| region.view.number(row.at, column));
    let (text, down) = match (touched, stated) {
        (Some((row, column)), _) => {
            let (Some(zero), Some(first)) = (region.view.number(row, column), first(column)) else {
                let error = region.view.error(row, column, "the floor is no number");
                return Err(error.help("write what the scale reads there"));
            };
            let down = options.down.unwrap_or(zero > first);
            for c in columns.columns.iter_mut().filter(|c| c.holds(What::Height)) {
                c.zero = options.zero.unwrap_or(zero);
                c.sign = if down { -1.0 } else { 1.0 };
            }
            (region.cell(row, column).to_owned(), down)
        }
        (None, Some(zero)) => {
            let heights: Vec<(usize, f64)> = columns
                .values()
                .filter(|(_, _, v)| v.what == What::Height && !matches!(v.role, Role::Error | Role::Lost))
                .filter(|(_, _, v)| zero.of == Of::All || (zero.of == Of::Releases) == (v.at == At::Release))
                .filter_map(|(n, c, _)| Some((n, zero.on(c.unit)?)))
                .collect();
            let Some(&(column, at)) = heights.first() else { return Ok(()) };
            let down = options.down.unwrap_or(first(column).is_some_and(|first| at > first));
            for (n, at) in heights {
                (columns.columns[n].zero, columns.columns[n].sign) = (at, if down { -1.0 } else { 1.0 });
            }
            (zero.text.clone(), down)
        }
        (None, None) => return Ok(()),
    };
    columns.notes.push(Note::Floor { reading: text, down });
    Ok(())
}

/// Where the ball touches the floor a place on a scale is that of the floor: the first of those
/// rows, and the column, where all of them read the same.
fn touched(region: &Region<'_>, columns: &Columns, rows: &Rows) -> Option<(usize, usize)> {
    let named = columns.one(&Kind::Event)?;
    let (column, _, _) = columns.values().find(|(_, _, v)| v.what == What::Height && v.position)?;
    let contact = |row: &&Row| super::named::event(region.cell(row.at, named)) == Some(Event::Contact);
    let mut contacts = rows.rows.iter().filter(contact).filter(|row| region.view.is_number(row.at, column));
    let first = contacts.next()?;
    contacts.all(|row| region.cell(row.at, column) == region.cell(first.at, column)).then_some((first.at, column))
}

/// Heights without a scale: places on a picture need a zero, and a pixel is the error of reading
/// one.
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
    let pixels = |unit: Option<Unit>| unit.is_some_and(|u| u.scale == Scale::Pixels && u != Unit::SPEED);
    let place = columns.values().find(|(_, c, v)| {
        pixels(c.unit) && v.position && c.zero == 0.0 && options.zero.is_none() && region.zero.is_none()
    });
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
    fn keyed(&mut self, rows: &Rows, tracks: usize) {
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
        // A condition that is measured, such as a temperature, tells groups apart where its values
        // repeat, or stand beside several trials.
        let trials = match self.layout {
            Layout::Pairs | Layout::Wide => rows.rows.len(),
            _ => rows.rows.iter().map(|row| self.key(row)).collect::<HashSet<String>>().len(),
        };
        for n in self.settings.clone().into_iter().filter(|n| self.columns.columns[*n].heading.unit.is_some()) {
            let cells = rows.rows.iter().map(|row| self.region.cell(row.at, n)).filter(|cell| !cell.is_empty());
            self.apart[n] = trials * tracks >= 2 * cells.collect::<HashSet<&str>>().len();
        }
        if let Layout::Samples { .. } = self.layout {
            // What is another in every row counts the samples.
            let counts = |n: usize| {
                let cells: HashSet<&str> = rows.rows.iter().map(|row| self.region.cell(row.at, n)).collect();
                rows.rows.len() > 2 && cells.len() == rows.rows.len()
            };
            let keys: Vec<usize> = self.keys.iter().copied().filter(|&n| !counts(n)).collect();
            self.settings.retain(|n| keys.contains(n));
            self.keys = keys;
        }
        let sure = self.columns.number().is_none_or(|(_, sure)| sure);
        if !sure
            && matches!(self.layout, Layout::Pairs | Layout::Wide)
            && let Some((n, _)) = self.columns.number()
        {
            self.keys.insert(0, n);
        }
    }

    /// Whether a column of times holds those of flights: within each trial they fall, as the times
    /// of contacts cannot.
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
            self.columns.notes.push(Note::FallingTimes);
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
        self.region.cell(self.spanning(row, column), column)
    }

    /// The row of a cell, or of the merged cell that it is part of.
    fn spanning(&self, row: usize, column: usize) -> usize {
        if self.region.cell(row, column).is_empty() { self.merged.get(&column).copied().unwrap_or(row) } else { row }
    }

    /// What remains to be done once all rows are read.
    fn finish(
        self,
        options: &ReadOptions,
        tracks: &[Track],
        flights: bool,
        mut table: Table,
    ) -> Result<Table, TableError> {
        let what = read_as(self.layout, self.columns, tracks, flights);
        let Self { region, columns, layout, mut trials, missing, aside, flights, .. } = self;
        let touches = layout == (Layout::Samples { frames: false }) && samples::touches(&mut trials);
        let what = if touches {
            Note::ReadAs { shape: Shape::Events, side_by_side: tracks.len(), speeds: false }
        } else {
            what
        };
        table.notes.insert(0, what.into());
        table.notes.extend(columns.notes.drain(..).map(Remark::from));
        table.warnings.extend(columns.warnings.drain(..).map(Remark::from));
        table.left_aside.extend(region.aside.iter().cloned().chain(columns.aside.drain(..)).chain(aside));
        let column = columns.values().find(|(_, _, v)| v.what == What::Time).map_or(0, |(n, _, _)| n);
        let key = columns.number().map_or(column, |(n, _)| n);
        table.metadata.intervals |= !flights.is_empty();
        let mut place = 0..;
        let mut flown = |_: &Trial| place.next().is_some_and(|n| flights.contains(&n));
        let (timed, plain): (Vec<_>, Vec<_>) =
            if flights.is_empty() { (Vec::new(), trials) } else { trials.into_iter().partition(|t| flown(t)) };
        for trial in timed {
            let runs = renumbered(region, vec![trial], key, &mut table.repairs)?;
            for run in runs {
                table.trials.push(summed(region, run)?);
            }
        }
        let plain = match layout {
            Layout::Numbered => renumbered(region, plain, key, &mut table.repairs)?,
            _ => plain,
        };
        // Of many drops one list is enough.
        if table.trials.is_empty() {
            table.trials = plain;
        } else {
            table.trials.extend(plain);
        }
        if let Layout::Samples { .. } = layout
            && !touches
        {
            if !missing.is_empty() {
                table.repairs.push(Repair::NoPosition { lines: Lines::of(&missing) }.into());
            }
            samples::series(region, column, columns.unscaled, options, &mut table)?;
        }
        for trial in &mut table.trials {
            let unresolved = in_order(region, column, trial, matches!(layout, Layout::Listed))?;
            let name = columns.columns.get(column).map_or_else(String::new, |c| shown(&c.heading.text));
            let left = |line| LeftAside::new(Part::Cell, name.as_str(), Why::Unresolved).at(line);
            table.left_aside.extend(unresolved.into_iter().map(left));
        }
        lasting::taken_off(region, columns, &mut table);
        percent(region, columns, &mut table)?;
        energies(columns, &mut table.trials);
        stray::warn(region, columns, &table.trials, &mut table.warnings);
        if layout == Layout::Listed && table.trials.len() > 1 {
            let against = table.trials.iter().find(|trial| rise(trial));
            table.doubts.extend(against.map(|trial| Doubt::Order { trial: shown(&trial.label) }));
        }
        Ok(table)
    }
}

/// Heights in hundredths of the release: it is itself a hundred of them.
fn percent(region: &Region<'_>, columns: &Columns, table: &mut Table) -> Result<(), TableError> {
    let part = |unit: Unit| matches!(unit.scale, Scale::Percent | Scale::Whole);
    let Some((index, column, _)) = columns.values().find(|(_, c, _)| c.unit.is_some_and(part)) else {
        return Ok(());
    };
    let of_release = column.unit == Some(Unit::WHOLE);
    for trial in &mut table.trials {
        let bounces: Vec<usize> = trial.readings.iter().map(|r| r.bounce).collect();
        match bounces.as_slice() {
            [0, ..] => {}
            [1, more @ ..] if more.is_empty() || of_release => trial
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

/// Energies as heights, and times at a gate as speeds: of each group, whose mass is one, the
/// largest counts as a metre.
fn energies(columns: &Columns, trials: &mut [Trial]) {
    let energy = |c: &Column| c.unit.is_some_and(|unit| matches!(unit.scale, Scale::Energy { .. }));
    if !columns.values().any(|(_, c, _)| energy(c) || c.turned) {
        return;
    }
    let mut most: HashMap<String, f64> = HashMap::new();
    for trial in &*trials {
        let own = trial.readings.iter().filter_map(|r| r.height).fold(0.0, f64::max);
        let largest = most.entry(trial.group.clone()).or_default();
        *largest = largest.max(own);
    }
    for trial in trials {
        let Some(&largest) = most.get(&trial.group).filter(|largest| **largest > 0.0) else { continue };
        for reading in &mut trial.readings {
            reading.height = reading.height.map(|height| height / largest);
            reading.sigma_height = reading.sigma_height.map(|sigma| sigma / largest);
        }
    }
}

/// What the columns were taken for.
fn read_as(layout: Layout, columns: &Columns, tracks: &[Track], flights: bool) -> Note {
    let name = |index: usize| columns.columns[index].heading.text.clone();
    let first = &tracks[0];
    let (height, time) = (first.height.or(first.after).or(first.speed), first.time);
    let shape = match layout {
        Layout::Events { .. } => Shape::Events,
        Layout::Numbered | Layout::Listed => match (time, first.interval, height) {
            (Some(t), _, Some(h)) if !flights && columns.of_tops() => Shape::Tops { times: name(t), heights: name(h) },
            (Some(t), _, Some(h)) if !flights => Shape::ContactsAndHeights { times: name(t), heights: name(h) },
            (Some(t), _, None) if !flights => Shape::Contacts { times: name(t) },
            (t, i, None) => Shape::Intervals { intervals: t.or(i).map_or_else(String::new, name) },
            (t, i, Some(h)) => match t.or(i) {
                Some(i) => Shape::IntervalsAndHeights { intervals: name(i), heights: name(h) },
                None => Shape::Heights { heights: name(h), numbered: layout == Layout::Numbered },
            },
        },
        Layout::Pairs => {
            let rebound = height.or(first.lost).or(first.share).or(first.interval).or(first.total);
            Shape::Drops { release: first.release.or(first.before).map(name), rebound: rebound.map(name) }
        }
        Layout::Wide => Shape::Wide,
        Layout::Samples { frames } => {
            let times = time.filter(|_| !frames).map_or_else(String::new, name);
            Shape::Series { heights: height.map_or_else(String::new, name), times: (!frames).then_some(times) }
        }
    };
    let speeds = columns.values().any(|(_, _, v)| v.what == What::Speed);
    Note::ReadAs { shape, side_by_side: tracks.len(), speeds }
}
