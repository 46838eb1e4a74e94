//! One scene with other values: which keys vary, which runs there are, and the scene of each.

mod values;

use clap::Args as ClapArgs;
use saltus_scene::{Run, Scene, SceneError, Template};
use values::Draws;
pub(crate) use values::{Value, Variation};

use crate::error::Error;

/// What may stand behind --vary.
pub(crate) const VARIATIONS: &str = "Variations, for example:
  --vary restitution=0.5:0.9:41        41 numbers from 0.5 to 0.9
  --vary ball.height=1m:10m:100        a hundred heights
  --vary drag.per_length=1e-3:1:31:log 31 numbers, each by the same factor above the last
  --vary gravity=earth,moon,mars       a list
  --vary floor.0.friction=0,0.2,0.4    of the first of several floors
Several make a grid, in which the first changes slowest; with --random N each of N runs draws from all.";

/// More runs than anyone waits for.
const MOST_RUNS: u64 = 1_000_000_000_000;

/// What varies, and how.
#[derive(Debug, ClapArgs)]
pub(crate) struct Vary {
    /// A key and its values: FROM:TO:COUNT, FROM:TO:COUNT:log, or a list A,B,C; may be repeated.
    #[arg(long = "vary", value_name = "KEY=VALUES", required = true)]
    pub(crate) variations: Vec<Variation>,
    /// Make so many runs with values drawn evenly from the ranges, evenly in the logarithm for `log`, instead of all; COUNT does not matter then.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..=MOST_RUNS))]
    pub(crate) random: Option<u64>,
    /// The seed of the draws: the same seed gives the same values.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "random")]
    pub(crate) seed: u64,
}

impl Vary {
    /// The variations as they were written.
    pub(crate) fn texts(&self) -> Vec<&str> {
        self.variations.iter().map(|variation| variation.text.as_str()).collect()
    }

    /// The keys that vary, each once.
    pub(crate) fn keys(&self) -> Result<Vec<&str>, Error> {
        let keys: Vec<&str> = self.variations.iter().map(|variation| variation.key.as_str()).collect();
        match keys.iter().enumerate().find(|(n, key)| keys[..*n].contains(key)) {
            Some((_, twice)) => Err(Error::new(format!("`{twice}` varies twice: keep one --vary of it"))),
            None => Ok(keys),
        }
    }

    /// How many runs there are.
    pub(crate) fn runs(&self) -> Result<u64, Error> {
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
    pub(crate) fn values(&self, run: u64) -> Vec<Value> {
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
    pub(crate) fn says(&self, run: u64) -> String {
        let values = self.values(run);
        let pairs = self
            .variations
            .iter()
            .zip(&values)
            .map(|(variation, value)| format!("{} = {}", variation.key, value.bare()));
        pairs.collect::<Vec<_>>().join(", ")
    }
}

/// The scene of a run.
pub(crate) fn scene(template: &Template<'_>, values: &[Value], end: Run) -> Result<Scene, SceneError> {
    let values: Vec<&str> = values.iter().map(|value| value.toml.as_str()).collect();
    template.scene(&values, end)
}

/// What is wrong with a scene, in one line.
pub(crate) fn refused(error: &SceneError) -> String {
    let says: Vec<&str> = [Some(error.message()), error.help()].into_iter().flatten().collect();
    says.join(": ").replace('\n', " ")
}
