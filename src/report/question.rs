//! What a study asks, where that is not the least mass for the largest workspace, and how the searches approached it.

use super::Source;
use super::chart::{Chart, ChartAxis, Mark, Series};
use super::figures::{color, values};
use super::fronts::{Front, Fronts};
use crate::study::{Column, DesignProblem, Study};
use kinefront_model::evaluation::{Better, Evaluation, Objective};
use kinefront_model::mechanism::DESIGN_VARIABLES;
use kinefront_optimize::{Objectives, hypervolume};

/// Colours of the searches in the chart of their progress, and of the design variables.
const COLORS: [[u8; 3]; 5] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [120, 94, 240],
];

/// The question of a study.
#[derive(Debug, Clone)]
pub(super) struct Question {
    pub objectives: Vec<Objective>,
    /// Reference point of the hypervolume.
    pub reference: Objectives,
    /// With one objective, its best value after so many evaluations, for each search; otherwise empty.
    progress: Vec<(String, Vec<[f64; 2]>)>,
}

impl Question {
    /// Returns the question of a study; `None` for the one that the paper asks.
    pub fn of(study: &Study, problem: &DesignProblem, sources: &[Source]) -> Option<Self> {
        if study.asks_as_the_paper() {
            return None;
        }
        let objectives = problem.model().objectives.clone();
        let progress = match objectives[..] {
            [objective] => sources
                .iter()
                .map(|source| (source.name.clone(), best_so_far(source, &objective)))
                .collect(),
            _ => Vec::new(),
        };
        Some(Self {
            objectives,
            reference: study.hypervolume_reference(),
            progress,
        })
    }

    /// Returns the value of an objective of a design.
    pub fn value(&self, objective: usize, evaluation: &Evaluation) -> f64 {
        self.objectives[objective].value(evaluation.objectives[objective])
    }

    /// Returns the label of an objective with its unit.
    pub fn label(&self, objective: usize) -> String {
        Column::of_quantity(self.objectives[objective].quantity).title()
    }

    /// Returns the hypervolume of a front.
    pub fn hypervolume(&self, front: &Front) -> f64 {
        let points = front
            .members
            .iter()
            .map(|member| DesignProblem::outcome(member).objectives);
        hypervolume(points, self.reference)
    }

    /// Returns the design of a front that is best in one objective.
    pub fn best<'a>(&self, objective: usize, front: &'a Front) -> Option<&'a Evaluation> {
        let value = |member: &Evaluation| member.objectives[objective];
        front.members.iter().min_by(|a, b| value(a).total_cmp(&value(b)))
    }

    /// Draws the fronts over each pair of objectives, or the progress of the searches; each with its name and caption.
    pub fn charts(&self, fronts: &Fronts) -> Vec<(String, String, Chart)> {
        if self.objectives.len() == 1 {
            let name = "front-progress".to_owned();
            let words = format!("{} of the best design over the number of evaluations", self.label(0));
            return vec![(name, words, self.progress_chart())];
        }
        let count = self.objectives.len();
        let pairs = (0..count).flat_map(|x| (x + 1..count).map(move |y| [x, y]));
        let chart = |[x, y]: [usize; 2]| {
            let [a, b] = [x, y].map(|k| self.objectives[k].quantity.entry());
            let name = format!("front-{}-{}", a.key, b.key).replace('_', "-");
            let words = format!("Designs of the fronts: {} and {}", a.label, b.label);
            (name, words, self.pair_chart(fronts, [x, y]))
        };
        pairs.map(chart).collect()
    }

    fn pair_chart(&self, fronts: &Fronts, axes: [usize; 2]) -> Chart {
        let point = |member: &Evaluation| axes.map(|axis| self.value(axis, member));
        let series: Vec<Series> = fronts
            .alone
            .iter()
            .map(|(architecture, front)| Series {
                name: architecture.to_string(),
                color: color(*architecture),
                mark: if self.objectives.len() == 2 {
                    Mark::DottedLine
                } else {
                    Mark::Dots
                },
                points: front.shown().map(point).collect(),
            })
            .collect();
        let [x, y] = [0, 1].map(|axis| ChartAxis::about(self.label(axes[axis]), values(&series, axis)));
        plain(x, y, series)
    }

    fn progress_chart(&self) -> Chart {
        let series: Vec<Series> = self
            .progress
            .iter()
            .zip(COLORS.into_iter().cycle())
            .map(|((name, points), color)| Series {
                name: if self.progress.len() > 1 {
                    name.clone()
                } else {
                    String::new()
                },
                color,
                mark: Mark::Line,
                points: points.clone(),
            })
            .collect();
        let x = ChartAxis::from_zero("evaluations", values(&series, 0));
        let y = ChartAxis::about(self.label(0), values(&series, 1));
        Chart {
            legend_above: false,
            ..plain(x, y, series)
        }
    }

    /// Draws the design variables along a front, over the first objective; `None` if there is but one objective.
    pub fn variables(&self, front: &Front, bars: bool) -> Option<Chart> {
        if self.objectives.len() == 1 {
            return None;
        }
        let shown = DESIGN_VARIABLES
            .into_iter()
            .filter(|variable| variable.may_be_zero() == bars);
        let series: Vec<Series> = shown
            .zip(COLORS)
            .map(|(variable, color)| Series {
                name: variable.symbol().to_owned(),
                color,
                mark: Mark::Dots,
                points: front
                    .shown()
                    .map(|member| [self.value(0, member), member.design.values()[variable as usize]])
                    .collect(),
            })
            .collect();
        let x = ChartAxis::about(self.label(0), values(&series, 0));
        let y = ChartAxis::from_zero("[m]", values(&series, 1));
        Some(plain(x, y, series))
    }
}

fn plain(x: ChartAxis, y: ChartAxis, series: Vec<Series>) -> Chart {
    Chart {
        x,
        y,
        names: None,
        series,
        notes: Vec::new(),
        legend_above: true,
    }
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
