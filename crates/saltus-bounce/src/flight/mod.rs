//! Vertical flight in closed form: gravity alone, with linear drag, with quadratic drag.
//!
//! The state is the height y of the ball's lowest point above the floor in m and its velocity v
//! upwards in m/s. Every formula is written so that drag may go to zero, and gravity too, without
//! loss of digits: see [`VerticalFlight`].

mod linear;
mod quadratic;
mod vacuum;

use nalgebra::Vector2;

pub use linear::LinearDragFlight;
pub use quadratic::QuadraticDragFlight;
pub use vacuum::VacuumFlight;

/// The highest point of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apex {
    /// The time of the apex, in s from the start.
    pub time: f64,
    /// The height of the apex above the start, in m.
    pub rise: f64,
}

/// The meeting with the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The time of the impact, in s from the start.
    pub time: f64,
    /// The speed downwards, in m/s, not negative.
    pub speed: f64,
}

/// A vertical flight with a solution in closed form.
///
/// Times and speeds of impact, apexes and depths fallen are sums and products of positive terms: a
/// few roundings off, from no drag at all to terminal velocities of micrometres per second, whether
/// the start is slower than terminal, faster, or almost at it. Only the height itself, a
/// difference, loses what every difference loses.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::flight::{QuadraticDragFlight, VacuumFlight, VerticalFlight};
/// let start = vector![10.0, 5.0];
/// let (vacuum, air) = (VacuumFlight::new(9.81)?, QuadraticDragFlight::new(9.81, 0.1)?);
/// assert!(air.apex(5.0).unwrap().rise < vacuum.apex(5.0).unwrap().rise);
/// let impact = air.impact(&start).unwrap();
/// let state = air.after(impact.time, &start);
/// assert!(state[0].abs() < 1e-14 && (state[1] + impact.speed).abs() < 1e-14);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
pub trait VerticalFlight {
    /// The acceleration upwards in m/s² at `velocity` upwards in m/s: the law that the other
    /// methods solve.
    fn acceleration(&self, velocity: f64) -> f64;

    /// The state `[y, v]` after `s` seconds, `s` ≥ 0, from the state `x`.
    fn after(&self, s: f64, x: &Vector2<f64>) -> Vector2<f64>;

    /// The apex of a flight that starts upwards at `velocity` in m/s; `None` if it starts level or
    /// downwards, or never turns.
    fn apex(&self, velocity: f64) -> Option<Apex>;

    /// The fall through `depth` ≥ 0 in m from a start downwards at `speed` ≥ 0 in m/s; `None` if it
    /// never gets there.
    fn fall(&self, depth: f64, speed: f64) -> Option<Impact>;

    /// The first fall through height zero from the state `x`; `None` if there is none: no gravity,
    /// or a start below zero that does not rise to it. A start at zero height that moves upwards
    /// falls after its apex; one that does not, at once.
    fn impact(&self, x: &Vector2<f64>) -> Option<Impact> {
        let (y, v) = (x[0], x[1]);
        if v > 0.0 {
            let apex = self.apex(v)?;
            let fall = self.fall(at_least_zero(y + apex.rise)?, 0.0)?;
            Some(Impact { time: apex.time + fall.time, speed: fall.speed })
        } else {
            self.fall(at_least_zero(y)?, -v)
        }
    }
}

fn at_least_zero(depth: f64) -> Option<f64> {
    (depth >= 0.0).then_some(depth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::vector;
    use proptest::prelude::*;

    fn laws(g: f64, drag: f64) -> [Box<dyn VerticalFlight>; 3] {
        [
            Box::new(VacuumFlight::new(g).unwrap()),
            Box::new(LinearDragFlight::new(g, drag).unwrap()),
            Box::new(QuadraticDragFlight::new(g, drag).unwrap()),
        ]
    }

    /// The force of each law, for integration.
    fn pull(law: usize, g: f64, drag: f64, v: f64) -> f64 {
        -g - [0.0, drag * v, drag * v * v.abs()][law]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// At the time of impact the ball is on the floor, at the speed announced; at the apex it
        /// stands, as high as announced.
        #[test]
        fn the_state_agrees_with_the_impact(
            g in 0.01..30.0_f64, log_drag in -14.0..3.0_f64, y in 0.0..30.0_f64, v in -30.0..30.0_f64,
        ) {
            let drag = 10.0_f64.powf(log_drag);
            for (n, law) in laws(g, drag).iter().enumerate() {
                let x = vector![y, v];
                let impact = law.impact(&x).unwrap();
                let rise = law.apex(v).map_or(0.0, |apex| apex.rise);
                let end = law.after(impact.time, &x);
                prop_assert!(end[0].abs() <= 1e-13 * (y + rise).max(impact.speed * impact.time), "law {n}: {end:?} {impact:?}");
                prop_assert!((end[1] + impact.speed).abs() <= 1e-13 * (impact.speed + g * impact.time), "law {n}: {end:?} {impact:?}");
                if let Some(apex) = law.apex(v) {
                    let top = law.after(apex.time, &x);
                    prop_assert!(top[1].abs() <= 1e-14 * v && (top[0] - y - apex.rise).abs() <= 1e-14 * (y + apex.rise), "law {n}: {top:?} {apex:?}");
                }
            }
        }

        /// Two flights one after the other are one flight.
        #[test]
        fn flights_compose(
            g in 0.0..30.0_f64, log_drag in -14.0..2.0_f64, v in -30.0..30.0_f64, s in 0.0..3.0_f64, r in 0.0..3.0_f64,
        ) {
            for (n, law) in laws(g, 10.0_f64.powf(log_drag)).iter().enumerate() {
                let once = law.after(s + r, &vector![0.0, v]);
                let twice = law.after(r, &law.after(s, &vector![0.0, v]));
                let size = v.abs() + g * (s + r);
                prop_assert!((once - twice).norm() <= 1e-13 * size * (1.0 + s + r), "law {n}: {once:?} {twice:?}");
            }
        }

        /// The solution obeys its law: a step of Simpson's rule through it.
        #[test]
        fn the_solution_obeys_the_law(
            g in 0.0..30.0_f64, log_drag in -14.0..0.5_f64, v in -5.0..5.0_f64, s in 0.0..2.0_f64,
        ) {
            let drag = 10.0_f64.powf(log_drag);
            for (n, law) in laws(g, drag).iter().enumerate() {
                let h = 1e-3;
                let [a, b, c] = [s, s + 0.5 * h, s + h].map(|s| law.after(s, &vector![0.0, v]));
                let mean = (a[1] + 4.0 * b[1] + c[1]) / 6.0;
                prop_assert!((c[0] - a[0] - mean * h).abs() < 1e-8 * h, "law {n}");
                let mean = [a, b, c].map(|x| pull(n, g, drag, x[1]));
                let mean = (mean[0] + 4.0 * mean[1] + mean[2]) / 6.0;
                prop_assert!((c[1] - a[1] - mean * h).abs() < 1e-6 * h * (1.0 + g), "law {n}");
            }
        }
    }

    /// No gravity, no drag, neither; from the floor, from below it, at rest.
    #[test]
    fn edges_of_the_domain() {
        for (n, law) in laws(0.0, 0.0).iter().enumerate() {
            assert_eq!(law.impact(&vector![3.0, -2.0]), Some(Impact { time: 1.5, speed: 2.0 }), "law {n}");
            assert_eq!(law.impact(&vector![3.0, 0.0]), None, "law {n}");
            assert_eq!((law.apex(2.0), law.impact(&vector![3.0, 2.0])), (None, None), "law {n}");
            assert_eq!(law.after(3.0, &vector![1.0, 2.0]), vector![7.0, 2.0], "law {n}");
        }
        for drag in [0.0, 1e-300, 0.1, 1e4, 1e200] {
            for (n, law) in laws(9.81, drag).iter().enumerate() {
                assert_eq!(law.impact(&vector![0.0, 0.0]), Some(Impact { time: 0.0, speed: 0.0 }), "law {n}");
                assert_eq!(law.impact(&vector![0.0, -2.0]), Some(Impact { time: 0.0, speed: 2.0 }), "law {n}");
                assert_eq!(law.impact(&vector![-1e-3, 0.0]), None, "law {n}");
                assert_eq!(law.impact(&vector![-1e3, 1.0]), None, "law {n}");
                assert_eq!((law.apex(0.0), law.apex(-1.0)), (None, None));
                for x in [vector![1.0, 3.0], vector![1.0, -3.0], vector![1e-300, 0.0], vector![1e5, -1e5]] {
                    let impact = law.impact(&x).unwrap();
                    assert!(
                        impact.time > 0.0 && !impact.time.is_nan() && impact.speed > 0.0,
                        "law {n}, drag {drag}: {impact:?}"
                    );
                    assert!(law.after(0.5, &x).iter().all(|part| part.is_finite()), "law {n}, drag {drag}");
                }
            }
        }
    }

    /// Drag that is almost nothing changes almost nothing: a few roundings.
    #[test]
    fn vanishing_drag() {
        let [vacuum, linear, quadratic] = laws(9.81, 1e-18);
        for x in [vector![10.0, 0.0], vector![10.0, -4.0], vector![10.0, 4.0], vector![0.0, 4.0], vector![1e-9, -4.0]] {
            let expected = vacuum.impact(&x).unwrap();
            for law in [&linear, &quadratic] {
                let got = law.impact(&x).unwrap();
                assert!((got.time - expected.time).abs() <= 4e-16 * expected.time, "{x:?}: {got:?} {expected:?}");
                assert!((got.speed - expected.speed).abs() <= 4e-16 * expected.speed, "{x:?}: {got:?} {expected:?}");
            }
        }
    }
}
