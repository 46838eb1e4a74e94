//! Which program wrote a text, and where in it the tables lie: Tracker, `ImageJ`, Vernier, runs side by side, bare numbers.

use std::collections::HashSet;
use std::ops::Range;

use super::ReadOptions;
use super::heading::{Line, heading};
use super::sheet::{Grid, Row};
use crate::error::TableError;

/// One table of a text: where its rows lie and what its columns are called.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    /// What tells it from the other tables of the text.
    pub(super) label: String,
    /// A name for each column; a column without one is not part of this table.
    pub(super) header: Vec<String>,
    /// Where the names stand: byte and line.
    pub(super) header_at: (usize, u64),
    pub(super) rows: Range<usize>,
    /// The number of the first line of `rows`.
    pub(super) line: u64,
    /// The units of times and heights, where neither header nor options name one.
    pub(super) units: (Option<&'static str>, Option<&'static str>),
    /// Rows are frames, and no column counts them.
    pub(super) frames: bool,
    /// The columns were chosen here, `--column` heeded.
    pub(super) chosen: bool,
    /// The line of the first remark below the rows.
    pub(super) remarks: Option<u64>,
}

/// The tables of a text, and what they are.
pub(super) struct Recognised {
    /// The program, or what else there is to say about where it comes from.
    pub(super) what: Option<&'static str>,
    pub(super) blocks: Vec<Block>,
    /// The blocks are tracks of one film: the ball is what moves.
    pub(super) tracks: bool,
}

/// A record of the head of a text.
struct Record {
    cells: Vec<String>,
    /// Every cell that is not empty is a number.
    numbers: bool,
    /// Some cell is.
    any: bool,
    at: (usize, u64),
}

impl Record {
    fn of(row: &Row<'_>) -> Self {
        let cells: Vec<String> = row.cells().map(str::to_owned).collect();
        let numbers = cells.iter().enumerate().all(|(n, cell)| cell.is_empty() || row.is_number(n));
        let any = (0..cells.len()).any(|n| row.is_number(n));
        Self { cells, numbers, any, at: (row.start, row.line) }
    }

    fn position(&self, name: &str) -> Option<usize> {
        self.cells.iter().position(|cell| cell.eq_ignore_ascii_case(name))
    }
}

/// A label of a contact spans no more than this, s.
const LABEL: f64 = 0.2;

/// Records of the head that are looked at.
const HEAD: usize = 16;

/// Recognises the tables of a text; `fps` is the frame rate, by an option or a comment.
pub(super) fn blocks(grid: &Grid<'_>, options: &ReadOptions, fps: Option<f64>) -> Result<Recognised, TableError> {
    let head = records(grid, 0, 1, HEAD)?;
    let Some(first) = head.first() else {
        return Err(TableError::new(grid.name, "the file is empty").help("give a table"));
    };
    let one = |block| Ok(Recognised { what: None, blocks: vec![block], tracks: false });
    if let Some(names) = &options.header {
        let at = if first.any { first.at } else { head.get(1).map_or((grid.text.len(), 1), |r| r.at) };
        let header = names.iter().map(|name| if name == "-" { String::new() } else { name.clone() }).collect();
        return one(Block { header, ..below(grid, first.at, at) });
    }
    if first.cells[0].to_lowercase().starts_with("vernier format") {
        return vernier(grid);
    }
    if first.cells[0].eq_ignore_ascii_case("frame") && first.position("y1").is_some() {
        return imagej(grid, &head, options);
    }
    if let Some(found) = tracker(grid, &head, options) {
        return Ok(found);
    }
    if let Some(block) = labels(grid, &head) {
        return Ok(Recognised { what: Some("a track of labels (s)"), blocks: vec![block], tracks: false });
    }
    if first.numbers {
        return one(bare(grid, first, options, fps)?);
    }
    let lines: Vec<Line<'_>> = head.iter().map(|record| (record.cells.as_slice(), record.any)).collect();
    let (names, header, rows) = heading(&lines);
    let at = head.get(rows).map_or((grid.text.len(), head[header].at.1), |r| r.at);
    let mut block = Block { header: names, ..below(grid, head[header].at, at) };
    leave_remarks(grid, &mut block)?;
    Ok(side_by_side(&block).unwrap_or(Recognised { what: None, blocks: vec![block], tracks: false }))
}

/// A track of labels as Audacity writes it, `start, end, text` a line without a header: the labels stand at the contacts.
fn labels(grid: &Grid<'_>, head: &[Record]) -> Option<Block> {
    let number = |record: &Record, n: usize| record.cells[n].replace(',', ".").parse::<f64>().ok();
    let label = |record: &Record| {
        record.cells.len() == 3
            && (record.cells[2].is_empty() || record.cells[2].starts_with(char::is_alphabetic))
            && number(record, 0).zip(number(record, 1)).is_some_and(|(start, end)| start <= end && end - start < LABEL)
    };
    let first = head.first().filter(|_| grid.delimiter == b'\t' && head.len() > 2 && head.iter().all(label))?;
    let header = vec!["time_s".to_owned(), String::new(), String::new()];
    Some(Block { header, ..below(grid, first.at, first.at) })
}

/// Ends the rows before the sentences below them: `Mean ratio: 0.64`.
fn leave_remarks(grid: &Grid<'_>, block: &mut Block) -> Result<(), TableError> {
    let mut end = None;
    grid.each_record(block.rows.clone(), block.line, |row| {
        let text = row.cell(0);
        let words = (0..row.cells().count()).all(|n| !row.is_number(n));
        let sentence = text.starts_with(char::is_alphabetic) && text.contains(char::is_whitespace);
        end = if words && sentence { end.or(Some((row.start, row.line))) } else { None };
        Ok(true)
    })?;
    if let Some((start, line)) = end.filter(|end| end.0 > block.rows.start) {
        (block.rows.end, block.remarks) = (start, Some(line));
    }
    Ok(())
}

/// The records from byte `start` in line `line` on, up to `most`.
fn records(grid: &Grid<'_>, start: usize, line: u64, most: usize) -> Result<Vec<Record>, TableError> {
    let mut found = Vec::new();
    grid.each_record(start..grid.text.len(), line, |row| {
        found.push(Record::of(row));
        Ok(found.len() < most)
    })?;
    Ok(found)
}

/// A table from `at` to the end of the text.
fn below(grid: &Grid<'_>, header_at: (usize, u64), at: (usize, u64)) -> Block {
    Block { header_at, rows: at.0..grid.text.len(), line: at.1, ..Block::default() }
}

/// `Frame X1 Y1 Flag1 X2 Y2 Flag2`, a line `Tracks 1 to 2`, frames, and a summary below them.
fn imagej(grid: &Grid<'_>, head: &[Record], options: &ReadOptions) -> Result<Recognised, TableError> {
    let first = &head[0];
    let skip = 1 + usize::from(head.get(1).is_some_and(|r| r.cells[0].to_lowercase().starts_with("tracks")));
    let start = head.get(skip).map_or((grid.text.len(), first.at.1), |r| r.at);
    let mut end = grid.text.len();
    grid.each_record(start.0..grid.text.len(), start.1, |row| {
        let frame = row.is_number(0);
        if !frame {
            end = row.start;
        }
        Ok(frame)
    })?;
    let blocks = (1..)
        .map_while(|n| first.position(&format!("y{n}")).map(|index| (n, index)))
        .filter(|(n, _)| options.column.as_ref().is_none_or(|name| name.eq_ignore_ascii_case(&format!("y{n}"))))
        .map(|(n, index)| Block {
            label: format!("track {n}"),
            header: picked(&first.cells, &[(0, "frame"), (index, "y")]),
            units: (None, Some("px")),
            chosen: true,
            rows: start.0..end,
            ..below(grid, first.at, start)
        })
        .collect::<Vec<_>>();
    if blocks.is_empty() {
        let name = options.column.as_deref().unwrap_or_default();
        return Err(TableError::new(grid.name, format!("there is no track '{name}'"))
            .help(format!("the file has {}", first.cells.join(", "))));
    }
    Ok(Recognised { what: Some("ImageJ tracks"), blocks, tracks: true })
}

/// Names for the columns `chosen`, and none for the others.
fn picked(cells: &[String], chosen: &[(usize, &str)]) -> Vec<String> {
    let name = |n| chosen.iter().find(|(index, _)| *index == n).map_or(String::new(), |(_, name)| (*name).to_owned());
    (0..cells.len()).map(name).collect()
}

/// A line of track names (not always), then `t x y ...` in any order, `x y ...` again for every further track.
fn tracker(grid: &Grid<'_>, head: &[Record], options: &ReadOptions) -> Option<Recognised> {
    let at = head.iter().take(3).position(|r| r.cells[0] == "t" && r.cells.iter().any(|cell| cell == "y"))?;
    let header = &head[at];
    // By itself `t,x,y` may be anybody's; a tab or a line of names above it is Tracker's hand.
    if head[..at].iter().any(|r| r.numbers) || (at == 0 && grid.delimiter != b'\t') {
        return None;
    }
    let titles = at.checked_sub(1).map_or(&[][..], |above| &head[above].cells[..]);
    let mut starts: Vec<(usize, String)> =
        titles.iter().enumerate().filter(|(_, t)| !t.is_empty()).map(|(n, t)| (n.max(1), t.clone())).collect();
    if starts.is_empty() {
        starts.push((1, String::new()));
    }
    let rows = head.get(at + 1).map_or((grid.text.len(), header.at.1), |r| r.at);
    let wanted = options.column.as_deref().map(str::trim);
    let track = |(n, (start, label)): (usize, &(usize, String))| {
        let end = starts.get(n + 1).map_or(header.cells.len(), |(next, _)| *next).min(header.cells.len());
        let find = |name: &str| (*start..end).find(|&n| header.cells[n].eq_ignore_ascii_case(name));
        let named = wanted.is_some_and(|name| name.eq_ignore_ascii_case(label));
        let index = if named { find("y") } else { wanted.map_or(find("y"), find) }?;
        let block = Block {
            label: label.clone(),
            header: picked(&header.cells, &[(0, "t"), (index, "y")]),
            units: (Some("s"), Some("m")),
            chosen: true,
            ..below(grid, header.at, rows)
        };
        Some((named, block))
    };
    let found: Vec<(bool, Block)> = starts.iter().enumerate().filter_map(track).collect();
    let named = found.iter().any(|(named, _)| *named);
    let blocks: Vec<Block> = found.into_iter().filter(|(own, _)| *own || !named).map(|(_, block)| block).collect();
    (!blocks.is_empty()).then_some(Recognised { what: Some("a Tracker export (s, m)"), blocks, tracks: true })
}

/// Data sets below one another: a line of the format, one of the source, one of the name; then long names, short names (not
/// always), units; then rows up to one of zeros or the next data set.
fn vernier(grid: &Grid<'_>) -> Result<Recognised, TableError> {
    let mut blocks: Vec<Block> = Vec::new();
    // The lines since the last data set began, and whether its rows have begun.
    let (mut head, mut rows): (Vec<Record>, bool) = (Vec::new(), false);
    grid.each_record(0..grid.text.len(), 1, |row| {
        let begins = row.cell(0).to_lowercase().starts_with("vernier format");
        let record = Record::of(row);
        let end = record.at.0;
        if begins || !rows && !record.numbers {
            if begins
                && rows
                && let Some(block) = blocks.last_mut()
            {
                block.rows.end = block.rows.end.min(end);
            }
            if begins {
                (rows, head) = (false, Vec::new());
            }
            head.push(record);
            return Ok(true);
        }
        let zeros = row.cells().all(|cell| cell.parse() == Ok(0.0)) && row.cells().count() > 1;
        if rows
            && zeros
            && let Some(block) = blocks.last_mut()
        {
            block.rows.end = block.rows.end.min(end);
        }
        if !rows {
            rows = true;
            let (Some(names), Some(units)) = (head.get(3), head.last()) else {
                return Err(row.error(0, "numbers before the names of their columns").help(VERNIER));
            };
            let header = names.cells.iter().enumerate().map(|(n, name)| {
                let unit = units.cells.get(n).filter(|u| head.len() > 4 && !u.is_empty());
                unit.map_or(name.clone(), |unit| format!("{name} ({unit})"))
            });
            blocks.push(Block {
                label: head.get(2).map_or(String::new(), |r| r.cells.join(" ").trim().to_owned()),
                header: header.collect(),
                ..below(grid, names.at, record.at)
            });
        }
        Ok(true)
    })?;
    if blocks.is_empty() {
        return Err(TableError::new(grid.name, "this Vernier file holds no readings").help(VERNIER));
    }
    if blocks.len() > 1 {
        distinct(&mut blocks);
    }
    Ok(Recognised { what: Some("a Vernier text"), blocks, tracks: false })
}

const VERNIER: &str =
    "its lines are: Vernier Format 2, source, name, column names, short names, units, a blank line, rows";

/// Data sets of the same name are told apart by number.
fn distinct(blocks: &mut [Block]) {
    let names: HashSet<&str> = blocks.iter().map(|b| b.label.as_str()).collect();
    if names.len() < blocks.len() {
        for (n, block) in blocks.iter_mut().enumerate() {
            block.label = format!("run {}", n + 1);
        }
    }
}

/// Runs side by side: `Run 1: Time (s)`, `Run 2: Time (s)`; or the same names again after a blank column.
fn side_by_side(block: &Block) -> Option<Recognised> {
    let header = &block.header;
    let run = |cell: &str| cell.split_once(':').map_or(String::new(), |(run, _)| run.trim().to_owned());
    let mut runs: Vec<String> = Vec::new();
    for name in header.iter().map(|cell| run(cell)) {
        if !name.is_empty() && !runs.contains(&name) {
            runs.push(name);
        }
    }
    let part = |label: String, mine: &dyn Fn(usize) -> bool| Block {
        label,
        header: header.iter().enumerate().map(|(n, c)| if mine(n) { c.clone() } else { String::new() }).collect(),
        ..block.clone()
    };
    if runs.len() > 1 {
        let blocks = runs.iter().map(|name| {
            part(name.clone(), &|n| {
                let own = run(&header[n]);
                own.is_empty() || own == *name
            })
        });
        return Some(Recognised { what: Some("runs side by side"), blocks: blocks.collect(), tracks: false });
    }
    let mut groups: Vec<Range<usize>> = Vec::new();
    for (n, cell) in header.iter().enumerate().filter(|(_, cell)| !cell.is_empty()) {
        match groups.last_mut().filter(|group| group.end == n) {
            Some(group) => group.end += 1,
            None => groups.push(n..n + 1),
        }
        if cell.is_empty() {
            return None;
        }
    }
    let first = groups.first()?.clone();
    let same = groups.iter().all(|group| header[group.clone()] == header[first.clone()]);
    if groups.len() < 2 || !same {
        return None;
    }
    let blocks = groups.iter().enumerate().map(|(n, group)| part(format!("run {}", n + 1), &|c| group.contains(&c)));
    Some(Recognised { what: Some("runs side by side"), blocks: blocks.collect(), tracks: false })
}

/// Numbers without names: a list, if the options say of what; a track of pixels, if they say how many frames a second.
fn bare(grid: &Grid<'_>, first: &Record, options: &ReadOptions, fps: Option<f64>) -> Result<Block, TableError> {
    let block = below(grid, first.at, first.at);
    let width = first.cells.iter().rposition(|cell| !cell.is_empty()).map_or(1, |last| last + 1);
    let listed = options.height_unit.as_deref().is_some_and(|unit| unit != "px") || options.time_unit.is_some();
    let name = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
    if width == 1 && (options.fps.is_none() || listed) {
        let kind = match (&options.height_unit, &options.time_unit) {
            (Some(_), None) => "height",
            (None, Some(_)) => "time",
            _ => {
                return Err(grid
                    .error(first.at.0, first.at.1, 0, "the list has no header: are these heights or times, and in which unit?")
                    .help("put a name above it, such as 'height_cm' or 'time_s', or give either --height-unit cm or --time-unit s"));
            }
        };
        return Ok(Block { header: name(&[kind]), ..block });
    }
    // A first column that ascends counts frames, or seconds.
    let (mut ascends, mut whole, mut last) = (width > 1, true, f64::NEG_INFINITY);
    grid.each_record(block.rows.clone(), block.line, |row| {
        let value = row.number(0).ok().flatten().unwrap_or(f64::NAN);
        ascends &= value > last;
        whole &= value.fract() == 0.0;
        last = value;
        Ok(ascends)
    })?;
    if fps.is_none() && !(ascends && !whole && width == 3) {
        return Err(grid.error(first.at.0, first.at.1, 0, "the table has no header: its first line is numbers").help(
            "name the columns, such as --header bounce,height_cm or --header time_s,height_m; \
                 for a track of pixels give the frames a second, such as --fps 100",
        ));
    }
    let clock = if whole { "frame" } else { "time" };
    let (names, frames): (&[&str], bool) = match (width, ascends) {
        (1, _) => (&["y"], true),
        (2, true) => (&[clock, "y"], false),
        (_, true) => (&[clock, "x", "y"], false),
        (_, false) => (&["x", "y"], true),
    };
    let mut header: Vec<String> = name(names);
    header.resize(first.cells.len().max(header.len()), String::new());
    Ok(Block { header, frames, units: (Some("s"), Some("px")), ..block })
}
