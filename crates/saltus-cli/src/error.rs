//! What the command says when it cannot go on.

use std::fmt;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use serde::Serialize;
use serde_json::{Value, json};

/// A failure, in words for the user; exit status 2.
#[derive(Debug)]
pub(crate) struct Error {
    message: String,
    broken_pipe: bool,
    /// What a program reads instead of the message, where it is known.
    data: Option<Value>,
}

impl Error {
    pub(crate) fn new(message: impl fmt::Display) -> Self {
        Self { message: message.to_string(), broken_pipe: false, data: None }
    }

    /// One that has its kind, place and advice as data too.
    #[allow(clippy::needless_pass_by_value)] // used as a function
    pub(crate) fn data(error: impl fmt::Display + Serialize) -> Self {
        Self { data: serde_json::to_value(&error).ok(), ..Self::new(error) }
    }

    /// Writing to standard output failed; that nobody reads on is no failure.
    #[allow(clippy::needless_pass_by_value)] // used as a function
    pub(crate) fn stdout(error: io::Error) -> Self {
        Self {
            message: format!("cannot write to standard output: {error}"),
            broken_pipe: error.kind() == io::ErrorKind::BrokenPipe,
            data: None,
        }
    }

    pub(crate) fn writing(path: &Path, error: &io::Error) -> Self {
        Self::new(format!("cannot write '{}': {error}", path.display()))
    }

    /// What it says.
    pub(crate) fn message(&self) -> &str {
        &self.message
    }

    /// Its kind, place and advice, where they are known.
    pub(crate) fn as_data(&self) -> Value {
        self.data.clone().unwrap_or_else(|| json!({ "kind": "command", "message": self.message }))
    }

    /// Says it on standard error; `json`: as an object on standard output, where the report would
    /// have been.
    pub(crate) fn report(&self, json: bool) -> ExitCode {
        if self.broken_pipe {
            return ExitCode::SUCCESS;
        }
        if json {
            let text = format!("{:#}\n", json!({ "schema": 1, "error": self.as_data() }));
            let mut out = io::stdout().lock();
            let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
            return if written.is_ok() { ExitCode::from(2) } else { ExitCode::FAILURE };
        }
        anstream::eprintln!("\u{1b}[1;31merror:\u{1b}[0m {}", self.message);
        ExitCode::from(2)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}
