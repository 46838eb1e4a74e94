//! Conditions of a drop that are no setting of it.

use super::{Column, Columns, Kind};
use crate::read::aside::Why;
use crate::read::phrases::Phrase;
use crate::read::region::Region;
use crate::read::vocabulary::folded;
use crate::read::words::pieces;

/// Temperatures that differ by less, in degrees, are those of one room through the day: nobody
/// cools or warms a ball by so little.
const ROOM: f64 = 3.0;

impl Columns {
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
            if high > low && high - low < ROOM {
                self.leave(index, Why::Other);
            }
        }
    }
}
