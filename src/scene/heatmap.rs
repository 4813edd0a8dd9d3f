//! A field over the reachable workspace at one orientation, as triangles with exact edges.
//!
//! The plane is laid out in cells of two triangles each. Triangles that the edge of reach cuts are clipped where the
//! inverse kinematics really ends, found by halving along the triangle's sides, so the edge is a polygon on the true
//! boundary and not a staircase. Contours are cut through the same triangles, each of their points moved along its side
//! until the field itself has the value. Both need the field's function between the nodes, which is why no library of
//! marching squares, which knows the nodes only, does it.

use std::collections::BTreeMap;

use glam::DVec2;
use rayon::prelude::*;

use super::Field;
use crate::evaluation::Model;
use crate::kinematics::Jacobian;
use crate::mechanism::{Design, Leg, ReachReason, with_leg};
use crate::spatial::{LEGS, Rotation};
use crate::workspace::{GridError, PoseChecker, PoseValues};

/// How finely a heatmap is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HeatmapSettings {
    /// Cells along the longer side of the reachable box.
    pub cells: usize,
}

/// A stretch of the edge of the reachable workspace.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// What ends the reach: where a leg is stretched out ([`ReachReason::OutOfReach`]) is a serial singularity.
    pub reason: ReachReason,
    /// Its points \[m\].
    pub points: Vec<DVec2>,
}

/// A field over the reachable workspace at one orientation.
#[derive(Debug, Clone, PartialEq)]
pub struct Heatmap {
    /// What it shows.
    pub field: Field,
    /// Orientation \[rad\].
    pub phi: f64,
    /// Positions of `P` \[m\].
    pub vertices: Vec<DVec2>,
    /// The field's value at each vertex.
    pub values: Vec<f64>,
    /// Triangles by their vertices, counterclockwise.
    pub triangles: Vec<[u32; 3]>,
    /// Where the field has its threshold.
    pub threshold: Vec<Vec<DVec2>>,
    /// Where `det A` vanishes: parallel singularities.
    pub singular: Vec<Vec<DVec2>>,
    /// Edge of the reachable workspace.
    pub edges: Vec<Edge>,
    /// Cells of the grid.
    pub cells: usize,
}

/// Halvings along a side that the edge of reach cuts: to 2⁻⁴⁰ of a cell.
const HALVINGS: u32 = 40;
/// Steps of false position that put a contour's point on its value.
const REFINEMENTS: u32 = 60;

impl Heatmap {
    /// The heatmap of `field` for `design` at orientation `phi` \[rad\].
    ///
    /// # Errors
    /// [`GridError`] when the isotropic characteristic length is asked for and the reference grid is not whole.
    pub fn new(
        model: &Model,
        design: &Design,
        field: Field,
        phi: f64,
        settings: HeatmapSettings,
    ) -> Result<Self, GridError> {
        with_leg!(design.architecture, L => {
            let checker = model.checker::<L>(design)?;
            let sampler = Sampler { model, design, checker: &checker, arms: checker.manipulator.arms(&Rotation::new(phi)), field };
            Ok(sampler.heatmap(phi, settings))
        })
    }

    /// Smallest and largest value; `None` where nothing is reachable.
    pub fn range(&self) -> Option<[f64; 2]> {
        let first = *self.values.first()?;
        Some(
            self.values
                .iter()
                .fold([first; 2], |[low, high], &value| [low.min(value), high.max(value)]),
        )
    }
}

/// Value of the field and `det A / ℓ` at a reachable position.
#[derive(Clone, Copy)]
struct Sample {
    value: f64,
    determinant: f64,
}

struct Sampler<'a, L> {
    model: &'a Model,
    design: &'a Design,
    checker: &'a PoseChecker<L>,
    arms: [DVec2; LEGS],
    field: Field,
}

impl<L: Leg> Sampler<'_, L> {
    fn at(&self, position: DVec2) -> Result<Sample, ReachReason> {
        let posture = self
            .checker
            .manipulator
            .posture_at(position, &self.arms)
            .map_err(|(_, shortfall)| shortfall.reason)?;
        let jacobian = Jacobian::new(&posture);
        let determinant = jacobian.determinant() / self.checker.length;
        let value = match self.field {
            // The cheap fields need no stiffness.
            Field::Determinant => determinant,
            Field::InverseCondition => jacobian.inverse_condition(self.checker.length),
            field => {
                let stiffness = self.checker.stiffness_at(&posture, &jacobian);
                let values = PoseValues {
                    slack: posture.slack,
                    determinant,
                    inverse_condition: jacobian.inverse_condition(self.checker.length),
                    rigidity: stiffness.rigidity(self.checker.definition),
                };
                field.value(self.model, self.design, &values, &stiffness)
            }
        };
        Ok(Sample { value, determinant })
    }

    /// Box that holds every reachable position.
    fn reach(&self) -> Option<[DVec2; 2]> {
        let boxes = self.checker.manipulator.legs.iter().zip(&self.arms).map(|(leg, arm)| {
            let [low, high] = leg.reach_box();
            [low - *arm, high - *arm]
        });
        let [low, high] = boxes.reduce(|[a, b], [c, d]| [a.max(c), b.min(d)])?;
        (low.x < high.x && low.y < high.y).then_some([low, high])
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
        let Some([low, high]) = self.reach() else {
            return heatmap;
        };
        let size = high - low;
        let step = size.max_element() / settings.cells.max(2) as f64;
        let columns = (size.x / step).ceil() as usize + 1;
        let rows = (size.y / step).ceil() as usize + 1;
        heatmap.cells = (columns - 1) * (rows - 1);
        let position = |node: usize| low + DVec2::new((node % columns) as f64, (node / columns) as f64) * step;
        let nodes: Vec<Result<Sample, ReachReason>> = (0..columns * rows)
            .into_par_iter()
            .map(|node| self.at(position(node)))
            .collect();

        let mut mesh = Mesh {
            sampler: self,
            determinants: Vec::new(),
            vertices: Vec::new(),
            values: Vec::new(),
            node_vertex: vec![None; nodes.len()],
            cuts: BTreeMap::new(),
            triangles: Vec::new(),
            outline: Vec::new(),
        };
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                let corner = row * columns + column;
                let [a, b, c, d] = [corner, corner + 1, corner + columns + 1, corner + columns];
                for triangle in [[a, b, c], [a, c, d]] {
                    mesh.triangle(triangle, &nodes, &position);
                }
            }
        }
        let threshold = self.field.threshold(self.model);
        heatmap.threshold = mesh.contour(&mesh.values, threshold, |sample| sample.value);
        heatmap.singular = mesh.contour(&mesh.determinants, 0.0, |sample| sample.determinant);
        heatmap.edges = mesh.edges();
        heatmap.vertices = mesh.vertices;
        heatmap.values = mesh.values;
        heatmap.triangles = mesh.triangles;
        heatmap
    }
}

struct Mesh<'a, L> {
    sampler: &'a Sampler<'a, L>,
    vertices: Vec<DVec2>,
    values: Vec<f64>,
    determinants: Vec<f64>,
    /// Vertex of each reachable grid node in use.
    node_vertex: Vec<Option<u32>>,
    /// Vertex where the edge of reach cuts a side, by the side's nodes, inner one first, and what ends the reach there.
    cuts: BTreeMap<(usize, usize), (u32, ReachReason)>,
    triangles: Vec<[u32; 3]>,
    /// Sides of clipped triangles that lie on the edge of reach.
    outline: Vec<([u32; 2], ReachReason)>,
}

impl<L: Leg> Mesh<'_, L> {
    fn vertex(&mut self, position: DVec2, sample: Sample) -> u32 {
        self.vertices.push(position);
        self.values.push(sample.value);
        self.determinants.push(sample.determinant);
        (self.vertices.len() - 1) as u32
    }

    fn node(&mut self, node: usize, position: DVec2, sample: Sample) -> u32 {
        if let Some(vertex) = self.node_vertex[node] {
            return vertex;
        }
        let vertex = self.vertex(position, sample);
        self.node_vertex[node] = Some(vertex);
        vertex
    }

    /// Last reachable point on the side from a reachable node to one that is not.
    fn cut(
        &mut self,
        (inner, at, sample): (usize, DVec2, Sample),
        (outer, beyond, reason): (usize, DVec2, ReachReason),
    ) -> (u32, ReachReason) {
        if let Some(&found) = self.cuts.get(&(inner, outer)) {
            return found;
        }
        let (mut inside, mut outside, mut last, mut why) = (at, beyond, sample, reason);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            match self.sampler.at(middle) {
                Ok(sample) => (inside, last) = (middle, sample),
                Err(reason) => (outside, why) = (middle, reason),
            }
        }
        let found = (self.vertex(inside, last), why);
        self.cuts.insert((inner, outer), found);
        found
    }

    /// Adds the reachable part of a triangle of grid nodes.
    fn triangle(
        &mut self,
        triangle: [usize; 3],
        nodes: &[Result<Sample, ReachReason>],
        position: &impl Fn(usize) -> DVec2,
    ) {
        let mut polygon: Vec<u32> = Vec::with_capacity(4);
        let mut ends: Vec<(u32, ReachReason)> = Vec::with_capacity(2);
        for k in 0..3 {
            let (here, next) = (triangle[k], triangle[(k + 1) % 3]);
            if let Ok(sample) = nodes[here] {
                polygon.push(self.node(here, position(here), sample));
            }
            let cut = match (nodes[here], nodes[next]) {
                (Ok(sample), Err(reason)) => {
                    Some(self.cut((here, position(here), sample), (next, position(next), reason)))
                }
                (Err(reason), Ok(sample)) => {
                    Some(self.cut((next, position(next), sample), (here, position(here), reason)))
                }
                _ => None,
            };
            if let Some((vertex, reason)) = cut {
                polygon.push(vertex);
                ends.push((vertex, reason));
            }
        }
        for k in 1..polygon.len().saturating_sub(1) {
            self.triangles.push([polygon[0], polygon[k], polygon[k + 1]]);
        }
        if let [(first, reason), (second, _)] = ends[..] {
            self.outline.push(([first, second], reason));
        }
    }

    /// Polylines on which a value given at the vertices, and by `pick` in between, equals `level`.
    fn contour(&self, values: &[f64], level: f64, pick: impl Fn(Sample) -> f64) -> Vec<Vec<DVec2>> {
        let mut points: BTreeMap<(u32, u32), Option<u32>> = BTreeMap::new();
        let mut positions: Vec<DVec2> = Vec::new();
        let mut segments: Vec<[u32; 2]> = Vec::new();
        for triangle in &self.triangles {
            let above = triangle.map(|vertex| values[vertex as usize] >= level);
            let mut ends: Vec<u32> = Vec::with_capacity(2);
            for k in 0..3 {
                let (a, b) = (k, (k + 1) % 3);
                if above[a] == above[b] {
                    continue;
                }
                // One direction for a side that two triangles share: one point.
                let side = (triangle[a].min(triangle[b]), triangle[a].max(triangle[b]));
                let point = *points.entry(side).or_insert_with(|| {
                    positions.push(self.crossing(side, values, level, &pick)?);
                    Some((positions.len() - 1) as u32)
                });
                ends.extend(point);
            }
            if let [first, second] = ends[..] {
                segments.push([first, second]);
            }
        }
        chains(&segments)
            .into_iter()
            .map(|chain| chain.into_iter().map(|point| positions[point as usize]).collect())
            .collect()
    }

    /// Point on a side at which the value equals `level`: false position (Illinois) on the function itself. `None` on a
    /// chord of a hollow edge of reach, which leaves what is reachable: the contour ends a cell before it.
    fn crossing(&self, side: (u32, u32), values: &[f64], level: f64, pick: &impl Fn(Sample) -> f64) -> Option<DVec2> {
        let (start, end) = (self.vertices[side.0 as usize], self.vertices[side.1 as usize]);
        let (mut low, mut high) = (0.0, 1.0);
        let (mut at_low, mut at_high) = (values[side.0 as usize] - level, values[side.1 as usize] - level);
        let mut last_low = None;
        for _ in 0..REFINEMENTS {
            let share = if at_low == at_high {
                0.5 * (low + high)
            } else {
                ((low * at_high - high * at_low) / (at_high - at_low)).clamp(low, high)
            };
            let point = start.lerp(end, share);
            let sample = self.sampler.at(point).ok()?;
            let value = pick(sample) - level;
            if value == 0.0 || high - low < 1e-13 {
                return Some(point);
            }
            if (value > 0.0) == (at_low > 0.0) {
                if last_low == Some(true) {
                    at_high *= 0.5;
                }
                (low, at_low, last_low) = (share, value, Some(true));
            } else {
                if last_low == Some(false) {
                    at_low *= 0.5;
                }
                (high, at_high, last_low) = (share, value, Some(false));
            }
        }
        Some(start.lerp(end, 0.5 * (low + high)))
    }

    /// Edge of reach as polylines of one reason each.
    fn edges(&self) -> Vec<Edge> {
        let mut edges = Vec::new();
        for reason in [
            ReachReason::OutOfReach,
            ReachReason::BelowLimit,
            ReachReason::AboveLimit,
            ReachReason::Degenerate,
        ] {
            let segments: Vec<[u32; 2]> = self
                .outline
                .iter()
                .filter(|(_, why)| *why == reason)
                .map(|(segment, _)| *segment)
                .collect();
            edges.extend(chains(&segments).into_iter().map(|chain| Edge {
                reason,
                points: chain.into_iter().map(|vertex| self.vertices[vertex as usize]).collect(),
            }));
        }
        edges
    }
}

/// Joins segments that share end points to chains; a closed chain ends where it starts.
fn chains(segments: &[[u32; 2]]) -> Vec<Vec<u32>> {
    let mut touching: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (index, segment) in segments.iter().enumerate() {
        for &point in segment {
            touching.entry(point).or_default().push(index);
        }
    }
    let mut used = vec![false; segments.len()];
    let follow = |start: usize, from: u32, used: &mut Vec<bool>| {
        let mut chain = vec![from];
        let mut segment = start;
        let mut point = from;
        loop {
            used[segment] = true;
            point = if segments[segment][0] == point {
                segments[segment][1]
            } else {
                segments[segment][0]
            };
            chain.push(point);
            match touching[&point].iter().find(|&&next| !used[next]) {
                Some(&next) => segment = next,
                None => return chain,
            }
        }
    };
    let mut found = Vec::new();
    // Open chains from their ends first, then what is left is closed.
    for (&point, at) in &touching {
        if at.len() == 1 && !used[at[0]] {
            found.push(follow(at[0], point, &mut used));
        }
    }
    for index in 0..segments.len() {
        if !used[index] {
            found.push(follow(index, segments[index][0], &mut used));
        }
    }
    found
}
