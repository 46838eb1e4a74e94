//! Lottie: x on a layer without a shape, heights on the ball that follows it, so that each has eases of its own.

use serde_json::{Value, json};

use super::view::View;
use super::{Export, ExportError};
use crate::curve::Curve;
use crate::ease::eases;

pub(super) fn json(export: &Export<'_>, curves: &[Curve]) -> Result<String, ExportError> {
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
    for (n, (track, curve)) in export.motion.tracks.iter().zip(curves).enumerate() {
        let (carrier, ball) = (2 * n + 1, 2 * n + 2);
        let mut moved = layer(4, &track.name, ball);
        moved["parent"] = json!(carrier);
        moved["ks"]["p"] = positions(export, curve, 2, |up| json!([0.0, view.y(up + track.radius), 0.0]));
        let size = 2.0 * track.radius * view.scale;
        moved["shapes"] = json!([{ "ty": "gr", "nm": "ball", "it": [
            { "ty": "el", "p": still(json!([0, 0])), "s": still(json!([size, size])) },
            { "ty": "fl", "c": paint([0.85, 0.33, 0.1]), "o": still(json!(100)), "r": 1 },
            at_origin,
        ] }]);
        let mut carrying = layer(3, &format!("{} x", track.name), carrier);
        carrying["ks"]["p"] = positions(export, curve, 0, |x| json!([view.x(x), 0.0, 0.0]));
        layers.extend([carrying, moved]);
    }
    let mut ground = layer(4, "ground", 2 * curves.len() + 1);
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
        "w": view.width, "h": view.height, "ddd": 0, "assets": [], "layers": layers,
    });
    Ok(serde_json::to_string(&document)? + "\n")
}

/// One axis as a position: a key for each ease, x of its handles the time and y the progress.
fn positions(export: &Export<'_>, curve: &Curve, axis: usize, at: impl Fn(f64) -> Value) -> Value {
    let eases = eases(curve, axis);
    let mut keys: Vec<Value> = Vec::new();
    for ease in &eases {
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
