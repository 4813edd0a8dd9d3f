//! # Kinefront: the model
//!
//! What a planar parallel manipulator with three legs is worth: inverse kinematics, Jacobian, stiffness, clearance and regular
//! workspace of the 3-PRR, 3-RPR and 3-RRR. `docs/model.md` in the repository derives every formula.
#![doc = ""]

#[macro_use]
pub mod mechanism;

pub mod clearance;
pub mod evaluation;
pub mod kinematics;
pub mod lanes;
pub mod spatial;
pub mod stiffness;
pub mod workspace;
