//! What devices show of a bouncing ball: accelerations, states of a switch or a beam, triggers,
//! samples of a sound, speeds. Their COR is planted, and found whatever they are called.

use std::f64::consts::PI;

use crate::noise::Noise;
use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Report, Verdict};

/// A ball that is let go at `at`, first hits with `speed`, m/s, and stays on the floor for `lasts`.
#[derive(Clone, Copy, Debug)]
struct Ball {
    cor: f64,
    at: f64,
    speed: f64,
    lasts: f64,
}

const G: f64 = 9.81;

impl Ball {
    /// The contacts as begin and speed before it, to the last flight of `shortest`.
    fn contacts(&self, shortest: f64) -> Vec<(f64, f64)> {
        let (mut begin, mut speed, mut found) = (self.at + self.speed / G, self.speed, Vec::new());
        while 2.0 * self.cor * speed / G > shortest {
            found.push((begin, speed));
            speed *= self.cor;
            begin += self.lasts + 2.0 * speed / G;
        }
        found.push((begin, speed));
        found
    }

    /// The acceleration of the ball that it feels at a time: one at rest, none in flight, in
    /// gravities.
    fn felt(&self, t: f64) -> f64 {
        let contacts = self.contacts(0.03);
        let (last, _) = contacts[contacts.len() - 1];
        if t < self.at || t > last + self.lasts {
            return 1.0;
        }
        let hit = contacts.iter().find(|(begin, _)| (0.0..self.lasts).contains(&(t - begin)));
        hit.map_or(0.0, |(begin, speed)| {
            let push = (1.0 + self.cor) * speed / G / self.lasts * 0.5 * PI;
            push * (PI * (t - begin) / self.lasts).sin()
        })
    }
}

fn near(cor: f64, e: f64, within: f64) -> bool {
    (cor - e).abs() < within
}

fn cor(report: &Report) -> f64 {
    report.cor().unwrap_or_else(|| panic!("{report}")).value
}

fn lines(header: &str, rows: impl IntoIterator<Item = String>) -> String {
    header.to_owned() + "\n" + &rows.into_iter().map(|row| row + "\n").collect::<String>()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// What a ball with an accelerometer in it, or a phone, feels: with gravity or without it,
    /// which way it lies, whether it turns, how hard it clips and how its clock runs.
    #[test]
    fn a_ball_feels_its_contacts(
        e in 0.62f64..0.85,
        form in 0usize..4,
        clip in 4.0f64..20.0,
        turns in any::<bool>(),
        jitter in 0.0f64..0.12,
        seed in 0u64..1000,
    ) {
        let ball = Ball { cor: e, at: 0.6, speed: 4.2, lasts: 0.011 };
        let mut noise = Noise(seed);
        let (rate, unit): (f64, f64) = [(1000.0, 1.0), (400.0, G), (800.0, G), (500.0, 1000.0)][form];
        let header = [
            "t_us,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps",
            "\"Time (s)\",\"Acceleration x (m/s^2)\",\"Acceleration y (m/s^2)\",\"Acceleration z (m/s^2)\"",
            "Time (s),Linear Acceleration x (m/s^2),Linear Acceleration y (m/s^2),Linear Acceleration z (m/s^2)",
            "time_ms,acc_x (mg),acc_y (mg),acc_z (mg)",
        ][form];
        let axis = |spin: f64| [spin.sin(), 0.2, spin.cos()].map(|a| a / 1.04f64.sqrt());
        let row = |n: usize| {
            let t = (n as f64 + jitter * (noise.uniform() - 0.5)) / rate;
            let g = if form == 2 { 1.0 } else { 0.0 };
            let spin = if turns && form != 2 { 3.0 * t } else { 0.4 };
            let parts = axis(spin).map(|a| (a * (ball.felt(t) - g) + noise.normal(0.012)).clamp(-clip, clip) * unit);
            let time = match form { 0 => format!("{:.0}", 1e6 * t + 3.1e6), 3 => format!("{:.2}", 1e3 * t), _ => format!("{t:.6}") };
            let parts = parts.map(|part| format!("{part:.4}")).join(",");
            let beside = if form == 0 { format!(",{:.1},{:.1},{:.1}", noise.normal(2.0), 90.0 * t, noise.normal(2.0)) } else { String::new() };
            format!("{time},{parts}{beside}")
        };
        let text = lines(header, (0..(5.0 * rate) as usize).map(row));
        let report = fit(&text);
        prop_assert!(near(cor(&report), e, 0.012) && report.verdict() == Verdict::Trusted, "{e} {report}");
    }

    /// A switch that the ball closes while it touches: its changes, or its samples, in numbers or
    /// in words, whichever of the two states is that of a contact, and though it chatters.
    #[test]
    fn a_ball_closes_a_switch(e in 0.72f64..0.94, lasts in 2e-4f64..0.01, form in 0usize..4) {
        let ball = Ball { cor: e, at: 0.7, speed: 2.6, lasts };
        // A contact lasts the longer the slower the ball is.
        let contacts = ball.contacts(0.05);
        let contacts: Vec<(f64, f64)> = contacts.iter().map(|(begin, speed)| (*begin, lasts * (speed / 2.6).powf(-0.2))).collect();
        let text = match form {
            0 => {
                let changes = contacts.iter().flat_map(|(begin, lasts)| [format!("{begin:.6}, 1"), format!("{:.6}, 0", begin + lasts)]);
                lines("; exported changes\nTime[s], Channel 0", std::iter::once("0.0, 0".to_owned()).chain(changes))
            }
            1 => {
                let changes = contacts.iter().flat_map(|(begin, lasts)| {
                    let ms = |t: f64| format!("{:.3}", 1e3 * t);
                    [ms(*begin) + ";low", ms(begin + 0.3 * lasts) + ";high", ms(begin + 0.35 * lasts) + ";low", ms(begin + lasts) + ";high"]
                });
                lines("t (ms);D3", changes)
            }
            2 => {
                let touched = |t: f64| contacts.iter().any(|(begin, lasts)| (0.0..lasts.max(6e-4)).contains(&(t - begin)));
                lines("time (s),state", (0..16_000).map(|n| 2.5e-4 * f64::from(n)).map(|t| format!("{t:.5},{}", i32::from(touched(t)))))
            }
            _ => {
                let changes = contacts.iter().flat_map(|(begin, lasts)| [format!("{:.0},closed", 1e6 * begin), format!("{:.0},open", 1e6 * (begin + lasts))]);
                lines("us,contact", changes)
            }
        };
        prop_assert!(near(trusted(&text), e, 0.01), "{form} {e} {}", fit(&text));
    }

    /// A ball that blocks one beam on its way down and up, whatever its height and the ball's size.
    #[test]
    fn a_beam_is_blocked_twice_a_bounce(e in 0.7f64..0.9, beam in 0.02f64..0.1, size in 0.02f64..0.05, words in any::<bool>()) {
        let ball = Ball { cor: e, at: 0.3, speed: 3.6, lasts: 0.0 };
        let contacts = ball.contacts(0.05);
        // When it is at a height after the contact n, on its way up.
        let up = |speed: f64, height: f64| (speed > (2.0 * G * height).sqrt()).then(|| (speed - (speed * speed - 2.0 * G * height).sqrt()) / G);
        let mut changes = Vec::new();
        for (begin, speed) in &contacts {
            let spans = [(*speed, -1.0), (e * speed, 1.0)].map(|(speed, sign)| {
                let [low, high] = [beam, beam + size].map(|height| up(speed, height).map(|t| begin + sign * t));
                low.zip(high)
            });
            let [Some(down), Some(rise)] = spans else { break };
            changes.extend([(down.1, true), (down.0, false), (rise.0, true), (rise.1, false)]);
        }
        let state = |blocked: bool| match (words, blocked) { (true, true) => "Blocked", (true, false) => "Unblocked", (_, true) => "1", _ => "0" };
        let rows = changes.iter().map(|(t, blocked)| format!("{t:.5},{}", state(*blocked)));
        let text = lines("Photogate on a stand\nTime (s),Gate state", rows);
        prop_assume!(changes.len() >= 16);
        prop_assert!(near(trusted(&text), e, 0.008), "{e} {}", fit(&text));
    }

    /// A log of triggers with how strong they were, some of them twice.
    #[test]
    fn triggers_may_come_twice(e in 0.65f64..0.9, form in 0usize..3, seed in 0u64..100) {
        let ball = Ball { cor: e, at: 0.0, speed: 3.4, lasts: 0.0 };
        let mut noise = Noise(seed);
        let mut rows = Vec::new();
        for (n, (begin, speed)) in ball.contacts(0.08).into_iter().enumerate() {
            let size = (250.0 * speed + noise.normal(6.0)).clamp(1.0, 1023.0);
            rows.push((begin + 40.0, size));
            if n % 3 == 1 {
                rows.push((begin + 40.0 + 0.009 + 0.006 * noise.uniform(), 0.15 * size));
            }
        }
        let header = ["t_ms,peak", "time (s);level", "timestamp_us,adc_max"][form];
        let row = |(t, size): (f64, f64)| match form {
            0 => format!("{:.1},{size:.0}", 1e3 * t),
            1 => format!("{t:.4};{size:.1}"),
            _ => format!("{:.0},{size:.0}", 1e6 * t),
        };
        let text = lines(header, rows.into_iter().map(row));
        prop_assert!(near(trusted(&text), e, 0.012), "{e} {}", fit(&text));
        // What fades by no order is of anything.
        let other = lines("t_ms,count of people", (0..12).map(|n| format!("{:.1},{}", 900.0 * f64::from(n) + 200.0 * noise.uniform(), n % 5)));
        prop_assert!(read(&other).is_err() || fit(&other).verdict() != Verdict::Trusted, "{other}");
    }

    /// Samples of a sound in one column, whose rate a line above them states.
    #[test]
    fn samples_of_a_stated_rate_need_no_name(e in 0.7f64..0.9, rate in prop::sample::select(vec![4000u32, 8000, 11025]), seed in 0u64..100) {
        let ball = Ball { cor: e, at: 0.2, speed: 2.9, lasts: 0.0 };
        let contacts = ball.contacts(0.08);
        let mut noise = Noise(seed);
        let sample = |n: u32| {
            let t = f64::from(n) / f64::from(rate);
            let rings = |(begin, speed): &(f64, f64)| {
                let after = t - begin;
                if after > 0.0 { 0.15 * speed * (-after / 0.006).exp() * (2.0 * PI * 1100.0 * after).sin() } else { 0.0 }
            };
            format!("{:.5}", contacts.iter().map(rings).sum::<f64>() + noise.normal(0.002))
        };
        let header = format!("take 2.txt   1 channel (mono)\nSample Rate: {rate} Hz.  Sample values on linear scale.");
        let text = lines(&header, (0..3 * rate).map(sample));
        prop_assert!(near(trusted(&text), e, 0.01), "{e} {}", fit(&text));
    }

    /// Speeds of a ball in flight, upwards and downwards alike or not, none below what a radar
    /// shows; so often that six of them tell the third flight.
    #[test]
    fn the_speed_of_a_ball_tells_its_contacts(
        e in 0.65f64..0.88,
        form in 0usize..4,
        dead in 0.0f64..0.35,
        rate in 50.0f64..120.0,
        seed in 0u64..100,
    ) {
        let ball = Ball { cor: e, at: 0.4, speed: 5.2, lasts: 0.006 };
        let contacts = ball.contacts(0.04);
        let speed = |t: f64| match contacts.iter().rev().find(|(begin, _)| *begin <= t) {
            None => -(G * (t - ball.at)).max(0.0),
            Some((begin, speed)) if t < begin + ball.lasts => -speed * (1.0 - (1.0 + e) * (t - begin) / ball.lasts),
            Some((begin, speed)) if *speed > contacts[contacts.len() - 1].1 => e * speed - G * (t - begin - ball.lasts),
            Some(_) => 0.0,
        };
        let (header, unit, signed) = [
            ("time,speed", 3.6, false),
            ("Time (s),Speed (m/s)", 1.0, false),
            ("t (s);velocity (m/s)", 1.0, true),
            ("time (s),speed (mph)", 1.0 / 0.44704, false),
        ][form];
        let mut noise = Noise(seed);
        let row = |n: usize| {
            let t = n as f64 / rate;
            let v = speed(t);
            let shown = if v.abs() < dead { 0.0 } else { unit * (v + noise.normal(0.03)) };
            let mark = if header.contains(';') { ';' } else { ',' };
            format!("{t:.3}{mark}{:.1}", if signed { -shown } else { shown.abs() })
        };
        let text = lines(&format!("# radar above a rubber ball\n{header}"), (0..(4.5 * rate) as usize).map(row));
        let report = fit(&text);
        prop_assert!(near(cor(&report), e, 0.02), "{e} {report}");
    }
}

/// A phone that lies, is carried, or is shaken, shows no ball; nor does a speed that falls and
/// rises otherwise than in flight.
#[test]
fn what_moves_otherwise_is_no_ball() {
    let mut noise = Noise(4);
    let header = "time (s),acceleration x (m/s²),acceleration y (m/s²),acceleration z (m/s²)";
    let moves: [fn(f64) -> f64; 3] =
        [|_| 0.0, |t| 6.0 * (PI * 3.6 * t).sin(), |t| if (t * 1.7).fract() < 0.02 { 30.0 } else { 0.0 }];
    for moves in moves {
        let row = |n: i32| {
            let t = 0.0025 * f64::from(n);
            format!(
                "{t:.4},{:.3},{:.3},{:.3}",
                noise.normal(0.05),
                noise.normal(0.05),
                G + moves(t) + noise.normal(0.05)
            )
        };
        let text = lines(header, (0..2000).map(row));
        assert!(read(&text).is_err() || fit(&text).verdict() != Verdict::Trusted, "{text:.200}");
    }
    let speeds: [fn(f64) -> f64; 2] = [|t| 3.0 * (2.0 * t).sin().abs(), |t| 2.0 + (3.0 * t).cos()];
    for speed in speeds {
        let rows = (0..300).map(|n| 0.02 * f64::from(n)).map(|t| format!("{t:.2},{:.2}", speed(t)));
        let text = lines("time (s),speed (m/s)", rows);
        assert!(read(&text).is_err() || fit(&text).verdict() != Verdict::Trusted, "{text:.200}");
    }
}
