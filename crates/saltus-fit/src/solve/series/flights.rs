//! Where a series of heights falls into flights: the contacts, which samples belong to which
//! flight, which to none.
//!
//! A flight has one maximum and no minimum, so every minimum that rises and falls by more than
//! noise on both sides is a contact.

use crate::orientation::noise_by_thirds;
use crate::statistics::median;

/// A sample that is smaller than this part of the whole range, or this many times the noise, makes
/// no extreme.
const PROMINENT: f64 = 0.01;
const ABOVE_NOISE: f64 = 8.0;
/// A minimum further above the floor than this part of the range is no contact with it.
const FLOOR: f64 = 0.05;
/// A flight with fewer samples than this says nothing of its own.
const FEWEST: usize = 4;

/// A series that was cut into flights: times and heights ascend in time.
#[derive(Clone, Debug)]
pub(super) struct Flights {
    pub(super) times: Vec<f64>,
    pub(super) heights: Vec<f64>,
    /// The first sample of each flight, the fall first, and one past the last sample of the last.
    pub(super) starts: Vec<usize>,
    /// The scatter from sample to sample.
    pub(super) noise: f64,
    /// Samples before the fall and after the last flight, when the ball was held or lay.
    pub(super) left_out: (usize, usize),
}

/// Why a series has no flights to compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NoFlights {
    /// It never falls and rises again.
    NoBounce,
    /// It has too few samples after the first contact, or before it.
    TooFew,
}

/// Single wild samples taken back between their neighbours, for finding extremes only.
fn smoothed(heights: &[f64]) -> Vec<f64> {
    let mut smooth = heights.to_vec();
    for (smooth, near) in smooth[1..].iter_mut().zip(heights.windows(3)) {
        *smooth = median(&mut near.to_vec()).unwrap_or(*smooth);
    }
    smooth
}

/// Minima (true) and maxima (false), alternating, each followed by a rise or a fall of at least
/// `least`.
fn extremes(heights: &[f64], least: f64) -> Vec<(usize, bool)> {
    let mut found = Vec::new();
    let (mut low, mut high) = (0, 0);
    let mut rising: Option<bool> = None;
    for (i, &h) in heights.iter().enumerate() {
        if h < heights[low] {
            low = i;
        }
        if h > heights[high] {
            high = i;
        }
        if rising != Some(true) && h > heights[low] + least {
            if rising.is_some() {
                found.push((low, true));
            }
            (rising, high) = (Some(true), i);
        } else if rising != Some(false) && h < heights[high] - least {
            found.push((high, false));
            (rising, low) = (Some(false), i);
        }
    }
    found
}

/// Cuts a series, heights upwards, into the fall and the flights after each contact.
pub(super) fn cut(times: &[f64], heights: &[f64]) -> Result<Flights, NoFlights> {
    let (noise, smooth) = (noise_by_thirds(times, heights), smoothed(heights));
    let (Some(top), Some(bottom)) = (smooth.iter().copied().reduce(f64::max), smooth.iter().copied().reduce(f64::min))
    else {
        return Err(NoFlights::NoBounce);
    };
    let least = (PROMINENT * (top - bottom)).max(ABOVE_NOISE * noise);
    let mut minima: Vec<usize> = extremes(&smooth, least).iter().filter(|e| e.1).map(|e| e.0).collect();
    // Contacts are all at the floor: the lowest few minima tell where that is.
    let mut lowest: Vec<f64> = minima.iter().map(|&i| smooth[i]).collect();
    lowest.sort_unstable_by(f64::total_cmp);
    lowest.truncate(lowest.len().div_ceil(2));
    let Some(floor) = median(&mut lowest) else {
        // A minimum of a single sample goes with the smoothing.
        let single = extremes(heights, least).iter().any(|e| e.1);
        return Err(if single { NoFlights::TooFew } else { NoFlights::NoBounce });
    };
    let sampling = |i: usize| {
        // Between two frames a ball may be this far from the floor at the lower of them; the median
        // of three has taken the lowest of both sides away.
        let near = [i.checked_sub(2), Some(i + 2)].into_iter().flatten().filter_map(|j| smooth.get(j));
        near.map(|h| (h - smooth[i]).abs()).fold(0.0, f64::max)
    };
    let high = |i: usize| smooth[i] - floor > (FLOOR * (top - bottom)).max(sampling(i));
    // A hand's first movements are no bounces; after the first minimum up in the air something else
    // than the floor was met.
    let leading = minima.iter().take_while(|&&i| high(i)).count();
    minima.drain(..leading);
    if let Some(n) = minima.iter().position(|&i| high(i)) {
        minima.truncate(n);
    }
    let Some(&first) = minima.first() else { return Err(NoFlights::NoBounce) };
    let begin = begin(times, &smooth, first, noise);
    let mut starts = vec![begin];
    for &contact in &minima {
        let last = starts.last().copied().unwrap_or(0);
        if contact < last + FEWEST {
            break;
        }
        starts.push(contact);
    }
    let contacts = starts.len() - 1;
    if contacts == 0 {
        return Err(NoFlights::TooFew);
    }
    let ended = if contacts < minima.len() { minima[contacts] } else { times.len() };
    let mut end = end(&smooth, starts[contacts], ended, floor, least);
    // The last flight may be cut short; if hardly any of it is recorded, the series ends at its
    // contact.
    if end < starts[contacts] + FEWEST {
        end = starts.pop().unwrap_or(end);
    }
    if starts.len() < 2 {
        return Err(NoFlights::TooFew);
    }
    starts.push(end);
    Ok(Flights {
        times: times.to_vec(),
        heights: heights.to_vec(),
        left_out: (begin, times.len() - end),
        starts,
        noise,
    })
}

/// The first sample of the fall: after the highest, and well below it if the ball was held there.
fn begin(times: &[f64], heights: &[f64], contact: usize, noise: f64) -> usize {
    let mut top = 0;
    for i in 0..contact {
        if heights[i] > heights[top] {
            top = i;
        }
    }
    let fall = heights[top] - heights[contact];
    let below = |part: f64| heights[top] - (part * fall).max(4.0 * noise);
    let falling = (0..contact).rev().find(|&i| heights[i] >= below(0.05)).unwrap_or(top);
    // From rest the first twentieth of a fall takes 0.29 of the time of the rest; longer means
    // held.
    let near = (0..=top).find(|&i| heights[i] >= below(0.05)).unwrap_or(top);
    let held = times[falling] - times[near] > 0.4 * (times[contact] - times[falling]);
    if held { falling + 1 } else { top }
}

/// One past the last sample of the last flight: where it nears the floor again, is caught, or the
/// series ends.
fn end(heights: &[f64], contact: usize, ended: usize, floor: f64, least: f64) -> usize {
    let mut top = contact;
    for i in contact..ended {
        if heights[i] > heights[top] {
            top = i;
        }
    }
    let mut low = heights[top];
    for i in top..ended {
        low = low.min(heights[i]);
        if heights[i] < floor + 0.1 * (heights[top] - floor) || heights[i] > low + 0.25 * least {
            return i;
        }
    }
    ended
}
