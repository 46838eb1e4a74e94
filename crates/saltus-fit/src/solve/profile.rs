//! The cost as one unknown is held at other values: its shape over the COR, and limits, where a
//! bound holds an unknown and no covariance speaks for it.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::least_squares::Failure;
use super::successive::{Fitted, fit};
use crate::model::{Bounds, Model};
use crate::quantity::{Measured, Method};

/// One-sided, 95 %: the square of the 95 % point of the normal distribution, 1.645.
pub(crate) const ONE_SIDED: f64 = 2.705_543_454_095_404;
/// So many distances are tried at most.
const TRIES: usize = 60;
/// The limit is found to this part of its distance from the bound, or of the growth of the cost.
const FINE: f64 = 1e-4;

/// How the cost of a method grows as the COR is held away from its best, all else fitted anew.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Profile {
    /// That of its estimate: heights, times, or both together.
    pub method: Method,
    /// From the least COR to the greatest.
    pub points: Vec<ProfilePoint>,
}

/// The cost at one COR.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ProfilePoint {
    /// The COR that is held, without unit.
    pub cor: f64,
    /// The least sum of squared residuals, each divided by its standard error.
    pub chi_square: f64,
}

/// A profile has so many points.
const POINTS: u32 = 121;
/// It reaches so many standard errors to both sides of the best, and this far at least.
const REACH: f64 = 6.0;
const LEAST_REACH: f64 = 0.01;

impl Profile {
    /// Around the best COR and its standard error, of a model whose first shared unknown is what
    /// `of` makes of the COR. What cannot be fitted is left out.
    pub(crate) fn of<M: Model>(
        method: Method,
        model: &M,
        at: &Fitted,
        best: Measured,
        of: impl Fn(f64) -> f64,
    ) -> Self {
        let reach = (REACH * best.standard_error).max(LEAST_REACH);
        let (low, high) = ((best.value - reach).max(1e-3), (best.value + reach).min(2.0));
        let point = |k: u32| {
            let cor = low + (high - low) * f64::from(k) / f64::from(POINTS - 1);
            let chi_square = held(model, at, 0, of(cor)).ok()?.chi_square;
            chi_square.is_finite().then_some(ProfilePoint { cor, chi_square })
        };
        Self { method, points: (0..POINTS).filter_map(point).collect() }
    }
}

/// A model with one shared unknown held at a value.
struct Held<'a, M> {
    model: &'a M,
    place: usize,
    value: f64,
}

impl<M: Model> Held<'_, M> {
    fn all(&self, others: &[f64]) -> Vec<f64> {
        let mut all = others.to_vec();
        all.insert(self.place, self.value);
        all
    }
}

impl<M: Model> Model for Held<'_, M> {
    fn supposed(&self) -> bool {
        true
    }

    fn ranges(&self) -> Vec<(Bounds, f64)> {
        let mut ranges = self.model.ranges();
        ranges.remove(self.place);
        ranges
    }

    fn size(&self, block: usize) -> (usize, usize) {
        self.model.size(block)
    }

    fn fill(&self, block: usize, shared: &[f64], own: &[f64], rows: &mut DMatrix<f64>) {
        let mut whole = DMatrix::zeros(rows.nrows(), rows.ncols() + 1);
        self.model.fill(block, &self.all(shared), own, &mut whole);
        rows.copy_from(&whole.remove_column(own.len() + self.place));
    }
}

/// The least cost with an unknown held at a value, all others free.
pub(crate) fn held<M: Model>(model: &M, at: &Fitted, place: usize, value: f64) -> Result<Fitted, Failure> {
    let mut others = at.shared.clone();
    others.remove(place);
    fit(&Held { model, place, value }, &others, at.own.clone())
}

/// How far a shared unknown may be from the bound that holds it until the cost has grown by 2.71;
/// the other end of its range, if it never does.
///
/// The cost grows by about a s + b s² over a distance s: two costs on the way give a and b, and
/// they the next distance to try.
pub(crate) fn limit<M: Model>(model: &M, at: &Fitted, place: usize) -> Result<f64, Failure> {
    let (bounds, reach) = model.ranges()[place];
    let here = at.shared[place];
    let (far, sign) = if here - bounds.low < bounds.high - here { (bounds.high, 1.0) } else { (bounds.low, -1.0) };
    let mut nearest = at.clone();
    let mut growth = |s: f64| -> Result<f64, Failure> {
        let value = here + sign * s;
        match held(model, &nearest, place, value) {
            Ok(mut found) => {
                let growth = found.chi_square - at.chi_square;
                if growth <= ONE_SIDED {
                    found.shared.insert(place, value);
                    nearest = found;
                }
                Ok(growth)
            }
            // Where the model has no value there is nothing that the readings would allow.
            Err(Failure::Malformed | Failure::NotIdentified) => Ok(f64::INFINITY),
            Err(failure) => Err(failure),
        }
    };
    // Small steps first: the cost is steep where the readings are good.
    let whole = (far - here).abs();
    let (mut inside, mut outside) = ([0.0, 0.0], None);
    let mut next = 1e-3 * reach.min(1.0);
    for _ in 0..TRIES {
        let s = next.min(whole);
        let grown = growth(s)?;
        if (grown - ONE_SIDED).abs() <= FINE * ONE_SIDED {
            return Ok(here + sign * s);
        }
        if grown < ONE_SIDED {
            inside = [s, grown];
            if s >= whole {
                return Ok(far);
            }
        } else {
            outside = Some([s, grown]);
        }
        next = match outside {
            None => s * (ONE_SIDED / grown.max(1e-9)).sqrt().clamp(2.0, 32.0),
            Some(outside) => {
                let wide = outside[0] - inside[0];
                if wide <= FINE * outside[0] {
                    break;
                }
                between(inside, outside).clamp(inside[0] + 1e-3 * wide, outside[0] - 1e-3 * wide)
            }
        };
    }
    Ok(here + sign * inside[0])
}

/// Where a s + b s² through two distances and their growths is 2.71; the middle between them where
/// that is nowhere.
fn between(inside: [f64; 2], outside: [f64; 2]) -> f64 {
    let slope = |[s, grown]: [f64; 2]| grown / s;
    let (a, b) = if inside[0] > 0.0 {
        let b = (slope(outside) - slope(inside)) / (outside[0] - inside[0]);
        (slope(inside) - b * inside[0], b)
    } else {
        (0.0, slope(outside) / outside[0])
    };
    let s = 2.0 * ONE_SIDED / (a + (a * a + 4.0 * b * ONE_SIDED).sqrt());
    if s > inside[0] && s < outside[0] { s } else { 0.5 * (inside[0] + outside[0]) }
}
