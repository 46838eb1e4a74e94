//! Labels of a sound that span the flights between contacts: `begin, end, text` a line, as Audacity
//! writes regions.

use super::super::cell::{self, Cell};
use super::super::limits::MANY;
use crate::statistics::median;

/// So many flights tell that they last ever less.
const FLIGHTS: usize = 3;

/// A contact lasts less than this part of the flight before it.
const CONTACT: f64 = 0.2;

/// What flights keep of the one before, and how far each may be off what they mostly keep.
const KEPT: std::ops::Range<f64> = 0.3..0.98;
const ALIKE: f64 = 0.1;

/// The begin and the end of a label, and what it says.
fn label(line: &str) -> Option<(f64, f64, &str)> {
    let mut cells = line.splitn(3, '\t');
    let mut number = || match cell::read(cells.next()?.trim(), false) {
        Cell::Number(m) if m.unit.is_none() && m.error.is_none() => Some(m.value),
        _ => None,
    };
    let (from, to) = (number()?, number()?);
    Some((from, to, cells.next().unwrap_or_default().trim()))
}

/// The text with the duration of each label in place of its begin and end, in seconds, and what the
/// labels say below; `None` where a line is none, where they do not follow one another closely, or
/// do not last ever less by one factor.
pub(super) fn table(text: &str) -> Option<String> {
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).take(MANY).collect();
    let found: Vec<(f64, f64, &str)> = lines.iter().map(|line| label(line)).collect::<Option<_>>()?;
    let lasts: Vec<f64> = found.iter().map(|(from, to, _)| to - from).collect();
    let close = |pair: &[(f64, f64, &str)]| {
        let (contact, flight) = (pair[1].0 - pair[0].1, pair[0].1 - pair[0].0);
        (0.0..CONTACT * flight).contains(&contact)
    };
    let mut kept: Vec<f64> = lasts.windows(2).map(|pair| pair[1] / pair[0]).collect();
    let usual = median(&mut kept)?;
    let alike = kept.iter().all(|part| (part / usual - 1.0).abs() < ALIKE);
    let follow = found.windows(2).all(close) && lasts.iter().all(|time| *time > 0.0);
    if found.len() < FLIGHTS || !follow || !KEPT.contains(&usual) || !alike {
        return None;
    }
    // To the last digit of the labels; a lone carriage return ends a row, and no line.
    let spelt = |(n, line): (usize, &str)| match label(line) {
        Some((from, to, _)) => {
            let name = if n == 0 { "air time after bounce (s)\r" } else { "" };
            format!("{name}{:.6}", to - from)
        }
        None => String::new(),
    };
    let said: String =
        found.iter().filter(|(_, _, said)| !said.is_empty()).map(|(_, _, said)| format!("#{said}\n")).collect();
    Some(text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n" + &said)
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn labels_of_flights_become_durations() {
        let text = "0.10\t0.60\tup\n0.61\t1.01\tup\n1.02\t1.34\t\n";
        let rows = "air time after bounce (s)\r0.500000\n0.400000\n0.320000\n#up\n#up\n";
        assert_eq!(table(text).as_deref(), Some(rows));
        for text in [
            // Labels of contacts, far apart; of what lasts alike; and of two.
            "0.10\t0.12\ta\n0.61\t0.63\tb\n1.02\t1.04\tc\n",
            "0.10\t0.60\ta\n0.61\t1.11\tb\n1.12\t1.62\tc\n",
            "0.10\t0.60\ta\n0.61\t1.01\tb\n",
            "0.10\t0.60\ta\n0.61\t1.01\tb\n1.02\tx\tc\n",
        ] {
            assert_eq!(table(text), None, "{text}");
        }
    }
}
