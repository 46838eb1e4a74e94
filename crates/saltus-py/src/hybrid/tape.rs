//! A function as a list of operations, as Python traced it: run over numbers and over numbers that
//! carry a derivative, and made a formula of the engine, whose series it runs.

use saltus::{Formula, Number, Op as Series};

/// An operation on results of operations before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Op {
    Constant(f64),
    Time,
    Coordinate(usize),
    Parameter(usize),
    One(One, usize),
    Two(Two, usize, usize),
    /// A constant power.
    Power(usize, f64),
    /// The second where the first is above zero, else the third.
    Choose(usize, usize, usize),
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum One {
    Neg,
    Abs,
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Atan,
    Tanh,
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Two {
    Add,
    Sub,
    Mul,
    Div,
    Atan2,
}

impl One {
    fn of<D: Number>(self, a: D) -> D {
        match self {
            Self::Neg => -a,
            Self::Abs => a.abs(),
            Self::Sqrt => a.sqrt(),
            Self::Exp => a.exp(),
            Self::Ln => a.ln(),
            Self::Sin => a.sin(),
            Self::Cos => a.cos(),
            Self::Tan => a.tan(),
            Self::Atan => a.atan(),
            Self::Tanh => a.tanh(),
        }
    }
}

impl Two {
    fn of<D: Number>(self, a: D, b: D) -> D {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Atan2 => a.atan2(b),
        }
    }
}

/// Operations in order, and the places of what they come to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tape {
    ops: Vec<Op>,
    outputs: Vec<usize>,
}

/// Results of so few operations are kept where nothing is asked for room.
const FEW: usize = 24;

impl Tape {
    /// `None` where an operation reads what does not stand before it, a coordinate or a parameter
    /// is not there, or an output is no place.
    pub(crate) fn new(ops: Vec<Op>, outputs: Vec<usize>, coordinates: usize, parameters: usize) -> Option<Self> {
        let good = ops.iter().enumerate().all(|(place, op)| match *op {
            Op::Constant(_) | Op::Time => true,
            Op::Coordinate(i) => i < coordinates,
            Op::Parameter(i) => i < parameters,
            Op::One(_, a) | Op::Power(a, _) => a < place,
            Op::Two(_, a, b) => a < place && b < place,
            Op::Choose(a, b, c) => a < place && b < place && c < place,
        });
        (good && outputs.iter().all(|&place| place < ops.len())).then_some(Self { ops, outputs })
    }

    pub(crate) fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// Hands over what it comes to at (t, x, p), output by output.
    #[inline]
    pub(crate) fn run<D: Number>(
        &self,
        t: D,
        x: impl Fn(usize) -> D,
        p: impl Fn(usize) -> D,
        mut out: impl FnMut(usize, D),
    ) {
        if self.ops.len() <= FEW {
            let mut results = [D::zero(); FEW];
            self.fill(&mut results, t, x, p);
            self.outputs.iter().enumerate().for_each(|(i, &place)| out(i, results[place % FEW]));
        } else {
            let mut results = vec![D::zero(); self.ops.len()];
            self.fill(&mut results, t, x, p);
            self.outputs.iter().enumerate().for_each(|(i, &place)| out(i, results[place]));
        }
    }

    #[inline]
    fn fill<D: Number>(&self, results: &mut [D], t: D, x: impl Fn(usize) -> D, p: impl Fn(usize) -> D) {
        for (place, op) in self.ops.iter().enumerate() {
            results[place] = match *op {
                Op::Constant(value) => D::from(value),
                Op::Time => t,
                Op::Coordinate(i) => x(i),
                Op::Parameter(i) => p(i),
                Op::One(function, a) => function.of(results[a]),
                Op::Two(function, a, b) => function.of(results[a], results[b]),
                // The series that it has at zero is that of products.
                Op::Power(a, e) if is_count(e) => results[a].powi(e as i32),
                Op::Power(a, e) => results[a].powf(e),
                Op::Choose(by, above, below) => results[if results[by].re() > 0.0 { above } else { below }],
            };
        }
    }

    /// The same with its parameters, and what they make constant, as numbers.
    pub(crate) fn bound(&self, p: &[f64]) -> Self {
        let mut ops: Vec<Op> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            let number = |a: usize| match ops[a] {
                Op::Constant(value) => Some(value),
                _ => None,
            };
            ops.push(match *op {
                Op::Parameter(i) => Op::Constant(p[i]),
                Op::One(f, a) => number(a).map_or(*op, |a| Op::Constant(f.of(a))),
                Op::Two(f, a, b) => number(a).zip(number(b)).map_or(*op, |(a, b)| Op::Constant(f.of(a, b))),
                Op::Power(a, e) => number(a).map_or(*op, |a| Op::Constant(a.powf(e))),
                other => other,
            });
        }
        Self { ops, outputs: self.outputs.clone() }.used()
    }

    /// Without what no output needs.
    fn used(&self) -> Self {
        let mut needed = vec![false; self.ops.len()];
        self.outputs.iter().for_each(|&place| needed[place] = true);
        for (place, op) in self.ops.iter().enumerate().rev().filter(|(_, op)| !matches!(op, Op::Constant(_))) {
            if !needed[place] {
                continue;
            }
            match *op {
                Op::One(_, a) | Op::Power(a, _) => needed[a] = true,
                Op::Two(_, a, b) => [a, b].into_iter().for_each(|a| needed[a] = true),
                Op::Choose(a, b, c) => [a, b, c].into_iter().for_each(|a| needed[a] = true),
                _ => {}
            }
        }
        let mut moved = Vec::with_capacity(self.ops.len());
        let mut ops = Vec::new();
        for (op, needed) in self.ops.iter().zip(needed) {
            moved.push(ops.len());
            if needed {
                ops.push(match *op {
                    Op::One(f, a) => Op::One(f, moved[a]),
                    Op::Two(f, a, b) => Op::Two(f, moved[a], moved[b]),
                    Op::Power(a, e) => Op::Power(moved[a], e),
                    Op::Choose(a, b, c) => Op::Choose(moved[a], moved[b], moved[c]),
                    other => other,
                });
            }
        }
        let outputs = self.outputs.iter().map(|&place| moved[place]).collect();
        Self { ops, outputs }
    }

    /// The rows a and the constants b of the outputs a·x + b, of a tape that is bound; `None` where
    /// one is no such sum.
    pub(crate) fn affine(&self, n: usize) -> Option<Vec<(Vec<f64>, f64)>> {
        let mut forms: Vec<Option<(Vec<f64>, f64)>> = Vec::with_capacity(self.ops.len());
        let combined = |(a, b): &(Vec<f64>, f64), k: f64, (c, d): &(Vec<f64>, f64), l: f64| {
            (a.iter().zip(c).map(|(a, c)| k * a + l * c).collect(), k * b + l * d)
        };
        let nothing = (vec![0.0; n], 0.0);
        for op in &self.ops {
            let form = |a: usize| forms[a].as_ref();
            let number = |a: usize| form(a).filter(|(row, _)| row.iter().all(|a| *a == 0.0)).map(|(_, b)| *b);
            let scaled = |a: usize, k: f64| form(a).map(|a| combined(a, k, &nothing, 0.0));
            forms.push(match *op {
                Op::Constant(value) => Some((vec![0.0; n], value)),
                Op::Coordinate(i) => Some(((0..n).map(|j| f64::from(i == j)).collect(), 0.0)),
                Op::One(One::Neg, a) => scaled(a, -1.0),
                Op::Two(Two::Add, a, b) => form(a).zip(form(b)).map(|(a, b)| combined(a, 1.0, b, 1.0)),
                Op::Two(Two::Sub, a, b) => form(a).zip(form(b)).map(|(a, b)| combined(a, 1.0, b, -1.0)),
                Op::Two(Two::Mul, a, b) => match (number(a), number(b)) {
                    (Some(k), _) => scaled(b, k),
                    (_, Some(k)) => scaled(a, k),
                    _ => None,
                },
                Op::Two(Two::Div, a, b) => number(b).and_then(|k| {
                    let (row, rest) = form(a)?;
                    Some((row.iter().map(|a| a / k).collect(), rest / k))
                }),
                Op::Power(a, 1.0) => form(a).cloned(),
                _ => None,
            });
        }
        self.outputs.iter().map(|&place| forms[place].clone()).collect()
    }

    /// The flow of `n` coordinates for the engine's series, of a tape that is bound.
    pub(crate) fn formula(&self, n: usize) -> Option<Formula> {
        let mut lowered = Lowered { base: 1 + n, ops: Vec::new() };
        let mut at: Vec<Value> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            at.push(match *op {
                Op::Constant(value) => Value::Number(value),
                Op::Time => Value::At(0),
                Op::Coordinate(i) => Value::At(1 + i),
                Op::Parameter(_) => return None,
                Op::One(f, a) => lowered.one(f, at[a]),
                Op::Two(f, a, b) => lowered.two(f, at[a], at[b]),
                Op::Power(a, e) => lowered.power(at[a], e),
                Op::Choose(by, above, below) => {
                    let [by, above, below] = [by, above, below].map(|a| lowered.place(at[a]));
                    lowered.put(Series::Choose { by, above, below })
                }
            });
        }
        let outputs = self.outputs.iter().map(|&place| lowered.place(at[place])).collect();
        Formula::new(n, lowered.ops, outputs)
    }
}

/// A whole number that a power is a few products of.
fn is_count(e: f64) -> bool {
    e.fract() == 0.0 && e.abs() <= 64.0
}

/// A number, or the place of one.
#[derive(Clone, Copy)]
enum Value {
    Number(f64),
    At(usize),
}

/// The engine's operations, as they are made of those of a tape.
struct Lowered {
    base: usize,
    ops: Vec<Series>,
}

impl Lowered {
    fn put(&mut self, op: Series) -> Value {
        self.ops.push(op);
        Value::At(self.base + self.ops.len() - 1)
    }

    fn place(&mut self, value: Value) -> usize {
        match value {
            Value::At(place) => place,
            Value::Number(number) => {
                self.ops.push(Series::Constant(number));
                self.base + self.ops.len() - 1
            }
        }
    }

    /// The place of the operation after so many.
    fn ahead(&self, count: usize) -> usize {
        self.base + self.ops.len() + count
    }

    fn one(&mut self, function: One, a: Value) -> Value {
        let a = match a {
            Value::Number(number) => return Value::Number(function.of(number)),
            Value::At(place) => place,
        };
        match function {
            One::Neg => self.put(Series::Neg(a)),
            One::Abs => self.put(Series::Abs(a)),
            One::Sqrt => self.put(Series::Sqrt(a)),
            One::Exp => self.put(Series::Exp(a)),
            One::Ln => self.put(Series::Ln(a)),
            One::Sin => self.sine_and_cosine(a).0,
            One::Cos => self.sine_and_cosine(a).1,
            One::Tan => {
                let (sine, cosine) = self.sine_and_cosine(a);
                self.two(Two::Div, sine, cosine)
            }
            One::Atan => {
                let square = self.put(Series::Square(a));
                let below = self.place(square);
                let below = self.put(Series::AddConstant(below, 1.0));
                let below = self.place(below);
                self.put(Series::Atan { of: a, below })
            }
            One::Tanh => {
                let result = self.put(Series::Tanh { of: a, slope: self.ahead(2) });
                let of = self.place(result);
                let square = self.put(Series::Square(of));
                let of = self.place(square);
                self.put(Series::SubFrom(1.0, of));
                result
            }
        }
    }

    fn sine_and_cosine(&mut self, of: usize) -> (Value, Value) {
        let (sin, cos) = (self.ahead(0), self.ahead(1));
        // The two of a number are made together, once.
        if let Some(there) = self.ops.iter().position(|op| matches!(op, Series::Sin { of: a, .. } if *a == of)) {
            return (Value::At(self.base + there), Value::At(self.base + there + 1));
        }
        (self.put(Series::Sin { of, cos }), self.put(Series::Cos { of, sin }))
    }

    fn two(&mut self, function: Two, a: Value, b: Value) -> Value {
        use Value::{At, Number};
        match (function, a, b) {
            (_, Number(a), Number(b)) => Number(function.of(a, b)),
            (Two::Add, At(a), Number(c)) | (Two::Add, Number(c), At(a)) => self.put(Series::AddConstant(a, c)),
            (Two::Add, At(a), At(b)) => self.put(Series::Add(a, b)),
            (Two::Sub, At(a), Number(c)) => self.put(Series::AddConstant(a, -c)),
            (Two::Sub, Number(c), At(a)) => self.put(Series::SubFrom(c, a)),
            (Two::Sub, At(a), At(b)) => self.put(Series::Sub(a, b)),
            (Two::Mul, At(a), Number(c)) | (Two::Mul, Number(c), At(a)) => self.put(Series::Scale(a, c)),
            (Two::Mul, At(a), At(b)) if a == b => self.put(Series::Square(a)),
            (Two::Mul, At(a), At(b)) => self.put(Series::Mul(a, b)),
            (Two::Div, At(a), Number(c)) => self.put(Series::Scale(a, 1.0 / c)),
            (Two::Div, Number(c), At(a)) => self.put(Series::DivInto(c, a)),
            (Two::Div, At(a), At(b)) => self.put(Series::Div(a, b)),
            (Two::Atan2, y, x) => {
                let [y, x] = [y, x].map(|value| self.place(value));
                let [one, other] = [y, x].map(|place| self.put(Series::Square(place)));
                let square = self.two(Two::Add, one, other);
                let square = self.place(square);
                self.put(Series::Atan2 { y, x, square })
            }
        }
    }

    /// A power: products where the exponent is a count, for those have a series at zero too.
    fn power(&mut self, a: Value, e: f64) -> Value {
        let place = match a {
            Value::Number(number) => return Value::Number(number.powf(e)),
            Value::At(place) => place,
        };
        if e == 0.5 {
            return self.put(Series::Sqrt(place));
        }
        if !is_count(e) {
            return self.put(Series::Powf(place, e));
        }
        let (mut left, mut base, mut power) = (e.abs() as u32, a, Value::Number(1.0));
        while left > 0 {
            if left % 2 == 1 {
                power = match power {
                    Value::Number(_) => base,
                    so_far @ Value::At(_) => self.two(Two::Mul, so_far, base),
                };
            }
            left /= 2;
            if left > 0 {
                base = self.two(Two::Mul, base, base);
            }
        }
        if e < 0.0 { self.two(Two::Div, Value::Number(1.0), power) } else { power }
    }
}
