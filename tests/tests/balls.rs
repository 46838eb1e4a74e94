//! Vertical balls, their flight and restitution composed by type: costs, laws.

use saltus::nalgebra::{Vector2, vector};
use saltus::{About, Automaton, Edges, Fall, Jump, Limit, Refusal, Run, Simulation, Solution, State, Stats};
use saltus_bounce::flight::{LinearDragFlight, QuadraticDragFlight, VacuumFlight};
use saltus_bounce::restitution::{Knots, Linear, Plastic, Viscoelastic};
use saltus_bounce::{Ball, Cor, Floor, Mode, Phase, Restitution, Turn};

fn cor(e: f64) -> Cor {
    Cor::new(e).unwrap()
}

/// The jumps by which the ball meets the floor.
fn impacts<M: Copy, E: Copy + PartialEq, S: State>(run: &Run<M, E, S>, floor: E) -> Vec<Jump<M, E, S>> {
    run.trajectory.jumps().iter().filter(|jump| jump.edge() == Some(floor)).cloned().collect()
}

/// The bounces of every flight under every restitution come to rest where the flights' own formulas
/// say, and cost no step.
#[test]
fn every_flight_rests() {
    for e in [0.0, 0.01, 0.3, 0.5, 0.77, 0.8, 0.9, 0.95, 0.99] {
        for drag in [0.0, 1e-12, 1e-3, 0.1, 10.0, 1e4] {
            let quadratic = QuadraticDragFlight::new(9.81, drag).unwrap();
            let ball = Ball::of(quadratic, cor(e));
            let run = Simulation::of(&ball).run(Phase::Falling, vector![2.0, 0.0], 0.0..1e4).unwrap();
            assert_eq!((run.end.mode, run.end.stats.steps), (Phase::Rest, 0), "e = {e}, drag {drag}");
            let expected = limit(&quadratic, e, 2.0);
            let got = run.trajectory.jumps().last().unwrap().t();
            assert!(
                (got / expected - 1.0).abs() < 1e-13,
                "quadratic, e = {e}, drag {drag}: {got} instead of {expected}"
            );

            let linear = LinearDragFlight::new(9.81, drag).unwrap();
            let ball = Ball::of(linear, cor(e));
            let run = Simulation::of(&ball).run(Mode::Flight, vector![2.0, 0.0], 0.0..1e6).unwrap();
            let expected = limit(&linear, e, 2.0);
            let got = run.trajectory.jumps().last().unwrap().t();
            assert_eq!((run.end.mode, run.end.stats.steps), (Mode::Rest, 0), "e = {e}, drag {drag}");
            assert!((got / expected - 1.0).abs() < 1e-13, "linear, e = {e}, drag {drag}: {got} instead of {expected}");
        }
    }
}

/// The sum of all flights.
fn limit(flight: &impl saltus_bounce::flight::VerticalFlight, e: f64, height: f64) -> f64 {
    let mut impact = flight.impact(&vector![height, 0.0]).unwrap();
    let mut t = impact.time;
    while impact.speed > 1e-18 {
        let Some(next) = flight.impact(&vector![0.0, e * impact.speed]) else { break };
        t += next.time;
        impact = next;
    }
    t
}

#[test]
fn no_rebound_rests_at_once() {
    let ball = Ball::of(QuadraticDragFlight::new(9.81, 0.1).unwrap(), cor(0.0));
    let run = Simulation::of(&ball).run(Phase::Falling, vector![2.0, 0.0], 0.0..9.0).unwrap();
    assert_eq!((run.end.mode, run.trajectory.jumps().len()), (Phase::Rest, 1));
    let ball = Ball::of(LinearDragFlight::new(9.81, 0.1).unwrap(), cor(0.0));
    let run = Simulation::of(&ball).run(Mode::Flight, vector![0.0, 3.0], 0.0..9.0).unwrap();
    assert_eq!((run.end.mode, run.trajectory.jumps().len()), (Mode::Rest, 1));
}

/// A start on the floor, below it by a rounding, in the wrong phase, and thrown up.
#[test]
fn starts() {
    let ball = Ball::of(QuadraticDragFlight::new(9.81, 0.1).unwrap(), cor(0.5));
    let run = |phase, x| Simulation::of(&ball).run(phase, x, 0.0..30.0).unwrap();
    assert_eq!(run(Phase::Falling, vector![0.0, 0.0]).end.mode, Phase::Rest);
    assert_eq!(run(Phase::Falling, vector![-1e-18, 0.0]).end.mode, Phase::Rest);
    let wrong = impacts(&run(Phase::Rising, vector![2.0, -1.0]), Turn::Floor)[0].t();
    assert_eq!(wrong, impacts(&run(Phase::Falling, vector![2.0, -1.0]), Turn::Floor)[0].t());
    let thrown = impacts(&run(Phase::Rising, vector![0.0, 9.0]), Turn::Floor)[0].t();
    let called_falling = impacts(&run(Phase::Falling, vector![0.0, 9.0]), Turn::Floor)[0].t();
    assert!((thrown - called_falling).abs() < 1e-15 && thrown > 1.0);
    let below = Simulation::of(&ball).run(Phase::Falling, vector![-0.5, 0.0], 0.0..1.0);
    assert!(below.is_err());
}

/// Laws that depend on the speed are asked at each impact, and each impact obeys them.
#[test]
fn restitution_that_depends_on_the_speed() {
    fn check<R: Restitution>(law: R, rests: bool) {
        let ball = Ball::of(VacuumFlight::new(9.81).unwrap(), &law);
        let run = Simulation::of(&ball).most_jumps(200_000).run(Mode::Flight, vector![3.0, 0.0], 0.0..200.0).unwrap();
        assert!(run.trajectory.jumps().len() > 3);
        for jump in impacts(&run, Floor) {
            assert_eq!(jump.after[1], law.rebound((-jump.before[1]).max(0.0)));
        }
        assert_eq!(run.end.mode == Mode::Rest, rests);
    }
    check(Linear::new(cor(0.8), -0.02, 0.0, 10.0).unwrap(), true);
    check(Knots::new(&[(0.5, cor(0.9)), (5.0, cor(0.6))]).unwrap(), true);
    check(Plastic::new(0.5).unwrap(), false); // below the yield speed nothing is lost
    check(Viscoelastic::new(0.01, 1e6, 0.1).unwrap(), true);
}

/// The ball of gravity and a constant COR, written out.
struct Plain {
    g: f64,
    e: f64,
}

impl Automaton for Plain {
    type Mode = Mode;
    type State = Vector2<f64>;
    type Edge = Floor;

    fn flow(&self, mode: Mode, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        if mode == Mode::Rest { vector![0.0, 0.0] } else { vector![x[1], -self.g] }
    }
    fn edges(&self, mode: Mode) -> Edges<'_, Floor> {
        if mode == Mode::Rest { Edges::none() } else { Edges::from([Floor]) }
    }
    fn guard(&self, Floor: Floor, _t: f64, x: &Vector2<f64>) -> f64 {
        x[0]
    }
    #[inline]
    fn about(&self, Floor: Floor) -> About {
        About::new().affine()
    }
    fn reset(&self, _: Mode, Floor: Floor, _t: f64, x: &Vector2<f64>) -> Result<(Mode, Vector2<f64>), Refusal> {
        let rebound = -self.e * x[1];
        Ok((if rebound > 0.0 { Mode::Flight } else { Mode::Rest }, vector![0.0, rebound.max(0.0)]))
    }
    fn solution(&self, mode: Mode, _t: f64, x: &Vector2<f64>) -> Solution<Self> {
        Solution::Polynomial(match mode {
            Mode::Flight => [*x, vector![x[1], -self.g], vector![-0.5 * self.g, 0.0]].into(),
            Mode::Rest => [*x].into(),
        })
    }
    fn falls(&self, _: Mode, Floor: Floor, _t: f64, x: &Vector2<f64>) -> Fall<Vector2<f64>> {
        let speed = if x[0] == 0.0 { x[1] } else { (x[1] * x[1] + 2.0 * self.g * x[0]).sqrt() };
        let time = if x[1] > 0.0 { (x[1] + speed) / self.g } else { 2.0 * x[0] / (speed - x[1]) };
        Fall::In(time, vector![0.0, -speed])
    }
    fn beyond(&self, _: &Limit<'_, Self>) -> Option<(Mode, Vector2<f64>)> {
        Some((Mode::Rest, vector![0.0, 0.0]))
    }
}

/// An effect that is not named costs nothing: the same bits and the same counts as a ball that
/// could have none.
#[test]
fn what_is_not_named_costs_nothing() {
    for e in [0.0, 0.5, 0.9, 0.99] {
        let (ball, plain) = (Ball::new(9.8, cor(e)).unwrap(), Plain { g: 9.8, e });
        let run = Simulation::of(&ball).run(Mode::Flight, vector![1.0, 0.5], 0.0..200.0).unwrap();
        let other = Simulation::of(&plain).run(Mode::Flight, vector![1.0, 0.5], 0.0..200.0).unwrap();
        assert_eq!(run.end.stats, other.end.stats);
        for (a, b) in run.trajectory.jumps().iter().zip(other.trajectory.jumps()) {
            assert_eq!((a.time, a.before, a.after), (b.time, b.before, b.after));
        }
        assert_eq!(size_of_val(&run.end.state), 16, "two coordinates");
    }
    // The counts of e = 0.5, as they were before there was anything else to name.
    let run =
        Simulation::of(&Ball::new(9.8, cor(0.5)).unwrap()).run(Mode::Flight, vector![1.0, 0.0], 0.0..4.0).unwrap();
    assert_eq!((run.end.stats.flows, run.end.stats.steps, run.end.stats.exact), (0, 0, 53));
    let Stats { jumps, steps, rejected, exact, flows, jacobians, .. } = run.end.stats;
    assert_eq!((jumps, exact, steps, rejected, flows, jacobians), (53, 53, 0, 0, 0, 0));
}

/// A floor elsewhere changes no bit of a run, only where the ball is.
#[test]
fn a_floor_at_any_height() {
    let ball = Ball::new(9.81, cor(0.9)).unwrap();
    let high = ball.with_floor(8848.86).unwrap();
    let [a, b] = [ball, high].map(|ball| Simulation::of(&ball).run(Mode::Flight, vector![1.0, 0.0], 0.0..9.0).unwrap());
    assert_eq!(a.end.stats, b.end.stats);
    assert!(a.trajectory.jumps().iter().zip(b.trajectory.jumps()).all(|(a, b)| a.time == b.time && a.after == b.after));
    assert_eq!((high.height(&b.end.state), high.floor()), (8848.86, 8848.86));
    assert!(ball.with_floor(f64::NAN).is_err());
}
