//! The flock as a hybrid automaton: what each ball would do alone, and the meetings of two.

use nalgebra::Vector3;
use saltus::{About, Automaton, Clocks, Edges, Fall, Limit, Refusal, Solution, State, Ticking};

use super::{CHANGE, Flock, Flying, Happens, Meeting, Stances};
use crate::cloud::meeting_of_balls;
use crate::effects::Effect;
use crate::flyer::{Event, Grip, OF_CONTACT, Stance};
use crate::restitution::Restitution;
use crate::walls::Walls;

impl<const N: usize, E, W, R, G, C> Flock<N, E, W, R, G, C>
where
    E: Effect<3, Vector3<f64>>,
    W: Walls<3>,
    R: Restitution,
    G: Grip<3, Vector3<f64>>,
    C: Restitution,
{
    /// The state a time `s` later, where each ball has a solution.
    fn flown(&self, stances: Stances<N>, t: f64, x: &Flying<N>, s: f64) -> Flying<N> {
        x.map(|ball| {
            let (flyer, stance, x) = (&self.balls.get(ball)?.1, stances.of(ball), x.ball(ball));
            flyer.solution(stance, t, &x).at(flyer, stance, t, &x, s)
        })
        .unwrap_or(*x)
    }
}

impl<const N: usize, E, W, R, G, C> Automaton for Flock<N, E, W, R, G, C>
where
    E: Effect<3, Vector3<f64>>,
    W: Walls<3>,
    R: Restitution,
    G: Grip<3, Vector3<f64>>,
    C: Restitution,
{
    type Mode = Stances<N>;
    type State = Flying<N>;
    type Edge = Meeting;

    #[inline(never)] // much code, called for each stage of each stepper
    fn flow(&self, stances: Stances<N>, t: f64, x: &Flying<N>) -> Flying<N> {
        x.map(|ball| Some(self.balls.get(ball)?.1.flow(stances.of(ball), t, &x.ball(ball)))).unwrap_or(*x)
    }

    fn edges(&self, stances: Stances<N>) -> Edges<'_, Meeting> {
        Edges::indexed(self.count(&stances), Meeting)
    }

    #[inline(never)]
    fn guard(&self, meeting: Meeting, t: f64, x: &Flying<N>) -> f64 {
        match self.happens(meeting, &x.stances()) {
            Happens::Balls(i, j) => self.gap(i, j, t, x),
            Happens::To(ball, event) => self.balls[ball].1.guard(event, t, &x.ball(ball)),
            Happens::Change | Happens::Nothing => 1.0,
        }
    }

    #[inline]
    fn about(&self, meeting: Meeting) -> About {
        // Where a ball touches a face, that guard is a constant.
        let affine = match self.happens(meeting, &Stances::FLIGHT) {
            Happens::To(ball, Event::Meet(face)) => {
                let walls = self.balls[ball].1.walls();
                walls.cells() == 1 && walls.straight(face)
            }
            _ => false,
        };
        let about = About::new().affine_if(affine);
        if self.is_meeting(meeting) { about } else { about.entry(OF_CONTACT) }
    }

    fn reset(
        &self,
        stances: Stances<N>,
        meeting: Meeting,
        t: f64,
        x: &Flying<N>,
    ) -> Result<(Stances<N>, Flying<N>), Refusal> {
        let x = x.doing(stances);
        let after = match self.happens(meeting, &stances) {
            Happens::Balls(i, j) => self.collided(i, j, &self.restitution, t, &x),
            Happens::To(ball, event) => {
                let (flyer, moving) = (&self.balls[ball].1, x.ball(ball));
                let (stance, moving) = flyer.reset(stances.of(ball), event, t, &moving)?;
                let mut after = x;
                after.put(ball, stance, moving);
                after
            }
            Happens::Change => {
                let mut after = x;
                for (ball, (_, flyer)) in self.balls.iter().enumerate() {
                    let (stance, moving) = flyer.reset(stances.of(ball), Event::Change, t, &x.ball(ball))?;
                    after.put(ball, stance, moving);
                }
                after
            }
            Happens::Nothing => x,
        };
        Ok((after.stances(), after))
    }

    fn solution(&self, stances: Stances<N>, t: f64, x: &Flying<N>) -> Solution<Self> {
        let mut parts = [x.with(|_| 0.0); 3];
        let (mut polynomial, mut exact) = (true, true);
        for (ball, (_, flyer)) in self.balls.iter().enumerate() {
            let stance = stances.of(ball);
            let solution = flyer.solution(stance, t, &x.ball(ball));
            match &solution {
                Solution::Polynomial(own) => {
                    for (part, c) in parts.iter_mut().zip(own.coefficients()) {
                        part.put(ball, stance, *c);
                    }
                }
                other => (polynomial, exact) = (false, exact && other.is_exact()),
            }
        }
        match (polynomial, exact) {
            (true, _) => Solution::Polynomial(parts.into()),
            (_, true) => Solution::Formula(Self::flown),
            _ => Solution::Steps,
        }
    }

    fn falls(&self, stances: Stances<N>, meeting: Meeting, t: f64, x: &Flying<N>) -> Fall<Flying<N>> {
        let Happens::Balls(i, j) = self.happens(meeting, &stances) else { return Fall::Unknown };
        let pull = |ball: usize| {
            let (flyer, stance) = (&self.balls[ball].1, stances.of(ball));
            let uniform = Effect::<3, Vector3<f64>>::uniform(flyer.effects());
            let straight = uniform && matches!(stance, Stance::Flight { .. });
            straight.then(|| flyer.flow(stance, t, &x.ball(ball)).velocity)
        };
        match (pull(i), pull(j)) {
            (Some(a), Some(b)) if a == b => {
                let (between, change) = self.apart(i, j, t, x);
                let meeting = meeting_of_balls(between.into(), change.into(), self.reach(i, j));
                meeting.map_or(Fall::Never, Fall::After)
            }
            _ => Fall::Unknown,
        }
    }

    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(Stances<N>, Flying<N>)> {
        let after = self.accumulated(limit.t, &limit.x.doing(limit.mode))?;
        Some((after.stances(), after))
    }

    fn clocks(&self, _: Stances<N>) -> Clocks<'_, Meeting> {
        let changing = self.after(f64::NEG_INFINITY).is_some();
        if changing { Clocks::asked(self, CHANGE) } else { Clocks::none() }
    }
}

/// The changes of the walls' motions.
impl<const N: usize, E, W, R, G, C> Ticking for Flock<N, E, W, R, G, C>
where
    E: Effect<3, Vector3<f64>>,
    W: Walls<3>,
    R: Restitution,
    G: Grip<3, Vector3<f64>>,
    C: Restitution,
{
    fn after(&self, t: f64) -> Option<f64> {
        let changes = self.balls.iter().filter_map(|(_, flyer)| flyer.walls().changes(t));
        changes.min_by(f64::total_cmp)
    }
}
