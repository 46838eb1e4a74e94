//! Workbooks of the `OpenDocument` format, `.ods`: their cells one by one, what is empty skipped
//! whatever it claims to repeat.

use std::collections::HashSet;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::aside::Why;
use super::foreign::entity;
use super::limits;
use super::sheet::{Content, Part, Rows, too_much};

/// The value of an attribute, and its name without what it is prefixed with.
fn attribute(tag: &BytesStart<'_>, name: &str) -> Option<String> {
    let mut attributes = tag.html_attributes();
    let own = attributes.with_checks(false).flatten();
    let mut own = own.filter(|a| a.key.as_ref().rsplit(':').next() == Some(name));
    own.next().map(|a| a.value.to_string())
}

fn repeated(tag: &BytesStart<'_>, name: &str) -> u32 {
    attribute(tag, name).and_then(|count| count.parse().ok()).unwrap_or(1).max(1)
}

/// A cell that is open: what it holds as a number, its text, and how often it stands there.
struct Cell {
    value: Option<String>,
    text: String,
    times: u32,
}

impl Cell {
    fn new(tag: &BytesStart<'_>) -> Self {
        let kind = attribute(tag, "value-type").unwrap_or_default();
        // Hundredths, dates and times are as they are shown.
        let plain = matches!(&*kind, "float" | "currency");
        let value = attribute(tag, "value").filter(|_| plain);
        Self { value, text: String::new(), times: repeated(tag, "number-columns-repeated") }
    }
}

/// The sheets of the content of a workbook.
#[derive(Default)]
struct Book {
    parts: Vec<Part>,
    /// The styles of sheets that are not shown, and the style that is open.
    hidden: HashSet<String>,
    style: String,
    sheet: Option<(String, bool, Rows)>,
    /// The row, the column, and the cells of the row that hold something.
    at: (u32, u32),
    cells: Vec<(u32, String)>,
    rows: u32,
    cell: Option<Cell>,
    /// How deep within remarks, which are no part of their cells, and the texts of those.
    remark: usize,
    remarks: Vec<String>,
    /// What the cells of the row may hold, and what those of the sheets may.
    held: usize,
    left: usize,
}

impl Book {
    fn begin(&mut self, tag: &BytesStart<'_>) {
        match tag.local_name().as_ref() {
            "style" => self.style = attribute(tag, "name").unwrap_or_default(),
            "table-properties" if attribute(tag, "display").is_some_and(|shown| shown == "false") => {
                self.hidden.insert(std::mem::take(&mut self.style));
            }
            "table" => {
                let hidden = attribute(tag, "style-name").is_some_and(|style| self.hidden.contains(&style));
                let name = attribute(tag, "name").unwrap_or_default();
                (self.sheet, self.at) = (Some((name, hidden, Rows::new(self.left))), (0, 0));
            }
            "table-row" => {
                (self.rows, self.at.1) = (repeated(tag, "number-rows-repeated"), 0);
                self.held = limits::bytes();
            }
            "table-cell" | "covered-table-cell" => self.cell = Some(Cell::new(tag)),
            "annotation" => {
                self.remark += 1;
                self.remarks.push(String::new());
            }
            "p" | "s" | "tab" | "line-break" => self.text(" "),
            _ => {}
        }
    }

    fn text(&mut self, words: &str) {
        match (self.remark, &mut self.cell, self.remarks.last_mut()) {
            (0, Some(cell), _) => cell.text.push_str(words),
            (1.., _, Some(remark)) => remark.push_str(words),
            _ => {}
        }
    }

    fn end(&mut self, tag: &str) -> Result<(), String> {
        match tag {
            "annotation" => self.remark = self.remark.saturating_sub(1),
            "table-cell" | "covered-table-cell" => {
                let Some(cell) = self.cell.take() else { return Ok(()) };
                let shown = cell.value.unwrap_or_else(|| cell.text.trim().trim_start_matches('#').to_owned());
                let end = self.at.1.saturating_add(cell.times);
                if !shown.is_empty() {
                    self.take(end - self.at.1, shown.len())?;
                    self.cells.extend((self.at.1..end).map(|column| (column, shown.clone())));
                }
                self.at.1 = end;
            }
            "table-row" => {
                let rows = self.at.0..self.at.0.saturating_add(self.rows);
                self.at.0 = rows.end;
                let cells = std::mem::take(&mut self.cells);
                let Some((_, _, sheet)) = self.sheet.as_mut().filter(|_| !cells.is_empty()) else { return Ok(()) };
                for row in rows {
                    for (column, cell) in &cells {
                        sheet.put((row, *column), cell)?;
                    }
                }
            }
            "table" => {
                if let Some((name, hidden, mut rows)) = self.sheet.take() {
                    for remark in std::mem::take(&mut self.remarks) {
                        rows.remark(remark.trim())?;
                    }
                    self.left = rows.left;
                    self.parts.push(Part::new(name, hidden.then_some(Why::Hidden), Content::Cells(rows.text)));
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Takes what a cell holds, so often, off what a row may hold.
    fn take(&mut self, times: u32, bytes: usize) -> Result<(), String> {
        let held = (times as usize).saturating_mul(bytes + size_of::<(u32, String)>());
        self.held = self.held.checked_sub(held).ok_or_else(too_much)?;
        Ok(())
    }
}

/// The sheets that a text of `OpenDocument` holds.
pub(super) fn sheets(content: &str) -> Result<Vec<Part>, String> {
    let mut reader = Reader::from_str(content);
    let mut book = Book { left: limits::bytes(), ..Book::default() };
    loop {
        match reader.read_event().map_err(|error| error.to_string())? {
            Event::Start(tag) => book.begin(&tag),
            Event::Empty(tag) => {
                book.begin(&tag);
                book.end(tag.local_name().as_ref())?;
            }
            Event::End(tag) => book.end(tag.local_name().as_ref())?,
            Event::Text(words) => book.text(words.as_ref()),
            Event::GeneralRef(name) => book.text(&entity(name.as_ref())),
            Event::Eof => break,
            _ => {}
        }
    }
    Ok(book.parts)
}
