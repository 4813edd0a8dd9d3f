//! The model against identities and independent values: joints, Jacobians, stiffness, clearance, workspace, sizing.

mod certify;
mod clearance;
mod enclosure;
mod forms;
mod joints;
mod lanes;
mod oracle;
mod reference;
mod search;
mod sizing;
mod strategies;
