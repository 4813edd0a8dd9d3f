//! What the strength at several poses at once follows from.

use crate::kinematics::Jacobian;
use crate::lanes::{Planar, Real};
use crate::mechanism::LegLanes;
use crate::spatial::LEGS;
use crate::stiffness::in_plane_block;

/// What the loads of a leg follow from at several poses at once.
#[derive(Clone, Copy)]
pub(crate) struct LegLoadPath<V> {
    /// Unit vector from `B_i` to `C_i`, and the distance between them along it \[m\].
    pub tangent: Planar<V>,
    pub offset: V,
    /// Unit vector along the bar from `A_i` to `B_i` in the distal axes, and the distance between them as a multiple of `L_a`, for
    /// chains that have one.
    pub proximal: Option<(Planar<V>, V)>,
    /// Unit vectors along which the prismatic joints move the platform, in the distal axes.
    pub guides: [Option<Planar<V>>; 3],
    /// Unit vector along the rail of a prismatic joint at the base, if it need not follow from the distal axes.
    pub rail: Option<Planar<V>>,
    /// `u_i`.
    pub u: Planar<V>,
    /// Moment of the leg's line about `P` \[m\].
    pub moment: V,
    /// Transmission `B_ii`, whose sign is of no importance to the largest loads.
    pub transmission: V,
}

impl<V: Real> LegLoadPath<V> {
    /// Takes what the loads follow from out of all that is known of a leg.
    #[inline(always)]
    #[allow(
        clippy::manual_map,
        reason = "a closure that is not inlined is compiled for the baseline processor"
    )]
    pub fn of(leg: &LegLanes<V>) -> Self {
        let chain = &leg.chain;
        let proximal = match &chain.proximal {
            Some(bar) => Some((bar.direction, bar.share)),
            None => None,
        };
        Self {
            tangent: chain.tangent,
            offset: chain.offset,
            proximal,
            guides: chain.guides,
            rail: None,
            u: leg.u,
            moment: leg.moment,
            transmission: leg.transmission,
        }
    }
}

/// Stiffness of a leg out of the plane at several poses at once, in base axes: force along z, and moments, per displacement along z and
/// rotations, as an upper triangle.
#[derive(Clone, Copy)]
pub(crate) struct LegStiffness<V> {
    /// `S_out,i⁻¹`, that at `P`.
    pub at_platform: [V; 6],
    /// That at another point, relative to `P` \[m\], at which force and moments are almost decoupled: enclosures stay narrow there.
    pub at_centre: Option<(Planar<V>, [V; 6])>,
}

/// What the strength at several poses follows from.
#[derive(Clone, Copy)]
pub(crate) struct StrengthInputs<V: Real> {
    pub legs: [LegLoadPath<V>; LEGS],
    /// `C_i − P` \[m\].
    pub arms: [Planar<V>; LEGS],
    /// `c_i`: compliances along the lines of the legs \[m/N\].
    pub along: [V; LEGS],
    /// Stiffness of the legs out of the plane.
    pub stiffness: [LegStiffness<V>; LEGS],
}

impl<V: Real> StrengthInputs<V> {
    /// Returns `K_out` as an upper triangle.
    #[inline(always)]
    pub fn out_of_plane(&self) -> [V; 6] {
        let mut sum = [self.along[0].splat(0.0); 6];
        for leg in &self.stiffness {
            for (sum, entry) in sum.iter_mut().zip(&leg.at_platform) {
                *sum = *sum + *entry;
            }
        }
        sum
    }

    /// Returns `K_in` as an upper triangle.
    #[inline(always)]
    pub fn in_plane(&self) -> [V; 6] {
        let one = self.along[0].splat(1.0);
        let stiffness = [one / self.along[0], one / self.along[1], one / self.along[2]];
        let legs = &self.legs;
        let jacobian = Jacobian {
            ux: [legs[0].u.x, legs[1].u.x, legs[2].u.x],
            uy: [legs[0].u.y, legs[1].u.y, legs[2].u.y],
            moment: [legs[0].moment, legs[1].moment, legs[2].moment],
            transmission: [legs[0].transmission, legs[1].transmission, legs[2].transmission],
        };
        in_plane_block(&jacobian, &stiffness)
    }
}
