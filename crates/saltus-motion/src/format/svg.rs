//! SVG that moves by CSS alone, and stands still for those who ask for less motion.

use std::fmt::Write;

use super::flat::{Channel, Moves, channels, cubics};
use super::view::View;
use super::{Ball, Export, ink};
use crate::curve::Between;

/// The time for which the last picture stands before it starts again, in s.
const PAUSE: f64 = 1.0;

/// A stand-in for the number that makes the names of a picture its own in a page, until that number
/// has been computed; no text that is shown has a control character.
const MARK: &str = "\u{1}";

/// The picture, all of whose names begin with a number made of its content: several may stand in
/// one page, and none moves another.
pub(super) fn animated(export: &Export<'_>, balls: &[Ball<'_>]) -> String {
    let picture = marked(export, balls);
    // Fowler, Noll and Vo's hash, 1a.
    let hash = picture
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    picture.replace(MARK, &format!("s{hash:016x}"))
}

fn marked(export: &Export<'_>, balls: &[Ball<'_>]) -> String {
    let view = View::of(export.motion);
    let duration = export.motion.end() + if export.motion.loops { 0.0 } else { PAUSE };
    let (mut style, mut body) = (String::new(), String::new());
    for line in &export.motion.ground {
        let points: Vec<String> = line.iter().map(|&[x, up]| format!("{},{}", view.x(x), view.y(up))).collect();
        let _ = writeln!(body, "<polyline class=\"ground\" points=\"{}\"/>", points.join(" "));
    }
    for (n, ball) in balls.iter().enumerate() {
        if ball.path.between == Between::Cubic {
            let way = cubics(&ball.path, |[x, _, up]| format!("{} {}", view.x(x), view.y(up + ball.track.radius)));
            let _ = writeln!(body, "<path class=\"path\" d=\"{way}\"/>");
        }
        // Each number has eases of its own, so each moves a group of its own.
        let channels = channels(ball, &view);
        let start = |moves: Moves| {
            let of = channels.iter().find(|channel| channel.moves == moves).and_then(|channel| channel.eases.first());
            of.map_or(0.0, |ease| ease.value[0])
        };
        let (x, y) = (start(Moves::X), start(Moves::Y));
        // A ball that would be no more than a dot is drawn larger about its centre.
        let r = view.radius(ball.track.radius);
        let _ = write!(body, "<g transform=\"translate({x} {y})\">");
        for (k, channel) in channels.iter().enumerate() {
            let name = format!("{MARK}b{n}{}", channel.name);
            // The first two are shifts from where the ball starts.
            keyframes(&mut style, &name, channel, [x, y].get(k).copied().unwrap_or(0.0), duration);
            let _ = write!(body, "<g class=\"moves\" style=\"animation-name:{name}\">");
        }
        let _ = write!(
            body,
            "<circle class=\"ball\" r=\"{r}\"{} data-radius=\"{}\"><title>{}</title></circle>",
            // The style has the first one's.
            if n == 0 { String::new() } else { format!(" style=\"fill:{}\"", ink(n)) },
            ball.track.radius * view.scale,
            escaped(&ball.track.name)
        );
        if ball.dress.as_ref().is_some_and(|dress| !dress.spin.is_empty()) {
            // A mark, which shows the turning.
            let _ = write!(body, "<path class=\"mark\" stroke-width=\"{}\" d=\"M0 0V{}\"/>", 0.3 * r, -0.8 * r);
        }
        let _ = writeln!(body, "{}</g>", "</g>".repeat(channels.len()));
    }
    let View { width, height, .. } = view;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" class=\"{MARK}\">
<title>{}</title>
<style>
.{MARK} .ground{{fill:none;stroke:#777;stroke-width:2}}
.{MARK} .path{{fill:none;stroke:#999;stroke-width:1;stroke-dasharray:2 4}}
.{MARK} .ball{{fill:#d9541a}}
.{MARK} .mark{{stroke:#f2cc99;stroke-linecap:round}}
.{MARK} .moves{{animation-duration:{duration}s;animation-iteration-count:infinite}}
{style}@media (prefers-reduced-motion:reduce){{.{MARK} .moves{{animation:none}}}}
</style>
{body}</svg>
",
        escaped(&export.motion.title)
    )
}

/// One number as it goes, from `from` on.
fn keyframes(style: &mut String, name: &str, channel: &Channel, from: f64, duration: f64) {
    let shown = |value: f64| {
        let value = value - from + 0.0;
        match channel.moves {
            Moves::X => format!("transform:translateX({value}px)"),
            Moves::Y => format!("transform:translateY({value}px)"),
            Moves::Turn => format!("transform:rotate({value}deg)"),
            Moves::ScaleX => format!("transform:scaleX({value})"),
            Moves::ScaleY => format!("transform:scaleY({value})"),
        }
    };
    let _ = writeln!(style, "@keyframes {name}{{");
    for ease in &channel.eases {
        let timing = match ease.handles {
            Some([a, b]) => format!("cubic-bezier({},{a},{},{b})", 1.0 / 3.0, 2.0 / 3.0),
            None => "steps(1,end)".to_owned(),
        };
        let percent = 100.0 * ease.t[0] / duration;
        let _ = writeln!(style, "{percent}%{{{};animation-timing-function:{timing}}}", shown(ease.value[0]));
    }
    if let Some(last) = channel.eases.last() {
        let _ = writeln!(style, "{}%,100%{{{}}}", 100.0 * last.t[1] / duration, shown(last.value[1]));
    }
    style.push_str("}\n");
}

/// Text as XML has it.
pub(super) fn escaped(text: &str) -> String {
    let clean: String = text.chars().filter(|c| !c.is_control()).collect();
    clean.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
