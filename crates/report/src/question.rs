//! What a study asks, and how the searches approached it.

use super::Source;
use super::fronts::Front;
use kinefront_model::evaluation::{Better, Bound, Evaluation, ModelSettings, Objective, Quantity};
use kinefront_optimize::{Objectives, hypervolume};
use kinefront_study::{Column, DesignProblem, Study, levels_between};

/// The question of a study. Of several objectives, the first is what a design costs, and the second what it is compared by.
#[derive(Debug, Clone)]
pub(super) struct Question {
    pub objectives: Vec<Objective>,
    /// Value that the study requires of the second objective at least, if it does.
    least: Option<f64>,
    /// Reference point of the hypervolume.
    pub reference: Objectives,
    /// With one objective, its best value after so many evaluations, for each search; otherwise empty.
    pub progress: Vec<(String, Vec<[f64; 2]>)>,
}

impl Question {
    /// Returns the question of a study.
    pub fn of(study: &Study, problem: &DesignProblem, sources: &[Source]) -> Self {
        let objectives = problem.model().settings().objectives.clone();
        let progress = match objectives[..] {
            [objective] => sources
                .iter()
                .map(|source| (source.name.clone(), best_so_far(source, &objective)))
                .collect(),
            _ => Vec::new(),
        };
        Self {
            least: objectives
                .get(1)
                .and_then(|second| least(problem.model().settings(), second.quantity)),
            objectives,
            reference: study.hypervolume_reference(),
            progress,
        }
    }

    /// Whether a front is a curve, of which each design is the best with its value of the second objective.
    pub fn is_of_two(&self) -> bool {
        self.objectives.len() == 2
    }

    /// Returns the objective by which designs are compared: the second one, or the only one.
    pub fn compared(&self) -> usize {
        usize::from(self.objectives.len() > 1)
    }

    /// Returns the value of an objective of a design.
    pub fn value(&self, objective: usize, evaluation: &Evaluation) -> f64 {
        self.objectives[objective].value(evaluation.objectives[objective])
    }

    /// Returns the name of an objective without its unit.
    pub fn name(&self, objective: usize) -> &'static str {
        self.objectives[objective].quantity.entry().label
    }

    /// Returns the unit of an objective, with a space before it if there is one.
    pub fn unit(&self, objective: usize) -> String {
        match self.objectives[objective].quantity.entry().unit {
            "" => String::new(),
            unit => format!(" {unit}"),
        }
    }

    /// Returns the label of an objective with its unit.
    pub fn label(&self, objective: usize) -> String {
        Column::Quantity(self.objectives[objective].quantity).title()
    }

    /// Returns what a bound of an objective is called: at least or at most, whichever is harder to keep.
    pub fn bound(&self, objective: usize) -> &'static str {
        match self.objectives[objective].goal {
            Better::Lower => "at most",
            Better::Higher => "at least",
        }
    }

    /// Returns the hypervolume of a front.
    pub fn hypervolume(&self, front: &Front) -> f64 {
        let points = front
            .members
            .iter()
            .map(|member| DesignProblem::outcome(member).objectives);
        hypervolume(points, self.reference)
    }

    /// Returns the values of the second objective at which fronts are compared, rounded to two digits: from the start of its
    /// [`span`](Self::span) to its end.
    pub fn levels(&self, front: &Front) -> Vec<f64> {
        let Some([worst, best]) = self.span(front) else {
            return Vec::new();
        };
        let levels = levels_between(worst, best).into_iter();
        levels.filter(|&level| level != worst).collect()
    }

    /// Returns the worst and the best value of the second objective over a front. A range of values that are to be large, and none of
    /// which is negative, begins at what the study requires, or else at 0. `None` for other questions than those of two objectives, and for
    /// an empty front.
    pub fn span(&self, front: &Front) -> Option<[f64; 2]> {
        if !self.is_of_two() {
            return None;
        }
        let values = || front.members.iter().map(|member| self.value(1, member));
        let (low, high) = (values().reduce(f64::min)?, values().reduce(f64::max)?);
        Some(match self.objectives[1].goal {
            Better::Higher if low >= 0.0 => [self.least.unwrap_or(0.0).min(low), high],
            Better::Higher => [low, high],
            Better::Lower => [high, low],
        })
    }

    /// Returns the design of a front that is best in the first objective of those whose second one is at least as good as a value.
    pub fn best_at<'a>(&self, front: &'a Front, level: f64) -> Option<&'a Evaluation> {
        front.best_with(&[self.objectives.get(1)?.minimised(Some(level))])
    }

    /// Returns the first objective of that design.
    pub fn cost_at(&self, front: &Front, level: f64) -> Option<f64> {
        self.best_at(front, level).map(|found| self.value(0, found))
    }
}

/// Returns the value that a study requires of a quantity at every pose at least, or as a limit.
fn least(settings: &ModelSettings, quantity: Quantity) -> Option<f64> {
    let threshold = match quantity {
        Quantity::Worst(scalar) if scalar.entry().quantity.better == Better::Higher => settings.thresholds.get(scalar),
        _ => None,
    };
    let limit = settings.limits.iter().find_map(|limit| match limit.bound {
        Bound::AtLeast(least) if limit.quantity == quantity => Some(least),
        _ => None,
    });
    threshold.or(limit)
}

/// States an objective: what is sought of it.
pub(super) fn sought(objective: &Objective) -> &'static str {
    match objective.goal {
        Better::Lower => "as small as possible",
        Better::Higher => "as large as possible",
    }
}

/// Returns the best value of a single objective after each improvement, and at the end.
fn best_so_far(source: &Source, objective: &Objective) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for (index, row) in source.rows.iter().enumerate().filter(|(_, row)| row.is_feasible()) {
        let (at, value) = (index as f64 + 1.0, objective.value(row.objectives[0]));
        match points.last().copied() {
            Some([_, best]) if objective.minimised(Some(best)) <= row.objectives[0] => {}
            Some([_, best]) => points.extend([[at, best], [at, value]]),
            None => points.push([at, value]),
        }
    }
    if let Some([_, best]) = points.last().copied() {
        points.push([source.rows.len() as f64, best]);
    }
    points
}
