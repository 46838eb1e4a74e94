//! The page of a chart: heading, panel, axes to whatever scale is asked for.

use std::cell::RefCell;
use std::rc::Rc;

use plotters::chart::{ChartBuilder, LabelAreaPosition};
use plotters::element::EmptyElement;
use plotters::style::FontStyle;
use plotters_backend::text_anchor::{HPos, VPos};

use crate::axis::{Axis, MANY_DECADES, opened};
use crate::callout;
use crate::chart::Chart;
use crate::curve::{Affine, path};
use crate::error::PlotError;
use crate::grain::grains;
use crate::heading::{Heading, Sign};
use crate::marks::{Trace, dot};
use crate::measure::Measure;
use crate::panel::{Area, failed, maps, mesh};
use crate::place::Place;
use crate::svg::{Canvas, Sheet, number};
use crate::theme::{Background, CAPITAL, Dash, Ink, Type, width, words};
use crate::unit::Unit;

/// The width of a page and its usual height, in px.
const PAGE: (f64, f64) = (800.0, 560.0);
/// The lowest and the highest panel of a picture to scale, as parts of its width.
const SHAPES: (f64, f64) = (0.18, 1.1);

impl Chart {
    /// The picture as an SVG document.
    ///
    /// # Errors
    /// [`PlotError::Empty`] when there is nothing to draw, [`PlotError::NotFinite`] and
    /// [`PlotError::Negative`] naming the number at fault.
    pub fn svg(&self) -> Result<String, PlotError> {
        draw(self, self.reach()?)
    }
}

/// Draws `chart`, whose data reach so far across and up.
fn draw(chart: &Chart, reach: [(f64, f64); 2]) -> Result<String, PlotError> {
    let w = PAGE.0;
    let ty = Type::for_size(PAGE.0, PAGE.1);
    let heading = Heading::of(&chart.title, &chart.captions, legend(chart), ty, w);
    let b = ty.base;
    let foot = (0.55 + CAPITAL + 0.75 + CAPITAL) * b;
    let fixed = heading.height() + 2.1 * b + foot + 0.8 * ty.margin();
    // One unit for both where they are to scale: that of the longer.
    let longer = usize::from(reach[1].1 - reach[1].0 > reach[0].1 - reach[0].0);
    let units = [0, 1].map(|k| if chart.to_scale { longer } else { k }).map(|k| {
        // Over many powers of ten no prefix fits better than none.
        let wide = chart.logarithmic[k] && (reach[k].1 / reach[k].0).log10() > MANY_DECADES;
        chart.axes[k].1.unit(if wide { (0.5, 5.0) } else { reach[k] })
    });
    let scaled = |k: usize| opened((reach[k].0 / units[k].size, reach[k].1 / units[k].size));
    let ranged = |k: usize| if chart.logarithmic[k] { decades(reach[k], units[k].size) } else { scaled(k) };
    let (mut across, mut up) = (ranged(0), ranged(1));
    let mut high = PAGE.1 - fixed;
    let rough = w - 2.0 * ty.margin() - 4.0 * b;
    if chart.to_scale {
        // In one unit and one scale; a panel that fits the data, within limits.
        let size = [units[0].size, units[1].size];
        let lengths = [(across.1 - across.0) * size[0], (up.1 - up.0) * size[1]];
        high = (rough * lengths[1] / lengths[0]).clamp(SHAPES.0 * rough, SHAPES.1 * rough);
    }
    let air = |(low, high): (f64, f64), length: f64| {
        let by = (high - low) * (0.8 * b / length).min(0.1);
        (low - by, high + by)
    };
    (across, up) = (air(across, rough), air(up, high));
    let most = (high / (2.3 * b)).clamp(3.0, 10.0) as usize;
    let y_axis =
        |up: (f64, f64)| if chart.logarithmic[1] { Axis::decades(up.0, up.1) } else { Axis::new(up.0, up.1, up, most) };
    let numbers = |axis: &Axis| axis.ticks().iter().map(|&t| width(&axis.text(t), b, false)).fold(0.0, f64::max);
    let left = ty.margin() + numbers(&y_axis(up)) * 1.04 + 0.55 * b;
    let panel = w - left - ty.margin();
    if chart.to_scale {
        let scale = [(across.1 - across.0) * units[0].size / panel, (up.1 - up.0) * units[1].size / high];
        let coarse = scale[0].max(scale[1]);
        let wider = |(low, high): (f64, f64), factor: f64, anchored: bool| {
            let more = (high - low) * (factor - 1.0);
            // Room is added above a ground, and evenly sideways.
            if anchored { (low, high + more) } else { (low - 0.5 * more, high + 0.5 * more) }
        };
        across = wider(across, coarse / scale[0], false);
        up = wider(up, coarse / scale[1], true);
    }
    let x = if chart.logarithmic[0] {
        Axis::decades(across.0, across.1)
    } else {
        Axis::new(across.0, across.1, across, 12)
    };
    let x = if chart.axes[0].1 == Measure::Count { x.whole() } else { x };
    // Only where something stands there.
    let least = chart.least.filter(|least| chart.logarithmic[0] && reach[0].0 <= *least);
    let least = least.map(|least| (least / units[0].size).log10());
    let x = x.thinned(panel, 1.6 * b, |text| width(text, b, false)).at_least(least);
    let y = y_axis(up);

    let h = (fixed + high).ceil();
    let canvas = Rc::new(RefCell::new(Canvas::new(w, h)));
    let root = Area::from(&canvas);
    if chart.background != Background::None {
        let paper = format!("M0 0H{}V{}H0Z", number(w, 2), number(h, 2));
        canvas.try_borrow_mut().map_err(|e| PlotError::Drawing(e.to_string()))?.area(&paper, Ink::Paper);
    }
    heading.draw(&root)?;
    let title = |k: usize| match units[k].label.as_str() {
        "" => chart.axes[k].0.clone(),
        unit => format!("{} ({unit})", chart.axes[k].0),
    };
    let top = heading.height() + 2.1 * b;
    let style = words(Ink::Muted, b, FontStyle::Normal, HPos::Left, VPos::Bottom);
    root.draw_text(&title(1), &style, (grains(ty.margin()), grains(top - 0.55 * b))).map_err(failed)?;
    let area = root.clone().shrink((0, grains(top)), (grains(w), grains(high + foot)));
    let mut panel = ChartBuilder::on(&area)
        .set_label_area_size(LabelAreaPosition::Left, grains(left))
        .margin_right(grains(ty.margin()))
        .set_label_area_size(LabelAreaPosition::Bottom, grains(foot))
        .build_cartesian_2d(x, y)
        .map_err(failed)?;
    mesh(&mut panel, ty, Some(&title(0)))?;
    let (x, y) = maps(&panel);
    let edges = ([x.at(across.0), x.at(across.1)], [y.at(up.1), y.at(up.0)]);
    let [x, y] = [(x, 0), (y, 1)].map(|(map, k)| if chart.logarithmic[k] { map } else { map.per_unit(units[k].size) });
    let sizes = [units[0].size, units[1].size];
    let place = Place { x, y, sizes, logarithmic: chart.logarithmic, least: chart.least };
    for (alpha, cells) in chart.map.iter().flat_map(|map| map.cells(&place)) {
        let mut canvas = canvas.try_borrow_mut().map_err(|e| PlotError::Drawing(e.to_string()))?;
        canvas.glaze(&cells, Ink::series(0), alpha);
    }
    for trace in traces(chart, &place, edges.1, ty) {
        panel.draw_series([trace]).map_err(failed)?;
    }
    for (data, ink, full) in discs(chart, x, y, ty) {
        let mut canvas = canvas.try_borrow_mut().map_err(|e| PlotError::Drawing(e.to_string()))?;
        canvas.glaze(&data, ink, if full { 1.0 } else { 0.35 });
    }
    panel.draw_series([EmptyElement::at((across.0, up.0))]).map_err(failed)?;
    callout::draw(chart, &place, edges, &root, ty)?;
    let description = described(chart, &units, reach);
    let sheet =
        Sheet { title: &chart.title, description: &description, adaptive: chart.background != Background::White };
    let svg = canvas.try_borrow_mut().map_err(|e| PlotError::Drawing(e.to_string()))?.document(sheet);
    Ok(svg)
}

fn legend(chart: &Chart) -> Vec<(Sign, String)> {
    let named = chart.lines.iter().enumerate().filter(|(_, (label, _))| !label.is_empty());
    let sign = |i: usize| {
        let dots = chart.dots.iter().filter(|(line, _)| *line == i).count();
        if dots > 0 {
            Sign::Dots(Ink::series(i), Dash::series(i), dots)
        } else {
            Sign::Line(Ink::series(i), Dash::series(i))
        }
    };
    let lines = named.map(|(i, (label, _))| (sign(i), label.clone()));
    let tones = chart.map.iter().flat_map(crate::map::Map::legend);
    tones.chain(lines).chain(chart.limits.iter().map(|(label, _)| (Sign::Limit, label.clone()))).collect()
}

/// A reach by powers of ten, in the unit.
fn decades((low, high): (f64, f64), size: f64) -> (f64, f64) {
    let (low, high) = ((low / size).log10(), (high / size).log10());
    if high - low < 0.3 { (low - 0.3, high + 0.3) } else { (low, high) }
}

/// Everything that is drawn with a pen, back to front, in a panel with these edges above and below.
fn traces(chart: &Chart, on: &Place, [top, bottom]: [f64; 2], ty: Type) -> Vec<Trace> {
    let &Place { x, y, .. } = on;
    let place = |point: [f64; 2]| on.at(point);
    let trace = |data: String, ink: Ink, width: f64, dash: Dash, alpha: f64| Trace { data, ink, width, dash, alpha };
    let mut traces = Vec::new();
    traces.push(trace(path(&chart.ground, x, y), Ink::Floor, 1.6 * ty.hairline(), Dash::Solid, 1.0));
    for (_, limit) in &chart.limits {
        let px = place([*limit, 0.0]).0;
        let data = format!("M{} {}V{}", number(px, 2), number(top, 2), number(bottom, 2));
        traces.push(trace(data, Ink::Text, ty.rule(), Dash::Dashed, 1.0));
    }
    let mut jumps = String::new();
    for &[from, to] in &chart.jumps {
        let ((ax, ay), (bx, by)) = (place(from), place(to));
        if (ax - bx).abs().max((ay - by).abs()) > 0.5 {
            jumps.push_str(&format!("M{} {}L{} {}", number(ax, 2), number(ay, 2), number(bx, 2), number(by, 2)));
        }
    }
    traces.push(trace(jumps, Ink::Muted, 0.9 * ty.hairline(), Dash::Dashed, 0.8));
    for (i, (_, strokes)) in chart.lines.iter().enumerate().rev() {
        let data = if chart.logarithmic.contains(&true) {
            let mut data = String::new();
            for (n, stroke) in strokes.iter().enumerate() {
                let ends = [stroke.at(0.0), stroke.at(stroke.span)].map(|(a, b)| place([a, b]));
                let [(ax, ay), (bx, by)] = ends;
                if n == 0 {
                    data.push_str(&format!("M{} {}", number(ax, 2), number(ay, 2)));
                }
                data.push_str(&format!("L{} {}", number(bx, 2), number(by, 2)));
            }
            data
        } else {
            path(strokes, x, y)
        };
        traces.push(trace(data, Ink::series(i), ty.line(), Dash::series(i), 1.0));
        let dots: String = chart.dots.iter().filter(|(line, _)| *line == i).map(|(_, at)| dot(place(*at))).collect();
        traces.push(trace(dots, Ink::series(i), 2.0 * ty.mark(), Dash::Solid, 1.0));
    }
    let mut heads = String::new();
    for &[at, towards] in &chart.arrows {
        let ((ax, ay), (bx, by)) = (place(at), place(towards));
        let length = (bx - ax).hypot(by - ay);
        if length < 1e-9 {
            continue;
        }
        let (ux, uy) = ((bx - ax) / length * ty.base * 0.55, (by - ay) / length * ty.base * 0.55);
        let (lx, ly) = (ax - ux - 0.5 * uy, ay - uy + 0.5 * ux);
        let (rx, ry) = (ax - ux + 0.5 * uy, ay - uy - 0.5 * ux);
        let [lx, ly, ax, ay, rx, ry] = [lx, ly, ax, ay, rx, ry].map(|v| number(v, 2));
        heads.push_str(&format!("M{lx} {ly}L{ax} {ay}L{rx} {ry}"));
    }
    traces.push(trace(heads, Ink::Text, ty.line(), Dash::Solid, 1.0));
    let dots = chart.marks.iter().map(|&mark| dot(place(mark))).collect();
    traces.push(trace(dots, Ink::Text, 1.6 * ty.mark(), Dash::Solid, 1.0));
    traces
}

/// A disc to scale whose radius would be less than this many widths of a line would be hidden by
/// the line through it.
const LEAST_DISC: f64 = 1.5;

/// Discs as paths, pale ones first.
fn discs(chart: &Chart, x: Affine, y: Affine, ty: Type) -> Vec<(String, Ink, bool)> {
    let mut discs: Vec<_> = chart.discs.clone();
    discs.sort_by_key(|(_, disc)| disc.full);
    let circle = |(line, disc): &(usize, crate::chart::Disc)| {
        let r = (disc.radius * x.scale.abs()).max(LEAST_DISC * ty.line());
        let (cx, cy) = (x.at(disc.at[0]), y.at(disc.at[1]));
        let [r2, x0, y0, d] = [r, cx - r, cy, 2.0 * r].map(|v| number(v, 2));
        (format!("M{x0} {y0}a{r2} {r2} 0 1 0 {d} 0a{r2} {r2} 0 1 0 -{d} 0Z"), Ink::series(*line), disc.full)
    };
    discs.iter().map(circle).collect()
}

/// The picture in a sentence, for those who cannot see it.
fn described(chart: &Chart, units: &[Unit; 2], reach: [(f64, f64); 2]) -> String {
    let short = |value: f64| crate::axis::typeset(&format!("{value:.3}"));
    let axis = |k: usize| {
        let Unit { size, label } = &units[k];
        let (low, high) = (reach[k].0 / size, reach[k].1 / size);
        format!("{} from {} to {} {label}", chart.axes[k].0, short(low), short(high)).trim_end().to_owned()
    };
    let mut text = format!("{} against {}.", axis(1), axis(0));
    let labels: Vec<_> = chart.lines.iter().map(|(label, _)| label.as_str()).filter(|l| !l.is_empty()).collect();
    if !labels.is_empty() {
        text.push_str(&format!(" Lines: {}.", labels.join("; ")));
    }
    for (label, at) in &chart.limits {
        let at = format!("{:.3e}", at / units[0].size);
        text.push_str(&format!(" Limit: {label}, at {at} {}.", units[0].label));
    }
    for (words, _) in &chart.callouts {
        text.push_str(&format!(" Marked: {words}."));
    }
    for caption in &chart.captions {
        text.push_str(&format!(" {caption}."));
    }
    text
}
