//! How to run an automaton.

use std::fmt;
use std::ops::{ControlFlow, Range};
use std::time::Duration;

use crate::advance::{Advance, Memory};
use crate::automaton::Automaton;
use crate::checkpoint::{CheckpointOf, Stage};
use crate::control::Tolerance;
use crate::course::Course;
use crate::ending::{Ending, EndingOf, Failed, FailedOf, Options, Run, RunOf, Stats, Stop};
use crate::error::{Error, ErrorKind, Place};
use crate::inspection::InspectionOf;
use crate::jump::JumpOf;
use crate::memory::Room;
use crate::observe::Observer;
use crate::piece::Piece;
use crate::state::State;
use crate::step::{Auto, Stepper};
use crate::time::{LAST, Time};
use crate::trajectory::{Trajectory, TrajectoryOf};

/// How to run an automaton: its stepper, tolerances and limits.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Hybrid, Simulation, Stop};
///
/// let ball = Hybrid::new()
///     .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.81])
///     .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.8 * x[1]]);
/// let run = Simulation::of(&ball).tolerance(1e-10).run("flight", vector![1.0, 0.0], 0.0..6.0)?;
///
/// // The impacts accumulate at t = sqrt(2 h / g) (1 + e) / (1 - e); nobody had to say so.
/// let limit = (2.0_f64 / 9.81).sqrt() * 1.8 / 0.2;
/// assert!(matches!(run.end.stop, Stop::Zeno { limit: t } if (t - limit).abs() < 1e-9));
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

/// Records until there is no more room.
struct Bounded<'t, A: Automaton> {
    trajectory: &'t mut TrajectoryOf<A>,
    /// What has been recorded takes at most so much.
    bytes: usize,
    room: Room,
    /// How many bytes may be taken before the room is asked again.
    next: usize,
    /// The limit, once it is reached.
    most: Option<usize>,
}

impl<A: Automaton> Bounded<'_, A> {
    #[inline]
    fn grow(&mut self, by: usize) -> ControlFlow<()> {
        self.bytes += by;
        if self.bytes < self.next { ControlFlow::Continue(()) } else { self.ask() }
    }

    #[cold]
    fn ask(&mut self) -> ControlFlow<()> {
        self.bytes = self.trajectory.bytes();
        if self.bytes < self.next {
            return ControlFlow::Continue(()); // doubts have been settled
        }
        match self.room.ask(self.bytes) {
            Ok(next) => {
                self.next = next;
                ControlFlow::Continue(())
            }
            Err(most) => {
                self.most = Some(most);
                ControlFlow::Break(())
            }
        }
    }
}

impl<A: Automaton> Observer<A> for Bounded<'_, A> {
    fn piece(&mut self, _: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        let by = self.trajectory.push_piece(piece);
        self.grow(by)
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        let by = self.trajectory.push_jump(jump.clone());
        self.grow(by)
    }
    fn inspection(&mut self, inspection: &InspectionOf<A>) {
        if inspection.evidence.doubt().is_some() {
            self.trajectory.push_doubt(inspection);
            self.bytes += size_of_val(inspection);
        }
    }
}

impl<'a, A: Automaton> Simulation<'a, A> {
    /// A simulation of `automaton` with [`Auto`], relative tolerance 1e-9, absolute tolerance
    /// 1e-12, and limits of 10⁷ jumps, 10⁸ steps, 10⁴ jumps at one time and, of what is recorded, a
    /// quarter of the memory that is free, at most 4 GiB ([`most_bytes`](Self::most_bytes));
    /// evaluations and time on the wall are not limited.
    #[must_use]
    pub const fn of(automaton: &'a A) -> Self {
        let options = Options {
            tolerance: Tolerance { relative: 1e-9, absolute: 1e-12 },
            absolute: false,
            first_step: None,
            longest_step: f64::INFINITY,
            most_steps: 100_000_000,
            most_evaluations: u64::MAX,
            most_jumps: 10_000_000,
            longest_cascade: 10_000,
            room: Room::Free,
            deadline: None,
            due: None,
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

    /// The local error allowed per step, relative to each coordinate, at least 1e-15 and below 1;
    /// the absolute tolerance becomes a thousandth of it, unless it is given.
    #[must_use]
    pub const fn tolerance(mut self, relative: f64) -> Self {
        let absolute = if self.options.absolute { self.options.tolerance.absolute } else { relative * 1e-3 };
        self.options.tolerance = Tolerance { relative, absolute };
        self
    }

    /// The local error allowed per step where a coordinate is near zero, in the unit of the state.
    #[must_use]
    pub const fn absolute_tolerance(mut self, absolute: f64) -> Self {
        self.options.tolerance.absolute = absolute;
        self.options.absolute = true;
        self
    }

    /// The first step size, in seconds; chosen automatically unless given.
    #[must_use]
    pub const fn first_step(mut self, h: f64) -> Self {
        self.options.first_step = Some(h);
        self
    }

    /// The longest step, in seconds, and the longest stretch of an exact arc that is searched at
    /// once. Needed for a guard that varies faster than the state: a floor that vibrates under a
    /// long flight.
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

    /// After how many steps the run ends with [`Stop::Steps`]; a further stretch of an exact arc
    /// that is searched or recorded by itself counts as one.
    #[must_use]
    pub const fn most_steps(mut self, count: u64) -> Self {
        self.options.most_steps = count;
        self
    }

    /// After how many evaluations of flows and guards together the run ends with
    /// [`Stop::Evaluations`].
    ///
    /// Looked at between steps and between jumps: one step may go over it by its own evaluations.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation, Stop};
    /// let decay = Hybrid::new().mode("decay", |_t, x: &f64| -x);
    /// let run = Simulation::of(&decay).most_evaluations(100).run("decay", 1.0, 0.0..1e6)?;
    /// assert_eq!(run.end.stop, Stop::Evaluations { most: 100 });
    /// assert!((100..120).contains(&run.end.stats.evaluations()));
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub const fn most_evaluations(mut self, count: u64) -> Self {
        self.options.most_evaluations = count;
        self
    }

    /// After how many bytes of its trajectory [`run`](Self::run) ends with [`Stop::Bytes`], counted
    /// between pieces and between jumps. Memory for up to twice as many may be set aside.
    ///
    /// Without it, a quarter of the memory that is free, of the machine or of the container, and at
    /// most 4 GiB. It is asked for from 16 MiB on, and again as the record grows, so that runs side
    /// by side leave room for each other. In a browser it is 1 GiB.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation, Stop};
    /// let swing = Hybrid::new().mode("swing", |_t, x: &[f64; 2]| [x[1], -x[0]]);
    /// let run = Simulation::of(&swing).most_bytes(10_000).run("swing", [1.0, 0.0], 0.0..f64::INFINITY)?;
    /// assert_eq!(run.end.stop, Stop::Bytes { most: 10_000 });
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub const fn most_bytes(mut self, count: usize) -> Self {
        self.options.room = Room::Given(count);
        self
    }

    /// After how long, by the clock on the wall, the run ends with [`Stop::Deadline`]; a run that
    /// is resumed has as much again. Looked at between steps and between jumps.
    ///
    /// ```
    /// use std::time::Duration;
    /// use saltus::{Hybrid, Simulation, Stop};
    /// let swing = Hybrid::new().mode("swing", |_t, x: &[f64; 2]| [x[1], -x[0]]);
    /// let simulation = Simulation::of(&swing).deadline(Duration::from_millis(20));
    /// let end = simulation.drive("swing", [1.0, 0.0], 0.0..f64::INFINITY, &mut ())?;
    /// assert_eq!(end.stop, Stop::Deadline { after: Duration::from_millis(20) });
    /// assert!((end.state[0] - end.time.seconds().cos()).abs() < 1e-3);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub const fn deadline(mut self, after: Duration) -> Self {
        self.options.deadline = Some(after);
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
    /// use saltus::nalgebra::{self, Vector2, vector};
    /// use saltus::{Hybrid, Simulation};
    /// let rest = Hybrid::new().mode("rest", |_t, _x: &Vector2<f64>| vector![0.0, 0.0]);
    /// let run = Simulation::of(&rest).stepped().run("rest", vector![1.0, 2.0], 0.0..3.0)?;
    /// assert!(run.end.stats.steps > 0 && run.end.stats.exact == 0);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub const fn stepped(mut self) -> Self {
        self.options.stepped = true;
        self
    }

    /// Runs from `state` in `mode` over the span of time and records the whole trajectory.
    ///
    /// The end of the span may be infinite: a run in which nothing happens any more ends with
    /// [`Stop::Forever`], its state that at 10³⁰⁰ s, the last time to which guards are searched.
    /// One whose state there is no number, as of a ball that falls for ever, fails.
    ///
    /// # Errors
    /// [`Failed`], which holds the [`Error`] and the run up to it; `?` turns it into the [`Error`]
    /// where a function returns that.
    pub fn run(&self, mode: A::Mode, state: A::State, span: Range<f64>) -> Result<RunOf<A>, Box<FailedOf<A>>> {
        let mut trajectory = Trajectory::starting(mode, state.clone(), Time::new(span.start));
        let mut course = match self.start(mode, state, span) {
            Ok(course) => course,
            Err(error) => return Err(Box::new(Failed { error, trajectory, stats: Stats::default() })),
        };
        let room = self.options.room;
        let mut record =
            Bounded { bytes: trajectory.bytes(), trajectory: &mut trajectory, room, next: room.first(), most: None };
        let end = course.finish(&mut record);
        let most = record.most;
        match end {
            Ok(end) => {
                trajectory.finish(end.time);
                let stop = most.map_or(end.stop, |most| Stop::Bytes { most });
                Ok(Run { trajectory, end: Ending { stop, ..end } })
            }
            Err(error) => {
                trajectory.settle(Time::new(error.t()));
                Err(Box::new(Failed { error, trajectory, stats: course.stats() }))
            }
        }
    }

    /// Runs and hands each piece and jump to `observer`, recording nothing.
    ///
    /// # Errors
    /// See [`Error`]; the observer has had everything before it.
    #[inline]
    pub fn drive(
        &self,
        mode: A::Mode,
        state: A::State,
        span: Range<f64>,
        observer: &mut impl Observer<A>,
    ) -> Result<EndingOf<A>, Error> {
        self.check(mode, &state, &span)?;
        self.course(mode, state, span).finish(observer)
    }

    /// Begins a run that is advanced jump by jump.
    ///
    /// # Errors
    /// See [`Error`]: a span, tolerance, mode or state that cannot be run.
    #[inline]
    pub fn start(&self, mode: A::Mode, state: A::State, span: Range<f64>) -> Result<Course<'a, A, M>, Error> {
        self.check(mode, &state, &span)?;
        Ok(self.course(mode, state, span))
    }

    /// A run from what has been checked.
    #[inline(always)]
    fn course(&self, mode: A::Mode, state: A::State, span: Range<f64>) -> Course<'a, A, M> {
        let (stepper, options) = (self.fitted(), self.options.begun());
        let memory = Memory::new(&stepper, options.first_step);
        Course::new(Advance::new(self.automaton, stepper, options, memory), Stage::start(mode, state, span))
    }

    /// Goes on from a checkpoint, to the bit as if there had been no pause.
    ///
    /// A run that has ended stays ended, unless it was by a limit on jumps, steps or evaluations
    /// that is higher now.
    ///
    /// The automaton, stepper and options are taken to be those of the run that the checkpoint
    /// comes from.
    #[must_use]
    pub fn resume(&self, checkpoint: CheckpointOf<A>) -> Course<'a, A, M> {
        Course::from(self.automaton, self.fitted(), self.options.begun(), checkpoint)
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
        let (kind, note) = if !(span.start.abs() <= LAST && span.start <= span.end) {
            (ErrorKind::Span, Some(format!("{}..{}", span.start, span.end)))
        } else if !((1e-15..1.0).contains(&relative) && absolute > 0.0 && absolute.is_finite()) {
            (ErrorKind::Tolerance, Some(format!("relative {relative:e}, absolute {absolute:e}")))
        } else if !(longest_step > 0.0 && first_step.is_none_or(|h| h > 0.0 && h.is_finite())) {
            let first = first_step.map(|h| format!("first_step {h}"));
            (
                ErrorKind::StepLimit,
                first.filter(|_| longest_step > 0.0).or(Some(format!("longest_step {longest_step}"))),
            )
        } else if let Err(flaw) = self.automaton.validate(mode, span.start, state) {
            (ErrorKind::Model, Some(flaw))
        } else if !state.is_finite() {
            (ErrorKind::InitialState, None)
        } else {
            return Ok(());
        };
        Err(Error::new(kind, Place::new(span.start, mode, None::<A::Edge>, state)).noting(note))
    }
}
