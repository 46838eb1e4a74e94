//! Jumps in a panel: upright lines, and both limits of a line that breaks.

use crate::curve::Affine;
use crate::marks::dot;
use crate::svg::number;
use crate::theme::Type;
use crate::traced::Traced;

/// The most jumps that have upright lines.
const MOST_UPRIGHT: usize = 80;
/// Jumps nearer to each other than this, in px, have one upright line.
const ONE: f64 = 3.0;
/// No panel is wider than this, in px.
const MOST: f64 = 750.0;
/// Breaks nearer to each other than this, in px, are joined by one line.
const SAME: f64 = 0.3;
/// A line breaks visibly where its limits are farther apart than this, in px.
const BREAK: f64 = 2.5;

/// Half the breadth of the mark of a limit, in px.
pub(super) fn radius(ty: Type) -> f64 {
    0.62 * ty.mark()
}

/// Whether there are so few jumps that each may have an upright line.
pub(super) fn few(traced: &Traced) -> bool {
    let (from, to) = traced.window;
    let nearest = ONE / MOST * (to - from);
    let mut times: Vec<f64> = traced.leaps.iter().filter(|leap| !leap.limit).map(|leap| leap.t).collect();
    times.dedup_by(|next, t| *next - *t < nearest);
    times.len() <= MOST_UPRIGHT
}

/// The upright lines of jumps, none if there are too many of them, and those of limits at which
/// jumps accumulate.
pub(super) fn upright(traced: &Traced, x: Affine, (top, bottom): (f64, f64)) -> (String, String) {
    let line = |px: f64| format!("M{} {}V{}", number(px, 2), number(top, 2), number(bottom, 2));
    let lines = |limit: bool| -> String {
        let leaps = traced.leaps.iter().filter(|leap| leap.limit == limit);
        let mut places: Vec<f64> = leaps.map(|leap| x.at(leap.t)).collect();
        places.dedup_by(|next, px| *next - *px < ONE);
        places.into_iter().map(line).collect()
    };
    let jumps = if few(traced) { lines(false) } else { String::new() };
    (jumps, lines(true))
}

/// The marks of the jumps of one line, as path data.
#[derive(Debug, Default)]
pub(super) struct Sides {
    pub(super) between: String,
    /// A ring for each limit before.
    pub(super) before: String,
    /// A dot for each limit after.
    pub(super) after: String,
}

/// Both limits of each jump at which the line breaks; marks only where no other jump is near.
pub(super) fn sides(traced: &Traced, line: usize, (x, y): (Affine, Affine), ty: Type) -> Sides {
    let place = |(t, from, to): (f64, f64, f64)| (x.at(t), y.at(from), y.at(to));
    let breaks: Vec<_> = traced.breaks(line).map(place).collect();
    let r = radius(ty);
    let mut sides = Sides::default();
    let mut drawn = f64::NEG_INFINITY;
    for (n, &(px, from, to)) in breaks.iter().enumerate() {
        if (from - to).abs() < BREAK {
            continue;
        }
        if px - drawn > SAME {
            sides.between.push_str(&format!("M{} {}V{}", number(px, 2), number(from, 2), number(to, 2)));
            drawn = px;
        }
        let near = |other: Option<&(f64, f64, f64)>| other.is_some_and(|other| (other.0 - px).abs() < 4.0 * r);
        let crowded = near(n.checked_sub(1).and_then(|before| breaks.get(before))) || near(breaks.get(n + 1));
        if crowded || (from - to).abs() < 3.0 * r {
            continue;
        }
        let [left, middle, breadth] = [px - r, from, 2.0 * r].map(|value| number(value, 2));
        let [radius, back] = [r, -2.0 * r].map(|value| number(value, 2));
        let half = format!("a{radius} {radius} 0 1 0");
        sides.before.push_str(&format!("M{left} {middle}{half} {breadth} 0{half} {back} 0Z"));
        sides.after.push_str(&dot((px, to)));
    }
    sides
}
