//! One scene with other values: which keys vary, which runs there are, and the values of each.

mod values;

use values::Draws;
pub(crate) use values::Said;
pub use values::{Value, Variation};

use crate::{Error, SceneError};

/// The most runs of one sweep: their table is some 15 GB, and takes one core hours to days.
const MOST_RUNS: u64 = 100_000_000;

/// The keys that vary, and the order of their values: every value with every other, the last
/// variation fastest, or values drawn at random.
///
/// ```
/// use saltus_scene::vary::Vary;
/// let vary = Vary::new(&["restitution=0.5:0.9:5", "ball.height=1m,2m"])?;
/// assert_eq!((vary.runs()?, vary.says(3)), (10, "restitution = 0.6, ball.height = 2.0 m".to_owned()));
/// # Ok::<(), saltus_scene::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Vary {
    /// The keys that vary, each with its values.
    pub variations: Vec<Variation>,
    /// The number of runs with values drawn evenly from the ranges, evenly in the logarithm for
    /// `log`; `None` for every value with every other.
    pub random: Option<u64>,
    /// The seed of the draws: the same seed gives the same values.
    pub seed: u64,
    /// Whether run n takes value n of each key: the rows of a design.
    pub rows: bool,
}

impl Vary {
    /// Every value with every other.
    ///
    /// # Errors
    /// [`Error`] if a text is not of the form `KEY=FROM:TO:COUNT`, `KEY=FROM:TO:COUNT:log` or
    /// `KEY=A,B,C`.
    pub fn new(texts: &[&str]) -> Result<Self, Error> {
        let variations = texts.iter().map(|text| text.parse().map_err(Error::new)).collect::<Result<_, _>>()?;
        Ok(Self { variations, random: None, seed: 1, rows: false })
    }

    /// A run for each row of a table, as designs of experiments have: CSV, a key in each heading,
    /// `ball.height`, or a key and its unit, `ball.height (cm)`.
    ///
    /// ```
    /// use saltus_scene::vary::Vary;
    /// let vary = Vary::of_rows("restitution,ball.height (cm)\n0.5,120\n0.7,80\n")?;
    /// assert_eq!((vary.runs()?, vary.says(1)), (2, "restitution = 0.7, ball.height = 80.0 cm".to_owned()));
    /// # Ok::<(), saltus_scene::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`] with the line for a row of another length than the headings and for a value that
    /// is missing, and for what is no key or no value; for a table without rows.
    pub fn of_rows(text: &str) -> Result<Self, Error> {
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.trim_start_matches('\u{feff}').as_bytes());
        let headings: Vec<String> = reader.headers().map_err(Error::new)?.iter().map(str::to_owned).collect();
        let mut columns: Vec<Vec<String>> = vec![Vec::new(); headings.len()];
        for record in reader.records() {
            let record = record.map_err(Error::new)?;
            for ((cell, heading), column) in record.iter().zip(&headings).zip(&mut columns) {
                if cell.is_empty() || cell.contains([',', ':']) {
                    let line = record.position().map_or(0, csv::Position::line);
                    let what = if cell.is_empty() { "a value is missing" } else { "one value is wanted" };
                    return Err(Error::new(format!("line {line}, `{heading}`: {what}: a run takes one of each key")));
                }
                column.push(cell.to_owned());
            }
        }
        if columns.first().is_none_or(Vec::is_empty) {
            return Err(Error::new("the design has no rows: write the keys in the first line and a run in each below"));
        }
        let variation = |(heading, cells): (&String, &Vec<String>)| {
            let (key, unit) = match heading.split_once('(') {
                Some((key, unit)) => (key.trim(), format!(" {}", unit.trim_end_matches(')').trim())),
                None => (heading.as_str(), String::new()),
            };
            let cells: Vec<String> = cells.iter().map(|cell| format!("{cell}{unit}")).collect();
            format!("{key}={}", cells.join(",")).parse().map_err(Error::new)
        };
        let variations = headings.iter().zip(&columns).map(variation).collect::<Result<_, _>>()?;
        Ok(Self { variations, random: None, seed: 1, rows: true })
    }

    /// The variations as they were written.
    #[must_use]
    pub fn texts(&self) -> Vec<&str> {
        self.variations.iter().map(|variation| variation.text.as_str()).collect()
    }

    /// The keys that vary, each once.
    ///
    /// # Errors
    /// [`Error`] for a key that varies twice.
    pub fn keys(&self) -> Result<Vec<&str>, Error> {
        let keys: Vec<&str> = self.variations.iter().map(|variation| variation.key.as_str()).collect();
        match keys.iter().enumerate().find(|(n, key)| keys[..*n].contains(key)) {
            Some((_, twice)) => Err(Error::new(format!("`{twice}` varies twice: keep one --vary of it"))),
            None => Ok(keys),
        }
    }

    /// The number of runs.
    ///
    /// # Errors
    /// [`Error`] for a range without a count in a grid, and for more than a hundred million runs.
    pub fn runs(&self) -> Result<u64, Error> {
        let runs = match self.random {
            Some(count) => u128::from(count),
            None if self.rows => u128::from(self.length()?),
            None => self.variations.iter().try_fold(1_u128, |runs, variation| {
                let count = variation.count().ok_or_else(|| {
                    let (key, text) = (&variation.key, &variation.text);
                    Error::new(format!(
                        "it is not said how many values `{key}` takes: write --vary {text}:10, or draw them by --random 1000"
                    ))
                })?;
                Ok::<_, Error>(runs.saturating_mul(u128::from(count)))
            })?,
        };
        match u64::try_from(runs) {
            Ok(runs) if runs <= MOST_RUNS => Ok(runs),
            _ => Err(Error::new(format!(
                "these are {runs} runs, and a sweep has {MOST_RUNS} at most: vary in fewer steps, draw some by --random 100000, or make several sweeps"
            ))),
        }
    }

    /// The number of values of each variation of a design.
    fn length(&self) -> Result<u64, Error> {
        let count = |variation: &Variation| variation.count().unwrap_or(0);
        let length = self.variations.first().map_or(0, count);
        match self.variations.iter().find(|variation| count(variation) != length) {
            None => Ok(length),
            Some(other) => {
                let (key, there, first) = (&other.key, count(other), &self.variations[0].key);
                Err(Error::new(format!("`{first}` has {length} values, and `{key}` {there}: a design has rows")))
            }
        }
    }

    /// The values of a run, counted from 0, one for each variation.
    #[must_use]
    pub fn values(&self, run: u64) -> Vec<Value> {
        if self.random.is_some() {
            let mut draws = Draws::of(self.seed, run);
            return self.variations.iter().map(|variation| draws.next(variation)).collect();
        }
        if self.rows {
            return self.variations.iter().map(|variation| variation.value(run)).collect();
        }
        // Every value with every other, the last variation fastest.
        let mut rest = run;
        let mut values = Vec::with_capacity(self.variations.len());
        for variation in self.variations.iter().rev() {
            let count = variation.count().unwrap_or(1);
            values.push(variation.value(rest % count));
            rest /= count;
        }
        values.reverse();
        values
    }

    /// The values of a run for a person.
    #[must_use]
    pub fn says(&self, run: u64) -> String {
        let values = self.values(run);
        let pairs = self
            .variations
            .iter()
            .zip(&values)
            .map(|(variation, value)| format!("{} = {}", variation.key, value.bare()));
        pairs.collect::<Vec<_>>().join(", ")
    }
}

/// The error of a scene, in one line.
#[must_use]
pub fn refused(error: &SceneError) -> String {
    let says: Vec<&str> = [Some(error.message()), error.help()].into_iter().flatten().collect();
    says.join(": ").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Variation, Vary};

    proptest! {
        /// Run n of a design has value n of every key, to the bit; unequal lengths are refused.
        #[test]
        fn a_design_has_rows(rows in prop::collection::vec((-1e6..1e6_f64, "[a-z0-9 ]{1,6}"), 1..20), more in 1..3_usize) {
            let numbers: Vec<f64> = rows.iter().map(|row| row.0).collect();
            let words: Vec<String> = rows.iter().map(|row| row.1.clone()).collect();
            let of = |numbers: Vec<f64>| Vary {
                variations: vec![
                    Variation::numbers("restitution", numbers).expect("a list"),
                    Variation::words("gravity", &words).expect("a list"),
                ],
                random: None,
                seed: 1,
                rows: true,
            };
            let vary = of(numbers.clone());
            prop_assert_eq!(vary.runs().ok(), Some(rows.len() as u64));
            for (n, (number, word)) in rows.iter().enumerate() {
                let values = vary.values(n as u64);
                prop_assert_eq!(values[0].cell.parse::<f64>().map(f64::to_bits), Ok((number + 0.0).to_bits()));
                prop_assert!(values[1].word && values[1].cell == *word);
            }
            let longer = numbers.iter().copied().cycle().take(rows.len() + more).collect();
            prop_assert!(of(longer).runs().is_err());
        }
    }
}
