//! Tables as a wiki writes them.

/// A table of `DokuWiki`, whose names stand behind `^`, with `|` in place of it; `None` if it is
/// none.
pub(super) fn marked(text: &str) -> Option<String> {
    let of_names = |line: &str| line.starts_with('^') && line.trim_end().ends_with(['^', '|']);
    if !text.lines().any(of_names) {
        return None;
    }
    let row = |line: &str| of_names(line) || line.starts_with('|');
    let spelt = |line: &str| if row(line) { line.replace('^', "|") } else { line.replace("==", "  ") };
    Some(text.lines().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// A table of `MediaWiki`: rows parted by `|-`, cells behind `!` and `|`; `None` if it is none.
pub(super) fn table(text: &str) -> Option<String> {
    let begins = |mark: &str| text.lines().any(|line| line.trim_start().starts_with(mark));
    if !begins("{|") || !begins("|-") {
        return None;
    }
    let mut lines: Vec<String> = Vec::new();
    // The line that the cells of the row stand in, and whether a table is open.
    let (mut row, mut open): (Option<usize>, bool) = (None, false);
    for (n, line) in text.lines().enumerate() {
        let bare = line.trim();
        lines.push(String::new());
        match bare {
            _ if bare.starts_with("{|") => (row, open) = (None, true),
            _ if !open => lines[n].push_str(line),
            _ if bare.starts_with("|}") => (row, open) = (None, false),
            _ if bare.starts_with("|-") => row = None,
            _ if bare.starts_with("|+") => lines[n].push_str(contents(&bare[2..])),
            _ => {
                let Some(cells) = bare.strip_prefix(['|', '!']) else { continue };
                for cell in cells.split("||").flat_map(|cells| cells.split("!!")) {
                    let at = *row.get_or_insert(n);
                    if !lines[at].is_empty() {
                        lines[at].push('\t');
                    }
                    lines[at].push_str(contents(cell));
                }
            }
        }
    }
    Some(lines.join("\n") + "\n")
}

/// What a cell of it holds, without the attributes before it and without quotes of
/// bold letters.
fn contents(cell: &str) -> &str {
    let cell = cell.rsplit_once('|').filter(|(before, _)| before.contains('=')).map_or(cell, |(_, cell)| cell);
    cell.trim().trim_matches('\'').trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_of_a_wiki_have_rows() {
        let text = "{| class=\"wikitable\"\n|+ Bounces\n! Bounce !! Height (cm)\n|-\n| 0 || 100\n|-\n| 1\n| align=\"right\" | '''64'''\n|}\n";
        assert_eq!(table(text).as_deref(), Some("\nBounces\nBounce\tHeight (cm)\n\n0\t100\n\n1\t64\n\n\n"));
    }
}
