//! The inputs of an evaluation: material, actuators, limits, definitions, workspace and grids.

use glam::DVec2;

use super::{Better, Objective, PoseScalar, Quantity, QuantityLimit, QuantitySet, Thresholds};
use crate::clearance::{BodySettings, Surroundings};
use crate::dynamics::{DriveCatalogue, DynamicsSettings, Task};
use crate::kinematics::CharacteristicLength;
use crate::mechanism::{CrossSections, JointMasses, JointSizes, LegSettings};
use crate::stiffness::planar::ActuatorStiffness;
use crate::stiffness::{Material, RailSettings, StiffnessDefinition};
use crate::strength::Loads;
use crate::workspace::{Grid, Region, WorkspaceSpec};

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
