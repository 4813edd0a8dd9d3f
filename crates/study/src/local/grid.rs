//! Optima for the fine grid, on which reported designs are verified.

use kinefront_model::evaluation::{Evaluation, GridChoice, Quantity};
use kinefront_model::mechanism::Design;
use kinefront_model::workers::Workers;
use kinefront_model::workspace::Region;
use kinefront_optimum::{LocalProblem, Polished};

use super::LocalAnswer;
use crate::{DesignProblem, PoolWorkers};

/// Slack that a design for the fine grid keeps, so that rounding misses no requirement.
pub(super) const ROOM: f64 = 2e-7;

/// Share of the objective that a design for the fine grid may cost before the other neighbour of its home orientation is tried.
const DEAR: f64 = 1e-3;

/// The largest slack that is tried where the optimum does not hold on the fine grid: a clearance has kinks, so that its least value can lie
/// between the poses that an optimum knows.
pub(super) const LARGEST_ROOM: f64 = 1e-3;

/// Slack that is added to that of a design which misses a requirement on the fine grid, as a multiple of what is missed.
const MORE: f64 = 1.5;

/// Number of optima with different entries of lists that are tried on the fine grid.
pub(super) const ANSWERS: usize = 3;

/// Relative amount by which the other objectives of an improved design may be worse.
const KEPT: f64 = 1e-3;

/// What is improved of a design, and what is held.
#[derive(Debug, Clone, Default)]
pub(crate) struct Aim {
    /// Place of the objective that is improved.
    pub improved: usize,
    /// Values that other objectives have to keep; those of the design for all that are not named.
    pub held: Vec<(Quantity, f64)>,
    /// Whether the dimensions that are listed or of a catalogue stay as they are.
    pub keeps_entries: bool,
}

impl DesignProblem {
    /// Verifies the best design near one that a search found, or that design itself if no better one holds on the fine grid.
    pub fn verify_improved(&self, design: &Design) -> Evaluation {
        let found = self.evaluate_design(design);
        // The evaluation may select another home orientation than the optimum has, in which an objective over poses is worse.
        let keeps_others = |better: &Evaluation| {
            let mut others = better.objectives.iter().zip(&found.objectives).skip(1);
            others.all(|(better, had)| *better <= had + KEPT * had.abs())
        };
        let has_lists = self.listed_variables().next().is_some();
        // With other entries than those of the best answer, a design may be worse than the one that was found.
        let is_no_worse = |better: &Evaluation| {
            let (value, had) = (better.objectives[0], found.objectives[0]);
            !has_lists || value <= had + KEPT * had.abs()
        };
        let improved = self.improved(&found, &Aim::default());
        // Without lists, a front has other designs in place of one that does not hold.
        let most = if has_lists { LARGEST_ROOM } else { ROOM };
        let mut better = improved
            .iter()
            .filter_map(|answer| self.held_on_fine_grid(answer, [ROOM, most], &PoolWorkers))
            .filter(|better| keeps_others(better) && is_no_worse(better));
        match better.next() {
            // It may be worse in the first objective, because it holds the others between the poses of the grid, too.
            Some(better) if better.objectives.len() > 1 => better,
            // On the fine grid, the design itself is hardly ever better than it was on the reference grid, and takes long to size.
            Some(better) if better.objectives[0] <= found.objectives[0] => better,
            Some(better) => {
                let verified = self.verify(design);
                let is_lighter = verified.is_feasible() && verified.objectives[0] < better.objectives[0];
                if is_lighter { verified } else { better }
            }
            None => self.verify(design),
        }
    }

    /// Returns the best design near another one for an aim, verified on the fine grid; `None` if none holds there.
    pub(crate) fn verify_toward(&self, near: &Evaluation, aim: &Aim) -> Option<Evaluation> {
        self.verify_with(near, aim, [ROOM, LARGEST_ROOM], &PoolWorkers)
    }

    /// Returns the best design near another one that keeps every requirement with a slack, verified on the fine grid; `None` if none does.
    pub(crate) fn with_slack(&self, near: &Evaluation, slack: f64, workers: &dyn Workers) -> Option<Evaluation> {
        let aim = Aim {
            keeps_entries: true,
            ..Aim::default()
        };
        self.verify_with(near, &aim, [slack; 2], workers)
    }

    fn verify_with(&self, near: &Evaluation, aim: &Aim, rooms: [f64; 2], workers: &dyn Workers) -> Option<Evaluation> {
        let improved = self.improved(near, aim);
        let mut held = improved.iter();
        held.find_map(|answer| self.held_on_fine_grid(answer, rooms, workers))
    }

    /// Evaluates an optimum on the fine grid, with more slack where it does not hold there; `None` if it does not.
    fn held_on_fine_grid(
        &self,
        (problem, polished): &(LocalProblem, Polished),
        rooms: [f64; 2],
        workers: &dyn Workers,
    ) -> Option<Evaluation> {
        self.held_with_room((problem, polished), rooms, 0.0, |design| {
            self.model().evaluate_by(workers, design, GridChoice::Fine)
        })
    }

    /// Evaluates an optimum for the fine grid by `evaluate` with the first of the slacks `rooms`, and with more, up to the last, where it
    /// misses a requirement; `None` if it does not hold with that either. The radius of a disc is increased by a share of itself.
    pub(super) fn held_with_room(
        &self,
        (problem, polished): (&LocalProblem, &Polished),
        [first, most]: [f64; 2],
        increase: f64,
        evaluate: impl Fn(&Design) -> Evaluation,
    ) -> Option<Evaluation> {
        let mut room = first;
        let mut is_estimated = false;
        loop {
            let design = self.for_fine_grid(problem, polished, increase, room);
            let missed = match design.map(|design| evaluate(&design)) {
                Some(found) if found.is_feasible() => return Some(found),
                Some(found) => missed_at_poses(&found),
                None => None,
            };
            if room >= most {
                return None;
            }
            let wanted = missed.map(|missed| room + MORE * missed);
            // Where this is not enough either, what is missed is no measure of what is needed.
            room = wanted.filter(|wanted| !is_estimated && *wanted < most).unwrap_or(most);
            is_estimated = true;
        }
    }

    /// Returns the value of the first objective, as it is minimised, at the optimum near a design that a search found; `None` if no optimum
    /// is found.
    pub fn objective_near(&self, design: &Design) -> Option<f64> {
        let evaluation = self.evaluate_design(design);
        let (problem, polished) = self.improved(&evaluation, &Aim::default()).into_iter().next()?;
        polished.is_feasible().then(|| problem.goal_sign() * polished.objective)
    }

    /// Returns an optimum again with a home orientation of the fine grid, and with the slack `room`. The radius of a disc is increased by a
    /// share of itself, and by the resolution of the grid.
    pub(super) fn for_fine_grid(
        &self,
        problem: &LocalProblem,
        polished: &Polished,
        increase: f64,
        room: f64,
    ) -> Option<Design> {
        let grid = &self.model().settings().fine_grid;
        let mut question = problem.question().clone();
        question.slack = room;
        if let Region::Disc(radius) = &mut question.workspace.region {
            let ray_step = polished.design.base_radius() / grid.ray_steps() as f64;
            *radius = *radius * (1.0 + increase) + grid.resolution(ray_step);
        }
        let at_home = |home_deg: f64| {
            let mut question = question.clone();
            question.workspace.home_phi_deg = Some(home_deg);
            let fixed = problem.with_question(question).ok()?;
            let found = fixed.polish(&polished.design, home_deg.to_radians())?;
            let loss = problem.goal_sign() * libm::log(found.objective / polished.objective);
            found.is_feasible().then_some((loss, found.design))
        };
        if let Some(stated) = question.workspace.home_phi_deg {
            return at_home(stated).map(|(_, design)| design);
        }
        // The other neighbour is usually better by a millionth at most. Where two clearances are least, one of the two may cost much, or
        // leave room for neither.
        let step = grid.phi_step_deg();
        let exact = polished.home.to_degrees() / step;
        let nearest = exact.round();
        let other = if nearest > exact { nearest - 1.0 } else { nearest + 1.0 };
        let mut best = at_home(nearest * step);
        if best.is_none_or(|(loss, _)| loss > DEAR) {
            let least = |best: Option<(f64, Design)>| best.map_or(f64::INFINITY, |(loss, _)| loss);
            best = [best, at_home(other * step)]
                .into_iter()
                .min_by(|a, b| least(*a).total_cmp(&least(*b)))
                .flatten();
        }
        best.map(|(_, design)| design)
    }

    /// Returns the optima near a design that was evaluated on a grid, the best first, each with its problem; none if the design is infeasible,
    /// or if its question has no local problem. There are several only where dimensions are listed or of a catalogue: with those of the
    /// design, and with the entries that are better.
    fn improved(&self, evaluation: &Evaluation, aim: &Aim) -> Vec<(LocalProblem, Polished)> {
        let local = Some(evaluation)
            .filter(|evaluation| evaluation.is_feasible())
            .and_then(|evaluation| self.local_toward(evaluation, aim.improved, &aim.held).ok());
        let Some((home, local)) = local.and_then(|local| Some((local.home?, local))) else {
            return Vec::new();
        };
        // An objective that the local problem does not know would be given up.
        let left_out = local.problem.left_out();
        let objectives = &self.model().settings().objectives;
        if objectives
            .iter()
            .any(|objective| left_out.contains(&objective.quantity))
        {
            return Vec::new();
        }
        let mut question = local.problem.question().clone();
        question.slack = ROOM;
        let solve = |design: &Design, home: f64, _: bool| {
            // Of a design with other entries, the dimensions that are kept are others.
            let problem = match *design == evaluation.design {
                true => local.problem.with_question(question.clone()),
                false => LocalProblem::new(question.clone(), design),
            };
            let problem = problem.ok()?;
            // A similar design has the radius that is aimed at, unless bounds are in the way.
            let scaled = problem.scaled(design, local.scale).filter(|scaled| scaled != design);
            let of_scaled = scaled.and_then(|scaled| problem.polish(&scaled, home));
            let polished = of_scaled
                .filter(Polished::is_feasible)
                .or_else(|| problem.polish(design, home))?;
            Some(LocalAnswer {
                polished,
                problem,
                part: 1.0,
            })
        };
        let own = solve(&evaluation.design, home, true);
        if local.entries.is_empty() || aim.keeps_entries {
            let own = own.map(|own| (local.problem, own.polished));
            return own.into_iter().collect();
        }
        let answers = self.follow_entries((evaluation.design, home), own, 1, &solve);
        let answers = answers.into_iter().take(ANSWERS);
        answers.map(|answer| (answer.problem, answer.polished)).collect()
    }
}

/// Returns by how much an infeasible design misses a requirement of poses over its prescribed region, as a share of the threshold or of
/// `R`; `None` if that is not known.
fn missed_at_poses(evaluation: &Evaluation) -> Option<f64> {
    let of_design = evaluation.limits.iter().filter(|result| match result.limit.quantity {
        Quantity::Worst(scalar) => !scalar.bounds_poses(),
        _ => true,
    });
    let missed = evaluation.violation - of_design.map(|result| (-result.margin).max(0.0)).sum::<f64>();
    (missed > 0.0).then_some(missed)
}
