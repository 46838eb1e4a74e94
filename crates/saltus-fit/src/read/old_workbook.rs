//! Whether an old workbook (`.xls`) may be given to its reader, which trusts what it reads: sectors
//! that are chained in a circle, and two cells far apart, would have it fill the memory.
//!
//! The container is that of \[MS-CFB\], the records in it are those of \[MS-XLS\].

use super::limits::{CELLS, MANY};

/// What an old sheet has at most.
const ROWS: u32 = 1 << 16;
const COLUMNS: u32 = 1 << 8;

/// The largest numbers of sectors mean "the end", "free" and the like.
const LAST: u32 = 0xFFFF_FFF9;
const END: u32 = 0xFFFF_FFFE;

/// Refuses what would harm.
pub(super) fn check(bytes: &[u8]) -> Result<(), String> {
    let damaged = || "it is damaged or was cut short".to_owned();
    let container = Container::open(bytes).ok_or_else(damaged)?;
    for stream in container.workbooks().ok_or_else(damaged)? {
        span(&stream)?;
    }
    Ok(())
}

fn short(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?)))
}

fn long(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}

fn longs(bytes: &[u8]) -> impl Iterator<Item = u32> {
    bytes.chunks_exact(4).filter_map(|chunk| long(chunk, 0))
}

/// A file of streams, each a chain of sectors.
struct Container<'a> {
    /// What follows the head.
    sectors: &'a [u8],
    head: &'a [u8],
    size: usize,
    /// The sector after each one.
    next: Vec<u32>,
}

impl<'a> Container<'a> {
    /// `None` if a sector that is named is not in the file: then it was cut short.
    fn open(bytes: &'a [u8]) -> Option<Self> {
        let size = if bytes.get(30) == Some(&12) { 4096 } else { 512 };
        let (head, sectors) = bytes.split_at_checked(size)?;
        let mut file = Self { sectors, head, size, next: Vec::new() };
        let count = sectors.len().div_ceil(size);
        // The first 109 parts of the table are listed in the head, more in sectors that name the
        // next of their kind at the end.
        let mut parts: Vec<u32> = longs(&head[76..512]).collect();
        let mut more = long(head, 68)?;
        for _ in 0..=count {
            if more > LAST {
                break;
            }
            parts.extend(longs(file.sector(more)?));
            more = parts.pop()?;
        }
        parts.retain(|id| *id <= LAST);
        if parts.len() > count {
            return None;
        }
        for part in parts {
            file.next.extend(longs(file.sector(part)?));
        }
        file.next.iter().all(|id| *id > LAST || (*id as usize) < count).then_some(file)
    }

    fn sector(&self, id: u32) -> Option<&'a [u8]> {
        self.sectors.chunks(self.size).nth(id as usize)
    }

    /// The sectors of a stream from `start`, at most `bytes` of them; `None` if it goes round in
    /// circles.
    fn read(&self, start: u32, bytes: u64) -> Option<Vec<u8>> {
        chained(self.sectors, self.size, &self.next, start, bytes)
    }

    /// The streams that may be the workbook; `None` if one cannot be read.
    fn workbooks(&self) -> Option<Vec<Vec<u8>>> {
        let entries = self.read(long(self.head, 48)?, u64::MAX)?;
        let entries: Vec<&[u8]> = entries.chunks_exact(128).collect();
        let length = |entry: &[u8]| {
            let high = if self.size > 512 { u64::from(long(entry, 124)?) << 32 } else { 0 };
            Some(high + u64::from(long(entry, 120)?))
        };
        let first = entries.first()?;
        let (mut small, mut next) = (Vec::new(), Vec::new());
        if long(self.head, 64)? > 0 {
            small = self.read(long(first, 116)?, length(first)?)?;
            next =
                longs(&self.read(long(self.head, 60)?, u64::from(long(self.head, 64)?) * self.size as u64)?).collect();
        }
        let named = |entry: &&&[u8]| {
            let letters = entry[..64].chunks_exact(2).map(|pair| char::from(pair[0]).to_ascii_lowercase());
            let name: String = letters.take_while(|c| *c != '\0').collect();
            name == "workbook" || name == "book"
        };
        let stream = |entry: &&[u8]| {
            let (start, bytes) = (long(entry, 116)?, length(entry)?);
            if bytes < 4096 { chained(&small, 64, &next, start, bytes) } else { self.read(start, bytes) }
        };
        entries.iter().filter(named).map(stream).collect()
    }
}

fn chained(from: &[u8], size: usize, next: &[u32], start: u32, bytes: u64) -> Option<Vec<u8>> {
    let (mut stream, mut id, mut steps) = (Vec::new(), start, 0);
    while id != END && (stream.len() as u64) < bytes {
        let at = (id as usize).checked_mul(size)?;
        stream.extend(from.get(at..)?.iter().take(size));
        id = *next.get(id as usize)?;
        steps += 1;
        if steps > next.len() {
            return None;
        }
    }
    Some(stream)
}

/// The records of a stream: what each is, and its content.
fn records(mut stream: &[u8]) -> impl Iterator<Item = (u32, &[u8])> {
    std::iter::from_fn(move || {
        let (kind, length) = (short(stream, 0)?, short(stream, 2)? as usize);
        let (content, rest) = stream.get(4..)?.split_at_checked(length)?;
        stream = rest;
        Some((kind, content))
    })
}

/// Refuses sheets whose cells span more than is kept.
fn span(stream: &[u8]) -> Result<(), String> {
    const BEGIN: u32 = 0x809;
    const END: u32 = 0xA;
    const SHEET: u32 = 0x85;
    const DIMENSIONS: u32 = 0x200;
    const ROW_OF_NUMBERS: u32 = 0xBD;
    // Formula, number, label, label with runs, truth, shared label, packed number.
    const CELL: [u32; 7] = [0x6, 0x203, 0x204, 0xD6, 0x205, 0xFD, 0x27E];
    let too_large = || "its cells lie too far apart".to_owned();
    let globals = records(stream).take_while(|(kind, _)| *kind != END);
    let sheets: Vec<usize> = globals
        .filter(|(kind, _)| *kind == SHEET)
        .filter_map(|(_, content)| Some(long(content, 0)? as usize))
        .collect();
    if sheets.len() > MANY {
        return Err(format!("it has more than {MANY} sheets"));
    }
    let mut left = CELLS as u64;
    for at in sheets {
        let (mut depth, mut rows, mut columns) = (0, 0, 0);
        for (kind, content) in records(stream.get(at..).unwrap_or_default()) {
            match kind {
                BEGIN => depth += 1,
                END if depth < 2 => break,
                END => depth -= 1,
                // A chart within the sheet.
                _ if depth > 1 => {}
                DIMENSIONS => {
                    let (row, column) = if content.len() < 14 {
                        (short(content, 2), short(content, 6))
                    } else {
                        (long(content, 4), short(content, 10))
                    };
                    if row.is_some_and(|row| row > ROWS) || column.is_some_and(|column| column > COLUMNS) {
                        return Err(too_large());
                    }
                }
                _ if kind == ROW_OF_NUMBERS || CELL.contains(&kind) => {
                    let more = if kind == ROW_OF_NUMBERS { content.len() as u32 / 6 } else { 0 };
                    rows = rows.max(short(content, 0).unwrap_or_default() + 1);
                    columns = columns.max(short(content, 2).unwrap_or_default() + 1 + more);
                }
                _ => {}
            }
        }
        left = left.checked_sub(u64::from(rows) * u64::from(columns)).ok_or_else(too_large)?;
    }
    Ok(())
}
