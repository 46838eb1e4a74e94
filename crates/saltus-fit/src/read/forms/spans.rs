//! Lines that name two bounces, one after the other, and the time from the first to the second:
//! `between 1 and 2: 704 ms`, `1-2: 580 ms`.

use super::super::cell::{self, Cell};
use super::super::clause;
use super::super::heading::Heading;
use super::super::phrases::Phrase;
use super::super::units::{Dimension, Unit};
use super::super::vocabulary::{Atom, folded};
use super::super::words::{Kind, Word, split};

/// The bounce that a line begins at, and its time; whether that bears a unit of time. Where a line
/// says that the times are between bounces, `counted`, these may be called times: `lần 1 -> lần 2`.
fn span(line: &str, counted: bool) -> Option<(usize, &str, bool)> {
    let marked = line.split_once(": ").or_else(|| line.split_once('=')).or_else(|| line.split_once('\t'));
    // Blanks may part them, where the time bears its unit: `1 -> 2   746 ms`.
    let (name, value) = marked
        .or_else(|| line.trim_end().rsplit_once("  ").filter(|(_, value)| value.contains(char::is_alphabetic)))?;
    let Cell::Number(m) = cell::read(value.trim(), false) else { return None };
    let timed = m.unit.is_some_and(|unit| unit.dimension == Dimension::Time);
    let words = split(name);
    let number = |word: &Word| match word.kind {
        Kind::Number(n) | Kind::Ordinal(n) => Some(n),
        _ => None,
    };
    let [from, to] = words.iter().filter_map(number).collect::<Vec<_>>().try_into().ok()?;
    // Words that say nothing of a quantity: `between`, `from`, `to`, `and`, of bounces.
    let joins = |word: &Word| {
        let text = folded(&word.text);
        Phrase::And.is(&text) || Phrase::From.is(&text) || text.chars().nth(1).is_none()
    };
    let plain = |word: &Word| {
        let said = [Atom::Between, Atom::Impact, Atom::Rebound, Atom::Filler, Atom::Interval, Atom::Time, Atom::Air];
        number(word).is_some()
            || joins(word)
            || counted && (word.is(Atom::Trial) || word.is(Atom::Repeat))
            || said.iter().any(|atom| word.is(*atom))
    };
    let bare = m.unit.is_none() || timed;
    (bare && to == from + 1 && words.iter().all(plain)).then_some((from, value.trim(), timed))
}

/// The text with a row for each of such lines, two or more, in their order, and the others as
/// remarks that measure nothing. `None` where no unit of time stands behind them or above, and
/// where a bounce is left out.
pub(super) fn table(text: &str) -> Option<String> {
    let between = |line: &str| {
        let words = split(line);
        let of = |atoms: &[Atom]| words.iter().any(|word| atoms.iter().any(|atom| word.is(*atom)));
        of(&[Atom::Between]) && of(&[Atom::Impact, Atom::Rebound]) && of(&[Atom::Time, Atom::Interval])
    };
    let counted = text.lines().any(between);
    let found: Vec<(usize, &str, bool)> = text.lines().filter_map(|line| span(line, counted)).collect();
    let first = text.lines().position(|line| span(line, counted).is_some())?;
    let follows = found.windows(2).all(|pair| pair[1].0 == pair[0].0 + 1);
    // What stands above says that they are times, and in which unit.
    let above = || text.lines().take(first);
    let of_times = |line: &str| {
        let heading = Heading::parse(line.trim_end_matches(':'));
        [Atom::Time, Atom::Interval, Atom::Air].iter().any(|atom| heading.has(*atom))
    };
    let timed = found.iter().all(|(_, _, timed)| *timed);
    let unit = || above().filter(|line| of_times(line)).find_map(clause::of_clauses);
    let stated = match timed {
        true => String::new(),
        false if found.iter().any(|(_, _, timed)| *timed) => return None,
        false => {
            let unit = unit().filter(|unit| unit.dimension == Dimension::Time)?;
            let alike = |name: &&str| Unit::parse(name) == Some(unit);
            format!(" {}", ["s", "ms"].into_iter().find(alike)?)
        }
    };
    let error = |line: &str| clause::error(line).is_some();
    let other = |line: &str| {
        span(line, counted).is_none() && !(super::silent(line) || error(line) || clause::drop(line).is_some())
    };
    if found.len() < 2 || !follows || text.lines().any(other) {
        return None;
    }
    let spelt = |(n, line): (usize, &str)| match span(line, counted) {
        // A lone carriage return ends a row, and no line.
        Some((from, value, _)) if n == first => format!("bounce\ttime between bounces\r{from}\t{value}{stated}"),
        Some((from, value, _)) => format!("{from}\t{value}{stated}"),
        None if line.trim().is_empty() => String::new(),
        None if n < first => line.to_owned(),
        None => format!("#{line}"),
    };
    Some(text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn two_bounces_name_the_time_between_them() {
        let rows = "bounce\ttime between bounces\r1\t704 ms\n2\t580 ms\n";
        for (name, and) in
            [("between ", " and "), ("tra ", " e "), ("zwischen ", " und "), ("", "-"), ("bounce ", " to ")]
        {
            let text = format!("Rubber ball\n{name}1{and}2: 704 ms\n{name}2{and}3: 580 ms\n");
            assert_eq!(table(&text), Some(format!("Rubber ball\n{rows}")), "{text}");
        }
        for text in [
            "between 1 and 2: 64 cm\nbetween 2 and 3: 41 cm\n",
            "between 1 and 2: 704 ms\nbetween 3 and 4: 580 ms\n",
            "between 1 and 3: 704 ms\nbetween 2 and 4: 580 ms\n",
            "1-2: 704\n2-3: 580\n",
            "between 1 and 2: 704 ms\nzorb 2 and 3: 580 ms\n",
        ] {
            assert_eq!(table(text), None, "{text}");
        }
    }
}
