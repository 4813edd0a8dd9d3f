//! Records one design: as a step of a run's front, or alone with all overlays and its tour.

use std::path::Path;

use super::card::card;
use super::draw::Canvas;
use super::subject::DrawnDesign;
use super::writer::{ALWAYS, Moment, RecordingError, RecordingWriter};
use super::{blueprint, motion, paths, timelines};
use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_model::spatial::Pose;
use kinefront_scene::{
    EllipsoidKind, EllipsoidSet, Field, Heatmap, HeatmapSettings, manipulator, tour, workspace_proof,
};
use kinefront_study::{CertifiedWorkspace, DesignProblem, Drivers, DriversOptions, PreparedStudy, Study, replace};

/// Number of cells along the longer side of a heatmap: of a single design, of a layer over φ, of a step of a front, and
/// of an outline over φ.
const FINE: HeatmapSettings = HeatmapSettings { cells: 240 };
const LAYER: HeatmapSettings = HeatmapSettings { cells: 72 };
const STEP: HeatmapSettings = HeatmapSettings { cells: 64 };
const OUTLINE: HeatmapSettings = HeatmapSettings { cells: 32 };

/// Number of poses around each rim of a tour.
const TOUR_STEPS: usize = 72;

/// Records one design with its overlays, its tour and the motion of the study to its own file; the tab with the heatmap of the field
/// `first` is in front, or that of the proof of its workspace.
///
/// # Errors
/// [`RecordingError::Write`] when the file exists or cannot be written; [`RecordingError::Encode`] otherwise.
pub fn record_design(
    path: &Path,
    study: &PreparedStudy,
    evaluation: &Evaluation,
    heading: &str,
    first: Option<Field>,
) -> Result<(), RecordingError> {
    write_new(path, |part| draw_design(part, study, evaluation, heading, first))
}

/// Writes a recording to a new file, which appears when it is complete.
pub(super) fn write_new(
    path: &Path,
    draw: impl FnOnce(&Path) -> Result<(), RecordingError>,
) -> Result<(), RecordingError> {
    if path.exists() {
        return Err(RecordingError::of_file(path)(std::io::ErrorKind::AlreadyExists.into()));
    }
    replace(path, draw).map_err(|error| match error {
        RecordingError::Write { cause, .. } => RecordingError::of_file(path)(cause),
        error => error,
    })
}

fn draw_design(
    path: &Path,
    study: &PreparedStudy,
    evaluation: &Evaluation,
    heading: &str,
    first: Option<Field>,
) -> Result<(), RecordingError> {
    let (study, model) = (study.study(), study.model());
    let writer = RecordingWriter::create(path, heading)?;
    let prove = || workspace_proof(model, evaluation, &|| true);
    let proof = study.workspace.certify.then(prove).flatten();
    let certified = proof
        .as_ref()
        .map(|proof| CertifiedWorkspace::new(&proof.certificate, &proof.claim));
    // What is drawn is the workspace that is proved.
    let mut evaluation = evaluation.clone();
    if let Some(certified) = certified.as_ref().filter(|certified| !certified.is_of_region) {
        evaluation.set_workspace_radius(certified.lower, &model.settings().objectives);
    }
    let evaluation = &evaluation;
    let subject = DrawnDesign { model, evaluation };
    let tour = subject
        .cylinder()
        .and_then(|cylinder| tour(model, &evaluation.design, &cylinder, TOUR_STEPS));
    let still = [subject.home()];
    let poses: &[Pose] = tour.as_ref().map_or(&still, |tour| &tour.poses);
    let fields: Vec<Field> = Field::of(model, &evaluation.design).collect();
    // A motion that ends early has no curves that stop in the middle.
    let followed = model.follow_task(evaluation);
    let samples = followed.and_then(|(outcome, samples)| outcome.figures().map(|_| samples));
    let extent = subject.extent(poses);
    blueprint::send_design_layout(writer.stream(), extent, &fields, first, samples.is_some())?;
    let canvas = Canvas::at(&writer, ALWAYS);
    let sets = draw_standing(&subject, &canvas, fields)?;
    if let Some(proof) = &proof {
        subject.proof(&canvas, proof, subject.home().phi)?;
        subject.proof_in_space(&canvas, proof)?;
    }

    for (index, pose) in poses.iter().enumerate() {
        let moment = [(timelines::TOUR, index)];
        subject.at_pose(&Canvas::at(&writer, &moment), pose)?;
    }
    if let Some(samples) = &samples {
        motion::record_motion(&writer, &subject, samples)?;
    }
    let drivers = drivers(study, evaluation);
    let (tour, certified, drivers) = (tour.as_ref(), certified.as_ref(), drivers.as_ref());
    let card = card(heading, model, evaluation, &sets, tour, certified, drivers);
    writer.text(paths::CARD, ALWAYS, &card)?;
    writer.close()
}

/// Draws what does not move: ellipsoids, heatmaps, workspace and layers. Returns the ellipsoids.
fn draw_standing(
    subject: &DrawnDesign<'_>,
    canvas: &Canvas<'_>,
    fields: Vec<Field>,
) -> Result<Vec<EllipsoidSet>, RecordingError> {
    let mut sets = Vec::new();
    for kind in EllipsoidKind::ALL {
        sets.extend(subject.ellipsoids(canvas, kind)?);
    }
    for field in fields {
        let heatmap = Heatmap::new(subject.model, subject.design(), field, subject.home().phi, FINE);
        subject.heatmap(canvas, &heatmap, subject.floor())?;
    }
    subject.workspace(canvas)?;
    subject.configuration(canvas)?;
    subject.layers(canvas, LAYER, true)?;
    Ok(sets)
}

/// Returns what drives the first objective of a design, if an optimum is found near it.
pub(super) fn drivers(study: &Study, evaluation: &Evaluation) -> Option<Drivers> {
    let local = DesignProblem::new(study).ok()?.local_of(evaluation, &[]).ok()?;
    local.drivers(DriversOptions::default()).ok()
}

/// Records one verified design of a front as a step: manipulator at the home pose, regular workspace, heatmap of the
/// inverse condition number, stiffness ellipsoids, configuration space and card.
pub(super) fn record_step(
    writer: &RecordingWriter,
    moment: Moment<'_>,
    model: &Model,
    evaluation: &Evaluation,
    certified: Option<&CertifiedWorkspace>,
    drivers: Option<&Drivers>,
    heading: &str,
) -> Result<(), RecordingError> {
    let subject = DrawnDesign { model, evaluation };
    let canvas = Canvas::at(writer, moment);
    let home = subject.home();
    if let Ok(scene) = manipulator(model, &evaluation.design, &home) {
        canvas.manipulator(paths::MANIPULATOR, &scene)?;
    }
    let heatmap = Heatmap::new(model, &evaluation.design, Field::DEXTERITY, home.phi, STEP);
    subject.heatmap(&canvas, &heatmap, subject.floor())?;
    let set = subject.ellipsoids(&canvas, EllipsoidKind::Stiffness)?;
    subject.workspace(&canvas)?;
    subject.configuration(&canvas)?;
    subject.layers(&canvas, OUTLINE, false)?;
    let card = card(heading, model, evaluation, set.as_slice(), None, certified, drivers);
    writer.text(paths::CARD, moment, &card)
}
