//! Files that survive a crash: a file is written beside its place, synchronised, and moved there.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Error of writing a run folder.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The folder already holds a run.
    #[error(
        "{} already holds a run ({found}); continue it with --resume, choose another folder, or move that one away",
        path.display()
    )]
    Occupied {
        /// Path of the folder.
        path: PathBuf,
        /// Name of a file of the run that it holds.
        found: &'static str,
    },
    /// Another process writes the run.
    #[error("{} is in use: another process writes its run", .0.display())]
    InUse(PathBuf),
    /// The table is no longer the one that is being written.
    #[error("{} was changed by another program while the run wrote it: {message}", path.display())]
    Changed {
        /// Path of the file.
        path: PathBuf,
        /// What is different.
        message: String,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {cause}", path.display())]
    Write {
        /// Path of the file.
        path: PathBuf,
        /// Cause of the error.
        cause: io::Error,
    },
}

impl WriteError {
    /// Converts an I/O error of the file at `path`.
    pub(super) fn at(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |cause| Self::Write { path, cause }
    }
}

/// Writes a file so that, after a crash or a power loss at any instant, it is either complete or as before: writes and
/// synchronises a temporary file in the same folder, renames it, and synchronises the folder.
///
/// # Errors
/// [`WriteError::Write`].
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), WriteError> {
    let partial = partial_path(path);
    let write = || -> io::Result<()> {
        let mut file = File::create(&partial)?;
        file.write_all(contents)?;
        file.sync_all()?;
        fs::rename(&partial, path)?;
        sync_folder(path.parent().unwrap_or(Path::new("")))
    };
    write().map_err(|cause| {
        // The partial file is useless; failing to remove it does not justify a second error.
        let _ = fs::remove_file(&partial);
        WriteError::at(path)(cause)
    })
}

/// Returns the path at which a file is written before it is complete.
pub fn partial_path(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".partial");
    path.with_file_name(name)
}

/// Synchronises the names of the files in a folder to the disk.
pub(super) fn sync_folder(folder: &Path) -> io::Result<()> {
    // Elsewhere a folder cannot be opened as a file; the file system synchronises it by itself.
    if cfg!(unix) {
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        match File::open(folder)?.sync_all() {
            // Some network file systems synchronise files only.
            Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => Ok(()),
            result => result,
        }
    } else {
        Ok(())
    }
}

/// Removes a file if it exists.
pub(super) fn remove(path: &Path) -> Result<(), WriteError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(WriteError::at(path)(error)),
        _ => Ok(()),
    }
}
