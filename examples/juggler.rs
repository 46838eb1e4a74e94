//! A paddle that juggles one ball by a mirror law (M. Bühler, D. Koditschek, P. Kindlmann, IEEE
//! Control Systems 10 (1990) 16).
//!
//! `cargo run --example juggler`: the paddle moves as the ball's mirror image, the faster the less
//! energy the ball has.

use std::error::Error;

use saltus::nalgebra::{self, Vector2, vector};
use saltus::return_map::{ReturnMap, Selection};
use saltus::{Automaton, Edges, Linearize, Number, Polynomial, Refusal, Simulation, Solution};
use saltus_examples::{Figure, gallery};

/// g in m/s², the coefficient of restitution, the gain in s²/m², the energy wanted in m²/s².
#[derive(Clone, Copy, Debug)]
pub(crate) struct Juggler {
    pub(crate) g: f64,
    pub(crate) cor: f64,
    pub(crate) gain: f64,
    pub(crate) wanted: f64,
}

impl Juggler {
    /// κ: the paddle is at -κ times the ball's height.
    fn mirror<D: Number>(&self, [b, v]: [D; 2]) -> D {
        let energy = v * v * 0.5 + b * self.g;
        (-energy + self.wanted) * self.gain + (1.0 - self.cor) / (1.0 + self.cor)
    }
}

impl Linearize for Juggler {
    type Parameters = [f64; 0];

    fn parameters(&self) -> [f64; 0] {
        []
    }
    fn flow_over<D: Number>(&self, _: (), _t: D, [_, v]: [D; 2], _: [D; 0]) -> [D; 2] {
        [v, D::from(-self.g)]
    }
    fn exact_over<D: Number>(&self, _: (), _t: D, x: [D; 2], _: [D; 0]) -> Option<Polynomial<[D; 2]>> {
        Some([x, [x[1], D::from(-self.g)], [D::from(-0.5 * self.g), D::zero()]].into())
    }
    /// The gap between ball and paddle.
    fn guard_over<D: Number>(&self, _: (), _t: D, x: [D; 2], _: [D; 0]) -> D {
        x[0] + self.mirror(x) * x[0]
    }
    fn reset_over<D: Number>(&self, _: (), _t: D, x: [D; 2], _: [D; 0]) -> [D; 2] {
        let paddle = -self.mirror([D::zero(), x[1]]) * x[1];
        [D::zero(), -x[1] * self.cor + paddle * (1.0 + self.cor)]
    }
}

impl Automaton for Juggler {
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

fn main() -> Result<(), Box<dyn Error>> {
    let juggler = Juggler { g: 9.81, cor: 0.7, gain: 0.02, wanted: 15.0 };
    // Ball and paddle meet at height zero: the ball's velocity after it says everything.
    let hit = Selection::of((), ((), vector![0.0, 0.0]), [1])?;
    let steady = ReturnMap::of(Simulation::of(&juggler), hit).fixed_point([5.0])?;

    let trajectory = Simulation::of(&juggler).run((), vector![0.5, 0.0], 0.0..6.0)?.trajectory;
    let at = |f: fn(&Juggler, [f64; 2]) -> f64| {
        let (trajectory, juggler) = (&trajectory, &juggler);
        (0..=1500).filter_map(move |k| {
            let t = f64::from(k) * 4e-3;
            trajectory.at(t).map(|x| [t, f(juggler, [x[0], x[1]])])
        })
    };
    let picture = Figure::new("A paddle juggles a ball by its mirror image", "time (s)", "height (m)")
        .line("ball", at(|_, x| x[0]))
        .line("paddle", at(|juggler, x| -juggler.mirror(x) * x[0]));
    gallery("juggler", &picture.svg())?;

    // v⁺ = v (1 + (1 + e) κ₁ (η - v²/2)) stands still at v² = 2η.
    let (v, multiplier) =
        ((2.0 * juggler.wanted).sqrt(), 1.0 - 2.0 * (1.0 + juggler.cor) * juggler.gain * juggler.wanted);
    println!(
        "v = {:.14} m/s (exact {v:.14}), multiplier {:.10}: see docs/program/gallery/juggler.svg",
        steady.q[0], steady.multipliers[0].re
    );
    assert!((steady.q[0] / v - 1.0).abs() < 6e-15 && (steady.multipliers[0].re - multiplier).abs() < 1e-12);
    Ok(())
}
