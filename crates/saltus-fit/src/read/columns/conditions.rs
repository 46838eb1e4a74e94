//! Conditions of a drop that are no setting of it.

use super::{Column, Columns, Kind};
use crate::read::aside::Why;
use crate::read::cell::Cell;
use crate::read::heading::{At, Value, What};
use crate::read::phrases::Phrase;
use crate::read::region::Region;
use crate::read::units::Scale;
use crate::read::vocabulary::{Atom, folded};
use crate::read::words::pieces;

/// Temperatures that differ by no more, in degrees, are those of one room through the day: nobody
/// cools or warms a ball by so little.
const ROOM: f64 = 3.0;

/// Whether a heading bears the sign of a height that counts: `h1`, `Rebound height h_2`.
fn signs(column: &Column) -> bool {
    let sign = |word: &String| {
        folded(word).strip_prefix('h').is_some_and(|n| n.chars().all(|c| c.is_ascii_digit() || c == '_'))
    };
    pieces(&column.heading.text).iter().any(sign)
}

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

    /// Where a line, or a heading, states the height of release by a sign that counts, `Drop height
    /// H1`, heights of later signs count from there: `H2` is that of the first bounce.
    pub(super) fn signed(&mut self, region: &Region<'_>) {
        let stated = region.drop.as_ref().map(|drop| drop.sign).filter(|sign| *sign > 0);
        let nth = |v: &Value| match v.at {
            At::Nth(n) if v.what == What::Height && (stated.is_none() || v.trial.is_empty()) => Some(n),
            _ => None,
        };
        let of_release = |c: &Column| c.heading.has(Atom::Release) && !c.heading.has(Atom::Rebound);
        let mut columns: Vec<(usize, usize)> = self.values().filter_map(|(n, _, v)| Some((n, nth(v)?))).collect();
        let released = columns.iter().position(|(n, _)| of_release(&self.columns[*n]) && signs(&self.columns[*n]));
        let released = released.filter(|_| stated.is_none()).map(|at| columns.remove(at));
        let Some(first) = stated.or(released.map(|(_, sign)| sign)) else { return };
        // Repeats of one height bear its sign once.
        let repeats = |c: &Column| matches!(&c.kind, Kind::Value(v) if !v.trial.is_empty());
        let letter = |c: &Column| c.heading.text.trim_start().starts_with(['h', 'H']);
        let counts = |&(index, n): &(usize, usize)| {
            let column = &self.columns[index];
            let later = match stated {
                Some(_) => letter(column),
                None => signs(column) && !of_release(column) || repeats(column),
            };
            n > first && later
        };
        if columns.is_empty() || !columns.iter().all(counts) {
            return;
        }
        let one = columns.iter().all(|(_, n)| *n == first + 1);
        for (index, n) in columns {
            if let Kind::Value(value) = &mut self.columns[index].kind {
                value.at = if one { At::Row } else { At::Nth(n - first) };
            }
        }
        if let Some(Kind::Value(value)) = released.map(|(index, _)| &mut self.columns[index].kind) {
            value.at = At::Release;
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
