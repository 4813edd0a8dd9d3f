//! The model of a study: its settings, whose grids fit the workspace, and what holds of every design.

use std::sync::Arc;

use glam::DVec2;

use super::{
    Bound, Constraint, Evaluation, ModelSettings, PoseScalar, Quantity, QuantityLimit, QuantitySet, Thresholds,
};
use crate::clearance::{Barrier, StackOrder};
use crate::dynamics::{Drive, DynamicsSettings, MotionValue};
use crate::kinematics::{CharacteristicLength, Jacobian};
use crate::mechanism::{AnyLeg, Design, JointKind, JointMasses, Leg, Manipulator};
use crate::spatial::{LEGS, Pose, Rotation};
use crate::workspace::{GridError, WorkspaceSampling};

/// One of the two grids.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GridChoice {
    /// Reference grid, for searching.
    Reference,
    /// Fine grid, for verifying reported designs.
    Fine,
}

/// [`ModelSettings`] whose grids fit the workspace, so that every design can be evaluated.
///
/// A model reads like its settings; to change one, change the settings and build the model again:
///
/// ```
/// use kinefront_model::evaluation::{Model, ModelSettings};
/// use kinefront_model::workspace::GridError;
///
/// let settings = ModelSettings { platform_bars: 1, ..ModelSettings::default() };
/// assert_eq!(Model::new(settings.clone())?.settings().platform_bars, 1);
///
/// let mut settings = settings;
/// settings.workspace.rotation_range_deg = 7.0;
/// assert!(matches!(Model::new(settings), Err(GridError::WindowNotWhole { .. })));
/// # Ok::<(), GridError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    settings: ModelSettings,
    reference: WorkspaceSampling,
    fine: WorkspaceSampling,
    barriers: Arc<[Barrier]>,
}

impl Default for Model {
    /// The paper's model.
    fn default() -> Self {
        Self::new(ModelSettings::default()).expect("the paper's grids fit its rotation range")
    }
}

impl Model {
    /// The settings that the model was built from.
    pub fn settings(&self) -> &ModelSettings {
        &self.settings
    }

    /// The model of the given settings.
    ///
    /// # Errors
    /// [`GridError::WindowNotWhole`] when a grid does not fit the rotation range.
    pub fn new(settings: ModelSettings) -> Result<Self, GridError> {
        let on = |grid| WorkspaceSampling::new(settings.workspace.clone(), grid);
        Ok(Self {
            reference: on(settings.reference_grid)?,
            fine: on(settings.fine_grid)?,
            barriers: settings.surroundings.barriers().into(),
            settings,
        })
    }

    /// Returns the model with further quantities asked for.
    pub fn with_quantities(mut self, further: impl IntoIterator<Item = Quantity>) -> Self {
        self.settings.quantities = self.settings.quantities.iter().chain(further).collect();
        self
    }

    /// Returns the model with every quantity asked for.
    pub fn with_all_quantities(mut self) -> Self {
        self.settings.quantities = QuantitySet::all();
        self
    }

    /// Returns the model with the motors and rotors of a drive in place of those that the study states.
    pub(super) fn with_drive(&self, drive: &Drive) -> Self {
        let (dynamics, joints) = self.driven(drive.kind, drive.mass, drive.inertia);
        let mut model = self.clone();
        (model.settings.dynamics, model.settings.joints) = (dynamics, joints);
        model
    }

    /// Returns the settings of the motion and the masses of the joints with motors of a mass \[kg\] and rotors of an inertia
    /// \[kg or kg·m²\] in place of those that the study states.
    pub(super) fn driven(&self, actuator: JointKind, mass: f64, inertia: f64) -> (DynamicsSettings, JointMasses) {
        let (mut dynamics, mut joints) = (self.settings.dynamics, self.settings.joints);
        dynamics.drives.set(actuator, inertia);
        joints.motor = mass;
        (dynamics, joints)
    }

    /// The workspace to be found, sampled on the chosen grid.
    pub fn sampling(&self, choice: GridChoice) -> &WorkspaceSampling {
        match choice {
            GridChoice::Reference => &self.reference,
            GridChoice::Fine => &self.fine,
        }
    }

    /// Returns what no member may cross.
    pub(crate) fn barriers(&self) -> &Arc<[Barrier]> {
        &self.barriers
    }

    /// Returns a distance from `O` that no point of the platform's joints, and so no `P`, exceeds \[m\].
    pub(crate) fn extent(&self, design: &Design) -> f64 {
        let sizes = design.base_radius() + design.platform_radius() + 2.0 * design.link_length();
        (0..LEGS).fold(sizes, |farthest, index| {
            let leg = AnyLeg::new(design, &self.settings.legs, index);
            let corner = leg
                .reach_box()
                .map(DVec2::abs)
                .into_iter()
                .fold(DVec2::ZERO, DVec2::max);
            farthest.max(corner.length() + leg.frame().arm_length)
        })
    }

    /// Returns the characteristic length `ℓ` of a design \[m\].
    ///
    /// The isotropic length uses the orientations of the reference grid, whatever grid is evaluated, so that a design
    /// has only one length. If the design reaches none of them with `P` at `O`, the length falls back to `r`.
    pub(super) fn length<L: Leg>(&self, design: &Design, manipulator: &Manipulator<L>) -> f64 {
        match self.settings.characteristic_length {
            CharacteristicLength::PlatformRadius => design.platform_radius(),
            CharacteristicLength::Fixed(length) => length,
            CharacteristicLength::Isotropic => {
                let grid = &self.settings.reference_grid;
                let mut largest = 0.0f64;
                for k in 0..grid.orientations() {
                    let phi = (k as f64 * grid.phi_step_deg()).to_radians();
                    let arms = manipulator.arms(&Rotation::new(phi));
                    if let Ok(posture) = manipulator.posture_at(DVec2::ZERO, &arms) {
                        let jacobian = Jacobian::new(&posture);
                        largest = jacobian
                            .moment
                            .iter()
                            .fold(largest, |max, moment| max.max(moment.abs()));
                    }
                }
                if largest > 0.0 {
                    std::f64::consts::SQRT_2 * largest
                } else {
                    design.platform_radius()
                }
            }
        }
    }

    /// Returns the home pose of an evaluated design; for an infeasible design, the home pose or the pose at which its constraints are
    /// reported.
    pub fn home(&self, evaluation: &Evaluation) -> Pose {
        let reported = || evaluation.constraints.iter().find_map(|report| report.pose);
        let home = evaluation.home.or(evaluation.reported_home);
        home.or_else(reported).unwrap_or(Pose {
            position: self.settings.workspace.centre,
            phi: 0.0,
        })
    }

    /// Returns whether a rotation by 120° about the centre of the workspace maps the design onto itself.
    pub fn is_symmetric(&self, design: &Design) -> bool {
        self.is_symmetric_in(design, self.stack_of(design).order)
    }

    /// Does the same with the legs stacked in an order.
    pub(crate) fn is_symmetric_in(&self, design: &Design, order: StackOrder) -> bool {
        order == StackOrder::Common
            && self.settings.workspace.centre == DVec2::ZERO
            && design.working_mode().is_uniform()
            && self.settings.legs.geometry.is_three_fold()
            && self.settings.surroundings.is_empty()
            && (self.settings.loads.are_three_fold() || !self.computes_any(PoseScalar::OF_LOADS))
            && (self.settings.dynamics.is_three_fold() || !self.computes_any(PoseScalar::OF_MOTION))
    }

    /// Returns whether a scalar of a pose has values for a design: some that depend on the loads do not exist for every design.
    pub fn has(&self, design: &Design, scalar: PoseScalar) -> bool {
        let on_rails = self.rails_of(design).is_some();
        let (strength, actuator) = (self.settings.material.yield_strength, design.architecture().actuator());
        let of_motion = scalar
            .of_motion()
            .is_none_or(|value| value.exists(actuator) && !(on_rails && value == MotionValue::NaturalFrequency));
        of_motion
            && scalar
                .of_strength()
                .is_none_or(|value| value.exists(strength, actuator, on_rails))
    }

    /// Returns whether a scalar of a pose tells something of a design: errors need tolerances, and speeds and forces in motion need a
    /// motion.
    pub fn tells(&self, design: &Design, scalar: PoseScalar) -> bool {
        let of_motion = scalar.of_motion();
        self.has(design, scalar) && of_motion.is_none_or(|value| value.is_asked(&self.settings.dynamics))
    }

    /// Returns the limits that concern a design: those of actuators that turn bound no design whose actuators slide, and the reverse.
    pub(crate) fn thresholds_of(&self, design: &Design) -> Thresholds {
        let mut thresholds = self.settings.thresholds;
        for (scalar, _) in self.settings.thresholds.iter() {
            if !Quantity::Worst(scalar).is_of(design) {
                thresholds.set(scalar, None);
            }
        }
        thresholds
    }

    /// Returns the limits of the scalars at each pose of a design that no constraint reports.
    pub(super) fn limits_of_poses(&self, design: &Design) -> impl Iterator<Item = QuantityLimit> {
        let thresholds = self.thresholds_of(design);
        let limits: Vec<(PoseScalar, f64)> = thresholds.iter().collect();
        let limits = limits.into_iter();
        let others = limits.filter(|(scalar, _)| Constraint::of_scalar(*scalar).is_none());
        others.map(|(scalar, threshold)| QuantityLimit {
            quantity: Quantity::Worst(scalar),
            bound: Bound::no_worse_than(threshold, scalar.entry().quantity.better),
        })
    }

    /// Returns whether an evaluation computes any of some scalars.
    pub(super) fn computes_any(&self, scalars: &[PoseScalar]) -> bool {
        let ModelSettings {
            thresholds, quantities, ..
        } = &self.settings;
        let is_asked = |scalar: PoseScalar| {
            quantities.contains(Quantity::Worst(scalar))
                || scalar == PoseScalar::NaturalFrequency && quantities.contains(Quantity::FrameFrequency)
        };
        scalars
            .iter()
            .any(|&scalar| thresholds.get(scalar).is_some() || is_asked(scalar))
    }
}
