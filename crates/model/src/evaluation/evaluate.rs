//! The one call by which all other code evaluates a design.

use super::worst::ConstraintSearch;
use super::{
    Constraint, Evaluation, GridChoice, LimitResult, Model, Quantity, QuantityLimit, QuantityValues, SelectedDrive,
    quantities,
};
use crate::lanes::InstructionSet;
use crate::mechanism::{Design, Leg};
use crate::pose::{EXAMINED_ALWAYS, PoseChecker, PoseScalar, Thresholds};
use crate::spatial::Pose;
use crate::workers::{OneWorker, Workers};
use crate::workspace::{Region, RegularWorkspace, WorkspaceSampling, search, search_prescribed};

impl Model {
    /// Evaluates a design on one of the grids.
    pub fn evaluate(&self, design: &Design, grid: GridChoice) -> Evaluation {
        self.evaluate_with(design, grid, InstructionSet::best())
    }

    /// Evaluates a design like [`Model::evaluate`], with a given instruction set, which changes no bit of the result.
    pub fn evaluate_with(&self, design: &Design, grid: GridChoice, instructions: InstructionSet) -> Evaluation {
        with_leg!(design.architecture(), L => {
            let mut checker = self.checker::<L>(design);
            checker.instructions = instructions;
            evaluate(self, &checker, design, self.sampling(grid), &OneWorker).0
        })
    }

    /// Evaluates a design like [`Model::evaluate`], on several threads where its region has many poses, which changes no bit of the result.
    pub fn evaluate_by(&self, workers: &dyn Workers, design: &Design, grid: GridChoice) -> Evaluation {
        with_leg!(design.architecture(), L => {
            evaluate(self, &self.checker::<L>(design), design, self.sampling(grid), workers).0
        })
    }

    /// Evaluates a design like [`Model::evaluate`], and determines the values of an infeasible design that are limited, which tell a person
    /// what is wrong: over a prescribed region in the best home orientation, otherwise at the pose at which the constraints are reported. The
    /// violation and the quantities are those of [`Model::evaluate`].
    pub fn evaluate_in_full(&self, design: &Design, grid: GridChoice) -> Evaluation {
        with_leg!(design.architecture(), L => {
            let checker = self.checker::<L>(design);
            let (mut evaluation, found) = evaluate(self, &checker, design, self.sampling(grid), &OneWorker);
            if !evaluation.is_feasible() {
                quantities::add_to_limits(&mut evaluation, self, &checker, &found);
            }
            evaluation
        })
    }
}

/// Evaluates the design that is prepared in `checker`, and returns the workspace that was searched, too.
fn evaluate<L: Leg>(
    model: &Model,
    checker: &PoseChecker<L>,
    design: &Design,
    sampling: &WorkspaceSampling,
    workers: &dyn Workers,
) -> (Evaluation, RegularWorkspace) {
    let (found, worst) = searched(model, checker, design, sampling, workers);
    let reporter = ConstraintSearch {
        model,
        checker,
        design,
        found: &found,
        workers,
    };
    let grid = sampling.grid();
    let (constraints, violation, home) = reporter.report(worst, grid);
    let workspace_radius = if home.is_some() { found.radius } else { 0.0 };
    let height = checker.bodies.height();
    let mut quantities = quantities::known(model, height, design, workspace_radius, &constraints);
    let phi_deg = |home: usize| found.orientations[home].phi_deg;
    let mut drive = None;
    if let Some(home) = home {
        quantities::add_of_region(&mut quantities, &reporter, home, grid);
        let frame = model.task_frame(design, workspace_radius, phi_deg(home));
        drive = quantities::add_of_task(&mut quantities, model, design, &frame);
    }
    let (limits, violation_of_limits) = results_of_limits(model, design, &quantities);
    let home_phi_deg = home.map(phi_deg);
    let centre = model.settings().workspace.centre;
    let pose_at = |phi_deg: f64| Pose::new(centre.x, centre.y, phi_deg.to_radians());
    let reported = found.home.filter(|_| home.is_none() && worst.is_some());
    let nearest = constraints[Constraint::Clearance as usize].pose;
    let objectives = model.settings().objectives.iter();
    let evaluation = Evaluation {
        design: *design,
        home: home_phi_deg.map(pose_at),
        home_phi_deg,
        reported_home: reported.map(|home| pose_at(phi_deg(home))),
        nearest: nearest.and_then(|pose| reporter.nearest(pose)),
        drive: drive.filter(SelectedDrive::carries).map(|drive| drive.place),
        constraints,
        objectives: objectives
            .map(|objective| objective.minimised(quantities.get(objective.quantity)))
            .collect(),
        quantities,
        limits,
        violation: violation + violation_of_limits,
    };
    (evaluation, found)
}

/// Searches the workspace of a design, and returns the worst margin, too, for a prescribed region.
fn searched<L: Leg>(
    model: &Model,
    checker: &PoseChecker<L>,
    design: &Design,
    sampling: &WorkspaceSampling,
    workers: &dyn Workers,
) -> (RegularWorkspace, Option<f64>) {
    let symmetric = model.is_symmetric_in(design, checker.bodies.stack().order);
    if sampling.spec().region == Region::Largest {
        return (search(checker, sampling, design.base_radius(), symmetric), None);
    }
    let objective = examined_objective(model, &checker.thresholds);
    let (found, worst) = search_prescribed(checker, sampling, design.base_radius(), symmetric, objective, workers);
    (found, Some(worst))
}

/// Returns the results of the limits that the study states, and by how much those of the design as a whole are violated. The search of
/// the region has counted what the others are violated by.
fn results_of_limits(model: &Model, design: &Design, quantities: &QuantityValues) -> (Vec<LimitResult>, f64) {
    let result = |limit: QuantityLimit| limit.result(quantities.get(limit.quantity));
    let stated = model.settings().limits.iter().copied();
    let of_designs = stated.filter(|limit| limit.quantity.is_of(design));
    let mut limits: Vec<LimitResult> = of_designs.map(result).collect();
    let violation = limits.iter().map(|limit| (-limit.margin).max(0.0)).sum();
    limits.extend(model.limits_of_poses(design).map(result));
    (limits, violation)
}

/// Returns the scalar of the first objective whose value the search of a prescribed region knows at every pose that it examines.
fn examined_objective(model: &Model, thresholds: &Thresholds) -> Option<PoseScalar> {
    let objectives = &model.settings().objectives;
    objectives.iter().find_map(|objective| {
        let Quantity::Worst(scalar) = objective.quantity else {
            return None;
        };
        let is_examined = EXAMINED_ALWAYS.contains(&scalar) || thresholds.get(scalar).is_some();
        // The distance between members is examined no further than to its limit.
        let is_known = is_examined && scalar != PoseScalar::Clearance;
        (is_known && objective.goal == scalar.entry().quantity.better).then_some(scalar)
    })
}
