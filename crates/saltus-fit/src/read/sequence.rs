//! What numbers in a row are by how they go on: heights of bounces fall, samples of a sound rise.

use super::heading::Heading;
use super::vocabulary::Atom;

/// A ball that keeps more of its height at every bounce does not differ from one that is dropped
/// again and again.
pub(super) const LEVEL: f64 = 0.95;

/// Numbers of samples rise by more than this from contact to contact, where trials are counted by
/// ones: at 8000 a second, the slowest that sounds are recorded at, it is an eightieth of a second.
const SAMPLES: f64 = 100.0;

/// Whether a column is of samples of a sound, by its heading and its cells.
pub(super) fn of_samples<'a>(heading: &Heading, cells: impl Iterator<Item = &'a str>) -> bool {
    let between = heading.has(Atom::Between) || heading.has(Atom::Interval);
    heading.counts_samples() && if between { many(cells) } else { leap(cells) }
}

/// Whether cells hold whole numbers that are many, as those of the samples of a flight are.
fn many<'a>(cells: impl Iterator<Item = &'a str>) -> bool {
    let many = |cell: &str| cell.parse().is_ok_and(|value: f64| value.fract() == 0.0 && value > SAMPLES);
    let mut cells = cells.filter(|cell| !cell.is_empty()).peekable();
    cells.peek().is_some() && cells.all(many)
}

/// Whether cells hold whole numbers that rise as those of samples do.
fn leap<'a>(cells: impl Iterator<Item = &'a str>) -> bool {
    let whole = |cell: &str| cell.parse().ok().filter(|value: &f64| value.fract() == 0.0);
    let numbers: Vec<Option<f64>> = cells.filter(|cell| !cell.is_empty()).map(whole).collect();
    let rises = |pair: &[Option<f64>]| matches!(pair, [Some(a), Some(b)] if b - a > SAMPLES);
    numbers.len() > 1 && numbers.windows(2).all(rises)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contacts 40 ms apart are at samples that rise by 320 and more; samples that are things are
    /// counted by ones, or by tens.
    #[test]
    fn samples_of_a_sound_rise_by_more_than_things_are_counted_by() {
        let heading = Heading::parse("Sample");
        let of = |cells: &[&str]| of_samples(&heading, cells.iter().copied());
        assert!(of(&["4000", "4400", "4720"]) && of(&["4000", "8820", "12000"]));
        assert!(!of(&["1", "2", "3"]) && !of(&["20", "40", "60"]) && !of(&["4000", "3000"]));
    }
}
