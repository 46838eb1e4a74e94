//! What the rows of a table differ by, whatever its column is called: conditions in numbers and
//! words of any language. Where the COR differs by it, each has a COR of its own, or all together
//! are doubted; they are never one COR that is trusted.

use crate::typed::{fit, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{ReadOptions, Table, Verdict};

/// CORs that rise with the condition, by this from one to the next.
fn cors(first: f64, step: f64, count: usize) -> Vec<f64> {
    (0..count).map(|n| first + step * n as f64).collect()
}

/// A rebound from 150 cm, with the scatter of drop `n` of them.
fn rebound(e: f64, n: usize) -> String {
    const SCATTER: [f64; 7] = [0.4, -0.7, 0.1, 0.8, -0.5, 0.0, -0.2];
    format!("{:.1}", 150.0 * e * e + SCATTER[n % SCATTER.len()])
}

/// Names of columns of conditions, and the step from one condition to the next.
const NUMBERS: [(&str, f64); 10] = [
    ("Temperature (°C)", 15.0),
    ("T (°C)", 10.0),
    ("Temperature / °C", 15.0),
    ("Ball temp (°C)", 15.0),
    ("Temperatur [°C]", 12.0),
    ("PSI", 2.0),
    ("Pressure (psi)", 2.0),
    ("Air pressure (bar)", 0.1),
    ("Zorb (psi)", 2.0),
    ("Inflation", 20.0),
];

/// Names of columns of words, and the words.
const WORDS: [(&str, [&str; 3]); 5] = [
    ("Top", ["Basketbol topu", "Futbol topu", "Tenis topu"]),
    ("felt", ["dry", "damp", "wet"]),
    ("Zorb", ["quax", "wibble", "frob"]),
    ("Conditie", ["droog", "klam", "nat"]),
    ("Kunto", ["kuiva", "kostea", "marka"]),
];

/// The CORs of the groups, where each is trusted.
fn of_groups(report: &saltus_fit::Report) -> Vec<f64> {
    let groups = report.groups().iter().filter(|g| g.report.verdict() == Verdict::Trusted);
    groups.map(|g| g.report.cor().unwrap().value).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// Conditions in numbers with several drops of each, in rows or side by side, below a line that
    /// tells the height of release: a COR for each.
    #[test]
    fn each_condition_of_several_drops_has_a_cor(
        name in prop::sample::select(NUMBERS.to_vec()),
        first in 0.5..0.65_f64,
        count in 3_usize..6,
        side in any::<bool>(),
        form in 0_usize..3,
    ) {
        let (name, step) = name;
        let cors = cors(first, 0.05, count);
        let of = |n: usize| format!("{}", 5.0 + step * n as f64);
        let text = if side {
            let rows = cors.iter().enumerate().map(|(n, e)| {
                format!("{},{}\n", of(n), (0..3).map(|drop| rebound(*e, 3 * n + drop)).collect::<Vec<_>>().join(","))
            });
            // The counts of the drops stand in the line of the name, below it, or below errors.
            let head = match form {
                0 => format!("{name},Trial 1 (cm),Trial 2 (cm),Trial 3 (cm)\n"),
                1 => format!("{name},Rebound height / cm,,\n,1,2,3\n"),
                _ => format!("{name},Rebound height / cm,,\n±1,±0.5 cm,,\n,1,2,3\n"),
            };
            format!("Ball dropped from 150 cm\n{head}{}", rows.collect::<String>())
        } else {
            let rows = cors.iter().enumerate().flat_map(|(n, e)| {
                (0..3).map(move |drop| format!("{},150,{}\n", of(n), rebound(*e, 3 * n + drop)))
            });
            format!("{name},Drop (cm),Rebound (cm)\n{}", rows.collect::<String>())
        };
        let report = fit(&text);
        let found = of_groups(&report);
        prop_assert_eq!(found.len(), count, "{}\n{}", text, report);
        for (found, e) in found.iter().zip(&cors) {
            prop_assert!((found - e).abs() < 0.01, "{}\n{}", text, report);
        }
    }

    /// A condition that is another in each row, with one drop of each, by which the COR rises: no
    /// COR of all is trusted, however little it rises.
    #[test]
    fn a_condition_of_single_drops_that_the_cor_follows_is_doubted(
        name in prop::sample::select(NUMBERS.to_vec()),
        first in 0.5..0.65_f64,
        step in 0.01..0.05_f64,
        count in 5_usize..9,
        falls in any::<bool>(),
    ) {
        let (name, by) = name;
        let row = |(n, e): (usize, f64)| format!("{},150,{:.1}\n", 5.0 + by * n as f64, 150.0 * e * e);
        let mut cors = cors(first, step, count);
        if falls {
            cors.reverse();
        }
        let report = fit(&format!("{name},Drop (cm),Rebound (cm)\n{}", cors.into_iter().enumerate().map(row).collect::<String>()));
        prop_assert!(report.verdict() != Verdict::Trusted, "{}", report);
        prop_assert!(of_groups(&report).is_empty(), "{}", report);
    }

    /// Words below a name that is not understood: a COR for each word where it differs clearly, in
    /// rows or side by side, and one for all where it does not.
    #[test]
    fn words_that_the_cor_differs_by_tell_groups_apart(
        name in prop::sample::select(WORDS.to_vec()),
        first in 0.5..0.7_f64,
        step in prop::sample::select(vec![0.0, 0.05, -0.06]),
    ) {
        let (name, words) = name;
        let rows = words.iter().enumerate().map(|(n, word)| {
            let e = first + step * n as f64;
            format!("{word},150,{}\n", (0..4).map(|drop| rebound(e, 4 * n + drop)).collect::<Vec<_>>().join(","))
        });
        let head = format!("{name},Drop height (cm),Trial 1 (cm),Trial 2 (cm),Trial 3 (cm),Trial 4 (cm)\n");
        let text = format!("{head}{}", rows.collect::<String>());
        let Ok(table) = Table::parse("drops.csv", text.as_bytes(), &ReadOptions::default()) else {
            // What the column tells apart may be asked.
            return Ok(());
        };
        let report = saltus_fit::Fit::new().run(&table).unwrap();
        let found = of_groups(&report);
        if report.groups().is_empty() {
            prop_assert!(step == 0.0 || report.verdict() != Verdict::Trusted, "{}\n{}", text, report);
        } else {
            prop_assert_eq!(found.len(), words.len(), "{}\n{}", text, report);
            for (n, found) in found.iter().enumerate() {
                prop_assert!((found - first - step * n as f64).abs() < 0.01, "{}\n{}", text, report);
            }
        }
    }
}

/// A column of words that is not understood and by which the COR does not differ parts nothing.
#[test]
fn words_that_the_cor_does_not_differ_by_part_nothing() {
    let rows: String = (0..3)
        .map(|n| {
            let cells: Vec<String> = (0..4).map(|drop| rebound(0.7, drop)).collect();
            format!("{},150,{}\n", WORDS[0].1[n], cells.join(","))
        })
        .collect();
    let head = "Top,Drop height (cm),Trial 1 (cm),Trial 2 (cm),Trial 3 (cm),Trial 4 (cm)\n";
    let text = format!("{head}{rows}");
    assert!((trusted(&text) - 0.7).abs() < 0.01 && fit(&text).groups().is_empty());
}

/// The temperature of a room, which hardly changes from drop to drop, parts nothing, whatever its
/// unit looks like; a ball that was cooled and warmed is a condition.
#[test]
fn the_temperature_of_a_room_sets_nothing() {
    for (name, warmth, parts) in [
        ("temp_C", [21.0, 22.0], false),
        ("Temp (°C)", [22.5, 23.1], false),
        ("Raumtemperatur (°C)", [19.0, 21.5], false),
        ("temperature", [20.0, 22.0], false),
        ("temp_C", [5.0, 60.0], true),
        ("temperature (°C)", [20.0, 24.0], true),
    ] {
        let rows = (0..12).map(|n| format!("{n},{},150,{}\n", warmth[n % 2], rebound(0.7, n)));
        let text = format!("id,{name},drop_cm,rebound_cm\n{}", rows.collect::<String>());
        assert_eq!(fit(&text).groups().len(), if parts { 2 } else { 0 }, "{text}{}", fit(&text));
    }
}
