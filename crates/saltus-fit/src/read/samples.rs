//! A series of heights in time: its order, its gaps and repeats, and which way is up.

use std::mem;

use super::aside::{LeftAside, Part, Why};
use super::region::Region;
use super::{Event, ReadOptions, Reading, Table, Trial};
use crate::error::TableError;
use crate::finding::{Lines, Note, Pace, Remark, Repair, Warning};
use crate::orientation::falls_upwards;
use crate::quantity::STANDARD_GRAVITY;
use crate::statistics::median;

/// Shorter runs of ascending times are rows out of order; longer ones are recordings, one below the
/// other.
const RECORDING: usize = 5;
/// Times nearer than this part of the usual step are those of two recordings that went on at once.
const AT_ONCE: f64 = 0.5;
/// A ball in the middle of a picture is further from its edge than this part of the way across.
const FAR: f64 = 0.05;
/// What moves less than this part of what moves most stands still.
const HARDLY: f64 = 0.1;
/// Rows this far apart are compared to tell how fast the ball falls.
const STRIDES: [usize; 6] = [2, 3, 5, 8, 13, 21];
/// They agree how fast if the middle half of the bends lies within this part of their median.
const ALIKE: f64 = 0.35;

/// Puts the samples of a table in order and the right way up.
pub(super) fn series(
    region: &Region<'_>,
    column: usize,
    unscaled: bool,
    options: &ReadOptions,
    table: &mut Table,
) -> Result<(), TableError> {
    let mut trials = mem::take(&mut table.trials);
    if unscaled {
        let lost: Vec<u64> = trials.iter_mut().flat_map(take_lost).collect();
        if !lost.is_empty() {
            table.repairs.push(Repair::NoPosition { lines: Lines::of(&lost) }.into());
        }
    }
    for trial in trials {
        for part in recordings(trial, &mut table.notes) {
            table.trials.push(ordered(region, column, part, &mut table.repairs)?);
        }
    }
    table.trials.retain(|trial| !trial.readings.is_empty());
    if table.trials.is_empty() {
        return Err(region
            .error("no row holds both a time and a height")
            .help("check the columns, or name them by --header"));
    }
    leave_still(table);
    orient(unscaled, options, table);
    if !unscaled {
        falls(table);
    }
    Ok(())
}

/// Takes the samples out in which a program did not find the ball, and gives their lines: no place
/// of a picture is negative, but for one number in place of all of these, far from all others.
fn take_lost(trial: &mut Trial) -> Vec<u64> {
    let heights = || trial.readings.iter().filter_map(|r| r.height);
    let found = || heights().filter(|h| *h >= 0.0);
    let Some(sign) = heights().find(|h| *h < 0.0) else { return Vec::new() };
    let (least, most) = found().fold((f64::INFINITY, 0.0_f64), |(low, high), h| (low.min(h), high.max(h)));
    let same = heights().filter(|h| *h < 0.0).all(|h| h.total_cmp(&sign).is_eq());
    if !same || least < FAR * most || most <= 0.0 {
        return Vec::new();
    }
    let (lost, kept) = mem::take(&mut trial.readings).into_iter().partition(|r| r.height.is_some_and(|h| h < 0.0));
    trial.readings = kept;
    Vec::into_iter(lost).map(|r: Reading| r.line).collect()
}

/// Leaves bodies aside that hardly move while another one does: the floor, a corner of the table.
fn leave_still(table: &mut Table) {
    let travel = |group: &str| {
        let own = table.trials.iter().filter(|trial| trial.group == group).flat_map(|trial| &trial.readings);
        let ends = own
            .filter_map(|r| r.height)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
        ends.1 - ends.0
    };
    let groups: Vec<String> = table.groups().into_iter().map(str::to_owned).collect();
    let most = groups.iter().map(|group| travel(group)).fold(0.0, f64::max);
    let still: Vec<String> = groups.into_iter().filter(|group| travel(group) < HARDLY * most).collect();
    if still.is_empty() {
        return;
    }
    table.trials.retain(|trial| !still.contains(&trial.group));
    table.left_aside.extend(still.iter().map(|name| LeftAside::new(Part::Track, name.as_str(), Why::Still)));
    // Of the ball that is left alone no name is needed to tell it apart.
    if table.groups().len() == 1 {
        table.trials.iter_mut().for_each(|trial| trial.group.clear());
    }
    table.notes.push(Note::Still { tracks: still }.into());
}

/// Heights of which every other is zero are those of the release, the contacts and the tops between
/// them, one after the other: events, and no film; says whether all trials are of such.
pub(super) fn touches(trials: &mut [Trial]) -> bool {
    let zero = |r: &Reading| r.height == Some(0.0);
    let in_turn = |trial: &Trial| {
        let contacts = trial.readings.iter().filter(|r| zero(r)).count();
        contacts > 1
            && trial.readings.windows(2).all(|pair| zero(&pair[0]) != zero(&pair[1]) && pair[0].time < pair[1].time)
    };
    if trials.is_empty() || !trials.iter().all(in_turn) {
        return false;
    }
    for trial in trials {
        let mut bounce = 0;
        for reading in &mut trial.readings {
            if zero(reading) {
                bounce += 1;
                (reading.event, reading.height, reading.sigma_height) = (Event::Contact, None, None);
            } else {
                reading.event = if bounce == 0 { Event::Release } else { Event::Apex };
            }
            reading.bounce = bounce;
        }
    }
    true
}

/// A series in metres and seconds says how fast balls fall; a wrong unit, scale or frame rate says
/// so too.
fn falls(table: &mut Table) {
    let gravity = table.metadata.gravity.unwrap_or(STANDARD_GRAVITY);
    let agreed = |stride: &usize| {
        let found = table.trials.iter().flat_map(|trial| accelerations(&trial.readings, *stride));
        let mut found: Vec<f64> = found.collect();
        found.sort_unstable_by(f64::total_cmp);
        let part = |n: usize| found.get(found.len() * n / 4).copied().unwrap_or(f64::NAN);
        (found.len() >= 8 && part(3) - part(1) < ALIKE * part(2)).then_some(part(2))
    };
    // Close samples show their noise: the nearest are taken on which the bends agree.
    let Some(median) = STRIDES.iter().find_map(agreed) else { return };
    if (0.7 * gravity..1.4 * gravity).contains(&median) {
        return;
    }
    let rate = (gravity / median).sqrt();
    let pace = match table.metadata.frame_rate {
        Some(fps) => Pace::Frames { rate: fps * rate },
        None => Pace::Clock { factor: rate, played: played(table) },
    };
    table.warnings.push(Warning::Gravity { found: median, due: gravity, pace }.into());
}

/// The rate of the samples, 1/s.
fn played(table: &Table) -> f64 {
    let steps = table.trials.iter().flat_map(|t| t.readings.windows(2)).filter_map(|w| Some(w[1].time? - w[0].time?));
    median(&mut steps.collect::<Vec<f64>>()).map_or(0.0, |step| 1.0 / step)
}

/// The downward accelerations where a series moves and bends downwards, from second differences.
fn accelerations(readings: &[Reading], stride: usize) -> Vec<f64> {
    let points: Vec<(f64, f64)> = readings.iter().filter_map(|r| Some((r.time?, r.height?))).collect();
    let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.1), h.max(p.1)));
    let moves = 0.02 * (high - low);
    let bend = |w: &[(f64, f64)]| {
        let (a, b, c) = (w[0], w[stride], w[2 * stride]);
        let slopes = ((b.1 - a.1) / (b.0 - a.0), (c.1 - b.1) / (c.0 - b.0));
        let acceleration = 2.0 * (slopes.0 - slopes.1) / (c.0 - a.0);
        ((b.1 - a.1).abs().max((c.1 - b.1).abs()) > moves && acceleration > 0.0).then_some(acceleration)
    };
    points.windows(2 * stride + 1).filter_map(bend).filter(|a| a.is_finite()).collect()
}

/// Whether the rows are those of one recording out of their order, as packets arrive: put in order,
/// the times have no gap that a recording could end in.
fn shuffled(readings: &[Reading]) -> bool {
    let mut times: Vec<f64> = readings.iter().filter_map(|reading| reading.time).collect();
    times.sort_unstable_by(f64::total_cmp);
    let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let usual = median(&mut steps.clone()).unwrap_or(0.0);
    steps.iter().all(|step| *step > AT_ONCE * usual && *step < RECORDING as f64 * usual)
}

/// Recordings one below the other, parted where a clock starts again.
fn recordings(trial: Trial, notes: &mut Vec<Remark<Note>>) -> Vec<Trial> {
    let restarts = |pair: &[Reading]| pair[1].time < pair[0].time;
    let starts: Vec<usize> =
        trial.readings.windows(2).enumerate().filter(|(_, pair)| restarts(pair)).map(|(n, _)| n + 1).collect();
    let ends = starts.iter().copied().chain([trial.readings.len()]);
    let shortest = std::iter::once(0).chain(starts.iter().copied()).zip(ends).map(|(a, b)| b - a).min().unwrap_or(0);
    if starts.is_empty() || shortest < RECORDING || shuffled(&trial.readings) {
        return vec![trial];
    }
    notes.push(Note::Restarts { times: starts.len() }.into());
    let like = Trial { readings: Vec::new(), ..trial.clone() };
    let mut parts: Vec<Trial> = Vec::new();
    for (n, reading) in trial.readings.into_iter().enumerate() {
        if n == 0 || starts.binary_search(&n).is_ok() {
            let run = format!("recording {}", parts.len() + 1);
            let label = if trial.label.is_empty() { run } else { format!("{}, {run}", trial.label) };
            parts.push(Trial { label, readings: Vec::new(), ..like.clone() });
        }
        if let Some(part) = parts.last_mut() {
            part.readings.push(reading);
        }
    }
    parts
}

/// Sorts by time; a sample given twice alike counts once, one given twice otherwise is an error.
fn ordered(
    region: &Region<'_>,
    column: usize,
    mut trial: Trial,
    repairs: &mut Vec<Remark<Repair>>,
) -> Result<Trial, TableError> {
    let by_time = |a: &Reading, b: &Reading| a.time.partial_cmp(&b.time).unwrap_or(std::cmp::Ordering::Equal);
    trial.readings.sort_by(|a, b| by_time(a, b).then(a.line.cmp(&b.line)));
    if let Some(pair) = trial.readings.windows(2).find(|p| p[0].time == p[1].time && p[0].height != p[1].height) {
        let message = format!("this time stands in line {} too, with another height", pair[0].line);
        return Err(region
            .line_error(pair[1].line, column, message)
            .help(
                "correct one of the two; tell recordings apart by a column 'trial'; where times are rounded to more than a frame, number the \
                 frames instead, in a column 'frame' (--header frame,height_cm --fps 240)",
            ));
    }
    let before = trial.readings.len();
    trial.readings.dedup_by(|b, a| a.time == b.time && a.height == b.height);
    let repeated = before - trial.readings.len();
    if repeated > 0 {
        repairs.push(Repair::SameSamples { samples: repeated }.into());
    }
    for (n, reading) in trial.readings.iter_mut().enumerate() {
        reading.bounce = n;
    }
    Ok(trial)
}

/// Turns a series that falls upwards; heights of a picture are then counted from its lowest.
fn orient(unscaled: bool, options: &ReadOptions, table: &mut Table) {
    let recordings: Vec<(Vec<f64>, Vec<f64>)> =
        table.trials.iter().map(|t| t.readings.iter().filter_map(|r| Some((r.time?, r.height?))).unzip()).collect();
    let falls_upwards = falls_upwards(&recordings);
    let turned = match options.down {
        Some(down) => {
            // What is stated is heeded, but a ball that then falls upwards is worth a word.
            if falls_upwards == Some(true) {
                table.metadata.falls_upwards = Some(down);
            }
            false
        }
        None => falls_upwards.unwrap_or(unscaled),
    };
    if turned {
        table.notes.push(Note::Downwards { shown: falls_upwards.is_some() }.into());
        each_height(table, |h| -h);
    }
    // Where nobody says what the scale reads at the floor, pictures and scales upside down are
    // counted from the lowest reading.
    let floor = table.trials.iter().flat_map(|t| &t.readings).filter_map(|r| r.height).fold(f64::INFINITY, f64::min);
    if options.zero.is_none() && (turned || options.down == Some(true) || unscaled) && floor.is_finite() {
        each_height(table, |h| h - floor);
    }
}

fn each_height(table: &mut Table, change: impl Fn(f64) -> f64) {
    for reading in table.trials.iter_mut().flat_map(|t| &mut t.readings) {
        reading.height = reading.height.map(&change);
    }
}
