//! A design to its objectives, constraints and margins: the one call that everything else makes.
//!
//! ```
//! use kinefront_model::evaluation::{GridChoice, Model};
//!
//! let design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
//! let evaluation = Model::default().evaluate(&design, GridChoice::Reference);
//! assert!((evaluation.mass - 479.47).abs() < 0.01);
//! assert!((evaluation.workspace_radius - 1.2201).abs() < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod constraint;
mod layout;
mod lightest;
mod members;
mod model;
mod pose;
mod sizing;
mod worst;

pub use crate::stiffness::Share;
pub use constraint::{Constraint, ConstraintReport};
pub use members::MemberReport;
pub use model::{GridChoice, Model, ModelSettings};
pub use pose::{PoseReport, Unreachable};
pub use sizing::{BarRanges, Demand};

use crate::mechanism::Design;
use crate::spatial::Pose;

/// What is known of a design after one evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// The design.
    pub design: Design,
    /// `f1`: mass in motion \[kg\].
    pub mass: f64,
    /// `f2`: regular workspace radius `R_w` \[m\]; 0 for an infeasible design.
    pub workspace_radius: f64,
    /// Centre and home orientation of the regular workspace; `None` for an infeasible design.
    pub home: Option<Pose>,
    /// `φ_c` in degrees exactly as it stands on the grid, in \[0, 360).
    pub home_phi_deg: Option<f64>,
    /// The constraints, in the order of [`Constraint::ALL`].
    pub constraints: [ConstraintReport; Constraint::ALL.len()],
    /// How far the design is from having a workspace: 0 for a feasible one, else the least mean over a window of the
    /// summed relative shortfalls at the centre. For optimizers; without unit.
    pub violation: f64,
}

impl Evaluation {
    /// Whether the design has a regular workspace.
    pub fn is_feasible(&self) -> bool {
        self.workspace_radius > 0.0
    }

    /// The report of one constraint.
    pub fn constraint(&self, constraint: Constraint) -> &ConstraintReport {
        &self.constraints[constraint as usize]
    }

    /// Least clearance of bodies that are not joined over the regular workspace, asked for or not \[m\]; `None` where no pose
    /// has one.
    pub fn clearance(&self) -> Option<f64> {
        self.constraint(Constraint::Clearance).value
    }

    /// Ids of the active constraints, in order.
    pub fn active(&self) -> impl Iterator<Item = Constraint> + '_ {
        self.constraints
            .iter()
            .filter(|report| report.active)
            .map(|report| report.constraint)
    }
}
