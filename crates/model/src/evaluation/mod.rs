//! Evaluation of a design: computes its objectives, constraints and margins in the one call that all other code uses.
//!
//! ```
//! use kinefront_model::evaluation::{GridChoice, Model};
//!
//! let design = "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056".parse()?;
//! let evaluation = Model::default().evaluate(&design, GridChoice::Reference);
//! assert!((evaluation.mass() - 479.47).abs() < 0.01);
//! assert!((evaluation.workspace_radius() - 1.2201).abs() < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cycle;
mod drives;
mod evaluate;
mod goals;
mod mass;
mod members;
mod model;
mod over_workspace;
mod parts;
mod pose;
mod prepare;
mod quantities;
mod quantity;
mod settings;
mod sizing;
mod stacking;
mod task;
mod worst;

pub use crate::pose::{
    Better, Constraint, ConstraintSet, MarginUnit, PoseScalar, PoseScalarEntry, PoseScalars, PoseValues, QuantityEntry,
    Reference, ScalarSet, Scale, Scope, Thresholds,
};
pub use crate::stiffness::Contribution;
pub use cycle::ShortestCycle;
pub use goals::{Bound, LimitResult, Objective, QuantityLimit};
pub use members::MemberReport;
pub use model::{GridChoice, Model};
pub use over_workspace::{At, OverWorkspace};
pub use parts::{CutBar, Part};
pub use pose::{PoseEvaluation, PosedDesign, PosedDynamics, Unreachable};
pub use quantity::{Quantity, QuantitySet, QuantityValues};
pub use settings::ModelSettings;
pub use sizing::{SizingRanges, WorkspaceTarget};
pub use task::{SelectedDrive, TaskFailure, TaskFault, TaskFigures, TaskOutcome, TaskSample, largest_of_legs};

use crate::clearance::Clearance;
use crate::mechanism::Design;
use crate::spatial::Pose;

/// Result of one evaluation of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// The evaluated design.
    pub design: Design,
    /// Centre and home orientation of the workspace; `None` for a design without one.
    pub home: Option<Pose>,
    /// Home orientation `φ_c` exactly as on the grid \[deg\], in \[0, 360); `None` for a design without a workspace.
    pub home_phi_deg: Option<f64>,
    /// The nearest pair of members that are not joined, at the pose of the smallest clearance; `None` if no pose has one.
    pub nearest: Option<Clearance>,
    /// Place of the drive that the design selects from the catalogue of the study; `None` without a catalogue, and if no drive carries the
    /// motion.
    pub drive: Option<usize>,
    /// Home pose in which the constraints of an infeasible design are reported over a prescribed region; `None` otherwise.
    pub reported_home: Option<Pose>,
    /// Reports of the constraints, in the order of [`Constraint::ALL`].
    pub constraints: [ConstraintResult; Constraint::COUNT],
    /// Quantities: those that an evaluation always determines, and those that the study asks for.
    pub quantities: QuantityValues,
    /// The objectives of the study, as they are minimised.
    pub objectives: Vec<f64>,
    /// The limits of quantities that the study states.
    pub limits: Vec<LimitResult>,
    /// Dimensionless measure, for optimizers, of how far the design is from having a workspace: 0 for a feasible
    /// design, otherwise the smallest mean over a window of the summed relative shortfalls at the centre. A window with
    /// both signs of `det A` counts 1 more, and the relative shortfall of g1 is added. For a prescribed region, the shortfall of
    /// the worst margin takes the place of the mean. The relative shortfalls of the limits are added.
    pub violation: f64,
}

impl Evaluation {
    /// Returns whether the design has a workspace and keeps all limits.
    pub fn is_feasible(&self) -> bool {
        self.violation <= 0.0
    }

    /// Returns `f1`: mass in motion \[kg\].
    pub fn mass(&self) -> f64 {
        self.quantities.get(Quantity::Mass).unwrap_or(0.0)
    }

    /// Returns `f2`: regular workspace radius `R_w` \[m\]; 0 for a design without a workspace. For a prescribed region, the radius of
    /// the largest disc about the centre within it.
    pub fn workspace_radius(&self) -> f64 {
        self.quantities.get(Quantity::WorkspaceRadius).unwrap_or(0.0)
    }

    /// Replaces the workspace radius by another one, for example one that is proved, in every value that depends on it alone.
    pub fn set_workspace_radius(&mut self, radius: f64, objectives: &[Objective]) {
        self.quantities.set(Quantity::WorkspaceRadius, Some(radius));
        for (value, objective) in self.objectives.iter_mut().zip(objectives) {
            if objective.quantity == Quantity::WorkspaceRadius {
                *value = objective.minimised(Some(radius));
            }
        }
    }

    /// Returns the report of one constraint.
    pub fn constraint(&self, constraint: Constraint) -> &ConstraintResult {
        &self.constraints[constraint as usize]
    }

    /// Returns the smallest clearance over the regular workspace between members that are not joined \[m\], whether it
    /// is required or not; `None` if no pose has one.
    pub fn clearance(&self) -> Option<f64> {
        self.constraint(Constraint::Clearance).value
    }

    /// Returns the active constraints, in the order of [`Constraint::ALL`].
    pub fn active(&self) -> impl Iterator<Item = Constraint> + '_ {
        self.constraints
            .iter()
            .filter(|report| report.active)
            .map(|report| report.constraint)
    }
}

/// One constraint of one design: its smallest value over the regular workspace, and the pose at which it occurs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstraintResult {
    /// The constraint.
    pub constraint: Constraint,
    /// Smallest value; `None` if no reachable pose has one.
    pub value: Option<f64>,
    /// Smallest value allowed.
    pub threshold: f64,
    /// Whether the study requires the constraint. A constraint that is not required is never violated and never active.
    pub required: bool,
    /// Relative margin ([`Constraint::margin`]); −1 if there is no value.
    pub margin: f64,
    /// Whether the constraint is among those that fail first just beyond `R_w` in the home window; for an infeasible
    /// design, among those that prevent the best window from having a workspace.
    pub active: bool,
    /// Pose at which the value occurs; `None` for g1, which applies to the design as a whole.
    pub pose: Option<Pose>,
}

impl ConstraintResult {
    /// Returns the margin, if the study requires the constraint.
    pub fn required_margin(&self) -> Option<f64> {
        self.required.then_some(self.margin)
    }
}
