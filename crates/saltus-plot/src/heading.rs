//! What stands above the panels: the title, the captions, the legend.

use plotters::element::Rectangle;
use plotters::style::FontStyle;
use plotters_backend::text_anchor::{HPos, VPos};

use crate::data::Mark;
use crate::error::PlotError;
use crate::grain::grains;
use crate::marks::{Spot, Tick, Trace, dot};
use crate::panel::{Area, failed};
use crate::svg::number;
use crate::theme::{CAPITAL, Dash, Ink, Type, room, words, wrapped};

/// The sign of a legend entry, before its words.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Sign {
    Line(Ink, Dash),
    /// A line with dots on it; of a single dot there is no line.
    Dots(Ink, Dash, usize),
    /// An upright line.
    Limit,
    /// An upright line, thin: a jump.
    Jump,
    Spot(Mark),
    Contact,
    /// A patch of a map, so opaque.
    Tone(f64),
    /// Words alone: what the marks after them have in common.
    Nothing,
}

impl Sign {
    fn width(self, ty: Type) -> f64 {
        match self {
            Self::Dots(_, _, 1) => 0.7 * ty.base,
            Self::Line(..) | Self::Dots(..) => 2.2 * ty.base,
            Self::Spot(_) => 0.7 * ty.base,
            Self::Contact | Self::Limit | Self::Jump => 0.5 * ty.base,
            Self::Tone(_) => 1.3 * ty.base,
            Self::Nothing => 0.0,
        }
    }

    /// The distance from the sign to its words.
    fn lead(self, ty: Type) -> f64 {
        match self {
            Self::Nothing => 0.0,
            Self::Line(..) | Self::Dots(..) => self.width(ty) + 0.55 * ty.base,
            Self::Spot(_) | Self::Contact | Self::Limit | Self::Jump | Self::Tone(_) => self.width(ty) + 0.38 * ty.base,
        }
    }

    /// The distance from the words to the next sign.
    fn gap(self, ty: Type) -> f64 {
        match self {
            Self::Nothing => 0.4 * ty.base,
            Self::Line(..) | Self::Dots(..) => ty.base,
            Self::Spot(_) | Self::Contact | Self::Limit | Self::Jump | Self::Tone(_) => 0.9 * ty.base,
        }
    }
}

#[derive(Debug, Clone)]
struct Entry {
    sign: Sign,
    lines: Vec<String>,
    x: f64,
    row: usize,
}

/// Signs with words, in rows.
#[derive(Debug, Clone)]
pub(crate) struct Legend {
    ty: Type,
    entries: Vec<Entry>,
    rows: usize,
}

impl Legend {
    /// Rows no wider than `inside` px.
    pub(crate) fn of(wanted: Vec<(Sign, String)>, ty: Type, inside: f64) -> Self {
        let all = wanted.len();
        Self::divided((wanted, all), ty, inside)
    }

    /// Signs and words; the first `model` of them are of the model, the others of measurements.
    fn divided((wanted, model): (Vec<(Sign, String)>, usize), ty: Type, inside: f64) -> Self {
        let mut legend = Self { ty, entries: Vec::new(), rows: 0 };
        let full: f64 =
            wanted.iter().map(|(sign, text)| sign.lead(ty) + room(text, ty.base, false) + sign.gap(ty)).sum();
        let mut x = 0.0;
        let mut row = 0;
        for (i, (sign, label)) in wanted.into_iter().enumerate() {
            // In one row if all of it fits, else the model above the measurements.
            if i == model && x > 0.0 && full > inside + ty.base {
                row += 1;
                x = 0.0;
            }
            let lead = sign.lead(ty);
            let lines = wrapped(&label, ty.base, false, inside - lead);
            let broad = lead + lines.iter().map(|line| room(line, ty.base, false)).fold(0.0, f64::max);
            if x > 0.0 && (x + broad > inside || lines.len() > 1) {
                row += 1;
                x = 0.0;
            }
            let deep = lines.len().max(1);
            legend.rows = legend.rows.max(row + deep);
            legend.entries.push(Entry { sign, lines, x, row });
            x += broad + sign.gap(ty);
            if deep > 1 {
                row += deep;
                x = 0.0;
            }
        }
        legend
    }

    /// The type it is set in.
    pub(crate) const fn ty(&self) -> Type {
        self.ty
    }

    /// The height in px.
    pub(crate) fn height(&self) -> f64 {
        self.rows as f64 * 1.45 * self.ty.base
    }

    /// Draws it from `left` and `top` on.
    pub(crate) fn draw(&self, area: &Area, left: f64, top: f64) -> Result<(), PlotError> {
        let b = self.ty.base;
        // All signs first, then all words: neighbours with one pen share a group.
        for entry in &self.entries {
            let middle = top + entry.row as f64 * 1.45 * b + b - 0.5 * CAPITAL * b;
            sign(area, entry.sign, (left + entry.x, middle), self.ty)?;
        }
        for entry in &self.entries {
            for (i, line) in entry.lines.iter().enumerate() {
                let baseline = top + (entry.row + i) as f64 * 1.45 * b + b;
                let x = left + entry.x + entry.sign.lead(self.ty);
                let ink = if entry.sign == Sign::Nothing { Ink::Muted } else { Ink::Text };
                let style = words(ink, b, FontStyle::Normal, HPos::Left, VPos::Bottom);
                area.draw_text(line, &style, (grains(x), grains(baseline))).map_err(failed)?;
            }
        }
        Ok(())
    }
}

/// Everything above the panels, broken into lines for one type size and page width.
#[derive(Debug, Clone)]
pub(crate) struct Heading {
    ty: Type,
    title: Vec<String>,
    captions: Vec<String>,
    legend: Legend,
}

impl Heading {
    /// The heading of a title, lines under it, and the signs and words of a legend.
    pub(crate) fn of(title: &str, captions: &[String], legend: Vec<(Sign, String)>, ty: Type, page: f64) -> Self {
        let all = legend.len();
        Self::divided(title, captions, (legend, all), ty, page)
    }

    /// The heading with so many first signs of the model, and the others of measurements.
    pub(crate) fn divided(
        title: &str,
        captions: &[String],
        legend: (Vec<(Sign, String)>, usize),
        ty: Type,
        page: f64,
    ) -> Self {
        let inside = page - 2.0 * ty.margin();
        let title = wrapped(title, ty.title(), true, inside);
        let captions = captions.iter().flat_map(|c| wrapped(c, ty.base, false, inside)).collect();
        Self { ty, title, captions, legend: Legend::divided(legend, ty, inside) }
    }

    /// The height from the top of the page to the bottom of the last line, in px.
    pub(crate) fn height(&self) -> f64 {
        let b = self.ty.base;
        let mut y = 0.9 * self.ty.margin();
        if !self.title.is_empty() {
            y += self.title.len() as f64 * 1.25 * self.ty.title();
        }
        if !self.captions.is_empty() {
            y += 0.15 * b + self.captions.len() as f64 * 1.4 * b;
        }
        if self.legend.rows > 0 {
            y += 0.75 * b + self.legend.height();
        }
        y
    }

    pub(crate) fn draw(&self, area: &Area) -> Result<(), PlotError> {
        let ty = self.ty;
        let b = ty.base;
        let left = ty.margin();
        let mut y = 0.9 * ty.margin();
        let text = |line: &str, ink: Ink, size: f64, weight: FontStyle, baseline: f64| {
            let style = words(ink, size, weight, HPos::Left, VPos::Bottom);
            area.draw_text(line, &style, (grains(left), grains(baseline))).map_err(failed)
        };
        for line in &self.title {
            text(line, Ink::Text, ty.title(), FontStyle::Bold, y + 0.8 * ty.title())?;
            y += 1.25 * ty.title();
        }
        if !self.captions.is_empty() {
            y += 0.15 * b;
        }
        for line in &self.captions {
            text(line, Ink::Muted, b, FontStyle::Normal, y + b)?;
            y += 1.4 * b;
        }
        self.legend.draw(area, left, y + 0.75 * b)
    }
}

/// Draws the sign of an entry from `x` on, its middle at `y`.
fn sign(area: &Area, sign: Sign, (x, y): (f64, f64), ty: Type) -> Result<(), PlotError> {
    let broad = sign.width(ty);
    let upright =
        |x: f64, half: f64| format!("M{} {}V{}", number(x + 0.5 * broad, 2), number(y - half, 2), number(y + half, 2));
    match sign {
        Sign::Nothing => Ok(()),
        Sign::Line(ink, dash) => {
            let data = format!("M{} {}H{}", number(x, 2), number(y, 2), number(x + broad, 2));
            area.draw(&Trace { data, ink, width: ty.line(), dash, alpha: 1.0 }).map_err(failed)
        }
        Sign::Dots(ink, dash, dots) => {
            if dots > 1 {
                self::sign(area, Sign::Line(ink, dash), (x, y), ty)?;
            }
            let data = dot((x + 0.5 * broad, y));
            area.draw(&Trace { data, ink, width: 2.0 * ty.mark(), dash: Dash::Solid, alpha: 1.0 }).map_err(failed)
        }
        Sign::Limit => {
            let data = upright(x, 0.5 * ty.base);
            area.draw(&Trace { data, ink: Ink::Text, width: ty.rule(), dash: Dash::Dashed, alpha: 1.0 }).map_err(failed)
        }
        Sign::Tone(alpha) => {
            let half = 0.5 * CAPITAL * ty.base;
            let corners = [(grains(x), grains(y - half)), (grains(x + broad), grains(y + half))];
            area.draw(&Rectangle::new(corners, Ink::series(0).wash(alpha))).map_err(failed)
        }
        Sign::Jump => area.draw(&crate::marks::event(upright(x, 0.5 * ty.base), ty)).map_err(failed),
        Sign::Spot(mark) => {
            let at = (grains(x + 0.5 * broad), grains(y));
            area.draw(&Spot { at, mark, radius: ty.mark(), alpha: 1.0 }).map_err(failed)
        }
        Sign::Contact => {
            let length = 0.7 * ty.sole();
            let at = (grains(x + 0.5 * broad), grains(y - 0.5 * length));
            let tick = Tick { at, length, width: 1.5 * ty.hairline(), ink: Ink::Series(0) };
            area.draw(&tick).map_err(failed)
        }
    }
}
