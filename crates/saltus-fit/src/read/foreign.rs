//! Files that hold no table as they are: pages of the web, whose tables are taken out, and other
//! programs' own files.

use quick_xml::Reader;
use quick_xml::events::Event;

use super::cell::{self, Cell};
use super::forms;
use super::limits::MANY;
use super::sheet::{Content, Part};
use super::wrapped::lettered;
use crate::error::TableError;

/// Endings of files that other programs write for themselves, what they are, and which export to
/// make there.
const KINDS: [(&[&str], &str, &str); 14] = [
    (
        &["trk", "trz"],
        "a project of Tracker",
        "in Tracker: File, Export, Data File (all cells, tab delimited); give that file",
    ),
    (&["cap"], "a project of Capstone", "in Capstone: File, Export Data, as CSV; give that file"),
    (
        &["cmbl", "gambl"],
        "a project of Vernier's",
        "in Logger Pro or Graphical Analysis: File, Export, CSV; give that file",
    ),
    (&["xmcd", "mcdx"], "a sheet of Mathcad", "there: save or export the table as CSV or text; give that file"),
    (
        &["avi", "mp4", "mov", "mkv", "m4v", "webm"],
        "a film",
        "track the ball, in Tracker or ImageJ for instance, and give the table of its places",
    ),
    (
        &["wav", "mp3", "m4a", "aac", "ogg", "opus", "flac", "wma", "aiff", "aif", "caf", "amr", "3gp", "aup3"],
        "a sound that is not WAV",
        "save it as WAV, in Audacity for instance (File, Export), or by ffmpeg -i drop.m4a drop.wav; give that file",
    ),
    (&["pdf"], "a PDF", "copy the table into a spreadsheet and save it as CSV"),
    (&["docx", "odt", "doc", "rtf"], "a text document", "copy the table into a spreadsheet and save it as CSV"),
    (
        &["png", "jpg", "jpeg", "heic", "gif", "tif", "tiff"],
        "a picture",
        "type the numbers into a spreadsheet and save it as CSV",
    ),
    (&["numbers"], "a sheet of Numbers", "in Numbers: File, Export To, CSV or Excel; give that file"),
    (
        &["json"],
        "JSON without records of numbers, or longer than 16 MB",
        "write its numbers as a table, a name above each column, and save it as CSV",
    ),
    (
        &["sql"],
        "SQL that inserts no rows of a table, or of several",
        "export the rows as CSV, such as by SELECT into a file; give that file",
    ),
    (&["xml"], "XML without records of numbers", "export the table as CSV; give that file"),
    (&["xlsb"], "a workbook of a kind that is not read", "save it as .xlsx or as CSV"),
];

/// The beginnings of such files, where the ending does not tell.
const BEGINNINGS: [(&[u8], &str); 6] = [
    (b"%PDF", "pdf"),
    (b"\x89PNG", "png"),
    (b"\xFF\xD8\xFF", "jpg"),
    (b"OggS", "ogg"),
    (b"{\\rtf", "rtf"),
    (b"fLaC", "flac"),
];

/// Whether a file holds records as members of values, or of elements, and is no page of the web and
/// no other program's own.
pub(super) fn of_records(name: &str, bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(BEGIN)]);
    !text.trim_start().starts_with('<') || matches!(&*kind(name, bytes), "xml" | "txt" | "") && !is_page(&text)
}

/// So many bytes at the beginning of a file tell what it is.
const BEGIN: usize = 4000;

/// The error for a file of another program's own kind.
pub(super) fn refused(name: &str, bytes: &[u8]) -> Option<TableError> {
    let kind = kind(name, bytes);
    let (_, what, help) = KINDS.iter().find(|(endings, _, _)| endings.contains(&&*kind))?;
    // A table that only has the name of something else is a table, and so are rows that are
    // inserted.
    if kind == "sql" && forms::dumped(&String::from_utf8_lossy(bytes)).is_some() {
        return None;
    }
    let table = bytes.starts_with(b"PK") && !matches!(&*kind, "docx" | "odt" | "xlsb" | "numbers");
    (!table).then(|| TableError::new(name, format!("this is {what}, and no table")).help(*help))
}

/// The ending that files of this kind have, whatever it is called; that of its name where what it
/// holds does not tell.
fn kind(name: &str, bytes: &[u8]) -> String {
    let ending = name.rsplit_once('.').map_or(String::new(), |(_, ending)| ending.to_lowercase());
    let begins = |mark: &[u8]| bytes.starts_with(mark);
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(BEGIN)]);
    let found = BEGINNINGS.iter().find(|(mark, _)| begins(mark)).map(|(_, kind)| *kind);
    let kind = match found {
        Some(kind) => kind,
        None if begins(b"RIFF") && bytes.get(8..12) == Some(b"AVI ") => "avi",
        None if begins(b"RIFF") => "wav",
        None if bytes.get(4..11) == Some(b"ftypM4A") => "m4a",
        None if bytes.get(4..8) == Some(b"ftyp") => {
            if ending == "m4a" {
                "m4a"
            } else {
                "mp4"
            }
        }
        None if text.contains("org.opensourcephysics") => "trk",
        None if text.trim_start().starts_with(['{', '[']) && text.contains('"') && text.contains(':') => "json",
        None if text.contains("<MBL>") || text.contains("LoggerPro") => "cmbl",
        None => ending.as_str(),
    };
    kind.to_owned()
}

/// Whether a text begins as a page of the web that may hold tables.
fn is_page(text: &str) -> bool {
    let head = text.trim_start().to_lowercase();
    head.starts_with('<') && (head.contains("<table") || head.contains("<html"))
}

/// A text of a forum, whose tags stand in square brackets, `[tr][td]`, as a page of the web; `None`
/// if it is none.
fn forum(text: &str) -> Option<String> {
    let spelt = text.to_lowercase();
    let table = ["[table]", "[tr]", "[td]"].iter().all(|tag| spelt.contains(tag));
    let from = spelt.find("[table]").filter(|_| table && spelt.len() == text.len())?;
    let plain = text[from..].replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    Some(plain.replace('[', "<").replace(']', ">"))
}

/// The tables of a page of the web, or of a post in a forum, cells separated by tabs; `None` if the
/// text is none.
pub(super) fn html(text: &str) -> Option<Vec<Part>> {
    if let Some(page) = forum(text) {
        return html(&page);
    }
    if !is_page(&text.trim_start().chars().take(BEGIN).collect::<String>()) {
        return None;
    }
    let mut reader = Reader::from_str(text);
    let config = reader.config_mut();
    config.check_end_names = false;
    config.allow_unmatched_ends = true;
    let mut page = Page::default();
    loop {
        match reader.read_event() {
            Ok(Event::Start(tag)) => {
                let spans = (span(&tag, "colspan"), span(&tag, "rowspan"));
                page.begin(&tag.local_name().as_ref().to_ascii_lowercase(), spans);
            }
            Ok(Event::Empty(tag)) if tag.local_name().as_ref().eq_ignore_ascii_case("br") => page.text(" "),
            Ok(Event::End(tag)) => page.end(&tag.local_name().as_ref().to_ascii_lowercase()),
            Ok(Event::Text(words)) => page.text(words.as_ref()),
            Ok(Event::GeneralRef(name)) => page.text(&entity(name.as_ref())),
            Ok(Event::Eof) => break,
            Ok(_) => {}
            // What is no markup may stand in a script; the tables before it are whole.
            Err(_) => break,
        }
    }
    page.end("table");
    page.end_line();
    // What stands below the last table is part of it.
    let told = page.told.split_off(0);
    if let Some(Part { content: Content::Cells(cells), .. }) = page.parts.last_mut() {
        told.iter().for_each(|line| cells.extend([line.as_str(), "\n"]));
    }
    Some(page.parts)
}

/// So many lines of a page stand above a table at most.
const ABOVE: usize = 20;

/// How many columns, or rows, a cell spans.
fn span(tag: &quick_xml::events::BytesStart<'_>, of: &str) -> usize {
    // In a page of the web a value needs no quotes.
    let value = tag.html_attributes().with_checks(false).flatten().find(|a| a.key.as_ref().eq_ignore_ascii_case(of));
    let number = value.and_then(|attribute| attribute.value.trim().parse::<usize>().ok());
    number.unwrap_or(1).clamp(1, MANY)
}

/// The character that a name stands for.
pub(super) fn entity(name: &str) -> String {
    let code = name.strip_prefix('#').and_then(|n| match n.strip_prefix(['x', 'X']) {
        Some(hex) => u32::from_str_radix(hex, 16).ok(),
        None => n.parse().ok(),
    });
    if let Some(c) = code.and_then(char::from_u32) {
        return c.to_string();
    }
    let known = quick_xml::escape::resolve_predefined_entity(name);
    known.map_or_else(
        || match name {
            "plusmn" => "±".to_owned(),
            "deg" => "°".to_owned(),
            "frac12" => "½".to_owned(),
            "auml" | "ouml" | "uuml" | "Auml" | "Ouml" | "Uuml" => name[..1].to_owned(),
            "eacute" | "egrave" | "agrave" => name[..1].to_owned(),
            "Delta" => "Δ".to_owned(),
            "sigma" => "σ".to_owned(),
            "minus" => "−".to_owned(),
            _ => " ".to_owned(),
        },
        str::to_owned,
    )
}

/// Whether a tag ends no line of text: emphasis, a link, a small sign.
fn within_a_line(tag: &str) -> bool {
    matches!(tag, "b" | "i" | "em" | "strong" | "u" | "span" | "a" | "small" | "sub" | "sup" | "font" | "code" | "mark")
}

/// Takes the mark of a note off the number that it stands at: `200<sup>a</sup>`.
fn unmarked(cell: &mut String) {
    let bare = |(number, mark): &(&str, &str)| {
        let letters = (1..=MARK).contains(&mark.trim().chars().count())
            && !mark.contains(|c: char| c.is_ascii_digit() || c == '-');
        letters && matches!(cell::read(number.trim(), false), Cell::Number(_))
    };
    if let Some(end) = cell.split_once('^').filter(bare).map(|(number, _)| number.trim_end().len()) {
        cell.truncate(end);
    }
}

/// The mark of a note is no longer: `a`, `**`, `(b)`.
const MARK: usize = 3;

/// The tables found so far.
#[derive(Default)]
struct Page {
    parts: Vec<Part>,
    /// The lines of text since the last table, the one that is open, and whether a script is, or
    /// the caption of a table.
    told: Vec<String>,
    line: String,
    script: bool,
    caption: bool,
    table: Option<String>,
    /// The cells of the row, and whether the last one is open.
    row: Vec<String>,
    open: bool,
    /// How many columns and rows the last cell spans.
    span: (usize, usize),
    /// In how many rows from here on each column is part of a cell above.
    taken: Vec<usize>,
}

impl Page {
    fn begin(&mut self, tag: &str, span: (usize, usize)) {
        match tag {
            "table" => {
                self.end_line();
                self.table = Some(String::new());
                self.taken.clear();
            }
            "script" | "style" => self.script = true,
            "caption" => self.caption = true,
            _ if self.table.is_none() && !within_a_line(tag) => self.end_line(),
            "tr" => self.close_row(),
            "td" | "th" => {
                self.close_cell();
                self.skip_taken();
                if self.row.len() < MANY {
                    self.row.push(String::new());
                    (self.open, self.span) = (true, span);
                }
            }
            "br" => self.text(" "),
            "sub" => self.text("_"),
            "sup" => self.text("^"),
            _ => {}
        }
    }

    fn end(&mut self, tag: &str) {
        match tag {
            "td" | "th" => self.close_cell(),
            "tr" => self.close_row(),
            "table" => {
                self.close_row();
                if let Some(text) = self.table.take().filter(|_| self.parts.len() < MANY) {
                    let text = lettered(&text).unwrap_or(text);
                    let above = self.told.len().saturating_sub(ABOVE);
                    let mut lines = self.told.split_off(above);
                    self.told.clear();
                    lines.push(text);
                    let text = lines.join("\n");
                    let name = format!("table {}", self.parts.len() + 1);
                    self.parts.push(Part::new(name, None, Content::Cells(text)));
                }
            }
            "script" | "style" => self.script = false,
            "caption" => {
                self.end_line();
                self.caption = false;
            }
            _ if self.table.is_none() && !within_a_line(tag) => self.end_line(),
            _ => {}
        }
    }

    /// Ends a line of text outside of tables.
    fn end_line(&mut self) {
        let line = self.line.split_whitespace().collect::<Vec<_>>().join(" ");
        self.line.clear();
        if !line.is_empty() {
            self.told.push(line);
        }
    }

    fn text(&mut self, words: &str) {
        let outside = (self.table.is_none() || self.caption) && !self.script && self.line.len() < MANY;
        let line = outside.then_some(&mut self.line);
        if let Some(text) = self.row.last_mut().filter(|_| self.open).or(line) {
            text.extend(words.chars().map(|c| if c.is_control() || c == '"' { ' ' } else { c }));
        }
    }

    fn close_cell(&mut self) {
        if self.open {
            if let Some(text) = self.row.last_mut() {
                unmarked(text);
            }
            let (columns, rows) = self.span;
            let more = columns.min(MANY - self.row.len().min(MANY) + 1) - 1;
            let first = self.row.len() - 1;
            self.row.extend(std::iter::repeat_n(String::new(), more));
            let end = self.row.len();
            self.taken.resize(self.taken.len().max(end), 0);
            self.taken[first..end].fill(rows);
            self.open = false;
        }
    }

    /// Empty cells where a cell of a row above reaches down.
    fn skip_taken(&mut self) {
        while self.taken.get(self.row.len()).is_some_and(|rows| *rows > 0) {
            self.row.push(String::new());
        }
    }

    fn close_row(&mut self) {
        self.close_cell();
        if !self.row.is_empty() {
            self.taken.iter_mut().for_each(|rows| *rows = rows.saturating_sub(1));
        }
        if let Some(table) = self.table.as_mut().filter(|_| !self.row.is_empty()) {
            let cells: Vec<&str> = self.row.iter().map(|cell| cell.trim()).collect();
            table.push_str(&cells.join("\t"));
            table.push('\n');
        }
        self.row.clear();
    }
}
