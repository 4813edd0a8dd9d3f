//! `designs.csv` as it grows; it is also the lock of its folder.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::DESIGNS;
use crate::FileSum;
use crate::sum::checksum;
use crate::table::{Column, append_row, table_bytes};
use crate::{Batch, Study};
use crate::{WriteError, read_regular};

/// `ENOLCK` of Linux: a network file system without a lock service.
const NO_LOCKS: i32 = 37;

/// Number of times that a lock is awaited for 10 ms.
const LOCK_PATIENCE: u32 = 30;

/// Opens and locks the table of a run folder, which is the lock of the folder.
pub(super) fn open_locked(folder: &Path, create: bool) -> Result<File, WriteError> {
    let path = folder.join(DESIGNS);
    // Rows are not written to what a link leads to, nor to a pipe.
    if fs::symlink_metadata(&path).is_ok_and(|found| !found.is_file()) {
        return Err(WriteError::NotAFile(path));
    }
    // Rows are appended whatever another program does to the file; a file truncated by others has no gap then.
    let file = OpenOptions::new()
        .read(true)
        .append(true)
        .create(create)
        .open(&path)
        .map_err(WriteError::at(&path))?;
    let mut lock = file.try_lock();
    // The lock of a process that has just ended may be held for a moment by a process that it was starting.
    let mut patience = LOCK_PATIENCE;
    while matches!(lock, Err(TryLockError::WouldBlock)) && patience > 0 {
        std::thread::sleep(Duration::from_millis(10));
        patience -= 1;
        lock = file.try_lock();
    }
    match lock {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(WriteError::InUse(folder.to_owned())),
        // A file system without locks cannot guard the folder; the run goes on as its user asked.
        Err(TryLockError::Error(error))
            if error.kind() == io::ErrorKind::Unsupported || error.raw_os_error() == Some(NO_LOCKS) =>
        {
            Ok(file)
        }
        Err(TryLockError::Error(error)) => Err(WriteError::at(&path)(error)),
    }
}

/// `designs.csv` as it grows.
#[derive(Debug)]
pub(super) struct DesignTable {
    file: File,
    path: PathBuf,
    columns: Vec<Column>,
    /// Sum of the rows that were written.
    pub sum: FileSum,
    checksum: crc32fast::Hasher,
}

impl DesignTable {
    /// Takes the table of a folder that is open and locked; it counts as empty.
    pub(super) fn over(file: File, folder: &Path, study: &Study) -> Self {
        Self {
            file,
            path: folder.join(DESIGNS),
            columns: Column::of_designs(study).collect(),
            sum: FileSum {
                rows: Some(0),
                bytes: 0,
                crc32: 0,
            },
            checksum: crc32fast::Hasher::new(),
        }
    }

    /// Whether the file has nothing but a header, or a part of one, left by a start that was killed.
    pub(super) fn is_begun_at_most(&self) -> Result<bool, WriteError> {
        let header = table_bytes(self.columns.iter().copied(), []).map_err(WriteError::at(&self.path))?;
        let length = self.file.metadata().map_err(WriteError::at(&self.path))?.len();
        if length > header.len() as u64 {
            return Ok(false);
        }
        let found = read_regular(&self.path, header.len() as u64).map_err(WriteError::at(&self.path))?;
        Ok(header.starts_with(&found))
    }

    /// Empties the table and writes its header.
    pub(super) fn begin(&mut self) -> Result<(), WriteError> {
        let header = table_bytes(self.columns.iter().copied(), []).map_err(WriteError::at(&self.path))?;
        self.file.set_len(0).map_err(WriteError::at(&self.path))?;
        self.append_bytes(&header, 0)
    }

    /// Keeps the first `rows` rows of the table, which end at byte `bytes`.
    pub(super) fn keep(&mut self, rows: usize, bytes: u64) -> Result<(), WriteError> {
        let keep = || -> io::Result<crc32fast::Hasher> {
            self.file.set_len(bytes)?;
            checksum(File::open(&self.path)?, bytes)
        };
        self.checksum = keep().map_err(WriteError::at(&self.path))?;
        self.sum = FileSum {
            rows: Some(rows),
            bytes,
            crc32: self.checksum.clone().finalize(),
        };
        Ok(())
    }

    pub(super) fn append(&mut self, batch: &Batch) -> Result<(), WriteError> {
        let text = || -> io::Result<Vec<u8>> {
            let mut table = csv::Writer::from_writer(Vec::new());
            for entry in batch.entries() {
                append_row(&mut table, self.columns.iter().map(|column| column.cell(&entry)))?;
            }
            table.into_inner().map_err(|error| error.into_error())
        };
        let text = text().map_err(WriteError::at(&self.path))?;
        self.append_bytes(&text, batch.rows.len())
    }

    /// Appends complete rows; if that fails, removes what was written of them.
    fn append_bytes(&mut self, text: &[u8], rows: usize) -> Result<(), WriteError> {
        if let Err(error) = self.file.write_all(text) {
            // Failing to remove the remains does not justify a second error: a reader ignores a cut last row.
            let _ = self.file.set_len(self.sum.bytes);
            return Err(WriteError::at(&self.path)(error));
        }
        self.checksum.update(text);
        self.sum = FileSum {
            rows: Some(self.sum.rows.unwrap_or(0) + rows),
            bytes: self.sum.bytes + text.len() as u64,
            crc32: self.checksum.clone().finalize(),
        };
        Ok(())
    }

    pub(super) fn synchronize(&self) -> Result<(), WriteError> {
        self.file.sync_data().map_err(WriteError::at(&self.path))
    }

    /// Checks that the file at the path of the table is still this one and as long as it was written.
    pub(super) fn check(&self) -> Result<(), WriteError> {
        let changed = |message: String| {
            Err(WriteError::Changed {
                path: self.path.clone(),
                message,
            })
        };
        let found = match fs::metadata(&self.path) {
            Ok(found) => found,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return changed("it was removed or moved".to_owned());
            }
            Err(error) => return Err(WriteError::at(&self.path)(error)),
        };
        let own = self.file.metadata().map_err(WriteError::at(&self.path))?;
        if !is_same_file(&found, &own) {
            return changed("another file is in its place".to_owned());
        }
        if own.len() != self.sum.bytes {
            return changed(format!("it has {} bytes instead of {}", own.len(), self.sum.bytes));
        }
        Ok(())
    }
}

#[cfg(unix)]
fn is_same_file(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn is_same_file(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    a.created().ok() == b.created().ok()
}
