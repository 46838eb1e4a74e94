//! Keys and frames as CSV and JSON.

use std::fmt::Write;

use serde_json::{Value, json};

use super::{Ball, Export, ExportError};
use crate::curve::{APART, Between, Key};
use crate::dress::Dress;
use crate::turn::{STRAIGHT, Turn, axis, product, turned};

/// The number of the JSON contract.
const SCHEMA: u32 = 1;

/// A name as a cell: in quotes where it has to be, and behind an apostrophe where a spreadsheet
/// would take it for a formula.
pub(super) fn quoted(name: &str) -> String {
    let name = if name.starts_with(['=', '+', '-', '@', '\t', '\r']) { format!("'{name}") } else { name.to_owned() };
    if name.contains([',', '"', '\n', '\r']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name }
}

/// One row for each key. Where the form or the orientation has keys between those of the path, the
/// path has rows there too; it is the same path.
pub(super) fn csv(export: &Export<'_>, balls: &[Ball<'_>]) -> String {
    let u = export.space.unit.symbol();
    let mut csv = format!(
        "ball,frame,time_s,x_{u},y_{u},height_{u},in_x_{u}_per_s,in_y_{u}_per_s,in_up_{u}_per_s,out_x_{u}_per_s,out_y_{u}_per_s,out_up_{u}_per_s,contact",
    );
    let shaped = balls.iter().any(|ball| ball.dress.as_ref().is_some_and(Dress::shaped));
    let turns = balls.iter().any(|ball| ball.dress.as_ref().is_some_and(|dress| !dress.spin.is_empty()));
    if shaped {
        let _ = write!(csv, ",centre_x_{u},centre_y_{u},centre_up_{u},along,across,axis_x,axis_y,axis_up");
    }
    if turns {
        csv.push_str(",turn_x,turn_y,turn_up,turn_w");
    }
    csv.push('\n');
    for Ball { track, path, dress, .. } in balls {
        let name = quoted(&track.name);
        let mut times: Vec<f64> = path.keys.iter().map(|key| key.t).collect();
        if let Some(dress) = dress.as_ref().filter(|_| path.between == Between::Cubic) {
            times.extend(dress.offset.keys.iter().map(|key| key.t));
            times.extend(dress.aim.iter().chain(&dress.spin).map(|turn| turn.t));
            times.sort_by(f64::total_cmp);
            // What is one key to programs is one row, at the time of the path's own key.
            let own = |t: f64| path.keys.iter().any(|key| key.t == t);
            times.dedup_by(|later, earlier| {
                let two = own(*later) && own(*earlier) && *later > *earlier;
                let one = *later - *earlier < APART * export.frames.rate.frame() && !two;
                if one && own(*later) {
                    *earlier = *later;
                }
                one
            });
        }
        for t in times {
            let Key { place, enter, leave, contact, .. } = path.key(t);
            let _ = write!(csv, "{name},{},{t}", export.frames.number(t));
            for number in place.iter().chain(&enter).chain(&leave) {
                let _ = write!(csv, ",{}", number + 0.0);
            }
            let _ = write!(csv, ",{}", u8::from(contact));
            let mut more: Vec<f64> = Vec::new();
            let aim = dress.as_ref().map_or(STRAIGHT, |dress| turned(&dress.aim, t));
            if shaped {
                let still = ([0.0, 0.0, track.radius], [1.0; 3]);
                let (offset, [across, _, along]) =
                    dress.as_ref().map_or(still, |dress| (dress.offset.at(t), dress.scale.at(t)));
                more.extend((0..3).map(|k| place[k] + offset[k]));
                more.extend([along, across]);
                more.extend(axis(aim));
            }
            if turns {
                let spin = dress.as_ref().map_or(STRAIGHT, |dress| turned(&dress.spin, t));
                more.extend(product(aim, spin));
            }
            for number in more {
                let _ = write!(csv, ",{}", number + 0.0);
            }
            csv.push('\n');
        }
    }
    csv
}

/// Keys with velocities on both sides, and a place for every frame.
pub(super) fn json(export: &Export<'_>, balls: &[Ball<'_>]) -> Result<String, ExportError> {
    let frames = export.frames;
    let balls = balls.iter().map(|Ball { track, path, dress, .. }| {
        let key = |key: &Key| {
            json!({
                "frame": frames.number(key.t), "t": key.t, "place": key.place,
                "enter": key.enter, "leave": key.leave, "contact": key.contact,
            })
        };
        let samples = track.samples(frames, false);
        let sample = |key: &Key| json!([frames.number(key.t), key.place[0], key.place[1], key.place[2]]);
        let mut ball = json!({
            "name": track.name, "radius": track.radius,
            "between": match path.between {
                Between::Cubic => "cubic",
                Between::Line => "line",
                Between::Hold => "hold",
            },
            "keys": path.keys.iter().map(key).collect::<Vec<_>>(),
            "frames": samples.keys.iter().map(sample).collect::<Vec<_>>(),
        });
        if let Some(dress) = dress {
            let turn = |turn: &Turn| json!({ "frame": frames.number(turn.t), "t": turn.t, "quaternion": turn.quaternion, "angle": turn.angle });
            if dress.shaped() {
                let form = |(offset, scale): (&Key, &Key)| {
                    json!({
                        "frame": frames.number(offset.t), "t": offset.t,
                        "offset": offset.place, "offset_enter": offset.enter, "offset_leave": offset.leave,
                        "scale": scale.place, "scale_enter": scale.enter, "scale_leave": scale.leave,
                    })
                };
                ball["form"] = dress.offset.keys.iter().zip(&dress.scale.keys).map(form).collect();
                ball["aim"] = dress.aim.iter().map(turn).collect();
            }
            if !dress.spin.is_empty() {
                ball["spin"] = dress.spin.iter().map(turn).collect();
            }
        }
        ball
    });
    let (per, seconds) = frames.rate.fraction();
    let document = json!({
        "schema": SCHEMA, "title": export.motion.title, "fps": [per, seconds], "first_frame": frames.first,
        "on_twos": frames.on_twos, "loops": export.motion.loops, "ground": export.motion.ground, "balls": balls.collect::<Vec<Value>>(),
    });
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}
