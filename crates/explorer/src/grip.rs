//! Where the pointer holds the platform, and the pose that follows from it; in the plan view and in 3-D alike.

use glam::DVec2;

use kinefront_model::spatial::Pose;

/// Share of the platform radius beyond which the pointer turns the platform instead of moving it.
const RIM: f64 = 0.7;

/// Part of the platform that the pointer holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Grip {
    /// The platform; offset of the held point from `P` \[m\].
    Move(DVec2),
    /// The rim; angle from the platform's orientation to the held point \[rad\].
    Turn(f64),
}

impl Grip {
    /// Takes hold of the platform at `point` \[m\] of the plane. Near the rim this turns it, unless `keeps_angle` is true.
    pub fn new(point: DVec2, pose: &Pose, platform_radius: f64, keeps_angle: bool) -> Self {
        let arm = point - pose.position;
        if arm.length() > RIM * platform_radius && !keeps_angle {
            Self::Turn(arm.to_angle() - pose.phi)
        } else {
            Self::Move(arm)
        }
    }

    /// Returns the pose that brings the held point to `point` \[m\], from the present pose. A turn is the shortest one.
    pub fn target(self, point: DVec2, pose: &Pose) -> Pose {
        match self {
            Self::Move(offset) => Pose {
                position: point - offset,
                ..*pose
            },
            Self::Turn(offset) => {
                let held = pose.phi + offset;
                let by = libm::remainder((point - pose.position).to_angle() - held, std::f64::consts::TAU);
                Pose {
                    phi: pose.phi + by,
                    ..*pose
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSE: Pose = Pose {
        position: DVec2::new(0.1, -0.2),
        phi: 3.0,
    };

    #[test]
    fn the_held_point_follows_the_pointer() {
        let hold = POSE.position + DVec2::new(0.03, 0.01);
        let target = Grip::new(hold, &POSE, 0.2, false).target(DVec2::new(0.5, 0.6), &POSE);
        assert!((target.position - DVec2::new(0.47, 0.59)).length() < 1e-15);
        assert_eq!(target.phi, POSE.phi);
    }

    #[test]
    fn the_rim_turns_the_platform_the_short_way_and_shift_moves_it() {
        let hold = POSE.position + 0.19 * DVec2::from_angle(3.1);
        let pointer = POSE.position + 0.4 * DVec2::from_angle(-3.1);
        let target = Grip::new(hold, &POSE, 0.2, false).target(pointer, &POSE);
        assert_eq!(target.position, POSE.position);
        // From 3.1 to −3.1 rad it is 0.0832 rad across the half turn.
        assert!((target.phi - POSE.phi - (std::f64::consts::TAU - 6.2)).abs() < 1e-12);
        let moved = Grip::new(hold, &POSE, 0.2, true).target(pointer, &POSE);
        assert_eq!(moved.phi, POSE.phi);
        assert!((moved.position - POSE.position - (pointer - hold)).length() < 1e-15);
    }
}
