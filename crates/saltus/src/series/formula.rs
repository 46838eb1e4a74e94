//! A flow as a list of operations, known only as a program runs: each gets its next coefficient in
//! turn.

use super::jet::{convolved, product, squared, weighted};
use super::{MOST_COEFFICIENTS, RECIPROCALS, Row, Series};
use crate::state::State;

/// An operation of a [`Formula`] on numbers at places: 0 is the time, 1 to n are the coordinates,
/// and what lies behind them are the results of the operations in order.
///
/// A function whose series needs that of another names the place of it, which may lie anywhere: the
/// sine that of the cosine and the other way round, the inverse of the tangent that of 1 + a², the
/// hyperbolic tangent that of 1 - c², the angle of a point that of the square of its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[allow(missing_docs)] // what the names say
pub enum Op {
    Constant(f64),
    Add(usize, usize),
    Sub(usize, usize),
    Mul(usize, usize),
    Square(usize),
    Div(usize, usize),
    /// The number at a place, and a constant.
    AddConstant(usize, f64),
    /// A constant less the number at a place.
    SubFrom(f64, usize),
    Scale(usize, f64),
    /// A constant divided by the number at a place.
    DivInto(f64, usize),
    Neg(usize),
    Abs(usize),
    Sqrt(usize),
    Powf(usize, f64),
    Exp(usize),
    Ln(usize),
    Sin {
        of: usize,
        cos: usize,
    },
    Cos {
        of: usize,
        sin: usize,
    },
    Atan {
        of: usize,
        below: usize,
    },
    Tanh {
        of: usize,
        slope: usize,
    },
    /// The angle of the point (x, y).
    Atan2 {
        y: usize,
        x: usize,
        square: usize,
    },
    /// One number where that at the place `by` is above zero, just after the present time, and
    /// another where it is not. A step ends where it changes its sign.
    Choose {
        by: usize,
        above: usize,
        below: usize,
    },
}

/// A flow of so many coordinates as a list of operations: what [`Series::formula`] takes.
///
/// ```
/// use saltus::{Automaton, Edges, Formula, Op, Refusal, Series, Simulation, Solution};
///
/// /// x'' = -sin x, as a list that a program might read from a file.
/// struct Pendulum(Formula);
///
/// impl Automaton for Pendulum {
///     type Mode = ();
///     type State = [f64; 2];
///     type Edge = ();
///     fn flow(&self, (): (), _t: f64, x: &[f64; 2]) -> [f64; 2] {
///         [x[1], -x[0].sin()]
///     }
///     fn solution(&self, (): (), _t: f64, _x: &[f64; 2]) -> Solution<Self> {
///         Solution::Series(|pendulum: &Self, (), series: &mut Series<'_, [f64; 2]>| series.formula(&pendulum.0))
///     }
///     fn edges(&self, (): ()) -> Edges<'_, ()> {
///         Edges::from([])
///     }
///     fn guard(&self, (): (), _t: f64, _x: &[f64; 2]) -> f64 {
///         1.0
///     }
///     fn reset(&self, (): (), (): (), _t: f64, x: &[f64; 2]) -> Result<((), [f64; 2]), Refusal> {
///         Ok(((), *x))
///     }
/// }
///
/// // Places: 0 is t, 1 the angle, 2 its rate, then the sine, the cosine that it needs, -sin.
/// let ops = vec![Op::Sin { of: 1, cos: 4 }, Op::Cos { of: 1, sin: 3 }, Op::Neg(3)];
/// let pendulum = Pendulum(Formula::new(2, ops, vec![2, 5]).expect("every place is there"));
/// let end = Simulation::of(&pendulum).run((), [1.0, 0.0], 0.0..2.0)?.end;
/// let energy = |x: [f64; 2]| 0.5 * x[1] * x[1] - x[0].cos();
/// assert!((energy(end.state) - energy([1.0, 0.0])).abs() < 1e-9 && end.stats.steps < 10);
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    coordinates: usize,
    ops: Vec<Op>,
    outputs: Vec<usize>,
}

impl Formula {
    /// The flow whose speeds stand at the places `outputs`; `None` where a place is not there, an
    /// operand stands behind its operation, or there are not as many speeds as coordinates.
    #[must_use]
    pub fn new(coordinates: usize, ops: Vec<Op>, outputs: Vec<usize>) -> Option<Self> {
        let all = 1 + coordinates + ops.len();
        let good = ops.iter().zip(1 + coordinates..).all(|(op, place)| {
            let before = |a: usize| a < place;
            match *op {
                Op::Constant(_) => true,
                Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Div(a, b) => before(a) && before(b),
                Op::Square(a)
                | Op::AddConstant(a, _)
                | Op::SubFrom(_, a)
                | Op::Scale(a, _)
                | Op::DivInto(_, a)
                | Op::Neg(a)
                | Op::Abs(a)
                | Op::Sqrt(a)
                | Op::Powf(a, _)
                | Op::Exp(a)
                | Op::Ln(a) => before(a),
                Op::Sin { of, cos: other } | Op::Cos { of, sin: other } | Op::Tanh { of, slope: other } => {
                    before(of) && other < all
                }
                Op::Atan { of, below } => before(of) && before(below),
                Op::Atan2 { y, x, square } => before(y) && before(x) && before(square),
                Op::Choose { by, above, below } => before(by) && before(above) && before(below),
            }
        });
        let whole = good && outputs.len() == coordinates && outputs.iter().all(|&place| place < all);
        whole.then_some(Self { coordinates, ops, outputs })
    }
}

impl<S: State> Series<'_, S> {
    /// Works out the series of x' = `formula`(t, x).
    pub fn formula(&mut self, formula: &Formula) {
        let n = formula.coordinates;
        if n != self.x.len() {
            self.mismatch = Some(n);
            return;
        }
        self.mismatch = None;
        if self.known == 0 {
            self.tape.start(self.t, self.unit, self.x);
            self.tape.reserve(1 + n + formula.ops.len());
        }
        let rows = &self.tape.rows[..];
        for k in self.known..self.order.min(MOST_COEFFICIENTS - 1) {
            for (op, result) in formula.ops.iter().zip(&rows[1 + n..]) {
                result[k].set(self.coefficient(op, result, k));
            }
            let by = self.unit * RECIPROCALS[k + 1];
            for (i, &place) in formula.outputs.iter().enumerate() {
                rows[1 + i][k + 1].set(by * rows[place][k].get());
            }
        }
    }

    /// Coefficient `k` of the result `c` of an operation. The functions are those of
    /// [`Jet`](super::Jet), with the recurrences named there.
    #[inline(always)]
    fn coefficient(&self, op: &Op, c: &Row, k: usize) -> f64 {
        let k = k % MOST_COEFFICIENTS;
        let row = |place: usize| &self.tape.rows[place];
        let first = |value: f64| if k == 0 { value } else { 0.0 };
        match *op {
            Op::Constant(value) => first(value),
            Op::Add(a, b) => row(a)[k].get() + row(b)[k].get(),
            Op::Sub(a, b) => row(a)[k].get() - row(b)[k].get(),
            Op::Mul(a, b) => product(row(a), row(b), k),
            Op::Square(a) => squared(row(a), k),
            Op::Div(a, b) => (row(a)[k].get() - convolved(&c[..k], &row(b)[1..=k])) / row(b)[0].get(),
            Op::AddConstant(a, value) => row(a)[k].get() + first(value),
            Op::SubFrom(value, a) => first(value) - row(a)[k].get(),
            Op::Scale(a, by) => row(a)[k].get() * by,
            Op::DivInto(value, b) => (first(value) - convolved(&c[..k], &row(b)[1..=k])) / row(b)[0].get(),
            Op::Neg(a) => -row(a)[k].get(),
            Op::Abs(a) => self.chosen(a, k, |sign| if sign > 0.0 { row(a)[k].get() } else { -row(a)[k].get() }),
            Op::Choose { by, above, below } => {
                self.chosen(by, k, |sign| row(if sign > 0.0 { above } else { below })[k].get())
            }
            Op::Sqrt(a) if k == 0 => row(a)[0].get().sqrt(),
            Op::Sqrt(a) => (row(a)[k].get() - convolved(&c[1..k], &c[1..k])) / (2.0 * c[0].get()),
            Op::Powf(a, p) if k == 0 => row(a)[0].get().powf(p),
            Op::Powf(a, p) => {
                let terms = c[..k].iter().zip(row(a)[1..=k].iter().rev()).enumerate();
                let sum: f64 = terms.map(|(j, (c, a))| (k as f64 * p - j as f64 * (p + 1.0)) * c.get() * a.get()).sum();
                sum / (k as f64 * row(a)[0].get())
            }
            Op::Exp(a) if k == 0 => row(a)[0].get().exp(),
            Op::Exp(a) => weighted(row(a), c, k, k) * RECIPROCALS[k],
            Op::Ln(a) if k == 0 => row(a)[0].get().ln(),
            Op::Ln(a) => (row(a)[k].get() - weighted(c, row(a), k - 1, k) * RECIPROCALS[k]) / row(a)[0].get(),
            Op::Sin { of, .. } if k == 0 => row(of)[0].get().sin(),
            Op::Sin { of, cos } => weighted(row(of), row(cos), k, k) * RECIPROCALS[k],
            Op::Cos { of, .. } if k == 0 => row(of)[0].get().cos(),
            Op::Cos { of, sin } => -weighted(row(of), row(sin), k, k) * RECIPROCALS[k],
            Op::Atan { of, .. } if k == 0 => row(of)[0].get().atan(),
            Op::Atan { of, below } => {
                (row(of)[k].get() - weighted(c, row(below), k - 1, k) * RECIPROCALS[k]) / row(below)[0].get()
            }
            Op::Tanh { of, .. } if k == 0 => row(of)[0].get().tanh(),
            Op::Tanh { of, slope } => weighted(row(of), row(slope), k, k) * RECIPROCALS[k],
            Op::Atan2 { y, x, .. } if k == 0 => row(y)[0].get().atan2(row(x)[0].get()),
            // From c' (x² + y²) = x y' - y x'.
            Op::Atan2 { y, x, square } => {
                let turned = weighted(row(y), row(x), k, k) - weighted(row(x), row(y), k, k);
                (turned - weighted(c, row(square), k - 1, k)) * RECIPROCALS[k] / row(square)[0].get()
            }
        }
    }

    /// What is chosen by the sign of the number at a place just after the present time: that of its
    /// first coefficient that is not zero.
    #[inline(always)]
    fn chosen(&self, place: usize, k: usize, choose: impl Fn(f64) -> f64) -> f64 {
        let a = &self.tape.rows[place];
        let leading = a[..=k].iter().map(std::cell::Cell::get).find(|a| *a != 0.0).unwrap_or(0.0);
        choose(self.tape.kinks.sign(place, leading))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Jet;
    use crate::series::Tape;

    /// Every operation has the coefficients of the jets, which have laws of their own.
    #[test]
    fn formulas_are_jets() {
        fn flow<'j>(t: Jet<'j>, [x, y]: [Jet<'j>; 2]) -> [Jet<'j>; 2] {
            let angle = (y / x).atan(); // of the point (x, y), x > 0
            [
                x.sin() * y.cos() + x.exp() - (y * y + 1.0).ln() + (x * x + y).sqrt().powf(0.3) - x.abs() / (2.0 + y),
                (2.0 - t) * x.tanh() + y.atan() - angle + 3.0 / (x * -0.5) - (y - 4.0).abs(),
            ]
        }
        let ops = vec![
            /* 3 */ Op::Sin { of: 1, cos: 4 },
            Op::Cos { of: 1, sin: 3 },
            /* 5 */ Op::Sin { of: 2, cos: 6 },
            Op::Cos { of: 2, sin: 5 },
            /* 7 */ Op::Mul(3, 6),
            Op::Exp(1),
            Op::Add(7, 8),
            /* 10 */ Op::Square(2),
            Op::AddConstant(10, 1.0),
            Op::Ln(11),
            Op::Sub(9, 12),
            /* 14 */ Op::Square(1),
            Op::Add(14, 2),
            Op::Sqrt(15),
            Op::Powf(16, 0.3),
            Op::Add(13, 17),
            /* 19 */ Op::Abs(1),
            Op::AddConstant(2, 2.0),
            Op::Div(19, 20),
            Op::Sub(18, 21),
            /* 23 */ Op::SubFrom(2.0, 0),
            Op::Tanh { of: 1, slope: 26 },
            Op::Square(24),
            Op::SubFrom(1.0, 25),
            Op::Mul(23, 24),
            /* 28 */ Op::Atan { of: 2, below: 11 },
            Op::Add(27, 28),
            Op::Add(14, 10),
            Op::Atan2 { y: 2, x: 1, square: 30 },
            Op::Sub(29, 31),
            /* 33 */ Op::Scale(1, -0.5),
            Op::DivInto(3.0, 33),
            Op::Add(32, 34),
            /* 36 */ Op::AddConstant(2, -4.0),
            Op::Neg(36),
            Op::Choose { by: 36, above: 36, below: 37 },
            Op::Sub(35, 38),
        ];
        let formula = Formula::new(2, ops, vec![22, 39]).unwrap();
        for (t, x) in [(0.3, [0.7, -0.2]), (0.0, [1.3, 0.4]), (-1.0, [0.2, 1.9])] {
            let read = |formula: Option<&Formula>| {
                let (mut tape, mut c) = (Tape::new(), [x; MOST_COEFFICIENTS]);
                for (known, order) in [(0, 7), (7, 20)] {
                    let mut series = Series::around(&mut tape, t, &x, known, order, 0.1);
                    match formula {
                        Some(formula) => series.formula(formula),
                        None => series.flow(flow),
                    }
                    series.read(&mut c);
                }
                c
            };
            let (jets, formulas) = (read(None), read(Some(&formula)));
            let most = jets[..=20].iter().flatten().fold(0.0_f64, |most, c| most.max(c.abs()));
            for (k, (jet, formula)) in jets[..=20].iter().zip(&formulas).enumerate() {
                for (one, other) in jet.iter().zip(formula) {
                    assert!((one - other).abs() <= 1e-13 * most, "order {k} at {x:?}: {one:e} {other:e}");
                }
            }
        }
    }

    #[test]
    fn what_is_no_formula_is_refused() {
        assert_eq!(Formula::new(1, vec![Op::Neg(2)], vec![2]), None); // of itself
        assert_eq!(Formula::new(1, vec![Op::Neg(1)], vec![3]), None); // of nothing
        assert_eq!(Formula::new(1, vec![Op::Neg(1)], vec![1, 2]), None); // two speeds
        assert_eq!(Formula::new(1, vec![Op::Sin { of: 1, cos: 3 }], vec![2]), None); // no cosine
    }
}
