//! Joints and motors (docs/model.md, section 5.1).

use super::declare::{Check, section};
use kinefront_model::mechanism::{CylinderSize, JointMasses, JointSizes};

section! {
    /// Masses of joints and motors. They count in the mass in motion where they move.
    pub struct JointSection in "joints" {
        /// Mass of a revolute joint; one on the base does not move.
        revolute_kg: f64 = 0.0, Check::Within(0.0, 1e6, " kg");
        /// Mass of the carriage of a prismatic joint.
        carriage_kg: f64 = 0.0, Check::Within(0.0, 1e6, " kg");
        /// Mass of the motor of an actuated joint; one on the base does not move.
        motor_kg: f64 = 0.0, Check::Within(0.0, 1e6, " kg");
        /// Radius of a revolute joint, an upright cylinder that no member may touch; 0 for a joint without a body.
        revolute_radius_m: f64 = 0.0, Check::Within(0.0, 1e3, " m");
        /// Height of a revolute joint; a pin of the same radius reaches to the members that it joins in any case.
        revolute_height_m: f64 = 0.0, Check::Within(0.0, 1e3, " m");
        /// Radius of the motor of an actuated revolute joint, an upright cylinder on the side of the base; 0 for one without a body.
        motor_radius_m: f64 = 0.0, Check::Within(0.0, 1e3, " m");
        /// Height of that motor.
        motor_height_m: f64 = 0.0, Check::Within(0.0, 1e3, " m");
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

impl From<&JointSection> for JointSizes {
    fn from(section: &JointSection) -> Self {
        Self {
            revolute: CylinderSize {
                radius: section.revolute_radius_m,
                height: section.revolute_height_m,
            },
            motor: CylinderSize {
                radius: section.motor_radius_m,
                height: section.motor_height_m,
            },
        }
    }
}
