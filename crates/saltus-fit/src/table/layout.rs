//! From rows to trials: which layout the table has, and what each row then means.

use std::collections::HashMap;

use saltus_bounce::units::Quantity;

use super::header::{Columns, Kind};
use super::order::{in_order, renumbered, summed};
use super::read::{Row, Sheet, shown};
use super::{Event, ReadOptions, Reading, Table, Trial};
use crate::error::TableError;

/// The layouts, each with the columns it needs.
enum Layout {
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
    /// `trial,h0_cm,h1_cm,h2_cm`: bounces side by side, a row being a trial.
    BounceColumns,
    /// `trial,bounce,interval_s`: times between contacts.
    Intervals { number: Option<usize> },
    /// `time_s,height_cm`: a series of heights in time.
    Samples,
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
}

/// Reads the rows of `sheet` into trials.
pub(super) fn table(sheet: &Sheet<'_>, columns: &Columns, options: &ReadOptions) -> Result<Table, TableError> {
    let one = |kind| columns.one(&kind);
    let filters = filters(sheet, options)?;
    let mut settings: Vec<usize> = columns.all(&Kind::Setting).chain(columns.one(&Kind::DropHeight)).collect();
    settings.sort_unstable();
    let mut groups: Vec<usize> = columns.all(&Kind::Group).chain(settings.iter().copied()).collect();
    groups.sort_unstable();
    let mut reader = Reader {
        columns,
        layout: layout(sheet, columns)?,
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
    };
    sheet.each_row(|row| reader.row(row), columns.headerless)?;
    if reader.kept == 0 {
        let error = if reader.skipped > 0 {
            let wanted: Vec<String> = options.filters.iter().map(|(n, v)| format!("{n} = {v}")).collect();
            TableError::new(sheet.name, format!("no row has {}", wanted.join(" and ")))
                .help("check the value; without a filter every row is read")
        } else {
            TableError::new(sheet.name, "the table has a header and no rows").help("add the readings below the header")
        };
        return Err(error);
    }
    let mut notes = columns.notes.clone();
    let what = reader.describe();
    if reader.skipped > 0 {
        notes.push(format!("{} rows kept and {} left out by the filter", reader.kept, reader.skipped));
    }
    let mut table = Table { notes, ..Table::default() };
    let Reader { trials, layout, kept, .. } = reader;
    table.trials = match layout {
        Layout::Numbered { number } => renumbered(sheet, trials, number, &mut table.repairs)?,
        _ => trials,
    };
    if matches!(layout, Layout::Intervals { .. }) {
        table.trials = table.trials.into_iter().map(|trial| summed(sheet, trial)).collect::<Result<_, _>>()?;
    }
    for trial in &mut table.trials {
        in_order(sheet, columns, trial, matches!(layout, Layout::Listed))?;
    }
    let plural = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
    table.notes.insert(0, format!("read as {what}: {}, {}", plural(kept, "row"), plural(table.trials.len(), "trial")));
    Ok(table)
}

/// The columns filters name.
fn filters(sheet: &Sheet<'_>, options: &ReadOptions) -> Result<Vec<(usize, String)>, TableError> {
    let find = |(name, value): &(String, String)| {
        let index = sheet.header.iter().position(|cell| cell.eq_ignore_ascii_case(name.trim()));
        index.map(|index| (index, value.trim().to_owned())).ok_or_else(|| {
            TableError::new(sheet.name, format!("there is no column '{name}' to filter by"))
                .help(format!("the table has {}", sheet.header.join(", ")))
        })
    };
    options.filters.iter().map(find).collect()
}

fn layout(sheet: &Sheet<'_>, columns: &Columns) -> Result<Layout, TableError> {
    let one = |kind| columns.one(&kind);
    let number = one(Kind::Bounce);
    let (time, height) = (one(Kind::Time), one(Kind::Height));
    if columns.columns.iter().any(|c| matches!(c.kind, Kind::Trial(_))) {
        return Ok(Layout::TrialColumns { number: number.or(one(Kind::Event)) });
    }
    if columns.columns.iter().any(|c| matches!(c.kind, Kind::HeightAt(_) | Kind::TimeAt(_))) {
        return Ok(Layout::BounceColumns);
    }
    if one(Kind::Interval).is_some() && time.is_none() {
        return Ok(Layout::Intervals { number: number.or(one(Kind::Event)) });
    }
    if time.is_none() && height.is_none() {
        return Err(TableError::new(sheet.name, "no column holds heights or times")
            .help("name one, such as 'height_cm' or 'time_s'"));
    }
    if let Some(event) = one(Kind::Event) {
        let mut counted = false;
        sheet.each_row(
            |row| {
                counted |= row.cell(event).parse::<f64>().is_ok();
                Ok(())
            },
            columns.headerless,
        )?;
        return Ok(if counted { Layout::Numbered { number: event } } else { Layout::Events { event } });
    }
    Ok(match (number, time, height) {
        (Some(number), _, _) => Layout::Numbered { number },
        (None, Some(_), Some(_)) => Layout::Samples,
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
            Layout::Pairs => return self.pair(row),
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
                    return Err(row.error(index, "the cell is empty").help("fill it, or take the row out"));
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
            Layout::Samples => {
                let (time, height) = (self.value(row, self.time)?, self.value(row, self.height)?);
                if time.is_some() && height.is_some() {
                    let n = self.trials[trial].readings.len();
                    self.trials[trial].readings.push(Reading { time, height, ..reading(Event::Sample, n) });
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

    fn value(&self, row: &Row<'_>, index: Option<usize>) -> Result<Option<f64>, TableError> {
        let Some(index) = index else { return Ok(None) };
        Ok(row.number(index)?.map(|number| self.columns.columns[index].si(number)))
    }

    fn required(&self, row: &Row<'_>, index: usize) -> Result<f64, TableError> {
        self.value(row, Some(index))?.ok_or_else(|| empty(row, index))
    }

    fn height(&self, row: &Row<'_>, index: Option<usize>) -> Result<Option<f64>, TableError> {
        let height = self.value(row, index)?;
        match (height, index) {
            (Some(height), Some(index)) if height < 0.0 => Err(row
                .error(index, "a height below the floor")
                .help("count heights upwards from the floor: turn the sign, or subtract the height of the floor")),
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

    fn pair(&mut self, row: &Row<'_>) -> Result<(), TableError> {
        let index = self.height.unwrap_or(0);
        let height = self.height(row, Some(index))?.ok_or_else(|| empty(row, index))?;
        let label = format!("{}, line {}", self.label(row), row.line);
        let sigma_height = self.sigma(row, self.sigma_height)?;
        let trial = self.push_trial(row, label)?;
        let reading = Reading { height: Some(height), sigma_height, ..Reading::new(Event::Apex, 1, row.line) };
        self.trials[trial].readings.push(reading);
        Ok(())
    }

    fn trial_columns(&mut self, row: &Row<'_>, number: Option<usize>) -> Result<(), TableError> {
        let columns = self.columns;
        for (index, column) in columns.columns.iter().enumerate() {
            let Kind::Trial(quantity) = &column.kind else { continue };
            let trial = match self.index.get(&column.name) {
                Some(&trial) => trial,
                None => {
                    let trial = self.push_trial(row, column.name.clone())?;
                    self.index.insert(column.name.clone(), trial);
                    trial
                }
            };
            let bounce = number.map_or(Ok(self.kept - 1), |n| bounce_number(row, n))?;
            let reading = if *quantity == Quantity::Time {
                let Some(time) = self.value(row, Some(index))? else { continue };
                Reading { time: Some(time), ..Reading::new(Event::Contact, bounce + 1, row.line) }
            } else {
                let Some(height) = self.height(row, Some(index))? else { continue };
                let event = if bounce == 0 { Event::Release } else { Event::Apex };
                Reading { height: Some(height), ..Reading::new(event, bounce, row.line) }
            };
            self.trials[trial].readings.push(reading);
        }
        Ok(())
    }

    fn bounce_columns(&mut self, row: &Row<'_>) -> Result<(), TableError> {
        let label = if self.groups.is_empty() { format!("line {}", row.line) } else { self.label(row) };
        let trial = self.push_trial(row, label)?;
        let columns = self.columns;
        let first =
            columns.columns.iter().filter_map(|c| if let Kind::TimeAt(n) = c.kind { Some(n) } else { None }).min();
        for (index, column) in columns.columns.iter().enumerate() {
            let reading = match column.kind {
                Kind::HeightAt(n) => {
                    let Some(height) = self.height(row, Some(index))? else { continue };
                    let event = if n == 0 { Event::Release } else { Event::Apex };
                    Reading { height: Some(height), ..Reading::new(event, n, row.line) }
                }
                Kind::TimeAt(n) => {
                    let Some(time) = self.value(row, Some(index))? else { continue };
                    let bounce = if first == Some(0) { n + 1 } else { n };
                    Reading { time: Some(time), ..Reading::new(Event::Contact, bounce, row.line) }
                }
                _ => continue,
            };
            self.trials[trial].readings.push(reading);
        }
        Ok(())
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
            Layout::TrialColumns { .. } => "one column per trial".to_owned(),
            Layout::BounceColumns => "one trial a row, one bounce a column".to_owned(),
            Layout::Intervals { .. } => format!("times between contacts '{}'", name(self.interval)),
            Layout::Samples => "a series of heights in time".to_owned(),
        }
    }
}

/// Equal as text, or as numbers.
fn same(cell: &str, value: &str) -> bool {
    cell.eq_ignore_ascii_case(value)
        || matches!((cell.parse::<f64>(), value.parse::<f64>()), (Ok(a), Ok(b)) if (a - b).abs() < f64::EPSILON)
}

fn empty(row: &Row<'_>, index: usize) -> TableError {
    row.error(index, "the cell is empty").help("fill it, or take the row out")
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
