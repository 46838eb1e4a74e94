//! Keys and frames as CSV and JSON.

use std::fmt::Write;

use serde_json::{Value, json};

use super::{Export, ExportError};
use crate::curve::{Between, Curve, Key};

/// The number of the JSON contract.
const SCHEMA: u32 = 1;

/// One row for each key.
pub(super) fn csv(export: &Export<'_>, curves: &[Curve]) -> String {
    let mut csv = String::from(
        "ball,frame,time_s,x_m,y_m,height_m,in_x_m_per_s,in_y_m_per_s,in_up_m_per_s,out_x_m_per_s,out_y_m_per_s,out_up_m_per_s,contact\n",
    );
    for (track, curve) in export.motion.tracks.iter().zip(curves) {
        let name = if track.name.contains([',', '"', '\n', '\r']) {
            format!("\"{}\"", track.name.replace('"', "\"\""))
        } else {
            track.name.clone()
        };
        for Key { t, place, enter, leave, contact } in &curve.keys {
            let _ = write!(csv, "{name},{},{t}", export.frames.number(*t));
            for number in place.iter().chain(enter).chain(leave) {
                let _ = write!(csv, ",{}", number + 0.0);
            }
            let _ = writeln!(csv, ",{}", u8::from(*contact));
        }
    }
    csv
}

/// Keys with velocities on both sides, and a place for every frame.
pub(super) fn json(export: &Export<'_>, curves: &[Curve]) -> Result<String, ExportError> {
    let frames = export.frames;
    let balls = export.motion.tracks.iter().zip(curves).map(|(track, curve)| {
        let key = |key: &Key| {
            json!({
                "frame": frames.number(key.t), "t": key.t, "place": key.place,
                "enter": key.enter, "leave": key.leave, "contact": key.contact,
            })
        };
        let samples = track.samples(frames, false);
        let sample = |key: &Key| json!([frames.number(key.t), key.place[0], key.place[1], key.place[2]]);
        json!({
            "name": track.name, "radius": track.radius,
            "between": match curve.between {
                Between::Cubic => "cubic",
                Between::Line => "line",
                Between::Hold => "hold",
            },
            "keys": curve.keys.iter().map(key).collect::<Vec<_>>(),
            "frames": samples.keys.iter().map(sample).collect::<Vec<_>>(),
        })
    });
    let (per, seconds) = frames.rate.fraction();
    let document = json!({
        "schema": SCHEMA, "title": export.motion.title, "fps": [per, seconds], "first_frame": frames.first,
        "on_twos": frames.on_twos, "ground": export.motion.ground, "balls": balls.collect::<Vec<Value>>(),
    });
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}
