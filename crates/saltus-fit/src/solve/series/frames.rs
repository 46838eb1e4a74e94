//! The times of frames that were written down rounded: 0.03, 0.07, 0.10, 0.13 s of a film with 30
//! frames a second.

use crate::statistics::{Line, median};

/// Times are written to one of these, s.
const STEPS: [f64; 4] = [0.1, 0.01, 0.001, 1e-4];
/// Rounding that moves no time by more than this part of a frame does not matter.
const SLIGHT: f64 = 0.005;
/// Rounded times are no further than half a step from an even row, and from the line fitted to them
/// a little further.
const ROUNDED: f64 = 0.75;
/// So few times are in a row by chance.
const FEW: usize = 8;

/// Frames at an even rate.
pub(super) struct Frames {
    pub(super) times: Vec<f64>,
    /// How many there are in a second.
    pub(super) rate: f64,
    /// What the times were rounded to, s.
    pub(super) rounded: f64,
}

/// The frames whose rounded times these are, ascending; `None` if they are not those of an even
/// row, with or without gaps, or were hardly rounded.
pub(super) fn of(times: &[f64]) -> Option<Frames> {
    // Of times with so many significant digits the last are the coarsest.
    let last = &times[3 * times.len() / 4..];
    let whole = |step: &f64| last.iter().all(|t| (t / step - (t / step).round()).abs() < 1e-6);
    let rounded = STEPS.into_iter().find(whole).filter(|_| times.len() >= FEW)?;
    let steps = || times.windows(2).map(|w| w[1] - w[0]);
    let usual = median(&mut steps().collect::<Vec<f64>>())?;
    let (sum, count) = steps().filter(|s| *s < 1.5 * usual).fold((0.0, 0.0), |(s, n), step| (s + step, n + 1.0));
    let frame = sum / count;
    let mut number = 0.0;
    let later = steps().map(|step| {
        number += (step / frame).round();
        number
    });
    let numbers: Vec<f64> = std::iter::once(0.0).chain(later).collect();
    let line = Line::through(numbers.iter().zip(times).map(|(n, t)| (1.0, *n, *t)));
    let frame = line.slope;
    let even: Vec<f64> = numbers.iter().map(|n| line.at(*n)).collect();
    let worst = even.iter().zip(times).map(|(even, t)| (even - t).abs()).fold(0.0, f64::max);
    let rate = 1.0 / frame;
    (rate.is_finite() && worst > SLIGHT * frame && worst <= ROUNDED * rounded).then_some(Frames {
        times: even,
        rate,
        rounded,
    })
}
