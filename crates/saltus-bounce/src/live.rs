//! Frame by frame: for loops that ask for the state at their own times.

use std::fmt;
use std::ops::{ControlFlow, Range};

use saltus::step::Stepper;
use saltus::{Automaton, CheckpointOf, Error, JumpOf, Observer, Piece, Simulation, State, Stop, Time};

/// The number of pieces of a stepped arc that are kept.
const PIECES: usize = 64;
/// The most coefficients of a piece of a stepper here.
const COEFFICIENTS: usize = 9;

/// A run that a game or an animation advances frame by frame.
///
/// Impacts are found ahead of the frames, by the same arcs and jumps as in a [`Simulation`]: they
/// are the same to the bit for every frame rate. Between them a frame evaluates a formula where the
/// mode has one. Each jump is handed out once, in the frame in which it happens, as many as happen.
///
/// Work per frame is bounded: at most [`most_jumps`](Self::most_jumps) jumps; then the frame says
/// that it is late, and the next ones catch up. Nothing is allocated, but for a stepped mode's room
/// for 64 pieces when the first one is entered. A stepped arc of more steps than that is begun
/// again for each further 64. The span's end should be finite: a mode that is never left is
/// searched to it once.
///
/// ```
/// use saltus::Simulation;
/// use saltus_bounce::{Ball, Cor, Live, Mode};
///
/// let ball = Ball::new(9.81, Cor::new(0.8)?)?;
/// let mut live = Live::start(&ball, Simulation::of(&ball), Mode::Flight, Ball::dropped_from(1.0), 0.0..60.0)?;
/// let mut impacts = 0;
/// for _ in 0..60 {
///     let frame = live.advance(1.0 / 60.0, |_impact| impacts += 1)?;
///     assert!(frame.state[0] >= 0.0);
/// }
/// assert_eq!(impacts, 1); // at 0.45 s; the next comes at 1.17 s
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Live<'a, A: Automaton, M> {
    automaton: &'a A,
    simulation: Simulation<'a, A, M>,
    /// The start of the present arc.
    from: CheckpointOf<A>,
    mode: A::Mode,
    state: A::State,
    /// The start of the next arc, if the end of the present one has been computed.
    next: Option<CheckpointOf<A>>,
    jumps: [Option<JumpOf<A>>; 2],
    pieces: Vec<Kept<A::State>>,
    /// The number of pieces of the present arc before those kept.
    before: usize,
    /// Whether only the limit of bounces is still to come, too soon for the state to move.
    stands: bool,
    now: Time,
    end: Time,
    most_jumps: usize,
}

/// The state at a frame.
pub struct Frame<A: Automaton> {
    /// The time in s.
    pub t: f64,
    /// The mode.
    pub mode: A::Mode,
    /// The state.
    pub state: A::State,
    /// Whether the limit on jumps in one frame was reached: t is that of the last jump, and the
    /// next frames catch up.
    pub late: bool,
}

impl<A: Automaton> fmt::Debug for Frame<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "t = {}: {:?} {:?}", self.t, self.mode, self.state)
    }
}

impl<A: Automaton, M> fmt::Debug for Live<'_, A, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at t = {}, in the arc from {:?}", self.now.seconds(), self.from)
    }
}

/// A piece of a stepped arc.
struct Kept<S> {
    start: Time,
    span: f64,
    scale: f64,
    coefficients: [S; COEFFICIENTS],
    len: usize,
}

/// Keeps an arc's jumps, and its pieces where they are wanted.
struct Ahead<'p, A: Automaton> {
    pieces: Option<&'p mut Vec<Kept<A::State>>>,
    skip: usize,
    jumps: [Option<JumpOf<A>>; 2],
}

impl<A: Automaton> Observer<A> for Ahead<'_, A> {
    fn wants_pieces(&self) -> bool {
        self.pieces.is_some()
    }
    fn piece(&mut self, _: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        let Some(pieces) = &mut self.pieces else { return ControlFlow::Continue(()) };
        if self.skip > 0 {
            self.skip -= 1;
            return ControlFlow::Continue(());
        }
        if pieces.len() >= PIECES {
            return ControlFlow::Break(());
        }
        let list = piece.coefficients();
        let coefficients = std::array::from_fn(|k| list[k.min(list.len() - 1)].clone());
        let len = list.len().min(COEFFICIENTS);
        pieces.push(Kept { start: piece.start(), span: piece.span(), scale: piece.scale(), coefficients, len });
        ControlFlow::Continue(())
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        let place = usize::from(self.jumps[0].is_some());
        self.jumps[place] = Some(jump.clone());
        ControlFlow::Continue(())
    }
}

impl<'a, A: Automaton, M: Stepper> Live<'a, A, M> {
    /// Starts from `state` in `mode`; `simulation` is one of `automaton`, its end that of `span`.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn start(
        automaton: &'a A,
        simulation: Simulation<'a, A, M>,
        mode: A::Mode,
        state: A::State,
        span: Range<f64>,
    ) -> Result<Self, Error> {
        let (now, end) = (Time::new(span.start), Time::new(span.end));
        let from = simulation.start(mode, state.clone(), span)?.checkpoint();
        let mut live = Self {
            automaton,
            simulation,
            from,
            mode,
            state,
            next: None,
            jumps: [None, None],
            pieces: Vec::new(),
            before: 0,
            stands: false,
            now,
            end,
            most_jumps: 1000,
        };
        live.look_ahead()?;
        Ok(live)
    }

    /// Hands out at most this many jumps in one frame; 1000 unless set.
    #[must_use]
    pub const fn most_jumps(mut self, count: usize) -> Self {
        self.most_jumps = count;
        self
    }

    /// The present time in s.
    #[must_use]
    pub const fn time(&self) -> f64 {
        self.now.seconds()
    }

    /// Advances by `dt` ≥ 0 in s, at most to the end of the span, and calls `event` with each jump
    /// on the way, in order.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn advance(&mut self, dt: f64, event: impl FnMut(&JumpOf<A>)) -> Result<Frame<A>, Error> {
        self.now = self.now.after(dt.max(0.0));
        self.show(event)
    }

    /// Advances to time `t` in s, if that is later: frame times that are given keep the run from
    /// collecting roundings of `dt`.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn advance_to(&mut self, t: f64, event: impl FnMut(&JumpOf<A>)) -> Result<Frame<A>, Error> {
        if t > self.now.seconds() {
            self.now = Time::new(t);
        }
        self.show(event)
    }

    fn show(&mut self, mut event: impl FnMut(&JumpOf<A>)) -> Result<Frame<A>, Error> {
        if self.now > self.end {
            self.now = self.end;
        }
        let mut count = 0;
        let mut last = None;
        loop {
            match &self.jumps {
                [Some(jump), _] if jump.time <= self.now => {
                    if count == self.most_jumps {
                        let t = last.unwrap_or(self.now.seconds());
                        return Ok(Frame { t, mode: self.mode, state: self.state.clone(), late: true });
                    }
                    count += 1;
                    event(jump);
                    (self.mode, self.state, last) = (jump.to, jump.after.clone(), Some(jump.t()));
                    self.jumps.rotate_left(1);
                    self.jumps[1] = None;
                    self.stands = self.jumps[0].is_some();
                    if !self.stands {
                        if let Some(next) = self.next.take() {
                            self.from = next;
                        }
                        self.before = 0;
                        self.look_ahead()?;
                    }
                }
                _ if self.beyond_pieces() => {
                    self.before += self.pieces.len();
                    self.look_ahead()?;
                }
                _ => break,
            }
        }
        Ok(Frame { t: self.now.seconds(), mode: self.mode, state: self.now_state(), late: false })
    }

    /// Whether the present time lies after the pieces kept, of an arc that goes on.
    fn beyond_pieces(&self) -> bool {
        let ends = |piece: &Kept<A::State>| self.now.since(piece.start) > piece.span;
        self.next.is_none() && self.pieces.len() == PIECES && self.pieces.last().is_some_and(ends)
    }

    /// Whether a formula gives the state in the present mode.
    #[inline]
    fn by_formula(&self, t: f64) -> bool {
        self.automaton.solution(self.mode, t, &self.state).is_exact()
    }

    /// Finds what ends the present arc.
    fn look_ahead(&mut self) -> Result<(), Error> {
        let formula = self.by_formula(self.from.time().seconds());
        self.pieces.clear();
        if !formula {
            self.pieces.reserve_exact(PIECES);
        }
        let mut course = self.simulation.resume(self.from.clone());
        let mut ahead =
            Ahead { pieces: (!formula).then_some(&mut self.pieces), skip: self.before, jumps: [None, None] };
        let stop = course.advance(&mut ahead)?;
        self.jumps = ahead.jumps;
        self.stands |= self.jumps[0].is_none() && !matches!(stop, Some(Stop::Time | Stop::Observer));
        self.next = self.jumps[0].is_some().then(|| course.checkpoint());
        Ok(())
    }

    /// The state at the present time, within the present arc.
    fn now_state(&self) -> A::State {
        let from = self.from.time();
        let s = self.now.since(from);
        if self.stands {
            return self.state.clone();
        }
        let t = from.seconds();
        let solution = self.automaton.solution(self.mode, t, &self.state);
        if let Some(state) = solution.at(self.automaton, self.mode, t, &self.state, s) {
            return state;
        }
        let after = self.pieces.partition_point(|piece| self.now.since(piece.start) >= 0.0);
        let Some(piece) = self.pieces.get(after.saturating_sub(1)) else { return self.state.clone() };
        let u = self.now.since(piece.start).min(piece.span) / piece.scale;
        let c = &piece.coefficients[..piece.len];
        c[0].with(|i| c.iter().rev().fold(0.0, |sum, c| sum * u + c.get(i)))
    }
}
