//! A second run beside that of the session: another material, another requirement, last week's.

use std::path::Path;

use super::Session;
use crate::FrontEntry;
use crate::files::{Opened, open};
use kinefront_optimize::Objectives;
use kinefront_study::{EqualLevel, SettingDifference, Study, equal_levels};

/// A run that is shown beside that of the session.
#[derive(Debug, Clone)]
pub struct Beside {
    /// Name of its folder, or of its recording.
    pub name: String,
    /// Its study, whose objectives are those of the session.
    pub study: Study,
    /// Its front, sorted by the first objective.
    pub front: Vec<FrontEntry>,
    /// What differs between the study of the session and this one.
    pub differences: Vec<SettingDifference>,
}

impl Session {
    /// Shows a run beside that of the session; both must have the same objectives.
    pub fn open_beside(&mut self, path: &Path) {
        let Opened { name, study, front, .. } = match open(path) {
            Ok(opened) => opened,
            Err(error) => return self.notify_error(error),
        };
        if study.objectives() != self.study().objectives() {
            let own = &self.study().name;
            let words = format!("{name} and {own} have different objectives, so their fronts cannot be compared");
            return self.notify_error(words);
        }
        self.beside = Some(Beside {
            differences: self.study().differences(&study),
            name,
            study,
            front,
        });
    }

    /// Returns the run that is shown beside that of the session.
    pub fn beside(&self) -> Option<&Beside> {
        self.beside.as_ref()
    }

    /// Removes the run that is shown beside.
    pub fn close_beside(&mut self) {
        self.beside = None;
    }

    /// Keeps the run beside that of a new run, if their objectives are the same.
    pub(super) fn keep_beside(&mut self) {
        let study = self.as_run.study();
        self.beside = self
            .beside
            .take()
            .filter(|beside| beside.study.objectives() == study.objectives());
        if let Some(beside) = &mut self.beside {
            beside.differences = study.differences(&beside.study);
        }
    }

    /// Returns the first objective of both fronts at equal values of the second one.
    pub fn levels_beside(&self) -> Vec<EqualLevel> {
        let Some(beside) = &self.beside else {
            return Vec::new();
        };
        let objectives = |front: &[FrontEntry]| front.iter().map(FrontEntry::objectives).collect::<Vec<Objectives>>();
        let fronts = [objectives(&self.front), objectives(&beside.front)];
        equal_levels(&self.study().objectives(), &fronts)
    }
}
