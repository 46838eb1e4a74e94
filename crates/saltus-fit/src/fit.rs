//! From a table to a report: the stages in order.

use std::borrow::Cow;
use std::ops::ControlFlow;

use crate::compare::{self, Wanted};
use crate::error::FitError;
use crate::evidence::Evidence;
use crate::finding::FindingKind;
use crate::model::{Contacts, Heights};
use crate::quantity::{Ball, CorModel, Loss, STANDARD_GRAVITY, Source, Sourced};
use crate::read::{Reading, Table};
use crate::report::{Extras, Group, Report};
use crate::solve::bootstrap::Progress;
use crate::solve::fits::{Fits, Known};
use crate::solve::one::OneKind;
use crate::solve::series::{self, Series};
use crate::solve::{bootstrap, kind, outliers, tolerance};
use crate::verdict::{self, Cor, Stated};

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
    drag: Option<f64>,
    sigma_zero: Option<f64>,
    sigma_scale: Option<f64>,
    model: Option<CorModel>,
    /// The ball that the table names.
    named: Option<Ball>,
    /// The readings are those of one group.
    within: bool,
}

impl Fit {
    /// A fit with nothing stated: reading errors come from the table, its frame rate, the scatter,
    /// or are assumed (1 cm, 10 ms).
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The standard error of a height reading, in metres. It yields to an error column of the
    /// table.
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

    /// Gravity, in m/s²; without it that of the table, else 9.81. It matters only where heights
    /// meet times.
    #[must_use]
    pub fn gravity(mut self, metres_per_second_squared: f64) -> Self {
        self.gravity = Some(metres_per_second_squared);
        self
    }

    /// The diameter of the ball, in metres: the zero of the height scale is supposed to be off by
    /// no more. Without it, that of a basketball.
    #[must_use]
    pub fn ball(mut self, metres: f64) -> Self {
        self.ball = Some(metres);
        self
    }

    /// The kind of ball: it states the diameter and the drag.
    ///
    /// ```
    /// use saltus_fit::{Ball, Fit, Table};
    /// let table = Table::from_heights(&[1.0, 0.64, 0.41, 0.26])?;
    /// let cor = Fit::new().kind(Ball::Squash).run(&table)?.cor().copied().expect("a COR");
    /// assert!((cor.value - 0.808).abs() < 0.001);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn kind(self, ball: Ball) -> Self {
        self.ball(ball.diameter()).drag(ball.drag())
    }

    /// The drag coefficient k of v' = −g ∓ k v², in 1/m: 0 in a vacuum, 0.016 of a squash ball,
    /// 0.13 of a table-tennis ball. The motion is fitted with it, and nothing is allowed for beside
    /// it. Without it any up to that of a table-tennis ball is allowed for in the interval, as far
    /// as the readings do not rule it out.
    ///
    /// ```
    /// use saltus_fit::{Fit, Table};
    /// let table = Table::from_heights(&[1.0, 0.64, 0.41, 0.26])?;
    /// let cor = |fit: Fit| *fit.sigma_height(0.005).run(&table).unwrap().cor().unwrap();
    /// let (unknown, none, squash) = (cor(Fit::new()), cor(Fit::new().drag(0.0)), cor(Fit::new().drag(0.016)));
    /// assert!(unknown.high > none.high && squash.value > none.value + 0.005);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn drag(mut self, per_metre: f64) -> Self {
        self.drag = Some(per_metre);
        self
    }

    /// By how far the zero of the height scale may be off, in metres (a standard error): 0 where
    /// heights are those of the bottom of the ball above the floor, and that was checked with the
    /// ball at rest. Without it, it may be off by a ball at most, up or down, as far as the
    /// chi-square of the readings allows.
    #[must_use]
    pub fn sigma_zero(mut self, metres: f64) -> Self {
        self.sigma_zero = Some(metres);
        self
    }

    /// By which part lengths may be wrong (a standard error): 0 where the rule, or the scale of the
    /// picture, was checked in the plane of the ball. It matters only where heights meet times.
    /// Without it, lengths may be wrong by a tenth, as far as the chi-square of the readings allows
    /// that.
    ///
    /// ```
    /// use saltus_fit::{Fit, ReadOptions, Table};
    /// let text = "event,time_s,height_m\nrelease,0,1\ncontact,0.45,\napex,,0.64\ncontact,1.17,\napex,,0.41\n";
    /// let table = Table::parse("drop.csv", text.as_bytes(), &ReadOptions::default())?;
    /// let length = |fit: Fit| fit.run(&table).unwrap().cor().map(|cor| cor.high - cor.low).unwrap();
    /// assert!(length(Fit::new().sigma_scale(0.0)) < length(Fit::new()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn sigma_scale(mut self, part: f64) -> Self {
        self.sigma_scale = Some(part);
        self
    }

    /// Also gives the cost of each method as the COR is held at other values: see
    /// [`Report::profiles`]. It counts the reading errors alone, not how much drops differ; a
    /// series has none.
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

    /// Whether contacts that were missed, counted twice or misread, and outliers, are found and
    /// mended before the fit: so it is by default. Every repair is listed in the report.
    #[must_use]
    pub fn repair(mut self, wanted: bool) -> Self {
        self.no_repair = !wanted;
        self
    }

    /// Also gives the COR by these losses, without an error: of heights and of times as estimates
    /// whose names end in those of the losses, of the models that are not out of the question as
    /// [`ModelChoice::losses`](crate::ModelChoice::losses).
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

    /// Trusts every height to within this, in metres, and asks which CORs that allows: see
    /// [`Report::allowed`].
    #[must_use]
    pub fn tolerance_height(mut self, metres: f64) -> Self {
        self.tolerance_height = Some(metres);
        self
    }

    /// Trusts every time to within this, in seconds, and asks which CORs that allows: see
    /// [`Report::allowed`].
    #[must_use]
    pub fn tolerance_time(mut self, seconds: f64) -> Self {
        self.tolerance_time = Some(seconds);
        self
    }

    /// Also draws whole trials anew so many times, from this seed, and refits: see
    /// [`Report::bootstrap`].
    #[must_use]
    pub fn bootstrap(mut self, rounds: usize, seed: u64) -> Self {
        self.bootstrap = Some((rounds, seed));
        self
    }

    /// Fits the COR.
    ///
    /// A table that does not determine a COR gives a report whose verdict is
    /// [`Verdict::Refused`](crate::Verdict::Refused).
    ///
    /// # Errors
    /// [`FitError::Option`] for an option that is not positive and finite; [`FitError::Solver`] if
    /// a least-squares solution does not pass its checks.
    pub fn run(&self, table: &Table) -> Result<Report, FitError> {
        self.run_with(table, &mut |_| ControlFlow::Continue(()))
    }

    /// The same, telling how many rounds of the bootstrap are done; `Break` ends the fit between
    /// two rounds, and between two groups of the table.
    ///
    /// # Errors
    /// Those of [`Fit::run`], and [`FitError::Ended`].
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use saltus_fit::{Fit, FitError, Table};
    /// let table = Table::from_heights(&[1.0, 0.64, 0.41, 0.26])?;
    /// let ended = Fit::new().run_with(&table, &mut |_| ControlFlow::Break(()));
    /// assert_eq!(ended.unwrap_err(), FitError::Ended);
    /// # Ok::<(), saltus_fit::TableError>(())
    /// ```
    pub fn run_with(&self, table: &Table, progress: Progress<'_>) -> Result<Report, FitError> {
        self.check()?;
        let groups = table.groups();
        if progress(0).is_break() {
            return Err(FitError::Ended);
        }
        if groups.len() > 1 {
            let own = Self { within: true, ..*self };
            let fit = |name: &&str| Ok(Group::new(name, own.run_with(&table.of_group(name), progress)?));
            let groups: Vec<Group> = groups.iter().map(fit).collect::<Result<_, FitError>>()?;
            let like = groups[0].report.clone();
            return Ok(Report::of_groups(table, groups, &like));
        }
        if let Some(ball) = self.named_by(table) {
            let named = Self { named: Some(ball), ..self.ball(ball.diameter()) };
            let fit = if named.air_shows(table, ball)? { named.drag(ball.drag()) } else { named };
            return fit.run_with(table, progress);
        }
        if let Some(drops) = table.by_drops().filter(|_| !self.within)
            && self.differ(&drops)?
        {
            return self.run_with(&drops, progress);
        }
        let as_read = table;
        let (table, known) = self.scaled(table);
        let table = &*table;
        let mut evidence = self.evidence(table, &known)?;
        if let Some(drag) = self.drag.filter(|drag| *drag > 0.0) {
            evidence = verdict::in_a_vacuum(table, evidence, (&known, drag))?;
        }
        let fits = Fits::of(table, &evidence, &known, self.losses.contains(&true))?;
        if !fits.any()
            && let Some(series) = series::fit(table, !self.no_repair, self.drag_of_films(table))?
        {
            return Ok(self.report_of_recordings(&fits, series));
        }
        let mut comparison = compare::all(&fits, &self.wanted())?;
        let extras = self.extras(&fits, progress)?;
        let mut judgement = verdict::of_readings(&fits, &mut comparison, self.model, (&known, self.stated()));
        let beside = |kind: &FindingKind| match kind {
            FindingKind::AsideDiffers { column, .. } => as_read.apart_by(column),
            _ => None,
        };
        if let Some(apart) = judgement.findings.iter().find_map(|f| beside(&f.kind)).filter(|_| !self.within) {
            return self.run_with(&apart, progress);
        }
        if let Some(ball) = self.named {
            judgement.note(FindingKind::BallNamed { ball, air: self.drag.is_some() });
        }
        if self.bootstrap.is_some() && extras.bootstrap.is_none() {
            judgement.note(FindingKind::NoBootstrap { trials: evidence.trials.len() });
        }
        Ok(Report::build(&fits, comparison, extras, judgement, self.ball))
    }

    /// Whether the groups of a table are surely of several balls.
    fn differ(&self, table: &Table) -> Result<bool, FitError> {
        let own = Self { within: true, ..*self };
        let cor = |name: &str| Ok(own.run(&table.of_group(name))?.cor().copied());
        let cors: Vec<Cor> =
            table.groups().into_iter().filter_map(|name| cor(name).transpose()).collect::<Result<_, FitError>>()?;
        Ok(cors.iter().enumerate().any(|(n, one)| cors[..n].iter().any(|other| one.is_apart(other))))
    }

    /// Whether the readings of a ball that the table names are better explained with its air.
    fn air_shows(&self, table: &Table, ball: Ball) -> Result<bool, FitError> {
        let (table, known) = self.scaled(table);
        let evidence = self.evidence(&table, &known)?;
        verdict::air_shows(&table, &evidence, (&known, ball.drag()))
    }

    /// The ball that the table names, where nothing is stated of it.
    fn named_by(&self, table: &Table) -> Option<Ball> {
        if self.ball.or(self.drag).is_some() {
            return None;
        }
        let ball = table.trials().first()?.ball?;
        table.trials().iter().all(|trial| trial.ball == Some(ball)).then_some(ball)
    }

    /// The table with what follows from the gravity that is known, and what is known of it.
    fn scaled<'a>(&self, table: &'a Table) -> (Cow<'a, Table>, Known) {
        let sized = table.sized(self.known(table).gravity.value);
        let known = self.known(&sized);
        let sigma_time = known.sigma_time.map_or(Contacts::ASSUMED, |s| s.value);
        (Table::at_gravity(sized, known.gravity.value, sigma_time), known)
    }

    /// What is known before anything is fitted: gravity, and the errors of reading as far as
    /// somebody states them.
    fn known(&self, table: &Table) -> Known {
        let gravity = sourced(self.gravity, table.metadata.gravity)
            .unwrap_or(Sourced { value: STANDARD_GRAVITY, source: Source::Assumed });
        let frame = table.metadata.frame_rate.map(|rate| 1.0 / rate);
        let sigma_height =
            sourced(self.sigma_height, table.metadata.sigma_height).or(stated_by_rows(table, |r| r.sigma_height));
        let sigma_time = sourced(self.sigma_time, table.metadata.sigma_time)
            .or(stated_by_rows(table, |r| r.sigma_time))
            .or(frame.map(|frame| Sourced { value: frame / 12f64.sqrt(), source: Source::FrameRate }));
        Known { gravity, sigma_height, sigma_time, frame }
    }

    /// The readings in order, without those that are none of the ball.
    fn evidence(&self, table: &Table, known: &Known) -> Result<Evidence, FitError> {
        let mut evidence = Evidence::of(table, known.sigma_time.map(|s| s.value), !self.no_repair);
        if !self.no_repair {
            let drop = |evidence: &mut Evidence, wrong: &[(usize, usize)]| evidence.drop_heights(table, wrong);
            evidence = outliers::without::<Heights>(evidence, known.sigma_height, drop)?;
            // Where bounces scatter, times have errors that add up, and none stands alone.
            if known.sigma_time.is_some() {
                let drop = |evidence: &mut Evidence, wrong: &[(usize, usize)]| evidence.drop_moments(table, wrong);
                evidence = outliers::without::<Contacts>(evidence, known.sigma_time, drop)?;
            }
        }
        if table.metadata.intervals && kind::add_up(&evidence, known.sigma_time)? {
            evidence.trials.iter_mut().for_each(|t| t.added_up = true);
        }
        Ok(evidence)
    }

    /// What is stated of what the readings cannot show.
    fn stated(&self) -> Stated {
        Stated {
            ball: self.ball,
            sigma_zero: self.sigma_zero,
            sigma_scale: self.sigma_scale,
            drag: self.drag,
            named: self.named,
        }
    }

    /// What the caller wants of the comparison with other models.
    fn wanted(&self) -> Wanted {
        let losses = Loss::ALL.into_iter().zip(self.losses).filter(|(_, wanted)| *wanted);
        Wanted { losses: losses.map(|(loss, _)| loss).collect(), model: self.model, ball: self.ball }
    }

    /// What is computed where it was asked for: the CORs that tolerances allow, profiles of the
    /// cost, a bootstrap.
    fn extras(&self, fits: &Fits<'_>, progress: Progress<'_>) -> Result<Extras, FitError> {
        let mut extras = Extras::default();
        if let Some((kind, within)) = fits.heights.as_ref().zip(self.tolerance_height) {
            extras.allowed.extend(tolerance::allowed(fits.evidence, kind, within)?);
        }
        if let Some((kind, within)) = fits.times.as_ref().zip(self.tolerance_time) {
            extras.allowed.extend(tolerance::allowed(fits.evidence, kind, within)?);
        }
        if self.profiles {
            extras.profiles = fits.profiles();
        }
        if let Some(draws) = self.bootstrap {
            extras.bootstrap = bootstrap::run(fits, draws, progress)?;
        }
        Ok(extras)
    }

    /// The drag that is stated, or that of the ball that the table names, 1/m; none where nothing
    /// shows how fast the ball flew in metres a second: at a rate that stands in for another, and,
    /// but for what is stated, where gravity does not check the clock.
    fn drag_of_films(&self, table: &Table) -> Option<f64> {
        let named = || self.named.map(Ball::drag).filter(|_| table.falls_as_due());
        self.drag.or_else(named).filter(|_| !table.at_any_rate())
    }

    fn report_of_recordings(&self, fits: &Fits<'_>, series: Series) -> Report {
        let (mut judgement, estimates, models) = verdict::of_recordings(fits, &series);
        match (self.drag_of_films(fits.table), self.named) {
            (Some(_), Some(ball)) => judgement.note(FindingKind::BallNamed { ball, air: true }),
            (None, _) if self.drag.is_some() || self.named.is_some() => judgement.note(FindingKind::DragNotHeeded),
            _ => {}
        }
        if self.model.is_some() {
            judgement.note(FindingKind::ModelNotHeeded);
        }
        Report::build_of_recordings(fits, series, estimates, models, judgement)
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
        // None at all is as good as any.
        let none_or_more = [
            ("drag", self.drag),
            ("the error of the zero", self.sigma_zero),
            ("the error of the scale", self.sigma_scale),
        ];
        for (name, value) in none_or_more {
            if let Some(value) = value.filter(|v| !v.is_finite() || *v < 0.0) {
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

/// The root mean square of the errors that rows state; it stands for the error of a row that states
/// none.
fn stated_by_rows(table: &Table, sigma: fn(&Reading) -> Option<f64>) -> Option<Sourced> {
    let stated = || table.trials().iter().flat_map(|t| t.readings()).filter_map(sigma);
    let count = stated().count();
    let value = (stated().map(|s| s * s).sum::<f64>() / count as f64).sqrt();
    (count > 0 && value.is_finite() && value > 0.0).then_some(Sourced { value, source: Source::Table })
}
