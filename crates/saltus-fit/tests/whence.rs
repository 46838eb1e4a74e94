//! Where a ball was let go and where it came up to, as people say it in other words, other scripts
//! and other layouts: each with a planted COR.

use crate::typed::{fit, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

/// Scatter of the drop `n`, a part of its height.
fn off(n: usize) -> f64 {
    [0.004, -0.006, 0.002, 0.007, -0.005, 0.0, -0.003][n % 7]
}

/// Rows of a number, a height of release and one of a rebound, cm, parted by a mark.
fn drops(e: f64, mark: &str) -> String {
    let row = |(n, h): (usize, f64)| format!("{}{mark}{h}{mark}{:.1}\n", n + 1, h * e * e * (1.0 + off(n)));
    [70.0, 90.0, 120.0, 140.0, 170.0, 190.0].into_iter().enumerate().map(row).collect()
}

/// The COR of each group of a table, all of them trusted.
fn groups(text: &str) -> Vec<f64> {
    let report = fit(text);
    let cor = |report: &Report| {
        assert_eq!(report.verdict(), Verdict::Trusted, "{text}\n{report}");
        report.cor().unwrap().value
    };
    report.groups().iter().map(|group| cor(&group.report)).collect()
}

fn near(found: f64, e: f64) -> bool {
    (found - e).abs() < 0.015
}

/// Names of where a ball was let go, and where it came up to, each ending in a word that leads.
const LED: [[&str; 2]; 22] = [
    ["let fall from", "got back to"],
    ["losgelassen aus", "sprang hoch bis"],
    ["lâchée depuis", "revient jusqu'à"],
    ["soltada desde", "llega hasta"],
    ["lasciata da", "risale fino a"],
    ["largada de", "subiu até"],
    ["losgelaten vanaf", "kwam terug tot"],
    ["släpptes från", "studsade till"],
    ["sluppet fra", "spratt opp til"],
    ["puszczona z", "doskoczyła do"],
    ["pušteno z", "vyskočil do"],
    ["ejtve innen", "felpattant eddig"],
    ["отпустили с", "подпрыгнул до"],
    ["кинули з", "підскочив до"],
    ["пуснато от", "отскача до"],
    ["lăsată de la", "a urcat până la"],
    ["αφέθηκε από", "αναπήδησε μέχρι"],
    ["amollada des de", "rebota fins a"],
    ["pušteno iz", "odskoči do"],
    ["numesta iš", "pakilo iki"],
    ["nomesta no", "uzlēca līdz"],
    ["dilepas dari", "memantul sampai"],
];

/// The same by whole names, in which no such word ends.
const NAMED: [[&str; 2]; 14] = [
    ["quota di rilascio", "quota massima dopo il rimbalzo"],
    ["altura desde la que se deja caer", "altura hasta la que rebota"],
    ["výška puštění", "výška výskoku"],
    ["výška spustenia", "výška odskoku"],
    ["înălțimea de la care cade", "înălțimea la care sare"],
    ["גובה הפלה", "גובה אחרי ניתור"],
    ["الارتفاع الابتدائي", "الارتفاع بعد الارتداد"],
    ["छोड़ने की ऊँचाई", "उछलने की ऊँचाई"],
    ["놓은 높이", "튄 높이"],
    ["落とした高さ", "はね返った高さ"],
    ["松手高度", "回弹高度"],
    ["висота кидання", "висота підскоку"],
    ["paleidimo aukštis", "atšokimo aukštis"],
    ["ύψος ρίψης", "μέγιστο ύψος μετά την αναπήδηση"],
];

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_leads_from_and_to_heights_names_them(e in 0.45..0.85_f64, n in 0..LED.len(), comma in any::<bool>()) {
        let [from, to] = LED[n];
        let unit = if comma { ", cm" } else { " (cm)" };
        let text = format!("Rubber ball on wood\nno.;{from}{unit};{to}{unit}\n{}", drops(e, ";"));
        prop_assert!(near(trusted(&text), e), "{}", text);
    }

    #[test]
    fn drops_and_rebounds_have_names_in_many_languages(e in 0.45..0.85_f64, n in 0..NAMED.len()) {
        let [from, to] = NAMED[n];
        let text = format!("no.;{from} (cm);{to} (cm)\n{}", drops(e, ";"));
        prop_assert!(near(trusted(&text), e), "{}", text);
    }

    /// `from` above the drops says what they are beside names of balls, and articles stand within
    /// these.
    #[test]
    fn where_balls_fall_from_stands_beside_their_names(
        one in 0.75..0.85_f64,
        other in 0.55..0.65_f64,
        (title, from, names) in prop::sample::select(vec![
            ("Cât sare mingea (cm)", "de la (cm)", ["minge de plastic", "minge de zorb"]),
            ("Rebound of the balls (cm)", "from (cm)", ["rubber ball", "ball of zorb"]),
            ("Rebond de la balle (cm)", "de (cm)", ["balle en mousse", "balle de zorb"]),
        ]),
    ) {
        let row = |(n, h): (usize, f64)| {
            let up = |e: f64| h * e * e * (1.0 + off(n));
            format!("{h};{:.1};{:.1}\n", up(one), up(other))
        };
        let rows: String = [60.0, 90.0, 120.0, 150.0, 180.0].into_iter().enumerate().map(row).collect();
        let text = format!("{title}\n{from};{};{}\n{rows}", names[0], names[1]);
        let found = groups(&text);
        prop_assert!(found.len() == 2 && near(found[0], one) && near(found[1], other), "{:?} {}", found, text);
    }

    /// Digits of other scripts, and their decimal marks, are read.
    #[test]
    fn digits_of_every_script_are_numbers(e in 0.5..0.85_f64, zero in prop::sample::select(vec!['٠', '۰', '०', '০', '๐', '０'])) {
        let digit = |c: char| c.to_digit(10).and_then(|n| char::from_u32(u32::from(zero) + n)).unwrap_or(c);
        let point = if matches!(zero, '٠' | '۰') { '٫' } else { '.' };
        let rows: String = drops(e, ";").chars().map(digit).map(|c| if c == '.' { point } else { c }).collect();
        let text = format!("no.;drop height (cm);rebound height (cm)\n{rows}");
        prop_assert!(near(trusted(&text), e), "{}", text);
    }

    /// A sentence that goes on in the next line states the height of release, however often it was
    /// dropped.
    #[test]
    fn a_sentence_in_two_lines_states_where_balls_fell_from(
        e in 0.6..0.85_f64,
        lines in prop::sample::select(vec![
            "We let every single ball fall four times\nfrom 180 cm (edge of the shelf) and looked how far it came,\nall in cm.",
            "Jeden der Bälle haben wir hier fünf mal fallen lassen\naus 180 cm und dann geschaut, wie hoch er kam,\nalles in cm.",
            "Iedere bal hebben we twee keer laten vallen\nvanaf 180 cm (rand van de tafel) en dan gemeten,\nalles in cm.",
        ]),
    ) {
        let up = |k: usize| 180.0 * e * e * (1.0 + 0.5 * off(k));
        let row = |name: &str, k: usize| format!("{name:<14}   {:<7.1}   {:<7.1}   {:<7.1}\n", up(k), up(k + 1), up(k + 2));
        let rows: String = ["golf ball", "tennis ball", "hockey ball"].iter().zip([0, 2, 4]).map(|(name, k)| row(name, k)).collect();
        let text = format!("{lines}\n\nball             trial 1   trial 2   trial 3\n{rows}");
        let found = groups(&text);
        prop_assert!(found.len() == 3 && found.iter().all(|cor| near(*cor, e)), "{:?} {}", found, text);
    }

    /// Pairs of contacts below the name of what lies between them are flights.
    #[test]
    fn pairs_of_contacts_below_a_name_are_flights(
        e in 0.6..0.85_f64,
        (name, pairs) in prop::sample::select(vec![
            ("Time between impacts (s)", ["1st-2nd", "2nd-3rd", "3rd-4th", "4th-5th"]),
            ("Temps entre deux rebonds (s)", ["1→2", "2→3", "3→4", "4→5"]),
            ("Tempo entre toques (s)", ["1º–2º", "2º–3º", "3º–4º", "4º–5º"]),
        ]),
    ) {
        let flight = |n: usize, k: i32| 0.9 * e.powi(k) * (1.0 + 0.3 * off(n + k as usize));
        let row = |n: usize| format!("run {n};{:.3};{:.3};{:.3};{:.3}\n", flight(n, 0), flight(n, 1), flight(n, 2), flight(n, 3));
        let rows: String = (1..5).map(row).collect();
        let text = format!("A ball bounces\n;{name};;;\n;{}\n{rows}", pairs.join(";"));
        prop_assert!(near(trusted(&text), e), "{}", text);
    }

    /// Lines of two contacts and the time between them, which blanks part.
    #[test]
    fn blanks_part_contacts_from_the_time_between_them(e in 0.6..0.85_f64, arrow in prop::sample::select(vec![" -> ", "-", " to "])) {
        let row = |k: i32| format!("hit {}{arrow}{}   {:.0} ms\n", k + 1, k + 2, 800.0 * e.powi(k));
        let text = format!("A rubber ball on stone.\nTimes from one hit to the next:\n\n{}", (0..7).map(row).collect::<String>());
        prop_assert!(near(trusted(&text), e), "{}", text);
    }

    /// Columns of frames that name a ball each are of these balls, and the hits on the floor are
    /// counted beside them.
    #[test]
    fn frames_of_several_balls_stand_side_by_side(
        one in 0.8..0.9_f64,
        other in 0.6..0.7_f64,
        (rate, hit, names) in prop::sample::select(vec![
            ("Filmed with 240 frames in a second", "hit on the floor no.", ["golf ball (frame)", "tennis ball (frame)"]),
            ("Video in 240 Bilder/s", "hit on the floor no.", ["golf ball (frame)", "hockey ball (frame)"]),
        ]),
    ) {
        let frame = |from: f64, e: f64, k: i32| (from + 240.0 * 0.9 * (1.0 - e.powi(k)) / (1.0 - e)).round();
        let row = |k: i32| format!("{};{};{}\n", k + 1, frame(100.0, one, k), frame(150.0, other, k));
        let text = format!("{rate};;\n{hit};{};{}\n{}", names[0], names[1], (0..7).map(row).collect::<String>());
        let found = groups(&text);
        prop_assert!(found.len() == 2 && near(found[0], one) && near(found[1], other), "{:?} {}", found, text);
    }

    /// Hundredths of the drop height say so in front of the sign, and bear it before the number.
    #[test]
    fn hundredths_say_of_what_they_are_before_the_sign(
        e in 0.6..0.85_f64,
        (drop, rebound) in prop::sample::select(vec![
            ("Bırakma yüksekliği (cm)", "Sıçrama (bırakma yüksekliğinin %'si)"),
            ("Drop height (cm)", "Rebound (% of the drop height)"),
        ]),
        before in any::<bool>(),
    ) {
        let row = |(n, h): (usize, f64)| {
            let part = 100.0 * e * e * (1.0 + off(n));
            if before { format!("{h};%{part:.1}\n") } else { format!("{h};{part:.1}\n") }
        };
        let rows: String = [60.0, 80.0, 110.0, 140.0, 180.0].into_iter().enumerate().map(row).collect();
        let text = format!("{drop};{rebound}\n{rows}");
        prop_assert!(near(trusted(&text), e), "{}", text);
    }

    /// The tables of a wiki whose names stand behind `^`, a page whose number stands below its
    /// table, and energies at the highest point.
    #[test]
    fn other_pages_hold_tables_too(e in 0.6..0.85_f64) {
        let rows: String = drops(e, " | ").lines().map(|line| format!("| {line} |\n")).collect();
        let wiki = format!("==== Rubber ball ====\n\n^ no. ^ Drop height (cm) ^ Rebound height (cm) ^\n{rows}");
        prop_assert!(near(trusted(&wiki), e), "{}", wiki);
        let rows: String = drops(e, "          ").lines().map(|line| line.replacen(' ', ".", 1) + "\n").collect();
        let page = format!("Table 4: a wooden ball\n\nn. m.   drop height   rebound height\n          [cm]          [cm]\n{rows}\n                    3 / 7\n");
        prop_assert!(near(trusted(&page), e), "{}", page);
        let energy = format!("n;Energía al soltar (J);Energía en el punto más alto (J)\n{}", drops(e, ";"));
        prop_assert!(near(trusted(&energy), e), "{}", energy);
    }

    /// Marks of notes that stand raised at numbers are no part of them.
    #[test]
    fn raised_marks_are_no_part_of_numbers(e in 0.6..0.85_f64, mark in prop::sample::select(vec!["a", "*", "(b)"])) {
        let row = |k: i32| {
            let note = if k == 2 { format!("<sup>{mark}</sup>") } else { String::new() };
            format!("<tr><td>bounce {k}</td><td>{:.1}{note}</td></tr>", 190.0 * e.powi(2 * k))
        };
        let rows: String = (1..6).map(row).collect();
        let text = format!("<html><body><table><caption>Height of the ball (cm)</caption><tr><td>release</td><td>190<sup>{mark}</sup></td></tr>{rows}</table></body></html>");
        let table = Table::parse("page.html", text.as_bytes(), &ReadOptions::default()).unwrap();
        let report = Fit::new().run(&table).unwrap();
        prop_assert!(near(report.cor().unwrap().value, e), "{} {}", report, text);
    }

    /// Where the line says no more than the unit of all, it is that of the rows of several balls.
    #[test]
    fn a_named_unit_is_that_of_all(e in 0.6..0.85_f64, line in prop::sample::select(vec!["단위는 모두 cm", "単位はすべてcm", "all units cm"])) {
        let up = |k: i32| 160.0 * e.powi(2 * k);
        let row = |k: i32| format!("| height of bounce {k} | {:.1} | {:.1} |\n", up(k), up(k));
        let text = format!("{line}\n\n|   | golf ball | tennis ball |\n|:--|--:|--:|\n| release height | 160 | 160 |\n{}", (1..6).map(row).collect::<String>());
        let found = groups(&text);
        prop_assert!(found.len() == 2 && found.iter().all(|cor| near(*cor, e)), "{:?} {}", found, text);
    }

    /// What a ball came up to is lower than where it was let go: where `to` is higher, nothing is
    /// taken for a rebound.
    #[test]
    fn what_leads_upwards_is_no_rebound(e in 0.6..0.85_f64) {
        let row = |h: f64| format!("{:.1};{h}\n", h * e * e);
        let rows: String = [80.0, 120.0, 160.0, 200.0].into_iter().map(row).collect();
        let text = format!("A ball bounces\nzorb from (cm);zorb to (cm)\n{rows}");
        let table = Table::parse("table.csv", text.as_bytes(), &ReadOptions::default());
        let trusted = table.is_ok_and(|table| Fit::new().run(&table).is_ok_and(|report| report.verdict() == Verdict::Trusted));
        prop_assert!(!trusted, "{}", text);
    }
}
