//! Columns that name what was dropped, or who dropped it: balls that are one kind, and trials;
//! and trials that only the first of several columns names in full.

use std::collections::HashSet;

use super::{Columns, Kind};
use crate::read::heading::{At, Role, Value, What};
use crate::read::region::Region;
use crate::read::vocabulary::Atom;
use crate::read::words::split;

/// So many rows are named alike by no chance.
const SEVERAL: usize = 3;

/// Balls of one kind come back to heights that are off by less than this factor: a COR of 0.9 that
/// differs by two hundredths from ball to ball gives 1.09 over ten of them.
const SAME: f64 = 1.1;

impl Columns {
    /// `Sample` above `A` and `B` names what was dropped; above numbers it counts.
    pub(super) fn specimens(&mut self, region: &Region<'_>) {
        for index in 0..self.columns.len() {
            let column = &self.columns[index];
            // What stands below the numbers is a remark.
            let read = |row: usize| (0..region.header.len()).any(|n| region.view.is_number(row, n));
            let rows: Vec<usize> = region.rows.iter().copied().filter(|&row| read(row)).collect();
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
                // `1`, `2`, `3` below the name of balls at large.
                let once = rows.len() >= SEVERAL && cells().count() == rows.len();
                if once && region.counts(index) && cells().collect::<HashSet<_>>().len() == rows.len() {
                    return self.one_height(region).then_some(());
                }
                let parts: Option<Vec<(&str, &str)>> = cells().map(|cell| cell.rsplit_once(' ')).collect();
                let parts = parts.filter(|parts| parts.len() >= SEVERAL && parts.len() == rows.len())?;
                let apart = parts.iter().map(|(_, nth)| *nth).collect::<HashSet<_>>().len() == parts.len();
                let short = |nth: &str| nth.parse::<usize>().is_ok() || nth.len() == 1;
                let alike = parts.iter().all(|(name, nth)| *name == parts[0].0 && short(nth));
                let trial = || split(parts[0].0).last().is_some_and(|w| w.is(Atom::Trial) || w.is(Atom::Repeat));
                (apart && alike && (trial() || self.one_height(region))).then_some(())
            };
            if column.kind == Kind::Setting && counted().is_some() {
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

    /// Whether all heights but those of release are of one column, and level.
    fn one_height(&self, region: &Region<'_>) -> bool {
        let read = |v: &Value| v.what == What::Height && v.at != At::Release && v.role == Role::Reading;
        let mut found = self.values().filter(|(_, _, v)| read(v)).map(|(n, _, _)| n);
        let (Some(index), None) = (found.next(), found.next()) else { return false };
        let heights = || region.numbers(index);
        heights().fold(0.0, f64::max) < SAME * heights().fold(f64::INFINITY, f64::min)
    }
}
