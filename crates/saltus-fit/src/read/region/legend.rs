//! What lines around a table say that the signs above its columns stand for.

use std::borrow::Cow;

use super::super::cell::{Cell, read};
use super::super::clause::clauses;
use super::super::grid::View;
use super::super::heading::{Heading, Meaning, What, is_sign};
use super::super::vocabulary::ROWS;

/// Signs, and the words for them: `h0 = drop height in cm, h1: rebound in cm`.
#[derive(Default)]
pub(super) struct Legend(Vec<(String, String)>);

impl Legend {
    /// The legend that cells of words and comments of a text hold, no further than `ROWS` from its
    /// edges.
    pub(super) fn of(view: View<'_>) -> Self {
        let grid = view.grid;
        let edges = (0..grid.rows()).filter(|row| *row < ROWS || row + ROWS >= grid.rows());
        let cells = edges.flat_map(|row| (0..grid.width(row)).map(move |n| grid.cell(row, n)));
        let comments = grid.comments().take(ROWS).map(|(_, text)| text);
        let lines = cells.chain(comments).filter(|text| MARKS.iter().any(|mark| text.contains(mark)));
        Self(lines.flat_map(clauses).filter_map(stated).collect())
    }

    /// What a cell says: the words that its sign stands for, or itself. A number, the unit and the
    /// name of a statistic may stand beside the sign: `t2 (s)`, `mean t (s)`.
    pub(super) fn words<'a>(&'a self, cell: &'a str) -> Cow<'a, str> {
        let (name, unit) = cell.split_at(cell.find(['(', '[']).unwrap_or(cell.len()));
        let says = |(sign, words): &'a (String, String)| {
            if sign == cell {
                return Some(Cow::Borrowed(words.as_str()));
            }
            let digits = |rest: &&str| rest.bytes().all(|b| b.is_ascii_digit());
            let number = |token: &'a str| token.strip_prefix(sign.as_str()).filter(digits);
            let (own, beside): (Vec<_>, Vec<_>) = name.split_whitespace().partition(|token| number(token).is_some());
            let [token] = own.as_slice() else { return None };
            let whole = beside.is_empty() || Heading::parse(&beside.join(" ")).sums_up();
            let fits = whole && Heading::parse(words).unit.is_some() == unit.is_empty();
            // Words that count contacts themselves are of one reading, whose repeats are counted.
            let count = number(token).filter(|n| !n.is_empty()).unwrap_or_default();
            let of = if count.is_empty() || !words.contains(|c: char| c.is_ascii_digit()) { "" } else { "trial" };
            let spelt = [words, of, count, &beside.join(" "), unit].join(" ");
            fits.then(|| Cow::Owned(spelt.split_whitespace().collect::<Vec<_>>().join(" ")))
        };
        self.0.iter().find_map(says).unwrap_or(Cow::Borrowed(cell))
    }
}

/// What stands between a sign and its words.
const MARKS: [&str; 4] = ["=", ":", " – ", " - "];

/// A sign and the words that a clause gives it, which say what it measures.
fn stated(clause: &str) -> Option<(String, String)> {
    let (sign, words) = MARKS.iter().find_map(|mark| clause.split_once(mark))?;
    let sign = sign.trim_matches(|c: char| c.is_whitespace() || matches!(c, '%' | '#' | '*' | '-' | '('));
    if !is_sign(sign) {
        return None;
    }
    // A sign that says what it is, or how it is worked out, needs no words.
    let words = words.trim().trim_end_matches('.');
    let unit = sign.chars().nth(1).is_some() && Heading::parse(sign).unit.is_some();
    if unit || matches!(read(words, false), Cell::Number(_)) || words.contains(['=', '/', '√', '^']) {
        return None;
    }
    // What brackets hold behind them is a remark.
    let bare = words.split(" (").next().unwrap_or(words);
    [words, bare].into_iter().find_map(|words| {
        let heading = Heading::parse(words);
        let says = match &heading.meaning {
            Meaning::Value(value) => value.what != What::Unsaid,
            Meaning::Setting | Meaning::Trial => true,
            _ => false,
        };
        (says && heading.unknown.is_empty()).then(|| (sign.to_owned(), words.to_owned()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sign of more letters would be a word of another language; of none longer than one letter
    /// `h_mean` were none.
    #[test]
    fn signs_are_no_words() {
        for sign in ["h", "h0", "h_mean", "hśr", "v'", "hreb1"] {
            assert!(is_sign(sign), "{sign}");
        }
        for word in ["hauteurs", "wobbling", "drop", "Ball", "0h", "h 1", "", "height"] {
            assert!(!is_sign(word), "{word}");
        }
    }

    #[test]
    fn signs_stand_for_words_that_measure() {
        for (clause, expected) in [
            ("h0 = drop height in cm", Some(("h0", "drop height in cm"))),
            ("R: rebound height (cm)", Some(("R", "rebound height (cm)"))),
            ("% h1 = rebound height in cm (with a wobble)", Some(("h1", "rebound height in cm"))),
            ("h1 = 64 cm", None),
            ("COR = h1/h0", None),
            ("D = wobble (cm)", None),
            ("Height: rebound height (cm)", None),
            ("d = diameter", None),
            ("t – time between the bounces", Some(("t", "time between the bounces"))),
            ("t = time between the bounces", Some(("t", "time between the bounces"))),
        ] {
            let expected = expected.map(|(sign, words)| (sign.to_owned(), words.to_owned()));
            assert_eq!(stated(clause), expected, "{clause}");
        }
    }

    #[test]
    fn units_and_numbers_stand_behind_a_sign() {
        let legend = Legend(vec![
            ("t".to_owned(), "time between the bounces".to_owned()),
            ("R".to_owned(), "rebound height in cm".to_owned()),
        ]);
        for (cell, words) in [
            ("t (s)", "time between the bounces (s)"),
            ("t2 (s)", "time between the bounces 2 (s)"),
            ("R", "rebound height in cm"),
            ("R3", "rebound height in cm 3"),
            ("R (mm)", "R (mm)"),
            ("t mean (s)", "time between the bounces mean (s)"),
            ("mean t (s)", "time between the bounces mean (s)"),
            ("t wobble (s)", "t wobble (s)"),
            ("trial", "trial"),
        ] {
            assert_eq!(legend.words(cell), words, "{cell}");
        }
    }
}
