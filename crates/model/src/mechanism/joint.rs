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
    /// Returns the unit of the joint value.
    pub fn unit(self) -> &'static str {
        match self {
            JointKind::Prismatic => "m",
            JointKind::Revolute => "rad",
        }
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
