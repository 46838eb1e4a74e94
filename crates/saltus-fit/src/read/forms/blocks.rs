//! Lists below titles, one for each ball or trial: `Ball A`, `Drop height,100 cm`, `Bounce 1,64
//! cm`, and the same again for `Ball B`.

use super::super::cell::{self, Cell};
use super::super::heading::Heading;

/// A title and the names and values below it.
struct Block<'a> {
    line: usize,
    title: &'a str,
    names: Vec<String>,
    values: Vec<&'a str>,
}

/// What parts a name from its value.
const MARKS: [char; 5] = ['\t', ';', ',', ':', '='];

/// The text as a table with a row for each of the lists, and tabs between its cells; `None` if it
/// holds no two lists of the same names. A line stays a line.
pub(super) fn table(text: &str) -> Option<String> {
    let (first, blocks) = MARKS.iter().find_map(|mark| parted(text, *mark))?;
    let of_trials = Heading::parse(blocks[0].title).value().is_some_and(|value| !value.trial.is_empty());
    let header = format!("{}\t{}", if of_trials { "trial" } else { "ball" }, blocks[0].names.join("\t"));
    let spelt = |(n, line): (usize, &str)| match blocks.iter().position(|block| block.line == n) {
        Some(at) => {
            let row = format!("{}\t{}", blocks[at].title, blocks[at].values.join("\t"));
            // A lone carriage return ends a row, and no line.
            if at == 0 { format!("{header}\r{row}") } else { row }
        }
        None if n < first => line.replace('\t', " "),
        None => String::new(),
    };
    Some(text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// The lists of a text whose names a mark parts from their values, and the line that they begin at;
/// `None` unless they are all below the first title, and of the same names.
fn parted(text: &str, mark: char) -> Option<(usize, Vec<Block<'_>>)> {
    let mut blocks: Vec<Block<'_>> = Vec::new();
    for (n, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let bare = line.trim().trim_end_matches([mark, ' ']);
        match bare.split_once(mark) {
            None if bare.is_empty() => {}
            None => {
                blocks.push(Block {
                    line: n,
                    title: bare.trim_end_matches(':'),
                    names: Vec::new(),
                    values: Vec::new(),
                });
            }
            Some((name, value)) => {
                let last = blocks.last_mut()?;
                let one = !value.trim().is_empty() && (mark == ':' || !value.contains(mark));
                let named = name.contains(char::is_alphabetic) && value.contains(|c: char| c.is_ascii_digit());
                if !one || !named {
                    return None;
                }
                last.names.push(name.trim().trim_end_matches([':', '=']).trim_end().to_owned());
                last.values.push(value.trim());
            }
        }
    }
    // Lines before the first list are its title, and those of the table.
    let from = blocks.iter().position(|block| !block.names.is_empty())?;
    let blocks = blocks.split_off(from);
    let alike = blocks.iter().all(|block| block.names.len() > 1 && block.names == blocks[0].names);
    (blocks.len() > 1 && alike).then(|| (blocks[0].line, blocks))
}

/// Lines in which dots lead from one cell to the next, `1 m ..... 0.64 m`, with a tab in their
/// place; `None` unless most are such lines. A line stays a line.
pub(super) fn led(text: &str) -> Option<String> {
    let cells = |line: &str| -> Vec<String> {
        let dots = line.replace('…', "...");
        let cells = dots.split("...").map(|cell| cell.trim_start_matches('.').trim().to_owned());
        cells.filter(|cell| !cell.is_empty()).collect()
    };
    let leads = |line: &&str| cells(line).len() > 1;
    let filled = || text.lines().filter(|line| !line.trim().is_empty());
    let found = filled().filter(leads).count();
    if found < 2 || 2 * found < filled().count() || text.contains(['\t', '|', ';']) {
        return None;
    }
    Some(text.lines().map(|line| cells(line).join("\t")).collect::<Vec<_>>().join("\n") + "\n")
}

/// Numbers behind dashes below a name, `bounces:`, `- 64`, `- 41`, as a list behind it; `None` if
/// there are none. A line stays a line.
pub(in crate::read) fn bulleted(text: &str) -> Option<String> {
    let item = |line: &str| {
        let value = line.trim().strip_prefix("- ")?.trim().to_owned();
        matches!(cell::read(&value, false), Cell::Number(_)).then_some(value)
    };
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut found = false;
    for n in 0..lines.len() {
        let items: Vec<String> = lines[n + 1..].iter().map_while(|line| item(line)).collect();
        // Behind the name a remark may stand.
        let name = lines[n].split(" #").next().unwrap_or_default().trim_end();
        if items.len() > 1 && name.ends_with(':') && item(name).is_none() {
            found = true;
            lines[n] = format!("{name} {}", items.join(", "));
            lines[n + 1..=n + items.len()].iter_mut().for_each(String::clear);
        }
    }
    found.then(|| lines.join("\n") + "\n")
}

/// Records one below the other, each of the same names, `drop: 100 cm`, `rebound: 64 cm`, as a
/// table with a row for each; `None` if there are no two. Lines before the first stay what they
/// are, lines that stand further left than the records are remarks, and a line stays a line.
pub(super) fn records(text: &str) -> Option<String> {
    let pair = |line: &'_ str| -> Option<(String, String)> {
        let said = line.split(" #").next().unwrap_or_default();
        let bare = said.trim().trim_start_matches("- ").trim_end_matches(',');
        let (name, value) = bare.split_once([':', '='])?;
        let (name, value) = (name.trim(), value.trim());
        let one = !name.is_empty() && !value.is_empty() && !value.contains([',', ';', '[', '(', '\t']);
        (one && !name.contains([',', ';', '\t', '|'])).then(|| (name.to_owned(), value.to_owned()))
    };
    let lines: Vec<&str> = text.lines().collect();
    let pairs: Vec<Option<(String, String)>> = lines.iter().map(|line| pair(line)).collect();
    let named = |n: usize| pairs[n].as_ref().map(|(name, _)| name);
    // The first name that comes again begins each record.
    let again = |n: &usize| named(*n).is_some() && (n + 1..lines.len()).any(|m| named(m) == named(*n));
    let first = (0..lines.len()).find(again)?;
    let indent = |n: usize| lines[n].len() - lines[n].trim_start().len();
    let dash = |n: usize| lines[n].trim_start().starts_with("- ");
    let within = |n: &usize| {
        let beside = indent(*n) == indent(first) && dash(*n) == dash(first);
        lines[*n].trim().is_empty() || indent(*n) > indent(first) || beside
    };
    let last = (first..lines.len()).take_while(within).last()? + 1;
    let starts: Vec<usize> = (first..last).filter(|&n| named(n) == named(first)).collect();
    let cells = |at: usize| -> Option<Vec<&(String, String)>> {
        let end = starts.get(at + 1).copied().unwrap_or(last);
        (starts[at]..end).filter(|&n| !lines[n].trim().is_empty()).map(|n| pairs[n].as_ref()).collect()
    };
    let all: Vec<Vec<&(String, String)>> = (0..starts.len()).map(cells).collect::<Option<_>>()?;
    let names = |record: &[&(String, String)]| record.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    let read = |(_, value): &&(String, String)| value.starts_with(|c: char| c.is_ascii_digit());
    let alike = |record: &Vec<&(String, String)>| names(record) == names(&all[0]) && record.iter().any(read);
    if all[0].len() < 2 || !all.iter().all(alike) {
        return None;
    }
    let spelt = |n: usize| match starts.iter().position(|start| *start == n) {
        Some(at) => {
            let row = all[at].iter().map(|(_, value)| value.as_str()).collect::<Vec<_>>().join("\t");
            // A lone carriage return ends a row, and no line.
            if at == 0 { format!("{}\r{row}", names(&all[0]).join("\t")) } else { row }
        }
        None if n < first => lines[n].replace('\t', " "),
        // A number without a unit states nothing.
        None if n >= last && matches!(&pairs[n], Some((_, value)) if value.parse::<f64>().is_ok()) => {
            format!("#{}", lines[n].replace([':', '='], " "))
        }
        None if n >= last && !lines[n].trim().is_empty() => format!("#{}", lines[n]),
        None => String::new(),
    };
    Some((0..lines.len()).map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

#[cfg(test)]
mod tests {
    use super::{bulleted, records, table};

    #[test]
    fn numbers_behind_dashes_are_a_list() {
        let text = "release: 100\nbounces:\n  - 64\n  - 41 cm\n";
        assert_eq!(bulleted(text).as_deref(), Some("release: 100\nbounces: 64, 41 cm\n\n\n"));
        for text in ["bounces:\n- 64\n", "- 64\n- 41\n", "bounces\n- 64\n- 41\n", "balls:\n- golf\n- tennis\n"] {
            assert_eq!(bulleted(text), None, "{text}");
        }
    }

    #[test]
    fn records_of_the_same_names_are_rows() {
        let text = "unit: cm\n- drop: 60\n  rebound: 37\n- drop: 90\n  rebound: 56\n";
        assert_eq!(records(text).as_deref(), Some("unit: cm\ndrop\trebound\r60\t37\n\n90\t56\n\n"));
        let text = "runs:\n  - drop_cm: 60  # by eye\n    rebound_cm: 37\n  - drop_cm: 90\n    rebound_cm: 56\nroom: 4\nby: Ann\n";
        let expected = "runs:\ndrop_cm\trebound_cm\r60\t37\n\n90\t56\n\n#room  4\n#by: Ann\n";
        assert_eq!(records(text).as_deref(), Some(expected));
        for text in ["drop: 60\nrebound: 37\n", "h: 60\nh: 37\n", "drop: 60\nrebound: 37\ndrop: 90\nball: golf\n"] {
            assert_eq!(records(text), None, "{text}");
        }
    }

    #[test]
    fn lists_below_titles_are_rows() {
        for mark in [",", ": ", ";", "\t"] {
            let text =
                "Lab 4\nBall A\nDrop,1 m\nBounce 1,64 cm\n\nBall B\nDrop,1 m\nBounce 1,49 cm\n".replace(',', mark);
            let expected = "Lab 4\nball\tDrop\tBounce 1\rBall A\t1 m\t64 cm\n\n\n\nBall B\t1 m\t49 cm\n\n\n";
            assert_eq!(table(&text).as_deref(), Some(expected), "{text}");
        }
        for text in [
            "Ball A\nDrop,1 m\nBounce 1,64 cm\n",
            "Ball A\nDrop,1 m\nBounce 1,64 cm\nBall B\nDrop,1 m\n",
            "bounce,height_cm\n0,100\n1,64\n",
            "Ball\nDrop (cm),Rebound (cm)\n100,64\n80,51\n",
        ] {
            assert_eq!(table(text), None, "{text}");
        }
    }
}
