//! Forces and moments of the joints and of the drives at several poses at once (docs/model.md, sections 14.3 and 14.6).

use super::resultants::LoadedLeg;
use super::{LoadShape, StrengthModel};
use crate::lanes::Real;
use crate::spatial::LEGS;

/// What a joint has to hold, at its worst.
#[derive(Clone, Copy)]
pub(super) struct JointLoads<V> {
    /// Force in the plane: of a prismatic joint across its direction \[N\].
    pub radial: V,
    /// Force along z \[N\].
    pub axial: V,
    /// Both together \[N\].
    pub force: V,
    /// Tilting moment, of a prismatic joint all of the moment \[N·m\].
    pub moment: V,
}

#[inline(always)]
fn norm<V: Real>(a: V, b: V) -> V {
    (a * a + b * b).sqrt()
}

impl StrengthModel {
    /// Returns what a joint of leg `index` has to hold.
    #[inline(always)]
    pub(super) fn joint_loads<V: Real>(&self, leg: &LoadedLeg<'_, V>, index: usize, joint: usize) -> JointLoads<V> {
        let place = leg.path.joints[joint];
        let beyond = self.beyond_joint(leg.path, &leg.from, index, joint);
        let carried = self.resultants(leg, (place, leg.lever(place)), &beyond);
        let (u, normal) = (leg.u, leg.u.perp());
        let along = self.about(leg, place, carried.moment, u);
        let across = self.about(leg, place, carried.moment, normal);
        let is_revolute = self.paths[index].is_revolute(joint);
        let zero = leg.moment.splat(0.0);
        let (radial, radial_range) = if is_revolute {
            (norm(carried.force.x, carried.force.y), leg.line.range)
        } else {
            let slide = leg.path.slides[joint];
            (slide.cross(carried.force).abs(), slide.cross(u).abs() * leg.line.range)
        };
        let (turn, turn_range) = if is_revolute {
            (zero, zero)
        } else {
            (carried.turn.value, carried.turn.range)
        };
        let lift = carried.lift;
        let [most_radial, most_axial] = [radial + radial_range, lift.most()];
        let (force, moment) = match self.loads.shape {
            LoadShape::Box | LoadShape::Cylinder => (
                norm(most_radial, most_axial),
                norm(norm(along.most(), across.most()), turn.abs() + turn_range),
            ),
            LoadShape::Ellipsoid => (
                norm(radial, lift.value) + radial_range.larger(lift.range),
                norm(norm(along.value, across.value), turn) + norm(along.range, across.range).larger(turn_range),
            ),
        };
        JointLoads {
            radial: most_radial,
            axial: most_axial,
            force,
            moment,
        }
    }

    /// Returns the largest force and the largest moment of any joint.
    #[inline(always)]
    pub(super) fn largest_joint_loads<V: Real>(&self, legs: &[LoadedLeg<'_, V>]) -> [V; 2] {
        let zero = legs[0].moment.splat(0.0);
        let (mut force, mut moment) = (zero, zero);
        for (index, leg) in legs.iter().enumerate() {
            for joint in 0..LEGS {
                let loads = self.joint_loads(leg, index, joint);
                force = force.larger(loads.force);
                moment = moment.larger(loads.moment);
            }
        }
        [force, moment]
    }

    /// Returns the largest force or torque of any drive.
    #[inline(always)]
    pub(super) fn largest_effort<V: Real>(&self, legs: &[LoadedLeg<'_, V>]) -> V {
        let mut most = legs[0].moment.splat(0.0);
        for leg in legs {
            most = most.larger(leg.transmission.abs() * leg.line.most());
        }
        most
    }
}
