//! Old workbooks that would have their reader fill the memory are refused before they come to it.

use saltus_fit::{ReadOptions, Table};

const END: u32 = 0xFFFF_FFFE;
const FREE: u32 = 0xFFFF_FFFF;

fn record(kind: u16, content: &[u8]) -> Vec<u8> {
    [&kind.to_le_bytes()[..], &(content.len() as u16).to_le_bytes(), content].concat()
}

fn number(row: u16, column: u16, value: f64) -> Vec<u8> {
    let place = [row, column, 0].map(u16::to_le_bytes).concat();
    record(0x203, &[&place[..], &value.to_le_bytes()].concat())
}

/// A workbook of one sheet with these records.
fn stream(records: &[Vec<u8>]) -> Vec<u8> {
    let begin = |what: u8| record(0x809, &[0, 6, what, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    let end = record(0xA, &[]);
    let start = begin(5).len() + 4 + 9 + end.len();
    let sheet = record(0x85, &[&(start as u32).to_le_bytes()[..], &[0, 0, 1, 0, b'a']].concat());
    [begin(5), sheet, end.clone(), begin(16), records.concat(), end].concat()
}

/// The stream in its container, of sectors 0: the table, 1: the directory, 2 and so on: the stream;
/// the changes are made to the table.
fn file(mut stream: Vec<u8>, length: u32, changes: &[(usize, u32)]) -> Vec<u8> {
    stream.resize(stream.len().max(4096).next_multiple_of(512), 0);
    let sectors = stream.len() / 512;
    let mut head = vec![0; 512];
    head[..8].copy_from_slice(b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1");
    (head[26], head[28], head[29], head[30], head[32]) = (3, 0xFE, 0xFF, 9, 6);
    for (at, value) in [(44, 1), (48, 1), (56, 4096), (60, END), (68, END)] {
        head[at..at + 4].copy_from_slice(&u32::to_le_bytes(value));
    }
    head[80..].fill(0xFF);
    let mut table = vec![FREE; 128];
    (table[0], table[1]) = (0xFFFF_FFFD, END);
    for n in 0..sectors {
        table[2 + n] = if n + 1 < sectors { 3 + n as u32 } else { END };
    }
    for &(at, value) in changes {
        table[at] = value;
    }
    let mut directory = vec![0; 512];
    for (entry, name, kind, start, length) in [(0, "Root Entry", 5, END, 0), (128, "Workbook", 2, 2, length)] {
        let letters: Vec<u8> = name.encode_utf16().flat_map(u16::to_le_bytes).collect();
        directory[entry..entry + letters.len()].copy_from_slice(&letters);
        (directory[entry + 64], directory[entry + 66]) = (letters.len() as u8 + 2, kind);
        directory[entry + 116..entry + 120].copy_from_slice(&u32::to_le_bytes(start));
        directory[entry + 120..entry + 124].copy_from_slice(&u32::to_le_bytes(length));
    }
    let table: Vec<u8> = table.into_iter().flat_map(u32::to_le_bytes).collect();
    [head, table, directory, stream].concat()
}

fn read(file: &[u8]) -> Result<Table, String> {
    let options = ReadOptions::default().header(&["bounce", "height_cm"]);
    Table::parse("old.xls", file, &options).map_err(|error| error.to_string())
}

fn refused(file: &[u8], says: &str) {
    let message = read(file).expect_err("a refusal");
    assert!(message.contains(says), "no '{says}' in {message}");
}

#[test]
fn an_old_workbook_is_read() {
    let heights = [number(0, 0, 0.0), number(0, 1, 100.0), number(1, 0, 1.0), number(1, 1, 64.0)];
    let table = read(&file(stream(&heights), 4096, &[])).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(table.trials()[0].readings()[1].height, Some(0.64));
}

/// Two cells would be four thousand million.
#[test]
fn cells_far_apart_are_refused() {
    refused(&file(stream(&[number(0, 0, 1.0), number(65_535, 65_535, 2.0)]), 4096, &[]), "too far apart");
    let dimensions = record(0x200, &[0, 0, 255, 255, 0, 0, 255, 255, 0, 0]);
    refused(&file(stream(&[dimensions, number(0, 0, 1.0)]), 4096, &[]), "too far apart");
}

/// A stream that says it is four gigabytes long, and goes round until it is; and a directory that
/// has no end.
#[test]
fn sectors_in_a_circle_are_refused() {
    refused(&file(stream(&[number(0, 0, 1.0)]), u32::MAX, &[(9, 2)]), "damaged");
    refused(&file(stream(&[number(0, 0, 1.0)]), 4096, &[(1, 1)]), "damaged");
}
