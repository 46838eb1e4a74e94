//! From text to cells: delimiter, comments, and the place of every cell for messages.

mod grouped;
mod repeated;
mod sections;
mod unfold;
mod unquoted;

use csv::{ReaderBuilder, StringRecord};
use saltus_bounce::units::Quantity;

use super::Metadata;
use super::cell::{self, Cell};
use super::clause;
use super::limits::CELLS;
use crate::error::{Place, TableError};

/// A text of cells.
pub(super) struct Grid<'a> {
    pub(super) name: &'a str,
    /// The sheet of a workbook it was; its cells are then named as a spreadsheet names them.
    pub(super) tab: Option<&'a str>,
    text: &'a str,
    pub(super) delimiter: u8,
    /// The text of all cells, trimmed, one behind the other, and where each ends.
    cells: String,
    ends: Vec<u32>,
    rows: Vec<RowAt>,
    /// The column of the text that each column stands in, where cells of several readings were
    /// parted.
    origin: Vec<usize>,
    /// Commas within cells are decimal ones, though commas part the cells.
    decimal: bool,
    /// A number whose mark parts thousands, as it was written.
    pub(super) grouped: Option<String>,
}

/// A row: its first cell, where it starts in the text, its line.
struct RowAt {
    first: u32,
    start: u32,
    line: u32,
}

impl<'a> Grid<'a> {
    pub(super) fn open(name: &'a str, tab: Option<&'a str>, text: &'a str) -> Result<Self, TableError> {
        let mut lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#')).peekable();
        if lines.peek().is_none() {
            let what = if text.trim().is_empty() { "the file is empty" } else { "the file holds comments only" };
            return Err(TableError::new(name, what)
                .nothing()
                .help("the first line names the columns, such as 'bounce,height_cm'"));
        }
        let delimiter = if tab.is_some() { b'\t' } else { delimiter(lines.take(40)) };
        let (cells, ends, rows, origin) = (String::new(), Vec::new(), Vec::new(), Vec::new());
        let mut grid = Self { name, tab, text, delimiter, cells, ends, rows, origin, decimal: false, grouped: None };
        grid.fill()?;
        grid.unquoted();
        grid.repeat();
        grid.ungroup();
        grid.decimal = grid.comma() && grid.decimal_commas();
        grid.united();
        grid.unfold();
        grid.section();
        Ok(grid)
    }

    /// What the file and the sheet are called, without the folder and the end: as words.
    pub(super) fn called(&self) -> String {
        let file = self.name.rsplit(['/', '\\']).next().unwrap_or(self.name);
        let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
        format!("{stem} {}", self.tab.unwrap_or_default()).replace(['_', '-'], " ").trim().to_owned()
    }

    fn fill(&mut self) -> Result<(), TableError> {
        let mut reader = ReaderBuilder::new()
            .delimiter(self.delimiter)
            .comment(Some(b'#'))
            .flexible(true)
            .has_headers(false)
            .quoting(self.delimiter != b'|')
            .trim(csv::Trim::All)
            .from_reader(self.text.as_bytes());
        let mut record = StringRecord::new();
        let not_table = |error: csv::Error| TableError::new(self.name, format!("this is not a table: {error}"));
        while reader.read_record(&mut record).map_err(not_table)? {
            if record.iter().all(str::is_empty) || self.delimiter == b'|' && ruled(&record) {
                continue;
            }
            let (byte, line) = record.position().map_or((0, 1), |p| (p.byte(), p.line()));
            let (start, line) = record_start(self.text, byte, line);
            let small = |n: u64| u32::try_from(n).unwrap_or(u32::MAX);
            self.rows.push(RowAt {
                first: small(self.ends.len() as u64),
                start: small(start as u64),
                line: small(line),
            });
            for cell in &record {
                let cell = if self.delimiter == b'|' { cell.trim_matches(['*', '`', '_', ' ']) } else { cell };
                self.cells.push_str(cell);
                self.ends.push(small(self.cells.len() as u64));
            }
            if self.ends.len() > CELLS {
                return Err(TableError::new(
                    self.name,
                    format!("the table has more than {CELLS} cells; it is read no further than line {line}"),
                )
                .help("thin it out, such as to every tenth row, or cut it to the drops that count"));
            }
        }
        Ok(())
    }

    /// Lays the cells of every row anew, however many: `lay` hands them on one by one.
    fn relay(&mut self, mut lay: impl FnMut(&Self, usize, &mut dyn FnMut(&str))) {
        let (mut cells, mut ends) = (String::with_capacity(self.cells.len()), Vec::with_capacity(self.ends.len()));
        let small = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let mut firsts = Vec::with_capacity(self.rows());
        for row in 0..self.rows() {
            firsts.push(small(ends.len()));
            lay(self, row, &mut |cell| {
                cells.push_str(cell);
                ends.push(small(cells.len()));
            });
        }
        for (row, first) in self.rows.iter_mut().zip(firsts) {
            row.first = first;
        }
        (self.cells, self.ends) = (cells, ends);
    }

    /// Writes every cell anew, by its row and its column.
    fn rewrite(&mut self, mut write: impl FnMut(&Self, usize, usize, &mut String)) {
        let mut cell = String::new();
        self.relay(|grid, row, push| {
            for column in 0..grid.width(row) {
                cell.clear();
                write(grid, row, column, &mut cell);
                push(&cell);
            }
        });
    }

    /// Whether a comma separates the cells, so that it is no decimal mark.
    pub(super) fn comma(&self) -> bool {
        self.delimiter == b','
    }

    /// Whether numbers in cells have decimal commas: some have one, which cannot part thousands,
    /// and none has a point.
    fn decimal_commas(&self) -> bool {
        let mut ends = self.ends.iter().map(|end| *end as usize);
        let mut start = 0;
        let mut cells = std::iter::from_fn(|| {
            let end = ends.next()?;
            Some(self.cells.get(std::mem::replace(&mut start, end)..end).unwrap_or_default())
        });
        let plain = |cell: &str| {
            cell.starts_with(|c: char| c.is_ascii_digit())
                && cell.chars().all(|c| c.is_ascii_digit() || ",.".contains(c))
        };
        let (mut decimal, mut other) = (false, false);
        cells.by_ref().filter(|cell| plain(cell)).for_each(|cell| match cell.split_once(',') {
            Some((whole, part)) => {
                decimal |= part.len() != 3 || whole == "0";
                other |= part.contains([',', '.']);
            }
            None => other |= cell.contains('.'),
        });
        decimal && !other
    }

    /// Whether a comma within a number may part its thousands.
    pub(super) fn thousands(&self) -> bool {
        self.comma() && !self.decimal
    }

    pub(super) fn rows(&self) -> usize {
        self.rows.len()
    }

    /// How many cells a row has.
    pub(super) fn width(&self, row: usize) -> usize {
        self.span(row).len()
    }

    fn span(&self, row: usize) -> std::ops::Range<usize> {
        let first = |n: usize| self.rows.get(n).map_or(self.ends.len(), |r| r.first as usize);
        first(row)..first(row + 1)
    }

    /// The trimmed text of a cell; a cell beyond the end of the row is empty.
    pub(super) fn cell(&self, row: usize, column: usize) -> &str {
        let span = self.span(row);
        let at = span.start + column;
        if column >= span.len() {
            return "";
        }
        let from = at.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        self.cells.get(from..self.ends[at] as usize).unwrap_or("")
    }

    /// The line of the file that a row starts in, counted from 1.
    pub(super) fn line(&self, row: usize) -> u64 {
        self.rows.get(row).map_or(1, |r| u64::from(r.line))
    }

    /// The row that starts in a line.
    pub(super) fn row_of(&self, line: u64) -> usize {
        self.rows.partition_point(|r| u64::from(r.line) < line)
    }

    /// An error at a cell.
    pub(super) fn error(&self, row: usize, column: usize, message: impl Into<String>) -> TableError {
        let (start, line) = self.rows.get(row).map_or((self.text.len(), 1), |r| (r.start as usize, u64::from(r.line)));
        let column = self.origin.get(column).copied().unwrap_or(column);
        TableError::new(self.name, message).at(self.place(start, line, column))
    }

    /// Where cell `index` of the record that starts at `start` in line `line` stands.
    fn place(&self, start: usize, line: u64, index: usize) -> Place {
        let (mut cell, mut quoted, mut line) = (0, false, line);
        let (mut line_start, mut from, mut to) = (start, start, self.text.len());
        for (at, byte) in self.text.bytes().enumerate().skip(start) {
            match byte {
                b'"' if self.delimiter != b'|' => quoted = !quoted,
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

    /// The lines that are comments, with their numbers.
    pub(super) fn comments(&self) -> impl Iterator<Item = (u64, &str)> {
        (1..).zip(self.text.lines()).filter_map(|(n, line)| Some((n, line.strip_prefix('#')?)))
    }

    /// The metadata comments: `# frame rate: 30`, `# gravity: 9.8 m/s^2`, `# sigma height: 1 cm`,
    /// `# sigma time: 5 ms`.
    pub(super) fn metadata(&self) -> Result<Metadata, TableError> {
        let mut found = Metadata::default();
        if !self.text.contains('#') {
            return Ok(found);
        }
        for (n, line) in self.text.lines().enumerate() {
            let Some(comment) = line.strip_prefix('#') else { continue };
            let Some((key, value)) = comment.split_once(':') else {
                found.frame_rate = found.frame_rate.or(clause::frame_rate(comment));
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
                "drop height" | "drop" | "release height" | "dropped from" => (&mut found.drop, Quantity::Length),
                "sigma height" | "height error" => (&mut found.sigma_height, Quantity::Length),
                "sigma time" | "time error" => (&mut found.sigma_time, Quantity::Time),
                _ => {
                    found.frame_rate = found.frame_rate.or(clause::frame_rate(comment));
                    continue;
                }
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

/// The reader's position precedes the blank lines and comments it skips: go past them.
fn record_start(text: &str, byte: u64, mut line: u64) -> (usize, u64) {
    let bytes = text.as_bytes();
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

/// A grid as it stands, or with rows and columns changed over.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) grid: &'a Grid<'a>,
    pub(super) across: bool,
}

impl View<'_> {
    pub(super) fn rows(&self) -> usize {
        if self.across { self.widest() } else { self.grid.rows() }
    }

    fn widest(&self) -> usize {
        (0..self.grid.rows()).map(|row| self.grid.width(row)).max().unwrap_or(0)
    }

    pub(super) fn width(&self, row: usize) -> usize {
        if self.across { self.grid.rows() } else { self.grid.width(row) }
    }

    pub(super) fn cell(&self, row: usize, column: usize) -> &str {
        if self.across { self.grid.cell(column, row) } else { self.grid.cell(row, column) }
    }

    pub(super) fn cells(&self, row: usize) -> impl Iterator<Item = &str> {
        (0..self.width(row)).map(move |column| self.cell(row, column))
    }

    pub(super) fn line(&self, row: usize, column: usize) -> u64 {
        self.grid.line(if self.across { column } else { row })
    }

    pub(super) fn error(&self, row: usize, column: usize, message: impl Into<String>) -> TableError {
        let (row, column) = if self.across { (column, row) } else { (row, column) };
        self.grid.error(row, column, message)
    }

    /// What a cell holds.
    pub(super) fn read(&self, row: usize, column: usize) -> Cell {
        cell::read(self.cell(row, column), self.grid.thousands())
    }

    /// The number that a cell holds, in its own unit.
    pub(super) fn number(&self, row: usize, column: usize) -> Option<f64> {
        match self.read(row, column) {
            Cell::Number(measured) => Some(measured.value),
            _ => None,
        }
    }

    /// Whether a cell holds a number, a stopwatch's time, or what is meant as one.
    pub(super) fn is_number(&self, row: usize, column: usize) -> bool {
        matches!(self.read(row, column), Cell::Number(_) | Cell::Wrong(_))
            || cell::clock(self.cell(row, column)).is_some()
    }
}

fn frame_rate(text: &str) -> Option<f64> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let unit = text[end..].trim().to_lowercase();
    let known = ["", "fps", "hz", "1/s", "/s", "frames/s", "frames per second"].contains(&unit.as_str());
    text[..end].parse().ok().filter(|rate: &f64| known && rate.is_finite() && *rate > 0.0)
}

/// Whether a row of a table drawn in characters is a line: `|---|:--:|`.
fn ruled(record: &StringRecord) -> bool {
    record.iter().all(|cell| cell.chars().all(|c| matches!(c, '-' | ':' | '=' | '+' | ' ')))
}

/// The delimiter of the first lines of a text.
fn delimiter<'a>(lines: impl Iterator<Item = &'a str>) -> u8 {
    let lines: Vec<&str> = lines.collect();
    let number = |cell: &str| cell.parse::<f64>().is_ok() || cell::clock(cell).is_some();
    let piped = lines.iter().filter(|line| line.contains('|')).count();
    // A table drawn in characters has lines that are rules, or bars in every line.
    // Above and below one there may be remarks.
    let bars = |line: &&str| line.matches('|').count();
    let counts: Vec<usize> = lines.iter().map(bars).skip_while(|n| *n == 0).collect();
    let level = counts.iter().take(piped).all(|n| *n == counts[0]);
    let drawn = piped == lines.len() || level && (piped > 2 || 2 * piped > lines.len());
    if piped > 0 && lines.iter().any(|line| rule(line)) || piped > 1 && drawn {
        return b'|';
    }
    match [b'\t', b';', b','].into_iter().find(|&mark| separates(&lines, mark)) {
        // Below a name without a comma, a comma that makes a number is no delimiter.
        Some(b',') if decimal_commas(&lines) => b';',
        Some(b',') if blanks_part(&lines) => b' ',
        Some(mark) => mark,
        None if lines.iter().skip(1).any(|line| line.trim().contains(' ') && line.trim().split(' ').all(number)) => {
            b' '
        }
        None => b',',
    }
}

/// Whether a line is drawn and holds nothing: `|---|:--:|`, `----+----`.
fn rule(line: &str) -> bool {
    let bare = line.trim();
    bare.contains(['|', '+'])
        && bare.contains(['-', '='])
        && bare.chars().all(|c| matches!(c, '|' | '-' | '=' | ':' | '+' | ' '))
}

/// Whether a mark separates cells: alike in several lines, and in half as many as any mark that
/// ranks below it. Commas of prose and of decimals rank last, so that they outvote no semicolon,
/// and a semicolon in a title outvotes no column of commas.
fn separates(lines: &[&str], mark: u8) -> bool {
    let alike = |mark: u8| {
        let counts: Vec<usize> = lines.iter().map(|line| count(line, mark)).filter(|n| *n > 0).collect();
        counts.iter().map(|n| counts.iter().filter(|other| *other == n).count()).max().unwrap_or(0)
    };
    let below: &[u8] = match mark {
        b'\t' => b";,",
        b';' => b",",
        _ => b"",
    };
    let (own, others) = (alike(mark), below.iter().map(|&mark| alike(mark)).max().unwrap_or(0));
    own > 0 && 2 * own >= others
}

/// Whether the first line with a comma stands below a name and is a number with a decimal comma.
fn decimal_commas(lines: &[&str]) -> bool {
    let first = lines.iter().position(|line| count(line, b',') > 0);
    first.is_some_and(|at| at > 0 && lines[at].trim().replacen(',', ".", 1).parse::<f64>().is_ok())
}

/// Whether blanks part numbers with decimal commas in most lines: `0,1 42,11`.
fn blanks_part(lines: &[&str]) -> bool {
    let number = |cell: &str| cell.replacen(',', ".", 1).parse::<f64>().is_ok() || cell::clock(cell).is_some();
    let whole = |line: &&&str| line.trim().contains(' ') && line.contains(',') && line.split_whitespace().all(number);
    2 * lines.iter().filter(whole).count() > lines.len()
}

/// How often a mark stands in a line outside of quotes.
fn count(line: &str, mark: u8) -> usize {
    let mut quoted = false;
    let mut outside = |byte: &u8| {
        quoted ^= *byte == b'"';
        !quoted && *byte == mark
    };
    line.as_bytes().iter().filter(|byte| outside(byte)).count()
}

/// A cell as a message quotes it: cut short, on one line.
pub(super) fn shown(cell: &str) -> String {
    let mut short: String = cell.chars().take(40).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if cell.chars().nth(40).is_some() {
        short.push('…');
    }
    short
}
