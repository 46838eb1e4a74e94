//! Columns that name what was dropped, or who dropped it: balls that are one kind, and trials;
//! and trials that only the first of several columns names in full.

use std::collections::HashMap;

use super::{Column, Columns, Kind};
use crate::read::heading::{At, Heading, Role, Value, What};
use crate::read::region::Region;
use crate::read::vocabulary::{Atom, ROWS};
use crate::read::words::split;
use crate::statistics::median;

/// So many rows are named alike by no chance.
const SEVERAL: usize = 3;

/// Balls of one kind come back to heights that are off the usual one by less than this factor: a
/// COR of 0.7 that differs by 0.015 from ball to ball, as a standard deviation, gives 1.09 at two.
const SAME: f64 = 1.1;

/// What stands before the number or the letter of one of several: `ball` of `ball A`, `B` of `B01`.
fn stem(cell: &str) -> Option<&str> {
    if let Some((name, nth)) = cell.rsplit_once(' ') {
        return (nth.parse::<usize>().is_ok() || nth.len() == 1).then_some(name);
    }
    let letters = cell.trim_end_matches(|c: char| c.is_ascii_digit());
    let code = !letters.is_empty() && letters.len() < cell.len() && letters.chars().all(char::is_uppercase);
    code.then_some(letters)
}

impl Columns {
    /// `Sample` above `A` and `B` names what was dropped; above numbers it counts.
    pub(super) fn specimens(&mut self, region: &Region<'_>) {
        for index in 0..self.columns.len() {
            let column = &self.columns[index];
            if !matches!(column.kind, Kind::Setting | Kind::Trial) {
                continue;
            }
            // What stands below the numbers is a remark.
            let read = |row: usize| (0..region.header.len()).any(|n| region.view.is_number(row, n));
            // Of many rows few sum others up.
            let few = region.rows.len() <= ROWS;
            let sums = |row: usize| few && Heading::parse(region.cell(row, index)).sums_up();
            let rows: Vec<usize> = region.rows.iter().copied().filter(|&row| read(row) && !sums(row)).collect();
            let cells = || rows.iter().map(|&row| region.cell(row, index)).filter(|cell| !cell.is_empty());
            let words = |cell: &str| !cell.contains(|c: char| c.is_ascii_digit());
            let named = cells().next().is_some() && cells().all(words);
            // Balls that bear a code of their own in each row are as many of one kind.
            let numbered = column.heading.has(Atom::Number) || column.heading.has(Atom::Repeat);
            // Numbers of those who repeat it, `lab table`, are of no surface.
            let persons = column.heading.has(Atom::Repeat) && !column.heading.has(Atom::Sample);
            // A number behind a trial, or a letter or a number behind one name of balls whose drops
            // are level, tells no balls apart: `golf ball trial 1`, `ball A`.
            let counted = || {
                let named: Vec<&str> = cells().collect();
                let mut times: HashMap<&str, usize> = HashMap::new();
                named.iter().for_each(|cell| *times.entry(cell).or_default() += 1);
                // Of so few readings each that none has a COR of its own that can be believed.
                let most = times.values().max().map_or(0, |times| times * self.beside());
                let few = times.len() >= SEVERAL && named.len() == rows.len() && most < SEVERAL;
                // `1`, `2`, `3` below the name of balls at large.
                if !few || region.counts(index) {
                    return few && self.level(region, &rows);
                }
                let Some(name) = named.first().and_then(|cell| stem(cell)) else { return false };
                let alike = named.iter().all(|cell| stem(cell) == Some(name));
                let trial = split(name).last().is_some_and(|w| w.is(Atom::Trial) || w.is(Atom::Repeat));
                alike && (trial && times.len() == named.len() || self.level(region, &rows))
            };
            if column.kind == Kind::Setting && counted() {
                self.columns[index].kind = Kind::Trial;
                continue;
            }
            if column.kind == Kind::Trial && column.heading.has(Atom::Sample) && named {
                self.columns[index].kind = Kind::Setting;
            } else if column.kind == Kind::Setting
                && (numbered && region.codes(index).is_some() || persons && region.counts(index))
            {
                self.columns[index].kind = Kind::Trial;
            }
        }
    }

    /// `Time to rest, trial 1 (s)` beside `trial 2 (s)`: columns behind the first trial that say no
    /// more than which trial they are, or that they are the mean, and its unit, have its quantity.
    pub(super) fn of_one_name(&mut self) {
        let nth = |v: &Value| v.trial.rsplit(' ').next().and_then(|n| n.parse::<usize>().ok());
        for index in 0..self.columns.len() {
            let Some(first) = self.columns[index].value().filter(|v| nth(v) == Some(1)).cloned() else { continue };
            let unit = self.columns[index].unit;
            let says = [What::Height, What::Interval, What::Total, What::Time].contains(&first.what);
            if !says || self.columns[index].heading.trial_only() || !self.columns[index].heading.unknown.is_empty() {
                continue;
            }
            for (n, column) in (2..).zip(&mut self.columns[index + 1..]) {
                let same = column.unit.is_none_or(|own| Some(own) == unit) && column.heading.trial_only();
                // Behind the last of them may stand their mean.
                let mean = |v: &Value| v.role == Role::Mean && v.trial.is_empty() && n > 2;
                match &mut column.kind {
                    Kind::Value(value) if same && (nth(value) == Some(n) || mean(value)) => {
                        (value.what, value.at) = (first.what, first.at);
                        column.unit = unit;
                    }
                    _ => break,
                }
            }
        }
    }

    /// How many readings of one group a row holds, but those of release.
    fn beside(&self) -> usize {
        let read = |v: &Value| v.role == Role::Reading && !matches!(v.at, At::Release | At::Before);
        let known = |c: &Column| c.heading.unknown.is_empty();
        let groups: Vec<&str> =
            self.values().filter(|(_, c, v)| read(v) && known(c)).map(|(_, _, v)| v.group.as_str()).collect();
        let alike = |group: &&str| groups.iter().filter(|other| *other == group).count();
        groups.iter().map(alike).max().unwrap_or(1)
    }

    /// Whether what stands before bounces is level in these rows, and so are rebounds, column by
    /// column, each as a part of it.
    fn level(&self, region: &Region<'_>, rows: &[usize]) -> bool {
        let read = |v: &Value| matches!(v.what, What::Height | What::Speed) && v.role == Role::Reading;
        let (before, after): (Vec<_>, Vec<_>) =
            self.values().filter(|(_, _, v)| read(v)).partition(|(_, _, v)| matches!(v.at, At::Release | At::Before));
        let number = |row: usize, column: usize| region.view.number(row, column);
        let level = |column: usize, what: What, of: Option<usize>| {
            let part = |&row: &usize| Some(number(row, column)? / of.map_or(Some(1.0), |n| number(row, n))?);
            let power = if what == What::Speed { 2 } else { 1 };
            let mut parts: Vec<f64> = rows.iter().filter_map(part).map(|part| part.powi(power)).collect();
            let usual = median(&mut parts).unwrap_or_default();
            parts.iter().all(|part| *part < SAME * usual && usual < SAME * part)
        };
        let from = before.first().map(|(n, _, _)| *n);
        !after.is_empty()
            && from.is_none_or(|n| level(n, What::Height, None))
            && after.iter().all(|(n, _, v)| level(*n, v.what, from))
    }
}
