//! Heights that a formula filled in are no readings, whether the numbers or a remark tell.

use crate::noise::Noise;
use crate::typed::{fit, trusted};
use proptest::prelude::*;
use saltus_fit::{Change, Doubt, FindingKind, ReadOptions, Report, Table, Verdict};

fn doubts(report: &Report) -> Vec<Doubt> {
    let doubt = |kind: &FindingKind| match kind {
        FindingKind::ReadDoubt { doubt, .. } => Some(doubt.clone()),
        _ => None,
    };
    report.findings().iter().filter_map(|finding| doubt(&finding.kind)).collect()
}

fn unread(report: &Report) -> bool {
    doubts(report).iter().any(|doubt| matches!(doubt, Doubt::Remark { change: Change::Unread, .. }))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// A factor that heights keep to all digits is none of a ball, bounce after bounce or drop by
    /// drop; to the digits of a rule a good ball keeps it too, and to more it does not.
    #[test]
    fn heights_by_a_formula_are_doubted(e in 0.65f64..0.9, seed: u64, chain: bool, digits in 5usize..7) {
        let mut noise = Noise(seed);
        let mut table = |digits: usize, sigma: f64| {
            let mut high = |n: i32, drop: f64| drop * e.powi(2 * n) * (1.0 + noise.normal(sigma));
            if chain {
                let rows = (0..8).map(|n| format!("{n},{:.digits$}\n", high(n, 1.5)));
                format!("bounce,height (m)\n{}", rows.collect::<String>())
            } else {
                let rows = (5..14).map(|n| format!("{:.1},{:.digits$}\n", 0.2 * f64::from(n), high(1, 0.2 * f64::from(n))));
                format!("drop height (m),rebound height (m)\n{}", rows.collect::<String>())
            }
        };
        let computed = |report: &Report| doubts(report).iter().any(|doubt| matches!(doubt, Doubt::Computed { .. }));
        let filled = fit(&table(digits + 1, 0.0));
        prop_assert!(computed(&filled) && filled.verdict() != Verdict::Trusted, "{}", filled);
        prop_assert!(!computed(&fit(&table(2, 0.0))), "{}", table(2, 0.0));
        prop_assert!(!computed(&fit(&table(digits, 0.005))), "{}", table(digits, 0.005));
    }

    /// Whoever filled a column in says so in many words, or states the formula.
    #[test]
    fn remarks_of_a_formula_are_doubts(e in 0.55f64..0.85) {
        let table = |said: &str| {
            let rows: String = (0..5).map(|n| format!("{n};{:.1}\n", 130.0 * e.powi(2 * n) * (1.0 + 0.003 * f64::from(n % 3)))).collect();
            format!("Ball dropped on the floor\nbounce;height (cm)\n{rows}\n{said}\n")
        };
        for said in [
            "C5 = C4*0.7 and so on",
            "the cells below are =0,6*B2, i.e. B3=0,6*B2",
            "only the first one was read, the rest is filled down",
            "autofilled by the sheet",
            "nur der erste Wert ist echt, der Rest nach unten gezogen",
            "les autres valeurs : formule étirée",
            "el resto con la fórmula arrastrada",
            "gli altri con la formula trascinata in basso",
            "o resto com a fórmula arrastada",
            "de rest is doorgetrokken",
            "resten är ifyllda med formel",
            "loput vedetty alas",
            "reszta przeciągnięta w dół",
            "zbytek vyplněn vzorcem dolů, vzorcem dolu",
            "a többi képlettel kitöltve",
            "restul cu formula trasă în jos",
            "gerisi formülle dolduruldu",
            "остальное протянули формулой вниз",
            "решта заповнена формулою",
            "其余用公式填充",
            "残りはオートフィルです",
            "나머지는 자동 채우기로 넣음",
            "các ô còn lại kéo công thức",
        ] {
            let report = fit(&table(said));
            prop_assert!(unread(&report) && report.verdict() != Verdict::Trusted, "{}{}", table(said), report);
        }
        for said in ["Pasted, copied from Excel", "Werte kopiert aus LibreOffice", "COR = sqrt(h1/h0) in column C", "A3 = A2 + 1 numbers the rows"] {
            prop_assert!((trusted(&table(said)) - e).abs() < 0.02, "{}", table(said));
        }
        let plain = table("");
        let named = Table::parse("Rebounds_copied_from_Excel_today.csv", plain.as_bytes(), &ReadOptions::default()).unwrap();
        prop_assert!(!unread(&saltus_fit::Fit::new().run(&named).unwrap()));
    }
}
