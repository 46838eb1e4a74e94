//! From the bytes of a file to a table: what kind of file, which tables in it, their trials together.

use saltus_bounce::units::Quantity;

use super::export::{self, Recognised};
use super::header::Columns;
use super::layout::{self, Layout};
use super::sheet::{Grid, Sheet};
use super::text::text;
use super::workbook::{self, Content, Part};
use super::{Event, Metadata, ReadOptions, Reading, Table, pool};
use crate::error::TableError;

/// A track that moves less than this part of what the liveliest does is not the ball.
const MOVES: f64 = 0.5;

/// Reads `bytes` into a table that is not yet checked.
pub(super) fn table(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Table, TableError> {
    let mut table = match workbook::parts(name, bytes) {
        Some(parts) => sheets(name, parts?, options)?,
        None if options.sheet.is_some() => {
            return Err(TableError::new(name, "this file has no sheets: it is a text").help("leave out --sheet"));
        }
        None => {
            let found = text(name, bytes)?;
            let mut table = recognise(&Grid::open(name, None, &found.text)?, options)?.read(options)?;
            table.notes.extend(found.encoding.map(|encoding| format!("the text is encoded as {encoding}")));
            table
        }
    };
    table.name = name.to_owned();
    Ok(table)
}

/// The tables of one text, recognised but not yet read.
struct Tables<'a> {
    what: Option<&'static str>,
    tracks: bool,
    metadata: Metadata,
    tables: Vec<(Sheet<'a>, Columns, Layout)>,
}

fn recognise<'a>(grid: &'a Grid<'a>, options: &ReadOptions) -> Result<Tables<'a>, TableError> {
    let mut metadata = grid.metadata()?;
    metadata.frame_rate = options.fps.or(metadata.frame_rate);
    metadata.oriented = options.down.is_some();
    let Recognised { what, blocks, tracks } = export::blocks(grid, options, metadata.frame_rate)?;
    let mut tables = Vec::with_capacity(blocks.len());
    for block in blocks {
        let sheet = Sheet { grid, block };
        let columns = Columns::of(&sheet, options, metadata.frame_rate)?;
        let layout = layout::layout(&sheet, &columns, metadata.frame_rate)?;
        metadata.pixels |= columns.pixels;
        if columns.pixels && !matches!(layout, Layout::Samples { .. }) {
            return Err(sheet
                .error("these heights are in pixels, and nothing says how large one is")
                .help("give --scale, such as --scale 1.5mm for one pixel; only a series can be fitted without"));
        }
        tables.push((sheet, columns, layout));
    }
    Ok(Tables { what, tracks, metadata, tables })
}

impl Tables<'_> {
    fn read(self, options: &ReadOptions) -> Result<Table, TableError> {
        let name = self.tables.first().map_or("", |(sheet, ..)| sheet.grid.name).to_owned();
        let mut parts = Vec::new();
        for (sheet, columns, layout) in &self.tables {
            let table = layout::table(sheet, columns, *layout, options, self.metadata)?;
            parts.push((sheet.block.label.clone(), table));
        }
        let still = if self.tracks { leave_still(&mut parts) } else { Vec::new() };
        let mut table = pool::join(&name, parts)?;
        if !still.is_empty() {
            table.notes.push(format!("left aside, as it hardly moves: {} (choose with --column)", still.join(", ")));
        }
        if let Some(what) = self.what {
            table.notes.insert(0, format!("recognised as {what}"));
        }
        Ok(table)
    }
}

/// Takes out the tracks of things that stand still while the ball moves.
fn leave_still(parts: &mut Vec<(String, Table)>) -> Vec<String> {
    let travel = |table: &Table| {
        let heights = || table.trials.iter().flat_map(|t| &t.readings).filter_map(|r| r.height);
        heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min)
    };
    let most = parts.iter().map(|(_, table)| travel(table)).fold(0.0, f64::max);
    let mut still = Vec::new();
    parts.retain(|(label, table)| {
        let moves = travel(table) >= MOVES * most;
        if !moves {
            still.push(label.clone());
        }
        moves
    });
    still
}

/// The sheets of a workbook or the files of an archive that hold tables.
fn sheets(name: &str, parts: Vec<Part>, options: &ReadOptions) -> Result<Table, TableError> {
    let known: Vec<String> = parts.iter().map(|part| part.name.trim().to_owned()).collect();
    let wanted = |part: &Part| match &options.sheet {
        Some(sheet) => part.name.trim().eq_ignore_ascii_case(sheet.trim()) || stem(&part.name) == sheet.trim(),
        // phyphox' stopwatches write the same events three times; only here are they all.
        None => !known.iter().any(|n| stem(n) == "All") || stem(&part.name) == "All",
    };
    let mut found = Vec::new();
    let (mut aside, mut first) = (Vec::new(), None);
    for part in parts.into_iter().filter(wanted) {
        match sheet(name, &part, options)? {
            Ok(table) => found.push((part.name.trim().to_owned(), table)),
            Err(problem) => {
                aside.push(part.name.trim().to_owned());
                first = first.or(Some(problem));
            }
        }
    }
    if found.is_empty() {
        let none = || TableError::new(name, "there is no such sheet, or none at all");
        return Err(first.unwrap_or_else(|| none().help(format!("the file has {}", known.join(", ")))));
    }
    let several = found.len() > 1;
    let mut drops = false;
    for (label, table) in &mut found {
        drops |= drop_height(label, table);
        for trial in table.trials.iter_mut().filter(|_| several) {
            trial.setting = [label.as_str(), &trial.setting]
                .iter()
                .filter(|s| !s.is_empty())
                .copied()
                .collect::<Vec<_>>()
                .join(", ");
        }
    }
    let read = found.iter().map(|(label, _)| label.as_str()).collect::<Vec<_>>().join(", ");
    let mut table = pool::join(name, found)?;
    let what = if drops { " (each name the height of release)" } else { "" };
    table.notes.insert(0, format!("sheets read: {read}{what}"));
    if !aside.is_empty() {
        table.notes.insert(1, format!("sheets left aside, for they hold no table of bounces: {}", aside.join(", ")));
    }
    Ok(table)
}

/// One sheet: a table; the reason why it is none; or an error in a table that is one.
fn sheet(name: &str, part: &Part, options: &ReadOptions) -> Result<Result<Table, TableError>, TableError> {
    let inner = format!("{name}/{}", part.name);
    let decoded;
    let (name, tab, content) = match &part.content {
        Content::Cells(cells) => (name, Some(part.name.as_str()), cells.as_str()),
        Content::Bytes(bytes) => match text(&inner, bytes) {
            Ok(found) => {
                decoded = found;
                (inner.as_str(), None, &*decoded.text)
            }
            Err(problem) => return Ok(Err(problem)),
        },
    };
    let grid = match Grid::open(name, tab, content) {
        Ok(grid) => grid,
        Err(problem) => return Ok(Err(problem)),
    };
    match recognise(&grid, options) {
        Ok(tables) => tables.read(options).map(Ok),
        Err(problem) => Ok(Err(problem)),
    }
}

/// `All.csv` without folder and ending.
fn stem(name: &str) -> &str {
    let file = name.trim().rsplit('/').next().unwrap_or_default();
    file.rsplit_once('.').map_or(file, |(stem, _)| stem)
}

/// A sheet named `80 cm` holds drops from there.
fn drop_height(label: &str, table: &mut Table) -> bool {
    let Some(height) = Quantity::Length.parse(label).ok().filter(|h| *h > 0.0) else { return false };
    for trial in &mut table.trials {
        let line = trial.readings.first().map_or(1, |r| r.line);
        if trial.readings.iter().all(|r| r.event == Event::Contact || r.event == Event::Apex) {
            trial.readings.insert(0, Reading { height: Some(height), ..Reading::new(Event::Release, 0, line) });
        }
    }
    true
}
