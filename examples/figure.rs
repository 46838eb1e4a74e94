//! Lines and dots between two axes, as SVG.

use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Colours that people with any colour vision tell apart (Okabe and Ito), and dashes for those who
/// print in grey.
const INKS: [(&str, &str); 5] =
    [("#0072b2", ""), ("#d55e00", "7 3"), ("#009e73", "2 3"), ("#cc79a7", "9 3 2 3"), ("#444", "4 4")];
const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 470.0;
/// The frame: left, top, right, bottom.
const FRAME: [f64; 4] = [78.0, 58.0, 736.0, 412.0];

/// A picture with two axes: lines, dots, clouds of dots.
#[derive(Clone, Debug)]
pub struct Figure {
    title: String,
    labels: [String; 2],
    ranges: [Option<(f64, f64)>; 2],
    equal: bool,
    series: Vec<Series>,
}

#[derive(Clone, Debug)]
struct Series {
    kind: Kind,
    label: String,
    points: Vec<[f64; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Line,
    Dots,
    Cloud,
}

impl Figure {
    /// An empty picture with the names of its axes, units in brackets.
    #[must_use]
    pub fn new(title: &str, across: &str, up: &str) -> Self {
        let labels = [across.to_owned(), up.to_owned()];
        Self { title: title.to_owned(), labels, ranges: [None; 2], equal: false, series: Vec::new() }
    }

    /// Adds a line through points; one that is not a number interrupts it. An empty label is not
    /// listed.
    #[must_use]
    pub fn line(self, label: &str, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        self.with(Kind::Line, label, points)
    }

    /// Adds dots.
    #[must_use]
    pub fn dots(self, label: &str, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        self.with(Kind::Dots, label, points)
    }

    /// Adds very many small dots: those that share a pixel are drawn once.
    #[must_use]
    pub fn cloud(self, label: &str, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        self.with(Kind::Cloud, label, points)
    }

    /// The range of the axis across; that of the data without it.
    #[must_use]
    pub const fn across(mut self, low: f64, high: f64) -> Self {
        self.ranges[0] = Some((low, high));
        self
    }

    /// The range of the axis up.
    #[must_use]
    pub const fn up(mut self, low: f64, high: f64) -> Self {
        self.ranges[1] = Some((low, high));
        self
    }

    /// Makes lengths on both axes equal, as on a map.
    #[must_use]
    pub const fn equal(mut self) -> Self {
        self.equal = true;
        self
    }

    fn with(mut self, kind: Kind, label: &str, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        self.series.push(Series { kind, label: label.to_owned(), points: points.into_iter().collect() });
        self
    }

    /// The picture as an SVG document.
    #[must_use]
    pub fn svg(&self) -> String {
        let [left, top, right, bottom] = FRAME;
        let ranges = self.fitted();
        let place = |p: &[f64; 2]| {
            let part = |axis: usize| (p[axis] - ranges[axis].0) / (ranges[axis].1 - ranges[axis].0);
            (left + part(0) * (right - left), bottom - part(1) * (bottom - top))
        };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"14\">\n\
             <title>{title}</title>\n<desc>{} against {}.</desc>\n<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#fff\"/>\n\
             <text x=\"{left}\" y=\"24\" font-size=\"17\" font-weight=\"bold\">{title}</text>\n\
             <clipPath id=\"frame\"><rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
            escaped(&self.labels[1]),
            escaped(&self.labels[0]),
            right - left,
            bottom - top,
            title = escaped(&self.title),
        );
        self.axes(&mut svg, &ranges, place);
        svg.push_str("<g clip-path=\"url(#frame)\" fill=\"none\" stroke-linejoin=\"round\">\n");
        for (series, (ink, dash)) in self.series.iter().zip(INKS.iter().cycle()) {
            let places = series.points.iter().map(place);
            match series.kind {
                Kind::Line => {
                    _ = writeln!(
                        svg,
                        "<path d=\"{}\" stroke=\"{ink}\" stroke-width=\"1.8\" stroke-dasharray=\"{dash}\"/>",
                        path(places)
                    );
                }
                Kind::Dots => {
                    let dots = places.map(|(x, y)| format!("M{x:.1} {y:.1}h0"));
                    _ = writeln!(
                        svg,
                        "<path d=\"{}\" stroke=\"{ink}\" stroke-width=\"7\" stroke-linecap=\"round\"/>",
                        dots.collect::<String>()
                    );
                }
                Kind::Cloud => {
                    _ = writeln!(svg, "<path d=\"{}\" stroke=\"#333\" stroke-width=\"0.8\"/>", cloud(places));
                }
            }
        }
        svg.push_str("</g>\n");
        self.legend(&mut svg);
        svg.push_str("</svg>\n");
        svg
    }

    /// The ranges of both axes: as asked for, else those of the data and a little more.
    fn fitted(&self) -> [(f64, f64); 2] {
        let mut ranges = [0, 1].map(|axis| {
            self.ranges[axis].unwrap_or_else(|| {
                let values =
                    self.series.iter().flat_map(|series| &series.points).map(|p| p[axis]).filter(|v| v.is_finite());
                let (low, high) =
                    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
                let (low, high) = if low < high {
                    (low, high)
                } else if low.is_finite() {
                    (low - 0.5, high + 0.5)
                } else {
                    (0.0, 1.0)
                };
                let air = 0.04 * (high - low);
                (low - air, high + air)
            })
        });
        if self.equal {
            let [left, top, right, bottom] = FRAME;
            let scale =
                ((ranges[0].1 - ranges[0].0) / (right - left)).max((ranges[1].1 - ranges[1].0) / (bottom - top));
            for (range, pixels) in ranges.iter_mut().zip([right - left, bottom - top]) {
                let more = 0.5 * (scale * pixels - (range.1 - range.0));
                *range = (range.0 - more, range.1 + more);
            }
        }
        ranges
    }

    fn axes(&self, svg: &mut String, ranges: &[(f64, f64); 2], place: impl Fn(&[f64; 2]) -> (f64, f64)) {
        let [left, top, right, bottom] = FRAME;
        for (tick, text) in ticks(ranges[0]) {
            let x = place(&[tick, ranges[1].0]).0;
            _ = writeln!(
                svg,
                "<path d=\"M{x:.1} {top}V{bottom}\" stroke=\"#e4e4e4\"/><text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{text}</text>",
                bottom + 20.0
            );
        }
        for (tick, text) in ticks(ranges[1]) {
            let y = place(&[ranges[0].0, tick]).1;
            _ = writeln!(
                svg,
                "<path d=\"M{left} {y:.1}H{right}\" stroke=\"#e4e4e4\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>",
                left - 8.0,
                y + 5.0
            );
        }
        _ = writeln!(svg, "<path d=\"M{left} {top}V{bottom}H{right}\" fill=\"none\" stroke=\"#222\"/>");
        let (x, y) = (0.5 * (left + right), 0.5 * (top + bottom));
        _ = writeln!(
            svg,
            "<text x=\"{x}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            HEIGHT - 14.0,
            escaped(&self.labels[0])
        );
        _ = writeln!(
            svg,
            "<text transform=\"translate(20 {y}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            escaped(&self.labels[1])
        );
    }

    /// The labels in a row under the title.
    fn legend(&self, svg: &mut String) {
        let mut x = FRAME[0];
        for (series, (ink, dash)) in
            self.series.iter().zip(INKS.iter().cycle()).filter(|(series, _)| !series.label.is_empty())
        {
            let mark = match series.kind {
                Kind::Line => format!(
                    "<path d=\"M{x:.0} 42h26\" stroke=\"{ink}\" stroke-width=\"2\" stroke-dasharray=\"{dash}\"/>"
                ),
                Kind::Dots => format!("<circle cx=\"{:.0}\" cy=\"42\" r=\"3.5\" fill=\"{ink}\"/>", x + 13.0),
                Kind::Cloud => format!("<circle cx=\"{:.0}\" cy=\"42\" r=\"2\" fill=\"#222\"/>", x + 13.0),
            };
            _ = writeln!(svg, "{mark}<text x=\"{:.0}\" y=\"47\">{}</text>", x + 33.0, escaped(&series.label));
            x += 58.0 + 7.2 * series.label.chars().count() as f64;
        }
    }
}

fn path(places: impl Iterator<Item = (f64, f64)>) -> String {
    let (mut d, mut pen) = (String::new(), 'M');
    for (x, y) in places {
        if x.is_finite() && y.is_finite() {
            _ = write!(d, "{pen}{x:.1} {y:.1}");
            pen = 'L';
        } else {
            pen = 'M';
        }
    }
    d
}

/// One stroke for each run of neighbouring half pixels.
fn cloud(places: impl Iterator<Item = (f64, f64)>) -> String {
    let inside = |x: f64, y: f64| (FRAME[0]..=FRAME[2]).contains(&x) && (FRAME[1]..=FRAME[3]).contains(&y);
    let cells: BTreeSet<(i32, i32)> = places
        .filter(|&(x, y)| inside(x, y))
        .map(|(x, y)| ((x * 2.0).round() as i32, (y * 2.0).round() as i32))
        .collect();
    let mut d = String::new();
    let mut cells = cells.into_iter().peekable();
    while let Some((x, y)) = cells.next() {
        let mut length = 1;
        while cells.next_if_eq(&(x, y + length)).is_some() {
            length += 1;
        }
        _ = write!(d, "M{} {}v{}", f64::from(x) * 0.5, f64::from(y) * 0.5, f64::from(length) * 0.5);
    }
    d
}

/// Round numbers across a range, and how they are written.
fn ticks((low, high): (f64, f64)) -> Vec<(f64, String)> {
    let rough = (high - low) / 6.0;
    let power = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|s| s * power).find(|s| *s >= rough).unwrap_or(rough);
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(|k| (k as f64 * step, format!("{:.decimals$}", k as f64 * step).replace('-', "−"))).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}
