//! Units that records state beside their numbers: `{"unit": "cm", "heights": [100, 64]}`,
//! `{"height": {"value": 64, "unit": "cm"}}`.

use super::super::cell::{self, Cell};
use super::super::heading::{At, Heading, Meaning, What};
use super::super::phrases::Phrase;
use super::super::units::{Dimension, Unit, names_unit};
use super::super::vocabulary::{Atom, folded};
use super::super::words::{Word, split};
use super::Node;

/// A unit that a record states, as it is written, and the name it is stated by: `height_unit`.
#[derive(Clone)]
struct Stated {
    of: String,
    unit: String,
    dimension: Dimension,
}

/// The value with all units written where the numbers are: behind the names of lists, and behind
/// the numbers of cells.
pub(super) fn united(node: Node) -> Node {
    within(node, &[])
}

fn within(node: Node, outer: &[Stated]) -> Node {
    let members = match node {
        Node::Record(members) => members,
        Node::List(list) => {
            return Node::List(list.into_iter().map(|node| inner(String::new(), within(node, outer)).1).collect());
        }
        cell @ Node::Cell(_) => return cell,
    };
    let mut known: Vec<Stated> = Vec::new();
    let mut rest: Vec<(String, Node)> = Vec::new();
    for (name, node) in members {
        let stated = stated(&name, &node);
        if stated.is_empty() {
            rest.push((name, node));
        } else {
            known.extend(stated);
        }
    }
    // What stands nearer comes first.
    known.extend_from_slice(outer);
    if known.is_empty() {
        return Node::Record(rest.into_iter().map(|(name, node)| inner(name, within(node, &[]))).collect());
    }
    // Beside numbers whose names say what they measure, a count has no unit.
    let measures = |name: &str| Heading::parse(name).value().is_some_and(|value| value.what != What::Unsaid);
    let said = rest.iter().any(|(name, _)| measures(name));
    let member = |(name, node): (String, Node)| {
        let counts = said && matches!(Heading::parse(&name).meaning, Meaning::Trial);
        let unit = of(&name, &known).filter(|_| !counts);
        match (within(node, &known), unit) {
            (list @ Node::List(_), Some(unit)) if list.cells().is_some() => (format!("{name} ({unit})"), list),
            (Node::Cell(cell), Some(unit)) => (name, Node::Cell(bears(cell, unit))),
            (node, _) => inner(name, node),
        }
    };
    Node::Record(rest.into_iter().map(member).collect())
}

/// A record of one number, or of one list of them, that is left when its unit is taken is that; the
/// unit of a list is that of its name.
fn inner(name: String, node: Node) -> (String, Node) {
    match node {
        Node::Record(mut members)
            if members.len() == 1 && Phrase::Value.all().iter().any(|value| members[0].0.starts_with(value)) =>
        {
            let (own, node) = members.remove(0);
            let unit = own.find(" (").map_or("", |at| &own[at..]);
            (format!("{name}{unit}"), node)
        }
        // A number of a unit that is not one of bounces.
        Node::Record(members) if members.len() == 2 && members.iter().any(|(own, _)| names_unit(own)) => {
            let of = |unit: bool| members.iter().find(|(own, _)| names_unit(own) == unit);
            let valued = |own: &str| Phrase::Value.all().iter().any(|value| own.starts_with(value));
            match (of(false), of(true)) {
                (Some((own, Node::Cell(value))), Some((_, Node::Cell(unit)))) if valued(own) => {
                    (name, Node::Cell(format!("{value} {unit}")))
                }
                _ => (name, Node::Record(members)),
            }
        }
        node => (name, node),
    }
}

/// A number with the unit behind it, whatever mark its decimals bear.
fn bears(cell: String, unit: &str) -> String {
    let bare = matches!(cell::read(&cell, false), Cell::Number(m) if m.unit.is_none());
    if bare { format!("{cell} {unit}") } else { cell }
}

/// The units that a member states: `"unit": "cm"`, `"height_unit": "cm"`, `"units": {"t": "s"}`.
fn stated(name: &str, node: &Node) -> Vec<Stated> {
    if !names_unit(name) {
        return Vec::new();
    }
    let one = |of: &str, node: &Node| {
        let unit = node.cell()?;
        Unit::parse(unit).map(|u| Stated { of: folded(of), unit: unit.to_owned(), dimension: u.dimension })
    };
    match node {
        Node::Record(units) => units.iter().map(|(of, unit)| one(of, unit)).collect::<Option<_>>().unwrap_or_default(),
        node => one(&subject(name), node).into_iter().collect(),
    }
}

/// What a name of a unit says that it is of: the other words.
fn subject(name: &str) -> String {
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !names_unit(word));
    words.collect::<Vec<_>>().join(" ")
}

/// The unit that is stated of what is called `name`, if that names none: of its dimension, and of
/// several that which names it.
fn of<'a>(name: &str, known: &'a [Stated]) -> Option<&'a str> {
    let heading = Heading::parse(name);
    let dimension = match &heading.meaning {
        _ if heading.unit.is_some() => return None,
        Meaning::Value(value) => value.what.dimension(),
        Meaning::Setting | Meaning::Trial => None,
        Meaning::Empty if !heading.unknown.is_empty() => None,
        _ if Phrase::Value.all().iter().any(|value| name.starts_with(value)) => None,
        _ => return None,
    };
    let fits = |stated: &&Stated| dimension.is_none_or(|dimension| dimension == stated.dimension);
    let name = folded(name);
    let called = |stated: &&Stated| !stated.of.is_empty() && name.contains(stated.of.as_str());
    // A quantity by itself is that of all readings: `height`, but not `drop`.
    let whole = |stated: &&Stated| {
        let of = Heading::parse(&stated.of);
        let of_all = |word: &Word| word.is(Atom::Filler) || Phrase::Lengths.is(&folded(&word.text));
        let lengths = stated.dimension == Dimension::Length && split(&stated.of).iter().all(of_all);
        lengths || stated.of.is_empty() || of.unknown.is_empty() && of.value().is_some_and(|value| value.at == At::Row)
    };
    let mut fitting = known.iter().filter(fits);
    let called = fitting.clone().find(called);
    let first = fitting.next()?;
    // Of what may be anything, or of several units, only one can be meant.
    let alone = dimension.is_some() && first.of.is_empty() || fitting.all(|other| other.unit == first.unit);
    called.or(Some(first).filter(|first| alone && whole(first))).map(|stated| stated.unit.as_str())
}
