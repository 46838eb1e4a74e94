//! The report: the verdict, the COR, and everything it rests on; serialised, it is the JSON contract.

mod numbers;
mod recordings;
mod scene;
mod text;

use std::fmt;
use std::path::Path;

use serde::Serialize;

pub(crate) use self::numbers::{duration, length, measured, pair};
use crate::bootstrap::Bootstrap;
use crate::bounces::BounceCor;
use crate::choice::ModelChoice;
use crate::estimate::{Estimate, Sourced};
use crate::joint::{Agreement, Hypothesis};
use crate::motion::Motion;
use crate::profile::Profile;
use crate::residual::{Point, Residual};
use crate::series::Track;
use crate::tolerance::Allowed;

/// The number of the JSON contract: it grows when a field changes its meaning or goes, not when one is added.
const SCHEMA: u32 = 1;

/// Whether the COR may be believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The readings determine the COR, fit the model, and the methods agree.
    Trusted,
    /// A number can be given, but something speaks against it; the reason and the warnings say what.
    Doubtful,
    /// The readings do not determine a COR.
    Refused,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Trusted => "trusted",
            Self::Doubtful => "doubtful",
            Self::Refused => "refused",
        })
    }
}

/// The COR with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Cor {
    /// The COR, without unit.
    pub value: f64,
    /// Its standard error; none where only a limit is known.
    pub standard_error: Option<f64>,
    /// The lower end of the 95 % interval.
    pub low: f64,
    /// The upper end of the 95 % interval.
    pub high: f64,
}

/// The COR and its standard error, with as many digits as that leaves it: `0.7812 ± 0.0009`.
impl fmt::Display for Cor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.standard_error {
            Some(error) => f.write_str(&pair(self.value, error)),
            None => write!(f, "{:.3}", self.value),
        }
    }
}

/// What a fit found: see [`Fit::run`](crate::Fit::run). `Display` writes it for people, serde for programs.
///
/// ```
/// use saltus_fit::{Fit, Table, Verdict};
///
/// let report = Fit::new().sigma_height(0.005).run(&Table::from_heights(&[1.0, 0.64, 0.41, 0.26])?)?;
/// let cor = report.cor().expect("the heights determine a COR");
/// assert_eq!(report.verdict(), Verdict::Trusted);
/// assert!((cor.value - 0.8).abs() < 0.003 && cor.low < 0.8 && 0.8 < cor.high);
/// println!("{report}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub(crate) schema: u32,
    pub(crate) table: String,
    pub(crate) verdict: Verdict,
    pub(crate) reason: String,
    pub(crate) cor: Option<Cor>,
    pub(crate) trials: usize,
    pub(crate) gravity: Sourced,
    pub(crate) sigma_height: Option<Sourced>,
    pub(crate) sigma_time: Option<Sourced>,
    pub(crate) frame_rate: Option<f64>,
    pub(crate) estimates: Vec<Estimate>,
    pub(crate) bounces: Vec<BounceCor>,
    pub(crate) agreement: Option<Agreement>,
    pub(crate) hypotheses: Vec<Hypothesis>,
    pub(crate) models: Vec<ModelChoice>,
    pub(crate) allowed: Vec<Allowed>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) profiles: Vec<Profile>,
    pub(crate) bootstrap: Option<Bootstrap>,
    pub(crate) series: Vec<Track>,
    pub(crate) warnings: Vec<String>,
    pub(crate) repairs: Vec<String>,
    pub(crate) notes: Vec<String>,
    /// The files of the table, where there are several.
    #[serde(skip)]
    pub(crate) files: Vec<String>,
    /// Heights are in pixels.
    #[serde(skip)]
    pub(crate) pixels: bool,
    /// What the interval takes in beside the error of the COR, in words, each thing once.
    #[serde(skip)]
    pub(crate) widened: Vec<String>,
    #[serde(skip)]
    pub(crate) ball: Option<f64>,
    #[serde(skip)]
    pub(crate) motion: Option<Motion>,
    #[serde(skip)]
    pub(crate) residuals: Vec<Residual>,
    #[serde(skip)]
    pub(crate) points: Vec<Point>,
}

impl Report {
    pub(crate) fn new(table: &str, gravity: Sourced) -> Self {
        Self {
            schema: SCHEMA,
            table: table.to_owned(),
            verdict: Verdict::Refused,
            reason: String::new(),
            cor: None,
            trials: 0,
            gravity,
            sigma_height: None,
            sigma_time: None,
            frame_rate: None,
            estimates: Vec::new(),
            bounces: Vec::new(),
            agreement: None,
            hypotheses: Vec::new(),
            models: Vec::new(),
            allowed: Vec::new(),
            profiles: Vec::new(),
            bootstrap: None,
            series: Vec::new(),
            warnings: Vec::new(),
            repairs: Vec::new(),
            notes: Vec::new(),
            files: Vec::new(),
            pixels: false,
            widened: Vec::new(),
            ball: None,
            motion: None,
            residuals: Vec::new(),
            points: Vec::new(),
        }
    }

    /// The interval takes in something more; `why`, in words.
    pub(crate) fn widen(&mut self, why: &str) {
        if !self.widened.iter().any(|said| said == why) {
            self.widened.push(why.to_owned());
        }
    }

    /// The name of the table.
    #[must_use]
    pub fn table(&self) -> &str {
        &self.table
    }

    /// What the table is about, after its name: `squash-on-cement.csv` is about "Squash on cement". Up to three files are listed, more are counted.
    #[must_use]
    pub fn title(&self) -> String {
        let words = |name: &str| {
            let stem = Path::new(name).file_stem().map_or(name.into(), |stem| stem.to_string_lossy());
            stem.replace(['-', '_'], " ")
        };
        let title = match self.files.as_slice() {
            [] | [_] => words(&self.table),
            [most @ .., last] if most.len() < 3 => {
                let most: Vec<String> = most.iter().map(|name| words(name)).collect();
                format!("{} and {}", most.join(", "), words(last))
            }
            more => format!("{} files", more.len()),
        };
        let mut letters = title.chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
    }

    /// Whether the COR may be believed.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.verdict
    }

    /// Why the verdict is what it is, in a sentence.
    #[must_use]
    pub fn reason(&self) -> &str {
        &self.reason
    }

    /// The COR; none if the verdict is refused.
    #[must_use]
    pub fn cor(&self) -> Option<&Cor> {
        self.cor.as_ref()
    }

    /// Whether the heights are in pixels that nobody gave a scale for.
    #[must_use]
    pub fn in_pixels(&self) -> bool {
        self.pixels
    }

    /// The gravity that was used, in m/s².
    #[must_use]
    pub fn gravity(&self) -> Sourced {
        self.gravity
    }

    /// The standard error of heights, in metres; none if the table has no heights.
    #[must_use]
    pub fn sigma_height(&self) -> Option<Sourced> {
        self.sigma_height
    }

    /// The standard error of times, in seconds; none if the table has no times.
    #[must_use]
    pub fn sigma_time(&self) -> Option<Sourced> {
        self.sigma_time
    }

    /// The COR by each method that applies.
    #[must_use]
    pub fn estimates(&self) -> &[Estimate] {
        &self.estimates
    }

    /// The COR bounce by bounce, for the first two dozen bounces.
    #[must_use]
    pub fn bounces(&self) -> &[BounceCor] {
        &self.bounces
    }

    /// How heights and times go together, where the table has both.
    #[must_use]
    pub fn agreement(&self) -> Option<&Agreement> {
        self.agreement.as_ref()
    }

    /// What might explain a disagreement, the best first.
    #[must_use]
    pub fn hypotheses(&self) -> &[Hypothesis] {
        &self.hypotheses
    }

    /// The models that were tried on the same readings, the best first.
    #[must_use]
    pub fn models(&self) -> &[ModelChoice] {
        &self.models
    }

    /// The CORs that the tolerances allow, where tolerances were given.
    #[must_use]
    pub fn allowed(&self) -> &[Allowed] {
        &self.allowed
    }

    /// How the cost of each method depends on the COR, where that was asked for.
    #[must_use]
    pub fn profiles(&self) -> &[Profile] {
        &self.profiles
    }

    /// The error by drawing whole trials anew, where that was asked for and there are five trials or more.
    #[must_use]
    pub fn bootstrap(&self) -> Option<&Bootstrap> {
        self.bootstrap.as_ref()
    }

    /// The recordings of heights in time, each as a fitted motion.
    #[must_use]
    pub fn series(&self) -> &[Track] {
        &self.series
    }

    /// What to be wary of.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// What was left out or mended before the fit.
    #[must_use]
    pub fn repairs(&self) -> &[String] {
        &self.repairs
    }

    /// How the table was read.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The fitted motion of the first trial, for a picture; none if the verdict is refused.
    #[must_use]
    pub fn motion(&self) -> Option<&Motion> {
        self.motion.as_ref()
    }

    /// How far each reading lies from the fitted motion of its trial.
    #[must_use]
    pub fn residuals(&self) -> &[Residual] {
        &self.residuals
    }

    /// The measured points, on the time axis of the fitted motion.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        text::write(self, f)
    }
}
