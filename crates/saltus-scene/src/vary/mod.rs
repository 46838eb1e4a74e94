//! One scene with other values: which keys vary, which runs there are, and the values of each.

mod values;

use values::Draws;
pub use values::{Value, Variation};

use crate::{Error, SceneError};

/// More runs than anyone waits for.
const MOST_RUNS: u64 = 1_000_000_000_000;

/// What varies, and how: every value with every other, the last variation fastest, or values drawn
/// at random.
///
/// ```
/// use saltus_scene::vary::Vary;
/// let vary = Vary::new(&["restitution=0.5:0.9:5", "ball.height=1m,2m"])?;
/// assert_eq!((vary.runs()?, vary.says(3)), (10, "restitution = 0.6, ball.height = 2.0 m".to_owned()));
/// # Ok::<(), saltus_scene::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Vary {
    /// A key and its values each.
    pub variations: Vec<Variation>,
    /// So many runs with values drawn evenly from the ranges, evenly in the logarithm for `log`,
    /// instead of all.
    pub random: Option<u64>,
    /// The seed of the draws: the same seed gives the same values.
    pub seed: u64,
}

impl Vary {
    /// Every value with every other.
    ///
    /// # Errors
    /// [`Error`] if a text is not of the form `KEY=FROM:TO:COUNT`, `KEY=FROM:TO:COUNT:log` or
    /// `KEY=A,B,C`.
    pub fn new(texts: &[&str]) -> Result<Self, Error> {
        let variations = texts.iter().map(|text| text.parse().map_err(Error::new)).collect::<Result<_, _>>()?;
        Ok(Self { variations, random: None, seed: 1 })
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

    /// How many runs there are.
    ///
    /// # Errors
    /// [`Error`] for a range without a count in a grid, or for more than 10¹² runs.
    pub fn runs(&self) -> Result<u64, Error> {
        if let Some(count) = self.random {
            return Ok(count);
        }
        let mut runs = 1_u64;
        for variation in &self.variations {
            let Some(count) = variation.count() else {
                let (key, text) = (&variation.key, &variation.text);
                return Err(Error::new(format!(
                    "it is not said how many values `{key}` takes: write --vary {text}:10, or draw them by --random 1000"
                )));
            };
            runs = runs.checked_mul(count).filter(|runs| *runs <= MOST_RUNS).ok_or_else(|| {
                Error::new(format!("the grid has more than {MOST_RUNS} runs: draw some of them by --random 100000"))
            })?;
        }
        Ok(runs)
    }

    /// The values of a run, counted from 0, one for each variation.
    #[must_use]
    pub fn values(&self, run: u64) -> Vec<Value> {
        if self.random.is_some() {
            let mut draws = Draws::of(self.seed, run);
            return self.variations.iter().map(|variation| draws.next(variation)).collect();
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

/// What is wrong with a scene, in one line.
#[must_use]
pub fn refused(error: &SceneError) -> String {
    let says: Vec<&str> = [Some(error.message()), error.help()].into_iter().flatten().collect();
    says.join(": ").replace('\n', " ")
}
