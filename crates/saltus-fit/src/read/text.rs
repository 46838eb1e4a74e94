//! From bytes to text: UTF-8, UTF-16, Latin-1, and every way to end a line.

use std::borrow::Cow;
use std::ops::Range;

use super::cell::{self, Cell};
use super::digits;
use super::encoding::decoded;
use super::exported;
use super::forms::{self, named_list};
use super::heading::{Heading, Meaning};
use super::limits::MANY;
use super::programs::regressi;
use super::units::Unit;
use super::wrapped;
use crate::error::TableError;

/// So many lines of numbers,
const SAMPLES: usize = 100;
/// and so many to each other line, are written by a program.
const OTHERS: usize = 10;

/// The text of a file and, where it is not UTF-8, the name of its encoding.
pub(super) struct Text<'a> {
    pub(super) text: Cow<'a, str>,
    pub(super) encoding: Option<&'static str>,
}

/// The bytes as text, or the reason why they are none.
pub(super) fn text<'a>(name: &str, bytes: &'a [u8]) -> Result<Text<'a>, TableError> {
    let (text, encoding) = decoded(bytes);
    let control = |c: char| c.is_ascii_control() && !matches!(c, '\t' | '\n' | '\r' | '\x0C' | '\x1A');
    if text.contains(control) {
        return Err(TableError::new(name, "this is not a text file: it contains control characters")
            .help("give a table as text or as a workbook (.xlsx, .xls), or save it as CSV and try again"));
    }
    // Old Macintosh files end their lines with a lone carriage return.
    let old = text.contains('\r') && !text.contains('\n');
    let text = if old { Cow::Owned(text.replace('\r', "\n")) } else { text };
    let text = digits::plain(&text).map_or(text, Cow::Owned);
    let text = counted(&text).map_or(text, Cow::Owned);
    let text = paged(&text).map_or(text, Cow::Owned);
    let text = wrapped::timecoded(&text).map_or(text, Cow::Owned);
    let text = match names_in_comment(&text) {
        Some(at) => Cow::Owned([&text[..at], text[at..].trim_start_matches(['#', ' '])].concat()),
        None => text,
    };
    let taken = |text: Cow<'a, str>, form: fn(&str) -> Option<String>| form(&text).map_or(text, Cow::Owned);
    let around = [
        regressi::tables,
        exported::row_names,
        exported::points,
        exported::samples,
        exported::sections,
        exported::frames,
        wrapped::headed,
        wrapped::repeated,
        forms::dumped,
        wrapped::pictured,
        wrapped::pointed,
        wrapped::quoted,
        wrapped::commented,
        wrapped::lettered,
        wrapped::unstamped,
        forms::indexed,
    ];
    let text = around.into_iter().fold(text, taken);
    // What is typed by hand has no more lines than these; a longer text is of cells side by side,
    // and so is one of numbers.
    let typed = text.lines().nth(MANY).is_none() && !sampled(&text);
    let text = if typed { [forms::bulleted, forms::table].into_iter().fold(text, taken) } else { text };
    let text = aligned(&text).map_or(text, Cow::Owned);
    Ok(Text { text, encoding })
}

/// A text without the numbers of its pages, `2 / 4` in a line by itself, which is blank instead;
/// `None` where there are none.
fn paged(text: &str) -> Option<String> {
    let page = |line: &str| {
        let (page, of) = line.trim().split_once('/')?;
        let (page, of): (u32, u32) = (page.trim_end().parse().ok()?, of.trim_start().parse().ok()?);
        (page > 0 && page <= of).then_some(())
    };
    let found = text.lines().filter(|line| page(line).is_some()).count();
    // A column of marks, `7/10`, is none.
    let blank = |line: &str| if page(line.trim_end()).is_some() { "\n".to_owned() } else { line.to_owned() };
    (found == 1).then(|| text.split_inclusive('\n').map(blank).collect())
}

/// Whether lines of numbers and nothing else are so many beside all others that a program wrote
/// them.
fn sampled(text: &str) -> bool {
    let mark = |c: char| matches!(c, ',' | ';' | '\t' | ' ');
    let number = |cell: &str| cell.is_empty() || cell.parse::<f64>().is_ok();
    let (numbers, others): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| line.split(mark).all(number));
    numbers.len() >= SAMPLES && numbers.len() >= OTHERS * others.len()
}

/// A text whose cells `#`, which name a count, are no comments; `None` where there are none.
pub(super) fn counted(text: &str) -> Option<String> {
    let found = numeros(text);
    // As long as before: what stands where does not change.
    (!found.is_empty()).then(|| {
        let mut text = text.to_owned();
        found.into_iter().for_each(|at| text.replace_range(at..=at, "n"));
        text
    })
}

/// Where lines begin with a `#` that is of a cell, and no comment: `#,time (s)`, `#1,64`, or `#,cm`
/// below the names.
fn numeros(text: &str) -> Vec<usize> {
    let cell = |at: &usize| {
        let after = text[*at..].strip_prefix('#').map(|after| after.trim_start_matches(' '));
        // `#1` counts a row.
        let bare = after.map(|after| after.trim_start_matches(|c: char| c.is_ascii_digit()));
        bare.is_some_and(|after| after.starts_with([',', ';', '\t']))
    };
    let starts = text.match_indices('\n').map(|(at, _)| at + 1);
    let first = text.find(|c: char| !c.is_whitespace());
    let mut found: Vec<usize> = first.into_iter().chain(starts).filter(cell).collect();
    found.dedup();
    found
}

/// Where the `#` stands of a comment that names the columns of the numbers below it, `# t (s)  y
/// (m)`: as many names as they have, and understood; or what a list of them is of.
fn names_in_comment(text: &str) -> Option<usize> {
    let (mut at, mut comment) = (0, None);
    let first = text.split_inclusive('\n').find(|line| {
        if line.starts_with('#') {
            comment = Some((at, line.trim_start_matches('#')));
        }
        at += line.len();
        !line.starts_with('#') && !line.trim().is_empty()
    })?;
    let (at, comment) = comment?;
    let cells = |line: &'_ str, mark: &str| -> Vec<String> {
        line.split(mark).map(str::trim).filter(|cell| !cell.is_empty()).map(str::to_owned).collect()
    };
    let numbers = |mark: &str| {
        let found = cells(first, mark);
        let comma = mark != ";" && mark != "\t";
        let number = |cell: &String| match cell::read(cell, comma) {
            Cell::Number(m) => m.unit.is_none(),
            _ => cell::clock(cell).is_some(),
        };
        Some(found.len()).filter(|count| *count > 1 && found.iter().all(number))
    };
    if matches!(cell::read(first.trim(), false), Cell::Number(m) if m.unit.is_none()) {
        return named_list(comment.trim()).map(|_| at);
    }
    let (mark, count) = [",", ";", "\t", "  ", " "].iter().find_map(|mark| Some((*mark, numbers(mark)?)))?;
    let names = |mark: &str| {
        let names = cells(comment, mark);
        let headings: Vec<Heading> = names.iter().map(|name| Heading::parse(name)).collect();
        let known = headings.iter().filter(|heading| heading.understood()).count();
        // Others are of something else; where more than a blank parts them, of anything.
        let other = |heading: &Heading| heading.unknown.is_empty() && heading.meaning != Meaning::Empty;
        let said = known == count || known > 1 && (mark != " " || headings.iter().all(other));
        names.len() == count && said
    };
    // Names that blanks part may hold one.
    (names(mark) || mark == " " && names("  ")).then_some(at)
}

/// A text whose columns are made by runs of spaces, with a tab at the end of each run in their
/// place; `None` if it is none.
fn aligned(text: &str) -> Option<String> {
    let lines = || text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#') && !drawn(line));
    let numbers = |line: &str| line.split_whitespace().all(|cell| cell.parse::<f64>().is_ok());
    // A number by itself above rows of several is none of them.
    let alone = |line: &&str| line.split_whitespace().count() == 1;
    let rows = || lines().filter(|line| numbers(line)).skip_while(alone);
    let width = rows().next().map_or(0, |line| line.split_whitespace().count());
    let spaced = |line: &str| line.starts_with(' ') || line.trim().contains("  ") || bracketed(line, width).is_some();
    let of_numbers = width > 1
        && !text.contains('\t')
        && rows().all(|line| line.split_whitespace().count() == width)
        && 2 * rows().count() >= lines().count()
        && lines().any(spaced);
    let width = if of_numbers { width } else { of_cells(text, lines())? };
    // A name may hold single spaces, unless there are as many words as columns; what stands above
    // the names is a title.
    let counted = |line: &str| line.split_whitespace().count() == width;
    let named = |line: &str| counted(line) && !line.contains(|c: char| c.is_ascii_digit() || matches!(c, '(' | '['));
    let titled = |line: &str, next: Option<&str>| {
        let names = |next: &str| named(next) && next.split_whitespace().any(|word| Unit::parse(word).is_none());
        named(line) && next.is_some_and(names)
    };
    let cells = |line: &str, next: Option<&str>| {
        let words = of_numbers && counted(line) && !titled(line, next);
        cells(line, if words { 1 } else { 2 })
    };
    let below = lines().skip(1).map(Some).chain([None]);
    let filled = || lines().zip(below.clone()).map(|(line, next)| cells(line, next));
    let columns = columns(filled().filter(|cells| cells.len() == width));
    let mut found = String::with_capacity(text.len());
    let mut nexts = lines().peekable();
    for line in text.split_inclusive('\n') {
        let (inner, end) = line.split_at(line.trim_end().len());
        if !drawn(line) {
            nexts.next_if(|next| next.trim_end() == inner);
            let (next, own) = (nexts.peek().copied(), cells(inner, nexts.peek().copied()));
            let title = own.len() == 1 && titled(inner, next);
            let (own, at) = if title { (own, vec![0]) } else { in_columns(inner, own, &columns, of_numbers) };
            tabbed(&mut found, inner, &own, &at);
        }
        found.push_str(end);
    }
    Some(found)
}

/// The cells of a line, and the columns that they stand in: where they are fewer than these, by
/// their place.
fn in_columns(
    line: &str,
    own: Vec<Range<usize>>,
    columns: &[Range<usize>],
    of_numbers: bool,
) -> (Vec<Range<usize>>, Vec<usize>) {
    let all = |own: Vec<Range<usize>>, from: usize| (own.clone(), (from..own.len() + from).collect());
    if own.len() >= columns.len() {
        return all(own, 0);
    }
    if let Some(names) = bracketed(line, columns.len()).filter(|_| of_numbers) {
        return all(names, 0);
    }
    // Names that single blanks part, where each stands above the numbers of its column.
    let single = || Some(cells(line, 1)).filter(|own| columns.len() - own.len().min(columns.len()) < 2);
    let by_place = |own: Vec<Range<usize>>| placed(&own, columns).map(|at| (own, at));
    // Names that begin beyond the first column leave it without one.
    let beyond = |names: &[Range<usize>]| {
        names.len() + 1 == columns.len() && names.first().is_some_and(|name| name.start >= columns[0].end)
    };
    let found =
        Some(own.clone()).filter(|own| own.len() > 1).and_then(by_place).or_else(|| single().and_then(by_place));
    found.unwrap_or_else(|| {
        // Behind the number of each row, which bears no name, stand so many words as names.
        let words = Some(cells(line, 1)).filter(|words| own.len() == 1 && beyond(words));
        match words {
            Some(words) => all(words, 1),
            None => all(own.clone(), usize::from(beyond(&own))),
        }
    })
}

/// Writes a line with its cells in their columns: as long as it was, with tabs at the ends of the
/// blanks before them.
fn tabbed(found: &mut String, line: &str, cells: &[Range<usize>], columns: &[usize]) {
    let (mut end, mut column) = (0, 0);
    for (cell, &at) in cells.iter().zip(columns) {
        let tabs = at - column;
        found.push_str(&" ".repeat((cell.start - end).saturating_sub(tabs)));
        found.push_str(&"\t".repeat(tabs));
        found.push_str(&line[cell.clone()]);
        (end, column) = (cell.end, at);
    }
}

/// Where the cells of a line stand that so many blanks part, in bytes.
fn cells(line: &str, blanks: usize) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for (at, c) in line.char_indices().filter(|(_, c)| !c.is_whitespace()) {
        match found.last_mut().filter(|last| at - last.end < blanks) {
            Some(last) => last.end = at + c.len_utf8(),
            None => found.push(at..at + c.len_utf8()),
        }
    }
    found
}

/// Where the names of a line stand that all end in a unit in brackets, one behind the other, `Drop
/// (cm) Rebound (cm)`; `None` unless there are so many.
fn bracketed(line: &str, count: usize) -> Option<Vec<Range<usize>>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for word in cells(line, 1) {
        match found.last_mut().filter(|last| !line[..last.end].ends_with([')', ']'])) {
            Some(last) => last.end = word.end,
            None => found.push(word),
        }
    }
    let closed = found.iter().all(|name| line[name.clone()].ends_with([')', ']']));
    (closed && found.len() == count && count > 1).then_some(found)
}

/// Where the columns of rows that have a cell in each of them begin and end.
fn columns(mut rows: impl Iterator<Item = Vec<Range<usize>>>) -> Vec<Range<usize>> {
    let first = rows.next().unwrap_or_default();
    rows.fold(first, |columns, row| {
        columns.into_iter().zip(row).map(|(a, b)| a.start.min(b.start)..a.end.max(b.end)).collect()
    })
}

/// The columns that cells stand in, each above or below one alone; `None` where one does not.
fn placed(cells: &[Range<usize>], columns: &[Range<usize>]) -> Option<Vec<usize>> {
    let over = |cell: &Range<usize>| {
        let mut found = columns.iter().enumerate().filter(|(_, c)| c.start < cell.end && cell.start < c.end);
        let (at, _) = found.next()?;
        found.next().is_none().then_some(at)
    };
    let found: Vec<usize> = cells.iter().map(over).collect::<Option<_>>()?;
    found.windows(2).all(|pair| pair[0] < pair[1]).then_some(found)
}

/// Whether a line is drawn, `-----  ------`, `=====`, or names types, `<fct> <dbl>`: it holds
/// nothing.
fn drawn(line: &str) -> bool {
    let bare = line.trim();
    let kind = |word: &str| word.len() > 2 && word.starts_with('<') && word.ends_with('>');
    if !bare.is_empty() && bare.split_whitespace().all(kind) {
        return true;
    }
    (bare.contains("---") || bare.contains("===")) && bare.chars().all(|c| matches!(c, '-' | '=' | ' '))
}

/// The cells of a line that are parted by two blanks or more.
fn parted(line: &str) -> impl Iterator<Item = &str> {
    line.trim().split("  ").map(str::trim).filter(|cell| !cell.is_empty())
}

/// Whether two blanks or more part the cells of lines, some of them words: as many in most lines,
/// and in two of these a number; a comma is a decimal one.
fn of_cells<'a>(text: &str, lines: impl Iterator<Item = &'a str> + Clone) -> Option<usize> {
    let decimal = |line: &str| {
        let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
        let inside = |(at, _)| digit(line[..at].chars().next_back()) && digit(line[at + 1..].chars().next());
        line.match_indices(',').all(inside)
    };
    if text.lines().any(|line| line.contains(['\t', ';', '|', '&']) && (line.contains("  ") || !forms::told(line))) {
        return None;
    }
    let number = |line: &&str| {
        parted(line).nth(1).is_some() && parted(line).any(|cell| matches!(cell::read(cell, false), Cell::Number(_)))
    };
    // Behind the cells of a row a remark may stand.
    let remarked = |line: &str| parted(line).last().is_some_and(|cell| cell::read(cell, false) == Cell::Words);
    let counts: Vec<usize> = lines.clone().filter(number).map(|line| parted(line).count()).collect();
    let often = |n: usize| counts.iter().filter(|count| **count == n).count();
    let width = counts.iter().copied().rev().max_by_key(|&n| often(n))?;
    let alike = |line: &&str| match parted(line).count() {
        n if n == width => true,
        n => n == width + 1 && number(line) && remarked(line),
    };
    let rows = lines.clone().filter(alike).filter(number).count();
    // A title may hold any comma.
    let table = lines.clone().filter(alike).count();
    // Names that each stand above a column of the rows are of the table, though fewer.
    let columns = columns(lines.clone().filter(alike).map(|line| cells(line, 2)));
    let first = lines.clone().position(|line| alike(&line) && number(&line)).unwrap_or(0);
    let above = first.checked_sub(1).and_then(|at| lines.clone().nth(at)).map(|line| (line, cells(line, 2)));
    let names = above.is_some_and(|(line, own)| {
        !alike(&line) && !number(&line) && own.len() > 1 && own.len() + 1 == width && placed(&own, &columns).is_some()
    });
    let table = table + usize::from(names);
    // What stands before and behind its rows may be anything.
    let end = lines.clone().enumerate().filter(|(_, line)| alike(line)).last().map_or(0, |(n, _)| n + 1);
    let within = end - lines.clone().position(|line| alike(&line)).unwrap_or(0) + usize::from(names);
    let whole = if rows > 2 { within } else { lines.clone().count() };
    let found = rows > 1 && lines.clone().filter(alike).filter(number).all(decimal) && 3 * table >= 2 * whole;
    found.then_some(width)
}
