//! The lock of a run folder: its table, which one process at a time may write. It ends with the process.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::Path;
use std::time::Duration;

use super::DESIGNS;
use crate::WriteError;

/// Number of times that a lock is awaited for 10 ms.
const PATIENCE: u32 = 30;

/// Opens and locks the table of a run folder, which is the lock of the folder.
pub(super) fn open_locked(folder: &Path, create: bool) -> Result<File, WriteError> {
    let path = folder.join(DESIGNS);
    // Rows are not written to what a link leads to, nor to a pipe.
    if fs::symlink_metadata(&path).is_ok_and(|found| !found.is_file()) {
        return Err(WriteError::NotAFile(path));
    }
    let mut lock = open_alone(&path, create);
    // The lock of a process that has just ended may be held for a moment by a process that it was starting.
    let mut patience = PATIENCE;
    while matches!(lock, Err(TryLockError::WouldBlock)) && patience > 0 {
        std::thread::sleep(Duration::from_millis(10));
        patience -= 1;
        lock = open_alone(&path, create);
    }
    lock.map_err(|error| match error {
        TryLockError::WouldBlock => WriteError::InUse(folder.to_owned()),
        TryLockError::Error(cause) => WriteError::at(&path)(cause),
    })
}

/// Opens a file that no other process writes, for reading and writing. Others may read it.
///
/// # Errors
/// [`TryLockError::WouldBlock`] if another process writes it, or the I/O error.
#[cfg(not(windows))]
fn open_alone(path: &Path, create: bool) -> Result<File, TryLockError> {
    /// `ENOLCK` of Linux: a network file system without a lock service.
    const NO_LOCKS: i32 = 37;
    // Rows are appended whatever another program does to the file; a file truncated by others has no gap then.
    let file = OpenOptions::new()
        .read(true)
        .append(true)
        .create(create)
        .open(path)
        .map_err(TryLockError::Error)?;
    match file.try_lock() {
        // A file system without locks cannot guard the folder; the run goes on as its user asked.
        Err(TryLockError::Error(error))
            if error.kind() == io::ErrorKind::Unsupported || error.raw_os_error() == Some(NO_LOCKS) =>
        {
            Ok(file)
        }
        lock => lock.map(|()| file),
    }
}

/// Opens a file that no other process writes, for reading and writing. Others may read it.
///
/// A lock of Windows also keeps others from reading, and a file that is opened for appending cannot be shortened. The file is
/// therefore opened without a lock, and not shared with others that would write, move or remove it.
///
/// # Errors
/// [`TryLockError::WouldBlock`] if another process writes it, or the I/O error.
#[cfg(windows)]
fn open_alone(path: &Path, create: bool) -> Result<File, TryLockError> {
    use std::os::windows::fs::OpenOptionsExt;
    const FILE_SHARE_READ: u32 = 1;
    const ERROR_SHARING_VIOLATION: i32 = 32;
    let file = OpenOptions::new()
        .read(true)
        .write(true)
        .create(create)
        .truncate(false)
        .share_mode(FILE_SHARE_READ)
        .open(path);
    file.map_err(|error: io::Error| match error.raw_os_error() {
        Some(ERROR_SHARING_VIOLATION) => TryLockError::WouldBlock,
        _ => TryLockError::Error(error),
    })
}

/// Whether what is found at a path is the file that is open.
#[cfg(unix)]
pub(super) fn is_same_file(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// Whether what is found at a path is the file that is open, which nobody can move or remove.
#[cfg(not(unix))]
pub(super) fn is_same_file(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    true
}
