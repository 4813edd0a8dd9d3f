//! Reads Kinefront's recordings back, and copies a recording that is still being written.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

use rerun::external::arrow::array::{Array, BooleanArray, Float64Array, StringArray};
use rerun::external::re_log_encoding::{DecodeError, Decoder};
use rerun::log::{Chunk, LogMsg};
use rerun::sink::LogSink;
use rerun::{StoreId, StoreKind, TimelineName};

use super::design;
use super::sink::RrdFile;
use super::writer::{RecordingError, RecordingWriter};
use super::{paths, timelines};
use kinefront_model::evaluation::{Evaluation, Model};

/// Why a recording cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Cause of the failure.
        cause: io::Error,
    },
    /// The file is not a recording, or not one written by Kinefront.
    #[error("{} is not a recording of a run: {message}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What is missing or cannot be decoded.
        message: String,
    },
}

/// A design as recorded; the columns have the names of `designs.csv`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RecordedDesign {
    /// Generation, from 1.
    pub generation: usize,
    /// Text columns by name.
    pub texts: BTreeMap<String, String>,
    /// Numeric columns by name; true and false are 1 and 0.
    pub numbers: BTreeMap<String, f64>,
}

/// The data of a run that a recording contains.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RecordedRun {
    /// The study as run, as TOML.
    pub study: String,
    /// Every evaluated design, in order.
    pub designs: Vec<RecordedDesign>,
}

type Messages = Box<dyn Iterator<Item = Result<LogMsg, DecodeError>>>;

fn messages(path: &Path) -> Result<Messages, ReadError> {
    let file = File::open(path).map_err(|cause| ReadError::Read {
        path: path.to_owned(),
        cause,
    })?;
    let decoder = Decoder::<LogMsg>::decode_eager(BufReader::new(file)).map_err(|error| foreign(path, error))?;
    Ok(Box::new(decoder))
}

pub(super) fn foreign(path: &Path, message: impl std::fmt::Display) -> ReadError {
    ReadError::Foreign {
        path: path.to_owned(),
        message: message.to_string(),
    }
}

/// Reads the study and the designs of a recorded run. An incomplete message at the end, left by a run that was killed,
/// is ignored.
///
/// # Errors
/// [`ReadError`] when the file cannot be read or is not a recording of a run.
pub fn read_run(path: &Path) -> Result<RecordedRun, ReadError> {
    let mut run = RecordedRun::default();
    for message in messages(path)? {
        let Ok(message) = message else { break };
        let LogMsg::ArrowMsg(store, message) = message else {
            continue;
        };
        if store.kind() != StoreKind::Recording {
            continue;
        }
        let chunk = Chunk::from_arrow_msg(&message).map_err(|error| foreign(path, error))?;
        match chunk.entity_path().to_string().as_str() {
            paths::DESIGNS => designs(&chunk, &mut run.designs),
            paths::STUDY => run.study = study(&chunk).unwrap_or_default(),
            _ => {}
        }
    }
    if run.study.is_empty() {
        return Err(foreign(path, format!("there is no study at {}", paths::STUDY)));
    }
    Ok(run)
}

/// Extracts the TOML from the study's document.
fn study(chunk: &Chunk) -> Option<String> {
    let texts = chunk.components().list_arrays().find_map(|list| {
        let row = list.iter().flatten().next()?;
        let texts = row.as_any().downcast_ref::<StringArray>()?;
        let text = texts.iter().flatten().next()?.to_owned();
        text.contains("```toml").then_some(text)
    })?;
    let (_, rest) = texts.split_once("```toml\n")?;
    let (toml, _) = rest.rsplit_once("```")?;
    Some(toml.to_owned())
}

fn designs(chunk: &Chunk, designs: &mut Vec<RecordedDesign>) {
    let first = designs.len();
    designs.resize(first + chunk.num_rows(), RecordedDesign::default());
    let rows = &mut designs[first..];
    let generation = TimelineName::try_new(timelines::GENERATION).ok();
    if let Some(column) = generation.and_then(|name| chunk.timelines().get(&name)) {
        for (row, &time) in rows.iter_mut().zip(column.times_raw()) {
            row.generation = usize::try_from(time).unwrap_or(0);
        }
    }
    let components = chunk.components();
    for (descriptor, list) in components.component_descriptors().zip(components.list_arrays()) {
        let name = descriptor.component.to_string();
        for (row, values) in rows.iter_mut().zip(list.iter()) {
            let Some(values) = values.filter(|values| !values.is_empty()) else {
                continue;
            };
            let any = values.as_any();
            if let Some(numbers) = any.downcast_ref::<Float64Array>() {
                row.numbers.insert(name.clone(), numbers.value(0));
            } else if let Some(texts) = any.downcast_ref::<StringArray>() {
                row.texts.insert(name.clone(), texts.value(0).to_owned());
            } else if let Some(flags) = any.downcast_ref::<BooleanArray>() {
                row.numbers.insert(name.clone(), f64::from(u8::from(flags.value(0))));
            }
        }
    }
}

/// Why a recording cannot be copied.
#[derive(Debug, thiserror::Error)]
pub enum CopyError {
    /// The recording cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The copy, or the design that it shows, cannot be written.
    #[error(transparent)]
    Write(#[from] RecordingError),
}

/// Copies the recording at `from`, as far as it has been written, to `to`, which must not exist; `shown` is a design
/// that the views of the copy show at its last moment.
///
/// # Errors
/// [`CopyError`], which names the file that cannot be read or written.
pub fn save_copy(from: &Path, to: &Path, shown: Option<(&Model, &Evaluation, &str)>) -> Result<(), CopyError> {
    let read = messages(from)?;
    let failed = RecordingError::of_file(to);
    let file = RrdFile::create(to).map_err(&failed)?;
    let mut recording: Option<StoreId> = None;
    let mut last = [(timelines::EVALUATION, 0), (timelines::GENERATION, 0)];
    for message in read {
        // The run may still be writing the last message.
        let Ok(message) = message else { break };
        if let LogMsg::ArrowMsg(store, arrow) = &message
            && store.kind() == StoreKind::Recording
        {
            recording = Some(store.clone());
            if let Ok(chunk) = Chunk::from_arrow_msg(arrow) {
                for (name, time) in &mut last {
                    let latest = TimelineName::try_new(name)
                        .ok()
                        .and_then(|name| chunk.timelines().get(&name)?.times_raw().last().copied());
                    *time = latest
                        .and_then(|latest| usize::try_from(latest).ok())
                        .unwrap_or(0)
                        .max(*time);
                }
            }
        }
        file.send(message);
        file.check().map_err(&failed)?;
    }
    if let Some(((model, evaluation, heading), store)) = shown.zip(recording) {
        let builder = RecordingWriter::builder().recording_id(store.recording_id().clone());
        let writer = RecordingWriter::over(&file, to, builder)?;
        design::record_step(&writer, &last, model, evaluation, None, None, heading)?;
        writer.close()?;
    } else {
        file.finish().map_err(failed)?;
    }
    Ok(())
}
