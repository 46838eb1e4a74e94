//! Columns that stand for others where nothing else is read: energies for heights, the speeds or
//! energies of one side of the impacts for those of the row, samples of a sound for times.

use super::{Columns, Kind};
use crate::finding::Note;
use crate::read::aside::Why;
use crate::read::cell::Cell;
use crate::read::grid::shown;
use crate::read::heading::{At, Role, Value, What};
use crate::read::region::Region;
use crate::read::sequence::{LEVEL, of_samples};
use crate::read::units::{Scale, Unit};
use crate::read::vocabulary::Atom;
use crate::read::words::{Word, split};

impl Columns {
    /// Energies are read as the heights that a ball has them at, where a table has no other
    /// readings: before and after a bounce, or bounce by bounce. Hundredths of it that are lost are
    /// those of the height.
    pub(super) fn energies(&mut self, region: &Region<'_>) {
        let stands = |role: Role| !matches!(role, Role::Error | Role::Lost);
        let read = |c: &super::Column| c.heading.unknown.is_empty() && c.value().is_some_and(|v| stands(v.role));
        let released = |c: &super::Column| c.value().is_some_and(|v| v.what == What::Height && v.at == At::Release);
        let named = |n: &usize| self.columns[*n].kind == Kind::Aside && self.columns[*n].heading.energy.is_some();
        let (parts, joules): (Vec<usize>, Vec<usize>) =
            (0..self.columns.len()).filter(named).partition(|&n| self.columns[n].of_hundredths());
        // Of two energies of one row one is after the bounce, and the other before it: `PE at the
        // top`, `KE at the floor`.
        if let [one, other] = joules.as_slice()
            && self.number().is_none_or(|(_, sure)| !sure)
        {
            let rebounds = |w: &Word| w.is(Atom::After) || w.is(Atom::Rebound) && !w.is(Atom::Top);
            let after = |n: usize| split(&self.columns[n].heading.text).iter().any(rebounds);
            let first = [(*one, *other), (*other, *one)].into_iter().find(|(n, of)| !after(*n) && after(*of));
            if let Some(energy) = first.and_then(|(n, _)| self.columns[n].heading.energy.as_mut())
                && energy.role == Role::Reading
                && energy.at == At::Row
            {
                energy.at = At::Release;
            }
        }
        let at = |n: &usize| self.columns[*n].heading.energy.as_ref().filter(|v| v.role == Role::Reading).map(|v| v.at);
        let places: Vec<At> = joules.iter().filter_map(at).collect();
        let paired = places.contains(&At::Release) && places.iter().any(|at| *at != At::Release);
        // The only height beside energies before and after, of a drop a row, is of no rebound: the
        // two say more.
        let other = |c: &super::Column| read(c) && !released(c) && !c.value().is_some_and(|v| v.or_trial);
        let others: Vec<usize> = (0..self.columns.len()).filter(|&n| other(&self.columns[n])).collect();
        let row = |n: usize| self.columns[n].value().is_some_and(|v| v.what == What::Height && v.at == At::Row);
        let drops = paired && self.number().is_none_or(|(_, sure)| !sure);
        match others.as_slice() {
            [] => {}
            [index] if drops && row(*index) && !self.columns.iter().any(|c| read(c) && released(c)) => {
                self.leave(*index, Why::Elsewhere);
            }
            _ => return,
        }
        let heights: Vec<usize> =
            (0..self.columns.len()).filter(|&n| read(&self.columns[n]) && released(&self.columns[n])).collect();
        let beside = heights.iter().any(|&n| !self.columns[n].value().is_some_and(|v| v.or_trial));
        if !places.is_empty() && (paired || !beside) {
            heights.into_iter().filter(|_| beside).for_each(|index| self.leave(index, Why::Elsewhere));
            joules.into_iter().for_each(|index| self.stands_for_a_height(region, index));
        } else if let ([index], true) = (parts.as_slice(), beside) {
            self.promote(*index);
        } else if let ([index], true) = (parts.as_slice(), joules.is_empty()) {
            self.lost_each(region, *index);
        }
    }

    /// Hundredths of the energy that are lost at every bounce: of the height before, unless they
    /// add up from bounce to bounce.
    fn lost_each(&mut self, region: &Region<'_>, index: usize) {
        let lost: Vec<f64> = region.numbers(index).collect();
        let parts = lost.iter().all(|lost| (0.0..100.0).contains(lost));
        let add_up = lost.len() > 1 && lost.windows(2).all(|pair| pair[0] < LEVEL * pair[1]);
        if parts && !add_up {
            self.promote(index);
            self.columns[index].kind = Kind::Share;
        }
    }

    /// A column of energies is one of heights, in joules.
    fn stands_for_a_height(&mut self, region: &Region<'_>, index: usize) {
        let of_cell = |row: &usize| match region.view.read(*row, index) {
            Cell::Number(m) => m.unit.and_then(Unit::of_height),
            _ => None,
        };
        let own = self.columns[index].heading.unit.and_then(Unit::of_height);
        // Of a mass that is not known a joule stands for any height: only ratios count.
        let unit = own.or(region.rows.iter().find_map(of_cell)).unwrap_or(Unit::JOULE);
        self.columns[index].unit = Some(unit);
        self.promote(index);
        let name = shown(&self.columns[index].heading.text);
        self.notes.push(Note::Energy { column: name });
    }

    fn promote(&mut self, index: usize) {
        let name = shown(&self.columns[index].heading.text);
        if let Some(value) = self.columns[index].heading.energy.clone() {
            if self.columns[index].of_hundredths() {
                self.columns[index].unit = Unit::parse("%");
            }
            self.columns[index].kind = Kind::Value(value);
            self.aside.retain(|aside| aside.name != name);
        }
    }

    /// Speeds, or energies, of impacts that are counted, all of one side: those of the row.
    pub(super) fn one_sided(&mut self) {
        let counted = self.number().is_some_and(|(_, sure)| sure);
        let sides: Vec<usize> = self
            .values()
            .filter(|(_, c, v)| {
                v.what == What::Speed || c.unit.is_some_and(|u| matches!(u.scale, Scale::Energy { .. }))
            })
            .filter(|(_, _, v)| v.role == Role::Reading)
            .map(|(n, _, _)| n)
            .collect();
        let before = |&n: &usize| {
            self.columns[n].heading.has(Atom::Impact)
                && self.columns[n].value().is_some_and(|v| matches!(v.at, At::Before | At::Release))
        };
        if !counted || self.values().count() != sides.len() || !sides.iter().all(before) {
            return;
        }
        for index in sides {
            if let Kind::Value(value) = &mut self.columns[index].kind {
                value.at = At::Row;
            }
        }
    }

    /// Numbers of samples, as sound programs count them, are a clock, as those of frames are.
    pub(super) fn sampled(&mut self, region: &Region<'_>) {
        // Beside heights they are specimens.
        let other = |v: &Value| !matches!(v.what, What::Unsaid | What::Time) && v.role != Role::Error;
        if self.values().any(|(_, c, v)| other(v) && c.heading.unit.is_some()) {
            return;
        }
        let cells = |n: usize| region.rows.iter().map(move |&row| region.cell(row, n));
        let counts = |n: &usize| of_samples(&self.columns[*n].heading, cells(*n));
        let found: Vec<usize> = (0..self.columns.len()).filter(counts).collect();
        for (place, &index) in found.iter().enumerate() {
            let name = shown(&self.columns[index].heading.text);
            self.aside.retain(|aside| aside.name != name);
            self.columns[index].unit = None;
            self.columns[index].kind = Kind::Frame;
            // Where a sound ends tells nothing that its start does not.
            if place > 0 {
                self.leave(index, Why::Other);
            }
        }
    }

    /// Whether the times of the rows are those of the tops beside them, by the name of the times or
    /// of what counts the rows.
    pub(in crate::read) fn of_tops(&self) -> bool {
        let row = |what: What| self.values().find(move |(_, _, v)| v.what == what && v.at == At::Row);
        let (Some((_, time, _)), Some((_, height, _))) = (row(What::Time), row(What::Height)) else { return false };
        // `time (s), peak height (m)`: the time of which is not stated otherwise.
        let both = height.heading.of_tops() && (time.heading.has(Atom::Max) || time.heading.only());
        let counted = self.number().is_some_and(|(n, _)| {
            let heading = &self.columns[n].heading;
            heading.of_tops() && !heading.has(Atom::Impact)
        });
        !time.heading.has(Atom::Impact) && (time.heading.of_tops() || counted || both)
    }
}
