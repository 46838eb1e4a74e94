//! Whatever the bytes, reading ends, soon, with a table or with an error that says something.
//!
//! `HOSTILE=100000 cargo test --release -p saltus-fit hostile::` is the long run: so many
//! changed files of every kind.

use std::path::Path;

use crate::random::Random;
use crate::written::{cells, workbook, xlsx, zip};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{ReadOptions, Table};

const TEXTS: [&str; 8] = [
    include_str!("tables/events.csv"),
    include_str!("tables/tracker.txt"),
    include_str!("tables/tracks.txt"),
    include_str!("tables/imagej.txt"),
    include_str!("tables/logger.txt"),
    include_str!("tables/bare.txt"),
    include_str!("tables/runs.csv"),
    include_str!("tables/stopwatch.csv"),
];

/// Reads whatever it is, in every way; only that it ends matters.
fn swallow(bytes: &[u8]) {
    let all = ReadOptions::default().fps(30.0).scale(0.01).height_unit("px").time_unit("ms").zero(3.0).y_down(true);
    for options in [
        ReadOptions::default(),
        ReadOptions::default().fps(100.0),
        ReadOptions::default().header(&["time_s", "-", "height_m"]),
        ReadOptions::default().sheet("All").column("y"),
        all,
    ] {
        match Table::parse("any", bytes, &options) {
            Ok(table) => assert!(
                table
                    .trials()
                    .iter()
                    .flat_map(|t| t.readings())
                    .all(|r| { r.time.is_none_or(f64::is_finite) && r.height.is_none_or(f64::is_finite) })
            ),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

/// Files of every kind that can be read; workbooks of other people's where they are to be had.
fn seeds() -> Vec<Vec<u8>> {
    let sheet = "Event time (s),Interval (s),,Event time (s),Interval (s)\n0.5,0.4,,0.6,0.5\n0.9,0,,1.1,0\n";
    let mut seeds: Vec<Vec<u8>> = TEXTS.iter().map(|text| text.as_bytes().to_vec()).collect();
    seeds.push(TEXTS[0].encode_utf16().flat_map(u16::to_le_bytes).collect());
    seeds.push(xlsx(&[("80 cm", cells(sheet)), ("All", cells(sheet))]));
    seeds.push(zip(&[("All.csv", sheet), ("meta/device.csv", "property,value\n")]));
    let borrowed = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/phyphox_golf_tennis");
    for name in ["tennis/Lancio 1, tennis, 65.xls", "CR_method2.xlsx"] {
        match std::fs::read(borrowed.join(name)) {
            Ok(bytes) => seeds.push(bytes),
            Err(_) => eprintln!("skipped: {} is not here", borrowed.join(name).display()),
        }
    }
    seeds
}

#[test]
fn no_change_to_a_good_file_is_too_much() {
    let rounds = std::env::var("HOSTILE").ok().and_then(|n| n.parse().ok()).unwrap_or(60);
    let mut random = Random(7);
    for (kind, seed) in seeds().iter().enumerate() {
        swallow(seed);
        for round in 0..rounds {
            let mut bytes = seed.clone();
            for _ in 0..=random.below(4) {
                let at = random.below(bytes.len());
                match random.below(6) {
                    0 => bytes.truncate(at),
                    1 => bytes.insert(at, random.below(256) as u8),
                    2 if !bytes.is_empty() => drop(bytes.remove(at)),
                    3 if !bytes.is_empty() => {
                        bytes[at] = [0, 0xFF, b'\t', b'\n', b',', b'"', b'#', b'9'][random.below(8)];
                    }
                    _ if !bytes.is_empty() => bytes[at] = random.below(256) as u8,
                    _ => {}
                }
            }
            let outcome = std::panic::catch_unwind(|| swallow(&bytes));
            assert!(outcome.is_ok(), "kind {kind}, round {round}: {} bytes", bytes.len());
        }
    }
}

/// Addresses of cells beyond any sheet make the reader of workbooks overflow.
#[test]
fn no_address_is_too_far() {
    for address in ["AINTERVALLLLLL3", "A99999999999"] {
        swallow(&workbook(&[("a", format!("<row r=\"1\"><c r=\"{address}\"><v>1</v></c></row>"))]));
    }
}

#[test]
fn no_message_is_too_long() {
    let rows = format!("<row r=\"1\"><c r=\"A1\" t=\"inlineStr\"><is><{}></row>", "\u{3}I".repeat(5000));
    let error = Table::parse("any", &workbook(&[("a", rows)]), &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.len() < 1000 && !error.contains('\u{3}'), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(200), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_are_too_much(start in 0usize..6, bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let magic: &[u8] = [&b""[..], b"PK\x03\x04", b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", b"\xFF\xFE", b"\xFE\xFF", b"Vernier Format 2\n"][start];
        swallow(&[magic, &bytes].concat());
    }

    #[test]
    fn no_text_is_too_much(start in 0usize..4, text in "[a-z0-9,;:\t\n\"#().-]{0,200}") {
        let first = ["", "Frame,Y1\n", "t\tx\ty\n", "Run 1: t (s),Run 2: t (s)\n"][start];
        swallow(format!("{first}{text}").as_bytes());
    }

    #[test]
    fn no_sheet_is_too_much(rows in proptest::collection::vec(proptest::collection::vec("[a-z0-9 .():-]{0,9}", 0..6), 0..12)) {
        swallow(&xlsx(&[("a", rows.clone()), ("2 m", rows)]));
    }
}
