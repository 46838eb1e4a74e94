//! The outcome of a run whose motion is not kept.

use std::ops::ControlFlow;

use saltus::{Automaton, EndingOf, JumpOf, Observer, Piece};

use super::record::{Apex, Cost, End, Moment, Record, Tops};
use super::view::{SceneView, impact, moment, segment};

/// The outcome of a run: the results that a table of many runs has of each.
///
/// ```
/// use saltus_scene::Scene;
/// let scene = Scene::parse("drop.toml", b"restitution = 0.5\nball = { height = '1 m' }\nrun = { until = '4 s' }\n")?;
/// let outcome = scene.plan()?.outcome()?;
/// let fall = (2.0 / 9.80665_f64).sqrt();
/// assert!((outcome.first_impact.unwrap() - fall).abs() < 1e-15 && (outcome.rest.unwrap() - 3.0 * fall).abs() < 1e-12);
/// assert!((outcome.first_apex.unwrap().height - 0.25).abs() < 1e-15);
/// assert_eq!((outcome.until, outcome.balls[0].height()), (4.0, 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The number of impacts.
    pub impacts: usize,
    /// The time of the first impact, in s.
    pub first_impact: Option<f64>,
    /// The time of the last impact, in s.
    pub last_impact: Option<f64>,
    /// The first apex of the first ball after its first impact.
    pub first_apex: Option<Apex>,
    /// The time from which everything is at rest, in s, if it is.
    pub rest: Option<f64>,
    /// The reason of the end.
    pub end: End,
    /// The time reached, in s.
    pub until: f64,
    /// Each ball at the end.
    pub balls: Vec<Moment>,
    /// The cost of the run.
    pub cost: Cost,
}

impl Outcome {
    /// The outcome of a recorded run.
    #[must_use]
    pub fn of(record: &Record) -> Self {
        let impacts = record.impacts();
        let first = impacts.iter().find(|impact| impact.ball == 0);
        Self {
            impacts: impacts.len(),
            first_impact: impacts.first().map(|impact| impact.t),
            last_impact: impacts.last().map(|impact| impact.t),
            first_apex: first.and_then(|first| record.apexes(0).into_iter().find(|apex| apex.t > first.t)),
            rest: record.rest(),
            end: record.end(),
            until: record.until(),
            balls: (0..record.balls()).filter_map(|ball| record.at(ball, record.until())).collect(),
            cost: record.cost(),
        }
    }
}

/// Counts impacts as they come, and looks at the motion only from the first one to the apex after
/// it.
pub(super) struct OutcomeObserver<'a, A: Automaton, R> {
    automaton: &'a A,
    view: &'a R,
    impacts: usize,
    first: Option<f64>,
    last: Option<f64>,
    tops: Option<Tops>,
    apex: Option<Apex>,
    /// The time, the mode and the state after the last jump.
    pub(super) left: Option<(f64, A::Mode, A::State)>,
}

impl<'a, A: Automaton, R: SceneView<A>> OutcomeObserver<'a, A, R> {
    pub(super) const fn new(automaton: &'a A, view: &'a R) -> Self {
        Self { automaton, view, impacts: 0, first: None, last: None, tops: None, apex: None, left: None }
    }

    /// The time of the last jump.
    pub(super) fn last_jump(&self) -> f64 {
        self.left.as_ref().map_or(0.0, |(t, ..)| *t)
    }

    /// The outcome of a run that ends at `until` in `state`.
    pub(super) fn outcome(
        self,
        ending: &EndingOf<A>,
        end: End,
        until: f64,
        state: &A::State,
        rest: Option<f64>,
    ) -> Outcome {
        Outcome {
            impacts: self.impacts,
            first_impact: self.first,
            last_impact: self.last,
            first_apex: self.apex,
            rest,
            end,
            until,
            balls: (0..self.view.balls()).map(|ball| moment(self.view, state, ball)).collect(),
            cost: ending.stats.into(),
        }
    }
}

impl<A: Automaton, R: SceneView<A>> Observer<A> for OutcomeObserver<'_, A, R> {
    fn wants_pieces(&self) -> bool {
        self.tops.is_some() && self.view.apex_jump().is_none()
    }

    fn piece(&mut self, mode: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        if let Some(tops) = &mut self.tops {
            self.apex = tops.next(&segment(self.view, mode, piece, 0));
            if self.apex.is_some() {
                self.tops = None;
            }
        }
        ControlFlow::Continue(())
    }

    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        if self.view.apex_jump() == Some((jump.from, jump.to)) {
            if self.tops.take().is_some() {
                let height = moment(self.view, &jump.before, 0).height();
                self.apex = Some(Apex { t: jump.t(), height });
            }
        } else if let Some(impact) = impact(self.automaton, self.view, jump) {
            self.impacts += 1;
            self.first.get_or_insert(impact.t);
            self.last = Some(impact.t);
            if impact.ball == 0 && self.apex.is_none() && self.tops.is_none() {
                self.tops = Some(Tops::default());
            }
        }
        self.left = Some((jump.t(), jump.to, jump.after.clone()));
        ControlFlow::Continue(())
    }
}
