//! Writes a recording: rows, texts and columns at any time of any timeline.

use std::io;
use std::path::{Path, PathBuf};

use rerun::log::{ChunkBatcherConfig, ChunkError};
use rerun::sink::LogSink;

use kinefront_model::workspace::GridError;
use kinefront_study::WriteError;
use rerun::{
    AsComponents, RecordingStream, RecordingStreamBuilder, RecordingStreamError, Scalars, SerializedComponentBatch,
    SerializedComponentColumn, SeriesLines, TextDocument, TimeColumn,
};

use super::colors::rgb;
use super::sink::RrdFile;
use super::{APPLICATION_ID, timelines};

/// Why a recording could not be written.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file cannot be written.
    #[error("cannot write the recording {}: {cause}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Cause of the failure.
        cause: io::Error,
    },
    /// A grid of the study does not fit its rotation range.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The recording was given up while it was written.
    #[error("the recording was abandoned")]
    GivenUp,
    /// Data cannot be encoded in Rerun's format.
    #[error("cannot encode the recording: {0}")]
    Encode(String),
}

impl RecordingError {
    /// Returns what makes an error of a file from its cause.
    pub(super) fn of_file(path: &Path) -> impl Fn(io::Error) -> Self {
        move |cause| Self::Write {
            path: path.to_owned(),
            cause,
        }
    }

    pub(super) fn encode(error: impl std::fmt::Display) -> Self {
        Self::Encode(error.to_string())
    }
}

impl From<WriteError> for RecordingError {
    fn from(error: WriteError) -> Self {
        match error {
            WriteError::Write { path, cause } => Self::Write { path, cause },
            error => Self::Write {
                path: PathBuf::new(),
                cause: io::Error::other(error),
            },
        }
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

/// The time of a row: a value on each of its timelines, a number or, on the timeline `time`, nanoseconds; empty for static data.
pub(super) type Moment<'a> = &'a [(&'static str, usize)];

/// The moment of static data.
pub(super) const ALWAYS: Moment<'static> = &[];

/// A recording being written, to a file or to another sink.
pub(super) struct RecordingWriter {
    file: Option<(PathBuf, RrdFile)>,
    recording: RecordingStream,
}

impl RecordingWriter {
    /// Creates the file; an existing file is an error.
    pub(super) fn create(path: &Path, name: &str) -> Result<Self, RecordingError> {
        let file = RrdFile::create(path).map_err(RecordingError::of_file(path))?;
        Self::over(&file, path, Self::builder().recording_name(name))
    }

    /// Writes the stream that `recording` builds to a file that is already open.
    pub(super) fn over(file: &RrdFile, path: &Path, recording: RecordingStreamBuilder) -> Result<Self, RecordingError> {
        let recording = recording.set_sinks(vec![Box::new(file.clone()) as Box<dyn LogSink>])?;
        recording.set_log_time_enabled(false);
        Ok(Self {
            file: Some((path.to_owned(), file.clone())),
            recording,
        })
    }

    /// Writes to `sink`.
    pub(super) fn sending(sink: Box<dyn LogSink>, name: &str) -> Result<Self, RecordingError> {
        let recording = Self::builder().recording_name(name).set_sinks(vec![sink])?;
        recording.set_log_time_enabled(false);
        Ok(Self { file: None, recording })
    }

    /// Returns a builder of a stream with Kinefront's application id. Rows are written as columns, many at a time, so
    /// the SDK's own batching is disabled.
    pub(super) fn builder() -> RecordingStreamBuilder {
        RecordingStreamBuilder::new(APPLICATION_ID)
            .enabled(true)
            .batcher_config(ChunkBatcherConfig::NEVER)
    }

    pub(super) fn stream(&self) -> &RecordingStream {
        &self.recording
    }

    /// Writes one row of an entity, with as many instances as the archetype has.
    pub(super) fn row(
        &self,
        entity: &str,
        moment: Moment<'_>,
        archetype: &dyn AsComponents,
    ) -> Result<(), RecordingError> {
        self.batches(entity, moment, archetype.as_serialized_batches())
    }

    /// Writes one row of an entity from serialized components.
    pub(super) fn batches(
        &self,
        entity: &str,
        moment: Moment<'_>,
        batches: Vec<SerializedComponentBatch>,
    ) -> Result<(), RecordingError> {
        let times = moment.iter().map(|&(timeline, time)| match timeline {
            timelines::TIME => TimeColumn::new_duration_nanos(timeline, [time as i64]),
            _ => TimeColumn::new_sequence(timeline, [time as i64]),
        });
        let columns: Vec<SerializedComponentColumn> = batches
            .into_iter()
            .map(|batch| {
                let count = batch.array.len();
                batch.partitioned([count]).map_err(RecordingError::encode)
            })
            .collect::<Result<_, _>>()?;
        Ok(self.recording.send_columns(entity, times, columns)?)
    }

    /// Writes values over time, drawn as a curve with a name and a colour.
    pub(super) fn curve(
        &self,
        entity: &str,
        name: String,
        color: [u8; 3],
        times: TimeColumn,
        values: impl Iterator<Item = f64>,
    ) -> Result<(), RecordingError> {
        let line = SeriesLines::new().with_names([name]).with_colors([rgb(color)]);
        self.row(entity, ALWAYS, &line)?;
        let columns = Scalars::new(values).columns_of_unit_batches();
        let columns = columns.map_err(RecordingError::encode)?;
        Ok(self.recording.send_columns(entity, [times], columns)?)
    }

    /// Writes a markdown document.
    pub(super) fn text(&self, entity: &str, moment: Moment<'_>, markdown: &str) -> Result<(), RecordingError> {
        self.row(entity, moment, &TextDocument::from_markdown(markdown))
    }

    /// Returns the first write error so far, if there is one.
    pub(super) fn check(&self) -> Result<(), RecordingError> {
        let Some((path, file)) = &self.file else {
            return Ok(());
        };
        file.check().map_err(RecordingError::of_file(path))
    }

    /// Writes the footer and closes the file.
    pub(super) fn close(self) -> Result<(), RecordingError> {
        let Self { file, recording } = self;
        let flushed = recording.flush_blocking().map_err(io::Error::other);
        // This is the last handle. Dropping it joins the SDK's threads, after which nothing more is sent.
        drop(recording);
        let Some((path, file)) = file else {
            return Ok(());
        };
        flushed
            .and_then(|()| file.finish())
            .map_err(RecordingError::of_file(&path))
    }
}
