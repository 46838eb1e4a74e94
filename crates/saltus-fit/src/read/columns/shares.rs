//! Ratios of heights, where they are all there is: a table of them alone, or beside the heights of
//! release.

use super::{Column, Columns, Kind};
use crate::error::TableError;
use crate::finding::Note;
use crate::quantity::STANDARD_GRAVITY;
use crate::read::aside::Why;
use crate::read::cell::Cell;
use crate::read::grid::shown;
use crate::read::heading::{At, Heading, Of, Role, Value, What};
use crate::read::region::Region;
use crate::read::sequence::LEVEL;
use crate::read::units::{Dimension, Scale, Unit};
use crate::read::vocabulary::Atom;
use crate::read::written::{rounds_to, step};
use crate::statistics::median;

/// Whether numbers are parts of the first height, by how they fall from the whole: each is about as
/// large a part of the one before as the first is of the whole, where parts of the height before
/// stay. So its part is nearer to that of the first than to all, or to the square of it.
fn of_the_first(numbers: &[f64], whole: f64) -> bool {
    // A first number that is all of it is the release itself.
    let released = numbers.first() == Some(&whole);
    let Some(first) = numbers.iter().find(|number| **number < whole).map(|number| number / whole) else { return false };
    let falls = |pair: &[f64]| {
        let squared = (pair[1] / pair[0]).powi(2);
        pair[1] < LEVEL * pair[0] && (released || squared < first && squared > first.powi(3))
    };
    numbers.len() > 1 && numbers.windows(2).all(falls)
}

/// Whether each number of a column is written with the sign of hundredths.
pub(super) fn of_hundredths(region: &Region<'_>, column: usize) -> bool {
    let unit = |row: &usize| match region.view.read(*row, column) {
        Cell::Number(m) => Some(m.unit.is_some_and(|unit| unit.scale == Scale::Percent)),
        _ => None,
    };
    let mut units = region.rows.iter().filter_map(unit).peekable();
    units.peek().is_some() && units.all(|percent| percent)
}

impl Columns {
    /// Hundredths beside heights of several trials follow from their mean.
    pub(super) fn hundredths_of_repeats(&mut self) {
        let percent = |c: &Column| c.unit.is_some_and(|unit| unit.scale == Scale::Percent);
        let high = |v: &Value| v.what == What::Height && v.at == At::Row;
        let repeated = |(_, c, v): (usize, &Column, &Value)| high(v) && !percent(c) && !v.trial.is_empty();
        if !self.values().any(repeated) {
            return;
        }
        let alone = |v: &Value| high(v) && v.trial.is_empty() && v.group.is_empty();
        let found: Vec<usize> = self.values().filter(|(_, c, v)| percent(c) && alone(v)).map(|(n, _, _)| n).collect();
        found.into_iter().for_each(|index| self.leave(index, Why::Derived));
    }

    /// The one column of ratios of heights of a table that has no other readings is read: as
    /// heights of which the release is the whole, where all are parts of it and bounces are counted
    /// or listed as they fall; else each row is a drop, and there may be a column for each trial.
    pub(super) fn shares(&mut self, region: &Region<'_>) {
        let read = |c: &Column| c.heading.unknown.is_empty() && c.value().is_some_and(|v| v.role != Role::Error);
        let released = |c: &Column| c.value().is_some_and(|v| v.what == What::Height && v.at == At::Release);
        let counted = self.number().is_some_and(|(_, sure)| sure);
        let metres = self.columns.iter().any(|c| released(c) && !c.heading.unit.is_none_or(Unit::unscaled));
        if metres && !counted {
            // Hundredths of the height of release beside it.
            for column in &mut self.columns {
                let hundredths = column.heading.unit.is_some_and(|unit| unit.scale == Scale::Percent);
                if hundredths && column.value().is_some_and(|v| v.what == What::Height && v.role == Role::Reading) {
                    column.kind = Kind::Share;
                }
            }
        }
        if self.columns.iter().any(|c| read(c) && !released(c)) {
            return;
        }
        let shares = |n: &usize| self.columns[*n].kind == Kind::Aside && self.columns[*n].heading.share.is_some();
        let found: Vec<usize> = (0..self.columns.len()).filter(shares).collect();
        let trials: Vec<String> = found.iter().map(|&n| self.columns[n].heading.trial()).collect();
        let apart = |(n, trial): (usize, &String)| !trial.is_empty() && !trials[..n].contains(trial);
        let Some(&index) = found.first() else { return };
        if found.len() > 1 && !trials.iter().enumerate().all(apart) {
            return;
        }
        let percent = self.is_percent(region, index);
        let whole = if percent { 100.0 } else { 1.0 };
        let numbers = |index: usize| region.numbers(index).collect::<Vec<f64>>();
        let of = self.columns[index].heading.share;
        let part = |n: &usize| {
            let numbers = numbers(*n);
            let alike = self.columns[*n].heading.share == of && self.is_percent(region, *n) == percent;
            alike && !numbers.is_empty() && numbers.iter().all(|&value| value > 0.0 && value <= whole)
        };
        if !found.iter().all(part) {
            return;
        }
        let first = numbers(index);
        let alone = self.columns.iter().all(|c| matches!(c.kind, Kind::Aside | Kind::Number { .. }));
        let listed = alone && first.windows(2).all(|pair| pair[1] < LEVEL * pair[0]);
        let said = self.columns[index].heading.has(Atom::Before);
        let whole_first = of == Some(Of::Release) || !said && of_the_first(&first, whole);
        let series = whole_first && (counted || listed) && !self.columns.iter().any(released);
        for (index, trial) in found.into_iter().zip(trials) {
            let name = shown(&self.columns[index].heading.text);
            let column = &mut self.columns[index];
            column.unit = if percent { Unit::parse("%") } else { Some(Unit::WHOLE) };
            column.kind = if series { Kind::Value(Value { trial, ..Value::of(What::Height) }) } else { Kind::Share };
            self.aside.retain(|aside| aside.name != name);
            self.notes.push(Note::Share { column: name, of_release: series });
        }
    }

    /// Whether heights stand for ratios only.
    pub(in crate::read) fn of_ratios(&self) -> bool {
        self.columns.iter().any(|c| c.kind == Kind::Share || c.value().is_some() && c.unit == Some(Unit::WHOLE))
    }

    /// Whether a column holds hundredths, by its heading or its cells.
    fn is_percent(&self, region: &Region<'_>, index: usize) -> bool {
        let percent = |unit: Option<Unit>| unit.is_some_and(|unit| unit.scale == Scale::Percent);
        let cell = |row: &usize| matches!(region.view.read(*row, index), Cell::Number(m) if percent(m.unit));
        percent(self.columns[index].heading.unit) || region.rows.iter().any(cell)
    }

    /// Two columns of parts of the same drops are a question, unless they say the same: what was
    /// kept beside what was lost.
    pub(super) fn unique_shares(&mut self, region: &Region<'_>) -> Result<(), TableError> {
        let name = |columns: &Columns, n: usize| {
            let heading = &columns.columns[n].heading;
            (heading.trial(), heading.value().map(|value| value.group.clone()))
        };
        let mut kept: Vec<usize> = Vec::new();
        for second in self.all(&Kind::Share).collect::<Vec<usize>>() {
            let Some(place) = kept.iter().position(|&first| name(self, first) == name(self, second)) else {
                kept.push(second);
                continue;
            };
            let first = kept[place];
            if !self.same_parts(region, first, second) {
                let of = shown(&self.columns[second].heading.text);
                let message = format!("'{of}' is of the same drops as a column before it");
                let help = "name trials by numbers, or balls by their names (--header); '-' leaves a column aside";
                return Err(region.header_error(second, message).question().help(help));
            }
            let lost = self.columns[first].heading.has(Atom::Lost);
            kept[place] = if lost { second } else { first };
            self.leave(if lost { first } else { second }, Why::Elsewhere);
        }
        Ok(())
    }

    /// Whether two columns hold the same part of a height in each row that has both, and there is
    /// one: each is off by half of what they are rounded to.
    fn same_parts(&self, region: &Region<'_>, first: usize, second: usize) -> bool {
        let part = |row: usize, n: usize| {
            let whole = if self.is_percent(region, n) { 100.0 } else { 1.0 };
            let part = region.view.number(row, n)? / whole;
            Some(if self.columns[n].heading.has(Atom::Lost) { 1.0 - part } else { part })
        };
        let pairs = region.rows.iter().filter_map(|&row| Some((part(row, first)?, part(row, second)?)));
        let (a, b): (Vec<f64>, Vec<f64>) = pairs.unzip();
        let off = step(a.iter().copied()) + step(b.iter().copied());
        !a.is_empty() && a.iter().zip(&b).all(|(a, b)| rounds_to(*a, *b, off))
    }
}

/// Whether heights side by side, or flights by how high they rise, are level with one another, and
/// well below the release, or `below` where it stands in no column: repeats, and not bounces.
pub(in crate::read) fn level(region: &Region<'_>, drop: Option<usize>, nth: &[usize], below: bool) -> bool {
    let ratios = |pairs: &[(usize, usize)]| {
        let all = pairs.iter().flat_map(|&(a, b)| parts(region, a, b));
        median(&mut all.collect::<Vec<f64>>())
    };
    let later: Vec<(usize, usize)> = nth.windows(2).map(|w| (w[0], w[1])).collect();
    let below = drop.map_or(below, |drop| ratios(&[(drop, nth[0])]).is_some_and(|first| first < LEVEL));
    below && ratios(&later).is_some_and(|later| later > LEVEL && later * LEVEL < 1.0)
}

/// Whether the numbers of every row fall from column to column.
pub(in crate::read) fn falling(region: &Region<'_>, nth: &[usize]) -> bool {
    nth.windows(2).all(|pair| parts(region, pair[0], pair[1]).iter().all(|part| *part < 1.0))
}

/// What part of the height in column `a` the one in column `b` is, row by row, each in its unit
/// where both have one; a flight of T rises g T²/8.
fn parts(region: &Region<'_>, a: usize, b: usize) -> Vec<f64> {
    let unit = |n: usize| region.header.get(n).and_then(|name| Heading::parse(name).unit);
    let (of_a, of_b) = unit(a).zip(unit(b)).unzip();
    let height = |unit: Option<Unit>, value: f64| match unit {
        Some(unit) if unit.dimension == Dimension::Time => STANDARD_GRAVITY * unit.si(value).powi(2) / 8.0,
        Some(unit) => unit.si(value),
        None => value,
    };
    let part =
        |&row: &usize| Some(height(of_b, region.view.number(row, b)?) / height(of_a, region.view.number(row, a)?));
    region.rows.iter().filter_map(part).collect()
}

/// Whether heights side by side that look level are as well those of bounces that lose as little:
/// each is nearer to the part of the one before that the first is of the release than to all of it.
pub(in crate::read) fn either(region: &Region<'_>, drop: usize, nth: &[usize]) -> bool {
    let ratio = |a: usize, b: usize| median(&mut parts(region, a, b));
    let Some(first) = nth.first().and_then(|&n| ratio(drop, n)) else { return false };
    let mut later: Vec<f64> = nth.windows(2).filter_map(|w| ratio(w[0], w[1])).collect();
    median(&mut later).is_some_and(|later| later < 1.0 && (later / first).ln().abs() < later.ln().abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parts of the release are powers of one number, to within what a COR changes by; those of the
    /// height before stay, or fall as slowly as a COR does.
    #[test]
    fn powers_of_one_number_are_parts_of_the_first_height() {
        for e in [0.5, 0.64, 0.75] {
            for by in [0.97f64, 1.0, 1.03] {
                let nth = |n: i32| e * by.powi(n - 1);
                let first: Vec<f64> = (1..6).map(|n| (1..=n).map(nth).product()).collect();
                let before: Vec<f64> = (1..6).map(|n| e * 0.94f64.powi(n - 1)).collect();
                assert!(of_the_first(&first, 1.0), "{first:?}");
                assert!(!of_the_first(&before, 1.0), "{before:?}");
            }
        }
        assert!(of_the_first(&[100.0, 80.0, 40.0], 100.0) && !of_the_first(&[64.0], 100.0));
        // Level numbers are of drops that repeat each other.
        assert!(!of_the_first(&[100.0, 97.0, 96.0], 100.0));
    }
}
