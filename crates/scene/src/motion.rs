//! A motion that a design follows: curves of its actuators, and its path with colours.

use std::borrow::Cow;

use glam::DVec2;
use kinefront_model::evaluation::{Model, Scale, TaskSample, largest_of_legs};
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

    /// Returns the name for a kind of actuator.
    pub fn name(self, actuator: JointKind) -> &'static str {
        match (self, actuator) {
            (MotionCurve::Position, _) => "position",
            (MotionCurve::Speed, _) => "speed",
            (MotionCurve::Acceleration, _) => "acceleration",
            (MotionCurve::Force, JointKind::Prismatic) => "force",
            (MotionCurve::Force, JointKind::Revolute) => "torque",
            (MotionCurve::Power, _) => "power",
        }
    }

    /// Returns the unit for a kind of actuator.
    pub fn unit(self, actuator: JointKind) -> String {
        match self {
            MotionCurve::Position => actuator.unit().to_owned(),
            MotionCurve::Speed => format!("{}/s", actuator.unit()),
            MotionCurve::Acceleration => format!("{}/s²", actuator.unit()),
            MotionCurve::Force => actuator.effort_unit().to_owned(),
            MotionCurve::Power => "W".to_owned(),
        }
    }

    /// Returns the name with the unit for a kind of actuator.
    pub fn title(self, actuator: JointKind) -> String {
        format!("{} [{}]", self.name(actuator), self.unit(actuator))
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
    /// Computes the path of samples of a motion; `None` without samples.
    pub fn new(model: &Model, design: &Design, samples: &[TaskSample], color: PathColor) -> Option<Self> {
        let chosen = drawn_samples(samples);
        chosen.first()?;
        let (values, map, factor) = match color {
            PathColor::Curve(curve) => {
                let largest = |sample: &&TaskSample| largest_of_legs(curve.values(sample));
                let values: Vec<f64> = chosen.iter().map(largest).collect();
                let map = ColorMap::new(Scale::Linear, range(&values), 0.0);
                (values, map, 1.0)
            }
            PathColor::Field(field) => {
                let values = values_of_field(model, design, &chosen, field);
                let map = ColorMap::new(field.scale(), range(&values), field.threshold(model));
                (values, map, field.display_factor())
            }
        };
        Some(Self {
            poses: chosen.iter().map(|sample| sample.instant.pose).collect(),
            colors: values.iter().map(|value| map.color(*value)).collect(),
            range: range(&values).map(|value| value * factor),
        })
    }
}

/// Returns the samples of a motion that are drawn: of a very long one, evenly chosen samples and the last one.
pub fn drawn_samples(samples: &[TaskSample]) -> Vec<&TaskSample> {
    let Some((last, others)) = samples.split_last() else {
        return Vec::new();
    };
    let step = samples.len().div_ceil(MOST_POINTS);
    others.iter().step_by(step).chain([last]).collect()
}

fn range(values: &[f64]) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    values
        .iter()
        .fold(none, |[low, high], value| [low.min(*value), high.max(*value)])
}

/// Returns the values of a field at samples, which every leg reaches.
fn values_of_field(model: &Model, design: &Design, samples: &[&TaskSample], field: Field) -> Vec<f64> {
    let mut evaluator = model.pose_evaluator(design);
    field.ask(evaluator.as_mut());
    let at = |sample: &&TaskSample| {
        let Pose { position, phi } = sample.instant.pose;
        let values = evaluator.evaluate_position(&evaluator.arms(&Rotation::new(phi)), position);
        values.map_or(0.0, |values| field.value(model, design, &values))
    };
    samples.iter().map(at).collect()
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
