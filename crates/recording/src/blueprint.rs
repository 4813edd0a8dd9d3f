//! The layout with which the stock viewer opens a recording.
//!
//! The SDK's own blueprint types lack most view properties (time ranges, axes, legends), so the layout is written with
//! the archetypes on which they are built.

use rerun::blueprint::components::{BackgroundKind, ContainerKind, Corner2D, Eye3DKind, PanelState, PlayState};
use rerun::datatypes::{Range2D, TimeRange, TimeRangeBoundary, VisibleTimeRange};
use rerun::external::re_log_types::{BlueprintActivationCommand, SetStoreInfo, StoreInfo, StoreSource};
use rerun::external::re_sdk_types::blueprint::archetypes as parts;
use rerun::external::uuid::Uuid;
use rerun::log::{Chunk, ChunkError, LogMsg, RowId};
use rerun::{AsComponents, EntityPath, RecordingStream, StoreId, StoreKind, TimePoint, Timeline};

use super::legend::legend_bounds;
use super::motion::curve_path;
use super::{APPLICATION_ID, Viewpoint, paths, price_curves, timelines};
use kinefront_model::evaluation::PoseScalar;
use kinefront_model::mechanism::{Architecture, JointKind};
use kinefront_scene::{Field, MotionCurve};

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
    let scatter = layout.view("2D", plot, paths::SCATTER, &["+ $origin/**"])?;
    layout.property(&scatter, "VisualBounds2D", &parts::VisualBounds2D::new(scatter_bounds))?;
    // Of the front and the axes the latest state is drawn; of the designs the whole history.
    for cloud in clouds {
        let place = parts::ViewContents::blueprint_base_visualizer_path_for_entity(scatter.id, &cloud.as_str().into());
        layout.log(place, &up_to_now())?;
    }
    let hypervolume = layout.curve(hypervolume, paths::HYPERVOLUME, "+ $origin")?;
    let feasible = layout.curve("Feasible fraction", paths::FEASIBLE_SHARE, "+ $origin")?;
    let size = layout.curve("Designs on the front", paths::FRONT_SIZE, "+ $origin")?;
    let along = layout.curve("Along the front", paths::ALONG_FRONT, "+ $origin/**")?;
    layout.legend(&along)?;
    let card = layout.text("Design", paths::CARD)?;
    let summary = layout.text("Result", paths::SUMMARY)?;
    let study = layout.text("Study", paths::STUDY)?;
    let table = layout.view("Dataframe", "Designs", paths::DESIGNS, &["+ $origin"])?;
    let query = parts::DataframeQuery::new()
        .with_timeline(timelines::EVALUATION)
        .with_apply_latest_at(false);
    layout.property(&table, "DataframeQuery", &query)?;
    let manipulator = layout.space("Manipulator", paths::DESIGN, &["+ $origin/**"], base_radius)?;
    let manipulator = layout.beside_legend(manipulator, "Manipulator", Field::DEXTERITY)?;
    let configuration = layout.configuration(base_radius)?;

    let curves = layout.container(ContainerKind::Tabs, &[hypervolume, feasible, size], &[])?;
    // The two have their data on different timelines; side by side, one of them has data on whichever is selected.
    let curves = layout.container(ContainerKind::Horizontal, &[curves, along], &[1.0, 1.0])?;
    let left = layout.container(ContainerKind::Vertical, &[scatter, curves], &[2.2, 1.0])?;
    let middle = layout.container(ContainerKind::Vertical, &[manipulator, configuration], &[1.7, 1.0])?;
    let right = layout.container(ContainerKind::Tabs, &[card, summary, study, table], &[])?;
    let root = layout.container(ContainerKind::Horizontal, &[left, middle, right], &[1.15, 1.25, 0.8])?;
    layout.finish(&root, timelines::GENERATION, PlayState::Following)?;
    layout.send(recording);
    Ok(())
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
    let boxes = layout.view(
        "3D",
        "Boxes of the proof (x, y, φ)",
        paths::CONFIGURATION,
        &contents.each_ref().map(String::as_str),
    )?;
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
    layout.finish(&root, timeline, PlayState::Paused)?;
    layout.send(recording);
    Ok(())
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
            let path = price_curves::view_path(architecture, view);
            let view = layout.curve(title, &path, "+ $origin/**")?;
            layout.legend(&view)?;
            views.push(view);
        }
        let views = layout.container(ContainerKind::Vertical, &views, &[1.0, 1.0])?;
        fronts.push(layout.named(views, architecture.name())?);
    }
    let fronts = layout.container(ContainerKind::Tabs, &fronts, &[])?;
    let manipulator = layout.space("Manipulator", paths::DESIGN, &["+ $origin/**"], extent)?;
    let manipulator = layout.beside_legend(manipulator, "Manipulator", Field::DEXTERITY)?;
    let summary = layout.text("What drives the front", paths::SUMMARY)?;
    let card = layout.text("Design", paths::CARD)?;
    let right = layout.container(ContainerKind::Vertical, &[summary, card], &[0.6, 1.0])?;
    let root = layout.container(
        ContainerKind::Horizontal,
        &[fronts, manipulator, right],
        &[1.2, 1.2, 0.8],
    )?;
    layout.finish(&root, timelines::FRONT, PlayState::Paused)?;
    layout.send(recording);
    Ok(())
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
    let scatter = layout.view("2D", "Front", paths::SCATTER, &["+ $origin/**"])?;
    layout.property(&scatter, "VisualBounds2D", &parts::VisualBounds2D::new(scatter_bounds))?;
    let pins = layout.view("3D", "Pinned designs", paths::PINS, &["+ $origin/**"])?;
    layout.eye(&pins, [0.0, -1.4, 3.2], [0.0, -0.1, 0.0], comparing.unwrap_or(extent))?;
    let tabs = match comparing {
        Some(_) => [pins, manipulator, configuration, scatter],
        None => [manipulator, configuration, pins, scatter],
    };
    let root = layout.container(ContainerKind::Tabs, &tabs, &[])?;
    layout.finish(&root, timelines::EVALUATION, PlayState::Paused)?;
    layout.send(recording);
    Ok(())
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

struct ViewLayout {
    id: StoreId,
    messages: Vec<LogMsg>,
    at: TimePoint,
    /// Whether 3-D views have a light background.
    light: bool,
}

/// A view or container of the layout.
#[derive(Clone)]
struct Node {
    id: Uuid,
    path: String,
}

impl ViewLayout {
    fn new() -> Self {
        // Each layout has a unique id, because viewers merge layouts with the same id.
        let id = StoreId::new(
            StoreKind::Blueprint,
            APPLICATION_ID,
            format!("layout-{}", Uuid::new_v4()),
        );
        let info = StoreInfo::new(id.clone(), StoreSource::Other(APPLICATION_ID.to_owned()));
        Self {
            messages: vec![
                SetStoreInfo {
                    row_id: *RowId::new(),
                    info,
                }
                .into(),
            ],
            id,
            at: TimePoint::default().with(Timeline::new_sequence("blueprint"), 0_i64),
            light: false,
        }
    }

    fn log(&mut self, path: impl Into<EntityPath>, part: &dyn AsComponents) -> Result<(), ChunkError> {
        let chunk = Chunk::builder(path)
            .with_archetype(RowId::new(), self.at.clone(), part)
            .build()?;
        self.messages
            .push(LogMsg::ArrowMsg(self.id.clone(), chunk.to_arrow_msg()?));
        Ok(())
    }

    fn node(kind: &str) -> Node {
        let id = Uuid::new_v4();
        Node {
            id,
            path: format!("{kind}/{id}"),
        }
    }

    fn view(&mut self, class: &str, name: &str, origin: &str, contents: &[&str]) -> Result<Node, ChunkError> {
        let node = Self::node("view");
        self.log(
            format!("{}/ViewContents", node.path),
            &parts::ViewContents::new(contents.iter().copied()),
        )?;
        let view = parts::ViewBlueprint::new(class)
            .with_display_name(name)
            .with_space_origin(origin);
        self.log(node.path.clone(), &view)?;
        Ok(node)
    }

    fn curve(&mut self, name: &str, origin: &str, contents: &str) -> Result<Node, ChunkError> {
        let node = self.view("TimeSeries", name, origin, &[contents])?;
        self.property(&node, "PlotLegend", &parts::PlotLegend::new().with_visible(false))?;
        Ok(node)
    }

    /// Shows the legend of a time-series view.
    fn legend(&mut self, view: &Node) -> Result<(), ChunkError> {
        let legend = parts::PlotLegend::new()
            .with_visible(true)
            .with_corner(Corner2D::LeftTop);
        self.property(view, "PlotLegend", &legend)
    }

    /// Places the legend of a field beside the view of its heatmap.
    fn beside_legend(&mut self, map: Node, title: &str, field: Field) -> Result<Node, ChunkError> {
        let contents = format!("+ $origin/{}/**", field.key());
        let legend = self.view("2D", &field.title(), paths::HEATMAP_LEGEND, &[&contents])?;
        self.property(&legend, "VisualBounds2D", &parts::VisualBounds2D::new(legend_bounds()))?;
        let together = self.container(ContainerKind::Horizontal, &[map, legend], &[5.0, 1.0])?;
        self.named(together, title)
    }

    /// Gives a container a name, which its tab shows.
    fn named(&mut self, container: Node, name: &str) -> Result<Node, ChunkError> {
        let update = parts::ContainerBlueprint::update_fields().with_display_name(name);
        self.log(container.path.clone(), &update)?;
        Ok(container)
    }

    /// Adds a view of the manipulator, seen from the front and above.
    fn space(&mut self, name: &str, origin: &str, contents: &[&str], base_radius: f64) -> Result<Node, ChunkError> {
        let node = self.view("3D", name, origin, contents)?;
        self.eye(&node, [0.0, -0.95, 2.25], [0.0, -0.06, 0.0], base_radius)?;
        Ok(node)
    }

    /// Adds the maps of some fields as tabs, with the proof of the workspace in front of them if none is first.
    fn maps(&mut self, extent: f64, fields: &[Field], first: Option<Field>) -> Result<Node, ChunkError> {
        let mut maps = Vec::new();
        let others = fields.iter().copied().filter(|&field| Some(field) != first);
        for field in first.into_iter().chain(others) {
            let key = field.key();
            let mut contents = vec![
                format!("+ {}/**", paths::MANIPULATOR),
                format!("+ {}/**", paths::WORKSPACE),
                format!("+ {}/{key}/**", paths::HEATMAP),
                format!("+ {}/**", paths::LIMITS),
                format!("+ {}/**", paths::PATH),
            ];
            // The heatmaps of in-plane stiffness and displacement also show the ellipsoids of that quantity.
            match field {
                Field::Scalar(PoseScalar::StiffnessXy) => {
                    contents.push(format!("+ {}/stiffness/**", paths::ELLIPSOIDS))
                }
                Field::Scalar(PoseScalar::Displacement) => {
                    contents.push(format!("+ {}/displacement/**", paths::ELLIPSOIDS))
                }
                _ => {}
            }
            let contents: Vec<&str> = contents.iter().map(String::as_str).collect();
            let title = field.title();
            let title = title.split(" [").next().unwrap_or(key);
            let map = self.space(title, paths::DESIGN, &contents, extent)?;
            maps.push(self.beside_legend(map, title, field)?);
        }
        let contents = [paths::PROOF, paths::WORKSPACE, &format!("{}/base", paths::MANIPULATOR)];
        let contents = contents.map(|path| format!("+ {path}/**"));
        let proof = self.view(
            "3D",
            "proof of the workspace",
            paths::DESIGN,
            &contents.each_ref().map(String::as_str),
        )?;
        self.eye(&proof, [0.0, -0.7, 1.9], [0.0, -0.05, 0.0], extent)?;
        maps.insert(if first.is_none() { 0 } else { maps.len() }, proof);
        self.container(ContainerKind::Tabs, &maps, &[])
    }

    /// Adds the curves of a motion as tabs, those of the forces in front.
    fn motion_curves(&mut self) -> Result<Node, ChunkError> {
        let others = MotionCurve::ALL
            .into_iter()
            .filter(|curve| *curve != MotionCurve::Force);
        let mut curves = Vec::new();
        for curve in std::iter::once(MotionCurve::Force).chain(others) {
            let name = curve.name(JointKind::Prismatic);
            let view = self.curve(name, &curve_path(curve), "+ $origin/**")?;
            self.legend(&view)?;
            curves.push(view);
        }
        self.container(ContainerKind::Tabs, &curves, &[])
    }

    /// Adds a view of the configuration space, seen from the side.
    fn configuration(&mut self, base_radius: f64) -> Result<Node, ChunkError> {
        let node = self.view(
            "3D",
            "Configuration space (x, y, φ)",
            paths::CONFIGURATION,
            &["+ $origin/**"],
        )?;
        self.eye(&node, [-1.15, -2.3, 1.1], [-0.05, 0.0, -0.08], base_radius)?;
        Ok(node)
    }

    /// Sets up a 3-D view: eye and target as multiples of `R`, without a grid.
    fn eye(&mut self, view: &Node, eye: [f64; 3], target: [f64; 3], base_radius: f64) -> Result<(), ChunkError> {
        let place = |p: [f64; 3]| p.map(|coordinate| (coordinate * base_radius) as f32);
        let controls = parts::EyeControls3D::new()
            .with_kind(Eye3DKind::Orbital)
            .with_position(place(eye))
            .with_look_target(place(target))
            .with_eye_up([0.0_f32, 0.0, 1.0]);
        self.property(view, "EyeControls3D", &controls)?;
        let color: [u8; 3] = if self.light { [236, 238, 241] } else { [17, 19, 24] };
        let background = parts::Background::new(BackgroundKind::SolidColor).with_color(color);
        self.property(view, "Background", &background)?;
        self.property(view, "LineGrid3D", &parts::LineGrid3D::new().with_visible(false))
    }

    fn text(&mut self, name: &str, entity: &str) -> Result<Node, ChunkError> {
        self.view("TextDocument", name, entity, &["+ $origin"])
    }

    /// Sets a property of a view; `name` is the name of the archetype.
    fn property(&mut self, view: &Node, name: &str, part: &dyn AsComponents) -> Result<(), ChunkError> {
        self.log(format!("{}/{name}", view.path), part)
    }

    fn container(&mut self, kind: ContainerKind, children: &[Node], shares: &[f32]) -> Result<Node, ChunkError> {
        let node = Self::node("container");
        let mut container =
            parts::ContainerBlueprint::new(kind).with_contents(children.iter().map(|child| child.path.as_str()));
        container = match kind {
            ContainerKind::Horizontal => container.with_col_shares(shares.iter().copied()),
            ContainerKind::Vertical => container.with_row_shares(shares.iter().copied()),
            ContainerKind::Tabs | ContainerKind::Grid => match children.first() {
                Some(first) => container.with_active_tab(first.path.as_str()),
                None => container,
            },
        };
        self.log(node.path.clone(), &container)?;
        Ok(node)
    }

    fn finish(&mut self, root: &Node, timeline: &'static str, play: PlayState) -> Result<(), ChunkError> {
        let viewport = parts::ViewportBlueprint::new()
            .with_root_container(root.id)
            .with_auto_layout(false)
            .with_auto_views(false);
        self.log("viewport", &viewport)?;
        let time = parts::TimePanelBlueprint::new()
            .with_state(PanelState::Collapsed)
            .with_timeline(timeline)
            .with_play_state(play)
            .with_fps(20.0);
        self.log("time_panel", &time)?;
        for panel in ["selection_panel", "blueprint_panel"] {
            self.log(panel, &parts::PanelBlueprint::new().with_state(PanelState::Collapsed))?;
        }
        Ok(())
    }

    fn send(self, recording: &RecordingStream) {
        recording.send_blueprint(self.messages, BlueprintActivationCommand::make_active(self.id));
    }
}
