//! A triangle mesh over the reachable positions, clipped at the edge of reach.

use glam::DVec2;
use rayon::prelude::*;

use super::{Sample, Sampler};
use kinefront_model::lanes::padded_length;
use kinefront_model::mechanism::ReachReason;

/// Number of halvings along a side that the edge of reach cuts: an accuracy of 2⁻³² of a cell.
const HALVINGS: u32 = 32;

/// Nodes of a grid, row by row from the lower left corner.
pub(super) struct NodeGrid {
    pub(super) low: DVec2,
    pub(super) step: f64,
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl NodeGrid {
    fn position(&self, node: usize) -> DVec2 {
        let (column, row) = (node % self.columns, node / self.columns);
        self.low + DVec2::new(column as f64, row as f64) * self.step
    }

    /// Returns the nodes that are connected to `node` by a side: to the right, above, and diagonally across the cell.
    fn neighbours(&self, node: usize) -> [Option<usize>; 3] {
        let right = node % self.columns + 1 < self.columns;
        let up = node / self.columns + 1 < self.rows;
        [
            right.then_some(node + 1),
            up.then_some(node + self.columns),
            (right && up).then_some(node + self.columns + 1),
        ]
    }

    /// Returns the index of the side between two nodes of one triangle.
    fn side(&self, a: usize, b: usize) -> usize {
        let (first, last) = (a.min(b), a.max(b));
        let kind = match last - first {
            1 => 0,
            difference if difference == self.columns => 1,
            _ => 2,
        };
        3 * first + kind
    }
}

/// A vertex of the mesh.
#[derive(Clone, Copy)]
pub(super) struct Vertex {
    pub(super) position: DVec2,
    pub(super) sample: Sample,
}

/// The point at which the edge of reach cuts a side.
struct Cut {
    side: usize,
    vertex: Vertex,
    reason: ReachReason,
}

/// A mesh of triangles with reachable vertices.
pub(super) struct FieldMesh {
    pub(super) vertices: Vec<Vertex>,
    /// Counterclockwise.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Sides of clipped triangles that lie on the edge of reach, with the reason why reach ends there.
    pub(super) outline: Vec<([u32; 2], ReachReason)>,
}

impl FieldMesh {
    /// Builds the mesh of the reachable part of `surface`. Rows are computed in parallel; the result does not depend on
    /// their distribution over threads.
    pub(super) fn new(layout: &NodeGrid, surface: &Sampler<'_>) -> Self {
        let count = layout.columns * layout.rows;
        let nodes = samples(layout, surface);
        let cuts = cuts(layout, surface, &nodes);
        let mut mesh = FieldMesh {
            vertices: Vec::with_capacity(count),
            triangles: Vec::with_capacity(2 * count),
            outline: Vec::new(),
        };
        let mut node_vertex = vec![u32::MAX; count];
        for (node, sample) in nodes.iter().enumerate() {
            if let Some(sample) = sample {
                node_vertex[node] = mesh.vertices.len() as u32;
                mesh.vertices.push(Vertex {
                    position: layout.position(node),
                    sample: *sample,
                });
            }
        }
        let first_cut = mesh.vertices.len();
        let mut cut_of_side = vec![u32::MAX; 3 * count];
        for (index, cut) in cuts.iter().enumerate() {
            cut_of_side[cut.side] = index as u32;
            mesh.vertices.push(cut.vertex);
        }
        for row in 0..layout.rows - 1 {
            for column in 0..layout.columns - 1 {
                let corner = row * layout.columns + column;
                let across = corner + layout.columns + 1;
                for triangle in [[corner, corner + 1, across], [corner, across, across - 1]] {
                    let vertices = triangle.map(|node| node_vertex[node]);
                    match vertices.iter().filter(|&&vertex| vertex != u32::MAX).count() {
                        0 => {}
                        3 => mesh.triangles.push(vertices),
                        _ => {
                            let cut = |a: usize, b: usize| {
                                let index = cut_of_side[layout.side(triangle[a], triangle[b])] as usize;
                                ((first_cut + index) as u32, cuts[index].reason)
                            };
                            mesh.clip(vertices, cut);
                        }
                    }
                }
            }
        }
        mesh
    }

    /// Adds the reachable part of a triangle with one or two reachable corners; `cut` returns the vertex on the side
    /// between two corners.
    fn clip(&mut self, corners: [u32; 3], cut: impl Fn(usize, usize) -> (u32, ReachReason)) {
        let mut polygon: Vec<u32> = Vec::with_capacity(4);
        let mut ends: Vec<(u32, ReachReason)> = Vec::with_capacity(2);
        for k in 0..3 {
            let next = (k + 1) % 3;
            if corners[k] != u32::MAX {
                polygon.push(corners[k]);
            }
            if (corners[k] == u32::MAX) != (corners[next] == u32::MAX) {
                let (vertex, reason) = cut(k, next);
                polygon.push(vertex);
                ends.push((vertex, reason));
            }
        }
        for k in 1..polygon.len() - 1 {
            self.triangles.push([polygon[0], polygon[k], polygon[k + 1]]);
        }
        if let [(first, reason), (second, _)] = ends[..] {
            self.outline.push(([first, second], reason));
        }
    }
}

/// Returns the samples at the nodes.
fn samples(layout: &NodeGrid, surface: &Sampler<'_>) -> Vec<Option<Sample>> {
    let row = |row: usize| {
        let first = row * layout.columns;
        let position = |column: usize| layout.position(first + column.min(layout.columns - 1));
        let (xs, ys): (Vec<f64>, Vec<f64>) = (0..padded_length(layout.columns))
            .map(|column| position(column).into())
            .unzip();
        surface.row(&xs, &ys).into_iter().take(layout.columns)
    };
    (0..layout.rows).into_par_iter().flat_map_iter(row).collect()
}

/// Finds the points at which the edge of reach cuts the sides of the grid.
fn cuts(layout: &NodeGrid, surface: &Sampler<'_>, nodes: &[Option<Sample>]) -> Vec<Cut> {
    let at_node = |node: usize| {
        let neighbours = layout.neighbours(node).into_iter().flatten();
        neighbours.filter_map(move |other| match (nodes[node], nodes[other]) {
            (Some(sample), None) => Some(cut(layout, surface, node, other, sample)),
            (None, Some(sample)) => Some(cut(layout, surface, other, node, sample)),
            _ => None,
        })
    };
    (0..nodes.len()).into_par_iter().flat_map_iter(at_node).collect()
}

/// Finds the last reachable point on the side from a reachable node to an unreachable one.
fn cut(layout: &NodeGrid, surface: &Sampler<'_>, inner: usize, outer: usize, sample: Sample) -> Cut {
    let (mut inside, mut outside) = (layout.position(inner), layout.position(outer));
    for _ in 0..HALVINGS {
        let position = 0.5 * (inside + outside);
        if surface.reaches(position) {
            inside = position;
        } else {
            outside = position;
        }
    }
    let reason = surface
        .reason(outside)
        .or_else(|| surface.reason(layout.position(outer)));
    Cut {
        side: layout.side(inner, outer),
        vertex: Vertex {
            position: inside,
            sample: surface.at(inside).unwrap_or(sample),
        },
        reason: reason.unwrap_or(ReachReason::OutOfReach),
    }
}
