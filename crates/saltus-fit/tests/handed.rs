//! Tables as people hand them in, each with its right answer, with what has to be left aside, or
//! with the question that it raises.

use std::path::{Path, PathBuf};

use saltus_fit::{FindingKind, Fit, Part, ReadOptions, Report, Table, TableError, Verdict, Why};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/handed").join(name)
}

fn read(name: &str) -> Result<Table, TableError> {
    Table::read(&path(name), &ReadOptions::default())
}

fn fit(name: &str) -> Report {
    Fit::new().run(&read(name).unwrap_or_else(|error| panic!("{error}"))).unwrap()
}

/// The name of a file, its COR, how near, and the standard error where one is known.
const CORS: &[(&str, f64, f64, Option<f64>)] = &[
    ("01-eu-trials.csv", 0.746, 0.001, None),
    ("02-comments.csv", 0.802, 0.001, None),
    ("03-units-in-cells.csv", 0.802, 0.001, None),
    ("04-plusminus.csv", 0.802, 0.002, None),
    ("07-missing-first.csv", 0.803, 0.001, None),
    ("08-ten-reps.csv", 0.8009, 0.0001, Some(0.0020)),
    ("12-markdown.md", 0.802, 0.001, None),
    ("13-transposed.csv", 0.802, 0.001, None),
    ("17-tracker.txt", 0.780, 0.001, None),
    ("17c-tracker6.txt", 0.780, 0.001, None),
    ("19-pixels-apexes.csv", 0.791, 0.001, None),
    ("22-laps.csv", 0.80, 0.005, None),
    ("24-speeds.csv", 0.7995, 0.001, None),
    ("32-phyphox-screen.csv", 0.82, 0.001, None),
    ("40-total-time.csv", 0.7994, 0.0001, None),
    ("41-mean-std-rows.csv", 0.7987, 0.0001, Some(0.0029)),
    ("48b-xlsx-hidden.xlsx", 0.802, 0.001, None),
    ("53-height-lost.csv", 0.800, 0.001, None),
    ("55k-max-min.csv", 0.80, 0.002, None),
    ("61i-theory.csv", 0.741, 0.001, None),
    ("61p-mean-sd-cols.csv", 0.800, 0.001, None),
    ("phyphox-three.csv", 0.8215, 0.001, None),
];

#[test]
fn every_table_gives_its_cor() {
    for &(name, truth, near, error) in CORS {
        let report = fit(name);
        let cor = report.cor().unwrap_or_else(|| panic!("{report}"));
        assert!((cor.value - truth).abs() <= near, "{name}: {truth}\n{report}");
        if let Some(error) = error {
            let found = cor.standard_error.expect("an error");
            assert!((found / error - 1.0).abs() < 0.05, "{name}: {error}\n{report}");
        }
    }
}

#[test]
fn balls_and_surfaces_have_a_cor_each() {
    for (name, cors) in [
        ("15-two-sheets.xlsx", &[("Tennis", 0.746), ("Golf", 0.838)][..]),
        ("53d-surface-columns.csv", &[("Wood", 0.80), ("Carpet", 0.548), ("Concrete", 0.849)]),
    ] {
        let report = fit(name);
        assert!(report.cor().is_none() && report.groups().len() == cors.len(), "{report}");
        for (group, (label, cor)) in report.groups().iter().zip(cors) {
            let found = group.report.cor().unwrap_or_else(|| panic!("{report}")).value;
            assert!(group.name == *label && (found - cor).abs() < 0.001, "{report}");
        }
        assert_eq!(report.differences().len(), cors.len() * (cors.len() - 1) / 2);
    }
}

#[test]
fn what_is_not_used_is_named() {
    for (name, what, part, why) in [
        ("61i-theory.csv", "theoretical height (cm)", Part::Column, Why::Predicted),
        ("48b-xlsx-hidden.xlsx", "ratio", Part::Column, Why::Derived),
        ("48b-xlsx-hidden.xlsx", "old", Part::Sheet, Why::Hidden),
        ("48b-xlsx-hidden.xlsx", "Chart", Part::Sheet, Why::NoTable),
        ("08-ten-reps.csv", "Average 100 64.15", Part::Row, Why::Statistic),
        ("41-mean-std-rows.csv", "Std dev 0 1.04", Part::Row, Why::Statistic),
        ("17c-tracker6.txt", "vᵧ (m/s)", Part::Column, Why::Other),
        ("02-comments.csv", "Comment", Part::Column, Why::Note),
        ("phyphox-three.csv", "Bounce 4 (s)", Part::Cell, Why::NotHeard),
    ] {
        let report = fit(name);
        let found = report.left_aside().iter().find(|aside| aside.name == what);
        let found = found.unwrap_or_else(|| panic!("{name}: {what}\n{:#?}", report.left_aside()));
        assert_eq!((found.what, found.why), (part, why), "{name}: {what}");
        assert!(report.to_string().replace("\n    ", " ").contains(&format!("'{what}'")), "{report}");
        let json = serde_json::to_value(&report).unwrap();
        let listed = json["left_aside"].as_array().unwrap();
        assert!(listed.iter().any(|aside| aside["name"] == what), "{json}");
    }
}

#[test]
fn what_cannot_be_trusted_is_doubted() {
    let rest = fit("40-total-time.csv");
    assert!(rest.verdict() == Verdict::Doubtful && rest.reason().contains("until the ball rests"), "{rest}");
    let typo = fit("06-typo.csv");
    assert_eq!(typo.verdict(), Verdict::Doubtful);
    assert!(typo.warnings().iter().any(|w| w.contains("'6.2'") && w.contains("62 for it")), "{typo}");
}

#[test]
fn what_is_not_known_is_asked() {
    let lost = read("55-lost-bounce.csv").unwrap_err();
    assert!(lost.is_question() && lost.to_string().contains("'height lost (cm)' holds what was lost"), "{lost}");
    let unit = read("54d-nounit-sheet.xlsx").unwrap_err();
    assert!(unit.is_question() && unit.to_string().contains("sheet 'Monday', cell B1"), "{unit}");
    assert!(unit.to_string().contains("no unit"), "{unit}");
}

/// Trials that agree to a whole centimetre are repeats, and no copies of one another.
#[test]
fn equal_trials_are_repeats() {
    let report = fit("55o-repeat-trials.csv");
    assert!(read("55o-repeat-trials.csv").unwrap().trials().len() == 10, "{report}");
    assert!(report.repairs().iter().all(|repair| !repair.contains("counted once")), "{report}");
    let cor = report.cor().unwrap().value;
    assert!((cor - 0.808).abs() < 0.001 && report.repairs().is_empty(), "{report}");
}

/// A film and a table of heights are two experiments: neither vanishes in the other.
#[test]
fn a_film_beside_heights_is_another_experiment() {
    let files = [path("02-comments.csv"), path("17-tracker.txt")];
    let report = Fit::new().run(&Table::read_all(&files, &ReadOptions::default()).unwrap()).unwrap();
    let cors: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
    assert!((cors[0] - 0.802).abs() < 0.001 && (cors[1] - 0.780).abs() < 0.001, "{report}");
    assert!(report.cor().is_none());
}

/// Tables in `answers.tsv`, of every kind that teachers and students write: each has its COR, or a
/// COR for each group, or asks what it has to.
#[test]
fn tables_have_the_answers_that_were_planted() {
    let answers = std::fs::read_to_string(path("answers.tsv")).unwrap();
    let lines = answers.lines().filter(|line| !line.starts_with('#'));
    let mut read = 0;
    for line in lines {
        let cells: Vec<&str> = line.split('\t').collect();
        let (name, answer, more) = (cells[0], cells[1], cells.get(3).copied().unwrap_or_default());
        let words: Vec<&str> = more.split(' ').collect();
        let mut options = ReadOptions::default();
        for option in words.windows(2).chain([&words[words.len() - 1..]]) {
            options = match option {
                ["--fps", rate] => options.fps(rate.parse().unwrap()),
                ["--height-unit", unit] => options.height_unit(unit),
                ["--time-unit", unit] => options.time_unit(unit),
                ["--y-down", ..] => options.y_down(true),
                _ => options,
            };
        }
        let table = Table::read(&path(name), &options);
        if answer == "asks" {
            let error = table.unwrap_err().to_string();
            assert!(error.contains(more), "{name}: {error}");
            continue;
        }
        if answer == "nothing" {
            // Of something else than bounces: read or not, nothing in it is trusted.
            let trusted = |report: &Report| report.verdict() == Verdict::Trusted;
            let report = table.ok().map(|table| Fit::new().run(&table).unwrap());
            assert!(!report.is_some_and(|r| trusted(&r) || r.groups().iter().any(|g| trusted(&g.report))), "{name}");
            continue;
        }
        let report = Fit::new().run(&table.unwrap_or_else(|error| panic!("{name}: {error}"))).unwrap();
        if answer == "doubts" {
            let doubted = report.verdict() == Verdict::Doubtful && report.reason().contains(more);
            assert!(doubted, "{name}: {report}");
            continue;
        }
        if answer == "refused" {
            assert!(report.verdict() == Verdict::Refused && report.cor().is_none(), "{name}: {report}");
            continue;
        }
        let near: f64 = cells[2].parse().unwrap();
        let is = |found: &Report, truth: &str| {
            let value = found.cor().unwrap_or_else(|| panic!("{name}: {report}")).value;
            assert!((value - truth.parse::<f64>().unwrap()).abs() <= near, "{name}: {truth}\n{report}");
        };
        if answer.contains('=') {
            let groups: Vec<(&str, &str)> = answer.split(';').map(|group| group.split_once('=').unwrap()).collect();
            assert_eq!(report.groups().len(), groups.len(), "{name}: {report}");
            for (found, (label, truth)) in report.groups().iter().zip(groups) {
                assert!(found.name.to_lowercase().contains(label), "{name}: {report}");
                is(&found.report, truth);
            }
        } else {
            is(&report, answer);
            assert!(report.verdict() == Verdict::Trusted || words.contains(&"doubt"), "{name}: {report}");
        }
        read += 1;
    }
    assert!(read > 230, "{read}");
}

/// What is left aside and matters is a doubt that names it: a column by which the COR differs,
/// whatever its name; one that only stands there is none.
#[test]
fn a_column_by_which_the_cor_differs_is_not_passed_over() {
    let verdict = |name: &str, cells: [&str; 2]| {
        let row = |(n, (drop, rebound)): (usize, (f64, f64))| {
            let of = usize::from(n % 2 == 0);
            let high = rebound * (1.0 + 0.3 * of as f64);
            format!("{},{drop},{high:.1}\n", if cells[0] == cells[1] { cells[n / 3] } else { cells[of] })
        };
        let drops = [(100.0, 50.0), (100.0, 50.5), (80.0, 40.0), (80.0, 40.3), (60.0, 30.0), (60.0, 29.8)];
        let rows: String = drops.into_iter().enumerate().map(row).collect();
        let text = format!("{name},Drop (cm),Rebound (cm)\n{rows}");
        let table = Table::parse("t.csv", text.as_bytes(), &ReadOptions::default()).unwrap();
        let report = Fit::new().run(&table).unwrap();
        report.findings().iter().any(|f| matches!(&f.kind, FindingKind::AsideDiffers { column, .. } if column == name))
    };
    for (name, cells) in [("Voltage (V)", ["6", "12"]), ("Zorb (V)", ["6", "12"]), ("Mass (g)", ["50", "70"])] {
        assert!(verdict(name, cells), "{name}");
        assert!(!verdict(name, ["6", "6"]), "{name}");
    }
}

/// A COR that the writer worked out checks how the readings beside it were taken; its square is
/// that of one who forgot the root.
#[test]
fn a_cor_in_the_table_checks_the_readings() {
    let verdict = |cors: [&str; 3]| {
        let rows = [("100", "64"), ("80", "51"), ("60", "38")].into_iter().zip(cors);
        let rows: String = rows.map(|((drop, rebound), cor)| format!("{drop},{rebound},{cor}\n")).collect();
        let text = format!("Drop (cm),Rebound (cm),Coefficient of restitution\n{rows}");
        let report = Fit::new().run(&Table::parse("t.csv", text.as_bytes(), &ReadOptions::default()).unwrap()).unwrap();
        (report.verdict(), report.findings().iter().any(|f| matches!(f.kind, FindingKind::StatedDiffers { .. })))
    };
    for right in [["0.80", "0.80", "0.79"], ["0.64", "0.64", "0.63"], ["80%", "80%", "79%"], ["", "0.8", "#N/A"]] {
        assert_eq!(verdict(right), (Verdict::Trusted, false), "{right:?}");
    }
    for other in [["0.55", "0.55", "0.56"], ["0.90", "0.91", "0.90"]] {
        assert_eq!(verdict(other), (Verdict::Doubtful, true), "{other:?}");
    }
}
