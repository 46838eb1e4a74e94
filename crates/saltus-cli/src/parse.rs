//! How what stands behind an option is read.

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

pub(crate) fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err(format!("'{text}' is not a frame rate: give a number above zero, such as 30")),
    }
}
