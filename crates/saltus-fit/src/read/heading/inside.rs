//! What stands within a heading beside its words: a height of release, what hundredths are of, the
//! place of a reading before or after a bounce.

use std::borrow::Cow;

use super::super::cell::{Cell, fraction, read};
use super::super::phrases::Phrase;
use super::super::units::{Dimension, Scale, Unit};
use super::super::vocabulary::{Atom, folded, meanings, unparted};
use super::super::words::{Kind, Word, lets_loose, split};

/// A height of release that a heading or a title states.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::read) struct DropHeight {
    /// As it is written.
    pub(in crate::read) text: String,
    /// The number, in `unit`.
    pub(in crate::read) value: f64,
    pub(in crate::read) unit: Unit,
    /// The number of the sign that stands for it, 1 of `H1`: heights after it count on from there.
    pub(in crate::read) sign: usize,
}

impl DropHeight {
    /// The height, m.
    pub(in crate::read) fn metres(&self) -> f64 {
        self.unit.si(self.value)
    }
}

/// A text of which no colon parts the end of a number in an order from it, as in Swedish: `1:a
/// studsen`.
pub(super) fn swedish(text: &str) -> Cow<'_, str> {
    let end = |at: usize| {
        let (before, after) = (&text[..at], &text[at + 2..]);
        before.ends_with(|c: char| c.is_ascii_digit()) && !after.starts_with(char::is_alphanumeric)
    };
    let found = [":a", ":e"].iter().flat_map(|mark| text.match_indices(mark)).find(|(at, _)| end(*at));
    found.map_or(Cow::Borrowed(text), |(at, _)| Cow::Owned(format!("{}{}", &text[..at], &text[at + 1..])))
}

/// Takes the word out that leads from a number to the next, `time 1 to 2`: from contact to contact.
pub(super) fn ranges(words: &mut Vec<Word>) {
    let leads = |three: &[Word]| match (&three[0].kind, &three[2].kind) {
        (Kind::Number(from), Kind::Number(to)) => *to == from + 1 && Phrase::UpTo.is(&folded(&three[1].text)),
        _ => false,
    };
    if let Some(at) = words.windows(3).position(leads) {
        words.remove(at + 1);
    }
}

/// Drops that are only counted are not more than this.
const COUNTED: f64 = 20.0;

/// The height of release in a text, `dropped from 1.5 m`, `50 cm drop`, `h0 = 1 m`, and the text
/// without it.
pub(in crate::read) fn release(text: &str) -> Option<(DropHeight, String)> {
    released(text).map(|(drop, before, after)| (drop, format!("{before} {after}")))
}

/// The height of release in a text, what stands before it, and what behind it.
pub(in crate::read) fn released(text: &str) -> Option<(DropHeight, &str, &str)> {
    let starts = |(at, c): &(usize, char)| {
        let before = text[..*at].chars().next_back();
        // Where no blanks part words, a number stands behind any.
        let apart = |b: char| unparted(b) || !b.is_alphanumeric() && !matches!(b, '.' | ',' | '_' | '±' | '-');
        c.is_ascii_digit() && before.is_none_or(apart)
    };
    // What stands behind a sign of an error is no height.
    let error = |at: usize| text[..at].trim_end().ends_with(['±', '+', '-', '−']);
    text.char_indices().filter(starts).filter(|(at, _)| !error(*at)).find_map(|(at, _)| {
        let (value, unit, written, end) = length(&text[at..])?;
        let length = unit.dimension == Dimension::Length && matches!(unit.scale, Scale::Si { .. });
        let before = folded(text[..at].trim_end_matches([' ', '=', ':', '(']));
        let word = before.rsplit(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
        let is = |word: &str, atom: Atom| meanings(word).is_some_and(|atoms| atoms.contains(&atom));
        let counted = value.fract() == 0.0 && value <= COUNTED && is(word, Atom::Trial);
        let from = Phrase::From.is(word);
        let parts = [&text[..at], &text[at + end..]];
        let word_of_release = |part: &&str| {
            let plain = folded(part).split(|c: char| !c.is_alphanumeric()).any(|word| is(word, Atom::Release));
            let joined = part.contains(unparted) && split(part).iter().any(|word| word.is(Atom::Release));
            plain || joined || lets_loose(part)
        };
        let fits = length && value > 0.0 && !counted && (from || parts.iter().any(word_of_release));
        fits.then_some((DropHeight { text: written, value, unit, sign: 0 }, parts[0], parts[1]))
    })
}

/// Whether a letter is of the Korean script.
fn hangul(c: char) -> bool {
    matches!(c, '\u{ac00}'..='\u{d7a3}')
}

/// A length at the start of a text: its number, its unit, as it is written, and where it ends.
type Length = (f64, Unit, String, usize);

/// `1.5 m`, `40 1/2 in`, and with a part in a smaller unit `1 m 20 cm`, `5 feet and 3 inches`.
fn length(text: &str) -> Option<Length> {
    let (value, unit, written, end) = part(text)?;
    let feet = Unit::parse("ft") == Some(unit);
    let rest = text[end..].trim_start();
    let joined = rest.split_once(' ').filter(|(word, _)| feet && Phrase::And.is(word));
    let rest = joined.map_or(rest, |(_, rest)| rest);
    let smaller = |other: &Unit| other.dimension == unit.dimension && other.si(1.0) < unit.si(1.0);
    Some(match part(rest).filter(|(_, other, ..)| smaller(other)) {
        Some((more, other, also, to)) => {
            let value = value + other.si(more) / unit.si(1.0);
            (value, unit, format!("{written} {also}"), text.len() - rest.len() + to)
        }
        None => (value, unit, written, end),
    })
}

/// A number and its unit.
fn part(text: &str) -> Option<Length> {
    let digits = text.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == ',')).unwrap_or(text.len());
    let value: f64 = text[..digits].replace(',', ".").parse().ok()?;
    let after = text[digits..].trim_start();
    let (value, after) =
        fraction(after).map_or((value, after), |(over, under, rest)| (value + over / under, rest.trim_start()));
    let number = text[..text.len() - after.len()].trim_end();
    // Behind the unit words may follow that no blank parts from it: `2m高さ`.
    let other = |c: char| after.starts_with(|c: char| c.is_ascii_alphabetic()) && (unparted(c) || hangul(c));
    let end = after.find(|c: char| other(c) || !c.is_alphabetic() && !matches!(c, '"' | '\'')).unwrap_or(after.len());
    // So they may behind one of their own script: `30厘米自由落下`.
    let ends = || after[..end].char_indices().map(|(at, c)| at + c.len_utf8());
    let joined = || after.starts_with(|c: char| unparted(c) || hangul(c));
    let begun = || ends().rev().find_map(|end| Some((Unit::parse(&after[..end])?, end))).filter(|_| joined());
    let (unit, end) = Unit::parse(&after[..end]).map(|unit| (unit, end)).or_else(begun)?;
    Some((value, unit, format!("{number} {}", &after[..end]), text.len() - after.len() + end))
}

/// Takes what hundredths are of out of the words, `% of drop height`; says whether they are of the
/// height before.
pub(super) fn hundredths(words: &mut Vec<Word>) -> Option<bool> {
    let at = words.iter().position(|w| w.is(Atom::Percent))?;
    let of = words.get(at + 1).is_some_and(|w| {
        matches!(
            &*folded(&w.text),
            "of" | "von"
                | "der"
                | "des"
                | "du"
                | "de"
                | "da"
                | "di"
                | "del"
                | "dell"
                | "della"
                | "van"
                | "av"
                | "af"
                | "din"
                | "od"
                | "от"
        )
    });
    // `Fallhöhe` in the genitive before the sign, as in Turkish or Japanese: `落下高さの%`.
    let ahead =
        words[..at].iter().rposition(|w| !matches!(w.kind, Kind::Known(_)) || !of_a_height(w)).map_or(0, |n| n + 1);
    let behind = words[ahead..at].iter().any(|w| w.is(Atom::Height))
        && words[ahead..at].iter().any(|w| w.is(Atom::Release) || w.is(Atom::Before));
    if !of && behind && ahead > 0 && words.len() <= at + 2 {
        return Some(words.drain(ahead..).any(|w| w.is(Atom::Before)));
    }
    let content =
        words[at..].iter().any(|w| w.is(Atom::Derived) || w.is(Atom::Lost) || matches!(w.kind, Kind::Unknown));
    if !of || content {
        return None;
    }
    let before = words.drain(at..).any(|w| w.is(Atom::Before));
    Some(before)
}

/// Whether a word is of the height that something began at, and of nothing else.
fn of_a_height(word: &Word) -> bool {
    let of = [Atom::Height, Atom::Release, Atom::Before, Atom::Filler];
    of.iter().any(|atom| word.is(*atom)) && !word.is(Atom::Rebound)
}

/// What a ratio of heights is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::read) enum Of {
    /// The height of release.
    Release,
    /// The height before, or of the drop of its row.
    Before,
}

/// What the numbers of a column are parts of whose words name a ratio of heights and nothing else:
/// `h/h0`, `height ratio`, `% of previous height`.
/// An energy is kept as the height is.
pub(super) fn share(text: &str, words: &[Word], hundredths: Option<bool>, percent: bool) -> Option<Of> {
    let is = |atom: Atom| words.iter().any(|word| word.is(atom));
    let derived = |word: &Word| word.is(Atom::Derived) && !word.is(Atom::Ratio) && !word.is(Atom::Energy);
    let other =
        [Atom::Speed, Atom::Time, Atom::Interval, Atom::Total, Atom::Lost, Atom::Predicted, Atom::Goal, Atom::Error];
    let plain = !words.iter().any(derived) && !other.into_iter().any(is);
    let named = is(Atom::Ratio) || is(Atom::Energy) && percent || hundredths == Some(true);
    if !(plain && named && (is(Atom::Height) || is(Atom::Energy) || hundredths == Some(true))) {
        return None;
    }
    let first = |word: &Word| matches!(word.kind, Kind::Number(0)) || word.text == "H" || word.is(Atom::Release);
    // `h1/h0` is of one bounce.
    let later = words.iter().any(|word| matches!(word.kind, Kind::Number(n) if n > 0));
    let counted = text.contains('/') && words.iter().any(first) && !later;
    Some(if hundredths == Some(true) || !counted { Of::Before } else { Of::Release })
}

/// The place of a reading beside the bounce of its row, and the text without the sums: 1 for
/// `h_n+1`, -1 for `h_n-1`, 0 for `h_n`; none for what lies between two places, `between bounce n
/// and n+1`.
pub(super) fn place(text: &str) -> (Option<i8>, String) {
    let spelt = text.replace('ₙ', "_n").replace('ₖ', "_k").replace('₊', "+").replace('₋', "-").replace('₁', "1");
    let (mut rest, mut bare) = (spelt.as_str(), String::new());
    let mut found: Vec<i8> = Vec::new();
    while let Some((end, step, after)) = counter(rest, bare.chars().next_back()) {
        bare.push_str(&rest[..end]);
        rest = after;
        found.push(step);
    }
    bare.push_str(rest);
    match found.as_slice() {
        [] => (None, text.to_owned()),
        [first, others @ ..] if others.iter().all(|step| step == first) => match first {
            0 => (Some(0), text.to_owned()),
            step => (Some(*step), bare),
        },
        _ => (None, bare),
    }
}

/// The first letter that counts bounces, `n`, `i` or `k` by itself: where it ends, what is added to
/// it, and the text behind the sum. `last` is the letter before the text.
fn counter(text: &str, last: Option<char>) -> Option<(usize, i8, &str)> {
    let letters: Vec<(usize, char)> = text.char_indices().collect();
    let alone = |n: usize| {
        let before = n.checked_sub(1).map_or(last, |before| Some(letters[before].1));
        before.is_some_and(|c| !c.is_alphanumeric()) && letters.get(n + 1).is_none_or(|(_, c)| !c.is_alphanumeric())
    };
    let (_, &(at, _)) = letters.iter().enumerate().find(|(n, (_, c))| matches!(c, 'n' | 'i' | 'k') && alone(*n))?;
    let after = text[at + 1..].trim_start_matches([' ', '}']);
    let plain = Some((at + 1, 0, &text[at + 1..]));
    let step = match after.chars().next() {
        Some('+') => 1,
        Some('-' | '−' | '–') => -1,
        _ => return plain,
    };
    let sign = after.chars().next().map_or(0, char::len_utf8);
    match after[sign..].trim_start().strip_prefix('1') {
        Some(rest) if !rest.starts_with(char::is_alphanumeric) => Some((at + 1, step, rest)),
        _ => plain,
    }
}

/// Whether words name the COR, and neither its square nor an energy.
pub(super) fn is_cor(words: &[Word]) -> bool {
    let text = |w: &Word| folded(&w.text);
    // `u(e)` is the error of it.
    if let [first, _] = words
        && matches!(&*text(first), "u" | "s" | "δ" | "σ")
    {
        return false;
    }
    words.iter().any(|w| w.is(Atom::Cor)) && !words.iter().any(|w| text(w) == "squared" || text(w).starts_with("energ"))
}

/// The sign of what a formula of other columns gives: `e` of `e = √(h1/h0)`. A number behind the
/// sign is stated, and a unit in brackets no formula.
pub(super) fn computed(text: &str) -> Option<&str> {
    let (sign, formula) = text.split_once('=')?;
    let unit = |at: usize| Unit::parse(formula[at..].trim_matches(['(', ')', '[', ']', ' '])).is_some();
    let formula = formula.rfind(['(', '[']).filter(|at| unit(*at)).map_or(formula, |at| &formula[..at]);
    let stated = formula.trim_start().starts_with(|c: char| c.is_ascii_digit());
    let combines = formula.contains(['/', '*', '^', '√', '·', '×', '÷']) && formula.contains(char::is_alphabetic);
    (combines && !stated).then(|| sign.trim())
}

/// Whether a text lists units of one kind, `ft, in`: each cell names its own.
pub(super) fn of_units(text: &str) -> bool {
    let units = text.split([',', '/', '&', ' ']).filter(|word| !word.is_empty() && !Phrase::And.is(word));
    let mut found = units.map(|word| Unit::parse(word).map(|unit| unit.dimension));
    let first = found.next().flatten();
    let mut rest = found.peekable();
    first.is_some() && rest.peek().is_some() && rest.all(|dimension| dimension == first)
}

/// Whether a text asks for units behind the numbers, `with unit!`.
pub(super) fn asks_for_unit(text: &str) -> bool {
    let words = split(text);
    words.iter().any(|word| word.is(Atom::Measure)) && words.iter().all(|w| w.is(Atom::Measure) || w.is(Atom::Filler))
}

/// A sign of a quantity has fewer letters: `h_mean` has five, `height` is a word.
const SIGN: usize = 6;

/// Whether a text is the sign of a quantity, `h`, `h_0`, `vin`, and no word with a meaning.
pub(in crate::read) fn is_sign(text: &str) -> bool {
    let letters = || text.chars().filter(|c| c.is_alphabetic());
    let end = text.find(|c: char| !c.is_alphabetic()).unwrap_or(text.len());
    let word = text[..end].chars().count() > 1 && meanings(&folded(&text[..end])).is_some();
    let joined = text.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '\''));
    !word && end > 0 && joined && letters().count() < SIGN
}

/// Whether a unit is of two parts of one number: feet, a point, inches are no number of either.
pub(super) fn of_two_parts(text: &str) -> bool {
    let dimension = |unit: &str| Unit::parse(unit).map(|unit| unit.dimension);
    let parts = text.split_once('.').filter(|(one, other)| !one.is_empty() && !other.is_empty());
    parts.is_some_and(|(one, other)| dimension(one).is_some() && dimension(one) == dimension(other))
}

/// What is found in a text and taken out of it.
pub(super) fn taken<T>(text: &mut String, find: fn(&str) -> Option<(T, String)>) -> Option<T> {
    let (found, rest) = find(text)?;
    *text = rest;
    Some(found)
}

/// A number of degrees or of a pressure beside other words, which tells their column from others:
/// `rebound at 23 °C (cm)`; and the text without it.
pub(super) fn condition(text: &str) -> Option<(String, String)> {
    let digit = |c: char| c.is_ascii_digit();
    let number = |c: char| digit(c) || matches!(c, '.' | ',');
    let begins =
        |(at, c): &(usize, char)| digit(*c) && !text[..*at].ends_with(|c: char| number(c) || c.is_alphabetic());
    let found = text.char_indices().filter(begins).find_map(|(at, _)| {
        let unit = text[at..].trim_start_matches(number).trim_start();
        let ends = unit.find([' ', '(', '[', ')', ']', ',', ';']).unwrap_or(unit.len());
        let state = Unit::parse(&unit[..ends]).is_some_and(|unit| unit.scale == Scale::State);
        let from = text[..at].strip_suffix(['-', '−']).map_or(at, str::len);
        state.then(|| (from, text.len() - unit.len() + ends))
    });
    let (from, to) = found?;
    let rest = [&text[..from], &text[to..]].concat();
    let other = |w: &Word| !matches!(w.kind, Kind::Known([Atom::Filler, ..]));
    let bare = rest.split(['(', '[']).next().unwrap_or_default();
    split(bare).iter().any(other).then(|| (text[from..to].trim().to_owned(), rest))
}

/// Whether a text is a number of degrees, of a pressure, of anything but lengths, times and speeds,
/// and nothing else: `21 °C`.
pub(super) fn of_a_condition(text: &str) -> bool {
    let other = |unit: Unit| unit.dimension == Dimension::Other && !matches!(unit.scale, Scale::Energy { .. });
    let begins = text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '−'));
    begins && !text.contains(['(', '[']) && matches!(read(text, false), Cell::Number(m) if m.unit.is_some_and(other))
}

/// Whether a text is the format of a clock: `min:sec`, `hh:mm:ss.ms`.
pub(super) fn of_a_clock(text: &str) -> bool {
    let part = |part: &str| {
        let zeros = !part.is_empty() && part.chars().all(|c| c == '0');
        zeros || matches!(&*folded(part), "h" | "hh" | "m" | "mm" | "min" | "s" | "ss" | "sec" | "ms" | "sss" | "f")
    };
    text.contains(':') && text.split([':', '.', ',']).all(part)
}
