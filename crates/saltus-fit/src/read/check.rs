//! What a table may hold that must not be counted: rebounds of zero height, copied trials.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

use super::grid::shown;
use super::{Event, Reading, Table, Trial};
use crate::finding::{Doubt, Lines, Named, Repair, Warning};

/// Where balls are dropped from, in metres.
const USUAL: std::ops::RangeInclusive<f64> = 0.02..=20.0;

/// Nothing is read finer, m and s: what is left of a multiple below it is rounding in binary.
const FINEST: f64 = 1e-9;

/// How much drops of the same ball from the same height differ at the least, as a part of the
/// reading.
const DIFFER: f64 = 0.02;
/// Trials that agree in every reading are copies if that would happen by chance less often than
/// once in so many powers of ten; else they repeat each other.
const CHANCE: f64 = 6.0;

/// Takes out what must not be counted, notes what has no logarithm, and says so.
pub(super) fn table(table: &mut Table) {
    zeros(table);
    copies(table);
    if !table.metadata.pixels && !table.metadata.speeds {
        size(table);
    }
}

/// Heights nobody drops a ball from are a unit gone wrong.
fn size(table: &mut Table) {
    let heights = || table.trials.iter().flat_map(|t| &t.readings).filter_map(|r| r.height.map(|h| (h, r.line)));
    let Some((highest, line)) = heights().max_by(|a, b| a.0.total_cmp(&b.0)) else { return };
    if highest > 0.0 && !USUAL.contains(&highest) {
        table.warnings.push(Warning::Size { height_m: highest, line }.into());
    }
}

fn zeros(table: &mut Table) {
    let zero = |r: &&Reading| r.event == Event::Apex && r.height == Some(0.0) && r.time.is_none();
    let lines: Vec<u64> = table.trials.iter().flat_map(|t| &t.readings).filter(zero).map(|r| r.line).collect();
    if !lines.is_empty() {
        table.warnings.push(Warning::Zeros { lines: Lines::of(&lines) }.into());
        table.zero_rebounds = lines.len();
    }
}

fn copies(table: &mut Table) {
    let mut seen: HashMap<u64, Vec<usize>> = HashMap::new();
    let mut copies = vec![false; table.trials.len()];
    let step = steps(&table.trials);
    for (n, trial) in table.trials.iter().enumerate() {
        if trial.readings.iter().any(|r| r.event == Event::Sample) || told(trial, step) < CHANCE {
            continue;
        }
        let candidates = seen.entry(fingerprint(trial)).or_default();
        if let Some(&original) = candidates.iter().find(|&&m| alike(&table.trials[m], trial)) {
            copies[n] = true;
            let (trial, as_trial) = (named(trial, n), named(&table.trials[original], original));
            table.repairs.push(Repair::SameTrial { trial, as_trial }.into());
        } else {
            candidates.push(n);
        }
    }
    let mut copied = copies.iter();
    table.trials.retain(|_| !copied.next().copied().unwrap_or(false));
}

/// Heights, and times, to the last digit.
type Digits = Vec<(bool, u64)>;

/// The doubt about balls, floors or heights of release whose readings are the same to the last
/// digit, as those of no two are: those of one were copied.
pub(super) fn copied(trials: &[Trial]) -> Option<Doubt> {
    let step = steps(trials);
    let filmed = |trial: &Trial| trial.readings.iter().any(|r| r.event == Event::Sample);
    let among = |name: fn(&Trial) -> &str| {
        let mut order: Vec<&str> = Vec::new();
        let mut all: HashMap<&str, (Digits, f64)> = HashMap::new();
        for trial in trials.iter().filter(|trial| !filmed(trial)) {
            let (read, chance) = all.entry(name(trial)).or_insert_with(|| {
                order.push(name(trial));
                Default::default()
            });
            read.extend(numbers(trial).map(|(timed, x)| (timed, x.to_bits())));
            *chance += told(trial, step);
        }
        // What all of them share is less likely the more they are.
        let first = &all.get(order.first()?)?.0;
        let others = if all.values().all(|(read, _)| read == first) { all.len().saturating_sub(1).max(1) } else { 1 };
        let mut seen: HashMap<&Digits, &str> = HashMap::new();
        order.iter().find_map(|name| {
            #[allow(clippy::cast_precision_loss)] // balls of a table
            let (read, _) = all.get(name).filter(|(_, chance)| others as f64 * chance >= CHANCE)?;
            let of = seen.insert(read, name)?;
            Some(Doubt::Copied { one: shown(name), other: shown(of) })
        })
    };
    among(|trial| &trial.group).or_else(|| among(|trial| &trial.setting))
}

/// The readings of a trial beside its release, which is set: heights, and times.
fn numbers(trial: &Trial) -> impl Iterator<Item = (bool, f64)> + Clone + '_ {
    let read = trial.readings.iter().filter(|r| r.event != Event::Release);
    read.flat_map(|r| r.height.map(|h| (false, h)).into_iter().chain(r.time.map(|t| (true, t))))
        .filter(|(_, x)| *x > 0.0)
}

/// To how much heights and times were read, m and s: in whatever unit they were written, they are
/// multiples of it.
fn steps(trials: &[Trial]) -> [f64; 2] {
    let read = |timed: bool| trials.iter().flat_map(numbers).filter(move |(t, _)| *t == timed).map(|(_, x)| x);
    [false, true].map(|timed| read(timed).fold(0.0, common).max(FINEST))
}

/// The largest step of which two numbers are multiples (Euclid's algorithm).
fn common(one: f64, other: f64) -> f64 {
    let largest = one.max(other);
    let (mut a, mut b) = (largest, one.min(other));
    while b > FINEST {
        (a, b) = (b, (a - (a / b).round() * b).abs());
    }
    // As exact as the number is that it is a part of: what rounding moved it by grows from pair to
    // pair.
    largest / (largest / a).round()
}

/// How many powers of ten it is against one that another trial has the same readings.
fn told(trial: &Trial, step: [f64; 2]) -> f64 {
    numbers(trial).map(|(timed, x)| (DIFFER * x / step[usize::from(timed)]).log10().max(0.0)).sum()
}

fn named(trial: &Trial, n: usize) -> Named {
    Named { trial: n + 1, name: trial.label.clone() }
}

fn fingerprint(trial: &Trial) -> u64 {
    let mut hasher = DefaultHasher::new();
    for r in &trial.readings {
        (r.event, r.bounce, r.time.map(f64::to_bits), r.height.map(f64::to_bits)).hash(&mut hasher);
    }
    hasher.finish()
}

fn alike(a: &Trial, b: &Trial) -> bool {
    a.readings.len() == b.readings.len()
        && a.readings
            .iter()
            .zip(&b.readings)
            .all(|(x, y)| (x.event, x.bounce, x.time, x.height) == (y.event, y.bounce, y.time, y.height))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn balls_are_dropped_from_usual_heights() {
        let warned = |height: f64| {
            let mut found = Table::from_heights(&[height, 0.64 * height]).unwrap();
            found.warnings.clear();
            size(&mut found);
            !found.warnings.is_empty()
        };
        assert!(!warned(0.03) && !warned(15.0) && warned(0.015) && warned(25.0));
    }

    /// Of four heights that all agree, three digits each are met by chance once in five hundred
    /// pairs of drops, four digits once in fifteen million.
    #[test]
    fn only_what_hardly_agrees_by_chance_is_a_copy() {
        let counted = |heights: [f64; 4]| {
            let apex = |(n, height)| Reading { height: Some(height), ..Reading::new(Event::Apex, n, 1) };
            let readings: Vec<Reading> = (1..).zip(heights).map(apex).collect();
            let trial = Trial { readings, ..Trial::default() };
            let mut table = Table { trials: vec![trial.clone(), trial], ..Table::default() };
            copies(&mut table);
            table.trials.len()
        };
        assert_eq!(counted([0.641, 0.412, 0.263, 0.169]), 2);
        assert_eq!(counted([0.6413, 0.4121, 0.2637, 0.1693]), 1);
    }
}
