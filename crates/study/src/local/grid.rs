//! Optima for the fine grid, on which reported designs are verified.

use kinefront_model::evaluation::{Evaluation, GridChoice};
use kinefront_model::mechanism::Design;
use kinefront_model::workspace::Region;
use kinefront_optimum::{LocalProblem, Polished};

use crate::DesignProblem;

/// Slack that a design for the fine grid keeps, so that rounding misses no requirement.
const ROOM: f64 = 2e-7;

/// Relative amount by which the other objectives of an improved design may be worse.
const KEPT: f64 = 1e-3;

impl DesignProblem {
    /// Verifies the best design near one that a search found, or that design itself if no better one holds on the fine grid.
    pub fn verify_improved(&self, design: &Design) -> Evaluation {
        let found = self.evaluate_design(design);
        let better = self
            .improved(&found)
            .map(|improved| self.model().evaluate(&improved, GridChoice::Fine));
        // The evaluation selects the home orientation by the requirements alone, so that an objective over poses may become worse.
        let keeps_others = |better: &Evaluation| {
            let mut others = better.objectives.iter().zip(&found.objectives).skip(1);
            others.all(|(better, had)| *better <= had + KEPT * had.abs())
        };
        match better.filter(|better| better.is_feasible() && keeps_others(better)) {
            // It may be worse in the first objective, because it holds the others between the poses of the grid, too.
            Some(better) if better.objectives.len() > 1 => better,
            Some(better) => {
                let verified = self.verify(design);
                let is_lighter = verified.is_feasible() && verified.objectives[0] < better.objectives[0];
                if is_lighter { verified } else { better }
            }
            None => self.verify(design),
        }
    }

    /// Returns an optimum again with a home orientation of the fine grid, and with a little room for rounding. The radius of a disc is
    /// increased by a share of itself, and by the resolution of the grid.
    pub(super) fn for_fine_grid(&self, problem: &LocalProblem, polished: &Polished, increase: f64) -> Option<Design> {
        let grid = &self.model().settings().fine_grid;
        let step = grid.phi_step_deg();
        let home = polished.home.to_degrees() / step;
        // The nearest orientation of the grid: the other neighbour is lighter by a millionth at most.
        let home = problem.question().workspace.home_phi_deg.unwrap_or(home.round() * step);
        let mut question = problem.question().clone();
        question.workspace.home_phi_deg = Some(home);
        question.slack = ROOM;
        if let Region::Disc(radius) = &mut question.workspace.region {
            let ray_step = polished.design.base_radius() / grid.ray_steps() as f64;
            *radius = *radius * (1.0 + increase) + grid.resolution(ray_step);
        }
        let fixed = problem.with_question(question).ok()?;
        let found = fixed.polish(&polished.design, home.to_radians())?;
        Some(found.design).filter(|_| found.is_feasible())
    }

    /// Returns the best design near one that was evaluated on a grid, for the fine grid; `None` if it is infeasible, if its question has no
    /// local problem, or if no design near it holds.
    fn improved(&self, evaluation: &Evaluation) -> Option<Design> {
        let local = Some(evaluation)
            .filter(|evaluation| evaluation.is_feasible())
            .and_then(|evaluation| self.local_of(evaluation, &[]).ok())?;
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
        let problem = local.problem.with_question(question).ok()?;
        let polished = problem.polish(&evaluation.design, local.home?)?;
        self.for_fine_grid(&local.problem, &polished, 0.0)
    }
}
