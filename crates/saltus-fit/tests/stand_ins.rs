//! Columns that stand for heights or times: energies, speeds of one side, samples of a sound, the
//! moments of tops. Balls of any COR are planted, and what is made of them is read.

use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Table, Verdict};

/// Rows below a header.
fn table(header: &str, rows: impl IntoIterator<Item = String>) -> String {
    rows.into_iter().fold(format!("{header}\n"), |text, row| text + &row + "\n")
}

/// The times of the contacts of a ball dropped from `drop` at 0 s.
fn contacts(drop: f64, e: f64, count: i32) -> Vec<f64> {
    let fall = (2.0 * drop / 9.81f64).sqrt();
    (0..count).map(|n| fall + 2.0 * fall * (1..=n).map(|k| e.powi(k)).sum::<f64>()).collect()
}

/// The mass, and the energies before and after a bounce.
const MASSES: &[(&str, &str, &str)] = &[
    ("Mass of ball", "PE at the top", "KE just after bounce"),
    ("Masa piłki", "E przed odbiciem", "E po odbiciu"),
    ("Masse de la balle", "Énergie avant rebond", "Énergie après rebond"),
    ("massa", "Energia potencial antes", "Energia potencial depois do ressalto"),
    ("hmotnost", "energie před odrazem", "energie po odrazu"),
    ("Bollens massa", "Rörelseenergi före studs", "Rörelseenergi efter studs"),
    ("top kütlesi", "Çarpmadan önce enerji", "Çarpmadan sonra enerji"),
    ("masa", "Energía cinética antes del rebote", "Energía cinética después del rebote"),
    ("Drop", "PE at release", "PE at max rebound height"),
];

/// What says nothing of a bounce by itself, the power of the COR in it, and whether it stands in
/// two columns.
const ALONE: &[(&str, i32, bool)] = &[
    ("Before (cm),After (cm)", 2, true),
    ("Altura inicial (cm),1ª medida (cm)", 2, true),
    ("Höjd före (cm),Höjd efter (cm)", 2, true),
    ("E_pot vorher (J),E_pot nachher (J)", 2, true),
    ("interval,time (s)", 1, false),
    ("interval,tijd (s)", 1, false),
];

/// What energies before and after a bounce are called.
const SIDES: &[(&str, &str)] = &[
    ("Potential energy at drop (mJ)", "Potential energy at rebound (mJ)"),
    ("Kinetic energy before impact (J)", "Kinetic energy after impact (J)"),
    ("Energie vor dem Stoß (mJ)", "Energie nach dem Stoß (mJ)"),
    ("PE before (J)", "PE after (J)"),
    ("Initial energy (J)", "Final energy (J)"),
    ("KE in (mJ)", "KE after (mJ)"),
    ("E1 before (mJ)", "E2 after (mJ)"),
    ("Énergie potentielle avant (J)", "Énergie potentielle après (J)"),
    ("Energía inicial (J)", "Energía final (J)"),
];

/// Of so many of them the names say that something bounces.
const SAID: usize = 3;

/// Headings of what carts, jumpers, lamps and pendulums have as well as balls; how the numbers fall
/// from row to row, or from one column to the next; and whether they do the latter.
const ANYTHING: &[(&str, i32, bool)] = &[
    ("KE before (J),KE after (J)", 2, true),
    ("Energy before (J),Energy after (J)", 2, true),
    ("Height before (cm),Height after (cm)", 2, true),
    ("Initial height (cm),Final height (cm)", 2, true),
    ("v before (m/s),v after (m/s)", 1, true),
    ("Lap,Time (s)", 1, false),
    ("Jump,Air time (s)", 1, false),
    ("n,T (s)", 1, false),
    ("Interval,Duration (s)", 1, false),
    ("n,Energy (J)", 2, false),
    ("n,h (cm)", 2, false),
    ("#,Height (cm)", 2, false),
];

/// Where a table may say that something bounces: above it, in a comment, in the name of a column
/// that is left aside, in a remark.
const SAYS: &[fn(&str) -> String] = &[
    |table| format!("Bouncing ball\n{table}"),
    |table| format!("# dropped on wood\n{table}"),
    |table| format!("{table}\nThe rebounds of a golf ball\n"),
];

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(32), failure_persistence: None, ..ProptestConfig::default() })]

    /// Before and after a bounce, whatever the mass: the ratio of energies is e².
    #[test]
    fn energies_before_and_after(e in 0.4f64..0.9, mass in 0.005f64..0.6, sides in 0..SIDES.len()) {
        let (before, after) = SIDES[sides];
        let unit = if before.contains("mJ") { 1e3 } else { 1.0 };
        let rows = [0.5, 1.0, 1.5, 2.0].map(|h: f64| {
            let energy = unit * mass * 9.81 * h;
            format!("{energy:.6},{:.6}", energy * e * e)
        });
        let of = |header: String| trusted(&table(&header, rows.clone()));
        let header = format!("{before},{after}");
        let alone = of(if sides < SAID { header } else { format!("Bouncing ball\n{header}") });
        prop_assert!((alone - e).abs() < 1e-3);
        // Beside the heights they are from they are left aside, whatever they say.
        let rows = [0.5, 1.0, 1.5, 2.0].map(|h: f64| format!("{h},{:.5},{:.4},{:.4}", h * e * e, 9.0 * h, 2.0 * h));
        let heights = fit(&table(&format!("Drop (m),Rebound (m),{before},{after}"), rows));
        prop_assert!((heights.cor().unwrap().value - e).abs() < 1e-3, "{}", heights);
        prop_assert_eq!(heights.left_aside().len(), 2);
    }

    /// What may be of anything is read and doubted, until the table says that something bounces.
    #[test]
    fn what_may_be_of_anything_is_not_trusted(
        e in 0.6f64..0.9, first in 0.3f64..3.0, anything in 0..ANYTHING.len(), says in 0..SAYS.len(),
    ) {
        let (header, power, side) = ANYTHING[anything];
        let part = e.powi(power);
        let rows = (0..5).map(|n| match side {
            true => format!("{:.4},{:.4}", 100.0 * first * f64::from(n + 1), 100.0 * part * first * f64::from(n + 1)),
            false => format!("{},{:.4}", n + 1, first * part.powi(n)),
        });
        let text = table(header, rows);
        let report = fit(&text);
        prop_assert!((report.cor().unwrap().value - e).abs() < 4e-3, "{}{}", text, report);
        prop_assert_eq!(report.verdict(), Verdict::Doubtful, "{}{}", text, report);
        prop_assert!(report.reason().contains("something bounces"), "{}", report);
        // The name of the file says it too, that of its folder does not.
        for (name, named) in [("bouncing-ball.csv", true), ("a/Drop 3.txt", true), ("drops/run3.csv", false)] {
            let table = Table::parse(name, text.as_bytes(), &ReadOptions::default()).unwrap();
            let report = Fit::new().run(&table).unwrap();
            prop_assert_eq!(!report.reason().contains("something bounces"), named, "{} {}", name, report);
        }
        let said = fit(&SAYS[says](&text));
        prop_assert!((said.cor().unwrap().value - e).abs() < 4e-3, "{}{}", text, said);
        prop_assert!(!said.reason().contains("something bounces"), "{}", said);
    }

    /// The energy of a row that is none after a bounce is that before it, in any language, whatever
    /// stands below the table of the ball itself, and beside one height.
    #[test]
    fn energies_of_a_ball_of_some_mass(e in 0.55f64..0.9, grams in 3u32..600, words in 0..MASSES.len(), below: bool, high: bool) {
        let (mass, before, after) = MASSES[words];
        let line = format!("{mass} (g),{grams}\n");
        let rows = [0.5, 0.8, 1.2, 1.5, 2.0].map(|h: f64| {
            let energy = f64::from(grams) * 9.81 * h;
            format!("{}{energy:.4},{:.4}", if high { format!("{h},") } else { String::new() }, energy * e * e)
        });
        let header = format!("{}{before} (mJ),{after} (mJ)", if high { "height (m)," } else { "" });
        let text = table(&header, rows);
        let text = if below { text + &line } else { line + &text };
        prop_assert!((trusted(&text) - e).abs() < 1e-3, "{}", text);
    }

    /// Where a ball is named its numbers may say that it bounces: all of a height, an energy, or a
    /// flight keep one part. Numbers at random do not, and those of a collision may be of another
    /// ball.
    #[test]
    fn numbers_of_a_ball_may_say_that_it_bounces(
        e in 0.5f64..0.93, form in 0..ALONE.len(), ball in prop::sample::select(vec!["Golf ball", "Pelota", "Stalen kogel", "Piłka", "Labda"]),
        off in prop::collection::vec(0.2f64..1.0, 6),
    ) {
        let (header, power, side) = ALONE[form];
        let text = |off: &dyn Fn(i32) -> f64| {
            let part = |n: i32| e.powi(power) * off(n);
            let row = |n: i32| match side {
                true => format!("{:.4},{:.4}", 50.0 * f64::from(n + 1), 50.0 * part(n) * f64::from(n + 1)),
                false => format!("{},{:.4}", n + 1, 1.5 * (0..n).map(part).product::<f64>()),
            };
            format!("{ball}\n{}", table(header, (0..6).map(row)))
        };
        // No ball keeps a factor to the last digit.
        let kept = |n: i32| 1.0 + 3e-4 * f64::from(n).sin();
        let report = fit(&text(&kept));
        prop_assert!((report.cor().unwrap().value - e).abs() < 4e-3, "{}", report);
        prop_assert_eq!(report.verdict(), Verdict::Trusted, "{}", report);
        let scatter = off.iter().cloned().fold(0.0, f64::max) / off.iter().cloned().fold(1.0, f64::min);
        if scatter > 1.5 && let Ok(table) = read(&text(&|n| off[usize::try_from(n).unwrap()])) {
            let verdict = Fit::new().run(&table).map(|report| report.verdict());
            prop_assert!(verdict != Ok(Verdict::Trusted), "{:?}", off);
        }
        let players = text(&kept).replacen('\n', " players zorb\n", 1);
        prop_assert!(fit(&players).reason().contains("something bounces"), "{}", players);
        let report = fit(&format!("Collision\n{}", text(&kept)));
        prop_assert!(report.reason().contains("something bounces"), "{}", report);
    }

    /// Bounce by bounce, of the tops or of the impacts.
    #[test]
    fn energies_and_speeds_bounce_by_bounce(e in 0.6f64..0.9, mass in 0.005f64..0.6) {
        for (header, first, power) in [
            ("Bounce,Potential energy (J)", 0, 2),
            ("Bounce,Kinetic energy at impact (J)", 1, 2),
            ("Impact,Speed at impact (m/s)", 1, 1),
        ] {
            let rows = (0..6).map(|n| format!("{},{:.6}", n + first, 9.0 * mass.powi(power - 1) * e.powi(power * n)));
            prop_assert!((trusted(&table(header, rows)) - e).abs() < 1e-3, "{}", header);
        }
    }

    /// Hundredths that are kept, or lost, of the energy are those of the height.
    #[test]
    fn parts_of_the_energy(e in 0.4f64..0.9) {
        for (header, part) in [
            ("Drop height (cm),Energy retained (%)", 100.0 * e * e),
            ("Drop height (cm),Energy lost (%)", 100.0 * (1.0 - e * e)),
            ("Drop height (cm),Fraction of height recovered", e * e),
            ("Bounce test\nTrial,Energy lost (%)", 100.0 * (1.0 - e * e)),
            ("Bounce test\nTrial,Energy retained (%)", 100.0 * e * e),
        ] {
            let rows = [60, 80, 100, 120].map(|h| format!("{h},{part:.4}"));
            prop_assert!((trusted(&table(header, rows)) - e).abs() < 1e-3, "{}", header);
        }
    }

    /// Parts that fall from bounce to bounce are of the first height, with its row or without.
    #[test]
    fn parts_of_the_first_height(e in 0.6f64..0.9, first in 0i32..2) {
        for header in ["Bounce,Energy (%)", "Bounce,Energy retained (%)", "Bounce,Height ratio"] {
            let whole = if header.contains('%') { 100.0 } else { 1.0 };
            let rows = (first..5).map(|n| format!("{n},{:.5}", whole * e.powi(2 * n)));
            prop_assert!((trusted(&table(header, rows)) - e).abs() < 1e-3, "{}", header);
        }
    }

    /// A plain height beside that of a bounce, above it in every row, is where the ball was
    /// dropped.
    #[test]
    fn a_plain_height_beside_a_bounce(e in 0.4f64..0.9) {
        let rows = [60, 80, 100, 120].map(|h| format!("{h},{:.2}", f64::from(h) * e * e));
        prop_assert!((trusted(&table("Height (cm),Bounce (cm)", rows)) - e).abs() < 1e-3);
    }

    /// Symbols of what was before and after: `u` and `v`, a prime, `i` and `f`.
    #[test]
    fn symbols_of_before_and_after(e in 0.4f64..0.9) {
        for (header, power) in
            [("u (m/s),v (m/s)", 1), ("v (m/s),v' (m/s)", 1), ("vi (m/s),vf (m/s)", 1), ("h (cm),h' (cm)", 2), ("hi (cm),hf (cm)", 2)]
        {
            let rows = [3.0, 4.0, 5.0, 6.0].map(|v: f64| format!("{v},{:.4}", v * e.powi(power)));
            prop_assert!((fit(&table(header, rows)).cor().unwrap().value - e).abs() < 2e-3, "{}", header);
        }
    }

    /// Columns of one name beside a height of release are repeats where they are level; trials take
    /// the unit that the cells of the release bear; an error may stand behind a name.
    #[test]
    fn repeats_beside_a_release(e in 0.4f64..0.9) {
        for (header, unit) in [
            ("Drop (cm),Rebound (cm),Rebound (cm),Rebound (cm)", ""),
            ("Drop height,Trial 1,Trial 2,Trial 3", " cm"),
            ("Drop (cm),T1 (cm),T2 (cm),T3 (cm)", ""),
            ("Drop (cm) ± 0.5,R1 (cm) ± 1,R2 (cm) ± 1,R3 (cm) ± 1", ""),
        ] {
            let rows = [60, 80, 100, 120].map(|h| {
                let rebound = f64::from(h) * e * e;
                format!("{h}{unit},{:.2},{:.2},{:.2}", rebound, 1.01 * rebound, 0.99 * rebound)
            });
            let report = fit(&table(header, rows));
            prop_assert!((report.cor().unwrap().value - e).abs() < 3e-3, "{}{}", header, report);
        }
    }

    /// Lines of a name and a number each, words among them being remarks.
    #[test]
    fn lines_of_names_and_numbers(e in 0.4f64..0.9, equals: bool, remark: bool) {
        let mark = if equals { " = " } else if remark { ": " } else { " - " };
        let mut text = if remark { "Ball: golf\nPlace: gym\n".to_owned() } else { String::new() };
        for (n, name) in ["h0", "h1", "h2", "h3"].into_iter().enumerate() {
            text += &format!("{name}{mark}{:.2} cm\n", 100.0 * e.powi(2 * n as i32));
        }
        let report = fit(&text);
        prop_assert!((report.cor().unwrap().value - e).abs() < 3e-3, "{}{}", text, report);
    }

    /// Cells that two blanks or more part, below names that are underlined or not.
    #[test]
    fn tables_are_aligned_by_blanks(e in 0.4f64..0.9, ruled: bool, comma: bool, words: bool) {
        let mut text = "Ball no.     Drop (cm)   Rebound (cm)\n".to_owned();
        if ruled {
            text += "--------     ---------   ------------\n";
        }
        for (n, h) in [60.0, 80.0, 100.0, 120.0].into_iter().enumerate() {
            let ball = if words { "n/a".to_owned() } else { (n + 1).to_string() };
            text += &format!("{ball}            {h:.1}        {:.2}\n", h * e * e);
        }
        let text = if comma { text.replace("0.", "0,").replace('.', ",").replace("no,", "no.") } else { text };
        let text = text.replace("Ball no.", "Trial   ");
        let report = fit(&text);
        prop_assert!((report.cor().unwrap().value - e).abs() < 1e-3, "{}{}", text, report);
    }

    /// Numbers of samples are times at the rate that is stated, wherever it stands; without one
    /// they are asked for.
    #[test]
    fn samples_of_a_sound(e in 0.6f64..0.9, rate in prop::sample::select(vec![8000, 22050, 44100, 48000, 96000])) {
        let times = contacts(1.0, e, 7);
        let rows = || times.iter().enumerate().map(|(n, t)| format!("{},{}", n + 1, (t * f64::from(rate)).round()));
        for (above, header) in [
            (String::new(), format!("Bounce,Sample ({rate} Hz)")),
            (format!("Recording, {rate} Hz\n"), "Click,Sample number".to_owned()),
            (format!("Sample rate: {} kHz\n", f64::from(rate) / 1000.0), "Impact,Sample".to_owned()),
            (format!("# sampled at {rate} Hz\n"), "Bounce,Sample index".to_owned()),
        ] {
            let text = above + &table(&header, rows());
            let report = fit(&text);
            prop_assert!((report.cor().unwrap().value - e).abs() < 2e-3, "{}{}", text, report);
            // A sample is no error of hearing a contact.
            prop_assert!(!report.to_string().contains("frame"), "{}", report);
        }
        let asked = read(&table("Bounce,Sample number", rows())).unwrap_err();
        prop_assert!(asked.is_question() && asked.to_string().contains("--fps 44100"), "{}", asked);
    }

    /// The moment of a top beside its height is no contact: heights and times agree on one COR.
    #[test]
    fn moments_of_tops(e in 0.6f64..0.9, drop in 0.5f64..2.0) {
        let hits = contacts(drop, e, 7);
        let tops = || (0..6).map(|n| (n + 1, 0.5 * (hits[n] + hits[n + 1]), 100.0 * drop * e.powi(2 * n as i32 + 2)));
        for (header, counted) in [
            ("Peak,Time (s),Height (cm)", true),
            ("Apex no.,t (s),h (cm)", true),
            ("Maximum Nr.,t (s),h (cm)", true),
            ("Bounce,Time of peak (s),Height (cm)", true),
            ("Time of max height (s),Max height (cm)", false),
        ] {
            let rows = tops().map(|(n, t, h)| {
                let row = format!("{t:.3},{h:.1}");
                if counted { format!("{n},{row}") } else { row }
            });
            let text = table(header, rows);
            let report = fit(&text);
            prop_assert!((report.cor().unwrap().value - e).abs() < 4e-3, "{}{}", text, report);
            prop_assert_eq!(report.verdict(), Verdict::Trusted, "{}{}", text, report);
        }
        // Contacts by name stay contacts.
        let rows = hits.iter().enumerate().map(|(n, t)| format!("{},{t:.3},{:.1}", n + 1, 100.0 * drop * e.powi(2 * n as i32 + 2)));
        let report = fit(&table("Bounce,Time of impact (s),Height (cm)", rows));
        prop_assert!((report.cor().unwrap().value - e).abs() < 4e-3 && report.verdict() == Verdict::Trusted, "{}", report);
    }

    /// Rows may be named by the two bounces that a flight lies between.
    #[test]
    fn flights_are_named_by_their_ends(e in 0.6f64..0.9, mark in prop::sample::select(vec!["-", "–", " → ", " to ", " & "])) {
        let times = contacts(1.0, e, 7);
        let rows = times.windows(2).enumerate().map(|(n, w)| format!("{}{mark}{},{:.1}", n + 1, n + 2, 1000.0 * (w[1] - w[0])));
        let report = fit(&table("Bounces,Time between (ms)", rows));
        prop_assert!((report.cor().unwrap().value - e).abs() < 3e-3, "{}", report);
    }
}

/// Hours are no height, and a time counts no bounces, in whatever unit.
#[test]
fn hours_count_no_bounces() {
    for unit in ["(h)", "(min)", "(days)", ""] {
        let text = format!("Time {unit},Bounce height (cm)\n0,60\n1,55\n2,50.5\n3,46\n");
        let report = read(&text).map(|table| Fit::new().run(&table).unwrap());
        assert!(report.is_err() || report.is_ok_and(|report| report.verdict() != Verdict::Trusted), "{text}");
    }
}

/// Heights of one day each are no bounces of one drop; the same day beside all says nothing.
#[test]
fn a_day_each_is_no_bounce() {
    for (name, days) in [("Day", ["0", "1", "2", "3"]), ("Date", ["3 May", "4 May", "5 May", "6 May"])] {
        let rows = |days: [&str; 4]| {
            let heights = ["60", "57", "54", "51"];
            table(
                &format!("{name},Bounce height (cm)"),
                days.into_iter().zip(heights).map(|(day, h)| format!("{day},{h}")),
            )
        };
        let asked = read(&rows(days)).unwrap_err();
        assert!(asked.is_question() && asked.to_string().contains("bounces of one drop"), "{asked}");
        assert!(read(&rows(["5 May"; 4])).is_ok(), "{name}");
    }
}

/// A single energy, or one that is a model's, is no height.
#[test]
fn energies_that_tell_no_cor_are_not_read() {
    for text in [
        "Drop height (m),Energy after bounce (J)\n1,0.36\n2,0.72\n",
        "Trial,Expected PE before (J),Expected PE after (J)\n1,0.57,0.36\n2,0.36,0.23\n",
        "Trial,Energy ratio error\n1,0.02\n2,0.03\n",
    ] {
        assert!(read(text).is_err(), "{text}");
    }
}
