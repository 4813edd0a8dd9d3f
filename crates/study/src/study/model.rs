//! The model by which the designs of a study are evaluated.

use glam::DVec2;

use super::{Catalogues, Study};
use crate::settings::{LengthChoice, StiffnessChoice, TelescopicBar};
use kinefront_model::dynamics::{Anywhere, DriveInertia, DynamicsSettings, Payload, Tolerances};
use kinefront_model::evaluation::{Model, ModelSettings, PoseScalar, Thresholds};
use kinefront_model::kinematics::CharacteristicLength;
use kinefront_model::mechanism::{Arrangement, BarLength, JointMasses, JointSizes, LegSettings};
use kinefront_model::stiffness::{ActuatorStiffness, Material, StiffnessDefinition};
use kinefront_model::workspace::{GridError, WorkspaceSpec};

impl Study {
    /// Builds the model that evaluates the designs of this study, in SI units.
    ///
    /// # Errors
    /// [`GridError`] when a grid does not divide the full turn or the rotation range into whole steps; a study that was
    /// read without faults has none.
    pub fn model(&self) -> Result<Model, GridError> {
        let model = &self.model;
        let Catalogues { sections, drives } = self.catalogues();
        Model::new(ModelSettings {
            material: Material::from(&self.material),
            sections,
            rails: self
                .rails
                .rails(self.sections.rails.cross_section().unwrap_or_default()),
            actuators: ActuatorStiffness {
                prismatic: self.actuators.prismatic_stiffness_n_per_m,
                revolute: self.actuators.revolute_stiffness_nm_per_rad,
            },
            joints: JointMasses::from(&self.joints),
            joint_sizes: JointSizes::from(&self.joints),
            legs: LegSettings {
                telescopic_bar: match model.telescopic_bar {
                    TelescopicBar::Current => BarLength::Current,
                    TelescopicBar::Longest => BarLength::Longest,
                },
                telescopic_shortest: model.telescopic_shortest,
                geometry: Arrangement::from(&self.geometry).into(),
            },
            bodies: self.bodies,
            surroundings: self.surroundings(),
            platform_bars: model.platform_bars,
            stiffness_definition: match model.stiffness_definition {
                StiffnessChoice::Stiffness => StiffnessDefinition::Stiffness,
                StiffnessChoice::Compliance => StiffnessDefinition::Compliance,
            },
            characteristic_length: match model.characteristic_length {
                LengthChoice::PlatformRadius => CharacteristicLength::PlatformRadius,
                LengthChoice::Isotropic => CharacteristicLength::Isotropic,
                // A study that was read without faults has this length.
                LengthChoice::Fixed => CharacteristicLength::Fixed(model.characteristic_length_m.unwrap_or(1.0)),
            },
            thresholds: self.thresholds(),
            in_plane_force: self.requirements.in_plane_force_n,
            loads: self.strength.loads(&self.requirements),
            dynamics: self.dynamics(),
            drive_catalogue: drives,
            task: self.task.task(),
            objectives: self.objectives(),
            limits: self.limits_of_designs(),
            quantities: self.asked_quantities(),
            workspace: WorkspaceSpec {
                region: self.region(),
                rotation_range_deg: self.workspace.rotation_range_deg,
                centre: DVec2::from_array(self.workspace.centre_m),
                home_phi_deg: self.workspace.home_phi_deg,
            },
            reference_grid: (&self.grid.reference).try_into()?,
            fine_grid: (&self.grid.fine).try_into()?,
        })
    }

    /// Returns the payload, what moves besides the members, the loads and motions, and the tolerances, in SI units.
    fn dynamics(&self) -> DynamicsSettings {
        let [fx, fy] = self.loads.tool_force_n;
        DynamicsSettings {
            payload: Payload {
                mass: self.payload.mass_kg,
                inertia: self.payload.inertia_kg_m2,
                centre: self.payload.centre_m,
            },
            drives: DriveInertia {
                slider_mass: self.drives.slider_mass_kg,
                prismatic: self.drives.prismatic_inertia_kg,
                revolute: self.drives.revolute_inertia_kg_m2,
            },
            gravity: self.loads.gravity_m_per_s2,
            tool: [fx, fy, self.loads.tool_moment_nm],
            anywhere: Anywhere {
                velocity: self.anywhere.v_m_per_s,
                omega: self.anywhere.omega_rad_per_s,
                acceleration: self.anywhere.a_m_per_s2,
                alpha: self.anywhere.alpha_rad_per_s2,
                force: self.anywhere.force_n,
                moment: self.anywhere.moment_nm,
            },
            tolerances: Tolerances {
                encoder_prismatic: self.tolerances.encoder_m,
                encoder_revolute: self.tolerances.encoder_rad,
                link: self.tolerances.link_m,
                base: self.tolerances.base_m,
                platform: self.tolerances.platform_m,
                play: self.tolerances.play_m,
            },
        }
    }

    /// Derives the thresholds of the constraints from the requirements.
    pub fn thresholds(&self) -> Thresholds {
        let requirements = &self.requirements;
        let quotient = |stated: Option<f64>, load: f64, displacement: f64| stated.unwrap_or(load / displacement);
        let mut thresholds = Thresholds::NONE
            .with(PoseScalar::Dexterity, requirements.inverse_condition_min)
            .with(
                PoseScalar::StiffnessXy,
                quotient(
                    requirements.k_xy_min_n_per_m,
                    requirements.in_plane_force_n,
                    requirements.in_plane_displacement_m,
                ),
            )
            .with(
                PoseScalar::StiffnessZ,
                quotient(
                    requirements.k_z_min_n_per_m,
                    requirements.vertical_force_n,
                    requirements.vertical_displacement_m,
                ),
            )
            .with(
                PoseScalar::StiffnessPhiZ,
                quotient(
                    requirements.k_phi_z_min_nm_per_rad,
                    requirements.torque_z_nm,
                    requirements.rotation_z_deg.to_radians(),
                ),
            );
        thresholds.set(PoseScalar::Clearance, requirements.clearance_min_m);
        self.bound_poses(&mut thresholds);
        thresholds
    }
}
