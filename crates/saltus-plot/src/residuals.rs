//! The panel of residuals: one standard error is one unit, whatever was measured.

use plotters::chart::ChartBuilder;
use plotters::element::{PathElement, Rectangle};

use crate::axis::Axis;
use crate::data::Residual;
use crate::error::PlotError;
use crate::marks::Spot;
use crate::panel::{Area, Frame, apart, failed, maps, mesh};
use crate::theme::{Ink, Type};

/// The number and the scatter of residuals: "5 residuals, rms 3.8 σ, 3 beyond ±2 σ".
pub(crate) fn summary(residuals: &[Residual]) -> String {
    let count = residuals.len();
    let noun = if count == 1 { "residual" } else { "residuals" };
    let largest = residuals.iter().fold(0.0, |most: f64, r| most.max(r.z.abs()));
    // Scaled by the largest, so that no square overflows.
    let scaled = |z: f64| if largest > 0.0 { z / largest } else { 0.0 };
    let mean = residuals.iter().map(|r| scaled(r.z).powi(2)).sum::<f64>() / count.max(1) as f64;
    let rms = largest * mean.sqrt();
    let digits = if rms < 0.095 { 2 } else { 1 };
    let rms = if rms < 1e5 { format!("{rms:.digits$}") } else { format!("{rms:.1e}") };
    let outside = residuals.iter().filter(|r| r.z.abs() > 2.0).count();
    let outside = match outside {
        0 => "all within ±2 σ".to_owned(),
        n if n == count => "all beyond ±2 σ".to_owned(),
        n => format!("{n} beyond ±2 σ"),
    };
    match count {
        1 => format!("1 {noun}, {rms} σ"),
        _ => format!("{count} {noun}, rms {rms} σ, {outside}"),
    }
}

/// The vertical axis: always room for ±2 σ, and for every residual.
pub(crate) fn axis(residuals: &[Residual], length: f64, ty: Type) -> Axis {
    let low = residuals.iter().fold(-2.0, |low: f64, r| low.min(r.z));
    let high = residuals.iter().fold(2.0, |high: f64, r| high.max(r.z));
    let pad = (high - low) * (0.75 * ty.base / length).min(0.2);
    let most = (length / (1.6 * ty.base)).clamp(3.0, 8.0);
    Axis::new(low - pad, high + pad, (low - pad, high + pad), most as usize)
}

/// Draws the panel into `area`.
pub(crate) fn draw(residuals: &[Residual], area: &Area, frame: &Frame, axis: Axis) -> Result<(), PlotError> {
    let ty = frame.ty;
    let mut chart = ChartBuilder::on(area)
        .set_label_area_size(plotters::chart::LabelAreaPosition::Left, frame.left)
        .margin_right(frame.right)
        .set_label_area_size(plotters::chart::LabelAreaPosition::Bottom, frame.foot)
        .build_cartesian_2d(frame.time, axis)
        .map_err(failed)?;
    let (t0, t1) = frame.time.ends();
    for (sigma, alpha) in [(2.0, 0.10), (1.0, 0.14)] {
        let band = Rectangle::new([(t0, -sigma), (t1, sigma)], Ink::Grid.wash(alpha));
        chart.draw_series([band]).map_err(failed)?;
    }
    mesh(&mut chart, ty, Some(&frame.time_label))?;
    let zero = PathElement::new(vec![(t0, 0.0), (t1, 0.0)], Ink::Floor.stroke(1.2 * ty.hairline()));
    chart.draw_series([zero]).map_err(failed)?;
    let unit = frame.second;
    // Stems lead the eye from a mark to zero; in a crowd they would only be in the way.
    let stems = if residuals.len() > 60 { &[] } else { residuals };
    chart
        .draw_series(stems.iter().map(|r| {
            let t = r.time / unit;
            PathElement::new(vec![(t, 0.0), (t, r.z)], Ink::Text.faint(1.1 * ty.hairline(), 0.55))
        }))
        .map_err(failed)?;
    let (x, y) = maps(&chart);
    let shown = apart(residuals, |r| (x.at(r.time / unit), y.at(r.z)), |r| r.mark);
    let (scale, alpha) = if residuals.len() > 60 { (0.85, 0.5) } else { (1.0, 1.0) };
    let radius = scale * ty.mark();
    chart
        .draw_series(shown.into_iter().map(|r| Spot { at: (r.time / unit, r.z), mark: r.mark, radius, alpha }))
        .map_err(failed)?;
    Ok(())
}
