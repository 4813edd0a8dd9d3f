//! The design that a window shows: what is drawn of it, and how.

use glam::DVec2;

use crate::draw::Canvas;
use crate::paths;
use crate::subject::DrawnDesign;
use crate::writer::RecordingError;
use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::spatial::Pose;
use kinefront_scene::{
    BarStresses, EllipsoidKind, Field, FieldLegend, Heatmap, HeatmapSettings, MotionPath, Part, PathColor, Scene,
    StressLegend, WorkspaceProof, manipulator,
};

/// Number of cells along the longer side of a heatmap, and of an outline over φ.
const HEATMAP: HeatmapSettings = HeatmapSettings { cells: 96 };
const OUTLINE: HeatmapSettings = HeatmapSettings { cells: 32 };

/// The parts and overlays of a design that are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibleLayers {
    /// Rails, bars and joints of the legs.
    pub legs: bool,
    /// Bars of the platform.
    pub platform: bool,
    /// Bars coloured by their stresses at the pose instead of by their parts.
    pub stresses: bool,
    /// A wrench on the platform at `P`, forces \[N\] before moments \[N·m\], drawn as arrows. The stresses are those under it, instead of under
    /// the loads of the study.
    pub wrench: Option<[f64; 6]>,
    /// Names of joints and frames.
    pub labels: bool,
    /// The pair of members with the smallest clearance, with its distance.
    pub clearance: bool,
    /// The regular workspace, and the poses that limit it.
    pub workspace: bool,
    /// Parallel singularities and the edge of reach.
    pub singularities: bool,
    /// Boxes of the proof of the workspace, and the infeasible pose beyond it.
    pub proof: bool,
    /// Ellipsoids at points of the workspace.
    pub ellipsoids: Option<EllipsoidKind>,
    /// Field below the manipulator.
    pub heatmap: Option<Field>,
    /// A field whose colours stand for the same values in every design, and their range; other fields use the range of the design.
    pub locked: Option<(Field, [f64; 2])>,
    /// The workspace in (x, y, φ).
    pub configuration: bool,
    /// The path of a motion, and what its colours tell.
    pub path: Option<PathColor>,
}

impl Default for VisibleLayers {
    fn default() -> Self {
        Self {
            legs: true,
            platform: true,
            stresses: false,
            wrench: None,
            labels: true,
            clearance: true,
            workspace: true,
            singularities: true,
            proof: false,
            ellipsoids: None,
            heatmap: Some(Field::DEXTERITY),
            locked: None,
            configuration: true,
            path: Some(PathColor::FORCE),
        }
    }
}

/// A design to show, and how to show it.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// The model with which the design was evaluated.
    pub model: &'a Model,
    /// The evaluated design.
    pub evaluation: &'a Evaluation,
    /// The proof of its workspace, once it is known.
    pub proof: Option<&'a WorkspaceProof>,
    /// The path of the motion that the design follows.
    pub path: Option<&'a MotionPath>,
    /// Pose of the manipulator; the home pose if `None`.
    pub pose: Option<Pose>,
    /// Orientation of the heatmap \[rad\]; the home orientation if `None`.
    pub heatmap_phi: Option<f64>,
    /// The parts and overlays to draw.
    pub layers: &'a VisibleLayers,
    /// Whether the viewer has a light theme.
    pub light: bool,
}

/// Legends of what is drawn of a design; the window draws them beside the scene.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SceneLegends {
    /// That of the heatmap, if there is one.
    pub field: Option<FieldLegend>,
    /// That of the colours of the bars, if they tell stresses.
    pub stress: Option<StressLegend>,
}

/// Draws a design, and returns the legends.
pub(super) fn draw(canvas: &Canvas<'_>, shown: &Shown<'_>) -> Result<SceneLegends, RecordingError> {
    let mut legends = SceneLegends::default();
    let Shown {
        model,
        evaluation,
        layers,
        ..
    } = *shown;
    let subject = DrawnDesign { model, evaluation };
    let home = subject.home();
    let pose = shown.pose.unwrap_or(home);
    if let Ok(mut scene) = manipulator(model, &evaluation.design, &pose) {
        keep(&mut scene, layers);
        if layers.stresses
            && let Some(stresses) = BarStresses::new(model, &evaluation.design, &pose, layers.wrench)
        {
            scene.set_values(&stresses);
            legends.stress = Some(stresses.legend);
        }
        canvas.manipulator(paths::MANIPULATOR, &scene)?;
        if let Some(wrench) = layers.wrench {
            subject.wrench(canvas, &pose, wrench)?;
        }
    }
    if layers.heatmap.is_some() || layers.singularities {
        legends.field = draw_field(canvas, &subject, layers, shown.heatmap_phi.unwrap_or(home.phi))?;
    }
    if let Some(kind) = layers.ellipsoids {
        subject.ellipsoids(canvas, kind)?;
    }
    if layers.workspace {
        subject.workspace(canvas)?;
    }
    let proof = shown.proof.filter(|_| layers.proof);
    if let Some(proof) = proof {
        subject.proof(canvas, proof, shown.heatmap_phi.unwrap_or(home.phi))?;
    }
    let path = shown.path.filter(|_| layers.path.is_some());
    if let Some(path) = path {
        subject.path(canvas, path)?;
    }
    if layers.configuration {
        subject.configuration(canvas)?;
        subject.layers(canvas, OUTLINE, false)?;
        if let Some(proof) = proof {
            subject.proof_in_space(canvas, proof)?;
        }
        if let Some(path) = path {
            subject.path_in_space(canvas, path)?;
        }
        subject.mark_pose(canvas, &pose)?;
    }
    Ok(legends)
}

/// Draws the heatmap of a field in an orientation \[rad\], or the singularities alone, and returns the legend of the field.
fn draw_field(
    canvas: &Canvas<'_>,
    subject: &DrawnDesign<'_>,
    layers: &VisibleLayers,
    phi: f64,
) -> Result<Option<FieldLegend>, RecordingError> {
    let field = layers.heatmap.unwrap_or(Field::DEXTERITY);
    let mut heatmap = Heatmap::new(subject.model, &subject.evaluation.design, field, phi, HEATMAP);
    if !layers.singularities {
        heatmap.singular.clear();
        heatmap.edges.clear();
    }
    let floor = subject.floor();
    if layers.heatmap.is_some() {
        let locked = layers.locked.filter(|(locked, _)| *locked == field);
        let range = locked.map(|(_, range)| range);
        return subject.field(canvas, &heatmap, range, floor);
    }
    heatmap.threshold.clear();
    canvas.outlines(&format!("{}/outlines", paths::HEATMAP), &heatmap, &|p: DVec2| {
        p.extend(floor)
    })?;
    Ok(None)
}

/// Removes the parts that `layers` excludes.
pub(super) fn keep(scene: &mut Scene, layers: &VisibleLayers) {
    scene.solids.retain(|solid| match solid.part {
        Part::PlatformBar => layers.platform,
        _ => layers.legs,
    });
    scene.lines.retain(|line| match line.part {
        Part::Rail | Part::Stroke => layers.legs,
        _ => true,
    });
    if !layers.labels {
        scene.labels.clear();
    }
    if !layers.clearance {
        scene.nearest = None;
    }
}
