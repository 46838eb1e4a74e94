//! What a clause of text states: a frame rate, the height of release, the unit and the error of all
//! readings.

use std::borrow::Cow;

use super::cell::{self, Cell};
use super::heading::{At, DropHeight, Heading, Role, rate, released};
use super::limits::MANY;
use super::phrases::Phrase;
use super::units::{Dimension, Unit};
use super::vocabulary::{Atom, folded, unparted};
use super::words::{Kind, Word, split, without_brackets};
use super::written::{rounds_to, step};
use crate::quantity::Ball;

/// The number that a text ends in, and the text before it.
fn last_number(text: &str) -> Option<(f64, &str)> {
    let digits = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',');
    let before = text.trim_end_matches(digits);
    let value: f64 = text[before.len()..].replace(',', ".").parse().ok()?;
    (value.is_finite() && value > 0.0).then_some((value, before.trim_end_matches([' ', ':', '='])))
}

/// `240 fps`, `Frame rate: 240`, `44.1 kHz`, 1/s.
pub(super) fn frame_rate(text: &str) -> Option<f64> {
    let named = || {
        let text = folded(text);
        let (value, before) = last_number(text.trim_end())?;
        Phrase::Rate.is(before).then_some(value)
    };
    rate(text).map(|(value, _)| value).or_else(named)
}

/// Whether a heading names a rate of frames or samples, `fps`, `Frame rate (Hz)`.
pub(super) fn names_rate(name: &str) -> bool {
    let name = folded(name);
    let bare = name.split(['(', '[', '/']).next().unwrap_or_default().replace('_', " ");
    Phrase::Rate.is(bare.trim().trim_end_matches(" hz"))
}

/// Whether a word says that a number was not measured.
fn turns(word: &Word) -> bool {
    word.is(Atom::Goal) || turns_away(word)
}

/// The same in brackets behind a height of release: a rule asks for it, `254 cm (ITF)`.
fn turns_away(word: &Word) -> bool {
    [Atom::Predicted, Atom::Lost, Atom::Derived].iter().any(|atom| word.is(*atom))
}

/// `Drop height: 1 m`, `Drop height (cm) 100`, `tested, dropped from 100 cm onto stone`: of the
/// clause that states it every word up to the number has to be understood.
pub(super) fn drop(text: &str) -> Option<DropHeight> {
    let text = without_repeat(text);
    let text = &*without_error(&text);
    // What a ball, or its test, is called before a colon is no part of how it was dropped.
    let behind = text.split_once(':').filter(|(name, _)| split(name).iter().any(names_ball)).map(|(_, behind)| behind);
    // `our ball (dropped from 1 m)`.
    clauses(text).chain(bracketed(text)).chain(dashed(text)).chain(behind).find_map(|clause| {
        let plain = |w: &Word| !matches!(w.kind, Kind::Unknown | Kind::Number(_)) && !turns(w);
        if let Some((height, before, after)) = released(clause) {
            // What brackets hold behind it is a remark.
            let remark = after.trim_start().strip_prefix('(').and_then(|after| after.split_once(')'));
            let after = remark
                .filter(|(inside, _)| !split(&inside.replace('/', " ")).iter().any(turns_away))
                .map_or(after, |(_, rest)| rest);
            // The sign that stands for it: `Fallhöhe h0 = 1 m`.
            let named = before.trim_end_matches([' ', '=', ':', '(']);
            let (named, sign) = signed(named).unwrap_or((named, 0));
            let height = DropHeight { sign, ..height };
            let (before, after) = (without_times(split(named)), split(after));
            let of_height = |w: &Word| w.is(Atom::Height) || matches!(&*folded(&w.text), "from" | "aus" | "de" | "von");
            // What is dropped from a height is dropped from it, wherever it falls.
            // A ball `from 1 m` was dropped from there.
            let ball = |w: &Word| w.is(Atom::Label) || names_ball(w);
            // No ball is so large: `una pallina da 1 metro` was dropped from there.
            let beyond = Ball::ALL.iter().all(|ball| ball.diameter() < height.metres());
            // `Tennis ball from 2 m onto wood`.
            let onto = |w: &Word| [Atom::Filler, Atom::Label, Atom::Group].iter().any(|atom| w.is(*atom));
            let of_drop =
                |w: &Word| w.is(Atom::Release) || ball(w) && (after.is_empty() || beyond && after.iter().all(onto));
            let said = before.iter().any(of_drop) && before.iter().any(of_height);
            // What it fell on may be anything: `onto the garage floor`.
            let silent = |w: &Word| !turns(w) && !matches!(w.kind, Kind::Number(_));
            let fell_on = after.iter().all(silent) && after.first().is_some_and(|w| w.is(Atom::Filler));
            let whole = before.iter().chain(&after).any(|w| w.is(Atom::Release));
            let whole = whole && (fell_on && beyond || after.iter().all(plain));
            // Whoever dropped it, and whatever for: `we let the ball fall from 1 m`.
            let from = before.iter().rposition(|w| w.is(Atom::Release)).map(|at| &before[at..]);
            let told = whole
                // How it was let go is one word: `dropped flat from`.
                && from.is_some_and(|words| match words {
                    [_, how, _] => silent(how),
                    _ => words.len() > 1 && words.iter().all(plain),
                })
                && before.last().is_some_and(|w| {
                    let leads = w.is(Atom::Filler) || w.is(Atom::Height);
                    Phrase::From.is(&folded(&w.text)) || leads && beyond && after.is_empty()
                })
                && !before.iter().any(turns);
            // Whatever else the clause holds: a ball was let go, and the number stands behind
            // `from`, or before `height`.
            let last = before.last().map(|w| folded(&w.text)).unwrap_or_default();
            let begins = after.first().is_some_and(|w| w.is(Atom::Height));
            let follows = from.is_some_and(|words| words.iter().all(|w| plain(w) && !w.is(Atom::Tool)));
            let mut next = after.iter().filter(|w| !w.is(Atom::Height) && !w.is(Atom::Filler));
            let leads = next.next().is_some_and(|w| w.is(Atom::Release));
            // Other languages say `from` at the end of the word: `180 cm magasságból ejtettük`.
            let placed = Phrase::From.is(&last) || begins && (leads || Phrase::At.is(&last));
            let all = || before.iter().chain(&after);
            // A height that says by its ending that something came from it needs no more than that.
            let ending = begins && Phrase::From.is(&after.first().map(|w| folded(&w.text)).unwrap_or_default());
            let ending = ending && from.is_some_and(|words| !words.iter().any(|w| w.is(Atom::Tool)));
            let of_ball = placed && (follows || leads) && beyond && all().any(names_ball);
            let of_ball = of_ball || ending && beyond && all().any(names_ball);
            // What brackets hold is a remark: `the ball (size 7)`.
            let bare = split(&without_brackets(named)).into_iter().any(|w| matches!(w.kind, Kind::Number(_)));
            let counted = bare || after.iter().any(|w| matches!(w.kind, Kind::Number(_)));
            let of_ball = of_ball && !counted && !all().any(turns);
            // Something else was done as well, from there: `dropped it and filmed it from`.
            let and = |w: &Word| Phrase::And.is(&folded(&w.text));
            let other = from.is_some_and(|words| Phrase::From.is(&last) && words.iter().any(and));
            // `180 cm from the wall` is no height.
            let away = !begins && Phrase::From.is(&after.first().map(|w| folded(&w.text)).unwrap_or_default());
            let other = other || away && !after.iter().any(|w| w.is(Atom::Floor));
            let fits = before.iter().all(plain) && (whole || said && !after.iter().any(turns)) || told || of_ball;
            return (fits && !other).then_some(height);
        }
        let (value, before) = last_number(clause.trim_end())?;
        let heading = Heading::parse(before);
        let unit = heading.unit.filter(|unit| unit.dimension == Dimension::Length && !unit.unscaled())?;
        (heading.unknown.is_empty() && heading.has(Atom::Release) && !heading.turns()).then(|| DropHeight {
            text: clause.trim().to_owned(),
            value,
            unit,
            sign: signed(before.split(['(', '[']).next().unwrap_or_default()).map_or(0, |(_, sign)| sign),
        })
    })
}

/// The words without how often something was done: `dropped three times from`.
fn without_times(mut words: Vec<Word>) -> Vec<Word> {
    let counts = |word: &Word| {
        let spelt = folded(&word.text);
        matches!(word.kind, Kind::Number(_)) || Phrase::Count.is(&spelt) || Phrase::Several.is(&spelt)
    };
    let often = |pair: &[Word]| counts(&pair[0]) && Phrase::Times.is(&folded(&pair[1].text));
    while let Some(at) = words.windows(2).position(often) {
        words.drain(at..at + 2);
    }
    words
}

/// The text before the sign of a height that it ends in, `h0`, `(H_1)`, and the number of the sign.
fn signed(text: &str) -> Option<(&str, usize)> {
    let text = text.trim_end().trim_end_matches([')', ']']);
    let at = text.rfind([' ', '(', '[']).map_or(0, |at| at + 1);
    let count = folded(&text[at..]).strip_prefix('h')?.trim_start_matches('_').parse().ok()?;
    Some((text[..at].trim_end_matches([' ', '(', '[', ',']), count)).filter(|_| count <= MANY)
}

/// Whether a word is what balls are called, or ends in it: `ball`, `Wasserball`, `pelota`.
pub(super) fn names_ball(word: &Word) -> bool {
    let spelt = folded(&word.text);
    let known = word.is(Atom::Label) || word.is(Atom::Group);
    Phrase::Called.is(&spelt) || known && Phrase::Ball.all().iter().any(|ball| spelt.ends_with(ball))
}

/// A text whose number with its error in brackets, and the unit behind these, is the number with
/// the unit: `(120 ± 0.5) cm`.
fn without_error(text: &str) -> Cow<'_, str> {
    let found = text.split_once('(').and_then(|(before, rest)| {
        let (inside, after) = rest.split_once(')')?;
        let (number, error) = ["±", "+/-"].iter().find_map(|mark| inside.split_once(mark))?;
        let bare = |text: &str| text.trim().replace(',', ".").parse::<f64>().is_ok();
        (bare(number) && bare(error)).then(|| format!("{before}{} {}", number.trim(), after.trim_start()))
    });
    found.map_or(Cow::Borrowed(text), Cow::Owned)
}

/// A text without a length in brackets that is the one before it in another unit: `1 m (100 cm)`.
fn without_repeat(text: &str) -> Cow<'_, str> {
    let length = |text: &str| match cell::read(text, false) {
        Cell::Number(m) => Some((m.value, m.unit.filter(|unit| unit.dimension == Dimension::Length)?)),
        _ => None,
    };
    let found = text.match_indices('(').find_map(|(at, _)| {
        let (before, rest) = (&text[..at], &text[at + 1..]);
        let (inside, after) = rest.split_once(')')?;
        let words: Vec<&str> = before.split_whitespace().collect();
        let last = |n: usize| length(&words.get(words.len().checked_sub(n)?..)?.join(" "));
        let ((repeat, unit), (value, of)) = (length(inside.trim())?, last(2).or_else(|| last(1))?);
        let same = rounds_to(of.si(value) / unit.si(1.0), repeat, step(std::iter::once(repeat)));
        (same && unit != of).then(|| format!("{}{after}", before.trim_end()))
    });
    found.map_or(Cow::Borrowed(text), Cow::Owned)
}

/// The parts of a sentence; a comma within a number parts none.
pub(super) fn clauses(text: &str) -> impl Iterator<Item = &str> {
    // Blanks beside each other part what stands in one line: `Floor: gym   Drop height = 1 m`.
    let parts = text.split([';', '!']).flat_map(|part| part.split(", ")).flat_map(|part| part.split(". "));
    parts.flat_map(parted).filter(|part| !part.is_empty())
}

/// What blanks beside each other part, where several parts state something by name.
fn parted(part: &str) -> Vec<&str> {
    let stated = part.split("  ").filter(|part| part.contains([':', '='])).count() > 1;
    if stated { part.split("  ").collect() } else { vec![part] }
}

/// The parts of a title that dashes tell apart, `Golf ball - dropped from 1 m`, each up to a remark
/// in brackets.
fn dashed(text: &str) -> Vec<&str> {
    let parts = [" -- ", " - ", " – ", " — "].iter().flat_map(|dash| text.split(*dash));
    // What a bracket turns, or measures in, it belongs to.
    let belongs = |inside: &str| {
        let inside = inside.split(')').next().unwrap_or_default();
        Unit::parse(inside).is_some() || split(inside).iter().any(turns_away)
    };
    let bare = |part: &'_ str| part.find('(').filter(|at| !belongs(&part[at + 1..])).unwrap_or(part.len());
    let mut found: Vec<&str> = Vec::new();
    for part in parts.map(|part| part[..bare(part)].trim()) {
        if part != text && !found.contains(&part) {
            found.push(part);
        }
    }
    found
}

/// What stands in brackets, a clause of its own.
fn bracketed(text: &str) -> Option<&str> {
    text.split_once('(').and_then(|(_, rest)| rest.split_once(')')).map(|(inside, _)| inside)
}

/// The unit that a clause states of all readings, whatever the others say; what stands behind a
/// colon, or in brackets, is a clause too: `Results: heights in cm`, `three runs (all cm)`.
pub(super) fn of_clauses(text: &str) -> Option<Unit> {
    let named = |clause: &str| {
        let behind = || clause.split_once(':').map(|(_, behind)| behind).filter(|behind| !behind.trim().is_empty());
        unit(clause).or_else(|| of_all(clause)).or_else(|| behind().and_then(|behind| unit(behind).or(of_all(behind))))
    };
    // In brackets words that say nothing need no `in`.
    let plain = |word: &Word| matches!(word.kind, Kind::Known([Atom::Filler, ..]));
    let inside = |text: &str| {
        let (name, unit) = text.trim().rsplit_once(' ')?;
        let unit = Unit::parse(unit).filter(|unit| !unit.unscaled())?;
        split(name).iter().all(plain).then_some(unit)
    };
    // `(cm, read at the bottom)`: a letter by itself may be anything.
    let whole =
        |text: &str| clauses(text).find_map(|part| Unit::parse(part).filter(|unit| part.len() > 1 && !unit.unscaled()));
    let of_brackets = || bracketed(text).and_then(|text| unit(text).or_else(|| inside(text)).or_else(|| whole(text)));
    // A title, or its last clause, ends in the unit of what stands below it: `Golf ball (cm)`.
    let ends = || {
        let last = clauses(text).last().unwrap_or(text);
        let (title, unit) = last.trim().strip_suffix(')')?.rsplit_once('(')?;
        let unit = Unit::parse(unit.trim()).filter(|unit| !unit.unscaled())?;
        let plain = title.contains(char::is_alphabetic) && !title.contains(|c: char| c.is_ascii_digit());
        (plain && matches!(unit.dimension, Dimension::Length | Dimension::Time)).then_some(unit)
    };
    let parts = || clauses(text).chain(dashed(text)).chain(clauses(text).flat_map(dashed)).find_map(named);
    let begins = || std::iter::once(text).chain(dashed(text)).find_map(begun);
    let counted = || clauses(text).chain(dashed(text)).find_map(since);
    let bare = || text.contains('(').then(|| of_clauses(&without_brackets(text))).flatten();
    unit(text).or_else(parts).or_else(of_brackets).or_else(ends).or_else(begins).or_else(counted).or_else(bare)
}

/// The unit of a clock that a clause begins with: `seconds from the start of the recording`.
fn since(clause: &str) -> Option<Unit> {
    let (unit, rest) = clause.trim().split_once(' ')?;
    let from = |word: &Word| {
        let spelt = folded(&word.text);
        word.is(Atom::After) || Phrase::From.is(&spelt) || Phrase::Since.is(&spelt)
    };
    let begins = split(rest).first().is_some_and(from) && unit.chars().count() > 1;
    Unit::parse(unit).filter(|unit| begins && unit.dimension == Dimension::Time && !unit.unscaled())
}

/// The unit of the quantity that a text begins with, whatever stands behind it: `Rebound heights in
/// cm of a ball dropped from 2 m`; but of no quantity at a release.
fn begun(text: &str) -> Option<Unit> {
    let ends = text.char_indices().filter(|(_, c)| c.is_whitespace()).map(|(at, _)| text.split_at(at));
    // Before a unit the inch is a preposition.
    let next = |rest: &str| rest.split_whitespace().next().unwrap_or_default().to_owned();
    // So it is before any word that is known: `frame in which`.
    let leads = |head: &str, rest: &str| {
        head.ends_with(" in") && matches!(split(&next(rest)).first(), Some(Word { kind: Kind::Known(_), .. }))
    };
    let whole = |head: &str, rest: &str| Unit::parse(&next(rest)).is_none() && !leads(head, rest);
    let measured = |head: &str| {
        let last = head.rsplit(char::is_whitespace).next().unwrap_or_default();
        Unit::parse(last.trim_matches(['(', ')', '[', ']', ','])).is_some()
    };
    let mut ends = ends.filter(|(head, rest)| measured(head) && whole(head, rest));
    let (found, rest) = ends.find_map(|(head, rest)| Some((unit(head)?, rest)))?;
    // A recording that begins releases nothing.
    let lets = |word: &Word| word.is(Atom::Release) && !Phrase::Begins.is(&folded(&word.text));
    let released = split(rest).iter().any(lets) && !measures(rest);
    (!released && !split(rest).iter().any(turns)).then_some(found)
}

/// `Uncertainty in heights: ±1 cm`: the standard error of all readings of a dimension, in SI units.
/// Every word has to be understood.
pub(super) fn error(text: &str) -> Option<(f64, Dimension)> {
    let signed = text.split_once([':', '=', '±']).and_then(|(name, size)| of_error(name, size, text.contains('±')));
    // `Heights read with a tape, uncertainty 1 cm`: each clause by itself, without a sign.
    let behind = |clause: &str| {
        let at = clause.find(|c: char| c.is_ascii_digit())?;
        let words = split(&clause[..at]);
        let last = words.iter().rfind(|w| !matches!(w.kind, Kind::Known([Atom::Filler])))?;
        // `se` is of a verb as well.
        if !last.is(Atom::Error) || last.text.chars().count() < 3 {
            return None;
        }
        of_error(&clause[..at], clause[at..].trim_end_matches('.'), false)
    };
    signed.or_else(|| clauses(text).filter(|clause| !clause.contains([':', '=', '±'])).find_map(behind))
}

/// The error that stands behind its name, which says that it is one unless a sign does.
fn of_error(name: &str, size: &str, sign: bool) -> Option<(f64, Dimension)> {
    let size = size.trim().trim_start_matches(['±', '+', '/', '-', ' ']);
    let Cell::Number(measured) = cell::read(size, false) else { return None };
    let (heading, unit) = (Heading::parse(name), measured.unit.filter(|unit| !unit.unscaled())?);
    let stated = heading.has(Atom::Error) || sign;
    let alike = match unit.dimension {
        Dimension::Length => !heading.has(Atom::Time) && !heading.has(Atom::Interval),
        Dimension::Time => !heading.has(Atom::Height) && !heading.has(Atom::Distance),
        _ => false,
    };
    let fits = stated && alike && heading.unknown.is_empty() && !heading.turns() && measured.value > 0.0;
    fits.then(|| (unit.si(measured.value), unit.dimension))
}

/// `All heights in cm`: the unit of what names none. Every word has to be understood, and nothing
/// is counted.
fn unit(text: &str) -> Option<Unit> {
    // `In the table stands the height in cm`.
    let bare = text.trim().split_once(' ').filter(|(first, _)| Phrase::In.is(&first.to_lowercase()));
    let heading = Heading::parse(bare.map_or(text, |(_, rest)| rest));
    let value = heading.value().filter(|_| heading.unknown.is_empty() && !heading.has(Atom::Release))?;
    let unit = heading.unit.filter(|unit| value.what.dimension() == Some(unit.dimension) && !unit.unscaled());
    let counted = text.contains(|c: char| c.is_ascii_digit());
    // `first rebound height in cm`: of the rebounds of each row there is one.
    let each = matches!(value.at, At::Row | At::Nth(1));
    let several = heading.text.trim().contains(' ') && each && value.role == Role::Reading;
    unit.filter(|_| several && !counted)
}

/// `all in cm`, `here are the numbers (cm)`: the unit that a clause of no other words states.
fn of_all(clause: &str) -> Option<Unit> {
    let clause = clause.trim().trim_end_matches([':', '.']);
    let bare = clause.trim_matches(['(', ')', '.']);
    let bracketed = clause.ends_with(')') && !clause.starts_with('(');
    // Words that no blanks part lead to a unit in Latin letters: `単位はすべてcm`.
    let joined =
        || bare.rfind(unparted).and_then(|at| bare[at..].chars().next().map(|c| bare.split_at(at + c.len_utf8())));
    let (name, unit) = bare.rsplit_once([' ', '(']).or_else(joined)?;
    let unit = Unit::parse(unit.trim_matches(['(', ')'])).filter(|unit| !unit.unscaled())?;
    let plain = |word: &Word| match word.kind {
        Kind::Known(atoms) => atoms.iter().all(|atom| {
            matches!(
                atom,
                Atom::Filler | Atom::Height | Atom::Time | Atom::Speed | Atom::Read | Atom::Number | Atom::Measure
            )
        }),
        _ => false,
    };
    let plain = |word: &Word| plain(word) || Phrase::Lengths.is(&folded(&word.text));
    let words = split(name);
    if bracketed && words.len() > 1 && words.iter().all(plain) {
        return Some(unit);
    }
    let last = words.last().is_some_and(|word| Phrase::In.is(&folded(&word.text)));
    // `단위는 모두 cm`: the unit is named as such.
    if words.len() > 1 && words.iter().all(plain) && words.iter().any(|word| word.is(Atom::Measure)) {
        return Some(unit);
    }
    // A clause may be nothing but the unit: `read at its top, in cm`.
    (last && words.iter().take(words.len() - 1).all(plain)).then_some(unit)
}

/// Whether a length stands in a text.
pub(super) fn measures(text: &str) -> bool {
    !lengths(text).is_empty()
}

/// The lengths that stand in a text, m.
pub(super) fn lengths(text: &str) -> Vec<f64> {
    let words: Vec<&str> =
        text.split_whitespace().map(|word| word.trim_matches(['(', ')', ',', ';', ':', '='])).collect();
    let apart = words.windows(2).filter(|pair| pair[0].ends_with(|c: char| c.is_ascii_digit()));
    words
        .iter()
        .filter_map(|word| cell::length(word))
        .chain(apart.filter_map(|pair| cell::length(&pair.join(" "))))
        .collect()
}

#[cfg(test)]
mod tests;
