//! Do bodies collide? The clearance of g7: the least distance between members that are not joined to each other.
//!
//! A member is a capsule: its axis with a radius about it. All axes are parallel to the plane, each kind of member in a
//! layer of its own height if the study says so, so that the distance of two axes is that in the plane and that of their
//! layers, and the clearance is what is left of it without the radii; where members overlap it is negative, the depth of
//! penetration along the shortest line between the axes. A slider is a block with rounded ends; it must not stick out
//! beyond the ends of its rail.
//!
//! Joined, and therefore not counted: the members of one leg, the last member of a leg with its own bar of the platform,
//! and the bars of the platform, which are one body.

mod bodies;
mod capsule;
mod distance;
mod layers;

pub use bodies::Bodies;
pub use capsule::{Capsule, Clearance, Member, Neighbour};
pub use layers::{BodySettings, Layers};

/// Longest distance that is told, and thickest body \[m\].
pub(crate) const FARTHEST: f64 = 1e100;
