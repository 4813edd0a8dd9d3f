//! Runs of different studies side by side: what differs in the studies, and the fronts that they found.

use std::path::Path;

use kinefront_model::evaluation::Objective;
use kinefront_optimize::Objectives;
use kinefront_study::{Column, EqualLevel, RunFolder, SettingDifference, Study, equal_levels};

use super::chart::{Chart, ChartAxis, Mark, Series};
use super::figures::{Figures, values};
use super::{Figure, ReportError, Topic};
use kinefront_model::evaluation::Scale;
use kinefront_scene::palette;

/// A run with its reported front.
#[derive(Debug, Clone)]
pub(crate) struct Run {
    pub name: String,
    pub study: Study,
    /// The objectives of the designs of the front, as they are minimised, in the order of the first one.
    pub front: Vec<Objectives>,
}

/// Runs of studies that ask for the same objectives and differ otherwise.
#[derive(Debug, Clone)]
pub struct SideBySide {
    pub(crate) runs: Vec<Run>,
    pub(crate) objectives: Vec<Objective>,
    /// What differs between the study of the first run and that of each other one.
    pub(crate) differences: Vec<Vec<SettingDifference>>,
    pub(crate) levels: Vec<EqualLevel>,
    pub(crate) figures: Vec<Figure>,
    pub(crate) command: String,
}

impl SideBySide {
    /// Reads the fronts of runs whose studies have the same objectives.
    ///
    /// # Errors
    /// [`ReportError`] if a folder cannot be read, if the objectives differ, or if a run has no front.
    pub fn read(folders: &[impl AsRef<Path>], command: String) -> Result<Self, ReportError> {
        let runs: Vec<Run> = folders
            .iter()
            .map(|folder| read(folder.as_ref()))
            .collect::<Result<_, _>>()?;
        let Some((first, others)) = runs.split_first() else {
            return Err(ReportError::NothingFeasible);
        };
        let objectives = first.study.objectives();
        if let Some(other) = others.iter().find(|other| other.study.objectives() != objectives) {
            return Err(ReportError::Differing {
                first: first.name.clone(),
                other: other.name.clone(),
                key: "objectives".to_owned(),
            });
        }
        let fronts: Vec<Vec<Objectives>> = runs.iter().map(|run| run.front.clone()).collect();
        let mut found = Self {
            differences: others
                .iter()
                .map(|other| first.study.differences(&other.study))
                .collect(),
            levels: equal_levels(&objectives, &fronts),
            figures: Vec::new(),
            objectives,
            command,
            runs,
        };
        found.figures = found.draw()?;
        Ok(found)
    }

    /// Draws the fronts, over a linear axis of the first objective and, where its values span decades, over a logarithmic one.
    fn draw(&self) -> Result<Vec<Figure>, ReportError> {
        let [first, second] = self.objectives.as_slice() else {
            return Ok(Vec::new());
        };
        let label = |objective: &Objective| Column::Quantity(objective.quantity).title();
        let is_of_decades = first.quantity.entry().scale == Scale::Logarithmic;
        let kinds = [("fronts", false), ("fronts-log", true)];
        let kinds = kinds.into_iter().filter(|(_, decades)| is_of_decades || !decades);
        let mut figures = Figures::default();
        for (name, decades) in kinds {
            let runs = self.runs.iter().zip(palette::SERIES.into_iter().cycle());
            let series: Vec<Series> = runs
                .map(|(run, color)| {
                    let points = run.front.iter();
                    let points = points.map(|point| [first.value(point[0]), second.value(point[1])]);
                    Series::new(&run.name, color, Mark::DottedLine, points.collect())
                })
                .collect();
            let x = match decades {
                true => ChartAxis::decades(label(first), values(&series, 0)),
                false => ChartAxis::from_zero_if_near(label(first), values(&series, 0)),
            };
            let y = ChartAxis::from_zero_if_near(label(second), values(&series, 1));
            let chart = Chart {
                legend_above: decades,
                ..Chart::new(x, y, series)
            };
            let over = if decades { ", with a logarithmic axis" } else { "" };
            figures.add(Topic::Fronts, name, format!("Reported fronts of the runs{over}"), chart)?;
        }
        Ok(figures.0)
    }
}

fn read(folder: &Path) -> Result<Run, ReportError> {
    let run = RunFolder::open(folder)?;
    let front = run.front()?.map(|front| front.rows).unwrap_or_default();
    let mut front: Vec<Objectives> = front.iter().map(|entry| entry.row.objectives).collect();
    if front.is_empty() {
        return Err(ReportError::NoFront(run.name()));
    }
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    Ok(Run {
        name: run.name(),
        study: run.study().clone(),
        front,
    })
}
