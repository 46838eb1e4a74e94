//! The unit of a column: from its header, from the options, or from the habits of the program that wrote it.

use saltus_bounce::units::Quantity;

use super::ReadOptions;
use super::sheet::{Sheet, shown};
use super::vocabulary::is_vocabulary;
use crate::error::TableError;

/// A unit as a factor, or, where that is exact, as a divisor: 30 cm is 30 / 100 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    times: f64,
    over: f64,
    /// Pixels nobody has given a scale for: one counts as a metre.
    pub(super) pixels: bool,
    /// The header names it.
    pub(super) named: bool,
}

/// Words for units beside their symbols.
const WORDS: &[(&[&str], &str)] = &[
    (&["second", "seconds", "secs"], "s"),
    (&["millisecond", "milliseconds", "msec"], "ms"),
    (&["minute", "minutes"], "min"),
    (&["meter", "meters", "metre", "metres"], "m"),
    (&["centimeter", "centimeters", "centimetre", "centimetres"], "cm"),
    (&["millimeter", "millimeters", "millimetre", "millimetres"], "mm"),
    (&["inch", "inches"], "in"),
    (&["foot", "feet"], "ft"),
];

const PIXEL: &[&str] = &["px", "pixel", "pixels", "pix"];

impl Unit {
    pub(super) const ONE: Self = Self { times: 1.0, over: 1.0, pixels: false, named: false };

    /// A number of this unit in SI units.
    pub(super) fn si(self, value: f64) -> f64 {
        value * self.times / self.over
    }

    /// One frame, in seconds.
    pub(super) fn frame(fps: f64) -> Self {
        Self { over: fps, ..Self::ONE }
    }

    /// The same, named by the header.
    pub(super) fn by_name(self) -> Self {
        Self { named: true, ..self }
    }

    fn of(scale: f64) -> Self {
        let inverse = (1.0 / scale).round();
        if scale < 1.0 && (inverse * scale - 1.0).abs() < f64::EPSILON {
            Self { over: inverse, ..Self::ONE }
        } else {
            Self { times: scale, ..Self::ONE }
        }
    }

    /// The unit a word means, if it is one of this quantity.
    fn named(quantity: Quantity, word: &str, options: &ReadOptions) -> Option<Self> {
        if quantity == Quantity::Length && PIXEL.contains(&word) {
            let (times, pixels) = (options.scale.unwrap_or(1.0), options.scale.is_none());
            return Some(Self { times, pixels, ..Self::ONE });
        }
        let symbol = WORDS.iter().find(|(words, _)| words.contains(&word)).map_or(word, |(_, symbol)| symbol);
        quantity.scale(symbol).map(Self::of)
    }
}

/// Whether a word is a unit of a quantity.
pub(super) fn is_unit(quantity: Quantity, word: &str) -> bool {
    Unit::named(quantity, word, &ReadOptions::default()).is_some()
}

/// The unit of column `index`, whose name `cell` splits into `words` and a `bracket`.
pub(super) fn unit(
    sheet: &Sheet<'_>,
    options: &ReadOptions,
    index: usize,
    quantity: Quantity,
    words: &[String],
    bracket: Option<&str>,
) -> Result<Unit, TableError> {
    let cell = sheet.block.header[index].as_str();
    let (assumed, option) = match quantity {
        Quantity::Time => (sheet.block.units.0, "--time-unit s"),
        _ => (sheet.block.units.1, "--height-unit cm (or px)"),
    };
    let given = stated(sheet, options, quantity)?;
    let in_words = || {
        let mut known = words.iter().skip(1).filter(|word| is_unit(quantity, word));
        let first = known.next();
        // In 'height in cm' the inch is a preposition.
        if first.is_some_and(|word| word == "in") { known.next().or(first) } else { first }
    };
    let own = bracket.and_then(|inside| Unit::named(quantity, inside, options));
    if let Some(unit) = own.or_else(|| in_words().and_then(|word| Unit::named(quantity, word, options))) {
        return Ok(unit.by_name());
    }
    let other = bracket.into_iter().chain(words.iter().skip(1).map(String::as_str)).find(|word| {
        [Quantity::Time, Quantity::Length, Quantity::Speed].iter().any(|q| is_unit(*q, word)) || *word == "kg"
    });
    if let Some(wrong) = other.or(bracket.filter(|_| given.is_none())) {
        return Err(sheet
            .header_error(
                index,
                format!("'{}' in '{}' is not a unit of {}", shown(wrong), shown(cell), thing(quantity)),
            )
            .help(format!("use one of {}", known(quantity))));
    }
    if let Some((_, unit)) = given {
        return Ok(unit);
    }
    // Only pixels are scaled: whoever gives a scale has pixels.
    let assumed = assumed.or((quantity == Quantity::Length && options.scale.is_some()).then_some("px"));
    if let Some(unit) = assumed.and_then(|unit| Unit::named(quantity, unit, options)) {
        return Ok(unit);
    }
    if quantity == Quantity::Time && stopwatch(sheet, index)? {
        return Ok(Unit::ONE);
    }
    let stem = words.first().map_or("height", String::as_str);
    let example = if quantity == Quantity::Time { format!("{stem}_s") } else { format!("{stem}_cm") };
    let message = match words.last().filter(|word| words.len() > 1 && !is_vocabulary(word)) {
        Some(word) => {
            format!("'{}' in '{}' is not a unit of {} that is known", shown(word), shown(cell), thing(quantity))
        }
        None => format!("the column '{}' has no unit", shown(cell)),
    };
    let known = known(quantity);
    Err(sheet.header_error(index, message).help(format!("name it '{example}', or give {option}; known are {known}")))
}

/// The unit that is stated beside the table for a quantity: its name, and what it is.
pub(super) fn stated<'a>(
    sheet: &Sheet<'_>,
    options: &'a ReadOptions,
    quantity: Quantity,
) -> Result<Option<(&'a str, Unit)>, TableError> {
    let given = if quantity == Quantity::Time { &options.time_unit } else { &options.height_unit };
    let Some(name) = given.as_deref().map(str::trim) else { return Ok(None) };
    match Unit::named(quantity, name, options) {
        Some(unit) => Ok(Some((name, unit))),
        None => Err(sheet
            .error(format!("the unit given, '{name}', is not a unit of {}", thing(quantity)))
            .help(format!("use one of {}", known(quantity)))),
    }
}

/// Whether the first reading of a column is one of a stopwatch, `0:01.25`.
fn stopwatch(sheet: &Sheet<'_>, index: usize) -> Result<bool, TableError> {
    let mut found = false;
    sheet.grid.each_record(sheet.block.rows.clone(), sheet.block.line, |row| {
        found = row.clock(index).is_some();
        Ok(row.cell(index).is_empty())
    })?;
    Ok(found)
}

fn known(quantity: Quantity) -> String {
    let names: Vec<&str> = quantity.units().iter().map(|(name, _)| *name).collect();
    let pixels = if quantity == Quantity::Length { ", px" } else { "" };
    format!("{}{pixels}", names.join(", "))
}

fn thing(quantity: Quantity) -> &'static str {
    if quantity == Quantity::Time { "time" } else { "length" }
}
