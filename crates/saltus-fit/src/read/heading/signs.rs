//! Names that mean what they do beside the others of their row: coordinates, small Roman numbers
//! behind a name that comes again, `rebound (i)` beside `rebound (ii)`; and signs of points.

use super::Heading;

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
