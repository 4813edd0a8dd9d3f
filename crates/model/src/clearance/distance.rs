//! Distance of two segments in the plane, at several poses at once.
//!
//! Written here because the loops over poses need it over [`Real`]: the same bits on every instruction set. What a library
//! computes (`parry3d-f64`) is what the tests compare it with.

use crate::lanes::Real;
use crate::mechanism::Axis;

/// Squared distance of two axes \[m²\]; 0 where they cross.
///
/// Two segments of a plane that do not cross are nearest at an end of one of them.
#[inline(always)]
pub(super) fn squared<V: Real>(a: &Axis<V>, b: &Axis<V>) -> V {
    let zero = a.length.splat(0.0);
    let way = b.from.minus(a.from);
    let (cos, sin) = (a.direction.dot(b.direction), a.direction.cross(b.direction));
    // The ends of b along and to the left of a, and those of a along and to the left of b.
    let near_b = [way.dot(a.direction), a.direction.cross(way)];
    let far_b = [near_b[0] + cos * b.length, near_b[1] + sin * b.length];
    let near_a = [-way.dot(b.direction), -b.direction.cross(way)];
    let far_a = [near_a[0] + cos * a.length, near_a[1] - sin * a.length];
    let of_ends = to_segment(near_b, a.length)
        .smaller(to_segment(far_b, a.length))
        .smaller(to_segment(near_a, b.length).smaller(to_segment(far_a, b.length)));
    let cross = zero.exceeds(near_b[1] * far_b[1]) & zero.exceeds(near_a[1] * far_a[1]);
    zero.where_set(cross, of_ends)
}

/// Squared distance of a point from a segment of a length, the point given along and to the left of it.
#[inline(always)]
fn to_segment<V: Real>([along, across]: [V; 2], length: V) -> V {
    let beyond = (-along).larger((along - length).larger(length.splat(0.0)));
    beyond * beyond + across * across
}

/// Whether two axes could be nearer than `distance` anywhere: by the circles about them, which costs a fifth of
/// [`squared`].
#[inline(always)]
pub(super) fn may_be_nearer<V: Real>(a: &Axis<V>, b: &Axis<V>, distance: V) -> V::Mask {
    let half = distance.splat(0.5);
    let (half_a, half_b) = (half * a.length, half * b.length);
    let way = b.from.minus(a.from);
    let way = way.plus(b.direction.scaled(half_b)).minus(a.direction.scaled(half_a));
    let reach = half_a + half_b + distance;
    reach.exceeds(distance.splat(0.0)) & (reach * reach).exceeds(way.dot(way))
}
