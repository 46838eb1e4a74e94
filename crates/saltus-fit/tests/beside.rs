//! What stands beside readings, or in place of one, and is none: codes and what they stand for,
//! names that are written again and again, names that commas part, words in a clock's place.

use crate::typed::{fit, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::Verdict;

/// Scatter of the reading `n`, a part of it.
fn off(n: usize) -> f64 {
    [0.004, -0.006, 0.001, 0.007, -0.005, 0.0, -0.002][n % 7]
}

/// The rebound from 200 cm, or what it is as a part of it.
fn rebound(e: f64, n: usize) -> f64 {
    200.0 * e * e * (1.0 + off(n))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(32), failure_persistence: None, ..ProptestConfig::default() })]

    /// A list of what codes stand for is no column of the rows that it happens to stand in.
    #[test]
    fn keys_beside_a_table_are_none_of_its_rows(e in 0.5f64..0.7, apart in 0.05f64..0.1, blanks in 1usize..3) {
        let gap = ",".repeat(blanks);
        let key = [",A,Acme,6.99", ",B,Borax,4.49", ",C,Corvo,9.25"];
        let row = |n: usize| {
            // The keys stand in the first rows, whatever these are of.
            let ball = [1, 0, 2][n % 3];
            let e = e + apart * ball as f64;
            let key = key.get(n).copied().unwrap_or(",,,");
            format!("{},{},{:.1}{gap}{key}\n", n + 1, ["A", "B", "C"][ball], rebound(e, n))
        };
        let rows: String = (0..15).map(row).collect();
        let table = format!("Ball dropped from 200 cm on a floor\nDrop,Code,Rebound (cm){gap},Code,Ball,Price\n{rows}");
        let report = fit(&table);
        let cors: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
        prop_assert_eq!(cors.len(), 3, "{}{}", table, report);
        for planted in [e, e + apart, e + 2.0 * apart] {
            prop_assert!(cors.iter().any(|cor| (cor - planted).abs() < 0.01), "{} {}{}", planted, table, report);
        }
    }

    /// The same name again beside heights of release is counted: rebounds that are level are
    /// repeats, those that fall are of one bounce after the other.
    #[test]
    fn names_written_again_are_counted(e in 0.5f64..0.9, count in 2usize..5, name in 0usize..4, falls: bool) {
        let name = ["first bounce (cm)", "rebound (cm)", "bounce height / cm", "Rücksprunghöhe (cm)"][name];
        let falls = falls && name != "first bounce (cm)";
        let drops = [100.0, 150.0, 200.0, 250.0];
        let row = |(k, drop): (usize, f64)| {
            let power = |n: usize| if falls { n as i32 + 1 } else { 1 };
            let high = |n: usize| format!("{:.1}", drop * (e * e).powi(power(n)) * (1.0 + off(k + n)));
            format!("{drop},{}\n", (0..count).map(high).collect::<Vec<_>>().join(","))
        };
        let rows: String = drops.into_iter().enumerate().map(row).collect();
        let table = format!("release (cm),{}\n{rows}", vec![name; count].join(","));
        let cor = fit(&table).cor().map(|cor| cor.value);
        prop_assert!(cor.is_some_and(|cor| (cor - e).abs() < 0.01), "{}{}", table, fit(&table));
    }

    /// A name that several columns share may be written in each of them.
    #[test]
    fn a_name_written_in_each_column_that_it_spans_is_one(e in 0.5f64..0.85, language in 0usize..3) {
        let [drop, rebound, mean] = [
            ["Drop height", "Rebound", "mean"],
            ["Fallhöhe", "Rücksprung", "Mittel"],
            ["Hauteur de chute", "Rebond", "moyenne"],
        ][language];
        let row = |n: usize| {
            let drop = 80.0 + 40.0 * n as f64;
            let at = drop * e * e * (1.0 + off(n));
            format!("{drop},{:.1},{:.1},{at:.1}\n", at - 2.0, at + 2.0)
        };
        let header = format!("{drop},{rebound},{rebound},{rebound}\n(cm),min (cm),max (cm),{mean} (cm)\n");
        let cor = trusted(&format!("{header}{}", (0..5).map(row).collect::<String>()));
        prop_assert!((cor - e).abs() < 0.01, "{header}");
    }

    /// A comma within a name that no quotes hold together parts no column.
    #[test]
    fn commas_within_names_part_no_columns(e in 0.5f64..0.85, form in 0usize..3) {
        let header = [
            "Trial,Drop height, cm,Rebound height, cm,Air (wet, dry)",
            "Trial,Drop height (cm, bottom),Rebound height (cm, bottom),Note",
            "Trial,Drop, cm,Rebound, cm,Remark",
        ][form];
        let row = |n: usize| format!("{},200,{:.1},\n", n + 1, rebound(e, n));
        let table = format!("{header}\n{}", (0..6).map(row).collect::<String>());
        prop_assert!((trusted(&table) - e).abs() < 0.01, "{table}");
    }

    /// Words in the place of a time on a clock say why there is none.
    #[test]
    fn words_in_place_of_a_time_are_left_aside(e in 0.6f64..0.85, said in 0usize..3) {
        let said = ["stopped watching", "missed", "not seen"][said];
        let mut time = 0.5;
        let mut table = "bounce,time\n".to_owned();
        for n in 1..7 {
            table += &format!("{n},0:{time:06.3}\n");
            time += 0.9 * e.powi(n);
        }
        table += &format!("7,{said}\n");
        let report = fit(&table);
        let cor = report.cor().map(|cor| cor.value);
        prop_assert!(cor.is_some_and(|cor| (cor - e).abs() < 0.01), "{}{}", table, report);
    }

    /// Speeds whose unit a line states, down and up as before and after.
    #[test]
    fn speeds_of_a_stated_unit_are_read(e in 0.4f64..0.8, names in 0usize..4, title in 0usize..3) {
        let [before, after] = [["Down", "Up"], ["before", "after"], ["vorher", "nachher"], ["in", "out"]][names];
        let title = [
            "Ball dropped on turf; vertical speed at the floor, in mph, from a film",
            "Ball bounce: speeds in mph (radar before / after the impact)",
            "Ball auf Boden: Geschwindigkeiten in km/h",
        ][title];
        let row = |n: usize| {
            let v = 21.0 + 0.3 * n as f64;
            format!("{},{v:.1},{:.2}\n", n + 1, v * e * (1.0 + off(n)))
        };
        let table = format!("\"{title}\"\nShot,{before},{after}\n{}", (0..6).map(row).collect::<String>());
        let report = fit(&table);
        let cor = report.cor().map(|cor| cor.value);
        prop_assert!(cor.is_some_and(|cor| (cor - e).abs() < 0.01), "{}{}", table, report);
    }

    /// An error of a mean by its letters is no COR of the table, and no reading.
    #[test]
    fn errors_of_means_by_their_letters_are_errors(e in 0.5f64..0.85, form in 0usize..4) {
        let [sd, se] = [["s.d.", "s.e."], ["S.D.", "S.E."], ["s.d.", "s.e.m."], ["sd", "s.e. of mean"]][form];
        let row = |n: usize| {
            let drop = 80.0 + 30.0 * n as f64;
            format!("{drop},10,{:.1},1.2,0.38\n", drop * e * e * (1.0 + off(n)))
        };
        let table = format!("Drop height (cm),n,Rebound mean (cm),{sd} (cm),{se} (cm)\n{}", (0..6).map(row).collect::<String>());
        prop_assert!((trusted(&table) - e).abs() < 0.01, "{table}");
    }
}

/// A remark in a record is not what its trial is called.
#[test]
fn comments_of_records_name_no_trials() {
    let run = |n: usize, said: &str| {
        let flights: Vec<String> =
            (0..4).map(|k| format!("{:.4}", 0.8 * 0.8f64.powi(k) * (1.0 + 0.2 * off(n)))).collect();
        format!("{{\"run\": {n}, \"intervals_s\": [{}], \"comment\": \"{said}\"}}", flights.join(", "))
    };
    let text = format!(
        "{{\"ball\": \"golf ball\", \"runs\": [{}, {}, {}]}}",
        run(1, "first try, works"),
        run(2, ""),
        run(3, "")
    );
    let report = fit(&text);
    assert!(report.groups().is_empty() && report.verdict() == Verdict::Trusted, "{report}");
}

/// Values of a book, and examples, are none of a table's own, in whatever language.
#[test]
fn examples_above_readings_are_left_aside() {
    let rows = |e: f64, scatter: f64| -> String {
        (0..6)
            .map(|n| {
                format!("{},{:.1}\n", 60 + 20 * n, f64::from(60 + 20 * n) * e * e * (1.0 + scatter * off(n as usize)))
            })
            .collect()
    };
    for name in [
        "Beispiel aus dem Buch",
        "Example",
        "Exemple du livre",
        "Ejemplo",
        "Esempio dal libro",
        "Voorbeeld",
        "Przykład",
        "Příklad",
        "Eksempel",
        "Пример",
    ] {
        let header = "Drop height (cm),Rebound height (cm)";
        let table = format!("{name}\n{header}\n{}\nOur drops\n{header}\n{}", rows(0.7, 0.0), rows(0.8, 1.0));
        let report = fit(&table);
        let cor = report.cor().map(|cor| cor.value);
        assert!(report.groups().is_empty() && cor.is_some_and(|cor| (cor - 0.8).abs() < 0.01), "{table}{report}");
    }
}
