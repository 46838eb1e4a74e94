//! What a reader of a file measures is at most what the export says of it: random motions in space,
//! formats, frame rates, squash and stretch.

use crate::glb::{channels, seen};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_motion::{Contact, Export, File, Format, Frames, Motion, Piece, Shape, Stretch, Track};
use serde_json::Value;

use crate::glb;

/// What single precision and the digits of a picture add, of the size of the motion.
const READER: f64 = 2e-6;
/// At so many times a reader looks.
const LOOKS: u32 = 1500;

/// One number of a picture as it goes: what it moves, and its keys with the handles' progress.
struct Moving {
    how: String,
    keys: Vec<(f64, f64, Option<[f64; 2]>)>,
}

impl Moving {
    fn at(&self, t: f64) -> f64 {
        let next = self.keys.partition_point(|key| key.0 <= t);
        match (next.checked_sub(1).map(|n| self.keys[n]), self.keys.get(next)) {
            (Some((start, p, Some([a, b]))), Some(&(end, q, _))) => {
                // Handles stand at a third and two thirds of the time, so that it is the parameter.
                let u = (t - start) / (end - start);
                let w = 1.0 - u;
                p + (q - p) * (3.0 * a * u * w * w + 3.0 * b * u * u * w + u * u * u)
            }
            (Some((_, p, _)), _) => p,
            (None, first) => first.unwrap().1,
        }
    }
}

/// A ball in a picture: groups within groups, around a disc.
struct Picture {
    moves: Vec<Moving>,
    /// Where the outermost group starts.
    from: [f64; 2],
    radius: f64,
    ground: f64,
}

impl Picture {
    /// The height of the lowest point, in radii of the disc.
    fn low(&self, t: f64) -> f64 {
        let ([mut x, mut y], mut m) = (self.from, [[1.0, 0.0], [0.0, 1.0]]);
        for moving in &self.moves {
            let by = moving.at(t);
            match moving.how.as_str() {
                "x" => (x, y) = (x + m[0][0] * by, y + m[1][0] * by),
                "y" => (x, y) = (x + m[0][1] * by, y + m[1][1] * by),
                "turn" => {
                    let (sin, cos) = by.to_radians().sin_cos();
                    m = m.map(|[a, b]| [a * cos + b * sin, b * cos - a * sin]);
                }
                "wide" => m = m.map(|[a, b]| [a * by, b]),
                _ => m = m.map(|[a, b]| [a, b * by]),
            }
        }
        let _ = x;
        (self.ground - y) / self.radius - m[1][0].hypot(m[1][1])
    }
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

fn svg(file: &File) -> Picture {
    let text = std::str::from_utf8(&file.bytes).unwrap();
    let between = |text: &str, from: &str, to: &str| -> Option<String> {
        Some(text.split_once(from)?.1.split_once(to)?.0.to_owned())
    };
    let duration = number(&between(text, "animation-duration:", "s").unwrap());
    let names = text.split("animation-name:").skip(1).map(|rest| rest.split_once('"').unwrap().0);
    let moving = |name: &str| {
        let rules = between(text, &format!("@keyframes {name}{{"), "\n}\n").unwrap();
        let mut how = String::new();
        let keys = rules.trim().lines().map(|line| {
            let t = duration * number(line.split('%').next().unwrap()) / 100.0;
            let (what, value) = between(line, "transform:", ")")
                .unwrap()
                .split_once('(')
                .map(|(a, b)| (a.to_owned(), b.to_owned()))
                .unwrap();
            how = match what.as_str() {
                "translateX" => "x",
                "translateY" => "y",
                "rotate" => "turn",
                "scaleX" => "wide",
                _ => "high",
            }
            .to_owned();
            let handles = between(line, "cubic-bezier(", ")").map(|numbers| {
                let numbers: Vec<f64> = numbers.split(',').map(number).collect();
                [numbers[1], numbers[3]]
            });
            (t, number(value.trim_end_matches("px").trim_end_matches("deg")), handles)
        });
        let keys = keys.collect();
        Moving { how, keys }
    };
    let from: Vec<f64> = between(text, "translate(", ")").unwrap().split(' ').map(number).collect();
    let ground = between(text, "points=\"", " ").unwrap();
    Picture {
        moves: names.map(moving).collect(),
        from: [from[0], from[1]],
        radius: number(&between(text, "data-radius=\"", "\"").unwrap()),
        ground: number(ground.split(',').nth(1).unwrap()),
    }
}

fn lottie(file: &File) -> Picture {
    let document: Value = serde_json::from_slice(&file.bytes).unwrap();
    let rate = document["fr"].as_f64().unwrap();
    let layers = document["layers"].as_array().unwrap();
    let (ground, balls) = layers.split_last().unwrap();
    let one = |value: &Value| value.as_f64().unwrap();
    let moves = balls.iter().flat_map(|layer| {
        let moved = |key: &str, axis: usize, how: &str, per: f64| {
            let keys = layer["ks"][key]["k"].as_array().filter(|_| layer["ks"][key]["a"] == 1)?;
            let keys = keys.iter().map(|key| {
                let handles = key.get("o").map(|out| [one(&out["y"][0]), one(&key["i"]["y"][0])]);
                (one(&key["t"]) / rate, one(&key["s"][axis]) / per, handles)
            });
            let keys: Vec<_> = keys.collect();
            let idle = if how == "wide" || how == "high" { 1.0 } else { 0.0 };
            keys.iter().any(|key| key.1 != idle).then(|| Moving { how: how.to_owned(), keys })
        };
        let all = [
            moved("p", 0, "x", 1.0),
            moved("p", 1, "y", 1.0),
            moved("r", 0, "turn", 1.0),
            moved("s", 0, "wide", 100.0),
            moved("s", 1, "high", 100.0),
        ];
        all.into_iter().flatten().collect::<Vec<_>>()
    });
    let shapes = |layer: &Value| layer["shapes"].as_array().unwrap().last().unwrap()["it"][0].clone();
    Picture {
        moves: moves.collect(),
        from: [0.0; 2],
        radius: 0.5 * one(&shapes(balls.last().unwrap())["s"]["k"][0]),
        ground: one(&shapes(ground)["ks"]["k"]["v"][0][1]),
    }
}

/// A flight of a random motion: how long, which way in x and y, how high, how far from a parabola,
/// and whether it ends at a wall.
type Leap = (f64, f64, f64, f64, f64, bool);

/// Flights over a level floor, some of which end at a wall across x while they are above it.
fn made(leaps: &[Leap], radius: f64) -> Motion {
    let (mut start, mut place) = (0.0, [0.0, 0.0, 0.0]);
    let mut stretches: Vec<Stretch> = Vec::new();
    let mut contact = None;
    for &(span, x, y, high, bent, wall) in leaps {
        let whole = if wall { 2.0 * span } else { span };
        // (4 high + bent (s/T)²) s (T - s)/T², and from where it was lower to there.
        let (a, b) = (4.0 * high / (whole * whole), bent * high / whole.powi(4));
        let down = -place[2] / whole;
        let coefficients =
            vec![place, [x, y, down + a * whole], [0.1 * x, bent * y, -a], [0.0, 0.0, b * whole], [0.0, 0.0, -b]];
        let piece = Piece { start, span, coefficients, spin: Vec::new() };
        let leaves = piece.slope(span);
        let next = piece.at(span);
        stretches.push(Stretch { contact, flight: true, pieces: vec![piece] });
        contact = Some(match wall {
            true => Contact { normal: [-x.signum(), 0.0, 0.0], speed: leaves[0].abs(), pressed: false },
            false => Contact::level(leaves[2].abs()),
        });
        (start, place) = (start + span, [next[0], next[1], if wall { next[2] } else { 0.0 }]);
    }
    let rest = Piece { start, span: 0.1, coefficients: vec![place], spin: Vec::new() };
    stretches.push(Stretch { contact, flight: true, pieces: vec![rest] });
    let ball = Track { name: "ball".into(), radius, stretches };
    Motion::new("leaps", vec![ball], vec![vec![[-1.0, 0.0], [1.0, 0.0]]]).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(64)))]

    #[test]
    fn what_a_reader_measures_is_at_most_what_is_said(
        leaps in prop::collection::vec((0.08..0.7_f64, -3.0..3.0_f64, prop_oneof![Just(0.0), -3.0..3.0_f64], 0.05..1.0_f64, -1.0..3.0_f64, any::<bool>()), 1..5),
        radius in 0.02..0.3_f64, rate in prop::sample::select(vec!["12", "24", "29.97", "60"]),
        squash in prop_oneof![Just(0.0), 0.0..0.6_f64], stretch in prop_oneof![Just(0.0), 0.0..0.5_f64], hold in 1..4_u32,
        tolerance in prop::sample::select(vec![1e-2, 1e-3, 1e-4]), apexes in any::<bool>(),
    ) {
        let frames = Frames::new(rate.parse().unwrap());
        let hold = f64::from(hold) * frames.step();
        let (mut motion, shaped) = (made(&leaps, radius), squash > 0.0 || stretch > 0.0);
        if squash > 0.0 {
            motion = motion.held(hold).unwrap();
        }
        let shape = Shape { squash, stretch, hold };
        let (track, size) = (&motion.tracks[0], 12.0);
        for format in [Format::Glb, Format::Svg, Format::Lottie] {
            let file = Export { shape, tolerance, apexes, ..Export::new(&motion, frames) }.file(format).unwrap();
            let shown = file.shown.unwrap_or_default();
            let [both, picture] = match format {
                Format::Glb => [Some(channels(&file.bytes)), None],
                _ => [None, None],
            };
            let _: Option<Vec<Vec<glb::Channel>>> = picture;
            let picture = match format {
                Format::Svg => Some(svg(&file)),
                Format::Lottie => Some(lottie(&file)),
                _ => None,
            };
            let animations = both.as_ref().map_or(1, Vec::len);
            for animation in 0..animations {
                for k in 0..LOOKS {
                    let t = motion.end() * (f64::from(k) + 0.5) / f64::from(LOOKS);
                    let (volume, low) = match (&both, &picture) {
                        (Some(both), _) => seen(&both[animation], radius, t),
                        (_, Some(picture)) => (1.0, radius * picture.low(t)),
                        _ => unreachable!(),
                    };
                    let (there, slack) = (track.at(t)[2], READER * size);
                    let moved = if shaped { shown.moved } else { 0.0 };
                    prop_assert!((low - there).abs() <= file.miss.height + moved + slack, "{format:?} {animation}: {low} at {t}, not {there}: {:?}", file.miss);
                    prop_assert!((volume - 1.0).abs() <= shown.volume + READER, "{format:?}: volume {volume} at {t} of {shown:?}");
                    let level = track.stretch(t).contact.is_none_or(|contact| contact.normal[2] == 1.0);
                    if track.stretch(t).flight || level {
                        let sunk = there - low;
                        prop_assert!(sunk <= file.miss.height + shown.sunk + slack, "{format:?} {animation}: {sunk} below {there} at {t}: {:?} {shown:?}", file.miss);
                    }
                }
            }
        }
    }
}
