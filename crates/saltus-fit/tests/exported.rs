//! Texts and workbooks that programs export, made for the test: their COR is planted.

use crate::film::{Ball, Contact};
use crate::typed::{fit, read, trusted};
use crate::written;
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

fn ball(cor: fn(f64) -> f64) -> Ball {
    Ball { drop: 1.1, release: 0.2, gravity: 9.81, drag: 0.0, cor, contact: Contact::Instant }
}

fn near(report: &Report, e: f64) {
    assert_eq!(report.verdict(), Verdict::Trusted, "{report}");
    let cor = report.cor().unwrap_or_else(|| panic!("{report}")).value;
    assert!((cor - e).abs() < 0.02, "{report}");
}

/// The times of contacts of a ball of `e` whose first flight lasts so long.
fn contacts(e: f64, flight: f64, from: f64) -> Vec<f64> {
    (0..8).scan(from, |t, n| Some(std::mem::replace(t, *t + flight * e.powi(n)))).collect()
}

#[test]
fn films_of_other_programs_are_read() {
    let film = ball(|_| 0.8).film(60.0, 2.4);
    let points: Vec<String> = film.iter().map(|(t, h)| format!("({t:.4}, {h:.3})")).collect();
    near(&fit(&format!("pts = {{{}}}\n", points.join(", "))), 0.8);
    // Rows of R that bear names, of two balls.
    let other = ball(|_| 0.7).film(60.0, 2.4);
    let rows = film.iter().map(|p| ("a", p)).chain(other.iter().map(|p| ("b", p))).enumerate();
    let rows: String = rows.map(|(n, (name, (t, h)))| format!("\"{}\" \"{name}\" {t:.4} {h:.4}\n", n + 1)).collect();
    let report = fit(&format!("\"ball\" \"time_s\" \"height_m\"\n{rows}"));
    let cors: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
    assert!(matches!(cors[..], [a, b] if (a - 0.8).abs() < 0.02 && (b - 0.7).abs() < 0.02), "{report}");
    // Boxes about a ball, and about one and somebody who stands there; pixels count downwards.
    let pixel = |h: f64| 900.0 - 600.0 * h;
    let boxes = film.iter().enumerate();
    let sized: String = boxes
        .clone()
        .map(|(n, (_, h))| format!("{n},410.5,{:.1},{:.1},40.2,0.9\n", pixel(*h), 40.0 + 0.1 * (n % 3) as f64))
        .collect();
    let table =
        Table::parse("clip_60fps.csv", format!("frame,x,y,w,h,conf\n{sized}").as_bytes(), &ReadOptions::default());
    near(&Fit::new().run(&table.unwrap()).unwrap(), 0.8);
    let tracked: String = boxes
        .map(|(n, (_, h))| {
            let stands = 0.3 * (n % 3) as f64;
            format!(
                "{0},1,410.5,{1:.2},40.1,40.2,0.9,-1,-1,-1\n{0},2,880.2,{2:.2},150.0,470.1,0.8,-1,-1,-1\n",
                n + 1,
                pixel(*h),
                180.0 + stands
            )
        })
        .collect();
    near(&fit(&tracked), 0.8);
    // Régressi, in whatever encoding its signs are.
    let rows: Vec<String> = film.iter().map(|(t, h)| format!("{t:.5} {h:.4}")).collect();
    for sign in ["£", "ú", "Ł"] {
        let head = format!(
            "EVARISTE REGRESSI WINDOWS 1.0\n{sign}2 NOM VAR\nt\ny\n{sign}2 UNITE VAR\ns\nm\n{sign}1 MEMO GRANDEURS\n'Une balle, au sol\n"
        );
        near(&fit(&format!("{head}&{} VALEUR VAR\n{}\n", rows.len(), rows.join("\n"))), 0.8);
    }
    // A sheet that tells what was filmed, with numbers of its own, beside one of the film.
    let cells = |text: String| written::cells(&text);
    let rows: String = film.iter().map(|(t, h)| format!("{t:.4},{h:.4}\n")).collect();
    let sheets = [
        ("About", cells("Ball,rubber\nSurface,vinyl\nFrame rate,60\nRoom,12\n".to_owned())),
        ("Take 1", cells(format!("Time,Height\ns,m\n{rows}"))),
    ];
    let table = Table::parse("t.xlsx", &written::xlsx(&sheets), &ReadOptions::default()).unwrap();
    near(&Fit::new().run(&table).unwrap(), 0.8);
}

#[test]
fn samples_of_oscilloscopes_have_clocks() {
    let hits = contacts(0.85, 0.5, 0.3);
    let size = |t: f64| {
        let since = hits.iter().map(|hit| t - hit).filter(|since| *since >= 0.0).fold(9.0, f64::min);
        0.01 * (900.0 * t).sin() + 2.0 * (-since / 0.004).exp() * (3000.0 * since).cos()
    };
    let time = |n: usize| n as f64 * 1e-3;
    let settings =
        ["Record Length,3000", "Sample Interval,0.001", "Source,CH1", "Vertical Units,V", "Horizontal Units,s"];
    let beside = |n: usize| format!("{},,{:.6},{:.4},\n", settings.get(n).unwrap_or(&","), time(n), size(time(n)));
    near(&fit(&(0..3000).map(beside).collect::<String>()), 0.85);
    let counted: String = (0..3000).map(|n| format!("{n},{:.4},,\n", size(time(n)))).collect();
    near(&fit(&format!("X,CH1,Start,Increment,\nSequence,Volt,0.0,0.001\n{counted}")), 0.85);
}

#[test]
fn contacts_stand_in_logs_sections_and_lists() {
    let times = contacts(0.83, 0.6, 2.0);
    let of = |factor: f64, digits: usize| times.iter().map(move |t| format!("{:.digits$}", t * factor));
    let section = |name: &str| {
        let hits: String = of(1000.0, 1).enumerate().map(|(n, t)| format!("t{} = {t}\n", n + 1)).collect();
        format!("[{name}]\ndrop_mm = 400\n{hits}\n")
    };
    near(
        &fit(&format!("; marble on glass, times of hits in milliseconds\n{}{}", section("first"), section("second"))),
        0.83,
    );
    let clock = |t: &f64| format!("2024-02-03 10:11:{:06.3}", 10.0 + t);
    let lines: String =
        times.iter().enumerate().map(|(n, t)| format!("{} IMPACT level={} dB\n", clock(t), -3 * n as i64)).collect();
    near(&fit(&format!("{} INFO ready, threshold -20 dB\n{lines}{} INFO idle\n", clock(&0.5), clock(&9.0))), 0.83);
    let frames: String =
        times.iter().enumerate().map(|(n, t)| format!("  contact {}   f{:.0}\n", n + 1, 1000.0 * t)).collect();
    near(&fit(&format!("take 7, ball on tiles @ 1000fps\n{frames}after contact 8 it rolls\n")), 0.83);
    let flights: Vec<String> = times.windows(2).map(|pair| format!("{:.1}", 1000.0 * (pair[1] - pair[0]))).collect();
    let run = |n: usize| format!("  - id: {n}\n    drop_mm: 441\n    flight_ms: [{}]\n", flights.join(", "));
    near(&fit(&format!("# by the microphone\nball: marble\nruns:\n{}{}", run(1), run(2))), 0.83);
    // What is withdrawn in a remark of such a list is doubted.
    let withdrawn = read(&format!("# do not use, wrong ball\nball: marble\nruns:\n{}{}", run(1), run(2))).unwrap();
    assert!(Fit::new().run(&withdrawn).unwrap().verdict() != Verdict::Trusted);
    let spans: String =
        flights.iter().enumerate().map(|(n, t)| format!("lần {} -> lần {}: {t} ms\n", n + 1, n + 2)).collect();
    assert!(
        (trusted(&format!("Thời gian giữa hai lần chạm đất liên tiếp\nThả từ độ cao 1 m\n{spans}")) - 0.83).abs()
            < 0.01
    );
}
