//! Joints of a leg: their kinds, and where they are.

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
    /// The motor of a driven joint.
    pub motor: f64,
}

impl JointMasses {
    /// Returns the mass of a joint of a kind without its motor \[kg\].
    pub fn of(&self, kind: JointKind) -> f64 {
        match kind {
            JointKind::Prismatic => self.carriage,
            JointKind::Revolute => self.revolute,
        }
    }
}

impl JointKind {
    /// Returns whether a joint of the kind moves at a place in its leg, from 0 at the base: a revolute joint on the base does not, the
    /// carriage of a rail does.
    pub fn moves(self, place: usize) -> bool {
        place > 0 || self == JointKind::Prismatic
    }
}

/// Point of a leg at which a revolute joint can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointPoint {
    /// `A_i`.
    A,
    /// `B_i`; a telescopic leg has `B_i = A_i`.
    B,
    /// `C_i`.
    C,
}
