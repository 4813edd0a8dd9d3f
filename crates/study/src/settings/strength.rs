//! The loads under which stress, buckling and the forces of joints and drives are computed (docs/model.md, section 14.6).

use serde::{Deserialize, Serialize};

use super::RequirementSection;
use super::declare::{Check, Initial, section};
use kinefront_model::strength::{LoadShape, Loads};

/// Shape of the set of wrenches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LoadShapeChoice {
    /// Each component varies by itself.
    Box,
    /// The force in the plane has any direction.
    Cylinder,
    /// All components vary together.
    Ellipsoid,
}

section! {
    /// Loads of the members, joints and drives.
    pub struct StrengthSection in "strength" {
        /// Force on the platform at `P`, along the axes of the base.
        force_n: [f64; 3] = [0.0; 3], Check::Within(-1e12, 1e12, "");
        /// Moment on the platform, about the axes of the base.
        moment_nm: [f64; 3] = [0.0; 3], Check::Within(-1e12, 1e12, "");
        /// Shape of the set of wrenches around the given one: a box, a cylinder (any direction in the plane) or an ellipsoid.
        shape: LoadShapeChoice = LoadShapeChoice::Cylinder, Check::Choice(&["box", "cylinder", "ellipsoid"]);
        /// Acceleration of gravity, along the axes of the base; [0, -9.81, 0] for a manipulator whose plane is vertical.
        gravity_m_per_s2: [f64; 3] = [0.0, 0.0, -9.81], Check::Within(-1e6, 1e6, "");
        optional {
            /// Largest deviation of the force from the given one; if omitted, the forces of the requirements.
            force_range_n: [f64; 3], Check::NonNegative, Initial::AsText;
            /// Largest deviation of the moment from the given one; if omitted, the torque of the requirements.
            moment_range_nm: [f64; 3], Check::NonNegative, Initial::AsText;
        }
    }
}

impl StrengthSection {
    /// Returns the loads of a study with the given requirements.
    pub fn loads(&self, requirements: &RequirementSection) -> Loads {
        let force = self.force_range_n.unwrap_or([
            requirements.in_plane_force_n,
            requirements.in_plane_force_n,
            requirements.vertical_force_n,
        ]);
        let moment = self.moment_range_nm.unwrap_or([0.0, 0.0, requirements.torque_z_nm]);
        let both = |[a, b, c]: [f64; 3], [d, e, f]: [f64; 3]| [a, b, c, d, e, f];
        Loads {
            wrench: both(self.force_n, self.moment_nm),
            range: both(force, moment),
            shape: match self.shape {
                LoadShapeChoice::Box => LoadShape::Box,
                LoadShapeChoice::Cylinder => LoadShape::Cylinder,
                LoadShapeChoice::Ellipsoid => LoadShape::Ellipsoid,
            },
            gravity: self.gravity_m_per_s2,
        }
    }
}
