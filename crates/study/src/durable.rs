//! Files that survive a crash: a file is written beside its place, synchronised, and moved there.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Error of writing a run folder.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The folder already holds a run.
    #[error(
        "{} already holds a run ({found}); continue it with --resume, choose another folder, or move the existing one",
        path.display()
    )]
    Occupied {
        /// Path of the folder.
        path: PathBuf,
        /// Name of a file of the run that it holds.
        found: &'static str,
    },
    /// Another process writes the run.
    #[error("{} is in use: another process is writing its run", .0.display())]
    InUse(PathBuf),
    /// Something else than a file has the name of a file of a run.
    #[error("{} is not a regular file; a run writes only regular files and does not follow links", .0.display())]
    NotAFile(PathBuf),
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
/// synchronises a temporary file in the same folder, renames it, and synchronises the folder. A link at `path` is replaced; what it
/// leads to is not touched.
///
/// # Errors
/// [`WriteError::Write`].
pub fn write_whole(path: &Path, contents: &[u8]) -> Result<(), WriteError> {
    let write = || -> io::Result<()> {
        // The name is random and the file new, so that nothing that lies in the folder is written to.
        let mut file = temporary(folder_of(path))?;
        file.write_all(contents)?;
        file.as_file().sync_all()?;
        persist(file, path)?;
        sync_folder(folder_of(path))
    };
    write().map_err(WriteError::at(path))
}

/// Replaces a file by one that `write` creates at the path that it is given; until that one is complete, the file is as before.
///
/// # Errors
/// The error of `write`, or [`WriteError::Write`].
pub fn replace<E: From<WriteError>>(path: &Path, write: impl FnOnce(&Path) -> Result<(), E>) -> Result<(), E> {
    let folder = folder_of(path);
    let in_folder = |folder| {
        tempfile::Builder::new()
            .prefix(PREFIX)
            .suffix(PARTIAL)
            .tempdir_in(folder)
    };
    let place = existing(folder).and_then(in_folder).map_err(WriteError::at(path))?;
    let part = place.path().join(path.file_name().unwrap_or_default());
    write(&part)?;
    fs::rename(&part, path).map_err(WriteError::at(path))?;
    sync_folder(folder_of(path)).map_err(WriteError::at(path))?;
    Ok(())
}

/// Both ends of the names of temporary files.
const PREFIX: &str = ".kinefront-";
const PARTIAL: &str = ".partial";

/// Creates a temporary file that others may read, as far as the mask of the process allows.
fn temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    existing(folder)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(PARTIAL);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// Returns a folder if it exists: the error of a temporary file in one that does not would name that file.
fn existing(folder: &Path) -> io::Result<&Path> {
    let missing = || {
        io::Error::new(
            io::ErrorKind::NotFound,
            format!("there is no folder {}", folder.display()),
        )
    };
    if folder.is_dir() { Ok(folder) } else { Err(missing()) }
}

/// Moves a complete temporary file to its place.
///
/// Windows refuses to replace a file that another program has open, if only to show it or to look for viruses; such a program is
/// awaited for a second.
fn persist(mut file: tempfile::NamedTempFile, path: &Path) -> io::Result<()> {
    let mut patience = if cfg!(windows) { 50 } else { 0 };
    loop {
        match file.persist(path) {
            Ok(_) => return Ok(()),
            Err(refused) if patience > 0 && refused.error.kind() == io::ErrorKind::PermissionDenied => {
                file = refused.file;
                patience -= 1;
                std::thread::sleep(Duration::from_millis(20));
            }
            Err(refused) => return Err(refused.error),
        }
    }
}

fn folder_of(path: &Path) -> &Path {
    or_here(path.parent().unwrap_or(Path::new("")))
}

/// Returns the path of a folder by which the system finds it: an empty one is the folder in which the process is.
pub(super) fn or_here(folder: &Path) -> &Path {
    match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    }
}

/// Removes the temporary files that a process left in a folder when it was killed.
pub(super) fn sweep(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_temporary = name.starts_with(PREFIX) && name.ends_with(PARTIAL);
        if is_temporary && entry.file_type()?.is_file() {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Opens a regular file of at most `most` bytes; a pipe or a device, which may have no end, is an error.
///
/// # Errors
/// The I/O error, which says what the file is instead.
pub fn open_regular(path: &Path, most: u64) -> io::Result<File> {
    // A pipe that nobody writes to is not even opened.
    let is_regular = |found: fs::Metadata| match found.is_file() {
        true => Ok(found.len()),
        false => Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file")),
    };
    is_regular(fs::metadata(path)?)?;
    let file = File::open(path)?;
    let length = is_regular(file.metadata()?)?;
    if length > most {
        let message = format!("it has {length} bytes, but such a file has at most {most}");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    Ok(file)
}

/// Reads a regular file of at most `most` bytes.
///
/// # Errors
/// As [`open_regular`].
pub fn read_regular(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut contents = Vec::new();
    // A file that grows meanwhile is read as far as it was known.
    open_regular(path, most)?.take(most).read_to_end(&mut contents)?;
    Ok(contents)
}

/// Synchronises the names of the files in a folder to the disk.
pub(super) fn sync_folder(folder: &Path) -> io::Result<()> {
    // Elsewhere a folder cannot be opened as a file; the file system synchronises it by itself.
    if cfg!(unix) {
        match File::open(or_here(folder))?.sync_all() {
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
