//! What has to hold at every pose of the region, or of the design as a whole.

use kinefront_model::evaluation::PoseScalar;

use super::place::Place;

/// Value of a requirement at a pose where it has none.
pub(crate) const NOWHERE: f64 = -50.0;

/// One end of the travel of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum End {
    /// The smallest value.
    Lower,
    /// The largest value.
    Upper,
}

/// Something that has to hold at every pose of the region, or of the design as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Requirement {
    /// A prismatic joint of a leg (0, 1, 2 from the base) does not pass an end of its travel (g2).
    Limit {
        /// The leg: 0, 1 or 2.
        leg: usize,
        /// The joint: 0, 1 or 2 from the base.
        joint: usize,
        /// The end.
        end: End,
    },
    /// The bars of a leg are long enough (g2).
    EndOfReach {
        /// The leg: 0, 1 or 2.
        leg: usize,
    },
    /// A scalar keeps its limit at each pose.
    Scalar(PoseScalar),
    /// `det A` has one sign, if no dexterity is required.
    Determinant,
    /// A limit of the question that is none of poses, by its place.
    Quantity(usize),
    /// The base lies within the limit of the footprint, of which a scalar or a quantity compares the members alone.
    Base,
    /// g1: a leg and the platform bridge the distance to the base.
    Assembly,
}

/// Requirements of one kind are missed together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// g2.
    Reach,
    /// Any other requirement.
    Other(Requirement),
}

impl End {
    /// Returns the name of the end, as of the bounds of a variable.
    pub(crate) fn name(self) -> &'static str {
        match self {
            End::Lower => "lower",
            End::Upper => "upper",
        }
    }

    /// Returns the sign of what keeps a value off the end: 1 for the smallest value.
    pub(crate) fn sign(self) -> f64 {
        match self {
            End::Lower => 1.0,
            End::Upper => -1.0,
        }
    }
}

impl Requirement {
    /// Returns the kind.
    pub(crate) fn kind(self) -> Kind {
        if self.is_of_reach() {
            Kind::Reach
        } else {
            Kind::Other(self)
        }
    }

    /// Returns whether the requirement is one of g2.
    pub(crate) fn is_of_reach(self) -> bool {
        matches!(self, Requirement::Limit { .. } | Requirement::EndOfReach { .. })
    }

    /// Returns whether thicker bars can restore the requirement.
    pub(crate) fn is_of_bars(self) -> bool {
        matches!(self, Requirement::Scalar(scalar) if scalar.entry().is_of_bars)
    }

    /// Returns whether another requirement is the same but for the leg.
    pub(crate) fn is_alike(self, other: Self) -> bool {
        let without_leg = |requirement: Self| match requirement {
            Requirement::Limit { joint, end, .. } => Requirement::Limit { leg: 0, joint, end },
            Requirement::EndOfReach { .. } => Requirement::EndOfReach { leg: 0 },
            other => other,
        };
        without_leg(self) == without_leg(other)
    }

    /// Returns the leg (0, 1, 2) that the requirement is of.
    pub fn leg(self) -> Option<usize> {
        match self {
            Requirement::Limit { leg, .. } | Requirement::EndOfReach { leg } => Some(leg),
            _ => None,
        }
    }
}

/// A pose at which a requirement is nearest to being missed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Critical {
    /// The requirement.
    pub requirement: Requirement,
    /// The pose; of no meaning for a requirement of the design as a whole.
    pub place: Place,
    /// By how much it holds there, as a logarithm or a share of `R`; negative where it does not.
    pub slack: f64,
}

impl Critical {
    /// Returns whether the requirement is active at the pose.
    pub fn is_active(&self) -> bool {
        self.slack <= ACTIVE
    }
}

/// Requirements and bounds with no more slack than this are active.
pub(crate) const ACTIVE: f64 = 2e-6;

/// Returns the name of the limit of a scalar as a parameter.
pub(crate) fn threshold_name(scalar: PoseScalar) -> &'static str {
    match scalar {
        PoseScalar::Dexterity => "inverse_condition_min",
        PoseScalar::StiffnessXy => "k_xy_min",
        PoseScalar::StiffnessZ => "k_z_min",
        PoseScalar::StiffnessPhiZ => "k_phi_z_min",
        PoseScalar::Clearance => "clearance_min",
        other => other.entry().quantity.key,
    }
}
