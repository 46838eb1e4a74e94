//! SVG that moves by CSS alone, and stands still for those who ask for less motion.

use std::fmt::Write;

use super::Export;
use super::view::View;
use crate::curve::{Between, Curve};
use crate::ease::eases;

/// For how long the last picture stands before it starts again, in s.
const PAUSE: f64 = 1.0;

pub(super) fn animated(export: &Export<'_>, curves: &[Curve]) -> String {
    let view = View::of(export.motion);
    let duration = export.motion.end() + PAUSE;
    let (mut style, mut body) = (String::new(), String::new());
    for line in &export.motion.ground {
        let points: Vec<String> = line.iter().map(|&[x, up]| format!("{},{}", view.x(x), view.y(up))).collect();
        let _ = writeln!(body, "<polyline class=\"ground\" points=\"{}\"/>", points.join(" "));
    }
    for (n, (track, curve)) in export.motion.tracks.iter().zip(curves).enumerate() {
        let [x, _, up] = track.at(0.0);
        if curve.between == Between::Cubic {
            let _ = writeln!(body, "<path class=\"path\" d=\"{}\"/>", path(&view, curve, track.radius));
        }
        // Sideways and up have eases of their own, so each moves a group of its own.
        let moves = [("x", 0, view.scale), ("y", 2, -view.scale)];
        for (name, axis, scale) in moves {
            keyframes(&mut style, &format!("b{n}{name}"), curve, axis, scale, duration);
        }
        let _ = writeln!(
            body,
            "<g class=\"moves\" style=\"animation-name:b{n}x\"><g class=\"moves\" style=\"animation-name:b{n}y\"><circle class=\"ball\" cx=\"{}\" cy=\"{}\" r=\"{}\"><title>{}</title></circle></g></g>",
            view.x(x),
            view.y(up + track.radius),
            track.radius * view.scale,
            escaped(&track.name)
        );
    }
    let View { width, height, .. } = view;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\">
<title>{}</title>
<style>
.ground{{fill:none;stroke:#777;stroke-width:2}}
.path{{fill:none;stroke:#999;stroke-width:1;stroke-dasharray:2 4}}
.ball{{fill:#d9541a}}
.moves{{animation-duration:{duration}s;animation-iteration-count:infinite}}
{style}@media (prefers-reduced-motion:reduce){{.moves{{animation:none}}}}
</style>
{body}</svg>
",
        escaped(&export.motion.title)
    )
}

/// One axis, as shifts from where it starts.
fn keyframes(style: &mut String, name: &str, curve: &Curve, axis: usize, scale: f64, duration: f64) {
    let eases = eases(curve, axis);
    let letter = if axis == 0 { "X" } else { "Y" };
    let from = curve.keys.first().map_or(0.0, |key| key.place[axis]);
    let shift = |value: f64| format!("transform:translate{letter}({}px)", (value - from) * scale + 0.0);
    let _ = writeln!(style, "@keyframes {name}{{");
    for ease in &eases {
        let timing = match ease.handles {
            Some([a, b]) => format!("cubic-bezier({},{a},{},{b})", 1.0 / 3.0, 2.0 / 3.0),
            None => "steps(1,end)".to_owned(),
        };
        let percent = 100.0 * ease.t[0] / duration;
        let _ = writeln!(style, "{percent}%{{{};animation-timing-function:{timing}}}", shift(ease.value[0]));
    }
    if let Some(last) = eases.last() {
        let _ = writeln!(style, "{}%,100%{{{}}}", 100.0 * last.t[1] / duration, shift(last.value[1]));
    }
    style.push_str("}\n");
}

/// The path of the centre.
fn path(view: &View, curve: &Curve, radius: f64) -> String {
    let point = |[x, _, up]: [f64; 3]| format!("{} {}", view.x(x), view.y(up + radius));
    let mut path = String::new();
    for (n, pair) in curve.keys.windows(2).enumerate() {
        let third = (pair[1].t - pair[0].t) / 3.0;
        let [p, q] = [pair[0].place, pair[1].place];
        let out = std::array::from_fn(|axis| p[axis] + third * pair[0].leave[axis]);
        let back = std::array::from_fn(|axis| q[axis] - third * pair[1].enter[axis]);
        if n == 0 {
            let _ = write!(path, "M{}", point(p));
        }
        let _ = write!(path, "C{} {} {}", point(out), point(back), point(q));
    }
    path
}

/// Text as XML has it.
fn escaped(text: &str) -> String {
    let clean: String = text.chars().filter(|c| !c.is_control()).collect();
    clean.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
