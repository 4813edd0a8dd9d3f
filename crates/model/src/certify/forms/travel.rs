//! What a design does along a motion, over an interval of time (docs/model.md, section 15.11).

use super::strength::planar;
use super::{Enclosures, Forms, ProvedForms, ReachForms, determinant, enclose_legs};
use crate::dynamics::{DynamicsInputs, DynamicsModel, EnclosedMotion};
use crate::enclosure::TaylorModel;
use crate::evaluation::Model;
use crate::mechanism::Design;
use crate::spatial::{LEGS, Pose};

/// What a design does over an interval of time.
pub(in super::super) struct Travel {
    /// Distances from the joint limits and the ends of reach \[m\].
    pub reach: Vec<TaylorModel>,
    /// `det A`, up to a positive factor, with the sign that it has where the motion begins.
    pub determinant: TaylorModel,
    /// Rate of each actuated joint, and force of its actuator.
    pub drives: [[TaylorModel; 2]; LEGS],
}

/// The forms of a motion.
pub(in super::super) struct TravelForms<'a> {
    forms: Forms<'a>,
    dynamics: DynamicsModel,
}

impl<'a> TravelForms<'a> {
    /// Prepares the forms of a design for a motion that begins at a pose; `None` for bars without a usable stiffness.
    pub fn new(model: &'a Model, design: &'a Design, begin: &Pose) -> Option<Self> {
        let mut forms = Forms::new(model, design).ok()?.with_sign_at(begin);
        forms.reach = Some(ReachForms::without_limit(model, design));
        Some(Self {
            forms,
            dynamics: model.dynamics_in_motion(design)?,
        })
    }

    /// Encloses what the design does over an interval of a motion.
    ///
    /// # Errors
    /// Where a leg may not reach, nothing else is known: whether it reaches nowhere on the interval.
    pub fn enclose(&self, motion: &EnclosedMotion) -> Result<Travel, bool> {
        let forms = &self.forms;
        let legs = enclose_legs(forms.model, forms.design, &forms.frames, &motion.pose);
        let reaches = || legs.iter().flat_map(|leg| leg.chain.reach);
        if !reaches().all(|reach| reach.is_positive()) {
            return Err(reaches().any(|reach| reach.is_negative()));
        }
        let mut distances = Enclosures::new(ProvedForms::default());
        forms.enclose_reach(&motion.pose, &legs, &mut distances);
        let inputs = DynamicsInputs {
            position: planar(motion.pose.position),
            legs: forms.load_inputs(&legs),
        };
        Ok(Travel {
            reach: distances.iter().map(|(_, value)| *value).collect(),
            determinant: determinant(&legs).times(forms.sign),
            drives: self.dynamics.enclose_drives(&inputs, motion.twist, motion.acceleration),
        })
    }
}
