//! What a scale of heights reads at the floor, as lines beside a table state it: a mark of the
//! floor, or the end of the ball that was read, and how large the ball is.

use super::cell::{self, Cell};
use super::clause::clauses;
use super::end::{End, names_end, point};
use super::grid::shown;
use super::phrases::{Phrase, denies};
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
    /// The heights that it is to be taken off.
    pub(super) of: Of,
    /// What states it, and its line.
    said: String,
    pub(super) line: u64,
}

impl Zero {
    /// A mark of a scale, by its number.
    fn at(text: &str, number: &str, unit: Option<Unit>) -> Option<Self> {
        let (said, line) = (String::new(), 0);
        Some(Self { text: text.to_owned(), value: value(number)?, unit, of_ball: false, of: Of::All, said, line })
    }

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
            Self::Zero(zero) if zero.of_ball && zero.of != Of::Rebounds && drop.is_some() => {
                Self::Open(zero.said, zero.line)
            }
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

/// Which heights a line speaks of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Of {
    All,
    Releases,
    Rebounds,
}

/// What lines, and the names of columns, state of the zero of heights, if anything.
pub(super) fn stated(lines: &[Line<'_>], names: &[Line<'_>]) -> Option<Datum> {
    let all = || lines.iter().flat_map(|&(line, text)| sentences(text).map(move |clause| (line, clause)));
    let marks = all().filter_map(|(line, clause)| Some(Zero { line, ..mark(clause).or_else(|| off(clause))? }));
    let mut ends: Vec<(End, Of, Line<'_>)> = lines.iter().flat_map(|line| ends(*line, false)).collect();
    ends.extend(of_names(names));
    let Some(&(first, _, (line, clause))) = ends.iter().find(|(end, ..)| *end != End::Bottom) else {
        return marks.map(Datum::Zero).next();
    };
    let every = |of: Of, end: End| {
        let mut found = ends.iter().filter(|(_, own, _)| *own == of).peekable();
        found.peek().is_some() && found.all(|(own, ..)| *own == end)
    };
    let alike = ends.iter().all(|(end, ..)| *end == first);
    let says = |of: Of| ends.iter().any(|(_, own, _)| *own == of);
    let of = match () {
        () if alike && (says(Of::All) || says(Of::Releases) && says(Of::Rebounds)) => Some(Of::All),
        () if says(Of::All) => None,
        // Those of the lower end are right as they stand.
        () if every(Of::Releases, End::Bottom) && every(Of::Rebounds, first) => Some(Of::Rebounds),
        () if every(Of::Rebounds, End::Bottom) && every(Of::Releases, first) => Some(Of::Releases),
        () => None,
    };
    let part = if first == End::Top { 1.0 } else { 0.5 };
    Some(match of.zip(all().find_map(|(_, clause)| diameter(clause))) {
        Some((of, (text, value, unit))) => {
            let said = shown(clause);
            Datum::Zero(Zero { text, value: part * value, unit: Some(unit), of_ball: true, of, said, line })
        }
        None => Datum::Open(shown(clause), line),
    })
}

/// The ends of the ball that names of columns name. Behind the name of a rebound alone it may be
/// that of its flight: `rebound (top)`.
fn of_names<'a>(names: &[Line<'a>]) -> Vec<(End, Of, Line<'a>)> {
    let mut found: Vec<_> = names.iter().flat_map(|name| ends(*name, true)).collect();
    let released = found.iter().any(|(end, of, _)| *end != End::Bottom && *of == Of::Releases);
    found.retain(|(end, _, (_, clause))| released || *end == End::Bottom || !names_end(clause));
    found
}

/// The ends of the ball that a line names, and of which heights: what a clause of it says of these
/// holds for the next ones. The lower end of a column needs no ball.
fn ends<'a>((line, text): Line<'a>, name: bool) -> Vec<(End, Of, Line<'a>)> {
    let mut of = Of::All;
    let mut found = Vec::new();
    for clause in sentences(text) {
        let words = split(clause);
        of = heights(&words).unwrap_or(of);
        let bare = || {
            let bottom = words.iter().any(|word| word.is(Atom::Bottom)).then_some(End::Bottom);
            let alone = || words.iter().find_map(point).filter(|_| names_end(clause));
            bottom.or_else(alone).filter(|_| name)
        };
        found.extend(end(&words).or_else(bare).map(|end| (end, of, (line, clause))));
    }
    found
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

/// `floor at y = 0 px`, `the floor is at the 12 cm mark of the tape`, `a plate whose surface reads
/// 4 cm`, `the tape reads 12 cm at the floor`.
fn mark(clause: &str) -> Option<Zero> {
    // What describes the word before it stands by itself.
    let relative = |(at, word): (usize, &str)| Phrase::Whose.is(&folded(word)).then_some(at + word.len());
    let starts = std::iter::once(0).chain(clause.match_indices(' ').map(|(at, _)| at + 1));
    let words = starts.map(|at| (at, clause[at..].split(' ').next().unwrap_or_default()));
    let (said, clause) = words.filter_map(relative).next_back().map_or(("", clause), |at| clause.split_at(at));
    // What a ball bounces on is a floor, whatever it is called.
    let met = split(said).iter().any(|word| word.is(Atom::Impact) || word.is(Atom::Rebound));
    let is_floor = |word: &Word| word.is(Atom::Floor) || met && word.is(Atom::Group);
    let (before, number, unit, after) = measured(clause)?;
    let (words, behind) = (split(before), split(after));
    let silent = |word: &Word| matches!(word.kind, Kind::Known([Atom::Filler, ..]) | Kind::Letter);
    let reads = |word: &Word| Phrase::Reads.is(&folded(&word.text));
    let place = |word: &Word| silent(word) || word.is(Atom::Position) || at(word) || reads(word);
    let length = unit.is_none_or(|unit| unit.dimension == Dimension::Length);
    // A bare number is a place on an axis.
    let named = unit.is_some() || before.trim_end().ends_with('=');
    let of_floor = |floor: usize| {
        let said = words[floor + 1..].iter().any(|word| at(word) || reads(word)) || before.trim_end().ends_with('=');
        said && words[..floor].iter().all(silent)
            && words[floor + 1..].iter().all(place)
            && behind.iter().all(|word| place(word) || matches!(word.kind, Kind::Unknown))
    };
    let at_floor = |floor: usize| {
        words.iter().any(reads)
            && behind[..floor].iter().any(at)
            && behind.iter().enumerate().all(|(n, word)| n == floor || place(word))
    };
    let floor = |words: &[Word]| words.iter().position(is_floor);
    let whole = floor(&words).map_or_else(|| floor(&behind).is_some_and(at_floor), of_floor);
    let text = format!("{number} {}", &clause[before.len() + number.len()..clause.len() - after.len()].trim());
    (length && named && whole).then(|| Zero::at(text.trim(), number, unit))?
}

/// `subtract 4 cm from every reading`: what is to be taken off all heights, and was not.
fn off(clause: &str) -> Option<Zero> {
    let (before, number, unit, after) = measured(clause)?;
    let unit = unit.filter(|unit| unit.dimension == Dimension::Length && !unit.unscaled())?;
    let words: Vec<Word> = split(before).into_iter().chain(split(after)).collect();
    let spelt = format!(" {} {} ", folded(before), folded(after)).replace([',', '.', ':'], " ");
    let tells = |phrase: &&str| spelt.contains(&format!(" {phrase} ")) || !phrase.is_ascii() && spelt.contains(*phrase);
    let of = |word: &Word, phrase: Phrase| phrase.is(&folded(&word.text));
    let all = |word: &Word| of(word, Phrase::Differing) || of(word, Phrase::Value) || word.is(Atom::Height);
    let denied = words.iter().any(|word| denies(&folded(&word.text)));
    let fits = Phrase::Subtract.all().iter().any(tells) && words.iter().any(all) && !denied;
    let text = clause[before.len()..clause.len() - after.len()].trim();
    fits.then(|| Zero::at(text, number, Some(unit)))?
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

/// The end of the ball that a clause says heights are read at, `measured to the top of the ball`.
fn end(words: &[Word]) -> Option<End> {
    let ball = |word: &Word| (word.is(Atom::Group) || word.is(Atom::Label)) && !word.is(Atom::Floor);
    let silent = |word: &Word| word.is(Atom::Filler) && !word.is(Atom::Bottom);
    let found = words.iter().enumerate().find_map(|(n, word)| {
        let end = point(word)?;
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
    found.filter(|_| words.iter().any(read))
}

/// Which heights a clause speaks of, where it tells.
fn heights(words: &[Word]) -> Option<Of> {
    let fell = words.iter().any(|word| word.is(Atom::Release));
    let rose = words.iter().any(|word| word.is(Atom::Rebound) && !word.is(Atom::Top));
    match (fell, rose) {
        (true, false) => Some(Of::Releases),
        (false, true) => Some(Of::Rebounds),
        (true, true) => Some(Of::All),
        (false, false) => None,
    }
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
            ("the ball bounces on a plate whose surface is at the 4.0 cm mark", Some(4.0)),
            ("The tape reads 12 cm at the floor", Some(12.0)),
            ("subtract 4 cm from every reading", Some(4.0)),
            ("von allen Höhen 4 cm abziehen", Some(4.0)),
            ("4 cm were subtracted from every reading", None),
        ] {
            let found = match stated(&[(1, text)], &[]) {
                Some(Datum::Zero(zero)) => zero.on(cm),
                _ => None,
            };
            assert_eq!(found, zero, "{text}");
        }
        let text = "drop height to the bottom of the ball; rebound height to the top of the ball; diameter 6 cm";
        let parted = stated(&[(1, text)], &[]).and_then(|datum| datum.zero());
        assert!(parted.is_some_and(|zero| zero.of == Of::Rebounds && zero.on(cm) == Some(6.0)));
        for text in [
            "heights are to the top of the ball",
            "drop height to the top of the ball, diameter 6 cm",
            "drop height to the bottom of the ball; rebound height to the top of the ball",
        ] {
            assert!(matches!(stated(&[(1, text)], &[]), Some(Datum::Open(..))), "{text}");
        }
    }
}
