//! The panels, one per file.

mod accuracy;
mod beside;
mod choose;
mod compare;
mod drivers;
mod examples;
mod fields;
mod front;
mod inspector;
mod layers;
mod mechanisms;
mod modes;
mod motion;
mod obstacles;
mod parallel;
mod plan;
mod pose;
mod prices;
mod progress;
mod question;
mod run;
pub mod scatter;
mod sketch;
mod space;
mod strength;
mod study;
mod vibration;
mod what_if;
mod why_not;
mod wish;

use egui::Ui;
use serde::{Deserialize, Serialize};

use self::scatter::Scatter;
use super::Session;

/// Gives a button whose text is a symbol a name for assistive technology, and says it when the pointer is over the button.
pub(super) fn named(button: egui::Response, name: &str) -> egui::Response {
    let enabled = button.enabled();
    button.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, enabled, name));
    button.on_hover_text(name)
}

/// Shows a button with a hint; returns whether it was clicked.
pub(super) fn button<'a>(ui: &mut Ui, text: impl egui::IntoAtoms<'a>, hint: &str) -> bool {
    ui.button(text).on_hover_text(hint).clicked()
}

/// Shows a button with a hint for while it can be clicked, and one for while it cannot; returns whether it was clicked.
pub(super) fn button_if(ui: &mut Ui, is_enabled: bool, button: egui::Button<'_>, hints: [&str; 2]) -> bool {
    let button = ui.add_enabled(is_enabled, button).on_hover_text(hints[0]);
    button.on_disabled_hover_text(hints[1]).clicked()
}

/// Shows a control that has no name beside it, and gives it one for assistive technology.
pub(super) fn add_named(ui: &mut Ui, control: impl egui::Widget, name: &str) -> egui::Response {
    let response = ui.add(control);
    ui.ctx()
        .accesskit_node_builder(response.id, |node| node.set_label(name));
    response
}

/// Shows the titles of the columns of a grid.
pub(super) fn headings(ui: &mut Ui, titles: impl IntoIterator<Item = impl Into<egui::RichText>>) {
    for title in titles {
        ui.strong(title);
    }
    ui.end_row();
}

/// Writes into the middle of an empty plot what comes there.
pub(super) fn say_empty(ui: &Ui, painter: &egui::Painter, middle: egui::Pos2, words: &str) {
    let color = ui.visuals().weak_text_color();
    let font = egui::FontId::proportional(13.0);
    painter.text(middle, egui::Align2::CENTER_CENTER, words, font, color);
}

/// Returns the least and the largest of values; of none, the first is above the second.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let values = values.into_iter();
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

/// Shows the button that starts and pauses a playback.
pub(super) fn play_button(ui: &mut Ui, is_playing: &mut bool) {
    let (symbol, name) = if *is_playing { ("⏸", "Pause") } else { ("▶", "Play") };
    if named(ui.add(crate::theme::toggle(*is_playing, symbol)), name).clicked() {
        *is_playing = !*is_playing;
    }
}

/// Height of a bar that shows a share.
const SHARE_BAR: f32 = 20.0;

/// Shows a text on a bar that is as long as a share of the width, at most the whole.
pub(super) fn share_bar(ui: &mut Ui, share: f32, text: &str, color: egui::Color32) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(egui::vec2(ui.available_width(), SHARE_BAR), egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Label, true, text));
    let painter = ui.painter_at(rect);
    let width = share.clamp(0.0, 1.0) * rect.width();
    let bar = egui::Rect::from_min_size(rect.min, egui::vec2(width, SHARE_BAR - 3.0));
    painter.rect_filled(bar, 2.0, color.gamma_multiply(0.35));
    painter.text(
        egui::pos2(rect.left() + 5.0, rect.center().y - 1.5),
        egui::Align2::LEFT_CENTER,
        text,
        egui::FontId::proportional(12.5),
        crate::theme::ink(ui),
    );
    response
}

/// Makes a field of a number take what is typed as a whole, when it is left or Enter is pressed: half of a number is often invalid.
/// Escape restores the value.
pub(super) fn typed<'a>(ui: &egui::Ui, field: egui::DragValue<'a>) -> egui::DragValue<'a> {
    // A field takes its text also in the frame after the one in which Escape has ended its editing.
    let (frame, id) = (
        ui.ctx().cumulative_frame_nr(),
        egui::Id::new("frame of the last Escape"),
    );
    if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
        ui.data_mut(|data| data.insert_temp(id, frame));
    }
    let ended = ui.data(|data| data.get_temp::<u64>(id));
    let is_restored = ended.is_some_and(|ended| frame <= ended + 1);
    field.update_while_editing(false).custom_parser(move |text| {
        let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        let number = text.replace('−', "-").parse().ok();
        number.filter(|_| !is_restored)
    })
}

/// The group of tabs that a panel is in when the window opens for the first time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// Top left.
    Plot,
    /// Bottom left.
    Run,
    /// Top middle.
    Scene,
    /// Bottom middle.
    Designs,
    /// Top right.
    Design,
    /// Bottom right.
    Pose,
}

/// Declares the panels: what each is called in the code and in the layout that is saved, its state, its title and its place. The
/// state is drawn by its method `ui`; what has no state is drawn by the window.
macro_rules! panels {
    ($($(#[$attribute:meta])* $panel:ident $(= $state:ident: $type:ty)?, $title:literal, $place:ident;)*) => {
        /// A panel of the window.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum Panel {
            $($(#[$attribute])* $panel,)*
        }

        impl Panel {
            /// All panels.
            pub const ALL: &'static [Panel] = &[$(Panel::$panel),*];

            /// Returns the title of the panel's tab.
            pub fn title(self) -> &'static str {
                match self {
                    $(Panel::$panel => $title,)*
                }
            }

            /// Returns the group of tabs that the panel is in when the window opens for the first time.
            pub(super) fn place(self) -> Place {
                match self {
                    $(Panel::$panel => Place::$place,)*
                }
            }
        }

        /// State of the panels.
        #[derive(Default)]
        pub struct Panels {
            $($($state: $type,)?)*
        }

        impl Panels {
            /// Draws a panel.
            pub fn ui(&mut self, panel: Panel, ui: &mut Ui, session: &mut Session) {
                match panel {
                    $(Panel::$panel => { $(self.$state.ui(ui, session);)? })*
                }
            }
        }
    };
}

panels! {
    /// Settings, controls and progress of the run.
    Run = run: run::RunPanel, "Run", Run;
    /// The study's settings.
    Study = study: study::StudyPanel, "Study", Run;
    /// The built-in studies with pictures.
    Examples = examples: examples::ExamplesPanel, "Examples", Run;
    /// The architectures, and which of them the study searches.
    Mechanisms = mechanisms: mechanisms::MechanismsPanel, "Mechanisms", Run;
    /// The scatter plot.
    Scatter = scatter: Scatter, "Scatter", Plot;
    /// The designs in three quantities.
    Space = space: space::SpacePanel, "Space", Plot;
    /// The embedded 3-D viewer, which the window draws.
    Scene, "3-D", Scene;
    /// The inspector of the selected design.
    #[serde(alias = "Design")]
    Inspector = inspector: inspector::Inspector, "Inspector", Design;
    /// What drives the mass of the selected design.
    Drivers = drivers: drivers::DriversPanel, "Drivers", Design;
    /// What is wished of the selected design, and the design that has it.
    Wish = wish: wish::WishPanel, "Wish", Design;
    /// Why a point beyond the front cannot be had.
    WhyNot = why_not: why_not::WhyNotPanel, "Why not", Design;
    /// Decision support, and the filter.
    Choose = choose: choose::ChoosePanel, "Choose", Design;
    /// The pose of the selected design.
    Pose = pose: pose::PosePanel, "Pose", Pose;
    /// Stresses of the bars at the pose, and which of them buckles first.
    Strength = strength: strength::StrengthPanel, "Strength", Pose;
    /// Natural frequencies at the pose, and how the machine vibrates at each.
    Vibration = vibration: vibration::VibrationPanel, "Vibration", Pose;
    /// Errors of the pose, and what causes them.
    Accuracy = accuracy: accuracy::AccuracyPanel, "Accuracy", Pose;
    /// Layers that are drawn in 3-D.
    Layers = layers: layers::LayersPanel, "Layers", Pose;
    /// The front as a table.
    #[serde(alias = "Table")]
    Front = front: front::FrontPanel, "Front", Designs;
    /// The plot in parallel coordinates.
    Parallel = parallel: parallel::ParallelPanel, "Parallel coordinates", Designs;
    /// What drives the mass along the front.
    Prices = prices: prices::PricesPanel, "Prices", Designs;
    /// The motion that the selected design follows.
    Motion = motion: motion::MotionPanel, "Motion", Designs;
    /// Pinned designs side by side.
    Compare = compare: compare::ComparePanel, "Compare", Designs;
    /// The front beside that of another run.
    Beside = beside: beside::BesidePanel, "Second run", Designs;
}

impl Panels {
    /// The scatter.
    pub(super) fn scatter(&self) -> &Scatter {
        &self.scatter
    }

    /// The scatter for modification.
    pub(super) fn scatter_mut(&mut self) -> &mut Scatter {
        &mut self.scatter
    }
}
