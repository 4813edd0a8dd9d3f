//! What stands beside the manipulators of a study.

use glam::DVec2;

use super::Study;
use kinefront_model::clearance::{Obstacle, ObstacleShape, Surroundings};
use kinefront_model::mechanism::{Arrangement, DesignVariable, Geometry};
use kinefront_model::spatial::LEGS;

impl Study {
    /// Returns the obstacles and the room; what is at fault is left out.
    pub fn surroundings(&self) -> Surroundings {
        Surroundings {
            obstacles: self
                .obstacles
                .iter()
                .filter_map(|found| found.obstacle().ok())
                .collect(),
            room: self.room.as_ref().and_then(|room| room.outline().ok()),
        }
    }
}

/// Returns the keys at fault, with what is wrong: obstacles and a room are outlines that leave a place for the manipulators.
pub(super) fn faults(study: &Study) -> Vec<(String, String)> {
    let mut faults = Vec::new();
    let place = |index: usize| format!("obstacles[{}]", index + 1);
    for (index, section) in study.obstacles.iter().enumerate() {
        let is_repeated = study.obstacles[..index].iter().any(|other| other.name == section.name);
        match section.obstacle() {
            Err((key, message)) => faults.push((format!("{}.{key}", place(index)), message)),
            Ok(_) if is_repeated => faults.push((
                format!("{}.name", place(index)),
                format!(
                    "is `{}`, the name of another obstacle; names must be unique",
                    section.name
                ),
            )),
            Ok(obstacle) => {
                let message = covers_workspace(study, &obstacle);
                faults.extend(message.map(|message| (place(index), message)));
            }
        }
    }
    if let Some(room) = &study.room {
        match room.outline() {
            Err((key, message)) => faults.push((format!("room.{key}"), message)),
            Ok(_) => faults.extend(base_outside(study).map(|message| ("room".to_owned(), message))),
        }
    }
    let first = match (study.obstacles.is_empty(), &study.room) {
        (false, _) => place(0),
        (true, Some(_)) => "room".to_owned(),
        (true, None) => return faults,
    };
    if study.requirements.clearance_min_m.is_none() {
        let message = "has no effect without a clearance; set requirements.clearance_min_m, to 0 if members may touch";
        faults.push((first, message.to_owned()));
    }
    faults
}

/// Explains that no design works, because an obstacle stands where `P` has to be.
fn covers_workspace(study: &Study, obstacle: &Obstacle) -> Option<String> {
    let centre = DVec2::from_array(study.workspace.centre_m);
    let [low, high] = obstacle.heights;
    // The bars of the platform meet at `P`, in the layer from which heights are measured.
    let layer = study.bodies.layers.platform;
    if layer != 0.0 || low > 0.0 || high < 0.0 {
        return None;
    }
    let covers = match &obstacle.shape {
        ObstacleShape::Disc { centre: at, radius } => at.distance(centre) <= *radius,
        ObstacleShape::Polygon(polygon) => polygon.contains(centre),
    };
    covers.then(|| {
        format!(
            "`{}` covers the centre of the workspace, ({}, {}) m, where the platform has to be; move it, or limit its heights_m",
            obstacle.name, centre.x, centre.y
        )
    })
}

/// Explains that no design works, because a joint of the smallest base lies outside the room.
fn base_outside(study: &Study) -> Option<String> {
    let room = study.room.as_ref()?.outline().ok()?;
    let geometry = Geometry::from(Arrangement::from(&study.geometry));
    let [radius, _] = study.range(DesignVariable::BaseRadius);
    let (leg, joint) = (0..LEGS)
        .map(|leg| (leg, geometry.base_joint(leg, radius)))
        .find(|(_, joint)| !room.contains(*joint))?;
    Some(format!(
        "is smaller than the base: A{} of the smallest one (R = {radius} m) is at ({:.3}, {:.3}) m; enlarge the room, or the range \
         of R",
        leg + 1,
        joint.x,
        joint.y
    ))
}
