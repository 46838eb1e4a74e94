//! Findings are data: every kind has words and a line in the documentation, and a report that was
//! written is read back as it was.

use std::fmt::{Debug, Display};
use std::fs;
use std::path::Path;

use crate::film::{Ball, Contact, csv, noisy, report};
use crate::noise::Noise;
use proptest::prelude::*;
use saltus_fit::{
    Fit, Lines, Loss, Named, Note, Pace, Program, ReadOptions, Remark, Repair, Report, Severity, Shape, Table, Verdict,
    Warning,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// What JSON has of a report is the same after it was read back.
fn comes_back(report: &Report) {
    let json = serde_json::to_string(report).unwrap();
    let back: Report = serde_json::from_str(&json).unwrap_or_else(|e| panic!("{e}\n{json}"));
    assert_eq!(serde_json::to_string(&back).unwrap(), json);
    assert_eq!(back.to_string(), report.to_string());
    assert_eq!((back.findings(), back.scene()), (report.findings(), report.scene()));
}

/// The verdict is that of the findings, and the reason is the words of the first of them.
fn follows_from_its_findings(report: &Report) {
    let gravest = report.findings().iter().map(|f| f.severity).max_by_key(|s| match s {
        Severity::Note => 0,
        Severity::Doubt => 1,
        _ => 2,
    });
    let expected = match gravest {
        Some(Severity::Refusal) => Verdict::Refused,
        Some(Severity::Doubt) => Verdict::Doubtful,
        _ => Verdict::Trusted,
    };
    assert_eq!(report.verdict(), expected, "{report}\n{:#?}", report.findings());
    let first = report.findings().first().unwrap_or_else(|| panic!("no finding: {report}"));
    assert_eq!((Some(first.severity), first.to_string()), (gravest, report.reason().to_owned()));
    assert_eq!(report.verdict() == Verdict::Refused || !report.groups().is_empty(), report.cor().is_none());
}

fn checked(text: &str, fit: &Fit) {
    let Ok(table) = Table::parse("t.csv", text.as_bytes(), &ReadOptions::default()) else { return };
    let report = fit.run(&table).unwrap();
    comes_back(&report);
    follows_from_its_findings(&report);
}

#[test]
fn reports_of_every_kind_come_back() {
    let all = Fit::new().losses(&Loss::ALL).profiles(true).tolerance_height(0.01).tolerance_time(0.01).bootstrap(20, 1);
    for text in [
        "height_cm\n100\n64\n41\n26\n17\n",
        "height_cm\n100\n",
        "height_cm\n100\n0\n0\n",
        "height_cm\n100\n120\n130\n",
        "height_cm\n100\n64\n26\n17\n11\n7\n",
        "time_s\n0.45\n1.17\n1.75\n2.21\n2.58\n2.88\n3.12\n",
        "time_s\n0.45\n1.17\n",
        "# frame rate: 30\nevent,time_s,height_cm\nrelease,0,100\ncontact,0.45,\napex,,30\ncontact,0.85,\napex,,10\ncontact,1.11,\n",
        "ball,trial,bounce,height_cm\na,1,0,100\na,1,1,64\na,2,0,100\na,2,1,65\nb,1,0,100\nb,1,1,49\nb,2,0,100\nb,2,1,50\n",
        "drop_cm,rebound_cm\n100,64\n100,65\n100,63\n90,58\n80,51\n70,45\n",
        "time_s,height_m\n0,1\n0.1,0.95\n0.2,0.80\n0.3,0.56\n0.4,0.21\n",
    ] {
        checked(text, &Fit::new());
        checked(text, &all);
    }
    let mut noise = Noise(1);
    for contact in [Contact::Instant, Contact::Spring(0.01)] {
        let ball = Ball { drop: 1.0, release: 0.1, gravity: 9.81, drag: 0.02, cor: |_| 0.8, contact };
        let report = report(&csv(&noisy(&ball.film(60.0, 2.0), &mut noise, 1e-3)));
        comes_back(&report);
        follows_from_its_findings(&report);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(if cfg!(debug_assertions) { 150 } else { 1500 }) })]

    #[test]
    fn any_heights_and_times_come_back(
        heights in proptest::collection::vec(prop_oneof![0.0..2.0f64, Just(0.0), 1e-9..1e-3f64, 1.0..1e4f64], 1..9),
        steps in proptest::collection::vec(1e-3..2.0f64, 1..12),
        trials in 1usize..4,
    ) {
        let mut text = "trial,bounce,height_m\n".to_owned();
        let mut times = "trial,time_s\n".to_owned();
        for trial in 0..trials {
            for (n, h) in heights.iter().enumerate() {
                text += &format!("{trial},{n},{}\n", h * (1.0 + 0.01 * trial as f64));
            }
            let mut t = 0.1;
            for step in &steps {
                times += &format!("{trial},{t}\n");
                t += step * (1.0 + 0.02 * trial as f64);
            }
        }
        checked(&text, &Fit::new());
        checked(&times, &Fit::new());
    }
}

/// The variants of the enumeration of findings.
fn kinds() -> Vec<String> {
    let source = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/finding/kind.rs")).unwrap();
    let body = source.split_once("pub enum FindingKind {").expect("the enumeration").1;
    let body = body.split_once("\n}").expect("its end").0;
    let first = |line: &str| line.split([' ', ',', '{']).next().unwrap_or("").to_owned();
    let variants = body.lines().filter_map(|line| line.strip_prefix("    ")).map(first);
    variants.filter(|word| word.starts_with(|c: char| c.is_ascii_uppercase())).collect()
}

#[test]
fn every_kind_has_words() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let words: String = ["repairs", "models", "verdict"]
        .map(|name| fs::read_to_string(root.join(format!("src/report/words/{name}.rs"))).unwrap())
        .concat();
    let kinds = kinds();
    assert!(kinds.len() > 60, "{kinds:?}");
    for kind in kinds {
        let name = format!("FindingKind::{kind}");
        let named = words.match_indices(&name);
        let whole = named.filter(|(at, found)| !words[at + found.len()..].starts_with(|c: char| c.is_alphanumeric()));
        assert!(whole.count() > 0, "{kind} has no words");
    }
}

/// Every remark of reading comes back from JSON, and has words: those of its parts before its own.
#[test]
fn every_remark_comes_back() {
    fn back<K: Clone + PartialEq + Debug + Display + Serialize + DeserializeOwned>(kinds: Vec<K>) -> usize
    where
        Remark<K>: Display,
    {
        for kind in &kinds {
            let whole = Remark::from(kind.clone());
            let json = serde_json::to_value(&whole).unwrap();
            assert!(json["kind"].is_string() && json.get("parts").is_none(), "{json}");
            assert_eq!(serde_json::from_value::<Remark<K>>(json.clone()).unwrap(), whole);
            assert_eq!(whole.to_string(), kind.to_string());
            let mut part = json;
            part["parts"] = serde_json::json!([{ "first": "a.csv", "last": "c.csv", "count": 3 }, { "first": "S", "last": "S", "count": 1 }]);
            let part: Remark<K> = serde_json::from_value(part).unwrap();
            assert_eq!(part.to_string(), format!("a.csv to c.csv (3 of them): S: {kind}"));
            assert!(kind.to_string().len() > 10, "{kind}");
        }
        kinds.len()
    }
    let column = || "h (cm)".to_owned();
    let columns = || vec![column(), "t (s)".to_owned()];
    let shapes = vec![
        Shape::Events,
        Shape::Tops { times: column(), heights: column() },
        Shape::ContactsAndHeights { times: column(), heights: column() },
        Shape::Contacts { times: column() },
        Shape::Intervals { intervals: column() },
        Shape::IntervalsAndHeights { intervals: column(), heights: column() },
        Shape::Heights { heights: column(), numbered: true },
        Shape::Drops { release: Some(column()), rebound: None },
        Shape::Wide,
        Shape::Series { heights: column(), times: None },
    ];
    let mut notes: Vec<Note> =
        shapes.into_iter().map(|shape| Note::ReadAs { shape, side_by_side: 2, speeds: true }).collect();
    notes.extend([
        Note::Size { rows: 1, trials: 2 },
        Note::Recognised { program: Program::Tracker },
        Note::Encoded { encoding: "UTF-16LE".to_owned() },
        Note::Rate { rate: 240.0, line: Some(3) },
        Note::Rate { rate: 240.0, line: None },
        Note::Vertical { column: "z (m)".to_owned() },
        Note::Still { tracks: columns() },
        Note::Heard { sounds: 48, contacts: 10, from: 0.0, to: 6.46 },
        Note::Felt { column: column(), pulses: 12, contacts: 8 },
        Note::Flown { column: column(), flights: 6 },
        Note::Overdriven { part: 0.02 },
        Note::Sheets { sheets: columns(), drops: true },
        Note::SheetsAside { sheets: columns() },
        Note::Filtered { kept: 5, left_out: 2 },
        Note::Apart { column: column() },
        Note::Dropped { height_m: 1.5 },
        Note::Floor { reading: "812".to_owned(), down: true },
        Note::Aloft { contact_s: 0.0162 },
        Note::FallingTimes,
        Note::RisingTimes { column: column() },
        Note::Thousands { cell: "1.250".to_owned() },
        Note::Start { name: "partenza".to_owned() },
        Note::Losses { column: column() },
        Note::Repeats { columns: columns() },
        Note::Namesakes { column: column() },
        Note::Computed,
        Note::Share { column: column(), of_release: false },
        Note::Energy { column: column() },
        Note::SameUnit { column: column(), of: column() },
        Note::UnitBySize { column: column(), unit: "ms".to_owned() },
        Note::Pixels { column: column() },
        Note::AnyRate { column: column(), rate: 24.0 },
        Note::ByFlights { metres: 0.001 },
        Note::Misspelt { written: "hieght".to_owned(), heading: column(), meant: "height".to_owned() },
        Note::Restarts { times: 2 },
        Note::Downwards { shown: true },
        Note::ByTime { gravity: 9.81 },
    ]);
    let lines = |json: &str| serde_json::from_str::<Lines>(json).unwrap();
    let few = lines(r#"{ "first": [3, 4], "count": 2 }"#);
    let many = lines(r#"{ "first": [3, 4, 5, 6, 7], "count": 90 }"#);
    assert_eq!(
        (few.to_string(), many.to_string()),
        ("lines 3 and 4".to_owned(), "90 lines, the first of them 3".to_owned())
    );
    let named = |json: &str| serde_json::from_str::<Named>(json).unwrap();
    let (first, second) = (named(r#"{ "trial": 1, "name": "" }"#), named(r#"{ "trial": 2, "name": "Ann" }"#));
    let repairs = vec![
        Repair::SameFile { file: "b.csv".to_owned(), as_file: "a.csv".to_owned() },
        Repair::SameLine { line: 4 },
        Repair::SameSamples { samples: 1 },
        Repair::SameTrial { trial: second, as_trial: first },
        Repair::RoundedNumbers,
        Repair::NoPosition { lines: few },
    ];
    let spot = r#"{ "file": "b.xlsx", "line": 3, "column": 2, "sheet": "S", "cell": "B3" }"#;
    let warnings = vec![
        Warning::Size { height_m: 100.0, line: 2 },
        Warning::Zeros { lines: many },
        Warning::Gravity { found: 4.0, due: 9.81, pace: Pace::Frames { rate: 120.0 } },
        Warning::Gravity { found: 4.0, due: 9.81, pace: Pace::Clock { factor: 2.0, played: 30.0 } },
        Warning::UnitAgainstName { column: column(), unit: "mm".to_owned() },
        Warning::Stray {
            at: serde_json::from_str(spot).unwrap(),
            reading: "6.2".to_owned(),
            factor: 10.0,
            instead: 62.0,
        },
        Warning::MoreStrays { heights: 7 },
    ];
    assert_eq!((back(notes), back(repairs), back(warnings)), (47, 6, 7));
}
