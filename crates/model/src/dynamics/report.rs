//! The motion of a design at one pose in full.

use super::DynamicsModel;
use super::bar_shape::BarShape;
use super::displacement::{Coordinates, Own, Row, full};
use super::effort::norm;
use super::error::{LegErrors, PoseErrors};
use super::frequency::lowest_frequency;
use super::inverse::DriveMotion;
use super::legs::{DynamicsInputs, MovingLeg};
use super::settings::Tolerances;
use crate::mechanism::AnyLeg;
use crate::spatial::{LEGS, Pose, Rotation};
use crate::strength::path::BARS;
use glam::DVec2;
use nalgebra::{Matrix3, SymmetricEigen};

/// A motion of the platform at a pose: velocities and accelerations of `P` and of the rotation, in base axes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Motion {
    /// `vx`, `vy` \[m/s\] and `ω` \[rad/s\].
    pub twist: [f64; 3],
    /// `ax`, `ay` \[m/s²\] and `α` \[rad/s²\].
    pub acceleration: [f64; 3],
}

/// What the actuators do during a motion; prismatic ones in metres and newtons, revolute ones in radians and newton metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Rates of the actuators.
    pub speeds: [f64; LEGS],
    /// Their accelerations.
    pub accelerations: [f64; LEGS],
    /// Forces or torques of the actuators, along the joint values.
    pub forces: [f64; LEGS],
}

/// What a unit of motion or load in any direction asks of the actuator that has to give most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gains {
    /// Speed of an actuator for a unit speed of `P`, and for a unit rate of rotation.
    pub speed: [f64; 2],
    /// Force of an actuator for a unit force, and for a unit moment.
    pub force: [f64; 2],
    /// Force of an actuator for a unit acceleration of `P`, and for a unit angular acceleration.
    pub inertia: [f64; 2],
}

/// Parts of an error by what causes them; they sum to the error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorBudget {
    /// Errors of the actuators.
    pub encoders: f64,
    /// Errors of the lengths of the links.
    pub links: f64,
    /// Errors of the places of the base joints.
    pub base: f64,
    /// Errors of the places of the platform joints.
    pub platform: f64,
    /// Clearance of the revolute joints.
    pub play: f64,
}

impl ErrorBudget {
    /// Returns the parts with their names, in the order of the settings.
    pub fn parts(&self) -> [(&'static str, f64); 5] {
        [
            ("encoders", self.encoders),
            ("links", self.links),
            ("base", self.base),
            ("platform", self.platform),
            ("play", self.play),
        ]
    }
}

/// Error of the pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Largest error of the position \[m\].
    pub worst_position: f64,
    /// Largest error of the orientation \[rad\].
    pub worst_orientation: f64,
    /// Root mean square of the error of the position \[m\].
    pub rms_position: f64,
    /// Root mean square of the error of the orientation \[rad\].
    pub rms_orientation: f64,
    /// Variances of the error of the position along x and along y, and their covariance \[m²\].
    pub covariance: [f64; 3],
    /// Parts of the largest error of the position that each source has, in the direction in which it occurs \[m\].
    pub budget_position: ErrorBudget,
    /// Parts of the largest error of the orientation that each source has \[rad\].
    pub budget_orientation: ErrorBudget,
    /// Largest relative change of `det A` within the error: the errors are right to a tenth up to 0.1, and unreliable above 0.3.
    pub nonlinearity: f64,
}

/// Motion of a design at a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DynamicsReport {
    /// Natural frequencies: three in the plane, and three out of it, each in increasing order \[Hz\]; `None` on rails that bend.
    pub frequencies: Option<[[f64; 3]; 2]>,
    /// How the platform moves in each of these vibrations, to any scale: `x`, `y`, `φz` in the plane, and `z`, `φx`, `φy` out of it.
    pub shapes: Option<[[[f64; 3]; 3]; 2]>,
    /// Frequency of the bending of the leg bars themselves, which the natural frequencies do not contain \[Hz\].
    pub bar_frequency: f64,
    /// Mass that a vibration moves in the plane, at `P`, for `x`, `y`, `φz` \[kg, kg·m, kg·m²\].
    pub mass_in_plane: [[f64; 3]; 3],
    /// Mass that a vibration moves out of the plane, at `P`, for `z`, `φx`, `φy` \[kg, kg·m, kg·m²\].
    pub mass_out_of_plane: [[f64; 3]; 3],
    /// Mass of the rigid bodies at `P`, for `x`, `y`, `φz` \[kg, kg·m, kg·m²\].
    pub rigid_mass: [[f64; 3]; 3],
    /// Gains.
    pub gains: Gains,
    /// Largest speed of an actuator for the motion in any direction \[m/s or rad/s\].
    pub anywhere_speed: f64,
    /// Largest force of an actuator for the motion and load in any direction, from rest \[N or N·m\].
    pub anywhere_force: f64,
    /// Error of the pose.
    pub accuracy: Accuracy,
}

impl DynamicsReport {
    /// Returns the lowest natural frequency \[Hz\]; `None` on rails that bend.
    pub fn lowest_frequency(&self) -> Option<f64> {
        let [in_plane, out_of_plane] = self.frequencies?;
        Some(in_plane[0].min(out_of_plane[0]))
    }
}

/// Returns the natural frequencies of a block with its mass, in increasing order \[Hz\], and how the platform moves at each; `None` where
/// the mass is not positive definite.
fn vibrations(stiffness: &[f64; 6], mass: &[f64; 6]) -> Option<([f64; 3], [[f64; 3]; 3])> {
    let matrix = |m: &[f64; 6]| Matrix3::from(full(m));
    let factor = matrix(mass).cholesky()?.l();
    let half = factor.solve_lower_triangular(&matrix(stiffness))?;
    let reduced = factor.solve_lower_triangular(&half.transpose())?;
    let symmetric = (reduced + reduced.transpose()) * 0.5;
    let found = SymmetricEigen::new(symmetric);
    let mut order = [0, 1, 2];
    order.sort_by(|&a: &usize, &b: &usize| found.eigenvalues[a].total_cmp(&found.eigenvalues[b]));
    let mut frequencies = order.map(|k| found.eigenvalues[k].max(0.0).sqrt() / (2.0 * std::f64::consts::PI));
    // The smallest one is most accurate from the inverse.
    let lowest = lowest_frequency(stiffness, mass);
    if lowest.is_finite() {
        frequencies[0] = lowest;
    }
    let shapes = factor.tr_solve_lower_triangular(&found.eigenvectors)?;
    Some((frequencies, order.map(|k| shapes.column(k).into_owned().into())))
}

/// Returns the largest length of the linear part of some rows, and the largest magnitude of their rotational part.
fn largest(rows: &[[f64; 3]; LEGS]) -> [f64; 2] {
    rows.iter().fold([0.0, 0.0], |[linear, angular]: [f64; 2], row| {
        [linear.max(norm(row)), angular.max(row[2].abs())]
    })
}

/// A point of a bar, and how a displacement of the platform at `P` moves it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VibratingPoint {
    /// Where it is \[m\].
    pub place: DVec2,
    /// Displacement along x and along y for a unit of `x`, `y` and `φz`.
    pub in_plane: [[f64; 3]; 2],
    /// Displacement along z for a unit of `z`, `φx` and `φy`.
    pub lift: [f64; 3],
}

/// A bar of a leg or of the platform in a vibration.
#[derive(Debug, Clone, PartialEq)]
pub struct VibratingBar {
    /// Leg, from 0.
    pub leg: usize,
    /// Place of the bar: 0 for that at the base, 1 for the one that ends at `C`, and 2 for that of the platform.
    pub bar: usize,
    /// Points from the base towards the platform.
    pub points: Vec<VibratingPoint>,
}

/// Number of stretches into which a bar is divided to show how it bends.
const STRETCHES: usize = 12;

/// Shares of the length of a bar at which it is shown.
fn shares() -> impl Iterator<Item = f64> {
    (0..=STRETCHES).map(|count| count as f64 / STRETCHES as f64)
}

impl DynamicsModel {
    /// Returns what the actuators do during a motion under the loads of the settings.
    pub fn response(&self, inputs: &DynamicsInputs<f64>, motion: &Motion) -> Response {
        let legs = self.legs(inputs);
        let loads = (self.gravity(0.0), self.settings.tool);
        let drives = self.drives(inputs, &legs, motion.twist, motion.acceleration, loads);
        let of = |value: fn(&DriveMotion<f64>) -> f64| [value(&drives[0]), value(&drives[1]), value(&drives[2])];
        Response {
            speeds: of(|drive| drive.speed),
            accelerations: of(|drive| drive.acceleration),
            forces: of(|drive| drive.force),
        }
    }

    /// Returns the motion of a design at a pose; `None` at a singular one.
    pub fn report(
        &self,
        inputs: &DynamicsInputs<f64>,
        pose: &Pose,
        legs_of: &[AnyLeg; LEGS],
        actuators: &[f64; LEGS],
    ) -> Option<DynamicsReport> {
        let legs = self.legs(inputs);
        let in_plane = self.mass_in_plane(inputs, &legs, Own);
        let out_of_plane = self.mass_out_of_plane(inputs, &legs, Own);
        let rigid = self.rigid_mass(inputs, &legs);
        let effort = self.effort_rows(&legs, &rigid);
        let errors = self.leg_errors(inputs, &legs);
        let found = self.pose_errors(&errors);
        let longest = self.longest_bar(&legs);
        let vibrations = match self.is_on_bending_rails {
            true => None,
            false => Some([
                vibrations(&inputs.legs.in_plane(), &in_plane)?,
                vibrations(&inputs.legs.out_of_plane(), &out_of_plane)?,
            ]),
        };
        let direction = [found.direction.x, found.direction.y, 0.0];
        let report = DynamicsReport {
            frequencies: vibrations.map(|both| both.map(|(frequencies, _)| frequencies)),
            shapes: vibrations.map(|both| both.map(|(_, shapes)| shapes)),
            bar_frequency: std::f64::consts::FRAC_PI_2 * (self.bar_bending / (longest * longest * longest)).sqrt(),
            mass_in_plane: full(&in_plane),
            mass_out_of_plane: full(&out_of_plane),
            rigid_mass: rigid,
            gains: Gains {
                speed: largest(&effort.speed),
                force: largest(&effort.force),
                inertia: largest(&effort.inertia),
            },
            anywhere_speed: self.largest_speed(&effort.speed),
            anywhere_force: self.largest_force(inputs, &legs, &effort),
            accuracy: Accuracy {
                worst_position: found.worst_position,
                worst_orientation: found.worst_orientation,
                rms_position: found.rms[0],
                rms_orientation: found.rms[1],
                covariance: self.covariance(&errors),
                budget_position: self.budget(inputs, &legs, direction),
                budget_orientation: self.budget(inputs, &legs, [0.0, 0.0, 1.0]),
                nonlinearity: self.nonlinearity(&errors, &found, pose, legs_of, actuators),
            },
        };
        report.anywhere_force.is_finite().then_some(report)
    }

    /// Returns the parts of the largest error in a direction: that of each source is the error without all others, because errors add up.
    fn budget(&self, inputs: &DynamicsInputs<f64>, legs: &[MovingLeg<f64>; LEGS], direction: [f64; 3]) -> ErrorBudget {
        let all = self.settings.tolerances;
        let part = |tolerances: Tolerances| {
            let mut alone = *self;
            alone.settings.tolerances = tolerances;
            alone.worst_along(&alone.leg_errors(inputs, legs), &direction)
        };
        let none = Tolerances::default();
        ErrorBudget {
            encoders: part(Tolerances {
                encoder_prismatic: all.encoder_prismatic,
                encoder_revolute: all.encoder_revolute,
                ..none
            }),
            links: part(Tolerances { link: all.link, ..none }),
            base: part(Tolerances { base: all.base, ..none }),
            platform: part(Tolerances {
                platform: all.platform,
                ..none
            }),
            play: part(Tolerances { play: all.play, ..none }),
        }
    }

    /// Returns how the bars move with the platform in a vibration.
    pub fn vibrating_bars(&self, inputs: &DynamicsInputs<f64>) -> Vec<VibratingBar> {
        let legs = self.legs(inputs);
        let mut bars = Vec::new();
        for (index, leg) in legs.iter().enumerate() {
            let mut unused = [0.0; 6];
            let mut in_plane = [const { Vec::new() }; BARS];
            self.add_leg_in_plane(&mut unused, leg, inputs.legs.along[index], Own, |bar, ends| {
                let lanes = &leg.path.bars[bar];
                let shape = BarShape::new(lanes.length, ends);
                let axis = lanes.axis;
                let moved = |share: f64| {
                    let [across, along] = shape.at_share(lanes.length, share);
                    let towards = |of_axis: f64, of_normal: f64| {
                        [0, 1, 2].map(|k: usize| of_axis * along[k] + of_normal * across[k])
                    };
                    [towards(axis.x, -axis.y), towards(axis.y, axis.x)]
                };
                in_plane[bar] = shares().map(moved).collect();
            });
            let forces = Own.forces(&inputs.legs.stiffness[index]);
            self.add_leg_out_of_plane(&mut unused, leg, &forces, Own, |bar, ends| {
                let lanes = &leg.path.bars[bar];
                let shape = BarShape::new(lanes.length, ends);
                let point = |(share, in_plane): (f64, &[Row<f64>; 2])| {
                    let place = inputs.position.plus(lanes.place(lanes.length * share));
                    VibratingPoint {
                        place: DVec2::new(place.x, place.y),
                        in_plane: *in_plane,
                        lift: shape.at_share(lanes.length, share)[0],
                    }
                };
                bars.push(VibratingBar {
                    leg: index,
                    bar,
                    points: shares().zip(&in_plane[bar]).map(point).collect(),
                });
            });
        }
        bars
    }

    /// Returns the length of the longest bar of any leg \[m\].
    fn longest_bar(&self, legs: &[MovingLeg<f64>; LEGS]) -> f64 {
        let bars = legs.iter().flat_map(|leg| &leg.path.bars[self.paths[0].first..2]);
        bars.fold(0.0, |most, bar| bar.length.max(most))
    }

    /// Returns the largest relative change of `det A` where the error that attains the worst case moves the platform either way, while
    /// the actuated joints stay where they are.
    fn nonlinearity(
        &self,
        errors: &[LegErrors<f64>; LEGS],
        found: &PoseErrors<f64>,
        pose: &Pose,
        legs: &[AnyLeg; LEGS],
        actuators: &[f64; LEGS],
    ) -> f64 {
        let shares = errors.map(|leg| found.direction.x * leg.column[0] + found.direction.y * leg.column[1]);
        let mut error = [0.0; 3];
        let mut add = |column: &[f64; 3], by: f64| {
            for (sum, part) in error.iter_mut().zip(column) {
                *sum += part * by;
            }
        };
        for (leg, share) in errors.iter().zip(shares) {
            add(&leg.column, leg.bound.copysign(share));
        }
        let ends = self.base_errors(errors, &shares);
        for component in 0..3 {
            let columns = errors.map(|leg| leg.column[component]);
            let by_component = self.base_errors(errors, &columns);
            for (end, way) in by_component.iter().zip(&ends) {
                let length = way.dot(*way).sqrt();
                if length > 0.0 {
                    let mut unit = [0.0; 3];
                    unit[component] = 1.0;
                    add(&unit, self.settings.tolerances.base * end.dot(*way) / length);
                }
            }
        }
        let determinant = |sign: f64| {
            let moved = Pose {
                position: pose.position + DVec2::new(error[0], error[1]) * sign,
                phi: pose.phi + sign * error[2],
            };
            let turn = Rotation::new(moved.phi);
            let rows = [0, 1, 2].map(|leg: usize| {
                let locked = legs[leg].locked(actuators[leg]);
                let (_, row) = locked.constraint(&moved, &turn, 1.0);
                let length = (row[0] * row[0] + row[1] * row[1]).sqrt();
                row.map(|part| part / length)
            });
            Matrix3::from(rows).determinant()
        };
        let here = determinant(0.0);
        let change = |sign: f64| (determinant(sign) / here - 1.0).abs();
        change(1.0).max(change(-1.0))
    }
}
