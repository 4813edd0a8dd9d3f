//! A tour of the regular workspace: along its rim at both ends of `Δφ`, then through the centre.

use super::RegularCylinder;
use kinefront_model::evaluation::Model;
use kinefront_model::kinematics::forward;
use kinefront_model::mechanism::{AnyLeg, Design, JointKind, Manipulator};
use kinefront_model::spatial::{Pose, unit};

/// Poses along the regular workspace.
#[derive(Debug, Clone, PartialEq)]
pub struct Tour {
    /// The poses, each a small step from the previous one.
    pub poses: Vec<Pose>,
    /// Radius of the rim that the tour follows \[m\]: `R_w`, reduced where the grid of directions has missed a part of
    /// the boundary.
    pub radius: f64,
    /// Largest difference between a pose and the forward kinematics of its actuator values, followed from the previous
    /// pose \[m\]; a difference in orientation counts as the displacement of the platform joints \[m\].
    pub forward_error: f64,
}

/// Computes the tour of a design with `steps` poses around each rim; `None` if no rim of at least 90 % of the radius
/// can be followed.
pub fn tour(model: &Model, design: &Design, cylinder: &RegularCylinder, steps: usize) -> Option<Tour> {
    let manipulator = Manipulator::<AnyLeg>::new(design, &model.settings().legs);
    // R_w is searched along finitely many directions: between them the rim may lie outside a straight boundary.
    let mut radii = (0..100).map(|k| cylinder.radius * (1.0 - 1e-3 * f64::from(k)));
    radii.find_map(|radius| {
        let poses = path(&RegularCylinder { radius, ..*cylinder }, steps.max(8));
        let is_reached = poses.iter().all(|pose| manipulator.posture(pose).is_ok());
        let forward_error = is_reached.then(|| check(&manipulator, design, &poses))??;
        Some(Tour {
            poses,
            radius,
            forward_error,
        })
    })
}

/// Returns the path: out to the rim while turning to the lower end of `Δφ`, around the rim, a turn to the upper end,
/// around the rim again, across the centre while turning back to the lower end, and home.
fn path(cylinder: &RegularCylinder, steps: usize) -> Vec<Pose> {
    let (low, high) = (-0.5 * cylinder.phi_range, 0.5 * cylinder.phi_range);
    let turn = 2.0 * std::f64::consts::PI;
    // Start and end of each section as (angle, fraction of the radius, orientation from home), and the section's number
    // of poses as a fraction of `steps`.
    let ways: [([f64; 3], [f64; 3], f64); 6] = [
        ([0.0, 0.0, 0.0], [0.0, 1.0, low], 0.25),
        ([0.0, 1.0, low], [turn, 1.0, low], 1.0),
        ([0.0, 1.0, low], [0.0, 1.0, high], 0.25),
        ([0.0, 1.0, high], [turn, 1.0, high], 1.0),
        ([0.0, 1.0, high], [0.0, -1.0, low], 0.5),
        ([0.0, -1.0, low], [0.0, 0.0, 0.0], 0.25),
    ];
    let mut poses = Vec::new();
    for (from, to, fraction) in ways {
        let count = ((steps as f64 * fraction).ceil() as usize).max(1);
        for k in 0..count {
            let s = k as f64 / count as f64;
            let at = |index: usize| from[index] + s * (to[index] - from[index]);
            poses.push(Pose {
                position: cylinder.centre + unit(at(0)) * (at(1) * cylinder.radius),
                phi: cylinder.phi + at(2),
            });
        }
    }
    poses.push(Pose {
        position: cylinder.centre,
        phi: cylinder.phi,
    });
    poses
}

/// Number of actuator steps from one pose of a tour to the next: near a singularity another assembly mode is close, and
/// a longer step might converge to it.
const SUBSTEPS: u32 = 16;

/// Returns the largest difference between the poses and their forward kinematics, followed from each pose to the next.
fn check(manipulator: &Manipulator<AnyLeg>, design: &Design, poses: &[Pose]) -> Option<f64> {
    let architecture = design.architecture();
    let actuators = |pose: &Pose| {
        let posture = manipulator.posture(pose).ok()?;
        Some([0, 1, 2].map(|i| manipulator.legs[i].joint_values(&posture.legs[i])[architecture.driven()]))
    };
    let mut found = *poses.first()?;
    let mut before = actuators(&found)?;
    let mut largest = 0.0f64;
    for pose in poses {
        let target = actuators(pose)?;
        for step in 1..=SUBSTEPS {
            let fraction = f64::from(step) / f64::from(SUBSTEPS);
            let part = [0, 1, 2].map(|i| {
                let way = match architecture.actuator() {
                    JointKind::Prismatic => target[i] - before[i],
                    // The shorter of the two directions of rotation.
                    JointKind::Revolute => libm::remainder(target[i] - before[i], 2.0 * std::f64::consts::PI),
                };
                before[i] + fraction * way
            });
            // At the edge of reach an iterate may become unreachable; the iteration then starts from the pose itself.
            found = forward(architecture, manipulator, part, found, 1e-13)
                .or_else(|_| forward(architecture, manipulator, target, *pose, 1e-13))
                .ok()?;
        }
        let turned = (found.phi - pose.phi).abs() * design.platform_radius();
        largest = largest.max(found.position.distance(pose.position)).max(turned);
        before = target;
    }
    Some(largest)
}
