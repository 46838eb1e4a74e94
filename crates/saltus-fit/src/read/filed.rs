//! Columns that only the name of a file says: `drop_vs_rebound_cm` of a table without names.

use super::grid::View;
use super::heading::{At, Heading, Meaning, Role, Value, What};
use super::phrases::Phrase;
use super::region::Region;
use super::units::{Dimension, Unit};

/// The table without names whose columns that of its file says, each word of it being understood:
/// as many as there are, and no two of one quantity. A rebound is lower than its drop: where all
/// are in the other column, the name has them the other way round. `None` of any other name.
pub(super) fn table(view: View<'_>) -> Option<Region<'_>> {
    let width = view.width(0);
    let rows: Vec<usize> = (0..view.rows()).collect();
    if width < 2 || !rows.iter().all(|&row| (0..width).all(|n| view.is_number(row, n))) {
        return None;
    }
    let mut names = names(&view.grid.called(), width)?;
    let region = |names: Vec<String>| Region { given: true, ..Region::new(view, names, 0, rows.clone()) };
    let read = values(&names)?;
    let counts = |n: usize| region(names.clone()).counts(n);
    if !read.iter().enumerate().all(|(n, value)| value.is_some() || counts(n)) {
        return None;
    }
    let at = |event: At| read.iter().position(|v| v.as_ref().is_some_and(|v| (v.what, v.at) == (What::Height, event)));
    if let Some((drop, rebound)) = at(At::Release).zip(at(At::Row).or_else(|| at(At::Nth(1)))) {
        let lower = |&row: &usize| Some(view.number(row, rebound)? < view.number(row, drop)?);
        let lower: Vec<bool> = rows.iter().filter_map(lower).collect();
        if lower.iter().all(|lower| !lower) {
            names.swap(drop, rebound);
        } else if lower.contains(&false) {
            return None;
        }
    }
    Some(region(names))
}

/// What each column holds, if names say so: a quantity, or nothing of those that count rows.
fn values(names: &[String]) -> Option<Vec<Option<Value>>> {
    let of = |name: &String| {
        let heading = Heading::parse(name);
        match heading.meaning {
            _ if !heading.unknown.is_empty() => None,
            Meaning::Number { .. } | Meaning::Trial => Some(None),
            Meaning::Value(value) if value.what != What::Unsaid && value.role == Role::Reading => Some(Some(value)),
            _ => None,
        }
    };
    let found: Vec<Option<Value>> = names.iter().map(of).collect::<Option<_>>()?;
    let read: Vec<(What, At)> = found.iter().flatten().map(|value| (value.what, value.at)).collect();
    let apart = read.iter().enumerate().all(|(n, one)| !read[..n].contains(one));
    (apart && !read.is_empty() && found.len() <= read.len() + 1).then_some(found)
}

/// The parts of a name, `count` of them, each with the unit that the name ends in where it bears
/// none; `None` where it parts in no way, or in several that say different things.
fn names(name: &str, count: usize) -> Option<Vec<String>> {
    let words = name.split([' ', ',']).filter(|word| !word.is_empty());
    // A number before the names counts the files.
    let words: Vec<&str> = words.skip_while(|word| word.parse::<usize>().is_ok()).collect();
    let last = words.last()?.trim_matches(['(', ')', '[', ']']);
    let unit = Unit::parse(last).filter(|unit| unit.dimension != Dimension::Other);
    let bare = words.len() - usize::from(unit.is_some());
    let words: Vec<&str> = words[..bare].to_vec();
    let words = words.strip_suffix(&["in"]).unwrap_or(&words);
    let mark = |word: &&&str| Phrase::Versus.is(&word.to_lowercase()) || Phrase::And.is(&word.to_lowercase());
    let marks = words.iter().filter(mark).count();
    let spelt = |parts: Vec<&[&str]>| -> Vec<String> {
        let part = |words: &[&str]| {
            let name = words.join(" ");
            let measured = format!("{name} ({last})");
            let silent = unit.is_some() && Heading::parse(&name).unit.is_none();
            let fits =
                Heading::parse(&measured).value().is_some_and(|v| v.what.dimension() == unit.map(|u| u.dimension));
            if silent && fits { measured } else { name }
        };
        parts.into_iter().map(part).collect()
    };
    if marks > 0 {
        let parts: Vec<&[&str]> = words.split(|word| mark(&word)).collect();
        return Some(spelt(parts)).filter(|parts| parts.len() == count && parts.iter().all(|part| !part.is_empty()));
    }
    // Two names side by side part wherever both are understood.
    let halves = (1..words.len()).map(|at| spelt(vec![&words[..at], &words[at..]]));
    let found: Vec<Vec<String>> = halves.filter(|names| count == 2 && values(names).is_some()).collect();
    let says = |names: &[String]| -> Vec<Option<(What, At)>> {
        values(names).into_iter().flatten().map(|value| value.map(|v| (v.what, v.at))).collect()
    };
    let alike = found.windows(2).all(|pair| says(&pair[0]) == says(&pair[1]));
    found.into_iter().next().filter(|_| alike)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_part_where_each_part_is_understood() {
        for (name, count, expected) in [
            ("drop vs rebound cm", 2, Some("drop (cm)|rebound (cm)")),
            ("drop height and bounce height in cm", 2, Some("drop height (cm)|bounce height (cm)")),
            ("fallhöhe rücksprunghöhe cm", 2, Some("fallhöhe (cm)|rücksprunghöhe (cm)")),
            ("drop cm rebound cm", 2, Some("drop cm|rebound (cm)")),
            ("drop vs rebound", 2, Some("drop|rebound")),
            ("zorb vs rebound cm", 2, Some("zorb (cm)|rebound (cm)")),
            ("drop vs rebound cm", 3, None),
            ("ball data cm", 2, None),
            ("results", 2, None),
        ] {
            assert_eq!(names(name, count).map(|names| names.join("|")).as_deref(), expected, "{name}");
        }
        assert!(values(&["zorb (cm)".to_owned(), "rebound (cm)".to_owned()]).is_none());
        assert!(values(&["golf".to_owned(), "tennis".to_owned()]).is_none());
    }
}
