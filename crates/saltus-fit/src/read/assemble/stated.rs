//! The height of release where no column and no row of a table tells it: from an option, a comment, or a line above the table.

use super::Builder;
use crate::error::TableError;
use crate::read::columns::Kind;
use crate::read::heading::What;
use crate::read::layout::Track;
use crate::read::rows::Rows;
use crate::read::units::Scale;

/// A first height down to this part of the stated one is the release itself: no ball rebounds so high.
const RELEASE: f64 = 0.99;

impl Builder<'_> {
    /// Gives the tracks the stated height of release, unless a column, or a row, tells it; says whether any took it.
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
            if first.is_none_or(|(height, _)| height < RELEASE * drop) {
                (track.drop, taken) = (Some(drop), true);
            }
        }
        Ok(taken && !percent)
    }
}
