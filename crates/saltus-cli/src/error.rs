//! What the command says when it cannot go on.

use std::fmt;
use std::io;
use std::path::Path;
use std::process::ExitCode;

/// A failure, in words for the user; exit status 2.
#[derive(Debug)]
pub(crate) struct Error {
    message: String,
    broken_pipe: bool,
}

impl Error {
    pub(crate) fn new(message: impl fmt::Display) -> Self {
        Self { message: message.to_string(), broken_pipe: false }
    }

    /// Writing to standard output failed; that nobody reads on is no failure.
    #[allow(clippy::needless_pass_by_value)] // used as a function
    pub(crate) fn stdout(error: io::Error) -> Self {
        Self {
            message: format!("cannot write to standard output: {error}"),
            broken_pipe: error.kind() == io::ErrorKind::BrokenPipe,
        }
    }

    pub(crate) fn writing(path: &Path, error: &io::Error) -> Self {
        Self::new(format!("cannot write '{}': {error}", path.display()))
    }

    /// Says it on standard error.
    pub(crate) fn report(&self) -> ExitCode {
        if self.broken_pipe {
            return ExitCode::SUCCESS;
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
