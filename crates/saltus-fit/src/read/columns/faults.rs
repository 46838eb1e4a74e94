//! Columns whose headings are not understood: what is left aside, and what is an error.

use std::collections::{HashMap, HashSet};

use super::{Column, Columns, Kind, level};
use crate::error::TableError;
use crate::finding::Doubt;
use crate::read::Event;
use crate::read::answers::answers;
use crate::read::aside::{LeftAside, Part, Why};
use crate::read::cell::{Cell, read};
use crate::read::grid::shown;
use crate::read::heading::{At, Heading, Meaning, Role, Value, What};
use crate::read::named::event;
use crate::read::region::Region;
use crate::read::units::Dimension;
use crate::read::vocabulary::{Atom, folded, nearest};
use crate::read::words::{ARTICLE, Kind as WordKind, Word, split};

/// A column that names a ball or a surface, and what its heading says beside that.
struct Named {
    index: usize,
    rest: String,
    value: Value,
    kind: Kind,
}

impl Columns {
    /// Columns without a name: of row names, of a plain count, or of something that is left aside.
    pub(super) fn unnamed(&mut self, region: &Region<'_>) -> Result<(), TableError> {
        let named = region.header.len();
        let widest = region.rows.iter().map(|&row| region.view.width(row)).max().unwrap_or(0);
        for row in region.rows.iter().filter(|&&row| region.view.width(row) > named) {
            let extra = (named..region.view.width(*row)).find(|&c| region.view.is_number(*row, c));
            if let Some(extra) = extra.filter(|_| region.view.grid.comma() || region.given) {
                let names = if named == 1 { "1 column".to_owned() } else { format!("{named} columns") };
                let help = if region.view.grid.comma() {
                    "give every column a name in the header; if the comma is a decimal comma, separate cells by semicolons"
                } else {
                    "give every column a name in the header"
                };
                let message = format!("this row has {} cells, but the header names {names}", region.view.width(*row));
                return Err(region.view.error(*row, extra, message).help(help));
            }
        }
        if region.chosen || region.given || !region.label.is_empty() {
            return Ok(());
        }
        let first = self.columns.iter().position(|c| c.value().is_some()).unwrap_or(0);
        let keyed = self
            .columns
            .iter()
            .any(|c| matches!(c.kind, Kind::Number { .. } | Kind::Event | Kind::Trial | Kind::Frame));
        while self.columns.len() < widest {
            self.push(Heading::parse(""));
        }
        for index in 0..self.columns.len() {
            if !self.columns[index].heading.text.is_empty() {
                continue;
            }
            let cells = || region.rows.iter().map(|&row| region.cell(row, index)).filter(|cell| !cell.is_empty());
            if cells().next().is_none() {
                continue;
            }
            let counted = cells().all(|cell| cell.parse::<usize>().is_ok());
            self.columns[index].kind = match () {
                () if index < first && !keyed && counted => Kind::Number { sure: false },
                () if index < first && !counted => Kind::Label,
                () => {
                    let name = cells().next().map(shown).unwrap_or_default();
                    self.aside.push(LeftAside::new(Part::Column, name, Why::Unnamed));
                    Kind::Aside
                }
            };
        }
        Ok(())
    }

    /// Columns of which a word is not understood, where none that is understood holds what they do,
    /// are read and doubted; several are distinguished by those words.
    pub(super) fn lacking(&mut self, region: &Region<'_>, released: bool) {
        if region.given || region.chosen {
            return;
        }
        let reads = |v: &Value| !matches!(v.role, Role::Error | Role::Lost);
        let of = |c: &Column, release: bool| c.value().is_some_and(|v| reads(v) && (v.at == At::Release) == release);
        let known = [false, true].map(|release| {
            self.columns.iter().any(|c| c.heading.unknown.is_empty() && of(c, release)) || release && released
        });
        let counted = self.columns.iter().any(|c| matches!(c.kind, Kind::Number { .. } | Kind::Event | Kind::Frame));
        let bounces = known[1] || self.number().is_some_and(|(_, sure)| sure);
        for release in [false, true] {
            // Where bounces are counted, none need be the release.
            if known[usize::from(release)] || release && (counted || !known[0]) {
                continue;
            }
            // What bears no unit may be called in one that is not known.
            let numbers = |n: usize| {
                let unit = self.columns[n].unit.or(region.units.1).is_some();
                let measured = |cell: Cell| matches!(cell, Cell::Number(m) if unit || m.unit.is_some());
                region.rows.iter().any(|&row| measured(region.view.read(row, n)))
            };
            let open = |n: &usize| {
                let column = &self.columns[*n];
                let what = column.value().is_some_and(|v| v.role == Role::Reading && v.what != What::Unsaid);
                what && !column.heading.unknown.is_empty()
                    && !column.heading.turns()
                    && of(column, release)
                    && numbers(*n)
            };
            let found: Vec<usize> = (0..self.columns.len()).filter(open).collect();
            // One by itself says that it is of a bounce, or a height; of several the table does.
            let says = |n: &usize| {
                let named = [Atom::Height, Atom::Rebound, Atom::Impact, Atom::Release, Atom::Top, Atom::Between];
                named.iter().any(|atom| self.columns[*n].heading.has(*atom))
            };
            if !(found.iter().all(says) || bounces && found.len() > 1) {
                return;
            }
            let kind = |n: usize| self.columns[n].value().map(|v| (v.what, v.at, v.drop.clone(), self.columns[n].unit));
            if found.iter().any(|&n| kind(n) != kind(found[0])) {
                return;
            }
            let words: Vec<String> = found.iter().map(|&n| self.columns[n].heading.unknown.join(" ")).collect();
            if words.iter().enumerate().any(|(n, word)| words[..n].contains(word)) {
                return;
            }
            // A letter names a trial or a ball, and turns no meaning: trials where they are level.
            let several = found.len() > 1;
            let letters = words.iter().all(|word| word.chars().count() == 1 && (several || word == "A"));
            let drop =
                self.values().find(|(_, _, v)| v.at == At::Release && v.role == Role::Reading).map(|(n, _, _)| n);
            let turned: Vec<usize> = found.iter().rev().copied().collect();
            let trials = several && letters && [&found, &turned].iter().all(|nth| level(region, drop, nth, false));
            for (&index, word) in found.iter().zip(words) {
                let column = &mut self.columns[index];
                column.heading.unknown.clear();
                if let (Kind::Value(value), true) = (&mut column.kind, several) {
                    let name = if trials { &mut value.trial } else { &mut value.group };
                    *name = [name.as_str(), &word].join(" ").trim().to_owned();
                }
                if letters {
                    continue;
                }
                self.doubts.push(Doubt::Word { column: shown(&column.heading.text), word: shown(&word) });
            }
        }
    }

    /// Of columns under one name that spans them all it says what they hold, and what stands before
    /// it names the ball or the surface of each: `1 month, rebound`, `new, rebound`.
    pub(super) fn spanned(&mut self) {
        let parts: Vec<Option<(String, String)>> = self
            .columns
            .iter()
            .map(|c| c.heading.text.split_once(", ").map(|(head, words)| (head.to_owned(), words.to_owned())))
            .collect();
        let shared = |words: &str| parts.iter().flatten().filter(|(_, other)| other == words).count() > 1;
        let names = |c: &Column| !c.heading.unknown.is_empty() || c.value().is_some_and(|v| !v.group.is_empty());
        for (column, part) in self.columns.iter_mut().zip(&parts) {
            let Some((head, words)) = part.as_ref().filter(|(_, words)| shared(words) && names(column)) else {
                continue;
            };
            let above = Heading::parse(words);
            let value = above.value().filter(|v| v.role == Role::Reading && v.what != What::Unsaid);
            if let Some(value) = value.filter(|_| above.unknown.is_empty()) {
                let value = Value { group: head.clone(), ..value.clone() };
                column.kind = Kind::Value(value.clone());
                column.heading.meaning = Meaning::Value(value);
                column.heading.unit = above.unit;
                column.heading.unknown.clear();
            }
        }
    }

    /// Columns called as two others are but for words that name a ball or a surface in those: they
    /// name one here as well, `Rebound zorb (cm)` beside `Rebound golf (cm)`; and so does a name by
    /// itself beside those, where the cells are numbers as theirs are.
    pub(super) fn siblings(&mut self, region: &Region<'_>) {
        let without = |text: &str, name: &str| text.replacen(name, "", 1).split_whitespace().collect::<String>();
        // What stands between the words of a name is part of it: `minge de handbal`.
        let bare = |text: &str, group: &str| {
            let article =
                |w: &Word| matches!(w.kind, WordKind::Known([Atom::Filler])) && w.text.chars().count() < ARTICLE;
            let within = |w: &Word| group.split(' ').any(|part| part == w.text);
            let whole = !text.contains(group) && split(text).iter().all(|w| within(w) || article(w));
            if whole { String::new() } else { without(text, group) }
        };
        let of = |c: &Column| c.value().or_else(|| c.heading.value().filter(|_| c.kind == Kind::Share)).cloned();
        let mut named: Vec<Named> = (0..)
            .zip(&self.columns)
            .filter(|(_, c)| c.heading.unknown.is_empty())
            .filter_map(|(index, c)| Some((index, c, of(c)?)))
            .filter(|(_, _, v)| !v.group.is_empty() && v.role == Role::Reading)
            .map(|(index, c, value)| Named {
                index,
                rest: bare(&c.heading.text, &value.group),
                value,
                kind: c.kind.clone(),
            })
            .collect();
        // One alone may be named by chance, where its heading says something else too.
        let several = |one: &Named| {
            let other = |other: &Named| other.rest == one.rest && other.value.group != one.value.group;
            one.rest.is_empty() || named.iter().any(other)
        };
        if !named.iter().any(several) {
            return;
        }
        let cell = |row: usize, n: usize| match region.view.read(row, n) {
            Cell::Number(m) => Some(m.unit),
            _ => None,
        };
        for index in 0..self.columns.len() {
            let heading = &self.columns[index].heading;
            // All of a heading that says nothing else is a name.
            let plain = |v: &Value| v.what == What::Unsaid && v.at == At::Row && v.role == Role::Reading;
            let whole = heading.value().is_none_or(plain) && heading.unit.is_none();
            let name = if whole { heading.text.clone() } else { heading.unknown.join(" ") };
            if heading.unknown.is_empty() || !heading.text.contains(&name) {
                continue;
            }
            let rest = without(&heading.text, &name);
            let same = |one: &&Named| {
                let of_one = |v: &Value| (v.what, v.at, v.role) == (one.value.what, one.value.at, one.value.role);
                let units = || region.rows.iter().filter_map(|&row| cell(row, one.index).map(|unit| (row, unit)));
                let between = |n: usize| n.min(index) + 1..n.max(index);
                let next = |n: usize| self.columns[between(n)].iter().all(|c| c.heading.text.is_empty());
                let beside = || named.iter().any(|n| next(n.index));
                let own = |row: usize| region.view.is_number(row, index).then(|| cell(row, index));
                let alike = || units().all(|(row, unit)| own(row).is_none_or(|own| own == Some(unit)));
                let filled = || 2 * units().filter(|(row, _)| own(*row).is_some()).count() > units().count();
                let bare = || whole && beside() && units().nth(1).is_some() && alike() && filled();
                one.rest == rest && heading.value().filter(|_| !whole).map_or_else(bare, of_one)
            };
            if let Some(Named { value, kind, .. }) = named.iter().find(same) {
                let (value, kind) = (Value { group: name, ..value.clone() }, kind.clone());
                let column = &mut self.columns[index];
                column.kind = if kind == Kind::Share { Kind::Share } else { Kind::Value(value.clone()) };
                column.heading.meaning = Meaning::Value(value.clone());
                column.heading.unknown.clear();
                named.push(Named { index, rest, value, kind });
            }
        }
    }

    /// Columns whose words are not understood: left aside, unless their cells may tell balls or
    /// surfaces apart.
    pub(super) fn not_understood(&mut self, region: &Region<'_>) -> Result<(), TableError> {
        for index in 0..self.columns.len() {
            let heading = &self.columns[index].heading;
            let Some(word) = heading.unknown.first().cloned() else { continue };
            if region.given {
                return Err(self.unknown(region, index, &word));
            }
            // The unit says that it is a condition.
            if self.columns[index].kind == Kind::Setting && heading.unit.is_some() {
                self.columns[index].heading.unknown.clear();
                continue;
            }
            let cells: Vec<&str> = region.rows.iter().map(|&row| region.cell(row, index)).collect();
            let events = cells.iter().filter_map(|cell| event(cell));
            let (release, impact) =
                (events.clone().any(|e| e == Event::Release), events.clone().any(|e| e == Event::Contact));
            // What happened, whatever stands above it.
            if events.count() == cells.len() && release && impact && self.one(&Kind::Event).is_none() {
                (self.columns[index].kind, self.columns[index].heading.unknown) = (Kind::Event, Vec::new());
                continue;
            }
            // Codes that are another in each row are of what was dropped.
            if heading.value().is_none() && region.codes(index).is_some() {
                self.leave(index, Why::Note);
                self.columns[index].heading.unknown.clear();
                continue;
            }
            // A name of a number that counts the rows is that, whatever else it says.
            if let Meaning::Number { sure } = heading.meaning
                && self.columns.iter().enumerate().all(|(n, c)| n == index || !matches!(c.kind, Kind::Number { .. }))
                && region.counts(index)
            {
                (self.columns[index].kind, self.columns[index].heading.unknown) = (Kind::Number { sure }, Vec::new());
                continue;
            }
            // Balls and surfaces tell rows apart, whatever stands above them.
            let labels = |cell: &&str| {
                let named = Heading::parse(cell);
                named.unknown.is_empty() && !named.labels().is_empty() && named.value().is_none()
            };
            let mut named = cells.iter().filter(|cell| !cell.is_empty()).peekable();
            if self.columns[index].value().is_none() && named.peek().is_some() && named.all(labels) {
                (self.columns[index].kind, self.columns[index].heading.unknown) = (Kind::Setting, Vec::new());
                continue;
            }
            let words = cells.iter().filter(|cell| !cell.is_empty()).all(|cell| read(cell, false) == Cell::Words);
            let filled = cells.iter().filter(|cell| !cell.is_empty()).count();
            let differ = cells.iter().any(|cell| *cell != cells[0]);
            let apart = cells.iter().collect::<HashSet<_>>().len();
            let values = self.columns.iter().filter(|c| c.value().is_some() && c.heading.unknown.is_empty()).count();
            if words
                && filled > 1
                && filled == cells.len()
                && differ
                && values > 0
                && self.columns[index].value().is_none()
            {
                // What names every event alike says again what happened.
                if self.of_events(region, index) {
                    self.leave(index, Why::NotUnderstood);
                    continue;
                }
                // What only answers yes or no is a remark, until the CORs differ by it.
                if cells.iter().all(|cell| answers(cell)) {
                    self.leave(index, Why::NotUnderstood);
                    continue;
                }
                // Words that come again tell rows apart, whatever stands above them.
                if 2 * apart <= cells.len() {
                    (self.columns[index].kind, self.columns[index].heading.unknown) = (Kind::Setting, Vec::new());
                    continue;
                }
                // Who did it tells none apart.
                if self.columns[index].heading.has(Atom::Repeat) {
                    self.leave(index, Why::NotUnderstood);
                    continue;
                }
                let name = shown(&self.columns[index].heading.text);
                return Err(region
                    .header_error(
                        index,
                        format!(
                            "does '{name}' tell balls or surfaces apart? The word '{}' is not understood",
                            shown(&word)
                        ),
                    )
                    .question()
                    .help(format!(
                        "give --group '{name}' if it does, and each has a COR of its own; --group - if not"
                    )));
            }
            self.leave(index, Why::NotUnderstood);
        }
        let keyed = [Kind::Frame, Kind::Share].iter().any(|kind| self.one(kind).is_some());
        if self.values().next().is_none() && !keyed && !region.chosen {
            return Err(self.nothing(region));
        }
        Ok(())
    }

    /// Whether all rows of an event bear the same word, of several events beside each other.
    fn of_events(&self, region: &Region<'_>, index: usize) -> bool {
        let Some(named) = self.one(&Kind::Event) else { return false };
        let mut words: HashMap<Option<Event>, &str> = HashMap::new();
        let alike = |&row: &usize| {
            let word = region.cell(row, index);
            *words.entry(event(region.cell(row, named))).or_insert(word) == word
        };
        region.rows.iter().all(alike) && words.len() > 1
    }

    /// No column is of use: why not, at the one that comes nearest.
    pub(super) fn nothing(&self, region: &Region<'_>) -> TableError {
        if let Some(error) = self.several(region) {
            return error;
        }
        let near = |c: &Column| !c.heading.unknown.is_empty() && !matches!(c.heading.meaning, Meaning::Empty);
        // Words below a name are of no reading.
        let position = |fits: &dyn Fn(&Column) -> bool| {
            let mut found = self.columns.iter().enumerate().filter(|(_, c)| fits(c)).map(|(n, _)| n);
            let first = found.clone().next();
            found.find(|&n| region.numbers(n).next().is_some()).or(first)
        };
        let index = position(&|c| near(c) && c.heading.value().is_some());
        let index = index.or_else(|| position(&|c| !c.heading.unknown.is_empty()));
        if let Some((index, word)) = index.and_then(|n| Some((n, self.columns[n].heading.unknown.first()?.clone()))) {
            return self.unknown(region, index, &word);
        }
        let measured = |c: &Column| match () {
            () if c.heading.unit.is_none_or(|unit| unit.dimension != Dimension::Other) => None,
            () if c.heading.has(Atom::Height) => Some(Dimension::Length),
            () if c.heading.has(Atom::Time) => Some(Dimension::Time),
            () => None,
        };
        if let Some((index, dimension)) = (0..self.columns.len()).find_map(|n| Some((n, measured(&self.columns[n])?))) {
            return self.mismatch(region, index, dimension);
        }
        let left: Vec<String> = self.aside.iter().map(|aside| format!("'{}': {}", aside.name, aside.why)).collect();
        let left = if left.is_empty() { String::new() } else { format!("; left aside are {}", left.join(", ")) };
        let help = format!("name one, such as 'height_cm' or 'time_s'{left}");
        region.error("no column holds heights or times").nothing().help(help)
    }

    /// Several columns of readings that nothing in their names tells apart but words that are not
    /// understood: of persons, or of balls.
    fn several(&self, region: &Region<'_>) -> Option<TableError> {
        let unknown = |c: &&Column| {
            let unit = c.heading.unit.is_some_and(|u| matches!(u.dimension, Dimension::Length | Dimension::Time));
            unit && !c.heading.unknown.is_empty() && !c.heading.turns()
        };
        let names: Vec<String> = self.columns.iter().filter(unknown).map(|c| shown(&c.heading.text)).collect();
        let index = self.columns.iter().position(|c| unknown(&c)).filter(|_| names.len() > 1)?;
        let message = format!("what do '{}' tell apart?", names.join("', '"));
        Some(region.header_error(index, message).question().help(format!(
            "balls or surfaces: --group '{}'; trials: names such as 'trial 1 (cm)' by --header; one of them: --column '{}'",
            names.join(","),
            names[0]
        )))
    }

    /// The unit of a column is of something else than what it holds.
    pub(in crate::read) fn mismatch(&self, region: &Region<'_>, index: usize, dimension: Dimension) -> TableError {
        let name = shown(&self.columns[index].heading.text);
        let spelt =
            name.rsplit(['(', '[', '_', ' ', '/']).next().unwrap_or(&name).trim_end_matches([')', ']']).to_owned();
        region
            .header_error(index, format!("'{spelt}' in '{name}' is not a unit of {}", dimension.noun()))
            .help(format!("use one of {}", dimension.known()))
    }

    pub(in crate::read) fn unknown(&self, region: &Region<'_>, index: usize, word: &str) -> TableError {
        let heading = &self.columns[index].heading;
        let name = shown(&heading.text);
        if heading.text.trim().parse::<f64>().is_ok() {
            return region
                .header_error(index, format!("'{name}' is no name of a column: the first line has to name them"))
                .help("write such as 'bounce,height_cm' above the numbers, or give it by --header; readings stand below one another");
        }
        let last = heading.unit.is_none() && heading.text.trim_end_matches([')', ']']).ends_with(word);
        if let Some(dimension) = heading.value().and_then(|v| v.what.dimension()).filter(|_| last) {
            return region
                .header_error(
                    index,
                    format!("'{}' in '{name}' is not a unit of {} that is known", shown(word), dimension.noun()),
                )
                .question()
                .help(format!("known are {}; or choose it with --column '{name}' and a unit", dimension.known()));
        }
        let folded = folded(word);
        let hint = match nearest(&folded).map(|known| heading.text.to_lowercase().replace(&word.to_lowercase(), known))
        {
            Some(meant) => format!("did you mean '{meant}'? "),
            None => String::new(),
        };
        let column = if heading.value().is_some() {
            format!("the column '{name}' is not known: the word '{}' in it is not understood", shown(word))
        } else {
            format!("the column '{name}' is not known")
        };
        let error = region.header_error(index, column);
        let error = if heading.value().is_some() { error.question() } else { error.nothing() };
        error.help(format!(
            "{hint}use it with --column '{name}', or give names by --header, '-' for a column to leave aside; known are event, bounce, time_s, \
             height_cm, interval_s, time_error_s, height_error_cm, h0_cm, trial, ball, note and the like"
        ))
    }
}
