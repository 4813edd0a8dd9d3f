//! Payload, motion and tolerances (docs/model.md, section 15).

use serde::{Deserialize, Serialize};

use super::declare::{Check, Initial, section};
use kinefront_model::dynamics::{MotionLaw, Task, TaskShape, TaskTiming};

section! {
    /// What the platform carries.
    pub struct PayloadSection in "payload" {
        /// Mass of the payload.
        mass_kg: f64 = 0.0, Check::Within(0.0, 1e12, " kg");
        /// Moment of inertia of the payload about z through its own centre of mass.
        inertia_kg_m2: f64 = 0.0, Check::Within(0.0, 1e12, " kg·m²");
        /// Centre of mass of the payload from `P`, in the axes of the platform.
        centre_m: [f64; 2] = [0.0; 2], Check::Within(-1e6, 1e6, " m");
    }
}

section! {
    /// Loads during a motion.
    pub struct LoadSection in "loads" {
        /// Acceleration of gravity, along the axes of the base; its part in the plane loads the actuators.
        gravity_m_per_s2: [f64; 3] = [0.0, 0.0, -9.81], Check::Within(-1e6, 1e6, "");
        /// Force that the surroundings exert on the platform at `P`, along the axes of the base.
        tool_force_n: [f64; 2] = [0.0; 2], Check::Within(-1e12, 1e12, " N");
        /// Moment about z that the surroundings exert on the platform.
        tool_moment_nm: f64 = 0.0, Check::Within(-1e12, 1e12, " N·m");
    }
}

section! {
    /// Motion and load that every pose of the workspace must allow in any direction.
    pub struct AnywhereSection in "anywhere" {
        /// Speed of `P`.
        v_m_per_s: f64 = 0.0, Check::Within(0.0, 1e9, "");
        /// Rate of rotation of the platform.
        omega_rad_per_s: f64 = 0.0, Check::Within(0.0, 1e9, "");
        /// Acceleration of `P`.
        a_m_per_s2: f64 = 0.0, Check::Within(0.0, 1e9, "");
        /// Angular acceleration of the platform.
        alpha_rad_per_s2: f64 = 0.0, Check::Within(0.0, 1e9, "");
        /// Force on the platform at `P`.
        force_n: f64 = 0.0, Check::Within(0.0, 1e12, " N");
        /// Moment on the platform about z.
        moment_nm: f64 = 0.0, Check::Within(0.0, 1e12, " N·m");
    }
}

section! {
    /// Errors of manufacture, assembly and control, each in both directions.
    pub struct ToleranceSection in "tolerances" {
        /// Error of a prismatic actuator.
        encoder_m: f64 = 0.0, Check::Within(0.0, 1e3, " m");
        /// Error of a revolute actuator.
        encoder_rad: f64 = 0.0, Check::Within(0.0, 1.0, " rad");
        /// Length error of each link; for a telescopic leg, the error of its zero position.
        link_m: f64 = 0.0, Check::Within(0.0, 1e3, " m");
        /// Radius of the disc in which each base joint, or each end of a rail, lies.
        base_m: f64 = 0.0, Check::Within(0.0, 1e3, " m");
        /// Radius of the disc in which each platform joint lies.
        platform_m: f64 = 0.0, Check::Within(0.0, 1e3, " m");
        /// Radial clearance of each revolute joint.
        play_m: f64 = 0.0, Check::Within(0.0, 1e3, " m");
    }
}

/// Path of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TaskShapeChoice {
    /// Straight from point to point.
    Waypoints,
    /// A circle about the centre of the workspace.
    Circle,
    /// A pentagram about the centre.
    Star,
    /// Across the workspace and back.
    PickAndPlace,
}

/// How a piece of a path is covered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionLawChoice {
    /// A polynomial of the fifth degree.
    Quintic,
    /// An acceleration in the shape of a trapezoid.
    Trapezoid,
}

/// Values that an editor starts from: time of a cycle \[s\], speed \[m/s\] and acceleration \[m/s²\] of `P`.
const FIRST_CYCLE: f64 = 2.0;
const FIRST_SPEED: f64 = 1.0;
const FIRST_ACCELERATION: f64 = 10.0;

section! {
    /// A motion that the platform makes again and again.
    pub struct TaskSection in "task" {
        /// Size of a path that is scaled to the workspace, as a fraction of the workspace radius.
        share: f64 = 0.8, Check::Within(1e-6, 1e3, "");
        /// Direction in which such a path begins.
        angle_deg: f64 = 0.0, Check::Within(-1e6, 1e6, "°");
        /// Rotation during a pick-and-place stroke.
        swing_deg: f64 = 0.0, Check::Within(-1e6, 1e6, "°");
        /// Whether the path returns to its first point; without effect for a circle and a star.
        closed: bool = true, Check::Any;
        /// How each piece of the path is covered from rest to rest.
        law: MotionLawChoice = MotionLawChoice::Quintic, Check::Choice(&["quintic", "trapezoid"]);
        /// Fraction of the time during which a `trapezoid` motion accelerates.
        blend: f64 = 1.0 / 3.0, Check::Within(1e-3, 0.5, "");
        /// Fraction of that time during which the acceleration rises, and during which it falls.
        ramp: f64 = 0.25, Check::Within(1e-3, 0.5, "");
        /// Rest after each piece.
        dwell_s: f64 = 0.0, Check::Within(0.0, 1e6, " s");
        /// Number of equal intervals in which each piece is sampled; all pieces together have at most 10⁶.
        samples: i64 = 200, Check::Count(2, 100_000);
        optional {
            /// Path: straight between `waypoints`, or a `circle`, a `star` or a `pick-and-place` stroke that is scaled to the workspace; if
            /// omitted, the study has no motion.
            shape: TaskShapeChoice, Check::Choice(&["pick-and-place", "circle", "star", "waypoints"]), Initial::AsText;
            /// Points of the path, as [x in metres, y in metres, φ in degrees]; angles are not wrapped.
            waypoints: Vec<[f64; 3]>, Check::Within(-1e6, 1e6, ""), Initial::AsText;
            /// Duration of the whole cycle, including rests; if omitted, the motion is as fast as its limits allow.
            cycle_time_s: f64, Check::Positive, Initial::Number(FIRST_CYCLE);
            /// Largest speed of `P`.
            v_max_m_per_s: f64, Check::Positive, Initial::Number(FIRST_SPEED);
            /// Largest acceleration of `P`.
            a_max_m_per_s2: f64, Check::Positive, Initial::Number(FIRST_ACCELERATION);
            /// Largest rate of rotation of the platform.
            omega_max_rad_per_s: f64, Check::Positive, Initial::Number(1.0);
            /// Largest angular acceleration of the platform.
            alpha_max_rad_per_s2: f64, Check::Positive, Initial::Number(10.0);
        }
    }
}

/// A key that is at fault, and what is wrong.
type Fault = (&'static str, String);

/// Largest number of samples of a motion.
const MOST_SAMPLES: i64 = 1_000_000;

impl TaskSection {
    /// Sets the path, with what else a new motion needs.
    pub fn go(&mut self, shape: TaskShapeChoice) {
        let before = self.clone();
        self.shape = Some(shape);
        self.settle(&before);
    }

    /// Makes the settings agree after one of them was changed by hand: a path of waypoints has them and no other has, and either the time
    /// of a cycle or limits state how fast the motion is.
    pub fn settle(&mut self, before: &Self) {
        let Some(shape) = self.shape else { return };
        let is_of_points = shape == TaskShapeChoice::Waypoints;
        let points = self.waypoints.take().filter(|_| is_of_points);
        let across = || vec![[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]];
        self.waypoints = is_of_points.then(|| points.unwrap_or_else(across));
        match (
            self.cycle_time_s.is_some(),
            self.limits().iter().any(|(_, limit)| limit.is_some()),
        ) {
            (true, true) if before.cycle_time_s.is_some() => self.cycle_time_s = None,
            (true, true) => {
                self.v_max_m_per_s = None;
                self.a_max_m_per_s2 = None;
                self.omega_max_rad_per_s = None;
                self.alpha_max_rad_per_s2 = None;
            }
            (false, false) if before.cycle_time_s.is_some() => {
                self.v_max_m_per_s = Some(FIRST_SPEED);
                self.a_max_m_per_s2 = Some(FIRST_ACCELERATION);
            }
            (false, false) => self.cycle_time_s = Some(FIRST_CYCLE),
            _ => {}
        }
    }

    /// Returns the limits of the motion, with their keys.
    fn limits(&self) -> [(&'static str, Option<f64>); 4] {
        [
            ("v_max_m_per_s", self.v_max_m_per_s),
            ("a_max_m_per_s2", self.a_max_m_per_s2),
            ("omega_max_rad_per_s", self.omega_max_rad_per_s),
            ("alpha_max_rad_per_s2", self.alpha_max_rad_per_s2),
        ]
    }

    /// Sets the path to straight lines between points \[m, m, deg\].
    pub fn go_along(&mut self, points: Vec<[f64; 3]>) {
        self.waypoints = Some(points);
        self.go(TaskShapeChoice::Waypoints);
    }

    /// Returns the points of the path.
    fn points(&self) -> &[[f64; 3]] {
        self.waypoints.as_deref().unwrap_or_default()
    }

    /// Returns the motion that the section asks for; `None` if it asks for none.
    pub fn task(&self) -> Option<Task> {
        Some(Task {
            shape: match self.shape? {
                TaskShapeChoice::Waypoints => TaskShape::Waypoints(
                    self.points()
                        .iter()
                        .map(|[x, y, phi_deg]| [*x, *y, phi_deg.to_radians()])
                        .collect(),
                ),
                TaskShapeChoice::Circle => TaskShape::Circle,
                TaskShapeChoice::Star => TaskShape::Star,
                TaskShapeChoice::PickAndPlace => TaskShape::PickAndPlace {
                    swing: self.swing_deg.to_radians(),
                },
            },
            share: self.share,
            angle: self.angle_deg.to_radians(),
            closed: self.closed,
            law: match self.law {
                MotionLawChoice::Quintic => MotionLaw::Quintic,
                MotionLawChoice::Trapezoid => MotionLaw::Trapezoid {
                    blend: self.blend,
                    ramp: self.ramp,
                },
            },
            dwell: self.dwell_s,
            samples: usize::try_from(self.samples).unwrap_or(1),
            timing: match self.cycle_time_s {
                Some(time) => TaskTiming::Cycle(time),
                None => TaskTiming::Limits {
                    velocity: self.v_max_m_per_s,
                    acceleration: self.a_max_m_per_s2,
                    omega: self.omega_max_rad_per_s,
                    alpha: self.alpha_max_rad_per_s2,
                },
            },
        })
    }

    /// Returns the keys that are at fault together with others, and what is wrong.
    pub(crate) fn faults(&self) -> Vec<Fault> {
        let (Some(shape), Some(task)) = (self.shape, self.task()) else {
            let words = "is missing; without it, nothing else in [task] has an effect";
            let is_stated = *self != Self::default();
            return is_stated.then(|| ("shape", words.to_owned())).into_iter().collect();
        };
        let pieces = task.pieces() as i64;
        let mut faults = self.faults_of_path(shape, pieces);
        faults.extend(self.faults_of_timing(shape, pieces));
        faults
    }

    fn faults_of_path(&self, shape: TaskShapeChoice, pieces: i64) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut fault = |key, message: String| faults.push((key, message));
        let is_of_points = shape == TaskShapeChoice::Waypoints;
        if is_of_points {
            let differ = self.points().windows(2).any(|pair| pair[0] != pair[1]);
            if !differ {
                let count = self.points().len();
                fault(
                    "waypoints",
                    format!("has {count} entries; a path needs at least two different points"),
                );
            }
        } else if self.waypoints.is_some() {
            fault(
                "waypoints",
                "has no effect; set shape = \"waypoints\", or omit it".to_owned(),
            );
        }
        if pieces.saturating_mul(self.samples) > MOST_SAMPLES {
            let key = if is_of_points { "waypoints" } else { "samples" };
            fault(
                key,
                format!(
                    "makes {pieces} pieces of {} samples; a motion has at most {MOST_SAMPLES} samples, so that fewer points or \
                     samples are needed",
                    self.samples
                ),
            );
        }
        faults
    }

    fn faults_of_timing(&self, shape: TaskShapeChoice, pieces: i64) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut fault = |key, message: String| faults.push((key, message));
        let limits = self.limits();
        match self.cycle_time_s {
            Some(time) => {
                for (key, limit) in limits {
                    if limit.is_some() {
                        fault(
                            key,
                            "has no effect together with cycle_time_s; omit one of the two".to_owned(),
                        );
                    }
                }
                let resting = self.dwell_s * pieces as f64;
                if time <= resting {
                    let message = format!(
                        "is {time}, but the rests after {pieces} pieces take {resting} s of it; it must be longer than that"
                    );
                    fault("cycle_time_s", message);
                }
            }
            None if limits.iter().all(|(_, limit)| limit.is_none()) => fault(
                "cycle_time_s",
                "is missing; set it, or limits such as v_max_m_per_s and a_max_m_per_s2".to_owned(),
            ),
            None => {
                let moves = |index: usize| self.points().windows(2).any(|pair| pair[0][index] != pair[1][index]);
                let turns = match shape {
                    TaskShapeChoice::Waypoints => moves(2),
                    TaskShapeChoice::PickAndPlace => self.swing_deg != 0.0,
                    _ => false,
                };
                let shifts = shape != TaskShapeChoice::Waypoints || moves(0) || moves(1);
                let is_bound = shifts && limits[..2].iter().any(|(_, limit)| limit.is_some())
                    || turns && limits[2..].iter().any(|(_, limit)| limit.is_some());
                if !is_bound {
                    let key = if shifts { limits[0].0 } else { limits[2].0 };
                    fault(
                        key,
                        "is missing; nothing else limits how fast the platform moves along the path".to_owned(),
                    );
                }
            }
        }
        faults
    }
}
