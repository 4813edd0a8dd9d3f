//! The panels, one a file.

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
    /// The run.
    Run,
    /// The study's settings.
    Study,
    /// The scatter.
    Scatter,
    /// The embedded viewer.
    Scene,
    /// The design in the light.
    Design,
    /// Its pose.
    Pose,
    /// What is drawn.
    Layers,
    /// Pinned designs side by side.
    Compare,
    /// Help in choosing, and the filter.
    Choose,
    /// The front as a table.
    Table,
    /// Parallel coordinates.
    Parallel,
}

impl Panel {
    /// All of them.
    pub const ALL: [Panel; 11] = [
        Panel::Run,
        Panel::Study,
        Panel::Scatter,
        Panel::Scene,
        Panel::Design,
        Panel::Pose,
        Panel::Layers,
        Panel::Compare,
        Panel::Choose,
        Panel::Table,
        Panel::Parallel,
    ];

    /// Title of its tab.
    pub fn title(self) -> &'static str {
        match self {
            Panel::Run => "Run",
            Panel::Study => "Study",
            Panel::Scatter => "Scatter",
            Panel::Scene => "3-D",
            Panel::Design => "Design",
            Panel::Pose => "Pose",
            Panel::Layers => "Layers",
            Panel::Compare => "Compare",
            Panel::Choose => "Choose",
            Panel::Table => "Front",
            Panel::Parallel => "Parallel coordinates",
        }
    }
}

/// The state of all panels but the embedded viewer.
#[derive(Default)]
pub struct Panels {
    run: RunPanel,
    study: StudyPanel,
    /// The scatter.
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
    /// Draws a panel; tells which file it asks for.
    pub fn ui(&mut self, panel: Panel, ui: &mut Ui, session: &mut Session) -> Option<Purpose> {
        match panel {
            Panel::Run => self.run.ui(ui, session),
            Panel::Study => return self.study.ui(ui, session).then_some(Purpose::SaveStudy),
            Panel::Scatter => self.scatter.ui(ui, session),
            Panel::Design => self.design.ui(ui, session),
            Panel::Pose => self.pose.ui(ui, session),
            Panel::Layers => self.layers.ui(ui, session),
            Panel::Compare => self.compare.ui(ui, session),
            Panel::Choose => {
                return self.choose.ui(ui, session).map(|asked| match asked {
                    choose::FilterFile::Save => Purpose::SaveFilter,
                    choose::FilterFile::Open => Purpose::OpenFilter,
                });
            }
            Panel::Table => self.table.ui(ui, session),
            Panel::Parallel => self.parallel.ui(ui, session),
            // Drawn by the window, which has the viewer.
            Panel::Scene => {}
        }
        None
    }
}
