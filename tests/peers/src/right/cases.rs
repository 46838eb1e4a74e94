//! The cases, and what is right.

use super::{Answer, Guard, Jumps, State, System};

const G: f64 = 9.8;
/// How long a fall from 1 m takes.
const FALL: f64 = 0.451_753_951_452_625_6;

/// A question, its answer, and a judge.
pub struct Case {
    pub name: &'static str,
    pub title: &'static str,
    pub right: &'static str,
    /// How many systems it consists of.
    pub runs: usize,
    pub system: fn(usize) -> System,
    /// What is wrong with an answer; nothing if it is right.
    pub wrong: fn(usize, &Answer) -> Option<String>,
    /// Whether an error is the right answer.
    pub refusal: bool,
}

/// A ball that keeps the part `e` of its speed, and what else is watched; `y` and `v` are the first
/// two coordinates.
fn ball(start: [f64; 2], span: [f64; 2], e: f64) -> System {
    System {
        start: [start[0], start[1], 0.0, 0.0],
        span,
        flow: Box::new(|_, x| [x[1], -G, 0.0, 0.0]),
        guards: vec![Box::new(|_, x| x[0])],
        jumps: Jumps::Reset { reset: Box::new(move |_, x, lift| [lift, -e * x[1], 0.0, 0.0]), rest: Some([0.0; 4]) },
        every: None,
    }
}

/// A flow along which a guard's crossings are written down.
fn written(start: State, end: f64, flow: fn(f64, &State) -> State, above: bool, guard: Guard) -> System {
    let flow = Box::new(flow);
    System { start, span: [0.0, end], flow, guards: vec![guard], jumps: Jumps::None(above), every: None }
}

fn oscillator(_: f64, x: &State) -> State {
    [x[1], -x[0], 0.0, 0.0]
}

fn thrown(_: f64, x: &State) -> State {
    [x[1], -G, 0.0, 0.0]
}

/// The events are these, by guard and time, and the run came to its end.
fn events(answer: &Answer, end: f64, expected: &[(usize, f64)], within: f64) -> Option<String> {
    let shown = |times: &[(usize, f64)]| {
        let first: Vec<_> = times.iter().take(3).map(|(_, t)| format!("{t:.7}")).collect();
        let more = if times.len() > 3 { ", …" } else { "" };
        format!("{} at {}{more}", count(times.len(), "event"), first.join(", "))
    };
    let close = |(a, b): (&(usize, f64), &(usize, f64))| a.0 == b.0 && (a.1 - b.1).abs() <= within;
    if answer.events.len() != expected.len() {
        return Some(if answer.events.is_empty() { "no event".into() } else { shown(&answer.events) });
    }
    if !answer.events.iter().zip(expected).all(close) {
        return Some(shown(&answer.events));
    }
    ended(answer, end)
}

/// The run came to its end.
fn ended(answer: &Answer, end: f64) -> Option<String> {
    ((answer.end.0 - end).abs() > 1e-9).then(|| format!("stops at t = {:.6}", answer.end.0))
}

fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// The ball lies on the floor.
fn at_rest(answer: &Answer, end: f64) -> Option<String> {
    let (t, [y, v, ..]) = answer.end;
    let impacts = count(answer.events.len(), "impact");
    if answer.endless() {
        Some(format!("{impacts} without an end, at t = {t:.6}"))
    } else if (t - end).abs() > 1e-9 {
        Some(format!("stops at t = {t:.6}, after {impacts}"))
    } else if y.abs() > 1e-9 || v.abs() > 1e-6 {
        Some(format!("y = {y:.2} m after {impacts}"))
    } else {
        None
    }
}

/// Where the `i`-th of 200 pairs of crossings begins.
fn pair(i: usize) -> f64 {
    0.049 * (i as f64 + 0.5)
}

/// The first impact of a ball at 1 m, and the end of that flight.
fn landed(height: f64, speed: f64, answer: &Answer, i: usize, end: f64) -> Option<String> {
    let (t, x) = answer.end;
    if (t - end).abs() > 1e-9 {
        return Some(format!("stops at t = {t:.6}"));
    }
    let [y, v] = [x[i], x[i + 1]];
    ((y - height).abs() > 1e-7 || (v - speed).abs() > 1e-7).then(|| format!("ball {} at y = {y:.4} m", i / 2 + 1))
}

pub const CASES: [Case; 15] = [
    Case {
        name: "drop",
        title: "a ball dropped from 1 m: its first impact",
        right: "0.4517540 s",
        runs: 1,
        system: |_| ball([1.0, 0.0], [0.0, 0.6], 0.8),
        wrong: |_, answer| events(answer, 0.6, &[(0, FALL)], 1e-9),
        refusal: false,
    },
    Case {
        name: "pair",
        title: "two crossings 2 ms apart along an oscillator, in 200 places",
        right: "both, in each",
        runs: 200,
        system: |i| {
            let a = pair(i);
            let guard = move |t: f64, _: &State| (t - a) * (t - (a + 2e-3));
            written([1.0, 0.0, 0.0, 0.0], 10.0, oscillator, true, Box::new(guard))
        },
        wrong: |i, answer| {
            let times: Vec<f64> = answer.events.iter().map(|event| event.1).collect();
            let near = |t: f64, a: f64| (t - a).abs() < 1e-6;
            let found = matches!(*times, [a, b] if near(a, pair(i)) && near(b, pair(i) + 2e-3));
            (!found).then(|| count(times.len(), "event"))
        },
        refusal: false,
    },
    Case {
        name: "apex",
        title: "a line 10 nm below the apex of a throw, crossed up and down",
        right: "1.0101074 and 1.0101977 s",
        runs: 1,
        system: |_| {
            let speed = (2.0 * G * (5.0 + 1e-8)).sqrt();
            written([0.0, speed, 0.0, 0.0], 1.5, thrown, false, Box::new(|_, x| x[0] - 5.0))
        },
        wrong: |_, answer| {
            let times: Vec<f64> = answer.events.iter().map(|event| event.1).collect();
            let near = |t: f64, a: f64| (t - a).abs() < 1e-6;
            let found = matches!(*times, [a, b] if near(a, 1.010_107_370_167_218) && near(b, 1.010_197_720_957_508_6));
            (!found).then(|| if times.is_empty() { "no event".into() } else { count(times.len(), "event") })
        },
        refusal: false,
    },
    Case {
        name: "step-end",
        title: "a crossing at 0.5 s, exactly where a step of 0.125 s ends",
        right: "once",
        runs: 1,
        system: |_| {
            let line = written([0.0; 4], 1.0, |_, _| [1.0, 0.0, 0.0, 0.0], true, Box::new(|_, x| 0.5 - x[0]));
            System { every: Some(0.125), ..line }
        },
        wrong: |_, answer| events(answer, 1.0, &[(0, 0.5)], 1e-9),
        refusal: false,
    },
    Case {
        name: "at-start",
        title: "a ball that starts on the floor, moving down at 3 m/s, e = 1",
        right: "impacts at 0 and 0.6122449 s",
        runs: 1,
        system: |_| ball([0.0, -3.0], [0.0, 0.7], 1.0),
        wrong: |_, answer| events(answer, 0.7, &[(0, 0.0), (0, 6.0 / G)], 1e-9),
        refusal: false,
    },
    Case {
        name: "launch",
        title: "a ball launched from exactly the floor at 5 m/s",
        right: "one impact, at 1.0204082 s",
        runs: 1,
        system: |_| ball([0.0, 5.0], [0.0, 1.5], 1.0),
        wrong: |_, answer| events(answer, 1.5, &[(0, 10.0 / G)], 1e-9),
        refusal: false,
    },
    Case {
        name: "order",
        title: "floor and a line at 0.9 m, listed in this order; a fall from 1 m",
        right: "0.1428571 s the line, then the floor",
        runs: 1,
        system: |_| {
            let ball = ball([1.0, 0.0], [0.0, 0.6], 0.8);
            let reset = |i: usize, x: &State, lift| if i == 0 { [lift, -0.8 * x[1], 0.0, 0.0] } else { *x };
            let guards: Vec<Guard> = vec![Box::new(|_, x| x[0]), Box::new(|_, x| x[0] - 0.9)];
            System { guards, jumps: Jumps::Reset { reset: Box::new(reset), rest: None }, ..ball }
        },
        wrong: |_, answer| events(answer, 0.6, &[(1, 1.0 / 7.0), (0, FALL)], 1e-9),
        refusal: false,
    },
    Case {
        name: "two-balls",
        title: "two balls dropped from 1 m together, e = 0.8, after 0.6 s",
        right: "both bounced",
        runs: 1,
        system: |_| System {
            start: [1.0, 0.0, 1.0, 0.0],
            span: [0.0, 0.6],
            flow: Box::new(|_, x| [x[1], -G, x[3], -G]),
            guards: vec![Box::new(|_, x| x[0]), Box::new(|_, x| x[2])],
            jumps: Jumps::Reset {
                reset: Box::new(|i, x, lift| {
                    let mut after = *x;
                    (after[2 * i], after[2 * i + 1]) = (lift, -0.8 * x[2 * i + 1]);
                    after
                }),
                rest: None,
            },
            every: None,
        },
        wrong: |_, answer| {
            let s = 0.6 - FALL;
            let (up, v) = (0.8 * G * FALL, 0.8 * G * FALL - G * s);
            let y = up * s - 0.5 * G * s * s;
            landed(y, v, answer, 0, 0.6).or_else(|| landed(y, v, answer, 2, 0.6))
        },
        refusal: false,
    },
    Case {
        name: "corner",
        title: "a ball into a corner: both walls at 0.5 s",
        right: "back at the start after 1 s",
        runs: 1,
        system: |_| System {
            start: [0.0, 1.0, 0.0, 1.0],
            span: [0.0, 1.0],
            flow: Box::new(|_, x| [x[1], 0.0, x[3], 0.0]),
            guards: vec![Box::new(|_, x| 0.5 - x[0]), Box::new(|_, x| 0.5 - x[2])],
            jumps: Jumps::Reset {
                reset: Box::new(|i, x, lift| {
                    let mut after = *x;
                    (after[2 * i], after[2 * i + 1]) = (0.5 - lift, -x[2 * i + 1]);
                    after
                }),
                rest: None,
            },
            every: None,
        },
        wrong: |_, answer| {
            let (_, [x, _, y, _]) = answer.end;
            let out = (x.abs() > 1e-9 || y.abs() > 1e-9).then(|| format!("at ({x:.3}, {y:.3})"));
            ended(answer, 1.0).or(out)
        },
        refusal: false,
    },
    Case {
        name: "zeno",
        title: "a ball with e = 0.5, beyond the limit of its impacts at 1.355 s: where it is at 3 s",
        right: "on the floor",
        runs: 1,
        system: |_| ball([1.0, 0.0], [0.0, 3.0], 0.5),
        wrong: |_, answer| at_rest(answer, 3.0),
        refusal: false,
    },
    Case {
        name: "plastic",
        title: "a ball with e = 0 at 2 s",
        right: "on the floor",
        runs: 1,
        system: |_| ball([1.0, 0.0], [0.0, 2.0], 0.0),
        wrong: |_, answer| at_rest(answer, 2.0),
        refusal: false,
    },
    Case {
        name: "late",
        title: "a clock of 1 kHz, ten seconds long, from t = 10⁶ s",
        right: "10000 ticks, each within 1 ns",
        runs: 1,
        system: |_| System {
            start: [0.0; 4],
            span: [1e6, 1e6 + 10.0005],
            flow: Box::new(|_, _| [1.0, 0.0, 0.0, 0.0]),
            guards: vec![Box::new(|_, x| 1e-3 - x[0])],
            jumps: Jumps::Reset { reset: Box::new(|_, _, _| [0.0; 4]), rest: None },
            every: None,
        },
        wrong: |_, answer| {
            let off = |(k, event): (usize, &(usize, f64))| (event.1 - (1e6 + 1e-3 * (k + 1) as f64)).abs();
            let worst = answer.events.iter().enumerate().map(off).fold(0.0, f64::max);
            let ticks = count(answer.events.len(), "tick");
            (answer.events.len() != 10_000 || worst > 1e-9).then(|| format!("{ticks}, off by up to {worst:.0e} s"))
        },
        refusal: false,
    },
    Case {
        name: "cubed",
        title: "the guard (y - 3 m)³ on a throw at 10 m/s",
        right: "0.36544 and 1.67538 s",
        runs: 1,
        system: |_| written([0.0, 10.0, 0.0, 0.0], 2.0, thrown, false, Box::new(|_, x| (x[0] - 3.0).powi(3))),
        wrong: |_, answer| events(answer, 2.0, &[(0, 0.365_436_467_923_215_8), (0, 1.675_379_858_607_396_5)], 1e-5),
        refusal: false,
    },
    Case {
        name: "squared",
        title: "the guard (y - 3 m)², which touches zero twice and never crosses it",
        right: "no event",
        runs: 1,
        system: |_| written([0.0, 10.0, 0.0, 0.0], 2.0, thrown, true, Box::new(|_, x| (x[0] - 3.0).powi(2))),
        wrong: |_, answer| events(answer, 2.0, &[], 0.0),
        refusal: false,
    },
    Case {
        name: "nan",
        title: "a guard that is not a number from t = 0.5 on",
        right: "an error that says so",
        runs: 1,
        system: |_| {
            let guard = |t: f64, _: &State| 0.1 + (0.5 - t).sqrt();
            written([1.0, 0.0, 0.0, 0.0], 1.0, oscillator, true, Box::new(guard))
        },
        wrong: |_, answer| answer.error.is_none().then(|| "ends as if nothing had been".into()),
        refusal: true,
    },
];
