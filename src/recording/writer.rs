//! A recording being written: rows, texts and columns at any point of any timeline.

use std::io;
use std::path::{Path, PathBuf};

use rerun::log::{ChunkBatcherConfig, ChunkError};
use rerun::sink::LogSink;
use rerun::{
    AsComponents, RecordingStream, RecordingStreamBuilder, RecordingStreamError, SerializedComponentBatch,
    SerializedComponentColumn, TextDocument, TimeColumn,
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

/// A recording being written: to a file, or to whoever listens.
pub(super) struct Writer {
    file: Option<(PathBuf, RrdFile)>,
    recording: RecordingStream,
}

impl Writer {
    /// Creates the file; an existing one is refused.
    pub(super) fn create(path: &Path, name: &str) -> Result<Self, RecordingError> {
        let file = RrdFile::create(path).map_err(|source| RecordingError::Write {
            path: path.to_owned(),
            source,
        })?;
        Self::over(&file, path, Self::builder().recording_name(name))
    }

    /// Writes to a file that was begun what `recording` builds.
    pub(super) fn over(file: &RrdFile, path: &Path, recording: RecordingStreamBuilder) -> Result<Self, RecordingError> {
        let recording = recording.set_sinks(vec![Box::new(file.clone()) as Box<dyn LogSink>])?;
        recording.set_log_time_enabled(false);
        Ok(Self {
            file: Some((path.to_owned(), file.clone())),
            recording,
        })
    }

    /// Sends to `sink`.
    pub(super) fn sending(sink: Box<dyn LogSink>, name: &str) -> Result<Self, RecordingError> {
        let recording = Self::builder().recording_name(name).set_sinks(vec![sink])?;
        recording.set_log_time_enabled(false);
        Ok(Self { file: None, recording })
    }

    /// A stream of ours. Rows are written as columns, many at a time: nothing is left for the SDK's own batching to do.
    pub(super) fn builder() -> RecordingStreamBuilder {
        RecordingStreamBuilder::new(APPLICATION_ID)
            .enabled(true)
            .batcher_config(ChunkBatcherConfig::NEVER)
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
        self.batches(entity, moment, archetype.as_serialized_batches())
    }

    /// One row of an entity.
    pub(super) fn batches(
        &self,
        entity: &str,
        moment: Moment<'_>,
        batches: Vec<SerializedComponentBatch>,
    ) -> Result<(), RecordingError> {
        let times = moment
            .iter()
            .map(|&(timeline, time)| TimeColumn::new_sequence(timeline, [time as i64]));
        let columns: Vec<SerializedComponentColumn> = batches
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
        let Some((path, file)) = &self.file else {
            return Ok(());
        };
        file.check().map_err(|source| RecordingError::Write {
            path: path.clone(),
            source,
        })
    }

    /// Writes the footer and closes the file.
    pub(super) fn close(self) -> Result<(), RecordingError> {
        let Self { file, recording } = self;
        let flushed = recording.flush_blocking().map_err(io::Error::other);
        // The last handle: dropping it joins the SDK's threads, after which nothing more is sent.
        drop(recording);
        let Some((path, file)) = file else {
            return Ok(());
        };
        flushed
            .and_then(|()| file.finish())
            .map_err(|source| RecordingError::Write { path, source })
    }
}
