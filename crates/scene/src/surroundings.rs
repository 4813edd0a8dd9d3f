//! Obstacles and the room, as outlines.

use glam::DVec2;

use super::{Part, Scene};
use kinefront_model::clearance::{ObstacleShape, Surroundings};
use kinefront_model::spatial::unit;

/// Number of sides by which a disc is drawn.
const SIDES: usize = 48;

/// Adds what stands beside the manipulator; what has no end is drawn between two heights.
pub(super) fn add(scene: &mut Scene, surroundings: &Surroundings, [lowest, highest]: [f64; 2]) {
    for obstacle in &surroundings.obstacles {
        let [low, high] = obstacle.heights;
        let heights = [
            if low.is_finite() { low } else { lowest.min(high) },
            if high.is_finite() { high } else { highest.max(low) },
        ];
        let (corners, uprights, middle) = match &obstacle.shape {
            ObstacleShape::Disc { centre, radius } => {
                let at = |k: usize| *centre + unit(std::f64::consts::TAU * k as f64 / SIDES as f64) * *radius;
                ((0..SIDES).map(at).collect(), SIDES / 8, *centre)
            }
            ObstacleShape::Polygon(polygon) => {
                let corners = polygon.corners().to_vec();
                let middle = corners.iter().sum::<DVec2>() / corners.len() as f64;
                (corners, 1, middle)
            }
        };
        prism(scene, Part::Obstacle, &corners, uprights, heights);
        scene.add_label(middle.extend(heights[1]), obstacle.name.to_string());
    }
    if let Some(room) = &surroundings.room {
        prism(scene, Part::Room, room.corners(), 1, [lowest, highest]);
    }
}

/// Adds the edges of an upright prism, of which every so many are drawn.
fn prism(scene: &mut Scene, part: Part, corners: &[DVec2], every: usize, heights: [f64; 2]) {
    for height in heights {
        let closed = corners.iter().chain(corners.first());
        scene.add_line(part, closed.map(|corner| corner.extend(height)));
    }
    for corner in corners.iter().step_by(every) {
        scene.add_line(part, heights.map(|height| corner.extend(height)));
    }
}
