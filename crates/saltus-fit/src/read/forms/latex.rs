//! Tables of LaTeX.

use super::super::limits::MANY;

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
        (ends && cells.contains('&')).then(|| cells.to_owned())
    };
    if text.lines().filter(|line| row(line).is_some()).count() < 2 {
        return None;
    }
    let mut columns = Vec::new();
    let mut plain = |line: &str| match row(line) {
        Some(cells) => parted(&cells, &columns),
        None if line.contains(r"\begin{") => {
            columns = joints(line);
            String::new()
        }
        None if line.trim_start().starts_with(r"\caption") => {
            line.split_once('{').map_or_else(String::new, |(_, said)| unmarked(said))
        }
        None if line.trim_start().starts_with('\\') => String::new(),
        None => line.to_owned(),
    };
    Some(text.lines().map(&mut plain).collect::<Vec<_>>().join("\n") + "\n")
}

/// What stands in brackets at the beginning of a text, and behind them.
fn bracketed(text: &str) -> Option<(&str, &str)> {
    let mut depth = 0_usize;
    let end = text.char_indices().find(|(_, c)| {
        depth = match c {
            '{' => depth + 1,
            '}' => depth.saturating_sub(1),
            _ => depth,
        };
        depth == 0
    })?;
    text.strip_prefix('{').map(|_| (&text[1..end.0], &text[end.0 + 1..]))
}

/// What joins each column of a table to the one before it, `±` of `r@{$\pm$}l`, where anything
/// does; in the line that begins it.
fn joints(line: &str) -> Vec<Option<String>> {
    let Some((_, mut rest)) = line.find(r"\begin{").and_then(|at| bracketed(&line[at + 6..])) else {
        return Vec::new();
    };
    // The width of a table stands before its columns.
    let mut given = Vec::new();
    while let Some((inside, after)) = bracketed(rest.trim_start()) {
        (rest, given) = (after, [given, vec![inside]].concat());
    }
    let (mut found, mut joint, mut rest) = (Vec::new(), None, given.last().copied().unwrap_or_default());
    while let Some(first) = rest.chars().next() {
        let after = &rest[first.len_utf8()..];
        let inner = bracketed(after);
        match first {
            '@' | '!' => joint = inner.map(|(inside, _)| unmarked(inside).trim().to_owned()),
            '>' | '<' | '|' | ' ' => {}
            _ => found.push(joint.take().filter(|joint| !joint.is_empty())),
        }
        rest = inner.map_or(after, |(_, rest)| rest);
    }
    found
}

/// A row with tabs between its cells: those that something joins are one, and what spans several
/// columns stands in the first.
fn parted(row: &str, joints: &[Option<String>]) -> String {
    let (mut found, mut column): (Vec<String>, usize) = (Vec::new(), 0);
    for cell in row.split('&') {
        let spans = || {
            let (count, rest) = bracketed(cell.trim_start().strip_prefix(r"\multicolumn")?)?;
            let (_, rest) = bracketed(rest.trim_start())?;
            Some((
                count.trim().parse().ok().filter(|count| (1..=MANY).contains(count))?,
                bracketed(rest.trim_start())?.0,
            ))
        };
        let (count, text) = spans().unwrap_or((1, cell));
        let joint = |column: usize| joints.get(column).and_then(Option::as_ref);
        match (joint(column), found.last_mut()) {
            (Some(joint), Some(last)) => {
                let blank = if joint.contains(['.', ',']) { "" } else { " " };
                *last = format!("{}{blank}{joint}{blank}{}", last.trim_end(), unmarked(text).trim_start());
            }
            _ => found.push(unmarked(text)),
        }
        // No other cell stands below the rest of what it spans.
        let rest = (column + 1..column + count).filter(|column| joint(*column).is_none()).count();
        found.extend(std::iter::repeat_n(String::new(), rest));
        column += count;
    }
    found.join("\t")
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
    let spelt = spelt.replace(r"\sqrt", "√");
    let mut parts = spelt.split('\\');
    let mut found = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(part.len());
        let sets = part[end..].starts_with('{') && &part[..end] != "frac";
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
