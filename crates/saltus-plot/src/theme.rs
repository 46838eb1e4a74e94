//! How pictures look: inks, dashes, type and the widths of letters.

use plotters::style::{FontDesc, FontFamily, FontStyle, RGBAColor, ShapeStyle, TextStyle};
use plotters_backend::BackendColor;
use plotters_backend::text_anchor::{HPos, Pos, VPos};

/// Shortest side a picture may have, in px.
pub(crate) const SMALLEST: f64 = 160.0;
/// Longest side a picture may have, in px.
pub(crate) const LARGEST: f64 = 20_000.0;

/// Faces with the same metrics on nearly every system, so that the widths that are computed here
/// are those of the picture.
pub(crate) const FAMILY: &str = "'Helvetica Neue',Helvetica,Arial,'Liberation Sans',system-ui,sans-serif";

/// The background of a picture.
///
/// # Example
///
/// ```
/// use saltus_plot::{Background, HeightTime, Stroke};
///
/// let picture = HeightTime::new("A drop").motion("model", [Stroke::over_time(0.0, 0.4, vec![1.0, 0.0, -4.9])]);
/// assert!(picture.clone().svg()?.contains("prefers-color-scheme"));
/// assert!(!picture.background(Background::White).svg()?.contains("prefers-color-scheme"));
/// # Ok::<(), saltus_plot::PlotError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Background {
    /// No background: the page shows through, and the colours follow the reader's light or dark
    /// scheme.
    ///
    /// A page that stays white for readers with a dark scheme needs [`White`](Self::White) or
    /// [`Adaptive`](Self::Adaptive): pale ink would vanish on it.
    #[default]
    None,
    /// White paper, in dark surroundings too.
    White,
    /// Paper of its own, white in light surroundings and nearly black in dark ones.
    Adaptive,
}

/// The number of motions with a colour of their own.
const SERIES: usize = 5;

/// The use of a stroke or a word. Each ink has a colour on light paper and one on dark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Ink {
    /// Titles, numbers, marks of measurements.
    Text,
    /// Captions, axis titles.
    Muted,
    /// Grid lines; translucent, so that they suit any paper.
    Grid,
    /// The floor and zero lines.
    Floor,
    /// The first five motions, then again from the first.
    Series(u8),
    /// The paper itself, when there is one.
    Paper,
}

impl Ink {
    pub(crate) const ALL: [Self; 10] = [
        Self::Text,
        Self::Muted,
        Self::Grid,
        Self::Floor,
        Self::Series(0),
        Self::Series(1),
        Self::Series(2),
        Self::Series(3),
        Self::Series(4),
        Self::Paper,
    ];

    pub(crate) fn series(index: usize) -> Self {
        Self::Series((index % 5) as u8)
    }

    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Muted => "muted",
            Self::Grid => "grid",
            Self::Floor => "floor",
            Self::Series(0) => "one",
            Self::Series(1) => "two",
            Self::Series(2) => "three",
            Self::Series(3) => "four",
            Self::Series(_) => "five",
            Self::Paper => "paper",
        }
    }

    /// The colour on light paper. Blue, vermilion, green and purple stay apart for every common
    /// kind of colour blindness; ochre, which is near vermilion for some, comes last.
    pub(crate) fn light(self) -> (u8, u8, u8) {
        match self {
            Self::Text => (0x1b, 0x20, 0x27),
            Self::Muted => (0x57, 0x60, 0x6c),
            Self::Grid => (0x7b, 0x88, 0x99),
            Self::Floor => (0x3d, 0x46, 0x51),
            Self::Series(0) => (0x0a, 0x62, 0xb5),
            Self::Series(1) => (0xcc, 0x51, 0x00),
            Self::Series(2) => (0x00, 0x7d, 0x5d),
            Self::Series(3) => (0xa0, 0x4a, 0x98),
            Self::Series(_) => (0x8a, 0x6a, 0x00),
            Self::Paper => (0xff, 0xff, 0xff),
        }
    }

    /// The colour on dark paper.
    pub(crate) fn dark(self) -> (u8, u8, u8) {
        match self {
            Self::Text => (0xec, 0xef, 0xf3),
            Self::Muted => (0xa7, 0xb1, 0xbd),
            Self::Grid => (0x8b, 0x98, 0xa9),
            Self::Floor => (0xc4, 0xcb, 0xd4),
            Self::Series(0) => (0x5a, 0xb0, 0xf7),
            Self::Series(1) => (0xff, 0x98, 0x52),
            Self::Series(2) => (0x3f, 0xd1, 0xa3),
            Self::Series(3) => (0xe2, 0x9a, 0xda),
            Self::Series(_) => (0xd6, 0xb2, 0x3c),
            Self::Paper => (0x12, 0x16, 0x1c),
        }
    }

    /// The ink a backend colour stands for.
    pub(crate) fn of(color: BackendColor) -> Option<Self> {
        Self::ALL.into_iter().find(|ink| ink.light() == color.rgb)
    }

    pub(crate) fn rgba(self, alpha: f64) -> RGBAColor {
        let (r, g, b) = self.light();
        RGBAColor(r, g, b, alpha)
    }

    /// A stroke of this ink, `width` px wide.
    pub(crate) fn stroke(self, width: f64) -> ShapeStyle {
        self.faint(width, 1.0)
    }

    /// A translucent stroke.
    pub(crate) fn faint(self, width: f64, alpha: f64) -> ShapeStyle {
        ShapeStyle { color: self.rgba(alpha), filled: false, stroke_width: crate::grain::grains(width).unsigned_abs() }
    }

    /// A translucent area.
    pub(crate) fn wash(self, alpha: f64) -> ShapeStyle {
        ShapeStyle { color: self.rgba(alpha), filled: true, stroke_width: 0 }
    }
}

/// The dashes of a line, so that lines differ in more than colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Dash {
    Solid,
    Dashed,
    Dotted,
    Mixed,
}

impl Dash {
    pub(crate) fn series(index: usize) -> Self {
        // One fewer than colours: each colour comes again with another dash.
        [Self::Solid, Self::Dashed, Self::Dotted, Self::Mixed][index % 4]
    }

    /// The dashes of lines that may be steep or have steps, whose own shape dashes would hide: the
    /// first five are solid, and differ by their inks alone.
    pub(crate) fn steep(index: usize) -> Self {
        Self::series(index / SERIES)
    }

    /// Lengths in units of the stroke's width; with round caps each dash grows by one such width.
    pub(crate) fn lengths(self) -> &'static [f64] {
        match self {
            Self::Solid => &[],
            Self::Dashed => &[3.4, 3.0],
            Self::Dotted => &[0.01, 2.1],
            Self::Mixed => &[3.6, 2.6, 0.01, 2.6],
        }
    }
}

/// Sizes that follow from one type size, in px.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Type {
    /// Size of numbers and legends.
    pub(crate) base: f64,
}

impl Type {
    /// The type size for a picture of this size: 16 px at 800 by 560, never below 11.
    pub(crate) fn for_size(width: f64, height: f64) -> Self {
        let side = width.min(1.43 * height) / 800.0;
        Self { base: (16.0 * side.powf(0.6)).max(11.0) }
    }

    pub(crate) fn title(self) -> f64 {
        1.5 * self.base
    }

    pub(crate) fn margin(self) -> f64 {
        1.5 * self.base
    }

    pub(crate) fn hairline(self) -> f64 {
        self.base / 16.0
    }

    pub(crate) fn line(self) -> f64 {
        2.3 * self.hairline()
    }

    /// The width of a limit, and of a ring around a point.
    pub(crate) fn rule(self) -> f64 {
        1.5 * self.hairline()
    }

    /// Half the breadth of a mark.
    pub(crate) fn mark(self) -> f64 {
        3.7 * self.hairline()
    }

    /// Depth of what lies below the floor line.
    pub(crate) fn sole(self) -> f64 {
        0.95 * self.base
    }
}

/// A text style in the backend's fine units.
pub(crate) fn words(ink: Ink, size: f64, weight: FontStyle, h: HPos, v: VPos) -> TextStyle<'static> {
    let font = FontDesc::new(FontFamily::SansSerif, size * crate::grain::GRAIN, weight);
    TextStyle { font, color: BackendColor { alpha: 1.0, rgb: ink.light() }, pos: Pos::new(h, v) }
}

/// Height of a capital letter as a part of the type size.
pub(crate) const CAPITAL: f64 = 0.717;

/// The advance widths of Helvetica for the characters from space to tilde, in thousandths of the
/// type size.
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833,
    722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556,
    556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334,
    260, 334, 584,
];

/// The width of `text` at `size`, in px, in a face like Helvetica.
pub(crate) fn width(text: &str, size: f64, bold: bool) -> f64 {
    let thousandths: f64 = text.chars().map(advance).sum();
    thousandths / 1000.0 * size * if bold { 1.06 } else { 1.0 }
}

fn advance(c: char) -> f64 {
    match c {
        ' '..='~' => f64::from(WIDTHS[(c as usize) - 32]),
        '\u{2009}' | '\u{200a}' | '\u{202f}' => 200.0,
        '\u{a0}' => 278.0,
        '·' | '’' | '‘' => 278.0,
        '\u{2212}' | '±' | '×' | '≈' | '≤' | '≥' => 584.0,
        '–' => 556.0,
        '—' | '…' => 1000.0,
        '⁰'..='⁹' | '¹' | '²' | '³' | '⁻' => 345.0,
        '\u{300}'..='\u{36f}' => 0.0,
        c if c >= '\u{1100}' => 1000.0,
        c if c.is_uppercase() => 720.0,
        _ => 556.0,
    }
}

/// Room left for faces wider than Helvetica where text must not be cut off or run into what
/// follows.
const GENEROUS: f64 = 1.1;

/// The width of `text` at `size` in a rather wide face.
pub(crate) fn room(text: &str, size: f64, bold: bool) -> f64 {
    GENEROUS * width(text, size, bold)
}

/// `text` in lines no wider than `room` px. Words break only when one alone is too wide.
pub(crate) fn wrapped(text: &str, size: f64, bold: bool, room: f64) -> Vec<String> {
    let fits = |line: &str| self::room(line, size, bold) <= room;
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split(' ').filter(|word| !word.is_empty()) {
            let gap = if line.is_empty() { "" } else { " " };
            if fits(&format!("{line}{gap}{word}")) {
                line.push_str(gap);
                line.push_str(word);
                continue;
            }
            if !line.is_empty() {
                lines.push(std::mem::take(&mut line));
            }
            for c in word.chars() {
                if !line.is_empty() && !fits(&format!("{line}{c}")) {
                    lines.push(std::mem::take(&mut line));
                }
                line.push(c);
            }
        }
        if !line.is_empty() {
            lines.push(line);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ink_has_its_own_colour() {
        for ink in Ink::ALL {
            let found = Ink::of(BackendColor { alpha: 1.0, rgb: ink.light() });
            assert_eq!(found, Some(ink));
        }
    }

    #[test]
    fn letters_have_helvetica_widths() {
        assert!((width("Height (cm)", 1000.0, false) - 5167.0).abs() < 1.0, "{}", width("Height (cm)", 1000.0, false));
        assert!((width("0.25", 1000.0, false) - 1946.0).abs() < 1e-9);
    }

    #[test]
    fn wrapping_keeps_every_word_and_the_width() {
        let text = "COR 0.54 (0.43 to 0.65): heights and times disagree, and a-word-without-any-spaces-that-is-longer-than-a-line";
        let lines = wrapped(text, 16.0, false, 200.0);
        assert!(lines.len() > 3);
        assert_eq!(lines.concat().replace(' ', ""), text.replace(' ', ""));
        assert!(lines.iter().all(|line| width(line, 16.0, false) <= 200.0));
    }
}
