//! Elements that plotters does not have: curves, marks, error bars, ticks on the floor.

use std::convert::Infallible;
use std::iter::{Empty, Once, empty, once};

use plotters::element::{Drawable, PointCollection};
use plotters_backend::{BackendCoord, DrawingBackend, DrawingErrorKind};

use crate::data::{Mark, Measured};
use crate::grain::grains;
use crate::svg::{Canvas, number};
use crate::theme::{Dash, Ink, Type};

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// A ready-made path in px. It has no points of its own: plotters would pull a control point
/// outside the panel back in.
#[derive(Debug)]
pub(crate) struct Trace {
    pub(crate) data: String,
    pub(crate) ink: Ink,
    pub(crate) width: f64,
    pub(crate) dash: Dash,
    pub(crate) alpha: f64,
}

/// The upright lines of jumps.
pub(crate) fn event(data: String, ty: Type) -> Trace {
    Trace { data, ink: Ink::Muted, width: 0.8 * ty.hairline(), dash: Dash::Solid, alpha: 0.4 }
}

impl<'a, C: 'a> PointCollection<'a, C> for &'a Trace {
    type Point = &'a C;
    type IntoIter = Empty<&'a C>;

    fn point_iter(self) -> Self::IntoIter {
        empty()
    }
}

impl Drawable<Canvas> for Trace {
    fn draw<I: Iterator<Item = BackendCoord>>(&self, _: I, canvas: &mut Canvas, _: (u32, u32)) -> Drawn {
        canvas.curve(&self.data, self.ink, self.width, self.dash, self.alpha);
        Ok(())
    }
}

/// The mark of a measurement, `radius` px from its middle to its edge.
#[derive(Debug)]
pub(crate) struct Spot<C> {
    pub(crate) at: C,
    pub(crate) mark: Mark,
    pub(crate) radius: f64,
    pub(crate) alpha: f64,
}

impl<'a, C: 'a> PointCollection<'a, C> for &'a Spot<C> {
    type Point = &'a C;
    type IntoIter = Once<&'a C>;

    fn point_iter(self) -> Self::IntoIter {
        once(&self.at)
    }
}

impl<C> Drawable<Canvas> for Spot<C> {
    fn draw<I: Iterator<Item = BackendCoord>>(&self, points: I, canvas: &mut Canvas, _: (u32, u32)) -> Drawn {
        let style = Ink::Text.wash(self.alpha);
        for (x, y) in points {
            match self.mark {
                Mark::Apex => canvas.draw_circle((x, y), grains(self.radius).unsigned_abs(), &style, true)?,
                Mark::Sample => canvas.draw_circle((x, y), grains(0.6 * self.radius).unsigned_abs(), &style, true)?,
                Mark::Contact => {
                    let r = grains(1.22 * self.radius);
                    canvas.fill_polygon([(x, y - r), (x + r, y), (x, y + r), (x - r, y)], &style)?;
                }
                Mark::Release => {
                    let r = grains(0.88 * self.radius);
                    canvas.draw_rect((x - r, y - r), (x + r, y + r), &style, true)?;
                }
            }
        }
        Ok(())
    }
}

/// The error bars of a measurement, with caps `cap` px long.
#[derive(Debug)]
pub(crate) struct Bars {
    ends: Vec<(f64, f64)>,
    cap: f64,
    width: f64,
    alpha: f64,
}

impl Bars {
    /// Bars of one standard error either way; `time` and `height` are the sizes of the axes' units.
    pub(crate) fn new(point: &Measured, time: f64, height: f64, cap: f64, width: f64, alpha: f64) -> Self {
        let (t, h) = (point.time, point.height);
        let mut ends = Vec::new();
        if point.time_error > 0.0 {
            ends.extend([(t - point.time_error, h), (t + point.time_error, h)]);
        }
        if point.height_error > 0.0 {
            ends.extend([(t, h - point.height_error), (t, h + point.height_error)]);
        }
        for end in &mut ends {
            *end = (end.0 / time, end.1 / height);
        }
        // Caps on both bars would draw a box around the mark.
        let cap = if ends.len() > 2 { 0.0 } else { cap };
        Self { ends, cap, width, alpha }
    }
}

impl<'a> PointCollection<'a, (f64, f64)> for &'a Bars {
    type Point = &'a (f64, f64);
    type IntoIter = std::slice::Iter<'a, (f64, f64)>;

    fn point_iter(self) -> Self::IntoIter {
        self.ends.iter()
    }
}

impl Drawable<Canvas> for Bars {
    fn draw<I: Iterator<Item = BackendCoord>>(&self, points: I, canvas: &mut Canvas, _: (u32, u32)) -> Drawn {
        let style = Ink::Text.faint(self.width, self.alpha);
        let half = grains(0.5 * self.cap);
        let ends: Vec<_> = points.collect();
        for pair in ends.chunks_exact(2) {
            let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
            let across = y0 == y1 && x0 != x1;
            canvas.draw_line((x0, y0), (x1, y1), &style)?;
            for (x, y) in [(x0, y0), (x1, y1)].into_iter().filter(|_| half > 0) {
                if across {
                    canvas.draw_line((x, y - half), (x, y + half), &style)?;
                } else {
                    canvas.draw_line((x - half, y), (x + half, y), &style)?;
                }
            }
        }
        Ok(())
    }
}

/// A stroke from a point straight down, `length` px long.
#[derive(Debug)]
pub(crate) struct Tick<C> {
    pub(crate) at: C,
    pub(crate) length: f64,
    pub(crate) width: f64,
    pub(crate) ink: Ink,
}

impl<'a, C: 'a> PointCollection<'a, C> for &'a Tick<C> {
    type Point = &'a C;
    type IntoIter = Once<&'a C>;

    fn point_iter(self) -> Self::IntoIter {
        once(&self.at)
    }
}

impl<C> Drawable<Canvas> for Tick<C> {
    fn draw<I: Iterator<Item = BackendCoord>>(&self, points: I, canvas: &mut Canvas, _: (u32, u32)) -> Drawn {
        let style = self.ink.stroke(self.width);
        for (x, y) in points {
            canvas.draw_line((x, y), (x, y + grains(self.length)), &style)?;
        }
        Ok(())
    }
}

/// A stroke of no length with round caps is a dot.
pub(crate) fn dot((x, y): (f64, f64)) -> String {
    format!("M{} {}h0", number(x, 2), number(y, 2))
}
