//! Where a guard first falls through zero: excluded by bounds, isolated by halving, refined to neighbouring times.

use crate::poly::{Bernstein, Shape};

/// A fall through zero between two neighbouring times: the guard is not negative at `inside` and negative at `outside`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The last time still inside the domain.
    pub inside: f64,
    /// The first time outside.
    pub outside: f64,
    /// The best estimate of the root, within rounding of both: where `inside` lies early by up to a rounding, this has no bias.
    pub root: f64,
}

impl Crossing {
    /// A crossing at the very start.
    pub(crate) const fn at_start(outside: f64) -> Self {
        Self { inside: 0.0, outside, root: 0.0 }
    }
}

/// What the guard does at the start of the interval searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Nothing special: a fall that begins with a zero at the start counts.
    Open,
    /// The guard is zero at the start because its edge was just taken: that root is divided out.
    Spent,
}

/// The outcome of a search that could not finish: the guard is not a number at this time, before any fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Undefined(pub f64);

/// Halvings after which an interval is as narrow as its ends can be told apart.
const DEEPEST: u32 = 60;
/// A fall within this fraction of the interval from its start is at its start.
const AT_START: f64 = 1.0 / (1_u64 << 60) as f64;
/// Samples of one guard within one search, after which halving stops and signs at the ends decide.
const MOST_SAMPLES: u32 = 200_000;

/// The first time in `0..=span` at which `guard` falls from positive or zero to negative, or `None`.
///
/// The guard is replaced by its interpolant at nine Chebyshev points; the interval is halved until the interpolant's tail and two
/// checks away from the nodes say that it is resolved, and until its Bernstein coefficients exclude a fall or show a single one.
/// A touch without a change of sign is no fall; a zero on a whole interval falls once, where it ends.
///
/// Guaranteed for guards that are smooth at the scale of the sampling (a feature narrower than about a ninth of `span`, and alone, can be missed).
///
/// ```
/// use saltus::cross::{Start, first_fall};
/// // Two crossings a millionth apart are not one, nor none.
/// let found = first_fall(|s| (s - 0.5) * (s - 0.500_001), 1.0, Start::Open).unwrap().unwrap();
/// assert!((found.inside - 0.5).abs() < 1e-10 && found.inside < found.outside);
/// // A root that was just spent is not found again; the next one is.
/// let next = first_fall(|s| s * (1.0 - s), 2.0, Start::Spent).unwrap().unwrap();
/// assert_eq!(next.inside, 1.0);
/// ```
///
/// # Errors
/// [`Undefined`] if the guard is not a number somewhere before its first fall.
pub fn first_fall(guard: impl FnMut(f64) -> f64, span: f64, start: Start) -> Result<Option<Crossing>, Undefined> {
    let mut search = Search { guard, samples: 0, largest: 0.0 };
    let first = search.value(0.0)?;
    let inside = match start {
        Start::Open => first >= 0.0,
        Start::Spent => match search.after_spent_root(first, span)? {
            Departure::Inside => true,
            Departure::Outside => false,
            Departure::Again => return Ok(Some(Crossing::at_start(span * AT_START))),
        },
    };
    let bracket = search.sampled(0.0, span, inside, start, DEEPEST, f64::INFINITY)?;
    search.refined(bracket, start)
}

/// The same for a guard that is known to be the polynomial `p(s / span)`; `guard` decides signs and refines.
pub(crate) fn first_fall_of_polynomial(
    p: &Bernstein,
    guard: impl FnMut(f64) -> f64,
    span: f64,
    start: Start,
) -> Result<Option<Crossing>, Undefined> {
    let margin = 8.0 * f64::EPSILON * p.scale();
    let p = match start {
        Start::Open => *p,
        Start::Spent => p.without_root_at_start(),
    };
    match p.shape(margin) {
        Shape::Above => return Ok(None),
        Shape::Below if start == Start::Spent => return Ok(None),
        _ => {}
    }
    let mut search = Search { guard, samples: 0, largest: 0.0 };
    let inside = match start {
        Start::Open => search.value(0.0)? >= 0.0,
        Start::Spent => p.coefficients().first().is_some_and(|&q| q >= 0.0),
    };
    let bracket = search.halved(&p, margin, 0.0, span, inside, DEEPEST)?;
    search.refined(bracket, start)
}

/// The fall close to `near`, a root known but for rounding, between neighbouring numbers.
pub(crate) fn settle(mut guard: impl FnMut(f64) -> f64, near: f64) -> Option<Crossing> {
    // Where rounding hides the guard's sign all around, the root that is known decides: a ball does not fall through a floor at height one.
    let known = Crossing { inside: near, outside: near.next_up(), root: near };
    let mut step = near.next_up() - near;
    let (mut a, mut b) = (near, near);
    if guard(near) >= 0.0 {
        loop {
            b = a + step;
            if guard(b) < 0.0 {
                break;
            }
            a = b;
            step *= 2.0;
            if b > 2.0 * near {
                return Some(known);
            }
        }
    } else {
        loop {
            a = (b - step).max(0.0);
            if guard(a) >= 0.0 {
                break;
            }
            if a == 0.0 {
                return Some(known);
            }
            b = a;
            step *= 2.0;
        }
    }
    while a.next_up() < b {
        let middle = 0.5 * (a + b);
        if guard(middle) >= 0.0 { a = middle } else { b = middle }
    }
    Some(Crossing { inside: a, outside: b, root: near })
}

struct Search<G> {
    guard: G,
    samples: u32,
    /// The largest magnitude of the guard met so far.
    largest: f64,
}

/// Where a guard goes from a root that was spent.
enum Departure {
    Inside,
    Outside,
    Again,
}

/// What a part of the interval holds: the bracket of its first fall, or else whether its end is inside.
enum Part {
    Fall(f64, f64),
    None { inside: bool },
}

impl<G: FnMut(f64) -> f64> Search<G> {
    fn value(&mut self, s: f64) -> Result<f64, Undefined> {
        self.samples += 1;
        let value = (self.guard)(s);
        self.largest = self.largest.max(value.abs());
        if value.is_nan() { Err(Undefined(s)) } else { Ok(value) }
    }

    /// Where the guard goes from a spent root at the start, where its value is `first`.
    ///
    /// Looked at closer than rounding can tell, then ever farther away, until two doublings of time in a row double the change of the
    /// guard (a simple root: its sign decides; times eight, a triple one) or quadruple it (a double root: if the guard falls, it holds one more fall).
    fn after_spent_root(&mut self, first: f64, span: f64) -> Result<Departure, Undefined> {
        let mut s = span * AT_START;
        let mut far = 0.0;
        let mut rose = false;
        while s < span {
            far = self.value(s)? - first;
            let (half, quarter) = (self.value(0.5 * s)? - first, self.value(0.25 * s)? - first);
            rose |= far > 0.0;
            let grows =
                |by: f64| (far - by * half).abs() < 0.1 * far.abs() && (half - by * quarter).abs() < 0.1 * half.abs();
            match (grows(2.0) || grows(8.0), grows(4.0), far > 0.0) {
                (true, _, true) | (_, true, true) => return Ok(Departure::Inside),
                (true, _, false) => return Ok(Departure::Outside),
                (_, true, false) => return Ok(Departure::Again),
                _ => s *= 8.0,
            }
        }
        // Nothing but steps of rounding: the end decides, unless the guard was seen to rise.
        let fell = far < 0.0 || self.value(span)? < first;
        Ok(if rose || !fell { Departure::Inside } else { Departure::Outside })
    }

    /// Signs at the ends alone; a zero leaves the guard on the side it came from.
    fn by_signs(&mut self, a: f64, b: f64, inside: bool) -> Result<Part, Undefined> {
        let end = self.value(b)?;
        let ends_inside = end > 0.0 || (end == 0.0 && inside);
        Ok(if inside && !ends_inside { Part::Fall(a, b) } else { Part::None { inside: ends_inside } })
    }

    fn halved(
        &mut self,
        p: &Bernstein,
        margin: f64,
        a: f64,
        b: f64,
        inside: bool,
        depth: u32,
    ) -> Result<Part, Undefined> {
        let middle = 0.5 * (a + b);
        match p.shape(margin) {
            Shape::Above => Ok(Part::None { inside: true }),
            Shape::Unclear if depth > 0 && a < middle && middle < b => {
                let (left, right) = p.halves();
                match self.halved(&left, margin, a, middle, inside, depth - 1)? {
                    Part::None { inside } => self.halved(&right, margin, middle, b, inside, depth - 1),
                    fall @ Part::Fall(..) => Ok(fall),
                }
            }
            _ => self.by_signs(a, b, inside),
        }
    }

    /// `whole` is how far the guard may be from its interpolant on the interval of which this is a half.
    fn sampled(
        &mut self,
        a: f64,
        b: f64,
        inside: bool,
        start: Start,
        depth: u32,
        whole: f64,
    ) -> Result<Part, Undefined> {
        let mut error = f64::INFINITY;
        let middle = 0.5 * (a + b);
        let narrow = depth == 0 || !(a < middle && middle < b) || self.samples > MOST_SAMPLES;
        let undecided = match self.proxy(a, b) {
            Err(undefined) if narrow => return Err(undefined),
            Err(_) => true,
            Ok((p, margin)) => {
                // Halving shrinks the error of a smooth guard by hundreds; what does not shrink is the guard's own rounding.
                let rounding = margin >= 0.1 * whole;
                error = margin;
                let p = if start == Start::Spent { p.without_root_at_start() } else { p };
                match p.shape(margin) {
                    Shape::Above => return Ok(Part::None { inside: true }),
                    Shape::Unclear => true,
                    Shape::Falling | Shape::Rising => margin > if rounding { 0.02 } else { 1e-6 } * p.scale(),
                    Shape::Below => false,
                    Shape::Flat => p.scale() > 64.0 * f64::EPSILON * self.largest,
                }
            }
        };
        if !undecided || narrow {
            return self.by_signs(a, b, inside);
        }
        match self.sampled(a, middle, inside, start, depth - 1, error)? {
            Part::None { inside } => self.sampled(middle, b, inside, Start::Open, depth - 1, error),
            fall @ Part::Fall(..) => Ok(fall),
        }
    }

    /// The interpolant at the Chebyshev points of `[a, b]`, and how far the guard may be from it.
    fn proxy(&mut self, a: f64, b: f64) -> Result<(Bernstein, f64), Undefined> {
        let (centre, radius) = (0.5 * (a + b), 0.5 * (b - a));
        let mut values = [0.0; 9];
        for (value, x) in values.iter_mut().zip(chebyshev::NODES) {
            let s = if x == -1.0 {
                a
            } else if x == 1.0 {
                b
            } else {
                centre + radius * x
            };
            *value = self.value(s)?;
        }
        let series = chebyshev::series(&values);
        let p = Bernstein::new(&chebyshev::bernstein(&series));
        let mut off = 0.0_f64;
        for x in [-0.557_350_921, 0.271_828_183] {
            off = off.max((self.value(centre + radius * x)? - chebyshev::sum(&series, x)).abs());
        }
        let margin = 8.0 * (series[7].abs() + series[8].abs()).max(off) + 16.0 * f64::EPSILON * p.scale();
        Ok((p, if margin.is_finite() { margin } else { f64::INFINITY }))
    }

    /// The bracket narrowed to neighbouring numbers by ITP, which is never slower than bisection by more than one step
    /// (I. Oliveira, R. Takahashi, ACM TOMS 47 (2021) 5, doi:10.1145/3423597).
    fn refined(&mut self, part: Part, start: Start) -> Result<Option<Crossing>, Undefined> {
        let Part::Fall(mut a, mut b) = part else { return Ok(None) };
        if a == 0.0 && start == Start::Open && self.value(b * AT_START)? < 0.0 {
            return Ok(Some(Crossing::at_start(b * AT_START)));
        }
        if a == 0.0 && start == Start::Spent {
            // Rounding may leave the guard negative at the spent root: begin where it is seen to have risen.
            let mut middle = 0.5 * b;
            while self.value(middle)? <= 0.0 {
                if middle <= b * AT_START {
                    return Ok(Some(Crossing::at_start(middle)));
                }
                middle *= 0.5;
            }
            a = middle;
            let mut ahead = 2.0 * a;
            while ahead < b && self.value(ahead)? >= 0.0 {
                a = ahead;
                ahead *= 2.0;
            }
            b = ahead.min(b);
        }
        let (mut above, mut below) = (self.value(a)?.max(0.0), self.value(b)?);
        let mut allowance = 2.0 * (b - a);
        let truncation = 0.2 / (b - a);
        while a.next_up() < b && b - a > f64::MIN_POSITIVE {
            let (middle, width) = (0.5 * (a + b), b - a);
            let slack = (allowance - 0.5 * width).max(0.0);
            allowance *= 0.5; // without a floor: a guard that is zero on a stretch is not crept along number by number
            let secant = (b * above - a * below) / (above - below);
            let towards = (middle - secant).signum();
            let shift = truncation * width * width;
            let guess = if shift <= (middle - secant).abs() { secant + towards * shift } else { middle };
            let guess = if (guess - middle).abs() <= slack { guess } else { middle - towards * slack };
            let guess = if guess.is_finite() { guess.clamp(a.next_up(), b.next_down()) } else { middle };
            let value = self.value(guess)?;
            if value >= 0.0 {
                (a, above) = (guess, value);
            } else {
                (b, below) = (guess, value);
            }
        }
        Ok(Some(Crossing { inside: a, outside: b, root: if above <= -below { a } else { b } }))
    }
}

/// Interpolation at the nine Chebyshev points of the second kind (L. N. Trefethen, *Approximation Theory and Approximation Practice*, 2013, ch. 3).
mod chebyshev {
    /// cos(j pi / 8), from -1 up to 1.
    pub(super) const NODES: [f64; 9] = [
        -1.0,
        -0.923_879_532_511_286_7,
        -std::f64::consts::FRAC_1_SQRT_2,
        -0.382_683_432_365_089_8,
        0.0,
        0.382_683_432_365_089_8,
        std::f64::consts::FRAC_1_SQRT_2,
        0.923_879_532_511_286_7,
        1.0,
    ];

    /// `T_k` at node j is cos(jk pi / 8), itself a node up to the order.
    fn value(k: usize, j: usize) -> f64 {
        // Node j has the angle (8 - j) pi / 8; fold the multiple of pi / 8 back into 0..=8.
        let turn = (k * (8 - j)) % 16;
        let fold = if turn > 8 { 16 - turn } else { turn };
        NODES[8 - fold]
    }

    /// The coefficients of `T_0` to `T_8` of the interpolant.
    pub(super) fn series(values: &[f64; 9]) -> [f64; 9] {
        std::array::from_fn(|k| {
            let sum: f64 = (0..9)
                .map(|j| {
                    let end = if j == 0 || j == 8 { 0.5 } else { 1.0 };
                    end * values[j] * value(k, j)
                })
                .sum();
            if k == 0 || k == 8 { sum / 8.0 } else { sum / 4.0 }
        })
    }

    /// Clenshaw's sum of the series at `x`.
    pub(super) fn sum(series: &[f64; 9], x: f64) -> f64 {
        let (mut next, mut after) = (0.0, 0.0);
        for &c in series[1..].iter().rev() {
            (next, after) = (2.0 * x * next - after + c, next);
        }
        x * next - after + series[0]
    }

    /// The Bernstein coefficients of degree eight on the interval.
    pub(super) fn bernstein(series: &[f64; 9]) -> [f64; 9] {
        const TABLE: [[f64; 9]; 9] = table();
        std::array::from_fn(|i| (0..9).map(|k| series[k] * TABLE[k][i]).sum())
    }

    /// Row k: `T_k` in the Bernstein basis, (-1)^(k-i) C(2k, 2i) / C(k, i), raised to degree eight.
    const fn table() -> [[f64; 9]; 9] {
        let mut rows = [[0.0; 9]; 9];
        let mut k = 0;
        while k < 9 {
            let mut row = [0.0; 9];
            let mut i = 0;
            while i <= k {
                let sign = if (k - i) % 2 == 0 { 1.0 } else { -1.0 };
                row[i] = sign * binomial(2 * k, 2 * i) / binomial(k, i);
                i += 1;
            }
            let mut degree = k;
            while degree < 8 {
                let mut raised = [0.0; 9];
                let mut i = 0;
                while i <= degree + 1 {
                    let w = i as f64 / (degree + 1) as f64;
                    let left = if i > 0 { row[i - 1] } else { 0.0 };
                    let here = if i <= degree { row[i] } else { 0.0 };
                    raised[i] = w * left + (1.0 - w) * here;
                    i += 1;
                }
                row = raised;
                degree += 1;
            }
            rows[k] = row;
            k += 1;
        }
        rows
    }

    const fn binomial(n: usize, k: usize) -> f64 {
        let mut value = 1.0;
        let mut i = 0;
        while i < k {
            value = value * (n - i) as f64 / (i + 1) as f64;
            i += 1;
        }
        value
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn a_polynomial_of_degree_eight_is_reproduced() {
            let f = |x: f64| ((x - 0.3) * (x + 0.7)).powi(4) - 0.1 * x;
            let values = NODES.map(f);
            let series = series(&values);
            for x in [-0.9, -0.2, 0.44, 0.99] {
                assert!((sum(&series, x) - f(x)).abs() < 1e-14);
                let u = 0.5 * (x + 1.0);
                let b = bernstein(&series);
                let total: f64 =
                    (0..9).map(|i| b[i] * binomial(8, i) * u.powi(i as i32) * (1.0 - u).powi(8 - i as i32)).sum();
                assert!((total - f(x)).abs() < 1e-13);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fall(guard: impl FnMut(f64) -> f64, span: f64) -> Option<f64> {
        first_fall(guard, span, Start::Open).unwrap().map(|c| c.inside)
    }

    #[test]
    fn a_touch_is_no_fall() {
        assert_eq!(fall(|s| (s - 0.5).powi(2), 1.0), None);
        assert_eq!(fall(|s| (s - 0.3).powi(4), 1.0), None);
        assert_eq!(fall(|s| -(s - 0.5).powi(2), 1.0), None);
    }

    #[test]
    fn a_plateau_falls_once_where_it_ends() {
        let found = fall(
            |s| {
                if s < 0.25 {
                    0.25 - s
                } else if s < 0.75 {
                    0.0
                } else {
                    0.75 - s
                }
            },
            1.0,
        )
        .unwrap();
        assert!((found - 0.75).abs() < 1e-15, "{found}");
    }

    #[test]
    fn a_fall_at_the_start_counts_unless_spent() {
        assert_eq!(fall(|s| -s, 1.0), Some(0.0));
        assert_eq!(first_fall(|s| -s, 1.0, Start::Spent), Ok(None));
    }

    #[test]
    fn undefined_before_the_fall_is_said_and_after_it_is_not() {
        assert!(matches!(first_fall(|s| (0.5 - s).sqrt() + 1.0, 1.0, Start::Open), Err(Undefined(s)) if s > 0.49));
        let found = fall(|s| if s > 0.6 { f64::NAN } else { 0.25 - s }, 1.0);
        assert!((found.unwrap() - 0.25).abs() < 1e-15);
    }

    #[test]
    fn a_fast_guard_gives_its_first_fall() {
        let found = fall(|s| (1000.0 * s + 0.1).sin(), 1.0).unwrap();
        assert!((found - (std::f64::consts::PI - 0.1) / 1000.0).abs() < 1e-15, "{found}");
    }

    proptest! {
        /// Plant falls and rises in turn, clustered, dyadic or at an end; the first fall is found, as a polynomial and as a function.
        #[test]
        fn planted_roots(mut roots in prop::collection::vec((0_u32..=64, -3_i32..=3), 1..=6)) {
            roots.sort_unstable();
            let roots: Vec<f64> = roots.iter().map(|&(k, hair)| f64::from(k) / 64.0 + f64::from(hair) * 1e-4).collect();
            let value = |s: f64| roots.iter().map(|r| r - s).product::<f64>();
            // Count the roots at each place: an even group is a touch, an odd one a change of sign.
            let mut sign = 1.0;
            let mut expected = None;
            let mut i = 0;
            while i < roots.len() {
                let same = roots[i..].iter().take_while(|&&r| r == roots[i]).count();
                if same % 2 == 1 {
                    if roots[i] >= 0.0 && roots[i] < 1.0 && sign > 0.0 {
                        expected = Some((roots[i], same));
                        break;
                    }
                    sign = -sign;
                }
                i += same;
            }
            let found = fall(value, 1.0);
            match expected {
                None => prop_assert!(found.is_none(), "{found:?}"),
                Some((root, multiplicity)) => {
                    let tolerance = if multiplicity == 1 { 1e-9 } else { 1e-3 };
                    prop_assert!(found.is_some_and(|s| (s - root).abs() < tolerance), "{found:?} {root}");
                }
            }
        }
    }
}
