//! Zeno: jumps accumulate where the times between them *and* what they change contract to nothing.

use std::array;

use crate::certainty::{FAR, FEW, ROUGHLY, ROUNDINGS, SMALL, TINY};
use crate::state::State;
use crate::time::resolution;

/// How many durations are remembered: two of the longest cycles.
const MEMORY: usize = 2 * LONGEST_CYCLE;
/// The longest repeating pattern of jumps looked for.
const LONGEST_CYCLE: usize = 8;

/// How many jumps are the first ones of a cascade: four of a ball between two.
const FIRST: usize = 8;

/// Durations so many of which are a part of each other, and when they were: three powers of eight.
const MARKS: usize = 4;

/// The states kept: two cycles back from the last jump.
const STATES: usize = 2 * LONGEST_CYCLE + 1;

/// Watches the durations between jumps, and how far the states x⁺ after them move from cycle to
/// cycle, for geometric contraction.
///
/// Both are needed: the collisions of an elastic chain come ever closer in time while each changes
/// as much as the one before, and no state lies beyond them.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Contraction<S> {
    durations: [f64; MEMORY],
    count: usize,
    /// The first of the last durations of each size, and how many there were with it.
    marks: [(f64, usize); MARKS],
    /// Kept only while jumps come in short times: no limit is near elsewhere, and a jump by a
    /// formula costs little more than their copy.
    states: Option<States<S>>,
}

/// The states x⁺ after the last jumps at each of the last instants.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct States<S> {
    /// The last of them, each in its turn.
    after: [S; STATES],
    count: usize,
    /// The square of the longest way that x⁺ went at first in a cycle of 1, 2, ... jumps.
    first: [f64; LONGEST_CYCLE],
}

impl<S: State> States<S> {
    #[cold]
    #[inline(never)]
    fn from(after: &S) -> Self {
        Self { after: array::from_fn(|_| after.clone()), count: 1, first: [0.0; LONGEST_CYCLE] }
    }

    /// x⁺ at the instant `back` instants ago, 0 for the last one.
    fn last(&self, back: usize) -> &S {
        &self.after[(self.count - 1 - back) % STATES]
    }

    #[cold]
    #[inline(never)]
    fn push(&mut self, after: &S) {
        if self.count <= MEMORY {
            for cycle in 1..=LONGEST_CYCLE.min(self.count) {
                let way = square_way(after, self.last(cycle - 1));
                self.first[cycle - 1] = self.first[cycle - 1].max(way);
            }
        }
        self.after[self.count % STATES] = after.clone();
        self.count += 1;
    }

    /// The last jump went on at once, to `after`.
    #[cold]
    #[inline(never)]
    fn replace(&mut self, after: &S) {
        self.after[(self.count - 1) % STATES] = after.clone();
    }

    /// Whether x⁺ moved by nothing in the last `cycle`, or by so much less than in the one before
    /// that what remains of its way is less than the longest of the first cycles.
    fn contract(&self, cycle: usize) -> bool {
        if self.count <= 2 * cycle {
            return false;
        }
        let way = |from: usize| square_way(self.last(from), self.last(from + cycle)).sqrt();
        let (now, before, first) = (way(0), way(cycle), self.first[cycle - 1].sqrt());
        now == 0.0 || now < before && now * now <= first * (before - now)
    }
}

impl<S: State> Contraction<S> {
    /// Before any jump.
    pub(crate) const fn new() -> Self {
        Self { durations: [0.0; MEMORY], count: 0, marks: [(0.0, 0); MARKS], states: None }
    }

    /// Adds a jump some time after the one at the instant before, and the state `after` it, which
    /// counts where that time was `short`; of jumps at one time the last one counts.
    #[inline]
    pub(crate) fn push(&mut self, duration: f64, short: bool, after: &S) {
        if duration > 0.0 {
            self.durations[self.count % MEMORY] = duration;
            self.count += 1;
            let (marked, _) = self.marks[MARKS - 1];
            if !(duration > ROUGHLY * marked && ROUGHLY * duration < marked) {
                self.mark(duration);
            }
            match &mut self.states {
                states if !short => *states = None,
                Some(states) => states.push(after),
                states => *states = Some(States::from(after)),
            }
        } else if let Some(states) = &mut self.states {
            states.replace(after);
        }
    }

    /// A duration of another size: of one that is longer others count no more.
    #[cold]
    #[inline(never)]
    fn mark(&mut self, duration: f64) {
        let mark = (duration, self.count);
        if duration > self.marks[MARKS - 1].0 {
            self.marks = [mark; MARKS];
        } else {
            self.marks.rotate_left(1);
            self.marks[MARKS - 1] = mark;
        }
    }

    /// Whether the durations have come down as a geometric series does of the last ratio, with
    /// `cycle` of them. Where ratios rise to one, as those of impacts that lose less the slower they
    /// are, durations fall as a power of their number, and a geometric series would have taken
    /// longer to come down as far; from what they are no bound follows. As long and half as long is
    /// too long. Held by `accumulation::ratios_that_rise_to_one_certify_no_limit`.
    fn is_geometric(&self, cycle: usize) -> bool {
        let back = (self.count.min(MEMORY) - 1) / cycle * cycle;
        let ((first, count), last) = (self.marks[0], self.last(0));
        let jumps = (self.count - count) as f64;
        let each = (self.last(back) / last).ln() / back as f64;
        each > 0.0 && (first / last).ln() <= (1.0 + FEW * ROUGHLY) * jumps * each
    }

    /// The duration `back` jumps ago, 0 for the last one.
    fn last(&self, back: usize) -> f64 {
        self.durations[(self.count - 1 - back) % MEMORY]
    }

    /// The limit after the last jump, if the durations contract and the next one is shorter than
    /// the resolution of the time `elapsed`.
    ///
    /// With a cycle of p jumps the certificate is that the last four ratios d(n)/d(n-p) are alike
    /// and all below one; with r the largest of them and S the last cycle's duration, what remains
    /// is at most S r/(1-r).
    ///
    /// Where rounding spoils the durations (`hidden`) before they are as short as that, nothing
    /// better can be had later: ratios that are clearly below one decide, and certify the limit if
    /// they do not rise.
    #[inline(always)]
    pub(crate) fn limit(&self, elapsed: f64, hidden: bool) -> Option<Ahead> {
        let open = self.count == 0 || self.last(0) > FAR * FAR * f64::EPSILON * elapsed && !hidden;
        if open { None } else { self.near(elapsed, hidden) }
    }

    #[cold]
    #[inline(never)]
    fn near(&self, elapsed: f64, hidden: bool) -> Option<Ahead> {
        if hidden {
            let ahead = self.certified(f64::INFINITY, 1.0 - SMALL)?;
            return Some(Ahead { certified: self.is_geometric(ahead.cycle), ..ahead });
        }
        // Too short to resolve: nothing moves. What rounding or a step leaves of ratios of one is
        // no contraction.
        self.certified(resolution(elapsed), 1.0 - TINY).map(|ahead| Ahead { cycle: 0, ..ahead })
    }

    fn certified(&self, resolution: f64, most: f64) -> Option<Ahead> {
        let known = self.count.min(MEMORY);
        let bound = |cycle| {
            if known < cycle + 4 {
                return None;
            }
            let ratios = (0..4.max(cycle)).filter(|i| i + cycle < known).map(|i| self.last(i) / self.last(i + cycle));
            let (least, ratio) = ratios.fold((f64::INFINITY, 0.0_f64), |(low, high), r| (low.min(r), high.max(r)));
            // One far below the others is of jumps that rounding keeps from being at one time.
            if least < SMALL * ratio {
                return None;
            }
            let last_cycle: f64 = (0..cycle).map(|i| self.last(i)).sum();
            let longest = (0..cycle).map(|i| self.last(i)).fold(0.0, f64::max);
            (ratio < most
                && longest * ratio < resolution
                && self.states.as_ref().is_some_and(|states| states.contract(cycle)))
            .then(|| {
                let cycles = ratio / (1.0 - ratio);
                Ahead { remaining: last_cycle * cycles, cycle, cycles, certified: true }
            })
        };
        // Each is an upper bound: rise and fall of a ball differ by a rounding, and as a cycle of
        // one would seem to hardly contract.
        let shorter = |best: Ahead, next: Ahead| if next.remaining < 0.5 * best.remaining { next } else { best };
        (1..=LONGEST_CYCLE).filter_map(bound).reduce(shorter)
    }

    /// The state at the limit `ahead` of the last one, `x`: what its last cycle moved it by goes on
    /// as the durations do, be it the last of its bounces or the way of what does not bounce.
    pub(crate) fn at(&self, ahead: &Ahead, x: &S) -> S {
        match &self.states {
            Some(states) if ahead.cycle > 0 && states.last(ahead.cycle).len() == x.len() => {
                let before = states.last(ahead.cycle);
                x.with(|i| x.get(i) + ahead.cycles * moved(before.get(i), x.get(i)))
            }
            _ => x.clone(),
        }
    }
}

/// Where jumps accumulate, ahead of the last one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ahead {
    /// After how long.
    pub(crate) remaining: f64,
    /// How many jumps a cycle has, and how many times as long as the last one all further cycles
    /// last.
    cycle: usize,
    cycles: f64,
    /// Whether the ratios bound what remains; not where rounding hides whether.
    pub(crate) certified: bool,
}

impl Ahead {
    /// At once.
    pub(crate) const fn now(certified: bool) -> Self {
        Self { remaining: 0.0, cycle: 0, cycles: 0.0, certified }
    }
}

/// Jumps at one time, one after the other, and how far they move the state.
///
/// What lies beyond them is a limit where they contract: a ball between two that close on it. Jumps
/// that change nothing, or as much as ever, have none: a relay that switches to and fro.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Cascade {
    jumps: usize,
    /// The square of the longest way of a jump among the first ones, and since the last power of
    /// two of them.
    first: f64,
    late: f64,
}

impl Cascade {
    pub(crate) const NONE: Self = Self { jumps: 0, first: 0.0, late: 0.0 };

    /// After one more jump, from the state after the one before to the state `after` it.
    #[cold]
    #[inline(never)]
    pub(crate) fn and<S: State>(self, before: S, after: S) -> Self {
        let (jumps, way) = (self.jumps + 1, square_way(&before, &after));
        let first = if jumps <= FIRST { self.first.max(way) } else { self.first };
        let late = if jumps.is_power_of_two() { way } else { self.late.max(way) };
        Self { jumps, first, late }
    }

    pub(crate) const fn jumps(&self) -> usize {
        self.jumps
    }

    /// Whether the jumps moved the state, and hardly do so any more: so many that no more are
    /// looked at, or by no more than rounding leaves of the first ones.
    pub(crate) fn contracts(&self, most: usize) -> bool {
        // A harmonic series, which has no limit, would still be larger after a million jumps.
        let to = if self.jumps >= most { TINY } else { f64::EPSILON };
        self.jumps > FIRST && self.first > 0.0 && self.late <= to * to * self.first
    }
}

/// |x - y|², where a coordinate that differs by no more than its rounding does not differ; endless
/// where the two have unlike dimensions.
#[inline]
fn square_way<S: State>(x: &S, y: &S) -> f64 {
    if x.len() != y.len() {
        return f64::INFINITY;
    }
    (0..x.len()).map(|i| moved(x.get(i), y.get(i)).powi(2)).sum()
}

/// From `x` to `y`, which is nothing within their rounding.
#[inline]
fn moved(x: f64, y: f64) -> f64 {
    let by = y - x;
    if by.abs() <= ROUNDINGS * f64::EPSILON * x.abs().max(y.abs()) { 0.0 } else { by }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A time whose resolution is 1e-12 s.
    const LATE: f64 = 5000.0;

    #[test]
    fn a_geometric_series_is_summed() {
        let mut contraction = Contraction::new();
        let mut d = 1.0;
        let mut sum = 0.0;
        while contraction.limit(LATE, false).is_none() {
            contraction.push(d, true, &d);
            sum += d;
            d *= 0.8;
        }
        assert!((sum + contraction.limit(LATE, false).unwrap().remaining - 5.0).abs() < 1e-14);
    }

    #[test]
    fn jumps_that_stay_as_large_are_not_zeno() {
        for growth in [1.0, 1.01, 0.999_999] {
            for turn in [1.0, -1.0] {
                let mut contraction = Contraction::new();
                let (mut d, mut by, mut x) = (1.0, 1.0, 0.0);
                for n in 0..400 {
                    x += by;
                    contraction.push(d, true, &if n % 2 == 0 { x } else { turn * x });
                    assert_eq!(contraction.limit(LATE, false), None);
                    (d, by) = (0.8 * d, growth * by);
                }
            }
        }
    }

    #[test]
    fn a_harmonic_series_is_not_zeno() {
        let mut contraction = Contraction::new();
        for n in 1..100_000 {
            contraction.push(1e-3 / f64::from(n), true, &0.0);
            assert_eq!(contraction.limit(LATE, false), None);
        }
    }

    #[test]
    fn a_cascade_is_not_zeno() {
        let mut contraction = Contraction::new();
        for duration in [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] {
            contraction.push(duration, true, &0.0);
            assert_eq!(contraction.limit(LATE, false), None);
        }
    }

    #[test]
    fn jumps_that_are_all_but_at_one_time_are_not_zeno() {
        // Swings of one length but for rounding, and two collisions a rounding apart.
        let mut contraction = Contraction::new();
        for duration in [1.0, 1.0_f64.next_down(), 0.9, 0.1, 1e-17] {
            contraction.push(duration, true, &0.0);
            assert_eq!(contraction.limit(LATE, false), None);
        }
    }

    #[test]
    fn a_cascade_contracts_where_its_jumps_do() {
        let ends = |way: fn(i32) -> f64| {
            let (mut cascade, mut x) = (Cascade::NONE, 0.0);
            for n in 0..10_000 {
                let next = x + way(n);
                cascade = cascade.and(x, next);
                x = next;
            }
            cascade.contracts(10_000)
        };
        assert!(ends(|n| 0.5_f64.powi(n)) && ends(|n| -(-0.995_f64).powi(n)));
        assert!(!ends(|_| 0.0) && !ends(|_| 1.0) && !ends(|n| if n % 2 == 0 { 1.0 } else { -1.0 }));
        assert!(!ends(|n| 1.0 / f64::from(n + 1)));
    }

    #[test]
    fn a_cascade_of_nothing_but_rounding_ends_before_it_leaves_the_range_of_numbers() {
        for power in 2..=15 {
            let (mut cascade, mut speed) = (Cascade::NONE, 1.0);
            while !cascade.contracts(10_000) {
                let next = speed * 10_f64.powi(-power);
                cascade = cascade.and(speed, next);
                speed = next;
                assert!(speed * speed > 0.0, "1e-{power} after {} jumps", cascade.jumps());
            }
        }
    }

    #[test]
    fn a_cycle_of_two_contracts_as_a_whole() {
        let mut contraction = Contraction::new();
        let mut d = 1.0;
        let mut sum = 0.0;
        for _ in 0..60 {
            for part in [d, 3.0 * d] {
                contraction.push(part, true, &part);
                sum += part;
            }
            d *= 0.5;
            if let Some(ahead) = contraction.limit(LATE, false) {
                assert!((sum + ahead.remaining - 8.0).abs() < 1e-12);
                return;
            }
        }
        panic!("not recognised");
    }
}
