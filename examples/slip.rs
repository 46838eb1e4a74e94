//! A spring–mass runner: a mass in flight, on a springy leg in stance, the leg put down at a fixed
//! angle.
//!
//! `cargo run --example slip` finds the stride that repeats itself. Flight has Cartesian
//! coordinates, stance polar ones about the foot.

use saltus::return_map::{ReturnMap, Section};
use saltus::{Automaton, Coords, Edges, Lift, Linearize, Number, Refusal, Simulation};
use saltus_examples::{Figure, gallery};

/// kg, N/m, m, rad, m/s².
#[derive(Clone, Copy, Debug)]
pub(crate) struct Runner {
    pub(crate) mass: f64,
    pub(crate) stiffness: f64,
    pub(crate) leg: f64,
    pub(crate) angle: f64,
    pub(crate) g: f64,
}

/// An edge is named by the phase that it ends: at the apex, at touchdown, at lift-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Phase {
    Rise,
    Fall,
    Stance,
}

impl Linearize for Runner {
    type Parameters = [f64; 2];
    fn parameters(&self) -> [f64; 2] {
        [self.stiffness, self.angle]
    }
    /// In flight x, y and their rates; in stance the length of the leg, its angle from the
    /// vertical, their rates, and the foot.
    fn flow_over<D: Number>(&self, phase: Phase, _t: D, x: [D; 5], [k, _]: [D; 2]) -> [D; 5] {
        let ([r, a, r1, a1, _], g, zero) = (x, self.g, D::zero());
        if phase != Phase::Stance {
            return [x[2], x[3], zero, D::from(-g), zero];
        }
        let push = k / self.mass * (-r + self.leg);
        [r1, a1, r * a1 * a1 - a.cos() * g + push, (a.sin() * g - r1 * a1 * 2.0) / r, zero]
    }
    fn guard_over<D: Number>(&self, ends: Phase, _t: D, x: [D; 5], [_, angle]: [D; 2]) -> D {
        [x[3], x[1] - angle.sin() * self.leg, -x[0] + self.leg][ends as usize]
    }
    fn reset_over<D: Number>(&self, ends: Phase, _t: D, x: [D; 5], [_, angle]: [D; 2]) -> [D; 5] {
        match ends {
            Phase::Rise => x,
            Phase::Fall => {
                let (a, r) = (angle - std::f64::consts::FRAC_PI_2, self.leg); // the leg points back and up from the foot
                let (sin, cos) = a.sin_cos();
                [D::from(r), a, x[2] * sin + x[3] * cos, (x[2] * cos - x[3] * sin) / r, x[0] - sin * r]
            }
            Phase::Stance => {
                let ([r, _, r1, a1, foot], (sin, cos)) = (x, x[1].sin_cos());
                [foot + r * sin, r * cos, r1 * sin + r * a1 * cos, r1 * cos - r * a1 * sin, D::zero()]
            }
        }
    }
}

impl Automaton for Runner {
    type Mode = Phase;
    type State = Coords<5>;
    type Edge = Phase;
    fn flow(&self, phase: Phase, t: f64, x: &Coords<5>) -> Coords<5> {
        self.flow_at(phase, t, x)
    }
    fn edges(&self, phase: Phase) -> Edges<'_, Phase> {
        Edges::from([phase])
    }
    fn guard(&self, ends: Phase, t: f64, x: &Coords<5>) -> f64 {
        self.guard_at(ends, t, x)
    }
    fn reset(&self, _: Phase, ends: Phase, t: f64, x: &Coords<5>) -> Result<(Phase, Coords<5>), Refusal> {
        let to = [Phase::Fall, Phase::Stance, Phase::Rise][ends as usize];
        let [a, b, c, d, foot] = self.reset_over(ends, t, x.over(), self.parameters());
        Ok((to, if to == Phase::Stance { [a, b, c, d, foot].into() } else { [a, b, c, d].into() }))
    }
}

/// At the apex, with this energy (J), the height says everything: where along the road it is does
/// not matter.
pub(crate) struct Apex(pub(crate) Runner, pub(crate) f64);

impl Section<Runner, 1> for Apex {
    fn edge(&self) -> Phase {
        Phase::Rise
    }
    fn start(&self) -> (Phase, Coords<5>) {
        (Phase::Fall, [0.0; 4].into())
    }
    fn place<D: Number>(&self, [y]: [D; 1], _: [D; 2]) -> [D; 5] {
        let Self(Runner { mass, g, .. }, energy) = *self;
        [D::zero(), y, ((-y * (mass * g) + energy) * (2.0 / mass)).sqrt(), D::zero(), D::zero()]
    }
    fn read<D: Number>(&self, _t: D, x: [D; 5], _: [D; 2]) -> [D; 1] {
        [x[1]]
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let runner = Runner { mass: 80.0, stiffness: 2e4, leg: 1.0, angle: 68.0_f64.to_radians(), g: 9.81 };
    let map = ReturnMap::of(Simulation::of(&runner).tolerance(1e-13), Apex(runner, 1784.8));
    let stride = map.fixed_point([0.95])?;
    // Start too high, and watch it find the stride.
    let (mode, _, start) = map.place(&[1.0]);
    let run = Simulation::of(&runner).run(mode, start, 0.0..1.6)?;
    let mass = |x: &Coords<5>| if x.len() > 4 { [x[4] + x[0] * x[1].sin(), x[0] * x[1].cos()] } else { [x[0], x[1]] };
    let path = (0..=800).filter_map(|k| run.trajectory.at(f64::from(k) * 2e-3));
    let legs = path.clone().step_by(20).filter(|x| x.len() > 4);
    let picture = Figure::new("A spring–mass runner finds its stride", "way (m)", "height (m)")
        .line("mass", path.map(|x| mass(&x)))
        .line("leg", legs.flat_map(|x| [[x[4], 0.0], mass(&x), [f64::NAN; 2]]))
        .line("apex of the stride that repeats", [[0.0, stride.q[0]], [8.0, stride.q[0]]]);
    gallery("slip", &picture.svg())?;
    let (apex, multiplier) = (stride.q[0], stride.multipliers[0].re);
    println!("apex {apex:.13} m, multiplier {multiplier:.9}: see docs/program/gallery/slip.svg");
    assert!((apex - 0.940_267_144_379_607).abs() < 5e-12);
    assert!((stride.period - 0.252_532_613_817_573).abs() < 5e-12 && (multiplier + 0.161_307_631_04).abs() < 1e-6);
    Ok(())
}
