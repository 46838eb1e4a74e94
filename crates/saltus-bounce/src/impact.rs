//! The impact of two bodies.

/// The velocities after an impact of `masses` at `velocities` along one axis, the second ahead of
/// the first, that approach at the speed `approach` and part at the speed `rebound`.
///
/// With the share μ of the lighter mass in the sum of both, the heavier one changes by μ (u + w),
/// where u = `approach` and w = `rebound`; the lighter one leaves it at exactly w. So momentum is
/// kept to the rounding of the heavier one's velocity, and the relative speed to its own, at every
/// mass ratio. Source: I. Newton, *Principia* (1687), scholium to the laws of motion.
pub(crate) fn impact(masses: [f64; 2], velocities: [f64; 2], approach: f64, rebound: f64) -> [f64; 2] {
    let ([m, n], [v, w]) = (masses, velocities);
    let change = approach + rebound;
    if m >= n {
        let heavy = v - change * (n / (m + n));
        [heavy, heavy + rebound]
    } else {
        let heavy = w + change * (m / (m + n));
        [heavy - rebound, heavy]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Momentum, and energy up to what restitution takes, at mass ratios up to 10¹² either way.
        #[test]
        fn momentum_and_energy(ratio in -12.0..12.0_f64, v in -10.0..10.0_f64, u in 0.0..20.0_f64, e in 0.0..=1.0_f64) {
            let masses = [1.0, 10.0_f64.powf(ratio)];
            let before = [v, v - u];
            let approach = before[0] - before[1];
            let after = impact(masses, before, approach, e * approach);
            let momentum = |v: [f64; 2]| masses[0] * v[0] + masses[1] * v[1];
            let size = masses[0] * before[0].abs().max(after[0].abs()) + masses[1] * before[1].abs().max(after[1].abs());
            prop_assert!((momentum(after) - momentum(before)).abs() <= 4.0 * f64::EPSILON * size);
            let energy = |v: [f64; 2]| 0.5 * (masses[0] * v[0] * v[0] + masses[1] * v[1] * v[1]);
            let lost = 0.5 * masses[0] * masses[1] / (masses[0] + masses[1]) * (1.0 - e * e) * u * u;
            let largest = energy(before).max(energy(after));
            prop_assert!((energy(before) - energy(after) - lost).abs() <= 1e-14 * largest);
        }
    }
}
