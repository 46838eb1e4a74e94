//! What the columns of a table are: a heading alone says much, its neighbours and its cells the
//! rest.

mod conditions;
mod coordinates;
mod energies;
mod faults;
mod frames;
mod gates;
mod pairs;
mod shares;
mod signals;
mod specimens;

use shares::of_hundredths;
pub(super) use shares::{either, falling, level};

use std::collections::HashSet;

use super::ReadOptions;
use super::answers::answers;
use super::aside::{LeftAside, Part, Why};
use super::cell::dated;
use super::clause;
use super::grid::shown;
use super::heading::{At, Heading, Meaning, Role, Value, What};
use super::named::event;
use super::region::Region;
use super::stamps::of_samples;
use super::units::{Dimension, Scale, Unit};
use super::vocabulary::Atom;
use crate::error::TableError;
use crate::finding::{Doubt, Note, Warning};

/// What a column is for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// The number of the bounce; `sure` if the heading says so.
    Number {
        sure: bool,
    },
    /// What happened.
    Event,
    /// Tells trials apart.
    Trial,
    /// Tells balls, surfaces, conditions apart.
    Setting,
    /// A count of frames.
    Frame,
    /// Names its row as a heading names a column.
    Label,
    Value(Value),
    /// The errors of the readings in another column.
    Error(usize),
    /// The upper ends of ranges whose lower ends stand in another column.
    High(usize),
    /// When what another column lists the begins of ends.
    Ends(usize),
    /// How much lower the rebound is than the release.
    Lost,
    /// The part of its drop's height to which a rebound rises.
    Share,
    /// Not used.
    Aside,
}

/// A column.
#[derive(Clone, Debug)]
pub(super) struct Column {
    pub(super) kind: Kind,
    pub(super) heading: Heading,
    /// The unit of its numbers; none where each names its own.
    pub(super) unit: Option<Unit>,
    /// What its scale reads at the floor, and which way it counts.
    pub(super) zero: f64,
    pub(super) sign: f64,
    /// Its numbers are turned over: the longer, the slower.
    pub(super) turned: bool,
}

impl Column {
    pub(super) fn value(&self) -> Option<&Value> {
        match &self.kind {
            Kind::Value(value) => Some(value),
            _ => None,
        }
    }

    /// Whether its numbers are hundredths.
    pub(in crate::read) fn of_hundredths(&self) -> bool {
        self.heading.has(Atom::Percent) || self.unit.is_some_and(|unit| unit.scale == Scale::Percent)
    }

    /// Whether the column holds readings of this quantity.
    pub(super) fn holds(&self, what: What) -> bool {
        self.value().is_some_and(|value| value.what == what)
    }
}

/// The columns of a table and what was noted about them.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    pub(super) columns: Vec<Column>,
    pub(super) aside: Vec<LeftAside>,
    pub(super) notes: Vec<Note>,
    pub(super) warnings: Vec<Warning>,
    pub(super) doubts: Vec<Doubt>,
    /// Heights have no scale: only their ratios mean anything.
    pub(super) unscaled: bool,
}

impl Columns {
    /// What the names of the columns say of them, and what they are beside one another; `released`
    /// where a height of release is stated.
    pub(super) fn named(region: &Region<'_>, options: &ReadOptions, released: bool) -> Result<Self, TableError> {
        let mut found = Self {
            columns: Vec::new(),
            aside: Vec::new(),
            notes: Vec::new(),
            warnings: Vec::new(),
            doubts: Vec::new(),
            unscaled: false,
        };
        for (index, text) in region.header.iter().enumerate() {
            let heading = Heading::beside(text, &region.header).unwrap_or_else(|| Heading::parse(text));
            found.push(if heading.unit.is_none() && of_hundredths(region, index) {
                heading.hundredths()
            } else {
                heading
            });
        }
        found.specimens(region);
        found.states(region);
        found.signed(region);
        found.capitals(region);
        found.enumerated();
        found.of_one_name();
        found.spans(region);
        found.counted(region);
        found.measured(region);
        found.sampled(region);
        found.counting(region);
        found.naming(region);
        found.spanning(region);
        found.placed();
        found.flown();
        found.sped(region);
        found.coupled(region);
        found.deltas(region);
        found.capital(region);
        found.letters();
        found.room(region);
        found.unnamed(region)?;
        found.groups(region, options)?;
        found.chosen(region, options)?;
        found.shares(region);
        found.energies(region);
        found.one_sided();
        found.spanned();
        found.siblings(region);
        found.lacking(region, released);
        found.not_understood(region)?;
        found.sided(region);
        found.drops(region);
        found.summed();
        found.statistics(region, released)?;
        found.paired(region)?;
        found.namesakes(region, released);
        found.repeats(region, released)?;
        Ok(found)
    }

    /// Gives the columns their quantities and units, by the rows that hold readings; `fps` is the
    /// frame rate, where one is known, and `any` what stands in for it.
    pub(super) fn measure(
        &mut self,
        region: &Region<'_>,
        options: &ReadOptions,
        (fps, any): (Option<f64>, Option<f64>),
    ) -> Result<(), TableError> {
        self.wordy(region);
        self.stamped(region);
        self.respelt(region);
        self.vertical(region);
        self.infer(region, options)?;
        self.signals(region, options);
        self.released(region);
        self.frames(region, fps, any)?;
        self.clocks(region);
        self.scales(region, options)?;
        self.unique(region)?;
        let bare = |c: &Column| c.unit.is_some_and(Unit::unscaled);
        self.unscaled = self.columns.iter().any(|c| (c.holds(What::Height) || c.holds(What::Speed)) && bare(c))
            || self.one(&Kind::Share).is_some() && !self.any(What::Height, Some(At::Release));
        for column in self.columns.iter_mut().filter(|c| c.holds(What::Height)) {
            column.zero = options.zero.unwrap_or(0.0);
            column.sign = if options.down == Some(true) { -1.0 } else { 1.0 };
        }
        Ok(())
    }

    fn push(&mut self, mut heading: Heading) {
        if clause::names_rate(&heading.text) {
            (heading.unknown, heading.meaning) = (Vec::new(), Meaning::Aside(Why::Other));
        }
        for (written, meant) in &heading.misspelt {
            self.notes.push(Note::Misspelt {
                written: shown(written),
                heading: shown(&heading.text),
                meant: meant.to_string(),
            });
        }
        let kind = match &heading.meaning {
            Meaning::Number { sure } => Kind::Number { sure: *sure },
            Meaning::Event => Kind::Event,
            Meaning::Trial => Kind::Trial,
            Meaning::Setting => Kind::Setting,
            Meaning::Frame => Kind::Frame,
            Meaning::Value(value) => Kind::Value(value.clone()),
            Meaning::Aside(why) => {
                if heading.unknown.is_empty() {
                    self.aside.push(LeftAside::new(Part::Column, shown(&heading.text), *why));
                }
                Kind::Aside
            }
            Meaning::Empty => Kind::Aside,
        };
        self.columns.push(Column { kind, unit: heading.unit, heading, zero: 0.0, sign: 1.0, turned: false });
    }

    /// The indices of all columns of a kind.
    pub(super) fn all<'a>(&'a self, kind: &'a Kind) -> impl Iterator<Item = usize> + 'a {
        self.columns.iter().enumerate().filter(move |(_, c)| c.kind == *kind).map(|(n, _)| n)
    }

    /// The index of the column of a kind.
    pub(super) fn one(&self, kind: &Kind) -> Option<usize> {
        self.all(kind).next()
    }

    /// The column that numbers the bounces, and whether it says so.
    pub(super) fn number(&self) -> Option<(usize, bool)> {
        self.columns.iter().enumerate().find_map(|(n, c)| match c.kind {
            Kind::Number { sure } => Some((n, sure)),
            _ => None,
        })
    }

    /// The columns of readings.
    pub(super) fn values(&self) -> impl Iterator<Item = (usize, &Column, &Value)> {
        self.columns.iter().enumerate().filter_map(|(n, c)| c.value().map(|value| (n, c, value)))
    }

    /// Whether a column of readings is of this quantity, and at this event if one is asked for.
    pub(super) fn any(&self, what: What, at: Option<At>) -> bool {
        self.values().any(|(_, _, v)| v.what == what && v.role != Role::Error && at.is_none_or(|at| v.at == at))
    }

    /// Leaves a column aside.
    pub(super) fn leave(&mut self, index: usize, why: Why) {
        self.columns[index].kind = Kind::Aside;
        self.aside.push(LeftAside::new(Part::Column, shown(&self.columns[index].heading.text), why));
    }

    /// What is written in words beside readings is none: the date of a form is a remark, and what a
    /// ball or a surface names tells them apart, `Tennis ball` above `new` and `old`.
    fn wordy(&mut self, region: &Region<'_>) {
        let number = |row: usize, n: usize| region.view.is_number(row, n) && dated(region.cell(row, n)).is_none();
        let stamps = |n: usize| region.rows.iter().map(move |&row| region.cell(row, n));
        let numbers = |n: usize| region.rows.iter().any(|&row| number(row, n)) || of_samples(stamps(n));
        let words = |n: usize| region.rows.iter().any(|&row| !region.view.cell(row, n).is_empty());
        let (read, wordy): (Vec<usize>, Vec<usize>) = self.values().map(|(n, _, _)| n).partition(|n| numbers(*n));
        for index in wordy.into_iter().filter(|n| !read.is_empty() && words(*n)) {
            self.cornered(index, &read);
            let heading = &self.columns[index].heading;
            // So does a place that words name, `Ort`, of several rows each.
            let places = || {
                let cells: Vec<&str> = region.rows.iter().map(|&row| region.cell(row, index)).collect();
                let apart: HashSet<&str> = cells.iter().copied().collect();
                apart.len() > 1
                    && 2 * apart.len() <= cells.len()
                    && !cells.iter().any(|c| c.is_empty() || event(c).is_some())
            };
            let place = heading.has(Atom::Position) && heading.unit.is_none() && places();
            // What only answers yes or no is a remark, until the CORs differ by it.
            let asked = region.rows.iter().all(|&row| answers(region.cell(row, index)));
            if !asked && (heading.has(Atom::Group) || heading.has(Atom::Label) || place) {
                self.columns[index].kind = Kind::Setting;
            } else {
                let dated = self.columns[index].holds(What::Time);
                self.leave(index, if dated { Why::Note } else { Why::Other });
            }
        }
    }

    /// A quantity with a unit above the names of rows is that of the columns beside them which bear
    /// none: `Height (cm), h0, h1` above `Drop 1`.
    fn cornered(&mut self, corner: usize, beside: &[usize]) {
        let Some((of, unit)) = self.columns[corner].value().map(|v| v.what).zip(self.columns[corner].unit) else {
            return;
        };
        for &index in beside {
            let column = &mut self.columns[index];
            if let Kind::Value(value) = &mut column.kind
                && column.unit.is_none()
                && (value.what == of || value.what == What::Unsaid)
            {
                (value.what, column.unit) = (of, Some(unit));
            }
        }
    }

    /// Columns that were asked to tell balls or surfaces apart.
    fn groups(&mut self, region: &Region<'_>, options: &ReadOptions) -> Result<(), TableError> {
        for name in options.groups.iter().map(|name| name.trim()) {
            if matches!(name, "-" | "none") {
                for column in &mut self.columns {
                    let key = column.heading.value().is_none()
                        && (column.kind == Kind::Setting || !column.heading.unknown.is_empty());
                    if key {
                        column.heading.unknown.clear();
                        column.kind = Kind::Aside;
                        self.aside.push(LeftAside::new(Part::Column, shown(&column.heading.text), Why::NotChosen));
                    }
                }
                continue;
            }
            let Some(index) = self.columns.iter().position(|c| c.heading.text.eq_ignore_ascii_case(name)) else {
                // It may name a column of another sheet.
                if options.groups.len() == 1 && !region.chosen {
                    return Err(region
                        .error(format!("there is no column '{}' to tell groups apart", shown(name)))
                        .help(format!("the table has {}", region.header.join(", "))));
                }
                continue;
            };
            let column = &mut self.columns[index];
            let words: Vec<String> = column.heading.unknown.drain(..).collect();
            column.kind = match column.heading.unit.map(|unit| unit.dimension) {
                Some(Dimension::Length | Dimension::Time) => {
                    let what = if column.unit.is_some_and(|u| u.dimension == Dimension::Time) {
                        What::Time
                    } else {
                        What::Height
                    };
                    let group = if words.is_empty() { column.heading.text.clone() } else { words.join(" ") };
                    let value = column.heading.value().cloned();
                    Kind::Value(Value { group, ..value.unwrap_or(Value::of(what)) })
                }
                _ => {
                    // Whether its values repeat or not.
                    column.heading.unit = None;
                    Kind::Setting
                }
            };
        }
        Ok(())
    }

    /// The column that was asked for, whatever its words; others of its kind are left aside.
    fn chosen(&mut self, region: &Region<'_>, options: &ReadOptions) -> Result<(), TableError> {
        let Some(name) = options.column.as_deref().map(str::trim).filter(|_| !region.chosen) else { return Ok(()) };
        let is = |c: &Column| {
            let labelled =
                c.value().is_some_and(|v| v.trial.eq_ignore_ascii_case(name) || v.group.eq_ignore_ascii_case(name));
            c.heading.text.eq_ignore_ascii_case(name) || labelled && !name.is_empty()
        };
        let chosen: Vec<usize> = (0..self.columns.len()).filter(|&n| is(&self.columns[n])).collect();
        let Some(&first) = chosen.first() else {
            return Err(region
                .error(format!("there is no column '{}' to choose", shown(name)))
                .help(format!("the table has {}", region.header.join(", "))));
        };
        if let [_, second, ..] = chosen.as_slice()
            && self.columns[first].heading.text == self.columns[*second].heading.text
        {
            return Err(region
                .header_error(*second, format!("two columns are named '{}'", shown(name)))
                .help("give names by --header, '-' for a column to leave aside"));
        }
        for &index in &chosen {
            let column = &mut self.columns[index];
            column.heading.unknown.clear();
            let what = match column.unit.map(|unit| unit.dimension) {
                Some(Dimension::Time) => What::Time,
                Some(Dimension::Speed) => What::Speed,
                Some(Dimension::Length) => What::Height,
                _ => What::Unsaid,
            };
            let value = column.value().cloned().unwrap_or(Value::of(what));
            column.kind = Kind::Value(Value { role: Role::Reading, ..value });
            let name = shown(&column.heading.text);
            self.aside.retain(|aside| aside.name != name);
        }
        let Some(value) = self.columns[first].value().cloned() else { return Ok(()) };
        let same =
            |v: &Value| (v.what == value.what || v.what == What::Unsaid) && v.at == value.at && v.role != Role::Error;
        let others: Vec<usize> =
            self.values().filter(|(n, _, v)| !chosen.contains(n) && same(v)).map(|(n, _, _)| n).collect();
        for index in others {
            self.columns[index].heading.unknown.clear();
            self.leave(index, Why::NotChosen);
        }
        Ok(())
    }

    /// Two columns of the same readings are a question, unless they say the same.
    fn unique(&mut self, region: &Region<'_>) -> Result<(), TableError> {
        for kind in [Kind::Event, Kind::Number { sure: true }] {
            if let Some(second) = self.all(&kind).nth(1) {
                let name = shown(&self.columns[second].heading.text);
                let message = format!("'{name}' means the same as a column before it");
                return Err(region
                    .header_error(second, message)
                    .question()
                    .help("keep one of the two, or give names by --header"));
            }
        }
        self.unique_shares(region)?;
        self.hundredths_of_repeats();
        let mut seen: Vec<(usize, Value)> = Vec::new();
        let values: Vec<(usize, Value)> = self.values().map(|(n, _, v)| (n, v.clone())).collect();
        for (index, value) in values {
            // The name of a ball that only one of them bears does not part a place on a scale
            // from a height above the floor.
            let named = |v: &Value| !(v.trial.is_empty() && v.group.is_empty());
            let apart = |v: &Value| named(v) == named(&value) || v.position == value.position;
            let same = |n: usize, v: &Value| {
                // A name that one of two bears, of a ball or of who read it, does not tell them
                // apart: `old height`, `height`.
                let person =
                    |n: usize| self.columns[n].heading.has(Atom::Repeat) && !self.columns[n].heading.has(Atom::Trial);
                let read_by = (v.trial.is_empty() != value.trial.is_empty()) && (person(n) || person(index));
                let bare = v.group.is_empty() != value.group.is_empty() || read_by;
                let alike = (&v.trial, &v.group) == (&value.trial, &value.group) || bare || !apart(v);
                (v.what, v.at) == (value.what, value.at) && alike
            };
            let Some((before, _)) = seen.iter().find(|(n, v)| same(*n, v)) else {
                seen.push((index, value));
                continue;
            };
            // Hundredths beside heights follow from them.
            let percent = |n: usize| self.columns[n].of_hundredths();
            if percent(index) != percent(*before) && value.what == What::Height {
                let first = *before;
                if percent(index) {
                    self.leave(index, Why::Derived);
                } else {
                    seen.retain(|(n, _)| *n != first);
                    seen.push((index, value));
                    self.leave(first, Why::Derived);
                }
                continue;
            }
            if let Some(coarser) = self.alike(region, *before, index) {
                if coarser != index {
                    let first = *before;
                    seen.retain(|(n, _)| *n != first);
                    seen.push((index, value));
                }
                self.leave(coarser, Why::Elsewhere);
                continue;
            }
            // A distance from above and the height that it leaves add up to the same in every row.
            let distance = |n: usize| self.columns[n].heading.has(Atom::Distance);
            let (first, of) = (*before, distance(index));
            if of != distance(first) && self.add_up_to_one(region, first, index) {
                if !of {
                    seen.retain(|(n, _)| *n != first);
                    seen.push((index, value));
                }
                self.leave(if of { index } else { first }, Why::Elsewhere);
                continue;
            }
            // Of the places of a film one axis may lie still.
            let (first, still) = (*before, |n: usize| value.position && region.constant(n));
            if still(index) || still(first) {
                if !still(index) {
                    seen.push((index, value.clone()));
                    seen.retain(|(n, _)| *n != first);
                }
                self.leave(if still(index) { index } else { first }, Why::Still);
                continue;
            }
            let name = |n: usize| shown(&self.columns[n].heading.text);
            let message = if name(*before) == name(index) {
                format!("two columns are named '{}'", name(index))
            } else {
                format!("'{}' and '{}' hold the same quantity: which one is meant?", name(*before), name(index))
            };
            return Err(region.header_error(index, message).question().help(format!(
                "choose one by --column '{}'; balls side by side are told apart by --group '{},{}', trials by names such as 'trial 1 (cm)' (--header)",
                name(*before),
                name(*before),
                name(index)
            )));
        }
        Ok(())
    }
}
