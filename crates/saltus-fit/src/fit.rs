//! From a table to a report.

use crate::bootstrap;
use crate::bounces::{self, Setting};
use crate::choice::CorModel;
use crate::diagnose::{self, Findings};
use crate::error::FitError;
use crate::estimate::{self, Kind, Source, Sourced, one_kind};
use crate::evidence::Evidence;
use crate::joint;
use crate::model::{Contacts, Heights};
use crate::motion;
use crate::outliers;
use crate::ratio;
use crate::report::Report;
use crate::robust::Loss;
use crate::series;
use crate::table::{Event, Reading, Table};
use crate::tolerance;
use crate::weigh;

/// Gravity where nobody states it, m/s².
const GRAVITY: f64 = 9.81;
/// More lines of repairs than this are counted, not listed.
const LISTED: usize = 20;

/// What is known beside the table, and the fit itself.
///
/// ```
/// use saltus_fit::{Fit, ReadOptions, Table, Verdict};
///
/// let csv = b"# frame rate: 30\nevent,time_s,height_cm\nrelease,0,100\ncontact,0.45,\napex,,30\ncontact,0.85,\napex,,10\ncontact,1.11,\n";
/// let table = Table::parse("squash.csv", csv, &ReadOptions::default())?;
/// let report = Fit::new().gravity(9.8).run(&table)?;
///
/// // Heights say 0.56 and times say 0.54, but no one COR holds both columns: it is not given a small error.
/// assert_eq!(report.verdict(), Verdict::Doubtful);
/// let cor = report.cor().expect("a doubtful table still has a range");
/// assert!(cor.low < 0.443 && cor.high > 0.650);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Fit {
    sigma_height: Option<f64>,
    sigma_time: Option<f64>,
    gravity: Option<f64>,
    no_repair: bool,
    /// Which of [`Loss::ALL`].
    losses: [bool; Loss::ALL.len()],
    profiles: bool,
    tolerance_height: Option<f64>,
    tolerance_time: Option<f64>,
    bootstrap: Option<(usize, u64)>,
    ball: Option<f64>,
    model: Option<CorModel>,
}

impl Fit {
    /// A fit with nothing stated: reading errors come from the table, its frame rate, the scatter, or are assumed (1 cm, 10 ms).
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The standard error of a height reading, in metres. It yields to an error column of the table.
    #[must_use]
    pub fn sigma_height(mut self, metres: f64) -> Self {
        self.sigma_height = Some(metres);
        self
    }

    /// The standard error of a time reading, in seconds. It yields to an error column of the table.
    #[must_use]
    pub fn sigma_time(mut self, seconds: f64) -> Self {
        self.sigma_time = Some(seconds);
        self
    }

    /// Gravity, in m/s²; without it that of the table, else 9.81. It matters only where heights meet times.
    #[must_use]
    pub fn gravity(mut self, metres_per_second_squared: f64) -> Self {
        self.gravity = Some(metres_per_second_squared);
        self
    }

    /// The diameter of the ball, in metres: the zero of the height scale is supposed to be off by no more. Without it, that of a basketball.
    #[must_use]
    pub fn ball(mut self, metres: f64) -> Self {
        self.ball = Some(metres);
        self
    }

    /// Also gives the cost of each method as the COR is held at other values: see [`Report::profiles`]. It counts the reading errors alone, not how
    /// much drops differ; a series has none.
    ///
    /// ```
    /// use saltus_fit::{Fit, Table};
    /// let table = Table::from_heights(&[1.0, 0.64, 0.41, 0.26])?;
    /// let report = Fit::new().sigma_height(0.005).profiles(true).run(&table)?;
    /// let points = &report.profiles()[0].points;
    /// let best = points.iter().min_by(|a, b| a.chi_square.total_cmp(&b.chi_square)).unwrap();
    /// assert!((best.cor - 0.8).abs() < 0.003);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn profiles(mut self, wanted: bool) -> Self {
        self.profiles = wanted;
        self
    }

    /// Lets the COR of the report be that of this model, where the readings can tell of it.
    #[must_use]
    pub fn model(mut self, model: CorModel) -> Self {
        self.model = Some(model);
        self
    }

    /// Whether contacts that were missed, counted twice or misread, and outliers, are found and mended before the fit: so it is by default.
    /// Every repair is listed in the report.
    #[must_use]
    pub fn repair(mut self, wanted: bool) -> Self {
        self.no_repair = !wanted;
        self
    }

    /// Also gives the COR by these losses, without an error: of heights and of times as estimates whose names end in those of the losses, of the
    /// models that are not out of the question as [`ModelChoice::losses`](crate::ModelChoice::losses).
    ///
    /// ```
    /// use saltus_fit::{Fit, Loss, Table};
    /// let table = Table::from_heights(&[1.0, 0.64, 0.41, 0.262, 0.168])?;
    /// let report = Fit::new().losses(&[Loss::Huber]).run(&table)?;
    /// let huber = report.estimates().iter().find(|e| e.method == "heights-huber").unwrap();
    /// assert!((huber.value.unwrap() - 0.8).abs() < 0.005);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn losses(mut self, wanted: &[Loss]) -> Self {
        self.losses = Loss::ALL.map(|loss| wanted.contains(&loss));
        self
    }

    /// Trusts every height to within this, in metres, and asks which CORs that allows: see [`Report::allowed`].
    #[must_use]
    pub fn tolerance_height(mut self, metres: f64) -> Self {
        self.tolerance_height = Some(metres);
        self
    }

    /// Trusts every time to within this, in seconds, and asks which CORs that allows: see [`Report::allowed`].
    #[must_use]
    pub fn tolerance_time(mut self, seconds: f64) -> Self {
        self.tolerance_time = Some(seconds);
        self
    }

    /// Also draws whole trials anew so many times, from this seed, and refits: see [`Report::bootstrap`].
    #[must_use]
    pub fn bootstrap(mut self, rounds: usize, seed: u64) -> Self {
        self.bootstrap = Some((rounds, seed));
        self
    }

    /// Fits the COR.
    ///
    /// A table that does not determine a COR gives a report whose verdict is [`Verdict::Refused`](crate::Verdict::Refused).
    ///
    /// # Errors
    /// [`FitError::Option`] for an option that is not positive and finite; [`FitError::Solver`] if a least-squares solution does
    /// not pass its checks.
    pub fn run(&self, table: &Table) -> Result<Report, FitError> {
        self.run_with(table, &mut |_| {})
    }

    /// The same, telling how many rounds of the bootstrap are done.
    ///
    /// # Errors
    /// Those of [`Fit::run`].
    pub fn run_with(&self, table: &Table, progress: &mut dyn FnMut(usize)) -> Result<Report, FitError> {
        self.check()?;
        let gravity = sourced(self.gravity, table.metadata.gravity)
            .unwrap_or(Sourced { value: GRAVITY, source: Source::Assumed });
        let frame = table.metadata.frame_rate.map(|rate| 1.0 / rate);
        let known_height =
            sourced(self.sigma_height, table.metadata.sigma_height).or(stated_by_rows(table, |r| r.sigma_height));
        let known_time = sourced(self.sigma_time, table.metadata.sigma_time)
            .or(stated_by_rows(table, |r| r.sigma_time))
            .or(frame.map(|frame| Sourced { value: frame / 12f64.sqrt(), source: Source::FrameRate }));
        let mut evidence = Evidence::of(table, known_time.map(|s| s.value), !self.no_repair);
        if !self.no_repair {
            let error = |known: Option<Sourced>| (known.map_or(0.01, |s| s.value), known.is_some());
            let (sigma, stated) = error(known_height);
            let drop = |evidence: &mut Evidence, wrong: &[(usize, usize)]| evidence.drop_heights(table, wrong);
            evidence = outliers::without::<Heights>(evidence, sigma, stated, drop)?;
            let (sigma, stated) = error(known_time);
            // Where bounces scatter, times have errors that add up, and none stands alone.
            if stated {
                let drop = |evidence: &mut Evidence, wrong: &[(usize, usize)]| evidence.drop_moments(table, wrong);
                evidence = outliers::without::<Contacts>(evidence, sigma, stated, drop)?;
            }
        }
        if table.metadata.intervals && estimate::add_up(&evidence, known_time)? {
            evidence.trials.iter_mut().for_each(|t| t.added_up = true);
        }
        let heights: Option<Kind<Heights>> = one_kind(&evidence, known_height)?;
        let times: Option<Kind<Contacts>> = estimate::times(&evidence, known_time)?;
        let assumed = Sourced { value: 0.01, source: Source::Assumed };
        let sigma_height = heights.as_ref().map(|k| k.sigma).or(known_height).unwrap_or(assumed);
        let sigma_time = times.as_ref().map(|k| k.sigma).or(known_time).unwrap_or(assumed);
        let setting =
            Setting { gravity: gravity.value, sigma_height: sigma_height.value, sigma_time: sigma_time.value };

        let mut report = Report::new(table.name(), gravity);
        report.ball = self.ball;
        report.pixels = table.metadata.pixels;
        report.files.clone_from(&table.files);
        let has = |event: fn(&Reading) -> bool| table.trials().iter().any(|t| t.readings().iter().any(event));
        report.sigma_height =
            (table.zero_rebounds > 0 || has(|r| r.event == Event::Apex && r.height.is_some())).then_some(sigma_height);
        report.sigma_time = has(|r| r.event == Event::Contact).then_some(sigma_time);
        report.frame_rate = table.metadata.frame_rate;
        report.trials = table.trials().len();
        report.notes.clone_from(&table.notes);
        report.repairs = listed(table.repairs.iter().chain(&evidence.repairs));
        report.warnings.clone_from(&table.warnings);
        report.bounces = bounces::list(&evidence, &setting);

        if heights.is_none()
            && times.is_none()
            && let Some(found) = series::fit(table, !self.no_repair)?
        {
            series::judge(&mut report, &found);
            (report.motion, report.points, report.residuals) = found.picture();
            report.series = found.tracks;
            if self.model.is_some() {
                report
                    .warnings
                    .push("a series chooses its model by itself: what was asked for is not heeded".to_owned());
            }
            return Ok(report);
        }

        let joint = joint::joint(&evidence, gravity.value, sigma_height.value, sigma_time.value)?;
        if let Some(joint) = &joint {
            let agreement = joint::agreement(joint, &evidence, gravity.value, table.metadata.frame_rate);
            if agreement.p.is_some_and(|p| p < diagnose::REJECT) {
                if joint.thinned() > 1 {
                    report.notes.push(format!("what could explain it was tried on one trial in {}", joint.thinned()));
                }
                report.hypotheses = joint::hypotheses(joint, sigma_height.value, sigma_time.value, frame)?;
            }
            report.agreement = Some(agreement);
        } else if let Some(kind) = heights.as_ref().filter(|k| k.trend.is_some_and(|p| p < diagnose::REJECT)) {
            let one_cor = (kind.fitted.shared[0].exp(), gravity.value, sigma_height.value);
            report.hypotheses.extend(joint::height_zero(&evidence, one_cor)?);
        }
        let means = bounces::means(&evidence, &setting);
        let read_as_zero = evidence.trials.iter().any(|t| !t.zeros.is_empty());
        let ratio = if read_as_zero || self.losses.contains(&true) {
            ratio::estimate(&evidence, sigma_height.value)
        } else {
            None
        };
        let findings = Findings {
            heights,
            times,
            means,
            joint,
            table,
            evidence: &evidence,
            sigma_height: sigma_height.value,
            ball: self.ball,
            ratio,
        };
        diagnose::judge(&mut report, &findings);
        if let Some((kind, within)) = findings.heights.as_ref().zip(self.tolerance_height) {
            report.allowed.extend(tolerance::allowed(&evidence, kind, within)?);
        }
        if let Some((kind, within)) = findings.times.as_ref().zip(self.tolerance_time) {
            report.allowed.extend(tolerance::allowed(&evidence, kind, within)?);
        }
        if self.profiles {
            report.profiles = findings.profiles();
        }
        if let Some(draws) = self.bootstrap {
            let setting = bootstrap::Setting {
                gravity: gravity.value,
                sigma_height,
                sigma_time,
                joint: findings.joint.is_some(),
                times: findings.times.is_some(),
            };
            report.bootstrap = bootstrap::run(&evidence, &setting, draws, progress)?;
            if report.bootstrap.is_none() {
                report.warnings.push("no bootstrap: it draws whole trials, and needs at least five".to_owned());
            }
        }
        let losses: Vec<Loss> =
            Loss::ALL.into_iter().zip(self.losses).filter(|(_, wanted)| *wanted).map(|(loss, _)| loss).collect();
        let (models, losses) = rayon::join(
            || diagnose::models(&mut report, &findings, (sigma_height, sigma_time), (&losses, self.model)),
            || findings.losses(&losses),
        );
        let compared = models?;
        report.models = compared.models;
        report.estimates.extend(losses?);
        if let Some(wanted) = self.model {
            weigh::rest_on(&mut report, wanted, compared.untried.as_deref());
        }

        let (motions, release_is_fitted) = match (&findings.joint, &findings.times, &findings.heights) {
            (Some(joint), _, _) => (motion::of_joint(joint, &evidence), false),
            (None, Some(times), _) => (motion::of_times(times, &evidence, gravity.value), false),
            (None, None, Some(heights)) => (motion::of_heights(heights, &evidence, gravity.value), true),
            (None, None, None) => (Vec::new(), false),
        };
        let sigmas = (sigma_height.value, sigma_time.value);
        (report.points, report.residuals) = motion::beside(&motions, &evidence, sigmas, release_is_fitted);
        report.motion = motions.into_iter().next().map(|(_, motion)| motion);
        Ok(report)
    }

    fn check(&self) -> Result<(), FitError> {
        let options = [
            ("the standard error of heights", self.sigma_height),
            ("the standard error of times", self.sigma_time),
            ("gravity", self.gravity),
            ("the size of the ball", self.ball),
            ("the tolerance of heights", self.tolerance_height),
            ("the tolerance of times", self.tolerance_time),
        ];
        for (name, value) in options {
            if let Some(value) = value.filter(|v| !v.is_finite() || *v <= 0.0) {
                return Err(FitError::Option { name, value });
            }
        }
        Ok(())
    }
}

fn sourced(stated: Option<f64>, table: Option<f64>) -> Option<Sourced> {
    let stated = stated.map(|value| Sourced { value, source: Source::Stated });
    stated.or(table.map(|value| Sourced { value, source: Source::Table }))
}

/// The root mean square of the errors that rows state; it stands for the error of a row that states none.
#[allow(clippy::cast_precision_loss)]
fn stated_by_rows(table: &Table, sigma: fn(&Reading) -> Option<f64>) -> Option<Sourced> {
    let stated = || table.trials().iter().flat_map(|t| t.readings()).filter_map(sigma);
    let count = stated().count();
    let value = (stated().map(|s| s * s).sum::<f64>() / count as f64).sqrt();
    (count > 0 && value.is_finite() && value > 0.0).then_some(Sourced { value, source: Source::Table })
}

/// The first lines, and how many more there are.
fn listed<'a>(lines: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut lines: Vec<String> = lines.cloned().collect();
    if lines.len() > LISTED {
        let more = lines.len() - LISTED;
        lines.truncate(LISTED);
        lines.push(format!("and {more} more of the kind"));
    }
    lines
}
