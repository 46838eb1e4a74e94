//! Logs of when contacts begin and when they end, a line each: `[ 3.853] contact 1 START`.

use super::super::cell::{self, Cell};
use super::super::clause;
use super::super::phrases::Phrase;
use super::super::units::{Dimension, Unit};
use super::super::vocabulary::folded;

/// So many contacts tell flights between them that shrink.
const CONTACTS: usize = 3;

/// The time of a line, its unit where it bears one, and whether a contact begins or ends there.
fn entry(line: &str) -> Option<(f64, Option<Unit>, bool)> {
    let line = line.trim_start().trim_start_matches('[').trim_start();
    let digits = line.find(|c: char| !(c.is_ascii_digit() || c == '.'))?;
    let (number, rest) = line.split_at(digits);
    let Cell::Number(time) = cell::read(number, false) else { return None };
    let rest = folded(rest);
    let words: Vec<&str> = rest.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let unit = words.first().and_then(|word| Unit::parse(word)).filter(|unit| unit.dimension == Dimension::Time);
    let says = |phrase: Phrase| words.iter().any(|word| phrase.is(word));
    let (begins, ends) = (says(Phrase::Begins), says(Phrase::Ends));
    (begins != ends).then_some((time.value, unit, begins))
}

/// The text with a row for each contact, its begin and its end, and the other lines as remarks,
/// but for what was typed at a console and what it answers in a word. `None` where begins and ends
/// do not take turns, and where nothing states the unit of the times.
pub(super) fn table(text: &str) -> Option<String> {
    let found: Vec<(f64, Option<Unit>, bool)> = text.lines().filter_map(entry).collect();
    let turns = found.iter().enumerate().all(|(n, (_, _, begins))| *begins == (n % 2 == 0));
    let rises = found.windows(2).all(|pair| pair[0].0 < pair[1].0);
    if found.len() < 2 * CONTACTS || !found.len().is_multiple_of(2) || !turns || !rises {
        return None;
    }
    let of_lines = || text.lines().filter(|line| entry(line).is_none()).flat_map(clause::clauses);
    let stated = || of_lines().filter_map(clause::of_clauses).find(|unit| unit.dimension == Dimension::Time);
    let unit = found[0].1.or_else(stated)?;
    let unit = ["s", "ms"].into_iter().find(|name| Unit::parse(name) == Some(unit))?;
    let (mut at, mut begun) = (0, 0.0);
    let mut spelt = Vec::new();
    for line in text.lines() {
        let typed = line.starts_with("$ ") || line.split_whitespace().nth(1).is_none();
        spelt.push(match entry(line) {
            Some((time, _, true)) => {
                begun = time;
                String::new()
            }
            Some((time, _, false)) => {
                at += 1;
                // A lone carriage return ends a row, and no line.
                let names = format!("contact begins ({unit})\tcontact ends ({unit})\r");
                format!("{}{begun}\t{time}", if at == 1 { &names } else { "" })
            }
            None if typed => String::new(),
            None => format!("#{line}"),
        });
    }
    Some(spelt.join("\n") + "\n")
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn begins_and_ends_take_turns() {
        let lines = "1.1 ms start\n2.1 ms stop\n9 ms start\n9.8 ms stop\n15 ms start\n15.7 ms stop\n";
        let rows = "\ncontact begins (ms)\tcontact ends (ms)\r1.1\t2.1\n\n9\t9.8\n\n15\t15.7\n";
        assert_eq!(table(lines).as_deref(), Some(rows));
        for text in [
            &lines.replace(" ms", ""),
            &lines.replace("9.8 ms stop", "9.8 ms start"),
            &lines.replace("9 ms", "1 ms"),
            "1 ms start\n2 ms stop\n",
        ] {
            assert_eq!(table(text), None, "{text}");
        }
    }
}
