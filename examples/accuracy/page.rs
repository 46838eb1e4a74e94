//! A section of the page: its picture, its table; and the page.

use std::error::Error;
use std::fmt::Write;
use std::path::Path;

use saltus::WorkPoint;
use saltus_examples::gallery;
use saltus_plot::{Background, Chart, Measure, Stroke};

/// Between these lines of the page stands what is measured.
const FROM: &str = "<!-- measured: from here -->\n";
const TO: &str = "<!-- measured: to here -->\n";
/// The errors that the tables ask for.
const ERRORS: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

/// One system.
pub(crate) struct Section {
    /// The name of its picture, after `accuracy-`.
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    /// The system and its numbers.
    pub(crate) system: &'static str,
    /// What the error is of, with its unit.
    pub(crate) error: &'static str,
    /// What it is measured against, and how far that may be off.
    pub(crate) reference: String,
    pub(crate) points: Vec<WorkPoint>,
}

/// What is exact is shown as a rounding off.
const LEAST: f64 = 1e-16;

impl Section {
    fn methods(&self) -> Vec<&str> {
        let mut methods: Vec<&str> = Vec::new();
        for point in &self.points {
            if !methods.contains(&point.method.as_str()) {
                methods.push(&point.method);
            }
        }
        methods
    }

    /// Time over error, by powers of ten.
    pub(crate) fn draw(&self) -> Result<(), Box<dyn Error>> {
        let mut chart = Chart::new(self.title, (self.error, Measure::Count), ("Time of a run", Measure::Time))
            .caption(&format!("Against {}", self.reference))
            .both_logarithmic()
            .at_least(LEAST)
            .background(Background::Adaptive);
        for method in self.methods() {
            let of = self.points.iter().filter(|point| point.method == method && point.error.is_finite());
            let points: Vec<[f64; 2]> = of.map(|point| [point.error.max(LEAST), point.timing.median]).collect();
            chart = chart.line(method, Stroke::polygon(&points)).dotted(points.iter().copied());
        }
        gallery(&format!("accuracy-{}", self.name), &chart.svg()?)?;
        Ok(())
    }

    /// The cheapest run of each method to each error: its evaluations and its time.
    fn table(&self) -> String {
        let mut text = String::from("| to within |");
        for wanted in ERRORS {
            let _ = write!(text, " {wanted:.0e} |");
        }
        text.push_str("\n|---|---|---|---|---|\n");
        for method in self.methods() {
            let _ = write!(text, "| {method} |");
            for wanted in ERRORS {
                let good = self.points.iter().filter(|point| point.method == method && point.error <= wanted);
                let _ = match good.min_by_key(|point| point.stats.evaluations()) {
                    Some(point) => write!(text, " {}; {} |", point.stats.evaluations(), time(point)),
                    None => write!(text, " - |"),
                };
            }
            text.push('\n');
        }
        text
    }
}

fn time(point: &WorkPoint) -> String {
    let median = point.timing.median;
    let (number, unit) = if median < 1e-3 { (1e6 * median, "µs") } else { (1e3 * median, "ms") };
    let digits = if number < 9.95 { 1 } else { 0 };
    format!("{number:.digits$} {unit}")
}

/// Puts what was measured into the page.
pub(crate) fn rewrite(sections: &[Section], machine: &str) -> Result<(), Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/trust/accuracy.md");
    let page = std::fs::read_to_string(&path)?;
    let (before, rest) = page.split_once(FROM).ok_or("the page has no place for what is measured")?;
    let (_, after) = rest.split_once(TO).ok_or("the place for what is measured has no end")?;
    let mut measured = format!("\nMeasured on {machine}.\n");
    for section in sections {
        let Section { name, title, system, reference, .. } = section;
        let _ = write!(
            measured,
            "\n### {title}\n\n{system} Against {reference}.\n\n![{title}: time over error](../program/gallery/accuracy-{name}.svg)\n\n{}",
            section.table()
        );
    }
    std::fs::write(&path, format!("{before}{FROM}{measured}\n{TO}{after}"))?;
    Ok(())
}
