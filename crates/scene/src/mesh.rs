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
            SolidShape::Bar { radius, from, to, .. } => radius > 0.0 && from != to,
            SolidShape::Block { half_size, .. } => half_size.min_element() > 0.0,
        }
    }

    /// Returns the surface as a mesh; a bar has 32 sides.
    pub fn mesh(&self) -> Mesh {
        match *self {
            SolidShape::Bar {
                from,
                to,
                radius,
                inner,
            } => bar(from, to, radius, inner),
            SolidShape::Block {
                centre,
                half_size,
                angle,
                inner,
            } => block(centre, half_size, angle, inner),
        }
    }

    /// Returns the shape expressed in a frame with its origin at `origin`, rotated by `angle` \[rad\] about z.
    pub fn seen_from(&self, origin: DVec2, angle: f64) -> SolidShape {
        let back = Rotation::new(-angle);
        let place = |point: DVec3| back.apply(point.truncate() - origin).extend(point.z);
        let mut seen = *self;
        match &mut seen {
            SolidShape::Bar { from, to, .. } => {
                *from = place(*from);
                *to = place(*to);
            }
            SolidShape::Block {
                centre, angle: turned, ..
            } => {
                *centre = place(*centre);
                *turned -= angle;
            }
        }
        seen
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

fn bar(from: DVec3, to: DVec3, radius: f64, inner: f64) -> Mesh {
    let axis = (to - from).normalize_or(DVec3::Z);
    let across = if axis.z.abs() < 0.9 { DVec3::Z } else { DVec3::X };
    let side = axis.cross(across).normalize_or(DVec3::X);
    let other = axis.cross(side);
    // Counter-clockwise as seen from the `to` end.
    let spokes: Vec<DVec3> = (0..SIDES)
        .map(|k| unit(2.0 * std::f64::consts::PI * k as f64 / SIDES as f64))
        .map(|turn| side * turn.x + other * turn.y)
        .collect();
    let ring = |centre: DVec3, radius: f64| spokes.iter().map(move |spoke| centre + *spoke * radius);
    let mut mesh = Mesh::default();
    mesh.positions.extend(ring(from, radius).chain(ring(to, radius)));
    mesh.normals.extend(spokes.iter().chain(&spokes));
    for k in 0..SIDES {
        let next = (k + 1) % SIDES;
        let [a, b, c, d] = [k, next, SIDES + next, SIDES + k].map(|index| index as u32);
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    if inner <= 0.0 {
        mesh.face(&ring(to, radius).collect::<Vec<_>>(), axis);
        mesh.face(&ring(from, radius).rev().collect::<Vec<_>>(), -axis);
        return mesh;
    }
    for k in 0..SIDES {
        let next = (k + 1) % SIDES;
        // The corners at one end and in one radius, at this spoke and at the next one.
        let at = |end: DVec3, radius: f64| [k, next].map(|k| end + spokes[k] * radius);
        let [[a, b], [c, d]] = [at(from, inner), at(to, inner)];
        let [[outer_a, outer_b], [outer_c, outer_d]] = [at(from, radius), at(to, radius)];
        let middle = (spokes[k] + spokes[next]).normalize_or(DVec3::X);
        // Inner surface, then both end faces.
        mesh.face(&[a, c, d, b], -middle);
        mesh.face(&[c, outer_c, outer_d, d], axis);
        mesh.face(&[a, b, outer_b, outer_a], -axis);
    }
    mesh
}

fn block(centre: DVec3, half: DVec3, angle: f64, inner: f64) -> Mesh {
    let along = unit(angle).extend(0.0);
    let axes = [along, DVec3::Z.cross(along), DVec3::Z];
    let half = half.to_array();
    let mut mesh = Mesh::default();
    if inner > 0.0 {
        open_ends(&mut mesh, centre, axes, half, inner);
    }
    for k in 0..3 {
        if k == 0 && inner > 0.0 {
            continue;
        }
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

/// Adds the end faces and the inner surface of a square tube along the first of three axes.
fn open_ends(mesh: &mut Mesh, centre: DVec3, [along, across, up]: [DVec3; 3], half: [f64; 3], inner: f64) {
    // The corners of a square, counter-clockwise as seen from the positive end.
    let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    let at = |end: f64, corner: usize, y: f64, z: f64| {
        let (s, t) = corners[corner % 4];
        centre + along * (end * half[0]) + across * (s * y) + up * (t * z)
    };
    for corner in 0..4 {
        let outer = |end: f64| [corner, corner + 1].map(|corner| at(end, corner, half[1], half[2]));
        let hollow = |end: f64| [corner, corner + 1].map(|corner| at(end, corner, inner, inner));
        let [[a, b], [c, d]] = [hollow(-1.0), hollow(1.0)];
        let [[outer_a, outer_b], [outer_c, outer_d]] = [outer(-1.0), outer(1.0)];
        mesh.face(&[outer_c, outer_d, d, c], along);
        mesh.face(&[outer_a, a, b, outer_b], -along);
        let [first, second] = hollow(0.0);
        let inwards = (2.0 * centre - first - second).normalize_or(DVec3::Z);
        mesh.face(&[a, c, d, b], inwards);
    }
}
