//! Numbers and poses that look random and are the same in every run.

use kinefront_model::spatial::{Pose, unit};
use kinefront_model::workspace::{Region, WorkspaceSpec};

/// Returns numbers in \[0, 1), by the linear congruential generator of Knuth's MMIX.
pub fn numbers(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Returns poses of a prescribed region in the window about a home orientation \[deg\]: a part of them on the boundary of the region, and
/// a part at the ends of the window.
///
/// # Panics
/// If the region is not prescribed.
pub fn poses_of_region(workspace: &WorkspaceSpec, phi_deg: f64, count: usize, seed: u64) -> Vec<Pose> {
    let mut next = numbers(seed);
    // The conversion to radians must not leave the window.
    let half = 0.5 * workspace.rotation_range_deg * (1.0 - 1e-12);
    let mut poses = Vec::with_capacity(count);
    while poses.len() < count {
        let direction = unit(std::f64::consts::TAU * next());
        let is_on_boundary = next() < 0.3;
        let position = match &workspace.region {
            Region::Disc(radius) if is_on_boundary => direction * *radius,
            Region::Disc(radius) => direction * (*radius * next().sqrt()),
            Region::Polygon(polygon) => {
                let corners = polygon.corners();
                if is_on_boundary {
                    let side = (next() * corners.len() as f64) as usize % corners.len();
                    corners[side].lerp(corners[(side + 1) % corners.len()], next())
                } else {
                    let farthest = corners.iter().map(|corner| corner.length()).fold(0.0, f64::max);
                    let position = direction * (farthest * next().sqrt());
                    if !polygon.contains(position) {
                        continue;
                    }
                    position
                }
            }
            Region::Largest => panic!("the region is not prescribed"),
        };
        let turn = match (6.0 * next()) as u32 {
            0 => half,
            1 => -half,
            _ => half * (2.0 * next() - 1.0),
        };
        poses.push(Pose {
            position: workspace.centre + position,
            phi: (phi_deg + turn).to_radians(),
        });
    }
    poses
}
