//! Numbers in a heading that count what its readings were taken from, `mean of 3 drops (cm)`,
//! `rebound (cm), N = 5`: they place no bounce.

use std::borrow::Cow;

use super::super::phrases::Phrase;
use super::super::vocabulary::{Atom, folded};
use super::super::words::{Kind, Word, split};

/// Takes such numbers out of the words of `text`, and with them the trials that they count;
/// `bracketed` if the words are all that stands in brackets.
pub(super) fn take(words: &mut Vec<Word>, text: &str, bracketed: bool) {
    let Some((at, noun)) = counted(words, text, bracketed) else { return };
    if noun && !words[at + 1].is(Atom::Rebound) && !words[at + 1].is(Atom::Impact) {
        words.remove(at + 1);
    }
    words.remove(at);
}

/// What stands in brackets without such a number: `3 trials`, `3 drops averaged`.
pub(super) fn without(inside: &str) -> Cow<'_, str> {
    let mut words = split(inside);
    let count = words.len();
    take(&mut words, inside, true);
    let silent = words.iter().all(|w| matches!(w.kind, Kind::Known([Atom::Filler, ..])));
    let bare = || words.iter().map(|w| w.text.as_str()).collect::<Vec<_>>().join(" ");
    match words.len() < count {
        true if silent => Cow::Borrowed(""),
        true => Cow::Owned(bare()),
        false => Cow::Borrowed(inside),
    }
}

/// Where a number counts repeats, and whether the word behind it is what it counts.
fn counted(words: &[Word], text: &str, bracketed: bool) -> Option<(usize, bool)> {
    let is = |w: &Word, atoms: &[Atom]| atoms.iter().any(|atom| w.is(*atom));
    let statistic = |w: &Word| is(w, &[Atom::Mean, Atom::Median, Atom::Max, Atom::Min]);
    let filler = |w: &Word| matches!(w.kind, Kind::Known([Atom::Filler, ..]));
    let trial = |w: &Word| is(w, &[Atom::Trial, Atom::Repeat]);
    let taken = |w: &Word| trial(w) || is(w, &[Atom::Rebound, Atom::Impact]);
    // `3.`, `3回目` and `第3次` are places in an order.
    let placed = |w: &Word| {
        text.match_indices(&w.text).any(|(at, number)| {
            let after = &text[at + number.len()..];
            let dotted = after.strip_prefix(['.', 'º', 'ª']);
            dotted.is_some_and(|after| !after.starts_with(|c: char| c.is_ascii_digit()))
                || after.starts_with("回目")
                || text[..at].ends_with('第')
        })
    };
    let count = |w: &Word| match w.kind {
        Kind::Number(n) | Kind::Ordinal(n) => n > 1 && w.text.bytes().all(|b| b.is_ascii_digit()) && !placed(w),
        Kind::Unknown => Phrase::Count.is(&folded(&w.text)) || Phrase::Several.is(&folded(&w.text)),
        _ => false,
    };
    let counts = |at: usize| {
        let before = words[..at].iter().rposition(|w| !filler(w));
        let noun = words.get(at + 1).is_some_and(taken);
        let numbered = words.get(at + 2).is_some_and(|w| matches!(w.kind, Kind::Number(_) | Kind::Letter));
        let noun = noun && !numbered;
        let of_trials = noun && trial(&words[at + 1]);
        // `bounce 2`, `h2`, `ball 3`, `after 2 bounces`: the number is of what stands before it.
        let beside = |w: &Word| taken(w) || is(w, &[Atom::Group, Atom::Label]) || w.text.chars().count() == 1;
        let own = |n: usize| is(&words[n], &[Atom::After, Atom::Between]) || n + 1 == at && beside(&words[n]);
        let own = before.is_some_and(own);
        let of_mean = before.is_some_and(|n| statistic(&words[n]) && (n + 1 < at || noun));
        let stated = words.iter().any(statistic);
        // `(2 readings)`.
        let silent = at + 1 < words.len() && words[at + 1..].iter().all(filler);
        let alone = before.is_none() && bracketed && (of_trials || stated || silent);
        let counts = of_mean || alone || noun && !own && (stated || of_trials && before.is_some());
        counts.then_some((at, noun))
    };
    (0..words.len()).filter(|&at| count(&words[at])).find_map(counts)
}

/// A text without the size of a sample, `N = 5`, or `n = 5` beside a mean or the name of a rebound,
/// of which several are no place in a sequence: `h (n = 1)` is one.
pub(super) fn without_size(text: &str) -> Cow<'_, str> {
    let start = |at: usize| !text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
    let size = |(at, sign): (usize, &str)| {
        let after = text[at + sign.len()..].trim_start().strip_prefix('=')?.trim_start();
        let digits = after.find(|c: char| !c.is_ascii_digit()).unwrap_or(after.len());
        let several = after[..digits].parse::<usize>().is_ok_and(|n| n > 1);
        let words = text[..at].contains(' ') || sign == "N";
        (several && start(at) && words).then(|| (at, text.len() - after.len() + digits))
    };
    match text.match_indices(['n', 'N']).find_map(size) {
        Some((from, to)) => Cow::Owned([&text[..from], &text[to..]].concat()),
        None => Cow::Borrowed(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bare(text: &str, bracketed: bool) -> String {
        let mut words = split(text);
        take(&mut words, text, bracketed);
        words.iter().map(|w| w.text.as_str()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn numbers_of_repeats_place_nothing() {
        for (text, expected) in [
            ("mean of 3", "mean of"),
            ("mean of 3 rebounds", "mean of rebounds"),
            ("mean rebound of 5 trials", "mean rebound of"),
            ("average of three drops", "average of"),
            ("rebound height 3 trials", "rebound height"),
            ("Rebound height 3 drops averaged", "Rebound height averaged"),
            ("Mittelwert aus drei Versuche", "Mittelwert aus"),
        ] {
            assert_eq!(bare(text, false), expected, "{text}");
        }
        for (text, expected) in
            [("3 trials", ""), ("3 drops averaged", "averaged"), ("2 readings", ""), ("of 5 drops", "")]
        {
            assert_eq!(without(text), expected, "{text}");
        }
        for text in [
            "bounce 3",
            "mean bounce 3",
            "height after 3 bounces",
            "mean height after 3 bounces",
            "3rd rebound",
            "3 rebound",
            "mean h3",
            "rebound 2 trial 3",
            "trial 3 mean",
            "ball 3 trials",
            "mean 3",
            "リバウンド 3回目",
            "反弹 第3次",
        ] {
            assert_eq!(bare(text, false), split(text).iter().map(|w| w.text.as_str()).collect::<Vec<_>>().join(" "));
        }
        assert!(bare("Mittelwert 3. Aufprall", false).contains('3'));
    }

    #[test]
    fn the_size_of_a_sample_is_no_place() {
        assert_eq!(without_size("rebound (cm), N = 5"), "rebound (cm), ");
        assert_eq!(without_size("mean rebound n=3 (cm)"), "mean rebound  (cm)");
        for text in ["h(n=2)", "n = 1", "rebound n=1", "hen = 5"] {
            assert_eq!(without_size(text), text);
        }
    }
}
