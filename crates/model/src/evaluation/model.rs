//! Physical model of a study: material, actuators, thresholds, definitions, workspace and grids.

use std::sync::Arc;

use glam::DVec2;

use super::{
    Better, Bound, Constraint, Evaluation, Objective, PoseScalar, Quantity, QuantityLimit, QuantitySet, Thresholds,
};
use crate::clearance::{Barrier, Bodies, BodyBasis, BodySettings, Stack, StackOrder, Surroundings};
use crate::dynamics::{Drive, DriveCatalogue, DynamicsBasis, DynamicsModel, DynamicsSettings, MotionValue, Task};
use crate::kinematics::{CharacteristicLength, Jacobian};
use crate::lanes::{InstructionSet, Planar, Real};
use crate::mechanism::{
    AnyLeg, Architecture, Assembly, CrossSection, CrossSections, Design, Geometry, JointKind, JointMasses, JointSizes,
    Leg, LegSettings, Manipulator,
};
use crate::pose::{PoseChecker, ScalarSet, computed};
use crate::spatial::{LEGS, Pose, Rotation};
use crate::stiffness::planar::ActuatorStiffness;
use crate::stiffness::{Material, RailSettings, StiffnessDefinition, StiffnessModel};
use crate::strength::{Loads, StrengthModel};
use crate::workspace::{Grid, GridError, PoseEvaluator, Region, WorkspaceSampling, WorkspaceSpec};

/// All inputs of an evaluation other than the design. The default is the model of the paper, with the choices of this
/// program where the paper leaves something open (docs/model.md, section 11).
#[derive(Debug, Clone, PartialEq)]
pub struct ModelSettings {
    /// Material of every bar.
    pub material: Material,
    /// Cross-sections of the bars.
    pub sections: CrossSections,
    /// Actuator stiffness.
    pub actuators: ActuatorStiffness,
    /// Masses of joints and motors.
    pub joints: JointMasses,
    /// Sizes of joints and motors.
    pub joint_sizes: JointSizes,
    /// Rails of the base; `None` if they are rigid and have no mass, as in the paper.
    pub rails: Option<RailSettings>,
    /// Settings of the legs.
    pub legs: LegSettings,
    /// Sizes of sliders and layers of members.
    pub bodies: BodySettings,
    /// Obstacles, and the room that the members must not leave.
    pub surroundings: Surroundings,
    /// Number of bars of length `r` that count towards the mass of the platform (docs/model.md, section 11).
    pub platform_bars: u32,
    /// Definition of `k_xy`, `k_z`, `k_φz`.
    pub stiffness_definition: StiffnessDefinition,
    /// Characteristic length.
    pub characteristic_length: CharacteristicLength,
    /// Limits of the scalars at each pose.
    pub thresholds: Thresholds,
    /// In-plane force of the study's requirement \[N\], used for displacements; the thresholds already account for it.
    pub in_plane_force: f64,
    /// Loads under which strength, buckling and the forces of joints and drives are computed.
    pub loads: Loads,
    /// Payload, drives, motion and tolerances.
    pub dynamics: DynamicsSettings,
    /// Drives of which a design selects the lightest one that carries the motion; none if there is no catalogue.
    pub drive_catalogue: DriveCatalogue,
    /// Motion that the platform makes again and again, if one is asked for.
    pub task: Option<Task>,
    /// Region, centre, home orientation and rotation range of the workspace.
    pub workspace: WorkspaceSpec,
    /// Objectives of the study.
    pub objectives: Vec<Objective>,
    /// Limits of quantities of a design that no pose violates by itself; those of poses are `thresholds`.
    pub limits: Vec<QuantityLimit>,
    /// Quantities that an evaluation determines besides those that it always does.
    pub quantities: QuantitySet,
    /// Grid on which designs are evaluated during a search.
    pub reference_grid: Grid,
    /// Grid on which reported designs are verified.
    pub fine_grid: Grid,
}

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

impl Default for ModelSettings {
    fn default() -> Self {
        Self {
            material: Material::STEEL,
            sections: CrossSections::default(),
            actuators: ActuatorStiffness {
                prismatic: 1e7,
                revolute: 1e7,
            },
            joints: JointMasses::default(),
            joint_sizes: JointSizes::default(),
            rails: None,
            legs: LegSettings::default(),
            bodies: BodySettings::default(),
            surroundings: Surroundings::default(),
            platform_bars: 3,
            stiffness_definition: StiffnessDefinition::Stiffness,
            characteristic_length: CharacteristicLength::PlatformRadius,
            thresholds: Thresholds::NONE
                .with(PoseScalar::Dexterity, 0.1)
                .with(PoseScalar::StiffnessXy, 1e6)
                .with(PoseScalar::StiffnessZ, 1e5)
                .with(PoseScalar::StiffnessPhiZ, 10.0 / 1f64.to_radians()),
            in_plane_force: 100.0,
            loads: Loads::default(),
            dynamics: DynamicsSettings::default(),
            drive_catalogue: DriveCatalogue::default(),
            task: None,
            workspace: WorkspaceSpec {
                region: Region::Largest,
                rotation_range_deg: 20.0,
                centre: DVec2::ZERO,
                home_phi_deg: None,
            },
            objectives: vec![
                Objective {
                    quantity: Quantity::Mass,
                    goal: Better::Lower,
                },
                Objective {
                    quantity: Quantity::WorkspaceRadius,
                    goal: Better::Higher,
                },
            ],
            limits: Vec::new(),
            quantities: QuantitySet::default(),
            reference_grid: Grid::REFERENCE,
            fine_grid: Grid::FINE,
        }
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

    /// Returns the objective `f1` \[kg\], the mass in motion: `ν·π·(n·r_j²·L_b + 3·r_p²·r)` for solid round bars, where 3 is the
    /// default number of platform bars. Rails with a cross-section add their mass, although they do not move, and joints and motors
    /// that move add theirs.
    pub fn mass(&self, design: &Design) -> f64 {
        self.legs_mass(design) + self.platform_mass(design)
    }

    /// Returns the mass of all legs \[kg\]: their bars, their rails if these have a cross-section, and what moves of their joints and
    /// motors.
    pub fn legs_mass(&self, design: &Design) -> f64 {
        let bars = self.leg_bars_mass(design);
        let legs = (0..LEGS).fold(bars, |sum, leg| sum + self.rail_mass(design, leg));
        legs + LEGS as f64 * self.leg_joints_mass(design.architecture())
    }

    /// Returns the mass of the joints and the motor of a leg that move \[kg\].
    fn leg_joints_mass(&self, architecture: Architecture) -> f64 {
        let parts = self.settings.joints.of_leg(architecture);
        parts.filter(|part| part.moves).fold(0.0, |sum, part| sum + part.mass)
    }

    /// Returns the mass of the bars of all legs \[kg\].
    pub fn leg_bars_mass(&self, design: &Design) -> f64 {
        let section = &self.settings.sections.legs;
        LEGS as f64 * self.bar_mass(section, design.leg_bar_radius(), design.leg_bars_length())
    }

    /// Returns the rails of a design, if its chain has rails and they have a cross-section.
    pub fn rails_of(&self, design: &Design) -> Option<&RailSettings> {
        let has_rails = design.architecture().chain().is_on_rails();
        self.settings.rails.as_ref().filter(|_| has_rails)
    }

    /// Returns the mass of the rail of a leg (0, 1, 2) over the travel of its slider \[kg\]; 0 if the chain has none, or if rails have
    /// no cross-section.
    pub fn rail_mass(&self, design: &Design, leg: usize) -> f64 {
        let Some(rails) = self.rails_of(design) else {
            return 0.0;
        };
        let [lower, upper] = self.settings.legs.geometry.rail_travel(leg, design.base_radius());
        self.bar_mass(&rails.section, rails.radius, upper - lower)
    }

    /// Returns the mass of the platform bars \[kg\].
    pub fn platform_mass(&self, design: &Design) -> f64 {
        let bar = self.bar_mass(
            &self.settings.sections.platform,
            design.platform_bar_radius(),
            design.platform_radius(),
        );
        f64::from(self.settings.platform_bars) * self.settings.legs.geometry.mean_platform_radius() * bar
    }

    /// Returns the mass of one bar \[kg\].
    pub fn bar_mass(&self, section: &CrossSection, radius: f64, length: f64) -> f64 {
        section.mass_per_length(self.settings.material.density, radius) * length
    }

    /// Prepares the design for evaluation at many poses.
    pub(crate) fn checker<L: Leg>(&self, design: &Design) -> PoseChecker<L> {
        self.checker_in(design, &self.stack_of(design))
    }

    /// Prepares the design with its members in a stack.
    pub(super) fn checker_in<L: Leg>(&self, design: &Design, stack: &Stack) -> PoseChecker<L> {
        self.checker_with(design, self.bodies_in(design, stack))
    }

    fn checker_with<L: Leg>(&self, design: &Design, bodies: Bodies) -> PoseChecker<L> {
        let manipulator = Manipulator::new(design, &self.settings.legs);
        let stiffness = self.stiffness(design);
        let thresholds = self.thresholds_of(design);
        PoseChecker {
            manipulator,
            strength: self.strength_if_asked(design, stiffness.as_ref()),
            dynamics: self.dynamics_if_asked(design, stiffness.as_ref()),
            stiffness,
            definition: self.settings.stiffness_definition,
            length: self.length(design, &manipulator),
            bodies,
            base_radius: design.base_radius(),
            longest_lever: design.architecture().longest_lever(design),
            actuator: design.architecture().actuator(),
            assembly: worst_assembly(&manipulator.legs, &self.settings.legs.geometry),
            leaves_out_base: false,
            in_plane_force: self.settings.in_plane_force,
            thresholds,
            asked: ScalarSet::default(),
            computed: computed(&thresholds, ScalarSet::default()),
            examines_all: thresholds.need_all_scalars(),
            instructions: InstructionSet::best(),
        }
    }

    /// Prepares the design for evaluation at many poses, whatever its legs are.
    pub fn pose_evaluator(&self, design: &Design) -> Box<dyn PoseEvaluator> {
        self.pose_evaluator_of(design, ScalarSet::all())
    }

    /// Prepares the design for some scalars besides those that an evaluation computes, which takes less time than for all of them: for
    /// methods that prepare many designs. No other scalar has a meaning.
    pub fn pose_evaluator_of(&self, design: &Design, set: ScalarSet) -> Box<dyn PoseEvaluator> {
        with_leg!(design.architecture(), L => Box::new(self.checker_of::<L>(design, set)))
    }

    /// Prepares the design for all scalars, also for those that an evaluation does not compute.
    pub(super) fn complete_checker<L: Leg>(&self, design: &Design) -> PoseChecker<L> {
        self.checker_of(design, ScalarSet::all())
    }

    /// Prepares the design for some scalars besides those that are limited.
    fn checker_of<L: Leg>(&self, design: &Design, set: ScalarSet) -> PoseChecker<L> {
        let asks = |scalars: &[PoseScalar]| scalars.iter().any(|&scalar| set.contains(scalar));
        let is_limited = self.settings.thresholds.get(PoseScalar::Clearance).is_some();
        let bodies = match asks(&[PoseScalar::Clearance]) || is_limited {
            true => self.bodies_of(design),
            false => Bodies::unpaired(design, &self.stack_of(design), &self.body_basis()),
        };
        let mut checker = self.checker_with(design, bodies);
        let stiffness = checker.stiffness.as_ref();
        if asks(PoseScalar::OF_LOADS) {
            checker.strength = stiffness.map(|stiffness| self.strength(design, stiffness));
        }
        if asks(PoseScalar::OF_MOTION) {
            checker.dynamics = stiffness.map(|stiffness| self.dynamics(design, stiffness));
        }
        checker
    }

    /// Returns `k_xy` at a position in the orientation of `arms`, by the formulas of every scalar but the clearance, on any type of
    /// number: on one that counts operations, they are the operations of a pose.
    #[doc(hidden)]
    pub fn run_formulas<V: Real>(&self, design: &Design, position: Planar<V>, arms: [Planar<V>; LEGS]) -> V {
        with_leg!(design.architecture(), L => {
            let (found, _) = self.checker::<L>(design).core_lanes(position, &arms);
            found.scalars[PoseScalar::StiffnessXy]
        })
    }

    /// Returns the stiffness model of a design; `None` if a bar is infinitely compliant.
    pub fn stiffness(&self, design: &Design) -> Option<StiffnessModel> {
        StiffnessModel::new(
            design,
            &self.settings.legs.geometry,
            &self.settings.material,
            &self.settings.sections,
            &self.settings.actuators,
            self.rails_of(design),
        )
    }

    /// Returns the strength of a design whose stiffness is known, if an evaluation computes anything of it.
    pub(super) fn strength_if_asked(
        &self,
        design: &Design,
        stiffness: Option<&StiffnessModel>,
    ) -> Option<StrengthModel> {
        stiffness
            .filter(|_| self.depends_on_loads())
            .map(|stiffness| self.strength(design, stiffness))
    }

    /// Returns the strength of a design, if an evaluation computes anything of it; `None` also if a bar is infinitely compliant.
    pub(crate) fn strength_of(&self, design: &Design) -> Option<StrengthModel> {
        self.strength_if_asked(design, self.stiffness(design).as_ref())
    }

    /// Returns the motion of a design whose stiffness is known, if an evaluation computes anything of it.
    pub(super) fn dynamics_if_asked(
        &self,
        design: &Design,
        stiffness: Option<&StiffnessModel>,
    ) -> Option<DynamicsModel> {
        stiffness
            .filter(|_| self.computes_any(PoseScalar::OF_MOTION))
            .map(|stiffness| self.dynamics(design, stiffness))
    }

    /// Returns the motion of a design, if the study limits anything of it; `None` also if a bar is infinitely compliant.
    pub(crate) fn dynamics_of(&self, design: &Design) -> Option<DynamicsModel> {
        self.dynamics_if_asked(design, self.stiffness(design).as_ref())
    }

    /// Returns the motion of a design; `None` if a bar is infinitely compliant.
    pub(crate) fn dynamics_in_motion(&self, design: &Design) -> Option<DynamicsModel> {
        let stiffness = self.stiffness(design)?;
        Some(self.dynamics(design, &stiffness))
    }

    fn dynamics(&self, design: &Design, stiffness: &StiffnessModel) -> DynamicsModel {
        self.dynamics_with(design, stiffness, &self.settings.dynamics, self.settings.joints)
    }

    /// Returns the motion of a design whose drives and motors are other ones than the study states.
    pub(super) fn dynamics_with(
        &self,
        design: &Design,
        stiffness: &StiffnessModel,
        settings: &DynamicsSettings,
        joints: JointMasses,
    ) -> DynamicsModel {
        let basis = DynamicsBasis {
            settings,
            legs: &self.settings.legs,
            material: &self.settings.material,
            sections: &self.settings.sections,
            joints,
            platform_bars: self.settings.platform_bars,
        };
        DynamicsModel::new(design, &basis, stiffness)
    }

    fn strength(&self, design: &Design, stiffness: &StiffnessModel) -> StrengthModel {
        let ModelSettings {
            legs,
            material,
            sections,
            loads,
            ..
        } = &self.settings;
        StrengthModel::new(design, legs, material, sections, stiffness, loads)
    }

    /// Returns the members of a design, prepared for clearance computations.
    pub fn bodies_of(&self, design: &Design) -> Bodies {
        self.bodies_in(design, &self.stack_of(design))
    }

    /// Returns the members of a design in a stack.
    pub(super) fn bodies_in(&self, design: &Design, stack: &Stack) -> Bodies {
        Bodies::new(design, stack, &self.body_basis())
    }

    fn body_basis(&self) -> BodyBasis<'_> {
        BodyBasis {
            legs: &self.settings.legs,
            settings: &self.settings.bodies,
            joints: &self.settings.joint_sizes,
            sections: &self.settings.sections,
            barriers: &self.barriers,
        }
    }

    /// Returns what no member may cross.
    pub(crate) fn barriers(&self) -> &[Barrier] {
        &self.barriers
    }

    /// Returns what g1 compares, for the leg that is worst off.
    pub fn assembly(&self, design: &Design) -> Assembly {
        let legs = [0, 1, 2].map(|index| AnyLeg::new(design, &self.settings.legs, index));
        worst_assembly(&legs, &self.settings.legs.geometry)
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
    fn length<L: Leg>(&self, design: &Design, manipulator: &Manipulator<L>) -> f64 {
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
            && (self.settings.loads.are_three_fold() || !self.depends_on_loads())
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

    /// Returns whether an evaluation computes scalars that depend on the loads.
    fn depends_on_loads(&self) -> bool {
        self.computes_any(PoseScalar::OF_LOADS)
    }

    /// Returns whether an evaluation computes any of some scalars.
    fn computes_any(&self, scalars: &[PoseScalar]) -> bool {
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

/// Returns what g1 compares, for the leg that is worst off.
fn worst_assembly<L: Leg>(legs: &[L; LEGS], geometry: &Geometry) -> Assembly {
    let first = legs[0].assembly();
    // A symmetric design has the same values for all legs, which rounding must not tell apart.
    if geometry.is_three_fold() {
        return first;
    }
    let excess = |assembly: &Assembly| assembly.value - assembly.threshold;
    legs[1..].iter().fold(first, |worst, leg| {
        let next = leg.assembly();
        if excess(&next) < excess(&worst) { next } else { worst }
    })
}
