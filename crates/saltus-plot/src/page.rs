//! The page: where the heading and the panels stand, and the panel of heights itself.

use std::cell::RefCell;
use std::rc::Rc;

use plotters::chart::{ChartBuilder, LabelAreaPosition};
use plotters::element::PathElement;
use plotters::style::FontStyle;
use plotters_backend::text_anchor::{HPos, VPos};

use crate::axis::Axis;
use crate::curve;
use crate::data::{Mark, Measured};
use crate::error::PlotError;
use crate::grain::grains;
use crate::heading::{Heading, Sign};
use crate::height_time::{Bounds, HeightTime};
use crate::marks::{Bars, Spot, Tick, Trace};
use crate::panel::{Area, Chart, Frame, apart, band, failed, maps, mesh};
use crate::residuals;
use crate::svg::{Canvas, Sheet, number};
use crate::theme::{Background, CAPITAL, Dash, Ink, Type, room, width, words};

/// Heights of the page's parts from top to bottom, in px.
#[derive(Debug, Clone, Copy)]
struct Parts {
    heading: f64,
    /// Label and panel of the sound, if any.
    wave: Option<(f64, f64)>,
    label: f64,
    main: f64,
    /// Gap, label and panel of the residuals, if any.
    residuals: Option<(f64, f64, f64)>,
    foot: f64,
}

impl Parts {
    /// Divides `height`; `None` if too little would be left for the panels.
    fn divide(picture: &HeightTime, heading: &Heading, ty: Type, page: (f64, f64), least: f64) -> Option<Self> {
        let b = ty.base;
        let label = 2.1 * b;
        let foot = (0.55 + CAPITAL + 0.75 + CAPITAL) * b;
        let margin = 0.8 * ty.margin();
        let rows = if residual_row_is_double(picture, ty, page.0) { 2.0 } else { 1.0 };
        let wave = picture.wave.as_ref().map(|_| (label, WAVE * b));
        let fixed = heading.height() + wave.map_or(0.0, |(label, panel)| label + panel) + label + foot + margin;
        if picture.residuals.is_empty() {
            let main = page.1 - fixed;
            let parts = Self { heading: heading.height(), wave, label, main, residuals: None, foot };
            (main >= least).then_some(parts)
        } else {
            let (gap, row) = (0.5 * b, (0.7 + 1.35 * rows) * b);
            let free = page.1 - fixed - gap - row;
            let below = (0.3 * free).max(5.0 * b);
            let main = free - below;
            let residuals = Some((gap, row, below));
            (main >= least).then_some(Self { heading: heading.height(), wave, label, main, residuals, foot })
        }
    }
}

/// The height of the panel of a sound, in sizes of the type.
const WAVE: f64 = 5.0;
const RESIDUAL_LABEL: &str = "Residual (σ)";

/// Whether the residuals' summary must stand below their label instead of beside it.
fn residual_row_is_double(picture: &HeightTime, ty: Type, page: f64) -> bool {
    let summary = residuals::summary(&picture.residuals);
    let both = room(RESIDUAL_LABEL, ty.base, false) + room(&summary, ty.base, false);
    both + ty.base > page - 2.0 * ty.margin()
}

impl HeightTime {
    /// The picture as an SVG document.
    ///
    /// # Errors
    ///
    /// [`PlotError::Empty`] when there is nothing to draw, [`PlotError::NotFinite`] and
    /// [`PlotError::Negative`] naming the number at fault, [`PlotError::Size`] when a side is
    /// shorter than 160 px or longer than 20 000 px.
    pub fn svg(&self) -> Result<String, PlotError> {
        let (width, height) = self.checked_size()?;
        let bounds = self.bounds()?;
        draw(self, &bounds, width, height)
    }
}

/// The whole picture.
fn draw(picture: &HeightTime, bounds: &Bounds, w: f64, h: f64) -> Result<String, PlotError> {
    let (ty, heading, parts, h) = compose(picture, w, h);
    let canvas = Rc::new(RefCell::new(Canvas::new(w, h)));
    let root = Area::from(&canvas);
    if picture.background != Background::None {
        let paper = format!("M0 0H{}V{}H0Z", number(w, 2), number(h, 2));
        canvas.try_borrow_mut().map_err(|e| PlotError::Drawing(e.to_string()))?.area(&paper, Ink::Paper);
    }
    heading.draw(&root)?;
    panels(picture, bounds, &root, (ty, parts), w)?;
    let description = picture.described(bounds);
    let adaptive = picture.background != Background::White;
    let sheet = Sheet { title: &picture.title, description: &description, adaptive };
    let svg = canvas.try_borrow_mut().map_err(|e| PlotError::Drawing(e.to_string()))?.document(sheet);
    Ok(svg)
}

/// Finds the largest type that leaves the panels their share; failing that, a taller page.
fn compose(picture: &HeightTime, w: f64, h: f64) -> (Type, Heading, Parts, f64) {
    let full = Type::for_size(w, h);
    let share = if picture.residuals.is_empty() { 0.42 } else { 0.33 };
    for factor in [1.0, 0.94, 0.88, 0.82, 0.76] {
        let ty = Type { base: full.base * factor };
        let heading = heading(picture, ty, w);
        if let Some(parts) = Parts::divide(picture, &heading, ty, (w, h), share * h) {
            return (ty, heading, parts, h);
        }
    }
    let ty = Type { base: 0.82 * full.base };
    let heading = heading(picture, ty, w);
    let mut taller = h;
    loop {
        taller += 2.0 * ty.base;
        if let Some(parts) = Parts::divide(picture, &heading, ty, (w, taller), share * h) {
            return (ty, heading, parts, taller.ceil());
        }
    }
}

/// The title, the captions and the legend.
fn heading(picture: &HeightTime, ty: Type, page: f64) -> Heading {
    let mut wanted: Vec<(Sign, String)> = Vec::new();
    for (i, motion) in picture.motions.iter().enumerate() {
        if !motion.label.is_empty() {
            wanted.push((Sign::Line(Ink::series(i), Dash::series(i)), motion.label.clone()));
        }
    }
    if !picture.contacts.is_empty() {
        let word = if picture.measured.is_empty() { "contact" } else { "model contact" };
        wanted.push((Sign::Contact, word.to_owned()));
    }
    let model = wanted.len();
    wanted.extend(measured(picture));
    Heading::divided(&picture.title, &picture.captions, (wanted, model), ty, page)
}

/// The legend of the marks: one kind is named in full, several share a first word.
fn measured(picture: &HeightTime) -> Vec<(Sign, String)> {
    let kinds: Vec<_> =
        Mark::ALL.into_iter().filter(|&mark| picture.measured.iter().any(|point| point.mark == mark)).collect();
    let barred = picture.measured.iter().any(|point| point.time_error > 0.0 || point.height_error > 0.0);
    let bars = if barred { " ±1 σ" } else { "" };
    match kinds[..] {
        [] => Vec::new(),
        [Mark::Sample] => vec![(Sign::Spot(Mark::Sample), format!("measured{bars}"))],
        [mark] => vec![(Sign::Spot(mark), format!("measured {}{bars}", mark.word()))],
        _ => {
            let first = (Sign::Nothing, format!("measured{bars}:"));
            let rest = kinds.iter().map(|&mark| (Sign::Spot(mark), mark.word().to_owned()));
            std::iter::once(first).chain(rest).collect()
        }
    }
}

fn panels(
    picture: &HeightTime,
    bounds: &Bounds,
    root: &Area,
    (ty, parts): (Type, Parts),
    w: f64,
) -> Result<(), PlotError> {
    let b = ty.base;
    let (height, sole) = height_axis(bounds, parts.main, ty, picture.is_flat());
    let below = parts.residuals.map(|(_, _, length)| residuals::axis(&picture.residuals, length, ty));
    let widest = |axis: &Axis| axis.ticks().iter().map(|&t| width(&axis.text(t), b, false)).fold(0.0, f64::max);
    let numbers = widest(&height).max(below.as_ref().map_or(0.0, widest));
    let left = ty.margin() + numbers * 1.04 + 0.55 * b;
    let right = ty.margin();
    let time = time_axis(bounds, w - left - right, ty);
    let frame = Frame {
        ty,
        time,
        time_label: format!("Time ({})", bounds.time_unit.label),
        second: bounds.time_unit.size,
        left: grains(left),
        right: grains(right),
        foot: grains(parts.foot),
    };

    let label = |text: &str, ink: Ink, h: HPos, x: f64, baseline: f64| {
        let style = words(ink, b, FontStyle::Normal, h, VPos::Bottom);
        root.draw_text(text, &style, (grains(x), grains(baseline))).map_err(failed)
    };
    let mut y = parts.heading + parts.label;
    if let (Some((row, panel)), Some(wave)) = (parts.wave, &picture.wave) {
        label("Sound", Ink::Muted, HPos::Left, ty.margin(), y - 0.55 * b)?;
        wave.draw(&picture.measured, &band(root, y, panel, w), &frame)?;
        y += panel + row;
    }
    label(&format!("Height ({})", bounds.height_unit.label), Ink::Muted, HPos::Left, ty.margin(), y - 0.55 * b)?;
    let foot = if parts.residuals.is_some() { 0.0 } else { parts.foot };
    let area = band(root, y, parts.main + foot, w);
    heights(picture, bounds, &area, &frame, (height, sole), foot > 0.0)?;
    y += parts.main;
    if let (Some((gap, row, length)), Some(axis)) = (parts.residuals, below) {
        y += gap + row;
        let summary = residuals::summary(&picture.residuals);
        if residual_row_is_double(picture, ty, w) {
            label(RESIDUAL_LABEL, Ink::Muted, HPos::Left, ty.margin(), y - 1.9 * b)?;
            label(&summary, Ink::Muted, HPos::Left, ty.margin(), y - 0.55 * b)?;
        } else {
            label(RESIDUAL_LABEL, Ink::Muted, HPos::Left, ty.margin(), y - 0.55 * b)?;
            label(&summary, Ink::Muted, HPos::Right, w - right, y - 0.55 * b)?;
        }
        let area = band(root, y, length + parts.foot, w);
        residuals::draw(&picture.residuals, &area, &frame, axis)?;
    }
    Ok(())
}

/// The time axis with a little air at both ends, and as many numbers as fit.
fn time_axis(bounds: &Bounds, length: f64, ty: Type) -> Axis {
    let size = bounds.time_unit.size;
    let (low, high) = (bounds.time.0 / size, bounds.time.1 / size);
    let air = (high - low) * (0.7 * ty.base / length).min(0.1);
    let ends = (low - air, high + air);
    Axis::new(ends.0, ends.1, (low, ends.1), 12).thinned(length, 1.6 * ty.base, |text| width(text, ty.base, false))
}

/// The height axis, over a floor that is `flat` at zero or not, and how far the panel reaches below
/// the floor, in px (zero when heights do).
fn height_axis(bounds: &Bounds, length: f64, ty: Type, flat: bool) -> (Axis, f64) {
    let size = bounds.height_unit.size;
    let (low, high) = (bounds.height.0 / size, bounds.height.1 / size);
    // Rounding leaves landings a hair below the floor.
    let floor_is_lowest = flat && low >= -2e-3 * (high - low);
    let sole = if floor_is_lowest { ty.sole() } else { 0.6 * ty.base };
    let head = 0.6 * ty.base;
    let scale = (high - low) / (length - sole - head).max(1.0);
    let most = (length / (2.3 * ty.base)).clamp(3.0, 10.0) as usize;
    let axis = Axis::new(low - sole * scale, high + head * scale, (low, high + head * scale), most);
    (axis, if floor_is_lowest { sole } else { 0.0 })
}

fn heights(
    picture: &HeightTime,
    bounds: &Bounds,
    area: &Area,
    frame: &Frame,
    (axis, sole): (Axis, f64),
    labelled: bool,
) -> Result<(), PlotError> {
    let ty = frame.ty;
    let mut chart = ChartBuilder::on(area)
        .set_label_area_size(LabelAreaPosition::Left, frame.left)
        .margin_right(frame.right)
        .set_label_area_size(LabelAreaPosition::Bottom, if labelled { frame.foot } else { 0 })
        .build_cartesian_2d(frame.time, axis)
        .map_err(failed)?;
    mesh(&mut chart, ty, Some(&frame.time_label))?;

    let (x, y) = maps(&chart);
    let (t0, t1) = frame.time.ends();
    if sole > 0.0 {
        let depth = 0.42 * sole;
        let mut hatch = String::new();
        let (from, to, floor) = (x.at(t0), x.at(t1), y.at(0.0));
        let count = ((to - from) / (0.62 * ty.base)).floor() as usize;
        let step = (to - from - depth) / count.max(1) as f64;
        for i in 0..=count {
            let x = from + depth + step * i as f64;
            let run = number(depth, 2);
            hatch.push_str(&format!("M{} {}l-{run} {run}", number(x, 2), number(floor, 2)));
        }
        chart
            .draw_series([Trace { data: hatch, ink: Ink::Grid, width: ty.hairline(), dash: Dash::Solid, alpha: 0.6 }])
            .map_err(failed)?;
    }
    let (x, y) = (x.per_unit(bounds.time_unit.size), y.per_unit(bounds.height_unit.size));
    if picture.is_flat() {
        let floor = PathElement::new(vec![(t0, 0.0), (t1, 0.0)], Ink::Floor.stroke(1.6 * ty.hairline()));
        chart.draw_series([floor]).map_err(failed)?;
    }
    let grounds = picture.grounds.iter().map(|ground| {
        let (data, width) = (curve::path(ground, x, y), 1.6 * ty.hairline());
        Trace { data, ink: Ink::Floor, width, dash: Dash::Solid, alpha: 1.0 }
    });
    chart.draw_series(grounds).map_err(failed)?;

    for (i, motion) in picture.motions.iter().enumerate().rev() {
        let data = curve::path(&motion.strokes, x, y);
        let trace = Trace { data, ink: Ink::series(i), width: ty.line(), dash: Dash::series(i), alpha: 1.0 };
        chart.draw_series([trace]).map_err(failed)?;
    }

    let mut contacts = picture.contacts.clone();
    contacts.sort_by(f64::total_cmp);
    contacts.dedup_by(|b, a| (x.at(*b) - x.at(*a)).abs() < 0.5);
    let ink = Ink::Series(0);
    let (length, width) = (0.8 * ty.sole(), 1.5 * ty.hairline());
    chart
        .draw_series(contacts.iter().map(|&t| {
            let at = (t / frame.second, picture.floor(t) / bounds.height_unit.size);
            Tick { at, length, width, ink }
        }))
        .map_err(failed)?;

    measurements(picture, bounds, &mut chart, ty, |p| (x.at(p.time), y.at(p.height)))
}

fn measurements(
    picture: &HeightTime,
    bounds: &Bounds,
    chart: &mut Chart<'_>,
    ty: Type,
    place: impl Fn(&Measured) -> (f64, f64),
) -> Result<(), PlotError> {
    // Crowded marks are smaller and let one another show through.
    let (scale, alpha) = match picture.measured.len() {
        0..=60 => (1.0, 1.0),
        61..=300 => (0.85, 0.5),
        _ => (0.7, 0.4),
    };
    let points = apart(&picture.measured, place, |p| p.mark);
    let (second, metre) = (bounds.time_unit.size, bounds.height_unit.size);
    let cap = 2.7 * ty.mark() * scale;
    let width = 1.4 * ty.hairline() * scale;
    chart.draw_series(points.iter().map(|p| Bars::new(p, second, metre, cap, width, alpha))).map_err(failed)?;
    let radius = ty.mark() * scale;
    chart
        .draw_series(points.iter().map(|p| Spot {
            at: (p.time / second, p.height / metre),
            mark: p.mark,
            radius,
            alpha,
        }))
        .map_err(failed)?;
    Ok(())
}
