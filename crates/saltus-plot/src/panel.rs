//! What every panel is drawn with: its area, its axes on the page, its grid, its marks.

use std::collections::BTreeSet;
use std::convert::Infallible;

use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind};
use plotters::style::FontStyle;
use plotters_backend::text_anchor::{HPos, VPos};

use crate::axis::Axis;
use crate::curve::Affine;
use crate::data::Mark;
use crate::error::PlotError;
use crate::grain::{GRAIN, grains};
use crate::svg::Canvas;
use crate::theme::{Ink, Type, words};

pub(crate) type Area = DrawingArea<Canvas, Shift>;
pub(crate) type Chart<'a> = ChartContext<'a, Canvas, Cartesian2d<Axis, Axis>>;

/// The most marks of which all are drawn; of more, those that would cover one another are left out.
const MANY: usize = 1500;

/// plotters' own failures; drawing on text cannot fail.
pub(crate) fn failed(error: DrawingAreaErrorKind<Infallible>) -> PlotError {
    PlotError::Drawing(error.to_string())
}

/// The layout that both panels share. Lengths are in grains.
#[derive(Debug)]
pub(crate) struct Frame {
    pub(crate) ty: Type,
    pub(crate) time: Axis,
    pub(crate) time_label: String,
    /// The size of the time axis' unit in seconds.
    pub(crate) second: f64,
    pub(crate) left: i32,
    pub(crate) right: i32,
    pub(crate) foot: i32,
}

/// The strip of the page from `top` px, `height` px high.
pub(crate) fn band(root: &Area, top: f64, height: f64, width: f64) -> Area {
    root.clone().shrink((0, grains(top)), (grains(width), grains(height)))
}

/// Grid and numbers; `time_label` only where the panel has room below for it.
pub(crate) fn mesh(chart: &mut Chart<'_>, ty: Type, time_label: Option<&str>) -> Result<(), PlotError> {
    let numbers = words(Ink::Text, ty.base, FontStyle::Normal, HPos::Left, VPos::Top);
    let titles = words(Ink::Muted, ty.base, FontStyle::Normal, HPos::Left, VPos::Top);
    let mut mesh = chart.configure_mesh();
    mesh.bold_line_style(Ink::Grid.faint(ty.hairline(), 0.26))
        .axis_style(Ink::Grid.faint(1.0, 0.0))
        .set_all_tick_mark_size(grains(0.275 * ty.base))
        .label_style(numbers)
        .axis_desc_style(titles);
    if let Some(text) = time_label {
        mesh.x_desc(text);
    }
    mesh.draw().map_err(failed)
}

/// The maps of a chart's axes to px, without plotters' rounding.
pub(crate) fn maps(chart: &Chart<'_>) -> (Affine, Affine) {
    let px = |grain: i32| f64::from(grain) / GRAIN;
    let area = chart.plotting_area();
    let (across, down) = (area.get_x_axis_pixel_range(), area.get_y_axis_pixel_range());
    let (time, height) = (area.as_coord_spec().x_spec(), area.as_coord_spec().y_spec());
    (time.onto(px(across.start), px(across.end)), height.onto(px(down.end), px(down.start)))
}

/// All of `points`, or when there are very many, one for each small square of the page.
pub(crate) fn apart<P>(points: &[P], place: impl Fn(&P) -> (f64, f64), mark: impl Fn(&P) -> Mark) -> Vec<&P> {
    if points.len() <= MANY {
        return points.iter().collect();
    }
    let mut seen = BTreeSet::new();
    let square = |px: f64| (0.5 * px).round() as i64;
    points
        .iter()
        .filter(|p| {
            let (x, y) = place(p);
            seen.insert((square(x), square(y), mark(p)))
        })
        .collect()
}
