//! Which lines name the columns of a table, and what they say together.

use std::ops::Range;

use super::super::cell::Cell;
use super::super::grid::View;
use super::super::heading::{At, Heading, Meaning, Role, Value, What, is_sign};
use super::super::sequence::of_samples;
use super::super::units::{Dimension, Unit};
use super::super::words::{numbers, split};
use super::legend::Legend;
use super::own_lines::{UNITLESS, of_errors, of_units, spelt, united, with_errors};

/// A header: its names, the first of its lines, the first row below, and how much of it is
/// understood.
pub(super) struct Header {
    pub(super) names: Vec<String>,
    pub(super) at: usize,
    pub(super) below: usize,
    pub(super) score: usize,
}

impl Header {
    /// Whether it is one line.
    pub(super) const fn is_line(&self) -> bool {
        self.at + 1 == self.below
    }

    /// Whether each number of a row has a name of its own that is understood, and that says what
    /// the number is, or that it is a mean or an error of its neighbours.
    pub(super) fn names_all(&self, view: View<'_>, row: usize) -> bool {
        let says = |name: &String| {
            let heading = Heading::parse(name);
            // What is known to be left aside has its own name too.
            let aside = matches!(heading.meaning, Meaning::Aside(_)) && heading.unknown.is_empty();
            // A unit by itself is of a name above it.
            let bare = of_units(&[name.clone(), String::new()]);
            (heading.understood() || aside)
                && !bare
                && heading.value().is_none_or(|value| value.what != What::Unsaid || value.role != Role::Reading)
        };
        let own = |n: usize| self.names.get(n).filter(|name| !self.names[..n].contains(name));
        let numbers: Vec<usize> = (0..view.width(row)).filter(|&n| view.is_number(row, n)).collect();
        // One number beside another name is a remark that measures: `Method, drop from 2540 mm`.
        let several = numbers.len() > 1 || self.names.iter().filter(|name| !name.is_empty()).count() == 1;
        several && numbers.into_iter().all(|n| own(n).is_some_and(says))
    }
}

/// The names of bodies stand so many lines above those of their coordinates at most: their kinds,
/// their codes and what is measured between them.
const APART: usize = 4;
/// What a column of numbers adds to the score of a header; a column of names adds one.
pub(super) const VALUE: usize = 100;
/// What a column of ratios of heights, or of energies, adds, which are read where nothing else is.
pub(super) const SHARE: usize = 50;

/// The headers that may begin in a row: one line, or two.
pub(super) fn headers(view: View<'_>, legend: &Legend, row: usize, end: usize) -> Vec<Header> {
    let mut found = Vec::new();
    if !names_only(view, row) {
        return found;
    }
    let line = |n: usize| -> Vec<String> { view.cells(n).map(|cell| legend.words(cell).into_owned()).collect() };
    let one = line(row);
    let one = clause_of(view, &one, row + 1..end).map_or(one, |name| vec![name]);
    let below = |n: usize| n < end && names_only(view, n);
    // Units are no names; and one name alone above several is a title.
    let names = |n: usize| view.cells(n).filter(|cell| !cell.is_empty()).count();
    let titled =
        names(row) == 1 && !one[0].is_empty() && row + 1 < end && names_only(view, row + 1) && names(row + 1) > 1;
    if of_units(&one) || of_errors(&one) || titled || Unit::listed(&one.join(" ")).is_some() {
        return found;
    }
    // Names that come again below those of bodies say what they say alone, whatever these are
    // called.
    let bodies = |names: &[String], lower: &[String]| {
        let again = |names: &[String]| (0..names.len()).any(|n| again(names, n).next().is_some());
        again(lower) && !again(names)
    };
    let mut push = |names: Vec<String>, next: usize| {
        let names = counted(united(view, &names, next).unwrap_or(names));
        let lower = if next > row + 1 { line(row + 1) } else { Vec::new() };
        let bare = |name: &String| name.rsplit_once(": ").map_or(name.as_str(), |(_, own)| own).to_owned();
        let own = || score(&names.iter().map(bare).collect::<Vec<_>>()) + 1;
        let score = score(&names).max(if bodies(&names, &lower) { own() } else { 0 });
        let counted = measured(view, &names, next) || sampled(view, &names, next..end);
        let score = if (1..VALUE).contains(&score) && counted { score + VALUE } else { score };
        let numbers = |n: usize| (0..view.width(n).max(1)).any(|c| view.is_number(n, c));
        // A row of words may stand between, such as of units that are not known, and remarks; a
        // header without rows is one too.
        let remarks = (next..end).take_while(|&n| remark(view, n, &names)).count();
        let rows = next + remarks;
        if score > 0 && (rows >= end || numbers(rows) || rows + 1 < end && numbers(rows + 1) || events(view, rows)) {
            found.push(Header { names, at: row, below: next, score });
        }
    };
    // Below the names their errors may stand, and below these the counts of what a name spans.
    let errors = Some(row + 1).filter(|&n| n < end && of_errors(&line(n))).map(line);
    if let Some(errors) = errors {
        push(with_errors(&one, one.clone(), &errors), row + 2);
        if let Some(names) = (row + 2 < end).then(|| numbered(view, &one, row + 2)).flatten() {
            push(with_errors(&one, names, &errors), row + 3);
        }
        return found;
    }
    push(one.clone(), row + 1);
    if let Some(names) = (row + 1 < end).then(|| numbered(view, &one, row + 1)).flatten() {
        push(names, row + 2);
    }
    // Units may stand below remarks.
    let remarks = (row + 1..end).take_while(|&n| remark(view, n, &one)).count();
    let units = row + 1 + remarks;
    if remarks > 0
        && below(units)
        && of_units(&line(units))
        && let Some(names) = both(&one, &line(units))
    {
        push(names, units + 1);
    }
    // What is followed may be named some lines above its coordinates.
    let last = (row + 1..end.min(row + 1 + APART)).take_while(|&n| names_only(view, n)).last();
    let last = last.filter(|&last| last > row + 1 && last + 1 < end && tells_apart(&one, &line(last)));
    if let Some((last, names)) = last.and_then(|last| Some((last, both(&one, &line(last))?))) {
        push(names, last + 1);
    }
    if below(row + 1)
        && !events(view, row + 1)
        && let Some(names) = both(&one, &line(row + 1))
    {
        if below(row + 2)
            && let Some(names) = both(&names, &line(row + 2)).filter(|_| of_units(&line(row + 2)))
        {
            push(names, row + 3);
        }
        push(names, row + 2);
    }
    found
}

/// Of a sentence above a single column, which commas part, the only clause that says what the
/// numbers are: `superball on tile, contact times in s`.
fn clause_of(view: View<'_>, names: &[String], mut rows: Range<usize>) -> Option<String> {
    let single = names.len() > 1 && names.iter().all(|name| !name.is_empty());
    if !single || rows.len() < 2 || !rows.all(|row| view.width(row) == 1 && view.is_number(row, 0)) {
        return None;
    }
    let says = |name: &&String| {
        let heading = Heading::parse(name);
        heading.understood() && heading.value().is_some_and(|value| value.what != What::Unsaid)
    };
    let mut found = names.iter().filter(says);
    found.next().filter(|_| found.next().is_none()).cloned()
}

/// Whether a row holds a cell of words and nothing else, where several columns are named: it is no
/// header of theirs, nor of a table below them.
pub(super) fn remark(view: View<'_>, row: usize, names: &[String]) -> bool {
    names.iter().filter(|name| !name.is_empty()).count() > 1
        && names_only(view, row)
        && view.cells(row).filter(|cell| !cell.is_empty()).count() == 1
        && !events(view, row)
        && !of_units(&view.cells(row).map(str::to_owned).collect::<Vec<_>>())
}

/// Whether a cell of a row bears a unit, below a name that is understood.
fn measured(view: View<'_>, names: &[String], row: usize) -> bool {
    names.iter().enumerate().any(|(n, name)| {
        let unit = matches!(view.read(row, n), Cell::Number(m) if m.unit.is_some_and(|u| u.dimension != Dimension::Other && !u.unscaled()));
        unit && Heading::parse(name).understood()
    })
}

/// Whether a name of samples stands above numbers of them, in the first rows.
fn sampled(view: View<'_>, names: &[String], rows: Range<usize>) -> bool {
    names
        .iter()
        .enumerate()
        .any(|(n, name)| of_samples(&Heading::parse(name), rows.clone().take(2).map(|row| view.cell(row, n))))
}

/// Whether a row holds the name of an event and nothing else.
fn events(view: View<'_>, row: usize) -> bool {
    let alone = (1..view.width(row)).all(|n| view.cell(row, n).is_empty());
    alone && matches!(view.cell(row, 0).to_lowercase().as_str(), "release" | "drop" | "start" | "contact" | "apex")
}

/// Whether a row holds words and no number.
pub(super) fn names_only(view: View<'_>, row: usize) -> bool {
    let (mut words, mut numbers) = (0, 0);
    for column in 0..view.width(row) {
        numbers += usize::from(view.is_number(row, column));
        words += usize::from(!view.cell(row, column).is_empty());
    }
    words > 0 && numbers == 0
}

/// `Rebound (cm)` over `1,2,3`: the columns that a name spans are counted in the line below it.
fn numbered(view: View<'_>, upper: &[String], row: usize) -> Option<Vec<String>> {
    let width = view.width(row).max(upper.len());
    let above = |n: usize| upper.get(n).filter(|cell| !cell.is_empty());
    let (mut spanning, mut count, mut names, mut counted) = (String::new(), 0, Vec::new(), 0);
    for n in 0..width {
        if let Some(name) = above(n) {
            (spanning, count) = (name.clone(), 0);
        }
        let cell = view.cell(row, n);
        if cell.is_empty() {
            names.push(above(n).cloned().unwrap_or_default());
            continue;
        }
        count += 1;
        if cell.parse() != Ok(count) || spanning.is_empty() {
            return None;
        }
        counted += usize::from(count > 1);
        names.push(with_count(&spanning, count));
    }
    (counted > 0 && view.cell(row, 0).is_empty()).then_some(names)
}

/// A name and its count, the unit staying behind the slash: `height 2 / m`.
fn with_count(name: &str, count: usize) -> String {
    match name.rsplit_once('/').filter(|(_, unit)| Unit::parse(unit).is_some()) {
        Some((name, unit)) => format!("{} {count} / {}", name.trim_end(), unit.trim()),
        None => format!("{name} {count}"),
    }
}

/// How much of a header is understood.
pub(super) fn score(names: &[String]) -> usize {
    let of = |name: &String| {
        let heading = Heading::parse(name);
        match heading.meaning {
            _ if !heading.unknown.is_empty() => 0,
            Meaning::Value(_) => VALUE + usize::from(heading.unit.is_some()),
            // A frame tells a time.
            Meaning::Frame => VALUE,
            Meaning::Aside(_) if heading.share.is_some() || heading.energy.is_some() => SHARE,
            Meaning::Empty | Meaning::Aside(_) => 0,
            _ => 1,
        }
    };
    names.iter().map(of).sum()
}

/// The names that two lines give together; `None` where the upper is a title.
pub(super) fn both(upper: &[String], lower: &[String]) -> Option<Vec<String>> {
    let width =
        upper.iter().rposition(|cell| !cell.is_empty())?.max(lower.iter().rposition(|cell| !cell.is_empty())?) + 1;
    let cell = |line: &[String], n: usize| line.get(n).cloned().unwrap_or_default();
    if of_units(lower) {
        let name = |n: usize| match (cell(upper, n), cell(lower, n)) {
            (name, unit) if !name.is_empty() && !unit.is_empty() && !UNITLESS.contains(&unit.as_str()) => {
                format!("{name} ({})", spelt(&unit))
            }
            (name, _) => name,
        };
        // What has a unit has a name.
        return (0..width)
            .all(|n| cell(lower, n).is_empty() || !cell(upper, n).is_empty())
            .then(|| (0..width).map(name).collect());
    }
    // A name and its value above the first of several names are of the file: `MARKER_NAMES ball`.
    let filled = |line: &[String]| line.iter().filter(|cell| !cell.is_empty()).count();
    let named = !cell(upper, 0).is_empty() && !cell(upper, 1).is_empty() && !cell(lower, 0).is_empty();
    if filled(upper) == 2 && filled(lower) > 2 && named {
        return None;
    }
    // A name that ends in a colon has its value beside it.
    if upper.windows(2).any(|pair| pair[0].ends_with(':') && !pair[1].is_empty()) {
        return None;
    }
    // A title stands alone, above the first name, unless it names a quantity, its unit and no first
    // column: `Time between bounces (s)` above `1st-2nd`, `2nd-3rd`.
    let first = |line: &[String]| line.iter().position(|cell| !cell.is_empty());
    let spans = || {
        let (at, name) = first(upper).map_or((0, String::new()), |at| (at, upper[at].clone()));
        let above = Heading::parse(&name);
        let read = above.unknown.is_empty() && above.unit.is_some() && above.value().is_some();
        at > 0 && first(lower) == Some(at) && read && lower[at..].iter().filter(|cell| flight(cell)).count() > 1
    };
    if upper.iter().filter(|cell| !cell.is_empty()).count() == 1 && first(upper) <= first(lower) && !spans() {
        return None;
    }
    // A merged cell holds its text in the first of the columns that it spans.
    let mut spanning = String::new();
    let above: Vec<String> = (0..width)
        .map(|n| {
            if !cell(upper, n).is_empty() {
                spanning = cell(upper, n);
            } else if cell(lower, n).is_empty() {
                spanning.clear();
            }
            spanning.clone()
        })
        .collect();
    let merged = (0..width).any(|n| cell(upper, n).is_empty() != cell(lower, n).is_empty());
    let again = |n: usize| again(lower, n);
    let repeated = (0..width).any(|n| again(n).next().is_some());
    let told = tells_apart(upper, lower);
    let written = spelt_out(upper, lower);
    // `Ball,Golf,,Tennis` above names that come again: of each block what stands above it.
    let above = if repeated { blocks(upper, lower).unwrap_or(above) } else { above };
    let name = |n: usize| match (above[n].as_str(), cell(lower, n)) {
        (name, lower) if lower.is_empty() => name.to_owned(),
        ("", lower) => lower,
        // Among names a unit is that of the name above it.
        (name, lower) if !cell(upper, n).is_empty() && of_units(&[lower.clone(), String::new()]) => {
            format!("{name} ({})", spelt(&lower))
        }
        // A sign, with its unit, above what it stands for: `h1 [cm]`, `after the bounce`.
        (name, lower) if !cell(upper, n).is_empty() && explained(name, &lower) => {
            let at = name.rfind(['(', '[']).unwrap_or(name.len());
            format!("{lower} {}", &name[at..])
        }
        // `Trial 1` above `Time (s)`, and `Trial 2` above another: runs side by side.
        (_, lower) if told && again(n).next().is_none() => lower,
        (name, lower) if repeated => format!("{name}: {lower}"),
        (name, lower) => spanned(name, &lower),
    };
    (merged || told || written).then(|| (0..width).map(name).collect())
}

/// The other columns of the same name.
fn again(names: &[String], n: usize) -> impl Iterator<Item = usize> {
    let name = names.get(n).filter(|name| name.contains(char::is_alphabetic));
    (0..names.len()).filter(move |m| *m != n && name.is_some_and(|name| names[*m] == *name))
}

/// Whether names that come again stand below others each: `ball,ball,floor,floor` above `x,y,x,y`.
fn tells_apart(upper: &[String], lower: &[String]) -> bool {
    let above = |n: usize| upper.get(n).filter(|name| !name.is_empty());
    let mut of_several = (0..lower.len()).filter(|&n| again(lower, n).next().is_some()).peekable();
    let apart = |n: usize| above(n).is_some() && again(lower, n).all(|m| above(m) != above(n));
    of_several.peek().is_some() && of_several.all(apart)
}

/// Whether a name that spans several columns is written in each of them, `Rebound` three times,
/// above what tells these apart: `min (cm)`, `max (cm)`, `mean (cm)`.
fn spelt_out(upper: &[String], lower: &[String]) -> bool {
    let alike = |n: &usize| again(upper, *n).any(|m| m.abs_diff(*n) == 1);
    let named = |n: usize| lower.get(n).is_some_and(|name| name.contains(char::is_alphabetic));
    let mut spanned = (0..upper.len()).filter(alike).peekable();
    spanned.peek().is_some() && spanned.all(|n| named(n) && again(lower, n).next().is_none())
}

/// Names of which some come again next to one another are counted, where heights of release stand
/// beside them: `release (m)`, `rebound (m)`, `rebound (m)`. One that names its bounce is of
/// trials.
fn counted(names: Vec<String>) -> Vec<String> {
    let value = |name: &str| Heading::parse(name).value().cloned();
    let released = |v: Value| (v.what, v.at) == (What::Height, At::Release);
    if repeated(&names).is_some() || !names.iter().filter_map(|name| value(name)).any(released) {
        return names;
    }
    let place = |n: usize| names[..n].iter().rev().take_while(|name| **name == names[n]).count() + 1;
    let several = |n: usize| place(n) > 1 || names.get(n + 1) == Some(&names[n]);
    let name = |n: usize| {
        let of = value(&names[n]).filter(|v| v.what == What::Height && v.trial.is_empty() && several(n));
        match of.map(|v| v.at) {
            None | Some(At::Release) => names[n].clone(),
            Some(At::Nth(_)) => format!("trial {}, {}", place(n), names[n]),
            Some(_) => with_count(&names[n], place(n)),
        }
    };
    (0..names.len()).map(name).collect()
}

/// Whether a name that is a sign, with the unit of it, `h1 [cm]`, stands above the words that say
/// what it is.
fn explained(name: &str, words: &str) -> bool {
    let (above, own) = (Heading::parse(name), Heading::parse(words));
    let sign = is_sign(name.split(['(', '[']).next().unwrap_or_default().trim());
    let fits = |unit: Unit| own.value().is_some_and(|v| v.what.dimension().is_none_or(|d| d == unit.dimension));
    sign && name.ends_with([')', ']']) && own.unit.is_none() && above.unit.is_some_and(fits)
}

/// What stands above each column of blocks of the same names: the cells above its block, of which
/// one that names balls or surfaces at large says nothing; `None` where the names make no blocks.
fn blocks(upper: &[String], lower: &[String]) -> Option<Vec<String>> {
    let found = repeated(lower)?;
    let mut above = upper.to_vec();
    above.resize(lower.len().max(upper.len()), String::new());
    for block in found {
        let cells = upper.get(block.start..block.end.min(upper.len())).unwrap_or_default();
        let plain = |cell: &&String| matches!(Heading::parse(cell).meaning, Meaning::Setting);
        let filled: Vec<&String> = cells.iter().filter(|cell| !cell.is_empty()).collect();
        let says: Vec<&str> = match filled.as_slice() {
            [first, rest @ ..] if !rest.is_empty() && plain(first) => rest.iter().map(|cell| cell.as_str()).collect(),
            all => all.iter().map(|cell| cell.as_str()).collect(),
        };
        above[block].fill(says.join(" "));
    }
    Some(above)
}

/// The columns of each block, where the same names come again and again.
pub(in crate::read) fn repeated(header: &[String]) -> Option<Vec<Range<usize>>> {
    let mut groups: Vec<Range<usize>> = Vec::new();
    for (n, _) in header.iter().enumerate().filter(|(_, cell)| !cell.is_empty()) {
        match groups.last_mut().filter(|group| group.end == n) {
            Some(group) => group.end += 1,
            None => groups.push(n..n + 1),
        }
    }
    if let [one] = groups.as_slice() {
        // Without blank columns between: the first name begins each.
        let (start, end) = (one.start, one.end);
        let period = (start + 1..end).find(|&n| header[n] == header[start])? - start;
        if period < 2 || (end - start) % period != 0 {
            return None;
        }
        groups = (start..end).step_by(period).map(|n| n..n + period).collect();
    }
    let first = groups.first()?.clone();
    let same = groups.iter().all(|group| header[group.clone()] == header[first.clone()]);
    (groups.len() > 1 && same).then_some(groups)
}

/// Whether a name is of two bounces, one after the other: `1st-2nd`.
fn flight(name: &str) -> bool {
    matches!(numbers(&split(name)).bounce.as_slice(), [one, other] if *one > 0 && *other == one + 1)
}

/// What an upper name adds to a lower: `Rebound (cm)` above `Trial 1`, whose unit is for both, as
/// that of `Height (cm)` is above `release`.
fn spanned(name: &str, lower: &str) -> String {
    let (own, above) = (Heading::parse(lower), Heading::parse(name));
    let same = |what: What| above.value().is_some_and(|v| v.what == what && v.at == At::Row);
    if own.unit.is_none() && above.unit.is_some() && own.value().is_some_and(|v| same(v.what)) {
        let bare = name.rfind(['(', '[']).map(|at| &name[at..]).filter(|unit| unit.ends_with([')', ']']));
        return bare.map_or(lower.to_owned(), |unit| format!("{lower} {unit}"));
    }
    let key = matches!(own.meaning, Meaning::Trial | Meaning::Number { .. } | Meaning::Event | Meaning::Frame);
    let said = key && own.unknown.is_empty() || own.value().is_some_and(|v| v.what != What::Unsaid);
    let aside = matches!(own.meaning, Meaning::Aside(_)) && own.unknown.is_empty();
    if said || aside && !(flight(lower) && above.unit.is_some()) {
        lower.to_owned()
    } else {
        format!("{lower}, {name}")
    }
}
