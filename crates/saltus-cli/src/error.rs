//! Errors of the command, as text and as data.

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
    /// The error as data, for a program, where it has a kind.
    data: Option<Value>,
}

impl Error {
    pub(crate) fn new(message: impl fmt::Display) -> Self {
        Self { message: message.to_string(), broken_pipe: false, data: None }
    }

    /// An error with its kind, place and advice as data too.
    #[allow(clippy::needless_pass_by_value)] // used as a function
    pub(crate) fn data(error: impl fmt::Display + Serialize) -> Self {
        Self { data: serde_json::to_value(&error).ok(), ..Self::new(error) }
    }

    /// An error of standard output; that nobody reads on is none.
    #[allow(clippy::needless_pass_by_value)] // used as a function
    pub(crate) fn stdout(error: io::Error) -> Self {
        Self {
            message: format!("cannot write to standard output: {}", system(&error)),
            broken_pipe: error.kind() == io::ErrorKind::BrokenPipe,
            data: None,
        }
    }

    pub(crate) fn writing(path: &Path, error: &io::Error) -> Self {
        Self::new(format!("cannot write '{}': {}", path.display(), system(error)))
    }

    pub(crate) fn reading(path: &Path, error: &io::Error) -> Self {
        Self::new(format!("cannot read '{}': {}", path.display(), plain(error)))
    }

    /// The message.
    pub(crate) fn message(&self) -> &str {
        &self.message
    }

    /// The kind, the place and the advice, as far as the error has them.
    pub(crate) fn as_data(&self) -> Value {
        self.data.clone().unwrap_or_else(|| json!({ "kind": "command", "message": self.message }))
    }

    /// Writes the error to standard error; with `json` as an object to standard output, where the
    /// report would have been.
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

/// The message of the system, without its number.
fn plain(error: &io::Error) -> String {
    let says = error.to_string();
    says.split(" (os error").next().unwrap_or(&says).to_owned()
}

/// The message of the system about writing, with advice where there is some.
pub(crate) fn system(error: &io::Error) -> String {
    let says = plain(error);
    let advice = match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "make room, or name a file elsewhere"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "name a file where you may write, or change whose it is"
        }
        _ => return says,
    };
    format!("{says}: {advice}")
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}
