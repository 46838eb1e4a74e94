//! The Taylor series of a solution, from a flow written over numbers that carry one.

mod formula;
mod functions;
mod jet;
mod kinks;

use std::cell::Cell;
use std::fmt;

pub use formula::{Formula, Op};
pub use jet::Jet;
use kinks::Kinks;
pub(crate) use kinks::NextKink;

use crate::state::State;

/// How many coefficients a jet has room for.
pub(crate) const MOST_COEFFICIENTS: usize = 32;

/// The coefficients of one number.
type Row = [Cell<f64>; MOST_COEFFICIENTS];

/// The Taylor series of a solution around the present state, which a model brings about by writing
/// its flow over [`Jet`]s: see [`Solution::Series`](crate::Solution::Series).
pub struct Series<'a, S> {
    tape: &'a mut Tape,
    t: f64,
    x: &'a S,
    /// The orders that are computed already, and those that are to be.
    known: usize,
    order: usize,
    /// The unit of time of the coefficients, in seconds.
    unit: f64,
    /// How many coordinates a flow of another dimension has; none, as long as there is no flow.
    mismatch: Option<usize>,
}

impl<'a, S: State> Series<'a, S> {
    /// A series around the state `x` at time `t`, its coefficients those of time in `unit`s: on
    /// from the order `known` to another.
    pub(crate) fn around(tape: &'a mut Tape, t: f64, x: &'a S, known: usize, order: usize, unit: f64) -> Self {
        Self { tape, t, x, known, order: order.min(MOST_COEFFICIENTS - 1), unit, mismatch: Some(0) }
    }

    /// Works out the series of x' = `flow`(t, x), N coordinates.
    ///
    /// The flow is gone through once for each order of the series. It must take the same way each
    /// time, which it does as long as it decides by [`Jet::value`] or by numbers of the model.
    #[inline]
    pub fn flow<const N: usize>(&mut self, flow: impl for<'j> Fn(Jet<'j>, [Jet<'j>; N]) -> [Jet<'j>; N]) {
        if N != self.x.len() {
            self.mismatch = Some(N);
            return;
        }
        self.mismatch = None;
        if self.known == 0 {
            self.tape.start(self.t, self.unit, self.x);
        }
        let (mut k, mut seen) = (self.known, false);
        while k < self.order {
            match self.tape.pass(k, &flow) {
                Ok(slope) => {
                    let by = self.unit * RECIPROCALS[k + 1];
                    for (row, c) in self.tape.rows[1..].iter().zip(slope) {
                        row[k + 1].set(by * c);
                    }
                    k += 1;
                }
                // The first pass shows how many numbers there are on the way; if a later one does,
                // the flow went another way.
                Err(needed) if k == 0 && !seen => {
                    self.tape.reserve(needed);
                    seen = true;
                }
                Err(_) => {
                    self.tape.rows.iter().for_each(|row| row[self.order].set(f64::NAN));
                    break;
                }
            }
        }
    }

    /// How many coordinates a flow of another dimension than the state's has, if it is one.
    pub(crate) fn mismatch(&self) -> Option<usize> {
        self.mismatch
    }

    /// Puts the coefficients of the state where they belong in a list.
    pub(crate) fn read(&self, c: &mut [S; MOST_COEFFICIENTS]) {
        let rows = &self.tape.rows[1..=self.x.len()];
        for (k, c) in c[..=self.order].iter_mut().enumerate().skip(self.known) {
            *c = self.x.with(|i| rows[i][k].get());
        }
    }
}

impl<S: fmt::Debug> fmt::Debug for Series<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a series of order {} around {:?} at t = {}", self.order, self.x, self.t)
    }
}

/// 1/k.
pub(crate) const RECIPROCALS: [f64; MOST_COEFFICIENTS] = {
    let mut list = [0.0; MOST_COEFFICIENTS];
    let mut k = 1;
    while k < MOST_COEFFICIENTS {
        list[k] = 1.0 / k as f64;
        k += 1;
    }
    list
};

/// The numbers that an evaluation of a flow comes by, in the order in which it does, each with its
/// coefficients as far as they are computed: time, the coordinates, and what the flow computes of
/// them.
pub(crate) struct Tape {
    rows: Vec<Row>,
    /// In place of rows that there are too few of.
    spare: Row,
    kinks: Kinks,
}

/// One way through a flow: each number is found at its place on the tape, and gets its coefficient
/// `k`.
struct Pass<'a> {
    rows: &'a [Row],
    spare: &'a Row,
    kinks: &'a Kinks,
    k: usize,
    /// The place of the next number.
    next: Cell<usize>,
}

impl<'a> Pass<'a> {
    #[inline]
    fn row(&self, place: usize) -> &'a Row {
        self.rows.get(place).unwrap_or(self.spare)
    }
}

impl Tape {
    pub(crate) const fn new() -> Self {
        Self { rows: Vec::new(), spare: zeros(), kinks: Kinks::new() }
    }

    /// The first coefficients of time and of the state.
    fn start<S: State>(&mut self, t: f64, unit: f64, x: &S) {
        self.reserve(1 + x.len());
        let (time, rows) = (&self.rows[0], &self.rows[1..=x.len()]);
        time.iter().skip(2).for_each(|c| c.set(0.0));
        time[0].set(t);
        time[1].set(unit);
        for (i, row) in rows.iter().enumerate() {
            row[0].set(x.get(i));
        }
    }

    #[inline]
    fn reserve(&mut self, rows: usize) {
        if self.rows.len() < rows {
            self.rows.resize_with(rows, zeros);
        }
    }

    /// Before a series from another state: one at which the number at the place of a `kink` changes
    /// its sign, if it does.
    pub(crate) fn anew(&mut self, kink: Option<usize>) {
        self.kinks.clear_but(kink);
        if let Some(place) = kink {
            self.turn(place);
        }
    }

    /// The next kink of the flow along a series of this `order`, up to so many units of time.
    pub(crate) fn next_kink(&self, order: usize, span: f64) -> NextKink {
        self.kinks.next(|place| &self.rows[place], order, span)
    }

    /// The number at a place changes its sign where the series starts.
    pub(crate) fn turn(&mut self, place: usize) {
        self.kinks.turn(place);
    }

    /// Coefficient `k` of the flow, given those of the state up to the same; or how many rows that
    /// takes, if there are fewer.
    #[inline]
    fn pass<const N: usize>(
        &self,
        k: usize,
        flow: &impl for<'j> Fn(Jet<'j>, [Jet<'j>; N]) -> [Jet<'j>; N],
    ) -> Result<[f64; N], usize> {
        let pass = Pass { rows: &self.rows, spare: &self.spare, kinks: &self.kinks, k, next: Cell::new(1 + N) };
        let slope = flow(Jet::at(&pass, 0), std::array::from_fn(|i| Jet::at(&pass, 1 + i)));
        let slope = slope.map(|slope| slope.coefficient(k));
        let needed = pass.next.get();
        if needed <= self.rows.len() { Ok(slope) } else { Err(needed) }
    }
}

const fn zeros() -> Row {
    [const { Cell::new(0.0) }; MOST_COEFFICIENTS]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The first coefficients of a solution of x' = `flow`(t, x) from `x` at time `t`.
    fn coefficients<const N: usize>(
        t: f64,
        x: [f64; N],
        flow: impl for<'j> Fn(Jet<'j>, [Jet<'j>; N]) -> [Jet<'j>; N],
    ) -> [[f64; N]; MOST_COEFFICIENTS] {
        let (mut tape, mut c) = (Tape::new(), [x; MOST_COEFFICIENTS]);
        let mut series = Series::around(&mut tape, t, &x, 0, 7, 1.0);
        series.flow(&flow);
        series.read(&mut c);
        // The rest, of a series that is gone on with.
        let mut series = Series::around(&mut tape, t, &x, 7, 14, 1.0);
        series.flow(&flow);
        series.read(&mut c);
        c
    }

    #[test]
    fn solutions_that_are_known() {
        let factorial = |k: usize| (1..=k).map(|k| k as f64).product::<f64>();
        let close = |got: f64, expected: f64| assert!((got - expected).abs() <= 1e-15, "{got} {expected}");
        let exponential = coefficients(0.0, [1.0], |_, [x]| [x]);
        let circle = coefficients(0.0, [0.0, 1.0], |_, [x, v]| [v, -x]);
        let pole = coefficients(0.0, [1.0], |_, [x]| [x * x]); // 1/(1 - t)
        let root = coefficients(0.0, [1.0], |_, [x]| [0.5 / x]); // √(1 + t)
        let driven = coefficients(2.0, [0.0], |t, [_]| [3.0 * t * t]); // t³ - 8 from t = 2
        for k in 0..=14 {
            close(exponential[k][0], 1.0 / factorial(k));
            let sine = [0.0, 1.0, 0.0, -1.0][k % 4] / factorial(k);
            close(circle[k][0], sine);
            close(pole[k][0], 1.0);
            let binomial = (0..k).map(|j| (0.5 - j as f64) / (j + 1) as f64).product::<f64>();
            close(root[k][0], binomial);
            close(driven[k][0], if k < 4 { [0.0, 12.0, 6.0, 1.0][k] } else { 0.0 });
        }
    }

    proptest! {
        /// Laws that hold for every series: what they say is zero has no coefficient.
        #[test]
        fn laws(x in 0.2..2.0_f64, y in -1.0..1.0_f64, p in -2.5..2.5_f64) {
            const LAWS: usize = 12;
            let c = coefficients::<{ LAWS + 2 }>(0.3, std::array::from_fn(|i| if i < 2 { [x, y][i] } else { 0.0 }), |t, state| {
                let (x, y) = (state[0], state[1]);
                let (s, c) = y.sin_cos();
                let zeros = [
                    s * s + c * c - 1.0,
                    x.ln().exp() - x,
                    x.sqrt() * x.sqrt() - x,
                    x.powf(p) * x.powf(1.0 - p) - x,
                    x.powi(3) / (x * x) - x,
                    x.powi(-2) * x * x - 1.0,
                    (y.tan()).atan() - y,
                    y.tanh() - ((2.0 * y).exp() - 1.0) / ((2.0 * y).exp() + 1.0),
                    (y - 2.0).abs() + (y - 2.0),
                    x.recip() - 1.0 / x,
                    (x - y) * (x + y) - (x.powi(2) - y.powi(2)),
                    x.powi(0) - y.cos() * y.cos() - y.sin().powi(2),
                ];
                let rate = |i: usize| match i { 0 => 0.3 - 0.5 * x * y, 1 => (x - 1.0) + 0.2 * t, _ => zeros[i - 2] };
                std::array::from_fn(rate)
            });
            let most = |i: usize| (1..=14).map(|k| c[k][i].abs()).fold(1.0, f64::max);
            for i in 2..LAWS + 2 {
                for (k, c) in c[1..=14].iter().enumerate() {
                    // Of the orders that a law of x or of y is of, the sizes grow alike.
                    let scale = 1e-11 * most(0).max(most(1)) * 5.0_f64.powi(k as i32);
                    prop_assert!(c[i].abs() <= scale, "law {}, order {k}: {:e}", i - 2, c[i]);
                }
            }
        }
    }

    #[test]
    fn a_flow_that_takes_another_way_has_no_series() {
        let calls = Cell::new(0);
        let c = coefficients(0.0, [1.0], |_, [x]| {
            calls.set(calls.get() + 1);
            [(0..calls.get()).fold(x, |sum, _| sum + x)]
        });
        assert!(c[7][0].is_nan() || c[14][0].is_nan());
    }
}
