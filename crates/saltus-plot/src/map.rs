//! A quantity over two others, in tones.

use crate::axis::{nice, typeset};
use crate::error::{PlotError, finite};
use crate::heading::Sign;
use crate::measure::Measure;
use crate::place::Place;
use crate::svg::number;

/// A quantity over a grid of two others.
///
/// ```
/// use saltus_plot::{Chart, Map, Measure};
/// // How long a ball bounces: by its restitution, and by the height it falls from.
/// let (cors, heights) = ([0.3, 0.5, 0.7], [0.5, 1.0]);
/// let lasts = |e: f64, h: f64| Some((2.0 * h / 9.81).sqrt() * (1.0 + e) / (1.0 - e));
/// let values = heights.iter().flat_map(|&h| cors.map(|e| lasts(e, h))).collect();
/// let map = Map::new("Rest after", Measure::Time, cors, heights, values);
/// let svg = Chart::new("How long", ("COR", Measure::Number), ("Height", Measure::Length)).map(map).svg()?;
/// assert!(svg.contains("Rest after (s)") && svg.contains("fill-opacity"));
/// # Ok::<(), saltus_plot::PlotError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    label: String,
    measure: Measure,
    /// The middles of the cells, across and up.
    pub(crate) middles: [Vec<f64>; 2],
    /// Row by row, each across.
    values: Vec<Option<f64>>,
}

/// The most tones that an eye tells apart on one page.
const TONES: usize = 7;
/// The opacity of the palest tone: a cell of it is no empty one.
const PALEST: f64 = 0.1;

impl Map {
    /// The quantity called `label`: its values row by row, at each of `up` for all of `across`;
    /// where there is none the cell stays empty.
    #[must_use]
    pub fn new(
        label: &str,
        measure: Measure,
        across: impl Into<Vec<f64>>,
        up: impl Into<Vec<f64>>,
        values: Vec<Option<f64>>,
    ) -> Self {
        Self { label: label.to_owned(), measure, middles: [across.into(), up.into()], values }
    }

    /// Checks every number; refuses values that do not fill the grid.
    pub(crate) fn check(&self) -> Result<(), PlotError> {
        if self.values.len() != self.middles[0].len() * self.middles[1].len() {
            return Err(PlotError::Missing(
                "a map has a value or none for each cell: give as many as there are across times up",
            ));
        }
        for (axis, middles) in ["across", "up"].into_iter().zip(&self.middles) {
            for (n, &middle) in middles.iter().enumerate() {
                finite(middle, || format!("value {} {axis} of the map", n + 1))?;
            }
            if !middles.is_sorted_by(|a, b| a < b) {
                return Err(PlotError::Missing("the values across and up of a map are to rise"));
            }
        }
        for (n, &value) in self.values.iter().enumerate() {
            value.map_or(Ok(0.0), |value| finite(value, || format!("cell {} of the map", n + 1)))?;
        }
        if self.values.iter().all(Option::is_none) { Err(PlotError::Empty) } else { Ok(()) }
    }

    /// The edges of the cells, across or up: half way between the middles, by factors where the
    /// axis goes by powers of ten.
    pub(crate) fn edges(&self, axis: usize, logarithmic: bool) -> Vec<f64> {
        let middles = &self.middles[axis];
        let [there, back]: [fn(f64) -> f64; 2] = if logarithmic { [f64::ln, f64::exp] } else { [|v| v, |v| v] };
        let between = middles.windows(2).map(|pair| 0.5 * (there(pair[0]) + there(pair[1])));
        let mut edges: Vec<f64> = between.collect();
        let (first, last) = (there(middles[0]), there(middles[middles.len() - 1]));
        // A single cell is as wide as its value, or one.
        let alone = if first == 0.0 { 0.5 } else { 0.5 * first.abs() };
        let [before, behind] = [edges.first().map(|e| e - first), edges.last().map(|e| last - e)];
        edges.insert(0, first - before.unwrap_or(alone));
        edges.push(last + behind.unwrap_or(alone));
        edges.into_iter().map(back).collect()
    }

    /// The tones from pale to full, each from a value on.
    fn tones(&self) -> Tones {
        let values = || self.values.iter().flatten().copied();
        let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let unit = self.measure.unit((low, high));
        let (low, high) = (low / unit.size, high / unit.size);
        let whole = self.measure == Measure::Count;
        // One class takes the value on its upper edge as well only where it is the last.
        let mut step = nice((high - low) / TONES as f64);
        if whole {
            step = step.max(1.0);
        }
        let base = (low / step).floor();
        let count = ((high / step).floor() - base) as usize + 1;
        Tones { size: unit.size, unit: unit.label, step, base, count: count.min(2 * TONES), whole }
    }

    /// The legend: what is shown, and what each tone stands for.
    pub(crate) fn legend(&self) -> Vec<(Sign, String)> {
        let tones = self.tones();
        let name = if tones.unit.is_empty() { self.label.clone() } else { format!("{} ({})", self.label, tones.unit) };
        let tone = |k: usize| (Sign::Tone(tones.alpha(k)), tones.text(k));
        std::iter::once((Sign::Nothing, format!("{name}:"))).chain((0..tones.count).map(tone)).collect()
    }

    /// The cells of each tone as one path, neighbours in a row as one rectangle.
    pub(crate) fn cells(&self, on: &Place) -> Vec<(f64, String)> {
        let tones = self.tones();
        let [across, up] = [0, 1].map(|axis| self.edges(axis, on.logarithmic[axis]));
        let columns = self.middles[0].len();
        let mut paths = vec![String::new(); tones.count];
        for (j, row) in self.values.chunks(columns).enumerate() {
            let mut i = 0;
            while i < columns {
                let tone = row[i].map(|value| tones.of(value));
                let same = row[i..].iter().take_while(|value| value.map(|value| tones.of(value)) == tone).count();
                if let Some(tone) = tone {
                    let ((x0, y0), (x1, y1)) = (on.at([across[i], up[j]]), on.at([across[i + same], up[j + 1]]));
                    let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(|px| number(px, 2));
                    paths[tone].push_str(&format!("M{x0} {y0}H{x1}V{y1}H{x0}Z"));
                }
                i += same;
            }
        }
        paths.into_iter().enumerate().map(|(k, path)| (tones.alpha(k), path)).collect()
    }
}

struct Tones {
    size: f64,
    unit: String,
    step: f64,
    /// The lower edge of the first, in steps.
    base: f64,
    count: usize,
    whole: bool,
}

impl Tones {
    fn of(&self, value: f64) -> usize {
        (((value / self.size / self.step).floor() - self.base).max(0.0) as usize).min(self.count - 1)
    }

    fn alpha(&self, k: usize) -> f64 {
        if self.count == 1 { 1.0 } else { PALEST + (1.0 - PALEST) * k as f64 / (self.count - 1) as f64 }
    }

    fn text(&self, k: usize) -> String {
        let decimals = (-(self.step.log10() + 1e-9).floor()).clamp(0.0, 12.0) as usize;
        let edge = |k: usize| typeset(&format!("{:.decimals$}", (self.base + k as f64) * self.step));
        if self.whole && self.step == 1.0 { edge(k) } else { format!("{}–{}", edge(k), edge(k + 1)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(values: Vec<Option<f64>>) -> Map {
        Map::new("m", Measure::Count, [1.0, 2.0, 4.0], [1.0, 10.0], values)
    }

    #[test]
    fn cells_meet_half_way() {
        let map = map(vec![Some(1.0); 6]);
        assert_eq!(map.edges(0, false), [0.5, 1.5, 3.0, 5.0]);
        let up = map.edges(1, true);
        assert!(up.iter().zip([0.316, 3.16, 31.6]).all(|(a, b)| (a / b - 1.0).abs() < 1e-2), "{up:?}");
    }

    #[test]
    fn whole_numbers_have_a_tone_each() {
        let map = map([3.0, 4.0, 5.0, 6.0, 6.0].map(Some).into_iter().chain([None]).collect());
        let words: Vec<_> = map.legend().into_iter().map(|(_, words)| words).collect();
        assert_eq!(words, ["m:", "3", "4", "5", "6"]);
    }

    #[test]
    fn a_map_that_is_not_filled_is_refused() {
        assert!(map(vec![Some(1.0); 5]).check().is_err());
        assert_eq!(map(vec![None; 6]).check(), Err(PlotError::Empty));
        let falls = Map::new("m", Measure::Number, [2.0, 1.0], [1.0], vec![Some(1.0); 2]);
        assert!(falls.check().is_err());
    }
}
