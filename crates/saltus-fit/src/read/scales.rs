//! The unit of every column of numbers: its own, that which is stated, that of its cells or of its
//! neighbours.

use super::ReadOptions;
use super::aside::Why;
use super::cell::{Cell, clock};
use super::columns::{Columns, Kind};
use super::grid::shown;
use super::heading::{At, What};
use super::region::Region;
use super::units::{Dimension, Scale, Unit};
use super::vocabulary::Atom;
use crate::error::TableError;
use crate::finding::{Note, Warning};

/// How long a ball bounces that is dropped and timed, s: from one short flight to a minute.
const BOUNCES: (f64, f64) = (0.1, 60.0);

impl Columns {
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
                Kind::Error(of) | Kind::High(of) | Kind::Ends(of) => {
                    self.columns[*of].value().and_then(|v| v.what.dimension())
                }
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
            Kind::Error(of) | Kind::High(of) | Kind::Ends(of) => Some(of),
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
        if let Some(unit) = self.in_cells(region, index, dimension)? {
            return Ok(unit);
        }
        // A film needs no scale.
        let moving = self.columns[index].value().is_some_and(|v| v.position) && self.any(What::Time, Some(At::Row));
        let filmed = moving
            || region.frames
            || self.values().any(|(_, c, v)| v.what == What::Time && c.heading.has(Atom::Frame));
        if dimension == Dimension::Length && filmed {
            self.notes.push(Note::Pixels { column: name });
            return Ok(Some(Unit::PIXEL));
        }
        if let Some(unit) = self.of_the_drop(region, index, dimension) {
            return Ok(Some(unit));
        }
        if let Some(unit) = self.adopted(region, index, dimension) {
            return Ok(Some(unit));
        }
        if dimension == Dimension::Time
            && let Some(unit) = self.by_size(region, index)
        {
            return Ok(Some(unit));
        }
        // Of speeds before and after only the ratio counts.
        if dimension == Dimension::Speed && self.values().all(|(_, _, v)| v.what == What::Speed) {
            return Ok(Some(Unit::SPEED));
        }
        // Nobody asks in which unit nothing is.
        if region.rows.is_empty() {
            return Ok(None);
        }
        Err(self.no_unit(region, index, dimension))
    }

    /// The unit of times that bear none, where only one of seconds and milliseconds makes them last
    /// as long as a ball bounces. A COR from times needs none.
    fn by_size(&mut self, region: &Region<'_>, index: usize) -> Option<Unit> {
        let numbers: Vec<f64> = region.numbers(index).collect();
        if numbers.len() < 3 {
            return None;
        }
        let (low, high) = numbers.iter().fold((f64::INFINITY, 0.0f64), |(l, h), &n| (l.min(n), h.max(n)));
        let between = self.columns[index].holds(What::Interval);
        let lasts = if between { high } else { high - low };
        let (unit, spelt) = [(Unit::SECOND, "s"), (Unit::parse("ms")?, "ms")]
            .into_iter()
            .find(|(unit, _)| (BOUNCES.0..BOUNCES.1).contains(&unit.si(lasts)))?;
        let name = shown(&self.columns[index].heading.text);
        self.notes.push(Note::UnitBySize { column: name, unit: spelt.to_owned() });
        Some(unit)
    }

    /// The unit that the cells of a column bear: none where each bears its own; nothing where they
    /// bear none.
    #[allow(clippy::option_option)] // whether the cells tell, and what
    fn in_cells(
        &self,
        region: &Region<'_>,
        index: usize,
        dimension: Dimension,
    ) -> Result<Option<Option<Unit>>, TableError> {
        let name = shown(&self.columns[index].heading.text);
        let cells: Vec<usize> = region.rows.iter().copied().filter(|&row| region.view.is_number(row, index)).collect();
        let clocks = cells.iter().filter(|&&row| clock(region.cell(row, index)).is_some()).count();
        if dimension == Dimension::Time && clocks > 0 && clocks == cells.len() {
            return Ok(Some(Some(Unit::SECOND)));
        }
        let bare = |row: &&usize| !matches!(region.view.read(**row, index), Cell::Number(m) if m.unit.is_some());
        match cells.iter().find(bare) {
            None if !cells.is_empty() => return Ok(Some(None)),
            // Written once, behind the first of them, it is that of all.
            Some(_) if cells.len() > 1 && cells.iter().filter(bare).count() + 1 == cells.len() && !bare(&&cells[0]) => {
                let Cell::Number(first) = region.view.read(cells[0], index) else { return Ok(None) };
                return Ok(Some(first.unit));
            }
            Some(&row) if cells.len() > 1 && cells.iter().filter(bare).count() < cells.len() => {
                return Err(region
                    .view
                    .error(row, index, format!("this number has no unit, and others of '{name}' have one"))
                    .help("write the unit behind each, or once in the header"));
            }
            _ => {}
        }
        Ok(None)
    }

    /// The unit of a column: that of its heading, or the one that all its cells bear.
    pub(super) fn unit_of(&self, region: &Region<'_>, index: usize) -> Option<Unit> {
        let own = self.columns[index].heading.unit.or(self.columns[index].unit);
        own.or_else(|| {
            let mut cells = region.rows.iter().filter_map(|&row| match region.view.read(row, index) {
                Cell::Number(m) => Some(m.unit),
                _ => None,
            });
            let first = cells.next()??;
            cells.all(|unit| unit == Some(first)).then_some(first)
        })
    }

    /// The unit of the height of release in the heading, or above the table, if the numbers below
    /// are no higher in it.
    fn of_the_drop(&self, region: &Region<'_>, index: usize, dimension: Dimension) -> Option<Unit> {
        let drop = self.columns[index].value()?.drop.as_ref().or(region.drop.as_ref());
        let drop = drop.filter(|drop| drop.unit.dimension == dimension)?;
        let most = region.numbers(index).fold(0.0, f64::max);
        (NEAR * drop.value..=drop.value).contains(&most).then_some(drop.unit)
    }

    /// The unit of the neighbours, if they have one and the numbers below it make sense: no rebound
    /// is higher than the release.
    fn adopted(&mut self, region: &Region<'_>, index: usize, dimension: Dimension) -> Option<Unit> {
        let lost = self.one(&Kind::Lost).filter(|_| dimension == Dimension::Length);
        let alike = self.values().filter(|(_, _, v)| v.what.dimension() == Some(dimension)).map(|(n, _, _)| n);
        let mut units: Vec<(usize, Unit)> =
            alike.chain(lost).filter(|n| *n != index).filter_map(|n| Some((n, self.unit_of(region, n)?))).collect();
        let (from, unit) = units.pop()?;
        if units.iter().any(|(_, other)| *other != unit) || unit.unscaled() {
            return None;
        }
        let most = |column: usize| region.numbers(column).fold(0.0, f64::max);
        let (own, other) = (most(index), most(from));
        let sane = own > 0.0 && (NEAR * other..=other / NEAR).contains(&own);
        let release = self.columns[from].value().is_some_and(|v| v.at == At::Release);
        if !sane || release && own > other {
            return None;
        }
        let (name, of) = (shown(&self.columns[index].heading.text), shown(&self.columns[from].heading.text));
        self.notes.push(Note::SameUnit { column: name, of });
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

    /// A unit that is stated is for columns that name none. Where all of them name one, and
    /// another, it can only mean that they are wrong: what is stated holds, with a warning.
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
            self.warnings.push(Warning::UnitAgainstName { column: column.heading.text.clone(), unit: name.to_owned() });
        }
        Ok(())
    }
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
