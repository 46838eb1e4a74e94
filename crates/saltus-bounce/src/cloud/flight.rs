//! A cloud advanced from event to event, with a list of the next events of each ball.

use saltus::{Automaton, Time};

use super::{Cloud, Swarm, Touch, meet};
use crate::restitution::Restitution;

/// A cloud in flight, with the next event of each ball: an impact makes only those searched again
/// whose next event it has changed.
///
/// The physics is that of the automaton, impact for impact; an event costs some N looks instead of
/// N²/2. Take this to drive many balls for long, the automaton to have a trajectory, an observer or
/// a limit. Nothing is allocated. Events at one time are taken in the order of [`Touch`] only if
/// their times are the same number.
///
/// ```
/// use saltus_bounce::{Cloud, Cor, cloud::Touch};
/// let cloud = Cloud::new([1.0, 1.0], [0.5, 0.5], Cor::new(1.0)?)?;
/// let start = cloud.placed([[0.0, 0.0], [3.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]])?;
/// let mut flight = cloud.flight(0.0, start);
/// assert_eq!(flight.event(9.0), Some(Touch::Balls(0, 1)));
/// assert_eq!(flight.time().seconds(), 2.0);
/// assert_eq!(flight.event(9.0), None); // no more before 9 s
/// assert_eq!(flight.state().centres, [[2.0, 0.0], [10.0, 0.0]]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Flight<'a, const D: usize, const N: usize, R> {
    cloud: &'a Cloud<D, N, R>,
    now: Time,
    state: Swarm<D, N>,
    next: [Option<(Time, Touch)>; N],
}

impl<const D: usize, const N: usize, R: Restitution + Copy> Cloud<D, N, R> {
    /// The cloud in flight from `state` at `time` in s.
    #[must_use]
    pub fn flight(&self, time: f64, state: Swarm<D, N>) -> Flight<'_, D, N, R> {
        let mut flight = Flight { cloud: self, now: Time::new(time), state, next: [None; N] };
        for ball in 0..N {
            flight.look(ball);
        }
        flight
    }
}

impl<const D: usize, const N: usize, R: Restitution + Copy> Flight<'_, D, N, R> {
    /// The time reached.
    #[must_use]
    pub const fn time(&self) -> Time {
        self.now
    }

    /// The state reached, after the last event.
    #[must_use]
    pub const fn state(&self) -> &Swarm<D, N> {
        &self.state
    }

    /// Advances to just after the next event, and returns it; or to `until` in s, if there is none
    /// before.
    ///
    /// A lossy cloud may have infinitely many events in a finite time: count them.
    pub fn event(&mut self, until: f64) -> Option<Touch> {
        let next = self.next.iter().flatten().fold(None, |first: Option<(Time, Touch)>, &event| match first {
            Some(first) if !earlier(event, first) => Some(first),
            _ => Some(event),
        });
        let Some((time, touch)) = next.filter(|(time, _)| *time <= Time::new(until)) else {
            self.coast(Time::new(until));
            return None;
        };
        self.coast(time);
        self.state = self.cloud.touched(touch, &self.state);
        match touch {
            Touch::Balls(i, j) => self.changed([i, j]),
            Touch::Low { ball, .. } | Touch::High { ball, .. } => self.changed([ball, ball]),
        }
        Some(touch)
    }

    /// Flies freely up to `time`.
    fn coast(&mut self, time: Time) {
        self.state = self.cloud.flown((), 0.0, &self.state, time.since(self.now));
        self.now = time;
    }

    /// The velocities of `balls` have changed.
    fn changed(&mut self, balls: [usize; 2]) {
        for ball in balls {
            self.look(ball);
        }
        for other in (0..N).filter(|other| !balls.contains(other)) {
            let stale =
                matches!(self.next[other], Some((_, Touch::Balls(i, j))) if balls.contains(&i) || balls.contains(&j));
            if stale {
                self.look(other);
            } else {
                for ball in balls {
                    self.next[other] = first(self.next[other], self.meeting(ball, other));
                }
            }
        }
    }

    /// Finds the next event of `ball`.
    fn look(&mut self, ball: usize) {
        let pairs = (0..N).filter(|&other| other != ball).filter_map(|other| self.meeting(ball, other));
        let walls = (0..D).flat_map(|axis| [Touch::Low { ball, axis }, Touch::High { ball, axis }]);
        let walls = walls.filter(|_| self.cloud.walls.is_some()).filter_map(|touch| self.when(touch));
        self.next[ball] = pairs.chain(walls).fold(None, |next, event| first(next, Some(event)));
    }

    fn meeting(&self, a: usize, b: usize) -> Option<(Time, Touch)> {
        self.when(Touch::Balls(a.min(b), a.max(b)))
    }

    fn when(&self, touch: Touch) -> Option<(Time, Touch)> {
        self.cloud.meeting(touch, &self.state).map(|s| (self.now.after(s), touch))
    }
}

impl<const D: usize, const N: usize, R: Restitution + Copy> Cloud<D, N, R> {
    /// The time in s from the state `x` to a touch, if it happens.
    #[inline]
    pub(super) fn meeting(&self, touch: Touch, x: &Swarm<D, N>) -> Option<f64> {
        match touch {
            Touch::Balls(i, j) => {
                let (r, v) = Self::relative(x, i, j);
                meet::balls(r, v, self.radii[i] + self.radii[j])
            }
            Touch::Low { ball, axis } => {
                meet::wall(self.guard(touch, 0.0, x), x.velocities[ball][axis], self.gravity[axis])
            }
            Touch::High { ball, axis } => {
                meet::wall(self.guard(touch, 0.0, x), -x.velocities[ball][axis], -self.gravity[axis])
            }
        }
    }
}

fn first(a: Option<(Time, Touch)>, b: Option<(Time, Touch)>) -> Option<(Time, Touch)> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if earlier(b, a) { b } else { a }),
        (a, b) => a.or(b),
    }
}

fn earlier(a: (Time, Touch), b: (Time, Touch)) -> bool {
    a.0 < b.0 || (a.0 == b.0 && a.1 < b.1)
}
