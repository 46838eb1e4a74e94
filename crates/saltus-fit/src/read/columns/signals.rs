//! Columns beside contacts and flights: what a sensor showed at each contact, and the heights from
//! which the ball was dropped before each flight.

use super::Columns;
use crate::quantity::STANDARD_GRAVITY;
use crate::read::ReadOptions;
use crate::read::aside::Why;
use crate::read::heading::{At, Role, Value, What};
use crate::read::region::Region;
use crate::read::sequence::LEVEL;
use crate::read::vocabulary::Atom;

/// Heights of one ball are as the squares of its flights: where these parts differ by more than
/// this factor they are of something else.
const ALIKE: f64 = 1.5;

impl Columns {
    /// `t=3479449 us peak=874`: peaks without a unit, beside times of contacts that bear one, are
    /// heights in whatever unit only where they are as the squares of the flights after them; else
    /// those of a signal.
    pub(super) fn signals(&mut self, region: &Region<'_>, options: &ReadOptions) {
        let time = self.values().find(|(_, _, v)| (v.what, v.at, v.role) == (What::Time, At::Row, Role::Reading));
        let Some((time, _, _)) = time.filter(|(n, _, _)| self.unit_of(region, *n).is_some()) else { return };
        if options.height_unit.is_some() || region.units.1.is_some() {
            return;
        }
        let bare = |n: usize| self.unit_of(region, n).is_none();
        let top = |n: usize| {
            let heading = &self.columns[n].heading;
            heading.has(Atom::Top) && !heading.has(Atom::Height) && !heading.has(Atom::Position)
        };
        let found: Vec<usize> = self.values().map(|(n, _, _)| n).filter(|&n| n != time && bare(n) && top(n)).collect();
        for index in found {
            let row = |&row: &usize| Some((region.view.number(row, time)?, region.view.number(row, index)?));
            let rows: Vec<(f64, f64)> = region.rows.iter().filter_map(row).collect();
            let parts = rows.windows(2).map(|pair| pair[0].1 / (pair[1].0 - pair[0].0).powi(2));
            let (low, high) = parts.fold((f64::INFINITY, 0.0_f64), |(low, high), part| (low.min(part), high.max(part)));
            if rows.len() > 3 && !(low > 0.0 && high < ALIKE * low) {
                self.leave(index, Why::Other);
            }
        }
    }

    /// Heights beside flights, a drop a row, of which none is that of its own flight, `height (m),
    /// flight time (s)`: the ball was dropped from there, if each flight rises to one part of it.
    pub(super) fn released(&mut self, region: &Region<'_>) {
        let of_rows = |what: What| {
            let first = |at: At| at == At::Row || what == What::Interval && at == At::Nth(1);
            let plain = move |v: &Value| (v.what, v.role) == (what, Role::Reading) && first(v.at) && v.group.is_empty();
            self.values().filter(move |(_, _, v)| plain(v)).map(|(n, c, _)| (n, c)).collect::<Vec<_>>()
        };
        let (heights, flights) = (of_rows(What::Height), of_rows(What::Interval));
        let [(height, column)] = heights.as_slice() else { return };
        let risen = [Atom::Rebound, Atom::Top, Atom::After, Atom::Impact].iter().any(|atom| column.heading.has(*atom));
        if risen || self.number().is_some() || self.any(What::Height, Some(At::Release)) {
            return;
        }
        let si = |row: usize, n: usize| Some(self.unit_of(region, n)?.si(region.view.number(row, n)?));
        let eighth = STANDARD_GRAVITY / 8.0;
        let part = |(row, n): (usize, usize)| Some(eighth * si(row, n)?.powi(2) / si(row, *height)?);
        let pairs = region.rows.iter().flat_map(|&row| flights.iter().map(move |(n, _)| (row, *n)));
        let mut parts: Vec<f64> = pairs.filter_map(part).collect();
        parts.sort_unstable_by(f64::total_cmp);
        let (Some(least), Some(most)) = (parts.first(), parts.last()) else { return };
        if parts.len() > 1 && *least > 0.0 && *most < LEVEL * LEVEL && *most < ALIKE * least {
            let height = *height;
            self.place(height, At::Release, String::new());
            self.flown();
        }
    }
}
