//! Whatever the bytes, reading ends, soon, with a table or with an error that says something.
//!
//! `HOSTILE=100000 cargo test --release -p saltus-fit --test hostile` is the long run: so many changed files of every kind.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

mod written;

use std::path::Path;

use proptest::prelude::*;
use saltus_fit::{ReadOptions, Table};
use written::{cells, xlsx, zip};

const TEXTS: [&str; 8] = [
    "# frame rate: 30\nevent,time_s,height_cm\nrelease,0,100\ncontact,0.45,\napex,,30\ncontact,0.85,\n",
    "mass A\t\t\t\nt\tx\ty\tv_{y}\n0\t0\t1\t\n0.04\t0\t9.0E-1\t-5\n0.08\t0\t0.7\t\n",
    "#multi:\n\tball\t\t\tedge\t\nt\tframe\tx\ty\tx\ty\n0\t1\t0\t1\t5\t5\n0.04\t2\t0\t0.9\t5\t5.001\n",
    "Frame\tX1\tY1\tFlag1\tX2\tY2\tFlag2\nTracks 1 to 2\n1\t5\t100\t \t9\t50\t \n2\t5\t104\t*\t9\t50.5\t \n\nTrack \tLength\n1\t9\n",
    "Vernier Format 2\nlab\nRun\nTime\tPosition\nt\ty\ns\tcm\n\n0\t100\n0.1\t90\n0\t0\nVernier Format 2\nlab\nRun\nTime\tPosition\ns\tcm\n1\t2\n",
    "673.3;587.1;\n673.7;587.4;\n674.2;nan;\n",
    "Run 1: Time (s),Run 1: Position (m),Run 2: Time (s),Run 2: Position (m)\n0,1,0,2\n0.1,0.9,0.1,1.9\n",
    "H (cm),T0,T1\n100,0:01.25,1:02:03\n",
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

/// A generator of numbers that look random and are the same in every run (S. Vigna's `splitmix64`).
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n.max(1) as u64) as usize
    }
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

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

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
