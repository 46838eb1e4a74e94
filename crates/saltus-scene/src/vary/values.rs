//! A key of the scene, and the values it takes.

use std::str::FromStr;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use saltus_bounce::units::Quantity;
use serde::Serialize;
use serde_json::Value as Json;
use sha2::{Digest, Sha256};

use crate::number::{self, hex, number};

/// So many values stand one by one in a plan; of more there is a hash: a plan stays short enough to
/// be read, and to stand in the metadata of every part.
const LISTED: u64 = 1000;

/// A key of the scene, and the values it takes.
#[derive(Clone, Debug)]
pub struct Variation {
    /// The path of the key in the file.
    pub key: String,
    /// The text of the variation.
    pub text: String,
    values: Values,
}

#[derive(Clone, Debug)]
enum Values {
    Range { from: f64, to: f64, count: Option<u64>, logarithmic: bool, unit: Option<String> },
    List { list: Vec<Value>, unit: Option<String> },
}

/// A value of a run.
#[derive(Clone, Debug)]
pub struct Value {
    /// The value as TOML.
    pub toml: String,
    /// The cell of the value in a table: a number, or a word.
    pub cell: String,
    /// Whether it is a word.
    pub word: bool,
}

impl Value {
    fn number(value: f64, unit: Option<&str>) -> Self {
        let toml = match unit {
            Some(unit) => format!("\"{value:?} {unit}\""),
            // Some keys take whole numbers only.
            None if value.fract() == 0.0 && value.abs() < 2e9 => format!("{value:.0}"),
            None => format!("{value:?}"),
        };
        Self { toml, cell: number(value), word: false }
    }

    /// Four digits and the unit, `1.5m` or `30mps`, or the word: short enough for the name of a
    /// file.
    #[must_use]
    pub fn short(&self) -> String {
        match number::split(self.bare()) {
            Some((number, unit)) => format!("{}{}", number::digits(number, 4), unit.replace('/', "p")),
            None => self.bare().to_owned(),
        }
    }

    /// Without quotes.
    #[must_use]
    pub fn bare(&self) -> &str {
        self.toml.trim_matches('"')
    }

    /// As it stands in a table.
    fn json(&self) -> Json {
        match self.cell.parse::<f64>() {
            Ok(number) if !self.word => number.into(),
            _ => self.cell.as_str().into(),
        }
    }

    fn word(word: &str) -> Self {
        let toml = if matches!(word, "true" | "false") { word.to_owned() } else { format!("\"{word}\"") };
        Self { toml, cell: word.to_owned(), word: true }
    }
}

/// A variation as values and not as text: those that are one have one serialization.
#[derive(Serialize)]
pub(crate) struct Said<'a> {
    key: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<&'a str>,
    #[serde(flatten)]
    which: Which,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Which {
    /// Numbers, and words as text.
    Each { values: Vec<Json> },
    /// So many values, by the SHA-256 of them as such a list.
    Many { count: u64, sha256: String },
    /// Drawn from a range.
    Between { from: f64, to: f64, log: bool },
}

impl FromStr for Variation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (key, values) =
            text.split_once('=').ok_or("a key and its values have `=` between them, such as restitution=0.5:0.9:41")?;
        let (key, values) = (path(key.trim())?, bare(values.trim())?);
        let values = if values.contains(':') { range(values)? } else { list(values)? };
        Ok(Self { key, text: text.trim().to_owned(), values })
    }
}

/// A key, if it is the path of a value.
fn path(key: &str) -> Result<String, String> {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    if key.split('.').all(|step| !step.is_empty() && step.chars().all(plain)) {
        return Ok(key.to_owned());
    }
    Err(format!("'{key}' is no key: write a path such as ball.height or floor.0.friction"))
}

/// Values, if nothing in them is more than text in TOML.
fn bare(values: &str) -> Result<&str, String> {
    if values.contains(['"', '\'', '\\']) || values.contains(char::is_control) {
        return Err("values stand without quotes, such as ball.height=1m:10m:100".to_owned());
    }
    Ok(values)
}

/// FROM:TO:COUNT, with `:log` behind it or not; for random draws without COUNT.
fn range(text: &str) -> Result<Values, String> {
    let mut parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let logarithmic = parts.last() == Some(&"log");
    if logarithmic {
        parts.pop();
    }
    let (from, to, count) = match parts[..] {
        [from, to] => (from, to, None),
        [from, to, count] => {
            let says = |_| format!("'{count}' is no count: write FROM:TO:COUNT, such as 1m:10m:100");
            (from, to, Some(count.parse::<u64>().map_err(says)?))
        }
        _ => return Err(format!("'{text}' is no range: write FROM:TO:COUNT, such as 1m:10m:100")),
    };
    let read = |text: &str| {
        let wrong = || format!("'{text}' is not a number: write FROM:TO:COUNT, such as 1m:10m:100");
        let (value, unit) = parsed(text).ok_or_else(wrong)?;
        Ok::<_, String>((value, unit.map(str::to_owned)))
    };
    let ((from, unit), (to, other)) = (read(from)?, read(to)?);
    let (to, unit) = match (unit, other) {
        (Some(unit), Some(other)) if unit != other => (to * ratio(&other, &unit)?, Some(unit)),
        (unit, other) => (to, unit.or(other)),
    };
    match count {
        Some(0) => return Err("no value is asked for: give a count above zero".to_owned()),
        Some(1) if from != to => {
            return Err("one value does not reach from end to end: give a count of two or more".to_owned());
        }
        _ => {}
    }
    if logarithmic && !(from > 0.0 && to > 0.0) {
        return Err("a range by equal factors has both ends above zero".to_owned());
    }
    if !(to - from).is_finite() {
        return Err("the range is too wide".to_owned());
    }
    Ok(Values::Range { from, to, count, logarithmic, unit })
}

fn list(text: &str) -> Result<Values, String> {
    let value = |item: &str| match (parsed(item), item) {
        (_, "") => Err("a value is missing: write A,B,C or FROM:TO:COUNT".to_owned()),
        (Some((value, unit)), _) => Ok((Value::number(value, unit), unit.map(str::to_owned))),
        (None, word) => Ok((Value::word(word), None)),
    };
    let read: Vec<(Value, Option<String>)> =
        text.split(',').map(|item| value(item.trim())).collect::<Result<_, _>>()?;
    // Numbers of one unit are numbers; else each cell says its unit.
    let first = read.first().and_then(|(_, unit)| unit.clone());
    let one = read.iter().all(|(value, unit)| !value.word && *unit == first);
    let values = read.into_iter().zip(text.split(',')).map(|((value, unit), item)| match unit {
        Some(_) if !one => Value { cell: item.trim().to_owned(), word: true, ..value },
        _ => value,
    });
    Ok(Values::List { list: values.collect(), unit: first.filter(|_| one) })
}

/// A number, and the unit behind it if there is one.
fn parsed(text: &str) -> Option<(f64, Option<&str>)> {
    let (value, unit) = number::split(text)?;
    Some((value, (!unit.is_empty()).then_some(unit)))
}

/// The size of `unit`, in units of `other`.
fn ratio(unit: &str, other: &str) -> Result<f64, String> {
    let both = |quantity: &Quantity| Some(quantity.scale(unit)? / quantity.scale(other)?);
    Quantity::ALL.iter().find_map(both).ok_or_else(|| format!("'{other}' and '{unit}' do not measure the same"))
}

impl Variation {
    /// A list of numbers, in the unit that the key has.
    ///
    /// # Errors
    /// What is wrong with the key, numbers that are not finite, and no numbers.
    pub fn numbers(key: &str, values: Vec<f64>) -> Result<Self, String> {
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Err(format!("a value of `{key}` is {value}"));
        }
        Self::listed(key, values.into_iter().map(|value| Value::number(value, None)).collect())
    }

    /// A list of words, amounts with their unit among them.
    ///
    /// # Errors
    /// What is wrong with the key or a word, and no words.
    pub fn words(key: &str, words: &[String]) -> Result<Self, String> {
        Self::listed(key, words.iter().map(|word| bare(word).map(Value::word)).collect::<Result<_, _>>()?)
    }

    fn listed(key: &str, list: Vec<Value>) -> Result<Self, String> {
        if list.is_empty() {
            return Err(format!("`{key}` has no values"));
        }
        Ok(Self { key: path(key)?, text: key.to_owned(), values: Values::List { list, unit: None } })
    }

    /// The number of values; `None` for a range without a count.
    #[must_use]
    pub fn count(&self) -> Option<u64> {
        match &self.values {
            Values::Range { count, .. } => *count,
            Values::List { list, .. } => Some(list.len() as u64),
        }
    }

    /// The name of its column.
    #[must_use]
    pub fn header(&self) -> String {
        match self.unit() {
            None => self.key.clone(),
            Some(unit) => {
                let unit = unit.strip_prefix("1/").map_or_else(|| unit.to_owned(), |rest| format!("per_{rest}"));
                let unit = unit.replace('/', "_per_").replace(' ', "_").replace(['^', '(', ')'], "");
                format!("{}_{}", self.key, unit.trim_start_matches('_'))
            }
        }
    }

    /// Whether its values follow each other by equal factors.
    #[must_use]
    pub const fn is_logarithmic(&self) -> bool {
        matches!(self.values, Values::Range { logarithmic: true, .. })
    }

    /// Whether its values are words, or numbers of several units.
    #[must_use]
    pub fn is_words(&self) -> bool {
        matches!(&self.values, Values::List { list, .. } if list.iter().any(|value| value.word))
    }

    /// The unit of its numbers, as the scene file has it.
    #[must_use]
    pub fn unit(&self) -> Option<&str> {
        let (Values::Range { unit, .. } | Values::List { unit, .. }) = &self.values;
        unit.as_deref()
    }

    /// What its values are, however they are written; of a range either each of them, or the range
    /// from which they are `drawn`.
    pub(crate) fn said(&self, drawn: bool) -> Said<'_> {
        let which = match (&self.values, self.count()) {
            (Values::Range { from, to, logarithmic, .. }, _) if drawn => {
                Which::Between { from: *from, to: *to, log: *logarithmic }
            }
            (_, Some(count)) if count > LISTED => {
                let mut all = Sha256::new();
                (0..count).for_each(|n| all.update(format!("{},", self.value(n).json())));
                Which::Many { count, sha256: hex(&all.finalize()) }
            }
            (_, count) => Which::Each { values: (0..count.unwrap_or(0)).map(|n| self.value(n).json()).collect() },
        };
        Said { key: &self.key, unit: self.unit(), which }
    }

    /// Value `n` of as many as it takes.
    #[allow(clippy::cast_precision_loss)] // counts are at most 10^8
    #[must_use]
    pub fn value(&self, n: u64) -> Value {
        match &self.values {
            Values::List { list, .. } => list[n as usize].clone(),
            Values::Range { from, to, count, logarithmic, unit } => {
                let last = count.unwrap_or(1).saturating_sub(1);
                let value = match (n, *logarithmic) {
                    (0, _) => *from,
                    _ if n >= last => *to,
                    (_, false) => even(*from, *to, n as f64 / last as f64),
                    (_, true) => between(*from, *to, n as f64 / last as f64),
                };
                Value::number(value, unit.as_deref())
            }
        }
    }
}

/// Values drawn from a seed, each run's from a stream of its own.
pub(super) struct Draws(ChaCha8Rng);

impl Draws {
    pub(super) fn of(seed: u64, run: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(run);
        Self(random)
    }

    /// A value drawn from all that a variation may take.
    #[allow(clippy::cast_precision_loss)] // 53 bits
    pub(super) fn next(&mut self, variation: &Variation) -> Value {
        let bits = self.0.next_u64();
        match &variation.values {
            Values::List { list, .. } => list[((u128::from(bits) * list.len() as u128) >> 64) as usize].clone(),
            Values::Range { from, to, logarithmic, unit, .. } => {
                let share = (bits >> 11) as f64 * 2.0_f64.powi(-53);
                let value = if *logarithmic { between(*from, *to, share) } else { from + (to - from) * share };
                Value::number(value.clamp(from.min(*to), from.max(*to)), unit.as_deref())
            }
        }
    }
}

/// A value by equal steps, to the fifteen digits that the greater end keeps: `0.31`, and not
/// `0.30999999999999994`.
fn even(from: f64, to: f64, share: f64) -> f64 {
    /// Fifteen digits of the smallest double need so many decimals.
    const MOST: f64 = 338.0;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
    let decimals = (14.0 - from.abs().max(to.abs()).log10().floor()).clamp(0.0, MOST) as usize;
    let value = from * (1.0 - share) + to * share;
    let rounded: f64 = format!("{value:.decimals$}").parse().unwrap_or(value);
    rounded.clamp(from.min(to), from.max(to))
}

/// A value by equal factors, to the fifteen digits that a logarithm keeps.
fn between(from: f64, to: f64, share: f64) -> f64 {
    let value = from * (to / from).powf(share);
    format!("{value:.14e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::Variation;

    #[test]
    fn ranges_as_wide_and_as_narrow_as_can_be_have_their_values() {
        for range in ["0:0", "5e-324:5e-324", "-5e-324:5e-324", "-1e-300:0", "0:1e308", "-8e307:8e307", "1e22:3e22"] {
            let vary: Variation = format!("key={range}:7").parse().unwrap();
            let values: Vec<f64> = (0..7).map(|n| vary.value(n).cell.parse().unwrap()).collect();
            assert!(values.is_sorted() && values.iter().all(|value| value.is_finite()), "{range}: {values:?}");
        }
    }

    proptest! {
        /// Steps of whole tenths, hundredths, ... are the decimals that are written so.
        #[test]
        fn even_steps_are_the_decimals_they_look_like(
            places in 0..9_u32, from in -99_999..99_999_i64, step in -999..999_i64, count in 2..200_u64,
        ) {
            let decimal = |n: i64| format!("{n}e-{places}");
            let to = from + step * (count as i64 - 1);
            let vary: Variation = format!("key={}:{}:{count}", decimal(from), decimal(to)).parse().unwrap();
            for n in 0..count {
                let expected: f64 = decimal(from + step * n as i64).parse().unwrap();
                prop_assert_eq!(vary.value(n).cell.parse::<f64>(), Ok(expected), "{} of {}", n, vary.text);
            }
        }
    }
}
