//! Measurements planned by the fit itself: readings without error are made, and fitted with the
//! errors that they would have.
//!
//! The readings of N drops have the information of one drop whose readings are √N times better, so
//! one drop is fitted.

use crate::error::FitError;
use crate::fit::Fit;
use crate::quantity::{Readings, STANDARD_GRAVITY};
use crate::read::Table;
use crate::report::{Plan, Planned, Report, Way};
use crate::statistics::{NORMAL, REPLICATED, student};
use crate::verdict::Verdict;

/// More drops than this nobody makes.
const MOST_DROPS: usize = 200;
/// Numbers of bounces that are tried: more tell hardly more.
const BOUNCES: [usize; 7] = [1, 2, 3, 4, 6, 8, 10];
/// A reading is planned where what it reads is so many standard errors large: a rebound lower, or a
/// flight shorter, is hardly made out.
const MADE_OUT: f64 = 5.0;
/// Two contacts are distinguished where they are this far apart, s: an echo, or the ringing
/// of a floor, lasts so long.
const RINGS: f64 = 0.05;
/// A next measurement is one of so many drops, which show their own spread.
const NEXT: usize = REPLICATED;

/// What is expected of a ball before it is dropped.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Expected {
    /// The COR.
    pub cor: f64,
    /// The height of the drop, m.
    pub drop_m: f64,
}

impl Default for Expected {
    /// A ball of sport dropped from a metre.
    fn default() -> Self {
        Self { cor: 0.75, drop_m: 1.0 }
    }
}

impl Expected {
    /// A COR between 0.05 and 0.99, dropped from 1 cm to 100 m; `None` of others.
    #[must_use]
    pub fn new(cor: f64, drop_m: f64) -> Option<Self> {
        ((0.05..=0.99).contains(&cor) && (0.01..=100.0).contains(&drop_m)).then_some(Self { cor, drop_m })
    }

    /// What a report says of it: the drop by the highest reading, or by the longest time between
    /// contacts.
    #[must_use]
    pub fn of(table: &Table, report: &Report) -> Option<Self> {
        let cor = report.cor()?.value;
        let readings = || table.trials().iter().flat_map(|trial| trial.readings());
        let highest = readings().filter_map(|r| r.height).fold(0.0, f64::max);
        let apart = |times: &[f64]| times.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
        let longest = table.trials().iter().map(|trial| {
            let mut times: Vec<f64> = trial.readings().iter().filter_map(|r| r.time).collect();
            times.sort_unstable_by(f64::total_cmp);
            apart(&times)
        });
        let flight = longest.fold(0.0, f64::max);
        let drop = if highest > 0.0 { highest } else { STANDARD_GRAVITY * flight * flight / (8.0 * cor * cor) };
        Self::new(cor, drop)
    }
}

/// A measurement to be judged.
#[derive(Clone, Copy, Debug)]
struct Trial {
    way: Way,
    drops: usize,
    bounces: usize,
}

impl Fit {
    /// What it takes to know a COR to within `want`, the half-width of its 95 % interval: for each
    /// way to measure the drops, and the bounces of each, with the fewest readings. What is stated
    /// of the ball and of the zero of heights is taken into account as in a fit.
    ///
    /// ```
    /// use saltus_fit::{Ball, Expected, Fit, Way};
    ///
    /// let plan = Fit::new().kind(Ball::Tennis).sigma_zero(0.002).plan(0.005, Expected::default())?;
    /// let sound = plan.ways.iter().find(|planned| planned.way == Way::Sound).expect("a bounce is heard");
    /// assert!(sound.enough && sound.drops == 1 && sound.half_width <= 0.005);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`FitError::Option`] where `want` is not between 0 and 0.5; those of [`Fit::run`].
    pub fn plan(&self, want: f64, expected: Expected) -> Result<Plan, FitError> {
        if !(want > 0.0 && want < 0.5) {
            return Err(FitError::Option { name: "the half-width that is wanted", value: want });
        }
        let mut ways = Vec::new();
        for way in Way::ALL {
            let mut best: Option<Planned> = None;
            for bounces in expected.bounces(way) {
                let Some(planned) = self.fewest(want, expected, (way, bounces))? else { continue };
                // What is enough before what is not, then the fewest readings, or the shortest
                // interval.
                let better = |b: &Planned| match (planned.enough, b.enough) {
                    (true, true) => planned.readings < b.readings,
                    (false, false) => planned.half_width < b.half_width,
                    (enough, _) => enough,
                };
                if best.as_ref().is_none_or(better) {
                    best = Some(planned);
                }
            }
            ways.extend(best);
        }
        Ok(Plan { want, cor: expected.cor, drop_m: expected.drop_m, ways })
    }

    /// The cheapest next measurement for a report that is in doubt, or whose interval is longer
    /// than `want`: five drops by the simplest way that halves the interval, or else the one that
    /// brings the shortest. Where an explanation fits whose fault is in one kind of reading, the
    /// other kind is measured. `None` for what is trusted, or where that is open.
    ///
    /// ```
    /// use saltus_fit::{Fit, Table};
    ///
    /// let (fit, table) = (Fit::new(), Table::from_heights(&[1.0, 0.50, 0.40])?);
    /// let report = fit.run(&table)?;
    /// let next = fit.next(&table, &report)?.expect("a measurement that settles it");
    /// let cor = report.cor().expect("a COR");
    /// assert!(next.drops == 5 && next.half_width < 0.5 * (cor.high - cor.low));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Fit::run`].
    pub fn next(&self, table: &Table, report: &Report) -> Result<Option<Planned>, FitError> {
        let Some((expected, cor)) = Expected::of(table, report).zip(report.cor()) else { return Ok(None) };
        if report.verdict() == Verdict::Trusted {
            return Ok(None);
        }
        let half = 0.25 * (cor.high - cor.low);
        let fault = report.hypotheses().first().filter(|hypothesis| hypothesis.fits()).and_then(|h| h.name.at_fault());
        let mut best: Option<Planned> = None;
        for way in Way::ALL.into_iter().filter(|way| Some(way.readings()) != fault) {
            let Some(bounces) = expected.bounces(way).last() else { continue };
            let Some(planned) = self.planned(half, expected, Trial { way, drops: NEXT, bounces })? else { continue };
            if planned.enough {
                return Ok(Some(planned));
            }
            if best.as_ref().is_none_or(|b| planned.half_width < b.half_width) {
                best = Some(planned);
            }
        }
        Ok(best.filter(|planned| planned.half_width < 2.0 * half))
    }

    /// The report with what may be measured next: [`Fit::next`], and where a half-width is wanted,
    /// [`Fit::plan`] for the ball of the report.
    ///
    /// # Errors
    /// Those of both.
    pub fn advised(&self, table: &Table, report: Report, want: Option<f64>) -> Result<Report, FitError> {
        let next = self.next(table, &report)?;
        let expected = Expected::of(table, &report);
        let plan = want.zip(expected).map(|(want, expected)| self.plan(want, expected)).transpose()?;
        Ok(report.with_advice(next, plan))
    }

    /// The fewest drops of so many bounces that are enough; if none are, what the most bring.
    fn fewest(&self, want: f64, expected: Expected, (way, bounces): (Way, usize)) -> Result<Option<Planned>, FitError> {
        let of = |drops: usize| self.planned(want, expected, Trial { way, drops, bounces });
        let Some(most) = of(MOST_DROPS)?.filter(|planned| planned.enough) else { return of(MOST_DROPS) };
        let (mut few, mut best) = (0, most);
        while few + 1 < best.drops {
            let middle = usize::midpoint(few, best.drops);
            match of(middle)? {
                Some(planned) if planned.enough => best = planned,
                _ => few = middle,
            }
        }
        Ok(Some(best))
    }

    /// What a measurement brings; `None` where it leaves no reading to check it by.
    fn planned(&self, want: f64, expected: Expected, trial: Trial) -> Result<Option<Planned>, FitError> {
        let Trial { way, drops, bounces } = trial;
        let sigma = way.sigma() / (drops as f64).sqrt();
        // Each drop has a height of its own, or a clock and a first flight, and all have one COR.
        let (spare, fit, table) = match way.readings() {
            Readings::Heights => (drops * bounces, self.sigma_height(sigma), expected.heights(bounces)),
            Readings::Times => (drops * (bounces - 1), self.sigma_time(sigma), expected.contacts(bounces)),
        };
        let Ok(table) = table else { return Ok(None) };
        if spare < 2 {
            return Ok(None);
        }
        let report = fit.repair(false).run(&table)?;
        let Some((cor, error)) = report.cor().and_then(|cor| Some((cor, cor.standard_error?))) else {
            return Ok(None);
        };
        // From five drops on, the spread between them is the measure, with Student's quantile.
        let quantile = if drops < REPLICATED { NORMAL } else { student(drops - 1) };
        let longer = (cor.high - cor.value).max(cor.value - cor.low);
        let half_width = (longer.powi(2) + (quantile.powi(2) - NORMAL.powi(2)) * error * error).sqrt();
        let readings = drops * (bounces + 1);
        let (enough, takes_in) = (half_width <= want, report.widened().to_vec());
        Ok(Some(Planned { way, drops, bounces, readings, half_width, enough, takes_in }))
    }
}

impl Expected {
    /// Numbers of bounces that a way makes out.
    fn bounces(self, way: Way) -> impl Iterator<Item = usize> {
        let made_out = move |bounces: &usize| {
            let height = self.drop_m * self.cor.powi(2 * *bounces as i32);
            match way.readings() {
                Readings::Heights => height >= MADE_OUT * way.sigma(),
                Readings::Times => {
                    let flight = (8.0 * height / STANDARD_GRAVITY).sqrt();
                    *bounces > 1 && flight >= (MADE_OUT * way.sigma()).max(RINGS)
                }
            }
        };
        BOUNCES.into_iter().filter(made_out)
    }

    fn heights(self, bounces: usize) -> Result<Table, crate::error::TableError> {
        let heights: Vec<f64> = (0..=bounces).map(|n| self.drop_m * self.cor.powi(2 * n as i32)).collect();
        Table::from_heights(&heights)
    }

    fn contacts(self, bounces: usize) -> Result<Table, crate::error::TableError> {
        let fall = (2.0 * self.drop_m / STANDARD_GRAVITY).sqrt();
        let flights = (1..=bounces).map(|n| 2.0 * fall * self.cor.powi(n as i32));
        let times = std::iter::once(fall).chain(flights).scan(0.0, |clock, lasts| {
            *clock += lasts;
            Some(*clock)
        });
        Table::from_contacts(&times.collect::<Vec<f64>>())
    }
}
