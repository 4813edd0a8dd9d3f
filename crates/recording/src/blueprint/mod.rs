//! The layout with which the stock viewer opens a recording.
//!
//! The SDK's own blueprint types lack most view properties (time ranges, axes, legends), so the layout is written with
//! the archetypes on which they are built.

mod views;

use rerun::RecordingStream;
use rerun::blueprint::components::{ContainerKind, PlayState};
use rerun::datatypes::{Range2D, TimeRange, TimeRangeBoundary, VisibleTimeRange};
use rerun::external::re_sdk_types::blueprint::archetypes as parts;
use rerun::log::ChunkError;

use self::views::ViewLayout;
use super::{Viewpoint, paths, price_curves, timelines};
use kinefront_model::mechanism::Architecture;
use kinefront_scene::Field;

/// Sends the layout of a run's recording; `clouds` are the entities whose rows together form the cloud of designs; `plot`
/// and `hypervolume` are names of views.
///
/// `base_radius` is the largest `R` of the study \[m\], which sets the scale of the 3-D views.
pub(super) fn send_run_layout(
    recording: &RecordingStream,
    clouds: &[String],
    [plot, hypervolume]: [&str; 2],
    scatter_bounds: Range2D,
    base_radius: f64,
) -> Result<(), ChunkError> {
    let mut layout = ViewLayout::new();
    let scatter = layout.plane(plot, paths::SCATTER, &["+ $origin/**"], scatter_bounds)?;
    // Of the front and the axes the latest state is drawn; of the designs the whole history.
    for cloud in clouds {
        let place = parts::ViewContents::blueprint_base_visualizer_path_for_entity(scatter.id, &cloud.as_str().into());
        layout.log(place, &up_to_now())?;
    }
    let hypervolume = layout.curve(hypervolume, paths::HYPERVOLUME, "+ $origin")?;
    let feasible = layout.curve("Feasible fraction", paths::FEASIBLE_SHARE, "+ $origin")?;
    let size = layout.curve("Designs on the front", paths::FRONT_SIZE, "+ $origin")?;
    let along = layout.curves("Along the front", paths::ALONG_FRONT)?;
    let card = layout.text("Design", paths::CARD)?;
    let summary = layout.text("Result", paths::SUMMARY)?;
    let study = layout.text("Study", paths::STUDY)?;
    let table = layout.view("Dataframe", "Designs", paths::DESIGNS, &["+ $origin"])?;
    let query = parts::DataframeQuery::new()
        .with_timeline(timelines::EVALUATION)
        .with_apply_latest_at(false);
    layout.property(&table, "DataframeQuery", &query)?;
    let manipulator = layout.map(Field::DEXTERITY, "Manipulator", &["+ $origin/**"], base_radius)?;
    let configuration = layout.configuration(base_radius)?;

    let curves = layout.container(ContainerKind::Tabs, &[hypervolume, feasible, size], &[])?;
    // The two have their data on different timelines; side by side, one of them has data on whichever is selected.
    let curves = layout.container(ContainerKind::Horizontal, &[curves, along], &[1.0, 1.0])?;
    let left = layout.container(ContainerKind::Vertical, &[scatter, curves], &[2.2, 1.0])?;
    let middle = layout.container(ContainerKind::Vertical, &[manipulator, configuration], &[1.7, 1.0])?;
    let right = layout.container(ContainerKind::Tabs, &[card, summary, study, table], &[])?;
    let root = layout.container(ContainerKind::Horizontal, &[left, middle, right], &[1.15, 1.25, 0.8])?;
    layout.send(recording, &root, timelines::GENERATION, PlayState::Following)
}

/// Sends the layout of the recording of one design that extends to the distance `extent` \[m\] from O.
///
/// `fields` have heatmaps, and `first` is the one that is in front; `None` brings the proof of the workspace to the front. A design that
/// follows a motion `moves`: its curves are below the maps, and time is that of the motion.
pub(super) fn send_design_layout(
    recording: &RecordingStream,
    extent: f64,
    fields: &[Field],
    first: Option<Field>,
    moves: bool,
) -> Result<(), ChunkError> {
    let mut layout = ViewLayout::new();
    let mut maps = layout.maps(extent, fields, first)?;
    if moves {
        let curves = layout.motion_curves()?;
        maps = layout.container(ContainerKind::Vertical, &[maps, curves], &[2.2, 1.0])?;
    }
    let space = layout.configuration(extent)?;
    let contents = ["axes", "cylinder", "proof"].map(|name| format!("+ {}/{name}/**", paths::CONFIGURATION));
    let boxes = layout.view("3D", "Boxes of the proof (x, y, φ)", paths::CONFIGURATION, &contents)?;
    layout.eye(&boxes, [-0.5, -1.2, 0.8], [0.0, 0.0, 0.0], extent)?;
    let spaces = if first.is_none() {
        [boxes, space]
    } else {
        [space, boxes]
    };
    let configuration = layout.container(ContainerKind::Tabs, &spaces, &[])?;
    let card = layout.text("Design", paths::CARD)?;
    let right = layout.container(ContainerKind::Vertical, &[configuration, card], &[0.8, 1.0])?;
    let root = layout.container(ContainerKind::Horizontal, &[maps, right], &[1.7, 1.0])?;
    let timeline = if moves { timelines::TIME } else { timelines::TOUR };
    layout.send(recording, &root, timeline, PlayState::Paused)
}

/// Sends the layout of the recording of prices along the fronts of some architectures, whose designs extend to the distance `extent` \[m\]
/// from O.
pub(super) fn send_prices_layout(
    recording: &RecordingStream,
    architectures: &[Architecture],
    extent: f64,
) -> Result<(), ChunkError> {
    let mut layout = ViewLayout::new();
    let mut fronts = Vec::new();
    for &architecture in architectures {
        let mut views = Vec::new();
        for (view, title, _) in price_curves::VIEWS {
            views.push(layout.curves(title, &price_curves::view_path(architecture, view))?);
        }
        let views = layout.container(ContainerKind::Vertical, &views, &[1.0, 1.0])?;
        fronts.push(layout.named(views, architecture.name())?);
    }
    let fronts = layout.container(ContainerKind::Tabs, &fronts, &[])?;
    let manipulator = layout.map(Field::DEXTERITY, "Manipulator", &["+ $origin/**"], extent)?;
    let summary = layout.text("What drives the front", paths::SUMMARY)?;
    let card = layout.text("Design", paths::CARD)?;
    let right = layout.container(ContainerKind::Vertical, &[summary, card], &[0.6, 1.0])?;
    let root = layout.container(
        ContainerKind::Horizontal,
        &[fronts, manipulator, right],
        &[1.2, 1.2, 0.8],
    )?;
    layout.send(recording, &root, timelines::FRONT, PlayState::Paused)
}

/// Sends the layout of a window's scene; `extent` \[m\] sets the scale of its 3-D views. If `comparing` is given, the
/// pinned designs are in front, and `comparing` \[m\] sets the scale of their view. The background is light if `light` is true, and the lines of
/// the ground grid are `grid_spacing` \[m\] apart.
pub(super) fn send_live_layout(
    recording: &RecordingStream,
    scatter_bounds: Range2D,
    extent: f64,
    comparing: Option<f64>,
    viewpoint: Viewpoint,
    light: bool,
    grid_spacing: f64,
) -> Result<(), ChunkError> {
    let mut layout = ViewLayout::new();
    layout.light = light;
    let manipulator = layout.view("3D", "Manipulator", paths::DESIGN, &["+ $origin/**"])?;
    let [eye, target] = viewpoint.eye_and_target();
    layout.eye(&manipulator, eye, target, extent)?;
    let gray: [u8; 4] = if light { [90, 96, 108, 70] } else { [150, 156, 168, 45] };
    let grid = parts::LineGrid3D::new()
        .with_visible(true)
        .with_spacing(grid_spacing as f32)
        .with_stroke_width(1.0)
        .with_color(gray);
    layout.property(&manipulator, "LineGrid3D", &grid)?;
    let configuration = layout.configuration(extent)?;
    let scatter = layout.plane("Front", paths::SCATTER, &["+ $origin/**"], scatter_bounds)?;
    let pins = layout.view("3D", "Pinned designs", paths::PINS, &["+ $origin/**"])?;
    layout.eye(&pins, [0.0, -1.4, 3.2], [0.0, -0.1, 0.0], comparing.unwrap_or(extent))?;
    let tabs = match comparing {
        Some(_) => [pins, manipulator, configuration, scatter],
        None => [manipulator, configuration, pins, scatter],
    };
    let root = layout.container(ContainerKind::Tabs, &tabs, &[])?;
    layout.send(recording, &root, timelines::EVALUATION, PlayState::Paused)
}

/// Returns the time range from the start to the time cursor, on either timeline.
fn up_to_now() -> parts::VisibleTimeRanges {
    parts::VisibleTimeRanges::new(
        [timelines::EVALUATION, timelines::GENERATION].map(|timeline| VisibleTimeRange {
            timeline: timeline.into(),
            range: TimeRange {
                start: TimeRangeBoundary::Infinite,
                end: TimeRangeBoundary::AT_CURSOR,
            },
        }),
    )
}
