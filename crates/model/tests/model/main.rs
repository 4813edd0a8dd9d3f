//! The model against identities and independent values: joints, Jacobians, stiffness, cross-sections, clearance, workspace, sizing.

mod assembly;
mod beyond;
mod certify;
mod clearance;
mod drives;
mod dynamics;
mod enclosure;
mod forms;
mod joints;
mod lanes;
mod legs;
mod motion;
mod motion_proofs;
mod quantities;
mod reference;
mod region_proofs;
mod regions;
mod search;
mod sections;
mod sizing;
mod stacks;
mod strategies;
mod strength;
