//! The systems of the tests, each written once over numbers that carry derivatives.

use saltus::nalgebra::{Vector2, vector};
use saltus::{
    About, Automaton, Clock, Clocks, Coords, Edges, Entry, Fall, Lift, Limit, Linearize, Number, Polynomial, Refusal,
    Solution,
};

/// A ball that bounces on a table at rest or moving as A sin(w t), flying or lying.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounce {
    pub(crate) g: f64,
    pub(crate) e: f64,
    pub(crate) floor: f64,
    pub(crate) amplitude: f64,
    pub(crate) frequency: f64,
    pub(crate) exact: bool,
    /// Whether a formula tells its impacts.
    pub(crate) told: bool,
    pub(crate) lies: bool,
    pub(crate) ends: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Phase {
    Flight,
    Rest,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Floor;

impl Bounce {
    pub(crate) fn new(g: f64, e: f64) -> Self {
        Self { g, e, floor: 0.0, amplitude: 0.0, frequency: 0.0, exact: true, told: false, lies: true, ends: false }
    }
    fn table<D: Number>(&self, t: D) -> D {
        (t * self.frequency).sin() * self.amplitude + self.floor
    }
}

impl Linearize for Bounce {
    type Parameters = [f64; 2];

    fn parameters(&self) -> [f64; 2] {
        [self.g, self.e]
    }
    fn flow_over<D: Number>(&self, mode: Phase, _: D, [_, v]: [D; 2], [g, _]: [D; 2]) -> [D; 2] {
        match mode {
            Phase::Flight => [v, -g],
            Phase::Rest => [D::zero(); 2],
        }
    }
    fn guard_over<D: Number>(&self, _: Floor, t: D, [y, _]: [D; 2], _: [D; 2]) -> D {
        y - self.table(t)
    }
    fn reset_over<D: Number>(&self, _: Floor, t: D, [y, v]: [D; 2], [_, e]: [D; 2]) -> [D; 2] {
        let moving = (t * self.frequency).cos() * (self.amplitude * self.frequency);
        [if self.amplitude > 0.0 { y } else { D::from(self.floor) }, -e * v + (e + 1.0) * moving]
    }
    fn beyond_over<D: Number>(&self, _: Phase, _: D, _: [D; 2], _: [D; 2]) -> Option<[D; 2]> {
        self.lies.then(|| [D::from(self.floor), D::zero()])
    }
    fn exact_over<D: Number>(&self, mode: Phase, _: D, x: [D; 2], [g, _]: [D; 2]) -> Option<Polynomial<[D; 2]>> {
        match mode {
            _ if !self.exact => None,
            Phase::Flight => Some(Polynomial::from([x, [x[1], -g], [g * -0.5, D::zero()]])),
            Phase::Rest => Some(Polynomial::from([x])),
        }
    }
}

impl Automaton for Bounce {
    type Mode = Phase;
    type State = Vector2<f64>;
    type Edge = Floor;

    fn flow(&self, mode: Phase, t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        self.flow_at(mode, t, x)
    }
    fn edges(&self, mode: Phase) -> Edges<'_, Floor> {
        if mode == Phase::Flight { Edges::from([Floor]) } else { Edges::none() }
    }
    fn guard(&self, edge: Floor, t: f64, x: &Vector2<f64>) -> f64 {
        self.guard_at(edge, t, x)
    }
    #[inline]
    fn about(&self, _: Floor) -> About {
        About::new().affine_if(self.amplitude == 0.0).terminal_if(self.ends)
    }
    fn reset(&self, _: Phase, edge: Floor, t: f64, x: &Vector2<f64>) -> Result<(Phase, Vector2<f64>), Refusal> {
        Ok((Phase::Flight, self.reset_at(edge, t, x)))
    }
    fn solution(&self, mode: Phase, t: f64, x: &Vector2<f64>) -> Solution<Self> {
        self.solution_at(mode, t, x)
    }
    fn falls(&self, _: Phase, _: Floor, _: f64, x: &Vector2<f64>) -> Fall<Vector2<f64>> {
        if !self.told {
            return Fall::Unknown;
        }
        let speed = (x[1] * x[1] + 2.0 * self.g * (x[0] - self.floor)).sqrt();
        Fall::In((x[1] + speed) / self.g, vector![self.floor, -speed])
    }
    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(Phase, Vector2<f64>)> {
        let &Limit { mode, t, x, .. } = limit;
        self.beyond_over(mode, t, x.over(), self.parameters()).map(|x| (Phase::Rest, x.into()))
    }
}

/// A ball with quadratic drag, its way up and its way down two smooth modes, on a table that may
/// move as A sin(w t).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Dragged {
    pub(crate) g: f64,
    pub(crate) k: f64,
    pub(crate) e: f64,
    pub(crate) amplitude: f64,
    pub(crate) frequency: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Way {
    Up,
    Down,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Turn {
    Apex,
    Floor,
}

impl Linearize for Dragged {
    type Parameters = [f64; 5];

    fn parameters(&self) -> [f64; 5] {
        [self.g, self.k, self.e, self.amplitude, self.frequency]
    }
    fn flow_over<D: Number>(&self, way: Way, _: D, [_, v]: [D; 2], [g, k, ..]: [D; 5]) -> [D; 2] {
        let drag = k * v * v;
        [v, if way == Way::Up { -g - drag } else { drag - g }]
    }
    fn guard_over<D: Number>(&self, turn: Turn, t: D, [y, v]: [D; 2], [_, _, _, a, w]: [D; 5]) -> D {
        match turn {
            Turn::Apex => v,
            Turn::Floor => y - a * (w * t).sin(),
        }
    }
    fn reset_over<D: Number>(&self, turn: Turn, t: D, [y, v]: [D; 2], [_, _, e, a, w]: [D; 5]) -> [D; 2] {
        match turn {
            Turn::Apex => [y, v],
            Turn::Floor => [y, -e * v + (e + 1.0) * a * w * (w * t).cos()],
        }
    }
}

impl Automaton for Dragged {
    type Mode = Way;
    type State = Vector2<f64>;
    type Edge = Turn;

    fn flow(&self, way: Way, t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        self.flow_at(way, t, x)
    }
    fn edges(&self, way: Way) -> Edges<'_, Turn> {
        match way {
            Way::Up => Edges::from([Turn::Floor, Turn::Apex]),
            Way::Down => Edges::from([Turn::Floor]),
        }
    }
    fn guard(&self, turn: Turn, t: f64, x: &Vector2<f64>) -> f64 {
        self.guard_at(turn, t, x)
    }
    fn reset(&self, _: Way, turn: Turn, t: f64, x: &Vector2<f64>) -> Result<(Way, Vector2<f64>), Refusal> {
        let after: Vector2<f64> = self.reset_at(turn, t, x);
        Ok((if turn == Turn::Floor && after[1] > 0.0 { Way::Up } else { Way::Down }, after))
    }
}

/// One coordinate and jumps at a given time, of several kinds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Coin {
    pub(crate) at: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Side {
    /// x' = 1 until the time, then still.
    Ramp,
    /// x' = x; at the time x + p, then at once squared.
    Grow,
    Grown,
    Squared,
    /// x' = 1; at the time x - 20, from where it is sent on at once.
    Fling,
    Flung,
    Still,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum When {
    Stop,
    Add,
    Square,
    Throw,
    Catch,
}

impl Linearize for Coin {
    type Parameters = [f64; 1];

    fn parameters(&self) -> [f64; 1] {
        [self.at]
    }
    fn flow_over<D: Number>(&self, side: Side, _: D, x: D, _: [D; 1]) -> D {
        match side {
            Side::Ramp | Side::Fling => D::one(),
            Side::Still => D::zero(),
            Side::Flung => D::from(-10.0),
            Side::Grow | Side::Grown | Side::Squared => x,
        }
    }
    fn guard_over<D: Number>(&self, when: When, t: D, x: D, [at]: [D; 1]) -> D {
        if when == When::Catch { x } else { at - t }
    }
    fn reset_over<D: Number>(&self, when: When, _: D, x: D, [at]: [D; 1]) -> D {
        match when {
            When::Stop => x,
            When::Add => x + at,
            When::Square => x * x,
            When::Throw => x - 20.0,
            When::Catch => x * 0.5,
        }
    }
}

impl Automaton for Coin {
    type Mode = Side;
    type State = f64;
    type Edge = When;

    fn flow(&self, side: Side, t: f64, x: &f64) -> f64 {
        self.flow_at(side, t, x)
    }
    fn edges(&self, side: Side) -> Edges<'_, When> {
        match side {
            Side::Ramp => Edges::from([When::Stop]),
            Side::Grow => Edges::from([When::Add]),
            Side::Grown => Edges::from([When::Square]),
            Side::Fling => Edges::from([When::Throw]),
            Side::Flung => Edges::from([When::Catch]),
            Side::Squared | Side::Still => Edges::none(),
        }
    }
    fn guard(&self, when: When, t: f64, x: &f64) -> f64 {
        self.guard_at(when, t, x)
    }
    fn reset(&self, _: Side, when: When, t: f64, x: &f64) -> Result<(Side, f64), Refusal> {
        let to = match when {
            When::Stop | When::Catch => Side::Still,
            When::Add => Side::Grown,
            When::Square => Side::Squared,
            When::Throw => Side::Flung,
        };
        Ok((to, self.reset_over(when, t, *x, self.parameters())))
    }
    #[inline]
    fn about(&self, when: When) -> About {
        About::new().entry(if when == When::Catch { Entry::Fire } else { Entry::Refuse })
    }
}

/// Thrown up under a gravity of 10 m/s², with an edge at the ceiling; its guard to some power.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tossed {
    pub(crate) ceiling: f64,
    pub(crate) power: i32,
}

impl Linearize for Tossed {
    type Parameters = [f64; 0];

    fn parameters(&self) -> [f64; 0] {
        []
    }
    fn flow_over<D: Number>(&self, _: (), _: D, [_, v]: [D; 2], _: [D; 0]) -> [D; 2] {
        [v, D::from(-10.0)]
    }
    fn guard_over<D: Number>(&self, _: (), _: D, [y, _]: [D; 2], _: [D; 0]) -> D {
        (-y + self.ceiling).powi(self.power)
    }
    fn exact_over<D: Number>(&self, _: (), _: D, x: [D; 2], _: [D; 0]) -> Option<Polynomial<[D; 2]>> {
        Some(Polynomial::from([x, [x[1], D::from(-10.0)], [D::from(-5.0), D::zero()]]))
    }
    fn reset_over<D: Number>(&self, _: (), _: D, [y, v]: [D; 2], _: [D; 0]) -> [D; 2] {
        [y, -v]
    }
}

impl Automaton for Tossed {
    type Mode = ();
    type State = Vector2<f64>;
    type Edge = ();

    fn flow(&self, mode: (), t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        self.flow_at(mode, t, x)
    }
    fn edges(&self, _: ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn guard(&self, edge: (), t: f64, x: &Vector2<f64>) -> f64 {
        self.guard_at(edge, t, x)
    }
    fn about(&self, (): ()) -> About {
        About::new().affine_if(self.power == 1)
    }
    fn solution(&self, mode: (), t: f64, x: &Vector2<f64>) -> Solution<Self> {
        self.solution_at(mode, t, x)
    }
    fn reset(&self, (): (), edge: (), t: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
        Ok(((), self.reset_at(edge, t, x)))
    }
}

/// A point that hops on a rigid leg: in flight x, y and their velocities; in stance the foot, the
/// leg's angle and its rate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hopper {
    pub(crate) g: f64,
    pub(crate) leg: f64,
    pub(crate) swing: f64,
    pub(crate) push: f64,
}

impl Default for Hopper {
    fn default() -> Self {
        Self { g: 9.81, leg: 1.0, swing: 0.3, push: 2.0 }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Gait {
    Flight,
    Stance,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    Touchdown,
    Liftoff,
}

impl Linearize for Hopper {
    type Parameters = [f64; 4];

    fn parameters(&self) -> [f64; 4] {
        [self.g, self.leg, self.swing, self.push]
    }
    fn flow_over<D: Number>(&self, gait: Gait, _: D, x: [D; 4], [g, leg, ..]: [D; 4]) -> [D; 4] {
        match gait {
            Gait::Flight => [x[2], x[3], D::zero(), -g],
            Gait::Stance => [D::zero(), x[2], g / leg * x[1].sin(), D::zero()],
        }
    }
    fn guard_over<D: Number>(&self, step: Step, _: D, x: [D; 4], [_, leg, swing, _]: [D; 4]) -> D {
        match step {
            Step::Touchdown => x[1] - leg * swing.cos(),
            Step::Liftoff => swing - x[1],
        }
    }
    fn reset_over<D: Number>(&self, step: Step, _: D, x: [D; 4], [_, leg, swing, push]: [D; 4]) -> [D; 4] {
        match step {
            // The leg stands ahead; the velocity along it is lost.
            Step::Touchdown => {
                let (sin, cos) = (-swing).sin_cos();
                [x[0] - leg * sin, -swing, (x[2] * cos - x[3] * sin) / leg, D::zero()]
            }
            // A push along the leg.
            Step::Liftoff => {
                let (sin, cos) = x[1].sin_cos();
                let speed = x[2] * leg;
                [x[0] + leg * sin, leg * cos, speed * cos + push * sin, push * cos - speed * sin]
            }
        }
    }
}

impl Automaton for Hopper {
    type Mode = Gait;
    type State = Coords<4>;
    type Edge = Step;

    fn flow(&self, gait: Gait, t: f64, x: &Coords<4>) -> Coords<4> {
        self.flow_at(gait, t, x)
    }
    fn edges(&self, gait: Gait) -> Edges<'_, Step> {
        Edges::from([if gait == Gait::Flight { Step::Touchdown } else { Step::Liftoff }])
    }
    fn guard(&self, step: Step, t: f64, x: &Coords<4>) -> f64 {
        self.guard_at(step, t, x)
    }
    fn reset(&self, _: Gait, step: Step, t: f64, x: &Coords<4>) -> Result<(Gait, Coords<4>), Refusal> {
        let after = self.reset_over(step, t, x.over(), self.parameters());
        Ok(match (step, after) {
            (Step::Touchdown, [foot, angle, rate, _]) => (Gait::Stance, [foot, angle, rate].into()),
            (Step::Liftoff, after) => (Gait::Flight, after.into()),
        })
    }
}

/// What decays at `rate` and is raised by `dose` each second, by the clock.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dosed {
    pub(crate) rate: f64,
    pub(crate) dose: f64,
}

impl Linearize for Dosed {
    type Parameters = [f64; 2];

    fn parameters(&self) -> [f64; 2] {
        [self.rate, self.dose]
    }
    fn flow_over<D: Number>(&self, (): (), _t: D, x: D, [rate, _]: [D; 2]) -> D {
        -rate * x
    }
    fn guard_over<D: Number>(&self, (): (), _t: D, _: D, _: [D; 2]) -> D {
        unreachable!("the clock takes the only edge")
    }
    fn reset_over<D: Number>(&self, (): (), _t: D, x: D, [_, dose]: [D; 2]) -> D {
        x + dose
    }
    fn tick_over<D: Number>(&self, (): (), (): (), t: f64, _: [D; 2]) -> Option<D> {
        Some(D::from(t)) // each second, whatever the parameters
    }
}

impl Automaton for Dosed {
    type Mode = ();
    type State = f64;
    type Edge = ();

    fn flow(&self, mode: (), t: f64, x: &f64) -> f64 {
        self.flow_at(mode, t, x)
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::none()
    }
    fn guard(&self, edge: (), t: f64, x: &f64) -> f64 {
        self.guard_at(edge, t, x)
    }
    fn reset(&self, (): (), edge: (), t: f64, x: &f64) -> Result<((), f64), Refusal> {
        Ok(((), self.reset_at(edge, t, x)))
    }
    fn clocks(&self, (): ()) -> Clocks<'_, ()> {
        Clocks::from([(Clock::every(1.0), ())])
    }
}
