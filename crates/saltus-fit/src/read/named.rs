//! Which bounce, which event a cell names.

use super::Event;
use super::cell::{self, Cell};
use super::heading::{At, Heading};
use super::phrases::Phrase;
use super::units::Unit;
use super::vocabulary::Atom;
use super::words::{Kind as WordKind, Word, split};

/// Whether a word of a text is what a ball bounces on, at the zero of heights.
pub(super) fn names_floor(text: &str) -> bool {
    split(text).iter().any(|word| word.is(Atom::Floor))
}

/// The event that a cell names.
pub(super) fn event(cell: &str) -> Option<Event> {
    let spelt = cell.to_lowercase();
    let events = [(Phrase::LetGo, Event::Release), (Phrase::Contact, Event::Contact), (Phrase::Apex, Event::Apex)];
    if let Some((_, event)) = events.into_iter().find(|(phrase, _)| phrase.is(&spelt)) {
        return Some(event);
    }
    let heading = Heading::parse(cell);
    let contact = heading.has(Atom::Impact) && !heading.has(Atom::After);
    match heading.unknown.is_empty() {
        true if heading.has(Atom::Release) => Some(Event::Release),
        true if contact => Some(Event::Contact),
        true if heading.has(Atom::Top) => Some(Event::Apex),
        _ => None,
    }
}

/// The first of two bounces, one after the other, that a cell names: `1-2`, `1 → 2`, `bounce 1 to
/// bounce 2`. What lies between the release and the first is no flight.
pub(super) fn between(cell: &str) -> Option<usize> {
    let numbers: Vec<&str> = cell.split(|c: char| !c.is_ascii_digit()).filter(|part| !part.is_empty()).collect();
    let &[first, second] = numbers.as_slice() else { return None };
    let (first, second): (usize, usize) = (first.parse().ok()?, second.parse().ok()?);
    let words = split(cell);
    let number = |w: &Word| matches!(w.kind, WordKind::Number(_) | WordKind::Ordinal(_));
    let (from, to) = (words.iter().position(number)?, words.iter().rposition(number)?);
    // A word of a letter or two between them is an `and`.
    let joins = |n: usize| (from..to).contains(&n) && words[n].text.len() < 4 && Unit::parse(&words[n].text).is_none();
    let of_bounces = |w: &Word| match w.kind {
        WordKind::Known(_) => {
            w.is(Atom::Impact) || w.is(Atom::Rebound) || w.is(Atom::Between) || w.is(Atom::Filler) || w.is(Atom::Number)
        }
        WordKind::Number(_) | WordKind::Ordinal(_) => true,
        _ => false,
    };
    let signs = |c: char| {
        c.is_alphanumeric() || matches!(c, ' ' | '-' | '–' | '—' | '→' | '>' | '&' | '#' | '.' | '°' | 'º' | 'ª')
    };
    let named = cell.chars().all(signs) && words.iter().enumerate().all(|(n, word)| joins(n) || of_bounces(word));
    (named && first > 0 && second == first + 1).then_some(first)
}

/// The number of the bounce that a cell names: `3`, `Bounce 3`, `2nd`, `drop`; of what lies between
/// two bounces that of the first.
pub(super) fn bounce(cell: &str) -> Option<usize> {
    numbered(cell).or_else(|| between(cell))
}

fn numbered(cell: &str) -> Option<usize> {
    // A sign that puts it in a place of an order, `1°`, and no angle.
    let cell = cell.strip_suffix(['°', 'º', 'ª']).unwrap_or(cell);
    if let Cell::Number(measured) = cell::read(cell, false) {
        let n = measured.value;
        // In range and whole: the cast is exact.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let plain = measured.unit.is_none() && measured.error.is_none();
        return (n.fract() == 0.0 && (0.0..=1e6).contains(&n) && plain).then_some(n as usize);
    }
    let heading = Heading::parse(cell);
    if !heading.unknown.is_empty() {
        return None;
    }
    match heading.value()?.at {
        At::Release => Some(0),
        At::Nth(n) => Some(n),
        _ => None,
    }
}

/// Numbers read off a diagram are off by so much at most.
pub(super) const OFF: f64 = 0.1;
