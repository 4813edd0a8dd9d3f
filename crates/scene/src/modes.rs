//! Assembly modes of a design: those that belong to the joint values of a pose, and their number over a slice of the joint space.

use kinefront_model::evaluation::{Model, PoseScalar};
use kinefront_model::kinematics::{AssemblyMode, assembly_modes};
use kinefront_model::mechanism::{Architecture, Design, JointKind, WorkingMode};
use kinefront_model::spatial::{LEGS, Pose};

/// The assembly modes at the joint values of a pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// Values of the actuated joints \[m or rad\].
    pub values: [f64; LEGS],
    /// The modes, in the order of their orientations.
    pub modes: Vec<AssemblyMode>,
}

/// Computes the assembly modes at the joint values that a design has at a pose; `None` if it does not reach the pose.
pub fn modes_at(model: &Model, design: &Design, pose: &Pose) -> Option<Modes> {
    let values = model.pose(design, pose).ok()?.actuators;
    Some(Modes {
        values,
        modes: assembly_modes(design, &model.settings().legs, values),
    })
}

/// Number of assembly modes over the values of the first two actuated joints, with the third one kept.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeMap {
    /// Ranges of the first and second joint value \[m or rad\].
    pub ranges: [[f64; 2]; 2],
    /// Number of cells along each range.
    pub cells: usize,
    /// Number of modes in the middle of each cell, row by row; the first joint value varies fastest.
    pub counts: Vec<u8>,
}

impl ModeMap {
    /// Counts the modes about given joint values: over a whole turn of revolute joints, and over `L_b` to either side of prismatic
    /// ones.
    pub fn new(model: &Model, design: &Design, values: [f64; LEGS], cells: usize) -> Self {
        let half = match design.architecture().actuator() {
            JointKind::Revolute => std::f64::consts::PI,
            JointKind::Prismatic => design.link_length(),
        };
        let ranges = [0, 1].map(|joint: usize| [values[joint] - half, values[joint] + half]);
        let at = |joint: usize, cell: usize| {
            let [low, high] = ranges[joint];
            low + (high - low) * (cell as f64 + 0.5) / cells as f64
        };
        let count = |place: usize| {
            let values = [at(0, place % cells), at(1, place / cells), values[2]];
            assembly_modes(design, &model.settings().legs, values).len() as u8
        };
        Self {
            ranges,
            cells,
            counts: (0..cells * cells).map(count).collect(),
        }
    }
}

/// A design of each architecture at a pose, with which the architectures are shown: lengths that let all legs be seen, at the
/// orientation of the best dexterity.
pub fn example(model: &Model, architecture: Architecture) -> Option<(Design, Pose)> {
    const LENGTHS: [f64; 3] = [0.62, 0.9, 1.2];
    const TURNS: u32 = 72;
    let designs = LENGTHS.into_iter().flat_map(|length| {
        [[true; LEGS], [false; LEGS]].into_iter().filter_map(move |plus| {
            Design::new(architecture, WorkingMode::new(plus), [1.0, 0.36, length, 0.03, 0.03]).ok()
        })
    });
    let pose = |k: u32| Pose::new(0.0, 0.0, f64::from(k) * std::f64::consts::TAU / f64::from(TURNS));
    let poses = |design: Design| (0..TURNS).map(move |k| (design, pose(k)));
    let rated = designs.flat_map(poses).filter_map(|(design, pose)| {
        let values = model.pose(&design, &pose).ok()?.values;
        let rate = values[PoseScalar::Dexterity].min(2.0 * values[PoseScalar::Reach]);
        Some((rate, design, pose))
    });
    let best = rated.reduce(|best, next| if next.0 > best.0 { next } else { best })?;
    Some((best.1, best.2))
}
