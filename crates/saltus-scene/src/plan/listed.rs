//! Models that differ in the number of their coordinates as one automaton, whose states are lists:
//! the engine is compiled once for all of them.

use std::fmt::Debug;

use saltus::{About, Automaton, Clocks, Coords, Edges, Fall, Limit, Refusal, Series, Solution, State};

use super::PlanError;

/// What names a mode or an edge.
pub(super) trait Name: Copy + PartialEq + Debug + Send + Sync + 'static {}
impl<T: Copy + PartialEq + Debug + Send + Sync + 'static> Name for T {}

/// An automaton of a kind: its modes and edges as M and E, which all of that kind have in common.
pub(super) trait Kin<M: Name, E: Name>: Automaton {
    /// The mode as one of the kind, and back.
    fn common(mode: Self::Mode) -> M;
    fn own(mode: M) -> Self::Mode;
    fn own_edge(edge: E) -> Self::Edge;
    /// The edges out of a mode.
    fn edges(&self, mode: M) -> Edges<'_, E>;
    /// The clocks, where there are any.
    fn clocks(&self, mode: M) -> Clocks<'_, E> {
        let _ = mode;
        Clocks::none()
    }
    /// The flow over jets, where it has one.
    fn expand<S: State>(&self, mode: M, series: &mut Series<'_, S>) {
        let _ = (mode, series);
    }
}

/// What an automaton is asked, of states of up to CAP coordinates: all that models of scenes say.
trait Model<M: Name, E: Name, const CAP: usize>: Send + Sync {
    fn flow(&self, mode: M, t: f64, x: &Coords<CAP>) -> Coords<CAP>;
    fn edges(&self, mode: M) -> Edges<'_, E>;
    fn guard(&self, edge: E, t: f64, x: &Coords<CAP>) -> f64;
    fn reset(&self, mode: M, edge: E, t: f64, x: &Coords<CAP>) -> Result<(M, Coords<CAP>), Refusal>;
    fn about(&self, edge: E) -> About;
    fn solution(&self, mode: M, t: f64, x: &Coords<CAP>) -> Solution<Listed<M, E, CAP>>;
    /// By the formula of the mode.
    fn after(&self, mode: M, t: f64, x: &Coords<CAP>, s: f64) -> Coords<CAP>;
    fn expand(&self, mode: M, series: &mut Series<'_, Coords<CAP>>);
    fn falls(&self, mode: M, edge: E, t: f64, x: &Coords<CAP>) -> Fall<Coords<CAP>>;
    fn beyond(&self, limit: &Limit<'_, Listed<M, E, CAP>>) -> Option<(M, Coords<CAP>)>;
    fn clocks(&self, mode: M) -> Clocks<'_, E>;
}

/// A model, chosen as a plan is made, whose states are lists.
pub(super) struct Listed<M, E, const CAP: usize>(Box<dyn Model<M, E, CAP>>);

/// A model with a state of as many coordinates as all of its states have, and the same as a list.
struct Typed<A: Automaton, const CAP: usize> {
    model: A,
    state: A::State,
    list: Coords<CAP>,
}

impl<M: Name, E: Name, const CAP: usize> Listed<M, E, CAP> {
    /// The model with its start.
    ///
    /// # Errors
    /// [`PlanError`] if there are more than CAP coordinates.
    pub(super) fn of<A>(model: A, mode: A::Mode, state: A::State) -> Result<(Self, M, Coords<CAP>), PlanError>
    where
        A: Kin<M, E, State: Send + Sync> + Send + Sync + 'static,
    {
        let values: Vec<f64> = (0..state.len()).map(|i| state.get(i)).collect();
        let list = Coords::try_from(&values[..]);
        let list = list.map_err(|error| PlanError::new("the scene", &error.to_string()))?;
        Ok((Self(Box::new(Typed { model, state, list })), A::common(mode), list))
    }
}

impl<A: Automaton, const CAP: usize> Typed<A, CAP> {
    #[inline]
    fn typed(&self, x: &Coords<CAP>) -> A::State {
        self.state.with(|i| x.get(i))
    }

    #[inline]
    fn list(&self, x: &A::State) -> Coords<CAP> {
        self.list.with(|i| x.get(i))
    }
}

impl<M, E, A, const CAP: usize> Model<M, E, CAP> for Typed<A, CAP>
where
    M: Name,
    E: Name,
    A: Kin<M, E, State: Send + Sync> + Send + Sync,
{
    fn flow(&self, mode: M, t: f64, x: &Coords<CAP>) -> Coords<CAP> {
        self.list(&self.model.flow(A::own(mode), t, &self.typed(x)))
    }
    fn edges(&self, mode: M) -> Edges<'_, E> {
        Kin::edges(&self.model, mode)
    }
    fn guard(&self, edge: E, t: f64, x: &Coords<CAP>) -> f64 {
        self.model.guard(A::own_edge(edge), t, &self.typed(x))
    }
    fn reset(&self, mode: M, edge: E, t: f64, x: &Coords<CAP>) -> Result<(M, Coords<CAP>), Refusal> {
        let (to, after) = self.model.reset(A::own(mode), A::own_edge(edge), t, &self.typed(x))?;
        Ok((A::common(to), self.list(&after)))
    }
    fn about(&self, edge: E) -> About {
        self.model.about(A::own_edge(edge))
    }
    fn solution(&self, mode: M, t: f64, x: &Coords<CAP>) -> Solution<Listed<M, E, CAP>> {
        match self.model.solution(A::own(mode), t, &self.typed(x)) {
            Solution::Sparse(sparsity) => Solution::Sparse(sparsity),
            Solution::Polynomial(polynomial) => match polynomial.coefficients() {
                [a] => Solution::Polynomial([self.list(a)].into()),
                [a, b] => Solution::Polynomial([self.list(a), self.list(b)].into()),
                [a, b, c] => Solution::Polynomial([self.list(a), self.list(b), self.list(c)].into()),
                [a, b, c, d] => Solution::Polynomial([self.list(a), self.list(b), self.list(c), self.list(d)].into()),
                _ => Solution::Steps,
            },
            Solution::Formula(_) => Solution::Formula(|model, mode, t, x, s| model.0.after(mode, t, x, s)),
            Solution::Series(_) => Solution::Series(|model, mode, series| model.0.expand(mode, series)),
            _ => Solution::Steps,
        }
    }
    fn after(&self, mode: M, t: f64, x: &Coords<CAP>, s: f64) -> Coords<CAP> {
        let (mode, x) = (A::own(mode), self.typed(x));
        let after = self.model.solution(mode, t, &x).at(&self.model, mode, t, &x, s);
        self.list(&after.unwrap_or(x))
    }
    fn expand(&self, mode: M, series: &mut Series<'_, Coords<CAP>>) {
        self.model.expand(mode, series);
    }
    fn falls(&self, mode: M, edge: E, t: f64, x: &Coords<CAP>) -> Fall<Coords<CAP>> {
        match self.model.falls(A::own(mode), A::own_edge(edge), t, &self.typed(x)) {
            Fall::Never => Fall::Never,
            Fall::After(s) => Fall::After(s),
            Fall::In(s, x) => Fall::In(s, self.list(&x)),
            _ => Fall::Unknown,
        }
    }
    fn beyond(&self, limit: &Limit<'_, Listed<M, E, CAP>>) -> Option<(M, Coords<CAP>)> {
        let edges: Vec<A::Edge> = limit.edges.iter().map(|&edge| A::own_edge(edge)).collect();
        let x = self.typed(limit.x);
        let (to, after) = self.model.beyond(&Limit::new(A::own(limit.mode), &edges, limit.t, &x))?;
        Some((A::common(to), self.list(&after)))
    }
    fn clocks(&self, mode: M) -> Clocks<'_, E> {
        Kin::clocks(&self.model, mode)
    }
}

impl<M: Name, E: Name, const CAP: usize> Automaton for Listed<M, E, CAP> {
    type Mode = M;
    type State = Coords<CAP>;
    type Edge = E;

    fn flow(&self, mode: M, t: f64, x: &Coords<CAP>) -> Coords<CAP> {
        self.0.flow(mode, t, x)
    }
    fn edges(&self, mode: M) -> Edges<'_, E> {
        self.0.edges(mode)
    }
    fn guard(&self, edge: E, t: f64, x: &Coords<CAP>) -> f64 {
        self.0.guard(edge, t, x)
    }
    fn reset(&self, mode: M, edge: E, t: f64, x: &Coords<CAP>) -> Result<(M, Coords<CAP>), Refusal> {
        self.0.reset(mode, edge, t, x)
    }
    fn about(&self, edge: E) -> About {
        self.0.about(edge)
    }
    fn solution(&self, mode: M, t: f64, x: &Coords<CAP>) -> Solution<Self> {
        self.0.solution(mode, t, x)
    }
    fn falls(&self, mode: M, edge: E, t: f64, x: &Coords<CAP>) -> Fall<Coords<CAP>> {
        self.0.falls(mode, edge, t, x)
    }
    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(M, Coords<CAP>)> {
        self.0.beyond(limit)
    }
    fn clocks(&self, mode: M) -> Clocks<'_, E> {
        self.0.clocks(mode)
    }
}
