//! Cells as numbers in SI units, each with its error.

use super::{Builder, Found};
use crate::error::TableError;
use crate::quantity::STANDARD_GRAVITY;
use crate::read::aside::{LeftAside, Part, Why};
use crate::read::cell::{Cell, Fault, clock};
use crate::read::columns::Kind;
use crate::read::grid::shown;
use crate::read::heading::{At, What};
use crate::read::rows::Rows;
use crate::read::units::{Dimension, Scale, Unit};

impl Builder<'_> {
    pub(super) fn line(&self, row: usize, column: usize) -> u64 {
        self.region.view.line(row, column)
    }

    /// Whether a cell holds words, and no digit, where most others of its column are numbers: the
    /// reading is missing, and the words say why.
    pub(super) fn wordy(&self, row: usize, column: usize) -> bool {
        let view = self.region.view;
        let mostly = || {
            let cells = || self.region.rows.iter().map(|&row| (view.read(row, column), view.cell(row, column)));
            let number = |(read, cell): &(Cell, &str)| matches!(read, Cell::Number(_)) || clock(cell).is_some();
            let words = |(read, cell): &(Cell, &str)| *read == Cell::Words && clock(cell).is_none();
            cells().filter(number).count() > 2 * cells().filter(words).count()
        };
        !view.cell(row, column).contains(|c: char| c.is_ascii_digit()) && *self.mostly[column].get_or_init(mostly)
    }

    /// Names the cells that hold words in place of a reading as left aside.
    pub(super) fn wanting(&mut self, rows: &Rows) {
        let found = (0..self.mostly.len()).filter(|column| self.mostly[*column].get() == Some(&true));
        for column in found.collect::<Vec<usize>>() {
            let name = shown(&self.columns.columns[column].heading.text);
            for row in &rows.rows {
                if self.region.view.read(row.at, column) == Cell::Words && self.wordy(row.at, column) {
                    let line = self.line(row.at, column);
                    self.aside.push(LeftAside::new(Part::Cell, name.clone(), Why::Empty).at(line));
                }
            }
        }
    }

    /// The number in a cell in SI units, with its error; `None` if it is empty.
    pub(super) fn number(&self, row: usize, column: usize) -> Result<Found, TableError> {
        let (view, own) = (self.region.view, &self.columns.columns[column]);
        let cell = view.cell(row, column);
        let timed = own.unit.is_some_and(|u| u.dimension == Dimension::Time);
        if let Some(seconds) = clock(cell).filter(|_| timed) {
            return Ok(Some((seconds, self.sigma(row, column)?)));
        }
        let wrong = |message: String, help: &str| Err(view.error(row, column, message).help(help));
        let text = shown(cell);
        let measured = match view.read(row, column) {
            Cell::Empty => return Ok(None),
            Cell::Number(measured) => measured,
            Cell::Lost | Cell::Wrong(Fault::NotFinite) => {
                return wrong(format!("'{text}' is not a finite number"), "take the row out");
            }
            Cell::Words if self.wordy(row, column) => return Ok(None),
            Cell::Words => {
                let help = if text.contains(' ') {
                    "write a plain number; the unit belongs in the header or behind the number, and a remark behind a '#'"
                } else {
                    "write a plain number; the unit belongs in the header"
                };
                return wrong(format!("'{text}' is not a number"), help);
            }
            Cell::Wrong(fault) => {
                let (what, help) = faulty(fault);
                return wrong(format!("'{text}' {what}"), help);
            }
        };
        let unit = self.unit(row, column, measured.unit)?;
        let sigma = match measured.error {
            Some(error) => Some(unit.si(error)),
            None => self.sigma(row, column)?,
        };
        let mut value = unit.si(measured.value);
        if own.turned {
            if value <= 0.0 {
                return wrong(format!("'{text}' is no time that a gate is blocked for"), "correct the cell");
            }
            return Ok(Some((1.0 / value, sigma.map(|sigma| sigma / (value * value)))));
        }
        if own.holds(What::Height) {
            let zero = own.unit.map_or(own.zero, |named| named.si(own.zero));
            // The difference in the column's own unit is exact where the sum of conversions is not.
            value = if measured.unit.is_none() { unit.si(measured.value - own.zero) } else { value - zero };
            value *= own.sign;
        }
        self.ranged(row, column, value, sigma)
    }

    /// The unit of a number: that of its cell, where the column has one of its kind, else that of
    /// the column.
    fn unit(&self, row: usize, column: usize, in_cell: Option<Unit>) -> Result<Unit, TableError> {
        let (view, own) = (self.region.view, &self.columns.columns[column]);
        let text = shown(view.cell(row, column));
        let wrong = |message: String, help: &str| Err(view.error(row, column, message).help(help));
        let joules = own.unit.is_some_and(|unit| matches!(unit.scale, Scale::Energy { .. }));
        let in_cell = in_cell.map(|unit| unit.of_height().filter(|_| joules).unwrap_or(unit));
        Ok(match (in_cell, own.unit) {
            (Some(unit), Some(named)) if unit.dimension != named.dimension => {
                return wrong(
                    format!("the unit of '{text}' is not one of {}", named.dimension.noun()),
                    "correct the cell",
                );
            }
            (Some(unit), None) if own.value().and_then(|v| v.what.dimension()).is_some_and(|d| d != unit.dimension) => {
                return wrong(format!("the unit of '{text}' is not the quantity of its column"), "correct the cell");
            }
            (Some(unit), named) => {
                let mixed = named.is_some_and(|named| named.unscaled() != unit.unscaled());
                if mixed && !(unit.unscaled() && named.is_none()) {
                    return wrong(
                        format!("'{text}' is in another kind of unit than its column"),
                        "write all numbers in one unit",
                    );
                }
                unit
            }
            (None, Some(named)) => named,
            (None, None) => {
                return wrong(format!("'{text}' has no unit"), "write it behind the number, or in the header");
            }
        })
    }

    /// A range has its middle for a reading, and half its width for an error.
    pub(super) fn ranged(
        &self,
        row: usize,
        column: usize,
        value: f64,
        sigma: Option<f64>,
    ) -> Result<Found, TableError> {
        let Some(high) = self.columns.one(&Kind::High(column)) else { return Ok(Some((value, sigma))) };
        let Some((top, _)) = self.number(row, high)? else { return Ok(Some((value, sigma))) };
        let half = 0.5 * (top - value);
        if half < 0.0 {
            return Err(self
                .region
                .view
                .error(row, high, "this upper end is below the lower")
                .help("correct the cell"));
        }
        Ok(Some((value + half, sigma.or(Some(half).filter(|half| *half > 0.0)))))
    }

    /// The error that a column states for a reading.
    pub(super) fn sigma(&self, row: usize, column: usize) -> Result<Option<f64>, TableError> {
        let own = &self.columns.columns[column];
        let spread = || own.heading.spread.and_then(|spread| own.unit.map(|unit| unit.si(spread)));
        let Some(index) = self.columns.one(&Kind::Error(column)) else { return Ok(spread()) };
        match self.region.view.read(row, index) {
            Cell::Empty | Cell::Words => Ok(spread()),
            _ => {
                let sigma = self.number(row, index)?.map(|(value, _)| value);
                // The release is set, and has none.
                if sigma == Some(0.0) && own.value().is_some_and(|v| v.at == At::Release) {
                    return Ok(None);
                }
                match sigma {
                    Some(sigma) if sigma <= 0.0 => Err(self
                        .region
                        .view
                        .error(row, index, "an error must be above zero")
                        .help("leave the cell empty if it is not known")),
                    sigma => Ok(sigma),
                }
            }
        }
    }

    pub(super) fn required(&self, row: usize, column: usize) -> Result<(f64, Option<f64>), TableError> {
        self.number(row, column)?.ok_or_else(|| self.empty(row, column))
    }

    pub(super) fn empty(&self, row: usize, column: usize) -> TableError {
        let view = self.region.view;
        match shown(view.cell(row, column)) {
            cell if cell.is_empty() => {
                view.error(row, column, "the cell is empty").help("fill it, or take the row out")
            }
            cell => {
                view.error(row, column, format!("'{cell}' is no reading")).help("write one here, or take the row out")
            }
        }
    }

    /// A height above the floor; a speed as the height that gives it.
    pub(super) fn height(&self, row: usize, column: usize) -> Result<Found, TableError> {
        let found = self.number(row, column)?;
        if self.columns.columns[column].holds(What::Speed) {
            return Ok(found.map(|(speed, sigma)| {
                (0.5 * speed * speed / STANDARD_GRAVITY, sigma.map(|sigma| sigma * speed.abs() / STANDARD_GRAVITY))
            }));
        }
        if found.is_some_and(|(height, _)| height < 0.0) {
            return Err(self.region.view.error(row, column, "a height below the floor").help(
                "heights count upwards from the floor: give what the scale reads there, such as --zero 2.5, \
                     and --y-down if it counts downwards",
            ));
        }
        Ok(found)
    }

    /// A time; zero after a time above it is one that was not heard.
    pub(super) fn time(&mut self, trial: usize, row: usize, column: usize) -> Result<Found, TableError> {
        let found = self.number(row, column)?;
        let before = self.trials[trial].readings.iter().filter_map(|r| r.time).fold(0.0, f64::max);
        if found.is_some_and(|(time, _)| time == 0.0) && before > 0.0 {
            let line = self.line(row, column);
            let name = shown(&self.columns.columns[column].heading.text);
            self.aside.push(LeftAside::new(Part::Cell, name, Why::NotHeard).at(line));
            return Ok(None);
        }
        Ok(found)
    }
}

fn faulty(fault: Fault) -> (&'static str, &'static str) {
    match fault {
        Fault::Comma => (
            "has a comma in a table separated by commas",
            "write a decimal point, or separate the cells by semicolons; write no separators of thousands",
        ),
        Fault::Thousands => ("is not a number", "write no separators of thousands"),
        Fault::NotFinite => ("is not a finite number", "take the row out"),
        Fault::Turned => ("says itself that it is no reading", "take it out, or the remark"),
        Fault::Bound => ("is a bound and no reading", "give what was read, or leave the cell empty"),
    }
}
