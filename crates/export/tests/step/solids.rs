//! The topology and geometry of a solid, and its volume.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use glam::DVec3;

use super::records::Records;

const NEAR: f64 = 1e-7;

/// An edge in the direction in which a face uses it.
struct Edge {
    record: usize,
    forward: bool,
    ends: [usize; 2],
    /// Radius and axis of a circle.
    circle: Option<(f64, DVec3, DVec3)>,
}

fn edge(records: &Records, oriented: usize) -> Result<Edge, String> {
    let parts = records.of(oriented, "ORIENTED_EDGE")?;
    let (record, forward) = (parts[3].record()?, parts[4].is_true());
    let parts = records.of(record, "EDGE_CURVE")?;
    let ends = [parts[1].record()?, parts[2].record()?];
    let curve = parts[3].record()?;
    let points = [records.vertex(ends[0])?, records.vertex(ends[1])?];
    let circle = match records.name(curve) {
        "CIRCLE" => {
            let parts = records.of(curve, "CIRCLE")?;
            let ([origin, z, _], radius) = (records.placement(parts[1].record()?)?, parts[2].number()?);
            for point in points {
                let way = point - origin;
                if (way.length() - radius).abs() > NEAR || way.dot(z).abs() > NEAR {
                    return Err(format!("a vertex of #{record} is not on its circle"));
                }
            }
            Some((radius, z, origin))
        }
        _ => {
            let parts = records.of(curve, "LINE")?;
            let from = records.vector(parts[1].record()?, "CARTESIAN_POINT")?;
            let vector = records.of(parts[2].record()?, "VECTOR")?;
            let along = records.vector(vector[1].record()?, "DIRECTION")?;
            for point in points {
                if (point - from).cross(along).length() > NEAR {
                    return Err(format!("a vertex of #{record} is not on its line"));
                }
            }
            if (points[1] - points[0]).dot(along) <= 0.0 {
                return Err(format!("#{record} runs against its line"));
            }
            None
        }
    };
    Ok(Edge {
        record,
        forward,
        ends: if forward { ends } else { [ends[1], ends[0]] },
        circle,
    })
}

/// Returns the volume of a solid by the divergence theorem, or what is wrong with it.
pub(super) fn volume(records: &Records, shell: usize) -> Result<f64, String> {
    let (mut uses, mut vertices) = (BTreeMap::<usize, [usize; 2]>::new(), Vec::new());
    let (mut faces, mut rings, mut sum) = (0, 0, 0.0);
    for face in records.of(shell, "CLOSED_SHELL")?[1].list()? {
        let parts = records.of(face.record()?, "ADVANCED_FACE")?;
        let (surface, sign) = (parts[2].record()?, if parts[3].is_true() { 1.0 } else { -1.0 });
        faces += 1;
        let mut loops = Vec::new();
        for (place, bound) in parts[1].list()?.iter().enumerate() {
            let kind = if place == 0 { "FACE_OUTER_BOUND" } else { "FACE_BOUND" };
            let bound = records.of(bound.record()?, kind)?;
            rings += usize::from(place > 0);
            let edges: Result<Vec<Edge>, String> = records.of(bound[1].record()?, "EDGE_LOOP")?[1]
                .list()?
                .iter()
                .map(|oriented| edge(records, oriented.record()?))
                .collect();
            let edges = edges?;
            for (k, edge) in edges.iter().enumerate() {
                if edge.ends[1] != edges[(k + 1) % edges.len()].ends[0] {
                    return Err(format!("a loop of #{} is open", face.record()?));
                }
                uses.entry(edge.record).or_default()[usize::from(edge.forward)] += 1;
                vertices.extend(edge.ends);
            }
            loops.push(edges);
        }
        sum += match records.name(surface) {
            "PLANE" => of_plane(records, surface, sign, &loops)?,
            "CYLINDRICAL_SURFACE" => of_cylinder(records, surface, sign, &loops)?,
            other => return Err(format!("a surface is a {other}")),
        };
    }
    if uses.values().any(|used| *used != [1, 1]) {
        return Err("an edge is not used once in each direction".to_owned());
    }
    vertices.sort_unstable();
    vertices.dedup();
    // A bore makes the solid a ring.
    let euler = vertices.len() as i64 - uses.len() as i64 + faces - rings as i64;
    if euler != if rings > 0 { 0 } else { 2 } {
        return Err(format!("the characteristic of #{shell} is {euler}"));
    }
    Ok(sum)
}

fn of_plane(records: &Records, surface: usize, sign: f64, loops: &[Vec<Edge>]) -> Result<f64, String> {
    let [origin, z, _] = records.placement(records.of(surface, "PLANE")?[1].record()?)?;
    let normal = z * sign;
    let mut area = 0.0;
    for (place, edges) in loops.iter().enumerate() {
        let mut part = 0.0;
        for edge in edges {
            let points = [records.vertex(edge.ends[0])?, records.vertex(edge.ends[1])?];
            if points.iter().any(|point| (*point - origin).dot(z).abs() > NEAR) {
                return Err(format!("a vertex is not on #{surface}"));
            }
            part += match edge.circle {
                Some((radius, axis, _)) => {
                    let turns = if edge.forward { 1.0 } else { -1.0 };
                    PI * radius * radius * turns * axis.dot(normal)
                }
                None => 0.5 * (points[0] - origin).cross(points[1] - origin).dot(normal),
            };
        }
        // The outer loop runs counter-clockwise about the normal, an inner one against it.
        if (part > 0.0) != (place == 0) {
            return Err(format!("a loop on #{surface} runs the wrong way"));
        }
        area += part;
    }
    Ok(origin.dot(normal) * area / 3.0)
}

fn of_cylinder(records: &Records, surface: usize, sign: f64, loops: &[Vec<Edge>]) -> Result<f64, String> {
    let parts = records.of(surface, "CYLINDRICAL_SURFACE")?;
    let ([origin, z, _], radius) = (records.placement(parts[1].record()?)?, parts[2].number()?);
    let mut heights = Vec::new();
    for edge in loops.iter().flatten() {
        for end in edge.ends {
            let way = records.vertex(end)? - origin;
            if (way.reject_from(z).length() - radius).abs() > NEAR {
                return Err(format!("a vertex is not on #{surface}"));
            }
        }
        if let Some((_, axis, centre)) = edge.circle {
            let turns = if edge.forward { 1.0 } else { -1.0 } * axis.dot(z);
            heights.push(((centre - origin).dot(z), turns));
        }
    }
    let [(first, at_first), (last, at_last)] = heights[..] else {
        return Err(format!("#{surface} has {} circles", heights.len()));
    };
    // Seen from outside, the lower circle runs with the axis and the upper one against it.
    let (low, high) = if first < last {
        (at_first, at_last)
    } else {
        (at_last, at_first)
    };
    if low * sign < 0.5 || high * sign > -0.5 {
        return Err(format!("the loop on #{surface} runs the wrong way"));
    }
    // The axis contributes nothing, because the normals about it sum to 0.
    Ok(sign * radius * 2.0 * PI * radius * (last - first).abs() / 3.0)
}
