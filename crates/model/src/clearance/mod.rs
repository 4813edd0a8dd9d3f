//! Clearance between members (constraint g7): the smallest distance between members that are not joined to each other
//! (docs/model.md, section 8).
//!
//! A member is modelled as a capsule: its axis with a radius around it. All axes are parallel to the plane of motion.
//! Each kind of member lies in a layer at a height that the study can set, and the distance between two axes combines
//! their distance in the plane with the distance between their layers. The clearance is the distance between the axes
//! minus both radii. Where members overlap it is negative, and its magnitude is the depth of penetration along the
//! shortest line between the axes. A slider is a block with rounded ends; it must not protrude beyond the ends of its
//! rail.
//!
//! The following members are joined, and pairs of them are therefore not checked: the members of one leg, the last
//! member of a leg and the platform bar that it is hinged to, and the platform bars, which form one rigid body.

mod bodies;
mod capsule;
mod distance;
mod layers;
mod places;
mod stack;
mod surroundings;

pub use bodies::Bodies;
pub(crate) use bodies::BodyBasis;
pub use capsule::{Capsule, Clearance, MemberId, Neighbour, UprightBody};
pub use layers::{BodySettings, Layers, Stacking};
pub(crate) use places::{DISTAL, MEMBERS, PLATFORM, PROXIMAL, ROWS, kinds, pairs_not_joined};
pub use stack::{Stack, StackOrder};
pub(crate) use stack::{Upright, pairs_of_joints};
pub(crate) use surroundings::Barrier;
pub use surroundings::{Obstacle, ObstacleShape, Surroundings};
