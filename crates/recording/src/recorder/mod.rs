//! Writes the events of a run to a `.rrd` file as they arrive.

mod texts;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use rerun::{Scalars, SeriesLines, TimeColumn};

use super::plot::{INFEASIBLE_COLOR, Plot};
use super::point::{FrontPoint, PlotPoint};
use super::rows::RowBuffer;
use super::writer::{ALWAYS, Moment, RecordingError, RecordingWriter};
use super::{blueprint, colors, columns, design, paths, timelines};
use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Architecture;
use kinefront_study::{
    Batch, Drivers, Event, GenerationSummary, PreparedStudy, Row, RunSummary, RunWriter, Study, TableRow,
};

/// Number of designs after which the rows that were collected are written, large enough to keep the file's index small.
const DESIGNS_AT_ONCE: usize = 3000;

/// Time after which the rows that were collected are written if there are fewer designs.
const WRITE_INTERVAL: Duration = Duration::from_secs(5);

/// Function that returns a number of a design.
type Value = fn(&Evaluation) -> f64;

/// Quantities plotted along the front: the name with its unit, and the value.
const ALONG_FRONT: [(&str, Value); 6] = [
    ("R [m]", |e| e.design.base_radius()),
    ("r [m]", |e| e.design.platform_radius()),
    ("L_b [m]", |e| e.design.link_length()),
    ("r_j [cm]", |e| 100.0 * e.design.leg_bar_radius()),
    ("r_p [cm]", |e| 100.0 * e.design.platform_bar_radius()),
    ("R_w [m]", Evaluation::workspace_radius),
];

/// Returns the entity path of a quantity along the front.
fn along_front(name: &str) -> String {
    format!("{}/{}", paths::ALONG_FRONT, name.split(' ').next().unwrap_or(name))
}

/// The recording of one run.
pub struct Recorder {
    study: PreparedStudy,
    writer: RecordingWriter,
    frame: Plot,
    /// Every how many generations one is recorded.
    every: usize,
    /// Whether the current generation is recorded.
    records: bool,
    /// Designs not yet written.
    pending: Vec<TableRow>,
    /// Rows of other entities not yet written.
    rows: RowBuffer,
    written: Instant,
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

/// Whether a generation, whose first design has the id `first_id`, is recorded if one of `every` generations is. The index
/// of a recording is in memory until it is closed; a run of 10⁷ designs therefore records 280 000 of them: all of the first
/// 100 000, a tenth of those up to a million, and so on.
pub fn is_recorded(generation: usize, first_id: usize, every: usize) -> bool {
    const DENSE: usize = 100_000;
    let mut step = every.max(1);
    let mut end = DENSE;
    while first_id >= end {
        step = step.saturating_mul(10);
        end = end.saturating_mul(10);
    }
    (generation - 1).is_multiple_of(step)
}

impl Recorder {
    /// Creates the file and writes the layout and the study, which are known before the run. One of `every` generations is
    /// recorded, and the front at the end in any case.
    ///
    /// # Errors
    /// [`RecordingError::Write`] when the file exists or cannot be created.
    pub fn create(path: &Path, study: &Study, every: usize) -> Result<Self, RecordingError> {
        let prepared = PreparedStudy::new(study.clone())?;
        let writer = RecordingWriter::create(path, &format!("{} (seed {})", study.name, study.optimizer.seed))?;
        let frame = Plot::new(study);
        let clouds: Vec<String> = study
            .architectures
            .iter()
            .map(|&architecture| cloud(architecture))
            .chain([paths::INFEASIBLE.to_owned()])
            .collect();
        let plot = if study.objectives.len() == 1 {
            "Progress"
        } else {
            "Pareto front"
        };
        let hypervolume = match study.hypervolume_unit() {
            unit if unit.is_empty() => "Hypervolume".to_owned(),
            unit => format!("Hypervolume [{unit}]"),
        };
        let names = [plot, &hypervolume];
        let bounds = Plot::bounds();
        blueprint::send_run_layout(writer.stream(), &clouds, names, bounds, study.bounds.R_m[1])?;
        writer.text(paths::STUDY, ALWAYS, &texts::study(study)?)?;
        Ok(Self {
            writer,
            study: prepared,
            frame,
            every: every.max(1),
            records: true,
            pending: Vec::new(),
            rows: RowBuffer::default(),
            written: Instant::now(),
            front: Vec::new(),
            front_changed: false,
            frame_changed: true,
        })
    }

    /// Creates the recording of the run that `folder` writes; `None` for a run without one.
    ///
    /// # Errors
    /// As [`Recorder::create`].
    pub fn of_run(folder: &RunWriter, study: &Study) -> Result<Option<Self>, RecordingError> {
        let create = |every| Self::create(&folder.recording_path(), study, every);
        folder.record_every().map(create).transpose()
    }

    /// Writes the events of a run until it ends, then closes the file. What was collected is written every few seconds,
    /// for which the events are awaited for `tick` at most.
    ///
    /// # Errors
    /// [`RecordingError`] at the first row that cannot be written, and when the recording is to be given up; the file
    /// remains readable up to that row.
    pub fn follow(
        mut self,
        events: &Receiver<Arc<Event>>,
        give_up: &AtomicBool,
        tick: Duration,
    ) -> Result<(), RecordingError> {
        loop {
            let event = match events.recv_timeout(tick) {
                Ok(event) => Some(event),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => return self.close(),
            };
            if give_up.load(Ordering::Relaxed) {
                return Err(RecordingError::GivenUp);
            }
            match event.as_deref() {
                Some(Event::Evaluated(batch)) => self.batch(batch),
                Some(Event::Front(front)) => {
                    self.front = front.iter().map(|entry| FrontPoint::from(&**entry)).collect();
                    self.front_changed = true;
                }
                Some(Event::Generation(summary)) if self.records => self.generation(summary),
                Some(Event::Finished(summary)) => self.finished(summary, give_up)?,
                Some(Event::Generation(_) | Event::Started(_) | Event::Concluding { .. } | Event::Failed(_)) | None => {
                }
            }
            if self.pending.len() >= DESIGNS_AT_ONCE || self.written.elapsed() >= WRITE_INTERVAL {
                self.write_collected()?;
            }
        }
    }

    fn batch(&mut self, batch: &Batch) {
        let placed = (batch.first_id..).zip(&batch.rows);
        let placed: Vec<(&Row, PlotPoint)> = placed.map(|(id, row)| (row, PlotPoint::of_row(id, row))).collect();
        for (_, point) in &placed {
            self.frame_changed |= self.frame.include(point);
        }
        self.records = is_recorded(batch.generation, batch.first_id, self.every);
        if !self.records {
            return;
        }
        let moment = moment(batch.first_id + batch.rows.len(), batch.generation);
        for architecture in self.study.study().architectures.clone() {
            let is_shown = |(row, point): &(&Row, PlotPoint)| {
                (point.is_feasible && row.design.architecture() == architecture).then_some(*point)
            };
            let designs: Vec<PlotPoint> = placed.iter().filter_map(is_shown).collect();
            let color = colors::architecture(architecture);
            self.cloud(&cloud(architecture), &moment, &designs, color, 2.0);
        }
        let points = placed.into_iter().map(|(_, point)| point);
        let infeasible: Vec<PlotPoint> = points
            .filter(|point| !point.is_feasible && self.frame.holds(point))
            .collect();
        let color = colors::rgb(INFEASIBLE_COLOR);
        self.cloud(paths::INFEASIBLE, &moment, &infeasible, color, 1.5);
        self.pending.extend(batch.entries());
    }

    fn cloud(&mut self, entity: &str, moment: Moment<'_>, designs: &[PlotPoint], color: rerun::Color, size: f32) {
        if !designs.is_empty() {
            self.rows.add(entity, moment, &self.frame.points(designs, color, size));
        }
    }

    fn generation(&mut self, summary: &GenerationSummary) {
        let moment = moment(summary.evaluations, summary.generation);
        if self.frame_changed {
            self.axes(&moment);
            self.frame_changed = false;
        }
        if self.front_changed {
            self.add_front(&moment);
            self.front_changed = false;
        }
        self.curves(&moment, summary);
    }

    fn curves(&mut self, moment: Moment<'_>, summary: &GenerationSummary) {
        let fraction = summary.feasible as f64 / summary.evaluations.max(1) as f64;
        for (entity, value) in [
            (paths::HYPERVOLUME, summary.hypervolume),
            (paths::FEASIBLE_SHARE, fraction),
            (paths::FRONT_SIZE, summary.front_size as f64),
        ] {
            self.rows.add(entity, moment, &Scalars::single(value));
        }
    }

    fn finished(&mut self, summary: &RunSummary, give_up: &AtomicBool) -> Result<(), RecordingError> {
        // A generation that was left out may have been the last.
        if let Some(last) = summary.history.last().filter(|_| !self.records) {
            self.generation(last);
        }
        self.write_collected()?;
        self.writer
            .text(paths::SUMMARY, ALWAYS, &texts::summary(self.study.study(), summary))?;
        for (name, _) in ALONG_FRONT {
            let lines = SeriesLines::new().with_names([name]);
            self.writer.row(&along_front(name), ALWAYS, &lines)?;
        }
        for step in 0..summary.front.len() {
            if give_up.load(Ordering::Relaxed) {
                return Err(RecordingError::GivenUp);
            }
            self.step(&[(timelines::FRONT, step)], step, None, summary)?;
            self.writer.check()?;
        }
        // The timelines `evaluation` and `generation` end with the knee of the front; `front` begins with the scatter.
        let last = summary.history.last();
        if let Some((knee, last)) = summary.knee().zip(last) {
            // Prices take longer than a step, so that only the knee has them.
            let drivers = design::drivers(self.study.study(), &summary.front[knee].evaluation);
            let at = moment(last.evaluations, last.generation);
            self.step(&at, knee, drivers.as_ref(), summary)?;
            self.scatter_on_front();
            // On the timeline `front`, each curve of the run is a horizontal line at its last value.
            for step in [0, summary.front.len() - 1] {
                self.curves(&[(timelines::FRONT, step)], last);
            }
        }
        self.write_collected()
    }

    /// Writes one design of the verified front at a moment, and marks it in the scatter plot.
    fn step(
        &self,
        moment: Moment<'_>,
        step: usize,
        drivers: Option<&Drivers>,
        summary: &RunSummary,
    ) -> Result<(), RecordingError> {
        let member = &summary.front[step];
        let (evaluation, certified) = (&member.evaluation, member.certified.as_ref());
        let (number, count) = (step + 1, summary.front.len());
        let heading = format!("#{}, design {number} of {count} on the front", member.id);
        let model = self.study.model();
        design::record_step(&self.writer, moment, model, evaluation, certified, drivers, &heading)?;
        for (name, value) in ALONG_FRONT {
            self.writer
                .row(&along_front(name), moment, &Scalars::single(value(evaluation)))?;
        }
        let point = PlotPoint::of_evaluation(Some(member.id), evaluation);
        self.writer.row(paths::SELECTED, moment, &self.frame.selected(&point))
    }

    /// Adds the axes, ticks and legend of the scatter plot.
    fn axes(&mut self, moment: Moment<'_>) {
        let grid = self.frame.grid();
        self.rows.add(paths::PLOT, moment, &self.frame.transform());
        self.rows.add(paths::AXES, moment, &grid.lines());
        self.rows.add(paths::TICKS, moment, &grid.labels());
        let legend = grid.legend(&self.study.study().architectures);
        self.rows.add(paths::LEGEND, moment, &legend);
    }

    /// Adds the front to the scatter plot.
    fn add_front(&mut self, moment: Moment<'_>) {
        let (designs, line) = (self.frame.front_points(&self.front), self.frame.staircase(&self.front));
        self.rows.add(paths::FRONT_DESIGNS, moment, &designs);
        self.rows.add(paths::FRONT_LINE, moment, &line);
    }

    /// Adds the axes, legend and front at the first step of the timeline `front`, on which the scatter plot would
    /// otherwise be empty.
    fn scatter_on_front(&mut self) {
        let moment: Moment<'_> = &[(timelines::FRONT, 0)];
        self.axes(moment);
        self.add_front(moment);
    }

    /// Writes the designs and rows that were collected.
    fn write_collected(&mut self) -> Result<(), RecordingError> {
        self.written = Instant::now();
        self.rows.write(&self.writer)?;
        if self.pending.is_empty() {
            return self.writer.check();
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
            .send_columns(paths::DESIGNS, times, columns::designs(self.study.study(), pending)?)?;
        self.pending.clear();
        self.writer.check()
    }

    fn close(mut self) -> Result<(), RecordingError> {
        self.write_collected()?;
        self.writer.close()
    }
}

/// Returns the entity path of an architecture's feasible designs.
fn cloud(architecture: Architecture) -> String {
    format!("{}/{architecture}", paths::CLOUD)
}
