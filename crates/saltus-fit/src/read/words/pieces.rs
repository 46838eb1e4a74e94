//! The pieces that a text is parted into, and what is no part of it: addresses, brackets.

use std::borrow::Cow;

use crate::read::phrases::Phrase;
use crate::read::vocabulary::{Atom, first_word, folded, meanings, unparted};

fn greek(c: char) -> bool {
    matches!(c, '\u{370}'..='\u{3ff}')
}

/// A text without the addresses in it, `sam@school.example`: they are names, whatever their words
/// mean elsewhere.
pub(in crate::read) fn unaddressed(text: &str) -> Cow<'_, str> {
    let address = |word: &str| {
        let parted = |mark| word.split_once(mark).is_some_and(|(a, b)| !a.is_empty() && b.contains('.'));
        parted("@") || parted("://")
    };
    if !text.split_whitespace().any(address) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.split_whitespace().filter(|word| !address(word)).collect::<Vec<_>>().join(" "))
}

/// A text without what its brackets hold.
pub(in crate::read) fn without_brackets(text: &str) -> String {
    let (mut found, mut rest) = (String::new(), text);
    while let Some((before, inside)) = rest.split_once('(') {
        found.push_str(before);
        rest = inside.split_once(')').map_or("", |(_, after)| after);
    }
    found + rest
}

/// Whether a word of a text is of this kind.
pub(in crate::read) fn has_word(text: &str, phrase: Phrase) -> bool {
    pieces(text).iter().any(|word| phrase.is(&folded(word)))
}

/// The runs of letters and digits of a text, its signs as words.
pub(in crate::read) fn pieces(text: &str) -> Vec<String> {
    let text = unaddressed(text);
    let mut spelt = String::with_capacity(text.len());
    let mut letters = text.chars().peekable();
    while let Some(c) = letters.next() {
        match c {
            '√' => spelt.push_str(" root "),
            '²' | '³' => spelt.push_str(" squared "),
            'Δ' | '∆' => spelt.push_str(" delta "),
            '±' => spelt.push_str(" error "),
            // A letter of a Greek word is none.
            'σ' if !spelt.ends_with(greek) && !letters.peek().is_some_and(|c| greek(*c)) => spelt.push_str(" error "),
            'Ø' | 'ø'
                if !spelt.ends_with(char::is_alphabetic) && !letters.peek().is_some_and(|c| c.is_alphabetic()) =>
            {
                spelt.push_str(" mean ");
            }
            '#' | '№' => spelt.push_str(" number "),
            '%' => spelt.push_str(" percent "),
            '{' | '}' | '\u{a0}' => spelt.push(' '),
            c => spelt.push(c),
        }
    }
    spelt = spelt.replace("^2", " squared ");
    for spread in ["s.e.m.", "S.E.M.", "s.e.", "S.E.", "s.d.", "S.D."] {
        spelt = spelt.replace(spread, " error ");
    }
    for number in ["N°", "n°", "N.º", "n.º", "Nº", "nº"] {
        spelt = spelt.replace(number, " number ");
    }
    spelt = spelt.replace(".º", "º").replace(".ª", "ª");
    // `h'` beside `h`, `v'` beside `v`: after the impact.
    let primed = |text: &str, letter: char| {
        let mark = |c: char| matches!(c, '\'' | '′' | '’');
        let mut letters = text.trim().chars();
        letters.next() == Some(letter)
            && letters.next().is_some_and(mark)
            && !letters.next().is_some_and(char::is_alphanumeric)
    };
    let spelt = match ['h', 'H', 'v', 'V'].into_iter().find(|letter| primed(&spelt, *letter)) {
        Some(letter) => spelt.trim().replacen(letter, &format!("{letter} after "), 1),
        None => spelt,
    };
    // Whose it is: "the ball's height".
    let spelt = spelt.replace("'s ", " ").replace("’s ", " ");
    // A date is none.
    let parts: Vec<&str> = spelt.split('/').filter(|part| part.contains(char::is_alphabetic)).collect();
    // Names, `Anna / Tom`, are no ratio.
    let known = |word: Option<&str>| {
        let word = folded(word.unwrap_or_default());
        let sign = word.starts_with(char::is_alphabetic) && word.contains(|c: char| c.is_ascii_digit());
        word.chars().count() < 3 || sign || meanings(&word).is_some_and(|atoms| *atoms != [Atom::Person])
    };
    let end = |c: char| !c.is_alphanumeric();
    // Nor is who is short for a name: `Léa M. / Tom K.`.
    let initial = |part: &str| {
        let last = part.trim_end().rsplit(' ').next().unwrap_or_default();
        last.ends_with('.') && last.chars().count() == 2 && last.starts_with(char::is_uppercase)
    };
    let ratio = |pair: &[&str]| {
        let names = initial(pair[0]) || initial(pair[1].split(" -").next().unwrap_or_default());
        !names
            && (known(pair[0].split(end).rfind(|w| !w.is_empty())) || known(pair[1].split(end).find(|w| !w.is_empty())))
    };
    let mut found: Vec<String> = spelt
        .split(|c: char| !c.is_alphanumeric() && !marks(c) && !matches!(c, '°' | 'º' | 'ª'))
        .filter(|piece| !piece.is_empty())
        .flat_map(parted)
        .collect();
    if parts.windows(2).any(ratio) {
        found.push("ratio".to_owned());
    }
    found
}

/// Whether a character is a mark of the letter before it, and no letter by itself: an accent, the
/// sign that a consonant of an Indian script has no vowel, the points of Hebrew and what shortens
/// its words.
pub(in crate::read) fn marks(c: char) -> bool {
    // The second half of the block of each Indian script begins with its sign of no vowel.
    let bare = matches!(c, '\u{900}'..='\u{d7f}') && matches!(u32::from(c) % 0x80, 0x3c | 0x4d);
    bare || matches!(c, '\u{300}'..='\u{36f}' | '\u{591}'..='\u{5c7}' | '\u{5f3}' | '\u{5f4}' | '\u{e47}'..='\u{e4e}')
}

/// The words of a piece: of a script that parts none by blanks the longest that are known, and what
/// stands between them.
fn parted(piece: &str) -> Vec<String> {
    let (mut words, mut rest) = (Vec::new(), piece);
    while rest.contains(unparted) {
        let plain = rest.find(unparted).filter(|&at| at > 0);
        // What is not known ends where a word of several letters begins that is.
        let several = |at: &usize| first_word(&rest[*at..]).is_some_and(|word| word.chars().nth(1).is_some());
        let next = || rest.char_indices().map(|(at, _)| at).skip(1).find(several);
        let end = plain.or(first_word(rest).map(str::len)).or_else(next).unwrap_or(rest.len());
        words.push(rest[..end].to_owned());
        rest = &rest[end..];
    }
    words.extend(Some(rest.to_owned()).filter(|rest| !rest.is_empty()));
    words
}
