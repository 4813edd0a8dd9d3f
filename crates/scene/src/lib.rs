//! A design at a pose as named shapes and fields, independent of any renderer.
//!
//! | item | contents |
//! |---|---|
//! | [`manipulator`] | base, rails, legs, platform, joints, frames and labels, to scale |
//! | [`regular_workspace`] | the cylinder, on the manipulator and in the configuration space |
//! | [`WorkspaceProof`] | the boxes of the proof of a workspace |
//! | [`FieldLegend`] | the colours of a field and its threshold |
//! | [`Heatmap`] | a field over the reachable workspace at one φ: triangles, contours, edges of reach, singularities |
//! | [`ellipsoids`] | stiffness or displacement ellipsoids at points of the regular workspace |
//! | [`dimension_lines`] | where the lengths of a design are |
//! | [`linkage`] | the manipulator as rigid bodies with joints and masses |
//! | [`Mesh`] | a solid as triangles |
//! | [`MotionPath`], [`MotionCurve`] | the path of a motion with colours, and what the actuators do during it |
//! | [`Vibrations`] | natural frequencies, and the bars as they bend |
//! | [`BarStresses`] | the stresses of the bars at a pose |
//! | [`tour`] | poses along the regular workspace, checked by forward kinematics |
//!
//! Lengths are in metres in the base frame; z points out of the plane. A shape states which part of the manipulator it
//! is ([`Part`]), not how it looks.

mod color_map;
mod dimensions;
mod ellipsoid;
mod field;
mod heatmap;
mod linkage;
mod manipulator;
mod mesh;
mod modes;
mod motion;
pub mod palette;
mod proof;
mod shape;
mod stress;
mod surroundings;
pub mod text;
mod tour;
mod vibration;
mod workspace;

pub use color_map::{ColorMap, FieldLegend};
pub use dimensions::dimension_lines;
pub use ellipsoid::{Ellipsoid, EllipsoidKind, EllipsoidSet, ellipsoids};
pub use field::Field;
pub use heatmap::{Edge, Heatmap, HeatmapSettings};
pub use kinefront_model::kinematics::AssemblyMode;
pub use linkage::{Body, Closure, Frame, Joint, Linkage, MassBar, linkage};
pub use manipulator::manipulator;
pub use mesh::Mesh;
pub use modes::{ModeMap, Modes, example, modes_at};
pub use motion::{MotionCurve, MotionPath, PathColor, drawn_samples, pose_at};
pub use proof::{ProofCell, WorkspaceProof, workspace_proof};
pub use shape::{Label, Line, Nearest, Part, Scene, Solid, SolidShape};
pub use stress::{BarStresses, StressLegend};
pub use tour::{Tour, tour};
pub use vibration::{BentBar, VibrationMode, Vibrations};
pub use workspace::{ConfigurationSpace, RegularCylinder, region_corners, regular_workspace};
