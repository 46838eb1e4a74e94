//! What codes stand for, in columns beside those of the readings: `Code`, `Ball`.

use std::collections::BTreeSet;
use std::ops::Range;

use super::super::aside::{LeftAside, Part, Why};
use super::super::grid::shown;
use super::super::vocabulary::ROWS;
use super::Region;

/// A name has no more words; more are a sentence.
const NAME: usize = 4;

/// Takes the columns behind blank ones off a table whose first lists each of the codes of a column
/// of the table once, beside rows of other codes; and a sentence there that nothing stands below.
pub(super) fn leave(region: &mut Region<'_>) {
    for block in keys(region) {
        let text = shown(&region.header[block.clone()].join(" "));
        region.aside.push(LeftAside::new(Part::Text, text, Why::NoTable).at(region.view.line(region.header_row, 0)));
        region.header[block].fill(String::new());
    }
}

fn keys(region: &Region<'_>) -> Vec<Range<usize>> {
    let blocks = blocks(region);
    let Some((own, others)) = blocks.split_first() else { return Vec::new() };
    let bare = |n: usize| region.rows.iter().all(|&row| region.cell(row, n).is_empty());
    let said = |n: usize| bare(n) && region.header[n].split_whitespace().count() > NAME;
    let listed = |block: &Range<usize>| block.len() > 1 && lists(region, own, block.start);
    others.iter().filter(|block| listed(block) || (*block).clone().all(said)).cloned().collect()
}

/// The runs of named columns that blank ones part.
fn blocks(region: &Region<'_>) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for n in (0..region.header.len()).filter(|&n| !region.header[n].is_empty()) {
        match found.last_mut().filter(|block| block.end == n) {
            Some(block) => block.end += 1,
            None => found.push(n..n + 1),
        }
    }
    found
}

/// Whether a column lists each of the words that a column of the table holds once, and not in the
/// rows of these.
fn lists(region: &Region<'_>, own: &Range<usize>, keys: usize) -> bool {
    let cells = |n: usize| {
        let rows = region.rows.iter().take(ROWS).map(move |&row| (row, region.cell(row, n)));
        rows.filter(|(_, cell)| !cell.is_empty())
    };
    let listed: Vec<&str> = cells(keys).map(|(_, cell)| cell).collect();
    let apart: BTreeSet<&str> = listed.iter().copied().collect();
    let of = |n: usize| {
        let words = cells(n).map(|(_, cell)| cell).collect::<BTreeSet<_>>();
        let elsewhere = cells(keys).any(|(row, cell)| region.cell(row, n) != cell);
        words == apart && elsewhere
    };
    listed.len() > 1 && listed.len() == apart.len() && own.clone().any(of)
}
