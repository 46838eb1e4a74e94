//! A table from what a sensor shows that feels the ball hit: a force plate, a load cell, a piezo, a
//! switch, an accelerometer in the ball. Its pulses are the contacts, where they come ever sooner
//! as those of a ball do; so are the tops of its flights, where a sensor shows how fast it is.

mod clock;
mod events;
mod felt;
mod speeds;

use super::aside::{LeftAside, Part, Why};
use super::grid::shown;
use super::heading::{Heading, What};
use super::heard;
use super::phrases::Phrase;
use super::region::Region;
use super::units::{Dimension, Unit};
use super::words::has_word;
use super::{Metadata, ReadOptions, Table};
use crate::elementary::hypot;
use crate::quantity::STANDARD_GRAVITY;
use crate::sound::{Pulses, Sound};
use clock::Clock;
use events::States;
use felt::{By, Felt, PULSES, Series};

/// Whether a column is called by how much a sensor shows, which in a unit of length would be how
/// high a ball is.
pub(super) fn shows(region: &Region<'_>) -> bool {
    region.header.iter().any(|text| has_word(text, Phrase::Shown) && Heading::parse(text).unit.is_none())
}

/// A column of samples, or the size of a vector whose parts three columns hold, and its pulses.
struct Sensor {
    column: usize,
    /// Whether it is the size of a vector.
    vector: bool,
    unit: String,
    samples: Vec<f64>,
    found: Pulses,
}

/// The contacts that a sensor felt; `None` where the table is none of one, or where no ball bounces
/// in it.
pub(super) fn table(region: &Region<'_>, options: &ReadOptions, metadata: Metadata) -> Option<Table> {
    let headings: Vec<Heading> = region.header.iter().map(|text| Heading::parse(text)).collect();
    let holds = |n: usize, what: What| places(&headings[n], what) && region.numbers(n).next().is_some();
    let [high, fast] = [What::Height, What::Speed].map(|what| (0..headings.len()).any(|n| holds(n, what)));
    let filmed = high || fast;
    // Light that a ball blocks is none that it hits.
    let texts = region.aside.iter().map(|aside| aside.name.as_str()).chain([region.view.grid.name]);
    let gate = texts.chain(region.header.iter().map(String::as_str)).any(|text| has_word(text, Phrase::Gate));
    let clock = Clock::of(region, options, &headings);
    let sampled = clock.filter(|_| !gate && !filmed).and_then(|clock| sampled(region, options, &headings, &clock));
    let (mut table, column) = sampled.or_else(|| {
        let states = States::of(region, options, &headings).filter(|_| !filmed);
        let gravity = metadata.gravity.unwrap_or(STANDARD_GRAVITY);
        let contacts = states.as_ref().filter(|_| !gate).map(States::contacts);
        let series = [contacts, states.and_then(|states| states.below_a_beam(gravity))];
        let triggered = || events::triggered(region, options, &headings).filter(|_| !gate);
        let of = |series: Series| Some((series.table(region)?.0, series.column));
        let logged = series.into_iter().flatten().find_map(of).or_else(|| of(triggered()?));
        logged.or_else(|| speeds::table(region, options, &headings, metadata.gravity).filter(|_| fast && !high))
    })?;
    let (drop, frame_rate) = (options.drop.or(metadata.drop), None);
    table.metadata = Metadata { drop, frame_rate, intervals: table.metadata.intervals, ..metadata };
    let clocked = |n: usize| clock::times(region, options, &headings[n], n).is_some();
    let known = |n: usize| table.left_aside.iter().any(|aside| aside.name == shown(&region.header[n]));
    let others = (0..headings.len()).filter(|&n| n != column && !clocked(n) && !known(n));
    let left = others.filter(|&n| region.numbers(n).next().is_some());
    let left: Vec<LeftAside> =
        left.map(|n| LeftAside::new(Part::Column, shown(&region.header[n]), Why::Other)).collect();
    table.left_aside.extend(region.aside.iter().cloned().chain(left));
    Some(table)
}

/// The contacts in samples, and the column that shows them: of several that with the most, of those
/// one that tells how long they last, of those a part of a vector before its size, and the one with
/// the largest pulses.
fn sampled(region: &Region<'_>, options: &ReadOptions, headings: &[Heading], clock: &Clock) -> Option<(Table, usize)> {
    let asked =
        |n: &usize| options.column.as_deref().is_none_or(|name| region.header[*n].eq_ignore_ascii_case(name.trim()));
    let others = || (0..headings.len()).filter(|n| Some(*n) != clock.column && asked(n));
    let single = others().filter_map(|n| Sensor::of(region, headings, &[n], clock));
    let vectors = others().filter_map(|n| Sensor::of(region, headings, &vector(region, n)?, clock));
    let sensors: Vec<Sensor> = single.chain(vectors).collect();
    let alike = sensors.iter().all(|sensor| sensor.unit == sensors[0].unit);
    let found = sensors.iter().filter_map(|sensor| {
        let (table, contacts) = sensor.table(region, options, clock)?;
        let rank = (contacts, table.metadata.intervals, !sensor.vector);
        Some((sensor, table, rank))
    });
    let (best, mut table, _) =
        found.max_by(|(a, _, rank), (b, _, other)| rank.cmp(other).then(a.size(alike).total_cmp(&b.size(alike))))?;
    let fainter = sensors.iter().filter(|sensor| !sensor.vector && sensor.column != best.column);
    let left = fainter.map(|s| LeftAside::new(Part::Column, shown(&region.header[s.column]), Why::Fainter));
    table.left_aside.extend(left);
    Some((table, best.column))
}

/// The columns of the parts of a vector of which one is the first: their names differ in the letter
/// of the axis alone.
fn vector(region: &Region<'_>, first: usize) -> Option<[usize; 3]> {
    let letters: Vec<char> = region.header[first].to_lowercase().chars().collect();
    let of = |at: usize, axis: char| {
        let mut name = letters.clone();
        name[at] = axis;
        let name: String = name.into_iter().collect();
        region.header.iter().position(|other| other.to_lowercase() == name)
    };
    let places = (0..letters.len()).filter(|&at| letters[at] == 'x');
    places.into_iter().find_map(|at| Some([first, of(at, 'y')?, of(at, 'z')?]))
}

/// Whether a heading is that of heights, places or speeds: the ball was filmed.
fn places(heading: &Heading, what: What) -> bool {
    let of = |dimension: Dimension| heading.unit.is_none_or(|unit| unit.dimension == dimension);
    let place = |of_column: What| match of_column {
        _ if of_column != what => false,
        What::Height => of(Dimension::Length) && !(heading.unit.is_none() && has_word(&heading.text, Phrase::Shown)),
        What::Speed => of(Dimension::Speed),
        _ => false,
    };
    heading.unknown.is_empty() && heading.value().is_some_and(|value| place(value.what))
}

impl Sensor {
    /// The samples of a column, or of the size of a vector, unless no contact shows in it.
    fn of(region: &Region<'_>, headings: &[Heading], columns: &[usize], clock: &Clock) -> Option<Self> {
        let other = |unit: Unit| unit.dimension != Dimension::Other;
        let unfelt = |n: &usize| headings[*n].unit.is_some_and(other) || has_word(&headings[*n].text, Phrase::Unfelt);
        if columns.iter().any(unfelt) {
            return None;
        }
        let number = |row: usize, n: usize| region.view.number(row, n);
        let size = |row: &usize| columns.iter().try_fold(0.0, |size, &n| Some(hypot(size, number(*row, n)?)));
        let sample = |row: &usize| if let [one] = columns { number(*row, *one) } else { size(row) };
        let samples: Vec<f64> = clock.rows.iter().map(sample).collect::<Option<_>>()?;
        let column = columns[0];
        let text = &headings[column].text;
        let bracket = text.rfind(['(', '[']).map_or("", |at| &text[at..]);
        let found = Pulses::of(clock.step, &samples);
        Some(Self { column, vector: columns.len() > 1, unit: bracket.to_lowercase(), samples, found })
    }

    /// How large its pulses are: the last of so many as are wanted, in its unit or in its noise.
    fn size(&self, alike: bool) -> f64 {
        let mut peaks: Vec<f64> = self.found.pulses.iter().map(|pulse| pulse.peak).collect();
        peaks.sort_unstable_by(|a, b| b.total_cmp(a));
        peaks.get(PULSES - 1).map_or(0.0, |peak| if alike { *peak } else { peak / self.found.noise })
    }

    /// The contacts of its pulses, and how many: what swings both ways, fast enough, is a sound.
    fn table(&self, region: &Region<'_>, options: &ReadOptions, clock: &Clock) -> Option<(Table, usize)> {
        self.heard(region, options, clock).or_else(|| self.felt(clock).table(region))
    }

    fn heard(&self, region: &Region<'_>, options: &ReadOptions, clock: &Clock) -> Option<(Table, usize)> {
        let most = self.samples.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // out of range it stays at an end
        let rate = (1.0 / clock.step).round() as u32;
        #[allow(clippy::cast_possible_truncation)] // single precision does
        let samples: Vec<f32> = self.samples.iter().map(|x| (0.9 * x / most) as f32).collect();
        let sound = self.found.swings.then(|| Sound::of(region.view.grid.name, rate, &samples).ok())??;
        let contacts = sound.drops().iter().map(Vec::len).sum();
        let mut table = heard::table(sound, options);
        for reading in table.trials.iter_mut().flat_map(|trial| &mut trial.readings) {
            reading.time = reading.time.map(|time| clock.at(time));
        }
        Some((table, contacts))
    }

    fn felt(&self, clock: &Clock) -> Series {
        let felt = self.found.pulses.iter().map(|pulse| Felt {
            begin: clock.at(pulse.begin),
            end: clock.at(pulse.end),
            sigma: pulse.sigma,
            peak: pulse.peak,
            row: clock.row(pulse.begin),
        });
        let (felt, end) = (felt.collect(), self.found.end());
        Series { by: By::Samples, column: self.column, rows: clock.rows.len(), felt, end }
    }
}
