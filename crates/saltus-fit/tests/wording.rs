//! What lines above a table, lists and sheets say of numbers whose names say little: units of all
//! speeds and times, letters that count, the floor's own row, copies of a sheet.

use crate::typed::{fit, read, trusted};
use crate::written::xlsx;
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{ReadOptions, Table};

fn near(found: f64, e: f64, by: f64) -> bool {
    (found - e).abs() < by
}

/// Scatter of the drop `n`, a part of its height.
fn off(n: usize) -> f64 {
    [0.004, -0.007, 0.001, 0.008, -0.005, 0.0, -0.002][n % 7]
}

/// Rows of a drop and three rebounds of the same COR, cm.
fn repeats(e: f64) -> String {
    let row = |(n, h): (usize, f64)| {
        let cell = |k: usize| format!("{:.1}", h * e * e * (1.0 + off(n + 2 * k)));
        format!("{h};{};{};{}\n", cell(0), cell(1), cell(2))
    };
    [80.0, 120.0, 160.0, 200.0].into_iter().enumerate().map(row).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// Small letters and small Roman numbers behind one name count what is level, and units that a
    /// line states of all lengths are theirs.
    #[test]
    fn letters_behind_one_name_count_repeats(
        e in 0.5..0.85_f64,
        header in prop::sample::select(vec![
            "Fallhöhe;Rücksprung a;Rücksprung b;Rücksprung c", "hauteur de chute;rebond (i);rebond (ii);rebond (iii)",
            "Valhoogte;Terugstuit i;Terugstuit ii;Terugstuit iii", "Drop height;Rebound a;Rebound b;Rebound c",
        ]),
        line in prop::sample::select(vec!["All lengths in cm", "Alle Längen in cm", "toutes les longueurs en cm"]),
    ) {
        let text = format!("{line}\n{header}\n{}", repeats(e));
        prop_assert!(near(trusted(&text), e, 0.01), "{}", text);
    }

    /// A name of a rebound above numbers that are not whole counts nothing.
    #[test]
    fn rebounds_that_are_not_whole_are_heights(
        e in 0.5..0.85_f64,
        (line, header) in prop::sample::select(vec![
            ("alturas en metros", "caída;rebote"), ("altezze in metri", "caduta;rimbalzo"),
            ("alturas em metros", "queda;ressalto"), ("hauteurs en m", "chute;rebond"),
        ]),
    ) {
        let row = |(n, h): (usize, f64)| format!("{h};{:.3}\n", h * e * e * (1.0 + off(n)));
        let rows: String = [0.9, 1.1, 1.4, 1.7, 2.1].into_iter().enumerate().map(row).collect();
        let text = format!("{line}\n{header}\n{rows}");
        prop_assert!(near(trusted(&text), e, 0.01), "{}", text);
    }

    /// Columns that say no more than before and after are speeds below a line with their unit.
    #[test]
    fn before_and_after_are_what_a_line_says(
        e in 0.5..0.85_f64,
        (line, header) in prop::sample::select(vec![
            ("Speeds of the ball at the floor, in m/s", "trial;before;after"),
            ("Vitesses de la balle au sol, en m/s", "essai;avant;après"),
            ("Velocità della palla al pavimento, in m/s", "prova;prima;dopo"),
        ]),
    ) {
        let row = |n: usize| format!("{n};{:.3};{:.3}\n", 4.2 + 0.1 * n as f64, (4.2 + 0.1 * n as f64) * e * (1.0 + off(n)));
        let rows: String = (1..8).map(row).collect();
        let report = fit(&format!("{line}\n{header}\n{rows}"));
        prop_assert!(near(report.cor().unwrap().value, e, 0.01), "{}", report);
        // Without the line they may be heights.
        let bare = format!("{header}\n{rows}");
        prop_assert!(read(&bare).is_err(), "{}", bare);
    }

    /// Names in the first column that bear units of speed turn a table over.
    #[test]
    fn speeds_in_rows_are_of_the_trials_above(
        e in 0.5..0.85_f64,
        names in prop::sample::select(vec![
            ("Speed before impact (m/s)", "Speed after impact (m/s)", "Run"),
            ("Vitesse avant le choc (m/s)", "Vitesse après le choc (m/s)", "Essai"),
            ("Geschwindigkeit vor dem Aufprall (m/s)", "Geschwindigkeit nach dem Aufprall (m/s)", "Messung"),
        ]),
    ) {
        let line = |name: &str, cell: &dyn Fn(usize) -> f64| {
            (1..7).fold(name.to_owned(), |line, n| format!("{line}\t{:.3}", cell(n))) + "\n"
        };
        let head = (1..7).fold(String::new(), |line, n| format!("{line}\t{} #{n}", names.2)) + "\n";
        let before = |n: usize| -(4.0 + 0.1 * n as f64);
        let after = |n: usize| -before(n) * e * (1.0 + off(n));
        let text = head + &line(names.0, &before) + &line(names.1, &after);
        prop_assert!(near(trusted(&text), e, 0.01), "{}", text);
    }

    /// The unit in a bracket at the end of a title is that of what stands below it.
    #[test]
    fn brackets_of_a_title_name_the_unit(
        e in 0.6..0.85_f64,
        title in prop::sample::select(vec![
            "Flight times of the ball (unit: s)", "Flugzeiten des Balls (Einheit: s)", "ボールの滞空時間（単位：秒）",
        ]),
        nth in prop::sample::select(vec!["bounce ", "Aufprall ", "バウンド"]),
    ) {
        let names: String = (1..5).map(|n| format!(";{nth}{n}")).collect();
        let row = |n: usize| (1..5).fold(format!("{n}"), |line, k| format!("{line};{:.4}", 0.9 * e.powi(k) * (1.0 + 0.2 * off(n + k as usize))));
        let rows: String = (1..5).map(|n| row(n) + "\n").collect();
        let text = format!("{title}\ntrial{names}\n{rows}");
        prop_assert!(near(fit(&text).cor().unwrap().value, e, 0.01), "{}", text);
    }

    /// From what height a ball fell is where it began, beside how high it came back.
    #[test]
    fn from_what_height_is_the_release(
        e in 0.5..0.85_f64,
        header in prop::sample::select(vec![
            "from what height (cm);how high it bounced (cm)", "aus welcher Höhe (cm);Wie hoch zurückgesprungen (cm)",
            "z jaké výšky (cm);jak vysoko vyskočil (cm)",
        ]),
    ) {
        let row = |(n, h): (usize, f64)| format!("{h};{:.1}\n", h * e * e * (1.0 + off(n)));
        let rows: String = [80.0, 100.0, 130.0, 160.0, 190.0].into_iter().enumerate().map(row).collect();
        let text = format!("{header}\n{rows}");
        prop_assert!(near(trusted(&text), e, 0.01), "{}", text);
    }

    /// Times of flights may be a counted list, and times of contacts a list of names and clocks.
    #[test]
    fn times_may_be_a_list(
        e in 0.7..0.9_f64,
        line in prop::sample::select(vec![
            "Time in the air between two bounces:", "Zeit in der Luft zwischen zwei Aufprallen:",
            "temps en l'air entre deux rebonds :",
        ]),
        hit in prop::sample::select(vec!["hit", "Aufprall", "choc", "stuit"]),
    ) {
        let flights: Vec<f64> = (0..6).map(|n| 0.8 * e.powi(n) * (1.0 + 0.3 * off(n as usize))).collect();
        let list: String = flights.iter().enumerate().map(|(n, t)| format!("{}. {t:.3} s\n", n + 1)).collect();
        let report = fit(&format!("{line}\n\n{list}\nthen a dog barked\n"));
        prop_assert!(near(report.cor().unwrap().value, e, 0.01), "{}", report);
        let mut at = 12.345;
        let mut log = "Phone log\n\n".to_owned();
        for (n, lasts) in flights.iter().chain(&[0.0]).enumerate() {
            log += &format!("{hit} {}   09:41:{}\n", n + 1, format!("{at:06.3}").replace('.', ","));
            at += lasts;
        }
        let report = fit(&log);
        prop_assert!(near(report.cor().unwrap().value, e, 0.01), "{}\n{}", log, report);
    }

    /// A length that a sentence states of the floor is taken in by the row that reads it there.
    #[test]
    fn the_row_of_the_floor_takes_its_length_in(
        e in 0.5..0.85_f64,
        zero in prop::sample::select(vec![5.0, 8.5, 20.0]),
        (sentence, names) in prop::sample::select(vec![
            ("The ruler stands on a step, and we read ZERO cm where the floor is", ["let go", "top of bounce", "floor"]),
            ("Das Maßband hängt schief, der Boden liest sich als ZERO cm", ["Abwurf", "Aufprall", "Boden"]),
        ]),
    ) {
        let mut text = format!("{}\n\n;height (cm)\n", sentence.replace("ZERO", &format!("{zero:.1}")));
        text += &format!("{};{:.1}\n", names[0], 150.0 + zero);
        for n in 1..5 {
            text += &format!("{} {n};{:.1}\n", names[1], 150.0 * e.powi(2 * n) + zero);
        }
        text += &format!("{};{zero:.1}\n", names[2]);
        let report = fit(&text);
        prop_assert!(near(report.cor().unwrap().value, e, 0.01) && !report.to_string().contains("no reading takes in"), "{}", report);
    }

    /// Sheets whose rebounds are the same from other drops are copies, of which one is wrong; those
    /// of two balls are not.
    #[test]
    fn the_same_rebounds_from_other_drops_are_a_question(e in 0.6..0.8_f64, wrong in 1.1..1.4_f64) {
        let sheet = |drop: f64, cor: f64, from: usize| {
            let mut rows = vec![vec!["trial".to_owned(), "drop height (cm)".to_owned(), "rebound (cm)".to_owned()]];
            let cell = |n: usize| format!("{:.1}", 150.0 * cor * cor * (1.0 + off(n + from)));
            rows.extend((0..7).map(|n| vec![(n + 1).to_string(), format!("{drop:.0}"), cell(n)]));
            rows
        };
        let parse = |sheets: &[(&str, Vec<Vec<String>>)]| Table::parse("b.xlsx", &xlsx(sheets), &ReadOptions::default());
        let copies = [("draft", sheet(150.0, e, 0)), ("clean", sheet(150.0 / wrong, e, 0))];
        let error = parse(&copies).unwrap_err();
        prop_assert!(error.is_question() && error.to_string().contains("--sheet"), "{}", error);
        prop_assert!(parse(&[("golf", sheet(150.0, e, 0)), ("marble", sheet(150.0, e + 0.05, 1))]).is_ok());
    }

    /// A range with a unit and a question mark above a column asks something, and is no number.
    #[test]
    fn what_a_column_asks_is_no_number(e in 0.6..0.8_f64, asks in prop::sample::select(vec!["50-60 cm?", "40-55 in ?"])) {
        let rows: String = (0..5).map(|n| format!("{n};{:.1};yes\n", 120.0 * e * e * (1.0 + off(n)))).collect();
        let text = format!("Drop height: 120 cm\nSample;Rebound (cm);{asks}\n{rows}");
        prop_assert!(near(trusted(&text), e, 0.01), "{}", text);
    }
}

/// Units are words in every language that a title may be written in.
#[test]
fn units_are_words_of_every_language() {
    for unit in ["santimetre", "centymetry", "centimetry", "сантиметры", "senttimetri", "センチ", "센티미터"]
    {
        let text = format!("bounce;height ({unit})\n0;100\n1;64\n2;41\n3;26.2\n");
        assert!(near(fit(&text).cor().unwrap().value, 0.8, 0.005), "{unit}");
    }
}

/// A remark that its row does not count takes it out, in the words of many languages.
#[test]
fn rows_that_do_not_count_are_left_out() {
    for said in [
        "hit the net, do not use",
        "nicht werten, Netz berührt",
        "zählt nicht",
        "a touché le filet, ne pas compter",
        "tocó la red, no contar",
        "toccata la rete, non contare",
        "tocou na rede, não contar",
        "net geraakt, niet meetellen",
        "telt niet",
        "nuddade nätet, räkna ej",
        "ramte nettet, tæller ikke",
        "traff nettet, teller ikke",
        "dotknęła siatki, nie liczyć",
        "trefil síť, nepočítat",
        "ağa değdi, sayma",
        "задел сетку, не считать",
    ] {
        let row = |n: usize| {
            let h = 80.0 + 20.0 * (n / 2) as f64;
            let (high, note) = if n == 4 { (0.3 * h, said) } else { (h * 0.5625 * (1.0 + off(n)), "") };
            format!("{h:.0};{high:.1};\"{note}\"\n")
        };
        let text = format!("drop height (cm);rebound height (cm);remark\n{}", (0..8).map(row).collect::<String>());
        assert!(near(trusted(&text), 0.75, 0.01), "{text}");
    }
}

/// Drops that a sign counts, `#1`, count no bounces, whatever the release is called; and a test is
/// called before a colon what it may be.
#[test]
fn names_of_drops_and_tests_count_nothing() {
    for (drop, start) in [("Drop", "Start"), ("Drop", "Release"), ("Throw", "Start"), ("Trial", "h0")] {
        let row = |n: usize| {
            let high = |k: i32| 64.0 * 0.77_f64.powi(2 * k) * (1.0 + off(n + k as usize));
            format!("#{}\t64\t{:.1}\t{:.1}\t{:.1}\n", n + 1, high(1), high(2), high(3))
        };
        let rows = (0..5).map(row).collect::<String>();
        let text = format!("Rubber ball, all in inches\n\n{drop}\t{start}\tBounce 1\tBounce 2\tBounce 3\n{rows}");
        assert!(near(trusted(&text), 0.77, 0.01), "{text}");
    }
    for title in
        ["SQUASH BALL TEST (WSF method): dropped from 254 cm on concrete", "Ball test (XYZ): drop height 254 cm"]
    {
        let row = |n: usize| format!("{}\t{:.1}\n", n + 1, 254.0 * 0.29 * (1.0 + off(n)));
        let text = format!("{title}\n\nNo.\tRebound [cm]\n{}", (0..9).map(row).collect::<String>());
        assert!(near(trusted(&text), 0.29_f64.sqrt(), 0.01), "{text}");
    }
}

/// What is to be taken off all readings is, and what is of one end of the ball off those that are
/// read there, by the size that is stated.
#[test]
fn a_stated_correction_is_taken_off() {
    let table = |said: &str, header: &str, off_drop: f64, off_rebound: f64| {
        let row = |n: usize| {
            let h = 100.0 + 25.0 * n as f64;
            format!("{};{:.1};{:.1}\n", n + 1, h + off_drop, h * 0.64 * (1.0 + off(n)) + off_rebound)
        };
        format!("{said}\n\n{header}\n{}", (0..6).map(row).collect::<String>())
    };
    for said in [
        "NB: the ball bounces on a bench whose surface is at the 6.5 cm mark. Readings NOT corrected.",
        "The ruler reads 6.5 cm at the floor",
        "Subtract 6.5 cm from all heights",
        "Von allen Höhen sind 6,5 cm abzuziehen",
        "soustraire 6,5 cm de toutes les hauteurs",
        "restar 6,5 cm a todas las alturas",
        "sottrarre 6,5 cm da tutte le altezze",
        "subtrair 6,5 cm de todas as alturas",
        "6,5 cm aftrekken van alle hoogten",
    ] {
        let text = table(said, "drop;drop height (cm);rebound height (cm)", 6.5, 6.5);
        assert!(near(trusted(&text), 0.8, 0.01), "{text}");
    }
    for (said, header) in [
        (
            "Drop: measured to the BOTTOM of the ball.\nRebound: measured to the TOP of the ball (diameter 6.6 cm). Not corrected.",
            "drop;drop bottom (cm);rebound top of ball (cm)",
        ),
        (
            "Drop height to the underside of the ball. Rebound height to the top of the ball. Ball diameter 66 mm",
            "drop;drop height (cm);rebound height (cm)",
        ),
    ] {
        let text = table(said, header, 0.0, 6.6);
        assert!(near(trusted(&text), 0.8, 0.01), "{text}");
    }
    // How large the ball is, nobody says.
    let said = "Drop height to the underside of the ball. Rebound height to the top of the ball";
    let text = table(said, "drop;drop height (cm);rebound height (cm)", 0.0, 6.6);
    assert_ne!(fit(&text).verdict(), saltus_fit::Verdict::Trusted, "{text}");
}

/// The flight between the first contacts, whatever joins their numbers.
#[test]
fn numbers_of_contacts_are_joined_in_many_languages() {
    for name in [
        "time between 1st and 2nd bounce (s)",
        "Zeit zwischen 1. und 2. Aufprall (s)",
        "temps entre le 1er et le 2e rebond (s)",
        "tiempo entre el 1º y el 2º rebote (s)",
        "tempo tra il 1º e il 2º rimbalzo (s)",
        "tempo entre o 1º e o 2º ressalto (s)",
        "tijd tussen 1e en 2e stuit (s)",
        "tid mellan 1:a och 2:a studsen (s)",
        "tid mellem 1. og 2. hop (s)",
        "czas między 1. i 2. odbiciem (s)",
        "čas mezi 1. a 2. odrazem (s)",
        "1. ve 2. sekme arasındaki süre (s)",
        "время между 1-м и 2-м ударом (с)",
    ] {
        let row = |n: usize| {
            let h = 60.0 + 20.0 * (n / 2) as f64;
            format!("{};{h:.0};{:.3}\n", n + 1, 2.0 * 0.74 * (2.0 * h / 981.0).sqrt() * (1.0 + 0.3 * off(n)))
        };
        let text = format!("no;drop height (cm);{name}\n{}", (0..8).map(row).collect::<String>());
        assert!(near(trusted(&text), 0.74, 0.01), "{text}");
    }
}
