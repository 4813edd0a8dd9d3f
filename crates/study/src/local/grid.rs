//! Optima for the fine grid, on which reported designs are verified.

use kinefront_model::evaluation::Evaluation;
use kinefront_model::mechanism::Design;
use kinefront_model::workspace::Region;
use kinefront_optimum::{LocalProblem, Polished};

use crate::DesignProblem;

/// Slack that a design for the fine grid keeps, so that rounding misses no requirement.
const ROOM: f64 = 2e-7;

impl DesignProblem {
    /// Returns an optimum again with a home orientation of the fine grid, and with a little room for rounding. The radius of a disc is
    /// increased by a share of itself, and by the resolution of the grid.
    pub(super) fn for_fine_grid(&self, problem: &LocalProblem, polished: &Polished, increase: f64) -> Option<Design> {
        let grid = &self.model().settings().fine_grid;
        let step = grid.phi_step_deg();
        let home = polished.home.to_degrees() / step;
        // The nearest orientation of the grid: the other neighbour is lighter by a millionth at most.
        let home = problem.question().workspace.home_phi_deg.unwrap_or(home.round() * step);
        let resolution = 1.0 / (grid.ray_steps() as f64 * f64::from(1u32 << grid.halvings().min(30)));
        let mut question = problem.question().clone();
        question.workspace.home_phi_deg = Some(home);
        question.slack = ROOM;
        if let Region::Disc(radius) = &mut question.workspace.region {
            *radius = *radius * (1.0 + increase) + resolution * polished.design.base_radius();
        }
        let fixed = LocalProblem::new(question, &polished.design).ok()?;
        let found = fixed.polish(&polished.design, home.to_radians())?;
        Some(found.design).filter(|_| found.is_feasible())
    }

    /// Returns the best design near one that was evaluated on a grid, for the fine grid; `None` if its question has no local problem, or
    /// if no design near it holds.
    pub(crate) fn improved(&self, evaluation: &Evaluation) -> Option<Design> {
        let local = self.local_of(evaluation, None).ok()?;
        // An objective that the local problem does not know would be given up.
        let left_out = local.problem.left_out();
        let objectives = &self.model().settings().objectives;
        if objectives
            .iter()
            .any(|objective| left_out.contains(&objective.quantity))
        {
            return None;
        }
        let mut question = local.problem.question().clone();
        question.slack = ROOM;
        let problem = LocalProblem::new(question, &evaluation.design).ok()?;
        let polished = problem.polish(&evaluation.design, local.home?)?;
        self.for_fine_grid(&local.problem, &polished, 0.0)
    }
}
