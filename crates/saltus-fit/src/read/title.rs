//! What the lines above a table state: a frame rate, the height of release, the unit and the error
//! of all readings; and lengths that are not used.

use super::aside::LeftAside;
use super::cell::{Cell, spaced};
use super::clause::{clauses, drop, error, frame_rate, lengths, names_rate, of_clauses};
use super::datum::{self, Datum};
use super::forms::told;
use super::grid::{Grid, shown};
use super::heading::{At, DropHeight, Heading, Meaning, What};
use super::phrases::Phrase;
use super::region::Region;
use super::sizes::states_length;
use super::units::{Dimension, Unit};
use super::vocabulary::{Atom, ROWS, folded, misspelt};
use super::words::{Kind, Word, split, without_brackets};
use super::{Event, Table};
use crate::finding::{Doubt, Note, Remark};
use crate::statistics::{FILMED, RATES};

/// Heights of release are read within this part of the one that is stated: a centimetre or two.
const NOMINAL: f64 = 0.03;

/// Lengths that are written alike differ by less, m.
const SAME: f64 = 1e-9;

/// A title has no more words than this; more, of which not all are understood, are a sentence.
const TITLE: usize = 4;

/// What a table's title states, and where.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Stated {
    /// The line of one cell next to the table: its name.
    pub(super) name: String,
    /// Frames a second, and the line.
    pub(super) fps: Option<(f64, u64)>,
    /// Whether a line says that numbers of frames stand below it.
    frames: bool,
    /// The height of release, and the line.
    pub(super) drop: Option<(DropHeight, u64)>,
    /// The units of all times and of all heights.
    pub(super) units: (Option<Unit>, Option<Unit>),
    /// The unit of all speeds.
    pub(super) speed: Option<Unit>,
    /// The standard errors of heights, m, and of times, s.
    pub(super) sigma: (Option<f64>, Option<f64>),
    /// What the scale reads at the floor.
    pub(super) datum: Option<Datum>,
    /// A line that speaks of heights, states lengths, and is not used; its number, and these, m.
    pub(super) length: Option<(String, u64, Vec<f64>)>,
}

/// Reads the lines above a table.
pub(super) fn stated(region: &Region<'_>) -> Stated {
    let mut found = Stated::default();
    let comments = region.view.grid.comments().take(ROWS).flat_map(|(_, text)| clauses(text));
    let units = comments.flat_map(|text| Unit::listed(text).unwrap_or_else(|| of_clauses(text).into_iter().collect()));
    units.for_each(|unit| found.of_all(unit));
    let commented = || region.view.grid.comments().take(ROWS).find_map(|(line, text)| Some((drop(text)?, line)));
    // Of rows that are turned over, lines by themselves state the units of all.
    if region.view.across {
        let grid = region.view.grid;
        let alone = |row: &usize| (1..grid.width(*row)).all(|n| grid.cell(*row, n).is_empty());
        let said = (0..grid.rows().min(ROWS)).filter(alone).flat_map(|row| of_clauses(grid.cell(row, 0)));
        said.for_each(|unit| found.of_all(unit));
        // A remark may stand beside them.
        let lines = (0..grid.rows().min(ROWS)).flat_map(|row| (0..grid.width(row)).map(move |n| (row, n)));
        let mut drops = lines.filter_map(|(row, n)| Some((drop(grid.cell(row, n))?, grid.line(row))));
        found.drop = drops.next().or_else(commented);
        return found;
    }
    let headings = region.header.iter().filter_map(|name| Heading::parse(name).rate);
    let of_column = || (0..region.header.len()).find_map(|column| of_column(region, column));
    found.fps = headings.into_iter().next().or_else(of_column).map(|fps| (fps, region.view.line(region.header_row, 0)));
    found.fps = found.fps.or_else(|| lone(region));
    // Below a table as well, where a line stands alone.
    let above = region.aside.iter().filter_map(|aside| aside.line).map(|line| region.view.grid.row_of(line));
    let alone = |row: &usize| (1..region.view.width(*row)).all(|n| region.view.cell(*row, n).is_empty());
    let below = region.rows.iter().rev().take(ROWS).copied().filter(alone);
    let cells = |row: usize| region.view.cells(row).filter(|cell| !cell.is_empty());
    // Emphasis is no word: `dropped from **1 m**`, and blanks part thousands: `1 016 mm`.
    let text = |row: usize| cells(row).map(closed).collect::<Vec<_>>().join(" ").replace('*', "");
    let rows: Vec<usize> = above.chain(below).collect();
    let said: Vec<(u64, String)> = rows.iter().map(|&row| (region.view.line(row, 0), text(row))).collect();
    let header = region.view.line(region.header_row, 0);
    // The name of one of several columns of heights is of these alone.
    let at = |name: &String| Heading::parse(name).value().filter(|v| v.what == What::Height).map(|v| v.at);
    let several = region.header.iter().filter_map(at).count() > 1;
    let of = |name: &String| match at(name) {
        Some(At::Release) if several => "drop height",
        Some(_) if several => "rebound height",
        _ => "height",
    };
    let names: Vec<(u64, String)> = region.header.iter().map(|name| (header, format!("{} {name}", of(name)))).collect();
    let [own, names] =
        [&said, &names].map(|lines| lines.iter().map(|(line, text)| (*line, text.as_str())).collect::<Vec<_>>());
    found.datum = datum::stated(&region.view.grid.comments().take(ROWS).chain(own).collect::<Vec<_>>(), &names);
    let wrapped = said.windows(2).find_map(|pair| Some((drop(&sentence(pair)?)?, pair[0].0)));
    for (row, (line, text)) in rows.into_iter().zip(said) {
        let cells: Vec<&str> = cells(row).collect();
        let (fps, height, sigma) =
            (frame_rate(&text), drop(&text).or(drop(&cells.join("; "))).or_else(|| begun(&cells)), error(&text));
        let zero = matches!(&found.datum, Some(Datum::Zero(zero)) if zero.line == line);
        if !zero
            && fps.is_none()
            && height.is_none()
            && sigma.is_none()
            && states_length(&text)
            && !names_no_readings(&text)
        {
            found.length = found.length.or(Some((shown(&text), line, lengths(&text))));
        }
        found.fps = found.fps.or(fps.map(|fps| (fps, line)));
        found.drop = found.drop.or(height.map(|drop| (drop, line)));
        if let Some((value, Dimension::Time)) = sigma {
            found.sigma.1 = found.sigma.1.or(Some(value));
        } else if let Some((value, _)) = sigma {
            found.sigma.0 = found.sigma.0.or(Some(value));
        }
        let of_clauses = || of_clauses(&text).into_iter().collect();
        Unit::listed(&text).unwrap_or_else(of_clauses).into_iter().for_each(|unit| found.of_all(unit));
        found.frames |= cells.iter().any(|cell| counts_frames(cell));
        found.name = if cells.len() == 1 && row < region.header_row { text } else { found.name };
    }
    found.drop = found.drop.or(wrapped).or_else(commented);
    found.frames |= region.view.grid.comments().take(ROWS).any(|(_, text)| counts_frames(text));
    // Numbers of frames that a title speaks of are times, where it names no other quantity.
    let in_comments = || region.view.grid.comments().take(ROWS).find_map(|(_, text)| frame_rate(text));
    let fps = found.fps.map(|(fps, _)| fps).or_else(in_comments);
    if let (true, Some(fps), (None, None)) = (found.frames, fps, found.units) {
        found.units.0 = Some(Unit::frame(fps));
    }
    found
}

/// A sentence that goes on in the next line, `dropped three times` above `from 200 cm`: the one
/// does not end, and the other begins with no capital.
fn sentence(pair: &[(u64, String)]) -> Option<String> {
    let [(above, first), (below, second)] = pair else { return None };
    let goes_on = !first.trim_end().ends_with(['.', ':', '!', '?', ';', ')']) && second.starts_with(char::is_lowercase);
    (below.checked_sub(1) == Some(*above) && goes_on && told(first)).then(|| format!("{} {second}", first.trim_end()))
}

/// The height of release that a name, a number and its unit state in cells of their own, whatever
/// stands in those behind them.
fn begun(cells: &[&str]) -> Option<DropHeight> {
    let [name, number, unit, ..] = cells else { return None };
    drop(&format!("{name} {number} {unit}"))
}

/// A cell whose number, by itself or behind a sign, is written without blanks between thousands.
fn closed(cell: &str) -> String {
    let (name, number) = cell.rfind(['=', ':']).map_or(("", cell), |at| cell.split_at(at + 1));
    spaced(number.trim_start()).map_or_else(|| cell.to_owned(), |number| format!("{name} {number}"))
}

/// The heights of release, m, that lines of a sheet state, each in a cell or in several.
pub(super) fn drops(grid: &Grid<'_>) -> Vec<f64> {
    let cells = |row: usize| (0..grid.width(row)).map(move |n| grid.cell(row, n)).filter(|cell| !cell.is_empty());
    let text = |row: usize| cells(row).map(closed).collect::<Vec<_>>().join(" ");
    let said = |row: usize| drop(&text(row)).or_else(|| cells(row).find_map(drop));
    (0..grid.rows().min(ROWS)).filter_map(said).map(|height| height.metres()).collect()
}

/// The units of times and of heights that the name of a file ends in, `3 balls heights cm`.
pub(super) fn named(name: &str) -> (Option<Unit>, Option<Unit>) {
    let ends = name.match_indices(' ').map(|(at, _)| &name[at + 1..]);
    let mut found = Stated::default();
    std::iter::once(name).chain(ends).find_map(of_clauses).into_iter().for_each(|unit| found.of_all(unit));
    found.units
}

impl Stated {
    /// With what a title above that of another table states, where its own does not.
    pub(super) fn below(self, first: &Self) -> Self {
        Self {
            drop: self.drop.or_else(|| first.drop.clone()),
            units: (self.units.0.or(first.units.0), self.units.1.or(first.units.1)),
            speed: self.speed.or(first.speed),
            sigma: (self.sigma.0.or(first.sigma.0), self.sigma.1.or(first.sigma.1)),
            datum: self.datum.or_else(|| first.datum.clone()),
            ..self
        }
    }

    /// Takes a unit in that is of all readings of its dimension, unless another one was stated.
    fn of_all(&mut self, unit: Unit) {
        let place = match unit.dimension {
            Dimension::Time => &mut self.units.0,
            Dimension::Length => &mut self.units.1,
            Dimension::Speed => &mut self.speed,
            Dimension::Other => return,
        };
        *place = place.or(Some(unit));
    }
}

/// The rate of a film whose frames are counted, where the only number above the names stands in a
/// line by itself.
fn lone(region: &Region<'_>) -> Option<(f64, u64)> {
    let counted = region.header.iter().any(|name| Heading::parse(name).meaning == Meaning::Frame);
    let filled = |row: usize| region.view.cells(row).filter(|cell| !cell.is_empty()).count();
    let number =
        |row: usize| Some((region.view.number(row, 0).filter(|_| filled(row) == 1)?, region.view.line(row, 0)));
    let mut alone = (0..region.header_row.min(ROWS)).filter_map(number);
    let first = alone.next().filter(|(rate, _)| counted && (RATES[0]..=FILMED).contains(rate))?;
    alone.next().is_none().then_some(first)
}

/// Whether a clause of a title is of frames, all of its words being understood: `frame in which the
/// ball touches the floor`.
fn counts_frames(text: &str) -> bool {
    let text = without_brackets(text);
    let parts = clauses(&text).flat_map(|part| part.split(" - "));
    let mut of_frames = parts.map(Heading::parse).filter(|h| h.has(Atom::Frame) && h.value().is_none());
    of_frames.any(|heading| heading.unknown.is_empty() && (heading.rate.is_none() || heading.has(Atom::Number)))
}

/// The rate that a column of its own states, the same in all of its cells.
fn of_column(region: &Region<'_>, column: usize) -> Option<f64> {
    if !names_rate(&region.header[column]) {
        return None;
    }
    let factor = if folded(&region.header[column]).contains("khz") { 1000.0 } else { 1.0 };
    let number = |row: &usize| match region.view.read(*row, column) {
        Cell::Number(m) => Some(m.value * factor),
        _ => frame_rate(region.view.cell(*row, column)),
    };
    let mut rates = region.rows.iter().filter_map(number);
    let first = rates.next().filter(|rate| *rate > 0.0)?;
    rates.all(|rate| rate == first).then_some(first)
}

/// Whether a text that is no heading says that what it names was not read.
///
/// What only looks like a word that was worked out, `different` for `differenz`, or is the
/// beginning of one, `slo-mo` for `slope`, is none there.
pub(super) fn names_no_readings(text: &str) -> bool {
    // A body whose rule a test keeps is a name there: `ITF style test`.
    let rule = |word: &Word| word.is(Atom::Goal) && word.text.chars().all(char::is_uppercase);
    let words = split(text);
    let test = |w: &Word| [Atom::Filler, Atom::Trial, Atom::Rebound, Atom::Release].iter().any(|atom| w.is(*atom));
    let named = words.iter().position(rule).filter(|at| words.get(at + 1).is_some_and(test));
    let bare = named.map(|at| text.replacen(&words[at].text, "", 1));
    let text = bare.as_deref().unwrap_or(text);
    let heading = Heading::parse(text);
    // Among words that are not understood a part of something is that of anything: `kept in water`;
    // and a log is a record.
    // Who signs, `LG Jonas`, works nothing out.
    let signed = |word: &Word| word.is(Atom::Derived) && heading.has(Atom::Person);
    let silent =
        |word: &Word| word.is(Atom::Note) || signed(word) || word.is(Atom::Ratio) && !heading.unknown.is_empty();
    let exact = |atom: Atom| split(text).iter().any(|word| word.is(atom) && !silent(word));
    let slip = |atom: Atom| {
        let meant = |word: &Word| misspelt(&folded(&word.text)).is_some_and(|(_, atoms)| atoms.contains(&atom));
        matches!(atom, Atom::Predicted | Atom::Goal) && split(text).iter().any(meant)
    };
    let unread = |atom: &Atom| exact(*atom) || slip(*atom);
    heading.turns_readings() && heading.turned_by().iter().any(unread)
}

/// A title that speaks of what was not measured is a doubt, unless a column is the one it speaks
/// of.
pub(super) fn doubted(region: &Region<'_>, table: &mut Table) {
    // The rate of a recording is none of what it shows.
    let turns = names_no_readings;
    // What a rule of measuring is called turns nothing: `acc. to ITF procedure`.
    let by_rule = |text: &str| {
        let lower = text.to_lowercase();
        let at = Phrase::According.all().iter().find_map(|rule| Some((lower.find(rule)?, rule.len())));
        let (at, long) = at.filter(|_| lower.len() == text.len())?;
        let after = text[at + long..].trim_start().split_once(' ').map_or("", |(_, after)| after);
        Some(format!("{}{after}", &text[..at]))
    };
    let turned = |text: &str| match (frame_rate(text), by_rule(text)) {
        _ if text.split([':', '=', ',', ';', '\t']).next().is_some_and(names_rate) => false,
        (Some(_), _) => turns(&text.replace("rate", "")),
        (None, Some(text)) => turns(&text),
        (None, None) => turns(text),
    };
    if region.header.iter().any(|name| turned(name)) {
        return;
    }
    // What stands above a line that says whose readings follow is of others: `My results`.
    let reads = |aside: &LeftAside| {
        let read = |w: &Word| matches!(w.kind, Kind::Known([Atom::Filler, Atom::Read]));
        split(&aside.name).iter().any(read) && !turned(&aside.name)
    };
    let from = region.aside.iter().rposition(reads).unwrap_or(0);
    // Of a name and what it is, the name says whether readings follow: `Product`, `range ball`; but
    // what was predicted is no reading wherever that is written.
    let row = |aside: &LeftAside| {
        let row = region.view.grid.row_of(aside.line?);
        let cells = (0..region.view.grid.width(row)).map(|column| region.view.grid.cell(row, column));
        let cells: Vec<String> = cells.filter(|cell| !cell.is_empty()).map(str::to_owned).collect();
        <[String; 2]>::try_from(cells).ok()
    };
    let wanted =
        |value: &str| Heading::parse(value).turned_by().iter().any(|a| matches!(a, Atom::Predicted | Atom::Goal));
    // What a sensor shows may be in any unit, `Normalized force`: its times are what they are.
    let felt = table.notes.iter().any(|note| matches!(note.kind, Note::Felt { .. }));
    // What was aimed at, and stands behind its name itself, is none of the readings.
    let aimed = |text: &str| {
        text.split_once(':').is_some_and(|(name, aim)| {
            let by = Heading::parse(name).turned_by();
            let stated = aim.contains(|c: char| c.is_ascii_digit()) || !Heading::parse(aim).names_anything();
            by == [Atom::Goal] && stated
        })
    };
    // What refers to the floor, or to an end of the ball, says where heights begin.
    let placed = |text: &str| {
        text.split_once(':').is_some_and(|(name, place)| {
            let of_place = |word: &Word| word.is(Atom::Floor) || word.is(Atom::Bottom);
            turned(name) && split(place).iter().any(of_place) && !turns(place)
        })
    };
    // In a sentence a word turns nothing by itself: `corrected for parallax`.
    let sentence = |text: &str| {
        let words = split(text);
        let named = text.split_once(':').is_some_and(|(name, _)| turned(name));
        !named && words.len() > TITLE && words.iter().any(|word| matches!(word.kind, Kind::Unknown))
    };
    let tells =
        |text: &str| turned(text) && (!felt || wanted(text)) && !aimed(text) && !placed(text) && !sentence(text);
    // Names above other numbers than those of the table are of these.
    let of_others = |aside: &LeftAside| {
        let below = aside.line.map(|line| region.view.grid.row_of(line) + 1);
        below.is_some_and(|row| {
            let numbers = (0..region.view.width(row)).filter(|&n| region.view.is_number(row, n)).count();
            row < region.header_row && numbers > 1 && numbers == region.view.cells(row).count()
        })
    };
    let titles = |aside: &&LeftAside| match row(aside) {
        _ if of_others(aside) => false,
        Some([name, value]) => tells(&name) || turned(&value) && wanted(&value),
        None => tells(&aside.name),
    };
    let title = region.aside[from..].iter().filter(|aside| !aside.name.starts_with('>')).find(titles);
    let title = title.map(|title| Doubt::Title { text: title.name.clone(), line: title.line.unwrap_or(1) });
    // Comments speak of much else: of one every word is understood, or of a clause of it, which
    // states no number, for then it speaks of that; and what it states of something by name
    // (`frame rate: 30`) is of that alone.
    let speaks = |text: &str| Heading::parse(text).unknown.is_empty() && turned(text);
    let whole = |text: &str| {
        let said = text.split_once(':').map_or(text, |(_, said)| said);
        let clauses = said.split([',', ';', '(']).flat_map(|part| part.split(". "));
        speaks(said) || clauses.filter(|clause| !clause.contains(|c: char| c.is_ascii_digit())).any(speaks)
    };
    let comment = || region.view.grid.comments().take(ROWS).find(|(_, text)| whole(text));
    let comment = || comment().map(|(line, text)| Doubt::Title { text: shown(text.trim()), line });
    table.doubts.extend(title.or_else(comment));
}

/// The doubt about a length that is stated and that no reading takes in: one of a sentence, but for
/// the table's own release, and a height of release where those of the table are others.
pub(super) fn unmet(title: &Stated, table: &Table) -> Option<Doubt> {
    let own = || table.trials.iter().flat_map(|t| &t.readings).filter(|r| r.event == Event::Release);
    let own = || own().filter_map(|reading| reading.height);
    // What the row of the floor reads is taken in, in whatever unit.
    let floor = |note: &Remark<Note>| match &note.kind {
        Note::Floor { reading, .. } => reading.replace(',', ".").parse::<f64>().ok(),
        _ => None,
    };
    let floor = table.notes.iter().find_map(floor);
    let at_floor = |m: f64| {
        ["m", "cm", "mm", "in", "ft"]
            .iter()
            .any(|unit| Unit::parse(unit).zip(floor).is_some_and(|(unit, reads)| (unit.si(reads) - m).abs() < SAME))
    };
    let met = |m: &f64| own().any(|h| h == *m) || at_floor(*m);
    let sentence = title.length.as_ref().filter(|(_, _, lengths)| !lengths.iter().all(met));
    let near = |drop: f64| own().any(|h| (h / drop - 1.0).abs() < NOMINAL);
    let metres = !table.metadata.ratios && !table.metadata.pixels;
    let other = |drop: f64| metres && own().next().is_some() && !near(drop);
    let drop = title.drop.as_ref().filter(|(drop, _)| other(drop.metres()));
    let sentence = sentence.map(|(text, line, _)| Doubt::Length { text: text.clone(), line: *line });
    sentence.or_else(|| drop.map(|(drop, line)| Doubt::Length { text: drop.text.clone(), line: *line }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slip or an abbreviation of what was worked out is none in a sentence; one of what was
    /// predicted is.
    #[test]
    fn texts_that_name_no_readings() {
        for text in ["Prediction", "Calculated heights", "Ratio of the heights", "predcted heights"] {
            assert!(names_no_readings(text), "{text}");
        }
        for text in ["slo-mo", "different heights", "Data", "Wood", "measured"] {
            assert!(!names_no_readings(text), "{text}");
        }
    }
}
