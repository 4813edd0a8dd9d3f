//! The layers panel: what is drawn of the selected design in 3-D.

use egui::{Slider, Ui};

use crate::Session;
use kinefront_scene::{EllipsoidKind, PathColor};

/// The layers panel.
#[derive(Default)]
pub struct LayersPanel;

impl LayersPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let fields = session.fields();
        let layers = &mut session.view_mut().layers;
        for (flag, name) in [
            (&mut layers.legs, "Legs"),
            (&mut layers.platform, "Platform"),
            (&mut layers.stresses, "Bars coloured by stress"),
            (&mut layers.labels, "Labels"),
            (&mut layers.clearance, "Nearest pair of members"),
            (&mut layers.workspace, "Regular workspace"),
            (&mut layers.singularities, "Singularities"),
            (&mut layers.proof, "Proof of the workspace"),
            (&mut layers.configuration, "Configuration space"),
        ] {
            ui.checkbox(flag, name);
        }
        let mut is_shown = layers.path.is_some();
        if ui.checkbox(&mut is_shown, "Path of the motion").changed() {
            layers.path = is_shown.then_some(PathColor::FORCE);
        }
        ui.separator();
        ui.label("ellipsoids");
        ui.radio_value(&mut layers.ellipsoids, None, "no ellipsoids");
        for kind in EllipsoidKind::ALL {
            ui.radio_value(&mut layers.ellipsoids, Some(kind), format!("{} ellipsoids", kind.key()));
        }
        ui.separator();
        ui.label("heatmap");
        ui.radio_value(&mut layers.heatmap, None, "no heatmap");
        for field in fields {
            ui.radio_value(&mut layers.heatmap, Some(field), field.title());
        }
        let Some(home) = session.home() else {
            return;
        };
        let mut degrees = (session.view().heatmap_phi.unwrap_or(home.phi) - home.phi).to_degrees();
        ui.horizontal(|ui| {
            let label = ui.label("at φ = φ_c +");
            let slider = ui
                .add(Slider::new(&mut degrees, -90.0..=90.0).suffix("°"))
                .labelled_by(label.id);
            if slider.changed() {
                session.view_mut().heatmap_phi = Some(home.phi + degrees.to_radians());
            }
            if ui.button("use φ of the pose").clicked() {
                session.view_mut().heatmap_phi = session.pose().map(|pose| pose.phi);
            }
        });
    }
}
