//! What texts were found to say, for when the same text is met again: forms, titles, columns and
//! remarks of a table each look at its lines, and the next table has the same headings.

use std::collections::HashMap;
use std::sync::{LazyLock, RwLock};

/// So many texts are kept, of so many bytes each at most: more than the tables of one author have,
/// and a few megabytes.
const MOST: usize = 4096;
const LONG: usize = 128;

/// What is kept of texts, by all threads.
pub(super) type Kept<T> = LazyLock<RwLock<HashMap<String, T>>>;

/// What `read` finds in a text: the same for the same text. No thread waits for another: where one
/// writes, the others read their texts themselves.
pub(super) fn kept<T: Clone>(kept: &Kept<T>, text: &str, read: impl FnOnce(&str) -> T) -> T {
    if text.len() > LONG {
        return read(text);
    }
    if let Some(found) = kept.try_read().ok().and_then(|kept| kept.get(text).cloned()) {
        return found;
    }
    let found = read(text);
    if let Ok(mut kept) = kept.try_write() {
        if kept.len() >= MOST {
            kept.clear();
        }
        kept.insert(text.to_owned(), found.clone());
    }
    found
}
