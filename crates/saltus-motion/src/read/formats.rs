//! Heights over time out of each format, as it has them.

use serde_json::Value;

use super::{Ball, ReadError, Reading};
use crate::space::Unit;

/// The course of a value after a key.
#[derive(Clone, Copy)]
enum After {
    Line,
    Hold,
    /// A cubic: the slope on leaving, and on entering the next key.
    Cubic(f64, f64),
    /// An ease by a Bézier curve from (0, 0) to (1, 1): its two handles.
    Ease([f64; 4]),
}

struct Key {
    t: f64,
    value: f64,
    after: After,
}

/// The value at a time, by keys that rise in time.
fn curve(keys: Vec<Key>) -> Result<Ball, ReadError> {
    let Some(last) = keys.last() else { return Err(ReadError::new("a ball has no keys")) };
    let end = last.t;
    let height = move |t: f64| {
        let next = keys.partition_point(|key| key.t <= t);
        match (next.checked_sub(1).and_then(|n| keys.get(n)), keys.get(next)) {
            (Some(a), Some(b)) => between(a, b, t),
            (Some(only), None) | (None, Some(only)) => only.value,
            (None, None) => f64::NAN,
        }
    };
    Ok(Ball { height: Box::new(height), radii: None, end })
}

fn between(a: &Key, b: &Key, t: f64) -> f64 {
    let (h, d) = (b.t - a.t, b.value - a.value);
    let u = (t - a.t) / h;
    match a.after {
        After::Hold => a.value,
        After::Line => a.value + d * u,
        After::Cubic(v, w) => {
            let (m, n) = (h * v, h * w);
            a.value + u * (m + u * (3.0 * d - 2.0 * m - n + u * (m + n - 2.0 * d)))
        }
        After::Ease([x1, y1, x2, y2]) => {
            let bezier = |a: f64, b: f64, s: f64| s * (3.0 * (1.0 - s) * (a * (1.0 - s) + b * s) + s * s);
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if bezier(x1, x2, middle) < u { low = middle } else { high = middle }
            }
            a.value + d * bezier(y1, y2, low)
        }
    }
}

/// The error of a file that lacks something.
fn lacks(what: &str) -> ReadError {
    ReadError::new(format!("there is no {what}"))
}

/// A binary glTF: its document, and the bytes behind it.
fn chunks(bytes: &[u8]) -> Option<(Value, &[u8])> {
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    let length = word(12)?;
    let document = serde_json::from_slice(bytes.get(20..20 + length)?).ok()?;
    let from = 20 + length;
    let binary = word(from).and_then(|length| bytes.get(from + 8..from + 8 + length)).unwrap_or_default();
    (bytes.starts_with(b"glTF\x02\0\0\0") && bytes.get(16..20)? == b"JSON").then_some((document, binary))
}

/// The floats of an accessor, `width` to a row.
fn floats(document: &Value, binary: &[u8], accessor: &Value, width: usize) -> Option<Vec<Vec<f64>>> {
    let at = |value: &Value| value.as_u64().and_then(|n| usize::try_from(n).ok());
    let accessor = &document["accessors"][at(accessor)?];
    let view = &document["bufferViews"][at(&accessor["bufferView"])?];
    let start = at(&view["byteOffset"]).unwrap_or(0) + at(&accessor["byteOffset"]).unwrap_or(0);
    let stride = at(&view["byteStride"]).unwrap_or(4 * width);
    let float = accessor["componentType"] == 5126;
    let row = |n: usize| -> Option<Vec<f64>> {
        let cell = |k: usize| {
            let from = start + n * stride + 4 * k;
            Some(f64::from(f32::from_le_bytes(binary.get(from..from + 4)?.try_into().ok()?)))
        };
        (0..width).map(cell).collect()
    };
    let count = at(&accessor["count"]).filter(|count| float && *count <= binary.len() / 4)?;
    (0..count).map(row).collect()
}

/// Balls are the root nodes that move; y is up.
pub(super) fn glb(bytes: &[u8]) -> Result<Vec<Reading>, ReadError> {
    let (document, binary) = chunks(bytes).ok_or_else(|| ReadError::new("it is no binary glTF 2.0"))?;
    let roots = &document["scenes"][0]["nodes"];
    let mut readings = Vec::new();
    for animation in document["animations"].as_array().into_iter().flatten() {
        let (mut balls, mut sampled) = (Vec::new(), false);
        for channel in animation["channels"].as_array().into_iter().flatten() {
            let target = &channel["target"];
            let root = roots.as_array().is_some_and(|roots| roots.contains(&target["node"]));
            if target["path"] != "translation" || !root {
                continue;
            }
            let sampler = channel["sampler"].as_u64().and_then(|n| usize::try_from(n).ok());
            let sampler = &animation["samplers"][sampler.ok_or_else(|| lacks("sampler"))?];
            let times = floats(&document, binary, &sampler["input"], 1).ok_or_else(|| lacks("time"))?;
            let rows = floats(&document, binary, &sampler["output"], 3).ok_or_else(|| lacks("place"))?;
            let kind = sampler["interpolation"].as_str().unwrap_or("LINEAR");
            sampled |= kind != "CUBICSPLINE";
            let key = |(n, t): (usize, &Vec<f64>)| {
                // Of a cubic: the slope on entering, the value, the slope on leaving.
                let up = |n: usize| rows.get(n).map_or(f64::NAN, |row| row[1]);
                let t = t[0];
                match kind {
                    "CUBICSPLINE" => Key { t, value: up(3 * n + 1), after: After::Cubic(up(3 * n + 2), up(3 * n + 3)) },
                    "STEP" => Key { t, value: up(n), after: After::Hold },
                    _ => Key { t, value: up(n), after: After::Line },
                }
            };
            balls.push(curve(times.iter().enumerate().map(key).collect())?);
        }
        readings.push(Reading { name: animation["name"].as_str().unwrap_or("animation").to_owned(), sampled, balls });
    }
    if readings.is_empty() { Err(lacks("animation")) } else { Ok(readings) }
}

/// Samples of places, or splines of heights; the unit and the axis that is up are those of the
/// stage.
pub(super) fn usda(text: &str) -> Result<Vec<Reading>, ReadError> {
    let number =
        |name: &str| -> Option<f64> { after(text, &format!("{name} = "))?.lines().next()?.trim().parse().ok() };
    let fps = number("timeCodesPerSecond").ok_or_else(|| lacks("timeCodesPerSecond"))?;
    let first = number("startTimeCode").ok_or_else(|| lacks("startTimeCode"))?;
    let metres = number("metersPerUnit").ok_or_else(|| lacks("metersPerUnit"))?;
    let axis = after(text, "upAxis = \"").and_then(|rest| rest.chars().next()).ok_or_else(|| lacks("upAxis"))?;
    let place_of = if axis == 'Z' { 2 } else { 1 };
    let (mut balls, mut sampled) = (Vec::new(), false);
    for part in text.split("def Xform \"Ball").skip(1) {
        let seconds = |frame: &str| frame.trim().parse::<f64>().ok().map(|frame| (frame - first) / fps);
        // The path comes before what it carries.
        let path = part.split("def ").next().unwrap_or_default();
        let samples = after(path, "xformOp:translate.timeSamples = {").and_then(|rest| rest.split('}').next());
        let spline =
            after(path, &format!("xformOp:translate{axis}.spline = {{")).and_then(|rest| rest.split('}').next());
        let keys: Option<Vec<Key>> = match (samples, spline) {
            (Some(samples), _) => {
                sampled = true;
                let key = |line: &str| {
                    let (frame, place) = line.split_once(": (")?;
                    let value: f64 = place.trim_end_matches("),").split(',').nth(place_of)?.trim().parse().ok()?;
                    Some(Key { t: seconds(frame)?, value: metres * value, after: After::Line })
                };
                samples.lines().filter(|line| !line.trim().is_empty()).map(key).collect()
            }
            (None, Some(spline)) => {
                let lines: Vec<&str> = spline.lines().filter(|line| line.contains(": ")).collect();
                sampled |= lines.iter().any(|line| line.contains("post held"));
                let slope = |line: &str, side: &str| -> Option<f64> {
                    after(line, side)?.split(')').next()?.split(',').nth(1)?.trim().parse().ok()
                };
                let key = |(n, line): (usize, &&str)| {
                    let (frame, rest) = line.trim().split_once(": ")?;
                    let value: f64 = rest.trim_end_matches(',').split(';').next()?.trim().parse().ok()?;
                    let next = lines.get(n + 1).and_then(|next| slope(next, "pre ("));
                    let after = match (slope(line, "post curve ("), next) {
                        (Some(leave), Some(enter)) => After::Cubic(metres * leave * fps, metres * enter * fps),
                        _ if rest.contains("post linear") => After::Line,
                        _ => After::Hold,
                    };
                    Some(Key { t: seconds(frame)?, value: metres * value, after })
                };
                lines.iter().enumerate().map(key).collect()
            }
            (None, None) => None,
        };
        balls.push(curve(keys.ok_or_else(|| lacks("place of a ball"))?)?);
    }
    Ok(vec![Reading { name: "USD".to_owned(), sampled, balls }])
}

/// The text behind a start.
fn after<'a>(text: &'a str, start: &str) -> Option<&'a str> {
    text.split_once(start).map(|(_, rest)| rest)
}

/// Rules that move a group up and down; the ball's size is the scale.
pub(super) fn svg(text: &str) -> Result<Vec<Reading>, ReadError> {
    let document = roxmltree::Document::parse(text).map_err(ReadError::new)?;
    let style: String = document.descendants().filter(|n| n.has_tag_name("style")).filter_map(|n| n.text()).collect();
    let duration = after(&style, "animation-duration:").and_then(|rest| rest.split('s').next()?.parse::<f64>().ok());
    let duration = duration.ok_or_else(|| ReadError::new("it does not move"))?;
    let (mut balls, mut sampled) = (Vec::new(), false);
    for circle in document.descendants().filter(|node| node.attribute("class") == Some("ball")) {
        let radius: f64 =
            circle.attribute("data-radius").and_then(|r| r.parse().ok()).ok_or_else(|| lacks("radius"))?;
        let rules = after(&style, &format!("b{}y{{", balls.len())).and_then(|rest| rest.split("}\n}").next());
        let rules = rules.ok_or_else(|| lacks("rule for a ball's height"))?;
        let key = |line: &str| {
            let value: f64 = after(line, "translateY(")?.split("px").next()?.parse().ok()?;
            let handles = after(line, "cubic-bezier(").and_then(|rest| {
                let numbers: Option<Vec<f64>> = rest.split(')').next()?.split(',').map(|n| n.parse().ok()).collect();
                numbers?.try_into().ok()
            });
            let t = duration * line.split('%').next()?.parse::<f64>().ok()? / 100.0;
            Some(Key { t, value: -value, after: handles.map_or(After::Hold, After::Ease) })
        };
        let keys: Option<Vec<Key>> = rules.trim().lines().map(key).collect();
        let keys = keys.ok_or_else(|| lacks("number where one should be"))?;
        sampled |= keys.iter().rev().skip(1).all(|key| matches!(key.after, After::Hold));
        balls.push(Ball { radii: Some(1.0 / radius), ..curve(keys)? });
    }
    Ok(vec![Reading { name: "SVG".to_owned(), sampled, balls }])
}

/// Keys with velocities on both sides, in the unit that the names of columns have; from frame to
/// frame they are the slopes of the motion, not of lines.
pub(super) fn csv(text: &str) -> Result<Vec<Reading>, ReadError> {
    let mut table = ::csv::Reader::from_reader(text.as_bytes());
    let header = table.headers().map_err(ReadError::new)?.clone();
    let column =
        |name: &str| header.iter().position(|cell| cell == name).ok_or_else(|| lacks(&format!("column '{name}'")));
    let unit = Unit::ALL.into_iter().find(|unit| column(&format!("height_{}", unit.symbol())).is_ok());
    let (unit, metres) = unit.map_or(("m", 1.0), |unit| (unit.symbol(), unit.metres()));
    let columns = [
        column("time_s")?,
        column(&format!("height_{unit}"))?,
        column(&format!("in_up_{unit}_per_s"))?,
        column(&format!("out_up_{unit}_per_s"))?,
    ];
    let ball = column("ball")?;
    let mut rows: Vec<(String, Vec<[f64; 4]>)> = Vec::new();
    for record in table.records() {
        let record = record.map_err(ReadError::new)?;
        let cell = |n: usize| record.get(n).and_then(|cell| cell.parse::<f64>().ok()).ok_or_else(|| lacks("number"));
        let row =
            [cell(columns[0])?, metres * cell(columns[1])?, metres * cell(columns[2])?, metres * cell(columns[3])?];
        let name = record.get(ball).unwrap_or_default();
        match rows.last_mut().filter(|(last, keys)| last == name && keys.last().is_some_and(|key| key[0] < row[0])) {
            Some((_, keys)) => keys.push(row),
            None => rows.push((name.to_owned(), vec![row])),
        }
    }
    let balls = rows.iter().map(|(_, rows)| {
        let key = |(n, row): (usize, &[f64; 4])| {
            let enter = rows.get(n + 1).map_or(0.0, |next| next[2]);
            Key { t: row[0], value: row[1], after: After::Cubic(row[3], enter) }
        };
        curve(rows.iter().enumerate().map(key).collect())
    });
    Ok(vec![Reading { name: "CSV".to_owned(), sampled: false, balls: balls.collect::<Result<_, _>>()? }])
}

/// Our own JSON, or Lottie's.
pub(super) fn json(text: &str) -> Result<Vec<Reading>, ReadError> {
    let document: Value = serde_json::from_str(text).map_err(ReadError::new)?;
    if document["layers"].is_array() {
        return lottie(&document);
    }
    let balls = document["balls"].as_array().ok_or_else(|| lacks("`balls`, nor `layers`"))?;
    let mut sampled = false;
    let balls = balls.iter().map(|ball| {
        let keys = ball["keys"].as_array().ok_or_else(|| lacks("`keys`"))?;
        let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
        sampled |= ball["between"] != "cubic";
        let key = |(n, key): (usize, &Value)| {
            let after = match (ball["between"].as_str(), keys.get(n + 1)) {
                (Some("cubic"), Some(next)) => After::Cubic(number(&key["leave"][2]), number(&next["enter"][2])),
                (Some("line"), _) => After::Line,
                _ => After::Hold,
            };
            Key { t: number(&key["t"]), value: number(&key["place"][2]), after }
        };
        curve(keys.iter().enumerate().map(key).collect())
    });
    let balls = balls.collect::<Result<_, ReadError>>()?;
    Ok(vec![Reading { name: "JSON".to_owned(), sampled, balls }])
}

/// The first layer that moves up and down below one that moves sideways; the ball's size is the
/// scale.
fn lottie(document: &Value) -> Result<Vec<Reading>, ReadError> {
    let layers = document["layers"].as_array().ok_or_else(|| lacks("`layers`"))?;
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let (fps, first) = (number(&document["fr"]), number(&document["ip"]));
    let (mut balls, mut sampled) = (Vec::new(), false);
    // A chain of layers begins with one without a parent, which moves sideways; the next moves up
    // and down; the last has the shape.
    let chains = layers.iter().filter(|layer| layer["parent"].is_null() && layer["ty"] == 3);
    for start in chains {
        let child = |of: &Value| layers.iter().find(|layer| layer["parent"] == of["ind"]);
        let up = child(start).ok_or_else(|| lacks("layer that moves up and down"))?;
        let mut shape = up;
        while let Some(next) = child(shape) {
            shape = next;
        }
        let ellipse = shape["shapes"]
            .as_array()
            .into_iter()
            .flatten()
            .flat_map(|group| group["it"].as_array().into_iter().flatten());
        let size = ellipse.filter(|item| item["ty"] == "el").map(|item| number(&item["s"]["k"][0])).next();
        let size = size.ok_or_else(|| lacks("disc"))?;
        let keys = up["ks"]["p"]["k"].as_array().ok_or_else(|| lacks("key of a height"))?;
        let origin = number(&keys[0]["s"][1]);
        let key = |key: &Value| {
            let handle = |side: &str, axis: &str| number(&key[side][axis][0]);
            let eased = !key["o"].is_null();
            let handles = [handle("o", "x"), handle("o", "y"), handle("i", "x"), handle("i", "y")];
            Key {
                t: (number(&key["t"]) - first) / fps,
                value: origin - number(&key["s"][1]),
                after: if eased { After::Ease(handles) } else { After::Hold },
            }
        };
        let keys: Vec<Key> = keys.iter().map(key).collect();
        sampled |= keys.iter().rev().skip(1).all(|key| matches!(key.after, After::Hold));
        balls.push(Ball { radii: Some(2.0 / size), ..curve(keys)? });
    }
    Ok(vec![Reading { name: "Lottie".to_owned(), sampled, balls }])
}
