//! Whether the derivatives that a model gives of its surface are those that differences show.

use std::fmt;

use super::TwoSided;
use crate::state::State;

/// A difference quotient and a derivative are one if they differ by no more than this part: far
/// more than a difference over a small step is off, and less than a mistake makes.
const ALIKE: f64 = 1e-3;

/// The middle one of the steps over which differences are taken, as a part of a coordinate or of
/// the time; in its unit where that is zero.
const MIDDLE: f64 = 1.0 / (1_u64 << 26) as f64;

/// So many steps, each four times the one before, are tried about the middle one.
const STEPS: i32 = 25;

/// A derivative of h that its differences contradict.
pub(super) struct Untrue {
    /// The coordinate by which it is; none for the time.
    by: Option<String>,
    given: f64,
    shown: f64,
}

impl fmt::Display for Untrue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { by, given, shown } = self;
        match by {
            None => write!(
                f,
                "∂h/∂t is {given} by TwoSided::surface_rate, and differences of the surface show {shown:.6}: a surface that moves says how fast (Sides::moving)"
            ),
            Some(name) => write!(
                f,
                "∂h/∂{name} is {given} by TwoSided::normal, and differences of the surface show {shown:.6}: give the gradient of the surface itself"
            ),
        }
    }
}

/// The first derivative of the surface at (t, x) that its differences contradict.
///
/// Only what is sure counts: differences to both sides, each a thousand times their rounding, agree
/// with each other over three steps in a row, and with the derivative over no two. A kink, a leap
/// or a rounding hides what they show, and is believed.
pub(super) fn untrue<T: TwoSided + ?Sized>(system: &T, t: f64, x: &T::State) -> Option<Untrue> {
    let moved = |i: usize, by: f64| x.with(|j| if j == i { x.get(j) + by } else { x.get(j) });
    let rate = system.surface_rate(t, x);
    if let Some(shown) = contradicted(|by| system.surface(t + by, x), t, rate) {
        return Some(Untrue { by: None, given: rate, shown });
    }
    let normal = system.normal(t, x);
    (0..x.len()).find_map(|i| {
        let shown = contradicted(|by| system.surface(t, &moved(i, by)), x.get(i), normal.get(i))?;
        Some(Untrue { by: Some(x.name(i).into_owned()), given: normal.get(i), shown })
    })
}

/// The slope of `h` that its differences show about zero, where that is not the one `given`.
fn contradicted(h: impl Fn(f64) -> f64, size: f64, given: f64) -> Option<f64> {
    let here = h(0.0);
    let middle = if size == 0.0 { MIDDLE } else { size.abs() * MIDDLE };
    let step = |k: i32| middle * 4_f64.powi(k);
    let differences = |step: f64| [h(step) - here, here - h(-step)];
    let agrees = |step: f64, all: &[f64; 2]| all.iter().any(|difference| alike(difference / step, given));
    if agrees(step(0), &differences(step(0))) {
        return None;
    }
    let all: Vec<(f64, [f64; 2])> = (-STEPS / 2..=STEPS / 2).map(step).map(|step| (step, differences(step))).collect();
    // Over one small step rounding may show anything, and nothing over several.
    if given != 0.0 && all.windows(2).any(|two| two.iter().all(|(step, all)| agrees(*step, all))) {
        return None;
    }
    // The least of them is a rounding of h, or more: a multiple of it tells a slope as well as it
    // is large.
    let sizes = || all.iter().flat_map(|(_, all)| all).map(|difference| difference.abs());
    let least = sizes().filter(|size| *size > 0.0).fold(f64::INFINITY, f64::min);
    let tells = |difference: f64| difference.abs() * ALIKE >= least;
    let stable = |window: &&[(f64, [f64; 2])]| {
        let (step, [first, _]) = window[0];
        let slopes = window.iter().flat_map(|(step, all)| all.map(|difference| difference / step));
        window.iter().flat_map(|(_, all)| all).all(|difference| tells(*difference))
            && slopes.into_iter().all(|slope| alike(slope, first / step))
    };
    all.windows(3).find(stable).map(|window| window[1].1[0] / window[1].0)
}

fn alike(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= ALIKE * a.abs().max(b.abs())
}
