//! Films of balls whose impacts take time, as all do: what the program says of the COR, and how
//! often its intervals hold the truth.

use crate::film::{Ball, Contact, csv, noisy, report};
use crate::noise::Noise;
use saltus_cases::cases;
use saltus_fit::{FindingKind, Fit, ReadOptions, Report, Table, Verdict, Widening};

const CORS: [fn(f64) -> f64; 4] = [|_| 0.52, |_| 0.62, |_| 0.72, |_| 0.82];
const SCATTER: [f64; 4] = [5e-4, 1e-3, 2e-3, 3e-3];

/// So many films of each kind; the environment's FILMS asks for more.
fn films() -> u32 {
    std::env::var("FILMS").map_or(cases(40), |n| n.parse().expect("FILMS is a number"))
}

/// One film of many, drop height, rebounds, scatter and length chosen by its number; and the least
/// and greatest COR of its first three impacts.
fn filmed(contact: Contact, rate: f64, n: u32) -> (Report, [f64; 2]) {
    let mut noise = Noise(u64::from(n) + 1000 * rate as u64);
    let ball = Ball {
        drop: 0.8 + 0.4 * noise.uniform(),
        release: noise.uniform() / rate,
        gravity: 9.81,
        drag: 0.0,
        cor: CORS[n as usize % 4],
        contact,
    };
    let seconds = 1.5 + noise.uniform();
    let (heights, cors) = ball.watched(rate, seconds);
    let scatter = SCATTER[n as usize / 4 % 4];
    let first = &cors[..cors.len().min(3)];
    let ends = [first.iter().copied().fold(f64::INFINITY, f64::min), first.iter().copied().fold(0.0, f64::max)];
    (report(&csv(&noisy(&heights, &mut noise, scatter))), ends)
}

/// How many of the reports that are trusted hold a COR of the first three impacts, of how many.
fn held(contact: Contact, rates: &[f64]) -> (u32, u32) {
    let (mut held, mut trusted) = (0, 0);
    for &rate in rates {
        for n in 0..films() {
            let (report, [least, most]) = filmed(contact, rate, n);
            let cor = report.cor().unwrap_or_else(|| panic!("{report}"));
            if report.verdict() == Verdict::Trusted {
                trusted += 1;
                held += u32::from(cor.low <= most && least <= cor.high);
            }
        }
    }
    println!(
        "{contact:?}: {held} of {trusted} trusted intervals hold the truth, of {} films",
        films() as usize * rates.len()
    );
    assert!(trusted as usize * 4 >= films() as usize * rates.len() * 3, "{contact:?}: only {trusted} are trusted");
    (held, trusted)
}

fn nine_of_ten(kinds: impl IntoIterator<Item = Contact>) {
    let counts: Vec<(u32, u32)> = kinds.into_iter().map(|contact| held(contact, &[30.0, 120.0])).collect();
    let (held, trusted) = counts.iter().fold((0, 0), |sum, count| (sum.0 + count.0, sum.1 + count.1));
    assert!(10 * held >= 9 * trusted, "{held} of {trusted}");
}

#[test]
fn intervals_of_balls_on_a_spring_hold_the_truth() {
    nine_of_ten([0.005, 0.01, 0.02].map(Contact::Spring));
}

#[test]
fn intervals_of_solid_balls_hold_the_truth() {
    nine_of_ten([0.005, 0.01, 0.02].map(Contact::Solid));
}

#[test]
fn intervals_of_impacts_that_take_no_time_hold_the_truth() {
    let (held, trusted) = held(Contact::Instant, &[30.0, 60.0, 120.0, 240.0]);
    assert!(100 * held >= 91 * trusted, "{held} of {trusted}");
}

/// A squash ball or a football stays on the floor for about 10 ms: without that time the COR would
/// come out up to 0.01 too high.
#[test]
fn impacts_that_last_are_found() {
    let mut noise = Noise(31);
    for rate in [30.0, 60.0, 240.0] {
        for cor in [CORS[1], CORS[3]] {
            for k in 0..3 {
                let (drop, contact) = (0.9 + 0.07 * f64::from(k), Contact::Spring(0.01));
                let ball = Ball { drop, release: 0.1, gravity: 9.81, drag: 0.0, cor, contact };
                let report = report(&csv(&noisy(&ball.film(rate, 2.2), &mut noise, 1e-3)));
                let contact = report.series()[0].contact.unwrap_or_else(|| panic!("{rate}: {report}"));
                assert!((contact.value - 0.01).abs() < 4.0 * contact.standard_error, "{rate}: {report}");
                assert!(contact.standard_error < 0.002, "{rate}: {report}");
                assert!(report.notes().iter().any(|n| n.contains("ms on the floor at the first impact")), "{report}");
                assert_eq!(report.verdict(), Verdict::Trusted, "{report}");
                assert!((report.cor().expect("a COR").value - cor(1.0)).abs() < 0.006, "{rate}: {report}");
            }
        }
    }
}

/// Of impacts that take no time nothing is said.
#[test]
fn impacts_that_take_no_time_are_left_so() {
    let mut noise = Noise(32);
    for rate in [30.0, 60.0, 240.0] {
        for k in 0..5 {
            let drop = 0.9 + 0.07 * f64::from(k);
            let ball = Ball { drop, release: 0.1, gravity: 9.81, drag: 0.0, cor: CORS[3], contact: Contact::Instant };
            let report = report(&csv(&noisy(&ball.film(rate, 2.2), &mut noise, 1e-3)));
            assert!(report.series()[0].contact.is_none() && !report.to_string().contains("impacts last"), "{report}");
            assert!((report.cor().expect("a COR").value - 0.82).abs() < 0.003, "{report}");
        }
    }
}

/// One impact does not show how long it takes: the interval reaches down to what it would be if it
/// took some milliseconds.
#[test]
fn a_single_impact_may_take_time() {
    let mut noise = Noise(34);
    let (mut held, mut all) = (0, 0);
    for cor in [CORS[0], CORS[2]] {
        for k in 0..10 {
            let (drop, contact) = (0.9 + 0.03 * f64::from(k), Contact::Spring(0.001 * f64::from(k + 1)));
            let ball = Ball { drop, release: 0.05, gravity: 9.81, drag: 0.0, cor, contact };
            let (heights, cors) = ball.watched(60.0, 0.85);
            let report = report(&csv(&noisy(&heights, &mut noise, 1e-3)));
            assert_eq!(report.series()[0].impacts.len(), 1, "{report}");
            let interval = report.cor().expect("a COR");
            held += usize::from((interval.low..=interval.high).contains(&cors[0]));
            all += 1;
            let words = report.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(words.contains("does not show how long"), "{report}");
        }
    }
    assert!(held + 2 >= all, "{held} of {all}");
}

/// One impact does not show drag and COR both: the interval holds the COR of a ball with any drag
/// up to that of a table-tennis ball, and is shorter where the drag is stated.
#[test]
fn a_single_impact_is_that_of_any_ball() {
    let mut noise = Noise(35);
    let (mut held, mut all) = (0, 0);
    for rate in [30.0, 120.0] {
        for k in 0..12 {
            let (drop, drag) = (0.8 + 0.05 * f64::from(k), 0.012 * f64::from(k));
            let ball = Ball { drop, release: 0.05, gravity: 9.81, drag, cor: CORS[3], contact: Contact::Instant };
            let (heights, cors) = ball.watched(rate, 1.0);
            let text = csv(&noisy(&heights, &mut noise, 3e-3));
            let unknown = report(&text);
            assert_eq!(unknown.series()[0].impacts.len(), 1, "{unknown}");
            let airs = unknown.widened().iter().filter(|why| matches!(why, Widening::Air { .. })).count();
            assert!(airs <= 1, "{unknown}");
            let interval = unknown.cor().expect("a COR");
            held += usize::from((interval.low..=interval.high).contains(&cors[0]));
            all += 1;
            let table = Table::parse("film.csv", text.as_bytes(), &ReadOptions::default()).expect("a table");
            let stated = Fit::new().drag(drag).run(&table).expect("a fit");
            let stated = stated.cor().expect("a COR");
            assert!(stated.high - stated.low < interval.high - interval.low, "{unknown}");
        }
    }
    assert!(held + 1 >= all, "{held} of {all}");
}

/// A ball whose impacts scatter about one COR, each by its speed, which says nothing of the COR.
fn scattering(e: f64, by: f64) -> impl Fn(f64) -> f64 {
    move |speed| e + by * (1e4 * speed).sin()
}

/// Impacts whose CORs are a hundredth apart have one COR, somewhere between theirs; those that are
/// a tenth apart do not.
#[test]
fn impacts_that_scatter_have_one_cor() {
    let said = |by: f64, n: u64| {
        let mut noise = Noise(700 + n);
        let cor = scattering(0.74, by);
        let (mut cors, mut rows) = (Vec::new(), Vec::new());
        let (mut begun, mut top) = (0.1, 1.2 + 0.1 * noise.uniform());
        // Flights by their formula, since the COR of each impact is to be its own.
        let (fall, g) = ((2.0 * top / 9.81f64).sqrt(), 9.81);
        let (mut speed, mut contact) = (g * fall, begun + fall);
        rows.extend((0..12).map(|k| f64::from(k) / 120.0).filter(|t| *t < begun).map(|t| (t, top)));
        let mut frame = rows.len();
        let mut sampled = |from: f64, to: f64, height: &dyn Fn(f64) -> f64, rows: &mut Vec<(f64, f64)>| {
            while (frame as f64) / 120.0 < to {
                rows.push((frame as f64 / 120.0, height(frame as f64 / 120.0 - from)));
                frame += 1;
            }
        };
        sampled(begun, contact, &|t| top - 0.5 * g * t * t, &mut rows);
        for _ in 0..6 {
            let e = cor(speed);
            cors.push(e);
            speed *= e;
            (begun, top) = (contact, speed);
            contact += 2.0 * speed / g;
            sampled(begun, contact, &|t| top * t - 0.5 * g * t * t, &mut rows);
        }
        (report(&csv(&noisy(&rows, &mut noise, 1e-3))), cors)
    };
    for n in 0..12 {
        let (report, cors) = said(0.004, n);
        let cor = report.cor().unwrap();
        let mean = cors[..5].iter().sum::<f64>() / 5.0;
        assert_eq!(report.verdict(), Verdict::Trusted, "{n}: {report}");
        assert!(cor.low < mean && mean < cor.high && cor.high - cor.low < 0.06, "{n}: {mean} {report}");
        let (report, _) = said(0.05, n);
        assert_ne!(report.verdict(), Verdict::Trusted, "{n}: {report}");
    }
}

/// Of a film that goes on with other drops all are fitted, and what they say together is trusted
/// where they agree; another ball is a doubt, and one that is picked up, or lies, is no drop.
#[test]
fn a_film_of_two_drops_is_of_both() {
    let ball = |drop: f64, cor: fn(f64) -> f64| Ball {
        drop,
        release: 0.2,
        gravity: 9.81,
        drag: 0.0,
        cor,
        contact: Contact::Instant,
    };
    let joined = |parts: &[Vec<(f64, f64)>]| {
        let (mut rows, mut last): (Vec<(f64, f64)>, f64) = (Vec::new(), 0.0);
        for part in parts {
            rows.extend(part.iter().map(|(t, h)| (t + last, *h)));
            last = rows.last().unwrap().0 + 1.0 / 60.0;
        }
        report(&csv(&noisy(&rows, &mut Noise(5), 2e-3)))
    };
    let first = ball(1.2, |_| 0.8).film(60.0, 3.0);
    let again = |report: &Report| report.findings().iter().any(|f| matches!(f.kind, FindingKind::DroppedAgain { .. }));
    let drops = |report: &Report| {
        report.findings().iter().find_map(|f| match f.kind {
            FindingKind::Drops { drops } => Some(drops),
            _ => None,
        })
    };
    for (drop, cor) in [(1.2, CORS[1]), (1.1, CORS[1]), (0.7, CORS[0])] {
        let report = joined(&[first.clone(), ball(drop, cor).film(60.0, 1.5)]);
        assert!(again(&report) && report.verdict() == Verdict::Doubtful, "{report}");
    }
    let others = [1.0, 1.3].map(|drop| ball(drop, |_| 0.8).film(60.0, 2.4));
    for count in [1, 2] {
        let report = joined(&[std::slice::from_ref(&first), &others[..count]].concat());
        let near = report.cor().is_some_and(|cor| (cor.value - 0.8).abs() < 0.004);
        assert!(near && drops(&report) == Some(count + 1) && report.verdict() == Verdict::Trusted, "{report}");
    }
    let lifted: Vec<(f64, f64)> = (0..90).map(|k| (f64::from(k) / 60.0, (0.02 * f64::from(k)).min(1.0))).collect();
    let lies: Vec<(f64, f64)> = (0..90).map(|k| (f64::from(k) / 60.0, 0.0)).collect();
    for then in [lifted, lies, Vec::new()] {
        let report = joined(&[first.clone(), then]);
        assert!(!again(&report) && drops(&report).is_none() && report.verdict() == Verdict::Trusted, "{report}");
    }
}

/// Two balls that are tracked in turn, now the one and now the other, are of no COR; a track that
/// leaves one ball for what stands still, or for anything, is of that ball.
#[test]
fn a_film_of_two_balls_in_turn_is_doubted() {
    let ball = |drop: f64, release: f64, cor: fn(f64) -> f64| {
        Ball { drop, release, gravity: 9.81, drag: 0.0, cor, contact: Contact::Instant }.film(60.0, 2.8)
    };
    let body = |report: &Report| report.findings().iter().any(|f| matches!(f.kind, FindingKind::AnotherBody { .. }));
    let one = ball(1.1, 0.2, |_| 0.82);
    for (n, other) in [ball(0.9, 0.35, |_| 0.6), ball(1.2, 0.3, |_| 0.7), ball(0.8, 0.25, |_| 0.55)].iter().enumerate()
    {
        // Longer turns leave the first flights whole, and what comes after them may be anything.
        for run in [1.0, 3.0] {
            let mut noise = Noise(3 + n as u64);
            let (mut which, mut rows) = (false, Vec::new());
            for (a, b) in one.iter().zip(other) {
                which ^= noise.uniform() < 0.5 / run;
                rows.push(if which { *b } else { *a });
            }
            let report = report(&csv(&noisy(&rows, &mut noise, 2e-3)));
            assert_ne!(report.verdict(), Verdict::Trusted, "{n} {run} {report}");
        }
    }
    for still in [true, false] {
        let mut noise = Noise(8);
        let stray = |noise: &mut Noise| if still { 0.4 } else { 1.2 * noise.uniform() };
        let rows: Vec<(f64, f64)> =
            one.iter().map(|&(t, h)| (t, if noise.uniform() < 0.15 { stray(&mut noise) } else { h })).collect();
        let report = report(&csv(&noisy(&rows, &mut noise, 2e-3)));
        assert!(!body(&report), "{report}");
    }
}

/// What is no motion of one ball by itself is not trusted for its first flights: a film that goes
/// on at another scale, or a ball that a hand drives down again from every top. A ball that is
/// caught and carried away is.
#[test]
fn a_ball_that_is_driven_on_is_doubted() {
    const RATE: f64 = 60.0;
    let other = |report: &Report| report.findings().iter().any(|f| matches!(f.kind, FindingKind::OtherMotion { .. }));
    for n in 0..cases(48) {
        let mut noise = Noise(u64::from(n) + 900);
        let ball = |noise: &mut Noise, cor: fn(f64) -> f64| Ball {
            drop: 0.8 + 0.4 * noise.uniform(),
            release: 0.1,
            gravity: 9.81,
            drag: 0.0,
            cor,
            contact: Contact::Instant,
        };
        let cor = CORS[1 + n as usize % 3];
        // Up to a time within the flight after the second contact.
        let fall = |drop: f64| (2.0 * drop / 9.81).sqrt();
        let first = ball(&mut noise, cor);
        let (e, begun) = (cor(1.0), 0.1 + fall(first.drop));
        let flight = 2.0 * e * fall(first.drop);
        let end = begun + flight + e * flight * (0.2 + 0.6 * noise.uniform());
        let mut rows = first.film(RATE, end);
        let later = |rows: &[(f64, f64)]| rows.len() as f64 / RATE;
        match n % 4 {
            0 | 1 => {
                let scale = if n % 4 == 0 { 0.35 + 0.25 * noise.uniform() } else { 1.7 + noise.uniform() };
                let other = ball(&mut noise, CORS[1 + (n as usize + 1) % 3]).film(RATE, 3.0);
                for (_, height) in &other[(0.3 * RATE) as usize..] {
                    rows.push((later(&rows), scale * height));
                }
            }
            2 => {
                let (top, falls) = (e * e * first.drop, 14.0 + 10.0 * noise.uniform());
                let (up, down) = ((2.0 * top / 9.81).sqrt(), (2.0 * top / falls).sqrt());
                rows.truncate((RATE * (begun + flight)) as usize);
                for _ in 0..(2.0 * RATE) as usize {
                    let t = (later(&rows) - begun - flight).rem_euclid(up + down);
                    let below = if t < up { 0.5 * 9.81 * (up - t).powi(2) } else { 0.5 * falls * (t - up).powi(2) };
                    rows.push((later(&rows), top - below));
                }
            }
            _ => {
                let (held, up) = (rows[rows.len() - 1].1, 0.3 + 0.6 * noise.uniform());
                for k in 0..(1.5 * RATE) as usize {
                    let part = (k as f64 / RATE).min(1.0);
                    rows.push((later(&rows), held + 0.5 * up * (1.0 - (std::f64::consts::PI * part).cos())));
                }
            }
        }
        let report = report(&csv(&noisy(&rows, &mut noise, 1e-3)));
        if n % 4 == 3 {
            assert!(!other(&report) && report.verdict() == Verdict::Trusted, "{n} {report}");
        } else {
            assert_ne!(report.verdict(), Verdict::Trusted, "{n} {report}");
        }
    }
}

/// What swings, or stands on a spring, bounces nowhere: no such motion is trusted, whatever its
/// rate, its noise and how fast it dies away.
#[test]
fn what_swings_is_not_trusted() {
    let soft = |report: &Report| report.findings().iter().any(|f| matches!(f.kind, FindingKind::Soft { .. }));
    let mut smooth = 0;
    for n in 0..72 {
        let mut noise = Noise(n);
        let [period, size, phase] = [0.6 + 1.9 * noise.uniform(), 0.05 + noise.uniform(), 6.0 * noise.uniform()];
        let dies = if n % 2 == 0 { 0.0 } else { 0.3 * noise.uniform() };
        let rate = [24.0, 30.0, 60.0, 120.0][n as usize / 3 % 4];
        let height = |t: f64| {
            let (angle, left) = (std::f64::consts::TAU * t / period + phase, size * (-dies * t).exp());
            match n % 3 {
                // A pendulum, a weight on a spring that dies away about its middle, an arc cut off.
                0 => left * (0.5 * angle).cos().powi(2),
                1 => size + left * angle.cos(),
                _ => left * (0.5 * angle).cos().abs(),
            }
        };
        let rows: Vec<(f64, f64)> =
            (0..(5.0 * rate) as u32).map(|k| f64::from(k) / rate).map(|t| (t, height(t))).collect();
        let table =
            Table::parse("t.csv", csv(&noisy(&rows, &mut noise, 0.005 * size)).as_bytes(), &ReadOptions::default());
        let Ok(table) = table else { continue };
        let report = Fit::new().run(&table).unwrap();
        assert_ne!(report.verdict(), Verdict::Trusted, "{n}: {report}");
        smooth += u32::from(soft(&report));
    }
    assert!(smooth > 10, "{smooth}");
}

/// What a hand does after the bounces is no flight: it catches the ball on its way up or down,
/// holds it there, or lifts it.
#[test]
fn a_hand_ends_the_flights() {
    for (n, seconds) in (0u32..12).map(|n| (n, 1.25 + 0.08 * f64::from(n))) {
        let ball = Ball { drop: 1.2, release: 0.1, gravity: 9.81, drag: 0.0, cor: |_| 0.78, contact: Contact::Instant };
        let rows = ball.film(60.0, seconds);
        let &(last, height) = rows.last().unwrap();
        for lift in [0.0, 0.3, 1.0] {
            let hand = |k: u32| (last + f64::from(k) / 60.0, height + lift * (f64::from(k) / 60.0).min(1.0));
            let caught: Vec<(f64, f64)> = rows.iter().copied().chain((1..60).map(hand)).collect();
            let report = report(&csv(&noisy(&caught, &mut Noise(n.into()), 2e-3)));
            let cor = report.cor().unwrap_or_else(|| panic!("{seconds} {lift}: {report}"));
            assert_eq!(report.verdict(), Verdict::Trusted, "{seconds} {lift}: {report}");
            assert!(cor.low < 0.78 && 0.78 < cor.high && cor.high - cor.low < 0.05, "{seconds} {lift}: {report}");
        }
    }
}
