//! What numbers of a table say against one another: speeds that no fall gives, readings in a unit
//! that a remark names and their column does not.

use std::collections::HashMap;

use super::cell::Cell;
use super::clause::{clauses, frame_rate};
use super::columns::{Column, Columns};
use super::datum::Of;
use super::grid::shown;
use super::heading::{At, DropHeight, Heading, Role, Value, What};
use super::phrases::{DENIED, Phrase, denies};
use super::region::Region;
use super::said::ALIKE;
use super::units::{Dimension, Scale, Unit};
use super::vocabulary::{Atom, folded};
use super::words::{Kind, Word, split};
use super::{Event, Table};
use crate::finding::Doubt;
use crate::quantity::STANDARD_GRAVITY;
use crate::statistics::median;

/// A speed before a bounce is this part of that of a free fall at least, for air and a gate above
/// the floor leave so much of it, and at most: a rule and a clock err by less.
const FALLS: std::ops::RangeInclusive<f64> = 0.5..=1.25;

/// Readings of two units differ by what these do to within this part of it, as a ball's do.
const SCATTER: f64 = 0.05;

fn si(unit: Unit, dimension: Dimension) -> bool {
    unit.dimension == dimension && matches!(unit.scale, Scale::Si { .. })
}

/// The doubt about speeds before bounces that the heights of release beside them, or above the
/// table, do not give.
pub(super) fn no_fall(region: &Region<'_>, columns: &Columns) -> Option<Doubt> {
    let number = |row: usize, n: usize, unit: Option<Unit>| match region.view.read(row, n) {
        Cell::Number(m) => Some(m.unit.or(unit)?.si(m.value)),
        _ => None,
    };
    let before = columns
        .values()
        .find(|(_, _, v)| v.what == What::Speed && v.role == Role::Reading && matches!(v.at, At::Before | At::Release));
    let (speed, named, _) = before.filter(|(_, c, _)| !c.turned)?;
    let unit = named.unit.filter(|unit| si(*unit, Dimension::Speed))?;
    let released = |c: &Column| c.heading.value().is_some_and(|v| (v.what, v.at) == (What::Height, At::Release));
    let column = columns.columns.iter().enumerate().find_map(|(n, c)| {
        let unit = c.unit.or(region.units.1);
        let length = unit.is_none_or(|unit| si(unit, Dimension::Length));
        (released(c) && c.heading.unknown.is_empty() && length).then_some((n, unit, &c.heading.text))
    });
    let height = |row: usize| match column {
        Some((n, unit, _)) => number(row, n, unit),
        None => region.drop.as_ref().map(DropHeight::metres),
    };
    let part = |&row: &usize| {
        let free = (2.0 * STANDARD_GRAVITY * height(row).filter(|height| *height > 0.0)?).sqrt();
        Some(number(row, speed, Some(unit))?.abs() / free)
    };
    let mut parts: Vec<f64> = region.rows.iter().filter_map(part).collect();
    let drop = column.map(|(_, _, name)| name).or(region.drop.as_ref().map(|drop| &drop.text))?;
    let other = !FALLS.contains(&median(&mut parts)?);
    other.then(|| Doubt::Fall { drop: shown(drop), speed: shown(&named.heading.text) })
}

fn length(unit: &Unit) -> bool {
    si(*unit, Dimension::Length)
}

/// The units of length that headings have.
fn of_headings(region: &Region<'_>) -> Vec<Unit> {
    region.header.iter().filter_map(|name| Heading::parse(name).unit).filter(length).collect()
}

/// The unit of length that a word is, of several letters: one may be anything.
fn unit(word: &Word) -> Option<Unit> {
    Unit::parse(&word.text).filter(|unit| length(unit) && word.text.chars().count() > 1)
}

/// Whether a text names a unit of length that no heading has, and a rebound is to another one from
/// the same height as the two units are.
pub(super) fn mixed(region: &Region<'_>, table: &Table, text: &str) -> bool {
    let own = of_headings(region);
    let words = split(text);
    let known = |word: &&Word| matches!(word.kind, Kind::Known(_));
    let pairs = words.iter().filter(known).filter_map(unit).flat_map(|said| own.iter().map(move |own| (said, own)));
    let mut factors = pairs.filter(|(said, own)| said != *own).map(|(said, own)| said.si(1.0) / own.si(1.0)).peekable();
    if factors.peek().is_none() {
        return false;
    }
    let mut rebounds: HashMap<u64, Vec<f64>> = HashMap::new();
    for trial in &table.trials {
        let high = |event: Event| trial.readings.iter().find(|r| r.event == event).and_then(|r| r.height);
        if let Some((release, rebound)) = high(Event::Release).zip(high(Event::Apex)) {
            rebounds.entry(release.to_bits()).or_default().push(rebound);
        }
    }
    let mut heights: Vec<Vec<f64>> = rebounds.into_values().collect();
    heights.iter_mut().for_each(|of_one| of_one.sort_by(f64::total_cmp));
    let apart = |factor: f64| {
        let like = |of_one: &[f64], height: f64| {
            let from = of_one.partition_point(|other| *other < height * factor * (1.0 - SCATTER));
            of_one.get(from).is_some_and(|other| *other < height * factor * (1.0 + SCATTER))
        };
        heights.iter().any(|of_one| of_one.iter().any(|height| like(of_one, *height)))
    };
    factors.any(apart)
}

/// Whether a clause of a text says that readings are in a unit of length that no heading has: `the
/// last two bounces were read in inches`; but not if it says what they were converted from, nor
/// what a rule is divided into.
pub(super) fn misread(region: &Region<'_>, text: &str) -> bool {
    let own = of_headings(region);
    let plain = |word: &Word| matches!(word.kind, Kind::Known(_));
    let apart = |word: &Word| {
        let other = [Atom::Tool, Atom::Release, Atom::Error, Atom::Void, Atom::Note].iter().any(|atom| word.is(*atom));
        let spelt = folded(&word.text);
        other
            || Phrase::Converted.is(&spelt)
            || Phrase::Diameter.is(&spelt)
            || Phrase::Radius.is(&spelt)
            || denies(&spelt)
    };
    let of_readings = |word: &Word| match word.kind {
        Kind::Known(atoms) => atoms.iter().any(|a| a.measures() || matches!(a, Atom::Read | Atom::Person)),
        _ => false,
    };
    let strange = |clause: &str| {
        let words = split(clause);
        let other = |word: &Word| unit(word).is_some_and(|unit| !own.contains(&unit));
        let stated = words.windows(2).position(|pair| Phrase::In.is(&folded(&pair[0].text)) && other(&pair[1]));
        let Some(at) = stated.filter(|_| !words.iter().any(apart)) else { return false };
        let mut others = words[..at].iter().chain(&words[at + 2..]);
        others.clone().any(of_readings) || others.all(plain)
    };
    !own.is_empty() && clauses(text).any(strange)
}

/// The doubt whether releases and rebounds are read at the same end of the ball, where one names
/// its bottom and the other its top, and nothing states by how much.
pub(super) fn of_two_ends(region: &Region<'_>, columns: &Columns) -> Option<Doubt> {
    if region.zero.as_ref().is_some_and(|zero| zero.of != Of::All) {
        return None;
    }
    let names = |c: &Column, ends: Atom| split(&c.heading.text).iter().any(|word| word.is(ends));
    let column = |release: bool, ends: Atom| {
        let read = |v: &Value| v.role == Role::Reading && v.what == What::Height;
        let mut found =
            columns.values().filter(|(_, c, v)| read(v) && (v.at == At::Release) == release && names(c, ends));
        found.next().map(|(_, c, _)| shown(&c.heading.text))
    };
    let ends = [(Atom::Bottom, Atom::Top), (Atom::Top, Atom::Bottom)];
    let (drop, rebound) = ends.iter().find_map(|(one, other)| Some((column(true, *one)?, column(false, *other)?)))?;
    Some(Doubt::Datum { drop, rebound })
}

/// The doubt whether the heights that bounces begin at were measured: where each is that of the row
/// before times one factor, to its last digit, the column repeats the other and is no reading.
pub(super) fn repeated(region: &Region<'_>, columns: &Columns) -> Option<Doubt> {
    let column = |release: bool| {
        let read = |v: &Value| v.role == Role::Reading && v.what == What::Height && v.trial.is_empty();
        let mut found = columns
            .values()
            .filter(|(_, _, v)| read(v) && matches!(v.at, At::Release | At::Row) && (v.at == At::Release) == release);
        found.next().filter(|_| found.next().is_none())
    };
    let ((drop, of_drop, _), (rebound, of_rebound, _)) = (column(true)?, column(false)?);
    if !of_drop.heading.has(Atom::Before) {
        return None;
    }
    let step = |pair: &[usize]| {
        let (before, begins) = (columns.written(region, pair[0], rebound)?, columns.written(region, pair[1], drop)?);
        let falls = columns.written(region, pair[0], drop)?.0 > begins.0;
        // The factor, and how far the rounding of both may move it.
        let factor = begins.0 / before.0;
        (falls && before.0 > before.1).then(|| (factor, begins.1 / before.0 + factor * before.1 / before.0))
    };
    let steps: Vec<(f64, f64)> = region.rows.windows(2).map(step).collect::<Option<_>>()?;
    let (low, high) = steps.iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(low, high), (factor, by)| {
        (low.max(factor - by), high.min(factor + by))
    });
    let other = low > 1.0 || high < 1.0;
    (steps.len() + 1 >= ALIKE && low <= high && other)
        .then(|| Doubt::Repeated { column: shown(&of_drop.heading.text), of: shown(&of_rebound.heading.text) })
}

/// Whether a clause of a text counts a rebound that is not the first where the table has no other:
/// `we nearly always took the second`; but not one of a trial or a ball, nor what it denies.
pub(super) fn of_a_later(table: &Table, text: &str) -> bool {
    let mut readings = table.trials.iter().flat_map(|trial| &trial.readings);
    let later = readings.any(|reading| reading.bounce > 1 || reading.time.is_some())
        || table.trials.iter().any(|trial| trial.timed.is_some());
    let rebounds = |word: &Word| word.is(Atom::Rebound) || word.is(Atom::Impact);
    if later || !split(text).iter().any(rebounds) || frame_rate(text).is_some() {
        return false;
    }
    let denies = |word: &Word| denies(&folded(&word.text));
    let filler = |word: &&Word| matches!(word.kind, Kind::Known([Atom::Filler])) && !denies(word);
    let counts = |words: &[Word], at: usize| {
        // Behind a number it is a unit of time.
        let unit = at > 0 && matches!(words[at - 1].kind, Kind::Number(_));
        !unit
            && match words[at].kind {
                Kind::Ordinal(place) => place > 1,
                Kind::Known(atoms) => atoms.iter().any(|atom| matches!(atom, Atom::Ordinal(place) if *place > 1)),
                _ => false,
            }
    };
    clauses(text).any(|clause| {
        let words = split(clause);
        (0..words.len()).filter(|&at| counts(&words, at)).any(|at| {
            let mut behind = words[at + 1..].iter().skip_while(filler);
            let counted = behind.next().is_none_or(rebounds);
            let denied = words[at.saturating_sub(DENIED)..at].iter().any(denies)
                || behind.find(|word| !filler(word)).is_some_and(denies);
            counted && !denied
        })
    })
}

/// Whether a text speaks of a tool for rebounds that bears two scales, one of which no heading has,
/// and does not say which was read: `bounce: tape, cm on one side, inches on the other`. One for
/// releases as well gives the same ratios in either unit.
pub(super) fn of_two_scales(region: &Region<'_>, text: &str) -> bool {
    let own = of_headings(region);
    let words = split(text);
    let apart = |at: usize| {
        Phrase::In.is(&folded(&words[at].text)) || words.get(at + 1).is_some_and(|next| next.is(Atom::Tool))
    };
    let named = |at: usize| unit(&words[at]).filter(|_| !apart(at));
    let units: Vec<Unit> = (0..words.len()).filter_map(named).collect();
    let both = units.iter().any(|unit| own.contains(unit)) && units.iter().any(|unit| !own.contains(unit));
    let chosen = |clause: &str| {
        let words = split(clause);
        let read = |word: &Word| word.is(Atom::Read) || Phrase::Used.is(&folded(&word.text));
        words.iter().any(read) && words.iter().filter_map(unit).all(|unit| own.contains(&unit))
    };
    let rebounds = words.iter().any(|word| word.is(Atom::Rebound) || word.is(Atom::Impact));
    both && rebounds && words.iter().any(|word| word.is(Atom::Tool)) && !clauses(text).any(chosen)
}
