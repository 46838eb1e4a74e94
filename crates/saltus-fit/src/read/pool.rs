//! Several tables as one: the runs of a file, the sheets of a workbook, the files of an experiment.

use std::collections::HashMap;

use saltus_bounce::units::Quantity;

use super::aside::LeftAside;
use super::grid::shown;
use super::heading::Heading;
use super::sheet::joined;
use super::vocabulary::{Atom, MISSPELT, slip};
use super::written::{rounds_to, step};
use super::{Event, Metadata, Reading, Table, Trial};
use crate::error::TableError;
use crate::finding::{Doubt, Note, Parts, Remark, Warning};
use crate::quantity::{Ball, STANDARD_GRAVITY};

/// What the names of sheets tell: heights of release, trials, or balls and surfaces; says whether
/// they are heights. Those of `bodies` are balls, whatever they count.
pub(super) fn told_apart(found: &mut [(String, Table)], bodies: bool) -> bool {
    let several = found.len() > 1;
    let mut drops = false;
    for (label, table) in found.iter_mut().filter(|(label, _)| !label.is_empty()) {
        let drop = drop_height(label, table);
        drops |= drop;
        let heading = Heading::parse(label);
        let trial = heading.unknown.is_empty()
            && [Atom::Trial, Atom::Repeat, Atom::Time, Atom::Release].iter().any(|atom| heading.has(*atom));
        let group = several && !drop && (bodies || !trial || !heading.labels().is_empty());
        let name = if heading.labels().is_empty() { label.clone() } else { heading.labels() };
        for trial in table.trials.iter_mut().filter(|_| several) {
            trial.setting = joined(label, &trial.setting);
            if group {
                trial.group = joined(&name, &trial.group);
                trial.ball = trial.ball.or(Ball::named(&name));
            }
        }
    }
    drops
}

/// Tells trials apart by what encloses their table.
pub(super) fn within(name: &str, trials: &mut [Trial]) {
    for trial in trials {
        trial.group = joined(name, &trial.group);
        trial.ball = trial.ball.or(Ball::named(name));
    }
}

/// A sheet named `80 cm` holds drops from there.
fn drop_height(label: &str, table: &mut Table) -> bool {
    let Some(height) = Quantity::Length.parse(label).ok().filter(|h| *h > 0.0) else { return false };
    for trial in &mut table.trials {
        let line = trial.readings.first().map_or(1, |r| r.line);
        if trial.readings.iter().all(|r| r.event == Event::Contact || r.event == Event::Apex) {
            trial.readings.insert(0, Reading { height: Some(height), ..Reading::new(Event::Release, 0, line) });
        }
    }
    true
}

/// Tells files apart whose names are of different balls or surfaces, and recordings from readings
/// of bounces: they are no one experiment.
pub(super) fn apart(parts: &mut [(String, Table)]) {
    let named =
        |name: &str| Heading::parse(name.rsplit_once('.').map_or(name, |(stem, _)| stem)).labels().to_lowercase();
    let filmed = |table: &Table| table.trials.iter().any(|t| t.readings.iter().any(|r| r.event == Event::Sample));
    let labels: Vec<String> = parts.iter().map(|(name, _)| named(name)).collect();
    let balls = labels.iter().all(|label| !label.is_empty()) && labels.iter().any(|label| *label != labels[0]);
    let films = parts.iter().filter(|(_, table)| filmed(table)).count();
    let kinds = films > 0 && films < parts.len();
    for ((_, table), label) in parts.iter_mut().zip(labels) {
        let kind = match filmed(table) {
            _ if !kinds => "",
            true => "recordings",
            false => "readings of bounces",
        };
        let label = if balls { label } else { String::new() };
        for trial in &mut table.trials {
            let parts = [label.as_str(), kind, &trial.group];
            trial.ball = trial.ball.or(Ball::named(&label));
            trial.group = parts.iter().filter(|p| !p.is_empty()).copied().collect::<Vec<_>>().join(", ");
        }
    }
}

/// Spells names of groups that differ in capitals, blanks, hyphens and slips of the pen alone as
/// the first of them: of rows that several people type; and what was read for slips. A letter or
/// two may be a mark, of which `a` and `A` are two.
pub(super) fn spelt(trials: &mut [Trial]) -> Vec<Note> {
    let mut notes = Vec::new();
    let mut known: Vec<(String, String)> = Vec::new();
    // Each name as it was written, and as it is spelt.
    let mut written: HashMap<String, String> = HashMap::new();
    for trial in trials.iter_mut().filter(|trial| trial.group.chars().nth(2).is_some()) {
        if known.last().is_some_and(|(_, name)| *name == trial.group) {
            continue;
        }
        if let Some(name) = written.get(&trial.group) {
            trial.group.clone_from(name);
            continue;
        }
        let plain = trial.group.replace(['-', '_'], " ").to_lowercase();
        let plain = plain.split_whitespace().collect::<Vec<_>>().join(" ");
        let like = |(other, _): &(String, String)| *other == plain || slipped(&plain, other).is_some();
        let name = match known.iter().position(like) {
            Some(n) => {
                notes.extend(slipped(&plain, &known[n].0).map(|(written, meant)| Note::Misspelt {
                    written: written.to_owned(),
                    heading: shown(&trial.group),
                    meant: meant.to_owned(),
                }));
                known[n].1.clone()
            }
            None => {
                known.push((plain, trial.group.clone()));
                trial.group.clone()
            }
        };
        written.insert(trial.group.clone(), name.clone());
        trial.group = name;
    }
    notes
}

/// The word in which a name differs from another one by a slip of the pen, and what was meant.
fn slipped<'a>(name: &'a str, other: &'a str) -> Option<(&'a str, &'a str)> {
    let mut unlike = name.split(' ').zip(other.split(' ')).filter(|(one, other)| one != other);
    let found = unlike.next().filter(|_| name.split(' ').count() == other.split(' ').count())?;
    let letters = |word: &str| word.chars().all(char::is_alphabetic) && word.chars().count() + 1 >= MISSPELT;
    (unlike.next().is_none() && letters(found.0) && letters(found.1) && slip(found.0, found.1)).then_some(found)
}

/// Takes out tables of ratios beside others, and of means of the drops of others: they were worked
/// out from them.
pub(super) fn measured<T>(parts: &mut Vec<T>, table: impl Fn(&T) -> &Table) -> Vec<T> {
    if parts.iter().all(|part| table(part).metadata.ratios) {
        return Vec::new();
    }
    let of_more = |trials: &[Trial]| {
        let more = || parts.iter().map(|part| &table(part).trials).filter(|other| other.len() > trials.len());
        if more().any(|other| means_of_settings(trials, other)) {
            return true;
        }
        let more = more();
        let mut drops: Vec<(f64, f64)> = more.flatten().filter_map(drop).collect();
        drops.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        means(trials, &drops)
    };
    let worked_out: Vec<bool> =
        parts.iter().map(&table).map(|table| table.metadata.ratios || of_more(&table.trials)).collect();
    let mut worked_out = worked_out.into_iter();
    let (found, others) = std::mem::take(parts).into_iter().partition(|_| worked_out.next() == Some(true));
    *parts = others;
    found
}

/// So many rebounds, and half of all, are the same from other drops by no chance.
const COPIED: usize = 3;

/// Two sheets of as many drops, whose rebounds are the same in many of the same rows, but from
/// other heights of release, are a question: one of them is a copy, and one of them is wrong.
pub(super) fn copied(name: &str, parts: &[(String, Table)]) -> Result<(), TableError> {
    let again = |(one, other): (&Trial, &Trial)| {
        drop(one).zip(drop(other)).is_some_and(|((from, to), (of, up))| to == up && from != of)
    };
    let copy = |one: &Table, other: &Table| {
        let count = one.trials.iter().zip(&other.trials).filter(|pair| again(*pair)).count();
        one.trials.len() == other.trials.len() && count >= COPIED && 2 * count >= one.trials.len()
    };
    let pairs = (0..parts.len()).flat_map(|n| (0..n).map(move |before| (before, n)));
    let mut found = pairs.filter(|&(one, other)| copy(&parts[one].1, &parts[other].1));
    let Some((one, other)) = found.next().map(|(one, other)| (&parts[one].0, &parts[other].0)) else { return Ok(()) };
    let message = format!("the sheets '{one}' and '{other}' hold the same rebounds from other drops");
    let help = format!("give the one that is right, such as --sheet '{one}'");
    Err(TableError::new(name, message).question().help(help))
}

/// The height of release and that of the rebound, of a trial that holds these alone.
fn drop(trial: &Trial) -> Option<(f64, f64)> {
    match trial.readings.as_slice() {
        [release, apex] if release.event == Event::Release && apex.event == Event::Apex => {
            release.height.zip(apex.height)
        }
        _ => None,
    }
}

/// Whether each trial is the mean of the drops, in the order of their heights, that are from where
/// it is, all as they are rounded.
fn means(trials: &[Trial], drops: &[(f64, f64)]) -> bool {
    let own = || trials.iter().filter_map(drop);
    let [of_heights, of_rebounds] = [step(own().map(|drop| drop.0)), step(own().map(|drop| drop.1))];
    let mean = |(height, rebound): (f64, f64)| {
        let same = |drop: &(f64, f64)| rounds_to(drop.0, height, of_heights);
        let from = drops.partition_point(|drop| drop.0 < height && !same(drop));
        let to = drops.partition_point(|drop| drop.0 <= height || same(drop));
        let same = &drops[from..to];
        #[allow(clippy::cast_precision_loss)] // drops of a workbook
        let mean = same.iter().map(|drop| drop.1).sum::<f64>() / same.len() as f64;
        same.len() > 1 && rounds_to(mean, rebound, of_rebounds)
    };
    trials.len() > 1 && trials.iter().all(|trial| drop(trial).is_some_and(mean))
}

/// Takes out sheets of heights that follow from the flights of another sheet by g T²/8, as programs
/// work them out. Flights that somebody takes for those heights are of a ball, whatever the sheets
/// say of it.
pub(super) fn computed(parts: &mut Vec<(String, Table)>) -> Vec<(String, Table)> {
    let follows = |heights: &Table, times: &Table| {
        let pairs = || heights.trials.iter().zip(&times.trials);
        heights.trials.len() == times.trials.len() && pairs().all(|(one, other)| flown(one, other))
    };
    let pairs = (0..parts.len()).flat_map(|of| (0..parts.len()).map(move |from| (of, from)));
    let found: Vec<(usize, usize)> =
        pairs.filter(|&(of, from)| of != from && follows(&parts[of].1, &parts[from].1)).collect();
    for (_, from) in &found {
        parts[*from].1.doubts.retain(|doubt| !matches!(doubt, Doubt::Unsaid { .. }));
    }
    let mut at = 0..;
    let of = |_: &(String, Table)| at.next().is_some_and(|n| found.iter().any(|(of, _)| *of == n));
    let (heights, others) = std::mem::take(parts).into_iter().partition(of);
    *parts = others;
    heights
}

/// Heights that are worked out differ by less than this part of them from what they follow from.
const WORKED_OUT: f64 = 0.005;

/// Whether the heights of a trial are those of the flights of another one, two or more, under the
/// gravity of the earth.
fn flown(heights: &Trial, times: &Trial) -> bool {
    let apexes: Vec<f64> =
        heights.readings.iter().filter(|r| r.event == Event::Apex).filter_map(|r| r.height).collect();
    let contacts: Vec<f64> =
        times.readings.iter().filter(|r| r.event == Event::Contact).filter_map(|r| r.time).collect();
    let timed = heights.readings.iter().any(|r| r.time.is_some()) || times.readings.iter().any(|r| r.height.is_some());
    let flights = contacts.windows(2).map(|pair| pair[1] - pair[0]);
    let alike =
        |(flight, height): (f64, &f64)| (STANDARD_GRAVITY * flight * flight / 8.0 / height - 1.0).abs() < WORKED_OUT;
    !timed && apexes.len() > 1 && contacts.len() == apexes.len() + 1 && flights.zip(&apexes).all(alike)
}

/// Whether each trial is one height, or one drop from the same height, the mean of the rebounds of
/// other trials of its condition, as it is rounded: `Mean rebound (m)` of each temperature, in a
/// sheet of its own.
fn means_of_settings(trials: &[Trial], others: &[Trial]) -> bool {
    let alone = |trial: &Trial| match trial.readings.as_slice() {
        [one] if one.time.is_none() => one.height,
        _ => drop(trial).map(|(_, rebound)| rebound),
    };
    // Groups of one sheet are conditions of the other, where each stands once.
    let key = |trial: &'_ Trial| -> Vec<String> {
        let conditions = || trial.conditions.iter().map(|(_, cell)| cell.clone());
        let group = Some(&trial.group).filter(|group| !group.is_empty()).cloned();
        group.map_or_else(|| conditions().collect(), |group| vec![group])
    };
    let step = step(trials.iter().filter_map(alone));
    let mean = |trial: &Trial| {
        // One of several, as of a temperature in degrees and in kelvins.
        let keys = key(trial);
        let own = others.iter().filter(|other| key(other).iter().any(|of| keys.contains(of)));
        let from = drop(trial).map(|(height, _)| height);
        let same = |height: f64| from.is_none_or(|from| (height / from - 1.0).abs() < 1e-9);
        let drops = own.filter_map(drop).filter(|(height, _)| same(*height));
        let rebounds: Vec<f64> = drops.map(|(_, rebound)| rebound).collect();
        #[allow(clippy::cast_precision_loss)] // drops of a workbook
        let mean = rebounds.iter().sum::<f64>() / rebounds.len() as f64;
        rebounds.len() > 1 && alone(trial).is_some_and(|height| rounds_to(mean, height, step))
    };
    trials.len() > 1 && trials.iter().all(mean)
}

/// Joins tables, each with what tells it from the others, into one of all their trials.
pub(super) fn join(name: &str, parts: Vec<(String, Table)>) -> Result<Table, TableError> {
    if parts.len() == 1 {
        return Ok(parts.into_iter().next().map(|(_, table)| table).unwrap_or_default());
    }
    let mut pooled = Table { name: name.to_owned(), ..Table::default() };
    let mut notes: Vec<(Remark<Note>, Vec<String>)> = Vec::new();
    for (n, (label, part)) in parts.into_iter().enumerate() {
        pooled.metadata = if n == 0 { part.metadata } else { agreed(name, &pooled.metadata, &part.metadata)? };
        for note in part.notes {
            match notes.iter_mut().find(|(known, _)| *known == note) {
                Some((_, of)) => of.push(label.clone()),
                None => notes.push((note, vec![label.clone()])),
            }
        }
        pooled.repairs.extend(part.repairs.into_iter().map(|repair| repair.of(&label)));
        // What names its place names the file, or the sheet.
        let placed = |warning: &Warning| match warning {
            Warning::Stray { at, .. } => at.file.ends_with(&label) || at.sheet.as_ref() == Some(&label),
            _ => false,
        };
        let of = |warning: Remark<Warning>| if placed(&warning.kind) { warning } else { warning.of(&label) };
        pooled.warnings.extend(part.warnings.into_iter().map(of));
        pooled.rows += part.rows;
        pooled.zero_rebounds += part.zero_rebounds;
        pooled.doubts.extend(part.doubts);
        pooled.sounds.extend(part.sounds);
        pooled.left_aside.extend(part.left_aside.into_iter().map(|aside| LeftAside {
            within: Some(aside.within.map_or(label.clone(), |inner| format!("{label}, {inner}"))),
            ..aside
        }));
        pooled.trials.extend(part.trials.into_iter().map(|trial| Trial {
            label: if trial.label.is_empty() { label.clone() } else { format!("{label}, {}", trial.label) },
            ..trial
        }));
    }
    // A remark on every part alike is made once.
    pooled.notes.extend(notes.into_iter().map(|(mut note, of)| {
        if let (Some(first), Some(last)) = (of.first(), of.last()) {
            note.parts.insert(0, Parts { first: first.clone(), last: last.clone(), count: of.len() });
        }
        note
    }));
    Ok(pooled)
}

/// What two tables state together. Gravity is one; of reading errors the larger one holds for both.
fn agreed(name: &str, a: &Metadata, b: &Metadata) -> Result<Metadata, TableError> {
    if let (Some(one), Some(other)) = (a.gravity, b.gravity)
        && (one - other).abs() > 1e-9 * one.abs()
    {
        return Err(TableError::new(name, format!("the tables state different gravity: {one} and {other} m/s²"))
            .help("fit them one by one, or correct the comments '# gravity:'"));
    }
    if a.pixels != b.pixels {
        return Err(TableError::new(name, "some of the tables are in pixels, others are not")
            .help("give --scale, such as --scale 1.5mm for one pixel, or fit them one by one"));
    }
    let larger = |x: Option<f64>, y: Option<f64>| x.into_iter().chain(y).reduce(f64::max);
    let smaller = |x: Option<f64>, y: Option<f64>| x.into_iter().chain(y).reduce(f64::min);
    Ok(Metadata {
        averaged: a.averaged.zip(b.averaged).map(|(one, other)| one.min(other)),
        frame_rate: smaller(a.frame_rate, b.frame_rate),
        gravity: a.gravity.or(b.gravity),
        drop: None,
        noted: None,
        sigma_height: larger(a.sigma_height, b.sigma_height),
        sigma_time: larger(a.sigma_time, b.sigma_time),
        pixels: a.pixels,
        intervals: a.intervals || b.intervals,
        speeds: a.speeds && b.speeds,
        ratios: a.ratios && b.ratios,
        oriented: a.oriented,
        falls_upwards: a.falls_upwards.or(b.falls_upwards),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::Reading;

    #[test]
    fn means_of_the_drops_of_another_sheet_were_worked_out() {
        let trial = |&(release, rebound): &(f64, f64)| {
            let reading = |event, height| Reading { height: Some(height), ..Reading::new(event, 0, 1) };
            let readings = vec![reading(Event::Release, release), reading(Event::Apex, rebound)];
            Trial { readings, ..Trial::default() }
        };
        let sheet = |drops: &[(f64, f64)]| Table { trials: drops.iter().map(trial).collect(), ..Table::default() };
        let drops = sheet(&[(1.0, 0.6), (1.0, 0.62), (2.0, 1.2), (2.0, 1.26)]);
        for (other, aside) in [
            (sheet(&[(1.0, 0.61), (2.0, 1.23)]), 1),
            // Another ball, one drop, and as many drops.
            (sheet(&[(1.0, 0.61), (2.0, 1.3)]), 0),
            (sheet(&[(1.0, 0.61)]), 0),
            (drops.clone(), 0),
        ] {
            let mut parts = vec![drops.clone(), other];
            assert_eq!(measured(&mut parts, |table| table).len(), aside);
            assert_eq!(parts.len() + aside, 2);
        }
    }
}
