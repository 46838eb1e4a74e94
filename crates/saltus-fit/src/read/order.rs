//! The order of readings: trials parted where numbers restart, clocks that ascend, intervals
//! summed to times.

use super::region::Region;
use super::{Event, Reading, Trial};
use crate::error::TableError;
use crate::finding::{Remark, Repair};
use crate::statistics::median;

/// Trials whose numbers restart are split; a reading given twice alike is counted once; contacts
/// count from 1.
pub(super) fn renumbered(
    region: &Region<'_>,
    trials: Vec<Trial>,
    number: usize,
    repairs: &mut Vec<Remark<Repair>>,
) -> Result<Vec<Trial>, TableError> {
    let mut split: Vec<Trial> = Vec::with_capacity(trials.len());
    for trial in trials {
        if unique(&trial.readings) {
            split.push(trial);
            continue;
        }
        // A release that a column tells, for every run without one of its own.
        let told = trial
            .readings
            .first()
            .copied()
            .filter(|r| r.event == Event::Release && trial.readings.iter().skip(1).any(|o| o.line == r.line));
        let released = Trial { readings: Vec::new(), ..trial.clone() };
        let runs = runs(trial.readings.into_iter().skip(usize::from(told.is_some())), repairs);
        let count = runs.len();
        let first = runs.first().and_then(|run| run.first()).map_or(0, |r| r.bounce);
        for (n, readings) in runs.into_iter().enumerate() {
            // A restart begins where the first run began; anything else is a reading given twice.
            let start = readings.first().copied();
            if count > 1 && (readings.len() < 2 || start.is_some_and(|r| r.bounce != first)) {
                let line = start.map_or(0, |r| r.line);
                return Err(region
                    .line_error(line, number, "this bounce is given twice in one trial, and the readings differ")
                    .help("tell the drops apart by a column 'trial', or write each drop from its first bounce to its last"));
            }
            let run = format!("run {}", n + 1);
            let label = match (count, trial.label.is_empty()) {
                (1, _) => trial.label.clone(),
                (_, true) => run,
                _ => format!("{}, {run}", trial.label),
            };
            let own = readings.iter().any(|r| r.event == Event::Release);
            let readings = told.filter(|_| !own).into_iter().chain(readings).collect();
            split.push(Trial { label, readings, ..released.clone() });
        }
    }
    let zero = split.iter().flat_map(|t| &t.readings).any(|r| r.event == Event::Contact && r.bounce == 0);
    if zero {
        for reading in split.iter_mut().flat_map(|t| &mut t.readings).filter(|r| r.event == Event::Contact) {
            reading.bounce += 1;
        }
    }
    Ok(split)
}

/// Whether no bounce is given twice.
fn unique(readings: &[Reading]) -> bool {
    let mut keys: Vec<(bool, usize)> = readings.iter().map(|r| (r.event == Event::Contact, r.bounce)).collect();
    keys.sort_unstable();
    keys.windows(2).all(|pair| pair[0] != pair[1])
}

/// Readings whose numbers restart, run by run.
fn runs(readings: impl Iterator<Item = Reading>, repairs: &mut Vec<Remark<Repair>>) -> Vec<Vec<Reading>> {
    let mut runs: Vec<Vec<Reading>> = Vec::new();
    let mut last: Option<Reading> = None;
    for reading in readings {
        let repeated = last.is_some_and(|last| Reading { line: reading.line, ..last } == reading);
        if repeated {
            repairs.push(Repair::SameLine { line: reading.line }.into());
            continue;
        }
        let restarts = last.is_none_or(|last| {
            (reading.bounce, reading.event == Event::Apex) <= (last.bounce, last.event == Event::Apex)
        });
        if restarts {
            runs.push(Vec::new());
        }
        last = Some(reading);
        if let Some(run) = runs.last_mut() {
            run.push(reading);
        }
    }
    runs
}

/// Puts the readings in the order of the events and refuses clocks that run backwards. A list of
/// contacts ends where the clock, or the camera, does not tell two of them apart any more; gives
/// the lines from there on.
pub(super) fn in_order(
    region: &Region<'_>,
    column: usize,
    trial: &mut Trial,
    by_time: bool,
) -> Result<Vec<u64>, TableError> {
    let samples = trial.readings.iter().any(|r| r.event == Event::Sample);
    if by_time && trial.readings.iter().all(|r| r.event == Event::Contact) {
        trial.readings.sort_by(|a, b| a.time.partial_cmp(&b.time).unwrap_or(std::cmp::Ordering::Equal));
        for (n, reading) in trial.readings.iter_mut().enumerate() {
            reading.bounce = n + 1;
        }
    } else if !samples {
        trial.readings.sort_by_key(|r| (r.bounce, r.event == Event::Apex, r.line));
    }
    // A release height given by a column and again as bounce 0: the reading stands.
    let releases = trial.readings.iter().filter(|r| r.event == Event::Release).count();
    if releases > 1 {
        let mut seen = 0;
        trial.readings.retain(|r| {
            seen += usize::from(r.event == Event::Release);
            r.event != Event::Release || seen == releases
        });
    }
    let unresolved = merged(&trial.readings).map(|at| trial.readings.split_off(at)).unwrap_or_default();
    let mut last: Option<(f64, u64)> = None;
    for reading in trial.readings.iter().filter(|r| r.event != Event::Sample) {
        let Some(time) = reading.time else { continue };
        if let Some((before, line)) = last
            && time <= before
        {
            let what = if time < before { "is earlier than" } else { "is the same as" };
            return Err(region
                .line_error(
                    reading.line,
                    column,
                    format!("this time, {time} s, {what} that of the event before it, {before} s in line {line}"),
                )
                .help("times of one trial ascend; tell trials apart by a column 'trial'; times between contacts belong in a column 'interval_s'"));
        }
        last = Some((time, reading.line));
    }
    Ok(unresolved.into_iter().map(|reading| reading.line).collect())
}

/// So many contacts in order show that those of one time are too close, and not in disorder.
const ORDERED: usize = 3;

/// Where in a list of contacts, and nothing else, the first stands whose time is that of the one
/// before, no later one being earlier.
fn merged(readings: &[Reading]) -> Option<usize> {
    let ascends = |pair: &[Reading]| pair[0].time <= pair[1].time;
    let contacts = readings.iter().all(|r| r.event == Event::Contact && r.time.is_some());
    let at = readings.windows(2).position(|pair| pair[0].time == pair[1].time)? + 1;
    (contacts && at >= ORDERED && readings.windows(2).all(ascends)).then_some(at)
}

/// Intervals as contact times, the first contact being at 0 s.
pub(super) fn summed(region: &Region<'_>, trial: Trial) -> Result<Trial, TableError> {
    let (mut readings, intervals): (Vec<Reading>, Vec<Reading>) =
        trial.readings.into_iter().partition(|r| r.event != Event::Contact);
    let mut intervals = intervals;
    intervals.sort_by_key(|r| (r.bounce, r.line));
    let mut time = 0.0;
    let first = intervals.first().map_or(0, |r| r.bounce);
    for (n, interval) in intervals.iter().enumerate() {
        if interval.bounce != first + n {
            let text = format!("interval {} comes after interval {}", interval.bounce, first + n - 1);
            return Err(region
                .line_error(interval.line, 0, text)
                .help("give the times between all contacts, each once and without a gap"));
        }
        if n == 0 {
            readings.push(Reading { time: Some(0.0), ..Reading::new(Event::Contact, 1, interval.line) });
        }
        time += interval.time.unwrap_or(0.0);
        readings.push(Reading { bounce: n + 2, time: Some(time), ..*interval });
    }
    Ok(Trial { readings, ..trial })
}

/// Whether the heights of a trial rise from bounce to bounce, for the most part.
pub(super) fn rise(trial: &Trial) -> bool {
    let heights: Vec<f64> = trial.readings.iter().filter_map(|r| r.height).collect();
    let mut ratios: Vec<f64> = heights.windows(2).map(|pair| pair[1] / pair[0]).collect();
    median(&mut ratios).is_some_and(|ratio| ratio > 1.0)
}
