//! What varies from run to run: what can be asked of it.

use std::path::PathBuf;

use clap::Args as ClapArgs;
use saltus_scene::vary::{Variation, Vary};

use crate::error::Error;
use crate::parse::number;

/// What may stand behind --vary.
pub(crate) const VARIATIONS: &str = "Variations, for example:
  --vary restitution=0.5:0.9:41        41 numbers from 0.5 to 0.9
  --vary ball.height=1m:10m:100        a hundred heights
  --vary drag.per_length=1e-3:1:31:log 31 numbers, each by the same factor above the last
  --vary gravity=earth,moon,mars       a list
  --vary floor.0.friction=0,0.2,0.4    of the first of several floors
Several make a grid, in which the first changes slowest; with --random N each of N runs draws from all.";

/// What varies, and how.
#[derive(Debug, ClapArgs)]
pub(crate) struct Varying {
    /// A key and its values: FROM:TO:COUNT, FROM:TO:COUNT:log, or a list A,B,C; may be repeated.
    #[arg(long = "vary", value_name = "KEY=VALUES", required_unless_present = "design")]
    variations: Vec<Variation>,
    /// A run for each row of a CSV file instead; its headings are keys, such as `ball.height` or
    /// `ball.height (cm)`.
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["variations", "random"])]
    design: Option<PathBuf>,
    /// Make so many runs with values drawn evenly from the ranges, evenly in the logarithm for
    /// `log`, instead of all; COUNT does not matter then.
    #[arg(long, value_name = "COUNT", value_parser = number(1_u64..=u64::MAX), allow_hyphen_values = true)]
    random: Option<u64>,
    /// The seed of the draws: the same seed gives the same values.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = number(0..=u64::MAX), requires = "random", allow_hyphen_values = true)]
    seed: u64,
}

impl Varying {
    /// What varies.
    pub(crate) fn vary(&self) -> Result<Vary, Error> {
        if let Some(path) = &self.design {
            let text = std::fs::read_to_string(path).map_err(|error| Error::reading(path, &error))?;
            return Vary::of_rows(&text).map_err(|error| Error::new(format!("{}: {error}", path.display())));
        }
        Ok(Vary { variations: self.variations.clone(), random: self.random, seed: self.seed, rows: false })
    }
}
