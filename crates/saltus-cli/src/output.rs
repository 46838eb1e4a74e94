//! Where results go: standard output, or a file that is written whole or not at all.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use crate::error::Error;

/// Writes to the file, or to standard output if it is `-` or none is given.
pub(crate) fn write(to: Option<&Path>, bytes: &[u8]) -> Result<(), Error> {
    match to {
        Some(path) if path != Path::new("-") => file(path, bytes),
        _ => stdout(bytes).map(drop),
    }
}

/// Writes to standard output.
pub(crate) fn stdout(bytes: &[u8]) -> Result<ExitCode, Error> {
    let mut out = io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(Error::stdout)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes a file through a temporary one beside it, so that a failure never harms what was there.
fn file(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let fail = |error: io::Error| Error::writing(path, &error);
    // A link stays a link; the file it leads to is replaced.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    match fs::metadata(&target) {
        Ok(old) if old.is_dir() => {
            return Err(Error::new(format!("'{}' is a folder: name a file in it", path.display())));
        }
        // A device or a pipe cannot be replaced, only written to.
        Ok(old) if !old.is_file() => return fs::write(&target, bytes).map_err(fail),
        _ => {}
    }
    check_folder(&target)?;
    let mut temporary = builder().tempfile_in(folder(&target)).map_err(fail)?;
    temporary.write_all(bytes).and_then(|()| temporary.as_file().sync_all()).map_err(fail)?;
    if let Ok(old) = fs::metadata(&target) {
        fs::set_permissions(temporary.path(), old.permissions()).map_err(fail)?;
    }
    temporary.persist(&target).map_err(|error| fail(error.error))?;
    Ok(())
}

/// The folder that a file is in.
fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."))
}

/// Refuses a file in a folder that there is not.
pub(crate) fn check_folder(path: &Path) -> Result<(), Error> {
    let folder = folder(path);
    match fs::metadata(folder) {
        Ok(found) if found.is_dir() => Ok(()),
        Ok(_) => Err(Error::new(format!("cannot write '{}': '{}' is no folder", path.display(), folder.display()))),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            Err(Error::new(format!("cannot write '{}': there is no folder '{}'", path.display(), folder.display())))
        }
        Err(error) => Err(Error::writing(path, &error)),
    }
}

/// A new file gets the permissions that any program would give it.
pub(crate) fn builder<'a>() -> tempfile::Builder<'a, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".saltus-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}

/// Refuses to write over a file that may hold a person's work, unless it is asked for.
pub(crate) fn check_new(path: Option<&Path>, force: bool) -> Result<(), Error> {
    let holds = |path: &&Path| fs::metadata(path).is_ok_and(|file| file.is_file() && file.len() > 0);
    match path.filter(|path| !force && *path != Path::new("-")).filter(holds) {
        Some(path) => {
            Err(Error::new(format!("'{}' exists: name another file, or say --force to write it anew", path.display())))
        }
        None => Ok(()),
    }
}

/// Refuses to write over the file that is read, also where writing over files is asked for.
pub(crate) fn check_apart(to: Option<&Path>, from: &Path) -> Result<(), Error> {
    let real = |path: &Path| fs::canonicalize(path).ok().filter(|path| path.is_file());
    match to {
        Some(to) if real(to).is_some_and(|to| real(from) == Some(to)) => {
            Err(Error::new(format!("'{}' is what is read: name another file to write", to.display())))
        }
        _ => Ok(()),
    }
}

/// Refuses a file whose extension is that of another format: `own` is the extension of the one that
/// is asked for, `all` are those that say a format.
pub(crate) fn check_extension(to: Option<&Path>, format: &str, own: &str, all: &[&str]) -> Result<(), Error> {
    let Some(to) = to else { return Ok(()) };
    match extension(to) {
        Some(said) if said != own && all.contains(&said.as_str()) => Err(Error::new(format!(
            "'{}' is to be {format}, and its extension is that of another format: name the file '{}'",
            to.display(),
            to.with_extension(own).display()
        ))),
        _ => Ok(()),
    }
}

/// The extension of a file, in small letters.
pub(crate) fn extension(path: &Path) -> Option<String> {
    path.extension().map(|extension| extension.to_string_lossy().to_lowercase())
}

/// A line of talk, unless silence was asked for.
pub(crate) fn say(quiet: bool, line: &str) {
    if !quiet {
        anstream::eprintln!("{line}");
    }
}

/// Refuses a picture that is not to be SVG before any work is done.
pub(crate) fn check_picture(path: Option<&Path>) -> Result<(), Error> {
    match path {
        Some(path) if path != Path::new("-") && path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("svg")) => {
            let svg = path.with_extension("svg");
            Err(Error::new(format!(
                "pictures are SVG: name the file '{}' instead of '{}'",
                svg.display(),
                path.display()
            )))
        }
        _ => Ok(()),
    }
}
