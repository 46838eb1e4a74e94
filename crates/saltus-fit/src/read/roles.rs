//! What part columns play beside one another: means and errors, repeats and bounces, clocks and
//! intervals; and their quantity and unit.

use std::collections::BTreeSet;

use super::ReadOptions;
use super::aside::Why;
use super::cell::{Cell, clock};
use super::columns::{Column, Columns, Kind, either, falling, level};
use super::grid::shown;
use super::heading::{At, Heading, Role, Value, What};
use super::region::Region;
use super::units::{Dimension, Scale, Unit};
use super::vocabulary::{Atom, folded};
use crate::error::TableError;
use crate::finding::Note;

impl Columns {
    /// `Drop` is the height of release beside trials; beside readings that say what they are it may
    /// only count, and then holds 1, 2, 3.
    pub(super) fn drops(&mut self, region: &Region<'_>) {
        let trials = self.values().any(|(_, _, v)| !v.trial.is_empty() || !v.group.is_empty());
        let rows = self.values().any(|(_, c, v)| !v.or_trial && v.at != At::Release && (c.unit.is_some() || !trials));
        for (index, column) in self.columns.iter_mut().enumerate() {
            // A letter behind a trial may be short for a number: `pokus č.`.
            let trial = |v: &Value| v.or_trial || v.what == What::Unsaid && !v.trial.is_empty() && v.at == At::Row;
            if rows && column.unit.is_none() && column.value().is_some_and(trial) && region.counts(index) {
                column.kind = Kind::Trial;
            }
        }
    }

    /// What sums up columns that bear no unit has theirs: `Trial 1,Trial 2,Average (in)`.
    pub(super) fn summed(&mut self) {
        let sums = |v: &Value| matches!(v.role, Role::Mean | Role::Max | Role::Min);
        let units: Vec<Unit> = self.values().filter(|(_, _, v)| sums(v)).filter_map(|(_, c, _)| c.unit).collect();
        let length = |unit: &&Unit| unit.dimension == Dimension::Length && units.iter().all(|other| other == *unit);
        let Some(unit) = units.first().filter(length).copied() else { return };
        let bare = |c: &Column, v: &Value| c.unit.is_none() && v.role == Role::Reading;
        let silent = |v: &Value| v.what == What::Unsaid && !v.trial.is_empty();
        if self.values().any(|(_, c, v)| v.role == Role::Reading && !(bare(c, v) && silent(v) || v.at == At::Release)) {
            return;
        }
        for column in &mut self.columns {
            if let Kind::Value(value) = &mut column.kind
                && column.unit.is_none()
                && value.role == Role::Reading
                && silent(value)
            {
                (value.what, column.unit) = (What::Height, Some(unit));
            }
        }
    }

    /// Means, errors, extremes and losses, each beside the readings it belongs to.
    pub(super) fn statistics(&mut self, region: &Region<'_>, released: bool) -> Result<(), TableError> {
        // A mean of seconds, `Average (s)`, is of any time.
        let timed = |c: &Column| [Atom::Time, Atom::Interval, Atom::Total].iter().any(|atom| c.heading.has(*atom));
        let said = |c: &Column, v: &Value| match (v.role, v.what) {
            (Role::Mean | Role::Max | Role::Min, What::Time) if !timed(c) => What::Unsaid,
            (_, what) => what,
        };
        let of = |(n, c, v): (usize, &Column, &Value)| (n, Value { what: said(c, v), ..v.clone() });
        let values: Vec<(usize, Value)> = self.values().map(of).collect();
        let same = |a: &Value, b: &Value| a.what == b.what || a.what == What::Unsaid || b.what == What::Unsaid;
        let placed = |a: &Value, b: &Value| (a.at == At::Release) == (b.at == At::Release);
        let role = |v: &Value, role: Role| v.role == role;
        // Hundredths follow from heights, and are none that a mean of heights sums up.
        let parts: Vec<bool> = self.columns.iter().map(Column::of_hundredths).collect();
        let beside = |index: usize, v: &Value| {
            let of = |n: usize, o: &Value| role(o, Role::Reading) && same(o, v) && (parts[index] || !parts[n]);
            values.iter().any(|(n, o)| of(*n, o) && (placed(o, v) || !o.trial.is_empty()))
        };
        // A mean stands for the readings between its extremes.
        let within = |v: &Value| values.iter().any(|(_, o)| role(o, Role::Mean) && same(o, v) && placed(o, v));
        let tops = self.of_tops();
        for (index, value) in &values {
            match value.role {
                Role::Max if tops && matches!(value.what, What::Time | What::Height) => self.read(*index),
                Role::Reading => {}
                Role::Mean | Role::Max | Role::Min if self.of_no_other(region, *index, &values) => self.read(*index),
                Role::Mean if beside(*index, value) => self.leave(*index, Why::Statistic),
                Role::Mean => self.read(*index),
                Role::Error => self.error(*index, value, &values),
                Role::Max | Role::Min => {
                    let other = if value.role == Role::Max { Role::Min } else { Role::Max };
                    let pair = values.iter().find(|(_, o)| role(o, other) && same(o, value) && o.at == value.at);
                    match pair {
                        _ if beside(*index, value) || within(value) => self.leave(*index, Why::Statistic),
                        Some((low, _)) if value.role == Role::Max => self.columns[*index].kind = Kind::High(*low),
                        Some(_) => self.read(*index),
                        // The greatest height between two bounces is that of the apex.
                        None if value.role == Role::Max && (self.of_bounces(*index) || self.highest(*index)) => {
                            self.read(*index);
                        }
                        None => return Err(self.extreme(region, *index)),
                    }
                }
                Role::Lost => {
                    let drop = values.iter().any(|(_, o)| role(o, Role::Reading) && o.at == At::Release);
                    if beside(*index, value) {
                        self.leave(*index, Why::Derived);
                    } else if drop && (!self.number().is_some_and(|(_, sure)| sure) || self.own_drops(region)) {
                        self.columns[*index].kind = Kind::Lost;
                    } else if released && self.of_bounces(*index) && self.add_up(region, *index) {
                        self.columns[*index].kind =
                            Kind::Value(Value { role: Role::Reading, at: At::Row, ..value.clone() });
                    } else {
                        let name = shown(&self.columns[*index].heading.text);
                        let message =
                            format!("'{name}' holds what was lost: which height did each bounce begin and end at?");
                        return Err(region
                            .header_error(*index, message)
                            .question()
                            .help("give the heights, or the drop height of each row beside what was lost of it"));
                    }
                }
            }
        }
        Ok(())
    }

    /// Whether a mean, or an extreme, that stands in every row is none of what stands beside it: of
    /// one number a row that is another, and of no rows that share it.
    fn of_no_other(&self, region: &Region<'_>, index: usize, values: &[(usize, Value)]) -> bool {
        let Some(own) = self.columns[index].value() else { return false };
        let reads = |v: &Value| v.role == Role::Reading && v.what == own.what;
        let mut beside = values.iter().filter(|(_, v)| reads(v) && (v.at == own.at || !v.trial.is_empty()));
        let (Some((other, reading)), None) = (beside.next(), beside.next()) else { return false };
        let number = |row: usize, column: usize| match region.view.read(row, column) {
            Cell::Number(m) => Some(m.value.to_bits()),
            _ => None,
        };
        let pairs: Vec<_> = region.rows.iter().map(|&row| (number(row, index), number(row, *other))).collect();
        let apart: BTreeSet<_> = pairs.iter().map(|(sum, _)| *sum).collect();
        let whole = pairs.len() > 1 && pairs.iter().all(|(sum, one)| sum.is_some() && one.is_some());
        // Places of a film have tops.
        let filmed = reading.position && (self.any(What::Time, Some(At::Row)) || self.one(&Kind::Frame).is_some());
        whole && !filmed && apart.len() == pairs.len() && pairs.iter().any(|(sum, one)| sum != one)
    }

    /// Whether the numbers of a column rise from row to row.
    fn add_up(&self, region: &Region<'_>, index: usize) -> bool {
        let numbers: Vec<f64> = region.numbers(index).collect();
        numbers.len() > 1 && numbers.windows(2).all(|pair| pair[1] > pair[0])
    }

    /// Losses that add up from bounce to bounce are how far below the release, at `drop`, the ball
    /// came to: a scale that counts downwards from there.
    pub(super) fn losses(&mut self, drop: Option<f64>) {
        let lost = |c: &&mut Column| c.heading.has(Atom::Lost) && c.holds(What::Height);
        for column in self.columns.iter_mut().filter(lost) {
            if let (Some(drop), Some(unit)) = (drop, column.unit) {
                (column.zero, column.sign) = (drop / unit.si(1.0), -1.0);
                let name = shown(&column.heading.text);
                self.notes.push(Note::Losses { column: name });
            }
        }
    }

    /// Whether the height of release is another in every row, so that each is a drop of its own.
    fn own_drops(&self, region: &Region<'_>) -> bool {
        let release = self.values().find(|(_, _, v)| v.at == At::Release && v.role == Role::Reading);
        release.is_some_and(|(n, _, _)| {
            let cells: BTreeSet<&str> = region.rows.iter().map(|&row| region.cell(row, n)).collect();
            cells.len() == region.rows.len() && !cells.contains("")
        })
    }

    /// Whether the rows are bounces, by the name that counts them or by that of the column itself:
    /// `after the n-th impact`.
    fn of_bounces(&self, index: usize) -> bool {
        let column = &self.columns[index];
        let nth = column.heading.place == Some(0) || matches!(column.value().map(|v| v.at), Some(At::Nth(_)));
        nth && column.heading.has(Atom::After) || self.number().is_some_and(|(_, sure)| sure)
    }

    /// Whether the greatest height that a column holds is that of a flight, and of no repeats: it
    /// is one after an impact, `max. height after the bounce`.
    fn highest(&self, index: usize) -> bool {
        let heading = &self.columns[index].heading;
        self.columns[index].holds(What::Height) && heading.has(Atom::After) && !heading.has(Atom::Trial)
    }

    /// A column that plays another part is that of the readings.
    fn read(&mut self, index: usize) {
        if let Kind::Value(value) = &mut self.columns[index].kind {
            value.role = Role::Reading;
        }
    }

    fn extreme(&self, region: &Region<'_>, index: usize) -> TableError {
        let name = shown(&self.columns[index].heading.text);
        region
            .header_error(index, format!("'{name}' holds the extremes of readings: may they stand for all?"))
            .question()
            .help(format!("choose them by --column '{name}', or give the readings, or both extremes"))
    }

    /// The errors of the nearest readings before them, else of the first of their quantity.
    fn error(&mut self, index: usize, error: &Value, values: &[(usize, Value)]) {
        let unit = self.columns[index].unit.map(|unit| unit.dimension);
        let fits = |(_, v): &&(usize, Value)| {
            let dimension = v.what.dimension();
            v.role != Role::Error
                && (error.trial.is_empty() || error.trial == v.trial)
                && (error.what == What::Unsaid || v.what == What::Unsaid || error.what.dimension() == dimension)
                && (unit.is_none() || dimension.is_none() || unit == dimension)
        };
        let before = values.iter().rev().filter(|(n, _)| *n < index).find(fits);
        let named = values.iter().filter(|(_, v)| error.at != At::Row && v.at == error.at).find(fits);
        let percent = |n: usize| self.columns[n].unit.is_some_and(|unit| unit.scale == Scale::Percent);
        // Hundredths are of what somebody expected, or of nothing that is stated.
        let found = named.or(before).or(values.iter().find(fits)).filter(|(of, _)| !percent(index) || percent(*of));
        match found {
            Some((of, _)) => self.columns[index].kind = Kind::Error(*of),
            None => self.leave(index, Why::Statistic),
        }
    }

    /// Columns that are numbered may be bounces or repeats. Repeats are averaged, or are as high as
    /// one another below the release.
    pub(super) fn repeats(&mut self, region: &Region<'_>, released: bool) -> Result<(), TableError> {
        // Where rows are bounces, columns that are numbered are trials, whatever they hold.
        let rows = self.number().is_some_and(|(_, sure)| sure);
        let numbered = |v: &Value| match v.at {
            At::Nth(n)
                if (rows || matches!(v.what, What::Height | What::Unsaid | What::Interval | What::Total))
                    && v.trial.is_empty() =>
            {
                Some(n)
            }
            _ => None,
        };
        let mut nth: Vec<(usize, usize)> = self.values().filter_map(|(n, _, v)| Some((numbered(v)?, n))).collect();
        nth.sort_unstable();
        let counts: Vec<usize> = nth.iter().map(|(count, _)| *count).collect();
        let nth: Vec<usize> = nth.into_iter().map(|(_, n)| n).collect();
        let drop = self.values().find(|(_, _, v)| v.at == At::Release && v.role == Role::Reading);
        let drop = drop.or_else(|| self.height_beside(&nth));
        // A release that bears the number 0 is of the same count: `h0,h1,h2` are bounces.
        let counted =
            drop.is_some_and(|(_, c, _)| !c.heading.has(Atom::Release) && c.heading.text.contains(['0', '₀']));
        let drop = drop.map(|(n, _, _)| n);
        if nth.len() < 2 || counted {
            return Ok(());
        }
        let mean = self.columns.iter().any(|c| c.heading.has(Atom::Mean) && c.kind == Kind::Aside);
        let averaged = mean && (drop.is_some() || released);
        // A time until rest is that of a drop, and of no bounce.
        let totals = drop.is_some() && nth.iter().all(|&n| self.columns[n].holds(What::Total));
        // Level numbers of no release, of which some rise, are of drops that repeat each other.
        let high = || nth.iter().all(|&n| self.columns[n].holds(What::Height));
        let open = drop.is_none() && !mean && !released && high() && level(region, None, &nth, true);
        let open = !rows && open && !falling(region, &nth);
        if !rows && !averaged && !totals && !open && !level(region, drop, &nth, mean || released) {
            return Ok(());
        }
        let trials = nth.iter().any(|&n| self.columns[n].heading.has(Atom::Trial));
        let either = !(rows || averaged || totals || trials) && drop.is_some_and(|drop| either(region, drop, &nth));
        if open || either {
            let name = |n: usize| shown(&self.columns[n].heading.text);
            let (first, second) = (name(nth[0]), name(nth[1]));
            let message = format!("do '{first}' and '{second}' follow one another, or does each begin with a drop?");
            return Err(region
                .header_error(nth[1], message)
                .question()
                .help("name bounces 'h1 (cm)', 'h2 (cm)' beside 'h0 (cm)', or repeats 'trial 1 (cm)', by --header"));
        }
        let names: Vec<String> = nth.iter().map(|&n| self.columns[n].heading.text.clone()).collect();
        for (&index, count) in nth.iter().zip(counts) {
            if let Kind::Value(value) = &mut self.columns[index].kind {
                (value.at, value.trial) = (At::Row, format!("trial {count}"));
            }
        }
        self.notes.push(Note::Repeats { columns: names });
        Ok(())
    }

    /// The one height beside flights, which may be that of the release.
    fn height_beside(&self, flights: &[usize]) -> Option<(usize, &Column, &Value)> {
        let of_height = |v: &Value| v.what == What::Height && v.role == Role::Reading && v.group.is_empty();
        let mut heights = self.values().filter(|(_, _, v)| of_height(v));
        let one = heights.next().filter(|(_, c, v)| v.at == At::Row && !c.heading.has(Atom::Rebound));
        one.filter(|_| heights.next().is_none() && flights.iter().all(|&n| self.columns[n].holds(What::Interval)))
    }

    /// Columns of one name, nearly as high as one another, beside a height of release or below one
    /// that is stated: trials.
    pub(super) fn namesakes(&mut self, region: &Region<'_>, released: bool) {
        let row =
            |v: &Value| v.what == What::Height && v.at == At::Row && v.role == Role::Reading && v.trial.is_empty();
        let Some((_, name)) = self.values().find(|(_, _, v)| row(v)).map(|(n, c, _)| (n, c.heading.text.clone()))
        else {
            return;
        };
        let same: Vec<usize> =
            self.values().filter(|(_, c, v)| row(v) && c.heading.text == name).map(|(n, _, _)| n).collect();
        let drop = self.values().find(|(_, _, v)| v.at == At::Release && v.role == Role::Reading).map(|(n, _, _)| n);
        if same.len() < 2 || !level(region, drop, &same, released) {
            return;
        }
        for (count, &index) in same.iter().enumerate() {
            if let Kind::Value(value) = &mut self.columns[index].kind {
                value.trial = format!("trial {}", count + 1);
            }
        }
        self.notes.push(Note::Namesakes { column: shown(&name) });
    }

    /// The quantity of columns that do not say it: from their cells, the rows' names, their
    /// neighbours, the options.
    pub(super) fn infer(&mut self, region: &Region<'_>, options: &ReadOptions) -> Result<(), TableError> {
        let silent: Vec<usize> = self.values().filter(|(_, _, v)| v.what == What::Unsaid).map(|(n, _, _)| n).collect();
        let label = self.one(&Kind::Label).or(self.number().map(|(n, _)| n));
        let of_rows = label.and_then(|label| {
            let headings = region.rows.iter().map(|&row| Heading::parse(region.cell(row, label)));
            headings.filter_map(|h| Some((h.value()?.what, h.unit?))).find(|(what, _)| *what != What::Unsaid)
        });
        for index in silent {
            if region.rows.iter().all(|&row| region.cell(row, index).is_empty()) {
                self.leave(index, Why::Empty);
                continue;
            }
            let own = region.rows.iter().find_map(|&row| match region.view.read(row, index) {
                Cell::Number(m) => m.unit.map(|unit| unit.dimension),
                _ if clock(region.cell(row, index)).is_some() => Some(Dimension::Time),
                _ => None,
            });
            if own == Some(Dimension::Other) {
                self.leave(index, Why::Other);
                continue;
            }
            let lost = || self.one(&Kind::Lost).filter(|&n| self.unit_of(region, n).is_some()).map(|_| What::Height);
            let neighbour = self
                .values()
                .find(|(n, _, v)| v.what != What::Unsaid && self.unit_of(region, *n).is_some())
                .map(|(_, _, v)| v.what)
                .or_else(lost);
            let what = match (own, of_rows, options) {
                (Some(Dimension::Length), _, _) => What::Height,
                (Some(Dimension::Time), _, _) => What::Time,
                (Some(Dimension::Speed), _, _) => What::Speed,
                (_, Some((what, unit)), _) => {
                    self.columns[index].unit = Some(unit);
                    what
                }
                _ if neighbour == Some(What::Height) => What::Height,
                (_, _, ReadOptions { height_unit: Some(_), time_unit: None, .. }) => What::Height,
                (_, _, ReadOptions { height_unit: None, time_unit: Some(_), .. }) => What::Time,
                _ if neighbour.is_some_and(|what| what == What::Time) => What::Time,
                _ if matches!(region.units, (None, Some(_))) => What::Height,
                _ if matches!(region.units, (Some(_), None)) => What::Time,
                _ => {
                    let text = shown(&self.columns[index].heading.text);
                    let message = format!("does '{text}' hold heights or times, and in which unit?");
                    return Err(region.header_error(index, message).question().help(format!(
                        "write '{text} (cm)' or '{text} (s)', or give --height-unit cm or --time-unit s"
                    )));
                }
            };
            if let Kind::Value(value) = &mut self.columns[index].kind {
                value.what = what;
            }
        }
        Ok(())
    }

    /// When the ball was let go is a time, and no height, where its name counts frames, or a line
    /// states a unit of times and none of heights: no word says that it is one, and in each row it
    /// comes first.
    fn let_go(&mut self, region: &Region<'_>) {
        let timed = matches!(region.units, (Some(_), None));
        let open = |c: &Column| c.unit.is_none() && ![Atom::Height, Atom::Position].iter().any(|a| c.heading.has(*a));
        let release = |c: &Column, v: &Value| v.what == What::Height && v.at == At::Release && open(c);
        let found = self.values().find(|(_, c, v)| release(c, v) && (timed || c.heading.has(Atom::Frame)));
        let Some(index) = found.map(|(n, _, _)| n) else { return };
        let times: Vec<usize> = self.values().filter(|(_, _, v)| v.what == What::Time).map(|(n, _, _)| n).collect();
        let number = |row: usize, column: usize| region.view.number(row, column);
        let before = |&row: &usize| times.iter().all(|&n| number(row, index) < number(row, n));
        if !times.is_empty() && region.rows.iter().filter(|row| number(**row, index).is_some()).all(before) {
            self.leave(index, Why::Other);
        }
    }

    /// Times between contacts that rise from row to row are a running clock: those of a ball fall,
    /// but where every row has a height of release, and is a drop of its own.
    fn running(&mut self, region: &Region<'_>) {
        if self.any(What::Height, Some(At::Release)) && self.number().is_none() {
            return;
        }
        let between: Vec<usize> = self
            .values()
            .filter(|(_, _, v)| v.what == What::Interval && v.at == At::Row && v.role == Role::Reading)
            .map(|(n, _, _)| n)
            .collect();
        for index in between {
            let number = |row: &usize| region.view.number(*row, index).or_else(|| clock(region.cell(*row, index)));
            let times: Vec<f64> = region.rows.iter().filter_map(number).collect();
            if times.len() > 2
                && times.windows(2).all(|pair| pair[1] > pair[0])
                && let Kind::Value(value) = &mut self.columns[index].kind
            {
                value.what = What::Time;
                let name = shown(&self.columns[index].heading.text);
                self.notes.push(Note::RisingTimes { column: name });
            }
        }
    }

    /// Running clocks, laps, and the heights that phyphox computes from the times.
    pub(super) fn clocks(&mut self, region: &Region<'_>) {
        self.let_go(region);
        self.running(region);
        let numbered = self.number().is_some() || self.one(&Kind::Label).is_some();
        if self.any(What::Total, Some(At::Row))
            && (numbered || self.any(What::Interval, Some(At::Row)))
            && !self.any(What::Time, Some(At::Row))
        {
            for column in &mut self.columns {
                if let Kind::Value(value) = &mut column.kind
                    && value.what == What::Total
                {
                    value.what = What::Time;
                }
            }
        }
        if self.any(What::Time, Some(At::Row)) {
            let worked: Vec<usize> = self
                .values()
                .filter(|(_, _, v)| matches!(v.what, What::Interval | What::Total) && v.at == At::Row)
                .map(|(n, _, _)| n)
                .collect();
            worked.into_iter().for_each(|index| self.leave(index, Why::Derived));
        }
        let timed = |v: &Value| v.what == What::Time && matches!(v.at, At::Nth(_));
        if !self.values().any(|(_, _, v)| timed(v)) {
            return;
        }
        let heights: Vec<usize> = self
            .values()
            .filter(|(_, _, v)| v.what == What::Height && (matches!(v.at, At::Nth(_)) || v.at == At::Release))
            .map(|(n, _, _)| n)
            .collect();
        let energy = |c: &Column| folded(&c.heading.text).starts_with("energ");
        let computed = self.columns.iter().any(energy);
        if computed && heights.iter().any(|&n| matches!(self.columns[n].value().map(|v| v.at), Some(At::Nth(_)))) {
            heights.into_iter().for_each(|index| self.leave(index, Why::Computed));
            self.notes.push(Note::Computed);
        } else if heights.is_empty() {
            // `H,T0,T1,T2`: the height of release, and a clock.
            for column in &mut self.columns {
                if let Kind::Value(value) = &mut column.kind
                    && value.what == What::Height
                    && value.at == At::Row
                {
                    value.at = At::Release;
                }
            }
        }
    }
}
