//! Headings that were taken apart, for when the same text is met again: forms, titles and columns
//! of a table each look at its lines.

use std::cell::RefCell;
use std::collections::HashMap;

use super::Heading;

/// So many are kept, each of a text of so many bytes at most: more than a table has names, and less
/// than half a megabyte.
const MOST: usize = 512;
const LONG: usize = 128;

thread_local! {
    static KEPT: RefCell<HashMap<String, Heading>> = RefCell::default();
}

impl Heading {
    /// What a heading says: the same for the same text.
    pub(in crate::read) fn parse(text: &str) -> Self {
        if text.len() > LONG {
            return Self::apart(text);
        }
        if let Some(heading) = KEPT.with_borrow(|kept| kept.get(text).cloned()) {
            return heading;
        }
        let heading = Self::apart(text);
        KEPT.with_borrow_mut(|kept| {
            if kept.len() >= MOST {
                kept.clear();
            }
            kept.insert(text.to_owned(), heading.clone());
        });
        heading
    }
}
