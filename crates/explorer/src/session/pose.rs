//! The pose of the selected design.

use glam::DVec2;

use super::Session;
use kinefront_model::evaluation::Constraint;
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_scene::AssemblyMode;

/// What stopped a dragged platform.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stopped {
    design: Design,
    at: Pose,
    reason: String,
}

impl Session {
    /// Returns the pose of the manipulator.
    pub fn pose(&self) -> Option<Pose> {
        self.view.pose.or_else(|| self.home())
    }

    /// Returns the home pose of the selected design.
    pub fn home(&self) -> Option<Pose> {
        Some(self.model().home(&self.known()?.evaluation))
    }

    /// Moves the platform by steps of a hundredth of `R` along x and y, and of a degree about z.
    pub fn nudge(&mut self, steps: [f64; 3]) {
        let Some((pose, design)) = self.pose().zip(self.document().selected_design()) else {
            return;
        };
        let [x, y, turn] = steps;
        let length = 0.01 * design.base_radius();
        let position = pose.position + length * DVec2::new(x, y);
        let phi = pose.phi + turn.to_radians();
        if let Some(stopped) = self.move_platform(Pose { position, phi }) {
            self.notify(stopped);
        }
    }

    /// Moves the platform to `pose` or, if that is not reachable, as far towards it as possible in a straight line;
    /// returns what stopped it.
    pub fn move_platform(&mut self, pose: Pose) -> Option<String> {
        let design = self.document().selected_design()?;
        let from = self.pose()?;
        let reach = |pose: &Pose| self.model().pose(&design, pose).err();
        let Some(stopped) = reach(&pose) else {
            self.view.pose = Some(pose);
            return None;
        };
        let between = |fraction: f64| Pose {
            position: from.position.lerp(pose.position, fraction),
            phi: from.phi + fraction * (pose.phi - from.phi),
        };
        // The platform moves as near as possible; if the current pose itself is not reachable, it stays there.
        let (mut low, mut high) = (0.0, 1.0);
        if reach(&from).is_none() {
            for _ in 0..24 {
                let middle = 0.5 * (low + high);
                if reach(&between(middle)).is_none() {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            self.view.pose = Some(between(low));
        }
        Some(stopped.to_string())
    }

    /// Moves the platform towards `pose` as [`Session::move_platform`] does, and notes what stopped it.
    pub fn drag_platform(&mut self, pose: Pose) {
        let reason = self.move_platform(pose);
        let design = self.document().selected_design();
        self.stopped = match (reason, design, self.pose()) {
            (Some(reason), Some(design), Some(at)) => Some(Stopped { design, at, reason }),
            _ => None,
        };
    }

    /// Ends a drag: what stopped it matters no longer.
    pub fn end_drag(&mut self) {
        self.stopped = None;
    }

    /// Returns what stopped the dragged platform, as long as it stays there.
    pub fn stopped(&self) -> Option<&str> {
        let stopped = self.stopped.as_ref()?;
        let design = self.document().selected_design()?;
        (stopped.design == design && Some(stopped.at) == self.pose()).then_some(&*stopped.reason)
    }

    /// Moves the platform to an assembly mode, in the working mode that it needs.
    pub fn jump_to(&mut self, mode: &AssemblyMode) {
        let Some(selected) = self.document().selected.clone() else {
            return;
        };
        if let Some(needed) = mode
            .working_mode
            .filter(|&needed| needed != selected.design.working_mode())
        {
            self.modify_with("mode", |design| Ok(design.with_working_mode(needed)));
        }
        self.view.pose = Some(mode.pose);
    }

    /// Moves the manipulator to the worst pose of a constraint.
    pub fn show_worst(&mut self, constraint: Constraint) {
        let pose = self
            .known()
            .and_then(|known| known.evaluation.constraint(constraint).pose);
        if let Some(pose) = pose {
            self.view.pose = Some(pose);
            self.view.heatmap_phi = Some(pose.phi);
        }
    }

    /// Moves the platform to the infeasible pose that ends the proof of the workspace, and shows the proof.
    pub fn show_violation(&mut self) {
        if let Some(violation) = self.proof().and_then(|proof| proof.certificate.violation) {
            self.view.pose = Some(violation.pose);
            self.view.heatmap_phi = Some(violation.pose.phi);
            self.view.layers.proof = true;
        }
    }
}
