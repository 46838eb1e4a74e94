//! Names that mean what they do beside the others of their row: coordinates, small Roman numbers
//! behind a name that comes again, `rebound (i)` beside `rebound (ii)`; and signs of points.

use super::super::units::Dimension;
use super::super::vocabulary::Atom;
use super::super::words::split;
use super::{Heading, Meaning};

/// As many as columns are counted by them.
const COUNT: [&str; 8] = ["i", "ii", "iii", "iv", "v", "vi", "vii", "viii"];

impl Heading {
    /// What a name means beside the others of its row, where that is more than it says by itself.
    pub(in crate::read) fn beside(text: &str, header: &[String]) -> Option<Self> {
        let found = Self::coordinate(text, header).or_else(|| Self::flight(text, header));
        found
            .or_else(|| Self::initial(text, header))
            .or_else(|| Self::roman(text, header))
            .or_else(|| Self::point(text))
            .or_else(|| Self::upright(text, header))
    }

    /// The only component of a speed that is listed, before or after a bounce, `vz before (m/s)`:
    /// the one that turns round.
    fn upright(text: &str, header: &[String]) -> Option<Self> {
        let component = |text: &'_ str| -> Option<(String, usize)> {
            let lower = text.to_ascii_lowercase();
            let sign = lower.strip_prefix('v')?.trim_start_matches('_');
            let axis = sign.chars().next().filter(|c| matches!(c, 'x' | 'y' | 'z'))?;
            let end = lower.len() - sign.len() + 1;
            (!sign[1..].starts_with(char::is_alphanumeric)).then(|| (axis.to_string(), end))
        };
        let (axis, end) = component(text).filter(|(axis, _)| axis != "x")?;
        let others = header.iter().filter_map(|name| component(name)).any(|(other, _)| other != axis);
        let heading = Self::parse(&format!("v{}", &text[end..]));
        let of_speed = heading.unit.is_some_and(|unit| unit.dimension == Dimension::Speed);
        let at_impact = heading.has(Atom::Before) || heading.has(Atom::After);
        (of_speed && at_impact && !others).then(|| heading.called(text))
    }

    /// One of the coordinates that columns of one name hold, `ball_x` beside `ball_y`, or of one
    /// number, `X1` beside `Y1`.
    fn coordinate(text: &str, header: &[String]) -> Option<Self> {
        let parted = |text: &str| {
            let end = text.find(['(', '[']).unwrap_or(text.len());
            let name = text[..end].trim_end();
            let sign = name.trim_end_matches(|c: char| c.is_ascii_digit());
            if let (true, "x" | "y" | "z" | "X" | "Y" | "Z") = (sign.len() < name.len(), sign) {
                let letter = sign.chars().next()?;
                return Some((name[sign.len()..].to_owned(), letter, format!("{letter} {}", &text[end..])));
            }
            let letter = name.chars().next_back().filter(|c| matches!(c.to_ascii_lowercase(), 'x'..='z'))?;
            let stem = name.strip_suffix(letter)?;
            // What a colon ends is the name of the run.
            let joined = stem.chars().all(char::is_lowercase) && letter.is_lowercase();
            let apart = (joined || stem.ends_with(['_', ' ', '.', '-', '/']))
                && !stem.trim_end().ends_with(':')
                && stem.contains(char::is_alphabetic);
            apart.then(|| (stem.to_owned(), letter, format!("{letter} {}", &text[end..])))
        };
        let (stem, letter, plain) = parted(text)?;
        let other =
            |name: &String| parted(name).is_some_and(|(of, l, _)| of == stem && !l.eq_ignore_ascii_case(&letter));
        let mut heading = header.iter().any(other).then(|| Self::parse(&plain).called(text))?;
        // Where several bodies are followed, each column is of the one that it names.
        let body = |name: &String| parted(name).map(|(of, _, _)| of).filter(|of| of.contains(char::is_alphabetic));
        let several = header.iter().filter_map(body).any(|of| of != stem);
        let name = stem.trim_end_matches(['_', ' ', '.', '-', '/']);
        if let (true, true, Meaning::Value(value)) = (several, name != stem, &mut heading.meaning) {
            let run = split(name).iter().any(|word| word.is(Atom::Trial));
            *(if run { &mut value.trial } else { &mut value.group }) = name.to_owned();
        }
        Some(heading)
    }

    /// `h_i` beside `h_f`: before and after, where `h_i` by itself is counted.
    pub(super) fn initial(text: &str, header: &[String]) -> Option<Self> {
        let parted = |text: &str| {
            let (sign, rest) = text.split_once('_')?;
            let end = rest.find(|c: char| !c.is_alphanumeric()).unwrap_or(rest.len());
            let signs = sign.chars().count() == 1 && matches!(&rest[..end], "i" | "f");
            signs.then(|| (sign.to_owned(), rest[..end].to_owned()))
        };
        let (sign, event) = parted(text)?;
        let other = |name: &String| parted(name).is_some_and(|(of, at)| of == sign && at != event);
        header.iter().any(other).then(|| Self::parse(&text.replacen('_', "", 1)).called(text))
    }

    /// `P1Y`: the place of a point that is followed, by its number and its axis.
    fn point(text: &str) -> Option<Self> {
        let (name, unit) = text.split_at(text.find([' ', '(', '[']).unwrap_or(text.len()));
        let (point, axis) = name.strip_prefix('P')?.split_at_checked(name.len().checked_sub(2)?)?;
        let fits = point.parse::<u32>().is_ok() && matches!(axis, "X" | "Y");
        fits.then(|| Self::parse(&format!("{axis} {unit}")).called(text))
    }

    /// A name with a small Roman number, where the first two of that name stand in the row.
    fn roman(text: &str, header: &[String]) -> Option<Self> {
        let (name, number, rest) = parted(text)?;
        let stands = |n: usize| {
            let mut others = header.iter().filter_map(|name| parted(name));
            others.any(|(of, own, behind)| (of, own, behind) == (name, n, rest))
        };
        (stands(1) && stands(2)).then(|| Self::parse(&format!("{name} {number}{rest}")).called(text))
    }
}

/// A name, the small Roman number behind it, by itself or in brackets, and the text behind that.
fn parted(text: &str) -> Option<(&str, usize, &str)> {
    let starts = text.char_indices().filter(|(at, _)| text[..*at].ends_with([' ', '(', '_'])).map(|(at, _)| at);
    starts
        .filter_map(|at| {
            let end = text[at..].find(|c: char| !c.is_alphanumeric()).map_or(text.len(), |long| at + long);
            let number = COUNT.iter().position(|count| *count == &text[at..end])? + 1;
            let name = text[..at].trim_end_matches([' ', '(', '_']);
            let closed = text[..at].ends_with('(');
            let rest = if closed { text[end..].strip_prefix(')')? } else { &text[end..] };
            (!name.is_empty()).then_some((name, number, rest))
        })
        .next_back()
}

#[cfg(test)]
mod tests {
    use super::super::At;
    use super::*;

    #[test]
    fn small_roman_numbers_count_names_that_come_again() {
        let header = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        for names in [["rebound (i)", "rebound (ii)"], ["Rebound i (cm)", "Rebound ii (cm)"], ["h_i [m]", "h_ii [m]"]] {
            for (n, text) in (1..).zip(names) {
                let heading = Heading::roman(text, &header(&names)).unwrap();
                assert_eq!(heading.value().map(|value| value.at), Some(At::Nth(n)), "{text}");
            }
        }
        assert_eq!(Heading::point("P2Y (cm)").unwrap().value(), Heading::parse("Y (cm)").value());
        assert!(["PY", "P1Z", "P1", "Point"].iter().all(|text| Heading::point(text).is_none()));
        // A letter that counts any bounce, a volume, and a name by itself.
        for names in [["h_i", "h_f"], ["rebound v", "rebound vi"], ["i", "ii"]] {
            assert!(Heading::roman(names[0], &header(&names)).is_none(), "{names:?}");
        }
    }
}
