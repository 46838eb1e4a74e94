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
/// A sample is near the top within this part of a flight, or so many times the noise.
const TOP: f64 = 0.05;
const STILL: f64 = 4.0;
/// A ball that stays near the top of its last flight for so many times as long as a flight does is
/// held.
const HELD: f64 = 1.5;
/// What rises so many times more slowly than the ball fell, by its height over the square of the
/// time, is in a hand.
const SLOW: f64 = 3.0;
/// A ball that falls from its last top, but stays above the parabola by this part of the rise, is
/// caught; until then it is above it by so many times the noise at most.
const CAUGHT: f64 = 0.1;
const SCATTERS: f64 = 3.0;
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
    let aloft = minima.iter().position(|&i| high(i));
    let ended = aloft.map_or(times.len(), |n| minima[n]);
    minima.truncate(aloft.unwrap_or(minima.len()));
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
    // A flight that comes up higher than the one before it is no rebound: a hand lifts the ball.
    let high = |n: usize| {
        let to = minima.get(n).copied().unwrap_or(ended);
        smooth[starts[n]..to].iter().copied().fold(f64::NEG_INFINITY, f64::max)
    };
    if let Some(lifted) = (2..starts.len()).find(|&n| high(n) > high(n - 1) + least) {
        starts.truncate(lifted);
    }
    let contacts = starts.len() - 1;
    if contacts == 0 {
        return Err(NoFlights::TooFew);
    }
    let ended = minima.get(contacts).copied().unwrap_or(ended);
    // Heights over the squares of their times are alike for all flights, to within what is taken
    // off the fall of a ball that was held.
    let fall = (smooth[begin] - smooth[first]) / (times[first] - times[begin]).powi(2);
    let mut end = end((times, &smooth), (starts[contacts], ended), floor, (least, noise), fall / SLOW);
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

/// How far below the top of a flight that rises, or falls, by so much its samples are near it: a
/// twentieth of that, or what noise makes of a ball at rest.
fn near_top(rise: f64, noise: f64) -> f64 {
    (TOP * rise).max(STILL * noise)
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
    let high = heights[top] - near_top(fall, noise);
    let falling = (0..contact).rev().find(|&i| heights[i] >= high).unwrap_or(top);
    // From rest the first twentieth of a fall takes 0.29 of the time of the rest; longer means
    // held.
    let near = (0..=top).find(|&i| heights[i] >= high).unwrap_or(top);
    let held = times[falling] - times[near] > 0.4 * (times[contact] - times[falling]);
    if held { falling + 1 } else { top }
}

/// One past the last sample of the last flight: where it nears the floor again, is caught or held,
/// or the series ends.
fn end(
    (times, heights): (&[f64], &[f64]),
    (contact, ended): (usize, usize),
    floor: f64,
    (least, noise): (f64, f64),
    slowest: f64,
) -> usize {
    let mut top = contact;
    for i in contact..ended {
        if heights[i] > heights[top] {
            top = i;
        }
    }
    // The part of a flight that lies near its top takes no longer than by its parabola, but where a
    // hand holds the ball.
    let rise = heights[top] - heights[contact];
    if rise < slowest * (times[top] - times[contact]).powi(2) {
        return contact;
    }
    let part = near_top(rise, noise) / rise;
    let near = |i: &usize| heights[*i] >= heights[top] - part * rise;
    let came = (contact..top).find(near).unwrap_or(top);
    let left = (top..ended).find(|i| !near(i)).unwrap_or(ended);
    let parabola = 2.0 * part.sqrt() / (1.0 - part.sqrt()) * (times[came] - times[contact]);
    if part < 1.0 && times[left - 1] - times[came] > HELD * parabola {
        return came;
    }
    // On its way down it is as high as the parabola says, but where a hand catches it.
    let (apex, climb) = (0.5 * (times[came] + times[left - 1]), times[came] - times[contact]);
    let fall = 1.0 - part.sqrt();
    let above = |i: usize| heights[i] - heights[top] + rise * (fall * (times[i] - apex) / climb).powi(2);
    let caught = (left..ended).find(|&i| above(i) > (CAUGHT * rise).max(ABOVE_NOISE * noise));
    let followed = |i: usize| (left..i).rev().find(|&j| above(j) < SCATTERS * noise).map_or(left, |j| j + 1);
    let ended = caught.map_or(ended, followed);
    let mut low = heights[top];
    for i in top..ended {
        low = low.min(heights[i]);
        if heights[i] < floor + 0.1 * (heights[top] - floor) || heights[i] > low + 0.25 * least {
            return i;
        }
    }
    ended
}
