//! Whether trials of different balls, floors or drop heights may share one COR, and whether it
//! changes in their order.

use std::collections::{BTreeMap, BTreeSet};

use crate::elementary::ln;
use crate::read::{Event, Trial};
use crate::solve::kind::Each;
use crate::statistics::{Line, REJECT, SPARE, TREND, chi_square_p, variance_ratio_p};

/// Release heights that differ by less, as a part of them, are one.
pub(crate) const SAME_HEIGHT: f64 = 0.05;
/// CORs that differ by less differ by the rounding of their sums.
const ROUNDED: f64 = 1e-12;

/// How settings differ: the probability of that by chance, and the settings with the lowest and the
/// highest COR.
pub(crate) struct Differ {
    pub(crate) p: f64,
    /// How many more trials there are than settings.
    pub(crate) spare: usize,
    pub(crate) low: (String, f64),
    pub(crate) high: (String, f64),
}

/// Analysis of variance of the trials' own CORs by setting, each weighing by its information;
/// `None` for a single setting.
///
pub(crate) fn differ(trials: &[Trial], each: Each<'_>, cor: f64) -> Option<Differ> {
    differ_by(trials, each, cor, |trial| Some(&trial.setting))
}

/// A column that was left aside, and how the CORs differ by what stands in it: that with the least
/// probability by chance. Its values have to repeat, so that the trials of one value tell their own
/// scatter. Beside such columns a condition is looked at that is another in every row: the CORs may
/// follow its numbers.
pub(crate) fn differ_beside(trials: &[Trial], each: Each<'_>, cor: f64) -> Option<(String, Differ)> {
    let all = |of: fn(&Trial) -> &[(String, String)]| -> BTreeSet<&str> {
        trials.iter().flat_map(|trial| of(trial).iter().map(|(name, _)| &**name)).collect()
    };
    let conditions = all(|trial| &trial.conditions).into_iter().filter_map(|name| {
        let found = follow(trials, each, cor, |trial| cell(&trial.conditions, name))?;
        Some((name.to_owned(), found))
    });
    let found = all(|trial| &trial.beside).into_iter().filter_map(|name| {
        let differ = differ_by(trials, each, cor, |trial| cell(&trial.beside, name))?;
        (differ.spare > 0).then(|| (name.to_owned(), differ))
    });
    found.chain(conditions).min_by(|a, b| a.1.p.total_cmp(&b.1.p))
}

/// The cell of a column of this name.
fn cell<'a>(cells: &'a [(String, String)], name: &str) -> Option<&'a str> {
    cells.iter().find(|(other, _)| other == name).map(|(_, cell)| cell.as_str())
}

/// The straight line of the trials' own CORs over the numbers of a column, each trial weighing by
/// its information; `None` where a cell begins with no number, or the line tells no scatter about
/// it. `low` and `high` are the cells and the CORs at the ends of the line.
#[allow(clippy::cast_precision_loss)]
fn follow<'a>(
    trials: &'a [Trial],
    each: Each<'_>,
    cor: f64,
    key: impl Fn(&'a Trial) -> Option<&'a str>,
) -> Option<Differ> {
    let point = |(trial, s): (&'a Trial, &(f64, f64))| {
        let cell = key(trial)?;
        Some((cell, (s.0, leading(cell)?, s.1)))
    };
    let weighing = trials.iter().zip(each.own).filter(|(_, s)| s.0 > 0.0);
    let mut points: Vec<(&str, Point)> = weighing.map(point).collect::<Option<_>>()?;
    points.sort_by(|a, b| a.1.1.total_cmp(&b.1.1));
    let spare = points.len().checked_sub(2).filter(|spare| *spare > 0)?;
    let line = Line::through(points.iter().map(|point| point.1));
    let p = by_chance(&line, spare, each.least)?;
    let at = |(cell, point): &(&str, Point)| ((*cell).to_owned(), cor + line.at(point.1));
    let (first, last) = (at(points.first()?), at(points.last()?));
    let (low, high) = if first.1 < last.1 { (first, last) } else { (last, first) };
    (high.1 - low.1 > ROUNDED).then_some(Differ { p, spare, low, high })
}

/// The probability of a slope like that of a line by chance, where the scatter about it has so much
/// `freedom`, and a variance of no less than `least`.
#[allow(clippy::cast_precision_loss)]
fn by_chance(line: &Line, freedom: usize, least: f64) -> Option<f64> {
    let about = ((line.all - line.explained) / freedom as f64).max(least);
    variance_ratio_p(line.explained / about, 1, freedom)
}

/// The number that a cell begins with, `20` of `20 °C`.
fn leading(cell: &str) -> Option<f64> {
    let end = cell.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | ',' | '-' | '+'))).unwrap_or(cell.len());
    cell[..end].replace(',', ".").parse().ok().filter(|number: &f64| number.is_finite())
}

fn differ_by<'a>(
    trials: &'a [Trial],
    each: Each<'_>,
    cor: f64,
    key: impl Fn(&'a Trial) -> Option<&'a str>,
) -> Option<Differ> {
    let mut settings: BTreeMap<&str, (f64, f64, f64, usize)> = BTreeMap::new();
    for (trial, &(weight, shift)) in trials.iter().zip(each.own).filter(|(_, s)| s.0 > 0.0) {
        let sums = settings.entry(key(trial)?).or_default();
        *sums = (sums.0 + weight, sums.1 + weight * shift, sums.2 + weight * shift * shift, sums.3 + 1);
    }
    let above = settings.len().checked_sub(1).filter(|n| *n > 0)?;
    let all = settings.values().fold((0.0, 0.0), |a, s| (a.0 + s.0, a.1 + s.1));
    let mean = all.1 / all.0;
    let between: f64 = settings.values().map(|s| s.0 * (s.1 / s.0 - mean).powi(2)).sum();
    let within: f64 = settings.values().map(|s| s.2 - s.1 * s.1 / s.0).sum();
    let below = settings.values().map(|s| s.3 - 1).sum::<usize>();
    let p = if below >= SPARE {
        variance_ratio_p((between / above as f64) / (within / below as f64).max(each.least), above, below)?
    } else {
        chi_square_p(between, above)?
    };
    let spare = below;
    let own = || settings.iter().map(|(name, s)| ((*name).to_owned(), cor + s.1 / s.0));
    let by_cor = |a: &(String, f64), b: &(String, f64)| a.1.total_cmp(&b.1);
    let (low, high) = (own().min_by(by_cor)?, own().max_by(by_cor)?);
    (high.1 - low.1 > ROUNDED).then_some(Differ { p, spare, low, high })
}

/// A COR that changes from trial to trial in their order: the probability of that by chance, and
/// what it is at the first and at the last.
pub(crate) struct Drift {
    pub(crate) p: f64,
    pub(crate) first: f64,
    pub(crate) last: f64,
    /// Trials of one setting change: they do not repeat each other.
    pub(crate) repeats: bool,
}

/// A weight, a place in the list, the COR there less that of all.
type Point = (f64, f64, f64);

/// The straight line through the trials' own CORs, each weighing by its information, within
/// settings where trials repeat each other; arguments as for [`differ`].
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // places in a list
pub(crate) fn drift(trials: &[Trial], each: Each<'_>, cor: f64) -> Option<Drift> {
    let points = || each.own.iter().enumerate().filter(|(_, s)| s.0 > 0.0).map(|(n, s)| (s.0, n as f64, s.1));
    let release = |trial: &Trial| trial.readings.first().filter(|r| r.event == Event::Release).and_then(|r| r.height);
    // In steps of the releases that count as one.
    let step = |height: f64| (ln(height.max(f64::MIN_POSITIVE)) / SAME_HEIGHT).round() as i64;
    let mut settings: BTreeMap<(&str, Option<i64>), Vec<Point>> = BTreeMap::new();
    for (point, trial) in points().filter_map(|point| Some((point, trials.get(point.1 as usize)?))) {
        settings.entry((&trial.setting, release(trial).map(step))).or_default().push(point);
    }
    settings.retain(|_, points| points.len() > 1);
    // About the middle of their own setting.
    let about = |points: &Vec<Point>| {
        let sum = |of: &dyn Fn(&Point) -> f64| points.iter().map(of).sum::<f64>();
        let (weight, x, y) = (sum(&|p| p.0), sum(&|p| p.0 * p.1), sum(&|p| p.0 * p.2));
        points.iter().map(|p| (p.0, p.1 - x / weight, p.2 - y / weight)).collect::<Vec<_>>()
    };
    let within: Vec<Point> = settings.values().flat_map(about).collect();
    let chance = |line: &Line, count: usize, groups: usize| {
        let freedom = count.checked_sub(1 + groups).filter(|freedom| count >= TREND && *freedom > 0)?;
        by_chance(line, freedom, each.least)
    };
    let repeats = chance(&Line::through(within.iter().copied()), within.len(), settings.len()).filter(|p| *p < REJECT);
    let line = Line::through(points());
    let p = repeats.or_else(|| chance(&line, points().count(), 1))?;
    let (first, last) = (cor + line.at(0.0), cor + line.at(each.own.len() as f64 - 1.0));
    ((last - first).abs() > ROUNDED).then_some(Drift { p, first, last, repeats: repeats.is_some() })
}
