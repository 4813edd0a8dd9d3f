//! The pose of the design in the light.

use super::Session;
use kinefront_model::evaluation::Constraint;
use kinefront_model::spatial::Pose;

impl Session {
    /// Where the manipulator stands.
    pub fn pose(&self) -> Option<Pose> {
        self.staging.pose.or_else(|| self.home())
    }

    /// Home of the design in the light.
    pub fn home(&self) -> Option<Pose> {
        Some(self.model.home(&self.known()?.evaluation))
    }

    /// Moves the platform towards `pose`, as far as it gets in a straight line; tells what stopped it.
    pub fn move_platform(&mut self, pose: Pose) -> Option<String> {
        let design = self.document().chosen.as_ref()?.design;
        let from = self.pose()?;
        let reach = |pose: &Pose| self.model.pose(&design, pose).ok()?.err();
        let Some(stopped) = reach(&pose) else {
            self.staging.pose = Some(pose);
            return None;
        };
        let between = |share: f64| Pose {
            position: from.position.lerp(pose.position, share),
            phi: from.phi + share * (pose.phi - from.phi),
        };
        // As near as it gets: where the present pose itself is not reached, it stays.
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
            self.staging.pose = Some(between(low));
        }
        Some(stopped.to_string())
    }

    /// Moves the manipulator to the worst pose of a constraint.
    pub fn show_worst(&mut self, constraint: Constraint) {
        let pose = self
            .known()
            .and_then(|known| known.evaluation.constraint(constraint).pose);
        if let Some(pose) = pose {
            self.staging.pose = Some(pose);
            self.staging.heatmap_phi = Some(pose.phi);
        }
    }
}
