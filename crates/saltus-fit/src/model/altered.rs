//! Readings as they would have been: with another zero of the height scale, another height of
//! release, or without the air.

use super::drag::Air;
use super::flight::FOLLOWED;
use crate::evidence::{Evidence, TrialEvidence};
use crate::statistics::TELLING;

/// The speed that a flight of this duration starts with is found to a part of 1e-12 in so many
/// rounds: each leaves a tenth of the error at most.
const ROUNDS: usize = 12;

/// A part of the readings that tells what a change does to the COR: trials evenly spaced, each from
/// its beginning.
pub(crate) fn telling(evidence: &Evidence) -> Evidence {
    let readings: usize = evidence.trials.iter().map(|t| t.heights.len().max(t.moments.len()).min(TELLING)).sum();
    let trials = evidence.trials.iter().step_by(readings.div_ceil(TELLING).max(1)).cloned();
    let mut few = Evidence::supposed(trials.collect());
    for trial in &mut few.trials {
        trial.heights.truncate(TELLING);
        trial.moments.truncate(TELLING);
    }
    few
}

/// The ball left the floor by this part of the least height that was read, at least.
const LEFT: f64 = 0.1;

/// By how much heights may be read too high, m: the ball did leave the floor.
pub(crate) fn lowered_at_most(evidence: &Evidence) -> f64 {
    let read = evidence.trials.iter().flat_map(|trial| trial.heights.iter().map(|h| h.1));
    (1.0 - LEFT) * read.fold(f64::INFINITY, f64::min)
}

/// With heights read higher by so much, m.
pub(crate) fn raised(evidence: &Evidence, by: f64) -> Evidence {
    let mut altered = evidence.clone();
    let by = by.max(-lowered_at_most(evidence));
    for trial in &mut altered.trials {
        trial.heights.iter_mut().for_each(|h| h.1 += by);
        trial.release_height.iter_mut().for_each(|h| h.0 += by);
    }
    altered
}

/// With all lengths read larger by this factor.
pub(crate) fn rescaled(evidence: &Evidence, factor: f64) -> Evidence {
    let mut altered = evidence.clone();
    for trial in &mut altered.trials {
        trial.heights.iter_mut().for_each(|h| h.1 *= factor);
        trial.release_height.iter_mut().for_each(|h| h.0 *= factor);
    }
    altered
}

/// With one rebound missing before that of this number in every trial: the later ones count one
/// more.
pub(crate) fn missed(evidence: &Evidence, before: usize) -> Evidence {
    let mut altered = evidence.clone();
    for trial in &mut altered.trials {
        trial.heights.iter_mut().filter(|h| h.0 >= before).for_each(|h| h.0 += 1);
    }
    altered
}

/// With the height of release alone higher by so much, m, where its error is not stated.
pub(crate) fn released_higher(evidence: &Evidence, by: f64) -> Evidence {
    let mut altered = evidence.clone();
    for trial in &mut altered.trials {
        trial.release_height.iter_mut().filter(|h| h.1.is_none()).for_each(|h| h.0 += by);
    }
    altered
}

/// Without the air: less by what drag `k`, 1/m, makes of a motion with the COR `e`.
///
/// The motion starts at the first height of a trial, or with its first flight, and is followed with
/// drag and without.
pub(crate) fn without_air(evidence: &Evidence, (gravity, drag): (f64, f64), e: f64) -> Evidence {
    let mut altered = evidence.clone();
    let airs = [drag, 0.0].map(|drag| Air { gravity, drag });
    for trial in &mut altered.trials {
        heights(trial, airs, e);
        times(trial, airs, e);
    }
    altered
}

fn heights(trial: &mut TrialEvidence, airs: [Air; 2], e: f64) {
    let Some(&(first, height, _)) = trial.heights.first() else { return };
    let (mut at, mut both) = (first, [height; 2]);
    for reading in &mut trial.heights {
        while at < reading.0.min(FOLLOWED) {
            both = [0, 1].map(|n| airs[n].hop(e * airs[n].speed(both[n]).value).height.value);
            at += 1;
        }
        // A ball that lies still is slowed by nothing.
        reading.1 = (reading.1 - (both[0] - both[1])).max(0.5 * reading.1);
    }
}

/// The speed that a ball leaves the first contact with if the flights from one number to another
/// last so long together.
fn launch(air: Air, e: f64, (from, to, lasts): (usize, usize, f64)) -> f64 {
    let flights = (from..to).fold(0.0, |sum, n| sum + e.powi(i32::try_from(n).unwrap_or(i32::MAX)));
    let mut speed = 0.5 * air.gravity * lasts / flights;
    for _ in 0..ROUNDS {
        let (mut at, mut together) = (speed, 0.0);
        for n in 0..to {
            let hop = air.hop(at);
            together += if n < from { 0.0 } else { hop.rise.value + hop.fall.value };
            at = e * hop.arrival.value;
        }
        speed *= lasts / together;
    }
    speed
}

fn times(trial: &mut TrialEvidence, airs: [Air; 2], e: f64) {
    let released = trial.release_height.filter(|_| trial.release_time.is_some()).map(|h| h.0);
    let contacts: Vec<(usize, f64)> = trial.moments.iter().filter(|m| !m.1).map(|m| (m.0, m.2)).take(2).collect();
    let first = contacts.first().zip(contacts.get(1)).map(|(a, b)| (a.0, b.0, b.1 - a.1));
    let first = first.filter(|(from, to, lasts)| from < to && *to < FOLLOWED && *lasts > 0.0);
    let Some(last) = trial.moments.last().map(|m| m.0) else { return };
    // The time of the first contact, and the speed with which the ball leaves it.
    let starts = airs.map(|air| match (released, first) {
        (Some(height), _) => {
            let arrival = air.speed(height).value;
            Some((air.fallen(arrival).0.value, e * arrival))
        }
        (None, Some(between)) => Some((0.0, launch(air, e, between))),
        (None, None) => None,
    });
    let [Some(mut with), Some(mut without)] = starts else { return };
    let mut by = Vec::with_capacity(last + 1);
    for _ in 0..=last.min(FOLLOWED) {
        let mut apexes = [0.0; 2];
        let before = with.0 - without.0;
        for (n, (time, speed)) in [&mut with, &mut without].into_iter().enumerate() {
            let hop = airs[n].hop(*speed);
            apexes[n] = *time + hop.rise.value;
            (*time, *speed) = (apexes[n] + hop.fall.value, e * hop.arrival.value);
        }
        by.push((before, apexes[0] - apexes[1]));
    }
    for moment in &mut trial.moments {
        if let Some(&(contact, apex)) = by.get(moment.0) {
            moment.2 -= if moment.1 { apex } else { contact };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion with drag, taken without it, is that of the same COR in a vacuum: to first order in
    /// what is taken off, and here exactly.
    #[test]
    fn the_air_is_taken_off() {
        let (e, air) = (0.8, Air { gravity: 9.81, drag: 0.05 });
        let mut trial = TrialEvidence::default();
        let (mut height, mut time) = (1.0, 0.3);
        for n in 0..6 {
            trial.heights.push((n, height, None));
            let hop = air.hop(e * air.speed(height).value);
            trial.moments.push((n, false, time, None));
            (height, time) = (hop.height.value, time + hop.rise.value + hop.fall.value);
        }
        let evidence = Evidence { trials: vec![trial], ..Evidence::default() };
        let altered = without_air(&evidence, (9.81, 0.05), e);
        for (n, (number, height, _)) in altered.trials[0].heights.iter().enumerate() {
            assert!(*number == n && (height - 0.64f64.powi(n as i32)).abs() < 1e-12, "{n}: {height}");
        }
        let ratios: Vec<f64> = altered.trials[0].ratios().map(|r| r.3).collect();
        assert!(ratios.len() == 4 && ratios.iter().all(|r| (r - e).abs() < 1e-9), "{ratios:?}");
        // A contact that is missing changes nothing for the others.
        let mut gap = evidence.clone();
        gap.trials[0].heights.clear();
        gap.trials[0].moments.remove(1);
        let moments = &without_air(&gap, (9.81, 0.05), e).trials[0].moments;
        let last = |n: usize| moments[n + 1].2 - moments[n].2;
        assert!((last(2) / last(1) - e).abs() < 1e-9 && (last(0) * e * e / (1.0 + e) - last(1)).abs() < 1e-9);
    }
}
