//! Moments of a run too long to be recorded.

use std::ops::ControlFlow;

use saltus::{Automaton, JumpOf, Observer, Piece, Time};

/// Keeps the jumps of certain numbers and the states at certain times, and looks at each jump.
pub(crate) struct Samples<'a, A: Automaton, F> {
    numbers: &'a [usize],
    times: &'a [f64],
    look: F,
    jumps: Vec<JumpOf<A>>,
    /// The state at each time, and how many jumps came before it.
    states: Vec<(A::State, usize)>,
    count: usize,
}

impl<'a, A: Automaton, F: FnMut(&JumpOf<A>)> Samples<'a, A, F> {
    /// Of the jumps of these numbers and the states at these times, both rising.
    pub(crate) fn new(numbers: &'a [usize], times: &'a [f64], look: F) -> Self {
        Self { numbers, times, look, jumps: Vec::new(), states: Vec::new(), count: 0 }
    }

    /// The jump of this number.
    pub(crate) fn jump(&self, number: usize) -> &JumpOf<A> {
        self.jumps.iter().find(|jump| jump.j == number).unwrap()
    }

    /// The state at the time of this place, and how many jumps came before it.
    pub(crate) fn state(&self, place: usize) -> (A::State, usize) {
        self.states[place].clone()
    }
}

impl<A: Automaton, F: FnMut(&JumpOf<A>)> Observer<A> for Samples<'_, A, F> {
    fn wants_pieces(&self) -> bool {
        self.states.len() < self.times.len()
    }
    fn piece(&mut self, _: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        while let Some(&t) = self.times.get(self.states.len()) {
            let s = Time::new(t).since(piece.start());
            if s >= piece.span() {
                break;
            }
            self.states.push((piece.at(s), self.count));
        }
        ControlFlow::Continue(())
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        self.count = jump.j;
        if self.numbers.get(self.jumps.len()) == Some(&jump.j) {
            self.jumps.push(jump.clone());
        }
        (self.look)(jump);
        ControlFlow::Continue(())
    }
}
