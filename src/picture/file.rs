//! Files that are there whole or not at all.

use crate::problem::{Problem, Result};
use std::fmt::Display;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Where a picture is written to before it has its name.
pub(super) type Writer<'a> = &'a mut BufWriter<tempfile::NamedTempFile>;

/// Lets `write` fill a temporary file beside `path`, which then takes its name. On an error nothing is left behind, and
/// what was there before stays.
pub(super) fn write_whole<E: Display>(
    path: &Path,
    write: impl FnOnce(Writer) -> std::result::Result<(), E>,
) -> Result<()> {
    let failure = |cause: &dyn Display| {
        Problem::failure("picture-write", format!("can't write `{}`: {cause}", path.display()))
    };
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    // The error itself would name the temporary file.
    let file = create(folder).map_err(|error| failure(&error.kind()))?;
    let mut writer = BufWriter::new(file);
    write(&mut writer).map_err(|error| failure(&error))?;
    writer.flush().map_err(|error| failure(&error))?;
    let file = writer.into_inner().map_err(|error| failure(&error))?;
    file.persist(path).map_err(|error| failure(&error.error))?;
    Ok(())
}

/// A temporary file with the permissions of any new file; by themselves, temporary files are private.
fn create(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".voxgi-");
    #[cfg(unix)]
    let builder = builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

pub(super) fn unreadable(path: &Path, cause: impl Display) -> Problem {
    Problem::failure("picture-read", format!("can't read `{}`: {cause}", path.display()))
}

/// Writes bytes as they are.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    write_whole(path, |writer| writer.write_all(bytes))
}
