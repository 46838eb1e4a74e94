//! What the readings of a table say, trial by trial, in the form the models ask for.

pub(crate) mod follow;

use std::collections::HashMap;

use follow::{Repair, Run, Step, Way};

use crate::finding::{At, Finding, FindingKind};
use crate::quantity::Readings;
use crate::read::{Event, Reading, Table};
use crate::statistics::rounding;

/// A height: after how many contacts, how high (m), its standard error (m).
pub(crate) type Height = (usize, f64, f64);

/// A time: after how many flights, whether at the apex of the next one, when (s), its standard
/// error (s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moment {
    pub(crate) flights: usize,
    pub(crate) apex: bool,
    pub(crate) time: f64,
    pub(crate) sigma: f64,
}

/// The error of a time that nobody states, s.
pub(crate) const ASSUMED_TIME: f64 = 0.01;

/// At least so many pairs of contacts show that each was heard twice: within each they are no
/// further apart than this, s,
const PAIRS: usize = 3;
const ECHO: f64 = 0.05;
/// and all flights between pairs are so many times longer.
const APART: f64 = 3.0;

/// The evidence of one trial.
#[derive(Clone, Debug, Default)]
pub(crate) struct TrialEvidence {
    /// Its place among the trials of the table.
    pub(crate) trial: usize,
    pub(crate) release_height: Option<(f64, Option<f64>)>,
    pub(crate) release_time: Option<f64>,
    /// Number of contacts before, height, stated error; the release is number 0.
    pub(crate) heights: Vec<(usize, f64, Option<f64>)>,
    /// Bounces whose rebound was read as zero.
    pub(crate) zeros: Vec<usize>,
    /// The errors of the times are those of the intervals, which add up.
    pub(crate) added_up: bool,
    /// Flights since contact 1, whether at an apex, time, stated error.
    pub(crate) moments: Vec<(usize, bool, f64, Option<f64>)>,
}

/// The evidence of a table.
#[derive(Clone, Debug, Default)]
pub(crate) struct Evidence {
    pub(crate) trials: Vec<TrialEvidence>,
    /// What was done to put the readings in order.
    pub(crate) repairs: Vec<Finding>,
    /// How many contacts are supposed missed, extra or misread.
    pub(crate) adrift: usize,
    /// The trials as they are if the contacts are read in other ways that are about as likely.
    pub(crate) rivals: Vec<Vec<TrialEvidence>>,
    /// The readings were altered, or are a part of those of the table: what fits them is compared,
    /// and not reported.
    pub(crate) supposed: bool,
}

/// A top stands out once the ball has come down by this part of the height.
const TOLD: f64 = 0.01;

/// Gives tops of flights whose contacts are both read the error that they are read with, if none is
/// stated: a ball that has come down by the part p of its height has flown √p of half its flight.
fn blur_tops(moments: &mut [(usize, bool, f64, Option<f64>)]) {
    if moments.iter().all(|moment| !moment.1) {
        return;
    }
    let contacts: HashMap<usize, f64> =
        moments.iter().filter(|moment| !moment.1).map(|&(flights, _, time, _)| (flights, time)).collect();
    for (flights, _, _, sigma) in moments.iter_mut().filter(|moment| moment.1) {
        if let (Some(from), Some(to), None) = (contacts.get(flights), contacts.get(&(*flights + 1)), *sigma) {
            *sigma = Some(0.5 * (to - from).abs() * TOLD.sqrt());
        }
    }
}

impl Evidence {
    /// Trials that are supposed.
    pub(crate) fn supposed(trials: Vec<TrialEvidence>) -> Self {
        Self { trials, supposed: true, ..Self::default() }
    }

    /// Sorts the readings of a table into heights and moments, and mends the contacts if that is
    /// wanted; `sigma_time` is the error stated for times, if any.
    pub(crate) fn of(table: &Table, sigma_time: Option<f64>, repair: bool) -> Self {
        let mut evidence = Self { trials: Vec::with_capacity(table.trials().len()), ..Self::default() };
        for (trial, source) in table.trials().iter().enumerate() {
            let heights = Vec::with_capacity(source.readings().iter().filter(|r| r.height.is_some()).count());
            let mut found = TrialEvidence { trial, heights, ..TrialEvidence::default() };
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
                        if r.height == Some(0.0) {
                            found.zeros.push(r.bounce);
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
            blur_tops(&mut found.moments);
            evidence.trials.push(found);
        }
        if repair {
            evidence.pairs(table);
            evidence.mend(table, sigma_time);
        }
        evidence
    }

    /// Whether the errors of the times are those of the intervals, which add up.
    pub(crate) fn added_up(&self) -> bool {
        self.trials.iter().any(|t| t.added_up)
    }

    /// Finds trials whose contacts were all heard twice: the second of every pair is left out.
    fn pairs(&mut self, table: &Table) {
        for trial in &mut self.trials {
            let plain = trial.moments.iter().enumerate().all(|(n, m)| m.0 == n && !m.1);
            if !plain || trial.moments.len() < 2 * PAIRS || trial.heights.iter().any(|h| h.0 > 0) {
                continue;
            }
            let flights: Vec<f64> = trial.moments.windows(2).map(|w| w[1].2 - w[0].2).collect();
            let longest = flights.iter().copied().step_by(2).fold(0.0, f64::max);
            let shortest = flights.iter().copied().skip(1).step_by(2).fold(f64::INFINITY, f64::min);
            if longest > ECHO || shortest < APART * longest {
                continue;
            }
            let heard = trial.moments.len();
            trial.moments = trial.moments.iter().step_by(2).enumerate().map(|(n, m)| (n, m.1, m.2, m.3)).collect();
            let pairs = FindingKind::Pairs { heard, apart_s: longest };
            self.repairs.push(Finding::note(pairs).at(at(table, trial.trial)));
        }
    }

    /// Finds contacts that were missed, heard twice or misread, and releases that stand among
    /// contacts.
    fn mend(&mut self, table: &Table, sigma_time: Option<f64>) {
        let heard = |t: &TrialEvidence| !t.moments.is_empty() && t.plain();
        let places: Vec<usize> = (0..self.trials.len()).filter(|&n| heard(&self.trials[n])).collect();
        if places.is_empty() {
            return;
        }
        let runs: Vec<Run> = places.iter().map(|&n| self.trials[n].run()).collect();
        let times: Vec<f64> = runs.iter().flat_map(|run| run.times.iter().copied()).collect();
        let sigma = (sigma_time.unwrap_or(ASSUMED_TIME), sigma_time.is_some());
        let ways = follow::ways(&runs, sigma, rounding(&times));
        let Some((best, others)) = ways.split_first() else { return };
        let read = |mut trials: Vec<TrialEvidence>, way: &Way| {
            for (&n, steps) in places.iter().zip(&way.runs) {
                trials[n].reread(steps, way.released);
            }
            trials
        };
        self.rivals = others.iter().map(|way| read(self.trials.clone(), way)).collect();
        self.trials = read(std::mem::take(&mut self.trials), best);
        for ((&n, run), steps) in places.iter().zip(&runs).zip(&best.runs) {
            let place = at(table, self.trials[n].trial);
            if best.released && run.from_rest {
                self.repairs.push(Finding::note(FindingKind::ReleaseAmongContacts).at(place.clone()));
            }
            let repairs = follow::repairs(&run.times, steps);
            self.adrift += repairs.iter().map(Repair::events).sum::<usize>();
            self.repairs.extend(repairs.iter().map(|r| Finding::note(r.finding()).at(place.clone())));
        }
    }

    /// Leaves out heights, named by trial and place.
    pub(crate) fn drop_heights(&mut self, table: &Table, wrong: &[(usize, usize)]) {
        for &(trial, n) in wrong.iter().rev() {
            let found = &mut self.trials[trial];
            let (bounce, height, _) = found.heights.remove(n);
            let left_out = FindingKind::HeightLeftOut { height_m: height };
            self.repairs.push(Finding::note(left_out).at(at(table, found.trial).bounce(bounce)));
        }
    }

    /// Leaves out times, named by trial and place.
    pub(crate) fn drop_moments(&mut self, table: &Table, wrong: &[(usize, usize)]) {
        for &(trial, n) in wrong.iter().rev() {
            let found = &mut self.trials[trial];
            let (flights, _, time, _) = found.moments.remove(n);
            let left_out = FindingKind::TimeLeftOut { time_s: time };
            self.repairs.push(Finding::note(left_out).at(at(table, found.trial).bounce(flights + 1)));
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
}

/// Whether a table has readings of a kind.
pub(crate) fn has(table: &Table, kind: Readings) -> bool {
    let any = |event: fn(&Reading) -> bool| table.trials().iter().any(|t| t.readings().iter().any(event));
    match kind {
        Readings::Heights => table.zero_rebounds > 0 || any(|r| r.event == Event::Apex && r.height.is_some()),
        Readings::Times => any(|r| r.event == Event::Contact || r.event == Event::Apex && r.time.is_some()),
    }
}

/// A trial as a place for findings: named where the table holds several.
pub(crate) fn at(table: &Table, trial: usize) -> At {
    let label = table.trials().get(trial).map_or("", crate::read::Trial::label);
    let several = table.trials().len() > 1;
    let name = if label.is_empty() && several { format!("trial {}", trial + 1) } else { label.to_owned() };
    At { trial: several.then_some(trial), name, ..At::default() }
}

impl Repair {
    /// How many contacts it supposes missed, extra or misread.
    fn events(&self) -> usize {
        if let Self::Ended { left_out, .. } = self { *left_out } else { 1 }
    }

    /// As a finding.
    fn finding(&self) -> FindingKind {
        match *self {
            Self::Missed { after } => FindingKind::ContactMissed { after_s: after },
            Self::Double { at } => FindingKind::ContactTwice { at_s: at },
            Self::Misread { at } => FindingKind::ContactMisread { at_s: at },
            Self::Ended { last, left_out, before } => FindingKind::RunEnded { at_s: last, left_out, before },
        }
    }
}

impl TrialEvidence {
    /// Whether its contacts are one run that nothing else numbers: gaps that the table itself
    /// numbers, and apexes between contacts, are what they are, and heights are counted by the
    /// number of the contact before them.
    fn plain(&self) -> bool {
        let one_by_one = self.moments.windows(2).all(|w| w[1].0 == w[0].0 + 1);
        one_by_one && self.moments.iter().all(|m| !m.1) && self.heights.iter().all(|h| h.0 == 0)
    }

    /// Its contacts as a run; a first time of exactly 0 may be that of the release.
    fn run(&self) -> Run {
        let bare = self.release_time.is_none() && self.moments.len() > 3;
        let from_rest = bare && self.moments.first().is_some_and(|m| m.0 == 0 && m.2 == 0.0);
        Run { times: self.moments.iter().map(|m| m.2).collect(), from_rest }
    }

    /// Keeps these contacts, with these numbers of flights between them.
    fn reread(&mut self, steps: &[Step], released: bool) {
        let released = released && self.run().from_rest;
        let mut flights = steps.first().and_then(|step| self.moments.get(step.0)).map_or(0, |m| m.0);
        let mut kept = Vec::with_capacity(steps.len());
        for &(place, since) in steps {
            flights += since;
            let (_, apex, time, sigma) = self.moments[place];
            kept.push((flights, apex, time, sigma));
        }
        if released {
            self.release_time = Some(kept.remove(0).2);
            kept.iter_mut().for_each(|m| m.0 -= 1);
        }
        self.moments = kept;
    }

    pub(crate) fn moments(&self, sigma: f64) -> Vec<Moment> {
        self.moments
            .iter()
            .map(|&(flights, apex, time, s)| Moment { flights, apex, time, sigma: s.unwrap_or(sigma) })
            .collect()
    }

    /// The moment after so many flights, of a contact or the apex after it: they are in order.
    pub(crate) fn moment(&self, flights: usize, apex: bool) -> Option<&(usize, bool, f64, Option<f64>)> {
        let place = self.moments.binary_search_by_key(&(flights, apex), |m| (m.0, m.1)).ok()?;
        self.moments.get(place)
    }

    /// The time of a contact by number.
    pub(crate) fn contact(&self, number: usize) -> Option<f64> {
        self.moment(number.checked_sub(1)?, false).map(|m| m.2)
    }

    /// The flights between neighbouring contacts: the number of the contact before, the time it
    /// takes.
    pub(crate) fn intervals(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let contacts = || self.moments.iter().filter(|m| !m.1);
        contacts().zip(contacts().skip(1)).filter(|(a, b)| b.0 == a.0 + 1).map(|(a, b)| (b.0, b.2 - a.2))
    }

    /// Neighbouring intervals: the number of flights up to the contact between, both intervals,
    /// their ratio.
    pub(crate) fn ratios(&self) -> impl Iterator<Item = (usize, f64, f64, f64)> + '_ {
        self.intervals()
            .zip(self.intervals().skip(1))
            .filter(|(a, b)| b.0 == a.0 + 1 && a.1 > 0.0)
            .map(|(a, b)| (a.0, a.1, b.1, b.1 / a.1))
    }
}
