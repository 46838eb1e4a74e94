//! What numbers of a table say against one another, and against what is said of them, is doubted:
//! speeds that no fall gives, balls with the same digits, means over balls that differ, numbers of
//! two units under one name.

use crate::typed::{fit, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Doubt, FindingKind, Report, Verdict};

fn doubts(report: &Report) -> Vec<&Doubt> {
    let of_groups = report.groups().iter().flat_map(|group| group.report.findings());
    report
        .findings()
        .iter()
        .chain(of_groups)
        .filter_map(|finding| match &finding.kind {
            FindingKind::ReadDoubt { doubt } => Some(doubt),
            _ => None,
        })
        .collect()
}

/// Whether a remark is doubted, and what it says cannot be trusted.
fn remarked(report: &Report) -> bool {
    let is = |doubt: &&Doubt| matches!(doubt, Doubt::Remark { .. });
    report.verdict() != Verdict::Trusted && doubts(report).iter().any(is)
}

/// Scatter of the drop `n`, a part of its height.
fn off(n: usize) -> f64 {
    [0.004, -0.007, 0.001, 0.008, -0.005, 0.0, -0.002][n % 7]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// Speeds before a bounce are those of the fall beside them, or stated above; numbers of
    /// another unit under their name are not.
    #[test]
    fn speeds_that_no_fall_gives_are_doubted(e in 0.45f64..0.85, unit in 0usize..4, titled: bool, loses in 0.9f64..1.0) {
        let (name, per) = [("m/s", 1.0), ("km/h", 3.6), ("ft/s", 3.2808), ("cm/s", 100.0)][unit];
        let table = |slip: f64| {
            let row = |n: usize| {
                let h = if titled { 1.6 } else { 0.7 + 0.2 * n as f64 };
                let v = loses * (2.0 * 9.81 * h).sqrt() * (1.0 + off(n));
                let speeds = format!("{:.3},{:.3}\n", v * per * slip, v * e * (1.0 + off(n + 3)) * per);
                if titled { speeds } else { format!("{h:.2},{speeds}") }
            };
            let (above, drop) = if titled { ("Ball dropped from 1.6 m\n", "") } else { ("", "drop height (m),") };
            let header = format!("{drop}speed before impact ({name}),speed after impact ({name})");
            format!("{above}{header}\n{}", (0..6).map(row).collect::<String>())
        };
        prop_assert!((trusted(&table(1.0)) - e).abs() < 0.02, "{}", table(1.0));
        for slip in [3.6, 2.237, 0.3048] {
            let report = fit(&table(slip));
            let is = doubts(&report).iter().any(|doubt| matches!(doubt, Doubt::Fall { .. }));
            prop_assert!(is && report.verdict() != Verdict::Trusted, "{}{}", table(slip), report);
        }
    }

    /// No two balls, floors or heights of release give the same digits everywhere; the same few
    /// digits they may.
    #[test]
    fn balls_with_the_same_digits_are_doubted(e in 0.6f64..0.85, of in 0usize..3, wide: bool) {
        let (name, kinds) = [
            ("ball", ["golf", "marble", "squash"]),
            ("surface", ["tiles", "carpet", "grass"]),
            ("Untergrund", ["Beton", "Parkett", "Rasen"]),
        ][of];
        let table = |apart: f64, digits: usize| {
            let row = |ball: usize, n: usize| {
                let high = |k: i32| {
                    let e = e - apart * ball as f64;
                    format!("{:.digits$}", 130.0 * e.powi(2 * k) * (1.0 + off(n + k as usize)))
                };
                match wide {
                    true => format!("{},130,{},{},{}\n", kinds[ball], high(1), high(2), high(3)),
                    false => format!("{},130,{}\n", kinds[ball], high(1)),
                }
            };
            let header = if wide { "h0 (cm),h1 (cm),h2 (cm),h3 (cm)" } else { "drop (cm),rebound (cm)" };
            let rows = (0..3).flat_map(|ball| (0..5).map(move |n| (ball, n)));
            format!("{name},{header}\n{}", rows.map(|(ball, n)| row(ball, n)).collect::<String>())
        };
        let copied = |report: &Report| doubts(report).iter().any(|doubt| matches!(doubt, Doubt::Copied { .. }));
        let report = fit(&table(0.0, 2));
        prop_assert!(copied(&report) && report.verdict() != Verdict::Trusted, "{}{}", table(0.0, 2), report);
        prop_assert!(!copied(&fit(&table(0.05, 2))) && !copied(&fit(&table(0.0, 0).replace(",130,", ",130.0,"))) || wide);
    }

    /// A mean over balls that differ is the COR of none of them; a mean of drops of one ball is.
    #[test]
    fn means_over_balls_that_differ_are_doubted(e in 0.5f64..0.85, below: bool) {
        let row = |n: usize| format!("{},{:.1}\n", 60 + 30 * n, (60.0 + 30.0 * n as f64) * e * e * (1.0 + off(n)));
        let table = |said: &str| {
            let rows: String = (0..5).map(row).collect();
            let table = format!("drop height (cm),rebound height (cm)\n{rows}");
            let said = said.replace(',', ";");
            if below { format!("{table}\n{said}\n") } else { format!("{said}\n\n{table}") }
        };
        for said in [
            "Rebounds are averages over all our balls.",
            "the mean of five different balls",
            "mean of a tennis ball, a golf ball and a basketball",
            "Mittelwerte über alle Bälle",
            "Mittelwert aus verschiedenen Bällen",
            "moyenne de toutes les balles",
            "promedio de todas las pelotas",
            "media di tutte le palline",
            "média de todas as bolas",
            "gemiddelde van alle ballen",
            "medelvärde av alla bollar",
            "gennemsnit af alle bolde",
            "średnia ze wszystkich piłek",
            "průměr všech míčků",
            "tüm toplar için ortalama",
            "среднее по всем мячам",
        ] {
            let report = fit(&table(said));
            prop_assert!(remarked(&report), "{}{}", table(said), report);
        }
        for said in ["mean of 3 drops each", "Average of all drops of the ball", "Mittelwert aus drei Versuchen"] {
            prop_assert!((trusted(&table(said)) - e).abs() < 0.02, "{}", table(said));
        }
    }

    /// Who is not sure of the unit says so in many ways; and a remark that names another unit than
    /// the headings is of those whose rebounds are off by what the two differ by.
    #[test]
    fn units_that_may_be_mixed_are_doubted(e in 0.7f64..0.85, person in 0usize..3) {
        let table = |slip: f64, said: &str| {
            let row = |n: usize| {
                let by = ["Ida", "Ole", "Kai"][n % 3];
                let slip = if n % 3 == person { slip } else { 1.0 };
                format!("{by},180,{:.1}\n", 180.0 * e * e * (1.0 + off(n)) / slip)
            };
            format!("Read by,Drop height (cm),Rebound (cm)\n{}\n{said}\n", (0..12).map(row).collect::<String>())
        };
        for said in [
            "Ida may have read the wrong scale.",
            "Units may be mixed.",
            "Perhaps one of us used inches.",
            "Einheiten verwechselt?",
            "vielleicht Zoll statt cm",
            "unités mélangées",
            "peut-être en pouces",
            "unidades mezcladas",
            "unità mescolate",
            "unidades misturadas",
            "eenheden door elkaar",
            "blandade enheter",
            "blandede enheder",
            "yksiköt sekaisin",
            "pomieszane jednostki",
            "popletené jednotky",
            "birimler karıştı",
            "единицы перепутаны",
        ] {
            let report = fit(&table(2.54, said));
            prop_assert!(report.verdict() != Verdict::Trusted, "{}{}", table(2.54, said), report);
            prop_assert!(report.groups().iter().all(|g| g.report.verdict() != Verdict::Trusted), "{}", report);
        }
        let said = "One of us worked in inches and the others in cm.";
        prop_assert!(remarked(&fit(&table(2.54, said))), "{}", table(2.54, said));
        let said = "Tape: one edge inches and one edge cm.";
        prop_assert!(!remarked(&fit(&table(1.0, said))), "{}", table(1.0, said));
    }

    /// Readings in a unit that no heading has are doubted; what they were converted from, and the
    /// unit of a rule or of the ball, is none of theirs.
    #[test]
    fn a_unit_that_no_heading_has_is_doubted(e in 0.6f64..0.85, unit in 0usize..4) {
        let table = |said: &str| {
            let rows: String = (0..5).map(|n| format!("{n},{:.1}\n", 180.0 * e.powi(2 * n))).collect();
            format!("Ball dropped on the floor\nBounce,Height (cm)\n{rows}{said}\n")
        };
        let unit = ["inches", "mm", "feet", "metres"][unit];
        for said in [
            format!("The last two bounces were read in {unit}."),
            format!("heights in {unit}"),
            format!("Bounce 3 is in {unit}, sorry"),
            format!("the last three rebounds in {unit}"),
            format!("Höhe 2 wurde in {unit} gemessen"),
            format!("hauteurs 3 et 4 en {unit}"),
        ] {
            prop_assert!(remarked(&fit(&table(&said))), "{}", table(&said));
        }
        for said in [
            format!("Heights were read in {unit} and converted to cm"),
            format!("ruler marked in {unit}"),
            format!("Diameter of the ball in {unit}: 4"),
            format!("no reading was in {unit}"),
            "all heights in cm".to_owned(),
        ] {
            prop_assert!(!remarked(&fit(&table(&said))), "{}{}", table(&said), fit(&table(&said)));
        }
    }

    /// Where a table has one rebound a drop, a remark that counts a later one is a doubt; the count
    /// of trials and balls, what is denied, and a second of time are none.
    #[test]
    fn a_later_rebound_is_doubted(e in 0.5f64..0.85, wide: bool) {
        let table = |said: &str| {
            let row = |n: usize| {
                let drop = 80 + 20 * n;
                let rebound = |n: usize| format!("{:.1}", drop as f64 * e * e * (1.0 + off(n)));
                if wide { format!("{drop},{},{}\n", rebound(n), rebound(n + 3)) } else { format!("{drop},{}\n", rebound(n)) }
            };
            let header = if wide { "drop height (cm),trial 1 rebound (cm),trial 2 rebound (cm)" } else { "drop height (cm),rebound height (cm)" };
            format!("{said}\n{header}\n{}", (0..5).map(row).collect::<String>())
        };
        for said in [
            "The first bounce was too fast so we nearly always took the second",
            "heights are of the second bounce",
            "bounce read: the second, not the first",
            "read after the 3rd rebound",
            "Höhe nach dem zweiten Aufprall",
            "hauteur du deuxième rebond",
            "il primo rimbalzo era veloce quindi abbiamo preso il secondo",
            "altura del segundo rebote",
            "hoogte van de tweede stuit",
            "wysokość drugiego odbicia",
        ] {
            prop_assert!(remarked(&fit(&table(said))), "{}{}", table(said), fit(&table(said)));
        }
        for said in [
            "The second trial of each bounce is beside the first",
            "rebounds read by the second person",
            "not the second bounce",
            "the second bounce was not read",
            "second rebound: not measured",
            "bounces filmed at 240 frames per second",
            "the first bounce of each drop",
        ] {
            prop_assert!(!remarked(&fit(&table(said))), "{}{}", table(said), fit(&table(said)));
        }
    }

    /// A rule with two scales, one of them in a unit that no heading has, is a doubt unless it is
    /// stated which was read, wherever that stands: also behind the names of the columns.
    #[test]
    fn a_rule_of_two_scales_is_doubted(e in 0.5f64..0.85, place in 0usize..3) {
        let table = |said: &str| {
            let rows: String = (0..5).map(|n| format!("{},{:.1}\n", 80 + 20 * n, f64::from(80 + 20 * n) * e * e * (1.0 + off(n as usize)))).collect();
            let header = "drop (cm),rebound (cm)";
            match place {
                0 => format!("\"{said}\"\n{header}\n{rows}"),
                1 => format!("{header},,\"{said}\"\n{rows}"),
                _ => format!("{header}\n{rows}\n\"{said}\"\n"),
            }
        };
        for said in [
            "rebound: tape (cm on one side, inches on the other)",
            "drop by the long rule, bounce by a tape that has cm and inches",
            "Rücksprung mit einem Maßband mit cm und Zoll",
            "Ball thrown down from the rail",
        ] {
            prop_assert!(remarked(&fit(&table(said))), "{}{}", table(said), fit(&table(said)));
        }
        for said in [
            "tape with cm and inches",
            "rebounds by a tape with cm and inches, measured with the cm side",
            "rebounds by tape in cm",
            "read on a metre rule in cm",
        ] {
            prop_assert!(!remarked(&fit(&table(said))), "{}{}", table(said), fit(&table(said)));
        }
    }

    /// To how much readings agree by chance is by the digits they were written with: in inches and
    /// by energies as in centimetres.
    #[test]
    fn digits_in_any_unit_are_counted(e in 0.6f64..0.85, unit in 0usize..4, high in 60usize..90) {
        let unit = ["in", "cm", "mm", "mJ"][unit];
        let (drop, rebound) = if unit == "mJ" {
            ("kinetic energy before impact (mJ)", "kinetic energy after impact (mJ)")
        } else {
            ("drop height", "rebound height")
        };
        let name = |name: &str| if unit == "mJ" { name.to_owned() } else { format!("{name} ({unit})") };
        let table = |digits: usize| {
            let row = |ball: usize, n: usize| {
                format!("{},{high},{:.digits$}\n", ["golf", "marble"][ball], high as f64 * e * e * (1.0 + off(n)))
            };
            let rows = (0..2).flat_map(|ball| (0..5).map(move |n| (ball, n)));
            format!("ball,{},{}\n{}", name(drop), name(rebound), rows.map(|(ball, n)| row(ball, n)).collect::<String>())
        };
        let copied = |report: &Report| doubts(report).iter().any(|doubt| matches!(doubt, Doubt::Copied { .. }));
        prop_assert!(!copied(&fit(&table(0))), "{}{}", table(0), fit(&table(0)));
        prop_assert!(copied(&fit(&table(3))), "{}{}", table(3), fit(&table(3)));
    }
}
