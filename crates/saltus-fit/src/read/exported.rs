//! Texts that programs export whose cells stand in no table as they are: rows with names before
//! them, samples beside the settings of an oscilloscope, points in brackets.

use super::cell::{self, Cell};
use super::forms::named_list;
use super::named::event;
use super::units::Unit;

/// So many rows in a text are no chance.
const ROWS: usize = 3;

/// A table in which every row begins with a name that no column is called by, as R writes it: the
/// header is shorter by a cell, which a tab makes up for. `None` where there is none.
pub(super) fn row_names(text: &str) -> Option<String> {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let (head, first) = (lines.next()?, lines.next()?);
    let mark = ['\t', ';', ',', ' '].into_iter().find(|mark| first.contains(*mark))?;
    let names = cells(head, mark)?;
    let quoted = |line: &str| line.starts_with('"');
    // What is quoted is a name, and so is what counts the rows.
    let named = |(n, line): (usize, &str)| {
        let row = cells(line, mark)?;
        let name = row.first()?;
        let named = quoted(head) && quoted(line) || name.parse() == Ok(n + 1);
        (named && row.len() == names.len() + 1).then_some(row)
    };
    let word = |name: &String| matches!(cell::read(name, true), Cell::Words);
    if names.len() < 2 || !names.iter().all(word) {
        return None;
    }
    let rows = std::iter::once(first).chain(lines).enumerate().map(named);
    let rows: Vec<Vec<String>> = rows.collect::<Option<_>>()?;
    let mut spelt = std::iter::once(format!("\t{}", names.join("\t"))).chain(rows.iter().map(|row| row.join("\t")));
    let line = |line: &str| if line.trim().is_empty() { Some(String::new()) } else { spelt.next() };
    let all = text.lines().map(line).collect::<Option<Vec<_>>>()?;
    (rows.len() >= ROWS).then(|| all.join("\n") + "\n")
}

/// The cells of a line that a mark parts, without their quotes; `None` where one is not closed.
fn cells(line: &str, mark: char) -> Option<Vec<String>> {
    let (mut found, mut quoted) = (vec![String::new()], false);
    for c in line.trim().chars() {
        match found.last_mut() {
            _ if c == '"' => quoted = !quoted,
            _ if c == mark && !quoted => found.push(String::new()),
            Some(last) => last.push(if c == '\t' { ' ' } else { c }),
            None => {}
        }
    }
    (!quoted).then_some(found)
}

/// Points that a list holds in brackets, `l1 = {(0.00, 1.2), (0.04, 1.1)}`, a row each; `None`
/// where there are none, or more than one list.
pub(super) fn points(text: &str) -> Option<String> {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let line = lines.next().filter(|_| lines.next().is_none())?.trim();
    let (name, list) = line.split_once(['=', ':']).unwrap_or(("", line));
    let (list, name) = (list.trim(), name.trim());
    let inner =
        [('{', '}'), ('[', ']')].iter().find_map(|(open, close)| list.strip_prefix(*open)?.strip_suffix(*close));
    let point = |part: &str| {
        let (x, y) = part.trim_start_matches([',', ';', ' ']).strip_prefix('(')?.split_once([',', ';'])?;
        let number = |text: &str| text.trim().parse::<f64>().is_ok();
        (number(x) && number(y)).then(|| format!("{}\t{}", x.trim(), y.trim()))
    };
    let points = inner?.trim().strip_suffix(')')?.split(')').map(point).collect::<Option<Vec<_>>>()?;
    let plain = named_list(name).is_none() && !name.contains(['(', '\t']);
    // A lone carriage return ends a row, and no line.
    (points.len() >= ROWS && plain).then(|| points.join("\r") + "\n")
}

/// Samples of an oscilloscope by their times: beside them, in columns of their own, stand its
/// settings, a name and a value a line; or they are counted, and where they begin and how long
/// each lasts stands above them. `None` where there are none.
pub(super) fn samples(text: &str) -> Option<String> {
    beside_settings(text).or_else(|| counted(text))
}

/// Fewer samples show no contacts: at the slowest rate that does, half a second.
const SAMPLES: usize = 100;

/// `Record Length,2500,,-0.250,0.02`: settings in two columns of the first lines, samples in two
/// others of all.
fn beside_settings(text: &str) -> Option<String> {
    let row = |line: &'_ str| -> Option<[String; 4]> {
        let cells: Vec<&str> = line.trim_end().trim_end_matches(',').split(',').map(str::trim).collect();
        let [name, value, _, time, size] = cells.as_slice() else { return None };
        let sample = [time, size].iter().all(|cell| cell.parse::<f64>().is_ok());
        sample.then(|| [*name, *value, *time, *size].map(str::to_owned))
    };
    let first = text.lines().next()?;
    row(first).filter(|[name, ..]| name.contains(char::is_alphabetic))?;
    let rows: Vec<[String; 4]> = text.lines().map(row).collect::<Option<_>>()?;
    let setting = |name: &str| {
        let found = rows.iter().find(|row| row[0].eq_ignore_ascii_case(name)).map(|row| row[1].clone());
        found.filter(|value| !value.is_empty())
    };
    let settings = rows.iter().filter(|row| !row[0].is_empty()).count();
    if rows.len() < SAMPLES || 2 * settings > rows.len() {
        return None;
    }
    let time = setting("horizontal units").filter(|unit| Unit::parse(unit).is_some()).unwrap_or("s".to_owned());
    let unit = setting("vertical units").unwrap_or("V".to_owned());
    let source = setting("source").unwrap_or("CH1".to_owned());
    let mut lines = rows.iter().map(|[_, _, time, size]| format!("{time}\t{size}"));
    let first = format!("time ({time})\t{source} ({unit})\r{}", lines.next()?);
    Some(std::iter::once(first).chain(lines).collect::<Vec<_>>().join("\n") + "\n")
}

/// `X,CH1,Start,Increment` above `Sequence,Volt,0.0,1e-3`, and below it samples by their numbers.
fn counted(text: &str) -> Option<String> {
    let cells = |line: &'_ str| -> Vec<String> { line.split(',').map(|cell| cell.trim().to_owned()).collect() };
    let mut lines = text.lines();
    let (names, units) = (cells(lines.next()?), cells(lines.next()?));
    let setting = |name: &str| {
        let at = names.iter().position(|cell| cell.eq_ignore_ascii_case(name))?;
        units.get(at)?.parse::<f64>().ok()
    };
    let (start, step) = (setting("start")?, setting("increment")?);
    if !units.first()?.eq_ignore_ascii_case("sequence") || step <= 0.0 {
        return None;
    }
    let channels = 1..names.iter().position(|cell| cell.eq_ignore_ascii_case("start"))?;
    let row = |line: &str| {
        let row = cells(line);
        let count: f64 = row.first()?.parse().ok()?;
        let sizes = row.get(channels.clone())?.join("\t");
        Some(format!("{}\t{sizes}", start + step * count))
    };
    let rows: Vec<String> = lines.filter(|line| !line.trim().is_empty()).map(row).collect::<Option<_>>()?;
    let named = |n: usize| match units[n].as_str() {
        unit if unit.eq_ignore_ascii_case("volt") => format!("{} (V)", names[n]),
        unit => format!("{} ({unit})", names[n]),
    };
    let sizes: Vec<String> = channels.clone().map(named).collect();
    (rows.len() >= SAMPLES).then(|| format!("time (s)\t{}\n\n{}\n", sizes.join("\t"), rows.join("\n")))
}

/// The line that a section begins at, its name, and its names with their values.
type Section = (usize, String, Vec<(String, String)>);

/// Sections in brackets with a name and a number a line, `[run1]`, `drop_mm = 150`, `t1 = 812.0`,
/// as a row each below their names; remarks begin with a semicolon. `None` where there are no two,
/// and where a line is none of it.
pub(super) fn sections(text: &str) -> Option<String> {
    let section = |line: &'_ str| line.strip_prefix('[')?.strip_suffix(']').map(|name| name.trim().to_owned());
    let mut rows: Vec<Section> = Vec::new();
    let mut names: Vec<String> = Vec::new();
    for (n, line) in text.lines().map(str::trim).enumerate() {
        if line.is_empty() || line.starts_with([';', '#']) {
            continue;
        }
        if let Some(name) = section(line) {
            rows.push((n, name, Vec::new()));
            continue;
        }
        let (name, value) = line.split_once('=')?;
        let (name, value) = (name.trim().to_owned(), value.split(" ;").next().unwrap_or_default().trim().to_owned());
        if value.contains(['\t', ',']) || name.is_empty() {
            return None;
        }
        if !names.contains(&name) {
            names.push(name.clone());
        }
        rows.last_mut()?.2.push((name, value));
    }
    let first = rows.first()?.0;
    let header = format!("run\t{}\r", names.join("\t"));
    let row = |(n, name, cells): &Section| {
        let cell = |name: &String| cells.iter().find(|(own, _)| own == name).map_or("", |(_, value)| value.as_str());
        let cells = names.iter().map(cell).collect::<Vec<_>>().join("\t");
        format!("{}{name}\t{cells}", if *n == first { header.as_str() } else { "" })
    };
    let spelt = |(n, line): (usize, &str)| match rows.iter().find(|(at, ..)| *at == n) {
        Some(found) => row(found),
        None if line.trim_start().starts_with([';', '#']) => format!("#{}", line.trim_start_matches([' ', ';', '#'])),
        None => String::new(),
    };
    let several = rows.iter().filter(|(.., cells)| cells.len() > 1).count() > 1;
    several.then(|| text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// Contacts by the numbers of their frames, a letter before each: `contact 1   f1058`. `None` where
/// fewer lines are of these than of anything that measures.
pub(super) fn frames(text: &str) -> Option<String> {
    let row = |line: &'_ str| -> Option<(String, String)> {
        let (name, frame) = line.trim().rsplit_once(char::is_whitespace)?;
        let count = frame.strip_prefix(['f', 'F', '#'])?;
        let digits = !count.is_empty() && count.chars().all(|c| c.is_ascii_digit());
        let name = name.trim().trim_end_matches([':', '-', '=']).trim_end();
        (digits && event(name).is_some()).then(|| (name.to_owned(), count.to_owned()))
    };
    let first = text.lines().position(|line| row(line).is_some())?;
    if text.lines().filter(|line| row(line).is_some()).count() < ROWS || text.contains(['\t', '|']) {
        return None;
    }
    let spelt = |(n, line): (usize, &str)| match row(line) {
        Some((name, frame)) if n == first => format!("event\tframe\r{name}\t{frame}"),
        Some((name, frame)) => format!("{name}\t{frame}"),
        None if line.trim().is_empty() => String::new(),
        None => format!("#{line}"),
    };
    Some(text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_may_begin_with_a_name() {
        let text = "\"ball\" \"h 0\"\n\"1\" \"golf\" 1.5\n\"2\" \"golf\" 1.2\n\"b\" \"old one\" 1.1\n";
        assert_eq!(row_names(text).as_deref(), Some("\tball\th 0\n1\tgolf\t1.5\n2\tgolf\t1.2\nb\told one\t1.1\n"));
        let text = "ball\th\n1\tgolf\t1.5\n2\tgolf\t1.2\n3\tgolf\t1.1\n";
        assert_eq!(row_names(text).as_deref(), Some("\tball\th\n1\tgolf\t1.5\n2\tgolf\t1.2\n3\tgolf\t1.1\n"));
        for text in [
            "ball,h\ngolf,1.5\ngolf,1.2\ngolf,1.1\n",
            "ball,h\n7,golf,1.5\n9,golf,1.2\n8,golf,1.1\n",
            "\"ball\" \"h\"\n\"1\" \"golf\" 1.5\n\"2\" 1.2\n\"3\" \"golf\" 1.1\n",
            "1 2\n1 2 3\n2 2 3\n3 2 3\n",
            "the ball\n1 2 3\n",
        ] {
            assert_eq!(row_names(text), None, "{text}");
        }
    }

    #[test]
    fn sections_are_rows() {
        let text = "; golf\n[run1]\ndrop_mm = 150\nt1 = 8.0\n\n[run 2]\ndrop_mm=150\nt1 = 9.0 ; ok\nt2 = 9.5\n";
        let expected = "#golf\nrun\tdrop_mm\tt1\tt2\rrun1\t150\t8.0\t\n\n\n\nrun 2\t150\t9.0\t9.5\n\n\n\n";
        assert_eq!(sections(text).as_deref(), Some(expected));
        for text in ["[a]\nx = 1\ny = 2\n", "x = 1\n[a]\ny = 2\n", "[a]\nx = 1\nhello\n[b]\nx = 2\n", "h,e\n1,2\n"] {
            assert_eq!(sections(text), None, "{text}");
        }
    }

    #[test]
    fn a_letter_may_stand_before_the_number_of_a_frame() {
        let text = "shot 3 @ 60fps\n\n release   f10\n contact 1  f44\n contact 2: f101\nthen it rolls\n";
        let expected = "#shot 3 @ 60fps\n\nevent\tframe\rrelease\t10\ncontact 1\t44\ncontact 2\t101\n#then it rolls\n";
        assert_eq!(frames(text).as_deref(), Some(expected));
        for text in [
            "contact 1 f44\ncontact 2 f50\n",
            "page f1\npage f2\npage f3\n",
            "contact 1 44\ncontact 2 50\ncontact 3 5\n",
        ] {
            assert_eq!(frames(text), None, "{text}");
        }
    }

    #[test]
    fn points_of_a_list_are_rows() {
        for text in [
            "l1 = {(0.0, 1.2), (0.1, 1.1), (0.2, 0.9)}\n",
            "[(0.0,1.2),(0.1,1.1),(0.2,0.9)]",
            "pts: [(0.0; 1.2) (0.1; 1.1) (0.2; 0.9)]",
        ] {
            assert_eq!(points(text).as_deref(), Some("0.0\t1.2\r0.1\t1.1\r0.2\t0.9\n"), "{text}");
        }
        for text in [
            "l = {1, 2, 3}",
            "f(x) = (x, 2)",
            "l = {(a, 1), (b, 2), (c, 3)}",
            "l = {(0, 1), (1, 2), (2, 3)}\nm = {(0, 1)}",
        ] {
            assert_eq!(points(text), None, "{text}");
        }
    }

    #[test]
    fn samples_of_an_oscilloscope_have_times() {
        let line = |n: usize| match n {
            0 => "Record Length,200,,0.000,0.1,\n".to_owned(),
            1 => "Vertical Units,V,,0.001,0.1,\n".to_owned(),
            n => format!(",,,0.{n:03},0.{n},\n"),
        };
        let text: String = (0..200).map(line).collect();
        let found = samples(&text).unwrap();
        assert!(found.starts_with("time (s)\tCH1 (V)\r0.000\t0.1\n0.001\t0.1\n0.002\t0.2\n"), "{found}");
        let rows: String = (0..200).map(|n| format!("{n},0.{n},,\n")).collect();
        let found = samples(&format!("X,CH1,Start,Increment,\nSequence,Volt,-0.5,0.25\n{rows}")).unwrap();
        assert!(found.starts_with("time (s)\tCH1 (V)\n\n-0.5\t0.0\n-0.25\t0.1\n0\t0.2\n"), "{found}");
        assert_eq!(samples("a,b,,1,2\nc,d,,1,2\n"), None);
    }
}
