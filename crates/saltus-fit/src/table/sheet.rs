//! From text to rows: delimiter, comments, and the place of every cell for messages.

use std::ops::Range;

use csv::{ReaderBuilder, StringRecord};
use saltus_bounce::units::Quantity;

use super::Metadata;
use super::export::Block;
use crate::error::{Place, TableError};

/// A text of cells.
pub(super) struct Grid<'a> {
    pub(super) name: &'a str,
    /// The sheet of a workbook it was; its cells are then named as a spreadsheet names them.
    pub(super) tab: Option<&'a str>,
    pub(super) text: &'a str,
    pub(super) delimiter: u8,
}

/// One table in a grid.
pub(super) struct Sheet<'a> {
    pub(super) grid: &'a Grid<'a>,
    pub(super) block: Block,
}

/// One record with the place it starts at.
pub(super) struct Row<'a> {
    grid: &'a Grid<'a>,
    record: &'a StringRecord,
    pub(super) start: usize,
    /// The line of the file, counted from 1.
    pub(super) line: u64,
}

impl<'a> Grid<'a> {
    pub(super) fn open(name: &'a str, tab: Option<&'a str>, text: &'a str) -> Result<Self, TableError> {
        let mut lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#')).peekable();
        if lines.peek().is_none() {
            let what = if text.trim().is_empty() { "the file is empty" } else { "the file holds comments only" };
            return Err(
                TableError::new(name, what).help("the first line names the columns, such as 'bounce,height_cm'")
            );
        }
        let delimiter = if tab.is_some() { b'\t' } else { delimiter(lines.take(20)) };
        Ok(Self { name, tab, text, delimiter })
    }

    /// Whether a comma may stand for the decimal point.
    pub(super) fn decimal_comma(&self) -> bool {
        self.delimiter != b','
    }

    /// Calls `visit` for every record of `span` that holds anything, until it answers `false`; `line` is the number of its first line.
    pub(super) fn each_record(
        &self,
        span: Range<usize>,
        line: u64,
        mut visit: impl FnMut(&Row<'_>) -> Result<bool, TableError>,
    ) -> Result<(), TableError> {
        let mut reader = ReaderBuilder::new()
            .delimiter(self.delimiter)
            .comment(Some(b'#'))
            .flexible(true)
            .has_headers(false)
            .trim(csv::Trim::All)
            .from_reader(self.text.get(span.clone()).unwrap_or_default().as_bytes());
        let mut record = StringRecord::new();
        loop {
            let more = reader
                .read_record(&mut record)
                .map_err(|error| TableError::new(self.name, format!("this is not a table: {error}")))?;
            if !more {
                return Ok(());
            }
            let byte = |p: &csv::Position| span.start as u64 + p.byte();
            let (start, line) =
                record.position().map_or((0, 1), |p| self.record_start(byte(p), line.saturating_sub(1) + p.line()));
            let row = Row { grid: self, record: &record, start, line };
            if record.iter().any(|cell| !cell.is_empty()) && !visit(&row)? {
                return Ok(());
            }
        }
    }

    /// An error at cell `index` of the record that starts at `start` in line `line`.
    pub(super) fn error(&self, start: usize, line: u64, index: usize, message: impl Into<String>) -> TableError {
        TableError::new(self.name, message).at(self.place(start, line, index))
    }

    /// The reader's position precedes the blank lines and comments it skips: go past them.
    fn record_start(&self, byte: u64, mut line: u64) -> (usize, u64) {
        let bytes = self.text.as_bytes();
        let mut at = usize::try_from(byte).unwrap_or(usize::MAX).min(bytes.len());
        while let Some(&byte) = bytes.get(at) {
            match byte {
                b'\n' => line += 1,
                b'\r' => {}
                b'#' => at = bytes[at..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |n| at + n - 1),
                _ => break,
            }
            at += 1;
        }
        (at, line)
    }

    /// Where cell `index` of the record that starts at `start` in line `line` stands.
    fn place(&self, start: usize, line: u64, index: usize) -> Place {
        let (mut cell, mut quoted, mut line) = (0, false, line);
        let (mut line_start, mut from, mut to) = (start, start, self.text.len());
        for (at, byte) in self.text.bytes().enumerate().skip(start) {
            match byte {
                b'"' => quoted = !quoted,
                b'\n' | b'\r' if !quoted => {
                    to = at;
                    break;
                }
                b'\n' if cell < index => (line, line_start) = (line + 1, at + 1),
                byte if byte == self.delimiter && !quoted => {
                    if cell == index {
                        to = at;
                        break;
                    }
                    cell += 1;
                    from = at + 1;
                }
                _ => {}
            }
        }
        if cell < index {
            from = to;
        }
        let raw = self.text.get(from..to).unwrap_or("");
        let inner = raw.trim();
        let from = from + (raw.len() - raw.trim_start().len());
        let line_end = self.text[line_start..].find(['\n', '\r']).map_or(self.text.len(), |n| line_start + n);
        let before = self.text.get(line_start..from.max(line_start)).unwrap_or("");
        Place {
            line,
            column: before.chars().count() + 1,
            width: inner.lines().next().map_or(0, |l| l.chars().count()).max(1),
            text: self.text.get(line_start..line_end).unwrap_or("").to_owned(),
            cell: self.tab.map(|tab| (tab.to_owned(), index)),
        }
    }

    /// The metadata comments: `# frame rate: 30`, `# gravity: 9.8 m/s^2`, `# sigma height: 1 cm`, `# sigma time: 5 ms`.
    pub(super) fn metadata(&self) -> Result<Metadata, TableError> {
        let mut found = Metadata::default();
        if !self.text.contains('#') {
            return Ok(found);
        }
        for (n, line) in self.text.lines().enumerate() {
            let Some((key, value)) = line.strip_prefix('#').and_then(|comment| comment.split_once(':')) else {
                continue;
            };
            let value = value.trim();
            let error = |message: String| {
                let column = line.len() - line.trim_end().len();
                let start = line.len() - column - value.len();
                TableError::new(self.name, message).at(Place {
                    line: n as u64 + 1,
                    column: line[..start].chars().count() + 1,
                    width: value.chars().count().max(1),
                    text: line.to_owned(),
                    cell: self.tab.map(|tab| (tab.to_owned(), 0)),
                })
            };
            let key = key.to_lowercase().replace(['_', '-'], " ");
            let (slot, quantity) = match key.split_whitespace().collect::<Vec<_>>().join(" ").as_str() {
                "frame rate" | "framerate" | "fps" => {
                    found.frame_rate = Some(frame_rate(value).ok_or_else(|| {
                        error(format!("'{value}' is not a frame rate")).help("write it as '# frame rate: 30'")
                    })?);
                    continue;
                }
                "gravity" | "g" => (&mut found.gravity, Quantity::Acceleration),
                "sigma height" | "height error" => (&mut found.sigma_height, Quantity::Length),
                "sigma time" | "time error" => (&mut found.sigma_time, Quantity::Time),
                _ => continue,
            };
            let si = quantity.parse(value).map_err(|problem| error(problem.to_string()))?;
            if si <= 0.0 {
                return Err(error(format!("'{value}' is not above zero")).help("correct the comment or take it out"));
            }
            *slot = Some(si);
        }
        Ok(found)
    }
}

impl Sheet<'_> {
    /// Calls `visit` for every row below the header that is not blank.
    pub(super) fn each_row(&self, mut visit: impl FnMut(&Row<'_>) -> Result<(), TableError>) -> Result<(), TableError> {
        self.grid.each_record(self.block.rows.clone(), self.block.line, |row| {
            row.refuse_extra_cells(self.block.header.len())?;
            if row.cells().eq(self.block.header.iter()) {
                return Err(row.error(0, "the names of the columns stand here again").help(
                    "take this line out, and tell the tables apart by a column 'trial'; or put each into a file of its own: several are fitted together",
                ));
            }
            visit(row)?;
            Ok(true)
        })
    }

    /// An error of the sheet as a whole.
    pub(super) fn error(&self, message: impl Into<String>) -> TableError {
        TableError::new(self.grid.name, message)
    }

    /// An error at header cell `index`.
    pub(super) fn header_error(&self, index: usize, message: impl Into<String>) -> TableError {
        let (start, line) = self.block.header_at;
        self.grid.error(start, line, index, message)
    }

    /// An error at cell `index` of the line `line`.
    pub(super) fn line_error(&self, line: u64, index: usize, message: impl Into<String>) -> TableError {
        let before = usize::try_from(line.saturating_sub(1)).unwrap_or(usize::MAX);
        let start: usize = self.grid.text.split_inclusive('\n').take(before).map(str::len).sum();
        self.grid.error(start, line, index, message)
    }
}

fn frame_rate(text: &str) -> Option<f64> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let unit = text[end..].trim().to_lowercase();
    let known = ["", "fps", "hz", "1/s", "/s", "frames/s", "frames per second"].contains(&unit.as_str());
    text[..end].parse().ok().filter(|rate: &f64| known && rate.is_finite() && *rate > 0.0)
}

/// The delimiter of the first lines of a text.
fn delimiter<'a>(lines: impl Iterator<Item = &'a str>) -> u8 {
    let lines: Vec<&str> = lines.collect();
    let number = |cell: &str| cell.parse::<f64>().is_ok();
    match lines.iter().find_map(|line| mark(line).map(|mark| (mark, *line))) {
        // Below a name without a comma, a comma that makes a number is no delimiter.
        Some((b',', line)) if line != lines[0] && number(&line.trim().replacen(',', ".", 1)) => b';',
        Some((mark, _)) => mark,
        None if lines.iter().skip(1).any(|line| line.contains(' ') && line.split(' ').all(number)) => b' ',
        None => b',',
    }
}

/// What separates the cells of a line, if anything does: a tab before a semicolon before a comma.
fn mark(line: &str) -> Option<u8> {
    let mut quoted = false;
    let mut found = None;
    for byte in line.bytes() {
        match byte {
            b'"' => quoted = !quoted,
            b'\t' if !quoted => return Some(b'\t'),
            b';' if !quoted => found = Some(b';'),
            b',' if !quoted && found.is_none() => found = Some(b','),
            _ => {}
        }
    }
    found
}

/// Lines as a message names them: `lines 3 and 4`; of many the first, and how many there are.
pub(super) fn lines(list: &[u64]) -> String {
    match list {
        [] => "no line".to_owned(),
        [one] => format!("line {one}"),
        [most @ .., last] if most.len() < 5 => {
            let most: Vec<String> = most.iter().map(u64::to_string).collect();
            format!("lines {} and {last}", most.join(", "))
        }
        [first, ..] => format!("{} lines, the first of them {first}", list.len()),
    }
}

/// A cell as a message quotes it: cut short, on one line.
pub(super) fn shown(cell: &str) -> String {
    let mut short: String = cell.chars().take(40).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if cell.chars().nth(40).is_some() {
        short.push('…');
    }
    short
}

impl Row<'_> {
    /// The trimmed text of a cell; a cell beyond the end of the row is empty.
    pub(super) fn cell(&self, index: usize) -> &str {
        self.record.get(index).unwrap_or("")
    }

    /// An error at the cell `index`.
    pub(super) fn error(&self, index: usize, message: impl Into<String>) -> TableError {
        self.grid.error(self.start, self.line, index, message)
    }

    fn refuse_extra_cells(&self, width: usize) -> Result<(), TableError> {
        if self.record.len() <= width {
            return Ok(());
        }
        match (width..self.record.len()).find(|&n| !self.cell(n).is_empty()) {
            None => Ok(()),
            Some(extra) => {
                let help = if self.grid.decimal_comma() {
                    "give every column a name in the header"
                } else {
                    "give every column a name in the header; if the comma is a decimal comma, separate cells by semicolons"
                };
                let (cells, names) =
                    (self.record.len(), if width == 1 { "1 column" } else { &format!("{width} columns") });
                Err(self.error(extra, format!("this row has {cells} cells, but the header names {names}")).help(help))
            }
        }
    }

    /// The number in a cell, `None` if it is empty.
    pub(super) fn number(&self, index: usize) -> Result<Option<f64>, TableError> {
        // A remark behind a number.
        let cell = self.cell(index).split('#').next().unwrap_or_default().trim_end();
        if let Ok(value) = cell.parse::<f64>()
            && value.is_finite()
        {
            return Ok(Some(value));
        }
        if matches!(cell, "" | "-" | "--" | "–" | "NA" | "n/a" | "N/A") {
            return Ok(None);
        }
        let wrong = |message: String, help: &str| Err(self.error(index, message).help(help));
        let shown = shown(cell);
        let plain = "write a plain number; the unit belongs in the header";
        let remark = "write a plain number; the unit belongs in the header, and a remark behind a '#'";
        let value: Result<f64, _> = if cell.contains(',') {
            if !self.grid.decimal_comma() {
                return wrong(
                    format!("'{shown}' has a comma in a table separated by commas"),
                    "write a decimal point, or separate the cells by semicolons; write no separators of thousands",
                );
            }
            if cell.contains('.') || cell.matches(',').count() > 1 {
                return wrong(format!("'{shown}' is not a number"), "write no separators of thousands");
            }
            cell.replace(',', ".").replace('−', "-").parse()
        } else if cell.contains('−') {
            cell.replace('−', "-").parse()
        } else {
            cell.parse()
        };
        match value {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            Ok(_) => wrong(format!("'{shown}' is not a finite number"), "take the row out"),
            Err(_) => {
                let help = if cell.contains(char::is_whitespace) { remark } else { plain };
                wrong(format!("'{shown}' is not a number"), help)
            }
        }
    }

    /// The seconds in a cell that reads like a stopwatch, `0:01.25` or `1:02:03,4`; `None` if it does not.
    pub(super) fn clock(&self, index: usize) -> Option<f64> {
        let mut seconds = 0.0;
        let cell = self.cell(index);
        if !cell.contains(':') {
            return None;
        }
        for part in cell.split(':') {
            let digits = part.starts_with(|c: char| c.is_ascii_digit());
            seconds = 60.0 * seconds + part.replace(',', ".").parse::<f64>().ok().filter(|_| digits)?;
        }
        Some(seconds).filter(|s: &f64| s.is_finite())
    }

    /// Whether a cell holds a number, or something that stands for one.
    pub(super) fn is_number(&self, index: usize) -> bool {
        let cell = self.cell(index);
        let plain = if self.grid.decimal_comma() { cell.replace(',', ".") } else { cell.to_owned() };
        plain.parse::<f64>().is_ok()
    }

    /// The cells, trimmed.
    pub(super) fn cells(&self) -> impl Iterator<Item = &str> {
        self.record.iter()
    }
}
