//! Contours of a field: the lines in a mesh on which the field has a given value.

use std::collections::BTreeMap;

use glam::DVec2;
use rayon::prelude::*;

use super::Sample;
use super::mesh::FieldMesh;

/// Largest number of steps of false position for a point of a contour.
const REFINEMENTS: u32 = 120;
/// A difference from the level that is at most this fraction of those at the ends of the side counts as 0.
const CLOSE: f64 = 1e-14;

/// Computes the polylines on which `pick` of the samples equals `level`; each point lies on the contour of the field
/// `at` itself, not of its interpolation.
pub(super) fn contour(
    mesh: &FieldMesh,
    level: f64,
    at: &(impl Fn(DVec2) -> Option<Sample> + Sync),
    pick: impl Fn(&Sample) -> f64 + Sync,
) -> Vec<Vec<DVec2>> {
    let above: Vec<bool> = mesh
        .vertices
        .iter()
        .map(|vertex| pick(&vertex.sample) >= level)
        .collect();
    let is_above = |vertex: u32| above[vertex as usize];
    let cut: Vec<[u32; 3]> = mesh
        .triangles
        .par_iter()
        .copied()
        .filter(|&[a, b, c]| is_above(a) != is_above(b) || is_above(a) != is_above(c))
        .collect();
    // A side is identified by its vertices, the lower index first, so two triangles that share a side share its point.
    let crossed = |&[a, b, c]: &[u32; 3]| {
        [(a, b), (b, c), (c, a)]
            .into_iter()
            .filter(|&(from, to)| is_above(from) != is_above(to))
            .map(|(from, to)| (from.min(to), from.max(to)))
    };
    let mut sides: Vec<(u32, u32)> = cut.iter().flat_map(crossed).collect();
    sides.sort_unstable();
    sides.dedup();
    let points: Vec<Option<DVec2>> = sides
        .par_iter()
        .map(|&(a, b)| {
            let ends = [a, b].map(|vertex| {
                let vertex = &mesh.vertices[vertex as usize];
                (vertex.position, pick(&vertex.sample) - level)
            });
            crossing(ends, |position| Some(pick(&at(position)?) - level))
        })
        .collect();
    let mut segments: Vec<[u32; 2]> = Vec::new();
    for triangle in &cut {
        let mut ends = crossed(triangle).filter_map(|side| {
            let index = sides.binary_search(&side).ok()?;
            points[index].map(|_| index as u32)
        });
        if let (Some(first), Some(second)) = (ends.next(), ends.next()) {
            segments.push([first, second]);
        }
    }
    chains(&segments)
        .into_iter()
        .map(|chain| chain.into_iter().filter_map(|point| points[point as usize]).collect())
        .collect()
}

/// Finds the point between two ends with values of opposite sign at which the value is 0, by false position on the
/// function itself, with a bisection after each step that did not halve the bracket because values may have kinks.
/// `None` on a chord of a concave edge of reach that passes through unreachable positions: the contour ends one cell
/// before it.
fn crossing(
    [(start, at_start), (end, at_end)]: [(DVec2, f64); 2],
    value_at: impl Fn(DVec2) -> Option<f64>,
) -> Option<DVec2> {
    let close = CLOSE * at_start.abs().max(at_end.abs());
    let (mut low, mut high, mut at_low, mut at_high) = (0.0f64, 1.0f64, at_start, at_end);
    let mut halve = false;
    for _ in 0..REFINEMENTS {
        let width = high - low;
        let fraction = if halve || at_low == at_high {
            0.5 * (low + high)
        } else {
            ((low * at_high - high * at_low) / (at_high - at_low)).clamp(low, high)
        };
        let point = start.lerp(end, fraction);
        let value = value_at(point)?;
        if value.abs() <= close || width < CLOSE {
            return Some(point);
        }
        if (value > 0.0) == (at_low > 0.0) {
            (low, at_low) = (fraction, value);
        } else {
            (high, at_high) = (fraction, value);
        }
        halve = high - low > 0.5 * width;
    }
    Some(start.lerp(end, 0.5 * (low + high)))
}

/// Joins segments that share end points into chains; a closed chain ends at its first point.
pub(super) fn chains(segments: &[[u32; 2]]) -> Vec<Vec<u32>> {
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
    // Open chains are followed from their ends first; the remaining segments form closed chains.
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
