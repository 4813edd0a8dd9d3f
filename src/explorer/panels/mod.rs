//! The panels, one per file.

mod choose;
mod compare;
mod inspector;
mod layers;
mod parallel;
mod plan;
mod pose;
mod run;
pub mod scatter;
mod study;
mod table;

use egui::Ui;
use serde::{Deserialize, Serialize};

use self::choose::ChoosePanel;
use self::compare::ComparePanel;
use self::inspector::Inspector;
use self::layers::LayersPanel;
use self::parallel::ParallelPanel;
use self::pose::PosePanel;
use self::run::RunPanel;
use self::scatter::Scatter;
use self::study::StudyPanel;
use self::table::TablePanel;
use super::Session;
use super::files::Purpose;

/// A panel of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Panel {
    /// Settings, controls and progress of the run.
    Run,
    /// The study's settings.
    Study,
    /// The scatter plot.
    Scatter,
    /// The embedded 3-D viewer.
    Scene,
    /// The inspector of the selected design.
    Design,
    /// The pose of the selected design.
    Pose,
    /// Layers that are drawn in 3-D.
    VisibleLayers,
    /// Pinned designs side by side.
    Compare,
    /// Decision support, and the filter.
    Choose,
    /// The front as a table.
    Table,
    /// The plot in parallel coordinates.
    Parallel,
}

impl Panel {
    /// All panels.
    pub const ALL: [Panel; 11] = [
        Panel::Run,
        Panel::Study,
        Panel::Scatter,
        Panel::Scene,
        Panel::Design,
        Panel::Pose,
        Panel::VisibleLayers,
        Panel::Compare,
        Panel::Choose,
        Panel::Table,
        Panel::Parallel,
    ];

    /// Returns the title of the panel's tab.
    pub fn title(self) -> &'static str {
        match self {
            Panel::Run => "Run",
            Panel::Study => "Study",
            Panel::Scatter => "Scatter",
            Panel::Scene => "3-D",
            Panel::Design => "Inspector",
            Panel::Pose => "Pose",
            Panel::VisibleLayers => "Layers",
            Panel::Compare => "Compare",
            Panel::Choose => "Choose",
            Panel::Table => "Front",
            Panel::Parallel => "Parallel coordinates",
        }
    }
}

/// State of all panels except the embedded viewer.
#[derive(Default)]
pub struct Panels {
    run: RunPanel,
    study: StudyPanel,
    /// The scatter panel.
    pub scatter: Scatter,
    design: Inspector,
    pose: PosePanel,
    layers: LayersPanel,
    compare: ComparePanel,
    choose: ChoosePanel,
    table: TablePanel,
    parallel: ParallelPanel,
}

impl Panels {
    /// Draws a panel. Returns the purpose of the file dialog that the panel requests, if any.
    pub fn ui(&mut self, panel: Panel, ui: &mut Ui, session: &mut Session) -> Option<Purpose> {
        match panel {
            Panel::Run => self.run.ui(ui, session),
            Panel::Study => return self.study.ui(ui, session).then_some(Purpose::SaveStudy),
            Panel::Scatter => self.scatter.ui(ui, session),
            Panel::Design => self.design.ui(ui, session),
            Panel::Pose => self.pose.ui(ui, session),
            Panel::VisibleLayers => self.layers.ui(ui, session),
            Panel::Compare => self.compare.ui(ui, session),
            Panel::Choose => {
                return self.choose.ui(ui, session).map(|requested| match requested {
                    choose::FilterFile::Save => Purpose::SaveFilter,
                    choose::FilterFile::Open => Purpose::OpenFilter,
                });
            }
            Panel::Table => self.table.ui(ui, session),
            Panel::Parallel => self.parallel.ui(ui, session),
            // Drawn by the window, which owns the viewer.
            Panel::Scene => {}
        }
        None
    }
}
