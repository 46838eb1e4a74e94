//! Files of several tables: workbooks (`.xlsx`, `.xls`, `.ods`) and zip archives of CSV, each as
//! text, one line a row.
//!
//! A few kilobytes of a hostile archive can stand for gigabytes. Every entry of an archive is
//! therefore measured before it is trusted, cells are read one by one, and what they add up to is
//! bounded.

use std::io::{Cursor, Read, copy, sink};
use std::panic::{UnwindSafe, catch_unwind};

use calamine::{Data, DataRef, Reader, Sheet, SheetVisible, Xls, Xlsx, XlsxError};
use zip::ZipArchive;

use super::aside::Why;
use super::limits::{self, MANY};
use super::sheet::{Content, Part, Rows};
use super::{old_workbook, open_workbook, remarks};
use crate::error::TableError;

/// How much of another reader's message is shown, in characters.
const SHOWN: usize = 200;

/// The tables of a workbook or an archive; `None` if `bytes` are neither.
pub(super) fn parts(name: &str, bytes: &[u8]) -> Option<Result<Vec<Part>, TableError>> {
    if bytes.starts_with(&[0xD0, 0xCF, 0x11, 0xE0]) {
        Some(caught(|| xls(bytes)).map_err(|problem| broken(name, "workbook", &problem)))
    } else if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06") {
        Some(archive(name, bytes))
    } else {
        None
    }
}

/// The readers of workbooks trust what they read and may panic over a damaged file.
fn caught(read: impl FnOnce() -> Result<Vec<Part>, String> + UnwindSafe) -> Result<Vec<Part>, String> {
    catch_unwind(read).unwrap_or_else(|_| Err("it is damaged".to_owned()))
}

fn broken(name: &str, what: &str, problem: &str) -> TableError {
    // Readers quote what they stumble over, whatever its length.
    let problem: String = problem.chars().take(SHOWN).map(|c| if c.is_control() { ' ' } else { c }).collect();
    TableError::new(name, format!("this {what} cannot be read: {problem}"))
        .help("save the table as CSV (UTF-8) and try again")
}

fn archive(name: &str, bytes: &[u8]) -> Result<Vec<Part>, TableError> {
    let mut zip = ZipArchive::new(Cursor::new(bytes)).map_err(|e| broken(name, "archive", &e.to_string()))?;
    let names: Vec<String> = zip.file_names().take(MANY).filter_map(|n| Some(n.ok()?.into_owned())).collect();
    let has = |entry: &str| names.iter().any(|n| n == entry);
    if has("xl/workbook.xml") {
        measure(&mut zip).map_err(|problem| broken(name, "workbook", &problem))?;
        let remarks = remarks::of_sheets(&names, |entry| unpacked(&mut zip, entry).ok());
        return caught(|| xlsx(bytes, &remarks)).map_err(|problem| broken(name, "workbook", &problem));
    }
    if has("content.xml") {
        let sheets = unpacked(&mut zip, "content.xml").and_then(|content| open_workbook::sheets(&content));
        let sheets = sheets.map_err(|problem| broken(name, "workbook", &problem))?;
        if !sheets.is_empty() {
            return Ok(sheets);
        }
    }
    if has("content.xml") || has("xl/workbook.bin") {
        return Err(TableError::new(name, "workbooks of this kind are not read").help("save it as .xlsx or as CSV"));
    }
    let mut parts = Vec::new();
    let mut left = limits::bytes() as u64;
    for entry in names.iter().filter(|n| is_table(n)) {
        let mut content = Vec::new();
        let file = zip.by_name(entry).map_err(|e| broken(name, "archive", &e.to_string()))?;
        let read = file.take(left + 1).read_to_end(&mut content);
        let size = read.map_err(|e| broken(name, "archive", &e.to_string()))? as u64;
        left = left.checked_sub(size).ok_or_else(|| broken(name, "archive", &too_large()))?;
        parts.push(Part::new(entry.clone(), None, Content::Bytes(content)));
    }
    if parts.is_empty() {
        return Err(TableError::new(name, "the archive holds no table: no file in it ends in .csv, .tsv or .txt")
            .help("unpack it and give the table itself"));
    }
    Ok(parts)
}

/// The text of an entry of an archive.
fn unpacked(zip: &mut ZipArchive<Cursor<&[u8]>>, entry: &str) -> Result<String, String> {
    let mut content = Vec::new();
    let file = zip.by_name(entry).map_err(|e| e.to_string())?;
    let size = file.take(limits::bytes() as u64 + 1).read_to_end(&mut content).map_err(|e| e.to_string())?;
    if size > limits::bytes() {
        return Err(too_large());
    }
    String::from_utf8(content).map_err(|e| e.to_string())
}

/// Neither what macOS adds to every archive, nor phyphox' files on the telephone itself.
fn is_table(entry: &str) -> bool {
    let lower = entry.to_lowercase();
    let file = lower.rsplit('/').next().unwrap_or_default();
    [".csv", ".tsv", ".txt"].iter().any(|end| file.ends_with(end))
        && !file.starts_with('.')
        && !lower.starts_with("__macosx/")
        && !lower.split('/').any(|folder| folder == "meta")
}

fn too_large() -> String {
    format!("it unpacks to more than {} MB", limits::bytes() >> 20)
}

/// Unpacks everything into nothing, so that no claim about sizes has to be believed.
fn measure(zip: &mut ZipArchive<Cursor<&[u8]>>) -> Result<(), String> {
    let mut left = limits::bytes() as u64;
    for index in 0..zip.len() {
        let entry = zip.by_index(index).map_err(|e| e.to_string())?;
        let size = copy(&mut entry.take(left + 1), &mut sink()).map_err(|e| e.to_string())?;
        left = left.checked_sub(size).ok_or_else(too_large)?;
    }
    Ok(())
}

/// The sheets, each with the remarks on its cells, by the number of the sheet.
fn xlsx(bytes: &[u8], remarks: &[(usize, String)]) -> Result<Vec<Part>, String> {
    let mut workbook = Xlsx::new(Cursor::new(bytes)).map_err(|e| e.to_string())?;
    let mut parts = Vec::new();
    let mut left = limits::bytes();
    for (number, (name, hidden)) in (1..).zip(shown_or_not(workbook.sheets_metadata())) {
        let mut cells = match workbook.worksheet_cells_reader(&name) {
            Ok(cells) => cells,
            // A sheet that is a chart has no cells.
            Err(XlsxError::NotAWorksheet(_)) => continue,
            Err(e) => return Err(e.to_string()),
        };
        let mut rows = Rows::new(left);
        while let Some(cell) = cells.next_cell().map_err(|e| e.to_string())? {
            match cell.get_value() {
                DataRef::Empty => {}
                DataRef::SharedString(text) => rows.put(cell.get_position(), text)?,
                value => rows.put(cell.get_position(), &shown(&Data::from(value.clone())))?,
            }
        }
        remarks.iter().filter(|(sheet, _)| *sheet == number).try_for_each(|(_, text)| rows.remark(text))?;
        left = rows.left;
        parts.push(Part::new(name, hidden.then_some(Why::Hidden), Content::Cells(rows.text)));
    }
    Ok(parts)
}

fn xls(bytes: &[u8]) -> Result<Vec<Part>, String> {
    old_workbook::check(bytes)?;
    let mut workbook = Xls::new(Cursor::new(bytes)).map_err(|e| e.to_string())?;
    let mut parts = Vec::new();
    let mut left = limits::bytes();
    for (name, hidden) in shown_or_not(workbook.sheets_metadata()) {
        let Ok(range) = workbook.worksheet_range(&name) else { continue };
        let (top, first) = range.start().unwrap_or((0, 0));
        let mut rows = Rows::new(left);
        for (row, column, value) in range.used_cells() {
            let position = (u32::try_from(row).unwrap_or(u32::MAX), u32::try_from(column).unwrap_or(u32::MAX));
            rows.put((top.saturating_add(position.0), first.saturating_add(position.1)), &shown(value))?;
        }
        left = rows.left;
        parts.push(Part::new(name, hidden.then_some(Why::Hidden), Content::Cells(rows.text)));
    }
    Ok(parts)
}

/// The names of the sheets, and whether the workbook hides them.
fn shown_or_not(sheets: &[Sheet]) -> Vec<(String, bool)> {
    sheets.iter().map(|sheet| (sheet.name.clone(), sheet.visible != SheetVisible::Visible)).collect()
}

/// A value as CSV would have it.
fn shown(value: &Data) -> String {
    match value {
        Data::Float(number) => number.to_string(),
        Data::Int(number) => number.to_string(),
        Data::String(text) => text.clone(),
        // A moment is a number of days to a spreadsheet, and a stopwatch's reading is one to its
        // user.
        Data::DateTime(moment) => (moment.as_f64() * 86_400.0).to_string(),
        Data::Empty => String::new(),
        // '#N/A' at the start of a line would be a comment.
        other => other.to_string().trim_start_matches('#').to_owned(),
    }
}
