//! What the readings of a table say, trial by trial, in the form the models ask for.

use crate::model::{FlightTrial, Height, Moment};
use crate::statistics::median;
use crate::table::{Event, Table};

/// Intervals are compared with the run before them only where there are at least this many ratios to tell the usual one.
const RATIOS: usize = 4;
/// A next interval this much shorter or longer than expected ends the run.
const SHORT: f64 = 2.0 / 3.0;
const LONG: f64 = 1.25;

/// The evidence of one trial.
#[derive(Clone, Debug, Default)]
pub(crate) struct TrialEvidence {
    /// Its place among the trials of the table.
    pub(crate) trial: usize,
    pub(crate) release_height: Option<(f64, Option<f64>)>,
    pub(crate) release_time: Option<f64>,
    /// Number of contacts before, height, stated error; the release is number 0.
    pub(crate) heights: Vec<(usize, f64, Option<f64>)>,
    /// Flights since contact 1, whether at an apex, time, stated error.
    pub(crate) moments: Vec<(usize, bool, f64, Option<f64>)>,
}

/// The evidence of a table.
#[derive(Clone, Debug, Default)]
pub(crate) struct Evidence {
    pub(crate) trials: Vec<TrialEvidence>,
    pub(crate) repairs: Vec<String>,
}

impl Evidence {
    /// Sorts the readings of a table into heights and moments; `sigma_time` is the error stated for times, if any.
    pub(crate) fn of(table: &Table, sigma_time: Option<f64>) -> Self {
        let mut evidence = Self::default();
        for (trial, source) in table.trials().iter().enumerate() {
            let mut found = TrialEvidence { trial, ..TrialEvidence::default() };
            for r in source.readings() {
                match r.event {
                    Event::Release => {
                        found.release_time = r.time;
                        if let Some(height) = r.height.filter(|h| *h > 0.0) {
                            found.release_height = Some((height, r.sigma_height));
                            found.heights.push((0, height, r.sigma_height));
                        }
                    }
                    Event::Apex => {
                        if let Some(height) = r.height.filter(|h| *h > 0.0) {
                            found.heights.push((r.bounce, height, r.sigma_height));
                        }
                        if let (Some(time), Some(flights)) = (r.time, r.bounce.checked_sub(1)) {
                            found.moments.push((flights, true, time, r.sigma_time));
                        }
                    }
                    Event::Contact => {
                        if let (Some(time), Some(flights)) = (r.time, r.bounce.checked_sub(1)) {
                            found.moments.push((flights, false, time, r.sigma_time));
                        }
                    }
                    Event::Sample => {}
                }
            }
            evidence.trials.push(found);
        }
        evidence.keep_leading_runs(table, sigma_time);
        evidence
    }

    /// Ends each trial's contacts where an interval does not follow from the one before: a contact missed, or heard twice.
    fn keep_leading_runs(&mut self, table: &Table, sigma_time: Option<f64>) {
        let mut ratios: Vec<f64> = self.trials.iter().flat_map(|t| t.ratios().map(|(_, _, _, ratio)| ratio)).collect();
        if ratios.len() < RATIOS {
            return;
        }
        let Some(usual) = median(&mut ratios) else { return };
        for trial in &mut self.trials {
            let broken = trial.ratios().find(|&(_, before, after, ratio)| {
                let factor = ratio / usual;
                let noise = sigma_time.map_or(0.0, |s| 4.0 * s * (2.0 + 2.0 * usual + 2.0 * usual * usual).sqrt());
                !(SHORT..LONG).contains(&factor) && (after - usual * before).abs() > noise
            });
            let Some((flights, before, after, _)) = broken else { continue };
            let was = trial.moments.len();
            trial.moments.retain(|m| m.0 <= flights);
            let left_out = was - trial.moments.len();
            let label = table.trials()[trial.trial].label();
            let of = if label.is_empty() { String::new() } else { format!("{label}: ") };
            let cause = if after > usual * before { "a contact was missed" } else { "a contact was counted twice" };
            let plural = if left_out == 1 { "time was" } else { "times were" };
            self.repairs.push(format!(
                "{of}contacts used up to number {}; the next comes after {after:.4} s where about {:.4} s was due \
                 ({cause}?), and {left_out} {plural} left out",
                flights + 1,
                usual * before
            ));
        }
    }

    /// Heights by trial with every error filled in.
    pub(crate) fn heights(&self, sigma: f64) -> Vec<Vec<Height>> {
        self.trials.iter().map(|t| t.heights.iter().map(|&(n, h, s)| (n, h, s.unwrap_or(sigma))).collect()).collect()
    }

    /// Moments by trial with every error filled in, counted from each trial's first.
    pub(crate) fn moments(&self, sigma: f64) -> Vec<Vec<Moment>> {
        self.trials.iter().map(|t| t.moments(sigma)).collect()
    }

    /// Trials with at least one rebound height and contact times that fix a clock.
    pub(crate) fn joint(&self, sigma_height: f64, sigma_time: f64) -> Vec<(usize, FlightTrial)> {
        let rebounds = |t: &TrialEvidence| t.heights.iter().any(|h| h.0 > 0);
        let timed = |t: &TrialEvidence| t.moments.len() + usize::from(t.release_time.is_some()) >= 2;
        self.trials
            .iter()
            .filter(|t| rebounds(t) && timed(t))
            .map(|t| {
                let flight = FlightTrial {
                    release: t.release_height,
                    release_time: t.release_time,
                    heights: t
                        .heights
                        .iter()
                        .filter(|h| h.0 > 0)
                        .map(|&(n, h, s)| (n, h, s.unwrap_or(sigma_height)))
                        .collect(),
                    moments: t.moments(sigma_time),
                };
                (t.trial, flight)
            })
            .collect()
    }
}

impl TrialEvidence {
    fn moments(&self, sigma: f64) -> Vec<Moment> {
        self.moments
            .iter()
            .map(|&(flights, apex, time, s)| Moment { flights, apex, time, sigma: s.unwrap_or(sigma) })
            .collect()
    }

    /// The time of a contact by number.
    pub(crate) fn contact(&self, number: usize) -> Option<f64> {
        self.moments.iter().find(|m| !m.1 && m.0 + 1 == number).map(|m| m.2)
    }

    /// The flights between neighbouring contacts: the number of the contact before, the time it takes.
    pub(crate) fn intervals(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let contacts = || self.moments.iter().filter(|m| !m.1);
        contacts().zip(contacts().skip(1)).filter(|(a, b)| b.0 == a.0 + 1).map(|(a, b)| (b.0, b.2 - a.2))
    }

    /// Neighbouring intervals: the number of flights up to the contact between, both intervals, their ratio.
    pub(crate) fn ratios(&self) -> impl Iterator<Item = (usize, f64, f64, f64)> + '_ {
        self.intervals()
            .zip(self.intervals().skip(1))
            .filter(|(a, b)| b.0 == a.0 + 1 && a.1 > 0.0)
            .map(|(a, b)| (a.0, a.1, b.1, b.1 / a.1))
    }
}
