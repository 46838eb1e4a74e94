//! What columns, lines and sheets say of one another: a flight beside a height of release, a remark
//! that answers yes or no, a unit at the end of a line, a sheet of notes beside those of readings.

use crate::typed::{fit, read, trusted};
use crate::written::xlsx;
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

fn near(found: f64, e: f64, by: f64) -> bool {
    (found - e).abs() < by
}

/// The CORs of the groups of a report that are trusted.
fn of_groups(report: &Report) -> Vec<f64> {
    let groups = report.groups().iter().filter(|g| g.report.verdict() == Verdict::Trusted);
    groups.map(|g| g.report.cor().unwrap().value).collect()
}

/// Scatter of the drop `n`, a part of its height.
fn off(n: usize) -> f64 {
    [0.004, -0.007, 0.001, 0.008, -0.005, 0.0, -0.002][n % 7]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// A time that names a bounce and the next one is that of the flight between them, whoever
    /// wrote the rows down.
    #[test]
    fn a_time_from_a_bounce_to_the_next_is_a_flight(
        e in 0.5..0.9_f64,
        names in prop::sample::select(vec![
            ("Drop height [m]", "Time 1st bounce -> 2nd bounce [s]"),
            ("Fallhöhe [m]", "Zeit 1. → 2. Aufprall [s]"),
            ("Hauteur de chute (m)", "Temps 1er rebond => 2e rebond (s)"),
            ("Altura de caída (m)", "Tiempo entre 1er y 2º rebote (s)"),
            ("Drop height (m)", "Time from 1st to 2nd bounce (s)"),
            ("Drop height (m)", "t 1-2 (s)"),
        ]),
        by in prop::sample::select(vec!["done by", "student", "who"]),
    ) {
        let row = |(n, h): (usize, f64)| {
            let flight = 2.0 * e * (2.0 * h / 9.81f64).sqrt();
            format!("{h};{flight:.4};{}\n", ["Finn", "Tom"][n % 2])
        };
        let rows: String = [0.5, 0.5, 1.0, 1.0, 1.5, 1.5].into_iter().enumerate().map(row).collect();
        let report = fit(&format!("{};{};{by}\n{rows}", names.0, names.1));
        prop_assert!(near(report.cor().unwrap().value, e, 0.004) && report.groups().is_empty(), "{}", report);
    }

    /// A column that only answers yes or no is a remark: it parts no groups, but where the CORs
    /// differ by it; and what it calls bad does not count.
    #[test]
    fn answers_are_remarks_until_the_cors_differ_by_them(
        e in 0.5..0.8_f64,
        name in prop::sample::select(vec!["used_phone", "slow motion?", "Handy", "zorb", "new", "used"]),
        answers in prop::sample::select(vec![("no", "yes"), ("nein", "ja"), ("FALSE", "TRUE"), ("non", "oui"), ("n", "y")]),
        differ in any::<bool>(),
    ) {
        let row = |n: usize| {
            let (yes, drop) = (n % 2 == 1, [80.0, 100.0, 120.0][n / 2 % 3]);
            let e = if yes && differ { e + 0.06 } else { e };
            format!("{n},{drop},{:.2},{}\n", drop * e * e * (1.0 + off(n)), if yes { answers.1 } else { answers.0 })
        };
        let report = fit(&format!("id,drop_cm,rebound_cm,{name}\n{}", (0..18).map(row).collect::<String>()));
        let groups = of_groups(&report);
        if differ {
            prop_assert!(groups.len() == 2 || report.verdict() != Verdict::Trusted, "{}", report);
            for (found, e) in groups.iter().zip([e, e + 0.06]) {
                prop_assert!(near(*found, e, 0.01), "{}", report);
            }
        } else {
            prop_assert!(report.groups().is_empty() && near(report.cor().unwrap().value, e, 0.01), "{}", report);
        }
    }

    /// What a column calls bad does not count, whatever stands above it.
    #[test]
    fn what_is_called_bad_does_not_count(
        e in 0.5..0.7_f64,
        column in prop::sample::select(vec![
            ("valid", "yes", "no"), ("gültig", "ja", "nein"), ("result", "OK", "bad"), ("zorb", "ok", "discarded"), ("valide", "oui", "non"),
        ]),
    ) {
        let (name, good, bad) = column;
        let row = |n: usize| {
            let (wrong, drop) = (n % 3 == 2, [80.0, 100.0, 120.0][n % 3]);
            let height = drop * e * e * (1.0 + off(n)) * if wrong { 1.3 } else { 1.0 };
            format!("{n},{drop},{height:.2},{}\n", if wrong { bad } else { good })
        };
        let report = fit(&format!("id,drop_cm,rebound_cm,{name}\n{}", (0..18).map(row).collect::<String>()));
        prop_assert!(report.groups().is_empty() && near(report.cor().unwrap().value, e, 0.01), "{}", report);
    }

    /// Conditions may bear their unit in each cell, whatever stands above them.
    #[test]
    fn a_condition_may_bear_its_unit_in_each_cell(
        first in 0.5..0.6_f64,
        name in prop::sample::select(vec!["Pressure (gauge)", "Zorb", "Druck", "inflated to"]),
        unit in prop::sample::select(vec!["psi", "°C", "bar"]),
    ) {
        let row = |n: usize| {
            let e = first + 0.06 * n as f64;
            let cells = (0..5).map(|k| format!(",{:.2}", 100.0 * e * e * (1.0 + off(5 * n + k))));
            format!("{} {unit}{}\n", 4 * (n + 1), cells.collect::<String>())
        };
        let rows: String = (0..3).map(row).collect();
        let report = fit(&format!("Ball dropped from 100 in. onto concrete\nRebound (in)\n{name},R1,R2,R3,R4,R5\n{rows}"));
        let groups = of_groups(&report);
        prop_assert_eq!(groups.len(), 3, "{}", report);
        for (n, found) in groups.iter().enumerate() {
            prop_assert!(near(*found, first + 0.06 * n as f64, 0.01), "{}", report);
        }
    }

    /// Repeats that bear no unit have that of what sums them up.
    #[test]
    fn the_unit_of_a_mean_is_that_of_what_it_is_of(
        e in 0.5..0.85_f64,
        names in prop::sample::select(vec![
            ("Drop height: 100 in.", "Trial", "Average (in)"),
            ("Fallhöhe: 100 in", "Versuch", "Mittelwert (in)"),
            ("Hauteur de chute : 100 in", "essai", "moyenne (in)"),
        ]),
    ) {
        let row = |n: usize| {
            let cells: Vec<f64> = (0..3).map(|k| (1000.0 * e * e * (1.0 + off(3 * n + k))).round() / 10.0).collect();
            let mean = cells.iter().sum::<f64>() / 3.0;
            format!("{};{};{};{};{mean:.2}\n", ["golf", "tennis"][n], cells[0], cells[1], cells[2])
        };
        let (title, trial, mean) = names;
        let report = fit(&format!("{title}\nBall;{trial} 1;{trial} 2;{trial} 3;{mean}\n{}{}", row(0), row(1)));
        prop_assert_eq!(of_groups(&report).len(), 2, "{}", report);
        prop_assert!(of_groups(&report).iter().all(|found| near(*found, e, 0.01)), "{}", report);
    }

    /// A unit in brackets at the end of a line of names, above no number, is that of all.
    #[test]
    fn a_unit_at_the_end_of_the_names_is_of_all(
        e in 0.5..0.9_f64,
        names in prop::sample::select(vec![("drop", "rebound"), ("Fallhöhe", "Rücksprunghöhe"), ("chute", "rebond"), ("h0", "h1")]),
        mark in prop::sample::select(vec!["   ", "\t", " "]),
        unit in prop::sample::select(vec![("(cm)", 100.0), ("[m]", 1.0), ("(mm)", 1000.0)]),
        fenced in any::<bool>(),
    ) {
        let row = |h: f64| format!("{:.4}{mark}{:.4}\n", h * unit.1, h * e * e * unit.1);
        let rows: String = [1.0, 1.2, 1.5, 2.0].map(row).concat();
        let table = format!("{}{mark}{}{mark}{}\n{rows}", names.0, names.1, unit.0);
        let fence = if fenced { "```\n" } else { "" };
        let found = fit(&format!("Bouncing ball\n\n{fence}{table}{fence}"));
        prop_assert!(near(found.cor().unwrap().value, e, 0.004), "{}", found);
    }

    /// What names its columns all by itself stands below a title, though words of that are
    /// understood, and a column beside them that is worked out.
    #[test]
    fn names_that_say_all_stand_below_a_title(
        e in 0.5..0.9_f64,
        title in prop::sample::select(vec!["Pelota de goma - suelo de baldosa", "Rubber ball on tile", "Gummiball", "Golf ball"]),
        beside in prop::sample::select(vec!["Fecha: 12/03/2024", "Class 9b", "Datum: 3.4.2024"]),
        names in prop::sample::select(vec![
            "Ensayo;Velocidad antes del choque (m/s);Velocidad después del choque (m/s);Pérdida de energía (%)",
            "Trial;Speed before (m/s);Speed after (m/s);Energy lost (%)",
            "Versuch;Geschwindigkeit vorher (m/s);Geschwindigkeit nachher (m/s);Energieverlust (%)",
        ]),
    ) {
        let row = |n: usize| {
            let v = 3.0 + 0.3 * n as f64;
            format!("{n};{:.3};{:.3};{:.1}\n", -v, v * e, 100.0 * (1.0 - e * e))
        };
        let found = trusted(&format!("{title};;;{beside}\n\n{names}\n{}", (1..8).map(row).collect::<String>()));
        prop_assert!(near(found, e, 0.005));
    }

    /// A line states the height of release with a sign that counts, and in more units than one;
    /// later signs count on from there.
    #[test]
    fn later_signs_count_from_that_of_the_release(
        e in 0.5..0.9_f64,
        title in prop::sample::select(vec![
            "Drop height H1;1 016 mm;(40.00\")", "Drop height H1: 1016 mm", "Fallhöhe (h1);1 016 mm",
            "Hauteur de chute H1 = 1 016 mm", "Drop height H1 (mm) 1016", "Drop height H0;1 016 mm",
        ]),
    ) {
        let column = if title.contains("H0") { "H1 (mm)" } else { "H2 (mm)" };
        let rows: String = (0..6).map(|n| format!("{n};{:.1}\n", 1016.0 * e * e * (1.0 + off(n)))).collect();
        let report = fit(&format!("Rebound inspection\n{title}\nBatch: EPDM\n\nS/N;{column}\n{rows}"));
        prop_assert!(near(report.cor().unwrap().value, e, 0.006), "{}\n{}", title, report);
    }

    /// What a sheet of notes states holds for the sheets of readings that state none; and a sheet
    /// of the means of another one counts no more.
    #[test]
    fn a_sheet_of_notes_states_the_release(
        cors in prop::collection::vec(0.55..0.9_f64, 2),
        note in prop::sample::select(vec![
            "Abwurfhöhe für alle Bälle: 1,50 m (Unterkante)", "Drop height: 150 cm", "Every ball was dropped from 1.5 m",
            "Hauteur de chute : 1,5 m",
        ]),
        means in any::<bool>(),
    ) {
        let cell = |n: usize, ball: usize| (1500.0 * cors[ball].powi(2) * (1.0 + off(n + ball))).round() / 10.0;
        let text = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect::<Vec<String>>();
        let mut rows = vec![text(&["Versuch", "Tennisball", "Golfball"])];
        rows.extend((0..6).map(|n| vec![(n + 1).to_string(), cell(n, 0).to_string(), cell(n, 1).to_string()]));
        let mut data = vec![text(&["Rücksprunghöhe in cm"])];
        data.append(&mut rows);
        let notes = vec![text(&["Rücksprungversuch"]), text(&[note]), text(&["Ablesung am Maßstab"])];
        let mean = |ball: usize| format!("{:.1}", (0..6).map(|n| cell(n, ball)).sum::<f64>() / 6.0);
        let sums = vec![
            text(&["Ball", "Mittelwert [cm]", "Fallhöhe [cm]"]),
            text(&["Tennisball", &mean(0), "150"]),
            text(&["Golfball", &mean(1), "150"]),
        ];
        let mut sheets = vec![("Hinweise", notes), ("Messwerte", data)];
        if means {
            sheets.push(("Auswertung", sums));
        }
        let table = Table::parse("b.xlsx", &xlsx(&sheets), &ReadOptions::default()).unwrap();
        let report = Fit::new().run(&table).unwrap();
        prop_assert_eq!(of_groups(&report).len(), 2, "{}", report);
        for (found, e) in of_groups(&report).iter().zip(&cors) {
            prop_assert!(near(*found, *e, 0.01), "{}", report);
        }
    }
}

/// A column of names is not blamed where another one holds no reading.
#[test]
fn what_is_measured_is_blamed_before_what_is_written() {
    for name in ["Distance between bounces (cm)", "Abstand zwischen den Aufprallen (cm)"] {
        let text = format!("Drop height [m];{name};done by\n0.5;30;Finn\n1;40;Tom\n");
        let error = read(&text).unwrap_err().to_string();
        assert!(error.contains(name) && !error.contains("'done"), "{error}");
    }
}

/// Heights beside a release that lose as little from one to the next as the first does may be
/// bounces or repeats: it is asked, unless the names say trials. Repeats scatter about one height,
/// bounces fall by one factor.
#[test]
fn repeats_scatter_and_bounces_fall() {
    let table = |name: &str, factor: &dyn Fn(usize) -> f64| {
        let rows = [60.0, 80.0, 100.0, 120.0].map(|h| {
            let cells = (1..4).map(|n| format!(",{:.1}", h * factor(n)));
            format!("{h}{}\n", cells.collect::<String>())
        });
        format!("drop height (cm),{name} 1 (cm),{name} 2 (cm),{name} 3 (cm)\n{}", rows.concat())
    };
    let (bounces, repeats) = (|n: usize| 0.64f64.powi(n as i32), |n: usize| 0.64 * (1.0 + off(n)));
    assert!(near(trusted(&table("bounce", &bounces)), 0.8, 0.004));
    assert!(near(trusted(&table("bounce", &repeats)), 0.8, 0.004));
    let either = |n: usize| 0.96f64.powi(n as i32) * 0.985;
    assert!(read(&table("bounce", &either)).is_err_and(|error| error.is_question()));
    assert!(read(&table("trial", &either)).is_ok());
}

/// Two sheets of notes that state two heights state none.
#[test]
fn notes_that_differ_state_nothing() {
    let text = |cell: &str| vec![vec![cell.to_owned()]];
    let data = vec![vec!["Rebound (cm)".to_owned()], vec!["96".to_owned()], vec!["97".to_owned()]];
    let sheets = [("Notes", text("Drop height: 150 cm")), ("More", text("Drop height: 2 m")), ("Data", data)];
    let table = Table::parse("b.xlsx", &xlsx(&sheets), &ReadOptions::default());
    let verdict = table.map(|table| Fit::new().run(&table).unwrap().verdict());
    assert!(verdict.is_err() || verdict.is_ok_and(|v| v != Verdict::Trusted));
}
