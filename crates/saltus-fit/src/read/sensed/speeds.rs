//! The tops of the flights of a ball whose speed is sampled, as by a radar above it: upwards and
//! downwards alike, and none where it is too slow.
//!
//! In flight the speed falls and rises by one slope, and between is none: a straight line through
//! it, taken as negative before the top, tells when that is. From top to top the ball flies for
//! half of one flight and half of the next, so that these times shrink by the COR as flights do,
//! and tell where between them the contacts are.

use super::clock;
use crate::elementary::hypot;
use crate::finding::Note;
use crate::quantity::STANDARD_GRAVITY;
use crate::read::ReadOptions;
use crate::read::grid::shown;
use crate::read::heading::{Heading, What};
use crate::read::region::Region;
use crate::read::{Event, Reading, Table, Trial};
use crate::statistics::{Line, median, rounding};

/// A top lies where the speed is less than this part of that at the contact before, and the flight
/// goes on from where it is more again.
const SLOW: f64 = 0.4;
/// No contact is slower than this part of the fastest: what remains is noise.
const LEAST: f64 = 0.05;
/// Speeds of less than this part of the largest of a flight may be of either side of its top.
const EITHER: f64 = 0.2;
/// So many speeds tell the top of a flight,
const FEWEST: usize = 6;
/// and so many tops the COR.
const TOPS: usize = 3;
/// Speeds lie on the line of their flight to within this part of the largest of it.
const STRAIGHT: f64 = 0.06;
/// The slopes of all flights, and gravity, are alike to this part: air takes less, a radar that
/// looks aslant a little more.
const ALIKE: f64 = 0.3;
/// The speed jumps where the tops tell, to within this part of the flight that follows.
const JUMPS: f64 = 0.05;

/// A flight: when its top is and how well that is known, s, and how the speed changes, 1/s of its
/// unit.
struct Flight {
    top: f64,
    sigma: f64,
    slope: f64,
}

/// The tops of flights in a column of speeds beside times; `None` where it shows none.
pub(super) fn table(
    region: &Region<'_>,
    options: &ReadOptions,
    headings: &[Heading],
    gravity: Option<f64>,
) -> Option<(Table, usize)> {
    let (clock, (rows, times)) =
        (0..headings.len()).find_map(|n| Some((n, clock::times(region, options, &headings[n], n)?)))?;
    let fast = |n: &usize| *n != clock && headings[*n].value().is_some_and(|v| v.what == What::Speed);
    let mut columns = (0..headings.len()).filter(|n| fast(n) && headings[*n].unknown.is_empty());
    let column = columns.next().filter(|_| columns.next().is_none())?;
    let speeds: Vec<f64> =
        rows.iter().map(|&row| region.view.number(row, column).map(f64::abs)).collect::<Option<_>>()?;
    if times.windows(2).any(|pair| pair[1] <= pair[0]) {
        return None;
    }
    let peaks = peaks(&speeds);
    let of = |pair: &[usize]| flight(&times[pair[0] + 1..pair[1]], &speeds[pair[0] + 1..pair[1]]);
    let flights: Vec<Flight> = peaks.windows(2).map_while(of).collect();
    let usual = median(&mut flights.iter().map(|flight| flight.slope).collect::<Vec<f64>>())?;
    let alike = |slope: f64, due: f64| (slope / due - 1.0).abs() < ALIKE;
    let falls = headings[column].unit.or(region.speed).map(|unit| unit.si(usual));
    let free = falls.is_none_or(|falls| alike(falls, gravity.unwrap_or(STANDARD_GRAVITY)));
    let shrink = flights.windows(3).all(|three| three[2].top - three[1].top < three[1].top - three[0].top);
    if flights.len() < TOPS || !free || !shrink || !flights.iter().all(|flight| alike(flight.slope, usual)) {
        return None;
    }
    let contacts = contacts(&flights);
    let jumps = |(n, pair): (usize, &[f64])| {
        let near = |m: usize| times.get(m).copied().unwrap_or(pair[0]);
        let off = JUMPS * (pair[1] - pair[0]);
        (near(peaks[n].saturating_sub(1)) - off..=near(peaks[n] + 2) + off).contains(&pair[0])
    };
    if !contacts.windows(2).enumerate().all(jumps) {
        return None;
    }
    let sigma = flights.iter().map(|flight| flight.sigma).fold(rounding(&times), hypot);
    #[allow(clippy::cast_precision_loss)] // as many as there are flights
    let sigma = sigma / (flights.len() as f64).sqrt();
    let contact = |(n, time): (usize, &f64)| {
        let line = region.view.line(rows[peaks[n.min(peaks.len() - 1)]], column);
        Reading { time: Some(*time), sigma_time: Some(sigma), ..Reading::new(Event::Contact, n + 1, line) }
    };
    let readings = contacts.iter().enumerate().map(contact).collect();
    let note = Note::Flown { column: shown(&region.header[column]), flights: flights.len() };
    let trials = vec![Trial { readings, ..Trial::default() }];
    Some((Table { rows: rows.len(), trials, notes: vec![note.into()], ..Table::default() }, column))
}

/// The contacts before, between and after the tops: as far from the one as from the other as the
/// flights before and after last, which the times between tops tell; before the first top and after
/// the last as long as on its other side.
fn contacts(flights: &[Flight]) -> Vec<f64> {
    let tops: Vec<f64> = flights.iter().map(|flight| flight.top).collect();
    let apart: Vec<f64> = tops.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut ratios: Vec<f64> = apart.windows(2).map(|pair| pair[1] / pair[0]).collect();
    let cor = median(&mut ratios).unwrap_or(1.0);
    let between: Vec<f64> = tops.iter().zip(&apart).map(|(top, apart)| top + apart / (1.0 + cor)).collect();
    let mirrored = |contact: Option<&f64>, top: Option<&f64>| Some(2.0 * top? - contact?);
    let first = mirrored(between.first(), tops.first());
    let last = mirrored(between.last(), tops.last());
    first.into_iter().chain(between.iter().copied()).chain(last).collect()
}

/// Where the speed is largest before each contact; a single sample, within a contact, is none.
fn peaks(speeds: &[f64]) -> Vec<usize> {
    let middle = |n: usize| median(&mut speeds[n.saturating_sub(1)..speeds.len().min(n + 2)].to_vec());
    let smooth: Vec<f64> = (0..speeds.len()).filter_map(middle).collect();
    let least = LEAST * smooth.iter().copied().fold(0.0, f64::max);
    let (mut found, mut top, mut low): (Vec<usize>, usize, bool) = (Vec::new(), 0, false);
    for (n, speed) in smooth.iter().enumerate() {
        if low && *speed > SLOW * found.last().map_or(0.0, |&peak| smooth[peak]) {
            (top, low) = (n, false);
        } else if !low && *speed > smooth[top] {
            top = n;
        } else if !low && *speed < SLOW * smooth[top] && smooth[top] > least {
            found.push(top);
            low = true;
        }
    }
    let largest = |top: &usize| (*top..speeds.len().min(top + 3)).max_by(|&a, &b| speeds[a].total_cmp(&speeds[b]));
    found.iter().filter_map(largest).collect()
}

/// The flight between two contacts, whose samples next to these may be of both.
#[allow(clippy::cast_precision_loss)] // fewer than a table has cells
fn flight(times: &[f64], speeds: &[f64]) -> Option<Flight> {
    let within = 1..speeds.len().checked_sub(1)?;
    let low = within.clone().min_by(|&a, &b| speeds[a].total_cmp(&speeds[b]))?;
    // Of several that are none the one in the middle.
    let none: Vec<usize> = within.clone().filter(|&n| speeds[n] <= speeds[low]).collect();
    let low = none[none.len() / 2];
    let largest = within.clone().map(|n| speeds[n]).fold(0.0, f64::max);
    let signed = |n: usize| (1.0, times[n], if n < low { -speeds[n] } else { speeds[n] });
    let used: Vec<(f64, f64, f64)> = within.filter(|&n| speeds[n] > EITHER * largest).map(signed).collect();
    let sides = [-1.0, 1.0].map(|sign| used.iter().filter(|(_, _, speed)| sign * speed > 0.0).count());
    if used.len() < FEWEST || sides.contains(&0) {
        return None;
    }
    let line = Line::through(used.iter().copied());
    let scatter = ((line.all - line.explained).max(0.0) / (used.len() - 2) as f64).sqrt();
    let first = used[0].1;
    (scatter < STRAIGHT * largest && line.slope > 0.0).then(|| Flight {
        top: first - line.at(first) / line.slope,
        sigma: scatter / line.slope / (used.len() as f64).sqrt(),
        slope: line.slope,
    })
}
