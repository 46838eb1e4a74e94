//! With three readings in ten wild, the COR is still found, and its interval still holds it.

use crate::noise::Noise;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

/// The part of runs whose interval holds `truth`. A trusted COR must be near it, and nearly all
/// must be.
fn held(what: &str, runs: usize, truth: f64, mut run: impl FnMut(&mut Noise) -> Report) -> f64 {
    let mut noise = Noise(77);
    let runs = cases(runs as u32) as usize;
    let (mut held, mut near) = (0, 0);
    for _ in 0..runs {
        let report = run(&mut noise);
        let Some(cor) = report.cor() else { continue };
        let good = (cor.value - truth).abs() < 0.01;
        assert!(good || report.verdict() != Verdict::Trusted, "{what}: {report}");
        near += usize::from(good);
        held += usize::from(cor.low <= truth && truth <= cor.high);
    }
    let part = |n: usize| n as f64 / runs as f64;
    println!(
        "{what}: of {runs} intervals {:.3} hold the truth, {:.3} of the values within 0.01",
        part(held),
        part(near)
    );
    part(held).min(part(near))
}

fn parse(text: &str) -> Table {
    Table::parse("planted", text.as_bytes(), &ReadOptions::default()).expect("a table")
}

#[test]
fn heights() {
    let part = held("heights", 200, 0.8, |noise| {
        let mut text = "trial,bounce,height_m\n".to_owned();
        for trial in 0..8 {
            for n in 0..6 {
                let h = 0.8f64.powi(2 * n) + noise.normal(0.004);
                // A misread digit, another ball, a hand: anywhere up to the height of release.
                let h = if noise.uniform() < 0.3 { 1.2 * noise.uniform() } else { h };
                text += &format!("{trial},{n},{:.5}\n", h.max(0.001));
            }
        }
        Fit::new().sigma_height(0.004).run(&parse(&text)).unwrap()
    });
    assert!(part > 0.9, "{part}");
}

#[test]
fn times_with_double_triggers_and_missed_contacts() {
    let part = held("times", 200, 0.85, |noise| {
        let mut text = "trial,bounce,time_s\n".to_owned();
        for trial in 0..8 {
            let (mut t, mut flight, mut n) = (0.2, 0.8, 0);
            for _ in 0..12 {
                let fault = noise.uniform();
                if fault >= 0.15 {
                    text += &format!("{trial},{n},{:.5}\n", t + noise.normal(0.001));
                    n += 1;
                }
                if (0.15..0.3).contains(&fault) {
                    text += &format!("{trial},{n},{:.5}\n", t + 0.02 + 0.03 * noise.uniform());
                    n += 1;
                }
                t += flight;
                flight *= 0.85;
            }
        }
        Fit::new().sigma_time(0.001).run(&parse(&text)).unwrap()
    });
    assert!(part > 0.9, "{part}");
}

/// A film of two seconds at 120 frames a second, of which `misread` says what is seen instead of a
/// height, frame by frame.
fn film(noise: &mut Noise, mut misread: impl FnMut(u32, &mut Noise) -> Option<f64>) -> Report {
    let mut text = "time_s,height_m\n".to_owned();
    let g = 9.81f64;
    for n in 0..240 {
        let time = f64::from(n) / 120.0;
        let fall = (2.0 / g).sqrt();
        let (mut start, mut speed) = (fall, 0.8 * g * fall);
        let mut h = 1.0 - 0.5 * g * time * time;
        while time > start {
            let s = time - start;
            h = speed * s - 0.5 * g * s * s;
            start += 2.0 * speed / g;
            speed *= 0.8;
        }
        let h = misread(n, noise).unwrap_or_else(|| h + noise.normal(0.003));
        text += &format!("{time:.5},{h:.5}\n");
    }
    Fit::new().run(&parse(&text)).unwrap()
}

/// A part of the samples anywhere.
fn anywhere(wild: f64) -> impl Fn(u32, &mut Noise) -> Option<f64> {
    move |_, noise| (noise.uniform() < wild).then(|| 1.2 * noise.uniform())
}

#[test]
fn series_of_which_one_in_twenty_is_wild() {
    let part = held("series", 30, 0.8, |noise| film(noise, anywhere(0.05)));
    assert!(part > 0.95, "{part}");
}

#[test]
fn series_of_which_three_in_ten_are_wild() {
    let part = held("series", 30, 0.8, |noise| film(noise, anywhere(0.3)));
    assert!(part > 0.85, "{part}");
}

/// A tracker that takes something else far above for the ball, which lies still, for eight frames
/// in every fifty.
#[test]
fn series_whose_tracker_jumps_elsewhere_and_back() {
    let part = held("jumps", 30, 0.8, |noise| {
        let from = (50.0 * noise.uniform()) as u32;
        film(noise, |n, noise| ((n + from) % 50 < 8).then(|| 9.0 + noise.normal(0.003)))
    });
    assert!(part > 0.85, "{part}");
}

/// Drops of two balls in one table, so many of them of the other ball.
fn two_balls(others: u32) -> Report {
    let mut noise = Noise(5);
    let mut text = "trial,bounce,height_m\n".to_owned();
    for trial in 0..10 {
        let e: f64 = if trial < others { 0.6 } else { 0.8 };
        for n in 0..6 {
            text += &format!("{trial},{n},{:.5}\n", e.powi(2 * n) + noise.normal(0.002));
        }
    }
    Fit::new().sigma_height(0.002).run(&parse(&text)).unwrap()
}

#[test]
fn one_odd_drop_is_left_out_and_three_are_not() {
    let one = two_balls(1);
    assert!(!one.repairs().is_empty() && (one.cor().unwrap().value - 0.8).abs() < 0.003, "{one}");
    // Three drops in ten that fall together are no misreadings: the drops differ, and the interval
    // says so.
    let three = two_balls(3);
    assert!(three.repairs().is_empty() && three.reason().contains("drops that differ"), "{three}");
    let cor = three.cor().unwrap();
    assert!(cor.low < 0.74 && cor.high > 0.74 && cor.high - cor.low > 0.05, "{three}");
}

proptest::proptest! {
    #![proptest_config(proptest::test_runner::Config::with_cases(100))]

    /// Trials that are equal to the last digit scatter by its rounding: no reading within a few
    /// roundings is left out, and two drops that differ are two drops, whose COR is in the mean.
    #[test]
    fn equal_readings_are_as_good_as_their_rounding(e in 0.6f64..0.85, off in 0.02f64..0.06, equal in 6usize..10, two in 2usize..4) {
        let step = |h: f64| (100.0 * h).round();
        let trial = |e: f64| format!("100,{},{}\n", step(e * e), step(e.powi(4)));
        let table = |odd: &str, count: usize| {
            let rows = (0..equal).map(|_| trial(e)).chain((0..count).map(|_| odd.to_owned()));
            parse(&rows.enumerate().fold("trial,h0 (cm),h1 (cm),h2 (cm)\n".to_owned(), |text, (n, row)| text + &format!("{n},{row}")))
        };
        // One centimetre off is a reading of a ruler.
        let near = Fit::new().run(&table(&format!("100,{},{}\n", step(e * e) + 1.0, step(e.powi(4)) - 1.0), 2)).unwrap();
        proptest::prop_assert!(near.repairs().is_empty(), "{near}");
        let differ = Fit::new().run(&table(&trial(e + off), two)).unwrap();
        let mean = (equal as f64 * e + two as f64 * (e + off)) / (equal + two) as f64;
        proptest::prop_assert!(differ.repairs().is_empty() && (differ.cor().unwrap().value - mean).abs() < 0.006, "{mean} {differ}");
    }
}

/// Numbers that are no bounces at all are not trusted, but for a few that agree by chance.
#[test]
fn noise_is_not_trusted() {
    let mut noise = Noise(31);
    for count in [8, 12, 20, 100] {
        let (mut heights, mut times) = (0, 0);
        for _ in 0..30 {
            let mut text = "bounce,height_cm\n".to_owned();
            (0..count).for_each(|n| text += &format!("{n},{:.1}\n", 5.0 + 95.0 * noise.uniform()));
            heights += usize::from(Fit::new().run(&parse(&text)).is_ok_and(|r| r.verdict() == Verdict::Trusted));
            let (mut text, mut t) = ("time_s\n".to_owned(), 0.0);
            for _ in 0..count {
                t += 0.1 + 0.9 * noise.uniform();
                text += &format!("{t:.3}\n");
            }
            times += usize::from(Fit::new().run(&parse(&text)).is_ok_and(|r| r.verdict() == Verdict::Trusted));
        }
        assert!(heights <= 1 && times <= 4, "of 30 tables of {count} numbers {heights} and {times} are trusted");
    }
}

#[test]
fn a_cor_that_may_be_anything_is_not_trusted() {
    // Metres under a header in centimetres, read to a centimetre.
    let table = parse("bounce,height_cm\n0,1.00\n1,0.64\n2,0.41\n3,0.26\n");
    let report = Fit::new().run(&table).unwrap();
    assert_eq!(report.verdict(), Verdict::Doubtful, "{report}");
    assert!(report.reason().contains("hardly known"), "{report}");
}

/// A trigger that hears every contact twice, some milliseconds apart.
#[test]
fn contacts_all_heard_twice_count_once() {
    let (mut time, mut flight, mut times) = (0.3, 0.8, Vec::new());
    for n in 0..8 {
        times.extend([time, time + 0.008 + 0.001 * f64::from(n % 3)]);
        time += flight;
        flight *= 0.8;
    }
    for heard in [&times[..], &times[..15]] {
        let table = Table::from_contacts(heard).unwrap();
        let report = Fit::new().run(&table).unwrap();
        let cor = report.cor().unwrap();
        assert!(report.verdict() == Verdict::Trusted && (cor.value - 0.8).abs() < 1e-3, "{report}");
        assert!(report.repairs().iter().any(|r| r.contains("heard twice")), "{report}");
        // As they stand, they are no bounces of a ball.
        assert_ne!(Fit::new().repair(false).run(&table).unwrap().verdict(), Verdict::Trusted);
    }
}
