//! Displacements of a manipulator that follow those of its platform, as rows of the coordinates of the platform.

use crate::lanes::{Planar, Real, dot, scaled, sum};
use crate::strength::LegStiffness;

/// How a displacement depends on the three of the platform.
pub(super) type Row<V> = [V; 3];

/// Displacements of a body at `P`, each as a row: two components and the rotation, or that along z and both rotations.
pub(super) type Displacement<V> = [Row<V>; 3];

/// Coordinates of the platform in which displacements are stated.
pub(super) trait Coordinates<V: Real>: Copy {
    /// Whether masses are summed up at fixed shares of a uniform bar, and in one stretch where a piece is known to lie within its bar, which
    /// takes few operations.
    const AT_SHARES: bool;

    /// Returns in these coordinates what is given as a row of the displacements of the platform.
    fn of(self, row: &Row<V>) -> Row<V>;

    /// Returns the displacements of the platform.
    fn platform(self, like: V) -> Displacement<V>;

    /// Returns the force along z and the moments at `P` with which a leg opposes displacements out of the plane, as rows.
    fn forces(self, stiffness: &LegStiffness<V>) -> Displacement<V>;
}

/// The displacements of the platform themselves.
#[derive(Clone, Copy)]
pub(super) struct Own;

impl<V: Real> Coordinates<V> for Own {
    const AT_SHARES: bool = false;

    #[inline(always)]
    fn of(self, row: &Row<V>) -> Row<V> {
        *row
    }

    #[inline(always)]
    fn platform(self, like: V) -> Displacement<V> {
        let (zero, one) = (like.splat(0.0), like.splat(1.0));
        [[one, zero, zero], [zero, one, zero], [zero, zero, one]]
    }

    #[inline(always)]
    fn forces(self, stiffness: &LegStiffness<V>) -> Displacement<V> {
        full(&stiffness.at_platform)
    }
}

/// Adds the outer product of a row with itself to an upper triangle.
#[inline(always)]
pub(super) fn add_square<V: Real>(m: &mut [V; 6], row: &Row<V>, by: V) {
    let scaled = scaled(row, by);
    m[0] = m[0] + row[0] * scaled[0];
    m[1] = m[1] + row[0] * scaled[1];
    m[2] = m[2] + row[0] * scaled[2];
    m[3] = m[3] + row[1] * scaled[1];
    m[4] = m[4] + row[1] * scaled[2];
    m[5] = m[5] + row[2] * scaled[2];
}

#[inline(always)]
pub(super) fn combined<V: Real>(a: &Row<V>, by_a: V, b: &Row<V>, by_b: V) -> Row<V> {
    sum(&scaled(a, by_a), &scaled(b, by_b))
}

/// Adds a mass to another one.
#[inline(always)]
pub(super) fn add<V: Real>(mass: &mut [V; 6], added: &[V; 6]) {
    for (sum, entry) in mass.iter_mut().zip(added) {
        *sum = *sum + *entry;
    }
}

/// Returns the displacement of a place in a direction in the plane.
#[inline(always)]
pub(super) fn in_direction<V: Real>(of: &Displacement<V>, direction: Planar<V>, place: Planar<V>) -> Row<V> {
    let turned = direction.dot(place.perp());
    let both = combined(&of[0], direction.x, &of[1], direction.y);
    sum(&both, &scaled(&of[2], turned))
}

/// Returns the displacement of a place along z.
#[inline(always)]
pub(super) fn lift<V: Real>(of: &Displacement<V>, place: Planar<V>) -> Row<V> {
    sum(&of[0], &combined(&of[1], place.y, &of[2], -place.x))
}

/// Returns the rotation about an axis in the plane.
#[inline(always)]
pub(super) fn rotation<V: Real>(of: &Displacement<V>, axis: Planar<V>) -> Row<V> {
    combined(&of[1], axis.x, &of[2], axis.y)
}

/// Returns the slope along an axis in the plane: a rotation about the normal to the left lowers what lies ahead.
#[inline(always)]
pub(super) fn slope<V: Real>(of: &Displacement<V>, axis: Planar<V>) -> Row<V> {
    scaled(&rotation(of, axis.perp()), axis.x.splat(-1.0))
}

/// Adds a displacement along a twist.
#[inline(always)]
pub(super) fn add_twist<V: Real>(moved: &mut Displacement<V>, twist: &[V; 3], by: &Row<V>) {
    for (row, part) in moved.iter_mut().zip(twist) {
        *row = sum(row, &scaled(by, *part));
    }
}

/// Returns a symmetric matrix that is given as an upper triangle.
#[inline(always)]
pub(super) fn full<V: Copy>(m: &[V; 6]) -> [[V; 3]; 3] {
    [[m[0], m[1], m[2]], [m[1], m[3], m[4]], [m[2], m[4], m[5]]]
}

/// Returns the displacements for forces, given as rows, of a compliance, given as an upper triangle.
#[inline(always)]
pub(super) fn times<V: Real>(compliance: &[V; 6], forces: &Displacement<V>) -> Displacement<V> {
    let mut moved = *forces;
    for (of, row) in moved.iter_mut().zip(&full(compliance)) {
        for (k, entry) in of.iter_mut().enumerate() {
            *entry = dot(row, &column(forces, k));
        }
    }
    moved
}

/// Returns the displacements for one coordinate.
#[inline(always)]
pub(super) fn column<V: Copy>(of: &Displacement<V>, coordinate: usize) -> [V; 3] {
    [of[0][coordinate], of[1][coordinate], of[2][coordinate]]
}
