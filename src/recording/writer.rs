//! A recording being written: rows, texts and columns at any point of any timeline.

use std::io;
use std::path::{Path, PathBuf};

use rerun::log::{ChunkBatcherConfig, ChunkError};
use rerun::sink::LogSink;
use rerun::{
    AsComponents, RecordingStream, RecordingStreamBuilder, RecordingStreamError, SerializedComponentColumn,
    TextDocument, TimeColumn,
};

use super::APPLICATION_ID;
use super::sink::RrdFile;

/// Why a recording could not be written.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file.
    #[error("cannot write the recording {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Data did not fit Rerun's format.
    #[error("cannot encode the recording: {0}")]
    Encode(String),
}

impl RecordingError {
    pub(super) fn encode(error: impl std::fmt::Display) -> Self {
        Self::Encode(error.to_string())
    }
}

impl From<RecordingStreamError> for RecordingError {
    fn from(error: RecordingStreamError) -> Self {
        Self::encode(error)
    }
}

impl From<ChunkError> for RecordingError {
    fn from(error: ChunkError) -> Self {
        Self::encode(error)
    }
}

/// Where a row stands: a value on each of its timelines; none for what holds always.
pub(super) type Moment<'a> = &'a [(&'static str, usize)];

/// What holds always.
pub(super) const ALWAYS: Moment<'static> = &[];

/// A recording file being written.
pub(super) struct Writer {
    path: PathBuf,
    file: RrdFile,
    recording: RecordingStream,
}

impl Writer {
    /// Creates the file; an existing one is refused.
    pub(super) fn create(path: &Path, name: &str) -> Result<Self, RecordingError> {
        let file = RrdFile::create(path).map_err(|source| RecordingError::Write {
            path: path.to_owned(),
            source,
        })?;
        // Rows are written as columns, many at a time: nothing is left for the SDK's own batching to do.
        let recording = RecordingStreamBuilder::new(APPLICATION_ID)
            .recording_name(name)
            .enabled(true)
            .batcher_config(ChunkBatcherConfig::NEVER)
            .set_sinks(vec![Box::new(file.clone()) as Box<dyn LogSink>])?;
        recording.set_log_time_enabled(false);
        Ok(Self {
            path: path.to_owned(),
            file,
            recording,
        })
    }

    pub(super) fn stream(&self) -> &RecordingStream {
        &self.recording
    }

    /// One row of an entity, with as many instances as the archetype holds.
    pub(super) fn row(
        &self,
        entity: &str,
        moment: Moment<'_>,
        archetype: &dyn AsComponents,
    ) -> Result<(), RecordingError> {
        let times = moment
            .iter()
            .map(|&(timeline, time)| TimeColumn::new_sequence(timeline, [time as i64]));
        let columns: Vec<SerializedComponentColumn> = archetype
            .as_serialized_batches()
            .into_iter()
            .map(|batch| {
                let count = batch.array.len();
                batch.partitioned([count]).map_err(RecordingError::encode)
            })
            .collect::<Result<_, _>>()?;
        Ok(self.recording.send_columns(entity, times, columns)?)
    }

    /// A markdown document.
    pub(super) fn text(&self, entity: &str, moment: Moment<'_>, markdown: &str) -> Result<(), RecordingError> {
        self.row(entity, moment, &TextDocument::from_markdown(markdown))
    }

    /// Whether all went well so far.
    pub(super) fn check(&self) -> Result<(), RecordingError> {
        self.file.check().map_err(|source| RecordingError::Write {
            path: self.path.clone(),
            source,
        })
    }

    /// Writes the footer and closes the file.
    pub(super) fn close(self) -> Result<(), RecordingError> {
        let Self { path, file, recording } = self;
        let flushed = recording.flush_blocking().map_err(io::Error::other);
        // The last handle: dropping it joins the SDK's threads, after which nothing more is sent.
        drop(recording);
        flushed
            .and_then(|()| file.finish())
            .map_err(|source| RecordingError::Write { path, source })
    }
}
