//! Remarks that change what the readings beside them mean: the ball was thrown, the rule slipped,
//! every other bounce is missing. `alarms.tsv` lists how people say so.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::sync::OnceLock;

use serde::Deserialize;
use serde::de::{IntoDeserializer, value};

use super::against;
use super::aside::{Part, Why};
use super::clause::{frame_rate, names_ball};
use super::computed::recurs;
use super::grid::{Grid, shown};
use super::heading::Heading;
use super::phrases::{DENIED, Phrase, denies};
use super::region::Region;
use super::said::stem;
use super::strange;
use super::vocabulary::{Atom, ROWS, folded, unparted};
use super::words::{Kind, Word, marks, split, unaddressed};
use super::{Event, LeftAside, Table, Trial};
use crate::finding::{Change, Doubt, Note};
use crate::quantity::Ball;

/// A change, a tab, a phrase in lower case without accents, whose last word may go on where it ends
/// in `*`.
const ALARMS: &str = include_str!("alarms.tsv");

/// A remark of which so many words are not understood tells more than who measured, where and with
/// what: one in a hundred of those that change nothing has as many.
const STORY: usize = 5;

/// A name of so many words is a sentence.
const SENTENCE: usize = 4;

/// A phrase behind its first word.
struct Rest {
    change: Change,
    words: Vec<&'static str>,
    /// The last word of the phrase may go on.
    open: bool,
}

impl Rest {
    /// Whether the phrase stands at the beginning of `words`, whose first begins as its own does;
    /// `whole` if it is its own.
    fn stands(&self, whole: bool, words: &[&str]) -> bool {
        let last = self.words.len();
        let is = |(n, word): (usize, &&str)| {
            words.get(n + 1).is_some_and(|w| w == word || self.open && n + 1 == last && w.starts_with(word))
        };
        (whole || self.open && last == 0) && self.words.iter().enumerate().all(is)
    }
}

/// The lines of the file, each with what it changes.
fn entries() -> impl Iterator<Item = (Result<Change, value::Error>, &'static str)> {
    let lines = ALARMS.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once('\t'));
    lines.map(|(kind, phrase)| (Change::deserialize(kind.into_deserializer()), phrase))
}

/// The phrases by their first words.
fn phrases() -> &'static HashMap<&'static str, Vec<Rest>> {
    static ALL: OnceLock<HashMap<&'static str, Vec<Rest>>> = OnceLock::new();
    ALL.get_or_init(|| {
        let mut all: HashMap<&str, Vec<Rest>> = HashMap::new();
        for (change, phrase) in entries() {
            let Ok(change) = change else { continue };
            let mut words = phrase.trim_end_matches('*').split(' ');
            let first = words.next().unwrap_or_default();
            all.entry(first).or_default().push(Rest { change, words: words.collect(), open: phrase.ends_with('*') });
        }
        all
    })
}

/// What a text says that changes readings, but what it denies: `not thrown`.
fn changes(text: &str) -> Vec<Change> {
    let text = folded(&unaddressed(text));
    let mut found = Vec::new();
    for clause in text.split([',', ';', ':', '.', '(', ')', '!', '?']) {
        let words: Vec<&str> =
            clause.split(|c: char| !c.is_alphanumeric() && !marks(c)).filter(|word| !word.is_empty()).collect();
        let denies = |word: &&str| denies(word);
        for (at, word) in words.iter().enumerate() {
            if word.contains(unparted) {
                found.extend(within(word));
                continue;
            }
            let denied = |rest: &Rest| {
                let behind = at + 1 + rest.words.len();
                let after = words.get(behind);
                // What was copied from a program is what was typed there.
                let pasted = words[behind.min(words.len())..].iter().take(DENIED).any(|word| Phrase::Program.is(word));
                rest.change == Change::Unread && pasted
                    || after.is_some_and(denies)
                    || words[at.saturating_sub(DENIED)..at].iter().any(denies)
            };
            for end in word.char_indices().map(|(end, c)| end + c.len_utf8()) {
                let rests = phrases().get(&word[..end]).into_iter().flatten();
                let stands = rests.filter(|rest| rest.stands(end == word.len(), &words[at..]) && !denied(rest));
                found.extend(stands.map(|rest| rest.change));
            }
        }
    }
    found
}

/// What a run of a script that parts no words by blanks says that changes readings, but what is
/// denied right before it, or behind it, where the verb ends.
fn within(run: &str) -> Vec<Change> {
    let letters: Vec<usize> = run.char_indices().map(|(at, _)| at).chain([run.len()]).collect();
    let bends = |word: &str| word.contains(|c: char| matches!(c, '\u{3040}'..='\u{309f}'));
    let denying = |from: usize, to: usize, bent: bool| {
        let part = &run[letters[from]..letters[to.min(letters.len() - 1)]];
        let mut all = Phrase::Not.all().iter().chain(Phrase::Nothing.all());
        all.any(|word| word.contains(unparted) && bends(word) == bent && part.contains(word))
    };
    let mut found = Vec::new();
    for from in 0..letters.len() - 1 {
        for to in from + 1..letters.len() {
            let rests = phrases().get(&run[letters[from]..letters[to]]).into_iter().flatten();
            let denied = || denying(from.saturating_sub(DENIED), from, false) || denying(to, to + DENIED + 1, true);
            found.extend(rests.filter(|rest| rest.words.is_empty() && !denied()).map(|rest| rest.change));
        }
    }
    found
}

/// Whether a text says that numbers are means over balls, or floors, that differ: `mean of all
/// balls`, `average over a tennis ball and a golf ball`.
fn pools(text: &str) -> bool {
    let words = split(&unaddressed(text));
    let mean = |word: &Word| word.is(Atom::Mean) || word.is(Atom::Median);
    let Some(from) = words.iter().position(mean) else { return false };
    // `all the balls`, `all our five balls`, and no `all drops of the ball`.
    let silent = |word: &&Word| !matches!(word.kind, Kind::Known(atoms) if atoms[0] != Atom::Filler);
    let all = |at: usize| {
        let next = words[at + 1..].iter().find(|word| names_ball(word) || !silent(word));
        Phrase::Differing.is(&folded(&words[at].text)) && next.is_some_and(names_ball)
    };
    let mut balls: Vec<Ball> = words[from..].iter().filter_map(|word| Ball::named(&word.text)).collect();
    balls.dedup();
    (0..words.len()).any(all) || balls.len() > 1
}

/// How many words a text has, numbers not counted; two letters, more or less, are one of a script
/// that parts none by blanks.
fn words(text: &str) -> usize {
    let words = text.split(|c: char| !c.is_alphanumeric()).filter(|word| word.starts_with(char::is_alphabetic));
    words.map(|word| word.chars().filter(|c| unparted(*c)).count().div_ceil(2).max(1)).sum()
}

/// Why what bears a name is no reading: `Simulation`, `dynamic model A`, `wrong ball, do not use`.
pub(super) fn named(name: &str) -> Option<Why> {
    let predicted = Heading::parse(name).turned_by().contains(&Atom::Predicted);
    let said = changes(name).into_iter().find_map(|change| match change {
        Change::Unread => Some(Why::Predicted),
        Change::Void if words(name) > 1 => Some(Why::Void),
        _ => None,
    });
    said.or(predicted.then_some(Why::Predicted))
}

/// A remark in or around the tables of a text.
pub(super) struct Remark<'a> {
    text: &'a str,
    line: Option<u64>,
    /// The table that it stands above.
    above: Option<usize>,
    changes: Vec<Change>,
}

impl<'a> Remark<'a> {
    fn of(text: &'a str, line: Option<u64>) -> Self {
        let mut changes = changes(text);
        changes.extend(recurs(text).then_some(Change::Unread));
        changes.extend((strange::count(text) >= STORY).then_some(Change::Unclear));
        Self { text, line, above: None, changes }
    }

    fn doubt(&self, heeded: impl Fn(&str, Change) -> bool) -> Option<Doubt> {
        let change = self.changes.iter().copied().find(|change| heeded(self.text, *change))?;
        Some(Doubt::Remark { text: shown(self.text.trim()), line: self.line, change })
    }
}

/// The remarks in and around the tables of a text.
pub(super) fn remarks<'a>(grid: &'a Grid<'_>, regions: &[Region<'_>]) -> Vec<Remark<'a>> {
    let lines =
        regions.iter().enumerate().flat_map(|(n, region)| region.aside.iter().map(move |aside| (aside.line, n)));
    let above: HashMap<Option<u64>, usize> = lines.collect();
    // A name is of what stands below it, a remark of nothing.
    let names = |row: usize, n: usize| {
        regions.iter().any(|region| {
            let (row, n) = if region.view.across { (n, row) } else { (row, n) };
            row == region.header_row && region.rows.iter().any(|&below| !region.view.cell(below, n).is_empty())
        })
    };
    let cells = (0..grid.rows().min(ROWS)).flat_map(|row| (0..grid.width(row)).map(move |n| (row, n)));
    let cells = cells.filter(|&(row, n)| !names(row, n)).map(|(row, n)| (grid.cell(row, n), Some(grid.line(row))));
    // A word by itself names something: a ball, an event, a unit.
    let cells = cells.filter(|(cell, _)| words(cell) > 1);
    let texts = cells.chain(grid.comments().take(ROWS).map(|(line, text)| (text, Some(line))));
    texts.map(|(text, line)| Remark { above: above.get(&line).copied(), ..Remark::of(text, line) }).collect()
}

/// The doubt about a remark, or a name of table `n`, that changes what its readings mean: what is
/// above another table is about that, and what is in a row that does not count about the row.
pub(super) fn doubt((n, region): (usize, &Region<'_>), table: &Table, remarks: &[Remark<'_>]) -> Option<Doubt> {
    let readings = || table.trials.iter().flat_map(|trial| &trial.readings).filter(|r| r.event != Event::Sample);
    // A clock matters where flights are compared with heights; a film shows how it runs.
    let both = readings().any(|r| r.time.is_some()) && readings().any(|r| r.height.is_some());
    let timed = both || table.trials.iter().any(|trial| trial.timed.is_some());
    let void: HashSet<Option<u64>> =
        table.left_aside.iter().filter(|a| a.what == Part::Row && a.why == Why::Void).map(|a| a.line).collect();
    let own = |remark: &&Remark<'_>| remark.above.is_none_or(|of| of == n) && !void.contains(&remark.line);
    // One rate is that of a slow camera; a second one that at which it was played.
    let mut rates = remarks.iter().filter(own).flat_map(|r| r.text.split([',', ';'])).filter_map(frame_rate);
    let played = rates.next().is_some_and(|first| rates.any(|rate| rate != first));
    // That a ball bounced a sensor tells by its signal, however it was set.
    let felt = table.notes.iter().any(|note| matches!(note.kind, Note::Felt { .. } | Note::Flown { .. }));
    let heeded = |text: &str, change: Change| match change {
        Change::Clock => timed && (played || frame_rate(text).is_none()),
        Change::Shifted => region.zero.is_none(),
        Change::Unclear => !felt,
        _ => true,
    };
    let grid = region.view.grid;
    // What sums up in its own row says nothing of the others.
    let summed = |line: Option<u64>| {
        let row = line.map(|line| grid.row_of(line));
        row.is_some_and(|row| (0..grid.width(row)).any(|n| grid.cell(row, n).parse::<f64>().is_ok()))
    };
    let one = table.trials.windows(2).all(|pair| pair[0].group == pair[1].group);
    let pooled = |remark: &Remark<'_>| one && pools(remark.text) && !summed(remark.line);
    let beyond = |remark: &Remark<'_>| match () {
        () if pooled(remark) => Some(Change::Changed),
        () if against::misread(region, remark.text) => Some(Change::Shifted),
        () if against::mixed(region, table, remark.text) => Some(Change::Unsure),
        () if against::of_two_scales(region, remark.text) => Some(Change::Unsure),
        () if against::of_a_later(table, remark.text) => Some(Change::Counted),
        () => None,
    };
    let by_numbers = |remark: &Remark<'_>| {
        let text = shown(remark.text.trim());
        beyond(remark).map(|change| Doubt::Remark { text, line: remark.line, change })
    };
    let names = grid.tab.into_iter().chain([region.label.as_str(), stem(grid.name)]);
    let name = |text: &str| {
        let count = words(text);
        let of_all = |text: &str, change: Change| match change {
            Change::Thrown | Change::Medium | Change::Unread => true,
            Change::Void => count > 1,
            _ => count >= SENTENCE && heeded(text, change),
        };
        Remark::of(text, None).doubt(of_all)
    };
    let said = remarks.iter().filter(own).find_map(|remark| remark.doubt(heeded).or_else(|| by_numbers(remark)));
    said.or_else(|| names.into_iter().find_map(name))
}

/// Leaves groups and settings aside whose names say that they are no readings, where others remain.
/// Where there are more names than rows are looked through, they are numbers.
pub(super) fn leave(table: &mut Table) {
    let names = table.trials.iter().flat_map(|trial| [&trial.group, &trial.setting]);
    let apart: BTreeSet<String> = names.cloned().collect();
    let bad = apart.into_iter().take(ROWS).filter_map(|name| named(&name).map(|why| (name, why)));
    let bad: BTreeMap<String, Why> = bad.collect();
    let name = |trial: &Trial| [&trial.group, &trial.setting].into_iter().find(|name| bad.contains_key(*name)).cloned();
    if bad.is_empty() || table.trials.iter().all(|trial| name(trial).is_some()) {
        return;
    }
    table.trials.retain(|trial| name(trial).is_none());
    // What their names change concerns nothing else.
    let theirs = |text: &str| bad.keys().any(|name| name.contains(text.trim_end_matches('…')));
    table.doubts.retain(|doubt| !matches!(doubt, Doubt::Remark { text, .. } if theirs(text)));
    table.left_aside.extend(bad.into_iter().map(|(name, why)| LeftAside::new(Part::Text, name, why)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_phrase_changes_something_and_is_found() {
        for (change, phrase) in entries() {
            let change = change.unwrap();
            assert_eq!(folded(phrase), phrase);
            let bare = phrase.trim_end_matches('*');
            let rests = &phrases()[bare.split(' ').next().unwrap()];
            let words: Vec<&str> = bare.split(' ').collect();
            assert!(rests.iter().any(|rest| rest.change == change && rest.stands(true, &words)), "{phrase}");
        }
    }
}
