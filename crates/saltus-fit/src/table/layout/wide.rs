//! Layouts with several readings in a row: drops with their rebounds, trials side by side, bounces side by side.

use saltus_bounce::units::Quantity;

use super::{Reader, bounce_number, empty};
use crate::error::TableError;
use crate::table::header::Kind;
use crate::table::sheet::Row;
use crate::table::{Event, Reading};

impl Reader<'_> {
    pub(super) fn drop_trials(&mut self, row: &Row<'_>) -> Result<(), TableError> {
        let columns = self.columns;
        if let Some(drop) = self.drop {
            self.required(row, drop)?;
        }
        for index in columns.all(&Kind::Trial(Quantity::Length)).filter(|&n| !row.cell(n).is_empty()) {
            self.pair(row, index)?;
        }
        Ok(())
    }

    /// A drop and the rebound in cell `index`.
    pub(super) fn pair(&mut self, row: &Row<'_>, index: usize) -> Result<(), TableError> {
        let height = self.height(row, Some(index))?.ok_or_else(|| empty(row, index))?;
        let column = &self.columns.columns[index];
        let which = if matches!(column.kind, Kind::Trial(_)) { column.name.as_str() } else { "" };
        let line = format!("line {}", row.line);
        let label = [self.label(row).as_str(), which, &line]
            .iter()
            .filter(|p| !p.is_empty())
            .copied()
            .collect::<Vec<_>>()
            .join(", ");
        let sigma_height = self.sigma(row, self.sigma_height)?;
        let trial = self.push_trial(row, label)?;
        let reading = Reading { height: Some(height), sigma_height, ..Reading::new(Event::Apex, 1, row.line) };
        self.trials[trial].readings.push(reading);
        Ok(())
    }

    pub(super) fn trial_columns(&mut self, row: &Row<'_>, number: Option<usize>) -> Result<(), TableError> {
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

    pub(super) fn bounce_columns(&mut self, row: &Row<'_>) -> Result<(), TableError> {
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
}
