//! A drawing backend for plotters that writes SVG and keeps fractions of a pixel.
//!
//! plotters places everything on whole numbers. Here those numbers are *grains*, hundredths of a
//! px: plotters sees a very large sheet, and what it draws is divided back as it is written.
//! Neighbouring elements that share a pen become one group, and neighbouring strokes or areas in it
//! one path, which keeps files small.

use std::collections::BTreeSet;
use std::convert::Infallible;
use std::fmt::Write;

use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontStyle,
    FontTransform,
};

use crate::grain::{GRAIN, grains};
use crate::theme::{self, Dash, Ink};

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// A number with at most `decimals` decimals and nothing superfluous; never `-0`, never `NaN`.
pub(crate) fn number(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", if value.is_finite() { value } else { 0.0 });
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    match text {
        "-0" => "0".to_owned(),
        text => match text.strip_prefix("0.") {
            Some(fraction) => format!(".{fraction}"),
            None => match text.strip_prefix("-0.") {
                Some(fraction) => format!("-.{fraction}"),
                None => text.to_owned(),
            },
        },
    }
}

/// Text that is safe in an element or an attribute; characters XML cannot hold become U+FFFD.
pub(crate) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\t' | '\n' | '\r' => safe.push(' '),
            '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// The attributes that neighbouring elements must share to stand in one group.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pen {
    ink: Option<Ink>,
    color: (u8, u8, u8),
    alpha: f64,
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// Strokes so many px wide.
    Stroke(f64, Dash),
    Fill,
    /// Words so many px large.
    Words(f64, bool),
}

impl Pen {
    fn new(color: BackendColor, kind: Kind) -> Self {
        Self { ink: Ink::of(color), color: color.rgb, alpha: color.alpha, kind }
    }
}

/// The sheet that plotters draws on.
#[derive(Debug)]
pub(crate) struct Canvas {
    width: f64,
    height: f64,
    body: String,
    pen: Option<Pen>,
    /// Path data not yet written, all of one pen.
    pending: String,
    used: BTreeSet<(Ink, bool)>,
}

/// The title, the description and the background of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sheet<'a> {
    pub(crate) title: &'a str,
    pub(crate) description: &'a str,
    /// Whether dark surroundings change the colours.
    pub(crate) adaptive: bool,
}

impl Canvas {
    pub(crate) fn new(width: f64, height: f64) -> Self {
        Self { width, height, body: String::new(), pen: None, pending: String::new(), used: BTreeSet::new() }
    }

    /// A ready-made path in px: a curve that plotters has no element for.
    pub(crate) fn curve(&mut self, data: &str, ink: Ink, width: f64, dash: Dash, alpha: f64) {
        if data.is_empty() {
            return;
        }
        let color = BackendColor { alpha, rgb: ink.light() };
        self.path(Pen::new(color, Kind::Stroke(width, dash)), data);
    }

    /// An area bounded by ready-made path data in px.
    pub(crate) fn area(&mut self, data: &str, ink: Ink) {
        let color = BackendColor { alpha: 1.0, rgb: ink.light() };
        self.path(Pen::new(color, Kind::Fill), data);
    }

    /// An area through which the elements below show.
    pub(crate) fn glaze(&mut self, data: &str, ink: Ink, alpha: f64) {
        self.path(Pen::new(BackendColor { alpha, rgb: ink.light() }, Kind::Fill), data);
    }

    fn path(&mut self, pen: Pen, data: &str) {
        if pen.alpha == 0.0 {
            return;
        }
        self.take(pen);
        self.pending.push_str(data);
        // A dash pattern runs on from one subpath to the next in some renderers, and dashed curves
        // are whole anyway.
        let dashed = matches!(pen.kind, Kind::Stroke(_, dash) if dash != Dash::Solid);
        // Areas that show through one another must not melt into one.
        let glazed = pen.kind == Kind::Fill && pen.alpha < 1.0;
        if dashed || glazed {
            self.flush();
        }
    }

    fn flush(&mut self) {
        if !self.pending.is_empty() {
            let _ = write!(self.body, "<path d=\"{}\"/>", self.pending);
            self.pending.clear();
        }
    }

    fn close(&mut self) {
        self.flush();
        if self.pen.take().is_some() {
            self.body.push_str("</g>\n");
        }
    }

    /// Go on with `pen`, closing the group of another.
    fn take(&mut self, pen: Pen) {
        if self.pen == Some(pen) {
            return;
        }
        self.close();
        self.pen = Some(pen);
        let (r, g, b) = pen.color;
        let color = format!("#{r:02x}{g:02x}{b:02x}");
        let paint = if matches!(pen.kind, Kind::Stroke(..)) { "stroke" } else { "fill" };
        self.body.push_str("<g");
        if let Some(ink) = pen.ink {
            let stroked = paint == "stroke";
            self.used.insert((ink, stroked));
            let _ = write!(self.body, " class=\"{} {}\"", ink.class(), if stroked { "s" } else { "f" });
        }
        let _ = write!(self.body, " {paint}=\"{color}\"");
        if pen.alpha < 1.0 {
            let _ = write!(self.body, " {paint}-opacity=\"{}\"", number(pen.alpha, 3));
        }
        match pen.kind {
            Kind::Stroke(width, dash) => {
                let _ = write!(self.body, " stroke-width=\"{}\"", number(width, 2));
                if dash != Dash::Solid {
                    let lengths: Vec<_> = dash.lengths().iter().map(|part| number(part * width, 2)).collect();
                    let _ = write!(self.body, " stroke-dasharray=\"{}\"", lengths.join(" "));
                }
            }
            Kind::Fill => {}
            Kind::Words(size, bold) => {
                let _ = write!(self.body, " font-size=\"{}\"", number(size, 2));
                if bold {
                    self.body.push_str(" font-weight=\"600\"");
                }
            }
        }
        self.body.push('>');
    }

    /// The finished document.
    pub(crate) fn document(&mut self, sheet: Sheet<'_>) -> String {
        self.close();
        let (w, h) = (number(self.width, 2), number(self.height, 2));
        let (title, description) = (escaped(sheet.title), escaped(sheet.description));
        // Pictures in one HTML page share one space of names; the fingerprint keeps them apart.
        let id = format!("saltus-{:08x}", fingerprint(&[&title, &description, &self.body]));
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"{id}\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" \
             role=\"img\" aria-labelledby=\"{id}-title {id}-desc\" font-family=\"{}\" fill=\"none\" \
             stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<title id=\"{id}-title\">{title}</title>\n\
             <desc id=\"{id}-desc\">{description}</desc>\n",
            theme::FAMILY
        );
        // The scaling stylesheet rule lets the picture shrink with a narrow page; attributes alone
        // carry every colour.
        let _ = write!(svg, "<style>#{id}{{max-width:100%;height:auto;font-variant-numeric:tabular-nums");
        if sheet.adaptive {
            svg.push_str(";color-scheme:light dark}@media (prefers-color-scheme:dark){");
            for &(ink, stroked) in &self.used {
                let (r, g, b) = ink.dark();
                let (class, paint) = if stroked { ("s", "stroke") } else { ("f", "fill") };
                let _ = write!(svg, "#{id} .{}.{class}{{{paint}:#{r:02x}{g:02x}{b:02x}}}", ink.class());
            }
        }
        svg.push_str("}</style>\n");
        svg.push_str(&self.body);
        svg.push_str("</svg>\n");
        svg
    }
}

/// FNV-1a, 32 bits: the same on every machine and in every release.
fn fingerprint(parts: &[&str]) -> u32 {
    parts
        .iter()
        .flat_map(|part| part.bytes())
        .fold(0x811c_9dc5, |hash: u32, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

/// Grains to px, written out.
fn px(grain: i32) -> String {
    number(f64::from(grain) / GRAIN, 2)
}

fn stroke<S: BackendStyle>(style: &S) -> Pen {
    let width = f64::from(style.stroke_width()) / GRAIN;
    Pen::new(style.color(), Kind::Stroke(width, Dash::Solid))
}

fn fill<S: BackendStyle>(style: &S) -> Pen {
    Pen::new(style.color(), Kind::Fill)
}

/// `M` and then the shortest command to each next point.
fn polyline(points: impl IntoIterator<Item = BackendCoord>) -> String {
    let mut data = String::new();
    let mut at: Option<BackendCoord> = None;
    for (x, y) in points {
        let _ = match at {
            None => write!(data, "M{} {}", px(x), px(y)),
            Some((_, before)) if before == y => write!(data, "H{}", px(x)),
            Some((before, _)) if before == x => write!(data, "V{}", px(y)),
            Some(_) => write!(data, "L{} {}", px(x), px(y)),
        };
        at = Some((x, y));
    }
    data
}

impl DrawingBackend for Canvas {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (grains(self.width).unsigned_abs(), grains(self.height).unsigned_abs())
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        self.draw_rect((x, y), (x + 1, y + 1), &color, true)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn {
        self.path(stroke(style), &polyline([from, to]));
        Ok(())
    }

    fn draw_rect<S: BackendStyle>(&mut self, a: BackendCoord, b: BackendCoord, style: &S, filled: bool) -> Drawn {
        let data = format!("M{} {}H{}V{}H{}Z", px(a.0), px(a.1), px(b.0), px(b.1), px(a.0));
        self.path(if filled { fill(style) } else { stroke(style) }, &data);
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn {
        self.path(stroke(style), &polyline(path));
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(&mut self, center: BackendCoord, radius: u32, style: &S, filled: bool) -> Drawn {
        let r = i32::try_from(radius).unwrap_or(i32::MAX / 4);
        let half = format!("a{} {} 0 1 0", px(r), px(r));
        let data = format!("M{} {}{half} {} 0{half} {} 0Z", px(center.0 - r), px(center.1), px(2 * r), px(-2 * r));
        self.path(if filled { fill(style) } else { stroke(style) }, &data);
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, vert: I, style: &S) -> Drawn {
        let data = polyline(vert);
        if !data.is_empty() {
            self.path(fill(style), &format!("{data}Z"));
        }
        Ok(())
    }

    fn draw_text<T: BackendTextStyle>(&mut self, text: &str, style: &T, (x, y): BackendCoord) -> Drawn {
        if text.is_empty() || style.color().alpha == 0.0 {
            return Ok(());
        }
        let size = style.size() / GRAIN;
        let bold = matches!(style.style(), FontStyle::Bold);
        self.take(Pen::new(style.color(), Kind::Words(size, bold)));
        self.flush();
        let anchor = style.anchor();
        // The baseline is placed by hand: renderers disagree about `dominant-baseline`.
        let drop = match anchor.v_pos {
            VPos::Top => theme::CAPITAL * size,
            VPos::Center => 0.5 * theme::CAPITAL * size,
            VPos::Bottom => 0.0,
        };
        let degrees = match style.transform() {
            FontTransform::None => 0,
            FontTransform::Rotate90 => 90,
            FontTransform::Rotate180 => 180,
            FontTransform::Rotate270 => -90,
        };
        let _ = if degrees == 0 {
            write!(self.body, "<text x=\"{}\" y=\"{}\"", px(x), number(f64::from(y) / GRAIN + drop, 2))
        } else {
            let drop = number(drop, 2);
            write!(self.body, "<text y=\"{drop}\" transform=\"translate({} {})rotate({degrees})\"", px(x), px(y))
        };
        self.body.push_str(match anchor.h_pos {
            HPos::Left => "",
            HPos::Center => " text-anchor=\"middle\"",
            HPos::Right => " text-anchor=\"end\"",
        });
        let _ = write!(self.body, ">{}</text>", escaped(text));
        Ok(())
    }

    fn estimate_text_size<T: BackendTextStyle>(
        &self,
        text: &str,
        style: &T,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let size = style.size();
        let bold = matches!(style.style(), FontStyle::Bold);
        Ok((theme::width(text, size, bold).ceil() as u32, (theme::CAPITAL * size).ceil() as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_never_strange() {
        for (value, text) in
            [(1.0, "1"), (0.5, ".5"), (-0.25, "-.25"), (-0.0001, "0"), (100.0, "100"), (1.0 / 3.0, ".333")]
        {
            assert_eq!(number(value, 3), text);
        }
        assert_eq!(number(f64::NAN, 3), "0");
    }

    #[test]
    fn xml_is_escaped_and_control_characters_replaced() {
        assert_eq!(escaped("a<b & \"c\">\u{1b}"), "a&lt;b &amp; &quot;c&quot;&gt;\u{fffd}");
    }

    #[test]
    fn neighbours_with_one_pen_share_a_path() {
        let mut canvas = Canvas::new(10.0, 10.0);
        let ink = Ink::Grid.stroke(1.0);
        canvas.draw_line((0, 0), (1050, 0), &ink).unwrap();
        canvas.draw_line((0, 33), (1050, 33), &ink).unwrap();
        let svg = canvas.document(Sheet { title: "t", description: "d", adaptive: false });
        assert!(svg.contains("<path d=\"M0 0H10.5M0 .33H10.5\"/>"), "{svg}");
    }
}
