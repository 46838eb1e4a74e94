//! How the guard of an edge was searched over a step, and what is in doubt.

use std::fmt;
use std::ops::Range;

use crate::automaton::Automaton;
use crate::cross::{Doubt, Evidence};
use crate::time::Time;

/// How the guard of one edge was searched over one step, or over one exact arc.
///
/// ```
/// use saltus::cross::Doubt;
/// use saltus::{Hybrid, Simulation};
///
/// // A guard that swings more than a million times a second is too fast to be followed through a step.
/// let fast = Hybrid::new()
///     .mode("wait", |_t, _x: &f64| 1.0)
///     .terminal("wait", |t, _x| 1.5 + (1e7 * t).sin());
/// let run = Simulation::of(&fast).run("wait", 0.0, 0.0..1.0)?;
///
/// let doubt = run.trajectory.doubts().last().unwrap();
/// assert_eq!(doubt.evidence.doubt(), Some(Doubt::Unresolved));
/// assert_eq!(doubt.doubt().map(|when| when.end), Some(1.0));
/// assert!(doubt.to_string().contains("varies too fast"));
/// # Ok::<(), saltus::Error>(())
/// ```
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
#[derive(Clone, Copy)]
pub struct Inspection<M, E> {
    /// The mode.
    pub mode: M,
    /// The edge.
    pub edge: E,
    /// Where the step starts.
    pub start: Time,
    /// How far the search went, in seconds; infinite on an exact arc of a run without an end.
    pub span: f64,
    /// What was found: no crossing, one that was isolated, or where rounding or haste hides one.
    /// Times count from `start`.
    pub evidence: Evidence,
}

/// An inspection of the automaton `A`.
pub type InspectionOf<A> = Inspection<<A as Automaton>::Mode, <A as Automaton>::Edge>;

impl<M: Copy, E: Copy> Inspection<M, E> {
    /// Between which times, in seconds, a crossing may have been missed; `None` where the search
    /// leaves no doubt.
    #[must_use]
    pub fn doubt(&self) -> Option<Range<f64>> {
        let (from, to) = when(self.evidence)?;
        Some(self.start.after(from).seconds()..self.start.after(to).seconds())
    }

    /// The same doubt up to `end`; `None` if it lies after that.
    pub(crate) fn until(self, end: Time) -> Option<Self> {
        let (from, _) = when(self.evidence)?;
        (from < end.since(self.start)).then(|| self.up_to(end))
    }

    /// The same doubt cut at `end`, where it begins at the latest.
    fn up_to(self, end: Time) -> Self {
        let span = self.span.min(end.since(self.start));
        let cut = |(from, to): (f64, f64)| between(self.evidence, from.min(span), to.min(span));
        Self { span, evidence: when(self.evidence).map_or(self.evidence, cut), ..self }
    }

    /// Takes in a doubt of the same kind, of this step or a later one, that overlaps this one or
    /// follows without a gap; says whether it did.
    pub(crate) fn joined_by(&mut self, other: &Self) -> bool {
        let (Some((from, to)), Some((next, end))) = (when(self.evidence), when(other.evidence)) else {
            return false;
        };
        let after = other.start.since(self.start);
        let (next, end) = (after + next, after + end);
        let rounding = 4.0 * f64::EPSILON * to.abs();
        let same = self.evidence.doubt() == other.evidence.doubt();
        let joins = same && next <= to + rounding && end >= from - rounding;
        if joins {
            self.span = self.span.max(after + other.span);
            self.evidence = between(self.evidence, from.min(next), to.max(end));
        }
        joins
    }

    /// The same with time running the other way.
    pub(crate) fn turned(&self, negative: impl Fn(Time) -> Time) -> Self {
        let &Self { start, span, evidence, .. } = self;
        let evidence = when(evidence).map_or(evidence, |(from, to)| between(evidence, span - to, span - from));
        Self { start: negative(start.after(span)), evidence, ..*self }
    }
}

/// From when to when a doubt lasts.
const fn when(evidence: Evidence) -> Option<(f64, f64)> {
    match evidence {
        Evidence::Doubtful { from, to, .. } => Some((from, to)),
        Evidence::Excluded | Evidence::Isolated => None,
    }
}

/// The same doubt, from another time to another.
const fn between(evidence: Evidence, from: f64, to: f64) -> Evidence {
    match evidence {
        Evidence::Doubtful { why, .. } => Evidence::doubtful(why, from, to),
        sure => sure,
    }
}

impl<M: fmt::Debug, E: fmt::Debug> fmt::Debug for Inspection<M, E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, edge, start, span, evidence } = self;
        write!(f, "{mode:?} edge {edge:?} from t = {} for {span} s: {evidence:?}", start.seconds())
    }
}

impl<M: Copy + fmt::Debug, E: Copy + fmt::Debug> fmt::Display for Inspection<M, E> {
    /// What was found, where, and, of a doubt, what to do.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, edge, start, span, evidence } = self;
        let Range { start: from, end: to } =
            self.doubt().unwrap_or_else(|| start.seconds()..start.after(*span).seconds());
        write!(f, "edge {edge:?} in mode {mode:?}, t = {from} to {to}: ")?;
        f.write_str(match evidence {
            Evidence::Excluded => "not crossed; bounds on its guard leave no room",
            Evidence::Isolated => "searched until no part had room for more than one crossing",
            Evidence::Doubtful { why, .. } => advice(*why),
        })
    }
}

/// What is in doubt, and what to do.
const fn advice(why: Doubt) -> &'static str {
    match why {
        Doubt::Grazing => {
            "its guard comes as close to zero as the error of the step, and turns: whether it is crossed there \
             is not decided. If that matters, lower Simulation::tolerance"
        }
        Doubt::Rounding => {
            "its guard is zero but for rounding and was taken for a touch; two crossings may hide there. \
             If that matters, write the guard so that it does not cancel"
        }
        Doubt::Unresolved => {
            "its guard varies too fast to be followed, and a crossing may have been missed. \
             Shorten Simulation::longest_step, or give the guard a slower form"
        }
        Doubt::Discontinuous => {
            "its guard changes sign without coming near zero: a pole is no crossing, a leap is taken for one. \
             Write the guard so that it is continuous"
        }
        Doubt::Accumulated => {
            "its jumps came so close that rounding hides whether they accumulate, and were taken to. \
             If that matters, count time and place from nearer by"
        }
        Doubt::Missed => {
            "its guard is below zero at the end, and no crossing was found on the way. \
             Lower Simulation::tolerance or shorten Simulation::longest_step, and compare"
        }
    }
}

/// The doubts of a run: first those that stand, then those of the step in progress, whose end is
/// not built yet.
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[derive(Clone)]
pub(crate) struct Doubts<M, E> {
    list: Vec<Inspection<M, E>>,
    settled: usize,
}

/// So many doubts back an edge has its last one: as many as a step is likely to raise.
const LATELY: usize = 16;

impl<M, E> Doubts<M, E> {
    pub(crate) fn list(&self) -> &[Inspection<M, E>] {
        &self.list
    }
}

impl<M: Copy + PartialEq, E: Copy + PartialEq> Doubts<M, E> {
    pub(crate) const fn new() -> Self {
        Self { list: Vec::new(), settled: 0 }
    }

    pub(crate) fn add(&mut self, inspection: &Inspection<M, E>) {
        self.list.push(*inspection);
    }

    /// The step in progress ends here: what is doubted after it was not gone through, unless the
    /// edge is taken. Each that stands is `noted`.
    #[inline]
    pub(crate) fn settle(&mut self, end: Time, noted: impl FnMut(E)) {
        if self.settled < self.list.len() {
            self.settle_all(end, noted);
        }
    }

    #[cold]
    #[inline(never)]
    fn settle_all(&mut self, end: Time, mut noted: impl FnMut(E)) {
        let mut next = self.settled;
        while let Some(doubt) = self.list.get(next) {
            match doubt.until(end) {
                Some(doubt) => {
                    self.list.remove(next);
                    noted(doubt.edge);
                    next += usize::from(self.stands(doubt));
                }
                None => next += 1,
            }
        }
    }

    /// An arc ended at this time, by the edge `taken` if one was. Its search ended where its guard
    /// falls: what is doubted of it stands, but for a leap, which lies where it is.
    #[inline]
    pub(crate) fn end_arc(&mut self, time: Time, taken: Option<E>, noted: impl FnMut(E, bool)) {
        if self.settled < self.list.len() {
            self.end_doubted(time, taken, noted);
        }
    }

    #[cold]
    #[inline(never)]
    fn end_doubted(&mut self, time: Time, taken: Option<E>, mut noted: impl FnMut(E, bool)) {
        for doubt in self.list.split_off(self.settled) {
            let leaps = doubt.evidence.doubt() == Some(Doubt::Discontinuous);
            let of_taken = || (taken == Some(doubt.edge) && !leaps).then(|| doubt.up_to(time));
            let stands = doubt.until(time).or_else(of_taken);
            noted(doubt.edge, stands.is_some());
            stands.map(|doubt| self.stands(doubt));
        }
    }

    /// Puts a doubt to those that stand, or to the last of this edge; says whether the list grew.
    fn stands(&mut self, doubt: Inspection<M, E>) -> bool {
        let alike = |last: &&mut Inspection<M, E>| last.edge == doubt.edge && last.mode == doubt.mode;
        let last = self.list.iter_mut().take(self.settled).rev().take(LATELY).find(alike);
        if last.is_some_and(|last| last.joined_by(&doubt)) {
            return false;
        }
        self.list.insert(self.settled, doubt);
        self.settled += 1;
        true
    }
}

impl<M: fmt::Debug, E: fmt::Debug> fmt::Debug for Doubts<M, E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.list.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The longest that a doubt of these tests lasts, in s.
    const LONGEST: f64 = 3.0;

    proptest! {
        /// As an arc ends, a doubt stands up to there if it begins before, or is of the edge that
        /// was taken and no leap; no other does.
        #[test]
        fn an_arc_ends_with_the_doubts_up_to_its_end(
            raised in prop::collection::vec((0..3_u8, 0.0..10.0_f64, 0.0..LONGEST, any::<bool>()), 0..20),
            taken in prop::option::of(0..3_u8),
            end in 0.0..10.0_f64,
        ) {
            let why = |leaps| if leaps { Doubt::Discontinuous } else { Doubt::Grazing };
            let mut doubts = Doubts::new();
            for &(edge, from, length, leaps) in &raised {
                let evidence = Evidence::doubtful(why(leaps), from, from + length);
                doubts.add(&Inspection { mode: (), edge, start: Time::new(0.0), span: 10.0 + LONGEST, evidence });
            }
            let mut stood = Vec::new();
            doubts.end_arc(Time::new(end), taken, |edge, stands| stood.push((edge, stands)));

            let due = |&(edge, from, _, leaps): &(u8, f64, f64, bool)| from < end || taken == Some(edge) && !leaps;
            prop_assert_eq!(stood, raised.iter().map(|raised| (raised.0, due(raised))).collect::<Vec<_>>());
            let list: Vec<_> = doubts.list().iter().map(|doubt| (doubt.edge, doubt.doubt().unwrap())).collect();
            for (edge, when) in &list {
                prop_assert!(when.end <= end, "{when:?} of {edge} is after {end}");
                prop_assert!(raised.iter().any(|raised| raised.0 == *edge && due(raised)));
            }
            for raised in raised.iter().filter(|raised| due(raised)) {
                let [from, to] = [raised.1, raised.1 + raised.2].map(|t| t.min(end));
                let covered = list.iter().any(|(edge, when)| *edge == raised.0 && when.start <= from && to <= when.end);
                prop_assert!(covered, "{raised:?} is not in {list:?}");
            }
        }
    }
}
