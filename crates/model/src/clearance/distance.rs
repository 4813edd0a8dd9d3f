//! Distance between two segments in the plane, computed at several poses at once.
//!
//! This is an implementation of its own because the loops over poses need one that is generic over [`Real`], which
//! gives the same bits on every instruction set. The tests compare it with the result of a library (`parry3d-f64`).

use glam::DVec2;

use crate::lanes::Real;
use crate::mechanism::MemberAxis;
use crate::spatial::nearest_on_segment;

/// Returns the squared distance between two axes \[m²\]; 0 where they cross.
///
/// Two segments in a plane that do not cross are nearest to each other at an end of one of them.
#[inline(always)]
pub(super) fn squared<V: Real>(a: &MemberAxis<V>, b: &MemberAxis<V>) -> V {
    let zero = a.length.splat(0.0);
    let way = b.from.minus(a.from);
    let (cos, sin) = (a.direction.dot(b.direction), a.direction.cross(b.direction));
    // Coordinates of the ends of b along a and to the left of a, then those of the ends of a relative to b.
    let near_b = [way.dot(a.direction), a.direction.cross(way)];
    let far_b = [near_b[0] + cos * b.length, near_b[1] + sin * b.length];
    let near_a = [-way.dot(b.direction), -b.direction.cross(way)];
    let far_a = [near_a[0] + cos * a.length, near_a[1] - sin * a.length];
    let of_ends = to_segment(near_b, a.length)
        .smaller(to_segment(far_b, a.length))
        .smaller(to_segment(near_a, b.length).smaller(to_segment(far_a, b.length)));
    let cross = zero.exceeds(near_b[1] * far_b[1]) & zero.exceeds(near_a[1] * far_a[1]);
    zero.select(cross, of_ends)
}

/// Returns the squared distance from a point to a segment of the given length. The coordinates of the point are
/// measured from the start of the segment, along it and to its left.
#[inline(always)]
fn to_segment<V: Real>([along, across]: [V; 2], length: V) -> V {
    let beyond = (-along).larger((along - length).larger(length.splat(0.0)));
    beyond * beyond + across * across
}

/// Returns the distance between two upright prisms, given by how much they are apart in plan and in height; where they overlap in both, the
/// result is negative.
#[inline(always)]
pub(super) fn between_prisms<V: Real>(across: V, along_z: V) -> V {
    let zero = across.splat(0.0);
    let (outside_x, outside_z) = (across.larger(zero), along_z.larger(zero));
    let outside = (outside_x * outside_x + outside_z * outside_z).sqrt();
    outside + across.larger(along_z).smaller(zero)
}

/// Returns whether the distance between two axes could be smaller than `distance`. The test compares the circles around
/// the axes, which costs a fifth of [`squared`].
#[inline(always)]
pub(super) fn may_be_nearer<V: Real>(a: &MemberAxis<V>, b: &MemberAxis<V>, distance: V) -> V::Mask {
    let half = distance.splat(0.5);
    let (half_a, half_b) = (half * a.length, half * b.length);
    let way = b.from.minus(a.from);
    let way = way.plus(b.direction.scaled(half_b)).minus(a.direction.scaled(half_a));
    let reach = half_a + half_b + distance;
    reach.exceeds(distance.splat(0.0)) & (reach * reach).exceeds(way.dot(way))
}

/// Returns the point of each of two segments that is nearest to the other segment; both are the same point where they cross.
pub(super) fn nearest_points([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> [DVec2; 2] {
    let (way, other) = (b - a, d - c);
    let turn = way.perp_dot(other);
    if turn != 0.0 {
        let [on_first, on_second] = [other, way].map(|along| (c - a).perp_dot(along) / turn);
        if (0.0..=1.0).contains(&on_first) && (0.0..=1.0).contains(&on_second) {
            return [a.lerp(b, on_first); 2];
        }
    }
    let foot = |point: DVec2, [from, to]: [DVec2; 2]| from.lerp(to, nearest_on_segment(point, from, to));
    [
        [a, foot(a, [c, d])],
        [b, foot(b, [c, d])],
        [foot(c, [a, b]), c],
        [foot(d, [a, b]), d],
    ]
    .into_iter()
    .reduce(nearer)
    .expect("the array has four entries")
}

/// Returns the pair of points that are nearer to each other, the first one among equals.
pub(super) fn nearer(first: [DVec2; 2], second: [DVec2; 2]) -> [DVec2; 2] {
    let length = |[from, to]: [DVec2; 2]| from.distance_squared(to);
    if length(second) < length(first) { second } else { first }
}
