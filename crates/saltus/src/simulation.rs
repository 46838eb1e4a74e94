//! How to run an automaton, how a run ends, what it cost.

use std::fmt;
use std::ops::Range;

use crate::advance::Memory;
use crate::automaton::Automaton;
use crate::control::Tolerance;
use crate::copies::shown;
use crate::course::{Checkpoint, Course};
use crate::error::{Error, ErrorKind, Place};
use crate::observe::Observer;
use crate::state::State;
use crate::step::{Auto, Stepper};
use crate::time::Time;
use crate::trajectory::Trajectory;

/// How to run an automaton: its stepper, tolerances and limits.
///
/// ```
/// use saltus::nalgebra::{Vector2, vector};
/// use saltus::{Hybrid, Simulation, Stop};
///
/// let ball = Hybrid::new()
///     .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.81])
///     .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.8 * x[1]]);
/// let run = Simulation::of(&ball).tolerance(1e-10).run("flight", vector![1.0, 0.0], 0.0..6.0)?;
///
/// // The impacts accumulate at t = sqrt(2 h / g) (1 + e) / (1 - e); nobody had to say so.
/// let limit = (2.0_f64 / 9.81).sqrt() * 1.8 / 0.2;
/// assert!(matches!(run.stop, Stop::Zeno { limit: t } if (t - limit).abs() < 1e-9));
/// # Ok::<(), saltus::Error>(())
/// ```
pub struct Simulation<'a, A, M = Auto> {
    automaton: &'a A,
    stepper: M,
    options: Options,
}

impl<A, M: Copy> Clone for Simulation<'_, A, M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A, M: Copy> Copy for Simulation<'_, A, M> {}

impl<A, M: fmt::Debug> fmt::Debug for Simulation<'_, A, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stepper, options, .. } = self;
        f.debug_struct("Simulation").field("stepper", stepper).field("options", options).finish_non_exhaustive()
    }
}

/// What a run may cost and how exact it is to be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options {
    pub(crate) tolerance: Tolerance,
    pub(crate) first_step: Option<f64>,
    pub(crate) longest_step: f64,
    pub(crate) most_steps: u64,
    pub(crate) most_evaluations: u64,
    pub(crate) most_jumps: usize,
    pub(crate) longest_cascade: usize,
    /// Whether modes that a formula or a series solves are stepped through all the same.
    pub(crate) stepped: bool,
}

impl Options {
    /// Why a run that has cost so much takes no further step, if it does not.
    #[inline]
    pub(crate) fn exceeded<E>(&self, stats: &Stats) -> Option<Stop<E>> {
        if stats.steps >= self.most_steps {
            Some(Stop::Steps { most: self.most_steps })
        } else if stats.evaluations() >= self.most_evaluations {
            Some(Stop::Evaluations { most: self.most_evaluations })
        } else {
            None
        }
    }
}

impl<'a, A: Automaton> Simulation<'a, A> {
    /// A simulation of `automaton` with [`Auto`], relative tolerance 1e-9, absolute tolerance 1e-12,
    /// and limits of 10⁷ jumps, 10⁸ steps and 10⁴ jumps at one time; evaluations are not limited.
    #[must_use]
    pub const fn of(automaton: &'a A) -> Self {
        let options = Options {
            tolerance: Tolerance { relative: 1e-9, absolute: 1e-12 },
            first_step: None,
            longest_step: f64::INFINITY,
            most_steps: 100_000_000,
            most_evaluations: u64::MAX,
            most_jumps: 10_000_000,
            longest_cascade: 10_000,
            stepped: false,
        };
        Self { automaton, stepper: Auto::new(), options }
    }
}

impl<'a, A: Automaton, M: Stepper> Simulation<'a, A, M> {
    /// Uses another stepper for the modes that have neither an exact solution nor a series.
    #[must_use]
    pub fn stepper<N: Stepper>(self, stepper: N) -> Simulation<'a, A, N> {
        Simulation { automaton: self.automaton, stepper, options: self.options }
    }

    /// The local error allowed per step, relative to each coordinate, at least 1e-15; the absolute tolerance becomes a thousandth of it.
    #[must_use]
    pub const fn tolerance(mut self, relative: f64) -> Self {
        self.options.tolerance = Tolerance { relative, absolute: relative * 1e-3 };
        self
    }

    /// The local error allowed per step where a coordinate is near zero, in the unit of the state.
    #[must_use]
    pub const fn absolute_tolerance(mut self, absolute: f64) -> Self {
        self.options.tolerance.absolute = absolute;
        self
    }

    /// The first step size, in seconds; chosen automatically unless given.
    #[must_use]
    pub const fn first_step(mut self, h: f64) -> Self {
        self.options.first_step = Some(h);
        self
    }

    /// The longest step, in seconds, and the longest stretch of an exact arc that is searched at once. Needed for a guard that varies faster than the
    /// state: a floor that vibrates under a long flight.
    #[must_use]
    pub const fn longest_step(mut self, h: f64) -> Self {
        self.options.longest_step = h;
        self
    }

    /// After how many jumps the run ends with [`Stop::Jumps`].
    #[must_use]
    pub const fn most_jumps(mut self, count: usize) -> Self {
        self.options.most_jumps = count;
        self
    }

    /// After how many steps the run ends with [`Stop::Steps`].
    #[must_use]
    pub const fn most_steps(mut self, count: u64) -> Self {
        self.options.most_steps = count;
        self
    }

    /// After how many evaluations of flows and guards together the run ends with [`Stop::Evaluations`].
    ///
    /// Looked at between steps and between jumps: one step may go over it by its own evaluations.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation, Stop};
    /// let decay = Hybrid::new().mode("decay", |_t, x: &f64| -x);
    /// let run = Simulation::of(&decay).most_evaluations(100).run("decay", 1.0, 0.0..1e6)?;
    /// assert_eq!(run.stop, Stop::Evaluations { most: 100 });
    /// assert!((100..120).contains(&run.stats.evaluations()));
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub const fn most_evaluations(mut self, count: u64) -> Self {
        self.options.most_evaluations = count;
        self
    }

    /// After how many jumps at one and the same time the run ends with [`Stop::Cascade`].
    #[must_use]
    pub const fn longest_cascade(mut self, count: usize) -> Self {
        self.options.longest_cascade = count;
        self
    }

    /// Steps through every mode by the stepper, whatever [`Automaton::solution`] says: to see what
    /// that saves.
    ///
    /// ```
    /// use saltus::nalgebra::{Vector2, vector};
    /// use saltus::{Hybrid, Simulation};
    /// let rest = Hybrid::new().mode("rest", |_t, _x: &Vector2<f64>| vector![0.0, 0.0]);
    /// let run = Simulation::of(&rest).stepped().run("rest", vector![1.0, 2.0], 0.0..3.0)?;
    /// assert!(run.stats.steps > 0 && run.stats.exact == 0);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub const fn stepped(mut self) -> Self {
        self.options.stepped = true;
        self
    }

    /// Runs from `state` in `mode` over the span of time and records the whole trajectory.
    ///
    /// The end of the span may be infinite if the automaton ends or comes to rest by itself.
    ///
    /// # Errors
    /// [`Failed`], which holds the [`Error`] and the run up to it; `?` turns it into the [`Error`] where a function returns that.
    pub fn run(&self, mode: A::Mode, state: A::State, span: Range<f64>) -> Result<Run<A>, Box<Failed<A>>> {
        let mut trajectory = Trajectory::starting(mode, state, Time::new(span.start));
        let mut course = match self.start(mode, state, span) {
            Ok(course) => course,
            Err(error) => return Err(Box::new(Failed { error, trajectory, stats: Stats::default() })),
        };
        match course.finish(&mut trajectory) {
            Ok(Ending { stop, stats, time, mode, state, .. }) => {
                trajectory.finish(time);
                Ok(Run { trajectory, stop, stats, mode, state })
            }
            Err(error) => {
                trajectory.settle(Time::new(error.t()));
                Err(Box::new(Failed { error, trajectory, stats: course.stats() }))
            }
        }
    }

    /// Runs and tells `observer` of each piece and jump, recording nothing.
    ///
    /// # Errors
    /// See [`Error`]; the observer has been told of everything before it.
    pub fn drive(
        &self,
        mode: A::Mode,
        state: A::State,
        span: Range<f64>,
        observer: &mut impl Observer<A>,
    ) -> Result<Ending<A>, Error> {
        self.start(mode, state, span)?.finish(observer)
    }

    /// Begins a run that is advanced jump by jump.
    ///
    /// # Errors
    /// See [`Error`]: a span, tolerance, mode or state that cannot be run.
    pub fn start(&self, mode: A::Mode, state: A::State, span: Range<f64>) -> Result<Course<'a, A, M>, Error> {
        self.check(mode, &state, &span)?;
        let memory = Memory::new(&self.fitted(), self.options.first_step);
        Ok(self.resume(Checkpoint::start(mode, state, span, memory)))
    }

    /// Goes on from a checkpoint, to the bit as if there had been no pause.
    ///
    /// A run that has ended stays ended, unless it was by a limit on jumps, steps or evaluations that is higher now.
    ///
    /// The automaton, stepper and options are taken to be those of the run that the checkpoint comes from.
    #[must_use]
    pub fn resume(&self, checkpoint: Checkpoint<A>) -> Course<'a, A, M> {
        Course::new(self.automaton, self.fitted(), self.options, checkpoint.under(&self.options))
    }

    /// The relative tolerance.
    pub(crate) const fn relative_tolerance(&self) -> f64 {
        self.options.tolerance.relative
    }

    #[cfg(feature = "num-dual")]
    pub(crate) const fn automaton(&self) -> &'a A {
        self.automaton
    }

    /// The options.
    #[cfg(feature = "num-dual")]
    pub(crate) const fn options(&self) -> &Options {
        &self.options
    }

    /// The same stepper, tolerances and limits for another automaton.
    #[cfg(feature = "num-dual")]
    pub(crate) const fn over<'b, B: Automaton>(&self, automaton: &'b B) -> Simulation<'b, B, M> {
        Simulation { automaton, stepper: self.stepper, options: self.options }
    }

    /// The stepper for the tolerance asked for.
    fn fitted(&self) -> M {
        self.stepper.for_tolerance(self.options.tolerance.relative)
    }

    fn check(&self, mode: A::Mode, state: &A::State, span: &Range<f64>) -> Result<(), Error> {
        let Options { tolerance: Tolerance { relative, absolute }, first_step, longest_step, .. } = self.options;
        let (kind, note) = if !(span.start.is_finite() && span.start <= span.end) {
            (ErrorKind::Span, Some(format!("{}..{}", span.start, span.end)))
        } else if !(relative >= 1e-15 && absolute > 0.0 && relative.is_finite() && absolute.is_finite()) {
            (ErrorKind::Tolerance, Some(format!("relative {relative:e}, absolute {absolute:e}")))
        } else if !(longest_step > 0.0 && first_step.is_none_or(|h| h > 0.0 && h.is_finite())) {
            (ErrorKind::StepLimit, None)
        } else if let Err(flaw) = self.automaton.validate(mode) {
            (ErrorKind::Model, Some(flaw))
        } else if !state.is_finite() {
            (ErrorKind::InitialState, None)
        } else {
            return Ok(());
        };
        Err(Error::new(kind, Place::new(span.start, mode, None::<A::Edge>, state)).noting(note))
    }
}

/// Why a run ended. Written with `{}`, it is a sentence that says what to do.
///
/// ```
/// use saltus::{Hybrid, Simulation, Stop};
/// let drain = Hybrid::new().mode("drain", |_t, _x: &f64| -1.0).terminal("drain", |_t, x| *x);
/// let run = Simulation::of(&drain).run("drain", 2.0, 0.0..3.0)?;
/// assert!(matches!(run.stop, Stop::Terminal { edge } if edge.from == "drain"));
/// let run = Simulation::of(&drain).most_steps(0).run("drain", 2.0, 0.0..3.0)?;
/// assert_eq!(run.stop.to_string(), "the limit of 0 steps was reached: raise Simulation::most_steps to go on");
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Stop<E> {
    /// The end of the span was reached.
    Time,
    /// Jumps accumulate at `limit`, and the model does not say what lies beyond.
    Zeno {
        /// The accumulation time, in seconds.
        limit: f64,
    },
    /// A terminal edge was taken.
    Terminal {
        /// The edge.
        edge: E,
    },
    /// The observer asked for the end.
    Observer,
    /// The limit on jumps was reached.
    Jumps {
        /// The limit.
        most: usize,
    },
    /// The limit on steps was reached.
    Steps {
        /// The limit.
        most: u64,
    },
    /// The limit on evaluations of flows and guards was reached.
    Evaluations {
        /// The limit.
        most: u64,
    },
    /// Too many jumps at one and the same time: the resets send the state round in a circle.
    Cascade {
        /// The edge taken last.
        edge: E,
    },
}

impl<E> Stop<E> {
    /// Whether it was by a limit that these options have raised.
    pub(crate) fn is_lifted(&self, options: &Options) -> bool {
        match *self {
            Self::Jumps { most } => options.most_jumps > most,
            Self::Steps { most } => options.most_steps > most,
            Self::Evaluations { most } => options.most_evaluations > most,
            _ => false,
        }
    }
}

impl<E: fmt::Debug> fmt::Display for Stop<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time => write!(f, "the end of the span was reached"),
            Self::Zeno { limit } => {
                write!(
                    f,
                    "jumps accumulate at t = {limit}: say what lies there, to go on, by Automaton::beyond or Hybrid::beyond, in each mode of the jumps (and for derivatives by Linearize::beyond_over)"
                )
            }
            Self::Terminal { edge } => write!(f, "the terminal edge {edge:?} was taken"),
            Self::Observer => write!(f, "the observer ended the run"),
            Self::Jumps { most } => {
                write!(f, "the limit of {most} jumps was reached: raise Simulation::most_jumps to go on")
            }
            Self::Steps { most } => {
                write!(f, "the limit of {most} steps was reached: raise Simulation::most_steps to go on")
            }
            Self::Evaluations { most } => {
                write!(
                    f,
                    "the limit of {most} evaluations of flows and guards was reached: raise Simulation::most_evaluations to go on"
                )
            }
            Self::Cascade { edge } => {
                write!(
                    f,
                    "too many jumps at one time, the last by edge {edge:?}: let a reset lead away from the guards it meets"
                )
            }
        }
    }
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stats {
    /// Jumps made.
    pub jumps: usize,
    /// Steps accepted.
    pub steps: u64,
    /// Steps rejected.
    pub rejected: u64,
    /// Arcs advanced by an exact solution.
    pub exact: u64,
    /// Evaluations of flows; of one given over jets, each order of a series is one.
    pub flows: u64,
    /// Evaluations of guards.
    pub guards: u64,
    /// Jacobians, each by differences of flows counted above.
    pub jacobians: u64,
}

impl Stats {
    /// Evaluations of flows and guards together.
    #[must_use]
    #[inline]
    pub const fn evaluations(&self) -> u64 {
        self.flows + self.guards
    }
}

/// A recorded run.
///
/// ```
/// use saltus::{Hybrid, Simulation, Stop};
/// let decay = Hybrid::new().mode("decay", |_t, x: &f64| -x);
/// let run = Simulation::of(&decay).run("decay", 1.0, 0.0..1.0)?;
/// assert_eq!((run.stop, run.mode), (Stop::Time, "decay"));
/// assert_eq!(Some(run.state), run.trajectory.at(1.0));
/// assert!(run.stats.flows > 6 && run.trajectory.doubts().is_empty());
/// # Ok::<(), saltus::Error>(())
/// ```
pub struct Run<A: Automaton> {
    /// The hybrid arc.
    pub trajectory: Trajectory<A>,
    /// Why it ended.
    pub stop: Stop<A::Edge>,
    /// What it cost.
    pub stats: Stats,
    /// The mode at the end.
    pub mode: A::Mode,
    /// The state at the end.
    pub state: A::State,
}

/// How a driven run ended.
///
/// ```
/// use saltus::{Hybrid, Simulation, Stop};
/// let tank = Hybrid::new()
///     .mode("fill", |_t, _x: &f64| 1.0)
///     .edge("fill", "fill", |_t, x| 2.0 - x, |_t, _x| 0.0);
/// let end = Simulation::of(&tank).drive("fill", 0.0, 0.0..5.0, &mut ())?;
/// assert_eq!((end.stop, end.time.seconds(), end.jumps, end.mode), (Stop::Time, 5.0, 2, "fill"));
/// # Ok::<(), saltus::Error>(())
/// ```
pub struct Ending<A: Automaton> {
    /// Why it ended.
    pub stop: Stop<A::Edge>,
    /// What it cost.
    pub stats: Stats,
    /// When it ended.
    pub time: Time,
    /// How many jumps were made.
    pub jumps: usize,
    /// The mode at the end.
    pub mode: A::Mode,
    /// The state at the end.
    pub state: A::State,
}

/// A run that failed, and what it had until then.
///
/// ```
/// use saltus::{ErrorKind, Hybrid, Simulation};
/// // x' = x² from 1 is infinite at t = 1.
/// let growth = Hybrid::new().mode("grow", |_t, x: &f64| x * x);
/// let failed = Simulation::of(&growth).run("grow", 1.0, 0.0..2.0).unwrap_err();
/// assert_eq!(failed.error.kind(), ErrorKind::Flow);
/// assert!((failed.trajectory.at(0.5).unwrap() - 2.0).abs() < 1e-6);
/// ```
pub struct Failed<A: Automaton> {
    /// What went wrong.
    pub error: Error,
    /// The trajectory up to the failure.
    pub trajectory: Trajectory<A>,
    /// What it cost.
    pub stats: Stats,
}

shown!(Run { stop, mode, state, stats, trajectory });
shown!(Ending { stop, time, jumps, mode, state, stats });

impl<A: Automaton> From<Box<Failed<A>>> for Error {
    fn from(failed: Box<Failed<A>>) -> Self {
        failed.error
    }
}

impl<A: Automaton> fmt::Display for Failed<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

/// The sentence, which is what a `main` shows that returns the error.
impl<A: Automaton> fmt::Debug for Failed<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.error, f)
    }
}

impl<A: Automaton> std::error::Error for Failed<A> {}
