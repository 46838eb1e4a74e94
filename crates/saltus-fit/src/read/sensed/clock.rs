//! When samples were taken: by a column of times, or by the rate that is stated.

use crate::read::ReadOptions;
use crate::read::heading::{Heading, What};
use crate::read::region::Region;
use crate::read::units::{Dimension, Unit};
use crate::statistics::median;

/// Samples no further apart than this, s, show contacts: slower ones miss most of them.
const SLOWEST: f64 = 0.0101;
/// Fewer samples than these are none of a sensor: at the slowest, one second.
const SAMPLES: usize = 100;
/// Samples are no further apart than so many usual steps: in a wider gap a contact may be missed.
const GAP: f64 = 3.0;

/// The clock of samples.
pub(super) struct Clock {
    /// The column that holds it, unless the rate is stated.
    pub(super) column: Option<usize>,
    /// The rows that bear a sample,
    pub(super) rows: Vec<usize>,
    /// when each was taken, s,
    times: Vec<f64>,
    /// and the time between samples, on average, s.
    pub(super) step: f64,
}

/// The rows that bear a time, and their times, s, in a column that holds times.
pub(super) fn times(
    region: &Region<'_>,
    options: &ReadOptions,
    heading: &Heading,
    column: usize,
) -> Option<(Vec<usize>, Vec<f64>)> {
    let timed = |unit: &Unit| unit.dimension == Dimension::Time;
    let named = heading.unit.or_else(|| Unit::parse(heading.text.trim())).filter(timed);
    let time = heading.value().is_some_and(|v| matches!(v.what, What::Time | What::Total));
    let given = || options.time_unit.as_deref().and_then(Unit::parse).or(region.units.0);
    let unit = named.or_else(|| time.then(|| given().filter(timed).unwrap_or(Unit::SECOND)))?;
    let read = |&row: &usize| Some((row, region.time(row, column, unit)?));
    Some(region.rows.iter().filter_map(read).unzip())
}

impl Clock {
    /// The clock of a table's samples: its first column of times that are close and in order, or
    /// the rate that is stated where no column holds times.
    pub(super) fn of(region: &Region<'_>, options: &ReadOptions, headings: &[Heading]) -> Option<Self> {
        let columns = || (0..headings.len()).filter_map(|n| Some((n, times(region, options, &headings[n], n)?)));
        columns().find_map(|(column, (rows, times))| Self::timed(column, rows, times)).or_else(|| {
            let step = region.frame.filter(|step| *step <= SLOWEST && columns().next().is_none())?;
            let number = |row: &usize| (0..headings.len()).any(|n| region.view.is_number(*row, n));
            let rows: Vec<usize> = region.rows.iter().copied().filter(number).collect();
            #[allow(clippy::cast_precision_loss)] // fewer than a table has cells
            let times: Vec<f64> = (0..rows.len()).map(|n| step * n as f64).collect();
            (rows.len() >= SAMPLES).then_some(Self { column: None, rows, times, step })
        })
    }

    /// The clock of a column of times.
    fn timed(column: usize, rows: Vec<usize>, mut times: Vec<f64>) -> Option<Self> {
        let (first, last) = (*times.first()?, *times.last()?);
        #[allow(clippy::cast_precision_loss)] // fewer than a table has cells
        let step = (last - first) / (times.len().max(2) - 1) as f64;
        #[allow(clippy::cast_precision_loss)]
        let due = |n: usize| first + step * n as f64;
        // A clock may be written to no more than a sample: then the samples are as far apart as one
        // another.
        if times.iter().enumerate().all(|(n, t)| (t - due(n)).abs() <= step) {
            (0..times.len()).for_each(|n| times[n] = due(n));
        }
        let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let usual = median(&mut steps)?;
        let runs = steps.iter().all(|apart| *apart > 0.0 && *apart < GAP * usual);
        let close = step > 0.0 && step <= SLOWEST && times.len() >= SAMPLES;
        (close && runs).then_some(Self { column: Some(column), rows, times, step })
    }

    /// The time at a place among the samples, s: at its number times the usual step.
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub(super) fn at(&self, place: f64) -> f64 {
        let place = place / self.step;
        let before = (place.max(0.0) as usize).min(self.times.len() - 2);
        let (a, b) = (self.times[before], self.times[before + 1]);
        a + (place - before as f64) * (b - a)
    }

    /// The row of the sample nearest to a place.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // of a sample that there is
    pub(super) fn row(&self, place: f64) -> usize {
        let sample = (place / self.step).max(0.0).round() as usize;
        self.rows.get(sample).copied().unwrap_or_default()
    }
}
