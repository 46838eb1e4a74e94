//! A run at regular times: rows of a table, with both limits at each jump.

use std::borrow::Cow;
use std::fmt;
use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::jump::JumpOf;
use crate::observe::Observer;
use crate::piece::Piece;
use crate::state::State;
use crate::table::{MOST_ROWS, cell, clock_heading, heading, named, numbers};
use crate::time::{Time, grace};
use crate::trajectory::Trajectory;

/// The state at a hybrid time (t, j).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sample<M, S> {
    /// The time, in seconds.
    pub t: f64,
    /// How many jumps came before.
    pub j: usize,
    /// The mode.
    pub mode: M,
    /// The state.
    pub state: S,
}

/// Keeps a run at the times t₀ + k·dt, and where each arc begins and ends: at a jump x⁻ and then
/// x⁺.
///
/// As an observer it keeps only these rows, so that a long run takes the memory of its table. Tick
/// k is rounded once, never added up; one that falls on an end of an arc is that end. An arc that
/// never ends has its first row and its last. More than 10⁷ rows end the run, with
/// [`Stop::Observer`](crate::Stop::Observer). Written with `{}` it is a table as CSV, with the
/// names and units of the state's coordinates ([`State::name`], [`State::unit`]) as headings.
/// [`without_jumps`](Self::without_jumps) leaves the regular times alone.
///
/// ```
/// use saltus::{Hybrid, Sampler, Simulation};
/// let tank = Hybrid::new()
///     .exact("fill", |_t, x: &f64| [*x, 1.0].into())
///     .edge("fill", "fill", |_t, x| 1.25 - x, |_t, _x| 0.0)
///     .affine();
/// let mut table = Sampler::every(0.5).named(["level (m)"]);
/// Simulation::of(&tank).drive("fill", 0.0, 0.0..1.5, &mut table)?;
/// assert_eq!(table.to_string(), "\
/// t (s),j,mode,level (m)
/// 0.0,0,fill,0.0
/// 0.5,0,fill,0.5
/// 1.0,0,fill,1.0
/// 1.25,0,fill,1.25
/// 1.25,1,fill,0.0
/// 1.5,1,fill,0.25
/// ");
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sampler<M, S> {
    dt: f64,
    start: Option<f64>,
    /// The number of the next tick.
    next: u64,
    rows: Vec<Sample<M, S>>,
    /// Whether an arc begins, whose first row is there already.
    begun: bool,
    /// The end of the last piece, which may be that of its arc.
    end: Option<Sample<M, S>>,
    j: usize,
    /// Of the coordinates, where the state's are not wanted.
    names: Vec<String>,
    time: Cow<'static, str>,
}

/// The samples of the automaton `A`.
pub type SamplerOf<A> = Sampler<<A as Automaton>::Mode, <A as Automaton>::State>;

impl<M: Copy, S: State> Sampler<M, S> {
    /// Every `dt` seconds; with one that is not above zero only where arcs begin and end.
    #[must_use]
    pub const fn every(dt: f64) -> Self {
        Self {
            dt,
            start: None,
            next: 1,
            rows: Vec::new(),
            begun: false,
            end: None,
            j: 0,
            names: Vec::new(),
            time: Cow::Borrowed("s"),
        }
    }

    /// Names the coordinates in the table, units in brackets at the end; those left over keep the
    /// names of the state.
    #[must_use]
    pub fn named<N: Into<String>>(mut self, names: impl IntoIterator<Item = N>) -> Self {
        self.names = names.into_iter().map(Into::into).collect();
        self
    }

    /// Names the unit of time, for a model whose rates are not per second: `h` heads its times
    /// `t (h)`.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// let room = Hybrid::new().mode("cools", |_t, x: &f64| -0.1 * x);
    /// let run = Simulation::of(&room).run("cools", 20.0, 0.0..24.0)?;
    /// assert!(run.trajectory.sampled(1.0)?.time("h").to_string().starts_with("t (h),j,mode,x0\n"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn time(mut self, unit: impl Into<Cow<'static, str>>) -> Self {
        self.time = unit.into();
        self
    }

    /// Leaves only the rows at t₀ + k·dt; of several at one time the last, x⁺.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// let tank = Hybrid::new()
    ///     .mode("fill", |_t, _x: &f64| 1.0)
    ///     .edge("fill", "fill", |_t, x| 1.25 - x, |_t, _x| 0.0)
    ///     .affine();
    /// let run = Simulation::of(&tank).run("fill", 0.0, 0.0..2.6)?;
    /// let table = run.trajectory.sampled(0.625)?.without_jumps();
    /// let times: Vec<f64> = table.rows().map(|row| row.t).collect();
    /// assert_eq!(times, [0.0, 0.625, 1.25, 1.875, 2.5]);
    /// assert_eq!(table.rows().nth(2).unwrap().state, 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn without_jumps(mut self) -> Self {
        let rows: Vec<_> = self.rows().collect();
        let start = self.start.unwrap_or_default();
        let largest = rows.last().map_or(0.0, |last| last.t.abs().max(start.abs()));
        let instant = grace(if largest.is_finite() { largest } else { start.abs() });
        let tick = |row: &Sample<M, S>| ((row.t - start) / self.dt).round();
        let is_regular = |row: &Sample<M, S>| (tick(row).mul_add(self.dt, start) - row.t).abs() <= instant;
        let is_last = |k: usize| rows.get(k + 1).is_none_or(|next| tick(next) > tick(&rows[k]) || !is_regular(next));
        let regular = (0..rows.len()).filter(|&k| is_regular(&rows[k]) && is_last(k)).map(|k| rows[k].clone());
        self.rows = regular.map(|row| Sample { t: tick(&row).mul_add(self.dt, start), ..row }).collect();
        self.end = None;
        self
    }

    /// The rows in order.
    pub fn rows(&self) -> impl Iterator<Item = Sample<M, S>> {
        self.rows.iter().chain(&self.end).cloned()
    }

    fn full(&self) -> ControlFlow<()> {
        if self.rows.len() < MOST_ROWS { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }

    fn tick(&self, start: f64) -> f64 {
        self.tick_of(self.next, start)
    }

    #[allow(clippy::cast_precision_loss)] // a count of ticks
    fn tick_of(&self, k: u64, start: f64) -> f64 {
        (k as f64).mul_add(self.dt, start)
    }

    /// Goes on to the first tick after a time, if there is one: by steps that double, and then by
    /// halves, for where ticks are closer than numbers of time there may be any number before.
    fn skip(&mut self, start: f64, to: f64) -> bool {
        let is_after = |k: u64| self.tick_of(k, start) > to;
        if is_after(self.next) {
            return true;
        }
        let (mut before, mut by) = (self.next, 1_u64);
        let mut after = loop {
            let Some(next) = before.checked_add(by) else { break u64::MAX };
            if is_after(next) {
                break next;
            }
            (before, by) = (next, by.saturating_mul(2));
        };
        if !is_after(after) {
            return false;
        }
        while after - before > 1 {
            let middle = before + (after - before) / 2;
            *(if is_after(middle) { &mut after } else { &mut before }) = middle;
        }
        self.next = after;
        true
    }

    fn begin(&mut self, t: f64, mode: M, state: S) -> f64 {
        *self.start.get_or_insert_with(|| {
            self.rows.push(Sample { t, j: 0, mode, state });
            self.begun = true;
            t
        })
    }

    pub(crate) fn take_piece(&mut self, mode: M, piece: &Piece<'_, S>) -> ControlFlow<()> {
        let (from, j) = (piece.start(), self.j);
        let to = from.after(piece.span()).seconds();
        let start = self.begin(from.seconds(), mode, piece.at(0.0));
        if self.dt > 0.0 && to.is_finite() {
            let instant = grace(to.abs().max(start.abs()));
            let first = from.seconds() + instant;
            self.begun = self.begun && !self.skip(start, first);
            if self.begun && first < to - instant {
                return ControlFlow::Break(()); // more ticks than can be counted, each a row
            }
            while !self.begun && self.tick(start) < to - instant && self.full().is_continue() {
                let t = self.tick(start);
                let state = piece.at(Time::new(t).since(from).clamp(0.0, piece.span()));
                self.rows.push(Sample { t, j, mode, state });
                self.next += 1;
            }
        }
        self.end = Some(Sample { t: to, j, mode, state: piece.at(piece.span()) });
        self.full()
    }

    pub(crate) fn take_jump(&mut self, t: f64, [from, to]: [(M, S); 2]) -> ControlFlow<()> {
        self.begin(t, from.0, from.1.clone());
        // At once after another jump, or the start, the state before is the last row.
        if self.end.take().is_some() {
            self.rows.push(Sample { t, j: self.j, mode: from.0, state: from.1 });
        }
        self.j += 1;
        self.rows.push(Sample { t, j: self.j, mode: to.0, state: to.1 });
        self.begun = true;
        self.full()
    }
}

impl<A: Automaton> Observer<A> for SamplerOf<A> {
    fn piece(&mut self, mode: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        self.take_piece(mode, piece)
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        self.take_jump(jump.t(), [(jump.from, jump.before.clone()), (jump.to, jump.after.clone())])
    }
}

impl<M: Copy + fmt::Debug, S: State> fmt::Display for Sampler<M, S> {
    /// As CSV. Of modes that differ in dimension a row has as many numbers as its state.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},j,mode", clock_heading(&self.time))?;
        if let Some(widest) = self.rows().max_by_key(|row| row.state.len()) {
            for i in 0..widest.state.len() {
                write!(f, ",{}", cell(&heading(&self.names, &widest.state, i, "")))?;
            }
        }
        writeln!(f)?;
        for Sample { t, j, mode, state } in self.rows() {
            write!(f, "{t:?},{j},{}", cell(&named(&mode)))?;
            numbers(f, &state)?;
            writeln!(f)?;
        }
        Ok(())
    }
}

/// Why a trajectory is not sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SamplingError {
    /// The time from row to row is not above zero and finite.
    Interval {
        /// What it is, in seconds.
        dt: f64,
    },
    /// There would be more than 10⁷ rows.
    Rows {
        /// The time from row to row, in seconds.
        dt: f64,
    },
}

impl fmt::Display for SamplingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Interval { dt } => {
                write!(f, "rows every {dt} s are none: give a finite time above zero, or take Trajectory::jump_table")
            }
            Self::Rows { dt } => write!(
                f,
                "rows every {dt} s are more than {MOST_ROWS}: take fewer, or observe the run in parts with Sampler::every"
            ),
        }
    }
}

impl std::error::Error for SamplingError {}

impl<M: Copy, E, S: State> Trajectory<M, E, S> {
    /// The trajectory every `dt` seconds, with both limits at each jump: see [`Sampler`].
    ///
    /// # Errors
    /// [`SamplingError`] for a dt that is not above zero and finite, and for more than 10⁷ rows.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// let decay = Hybrid::new().mode("decay", |_t, x: &f64| -x);
    /// let run = Simulation::of(&decay).run("decay", 1.0, 0.0..1.0)?;
    /// let table = run.trajectory.sampled(0.25)?;
    /// assert_eq!(table.rows().count(), 5);
    /// assert!(table.rows().all(|row| (row.state - (-row.t).exp()).abs() < 1e-8));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sampled(&self, dt: f64) -> Result<Sampler<M, S>, SamplingError> {
        if !(dt > 0.0 && dt < f64::INFINITY) {
            return Err(SamplingError::Interval { dt });
        }
        let mut table = Sampler::every(dt);
        for (index, arc) in self.arcs().iter().enumerate() {
            if index == 0 {
                table.begin(arc.start().seconds(), arc.mode(), arc.state().clone());
            }
            for piece in self.pieces(index) {
                if table.take_piece(arc.mode(), &piece).is_break() {
                    return Err(SamplingError::Rows { dt });
                }
            }
            if let Some(jump) = self.jumps().get(index)
                && table
                    .take_jump(jump.t(), [(jump.from, jump.before.clone()), (jump.to, jump.after.clone())])
                    .is_break()
            {
                return Err(SamplingError::Rows { dt });
            }
        }
        Ok(table)
    }
}
