//! First-order kinematics: Jacobians, dexterity and singularities.

mod forward;
mod jacobian;

pub use forward::{ForwardError, forward};
pub use jacobian::{CharacteristicLength, Jacobian};
