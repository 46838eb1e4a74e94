//! Of several columns that are called heights the one that was measured is read, or it is asked
//! which one that is: never is another one trusted.

use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

/// What may be called a height and is none that the ball reached, or is that of another reading.
const OTHERS: [&str; 73] = [
    "target height",
    "ideal height",
    "expected height",
    "theoretical rebound",
    "theory height",
    "model height",
    "height (model)",
    "ceiling height",
    "table height",
    "height of table",
    "eye height",
    "height by eye",
    "camera height",
    "height of camera",
    "light height",
    "lamp height",
    "sensor height",
    "shelf height",
    "observer height",
    "partner height",
    "person height",
    "tripod height",
    "phone height",
    "ruler height",
    "wall height",
    "door height",
    "box height",
    "old height",
    "partner A",
    "light",
    "reference height",
    "standard height",
    "required height",
    "limit height",
    "guess height",
    "height from app",
    "height from video",
    "formula height",
    "height without air",
    "Sollhöhe",
    "Idealhöhe",
    "Modellhöhe",
    "erwartete Höhe",
    "Tischhöhe",
    "Augenhöhe",
    "Kamerahöhe",
    "Deckenhöhe",
    "Lampenhöhe",
    "hauteur idéale",
    "hauteur théorique",
    "hauteur attendue",
    "hauteur de la table",
    "hauteur du plafond",
    "hauteur caméra",
    "altura ideal",
    "altura esperada",
    "altura objetivo",
    "altura de la mesa",
    "altura del techo",
    "altezza ideale",
    "altezza attesa",
    "altezza tavolo",
    "streefhoogte",
    "verwachte hoogte",
    "tafelhoogte",
    "ooghoogte",
    "förväntad höjd",
    "oczekiwana wysokość",
    "ideální výška",
    "beklenen yükseklik",
    "ожидаемая высота",
    "理论高度",
    "目標高さ",
];

/// What the heights that were measured are called.
const MEASURED: [&str; 8] =
    ["height", "measured height", "rebound height", "actual height", "h", "max height", "mean height", "zorb height"];

fn fit(text: &str) -> Option<Report> {
    Table::parse("t.csv", text.as_bytes(), &ReadOptions::default()).ok().map(|table| Fit::new().run(&table).unwrap())
}

/// Whether a trusted COR is another than `e`.
fn wrong(report: &Report, e: f64, near: f64) -> bool {
    let of = |r: &Report| r.verdict() == Verdict::Trusted && r.cor().is_none_or(|cor| (cor.value - e).abs() > near);
    of(report) || report.groups().iter().any(|group| of(&group.report))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(1500), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn of_two_heights_the_wrong_one_is_not_trusted(
        other in 0..OTHERS.len(),
        measured in 0..MEASURED.len(),
        shape in 0..3_usize,
        first in any::<bool>(),
        drops in any::<bool>(),
        e in 0.55..0.74_f64,
    ) {
        let (other, measured) = (OTHERS[other], MEASURED[measured]);
        let named = |name: &str| if name.contains('(') { name.replace(')', " cm)") } else { format!("{name} (cm)") };
        let mut names = [named(other), named(measured)];
        if first {
            names.reverse();
        }
        let mut text = format!("{},{}\n", if drops { "drop height (cm)" } else { "bounce" }, names.join(","));
        for row in 0..5 {
            let n = row as f64;
            let drop = 100.0 + 20.0 * n;
            // What is expected, or does not move, or is above.
            let own = if drops { drop * e * e } else { 100.0 * e.powf(2.0 * n) };
            let ideal = if drops { 0.64 * drop } else { 100.0 * 0.8_f64.powf(2.0 * n) };
            let turned = [ideal, 75.0, 1.2 * own][shape];
            let mut cells = [format!("{turned:.1}"), format!("{own:.1}")];
            if first {
                cells.reverse();
            }
            text += &format!("{},{}\n", if drops { format!("{drop}") } else { row.to_string() }, cells.join(","));
        }
        // Heights that are all a fifth larger have the same COR.
        let Some(report) = fit(&text) else { return Ok(()) };
        prop_assert!(!wrong(&report, e, 0.008), "{}\n{}", text, report);
    }
}
