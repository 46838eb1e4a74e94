//! Restitution measured at several speeds: straight lines between knots.

use std::fmt;

use super::{Cor, Restitution};

/// e(v) by straight lines between up to [`Knots::MOST`] measured points (v, e), constant below the
/// first and above the last.
///
/// v: speed of impact in m/s. One knot is a constant.
///
/// ```
/// use saltus_bounce::restitution::{Cor, Knots, Restitution};
/// let law = Knots::new(&[(2.0, Cor::new(0.78)?), (4.0, Cor::new(0.72)?), (10.0, Cor::new(0.6)?)])?;
/// assert!((law.cor(3.0).value() - 0.75).abs() < 1e-15);
/// assert_eq!(law.cor(50.0).value(), 0.6);
/// assert_eq!(law.rebound(1.0), 0.78);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knots {
    knots: [(f64, f64); Self::MOST],
    count: usize,
}

impl Knots {
    /// The most knots that a law holds.
    pub const MOST: usize = 16;

    /// The law through `knots`, each a speed in m/s and the coefficient there, by increasing speed.
    ///
    /// # Errors
    /// [`KnotsError`] for no knots or too many, a speed that is negative or not finite, or speeds
    /// that do not increase.
    pub fn new(knots: &[(f64, Cor)]) -> Result<Self, KnotsError> {
        if knots.is_empty() || knots.len() > Self::MOST {
            return Err(KnotsError::Count(knots.len()));
        }
        let mut law = Self { knots: [(0.0, 0.0); Self::MOST], count: knots.len() };
        for (n, &(speed, cor)) in knots.iter().enumerate() {
            if !(speed.is_finite() && speed >= 0.0) {
                return Err(KnotsError::Speed { knot: n + 1, speed });
            }
            if n > 0 && speed <= knots[n - 1].0 {
                return Err(KnotsError::Order { knot: n + 1, speed, last: knots[n - 1].0 });
            }
            law.knots[n] = (speed, cor.value());
        }
        Ok(law)
    }

    /// e at the speed `impact` in m/s.
    #[must_use]
    pub fn cor(&self, impact: f64) -> Cor {
        let knots = &self.knots[..self.count];
        let above = knots.partition_point(|&(speed, _)| speed < impact);
        Cor::within(if above == 0 {
            knots[0].1
        } else if above == self.count {
            knots[above - 1].1
        } else {
            let ((v, e), (w, f)) = (knots[above - 1], knots[above]);
            e + (f - e) * ((impact - v) / (w - v))
        })
    }
}

impl Restitution for Knots {
    #[inline]
    fn rebound(&self, impact: f64) -> f64 {
        self.cor(impact).rebound(impact)
    }
}

/// Knots that make no law.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum KnotsError {
    /// No knots, or too many.
    Count(usize),
    /// A speed that is negative or not finite.
    Speed {
        /// The number of the knot, counted from 1.
        knot: usize,
        /// The speed of this knot in m/s.
        speed: f64,
    },
    /// A speed that is not above the one before.
    Order {
        /// The number of the knot, counted from 1.
        knot: usize,
        /// The speed of this knot in m/s.
        speed: f64,
        /// The speed of the knot before in m/s.
        last: f64,
    },
}

impl fmt::Display for KnotsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count(0) => write!(f, "no knots: give at least one speed with its coefficient of restitution"),
            Self::Count(n) => write!(f, "{n} knots are too many: give at most {}", Knots::MOST),
            Self::Speed { knot, speed } => {
                write!(f, "knot {knot}: {speed} is not a speed in m/s: give a finite number, zero or more")
            }
            Self::Order { knot, speed, last } => write!(
                f,
                "knot {knot}: its speed {speed} m/s is not above that of the knot before, {last} m/s: sort the knots by speed, each speed once"
            ),
        }
    }
}

impl std::error::Error for KnotsError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knots_are_met_and_bad_ones_refused() {
        let e = |e| Cor::new(e).unwrap();
        let law = Knots::new(&[(0.0, e(1.0)), (1.0, e(0.25)), (3.0, e(0.75))]).unwrap();
        assert_eq!([0.0, 0.5, 1.0, 2.0, 3.0, 1e300].map(|v| law.cor(v).value()), [1.0, 0.625, 0.25, 0.5, 0.75, 0.75]);
        for (knots, part) in [
            (vec![], "no knots"),
            (vec![(1.0, e(0.5)); 17], "17 knots are too many"),
            (vec![(-1.0, e(0.5))], "knot 1: -1 is not a speed"),
            (vec![(f64::NAN, e(0.5))], "knot 1: NaN is not a speed"),
            (vec![(1.0, e(0.5)), (1.0, e(0.6))], "knot 2: its speed 1 m/s is not above"),
        ] {
            let message = Knots::new(&knots).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
    }
}
