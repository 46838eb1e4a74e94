//! Words that mean nothing else than that they stand in a list.

use std::sync::OnceLock;

/// A word a line, in the order of their bytes, in lower case without accents.
pub(super) struct Listed {
    text: &'static str,
    words: OnceLock<Vec<&'static str>>,
}

impl Listed {
    pub(super) const fn new(text: &'static str) -> Self {
        Self { text, words: OnceLock::new() }
    }

    pub(super) fn words(&self) -> &[&'static str] {
        self.words.get_or_init(|| self.text.lines().collect())
    }

    pub(super) fn has(&self, word: &str) -> bool {
        self.words().binary_search(&word).is_ok()
    }

    /// Whether words stand where they are looked for.
    #[cfg(test)]
    pub(super) fn is_in_order(&self) -> bool {
        self.words().windows(2).all(|pair| pair[0] < pair[1])
    }
}
