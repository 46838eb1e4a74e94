//! One page that plays the motion: no network, no second file, nothing to install.

use std::fmt::Write;

use serde_json::{Value, json};

use super::flat::{Moves, channels, cubics};
use super::svg::escaped;
use super::view::View;
use super::{Ball, Export, ExportError};
use crate::curve::Between;

/// The page around the picture: `@TITLE@`, `@PICTURE@` and `@DATA@` are put in. Scripts and styles
/// stand in it, and the page may load nothing.
const PAGE: &str = include_str!("player.html");

pub(super) fn page(export: &Export<'_>, balls: &[Ball<'_>]) -> Result<String, ExportError> {
    let view = View::of(export.motion);
    let mut body = String::new();
    for line in &export.motion.ground {
        let points: Vec<String> = line.iter().map(|&[x, up]| format!("{},{}", view.x(x), view.y(up))).collect();
        let _ = writeln!(body, "<polyline class=\"ground\" points=\"{}\"/>", points.join(" "));
    }
    let mut data = Vec::new();
    for (n, ball) in balls.iter().enumerate() {
        // The page has as many inks, light and dark, as there are colours.
        let ink = match n % super::COLOURS.len() {
            0 => "var(--ball)".to_owned(),
            n => format!("var(--ball{})", n + 1),
        };
        if ball.path.between == Between::Cubic {
            let way = cubics(&ball.path, |[x, _, up]| format!("{} {}", view.x(x), view.y(up + ball.track.radius)));
            let _ = writeln!(body, "<path class=\"path\" d=\"{way}\"/>");
        }
        let channels = channels(ball, &view);
        let r = view.radius(ball.track.radius);
        // Each number moves a group of its own, from the outermost inwards, as the script finds
        // them.
        let _ = write!(
            body,
            "{}<circle class=\"ball\" r=\"{r}\" style=\"fill:{ink}\" data-radius=\"{}\"/>",
            "<g class=\"moves\">".repeat(channels.len()),
            ball.track.radius * view.scale
        );
        if ball.dress.as_ref().is_some_and(|dress| !dress.spin.is_empty()) {
            let _ = write!(body, "<path class=\"mark\" stroke-width=\"{}\" d=\"M0 0V{}\"/>", 0.3 * r, -0.8 * r);
        }
        let _ = writeln!(body, "{}", "</g>".repeat(channels.len()));
        let moving = channels.iter().map(|channel| {
            let how = match channel.moves {
                Moves::X => "translateX",
                Moves::Y => "translateY",
                Moves::Turn => "rotate",
                Moves::ScaleX => "scaleX",
                Moves::ScaleY => "scaleY",
            };
            let eases = channel.eases.iter().map(|ease| {
                let [a, b] = ease.handles.unwrap_or([-1.0, -1.0]);
                let held = ease.handles.is_none();
                json!([ease.t[0], ease.t[1], ease.value[0], ease.value[1], a, b, held])
            });
            json!({ "how": how, "eases": eases.collect::<Vec<Value>>() })
        });
        let keys: Vec<f64> = ball.path.keys.iter().map(|key| key.t).collect();
        let contacts = ball.track.stretches.iter().filter_map(|stretch| {
            let contact = stretch.contact?;
            Some(json!([stretch.start(), contact.speed]))
        });
        data.push(json!({
            "name": ball.track.name, "ink": ink, "moves": moving.collect::<Vec<Value>>(), "keys": keys,
            "contacts": contacts.collect::<Vec<Value>>(),
        }));
    }
    let (per, seconds) = export.frames.rate.fraction();
    let data = json!({
        "end": export.motion.end(), "fps": f64::from(per) / f64::from(seconds), "first": export.frames.first,
        "loops": export.motion.loops, "balls": data,
    });
    let View { width, height, .. } = view;
    let picture =
        format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-labelledby=\"title\">\n{body}</svg>");
    // Within a script element nothing may look like its end.
    let data = serde_json::to_string(&data)?.replace('<', "\\u003c");
    let title = escaped(&export.motion.title);
    // Piece by piece, so that no text of the scene can be taken for a mark.
    let mut page = String::new();
    for (n, part) in PAGE.split("@TITLE@").enumerate() {
        page.push_str(if n > 0 { &title } else { "" });
        let (before, after) = part.split_once("@PICTURE@").unwrap_or((part, ""));
        page.push_str(before);
        if part.len() > before.len() {
            let (between, rest) = after.split_once("@DATA@").unwrap_or((after, ""));
            page.extend([picture.as_str(), between, data.as_str(), rest]);
        }
    }
    Ok(page)
}
