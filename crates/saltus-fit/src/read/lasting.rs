//! Contacts that begin and end: where they are those of a ball on the floor, its flights are from
//! the end of each to the begin of the next.
//!
//! A ball stays on the floor for about as long at every bounce, a little longer the slower it is.
//! The beam of a light gate is blocked for a time that grows as one over the speed, a click rings
//! for the shorter the fainter it is, and a mark of one width says nothing. Where durations do not
//! show that they are of contacts, the times stay those of the begins, and what contacts take is
//! left to the models that are compared.

use std::f64::consts::SQRT_2;

use super::aside::{LeftAside, Part, Why};
use super::columns::{Columns, Kind};
use super::grid::shown;
use super::region::Region;
use super::{Event, Reading, Table, Trial};
use crate::elementary::{exp, hypot, ln};
use crate::finding::{Note, Remark};
use crate::statistics::{Line, median, rounding};

/// A contact of a ball lasts no longer, s: of a soft one, or one that lost its air, 40 ms.
pub(super) const LONGEST: f64 = 0.04;
/// Contacts of one ball last alike to within this part, as a standard deviation: two samples of a
/// contact of eight leave a tenth.
const ALIKE: f64 = 0.15;
/// From first to last contacts get no shorter than to this part: a force of which the last is four
/// times the threshold is above it for 0.84 of its time, a ringing that dies away for half of it.
const SHORTER: f64 = 0.75;
/// Durations whose differences are less than this part of them were set and not measured, where
/// they are written more finely: contacts differ by hundredths.
const SET: f64 = 1e-3;

/// What the durations of contacts are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lasting {
    /// Those of a ball on the floor.
    OnFloor,
    /// The longer the slower the ball is, as those of a beam that it blocks.
    Growing,
    /// Anything else.
    Other,
}

/// What durations are, each from a begin to an end in s, of which each has the standard error
/// `sigma`; flights are as the speeds of the contacts after them.
pub(super) fn of(contacts: &[(f64, f64)], sigma: f64) -> Lasting {
    let lasted = || contacts.iter().map(|(begin, end)| end - begin);
    let flown = || contacts.windows(2).map(|pair| pair[1].0 - pair[0].1);
    let usual = median(&mut lasted().collect::<Vec<f64>>()).filter(|_| contacts.len() > 2);
    let Some(usual) = usual.filter(|_| lasted().chain(flown()).all(|time| time > 0.0)) else { return Lasting::Other };
    let (low, high) = lasted().fold((f64::INFINITY, 0.0_f64), |(low, high), t| (low.min(t), high.max(t)));
    let set = high - low < SET * usual && sigma < SET * usual;
    let line = Line::through(flown().zip(lasted().skip(1)).map(|(flight, lasts)| (1.0, ln(flight), ln(lasts))));
    let fell = flown().next().zip(flown().next_back()).map_or(0.0, |(first, last)| ln(first / last));
    #[allow(clippy::cast_precision_loss)] // as many as there are contacts
    let spare = contacts.len().saturating_sub(3).max(1) as f64;
    let scatter = ((line.all - line.explained).max(0.0) / spare).sqrt();
    let alike = scatter <= hypot(ALIKE, SQRT_2 * sigma / usual);
    let grows = exp(-line.slope * fell);
    // Half way, in logarithms, from one duration to that of a beam, which is as one over the speed.
    let most = exp(0.5 * fell.abs()).max(1.0 / SHORTER);
    match () {
        () if alike && grows > most => Lasting::Growing,
        () if alike && !set && usual <= LONGEST && grows >= SHORTER => Lasting::OnFloor,
        () => Lasting::Other,
    }
}

/// How long contacts on the floor last, as a note.
pub(super) fn noted(contacts: impl Iterator<Item = (f64, f64)>) -> Option<Remark<Note>> {
    let mut lasted: Vec<f64> = contacts.map(|(begin, end)| end - begin).collect();
    Some(Note::Aloft { contact_s: median(&mut lasted)? }.into())
}

/// Puts a trial on a clock that stands still during its contacts, each for as long as it lasted.
pub(super) fn aloft(trial: &mut Trial, mut lasted: impl FnMut(&Reading) -> Option<f64>) {
    let mut before = 0.0;
    for reading in &mut trial.readings {
        let lasts = if reading.event == Event::Contact { lasted(reading) } else { None };
        reading.time = reading.time.map(|time| time - before);
        before += lasts.unwrap_or(0.0);
    }
}

/// Takes the contacts out of the times of a table whose column tells their ends, where they are of
/// the floor; else that column is left aside.
pub(super) fn taken_off(region: &Region<'_>, columns: &Columns, table: &mut Table) {
    let ends = columns.columns.iter().enumerate().find_map(|(n, column)| match column.kind {
        Kind::Ends(_) => column.unit.map(|unit| (n, column, unit)),
        _ => None,
    });
    let Some((index, column, unit)) = ends else { return };
    let end = |reading: &Reading| Some(unit.si(region.view.number(region.row_of(reading.line), index)?));
    let contact = |reading: &Reading| Some((reading.time?, end(reading)?));
    let contacts = |trial: &Trial| {
        let own = trial.readings.iter().filter(|reading| reading.event == Event::Contact);
        own.map(contact).collect::<Option<Vec<(f64, f64)>>>().filter(|contacts| {
            let times: Vec<f64> = contacts.iter().flat_map(|&(begin, end)| [begin, end]).collect();
            of(contacts, rounding(&times)) == Lasting::OnFloor
        })
    };
    let Some(found) = table.trials.iter().map(contacts).collect::<Option<Vec<_>>>() else {
        let name = shown(&column.heading.text);
        table.left_aside.push(LeftAside::new(Part::Column, name, Why::Elsewhere));
        return;
    };
    table.notes.extend(noted(found.into_iter().flatten()));
    table.metadata.intervals = true;
    for trial in &mut table.trials {
        aloft(trial, |reading| Some(end(reading)? - reading.time?));
    }
}
