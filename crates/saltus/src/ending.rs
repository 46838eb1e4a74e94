//! How a run ended, and what it cost.

use std::fmt;
use std::time::{Duration, Instant};

use crate::automaton::Automaton;
use crate::control::Tolerance;
use crate::error::{Error, ErrorKind, Place};
use crate::memory::Room;
use crate::state::State;
use crate::time::Time;
use crate::trajectory::Trajectory;

/// What a run may cost and how exact it is to be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options {
    pub(crate) tolerance: Tolerance,
    /// Whether the absolute one was given.
    pub(crate) absolute: bool,
    pub(crate) first_step: Option<f64>,
    pub(crate) longest_step: f64,
    pub(crate) most_steps: u64,
    pub(crate) most_evaluations: u64,
    pub(crate) most_jumps: usize,
    pub(crate) longest_cascade: usize,
    pub(crate) room: Room,
    pub(crate) deadline: Option<Duration>,
    /// The moment of the deadline, once the run has begun.
    pub(crate) due: Option<Instant>,
    /// Whether modes that a formula or a series solves are stepped through all the same.
    pub(crate) stepped: bool,
}

impl Options {
    /// Why a run that has cost so much takes no further step, if it does not.
    #[inline]
    pub(crate) fn exceeded<E>(&self, stats: &Stats) -> Option<Stop<E>> {
        if stats.steps + stats.windows >= self.most_steps {
            Some(Stop::Steps { most: self.most_steps })
        } else if stats.evaluations() >= self.most_evaluations {
            Some(Stop::Evaluations { most: self.most_evaluations })
        } else {
            self.overdue()
        }
    }

    /// Whether the deadline has passed.
    #[inline]
    pub(crate) fn overdue<E>(&self) -> Option<Stop<E>> {
        let due = self.due?;
        (Instant::now() >= due).then(|| Stop::Deadline { after: self.deadline.unwrap_or_default() })
    }

    /// A run begins now, or goes on.
    pub(crate) fn begun(self) -> Self {
        Self { due: self.deadline.and_then(|after| Instant::now().checked_add(after)), ..self }
    }
}

/// Why a run ended. Written with `{}`, it is a sentence that says what to do.
///
/// ```
/// use saltus::{Hybrid, Simulation, Stop};
/// let drain = Hybrid::new().mode("drain", |_t, _x: &f64| -1.0).terminal("drain", |_t, x| *x);
/// let run = Simulation::of(&drain).run("drain", 2.0, 0.0..3.0)?;
/// assert!(matches!(run.end.stop, Stop::Terminal { edge } if edge.from == "drain"));
/// let run = Simulation::of(&drain).most_steps(0).run("drain", 2.0, 0.0..3.0)?;
/// assert!(run.end.stop.to_string().starts_with("the limit of 0 steps was reached: raise Simulation::most_steps"));
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Stop<E> {
    /// The end of the span was reached.
    Time,
    /// The span has no end, and no guard falls any more: the last mode lasts for ever.
    Forever,
    /// Jumps accumulate at `limit`, and the model does not say what lies beyond.
    Zeno {
        /// The accumulation time, in seconds.
        limit: f64,
    },
    /// Jumps come closer together at `limit` than rounding can tell apart, without the contraction
    /// that would certify that they accumulate there, and the model does not say what lies beyond.
    Resolution {
        /// When, in seconds.
        limit: f64,
    },
    /// A terminal edge was taken.
    Terminal {
        /// The edge.
        edge: E,
    },
    /// An edge was met behind which the model does not say how it goes on: see
    /// [`About::undetermined`](crate::About::undetermined).
    Undetermined {
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
    /// The limit on the bytes of a recorded trajectory was reached.
    Bytes {
        /// The limit.
        most: usize,
    },
    /// The time that the run was given on the clock on the wall is over.
    Deadline {
        /// How long that was.
        after: Duration,
    },
    /// Too many jumps at one and the same time: the resets send the state round in a circle.
    Cascade {
        /// The edge taken last.
        edge: E,
    },
}

impl<E> Stop<E> {
    /// Whether it is an end that was asked for: that of the span, a terminal edge, the observer's.
    /// Else the run is not where it was to go.
    #[must_use]
    pub const fn is_asked(&self) -> bool {
        matches!(self, Self::Time | Self::Forever | Self::Terminal { .. } | Self::Observer)
    }

    /// Whether it was by a limit that these options have raised.
    pub(crate) fn is_lifted(&self, options: &Options) -> bool {
        match *self {
            Self::Jumps { most } => options.most_jumps > most,
            Self::Steps { most } => options.most_steps > most,
            Self::Evaluations { most } => options.most_evaluations > most,
            Self::Bytes { most } => options.room.exceeds(most),
            Self::Deadline { .. } => true,
            _ => false,
        }
    }
}

/// What to do where it is not the length of the run that took a limit.
const STANDS: &str =
    "or, where time nearly stands, let no flow jump with the state: give it a mode on each side (Filippov)";

impl<E: fmt::Debug> fmt::Display for Stop<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time => write!(f, "the end of the span was reached"),
            Self::Forever => write!(f, "nothing happens any more: the last mode lasts for ever"),
            Self::Zeno { limit } => {
                write!(
                    f,
                    "jumps accumulate at t = {limit}: say what lies there, to go on, by Automaton::beyond or Hybrid::beyond, in each mode of the jumps (and for derivatives by Linearize::beyond_over)"
                )
            }
            Self::Resolution { limit } => write!(
                f,
                "jumps come closer together at t = {limit} than rounding can tell apart: count time and lengths from nearer by (a floor at zero), or say what lies beyond by Automaton::beyond or Hybrid::beyond"
            ),
            Self::Terminal { edge } => write!(f, "the terminal edge {edge:?} was taken"),
            Self::Undetermined { edge } => write!(
                f,
                "edge {edge:?} was met, behind which the model does not determine how the state goes on: start a run behind it in the mode that is meant"
            ),
            Self::Observer => write!(f, "the observer ended the run"),
            Self::Jumps { most } => {
                write!(f, "the limit of {most} jumps was reached: raise Simulation::most_jumps to go on")
            }
            Self::Steps { most } => {
                write!(f, "the limit of {most} steps was reached: raise Simulation::most_steps to go on; {STANDS}")
            }
            Self::Evaluations { most } => {
                write!(
                    f,
                    "the limit of {most} evaluations of flows and guards was reached: raise Simulation::most_evaluations to go on; {STANDS}"
                )
            }
            Self::Bytes { most } => {
                write!(
                    f,
                    "the limit of {most} bytes of a recorded trajectory was reached: raise Simulation::most_bytes, or observe the run with Simulation::drive, which keeps nothing; {STANDS}"
                )
            }
            Self::Deadline { after } => {
                write!(
                    f,
                    "the deadline of {after:?} is over: give more by Simulation::deadline, or go on from a checkpoint"
                )
            }
            Self::Cascade { edge } => {
                write!(
                    f,
                    "too many jumps at one time, the last by edge {edge:?}: let a reset lead away from the guards it meets; where the flows of two modes push against each other, give them a mode that slides between (Filippov)"
                )
            }
        }
    }
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Stats {
    /// Jumps made.
    pub jumps: usize,
    /// Steps accepted.
    pub steps: u64,
    /// Stretches of exact arcs that were searched one at a time, beyond the first of each search.
    pub windows: u64,
    /// Steps rejected.
    pub rejected: u64,
    /// Arcs advanced by an exact solution.
    pub exact: u64,
    /// Steps accepted of a method for stiff flows to which the stepper changed by itself.
    pub stiff: u64,
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

/// The limits of accumulating jumps that a run went beyond, by [`Automaton::beyond`].
///
/// ```
/// use saltus::{Hybrid, Simulation};
/// let ball = Hybrid::new()
///     .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.8])
///     .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.5 * x[1]])
///     .mode("rest", |_t, _x| [0.0, 0.0])
///     .beyond("flight", "rest", |_t, _x| [0.0, 0.0]);
/// let run = Simulation::of(&ball).run("flight", [1.0, 0.0], 0.0..4.0)?;
/// assert_eq!(run.end.limits.count, 1);
/// assert!((run.end.limits.last.unwrap() - 3.0 * (2.0_f64 / 9.8).sqrt()).abs() < 1e-12);
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Limits {
    /// How many.
    pub count: usize,
    /// How many of these lack the contraction that certifies that jumps accumulate there: without
    /// [`Automaton::beyond`](crate::Automaton::beyond) the run ends in [`Stop::Resolution`].
    pub uncertified: usize,
    /// When the last one was reached, in seconds.
    pub last: Option<f64>,
}

/// A recorded run.
///
/// ```
/// use saltus::{Hybrid, Simulation, Stop};
/// let decay = Hybrid::new().mode("decay", |_t, x: &f64| -x);
/// let run = Simulation::of(&decay).run("decay", 1.0, 0.0..1.0)?;
/// assert_eq!((run.end.stop, run.end.mode), (Stop::Time, "decay"));
/// assert_eq!(Some(run.end.state), run.trajectory.at(1.0));
/// assert!(run.end.stats.flows > 6 && run.trajectory.doubts().is_empty());
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone)]
pub struct Run<M, E, S> {
    /// The hybrid arc.
    pub trajectory: Trajectory<M, E, S>,
    /// How it ended.
    pub end: Ending<M, E, S>,
}

/// A run of the automaton `A`.
pub type RunOf<A> = Run<<A as Automaton>::Mode, <A as Automaton>::Edge, <A as Automaton>::State>;

impl<M: fmt::Debug, E: fmt::Debug, S: State> Run<M, E, S> {
    /// The run, if it came to an end that was asked for: that of the span, or at a terminal edge.
    /// What ended before, by a limit or where jumps accumulate, has the state of another time.
    ///
    /// ```
    /// use saltus::{ErrorKind, Hybrid, Simulation};
    /// let ball = Hybrid::new()
    ///     .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.8])
    ///     .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.5 * x[1]]);
    /// let run = |end| Simulation::of(&ball).run("flight", [1.0, 0.0], 0.0..end)?.complete();
    /// assert!(run(1.0).is_ok());
    /// let failed = run(20.0).unwrap_err();
    /// assert_eq!(failed.error.kind(), ErrorKind::Unfinished);
    /// assert!(failed.error.to_string().starts_with("the run ended before it was to: jumps accumulate at t = 1.35"));
    /// ```
    ///
    /// # Errors
    /// [`Failed`], of [`ErrorKind::Unfinished`], with the trajectory.
    pub fn complete(self) -> Result<Self, Box<Failed<M, E, S>>> {
        let Self { trajectory, end } = self;
        let Ending { stop, stats, time, mode, state, .. } = &end;
        if stop.is_asked() {
            return Ok(Self { trajectory, end });
        }
        let place = Place::new(time.seconds(), mode, None::<E>, state);
        let error = Error::new(ErrorKind::Unfinished, place).noting(Some(stop.to_string()));
        Err(Box::new(Failed { error, trajectory, stats: *stats }))
    }
}

/// How a run ended.
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
#[non_exhaustive]
#[derive(Clone)]
pub struct Ending<M, E, S> {
    /// Why it ended.
    pub stop: Stop<E>,
    /// What it cost.
    pub stats: Stats,
    /// When it ended.
    pub time: Time,
    /// How many jumps were made.
    pub jumps: usize,
    /// The mode at the end.
    pub mode: M,
    /// The state at the end.
    pub state: S,
    /// Which limits of jumps that accumulate it went beyond.
    pub limits: Limits,
}

/// How a run of the automaton `A` ended.
pub type EndingOf<A> = Ending<<A as Automaton>::Mode, <A as Automaton>::Edge, <A as Automaton>::State>;

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
pub struct Failed<M, E, S> {
    /// What went wrong.
    pub error: Error,
    /// The trajectory up to the failure.
    pub trajectory: Trajectory<M, E, S>,
    /// What it cost.
    pub stats: Stats,
}

/// A run of the automaton `A` that failed.
pub type FailedOf<A> = Failed<<A as Automaton>::Mode, <A as Automaton>::Edge, <A as Automaton>::State>;

impl<M: fmt::Debug, E: fmt::Debug, S: State> fmt::Debug for Run<M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { trajectory, end } = self;
        f.debug_struct("Run").field("end", end).field("trajectory", trajectory).finish()
    }
}

impl<M: fmt::Debug, E: fmt::Debug, S: State> fmt::Debug for Ending<M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stop, stats, time, jumps, mode, state, limits } = self;
        f.debug_struct("Ending")
            .field("stop", stop)
            .field("time", time)
            .field("jumps", jumps)
            .field("mode", mode)
            .field("state", state)
            .field("limits", limits)
            .field("stats", stats)
            .finish()
    }
}

impl<M, E, S> From<Box<Failed<M, E, S>>> for Error {
    fn from(failed: Box<Failed<M, E, S>>) -> Self {
        failed.error
    }
}

impl<M, E, S> fmt::Display for Failed<M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

/// The sentence, which is what a `main` shows that returns the error.
impl<M, E, S> fmt::Debug for Failed<M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.error, f)
    }
}

impl<M, E, S> std::error::Error for Failed<M, E, S> {}
