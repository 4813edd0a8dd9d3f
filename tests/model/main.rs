//! The model: joints, Jacobians, stiffness, workspace and optimizers against identities and independent values.

mod clearance;
mod forms;
mod invariants;
mod joints;
mod lanes;
mod optimizers;
mod reference;
mod reports;
mod scenes;
mod search;
mod sizing;
mod strategies;
mod studies;
mod test_problems;
