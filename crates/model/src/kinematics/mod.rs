//! Jacobians, dexterity, singularities and forward kinematics.

mod forward;
mod jacobian;

pub use forward::{ForwardError, forward};
pub use jacobian::{CharacteristicLength, Jacobian};
