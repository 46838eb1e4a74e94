//! Lottie: x on a layer without a shape, heights on the ball that follows it, so that each has
//! eases of its own; squash and spin likewise.

use serde_json::{Value, json};

use super::flat::{Moves, channels};
use super::view::View;
use super::{Ball, Export, ExportError, colour};
use crate::ease::Ease;

pub(super) fn json(export: &Export<'_>, balls: &[Ball<'_>]) -> Result<String, ExportError> {
    let view = View::of(export.motion);
    let [first, last] = export.range();
    let end = last + 1;
    let still = |value: Value| json!({ "a": 0, "k": value });
    let layer = |kind: u32, name: &str, index: usize| {
        json!({
            "ty": kind, "nm": name, "ind": index, "ip": first, "op": end, "st": 0, "sr": 1, "bm": 0, "ddd": 0,
            "ks": { "o": still(json!(100)), "r": still(json!(0)), "a": still(json!([0, 0, 0])), "s": still(json!([100, 100, 100])), "p": still(json!([0, 0, 0])) },
        })
    };
    let paint = |colour: [f64; 3]| still(json!([colour[0], colour[1], colour[2], 1]));
    let at_origin = json!({
        "ty": "tr", "p": still(json!([0, 0])), "a": still(json!([0, 0])), "s": still(json!([100, 100])), "r": still(json!(0)), "o": still(json!(100)),
    });
    let mut layers = Vec::new();
    for (number, ball) in balls.iter().enumerate() {
        let channels = channels(ball, &view);
        let from = layers.len() + 1;
        let turns = ball.dress.as_ref().is_some_and(|dress| !dress.spin.is_empty());
        for (n, channel) in channels.iter().enumerate() {
            let innermost = n + 1 == channels.len();
            let (kind, name) = if innermost {
                (4, ball.track.name.clone())
            } else {
                (3, format!("{} {}", ball.track.name, channel.name))
            };
            let mut moved = layer(kind, &name, from + n);
            if n > 0 {
                moved["parent"] = json!(from + n - 1);
            }
            let (key, at): (&str, fn(f64) -> Value) = match channel.moves {
                Moves::X => ("p", |x| json!([x, 0.0, 0.0])),
                Moves::Y => ("p", |y| json!([0.0, y, 0.0])),
                Moves::Turn => ("r", |angle| json!([angle])),
                Moves::ScaleX => ("s", |s| json!([100.0 * s, 100.0, 100.0])),
                Moves::ScaleY => ("s", |s| json!([100.0, 100.0 * s, 100.0])),
            };
            moved["ks"][key] = moving(export, &channel.eases, at);
            if innermost {
                let r = ball.track.radius * view.scale;
                // A ball that would be no more than a dot is drawn larger about its centre; its
                // disc keeps its own size.
                let mut larger = at_origin.clone();
                let part = 100.0 * view.radius(ball.track.radius) / r;
                larger["s"] = still(json!([part, part]));
                let mut parts = vec![
                    json!({ "ty": "el", "p": still(json!([0, 0])), "s": still(json!([2.0 * r, 2.0 * r])) }),
                    json!({ "ty": "fl", "c": paint(colour(number)), "o": still(json!(100)), "r": 1 }),
                    larger.clone(),
                ];
                let mut shapes = vec![json!({ "ty": "gr", "nm": "ball", "it": parts })];
                if turns {
                    // A mark, which shows the turning.
                    let line = json!({ "c": false, "v": [[0.0, 0.0], [0.0, -0.8 * r]], "i": [[0, 0], [0, 0]], "o": [[0, 0], [0, 0]] });
                    parts = vec![
                        json!({ "ty": "sh", "ks": still(line) }),
                        json!({ "ty": "st", "c": paint([0.95, 0.8, 0.6]), "o": still(json!(100)), "w": still(json!(0.3 * r)), "lc": 2, "lj": 2 }),
                        larger,
                    ];
                    shapes.insert(0, json!({ "ty": "gr", "nm": "mark", "it": parts }));
                }
                moved["shapes"] = json!(shapes);
            }
            layers.push(moved);
        }
    }
    let mut ground = layer(4, "ground", layers.len() + 1);
    let lines = export.motion.ground.iter().map(|line| {
        let points: Vec<[f64; 2]> = line.iter().map(|&[x, up]| [view.x(x), view.y(up)]).collect();
        let flat = vec![[0.0, 0.0]; points.len()];
        json!({ "ty": "gr", "nm": "line", "it": [
            { "ty": "sh", "ks": still(json!({ "c": false, "v": points, "i": flat, "o": flat })) },
            { "ty": "st", "c": paint([0.5, 0.5, 0.5]), "o": still(json!(100)), "w": still(json!(2)), "lc": 1, "lj": 1 },
            at_origin,
        ] })
    });
    ground["shapes"] = lines.collect();
    layers.push(ground);
    let document = json!({
        "v": "5.7.0", "nm": export.motion.title, "fr": export.frames.rate.per_second(), "ip": first, "op": end,
        "w": whole(view.width), "h": whole(view.height), "ddd": 0, "assets": [], "layers": layers,
    });
    Ok(written(&document) + "\n")
}

/// A side of the picture, which has whole units: rlottie takes no others.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // above zero, and some thousands at most
const fn whole(side: f64) -> u32 {
    side as u32
}

/// JSON in which the type of an object stands before what it is of: rlottie reads a shape as it
/// comes, and passes over one whose type it does not know yet.
fn written(value: &Value) -> String {
    let list = |parts: Vec<String>, [open, close]: [char; 2]| format!("{open}{}{close}", parts.join(","));
    match value {
        Value::Array(items) => list(items.iter().map(written).collect(), ['[', ']']),
        Value::Object(fields) => {
            let pair = |(key, value): (&String, &Value)| format!("{}:{}", Value::from(key.as_str()), written(value));
            let (first, rest): (Vec<_>, Vec<_>) = fields.iter().partition(|(key, _)| *key == "ty");
            list(first.into_iter().chain(rest).map(pair).collect(), ['{', '}'])
        }
        other => other.to_string(),
    }
}

/// A key for each ease, x of its handles the time and y the progress.
fn moving(export: &Export<'_>, eases: &[Ease], at: impl Fn(f64) -> Value) -> Value {
    let mut keys: Vec<Value> = Vec::new();
    for ease in eases {
        let mut key = json!({ "t": export.frames.number(ease.t[0]), "s": at(ease.value[0]) });
        match ease.handles {
            Some([a, b]) => {
                key["o"] = json!({ "x": [1.0 / 3.0], "y": [a] });
                key["i"] = json!({ "x": [2.0 / 3.0], "y": [b] });
            }
            None => key["h"] = json!(1),
        }
        keys.push(key);
    }
    if let Some(last) = eases.last() {
        keys.push(json!({ "t": export.frames.number(last.t[1]), "s": at(last.value[1]) }));
    }
    json!({ "a": 1, "k": keys })
}
