//! Sentences that tell from where a ball was dropped and how high it came back, `We dropped it from
//! 1 m and it came back to 64 cm. From 80 cm it rose to 51 cm.`: a row for each drop.

use std::collections::BTreeSet;

use super::super::cell::length;
use super::super::heading::Heading;
use super::super::phrases::Phrase;
use super::super::sequence::LEVEL;
use super::super::vocabulary::{Atom, folded};
use super::super::words::{Word, split};
use super::{Part, parts};

/// A drop: the line that its rebound stands in, both heights as they are written, and what
/// stands of other lengths behind them.
struct Drop {
    line: usize,
    heights: [String; 2],
    rest: String,
}

/// What a length in a sentence is.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Release,
    Rebound,
    Other,
    /// How well all were read.
    Error,
}

/// The text with a row for each drop, two or more, and its other lines as remarks; `None` where a
/// sentence says of a height neither that the ball fell from it nor that it rose to it, but speaks
/// of that, or of what was not measured, and where several balls are named.
pub(super) fn table(text: &str) -> Option<String> {
    let bare = |line: &str| line.contains(|c: char| c.is_ascii_digit()) && !line.contains(char::is_alphabetic);
    if text.contains(['\t', '|', '=']) || text.lines().any(bare) {
        return None;
    }
    let drops = drops(text)?;
    let falls = |drop: &Drop| matches!(drop.heights.each_ref().map(|h| length(h)), [Some(a), Some(b)] if b < a);
    if drops.len() < 2 || !drops.iter().all(falls) {
        return None;
    }
    let spelt = |(n, line): (usize, &str)| {
        let row = |drop: &Drop| format!("{}\t{}", drop.heights.join("\t"), drop.rest);
        let rows: Vec<String> = drops.iter().filter(|drop| drop.line == n).map(row).collect();
        let header = (drops[0].line == n).then(|| "drop height\trebound height\tremark".to_owned());
        // A lone carriage return ends a row, and no line.
        match rows.is_empty() {
            true if line.trim().is_empty() => String::new(),
            true => format!("#{line}"),
            false => header.into_iter().chain(rows).collect::<Vec<_>>().join("\r"),
        }
    };
    Some(text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// The drops that sentences tell of.
fn drops(text: &str) -> Option<Vec<Drop>> {
    let mut drops: Vec<Drop> = Vec::new();
    let mut balls: BTreeSet<String> = BTreeSet::new();
    for (first, paragraph) in paragraphs(text) {
        let joined = paragraph.replace('\n', " ");
        let (mut from, mut release): (usize, Option<String>) = (0, None);
        for sentence in joined.split_inclusive(". ").flat_map(|part| part.split_inclusive(['!', '?', ';'])) {
            let at = from;
            from += sentence.len();
            let (found, behind) = parts(sentence);
            let lengths: Vec<&Part<'_>> = found.iter().filter(|part| length(part.number).is_some()).collect();
            let mut rose = false;
            for (n, part) in lengths.iter().enumerate() {
                let after = lengths.get(n + 1).map_or(behind, |next| next.words);
                match role(part.words, after)? {
                    Role::Release if release.is_none() => (release, rose) = (Some(part.number.to_owned()), false),
                    Role::Rebound if !rose => {
                        let heights = [release.take()?, part.number.to_owned()];
                        // Where in the text the number stands.
                        let place = at + (part.number.as_ptr() as usize - sentence.as_ptr() as usize);
                        let line = first + paragraph[..place].matches('\n').count();
                        drops.push(Drop { line, heights, rest: String::new() });
                        rose = true;
                    }
                    // `it came back to 86 cm, 88 cm and 87 cm`: again from there.
                    Role::Other if rose && part.joins(&[' ', ',', '\n']) => {
                        let Drop { line, heights: [release, last], .. } = drops.last()?;
                        // Those that fall may be of bounces one after the other.
                        length(part.number).zip(length(last)).filter(|(next, last)| *next > LEVEL * last)?;
                        let (line, heights) = (*line, [release.clone(), part.number.to_owned()]);
                        drops.push(Drop { line, heights, rest: String::new() });
                    }
                    Role::Other if rose => {
                        let rest = &mut drops.last_mut()?.rest;
                        let more = format!("{rest} {} {}", part.words, part.number);
                        more.trim_start_matches([' ', ',']).clone_into(rest);
                    }
                    Role::Other if release.is_none() => {}
                    Role::Error => {}
                    _ => return None,
                }
            }
            if rose {
                let named =
                    split(sentence).into_iter().filter(|word| word.is(Atom::Label)).map(|word| folded(&word.text));
                balls.insert(named.collect::<Vec<_>>().join(" "));
            }
        }
        if release.is_some() {
            return None;
        }
    }
    balls.retain(|name| !name.is_empty());
    (balls.len() < 2).then_some(drops)
}

/// The lines between blank ones, with the number of the first.
fn paragraphs(text: &str) -> Vec<(usize, String)> {
    let mut found: Vec<(usize, String)> = Vec::new();
    let mut open = false;
    for (n, line) in text.lines().enumerate() {
        match (line.trim().is_empty(), open) {
            (true, _) => open = false,
            (false, false) => {
                found.push((n, line.to_owned()));
                open = true;
            }
            (false, true) => {
                if let Some((_, text)) = found.last_mut() {
                    text.push('\n');
                    text.push_str(line);
                }
            }
        }
    }
    found
}

/// What a length is by the words before it and behind it; `None` where they say that it was not
/// read, or that the ball both fell from it and rose to it.
fn role(before: &str, after: &str) -> Option<Role> {
    let turns = [Atom::Predicted, Atom::Goal, Atom::Lost, Atom::Derived, Atom::Error, Atom::Mean, Atom::Max, Atom::Min];
    let words = split(before);
    // `and the uncertainty is 1 cm`: of no drop.
    let error = words.iter().rposition(|word| word.is(Atom::Error));
    if error.is_some_and(|at| words[at + 1..].iter().all(|word| word.is(Atom::Filler))) {
        return Some(Role::Error);
    }
    // `from the greatest drop height, 2 m`: the highest of those in the text.
    let of_drop = |word: &Word| word.is(Atom::Release) || word.is(Atom::Height) || word.is(Atom::Filler);
    let extreme = |word: &Word| word.is(Atom::Max) || word.is(Atom::Min);
    let from = words.iter().rposition(|word| Phrase::From.is(&folded(&word.text)));
    let of_extreme = from.is_some_and(|at| {
        let after = &words[at + 1..];
        after.iter().all(|word| of_drop(word) || extreme(word)) && after.iter().any(|word| word.is(Atom::Release))
    });
    if of_extreme {
        return Some(Role::Release);
    }
    if words.iter().any(|word| turns.iter().any(|atom| word.is(*atom))) {
        return None;
    }
    let fell = |word: &Word| word.is(Atom::Release);
    let rose = |word: &Word| Phrase::Rose.is(&folded(&word.text)) || word.is(Atom::Rebound) && !word.is(Atom::Top);
    // `from a height of`.
    let silent = |word: &Word| word.is(Atom::Height) || word.is(Atom::Filler);
    let from = words.iter().rposition(|word| Phrase::From.is(&folded(&word.text)));
    let from = from.is_some_and(|at| words[at + 1..].iter().all(silent));
    // `drop height 2 m`.
    let named = words.last().is_some_and(fell) || Heading::parse(before).has(Atom::Release) && words.len() < 3;
    match (named, words.iter().any(rose)) {
        _ if from => Some(Role::Release),
        (true, false) => Some(Role::Release),
        (false, true) => Some(Role::Rebound),
        (true, true) => None,
        // `from 1 m, 64 cm back`.
        (false, false) if split(after).first().is_some_and(rose) => Some(Role::Rebound),
        (false, false) if words.iter().any(fell) => None,
        (false, false) => Some(Role::Other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_say_what_the_heights_of_a_sentence_are() {
        let header = "drop height\trebound height\tremark";
        for (text, rows) in [
            (
                "We dropped the ball from 1 m and it came back to 64 cm.\nFrom 80 cm it bounced up to 51 cm. It is 4 cm wide.\n",
                Some(format!("{header}\r1 m\t64 cm\t\n80 cm\t51 cm\t\n")),
            ),
            (
                "Aus 1,0 m Höhe sprang der Ball 0,64 m hoch zurück. Aus einer\nHöhe von 1,5 m erreichte er 0,96 m.\n",
                Some(format!("{header}\r1,0 m\t0,64 m\t\n1,5 m\t0,96 m\t\n")),
            ),
            (
                "Dropped from 1 m it rose to 64 cm, third time 63 cm. From 2 m it rose to 1.3 m.\n",
                Some(format!("{header}\r1 m\t64 cm\tthird time 63 cm\r2 m\t1.3 m\t\n")),
            ),
            (
                "From 1 m it rose to 64 cm, and from the lowest drop height, 50 cm, it rose to 32 cm. The error is about 1 cm.\n",
                Some(format!("{header}\r1 m\t64 cm\t\r50 cm\t32 cm\t\n")),
            ),
            (
                "We dropped it from 1 m. It came back to 64 cm, 63 cm and 65 cm.\n",
                Some(format!("{header}\r1 m\t64 cm\t\n1 m\t63 cm\t\n1 m\t65 cm\t\n").replace("\n1", "\r1")),
            ),
            ("We dropped it from 1 m. It came back to 64 cm, 41 cm and 26 cm.\n", None),
            ("From 1 m it rose to 64 cm. From 2 m the maximum of all was 1.3 m.\n", None),
            ("Dropped from 1 m it should come back to 64 cm. From 2 m it rose to 1.3 m.\n", None),
            ("Dropped from 1 m it came back to 64 cm.\n", None),
            ("Dropped from 64 cm it rose to 1 m. From 70 cm it rose to 1.1 m.\n", None),
            ("The tennis ball fell from 1 m and rose to 55 cm. The golf ball fell from 1 m and rose to 75 cm.\n", None),
            ("It rose to 64 cm. From 2 m it rose to 1.3 m. From 1 m it rose to 64 cm.\n", None),
        ] {
            assert_eq!(table(text), rows, "{text}");
        }
    }
}
