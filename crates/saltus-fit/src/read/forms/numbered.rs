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

/// The text with a row for each of such lines, whose times fall, and its other lines as remarks,
/// which measure nothing; `None` if it is none. A line stays a line.
pub(super) fn table(text: &str) -> Option<String> {
    let lines: Vec<(&str, Option<(usize, &str, f64)>)> = text.lines().map(|line| (line, counted(line))).collect();
    let times: Vec<(usize, &str, f64)> = lines.iter().filter_map(|(_, time)| *time).collect();
    let first = lines.iter().position(|(_, time)| time.is_some())?;
    let in_order = times.iter().enumerate().all(|(n, (count, _, _))| *count == n + 1);
    let falls = times.windows(2).all(|pair| pair[1].2 < pair[0].2);
    let says = |line: &str| {
        let words = split(line);
        let is = |atoms: &[Atom]| words.iter().any(|word| atoms.iter().any(|atom| word.is(*atom)));
        is(&[Atom::Air, Atom::Between, Atom::Interval]) && !is(&[Atom::Predicted, Atom::Goal, Atom::Derived])
    };
    let flights = lines[..first].iter().any(|(line, _)| says(line));
    let others = lines.iter().filter(|(_, time)| time.is_none()).all(|(line, _)| silent(line));
    if times.len() < LIST || !(in_order && falls && flights && others) {
        return None;
    }
    let spelt = |(n, (line, time)): (usize, &(&str, Option<(usize, &str, f64)>))| match time {
        // A lone carriage return ends a row, and no line.
        Some((count, time, _)) if n == first => format!("bounce\tflight time\r{count}\t{time}"),
        Some((count, time, _)) => format!("{count}\t{time}"),
        None if line.trim().is_empty() => String::new(),
        None => format!("#{}", line.trim_start_matches('#')),
    };
    Some(lines.iter().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// The place of a line in its list, and the time that it is, as it is written and in s.
fn counted(line: &str) -> Option<(usize, &str, f64)> {
    let (count, time) = line.trim().split_once(['.', ')'])?;
    let time = time.strip_prefix(' ')?.trim();
    let Cell::Number(measured) = cell::read(time, false) else { return None };
    let unit = measured.unit.filter(|unit| unit.dimension == Dimension::Time)?;
    Some((count.parse().ok()?, time, unit.si(measured.value)))
}

/// The text with a row for each line that is a contact, counted from 1, and the time of a clock,
/// which rises, and its other lines as remarks; `None` if it is none.
pub(super) fn clocked(text: &str) -> Option<String> {
    let lines: Vec<(&str, Option<(usize, String, f64)>)> = text.lines().map(|line| (line, contact(line))).collect();
    let times: Vec<&(usize, String, f64)> = lines.iter().filter_map(|(_, time)| time.as_ref()).collect();
    let first = lines.iter().position(|(_, time)| time.is_some())?;
    let in_order = times.iter().enumerate().all(|(n, (count, ..))| *count == n + 1);
    let rises = times.windows(2).all(|pair| pair[1].2 > pair[0].2);
    let others = lines.iter().filter(|(_, time)| time.is_none()).all(|(line, _)| silent(line));
    if times.len() < LIST || !(in_order && rises && others) || text.contains(['\t', ';', '|']) {
        return None;
    }
    let spelt = |(n, (line, time)): (usize, &(&str, Option<(usize, String, f64)>))| match time {
        // A lone carriage return ends a row, and no line.
        Some((count, time, _)) if n == first => format!("impact\ttime\r{count}\t{time}"),
        Some((count, time, _)) => format!("{count}\t{time}"),
        None if line.trim().is_empty() => String::new(),
        None => format!("#{}", line.trim_start_matches('#')),
    };
    Some(lines.iter().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// The number of the contact that a line names, and its time by a clock, spelt with a point before
/// its milliseconds, and in s.
fn contact(line: &str) -> Option<(usize, String, f64)> {
    let (name, time) = line.trim().rsplit_once(char::is_whitespace)?;
    let (heading, time) = (Heading::parse(name.trim()), time.replace(',', "."));
    let fits = heading.unknown.is_empty() && heading.has(Atom::Impact) && !heading.has(Atom::After) && !heading.turns();
    let seconds = clock(&time).filter(|_| fits)?;
    Some((bounce(name.trim())?, time, seconds))
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
