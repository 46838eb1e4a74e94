//! Columns of what a sensor showed at each contact, beside the times of these.

use super::Columns;
use crate::read::ReadOptions;
use crate::read::aside::Why;
use crate::read::heading::{At, Role, What};
use crate::read::region::Region;
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
}
