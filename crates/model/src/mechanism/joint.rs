//! Joints of a leg: their kinds, where they are, and what moves of them.

use super::Architecture;

/// Kind of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointKind {
    /// Prismatic joint, with the joint value in metres and the stiffness of its actuator in N/m.
    Prismatic,
    /// Revolute joint about z, with the joint value in radians and the stiffness of its actuator in N·m/rad.
    Revolute,
}

impl JointKind {
    /// Returns the letter of the joint in the name of an architecture.
    pub fn letter(self) -> &'static str {
        match self {
            JointKind::Prismatic => "P",
            JointKind::Revolute => "R",
        }
    }

    /// Returns the unit of the effort of a drive.
    pub fn effort_unit(self) -> &'static str {
        match self {
            JointKind::Prismatic => "N",
            JointKind::Revolute => "N·m",
        }
    }

    /// Returns the unit of the joint value.
    pub fn unit(self) -> &'static str {
        match self {
            JointKind::Prismatic => "m",
            JointKind::Revolute => "rad",
        }
    }
}

/// Masses of joints and motors \[kg\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct JointMasses {
    /// A revolute joint.
    pub revolute: f64,
    /// The carriage of a prismatic joint.
    pub carriage: f64,
    /// The motor of an actuated joint.
    pub motor: f64,
}

/// Size of an upright cylinder \[m\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CylinderSize {
    /// Radius.
    pub radius: f64,
    /// Height.
    pub height: f64,
}

/// Sizes of joints and motors, which are upright cylinders. One of radius 0 is a point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct JointSizes {
    /// A revolute joint.
    pub revolute: CylinderSize,
    /// The motor of an actuated revolute joint.
    pub motor: CylinderSize,
}

/// A joint of a leg without its motor, or the motor of the actuated joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointPart {
    /// Place of the joint in its leg, from 0 at the base.
    pub place: usize,
    /// Kind of the joint.
    pub kind: JointKind,
    /// Whether it is the motor.
    pub is_motor: bool,
    /// Whether it moves: a revolute joint and a motor on the base do not, the carriage of a rail does.
    pub moves: bool,
    /// Mass \[kg\].
    pub mass: f64,
}

impl JointMasses {
    /// Returns the joints of a leg from the base, and then the motor.
    pub fn of_leg(self, architecture: Architecture) -> impl Iterator<Item = JointPart> {
        let joints = architecture.chain().joints;
        let joint = move |place: usize| JointPart {
            place,
            kind: joints[place],
            is_motor: false,
            moves: place > 0 || joints[place] == JointKind::Prismatic,
            mass: match joints[place] {
                JointKind::Prismatic => self.carriage,
                JointKind::Revolute => self.revolute,
            },
        };
        let driven = architecture.driven();
        let motor = JointPart {
            is_motor: true,
            moves: driven > 0,
            mass: self.motor,
            ..joint(driven)
        };
        (0..joints.len()).map(joint).chain([motor])
    }
}

/// Point of a leg at which a revolute joint can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum JointPoint {
    /// `A_i`.
    A,
    /// `B_i`; a telescopic leg has `B_i = A_i`.
    B,
    /// `C_i`.
    C,
}
