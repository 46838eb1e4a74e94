//! Groups of trials, and rebounds that follow from a time only with gravity.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::aside::{LeftAside, Part, Why};
use super::cell::{self, Cell};
use super::{Event, Reading, Span, Table, Trial};
use crate::finding::{Doubt, Note, Warning};
use crate::quantity::Ball;
use crate::statistics::median;

impl Table {
    /// The balls, surfaces or sheets of the table, each with a COR of its own; a single one,
    /// without a name, where nothing tells any apart.
    #[must_use]
    pub fn groups(&self) -> Vec<&str> {
        let mut found: Vec<&str> = Vec::new();
        for trial in &self.trials {
            if !found.contains(&trial.group.as_str()) {
                found.push(&trial.group);
            }
        }
        found
    }

    /// Whether its clock runs at a rate that stands in for one that is not stated.
    pub(crate) fn at_any_rate(&self) -> bool {
        self.notes.iter().any(|note| matches!(note.kind, Note::AnyRate { .. }))
    }

    /// Whether its heights have a scale, and a ball falls by it as gravity has it.
    pub(crate) fn falls_as_due(&self) -> bool {
        !self.metadata.pixels && !self.warnings.iter().any(|w| matches!(w.kind, Warning::Gravity { .. }))
    }

    /// The trials of one group.
    pub(crate) fn of_group(&self, group: &str) -> Self {
        let trials = self.trials.iter().filter(|trial| trial.group == group).cloned().collect();
        Self { trials, ..self.clone() }
    }

    /// The table of a sound of several drops with a group for each of them; none of another table.
    pub(crate) fn by_drops(&self) -> Option<Self> {
        let several = !self.sounds.is_empty() && self.trials.len() > 1;
        let mut table = several.then(|| self.clone())?;
        table.trials.iter_mut().for_each(|trial| trial.group.clone_from(&trial.label));
        Some(table)
    }

    /// The table with a group for each of the words of a column that was left aside, where these
    /// come again: of a column that is not understood, or of words beside readings, and not of
    /// remarks. `None` where a cell holds a number or nothing, or a word stands beside one trial.
    pub(crate) fn apart_by(&self, column: &str) -> Option<Self> {
        let of = |aside: &LeftAside| aside.what == Part::Column && aside.name == column;
        let names =
            self.left_aside.iter().any(|aside| of(aside) && matches!(aside.why, Why::NotUnderstood | Why::Other));
        let cell = |trial: &'_ Trial| {
            let found = trial.beside.iter().position(|(name, _)| name == column);
            found.filter(|n| cell::read(&trial.beside[*n].1, false) == Cell::Words)
        };
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for trial in &self.trials {
            *counts.entry(trial.beside[cell(trial)?].1.as_str()).or_default() += 1;
        }
        if !names || counts.len() < 2 || counts.values().any(|count| *count < 2) {
            return None;
        }
        let mut table = self.clone();
        for trial in &mut table.trials {
            let (name, word) = trial.beside.remove(cell(trial)?);
            let part = format!("{name} {word}");
            trial.setting = if trial.setting.is_empty() { part } else { format!("{}, {part}", trial.setting) };
            trial.ball = trial.ball.or(Ball::named(&word));
            trial.group = word;
        }
        table.left_aside.retain(|aside| !of(aside));
        table.notes.push(Note::Apart { column: column.to_owned() }.into());
        Some(table)
    }

    /// The table with the rebounds that follow from times where gravity is `g`; `sigma` is the
    /// error of a time that states none.
    ///
    /// The rebound after the only flight, of time T, is g T²/8. From release at h to rest a ball
    /// takes T = t (1 + e)/(1 - e) with the time of fall t = √(2h/g), so that e = (T - t)/(T + t),
    /// and it rebounds to e² h. To contact n it takes t (1 + 2e + … + 2eⁿ⁻¹).
    pub(crate) fn at_gravity(table: Cow<'_, Self>, g: f64, sigma: f64) -> Cow<'_, Self> {
        if table.trials.iter().all(|trial| trial.timed.is_none()) {
            return table;
        }
        let mut table = table.into_owned();
        for trial in &mut table.trials {
            let Some(timed) = trial.timed.take() else { continue };
            let Some(drop) = trial.readings.iter().find(|r| r.event == Event::Release).and_then(|r| r.height) else {
                continue;
            };
            let (time, error) = (timed.time, timed.sigma.unwrap_or(sigma));
            let fall = (2.0 * drop / g).sqrt();
            // The rebound, and what a second more adds to it.
            let (height, slope) = match timed.span {
                Span::Flight => (g * time * time / 8.0, g * time / 4.0),
                Span::Until(contact) => {
                    let (e, slope) = arrival(time / fall, contact);
                    (e * e * drop, 2.0 * e * drop * slope / fall)
                }
                Span::UntilRest => {
                    let e = ((time - fall) / (time + fall)).max(0.0);
                    (e * e * drop, 2.0 * e * drop * 2.0 * fall / (time + fall).powi(2))
                }
            };
            if !height.is_finite() {
                continue;
            }
            let sigma_height = Some(slope * error).filter(|s| *s > 0.0 && s.is_finite());
            let apex = Reading { height: Some(height), sigma_height, ..Reading::new(Event::Apex, 1, timed.line) };
            trial.readings.push(apex);
            let doubt = Doubt::UntilRest;
            if timed.span == Span::UntilRest && !table.doubts.contains(&doubt) {
                table.doubts.push(doubt);
            }
        }
        table.notes.push(Note::ByTime { gravity: g }.into());
        Cow::Owned(table)
    }
}

impl Table {
    /// The table with heights in pixels brought to the scale by which the flights between contacts
    /// last as long as they do where gravity is `g`: a flight of T is g T²/8 high. The scale is the
    /// median of those of all flights; without one that has both the table is left as it is.
    pub(crate) fn sized(&self, g: f64) -> Cow<'_, Self> {
        let of = |trial: &Trial| {
            let time = |n: usize| trial.readings.iter().find(|r| (r.event, r.bounce) == (Event::Contact, n))?.time;
            let apexes = trial.readings.iter().filter(|r| r.event == Event::Apex);
            let scale = |apex: &Reading| {
                let lasts = time(apex.bounce + 1)? - time(apex.bounce)?;
                Some(g * lasts * lasts / 8.0 / apex.height.filter(|height| *height > 0.0)?)
            };
            apexes.filter_map(scale).collect::<Vec<f64>>()
        };
        let mut scales: Vec<f64> = self
            .trials
            .iter()
            .filter(|_| self.metadata.pixels)
            .flat_map(of)
            .filter(|s| s.is_finite() && *s > 0.0)
            .collect();
        let Some(metres) = median(&mut scales) else { return Cow::Borrowed(self) };
        let mut table = self.clone();
        let sized = |height: &mut Option<f64>| *height = height.map(|h| metres * h);
        for reading in table.trials.iter_mut().flat_map(|trial| &mut trial.readings) {
            sized(&mut reading.height);
            sized(&mut reading.sigma_height);
        }
        sized(&mut table.metadata.sigma_height);
        sized(&mut table.metadata.drop);
        table.metadata.pixels = false;
        table.notes.push(Note::ByFlights { metres }.into());
        Cow::Owned(table)
    }
}

/// The COR of a ball that touches the floor for the n-th time after `times` the time of its fall,
/// and what one such time more adds to it.
fn arrival(times: f64, contact: usize) -> (f64, f64) {
    // No one counts further, and a sum of more flights is that until rest.
    let flights = contact.min(100);
    let sum = |e: f64| {
        (1..flights).fold((1.0, 0.0, 1.0), |(sum, slope, power), k| {
            #[allow(clippy::cast_precision_loss)] // up to a hundred
            (sum + 2.0 * power * e, slope + 2.0 * k as f64 * power, power * e)
        })
    };
    let (mut low, mut high) = (0.0, 2.0);
    // Until no number lies between.
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            break;
        }
        if sum(middle).0 < times { low = middle } else { high = middle }
    }
    (low, 1.0 / sum(low).1)
}
