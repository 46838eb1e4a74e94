//! Which sounds are contacts of a bouncing ball: those whose intervals shrink, from each to the
//! next, by nearly one factor, and which are about as loud as their neighbours.
//!
//! Sounds of anything else come at such times by chance as well, the oftener the more there are. So
//! a chain of contacts is worth what it says against chance: the chance that of sounds as frequent
//! as here one lies as near to where the next contact is due, from contact to contact, times how
//! many chains could have begun.

use std::collections::HashMap;

use super::onset::Onset;
use crate::elementary::{exp, hypot, ln};

/// The flights looked for, s: shorter ones are one sound, in three seconds a ball rises 11 m.
const FLIGHTS: std::ops::RangeInclusive<f64> = 0.008..=3.0;
/// The longest flight of a chain lasts at least so long, s: a rebound of 4 mm. The pulses of a
/// voice are closer, and as regular as a ball.
const LONG: f64 = 0.06;
/// The ratios of a flight to the one before. No ball keeps more; what keeps time does.
const RATIOS: std::ops::Range<f64> = 0.15..0.998;
/// How far the logarithm of the second ratio may be off the first, and of a later one off the mean
/// of the last three.
const FREE: f64 = 0.14;
const BOUND: f64 = 0.08;
/// So many ratios tell the next.
const LAST: usize = 3;
/// How much louder and fainter than the one before a contact may be, in the logarithm of power (9
/// and 20 dB): they fade, but no two are alike.
const LOUDER: f64 = 2.0;
const FAINTER: f64 = 4.5;
/// No contact follows a louder sound within this part of the flight before it: an echo does.
const ECHO: f64 = 0.2;
/// An echo comes so soon after its sound, s: of a wall in 34 m.
const LATE: f64 = 0.2;
/// Of several sounds near where a contact is due, a difference of loudness by this much weighs like
/// one of time by all that there may be.
const SPREAD: f64 = 2.5;
/// The onsets of two contacts may be off by so much, s, as their sounds are not alike.
const SLACK: f64 = 0.001;
/// A chain begins with sounds of which no more than so many within half a second of them are
/// louder: the work then grows as the length of the recording, whatever is in it.
const PROMINENT: usize = 8;
const AROUND: f64 = 0.5;
/// The error of a time that a contact counts with, in parts of its flight: beyond, it tells the
/// COR of its bounce worse than bounces scatter.
const WORTH: f64 = 0.01;
/// The evidence against what chance does once in ten times: enough to take a contact for missed
/// whose next one is where it is due.
pub(super) const LIKELY: f64 = 2.3;
/// A ball is heard for sure where as good a chain comes by chance once in a thousand recordings.
pub(crate) const SURE: f64 = 6.9;

/// Contacts of one ball.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Chain {
    /// Their places among the onsets, at least three.
    pub(super) at: Vec<usize>,
    /// Which contacts they are, from 0: one may not be heard.
    pub(super) numbers: Vec<usize>,
    /// How many of them count: the times of later ones no longer tell their flights.
    pub(super) counts: usize,
    /// ln of one over how many chains as good come by chance.
    pub(super) evidence: f64,
}

/// The chains that are heard: the surest, and of all others those that are sure and of another
/// time; in the order of time.
pub(super) fn chains(onsets: &[Onset]) -> Vec<Chain> {
    let listener = Listener { onsets, levels: onsets.iter().map(Onset::level).collect() };
    let mut found = listener.all();
    found.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    let mut kept: Vec<Chain> = Vec::new();
    for chain in found {
        let span = |chain: &Chain| [chain.at[0], chain.at[chain.at.len() - 1]];
        let [first, last] = span(&chain);
        let apart = kept.iter().map(span).all(|[from, to]| last < from || to < first);
        if apart && (kept.is_empty() || chain.evidence >= SURE) {
            kept.push(chain);
        }
    }
    kept.sort_by_key(|chain| chain.at[0]);
    kept.into_iter().map(|chain| Chain { counts: listener.counting(&chain.at), ..chain }).collect()
}

/// A contact next to a chain.
struct Link {
    onset: usize,
    /// How many flights lie between, and how long the one next to it lasts, s.
    flights: usize,
    flight: f64,
    /// ln of the ratio of flights.
    ratio: f64,
    /// What it adds to the evidence.
    worth: f64,
}

struct Listener<'a> {
    onsets: &'a [Onset],
    levels: Vec<f64>,
}

impl Listener<'_> {
    fn time(&self, n: usize) -> f64 {
        self.onsets[n].time
    }

    /// Whether the contact `b` may be the one after `a` by how loud they are.
    fn fades(&self, a: usize, b: usize) -> bool {
        (-FAINTER..=LOUDER).contains(&(self.levels[b] - self.levels[a]))
    }

    /// Whether a sound follows a louder one so soon, beside a flight, that it is its echo.
    fn echoes(&self, n: usize, flight: f64) -> bool {
        let from = self.onsets.partition_point(|onset| onset.time < self.time(n) - ECHO * flight);
        self.levels[from..n].iter().any(|level| *level > self.levels[n])
    }

    /// The onsets than which few around them are louder.
    fn prominent(&self) -> Vec<usize> {
        let from = |t: f64| self.onsets.partition_point(|onset| onset.time < t);
        let few = |n: usize| {
            let around = from(self.time(n) - AROUND)..from(self.time(n) + AROUND);
            self.levels[around].iter().filter(|level| **level > self.levels[n]).count() <= PROMINENT
        };
        (0..self.onsets.len()).filter(|&n| few(n)).collect()
    }

    /// The chains that go on from three prominent onsets, each once.
    fn all(&self) -> Vec<Chain> {
        let prominent = self.prominent();
        let (mut found, mut pairs, mut begun): (Vec<Chain>, _, f64) = (Vec::new(), HashMap::new(), 0.0);
        for (n, &i) in prominent.iter().enumerate() {
            for (m, &j) in prominent.iter().enumerate().skip(n + 1) {
                let flight = self.time(j) - self.time(i);
                if flight > *FLIGHTS.end() {
                    break;
                }
                if flight < LONG || !self.fades(i, j) || self.echoes(i, flight) || self.echoes(j, flight) {
                    continue;
                }
                for &k in &prominent[m + 1..] {
                    let ratio = (self.time(k) - self.time(j)) / flight;
                    if ratio >= RATIOS.end {
                        break;
                    }
                    if ratio < RATIOS.start || !self.fades(j, k) || self.echoes(k, ratio * flight) {
                        continue;
                    }
                    begun += 1.0;
                    if pairs.get(&(i, j)).is_some_and(|chain| pairs.get(&(j, k)) == Some(chain)) {
                        continue; // of a chain that was followed
                    }
                    let chain = self.followed([i, j, k]);
                    pairs.extend(chain.at.windows(2).map(|pair| ((pair[0], pair[1]), found.len())));
                    found.push(chain);
                }
            }
        }
        // What it began with may be an echo, or a tap: in its middle it is surest.
        let again = |chain: &Chain| {
            let middle = (chain.at.len() - 3) / 2;
            let again = self.followed([chain.at[middle], chain.at[middle + 1], chain.at[middle + 2]]);
            let surer = if again.at.len() + 1 >= chain.at.len() { again } else { chain.clone() };
            Chain { evidence: surer.evidence - ln(begun), ..self.direct(surer) }
        };
        found.iter().map(again).collect()
    }

    /// The sounds of which those of a chain are echoes, if so: louder, and each as long before.
    fn direct(&self, chain: Chain) -> Chain {
        let first = chain.at[0];
        let of = |delay: f64| {
            let source = |(&n, &number): (&usize, &usize)| {
                let due = self.time(n) - delay;
                let from = self.onsets.partition_point(|onset| onset.time < due - SLACK);
                let near = (from..n).take_while(|&m| self.time(m) <= due + SLACK);
                near.filter(|&m| self.levels[m] > self.levels[n]).map(|m| (m, number)).next()
            };
            chain.at.iter().zip(&chain.numbers).filter_map(source).unzip()
        };
        let from = self.onsets.partition_point(|onset| onset.time < self.time(first) - LATE);
        let delays = (from..first).map(|n| self.time(first) - self.time(n));
        let all_but_one = |(at, _): &(Vec<usize>, Vec<usize>)| at.len() >= 3.max(chain.at.len() - 1);
        match delays.map(of).find(all_but_one) {
            Some((at, numbers)) => Chain { counts: at.len(), at, numbers, ..chain },
            None => chain,
        }
    }

    /// The chain to both sides of three contacts.
    fn followed(&self, seed: [usize; 3]) -> Chain {
        let [i, j, k] = seed;
        let flights = [self.time(j) - self.time(i), self.time(k) - self.time(j)];
        let (mut at, mut numbers, mut evidence) = (seed.to_vec(), vec![0, 1, 2], 0.0);
        let mut ratios = vec![ln(flights[1] / flights[0])];
        let (mut last, mut flight) = (k, flights[1]);
        while let Some(link) = self.link((last, flight), &ratios, true) {
            at.push(link.onset);
            numbers.push(numbers[numbers.len() - 1] + link.flights);
            ratios.push(link.ratio);
            evidence += link.worth;
            (last, flight) = (link.onset, link.flight);
        }
        ratios.reverse();
        (last, flight) = (i, flights[0]);
        while let Some(link) = self.link((last, flight), &ratios, false) {
            numbers.iter_mut().for_each(|number| *number += link.flights);
            at.insert(0, link.onset);
            numbers.insert(0, 0);
            ratios.push(link.ratio);
            evidence += link.worth;
            (last, flight) = (link.onset, link.flight);
        }
        Chain { counts: at.len(), at, numbers, evidence }
    }

    /// The contact after the `last` one of a chain, or backwards the one before: the next, or
    /// where none is heard the one after that, if it is as good as sure.
    fn link(&self, last: (usize, f64), ratios: &[f64], forwards: bool) -> Option<Link> {
        self.linked(last, ratios, forwards, 1).or_else(|| {
            let missed = if ratios.len() < LAST { None } else { self.linked(last, ratios, forwards, 2) };
            missed.filter(|link| link.worth >= LIKELY)
        })
    }

    /// The contact so many `flights` from the `last` one, next to which a `flight` is known.
    fn linked(&self, (last, flight): (usize, f64), ratios: &[f64], forwards: bool, flights: usize) -> Option<Link> {
        let sign = if forwards { 1.0 } else { -1.0 };
        let known = &ratios[ratios.len().saturating_sub(LAST)..];
        #[allow(clippy::cast_precision_loss)] // up to three
        let expected = known.iter().sum::<f64>() / known.len() as f64;
        let free = if ratios.len() == 1 { FREE } else { BOUND };
        // With the factor x from flight to flight: x, or x + x² for two.
        let span = |ratio: f64| {
            let x = exp(sign * ratio);
            flight * if flights == 1 { x } else { x + x * x }
        };
        let due = |off: f64| span((expected + off).min(ln(RATIOS.end)));
        let [near, far] = [due(-sign * free) - SLACK, due(sign * free) + SLACK];
        if far > *FLIGHTS.end() || near < *FLIGHTS.start() - SLACK {
            return None;
        }
        let window = if forwards {
            self.time(last) + near..self.time(last) + far
        } else {
            self.time(last) - far..self.time(last) - near
        };
        let from = self.onsets.partition_point(|onset| onset.time < window.start);
        let to = self.onsets.partition_point(|onset| onset.time <= window.end);
        let may = |&n: &usize| {
            let fades = if forwards { self.fades(last, n) } else { self.fades(n, last) };
            n != last && fades && !self.echoes(n, due(0.0))
        };
        let apart = |n: usize| (self.time(n) - self.time(last)).abs();
        let factor = |n: usize| {
            let part = apart(n) / flight;
            if flights == 1 { part } else { 0.5 * ((1.0 + 4.0 * part).sqrt() - 1.0) }
        };
        let off = |n: usize| sign * ln(factor(n)) - expected;
        let cost = |n: usize| (off(n) / free).powi(2) + ((self.levels[n] - self.levels[last]) / SPREAD).powi(2);
        let next = (from..to).filter(may).min_by(|&a, &b| cost(a).total_cmp(&cost(b)))?;
        // How many as good ones chance puts as near: as often as they come there, or on the way.
        let least = self.levels[next].min(self.levels[last]);
        let way = if forwards { last + 1..next } else { next + 1..last };
        let passed = self.levels[way].iter().filter(|level| **level > least).count();
        let rivals = (from..to).filter(may).count();
        #[allow(clippy::cast_precision_loss)] // counts of sounds
        let often = (rivals as f64 / (far - near)).max((passed + 1) as f64 / apart(next));
        let missed = off(next).abs() * apart(next) + self.onsets[next].sigma + self.onsets[last].sigma;
        let (x, ratio) = (factor(next), sign * ln(factor(next)));
        let flight = if flights == 1 { flight * x } else { flight * x * x };
        Some(Link { onset: next, flights, flight, ratio, worth: -ln(2.0 * missed * often) })
    }

    /// How many contacts, from the first, have times that tell their flights.
    fn counting(&self, at: &[usize]) -> usize {
        let tells = |pair: &[usize]| {
            let [a, b] = [pair[0], pair[1]].map(|n| self.onsets[n]);
            hypot(a.sigma, b.sigma) <= WORTH * (b.time - a.time)
        };
        at.windows(2).take_while(|pair| tells(pair)).count() + 1
    }
}
