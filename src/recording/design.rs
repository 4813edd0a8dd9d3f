//! One design as entities: as a step of a run's front, or by itself with all overlays and its tour.

use std::path::Path;

use glam::{DVec2, DVec3};

use super::card::card;
use super::colors::ColorMap;
use super::draw::Canvas;
use super::writer::{ALWAYS, Moment, RecordingError, Writer};
use super::{blueprint, paths, timelines};
use crate::evaluation::{Evaluation, Model};
use crate::mechanism::Design;
use crate::scene::{
    ConfigurationSpace, EllipsoidKind, Field, Heatmap, HeatmapSettings, SolidShape, ellipsoids, manipulator,
    regular_workspace, tour,
};
use crate::spatial::Pose;
use crate::study::Study;

/// Cells along the longer side of a heatmap: of a design by itself, of a layer over φ, of a step of a front,
/// of an outline over φ.
const FINE: HeatmapSettings = HeatmapSettings { cells: 240 };
const LAYER: HeatmapSettings = HeatmapSettings { cells: 72 };
const STEP: HeatmapSettings = HeatmapSettings { cells: 64 };
const OUTLINE: HeatmapSettings = HeatmapSettings { cells: 32 };

/// Orientations of the layers from home \[deg\].
const LAYERS_DEG: [f64; 5] = [-60.0, -30.0, 0.0, 30.0, 60.0];

/// Top of the regular workspace on the manipulator, as a share of the depth of the heatmap: a flat disc, whose height
/// means nothing there.
const DISC: f64 = 0.8;

/// Either side of home that the configuration space shows \[deg\].
const SPAN_DEG: f64 = 75.0;

/// Poses around each rim of a tour.
const TOUR_STEPS: usize = 72;

/// Records one design with its overlays and its tour to a file of its own; `field` is the map in front.
///
/// # Errors
/// [`RecordingError::Write`] when the file exists or cannot be written; [`RecordingError::Encode`] otherwise.
pub fn record_design(
    path: &Path,
    study: &Study,
    evaluation: &Evaluation,
    heading: &str,
    field: Field,
) -> Result<(), RecordingError> {
    let model = &study.model();
    let writer = Writer::create(path, heading)?;
    let subject = Subject { model, evaluation };
    let cylinder = regular_workspace(evaluation, model.workspace.rotation_range_deg);
    let tour = cylinder.and_then(|cylinder| tour(model, &evaluation.design, &cylinder, TOUR_STEPS));
    let still = [subject.home()];
    let poses: &[Pose] = tour.as_ref().map_or(&still, |tour| &tour.poses);
    blueprint::send_design_layout(writer.stream(), subject.extent(poses), field)?;
    let canvas = Canvas {
        writer: &writer,
        moment: ALWAYS,
    };
    let floor = subject.floor();
    let home = subject.home();

    let mut sets = Vec::new();
    for (kind, name) in [
        (EllipsoidKind::Stiffness, "stiffness"),
        (EllipsoidKind::Displacement, "displacement"),
    ] {
        if let Some(set) = ellipsoids(model, evaluation, kind).map_err(RecordingError::encode)? {
            let entity = format!("{}/{name}", paths::ELLIPSOIDS);
            canvas.ellipsoids(&entity, &set, 0.0, subject.note())?;
            sets.push(set);
        }
    }
    for field in Field::ALL {
        let heatmap = Heatmap::new(model, &evaluation.design, field, home.phi, FINE).map_err(RecordingError::encode)?;
        subject.heatmap(&canvas, &heatmap, floor)?;
    }
    subject.workspace(&canvas)?;
    subject.configuration(&canvas)?;
    subject.layers(&canvas, LAYER, true)?;

    let space = subject.space();
    for (index, pose) in poses.iter().enumerate() {
        let moment = [(timelines::TOUR, index)];
        let canvas = Canvas {
            writer: &writer,
            moment: &moment,
        };
        // A pose that is not reached leaves the one before on screen; only an infeasible design has one.
        if let Ok(scene) = manipulator(model, &evaluation.design, pose) {
            canvas.manipulator(paths::MANIPULATOR, &scene)?;
            let at = space.place(pose.position, pose.phi);
            canvas.mark(
                &format!("{}/pose", paths::CONFIGURATION),
                at,
                "P",
                super::colors::ELLIPSOID,
            )?;
        }
    }
    writer.text(
        paths::CARD,
        ALWAYS,
        &card(heading, model, evaluation, &sets, tour.as_ref()),
    )?;
    writer.close()
}

/// Records one verified design of a front as a step: manipulator at home, workspace, heatmap of the inverse condition
/// number, stiffness ellipsoids, configuration space and card.
pub(super) fn record_step(
    writer: &Writer,
    moment: Moment<'_>,
    model: &Model,
    evaluation: &Evaluation,
    heading: &str,
) -> Result<(), RecordingError> {
    let subject = Subject { model, evaluation };
    let canvas = Canvas { writer, moment };
    let home = subject.home();
    if let Ok(scene) = manipulator(model, &evaluation.design, &home) {
        canvas.manipulator(paths::MANIPULATOR, &scene)?;
    }
    let heatmap = Heatmap::new(model, &evaluation.design, Field::InverseCondition, home.phi, STEP)
        .map_err(RecordingError::encode)?;
    subject.heatmap(&canvas, &heatmap, subject.floor())?;
    let set = ellipsoids(model, evaluation, EllipsoidKind::Stiffness).map_err(RecordingError::encode)?;
    if let Some(set) = &set {
        canvas.ellipsoids(&format!("{}/stiffness", paths::ELLIPSOIDS), set, 0.0, subject.note())?;
    }
    subject.workspace(&canvas)?;
    subject.configuration(&canvas)?;
    subject.layers(&canvas, OUTLINE, false)?;
    writer.text(
        paths::CARD,
        moment,
        &card(heading, model, evaluation, set.as_slice(), None),
    )
}

/// A design with what it was evaluated to.
struct Subject<'a> {
    model: &'a Model,
    evaluation: &'a Evaluation,
}

impl Subject<'_> {
    fn design(&self) -> &Design {
        &self.evaluation.design
    }

    /// Home, or for an infeasible design the pose that its constraints are reported at.
    fn home(&self) -> Pose {
        let reported = || self.evaluation.constraints.iter().find_map(|report| report.pose);
        let centre = self.model.workspace.centre;
        self.evaluation.home.or_else(reported).unwrap_or(Pose {
            position: centre,
            phi: 0.0,
        })
    }

    /// Height of the heatmaps: below every body of the manipulator.
    fn floor(&self) -> f64 {
        let lowest = manipulator(self.model, self.design(), &self.home()).map_or(0.0, |scene| {
            scene
                .solids
                .iter()
                .map(|solid| match solid.shape {
                    SolidShape::Bar { from, to, radius } => {
                        // A pin ends at its faces, a bar in the plane at its radius.
                        if from.z == to.z { -radius } else { from.z.min(to.z) }
                    }
                    SolidShape::Block { centre, half_size, .. } => centre.z - half_size.z,
                })
                .fold(0.0, f64::min)
        });
        1.15 * lowest - 0.01 * self.design().base_radius
    }

    /// What the view must hold: the base, and most of what the legs sweep \[m\].
    fn extent(&self, poses: &[Pose]) -> f64 {
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
    fn note(&self) -> DVec3 {
        let front = (0.95 * self.design().base_radius).max(1.3 * self.evaluation.workspace_radius);
        DVec3::new(0.0, -front, 0.0)
    }

    fn space(&self) -> ConfigurationSpace {
        ConfigurationSpace::new(self.home().phi, self.design().base_radius)
    }

    fn map(&self, heatmap: &Heatmap) -> Option<(ColorMap, f64)> {
        let threshold = heatmap.field.threshold(self.model);
        Some((
            ColorMap::new(heatmap.field.scale(), heatmap.range()?, threshold),
            threshold,
        ))
    }

    /// A heatmap below the manipulator and its legend beside it.
    fn heatmap(&self, canvas: &Canvas<'_>, heatmap: &Heatmap, z: f64) -> Result<(), RecordingError> {
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
    fn workspace(&self, canvas: &Canvas<'_>) -> Result<(), RecordingError> {
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

    /// Axes and cylinder of the configuration space.
    fn configuration(&self, canvas: &Canvas<'_>) -> Result<(), RecordingError> {
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
    fn layers(&self, canvas: &Canvas<'_>, settings: HeatmapSettings, filled: bool) -> Result<(), RecordingError> {
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
