//! Strength, buckling, and the forces of joints and drives (docs/model.md, section 14).

use crate::lanes::{LaneJob, Planar, Real};
use crate::mechanism::Leg;
use crate::pose::PoseChecker;
use crate::spatial::LEGS;
use crate::stiffness::{NoSliders, StiffnessModel};
use crate::strength::{LegLoadPath, LegStiffness, StrengthInputs, StrengthJob, StrengthSet, StrengthValue};

/// What the strength follows from, as a function of its own: it is the only part that depends on the type of the legs.
struct Inputs<'a, L, V> {
    checker: &'a PoseChecker<L>,
    stiffness: &'a StiffnessModel,
    position: Planar<V>,
    arms: &'a [Planar<V>; LEGS],
}

impl<L: Leg, V: Real> LaneJob for Inputs<'_, L, V> {
    type Output = StrengthInputs<V>;

    #[inline(always)]
    fn run(self) -> StrengthInputs<V> {
        self.checker.strength_inputs(self.stiffness, self.position, self.arms)
    }
}

impl<L: Leg> PoseChecker<L> {
    /// Returns what the strength at several poses at once follows from.
    #[inline(always)]
    pub(crate) fn strength_inputs<V: Real>(
        &self,
        stiffness: &StiffnessModel,
        position: Planar<V>,
        arms: &[Planar<V>; LEGS],
    ) -> StrengthInputs<V> {
        let legs = self.leg_lanes(position, arms);
        let (along, bending) = if L::MAY_BE_ON_RAILS && stiffness.is_on_bending_rails() {
            stiffness.leg_compliance_lanes(&legs, arms, &self.slider_lanes(position, arms, &legs))
        } else {
            stiffness.leg_compliance_lanes(&legs, arms, &NoSliders)
        };
        StrengthInputs {
            legs: [
                LegLoadPath::of(&legs[0]),
                LegLoadPath::of(&legs[1]),
                LegLoadPath::of(&legs[2]),
            ],
            arms: *arms,
            along,
            stiffness: [
                at_platform(&bending[0]),
                at_platform(&bending[1]),
                at_platform(&bending[2]),
            ],
        }
    }
}

/// Returns the stiffness of a leg of which the compliance at `P` is given.
#[inline(always)]
fn at_platform<V: Real>(bending: &[V; 6]) -> LegStiffness<V> {
    LegStiffness {
        at_platform: V::symmetric_inverse(bending),
        at_centre: None,
    }
}

/// Computes the values of a set at several poses at once; where there is none, the worst number, which is infinite.
#[inline(always)]
pub(super) fn lanes<L: Leg, V: Real>(
    checker: &PoseChecker<L>,
    position: Planar<V>,
    arms: &[Planar<V>; LEGS],
    set: StrengthSet,
) -> [V; StrengthValue::COUNT] {
    let like = position.x;
    let (Some(model), Some(stiffness)) = (&checker.strength, &checker.stiffness) else {
        return StrengthValue::none(like);
    };
    let inputs = &inputs(checker, stiffness, position, arms);
    like.call_apart(StrengthJob { model, inputs, set })
}

/// Returns what the strength at several poses at once follows from.
#[inline(always)]
pub(super) fn inputs<L: Leg, V: Real>(
    checker: &PoseChecker<L>,
    stiffness: &StiffnessModel,
    position: Planar<V>,
    arms: &[Planar<V>; LEGS],
) -> StrengthInputs<V> {
    position.x.call_apart(Inputs {
        checker,
        stiffness,
        position,
        arms,
    })
}
