//! A design with what it was evaluated to, and where its parts are drawn.

use glam::{DVec2, DVec3};

use super::colors::ColorMap;
use super::draw::Canvas;
use super::paths;
use super::writer::RecordingError;
use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::mechanism::Design;
use crate::scene::{ConfigurationSpace, Field, Heatmap, HeatmapSettings, SolidShape, manipulator, regular_workspace};
use kinefront_model::spatial::Pose;

/// Orientations of the layers from home \[deg\].
const LAYERS_DEG: [f64; 5] = [-60.0, -30.0, 0.0, 30.0, 60.0];

/// Top of the regular workspace on the manipulator, as a share of the depth of the heatmap: a flat disc, whose height
/// means nothing there.
const DISC: f64 = 0.8;

/// Either side of home that the configuration space shows \[deg\].
const SPAN_DEG: f64 = 75.0;

/// A design with what it was evaluated to.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub(super) model: &'a Model,
    pub(super) evaluation: &'a Evaluation,
}

impl Subject<'_> {
    pub(super) fn design(&self) -> &Design {
        &self.evaluation.design
    }

    pub(super) fn home(&self) -> Pose {
        self.model.home(self.evaluation)
    }

    /// Height of the heatmaps: below every body of the manipulator.
    pub(super) fn floor(&self) -> f64 {
        let lowest = manipulator(self.model, self.design(), &self.home()).map_or(0.0, |scene| {
            scene
                .solids
                .iter()
                .map(|solid| match solid.shape {
                    SolidShape::Bar { from, to, radius } => {
                        // A pin ends at its faces, a bar along the plane at its radius.
                        if from.z == to.z {
                            from.z - radius
                        } else {
                            from.z.min(to.z)
                        }
                    }
                    SolidShape::Block { centre, half_size, .. } => centre.z - half_size.z,
                })
                .fold(0.0, f64::min)
        });
        1.15 * lowest - 0.01 * self.design().base_radius
    }

    /// What the view must hold: the base, and most of what the legs sweep \[m\].
    pub(super) fn extent(&self, poses: &[Pose]) -> f64 {
        const MOST: f64 = 0.8;
        let swept = poses
            .iter()
            .filter_map(|pose| manipulator(self.model, self.design(), pose).ok())
            .flat_map(|scene| scene.solids)
            .map(|solid| match solid.shape {
                SolidShape::Bar { from, to, .. } => from.truncate().length().max(to.truncate().length()),
                SolidShape::Block { centre, .. } => centre.truncate().length(),
            })
            .fold(0.0, f64::max);
        self.design().base_radius.max(MOST * swept)
    }

    /// Where notes stand: before the base and the workspace.
    pub(super) fn note(&self) -> DVec3 {
        let front = (0.95 * self.design().base_radius).max(1.3 * self.evaluation.workspace_radius);
        DVec3::new(0.0, -front, 0.0)
    }

    pub(super) fn space(&self) -> ConfigurationSpace {
        ConfigurationSpace::new(self.home().phi, self.design().base_radius)
    }

    pub(super) fn map(&self, heatmap: &Heatmap) -> Option<(ColorMap, f64)> {
        let threshold = heatmap.field.threshold(self.model);
        Some((
            ColorMap::new(heatmap.field.scale(), heatmap.range()?, threshold),
            threshold,
        ))
    }

    /// A heatmap below the manipulator and its legend beside it.
    pub(super) fn heatmap(&self, canvas: &Canvas<'_>, heatmap: &Heatmap, z: f64) -> Result<(), RecordingError> {
        let Some((map, threshold)) = self.map(heatmap) else {
            return Ok(());
        };
        let key = heatmap.field.key();
        canvas.heatmap(&format!("{}/{key}", paths::HEATMAP), heatmap, &map, &|p: DVec2| {
            p.extend(z)
        })?;
        let right = heatmap
            .vertices
            .iter()
            .map(|p| p.x)
            .fold(0.9 * self.design().base_radius, f64::max);
        let size = self.design().base_radius;
        let corner = DVec3::new(right + 0.55 * size, -0.5 * size, z);
        let legend = format!("{}/{key}", paths::HEATMAP_LEGEND);
        canvas.legend(
            &legend,
            heatmap.field,
            threshold,
            &map,
            corner,
            DVec2::new(0.08, 1.2) * size,
        )
    }

    /// The regular workspace on the manipulator, and what stops it from growing.
    pub(super) fn workspace(&self, canvas: &Canvas<'_>) -> Result<(), RecordingError> {
        let Some(cylinder) = regular_workspace(self.evaluation, self.model.workspace.rotation_range_deg) else {
            return Ok(());
        };
        let floor = self.floor();
        let label = format!("R_w = {:.4} m", cylinder.radius);
        // A hair above the heatmap, so that the line is seen.
        canvas.cylinder(paths::WORKSPACE, &cylinder, [0.97 * floor, DISC * floor], &label)?;
        let away = self.design().base_radius.max(1.3 * cylinder.radius);
        canvas.limits(paths::LIMITS, self.evaluation, DISC * floor, away)
    }

    /// The regular workspace on the manipulator alone, below `root`.
    pub(super) fn disc(&self, canvas: &Canvas<'_>, root: &str) -> Result<(), RecordingError> {
        let Some(cylinder) = regular_workspace(self.evaluation, self.model.workspace.rotation_range_deg) else {
            return Ok(());
        };
        let floor = self.floor();
        canvas.cylinder(root, &cylinder, [0.97 * floor, DISC * floor], "")
    }

    /// Axes and cylinder of the configuration space.
    pub(super) fn configuration(&self, canvas: &Canvas<'_>) -> Result<(), RecordingError> {
        let space = self.space();
        let root = |name: &str| format!("{}/{name}", paths::CONFIGURATION);
        let extent = self.design().base_radius;
        canvas.configuration_axes(&root("axes"), &space, 0.8 * extent, SPAN_DEG.to_radians())?;
        let Some(cylinder) = regular_workspace(self.evaluation, self.model.workspace.rotation_range_deg) else {
            return Ok(());
        };
        let height = |turn: f64| space.place(DVec2::ZERO, cylinder.phi + turn).z;
        let half = 0.5 * cylinder.phi_range;
        let label = format!("Δφ = {}°", self.model.workspace.rotation_range_deg);
        canvas.cylinder(&root("cylinder"), &cylinder, [height(-half), height(half)], &label)
    }

    /// The inverse condition number stacked over φ: its heatmaps, or only their outlines.
    pub(super) fn layers(
        &self,
        canvas: &Canvas<'_>,
        settings: HeatmapSettings,
        filled: bool,
    ) -> Result<(), RecordingError> {
        let space = self.space();
        let field = Field::InverseCondition;
        // One map for all layers: the field's own range.
        let map = ColorMap::new(field.scale(), [0.0, 1.0], field.threshold(self.model));
        for (index, turn) in LAYERS_DEG.into_iter().enumerate() {
            let phi = space.origin + turn.to_radians();
            let heatmap =
                Heatmap::new(self.model, self.design(), field, phi, settings).map_err(RecordingError::encode)?;
            let root = format!("{}/layers/{index}", paths::CONFIGURATION);
            let place = |p: DVec2| space.place(p, phi);
            if filled {
                canvas.heatmap(&root, &heatmap, &map, &place)?;
            } else {
                canvas.outlines(&root, &heatmap, &place)?;
            }
        }
        Ok(())
    }
}
