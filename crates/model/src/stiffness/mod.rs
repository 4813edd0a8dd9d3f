//! Virtual-joint stiffness of the manipulator at `P` (SPEC section 3).
//!
//! Two forms of one model: [`planar`] is the closed form that everything uses, [`joint_model`] the general 6×6 form
//! of Pashkevich et al. that serves as its oracle. The closed form is written twice: as it reads, with all of `K`, and
//! reduced to the numbers that the constraints ask for, at several poses at once (`lanes`).

mod bar;
pub mod joint_model;
mod lanes;
pub mod planar;
mod shares;

pub use bar::{BarCompliance, Material};
pub use planar::{ActuatorStiffness, PlanarStiffness, StiffnessModel};
pub use shares::{LegShares, Share};

/// Which numbers stand for "the stiffness" along and about an axis (SPEC section 8, no. 5).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StiffnessDefinition {
    /// Entries of `K`: force per displacement with every other displacement held at 0.
    Stiffness,
    /// Inverse entries of `K⁻¹`: force per displacement under that force alone.
    Compliance,
}

/// The three stiffness values that the accuracy requirements bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rigidity {
    /// `k_xy`: least translational stiffness in the plane \[N/m\].
    pub k_xy: f64,
    /// `k_z`: translational stiffness out of the plane \[N/m\].
    pub k_z: f64,
    /// `k_φz`: rotational stiffness about z \[N·m/rad\].
    pub k_phi_z: f64,
}
