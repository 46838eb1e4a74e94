//! An arc whose flow is known by a formula that is no polynomial.

use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::cross::{Undefined, chebyshev};
use crate::error::{Error, ErrorKind, Place};
use crate::observe::Observer;
use crate::solution::Formula;
use crate::state::State;
use crate::step::Stepper;
use crate::time::Time;
use crate::trajectory::{Piece, horner};

use super::crossing::Close;
use super::exact::natural;
use super::{Advance, ArcEnd, Span};

/// How far a piece may be from the solution, relative to the largest coefficient of each coordinate.
const AS_GOOD_AS_EXACT: f64 = 1e-12;
/// The shortest piece, as a part of its arc.
const SHORTEST: f64 = 1.0 / (1_u64 << 20) as f64;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    pub(super) fn closed(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        formula: Formula<A>,
        clock: &Span,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        self.memory.stats.exact += 1;
        let automaton = self.automaton;
        let (now, t) = (clock.now, clock.now.seconds());
        let at = |s: f64| formula(automaton, mode, t, x, s);
        let remaining = clock.end.since(now);
        let search = |this: &mut Self, edge, limit, start| {
            let natural = natural(&[*x, this.flow(mode, t, x)]);
            this.fall_in_windows(edge, now, natural, at, limit, start)
                .map(|searched| (searched, false))
                .map_err(|Undefined(s)| this.undefined(mode, edge, now, s, &at(s)))
        };
        let first = self.first_on_solution(mode, x, now, remaining, at, search, observer)?;
        let close = match &first {
            Some(first) => self.close_on_solution(first, now, at, remaining),
            None => Close { span: remaining, time: clock.end, state: at(remaining) },
        };
        if !close.state.is_finite() {
            return Err(Error::new(
                ErrorKind::Flow,
                Place::new(close.time.seconds(), mode, None::<A::Edge>, &close.state),
            ));
        }
        let told = if observer.wants_pieces() {
            interpolated(mode, now, close.span, at, observer)
        } else {
            ControlFlow::Continue(())
        };
        Ok(ArcEnd::after(first.map(|first| first.edge), told, close.time, close.state))
    }
}

/// Tells `observer` of the solution in pieces of degree eight, as long as they are as good as exact.
fn interpolated<A: Automaton>(
    mode: A::Mode,
    now: Time,
    span: f64,
    at: impl Fn(f64) -> A::State,
    observer: &mut impl Observer<A>,
) -> ControlFlow<()> {
    let (mut from, mut length) = (0.0, span);
    let late = |s: f64| now.seconds().abs() + s;
    while from < span {
        let last = from + length >= span;
        let h = if last { span - from } else { length };
        let c = fitted(|u| at(from + h * u));
        let fits = [0.221_324_6, 0.635_914_1, 0.97].iter().all(|&u| {
            let (exact, fit) = (at(from + h * u), horner(&c, u));
            (0..exact.len()).all(|i| {
                let most = c.iter().map(|c| c.get(i).abs()).fold(0.0, f64::max);
                // No nearer than the rounding of time allows, late in an arc that swings or in a run, nor than the smallest numbers can say.
                let rate: f64 = c.iter().enumerate().map(|(k, c)| k as f64 * c.get(i).abs()).sum();
                let hidden = f64::MIN_POSITIVE + 4.0 * f64::EPSILON * rate * late(from + h) / h;
                (exact.get(i) - fit.get(i)).abs() <= AS_GOOD_AS_EXACT * most + hidden
            })
        });
        if !fits && h > SHORTEST * span {
            length = 0.5 * h;
            continue;
        }
        observer.piece(mode, &Piece::new(now.after(from), h, h, &c))?;
        from = if last { span } else { from + h };
        length = 2.0 * h;
    }
    ControlFlow::Continue(())
}

/// The powers of u of the interpolant of degree eight on `0..=1`.
fn fitted<S: State>(at: impl Fn(f64) -> S) -> [S; 9] {
    let values = chebyshev::NODES.map(|x| at(0.5 + 0.5 * x));
    let mut powers = values;
    for i in 0..values[0].len() {
        let column = chebyshev::powers(&values.each_ref().map(|value| value.get(i)));
        for (power, value) in powers.iter_mut().zip(column) {
            *power = power.with(|k| if k == i { value } else { power.get(k) });
        }
    }
    powers[0] = values[0];
    powers
}
