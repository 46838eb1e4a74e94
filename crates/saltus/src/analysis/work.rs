//! What accuracy costs: runs to several tolerances, each with its error, its counts and its time.

use std::ops::Range;
use std::time::Instant;

use crate::automaton::Automaton;
use crate::ending::{RunOf, Stats};
use crate::error::Error;
use crate::simulation::Simulation;
use crate::step::Stepper;

/// How often a run is timed at most.
const REPEATS: usize = 25;
/// After how many seconds it is not timed again.
const PATIENCE: f64 = 0.05;
/// How much looser the run is by which the error of a reference is estimated.
const LOOSER: f64 = 100.0;

/// How long something takes on this machine, in seconds: the median of repeated runs, the least and
/// the greatest.
///
/// ```
/// let timing = saltus::Timing::of(|| std::hint::black_box((0..1000).sum::<u32>()));
/// assert!(timing.least <= timing.median && timing.median <= timing.greatest);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Timing {
    /// The median.
    pub median: f64,
    /// The least.
    pub least: f64,
    /// The greatest.
    pub greatest: f64,
}

impl Timing {
    /// Runs it up to 25 times, or for a twentieth of a second; once at least.
    #[must_use]
    pub fn of<T>(run: impl FnMut() -> T) -> Self {
        Self::repeated(REPEATS, PATIENCE, run)
    }

    /// Runs it up to `most` times, or for `patience` seconds; once at least.
    #[must_use]
    pub fn repeated<T>(most: usize, patience: f64, mut run: impl FnMut() -> T) -> Self {
        let began = Instant::now();
        let mut seconds = Vec::new();
        while seconds.is_empty() || (seconds.len() < most && began.elapsed().as_secs_f64() < patience) {
            let start = Instant::now();
            std::hint::black_box(run());
            seconds.push(start.elapsed().as_secs_f64());
        }
        seconds.sort_by(f64::total_cmp);
        Self { median: seconds[seconds.len() / 2], least: seconds[0], greatest: seconds[seconds.len() - 1] }
    }
}

/// One run of a work–precision diagram.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct WorkPoint {
    /// What it was run by.
    pub method: String,
    /// The relative tolerance asked for.
    pub tolerance: f64,
    /// How far the farthest of its answers is from the reference; infinite if there are more or
    /// fewer of them.
    pub error: f64,
    /// What it cost, in counts: the same on every machine.
    pub stats: Stats,
    /// What it cost, in seconds: on this machine.
    pub timing: Timing,
}

/// Work against precision, for any automaton: how far off a run is at each tolerance, and what that
/// costs.
///
/// A question turns a run into numbers (times of jumps, the final state); the error is the largest
/// difference from the reference's numbers. The reference is known, or it is a run to a tighter
/// tolerance whose own error is estimated.
///
/// ```
/// use saltus::{Hybrid, Run, Simulation, Tsit5, WorkPrecision};
/// let decay = Hybrid::new().mode("decay", |_t, x: &f64| -x);
/// let start = ("decay", 1.0, 0.0..1.0);
/// let mut work = WorkPrecision::known(start, |run: &Run<_, _, _>| vec![run.end.state], vec![(-1.0_f64).exp()]);
/// for tolerance in [1e-4, 1e-6, 1e-8] {
///     work.measure("Tsit5", &Simulation::of(&decay).stepper(Tsit5).tolerance(tolerance))?;
/// }
/// let [loose, _, tight] = work.points() else { panic!() };
/// assert!(tight.error < 1e-2 * loose.error && tight.stats.flows > loose.stats.flows);
/// assert!(work.cheapest(1e-6).is_some_and(|point| point.error <= 1e-6 && point.tolerance > 1e-8));
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct WorkPrecision<A: Automaton, Q> {
    start: (A::Mode, A::State, Range<f64>),
    question: Q,
    reference: Vec<f64>,
    doubt: f64,
    points: Vec<WorkPoint>,
}

impl<A: Automaton, Q: Fn(&RunOf<A>) -> Vec<f64>> WorkPrecision<A, Q> {
    /// Against the right answers, from a mode and a state over a span of time.
    pub const fn known(start: (A::Mode, A::State, Range<f64>), question: Q, reference: Vec<f64>) -> Self {
        Self { start, question, reference, doubt: 0.0, points: Vec::new() }
    }

    /// Against a run of `simulation`; its error is taken for the difference between it and a run to
    /// a hundred times its tolerance, which is larger.
    ///
    /// # Errors
    /// Those of [`Simulation::run`].
    pub fn against<M: Stepper>(
        simulation: &Simulation<'_, A, M>,
        start: (A::Mode, A::State, Range<f64>),
        question: Q,
    ) -> Result<Self, Error> {
        let (mode, state, span) = &start;
        let reference = question(&simulation.run(*mode, state.clone(), span.clone())?);
        let looser = simulation.tolerance(LOOSER * simulation.relative_tolerance());
        let doubt = farthest(&question(&looser.run(*mode, state.clone(), span.clone())?), &reference);
        Ok(Self { start, question, reference, doubt, points: Vec::new() })
    }

    /// Runs `simulation`, compares and times it, and keeps the point under the name `method`.
    ///
    /// # Errors
    /// Those of [`Simulation::run`]; then no point is kept.
    pub fn measure<M: Stepper>(
        &mut self,
        method: &str,
        simulation: &Simulation<'_, A, M>,
    ) -> Result<&WorkPoint, Error> {
        let (mode, state, span) = &self.start;
        let run = simulation.run(*mode, state.clone(), span.clone())?;
        let error = farthest(&(self.question)(&run), &self.reference);
        let timing = Timing::of(|| simulation.drive(*mode, state.clone(), span.clone(), &mut ()));
        let tolerance = simulation.relative_tolerance();
        self.points.push(WorkPoint { method: method.to_owned(), tolerance, error, stats: run.end.stats, timing });
        Ok(&self.points[self.points.len() - 1])
    }

    /// How far the reference itself may be off; zero where it is known.
    pub const fn doubt(&self) -> f64 {
        self.doubt
    }

    /// What was measured, in order.
    pub fn points(&self) -> &[WorkPoint] {
        &self.points
    }

    /// The point of the fewest evaluations whose error, together with the reference's, is at most
    /// `error`.
    pub fn cheapest(&self, error: f64) -> Option<&WorkPoint> {
        let good = self.points.iter().filter(|point| point.error + self.doubt <= error);
        good.min_by_key(|point| point.stats.evaluations())
    }
}

/// The largest difference; infinite if the lengths differ.
fn farthest(one: &[f64], other: &[f64]) -> f64 {
    if one.len() != other.len() {
        return f64::INFINITY;
    }
    let gap = |(a, b): (&f64, &f64)| if a == b { 0.0 } else { (a - b).abs() };
    one.iter().zip(other).map(gap).fold(0.0, |worst, gap| if gap > worst || gap.is_nan() { gap } else { worst })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Hybrid, Tsit5};

    #[test]
    fn another_number_of_answers_is_infinitely_far_and_nan_is_not_near() {
        assert_eq!(farthest(&[1.0], &[1.0, 2.0]), f64::INFINITY);
        assert_eq!(farthest(&[f64::INFINITY, 1.0], &[f64::INFINITY, 1.5]), 0.5);
        assert!(farthest(&[f64::NAN, 1.0], &[0.0, 1.0]).is_nan());
    }

    #[test]
    fn a_reference_run_says_how_far_off_it_may_be() {
        let decay = Hybrid::new().mode("decay", |_t, x: &f64| -x);
        let tight = Simulation::of(&decay).stepper(Tsit5).tolerance(1e-10);
        let mut work = WorkPrecision::against(&tight, ("decay", 1.0, 0.0..1.0), |run| vec![run.end.state]).unwrap();
        assert!(work.doubt() > 0.0 && work.doubt() < 1e-7);
        work.measure("Tsit5", &Simulation::of(&decay).stepper(Tsit5).tolerance(1e-4)).unwrap();
        assert!(work.points()[0].error > work.doubt());
        assert_eq!(work.cheapest(1e-12), None);
    }
}
