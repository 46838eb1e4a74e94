//! The rimless wheel: spokes that roll down a slope, each impact taking a part of the speed (T.
//! McGeer, Int. J. Robotics Research 9 (1990) 62).
//!
//! `cargo run --example wheel` finds its steady gait.

use std::error::Error;

use saltus::nalgebra::{self, Vector2, vector};
use saltus::return_map::{ReturnMap, Section};
use saltus::{About, Automaton, Edges, Linearize, Number, Refusal, Simulation};
use saltus_examples::{Figure, gallery};

/// g in m/s², the spokes' length in m, half the angle between them and the slope in rad.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wheel {
    pub(crate) g: f64,
    pub(crate) spoke: f64,
    pub(crate) half: f64,
    pub(crate) slope: f64,
}

impl Linearize for Wheel {
    type Parameters = [f64; 1];

    fn parameters(&self) -> [f64; 1] {
        [self.slope]
    }
    /// The stance spoke's angle from the vertical, and its rate.
    fn flow_over<D: Number>(&self, _: (), _t: D, [angle, rate]: [D; 2], _: [D; 1]) -> [D; 2] {
        [rate, angle.sin() * (self.g / self.spoke)]
    }
    fn guard_over<D: Number>(&self, _: (), _t: D, [angle, _]: [D; 2], [slope]: [D; 1]) -> D {
        slope + self.half - angle
    }
    fn reset_over<D: Number>(&self, _: (), _t: D, [_, rate]: [D; 2], [slope]: [D; 1]) -> [D; 2] {
        [slope - self.half, rate * (2.0 * self.half).cos()]
    }
}

impl Automaton for Wheel {
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
    #[inline]
    fn about(&self, _: ()) -> About {
        About::new().affine()
    }
    fn reset(&self, (): (), edge: (), t: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
        Ok(((), self.reset_at(edge, t, x)))
    }
}

/// Just after an impact the angle is known; the rate says the rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Impact(pub(crate) Wheel);

impl Section<Wheel, 1> for Impact {
    fn edge(&self) {}
    fn start(&self) -> ((), Vector2<f64>) {
        ((), Vector2::zeros())
    }
    fn place<D: Number>(&self, [rate]: [D; 1], [slope]: [D; 1]) -> [D; 2] {
        [slope - self.0.half, rate]
    }
    fn read<D: Number>(&self, _t: D, [_, rate]: [D; 2], _: [D; 1]) -> [D; 1] {
        [rate]
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let wheel = Wheel { g: 9.81, spoke: 1.0, half: std::f64::consts::FRAC_PI_8, slope: 0.08 };
    let map = ReturnMap::of(Simulation::of(&wheel).tolerance(1e-13), Impact(wheel));
    let gait = map.fixed_point([1.2])?;

    let start = vector![wheel.slope - wheel.half, 2.0];
    let trajectory = Simulation::of(&wheel).run((), start, 0.0..8.0)?.trajectory;
    let (mut rolling, mut impacts) = (Vec::new(), Vec::new());
    for arc in 0..trajectory.arcs().len() {
        for piece in trajectory.pieces(arc) {
            rolling.extend((0..=8).map(|k| piece.at(piece.span() * f64::from(k) / 8.0)).map(|x| [x[0], x[1]]));
        }
        rolling.push([f64::NAN; 2]);
    }
    for jump in trajectory.jumps() {
        impacts.extend([[jump.before[0], jump.before[1]], [jump.after[0], jump.after[1]], [f64::NAN; 2]]);
    }
    let picture = Figure::new("A rimless wheel rolls into its steady gait", "angle of the spoke (rad)", "rate (rad/s)")
        .line("rolling", rolling)
        .line("impact", impacts)
        .dots("steady gait", [[start[0], gait.q[0]]]);
    gallery("wheel", &picture.svg())?;

    // Each step gives 2 g/l (cos(γ-α) - cos(γ+α)) to ω², each impact keeps the part cos²(2α) of it.
    let (gain, kept) = (4.0 * wheel.g * wheel.slope.sin() * wheel.half.sin(), (2.0 * wheel.half).cos().powi(2));
    let exact = (kept * gain / (1.0 - kept)).sqrt();
    println!(
        "ω = {:.14} (exact {exact:.14}), multiplier {:.12}: see docs/program/gallery/wheel.svg",
        gait.q[0], gait.multipliers[0].re
    );
    assert!((gait.q[0] - exact).abs() < 1e-12 && (gait.multipliers[0].re - kept).abs() < 1e-10);
    Ok(())
}
