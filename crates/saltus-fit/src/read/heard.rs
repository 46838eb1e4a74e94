//! A table from a sound: the contacts of each drop, and what of the sound was not used.

use std::io::Cursor;
use std::path::Path;

use super::aside::{LeftAside, Part, Why};
use super::{Event, ReadOptions, Reading, Table, Trial, check};
use crate::error::TableError;
use crate::finding::{Doubt, Lines, Note};
use crate::sound::{SURE, Sound, Unused, is_wav};

/// A recording of which more than this part is as loud as can be is overdriven.
const CLIPPED: f64 = 0.001;

/// The sound in a file, if it is one that is read; what is in no WAV file is not.
pub(super) fn of_file(path: &Path, name: &str, options: &ReadOptions) -> Option<Result<Table, TableError>> {
    let mut file = std::io::BufReader::new(std::fs::File::open(path).ok()?);
    let begins = std::io::BufRead::fill_buf(&mut file).ok()?;
    is_wav(begins).then(|| Sound::read(name, file, options.listened()).map(|sound| table(sound, options)))
}

/// The sound in the bytes of a file.
pub(super) fn of_bytes(name: &str, bytes: &[u8], options: &ReadOptions) -> Option<Result<Table, TableError>> {
    is_wav(bytes).then(|| Sound::read(name, Cursor::new(bytes), options.listened()).map(|sound| table(sound, options)))
}

/// Whether two tables are of one sound.
pub(super) fn is_same(a: &Table, b: &Table) -> bool {
    !a.sounds.is_empty() && a.trials == b.trials
}

impl Table {
    /// The contacts of a sound: a trial for each drop in it.
    #[must_use]
    pub fn from_sound(sound: Sound) -> Self {
        let mut table = table(sound, &ReadOptions::default());
        check::table(&mut table);
        table
    }

    /// The sounds that it was read from.
    #[must_use]
    pub fn sounds(&self) -> &[Sound] {
        &self.sounds
    }
}

/// The table, which is not yet checked.
pub(super) fn table(sound: Sound, options: &ReadOptions) -> Table {
    let several = sound.drops().len() > 1;
    let trials = sound.drops().iter().enumerate().map(|(n, contacts)| {
        let reading = |contact: &crate::sound::Contact| Reading {
            time: Some(contact.time),
            ..Reading::new(Event::Contact, contact.number, contact.number as u64)
        };
        let label = if several { format!("drop {}", n + 1) } else { String::new() };
        Trial { label, readings: contacts.iter().map(reading).collect(), ..Trial::default() }
    });
    let trials: Vec<Trial> = trials.collect();
    let contacts = sound.drops().iter().map(Vec::len).sum();
    let part = sound.part();
    let mut notes =
        vec![Note::Heard { sounds: contacts + sound.unused.len(), contacts, from: part.start, to: part.end }.into()];
    if sound.clipped() > CLIPPED {
        notes.push(Note::Overdriven { part: sound.clipped() }.into());
    }
    let mut doubts = doubts(sound.drops().iter().map(Vec::len), &sound.evidence);
    let undying = sound.fades.iter().filter(|fade| fade.is_none());
    #[allow(clippy::cast_possible_truncation)] // decibels
    doubts.extend(
        undying.map(|fade| Doubt::Undying { lost_db: fade.lost.round() as i32, due_db: fade.due.round() as i32 }),
    );
    let left_aside = aside(Part::Sound, &sound.unused);
    let metadata = super::Metadata { drop: options.drop, ..super::Metadata::default() };
    Table {
        name: sound.name().to_owned(),
        rows: contacts,
        trials,
        notes,
        doubts,
        left_aside,
        metadata,
        sounds: vec![sound],
        ..Table::default()
    }
}

/// Drops of so many contacts each that may be heard by chance.
pub(super) fn doubts(contacts: impl Iterator<Item = usize>, evidence: &[f64]) -> Vec<Doubt> {
    let chance = |(contacts, &evidence): (usize, &f64)| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below a thousand
        let once_in = evidence.min(SURE).exp() as u64;
        (evidence < SURE).then_some(Doubt::Chance { contacts, once_in })
    };
    contacts.zip(evidence).filter_map(chance).collect()
}

/// What was heard or felt and is not used, together for each reason.
pub(super) fn aside(part: Part, unused: &[(f64, Unused)]) -> Vec<LeftAside> {
    let of = |kind: Unused| {
        let times: Vec<f64> = unused.iter().filter(|(_, why)| *why == kind).map(|(time, _)| *time).collect();
        let named: Vec<String> = times.iter().take(Lines::NAMED).map(|time| format!("{time:.3} s")).collect();
        let more = times.len() - named.len();
        let name = if more > 0 { format!("{} and {more} more", named.join(", ")) } else { named.join(", ") };
        let why = match kind {
            Unused::Echo => Why::Echo,
            Unused::Close => Why::Close,
            Unused::Stray => Why::NoBounce,
        };
        (!times.is_empty()).then(|| LeftAside::new(part, name, why))
    };
    [Unused::Stray, Unused::Echo, Unused::Close].into_iter().filter_map(of).collect()
}
