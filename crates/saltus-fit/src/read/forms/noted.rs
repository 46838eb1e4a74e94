//! Notes of drops, a line each, whose heights arrows lead to: `- golf: 100 → 74, 74, 77`.

use super::super::cell::{self, Cell};
use super::super::heading::Heading;
use super::{arrows, listed_values, silent};

/// A line: its name, the height of release, the heights behind the arrow.
struct Drop<'a> {
    name: &'a str,
    heights: Vec<String>,
}

/// The text with a row for each of such lines, two or more, and the others as remarks, which
/// measure nothing; `None` if it is none. A line stays a line.
pub(super) fn noted(text: &str) -> Option<String> {
    if text.contains(['\t', '|', ';']) {
        return None;
    }
    let lines: Vec<(&str, Option<Drop<'_>>)> = text.lines().map(|line| (line, drop(line))).collect();
    let drops = || lines.iter().filter_map(|(_, drop)| drop.as_ref());
    let led = |line: &str| arrows().any(|arrow| line.contains(arrow));
    let other = |(line, drop): &(&str, Option<Drop<'_>>)| drop.is_none() && (led(line) || !silent(line));
    // Lines without names, and of one height each, are patterns; what has a colon within is a
    // message with its time and who wrote it.
    let named = drops().all(|drop| !drop.name.is_empty() && !drop.name.contains(':'));
    if drops().count() < 2 || !named || lines.iter().any(other) {
        return None;
    }
    let first = lines.iter().position(|(_, drop)| drop.is_some())?;
    let most = drops().map(|drop| drop.heights.len()).max()?;
    let counted = |drop: &Drop<'_>| Heading::parse(drop.name).value().is_some_and(|value| !value.trial.is_empty());
    let key = if drops().all(counted) { "trial" } else { "ball" };
    let names = (1..most).map(|n| format!("\theight {n}")).collect::<String>();
    let spelt = |(n, (line, drop)): (usize, &(&str, Option<Drop<'_>>))| match drop {
        Some(drop) => {
            let row = format!("{}\t{}", drop.name, drop.heights.join("\t"));
            // A lone carriage return ends a row, and no line.
            if n == first { format!("{key}\theight before{names}\r{row}") } else { row }
        }
        None if n < first || line.trim().is_empty() => (*line).to_owned(),
        None => format!("#{line}"),
    };
    Some(lines.iter().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// A line that is a name, a height and an arrow to others.
fn drop(line: &str) -> Option<Drop<'_>> {
    let bare = line.trim_start_matches([' ', '-', '*', '•', '–', '·']).trim_end();
    let (at, arrow) = arrows().filter_map(|arrow| Some((bare.find(arrow)?, arrow))).min()?;
    let (left, right) = (bare[..at].trim_end(), bare[at + arrow.len()..].trim());
    let (name, release) = parted(left)?;
    let steps = arrows().find(|arrow| right.contains(*arrow));
    let values = match steps {
        Some(arrow) => right.split(arrow).map(|value| value.trim().to_owned()).collect(),
        None => listed_values(right),
    };
    let number = |value: &String| matches!(cell::read(value, false), Cell::Number(_));
    let heights: Vec<String> = std::iter::once(release.to_owned()).chain(values).collect();
    heights.iter().all(number).then_some(Drop { name: name.trim_end_matches([':', ' ', ',']), heights })
}

/// The words of a text and the number that it ends in, with its unit.
fn parted(text: &str) -> Option<(&str, &str)> {
    let blanks = text.char_indices().filter(|(_, c)| matches!(c, ' ' | ':')).map(|(at, _)| at);
    let starts = blanks.map(|at| at + 1).chain([0]);
    let number = |at: &usize| {
        let rest = &text[*at..];
        rest.starts_with(|c: char| c.is_ascii_digit()) && matches!(cell::read(rest, false), Cell::Number(_))
    };
    let at = starts.filter(number).min()?;
    Some((text[..at].trim(), text[at..].trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_lead_from_a_release_to_what_follows_it() {
        let rows = "all in cm\nball\theight before\theight 1\theight 2\rtennis\t100\t57\t56\ngolf ball\t1 m\t74\t74\n";
        let text = "all in cm\n- tennis: 100 → 57, 56\n- golf ball: 1 m -> 74, 74\n";
        assert_eq!(noted(text).as_deref(), Some(rows));
        let chained = "A: 100 -> 64 -> 41\nB: 100 -> 49\n";
        assert_eq!(
            noted(chained).as_deref(),
            Some("ball\theight before\theight 1\theight 2\rA\t100\t64\t41\nB\t100\t49\n")
        );
        for text in [
            "100 → 64\n80 → 51\n",
            "tennis: 100 → high\ngolf: 100 → 74\n",
            "tennis: 100 → 57\n",
            "[12:03] Anna: drop 1: 100 cm → 60 cm\n[12:04] Anna: drop 2: 100 cm → 59 cm\n",
            "tennis: 100 → 57\ngolf: 100 → 74\nthe floor is 3 cm thick\n",
        ] {
            assert_eq!(noted(text), None, "{text}");
        }
    }
}
