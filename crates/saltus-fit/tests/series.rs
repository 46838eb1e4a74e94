//! Series of heights in time: planted motions are found, and recordings made by other people give
//! what an analyst found in them.

use std::path::{Path, PathBuf};

use crate::film::{Ball, Contact, csv, noisy, report};
use crate::noise::Noise;
use saltus_fit::{CorModel, Fit, ReadOptions, Report, Table, Track, Verdict};

fn steel() -> Ball {
    Ball { drop: 1.0, release: 0.1, gravity: 9.81, drag: 0.0, cor: |_| 0.8, contact: Contact::Instant }
}

fn light() -> Ball {
    Ball { drop: 1.2, release: 0.15, gravity: 9.81, drag: 0.12, cor: |_| 0.9, contact: Contact::Instant }
}

/// The COR lies within three of its errors, which are not large.
fn holds(report: &Report, truth: f64, largest_error: f64) {
    let cor = report.cor().unwrap_or_else(|| panic!("{report}"));
    let error = cor.standard_error.expect("an error");
    assert!((cor.value - truth).abs() <= 3.0 * error + 1e-4, "{report}");
    assert!(error <= largest_error, "{report}");
}

#[test]
fn a_heavy_ball_needs_no_drag() {
    let mut noise = Noise(11);
    let report = report(&csv(&noisy(&steel().film(120.0, 2.5), &mut noise, 0.002)));
    assert_eq!(report.verdict(), Verdict::Trusted, "{report}");
    holds(&report, 0.8, 0.002);
    let track = &report.series()[0];
    assert!(track.drag.is_none() && track.impacts.len() >= 4, "{report}");
    assert!((track.gravity.value - 9.81).abs() < 4.0 * track.gravity.standard_error, "{report}");
    assert!((track.impacts[0].speed - (2.0f64 * 9.81).sqrt()).abs() < 0.02, "{report}");
    assert!(report.motion().is_some() && report.points().len() == track.samples);
}

#[test]
fn a_light_ball_s_drag_is_found_by_itself() {
    let mut noise = Noise(12);
    let report = report(&csv(&noisy(&light().film(120.0, 2.5), &mut noise, 0.002)));
    holds(&report, 0.9, 0.01);
    let drag = report.series()[0].drag.expect("drag");
    assert!((drag.value - 0.12).abs() < 4.0 * drag.standard_error && drag.standard_error < 0.02, "{report}");
    assert!(report.notes().iter().any(|n| n.contains("air drag is needed")), "{report}");
}

#[test]
fn a_cor_that_falls_with_speed_is_seen() {
    let ball = Ball { cor: |v| 0.9 - 0.03 * v, ..steel() };
    let report = report(&csv(&noisy(&ball.film(240.0, 3.0), &mut Noise(13), 0.001)));
    let track = &report.series()[0];
    for impact in &track.impacts {
        let truth = 0.9 - 0.03 * impact.speed;
        assert!(
            (impact.cor.value - truth).abs() < 4.0 * impact.cor.standard_error + 2e-4,
            "{impact:?} {truth}\n{report}"
        );
    }
    let varies = [CorModel::Linear, CorModel::LinearDrag, CorModel::Each, CorModel::EachDrag];
    assert!(varies.contains(&report.models()[0].name), "{report}");
    assert_eq!(report.verdict(), Verdict::Doubtful, "one number for a COR that changes: {report}");
}

#[test]
fn units_turning_clock_and_order_do_not_matter() {
    let mut noise = Noise(14);
    let film = noisy(&light().film(100.0, 2.2), &mut noise, 0.002);
    let cor = |rows: &[(f64, f64)]| report(&csv(rows)).cor().map(|c| (c.value, c.standard_error.unwrap())).unwrap();
    let (value, error) = cor(&film);
    let film_as = |time: f64, scale: f64, zero: f64| -> Vec<(f64, f64)> {
        film.iter().map(|&(t, h)| (time * t, zero + scale * h)).collect()
    };
    // Pixels with y down; a clock that believes in 24 frames a second; a sensor in millimetres that
    // looks down from 1.5 m.
    for other in [film_as(1.0, -664.5, 1900.0), film_as(100.0 / 24.0, 1.0, 0.0), film_as(1.0, -1000.0, 1500.0)] {
        let (v, s) = cor(&other);
        assert!((v - value).abs() < 0.02 * error && (s / error - 1.0).abs() < 0.05, "{v} ± {s}, {value} ± {error}");
    }
    let mut shuffled = film.clone();
    for i in (1..shuffled.len()).rev() {
        shuffled.swap(i, (noise.uniform() * i as f64) as usize);
    }
    assert_eq!(cor(&shuffled), (value, error));
}

#[test]
fn a_hand_at_either_end_and_wild_samples_between_are_left_out() {
    let mut noise = Noise(15);
    let ball = Ball { release: 0.8, ..steel() };
    let mut film = noisy(&ball.film(100.0, 2.6), &mut noise, 0.002);
    for (t, h) in &mut film {
        // The hand sinks a little before it lets go.
        if *t < 0.75 {
            *h -= 0.02 * (0.75 - *t);
        }
    }
    for n in (90..film.len()).step_by(17) {
        film[n].1 += 0.4 * (noise.uniform() - 0.3);
    }
    let report = report(&csv(&film));
    holds(&report, 0.8, 0.005);
    let text = report.repairs().join("\n");
    assert!(text.contains("before the fall") && text.contains("wild"), "{report}");
}

#[test]
fn few_frames_a_second_are_enough_for_a_few_bounces() {
    let report = report(&csv(&noisy(&steel().film(30.0, 2.2), &mut Noise(16), 0.003)));
    holds(&report, 0.8, 0.02);
}

#[test]
fn several_films_of_one_ball_are_trials() {
    let mut noise = Noise(17);
    let mut text = "trial,time_s,height_m\n".to_owned();
    for trial in 0..5 {
        let ball = Ball { drop: 0.9 + 0.1 * f64::from(trial), ..steel() };
        for (t, h) in noisy(&ball.film(100.0, 1.8), &mut noise, 0.002) {
            text += &format!("{trial},{t},{h}\n");
        }
    }
    let report = report(&text);
    assert_eq!((report.series().len(), report.verdict()), (5, Verdict::Trusted), "{report}");
    holds(&report, 0.8, 0.002);
}

#[test]
fn what_does_not_bounce_is_refused_in_words() {
    let refused = |rows: &[(f64, f64)], part: &str| {
        let report = report(&csv(rows));
        assert!(
            report.verdict() == Verdict::Refused && report.cor().is_none() && report.motion().is_none(),
            "{report}"
        );
        assert!(report.reason().contains(part), "{report}");
    };
    let fall: Vec<(f64, f64)> = (0..20).map(|n| f64::from(n) / 50.0).map(|t| (t, 1.0 - 4.9 * t * t)).collect();
    refused(&fall, "no bounce");
    refused(&[(0.0, 1.0)], "no bounce");
    refused(&[(0.0, 1.0), (0.1, 1.0), (0.2, 1.0)], "no bounce");
    refused(&[(0.0, 1.0), (0.2, 0.8), (0.45, 0.01), (0.6, 0.3), (0.8, 0.1)], "too few");
    let wave: Vec<(f64, f64)> = (0..200).map(|n| (f64::from(n) / 100.0, (f64::from(n) / 10.0).sin())).collect();
    let report = report(&csv(&wave));
    assert_ne!(report.verdict(), Verdict::Trusted, "{report}");
}

#[test]
fn twenty_thousand_samples_give_their_cor() {
    let mut noise = Noise(18);
    let film = noisy(&light().film(10_000.0, 2.0), &mut noise, 0.002);
    holds(&report(&csv(&film)), 0.9, 0.002);
}

/// A folder of other people's recordings, or `None`, saying so, where it is not to be had.
fn borrowed(name: &str) -> Option<String> {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(name);
    let found = std::fs::read_to_string(&path).ok();
    if found.is_none() {
        eprintln!("skipped: {} is not here", path.display());
    }
    found
}

/// A table-tennis ball on a table, filmed from the side: `x;y;` in pixels, y down, 100 frames a
/// second.
fn table_tennis(name: &str) -> Option<Vec<(f64, f64)>> {
    let text = borrowed(&format!("tabletennis_100fps/{name}.txt"))?;
    let row = |(n, line): (usize, &str)| (0.01 * n as f64, line.split(';').nth(1).unwrap().parse().unwrap());
    Some(text.lines().enumerate().map(row).collect())
}

#[test]
fn a_table_tennis_ball_needs_drag_and_the_program_says_so() {
    let mut text = "trial,time_s,height_m\n".to_owned();
    for name in ["tracked-5", "tracked-8", "tracked-9"] {
        let Some(film) = table_tennis(name) else { return };
        let alone = report(&csv(&film));
        assert!(alone.series()[0].drag.is_some(), "{alone}");
        for (t, y) in film {
            text += &format!("{name},{t},{y}\n");
        }
    }
    let report = report(&text);
    // The analyst: 0.921 ± 0.004, then 0.921 ± 0.003; k = 0.124 a metre, at 911 pixels to 1.371 m.
    let cor = report.cor().unwrap();
    assert!((cor.value - 0.921).abs() < 0.01 && cor.low < 0.921 && 0.921 < cor.high, "{report}");
    let error = cor.standard_error.unwrap();
    assert!((0.002..0.008).contains(&error), "{report}");
    let mean = |of: &dyn Fn(&Track) -> f64| report.series().iter().map(of).sum::<f64>() / 3.0;
    for n in 0..2 {
        let found = mean(&|t| t.impacts[n].cor.value);
        assert!((found - 0.921).abs() < 0.01, "impact {n}: {found}\n{report}");
    }
    let k = mean(&|t| t.drag.unwrap().value) * 911.0 / 1.371;
    assert!((k - 0.124).abs() < 0.012, "{k}");
    assert!(report.notes().iter().any(|n| n.contains("air drag is needed")), "{report}");
    let without = report.models().iter().find(|m| m.name == "each").unwrap();
    assert!(without.cor.value < 0.85 && without.bic > 20.0, "{report}");
}

#[test]
fn a_glass_marble_on_paper() {
    for (name, cors) in [("HT-2-M", [0.513, 0.503]), ("HT-3-M", [0.508, 0.520])] {
        let Some(text) = borrowed(&format!("marble_200fps/{name}.csv")) else { return };
        // Frame, X1, Y1: the marble is the first track; the summary comes after an empty line.
        let rows = text.lines().skip(2).map_while(|line| {
            let mut cells = line.split('\t');
            let frame: f64 = cells.next()?.trim().parse().ok()?;
            Some((frame / 200.0, cells.nth(1)?.trim().parse::<f64>().ok()))
        });
        let film: Vec<(f64, f64)> = rows.filter_map(|(t, y)| Some((t, y?))).collect();
        let report = report(&csv(&film));
        for (impact, reference) in report.series()[0].impacts.iter().zip(cors) {
            assert!((impact.cor.value - reference).abs() < 0.01, "{name}: {impact:?}, {reference}\n{report}");
        }
    }
}

#[test]
fn a_drop_without_a_bounce_is_not_fitted() {
    let Some(text) = borrowed("tracker_drop/black_ball.txt") else { return };
    let options = ReadOptions::default().height_unit("m").time_unit("s");
    let table = Table::parse("black_ball.txt", text.as_bytes(), &options).expect("a table");
    let report = Fit::new().run(&table).expect("a report");
    assert_eq!(report.verdict(), Verdict::Refused);
    assert!(report.reason().contains("no bounce"), "{}", report.reason());
}

/// Phones film at 24 to 240 frames a second, from before the release to long after the ball lies:
/// every such film gives its COR.
#[test]
fn films_of_every_rate_and_length() {
    let mut noise = Noise(9);
    let bounces: [fn(f64) -> f64; 3] = [|_| 0.6, |_| 0.78, |_| 0.88];
    for rate in [24.0, 30.0, 60.0, 240.0] {
        for cor in bounces {
            let e = cor(1.0);
            for (k, seconds) in [2.4, 2.7, 3.0, 9.0].into_iter().enumerate() {
                let ball = Ball { drop: 0.9 + 0.13 * k as f64, release: 0.05 + 0.011 * k as f64, cor, ..steel() };
                let report = report(&csv(&noisy(&ball.film(rate, seconds), &mut noise, 8e-4)));
                let what = format!("{rate} frames a second, COR {e}, {seconds} s: {report}");
                assert_eq!(report.verdict(), Verdict::Trusted, "{what}");
                assert!((report.cor().unwrap().value - e).abs() < 0.01, "{what}");
                assert!(!report.warnings().iter().any(|w| w.contains("are due")), "{what}");
            }
        }
    }
}

/// Drag that one of several films does not show is none there, and no reason to leave it out of
/// all.
#[test]
fn a_film_without_drag_beside_films_with_drag() {
    let mut noise = Noise(23);
    let mut text = "trial,time_s,height_m\n".to_owned();
    for (trial, drag) in [0.0, 0.12, 0.12].into_iter().enumerate() {
        let ball = Ball { drop: 1.0 + 0.2 * trial as f64, drag, ..steel() };
        for (t, h) in noisy(&ball.film(120.0, 2.2), &mut noise, 0.0005) {
            text += &format!("{trial},{t},{h}\n");
        }
    }
    let report = report(&text);
    assert!((report.cor().expect("a COR").value - 0.8).abs() < 0.005, "{report}");
    assert_eq!(report.verdict(), Verdict::Trusted, "{report}");
}

/// The last bounces before a ball lies still have two to four samples each: they are not used, and
/// nothing is wrong with them.
#[test]
fn the_last_bounces_of_a_film_are_not_wild() {
    let mut noise = Noise(33);
    let bounces: [fn(f64) -> f64; 2] = [|_| 0.68, |_| 0.78];
    for cor in bounces {
        for k in 0..6 {
            let ball = Ball { drop: 0.9 + 0.05 * f64::from(k), cor, ..steel() };
            let report = report(&csv(&noisy(&ball.film(30.0, 5.0), &mut noise, 1e-3)));
            assert_eq!(report.verdict(), Verdict::Trusted, "{report}");
            assert!(!report.to_string().contains("outliers"), "{report}");
            assert!(report.series()[0].left_out[2] == 0, "{report}");
            holds(&report, cor(1.0), 0.004);
        }
    }
}
