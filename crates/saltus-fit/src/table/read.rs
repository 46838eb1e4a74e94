//! From bytes to rows: encoding, delimiter, comments, header, and the place of every cell for messages.

use csv::{ReaderBuilder, StringRecord};
use saltus_bounce::units::Quantity;

use super::header::Columns;
use super::layout;
use super::{Metadata, ReadOptions, Table};
use crate::error::{Place, TableError};

/// Reads `bytes` into a table that is not yet checked.
pub(super) fn table(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Table, TableError> {
    let text = text(name, bytes)?;
    // Old Macintosh files end their lines with a lone carriage return.
    let replaced = (text.contains('\r') && !text.contains('\n')).then(|| text.replace('\r', "\n"));
    let text = replaced.as_deref().unwrap_or(text);
    let sheet = Sheet::open(name, text)?;
    let metadata = sheet.metadata()?;
    let columns = Columns::of(&sheet, options)?;
    let mut table = layout::table(&sheet, &columns, options)?;
    table.name = name.to_owned();
    table.metadata = metadata;
    Ok(table)
}

/// The bytes as text, or the reason why they are none.
fn text<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, TableError> {
    let error = |message: &str| TableError::new(name, message);
    let as_csv = "save the table as CSV (UTF-8) and try again";
    if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(&[0xD0, 0xCF, 0x11, 0xE0]) {
        return Err(error("this is a spreadsheet workbook, not a text table").help(as_csv));
    }
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err(error("this text is encoded as UTF-16").help("save the table as CSV in UTF-8 and try again"));
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let control = |b: &u8| b.is_ascii_control() && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0C | 0x1A);
    if bytes.iter().any(control) {
        return Err(error("this is not a text file: it contains control characters").help(as_csv));
    }
    std::str::from_utf8(bytes).map_err(|problem| {
        let start = problem.valid_up_to();
        let before = &bytes[..start];
        let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |n| n + 1);
        let line_end = bytes[start..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |n| start + n);
        let place = Place {
            line: before.iter().filter(|&&b| b == b'\n').count() as u64 + 1,
            column: String::from_utf8_lossy(&bytes[line_start..start]).chars().count() + 1,
            width: 1,
            text: String::from_utf8_lossy(&bytes[line_start..line_end]).into_owned(),
        };
        error("a byte here is not UTF-8 text").at(place).help(as_csv)
    })
}

/// The text of a table with its delimiter and header found.
pub(super) struct Sheet<'a> {
    pub(super) name: &'a str,
    text: &'a str,
    delimiter: u8,
    /// The cells of the header line, trimmed.
    pub(super) header: Vec<String>,
    header_start: (usize, u64),
}

/// One record with the place it starts at.
pub(super) struct Row<'a> {
    sheet: &'a Sheet<'a>,
    record: &'a StringRecord,
    start: usize,
    /// The line of the file, counted from 1.
    pub(super) line: u64,
}

impl<'a> Sheet<'a> {
    fn open(name: &'a str, text: &'a str) -> Result<Self, TableError> {
        let first = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#'));
        let Some(first) = first else {
            let what = if text.trim().is_empty() { "the file is empty" } else { "the file holds comments only" };
            return Err(
                TableError::new(name, what).help("the first line names the columns, such as 'bounce,height_cm'")
            );
        };
        let delimiter = delimiter(first);
        let mut sheet = Sheet { name, text, delimiter, header: Vec::new(), header_start: (0, 1) };
        let mut header = None;
        sheet.each_record(|row| {
            header = Some((row.record.iter().map(str::to_owned).collect(), (row.start, row.line)));
            Ok(false)
        })?;
        if let Some((cells, start)) = header {
            sheet.header = cells;
            sheet.header_start = start;
        }
        Ok(sheet)
    }

    /// Whether a comma may stand for the decimal point.
    pub(super) fn decimal_comma(&self) -> bool {
        self.delimiter != b','
    }

    /// Calls `visit` for every row below the header that is not blank.
    pub(super) fn each_row(
        &self,
        mut visit: impl FnMut(&Row<'_>) -> Result<(), TableError>,
        with_header: bool,
    ) -> Result<(), TableError> {
        let mut header_is_due = !with_header;
        self.each_record(|row| {
            if header_is_due {
                header_is_due = false;
            } else {
                row.refuse_extra_cells()?;
                visit(row)?;
            }
            Ok(true)
        })
    }

    /// Calls `visit` for every record that holds anything, until it answers `false`.
    fn each_record(&self, mut visit: impl FnMut(&Row<'_>) -> Result<bool, TableError>) -> Result<(), TableError> {
        let mut reader = ReaderBuilder::new()
            .delimiter(self.delimiter)
            .comment(Some(b'#'))
            .flexible(true)
            .has_headers(false)
            .trim(csv::Trim::All)
            .from_reader(self.text.as_bytes());
        let mut record = StringRecord::new();
        loop {
            let more = reader
                .read_record(&mut record)
                .map_err(|error| TableError::new(self.name, format!("this is not a table: {error}")))?;
            if !more {
                return Ok(());
            }
            let (start, line) = record.position().map_or((0, 1), |p| self.record_start(p.byte(), p.line()));
            let row = Row { sheet: self, record: &record, start, line };
            if record.iter().any(|cell| !cell.is_empty()) && !visit(&row)? {
                return Ok(());
            }
        }
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
        }
    }

    /// An error at header cell `index`.
    pub(super) fn header_error(&self, index: usize, message: impl Into<String>) -> TableError {
        let (start, line) = self.header_start;
        TableError::new(self.name, message).at(self.place(start, line, index))
    }

    /// An error at cell `index` of the line `line`.
    pub(super) fn line_error(&self, line: u64, index: usize, message: impl Into<String>) -> TableError {
        let before = usize::try_from(line.saturating_sub(1)).unwrap_or(usize::MAX);
        let start: usize = self.text.split_inclusive('\n').take(before).map(str::len).sum();
        TableError::new(self.name, message).at(self.place(start, line, index))
    }

    /// The metadata comments: `# frame rate: 30`, `# gravity: 9.8 m/s^2`, `# sigma height: 1 cm`, `# sigma time: 5 ms`.
    fn metadata(&self) -> Result<Metadata, TableError> {
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

fn frame_rate(text: &str) -> Option<f64> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let unit = text[end..].trim().to_lowercase();
    let known = ["", "fps", "hz", "1/s", "/s", "frames/s", "frames per second"].contains(&unit.as_str());
    text[..end].parse().ok().filter(|rate: &f64| known && rate.is_finite() && *rate > 0.0)
}

/// The delimiter of the header line: a tab if there is one, else a semicolon, else a comma.
fn delimiter(line: &str) -> u8 {
    let mut quoted = false;
    let mut found = b',';
    for byte in line.bytes() {
        match byte {
            b'"' => quoted = !quoted,
            b'\t' if !quoted => return b'\t',
            b';' if !quoted => found = b';',
            _ => {}
        }
    }
    found
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
        TableError::new(self.sheet.name, message).at(self.sheet.place(self.start, self.line, index))
    }

    fn refuse_extra_cells(&self) -> Result<(), TableError> {
        let width = self.sheet.header.len();
        if self.record.len() <= width {
            return Ok(());
        }
        match (width..self.record.len()).find(|&n| !self.cell(n).is_empty()) {
            None => Ok(()),
            Some(extra) => {
                let help = if self.sheet.decimal_comma() {
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
        let cell = self.cell(index);
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
        let value: Result<f64, _> = if cell.contains(',') {
            if !self.sheet.decimal_comma() {
                return wrong(
                    format!("'{shown}' has a comma in a table separated by commas"),
                    "write a decimal point, or separate the cells by semicolons",
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
            Ok(_) => wrong(format!("'{shown}' is not a finite number"), "take the row out, or leave the cell empty"),
            Err(_) => wrong(format!("'{shown}' is not a number"), plain),
        }
    }
}
