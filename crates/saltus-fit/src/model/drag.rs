//! One vertical flight in closed form, with quadratic drag or without, and its derivatives.
//!
//! Upwards v' = −G − k v², downwards v' = −G + k v². With ω = √(G k) and τ the time since the apex,
//! the ball is below its apex by −ln cos(ωτ)/k before it and ln cosh(ωτ)/k after it (any text on
//! vertical motion with drag proportional to v²). As k → 0 both become ½ G τ². A ball that leaves
//! the floor at v, with u = v √(k/G), rises ln(1 + u²)/(2k) in atan(u)/ω, falls in asinh(u)/ω, and
//! arrives at v/√(1 + u²).

use crate::elementary::{asinh, atan, atanh, cos, exp, exp_m1, ln, ln_1p, sinh, tan, tanh};

/// Gravity and drag: G (length/time²) and k (1/length); k = 0 is a parabola.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Air {
    pub(crate) gravity: f64,
    pub(crate) drag: f64,
}

/// A value with its derivatives by speed (or time since the apex), G and k.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sloped {
    pub(crate) value: f64,
    pub(crate) by: [f64; 3],
}

/// What becomes of a ball that leaves the floor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hop {
    /// The time up to the apex.
    pub(crate) rise: Sloped,
    /// The time down from it.
    pub(crate) fall: Sloped,
    /// The height of the apex above the floor.
    pub(crate) height: Sloped,
    /// The speed of arrival.
    pub(crate) arrival: Sloped,
}

impl Air {
    /// How far below its apex the ball is at time τ after (or, negative, before) it; derivatives by
    /// τ, G, k.
    pub(crate) fn drop(self, tau: f64) -> Sloped {
        let Self { gravity: g, drag: k } = self;
        if k <= 0.0 {
            return Sloped { value: 0.5 * g * tau * tau, by: [g * tau, 0.5 * tau * tau, 0.0] };
        }
        let omega = (g * k).sqrt();
        let x = omega * tau;
        let (log, slope) = if x >= 0.0 { (0.5 * ln_1p(sinh(x).powi(2)), tanh(x)) } else { (-ln(cos(x)), tan(x)) };
        // sinh overflows long before its logarithm does.
        let log = if x > 300.0 { x - std::f64::consts::LN_2 } else { log };
        Sloped { value: log / k, by: [omega * slope / k, slope * x / (2.0 * g * k), (0.5 * slope * x - log) / (k * k)] }
    }

    /// The flight of a ball that leaves the floor at `speed`; derivatives by speed, G, k.
    pub(crate) fn hop(self, speed: f64) -> Hop {
        let Self { gravity: g, drag: k } = self;
        if k <= 0.0 {
            let time = Sloped { value: speed / g, by: [1.0 / g, -speed / (g * g), 0.0] };
            let height =
                Sloped { value: 0.5 * speed * speed / g, by: [speed / g, -0.5 * (speed / g) * (speed / g), 0.0] };
            return Hop { rise: time, fall: time, height, arrival: Sloped { value: speed, by: [1.0, 0.0, 0.0] } };
        }
        let (omega, u) = ((g * k).sqrt(), speed * (k / g).sqrt());
        // du by speed, G, k.
        let du = [(k / g).sqrt(), -0.5 * u / g, 0.5 * u / k];
        let square = 1.0 + u * u;
        let over_omega = |x: f64, dx: f64| Sloped {
            value: x / omega,
            by: [dx * du[0] / omega, (dx * du[1] - 0.5 * x / g) / omega, (dx * du[2] - 0.5 * x / k) / omega],
        };
        let height = 0.5 * ln_1p(u * u) / k;
        let root = square.sqrt();
        let bend = -speed * u / (square * root);
        Hop {
            rise: over_omega(atan(u), 1.0 / square),
            fall: over_omega(asinh(u), 1.0 / root),
            height: Sloped {
                value: height,
                by: [u * du[0] / (square * k), u * du[1] / (square * k), u * du[2] / (square * k) - height / k],
            },
            arrival: Sloped { value: speed / root, by: [1.0 / root + bend * du[0], bend * du[1], bend * du[2]] },
        }
    }

    /// The speed after a fall from rest through `height`; derivatives by height, G, k.
    pub(crate) fn speed(self, height: f64) -> Sloped {
        let Self { gravity: g, drag: k } = self;
        if k <= 0.0 {
            let v = (2.0 * g * height).sqrt();
            return Sloped { value: v, by: [g / v.max(1e-12), height / v.max(1e-12), 0.0] };
        }
        // v² = (G/k) (1 − e^(−2kh)).
        let left = exp(-2.0 * k * height);
        let square = -(g / k) * exp_m1(-2.0 * k * height);
        let v = square.sqrt();
        let half = 0.5 / v.max(1e-12);
        Sloped {
            value: v,
            by: [half * 2.0 * g * left, half * square / g, half * (2.0 * g * height * left - square) / k],
        }
    }

    /// The apex from which a ball that arrives at `speed` has fallen: time since, height above;
    /// derivatives by speed, G, k.
    ///
    /// Not a number where the speed is beyond the terminal one.
    pub(crate) fn fallen(self, speed: f64) -> (Sloped, Sloped) {
        let Self { gravity: g, drag: k } = self;
        if k <= 0.0 {
            let hop = self.hop(speed);
            return (hop.fall, hop.height);
        }
        let (omega, w) = ((g * k).sqrt(), speed * (k / g).sqrt());
        let dw = [(k / g).sqrt(), -0.5 * w / g, 0.5 * w / k];
        let rest = 1.0 - w * w;
        let (x, dx) = (atanh(w), 1.0 / rest);
        let time = Sloped {
            value: x / omega,
            by: [dx * dw[0] / omega, (dx * dw[1] - 0.5 * x / g) / omega, (dx * dw[2] - 0.5 * x / k) / omega],
        };
        let height = -0.5 * ln_1p(-w * w) / k;
        let by = [w * dw[0] / (rest * k), w * dw[1] / (rest * k), w * dw[2] / (rest * k) - height / k];
        (time, Sloped { value: height, by })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn differences(value: impl Fn([f64; 3]) -> f64, at: [f64; 3], by: [f64; 3]) {
        for j in 0..3 {
            let step = 1e-6 * at[j].abs().max(1e-3);
            let mut near = [at, at];
            near[0][j] -= step;
            near[1][j] += step;
            let numeric = (value(near[1]) - value(near[0])) / (2.0 * step);
            assert!((numeric - by[j]).abs() < 1e-6 * (1.0 + numeric.abs()), "{j}: {numeric} {}", by[j]);
        }
    }

    fn air(x: [f64; 3]) -> Air {
        Air { gravity: x[1], drag: x[2] }
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        let at = [1.7, 9.81, 0.12];
        for tau in [-0.6, -0.1, 0.2, 1.3] {
            let at = [tau, 9.81, 0.12];
            differences(|x| air(x).drop(x[0]).value, at, air(at).drop(tau).by);
        }
        differences(|x| air(x).hop(x[0]).rise.value, at, air(at).hop(at[0]).rise.by);
        differences(|x| air(x).hop(x[0]).fall.value, at, air(at).hop(at[0]).fall.by);
        differences(|x| air(x).hop(x[0]).height.value, at, air(at).hop(at[0]).height.by);
        differences(|x| air(x).hop(x[0]).arrival.value, at, air(at).hop(at[0]).arrival.by);
        differences(|x| air(x).speed(x[0]).value, at, air(at).speed(at[0]).by);
        differences(|x| air(x).fallen(x[0]).0.value, at, air(at).fallen(at[0]).0.by);
        differences(|x| air(x).fallen(x[0]).1.value, at, air(at).fallen(at[0]).1.by);
    }

    #[test]
    fn a_hop_ends_where_its_drop_says() {
        let air = Air { gravity: 9.81, drag: 0.12 };
        let hop = air.hop(4.0);
        assert!((air.drop(hop.fall.value).value - hop.height.value).abs() < 1e-13);
        assert!((air.drop(-hop.rise.value).value - hop.height.value).abs() < 1e-13);
        let (time, height) = air.fallen(hop.arrival.value);
        assert!((time.value - hop.fall.value).abs() < 1e-13 && (height.value - hop.height.value).abs() < 1e-13);
    }

    #[test]
    fn little_drag_is_nearly_none() {
        let (none, little) = (Air { gravity: 9.81, drag: 0.0 }, Air { gravity: 9.81, drag: 1e-7 });
        assert!((none.hop(4.0).height.value - little.hop(4.0).height.value).abs() < 1e-6);
        assert!((none.drop(0.3).value - little.drop(0.3).value).abs() < 1e-6);
        // d(drop)/dk at k = 0 is −G² τ⁴/12.
        let exact = -9.81f64.powi(2) * 0.3f64.powi(4) / 12.0;
        assert!((little.drop(0.3).by[2] / exact - 1.0).abs() < 1e-5);
    }
}
