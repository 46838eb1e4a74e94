//! Flows known by a formula: a ball with drag, its formula given with and without the time of its
//! fall, and stepped.

use proptest::prelude::*;
use saltus::nalgebra::{Vector2, vector};
use saltus::{Automaton, Dop853, Edges, Fall, Jump, Refusal, Simulation, Solution, Stop};
use saltus_bounce::flight::{QuadraticDragFlight, VerticalFlight};

#[derive(Clone, Copy, PartialEq)]
enum Path {
    Steps,
    Searched,
    Formula,
}

struct Ball {
    flight: QuadraticDragFlight,
    path: Path,
}

const G: f64 = 9.8;
const K: f64 = 0.1;

impl Ball {
    fn flown(&self, _: bool, _t: f64, x: &Vector2<f64>, s: f64) -> Vector2<f64> {
        self.flight.after(s, x)
    }
}

impl Automaton for Ball {
    type Mode = bool; // rising
    type State = Vector2<f64>;
    type Edge = bool; // the apex, else the floor

    fn flow(&self, rising: bool, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        vector![x[1], -G - if rising { K } else { -K } * x[1] * x[1]]
    }
    fn edges(&self, rising: bool) -> Edges<'_, bool> {
        Edges::from([rising])
    }
    fn guard(&self, apex: bool, _t: f64, x: &Vector2<f64>) -> f64 {
        if apex { x[1] } else { x[0] }
    }
    fn reset(&self, _: bool, apex: bool, _t: f64, x: &Vector2<f64>) -> Result<(bool, Vector2<f64>), Refusal> {
        Ok(if apex { (false, vector![x[0], 0.0]) } else { (true, vector![0.0, -0.9 * x[1]]) })
    }
    fn solution(&self, _: bool, _t: f64, _x: &Vector2<f64>) -> Solution<Self> {
        if self.path == Path::Steps { Solution::Steps } else { Solution::Formula(Self::flown) }
    }
    fn falls(&self, _: bool, apex: bool, _t: f64, x: &Vector2<f64>) -> Fall<Vector2<f64>> {
        let after = match (self.path, apex) {
            (Path::Formula, true) => self.flight.apex(x[1]).map(|apex| apex.time),
            (Path::Formula, false) => self.flight.impact(x).map(|impact| impact.time),
            _ => return Fall::Unknown,
        };
        after.map_or(Fall::Never, Fall::After)
    }
}

#[test]
fn three_ways_agree() {
    let times = |path: Path| {
        let ball = Ball { flight: QuadraticDragFlight::new(G, K).unwrap(), path };
        let run =
            Simulation::of(&ball).stepper(Dop853).tolerance(1e-13).run(false, vector![10.0, 0.0], 0.0..9.0).unwrap();
        assert_eq!(run.end.stop, Stop::Time);
        for arc in 0..run.trajectory.arcs().len() {
            for piece in run.trajectory.pieces(arc) {
                let (start, s) = (piece.at(0.0), 0.7 * piece.span());
                let exact = ball.flight.after(s, &start);
                assert!((piece.at(s) - exact).norm() < 1e-10, "{:?} {exact:?}", piece.at(s));
            }
        }
        let heights = (0..900).map(|k| run.trajectory.at(0.01 * f64::from(k)).unwrap()[0]);
        assert!(heights.clone().all(|y| y > -1e-12), "{:?}", heights.fold(0.0, f64::min));
        let times: Vec<_> = run.trajectory.jumps().iter().map(Jump::t).collect();
        (times, run.end.state, run.end.stats)
    };
    let [steps, searched, formula] = [Path::Steps, Path::Searched, Path::Formula].map(times);
    assert_eq!((searched.2.steps, formula.2.steps), (0, 0));
    for other in [&steps, &searched] {
        assert_eq!(other.0.len(), formula.0.len());
        for (a, b) in other.0.iter().zip(&formula.0) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
        assert!((other.1 - formula.1).norm() < 1e-11);
    }
}

/// A decay x' = -x whose formula adds a number, and takes it away again.
struct Cancelling {
    beside: f64,
}

impl Cancelling {
    fn after(&self, (): (), _t: f64, x: &f64, s: f64) -> f64 {
        (self.beside + x * (-s).exp()) - self.beside
    }
}

impl Automaton for Cancelling {
    type Mode = ();
    type State = f64;
    type Edge = ();

    fn flow(&self, (): (), _t: f64, x: &f64) -> f64 {
        -x
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::none()
    }
    fn guard(&self, (): (), _t: f64, _x: &f64) -> f64 {
        1.0
    }
    fn reset(&self, (): (), (): (), _t: f64, x: &f64) -> Result<((), f64), Refusal> {
        Ok(((), *x))
    }
    fn solution(&self, (): (), _t: f64, _x: &f64) -> Solution<Self> {
        Solution::Formula(Self::after)
    }
}

proptest! {
    /// However deep a solution decays into the rounding of its formula, its pieces are as many as a
    /// smooth solution takes, and no farther from it than the formula is.
    #[test]
    fn a_formula_that_cancels_takes_no_more_pieces(digits in 0.0..6.0_f64, sign in prop::bool::ANY) {
        let beside = if sign { 1.0 } else { -1.0 } * 10.0_f64.powf(digits);
        let run = Simulation::of(&Cancelling { beside }).most_steps(1000).run((), 1.0, 0.0..50.0).unwrap();
        prop_assert_eq!(run.end.stop, Stop::Time);
        let pieces: Vec<_> = run.trajectory.pieces(0).collect();
        prop_assert!(pieces.len() < 100, "{} pieces", pieces.len());
        for piece in &pieces {
            let s = 0.4 * piece.span();
            let off = (piece.at(s) - (-piece.start().seconds() - s).exp()).abs();
            prop_assert!(off < 1e-11 + 100.0 * f64::EPSILON * beside.abs(), "{off:e}");
        }
    }
}
