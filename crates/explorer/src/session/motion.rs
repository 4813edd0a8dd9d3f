//! The motion of the study being edited, which the selected design follows.

use std::sync::Arc;

use super::Session;
use crate::threads::{MotionAnswer, MotionQuestion, MotionShown};
use kinefront_model::spatial::Pose;
use kinefront_scene::pose_at;
use kinefront_study::Study;

impl Session {
    /// Returns what the motion asks of the drives of the selected design, once that is known: the motion of the study being edited, with
    /// its payload, drives and loads, and all else as in the study that was run.
    pub fn motion(&mut self) -> Option<Arc<MotionAnswer>> {
        let evaluation = Arc::clone(&self.known()?.evaluation);
        let study = self.moving_study();
        self.asking.motion.ask(MotionQuestion { study, evaluation })
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

    fn moving_study(&mut self) -> Arc<Study> {
        let edited = self.editor.study();
        let mut study = self.as_run.study().clone();
        study.task = edited.task.clone();
        study.payload = edited.payload.clone();
        study.drives = edited.drives.clone();
        study.loads = edited.loads.clone();
        // The study is compared with the last one that was asked: it is the same from frame to frame.
        match self.asking.motion.asked() {
            Some(asked) if *asked.study == study => Arc::clone(&asked.study),
            _ => Arc::new(study),
        }
    }
}

/// Returns a pose as a study states it, `[x, y, φ in degrees]`, rounded to a micrometre and a millionth of a degree.
fn in_degrees(pose: Pose) -> [f64; 3] {
    [pose.position.x, pose.position.y, pose.phi.to_degrees()].map(|value| (1e6 * value).round() / 1e6)
}
