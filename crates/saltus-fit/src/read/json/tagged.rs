//! Elements and their attributes, as XML has them, as records: `<drop height="1 m"/>` is one, and
//! elements of one name below another are its list.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::super::foreign::entity;
use super::super::phrases::Phrase;
use super::{Node, plain};

/// Values lie no deeper than those of JSON may.
const DEEPEST: usize = 128;

/// An element that is open: its name, its members so far, and its own text.
#[derive(Default)]
struct Open {
    name: String,
    members: Vec<(String, Node)>,
    text: String,
}

impl Open {
    fn new(tag: &BytesStart<'_>) -> Self {
        let mut attributes = tag.html_attributes();
        // Where a name is explained is no attribute of what it names.
        let own = attributes.with_checks(false).flatten().filter(|a| !a.key.as_ref().starts_with("xmlns"));
        let spelt = |name: &str| plain(name.rsplit(':').next().unwrap_or(name));
        let members = own.map(|a| (spelt(a.key.as_ref()), Node::Cell(plain(unescaped(&a.value).trim()))));
        Self { name: spelt(tag.name().as_ref()), members: members.collect(), text: String::new() }
    }

    /// The element as a value: its text, where it has nothing else.
    fn closed(self) -> (String, Node) {
        let text = plain(self.text.trim());
        let mut members = together(self.members);
        match (members.is_empty(), text.is_empty()) {
            (true, _) => return (self.name, Node::Cell(text)),
            (false, true) => {}
            (false, false) => {
                let value = Phrase::Value.all().first().copied().unwrap_or_default();
                members.push((value.to_owned(), Node::Cell(text)));
            }
        }
        (self.name, Node::Record(members))
    }
}

/// Members with those of one name as a list, where the first of them stands.
fn together(members: Vec<(String, Node)>) -> Vec<(String, Node)> {
    let mut lists: Vec<(String, Vec<Node>)> = Vec::new();
    let mut places = std::collections::HashMap::new();
    for (name, node) in members {
        let at = *places.entry(name.clone()).or_insert(lists.len());
        if at == lists.len() {
            lists.push((name, Vec::new()));
        }
        lists[at].1.push(node);
    }
    let one = |mut list: Vec<Node>| if list.len() == 1 { list.remove(0) } else { Node::List(list) };
    lists.into_iter().map(|(name, list)| (name, one(list))).collect()
}

/// A text with the characters that names within it, `&deg;`, stand for.
fn unescaped(text: &str) -> String {
    let mut parts = text.split('&');
    let mut found = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once(';') {
            Some((name, rest)) => found.extend([entity(name).as_str(), rest]),
            None => found.push_str(part),
        }
    }
    found
}

/// The value that a text of elements holds; `None` if it is none, or its elements do not close.
pub(super) fn tagged(text: &str) -> Option<Node> {
    let mut reader = Reader::from_str(text);
    let mut open = vec![Open::default()];
    loop {
        let closed = match reader.read_event().ok()? {
            Event::Start(tag) => {
                open.push(Open::new(&tag));
                None
            }
            Event::Empty(tag) => Some(Open::new(&tag)),
            Event::End(_) => open.pop(),
            Event::Text(words) => {
                open.last_mut()?.text.push_str(words.as_ref());
                None
            }
            Event::CData(words) => {
                open.last_mut()?.text.push_str(words.as_ref());
                None
            }
            Event::GeneralRef(name) => {
                open.last_mut()?.text.push_str(&entity(name.as_ref()));
                None
            }
            Event::Eof => break,
            _ => None,
        };
        if let Some(element) = closed {
            open.last_mut()?.members.push(element.closed());
        }
        if open.len() > DEEPEST {
            return None;
        }
    }
    let whole = open.pop().filter(|_| open.is_empty())?;
    whole.text.trim().is_empty().then_some(Node::Record(whole.members))
}

#[cfg(test)]
mod tests {
    use super::super::super::sheet::Content;
    use super::super::parts;

    fn cells(text: &str) -> Option<String> {
        match &parts(text.as_bytes())?.first()?.content {
            Content::Cells(cells) => Some(cells.clone()),
            Content::Bytes(_) => None,
        }
    }

    /// Attributes, elements, and elements with a unit beside them are one table.
    #[test]
    fn attributes_and_elements_are_members() {
        for row in [
            |drop, rebound| format!("<drop height=\"{drop} cm\" rebound=\"{rebound} cm\"/>"),
            |drop, rebound| format!("<drop><height>{drop} cm</height><rebound>{rebound} cm</rebound></drop>"),
            |drop, rebound| {
                format!("<drop><height unit='cm'>{drop}</height><rebound unit='cm'>{rebound}</rebound></drop>")
            },
            |drop, rebound| format!("<drop height=\"{drop} cm\"><rebound><![CDATA[{rebound} cm]]></rebound></drop>"),
        ] {
            let text = format!("<?xml version=\"1.0\"?>\n<lab>{}{}</lab>", row(100, 64), row(80, 51));
            assert_eq!(cells(&text).as_deref(), Some("height\trebound\n100 cm\t64 cm\n80 cm\t51 cm\n"), "{text}");
        }
    }

    #[test]
    fn what_does_not_close_or_lies_too_deep_is_none() {
        let deep = format!("{}{}", "<a>".repeat(200), "</a>".repeat(200));
        for text in ["<a><b></a>", "<a b='1'", "</a>", "<a/>b", "<", &deep] {
            assert_eq!(cells(text), None, "{text}");
        }
    }
}
