//! The run under way: started, held, ended, and its news taken in.

use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::super::document::{Chosen, Document, Origin};
use super::super::open::{Opened, open};
use super::super::running::Running;
use super::super::scene_thread::Request;
use super::super::{FrontEntry, Store, StudyEditor};
use super::{GLANCE, Phase, Session, references};
use kinefront_optimize::knee;
use crate::recording::FrontPoint;
use crate::study::{RunControl, Study, Subscriber, spawn};

impl Session {
    /// Starts the run of the study in the editor; one under way is given up.
    pub fn start(&mut self) {
        if let Some(fault) = self.editor.faults().first() {
            let words = format!("the study cannot run: `{}` {}", fault.key, fault.message);
            self.tell_error(words);
            return;
        }
        self.start_from(spawn);
    }

    /// Starts a run whose events come from `source`, as [`spawn`] is one.
    pub fn start_from(
        &mut self,
        source: impl FnOnce(Study, Arc<RunControl>, Vec<Subscriber>) -> std::io::Result<JoinHandle<()>>,
    ) {
        let wake = Arc::clone(&self.wake);
        match Running::start(self.editor.study().clone(), source, move || wake()) {
            Ok(running) => {
                self.begin(Arc::clone(&running.study));
                self.run = Some(running);
                self.phase = Phase::Searching;
            }
            Err(words) => self.tell_error(words),
        }
    }

    /// Opens what a run left, or a study.
    pub fn open(&mut self, path: &Path) {
        let is_study = path.extension().is_some_and(|extension| extension == "toml");
        if is_study {
            match StudyEditor::read(path) {
                Ok(editor) => {
                    self.editor = editor;
                    self.tell(format!("the study {} is ready to run", path.display()));
                }
                Err(error) => self.tell_error(error.to_string()),
            }
            return;
        }
        match open(path) {
            Ok(opened) => {
                let Opened {
                    study,
                    store,
                    front,
                    history,
                } = opened;
                self.editor = StudyEditor::new(study.clone(), None);
                self.begin(Arc::new(study));
                self.run = None;
                self.store = store;
                self.set_front(front);
                self.generations = history;
                self.phase = Phase::Opened(path.to_owned());
                self.choose_knee();
            }
            Err(error) => self.tell_error(error.to_string()),
        }
    }

    fn begin(&mut self, study: Arc<Study>) {
        self.model = study.model();
        self.references = references(&study);
        self.as_run = study;
        self.store = Store::default();
        self.generations.clear();
        self.set_front(Vec::new());
        self.threads = None;
        self.era += 1;
        self.following = true;
        self.followed = None;
        // Ids of the run before mean nothing now; designs by themselves and the filter go on.
        let before = self.history.present();
        let document = Document {
            pins: before.pins.clone(),
            kept: before.kept.clone(),
            filter: before.filter.clone(),
            ..Document::default()
        };
        self.history.restart(document);
        self.staging.pose = None;
        self.staging.heatmap_phi = None;
    }

    /// Holds the run after the generation under way.
    pub fn pause(&mut self) {
        if let Some(run) = self.run.as_mut().filter(|_| self.phase == Phase::Searching) {
            run.control.pause();
            run.count_time(false);
            self.phase = Phase::Paused;
        }
    }

    /// Goes on.
    pub fn resume(&mut self) {
        if let Some(run) = self.run.as_mut().filter(|_| self.phase == Phase::Paused) {
            run.control.resume();
            run.count_time(true);
            self.phase = Phase::Searching;
        }
    }

    /// Does one generation and holds again.
    pub fn step(&mut self) {
        if let Some(run) = &mut self.run
            && matches!(self.phase, Phase::Searching | Phase::Paused)
        {
            run.control.step();
            run.count_time(false);
            self.phase = Phase::Paused;
        }
    }

    /// Ends the run; what it found is verified and kept.
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

    /// Ends everything, the run's files included.
    pub fn close(&mut self) {
        if let Some(run) = self.run.take() {
            run.close();
        }
    }

    /// Takes in what is new; to be called before each frame.
    pub fn update(&mut self) {
        if let Some(run) = &mut self.run {
            let mut news = run.intake.take();
            self.store.append(&mut news.rows);
            self.generations.append(&mut news.history);
            self.threads = news.threads.or(self.threads);
            if let Some((done, total)) = news.verifying {
                self.phase = Phase::Verifying { done, total };
            }
            if let Some(summary) = news.finished {
                run.count_time(false);
                self.phase = Phase::Finished(summary.outcome);
            }
            if let Some(message) = news.failed {
                run.count_time(false);
                self.phase = Phase::Failed;
                self.tell_error(format!("the run broke off, what it found is kept: {message}"));
            }
            for words in news.troubles {
                self.tell_error(words);
            }
            if let Some(front) = news.front {
                self.set_front(front);
            }
        }
        self.follow();
        self.notices
            .retain(|notice| notice.is_error || notice.since.elapsed() < GLANCE);
        self.answer = self.scene.answer();
        if let Some(trouble) = self.answer.trouble.clone()
            && self.notices.iter().all(|notice| notice.text != trouble)
        {
            self.tell_error(trouble);
        }
        self.ask();
    }

    /// Keeps the knee in the light, now and then: it is drawn beside the search.
    fn follow(&mut self) {
        const EVERY: Duration = Duration::from_millis(700);
        let ended = !self.is_running();
        if !self.following || (!ended && self.followed.is_some_and(|last| last.elapsed() < EVERY)) {
            return;
        }
        if let Some(entry) = self.knee().map(|place| &self.front[place]) {
            let chosen = Chosen {
                design: entry.row.design,
                origin: Origin::Evaluated(entry.id),
            };
            self.history.follow(|document| document.chosen = Some(chosen));
            self.followed = Some(Instant::now());
        }
    }

    pub(super) fn knee(&self) -> Option<usize> {
        let objectives: Vec<[f64; 2]> = self.front.iter().map(FrontEntry::objectives).collect();
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

    /// The front as the scene draws it, dimmed where the filter says so.
    fn draw_front(&mut self) {
        let drawn = (self.front_number, self.history.present().filter.clone());
        if self.front_drawn.as_ref() == Some(&drawn) {
            return;
        }
        let sieve = drawn.1.sieve(&self.store);
        let points = self.front.iter().map(|entry| FrontPoint {
            id: entry.id,
            architecture: entry.row.design.architecture,
            mass: entry.row.mass,
            radius: entry.row.radius,
            lit: sieve.passes(entry.id),
        });
        self.front_points = Arc::new(points.collect());
        self.front_drawn = Some(drawn);
    }

    /// Asks the scene for what is to be shown.
    fn ask(&mut self) {
        self.draw_front();
        let document = self.history.present();
        let design = document.chosen.as_ref().map(|chosen| chosen.design);
        let request = Request {
            study: Arc::clone(&self.as_run),
            verified: self
                .answer
                .known
                .as_ref()
                .is_some_and(|known| known.verified && Some(known.evaluation.design) == design),
            design,
            pose: self.staging.pose,
            heatmap_phi: self.staging.heatmap_phi,
            layers: self.staging.layers,
            pins: document.pins.iter().map(|pin| (pin.name.clone(), pin.design)).collect(),
            comparing: self.staging.comparing,
            light: self.staging.light,
            front: Arc::clone(&self.front_points),
        };
        self.asked = self.scene.ask(request);
    }
}
