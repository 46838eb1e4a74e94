//! A table from the samples of a sensor that feels the ball hit: a force plate, a load cell, a
//! piezo. Its pulses are the contacts, where they come ever sooner as those of a ball do.

use super::aside::{LeftAside, Part, Why};
use super::grid::shown;
use super::heading::{Heading, What};
use super::heard;
use super::lasting::{self, Lasting};
use super::phrases::Phrase;
use super::region::Region;
use super::units::{Dimension, Unit};
use super::words::has_word;
use super::{Event, Metadata, ReadOptions, Reading, Table, Trial};
use crate::elementary::{hypot, ln};
use crate::finding::Note;
use crate::sound::{Bounced, Onset, Pulse, Pulses, Sound, Unused};
use crate::statistics::Line;

/// Samples no further apart than this, s, show contacts: slower ones miss most of them.
const SLOWEST: f64 = 0.0101;
/// Fewer samples than these are none of a sensor: at the slowest, one second.
const SAMPLES: usize = 100;
/// Fewer pulses tell no ratio of flights.
const PULSES: usize = 3;
/// A pulse of less than this part of the least contact may be of anything.
const STRAY: f64 = 0.5;
/// What lasts longer than so many of the longest contacts is a load, and no contact.
const LOAD: f64 = 1.5;

/// Whether a column is called by how much a sensor shows, which in a unit of length would be how
/// high a ball is.
pub(super) fn shows(region: &Region<'_>) -> bool {
    region.header.iter().any(|text| has_word(text, Phrase::Shown) && Heading::parse(text).unit.is_none())
}

/// The clock of evenly spaced samples.
struct Clock {
    column: usize,
    /// The rows that bear a time.
    rows: Vec<usize>,
    /// The first time and the time between samples, s.
    first: f64,
    step: f64,
}

/// A column of samples, and the pulses in it.
struct Sensor {
    column: usize,
    unit: String,
    samples: Vec<f64>,
    found: Pulses,
}

/// The contacts that a sensor felt; `None` where the table is none of its samples, or where no
/// ball bounces in them.
pub(super) fn table(region: &Region<'_>, options: &ReadOptions, metadata: Metadata) -> Option<Table> {
    let headings: Vec<Heading> = region.header.iter().map(|text| Heading::parse(text)).collect();
    let texts = region.aside.iter().map(|aside| aside.name.as_str()).chain([region.view.grid.name]);
    // Light that a ball blocks is none that it hits.
    if texts.chain(region.header.iter().map(String::as_str)).any(|text| has_word(text, Phrase::Gate)) {
        return None;
    }
    let clock = (0..headings.len()).find_map(|column| Clock::of(region, options, &headings, column))?;
    let others = || (0..headings.len()).filter(|&n| n != clock.column);
    if others().any(|n| places(&headings[n]) && region.numbers(n).next().is_some()) {
        return None;
    }
    let asked =
        |n: &usize| options.column.as_deref().is_none_or(|name| region.header[*n].eq_ignore_ascii_case(name.trim()));
    let sensors: Vec<Sensor> =
        others().filter(asked).filter_map(|n| Sensor::of(region, &headings[n], n, &clock)).collect();
    let best = sensors.iter().filter(|sensor| sensor.found.pulses.len() >= PULSES).max_by(|a, b| {
        let alike = sensors.iter().all(|sensor| sensor.unit == sensors[0].unit);
        a.size(alike).total_cmp(&b.size(alike))
    })?;
    let mut table = match best.heard(region, options, &clock) {
        Some(table) => table,
        None => best.felt(region, &clock)?,
    };
    let (drop, frame_rate) = (options.drop.or(metadata.drop), None);
    table.metadata = Metadata { drop, frame_rate, intervals: table.metadata.intervals, ..metadata };
    let left = others().filter(|&n| n != best.column && region.numbers(n).next().is_some()).map(|n| {
        let fainter = sensors.iter().any(|sensor| sensor.column == n);
        LeftAside::new(Part::Column, shown(&region.header[n]), if fainter { Why::Fainter } else { Why::Other })
    });
    table.left_aside.extend(region.aside.iter().cloned().chain(left));
    Some(table)
}

/// Whether a heading is that of a height, a place or a speed: the ball was filmed.
fn places(heading: &Heading) -> bool {
    let of = |dimension: Dimension| heading.unit.is_none_or(|unit| unit.dimension == dimension);
    let place = |what: What| match what {
        What::Height => of(Dimension::Length) && !(heading.unit.is_none() && has_word(&heading.text, Phrase::Shown)),
        What::Speed => of(Dimension::Speed),
        _ => false,
    };
    heading.unknown.is_empty() && heading.value().is_some_and(|value| place(value.what))
}

/// Whether, from first to last contact of each drop, most pulses that are half as large as the
/// least of its contacts are contacts.
fn most(pulses: &[&Pulse], bounced: &Bounced) -> bool {
    bounced.drops.iter().all(|drop| {
        let least = drop.iter().map(|&(n, _)| pulses[n].peak).fold(f64::INFINITY, f64::min);
        let within = |n: usize| drop.first().is_some_and(|f| f.0 < n) && drop.last().is_some_and(|l| n < l.0);
        let stray = |&&(n, why): &&(usize, Unused)| within(n) && why == Unused::Stray && pulses[n].peak > STRAY * least;
        2 * bounced.unused.iter().filter(stray).count() < drop.len()
    })
}

impl Clock {
    /// The clock in a column, if its times are as far apart as one another, and close.
    fn of(region: &Region<'_>, options: &ReadOptions, headings: &[Heading], column: usize) -> Option<Self> {
        let heading = &headings[column];
        let timed = |unit: &Unit| unit.dimension == Dimension::Time;
        let named = heading.unit.or_else(|| Unit::parse(heading.text.trim())).filter(timed);
        let time = heading.value().is_some_and(|v| matches!(v.what, What::Time | What::Total));
        let given = || options.time_unit.as_deref().and_then(Unit::parse).or(region.units.0);
        let unit = named.or_else(|| time.then(|| given().filter(timed).unwrap_or(Unit::SECOND)))?;
        let read = |&row: &usize| Some((row, unit.si(region.view.number(row, column)?)));
        let (rows, times): (Vec<usize>, Vec<f64>) = region.rows.iter().filter_map(read).unzip();
        let (first, last) = times.first().zip(times.last())?;
        #[allow(clippy::cast_precision_loss)] // fewer than a table has cells
        let step = (last - first) / (times.len().max(2) - 1) as f64;
        // A clock may be written to no more than a sample.
        #[allow(clippy::cast_precision_loss)]
        let even = times.iter().enumerate().all(|(n, t)| (t - first - step * n as f64).abs() <= step);
        let close = step > 0.0 && step <= SLOWEST && times.len() >= SAMPLES;
        (close && even).then_some(Self { column, first: *first, step, rows })
    }
}

impl Sensor {
    /// The samples of a column, unless it holds what no contact shows in.
    fn of(region: &Region<'_>, heading: &Heading, column: usize, clock: &Clock) -> Option<Self> {
        let other = |unit: Unit| unit.dimension != Dimension::Other;
        if heading.unit.is_some_and(other) || has_word(&heading.text, Phrase::Unfelt) {
            return None;
        }
        let samples: Option<Vec<f64>> = clock.rows.iter().map(|&row| region.view.number(row, column)).collect();
        let samples = samples?;
        let bracket = heading.text.rfind(['(', '[']).map_or("", |at| &heading.text[at..]);
        let found = Pulses::of(clock.step, &samples);
        Some(Self { column, unit: bracket.to_lowercase(), samples, found })
    }

    /// How large its pulses are: the last of so many as are wanted, in its unit or in its noise.
    fn size(&self, alike: bool) -> f64 {
        let mut peaks: Vec<f64> = self.found.pulses.iter().map(|pulse| pulse.peak).collect();
        peaks.sort_unstable_by(|a, b| b.total_cmp(a));
        peaks.get(PULSES - 1).map_or(0.0, |peak| if alike { *peak } else { peak / self.found.noise })
    }

    /// What swings both ways, fast enough, is a sound.
    fn heard(&self, region: &Region<'_>, options: &ReadOptions, clock: &Clock) -> Option<Table> {
        let most = self.samples.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // out of range it stays at an end
        let rate = (1.0 / clock.step).round() as u32;
        #[allow(clippy::cast_possible_truncation)] // single precision does
        let samples: Vec<f32> = self.samples.iter().map(|x| (0.9 * x / most) as f32).collect();
        let sound = self.found.swings.then(|| Sound::of(region.view.grid.name, rate, &samples).ok())??;
        let mut table = heard::table(sound, options);
        for reading in table.trials.iter_mut().flat_map(|trial| &mut trial.readings) {
            reading.time = reading.time.map(|time| clock.first + time);
        }
        Some(table)
    }

    /// The contacts of its pulses.
    fn felt(&self, region: &Region<'_>, clock: &Clock) -> Option<Table> {
        let load = |pulse: &&Pulse| pulse.end - pulse.begin > LOAD * lasting::LONGEST;
        let (loads, pulses): (Vec<&Pulse>, Vec<&Pulse>) = self.found.pulses.iter().partition(load);
        #[allow(clippy::cast_possible_truncation)] // single precision does
        let onset = |(pulse, lasted): (&&Pulse, f64)| Onset {
            time: pulse.begin - lasted,
            sigma: pulse.sigma,
            power: pulse.peak.powi(2) as f32,
        };
        // By a clock that stands still during contacts flights shrink by one factor.
        let lasted = pulses.iter().scan(0.0, |lasted, pulse| {
            let ends = if self.found.end() { pulse.end - pulse.begin } else { 0.0 };
            Some(std::mem::replace(lasted, *lasted + ends))
        });
        let onsets: Vec<Onset> = pulses.iter().zip(lasted).map(onset).collect();
        let bounced = Bounced::among(&onsets, true).filter(|bounced| most(&pulses, bounced))?;
        let of_drop = |drop: &Vec<(usize, usize)>| {
            let contacts: Vec<(f64, f64)> = drop.iter().map(|&(n, _)| (pulses[n].begin, pulses[n].end)).collect();
            let sigma = drop.iter().map(|&(n, _)| pulses[n].sigma).fold(0.0, f64::max);
            if self.found.end() { lasting::of(&contacts, sigma) } else { Lasting::Other }
        };
        let lasting: Vec<Lasting> = bounced.drops.iter().map(of_drop).collect();
        if lasting.contains(&Lasting::Growing) {
            return None;
        }
        let floor = lasting.iter().all(|lasting| *lasting == Lasting::OnFloor);
        let mut table = Table { rows: clock.rows.len(), ..Table::default() };
        for (n, drop) in bounced.drops.iter().enumerate() {
            let contacts: Vec<(&Pulse, usize)> = drop.iter().map(|&(at, number)| (pulses[at], number)).collect();
            let label = if bounced.drops.len() > 1 { format!("drop {}", n + 1) } else { String::new() };
            table.trials.push(Trial { label, ..self.trial(region, clock, &contacts, floor) });
        }
        let contacts: usize = bounced.drops.iter().map(Vec::len).sum();
        let (column, pulses_found) = (shown(&region.header[self.column]), self.found.pulses.len());
        table.notes.push(Note::Felt { column, pulses: pulses_found, contacts }.into());
        if floor {
            table.metadata.intervals = true;
            let used = bounced.drops.iter().flatten().map(|&(n, _)| (pulses[n].begin, pulses[n].end));
            table.notes.extend(lasting::noted(used));
        }
        // Where nothing else hits the plate no chance does.
        if bounced.unused.iter().any(|(_, why)| *why == Unused::Stray) {
            table.doubts = heard::doubts(bounced.drops.iter().map(Vec::len), &bounced.evidence);
        }
        let unused = bounced.unused.iter().map(|&(n, why)| (clock.first + pulses[n].begin, why));
        let loads = loads.iter().map(|pulse| (clock.first + pulse.begin, Unused::Stray));
        table.left_aside = heard::aside(Part::Pulse, &unused.chain(loads).collect::<Vec<_>>());
        Some(table)
    }

    /// The contacts of a drop; on the `floor` from their begins to their ends.
    fn trial(&self, region: &Region<'_>, clock: &Clock, contacts: &[(&Pulse, usize)], floor: bool) -> Trial {
        let reading = |&(pulse, number): &(&Pulse, usize)| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // of a sample that there is
            let sample = (pulse.begin / clock.step).max(0.0).round() as usize;
            let line = clock.rows.get(sample).map_or(0, |&row| region.view.line(row, self.column));
            let (time, sigma_time) = (Some(clock.first + pulse.begin), Some(pulse.sigma));
            Reading { time, sigma_time, ..Reading::new(Event::Contact, number, line) }
        };
        let mut trial = Trial { readings: contacts.iter().map(reading).collect(), ..Trial::default() };
        if floor {
            let mut lasted = contacts.iter().map(|(pulse, _)| pulse.end - pulse.begin);
            lasting::aloft(&mut trial, |_| lasted.next());
        }
        if scatter(&trial) {
            trial.readings.iter_mut().for_each(|reading| reading.sigma_time = None);
        }
        trial
    }
}

/// Whether the bounces of a trial scatter by more than its times are known to: then they tell their
/// error themselves.
fn scatter(trial: &Trial) -> bool {
    let flight = |pair: &[Reading]| {
        let flight = pair[1].time? - pair[0].time?;
        Some((flight, hypot(pair[0].sigma_time?, pair[1].sigma_time?) / flight))
    };
    let flights: Vec<(f64, f64)> = trial.readings.windows(2).filter_map(flight).collect();
    let ratio = |pair: &[(f64, f64)]| (hypot(pair[0].1, pair[1].1).powi(-2), 0.0, ln(pair[1].0 / pair[0].0));
    #[allow(clippy::cast_precision_loss)] // as many as there are contacts
    let spare = flights.len().saturating_sub(2) as f64;
    Line::through(flights.windows(2).map(ratio)).all > spare
}
