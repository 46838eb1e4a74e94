//! Rows of each layout as readings of their trials.

use super::{Builder, Found};
use crate::error::TableError;
use crate::quantity::Ball;
use crate::read::aside::{LeftAside, Part, Why};
use crate::read::cell::Cell;
use crate::read::columns::Kind;
use crate::read::grid::shown;
use crate::read::heading::{At, What};
use crate::read::layout::{Layout, Track};
use crate::read::named::event;
use crate::read::region::Region;
use crate::read::rows::{Row, Rows};
use crate::read::units::Scale;
use crate::read::vocabulary::Atom;
use crate::read::{Event, ReadOptions, Reading, Span, Timed, Trial};

impl Builder<'_> {
    pub(super) fn row(&mut self, n: usize, row: &Row, track: &Track, flights: bool) -> Result<(), TableError> {
        for &index in self.keys.iter().chain(&track.release) {
            if !self.region.cell(row.at, index).is_empty() {
                self.merged.insert(index, row.at);
            }
        }
        match self.layout {
            Layout::Wide => self.wide(row, track, flights),
            Layout::Pairs => self.pair(row, track),
            Layout::Samples { frames } => self.sample(n, row, track, frames),
            Layout::Events { event } => self.event(row, track, event),
            Layout::Numbered => self.numbered(row.bounce.unwrap_or(n), row, track, flights),
            Layout::Listed => {
                let several = !self.keys.is_empty() || !row.name.is_empty();
                let trial = self.trial(row, track)?;
                let count =
                    self.trials[trial].readings.iter().filter(|r| r.event != Event::Release || r.bounce > 0).count();
                let released = self.trials[trial].readings.iter().any(|r| r.event == Event::Release);
                // Of tops none need be that of the release.
                let next = if track.released() || self.tops { count + 1 } else { count + usize::from(released) };
                let place = if several { next } else { n + usize::from(track.released() || self.tops) };
                self.numbered(place, row, track, flights)
            }
        }
    }

    /// The trial a row belongs to, made at its first row.
    pub(super) fn trial(&mut self, row: &Row, track: &Track) -> Result<usize, TableError> {
        let key = format!("{}\u{1e}{}", self.key(row), track.label());
        if let Some(&found) = self.index.get(&key) {
            return Ok(found);
        }
        let found = self.push(row, track, "")?;
        self.index.insert(key, found);
        Ok(found)
    }

    pub(super) fn listed(&self, row: &Row, columns: &[usize]) -> Vec<String> {
        columns.iter().map(|&n| format!("{} {}", self.columns.columns[n].heading.text, self.text(row.at, n))).collect()
    }

    /// A new trial, with its release if a column tells the height of it.
    pub(super) fn push(&mut self, row: &Row, track: &Track, more: &str) -> Result<usize, TableError> {
        let track_label = track.label();
        let own = self
            .columns
            .columns
            .iter()
            .find(|c| c.value().is_some_and(|v| v.trial == track.trial && !v.trial.is_empty()));
        // A column that is one trial is called as it is written.
        let written = own.map_or(track_label.as_str(), |c| {
            if track.group.is_empty() { c.heading.text.as_str() } else { track_label.as_str() }
        });
        let mut label = self.listed(row, &self.keys);
        let parts = [row.name.as_str(), written, more];
        label.extend(parts.iter().filter(|p| !p.is_empty()).map(|p| (*p).to_owned()));
        let mut setting = self.listed(row, &self.settings);
        let groups = self.settings.iter().filter(|&&n| {
            let column = &self.columns.columns[n];
            column.kind == Kind::Setting && self.apart[n]
        });
        let mut group: Vec<String> = groups.map(|&n| self.text(row.at, n).to_owned()).collect();
        for name in [&row.group, &track.group].into_iter().filter(|name| !name.is_empty()) {
            setting.push(name.clone());
            group.push(name.clone());
        }
        let mut balls = group.iter().filter_map(|name| Ball::named(name));
        let ball = balls.next().filter(|_| balls.next().is_none());
        // A drop and its rebound, of which a table may hold millions.
        let mut readings = Vec::with_capacity(2);
        if let Some((index, (height, sigma))) = track
            .release
            .map(|n| Ok((n, self.height(self.spanning(row.at, n), n)?)))
            .transpose()?
            .and_then(|(n, found)| Some((n, found?)))
        {
            let line = self.line(row.at, index);
            readings.push(Reading {
                height: Some(height),
                sigma_height: sigma,
                ..Reading::new(Event::Release, 0, line)
            });
        }
        if let Some(height) = track.drop.filter(|_| track.release.is_none()) {
            let line = self.line(row.at, 0);
            readings.push(Reading { height: Some(height), ..Reading::new(Event::Release, 0, line) });
        }
        group.retain(|part| !part.is_empty());
        // A condition that is another in each row tells no groups apart, and the COR may follow it.
        let follows = |n: &&usize| self.columns.columns[**n].kind == Kind::Setting && !self.apart[**n];
        let cell = |n: &usize| (shown(&self.columns.columns[*n].heading.text), self.text(row.at, *n).to_owned());
        let conditions = self.settings.iter().filter(follows).map(cell).filter(|(_, cell)| !cell.is_empty()).collect();
        self.trials.push(Trial {
            label: label.join(", "),
            setting: setting.join(", "),
            group: group.join(", "),
            ball,
            readings,
            timed: None,
            stated: Vec::new(),
            beside: Vec::new(),
            conditions,
        });
        Ok(self.trials.len() - 1)
    }

    pub(super) fn apex(&mut self, trial: usize, bounce: usize, found: (f64, Option<f64>), line: u64) {
        let event = if bounce == 0 { Event::Release } else { Event::Apex };
        let reading = Reading { height: Some(found.0), sigma_height: found.1, ..Reading::new(event, bounce, line) };
        self.trials[trial].readings.push(reading);
    }

    pub(super) fn contact(&mut self, trial: usize, bounce: usize, found: (f64, Option<f64>), line: u64) {
        let reading =
            Reading { time: Some(found.0), sigma_time: found.1, ..Reading::new(Event::Contact, bounce, line) };
        self.trials[trial].readings.push(reading);
    }

    /// The readings of a numbered row.
    pub(super) fn numbered(
        &mut self,
        bounce: usize,
        row: &Row,
        track: &Track,
        flights: bool,
    ) -> Result<(), TableError> {
        let height = track.height.or(track.speed).or(track.after);
        let used = [height, track.time, track.interval];
        let Some(first) = used.iter().flatten().next().copied() else { return Ok(()) };
        if used.iter().flatten().all(|&c| self.region.cell(row.at, c).is_empty()) {
            return Ok(());
        }
        let trial = self.trial(row, track)?;
        let line = self.line(row.at, first);
        let time = match track.time {
            Some(column) => self.time(trial, row.at, column)?,
            None => None,
        };
        let (time, mut interval) = if flights { (None, time) } else { (time, None) };
        if let Some(column) = track.interval {
            interval = self.between(row.at, column)?;
        }
        let high = height.map(|column| self.height(row.at, column)).transpose()?.flatten();
        // With both, bounce 0 is the release; bounce n is a contact and the height it rebounds to,
        // or that top.
        let both = match bounce {
            0 => (height.is_some() && track.time.is_some() && !flights).then_some(Event::Release),
            _ => (self.tops && time.is_some()).then_some(Event::Apex),
        };
        if let Some(event) = both {
            self.trials[trial].readings.push(Reading {
                time: time.map(|t| t.0),
                height: high.map(|h| h.0),
                sigma_time: time.and_then(|t| t.1),
                sigma_height: high.and_then(|h| h.1),
                ..Reading::new(event, bounce, line)
            });
            return Ok(());
        }
        if let Some(found) = time {
            self.contact(trial, bounce, found, line);
        }
        if let Some(found) = interval.filter(|(time, _)| *time > 0.0) {
            if bounce == 0 && high.is_some() {
                let column = track.interval.or(track.time).unwrap_or(first);
                return Err(self
                    .region
                    .view
                    .error(row.at, column, "is this the time of the fall, or of a flight? Bounce 0 is the release")
                    .question()
                    .help("leave the cell of the release empty; flight n is the one after contact n"));
            }
            if !self.flights.contains(&trial) {
                self.flights.push(trial);
            }
            self.contact(trial, bounce, found, line);
        }
        if let Some(found) = high {
            self.apex(trial, bounce, found, line);
        }
        Ok(())
    }

    /// A time between contacts.
    fn between(&self, row: usize, column: usize) -> Result<Found, TableError> {
        let interval = self.number(row, column)?;
        if interval.is_some_and(|(time, _)| time < 0.0) {
            let error = self.region.view.error(row, column, "a time between contacts cannot be negative");
            return Err(error.help("check the cell"));
        }
        Ok(interval)
    }

    /// Bounces side by side, a row being a trial.
    pub(super) fn wide(&mut self, row: &Row, track: &Track, flights: bool) -> Result<(), TableError> {
        let more = if self.keys.is_empty() && row.name.is_empty() {
            format!("line {}", self.line(row.at, 0))
        } else {
            String::new()
        };
        let trial = self.push(row, track, &more)?;
        let bounce_of = |column: usize| match self.columns.columns[column].value().map(|v| (v.what, v.at)) {
            Some((what, At::Nth(n))) => Some((what, n)),
            _ => None,
        };
        let mut nth: Vec<(usize, What, usize)> =
            track.nth.iter().filter_map(|&c| bounce_of(c).map(|(w, n)| (n, w, c))).collect();
        nth.sort_by_key(|(n, _, _)| *n);
        let first = nth.iter().filter(|(_, what, _)| *what == What::Time).map(|(n, _, _)| *n).min();
        for (n, what, column) in nth {
            let line = self.line(row.at, column);
            match what {
                What::Time | What::Interval | What::Total => {
                    let Some(found) = self.time(trial, row.at, column)? else { continue };
                    if flights || what == What::Interval {
                        if !self.flights.contains(&trial) {
                            self.flights.push(trial);
                        }
                        self.contact(trial, n, found, line);
                    } else {
                        self.contact(trial, if first == Some(0) { n + 1 } else { n }, found, line);
                    }
                }
                _ => {
                    let Some(found) = self.height(row.at, column)? else { continue };
                    self.apex(trial, n, found, line);
                }
            }
        }
        Ok(())
    }

    /// A drop and its rebound.
    pub(super) fn pair(&mut self, row: &Row, track: &Track) -> Result<(), TableError> {
        let timed = track.interval.or(track.total).or(track.nth.first().copied());
        let rebound = track.height.or(track.after).or(track.lost).or(track.share).or(timed);
        // Beside the time until the ball rests a height by itself is that of the release.
        let rests = track.total.filter(|_| track.interval.is_none() && track.after.is_none());
        let alone = track.height.filter(|&n| !self.columns.columns[n].heading.has(Atom::Rebound));
        let resting = alone.zip(rests).filter(|_| track.release.or(track.before).is_none() && track.drop.is_none());
        let rebound = resting.map_or(rebound, |(_, total)| Some(total));
        let before = track.release.or(track.before).or(resting.map(|(height, _)| height));
        if let Some(share) = track.share.filter(|_| before.is_none() && track.drop.is_none()) {
            return self.rebound(row, track, share, |_| Ok((1.0, None)));
        }
        if let Some((drop, rebound)) = track.drop.filter(|_| before.is_none()).zip(rebound) {
            return self.rebound(row, track, rebound, |_| Ok((drop, None)));
        }
        let Some((before, rebound)) = before.zip(rebound) else {
            return match rebound.or(before) {
                Some(column) if rebound.is_some() => {
                    let name = shown(&self.columns.columns[column].heading.text);
                    let message = format!("beside '{name}' the height of release is wanted");
                    let error = self.region.header_error(column, message);
                    // One alone may be of anything, as the first two sounds of a stopwatch.
                    let error = if self.region.rows.len() == 1 { error.nothing() } else { error };
                    Err(error.help("give it in a column such as 'drop height (cm)'"))
                }
                _ => Ok(()),
            };
        };
        self.rebound(row, track, rebound, |builder| {
            let drop = builder.height(builder.spanning(row.at, before), before)?;
            drop.ok_or_else(|| builder.empty(row.at, before))
        })
    }

    /// Whether a drop has no rebound, which is named as left aside; words in its place say why.
    fn lacks(&mut self, row: usize, rebound: usize) -> bool {
        let empty = match self.region.view.read(row, rebound) {
            Cell::Words => return self.wordy(row, rebound),
            cell => cell == Cell::Empty,
        };
        if empty {
            let name = self.columns.columns[rebound].heading.text.clone();
            let line = self.line(row, rebound);
            self.aside.push(LeftAside::new(Part::Cell, shown(&name), Why::Empty).at(line));
        }
        empty
    }

    /// The rebound of a row, if there is one, from the height that `drop` finds.
    fn rebound(
        &mut self,
        row: &Row,
        track: &Track,
        rebound: usize,
        drop: impl FnOnce(&Self) -> Result<(f64, Option<f64>), TableError>,
    ) -> Result<(), TableError> {
        if self.lacks(row.at, rebound) {
            return Ok(());
        }
        let (drop, sigma) = drop(self)?;
        let line = self.line(row.at, rebound);
        let trial = self.push(row, track, &format!("line {line}"))?;
        if !track.released() {
            self.apex(trial, 0, (drop, sigma), line);
        }
        let at = self.columns.columns[rebound].value().map(|v| v.at);
        let span = match at {
            Some(At::Nth(contact)) => Some(Span::Until(contact)),
            _ if Some(rebound) == track.interval => Some(Span::Flight),
            _ if Some(rebound) == track.total => Some(Span::UntilRest),
            _ => None,
        };
        if let Some(span) = span {
            let (time, sigma) = self.required(row.at, rebound)?;
            self.trials[trial].timed = Some(Timed { span, time, sigma, line });
            return Ok(());
        }
        let (mut height, sigma) = if Some(rebound) == track.share {
            let (share, sigma) = self.required(row.at, rebound)?;
            let lost = self.columns.columns[rebound].heading.has(Atom::Lost);
            let share = if lost { 1.0 - share } else { share };
            (share * drop, sigma.map(|sigma| sigma * drop))
        } else if Some(rebound) == track.lost {
            let (lost, sigma) = self.required(row.at, rebound)?;
            // Hundredths of the height of release.
            let percent = self.region.view.read(row.at, rebound);
            let percent = self.columns.columns[rebound].unit.is_some_and(|unit| unit.scale == Scale::Percent)
                || matches!(percent, Cell::Number(m) if m.unit.is_some_and(|unit| unit.scale == Scale::Percent));
            let of = if percent { drop } else { 1.0 };
            (lost * of, sigma.map(|sigma| sigma * of))
        } else {
            self.height(row.at, rebound)?.ok_or_else(|| self.empty(row.at, rebound))?
        };
        if Some(rebound) == track.lost {
            height = drop - height;
            if height < 0.0 {
                return Err(self
                    .region
                    .view
                    .error(row.at, rebound, "more was lost than there was")
                    .help("correct the cell"));
            }
        }
        let bounce = row.bounce.filter(|_| self.after).unwrap_or(1);
        self.apex(trial, bounce, (height, sigma), line);
        Ok(())
    }

    pub(super) fn sample(&mut self, n: usize, row: &Row, track: &Track, frames: bool) -> Result<(), TableError> {
        let Some(height) = track.height else { return Ok(()) };
        let line = self.line(row.at, height);
        // Where the ball was not found, programs write words for "not a number".
        let measured = |column: usize| match self.region.view.read(row.at, column) {
            Cell::Lost => Ok(None),
            _ => self.number(row.at, column),
        };
        #[allow(clippy::cast_precision_loss)] // no film has 2^53 frames
        let time = match track.time {
            Some(column) if !frames => measured(column)?.map(|t| t.0),
            _ => self.frame().map(|frame| n as f64 * frame),
        };
        let found = measured(height)?;
        let (Some(time), Some((height, sigma_height))) = (time, found) else {
            self.missing.push(line);
            return Ok(());
        };
        let trial = self.trial(row, track)?;
        let n = self.trials[trial].readings.len();
        let reading =
            Reading { time: Some(time), height: Some(height), sigma_height, ..Reading::new(Event::Sample, n, line) };
        self.trials[trial].readings.push(reading);
        Ok(())
    }

    /// The time between rows that are frames.
    pub(super) fn frame(&self) -> Option<f64> {
        self.region.frame
    }

    pub(super) fn event(&mut self, row: &Row, track: &Track, event: usize) -> Result<(), TableError> {
        let (view, region) = (self.region.view, self.region);
        let what = event_of(region, row.at, event)?;
        let trial = self.trial(row, track)?;
        let line = self.line(row.at, event);
        let bounce = self.next_bounce(trial, what);
        let time = track.time.map(|c| self.number(row.at, c)).transpose()?.flatten();
        let high = track.height.or(track.speed).map(|c| self.height(row.at, c)).transpose()?.flatten();
        if let (Event::Contact, Some(_), Some((height, _))) = (what, track.height, high)
            && height != 0.0
            && track.time.is_none()
        {
            // Rows named by their bounces, without a clock: the height is the one reached after it.
            let bounce = self.next_bounce(trial, Event::Contact);
            self.apex(trial, bounce, (height, high.and_then(|h| h.1)), line);
            return Ok(());
        }
        if let (Event::Contact, Some(index), Some((height, _))) = (what, track.height, high)
            && height != 0.0
        {
            return Err(view
                .error(row.at, index, "a contact is at the height of the floor, zero")
                .help("leave the cell empty; if this is the height after the contact, give it a row 'apex'"));
        }
        let high = high.filter(|_| what != Event::Contact);
        let missing = match what {
            Event::Contact => time.is_none().then_some(("a contact needs a time", track.time)),
            _ => (time.is_none() && high.is_none())
                .then_some(("this row has neither a time nor a height", track.height.or(track.time))),
        };
        if let Some((problem, index)) = missing {
            return Err(view.error(row.at, index.unwrap_or(event), problem).help("fill the cell, or take the row out"));
        }
        self.trials[trial].readings.push(Reading {
            time: time.map(|t| t.0),
            height: high.map(|h| h.0),
            sigma_time: time.and_then(|t| t.1),
            sigma_height: high.and_then(|h| h.1),
            ..Reading::new(what, bounce, line)
        });
        Ok(())
    }

    /// The number of the next event of a trial, its rows being in the order of the events.
    pub(super) fn next_bounce(&self, trial: usize, event: Event) -> usize {
        let readings = &self.trials[trial].readings;
        let contacts = readings.last().map_or(0, |last| last.bounce);
        match (event, readings.last().map(|last| last.event)) {
            (Event::Release, _) => 0,
            (Event::Contact, _) => contacts + 1,
            // An apex right after an apex or a release: there was a contact between, only nobody
            // noted it.
            (_, Some(Event::Apex | Event::Release)) => contacts + 1,
            _ => contacts,
        }
    }
}

fn event_of(region: &Region<'_>, row: usize, index: usize) -> Result<Event, TableError> {
    let cell = region.cell(row, index);
    if cell.is_empty() {
        return Err(region.view.error(row, index, "the event is empty").help("write release, contact or apex"));
    }
    event(cell).ok_or_else(|| {
        region
            .view
            .error(row, index, format!("the event '{}' is not known", shown(cell)))
            .help("write release (or drop), contact (or impact, bounce), or apex (or peak)")
    })
}

/// Keeps the rows that every filter asks for, and counts the others.
pub(super) fn filtered(region: &Region<'_>, rows: &mut Rows, options: &ReadOptions) -> Result<usize, TableError> {
    let find = |(name, value): &(String, String)| {
        let index = region.header.iter().position(|cell| cell.eq_ignore_ascii_case(name.trim()));
        index.map(|index| (index, value.trim().to_owned())).ok_or_else(|| {
            region
                .error(format!("there is no column '{name}' to filter by"))
                .help(format!("the table has {}", region.header.join(", ")))
        })
    };
    let filters: Vec<(usize, String)> = options.filters.iter().map(find).collect::<Result<_, _>>()?;
    let before = rows.rows.len();
    rows.rows.retain(|row| filters.iter().all(|(index, value)| same(region.cell(row.at, *index), value)));
    Ok(before - rows.rows.len())
}

/// Equal as text, or as numbers.
fn same(cell: &str, value: &str) -> bool {
    cell.eq_ignore_ascii_case(value)
        || matches!((cell.parse::<f64>(), value.parse::<f64>()), (Ok(a), Ok(b)) if (a - b).abs() < f64::EPSILON)
}
