//! One coordinate of a run against another.

use std::fmt;
use std::ops::Range;

use saltus::{State, Trajectory};

use crate::chart::Chart;
use crate::coordinate::{Coordinate, Label, place};
use crate::error::PlotError;
use crate::measure::Measure;
use crate::stroke::Stroke;
use crate::theme::Background;
use crate::traced::{Leap, Part, Traced, labels};

/// The most arrows that show the direction of a run.
const ARROWS: usize = 6;
/// The way from one arrow to the next, as a part of how far the run reaches.
const APART: f64 = 0.8;
/// Arrows are looked for on so many stretches of that length.
const MOST: f64 = 40.0;
/// Arrows nearer than this to another, in the same unit, are left out.
const NEAR: f64 = 0.2;

/// A phase portrait of a run: one coordinate against another.
///
/// Each mode is a line of its own, named in the legend. Curves are the run's own polynomials,
/// within a third of a px of it. Jumps are thin and dashed; arrows show the direction, a dot the
/// start. Names, units and errors are those of [`Panels`](crate::Panels).
///
/// ```
/// use saltus::{Hybrid, Simulation};
/// use saltus_plot::Phase;
/// // A clock: a swing with a wall that gives a push.
/// let clock = Hybrid::new()
///     .mode("swing", |_t, x: &[f64; 2]| [x[1], -x[0] - 0.1 * x[1]])
///     .edge("swing", "swing", |_t, x| x[0] + 0.5, |_t, x| [x[0], 0.5 - x[1]]);
/// let run = Simulation::of(&clock).run("swing", [0.0, 1.0], 0.0..60.0)?;
/// let svg = Phase::of(&run.trajectory, 0, 1).named(["angle (rad)", "rate (rad/s)"]).svg()?;
/// assert!(svg.contains("angle (rad)") && svg.contains("rate (rad/s)"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Limits
/// The file grows with the run: [`over`](Self::over) draws a part of one that turns a thousand
/// times.
pub struct Phase<'a, M, E, S> {
    trajectory: &'a Trajectory<M, E, S>,
    axes: [Coordinate; 2],
    title: String,
    captions: Vec<String>,
    named: Vec<String>,
    over: Option<Range<f64>>,
    to_scale: bool,
    background: Background,
}

impl<M, E, S> fmt::Debug for Phase<'_, M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { title, axes, over, .. } = self;
        f.debug_struct("Phase").field("title", title).field("axes", axes).field("over", over).finish_non_exhaustive()
    }
}

impl<'a, M: Copy + fmt::Debug, E, S: State> Phase<'a, M, E, S> {
    /// The picture of a run, the first coordinate across and the second up, by name or place.
    #[must_use]
    pub fn of(trajectory: &'a Trajectory<M, E, S>, across: impl Into<Coordinate>, up: impl Into<Coordinate>) -> Self {
        Self {
            trajectory,
            axes: [across.into(), up.into()],
            title: String::new(),
            captions: Vec::new(),
            named: Vec::new(),
            over: None,
            to_scale: false,
            background: Background::None,
        }
    }

    /// The title; none without it.
    #[must_use]
    pub fn title(mut self, text: &str) -> Self {
        text.clone_into(&mut self.title);
        self
    }

    /// Adds a line under the title.
    #[must_use]
    pub fn caption(mut self, text: &str) -> Self {
        self.captions.push(text.to_owned());
        self
    }

    /// Names the coordinates of the state in order; see [`Panels::named`](crate::Panels::named).
    #[must_use]
    pub fn named<N: Into<String>>(mut self, names: impl IntoIterator<Item = N>) -> Self {
        self.named = names.into_iter().map(Into::into).collect();
        self
    }

    /// Draws this part only, in the unit of time of the model.
    #[must_use]
    pub fn over(mut self, part: Range<f64>) -> Self {
        self.over = Some(part);
        self
    }

    /// Shows both axes to one scale.
    #[must_use]
    pub const fn to_scale(mut self) -> Self {
        self.to_scale = true;
        self
    }

    /// The picture on a `background`; transparent without one.
    #[must_use]
    pub const fn background(mut self, background: Background) -> Self {
        self.background = background;
        self
    }

    /// The picture as an SVG document.
    ///
    /// # Errors
    /// As [`Panels::svg`](crate::Panels::svg).
    pub fn svg(&self) -> Result<String, PlotError> {
        let labels = labels(self.trajectory, &self.named)?;
        let [across, up] = &self.axes;
        let places = [place(across, &labels)?, place(up, &labels)?];
        let traced = Traced::of(self.trajectory, self.over.as_ref(), &places)?;
        let [across, up] = places.map(|place| &labels[place]);
        let mut chart = Chart::new(&self.title, axis(across), axis(up)).background(self.background);
        for caption in &self.captions {
            chart = chart.caption(caption);
        }
        chart = drawn(chart, &traced);
        (if self.to_scale { chart.to_scale() } else { chart }).svg()
    }
}

fn axis(label: &Label) -> (&str, Measure) {
    (&label.name, label.unit.clone().into())
}

/// The run in a chart: a line for each mode, jumps, arrows, the start.
fn drawn(mut chart: Chart, traced: &Traced) -> Chart {
    for (mode, name) in traced.modes.iter().enumerate() {
        let parts = traced.stays.iter().filter(|stay| stay.mode == mode).flat_map(|stay| &stay.parts);
        let label = if traced.modes.len() > 1 { name } else { "" };
        chart = chart.line(label, parts.filter_map(stroke));
    }
    let jump = |leap: &Leap| {
        let [before, after] = [&leap.before, &leap.after].map(|side| Some([side[0]?, side[1]?]));
        Some([before?, after?])
    };
    let strokes: Vec<Stroke> = traced.parts().filter_map(stroke).collect();
    let start = strokes.first().map(|first| first.start()).map(|(x, y)| [x, y]);
    chart.jumps(traced.leaps.iter().filter_map(jump)).arrows(arrows(&strokes)).marks(start)
}

fn stroke(part: &Part) -> Option<Stroke> {
    let [x, y] = [0, 1].map(|k| part.coefficients[k].clone());
    (!x.is_empty() && !y.is_empty()).then(|| Stroke::new(part.span / part.scale, x, y))
}

/// Arrows evenly along the way; lengths are parts of how far all strokes reach.
fn arrows(strokes: &[Stroke]) -> Vec<[[f64; 2]; 2]> {
    let ends = || strokes.iter().flat_map(|stroke| [stroke.start(), stroke.end()]);
    let size = |of: fn(&(f64, f64)) -> f64| {
        let (low, high) = ends()
            .map(|point| of(&point))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        if high > low { high - low } else { 1.0 }
    };
    let (wide, tall) = (size(|p| p.0), size(|p| p.1));
    let way = |a: (f64, f64), b: (f64, f64)| ((b.0 - a.0) / wide).hypot((b.1 - a.1) / tall);
    let length = |stroke: &Stroke| {
        let (from, middle, to) = (stroke.start(), stroke.at(0.5 * stroke.span), stroke.end());
        way(from, middle) + way(middle, to)
    };
    let mut arrows = Vec::new();
    let (mut gone, mut due) = (0.0, 0.5 * APART);
    for stroke in strokes {
        let long = length(stroke);
        while due < gone + long && due < MOST * APART && arrows.len() < ARROWS {
            let part = (due - gone) / long;
            let (at, ahead) = (stroke.at(part * stroke.span), stroke.at((part + 0.01) * stroke.span));
            let near = |arrow: &[[f64; 2]; 2]| way((arrow[0][0], arrow[0][1]), at) < NEAR;
            if !arrows.iter().any(near) {
                arrows.push([[at.0, at.1], [ahead.0, ahead.1]]);
            }
            due += APART;
        }
        gone += long;
    }
    arrows
}
