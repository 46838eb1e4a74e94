//! Which mode is when: a row for each mode at the foot of the panels.

use plotters::chart::{ChartBuilder, LabelAreaPosition};
use plotters::element::Rectangle;
use plotters::style::FontStyle;
use plotters_backend::text_anchor::{HPos, VPos};

use super::frame::Frame;
use crate::axis::Axis;
use crate::error::PlotError;
use crate::grain::grains;
use crate::panel::{Area, band, failed, maps, mesh};
use crate::theme::{CAPITAL, Ink, Type, room, words};
use crate::traced::Traced;

/// The most modes that have a lane.
const MOST_MODES: usize = 12;
/// The longest name that is written out, in letters.
const LETTERS: usize = 16;
/// Stays nearer to each other than this, in px, are drawn as one.
const ONE: f64 = 0.3;
/// A stay is drawn at least as long as this, in px: however short, it is visible.
const LEAST: f64 = 1.0;

/// The rows, before they are drawn.
#[derive(Debug)]
pub(super) struct Lane<'a> {
    modes: &'a [String],
    ty: Type,
}

impl<'a> Lane<'a> {
    /// None for one mode, or for very many.
    pub(super) fn of(modes: &'a [String], ty: Type) -> Option<Self> {
        (2..=MOST_MODES).contains(&modes.len()).then_some(Self { modes, ty })
    }

    fn row(&self) -> f64 {
        1.3 * self.ty.base
    }

    fn gap(&self) -> f64 {
        0.8 * self.ty.base
    }

    /// The height with the gap above it, in px.
    pub(super) fn height(&self) -> f64 {
        self.gap() + self.row() * self.modes.len() as f64
    }

    /// The room that the names take, in px.
    pub(super) fn words(&self) -> f64 {
        self.modes.iter().map(|mode| room(&short(mode), self.ty.base, false)).fold(0.0, f64::max)
    }

    /// Draws it from `top` on.
    pub(super) fn draw(
        &self,
        traced: &Traced,
        root: &Area,
        (top, w): (f64, f64),
        (frame, time_label): (&Frame, &str),
    ) -> Result<(), PlotError> {
        let (ty, b) = (self.ty, self.ty.base);
        let rows = self.row() * self.modes.len() as f64;
        let top = top + self.gap();
        let area = band(root, top, rows + frame.foot, w);
        let mut chart = ChartBuilder::on(&area)
            .set_label_area_size(LabelAreaPosition::Left, grains(frame.left))
            .margin_right(grains(frame.right))
            .set_label_area_size(LabelAreaPosition::Bottom, grains(frame.foot))
            .build_cartesian_2d(frame.time, Axis::bare(0.0, 1.0))
            .map_err(failed)?;
        mesh(&mut chart, ty, Some(time_label))?;
        let x = maps(&chart).0.per_unit(frame.second);
        let middle = |row: usize| top + (row as f64 + 0.5) * self.row();
        for (row, mode) in self.modes.iter().enumerate() {
            let style = words(Ink::Text, b, FontStyle::Normal, HPos::Right, VPos::Bottom);
            let baseline = middle(row) + 0.5 * CAPITAL * b;
            let at = (grains(frame.left - 0.55 * b), grains(baseline));
            root.draw_text(&short(mode), &style, at).map_err(failed)?;
            let half = 0.16 * b / rows;
            let at = 1.0 - (row as f64 + 0.5) / self.modes.len() as f64;
            let bar = |(from, to): (f64, f64)| {
                let more = 0.5 * (LEAST / x.scale.abs() - (to - from)).max(0.0);
                let (from, to) = (from - more, to + more);
                let corners = [(from / frame.second, at - half), (to / frame.second, at + half)];
                Rectangle::new(corners, Ink::Text.wash(0.7))
            };
            chart.draw_series(stays(traced, row, ONE / x.scale.abs()).into_iter().map(bar)).map_err(failed)?;
        }
        Ok(())
    }
}

/// The spans in which the mode is the run's; stays nearer to each other than `near` are one.
fn stays(traced: &Traced, mode: usize, near: f64) -> Vec<(f64, f64)> {
    let mut bars: Vec<(f64, f64)> = Vec::new();
    for stay in traced.stays.iter().filter(|stay| stay.mode == mode) {
        match bars.last_mut() {
            Some(last) if stay.from - last.1 < near => last.1 = stay.to,
            _ => bars.push((stay.from, stay.to)),
        }
    }
    bars
}

fn short(name: &str) -> String {
    if name.chars().count() <= LETTERS {
        return name.to_owned();
    }
    name.chars().take(LETTERS - 1).chain(['…']).collect()
}
