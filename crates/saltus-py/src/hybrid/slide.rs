//! Modes that slide along a surface between two others, by the engine's [`Filippov`].

use std::sync::Arc;

use saltus::num_dual::Dual64;
use saltus::{Automaton, Filippov, Lift, Linearize, LinearizeSides, Number, Over, Passage, Side, State, TwoSided};

use super::names::Mode;
use super::tape::Tape;

/// A surface as it is given: the modes above it, below it and along it.
pub(crate) struct SlideOf {
    pub(crate) above: Mode,
    pub(crate) below: Mode,
    pub(crate) sliding: Mode,
    /// Positive above; as it is given, for numbers that carry a derivative by a parameter.
    pub(crate) given: Arc<Tape>,
    /// The same with its parameters bound.
    pub(crate) surface: Tape,
    /// The row a and the constant b of a surface a·x + b = 0.
    pub(crate) affine: Option<(Vec<f64>, f64)>,
}

impl SlideOf {
    /// On which side a mode is.
    pub(crate) fn side(&self, mode: Mode) -> Option<Side> {
        let sides = [(self.above, Side::Above), (self.below, Side::Below), (self.sliding, Side::Sliding)];
        sides.into_iter().find(|(of, _)| *of == mode).map(|(_, side)| side)
    }

    pub(crate) fn mode(&self, side: Side) -> Mode {
        match side {
            Side::Above => self.above,
            Side::Below => self.below,
            Side::Sliding => self.sliding,
        }
    }

    /// The edges that lead out of a side, and to where as a rule.
    pub(crate) fn passages(&self, side: Side) -> Vec<(Passage, Mode)> {
        let (above, below, sliding) = (self.above, self.below, self.sliding);
        match side {
            Side::Above => vec![(Passage::FromAbove, sliding)],
            Side::Below => vec![(Passage::FromBelow, sliding)],
            // In the order in which they are taken where several are due.
            Side::Sliding => vec![
                (Passage::Undecided, sliding),
                (Passage::LeaveAbove, above),
                (Passage::LeaveBelow, below),
                (Passage::Unpushed, sliding),
            ],
        }
    }

    /// The guard of a passage as a row and a constant, where the surface is affine.
    pub(crate) fn guard(&self, passage: Passage) -> Option<(Vec<f64>, f64)> {
        let by = match passage {
            Passage::FromAbove => 1.0,
            Passage::FromBelow => -1.0,
            _ => return None,
        };
        self.affine.as_ref().map(|(row, rest)| (row.iter().map(|a| by * a).collect(), by * rest))
    }
}

/// The flows of two modes of `of` on the two sides of a surface.
pub(crate) struct Pair<'a, A: Automaton> {
    slide: &'a SlideOf,
    of: &'a A,
    /// A state of its dimension.
    like: &'a A::State,
}

impl<'a, A: Linearize<Mode = Mode>> Pair<'a, A> {
    pub(crate) fn of(slide: &'a SlideOf, of: &'a A, like: &'a A::State) -> Filippov<Self> {
        Filippov::of(Self { slide, of, like })
    }

    /// How the surface depends on a coordinate, or on time.
    fn slope(&self, t: f64, x: &A::State, by: Option<usize>) -> f64 {
        let number = |value: f64, of: Option<usize>| Dual64::new(value, if of == by { 1.0 } else { 0.0 });
        let mut slope = f64::NAN;
        let (t, x) = (number(t, None), |i: usize| number(x.get(i), Some(i)));
        self.slide.surface.run(t, x, |_| Dual64::from(f64::NAN), |_, value: Dual64| slope = value.eps);
        slope
    }
}

impl<A: Linearize<Mode = Mode>> TwoSided for Pair<'_, A> {
    type State = A::State;

    fn above(&self, t: f64, x: &A::State) -> A::State {
        self.of.flow(self.slide.above, t, x)
    }

    fn below(&self, t: f64, x: &A::State) -> A::State {
        self.of.flow(self.slide.below, t, x)
    }

    fn surface(&self, t: f64, x: &A::State) -> f64 {
        let mut value = f64::NAN;
        self.slide.surface.run(t, |i| x.get(i), |_| f64::NAN, |_, surface| value = surface);
        value
    }

    fn normal(&self, t: f64, x: &A::State) -> A::State {
        x.with(|i| self.slope(t, x, Some(i)))
    }

    fn surface_rate(&self, t: f64, x: &A::State) -> f64 {
        self.slope(t, x, None)
    }

    fn affine(&self) -> bool {
        self.slide.affine.is_some()
    }
}

impl<A: Linearize<Mode = Mode>> LinearizeSides for Pair<'_, A> {
    type Parameters = A::Parameters;

    fn parameters(&self) -> A::Parameters {
        self.of.parameters()
    }

    fn shape(&self) -> A::State {
        self.like.clone()
    }

    fn above_over<D: Number>(&self, t: D, x: Over<A::State, D>, p: Over<A::Parameters, D>) -> Over<A::State, D> {
        self.of.flow_over(self.slide.above, t, x, p)
    }

    fn below_over<D: Number>(&self, t: D, x: Over<A::State, D>, p: Over<A::Parameters, D>) -> Over<A::State, D> {
        self.of.flow_over(self.slide.below, t, x, p)
    }

    fn surface_over<D: Number>(&self, t: D, x: Over<A::State, D>, p: Over<A::Parameters, D>) -> D {
        let (mut value, like, given) = (D::from(f64::NAN), self.like, self.parameters());
        self.slide.given.run(t, |i| like.pick(&x, i), |i| given.pick(&p, i), |_, surface| value = surface);
        value
    }
}
