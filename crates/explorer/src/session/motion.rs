//! The motion of the study being edited, which the selected design follows.

use std::sync::Arc;

use super::Session;
use crate::threads::{MotionAnswer, MotionQuestion, MotionShown, StudyOfRun};
use kinefront_model::spatial::Pose;
use kinefront_scene::pose_at;

impl Session {
    /// Returns what the motion asks of the drives of the selected design, once that is known: the motion of the study being edited, with
    /// its payload, drives and loads, and all else as in the study that was run.
    pub fn motion(&mut self) -> Option<Arc<MotionAnswer>> {
        let question = MotionQuestion {
            study: StudyOfRun(self.prepared()),
            sections: self.editor.study().into(),
            color: self.view.layers.path,
            evaluation: Arc::clone(&self.known()?.evaluation),
        };
        let (study, design) = (question.study.clone(), question.evaluation.design);
        // While a setting is dragged, the motion before stays in view until the next one is known.
        let answer = self.asking.motion.ask(question);
        answer.or_else(|| {
            let motion = &self.asking.motion;
            motion.last(|asked| asked.study == study && asked.evaluation.design == design)
        })
    }

    /// Returns the motion that the scene shows, if there is one and its path is drawn.
    pub(super) fn shown_motion(&mut self) -> Option<MotionShown> {
        if self.editor.study().task.shape.is_none() || self.view.layers.path.is_none() {
            return None;
        }
        self.motion().map(MotionShown)
    }

    /// Moves the platform to where it is at a time \[s\] of the motion.
    pub fn move_to_time(&mut self, motion: &MotionAnswer, time: f64) {
        let followed = motion.as_ref().ok().and_then(Option::as_ref);
        if let Some(pose) = followed.and_then(|followed| pose_at(&followed.samples, time)) {
            self.view.pose = Some(pose);
        }
    }

    /// Adds a pose to the waypoints of the study being edited. Without a motion, the path begins at the home pose.
    pub fn add_waypoint(&mut self, pose: Pose) {
        let home = self.home();
        let task = &self.editor.study().task;
        let mut points = task.waypoints.clone().unwrap_or_default();
        if points.is_empty() {
            points.extend(home.map(in_degrees));
        }
        points.push(in_degrees(pose));
        self.editor.change(|study| study.task.go_along(points));
        self.editor.end_gesture();
    }
}

/// Returns a pose as a study states it, `[x, y, φ in degrees]`, rounded to a micrometre and a millionth of a degree.
fn in_degrees(pose: Pose) -> [f64; 3] {
    [pose.position.x, pose.position.y, pose.phi.to_degrees()].map(|value| (1e6 * value).round() / 1e6)
}
