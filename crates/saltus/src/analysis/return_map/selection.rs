//! The section that most models need: some coordinates of the state as they are.

use std::fmt::Debug;

use super::{MapError, Section};
use crate::analysis::linearize::{Lift, Linearize, Number, Over};
use crate::state::State;

/// How far a coordinate may be off that the section holds, relative to the largest.
const HELD: f64 = 1e-6;

/// A [`Section`] whose coordinates q are K of the state's own; the others are always those of one
/// given state just after the edge, and a return on which they are not, but for rounding (10⁻⁶ of
/// the largest coordinate), is an error.
///
/// Of a ball that rises from the floor only the velocity is left:
///
/// ```
/// # use saltus::nalgebra::{self, Vector2, vector};
/// # use saltus::{Automaton, Edges, Linearize, Number, Refusal};
/// # struct Ball;
/// # impl Linearize for Ball {
/// #     type Parameters = [f64; 0];
/// #     fn parameters(&self) -> [f64; 0] { [] }
/// #     fn flow_over<D: Number>(&self, _: (), _t: D, [_, v]: [D; 2], _: [D; 0]) -> [D; 2] { [v, D::from(-9.81)] }
/// #     fn guard_over<D: Number>(&self, _: (), _t: D, [y, _]: [D; 2], _: [D; 0]) -> D { y }
/// #     fn reset_over<D: Number>(&self, _: (), _t: D, [_, v]: [D; 2], _: [D; 0]) -> [D; 2] { [D::zero(), -v * 0.5 + 1.0] }
/// # }
/// # impl Automaton for Ball {
/// #     type Mode = ();
/// #     type State = Vector2<f64>;
/// #     type Edge = ();
/// #     fn flow(&self, mode: (), t: f64, x: &Vector2<f64>) -> Vector2<f64> { self.flow_at(mode, t, x) }
/// #     fn edges(&self, _: ()) -> Edges<'_, ()> { Edges::from([()]) }
/// #     fn guard(&self, edge: (), t: f64, x: &Vector2<f64>) -> f64 { self.guard_at(edge, t, x) }
/// #     fn reset(&self, _: (), edge: (), t: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
/// #         Ok(((), self.reset_at(edge, t, x)))
/// #     }
/// # }
/// use saltus::Simulation;
/// use saltus::return_map::{ReturnMap, Selection};
///
/// // `Ball` falls under g and is sent up again at v' = 1 - v/2, by a floor that pushes: v = 2.
/// let rising = Selection::of((), ((), vector![0.0, 0.0]), [1])?;
/// let orbit = ReturnMap::of(Simulation::of(&Ball), rising).fixed_point([1.5])?;
/// assert!((orbit.q[0] - 2.0).abs() < 1e-12 && (orbit.multipliers[0].re - 0.5).abs() < 1e-9);
/// # Ok::<(), saltus::return_map::MapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Selection<M, S, E, const K: usize> {
    edge: E,
    mode: M,
    state: S,
    which: [usize; K],
}

impl<M: Debug, S: State, E, const K: usize> Selection<M, S, E, K> {
    /// The section by `edge` into this mode, with the coordinates `which` of this state just after
    /// it, counted from 0.
    ///
    /// # Errors
    /// [`MapError::Question`] if the state has no such coordinate, or one is named twice.
    pub fn of(edge: E, (mode, state): (M, S), which: [usize; K]) -> Result<Self, MapError> {
        let count = state.len();
        if let Some(beyond) = which.iter().find(|&&i| i >= count) {
            let what = format!("there is no coordinate {beyond}: the state in {mode:?} has {count}, counted from 0");
            return Err(MapError::Question(what));
        }
        if let Some(twice) = (1..K).find(|&k| which[..k].contains(&which[k])) {
            return Err(MapError::Question(format!("coordinate {} is named twice: name each once", which[twice])));
        }
        Ok(Self { edge, mode, state, which })
    }
}

impl<A: Linearize, const K: usize> Section<A, K> for Selection<A::Mode, A::State, A::Edge, K> {
    fn edge(&self) -> A::Edge {
        self.edge
    }
    fn start(&self) -> (A::Mode, A::State) {
        (self.mode, self.state.clone())
    }
    fn place<D: Number>(&self, q: [D; K], _: Over<A::Parameters, D>) -> Over<A::State, D> {
        let chosen = |i: usize| self.which.iter().position(|&which| which == i);
        self.state.lift(|i| chosen(i).map_or_else(|| D::from(self.state.get(i)), |k| q[k]))
    }
    fn flaw(&self, x: &A::State) -> Option<String> {
        let others = || (0..x.len()).filter(|i| !self.which.contains(i));
        let largest = (0..x.len()).map(|i| x.get(i).abs()).fold(0.0, f64::max);
        // Coordinates have units of their own; one that is held at zero, but for errors of those
        // beside it, has no size but theirs.
        let size = |i: usize| {
            let held = self.state.get(i).abs();
            if held > HELD * largest { held } else { largest }
        };
        let moved = others().find(|&i| (x.get(i) - self.state.get(i)).abs() > HELD * size(i));
        moved.map(|i| {
            let (edge, held, came) = (self.edge, self.state.get(i), x.get(i));
            format!("after edge {edge:?} coordinate {i} is {came}, not {held} as the section holds it: give it what the edge leaves, or select it too")
        })
    }
    fn read<D: Number>(&self, _t: D, x: Over<A::State, D>, _: Over<A::Parameters, D>) -> [D; K] {
        self.which.map(|i| self.state.pick(&x, i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_that_are_not_there_are_refused() {
        let of = |which| Selection::of((), ("flight", [1.0, 2.0]), which).map_err(|error| error.to_string());
        assert!(of([0, 1]).is_ok());
        assert_eq!(of([0, 2]).unwrap_err(), "there is no coordinate 2: the state in \"flight\" has 2, counted from 0");
        assert_eq!(of([1, 1]).unwrap_err(), "coordinate 1 is named twice: name each once");
    }
}
