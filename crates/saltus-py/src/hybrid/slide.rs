//! Modes that slide along a surface between two others, by the engine's [`Filippov`].

use std::marker::PhantomData;

use saltus::num_dual::Dual64;
use saltus::{Filippov, Passage, Side, State, TwoSided};

use super::names::Mode;
use super::tape::Tape;

/// A surface as it is given: the modes above it, below it and along it.
pub(crate) struct SlideOf {
    pub(crate) above: Mode,
    pub(crate) below: Mode,
    pub(crate) sliding: Mode,
    /// Positive above; with its parameters bound.
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

/// The flows of two modes on the two sides of a surface.
pub(crate) struct Pair<'a, S, F> {
    slide: &'a SlideOf,
    flow: F,
    state: PhantomData<fn(&S)>,
}

impl<'a, S: State, F: Fn(Mode, f64, &S) -> S> Pair<'a, S, F> {
    pub(crate) fn of(slide: &'a SlideOf, flow: F) -> Filippov<Self> {
        Filippov::of(Self { slide, flow, state: PhantomData })
    }

    /// How the surface depends on a coordinate, or on time.
    fn slope(&self, t: f64, x: &S, by: Option<usize>) -> f64 {
        let number = |value: f64, of: Option<usize>| Dual64::new(value, if of == by { 1.0 } else { 0.0 });
        let mut slope = f64::NAN;
        let (t, x) = (number(t, None), |i: usize| number(x.get(i), Some(i)));
        self.slide.surface.run(t, x, |_| Dual64::from(f64::NAN), |_, value: Dual64| slope = value.eps);
        slope
    }
}

impl<S: State, F: Fn(Mode, f64, &S) -> S> TwoSided for Pair<'_, S, F> {
    type State = S;

    fn above(&self, t: f64, x: &S) -> S {
        (self.flow)(self.slide.above, t, x)
    }

    fn below(&self, t: f64, x: &S) -> S {
        (self.flow)(self.slide.below, t, x)
    }

    fn surface(&self, t: f64, x: &S) -> f64 {
        let mut value = f64::NAN;
        self.slide.surface.run(t, |i| x.get(i), |_| f64::NAN, |_, surface| value = surface);
        value
    }

    fn normal(&self, t: f64, x: &S) -> S {
        x.with(|i| self.slope(t, x, Some(i)))
    }

    fn surface_rate(&self, t: f64, x: &S) -> f64 {
        self.slope(t, x, None)
    }

    fn affine(&self) -> bool {
        self.slide.affine.is_some()
    }
}
