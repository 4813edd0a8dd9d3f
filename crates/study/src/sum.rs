//! Size and checksum of a file, by which damage is told from a shorter run.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::open_regular;

/// Size and checksum of a file, or of the rows of a table up to a checkpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileSum {
    /// Number of rows of a table, without its header.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<usize>,
    /// Number of bytes.
    pub bytes: u64,
    /// CRC-32 (IEEE 802.3) of the bytes.
    pub crc32: u32,
}

/// How a file differs from what was written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Difference {
    /// The file is shorter.
    #[error("it has {found} bytes, but the run wrote {}", written(.sum))]
    Shorter {
        /// Size of the file.
        found: u64,
        /// What was written.
        sum: FileSum,
    },
    /// The file is longer.
    #[error("it has {found} bytes, but the run wrote {}", written(.sum))]
    Longer {
        /// Size of the file.
        found: u64,
        /// What was written.
        sum: FileSum,
    },
    /// Bytes were changed.
    #[error("its checksum is {found:08x}, but the {} that the run wrote have {:08x}: bytes were changed", written(.sum), .sum.crc32)]
    Changed {
        /// Checksum of the same number of bytes of the file.
        found: u32,
        /// What was written.
        sum: FileSum,
    },
}

fn written(sum: &FileSum) -> String {
    match sum.rows {
        Some(rows) => format!("{} bytes ({rows} rows)", sum.bytes),
        None => format!("{} bytes", sum.bytes),
    }
}

impl FileSum {
    /// The sum of a whole file that is not a table.
    pub fn of(contents: &[u8]) -> Self {
        Self {
            rows: None,
            bytes: contents.len() as u64,
            crc32: crc32fast::hash(contents),
        }
    }

    /// Compares a file, which may be longer if `may_grow`, with its sum.
    ///
    /// # Errors
    /// The I/O error if the file cannot be read.
    pub fn compare(&self, path: &Path, may_grow: bool) -> io::Result<Option<Difference>> {
        let file = open_regular(path, u64::MAX)?;
        let found = file.metadata()?.len();
        if found < self.bytes {
            return Ok(Some(Difference::Shorter { found, sum: *self }));
        }
        if found > self.bytes && !may_grow {
            return Ok(Some(Difference::Longer { found, sum: *self }));
        }
        let found = checksum(file, self.bytes)?.finalize();
        Ok((found != self.crc32).then_some(Difference::Changed { found, sum: *self }))
    }
}

/// Returns the state of the checksum after the first `bytes` bytes of a file.
pub(super) fn checksum(file: File, bytes: u64) -> io::Result<crc32fast::Hasher> {
    let mut hasher = crc32fast::Hasher::new();
    let mut reader = BufReader::new(file).take(bytes);
    let mut buffer = vec![0; 1 << 16];
    loop {
        let count = reader.read(&mut buffer)?;
        if count == 0 {
            return Ok(hasher);
        }
        hasher.update(&buffer[..count]);
    }
}
