//! The scene of a window: one design at a pose, the pinned designs side by side, and the front, all updated in place.

mod shown;

use std::cell::RefCell;

use glam::DVec2;
use rerun::sink::LogSink;
use rerun::{Transform3D, Vec3D};

pub use self::shown::{SceneLegends, Shown, VisibleLayers};
use self::shown::{draw, keep};
use super::draw::Canvas;
use super::plot::Plot;
use super::point::{FrontPoint, PlotPoint};
use super::stage::{Rows, Stage};
use super::subject::DrawnDesign;
use super::viewpoint::Viewpoint;
use super::writer::{RecordingError, RecordingWriter};
use super::{SceneTarget, blueprint, colors, paths};
use kinefront_model::evaluation::{Evaluation, Model};
use kinefront_scene::{BentBar, manipulator};
use kinefront_study::Study;

/// Size for which the 3-D views are set up, as a multiple of `R`.
const VIEW: f64 = 1.0;

/// Distance between pinned designs, as a multiple of the largest `R` among them.
const PIN_DISTANCE: f64 = 2.1;

/// Width that the view of pinned designs shows, as a multiple of the size for which it is set up.
const PIN_VIEW: f64 = 3.1;

/// A design to compare with others.
#[derive(Debug, Clone, Copy)]
pub struct Pinned<'a> {
    /// The evaluated design.
    pub evaluation: &'a Evaluation,
    /// Name.
    pub name: &'a str,
}

/// What the user clicked in the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Picked {
    /// The design with this index in the front last shown.
    Front(usize),
    /// The pinned design with this index.
    Pin(usize),
    /// A position of the platform \[m\], on the heatmap.
    Position(DVec2),
}

/// The scene, as sent to a viewer.
pub struct LiveScene {
    writer: RecordingWriter,
    frame: Plot,
    /// Size for which the 3-D views are set up \[m\].
    extent: f64,
    /// Size for which the view of the pinned designs is set up \[m\].
    pins_extent: f64,
    comparing: bool,
    viewpoint: Viewpoint,
    /// Whether text is dark: the viewer draws it on a light background.
    light: bool,
    design: Stage,
    bent: Stage,
    pins: Stage,
    front: Stage,
}

impl LiveScene {
    /// Creates a scene that is sent to `sink`, with the layout for `study`.
    ///
    /// # Errors
    /// [`RecordingError::Encode`] when the layout cannot be encoded.
    pub fn new(sink: Box<dyn LogSink>, study: &Study) -> Result<Self, RecordingError> {
        let scene = Self {
            writer: RecordingWriter::sending(sink, "scene")?,
            frame: Plot::new(study),
            extent: VIEW * study.bounds.R_m[1],
            pins_extent: 1.0,
            comparing: false,
            viewpoint: Viewpoint::default(),
            light: false,
            design: Stage::default(),
            bent: Stage::default(),
            pins: Stage::default(),
            front: Stage::default(),
        };
        scene.layout()?;
        Ok(scene)
    }

    /// Switches to another study.
    ///
    /// # Errors
    /// [`RecordingError::Encode`] when the layout cannot be encoded.
    pub fn turn_to(&mut self, study: &Study) -> Result<(), RecordingError> {
        self.frame = Plot::new(study);
        self.extent = VIEW * study.bounds.R_m[1];
        self.layout()
    }

    /// Brings the view of the pinned designs to the front, or, if `comparing` is false, that of the selected design.
    ///
    /// # Errors
    /// [`RecordingError::Encode`] when the layout cannot be encoded.
    pub fn compare(&mut self, comparing: bool) -> Result<(), RecordingError> {
        self.comparing = comparing;
        self.layout()
    }

    fn layout(&self) -> Result<(), RecordingError> {
        let stream = self.writer.stream();
        let comparing = self.comparing.then_some(self.pins_extent);
        Ok(blueprint::send_live_layout(
            stream,
            Plot::bounds(),
            self.extent,
            comparing,
            self.viewpoint,
            self.light,
            self.grid_spacing(),
        )?)
    }

    /// Returns the distance between the lines of the ground grid \[m\]: 1, 2 or 5 times a power of ten.
    pub fn grid_spacing(&self) -> f64 {
        let wanted = 0.25 * self.extent.max(1e-6);
        let decade = libm::pow(10.0, libm::floor(libm::log10(wanted)));
        let steps = [5.0, 2.0, 1.0].map(|step| step * decade);
        steps.into_iter().find(|step| *step <= wanted).unwrap_or(decade)
    }

    /// Looks at the manipulator from another side, with the whole of it in view.
    ///
    /// # Errors
    /// [`RecordingError::Encode`] when the layout cannot be encoded.
    pub fn look_from(&mut self, viewpoint: Viewpoint) -> Result<(), RecordingError> {
        self.viewpoint = viewpoint;
        self.layout()
    }

    /// Sets the views up again if the size of the design differs greatly from that for which they are set up; otherwise
    /// the user's viewpoint is kept.
    fn fit(&mut self, evaluation: &Evaluation) -> Result<(), RecordingError> {
        const ALIKE: std::ops::Range<f64> = 0.6..1.5;
        let wanted = VIEW * evaluation.design.base_radius();
        if ALIKE.contains(&(wanted / self.extent)) {
            return Ok(());
        }
        self.extent = wanted;
        self.layout()
    }

    /// Shows a design, or none, and returns the legends.
    ///
    /// # Errors
    /// [`RecordingError::Encode`] when the scene cannot be encoded.
    pub fn design(&mut self, shown: Option<&Shown<'_>>) -> Result<SceneLegends, RecordingError> {
        let rows = RefCell::new(Rows::default());
        let mut legends = SceneLegends::default();
        if let Some(shown) = shown {
            self.fit(shown.evaluation)?;
            if self.light != shown.light {
                self.light = shown.light;
                self.layout()?;
            }
            legends = draw(&Canvas::collecting(&rows, shown.light), shown)?;
        }
        self.design.show(&self.writer, rows.into_inner())?;
        Ok(legends)
    }

    /// Shows the bars of the design as they bend in a vibration, or none. It is drawn apart from the design, because it changes with every
    /// frame.
    ///
    /// # Errors
    /// [`RecordingError::Encode`] when the scene cannot be encoded.
    pub fn bend(&mut self, bars: &[BentBar]) -> Result<(), RecordingError> {
        let rows = RefCell::new(Rows::default());
        if !bars.is_empty() {
            Canvas::collecting(&rows, self.light).bent_bars(paths::VIBRATION, bars)?;
        }
        self.bent.show(&self.writer, rows.into_inner())
    }

    /// Shows the pinned designs side by side, each at its home pose with its regular workspace.
    ///
    /// # Errors
    /// [`RecordingError::Encode`] when the scene cannot be encoded.
    pub fn pins(&mut self, model: &Model, pins: &[Pinned<'_>]) -> Result<(), RecordingError> {
        let rows = RefCell::new(Rows::default());
        let canvas = Canvas::collecting(&rows, self.light);
        let widest = pins
            .iter()
            .map(|pin| pin.evaluation.design.base_radius())
            .fold(0.0, f64::max);
        // Two per row, so that four designs are shown as large as possible.
        let columns = pins.len().clamp(1, 2);
        let rows_of_pins = pins.len().div_ceil(columns).max(1);
        let extent = widest * (PIN_DISTANCE * columns.max(rows_of_pins) as f64 / PIN_VIEW).max(VIEW);
        if (extent - self.pins_extent).abs() > 0.1 * extent && widest > 0.0 {
            self.pins_extent = extent;
            if self.comparing {
                self.layout()?;
            }
        }
        let layers = VisibleLayers {
            labels: false,
            clearance: false,
            ..VisibleLayers::default()
        };
        for (index, pin) in pins.iter().enumerate() {
            let root = format!("{}/{index}", paths::PINS);
            let off = |place: usize, count: usize| (place as f64 - 0.5 * (count as f64 - 1.0)) * PIN_DISTANCE * widest;
            let (x, y) = (off(index % columns, columns), -off(index / columns, rows_of_pins));
            let transform = Transform3D::from_translation(Vec3D::new(x as f32, y as f32, 0.0));
            rows.borrow_mut().push(&root, &transform);
            let subject = DrawnDesign {
                model,
                evaluation: pin.evaluation,
            };
            if let Ok(mut scene) = manipulator(model, &pin.evaluation.design, &subject.home()) {
                keep(&mut scene, &layers);
                canvas.manipulator(&format!("{root}/manipulator"), &scene)?;
            }
            subject.disc(&canvas, &format!("{root}/workspace"))?;
            let at = glam::DVec3::new(0.0, -0.75 * widest, 0.0);
            let text = format!(
                "{}: {:.1} kg, R_w {:.3} m",
                pin.name,
                pin.evaluation.mass(),
                pin.evaluation.workspace_radius()
            );
            canvas.word(&format!("{root}/name"), at, &text, colors::TEXT)?;
        }
        self.pins.show(&self.writer, rows.into_inner())
    }

    /// Shows the front in its own scatter plot, and marks the selected design.
    ///
    /// # Errors
    /// [`RecordingError::Encode`] when the scene cannot be encoded.
    pub fn front(
        &mut self,
        study: &Study,
        front: &[FrontPoint],
        marked: Option<&Evaluation>,
    ) -> Result<(), RecordingError> {
        let mut rows = Rows::default();
        for member in front {
            self.frame.include(&member.at());
        }
        let marked = marked.map(|marked| {
            let point = PlotPoint::of_evaluation(None, marked);
            let same = |member: &&FrontPoint| member.objectives == point.objectives;
            let id = front.iter().find(same).map(|member| member.id);
            PlotPoint { id, ..point }
        });
        if let Some(marked) = &marked {
            self.frame.include(marked);
        }
        rows.push(paths::PLOT, &self.frame.transform());
        let grid = self.frame.grid();
        rows.push(paths::AXES, &grid.lines());
        rows.push(paths::TICKS, &grid.labels());
        rows.push(paths::LEGEND, &grid.legend(&study.architectures));
        rows.push(paths::FRONT_LINE, &self.frame.staircase(front));
        rows.push(paths::FRONT_DESIGNS, &self.frame.front_points(front));
        if let Some(marked) = &marked {
            rows.push(paths::SELECTED, &self.frame.selected(marked));
        }
        self.front.show(&self.writer, rows)
    }

    /// Returns whether a view with this origin shows the selected design.
    pub fn shows_design(origin: &str) -> bool {
        origin == paths::DESIGN
    }

    /// Returns what a click at `at` on an entity of the scene selects, if it selects anything.
    pub fn picked(entity: &str, instance: Option<u64>, at: DVec2) -> Option<Picked> {
        if let Some(SceneTarget::Field(_)) = SceneTarget::of_entity(entity, instance) {
            return Some(Picked::Position(at));
        }
        let entity = entity.strip_prefix('/').unwrap_or(entity);
        if entity == &paths::FRONT_DESIGNS[1..] {
            return Some(Picked::Front(instance? as usize));
        }
        let rest = entity.strip_prefix(&paths::PINS[1..])?.strip_prefix('/')?;
        let index = rest.split('/').next()?.parse().ok()?;
        Some(Picked::Pin(index))
    }
}
