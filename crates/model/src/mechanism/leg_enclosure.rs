//! Enclosures of what a leg is over a box of poses.

use super::chain_enclosure::ChainEnclosure;
use crate::enclosure::{PlanarModel, TaylorModel};

/// Loads of the bars of a leg whose line is not that of its distal bar, with moments as multiples of `L_b`. Each holds the
/// component of the force along the bar, then the moments about its proximal and its distal end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnclosedLoads {
    /// Bar from `B_i` to `C_i`.
    pub distal: [TaylorModel; 3],
    /// Bar from `A_i` to `B_i`; meaningless if there is none.
    pub proximal: [TaylorModel; 3],
    /// Bar from `C_i` to `P`; the component of the force is multiplied by `r_i/r`.
    pub platform: [TaylorModel; 3],
}

/// What the constraints need of a leg, over a box of poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegEnclosure {
    /// The chain.
    pub chain: ChainEnclosure,
    /// Unit vector from `P` to `C_i`.
    pub arm: PlanarModel,
    /// `u_i` in base axes.
    pub u: PlanarModel,
    /// Moment of the leg's line about `P`, as a multiple of `r`.
    pub moment: TaylorModel,
    /// Component of `C_i − P` along the distal bar, as a multiple of `r`.
    pub along: TaylorModel,
    /// Moment about `P` of a unit vector on the line of the distal bar, as a multiple of `r`.
    pub across: TaylorModel,
    /// Square of the transmission `B_ii`, in units of `L_b` for a revolute joint.
    pub transmission_square: TaylorModel,
    /// Loads of the bars; `None` if the line is that of the distal bar.
    pub loads: Option<EnclosedLoads>,
}
