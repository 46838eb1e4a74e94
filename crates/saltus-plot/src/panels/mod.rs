//! The coordinates of a run against time, one panel above the other.

mod frame;
mod lane;
mod leaps;
mod page;

use std::fmt;
use std::ops::Range;

use saltus::{State, Trajectory};

use crate::coordinate::{Coordinate, Label, places};
use crate::error::PlotError;
use crate::measure::Measure;
use crate::theme::Background;
use crate::traced::{Traced, labels};

/// The most panels that are drawn unless they are asked for.
const MOST_PANELS: usize = 12;

/// A picture of a run: its coordinates against time, in panels that share the axis of time.
///
/// Each coordinate has a panel; those of one list or vector (`arm[0]`, `arm[1]`, …) share one.
/// Curves are the run's own polynomials, within a third of a px of it, however short a peak is. At
/// a jump a curve breaks: a ring is the limit before, a dot the one after, where there is room for
/// them; a long leap is dashed in the curve's own ink. An upright line marks each jump, where there
/// are no more than eighty, a dashed one a limit at which jumps accumulate. Of a run with several
/// modes a lane at the foot shows which is when.
///
/// Names and units are those of the state ([`State::name`], [`State::unit`]); units of the SI get
/// prefixes where numbers would be long. The same input gives the same bytes.
///
/// ```
/// use saltus::{Hybrid, Simulation, State};
/// use saltus_plot::Panels;
///
/// #[derive(Clone, Copy, Debug, State)]
/// struct Tank {
///     #[unit("m")]
///     level: f64,
///     #[unit("bar")]
///     pressure: f64,
/// }
///
/// let tank = Hybrid::new()
///     .mode("fills", |_t, x: &Tank| Tank { level: 0.4, pressure: 0.2 - x.pressure })
///     .edge("fills", "fills", |_t, x| 2.0 - x.level, |_t, x| Tank { level: 0.0, ..*x });
/// let run = Simulation::of(&tank).run("fills", Tank { level: 1.0, pressure: 3.0 }, 0.0..12.0)?;
///
/// let svg = Panels::of(&run.trajectory).svg()?;
/// assert!(svg.contains(">level (m)<") && svg.contains(">pressure (bar)<") && svg.contains("Time (s)"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Limits
/// A run that never ends is drawn until a little after its last jump. Modes that carry numbers are
/// one mode; of more than twelve modes the lane is left out. Of more than eight coordinates in one
/// panel none has a name of its own.
pub struct Panels<'a, M, E, S> {
    trajectory: &'a Trajectory<M, E, S>,
    title: String,
    captions: Vec<String>,
    named: Vec<String>,
    groups: Vec<Vec<Coordinate>>,
    over: Option<Range<f64>>,
    time: Measure,
    background: Background,
}

impl<M, E, S> fmt::Debug for Panels<'_, M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { title, groups, over, .. } = self;
        f.debug_struct("Panels")
            .field("title", title)
            .field("groups", groups)
            .field("over", over)
            .finish_non_exhaustive()
    }
}

impl<'a, M: Copy + fmt::Debug, E, S: State> Panels<'a, M, E, S> {
    /// The picture of all coordinates of a run over all of its time.
    #[must_use]
    pub const fn of(trajectory: &'a Trajectory<M, E, S>) -> Self {
        Self {
            trajectory,
            title: String::new(),
            captions: Vec::new(),
            named: Vec::new(),
            groups: Vec::new(),
            over: None,
            time: Measure::Time,
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

    /// Names the coordinates in order, units in brackets at the end, as tables do; those left over
    /// keep the names of the state.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// let swing = Hybrid::new().mode("swing", |_t, x: &[f64; 2]| [x[1], -9.81 * x[0].sin()]);
    /// let run = Simulation::of(&swing).run("swing", [0.5, 0.0], 0.0..4.0)?;
    /// let svg = saltus_plot::Panels::of(&run.trajectory).named(["angle (rad)", "rate (rad/s)"]).svg()?;
    /// assert!(svg.contains(">angle (rad)<") && svg.contains(">rate (rad/s)<"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn named<N: Into<String>>(mut self, names: impl IntoIterator<Item = N>) -> Self {
        self.named = names.into_iter().map(Into::into).collect();
        self
    }

    /// Adds a panel with these coordinates, by name or place; what is in no panel is then not
    /// drawn.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// let line = Hybrid::new().mode("go", |_t, _x: &[f64; 3]| [1.0, 2.0, 3.0]);
    /// let run = Simulation::of(&line).run("go", [0.0; 3], 0.0..4.0)?;
    /// let svg = saltus_plot::Panels::of(&run.trajectory).panel([0, 2]).svg()?;
    /// assert!(svg.contains(">x0<") && svg.contains(">x2<") && !svg.contains(">x1<"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn panel<C: Into<Coordinate>>(mut self, coordinates: impl IntoIterator<Item = C>) -> Self {
        self.groups.push(coordinates.into_iter().map(Into::into).collect());
        self
    }

    /// Draws this part only, in the unit of time of the model.
    #[must_use]
    pub fn over(mut self, part: Range<f64>) -> Self {
        self.over = Some(part);
        self
    }

    /// The unit in which the model counts time; seconds without it.
    #[must_use]
    pub fn time(mut self, unit: impl Into<Measure>) -> Self {
        self.time = unit.into();
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
    /// [`PlotError::Coordinate`] for one that there is not, [`PlotError::Names`] for more names
    /// than coordinates, [`PlotError::Window`] and [`PlotError::Missing`] where there is no time to
    /// draw, [`PlotError::NotFinite`] naming the number at fault.
    pub fn svg(&self) -> Result<String, PlotError> {
        let labels = labels(self.trajectory, &self.named)?;
        let groups = if self.groups.is_empty() {
            grouped(&labels)
        } else {
            let all = |group: &Vec<Coordinate>| {
                group.iter().map(|meant| places(meant, &labels)).collect::<Result<Vec<_>, _>>().map(|all| all.concat())
            };
            self.groups.iter().map(all).collect::<Result<Vec<_>, _>>()?
        };
        if groups.iter().all(Vec::is_empty) {
            return Err(PlotError::Empty);
        }
        let drawn: Vec<usize> = groups.concat();
        let traced = Traced::of(self.trajectory, self.over.as_ref(), &drawn)?;
        let labels: Vec<Label> = drawn.iter().map(|&place| labels[place].clone()).collect();
        // From here on a coordinate is its place among those drawn.
        let mut next = 0..drawn.len();
        let groups: Vec<Vec<usize>> = groups.iter().map(|group| next.by_ref().take(group.len()).collect()).collect();
        page::draw(&page::Content {
            title: &self.title,
            captions: &self.captions,
            labels: &labels,
            groups: groups.into_iter().filter(|group| !group.is_empty()).collect(),
            traced: &traced,
            time: &self.time,
            background: self.background,
        })
    }
}

/// The coordinates that share a panel: those of one list; of very many those of one unit.
fn grouped(labels: &[Label]) -> Vec<Vec<usize>> {
    let by = |same: fn(&Label, &Label) -> bool| {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for (place, label) in labels.iter().enumerate() {
            match groups.iter_mut().find(|group| same(&labels[group[0]], label)) {
                Some(group) => group.push(place),
                None => groups.push(vec![place]),
            }
        }
        groups
    };
    let groups = by(|a, b| a.unit == b.unit && a.list().is_some() && a.list() == b.list());
    if groups.len() > MOST_PANELS { by(|a, b| a.unit == b.unit) } else { groups }
}
