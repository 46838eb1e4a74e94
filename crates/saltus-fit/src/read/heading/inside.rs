//! What stands within a heading beside its words: a height of release, what hundredths are of, the place of a reading before or after a bounce.

use super::super::units::{Dimension, Scale, Unit};
use super::super::vocabulary::{Atom, folded, meanings};
use super::super::words::{Kind, Word};

/// A height of release that a heading or a title states.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::read) struct DropHeight {
    /// As it is written.
    pub(in crate::read) text: String,
    /// The number, in `unit`.
    pub(in crate::read) value: f64,
    pub(in crate::read) unit: Unit,
}

impl DropHeight {
    /// The height, m.
    pub(in crate::read) fn metres(&self) -> f64 {
        self.unit.si(self.value)
    }
}

/// Drops that are only counted are not more than this.
const COUNTED: f64 = 20.0;

/// The height of release in a text, `dropped from 1.5 m`, `50 cm drop`, `h0 = 1 m`, and the text without it.
pub(in crate::read) fn release(text: &str) -> Option<(DropHeight, String)> {
    let starts = |(at, c): &(usize, char)| {
        let before = text[..*at].chars().next_back();
        c.is_ascii_digit() && before.is_none_or(|b| !b.is_alphanumeric() && !matches!(b, '.' | ',' | '_' | '±' | '-'))
    };
    text.char_indices().filter(starts).find_map(|(at, _)| {
        let digits =
            text[at..].find(|c: char| !(c.is_ascii_digit() || c == '.' || c == ',')).unwrap_or(text.len() - at);
        let value: f64 = text[at..at + digits].replace(',', ".").parse().ok()?;
        let after = text[at + digits..].trim_start();
        let end = after.find(|c: char| !c.is_alphabetic() && !matches!(c, '"' | '\'')).unwrap_or(after.len());
        let unit = Unit::parse(&after[..end])?;
        let length = unit.dimension == Dimension::Length && matches!(unit.scale, Scale::Si { .. });
        let rest = format!("{} {}", &text[..at], &after[end..]);
        let before = folded(text[..at].trim_end_matches([' ', '=', ':', '(']));
        let word = before.rsplit(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
        let is = |word: &str, atom: Atom| meanings(word).is_some_and(|atoms| atoms.contains(&atom));
        let counted = value.fract() == 0.0 && value <= COUNTED && is(word, Atom::Trial);
        let from = matches!(word, "from" | "aus" | "depuis" | "desde" | "vanaf" | "h0" | "h_0");
        let released = folded(&rest).split(|c: char| !c.is_alphanumeric()).any(|word| is(word, Atom::Release));
        let text = format!("{} {}", &text[at..at + digits], &after[..end]);
        (length && value > 0.0 && !counted && (from || released)).then_some((DropHeight { text, value, unit }, rest))
    })
}

/// Takes what hundredths are of out of the words, `% of drop height`; says whether they are of the height before.
pub(super) fn hundredths(words: &mut Vec<Word>) -> Option<bool> {
    let at = words.iter().position(|w| w.is(Atom::Percent))?;
    let of = words.get(at + 1).is_some_and(|w| {
        matches!(&*folded(&w.text), "of" | "von" | "der" | "des" | "du" | "de" | "di" | "del" | "van")
    });
    let content =
        words[at..].iter().any(|w| w.is(Atom::Derived) || w.is(Atom::Lost) || matches!(w.kind, Kind::Unknown));
    if !of || content {
        return None;
    }
    let before = words.drain(at..).any(|w| w.is(Atom::Before));
    Some(before)
}

/// The place of a reading beside the bounce of its row: 1 for `h_n+1`, -1 for `h_n-1`, 0 for `h_n`; and the text without the sum.
pub(super) fn place(text: &str) -> (Option<i8>, String) {
    let spelt = text.replace('ₙ', "_n").replace('ₖ', "_k").replace('₊', "+").replace('₋', "-").replace('₁', "1");
    let letters: Vec<(usize, char)> = spelt.char_indices().collect();
    for (n, &(at, letter)) in letters.iter().enumerate().skip(1) {
        let alone = !letters[n - 1].1.is_alphanumeric() && letters.get(n + 1).is_none_or(|(_, c)| !c.is_alphanumeric());
        if !matches!(letter, 'n' | 'i' | 'k') || !alone {
            continue;
        }
        let after = spelt[at + 1..].trim_start_matches([' ', '}']);
        let step = match after.chars().next() {
            Some('+') => 1,
            Some('-' | '−' | '–') => -1,
            _ => return (Some(0), text.to_owned()),
        };
        let sign = after.chars().next().map_or(0, char::len_utf8);
        let Some(rest) = after[sign..].trim_start().strip_prefix('1') else { return (Some(0), text.to_owned()) };
        if rest.starts_with(char::is_alphanumeric) {
            return (Some(0), text.to_owned());
        }
        return (Some(step), format!("{}{rest}", &spelt[..at]));
    }
    (None, text.to_owned())
}

/// Whether words name the COR, and neither its square nor an energy.
pub(super) fn is_cor(words: &[Word]) -> bool {
    const NAMES: [&str; 16] = [
        "cor",
        "e",
        "cr",
        "restitution",
        "restitucion",
        "restituzione",
        "restituicao",
        "stosszahl",
        "stossziffer",
        "restitutionszahl",
        "restitutionskoeffizient",
        "restitutiecoefficient",
        "coefrest",
        "coeffrest",
        "restcoeff",
        "elastizitatszahl",
    ];
    let text = |w: &Word| folded(&w.text);
    words.iter().any(|w| NAMES.contains(&text(w).as_str()))
        && !words.iter().any(|w| text(w) == "squared" || text(w).starts_with("energ"))
}
