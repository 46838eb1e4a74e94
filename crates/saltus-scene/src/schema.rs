//! The keys of a scene file, for editors.

use serde_json::{Map, Value};

/// Written by a test from the types that a file is read into.
const SCHEMA: &str = include_str!("scene.schema.json");

/// The JSON Schema (draft 7) of scene files, as text.
///
/// An editor that knows schemas for TOML checks and completes by it when the file begins with
/// `#:schema scene.schema.json`.
///
/// ```
/// let schema = saltus_scene::schema();
/// assert!(schema.contains("\"title\": \"saltus scene\"") && schema.contains("\"height\""));
/// ```
#[must_use]
pub const fn schema() -> &'static str {
    SCHEMA
}

/// The tables with their keys; the top of the file is "".
fn tables() -> Vec<(String, Map<String, Value>)> {
    let root: Value = serde_json::from_str(SCHEMA).unwrap_or_default();
    let keys = |table: &Value| table.get("properties").and_then(Value::as_object).cloned();
    let mut tables: Vec<_> = keys(&root).map(|keys| (String::new(), keys)).into_iter().collect();
    if let Some(definitions) = root.get("definitions").and_then(Value::as_object) {
        tables.extend(definitions.iter().filter_map(|(name, table)| Some((name.replace('-', "_"), keys(table)?))));
    }
    tables
}

/// Every key, once.
pub(super) fn keys() -> Vec<String> {
    let mut keys: Vec<String> =
        tables().into_iter().flat_map(|(_, keys)| keys.into_iter().map(|(key, _)| key)).collect();
    keys.sort_unstable();
    keys.dedup();
    keys
}

/// The places of a key, in words; the likeliest first.
pub(super) fn homes(key: &str) -> Vec<String> {
    let tables: Vec<String> =
        tables().into_iter().filter(|(_, keys)| keys.contains_key(key)).map(|(name, _)| name).collect();
    tables
        .into_iter()
        .map(|name| match name.as_str() {
            "" => "at the top of the file, before the first [table]".to_owned(),
            "elastic" => "to `ball` and `floor` under [contact]".to_owned(),
            "motion" => "to `motion` under [floor]".to_owned(),
            _ => format!("under [{name}]"),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use schemars::generate::SchemaSettings;

    use super::super::file::File;
    use super::SCHEMA;

    /// `SALTUS_BLESS=1` rewrites it.
    #[test]
    fn it_is_that_of_the_types() {
        let root =
            SchemaSettings::draft07().for_deserialize().into_generator().into_root_schema_for::<File>().to_value();
        // A line's end in a comment is no line's end in an editor; an empty line is.
        let schema = serde_json::to_string_pretty(&root).unwrap() + "\n";
        let schema = schema.split(r"\n\n").map(|part| part.replace(r"\n", " ")).collect::<Vec<_>>().join(r"\n\n");
        if std::env::var_os("SALTUS_BLESS").is_some() {
            let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/scene.schema.json");
            std::fs::write(path, &schema).unwrap();
        } else {
            assert!(schema == SCHEMA.replace("\r\n", "\n"), "SALTUS_BLESS=1 writes:\n{schema}");
        }
    }

    /// Every kind of a table has a row in docs/use/scenes.md that names its keys; the kinds and
    /// keys are those of the schema, which come from the one declaration of each table.
    #[test]
    fn docs_have_every_kind_with_its_keys() {
        let docs = include_str!("../../../docs/use/scenes.md");
        let root: serde_json::Value = serde_json::from_str(SCHEMA).unwrap();
        let mut found = 0;
        for (table, key) in [("floor", "kind"), ("contact", "law"), ("restitution", "law")] {
            let of = &root["definitions"][table]["properties"][key];
            let kinds = of["oneOf"].as_array().or(of["anyOf"][0]["oneOf"].as_array()).unwrap();
            for kind in kinds {
                let (name, about) = (kind["const"].as_str().unwrap(), kind["description"].as_str().unwrap());
                let row = |line: &&str| line.starts_with('|') && line.contains(&format!("\"{name}\""));
                let row =
                    docs.lines().find(row).unwrap_or_else(|| panic!("docs/use/scenes.md has no row of \"{name}\""));
                for key in about.split('`').skip(1).step_by(2) {
                    let mut words = row.split(|c: char| !c.is_ascii_lowercase() && c != '_');
                    assert!(words.any(|word| word == key), "\"{name}\" in docs/use/scenes.md has no `{key}`: {row}");
                    found += 1;
                }
            }
        }
        assert!(found > 40, "{found}");
    }

    /// Who has the docs of the crate and nothing else finds every key of the top there.
    #[test]
    fn the_docs_of_the_crate_name_every_key_of_the_top() {
        let docs = include_str!("lib.rs");
        let docs = docs.split_once("# The keys of a scene").unwrap().1;
        let root: serde_json::Value = serde_json::from_str(SCHEMA).unwrap();
        for key in root["properties"].as_object().unwrap().keys() {
            let table = format!("[{key}]");
            let named = [format!("//! {key} = "), format!("`{key}"), table];
            assert!(named.iter().any(|named| docs.contains(named)), "`{key}`");
        }
    }
}
