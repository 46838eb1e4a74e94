//! The points of a ball that its height is read at, as words name them.

use super::phrases::Phrase;
use super::vocabulary::{Atom, folded};
use super::words::{Word, split};

/// A point of the ball that heights are read at.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum End {
    Bottom,
    Middle,
    Top,
}

/// Whether a text is the end of a ball and nothing else: `top`, `lower edge`.
pub(super) fn names_end(text: &str) -> bool {
    let words = split(text);
    let silent = |word: &Word| word.is(Atom::Filler) && !word.is(Atom::Bottom);
    let end = words.iter().filter(|word| point(word).is_some()).count();
    end == 1 && words.iter().all(|word| point(word).is_some() || silent(word))
}

/// The end of a ball that a word names.
pub(super) fn point(word: &Word) -> Option<End> {
    match &*folded(&word.text) {
        _ if word.is(Atom::Bottom) => Some(End::Bottom),
        text if Phrase::Top.is(text) => Some(End::Top),
        text if Phrase::Middle.is(text) => Some(End::Middle),
        _ => None,
    }
}
