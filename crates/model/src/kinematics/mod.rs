//! Jacobians, dexterity, singularities and forward kinematics.

mod assembly_modes;
mod forward;
mod jacobian;
mod polynomial;

pub use assembly_modes::{AssemblyMode, assembly_modes, poses_of};
pub use forward::{ForwardError, forward};
pub use jacobian::{CharacteristicLength, Jacobian};
