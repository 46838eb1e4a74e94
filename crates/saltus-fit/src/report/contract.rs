//! What a report holds; serialised, it is the JSON contract.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::motion::Motion;
use super::plan::{Plan, Planned};
use super::residual::{Point, Residual};
use crate::compare::explain::{Agreement, Hypothesis};
use crate::finding::{Finding, Widening};
use crate::quantity::Sourced;
use crate::read::LeftAside;
use crate::solve::bootstrap::Bootstrap;
use crate::solve::bounces::BounceCor;
use crate::solve::choice::ModelChoice;
use crate::solve::estimate::Estimate;
use crate::solve::profile::Profile;
use crate::solve::series::Track;
use crate::solve::tolerance::Allowed;
use crate::verdict::{Cor, Verdict};

/// What a fit found: see [`Fit::run`](crate::Fit::run). `Display` writes it for people, serde for
/// programs, which can read it back.
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    pub(super) schema: u32,
    pub(super) table: String,
    pub(super) verdict: Verdict,
    pub(super) reason: String,
    pub(super) cor: Option<Cor>,
    pub(super) trials: usize,
    pub(super) gravity: Sourced,
    pub(super) sigma_height: Option<Sourced>,
    pub(super) sigma_time: Option<Sourced>,
    pub(super) frame_rate: Option<f64>,
    pub(super) estimates: Vec<Estimate>,
    pub(super) bounces: Vec<BounceCor>,
    pub(super) agreement: Option<Agreement>,
    pub(super) hypotheses: Vec<Hypothesis>,
    pub(super) models: Vec<ModelChoice>,
    pub(super) allowed: Vec<Allowed>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) profiles: Vec<Profile>,
    pub(super) bootstrap: Option<Bootstrap>,
    pub(super) series: Vec<Track>,
    /// What was found, that which the verdict rests on first.
    pub(super) findings: Vec<Finding>,
    /// What the interval takes in beside the error of the COR.
    pub(super) widened: Vec<Widening>,
    pub(super) warnings: Vec<String>,
    pub(super) repairs: Vec<String>,
    pub(super) notes: Vec<String>,
    /// What the files hold and was not used.
    #[serde(default)]
    pub(super) left_aside: Vec<LeftAside>,
    /// The fits of several groups, which have no COR together.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) groups: Vec<Group>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) differences: Vec<Difference>,
    /// The next measurement, of a doubtful COR.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) next: Option<Planned>,
    /// What it takes to know the COR as well as is wanted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) plan: Option<Plan>,
    /// The files of the table, where there are several.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) files: Vec<String>,
    /// Heights are in pixels.
    #[serde(default)]
    pub(super) pixels: bool,
    /// The diameter of the ball, m, where it was stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) ball_m: Option<f64>,
    /// Height and velocity at the start as they were read, where the motion begins with a reading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) start: Option<[f64; 2]>,
    /// The fitted motions, of the first trials.
    pub(super) motions: Vec<Motion>,
    // Readings beside the motions: a picture has them, the table has them too.
    #[serde(skip)]
    pub(super) residuals: Vec<Residual>,
    #[serde(skip)]
    pub(super) points: Vec<Point>,
}

/// One of several groups of a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Group {
    /// What tells it from the others: `golf`, `wood`, the name of a sheet.
    pub name: String,
    /// Its fit.
    pub report: Report,
}

/// By how much the COR of one group is above that of another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Difference {
    /// The group with the greater COR.
    pub greater: String,
    /// The other.
    pub less: String,
    /// The difference of their CORs.
    pub value: f64,
    /// Its standard error, where both have one: the root of the sum of squares.
    pub standard_error: Option<f64>,
    /// The lower end of its 95 % interval.
    pub low: f64,
    /// The upper end of its 95 % interval.
    pub high: f64,
}

impl Report {
    /// The cheapest next measurement, where [`Fit::advised`](crate::Fit::advised) was asked and the
    /// COR is in doubt.
    #[must_use]
    pub const fn next(&self) -> Option<&Planned> {
        self.next.as_ref()
    }

    /// What it takes to know the COR as well as was wanted of
    /// [`Fit::advised`](crate::Fit::advised).
    #[must_use]
    pub const fn plan(&self) -> Option<&Plan> {
        self.plan.as_ref()
    }

    /// The report with what may be measured next.
    pub(crate) fn with_advice(self, next: Option<Planned>, plan: Option<Plan>) -> Self {
        Self { next, plan, ..self }
    }

    /// What the files hold and was not used, each with its place and the reason.
    #[must_use]
    pub fn left_aside(&self) -> &[LeftAside] {
        &self.left_aside
    }

    /// The name of the table.
    #[must_use]
    pub fn table(&self) -> &str {
        &self.table
    }

    /// What the table is about, after its name: `squash-on-cement.csv` is about "Squash on cement".
    /// Up to three files are listed, more are counted.
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

    /// The error by drawing whole trials anew, where that was asked for and there are five trials
    /// or more.
    #[must_use]
    pub fn bootstrap(&self) -> Option<&Bootstrap> {
        self.bootstrap.as_ref()
    }

    /// The recordings of heights in time, each as a fitted motion.
    #[must_use]
    pub fn series(&self) -> &[Track] {
        &self.series
    }

    /// What was found beside the COR, as data: what the verdict rests on first, then what speaks
    /// against the COR, then the rest.
    ///
    /// ```
    /// use saltus_fit::{Fit, FindingKind, Severity, Table};
    /// let report = Fit::new().run(&Table::from_heights(&[1.0, 0.64])?)?;
    /// let doubt = &report.findings()[0];
    /// assert_eq!(doubt.severity, Severity::Doubt);
    /// assert!(matches!(doubt.kind, FindingKind::JustEnough { .. }));
    /// assert_eq!(doubt.to_string(), report.reason());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// What the interval takes in beside the error of the COR.
    #[must_use]
    pub fn widened(&self) -> &[Widening] {
        &self.widened
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
        self.motions.first()
    }

    /// The fitted motion of each trial that has one, in the order of the table.
    #[must_use]
    pub fn motions(&self) -> &[Motion] {
        &self.motions
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
