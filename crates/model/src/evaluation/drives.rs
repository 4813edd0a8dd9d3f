//! The selection of a drive: the lightest one of a catalogue that carries the motion of a study (docs/model.md, section 15.9).

use std::borrow::Cow;

use super::{Model, Quantity, SelectedDrive, TaskFigures, TaskOutcome, TaskSample, largest_of_legs};
use crate::dynamics::{Drive, Task, TaskFrame};
use crate::mechanism::{Architecture, Design};
use crate::spatial::LEGS;

/// Share by which the utilization may differ from what is estimated from other drives.
const ROUNDING: f64 = 1e-9;

impl Drive {
    /// Returns the largest share of the limits that a motion with this drive uses.
    fn utilization(&self, figures: &TaskFigures) -> f64 {
        let peak = largest_of_legs(figures.peak_force) / self.peak;
        let rated = largest_of_legs(figures.rms_force) / self.rated;
        let speed = largest_of_legs(figures.peak_speed) / self.speed;
        peak.max(rated).max(speed)
    }
}

impl Model {
    /// Returns the model in which the motors and rotors are those of the drive at a place of the catalogue; the model itself without one.
    pub fn driven_by(&self, drive: Option<usize>) -> Cow<'_, Model> {
        let Some(drive) = drive.and_then(|place| self.settings().drive_catalogue.get(place)) else {
            return Cow::Borrowed(self);
        };
        Cow::Owned(self.with_drive(drive))
    }

    /// Returns what a drive adds to the mass in motion \[kg\], in place of the motors that the study states.
    pub(super) fn drive_mass(&self, architecture: Architecture, drive: &Drive) -> f64 {
        let motor = self.settings().joints.of_leg(architecture).find(|part| part.is_motor);
        let moves = motor.filter(|motor| motor.moves);
        moves.map_or(0.0, |motor| LEGS as f64 * (drive.mass - motor.mass))
    }

    /// Returns the largest share of its limits that a selected drive may use: 1, or what the study allows.
    fn allowed_utilization(&self) -> f64 {
        let limits = self.settings().limits.iter();
        let of_drives = limits.filter(|limit| limit.quantity == Quantity::DriveUtilization);
        of_drives.filter_map(|limit| limit.bound.most()).fold(1.0, f64::min)
    }

    /// Moves a design along a task with the lightest drive that keeps the limit of its utilization, if the study has a catalogue, or with the motors and rotors
    /// that it states. The forces are linear in the mass and in the inertia of a drive, so that two motions tell which drives are worth
    /// a motion of their own.
    pub(super) fn follow_driven(
        &self,
        design: &Design,
        task: &Task,
        frame: &TaskFrame,
    ) -> (TaskOutcome, Vec<TaskSample>) {
        let mut posed = self.posed(design);
        let drives: Vec<(usize, &Drive)> = self.settings().drive_catalogue.of_kind(posed.actuator()).collect();
        if drives.is_empty() {
            return posed.follow(task, frame);
        }
        let mut followed = |mass: f64, inertia: f64| {
            self.set_drive(&mut posed, mass, inertia);
            posed.follow(task, frame)
        };
        let (outcome, samples) = followed(0.0, 0.0);
        // Whether the design reaches the path does not depend on its drives.
        let (Some(motion), Some(_)) = (&outcome.motion, outcome.figures()) else {
            return (outcome, samples);
        };
        let moves = design.architecture().driven() > 0;
        let heavier = moves.then(|| followed(1.0, 0.0).1);
        let estimate = |drive: &Drive| {
            let forces = samples.iter().enumerate().map(|(place, sample)| {
                let of_unit = heavier.as_ref().and_then(|samples| samples.get(place));
                let (without, rates) = (sample.response.forces, sample.response.accelerations);
                [0, 1, 2].map(|leg: usize| {
                    let per_mass = of_unit.map_or(0.0, |of_unit| of_unit.response.forces[leg] - without[leg]);
                    without[leg] + drive.mass * per_mass + drive.inertia * rates[leg]
                })
            });
            drive.utilization(&TaskFigures::with_forces(&samples, forces, motion))
        };
        let estimated: Vec<f64> = drives.iter().map(|(_, drive)| estimate(drive)).collect();
        let mut selected = |index: usize| {
            let (place, drive) = drives[index];
            let (mut outcome, samples) = followed(drive.mass, drive.inertia);
            let utilization = outcome.figures().map(|figures| drive.utilization(figures));
            outcome.drive = utilization.map(|utilization| SelectedDrive { place, utilization });
            (outcome, samples)
        };
        let allowed = self.allowed_utilization();
        for index in 0..drives.len() {
            if estimated[index] <= allowed + ROUNDING {
                let found = selected(index);
                if found.0.drive.is_some_and(|drive| drive.utilization <= allowed) {
                    return found;
                }
            }
        }
        let nearest = (0..drives.len()).min_by(|&a, &b| estimated[a].total_cmp(&estimated[b]));
        selected(nearest.unwrap_or(0))
    }
}
