//! What stands around a text of readings and is no part of it: the marks of a mail that is quoted,
//! the letters and numbers at the edges of a spreadsheet, the times before the lines of a chat.

use super::Event;
use super::cell::{self, Cell, Measured};
use super::heading::{Heading, What};
use super::named::event;
use super::phrases::Phrase;
use super::stamps::of_samples;
use super::units::Dimension;
use super::vocabulary::Atom;
use super::words::split;

/// A text without the `>` before the lines that a mail quotes, where most are; of a few such lines
/// each is what somebody typed at a console, and no reading. `None` if there is none.
pub(super) fn quoted(text: &str) -> Option<String> {
    let filled = text.lines().filter(|line| !line.trim().is_empty()).count();
    let quotes = text.lines().filter(|line| line.starts_with('>')).count();
    let bare = |line: &str| match line.strip_prefix('>') {
        Some(rest) => rest.strip_prefix(' ').unwrap_or(rest).to_owned(),
        None => line.to_owned(),
    };
    if quotes > 1 && 2 * quotes > filled {
        return Some(text.lines().map(bare).collect::<Vec<_>>().join("\n") + "\n");
    }
    let typed = |line: &str| {
        let said = line.trim_start_matches('>').trim_start();
        line.starts_with('>') && !said.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '=' | '.' | ','))
    };
    // A remark that was typed is one of the table.
    let remark = |line: &'_ str| -> String { line.trim_start_matches(['>', ' ', '#']).to_owned() };
    let silent = |line: &str| match typed(line) {
        true if line.trim_start_matches(['>', ' ']).starts_with('#') => format!("# {}", remark(line)),
        true => format!("#{line}"),
        false => line.to_owned(),
    };
    text.lines().any(typed).then(|| text.lines().map(silent).collect::<Vec<_>>().join("\n") + "\n")
}

/// A text in which each `"` stands by itself, a mark of repetition, with one in its place that no
/// table takes for the beginning of a cell in quotes; `None` where one is that, or of inches.
pub(super) fn repeated(text: &str) -> Option<String> {
    let edge = |c: Option<char>| c.is_none_or(|c| c.is_whitespace() || matches!(c, ';' | '|' | '-' | '–' | '—'));
    let alone = |(at, _): (usize, &str)| edge(text[..at].chars().next_back()) && edge(text[at + 1..].chars().next());
    (text.contains('"') && text.match_indices('"').all(alone)).then(|| text.replace('"', "〃"))
}

/// A text whose remarks, as programs mark them, `% times`, `// times`, `-- times`, are those of
/// tables; `None` if there are none.
pub(super) fn commented(text: &str) -> Option<String> {
    let cells = |line: &str| line.contains([',', ';', '\t', '|']) || line.trim().contains("  ");
    // `% of drop height` is a name.
    let name = |line: &str| {
        let heading = Heading::parse(line);
        line.starts_with('%') && heading.unknown.is_empty() && !heading.has(Atom::Time)
    };
    let marked = |line: &str| ["% ", "// ", "-- "].iter().any(|mark| line.starts_with(mark));
    // Beside lists that are given a name, `h0 = [30 45 60]`, every one is a remark.
    let lists = text.lines().any(|line| line.contains("= [") || line.contains("=["));
    let remark = |line: &str| marked(line) && (lists || !cells(line) && !name(line));
    let spelt = |line: &str| if remark(line) { format!("#{line}") } else { line.to_owned() };
    text.lines().any(remark).then(|| text.lines().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// A text without the remarks that an arrow points from at the end of lines, `1,80  <- released`;
/// `None` if there are none.
pub(super) fn pointed(text: &str) -> Option<String> {
    let read = |line: &'_ str| -> Option<usize> {
        let (at, mark) = ["<--", "<-", "←", "<="].iter().find_map(|mark| Some((line.find(mark)?, *mark)))?;
        let digit = |c: char| c.is_ascii_digit();
        let remark = &line[at + mark.len()..];
        let names = remark.contains(char::is_alphabetic) && !remark.contains(digit);
        (line[..at].contains(digit) && names).then_some(at)
    };
    let bare = |line: &str| read(line).map_or(line, |at| line[..at].trim_end()).to_owned();
    text.lines().any(|line| read(line).is_some()).then(|| text.lines().map(bare).collect::<Vec<_>>().join("\n") + "\n")
}

/// A text of Markdown, with a table drawn in bars below a rule, whose headings are titles, `##
/// Wood` above the table of it; `None` where there are none.
pub(super) fn headed(text: &str) -> Option<String> {
    let rule = |line: &str| {
        let bare = line.trim();
        bare.starts_with('|') && bare.contains("--") && bare.chars().all(|c| matches!(c, '|' | '-' | ':' | ' '))
    };
    let title = |line: &'_ str| -> Option<usize> {
        let marks = line.len() - line.trim_start_matches('#').len();
        (marks > 0 && line[marks..].starts_with(' ')).then_some(marks + 1)
    };
    let found = text.lines().any(rule) && text.lines().any(|line| title(line).is_some());
    let bare = |line: &str| line[title(line).unwrap_or(0)..].to_owned();
    found.then(|| text.lines().map(bare).collect::<Vec<_>>().join("\n") + "\n")
}

/// A text without the pictures that telephones set beside words; `None` if there are none.
pub(super) fn pictured(text: &str) -> Option<String> {
    let picture = |c: char| matches!(c, '\u{1f000}'..='\u{1faff}' | '\u{fe0f}');
    text.contains(picture).then(|| text.replace(picture, ""))
}

/// A table without the letters above its columns and the numbers before its rows, as they are
/// copied with it from a spreadsheet; `None` where there are none.
pub(super) fn lettered(text: &str) -> Option<String> {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let letters: Vec<&str> = lines.next()?.trim().split('\t').map(str::trim).collect();
    let in_order = letters.iter().zip('A'..='Z').all(|(letter, c)| letter.chars().eq([c]));
    let numbered = |(n, line): (usize, &str)| {
        line.trim_start().split('\t').next().is_some_and(|cell| cell.trim() == n.to_string())
    };
    let framed = letters.len() > 1 && in_order && lines.clone().count() > 1 && (1..).zip(lines).all(numbered);
    let mut first = true;
    let inner = |line: &str| {
        if line.trim().is_empty() || std::mem::take(&mut first) {
            return String::new();
        }
        line.trim_start().split_once('\t').map_or("", |(_, cells)| cells).to_owned()
    };
    framed.then(|| text.lines().map(inner).collect::<Vec<_>>().join("\n") + "\n")
}

/// A text whose times of four parts, `0:00:01:25`, end in hundredths, or in thousandths where they
/// have three digits, written as such: what Kinovea's are, and those of which one is above every
/// count of frames in a second of a time code. `None` where no cell is such a time, or it may end
/// in frames.
pub(super) fn timecoded(text: &str) -> Option<String> {
    let part = |cell: &str| -> Option<(usize, u32)> {
        let cell = cell.trim();
        let (time, last) = cell.rsplit_once(':')?;
        let parts = time.split(':').all(|part| !part.is_empty() && part.chars().all(|c| c.is_ascii_digit()));
        let digits = matches!(last.len(), 2 | 3) && last.chars().all(|c| c.is_ascii_digit());
        let last = if last.len() == 3 { Some(FRAMES) } else { last.parse().ok() };
        (parts && digits && time.matches(':').count() == 2).then(|| Some((time.len(), last?)))?
    };
    let marks = [';', '\t', ',', ' '];
    let first = |line: &'_ str| line.trim_start().split(marks).next().and_then(part);
    let lasts: Vec<u32> = text.lines().filter_map(first).map(|(_, last)| last).collect();
    let program = text.lines().next().is_some_and(|line| line.to_lowercase().contains("kinovea"));
    if lasts.len() < 2 || !program && lasts.iter().all(|last| *last < FRAMES) {
        return None;
    }
    let spelt = |line: &str| match first(line) {
        Some((at, _)) => {
            let bare = line.trim_start();
            format!("{}.{}", &bare[..at], &bare[at + 1..])
        }
        None => line.to_owned(),
    };
    Some(text.lines().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// A time code counts fewer frames in a second than these.
const FRAMES: u32 = 60;

/// A text without the time that a monitor, a logger or a chat writes before its lines, and without
/// who wrote them: `15:21:07.112 -> 64`, `[12.03.24, 14:22] Anna: 64 cm`; of lines that say nothing
/// but that the ball hit the floor the times are the readings. `None` where lines bear no times.
pub(super) fn unstamped(text: &str) -> Option<String> {
    let filled = || text.lines().filter(|line| !line.trim().is_empty());
    if let Some(times) = hits(text).or_else(|| bare_stamps(text)).or_else(|| sent(text)).or_else(|| struck(text)) {
        return Some(times);
    }
    let stamps: Vec<Stamped<'_>> = filled().filter_map(stamped).collect();
    // Before the first of them a device may tell what it is.
    if stamps.len() < 2 || 2 * stamps.len() < filled().count() {
        return None;
    }
    // A message may go on in the next line; between those of a device a line tells something.
    let chat = stamps[0].chat;
    let said = |line: &str| match stamped(line) {
        Some(stamp) if stamp.chat => spoken(stamp.said).to_owned(),
        Some(stamp) => stamp.said.to_owned(),
        None if chat || line.trim().is_empty() => line.to_owned(),
        None => format!("#{line}"),
    };
    Some(text.lines().map(said).collect::<Vec<_>>().join("\n") + "\n")
}

/// The times of lines that say nothing but that the ball hit the floor, below their name; lines
/// above the first of them are remarks. `None` where a line says something else.
fn hits(text: &str) -> Option<String> {
    let first = text.lines().position(|line| timed(line).is_some())?;
    let event = counted_out(text.lines().nth(first).and_then(timed)?.1);
    let hit = |line: &str| {
        let (time, said) = timed(line)?;
        (exact(time) && counted_out(said) == event).then(|| time.to_owned())
    };
    let mut below = text.lines().skip(first).filter(|line| !line.trim().is_empty());
    let heading = format!("time of {event}");
    if below.clone().count() < 2 || !of_contacts(&Heading::parse(&heading)) || !below.all(|line| hit(line).is_some()) {
        return None;
    }
    Some(below_name(text, (first, &heading), hit))
}

/// The times of the lines of a log that begin with a word for a contact, whatever else they say,
/// `HIT peak=-3.3 dB`; its other lines are remarks. `None` where most say something else.
fn struck(text: &str) -> Option<String> {
    let hit = |line: &str| {
        let stamp = stamped(line).filter(|stamp| !stamp.chat && exact(stamp.time))?;
        let word = stamp.said.split([' ', ':', '=', '\t']).next().filter(|word| word.chars().count() > 1)?;
        (event(word) == Some(Event::Contact)).then(|| stamp.time.to_owned())
    };
    let first = text.lines().position(|line| hit(line).is_some())?;
    let hits = text.lines().filter(|line| hit(line).is_some()).count();
    let stamps = text.lines().filter(|line| stamped(line).is_some()).count();
    // A number that rises from line to line is the time by the clock of the device.
    let last = |line: &str| {
        let said = line.trim_end_matches(|c: char| !c.is_ascii_digit());
        let digits =
            said.rfind(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '-'))).map_or(said, |at| &said[at..]);
        digits.trim_start_matches(|c: char| !(c.is_ascii_digit() || c == '-')).parse::<f64>().ok()
    };
    let lasts: Vec<Option<f64>> = text.lines().filter(|line| hit(line).is_some()).map(last).collect();
    let clocked = lasts.windows(2).all(|pair| pair[0].is_some() && pair[0] < pair[1]);
    (hits > 2 && 2 * hits > stamps && !clocked).then(|| below_name(text, (first, "time of impact"), hit))
}

/// Whether a time is written to a part of a second.
fn exact(time: &str) -> bool {
    time.rsplit(':').next().is_some_and(|s| s.contains(['.', ',']))
}

/// A text whose lines from the first one on are rows below a heading, which shares the line of the
/// first; lines that are none are remarks.
fn below_name(text: &str, (first, heading): (usize, &str), row: impl Fn(&str) -> Option<String>) -> String {
    let spelt = |(n, line): (usize, &str)| match row(line).filter(|_| n >= first) {
        Some(row) if n == first => format!("{heading}\r{row}"),
        Some(row) => row,
        None if line.trim().is_empty() => String::new(),
        None => format!("#{line}"),
    };
    text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n"
}

/// What a device sends, numbers of the same names a line, `14:03:22.159 -> Distance: 26 cm`, as a
/// table of those and the time; `None` where a line says something else, but for words in place of
/// a reading, of which fewer are lost than not: `Out of range`.
///
/// The time of a bounce by the clock of the device, `Bounce 1: 8829 ms  level=1000`, is better than
/// that at which the line came.
fn sent(text: &str) -> Option<String> {
    let sampled = of_samples(text.lines().filter_map(stamped).map(|stamp| stamp.time));
    let reading = |line: &'_ str| -> Option<(String, String)> {
        let stamp = stamped(line).filter(|stamp| !stamp.chat && exact(stamp.time))?;
        let parts = stamp.said.split("  ").flat_map(|part| part.split([',', ';', '\t', '|'])).map(str::trim);
        let part = |part: &str| {
            // A length by itself, again and again, is how far the ball is.
            let bare = || Some(("height", part)).filter(|_| sampled);
            let (name, number) = part.split_once([':', '=']).or_else(bare)?;
            let Cell::Number(sent) = cell::read(number, false) else { return None };
            let unit = number.trim().trim_start_matches(|c: char| !c.is_alphabetic());
            let count = name.trim().trim_end_matches(|c: char| c.is_ascii_digit());
            Some((count.trim().to_owned(), unit.to_owned(), sent))
        };
        let parts: Option<Vec<_>> = parts.filter(|part| !part.is_empty()).map(part).collect();
        let parts = parts.filter(|parts| parts.first().is_some_and(|(_, _, sent)| sent.unit.is_some()))?;
        let heading = Heading::parse(&format!("{} ({})", parts[0].0, parts[0].1));
        let clock = heading.has(Atom::Impact) || heading.has(Atom::Rebound);
        // How hard the ball hit is no reading.
        if clock && parts[0].2.unit.is_some_and(|unit| unit.dimension == Dimension::Other) {
            return None;
        }
        let clock = clock && parts[0].2.unit.is_some_and(|unit| unit.dimension == Dimension::Time);
        let cell = |(name, unit, sent): &(String, String, Measured)| match unit.as_str() {
            "" => (name.clone(), sent.value.to_string()),
            unit if clock && *name == parts[0].0 => (format!("time of {name} ({unit})"), sent.value.to_string()),
            unit => (format!("{name} ({unit})"), sent.value.to_string()),
        };
        let stamp = (!clock).then(|| ("time".to_owned(), stamp.time.to_owned()));
        let (names, cells): (Vec<String>, Vec<String>) = stamp.into_iter().chain(parts.iter().map(cell)).unzip();
        Some((names.join(","), cells.join(",")))
    };
    // Before the first of them a device may tell what it is.
    let first = text.lines().position(|line| reading(line).is_some())?;
    let (heading, _) = text.lines().nth(first).and_then(reading)?;
    let wordy = |line: &str| stamped(line).is_some_and(|stamp| !stamp.said.contains(|c: char| c.is_ascii_digit()));
    let (mut read, mut lost) = (0, 0);
    for line in text.lines().skip(first).filter(|line| !line.trim().is_empty()) {
        match reading(line) {
            Some((name, _)) if name == heading => read += 1,
            None if wordy(line) => lost += 1,
            _ => return None,
        }
    }
    if read < 3 || read < lost {
        return None;
    }
    let row = |line: &str| match reading(line) {
        Some((_, row)) => Some(row),
        // A reading that was lost keeps its time.
        None => stamped(line).map(|stamp| stamp.time.to_owned() + &",NaN".repeat(heading.matches(',').count())),
    };
    Some(below_name(text, (first, &heading), row))
}

/// Days and times by themselves, to a part of a second, below a line that names impacts: `# hits`.
fn bare_stamps(text: &str) -> Option<String> {
    let bare = |line: &str| {
        let exact = line.rsplit(':').next().is_some_and(|s| s.contains('.'));
        let parted = line.trim().find([' ', 'T']).is_some_and(|at| cell::date(&line.trim()[..at]));
        // What a mark of a table parts from a time is a cell.
        let alone = |c: char| c.is_ascii_digit() || matches!(c, '-' | '/' | '.' | ':' | ' ' | 'T' | 'Z');
        parted && exact && line.trim().chars().all(alone) && cell::clock(line).is_some()
    };
    let first = text.lines().position(bare)?;
    let names = |line: &str| split(line).iter().any(|word| word.is(Atom::Impact) && !word.is(Atom::Other));
    let mut below = text.lines().skip(first).filter(|line| !line.trim().is_empty());
    let several = below.clone().nth(2).is_some();
    if !several || !below.all(bare) || !text.lines().take(first).any(names) {
        return None;
    }
    let spelt = |(n, line): (usize, &str)| match bare(line) {
        true if n == first => format!("time of impact\r{line}"),
        true => line.to_owned(),
        false if line.trim().is_empty() => String::new(),
        false => format!("#{}", line.trim_start_matches('#')),
    };
    Some(text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// The time that a line begins with, and what it says.
fn timed(line: &str) -> Option<(&str, &str)> {
    stamped(line).map(|stamp| (stamp.time, stamp.said)).or_else(|| clocked(line))
}

/// A time of day, or of a stopwatch, and the words that blanks or a mark part from it.
fn clocked(line: &str) -> Option<(&str, &str)> {
    let bare = line.trim();
    let end = bare.find(|c: char| !(c.is_ascii_digit() || matches!(c, ':' | '.' | ',')))?;
    let end = bare[..end].trim_end_matches([',', '.', ':']).len();
    cell::clock(&bare[..end])?;
    let said = bare[end..].trim_start_matches([' ', '\t', ';', ',', '-', ':']);
    (said.len() < bare[end..].len() && said.starts_with(char::is_alphabetic)).then(|| (&bare[..end], said))
}

/// A line with the time before it.
struct Stamped<'a> {
    time: &'a str,
    said: &'a str,
    /// A message of somebody.
    chat: bool,
}

fn stamped(line: &str) -> Option<Stamped<'_>> {
    let bare = line.trim_start().trim_start_matches('[');
    let date = bare.find([' ', 'T']).filter(|at| cell::date(bare[..*at].trim_end_matches(',')));
    let from = date.map_or(0, |at| at + 1);
    let digits = |c: char| c.is_ascii_digit() || matches!(c, ':' | '.' | ',');
    let run = bare[from..].find(|c: char| !digits(c)).unwrap_or(bare.len() - from);
    let end = from + bare[from..from + run].trim_end_matches(['.', ',']).len();
    cell::clock(&bare[from..end])?;
    let (time, rest) = bare.split_at(end);
    let half = rest.trim_start().split([' ', ']']).next().filter(|word| Phrase::Half.is(&word.to_lowercase()));
    let rest = half.map_or(rest, |word| &rest.trim_start()[word.len()..]).trim_start_matches('Z');
    // What a mark of a table parts from a time is a cell.
    let tells = |said: &str| said.starts_with(char::is_alphabetic) && !said.contains([',', ';', '\t']);
    let said = rest.trim_start();
    let (said, chat) = match said {
        _ if said.starts_with("->") => (&said[2..], false),
        _ if said.starts_with([']', '-', '–']) && date.is_some() => (said.trim_start_matches([']', '-', '–']), true),
        _ if date.is_some() && rest.starts_with(' ') && tells(said) => (said, false),
        _ => return None,
    };
    Some(Stamped { time, said: said.trim(), chat })
}

/// Whether a heading is of the times of contacts, every word of it being understood.
fn of_contacts(heading: &Heading) -> bool {
    heading.understood() && heading.has(Atom::Impact) && heading.value().is_some_and(|value| value.what == What::Time)
}

/// What a message says, without the name of who wrote it.
fn spoken(said: &str) -> &str {
    let name = |who: &str| !who.contains(|c: char| c.is_ascii_digit()) && !who.contains(['(', '=']);
    said.split_once(": ").filter(|(who, _)| name(who)).map_or(said, |(_, words)| words)
}

/// A text without its numbers.
fn counted_out(text: &str) -> String {
    let words = text.split_whitespace().filter(|word| word.trim_matches(['#', ':', '.']).parse::<f64>().is_err());
    words.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fourth_part_of_a_time_is_hundredths_or_asked() {
        let text = "0:00:00:08;1\n0:00:00:99;2\n";
        assert_eq!(timecoded(text).as_deref(), Some("0:00:00.08;1\n0:00:00.99;2\n"));
        assert_eq!(timecoded("0:00:00:008;1\n0:00:01:010;2\n").as_deref(), Some("0:00:00.008;1\n0:00:01.010;2\n"));
        let text = "#Kinovea\n0:00:00:08;1\n0:00:01:10;2\n";
        assert_eq!(timecoded(text).as_deref(), Some("#Kinovea\n0:00:00.08;1\n0:00:01.10;2\n"));
        for text in ["0:00:00:08;1\n0:00:01:24;2\n", "0:00:99;1\n0:01:98;2\n", "0:00:00:99\n", "a:b:c:99\nd:e:f:98\n"] {
            assert_eq!(timecoded(text), None, "{text}");
        }
    }

    #[test]
    fn marks_around_a_table_are_taken_off() {
        assert_eq!(quoted("He wrote:\n> a b\n>  1 2\n>\n").as_deref(), Some("He wrote:\na b\n 1 2\n\n"));
        assert_eq!(quoted("> 60\na,b\n1,2\n"), None);
        assert_eq!(quoted("> df\n  a  b\n1  2\n>\n").as_deref(), Some("#> df\n  a  b\n1  2\n#>\n"));
        assert_eq!(commented("% times\n// by ear\nt = [1 2]\n").as_deref(), Some("#% times\n#// by ear\nt = [1 2]\n"));
        for text in ["% of drop,ball\n64,golf\n", "% of previous height\n64\n64\n", "% of drop height\n64\n"] {
            assert_eq!(commented(text), None, "{text}");
        }
        assert_eq!(lettered("\tA\tB\n1\tdrop\trise\n2\t60\t30\n").as_deref(), Some("\ndrop\trise\n60\t30\n"));
        for text in ["A\tB\n60\t30\n80\t41\n", "\tA\tC\n1\tx\ty\n2\t60\t30\n", "\tA\tB\n1\tx\ty\n3\t60\t30\n"] {
            assert_eq!(lettered(text), None, "{text}");
        }
    }

    #[test]
    fn quotes_around_cells_and_inches_repeat_nothing() {
        assert_eq!(repeated("a  b\n1  2\n\"  3\n").as_deref(), Some("a  b\n1  2\n〃  3\n"));
        for text in ["a,b\n\"1,5\",\"2\"\n", "drop,rebound\n40\",21\"\n", "a;b\n1;2\n", "a,b\n\"x\ny\",2\n"] {
            assert_eq!(repeated(text), None, "{text}");
        }
    }
}
