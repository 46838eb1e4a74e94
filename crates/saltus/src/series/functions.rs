//! The elementary functions of a series.

use super::jet::{Jet, convolved, product, squared, weighted};

/// Each with the recurrence that it comes from; where a function has no series (√a at a = 0),
/// neither has the solution, and steps are taken there.
impl Jet<'_> {
    /// 1/a.
    #[inline]
    #[must_use]
    pub fn recip(self) -> Self {
        1.0 / self
    }

    /// aⁿ.
    #[inline]
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        let (mut power, mut base, mut left) = (None, self, n.unsigned_abs());
        while left > 0 {
            if left % 2 == 1 {
                power = Some(power.map_or(base, |power| power * base));
            }
            left /= 2;
            if left > 0 {
                base = base.square();
            }
        }
        let power = power.unwrap_or_else(|| 1.0.into());
        if n < 0 { power.recip() } else { power }
    }

    /// a^p, from a c' = p c a'.
    #[inline]
    #[must_use]
    pub fn powf(self, p: f64) -> Self {
        self.function(
            |a| a.powf(p),
            |k, a, c| {
                if k == 0 {
                    return a[0].get().powf(p);
                }
                let terms = c[..k].iter().zip(a[1..=k].iter().rev()).enumerate();
                let sum: f64 = terms.map(|(j, (c, a))| (k as f64 * p - j as f64 * (p + 1.0)) * c.get() * a.get()).sum();
                sum / (k as f64 * a[0].get())
            },
        )
    }

    /// √a, from c c = a.
    #[inline]
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.function(f64::sqrt, |k, a, c| {
            if k == 0 {
                return a[0].get().sqrt();
            }
            (a[k].get() - convolved(&c[1..k], &c[1..k])) / (2.0 * c[0].get())
        })
    }

    /// The exponential, from c' = c a'.
    #[inline]
    #[must_use]
    pub fn exp(self) -> Self {
        self.function(f64::exp, |k, a, c| if k == 0 { a[0].get().exp() } else { weighted(a, c, k, k) / k as f64 })
    }

    /// The natural logarithm, from a c' = a'.
    #[inline]
    #[must_use]
    pub fn ln(self) -> Self {
        self.function(f64::ln, |k, a, c| {
            if k == 0 {
                return a[0].get().ln();
            }
            (a[k].get() - weighted(c, a, k - 1, k) / k as f64) / a[0].get()
        })
    }

    /// The sine and the cosine together, from s' = c a' and c' = -s a'.
    #[inline]
    #[must_use]
    pub fn sin_cos(self) -> (Self, Self) {
        // Each needs the other's lower coefficients only; at its turn the cosine's row, the next
        // one, holds those of the passes before.
        let sine = self.function(f64::sin, |_, _, _| 0.0);
        let cosine = self.function(f64::cos, |_, _, _| 0.0);
        sine.together(cosine, self, |k, a, s, c| {
            if k == 0 {
                return a[0].get().sin_cos();
            }
            (weighted(a, c, k, k) / k as f64, -weighted(a, s, k, k) / k as f64)
        });
        (sine, cosine)
    }

    /// The sine.
    #[inline]
    #[must_use]
    pub fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// The cosine.
    #[inline]
    #[must_use]
    pub fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// The tangent.
    #[inline]
    #[must_use]
    pub fn tan(self) -> Self {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }

    /// The inverse of the tangent, from (1 + a²) c' = a'.
    #[inline]
    #[must_use]
    pub fn atan(self) -> Self {
        let result = self.function(f64::atan, |_, _, _| 0.0);
        let below = self.function(|_| 1.0, |k, a, _| squared(a, k) + if k == 0 { 1.0 } else { 0.0 });
        result.together(below, self, |k, a, c, w| {
            let next = match k {
                0 => a[0].get().atan(),
                _ => (a[k].get() - weighted(c, w, k - 1, k) / k as f64) / w[0].get(),
            };
            (next, w[k].get())
        });
        result
    }

    /// The hyperbolic tangent, from c' = (1 - c²) a'.
    #[inline]
    #[must_use]
    pub fn tanh(self) -> Self {
        let result = self.function(f64::tanh, |_, _, _| 0.0);
        let slope = self.function(|_| 1.0, |_, _, _| 0.0);
        result.together(slope, self, |k, a, c, w| {
            let next = if k == 0 { a[0].get().tanh() } else { weighted(a, w, k, k) / k as f64 };
            c[k].set(next);
            (next, if k == 0 { 1.0 - next * next } else { -product(c, c, k) })
        });
        result
    }
}
