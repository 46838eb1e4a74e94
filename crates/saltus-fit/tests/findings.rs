//! Findings are data: every kind has words and a line in the documentation, and a report that was
//! written is read back as it was.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

mod film;
mod noise;

use std::fs;
use std::path::Path;

use film::{Ball, Contact, csv, noisy, report};
use noise::Noise;
use proptest::prelude::*;
use saltus_fit::{Fit, Loss, ReadOptions, Report, Severity, Table, Verdict};

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
