//! The panel of a sound: how loud it is, to both sides of silence, and the contacts read off it.

use plotters::chart::ChartBuilder;

use crate::axis::Axis;
use crate::data::{Mark, Measured};
use crate::error::PlotError;
use crate::marks::Trace;
use crate::panel::{Area, Frame, failed, maps, mesh};
use crate::svg::number;
use crate::theme::{Dash, Ink};

/// A sound as the lowest and the highest sample of stretches of equal length.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wave {
    /// The start of the first stretch, s.
    pub(crate) start: f64,
    /// The duration of a stretch, s.
    pub(crate) step: f64,
    pub(crate) stretches: Vec<[f32; 2]>,
}

impl Wave {
    /// Draws it into `area`, with an upright line for each contact that was measured.
    pub(crate) fn draw(&self, measured: &[Measured], area: &Area, frame: &Frame) -> Result<(), PlotError> {
        let ty = frame.ty;
        let largest = self.stretches.iter().flatten().fold(f32::MIN_POSITIVE, |most, x| most.max(x.abs()));
        let mut chart = ChartBuilder::on(area)
            .set_label_area_size(plotters::chart::LabelAreaPosition::Left, frame.left)
            .margin_right(frame.right)
            .build_cartesian_2d(frame.time, Axis::bare(-1.0, 1.0))
            .map_err(failed)?;
        mesh(&mut chart, ty, None)?;
        let (x, y) = maps(&chart);
        let (from, to) = frame.time.ends();
        let upright = |t: f64, low: f64, high: f64| {
            let [x, low, high] = [x.at(t), y.at(low), y.at(high)].map(|place| number(place, 2));
            format!("M{x} {low}V{high}")
        };
        let within = |t: &f64| (from..=to).contains(t);
        let columns = self.columns(frame.second, |t| x.at(t)).into_iter().filter(|(t, _)| within(t));
        let data = columns.map(|(t, [low, high])| upright(t, low / f64::from(largest), high / f64::from(largest)));
        let sound = Trace { data: data.collect(), ink: Ink::Text, width: 1.0, dash: Dash::Solid, alpha: 0.7 };
        let contacts =
            measured.iter().filter(|point| point.mark == Mark::Contact).map(|point| point.time / frame.second);
        let lines = contacts.filter(within).map(|t| upright(t, -1.0, 1.0)).collect();
        let width = ty.hairline();
        let lines = Trace { data: lines, ink: Ink::Series(0), width, dash: Dash::Solid, alpha: 0.5 };
        chart.draw_series([lines, sound]).map_err(failed)?;
        Ok(())
    }

    /// The lowest and the highest sample of each px, at the time of its first stretch in the unit
    /// of the axis.
    fn columns(&self, second: f64, x: impl Fn(f64) -> f64) -> Vec<(f64, [f64; 2])> {
        let mut columns: Vec<(f64, [f64; 2])> = Vec::new();
        for (k, &[low, high]) in self.stretches.iter().enumerate() {
            let t = (self.start + self.step * k as f64) / second;
            let [low, high] = [low.into(), high.into()];
            match columns.last_mut() {
                Some((first, column)) if x(t).floor() == x(*first).floor() => {
                    *column = [column[0].min(low), column[1].max(high)];
                }
                _ => columns.push((t, [low, high])),
            }
        }
        columns
    }
}
