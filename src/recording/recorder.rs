//! Writes the events of a run to a `.rrd` file as they come.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use rerun::log::{ChunkBatcherConfig, ChunkError};
use rerun::sink::LogSink;
use rerun::{
    AsComponents, RecordingStream, RecordingStreamBuilder, RecordingStreamError, Scalars, SerializedComponentColumn,
    TextDocument, TimeColumn, Transform3D,
};

use super::scatter::{Frame, INFEASIBLE_COLOR, color, front_points, points, staircase};
use super::sink::RrdFile;
use super::{APPLICATION_ID, blueprint, columns, paths, timelines};
use crate::evaluation::Evaluation;
use crate::mechanism::Architecture;
use crate::study::{Batch, Event, FrontMember, GenerationSummary, RunSummary, Study};

/// Rows of `/designs` written at a time: enough that the file's index stays small.
const ROWS: usize = 300;

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

/// The recording of one run.
pub struct Recorder {
    path: PathBuf,
    file: RrdFile,
    recording: RecordingStream,
    architectures: Vec<Architecture>,
    frame: Frame,
    /// Rows not yet written: id, generation, evaluation.
    pending: Vec<(usize, usize, Evaluation)>,
    front: Vec<FrontMember>,
    front_changed: bool,
    frame_changed: bool,
}

/// Where a row stands on the timelines.
#[derive(Clone, Copy)]
struct Moment {
    evaluation: usize,
    generation: usize,
}

impl Recorder {
    /// Creates the file and writes what is known before the run: the layout and the study.
    ///
    /// # Errors
    /// [`RecordingError::Write`] when the file exists or cannot be created.
    pub fn create(path: &Path, study: &Study) -> Result<Self, RecordingError> {
        let file = RrdFile::create(path).map_err(|source| RecordingError::Write {
            path: path.to_owned(),
            source,
        })?;
        // Rows are written in columns, a batch at a time: nothing is left for the SDK's own batching to do.
        let recording = RecordingStreamBuilder::new(APPLICATION_ID)
            .recording_name(format!("{} (seed {})", study.name, study.optimizer.seed))
            .enabled(true)
            .batcher_config(ChunkBatcherConfig::NEVER)
            .set_sinks(vec![Box::new(file.clone()) as Box<dyn LogSink>])?;
        recording.set_log_time_enabled(false);
        let frame = Frame::new(study);
        let clouds: Vec<String> = study
            .architectures
            .iter()
            .map(|&architecture| cloud(architecture))
            .chain([paths::INFEASIBLE.to_owned()])
            .collect();
        blueprint::send_run_layout(&recording, &clouds)?;
        let recorder = Self {
            path: path.to_owned(),
            file,
            recording,
            architectures: study.architectures.clone(),
            frame,
            pending: Vec::new(),
            front: Vec::new(),
            front_changed: false,
            frame_changed: true,
        };
        recorder.text(paths::STUDY, &study_text(study)?)?;
        Ok(recorder)
    }

    /// Writes what a run tells until it ends, then closes the file.
    ///
    /// # Errors
    /// [`RecordingError`] at the first thing that cannot be written; the file stays readable up to there.
    pub fn follow(mut self, events: &Receiver<Arc<Event>>) -> Result<(), RecordingError> {
        for event in events {
            match &*event {
                Event::Evaluated(batch) => self.batch(batch)?,
                Event::Front(front) => {
                    self.front.clone_from(front);
                    self.front_changed = true;
                }
                Event::Generation(summary) => self.generation(summary)?,
                Event::Finished(summary) => self.finished(summary)?,
                Event::Started(_) | Event::Verifying { .. } | Event::Failed(_) => {}
            }
        }
        self.close()
    }

    fn batch(&mut self, batch: &Batch) -> Result<(), RecordingError> {
        let moment = Moment {
            evaluation: (batch.first_id + batch.evaluations.len()).saturating_sub(1),
            generation: batch.generation,
        };
        for evaluation in &batch.evaluations {
            self.frame_changed |= self.frame.include(evaluation);
        }
        for &architecture in Architecture::ALL {
            let kind: Vec<&Evaluation> = batch
                .evaluations
                .iter()
                .filter(|e| e.is_feasible() && e.design.architecture == architecture)
                .collect();
            self.cloud(&cloud(architecture), moment, &kind, color(architecture), 2.0)?;
        }
        let infeasible: Vec<&Evaluation> = batch
            .evaluations
            .iter()
            .filter(|e| !e.is_feasible() && self.frame.holds(e))
            .collect();
        let [r, g, b] = INFEASIBLE_COLOR;
        self.cloud(
            paths::INFEASIBLE,
            moment,
            &infeasible,
            rerun::Color::from_rgb(r, g, b),
            1.5,
        )?;
        let rows = batch.evaluations.iter().enumerate();
        self.pending
            .extend(rows.map(|(offset, e)| (batch.first_id + offset, batch.generation, e.clone())));
        if self.pending.len() >= ROWS {
            self.write_pending()?;
        }
        Ok(())
    }

    fn cloud(
        &self,
        entity: &str,
        moment: Moment,
        designs: &[&Evaluation],
        color: rerun::Color,
        size: f32,
    ) -> Result<(), RecordingError> {
        if designs.is_empty() {
            return Ok(());
        }
        self.row(entity, moment, &points(designs, color, size))
    }

    fn generation(&mut self, summary: &GenerationSummary) -> Result<(), RecordingError> {
        let moment = Moment {
            evaluation: summary.evaluations.saturating_sub(1),
            generation: summary.generation,
        };
        if self.frame_changed {
            self.row(paths::PLOT, moment, &Transform3D::from_scale(self.frame.scale()))?;
            self.row(paths::AXES, moment, &self.frame.lines())?;
            self.row(paths::TICKS, moment, &self.frame.labels())?;
            self.row(paths::LEGEND, moment, &self.frame.legend(&self.architectures))?;
            self.frame_changed = false;
        }
        if self.front_changed {
            self.row(paths::FRONT_DESIGNS, moment, &front_points(&self.front))?;
            self.row(paths::FRONT_LINE, moment, &staircase(&self.front, &self.frame))?;
            self.front_changed = false;
        }
        let share = summary.feasible as f64 / summary.evaluations.max(1) as f64;
        for (entity, value) in [
            (paths::HYPERVOLUME, summary.hypervolume),
            (paths::FEASIBLE_SHARE, share),
            (paths::FRONT_SIZE, summary.front_size as f64),
        ] {
            self.row(entity, moment, &Scalars::single(value))?;
        }
        self.check()
    }

    fn finished(&mut self, summary: &RunSummary) -> Result<(), RecordingError> {
        self.write_pending()?;
        self.text(paths::SUMMARY, &summary_text(summary))
    }

    fn write_pending(&mut self) -> Result<(), RecordingError> {
        if self.pending.is_empty() {
            return Ok(());
        }
        let time = |name, pick: fn(&(usize, usize, Evaluation)) -> usize| {
            TimeColumn::new_sequence(name, self.pending.iter().map(move |row| pick(row) as i64))
        };
        let times = [
            time(timelines::EVALUATION, |row| row.0),
            time(timelines::GENERATION, |row| row.1),
        ];
        let evaluations: Vec<&Evaluation> = self.pending.iter().map(|(_, _, evaluation)| evaluation).collect();
        self.recording
            .send_columns(paths::DESIGNS, times, columns::designs(&evaluations)?)?;
        self.pending.clear();
        self.check()
    }

    /// One row of an entity, with as many instances as the archetype holds.
    fn row(&self, entity: &str, moment: Moment, archetype: &dyn AsComponents) -> Result<(), RecordingError> {
        let times = [
            TimeColumn::new_sequence(timelines::EVALUATION, [moment.evaluation as i64]),
            TimeColumn::new_sequence(timelines::GENERATION, [moment.generation as i64]),
        ];
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

    fn text(&self, entity: &str, markdown: &str) -> Result<(), RecordingError> {
        Ok(self
            .recording
            .log_static(entity, &TextDocument::from_markdown(markdown))?)
    }

    fn check(&self) -> Result<(), RecordingError> {
        self.file.check().map_err(|source| RecordingError::Write {
            path: self.path.clone(),
            source,
        })
    }

    fn close(mut self) -> Result<(), RecordingError> {
        self.write_pending()?;
        let Self {
            path, file, recording, ..
        } = self;
        let flushed = recording.flush_blocking().map_err(io::Error::other);
        // The last handle: dropping it joins the SDK's threads, after which nothing more is sent.
        drop(recording);
        flushed
            .and_then(|()| file.finish())
            .map_err(|source| RecordingError::Write { path, source })
    }
}

/// Entity of an architecture's feasible designs.
fn cloud(architecture: Architecture) -> String {
    format!("{}/{architecture}", paths::CLOUD)
}

fn study_text(study: &Study) -> Result<String, RecordingError> {
    let text = toml::to_string(study).map_err(RecordingError::encode)?;
    Ok(format!(
        "# {}\n\n{}\n\n```toml\n{text}```\n",
        study.name, study.description
    ))
}

/// The verified front as a table, thinned to a readable number of rows.
fn summary_text(summary: &RunSummary) -> String {
    const MOST_ROWS: usize = 40;
    let last = summary.history.last();
    let mut text = format!(
        "# Result\n\n{} evaluations, {} feasible. {} designs stand on the front after verification on the fine grid \
         ({} dropped); hypervolume {:.1} kg·m.\n\n| # | architecture | mass [kg] | R_w [m] | φ_c [°] | R | r | L_b | r_j | \
         r_p | active |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
        last.map_or(0, |last| last.evaluations),
        last.map_or(0, |last| last.feasible),
        summary.front.len(),
        summary.dropped,
        summary.verified_hypervolume,
    );
    let count = summary.front.len();
    let rows = count.min(MOST_ROWS);
    for k in 0..rows {
        let member = &summary.front[if rows > 1 { k * (count - 1) / (rows - 1) } else { 0 }];
        let e = &member.evaluation;
        let [base, platform, link, leg_bar, platform_bar] = e.design.values();
        let active: Vec<&str> = e.active().map(|constraint| constraint.id()).collect();
        text.push_str(&format!(
            "| {} | {} | {:.2} | {:.4} | {} | {base:.3} | {platform:.3} | {link:.3} | {leg_bar:.4} | {platform_bar:.4} | {} |\n",
            member.id,
            e.design.architecture,
            e.mass,
            e.workspace_radius,
            e.home_phi_deg.map(|phi| phi.to_string()).unwrap_or_default(),
            active.join(" "),
        ));
    }
    text
}
