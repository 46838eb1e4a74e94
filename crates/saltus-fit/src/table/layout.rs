//! From rows to trials: which layout the table has, and what each row then means.

mod wide;

use std::collections::HashMap;

use saltus_bounce::units::Quantity;

use super::header::{Columns, Kind};
use super::order::{in_order, renumbered, summed};
use super::samples;
use super::sheet::{Row, Sheet, lines, shown};
use super::stray;
use super::{Event, Metadata, ReadOptions, Reading, Table, Trial};
use crate::error::TableError;
use crate::statistics::median;

/// The layouts, each with the columns it needs.
#[derive(Clone, Copy)]
pub(super) enum Layout {
    /// `event,time_s,height_cm`: what happened, row by row.
    Events { event: usize },
    /// `bounce,height_cm` or `bounce,time_s`: numbered readings.
    Numbered { number: usize },
    /// One column of heights or contact times, in order.
    Listed,
    /// `h0_cm,height_cm`: every row is one drop and its rebound.
    Pairs,
    /// `bounce,trial 1,trial 2`: trials side by side.
    TrialColumns { number: Option<usize> },
    /// `drop_cm,trial 1 (cm),trial 2 (cm)`: a row is a height of release, and how high each drop from there rebounds.
    DropTrials,
    /// `trial,h0_cm,h1_cm,h2_cm`: bounces side by side, a row being a trial.
    BounceColumns,
    /// `trial,bounce,interval_s`: times between contacts.
    Intervals { number: Option<usize> },
    /// `time_s,height_cm`: a series of heights in time; or heights only, a frame apart.
    Samples { frame: Option<f64> },
}

/// Everything a row needs to become readings.
struct Reader<'a> {
    columns: &'a Columns,
    layout: Layout,
    time: Option<usize>,
    height: Option<usize>,
    interval: Option<usize>,
    sigma_time: Option<usize>,
    sigma_height: Option<usize>,
    drop: Option<usize>,
    groups: Vec<usize>,
    settings: Vec<usize>,
    filters: Vec<(usize, String)>,
    trials: Vec<Trial>,
    index: HashMap<String, usize>,
    /// The cells that tell trials apart, of the row before, and its trial.
    last: (String, Option<usize>),
    key: String,
    kept: usize,
    skipped: usize,
    /// The lines of rows without a position.
    missing: Vec<u64>,
}

/// Reads the rows of `sheet` into trials.
pub(super) fn table(
    sheet: &Sheet<'_>,
    columns: &Columns,
    layout: Layout,
    options: &ReadOptions,
    metadata: Metadata,
) -> Result<Table, TableError> {
    let one = |kind| columns.one(&kind);
    let filters = filters(sheet, options)?;
    let mut settings: Vec<usize> = columns.all(&Kind::Setting).chain(columns.one(&Kind::DropHeight)).collect();
    settings.sort_unstable();
    let mut groups: Vec<usize> = columns.all(&Kind::Group).chain(settings.iter().copied()).collect();
    groups.sort_unstable();
    let mut reader = Reader {
        columns,
        layout,
        time: one(Kind::Time),
        height: one(Kind::Height),
        interval: one(Kind::Interval),
        sigma_time: one(Kind::SigmaTime),
        sigma_height: one(Kind::SigmaHeight),
        drop: one(Kind::DropHeight),
        groups,
        settings,
        filters,
        trials: Vec::new(),
        index: HashMap::new(),
        last: (String::new(), None),
        key: String::new(),
        kept: 0,
        skipped: 0,
        missing: Vec::new(),
    };
    sheet.each_row(|row| reader.row(row))?;
    if reader.kept == 0 {
        let error = if reader.skipped > 0 {
            let wanted: Vec<String> = options.filters.iter().map(|(n, v)| format!("{n} = {v}")).collect();
            sheet
                .error(format!("no row has {}", wanted.join(" and ")))
                .help("check the value; without a filter every row is read")
        } else {
            sheet.error("the table has a header and no rows").help("add the readings below the header")
        };
        return Err(error);
    }
    let mut notes = columns.notes.clone();
    notes.extend(sheet.block.remarks.map(|line| format!("left aside: the text from line {line} on")));
    let what = reader.describe();
    if reader.skipped > 0 {
        notes.push(format!("{} rows kept and {} left out by the filter", reader.kept, reader.skipped));
    }
    let mut table = Table { notes, warnings: columns.warnings.clone(), metadata, ..Table::default() };
    let Reader { trials, layout, kept, missing, .. } = reader;
    table.trials = match layout {
        Layout::Numbered { number } => renumbered(sheet, trials, number, &mut table.repairs)?,
        _ => trials,
    };
    if matches!(layout, Layout::Intervals { .. }) {
        table.metadata.intervals = true;
        table.trials = table.trials.into_iter().map(|trial| summed(sheet, trial)).collect::<Result<_, _>>()?;
    }
    if let Layout::Samples { .. } = layout {
        if !missing.is_empty() {
            table.repairs.push(format!("{}: no position here, left out", lines(&missing)));
        }
        samples::series(sheet, columns, options, &mut table)?;
    }
    for trial in &mut table.trials {
        in_order(sheet, columns, trial, matches!(layout, Layout::Listed))?;
    }
    if matches!(layout, Layout::BounceColumns) && alike(&table.trials) {
        table.warnings.push(
            "the rebounds of a row are alike: if they are repeats and not bounces one after another, name them 'trial 1', 'trial 2' (--header)"
                .to_owned(),
        );
    }
    stray::warn(sheet, columns, &table.trials, &mut table.warnings)?;
    table.notes.insert(0, format!("read as {what}"));
    table.rows = kept;
    Ok(table)
}

/// Whether rebounds side by side are nearly as high as one another, and well below the release: more often repeats than bounces.
fn alike(trials: &[Trial]) -> bool {
    let falls = |first: bool| {
        let pairs = trials.iter().flat_map(|t| t.readings.windows(2)).filter(|w| (w[0].bounce == 0) == first);
        median(&mut pairs.filter_map(|w| Some(w[1].height? / w[0].height?)).collect::<Vec<f64>>())
    };
    falls(true).zip(falls(false)).is_some_and(|(drop, later)| later > 0.95 && drop < 0.9)
}

/// The columns filters name.
fn filters(sheet: &Sheet<'_>, options: &ReadOptions) -> Result<Vec<(usize, String)>, TableError> {
    let find = |(name, value): &(String, String)| {
        let index = sheet.block.header.iter().position(|cell| cell.eq_ignore_ascii_case(name.trim()));
        index.map(|index| (index, value.trim().to_owned())).ok_or_else(|| {
            sheet
                .error(format!("there is no column '{name}' to filter by"))
                .help(format!("the table has {}", sheet.block.header.join(", ")))
        })
    };
    options.filters.iter().map(find).collect()
}

/// The layout of a sheet, by its columns.
pub(super) fn layout(sheet: &Sheet<'_>, columns: &Columns, fps: Option<f64>) -> Result<Layout, TableError> {
    let one = |kind| columns.one(&kind);
    let number = one(Kind::Bounce);
    let (time, height) = (one(Kind::Time), one(Kind::Height));
    let trials = |quantity| columns.columns.iter().any(|c| c.kind == Kind::Trial(quantity));
    if trials(Quantity::Length) && one(Kind::DropHeight).is_some() && number.or(one(Kind::Event)).is_none() {
        return Ok(Layout::DropTrials);
    }
    if trials(Quantity::Length) || trials(Quantity::Time) {
        return Ok(Layout::TrialColumns { number: number.or(one(Kind::Event)) });
    }
    if columns.columns.iter().any(|c| matches!(c.kind, Kind::HeightAt(_) | Kind::TimeAt(_))) {
        return Ok(Layout::BounceColumns);
    }
    if one(Kind::Interval).is_some() && time.is_none() {
        return Ok(Layout::Intervals { number: number.or(one(Kind::Event)) });
    }
    if sheet.block.frames && height.is_some() {
        return Ok(Layout::Samples { frame: fps.map(|fps| 1.0 / fps) });
    }
    if time.is_none() && height.is_none() {
        return Err(sheet.error("no column holds heights or times").help("name one, such as 'height_cm' or 'time_s'"));
    }
    if let Some(event) = one(Kind::Event) {
        let mut counted = false;
        sheet.each_row(|row| {
            counted |= row.cell(event).parse::<f64>().is_ok();
            Ok(())
        })?;
        return Ok(if counted { Layout::Numbered { number: event } } else { Layout::Events { event } });
    }
    Ok(match (number, time, height) {
        (Some(number), _, _) => Layout::Numbered { number },
        (None, Some(_), Some(_)) => Layout::Samples { frame: None },
        (None, None, Some(_)) if one(Kind::DropHeight).is_some() => Layout::Pairs,
        _ => Layout::Listed,
    })
}

impl Reader<'_> {
    fn row(&mut self, row: &Row<'_>) -> Result<(), TableError> {
        if !self.filters.iter().all(|(index, value)| same(row.cell(*index), value)) {
            self.skipped += 1;
            return Ok(());
        }
        self.kept += 1;
        match self.layout {
            Layout::TrialColumns { number } => return self.trial_columns(row, number),
            Layout::BounceColumns => return self.bounce_columns(row),
            Layout::Pairs => return self.pair(row, self.height.unwrap_or(0)),
            Layout::DropTrials => return self.drop_trials(row),
            _ => {}
        }
        let trial = self.trial(row)?;
        let sigma_time = self.sigma(row, self.sigma_time)?;
        let sigma_height = self.sigma(row, self.sigma_height)?;
        let reading = |event, bounce| Reading { sigma_time, sigma_height, ..Reading::new(event, bounce, row.line) };
        match self.layout {
            Layout::Events { event } => {
                let what = event_of(row, event)?;
                let bounce = self.next_bounce(trial, what);
                let (time, height) = (self.value(row, self.time)?, self.height(row, self.height)?);
                if let (Event::Contact, Some(index), Some(high)) = (what, self.height, height)
                    && high != 0.0
                {
                    return Err(row
                        .error(index, "a contact is at the height of the floor, zero")
                        .help("leave the cell empty; if this is the height after the contact, give it a row 'apex'"));
                }
                let height = height.filter(|_| what != Event::Contact);
                let missing = match what {
                    Event::Contact => time.is_none().then_some(("a contact needs a time", self.time)),
                    _ => (time.is_none() && height.is_none())
                        .then_some(("this row has neither a time nor a height", self.height.or(self.time))),
                };
                if let Some((problem, index)) = missing {
                    return Err(row.error(index.unwrap_or(event), problem).help("fill the cell, or take the row out"));
                }
                self.trials[trial].readings.push(Reading { time, height, ..reading(what, bounce) });
            }
            Layout::Numbered { number } => {
                let bounce = bounce_number(row, number)?;
                let (time, height) = (self.value(row, self.time)?, self.height(row, self.height)?);
                if time.is_none() && height.is_none() {
                    let index = self.height.or(self.time).unwrap_or(number);
                    return Err(empty(row, index));
                }
                let readings = &mut self.trials[trial].readings;
                match (self.height.is_some(), self.time.is_some()) {
                    // With both, bounce 0 is the release; bounce n is a contact and the height it rebounds to.
                    (true, true) if bounce == 0 => {
                        readings.push(Reading { time, height, ..reading(Event::Release, 0) });
                    }
                    (true, true) => {
                        if time.is_some() {
                            readings.push(Reading { time, ..reading(Event::Contact, bounce) });
                        }
                        if height.is_some() {
                            readings.push(Reading { height, ..reading(Event::Apex, bounce) });
                        }
                    }
                    (true, false) => {
                        let event = if bounce == 0 { Event::Release } else { Event::Apex };
                        readings.push(Reading { height, ..reading(event, bounce) });
                    }
                    _ => readings.push(Reading { time, ..reading(Event::Contact, bounce) }),
                }
            }
            Layout::Intervals { number } => {
                let index = self.interval.unwrap_or(0);
                let bounce = number.map_or(Ok(self.trials[trial].readings.len()), |n| bounce_number(row, n))?;
                let value = self.required(row, index)?;
                if value < 0.0 {
                    return Err(row.error(index, "a time between contacts cannot be negative").help("check the cell"));
                }
                if value > 0.0 {
                    self.trials[trial].readings.push(Reading { time: Some(value), ..reading(Event::Contact, bounce) });
                }
            }
            Layout::Samples { frame } => {
                let time = match frame {
                    #[allow(clippy::cast_precision_loss)] // no film has 2^53 frames
                    Some(frame) => Some((self.kept - 1) as f64 * frame),
                    None => self.measured(row, self.time)?,
                };
                let height = self.measured(row, self.height)?;
                if time.is_some() && height.is_some() {
                    let n = self.trials[trial].readings.len();
                    self.trials[trial].readings.push(Reading { time, height, ..reading(Event::Sample, n) });
                } else {
                    self.missing.push(row.line);
                }
            }
            _ => {
                let count = self.trials[trial].readings.len();
                if let Some(index) = self.height {
                    let height = self.height(row, self.height)?;
                    let height = Some(height.ok_or_else(|| empty(row, index))?);
                    let event = if count == 0 { Event::Release } else { Event::Apex };
                    self.trials[trial].readings.push(Reading { height, ..reading(event, count) });
                } else if let Some(index) = self.time {
                    let time = Some(self.required(row, index)?);
                    self.trials[trial].readings.push(Reading { time, ..reading(Event::Contact, count + 1) });
                }
            }
        }
        Ok(())
    }

    /// The trial a row belongs to, made at its first row.
    fn trial(&mut self, row: &Row<'_>) -> Result<usize, TableError> {
        self.key.clear();
        for &index in &self.groups {
            self.key.push_str(row.cell(index));
            self.key.push('\u{1f}');
        }
        if let Some(last) = self.last.1.filter(|_| self.last.0 == self.key) {
            return Ok(last);
        }
        let found = match self.index.get(&self.key) {
            Some(&found) => found,
            None => {
                let label = self.label(row);
                let found = self.push_trial(row, label)?;
                self.index.insert(self.key.clone(), found);
                found
            }
        };
        self.last = (self.key.clone(), Some(found));
        Ok(found)
    }

    fn label(&self, row: &Row<'_>) -> String {
        self.named(row, &self.groups)
    }

    fn named(&self, row: &Row<'_>, columns: &[usize]) -> String {
        let parts = columns.iter().map(|&n| format!("{} {}", self.columns.columns[n].name, row.cell(n)));
        parts.collect::<Vec<_>>().join(", ")
    }

    /// A new trial, with its release if a column tells the height of it.
    fn push_trial(&mut self, row: &Row<'_>, label: String) -> Result<usize, TableError> {
        let mut readings = Vec::new();
        if let Some(index) = self.drop
            && let Some(height) = self.height(row, Some(index))?
        {
            readings.push(Reading { height: Some(height), ..Reading::new(Event::Release, 0, row.line) });
        }
        let setting = self.named(row, &self.settings);
        self.trials.push(Trial { label, setting, readings });
        Ok(self.trials.len() - 1)
    }

    /// A reading of a series; where the ball was not found, programs write words for "not a number".
    fn measured(&self, row: &Row<'_>, index: Option<usize>) -> Result<Option<f64>, TableError> {
        let lost = index.is_some_and(|n| row.cell(n).parse().is_ok_and(|number: f64| !number.is_finite()));
        if lost { Ok(None) } else { self.value(row, index) }
    }

    fn value(&self, row: &Row<'_>, index: Option<usize>) -> Result<Option<f64>, TableError> {
        let Some(index) = index else { return Ok(None) };
        if self.columns.columns[index].is_time()
            && let Some(seconds) = row.clock(index)
        {
            return Ok(Some(seconds));
        }
        Ok(row.number(index)?.map(|number| self.columns.columns[index].si(number)))
    }

    fn required(&self, row: &Row<'_>, index: usize) -> Result<f64, TableError> {
        self.value(row, Some(index))?.ok_or_else(|| empty(row, index))
    }

    fn height(&self, row: &Row<'_>, index: Option<usize>) -> Result<Option<f64>, TableError> {
        let height = self.value(row, index)?;
        match (height, index) {
            (Some(height), Some(index)) if height < 0.0 => Err(row.error(index, "a height below the floor").help(
                "heights count upwards from the floor: give what the scale reads there, such as --zero 2.5, \
                     and --y-down if it counts downwards",
            )),
            _ => Ok(height),
        }
    }

    fn sigma(&self, row: &Row<'_>, index: Option<usize>) -> Result<Option<f64>, TableError> {
        let sigma = self.value(row, index)?;
        match (sigma, index) {
            (Some(sigma), Some(index)) if sigma <= 0.0 => {
                Err(row.error(index, "an error must be above zero").help("leave the cell empty if it is not known"))
            }
            _ => Ok(sigma),
        }
    }

    /// The number of the next event of a trial, its rows being in the order of the events.
    fn next_bounce(&self, trial: usize, event: Event) -> usize {
        let readings = &self.trials[trial].readings;
        let contacts = readings.last().map_or(0, |last| last.bounce);
        match (event, readings.last().map(|last| last.event)) {
            (Event::Release, _) => 0,
            (Event::Contact, _) => contacts + 1,
            // An apex right after an apex or a release: there was a contact between, only nobody noted it.
            (_, Some(Event::Apex | Event::Release)) => contacts + 1,
            _ => contacts,
        }
    }

    /// One line on what was recognised.
    fn describe(&self) -> String {
        let name = |index: Option<usize>| index.map_or("", |n| self.columns.columns[n].name.as_str());
        match self.layout {
            Layout::Events { .. } => "events (release, contact, apex)".to_owned(),
            Layout::Numbered { .. } => match (self.time, self.height) {
                (Some(t), Some(h)) => {
                    format!("contact times '{}' and the heights reached after them '{}'", name(Some(t)), name(Some(h)))
                }
                (Some(t), None) => format!("contact times '{}'", name(Some(t))),
                (_, h) => format!("heights '{}' by number of bounces, 0 being the release", name(h)),
            },
            Layout::Listed if self.height.is_some() => {
                format!("heights '{}' in order, the first being the release", name(self.height))
            }
            Layout::Listed => format!("contact times '{}' in order", name(self.time)),
            Layout::Pairs => "drop heights and rebounds, one drop a row".to_owned(),
            Layout::DropTrials => "drop heights, and rebounds in one column per trial".to_owned(),
            Layout::TrialColumns { .. } => "one column per trial".to_owned(),
            Layout::BounceColumns => "one trial a row, one bounce a column".to_owned(),
            Layout::Intervals { .. } => format!("times between contacts '{}'", name(self.interval)),
            Layout::Samples { frame: None } => {
                format!("a series of heights '{}' in time '{}'", name(self.height), name(self.time))
            }
            Layout::Samples { .. } => format!("a series of heights '{}', a frame apart", name(self.height)),
        }
    }
}

/// Equal as text, or as numbers.
fn same(cell: &str, value: &str) -> bool {
    cell.eq_ignore_ascii_case(value)
        || matches!((cell.parse::<f64>(), value.parse::<f64>()), (Ok(a), Ok(b)) if (a - b).abs() < f64::EPSILON)
}

fn empty(row: &Row<'_>, index: usize) -> TableError {
    match shown(row.cell(index)) {
        cell if cell.is_empty() => row.error(index, "the cell is empty").help("fill it, or take the row out"),
        cell => row.error(index, format!("'{cell}' is no reading")).help("write one here, or take the row out"),
    }
}

fn event_of(row: &Row<'_>, index: usize) -> Result<Event, TableError> {
    let cell = row.cell(index);
    Ok(match cell.to_lowercase().as_str() {
        "release" | "released" | "drop" | "dropped" | "start" => Event::Release,
        "contact" | "impact" | "bounce" | "floor" | "hit" | "touch" | "touchdown" | "ground" => Event::Contact,
        "apex" | "peak" | "top" | "rebound" | "max" | "maximum" => Event::Apex,
        "" => return Err(row.error(index, "the event is empty").help("write release, contact or apex")),
        _ => {
            return Err(row
                .error(index, format!("the event '{}' is not known", shown(cell)))
                .help("write release (or drop), contact (or impact, bounce), or apex (or peak)"));
        }
    })
}

fn bounce_number(row: &Row<'_>, index: usize) -> Result<usize, TableError> {
    let number = row.number(index)?.ok_or_else(|| empty(row, index))?;
    if number.fract() == 0.0 && (0.0..=1e6).contains(&number) {
        // In range and whole: the cast is exact.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        Ok(number as usize)
    } else {
        Err(row.error(index, "the number of a bounce is 0, 1, 2 and so on").help("count the bounces in whole numbers"))
    }
}
