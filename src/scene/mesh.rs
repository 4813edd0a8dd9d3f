//! Solids as triangle meshes.

use glam::{DVec2, DVec3};

use super::{Solid, SolidShape};
use kinefront_model::spatial::{Rotation, unit};

/// A closed surface of triangles, counter-clockwise as seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Points \[m\]; a point on an edge is repeated for each face that meets there.
    pub positions: Vec<DVec3>,
    /// Outward unit normals, one per point.
    pub normals: Vec<DVec3>,
    /// Indices of the three points of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// Number of sides of the prism that approximates a bar.
const SIDES: usize = 32;

impl Mesh {
    /// Appends another surface.
    pub fn append(&mut self, other: &Mesh) {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        let moved = other.triangles.iter().map(|corners| corners.map(|k| k + first));
        self.triangles.extend(moved);
    }

    /// Adds a convex polygon with one normal; the corners are counter-clockwise as seen from the tip of the normal.
    fn face(&mut self, corners: &[DVec3], normal: DVec3) {
        let first = self.positions.len() as u32;
        self.positions.extend(corners);
        self.normals.extend(corners.iter().map(|_| normal));
        let fan = (2..corners.len() as u32).map(|k| [first, first + k - 1, first + k]);
        self.triangles.extend(fan);
    }
}

impl SolidShape {
    /// Returns whether the shape has a volume; a bar of radius 0 has none.
    pub fn has_volume(&self) -> bool {
        match *self {
            SolidShape::Bar { radius, from, to } => radius > 0.0 && from != to,
            SolidShape::Block { half_size, .. } => half_size.min_element() > 0.0,
        }
    }

    /// Returns the surface as a mesh; a bar has 32 sides.
    pub fn mesh(&self) -> Mesh {
        match *self {
            SolidShape::Bar { from, to, radius } => bar(from, to, radius),
            SolidShape::Block {
                centre,
                half_size,
                angle,
            } => block(centre, half_size, angle),
        }
    }

    /// Returns the shape expressed in a frame with its origin at `origin`, rotated by `angle` \[rad\] about z.
    pub fn seen_from(&self, origin: DVec2, angle: f64) -> SolidShape {
        let back = Rotation::new(-angle);
        let place = |point: DVec3| back.apply(point.truncate() - origin).extend(point.z);
        match *self {
            SolidShape::Bar { from, to, radius } => SolidShape::Bar {
                from: place(from),
                to: place(to),
                radius,
            },
            SolidShape::Block {
                centre,
                half_size,
                angle: turned,
            } => SolidShape::Block {
                centre: place(centre),
                half_size,
                angle: turned - angle,
            },
        }
    }
}

impl Solid {
    /// Returns the solid expressed in a frame with its origin at `origin`, rotated by `angle` \[rad\] about z.
    pub fn seen_from(&self, origin: DVec2, angle: f64) -> Solid {
        Solid {
            shape: self.shape.seen_from(origin, angle),
            ..*self
        }
    }
}

fn bar(from: DVec3, to: DVec3, radius: f64) -> Mesh {
    let axis = (to - from).normalize_or(DVec3::Z);
    let across = if axis.z.abs() < 0.9 { DVec3::Z } else { DVec3::X };
    let side = axis.cross(across).normalize_or(DVec3::X);
    let other = axis.cross(side);
    // Counter-clockwise as seen from the `to` end.
    let spokes: Vec<DVec3> = (0..SIDES)
        .map(|k| unit(2.0 * std::f64::consts::PI * k as f64 / SIDES as f64))
        .map(|turn| side * turn.x + other * turn.y)
        .collect();
    let ring = |centre: DVec3| spokes.iter().map(move |spoke| centre + *spoke * radius);
    let mut mesh = Mesh::default();
    mesh.positions.extend(ring(from).chain(ring(to)));
    mesh.normals.extend(spokes.iter().chain(&spokes));
    for k in 0..SIDES {
        let next = (k + 1) % SIDES;
        let [a, b, c, d] = [k, next, SIDES + next, SIDES + k].map(|index| index as u32);
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    mesh.face(&ring(to).collect::<Vec<_>>(), axis);
    mesh.face(&ring(from).rev().collect::<Vec<_>>(), -axis);
    mesh
}

fn block(centre: DVec3, half: DVec3, angle: f64) -> Mesh {
    let along = unit(angle).extend(0.0);
    let axes = [along, DVec3::Z.cross(along), DVec3::Z];
    let half = half.to_array();
    let mut mesh = Mesh::default();
    for k in 0..3 {
        // The other two axes, in the order in which their cross product is this axis.
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        for sign in [1.0, -1.0] {
            let middle = centre + axes[k] * (sign * half[k]);
            let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
                .map(|(s, t)| middle + axes[a] * (s * sign * half[a]) + axes[b] * (t * half[b]));
            mesh.face(&corners, axes[k] * sign);
        }
    }
    mesh
}
