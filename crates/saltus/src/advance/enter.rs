//! What a mode's guards say as it is entered.

use crate::automaton::{Automaton, Entry};
use crate::cross::Move;
use crate::error::{Error, ErrorKind, Place};
use crate::state::State;
use crate::step::Stepper;
use crate::time::Time;

use super::{Advance, Trigger};

/// A guard larger than this part of the state is not zero but for rounding: others are looked at.
const SMALL: f64 = 1e-12;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// Looks at every guard as the mode is entered; an edge to be taken at once is returned.
    #[inline]
    pub(super) fn enter(&mut self, mode: A::Mode, x: &A::State, now: Time) -> Result<Option<A::Edge>, Error> {
        let t = now.seconds();
        for edge in self.automaton.edges(mode).iter() {
            self.memory.stats.guards += 1;
            let g = self.automaton.guard(edge, t, x);
            let trigger = self.memory.trigger(edge);
            match trigger {
                None if g > SMALL * size(x) => continue,
                Some(Trigger::Taken { slack }) if g.abs() <= slack => continue,
                _ => {}
            }
            if self.is_entered(mode, edge, t, x, g, trigger)? {
                self.decide_taken(mode, edge, t, x)?;
                return Ok(Some(edge));
            }
        }
        if self.memory.triggers.len() > 1 {
            self.forget_others(mode);
        }
        Ok(None)
    }

    /// Whether an edge whose guard is neither clear of zero nor just taken is to be taken at once.
    #[inline(never)]
    fn is_entered(
        &mut self,
        mode: A::Mode,
        edge: A::Edge,
        t: f64,
        x: &A::State,
        g: f64,
        trigger: Option<Trigger>,
    ) -> Result<bool, Error> {
        if g.is_nan() {
            return Err(Error::new(ErrorKind::Guard, Place::new(t, mode, Some(edge), x)));
        }
        let noise = self.zero(edge, t, x);
        if g > noise {
            self.memory.arm(edge);
            return Ok(false);
        }
        if g < -noise && g < -self.within(edge, t, x) {
            return match trigger {
                Some(Trigger::Outside { .. }) => Ok(self.waits(edge)),
                // What has drifted while it touched fires once something drives it.
                Some(Trigger::Touches { .. }) => {
                    Ok(matches!(self.first_move(mode, edge, t, x)?, Move::Falls { order: 1 }))
                }
                _ => self.outside(mode, edge, t, x, None),
            };
        }
        let first = self.first_move(mode, edge, t, x)?;
        match first {
            Move::Rises { slope } => {
                self.memory.set(edge, Trigger::Rises { slope, noise });
                Ok(false)
            }
            Move::Stays => {
                self.memory.set(edge, Trigger::Touches { noise });
                Ok(false)
            }
            Move::Falls { order } => match trigger {
                Some(Trigger::Taken { .. } | Trigger::Outside { .. }) if order % 2 == 1 => {
                    self.outside(mode, edge, t, x, Some(noise))
                }
                _ => Ok(true),
            },
        }
    }

    /// An edge that waits for its guard to rise goes on waiting.
    fn waits(&mut self, edge: A::Edge) -> bool {
        self.memory.set(edge, Trigger::Outside { noise: None });
        false
    }

    /// Whether an edge is taken at once whose guard is below zero, or falls on from a zero that was
    /// taken: that is the model's decision.
    pub(super) fn outside(
        &mut self,
        mode: A::Mode,
        edge: A::Edge,
        t: f64,
        x: &A::State,
        noise: Option<f64>,
    ) -> Result<bool, Error> {
        match self.automaton.entry(edge) {
            Entry::Refuse if noise.is_none() => Err(Error::new(ErrorKind::Entry, Place::new(t, mode, Some(edge), x))),
            Entry::Fire if noise.is_none() => Ok(true),
            _ => {
                self.memory.set(edge, Trigger::Outside { noise });
                Ok(false)
            }
        }
    }

    /// Decides what edges that were taken do next, before another one is taken at the same instant:
    /// what that one changes is to be told from what they did.
    #[cold]
    fn decide_taken(&mut self, mode: A::Mode, fires: A::Edge, t: f64, x: &A::State) -> Result<(), Error> {
        for edge in self.automaton.edges(mode).iter().filter(|edge| *edge != fires) {
            if let Some(Trigger::Taken { .. }) = self.memory.trigger(edge) {
                let noise = self.zero(edge, t, x);
                let trigger = match self.first_move(mode, edge, t, x)? {
                    Move::Rises { slope } => Trigger::Rises { slope, noise },
                    Move::Stays | Move::Falls { order: 2 } => Trigger::Touches { noise },
                    Move::Falls { .. } => Trigger::Outside { noise: Some(noise) },
                };
                self.memory.set(edge, trigger);
            }
        }
        Ok(())
    }

    /// Forgets the edges that the mode does not have.
    #[cold]
    fn forget_others(&mut self, mode: A::Mode) {
        let edges = self.automaton.edges(mode);
        self.memory.triggers.retain(|(edge, _)| edges.iter().any(|other| other == *edge));
    }
}

/// The sum of a state's coordinates, all taken as positive.
#[inline]
fn size<S: State>(x: &S) -> f64 {
    (0..x.len()).map(|i| x.get(i).abs()).sum()
}
