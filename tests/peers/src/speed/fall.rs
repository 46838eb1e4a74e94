//! What a user writes by hand for a solver without events of its own: the fall of a guard within a
//! step.

/// Where `g` falls through zero in (a, b], if g(b) < 0. A zero at `a` is taken for the crossing
/// that has just been made.
///
/// Halving until the left end is positive, then regula falsi in its Illinois form.
pub fn fall(mut g: impl FnMut(f64) -> f64, a: f64, b: f64, end: f64) -> f64 {
    let (mut lo, mut hi) = (a, b);
    let (mut above, mut below) = (g(a), end);
    for _ in 0..60 {
        if above > 0.0 {
            break;
        }
        let middle = 0.5 * (lo + hi);
        let value = g(middle);
        if value < 0.0 { (hi, below) = (middle, value) } else { (lo, above) = (middle, value) }
    }
    let mut side = 0;
    for _ in 0..60 {
        if hi - lo <= 2.0 * f64::EPSILON * hi.abs() || above == 0.0 {
            return lo;
        }
        let middle = (lo * below - hi * above) / (below - above);
        if !(middle > lo && middle < hi) {
            return middle;
        }
        let value = g(middle);
        if value < 0.0 {
            (hi, below) = (middle, value);
            above *= if side < 0 { 0.5 } else { 1.0 };
            side = -1;
        } else {
            (lo, above) = (middle, value);
            below *= if side > 0 { 0.5 } else { 1.0 };
            side = 1;
        }
    }
    lo
}
