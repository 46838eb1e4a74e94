//! What a table states beside its readings: a height of release above it or in an option, the CORs
//! that its writer worked out, and what is not used.

use std::collections::HashMap;

use super::Builder;
use crate::error::TableError;
use crate::read::aside::{LeftAside, Part, Why};
use crate::read::cell::Cell;
use crate::read::columns::{Columns, Kind};
use crate::read::grid::shown;
use crate::read::heading::What;
use crate::read::layout::Track;
use crate::read::region::Region;
use crate::read::rows::Rows;
use crate::read::sequence::LEVEL;
use crate::read::units::Scale;
use crate::read::{Table, Trial};

/// Gives each trial the CORs that a column of the table works out beside its readings.
pub(super) fn cors(region: &Region<'_>, columns: &Columns, rows: &Rows, trials: &mut [Trial]) {
    if region.view.across {
        return;
    }
    for (index, column) in columns.columns.iter().enumerate().filter(|(_, c)| c.kind == Kind::Aside && c.heading.cor) {
        let mut found: HashMap<u64, f64> = HashMap::new();
        for row in &rows.rows {
            if let Cell::Number(m) = region.view.read(row.at, index) {
                let unit = m.unit.or(column.unit).filter(|unit| unit.scale == Scale::Percent);
                let cor = unit.map_or(m.value, |unit| unit.si(m.value));
                if cor > 0.0 && cor < 1.5 {
                    found.insert(region.view.line(row.at, index), cor);
                }
            }
        }
        for trial in trials.iter_mut() {
            let mut lines: Vec<u64> = trial.readings.iter().map(|r| r.line).collect();
            lines.dedup();
            trial.stated.extend(lines.iter().filter_map(|line| found.get(line)));
        }
    }
}

/// Gives each trial what stands in its rows in columns of other quantities, of remarks, or of names
/// that are not understood.
pub(super) fn beside(region: &Region<'_>, columns: &Columns, rows: &Rows, table: &mut Table) {
    if region.view.across {
        return;
    }
    let other = |name: &str| {
        let of = |aside: &&LeftAside| aside.what == Part::Column && aside.name == name;
        table
            .left_aside
            .iter()
            .find(of)
            .is_some_and(|aside| matches!(aside.why, Why::Other | Why::Note | Why::NotUnderstood))
    };
    let left: Vec<(usize, String)> = columns
        .columns
        .iter()
        .enumerate()
        .filter(|(_, c)| c.kind == Kind::Aside)
        .map(|(n, c)| (n, shown(&c.heading.text)))
        .filter(|(_, name)| other(name))
        .collect();
    let rows: HashMap<u64, usize> = rows.rows.iter().map(|row| (region.view.line(row.at, 0), row.at)).collect();
    for trial in &mut table.trials {
        let own: Vec<usize> = trial.readings.iter().filter_map(|r| rows.get(&r.line).copied()).collect();
        for (column, name) in &left {
            let mut cells = own.iter().map(|&row| region.cell(row, *column));
            let first = cells.next().filter(|cell| !cell.is_empty());
            if let Some(cell) = first.filter(|first| cells.all(|cell| cell == *first)) {
                trial.beside.push((name.clone(), cell.to_owned()));
            }
        }
    }
}

impl Builder<'_> {
    /// Gives the tracks the stated height of release, unless a column, or a row, tells it; says
    /// whether any took it.
    pub(super) fn dropped(&self, rows: &Rows, tracks: &mut [Track], drop: Option<f64>) -> Result<bool, TableError> {
        // Hundredths are of the release.
        let percent = self.columns.values().any(|(_, c, _)| c.unit.is_some_and(|unit| unit.scale == Scale::Percent));
        let Some(drop) = drop.filter(|_| !self.columns.unscaled).or(percent.then_some(1.0)) else { return Ok(false) };
        let numbered = rows.rows.iter().any(|row| row.bounce == Some(0));
        let events = self.columns.one(&Kind::Event).is_some();
        let series = tracks.iter().any(|t| t.time.is_some() && t.height.is_some());
        if numbered || events || series {
            return Ok(false);
        }
        let mut taken = false;
        for track in tracks.iter_mut().filter(|t| !t.released() && t.before.is_none()) {
            let column = track.height.or(track.nth.first().copied());
            let column = column.filter(|n| self.columns.columns[*n].holds(What::Height));
            let first = rows.rows.iter().find_map(|row| self.height(row.at, column?).transpose()).transpose()?;
            // A first height that is level with the stated one is the release itself.
            if first.is_none_or(|(height, _)| height < LEVEL * drop) {
                (track.drop, taken) = (Some(drop), true);
            }
        }
        Ok(taken && !percent)
    }
}
