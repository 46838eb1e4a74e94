//! Clocks: edges that are taken at given times.

use std::fmt;
use std::sync::Arc;

type Function = dyn Fn(f64) -> Option<f64> + Send + Sync;

/// When a clock ticks: with a period, at given times, or as a function says.
///
/// Tick k of a period T is k·T, rounded once: never a sum of periods, so that the millionth is as
/// exact as the first. A clock that cannot tick (a period that is not above zero, times that do not
/// rise) is an error that names it, of a [`Hybrid`](crate::Hybrid) before a run starts.
///
/// Two clocks are one and the same if they are equal: the same period and phase, the same times, or
/// clones of one function.
///
/// ```
/// use saltus::{Clock, Hybrid, Simulation};
/// // A measurement each 10 ms, and each 30 ms, at the same instant but after it, a correction.
/// let control = Hybrid::new()
///     .mode("run", |_t, _x: &[f64; 2]| [0.0; 2])
///     .clock("run", "run", Clock::every(0.01), |_t, x| [x[0] + 1.0, x[1]])
///     .clock("run", "run", Clock::every(0.03), |_t, x| [x[0], x[1] + 1.0]);
/// let run = Simulation::of(&control).run("run", [0.0; 2], 0.0..0.3)?;
/// assert_eq!(run.end.state, [30.0, 10.0]);
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone)]
pub struct Clock {
    times: Times,
    from_start: bool,
    /// Whether time runs backwards: it ticks at -t for each of its times t.
    backwards: bool,
    /// Why it cannot tick.
    flaw: Option<Arc<str>>,
}

#[derive(Clone)]
enum Times {
    /// k·period for each integer k; with a phase, phase + k·period for k ≥ 0.
    Every {
        period: f64,
        phase: Option<f64>,
    },
    /// time + k·period for each integer k and each of the times, which rise within one period.
    Cycle {
        period: f64,
        times: Arc<[f64]>,
    },
    At(Arc<[f64]>),
    Function(Arc<Function>),
}

impl Clock {
    /// At k·`period` for each integer k, in seconds.
    ///
    /// ```
    /// use saltus::{Clock, Hybrid, Simulation};
    /// let ticking = |period| Hybrid::new()
    ///     .mode("run", |_t, _x: &f64| 0.0)
    ///     .clock("run", "run", Clock::every(period), |_t, x| x + 1.0);
    /// let run = Simulation::of(&ticking(0.1)).run("run", 0.0, 0.0..0.3)?;
    /// let times: Vec<_> = run.trajectory.jumps().iter().map(|jump| jump.t()).collect();
    /// assert_eq!(times, [0.1, 0.2, 0.3]); // not 0.1 + 0.1 + 0.1, which is more than 0.3
    /// let error = Simulation::of(&ticking(0.0)).run("run", 0.0, 0.0..0.3).unwrap_err().error;
    /// assert!(error.to_string().contains("has a period of 0 s"));
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn every(period: f64) -> Self {
        let flaw = (!(period > 0.0 && period.is_finite()))
            .then(|| format!("has a period of {period} s: give Clock::every a finite one above zero"));
        Self::of(Times::Every { period, phase: None }, flaw)
    }

    /// At `times`, in seconds, each after the one before.
    ///
    /// ```
    /// use saltus::{Clock, Hybrid, Simulation};
    /// let kicked = Hybrid::new()
    ///     .mode("run", |_t, _x: &f64| 0.0)
    ///     .clock("run", "run", Clock::at([0.5, 0.75]), |t, x| x + t);
    /// assert_eq!(Simulation::of(&kicked).run("run", 0.0, 0.0..1.0)?.end.state, 1.25);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn at(times: impl Into<Arc<[f64]>>) -> Self {
        let times = times.into();
        let falls = times.windows(2).find(|pair| pair[0] >= pair[1]);
        let flaw = match (times.iter().find(|time| !time.is_finite()), falls) {
            (Some(time), _) => Some(format!("has a tick at {time}: give Clock::at finite times")),
            (None, Some(pair)) => {
                Some(format!("has a tick at {} and then one at {}: give Clock::at times that rise", pair[0], pair[1]))
            }
            (None, None) => None,
        };
        Self::of(Times::At(times), flaw)
    }

    /// As `next` says: its first tick strictly after a time, in seconds; nothing if there is none.
    ///
    /// It is asked once for each tick, with the time of the tick before. An answer that is not
    /// after that time is an error, which names both: work ticks out from an integer that counts
    /// them, not from the time.
    ///
    /// ```
    /// use saltus::{Clock, ErrorKind, Hybrid, Simulation};
    /// // Rounding makes this return the time it is asked about, first at 0.6 s.
    /// let wrong = Clock::from_fn(|t| Some(((t / 0.1).floor() + 1.0) * 0.1));
    /// let model = Hybrid::new()
    ///     .mode("run", |_t, _x: &f64| 0.0)
    ///     .clock("run", "run", wrong, |_t, x| x + 1.0);
    /// let error = Simulation::of(&model).run("run", 0.0, 0.0..10.0).unwrap_err().error;
    /// assert_eq!(error.kind(), ErrorKind::Clock);
    /// ```
    #[must_use]
    pub fn from_fn(next: impl Fn(f64) -> Option<f64> + Send + Sync + 'static) -> Self {
        Self::of(Times::Function(Arc::new(next)), None)
    }

    /// The same over and over, before its first tick as well: at t + k·`period`, in seconds, for
    /// each tick t and each integer k.
    ///
    /// It is for [`at`](Self::at), whose times are to lie within one period; of what repeats by
    /// itself, and of a function, it is an error.
    ///
    /// ```
    /// use saltus::{Clock, Hybrid, Simulation};
    /// // Each minute two drops, 10 s apart.
    /// let drops = Hybrid::new()
    ///     .mode("wait", |_t, _x: &f64| 0.0)
    ///     .clock("wait", "wait", Clock::at([20.0, 30.0]).repeated(60.0), |_t, x| x + 1.0);
    /// let run = Simulation::of(&drops).run("wait", 0.0, 0.0..120.0)?;
    /// let times: Vec<_> = run.trajectory.jumps().iter().map(|jump| jump.t()).collect();
    /// assert_eq!(times, [20.0, 30.0, 80.0, 90.0]);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn repeated(self, period: f64) -> Self {
        let Self { times, from_start, backwards, flaw } = self;
        let wrong = match &times {
            Times::At(times) if times.is_empty() => Some("has no tick to repeat: give Clock::at a time".into()),
            Times::At(times) => {
                let lasts = times[times.len() - 1] - times[0];
                (!(period > lasts && period.is_finite())).then(|| {
                    format!("repeats ticks over {lasts} s each {period} s: give Clock::repeated a longer period")
                })
            }
            _ => Some("repeats what is no list of times: use Clock::repeated with Clock::at".into()),
        };
        let times = if let Times::At(times) = times { Times::Cycle { period, times } } else { times };
        Self { times, from_start, backwards, flaw: flaw.or(wrong.map(Into::into)) }
    }

    /// The same in time that runs backwards, s = -t; a function has no way back, which is a flaw.
    pub(crate) fn reversed(&self) -> Self {
        let one_way = matches!(self.times, Times::Function(_)).then(|| {
            "is a function of time, which cannot run backwards: use Clock::every, or Clock::at and repeated".into()
        });
        Self { backwards: !self.backwards, flaw: self.flaw.clone().or(one_way), ..self.clone() }
    }

    /// The same shifted by `phase`, in seconds: a period ticks at phase + k·T for k = 0, 1, 2, …
    ///
    /// ```
    /// use saltus::{Clock, Hybrid, Simulation};
    /// let late = Hybrid::new()
    ///     .mode("run", |_t, _x: &f64| 0.0)
    ///     .clock("run", "run", Clock::every(0.5).after(3.25), |_t, x| x + 1.0);
    /// let run = Simulation::of(&late).run("run", 0.0, 0.0..4.0)?;
    /// let times: Vec<_> = run.trajectory.jumps().iter().map(|jump| jump.t()).collect();
    /// assert_eq!(times, [3.25, 3.75]);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn after(self, phase: f64) -> Self {
        let Self { times, from_start, backwards, flaw } = self;
        let flaw = flaw.or_else(|| {
            let wrong = (!phase.is_finite()).then(|| format!("has a phase of {phase} s: give a finite one"));
            wrong.map(Into::into)
        });
        let times = match times {
            Times::Every { period, phase: before } => {
                Times::Every { period, phase: Some(before.unwrap_or(0.0) + phase) }
            }
            Times::Cycle { period, times } => Times::Cycle { period, times: shifted(&times, phase) },
            Times::At(times) => Times::At(shifted(&times, phase)),
            Times::Function(next) => Times::Function(Arc::new(move |t| Some(next(t - phase)? + phase))),
        };
        Self { times, from_start, backwards, flaw }
    }

    /// Takes also the tick that falls on the very start of a run, which is over by default: so that
    /// of two runs, the second of which starts where the first ends, each tick is taken once.
    ///
    /// ```
    /// use saltus::{Clock, Hybrid, Simulation};
    /// let sampled = Hybrid::new()
    ///     .mode("run", |_t, _x: &f64| 0.0)
    ///     .clock("run", "run", Clock::every(0.5).from_start(), |_t, x| x + 1.0);
    /// assert_eq!(Simulation::of(&sampled).run("run", 0.0, 0.0..1.0)?.end.state, 3.0);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn from_start(self) -> Self {
        Self { from_start: true, ..self }
    }

    fn of(times: Times, flaw: Option<String>) -> Self {
        Self { times, from_start: false, backwards: false, flaw: flaw.map(Into::into) }
    }

    /// The period of one that has a period, and the largest size of what it adds to its multiples.
    pub(crate) fn period(&self) -> Option<(f64, f64)> {
        match &self.times {
            Times::Every { period, phase } => Some((*period, phase.map_or(0.0, f64::abs))),
            Times::Cycle { period, times } => {
                Some((*period, times.iter().fold(0.0, |most, time| time.abs().max(most))))
            }
            Times::At(_) | Times::Function(_) => None,
        }
    }

    /// How long before the time zero it began to count: its ticks soon after that have the rounding
    /// of this.
    pub(crate) fn behind(&self) -> f64 {
        if let Times::Every { phase: Some(phase), .. } = self.times { (-phase).max(0.0) } else { 0.0 }
    }

    /// The first tick at `from` or later, where that follows without asking; or whom to ask.
    fn next(&self, from: f64) -> Result<Option<f64>, &Function> {
        match &self.times {
            Times::Function(next) => Err(&**next),
            _ if self.backwards => Ok(self.latest(-from).map(|time| -time)),
            Times::Every { period, phase } => {
                let least = phase.map_or(f64::NEG_INFINITY, |_| 0.0);
                Ok(multiples(*period, phase.unwrap_or(0.0), from, |k| k.max(least)).find(|&time| time >= from))
            }
            Times::Cycle { period, times } => Ok(cycles(*period, times, from).find_map(|k| {
                let at = |time: &f64| k.mul_add(*period, *time);
                times.get(times.partition_point(|time| at(time) < from)).map(at)
            })),
            Times::At(times) => Ok(times.get(times.partition_point(|&time| time < from)).copied()),
        }
    }

    /// The last tick at `until` or earlier, of what is no function.
    fn latest(&self, until: f64) -> Option<f64> {
        match &self.times {
            Times::Every { period, phase } => {
                let (offset, least) = (phase.unwrap_or(0.0), phase.unwrap_or(f64::NEG_INFINITY));
                let mut last = multiples(*period, offset, until, |k| k).filter(|&time| least <= time && time <= until);
                last.next_back()
            }
            Times::Cycle { period, times } => cycles(*period, times, until).rev().find_map(|k| {
                let at = |time: &f64| k.mul_add(*period, *time);
                times[..times.partition_point(|time| at(time) <= until)].last().map(at)
            }),
            Times::At(times) => times[..times.partition_point(|&time| time <= until)].last().copied(),
            Times::Function(_) => None,
        }
    }

    /// Whether it can tick.
    pub(crate) fn validate(&self) -> Result<(), String> {
        self.flaw.as_ref().map_or(Ok(()), |flaw| Err(flaw.to_string()))
    }
}

impl PartialEq for Clock {
    fn eq(&self, other: &Self) -> bool {
        let same = match (&self.times, &other.times) {
            (Times::Every { period: a, phase: p }, Times::Every { period: b, phase: q }) => a == b && p == q,
            (Times::Cycle { period: a, times: p }, Times::Cycle { period: b, times: q }) => a == b && p == q,
            (Times::At(a), Times::At(b)) => a == b,
            (Times::Function(a), Times::Function(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        same && self.from_start == other.from_start && self.backwards == other.backwards
    }
}

impl fmt::Debug for Clock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.times {
            Times::Every { period, phase } => {
                write!(f, "every {period} s")?;
                phase.map_or(Ok(()), |phase| write!(f, " after {phase} s"))
            }
            Times::Cycle { period, times } => write!(f, "at {times:?} s, every {period} s"),
            Times::At(times) => write!(f, "at {times:?} s"),
            Times::Function(_) => f.write_str("as a function says"),
        }?;
        if self.backwards { f.write_str(", backwards") } else { Ok(()) }
    }
}

/// Something that is asked when it ticks next: a model that does not keep its clocks.
pub trait Ticking {
    /// The first tick strictly after `t`, in seconds; nothing if there is none. Asked once for each
    /// tick; see [`Clock::from_fn`].
    fn after(&self, t: f64) -> Option<f64>;
}

/// The clocks of a mode, in order of priority, each with the edge that it takes.
///
/// All clocks that are due at one instant are taken, each once, in the order in which the mode
/// lists them, after the crossings at that instant: also where one of them leads to another mode,
/// which lists an equal clock. Ticks that differ by no more than the rounding of k·T are at one
/// instant. A tick at the very end of the span is taken, one at the very start is not
/// ([`Clock::from_start`]).
///
/// A model that keeps its clocks lends them, which takes no allocation:
///
/// ```
/// use saltus::{Automaton, Clock, Clocks, Edges, Refusal, Simulation};
///
/// /// A tank that is filled by 1 L each second.
/// struct Tank {
///     clocks: [(Clock, ()); 1],
/// }
///
/// impl Automaton for Tank {
///     type Mode = ();
///     type State = f64;
///     type Edge = ();
///     fn flow(&self, (): (), _t: f64, _x: &f64) -> f64 {
///         0.0
///     }
///     fn edges(&self, (): ()) -> Edges<'_, ()> {
///         Edges::none()
///     }
///     fn guard(&self, (): (), _t: f64, _x: &f64) -> f64 {
///         1.0
///     }
///     fn clocks(&self, (): ()) -> Clocks<'_, ()> {
///         Clocks::kept(&self.clocks)
///     }
///     fn reset(&self, (): (), (): (), _t: f64, x: &f64) -> Result<((), f64), Refusal> {
///         Ok(((), x + 1.0))
///     }
/// }
///
/// let tank = Tank { clocks: [(Clock::every(1.0), ())] };
/// assert_eq!(Simulation::of(&tank).run((), 0.0, 0.0..5.5)?.end.state, 5.0);
/// # Ok::<(), saltus::Error>(())
/// ```
pub struct Clocks<'a, E> {
    list: List<'a, E>,
}

enum List<'a, E> {
    Kept(&'a [(Clock, E)]),
    Made(Vec<(Clock, E)>),
    Asked(&'a dyn Ticking, E),
}

impl<'a, E: Copy> Clocks<'a, E> {
    /// No clocks.
    #[must_use]
    #[inline]
    pub const fn none() -> Self {
        Self { list: List::Kept(&[]) }
    }

    /// Clocks that the model keeps.
    #[must_use]
    #[inline]
    pub const fn kept(clocks: &'a [(Clock, E)]) -> Self {
        Self { list: List::Kept(clocks) }
    }

    /// The one clock of a model that is asked for its ticks.
    #[must_use]
    #[inline]
    pub const fn asked(clock: &'a dyn Ticking, edge: E) -> Self {
        Self { list: List::Asked(clock, edge) }
    }

    /// The edges that they take, in order.
    pub fn edges(&self) -> impl Iterator<Item = E> {
        (0..self.len()).filter_map(|place| Some(self.get(place)?.1))
    }

    /// How many there are.
    #[must_use]
    #[inline]
    pub const fn len(&self) -> usize {
        match &self.list {
            List::Kept(list) => list.len(),
            List::Made(list) => list.len(),
            List::Asked(..) => 1,
        }
    }

    /// Whether there are none.
    #[must_use]
    #[inline]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(crate) fn get(&self, place: usize) -> Option<(Source<'_>, E)> {
        match &self.list {
            List::Kept(list) => list.get(place).map(|(clock, edge)| (Source::Clock(clock), *edge)),
            List::Made(list) => list.get(place).map(|(clock, edge)| (Source::Clock(clock), *edge)),
            List::Asked(clock, edge) => (place == 0).then_some((Source::Asked(*clock), *edge)),
        }
    }
}

/// Clocks that are made anew: their number takes an allocation each time, unless there are none.
impl<E, const N: usize> From<[(Clock, E); N]> for Clocks<'_, E> {
    fn from(clocks: [(Clock, E); N]) -> Self {
        Self { list: List::Made(clocks.into()) }
    }
}

impl<E: fmt::Debug + Copy> fmt::Debug for Clocks<'_, E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.edges()).finish()
    }
}

/// Where ticks come from.
#[derive(Clone, Copy)]
pub(crate) enum Source<'s> {
    Clock(&'s Clock),
    Asked(&'s dyn Ticking),
}

impl Source<'_> {
    /// Whether it is one and the same clock.
    pub(crate) fn is(&self, other: &Source<'_>) -> bool {
        match (self, other) {
            (Self::Clock(a), Source::Clock(b)) => a == b,
            (Self::Asked(a), Source::Asked(b)) => std::ptr::addr_eq(*a, *b),
            _ => false,
        }
    }

    /// See [`Clock::behind`].
    pub(crate) fn behind(&self) -> f64 {
        if let Self::Clock(clock) = self { clock.behind() } else { 0.0 }
    }

    /// Whether it ticks at the very start of a run.
    pub(crate) fn starts(&self) -> bool {
        matches!(self, Self::Clock(clock) if clock.from_start)
    }

    /// The first tick at `from` or later, where that follows without asking; or whom to ask.
    pub(crate) fn next(&self, from: f64) -> Result<Option<f64>, Ask<'_>> {
        match self {
            Self::Clock(clock) => clock.next(from).map_err(Ask::To),
            Self::Asked(ticking) => Err(Ask::Of(*ticking)),
        }
    }
}

/// Whom to ask for a tick.
pub(crate) enum Ask<'s> {
    Of(&'s dyn Ticking),
    To(&'s Function),
}

impl Ask<'_> {
    pub(crate) fn after(&self, t: f64) -> Option<f64> {
        match self {
            Self::Of(ticking) => ticking.after(t),
            Self::To(next) => next(t),
        }
    }
}

/// The k of those repetitions of `times` between which `t` lies, in order.
fn cycles(period: f64, times: &[f64], t: f64) -> impl DoubleEndedIterator<Item = f64> {
    let near = times.first().map(|first| ((t - first) / period).floor());
    near.into_iter().flat_map(|near| [near - 1.0, near, near + 1.0])
}

/// offset + k·period near `t`, each rounded once, in order, for k as `bounded` lets it be.
///
/// The quotient is off by less than a half, for a period longer than two instants: k is below 2⁵⁰.
fn multiples(period: f64, offset: f64, t: f64, bounded: impl Fn(f64) -> f64) -> impl DoubleEndedIterator<Item = f64> {
    let near = ((t - offset) / period).round();
    [near - 1.0, near, near + 1.0].into_iter().map(move |k| bounded(k).mul_add(period, offset))
}

fn shifted(times: &[f64], phase: f64) -> Arc<[f64]> {
    times.iter().map(|time| phase + time).collect()
}
