//! Films of balls whose COR is known: flights and contacts integrated in small steps, with nothing
//! of the crate's own formulas.

use std::f64::consts::PI;

use crate::noise::Noise;
use saltus_fit::{Fit, ReadOptions, Report, Table};

/// What happens between floor and ball; not every test needs every kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Contact {
    /// Nothing that takes time.
    Instant,
    /// A linear spring with a damper, on which a ball without weight stays so long.
    Spring(f64),
    /// Hertz's force, less by e² on the way up: a ball without weight that comes at 4 m/s would
    /// stay so long, were e one.
    Solid(f64),
}

/// A ball dropped from `drop` at `release`, with quadratic drag.
pub(crate) struct Ball {
    pub(crate) drop: f64,
    pub(crate) release: f64,
    pub(crate) gravity: f64,
    pub(crate) drag: f64,
    pub(crate) cor: fn(f64) -> f64,
    pub(crate) contact: Contact,
}

impl Ball {
    /// The acceleration that the floor gives to a ball of the COR `e` that is below it.
    fn pushed(&self, e: f64, h: f64, v: f64) -> f64 {
        match self.contact {
            Contact::Instant => 0.0,
            Contact::Spring(lasts) => {
                let (turns, damps) = (PI / lasts, -e.ln() / lasts);
                -(turns * turns + damps * damps) * h - 2.0 * damps * v
            }
            Contact::Solid(lasts) => {
                // Of a ball that comes at v the depth is v T/2.94, and then v²/2 = (2/5) K
                // depth^(5/2).
                let stiffness = 20.0 / (4.0 * lasts / 2.94).powf(2.5);
                stiffness * (-h).powf(1.5) * if v < 0.0 { 1.0 } else { e * e }
            }
        }
    }

    /// Heights at `rate` samples per second, held until the release.
    pub(crate) fn film(&self, rate: f64, seconds: f64) -> Vec<(f64, f64)> {
        self.watched(rate, seconds).0
    }

    /// The same, and the COR of every impact: the ratio of the speeds at which the ball leaves and
    /// comes.
    pub(crate) fn watched(&self, rate: f64, seconds: f64) -> (Vec<(f64, f64)>, Vec<f64>) {
        let dt = 2e-6;
        let (mut t, mut h, mut v) = (self.release, self.drop, 0.0f64);
        let (mut came, mut cors) = (0.0, Vec::new());
        let e = (self.cor)(1.0);
        let mut frame = |at: f64| {
            while t < at {
                if h < 0.0 {
                    // Speed first: this keeps the energy of a spring.
                    v += dt * (self.pushed(e, h, v) - self.gravity);
                    h += dt * v;
                    if h >= 0.0 {
                        cors.push(v / came);
                    }
                } else {
                    let a = -self.gravity - self.drag * v * v.abs();
                    let next = h + dt * (v + 0.5 * dt * a);
                    v += dt * a;
                    if next <= 0.0 && v < 0.0 {
                        came = -v;
                    }
                    if self.contact == Contact::Instant && next <= 0.0 && v < 0.0 {
                        v *= -(self.cor)(-v);
                        h = 0.0;
                        cors.push(v / came);
                    } else {
                        h = next;
                    }
                }
                t += dt;
            }
            (at, h)
        };
        let heights = (0..(rate * seconds) as usize).map(|n| frame(n as f64 / rate)).collect();
        (heights, cors)
    }
}

pub(crate) fn csv(rows: &[(f64, f64)]) -> String {
    rows.iter().fold("time_s,height_m\n".to_owned(), |text, (t, h)| text + &format!("{t:.6},{h:.6}\n"))
}

pub(crate) fn report(text: &str) -> Report {
    let table = Table::parse("film.csv", text.as_bytes(), &ReadOptions::default()).expect("a table");
    Fit::new().run(&table).expect("a report")
}

pub(crate) fn noisy(rows: &[(f64, f64)], noise: &mut Noise, sigma: f64) -> Vec<(f64, f64)> {
    rows.iter().map(|&(t, h)| (t, h + noise.normal(sigma))).collect()
}
