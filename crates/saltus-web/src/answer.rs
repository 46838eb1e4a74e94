//! What every answer is.

use serde_json::{Value, json};

/// The answer, and the bytes behind it.
pub(crate) type Answer = Result<(Value, Vec<u8>), Value>;

/// A failure that has a kind and words.
#[allow(clippy::needless_pass_by_value)] // used as a function
pub(crate) fn failed(kind: &str, message: impl ToString) -> Value {
    json!({ "kind": kind, "message": message.to_string() })
}
