//! Remarks on the cells of a workbook, `.xlsx`: they stand in parts of their own, which the
//! relations of a sheet name.

use quick_xml::Reader;
use quick_xml::events::Event;

use super::foreign::entity;

/// The remarks of a workbook, each with the number of its sheet; `unpack` gives the text of a part.
pub(super) fn of_sheets(parts: &[String], mut unpack: impl FnMut(&str) -> Option<String>) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for entry in parts {
        let number =
            |name: &str| name.strip_prefix("xl/worksheets/_rels/sheet")?.strip_suffix(".xml.rels")?.parse().ok();
        let Some(sheet) = number(entry) else { continue };
        let Some(relations) = unpack(entry) else { continue };
        let of_sheet = parts.iter().filter(|part| {
            let name = part.strip_prefix("xl/").filter(|name| name.starts_with("comments"));
            name.is_some_and(|name| relations.contains(&format!("/{name}\"")))
        });
        for part in of_sheet {
            let texts = unpack(part).map_or_else(Vec::new, |xml| texts(&xml));
            found.extend(texts.into_iter().map(|text| (sheet, text)));
        }
    }
    found
}

/// The text of every remark of a part; what is damaged ends it.
fn texts(xml: &str) -> Vec<String> {
    let (mut reader, mut found, mut within) = (Reader::from_str(xml), Vec::new(), false);
    loop {
        match reader.read_event() {
            Ok(Event::Start(tag)) => match tag.local_name().as_ref() {
                "comment" => found.push(String::new()),
                "t" => within = true,
                _ => {}
            },
            Ok(Event::End(tag)) if tag.local_name().as_ref() == "t" => within = false,
            Ok(Event::Text(words)) if within => {
                if let Some(text) = found.last_mut() {
                    text.push_str(words.as_ref());
                }
            }
            Ok(Event::GeneralRef(name)) if within => {
                if let Some(text) = found.last_mut() {
                    text.push_str(&entity(name.as_ref()));
                }
            }
            Ok(Event::Eof) | Err(_) => return found,
            Ok(_) => {}
        }
    }
}
