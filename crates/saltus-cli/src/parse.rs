//! How what stands behind an option is read.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use saltus_bounce::units::Quantity;
use saltus_scene::accuracy::Target;

/// How a report is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ReportFormat {
    /// For people.
    #[default]
    Text,
    /// For programs: a contract.
    Json,
}

/// One of `all`, each with its name and a few words about it.
pub(crate) fn one_of<T>(
    all: &'static [T],
    name: fn(T) -> &'static str,
    about: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let values = all.iter().map(|&value| PossibleValue::new(name(value)).help(about(value)));
    PossibleValuesParser::new(values).try_map(move |chosen| {
        all.iter().copied().find(|&value| name(value) == chosen).ok_or_else(|| format!("'{chosen}' is not known"))
    })
}

pub(crate) fn quantity(quantity: Quantity) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| quantity.parse(text).map_err(|error| error.to_string())
}

pub(crate) fn positive(quantity: Quantity) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| match quantity.parse(text) {
        Ok(value) if value > 0.0 => Ok(value),
        Ok(_) => Err(format!("'{text}' is not above zero")),
        Err(error) => Err(error.to_string()),
    }
}

/// A length, a time, or both with a comma between.
pub(crate) fn target(text: &str) -> Result<Target, String> {
    let mut target = Target { length: None, time: None };
    for part in text.split(',') {
        let (length, time) = (positive(Quantity::Length)(part.trim()), positive(Quantity::Time)(part.trim()));
        match (length, time) {
            (Ok(length), _) if target.length.is_none() => target.length = Some(length),
            (_, Ok(time)) if target.time.is_none() => target.time = Some(time),
            _ => {
                return Err(format!(
                    "'{text}' is no accuracy: give a length, a time, or both, above zero, such as 1mm,1ms"
                ));
            }
        }
    }
    Ok(target)
}

/// A number without a unit in a range; a whole one if its type has no other.
pub(crate) fn number<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + fmt::Display + Clone + Send + Sync + 'static,
{
    move |text| {
        let whole = if "0.5".parse::<T>().is_ok() { "" } else { "whole " };
        let (low, high) = (range.start(), range.end());
        let value = text.parse().ok().filter(|value| range.contains(value));
        value.ok_or_else(|| format!("'{text}' is not a {whole}number from {low} to {high}"))
    }
}

/// After how many jumps a run may end: any number.
pub(crate) const JUMPS: RangeInclusive<u32> = 1..=u32::MAX;
/// How many samples or frames a second may have: from one in a quarter of an hour to one in a
/// microsecond.
pub(crate) const RATES: RangeInclusive<f64> = 0.001..=1e6;
/// The number of a first frame: six digits, which every format holds.
pub(crate) const FIRST_FRAME: RangeInclusive<i32> = -1_000_000..=1_000_000;
