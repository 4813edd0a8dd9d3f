//! What a task asks of a manipulator, whatever its design (docs/model.md, section 15).

use crate::mechanism::JointKind;

/// A body that the platform carries.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Payload {
    /// Mass \[kg\].
    pub mass: f64,
    /// Moment of inertia about z through its own centre of mass \[kg·m²\].
    pub inertia: f64,
    /// Centre of mass from `P`, in the axes of the platform \[m\].
    pub centre: [f64; 2],
}

/// What drives move besides the members.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DriveInertia {
    /// Mass of a slider on a rail \[kg\].
    pub slider_mass: f64,
    /// Inertia of the rotor, reflected to a prismatic actuator \[kg\].
    pub prismatic: f64,
    /// Inertia of the rotor, reflected to a revolute actuator \[kg·m²\].
    pub revolute: f64,
}

impl DriveInertia {
    /// Sets the reflected inertia of the actuators of the given kind \[kg or kg·m²\].
    pub(crate) fn set(&mut self, actuator: JointKind, inertia: f64) {
        match actuator {
            JointKind::Prismatic => self.prismatic = inertia,
            JointKind::Revolute => self.revolute = inertia,
        }
    }

    /// Returns the reflected inertia of an actuator of the given kind \[kg or kg·m²\].
    pub fn of(&self, actuator: JointKind) -> f64 {
        match actuator {
            JointKind::Prismatic => self.prismatic,
            JointKind::Revolute => self.revolute,
        }
    }
}

/// Motion and load that every pose must allow in any direction.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Anywhere {
    /// Speed of `P` \[m/s\].
    pub velocity: f64,
    /// Rate of rotation of the platform \[rad/s\].
    pub omega: f64,
    /// Acceleration of `P` \[m/s²\].
    pub acceleration: f64,
    /// Angular acceleration of the platform \[rad/s²\].
    pub alpha: f64,
    /// Force on the platform at `P` \[N\].
    pub force: f64,
    /// Moment on the platform about z \[N·m\].
    pub moment: f64,
}

/// Errors of manufacture, assembly and control, each in both directions and independent of the others.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tolerances {
    /// Error of a prismatic actuator \[m\].
    pub encoder_prismatic: f64,
    /// Error of a revolute actuator \[rad\].
    pub encoder_revolute: f64,
    /// Error of the length of each link; of a telescopic leg, of the zero of its length \[m\].
    pub link: f64,
    /// Radius of the disc in which each base joint or end of a rail lies \[m\].
    pub base: f64,
    /// Radius of the disc in which each platform joint lies, in the axes of the platform \[m\].
    pub platform: f64,
    /// Radial clearance of each revolute joint \[m\].
    pub play: f64,
}

impl Tolerances {
    /// Returns the error of an actuator of the given kind \[m or rad\].
    pub fn encoder(&self, actuator: JointKind) -> f64 {
        match actuator {
            JointKind::Prismatic => self.encoder_prismatic,
            JointKind::Revolute => self.encoder_revolute,
        }
    }
}

/// What a task asks of a manipulator. The default asks nothing, and gravity acts across the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DynamicsSettings {
    /// What the platform carries.
    pub payload: Payload,
    /// What the drives move besides the members.
    pub drives: DriveInertia,
    /// Acceleration of gravity in base axes \[m/s²\]. Its part in the plane loads the actuators.
    pub gravity: [f64; 3],
    /// Force in the plane and moment about z that the surroundings exert on the platform at `P`, in base axes \[N, N·m\].
    pub tool: [f64; 3],
    /// Motion and load in any direction.
    pub anywhere: Anywhere,
    /// Errors of manufacture, assembly and control.
    pub tolerances: Tolerances,
}

impl Default for DynamicsSettings {
    fn default() -> Self {
        Self {
            payload: Payload::default(),
            drives: DriveInertia::default(),
            gravity: [0.0, 0.0, -9.81],
            tool: [0.0; 3],
            anywhere: Anywhere::default(),
            tolerances: Tolerances::default(),
        }
    }
}

impl DynamicsSettings {
    /// Returns whether a rotation by 120° about z changes nothing. The load of a tool counts for motions alone.
    pub fn is_three_fold(&self) -> bool {
        let [x, y, _] = self.gravity;
        let is_centred = self.payload.mass == 0.0 || self.payload.centre == [0.0; 2];
        x == 0.0 && y == 0.0 && is_centred
    }
}
