//! `designs.csv` as it grows.

use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::DESIGNS;
use super::lock::is_same_file;
use crate::FileSum;
use crate::sum::checksum;
use crate::table::{Column, TableRow, rows_as_csv, table_bytes};
use crate::{Batch, Study};
use crate::{WriteError, read_regular};

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
        let cells = |entry: TableRow| self.columns.iter().map(|column| column.cell(&entry)).collect();
        let text = rows_as_csv(batch.entries().map(cells)).map_err(WriteError::at(&self.path))?;
        self.append_bytes(&text, batch.rows.len())
    }

    /// Appends complete rows; if that fails, removes what was written of them.
    fn append_bytes(&mut self, text: &[u8], rows: usize) -> Result<(), WriteError> {
        // Where the file is not open for appending, its cursor has to follow.
        let end = self.file.seek(SeekFrom::Start(self.sum.bytes));
        if let Err(error) = end.and_then(|_| self.file.write_all(text)) {
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
