//! The animator's timing chart: where the ball is in every frame, as a picture that stands still.
//!
//! A ball that travels is shown on its path, to scale. One that only goes up and down would draw
//! over itself, so each way up and each way down is a line of its own, from left to right.

use std::fmt::Write;

use super::flat::cubics;
use super::svg::escaped;
use super::{Ball, Export};
use crate::motion::Track;

/// The least width and the height of the picture, in its own units.
const PAGE: [f64; 2] = [900.0, 620.0];
/// Room left, right, above and below.
const ROOM: [f64; 4] = [64.0, 40.0, 84.0, 64.0];
/// Numbers are this high, and this much apart at least.
const SIZE: f64 = 12.0;
/// Two lines of a ball that only goes up and down are this far apart.
const APART: f64 = 44.0;
/// A path this much wider than high is shown as one; so is any that is not this much narrower.
const TRAVELS: f64 = 0.25;

/// The event at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Event {
    Contact,
    Top,
    Frame,
}

/// Something to be marked on a line.
#[derive(Clone, Copy, Debug)]
struct Mark {
    event: Event,
    t: f64,
    /// The place on the picture.
    at: [f64; 2],
    /// The direction of the line on the picture, of length 1.
    along: [f64; 2],
}

pub(super) fn chart(export: &Export<'_>, balls: &[Ball<'_>]) -> String {
    let [[left, right], [low, high]] = reach(balls);
    let travels = right - left > TRAVELS * (high - low).max(1e-9);
    let runs: Vec<Vec<[f64; 2]>> = balls.iter().map(|ball| ways(ball.track)).collect();
    let columns = if travels { 0 } else { runs.iter().map(Vec::len).sum() };
    let width = PAGE[0].max(ROOM[0] + ROOM[1] + APART * columns as f64);
    let (wide, tall) = (width - ROOM[0] - ROOM[1], PAGE[1] - ROOM[2] - ROOM[3]);
    let (across, up) = ((right - left).max(1e-9), (high - low).max(1e-9));
    let scale = if travels { (wide / across).min(tall / up) } else { tall / up };
    let height = ROOM[2] + ROOM[3] + up * scale;
    let y = |z: f64| ROOM[2] + (high - z) * scale;
    let apart = wide / columns.max(1) as f64;
    let (mut lines, mut marks, mut column) = (String::new(), Vec::new(), 0_u32);
    for (ball, runs) in balls.iter().zip(&runs) {
        let track = ball.track;
        if travels {
            let x = |x: f64| ROOM[0] + (x - left) * scale;
            let way = cubics(&ball.path, |p| format!("{:.2} {:.2}", x(p[0]), y(p[2])));
            let _ = writeln!(lines, "<path class=\"way\" d=\"{way}\"/>");
            let at = |t: f64| [x(track.at(t)[0]), y(track.at(t)[2])];
            let all = [0.0, track.end()];
            marks.extend(events(export, track, all).into_iter().map(|(t, event)| {
                let [vx, _, vz] = track.stretch(t).slope(t);
                let speed = vx.hypot(vz);
                let along = if speed > 0.0 { [vx / speed, -vz / speed] } else { [1.0, 0.0] };
                Mark { event, t, at: at(t), along }
            }));
        } else {
            let mut last: Option<[f64; 2]> = None;
            for &run in runs {
                let x = ROOM[0] + apart * (f64::from(column) + 0.4);
                column += 1;
                let ends = run.map(|t| y(track.stretch(0.5 * (run[0] + run[1])).at(t)[2]));
                let _ = writeln!(lines, "<path class=\"way\" d=\"M{x:.2} {:.2}V{:.2}\"/>", ends[0], ends[1]);
                if let Some([from, level]) = last {
                    let _ = writeln!(lines, "<path class=\"link\" d=\"M{from:.2} {level:.2}H{x:.2}\"/>");
                }
                last = Some([x, ends[1]]);
                marks.extend(events(export, track, run).into_iter().map(|(t, event)| {
                    let z = track.stretch(0.5 * (run[0] + run[1])).at(t)[2];
                    Mark { event, t, at: [x, y(z)], along: [0.0, 1.0] }
                }));
            }
        }
    }
    for line in export.motion.ground.iter().filter(|_| travels) {
        let points: Vec<String> =
            line.iter().map(|&[x, z]| format!("{:.2},{:.2}", ROOM[0] + (x - left) * scale, y(z))).collect();
        let _ = writeln!(lines, "<polyline class=\"ground\" points=\"{}\"/>", points.join(" "));
    }
    let (drawn, hidden) = numbered(export, marks, !travels);
    let title = escaped(&export.motion.title);
    let every = if export.frames.on_twos { "every second frame, " } else { "every frame, " };
    let left_out = if hidden > 0 { " Numbers that would lie on others are left out." } else { "" };
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height:.0}\" width=\"{width}\" height=\"{height:.0}\" role=\"img\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"{SIZE}\">
<title>{title}: timing chart</title>
<style>
.page{{fill:#fff}}text{{fill:#222;stroke:#fff;stroke-width:3px;paint-order:stroke}}
.way{{fill:none;stroke:#888;stroke-width:1.5}}
.link{{fill:none;stroke:#aaa;stroke-width:1;stroke-dasharray:2 4}}
.ground{{fill:none;stroke:#777;stroke-width:2}}
.frame{{stroke:#222;stroke-width:1.5}}
.contact{{fill:#d9541a}}
.top{{fill:#fff;stroke:#d9541a;stroke-width:2}}
@media (prefers-color-scheme:dark){{.page{{fill:#1b1b1b}}text{{fill:#ddd;stroke:#1b1b1b}}.frame{{stroke:#ddd}}.top{{fill:#1b1b1b}}}}
</style>
<rect class=\"page\" width=\"100%\" height=\"100%\"/>
<text x=\"{0}\" y=\"36\" font-size=\"20\">{title}</text>
<text x=\"{0}\" y=\"58\">A tick for {every}{1} frames per second; numbers count frames.{left_out}</text>
{lines}{drawn}<g transform=\"translate({0} {2:.2})\"><path class=\"frame\" d=\"M0 0h12\"/><text x=\"18\" y=\"4\">frame</text><circle class=\"contact\" cx=\"80\" r=\"5\"/><text x=\"91\" y=\"4\">contact</text><circle class=\"top\" cx=\"160\" r=\"5\"/><text x=\"171\" y=\"4\">top</text></g>
</svg>
",
        ROOM[0],
        export.frames.rate,
        height - 20.0
    )
}

/// The reach of the lowest points, [x, up] from least to greatest.
fn reach(balls: &[Ball<'_>]) -> [[f64; 2]; 2] {
    let mut reach = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for stretch in balls.iter().flat_map(|ball| &ball.track.stretches) {
        let (_, at) = stretch.top();
        for [x, _, up] in [stretch.start(), at, stretch.end()].map(|t| stretch.at(t)) {
            for (range, value) in reach.iter_mut().zip([x, up]) {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
    }
    reach
}

/// The ways up and down of a ball, each from when to when, in s. Where it stays there is none.
fn ways(track: &Track) -> Vec<[f64; 2]> {
    let moving = track
        .stretches
        .iter()
        .filter(|stretch| stretch.at(stretch.start())[2] != stretch.at(stretch.end())[2] || stretch.flight);
    moving
        .flat_map(|stretch| {
            let (start, end, (_, top)) = (stretch.start(), stretch.end(), stretch.top());
            if top > start && top < end { vec![[start, top], [top, end]] } else { vec![[start, end]] }
        })
        .collect()
}

/// Frames, contacts and tops from when to when; an instant that is one of the latter on a frame is
/// no frame besides.
fn events(export: &Export<'_>, track: &Track, [from, to]: [f64; 2]) -> Vec<(f64, Event)> {
    let (step, grace) = (export.frames.step(), 1e-6 * export.frames.step());
    let inside = |t: f64| t >= from - grace && t <= to + grace;
    let mut events: Vec<(f64, Event)> = track.contacts().filter(|&t| inside(t)).map(|t| (t, Event::Contact)).collect();
    for stretch in track.stretches.iter().filter(|stretch| stretch.flight) {
        let (_, t) = stretch.top();
        // What is let go from rest starts at a top.
        let ends = stretch.start() + grace..stretch.end() - grace;
        if inside(t) && (ends.contains(&t) || (t == 0.0 && stretch.slope(t)[2] == 0.0)) {
            events.push((t, Event::Top));
        }
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most a million
    let span = ((from / step - 1e-6).ceil().max(0.0) as u32, (to / step + 1e-6).floor() as u32);
    for k in span.0..=span.1 {
        let t = f64::from(k) * step;
        if events.iter().all(|(other, _)| (other - t).abs() > grace) {
            events.push((t.clamp(from, to), Event::Frame));
        }
    }
    events
}

/// Marks with as many of their numbers as there is room for, contacts and tops first; and how many
/// are without.
fn numbered(export: &Export<'_>, mut marks: Vec<Mark>, columns: bool) -> (String, usize) {
    marks.sort_by(|a, b| a.event.cmp(&b.event).then(a.t.total_cmp(&b.t)));
    let mut taken: Vec<[f64; 4]> = Vec::new();
    let (mut ticks, mut points, mut numbers, mut hidden) = (String::new(), String::new(), String::new(), 0);
    for Mark { event, t, at: [x, y], along: [dx, dy] } in marks {
        // Across the line, to the right or below.
        let [ax, ay] = if dy.abs() >= dx.abs() { [dy.abs(), -dx * dy.signum()] } else { [-dy * dx.signum(), dx.abs()] };
        let _ = match event {
            Event::Contact => writeln!(points, "<circle class=\"contact\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"5\"/>"),
            Event::Top => writeln!(points, "<circle class=\"top\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"5\"/>"),
            Event::Frame => writeln!(
                ticks,
                "<path class=\"frame\" d=\"M{:.2} {:.2}L{:.2} {:.2}\"/>",
                x - 5.0 * ax,
                y - 5.0 * ay,
                x + 5.0 * ax,
                y + 5.0 * ay
            ),
        };
        let number = export.frames.number(t);
        let text = format!("{number:.1}");
        let text = text.trim_end_matches(".0");
        let wide = 0.58 * SIZE * text.len() as f64;
        // To the right of the tick, or where the line itself goes that way, centred below it; on a
        // path tops are named above it and contacts below.
        let (left, top) = match event {
            Event::Contact if !columns => (x - 0.5 * wide, y + 9.0),
            Event::Top if !columns => (x - 0.5 * wide, y - 9.0 - SIZE),
            _ if ax.abs() >= ay.abs() => (x + 9.0, y - 0.5 * SIZE),
            _ => (x - 0.5 * wide, y + 9.0),
        };
        let area = [left - 2.0, top, left + wide + 2.0, top + SIZE];
        let free =
            |other: &[f64; 4]| area[0] > other[2] || area[2] < other[0] || area[1] > other[3] || area[3] < other[1];
        if taken.iter().all(free) {
            taken.push(area);
            let _ = writeln!(numbers, "<text x=\"{left:.2}\" y=\"{:.2}\">{text}</text>", top + 0.85 * SIZE);
        } else {
            hidden += 1;
        }
    }
    (ticks + &points + &numbers, hidden)
}
