//! A point that is pointed at: a ring around it, and words beside it where they cover least.

use plotters::element::Rectangle;
use plotters::style::FontStyle;
use plotters_backend::text_anchor::{HPos, VPos};

use crate::chart::Chart;
use crate::error::PlotError;
use crate::grain::grains;
use crate::marks::Trace;
use crate::panel::{Area, failed};
use crate::place::Place;
use crate::svg::number;
use crate::theme::{Background, CAPITAL, Dash, Ink, Type, room, words};

type Point = (f64, f64);

/// A part of the page in px.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rect {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl Rect {
    fn holds(&self, (x, y): Point) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    fn wider(self, by: f64) -> Self {
        Self { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }

    /// A rectangle of this size, pushed into `frame`.
    fn inside(self, frame: Self) -> Self {
        let by = |low: f64, high: f64, from: f64, to: f64| (from - low).max(0.0) + (to - high).min(0.0);
        let x = by(self.left, self.right, frame.left, frame.right);
        let y = by(self.top, self.bottom, frame.top, frame.bottom);
        Self { left: self.left + x, top: self.top + y, right: self.right + x, bottom: self.bottom + y }
    }
}

/// Words wider than this part of the panel stand in several lines: one line of them finds no place
/// near its point.
const WIDEST: f64 = 0.4;
/// The distance of two lines, in sizes of type.
const LEADING: f64 = 1.25;

/// Words in lines no wider than `most`, but for a word that is.
fn lines(text: &str, most: f64, b: f64) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match found.last_mut().map(|line| format!("{line} {word}")).filter(|line| room(line, b, false) <= most) {
            Some(longer) => {
                found.pop();
                found.push(longer);
            }
            None => found.push(word.to_owned()),
        }
    }
    found
}

/// Draws every callout of the chart; the panel reaches from left to right and from top to bottom.
pub(crate) fn draw(
    chart: &Chart,
    place: &Place,
    ([left, right], [top, bottom]): ([f64; 2], [f64; 2]),
    area: &Area,
    ty: Type,
) -> Result<(), PlotError> {
    let b = ty.base;
    let frame = Rect { left, top, right, bottom };
    let mut taken = ink(chart, place, frame);
    for (text, at) in &chart.callouts {
        let (x, y) = place.at(*at);
        let r = 2.0 * ty.mark();
        let [x0, cy, r2, d] = [x - r, y, r, 2.0 * r].map(|v| number(v, 2));
        let data = format!("M{x0} {cy}a{r2} {r2} 0 1 0 {d} 0a{r2} {r2} 0 1 0 -{d} 0Z");
        area.draw(&Trace { data, ink: Ink::Text, width: ty.rule(), dash: Dash::Solid, alpha: 1.0 }).map_err(failed)?;
        taken.extend([(x - r, y), (x + r, y), (x, y - r), (x, y + r)]);
        let lines = lines(text, WIDEST * (right - left), b);
        let width = lines.iter().map(|line| room(line, b, false)).fold(0.0, f64::max);
        let below = |line: usize| lines[line + 1..].iter().map(|_| LEADING * b).sum::<f64>();
        let size = (width, CAPITAL * b + if lines.is_empty() { 0.0 } else { below(0) });
        let spot = freest((x, y), size, frame.wider(-0.3 * b), &taken, b);
        if chart.background != Background::None {
            // The grid does not run through words.
            let Rect { left, top, right, bottom } = spot.wider(0.25 * b);
            let corners = [(grains(left), grains(top)), (grains(right), grains(bottom))];
            area.draw(&Rectangle::new(corners, Ink::Paper.wash(1.0))).map_err(failed)?;
        }
        let style = words(Ink::Text, b, FontStyle::Normal, HPos::Left, VPos::Bottom);
        for (n, line) in lines.iter().enumerate() {
            area.draw_text(line, &style, (grains(spot.left), grains(spot.bottom - below(n)))).map_err(failed)?;
        }
        taken.extend([(spot.left, spot.bottom), (spot.right, spot.top)]);
    }
    Ok(())
}

/// The points that words should not cover: along every line and limit, and every dot.
fn ink(chart: &Chart, place: &Place, frame: Rect) -> Vec<Point> {
    let dots = chart.dots.iter().map(|(_, at)| at).chain(&chart.marks);
    let mut ink: Vec<Point> = dots.map(|&at| place.at(at)).collect();
    let along = |from: Point, to: Point| {
        let part = move |k: u8| f64::from(k) / 24.0;
        (0..=24).map(part).map(move |s| (from.0 + s * (to.0 - from.0), from.1 + s * (to.1 - from.1)))
    };
    for stroke in chart.lines.iter().flat_map(|(_, strokes)| strokes) {
        let [from, to] = [stroke.start(), stroke.end()].map(|(x, y)| place.at([x, y]));
        ink.extend(along(from, to));
    }
    for (_, limit) in &chart.limits {
        let x = place.at([*limit, 1.0]).0;
        ink.extend(along((x, frame.top), (x, frame.bottom)));
    }
    ink
}

/// The place around a point, inside a frame, that covers least; of two the nearer one.
fn freest((x, y): Point, (width, height): (f64, f64), frame: Rect, ink: &[Point], b: f64) -> Rect {
    let mut best: Option<(f64, Rect)> = None;
    for away in [0.9_f64, 1.4, 2.0, 2.8, 3.8, 5.0] {
        for (over, down) in [(1, 0), (1, -1), (1, 1), (-1, 0), (-1, -1), (-1, 1), (0, -1), (0, 1)]
            .map(|(a, b)| (f64::from(a), f64::from(b)))
        {
            let left = x + over * away * b - 0.5 * (1.0 - over) * width;
            let top = y + down * away * b - 0.5 * height;
            let rect = Rect { left, top, right: left + width, bottom: top + height }.inside(frame);
            let covered = ink.iter().filter(|point| rect.wider(0.35 * b).holds(**point)).count();
            #[allow(clippy::cast_precision_loss)] // a count
            let cost = covered as f64 + 0.4 * away;
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, rect));
            }
        }
    }
    best.map_or(Rect { left: x, top: y - height, right: x + width, bottom: y }, |(_, rect)| rect)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect { left: 0.0, top: 0.0, right: 400.0, bottom: 300.0 };

    #[test]
    fn words_stand_to_the_right_where_nothing_else_does() {
        let rect = freest((100.0, 100.0), (80.0, 12.0), FRAME, &[], 16.0);
        assert!(rect.left > 110.0 && rect.top < 100.0 && rect.bottom > 100.0, "{rect:?}");
    }

    #[test]
    fn long_words_stand_in_lines_that_are_short() {
        let text = "Polished concrete floor of the school gymnasium, east side";
        let found = lines(text, 200.0, 16.0);
        assert!(found.len() > 1 && found.iter().all(|line| room(line, 16.0, false) <= 200.0), "{found:?}");
        assert_eq!(found.join(" "), text);
        assert_eq!((lines("grass", 20.0, 16.0), lines("", 20.0, 16.0).len()), (vec!["grass".to_owned()], 0));
    }

    #[test]
    fn words_keep_off_what_is_drawn_and_inside_the_frame() {
        // A line to the right, and the frame's edge to the left.
        let line: Vec<Point> = (0..40).map(|k| (20.0 + 10.0 * f64::from(k), 100.0)).collect();
        let rect = freest((20.0, 100.0), (80.0, 12.0), FRAME, &line, 16.0);
        assert!(!line.iter().any(|at| rect.holds(*at)), "{rect:?}");
        assert!(rect.left >= 0.0 && rect.right <= 400.0 && rect.top >= 0.0 && rect.bottom <= 300.0, "{rect:?}");
    }
}
