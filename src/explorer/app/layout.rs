//! The default layout of the panels, and drawing the panels in their tiles.

use egui::Ui;
use egui_tiles::{Linear, LinearDir, SimplificationOptions, TileId, Tiles, Tree, UiResponse};

use super::super::files::Purpose;
use super::super::overlay;
use super::super::pointing::describe;
use super::super::viewer::Viewer;
use super::super::{Panel, Panels, Session};

/// Returns the default layout.
pub(super) fn layout() -> Tree<Panel> {
    let mut tiles = Tiles::default();
    let mut tabs = |panels: &[Panel]| {
        let panes = panels.iter().map(|&panel| tiles.insert_pane(panel)).collect();
        tiles.insert_tab_tile(panes)
    };
    let run = tabs(&[Panel::Run, Panel::Study, Panel::Mechanisms]);
    let scatter = tabs(&[Panel::Scatter, Panel::Space]);
    let scene = tabs(&[Panel::Scene]);
    let below = tabs(&[Panel::Front, Panel::Parallel, Panel::Compare]);
    let design = tabs(&[Panel::Inspector, Panel::Choose]);
    let pose = tabs(&[Panel::Pose, Panel::Layers]);
    let mut split = |direction: LinearDir, parts: &[(TileId, f32)]| {
        let mut linear = Linear::new(direction, parts.iter().map(|(tile, _)| *tile).collect());
        for &(tile, fraction) in parts {
            linear.shares.set_share(tile, fraction);
        }
        tiles.insert_container(linear)
    };
    let left = split(LinearDir::Vertical, &[(scatter, 1.5), (run, 1.0)]);
    let middle = split(LinearDir::Vertical, &[(scene, 2.0), (below, 1.0)]);
    let right = split(LinearDir::Vertical, &[(design, 1.3), (pose, 1.0)]);
    let root = split(LinearDir::Horizontal, &[(left, 1.15), (middle, 1.75), (right, 0.9)]);
    Tree::new("kinefront", root, tiles)
}

/// Draws the panels into the tiles, and collects a panel's request for a file dialog.
pub(super) struct Drawing<'a> {
    pub(super) session: &'a mut Session,
    pub(super) panels: &'a mut Panels,
    pub(super) viewer: Option<&'a mut Viewer>,
    pub(super) frame: &'a mut eframe::Frame,
    pub(super) requested: Option<Purpose>,
}

impl egui_tiles::Behavior<Panel> for Drawing<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, panel: &mut Panel) -> UiResponse {
        if *panel == Panel::Scene {
            match &mut self.viewer {
                Some(viewer) => {
                    let pane = ui.max_rect();
                    viewer.ui(ui, self.frame);
                    let pointed = viewer.pointed();
                    let pointed = pointed.and_then(|pointed| describe(self.session, &pointed));
                    overlay::ui(ui, pane, self.session, pointed.as_ref());
                }
                None => drop(ui.weak("the 3-D viewer is not available")),
            }
            return UiResponse::None;
        }
        egui::Frame::central_panel(ui.style()).inner_margin(6).show(ui, |ui| {
            ui.push_id(*panel, |ui| {
                let requested = self.panels.ui(*panel, ui, self.session);
                self.requested = self.requested.or(requested);
            });
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, panel: &Panel) -> egui::WidgetText {
        panel.title().into()
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions {
            all_panes_must_have_tabs: true,
            ..SimplificationOptions::default()
        }
    }
}
