//! Tail probabilities and quantiles, with `None` where they mean nothing; medians and straight
//! lines.

use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor, StudentsT};

/// A fit less probable than this by chance is rejected.
pub(crate) const REJECT: f64 = 0.01;
/// From this many trials on, the spread between them sets the error.
pub(crate) const REPLICATED: usize = 5;
/// From this many degrees of freedom on, the scatter can stand for a reading error that nobody
/// stated.
pub(crate) const SCATTER: usize = 4;

/// A BIC, or a chi-square, this much less decides (Kass and Raftery, J. Am. Stat. Assoc. 90 (1995)
/// 773: strong evidence).
pub(crate) const CLEAR: f64 = 6.0;

/// This much less speaks for something, weakly; a model that is worse by more is out of the
/// question (Kass and Raftery).
pub(crate) const WEAK: f64 = 2.0;
/// Numbers further apart than so many standard errors differ: one chance in a hundred.
pub(crate) const SURELY: f64 = 2.576;
/// A reading so many standard errors from where it should be is none.
pub(crate) const FAR: f64 = 5.0;
/// So many readings, or trials, to spare tell a scatter that is compared with another one.
pub(crate) const SPARE: usize = 3;
/// From so many bounces, or trials, on a COR that changes along them shows.
pub(crate) const TREND: usize = 6;

/// The 97.5 % point of the normal distribution.
pub(crate) const NORMAL: f64 = 1.959_963_984_540_054;

/// The probability of a chi-square at least this large by chance.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn chi_square_p(chi_square: f64, freedom: usize) -> Option<f64> {
    if freedom == 0 || !chi_square.is_finite() || chi_square < 0.0 {
        return None;
    }
    let p = ChiSquared::new(freedom as f64).ok()?.sf(chi_square);
    p.is_finite().then_some(p.clamp(0.0, 1.0))
}

/// The 97.5 % point of Student's distribution.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn student(freedom: usize) -> f64 {
    if freedom == 0 || freedom > 10_000 {
        return NORMAL;
    }
    StudentsT::new(0.0, 1.0, freedom as f64).map_or(NORMAL, |t| t.inverse_cdf(0.975))
}

/// The probability of a ratio of variances at least this large by chance, on `above` over `below`
/// degrees of freedom; none of an infinite one, over no variance at all.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn variance_ratio_p(ratio: f64, above: usize, below: usize) -> Option<f64> {
    if above == 0 || below == 0 || ratio.is_nan() || ratio < 0.0 {
        return None;
    }
    if ratio.is_infinite() {
        return Some(0.0);
    }
    let p = FisherSnedecor::new(above as f64, below as f64).ok()?.sf(ratio);
    p.is_finite().then_some(p.clamp(0.0, 1.0))
}

/// The middle value (the mean of the two in the middle); `None` of nothing.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let n = values.len();
    let high = *values.get(n / 2)?;
    Some(if n % 2 == 1 { high } else { 0.5 * (values[n / 2 - 1] + high) })
}

/// So many readings tell how all are to be read, and what a change of all does to the COR; more
/// would only cost time.
pub(crate) const TELLING: usize = 1000;

/// Samples a second of the fastest films in use. What is sampled faster is a sound or a force,
/// whose times are as good as a contact is short, and not as the samples are close.
pub(crate) const FILMED: f64 = 1000.0;

/// Frame rates of cameras, 1/s; colour television's are a thousandth slower.
pub(crate) const RATES: [f64; 12] = [24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 90.0, 100.0, 120.0, 240.0, 480.0, 960.0];

/// The standard deviation of the rounding that these numbers share: to a decimal, or to frames of a
/// camera. A scatter that happens to be smaller claims too much.
pub(crate) fn rounding(values: &[f64]) -> f64 {
    let whole = |step: f64, off: f64| values.iter().all(|v| (v / step - (v / step).round()).abs() <= off / step);
    let decimals = [1.0, 0.1, 0.01, 0.001, 1e-4, 1e-5];
    let Some(written) = decimals.into_iter().find(|step| whole(*step, 1e-6 * step)) else { return 0.0 };
    // Numbers that were written to a decimal fall on frames by chance with the probability that the
    // decimal leaves each.
    let by_chance =
        |frame: f64| (1.02 * written / frame).min(1.0).powi(i32::try_from(values.len()).unwrap_or(i32::MAX) - 1);
    let rates = RATES.into_iter().flat_map(|rate| [rate, rate / 1.001]);
    let mut frames = rates.map(|rate| 1.0 / rate);
    let frame = frames.find(|frame| by_chance(*frame) < REJECT / RATES.len() as f64 && whole(*frame, 0.51 * written));
    frame.unwrap_or(0.0).max(written) / 12f64.sqrt()
}

/// A straight line y + b (x - x̄) through points.
pub(crate) struct Line {
    middle: (f64, f64),
    pub(crate) slope: f64,
    /// The weighted sum of squares about the points' mean, and what of it the line explains.
    pub(crate) all: f64,
    pub(crate) explained: f64,
}

impl Line {
    /// Through points of a weight, x and y, by weighted least squares.
    pub(crate) fn through(points: impl Iterator<Item = (f64, f64, f64)> + Clone) -> Self {
        let (weight, x, y) = points.clone().fold((0.0, 0.0, 0.0), |s, (w, x, y)| (s.0 + w, s.1 + w * x, s.2 + w * y));
        let middle = (x / weight, y / weight);
        let (square, product, all) = points.fold((0.0, 0.0, 0.0), |s, (w, x, y)| {
            let (x, y) = (x - middle.0, y - middle.1);
            (s.0 + w * x * x, s.1 + w * x * y, s.2 + w * y * y)
        });
        let slope = product / square;
        Self { middle, slope, all, explained: slope * product }
    }

    pub(crate) fn at(&self, x: f64) -> f64 {
        self.middle.1 + self.slope * (x - self.middle.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_on_frames_are_rounded_to_frames() {
        let on = |rate: f64| [0.0, 3.0, 7.0, 11.0, 12.0, 17.0, 23.0, 29.0].map(|n| (1e4 * n / rate).round() / 1e4);
        for rate in [25.0, 29.97, 30.0, 60.0, 240.0] {
            assert!((rounding(&on(rate)) * 12f64.sqrt() * rate - 1.0).abs() < 2e-3, "{rate}");
        }
        assert!((rounding(&[0.1234, 0.2351, 0.3412, 0.0077]) - 1e-4 / 12f64.sqrt()).abs() < 1e-12);
        // So few that they may be on frames by chance, and heights in whole centimetres.
        assert!(rounding(&[0.03, 0.07]) < 0.003 && (rounding(&[1.0, 0.5, 0.25]) * 12f64.sqrt() - 0.01).abs() < 1e-9);
    }

    #[test]
    fn tails_match_printed_tables() {
        let close = |a: f64, b: f64| (a - b).abs() < 1e-4 * b;
        assert!(close(chi_square_p(3.841_458_8, 1).unwrap(), 0.05));
        // On four degrees of freedom the tail is exp(−x/2) (1 + x/2).
        assert!(close(chi_square_p(73.244_587, 4).unwrap(), (-36.622_293_5f64).exp() * 37.622_293_5));
        assert_eq!(chi_square_p(1.0, 0), None);
        assert!(close(student(4), 2.776_445));
        assert!(close(variance_ratio_p(7.708_647, 1, 4).unwrap(), 0.05));
        assert_eq!(median(&mut [3.0, 1.0, 2.0, 10.0]), Some(2.5));
        assert_eq!(median(&mut []), None);
    }
}
