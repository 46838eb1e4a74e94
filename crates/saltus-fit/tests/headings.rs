//! What heads a column, however it is put: the readings that a mean is of, a condition or a height
//! of release, a sign with its legend, the title of a part of a page, a trial that is only counted.

use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Group, Report, Verdict};

/// Rebounds of drops from `from`, which scatter by half a hundredth.
fn rebounds(e: f64, from: f64) -> [f64; 4] {
    [0.0, 0.004, -0.005, 0.002].map(|off| from * e * e * (1.0 + off))
}

fn is(report: &Report, e: f64) -> bool {
    report.cor().is_some_and(|cor| (cor.value - e).abs() < 6e-3)
}

/// The CORs of the groups by their names, all trusted.
fn groups(report: &Report) -> Vec<(String, f64)> {
    let of = |group: &Group| {
        assert_eq!(group.report.verdict(), Verdict::Trusted, "{}", group.name);
        (group.name.clone(), group.report.cor().unwrap().value)
    };
    report.groups().iter().map(of).collect()
}

fn drops(rebound: &str, e: f64) -> String {
    let mut text = format!("drop height (cm);{rebound}\n");
    for from in [60.0, 90.0, 120.0, 150.0] {
        text += &format!("{from};{:.1}\n", from * e * e);
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(32), failure_persistence: None, ..ProptestConfig::default() })]

    /// However many readings a mean is of, it is that of the first rebound.
    #[test]
    fn the_readings_that_a_mean_is_of_are_no_bounce(e in 0.5f64..0.9, n in 2usize..12, form in 0usize..14) {
        let heading = [
            "rebound height in cm (mean of N)",
            "mean of N rebounds (cm)",
            "mean rebound of N trials (cm)",
            "rebound height (cm) (average of N drops)",
            "rebound (cm) avg of N",
            "rebound height (cm) [N trials]",
            "Rebound height, N drops averaged (cm)",
            "rebound height (N trials) (cm)",
            "mean rebound (n=N) / cm",
            "rebound height (cm), N = N",
            "Mittlere Rücksprunghöhe aus N Versuchen (cm)",
            "moyenne de N rebonds (cm)",
            "hauteur de rebond (moyenne sur N) (cm)",
            "altura del rebote (media de N ensayos) (cm)",
        ][form];
        let heading = match heading.strip_suffix("N = N") {
            Some(start) => format!("{start}N = {n}"),
            None => heading.replace('N', &n.to_string()),
        };
        let text = drops(&heading, e);
        prop_assert!(is(&fit(&text), e), "{text}");
    }

    /// What places a bounce goes on to place it.
    #[test]
    fn a_bounce_of_which_a_mean_is_taken_stays_that_bounce(e in 0.6f64..0.9, n in 2i32..4, form in 0usize..5) {
        let heading = ["mean height of bounce N (cm)", "height after N bounces (cm)", "avg hN (cm)", "bounce N mean (cm)",
            "average height after N bounces (cm)"][form].replace('N', &n.to_string());
        let text = drops(&heading, e.powi(n));
        prop_assert!(is(&fit(&text), e), "{text}");
    }

    /// A number behind a word that says nothing of a bounce places none.
    #[test]
    fn a_number_of_something_else_is_no_bounce(e in 0.5f64..0.9, n in 2usize..9, form in 0usize..5) {
        let heading = ["class N rebound (cm)", "day N rebound height (cm)", "camera N: rebound height (cm)",
            "rebound height using N balls (cm)", "rebound (N readings) (cm)"][form].replace('N', &n.to_string());
        let text = drops(&heading, e);
        let report = fit(&text);
        prop_assert!(is(&report, e), "{text}");
    }

    /// Conditions head columns of one ball each; heights of release head columns of one ball.
    #[test]
    fn what_was_set_heads_a_column(e in 0.5f64..0.7, step in 0.04f64..0.08, unit in 0usize..4, key in 0usize..3) {
        let unit = ["°C", "psi", "kPa", "bar"][unit];
        let key = ["Trial", "", "Pressure or temperature"][key];
        let cors = [e, e + step, e + 2.0 * step];
        let mut text = format!("Rebound height in cm of a ball dropped from 150 cm\n{key},4 {unit},6 {unit},9 {unit}\n");
        for n in 0..4 {
            let cells = cors.map(|e| format!("{:.1}", rebounds(e, 150.0)[n]));
            text += &format!("run {},{}\n", n + 1, cells.join(","));
        }
        let found = groups(&fit(&text));
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        prop_assert_eq!(names, [4, 6, 9].map(|n| format!("{n} {unit}")));
        prop_assert!(found.iter().zip(cors).all(|((_, found), e)| (found - e).abs() < 6e-3), "{text}");
    }

    #[test]
    fn heights_of_release_head_columns(e in 0.5f64..0.9, key in 0usize..2) {
        let mut text = format!("Rebound height in cm\n{},50 cm,100 cm,150 cm\n", ["Trial", "Drop no."][key]);
        for n in 0..4 {
            let cells = [50.0, 100.0, 150.0].map(|from| format!("{:.1}", rebounds(e, from)[n]));
            text += &format!("{},{}\n", n + 1, cells.join(","));
        }
        prop_assert!(is(&fit(&text), e), "{text}");
    }

    /// A line around the table, or a remark of a script, says what the signs stand for.
    #[test]
    fn signs_are_what_their_legend_says(e in 0.5f64..0.9, form in 0usize..4) {
        let rows = |mark: &str| {
            let row = |from: f64| format!("{from}{mark}{:.1}\n", from * e * e);
            [40.0, 80.0, 120.0, 160.0].map(row).concat()
        };
        let list = |of: fn(f64, f64) -> f64| [40.0, 80.0, 120.0, 160.0].map(|h| format!("{:.1}", of(h, e))).join(" ");
        let text = match form {
            0 => format!("D = drop height in cm; B = rebound height in cm\nD;B\n{}", rows(";")),
            1 => format!("# P: drop height (cm), Q: rebound height (cm)\nP,Q\n{}", rows(",")),
            2 => format!("X\tY\n{}X: height of release (cm)\nY: rebound height (cm)\n", rows("\t")),
            _ => format!(
                "% lab 3, rubber ball on stone\n% h0 = drop height in cm, h1 = rebound height in cm (mean of 3)\n\
                 h0 = [{}];\nh1 = [{}];\n\nplot(h0,h1,'o'); xlabel('drop');\n",
                list(|h, _| h), list(|h, e| h * e * e)
            ),
        };
        prop_assert!(is(&fit(&text), e), "{text}");
    }

    /// Titles of Markdown above tables of the same names name what each is of.
    #[test]
    fn a_title_of_markdown_is_that_of_its_table(e in 0.5f64..0.7, step in 0.05f64..0.2) {
        let mut text = String::from("# Our balls\n\nDropped by the class.\n");
        for (name, e) in [("Granite", e), ("Rubber mat", e + step)] {
            text += &format!("\n## {name}\n\n| Drop (cm) | Rebound 1 (cm) | Rebound 2 (cm) |\n|---:|---:|---:|\n");
            for from in [60.0, 100.0, 140.0] {
                text += &format!("| {from} | {:.1} | {:.1} |\n", from * e * e, from * e * e * 1.004);
            }
        }
        let found = groups(&fit(&text));
        prop_assert!(found.len() == 2 && found[0].0 == "Granite" && found[1].0 == "Rubber mat", "{found:?} {text}");
        prop_assert!((found[0].1 - e).abs() < 6e-3 && (found[1].1 - e - step).abs() < 6e-3, "{found:?} {text}");
    }
}

/// Columns behind the first trial, and their mean, are of the quantity that it names.
#[test]
fn a_quantity_is_named_above_the_first_trial_alone() {
    let rest = |from: f64, e: f64| (2.0 * from / 9.81).sqrt() * (1.0 + e) / (1.0 - e);
    let mut text = String::from("drop height (cm),time until it is at rest (s) - trial 1,trial 2 (s),avg (s)\n");
    for from in [0.2, 0.4, 0.8] {
        let time = rest(from, 0.8);
        text += &format!("{},{time:.2},{:.2},{:.2}\n", 100.0 * from, time * 1.01, time * 1.005);
    }
    let table = read(&text).unwrap();
    assert_eq!(table.trials().len(), 6, "{text}");
    assert!(is(&fit(&text), 0.8), "{text}");
}

/// The words below signs explain them, and keep their unit.
#[test]
fn words_below_a_sign_bear_its_unit() {
    let mut text = String::from(
        "No.;h0 [cm];h1 [cm];h2 [cm];k\n;initial height;after the bounce, trial 1;after the bounce, trial 2;\n",
    );
    for (n, from) in [50.0, 90.0, 130.0].into_iter().enumerate() {
        text += &format!("{};{from};{:.1};{:.1};0.8\n", n + 1, from * 0.64, from * 0.643);
    }
    assert!(is(&fit(&text), 0.8), "{text}");
}

/// A length in a sentence that the table holds as the release is read.
#[test]
fn a_height_of_release_may_be_told_twice() {
    let text = "Ball: zorb, dropped once from 180 cm and filmed.\nbounce;height (cm)\n0;180\n1;115.2\n2;73.7\n3;47.2\n";
    assert!((trusted(text) - 0.8).abs() < 4e-3);
    assert_eq!(fit(&text.replace("from 180 cm", "from 170 cm")).verdict(), Verdict::Doubtful);
}

/// The same drops under headings of many hands, each with a COR of 0.8.
#[test]
fn many_hands_write_the_same_drops() {
    let drops = [50.0, 75.0, 100.0, 150.0];
    let rows = |row: &dyn Fn(f64) -> String| drops.map(row).concat();
    let reb = |from: f64, off: f64| from * 0.64 * (1.0 + off);
    for text in [
        // A mean is the rebound where no other is.
        format!("Side;H (cm);h, avg of 3 (cm);%\n{}", rows(&|h| format!("logo;{h};{:.1};64\n", reb(h, 0.0)))),
        // Columns of something else beside `H` and `h`.
        format!(
            "No.;Ball dia. (mm);k;H (mm);h (mm)\n{}",
            rows(&|h| format!("1;19.05;0.8;{};{:.0}\n", 10.0 * h, 10.0 * reb(h, 0.0)))
        ),
        // Repeats in another unit than the release.
        format!(
            "Pupil;Drop (m);Bounce 1 (cm);Bounce 2 (cm);Bounce 3 (cm)\n{}",
            rows(&|h| format!(
                "Ann;1.00;{:.1};{:.1};{:.1}\n",
                reb(100.0, h * 1e-5),
                reb(100.0, -0.004),
                reb(100.0, 0.003)
            ))
        ),
        // A row of errors, and of units where there is none.
        format!(
            "Drop height (cm);Trial 1;Trial 2;Mean;Range/2\n±0.5 cm;(±1 cm);(±1 cm);cm;cm\n{}",
            rows(&|h| format!("{h};{:.1};{:.1};{:.1};0.2\n", reb(h, 0.003), reb(h, -0.003), reb(h, 0.0)))
        ),
        // Numbers in brackets go on with the name before them.
        format!(
            "Drop height / cm;Rebound height / cm (1);(2);(3);Mean / cm\n{}",
            rows(&|h| format!(
                "{h};{:.1};{:.1};{:.1};{:.1}\n",
                reb(h, 0.003),
                reb(h, -0.003),
                reb(h, 0.0),
                reb(h, 0.0)
            ))
        ),
        // A mark before its number counts a row, and is no comment.
        format!(
            "All drops from 1.00 m. Rebound in cm.\nAttempt,Wood\n{}",
            (1..5).map(|n| format!("#{n},{:.1}\n", reb(100.0, 2e-3 * f64::from(n) - 5e-3))).collect::<String>()
        ),
        // Beside the speeds of an impact its greatest height says nothing more.
        format!(
            "Ball;Speed at impact (m/s);Speed leaving floor (m/s);Max height reached (m)\n{}",
            rows(&|h| format!("zorb;{:.3};{:.3};{:.3}\n", h / 30.0, 0.8 * h / 30.0, (0.8 * h / 30.0).powi(2) / 19.62))
        ),
        // Powers of units.
        format!(
            "Trial no.;u / m s^-1;v / m s^-1\n{}",
            rows(&|h| format!("1;-{:.3};{:.3}\n", h / 30.0, 0.8 * h / 30.0))
        ),
        // A remark below a table of blanks may hold any mark.
        format!(
            "Lab\nBouncing of a ball\n\n  H (cm)    h avg (cm)   std\n  ------    ----------   ---\n{}\n  g = 9.81 m/s^2 ; e from the slope\n",
            rows(&|h| format!("  {h:6.1}    {:10.1}   0.8\n", reb(h, 0.0)))
        ),
        // Hundredths of a drop whose height the heading states.
        format!("ball;rebound % of drop height (mean of 5 drops from 1.5 m)\n{}", rows(&|_| "zorb;64%\n".to_owned())),
        // What measures beside a name above the table names none of its columns.
        format!(
            "Method;Drop from 2540 mm onto stone;;\nSample no.;Wobble (mm);Drop height (mm);Rebound height (mm)\n{}",
            rows(&|h| format!("TB-{h};6.2;2540;{:.0}\n", reb(2540.0, h * 1e-5)))
        ),
        // A remark behind the cells of a row, which blanks part.
        format!(
            "Zorb\nBy: Sem and Flo    on: 8-2-2023\n\nbounce   height (cm)\n{}",
            (0..5)
                .map(|n| format!(
                    "{n}       {:.1}{}\n",
                    80.0 * 0.64f64.powi(n),
                    if n == 3 { "    hard to read" } else { "" }
                ))
                .collect::<String>()
        ),
        // A distance from a sensor above and the height that it leaves.
        format!(
            "peak;distance to sensor (mm);height above floor (mm)\n{}",
            (0..5)
                .map(|n| 900.0 * 0.64f64.powi(n))
                .map(|h| format!("{:.0};{h:.0}\n", 1400.0 - h.round()))
                .enumerate()
                .map(|(n, row)| format!("{n};{row}"))
                .collect::<String>()
        ),
        // The error of a COR is none.
        format!(
            "h0 / m;u(h0) / m;h1 / m;u(h1) / m;e;u(e)\n{}",
            rows(&|h| format!("{:.3};0.002;{:.3};0.005;0.800;0.015\n", h / 100.0, reb(h, 0.0) / 100.0))
        ),
        // Balls that are only counted.
        format!(
            "Tennis club, bounces\nBall;Drop (cm);Rebound (cm)\n{}",
            (1..6).map(|n| format!("{n};254;{:.0}\n", reb(254.0, f64::from(n - 3) * 4e-3))).collect::<String>()
        ),
        // A unit before a remark of how many drops.
        format!("Drop height / cm;Mean rebound / cm (of 5 drops)\n{}", rows(&|h| format!("{h};{:.1}\n", reb(h, 0.0)))),
    ] {
        assert!(is(&fit(&text), 0.8), "{text}{}", fit(&text));
    }
}

/// A ball that was thrown was not released from rest.
#[test]
fn a_ball_that_was_thrown_is_a_doubt() {
    let text = "Ball thrown down at the floor\nHand height (cm);Height after bounce (cm)\n130;83\n125;80\n128;82\n";
    assert_ne!(fit(text).verdict(), Verdict::Trusted);
    assert_eq!(fit(&text.replace("thrown down at", "dropped on")).verdict(), Verdict::Trusted);
}
