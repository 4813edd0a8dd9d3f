//! A layout as it is made: its views, their properties, and the containers that hold them.

use rerun::blueprint::components::{BackgroundKind, ContainerKind, Corner2D, Eye3DKind, PanelState, PlayState};
use rerun::datatypes::Range2D;
use rerun::external::re_log_types::{BlueprintActivationCommand, SetStoreInfo, StoreInfo, StoreSource};
use rerun::external::re_sdk_types::blueprint::archetypes as parts;
use rerun::external::uuid::Uuid;
use rerun::log::{Chunk, ChunkError, LogMsg, RowId};
use rerun::{AsComponents, EntityPath, RecordingStream, StoreId, StoreKind, TimePoint, Timeline};

use crate::legend::legend_bounds;
use crate::motion::curve_path;
use crate::{APPLICATION_ID, paths};
use kinefront_model::evaluation::PoseScalar;
use kinefront_model::mechanism::JointKind;
use kinefront_scene::{Field, MotionCurve};

/// A layout that is being made.
pub(super) struct ViewLayout {
    id: StoreId,
    messages: Vec<LogMsg>,
    at: TimePoint,
    /// Whether 3-D views have a light background.
    pub(super) light: bool,
}

/// A view or container of the layout.
#[derive(Clone)]
pub(super) struct Node {
    pub(super) id: Uuid,
    path: String,
}

impl ViewLayout {
    pub(super) fn new() -> Self {
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

    pub(super) fn log(&mut self, path: impl Into<EntityPath>, part: &dyn AsComponents) -> Result<(), ChunkError> {
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

    pub(super) fn view(
        &mut self,
        class: &str,
        name: &str,
        origin: &str,
        contents: &[impl AsRef<str>],
    ) -> Result<Node, ChunkError> {
        let node = Self::node("view");
        let contents = parts::ViewContents::new(contents.iter().map(AsRef::as_ref));
        self.property(&node, "ViewContents", &contents)?;
        let view = parts::ViewBlueprint::new(class)
            .with_display_name(name)
            .with_space_origin(origin);
        self.log(node.path.clone(), &view)?;
        Ok(node)
    }

    pub(super) fn curve(&mut self, name: &str, origin: &str, contents: &str) -> Result<Node, ChunkError> {
        let node = self.view("TimeSeries", name, origin, &[contents])?;
        self.property(&node, "PlotLegend", &parts::PlotLegend::new().with_visible(false))?;
        Ok(node)
    }

    /// Adds a view of the curves below an entity, with their legend.
    pub(super) fn curves(&mut self, name: &str, origin: &str) -> Result<Node, ChunkError> {
        let node = self.curve(name, origin, "+ $origin/**")?;
        let legend = parts::PlotLegend::new()
            .with_visible(true)
            .with_corner(Corner2D::LeftTop);
        self.property(&node, "PlotLegend", &legend)?;
        Ok(node)
    }

    /// Adds a flat view of some bounds.
    pub(super) fn plane(
        &mut self,
        name: &str,
        origin: &str,
        contents: &[impl AsRef<str>],
        bounds: Range2D,
    ) -> Result<Node, ChunkError> {
        let node = self.view("2D", name, origin, contents)?;
        self.property(&node, "VisualBounds2D", &parts::VisualBounds2D::new(bounds))?;
        Ok(node)
    }

    /// Adds a view of the manipulator with the heatmap of a field, seen from the front and above, and the legend of the field beside it.
    pub(super) fn map(
        &mut self,
        field: Field,
        title: &str,
        contents: &[impl AsRef<str>],
        base_radius: f64,
    ) -> Result<Node, ChunkError> {
        let map = self.view("3D", title, paths::DESIGN, contents)?;
        self.eye(&map, [0.0, -0.95, 2.25], [0.0, -0.06, 0.0], base_radius)?;
        let contents = format!("+ $origin/{}/**", field.key());
        let legend = self.plane(&field.title(), paths::HEATMAP_LEGEND, &[contents], legend_bounds())?;
        let together = self.container(ContainerKind::Horizontal, &[map, legend], &[5.0, 1.0])?;
        self.named(together, title)
    }

    /// Gives a container a name, which its tab shows.
    pub(super) fn named(&mut self, container: Node, name: &str) -> Result<Node, ChunkError> {
        let update = parts::ContainerBlueprint::update_fields().with_display_name(name);
        self.log(container.path.clone(), &update)?;
        Ok(container)
    }

    /// Adds the maps of some fields as tabs, with the proof of the workspace in front of them if none is first.
    pub(super) fn maps(&mut self, extent: f64, fields: &[Field], first: Option<Field>) -> Result<Node, ChunkError> {
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
            let ellipsoids = match field {
                Field::Scalar(PoseScalar::StiffnessXy) => Some("stiffness"),
                Field::Scalar(PoseScalar::Displacement) => Some("displacement"),
                _ => None,
            };
            contents.extend(ellipsoids.map(|kind| format!("+ {}/{kind}/**", paths::ELLIPSOIDS)));
            let title = field.title();
            let title = title.split(" [").next().unwrap_or(key);
            maps.push(self.map(field, title, &contents, extent)?);
        }
        let contents = [paths::PROOF, paths::WORKSPACE, &format!("{}/base", paths::MANIPULATOR)];
        let contents = contents.map(|path| format!("+ {path}/**"));
        let proof = self.view("3D", "proof of the workspace", paths::DESIGN, &contents)?;
        self.eye(&proof, [0.0, -0.7, 1.9], [0.0, -0.05, 0.0], extent)?;
        maps.insert(if first.is_none() { 0 } else { maps.len() }, proof);
        self.container(ContainerKind::Tabs, &maps, &[])
    }

    /// Adds the curves of a motion as tabs, those of the forces in front.
    pub(super) fn motion_curves(&mut self) -> Result<Node, ChunkError> {
        let others = MotionCurve::ALL
            .into_iter()
            .filter(|curve| *curve != MotionCurve::Force);
        let mut curves = Vec::new();
        for curve in std::iter::once(MotionCurve::Force).chain(others) {
            let name = curve.name(JointKind::Prismatic);
            curves.push(self.curves(name, &curve_path(curve))?);
        }
        self.container(ContainerKind::Tabs, &curves, &[])
    }

    /// Adds a view of the configuration space, seen from the side.
    pub(super) fn configuration(&mut self, base_radius: f64) -> Result<Node, ChunkError> {
        let name = "Configuration space (x, y, φ)";
        let node = self.view("3D", name, paths::CONFIGURATION, &["+ $origin/**"])?;
        self.eye(&node, [-1.15, -2.3, 1.1], [-0.05, 0.0, -0.08], base_radius)?;
        Ok(node)
    }

    /// Sets up a 3-D view: eye and target as multiples of `R`, without a grid.
    pub(super) fn eye(
        &mut self,
        view: &Node,
        eye: [f64; 3],
        target: [f64; 3],
        base_radius: f64,
    ) -> Result<(), ChunkError> {
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

    pub(super) fn text(&mut self, name: &str, entity: &str) -> Result<Node, ChunkError> {
        self.view("TextDocument", name, entity, &["+ $origin"])
    }

    /// Sets a property of a view; `name` is the name of the archetype.
    pub(super) fn property(&mut self, view: &Node, name: &str, part: &dyn AsComponents) -> Result<(), ChunkError> {
        self.log(format!("{}/{name}", view.path), part)
    }

    pub(super) fn container(
        &mut self,
        kind: ContainerKind,
        children: &[Node],
        shares: &[f32],
    ) -> Result<Node, ChunkError> {
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

    /// Completes the layout with its root and the timeline that it shows, and sends it.
    pub(super) fn send(
        mut self,
        recording: &RecordingStream,
        root: &Node,
        timeline: &'static str,
        play: PlayState,
    ) -> Result<(), ChunkError> {
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
        recording.send_blueprint(self.messages, BlueprintActivationCommand::make_active(self.id));
        Ok(())
    }
}
