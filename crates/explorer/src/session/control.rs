//! The current run: it is started, paused and ended here, and its messages are processed.

use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::super::{Filter, FrontEntry, Store, StudyEditor};
use super::{Phase, Session, references};
use crate::AnyError;
use crate::data::{DesignOrigin, Document, Selected};
use crate::files::{Opened, open, run_folder_of};
use crate::threads::{Request, Running};
use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Design;
use kinefront_optimize::{Objectives, knee};
use kinefront_recording::FrontPoint;
use kinefront_study::{Builtin, PreparedStudy, ResumeOptions, Resumption, RunControl, Study, Subscriber, spawn};

impl Session {
    /// Puts a built-in study into the editor.
    pub fn edit_builtin(&mut self, builtin: &Builtin) {
        match StudyEditor::builtin(builtin) {
            Ok(editor) => self.edit_study(editor),
            Err(error) => self.notify_error(error),
        }
    }

    /// Puts a study into the editor. If the one that was there has edits that were not saved, undo brings it back.
    fn edit_study(&mut self, editor: StudyEditor) {
        if self.editor.is_changed() {
            let name = &self.editor.study().name;
            self.notify(format!("undo (Ctrl+Z) restores your edits of the study {name}"));
            self.editor.replace(&editor);
        } else {
            self.editor = editor;
        }
    }

    /// Starts a run of the study in the editor; a run in progress is abandoned.
    pub fn start(&mut self) {
        if let Some(fault) = self.editor.text_fault() {
            let words = format!("the study cannot be run: `{}` {}", fault.key, fault.message);
            self.notify_error(words);
            return;
        }
        self.start_from(spawn);
    }

    /// Starts a run whose events come from `source`, for example [`spawn`].
    pub fn start_from(
        &mut self,
        source: impl FnOnce(Study, Arc<RunControl>, Vec<Subscriber>) -> std::io::Result<JoinHandle<()>>,
    ) {
        let study = self.editor.study().clone();
        let wake = Arc::clone(&self.wake);
        self.search(study, |study| Running::start(study, source, move || wake()));
    }

    /// Shows the run of a study, which `start` starts.
    fn search(&mut self, study: Study, start: impl FnOnce(Study) -> Result<Running, AnyError>) {
        let started = PreparedStudy::new(study)
            .map_err(AnyError::from)
            .and_then(|study| Ok((start(study.study().clone())?, study)));
        match started {
            Ok((running, study)) => {
                self.begin(study);
                self.run = Some(running);
                self.phase = Phase::Searching;
            }
            Err(error) => self.notify_error(error),
        }
    }

    /// The folder of the run that was opened, in which it can be continued.
    pub fn continuable(&self) -> Option<&Path> {
        match &self.phase {
            Phase::Opened(path) => run_folder_of(path),
            _ => None,
        }
    }

    /// Continues the run that was opened, in its folder. A larger budget in the editor extends it.
    pub fn continue_run(&mut self) {
        let Some(folder) = self.continuable() else { return };
        let asked = self.editor.study().optimizer.evaluations;
        let more = (asked > self.study().optimizer.evaluations).then_some(asked);
        let options = ResumeOptions {
            evaluations: more,
            ..ResumeOptions::default()
        };
        let resumption = match Resumption::open(folder, &options) {
            Ok(resumption) => resumption,
            Err(error) => return self.notify_error(error),
        };
        if resumption.is_complete() {
            self.notify("the run is complete; a larger number of evaluations extends it".to_owned());
            return;
        }
        for note in resumption.notes() {
            self.notify(note.clone());
        }
        let study = Study::clone(resumption.search().study());
        let wake = Arc::clone(&self.wake);
        self.search(study, |_| Running::resume(resumption, move || wake()));
    }

    /// Opens the results of a run, or a study.
    pub fn open(&mut self, path: &Path) {
        let is_study = path.extension().is_some_and(|extension| extension == "toml");
        if is_study {
            match StudyEditor::read(path) {
                Ok(editor) => {
                    self.edit_study(editor);
                    self.notify(format!("the study {} is ready to run", path.display()));
                }
                Err(error) => self.notify_error(error),
            }
            return;
        }
        match open(path) {
            Ok(Opened {
                study,
                store,
                front,
                history,
                ..
            }) => {
                match PreparedStudy::new(study.clone()) {
                    Ok(prepared) => self.begin(prepared),
                    Err(error) => return self.notify_error(error),
                }
                self.edit_study(StudyEditor::new(study, None));
                self.run = None;
                self.store = store;
                self.set_front(front);
                self.generations = history;
                self.phase = Phase::Opened(path.to_owned());
                self.select_knee();
            }
            Err(error) => self.notify_error(error),
        }
    }

    fn begin(&mut self, study: PreparedStudy) {
        let is_same = self.as_run.study().differing_key(study.study()).is_none();
        self.references = references(&study);
        self.as_run = Arc::new(study);
        self.store = Store::default();
        self.generations.clear();
        self.generation_times.clear();
        self.set_front(Vec::new());
        self.threads = None;
        self.era += 1;
        self.following = true;
        self.followed = None;
        self.asking.forget();
        self.keep_beside();
        // The ids of the previous run are meaningless now; pinned and kept designs remain, and the filter if the question is the same.
        let before = self.history.present();
        let document = Document {
            pins: before.pins.clone(),
            kept: before.kept.clone(),
            filter: if is_same {
                before.filter.clone()
            } else {
                Filter::default()
            },
            ..Document::default()
        };
        self.history.restart(document);
        self.view.pose = None;
        self.view.heatmap_phi = None;
    }

    /// Pauses the run after the current generation.
    pub fn pause(&mut self) {
        if let Some(run) = self.run.as_mut().filter(|_| self.phase == Phase::Searching) {
            run.control.pause();
            run.count_time(false);
            self.phase = Phase::Paused;
        }
    }

    /// Resumes the run.
    pub fn resume(&mut self) {
        if let Some(run) = self.run.as_mut().filter(|_| self.phase == Phase::Paused) {
            run.control.resume();
            run.count_time(true);
            self.phase = Phase::Searching;
        }
    }

    /// Runs one generation and pauses again.
    pub fn step(&mut self) {
        if let Some(run) = &mut self.run
            && matches!(self.phase, Phase::Searching | Phase::Paused)
        {
            run.control.step();
            run.count_time(false);
            self.phase = Phase::Paused;
        }
    }

    /// Returns whether the run is paused and its last generation is done.
    pub fn is_waiting(&self) -> bool {
        self.run.as_ref().is_some_and(|run| run.control.is_waiting())
    }

    /// Ends the run; the designs found so far are verified and kept.
    pub fn stop(&mut self) {
        if let Some(run) = self
            .run
            .as_mut()
            .filter(|_| matches!(self.phase, Phase::Searching | Phase::Paused))
        {
            run.control.stop();
            run.count_time(true);
            self.phase = Phase::Searching;
        }
    }

    /// Ends the run and removes its temporary files.
    pub fn close(&mut self) {
        if let Some(run) = self.run.take() {
            run.close();
        }
    }

    /// Processes new messages and results; must be called before each frame.
    pub fn update(&mut self) {
        if let Some(run) = &mut self.run {
            let mut messages = run.intake.take();
            self.store.append(&mut messages.rows);
            for (generation, at) in messages.history {
                self.generations.push(generation);
                self.generation_times.push(run.elapsed_at(at));
            }
            self.threads = messages.threads.or(self.threads);
            if let Some((part, done, total)) = messages.conclusion {
                self.phase = Phase::Concluding { part, done, total };
            }
            if let Some(summary) = messages.finished {
                run.count_time(false);
                self.phase = Phase::Finished(summary.outcome);
            }
            if let Some(message) = messages.failed {
                run.count_time(false);
                self.phase = Phase::Failed;
                self.notify_error(format!("the run failed; the designs found so far are kept: {message}"));
            }
            for words in messages.troubles {
                self.notify_error(words);
            }
            if let Some(front) = messages.front {
                self.set_front(front);
            }
        }
        self.follow();
        self.take_wish();
        self.dismiss_seen();
        self.answer = self.scene.answer();
        // A design of the previous run may be selected again: its values are those of another study.
        if self.answer.study.as_ref().is_some_and(|study| *study != self.as_run) {
            self.answer.known = None;
            self.answer.proof = None;
            self.answer.pins.clear();
        }
        // A failure is shown once, so that a message that the user dismissed does not come back.
        if let Some((number, trouble)) = self.answer.trouble.clone()
            && self.failure_shown.replace(number) != Some(number)
            && self.notices.iter().all(|notice| notice.text != trouble)
        {
            self.notify_error(trouble);
        }
        self.ask();
    }

    /// Selects the knee at intervals only, because drawing it takes processor time from the search.
    fn follow(&mut self) {
        const EVERY: Duration = Duration::from_millis(700);
        let ended = !self.is_running();
        if !self.following || (!ended && self.followed.is_some_and(|last| last.elapsed() < EVERY)) {
            return;
        }
        if let Some(entry) = self.knee().map(|place| &self.front[place]) {
            let selected = Selected {
                design: entry.row.design,
                origin: DesignOrigin::Evaluated(entry.id),
            };
            self.history.follow(|document| document.selected = Some(selected));
            self.followed = Some(Instant::now());
        }
    }

    pub(super) fn knee(&self) -> Option<usize> {
        let objectives: Vec<Objectives> = self.front.iter().map(FrontEntry::objectives).collect();
        knee(&objectives)
    }

    fn set_front(&mut self, front: Vec<FrontEntry>) {
        self.place_on_front = front
            .iter()
            .enumerate()
            .map(|(place, entry)| (entry.id, place))
            .collect();
        self.front_number += 1;
        self.front = front;
    }

    /// Prepares the front for the scene; designs that do not pass the filter are dimmed.
    fn draw_front(&mut self) {
        let drawn = (self.front_number, self.history.present().filter.clone());
        if self.front_drawn.as_ref() == Some(&drawn) {
            return;
        }
        let prepared = drawn.1.prepare(&self.store);
        let points = self.front.iter().map(|entry| FrontPoint {
            id: entry.id,
            architecture: entry.row.design.architecture(),
            objectives: entry.row.objectives,
            passes_filter: prepared.passes_entry(entry),
        });
        self.front_points = Arc::new(points.collect());
        self.front_drawn = Some(drawn);
    }

    /// Returns the evaluation of the selected design on the fine grid, if it is known: from the verification of the front,
    /// which is not repeated for a click, or from the verify thread.
    fn verified(&self, design: &Design) -> Option<Arc<Evaluation>> {
        let of_front = || {
            let id = match self.document().selected.as_ref()?.origin {
                DesignOrigin::Evaluated(id) => id,
                DesignOrigin::Wished(_) => return self.wished_evaluation(design),
                _ => return None,
            };
            self.front[*self.place_on_front.get(&id)?].evaluation.clone()
        };
        let answered = || {
            let known = self.answer.known.as_ref()?;
            known.verified.then(|| Arc::clone(&known.evaluation))
        };
        of_front()
            .filter(|evaluation| evaluation.design == *design)
            .or_else(|| answered().filter(|evaluation| evaluation.design == *design))
    }

    /// Requests the current scene from the scene thread.
    fn ask(&mut self) {
        self.draw_front();
        let motion = self.shown_motion();
        let bent = self.bent();
        let document = self.history.present();
        let design = document.selected_design();
        let request = Request {
            study: Arc::clone(&self.as_run),
            verified: design.and_then(|design| self.verified(&design)),
            proof: self.proof().cloned(),
            motion,
            design,
            pose: self.view.pose,
            heatmap_phi: self.view.heatmap_phi,
            bent,
            layers: self.view.layers,
            pins: document.pins.iter().map(|pin| (pin.name.clone(), pin.design)).collect(),
            comparing: self.view.comparing,
            light: self.view.light,
            viewpoint: self.view.viewpoint,
            front: Arc::clone(&self.front_points),
        };
        self.requested = self.scene.ask(request);
    }
}
