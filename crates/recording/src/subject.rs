//! A design with its evaluation, and the places at which its parts are drawn.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::draw::Canvas;
use super::legend::draw_legend;
use super::writer::RecordingError;
use super::{colors, paths};
use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::mechanism::Design;
use kinefront_model::spatial::Pose;
use kinefront_scene::text::number;
use kinefront_scene::{
    ColorMap, ConfigurationSpace, EllipsoidKind, EllipsoidSet, Field, FieldLegend, Heatmap, HeatmapSettings,
    MotionPath, RegularCylinder, SolidShape, WorkspaceProof, ellipsoids, manipulator, region_corners,
    regular_workspace,
};

/// Orientations of the layers, relative to the home orientation \[deg\].
const LAYERS_DEG: [f64; 5] = [-60.0, -30.0, 0.0, 30.0, 60.0];

/// Height of the top of the regular workspace drawn below the manipulator, as a fraction of the heatmap's depth. It is
/// drawn as a flat disc, because its height has no meaning there.
const DISC: f64 = 0.8;

/// The same of the path of a motion.
const PATH: f64 = 0.7;

/// Range of orientations shown in the configuration space on either side of the home orientation \[deg\].
const SPAN_DEG: f64 = 75.0;

/// A design with its evaluation and the model.
#[derive(Clone, Copy)]
pub(super) struct DrawnDesign<'a> {
    pub(super) model: &'a Model,
    pub(super) evaluation: &'a Evaluation,
}

impl DrawnDesign<'_> {
    pub(super) fn design(&self) -> &Design {
        &self.evaluation.design
    }

    pub(super) fn home(&self) -> Pose {
        self.model.home(self.evaluation)
    }

    /// Returns the regular workspace, if there is one.
    pub(super) fn cylinder(&self) -> Option<RegularCylinder> {
        regular_workspace(self.evaluation, self.model.settings().workspace.rotation_range_deg)
    }

    /// Returns the height of the heatmaps, below every solid of the manipulator \[m\].
    pub(super) fn floor(&self) -> f64 {
        let lowest = manipulator(self.model, self.design(), &self.home()).map_or(0.0, |scene| {
            scene
                .solids
                .iter()
                .map(|solid| match solid.shape {
                    SolidShape::Bar { from, to, radius, .. } => {
                        // A pin extends down to its lower face, a bar in the plane down by its radius.
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
        1.15 * lowest - 0.01 * self.design().base_radius()
    }

    /// Returns the radius that the view must contain \[m\]: that of the base, and most of the radius that the members
    /// reach over `poses`.
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
        self.design().base_radius().max(MOST * swept)
    }

    /// Returns the position of notes, in front of the base and the workspace.
    fn note(&self) -> DVec3 {
        let front = (0.95 * self.design().base_radius()).max(1.3 * self.evaluation.workspace_radius());
        DVec3::new(0.0, -front, 0.0)
    }

    /// Draws a wrench on the platform at a pose: an arrow for its force and one for its moment, whose lengths tell nothing.
    pub(super) fn wrench(&self, canvas: &Canvas<'_>, pose: &Pose, wrench: [f64; 6]) -> Result<(), RecordingError> {
        let [fx, fy, fz, mx, my, mz] = wrench;
        // Above the bars, so that arrows in the plane are seen.
        let lift = 0.08 * self.design().base_radius();
        let at = pose.position.extend(lift);
        for (name, vector, unit, color) in [
            ("force", DVec3::new(fx, fy, fz), "N", colors::FORCE),
            ("moment", DVec3::new(mx, my, mz), "N·m", colors::MOMENT),
        ] {
            let size = vector.length();
            if size > 0.0 {
                let arrow = vector * (0.45 * self.design().base_radius() / size);
                let text = format!("{} {unit}", number(size));
                canvas.arrow(&format!("{}/{name}", paths::WRENCH), at, arrow, &text, color)?;
            }
        }
        Ok(())
    }

    pub(super) fn space(&self) -> ConfigurationSpace {
        ConfigurationSpace::new(self.home().phi, self.design().base_radius())
    }

    /// Draws a heatmap at height `z` below the manipulator, with colours over `range` or over its own values, and returns its legend;
    /// `None` if no position is reachable.
    pub(super) fn field(
        &self,
        canvas: &Canvas<'_>,
        heatmap: &Heatmap,
        range: Option<[f64; 2]>,
        z: f64,
    ) -> Result<Option<FieldLegend>, RecordingError> {
        let Some(range) = range.or(heatmap.range()) else {
            return Ok(None);
        };
        let field = heatmap.field;
        let threshold = field.threshold(self.model);
        let map = ColorMap::new(field.scale(), range, threshold);
        let root = format!("{}/{}", paths::HEATMAP, field.key());
        canvas.heatmap(&root, heatmap, &map, &|p: DVec2| p.extend(z))?;
        Ok(Some(FieldLegend { field, map, threshold }))
    }

    /// Draws a heatmap at height `z` below the manipulator, and its legend for a view of its own.
    pub(super) fn heatmap(&self, canvas: &Canvas<'_>, heatmap: &Heatmap, z: f64) -> Result<(), RecordingError> {
        let Some(legend) = self.field(canvas, heatmap, None, z)? else {
            return Ok(());
        };
        let root = format!("{}/{}", paths::HEATMAP_LEGEND, heatmap.field.key());
        draw_legend(canvas, &root, &legend)
    }

    /// Draws the regular workspace below the manipulator, and the poses that limit it.
    pub(super) fn workspace(&self, canvas: &Canvas<'_>) -> Result<(), RecordingError> {
        let Some(cylinder) = self.cylinder() else { return Ok(()) };
        let floor = self.floor();
        // Slightly above the heatmap, so that the line remains visible.
        let heights = [0.97 * floor, DISC * floor];
        let label = match region_corners(self.model) {
            Some(_) => "prescribed region".to_owned(),
            None => format!("R_w = {:.4} m", cylinder.radius),
        };
        self.outline(canvas, paths::WORKSPACE, &cylinder, heights, &label)?;
        let away = self.design().base_radius().max(1.3 * cylinder.radius);
        canvas.limits(paths::LIMITS, self.evaluation, DISC * floor, away)
    }

    /// Draws the proof of the workspace at the orientation `phi`.
    pub(super) fn proof(&self, canvas: &Canvas<'_>, proof: &WorkspaceProof, phi: f64) -> Result<(), RecordingError> {
        // Between the heatmap and the disc of the workspace, so that both remain visible.
        canvas.proof_at(paths::PROOF, proof, phi, 0.9 * self.floor())
    }

    /// Draws the proof of the workspace in the configuration space.
    pub(super) fn proof_in_space(&self, canvas: &Canvas<'_>, proof: &WorkspaceProof) -> Result<(), RecordingError> {
        canvas.proof_in_space(&format!("{}/proof", paths::CONFIGURATION), proof, &self.space())
    }

    /// Draws the manipulator at a pose, and its place in the configuration space. At a pose that it does not reach, nothing is drawn, so that
    /// a viewer keeps showing the pose before.
    pub(super) fn at_pose(&self, canvas: &Canvas<'_>, pose: &Pose) -> Result<(), RecordingError> {
        let Ok(scene) = manipulator(self.model, self.design(), pose) else {
            return Ok(());
        };
        canvas.manipulator(paths::MANIPULATOR, &scene)?;
        self.mark_pose(canvas, pose)
    }

    /// Marks a pose in the configuration space.
    pub(super) fn mark_pose(&self, canvas: &Canvas<'_>, pose: &Pose) -> Result<(), RecordingError> {
        let at = self.space().place(pose.position, pose.phi);
        canvas.mark(&format!("{}/pose", paths::CONFIGURATION), at, "P", colors::ELLIPSOID)
    }

    /// Draws ellipsoids of a kind, and returns them; `None` for a design without a regular workspace.
    pub(super) fn ellipsoids(
        &self,
        canvas: &Canvas<'_>,
        kind: EllipsoidKind,
    ) -> Result<Option<EllipsoidSet>, RecordingError> {
        let set = ellipsoids(self.model, self.evaluation, kind);
        if let Some(set) = &set {
            let root = format!("{}/{}", paths::ELLIPSOIDS, kind.key());
            canvas.ellipsoids(&root, set, 0.0, self.note())?;
        }
        Ok(set)
    }

    /// Draws the path of a motion, above the disc of the workspace.
    pub(super) fn path(&self, canvas: &Canvas<'_>, path: &MotionPath) -> Result<(), RecordingError> {
        let height = PATH * self.floor();
        canvas.path(paths::PATH, path, &|pose: &Pose| pose.position.extend(height))
    }

    /// Draws the path of a motion in the configuration space.
    pub(super) fn path_in_space(&self, canvas: &Canvas<'_>, path: &MotionPath) -> Result<(), RecordingError> {
        let space = self.space();
        canvas.path(&format!("{}/path", paths::CONFIGURATION), path, &|pose: &Pose| {
            space.place(pose.position, pose.phi)
        })
    }

    /// Draws only the regular workspace, at the entities below `root`.
    pub(super) fn disc(&self, canvas: &Canvas<'_>, root: &str) -> Result<(), RecordingError> {
        let Some(cylinder) = self.cylinder() else { return Ok(()) };
        let floor = self.floor();
        self.outline(canvas, root, &cylinder, [0.97 * floor, DISC * floor], "")
    }

    /// Draws the region of the workspace: the disc, or the polygon that the study prescribes.
    fn outline(
        &self,
        canvas: &Canvas<'_>,
        root: &str,
        cylinder: &RegularCylinder,
        heights: [f64; 2],
        label: &str,
    ) -> Result<(), RecordingError> {
        match region_corners(self.model) {
            Some(corners) => canvas.prism(root, &corners, heights, label),
            None => canvas.cylinder(root, cylinder, heights, label),
        }
    }

    /// Draws the axes and the regular workspace of the configuration space.
    pub(super) fn configuration(&self, canvas: &Canvas<'_>) -> Result<(), RecordingError> {
        let space = self.space();
        let root = |name: &str| format!("{}/{name}", paths::CONFIGURATION);
        let extent = self.design().base_radius();
        canvas.configuration_axes(&root("axes"), &space, 0.8 * extent, SPAN_DEG.to_radians())?;
        let Some(cylinder) = self.cylinder() else { return Ok(()) };
        let height = |turn: f64| space.place(DVec2::ZERO, cylinder.phi + turn).z;
        let half = 0.5 * cylinder.phi_range;
        let label = format!("Δφ = {}°", self.model.settings().workspace.rotation_range_deg);
        let heights = [height(-half), height(half)];
        if region_corners(self.model).is_none() {
            canvas.volume(&root("cylinder"), &cylinder, heights)?;
        }
        self.outline(canvas, &root("cylinder"), &cylinder, heights, &label)
    }

    /// Draws the inverse condition number as layers stacked over φ: its heatmaps, or only their outlines.
    pub(super) fn layers(
        &self,
        canvas: &Canvas<'_>,
        settings: HeatmapSettings,
        filled: bool,
    ) -> Result<(), RecordingError> {
        let space = self.space();
        let field = Field::DEXTERITY;
        // All layers share one colour map, over the full range of the inverse condition number.
        let map = ColorMap::new(field.scale(), [0.0, 1.0], field.threshold(self.model));
        // Each of them is small, so that they are computed side by side rather than each in parallel.
        let heatmap = |turn: f64| {
            let phi = space.origin + turn.to_radians();
            (phi, Heatmap::new(self.model, self.design(), field, phi, settings))
        };
        let heatmaps: Vec<(f64, Heatmap)> = LAYERS_DEG.into_par_iter().map(heatmap).collect();
        for (index, (phi, heatmap)) in heatmaps.into_iter().enumerate() {
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
