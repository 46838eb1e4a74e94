//! Lists of times that are counted: those of flights, `1. 0.75 s`, below a line that says that they
//! are; those of contacts by a clock, `hit 1   14:05:12,777`.

use super::super::cell::{self, Cell, clock};
use super::super::heading::Heading;
use super::super::named::bounce;
use super::super::units::Dimension;
use super::super::vocabulary::Atom;
use super::super::words::split;
use super::silent;
use super::values::LIST;

/// A time of a list: its place, how it is written, and in s.
struct Time {
    count: usize,
    written: String,
    seconds: f64,
}

/// The text with a row for each line that is the time of a flight, where these fall, below a line
/// that says what they are; `None` if it is none. A line stays a line.
pub(super) fn table(text: &str) -> Option<String> {
    let says = |line: &str| {
        let words = split(line);
        let is = |atoms: &[Atom]| words.iter().any(|word| atoms.iter().any(|atom| word.is(*atom)));
        is(&[Atom::Air, Atom::Between, Atom::Interval]) && !is(&[Atom::Predicted, Atom::Goal, Atom::Derived])
    };
    let above = text.lines().take_while(|line| counted(line).is_none());
    let flights = above.filter(|line| says(line)).count() > 0;
    listed(text, counted, "bounce\tflight time", |before, after| after < before).filter(|_| flights)
}

/// The text with a row for each line that is a contact and the time of a clock, where these rise;
/// `None` if it is none.
pub(super) fn clocked(text: &str) -> Option<String> {
    let bare = !text.contains(['\t', ';', '|']);
    listed(text, contact, "impact\ttime", |before, after| after > before).filter(|_| bare)
}

/// The text with the times of a list, counted from 1, below `names`, and its other lines as
/// remarks, which measure nothing; `follows` tells whether a time may stand behind another one.
fn listed(
    text: &str,
    read: fn(&str) -> Option<Time>,
    names: &str,
    follows: impl Fn(f64, f64) -> bool,
) -> Option<String> {
    let lines: Vec<(&str, Option<Time>)> = text.lines().map(|line| (line, read(line))).collect();
    let times: Vec<&Time> = lines.iter().filter_map(|(_, time)| time.as_ref()).collect();
    let first = lines.iter().position(|(_, time)| time.is_some())?;
    let in_order = times.iter().enumerate().all(|(n, time)| time.count == n + 1);
    let ordered = times.windows(2).all(|pair| follows(pair[0].seconds, pair[1].seconds));
    let others = lines.iter().filter(|(_, time)| time.is_none()).all(|(line, _)| silent(line));
    if times.len() < LIST || !(in_order && ordered && others) {
        return None;
    }
    let spelt = |(n, (line, time)): (usize, &(&str, Option<Time>))| match time {
        // A lone carriage return ends a row, and no line.
        Some(Time { count, written, .. }) if n == first => format!("{names}\r{count}\t{written}"),
        Some(Time { count, written, .. }) => format!("{count}\t{written}"),
        None if line.trim().is_empty() => String::new(),
        None => format!("#{}", line.trim_start_matches('#')),
    };
    Some(lines.iter().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// The time that a line is, behind its place in a list.
fn counted(line: &str) -> Option<Time> {
    let (count, time) = line.trim().split_once(['.', ')'])?;
    let time = time.strip_prefix(' ')?.trim();
    let Cell::Number(measured) = cell::read(time, false) else { return None };
    let unit = measured.unit.filter(|unit| unit.dimension == Dimension::Time)?;
    Some(Time { count: count.parse().ok()?, written: time.to_owned(), seconds: unit.si(measured.value) })
}

/// The contact that a line names by its number, and its time by a clock, written with a point
/// before its milliseconds.
fn contact(line: &str) -> Option<Time> {
    let (name, time) = line.trim().rsplit_once(char::is_whitespace)?;
    let (heading, written) = (Heading::parse(name.trim()), time.replace(',', "."));
    let fits = heading.unknown.is_empty() && heading.has(Atom::Impact) && !heading.has(Atom::After) && !heading.turns();
    let seconds = clock(&written).filter(|_| fits)?;
    Some(Time { count: bounce(name.trim())?, written, seconds })
}

#[cfg(test)]
mod tests {
    use super::{clocked, table};

    #[test]
    fn contacts_by_a_clock_are_rows() {
        let text = "Log of a phone\n\nhit 1   14:05:12,777\nhit 2   14:05:13,483\nhit 3   14:05:14.059\nend 14:05:20\n";
        let rows =
            "#Log of a phone\n\nimpact\ttime\r1\t14:05:12.777\n2\t14:05:13.483\n3\t14:05:14.059\n#end 14:05:20\n";
        assert_eq!(clocked(text).as_deref(), Some(rows));
        for text in [
            "hit 1 14:05:12,777\nhit 2 14:05:11,483\nhit 3 14:05:14,059\n",
            "hit 1 14:05:12,777\nhit 3 14:05:13,483\nhit 4 14:05:14,059\n",
            "page 1 14:05:12,777\npage 2 14:05:13,483\npage 3 14:05:14,059\n",
            "hit 1;14:05:12,777\nhit 2;14:05:13,483\nhit 3;14:05:14,059\n",
        ] {
            assert_eq!(clocked(text), None, "{text}");
        }
    }

    #[test]
    fn counted_times_of_flights_are_rows() {
        let text = "Time in the air between bounces:\n\n1. 0.75 s\n2. 0,63 s\n3. 0.55 s\n";
        let rows = "#Time in the air between bounces:\n\nbounce\tflight time\r1\t0.75 s\n2\t0,63 s\n3\t0.55 s\n";
        assert_eq!(table(text).as_deref(), Some(rows));
        for text in [
            "My drops:\n1. 0.75 s\n2. 0.63 s\n3. 0.55 s\n",
            "Time in the air:\n1. 0.75 s\n2. 0.80 s\n3. 0.55 s\n",
            "Time in the air:\n1. 0.75 s\n3. 0.63 s\n4. 0.55 s\n",
            "Time in the air:\nthe floor is 3 cm thick\n1. 0.75 s\n2. 0.63 s\n3. 0.55 s\n",
        ] {
            assert_eq!(table(text), None, "{text}");
        }
    }
}
