//! A ball that a vibrating table hits once in n of its periods: where such orbits are born, and
//! where they lose their stability.
//!
//! `cargo run --example table` follows them and compares with the closed form. (The attractors are
//! drawn by `chaos`.)

use std::error::Error;
use std::f64::consts::{PI, TAU};

use saltus::nalgebra::Vector2;
use saltus::return_map::{Continuation, Kind, ReturnMap, Section};
use saltus::{Automaton, Edges, Linearize, Number, Polynomial, Refusal, Simulation, Solution};
use saltus_examples::{Figure, gallery};

/// The table moves as A sin(ω t).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Table {
    pub(crate) g: f64,
    pub(crate) amplitude: f64,
    pub(crate) omega: f64,
    pub(crate) cor: f64,
}

impl Linearize for Table {
    type Parameters = [f64; 1];

    fn parameters(&self) -> [f64; 1] {
        [self.amplitude]
    }
    fn flow_over<D: Number>(&self, _: (), _t: D, [_, v]: [D; 2], _: [D; 1]) -> [D; 2] {
        [v, D::from(-self.g)]
    }
    fn exact_over<D: Number>(&self, _: (), _t: D, x: [D; 2], _: [D; 1]) -> Option<Polynomial<[D; 2]>> {
        Some([x, [x[1], D::from(-self.g)], [D::from(-0.5 * self.g), D::zero()]].into())
    }
    fn guard_over<D: Number>(&self, _: (), t: D, [y, _]: [D; 2], [a]: [D; 1]) -> D {
        y - a * (t * self.omega).sin()
    }
    fn reset_over<D: Number>(&self, _: (), t: D, [y, v]: [D; 2], [a]: [D; 1]) -> [D; 2] {
        [y, a * (t * self.omega).cos() * (self.omega * (1.0 + self.cor)) - v * self.cor]
    }
}

impl Automaton for Table {
    type Mode = ();
    type State = Vector2<f64>;
    type Edge = ();

    fn flow(&self, mode: (), t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        self.flow_at(mode, t, x)
    }
    fn solution(&self, mode: (), t: f64, x: &Vector2<f64>) -> Solution<Self> {
        self.solution_at(mode, t, x)
    }
    fn edges(&self, _: ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn guard(&self, edge: (), t: f64, x: &Vector2<f64>) -> f64 {
        self.guard_at(edge, t, x)
    }
    fn reset(&self, (): (), edge: (), t: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
        Ok(((), self.reset_at(edge, t, x)))
    }
}

/// Just after an impact: the table's phase, and the ball's velocity. The ball comes back `periods`
/// periods of the table later.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Impact {
    pub(crate) table: Table,
    pub(crate) periods: f64,
}

impl Section<Table, 2> for Impact {
    fn edge(&self) {}
    fn start(&self) -> ((), Vector2<f64>) {
        ((), Vector2::zeros())
    }
    fn time<D: Number>(&self, [phase, _]: [D; 2], _: [D; 1]) -> D {
        phase / self.table.omega
    }
    fn place<D: Number>(&self, [phase, v]: [D; 2], [a]: [D; 1]) -> [D; 2] {
        [a * phase.sin(), v]
    }
    fn read<D: Number>(&self, t: D, [_, v]: [D; 2], _: [D; 1]) -> [D; 2] {
        [t * self.table.omega - TAU * self.periods, v]
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let (g, omega, cor) = (9.81, 50.0, 0.8);
    let strength = |amplitude: f64| amplitude * omega * omega / g;
    let mut picture = Figure::new(
        "Periodic bounces on a vibrating table",
        "acceleration of the table, Aω²/g",
        "phase of the impact (rad)",
    );
    let (mut births, mut doublings) = (Vec::new(), Vec::new());
    for n in 1..=3_u32 {
        // Its flight takes n periods; stable and unstable orbits are born together where the table
        // is just strong enough.
        let born = f64::from(n) * PI * (1.0 - cor) / (1.0 + cor);
        let table = Table { g, amplitude: 2.2 * g / (omega * omega), omega, cor };
        let map = ReturnMap::of(Simulation::of(&table).tolerance(1e-13), Impact { table, periods: f64::from(n) });
        let guess = [(born / 2.2).acos(), f64::from(n) * PI * g / omega];
        let family = |amplitude| Table { amplitude, ..table };
        let branch = Continuation::of(&map, family, 0).follow(guess, table.amplitude, 0.1 * table.amplitude)?;

        let doubled = born.hypot(2.0 * (1.0 + cor * cor) / (1.0 + cor).powi(2));
        for (kind, exact, found) in [(Kind::Fold, born, &mut births), (Kind::PeriodDoubling, doubled, &mut doublings)] {
            let at =
                &branch.bifurcations.iter().find(|found| found.kind == kind).ok_or("a bifurcation is missing")?.point;
            println!("n = {n}, {kind:?} at {:.11}, exact {exact:.11}", strength(at.parameter));
            assert!((strength(at.parameter) - exact).abs() < 1e-8);
            found.push([strength(at.parameter), at.orbit.q[0]]);
        }
        let label = format!("n = {n}");
        picture = picture.line(&label, branch.points.iter().map(|point| [strength(point.parameter), point.orbit.q[0]]));
    }
    gallery("table", &picture.dots("period doubling", doublings).dots("birth", births).svg())?;
    Ok(())
}
