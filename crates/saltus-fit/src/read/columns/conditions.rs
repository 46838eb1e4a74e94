//! Conditions of a drop that are no setting of it.

use super::{Column, Columns, Kind};
use crate::read::aside::Why;
use crate::read::cell::Cell;
use crate::read::heading::{At, Value, What};
use crate::read::phrases::Phrase;
use crate::read::region::Region;
use crate::read::units::Scale;
use crate::read::vocabulary::folded;
use crate::read::words::pieces;

/// Temperatures that differ by no more, in degrees, are those of one room through the day: nobody
/// cools or warms a ball by so little.
const ROOM: f64 = 3.0;

impl Columns {
    /// Cells that all bear degrees, or a unit of pressure, are conditions, whatever stands above.
    pub(super) fn states(&mut self, region: &Region<'_>) {
        for index in 0..self.columns.len() {
            let unit = |&row: &usize| match region.view.read(row, index) {
                Cell::Empty => None,
                Cell::Number(m) => Some(m.unit.is_some_and(|unit| unit.scale == Scale::State)),
                _ => Some(false),
            };
            let mut states = region.rows.iter().filter_map(unit).peekable();
            let column = &mut self.columns[index];
            let open = matches!(column.kind, Kind::Aside | Kind::Setting | Kind::Value(_)) && !column.heading.turns();
            if open && column.heading.unit.is_none() && states.peek().is_some() && states.all(|state| state) {
                (column.kind, column.heading.unknown) = (Kind::Setting, Vec::new());
            }
        }
    }

    /// Where a line states the height of release by a sign that counts, `Drop height H1`, heights
    /// of later signs count from there: `H2` is that of the first bounce.
    pub(super) fn signed(&mut self, region: &Region<'_>) {
        let Some(first) = region.drop.as_ref().map(|drop| drop.sign).filter(|sign| *sign > 0) else { return };
        let letter = |c: &Column| c.heading.text.trim_start().starts_with(['h', 'H']);
        let nth = |v: &Value| match v.at {
            At::Nth(n) if v.what == What::Height && v.trial.is_empty() => Some(n),
            _ => None,
        };
        let later: Vec<(usize, usize)> = self.values().filter_map(|(n, _, v)| Some((n, nth(v)?))).collect();
        let counts = |&(index, n): &(usize, usize)| n > first && letter(&self.columns[index]);
        if !later.iter().all(counts) {
            return;
        }
        let alone = later.len() == 1;
        for (index, n) in later {
            if let Kind::Value(value) = &mut self.columns[index].kind {
                value.at = if alone && n == first + 1 { At::Row } else { At::Nth(n - first) };
            }
        }
    }

    /// The temperature of the room beside each drop sets nothing: it is left aside, and the CORs
    /// are compared by it as by any other column.
    pub(super) fn room(&mut self, region: &Region<'_>) {
        // Or a word that ends in it: `Raumtemperatur`.
        let named = |word: &str| Phrase::Temperature.all().iter().any(|warmth| word.ends_with(warmth));
        let warmth = |c: &Column| pieces(&c.heading.text).iter().any(|word| named(&folded(word)));
        for index in 0..self.columns.len() {
            let column = &self.columns[index];
            if column.kind != Kind::Setting || !warmth(column) {
                continue;
            }
            let (low, high) = region
                .numbers(index)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), n| (low.min(n), high.max(n)));
            if high > low && high - low <= ROOM {
                self.leave(index, Why::Other);
            }
        }
    }
}
