//! The text that a scene was read from, kept so that what is wrong with the scene as a whole can be
//! shown in it.

use std::ops::Range;
use std::sync::Arc;

use toml::de::{DeTable, DeValue};

use super::error::{Fault, SceneError};

/// The name and the text of a scene; none for one that is made of several.
///
/// Two scenes are equal whatever they were read from.
#[derive(Clone, Debug, Default)]
pub(super) struct Source(Option<Arc<(String, String)>>);

impl PartialEq for Source {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Source {
    pub(super) fn new(name: &str, text: &str) -> Self {
        Self(Some(Arc::new((name.to_owned(), text.to_owned()))))
    }

    /// The fault `says` of the item `number`, from 0 and the last without one, of a table or list
    /// under `key`, with its place.
    pub(super) fn fault(&self, key: &str, number: Option<usize>, says: &str) -> Option<SceneError> {
        let (name, text) = self.0.as_deref()?;
        let span = found(text, key, number)?;
        Some(SceneError::new(name, text.as_bytes(), Fault::new(span, says)))
    }
}

/// The place of an item under a key.
fn found(text: &str, key: &str, number: Option<usize>) -> Option<Range<usize>> {
    let table = DeTable::parse(text).ok()?;
    let (found, value) = table.get_ref().iter().find(|(found, _)| found.get_ref() == key)?;
    match value.get_ref() {
        DeValue::Array(items) => {
            let item = number.map_or_else(|| items.iter().last(), |number| items.get(number))?;
            Some(item.span())
        }
        _ => Some(found.span()),
    }
}
