//! What part columns play beside one another: means and errors, repeats and bounces, clocks and intervals; and their quantity and unit.

use std::collections::BTreeSet;

use super::ReadOptions;
use super::aside::Why;
use super::cell::{Cell, clock};
use super::columns::{Columns, Kind};
use super::grid::shown;
use super::heading::{At, Heading, Role, Value, What};
use super::region::Region;
use super::units::{Dimension, Scale, Unit};
use super::vocabulary::{Atom, folded};
use crate::error::TableError;
use crate::statistics::median;

impl Columns {
    /// `Drop` is the height of release beside trials; beside readings that say what they are it may only count, and then holds 1, 2, 3.
    pub(super) fn drops(&mut self, region: &Region<'_>) {
        let trials = self.values().any(|(_, _, v)| !v.trial.is_empty() || !v.group.is_empty());
        let rows = self.values().any(|(_, c, v)| !v.or_trial && v.at != At::Release && (c.unit.is_some() || !trials));
        for (index, column) in self.columns.iter_mut().enumerate() {
            if rows && column.unit.is_none() && column.value().is_some_and(|v| v.or_trial) && counts(region, index) {
                column.kind = Kind::Trial;
            }
        }
    }

    /// Means, errors, extremes and losses, each beside the readings it belongs to.
    pub(super) fn statistics(&mut self, region: &Region<'_>) -> Result<(), TableError> {
        let values: Vec<(usize, Value)> = self.values().map(|(n, _, v)| (n, v.clone())).collect();
        let same = |a: &Value, b: &Value| a.what == b.what || a.what == What::Unsaid || b.what == What::Unsaid;
        let placed = |a: &Value, b: &Value| (a.at == At::Release) == (b.at == At::Release);
        let role = |v: &Value, role: Role| v.role == role;
        let beside = |v: &Value| {
            values.iter().any(|(_, o)| role(o, Role::Reading) && same(o, v) && (placed(o, v) || !o.trial.is_empty()))
        };
        // A mean stands for the readings between its extremes.
        let within = |v: &Value| values.iter().any(|(_, o)| role(o, Role::Mean) && same(o, v) && placed(o, v));
        for (index, value) in &values {
            match value.role {
                Role::Reading => {}
                Role::Mean if beside(value) => self.leave(*index, Why::Statistic),
                Role::Mean => self.read(*index),
                Role::Error => self.error(*index, value, &values),
                Role::Max | Role::Min => {
                    let other = if value.role == Role::Max { Role::Min } else { Role::Max };
                    let pair = values.iter().find(|(_, o)| role(o, other) && same(o, value) && o.at == value.at);
                    match pair {
                        _ if beside(value) || within(value) => self.leave(*index, Why::Statistic),
                        Some((low, _)) if value.role == Role::Max => self.columns[*index].kind = Kind::High(*low),
                        Some(_) => self.read(*index),
                        // The greatest height between two bounces is that of the apex.
                        None if value.role == Role::Max && self.number().is_some_and(|(_, sure)| sure) => {
                            self.read(*index);
                        }
                        None => return Err(self.extreme(region, *index)),
                    }
                }
                Role::Lost => {
                    let drop = values.iter().any(|(_, o)| role(o, Role::Reading) && o.at == At::Release);
                    if beside(value) {
                        self.leave(*index, Why::Derived);
                    } else if drop && !self.number().is_some_and(|(_, sure)| sure) {
                        self.columns[*index].kind = Kind::Lost;
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
        match named.or(before).or(values.iter().find(fits)) {
            Some((of, _)) => self.columns[index].kind = Kind::Error(*of),
            None => self.leave(index, Why::Statistic),
        }
    }

    /// Columns that are numbered may be bounces or repeats. Repeats are averaged, or are as high as one another below the release.
    pub(super) fn repeats(&mut self, region: &Region<'_>) {
        // Where rows are bounces, columns that are numbered are trials, whatever they hold.
        let rows = self.number().is_some_and(|(_, sure)| sure);
        let numbered = |v: &Value| match v.at {
            At::Nth(n)
                if (rows || matches!(v.what, What::Height | What::Unsaid | What::Interval)) && v.trial.is_empty() =>
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
        // A release that bears the number 0 is of the same count: `h0,h1,h2` are bounces.
        let counted = drop.is_some_and(|(_, c, _)| !c.heading.has(Atom::Release));
        let drop = drop.map(|(n, _, _)| n);
        if nth.len() < 2 || counted {
            return;
        }
        let averaged =
            drop.is_some() && self.columns.iter().any(|c| c.heading.has(Atom::Mean) && c.kind == Kind::Aside);
        if !rows && !averaged && !drop.is_some_and(|drop| level(region, drop, &nth)) {
            return;
        }
        let names: Vec<String> = nth.iter().map(|&n| self.columns[n].heading.text.clone()).collect();
        for (&index, count) in nth.iter().zip(counts) {
            if let Kind::Value(value) = &mut self.columns[index].kind {
                (value.at, value.trial) = (At::Row, format!("trial {count}"));
            }
        }
        self.notes
            .push(format!("'{}' are taken for repeats and not for bounces one after another", names.join("', '")));
    }

    /// The quantity of columns that do not say it: from their cells, the rows' names, their neighbours, the options.
    pub(super) fn infer(&mut self, region: &Region<'_>, options: &ReadOptions) -> Result<(), TableError> {
        let silent: Vec<usize> = self.values().filter(|(_, _, v)| v.what == What::Unsaid).map(|(n, _, _)| n).collect();
        let label = self.one(&Kind::Label).or(self.number().map(|(n, _)| n));
        let of_rows = label.and_then(|label| {
            let headings = region.rows.iter().map(|&row| Heading::parse(region.cell(row, label)));
            headings.filter_map(|h| Some((h.value()?.what, h.unit?))).find(|(what, _)| *what != What::Unsaid)
        });
        for index in silent {
            let own = region.rows.iter().find_map(|&row| match region.view.read(row, index) {
                Cell::Number(m) => m.unit.map(|unit| unit.dimension),
                _ if clock(region.cell(row, index)).is_some() => Some(Dimension::Time),
                _ => None,
            });
            let neighbour =
                self.values().find(|(_, c, v)| v.what != What::Unsaid && c.unit.is_some()).map(|(_, _, v)| v.what);
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

    /// Times between contacts that rise from row to row are a running clock: those of a ball fall.
    fn running(&mut self, region: &Region<'_>) {
        let between: Vec<usize> = self
            .values()
            .filter(|(_, _, v)| v.what == What::Interval && v.at == At::Row && v.role == Role::Reading)
            .map(|(n, _, _)| n)
            .collect();
        for index in between {
            let number = |row: &usize| match region.view.read(*row, index) {
                Cell::Number(m) => Some(m.value),
                _ => clock(region.cell(*row, index)),
            };
            let times: Vec<f64> = region.rows.iter().filter_map(number).collect();
            if times.len() > 2
                && times.windows(2).all(|pair| pair[1] > pair[0])
                && let Kind::Value(value) = &mut self.columns[index].kind
            {
                value.what = What::Time;
                let name = shown(&self.columns[index].heading.text);
                self.notes
                    .push(format!("the times of '{name}' rise from row to row: taken as those of a running clock"));
            }
        }
    }

    /// Running clocks, laps, and the heights that phyphox computes from the times.
    pub(super) fn clocks(&mut self, region: &Region<'_>) {
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
        let energy = |c: &super::columns::Column| folded(&c.heading.text).starts_with("energ");
        let computed = self.columns.iter().any(energy);
        if computed && heights.iter().any(|&n| matches!(self.columns[n].value().map(|v| v.at), Some(At::Nth(_)))) {
            heights.into_iter().for_each(|index| self.leave(index, Why::Computed));
            self.notes.push("heights were left aside: phyphox computes them from the times".to_owned());
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

    /// The unit of every column of numbers.
    pub(super) fn scales(&mut self, region: &Region<'_>, options: &ReadOptions) -> Result<(), TableError> {
        let placed = self.any(What::Height, None) || self.any(What::Time, None);
        for index in 0..self.columns.len() {
            // Programs write speeds in units of their own beside the places that they follow from.
            let column = &self.columns[index];
            if placed && column.holds(What::Speed) && column.unit.is_none_or(|unit| unit.dimension != Dimension::Speed)
            {
                self.leave(index, Why::Derived);
            }
            let dimension = match &self.columns[index].kind {
                Kind::Value(value) => value.what.dimension(),
                Kind::Lost => Some(Dimension::Length),
                Kind::Error(of) | Kind::High(of) => self.columns[*of].value().and_then(|v| v.what.dimension()),
                _ => None,
            };
            if let Some(dimension) = dimension {
                self.columns[index].unit = self.scale(region, options, index, dimension)?;
            }
        }
        for dimension in [Dimension::Length, Dimension::Time] {
            self.overrule(region, options, dimension)?;
        }
        Ok(())
    }

    fn scale(
        &mut self,
        region: &Region<'_>,
        options: &ReadOptions,
        index: usize,
        dimension: Dimension,
    ) -> Result<Option<Unit>, TableError> {
        let sized = |unit: Unit| match (unit.scale, options.scale) {
            (Scale::Pixels, Some(metres)) => Unit::pixel_of(metres),
            _ => unit,
        };
        let column = &self.columns[index];
        let name = shown(&column.heading.text);
        let of = match column.kind {
            Kind::Error(of) | Kind::High(of) => Some(of),
            _ => None,
        };
        if let Some(unit) = column.unit {
            if unit.dimension == dimension {
                return Ok(Some(sized(unit)));
            }
            return Err(self.mismatch(region, index, dimension));
        }
        if let Some(unit) = stated(region, options, dimension)? {
            return Ok(Some(sized(unit)));
        }
        if let Some(of) = of {
            return Ok(self.columns[of].unit);
        }
        let default = if dimension == Dimension::Time { region.units.0 } else { region.units.1 };
        // Only pixels are scaled: whoever gives a scale has pixels.
        let pixels = options.scale.is_some() && dimension == Dimension::Length;
        if let Some(unit) = default.or(pixels.then_some(Unit::PIXEL)).filter(|unit| unit.dimension == dimension) {
            return Ok(Some(sized(unit)));
        }
        let cells: Vec<usize> = region.rows.iter().copied().filter(|&row| region.view.is_number(row, index)).collect();
        let clocks = cells.iter().filter(|&&row| clock(region.cell(row, index)).is_some()).count();
        if dimension == Dimension::Time && clocks > 0 && clocks == cells.len() {
            return Ok(Some(Unit::SECOND));
        }
        let bare = |row: &&usize| !matches!(region.view.read(**row, index), Cell::Number(m) if m.unit.is_some());
        match cells.iter().find(bare) {
            None if !cells.is_empty() => return Ok(None),
            Some(&row) if cells.len() > 1 && cells.iter().filter(bare).count() < cells.len() => {
                return Err(region
                    .view
                    .error(row, index, format!("this number has no unit, and others of '{name}' have one"))
                    .help("write the unit behind each, or once in the header"));
            }
            _ => {}
        }
        // A film needs no scale.
        let filmed = region.frames || self.values().any(|(_, c, v)| v.what == What::Time && c.heading.has(Atom::Frame));
        if dimension == Dimension::Length && filmed {
            self.notes
                .push(format!("'{name}' has no unit: taken as pixels of unknown size, which a COR does not need"));
            return Ok(Some(Unit::PIXEL));
        }
        if let Some(unit) = self.of_the_drop(region, index, dimension) {
            return Ok(Some(unit));
        }
        if let Some(unit) = self.adopted(region, index, dimension) {
            return Ok(Some(unit));
        }
        Err(self.no_unit(region, index, dimension))
    }

    /// The unit of the height of release in the heading, if the numbers below it are no higher in it.
    fn of_the_drop(&self, region: &Region<'_>, index: usize, dimension: Dimension) -> Option<Unit> {
        let drop = self.columns[index].value()?.drop.as_ref().filter(|drop| drop.unit.dimension == dimension)?;
        let number = |row: &usize| match region.view.read(*row, index) {
            Cell::Number(m) => Some(m.value),
            _ => None,
        };
        let most = region.rows.iter().filter_map(number).fold(0.0, f64::max);
        (NEAR * drop.value..=drop.value).contains(&most).then_some(drop.unit)
    }

    /// The unit of the neighbours, if they have one and the numbers below it make sense: no rebound is higher than the release.
    fn adopted(&mut self, region: &Region<'_>, index: usize, dimension: Dimension) -> Option<Unit> {
        let mut units: Vec<(usize, Unit)> = self
            .values()
            .filter(|(n, c, v)| *n != index && v.what.dimension() == Some(dimension) && c.heading.unit.is_some())
            .filter_map(|(n, c, _)| Some((n, c.heading.unit?)))
            .collect();
        let (from, unit) = units.pop()?;
        if units.iter().any(|(_, other)| *other != unit) || unit.unscaled() {
            return None;
        }
        let most = |column: usize| {
            let number = |row: &usize| match region.view.read(*row, column) {
                Cell::Number(m) => Some(m.value),
                _ => None,
            };
            region.rows.iter().filter_map(number).fold(0.0, f64::max)
        };
        let (own, other) = (most(index), most(from));
        let sane = own > 0.0 && (NEAR * other..=other / NEAR).contains(&own);
        let release = self.columns[from].value().is_some_and(|v| v.at == At::Release);
        if !sane || release && own > other {
            return None;
        }
        let (name, of) = (shown(&self.columns[index].heading.text), shown(&self.columns[from].heading.text));
        self.notes.push(format!("'{name}' is taken to be in the unit of '{of}'"));
        Some(unit)
    }

    fn no_unit(&self, region: &Region<'_>, index: usize, dimension: Dimension) -> TableError {
        let text = shown(&self.columns[index].heading.text);
        let (example, option) = match dimension {
            Dimension::Time => (format!("{text} (s)"), "--time-unit s"),
            Dimension::Speed => (format!("{text} (m/s)"), "--header with it"),
            _ => (format!("{text} (cm)"), "--height-unit cm (or px)"),
        };
        region
            .header_error(index, format!("the column '{text}' has no unit"))
            .question()
            .help(format!("name it '{example}', or give {option}; known are {}", dimension.known()))
    }

    /// A unit that is stated is for columns that name none. Where all of them name one, and another, it can only mean that they are wrong: what
    /// is stated holds, with a warning.
    fn overrule(&mut self, region: &Region<'_>, options: &ReadOptions, dimension: Dimension) -> Result<(), TableError> {
        let Some(unit) = stated(region, options, dimension)? else { return Ok(()) };
        let unit = match (unit.scale, options.scale) {
            (Scale::Pixels, Some(metres)) => Unit::pixel_of(metres),
            _ => unit,
        };
        let name = if dimension == Dimension::Time { &options.time_unit } else { &options.height_unit };
        let (name, of) = (name.as_deref().unwrap_or_default(), |c: &super::columns::Column| {
            c.unit.is_some_and(|u| u.dimension == dimension) && !matches!(c.kind, Kind::Aside | Kind::Setting)
        });
        if !self.columns.iter().filter(|c| of(c)).all(|c| c.heading.unit.is_some()) {
            return Ok(());
        }
        for column in self.columns.iter_mut().filter(|c| of(c) && c.unit != Some(unit)) {
            column.unit = Some(unit);
            self.warnings.push(format!(
                "the numbers of '{}' are taken to be in {name}, as stated, against its name",
                column.heading.text
            ));
        }
        Ok(())
    }
}

/// Whether the cells of a column count something: whole numbers from 0 or 1 on, none of them left out.
fn counts(region: &Region<'_>, index: usize) -> bool {
    let cells = || region.rows.iter().map(|&row| region.cell(row, index)).filter(|cell| !cell.is_empty());
    let numbers: Option<BTreeSet<usize>> = cells().map(|cell| cell.parse().ok()).collect();
    numbers.is_some_and(|numbers| {
        let first = numbers.first().copied().unwrap_or(2);
        first < 2 && numbers.iter().enumerate().all(|(n, number)| *number == first + n)
    })
}

/// A rebound is read down to this part of its neighbour.
const NEAR: f64 = 0.02;

/// The unit that is stated beside the table.
fn stated(region: &Region<'_>, options: &ReadOptions, dimension: Dimension) -> Result<Option<Unit>, TableError> {
    let given = match dimension {
        Dimension::Time => &options.time_unit,
        Dimension::Length => &options.height_unit,
        _ => return Ok(None),
    };
    let Some(name) = given.as_deref().map(str::trim) else { return Ok(None) };
    match Unit::parse(name).filter(|unit| unit.dimension == dimension) {
        Some(unit) => Ok(Some(unit)),
        None => Err(region
            .error(format!("the unit given, '{name}', is not a unit of {}", dimension.noun()))
            .help(format!("use one of {}", dimension.known()))),
    }
}

/// Whether heights side by side are nearly as high as one another, and well below the release: repeats, and not bounces.
fn level(region: &Region<'_>, drop: usize, nth: &[usize]) -> bool {
    /// A ball that keeps more of its height than this keeps it at the first bounce too.
    const LEVEL: f64 = 0.95;
    const FALLS: f64 = 0.9;
    let number = |row: usize, column: usize| match region.view.read(row, column) {
        Cell::Number(m) => Some(m.value),
        _ => None,
    };
    let ratios = |pairs: &[(usize, usize)]| {
        let all = region
            .rows
            .iter()
            .flat_map(|&row| pairs.iter().filter_map(move |&(a, b)| Some(number(row, b)? / number(row, a)?)));
        median(&mut all.collect::<Vec<f64>>())
    };
    let later: Vec<(usize, usize)> = nth.windows(2).map(|w| (w[0], w[1])).collect();
    ratios(&[(drop, nth[0])]).zip(ratios(&later)).is_some_and(|(first, later)| later > LEVEL && first < FALLS)
}
