//! Records in JSON, and in XML, as tables: a list of objects is a row each, a list a member is a
//! column each.

mod outlined;
mod tagged;
mod united;

use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use super::answers::answers;
use super::aside::Why;
use super::cell::{self, Cell};
use super::heading::{Heading, Meaning};
use super::judged;
use super::limits::{self, CELLS, MANY};
use super::sheet::{Content, Part, joined};
use super::units::{Dimension, Unit};
use super::vocabulary::Atom;

/// A value, its members in the order in which they stand.
enum Node {
    /// A number, a text or a truth value as a cell; nothing for null.
    Cell(String),
    List(Vec<Self>),
    Record(Vec<(String, Self)>),
}

impl Node {
    fn cell(&self) -> Option<&str> {
        match self {
            Self::Cell(cell) => Some(cell),
            _ => None,
        }
    }

    /// The records of a list that holds nothing else.
    fn records(&self) -> Option<Vec<&[(String, Self)]>> {
        let Self::List(list) = self else { return None };
        let record = |node: &Self| node.members().iter().all(|(_, cell)| cell.cell().is_some());
        let found = list.iter().map(|node| Some(node.members()).filter(|m| !m.is_empty() && record(node)));
        found.collect::<Option<Vec<_>>>().filter(|records| !records.is_empty())
    }

    fn members(&self) -> &[(String, Self)] {
        match self {
            Self::Record(members) => members,
            _ => &[],
        }
    }

    /// The cells of a list that holds nothing else.
    fn cells(&self) -> Option<Vec<&str>> {
        let Self::List(list) = self else { return None };
        list.iter().map(Self::cell).collect()
    }
}

/// What is called by numbers, `{"0": {"height_m": 1}, "1": {"height_m": 0.64}}`, as rows that bear
/// them; `name` is that of the whole.
fn numbered(name: &str, node: Node) -> Node {
    let Node::Record(members) = node else { return node };
    let numbers = members.len() > 1 && members.iter().all(|(name, _)| name.parse::<u32>().is_ok());
    let cells =
        |node: &Node| !node.members().is_empty() && node.members().iter().all(|(_, cell)| cell.cell().is_some());
    let flat = |node: &Node| node.cell().is_some() || cells(node);
    let counted = matches!(Heading::parse(name).meaning, Meaning::Number { .. } | Meaning::Trial);
    if !numbers || !members.iter().all(|(_, node)| flat(node)) {
        return Node::Record(members);
    }
    let row = |(number, node): (String, Node)| {
        let count = if counted && node.cell().is_none() { name } else { "n" };
        let mut row = vec![(count.to_owned(), Node::Cell(number))];
        match node {
            Node::Record(members) => row.extend(members),
            cell => row.push((name.to_owned(), cell)),
        }
        Node::Record(row)
    };
    Node::List(members.into_iter().map(row).collect())
}

impl<'de> Deserialize<'de> for Node {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

/// Makes nodes of what is read.
struct Reader;

/// What no cell can hold.
fn plain(text: &str) -> String {
    text.chars().take(MANY).map(|c| if c.is_control() || c == '"' { ' ' } else { c }).collect()
}

impl<'de> Visitor<'de> for Reader {
    type Value = Node;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Node, E> {
        Ok(Node::Cell(value.to_string()))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Node, E> {
        Ok(Node::Cell(value.to_string()))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Node, E> {
        Ok(Node::Cell(value.to_string()))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Node, E> {
        Ok(Node::Cell(value.to_string()))
    }

    fn visit_str<E>(self, value: &str) -> Result<Node, E> {
        Ok(Node::Cell(plain(value)))
    }

    fn visit_unit<E>(self) -> Result<Node, E> {
        Ok(Node::Cell(String::new()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Node, A::Error> {
        let mut found = Vec::new();
        while let Some(node) = list.next_element()? {
            found.push(node);
        }
        Ok(Node::List(found))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Node, A::Error> {
        let mut found = Vec::new();
        while let Some((name, node)) = map.next_entry::<String, Node>()? {
            let name = plain(&name);
            let node = numbered(&name, node);
            found.push((name, node));
        }
        Ok(Node::Record(found))
    }
}

/// The tables of a text in JSON, of records a line each, in XML or in YAML; `None` if it holds
/// none, or is so long that its values, of some eight times its length, would take more than a file
/// may hold.
pub(super) fn parts(bytes: &[u8]) -> Option<Vec<Part>> {
    let text = std::str::from_utf8(bytes).ok()?.trim_start_matches('\u{feff}').trim_start();
    if 8 * text.len() > limits::bytes() {
        return None;
    }
    let whole = match text.chars().next()? {
        '<' => tagged::tagged(text)?,
        '{' | '[' => valued(text)?,
        _ => outlined::outlined(text)?,
    };
    let whole = united::united(whole);
    let mut found = Vec::new();
    tables("", &whole, "", &mut found);
    (!found.is_empty()).then_some(found)
}

/// The value of a text in JSON, or those of its lines.
fn valued(text: &str) -> Option<Node> {
    let values = serde_json::Deserializer::from_str(text).into_iter::<Node>();
    let values: Result<Vec<Node>, _> = values.collect();
    let mut values = values.ok().or_else(|| printed(text))?;
    Some(numbered("", if values.len() == 1 { values.pop()? } else { Node::List(values) }))
}

/// Values as Python prints them, in single quotes.
fn printed(text: &str) -> Option<Vec<Node>> {
    let words = [("'", "\""), (": None", ": null"), (": True", ": true"), (": False", ": false")];
    let spelt = words.iter().fold(text.to_owned(), |spelt, (word, plain)| spelt.replace(word, plain));
    let values = serde_json::Deserializer::from_str(&spelt).into_iter::<Node>();
    values.collect::<Result<_, _>>().ok().filter(|_| !text.contains('"'))
}

/// Gathers the tables in a value called `name`; `above` are lines that what encloses it states.
/// Those of a value that says that it does not count are set aside.
fn tables(name: &str, node: &Node, above: &str, found: &mut Vec<Part>) {
    if found.len() >= MANY {
        return;
    }
    let withdrawn = |(name, node): &(String, Node)| node.cell().is_some_and(|cell| judged::withdraws(name, cell));
    let aside = node.members().iter().any(withdrawn).then_some(Why::Void);
    let from = found.len();
    gathered(name, node, above, found);
    found[from..].iter_mut().for_each(|part| part.aside = part.aside.or(aside));
}

fn gathered(name: &str, node: &Node, above: &str, found: &mut Vec<Part>) {
    let mut push = |rows: Option<String>| {
        let Some(rows) = rows else { return };
        let name = if name.is_empty() { format!("table {}", found.len() + 1) } else { name.to_owned() };
        found.push(Part::new(name, None, Content::Cells(format!("{above}{rows}"))));
    };
    if let Some(records) = node.records() {
        return push(rows(&records));
    }
    if let Some(cells) = named_rows(node) {
        return push(Some(cells));
    }
    let columns = numbered_columns(node);
    if columns.len() > 1 {
        return push(side_by_side(&columns));
    }
    let repeats: Vec<(String, Vec<&str>)> = node.members().iter().flat_map(repeated).collect();
    let columns = node.members().iter().filter_map(|(name, list)| Some((name.as_str(), list.cells()?)));
    let columns = columns.chain(repeats.iter().map(|(name, cells)| (name.as_str(), cells.clone())));
    let columns: Vec<(&str, Vec<&str>)> = columns.filter(|(_, cells)| !cells.is_empty()).collect();
    let stated = node.members().iter().filter_map(|(name, node)| Some((name, node.cell()?)));
    let stated: String = stated.map(|(name, cell)| format!("{name}: {cell}\n")).collect();
    let stated = if above.len() + stated.len() > MANY { String::new() } else { stated };
    if !columns.is_empty() {
        push(side_by_side(&columns).map(|rows| format!("{stated}{rows}")));
    }
    let inner = || node.members().iter().filter(|(_, node)| node.cells().is_none() && node.cell().is_none());
    // The only table within a value is called as that is.
    let only = !name.is_empty() && columns.is_empty() && inner().count() == 1;
    // Names of what is made alike tell what they hold apart: `"golf": {"drops": [...]}`.
    let names = |node: &Node| node.members().iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    let shape = inner().next().map(|(_, node)| names(node)).filter(|names| !names.is_empty());
    let alike = inner().count() > 1 && inner().all(|(_, node)| Some(names(node)) == shape);
    for (own, member) in inner() {
        let (of_both, from) = (matches!(member, Node::List(list) if nested(own, list).is_some()), found.len());
        tables(if only && !of_both { name } else { own }, member, &format!("{above}{stated}"), found);
        enclosed(&mut found[from..], own, alike);
    }
    // Lists of the same names are trials, or are called by their first words.
    let Node::List(list) = node else { return };
    if let Some(rows) = nested(name, list) {
        let name = if name.is_empty() { format!("table {}", found.len() + 1) } else { name.to_owned() };
        found.push(Part::new(name, None, Content::Cells(format!("{above}{rows}"))));
        return;
    }
    for (n, member) in list.iter().enumerate() {
        // A length, or a time, is no name.
        let measured = |cell: &str| {
            let unit = |unit: Unit| unit.dimension != Dimension::Other;
            matches!(cell::read(cell, false), Cell::Number(m) if m.unit.is_some_and(unit))
        };
        let words = |cell: &&str| cell.contains(char::is_alphabetic) && !measured(cell) && !answers(cell);
        let cells = || member.members().iter().filter_map(|(name, node)| Some((name, node.cell()?)));
        // A letter below the name of a trial is of that: `"run": "A"`.
        let letter = |(name, cell): &(&String, &str)| {
            cell.chars().count() == 1 && matches!(Heading::parse(name).meaning, Meaning::Trial)
        };
        let remark = |name: &str| Heading::parse(name).has(Atom::Note);
        let called = cells().find(|(name, cell)| words(cell) && !remark(name)).map(|named| match named {
            (name, cell) if letter(&named) => format!("{name} {cell}"),
            (_, cell) => cell.to_owned(),
        });
        // Or a condition is, `"ball_temp_C": 23`, where no words are.
        let condition = |(name, _): &(&String, &str)| matches!(Heading::parse(name).meaning, Meaning::Setting);
        let called = called.or_else(|| cells().find(condition).map(|(name, cell)| format!("{name} {cell}")));
        let from = found.len();
        tables(called.as_deref().unwrap_or(&format!("trial {}", n + 1)), member, above, found);
        called.iter().for_each(|name| enclosed(&mut found[from..], name, true));
    }
}

/// Tables that are called otherwise than what holds them are within it, the drops of a ball, unless
/// that is `apart` from nothing, or counts trials.
fn enclosed(parts: &mut [Part], name: &str, apart: bool) {
    let heading = Heading::parse(name);
    if apart && !(heading.labels().is_empty() && heading.has(Atom::Trial)) {
        for part in parts.iter_mut().filter(|part| part.name != name) {
            part.within = joined(name, &part.within);
        }
    }
}

/// Lists of numbers within a list that has a name, as columns of that name, each of a trial.
fn repeated((name, node): &(String, Node)) -> Vec<(String, Vec<&str>)> {
    let Node::List(list) = node else { return Vec::new() };
    let rows: Option<Vec<Vec<&str>>> = list.iter().map(Node::cells).collect();
    let numbers = |rows: &Vec<Vec<&str>>| rows.iter().flatten().all(|cell| cell.parse::<f64>().is_ok());
    let named = |(n, cells)| (format!("trial {} {name}", n + 1), cells);
    rows.filter(numbers).unwrap_or_default().into_iter().enumerate().take(MANY).map(named).collect()
}

/// Names with their cells.
type Cells = Vec<(String, String)>;

/// A record that holds a list: its own cells, the name of the list, and the cells of its records.
type Holder = (Cells, String, Vec<Cells>);

/// Records called `name` that hold cells and one list of records each, of which a member is called
/// as one of theirs: `<drop height="1 m"><bounce height="0.64 m"/></drop>`. A row for each record
/// of the lists, whose columns of both are called by both names; the records are trials. `None`
/// where no name is in both, for then each says what it is by itself.
fn nested(name: &str, list: &[Node]) -> Option<String> {
    let one = |node: &'_ Node| -> Option<Holder> {
        let own = node.members().iter().filter_map(|(name, node)| Some((name.clone(), node.cell()?.to_owned())));
        let mut inner = node.members().iter().filter(|(_, node)| node.cell().is_none());
        let (of, records) = inner.next().filter(|_| inner.next().is_none())?;
        let cells = |record: &[(String, Node)]| {
            record.iter().map(|(name, node)| Some((name.clone(), node.cell()?.to_owned()))).collect::<Option<Vec<_>>>()
        };
        let rows = records.records()?.into_iter().map(cells).collect::<Option<Vec<_>>>()?;
        Some((own.collect(), of.clone(), rows))
    };
    let all: Vec<_> = list.iter().map(one).collect::<Option<_>>()?;
    let (first, of, rows) = all.first()?;
    let names = |cells: &[(String, String)]| cells.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    let (outer, inner) = (names(first), names(rows.first()?));
    let same = |(own, by, rows): &Holder| names(own) == outer && by == of && rows.iter().all(|row| names(row) == inner);
    if all.len() < 2 || name.is_empty() || !all.iter().all(same) || !outer.iter().any(|name| inner.contains(name)) {
        return None;
    }
    // What counts them counts trials, and bounces in these.
    let counts = |name: &&String| matches!(Heading::parse(name).meaning, Meaning::Number { .. } | Meaning::Trial);
    let both = |of: &str, own: &String| {
        if inner.contains(own) && outer.contains(own) { format!("{of} {own}") } else { own.clone() }
    };
    let columns = outer.iter().map(|own| if counts(&own) { "-".to_owned() } else { both(name, own) });
    let within = inner.iter().map(|own| if counts(&own) { "bounce".to_owned() } else { both(of, own) });
    let names: Vec<String> = std::iter::once("trial".to_owned()).chain(columns).chain(within).collect();
    let names: Vec<&str> = names.iter().map(|name| if name == "-" { "" } else { name.as_str() }).collect();
    let mut text = begun(&names, all.iter().map(|(_, _, rows)| rows.len()).sum())?;
    for (n, (own, _, rows)) in all.iter().enumerate() {
        for row in rows {
            let cells = own.iter().map(|(name, cell)| if counts(&name) { "" } else { cell.as_str() });
            let cells = cells.chain(row.iter().map(|(_, cell)| cell.as_str()));
            text.push_str(&format!("{}\t{}\n", n + 1, cells.collect::<Vec<_>>().join("\t")));
        }
    }
    Some(text)
}

/// Members that all hold cells called by the same numbers, `{"drop_m": {"0": 1, "1": 2},
/// "rebound_m": {"0": 0.64, "1": 1.28}}`, as columns; none where one holds something else.
fn numbered_columns(node: &Node) -> Vec<(&str, Vec<&str>)> {
    let column = |(name, node): &'_ (String, Node)| -> Option<Vec<(String, String)>> {
        let pair = |row: &[(String, Node)]| match row {
            [(_, number), (own, cell)] if own == name => Some((number.cell()?.to_owned(), cell.cell()?.to_owned())),
            _ => None,
        };
        node.records()?.into_iter().map(pair).collect()
    };
    let found: Option<Vec<_>> = node.members().iter().map(column).collect();
    let numbers = |cells: &[(String, String)]| cells.iter().map(|(number, _)| number.clone()).collect::<Vec<_>>();
    let alike = found.is_some_and(|all| all.iter().all(|cells| numbers(cells) == numbers(&all[0])));
    let columns = node.members().iter().filter(|_| alike).map(|(name, node)| {
        let rows = node.records().into_iter().flatten();
        (name.as_str(), rows.filter_map(|row| row.get(1)?.1.cell()).collect())
    });
    columns.collect()
}

/// Lists of as many cells each as rows, below the names that a list beside them has, or the first
/// of them: `{"columns": ["t_s", "y_m"], "data": [[0, 1], [0.1, 0.95]]}`.
fn named_rows(node: &Node) -> Option<String> {
    let of = |node: &Node| -> Option<Vec<Vec<String>>> {
        let Node::List(list) = node else { return None };
        let owned = |row: Vec<&str>| row.into_iter().map(str::to_owned).collect::<Vec<_>>();
        let rows: Vec<Vec<String>> = list.iter().map(|row| row.cells().map(owned)).collect::<Option<_>>()?;
        let width = rows.first()?.len();
        (rows.len() > 1 && (2..MANY).contains(&width) && rows.iter().all(|row| row.len() == width)).then_some(rows)
    };
    let words = |row: &[String]| row.iter().all(|cell| cell.contains(char::is_alphabetic));
    let owned = |node: &Node| node.cells().map(|row| row.into_iter().map(str::to_owned).collect::<Vec<_>>());
    let rows = node.members().iter().find_map(|(_, node)| of(node)).or_else(|| of(node))?;
    let beside = node.members().iter().filter_map(|(_, node)| owned(node));
    let mut names = beside.filter(|names| names.len() == rows[0].len() && words(names));
    let lines = names.next().filter(|_| !words(&rows[0])).into_iter().chain(rows);
    let mut lines = lines.peekable();
    lines.peek().filter(|first| words(first))?;
    Some(lines.map(|row| row.join("\t") + "\n").collect())
}

/// Records as rows below all of their names; `None` where these are too many.
fn rows(records: &[&[(String, Node)]]) -> Option<String> {
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in records.iter().flat_map(|record| record.iter()) {
        if names.len() <= MANY && !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let mut text = begun(&names, records.len())?;
    for record in records {
        let own = |n: usize, name: &str| {
            let same = |(own, _): &&(String, Node)| own == name;
            record.get(n).filter(same).or_else(|| record.iter().find(same)).and_then(|(_, node)| node.cell())
        };
        let cells = names.iter().enumerate().map(|(n, name)| own(n, name).unwrap_or_default());
        text.push_str(&cells.collect::<Vec<_>>().join("\t"));
        text.push('\n');
    }
    Some(text)
}

/// The line of names, where rows are worth writing: a table of no more cells than are read.
fn begun(names: &[&str], rows: usize) -> Option<String> {
    let fits = names.len() <= MANY && rows.saturating_mul(names.len()) <= CELLS;
    fits.then(|| names.join("\t") + "\n")
}

/// Lists as columns below their names; `None` where they are too many.
fn side_by_side(columns: &[(&str, Vec<&str>)]) -> Option<String> {
    let longest = columns.iter().map(|(_, cells)| cells.len()).max().unwrap_or(0);
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let mut text = begun(&names, longest)?;
    for row in 0..longest {
        let cells = columns.iter().map(|(_, cells)| cells.get(row).copied().unwrap_or_default());
        text.push_str(&cells.collect::<Vec<_>>().join("\t"));
        text.push('\n');
    }
    Some(text)
}
