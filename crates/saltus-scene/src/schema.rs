//! The keys of a scene file, for editors.

use serde_json::{Map, Value};

/// Written by a test from the types that a file is read into.
const SCHEMA: &str = include_str!("scene.schema.json");

/// The JSON Schema (draft 7) of scene files, as text.
///
/// An editor that knows schemas for TOML checks and completes by it when the file begins with `#:schema scene.schema.json`.
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

/// Where a key belongs, in words; the likeliest first.
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
        let schema = serde_json::to_string_pretty(&root).unwrap() + "\n";
        if std::env::var_os("SALTUS_BLESS").is_some() {
            let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/scene.schema.json");
            std::fs::write(path, &schema).unwrap();
        } else {
            assert!(schema == SCHEMA.replace("\r\n", "\n"), "SALTUS_BLESS=1 writes:\n{schema}");
        }
    }
}
