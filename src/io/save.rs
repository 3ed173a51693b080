//! Writing a file so that it is either there whole or as it was.

use super::error::ExportError;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes a file through a temporary one in the same folder, which replaces it at the end. When anything fails, a
/// file that was there before is as it was and the temporary one is gone.
///
/// # Errors
/// The folder is missing, or the system or `write` reports an error.
pub fn save(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), ExportError> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let file = path.display().to_string();
    if !folder.is_dir() {
        return Err(ExportError::FolderMissing { file, folder: folder.display().to_string() });
    }
    let failed = |source| ExportError::Unwritable { file: path.display().to_string(), source };
    if path.is_dir() {
        return Err(failed(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder")));
    }
    let (temporary, handle) = create_temporary(folder, path).map_err(failed)?;
    let result = fill(handle, write).and_then(|()| {
        // A file that is replaced keeps its permissions.
        if let Ok(before) = fs::metadata(path) {
            fs::set_permissions(&temporary, before.permissions())?;
        }
        fs::rename(&temporary, path)
    });
    result.map_err(|source| {
        // The first error is the one to report; a temporary file that cannot be removed is no worse.
        let _ = fs::remove_file(&temporary);
        failed(source)
    })
}

fn fill(handle: File, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, handle);
    write(&mut out)?;
    out.flush()?;
    out.get_ref().sync_all()
}

/// Creates a file that was not there, named after `path`.
fn create_temporary(folder: &Path, path: &Path) -> io::Result<(PathBuf, File)> {
    const ATTEMPTS: u32 = 1000;
    let name =
        path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it has no name"))?;
    for attempt in 0..ATTEMPTS {
        let mut temporary = name.to_os_string();
        temporary.push(format!(".{}-{attempt}.tmp", std::process::id()));
        let temporary = folder.join(temporary);
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Ok(handle) => return Ok((temporary, handle)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::new(io::ErrorKind::AlreadyExists, "no temporary file could be created beside it"))
}
