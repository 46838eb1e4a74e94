//! Tables of LaTeX.

/// A table of LaTeX, whose rows end in `\\` and whose cells are parted by `&`, with tabs in their
/// place; `None` if it is none. A line stays a line.
pub(super) fn table(text: &str) -> Option<String> {
    // A remark goes from its sign to the end of the line.
    let said = |line: &str| {
        let sign = line.match_indices('%').map(|(at, _)| at).find(|&at| !line[..at].ends_with('\\'));
        line[..sign.unwrap_or(line.len())].to_owned()
    };
    let row = |line: &str| {
        let line = kept(&said(line));
        let (cells, after) = line.rsplit_once(r"\\")?;
        let ends = after.trim().is_empty() || after.trim_start().starts_with('\\');
        (ends && cells.contains('&')).then(|| cells.replace('&', "\t"))
    };
    if text.lines().filter(|line| row(line).is_some()).count() < 2 {
        return None;
    }
    let plain = |line: &str| match row(line) {
        Some(cells) => unmarked(&cells),
        None if line.trim_start().starts_with(r"\caption") => {
            line.split_once('{').map_or_else(String::new, |(_, said)| unmarked(said))
        }
        None if line.trim_start().starts_with('\\') => String::new(),
        None => line.to_owned(),
    };
    Some(text.lines().map(plain).collect::<Vec<_>>().join("\n") + "\n")
}

/// A line of LaTeX without what is struck out in it, which was withdrawn by who wrote it.
fn kept(line: &str) -> String {
    let mut found = line.to_owned();
    while let Some((at, from)) = STRUCK.iter().find_map(|c| found.find(c).map(|at| (at, at + c.len()))) {
        let end = found[from..].find('}').map_or(found.len(), |end| from + end + 1);
        found.replace_range(at..end, "");
    }
    found
}

/// Commands of LaTeX that strike out what follows.
const STRUCK: [&str; 6] = [r"\sout{", r"\xout{", r"\st{", r"\cancel{", r"\bcancel{", r"\xcancel{"];

/// A row of LaTeX without what sets it: `{$h_0$ / \si{\centi\metre}}` is `h_0 / centimetre`. What
/// brackets follow sets what is in these, other commands are words, parts of units among them.
fn unmarked(row: &str) -> String {
    let spelt = row.replace(r"\pm", "±").replace(r"\%", "%").replace(r"\,", " ").replace(r"\per", "/");
    let mut parts = spelt.split('\\');
    let mut found = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(part.len());
        let sets = part[end..].starts_with('{') && !matches!(&part[..end], "frac" | "sqrt");
        found.push_str(&part[if sets { end } else { 0 }..]);
    }
    found.replace("}{", " ").replace(['$', '{', '}'], "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn captions_of_latex_are_remarks() {
        let text = "\\caption{Dropped from \\SI{80}{cm}}\nBall & $h_1$ \\\\\nA & 51 \\\\\nB & 41 \\\\\n";
        assert_eq!(table(text).as_deref(), Some("Dropped from 80 cm\nBall \t h_1 \nA \t 51 \nB \t 41 \n"));
    }
}
