//! What the lines above a table state: how many frames were filmed in a second, and the height of release.

use super::heading::{Heading, release};
use super::region::Region;
use super::units::Dimension;
use super::vocabulary::{Atom, folded};
use super::words::{Kind, Word, split};

/// What a table's title states, and where.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Stated {
    /// The line of one cell next to the table: its name.
    pub(super) name: String,
    /// Frames a second, and the line.
    pub(super) fps: Option<(f64, u64)>,
    /// The height of release, m, and the line.
    pub(super) drop: Option<(f64, u64)>,
}

/// Remarks below a table are looked for in so many of its last lines.
const REMARKS: usize = 20;

/// What frame rates are written in.
const RATES: [&str; 14] = [
    "fps",
    "frames per second",
    "frames/s",
    "frames/second",
    "frames a second",
    "hz",
    "bilder/s",
    "bilder pro sekunde",
    "images/s",
    "images par seconde",
    "im/s",
    "fotogrammi al secondo",
    "fotogramas por segundo",
    "cuadros por segundo",
];

/// Reads the lines above a table.
pub(super) fn stated(region: &Region<'_>) -> Stated {
    let mut found = Stated::default();
    if region.view.across {
        return found;
    }
    // Below a table as well, where a line stands alone.
    let above = region.aside.iter().filter_map(|aside| aside.line).map(|line| region.view.grid.row_of(line));
    let alone = |row: &usize| (1..region.view.width(*row)).all(|n| region.view.cell(*row, n).is_empty());
    let below = region.rows.iter().rev().take(REMARKS).copied().filter(alone);
    for row in above.chain(below) {
        let line = region.view.line(row, 0);
        let cells: Vec<&str> = region.view.cells(row).filter(|cell| !cell.is_empty()).collect();
        let text = cells.join(" ");
        found.fps = found.fps.or(frame_rate(&text).map(|fps| (fps, line)));
        found.drop = found.drop.or(drop(&text).map(|drop| (drop, line)));
        found.name = if cells.len() == 1 && row < region.header_row { text } else { found.name };
    }
    found
}

/// The number that a text ends in, and the text before it.
fn last_number(text: &str) -> Option<(f64, &str)> {
    let digits = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',');
    let before = text.trim_end_matches(digits);
    let value: f64 = text[before.len()..].replace(',', ".").parse().ok()?;
    (value.is_finite() && value > 0.0).then_some((value, before.trim_end_matches([' ', ':', '='])))
}

/// `240 fps`, `Frame rate: 240`.
fn frame_rate(text: &str) -> Option<f64> {
    let text = folded(text);
    let number = RATES.iter().find_map(|unit| {
        let at = text.find(unit)?;
        let ends = text[at + unit.len()..].chars().next().is_none_or(|c| !c.is_alphanumeric());
        last_number(text[..at].trim_end()).filter(|_| ends)
    });
    let named =
        || last_number(text.trim_end()).filter(|(_, before)| matches!(*before, "fps" | "frame rate" | "framerate"));
    number.or_else(named).map(|(value, _)| value)
}

/// `Drop height: 1 m`, `Drop height (cm) 100`, `Dropped from 100 cm`; every other word has to be understood.
fn drop(text: &str) -> Option<f64> {
    let understood = |text: &str| {
        let words = split(text);
        let released = words.iter().any(|w| w.is(Atom::Release));
        let turned = [Atom::Predicted, Atom::Goal, Atom::Lost, Atom::Derived];
        let plain =
            |w: &Word| !matches!(w.kind, Kind::Unknown | Kind::Number(_)) && !turned.iter().any(|atom| w.is(*atom));
        released && words.iter().all(plain)
    };
    if let Some((height, rest)) = release(text) {
        return understood(&rest).then(|| height.metres());
    }
    let (value, before) = last_number(text.trim_end())?;
    let heading = Heading::parse(before);
    let unit = heading.unit.filter(|unit| unit.dimension == Dimension::Length && !unit.unscaled())?;
    (heading.unknown.is_empty() && heading.has(Atom::Release) && !heading.turns()).then(|| unit.si(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_state_rates_and_heights() {
        for (text, fps, height) in [
            ("Filmed at 240 fps", Some(240.0), None),
            ("Frame rate: 59.94", Some(59.94), None),
            ("Video mit 120 Bilder/s", Some(120.0), None),
            ("Drop height: 100 cm", None, Some(1.0)),
            ("Drop height (cm) 150", None, Some(1.5)),
            ("Fallhöhe = 1,2 m", None, Some(1.2)),
            ("Ball dropped from 2 m", None, Some(2.0)),
            ("Experiment 3, Table 2", None, None),
            ("The ball was released 5 cm from the edge", None, None),
            ("Expected drop height: 1 m", None, None),
            ("Mass (g) 58", None, None),
        ] {
            assert_eq!((frame_rate(text), drop(text)), (fps, height), "{text}");
        }
    }
}
