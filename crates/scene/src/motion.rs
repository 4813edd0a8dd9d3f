//! A motion that a design follows: curves of its actuators, and its path with colours.

use std::borrow::Cow;

use glam::DVec2;
use kinefront_model::evaluation::{Model, Scale, TaskSample};
use kinefront_model::mechanism::{Design, JointKind};
use kinefront_model::spatial::{Pose, Rotation};

use super::{ColorMap, Field};

/// Largest number of points of a path that are drawn.
const MOST_POINTS: usize = 2000;

/// A value of each actuator over the time of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MotionCurve {
    /// Position.
    Position,
    /// Speed.
    Speed,
    /// Acceleration.
    Acceleration,
    /// Force or torque.
    Force,
    /// Power.
    Power,
}

impl MotionCurve {
    /// All curves.
    pub const ALL: [MotionCurve; 5] = [
        MotionCurve::Position,
        MotionCurve::Speed,
        MotionCurve::Acceleration,
        MotionCurve::Force,
        MotionCurve::Power,
    ];

    /// Returns the name, with that of the unit for an actuator.
    pub fn title(self, actuator: JointKind) -> String {
        let name = match (self, actuator) {
            (MotionCurve::Position, _) => "position",
            (MotionCurve::Speed, _) => "speed",
            (MotionCurve::Acceleration, _) => "acceleration",
            (MotionCurve::Force, JointKind::Prismatic) => "force",
            (MotionCurve::Force, JointKind::Revolute) => "torque",
            (MotionCurve::Power, _) => "power",
        };
        format!("{name} [{}]", self.unit(actuator))
    }

    /// Returns the unit for an actuator.
    pub fn unit(self, actuator: JointKind) -> &'static str {
        let is_linear = actuator == JointKind::Prismatic;
        match self {
            MotionCurve::Position if is_linear => "m",
            MotionCurve::Position => "rad",
            MotionCurve::Speed if is_linear => "m/s",
            MotionCurve::Speed => "rad/s",
            MotionCurve::Acceleration if is_linear => "m/s²",
            MotionCurve::Acceleration => "rad/s²",
            MotionCurve::Force if is_linear => "N",
            MotionCurve::Force => "N·m",
            MotionCurve::Power => "W",
        }
    }

    /// Returns the value of each actuator at a sample, in the unit of [`MotionCurve::unit`].
    pub fn values(self, sample: &TaskSample) -> [f64; 3] {
        match self {
            MotionCurve::Position => sample.actuators,
            MotionCurve::Speed => sample.response.speeds,
            MotionCurve::Acceleration => sample.response.accelerations,
            MotionCurve::Force => sample.response.forces,
            MotionCurve::Power => sample.powers(),
        }
    }
}

/// What the colours of a path tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PathColor {
    /// The largest absolute value of a curve of the three actuators.
    Curve(MotionCurve),
    /// A field at each pose.
    Field(Field),
}

impl PathColor {
    /// What a path shows at first: the largest force of an actuator.
    pub const FORCE: PathColor = PathColor::Curve(MotionCurve::Force);

    /// Returns the name with its unit.
    pub fn title(self, actuator: JointKind) -> Cow<'static, str> {
        match self {
            PathColor::Curve(curve) => curve.title(actuator).into(),
            PathColor::Field(field) => field.title(),
        }
    }
}

/// The path of a motion, with a value at each of its points.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionPath {
    /// Poses along the path.
    pub poses: Vec<Pose>,
    /// Colour at each pose, as red, green and blue.
    pub colors: Vec<[u8; 3]>,
    /// Least and largest value, in the unit of the title.
    pub range: [f64; 2],
}

impl MotionPath {
    /// Computes the path of samples of a motion; `None` without samples. Of a very long motion, evenly chosen samples are drawn.
    pub fn new(model: &Model, design: &Design, samples: &[TaskSample], color: PathColor) -> Option<Self> {
        let step = samples.len().div_ceil(MOST_POINTS).max(1);
        let last = samples.last()?;
        let chosen: Vec<&TaskSample> = samples.iter().step_by(step).chain([last]).collect();
        let values = values(model, design, &chosen, color);
        let range = values
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                [low.min(*value), high.max(*value)]
            });
        let scale = match color {
            PathColor::Curve(_) => Scale::Linear,
            PathColor::Field(field) => field.scale(),
        };
        let threshold = match color {
            PathColor::Curve(_) => 0.0,
            PathColor::Field(field) => field.threshold(model),
        };
        let map = ColorMap::new(scale, range, threshold);
        let factor = match color {
            PathColor::Curve(_) => 1.0,
            PathColor::Field(field) => field.display_factor(),
        };
        Some(Self {
            poses: chosen.iter().map(|sample| sample.instant.pose).collect(),
            colors: values.iter().map(|value| map.color(*value)).collect(),
            range: range.map(|value| value * factor),
        })
    }
}

/// Returns the values that the colours of a path tell.
fn values(model: &Model, design: &Design, samples: &[&TaskSample], color: PathColor) -> Vec<f64> {
    match color {
        PathColor::Curve(curve) => samples
            .iter()
            .map(|sample| {
                curve
                    .values(sample)
                    .iter()
                    .fold(0.0f64, |most, value| most.max(value.abs()))
            })
            .collect(),
        PathColor::Field(field) => {
            let mut evaluator = model.pose_evaluator(design);
            field.ask(evaluator.as_mut());
            let at = |sample: &&TaskSample| {
                let Pose { position, phi } = sample.instant.pose;
                let values = evaluator.evaluate_position(&evaluator.arms(&Rotation::new(phi)), position);
                // A motion is followed where every leg reaches it.
                values.map_or(0.0, |values| field.value(model, design, &values))
            };
            samples.iter().map(at).collect()
        }
    }
}

/// Returns the pose of a motion at a time \[s\] from the beginning of its cycle: between samples on a straight line, and at rest after
/// each piece. `None` without samples.
pub fn pose_at(samples: &[TaskSample], time: f64) -> Option<Pose> {
    let next = samples.partition_point(|sample| sample.instant.time <= time);
    let before = samples.get(next.saturating_sub(1))?.instant;
    let Some(after) = samples.get(next).map(|sample| sample.instant) else {
        return Some(before.pose);
    };
    let span = after.time - before.time;
    if after.piece != before.piece || span <= 0.0 {
        return Some(before.pose);
    }
    let share = ((time - before.time) / span).clamp(0.0, 1.0);
    Some(Pose {
        position: DVec2::lerp(before.pose.position, after.pose.position, share),
        phi: before.pose.phi + share * (after.pose.phi - before.pose.phi),
    })
}
