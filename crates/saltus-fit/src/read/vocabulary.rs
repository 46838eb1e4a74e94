//! The words that headings are made of, with their meanings: `words.tsv`, one word a line.

use std::collections::HashMap;
use std::sync::OnceLock;

use strsim::levenshtein;

use super::listed::Listed;

/// A word a line, a tab, its meanings.
const WORDS: &str = include_str!("words.tsv");

/// Given names of people.
static NAMES: Listed = Listed::new(include_str!("names.txt"));

/// A meaning of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Atom {
    // What is measured.
    Height,
    Position,
    Distance,
    Time,
    Interval,
    Total,
    Speed,
    Percent,
    // At which event.
    Release,
    Rebound,
    Impact,
    Before,
    After,
    Between,
    Rest,
    Air,
    // What tells rows and columns apart.
    Number,
    Trial,
    Repeat,
    Group,
    Label,
    Event,
    Frame,
    // A statistic of readings.
    Mean,
    Median,
    Error,
    Max,
    Min,
    // What turns the meaning: the numbers are no readings.
    Lost,
    Predicted,
    Goal,
    Derived,
    /// What is derived is a ratio.
    Ratio,
    /// What is derived is an energy.
    Energy,
    /// What is repeated may be a sample of a sound.
    Sample,
    /// A rebound at its top, or the top itself.
    Top,
    /// The lower end of the ball.
    Bottom,
    Other,
    /// A motion that is none of a bounce, though heights or speeds fall in it alike.
    Motion,
    Note,
    /// A word of bounces that is of races, waves, jumpers, carts and markets too.
    Loose,
    /// Numbers of this name were read, or are of a ball.
    Read,
    /// What a ball bounces on, at the zero of heights.
    Floor,
    /// What is derived is the COR.
    Cor,
    /// What a unit is called.
    Measure,
    /// A row counts where a column of this name says yes,
    Counts,
    /// and does not where one of this name does, or a remark.
    Void,
    Yes,
    Nay,
    /// A sign of a note below the table, behind what the note is of.
    Footnote,
    /// The word says nothing.
    Filler,
    /// A filler that readings are taken with, or by.
    Tool,
    /// The given name of a person: who dropped the ball, or read.
    Person,
    /// The word puts what follows in this place of an order.
    Ordinal(usize),
    /// The word is this unit.
    Unit(&'static str),
}

impl Atom {
    /// Whether it has to do with what is measured: a quantity, an event, a statistic, what turns
    /// the meaning.
    pub(super) fn measures(self) -> bool {
        use Atom::{
            Error, Filler, Footnote, Group, Label, Measure, Motion, Note, Number, Ordinal, Other, Person, Unit, Void,
        };
        !matches!(
            self,
            Filler
                | Footnote
                | Label
                | Group
                | Motion
                | Other
                | Note
                | Number
                | Ordinal(_)
                | Unit(_)
                | Error
                | Measure
                | Person
                | Void
        )
    }

    fn of(name: &'static str) -> Option<Self> {
        Some(match name {
            "height" => Self::Height,
            "position" => Self::Position,
            "distance" => Self::Distance,
            "time" => Self::Time,
            "interval" => Self::Interval,
            "total" => Self::Total,
            "speed" => Self::Speed,
            "percent" => Self::Percent,
            "release" => Self::Release,
            "rebound" => Self::Rebound,
            "impact" => Self::Impact,
            "before" => Self::Before,
            "after" => Self::After,
            "between" => Self::Between,
            "rest" => Self::Rest,
            "air" => Self::Air,
            "number" => Self::Number,
            "trial" => Self::Trial,
            "repeat" => Self::Repeat,
            "group" => Self::Group,
            "label" => Self::Label,
            "event" => Self::Event,
            "frame" => Self::Frame,
            "mean" => Self::Mean,
            "median" => Self::Median,
            "error" => Self::Error,
            "max" => Self::Max,
            "min" => Self::Min,
            "lost" => Self::Lost,
            "predicted" => Self::Predicted,
            "goal" => Self::Goal,
            "derived" => Self::Derived,
            "ratio" => Self::Ratio,
            "energy" => Self::Energy,
            "sample" => Self::Sample,
            "top" => Self::Top,
            "bottom" => Self::Bottom,
            "other" => Self::Other,
            "motion" => Self::Motion,
            "note" => Self::Note,
            "loose" => Self::Loose,
            "read" => Self::Read,
            "floor" => Self::Floor,
            "cor" => Self::Cor,
            "measure" => Self::Measure,
            "counts" => Self::Counts,
            "void" => Self::Void,
            "yes" => Self::Yes,
            "nay" => Self::Nay,
            "footnote" => Self::Footnote,
            "filler" => Self::Filler,
            "tool" => Self::Tool,
            _ => match name.split_once(':')? {
                ("ordinal", place) => Self::Ordinal(place.parse().ok()?),
                ("unit", symbol) => Self::Unit(symbol),
                _ => return None,
            },
        })
    }
}

/// All words with their meanings, in the order of the file, which is taken apart once.
fn words() -> impl Iterator<Item = (&'static str, &'static [Atom])> {
    static ALL: OnceLock<Vec<(&'static str, Vec<Atom>)>> = OnceLock::new();
    let parsed = || entries().map(|(word, names)| (word, names.filter_map(Atom::of).collect())).collect();
    ALL.get_or_init(parsed).iter().map(|(word, atoms)| (*word, atoms.as_slice()))
}

/// What a word means that is another one without its accents: before, in Czech, Danish and Turkish,
/// where `pred` is short for predicted, `for` says nothing and `once` counts; signs of a number, or
/// of a mean; a fall, and no pad.
pub(super) fn accented(word: &str) -> Option<&'static [Atom]> {
    match word {
        "před" | "før" | "önce" => Some(&[Atom::Before]),
        "č" | "št" => Some(&[Atom::Number]),
        "pád" => Some(&[Atom::Release]),
        "śr" => Some(&[Atom::Mean]),
        _ => None,
    }
}

/// A word whose vowels with two dots are spelt by two letters: `Ruecksprung` for `Rücksprung`.
pub(super) fn spelt_out(word: &str) -> Option<&'static [Atom]> {
    let plain = word.replace("ae", "a").replace("oe", "o").replace("ue", "u");
    meanings(&plain).filter(|_| plain != word)
}

/// The words without those that stand for two.
fn single() -> impl Iterator<Item = (&'static str, &'static [Atom])> {
    words().filter(|(word, _)| !word.contains(' '))
}

/// Those that begin with the letter that a word does.
fn beginning(word: &str) -> impl Iterator<Item = (&'static str, &'static [Atom])> {
    type Words = HashMap<char, Vec<(&'static str, &'static [Atom])>>;
    static ALL: OnceLock<Words> = OnceLock::new();
    let all = ALL.get_or_init(|| {
        let mut all = Words::new();
        for (word, atoms) in single() {
            all.entry(word.chars().next().unwrap_or_default()).or_default().push((word, atoms));
        }
        all
    });
    word.chars().next().and_then(|letter| all.get(&letter)).into_iter().flatten().copied()
}

/// The meanings of a word, or of two parted by a blank, in lower case without accents; `None` if it
/// is not known.
pub(super) fn meanings(word: &str) -> Option<&'static [Atom]> {
    static ALL: OnceLock<HashMap<&'static str, &'static [Atom]>> = OnceLock::new();
    let known = ALL.get_or_init(|| words().collect()).get(word).copied();
    known.or_else(|| NAMES.has(word).then_some(&[Atom::Person]))
}

/// The signs of notes below a table.
pub(super) fn footnotes() -> impl Iterator<Item = char> {
    words().filter(|(_, atoms)| *atoms == [Atom::Footnote]).filter_map(|(sign, _)| sign.chars().next())
}

/// The word that is spelt most like `word`, if any is alike enough to be meant: one edit in three
/// letters. What is longer or shorter by more than that is no further compared.
pub(super) fn nearest(word: &str) -> Option<&'static str> {
    let length = word.chars().count();
    let most = length / 3;
    let says = |(_, atoms): &(&str, &[Atom])| atoms.iter().any(|atom| *atom != Atom::Filler);
    let near = single().filter(says).filter(|(known, _)| known.chars().count().abs_diff(length) <= most);
    let known = near.map(|(known, _)| (levenshtein(word, known), known));
    known.min_by_key(|(edits, _)| *edits).filter(|(edits, _)| *edits <= most).map(|(_, known)| known)
}

/// More rows than these are not looked through for words, nor comments.
pub(super) const ROWS: usize = 200;

/// Words of fewer letters may well be others; one of them may be missing in what is misspelt.
pub(super) const MISSPELT: usize = 6;

/// The word that a misspelt one is meant to be: it begins with the same letter, and one letter is
/// missing, too many, another, or has changed places with its neighbour. `None` where words of
/// different meanings are as near.
pub(super) fn misspelt(word: &str) -> Option<(&'static str, &'static [Atom])> {
    // Digits that stand for the letters they look like: `dr0p`.
    if word.contains(|c: char| c.is_ascii_digit()) {
        let letter = |c: char| match c {
            '0' => 'o',
            '1' => 'l',
            c => c,
        };
        let spelt: String = word.chars().map(letter).collect();
        return beginning(&spelt).find(|(known, _)| *known == spelt);
    }
    let letters = word.chars().count();
    if letters + 1 < MISSPELT || word.contains(|c: char| !c.is_alphabetic()) {
        return None;
    }
    let near = |(known, _): &(&str, &[Atom])| {
        let long = known.chars().count();
        long >= MISSPELT && letters.abs_diff(long) < 2 && slip(word, known)
    };
    let mut found = beginning(word).filter(near);
    let first = found.next()?;
    found.all(|(_, atoms)| atoms == first.1).then_some(first)
}

/// An abbreviation has so many letters at least.
const SHORT: usize = 3;

/// The word that a beginning of one, or its consonants, are short for, `reb`, `drp`: of a quantity,
/// an event or a statistic, as are all words that may be meant, and of one meaning. `None` where
/// they differ.
pub(super) fn short_for(word: &str) -> Option<(&'static str, &'static [Atom])> {
    if word.chars().count() < SHORT || word.contains(|c: char| !c.is_alphabetic()) {
        return None;
    }
    let meant = |known: &str| known.starts_with(word) || consonants(known).eq(word.chars());
    let mut found = beginning(word).filter(|(known, _)| meant(known));
    let first = found.next()?;
    let alike = |(_, atoms): (&str, &'static [Atom])| meaning(atoms).eq(meaning(first.1));
    (first.1.iter().all(|atom| atom.measures()) && found.all(alike)).then_some(first)
}

/// A word without its vowels, but with the first letter.
fn consonants(word: &str) -> impl Iterator<Item = char> {
    let vowel = |c: char| matches!(c, 'a' | 'e' | 'i' | 'o' | 'u' | 'y');
    word.char_indices().filter(move |(at, c)| *at == 0 || !vowel(*c)).map(|(_, c)| c)
}

/// What a word means, without how loosely it is used.
fn meaning(atoms: &'static [Atom]) -> impl Iterator<Item = &'static Atom> {
    atoms.iter().filter(|atom| !matches!(atom, Atom::Loose | Atom::Read))
}

/// Whether a slip of one letter makes one word of the other.
pub(super) fn slip(a: &str, b: &str) -> bool {
    let head = a.chars().zip(b.chars()).take_while(|(x, y)| x == y).map(|(x, _)| x.len_utf8()).sum();
    let (a, b) = (&a[head..], &b[head..]);
    match (parted(a), parted(b)) {
        (Some((x, one)), Some((y, other))) => {
            let swapped =
                parted(one).zip(parted(other)).is_some_and(|((v, one), (w, other))| x == w && v == y && one == other);
            one == b || a == other || one == other || swapped
        }
        (Some((_, rest)), None) | (None, Some((_, rest))) => rest.is_empty(),
        (None, None) => false,
    }
}

/// The first letter of a word, and the others.
fn parted(word: &str) -> Option<(char, &str)> {
    word.chars().next().map(|first| (first, &word[first.len_utf8()..]))
}

fn entries() -> impl Iterator<Item = (&'static str, std::str::Split<'static, char>)> {
    let lines = WORDS.lines().filter(|line| !line.starts_with('#'));
    lines.filter_map(|line| line.split_once('\t')).map(|(word, names)| (word, names.split(' ')))
}

/// The longest word that a text begins with, of a script that parts none by blanks.
pub(super) fn first_word(text: &str) -> Option<&str> {
    let mut ends = text.char_indices().rev().map(|(at, c)| at + c.len_utf8());
    ends.find(|&end| meanings(&text[..end]).is_some()).map(|end| &text[..end])
}

/// The signs that an error stands behind.
pub(super) const SPREAD: [&str; 4] = ["±", "+/-", "+/−", "+-"];

/// A text whose letters, digits and signs of full width, as East Asian keyboards write them, are
/// the plain ones, and whose signs of an error, `+/-`, are one.
pub(super) fn narrow(text: &str) -> String {
    let plain = |c: char| match c {
        '\u{ff01}'..='\u{ff5e}' => char::from_u32(u32::from(c) - u32::from('！') + u32::from('!')).unwrap_or(c),
        '\u{3000}' => ' ',
        '【' => '[',
        '】' => ']',
        c => c,
    };
    let text: String = text.chars().map(plain).collect();
    SPREAD[1..].iter().fold(text, |text, sign| text.replace(sign, SPREAD[0]))
}

/// Whether a letter is of a script that parts no words by blanks.
pub(super) fn unparted(c: char) -> bool {
    matches!(c, '\u{3040}'..='\u{30ff}' | '\u{3400}'..='\u{9fff}')
}

/// Letters with marks, and the plain ones.
const MARKED: [(&str, &str); 37] = [
    ("àáâãäåąăāảạấầẩẫậắằẳẵặ", "a"),
    ("çćčĉċ", "c"),
    ("ďđð", "d"),
    ("èéêëęěēėẻẽẹếềểễệ", "e"),
    ("ğģĝ", "g"),
    ("ìíîïıīįỉĩị", "i"),
    ("ķ", "k"),
    ("łļľĺ", "l"),
    ("ñńňņ", "n"),
    ("òóôõöøőōỏọốồổỗộơớờởỡợ", "o"),
    ("řŕ", "r"),
    ("śşšș", "s"),
    ("ťţț", "t"),
    ("ùúûüůűūųủũụưứừửữự", "u"),
    ("ŵẅ", "w"),
    ("ýỳỷỹỵŷÿ", "y"),
    ("źżž", "z"),
    ("ά", "α"),
    ("έ", "ε"),
    ("ή", "η"),
    ("ί", "ι"),
    ("ό", "ο"),
    ("ύ", "υ"),
    ("ώ", "ω"),
    ("ё", "е"),
    ("æ", "ae"),
    ("œ", "oe"),
    ("ß", "ss"),
    ("þ", "th"),
    ("أإآ", "ا"),
    ("ة", "ه"),
    ("ي", "ی"),
    ("ك", "ک"),
    ("ँ", "ं"),
    // A subscript letter names a component of a vector.
    ("ₓ", "x"),
    ("ᵧ", "y"),
    // Vowels of Arabic, and marks that turn the direction of writing.
    ("\u{64b}\u{64c}\u{64d}\u{64e}\u{64f}\u{650}\u{651}\u{652}\u{200c}\u{200e}\u{200f}", ""),
];

/// A text in lower case, its accents and the marks of subscripts taken off: `Höhe h₁` is `hohe h1`.
pub(super) fn folded(text: &str) -> String {
    let mut found = String::with_capacity(text.len());
    for c in text.chars().flat_map(char::to_lowercase) {
        match c {
            '₀'..='₉' => found.extend(char::from_digit(u32::from(c) - u32::from('₀'), 10)),
            // Accents by themselves, as some programs write them.
            '\u{300}'..='\u{36f}' => {}
            c if c.is_ascii() => found.push(c),
            c => match MARKED.iter().find(|(marked, _)| marked.contains(c)) {
                Some((_, plain)) => found.push_str(plain),
                None => found.push(c),
            },
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_stands_once_in_plain_letters_and_has_a_meaning() {
        let mut seen = std::collections::HashSet::new();
        for (word, names) in entries() {
            assert!(seen.insert(word), "{word} stands twice");
            assert_eq!(folded(word), word);
            let names: Vec<&str> = names.collect();
            assert!(!names.is_empty() && names.iter().all(|name| Atom::of(name).is_some()), "{word}: {names:?}");
        }
        assert!(seen.len() > 400);
    }

    #[test]
    fn names_are_in_order_and_have_no_other_meaning() {
        assert!(NAMES.is_in_order() && NAMES.words().iter().all(|name| folded(name) == *name));
        assert!(NAMES.words().iter().all(|name| words().all(|(word, _)| word != *name)));
    }

    #[test]
    fn a_slip_of_one_letter_is_read() {
        for (word, meant) in [
            ("droped", Some("dropped")),
            ("bouced", Some("bounced")),
            ("heigth", Some("height")),
            ("hieght", Some("height")),
            ("rebuond", None),
            ("predcted", Some("predicted")),
            ("weight", None),
            ("wobble", None),
            ("sped", None),
            ("dr0p", Some("drop")),
            ("w0bble", None),
        ] {
            assert_eq!(misspelt(word).map(|(known, _)| known), meant, "{word}");
        }
    }

    #[test]
    fn a_beginning_of_words_of_one_meaning_is_short_for_it() {
        let meant = |word: &str| short_for(word).map(|(_, atoms)| atoms.to_vec());
        assert_eq!(meant("veloc"), Some(vec![Atom::Speed]));
        assert_eq!(meant("theor"), Some(vec![Atom::Predicted]));
        assert_eq!(meant("trl"), Some(vec![Atom::Trial]));
        // Of several meanings, of balls, or too short.
        assert_eq!(["pre", "ten", "re", "wob"].map(meant), [None, None, None, None]);
    }

    #[test]
    fn the_nearest_word_is_an_edit_in_three_letters_away() {
        assert_eq!((nearest("hieght"), nearest("wobble")), (Some("height"), None));
    }
}
