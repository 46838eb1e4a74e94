//! saltus, by its public interface.

use std::ops::ControlFlow;

use saltus::step::Stepper;
use saltus::{About, Automaton, Edges, JumpOf, Observer, Refusal, Rodas5P, Series, Simulation, Solution};
use saltus_bounce::flight::QuadraticDragFlight;
use saltus_bounce::{Cor, Mode, Phase};

use super::contest::{Entry, Events, Log, Solve};
use super::problems::{self, CROSSINGS, DRAG, VACUUM, arenstorf, van_der_pol};

const SOLVER: &str = "saltus";
/// The method that is no stepper.
pub const SERIES: &str = "Taylor series";

/// Keeps the times of the jumps by one edge.
struct Times<'a, E> {
    log: &'a mut Vec<f64>,
    edge: E,
}

impl<A: Automaton> Observer<A> for Times<'_, A::Edge> {
    fn wants_pieces(&self) -> bool {
        false
    }
    #[inline]
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        if jump.edge() == Some(self.edge) {
            self.log.push(jump.t());
        }
        ControlFlow::Continue(())
    }
}

/// The ball as it comes: its parabola is known.
pub fn vacuum_ball() -> Entry {
    let ball = saltus_bounce::Ball::new(VACUUM.gravity, Cor::new(VACUUM.cor).unwrap()).unwrap();
    Entry::exact(SOLVER, "Ball, exact arcs", move |log: &mut Log| {
        let start = saltus_bounce::Ball::dropped_from(VACUUM.height);
        let mut times = Times { log: &mut log.marks, edge: saltus_bounce::Floor };
        let run = Simulation::of(&ball).most_jumps(VACUUM.impacts);
        run.drive(Mode::Flight, start, 0.0..100.0, &mut times).unwrap();
    })
}

/// The ball as it comes: its flight under quadratic drag is a formula.
pub fn drag_ball() -> Entry {
    let flight = QuadraticDragFlight::new(DRAG.gravity, DRAG.drag).unwrap();
    let ball = saltus_bounce::Ball::of(flight, Cor::new(DRAG.cor).unwrap());
    Entry::exact(SOLVER, "Ball, closed form", move |log: &mut Log| {
        let start = saltus_bounce::Ball::dropped_from(DRAG.height);
        let mut times = Times { log: &mut log.marks, edge: saltus_bounce::Turn::Floor };
        let run = Simulation::of(&ball).most_jumps(2 * DRAG.impacts - 1);
        run.drive(Phase::Falling, start, 0.0..100.0, &mut times).unwrap();
    })
}

/// A ball whose formula nobody knows, in two smooth modes: rising or not.
pub struct Stepped(pub problems::Ball);

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    Apex,
    Floor,
}

impl Stepped {
    fn series(&self, rising: bool, series: &mut Series<'_, [f64; 2]>) {
        let (g, k) = (self.0.gravity, if rising { -self.0.drag } else { self.0.drag });
        series.flow(|_t, [_, v]| [v, k * (v * v) - g]);
    }
}

impl Automaton for Stepped {
    type Mode = bool;
    type State = [f64; 2];
    type Edge = Turn;

    #[inline]
    fn flow(&self, rising: bool, _t: f64, x: &[f64; 2]) -> [f64; 2] {
        [x[1], self.0.smooth(rising, x[1])]
    }
    #[inline]
    fn solution(&self, _: bool, _t: f64, _x: &[f64; 2]) -> Solution<Self> {
        Solution::Series(Self::series)
    }
    #[inline]
    fn edges(&self, rising: bool) -> Edges<'_, Turn> {
        Edges::from([if rising { Turn::Apex } else { Turn::Floor }])
    }
    #[inline]
    fn guard(&self, turn: Turn, _t: f64, x: &[f64; 2]) -> f64 {
        match turn {
            Turn::Apex => x[1],
            Turn::Floor => x[0],
        }
    }
    #[inline]
    fn about(&self, _: Turn) -> About {
        About::new().affine()
    }
    #[inline]
    fn reset(&self, _: bool, turn: Turn, _t: f64, x: &[f64; 2]) -> Result<(bool, [f64; 2]), Refusal> {
        Ok(match turn {
            Turn::Apex => (false, [x[0], 0.0]),
            Turn::Floor => (true, [0.0, -self.0.cor * x[1]]),
        })
    }
}

/// A ball without drag that is stepped all the same: one mode.
struct Flight(problems::Ball);

impl Automaton for Flight {
    type Mode = ();
    type State = [f64; 2];
    type Edge = ();

    #[inline]
    fn flow(&self, (): (), _t: f64, x: &[f64; 2]) -> [f64; 2] {
        [x[1], -self.0.gravity]
    }
    #[inline]
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    #[inline]
    fn guard(&self, (): (), _t: f64, x: &[f64; 2]) -> f64 {
        x[0]
    }
    #[inline]
    fn about(&self, (): ()) -> About {
        About::new().affine()
    }
    #[inline]
    fn reset(&self, (): (), (): (), _t: f64, x: &[f64; 2]) -> Result<((), [f64; 2]), Refusal> {
        Ok(((), [0.0, -self.0.cor * x[1]]))
    }
}

/// An automaton, run with one stepper at one tolerance.
fn entry<A, M>(
    method: &'static str,
    events: Events,
    stepper: M,
    make: fn() -> A,
    run: fn(&Simulation<'_, A, M>, &mut Log),
) -> Entry
where
    A: Automaton + 'static,
    M: Stepper + 'static,
{
    Entry::new(SOLVER, method, events, move |tolerance| -> Solve {
        let automaton = make();
        Box::new(move |log| {
            let simulation =
                Simulation::of(&automaton).stepper(stepper).tolerance(tolerance).absolute_tolerance(tolerance);
            let simulation = if method == SERIES { simulation } else { simulation.stepped() };
            run(&simulation, log);
        })
    })
}

pub fn vacuum_stepped<M: Stepper + 'static>(method: &'static str, stepper: M) -> Entry {
    entry(
        method,
        Events::Own,
        stepper,
        || Flight(VACUUM),
        |simulation, log| {
            let mut times = Times { log: &mut log.marks, edge: () };
            let simulation = simulation.most_jumps(VACUUM.impacts);
            let end = simulation.drive((), [VACUUM.height, 0.0], 0.0..100.0, &mut times).unwrap();
            log.flows = end.stats.flows;
        },
    )
}

pub fn drag_stepped<M: Stepper + 'static>(method: &'static str, stepper: M) -> Entry {
    entry(
        method,
        Events::Own,
        stepper,
        || Stepped(DRAG),
        |simulation, log| {
            let mut times = Times { log: &mut log.marks, edge: Turn::Floor };
            let simulation = simulation.most_jumps(2 * DRAG.impacts - 1);
            let end = simulation.drive(false, [DRAG.height, 0.0], 0.0..100.0, &mut times).unwrap();
            log.flows = end.stats.flows;
        },
    )
}

/// One mode without edges.
struct Orbit;

impl Orbit {
    fn series(&self, (): (), series: &mut Series<'_, [f64; 4]>) {
        use arenstorf::MU;
        series.flow(|_t, [x, y, u, v]| {
            let (a, b) = (x + MU, x - (1.0 - MU));
            let y2 = y * y;
            let (p, q) = ((1.0 - MU) * (a * a + y2).powf(-1.5), MU * (b * b + y2).powf(-1.5));
            [u, v, x + 2.0 * v - p * a - q * b, y - 2.0 * u - (p + q) * y]
        });
    }
}

impl Automaton for Orbit {
    type Mode = ();
    type State = [f64; 4];
    type Edge = ();

    #[inline]
    fn flow(&self, (): (), _t: f64, x: &[f64; 4]) -> [f64; 4] {
        arenstorf::flow(*x)
    }
    #[inline]
    fn solution(&self, (): (), _t: f64, _x: &[f64; 4]) -> Solution<Self> {
        Solution::Series(Self::series)
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::none()
    }
    fn guard(&self, (): (), _t: f64, _x: &[f64; 4]) -> f64 {
        1.0
    }
    fn reset(&self, (): (), (): (), _t: f64, x: &[f64; 4]) -> Result<((), [f64; 4]), Refusal> {
        Ok(((), *x))
    }
}

pub fn orbit<M: Stepper + 'static>(method: &'static str, stepper: M) -> Entry {
    entry(
        method,
        Events::None,
        stepper,
        || Orbit,
        |simulation, log| {
            if let Ok(end) = simulation.drive((), arenstorf::START, 0.0..arenstorf::PERIOD, &mut ()) {
                log.marks.extend([end.time.seconds(), end.state[0], end.state[1]]);
                log.flows = end.stats.flows;
            }
        },
    )
}

/// One mode without edges.
struct Stiff;

impl Automaton for Stiff {
    type Mode = ();
    type State = [f64; 2];
    type Edge = ();

    #[inline]
    fn flow(&self, (): (), _t: f64, x: &[f64; 2]) -> [f64; 2] {
        van_der_pol::flow(*x)
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::none()
    }
    fn guard(&self, (): (), _t: f64, _x: &[f64; 2]) -> f64 {
        1.0
    }
    fn reset(&self, (): (), (): (), _t: f64, x: &[f64; 2]) -> Result<((), [f64; 2]), Refusal> {
        Ok(((), *x))
    }
}

pub fn stiff() -> Entry {
    entry(
        "Rodas5P",
        Events::None,
        Rodas5P,
        || Stiff,
        |simulation, log| {
            if let Ok(end) = simulation.drive((), van_der_pol::START, 0.0..van_der_pol::END, &mut ()) {
                log.marks.extend([end.time.seconds(), end.state[0], end.state[1]]);
                log.flows = end.stats.flows;
            }
        },
    )
}

/// x'' = -x; the side of zero is the mode, and each crossing a jump.
struct Oscillator;

impl Oscillator {
    fn series(&self, _: bool, series: &mut Series<'_, [f64; 2]>) {
        series.flow(|_t, [x, v]| [v, -x]);
    }
}

impl Automaton for Oscillator {
    type Mode = bool;
    type State = [f64; 2];
    type Edge = bool;

    #[inline]
    fn flow(&self, _: bool, _t: f64, x: &[f64; 2]) -> [f64; 2] {
        [x[1], -x[0]]
    }
    #[inline]
    fn solution(&self, _: bool, _t: f64, _x: &[f64; 2]) -> Solution<Self> {
        Solution::Series(Self::series)
    }
    #[inline]
    fn edges(&self, above: bool) -> Edges<'_, bool> {
        Edges::from([above])
    }
    #[inline]
    fn guard(&self, above: bool, _t: f64, x: &[f64; 2]) -> f64 {
        if above { x[0] } else { -x[0] }
    }
    #[inline]
    fn about(&self, _: bool) -> About {
        About::new().affine()
    }
    #[inline]
    fn reset(&self, _: bool, above: bool, _t: f64, x: &[f64; 2]) -> Result<(bool, [f64; 2]), Refusal> {
        Ok((!above, *x))
    }
}

/// Keeps the times of all jumps.
struct All<'a>(&'a mut Vec<f64>);

impl<A: Automaton> Observer<A> for All<'_> {
    fn wants_pieces(&self) -> bool {
        false
    }
    #[inline]
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        self.0.push(jump.t());
        ControlFlow::Continue(())
    }
}

pub fn crossings<M: Stepper + 'static>(method: &'static str, stepper: M) -> Entry {
    entry(
        method,
        Events::Own,
        stepper,
        || Oscillator,
        |simulation, log| {
            let simulation = simulation.most_jumps(CROSSINGS);
            let end = simulation.drive(true, [1.0, 0.0], 0.0..1e9, &mut All(&mut log.marks)).unwrap();
            log.flows = end.stats.flows;
        },
    )
}

/// An oscillator that is watched by a guard of time alone: the sign of `g` is the mode.
pub struct Watched<G>(pub G);

impl<G: Fn(f64) -> f64> Automaton for Watched<G> {
    type Mode = bool;
    type State = [f64; 2];
    type Edge = bool;

    fn flow(&self, _: bool, _t: f64, x: &[f64; 2]) -> [f64; 2] {
        [x[1], -x[0]]
    }
    fn edges(&self, above: bool) -> Edges<'_, bool> {
        Edges::from([above])
    }
    fn guard(&self, above: bool, t: f64, _x: &[f64; 2]) -> f64 {
        if above { (self.0)(t) } else { -(self.0)(t) }
    }
    fn reset(&self, _: bool, above: bool, _t: f64, x: &[f64; 2]) -> Result<(bool, [f64; 2]), Refusal> {
        Ok((!above, *x))
    }
}

/// The crossings of zero of `g` along an oscillator's ten seconds.
pub fn watched(g: impl Fn(f64) -> f64, tolerance: f64) -> Vec<f64> {
    let mut times = Vec::new();
    let automaton = Watched(g);
    let simulation = Simulation::of(&automaton).tolerance(tolerance).absolute_tolerance(tolerance);
    simulation.drive(true, [1.0, 0.0], 0.0..10.0, &mut All(&mut times)).unwrap();
    times
}
