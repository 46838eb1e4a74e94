//! Coordinates in space: along which of them a ball falls.

use super::{Column, Columns, Kind};
use crate::finding::Note;
use crate::read::aside::Why;
use crate::read::grid::shown;
use crate::read::heading::{At, Role, Value, What};
use crate::read::region::Region;

/// A flight shows its bend over this part of a recording: a few bounces take most of it.
const STRIDE: usize = 20;

/// The sign of a coordinate that may be the vertical one: some count `y` upwards, and some `z`.
fn sign(column: &Column) -> Option<char> {
    let name = column.heading.text.split(['(', '[']).next().unwrap_or_default().trim_end();
    let letter = name.chars().next_back().map(|c| c.to_ascii_lowercase());
    let before = name.chars().rev().nth(1);
    letter.filter(|c| matches!(c, 'y' | 'z') && before.is_none_or(|c| !c.is_alphanumeric()))
}

impl Columns {
    /// Of `y` beside `z` in time the height is the one that bends most: a ball falls along it, and
    /// flies straight along the other.
    pub(super) fn vertical(&mut self, region: &Region<'_>) {
        let place = |v: &Value| v.position && v.what == What::Height && v.at == At::Row && v.role == Role::Reading;
        let found: Vec<(usize, char)> =
            self.values().filter(|(_, _, v)| place(v)).filter_map(|(n, c, _)| Some((n, sign(c)?))).collect();
        let timed = self.any(What::Time, Some(At::Row)) || self.one(&Kind::Frame).is_some();
        let most = |letter: char| {
            let own = found.iter().filter(|(_, other)| *other == letter);
            own.map(|(n, _)| bend(region, *n)).reduce(f64::max)
        };
        let (Some(y), Some(z)) = (most('y'), most('z')) else { return };
        if !timed || region.rows.len() < 2 * STRIDE {
            return;
        }
        let upright = if z > y { 'z' } else { 'y' };
        for (index, letter) in found {
            if letter == upright {
                let column = shown(&self.columns[index].heading.text);
                self.notes.push(Note::Vertical { column });
            } else {
                self.leave(index, Why::Other);
            }
        }
    }
}

/// How far places leave a straight line over a part of the recording, as a sum of squares.
fn bend(region: &Region<'_>, column: usize) -> f64 {
    let places: Vec<f64> = region.numbers(column).collect();
    let step = (places.len() / STRIDE).max(1);
    places.windows(2 * step + 1).map(|part| (part[2 * step] - 2.0 * part[step] + part[0]).powi(2)).sum()
}
