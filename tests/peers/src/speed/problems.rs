//! The problems and their exact answers.

use std::f64::consts::PI;

/// A ball under gravity and quadratic drag, a = -g - k |v| v, dropped from `height` in m, that
/// keeps the part `cor` of its speed.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    pub gravity: f64,
    pub drag: f64,
    pub height: f64,
    pub cor: f64,
    /// After how many impacts a run ends.
    pub impacts: usize,
}

/// P1: gravity only.
pub const VACUUM: Ball = Ball { gravity: 9.8, drag: 0.0, height: 1.0, cor: 0.8, impacts: 10 };
/// P2: quadratic drag.
pub const DRAG: Ball = Ball { gravity: 9.8, drag: 0.1, height: 10.0, cor: 0.9, impacts: 20 };

/// P3: the Arenstorf orbit, (x, y, x', y') in a frame that turns with Earth and Moon.
pub mod arenstorf {
    pub const MU: f64 = 0.012_277_471;
    pub const PERIOD: f64 = 17.065_216_560_157_964;
    pub const START: [f64; 4] = [0.994, 0.0, 0.0, -2.001_585_106_379_082_5];

    #[inline(always)]
    pub fn flow([x, y, u, v]: [f64; 4]) -> [f64; 4] {
        let (a, b) = (x + MU, x - (1.0 - MU));
        let (r, s) = (a * a + y * y, b * b + y * y);
        let (p, q) = ((1.0 - MU) / (r * r.sqrt()), MU / (s * s.sqrt()));
        [u, v, x + 2.0 * v - p * a - q * b, y - 2.0 * u - (p + q) * y]
    }
}

/// P4: Van der Pol's oscillator in the scaling of the IVP test set (F. Mazzia, C. Magherini,
/// release 2.4), problem VDPOLM.
pub mod van_der_pol {
    pub const MU: f64 = 1000.0;
    pub const END: f64 = 2000.0;
    pub const START: [f64; 2] = [2.0, 0.0];
    pub const EXACT: [f64; 2] = [1.706_167_732_170_483, -0.892_809_701_024_797_5e-3];

    #[inline(always)]
    pub fn flow([x, v]: [f64; 2]) -> [f64; 2] {
        [v, MU * (1.0 - x * x) * v - x]
    }

    /// The second row of the Jacobian; the first is (0, 1).
    #[inline(always)]
    pub fn slopes([x, v]: [f64; 2]) -> [f64; 2] {
        [-2.0 * MU * x * v - 1.0, MU * (1.0 - x * x)]
    }
}

/// P5: how many crossings of the oscillator.
pub const CROSSINGS: usize = 1000;

impl Ball {
    #[inline(always)]
    pub fn acceleration(&self, v: f64) -> f64 {
        -self.gravity - self.drag * v * v.abs()
    }

    /// The same where the sign of v is known: smooth.
    #[inline(always)]
    pub fn smooth(&self, rising: bool, v: f64) -> f64 {
        if rising { -self.gravity - self.drag * v * v } else { -self.gravity + self.drag * v * v }
    }

    /// Tells `impact` of the time and the speed before each impact, until it says stop. By the
    /// closed formulas, in compensated sums.
    pub fn closed(&self, mut impact: impl FnMut(f64, f64) -> bool) {
        let Self { gravity: g, drag: k, height, cor, .. } = *self;
        let (rate, limit) = ((g * k).sqrt(), (g / k).sqrt());
        let (mut t, mut rest, mut h) = (0.0_f64, 0.0, height);
        let mut rise = 0.0;
        loop {
            let (fall, speed) = if k > 0.0 {
                // t = acosh(exp(kh))/ω and v² = w² (1 - exp(-2kh)), without the cancellation in 1 -
                // exp
                let lost = -(-2.0 * k * h).exp_m1();
                let v = lost.sqrt();
                (v.atanh() / rate, limit * v)
            } else {
                let fall = (2.0 * h / g).sqrt();
                (fall, g * fall)
            };
            let step = rise + fall - rest;
            let sum = t + step;
            rest = (sum - t) - step;
            t = sum;
            if !impact(t, speed) {
                return;
            }
            let v = cor * speed;
            (h, rise) = if k > 0.0 {
                ((v / limit).powi(2).ln_1p() / (2.0 * k), (v / limit).atan() / rate)
            } else {
                (v * v / (2.0 * g), v / g)
            };
        }
    }

    fn error(&self, times: &[f64]) -> f64 {
        let (mut n, mut worst) = (0, 0.0_f64);
        if times.len() != self.impacts {
            return f64::INFINITY;
        }
        self.closed(|t, _| {
            worst = worst.max(gap(times[n], t));
            n += 1;
            n < self.impacts
        });
        worst
    }
}

/// |a - b|, infinite for what is not a number.
fn gap(a: f64, b: f64) -> f64 {
    let gap = (a - b).abs();
    if gap.is_nan() { f64::INFINITY } else { gap }
}

pub fn vacuum_error(times: &[f64]) -> f64 {
    VACUUM.error(times)
}

pub fn drag_error(times: &[f64]) -> f64 {
    DRAG.error(times)
}

/// The distance from the start after one period; `marks` are the time reached, x and y.
pub fn arenstorf_error(marks: &[f64]) -> f64 {
    match *marks {
        [t, x, y] if gap(t, arenstorf::PERIOD) < 1e-12 => gap((x - arenstorf::START[0]).hypot(y), 0.0),
        _ => f64::INFINITY,
    }
}

/// The larger of the two relative errors; `marks` are the time reached, x and v.
pub fn van_der_pol_error(marks: &[f64]) -> f64 {
    match *marks {
        [t, x, v] if gap(t, van_der_pol::END) < 1e-9 => {
            let [a, b] = van_der_pol::EXACT;
            gap(x / a, 1.0).max(gap(v / b, 1.0))
        }
        _ => f64::INFINITY,
    }
}

pub fn crossings_error(times: &[f64]) -> f64 {
    if times.len() != CROSSINGS {
        return f64::INFINITY;
    }
    let errors = times.iter().enumerate().map(|(k, &t)| gap(t, (k as f64 + 0.5) * PI));
    errors.fold(0.0, f64::max)
}
