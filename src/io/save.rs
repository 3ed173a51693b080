//! Writing a file so that it is either there whole or as it was.

use super::error::ExportError;
use crate::fault;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter};
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
    let failed = |source| ExportError::Unwritable { file: path.display().to_string(), source };
    let before = fs::metadata(path).ok();
    match &before {
        Some(before) if before.is_dir() => {
            return Err(failed(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder")));
        }
        // A pipe or a device is written to; nothing may take its place.
        Some(before) if !before.is_file() => {
            return File::options()
                .write(true)
                .open(path)
                .and_then(|handle| fill(handle, write))
                .map(drop)
                .map_err(failed);
        }
        _ => {}
    }
    // A link stays one: the file it leads to is the one that changes.
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        let [file, folder] = [path, folder].map(|path| path.display().to_string());
        return Err(ExportError::FolderMissing { file, folder });
    }
    let (temporary, handle) = create_temporary(folder, path).map_err(failed)?;
    let result = fill(handle, write).and_then(|handle| {
        handle.sync_all()?;
        // A file that is replaced keeps its permissions.
        if let Some(before) = before {
            fs::set_permissions(&temporary.0, before.permissions())?;
        }
        fault::point("write");
        fs::rename(&temporary.0, path)
    });
    result.map_err(failed)
}

/// A temporary file, which is removed at the end, also when writing panics, unless it was renamed.
struct Temporary(PathBuf);

impl Drop for Temporary {
    fn drop(&mut self) {
        // What went wrong before is what counts; a file that cannot be removed is no worse.
        let _ = fs::remove_file(&self.0);
    }
}

fn fill(handle: File, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<File> {
    let mut out = BufWriter::with_capacity(1 << 16, handle);
    write(&mut out)?;
    fault::point("write");
    out.into_inner().map_err(io::IntoInnerError::into_error)
}

/// Creates a file that was not there, named after `path`.
fn create_temporary(folder: &Path, path: &Path) -> io::Result<(Temporary, File)> {
    const ATTEMPTS: u32 = 1000;
    let name =
        path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it has no name"))?;
    for attempt in 0..ATTEMPTS {
        let mut temporary = name.to_os_string();
        temporary.push(format!(".{}-{attempt}.tmp", std::process::id()));
        let temporary = folder.join(temporary);
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Ok(handle) => return Ok((Temporary(temporary), handle)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::new(io::ErrorKind::AlreadyExists, "no temporary file could be created beside it"))
}
