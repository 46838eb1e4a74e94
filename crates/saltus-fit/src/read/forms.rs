//! Forms of tables that are no cells side by side: lines of a name and a number, tables of LaTeX
//! and of `MediaWiki`, lines that differ in their numbers only. Each becomes cells parted by tabs,
//! and a line stays a line.

mod aloft;
mod blocks;
mod counted;
mod drops;
mod laps;
mod latex;
mod noted;
mod numbered;
mod parts;
mod points;
mod printed;
mod sentences;
mod spans;
mod touching;
mod values;
mod wiki;

use std::borrow::Cow;
use std::collections::HashMap;

pub(super) use blocks::bulleted;
use parts::{Part, arrows, parts};
pub(super) use printed::{dumped, indexed};
pub(super) use values::named_list;
use values::{LIST, listed_numbers, listed_values, of_one_unit, risen, titled};

use super::cell::{self, Cell, length};
use super::clause;
use super::heading::Heading;
use super::phrases::Phrase;
use super::sequence::LEVEL;
use super::units::{Dimension, Unit};
use super::vocabulary::{Atom, folded};
use super::words::{ordinal, split};

/// The text with tabs between the cells of such a table; `None` if it holds none.
pub(super) fn table(text: &str) -> Option<String> {
    // A page of the web is read as such.
    if text.trim_start().starts_with('<') {
        return None;
    }
    let text = &*of_one_unit(text).map_or(Cow::Borrowed(text), Cow::Owned);
    let forms = [
        latex::table,
        numbered::table,
        numbered::clocked,
        laps::table,
        wiki::table,
        wiki::marked,
        blocks::led,
        blocks::table,
        blocks::records,
        printed::scripted,
        noted::noted,
        spans::table,
        aloft::table,
        touching::table,
        points::table,
        titled,
        listed,
        headed,
        drops::table,
        patterned,
        sentences::table,
        counted::table,
    ];
    forms.iter().find_map(|form| form(text))
}

/// Lines that all are a name and what was read, `Height after bounce 1: 64 cm`, `h1 = 64 cm`, with
/// tabs between them; words may be read of some, `Ball: golf`, and lines between may tell
/// something. `None` if any is something else.
fn listed(text: &str) -> Option<String> {
    // The only line that tells where the ball was dropped from, or the shortest of those that
    // tell the same; the others are remarks.
    let drops: Vec<(&str, f64)> = text.lines().filter_map(|line| Some((line, clause::drop(line)?.metres()))).collect();
    let same = drops.windows(2).all(|pair| pair[0].1.total_cmp(&pair[1].1).is_eq());
    let first = drops.iter().map(|(line, _)| *line).min_by_key(|line| line.len()).filter(|_| same);
    let again = |line: &str| told(line) && first != Some(line) && drops.iter().any(|(other, _)| *other == line);
    let drop = first.map(remarked);
    // The unit that it states of all heights.
    let unit = drop.and_then(clause::of_clauses).filter(|unit| unit.dimension == Dimension::Length);
    let marks = [' ', ':', ',', '.', '(', ')'];
    let stated = unit.and(drop).into_iter().flat_map(|line| line.split(marks)).find(|word| unit == Unit::parse(word));
    let stated = stated.map_or(String::new(), |unit| format!(" {unit}"));
    // Lengths by themselves are of bounces below a line that names these, or below the height of
    // release where most fall; there they are of trials where they do not.
    let alone = |line: &str| length(placed(remarked(line).trim()));
    let lengths: Vec<f64> = text.lines().filter_map(alone).collect();
    let fall = lengths.windows(2).filter(|pair| falling(pair)).count();
    let name = if drop.is_some() && 2 * fall < lengths.len() { "trial" } else { "bounce" };
    let (mut counted, mut number, mut title) = (drop.map(|_| name), 0, None);
    let lists = text.lines().filter(|line| listed_numbers(line).is_some()).count();
    let line = |line: &str| {
        if again(line) {
            return Some((false, format!("#{line}")));
        }
        let line = remarked(line);
        if let (Some(name), Some(_)) = (counted, alone(line)) {
            number += 1;
            return Some((true, format!("{name} {number}\t{}", placed(line.trim()))));
        }
        // Numbers in a line by themselves, below the name of all of them.
        if let Some(values) = listed_numbers(line).filter(|_| lists == 1) {
            return Some((true, format!("{}\t{}", title.as_ref()?, values.join("\t"))));
        }
        let named = |(name, _): &(&str, &str)| name.trim_start().starts_with(char::is_alphabetic);
        let dash = || [" - ", " – ", " — "].iter().find_map(|mark| line.split_once(mark)).filter(named);
        title = named_list(line).map(str::to_owned).or(title.take());
        // Words by themselves are a title, and so is a name with a digit in it, `class 8b`.
        // A name of which nothing was read keeps its place in the order.
        let missing = |(name, value): (&str, &str)| {
            let place = Heading::parse(name).understood() && name.contains(|c: char| c.is_ascii_digit());
            (place && !value.trim().is_empty() && cell::read(value, false) == Cell::Empty)
                .then(|| name.trim().to_owned())
        };
        if let Some(name) = line.split_once(": ").and_then(missing) {
            return Some((false, format!("{name}\t-")));
        }
        if parts(line).0.is_empty() && !line.contains([';', '\t', '|', '=']) && !line.contains("<-") {
            let heading = Heading::parse(line.trim_end_matches(':'));
            let names = !line.contains(',') && (heading.has(Atom::Rebound) || heading.has(Atom::Impact));
            counted = if names { Some(name) } else { counted };
            return Some((false, format!("#{line}")));
        }
        // What an arrow leads to was read of what stands before it, unless that is a number too.
        let words = |(name, _): &(&str, &str)| {
            name.contains(char::is_alphabetic) && cell::read(name.trim(), false) == Cell::Words
        };
        let arrow = || arrows().find_map(|arrow| line.split_once(arrow)).filter(words);
        let parted =
            line.split_once("<-").or(line.split_once(": ")).or(line.split_once('=')).or_else(dash).or_else(arrow);
        let dropped = || {
            let height = drop.filter(|of| *of == line).and_then(clause::drop)?.metres();
            Some((true, format!("drop height\t{height} m")))
        };
        // A line that tells where the ball was dropped from names no column.
        let words = |(_, values): &(&str, &str)| cell::read(values.trim(), false) == Cell::Words;
        let parted = parted.filter(|parted| !(words(parted) && dropped().is_some()));
        let found = parted.or_else(|| measured(line).filter(|_| dropped().is_none()));
        let Some((name, values)) = found else {
            let other = || prose(line) || of_others(line) || dated(line) || clause::frame_rate(line).is_some();
            return dropped().or_else(|| other().then(|| (false, format!("#{line}"))));
        };
        let number = |value: &String| matches!(cell::read(value, false), Cell::Number(_));
        let values = listed_values(risen(values.trim()));
        let plain = !name.contains(['\t', ';', ',']) && !name.trim().is_empty();
        // Words are a remark.
        let name = name.trim_end().trim_end_matches(['~', '≈']);
        let read = values.iter().all(number);
        let of_bounces = || {
            let heading = Heading::parse(name);
            let timed = [Atom::Time, Atom::Interval, Atom::Air, Atom::Speed].iter().any(|atom| heading.has(*atom));
            heading.unknown.is_empty() && !timed && (heading.has(Atom::Rebound) || heading.has(Atom::Impact))
        };
        // Several bounces in a line come one after the other where they fall.
        let unit = Heading::parse(name).unit.filter(|unit| unit.dimension == Dimension::Length);
        let bare = |value: &String| value.parse().ok();
        let lengths: Vec<f64> = values.iter().filter_map(|value| length(value).or_else(|| bare(value))).collect();
        if read && lengths.len() == values.len() && lengths.len() > 1 && falling(&lengths) && of_bounces() {
            let unit = unit.and(name.rfind(['(', '[', '_'])).map_or("", |at| &name[at..]);
            let rows = (1..).zip(&values).map(|(n, value)| format!("bounce {n}{unit}\t{value}"));
            return Some((true, rows.collect::<Vec<_>>().join("\r")));
        }
        // What commas part from the name above a list is its title, `golf ball, heights in cm:`.
        if let Some((title, name)) = name.rsplit_once(',').filter(|_| read && values.len() >= LIST) {
            return Some((true, format!("{title}\r{}\t{}", name.trim(), values.join("\t"))));
        }
        let silent = |value: &String| matches!(cell::read(value, false), Cell::Number(m) if m.unit.is_none());
        let bare = values.iter().all(silent) && Heading::parse(name).unit.is_none() && of_bounces();
        let own = if bare { stated.as_str() } else { "" };
        let cells = || values.iter().map(|value| format!("{value}{own}")).collect::<Vec<_>>().join("\t");
        let spelt = if read { format!("{}\t{}", name.trim(), cells()) } else { format!("#{line}") };
        (plain || !read && prose(line)).then_some((read, spelt))
    };
    let lines = || text.lines().filter(|line| !line.trim().is_empty());
    let mut found: Vec<(bool, String)> = lines().map_while(line).collect();
    // Who wrote it stands below the last number, `Léa (class 4)`.
    let signed = |line: &str| silent(line) && line.contains(char::is_alphabetic) && !cells_of_commas(line);
    if !lines().skip(found.len()).all(signed) {
        return None;
    }
    found.extend(lines().skip(found.len()).map(|line| (false, format!("#{line}"))));
    let numbers = found.iter().filter(|(number, _)| *number).count();
    // A line by itself is a list of several.
    let several = found.iter().any(|(number, line)| *number && line.matches(['\t', '\r']).count() >= LIST);
    let told = lines().filter(|line| prose(line) || parts(line).0.is_empty()).count();
    if numbers < 2 && !(numbers == 1 && several) || 2 * numbers < found.len() - told {
        return None;
    }
    // A blank line stays one, so that lines keep their numbers.
    let mut found = found.into_iter().map(|(_, line)| line);
    let spelt = text.lines().map(|line| if line.trim().is_empty() { Some(String::new()) } else { found.next() });
    Some(spelt.collect::<Option<Vec<String>>>()?.join("\n") + "\n")
}

/// A line without the place in an order that it begins with: `1st: 64 cm`.
fn placed(line: &str) -> &str {
    let place = |(name, _): &(&str, &str)| name.parse::<usize>().is_ok() || ordinal(&folded(name)).is_some();
    line.split_once(": ").filter(place).map_or(line, |(_, value)| value.trim())
}

/// Whether a line names a day, `Tuesday 6 Feb 2024`: its numbers are of one, and no word of it is
/// of a bounce.
fn dated(line: &str) -> bool {
    let day =
        |part: &Part<'_>| part.number.parse().is_ok_and(|n: u32| (1..=31).contains(&n) || (1990..2100).contains(&n));
    let (found, rest) = parts(line);
    let words: Vec<&str> = found.iter().map(|part| part.words).chain([rest]).collect();
    let heading = Heading::parse(&words.join(" "));
    let plain = !line.contains(['\t', '|', ';', '=', ':']) && !heading.names_anything();
    plain && (1..3).contains(&found.len()) && found.iter().all(day) && words.iter().any(|w| !w.is_empty())
}

/// Whether all numbers of a line are of something else than lengths and times, and it has some:
/// `Basketball (0.6 bar)`.
fn of_others(line: &str) -> bool {
    let other = |part: &Part<'_>| matches!(cell::read(part.number, false), Cell::Number(m) if m.unit.is_some_and(|u| u.dimension == Dimension::Other));
    let (found, _) = parts(line);
    !found.is_empty() && found.iter().all(other) && !line.contains(['\t', '|', ';', '=', ':'])
}

/// Whether heights fall as those of bounces do, one after the other.
fn falling(heights: &[f64]) -> bool {
    heights.windows(2).all(|pair| pair[1] < LEVEL * pair[0])
}

/// A line without the remark in brackets that it ends in: `64 cm (hard to see)`.
fn remarked(line: &str) -> &str {
    let remark = |inside: &str| inside.contains(' ') && !inside.contains(|c: char| c.is_ascii_digit());
    let parts = line.trim_end().strip_suffix(')').and_then(|line| line.rsplit_once('('));
    parts.filter(|(_, inside)| remark(inside)).map_or(line, |(line, _)| line.trim_end())
}

/// A line of so many words or more, of letters, tells something.
const TOLD: usize = 5;

/// Whether a line tells something.
pub(super) fn told(line: &str) -> bool {
    line.split_whitespace().filter(|word| word.contains(char::is_alphabetic)).count() >= TOLD
}

/// Whether a line tells something, and measures nothing: no number in it has a unit.
fn prose(line: &str) -> bool {
    told(line) && silent(line)
}

/// Whether a line measures nothing: no number in it has a unit, but one that is an error of
/// reading.
fn silent(line: &str) -> bool {
    let error = |part: &Part<'_>| split(part.words).iter().any(|word| word.is(Atom::Error));
    // How large and how heavy a ball is tells nothing of how it bounced.
    let size = |word: &str| Phrase::Diameter.is(word) || Phrase::Radius.is(word);
    let of_ball = |part: &Part<'_>| part.words.split(|c: char| !c.is_alphanumeric()).any(|word| size(&folded(word)));
    let mass = |unit: Option<Unit>| unit.is_some_and(|unit| unit.dimension == Dimension::Other);
    let unit = |part: &Part<'_>| {
        let measured = matches!(cell::read(part.number, false), Cell::Number(m) if m.unit.is_some() && !mass(m.unit));
        measured && !error(part) && !of_ball(part)
    };
    !line.contains(['\t', '|', ';']) && !parts(line).0.iter().any(unit)
}

/// Whether a comma parts a number from what stands before it.
fn cells_of_commas(line: &str) -> bool {
    line.split(',').skip(1).any(|cell| cell.trim_start().starts_with(|c: char| c.is_ascii_digit()))
}

/// Lines of a name and a number, `1st 128`, below one that says of what and in which unit, `Height
/// of bounce (cm)`: with a tab before that, and between the two. `None` if any is something else.
fn headed(text: &str) -> Option<String> {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let heading = lines.next()?;
    // Blanks beside each other, or several numbers in a line, are cells.
    let parted = |line: &str| line.contains(['\t', ';', ',', '|', ':', '=']) || line.contains("  ");
    let counts = |word: &str| word.parse::<f64>().is_ok();
    let (_, unit) = heading.strip_suffix([')', ']'])?.rsplit_once(['(', '['])?;
    let row = |line: &str| {
        let (name, number) = line.rsplit_once(' ')?;
        let bare = matches!(cell::read(number, false), Cell::Number(m) if m.unit.is_none());
        let words = name.contains(char::is_alphabetic) && !name.split(' ').any(counts);
        (bare && words && !parted(line)).then(|| format!("{}\t{number}", name.trim()))
    };
    let rows: Vec<String> = lines.map(row).collect::<Option<_>>()?;
    if rows.len() < 2 || Unit::parse(unit).is_none() || parted(heading) || heading.matches(['(', '[']).count() > 1 {
        return None;
    }
    // A blank line stays one, so that lines keep their numbers.
    let mut spelt = std::iter::once(format!("\t{heading}")).chain(rows);
    let lines = text.lines().map(|line| if line.trim().is_empty() { Some(String::new()) } else { spelt.next() });
    Some(lines.collect::<Option<Vec<_>>>()?.join("\n") + "\n")
}

/// A line of words and, at its end, a number with its unit, `2nd bounce 1.15 m`, parted before the
/// number.
fn measured(line: &str) -> Option<(&str, &str)> {
    let (found, rest) = parts(line);
    let last = found.last().filter(|_| rest.is_empty())?;
    let name = line.trim_end().strip_suffix(last.number)?;
    let unit = matches!(cell::read(last.number, false), Cell::Number(m) if m.unit.is_some());
    // Blanks beside each other part cells.
    let length = |part: &Part<'_>| length(part.number).is_some() && part.words.is_empty();
    let chained = arrows().any(|arrow| name.contains(arrow))
        || found.len() > 1
            && (name.trim_end().contains("  ") || name.ends_with("  ") && found.first().is_some_and(length));
    let words =
        !chained && found.len() < 3 && name.contains(char::is_alphabetic) && !name.contains([',', ';', '|', '\t']);
    (unit && words).then_some((name, last.number))
}

/// Lines that are the same but for their numbers, `dropped from 1 m, came back to 64 cm`: a row
/// each, the words before a number being its name, `h0 = 1 m, h1 = 64 cm`; arrows stand between a
/// height and the next, `100 cm -> 64 cm -> 41 cm`. `None` if most lines are something else.
fn patterned(text: &str) -> Option<String> {
    let lines: Vec<&str> = text.lines().collect();
    // A semicolon, or blanks, part `h1 = 64 cm; h2 = 41 cm`, and cells without such names.
    let blanks = |line: &str| line.trim().contains("  ") && !line.contains(['=', ':']) && !labelled(line);
    let chained = |line: &str| arrows().any(|arrow| line.contains(arrow));
    let cells = |line: &str| {
        line.contains(['\t', '|']) || line.contains(';') && !line.contains('=') || blanks(line) && !chained(line)
    };
    if lines.iter().any(|line| cells(line)) {
        return None;
    }
    let patterns: Vec<Option<Vec<String>>> = lines.iter().map(|line| pattern(line)).collect();
    let mut times: HashMap<&Vec<String>, usize> = HashMap::new();
    patterns.iter().flatten().for_each(|pattern| *times.entry(pattern).or_default() += 1);
    // Of those that most lines have the first.
    let first = patterns.iter().flatten().rev().max_by_key(|pattern| times[pattern])?;
    let alike = |n: usize| patterns[n].as_ref() == Some(first);
    let rows: Vec<usize> = (0..lines.len()).filter(|&n| alike(n)).collect();
    let filled = lines.iter().filter(|line| !parts(line).0.is_empty()).count();
    // Names in a line of their own, as many as there are cells, make a table of it.
    let commas = |line: &str| line.matches(',').count();
    let named = |n: usize| commas(lines[n]) > 0 && commas(lines[n]) == commas(lines[rows[0]]);
    let titled = (0..rows[0]).any(|n| parts(lines[n]).0.is_empty() && named(n));
    let alone = parts(lines[rows[0]])
        .0
        .iter()
        .any(|part| arrows().any(|arrow| arrow == part.words) || part.words.ends_with('='));
    if rows.len() < 2 && !alone || 2 * rows.len() < filled || titled {
        return None;
    }
    let longest = *rows.iter().max_by_key(|&&n| parts(lines[n]).0.len())?;
    let names = names(&parts(lines[longest]).0)?;
    let spelt = |n: usize| {
        let cells = || parts(lines[n]).0.iter().map(|part| part.number).collect::<Vec<_>>().join("\t");
        match n {
            // A lone carriage return ends a row, and no line.
            n if n == rows[0] => format!("{}\r{}", names.join("\t"), cells()),
            n if alike(n) => cells(),
            n => lines[n].to_owned(),
        }
    };
    Some((0..lines.len()).map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// Whether each number of a line has a word of its own before it, `touch 1   frame 118`, or it has
/// but one.
fn labelled(line: &str) -> bool {
    let (found, _) = parts(line);
    found.len() < 2 || found.iter().all(|part| part.words.ends_with(char::is_alphabetic))
}

/// The words of a line around its numbers, without arrows; `None` where no words part them, as
/// none do in cells that commas part.
fn pattern(line: &str) -> Option<Vec<String>> {
    let (found, rest) = parts(line);
    let arrow = |part: &Part<'_>| arrows().any(|arrow| arrow == part.words);
    let named = |part: &Part<'_>| part.words.ends_with(['=', ':']) && part.words.contains(char::is_alphabetic);
    let between = |part: &Part<'_>| arrow(part) || named(part) || part.words.ends_with(char::is_alphabetic);
    let fits = found.len() > 1 && found.iter().skip(1).any(between);
    let names = found.iter().filter(|part| !arrow(part)).map(|part| part.words.to_lowercase());
    fits.then(|| names.chain([rest.to_lowercase()]).collect())
}

/// What the numbers of a line are called; `None` where arrows stand between anything but heights.
fn names(parts: &[Part<'_>]) -> Option<Vec<String>> {
    let arrow = |n: usize| parts.get(n).is_some_and(|part| arrows().any(|arrow| arrow == part.words));
    let mut bounce = 0;
    let name = |(n, part): (usize, &Part<'_>)| {
        if !arrow(n) && !arrow(n + 1) {
            // Before it a sentence may end.
            let said =
                [". ", "! ", "? "].iter().fold(part.words, |words, end| words.rsplit(*end).next().unwrap_or(words));
            return Some(said.trim_matches(|c: char| !c.is_alphanumeric()).to_owned());
        }
        bounce = if arrow(n) { bounce + 1 } else { 0 };
        let height = match cell::read(part.number, false) {
            Cell::Number(m) => m.unit.is_none_or(|unit| unit.dimension == Dimension::Length),
            _ => false,
        };
        // Names that say nothing of a bounce: no line does.
        height.then(|| if bounce == 0 { "height before".to_owned() } else { format!("height {bounce}") })
    };
    parts.iter().enumerate().map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_differ_in_their_numbers_are_rows() {
        for (text, expected) in [
            (
                "100 cm -> 64 cm -> 41 cm\n80 cm -> 51 cm\n",
                "height before\theight 1\theight 2\r100 cm\t64 cm\t41 cm\n80 cm\t51 cm\n",
            ),
            ("in cm\n100→64\n80→51\n", "in cm\nheight before\theight 1\r100\t64\n80\t51\n"),
            ("Filmed it. h0=1m, h1=64cm, h2=41cm.\n", "h0\th1\th2\r1m\t64cm\t41cm\n"),
            ("Clip   1\ntouch 1   frame 118\ntouch 2   frame 268\n", "Clip   1\ntouch\tframe\r1\t118\n2\t268\n"),
            (
                "v 0.3\nready after 5 ms\nhit 1 at 102 ms\nhit 2 at 707 ms\n",
                "v 0.3\nready after 5 ms\nhit\tat\r1\t102 ms\n2\t707 ms\n",
            ),
            ("hit 1  t_ms=102  peak=80\nhit 2  t_ms=707  peak=58\n", "hit\tt_ms\tpeak\r1\t102\t80\n2\t707\t58\n"),
            (
                "Dropped from 1.0 m, came back to 64 cm.\nDropped from 2.0 m, came back to 1.3 m.\n",
                "Dropped from\tcame back to\r1.0 m\t64 cm\n2.0 m\t1.3 m\n",
            ),
        ] {
            assert_eq!(patterned(text).as_deref(), Some(expected), "{text}");
        }
        for text in [
            "Trial,Ball,Drop,Rebound\n1,golf,100,70\n2,golf,80,56\n",
            "bounce,height_cm\n0,100\n1,64\n",
            "0.45 s -> 1.17 s\n0.44 s -> 1.16 s\n",
            "  ball  drop_m  rebound_m\n1 golf     1.0       0.74\n2 golf     1.5       1.11\n",
            "100\n64\n41\n",
            "Drop 1 m\n1st bounce 64 cm\n2nd bounce 41 cm\n",
            "The 2 balls are 5 cm wide.\nWe had 3 m of tape.\n100,64\n80,51\n60,38\n40,26\n",
        ] {
            assert_eq!(patterned(text), None, "{text}");
        }
    }

    #[test]
    fn lines_may_hold_a_name_and_what_was_read() {
        for (text, expected) in [
            ("Drop 1 m\n1st bounce 64 cm\n\nbounce 2 41 cm\n", "Drop\t1 m\n1st bounce\t64 cm\n\nbounce 2\t41 cm\n"),
            ("Golf ball\nDrop 1 m\nrebound 64 cm\n", "#Golf ball\nDrop\t1 m\nrebound\t64 cm\n"),
            ("Bounce times (s): 0.5, 1.2, 1.8\n", "Bounce times (s)\t0.5\t1.2\t1.8\n"),
            ("drop_cm = 100\nrebounds_cm = [64, 41]\n", "drop_cm\t100\nbounce 1_cm\t64\rbounce 2_cm\t41\n"),
            ("dt = diff(t);\nt = np.array([0.5, 1.2, 1.8])\n", "#dt = diff(t);\nt\t0.5\t1.2\t1.8\n"),
            (
                "Hi Ana,\nDrop 1 m\n1st bounce 64 cm\nTom (class 4)\n",
                "#Hi Ana,\nDrop\t1 m\n1st bounce\t64 cm\n#Tom (class 4)\n",
            ),
            ("Film, 240 fps\nImpact frames: 9, 60, 95\n", "#Film, 240 fps\nImpact frames\t9\t60\t95\n"),
        ] {
            assert_eq!(listed(text).as_deref(), Some(expected), "{text}");
        }
        for text in ["Ball 58 g\n", "height_cm\n100\n64\n", "drop,100 cm\nbounce,64 cm\n", "Class: 7, 8\n"] {
            assert_eq!(listed(text), None, "{text}");
        }
    }

    #[test]
    fn names_and_numbers_may_stand_below_what_they_are() {
        let text = "Height of bounce (cm)\n\ndrop 200\n1st 128\nsecond bounce 82\n";
        assert_eq!(
            headed(text).as_deref(),
            Some("\tHeight of bounce (cm)\n\ndrop\t200\n1st\t128\nsecond bounce\t82\n")
        );
        for text in ["Height (cm)\n100\n64\n", "Height\ndrop 200\n1st 128\n", "Height (cm)\ndrop 200\nof a ball\n"] {
            assert_eq!(headed(text), None, "{text}");
        }
    }
}
