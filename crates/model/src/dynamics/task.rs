//! Motions that a task asks for: paths, and how the platform moves along them (docs/model.md, section 15.6).

use glam::DVec2;

use super::Motion;
use super::law::MotionLaw;
use crate::polygon::Polygon;
use crate::spatial::Pose;

/// What the platform moves along.
#[derive(Debug, Clone, PartialEq)]
pub enum TaskShape {
    /// Straight from point to point: `x`, `y` \[m\] and `φ` \[rad\], which is not wrapped.
    Waypoints(Vec<[f64; 3]>),
    /// A circle about the centre of the workspace, counter-clockwise, at the home orientation.
    Circle,
    /// Five strokes between the corners of a pentagram about the centre, at the home orientation.
    Star,
    /// From one side of the workspace to the other and back, turning by a swing \[rad\] about the home orientation.
    PickAndPlace {
        /// The swing.
        swing: f64,
    },
}

/// How long a motion takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TaskTiming {
    /// The whole cycle, with the dwells \[s\].
    Cycle(f64),
    /// As fast as limits allow; `None` does not limit.
    Limits {
        /// Speed of `P` \[m/s\].
        velocity: Option<f64>,
        /// Acceleration of `P` \[m/s²\].
        acceleration: Option<f64>,
        /// Rate of rotation \[rad/s\].
        omega: Option<f64>,
        /// Angular acceleration \[rad/s²\].
        alpha: Option<f64>,
    },
}

/// A motion that a study asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Task {
    /// The path.
    pub shape: TaskShape,
    /// Size of a path that is scaled to the workspace, as a share of its radius.
    pub share: f64,
    /// Direction in which such a path begins \[rad\].
    pub angle: f64,
    /// Whether the path returns to its first point; without effect for a circle.
    pub closed: bool,
    /// How each piece is covered.
    pub law: MotionLaw,
    /// Rest after each piece \[s\].
    pub dwell: f64,
    /// Number of equal intervals in which each piece is sampled.
    pub samples: usize,
    /// How long the motion takes.
    pub timing: TaskTiming,
}

/// The workspace to which a path is scaled.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskFrame {
    /// Centre \[m\].
    pub centre: DVec2,
    /// `R_w` \[m\].
    pub radius: f64,
    /// Outline of a prescribed region that is no disc, about the centre: it holds more than the disc.
    pub polygon: Option<Polygon>,
    /// `φ_c` \[rad\].
    pub home_phi: f64,
    /// Half the rotation range \[rad\].
    pub half_range: f64,
    /// `r` of the design, by which angular accelerations compare with others \[m\].
    pub lever: f64,
}

/// A piece of a path, from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Piece {
    /// Straight in all coordinates.
    Straight { from: [f64; 3], by: [f64; 3] },
    /// A full turn about a point.
    Circle { centre: DVec2, arm: DVec2, phi: f64 },
}

/// A moment of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskInstant {
    /// Time from the beginning of the cycle \[s\].
    pub time: f64,
    /// Piece, from 0.
    pub piece: usize,
    /// Pose of the platform.
    pub pose: Pose,
    /// Its velocities and accelerations.
    pub motion: Motion,
}

/// A motion in time.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskMotion {
    pub(super) pieces: Vec<Piece>,
    /// Durations of the pieces, without the dwells \[s\].
    durations: Vec<f64>,
    pub(super) law: MotionLaw,
    dwell: f64,
    samples: usize,
}

impl Piece {
    fn between(from: [f64; 3], to: [f64; 3]) -> Option<Self> {
        let by = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
        (by != [0.0; 3]).then_some(Self::Straight { from, by })
    }

    /// Returns the pose, and its derivatives by the share of the path, of which the motion follows.
    fn at(&self, [way, speed, acceleration]: [f64; 3]) -> (Pose, Motion) {
        match self {
            Piece::Straight { from, by } => {
                let at = [0, 1, 2].map(|k| from[k] + by[k] * way);
                let motion = Motion {
                    twist: by.map(|by| by * speed),
                    acceleration: by.map(|by| by * acceleration),
                };
                (Pose::new(at[0], at[1], at[2]), motion)
            }
            Piece::Circle { centre, arm, phi } => {
                let turn = 2.0 * std::f64::consts::PI;
                let (sine, cosine) = (libm::sin(turn * way), libm::cos(turn * way));
                let out = *arm * cosine + arm.perp() * sine;
                let along = out.perp();
                let velocity = along * (turn * speed);
                let towards = along * (turn * acceleration) - out * (turn * speed * turn * speed);
                let at = *centre + out;
                let motion = Motion {
                    twist: [velocity.x, velocity.y, 0.0],
                    acceleration: [towards.x, towards.y, 0.0],
                };
                (Pose::new(at.x, at.y, *phi), motion)
            }
        }
    }
}

impl Task {
    /// Returns the number of pieces of a path.
    pub fn pieces(&self) -> usize {
        match &self.shape {
            TaskShape::Waypoints(points) if self.closed => points.len(),
            TaskShape::Waypoints(points) => points.len().saturating_sub(1),
            TaskShape::Circle => 1,
            TaskShape::Star => 5,
            TaskShape::PickAndPlace { .. } => 1 + usize::from(self.closed),
        }
    }

    /// Returns whether the path is scaled to the workspace.
    pub fn is_scaled(&self) -> bool {
        !matches!(self.shape, TaskShape::Waypoints(_))
    }

    /// Returns the motion in a workspace; `None` if the path has no length, or if it is scaled to a workspace that does not exist.
    pub fn motion(&self, frame: &TaskFrame) -> Option<TaskMotion> {
        let pieces = self.path(frame);
        if pieces.is_empty() {
            return None;
        }
        let peaks: Vec<[f64; 4]> = pieces.iter().map(|piece| self.peaks(piece)).collect();
        let durations: Vec<f64> = match self.timing {
            TaskTiming::Cycle(time) => {
                let moving = time - self.dwell * pieces.len() as f64;
                let weights = peaks
                    .iter()
                    .map(|[_, acceleration, _, alpha]| acceleration.max(frame.lever * alpha).sqrt());
                let weights: Vec<f64> = weights.collect();
                let all: f64 = weights.iter().sum();
                weights.iter().map(|weight| moving * weight / all).collect()
            }
            TaskTiming::Limits {
                velocity,
                acceleration,
                omega,
                alpha,
            } => {
                let time = |peak: f64, limit: Option<f64>| limit.map_or(0.0, |limit| peak / limit);
                let of = |peaks: &[f64; 4]| {
                    time(peaks[0], velocity)
                        .max(time(peaks[1], acceleration).sqrt())
                        .max(time(peaks[2], omega))
                        .max(time(peaks[3], alpha).sqrt())
                };
                peaks.iter().map(of).collect()
            }
        };
        let moves = durations.iter().all(|time| *time > 0.0 && time.is_finite());
        moves.then_some(TaskMotion {
            pieces,
            durations,
            law: self.law,
            dwell: self.dwell,
            samples: self.samples,
        })
    }

    fn path(&self, frame: &TaskFrame) -> Vec<Piece> {
        let reach = self.share * frame.radius;
        let scaled_to_nothing = self.is_scaled() && reach <= 0.0;
        if scaled_to_nothing {
            return Vec::new();
        }
        let towards = |angle: f64| DVec2::new(libm::cos(angle), libm::sin(angle));
        let point = |at: DVec2, phi: f64| [at.x, at.y, phi];
        let mut points: Vec<[f64; 3]> = match &self.shape {
            TaskShape::Circle => {
                return vec![Piece::Circle {
                    centre: frame.centre,
                    arm: towards(self.angle) * reach,
                    phi: frame.home_phi,
                }];
            }
            TaskShape::Waypoints(points) => points.clone(),
            TaskShape::Star => (0..5)
                .map(|corner| {
                    let angle = self.angle + f64::from(corner) * 144f64.to_radians();
                    point(frame.centre + towards(angle) * reach, frame.home_phi)
                })
                .collect(),
            TaskShape::PickAndPlace { swing } => [-1.0, 1.0]
                .map(|side| {
                    let at = frame.centre + towards(self.angle) * (side * reach);
                    point(at, frame.home_phi + side * 0.5 * swing)
                })
                .to_vec(),
        };
        // A star is a closed figure.
        if self.closed || self.shape == TaskShape::Star {
            points.extend(points.first().copied());
        }
        points
            .windows(2)
            .filter_map(|pair| Piece::between(pair[0], pair[1]))
            .collect()
    }

    /// Returns the largest speed, acceleration, rate of rotation and angular acceleration of a piece that takes a unit of time.
    fn peaks(&self, piece: &Piece) -> [f64; 4] {
        let sizes = |[x, y, turn]: [f64; 3]| [(x * x + y * y).sqrt(), turn.abs()];
        (0..=self.samples).fold([0.0; 4], |most, sample| {
            let (_, motion) = piece.at(self.law.at(sample as f64 / self.samples as f64));
            let ([velocity, omega], [acceleration, alpha]) = (sizes(motion.twist), sizes(motion.acceleration));
            let found = [velocity, acceleration, omega, alpha];
            [0, 1, 2, 3].map(|k: usize| f64::max(most[k], found[k]))
        })
    }
}

impl TaskMotion {
    /// Returns the durations of the pieces, without the dwells \[s\].
    pub fn durations(&self) -> &[f64] {
        &self.durations
    }

    /// Returns the rest after each piece \[s\].
    pub fn dwell(&self) -> f64 {
        self.dwell
    }

    /// Returns the time of a cycle, with the dwells \[s\].
    pub fn cycle_time(&self) -> f64 {
        let moving: f64 = self.durations.iter().sum();
        moving + self.dwell * self.durations.len() as f64
    }

    /// Iterates over the times at which the pieces begin \[s\].
    pub(crate) fn begins(&self) -> impl Iterator<Item = f64> + '_ {
        self.durations.iter().scan(0.0, |begin, duration| {
            let start = *begin;
            *begin += duration + self.dwell;
            Some(start)
        })
    }

    /// Iterates over the samples, both ends of each piece included.
    pub fn instants(&self) -> impl Iterator<Item = TaskInstant> + '_ {
        self.begins().enumerate().flat_map(move |(place, start)| {
            (0..=self.samples).map(move |sample| self.instant(place, start, sample as f64 / self.samples as f64))
        })
    }

    /// Iterates over the cycle in equal steps of time \[s\], and ends with the end of the cycle. After each piece the platform rests.
    pub fn at_steps(&self, step: f64) -> impl Iterator<Item = TaskInstant> + '_ {
        let cycle = self.cycle_time();
        // What rounding adds to the cycle is no step of its own.
        let steps = (cycle / step - 1e-9).ceil() as usize;
        let (mut place, mut start) = (0, 0.0);
        (0..=steps).map(move |count| {
            let time = (count as f64 * step).min(cycle);
            while place + 1 < self.durations.len() && time >= start + self.durations[place] + self.dwell {
                start += self.durations[place] + self.dwell;
                place += 1;
            }
            let share = ((time - start) / self.durations[place]).clamp(0.0, 1.0);
            TaskInstant {
                time,
                ..self.instant(place, start, share)
            }
        })
    }

    /// Iterates over the moments at which the platform comes to rest: the beginning, and the end of each piece.
    pub fn rests(&self) -> impl Iterator<Item = TaskInstant> + '_ {
        let ends = self.begins().enumerate();
        let ends = ends.map(|(place, start)| self.instant(place, start, 1.0));
        std::iter::once(self.instant(0, 0.0, 0.0)).chain(ends)
    }

    /// Returns the moment at a share of the time of a piece, which begins at `start` \[s\].
    fn instant(&self, place: usize, start: f64, share: f64) -> TaskInstant {
        let duration = self.durations[place];
        let [way, speed, acceleration] = self.law.at(share);
        let (pose, motion) = self.pieces[place].at([way, speed / duration, acceleration / (duration * duration)]);
        TaskInstant {
            time: start + share * duration,
            piece: place,
            pose,
            motion,
        }
    }
}
