//! Joints and motors (docs/model.md, section 5.1).

use super::declare::{Check, section};
use kinefront_model::mechanism::JointMasses;

section! {
    /// Masses of joints and motors. They count in the mass in motion where they move.
    pub struct JointSection in "joints" {
        /// Mass of a revolute joint; one on the base does not move.
        revolute_kg: f64 = 0.0, Check::Within(0.0, 1e6, " kg");
        /// Mass of the carriage of a prismatic joint.
        carriage_kg: f64 = 0.0, Check::Within(0.0, 1e6, " kg");
        /// Mass of the motor of an actuated joint; one on the base does not move.
        motor_kg: f64 = 0.0, Check::Within(0.0, 1e6, " kg");
    }
}

impl From<&JointSection> for JointMasses {
    fn from(section: &JointSection) -> Self {
        Self {
            revolute: section.revolute_kg,
            carriage: section.carriage_kg,
            motor: section.motor_kg,
        }
    }
}
