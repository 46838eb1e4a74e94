//! Contacts that were missed, heard twice or misread: found by comparing each interval with the ones beside it, and put right.
//!
//! The usual ratio of neighbouring intervals is found robustly over all trials. From two intervals that go together the run is followed
//! both ways. An interval that does not follow is one of four things: two flights with a contact missed between them; a flight that a
//! second trigger cut in two; one of the two neighbours of a misread contact; or the end of what can be used.

use crate::finding::FindingKind;
use crate::statistics::median;

/// Intervals are compared only where there are at least this many ratios to tell the usual one.
const RATIOS: usize = 4;
/// From this many ratios on, the densest part of them is taken instead of the middle.
const MANY: usize = 9;
const DENSEST: f64 = 0.4;
/// An interval this much shorter or longer than expected does not follow.
const SHORT: f64 = 0.75;
const LONG: f64 = 1.25;
/// Sums that a repair rests on must match to this part.
const MATCH: f64 = 0.12;

/// A contact: flights since the first, when, and its place among the readings it came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contact {
    pub(crate) flights: usize,
    pub(crate) time: f64,
    pub(crate) place: usize,
}

/// What was done to a trial.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Repair {
    /// A contact was missed after this one: later ones count one more.
    Missed { after: f64 },
    /// This contact is a second trigger.
    Double { at: f64 },
    /// This contact was misread.
    Misread { at: f64 },
    /// Nothing before, or nothing after, follows from the rest.
    Ended { last: f64, left_out: usize, before: bool },
}

/// The usual ratio of neighbouring intervals; `None` of too few.
pub(crate) fn usual(mut ratios: Vec<f64>) -> Option<f64> {
    if ratios.len() < RATIOS {
        return None;
    }
    if ratios.len() < MANY {
        return median(&mut ratios);
    }
    // The shortest interval of logarithms that holds a good part of the ratios: half of them may be spoilt.
    let mut logs: Vec<f64> = ratios.iter().map(|r| r.ln()).collect();
    logs.sort_unstable_by(f64::total_cmp);
    let part = ((DENSEST * logs.len() as f64).ceil() as usize).max(RATIOS);
    let narrowest = logs.windows(part).min_by(|a, b| (a[part - 1] - a[0]).total_cmp(&(b[part - 1] - b[0])))?;
    Some(median(&mut narrowest.to_vec())?.exp())
}

/// How one end of a run goes on.
enum Next {
    Follows,
    Missed,
    Double,
    Misread,
    End,
}

/// Judges the next contacts in the direction of the run, where the next interval should last `due` and the one after it `then`.
fn next(gaps: [Option<f64>; 3], due: f64, then: f64, slack: f64) -> Next {
    let Some(gap) = gaps[0] else { return Next::End };
    let near = |x: f64, wanted: f64| (x - wanted).abs() <= (MATCH * wanted).max(slack);
    let follows = |x: f64, wanted: f64| {
        let factor = x / wanted;
        (SHORT..LONG).contains(&factor) || (x - wanted).abs() <= slack
    };
    // A misread contact may leave its first interval within the band, but then the second is out of it.
    let loosely = follows(gap, due);
    if near(gap, due) || loosely && gaps[1].is_none_or(|g| follows(g, gap * then / due)) {
        return Next::Follows;
    }
    let two = gaps[1].map(|g| gap + g);
    let goes_on = gaps[1].is_none_or(|g| follows(g, then * then / due));
    if near(gap, due + then) && goes_on {
        return Next::Missed;
    }
    if gap < due && two.is_some_and(|two| near(two, due)) {
        return Next::Double;
    }
    if two.is_some_and(|two| near(two, due + then)) {
        return Next::Misread;
    }
    if loosely { Next::Follows } else { Next::End }
}

/// Puts one trial's contacts in order: those to keep, renumbered, and what was done.
///
/// `ratio` is the usual ratio of an interval to the one before it, `noise` the error of a time if it is known.
pub(crate) fn mend(contacts: &[Contact], ratio: f64, noise: f64) -> (Vec<Contact>, Vec<Repair>) {
    let slack = 4.0 * noise * (2.0 + 2.0 * ratio + 2.0 * ratio * ratio).sqrt();
    let interval = |i: usize| contacts[i + 1].time - contacts[i].time;
    let together = |i: &usize| {
        let factor = interval(i + 1) / interval(*i) / ratio;
        (SHORT..LONG).contains(&factor) || (interval(i + 1) - ratio * interval(*i)).abs() <= slack
    };
    // The run starts where two intervals go together best.
    let off = |i: usize| (interval(i + 1) / interval(i) / ratio).ln().abs();
    let pairs = (0..contacts.len().saturating_sub(2)).filter(together);
    let Some(anchor) = pairs.min_by(|&a, &b| off(a).total_cmp(&off(b))) else {
        return (contacts.to_vec(), Vec::new());
    };
    let mut repairs = Vec::new();
    // Forwards from the anchor's three contacts: steps in number from one kept contact to the next.
    let mut kept: Vec<(usize, usize)> = vec![(anchor, 0), (anchor + 1, 1), (anchor + 2, 1)];
    let mut last = interval(anchor + 1);
    let mut at = anchor + 2;
    while at + 1 < contacts.len() {
        let gap = |n: usize| contacts.get(at + n + 1).map(|c| c.time - contacts[at + n].time);
        let due = ratio * last;
        match next([gap(0), gap(1), gap(2)], due, ratio * due, slack) {
            Next::Follows => {
                last = interval(at);
                at += 1;
                kept.push((at, 1));
            }
            Next::Missed => {
                repairs.push(Repair::Missed { after: contacts[at].time });
                last = interval(at) * ratio / (1.0 + ratio);
                at += 1;
                kept.push((at, 2));
            }
            Next::Double => {
                repairs.push(Repair::Double { at: contacts[at + 1].time });
                last = interval(at) + interval(at + 1);
                at += 2;
                kept.push((at, 1));
            }
            Next::Misread => {
                repairs.push(Repair::Misread { at: contacts[at + 1].time });
                last = (interval(at) + interval(at + 1)) * ratio / (1.0 + ratio);
                at += 2;
                kept.push((at, 2));
            }
            Next::End => {
                let left_out = contacts.len() - 1 - at;
                repairs.push(Repair::Ended { last: contacts[at].time, left_out, before: false });
                break;
            }
        }
    }
    // Backwards: the same, with the inverse ratio; found steps are put in front.
    let mut front: Vec<(usize, usize)> = Vec::new();
    let (mut last, mut at) = (interval(anchor), anchor);
    while at > 0 {
        let gap = |n: usize| at.checked_sub(n + 1).map(&interval);
        // The contact the run has come to may itself be a second trigger: then the one before it takes its place.
        if let (Some(first), Some(second)) = (gap(0), gap(1))
            && first < 0.5 * last / ratio
            && (second / ((last + first) / ratio) - 1.0).abs() <= MATCH
        {
            repairs.push(Repair::Double { at: contacts[at].time });
            let place = front.last_mut().unwrap_or(&mut kept[0]);
            place.0 = at - 1;
            (last, at) = (last + first, at - 1);
            continue;
        }
        let due = last / ratio;
        // The step is that from the contact put in front to the one behind it.
        let (to, step, repair) = match next([gap(0), gap(1), gap(2)], due, due / ratio, slack) {
            Next::Follows => (at - 1, 1, None),
            Next::Missed => (at - 1, 2, Some(Repair::Missed { after: contacts[at - 1].time })),
            Next::Double => (at - 2, 1, Some(Repair::Double { at: contacts[at - 1].time })),
            Next::Misread => (at - 2, 2, Some(Repair::Misread { at: contacts[at - 1].time })),
            Next::End => {
                repairs.push(Repair::Ended { last: contacts[at].time, left_out: at, before: true });
                break;
            }
        };
        let whole = contacts[at].time - contacts[to].time;
        last = if step == 2 { whole / (1.0 + ratio) } else { whole };
        repairs.extend(repair);
        front.push((to, step));
        at = to;
    }
    let mut number = contacts[at].flights;
    let mut mended = Vec::with_capacity(kept.len() + front.len());
    let mut place = |index: usize, number: usize| mended.push(Contact { flights: number, ..contacts[index] });
    // Each in front bears the step to the one behind it.
    for &(index, step) in front.iter().rev() {
        place(index, number);
        number += step;
    }
    for &(index, step) in &kept {
        number += step;
        place(index, number);
    }
    (mended, repairs)
}

impl Repair {
    /// How many contacts it leaves out because they follow from nothing else.
    pub(crate) fn adrift(&self) -> usize {
        if let Self::Ended { left_out, .. } = self { *left_out } else { 0 }
    }

    /// As a finding.
    pub(crate) fn finding(&self) -> FindingKind {
        match *self {
            Self::Missed { after } => FindingKind::ContactMissed { after_s: after },
            Self::Double { at } => FindingKind::ContactTwice { at_s: at },
            Self::Misread { at } => FindingKind::ContactMisread { at_s: at },
            Self::Ended { last, left_out, before } => FindingKind::RunEnded { at_s: last, left_out, before },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contacts(times: &[f64]) -> Vec<Contact> {
        times.iter().enumerate().map(|(n, &time)| Contact { flights: n, time, place: n }).collect()
    }

    fn ideal(count: i32) -> Vec<f64> {
        (0..count).map(|n| (1.0 - 0.8f64.powi(n)) / 0.2).collect()
    }

    /// Every kept contact has the number it truly has.
    fn right(mended: &[Contact], first: usize) -> bool {
        let truth = ideal(20);
        mended.iter().all(|c| (truth[c.flights + first] - c.time).abs() < 1e-9)
    }

    #[test]
    fn a_contact_missed_anywhere_is_counted() {
        for gone in 1..9 {
            let mut times = ideal(10);
            times.remove(gone);
            let (mended, repairs) = mend(&contacts(&times), 0.8, 0.0);
            assert!(right(&mended, 0) && mended.len() == 9, "{gone}: {mended:?} {repairs:?}");
            assert!(matches!(repairs[..], [Repair::Missed { .. }]), "{gone}: {repairs:?}");
        }
    }

    #[test]
    fn a_second_trigger_is_taken_out() {
        for twice in 0..8 {
            let mut times = ideal(10);
            times.insert(twice + 1, times[twice] + 0.04);
            let (mended, repairs) = mend(&contacts(&times), 0.8, 0.0);
            let kept: Vec<f64> = mended.iter().map(|c| c.time).collect();
            assert_eq!(repairs.len(), 1, "{twice}: {repairs:?}");
            assert!(
                kept.len() == 10 && mended.windows(2).all(|w| w[1].flights == w[0].flights + 1),
                "{twice}: {kept:?}"
            );
        }
    }

    #[test]
    fn a_misread_contact_is_left_out_and_the_others_keep_their_numbers() {
        for bad in 1..8 {
            let mut times = ideal(10);
            times[bad] += 0.3 * (times[bad + 1] - times[bad]);
            let (mended, repairs) = mend(&contacts(&times), 0.8, 0.0);
            assert!(right(&mended, 0) && mended.len() == 9, "{bad}: {mended:?} {repairs:?}");
        }
    }

    #[test]
    fn whole_runs_are_left_alone() {
        let whole = contacts(&ideal(12));
        assert_eq!(mend(&whole, 0.8, 0.0), (whole, Vec::new()));
        assert_eq!(mend(&[], 0.8, 0.0), (Vec::new(), Vec::new()));
    }

    #[test]
    fn the_usual_ratio_bears_half_of_them_spoilt() {
        let mut ratios: Vec<f64> = (0..10).map(|n| 0.8 + 0.002 * f64::from(n)).collect();
        ratios.extend((0..9).map(|n| 0.2 + 0.3 * f64::from(n)));
        assert!((usual(ratios).unwrap() - 0.81).abs() < 0.02);
        assert_eq!(usual(vec![0.8; 3]), None);
    }
}
