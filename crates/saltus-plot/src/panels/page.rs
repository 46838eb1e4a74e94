//! The page of panels: heading, panels, the lane of modes, one axis of time.

use std::cell::RefCell;
use std::rc::Rc;

use plotters::chart::{ChartBuilder, LabelAreaPosition};

use super::frame::Frame;
use super::lane::Lane;
use super::leaps;
use crate::axis::{Axis, opened, typeset};
use crate::coordinate::Label;
use crate::curve::path;
use crate::error::{PlotError, finite};
use crate::grain::grains;
use crate::heading::{Heading, Legend, Sign};
use crate::marks::{Trace, event};
use crate::measure::Measure;
use crate::panel::{Area, band, failed, maps, mesh};
use crate::polynomial::extent;
use crate::stroke::Stroke;
use crate::svg::{Canvas, Sheet, number};
use crate::theme::{Background, CAPITAL, Dash, Ink, Type, width};
use crate::traced::{Part, Traced};
use crate::unit::Unit;

/// The width of a page, and the height of all its panels if each is high enough then, in px.
const PAGE: (f64, f64) = (800.0, 470.0);
/// The least height of a panel, in px.
const LOWEST: f64 = 116.0;
/// Lines of a panel beyond so many have no names of their own.
const NAMES: usize = 8;

/// The content of a page.
#[derive(Debug)]
pub(super) struct Content<'a> {
    pub(super) title: &'a str,
    pub(super) captions: &'a [String],
    /// The labels of the coordinates drawn.
    pub(super) labels: &'a [Label],
    /// The groups of coordinates that share a panel.
    pub(super) groups: Vec<Vec<usize>>,
    pub(super) traced: &'a Traced,
    pub(super) time: &'a Measure,
    pub(super) background: Background,
}

/// One panel: its lines, their unit, how far they reach.
#[derive(Debug)]
struct Panel {
    lines: Vec<usize>,
    unit: Unit,
    legend: Legend,
    axis: Axis,
}

impl Panel {
    /// The room that its words take above it, in px.
    fn above(&self) -> f64 {
        self.legend.height() + 1.1 * self.legend.ty().base
    }
}

/// The look of a line among so many of a panel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pen {
    pub(super) ink: Ink,
    dash: Dash,
    width: f64,
    alpha: f64,
}

impl Pen {
    fn of(line: usize, lines: usize, ty: Type) -> Self {
        if lines > NAMES {
            return Self { ink: Ink::Series(0), dash: Dash::Solid, width: ty.hairline(), alpha: 0.6 };
        }
        Self { ink: Ink::series(line), dash: Dash::steep(line), width: ty.line(), alpha: 1.0 }
    }
}

/// The whole picture.
pub(super) fn draw(content: &Content<'_>) -> Result<String, PlotError> {
    let w = PAGE.0;
    let ty = Type::for_size(800.0, 560.0);
    let b = ty.base;
    let heading = Heading::of(content.title, content.captions, events(content.traced), ty, w);
    let high = (PAGE.1 / content.groups.len() as f64 - 2.55 * b).max(LOWEST);
    let reach = reach(content)?;
    let panels: Vec<Panel> = content.groups.iter().map(|lines| panel(content, lines, &reach, (high, w), ty)).collect();
    let lane = Lane::of(&content.traced.modes, ty);
    let (frame, time_label) = frame(content, &panels, lane.as_ref(), (w, ty));
    let titles: f64 = panels.iter().map(Panel::above).sum();
    let foot = frame.foot + 0.8 * ty.margin();
    let h = heading.height() + titles + high * panels.len() as f64 + lane.as_ref().map_or(0.0, Lane::height) + foot;

    let canvas = Rc::new(RefCell::new(Canvas::new(w, h.ceil())));
    let root = Area::from(&canvas);
    if content.background != Background::None {
        let paper = format!("M0 0H{}V{}H0Z", number(w, 2), number(h.ceil(), 2));
        canvas.try_borrow_mut().map_err(|e| PlotError::Drawing(e.to_string()))?.area(&paper, Ink::Paper);
    }
    heading.draw(&root)?;
    let mut y = heading.height();
    for (n, panel) in panels.iter().enumerate() {
        y += panel.above();
        panel.legend.draw(&root, ty.margin(), y - panel.legend.height() - 0.3 * b)?;
        let foot = if n + 1 == panels.len() && lane.is_none() { frame.foot } else { 0.0 };
        one(content, panel, &band(&root, y, high + foot, w), (&frame, &time_label), foot)?;
        y += high;
    }
    if let Some(lane) = lane {
        lane.draw(content.traced, &root, (y, w), (&frame, &time_label))?;
    }
    let description = described(content, &reach, &time_label);
    let adaptive = content.background != Background::White;
    let title = if content.title.is_empty() { "A run against time" } else { content.title };
    let sheet = Sheet { title, description: &description, adaptive };
    let svg = canvas.try_borrow_mut().map_err(|e| PlotError::Drawing(e.to_string()))?.document(sheet);
    Ok(svg)
}

/// The meaning of the upright lines, if there are any.
fn events(traced: &Traced) -> Vec<(Sign, String)> {
    let jump =
        (leaps::few(traced) && traced.leaps.iter().any(|leap| !leap.limit)).then(|| (Sign::Jump, "jump".to_owned()));
    let limit = traced.leaps.iter().any(|leap| leap.limit).then(|| (Sign::Limit, "jumps accumulate".to_owned()));
    jump.into_iter().chain(limit).collect()
}

/// The reach of each coordinate.
fn reach(content: &Content<'_>) -> Result<Vec<(f64, f64)>, PlotError> {
    let reach = |(line, label): (usize, &Label)| {
        let mut reach = (f64::INFINITY, f64::NEG_INFINITY);
        for part in content.traced.parts() {
            let coefficients = &part.coefficients[line];
            if !coefficients.is_empty() {
                let (low, high) = extent(coefficients, part.span / part.scale);
                reach = (reach.0.min(low), reach.1.max(high));
                finite(low, || format!("{} near t = {}", label.name, part.start))?;
                finite(high, || format!("{} near t = {}", label.name, part.start))?;
            }
        }
        for (t, before, after) in content.traced.breaks(line) {
            for value in [before, after] {
                finite(value, || format!("{} at t = {t}", label.name))?;
                reach = (reach.0.min(value), reach.1.max(value));
            }
        }
        // A coordinate that is not there in this part of time has a panel all the same.
        Ok(if reach.0 > reach.1 { (0.0, 0.0) } else { reach })
    };
    content.labels.iter().enumerate().map(reach).collect()
}

fn panel(content: &Content<'_>, lines: &[usize], reach: &[(f64, f64)], (high, page): (f64, f64), ty: Type) -> Panel {
    let labels: Vec<&Label> = lines.iter().map(|&line| &content.labels[line]).collect();
    let (low, top) = lines
        .iter()
        .map(|&line| reach[line])
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (l, h)| (low.min(l), high.max(h)));
    let same = labels.iter().all(|label| label.unit == labels[0].unit);
    let unit = if same {
        Unit::named(&labels[0].unit, low.abs().max(top.abs()), top - low)
    } else {
        Unit { size: 1.0, label: String::new() }
    };
    let (low, top) = opened((low / unit.size, top / unit.size));
    let air = (top - low) * (0.5 * ty.base / high).min(0.1);
    let ends = (low - air, top + air);
    let most = (high / (1.4 * ty.base)).clamp(2.0, 10.0) as usize;
    let legend = Legend::of(words(&labels, &unit, same, ty), ty, page - 2.0 * ty.margin());
    Panel { lines: lines.to_vec(), legend, axis: Axis::new(ends.0, ends.1, ends, most), unit }
}

/// The words above a panel: the name of its line, or a sign and a name for each; and the unit.
fn words(labels: &[&Label], unit: &Unit, same: bool, ty: Type) -> Vec<(Sign, String)> {
    let brackets = if unit.label.is_empty() { String::new() } else { format!(" ({})", unit.label) };
    match labels {
        [label] => vec![(Sign::Nothing, format!("{}{brackets}", label.name))],
        [first, .., last] if labels.len() > NAMES => {
            vec![(Sign::Nothing, format!("{} to {}{brackets}", first.name, last.name))]
        }
        _ => {
            let own = |label: &Label| {
                if same || label.unit.is_empty() { String::new() } else { format!(" ({})", label.unit) }
            };
            let line = |(n, label): (usize, &&Label)| {
                let pen = Pen::of(n, labels.len(), ty);
                (Sign::Line(pen.ink, pen.dash), format!("{}{}", label.name, own(label)))
            };
            let unit = (!brackets.is_empty()).then(|| (Sign::Nothing, brackets.trim().to_owned()));
            labels.iter().enumerate().map(line).chain(unit).collect()
        }
    }
}

/// The axis of time and the margins, and the name of the axis.
fn frame(content: &Content<'_>, panels: &[Panel], lane: Option<&Lane<'_>>, (w, ty): (f64, Type)) -> (Frame, String) {
    let b = ty.base;
    let widest = |axis: &Axis| axis.ticks().iter().map(|&tick| width(&axis.text(tick), b, false)).fold(0.0, f64::max);
    let numbers = panels.iter().map(|panel| widest(&panel.axis)).fold(0.0, f64::max) * 1.04;
    let left = ty.margin() + numbers.max(lane.map_or(0.0, Lane::words)) + 0.55 * b;
    let right = ty.margin();
    let (from, to) = content.traced.window;
    let second = content.time.unit((from, to));
    let (low, high) = (from / second.size, to / second.size);
    let length = w - left - right;
    let air = (high - low) * (0.4 * b / length).min(0.1);
    let time = Axis::new(low - air, high + air, (low - air, high + air), 12)
        .thinned(length, 1.6 * b, |text| width(text, b, false));
    let foot = (0.55 + CAPITAL + 0.75 + CAPITAL) * b;
    let label = if second.label.is_empty() { "Time".to_owned() } else { format!("Time ({})", second.label) };
    (Frame { ty, time, second: second.size, left, right, foot }, label)
}

/// Draws one panel.
fn one(
    content: &Content<'_>,
    panel: &Panel,
    area: &Area,
    (frame, time_label): (&Frame, &str),
    foot: f64,
) -> Result<(), PlotError> {
    let ty = frame.ty;
    let mut chart = ChartBuilder::on(area)
        .set_label_area_size(LabelAreaPosition::Left, grains(frame.left))
        .margin_right(grains(frame.right))
        .set_label_area_size(LabelAreaPosition::Bottom, grains(foot))
        .build_cartesian_2d(frame.time, panel.axis)
        .map_err(failed)?;
    mesh(&mut chart, ty, Some(time_label))?;
    let (x, y) = maps(&chart);
    let (low, high) = panel.axis.ends();
    let (t0, t1) = frame.time.ends();
    let (bottom, top) = (y.at(low), y.at(high));
    if low < 0.0 && high > 0.0 {
        let data = format!("M{} {}H{}", number(x.at(t0), 2), number(y.at(0.0), 2), number(x.at(t1), 2));
        let zero = Trace { data, ink: Ink::Floor, width: ty.hairline(), dash: Dash::Solid, alpha: 0.45 };
        chart.draw_series([zero]).map_err(failed)?;
    }
    let (x, y) = (x.per_unit(frame.second), y.per_unit(panel.unit.size));
    let (jumps, limits) = leaps::upright(content.traced, x, (top, bottom));
    chart.draw_series([event(jumps, ty)]).map_err(failed)?;
    let limits = Trace { data: limits, ink: Ink::Text, width: ty.rule(), dash: Dash::Dashed, alpha: 1.0 };
    chart.draw_series([limits]).map_err(failed)?;
    for (n, &line) in panel.lines.iter().enumerate().rev() {
        let Pen { ink, dash, width, alpha } = Pen::of(n, panel.lines.len(), ty);
        let strokes: Vec<Stroke> = content.traced.parts().filter_map(|part| stroke(part, line)).collect();
        let sides = leaps::sides(content.traced, line, (x, y), ty);
        let thin =
            Trace { data: sides.between, ink, width: 0.8 * ty.hairline(), dash: Dash::Dashed, alpha: 0.7 * alpha };
        chart.draw_series([thin]).map_err(failed)?;
        let data = path(&strokes, x, y);
        chart.draw_series([Trace { data, ink, width, dash, alpha }]).map_err(failed)?;
        let rings = Trace { data: sides.before, ink, width: 1.2 * ty.hairline(), dash: Dash::Solid, alpha };
        let dots = Trace { data: sides.after, ink, width: 2.0 * leaps::radius(ty), dash: Dash::Solid, alpha };
        chart.draw_series([rings, dots]).map_err(failed)?;
    }
    Ok(())
}

/// A coordinate over time.
fn stroke(part: &Part, line: usize) -> Option<Stroke> {
    let coefficients = &part.coefficients[line];
    let over = || Stroke::new(part.span / part.scale, vec![part.start, part.scale], coefficients.clone());
    (!coefficients.is_empty()).then(over)
}

/// The picture in a sentence, for those who cannot see it.
fn described(content: &Content<'_>, reach: &[(f64, f64)], time: &str) -> String {
    let short = |value: f64| typeset(&number(value, 4));
    let line = |(label, (low, high)): (&Label, &(f64, f64))| {
        format!("{} from {} to {} {}", label.name, short(*low), short(*high), label.unit).trim_end().to_owned()
    };
    let lines: Vec<String> = content.labels.iter().zip(reach).take(NAMES).map(line).collect();
    let more = content.labels.len().saturating_sub(NAMES);
    let more = if more > 0 { format!("; {more} more") } else { String::new() };
    let mut text = format!("{} against {}: {}{more}.", "Coordinates of a run", time.to_lowercase(), lines.join("; "));
    let traced = content.traced;
    if !traced.leaps.is_empty() {
        text.push_str(&format!(" Jumps: {}.", traced.leaps.len()));
    }
    if traced.modes.len() > 1 {
        text.push_str(&format!(" Modes: {}.", traced.modes.join(", ")));
    }
    for caption in content.captions {
        text.push_str(&format!(" {caption}."));
    }
    text
}
