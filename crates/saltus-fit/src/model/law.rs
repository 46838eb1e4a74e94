//! How the COR may depend on the bounce, or on the speed of impact.

use super::dual::{Dual, Slopes};
use super::problem::Bounds;
use crate::elementary::{ln, powf};

/// A law for the COR. Speeds are in m/s; beyond the range of speeds it was made for, a law is
/// continued.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) enum CorLaw {
    /// One COR.
    #[default]
    Constant,
    /// A COR for each of so many bounces, the last for all later ones.
    Each(usize),
    /// A straight line; unknown are its values at these two speeds.
    Linear { low: f64, high: f64 },
    /// A viscoelastic sphere; unknown is √(β v^(1/5)) at this speed, from which all coefficients of
    /// the series follow.
    Viscoelastic { high: f64 },
    /// e = C (v/v₀)^(−1/4), at most 1; unknown is C.
    Plastic { middle: f64 },
    /// e = C (v/v₀)^(−p), at most 1; unknown are C and p.
    Power { middle: f64 },
    /// Straight lines between these ascending speeds, never rising; unknown are the COR at the
    /// first, and at each of the others the part of the one before that is left. So every bound is
    /// one of a single unknown.
    Knots(Vec<f64>),
}

/// The COR is kept above this: at zero there would be no next flight.
const LEAST: f64 = 1e-6;
/// The Padé approximant of Müller and Pöschel (Phys. Rev. E 84, 021302, 2011), whose series has
/// γ₂ = (3/5) γ₁².
const PADE: [f64; 4] = [0.501_086, 1.153_45, 0.577_977, 0.532_178];
/// With more the Padé approximant is below 0.02.
const SOFTEST: f64 = 4.0;

impl CorLaw {
    /// How many unknowns it has.
    pub(crate) fn unknowns(&self) -> usize {
        match self {
            Self::Constant | Self::Viscoelastic { .. } | Self::Plastic { .. } => 1,
            Self::Linear { .. } | Self::Power { .. } => 2,
            Self::Each(n) => *n,
            Self::Knots(speeds) => speeds.len(),
        }
    }

    /// Whether the COR depends on the speed.
    pub(crate) fn of_speed(&self) -> bool {
        !matches!(self, Self::Constant | Self::Each(_))
    }

    /// For each unknown its range, and how far one step may move it.
    pub(crate) fn ranges(&self) -> Vec<(Bounds, f64)> {
        let unit = (Bounds { low: 0.0, high: 1.0 }, 0.1);
        match self {
            Self::Constant | Self::Each(_) => vec![(Bounds { low: LEAST, high: 2.0 }, 0.1); self.unknowns()],
            Self::Viscoelastic { .. } => vec![(Bounds { low: 0.0, high: SOFTEST }, 0.2)],
            _ => vec![unit; self.unknowns()],
        }
    }

    /// Unknowns that give about the same COR at all speeds.
    pub(crate) fn start(&self, e: f64) -> Vec<f64> {
        match self {
            Self::Viscoelastic { .. } => vec![((1.0 - e).max(0.01) / e.max(0.05)).sqrt().min(SOFTEST / 2.0)],
            Self::Power { .. } => vec![e, 0.02],
            // Away from the bound of a COR that does not change.
            Self::Knots(speeds) => (0..speeds.len()).map(|k| if k == 0 { e.min(0.99) } else { 0.98 }).collect(),
            _ => vec![e; self.unknowns()],
        }
    }

    /// The COR of bounce `n` (from 0) at a speed: its value, its derivative by the speed, those by
    /// the unknowns.
    pub(crate) fn at(&self, n: usize, speed: f64, unknowns: &[f64]) -> (f64, f64, Slopes) {
        let mut by = Slopes::from_elem(0.0, unknowns.len());
        let (value, slope) = match self {
            Self::Constant | Self::Each(_) => {
                let which = n.min(unknowns.len() - 1);
                by[which] = 1.0;
                return (unknowns[which], 0.0, by);
            }
            Self::Linear { low, high } => {
                let part = (speed - low) / (high - low);
                (by[0], by[1]) = (1.0 - part, part);
                (unknowns[0] * by[0] + unknowns[1] * by[1], (unknowns[1] - unknowns[0]) / (high - low))
            }
            Self::Viscoelastic { high } => {
                let root = powf(speed / high, 0.1);
                let (value, slope) = pade(unknowns[0] * root);
                by[0] = slope * root;
                (value, slope * unknowns[0] * root * 0.1 / speed)
            }
            Self::Plastic { middle } => {
                by[0] = powf(speed / middle, -0.25);
                (unknowns[0] * by[0], -0.25 * unknowns[0] * by[0] / speed)
            }
            Self::Power { middle } => {
                by[0] = powf(speed / middle, -unknowns[1]);
                let value = unknowns[0] * by[0];
                by[1] = -value * ln(speed / middle);
                (value, -unknowns[1] * value / speed)
            }
            Self::Knots(speeds) => knots(speeds, speed, unknowns, &mut by),
        };
        if (LEAST..=1.0).contains(&value) && value.is_finite() {
            (value, slope, by)
        } else {
            // A reading that wants more than the law can give does not move it.
            by.fill(0.0);
            (value.clamp(LEAST, 1.0), 0.0, by)
        }
    }

    /// The COR of bounce `n` with derivatives by all unknowns of a fit; those of the law begin at
    /// `first`.
    pub(crate) fn through(&self, n: usize, speed: &Dual, unknowns: &[f64], first: usize) -> Dual {
        let (value, slope, own) = self.at(n, speed.value, unknowns);
        let mut cor = speed.mapped(value, slope);
        cor.by[first..].iter_mut().zip(&own).for_each(|(by, d)| *by += d);
        cor
    }
}

/// (1 + a x)/(1 + a x + b x² + c x³ + d x⁴) and its derivative.
fn pade(x: f64) -> (f64, f64) {
    let [a, b, c, d] = PADE;
    let top = 1.0 + a * x;
    let rest = x * x * (b + x * (c + x * d));
    let bottom = top + rest;
    let rest_slope = x * (2.0 * b + x * (3.0 * c + x * 4.0 * d));
    (top / bottom, (a * rest - top * rest_slope) / (bottom * bottom))
}

/// Value and slope of the lines between knots; fills the derivatives by the unknowns.
fn knots(speeds: &[f64], speed: f64, unknowns: &[f64], by: &mut [f64]) -> (f64, f64) {
    let above = speeds.partition_point(|s| *s <= speed).clamp(1, speeds.len() - 1);
    let (low, high) = (speeds[above - 1], speeds[above]);
    let part = ((speed - low) / (high - low)).clamp(0.0, 1.0);
    let left: f64 = unknowns[..above].iter().product();
    let value = left * (1.0 - part + part * unknowns[above]);
    for (j, by) in by.iter_mut().enumerate().take(above) {
        let others: f64 = (0..above).filter(|&i| i != j).map(|i| unknowns[i]).product();
        *by = others * (1.0 - part + part * unknowns[above]);
    }
    by[above] = left * part;
    let inside = (low..=high).contains(&speed);
    (value, if inside { left * (unknowns[above] - 1.0) / (high - low) } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use saltus_bounce::restitution::{Cor, Plastic, Viscoelastic};

    use super::*;

    #[test]
    fn derivatives_are_those_of_the_values() {
        let laws = [
            (CorLaw::Linear { low: 1.0, high: 4.0 }, vec![0.9, 0.7]),
            (CorLaw::Viscoelastic { high: 4.0 }, vec![0.5]),
            (CorLaw::Plastic { middle: 2.0 }, vec![0.6]),
            (CorLaw::Power { middle: 2.0 }, vec![0.6, 0.15]),
            (CorLaw::Knots(vec![1.0, 1.6, 2.5, 4.0]), vec![0.9, 0.95, 0.9, 0.97]),
        ];
        for (law, unknowns) in laws {
            assert_eq!(law.unknowns(), unknowns.len());
            for speed in [1.1, 2.0, 3.7] {
                let (_, slope, by) = law.at(0, speed, &unknowns);
                let step = 1e-6;
                let numeric =
                    (law.at(0, speed + step, &unknowns).0 - law.at(0, speed - step, &unknowns).0) / (2.0 * step);
                assert!((numeric - slope).abs() < 1e-8, "{law:?} at {speed}: {numeric} {slope}");
                for j in 0..unknowns.len() {
                    let (mut less, mut more) = (unknowns.clone(), unknowns.clone());
                    less[j] -= step;
                    more[j] += step;
                    let numeric = (law.at(0, speed, &more).0 - law.at(0, speed, &less).0) / (2.0 * step);
                    assert!((numeric - by[j]).abs() < 1e-8, "{law:?} by {j} at {speed}: {numeric} {}", by[j]);
                }
            }
        }
    }

    #[test]
    fn the_laws_are_those_of_the_simulator() {
        let (sphere, steel) = (
            Viscoelastic::through(Cor::new(0.7).unwrap(), 4.0).unwrap(),
            Plastic::through(Cor::new(0.6).unwrap(), 2.0).unwrap(),
        );
        // The unknown that gives 0.7 at 4 m/s, by halving.
        let (mut low, mut high) = (0.0, SOFTEST);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if pade(middle).0 > 0.7 { low = middle } else { high = middle }
        }
        for speed in [0.1, 1.0, 3.0, 10.0] {
            let ours = CorLaw::Viscoelastic { high: 4.0 }.at(0, speed, &[low]).0;
            assert!((ours - sphere.cor(speed).value()).abs() < 1e-12);
            let ours = CorLaw::Plastic { middle: 2.0 }.at(0, speed, &[0.6]).0;
            assert!((ours - steel.cor(speed).value()).abs() < 1e-12);
        }
    }

    #[test]
    fn knots_never_rise_and_stay_between_nought_and_one() {
        let law = CorLaw::Knots(vec![1.0, 2.0, 4.0]);
        let mut last = 1.0;
        for speed in 0..60 {
            let e = law.at(0, 0.1 * f64::from(speed), &[1.0, 0.8, 0.0]).0;
            assert!(e <= last && e >= LEAST);
            last = e;
        }
        assert!((law.at(0, 3.0, &[1.0, 0.8, 0.5]).0 - 0.6).abs() < 1e-15);
    }
}
