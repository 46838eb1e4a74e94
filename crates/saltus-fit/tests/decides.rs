//! Numbers by which the fit decides, each met from both sides, so that ten times more or less of
//! any fails.

use std::fmt::Write as _;

use saltus_fit::{FindingKind, Fit, ReadOptions, Report, Table, Verdict, Widening};

const G: f64 = 9.81;

fn read(text: &str) -> Table {
    Table::parse("t.csv", text.as_bytes(), &ReadOptions::default()).unwrap()
}

fn fit(text: &str) -> Report {
    Fit::new().run(&read(text)).unwrap()
}

fn found(report: &Report, kind: fn(&FindingKind) -> bool) -> bool {
    report.findings().iter().any(|finding| kind(&finding.kind))
}

fn of_heights(heights: &[f64], fit: Fit) -> Report {
    fit.run(&Table::from_heights(heights).unwrap()).unwrap()
}

/// The times of contacts after a release at 0 from 1 m.
fn contacts(e: f64, count: usize) -> Vec<f64> {
    let fall = (2.0 / G).sqrt();
    let flights = std::iter::successors(Some(2.0 * fall * e), |flight| Some(flight * e));
    let times = flights.scan(fall, |time, flight| Some(std::mem::replace(time, *time + flight)));
    times.take(count).collect()
}

fn drops(rebounds: impl Iterator<Item = f64>) -> String {
    rebounds.fold("drop_cm,rebound_cm\n".to_owned(), |text, rebound| text + &format!("100,{rebound:.3}\n"))
}

/// An error that nobody states, of few readings: 1 cm, 10 ms.
#[test]
fn errors_that_nobody_states_are_usual_ones() {
    let heights = of_heights(&[1.0, 0.64, 0.41], Fit::new()).sigma_height().unwrap().value;
    let times = Fit::new().run(&Table::from_contacts(&[0.4, 1.2, 1.84]).unwrap()).unwrap().sigma_time().unwrap().value;
    assert!((0.005..0.02).contains(&heights) && (0.005..0.02).contains(&times), "{heights} {times}");
}

/// Two heights rule nothing out: a table-tennis ball, 0.14 /m, and a zero off by a tennis ball. Six
/// read to a tenth of a millimetre rule out all but ordinary balls, 0.022 /m.
#[test]
fn what_no_reading_shows_is_that_of_usual_balls() {
    let air = |report: &Report| {
        report
            .widened()
            .iter()
            .find_map(|w| if let Widening::Air { most_per_m, .. } = w { Some(*most_per_m) } else { None })
    };
    let zero = |report: &Report| {
        report.widened().iter().find_map(|w| if let Widening::Zero { zero_m, .. } = w { Some(*zero_m) } else { None })
    };
    let two = of_heights(&[1.0, 0.64], Fit::new());
    let (most, off) = (air(&two).unwrap(), zero(&two).unwrap());
    assert!((0.1..0.2).contains(&most) && (0.04..0.1).contains(&off), "{most} {off}");
    let apexes: Vec<f64> = (0..6).map(|n| 0.64f64.powi(n)).collect();
    let six = of_heights(&apexes, Fit::new().sigma_height(1e-4).sigma_zero(0.0));
    let most = air(&six).unwrap();
    assert!((0.015..0.03).contains(&most), "{most}: {six}");
}

/// Heights of one drop and times of another: 1.5 standard errors apart they agree, and 6 apart they
/// do not.
#[test]
fn methods_that_differ_by_six_errors_are_doubted() {
    let differ = |errors: f64| {
        let table = |e: f64| {
            let mut text = "trial,event,time_s,height_m\n1,release,,1\n".to_owned();
            for n in 1..4 {
                writeln!(text, "1,apex,,{}", 0.64f64.powi(n)).unwrap();
            }
            for time in contacts(e, 5) {
                writeln!(text, "2,contact,{time},").unwrap();
            }
            read(&text)
        };
        let run = |e: f64| Fit::new().sigma_height(0.005).sigma_time(0.002).run(&table(e)).unwrap();
        let error = run(0.8)
            .estimates()
            .iter()
            .filter(|e| ["heights", "times"].contains(&e.method.name()))
            .fold(0.0, |sum, e| f64::hypot(sum, e.standard_error.unwrap()));
        found(&run(0.8 + errors * error), |k| matches!(k, FindingKind::MethodsDiffer { .. }))
    };
    assert!(!differ(1.5) && differ(6.0));
}

/// A rebound 30 scatters from the others is none, and one 4 from them is one.
#[test]
fn a_rebound_far_from_the_scatter_is_left_out() {
    let out = |scatters: f64| {
        let rebound = |n: usize| 64.0 + if n == 7 { 0.3 * scatters } else { 0.3 * (n as f64 * 2.4).sin() };
        found(&fit(&drops((0..20).map(rebound))), |k| matches!(k, FindingKind::HeightLeftOut { .. }))
    };
    assert!(out(30.0) && !out(4.0));
}

/// Contacts heard twice, 40 ms apart: pairs where all else is four times longer, and none where it
/// is but twice as long.
#[test]
fn pairs_are_far_apart() {
    let pairs = |between: [f64; 3]| {
        let mut at = 0.5;
        let mut text = "contact,time_s\n1,0.5\n2,0.54\n".to_owned();
        for (n, flight) in between.into_iter().enumerate() {
            at += flight;
            write!(text, "{},{:.3}\n{},{:.3}\n", 2 * n + 3, at, 2 * n + 4, at + 0.04).unwrap();
        }
        found(&fit(&text), |k| matches!(k, FindingKind::Pairs { .. }))
    };
    assert!(pairs([0.32, 0.27, 0.23]) && !pairs([0.1, 0.098, 0.096]));
}

/// Rebounds that scatter by a part of the largest height: a fortieth shows a bounce, and a quarter
/// hardly does.
#[test]
fn what_scatters_as_much_as_it_bounces_is_loud() {
    let loud = |part: f64| {
        let rebounds = (0..12).map(|n| 64.0 + 141.0 * part * (2.4 * f64::from(n)).sin());
        found(&fit(&drops(rebounds)), |k| matches!(k, FindingKind::Loud { .. }))
    };
    assert!(!loud(0.025) && loud(0.25));
}

/// Rebounds that stay where they are whatever the height of release follow no COR: rebounds that
/// do, or scatter too much to tell, or come from one height, are no such.
#[test]
fn rebounds_that_do_not_follow_the_release_are_a_doubt() {
    let unmoved = |rebound: &dyn Fn(f64, f64) -> f64, heights: [f64; 8]| {
        let rounded = |high: f64| (100.0 * high).round() / 100.0;
        let row = |(n, h): (usize, f64)| format!("{h},{}\n", rounded(rebound(h, (2.4 * n as f64).sin())));
        let rows: String = heights.into_iter().enumerate().map(row).collect();
        let report = fit(&("drop_cm,rebound_cm\n".to_owned() + &rows));
        let found = found(&report, |k| matches!(k, FindingKind::Unmoved { .. }));
        assert!(!found || report.verdict() == Verdict::Doubtful, "{report}");
        found
    };
    let apart = [0, 1, 2, 3, 4, 5, 6, 7].map(|n| 80.0 + 20.0 * f64::from(n));
    let near = [0, 1, 2, 3, 4, 5, 6, 7].map(|n| 150.0 + 0.5 * f64::from(n % 3));
    for level in [12.0, 30.0, 62.0] {
        assert!(unmoved(&|_, noise| level + noise, apart), "{level}");
        assert!(!unmoved(&|_, noise| level + noise, near), "{level}");
    }
    // Rounded to the same number they scatter less than they were read to.
    let alike = [86.0, 87.0, 86.0, 86.5, 86.0, 87.0, 86.0, 86.5];
    assert!(!unmoved(&|_, _| 34.0, alike) && unmoved(&|_, _| 34.0, apart));
    for e in [0.4, 0.6, 0.8] {
        assert!(!unmoved(&|h, noise| e * e * h + noise, apart) && !unmoved(&|h, noise| e * e * h + 8.0 * noise, apart));
    }
}

/// Errors so large that one fit in a thousand is as good by chance are said to be too large, and
/// such that one in a hundred is are not.
#[test]
fn errors_that_are_far_too_large_are_named() {
    let off = [0.0, 0.004, -0.003, 0.003, -0.004, 0.002, -0.002, 0.003];
    let heights: Vec<f64> = off.iter().enumerate().map(|(n, off)| 0.81f64.powi(n as i32) + off).collect();
    let named = |sigma: f64| {
        let report = of_heights(&heights, Fit::new().sigma_height(sigma));
        let p = report.estimates().iter().find_map(|e| e.p).unwrap();
        (found(&report, |k| matches!(k, FindingKind::ErrorsTooLarge { .. })), p)
    };
    let all: Vec<(bool, f64)> = (10..200).map(|n| named(0.0002 * f64::from(n))).collect();
    let between =
        |low: f64, high: f64| all.iter().filter(move |(_, p)| (low..high).contains(p)).map(|(named, _)| *named);
    assert!(between(0.991, 0.998).any(|_| true) && between(0.991, 0.998).all(|named| !named), "{all:?}");
    assert!(between(0.9992, 0.9998).any(|_| true) && between(0.9992, 0.9998).all(|named| named), "{all:?}");
}

/// The height of release tells of the first flight what the others do not: six errors off it is
/// said, and one off it is not.
#[test]
fn a_first_flight_that_differs_is_named() {
    let differs = |errors: f64| {
        let run = |release: f64| {
            let mut text = format!("event,time_s,height_m\nrelease,0,{release}\n");
            contacts(0.8, 6).iter().for_each(|time| writeln!(text, "contact,{time},").unwrap());
            Fit::new().sigma_height(0.003).sigma_time(0.001).run(&read(&text)).unwrap()
        };
        let first = |report: &Report| {
            *report
                .estimates()
                .iter()
                .find(|e| e.method.name() == "first-flight")
                .map(|e| (e.value.unwrap(), e.standard_error.unwrap()))
                .as_ref()
                .unwrap()
        };
        let error = first(&run(1.0)).1;
        // e follows from 1/√h.
        found(&run((0.8 / (0.8 + errors * error)).powi(2)), |k| matches!(k, FindingKind::FirstFlightDiffers { .. }))
    };
    assert!(differs(8.0) && !differs(1.0));
}

#[test]
fn what_agrees_to_the_last_digit_does_not_differ() {
    for kept in [0.25, 0.36, 0.49, 0.5, 0.55, 0.6, 0.7, 0.81] {
        for heights in [[90.0, 60.0, 100.0], [50.0, 100.0, 60.0], [80.0, 120.0, 40.0], [150.0, 70.0, 90.0]] {
            // Roundings of sums make the CORs of heights and of days differ in their last digit.
            let mut text = String::from("drop_cm,rebound_cm,humidity\n");
            for trial in 0..12 {
                let height = heights[trial % 3];
                let _ = writeln!(text, "{height},{:.4},{}", kept * height, 40 + 5 * (trial / 3 % 2));
            }
            let report = fit(&text);
            assert_eq!(report.verdict(), Verdict::Trusted, "{kept} {heights:?}: {report}");
        }
    }
}
