//! Bounces that a text counts, in one sentence or in several: `We let it fall from 1 m. The first
//! bounce was 64 cm, the second 41 cm, then 26 cm`.

use super::super::cell::{self, Cell};
use super::super::phrases::Phrase;
use super::super::sequence::LEVEL;
use super::super::units::Dimension;
use super::super::vocabulary::{Atom, folded};
use super::super::words::{Kind, Word, split};
use super::{Part, parts};

/// So many readings of one kind that are counted, with the height of release, are bounces.
const COUNTED: usize = 3;

/// A number with its unit, the words before it back to the last number, and what follows these.
struct Counted<'a> {
    /// Where in the text the number stands, in bytes.
    at: usize,
    number: &'a str,
    value: f64,
    dimension: Dimension,
    words: Vec<Word>,
    place: Option<usize>,
}

/// The text with the bounces that it counts as rows of a table, its other lines as remarks. All
/// lengths and times of the text are counted, 1, 2, 3, each followed by the next or by none that
/// says a place in the order; but for one before them, from which the ball was dropped. Heights
/// fall, and what lies between bounces grows shorter: what is counted otherwise is counted trials.
/// `None` where anything else is measured, or was not read.
pub(super) fn table(text: &str) -> Option<String> {
    if text.contains(['\t', '|']) {
        return None;
    }
    let found = measured(text)?;
    let first = found.iter().position(|part| part.place == Some(1))?;
    let (before, bounces) = found.split_at(first);
    let dimension = bounces[0].dimension;
    let falls = bounces.windows(2).all(|pair| pair[1].value < LEVEL * pair[0].value);
    let linked = |part: &Counted<'_>| part.words.len() <= LINKS;
    let in_order = bounces.iter().enumerate().all(|(n, part)| match part.place {
        Some(place) => place == n + 1,
        None => linked(part),
    });
    let alike = bounces.iter().all(|part| part.dimension == dimension);
    let counted = bounces.iter().filter(|part| part.place.is_some()).count();
    let turned =
        [Atom::Predicted, Atom::Goal, Atom::Lost, Atom::Derived, Atom::Error, Atom::Mean, Atom::Void, Atom::Percent];
    // A letter by itself is a word of a sentence: `e` is `and`.
    let turns = |word: &Word| word.text.chars().nth(1).is_some() && turned.iter().any(|atom| word.is(*atom));
    if !falls || !in_order || !alike || counted < 2 || found.iter().any(|part| part.words.iter().any(turns)) {
        return None;
    }
    let says = |part: &Counted<'_>, atoms: &[Atom]| part.words.iter().any(|w| atoms.iter().any(|atom| w.is(*atom)));
    // A word of bounces that is of laps too says nothing.
    let bounced = |word: &Word| (word.is(Atom::Rebound) || word.is(Atom::Impact)) && !word.is(Atom::Loose);
    let rose = |part: &Counted<'_>| {
        part.words.iter().any(bounced) || part.words.iter().any(|w| Phrase::Rose.is(&folded(&w.text)))
    };
    let release = match (before, dimension) {
        ([], _) => None,
        ([one], Dimension::Length) if says(one, &[Atom::Release]) && bounces[0].value < LEVEL * one.value => Some(one),
        _ => return None,
    };
    let named = match dimension {
        Dimension::Length if bounces.iter().any(rose) => "height",
        // Between impacts a ball is in the air.
        Dimension::Time if says(&bounces[0], &[Atom::Between]) && rose(&bounces[0]) => "interval",
        Dimension::Time if says(&bounces[0], &[Atom::Air, Atom::Interval]) => "interval",
        _ => return None,
    };
    let readings = release.into_iter().chain(bounces);
    if readings.clone().count() < COUNTED {
        return None;
    }
    let from = usize::from(release.is_none());
    let rows: Vec<String> = readings.zip(from..).map(|(part, n)| format!("{n}\t{}", part.number)).collect();
    let line = text[..bounces[0].at].matches('\n').count();
    let spelt = |(n, said): (usize, &str)| match said.trim().is_empty() {
        // A lone carriage return ends a row, and no line.
        _ if n == line => format!("bounce\t{named}\r{}", rows.join("\r")),
        true => String::new(),
        false => format!("#{said}"),
    };
    Some(text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// So many words, of any kind, may lead from one bounce to the next that is not counted: `and
/// then`.
const LINKS: usize = 2;

/// The lengths and times of a text; `None` where it has none.
fn measured(text: &str) -> Option<Vec<Counted<'_>>> {
    let mut found = Vec::new();
    let (parts, _) = parts(text);
    for Part { words, number } in parts {
        let Cell::Number(m) = cell::read(number, false) else { continue };
        let Some(unit) = m.unit.filter(|unit| !unit.unscaled()) else { continue };
        if !matches!(unit.dimension, Dimension::Length | Dimension::Time) {
            continue;
        }
        let words = split(words);
        let place = words.iter().rev().find_map(|word| match word.kind {
            Kind::Ordinal(n) => Some(n),
            Kind::Known(atoms) => atoms.iter().find_map(|atom| match atom {
                Atom::Ordinal(n) => Some(*n),
                _ => None,
            }),
            _ => None,
        });
        let at = number.as_ptr() as usize - text.as_ptr() as usize;
        found.push(Counted { at, number, value: unit.si(m.value), dimension: unit.dimension, words, place });
    }
    (!found.is_empty()).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn bounces_that_are_counted_are_rows() {
        for (text, expected) in [
            (
                "Hi Ana,\nwe dropped it from 1 m. The first bounce was 64 cm, the\nsecond one 41 cm, then 26 cm.\nBye\n",
                "#Hi Ana,\nbounce\theight\r0\t1 m\r1\t64 cm\r2\t41 cm\r3\t26 cm\n#second one 41 cm, then 26 cm.\n#Bye\n",
            ),
            (
                "Zeiten zwischen den Aufprallen: erste 0,70 s, zweite 0,56 s und dritte 0,45 s.\n",
                "bounce\tinterval\r1\t0,70 s\r2\t0,56 s\r3\t0,45 s\n",
            ),
            (
                "balle lâchée à 2 m\n1er rebond 1,3 m\n\n2e rebond 84 cm\n",
                "#balle lâchée à 2 m\nbounce\theight\r0\t2 m\r1\t1,3 m\r2\t84 cm\n\n#2e rebond 84 cm\n",
            ),
        ] {
            assert_eq!(table(text).as_deref(), Some(expected), "{text}");
        }
    }

    #[test]
    fn what_is_counted_otherwise_is_none() {
        for text in [
            // Trials.
            "We dropped it from 1 m. The first time it bounced 64 cm, the second 63 cm, the third 64 cm.\n",
            // A place in the order is left out, or something else is measured.
            "Dropped from 1 m. The first bounce was 64 cm, the third 26 cm.\n",
            "Dropped from 1 m. First bounce 64 cm, second 41 cm. The ball is 4 cm wide.\n",
            // No reading, or nothing that bounces.
            "Dropped from 1 m. The first bounce should be 64 cm, the second 41 cm in theory.\n",
            "The first plank is 64 cm, the second 41 cm, the third 26 cm.\n",
            "The first lap took 70 s, the second 56 s, the third 45 s.\n",
            // From where it was dropped nobody says.
            "The tape is 1 m long. The first bounce was 64 cm, the second 41 cm.\n",
            "First bounce 64 cm, second 41 cm.\n",
        ] {
            assert_eq!(table(text), None, "{text}");
        }
    }
}
