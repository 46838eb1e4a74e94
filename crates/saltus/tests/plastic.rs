//! Impacts that are nearly plastic, on floors that move: rebounds too low for the guard's values to
//! show them, and no ball that falls through.

use std::f64::consts::TAU;

use saltus::{Cause, Entry, Hybrid, Simulation, Stop};

use crate::methods::methods;

const GRAVITY: f64 = 9.81;

/// A floor at A sin(ω t).
#[derive(Clone, Copy, Debug)]
struct Floor {
    amplitude: f64,
    omega: f64,
}

/// How a ball falls onto a floor: with which restitution, from where, and whether a rebound sets
/// its height to the floor's or leaves it as it is.
#[derive(Clone, Copy, Debug)]
struct Drop {
    e: f64,
    start: f64,
    x: [f64; 2],
    set: bool,
}

impl Floor {
    fn height(self, t: f64) -> f64 {
        self.amplitude * (self.omega * t).sin()
    }

    fn speed(self, t: f64) -> f64 {
        self.amplitude * self.omega * (self.omega * t).cos()
    }

    /// What presses a ball that lies on it, per kilogram.
    fn press(self, t: f64) -> f64 {
        GRAVITY - self.omega * self.omega * self.height(t)
    }

    /// What the guard of a ball at height `x` is rounded by: its own numbers and those of time.
    fn rounding(self, t: f64, x: f64) -> f64 {
        16.0 * f64::EPSILON * (x.abs() + self.amplitude * (1.0 + self.omega * t.abs()))
    }

    /// A ball that flies above it, and lies on it where its impacts accumulate, for as long as it
    /// is pressed.
    fn ball(self, Drop { e, set, .. }: Drop) -> Hybrid<'static, [f64; 2]> {
        Hybrid::new()
            .mode("flight", |_t, x: &[f64; 2]| [x[1], -GRAVITY])
            .mode("rest", move |t, _x| [self.speed(t), self.press(t) - GRAVITY])
            .edge(
                "flight",
                "flight",
                move |t, x| x[0] - self.height(t),
                move |t, x| {
                    let speed = self.speed(t);
                    [if set { self.height(t) } else { x[0] }, speed - e * (x[1] - speed)]
                },
            )
            .beyond("flight", "rest", move |t, _x| [self.height(t), self.speed(t)])
            .edge("rest", "flight", move |t, _x| self.press(t), move |t, _x| [self.height(t), self.speed(t)])
            .entry(Entry::Fire)
    }

    /// Runs to the end of three seconds: the ball is never below the floor, and leaves it where
    /// that falls away. Says how often it came to rest.
    fn holds(self, drop: Drop, method: usize, tolerance: f64) -> usize {
        let ball = self.ball(drop);
        let run = Simulation::of(&ball)
            .stepper(methods()[method])
            .tolerance(tolerance)
            .most_jumps(10_000)
            .run("flight", drop.x, drop.start..drop.start + 3.0)
            .unwrap_or_else(|failed| panic!("{self:?}, {drop:?}: {failed}"));
        assert_eq!(run.end.stop, Stop::Time, "{self:?}, {drop:?}");
        let above = |t: f64, x: &[f64; 2], stood: f64| {
            let (gap, least) = (x[0] - self.height(t), self.rounding(t, x[0]) + stood * self.amplitude * self.omega);
            assert!(gap >= -least, "{self:?}, {drop:?}: {gap:e} at {t}");
        };
        let trajectory = &run.trajectory;
        for jump in trajectory.jumps() {
            let t = jump.t();
            if jump.from == "rest" {
                // It rises as the third power of time at first, which rounding hides for a while.
                let third = self.amplitude * self.omega.powi(3);
                let hidden = (self.rounding(t, 0.0) / third).cbrt();
                let press = self.press(t);
                assert!(press.abs() <= (1e-9 + hidden) * third, "{self:?}, {drop:?}: left at {t}, pressed by {press}");
            } else if jump.cause != Cause::Zeno {
                above(t, &jump.before, 0.0);
            }
            if jump.to == "flight" {
                above(t, &jump.after, 0.0);
            }
        }
        for k in (0..trajectory.arcs().len()).filter(|&k| trajectory.arcs()[k].mode() == "flight") {
            for piece in trajectory.pieces(k) {
                // For the rest of the time to a limit the state goes on in a line.
                let [start, middle, end] = [0.0, 0.5, 1.0].map(|part| piece.at(part * piece.span())[0]);
                let straight = middle == start.midpoint(end);
                for part in 0..=16 {
                    let s = piece.span() * f64::from(part) / 16.0;
                    above(piece.start().after(s).seconds(), &piece.at(s), if straight { s } else { 0.0 });
                }
            }
        }
        trajectory.jumps().iter().filter(|jump| jump.cause == Cause::Zeno).count()
    }
}

/// Rebounds of 10⁻¹¹ m/s, which rise by 10⁻²² m.
#[test]
fn a_rebound_that_rounding_hides_ends_on_the_floor() {
    let floor = Floor { amplitude: 0.041_468_532_207_458_275, omega: TAU * 2.518_827_266_676_153_5 };
    for set in [false, true] {
        for drop in [
            Drop { e: 1e-3, start: 0.0, x: [1.035_470_686_368_142, 1.615_898_209_096_905_6], set },
            Drop {
                e: 1e-9,
                start: 1.269_129_804_894_191_5,
                x: [0.039_166_363_371_551_31, 0.215_629_588_238_524_38],
                set,
            },
        ] {
            assert!(floor.holds(drop, 1, 1e-9) > 0);
        }
    }
}

#[test]
fn no_ball_falls_through_a_floor_that_moves() {
    let mut seed = 1_u64;
    let mut random = |low: f64, high: f64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((seed >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let mut rests = 0;
    for e in [1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 0.5] {
        for case in 0..50 {
            let amplitude = random(1e-5_f64.ln(), 0.05_f64.ln()).exp();
            let floor = Floor { amplitude, omega: TAU * random(0.5_f64.ln(), 60.0_f64.ln()).exp() };
            let start = random(0.0, if case % 5 == 0 { 30.0 } else { 2.0 });
            let x = [floor.height(start) + random(1e-6_f64.ln(), 1.0_f64.ln()).exp(), random(-2.0, 2.0)];
            let drop = Drop { e, start, x, set: case % 3 == 0 };
            rests += match case % 4 {
                0 => floor.holds(drop, 0, 1e-6),
                1 => floor.holds(drop, 1, 1e-12),
                _ => floor.holds(drop, 1, 1e-9),
            };
        }
    }
    assert!(rests > 2000, "{rests} rests");
}
