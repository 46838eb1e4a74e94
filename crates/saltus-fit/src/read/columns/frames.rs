//! Counts of frames, and of samples: a clock where their rate is known, or where none is needed.

use std::cmp::Ordering;

use super::{Column, Columns, Kind};
use crate::error::TableError;
use crate::finding::Note;
use crate::read::ReadOptions;
use crate::read::aside::Why;
use crate::read::clause::names_rate;
use crate::read::grid::shown;
use crate::read::heading::{Role, Value, What};
use crate::read::region::Region;
use crate::read::sequence::LEVEL;
use crate::read::units::{Dimension, Unit};
use crate::read::vocabulary::Atom;
use crate::statistics::RATES;

/// So many rows in the order of their times are those of a film.
const FILM: usize = 20;

impl Columns {
    /// The rate of frames that stands in for one that is not stated: where heights have no scale,
    /// neither has their clock, and a COR is a ratio of either. It is the fewest that cameras film,
    /// for the time of a flight bounds its height, and the air that it allows for.
    pub(in crate::read) fn any_rate(&self, region: &Region<'_>, options: &ReadOptions) -> Option<f64> {
        let frames = self.one(&Kind::Frame).filter(|&n| !self.columns[n].heading.has(Atom::Sample))?;
        let timed = self.values().any(|(_, _, v)| matches!(v.what, What::Time | What::Interval | What::Total));
        let scaled = options.scale.is_some() || options.height_unit.is_some();
        let read = || self.values().filter(|(n, _, v)| *n != frames && v.role != Role::Error);
        let bare = |n: usize| self.unit_of(region, n).or(region.units.1).is_none_or(Unit::unscaled);
        // A film that shows no bounce lacks more than its rate.
        let turns = |n: usize| {
            let places: Vec<f64> = region.numbers(n).collect();
            let moves = |by: Ordering| places.windows(2).any(|w| w[1].partial_cmp(&w[0]) == Some(by));
            moves(Ordering::Less) && moves(Ordering::Greater)
        };
        // Frames of contacts alone tell their COR as well, but where their rates differ.
        let named = self.all(&Kind::Frame).all(|n| self.columns[n].heading.has(Atom::Impact));
        let counted = self.number().is_some_and(|(_, sure)| sure);
        let rated = self.columns.iter().any(|c| names_rate(&c.heading.text));
        let contacts = || (named || counted) && !rated && read().all(|(_, _, v)| v.what == What::Unsaid);
        let film = || read().any(|(n, _, _)| turns(n)) && read().all(|(n, _, v)| v.position && bare(n));
        (!timed && !scaled && (contacts() || film())).then_some(RATES[0])
    }

    /// Numbers in a unit of time that rise from row to row, beside places and no other clock, are
    /// times, whatever they are called.
    pub(super) fn stamped(&mut self, region: &Region<'_>) {
        let timed =
            |c: &Column| c.kind == Kind::Frame || [What::Time, What::Interval, What::Total].iter().any(|&w| c.holds(w));
        if self.columns.iter().any(timed) || !self.values().any(|(_, _, v)| v.position) {
            return;
        }
        let rises = |n: usize| {
            let times: Vec<f64> = region.numbers(n).collect();
            times.len() == region.rows.len() && times.len() >= FILM && times.windows(2).all(|pair| pair[0] < pair[1])
        };
        let clock = |(n, c): &(usize, &Column)| {
            let unit = c.heading.unit.is_some_and(|unit| unit.dimension == Dimension::Time);
            c.kind == Kind::Aside && unit && !c.heading.turns() && rises(*n)
        };
        let clocks: Vec<usize> = self.columns.iter().enumerate().filter(clock).map(|(n, _)| n).collect();
        if let [index] = *clocks.as_slice() {
            self.columns[index].kind = Kind::Value(Value::of(What::Time));
        }
    }

    /// A count of frames is a time, if nothing else is and the frame rate is known; `any` where one
    /// stands in for it.
    pub(super) fn frames(&mut self, region: &Region<'_>, fps: Option<f64>, any: Option<f64>) -> Result<(), TableError> {
        let Some(index) = self.one(&Kind::Frame) else { return Ok(()) };
        if self.values().any(|(_, _, v)| matches!(v.what, What::Time | What::Interval | What::Total)) {
            self.leave(index, Why::Other);
            return Ok(());
        }
        if fps.or(any).is_none() && self.counted_tops(region) {
            self.leave(index, Why::NoRate);
            return Ok(());
        }
        let name = shown(&self.columns[index].heading.text);
        let rate = fps.or(any).ok_or_else(|| {
            let (what, help) = if self.columns[index].heading.has(Atom::Sample) {
                ("counts samples of a sound: how many", "give the sample rate of the recording, such as --fps 44100")
            } else {
                ("counts frames: how many were filmed", "give the frame rate of the camera, such as --fps 100")
            };
            region.header_error(index, format!("the column '{name}' {what} in a second?")).question().help(help)
        })?;
        if fps.is_none() {
            self.notes.push(Note::AnyRate { column: name, rate });
        }
        let all: Vec<usize> = self.all(&Kind::Frame).collect();
        let names: Vec<String> = all.iter().map(|&n| self.columns[n].heading.labels()).collect();
        // Columns that name a ball each are of these: `golf ball (frame)` beside `tennis (frame)`.
        let apart = names.iter().enumerate().all(|(n, name)| !name.is_empty() && !names[..n].contains(name));
        let several = all.len() > 1 && apart;
        // Those that name a contact each are of one ball: `hit 1 (frame)` beside `hit 2 (frame)`.
        let contact = |&n: &usize| self.columns[n].heading.of_times();
        let contacts: Vec<Value> = if several { Vec::new() } else { all.iter().filter_map(contact).collect() };
        let distinct = contacts.iter().enumerate().all(|(n, value)| !contacts[..n].contains(value));
        if contacts.len() > 1 && contacts.len() == all.len() && distinct {
            for (n, value) in all.into_iter().zip(contacts) {
                self.columns[n].kind = Kind::Value(value);
                self.columns[n].unit = Some(Unit::frame(rate));
            }
            return Ok(());
        }
        for (n, group) in all.into_iter().zip(names).filter(|(n, _)| several || *n == index) {
            let heading = &self.columns[n].heading;
            let between = heading.has(Atom::Between) || heading.has(Atom::Interval);
            let group = if several { group } else { String::new() };
            let what = if between { What::Interval } else { What::Time };
            self.columns[n].kind = Kind::Value(Value { group, ..Value::of(what) });
            self.columns[n].unit = Some(Unit::frame(rate));
        }
        Ok(())
    }

    /// Whether heights that bounces are counted beside fall from row to row: those of tops, which
    /// tell the COR without a clock.
    fn counted_tops(&self, region: &Region<'_>) -> bool {
        let falls = |n: usize| {
            let heights: Vec<f64> = region.numbers(n).collect();
            heights.len() > 1 && heights.windows(2).all(|pair| pair[1] < LEVEL * pair[0])
        };
        let mut read = self.values().filter(|(_, _, v)| v.role != Role::Error).peekable();
        let counted = self.number().is_some_and(|(_, sure)| sure) && read.peek().is_some();
        counted && read.all(|(n, _, v)| v.what == What::Height && falls(n))
    }
}
