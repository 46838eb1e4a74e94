//! What the numbers and names in a heading count.

use super::super::vocabulary::Atom;
use super::{ARTICLE, Kind, Word};

/// The numbers and names in a heading, each with what it counts.
#[derive(Default)]
pub(in crate::read) struct Numbers {
    pub(in crate::read) bounce: Vec<usize>,
    pub(in crate::read) trial: String,
    pub(in crate::read) group: String,
}

pub(in crate::read) fn numbers(words: &[Word]) -> Numbers {
    let mut found = Numbers::default();
    let of_trial = |w: &Word| (w.is(Atom::Trial) || w.is(Atom::Repeat)) && !w.is(Atom::Filler);
    let of_group = |w: &Word| w.is(Atom::Group) || w.is(Atom::Label);
    let counts =
        |w: &Word| matches!(w.kind, Kind::Known(atoms) if !matches!(atoms, [Atom::Filler, ..] | [Atom::Number, ..]));
    let mut group: Vec<&str> = Vec::new();
    let mut labelled = false;
    for (n, word) in words.iter().enumerate() {
        let before = words[..n].iter().rev().find(|w| counts(w));
        match word.kind {
            Kind::Number(_) | Kind::Letter if before.is_some_and(of_trial) => {
                let name = before.map_or("", |w| w.text.as_str());
                found.trial = format!("{name} {}", word.text);
            }
            Kind::Number(_) | Kind::Letter if before.is_some_and(of_group) => {
                group.push(&word.text);
                labelled = true;
            }
            // Behind a word that says nothing it counts what that names: `class 7`, `camera 2`.
            Kind::Number(_) if names(words, n) => {
                let name = || format!("{} {}", words[n - 1].text, word.text);
                found.trial = Some(std::mem::take(&mut found.trial)).filter(|t| !t.is_empty()).unwrap_or_else(name);
            }
            Kind::Number(count) => found.bounce.push(count),
            Kind::Ordinal(count) | Kind::Known(&[Atom::Ordinal(count)]) => {
                let next = words[n + 1..].iter().find(|w| counts(w));
                if next.is_some_and(of_trial) {
                    found.trial = format!("{} {count}", next.map_or("", |w| w.text.as_str()));
                } else if next.is_some_and(of_group) {
                    group.push(&word.text);
                    labelled = true;
                } else {
                    found.bounce.push(count);
                }
            }
            // What bears the name of a person is what that person dropped, or read.
            _ if word.is(Atom::Person) && found.trial.is_empty() => word.text.clone_into(&mut found.trial),
            _ if of_group(word) => {
                labelled |= word.is(Atom::Label);
                group.push(&word.text);
            }
            _ => {}
        }
    }
    if labelled {
        found.group = group.join(" ");
    }
    found
}

/// Whether the number at `n` is of the word before it, which says nothing of a bounce, and neither
/// does the word behind it, unless the one before is no article: `class 7 rebound`.
fn names(words: &[Word], n: usize) -> bool {
    let filler = |w: &Word| matches!(w.kind, Kind::Known([Atom::Filler]));
    let of = |w: &Word, atoms: &[Atom]| atoms.iter().any(|atom| w.is(*atom));
    // `after the 3 bounces`, `between the 2`.
    let placed = words[..n].iter().rev().find(|w| !filler(w));
    let placed = placed.is_some_and(|w| of(w, &[Atom::After, Atom::Before, Atom::Between, Atom::Number]));
    let next = words.get(n + 1).is_some_and(|w| of(w, &[Atom::Rebound, Atom::Impact]));
    let silent = |atom: &Atom| matches!(atom, Atom::Filler | Atom::Note | Atom::Tool);
    let silent = |w: &Word| matches!(w.kind, Kind::Known(atoms) if atoms.iter().all(silent));
    let article = |w: &Word| filler(w) && w.text.chars().count() < ARTICLE;
    n > 0 && silent(&words[n - 1]) && !(next && article(&words[n - 1])) && !placed
}
