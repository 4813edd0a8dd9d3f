//! A design of a local problem, prepared for many poses.

use glam::DVec2;
use kinefront_model::evaluation::PoseScalar;
use kinefront_model::mechanism::{AnyLeg, Design, Leg};
use kinefront_model::spatial::{LEGS, Rotation};
use kinefront_model::workspace::PoseEvaluator;

use super::place::{Area, Place};
use super::requirement::End;

/// A design of a local problem, prepared for many poses.
pub(crate) struct Prepared {
    pub design: Design,
    /// Home orientation \[rad\].
    pub home: f64,
    pub area: Area,
    pub half_range: f64,
    /// Centre of the region \[m\].
    pub centre: DVec2,
    pub evaluator: Box<dyn PoseEvaluator>,
    pub legs: [AnyLeg; LEGS],
    pub limits: [[Option<[f64; 2]>; 3]; LEGS],
    /// The limit of a scalar that is an unknown, with its value.
    pub level: Option<(PoseScalar, f64)>,
}

impl Prepared {
    /// Returns the position of a place \[m\], and the arms in its orientation.
    pub fn located(&self, place: &Place) -> (DVec2, [DVec2; LEGS]) {
        let position = self.centre + self.area.position(place.spot);
        (position, self.arms(place.turn))
    }

    /// Returns the arms in an orientation, a share of half the rotation range from the home orientation.
    pub fn arms(&self, turn: f64) -> [DVec2; LEGS] {
        self.evaluator.arms(&Rotation::new(self.orientation(turn)))
    }

    /// Returns an orientation \[rad\] from its share of half the rotation range.
    pub fn orientation(&self, turn: f64) -> f64 {
        self.home + turn * self.half_range
    }

    /// The evaluator of poses.
    pub fn evaluator(&self) -> &dyn PoseEvaluator {
        &*self.evaluator
    }

    /// Returns the distance of the farthest anchor of the base from `O` \[m\].
    pub fn base_radius(&self) -> f64 {
        let distances = self.legs.iter().map(|leg| leg.frame().anchor_distance);
        distances.fold(0.0, f64::max)
    }

    /// Returns the distance of a joint from one of its limits \[m\], negative beyond it; `None` where the leg does not reach the pose.
    pub fn distance_from_limit(&self, leg: usize, joint: usize, end: End, place: &Place) -> Option<f64> {
        let (position, arms) = self.located(place);
        let [lower, upper] = self.limits[leg][joint]?;
        let (posture, _) = self.legs[leg].solve(position + arms[leg], arms[leg]).ok()?;
        let value = self.legs[leg].joint_values(&posture)[joint];
        Some(match end {
            End::Lower => value - lower,
            End::Upper => upper - value,
        })
    }

    /// Returns the distance of a leg from the end of its reach \[m\], negative beyond it; `None` where a joint limit is nearer, so that the
    /// end is not what is missed first.
    pub fn distance_from_end(&self, leg: usize, place: &Place) -> Option<f64> {
        let (position, arms) = self.located(place);
        match self.legs[leg].solve(position + arms[leg], arms[leg]) {
            Err(shortfall) => Some(shortfall.limit_margin),
            Ok((_, Some(_))) => None,
            Ok((posture, None)) => {
                let values = self.legs[leg].joint_values(&posture);
                let limits = self.limits[leg].iter().zip(values);
                let distances = limits
                    .filter_map(|(limits, value)| limits.map(|[lower, upper]| (value - lower).min(upper - value)));
                let nearest = distances.fold(f64::INFINITY, f64::min);
                Some(posture.chain.limit_margin).filter(|margin| *margin < nearest * (1.0 - 1e-9))
            }
        }
    }
}
