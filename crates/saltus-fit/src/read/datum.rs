//! What a scale of heights reads at the floor, as lines beside a table state it: a mark of the
//! floor, or the end of the ball that was read, and how large the ball is.

use super::cell::{self, Cell};
use super::clause::clauses;
use super::grid::shown;
use super::phrases::Phrase;
use super::units::{Dimension, Unit};
use super::vocabulary::{Atom, folded};
use super::words::{Kind, Word, split};
use crate::finding::Doubt;

/// A line and its number.
pub(super) type Line<'a> = (u64, &'a str);

/// What a scale reads with the ball on the floor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Zero {
    /// As it is written.
    pub(super) text: String,
    value: f64,
    unit: Option<Unit>,
    /// It is the size of the ball.
    of_ball: bool,
    /// What states it, and its line.
    said: String,
    pub(super) line: u64,
}

impl Zero {
    /// What it is in the unit of a column; `None` where one of the two has no scale.
    pub(super) fn on(&self, column: Option<Unit>) -> Option<f64> {
        match (self.unit, column) {
            (None, _) => Some(self.value),
            (Some(own), Some(unit)) if own == unit => Some(self.value),
            (Some(own), Some(unit)) if !own.unscaled() && !unit.unscaled() => Some(own.si(self.value) / unit.si(1.0)),
            _ => None,
        }
    }
}

/// What lines state of the zero of heights.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Datum {
    Zero(Zero),
    /// Heights are not of the lower end of the ball, or of several ends, and by how much they are
    /// too high is not stated: the line.
    Open(String, u64),
}

impl Datum {
    /// A release that is stated by itself may be of any end of the ball.
    pub(super) fn beside(self, drop: Option<f64>) -> Self {
        match self {
            Self::Zero(zero) if zero.of_ball && drop.is_some() => Self::Open(zero.said, zero.line),
            datum => datum,
        }
    }

    pub(super) fn zero(&self) -> Option<Zero> {
        match self {
            Self::Zero(zero) => Some(zero.clone()),
            Self::Open(..) => None,
        }
    }

    pub(super) fn doubt(self) -> Option<Doubt> {
        match self {
            Self::Zero(_) => None,
            Self::Open(text, line) => Some(Doubt::End { text, line }),
        }
    }
}

/// A point of the ball that heights are read at.
#[derive(Clone, Copy, PartialEq)]
enum End {
    Bottom,
    Middle,
    Top,
}

/// Which heights a line speaks of.
#[derive(Clone, Copy, PartialEq)]
enum Of {
    All,
    Releases,
    Rebounds,
}

/// What lines state of the zero of heights, if anything.
pub(super) fn stated(lines: &[Line<'_>]) -> Option<Datum> {
    let all = || lines.iter().flat_map(|&(line, text)| sentences(text).map(move |clause| (line, clause)));
    let marks = all().filter_map(|(line, clause)| Some(Zero { line, ..mark(clause)? }));
    let ends: Vec<(End, Of, Line<'_>)> =
        all().filter_map(|(line, clause)| end(clause).map(|(end, of)| (end, of, (line, clause)))).collect();
    let Some(&(first, _, (line, clause))) = ends.iter().find(|(end, ..)| *end != End::Bottom) else {
        return marks.map(Datum::Zero).next();
    };
    let says = |of: Of| ends.iter().any(|(_, own, _)| *own == of);
    let whole = says(Of::All) || says(Of::Releases) && says(Of::Rebounds);
    let alike = ends.iter().all(|(end, ..)| *end == first);
    let size = all().find_map(|(_, clause)| diameter(clause)).filter(|_| alike && whole);
    let part = if first == End::Top { 1.0 } else { 0.5 };
    Some(match size {
        Some((text, value, unit)) => {
            let said = shown(clause);
            Datum::Zero(Zero { text, value: part * value, unit: Some(unit), of_ball: true, said, line })
        }
        None => Datum::Open(shown(clause), line),
    })
}

/// The clauses of a line, and what its brackets hold.
fn sentences(text: &str) -> impl Iterator<Item = &str> {
    text.split(['(', ')']).flat_map(clauses).map(str::trim).filter(|clause| !clause.is_empty())
}

/// The only number of a clause, the words before it, its unit, and the words behind it.
fn measured(clause: &str) -> Option<(&str, &str, Option<Unit>, &str)> {
    let digits = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',');
    let start = clause.find(|c: char| c.is_ascii_digit())?;
    let end = clause[start..].find(|c: char| !digits(c)).map_or(clause.len(), |n| start + n);
    let number = clause[start..end].trim_end_matches(['.', ',']);
    let after = clause[start + number.len()..].trim_start();
    let stop = after.find(|c: char| !(c.is_alphabetic() || c == '"')).unwrap_or(after.len());
    let unit = Unit::parse(&after[..stop]).filter(|_| stop > 0);
    let rest = if unit.is_some() { &after[stop..] } else { after };
    let joined = clause[..start].ends_with(|c: char| c.is_alphanumeric() || matches!(c, '-' | '−' | '_'));
    (!joined && !rest.contains(|c: char| c.is_ascii_digit())).then_some((&clause[..start], number, unit, rest))
}

fn value(number: &str) -> Option<f64> {
    match cell::read(number, false) {
        Cell::Number(measured) => Some(measured.value),
        _ => None,
    }
}

/// `floor at y = 0 px`, `the floor is at the 12 cm mark of the tape`.
fn mark(clause: &str) -> Option<Zero> {
    let (before, number, unit, after) = measured(clause)?;
    let (words, behind) = (split(before), split(after));
    let floor = words.iter().position(|word| word.is(Atom::Floor))?;
    let silent = |word: &Word| matches!(word.kind, Kind::Known([Atom::Filler, ..]) | Kind::Letter);
    let place = |word: &Word| silent(word) || word.is(Atom::Position) || at(word);
    let said = words[floor + 1..].iter().any(at) || before.trim_end().ends_with('=');
    let length = unit.is_none_or(|unit| unit.dimension == Dimension::Length);
    // A bare number is a place on an axis.
    let named = unit.is_some() || before.trim_end().ends_with('=');
    let whole = words[..floor].iter().all(silent)
        && words[floor + 1..].iter().all(place)
        && behind.iter().all(|word| place(word) || matches!(word.kind, Kind::Unknown));
    let text = format!("{number} {}", &clause[before.len() + number.len()..clause.len() - after.len()].trim());
    let zero = Zero {
        text: text.trim().to_owned(),
        value: value(number)?,
        unit,
        of_ball: false,
        said: String::new(),
        line: 0,
    };
    (said && length && named && whole).then_some(zero)
}

fn at(word: &Word) -> bool {
    Phrase::At.is(&folded(&word.text))
}

/// How large a ball is, `diameter 24 cm`, `radius: 12 cm`: as it is written, the diameter, its
/// unit.
fn diameter(clause: &str) -> Option<(String, f64, Unit)> {
    let (before, number, unit, after) = measured(clause)?;
    let unit = unit.filter(|unit| unit.dimension == Dimension::Length)?;
    let says = |phrase: Phrase| split(before).iter().chain(&split(after)).any(|word| phrase.is(&folded(&word.text)));
    let times = if says(Phrase::Radius) { 2.0 } else { 1.0 };
    let text = clause[before.len()..clause.len() - after.len()].trim().to_owned();
    (says(Phrase::Diameter) || says(Phrase::Radius)).then_some((text, times * value(number)?, unit))
}

/// The end of the ball that a clause says heights are read at, `measured to the top of the ball`,
/// and which heights.
fn end(clause: &str) -> Option<(End, Of)> {
    let words = split(clause);
    let ball = |word: &Word| (word.is(Atom::Group) || word.is(Atom::Label)) && !word.is(Atom::Floor);
    let silent = |word: &Word| word.is(Atom::Filler) && !word.is(Atom::Bottom);
    let of = |word: &Word| match &*folded(&word.text) {
        _ if word.is(Atom::Bottom) => Some(End::Bottom),
        text if Phrase::Top.is(text) => Some(End::Top),
        text if Phrase::Middle.is(text) => Some(End::Middle),
        _ => None,
    };
    let found = words.iter().enumerate().find_map(|(n, word)| {
        let end = of(word)?;
        let next = words[n + 1..].iter().position(|word| !silent(word)).map(|next| n + 1 + next);
        let behind = next.filter(|&next| ball(&words[next])).map(|next| next + 1);
        // `the ball's top`; what goes on is of something else, `the top of the ball's flight`.
        let before = (n > 0 && ball(&words[n - 1])).then_some(n + 1);
        let rest = behind.or(before)?;
        words[rest..].first().is_none_or(silent).then_some(end)
    });
    let read = |word: &Word| {
        [Atom::Height, Atom::Position, Atom::Distance, Atom::Read, Atom::Release, Atom::Rebound]
            .iter()
            .any(|atom| word.is(*atom) && !ball(word))
    };
    let (fell, rose) =
        (words.iter().any(|w| w.is(Atom::Release)), words.iter().any(|w| w.is(Atom::Rebound) && !w.is(Atom::Top)));
    let of = match (fell, rose) {
        (true, false) => Of::Releases,
        (false, true) => Of::Rebounds,
        _ => Of::All,
    };
    found.filter(|_| words.iter().any(read)).map(|end| (end, of))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_state_what_the_scale_reads_at_the_floor() {
        let cm = Unit::parse("cm");
        for (text, zero) in [
            ("basketball, diameter 24 cm. All heights are measured from the floor to the TOP of the ball!", Some(24.0)),
            ("Heights measured to the top of the ball (diameter 6.7 cm)", Some(6.7)),
            ("Radius 3 cm; heights of the centre of the ball", Some(3.0)),
            ("Ball: Durchmesser 24 cm. Höhen bis zur Oberkante des Balls gemessen", Some(24.0)),
            ("diameter 24 cm, heights to the bottom of the ball", None),
            ("The floor is at the 12 cm mark of the tape", Some(12.0)),
            ("Boden bei y = 0 cm, y nach oben", Some(0.0)),
            ("floor at y = 905", Some(905.0)),
            ("Distance from the ceiling; floor is at 240cm", Some(240.0)),
            ("Table 3: bounce heights", None),
            ("table height = 80 cm", None),
            ("dropped onto the floor from 100 cm", None),
            ("sensor 1.65 m above the floor", None),
            ("height at the top of the ball's flight, diameter 24 cm", None),
        ] {
            let found = match stated(&[(1, text)]) {
                Some(Datum::Zero(zero)) => zero.on(cm),
                _ => None,
            };
            assert_eq!(found, zero, "{text}");
        }
        for text in [
            "heights are to the top of the ball",
            "drop height to the top of the ball, diameter 6 cm",
            "drop height to the bottom of the ball; rebound height to the top of the ball; diameter 6 cm",
        ] {
            assert!(matches!(stated(&[(1, text)]), Some(Datum::Open(..))), "{text}");
        }
    }
}
