//! Rows of several entities, collected so that many of them are written as one chunk.
//!
//! The file's index has an entry for each chunk, which takes a few kilobytes of memory until the file is closed. A chunk of
//! one row per generation would therefore take more memory than the designs.

use std::collections::BTreeMap;

use rerun::external::arrow::array::{Array, ArrayRef};
use rerun::external::arrow::compute::concat;
use rerun::{AsComponents, SerializedComponentBatch, SerializedComponentColumn, TimeColumn};

use super::writer::{Moment, RecordingError, RecordingWriter};

/// Rows that are still to be written, by entity.
#[derive(Default)]
pub(super) struct RowBuffer(BTreeMap<String, Vec<BufferedRow>>);

struct BufferedRow {
    times: Vec<(&'static str, i64)>,
    batches: Vec<SerializedComponentBatch>,
}

impl BufferedRow {
    /// Whether two rows have the same timelines and components, so that one chunk can hold both.
    fn is_like(&self, other: &Self) -> bool {
        let lines = |row: &Self| row.times.iter().map(|&(line, _)| line).collect::<Vec<_>>();
        let parts = |row: &Self| {
            row.batches
                .iter()
                .map(|batch| batch.descriptor.clone())
                .collect::<Vec<_>>()
        };
        lines(self) == lines(other) && parts(self) == parts(other)
    }
}

impl RowBuffer {
    /// Adds one row of an entity.
    pub(super) fn add(&mut self, entity: &str, moment: Moment<'_>, archetype: &dyn AsComponents) {
        let row = BufferedRow {
            times: moment.iter().map(|&(line, time)| (line, time as i64)).collect(),
            batches: archetype.as_serialized_batches(),
        };
        match self.0.get_mut(entity) {
            Some(rows) => rows.push(row),
            None => {
                self.0.insert(entity.to_owned(), vec![row]);
            }
        }
    }

    /// Writes all rows.
    pub(super) fn write(&mut self, writer: &RecordingWriter) -> Result<(), RecordingError> {
        for (entity, rows) in std::mem::take(&mut self.0) {
            for rows in rows.chunk_by(BufferedRow::is_like) {
                writer
                    .stream()
                    .send_columns(entity.as_str(), times(rows), columns(rows)?)?;
            }
        }
        Ok(())
    }
}

fn times(rows: &[BufferedRow]) -> Vec<TimeColumn> {
    let lines = rows[0].times.iter().enumerate();
    lines
        .map(|(place, &(line, _))| TimeColumn::new_sequence(line, rows.iter().map(|row| row.times[place].1)))
        .collect()
}

fn columns(rows: &[BufferedRow]) -> Result<Vec<SerializedComponentColumn>, RecordingError> {
    let components = rows[0].batches.iter().enumerate();
    components
        .map(|(place, first)| {
            let arrays: Vec<&ArrayRef> = rows.iter().map(|row| &row.batches[place].array).collect();
            let lengths: Vec<usize> = arrays.iter().map(|array| array.len()).collect();
            let arrays: Vec<&dyn Array> = arrays.iter().map(|array| array.as_ref()).collect();
            let joined = concat(&arrays).map_err(RecordingError::encode)?;
            SerializedComponentBatch::new(joined, first.descriptor.clone())
                .partitioned(lengths)
                .map_err(RecordingError::encode)
        })
        .collect()
}
