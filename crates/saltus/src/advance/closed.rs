//! An arc whose solution is a formula that is no polynomial.

use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::automaton::solution::Formula;
use crate::certainty::{FEW, MINUTE, NOTHING, TINY};
use crate::cross::chebyshev;
use crate::ending::Stop;
use crate::error::Error;
use crate::observe::Observer;
use crate::piece::{Piece, horner};
use crate::state::State;
use crate::step::Stepper;
use crate::time::{LAST, Span, Time};

use super::crossing::Close;
use super::exact::{in_numbers, natural};
use super::{Advance, ArcEnd};

/// The longest first piece of an arc, in times in which its solution changes by its own size.
const FIRST: f64 = 16.0;

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
        let remaining = clock.remaining();
        let search = |this: &mut Self, edge, limit, start| {
            let natural = natural(&[x.clone(), this.flow(mode, t, x)]);
            this.fall_in_windows(edge, now, natural, at, limit, start).map(|searched| (searched, false))
        };
        let first = self.first_on_solution(mode, x, clock, at, search, observer)?;
        let cut = self.cut_before(first.as_ref());
        if let Some((cut, stop)) = cut {
            let (told, reached) = self.interpolated(mode, x, now, cut, at, observer);
            let stop = if told.is_break() { Stop::Observer } else { stop };
            return Ok(ArcEnd::Stop { stop, time: now.after(reached), state: at(reached) });
        }
        let close = match &first {
            Some(first) => {
                let (duration, slope) = (first.crossing.root, automaton.flow(mode, t, x));
                self.memory.reach = Some(slope.with(|i| duration * slope.get(i)));
                self.close_on_solution(first, now, at, remaining)
            }
            None => Close { span: remaining, time: clock.end, state: at(remaining.min(LAST)) },
        };
        let end = if first.is_some() { close.time } else { clock.in_numbers().end };
        let close = Close { state: in_numbers(mode, end, close.state)?, ..close };
        let (told, reached) = self.interpolated(mode, x, now, close.span, at, observer);
        if reached < close.span.min(LAST) && told.is_continue() {
            let stop = Stop::Steps { most: self.options.most_steps };
            return Ok(ArcEnd::Stop { stop, time: now.after(reached), state: at(reached) });
        }
        Ok(ArcEnd::after(first.map(|first| first.edge), told, close.time, close.state))
    }

    /// Tells `observer`, if it wants to know, of the solution `at` from `x` in pieces of degree
    /// eight, as long as they are as good as exact; and how far: no further than the run's limits
    /// allow, nor than the end of numbers.
    fn interpolated(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        now: Time,
        span: f64,
        at: impl Fn(f64) -> A::State,
        observer: &mut impl Observer<A>,
    ) -> (ControlFlow<()>, f64) {
        let span = span.min(LAST);
        if !observer.wants_pieces() {
            return (ControlFlow::Continue(()), span);
        }
        let natural = natural(&[x.clone(), self.automaton.flow(mode, now.seconds(), x)]);
        // A solution that no polynomial follows over so short a piece is followed by none.
        let shortest = TINY * if natural > 0.0 { span.min(natural) } else { span };
        let mut pieces = 0;
        // What the formula is rough by, of the pieces so far, and how far the last one was off.
        let (mut noise, mut longer) = (x.with(|_| 0.0), None);
        // Of a long arc the first piece is as long as the solution takes to change.
        let (mut from, mut length) = (0.0, if natural > 0.0 { span.min(FIRST * natural) } else { span });
        while from < span {
            let last = from + length >= span;
            let h = if last { span - from } else { length };
            let c = fitted(|u| at(from + h * u));
            if h > shortest {
                let fit = Fit::of(&c, |u| at(from + h * u), h, now.seconds().abs() + from + h);
                let rough = |i: usize| longer.as_ref().is_some_and(|longer| fit.is_rough(i, longer));
                let holds = |i: usize| fit.fits(i) || fit.off.get(i) <= FEW * noise.get(i) || rough(i);
                if !(0..x.len()).all(holds) {
                    (longer, length) = (Some(fit.off), 0.5 * h);
                    continue;
                }
                // By what a piece shows itself: else it would grow with each that it lets pass.
                let shown = |i: usize| if !fit.fits(i) && rough(i) { fit.off.get(i) } else { 0.0 };
                noise = x.with(|i| noise.get(i).max(shown(i)));
            }
            longer = None;
            let told = observer.piece(mode, &Piece::new(now.after(from), h, h, &c));
            from = if last { span } else { from + h };
            if told.is_break() {
                return (told, from);
            }
            pieces += 1;
            if pieces >= self.options.most_steps {
                break;
            }
            length = 2.0 * h;
        }
        (ControlFlow::Continue(()), from)
    }
}

/// Where on a piece it is compared with the solution: between the nodes of its interpolant.
const FITS_AT: [f64; 3] = [0.221_324_6, 0.635_914_1, 0.97];

/// How far the powers of a piece are off the exact state, coordinate by coordinate.
struct Fit<S> {
    off: S,
    /// What they may be off by.
    allowed: S,
    /// The largest power.
    size: S,
}

impl<S: State> Fit<S> {
    /// The powers `c` of the part u of a piece of length `h`, which ends `late`, beside the exact
    /// state `at` it.
    fn of(c: &[S], at: impl Fn(f64) -> S, h: f64, late: f64) -> Self {
        let beside = FITS_AT.map(|u| (at(u), horner(c, u)));
        // No number where one of them is none.
        let larger = |off: f64, by: f64| if off.is_nan() || by <= off { off } else { by };
        let off = |i: usize| beside.iter().map(|(exact, fit)| (exact.get(i) - fit.get(i)).abs()).fold(0.0, larger);
        let size = c[0].with(|i| c.iter().map(|c| c.get(i).abs()).fold(0.0, f64::max));
        // No nearer than the rounding of time allows, late in an arc that swings or in a run, nor
        // than the smallest numbers can say.
        let rate = |i: usize| c.iter().enumerate().map(|(k, c)| k as f64 * c.get(i).abs()).sum::<f64>();
        let hidden = |i: usize| f64::MIN_POSITIVE + FEW * f64::EPSILON * rate(i) * late / h;
        let allowed = size.with(|i| NOTHING * size.get(i) + hidden(i));
        Self { off: size.with(off), allowed, size }
    }

    fn fits(&self, i: usize) -> bool {
        self.off.get(i) <= self.allowed.get(i)
    }

    /// Whether what coordinate `i` is off by, beside a piece twice as long, is the rounding of a
    /// formula that cancels: nine digits are right, and half of the length has not mended half of
    /// it.
    fn is_rough(&self, i: usize, longer: &S) -> bool {
        let off = self.off.get(i);
        off <= MINUTE * self.size.get(i) && 2.0 * off > longer.get(i)
    }
}

/// The powers of u of the interpolant of degree eight on `0..=1`.
fn fitted<S: State>(at: impl Fn(f64) -> S) -> [S; 9] {
    let values = chebyshev::NODES.map(|x| at(0.5 + 0.5 * x));
    let mut powers = values.clone();
    for i in 0..values[0].len() {
        let column = chebyshev::powers(&values.each_ref().map(|value| value.get(i)));
        for (power, value) in powers.iter_mut().zip(column) {
            *power = power.with(|k| if k == i { value } else { power.get(k) });
        }
    }
    let [start, ..] = values;
    powers[0] = start;
    powers
}
