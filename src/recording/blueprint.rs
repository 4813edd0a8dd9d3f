//! The layout that the stock viewer opens a recording with.
//!
//! The SDK's own blueprint types leave out most view properties (ranges in time, axes, legends), so the layout is
//! written with the archetypes they are made of.

use rerun::blueprint::components::{ContainerKind, Corner2D, PanelState, PlayState};
use rerun::datatypes::{TimeRange, TimeRangeBoundary, VisibleTimeRange};
use rerun::external::re_log_types::{BlueprintActivationCommand, SetStoreInfo, StoreInfo, StoreSource};
use rerun::external::re_sdk_types::blueprint::archetypes as parts;
use rerun::external::uuid::Uuid;
use rerun::log::{Chunk, ChunkError, LogMsg, RowId};
use rerun::{AsComponents, EntityPath, RecordingStream, StoreId, StoreKind, TimePoint, Timeline};

use super::{APPLICATION_ID, paths, timelines};

/// Sends the layout of a run's recording; `clouds` are the entities whose rows add up to the cloud of designs.
pub(super) fn send_run_layout(recording: &RecordingStream, clouds: &[String]) -> Result<(), ChunkError> {
    let mut layout = Layout::new();
    let scatter = layout.view("2D", "Pareto front", paths::SCATTER, &["+ $origin/**"])?;
    // The front and the axes are states, of which the latest is drawn; the designs are a history.
    for cloud in clouds {
        let place = parts::ViewContents::blueprint_base_visualizer_path_for_entity(scatter.id, &cloud.as_str().into());
        layout.log(place, &up_to_now())?;
    }
    let hypervolume = layout.curve("Hypervolume [kg·m]", paths::HYPERVOLUME)?;
    let feasible = layout.curve("Feasible share", paths::FEASIBLE_SHARE)?;
    let size = layout.curve("Designs on the front", paths::FRONT_SIZE)?;
    let summary = layout.text("Result", paths::SUMMARY)?;
    let study = layout.text("Study", paths::STUDY)?;
    let table = layout.view("Dataframe", "Designs", paths::DESIGNS, &["+ $origin"])?;
    let query = parts::DataframeQuery::new()
        .with_timeline(timelines::EVALUATION)
        .with_apply_latest_at(false);
    layout.property(&table, "DataframeQuery", &query)?;

    let curves = layout.container(ContainerKind::Horizontal, &[hypervolume, feasible, size], &[1.0; 3])?;
    let left = layout.container(ContainerKind::Vertical, &[scatter, curves], &[3.0, 1.0])?;
    let right = layout.container(ContainerKind::Tabs, &[summary, study, table], &[])?;
    let root = layout.container(ContainerKind::Horizontal, &[left, right], &[2.0, 1.0])?;
    layout.finish(&root)?;
    layout.send(recording);
    Ok(())
}

/// Everything from the start to the time cursor, on either timeline.
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

struct Layout {
    id: StoreId,
    messages: Vec<LogMsg>,
    at: TimePoint,
}

/// A view or container of the layout.
#[derive(Clone)]
struct Node {
    id: Uuid,
    path: String,
}

impl Layout {
    fn new() -> Self {
        // An id of its own: viewers merge layouts of one id.
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

    fn curve(&mut self, name: &str, entity: &str) -> Result<Node, ChunkError> {
        let node = self.view("TimeSeries", name, entity, &["+ $origin"])?;
        let legend = parts::PlotLegend::new()
            .with_visible(false)
            .with_corner(Corner2D::RightBottom);
        self.property(&node, "PlotLegend", &legend)?;
        Ok(node)
    }

    fn text(&mut self, name: &str, entity: &str) -> Result<Node, ChunkError> {
        self.view("TextDocument", name, entity, &["+ $origin"])
    }

    /// A property of a view; `name` is the archetype's.
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

    fn finish(&mut self, root: &Node) -> Result<(), ChunkError> {
        let viewport = parts::ViewportBlueprint::new()
            .with_root_container(root.id)
            .with_auto_layout(false)
            .with_auto_views(false);
        self.log("viewport", &viewport)?;
        let time = parts::TimePanelBlueprint::new()
            .with_state(PanelState::Collapsed)
            .with_timeline(timelines::GENERATION)
            .with_play_state(PlayState::Following)
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
