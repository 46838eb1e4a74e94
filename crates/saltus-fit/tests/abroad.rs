//! Tables of other countries and makers: their encodings, scripts that part no words, drawn tables
//! below titles, codes of specimens, speeds of gates.

use crate::typed::{fit, trusted};
use encoding_rs::{BIG5, EUC_KR, Encoding, GB18030, SHIFT_JIS, WINDOWS_1250, WINDOWS_1251, WINDOWS_1253};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

fn near(found: f64, e: f64, by: f64) -> bool {
    (found - e).abs() < by
}

/// Scatter of the drop `n`, a part of its height.
fn off(n: usize) -> f64 {
    [0.004, -0.007, 0.001, 0.008, -0.005, 0.0, -0.002][n % 7]
}

/// A report of bytes.
fn fitted(bytes: &[u8]) -> Report {
    let table = Table::parse("a.csv", bytes, &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    Fit::new().run(&table).unwrap()
}

/// The COR of a report that is trusted and has no groups.
fn one(report: &Report, e: f64) -> bool {
    report.groups().is_empty() && report.verdict() == Verdict::Trusted && near(report.cor().unwrap().value, e, 0.01)
}

/// Rows of a height of release and its rebound.
fn drops(e: f64, mark: &str) -> String {
    let row = |n: usize| {
        let drop = [60.0, 80.0, 100.0, 120.0][n % 4];
        format!("{drop}{mark}{:.1}\n", drop * e * e * (1.0 + off(n)))
    };
    (0..8).map(row).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// The encoding of a file is that in which its headings are understood.
    #[test]
    fn headings_tell_the_encoding(
        e in 0.5..0.85_f64,
        (of, names) in prop::sample::select(vec![
            (SHIFT_JIS, "落下高さ(cm),はね返り高さ(cm)"),
            (GB18030, "下落高度(cm),反弹高度(cm)"),
            (BIG5, "落下高度(cm),反彈高度(cm)"),
            (EUC_KR, "낙하 높이(cm),반발 높이(cm)"),
            (WINDOWS_1250, "výška pádu (cm),výška odrazu (cm)"),
            (WINDOWS_1251, "высота падения (см),высота отскока (см)"),
            (WINDOWS_1253, "ύψος πτώσης (cm),ύψος αναπήδησης (cm)"),
        ] as Vec<(&'static Encoding, &str)>),
    ) {
        let text = format!("{names}\n{}", drops(e, ","));
        let (bytes, _, lost) = of.encode(&text);
        prop_assert!(!lost && one(&fitted(&bytes), e), "{} {}", of.name(), fitted(&bytes));
    }

    /// Headings of a script that parts no words are read part by part; surfaces and balls tell
    /// columns apart.
    #[test]
    fn names_without_blanks_are_read_part_by_part(
        e in 0.5..0.8_f64,
        names in prop::sample::select(vec![
            ["下落高度(cm)", "水泥地反弹高度(cm)", "草地反弹高度(cm)"],
            ["落下高さ(cm)", "コンクリートはね返り高さ(cm)", "芝生はね返り高さ(cm)"],
            ["落下高度(cm)", "籃球反彈高度(cm)", "網球反彈高度(cm)"],
        ]),
    ) {
        let row = |n: usize| {
            let drop = 20.0 * (n + 3) as f64;
            format!("{drop},{:.1},{:.1}\n", drop * e * e * (1.0 + off(n)), drop * (e - 0.1).powi(2) * (1.0 + off(n + 3)))
        };
        let report = fit(&format!("{}\n{}", names.join(","), (0..6).map(row).collect::<String>()));
        let groups = report.groups();
        prop_assert_eq!(groups.len(), 2, "{}", report);
        for (group, e) in groups.iter().zip([e, e - 0.1]) {
            let found = &group.report;
            prop_assert!(found.verdict() == Verdict::Trusted && near(found.cor().unwrap().value, e, 0.01), "{}", report);
        }
    }

    /// What was predicted, or is an error, is none of the readings in those scripts either.
    #[test]
    fn what_was_not_read_is_left_aside_in_any_script(
        e in 0.5..0.8_f64,
        names in prop::sample::select(vec![
            "下落高度(cm),反弹高度(cm),理论反弹高度(cm)",
            "落下高さ(cm),はね返り高さ(cm),理論はね返り高さ(cm)",
            "下落高度(cm),反弹高度(cm),损失高度(cm)",
        ]),
    ) {
        let rows: String = drops(e, ",").lines().map(|row| format!("{row},40\n")).collect();
        let report = fit(&format!("{names}\n{rows}"));
        prop_assert!(one(&report, e), "{}", report);
    }

    /// The time between two neighbouring contacts, in whatever words.
    #[test]
    fn the_time_between_neighbours_is_a_flight(
        e in 0.7..0.95_f64,
        name in prop::sample::select(vec!["相邻两次撞击的时间间隔 (s)", "相鄰兩次碰撞的時間間隔 (s)", "連続する衝突の時間間隔 (s)", "时间间隔 (s)"]),
    ) {
        let rows: String = (0..8).map(|n| format!("{},{:.4}\n", n + 1, 0.64 * e.powi(n))).collect();
        let report = fit(&format!("乒乓球在桌面上的弹跳,\n序号,{name}\n{rows}"));
        prop_assert!(one(&report, e), "{}", report);
    }

    /// A table drawn with bars may stand below titles and above remarks.
    #[test]
    fn bars_part_cells_below_a_title(
        e in 0.5..0.85_f64,
        title in prop::sample::select(vec!["Basketball check - gym floor, by group 4", "Versuch 3", "Balle n° 2, mesures du 3 mai"]),
        remark in prop::sample::select(vec!["", "\nread by Ann, with a ruler\n"]),
    ) {
        let report = fit(&format!("{title}\n\nDrop height (cm) | Bounce height (cm)\n{}{remark}", drops(e, " | ")));
        prop_assert!(one(&report, e), "{}", report);
    }

    /// Codes that are numbered name specimens, whatever their letters mean elsewhere; a mean below
    /// them is one.
    #[test]
    fn codes_of_specimens_say_nothing(
        e in 0.6..0.8_f64,
        code in prop::sample::select(vec!["ITF-4", "FIFA 3", "MAX_0", "AB-1"]),
        name in prop::sample::select(vec!["Sample ID", "Ball ID", "Specimen", "Probe"]),
    ) {
        let row = |n: usize| format!("{code}{n},100,{:.1}\n", 100.0 * e * e * (1.0 + off(n)));
        let rows: String = (0..7).map(row).collect();
        let report = fit(&format!("{name},Drop (in),Rebound (in)\n{rows}Average,100,{:.2}\n", 100.0 * e * e));
        prop_assert!(report.groups().is_empty() && near(report.cor().unwrap().value, e, 0.01), "{}", report);
    }

    /// A zone of the floor names a drop, and parts no groups.
    #[test]
    fn zones_are_repeats(
        e in 0.6..0.8_f64,
        name in prop::sample::select(vec!["Zona", "zone", "Strefa", "Lane", "区域", "Bölge"]),
    ) {
        let row = |n: usize| format!("{},{:.1}\n", ["A", "B", "C", "D", "E", "F"][n], 100.0 * e * e * (1.0 + off(n)));
        let rows: String = (0..6).map(row).collect();
        let report = fit(&format!("Ball dropped from 100 cm\n{name},rebound (cm)\n{rows}"));
        prop_assert!(report.groups().is_empty() && near(report.cor().unwrap().value, e, 0.01), "{}", report);
    }

    /// Speeds on the way to something and back are of a bounce, which no air stands between; what
    /// comes back faster in some row is not known to be one.
    #[test]
    fn speeds_in_and_out_are_of_a_bounce(
        e in 0.4..0.8_f64,
        names in prop::sample::select(vec![
            ("v_in (m/s)", "v_out (m/s)"), ("speed in (m/s)", "speed out (m/s)"), ("v hin (m/s)", "v zurück (m/s)"),
            ("vitesse aller (m/s)", "vitesse retour (m/s)"), ("velocidad ida (m/s)", "velocidad vuelta (m/s)"),
            ("incoming speed (mph)", "outgoing speed (mph)"),
        ]),
        faster in any::<bool>(),
    ) {
        let row = |n: usize| {
            let v = 20.0 + 3.0 * n as f64;
            let e = if faster && n == 3 { 1.1 } else { e };
            format!("{n},{v:.2},{:.2}\n", v * e * (1.0 + off(n)))
        };
        let report = fit(&format!("run,{},{}\n{}", names.0, names.1, (1..9).map(row).collect::<String>()));
        if faster {
            prop_assert!(report.verdict() != Verdict::Trusted, "{}", report);
        } else {
            prop_assert!(one(&report, e) && report.cor().unwrap().high < e + 0.02, "{}", report);
        }
    }

    /// The ratio that LaTeX sets with a root was worked out.
    #[test]
    fn roots_of_latex_are_worked_out(e in 0.6..0.85_f64) {
        let row = |n: usize| {
            let h = 20.0 + 10.0 * n as f64;
            format!("${h} \\pm 0.2$ & ${:.1} \\pm 0.5$ & {:.2} \\\\\n", h * e * e * (1.0 + off(n)), e + 0.01 * (n % 2) as f64)
        };
        let rows: String = (0..6).map(row).collect();
        let head = "\\begin{tabular}{ccc}\n$h_0$ (cm) & $h_1$ (cm) & $\\sqrt{h_1/h_0}$ \\\\\n";
        let report = fit(&format!("{head}{rows}\\end{{tabular}}\n"));
        prop_assert!(report.groups().is_empty() && near(report.cor().unwrap().value, e, 0.01), "{}", report);
    }

    /// Lines that name two bounces hold the time between them.
    #[test]
    fn lines_name_the_bounces_that_a_time_lies_between(
        e in 0.7..0.9_f64,
        (title, name, and, unit) in prop::sample::select(vec![
            ("Tempi tra un rimbalzo e il successivo (in millisecondi):", "tra ", " e ", " ms"),
            ("Zeiten zwischen den Aufprallen", "zwischen ", " und ", " ms"),
            ("Times between bounces (ms)", "", "-", ""),
            ("Tiempos entre botes", "entre ", " y ", " ms"),
            ("Temps entre les rebonds", "entre ", " et ", " ms"),
        ]),
    ) {
        let row = |n: i32| format!("{name}{n}{and}{}: {:.0}{unit}\n", n + 1, 700.0 * e.powi(n - 1));
        let report = fit(&format!("{title}\n\n{}", (1..8).map(row).collect::<String>()));
        prop_assert!(near(report.cor().unwrap().value, e, 0.01), "{}", report);
    }

    /// Days and times by themselves, below what names impacts, are those of contacts.
    #[test]
    fn times_of_day_alone_are_of_contacts(
        e in 0.7..0.9_f64,
        title in prop::sample::select(vec!["# hit detector, local time", "impacts, by microphone", "# Aufprall"]),
    ) {
        let mut at = 58.493;
        let row = |n: i32| {
            at += if n == 0 { 0.0 } else { 0.8 * e.powi(n - 1) };
            let (minute, second) = if at < 60.0 { (31, at) } else { (32, at - 60.0) };
            format!("2024-06-18 09:{minute}:{second:06.3}\n")
        };
        let report = fit(&format!("{title}\n{}", (0..8).map(row).collect::<String>()));
        prop_assert!(near(report.cor().unwrap().value, e, 0.01), "{}", report);
    }

    /// Flights beside contacts that last leave out how long these do.
    #[test]
    fn flights_leave_out_how_long_contacts_last(
        e in 0.6..0.8_f64,
        names in prop::sample::select(vec![
            "Contact,Start (s),End (s),Peak force (N),Flight time to next contact (s)",
            "Contact,Start (s),End (s),Peak force (N),Air time (s)",
        ]),
    ) {
        let mut at = 0.4;
        let row = |n: i32| {
            let (begun, flown) = (at, 0.67 * e.powi(n));
            at += 0.012 + flown;
            format!("{},{begun:.4},{:.4},{},{flown:.4}\n", n + 1, begun + 0.012, 700 - 90 * n)
        };
        let report = fit(&format!("Force plate\n{names}\n{}", (0..6).map(row).collect::<String>()));
        prop_assert!(near(report.cor().unwrap().value, e, 0.003), "{}", report);
    }

    /// A unit may stand behind a preposition of one letter, in a heading and in a sentence.
    #[test]
    fn prepositions_lead_to_a_unit(
        e in 0.5..0.8_f64,
        text in prop::sample::select(vec![
            "Dropped from 1 m. W tabeli podano wysokość po odbiciu w cm.",
            "Dropped from 1 m. výška odrazu v cm",
            "Dropped from 1 m. The table shows the rebound height in cm.",
            "Dropped from 1 m. Le tableau donne la hauteur du rebond en cm.",
        ]),
    ) {
        let row = |n: usize| {
            let cell = |k: usize| format!(",{:.1}", 100.0 * (e + 0.05 * n as f64).powi(2) * (1.0 + off(3 * n + k)));
            format!("{}{}\n", ["wood", "steel"][n], (0..4).map(cell).collect::<String>())
        };
        let report = fit(&format!("{text}\nfloor;trial 1;trial 2;trial 3;trial 4\n{}", (0..2).map(row).collect::<String>().replace(',', ";")));
        prop_assert_eq!(report.groups().len(), 2, "{}", report);
        prop_assert!(near(report.groups()[0].report.cor().unwrap().value, e, 0.01), "{}", report);
    }

    /// Messages say how high a ball came, below one that says from where.
    #[test]
    fn messages_say_how_high_a_ball_came(
        e in 0.5..0.8_f64,
        (from, name, high) in prop::sample::select(vec![
            ("ok ich lass jetzt immer aus 1,50 m fallen", "Versuch", " hoch gesprungen"),
            ("we drop it from 1.50 m every time", "try", " high"),
            ("Wir haben den Ball immer aus 1,50 m fallen lassen", "Versuch", " hoch"),
        ]),
    ) {
        let row = |n: usize| format!("[12.05.24, 16:0{n}:10] Mia: {name} {n}: {:.0} cm{high}\n", 150.0 * e * e * (1.0 + off(n)));
        let text = format!("[12.05.24, 16:00:11] Jonas: {from}\n{}", (1..6).map(row).collect::<String>());
        let report = fit(&text);
        prop_assert!(near(report.cor().unwrap().value, e, 0.02), "{}", report);
    }

    /// Conditions in the names of programs, above or among the readings.
    #[test]
    fn conditions_bear_a_unit_behind_an_underscore(
        e in 0.5..0.8_f64,
        name in prop::sample::select(vec!["air_temperature_c", "floor_temp_f", "room_temperature_k", "ball_temp_C"]),
    ) {
        let h = |n: i32| 3.0 * e.powi(2 * n);
        let text = format!("drop_height_m: 3.00\nbounce_heights_m:\n  - {:.3}\n  - {:.3}\n  - {:.3}\n{name}: 21\n", h(1), h(2), h(3));
        prop_assert!(near(trusted(&text), e, 0.01));
    }

    /// Sentences count bounces, with an `and` of one letter.
    #[test]
    fn sentences_count_bounces_with_short_words(
        e in 0.6..0.85_f64,
        text in prop::sample::select(vec![
            "ho lasciato cadere il pallone da basket da 180 cm. Al primo rimbalzo è arrivato a A cm, al secondo a B cm e al terzo a C cm.",
            "I dropped the ball from 180 cm. The first bounce came up to A cm, the second to B cm and the third to C cm.",
        ]),
    ) {
        let h = |n: i32| format!("{:.1}", 180.0 * e.powi(2 * n));
        let text = text.replace("A cm", &(h(1) + " cm")).replace("B cm", &(h(2) + " cm")).replace("C cm", &(h(3) + " cm"));
        prop_assert!(near(trusted(&text), e, 0.01));
    }

    /// Names of columns in a line above one row of numbers are those of its columns.
    #[test]
    fn names_above_one_row_are_of_its_columns(e in 0.6..0.85_f64, count in 4..7_i32) {
        let names: Vec<String> = (1..=count).map(|n| format!("Time interval {n} (s)")).collect();
        let times: Vec<String> = (0..count).map(|n| format!("{:.4}", 0.62 * e.powi(n))).collect();
        let report = fit(&format!("{}\n{}\n", names.join(","), times.join(",")));
        prop_assert!(near(report.cor().unwrap().value, e, 0.01), "{}", report);
    }

    /// Measurements of the first bounce, numbered, beside what they were dropped from.
    #[test]
    fn measurements_that_are_numbered_are_repeats(
        e in 0.6..0.85_f64,
        (drop, name) in prop::sample::select(vec![
            ("Bırakma yüksekliği", "sıçrama yüksekliği ölçümü"),
            ("Drop height", "rebound height measurement"),
        ]),
    ) {
        let row = |n: usize| format!("{n}. {name}: {:.3} m\n", 1.75 * e * e * (1.0 + off(n)));
        let report = fit(&format!("{drop}: 1.75 m\n{}", (1..6).map(row).collect::<String>()));
        prop_assert!(one(&report, e), "{}", report);
    }

    /// Who wrote a sheet may be short for a name, which is no ratio.
    #[test]
    fn initials_are_no_ratio(
        e in 0.7..0.9_f64,
        names in prop::sample::select(vec!["Binôme : Léa M. / Hugo T. - classe de 2nde 3", "By: Ann K. / Tom B.", "Gruppe: Mia S. / Jan R."]),
    ) {
        let rows: String = (0..6).map(|n| format!("{n};{:.3}\n", 1.2 * e.powi(2 * n))).collect();
        let cor = trusted(&format!("Bounces of a ball\n{names}\n\nBounce;Max height (m)\n{rows}"));
        prop_assert!(near(cor, e, 0.01), "{}", cor);
    }

    /// What passes a rule, or fails, was measured all the same.
    #[test]
    fn what_fails_a_rule_was_measured(
        e in 0.6..0.8_f64,
        name in prop::sample::select(vec!["Pass/Fail", "Result", "Ergebnis", "Status"]),
        answers in prop::sample::select(vec![("PASS", "FAIL"), ("pass", "Fail")]),
    ) {
        let row = |n: usize| format!("100,{:.1},{}\n", 100.0 * e * e * (1.0 + off(n)), if n == 3 { answers.1 } else { answers.0 });
        let rows: String = (0..7).map(row).collect();
        let table = Table::parse("a.csv", format!("drop (cm),rebound (cm),{name}\n{rows}").as_bytes(), &ReadOptions::default());
        prop_assert_eq!(table.unwrap().trials().len(), 7);
    }
}
