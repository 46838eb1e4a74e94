//! A ball under quadratic drag as a model of one's own: its flow for steppers and, over jets, for
//! series.

use saltus::{About, Automaton, Edges, Refusal, Series, Solution};

/// Height and velocity, in the smooth modes rising and falling or, `whole`, in one with the kink of
/// v|v| at rest.
pub(crate) struct Dragged {
    pub(crate) gravity: f64,
    pub(crate) drag: f64,
    pub(crate) cor: f64,
    pub(crate) whole: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turn {
    Floor,
    Apex,
}

impl Dragged {
    fn series(&self, rising: bool, series: &mut Series<'_, [f64; 2]>) {
        let &Self { gravity, drag, whole, .. } = self;
        if whole {
            series.flow(|_t, [_, v]| [v, -drag * (v * v.abs()) - gravity]);
        } else {
            let drag = if rising { -drag } else { drag };
            series.flow(|_t, [_, v]| [v, drag * (v * v) - gravity]);
        }
    }
}

impl Automaton for Dragged {
    type Mode = bool; // rising?
    type State = [f64; 2];
    type Edge = Turn;

    #[inline]
    fn flow(&self, rising: bool, _t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
        let speed = match (self.whole, rising) {
            (true, _) => v.abs(),
            (_, true) => v,
            (_, false) => -v,
        };
        [v, -self.gravity - self.drag * v * speed]
    }
    #[inline]
    fn solution(&self, _: bool, _t: f64, _x: &[f64; 2]) -> Solution<Self> {
        Solution::Series(Self::series)
    }
    #[inline]
    fn edges(&self, rising: bool) -> Edges<'_, Turn> {
        Edges::from([if rising && !self.whole { Turn::Apex } else { Turn::Floor }])
    }
    #[inline]
    fn guard(&self, turn: Turn, _t: f64, &[y, v]: &[f64; 2]) -> f64 {
        match turn {
            Turn::Floor => y,
            Turn::Apex => v,
        }
    }
    #[inline]
    fn about(&self, _: Turn) -> About {
        About::new().affine()
    }
    #[inline]
    fn reset(&self, _: bool, turn: Turn, _t: f64, &[y, v]: &[f64; 2]) -> Result<(bool, [f64; 2]), Refusal> {
        Ok(match turn {
            Turn::Floor => (true, [0.0, -self.cor * v]),
            Turn::Apex => (false, [y, 0.0]),
        })
    }
}
