//! Writes the events of a run to a `.rrd` file as they arrive.

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use rerun::{Scalars, SeriesLines, TimeColumn};

use super::scatter::{FrontPoint, INFEASIBLE_COLOR, PlotRange, front_points, points, selected, staircase};
use super::writer::{ALWAYS, Moment, RecordingError, RecordingWriter};
use super::{blueprint, colors, columns, design, paths, timelines};
use crate::study::{Batch, Event, GenerationSummary, Row, RunSummary, Study, TableRow};
use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::mechanism::Architecture;

/// Number of rows of `/designs` written at a time, large enough to keep the file's index small.
const ROWS: usize = 300;

/// Function that returns a number of a design.
type Value = fn(&Evaluation) -> f64;

/// Quantities plotted along the front: the name with its unit, and the value.
const ALONG_FRONT: [(&str, Value); 6] = [
    ("R [m]", |e| e.design.base_radius),
    ("r [m]", |e| e.design.platform_radius),
    ("L_b [m]", |e| e.design.link_length),
    ("r_j [cm]", |e| 100.0 * e.design.leg_bar_radius),
    ("r_p [cm]", |e| 100.0 * e.design.platform_bar_radius),
    ("R_w [m]", |e| e.workspace_radius),
];

/// Returns the entity path of a quantity along the front.
fn along_front(name: &str) -> String {
    format!("{}/{}", paths::ALONG_FRONT, name.split(' ').next().unwrap_or(name))
}

/// The recording of one run.
pub struct Recorder {
    writer: RecordingWriter,
    model: Model,
    architectures: Vec<Architecture>,
    frame: PlotRange,
    /// Rows not yet written.
    pending: Vec<TableRow>,
    front: Vec<FrontPoint>,
    front_changed: bool,
    frame_changed: bool,
}

/// Returns the moment of a row that belongs to a generation: that of the generation's last design.
fn moment(evaluations: usize, generation: usize) -> [(&'static str, usize); 2] {
    [
        (timelines::EVALUATION, evaluations.saturating_sub(1)),
        (timelines::GENERATION, generation),
    ]
}

impl Recorder {
    /// Creates the file and writes the layout and the study, which are known before the run.
    ///
    /// # Errors
    /// [`RecordingError::Write`] when the file exists or cannot be created.
    pub fn create(path: &Path, study: &Study) -> Result<Self, RecordingError> {
        let model = study.model()?;
        let writer = RecordingWriter::create(path, &format!("{} (seed {})", study.name, study.optimizer.seed))?;
        let frame = PlotRange::new(study);
        let clouds: Vec<String> = study
            .architectures
            .iter()
            .map(|&architecture| cloud(architecture))
            .chain([paths::INFEASIBLE.to_owned()])
            .collect();
        blueprint::send_run_layout(writer.stream(), &clouds, frame.bounds(), study.bounds.R_m[1])?;
        writer.text(paths::STUDY, ALWAYS, &study_text(study)?)?;
        Ok(Self {
            writer,
            model,
            architectures: study.architectures.clone(),
            frame,
            pending: Vec::new(),
            front: Vec::new(),
            front_changed: false,
            frame_changed: true,
        })
    }

    /// Writes the events of a run until it ends, then closes the file.
    ///
    /// # Errors
    /// [`RecordingError`] at the first row that cannot be written; the file remains readable up to that row.
    pub fn follow(mut self, events: &Receiver<Arc<Event>>) -> Result<(), RecordingError> {
        for event in events {
            match &*event {
                Event::Evaluated(batch) => self.batch(batch)?,
                Event::Front(front) => {
                    self.front = front.iter().map(FrontPoint::from).collect();
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
        let moment = moment(batch.first_id + batch.evaluations.len(), batch.generation);
        for evaluation in &batch.evaluations {
            self.frame_changed |= self.frame.include(evaluation.mass, evaluation.workspace_radius);
        }
        for &architecture in Architecture::ALL {
            let kind: Vec<&Evaluation> = batch
                .evaluations
                .iter()
                .filter(|e| e.is_feasible() && e.design.architecture == architecture)
                .collect();
            self.cloud(
                &cloud(architecture),
                &moment,
                &kind,
                colors::architecture(architecture),
                2.0,
            )?;
        }
        let infeasible: Vec<&Evaluation> = batch
            .evaluations
            .iter()
            .filter(|e| !e.is_feasible() && self.frame.holds(e))
            .collect();
        let [r, g, b] = INFEASIBLE_COLOR;
        self.cloud(
            paths::INFEASIBLE,
            &moment,
            &infeasible,
            rerun::Color::from_rgb(r, g, b),
            1.5,
        )?;
        let rows = batch.evaluations.iter().enumerate();
        self.pending.extend(rows.map(|(offset, evaluation)| TableRow {
            id: batch.first_id + offset,
            row: Row::new(batch.generation, evaluation),
            reference_radius: None,
        }));
        if self.pending.len() >= ROWS {
            self.write_pending()?;
        }
        Ok(())
    }

    fn cloud(
        &self,
        entity: &str,
        moment: Moment<'_>,
        designs: &[&Evaluation],
        color: rerun::Color,
        size: f32,
    ) -> Result<(), RecordingError> {
        if designs.is_empty() {
            return Ok(());
        }
        self.writer.row(entity, moment, &points(designs, color, size))
    }

    fn generation(&mut self, summary: &GenerationSummary) -> Result<(), RecordingError> {
        let moment = moment(summary.evaluations, summary.generation);
        if self.frame_changed {
            self.axes(&moment)?;
            self.frame_changed = false;
        }
        if self.front_changed {
            self.writer
                .row(paths::FRONT_DESIGNS, &moment, &front_points(&self.front))?;
            self.writer
                .row(paths::FRONT_LINE, &moment, &staircase(&self.front, &self.frame))?;
            self.front_changed = false;
        }
        self.curves(&moment, summary)?;
        self.writer.check()
    }

    fn curves(&self, moment: Moment<'_>, summary: &GenerationSummary) -> Result<(), RecordingError> {
        let fraction = summary.feasible as f64 / summary.evaluations.max(1) as f64;
        for (entity, value) in [
            (paths::HYPERVOLUME, summary.hypervolume),
            (paths::FEASIBLE_SHARE, fraction),
            (paths::FRONT_SIZE, summary.front_size as f64),
        ] {
            self.writer.row(entity, moment, &Scalars::single(value))?;
        }
        Ok(())
    }

    fn finished(&mut self, summary: &RunSummary) -> Result<(), RecordingError> {
        self.write_pending()?;
        self.writer.text(paths::SUMMARY, ALWAYS, &summary_text(summary))?;
        for (name, _) in ALONG_FRONT {
            let lines = SeriesLines::new().with_names([name]);
            self.writer.row(&along_front(name), ALWAYS, &lines)?;
        }
        for step in 0..summary.front.len() {
            self.step(&[(timelines::FRONT, step)], step, summary)?;
            self.writer.check()?;
        }
        // The timelines `evaluation` and `generation` end with the knee of the front; `front` begins with the scatter.
        let last = summary.history.last();
        if let Some((knee, last)) = summary.knee().zip(last) {
            self.step(&moment(last.evaluations, last.generation), knee, summary)?;
            self.scatter_on_front()?;
            // On the timeline `front`, each curve of the run is a horizontal line at its last value.
            for step in [0, summary.front.len() - 1] {
                self.curves(&[(timelines::FRONT, step)], last)?;
            }
        }
        Ok(())
    }

    /// Writes one design of the verified front at a moment, and marks it in the scatter plot.
    fn step(&self, moment: Moment<'_>, step: usize, summary: &RunSummary) -> Result<(), RecordingError> {
        let member = &summary.front[step];
        let heading = format!(
            "#{}, design {} of {} on the front",
            member.id,
            step + 1,
            summary.front.len()
        );
        design::record_step(&self.writer, moment, &self.model, &member.evaluation, &heading)?;
        for (name, value) in ALONG_FRONT {
            let value = Scalars::single(value(&member.evaluation));
            self.writer.row(&along_front(name), moment, &value)?;
        }
        self.writer.row(paths::SELECTED, moment, &selected(&member.evaluation))
    }

    /// Writes the axes, ticks and legend of the scatter plot.
    fn axes(&self, moment: Moment<'_>) -> Result<(), RecordingError> {
        self.writer.row(paths::PLOT, moment, &self.frame.transform())?;
        self.writer.row(paths::AXES, moment, &self.frame.lines())?;
        self.writer.row(paths::TICKS, moment, &self.frame.labels())?;
        self.writer
            .row(paths::LEGEND, moment, &self.frame.legend(&self.architectures))
    }

    /// Writes the axes, legend and front at the first step of the timeline `front`, on which the scatter plot would
    /// otherwise be empty.
    fn scatter_on_front(&self) -> Result<(), RecordingError> {
        let moment: Moment<'_> = &[(timelines::FRONT, 0)];
        self.axes(moment)?;
        self.writer
            .row(paths::FRONT_DESIGNS, moment, &front_points(&self.front))?;
        self.writer
            .row(paths::FRONT_LINE, moment, &staircase(&self.front, &self.frame))
    }

    fn write_pending(&mut self) -> Result<(), RecordingError> {
        if self.pending.is_empty() {
            return Ok(());
        }
        let pending = &self.pending;
        let times = [
            TimeColumn::new_sequence(timelines::EVALUATION, pending.iter().map(|entry| entry.id as i64)),
            TimeColumn::new_sequence(
                timelines::GENERATION,
                pending.iter().map(|entry| i64::from(entry.row.generation)),
            ),
        ];
        self.writer
            .stream()
            .send_columns(paths::DESIGNS, times, columns::designs(pending)?)?;
        self.pending.clear();
        self.writer.check()
    }

    fn close(mut self) -> Result<(), RecordingError> {
        self.write_pending()?;
        self.writer.close()
    }
}

/// Returns the entity path of an architecture's feasible designs.
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

/// Returns the verified front as a table, thinned to a readable number of rows.
fn summary_text(summary: &RunSummary) -> String {
    const MOST_ROWS: usize = 40;
    let last = summary.history.last();
    let mut text = format!(
        "# Result\n\n{} evaluations, {} feasible. {} designs are on the front after verification on the fine grid \
         ({} dropped); hypervolume {:.1} kg·m.\n\n| # | architecture | mass [kg] | R_w [m] | φ_c [°] | R | r | L_b | r_j | \
         r_p | clearance [mm] | active |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        last.map_or(0, |last| last.evaluations),
        last.map_or(0, |last| last.feasible),
        summary.front.len(),
        summary.dropped,
        summary.verified_hypervolume,
    );
    for (_, member) in summary.spread(MOST_ROWS) {
        let e = &member.evaluation;
        let [base, platform, link, leg_bar, platform_bar] = e.design.values();
        let active: Vec<&str> = e.active().map(|constraint| constraint.id()).collect();
        let clearance = e.clearance();
        text.push_str(&format!(
            "| {} | {} | {:.2} | {:.4} | {} | {base:.3} | {platform:.3} | {link:.3} | {leg_bar:.4} | {platform_bar:.4} | {} | {} |\n",
            member.id,
            e.design.architecture,
            e.mass,
            e.workspace_radius,
            e.home_phi_deg.map(|phi| phi.to_string()).unwrap_or_default(),
            clearance.map(|clearance| format!("{:.1}", 1e3 * clearance)).unwrap_or_default(),
            active.join(" "),
        ));
    }
    text
}
