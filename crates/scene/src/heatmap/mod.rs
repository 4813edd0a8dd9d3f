//! A field over the reachable workspace at one orientation, as triangles with exact edges.
//!
//! The plane is divided into cells of two triangles each. A triangle that the edge of reach cuts is clipped where the
//! inverse kinematics ends, found by bisection along the triangle's sides, so the edge is a polygon with its vertices
//! on the true boundary and not a staircase. Contours run through the same triangles; each of their points is moved
//! along its side until the field itself has the value. Both steps evaluate the field between the nodes. A
//! marching-squares library knows the values at the nodes only, so none is used.

mod contour;
mod mesh;

use glam::DVec2;

use self::contour::{chains, contour};
use self::mesh::{FieldMesh, NodeGrid};
use super::Field;
use kinefront_model::evaluation::{Model, PoseScalar, PoseValues};
use kinefront_model::mechanism::{Design, ReachReason};
use kinefront_model::spatial::{LEGS, Pose, Rotation};
use kinefront_model::workspace::{PoseEvaluator, ValueColumns};

/// Resolution of a heatmap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HeatmapSettings {
    /// Number of cells along the longer side of the box that contains the reachable workspace.
    pub cells: usize,
}

/// A section of the edge of the reachable workspace.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// Why reach ends here; the end of a leg's reach ([`ReachReason::OutOfReach`]) is a serial singularity.
    pub reason: ReachReason,
    /// Points \[m\].
    pub points: Vec<DVec2>,
}

/// A field over the reachable workspace at one orientation.
#[derive(Debug, Clone, PartialEq)]
pub struct Heatmap {
    /// The field shown.
    pub field: Field,
    /// Orientation \[rad\].
    pub phi: f64,
    /// Positions of `P` \[m\].
    pub vertices: Vec<DVec2>,
    /// The field's value at each vertex.
    pub values: Vec<f64>,
    /// Vertex indices of the triangles, counterclockwise.
    pub triangles: Vec<[u32; 3]>,
    /// Contours at the field's threshold.
    pub threshold: Vec<Vec<DVec2>>,
    /// Contours on which `det A` vanishes: parallel singularities.
    pub singular: Vec<Vec<DVec2>>,
    /// Edge of the reachable workspace.
    pub edges: Vec<Edge>,
    /// Number of cells of the grid.
    pub cells: usize,
}

impl Heatmap {
    /// Computes the heatmap of `field` for `design` at orientation `phi` \[rad\].
    pub fn new(model: &Model, design: &Design, field: Field, phi: f64, settings: HeatmapSettings) -> Self {
        Sampler::new(model, design, field, phi).heatmap(phi, settings)
    }

    /// Returns the value of a field at a pose; `None` if a leg does not reach it.
    pub fn value_at(model: &Model, design: &Design, field: Field, pose: &Pose) -> Option<f64> {
        let sample = Sampler::new(model, design, field, pose.phi).at(pose.position);
        sample.map(|sample| sample.value)
    }

    /// Returns the smallest and the largest value; `None` if no position is reachable.
    pub fn range(&self) -> Option<[f64; 2]> {
        let first = *self.values.first()?;
        let widened = |[low, high]: [f64; 2], value: &f64| [low.min(*value), high.max(*value)];
        Some(self.values.iter().fold([first; 2], widened))
    }
}

/// Value of the field and `det A` at a reachable position.
#[derive(Clone, Copy)]
struct Sample {
    value: f64,
    determinant: f64,
}

struct Sampler<'a> {
    model: &'a Model,
    design: &'a Design,
    evaluator: Box<dyn PoseEvaluator>,
    arms: [DVec2; LEGS],
    field: Field,
}

impl<'a> Sampler<'a> {
    /// Prepares the design for the values that the field needs.
    fn new(model: &'a Model, design: &'a Design, field: Field, phi: f64) -> Self {
        let mut evaluator = model.pose_evaluator(design);
        field.ask(evaluator.as_mut());
        Self {
            model,
            design,
            arms: evaluator.arms(&Rotation::new(phi)),
            evaluator,
            field,
        }
    }

    fn of(&self, values: &PoseValues) -> Sample {
        Sample {
            value: self.field.value(self.model, self.design, values),
            determinant: values[PoseScalar::Determinant],
        }
    }

    /// Returns the samples at many positions; the length of the columns is a multiple of
    /// [`MAX_LANES`](kinefront_model::lanes::MAX_LANES).
    fn row(&self, xs: &[f64], ys: &[f64]) -> Vec<Option<Sample>> {
        let mut values = ValueColumns::default();
        self.evaluator.evaluate_positions(&self.arms, xs, ys, &mut values);
        (0..xs.len())
            .map(|index| values.get(index).ok().map(|values| self.of(&values)))
            .collect()
    }

    /// Returns the sample at one position; `None` where it is unreachable.
    fn at(&self, position: DVec2) -> Option<Sample> {
        let values = self.evaluator.evaluate_position(&self.arms, position).ok()?;
        Some(self.of(&values))
    }

    fn reaches(&self, position: DVec2) -> bool {
        self.evaluator.reaches(&self.arms, position)
    }

    /// Returns why a position is unreachable; a position within rounding of the edge may have no reason.
    fn reason(&self, position: DVec2) -> Option<ReachReason> {
        self.evaluator.reason(&self.arms, position)
    }

    fn heatmap(&self, phi: f64, settings: HeatmapSettings) -> Heatmap {
        let mut heatmap = Heatmap {
            field: self.field,
            phi,
            vertices: Vec::new(),
            values: Vec::new(),
            triangles: Vec::new(),
            threshold: Vec::new(),
            singular: Vec::new(),
            edges: Vec::new(),
            cells: 0,
        };
        let Some([low, high]) = self.evaluator.reach_box(&self.arms) else {
            return heatmap;
        };
        let size = high - low;
        let step = size.max_element() / settings.cells.max(2) as f64;
        let layout = NodeGrid {
            low,
            step,
            columns: (size.x / step).ceil() as usize + 1,
            rows: (size.y / step).ceil() as usize + 1,
        };
        let mesh = FieldMesh::new(&layout, self);
        let threshold = self.field.threshold(self.model);
        let at = |position| self.at(position);
        heatmap.cells = (layout.columns - 1) * (layout.rows - 1);
        heatmap.threshold = contour(&mesh, threshold, &at, |sample| sample.value);
        heatmap.singular = contour(&mesh, 0.0, &at, |sample| sample.determinant);
        heatmap.edges = edges(&mesh);
        heatmap.vertices = mesh.vertices.iter().map(|vertex| vertex.position).collect();
        heatmap.values = mesh.vertices.iter().map(|vertex| vertex.sample.value).collect();
        heatmap.triangles = mesh.triangles;
        heatmap
    }
}

/// Returns the edge of reach as polylines, each with a single reason.
fn edges(mesh: &FieldMesh) -> Vec<Edge> {
    let mut edges = Vec::new();
    for reason in [
        ReachReason::OutOfReach,
        ReachReason::BelowLimit,
        ReachReason::AboveLimit,
        ReachReason::Degenerate,
    ] {
        let segments: Vec<[u32; 2]> = mesh
            .outline
            .iter()
            .filter(|(_, why)| *why == reason)
            .map(|(segment, _)| *segment)
            .collect();
        edges.extend(chains(&segments).into_iter().map(|chain| {
            Edge {
                reason,
                points: chain
                    .into_iter()
                    .map(|vertex| mesh.vertices[vertex as usize].position)
                    .collect(),
            }
        }));
    }
    edges
}
