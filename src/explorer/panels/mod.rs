//! The panels, one per file.

mod choose;
mod compare;
mod front;
mod inspector;
mod layers;
mod mechanisms;
mod modes;
mod parallel;
mod plan;
mod pose;
mod progress;
mod question;
mod run;
pub mod scatter;
mod sketch;
mod space;
mod study;

use egui::Ui;
use serde::{Deserialize, Serialize};

use self::choose::ChoosePanel;
use self::compare::ComparePanel;
use self::front::FrontPanel;
use self::inspector::Inspector;
use self::layers::LayersPanel;
use self::mechanisms::MechanismsPanel;
use self::parallel::ParallelPanel;
use self::pose::PosePanel;
use self::run::RunPanel;
use self::scatter::Scatter;
use self::space::SpacePanel;
use self::study::StudyPanel;
use super::Session;
use super::files::Purpose;

/// Gives a button whose text is a symbol a name for assistive technology, and says it when the pointer is over the button.
pub(super) fn named(button: egui::Response, name: &str) -> egui::Response {
    let enabled = button.enabled();
    button.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, enabled, name));
    button.on_hover_text(name)
}

/// A panel of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Panel {
    /// Settings, controls and progress of the run.
    Run,
    /// The study's settings.
    Study,
    /// The architectures, and which of them the study searches.
    Mechanisms,
    /// The scatter plot.
    Scatter,
    /// The designs in three quantities.
    Space,
    /// The embedded 3-D viewer.
    Scene,
    /// The inspector of the selected design.
    #[serde(alias = "Design")]
    Inspector,
    /// The pose of the selected design.
    Pose,
    /// Layers that are drawn in 3-D.
    Layers,
    /// Pinned designs side by side.
    Compare,
    /// Decision support, and the filter.
    Choose,
    /// The front as a table.
    #[serde(alias = "Table")]
    Front,
    /// The plot in parallel coordinates.
    Parallel,
}

impl Panel {
    /// All panels.
    pub const ALL: [Panel; 13] = [
        Panel::Run,
        Panel::Study,
        Panel::Mechanisms,
        Panel::Scatter,
        Panel::Space,
        Panel::Scene,
        Panel::Inspector,
        Panel::Pose,
        Panel::Layers,
        Panel::Compare,
        Panel::Choose,
        Panel::Front,
        Panel::Parallel,
    ];

    /// Returns the title of the panel's tab.
    pub fn title(self) -> &'static str {
        match self {
            Panel::Run => "Run",
            Panel::Study => "Study",
            Panel::Mechanisms => "Mechanisms",
            Panel::Scatter => "Scatter",
            Panel::Space => "Space",
            Panel::Scene => "3-D",
            Panel::Inspector => "Inspector",
            Panel::Pose => "Pose",
            Panel::Layers => "Layers",
            Panel::Compare => "Compare",
            Panel::Choose => "Choose",
            Panel::Front => "Front",
            Panel::Parallel => "Parallel coordinates",
        }
    }
}

/// State of all panels except the embedded viewer.
#[derive(Default)]
pub struct Panels {
    run: RunPanel,
    study: StudyPanel,
    mechanisms: MechanismsPanel,
    /// The scatter panel.
    pub scatter: Scatter,
    space: SpacePanel,
    inspector: Inspector,
    pose: PosePanel,
    layers: LayersPanel,
    compare: ComparePanel,
    choose: ChoosePanel,
    front: FrontPanel,
    parallel: ParallelPanel,
}

impl Panels {
    /// Draws a panel. Returns the purpose of the file dialog that the panel requests, if any.
    pub fn ui(&mut self, panel: Panel, ui: &mut Ui, session: &mut Session) -> Option<Purpose> {
        match panel {
            Panel::Run => self.run.ui(ui, session),
            Panel::Study => return self.study.ui(ui, session).then_some(Purpose::SaveStudy),
            Panel::Mechanisms => self.mechanisms.ui(ui, session),
            Panel::Scatter => self.scatter.ui(ui, session),
            Panel::Space => self.space.ui(ui, session),
            Panel::Inspector => self.inspector.ui(ui, session),
            Panel::Pose => self.pose.ui(ui, session),
            Panel::Layers => self.layers.ui(ui, session),
            Panel::Compare => self.compare.ui(ui, session),
            Panel::Choose => {
                return self.choose.ui(ui, session).map(|requested| match requested {
                    choose::FilterFile::Save => Purpose::SaveFilter,
                    choose::FilterFile::Open => Purpose::OpenFilter,
                });
            }
            Panel::Front => self.front.ui(ui, session),
            Panel::Parallel => self.parallel.ui(ui, session),
            // Drawn by the window, which owns the viewer.
            Panel::Scene => {}
        }
        None
    }
}
