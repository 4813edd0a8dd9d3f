//! The default layout of the panels, and drawing the panels in their tiles.

use egui::{Ui, UiBuilder};
use egui_tiles::{Linear, LinearDir, SimplificationOptions, TileId, Tiles, Tree, UiResponse};

use super::super::Session;
use super::super::overlay;
use super::super::panels::{Panel, Panels, Place};
use super::super::platform_drag::PlatformDrag;
use super::super::pointing::describe;
use super::super::viewer::Viewer;

/// Returns the default layout.
pub(super) fn layout() -> Tree<Panel> {
    let mut tiles = Tiles::default();
    let mut tabs = |place: Place| {
        let panels = Panel::ALL.iter().filter(|panel| panel.place() == place);
        let panes = panels.map(|&panel| tiles.insert_pane(panel)).collect();
        tiles.insert_tab_tile(panes)
    };
    let run = tabs(Place::Run);
    let plot = tabs(Place::Plot);
    let scene = tabs(Place::Scene);
    let designs = tabs(Place::Designs);
    let design = tabs(Place::Design);
    let pose = tabs(Place::Pose);
    let mut split = |direction: LinearDir, parts: &[(TileId, f32)]| {
        let mut linear = Linear::new(direction, parts.iter().map(|(tile, _)| *tile).collect());
        for &(tile, fraction) in parts {
            linear.shares.set_share(tile, fraction);
        }
        tiles.insert_container(linear)
    };
    let left = split(LinearDir::Vertical, &[(plot, 1.5), (run, 1.0)]);
    let middle = split(LinearDir::Vertical, &[(scene, 2.0), (designs, 1.0)]);
    let right = split(LinearDir::Vertical, &[(design, 1.3), (pose, 1.0)]);
    let root = split(LinearDir::Horizontal, &[(left, 1.15), (middle, 1.75), (right, 0.9)]);
    Tree::new("kinefront", root, tiles)
}

/// Activates the tab of a panel. A layout that was saved before the panel existed gets the tab beside those of its place.
pub(super) fn show(tree: &mut Tree<Panel>, panel: Panel) {
    if tree.tiles.find_pane(&panel).is_none() {
        let tile = tree.tiles.insert_pane(panel);
        let mut others = Panel::ALL
            .iter()
            .filter(|other| **other != panel && other.place() == panel.place());
        let group = others.find_map(|other| tree.tiles.parent_of(tree.tiles.find_pane(other)?));
        match group.or(tree.root) {
            Some(group) => tree.move_tile_to_container(tile, group, usize::MAX, false),
            None => tree.root = Some(tile),
        }
    }
    tree.make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(other) if *other == panel));
}

/// Draws the panels into the tiles.
pub(super) struct Drawing<'a> {
    pub(super) session: &'a mut Session,
    pub(super) panels: &'a mut Panels,
    pub(super) viewer: Option<&'a mut Viewer>,
    pub(super) platform_drag: &'a PlatformDrag,
    pub(super) frame: &'a mut eframe::Frame,
}

impl egui_tiles::Behavior<Panel> for Drawing<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, panel: &mut Panel) -> UiResponse {
        if *panel == Panel::Scene {
            match &mut self.viewer {
                Some(viewer) => {
                    let pane = ui.max_rect();
                    let view = overlay::view_in(pane, self.session);
                    ui.scope_builder(UiBuilder::new().max_rect(view), |ui| viewer.ui(ui, self.frame));
                    self.platform_drag.ui(ui, self.session, viewer.view_of_design(ui.ctx()));
                    // What passes under a dragged platform is of no interest.
                    let pointed = viewer.pointed().filter(|_| !self.platform_drag.is_dragging());
                    let pointed = pointed.and_then(|pointed| describe(self.session, &pointed));
                    overlay::ui(ui, pane, view, self.session, pointed.as_ref());
                }
                None => drop(ui.weak("the 3-D viewer is not available")),
            }
            return UiResponse::None;
        }
        egui::Frame::central_panel(ui.style()).inner_margin(6).show(ui, |ui| {
            ui.push_id(*panel, |ui| {
                self.panels.ui(*panel, ui, self.session);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn is_active(tree: &Tree<Panel>, panel: Panel) -> bool {
        let tile = tree.tiles.find_pane(&panel).expect("the panel has a tile");
        tree.active_tiles().contains(&tile)
    }

    #[test]
    fn a_layout_saved_before_a_panel_existed_can_show_it() {
        for &panel in Panel::ALL {
            let mut tree = layout();
            let tile = tree
                .tiles
                .find_pane(&panel)
                .expect("the default layout has every panel");
            tree.remove_recursively(tile);
            assert!(tree.tiles.find_pane(&panel).is_none());
            // As it is when the window is opened again.
            let saved = serde_json::to_string(&tree).expect("a layout");
            let mut tree: Tree<Panel> = serde_json::from_str(&saved).expect("a layout");
            show(&mut tree, panel);
            assert!(is_active(&tree, panel), "{panel:?}");
            let others = Panel::ALL
                .iter()
                .filter(|other| **other != panel && other.place() == panel.place());
            for other in others {
                let parent = |panel| tree.tiles.parent_of(tree.tiles.find_pane(panel)?);
                assert_eq!(parent(other), parent(&panel), "{panel:?} is beside {other:?}");
            }
        }
    }

    #[test]
    fn a_panel_that_is_in_the_layout_is_shown_where_it_is() {
        let mut tree = layout();
        let before = tree.tiles.len();
        for &panel in Panel::ALL {
            show(&mut tree, panel);
            assert!(is_active(&tree, panel));
        }
        assert_eq!(tree.tiles.len(), before);
    }
}
