//! Which lines of a text name its columns: one below titles, or two, where cells of the upper are merged or the lower holds units.

use saltus_bounce::units::Quantity;

use super::units::is_unit;

/// One line of the head of a text: its cells, and whether any of them is a number.
pub(super) type Line<'a> = (&'a [String], bool);

/// The names of the columns, the line that they stand in, and that of the first row below.
pub(super) fn heading(head: &[Line<'_>]) -> (Vec<String>, usize, usize) {
    let filled = |n: usize| head[n].0.iter().filter(|cell| !cell.is_empty()).count();
    let titles = |lines: usize| (0..lines).all(|n| !head[n].1 && filled(n) == 1);
    let one = |n: usize| (head.get(n).map_or_else(Vec::new, |line| line.0.to_vec()), n, n + 1);
    // The last line without numbers before one with them.
    let last = (0..head.len().saturating_sub(1))
        .find(|&n| !head[n].1 && (filled(n) > 1 || n > 0 && of_units(head[n].0)) && head[n + 1].1);
    let Some(last) = last else { return one(0) };
    if let Some(upper) = last.checked_sub(1).filter(|&n| !head[n].1 && titles(n))
        && let Some(names) = both(head[upper].0, head[last].0)
    {
        return (names, upper, last + 1);
    }
    one(if titles(last) { last } else { 0 })
}

/// The names that two lines give together; `None` where the upper is a title.
fn both(upper: &[String], lower: &[String]) -> Option<Vec<String>> {
    let width =
        upper.iter().rposition(|cell| !cell.is_empty())?.max(lower.iter().rposition(|cell| !cell.is_empty())?) + 1;
    let cell = |line: &[String], n: usize| line.get(n).cloned().unwrap_or_default();
    if of_units(lower) {
        let name = |n: usize| match (cell(upper, n), symbol(&cell(lower, n))) {
            (name, Some(unit)) if !name.is_empty() => format!("{name} ({unit})"),
            (name, _) => name,
        };
        // What has a unit has a name.
        return (0..width)
            .all(|n| cell(lower, n).is_empty() || !cell(upper, n).is_empty())
            .then(|| (0..width).map(name).collect());
    }
    // A title stands alone in the first cell.
    if upper.iter().skip(1).all(String::is_empty) {
        return None;
    }
    // A merged cell holds its text in the first of the columns that it spans.
    let mut spanning = String::new();
    let above: Vec<String> = (0..width)
        .map(|n| {
            if !cell(upper, n).is_empty() {
                spanning = cell(upper, n);
            } else if cell(lower, n).is_empty() {
                spanning.clear();
            }
            spanning.clone()
        })
        .collect();
    let merged = (0..width).any(|n| cell(upper, n).is_empty() != cell(lower, n).is_empty());
    let repeated = (0..width).any(|n| !cell(lower, n).is_empty() && (0..n).any(|m| cell(lower, m) == cell(lower, n)));
    let name = |n: usize| match (above[n].as_str(), cell(lower, n)) {
        (name, lower) if lower.is_empty() => name.to_owned(),
        ("", lower) => lower,
        // `Trial 1` above `Time (s)`, and `Trial 2` above another: runs side by side.
        (name, lower) if repeated => format!("{name}: {lower}"),
        // `Rebound (cm)` above `Trial 1`: the unit is for both.
        (name, lower) => match name.rfind(['(', '[']) {
            Some(open) if !lower.contains(['(', '[']) => format!("{lower} {}", &name[open..]),
            _ => lower,
        },
    };
    merged.then(|| (0..width).map(name).collect())
}

/// Whether a line holds units and nothing else.
fn of_units(line: &[String]) -> bool {
    line.iter().all(|cell| cell.is_empty() || symbol(cell).is_some())
}

/// The unit that a cell holds and nothing else, with or without brackets.
fn symbol(cell: &str) -> Option<&str> {
    let bare = cell.trim_matches(['(', ')', '[', ']']).trim();
    let known = [Quantity::Time, Quantity::Length, Quantity::Speed, Quantity::Acceleration];
    known.iter().any(|quantity| is_unit(*quantity, &bare.to_lowercase())).then_some(bare)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> (Vec<String>, usize, usize) {
        let cells: Vec<Vec<String>> =
            text.lines().map(|line| line.split(',').map(|cell| cell.trim().to_owned()).collect()).collect();
        let number = |line: &Vec<String>| line.iter().any(|cell| cell.parse::<f64>().is_ok());
        let lines: Vec<Line<'_>> = cells.iter().map(|line| (line.as_slice(), number(line))).collect();
        heading(&lines)
    }

    #[test]
    fn two_lines_are_one_header() {
        for (text, expected, at) in [
            ("bounce,height_cm\n0,100", "bounce|height_cm", (0, 1)),
            ("My drops,\nbounce,height_cm\n0,100", "bounce|height_cm", (1, 2)),
            ("time,height\ns,cm\n0,100", "time (s)|height (cm)", (0, 2)),
            ("bounce,height\n,cm\n0,100", "bounce|height (cm)", (0, 2)),
            ("time,height\n(s),[cm]\n0,100", "time (s)|height (cm)", (0, 2)),
            ("Drop (in),Rebound (in),\n,Trial 1,Trial 2\n72,40,41", "Drop (in)|Trial 1 (in)|Trial 2 (in)", (0, 2)),
            (
                "Title,,\n,Rebound (in),\nDrop (in),Trial 1,Trial 2\n72,40,41",
                "Drop (in)|Trial 1 (in)|Trial 2 (in)",
                (1, 3),
            ),
            (
                "Trial 1,,Trial 2,\nTime (s),y (m),Time (s),y (m)\n0,1,0,1",
                "Trial 1: Time (s)|Trial 1: y (m)|Trial 2: Time (s)|Trial 2: y (m)",
                (0, 2),
            ),
            // Neither merged nor of units: what it is, the reader of columns says.
            ("one,two\nbounce,height_cm\n0,100", "one|two", (0, 1)),
        ] {
            let (names, header, rows) = names(text);
            assert_eq!(names.join("|"), expected, "{text}");
            assert_eq!((header, rows), at, "{text}");
        }
    }
}
