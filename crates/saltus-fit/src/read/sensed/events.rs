//! What a sensor logs of itself: when it changes from one of two states to the other, and when and
//! how strongly it was triggered.

use std::f64::consts::SQRT_2;

use super::clock;
use super::felt::{By, Felt, PULSES, Series};
use crate::read::ReadOptions;
use crate::read::cell::Cell;
use crate::read::heading::Heading;
use crate::read::phrases::Phrase;
use crate::read::region::Region;
use crate::read::vocabulary::Atom;
use crate::read::words::has_word;
use crate::statistics::{median, rounding};

/// A switch that closes again within this time, s, chatters: no flight is so short.
const CHATTER: f64 = 0.002;
/// No log tells a time better, s: of a microsecond.
const FINEST: f64 = 3e-7;
/// The heights of a beam that bounces tell agree to this part.
const BEAM: f64 = 0.1;
/// No beam is so high above the floor, m.
const HIGHEST: f64 = 10.0;
/// The height is found by halving its range so often: to a thousand millionth of it.
const HALVED: usize = 34;

/// The times at which a column of two states is in the rarer one, from begin to end.
pub(super) struct States {
    pub(super) column: usize,
    rows: usize,
    spans: Vec<Felt>,
}

impl States {
    /// The states of a column beside times; `None` where it has no two of them.
    pub(super) fn of(region: &Region<'_>, options: &ReadOptions, headings: &[Heading]) -> Option<Self> {
        let (clock, (rows, times)) = (0..headings.len())
            .find_map(|n| Some((n, clock::times(region, options, &headings[n], n)?)))
            .filter(|(_, (_, times))| times.windows(2).all(|pair| pair[0] < pair[1]))?;
        (0..headings.len()).filter(|&n| n != clock).find_map(|column| {
            let cells: Vec<&str> = rows.iter().map(|&row| region.cell(row, column)).collect();
            let first = *cells.first()?;
            let other = *cells.iter().find(|cell| **cell != first)?;
            let two =
                !first.is_empty() && !other.is_empty() && cells.iter().all(|cell| *cell == first || *cell == other);
            two.then(|| Self::between(column, &rows, &times, &cells)).filter(|states| states.spans.len() >= PULSES)
        })
    }

    /// The spans of the state that lasts less.
    fn between(column: usize, rows: &[usize], times: &[f64], cells: &[&str]) -> Self {
        // Where each state begins: in its row, or half way from the row before where that is a
        // sample of the other.
        let sampled = cells.windows(2).filter(|pair| pair[0] == pair[1]).count() > 1;
        let written = rounding(times).max(FINEST);
        let begins = |n: &usize| *n == 0 || cells[*n] != cells[*n - 1];
        let change = |n: usize| match n.checked_sub(1).filter(|_| sampled) {
            Some(before) => (n, 0.5 * (times[n] + times[before]), (times[n] - times[before]) / 12f64.sqrt()),
            None => (n, times[n], written),
        };
        let changes: Vec<(usize, f64, f64)> = (0..cells.len()).filter(begins).map(change).collect();
        let spans = |from: usize| {
            let span = |pair: &[(usize, f64, f64)]| Felt {
                begin: pair[0].1,
                end: pair[1].1,
                sigma: pair[0].2.max(pair[1].2),
                peak: 1.0,
                row: rows[pair[0].0],
            };
            changes.windows(2).skip(from).step_by(2).map(span).collect::<Vec<Felt>>()
        };
        let lasts = |spans: &[Felt]| spans.iter().map(|span| span.end - span.begin).sum::<f64>();
        let (even, odd) = (spans(0), spans(1));
        let spans = if lasts(&odd) < lasts(&even) { odd } else { even };
        Self { column, rows: rows.len(), spans }
    }

    /// Contacts that close a switch.
    pub(super) fn contacts(&self) -> Series {
        let mut felt: Vec<Felt> = Vec::new();
        for span in &self.spans {
            match felt.last_mut().filter(|last| span.begin - last.end < CHATTER) {
                Some(last) => last.end = span.end,
                None => felt.push(*span),
            }
        }
        Series { column: self.column, rows: self.rows, felt, end: true, by: By::States }
    }

    /// Contacts between the times at which a ball blocks a beam, on its way down and up.
    ///
    /// Above the beam it flies for 2 v/g, so that its speed there is known; from there to the floor
    /// and back it takes as long as the height of the beam says, which is the same at every bounce.
    pub(super) fn below_a_beam(&self, gravity: f64) -> Option<Series> {
        let passes: Vec<(Felt, Felt)> = self.spans.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
        let speeds: Vec<f64> =
            passes.windows(2).map(|pair| 0.5 * gravity * (pair[1].0.begin - pair[0].1.end)).collect();
        // How long the ball falls on from the beam at a speed.
        let falls = |height: f64, speed: f64| ((speed.powi(2) + 2.0 * gravity * height).sqrt() - speed) / gravity;
        let height = |n: usize| {
            let below = passes[n].1.end - passes[n].0.begin;
            let within = |(low, high): (f64, f64), _| {
                let middle = 0.5 * (low + high);
                let lasts = falls(middle, speeds[n - 1]) + falls(middle, speeds[n]);
                if lasts > below { (low, middle) } else { (middle, high) }
            };
            (0..HALVED).fold((0.0, HIGHEST), within).0
        };
        let heights: Vec<f64> = (1..speeds.len()).map(height).collect();
        let beam = median(&mut heights.clone()).filter(|beam| *beam > 0.0)?;
        let kept = heights.iter().take_while(|height| (**height / beam - 1.0).abs() < BEAM).count();
        if kept + 1 < PULSES || speeds.iter().take(kept + 1).any(|speed| *speed <= 0.0) {
            return None;
        }
        let contact = |n: usize| {
            let time = passes[n].1.end - falls(beam, speeds[n]);
            Felt { begin: time, end: time, sigma: SQRT_2 * passes[n].1.sigma, ..passes[n].0 }
        };
        // The pass after the last of these begins with a flight that is known.
        let last = passes.get(kept + 1).map(|(down, _)| {
            let time = down.begin + falls(beam, speeds[kept]);
            Felt { begin: time, end: time, sigma: SQRT_2 * down.sigma, ..*down }
        });
        let felt = (0..=kept).map(contact).chain(last).collect();
        Some(Series { column: self.column, rows: self.rows, felt, end: false, by: By::Beam })
    }
}

/// When a sensor was triggered, beside how strongly, in the only other numbers of the table.
pub(super) fn triggered(region: &Region<'_>, options: &ReadOptions, headings: &[Heading]) -> Option<Series> {
    let (clock, (rows, times)) =
        (0..headings.len()).find_map(|n| Some((n, clock::times(region, options, &headings[n], n)?)))?;
    let others =
        || (0..headings.len()).filter(|&n| n != clock && region.numbers(n).next().is_some() && !region.counts(n));
    let column = others().next().filter(|_| others().count() == 1)?;
    // What is called by how much a sensor shows is no height.
    let shown = has_word(&headings[column].text, Phrase::Shown);
    if !shown && (headings[column].has(Atom::Height) || headings[column].has(Atom::Position)) {
        return None;
    }
    let number = |row: usize| match region.view.read(row, column) {
        Cell::Number(measured) if measured.unit.is_none() && measured.value > 0.0 => Some(measured.value),
        _ => None,
    };
    let sigma = rounding(&times).max(FINEST);
    let felt = |(&row, &time): (&usize, &f64)| Some(Felt { begin: time, end: time, sigma, peak: number(row)?, row });
    let felt: Vec<Felt> = rows.iter().zip(&times).map(felt).collect::<Option<_>>()?;
    let ordered = times.windows(2).all(|pair| pair[0] < pair[1]);
    ordered.then_some(Series { column, rows: rows.len(), felt, end: false, by: By::Triggers })
}
