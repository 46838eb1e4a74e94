//! Records in YAML: names and values a line each, what is within them further right, lists behind
//! dashes or in brackets.

use super::Node;

/// Values lie no deeper than these.
const DEEPEST: usize = 16;

/// A line: how far right it begins, and what it says.
struct Line {
    indent: usize,
    said: String,
}

/// The value of a text that holds a list of records of which one holds a list in brackets; `None`
/// of any other, and where a line is none of it.
pub(super) fn outlined(text: &str) -> Option<Node> {
    let listed = |line: &str| line.trim_end().ends_with(']') && line.contains(": [");
    let dashed = |line: &str| line.trim_start().strip_prefix("- ").is_some_and(|record| record.contains(':'));
    if !text.lines().any(listed) || !text.lines().any(dashed) {
        return None;
    }
    let mut remarks: Vec<(String, Node)> = Vec::new();
    let mut lines: Vec<Line> = Vec::new();
    for line in text.lines() {
        let at = if line.trim_start().starts_with('#') { Some(0) } else { line.find(" #") };
        let (said, remark) = line.split_at(at.unwrap_or(line.len()));
        let remark = remark.trim_matches([' ', '#']);
        if !remark.is_empty() {
            remarks.push(("remark".to_owned(), Node::Cell(super::plain(remark))));
        }
        if !said.trim().is_empty() && said.trim() != "---" {
            let indent = said.len() - said.trim_start().len();
            lines.push(Line { indent, said: said.trim().to_owned() });
        }
    }
    let mut at = 0;
    let whole = block(&mut lines, &mut at, 0)?;
    match whole {
        Node::Record(members) if at == lines.len() => Some(Node::Record(remarks.into_iter().chain(members).collect())),
        _ => None,
    }
}

/// The value whose lines begin as far right as the next one.
fn block(lines: &mut [Line], at: &mut usize, deep: usize) -> Option<Node> {
    let indent = lines.get(*at).filter(|_| deep < DEEPEST)?.indent;
    let begins = |lines: &[Line], at: usize| lines.get(at).is_some_and(|line| line.indent == indent);
    let item = |line: &Line| line.said.strip_prefix("- ").map(str::to_owned);
    if item(&lines[*at]).is_some() {
        let mut list = Vec::new();
        while begins(lines, *at) {
            let said = item(&lines[*at])?;
            if named(&said).is_some() {
                // What stands behind the dash begins a record.
                lines[*at] = Line { indent: indent + said_at(&lines[*at].said), said };
                list.push(block(lines, at, deep + 1)?);
            } else {
                *at += 1;
                list.push(value(&said)?);
            }
        }
        return Some(Node::List(list));
    }
    let mut members = Vec::new();
    while begins(lines, *at) {
        let (name, said) = named(&lines[*at].said).map(|(name, said)| (name.to_owned(), said.to_owned()))?;
        *at += 1;
        let next = lines.get(*at).map(|line| line.indent);
        // A list may begin as far right as its name.
        let dashed = lines.get(*at).is_some_and(|line| line.indent == indent && line.said.starts_with("- "));
        let node = match said.as_str() {
            ">" | "|" | ">-" | "|-" => {
                let mut text = Vec::new();
                while let Some(line) = lines.get(*at).filter(|line| line.indent > indent) {
                    text.push(line.said.clone());
                    *at += 1;
                }
                Node::Cell(super::plain(&text.join(" ")))
            }
            "" if next.is_some_and(|next| next > indent) || dashed => block(lines, at, deep + 1)?,
            said => value(said)?,
        };
        members.push((super::plain(&name), node));
    }
    // What stands further left is of what encloses it; further right nothing may begin.
    lines.get(*at).is_none_or(|line| line.indent < indent).then_some(Node::Record(members))
}

/// Where the record behind a dash begins.
fn said_at(line: &str) -> usize {
    line.len() - line[1..].trim_start().len()
}

/// A name and its value, `drop_mm: 350`.
fn named(line: &str) -> Option<(&str, &str)> {
    let (name, said) = line.split_once(": ").or_else(|| Some((line.strip_suffix(':')?, "")))?;
    let plain = !name.is_empty() && !name.contains(['[', ']', '{', '}', '"', ',']);
    plain.then(|| (name.trim(), said.trim()))
}

/// A list in brackets, or a cell; `None` where a bracket is not closed in its line.
fn value(said: &str) -> Option<Node> {
    let bare = |text: &str| super::plain(text.trim().trim_matches(['"', '\'']));
    match said.strip_prefix('[') {
        Some(list) => {
            let list = list.strip_suffix(']').filter(|list| !list.contains(['[', ']', '{']))?;
            let cells = list.split(',').filter(|cell| !cell.trim().is_empty());
            Some(Node::List(cells.map(|cell| Node::Cell(bare(cell))).collect()))
        }
        None if said.starts_with(['{', '&', '*']) => None,
        None => Some(Node::Cell(bare(said))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spelt(node: &Node) -> String {
        match node {
            Node::Cell(cell) => cell.clone(),
            Node::List(list) => format!("[{}]", list.iter().map(spelt).collect::<Vec<_>>().join(" ")),
            Node::Record(members) => {
                let all = members.iter().map(|(name, node)| format!("{name}={}", spelt(node)));
                format!("{{{}}}", all.collect::<Vec<_>>().join(" "))
            }
        }
    }

    #[test]
    fn names_and_dashes_are_records_and_lists() {
        let text = "# by Ann\nball: golf\nnotes: >\n  two\n  lines\nruns:\n  - id: 1\n    h: [1, 0.6]  # ok\n  - id: 2\n    h: [1, 0.5]\nend: x\n";
        let expected =
            "{remark=by Ann remark=ok ball=golf notes=two lines runs=[{id=1 h=[1 0.6]} {id=2 h=[1 0.5]}] end=x}";
        assert_eq!(outlined(text).map(|node| spelt(&node)).as_deref(), Some(expected));
        let text = "runs:\n- id: 1\n  h: [1, 0.6]\n- id: 2\n  of:\n    h: [1, 0.5]\n";
        let expected = "{runs=[{id=1 h=[1 0.6]} {id=2 of={h=[1 0.5]}}]}";
        assert_eq!(outlined(text).map(|node| spelt(&node)).as_deref(), Some(expected));
        for text in [
            "runs:\n  - id: 1\n",
            "h: [1, 0.6]\n",
            "runs:\n  - id: 1\n    h: [1, 0.6]\nwhat is this\n",
            "runs:\n  - id: 1\n    h: [1, 0.6]\n      x: 1\n",
            "a,b\n1,2\n",
        ] {
            assert!(outlined(text).is_none(), "{text}");
        }
    }
}
