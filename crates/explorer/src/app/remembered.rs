//! The state of the window that is saved between two sessions.

use std::path::PathBuf;

use egui_tiles::Tree;
use serde::{Deserialize, Serialize};

use super::super::panels::Panel;
use super::super::panels::scatter::{Scatter, ScatterAxis};
use super::Explorer;
use kinefront_study::Column;

/// What is saved.
#[derive(Serialize, Deserialize)]
pub(super) struct Remembered {
    pub tree: Tree<Panel>,
    axes: [ScatterAxis; 2],
    /// Names of the objectives for which the axes were chosen.
    #[serde(default)]
    objectives: Vec<String>,
    pub recent: Vec<PathBuf>,
    pub dark: bool,
    /// Whether the introduction was closed.
    #[serde(default)]
    pub introduced: bool,
}

impl Remembered {
    /// Notes the state of the window.
    pub fn of(explorer: &Explorer) -> Self {
        let scatter = explorer.panels.scatter();
        let objectives = scatter.followed().iter();
        Self {
            tree: explorer.tree.clone(),
            axes: scatter.axes(),
            objectives: objectives.map(|column| column.name().into_owned()).collect(),
            recent: explorer.recent.clone(),
            dark: explorer.dark,
            introduced: !explorer.introduction,
        }
    }

    /// Returns the scatter with its axes.
    pub fn scatter(&self) -> Scatter {
        let objectives = self.objectives.iter();
        let objectives = objectives.filter_map(|name| Column::find_quantity(name));
        Scatter::new(self.axes, objectives.collect())
    }
}
