//! Stiffness of the manipulator at `P` according to the virtual-joint model (docs/model.md, section 4).
//!
//! The model has two forms: [`planar`] is the closed form, which the rest of the program uses; [`joint_model`] is the
//! general 6×6 form of Pashkevich et al., which serves as the reference in the tests of the closed form. The closed
//! form is implemented twice: in `planar` for one pose and with all entries of `K`, and in `lanes` for several poses at
//! once, reduced to the three values that the constraints need.

mod bar;
mod blocks;
mod contributions;
pub mod joint_model;
mod lanes;
pub mod planar;
mod rail;
mod reduced;

pub use bar::{BarCompliance, Material};
pub(crate) use blocks::{add_bar, in_plane_block};
pub use contributions::{Contribution, LegContributions};
pub(crate) use lanes::NoSliders;
pub use planar::{ActuatorStiffness, PlanarStiffness, StiffnessModel};
pub use rail::{RailSettings, RailSupports};

/// Definition of the stiffness along and about an axis (docs/model.md, section 4.5).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StiffnessDefinition {
    /// Entries of `K` (for `k_xy`, the smaller eigenvalue of the xy block): force per displacement with all other
    /// displacements held at 0.
    Stiffness,
    /// Reciprocals of entries of `K⁻¹` (for `k_xy`, of the larger eigenvalue of the xy block): force per displacement
    /// under that force alone.
    Compliance,
}

/// The three stiffness values that the accuracy requirements bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StiffnessValues {
    /// `k_xy`: smallest translational stiffness in the plane \[N/m\].
    pub k_xy: f64,
    /// `k_z`: translational stiffness out of the plane \[N/m\].
    pub k_z: f64,
    /// `k_φz`: rotational stiffness about z \[N·m/rad\].
    pub k_phi_z: f64,
}
