//! What cells answer to a question that their column asks: yes, no, nothing, something else.

use super::vocabulary::{Atom, folded, meanings};
use super::words::{Kind, split};

/// What a cell answers.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Answer {
    Yes,
    No,
    /// Nothing stands in it.
    Empty,
    Other,
}

pub(super) fn answer(cell: &str) -> Answer {
    let spelt = folded(cell.trim());
    if spelt.is_empty() {
        return Answer::Empty;
    }
    let says = |atoms: &[Atom]| match () {
        () if atoms.contains(&Atom::Nay) || atoms.contains(&Atom::Void) => Answer::No,
        () if atoms.contains(&Atom::Yes) || atoms.contains(&Atom::Counts) => Answer::Yes,
        () => Answer::Other,
    };
    // A sign by itself is no word of a heading.
    if let Some(atoms) = meanings(&spelt) {
        return says(atoms);
    }
    match split(cell).first().map(|word| &word.kind) {
        Some(Kind::Known(atoms)) => says(atoms),
        Some(Kind::Number(0)) => Answer::No,
        Some(Kind::Number(1)) => Answer::Yes,
        _ => Answer::Other,
    }
}

/// Whether a cell answers a question, `true`, and says nothing else.
pub(super) fn answers(cell: &str) -> bool {
    matches!(answer(cell), Answer::Yes | Answer::No)
}
