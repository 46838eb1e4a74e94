//! Any two quantities against each other: paths, phase portraits, energies, loops.

use crate::error::{PlotError, finite, magnitude};
use crate::map::Map;
use crate::measure::Measure;
use crate::stroke::Stroke;
use crate::theme::Background;

/// A disc to scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// The centre.
    pub at: [f64; 2],
    /// The radius in the unit of the axes.
    pub radius: f64,
    /// Full ink; others are pale.
    pub full: bool,
}

/// A picture of one quantity against another.
///
/// Lines are solid, dashed, dotted, dash-dotted, in that order; jumps are thin and dashed and never
/// join two lines with a solid stroke. The same input gives the same bytes.
///
/// ```
/// use saltus_plot::{Chart, Measure, Stroke};
/// let fall = Stroke::new(0.4, vec![1.0, 0.0, -4.9], vec![0.0, -9.8]);
/// let svg = Chart::new("A fall", ("Height", Measure::Length), ("Velocity", Measure::Speed)).line("", [fall]).svg()?;
/// assert!(svg.contains("Height (cm)") && svg.contains("Velocity (m/s)"));
/// # Ok::<(), saltus_plot::PlotError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    pub(crate) title: String,
    pub(crate) captions: Vec<String>,
    pub(crate) axes: [(String, Measure); 2],
    pub(crate) lines: Vec<(String, Vec<Stroke>)>,
    /// Points of the line so numbered.
    pub(crate) dots: Vec<(usize, [f64; 2])>,
    pub(crate) limits: Vec<(String, f64)>,
    pub(crate) callouts: Vec<(String, [f64; 2])>,
    pub(crate) jumps: Vec<[[f64; 2]; 2]>,
    pub(crate) arrows: Vec<[[f64; 2]; 2]>,
    pub(crate) marks: Vec<[f64; 2]>,
    pub(crate) discs: Vec<(usize, Disc)>,
    pub(crate) map: Option<Map>,
    pub(crate) ground: Vec<Stroke>,
    pub(crate) to_scale: bool,
    /// The axes in powers of ten, across and up.
    pub(crate) logarithmic: [bool; 2],
    /// The place across of all lesser values.
    pub(crate) least: Option<f64>,
    pub(crate) background: Background,
}

impl Chart {
    /// A picture with a title and the names and measures of its axes, across and up.
    #[must_use]
    pub fn new(title: &str, across: (&str, Measure), up: (&str, Measure)) -> Self {
        Self {
            title: title.to_owned(),
            captions: Vec::new(),
            axes: [across, up].map(|(name, measure)| (name.to_owned(), measure)),
            lines: Vec::new(),
            dots: Vec::new(),
            limits: Vec::new(),
            callouts: Vec::new(),
            jumps: Vec::new(),
            arrows: Vec::new(),
            marks: Vec::new(),
            discs: Vec::new(),
            map: None,
            ground: Vec::new(),
            to_scale: false,
            logarithmic: [false; 2],
            least: None,
            background: Background::None,
        }
    }

    /// Adds a line under the title.
    #[must_use]
    pub fn caption(mut self, text: &str) -> Self {
        self.captions.push(text.to_owned());
        self
    }

    /// Adds a line; without a name it is not in the legend.
    #[must_use]
    pub fn line(mut self, label: &str, strokes: impl IntoIterator<Item = Stroke>) -> Self {
        self.lines.push((label.to_owned(), strokes.into_iter().collect()));
        self
    }

    /// Adds points to the line added last, in its colour.
    #[must_use]
    pub fn dotted(mut self, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let line = self.lines.len().saturating_sub(1);
        self.dots.extend(points.into_iter().map(|point| (line, point)));
        self
    }

    /// Adds a limit on the axis across: an upright line from edge to edge, named in the legend.
    #[must_use]
    pub fn limit(mut self, label: &str, at: f64) -> Self {
        self.limits.push((label.to_owned(), at));
        self
    }

    /// Puts a ring around a point, and words beside it where there is room.
    #[must_use]
    pub fn callout(mut self, words: &str, at: [f64; 2]) -> Self {
        self.callouts.push((words.to_owned(), at));
        self
    }

    /// Adds jumps: thin dashed lines from one point to another.
    #[must_use]
    pub fn jumps(mut self, jumps: impl IntoIterator<Item = [[f64; 2]; 2]>) -> Self {
        self.jumps.extend(jumps);
        self
    }

    /// Adds arrow heads, each at a point and towards another one.
    #[must_use]
    pub fn arrows(mut self, arrows: impl IntoIterator<Item = [[f64; 2]; 2]>) -> Self {
        self.arrows.extend(arrows);
        self
    }

    /// Adds points.
    #[must_use]
    pub fn marks(mut self, marks: impl IntoIterator<Item = [f64; 2]>) -> Self {
        self.marks.extend(marks);
        self
    }

    /// Adds discs in the ink of the last line.
    #[must_use]
    pub fn discs(mut self, discs: impl IntoIterator<Item = Disc>) -> Self {
        let line = self.lines.len().saturating_sub(1);
        self.discs.extend(discs.into_iter().map(|disc| (line, disc)));
        self
    }

    /// Puts a quantity in tones over both axes, under all else.
    #[must_use]
    pub fn map(mut self, map: Map) -> Self {
        self.map = Some(map);
        self
    }

    /// Adds floors and walls.
    #[must_use]
    pub fn ground(mut self, strokes: impl IntoIterator<Item = Stroke>) -> Self {
        self.ground.extend(strokes);
        self
    }

    /// Shows both axes to one scale.
    #[must_use]
    pub const fn to_scale(mut self) -> Self {
        self.to_scale = true;
        self
    }

    /// Shows the upward axis by powers of ten; what is not above zero is refused.
    #[must_use]
    pub const fn logarithmic(mut self) -> Self {
        self.logarithmic[1] = true;
        self
    }

    /// Shows the axis across by powers of ten; what is not above zero is refused.
    #[must_use]
    pub const fn logarithmic_across(mut self) -> Self {
        self.logarithmic[0] = true;
        self
    }

    /// Shows both axes by powers of ten; what is not above zero is refused.
    #[must_use]
    pub const fn both_logarithmic(mut self) -> Self {
        self.logarithmic = [true; 2];
        self
    }

    /// Draws values across that are less than `least`, zero for one, at `least`, with a tick for
    /// them: a logarithmic axis has no other place for them.
    ///
    /// ```
    /// use saltus_plot::{Chart, Measure};
    /// let chart = Chart::new("Errors", ("Error", Measure::Length), ("Time", Measure::Time)).both_logarithmic();
    /// let svg = chart.at_least(1e-15).marks([[0.0, 1e-3], [1e-3, 1e-5]]).svg()?;
    /// assert!(svg.contains("≤ 10⁻¹⁵"));
    /// # Ok::<(), saltus_plot::PlotError>(())
    /// ```
    #[must_use]
    pub const fn at_least(mut self, least: f64) -> Self {
        self.least = Some(least);
        self
    }

    /// The picture on a `background`; transparent without one.
    #[must_use]
    pub const fn background(mut self, background: Background) -> Self {
        self.background = background;
        self
    }

    /// Checks every number, and gathers how far the data reach.
    pub(crate) fn reach(&self) -> Result<[(f64, f64); 2], PlotError> {
        let mut reach = [(f64::INFINITY, f64::NEG_INFINITY); 2];
        let least = self.least.unwrap_or(f64::NEG_INFINITY);
        let mut include = |k: usize, value: f64| {
            let value = if k == 0 { value.max(least) } else { value };
            reach[k] = (reach[k].0.min(value), reach[k].1.max(value));
        };
        let lines = self.lines.iter().flat_map(|(_, strokes)| strokes).chain(&self.ground);
        for (n, stroke) in lines.enumerate() {
            for (k, (low, high)) in stroke.check(|| format!("stroke {}", n + 1))?.into_iter().enumerate() {
                include(k, low);
                include(k, high);
            }
        }
        let dots = self.dots.iter().map(|(_, point)| point);
        let called = self.callouts.iter().map(|(_, point)| point);
        let points = self.jumps.iter().flatten().chain(&self.marks).chain(dots).chain(called);
        for (n, point) in points.enumerate() {
            for (k, &value) in point.iter().enumerate() {
                include(k, finite(value, || format!("a coordinate of point {}", n + 1))?);
            }
        }
        for (label, at) in &self.limits {
            include(0, finite(*at, || format!("the limit '{label}'"))?);
        }
        for (n, (_, disc)) in self.discs.iter().enumerate() {
            let radius = magnitude(disc.radius, || format!("the radius of disc {}", n + 1))?;
            for (k, &value) in disc.at.iter().enumerate() {
                let value = finite(value, || format!("a coordinate of disc {}", n + 1))?;
                include(k, value - radius);
                include(k, value + radius);
            }
        }
        if let Some(map) = &self.map {
            map.check()?;
            for k in 0..2 {
                map.edges(k, self.logarithmic[k]).into_iter().for_each(|edge| include(k, edge));
            }
        }
        if reach[0].0 > reach[0].1 {
            return Err(PlotError::Empty);
        }
        for (logarithmic, (low, _)) in self.logarithmic.iter().zip(reach) {
            if *logarithmic && low <= 0.0 {
                return Err(PlotError::Negative { what: "a value on the logarithmic axis".to_owned(), value: low });
            }
        }
        Ok(reach)
    }
}
