//! The contacts of a ball among what a sensor felt: what comes ever sooner, as they do.

use crate::elementary::{hypot, ln};
use crate::finding::Note;
use crate::read::aside::Part;
use crate::read::grid::shown;
use crate::read::heard;
use crate::read::lasting::{self, Lasting};
use crate::read::region::Region;
use crate::read::{Event, Reading, Table, Trial};
use crate::sound::{Bounced, Onset, SURE, Unused};
use crate::statistics::Line;

/// Fewer pulses tell no ratio of flights.
pub(super) const PULSES: usize = 3;
/// A pulse of less than this part of the least contact may be of anything.
const STRAY: f64 = 0.5;
/// What lasts longer than so many of the longest contacts is a load, and no contact.
const LOAD: f64 = 1.5;
/// So many contacts to one are fainter than the one before, where speeds decide how strongly a
/// sensor is triggered: of numbers without order half are.
const FADING: usize = 2;

/// What a sensor felt once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Felt {
    /// When it begins and ends, s,
    pub(super) begin: f64,
    pub(super) end: f64,
    /// and the standard error of either, s.
    pub(super) sigma: f64,
    /// How large it is.
    pub(super) peak: f64,
    /// The row in which it begins.
    pub(super) row: usize,
}

/// What tells what a sensor felt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum By {
    /// Its samples, in which nothing else stands out.
    Samples,
    /// Its changes from one state to another.
    States,
    /// The times between which a beam is blocked, whose height every bounce tells alike.
    Beam,
    /// Its being triggered, and how strongly: contacts are the fainter the slower the ball is.
    Triggers,
}

/// All that a sensor felt, in the order of time.
pub(super) struct Series {
    pub(super) by: By,
    pub(super) column: usize,
    /// How many rows it was felt in.
    pub(super) rows: usize,
    pub(super) felt: Vec<Felt>,
    /// Whether ends tell how long a contact lasts.
    pub(super) end: bool,
}

/// Whether, from first to last contact of each drop, most pulses that are half as large as the
/// least of its contacts are contacts.
fn most(felt: &[&Felt], bounced: &Bounced) -> bool {
    bounced.drops.iter().all(|drop| {
        let least = drop.iter().map(|&(n, _)| felt[n].peak).fold(f64::INFINITY, f64::min);
        let within = |n: usize| drop.first().is_some_and(|f| f.0 < n) && drop.last().is_some_and(|l| n < l.0);
        let stray = |&&(n, why): &&(usize, Unused)| within(n) && why == Unused::Stray && felt[n].peak > STRAY * least;
        2 * bounced.unused.iter().filter(stray).count() < drop.len()
    })
}

impl Series {
    /// The contacts, and how many there are; `None` where no ball bounces.
    pub(super) fn table(&self, region: &Region<'_>) -> Option<(Table, usize)> {
        if self.felt.len() < PULSES {
            return None;
        }
        let load = |felt: &&Felt| felt.end - felt.begin > LOAD * lasting::LONGEST;
        let (loads, felt): (Vec<&Felt>, Vec<&Felt>) = self.felt.iter().partition(load);
        #[allow(clippy::cast_possible_truncation)] // single precision does
        let onset = |(felt, lasted): (&&Felt, f64)| Onset {
            time: felt.begin - lasted,
            sigma: felt.sigma,
            power: felt.peak.powi(2) as f32,
        };
        // By a clock that stands still during contacts flights shrink by one factor.
        let lasted = felt.iter().scan(0.0, |lasted, felt| {
            let ends = if self.end { felt.end - felt.begin } else { 0.0 };
            Some(std::mem::replace(lasted, *lasted + ends))
        });
        let onsets: Vec<Onset> = felt.iter().zip(lasted).map(onset).collect();
        let bounced = Bounced::among(&onsets, true).filter(|bounced| most(&felt, bounced))?;
        let fades = |drop: &Vec<(usize, usize)>| {
            let less = drop.windows(2).filter(|pair| felt[pair[1].0].peak < felt[pair[0].0].peak).count();
            self.by != By::Triggers || less > FADING * (drop.len() - 1 - less)
        };
        // What is only logged may be of anything.
        let alone = matches!(self.by, By::States | By::Triggers);
        let chance = alone && bounced.evidence.iter().any(|evidence| *evidence < SURE);
        if chance || !bounced.drops.iter().all(fades) {
            return None;
        }
        let of_drop = |drop: &Vec<(usize, usize)>| {
            let contacts: Vec<(f64, f64)> = drop.iter().map(|&(n, _)| (felt[n].begin, felt[n].end)).collect();
            let sigma = drop.iter().map(|&(n, _)| felt[n].sigma).fold(0.0, f64::max);
            if self.end { lasting::of(&contacts, sigma) } else { Lasting::Other }
        };
        let lasting: Vec<Lasting> = bounced.drops.iter().map(of_drop).collect();
        if lasting.contains(&Lasting::Growing) {
            return None;
        }
        let floor = lasting.iter().all(|lasting| *lasting == Lasting::OnFloor);
        let mut table = Table { rows: self.rows, ..Table::default() };
        for (n, drop) in bounced.drops.iter().enumerate() {
            let contacts: Vec<(Felt, usize)> = drop.iter().map(|&(at, number)| (*felt[at], number)).collect();
            let label = if bounced.drops.len() > 1 { format!("drop {}", n + 1) } else { String::new() };
            table.trials.push(Trial { label, ..trial(region, self.column, &contacts, floor) });
        }
        let contacts: usize = bounced.drops.iter().map(Vec::len).sum();
        let (column, pulses) = (shown(&region.header[self.column]), self.felt.len());
        table.notes.push(Note::Felt { column, pulses, contacts }.into());
        if floor {
            table.metadata.intervals = true;
            let used = bounced.drops.iter().flatten().map(|&(n, _)| (felt[n].begin, felt[n].end));
            table.notes.extend(lasting::noted(used));
        }
        // Where nothing else hits the plate as hard no chance does.
        let least = bounced.drops.iter().flatten().map(|&(n, _)| felt[n].peak).fold(f64::INFINITY, f64::min);
        let hits = |&(n, why): &(usize, Unused)| why == Unused::Stray && felt[n].peak > STRAY * least;
        if bounced.unused.iter().any(hits) {
            table.doubts = heard::doubts(bounced.drops.iter().map(Vec::len), &bounced.evidence);
        }
        let unused = bounced.unused.iter().map(|&(n, why)| (felt[n].begin, why));
        let loads = loads.iter().map(|felt| (felt.begin, Unused::Stray));
        table.left_aside = heard::aside(Part::Pulse, &unused.chain(loads).collect::<Vec<_>>());
        Some((table, contacts))
    }
}

/// The contacts of a drop; on the `floor` from their begins to their ends.
fn trial(region: &Region<'_>, column: usize, contacts: &[(Felt, usize)], floor: bool) -> Trial {
    let reading = |&(felt, number): &(Felt, usize)| {
        let line = region.view.line(felt.row, column);
        let (time, sigma_time) = (Some(felt.begin), Some(felt.sigma));
        Reading { time, sigma_time, ..Reading::new(Event::Contact, number, line) }
    };
    let mut trial = Trial { readings: contacts.iter().map(reading).collect(), ..Trial::default() };
    if floor {
        let mut lasted = contacts.iter().map(|(felt, _)| felt.end - felt.begin);
        lasting::aloft(&mut trial, |_| lasted.next());
    }
    if scatter(&trial) {
        trial.readings.iter_mut().for_each(|reading| reading.sigma_time = None);
    }
    trial
}

/// Whether the bounces of a trial scatter by more than its times are known to: then they tell their
/// error themselves.
fn scatter(trial: &Trial) -> bool {
    let flight = |pair: &[Reading]| {
        let flight = pair[1].time? - pair[0].time?;
        Some((flight, hypot(pair[0].sigma_time?, pair[1].sigma_time?) / flight))
    };
    let flights: Vec<(f64, f64)> = trial.readings.windows(2).filter_map(flight).collect();
    let ratio = |pair: &[(f64, f64)]| (hypot(pair[0].1, pair[1].1).powi(-2), 0.0, ln(pair[1].0 / pair[0].0));
    #[allow(clippy::cast_precision_loss)] // as many as there are contacts
    let spare = flights.len().saturating_sub(2) as f64;
    Line::through(flights.windows(2).map(ratio)).all > spare
}
