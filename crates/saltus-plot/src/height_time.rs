//! Height against time: measurements, model and residuals.

use crate::axis::opened;
use crate::data::{Mark, Measured, Residual};
use crate::error::{PlotError, finite};
use crate::residuals;
use crate::stroke::Stroke;
use crate::theme::{Background, LARGEST, SMALLEST};
use crate::unit::{HeightUnit, Unit};
use crate::wave::Wave;

/// One curve and what it is called.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Motion {
    pub(crate) label: String,
    pub(crate) strokes: Vec<Stroke>,
}

/// A picture of height against time.
///
/// Time runs to the right, height upwards from the floor at zero, unless it is elsewhere. Each
/// motion is a line (solid, dashed, dotted, dash-dotted, in that order) in which every flight is
/// one smooth curve; measurements are marks with bars of one standard error; model contacts are
/// ticks under the floor
/// line; residuals stand in a panel of their own below. The same input gives the same bytes.
///
/// # Example
///
/// ```
/// use saltus_plot::{HeightTime, Mark, Measured, Residual, Stroke};
///
/// // A ball from 1 m that keeps half its speed.
/// let landing = (2.0_f64 / 9.8).sqrt();
/// let speed = 0.5 * 9.8 * landing;
/// let flight = 2.0 * speed / 9.8;
/// let svg = HeightTime::new("A ball from one metre")
///     .caption("COR 0.50 ± 0.01")
///     .motion(
///         "e = 0.50",
///         [
///             Stroke::over_time(0.0, landing, vec![1.0, 0.0, -4.9]),
///             Stroke::over_time(landing, flight, vec![0.0, speed, -4.9]),
///         ],
///     )
///     .measured([
///         Measured::new(0.0, 1.0).height_error(0.01).mark(Mark::Release),
///         Measured::new(0.45, 0.0).time_error(0.01).mark(Mark::Contact),
///     ])
///     .contacts([landing, landing + flight])
///     .residuals([Residual::new(0.45, -0.2).mark(Mark::Contact)])
///     .svg()?;
/// assert!(svg.contains("role=\"img\"") && svg.contains("<title"));
/// assert_eq!(svg.matches('Q').count(), 2); // two flights, two curves
/// # Ok::<(), saltus_plot::PlotError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HeightTime {
    pub(crate) title: String,
    description: Option<String>,
    pub(crate) captions: Vec<String>,
    pub(crate) motions: Vec<Motion>,
    pub(crate) measured: Vec<Measured>,
    pub(crate) contacts: Vec<f64>,
    pub(crate) grounds: Vec<Vec<Stroke>>,
    floorless: bool,
    pub(crate) wave: Option<Wave>,
    pub(crate) residuals: Vec<Residual>,
    unit: Option<HeightUnit>,
    size: Option<(f64, f64)>,
    pub(crate) background: Background,
}

impl HeightTime {
    /// A picture with a title and nothing else yet.
    #[must_use]
    pub fn new(title: &str) -> Self {
        Self {
            title: title.to_owned(),
            description: None,
            captions: Vec::new(),
            motions: Vec::new(),
            measured: Vec::new(),
            contacts: Vec::new(),
            grounds: Vec::new(),
            floorless: false,
            wave: None,
            residuals: Vec::new(),
            unit: None,
            size: None,
            background: Background::None,
        }
    }

    /// A description of the picture for those who cannot see it. Without one, a sentence is made
    /// from the data.
    #[must_use]
    pub fn description(mut self, text: &str) -> Self {
        self.description = Some(text.to_owned());
        self
    }

    /// Adds a curve. The first is solid, the next dashed, then dotted, then dash-dotted.
    #[must_use]
    pub fn motion(mut self, label: &str, strokes: impl IntoIterator<Item = Stroke>) -> Self {
        self.motions.push(Motion { label: label.to_owned(), strokes: strokes.into_iter().collect() });
        self
    }

    /// Adds measurements.
    #[must_use]
    pub fn measured(mut self, points: impl IntoIterator<Item = Measured>) -> Self {
        self.measured.extend(points);
        self
    }

    /// Adds the times (s) at which the model touches the floor.
    #[must_use]
    pub fn contacts(mut self, times: impl IntoIterator<Item = f64>) -> Self {
        self.contacts.extend(times);
        self
    }

    /// Adds where the floor is, in place of the one at height zero: one that moves, or what is
    /// below a ball that travels. Contacts are marked on the floor that is nearest to a motion.
    #[must_use]
    pub fn ground(mut self, strokes: impl IntoIterator<Item = Stroke>) -> Self {
        self.grounds.push(strokes.into_iter().collect());
        self
    }

    /// The sound that the times were read off, above the heights: the lowest and the highest sample
    /// of stretches of `step` s, from a time on; its contacts are upright lines.
    #[must_use]
    pub fn wave(mut self, start: f64, step: f64, stretches: impl IntoIterator<Item = [f32; 2]>) -> Self {
        self.wave = Some(Wave { start, step, stretches: stretches.into_iter().collect() });
        self
    }

    /// No floor is drawn at height zero: there is none.
    #[must_use]
    pub fn floorless(mut self) -> Self {
        self.floorless = true;
        self
    }

    /// Whether the floor is at height zero all the time.
    pub(crate) fn is_flat(&self) -> bool {
        self.grounds.is_empty() && !self.floorless
    }

    /// The height of the floor at `t` in s under the motion that is nearest to it.
    pub(crate) fn floor(&self, t: f64) -> f64 {
        let at = |strokes: &[Stroke]| {
            let on = |stroke: &&Stroke| stroke.start().0 <= t && t <= stroke.end().0;
            let stroke = strokes.iter().find(on)?;
            let (from, to) = (stroke.start().0, stroke.end().0);
            let part = if to > from { (t - from) / (to - from) } else { 0.0 };
            Some(stroke.at(part * stroke.span).1)
        };
        let heights: Vec<f64> = self.motions.iter().filter_map(|motion| at(&motion.strokes)).collect();
        let far = |floor: f64| heights.iter().map(|height| (height - floor).abs()).fold(f64::INFINITY, f64::min);
        let floors = self.grounds.iter().filter_map(|ground| at(ground));
        floors.min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(0.0)
    }

    /// Adds a line under the title, such as the COR and its error. Long lines wrap.
    #[must_use]
    pub fn caption(mut self, text: &str) -> Self {
        self.captions.push(text.to_owned());
        self
    }

    /// Adds residuals: a panel below with the same time axis.
    #[must_use]
    pub fn residuals(mut self, residuals: impl IntoIterator<Item = Residual>) -> Self {
        self.residuals.extend(residuals);
        self
    }

    /// The unit of the height axis; without it, one is chosen from the data.
    #[must_use]
    pub fn height_unit(mut self, unit: HeightUnit) -> Self {
        self.unit = Some(unit);
        self
    }

    /// The size of the picture in px; 800 by 560 without it, or 800 by 680 with residuals.
    ///
    /// Type grows and shrinks with the picture, but never below what can be read: when there are
    /// more words than the height has room for, the picture becomes taller.
    #[must_use]
    pub fn size(mut self, width: f64, height: f64) -> Self {
        self.size = Some((width, height));
        self
    }

    /// The picture on a `background`; transparent without one.
    #[must_use]
    pub fn background(mut self, background: Background) -> Self {
        self.background = background;
        self
    }

    pub(crate) fn checked_size(&self) -> Result<(f64, f64), PlotError> {
        let default = if self.residuals.is_empty() { (800.0, 560.0) } else { (800.0, 680.0) };
        let (width, height) = self.size.unwrap_or(default);
        let fits = |side: f64| (SMALLEST..=LARGEST).contains(&side);
        if fits(width) && fits(height) { Ok((width, height)) } else { Err(PlotError::Size { width, height }) }
    }

    /// Checks every number, and gathers how far the data reach.
    pub(crate) fn bounds(&self) -> Result<Bounds, PlotError> {
        let mut time = Reach::default();
        let mut height = Reach::default();
        if self.is_flat() {
            height.include(0.0);
        }
        let motions = self.motions.iter().map(|motion| ("motion", &motion.strokes));
        let grounds = self.grounds.iter().map(|ground| ("ground", ground));
        for (m, (what, strokes)) in motions.enumerate().chain(grounds.enumerate()) {
            for (n, stroke) in strokes.iter().enumerate() {
                let [across, up] = stroke.check(|| format!("stroke {} of {what} {}", n + 1, m + 1))?;
                time.include(across.0);
                time.include(across.1);
                height.include(up.0);
                height.include(up.1);
            }
        }
        for (i, point) in self.measured.iter().enumerate() {
            point.check(i + 1)?;
            time.include(point.time - point.time_error);
            time.include(point.time + point.time_error);
            height.include(point.height - point.height_error);
            height.include(point.height + point.height_error);
        }
        for (i, &t) in self.contacts.iter().enumerate() {
            time.include(finite(t, || format!("model contact {}", i + 1))?);
        }
        for (i, residual) in self.residuals.iter().enumerate() {
            residual.check(i + 1)?;
            time.include(residual.time);
        }
        if time.low > time.high {
            return Err(PlotError::Empty);
        }
        finite(time.high - time.low, || "the length of the time axis".to_owned())?;
        finite(height.high - height.low, || "the length of the height axis".to_owned())?;
        let time = time.of_time();
        let height = match height {
            _ if height.largest() < NEAREST => Reach { low: 0.0, high: 1.0 },
            Reach { low, high } if !self.is_flat() => {
                let (low, high) = opened((low, high));
                Reach { low, high }
            }
            from_floor => from_floor,
        };
        Ok(Bounds {
            time_unit: Unit::of_time(time.largest(), time.high - time.low),
            height_unit: Unit::of_height(self.unit, height.largest(), height.high - height.low),
            time: (time.low, time.high),
            height: (height.low, height.high),
        })
    }

    /// The description given, or one made from the data.
    pub(crate) fn described(&self, bounds: &Bounds) -> String {
        if let Some(text) = &self.description {
            return text.clone();
        }
        let unit = &bounds.height_unit;
        let second = &bounds.time_unit;
        let mut text = format!(
            "Height against time, from {} to {} {}, up to {} {}.",
            short(bounds.time.0 / second.size),
            short(bounds.time.1 / second.size),
            second.label,
            short(bounds.height.1 / unit.size),
            unit.label,
        );
        let labels: Vec<_> = self.motions.iter().map(|m| m.label.as_str()).filter(|l| !l.is_empty()).collect();
        if !labels.is_empty() {
            text.push_str(&format!(" Lines: {}.", labels.join("; ")));
        }
        let counts: Vec<_> = Mark::ALL
            .into_iter()
            .map(|mark| (mark, self.measured.iter().filter(|p| p.mark == mark).count()))
            .filter(|&(_, count)| count > 0)
            .map(|(mark, count)| format!("{count} {}", plural(mark, count)))
            .collect();
        if !counts.is_empty() {
            text.push_str(&format!(" Measured: {}.", counts.join(", ")));
        }
        if !self.contacts.is_empty() {
            text.push_str(&format!(" Contacts of the model: {}.", self.contacts.len()));
        }
        if !self.residuals.is_empty() {
            text.push_str(&format!(" Below: {}.", residuals::summary(&self.residuals)));
        }
        for caption in &self.captions {
            let stop = if caption.ends_with(['.', '!', '?']) { "" } else { "." };
            text.push_str(&format!(" {caption}{stop}"));
        }
        text
    }
}

fn plural(mark: Mark, count: usize) -> &'static str {
    match (mark, count) {
        (_, 1) => mark.word(),
        (Mark::Release, _) => "releases",
        (Mark::Apex, _) => "apexes",
        (Mark::Contact, _) => "contacts",
        (Mark::Sample, _) => "readings",
    }
}

/// The number with at most four significant digits.
fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let decimals = (3.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    crate::axis::typeset(text)
}

/// The reach of the data, in seconds and metres, and the units to show them in.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) time: (f64, f64),
    pub(crate) height: (f64, f64),
    pub(crate) time_unit: Unit,
    pub(crate) height_unit: Unit,
}

/// Lengths below this are as good as zero: dividing by them would overflow.
const NEAREST: f64 = 1e-280;

/// A clock that starts at no more than this part of its end is shown from zero.
const SINCE_ZERO: f64 = 0.3;

/// The shortest time axis, as a part of the latest time: 2 ms of a clock that counts from 1970. Its
/// ticks still differ; values that differ by so little are one (`axis::opened`).
const SHORTEST: f64 = 1e-12;

#[derive(Debug, Clone, Copy)]
struct Reach {
    low: f64,
    high: f64,
}

impl Default for Reach {
    fn default() -> Self {
        Self { low: f64::INFINITY, high: f64::NEG_INFINITY }
    }
}

impl Reach {
    fn include(&mut self, value: f64) {
        self.low = self.low.min(value);
        self.high = self.high.max(value);
    }

    fn largest(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// That of a clock: back to zero where that is near, and never too narrow to have ticks.
    fn of_time(self) -> Self {
        let Self { mut low, mut high } = self;
        if self.largest() < NEAREST {
            return Self { low: 0.0, high: 1.0 };
        }
        if low > 0.0 && low <= SINCE_ZERO * high {
            low = 0.0;
        }
        let least = SHORTEST * self.largest();
        if high - low < least {
            if low > 0.0 && self.low == self.high {
                return Self { low: 0.0, high: 1.25 * high };
            }
            let middle = 0.5 * (low + high);
            low = middle - 0.5 * least;
            high = middle + 0.5 * least;
        }
        Self { low, high }
    }
}
