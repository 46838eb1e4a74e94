//! Batches of balls, classes and clubs: what their tables call rows and columns, and what they say
//! beside them.

use crate::film::{Ball, Contact, csv, noisy, report};
use crate::noise::Noise;
use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{FindingKind, Report, Verdict};

fn lines(rows: impl IntoIterator<Item = String>) -> String {
    rows.into_iter().map(|row| row + "\n").collect()
}

/// The COR of each group by its name, all of them trusted.
fn groups(text: &str) -> Vec<(String, f64)> {
    let report = fit(text);
    assert_eq!(report.verdict(), Verdict::Trusted, "{text}{report}");
    report.groups().iter().map(|g| (g.name.clone(), g.report.cor().unwrap().value)).collect()
}

fn is(found: &[(String, f64)], expected: &[(&str, f64)]) -> bool {
    found.len() == expected.len()
        && expected.iter().all(|(name, e)| found.iter().any(|(n, cor)| n == name && (cor - e).abs() < 0.01))
}

fn off(n: usize) -> f64 {
    (2.4 * n as f64).sin()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// A number of degrees or of a pressure in a heading tells its column from others; beside them
    /// `Drop` counts, whatever rows below sum up or remark.
    #[test]
    fn a_condition_in_a_heading_tells_columns_apart(e in 0.4f64..0.85, form in 0usize..6, below in 0usize..4) {
        let (one, other, names) = [
            ("20 °C rebound (cm)", "5 °C rebound (cm)", ["20 °C", "5 °C"]),
            ("Rebound at 23 °C (cm)", "Rebound at 45 °C (cm)", ["23 °C", "45 °C"]),
            ("Rebound (cm) at 23°C", "Rebound (cm) at 45°C", ["23°C", "45°C"]),
            ("Bounce height 0.8 bar [cm]", "Bounce height 1.1 bar [cm]", ["0.8 bar", "1.1 bar"]),
            ("Rücksprung bei -5 °C (cm)", "Rücksprung bei 30 °C (cm)", ["-5 °C", "30 °C"]),
            ("rebound 8 psi (cm)", "rebound 12 psi (cm)", ["8 psi", "12 psi"]),
        ][form];
        let below = ["", "Average,1,1\n", "Mean,1,1\nMax - Min,2,2\n", "Limits,100 - 120,90 - 110\nTested by: R.K.,,\n"][below];
        let high = |e: f64, n: usize| 200.0 * e * e + 0.4 * off(n);
        let rows = (0..8).map(|n| format!("{},{:.1},{:.1}", n + 1, high(e, n), high(0.9 * e, n + 3)));
        let text = format!("Rebound test\nball released from 2.00 m\nDrop,{one},{other}\n{}{below}", lines(rows));
        prop_assert!(is(&groups(&text), &[(names[0], e), (names[1], 0.9 * e)]), "{}", text);
    }

    /// Balls that bear numbers or codes, of so few rows each that none has a COR of its own, are
    /// one kind where their rebounds are level; where they are not, they are told apart.
    #[test]
    fn balls_of_a_batch_are_one_kind(e in 0.5f64..0.8, rows in 1usize..3, code: bool, fast: bool) {
        let name = |ball: usize| if code { format!("B{:02}", ball + 1) } else { (ball + 1).to_string() };
        let table = |scatter: f64| {
            let row = |n: usize| {
                let e = e * (1.0 + scatter * off(n));
                let (before, after) = if fast { (88.0 + off(n), (88.0 + off(n)) * e) } else { (254.0, 254.0 * e * e) };
                format!("{},{},57.{},{before:.1},{after:.1}", name(n / rows), n % rows + 1, n % 10)
            };
            let names = if fast { "Inbound speed (ft/s),Outbound speed (ft/s)" } else { "Drop (cm),Rebound (cm)" };
            format!("Ball no.,Shot,Mass (g),{names}\n{}Mean,,57.4,,\n", lines((0..9 * rows).map(row)))
        };
        let report = fit(&table(0.004));
        prop_assert!(report.groups().is_empty() && report.verdict() == Verdict::Trusted, "{}", report);
        prop_assert!((report.cor().unwrap().value - e).abs() < 0.01, "{}", report);
        // Codes that stand once are those of one kind in any case.
        prop_assert!(code && rows == 1 || !fit(&table(0.2)).groups().is_empty());
    }

    /// Drops of one bounce each whose CORs scatter by a hundredth have one COR, however finely they
    /// were read; such that scatter by a tenth have not.
    #[test]
    fn drops_that_scatter_little_have_one_cor(e in 0.4f64..0.8, fine in 0usize..3) {
        let table = |scatter: f64| {
            let speed = |n: usize| 20.0 + f64::from(n as u32 % 3);
            let row = |n: usize| format!("{:.*},{:.*}", fine + 1, speed(n), fine + 1, speed(n) * (e + scatter * off(n)));
            format!("golf ball\nInbound speed (m/s),Outbound speed (m/s)\n{}", lines((0..3).map(row)))
        };
        prop_assert!((trusted(&table(0.008)) - e).abs() < 0.01);
        prop_assert_eq!(fit(&table(0.1)).verdict(), Verdict::Doubtful);
    }

    /// Hundredths may be called by their name.
    #[test]
    fn a_rebound_in_percent_may_be_called_so(e in 0.4f64..0.9, form in 0usize..4) {
        let name = ["rebound_percent", "Rebound percentage", "pct_rebound", "Percent rebound"][form];
        let row = |n: usize| format!("tennis,{:.1}\ngolf,{:.1}", 100.0 * e * e + 0.3 * off(n), 81.0 * e * e + 0.3 * off(n));
        let text = format!("# drop height 2 m\nball,{name}\n{}", lines((0..5).map(row)));
        prop_assert!(is(&groups(&text), &[("tennis", e), ("golf", 0.9 * e)]), "{}", text);
    }

    /// Columns beside one that names a ball are named alike, whatever their words, though a cell is
    /// missing or holds several readings.
    #[test]
    fn names_beside_a_name_tell_columns_apart(e in 0.5f64..0.85, several: bool, missing: bool) {
        let cell = |e: f64, n: usize| {
            let one = |k: usize| format!("{:.1}", (60.0 + 30.0 * n as f64) * e * e + 0.3 * off(n + k));
            if several { format!("{} / {} / {}", one(0), one(1), one(2)) } else { one(0) }
        };
        let row = |n: usize| {
            let last = if missing && n == 1 { "n/a".to_owned() } else { cell(0.7 * e, n) };
            format!("| {} cm | {} | {} | {last} |", 60 + 30 * n, cell(e, n), cell(0.8 * e, n))
        };
        let head = "| Drop height | Golf ball | Squash (double dot) | Kept overnight |\n|---|---|---|---|\n";
        let text = format!("Rebound heights (cm)\n\n{head}{}", lines((0..5).map(row)));
        let expected = [("Golf ball", e), ("Squash (double dot)", 0.8 * e), ("Kept overnight", 0.7 * e)];
        prop_assert!(is(&groups(&text), &expected), "{}", text);
    }

    /// What is dropped from a height is, whatever it falls on; and where releases of the table are
    /// others than the one that is stated, one of the two is wrong.
    #[test]
    fn a_height_of_release_is_that_of_the_table(e in 0.5f64..0.85, wrong in prop::sample::select(vec![0.5, 0.8, 0.94, 1.07, 1.5])) {
        let rows = || lines((0..5).map(|n| format!("{:.1}", 152.4 * e * e + 0.4 * off(n))));
        for title in ["puck dropped from 60 inches onto garage floor", "Ball drop - dropped flat from 152.4 cm onto the zorb mat"] {
            prop_assert!((trusted(&format!("{title}\nrebound (cm)\n{}", rows())) - e).abs() < 0.01, "{}", title);
        }
        let stated = |part: f64| {
            let bounces = lines((0..5).map(|n| format!("{n},{:.2}", 180.0 * e.powi(2 * n))));
            fit(&format!("Ball dropped from {:.1} cm\nbounce,height (cm)\n{bounces}", 180.0 * part))
        };
        prop_assert_eq!(stated(1.01).verdict(), Verdict::Trusted);
        prop_assert_eq!(stated(wrong).verdict(), Verdict::Doubtful);
    }

    /// Times between which less and less passes, by one factor, are those of contacts, unless they
    /// are called otherwise; a column beside them whose words are not understood chooses none.
    #[test]
    fn times_that_shrink_by_one_factor_say_what_they_are(e in 0.5f64..0.92, form in 0usize..4) {
        let times = |scatter: f64| -> Vec<f64> {
            let flight = |n: i32| 0.8 * e.powi(n) * (1.0 + scatter * off(n as usize));
            (0..8).scan(1.0, |t, n| { let at = *t; *t += flight(n); Some(at) }).collect()
        };
        let text = |times: Vec<f64>| match form {
            0 => format!("Event time (s)\n{}", lines(times.iter().map(|t| format!("{t:.5}")))),
            1 => format!("Time (ms),zorb peak\n{}", lines(times.iter().enumerate().map(|(n, t)| format!("{:.2},{}", 1e3 * t, 900 - 37 * n)))),
            2 => format!("time_s;zorb\n{}", lines(times.iter().enumerate().map(|(n, t)| format!("{t:.5};{}", 7 * n + 3)))),
            _ => format!("zorb threshold: 620\n{}", lines(times.iter().enumerate().map(|(n, t)| {
                format!("14:23:{:06.3} -> Bounce {}: {:.1} ms  zorb={}", 7.0 + t, n + 1, 1e3 * t, 900 - 37 * n)
            }))),
        };
        prop_assert!((trusted(&text(times(0.0))) - e).abs() < 0.01, "{}", text(times(0.0)));
        // What is called a lap is one, and what grows rarer by no one factor may be of anything.
        let laps = format!("Lap time (s)\n{}", lines(times(0.0).iter().map(|t| format!("{t:.5}"))));
        prop_assert!(read(&laps).is_err() || fit(&laps).verdict() == Verdict::Doubtful, "{}", laps);
        if form < 3 {
            let other = text(times(0.06));
            prop_assert!(read(&other).is_err() || fit(&other).verdict() == Verdict::Doubtful, "{}", other);
        }
    }
}

fn named_ball(report: &Report) -> bool {
    report.findings().iter().any(|f| matches!(f.kind, FindingKind::BallNamed { .. }))
}

/// A ball that a title, a comment or the row above a track names is the one that bounces: its size
/// and its air are those of its sport.
#[test]
fn a_ball_may_be_named_beside_the_table() {
    let table = |title: &str| format!("{title}\ndrop (cm),rebound (cm)\n100,60\n120,72\n150,90\n");
    for title in
        ["Basketball dropped in the gym", "# 2 old tennis balls", "Table tennis ball on glass", "Tennisball, Beton"]
    {
        assert!(named_ball(&fit(&table(title))), "{title}");
    }
    for title in [
        "Basketball court, a ball dropped",
        "Tennis ball and golf ball",
        "mini basketball bounce",
        "ball dropped at the golf club",
    ] {
        assert!(!named_ball(&fit(&table(title))), "{title}");
    }
    let film = Ball { drop: 1.2, release: 0.2, gravity: 9.81, drag: 0.022, cor: |_| 0.8, contact: Contact::Instant };
    let rows = noisy(&film.film(30.0, 3.0), &mut Noise(7), 4e-3);
    let rows = lines(rows.iter().map(|(t, h)| format!("{t:.4},{h:.4}")));
    let text = format!("#mass: basketball (0.62 kg, centre tracked)\nt (s),y (m)\n{rows}");
    assert!(named_ball(&fit(&text)) && (trusted(&text) - 0.8).abs() < 0.005);
}

/// Words of a title that is not understood turn no readings, and a log is a record.
#[test]
fn sentences_say_nothing_of_parts() {
    for title in ["Balls kept 1 h in the zorb at 20 °C", "PuTTY log 2024.03.12 15:07:33", "Ball bounce log, group 3"] {
        let text = format!("Squash ball dropped from 2 m\n{title}\nTrial,Rebound (cm)\n1,35\n2,36\n3,35\n4,36\n");
        assert!((trusted(&text) - 0.421).abs() < 0.01, "{title}");
    }
    let text = "Ratio of the heights of a ball\nTrial,Drop (cm),Rebound (cm)\n1,100,35\n2,100,36\n3,100,35\n";
    assert_eq!(fit(text).verdict(), Verdict::Doubtful);
}

/// Names that differ in hyphens, capitals or one slip are one; those that differ in a digit or a
/// short word are not.
#[test]
fn names_with_slips_are_one_group() {
    let table = |names: [&str; 2]| {
        let row = |n: usize| format!("{},100,{:.1}", names[n % 2], 56.0 + 0.5 * off(n));
        format!("ball,drop (cm),rebound (cm)\n{}golf ball,100,70\ngolf ball,100,71\n", lines((0..6).map(row)))
    };
    let count = |names| fit(&table(names)).groups().len();
    for names in [["Tennis ball", "Tenis ball"], ["Ping pong ball", "ping-pong ball"], ["Superball", "superbal"]] {
        assert_eq!(count(names), 2, "{names:?}");
    }
    for names in [["ball A1", "ball A2"], ["cork ball", "cord ball"], ["Ball 15", "Ball 16"]] {
        assert_eq!(count(names), 3, "{names:?}");
    }
}

fn film() -> Vec<(f64, f64)> {
    let ball = Ball { drop: 1.1, release: 0.1, gravity: 9.81, drag: 0.0, cor: |_| 0.75, contact: Contact::Instant };
    noisy(&ball.film(60.0, 2.2), &mut Noise(11), 2e-3)
}

/// A clock and the places of what moves need no names; two columns of a few drops do.
#[test]
fn a_film_may_have_no_header() {
    let text = lines(film().iter().map(|(t, h)| format!("{t:.6e}  {h:.6e}")));
    assert!((trusted(&text) - 0.75).abs() < 0.01);
    let error = read("0.8 0.45\n1.0 0.56\n1.2 0.67\n1.4 0.79\n").unwrap_err().to_string();
    assert!(error.contains("no header"), "{error}");
    let scattered = lines((0..40).map(|n| format!("{:.2} {:.3}", 0.1 * n as f64, 1.0 + off(n * n))));
    assert!(read(&scattered).unwrap_err().to_string().contains("no header"));
}

/// In space the height is the coordinate that bends, whichever it is called; bodies that stand
/// still are none of the ball, whether they are named before the coordinates or lines above them.
#[test]
fn the_height_is_the_coordinate_along_which_the_ball_falls() {
    let rows = film();
    let still = |n: usize| 0.3 + 1e-3 * off(n);
    for up in ['y', 'z'] {
        let place = |n: usize, h: f64| if up == 'z' { (still(n), h) } else { (h, still(n)) };
        let table = |header: &str, unit: f64, rest: bool| {
            let row = |(n, (t, h)): (usize, &(f64, f64))| {
                let (y, z) = place(n, *h);
                let beside = if rest {
                    format!(",{:.4},{:.4},{:.4}", 0.1, unit * still(n), unit * still(n + 2))
                } else {
                    String::new()
                };
                format!("{n},{t:.4},{:.4},{:.4},{:.4}{beside}", unit * (0.1 + 0.2 * t), unit * y, unit * z)
            };
            header.to_owned() + &lines(rows.iter().enumerate().map(row))
        };
        let near = |text: &str| assert!((trusted(text) - 0.75).abs() < 0.01, "{text}");
        near(&table("Ball\nframe,t (s),x (m),y (m),z (m)\n", 1.0, false));
        near(&table("Frame,Time,ball X,ball Y,ball Z,table X,table Y,table Z\n", 1000.0, true));
        let above = ",Type,Marker,Marker,Marker,Marker,Marker,Marker\n,Name,ball,ball,ball,floor,floor,floor\n";
        let names = ",,Position,Position,Position,Position,Position,Position\nFrame,Time (Seconds),X,Y,Z,X,Y,Z\n";
        near(&table(&format!("{above}{names}"), 1.0, true));
    }
}

/// One name that spans columns says what all of them hold, whatever each is called.
#[test]
fn a_name_above_all_columns_is_of_all() {
    let row = |n: usize| format!("{},{:.1},{:.1},{:.1}", n + 1, 56.0 + off(n), 52.0 + off(n + 1), 38.0 + off(n + 2));
    let text = format!(
        "Do tennis balls go flat?\n,\"Rebound height (cm), all dropped from 100 cm onto lab bench\",,\nTrial,New,1 month,2 years\n{}",
        lines((0..8).map(row))
    );
    assert!(is(&groups(&text), &[("New", 0.748), ("1 month", 0.721), ("2 years", 0.616)]), "{text}");
}

/// Packets that arrive out of their order are one film; recordings one below the other, whose
/// clocks start again, are several.
#[test]
fn packets_out_of_order_are_one_film() {
    let rows = film();
    let text = |parts: &[&[(f64, f64)]]| {
        format!(
            "Ball\nt (s),y (m)\n{}",
            lines(parts.iter().flat_map(|p| p.iter()).map(|(t, h)| format!("{t:.4},{h:.4}")))
        )
    };
    let (a, b, c) = (&rows[..40], &rows[40..90], &rows[90..]);
    let (ordered, shuffled) = (report(&csv(&rows)), fit(&text(&[b, c, a])));
    assert_eq!((shuffled.verdict(), shuffled.series().len()), (Verdict::Trusted, 1), "{shuffled}");
    assert!((shuffled.cor().unwrap().value - ordered.cor().unwrap().value).abs() < 1e-4);
    assert_eq!(fit(&text(&[&rows, &rows])).series().len(), 2);
}

/// A film whose clock or scale is wrong falls as nothing on Earth does, however noisy it is.
#[test]
fn a_ball_that_falls_too_fast_is_warned_of() {
    let heights = |wrong: f64, noise: f64| {
        let rows = film().into_iter().zip(0..).map(|((t, h), n)| format!("{:.4},{:.4}", t * wrong, h + noise * off(n)));
        fit(&format!("t (s),y (m)\n{}", lines(rows))).warnings().iter().find(|w| w.contains("are due")).cloned()
    };
    for noise in [0.0, 0.004] {
        assert_eq!(heights(1.0, noise), None, "{noise}");
        let warning = heights(2.0, noise).expect("a warning");
        assert!(warning.starts_with("the ball falls with 2."), "{warning}");
    }
}

/// Tops between contacts that are both read are read to some frames, where the ball is slow: they
/// leave the COR as it is.
#[test]
fn tops_are_read_less_exactly_than_contacts() {
    let contacts: Vec<f64> = (0..6)
        .scan(0.6, |t, n| {
            let at = *t;
            *t += 0.9 * 0.78f64.powi(n);
            Some(at)
        })
        .collect();
    let text = |slow: f64| {
        let mut text = "120 fps\nframe,event\n0,release\n".to_owned();
        for (n, pair) in contacts.windows(2).enumerate() {
            let top = 0.5 * (pair[0] + pair[1]) + slow * off(n);
            text +=
                &format!("{:.0},impact {}\n{:.0},top after impact {}\n", 120.0 * pair[0], n + 1, 120.0 * top, n + 1);
        }
        text + &format!("{:.0},impact 6\n", 120.0 * contacts[5])
    };
    for slow in [0.0, 0.02, 0.04] {
        assert!((trusted(&text(slow)) - 0.78).abs() < 0.01);
    }
}
