//! Ratios of heights are readings where they are all there is.

use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Table, TableError};

/// Of each row to its own drop, or to the height before.
const OF_DROPS: [&str; 8] = [
    "h1/h0",
    "h/H",
    "height ratio",
    "bounce height / drop height",
    "% of previous height",
    "percent of previous height",
    "Verhältnis der Höhen",
    "h_n+1/h_n",
];

fn read(text: &str) -> Result<Table, TableError> {
    Table::parse("table.csv", text.as_bytes(), &ReadOptions::default())
}

fn cor(text: &str) -> f64 {
    let table = read(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let report = Fit::new().run(&table).unwrap();
    report.cor().unwrap_or_else(|| panic!("{report}\n{text}")).value
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(200)))]

    /// Alone, counted or beside the heights of release, as parts or in hundredths.
    #[test]
    fn ratios_of_drops(heading in 0..OF_DROPS.len(), e in 0.4..0.92_f64, rows in 3..7_usize, beside in 0..3_usize, noise in prop::collection::vec(-1.0..1.0_f64, 7)) {
        let heading = OF_DROPS[heading];
        let whole = if heading.contains('%') || heading.contains("percent") { 100.0 } else { 1.0 };
        let mut text = [String::new(), "trial,".to_owned(), "drop height (cm),".to_owned()][beside].clone() + heading + "\n";
        for (row, noise) in noise.iter().enumerate().take(rows) {
            let ratio = whole * e * e * (1.0 + 0.005 * noise);
            text += &match beside {
                0 => format!("{ratio:.4}\n"),
                1 => format!("{},{ratio:.4}\n", row + 1),
                _ => format!("{},{ratio:.4}\n", 150 - 10 * row),
            };
        }
        prop_assert!((cor(&text) - e).abs() < 4e-3, "{}", text);
    }

    /// Of bounces to the height of release, with the release and without.
    #[test]
    fn ratios_of_one_drop(e in 0.5..0.9_f64, first in 0..2_i32, percent in any::<bool>(), bounces in 3..6_i32) {
        let (heading, whole) = if percent { ("h/h0 (%)", 100.0) } else { ("h/h0", 1.0) };
        let rows = (first..first + bounces).map(|n| format!("{n},{:.4}\n", whole * e.powi(2 * n)));
        let text = format!("bounce,{heading}\n{}", rows.collect::<String>());
        if percent && first == 1 {
            prop_assert!(read(&text).is_err() || (cor(&text) - e).abs() < 4e-3);
        } else {
            prop_assert!((cor(&text) - e).abs() < 4e-3, "{}", text);
        }
    }

    /// `H` is the height of release beside `h`, where it is above it; else that is a question.
    #[test]
    fn a_capital_is_the_release(e in 0.4..0.92_f64, swapped in any::<bool>()) {
        let (heading, names) = if swapped { ("h (cm),H (cm)\n", [0, 1]) } else { ("H (cm),h (cm)\n", [1, 0]) };
        let row = |k: i32| {
            let high = 150.0 - 10.0 * f64::from(k);
            let cells = [high * e * e, high];
            format!("{:.1},{:.1}\n", cells[names[0]], cells[names[1]])
        };
        let text = format!("{heading}{}", (0..5).map(row).collect::<String>());
        prop_assert!((cor(&text) - e).abs() < 4e-3, "{}", text);
        prop_assert!(read(&text.replace('h', "x").replace('H', "h").replace('x', "H")).is_err());
    }

    /// Hundredths may be written in the cells.
    #[test]
    fn hundredths_in_cells(e in 0.5..0.9_f64, drops in any::<bool>()) {
        let row = |h: f64| if drops { format!("{h},{:.2}%\n", 100.0 * e * e) } else { format!("{:.2}%\n", 100.0 * e * e) };
        let rows = [150.0, 120.0, 100.0].map(row).concat();
        let text = if drops { format!("Drop height (cm),Rebound\n{rows}") } else { format!("Rebound height\n{rows}") };
        prop_assert!((cor(&text) - e).abs() < 4e-3, "{}", text);
    }

    /// Of bounces that nothing counts, as they fall.
    #[test]
    fn ratios_that_are_listed(e in 0.5..0.9_f64, first in 0..2_i32) {
        let rows = (first..first + 5).map(|n| format!("{:.4}\n", e.powi(2 * n)));
        let text = format!("h/h0\n{}", rows.collect::<String>());
        prop_assert!((cor(&text) - e).abs() < 4e-3, "{}", text);
    }

    /// Beside heights they are left aside; above one they are none.
    #[test]
    fn ratios_beside_heights(e in 0.5..0.9_f64) {
        let mut text = "bounce,height (cm),h/h_previous\n0,150,\n".to_owned();
        (1..6).for_each(|n| text += &format!("{n},{:.2},0.11\n", 150.0 * e.powi(2 * n)));
        prop_assert!((cor(&text) - e).abs() < 4e-3, "{}", text);
        let text = format!("drop height (cm),H/h\n100,{:.4}\n90,{:.4}\n", 1.0 / (e * e), 1.0 / (e * e));
        prop_assert!(read(&text).is_err());
    }
}
