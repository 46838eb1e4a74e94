//! The command as the tests of the command line call it.

pub(crate) mod place;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

pub(crate) fn saltus() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_saltus"));
    command.env("NO_COLOR", "1");
    command
}

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub(crate) fn squash() -> PathBuf {
    root().join("examples/data/squash-on-cement.csv")
}

pub(crate) fn run(arguments: &[&str]) -> Output {
    saltus().args(arguments).output().unwrap()
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A command that must succeed and say nothing on standard error; its standard output.
pub(crate) fn done(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

/// A command that must fail with status 2 and nothing on standard output; its message.
pub(crate) fn refused(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    assert_eq!(text(&output.stdout), "");
    text(&output.stderr)
}

/// A command that must succeed with this on its standard input; its standard output.
pub(crate) fn fed(arguments: &[&str], input: &[u8]) -> String {
    let mut child = saltus().args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(input).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    text(&output.stdout)
}

/// A table in a folder of its own.
pub(crate) fn table(content: impl AsRef<[u8]>) -> (TempDir, String) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("table.csv");
    fs::write(&path, content).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
}

/// Compares with a file in the project; `SALTUS_BLESS=1` rewrites it instead.
pub(crate) fn golden(path: &Path, got: &str) {
    if std::env::var_os("SALTUS_BLESS").is_some() {
        fs::write(path, got).unwrap();
    }
    let expected = fs::read_to_string(path).unwrap_or_default().replace("\r\n", "\n");
    assert!(expected == got, "{} differs from:\n{got}\nLook at it; SALTUS_BLESS=1 accepts it.", path.display());
}

/// A scene in a folder of its own.
pub(crate) fn scene(toml: &str) -> (TempDir, String) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("drop.toml");
    fs::write(&path, toml).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
}

pub(crate) fn run_quietly(arguments: &[&str]) -> bool {
    run(&[&["-q"], arguments].concat()).status.success()
}
