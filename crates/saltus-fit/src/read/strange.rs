//! How much of a remark is not understood: the words that neither mean anything to a table nor say
//! nothing of numbers in any prose.

use std::collections::BTreeSet;

use super::listed::Listed;
use super::phrases::Phrase;
use super::vocabulary::{folded, meanings, unparted};
use super::words::{Kind, Word, split, unaddressed};

/// Words of prose that say nothing of numbers, wherever they stand.
static PLAIN: Listed = Listed::new(include_str!("plain.txt"));

/// How many words of a text are not understood, each counted once; of a list behind its name, how
/// many of the item that has the most.
pub(super) fn count(text: &str) -> usize {
    let text = unaddressed(text);
    match listed(&text) {
        Some(items) => items.map(|item| strange(item).len()).max().unwrap_or(0),
        None => strange(&text).len(),
    }
}

/// The items of a list that its name says to be of what was used, and where and by whom:
/// `Equipment: tape, two gates, a steel ball`.
fn listed(text: &str) -> Option<impl Iterator<Item = &str>> {
    let (name, items) = text.split_once([':', '：'])?;
    let names = split(name).iter().any(|word| Phrase::Used.is(&folded(&word.text)));
    let parted = items.contains([',', ';', '、', '，', '،']);
    (names && parted).then(|| items.split([',', ';', '、', '，', '،']))
}

/// The words of a text that are not understood. A word in a sentence that begins with a capital is
/// a name, and so is one with a digit in it; a letter by itself says nothing.
fn strange(text: &str) -> BTreeSet<String> {
    let named = |n: usize, word: &Word| n > 0 && word.text.starts_with(char::is_uppercase);
    let words = split(text).into_iter().enumerate().filter(|(n, word)| !named(*n, word));
    let unknown = words.filter(|(_, word)| matches!(word.kind, Kind::Unknown)).map(|(_, word)| folded(&word.text));
    unknown.filter(|word| tells(word)).collect()
}

/// Whether a word that has no meaning may tell something.
fn tells(word: &str) -> bool {
    if word.contains(unparted) {
        return run(word);
    }
    let digits = word.contains(|c: char| c.is_ascii_digit());
    !(digits || word.chars().nth(1).is_none() || PLAIN.has(word) || inflected(word))
}

/// Whether something is left of a run of a script that parts no words by blanks, without the words
/// that say nothing, and without the few letters that bend them.
fn run(word: &str) -> bool {
    let letters: Vec<(usize, char)> = word.char_indices().collect();
    let bends = |c: char| matches!(c, '\u{3040}'..='\u{309f}' | 'ー') || c.is_ascii_digit();
    let (mut at, mut bent) = (0, 0);
    while at < letters.len() {
        let end = |n: usize| letters.get(n).map_or(word.len(), |letter| letter.0);
        let known = (at + 1..=letters.len()).rev().find(|&to| PLAIN.has(&word[letters[at].0..end(to)]));
        match known {
            Some(to) => (at, bent) = (to, 0),
            None if bends(letters[at].1) && bent < BENT => (at, bent) = (at + 1, bent + 1),
            None => return true,
        }
    }
    false
}

/// So many letters in a row bend a word: more are words themselves.
const BENT: usize = 4;

/// Whether a Korean word is one that is understood, or says nothing, with a particle behind it.
fn inflected(word: &str) -> bool {
    Phrase::Particle.all().iter().filter_map(|end| word.strip_suffix(end)).any(|stem| {
        let korean = stem.ends_with(|c: char| matches!(c, '\u{ac00}'..='\u{d7a3}'));
        korean && (PLAIN.has(stem) || meanings(stem).is_some())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_words_stand_in_order() {
        assert!(PLAIN.is_in_order() && PLAIN.words().iter().all(|word| folded(word) == *word));
    }

    #[test]
    fn words_are_strange_that_may_tell_something() {
        for (text, strange) in [
            ("zorbing quuxes perched glumly", 4),
            ("quux quux QUUX quux", 1),
            ("Sketch wuzzle_v0.3 on COM7, 115200", 1),
            ("Equipment: glorp, two quuxes, steel blorp with a wuzzle", 2),
            ("We saw: glorp, two quuxes, steel blorp with a wuzzle", 4),
            ("台からスマホで録音した", 0),
            ("台から龍が録音した", 1),
            ("값은 처음에 측정한 값", 0),
        ] {
            assert_eq!(count(text), strange, "{text}");
        }
    }
}
