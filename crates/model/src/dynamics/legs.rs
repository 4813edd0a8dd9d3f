//! The legs at several poses at once as their motion sees them.

use super::DynamicsModel;
use crate::lanes::{Planar, Real, dot};
use crate::spatial::LEGS;
use crate::strength::StrengthInputs;
use crate::strength::path::PathLanes;

/// What the motion at several poses follows from.
#[derive(Clone, Copy)]
pub(crate) struct DynamicsInputs<V: Real> {
    /// `P` \[m\].
    pub position: Planar<V>,
    /// The legs with their compliances.
    pub legs: StrengthInputs<V>,
}

/// A leg at several poses at once.
#[derive(Clone, Copy)]
pub(crate) struct MovingLeg<V> {
    pub path: PathLanes<V>,
    /// Twists of the platform at `P` for a unit rate of each joint.
    pub twists: [[V; 3]; 3],
    /// Rate of each joint for a unit of each component of the twist of the platform: rows of the inverse of the twists.
    pub rates: [[V; 3]; 3],
    /// Unit wrench along the line of the leg: `u_i` and its moment about `P`.
    pub wrench: [V; 3],
    /// `B_ii`, along the joint value.
    pub transmission: V,
    /// Column of `A⁻¹`: the motion of the platform for a unit of motion along the line of this leg.
    pub column: [V; 3],
}

impl<V: Real> MovingLeg<V> {
    /// Returns the moment of the line of the leg about a place.
    #[inline(always)]
    pub(super) fn lever(&self, place: Planar<V>) -> V {
        let [x, y, moment] = self.wrench;
        moment - place.cross(Planar::new(x, y))
    }
}

impl DynamicsModel {
    /// Returns the legs at several poses at once.
    #[inline(always)]
    pub fn legs<V: Real>(&self, inputs: &DynamicsInputs<V>) -> [MovingLeg<V>; LEGS] {
        let rows = [row(inputs, 0), row(inputs, 1), row(inputs, 2)];
        let columns = V::inverse_transpose(&rows);
        [
            self.leg(inputs, 0, rows[0], columns[0]),
            self.leg(inputs, 1, rows[1], columns[1]),
            self.leg(inputs, 2, rows[2], columns[2]),
        ]
    }

    #[inline(always)]
    fn leg<V: Real>(&self, inputs: &DynamicsInputs<V>, index: usize, wrench: [V; 3], column: [V; 3]) -> MovingLeg<V> {
        let of = &self.paths[index];
        let path = of.at(&inputs.legs.legs[index], inputs.legs.arms[index]);
        let twists = [of.twist(&path, 0), of.twist(&path, 1), of.twist(&path, 2)];
        MovingLeg {
            path,
            twists,
            rates: V::inverse_transpose(&twists),
            wrench,
            transmission: dot(&wrench, &twists[self.driven]),
            column,
        }
    }

    /// Returns the cosine and sine of the orientation of the platform at several poses at once.
    #[inline(always)]
    pub(super) fn turn<V: Real>(&self, inputs: &DynamicsInputs<V>) -> Planar<V> {
        let arm = inputs.legs.arms[0];
        let joint = Planar::splat(arm.x, self.first_joint / self.first_joint.length_squared());
        Planar::new(joint.dot(arm), joint.cross(arm))
    }
}

/// Returns the row of `A` of a leg.
#[inline(always)]
fn row<V: Real>(inputs: &DynamicsInputs<V>, index: usize) -> [V; 3] {
    let leg = &inputs.legs.legs[index];
    [leg.u.x, leg.u.y, leg.moment]
}
