//! The motion of all architectures, compared with what other routes give: kinetic energy from the bodies of the legs, forces from
//! Lagrange's equations, and the mass of vibrations from a frame of bars whose energy is minimised.

mod elements;
mod frame;

use glam::DVec2;
use kinefront_model::dynamics::{DriveInertia, DynamicsReport, DynamicsSettings, Motion, Payload};
use kinefront_model::evaluation::{Model, PoseScalar};
use kinefront_model::mechanism::{
    AnyLeg, Architecture, CrossSection, Design, JointKind, LegPart, Manipulator, MemberKind,
};
use kinefront_model::spatial::{Pose, Rotation};
use kinefront_testkit::numbers as random_numbers;

use super::legs::{cases, model as model_of};
use super::reference::{design, pose as pose_of};

pub const DRIVES: DriveInertia = DriveInertia {
    slider_mass: 1.5,
    prismatic: 0.7,
    revolute: 0.3,
};

pub const PAYLOAD: Payload = Payload {
    mass: 4.0,
    inertia: 0.2,
    centre: [0.11, -0.07],
};

/// Number of poses of each architecture.
const POSES: usize = 20;

struct Subject {
    model: Model,
    design: Design,
    manipulator: Manipulator<AnyLeg>,
    pose: Pose,
    twist: [f64; 3],
    acceleration: [f64; 3],
}

/// Calls a function for each architecture at poses about those of the fixture, with a random motion.
fn for_all(gravity: [f64; 3], mut check: impl FnMut(&Subject)) {
    let mut random = random_numbers(11);
    let mut counts = std::collections::BTreeMap::new();
    let cases = cases("poses");
    for round in 0.. {
        let case = &cases[round % cases.len()];
        let design = design(case);
        let count = counts.entry(design.architecture().name()).or_insert(0);
        if *count >= POSES {
            if counts.len() == Architecture::ALL.len() && counts.values().all(|count| *count >= POSES) {
                return;
            }
            continue;
        }
        assert!(round < 20_000, "the poses of {design} are not reached");
        let mut spread = |by: f64| by * (2.0 * random() - 1.0);
        let model = model_of(case, |model| {
            model.dynamics = DynamicsSettings {
                payload: PAYLOAD,
                drives: DRIVES,
                gravity,
                ..DynamicsSettings::default()
            };
        });
        let near = pose_of(case);
        let by = 0.02 * design.base_radius();
        let pose = Pose {
            position: near.position + DVec2::new(spread(by), spread(by)),
            phi: near.phi + spread(0.05),
        };
        let manipulator = Manipulator::<AnyLeg>::new(&design, &model.settings().legs);
        let subject = Subject {
            twist: [spread(1.0), spread(1.0), spread(1.0)],
            acceleration: [spread(5.0), spread(5.0), spread(5.0)],
            model,
            design,
            manipulator,
            pose,
        };
        // Near a singularity, differences lose too many digits.
        let is_regular = manipulator.posture(&pose).is_ok_and(|posture| {
            posture.limit_margin > 1e-3 && posture.legs.iter().all(|leg| leg.transmission.abs() > 0.05)
        });
        let is_known = subject
            .model
            .pose(&subject.design, &pose)
            .is_ok_and(|found| found.values[PoseScalar::Dexterity] > 0.02);
        if is_regular && is_known {
            *count += 1;
            check(&subject);
        }
    }
}

/// Both ends of a uniform bar, its mass, and the radius of its section.
type MassBar = (DVec2, DVec2, f64, f64);

impl Subject {
    fn shifted(&self, twist: [f64; 3], by: f64) -> Pose {
        Pose {
            position: self.pose.position + DVec2::new(twist[0], twist[1]) * by,
            phi: self.pose.phi + twist[2] * by,
        }
    }

    /// The cross-section of a member, and its radius.
    fn section(&self, kind: MemberKind) -> (&CrossSection, f64) {
        let sections = &self.model.settings().sections;
        match kind {
            MemberKind::PlatformBar => (&sections.platform, self.design.platform_bar_radius()),
            _ => (&sections.legs, self.design.leg_bar_radius()),
        }
    }

    fn density(&self, kind: MemberKind) -> f64 {
        let (section, radius) = self.section(kind);
        section.mass_per_length(self.model.settings().material.density, radius)
    }

    /// All uniform bars, and points with mass, at a pose.
    fn masses(&self, pose: &Pose) -> (Vec<MassBar>, Vec<(DVec2, f64)>) {
        let posture = self.manipulator.posture(pose).expect("reached");
        let (mut bars, mut points) = (Vec::new(), Vec::new());
        let leg_radius = self.design.leg_bar_radius();
        let of_leg = self.density(MemberKind::Link);
        for (leg, found) in posture.legs.iter().enumerate() {
            for body in self.manipulator.legs[leg].bodies(found) {
                for part in &body.parts {
                    let (from, to, length) = match *part {
                        LegPart::Tube { from, to }
                        | LegPart::Rod { from, to }
                        | LegPart::Crank { from, to }
                        | LegPart::Link { from, to } => (from, to, from.distance(to)),
                        LegPart::GuideBar { from, to, kind } => {
                            // A guide has the mass of its full length.
                            let whole = match kind {
                                MemberKind::TurningGuide => self.design.proximal_length(),
                                _ => self.design.link_length(),
                            };
                            (from, to, whole)
                        }
                        LegPart::Slider { at, .. } => {
                            points.push((at, DRIVES.slider_mass));
                            continue;
                        }
                        _ => continue,
                    };
                    bars.push((from, to, of_leg * length, leg_radius));
                }
            }
            let c = pose.position + posture.arms[leg];
            let mass = self.density(MemberKind::PlatformBar) * posture.arms[leg].length();
            bars.push((c, pose.position, mass, self.design.platform_bar_radius()));
        }
        let centre = Rotation::new(pose.phi).apply(PAYLOAD.centre.into());
        points.push((pose.position + centre, PAYLOAD.mass));
        (bars, points)
    }

    /// Kinetic energy from differences of the places of all bodies.
    fn kinetic_energy(&self) -> f64 {
        const STEP: f64 = 1e-6;
        let [before, after] = [-STEP, STEP].map(|by| self.shifted(self.twist, by));
        let (bars_before, points_before) = self.masses(&before);
        let (bars_after, points_after) = self.masses(&after);
        let mut energy = 0.0;
        for ((a, b, mass, radius), (c, d, ..)) in bars_before.iter().zip(&bars_after) {
            let (first, second) = ((*c - *a) / (2.0 * STEP), (*d - *b) / (2.0 * STEP));
            let along = *b - *a;
            let turn = along.perp().dot(second - first) / along.length_squared();
            let sum = first.length_squared() + first.dot(second) + second.length_squared();
            energy += 0.5 * mass * (sum / 3.0 + 0.25 * radius * radius * turn * turn);
        }
        for ((a, mass), (b, _)) in points_before.iter().zip(&points_after) {
            energy += 0.5 * mass * ((*b - *a) / (2.0 * STEP)).length_squared();
        }
        energy += 0.5 * PAYLOAD.inertia * self.twist[2] * self.twist[2];
        let posed = self.model.posed(&self.design);
        let values = [before, after].map(|pose| posed.dynamics_at(&pose).expect("reached").expect("stiff").actuators());
        let inertia = DRIVES.of(self.design.architecture().actuator());
        for (before, after) in values[0].iter().zip(values[1]) {
            let turn = 2.0 * std::f64::consts::PI;
            let change = after - before;
            let change = match self.design.architecture().actuator() {
                JointKind::Revolute => change - turn * (change / turn).round(),
                JointKind::Prismatic => change,
            };
            energy += 0.5 * inertia * (change / (2.0 * STEP)).powi(2);
        }
        energy
    }

    fn report_at(&self, pose: &Pose) -> DynamicsReport {
        let posed = self.model.posed(&self.design);
        let dynamics = posed.dynamics_at(pose).expect("reached").expect("stiff");
        dynamics.report().expect("regular")
    }

    fn rigid_mass(&self, pose: &Pose) -> [[f64; 3]; 3] {
        self.report_at(pose).rigid_mass
    }

    /// What the platform needs in all for a motion, from the forces of the actuators.
    fn needed(&self, motion: &Motion) -> [f64; 3] {
        let posed = self.model.posed(&self.design);
        let dynamics = posed.dynamics_at(&self.pose).expect("reached").expect("stiff");
        let forces = dynamics.response(motion).forces;
        [0, 1, 2].map(|component: usize| {
            let mut twist = [0.0; 3];
            twist[component] = 1.0;
            let speeds = dynamics
                .response(&Motion {
                    twist,
                    acceleration: [0.0; 3],
                })
                .speeds;
            speeds.iter().zip(forces).map(|(speed, force)| speed * force).sum()
        })
    }
}

fn quadratic(mass: &[[f64; 3]; 3], a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3)
        .map(|i| (0..3).map(|k| a[i] * mass[i][k] * b[k]).sum::<f64>())
        .sum()
}

#[test]
fn the_mass_gives_the_kinetic_energy_of_the_bodies() {
    for_all([0.0; 3], |subject| {
        let mass = subject.rigid_mass(&subject.pose);
        let energy = 0.5 * quadratic(&mass, &subject.twist, &subject.twist);
        let wanted = subject.kinetic_energy();
        assert!(
            (energy - wanted).abs() < 2e-6 * wanted,
            "{}: {energy} J instead of {wanted} J",
            subject.design
        );
    });
}

#[test]
fn forces_are_those_of_lagrange() {
    const STEP: f64 = 1e-5;
    let gravity = [1.5, -9.0, 2.0];
    for_all(gravity, |subject| {
        let twist = &subject.twist;
        let here = subject.rigid_mass(&subject.pose);
        let unit = |component: usize| std::array::from_fn(|k| f64::from(u8::from(k == component)));
        let slopes = [0, 1, 2].map(|component| {
            let [before, after] = [-STEP, STEP].map(|by| subject.shifted(unit(component), by));
            let (before_mass, after_mass) = (subject.rigid_mass(&before), subject.rigid_mass(&after));
            let fall = |pose: &Pose| {
                let (bars, points) = subject.masses(pose);
                let of_bars: DVec2 = bars.iter().map(|(a, b, mass, _)| (*a + *b) * (0.5 * mass)).sum();
                let of_points: DVec2 = points.iter().map(|(at, mass)| *at * *mass).sum();
                (of_bars + of_points).dot(DVec2::new(gravity[0], gravity[1]))
            };
            let potential = -(fall(&after) - fall(&before)) / (2.0 * STEP);
            let mass: [[f64; 3]; 3] =
                std::array::from_fn(|i| std::array::from_fn(|k| (after_mass[i][k] - before_mass[i][k]) / (2.0 * STEP)));
            (mass, potential)
        });
        let found = subject.needed(&Motion {
            twist: *twist,
            acceleration: subject.acceleration,
        });
        let wanted: [f64; 3] = std::array::from_fn(|component| {
            let row = unit(component);
            let carried: f64 = (0..3).map(|k| quadratic(&slopes[k].0, &row, twist) * twist[k]).sum();
            let (slope, potential) = &slopes[component];
            quadratic(&here, &row, &subject.acceleration) + carried - 0.5 * quadratic(slope, twist, twist) + potential
        });
        let scale = wanted.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        for (found, wanted) in found.iter().zip(wanted) {
            assert!(
                (found - wanted).abs() < 1e-5 * scale,
                "{}: {found} instead of {wanted}",
                subject.design
            );
        }
    });
}

/// Each vibration balances the forces of stiffness and of mass, and moves the bars continuously, from rest at the base to the platform.
#[test]
fn vibrations_are_balanced_and_continuous() {
    for_all([0.0, 0.0, -9.81], |subject| {
        let posed = subject.model.posed(&subject.design);
        let dynamics = posed.dynamics_at(&subject.pose).expect("reached").expect("regular");
        let report = dynamics.report().expect("regular");
        let found = posed.at(&subject.pose).expect("reached");
        let (frequencies, shapes) = (report.frequencies.expect("known"), report.shapes.expect("known"));
        for (block, places) in [[0, 1, 5], [2, 3, 4]].into_iter().enumerate() {
            let mass = [report.mass_in_plane, report.mass_out_of_plane][block];
            for (frequency, shape) in frequencies[block].into_iter().zip(shapes[block]) {
                let square = (2.0 * std::f64::consts::PI * frequency).powi(2);
                let (mut off, mut scale) = (0.0f64, 0.0f64);
                for row in 0..3 {
                    let of_stiffness: f64 = (0..3)
                        .map(|k| found.stiffness[(places[row], places[k])] * shape[k])
                        .sum();
                    let of_mass: f64 = (0..3).map(|k| mass[row][k] * shape[k]).sum();
                    off = off.max((of_stiffness - square * of_mass).abs());
                    let largest = (0..3).map(|k| (found.stiffness[(places[row], places[k])] * shape[k]).abs());
                    scale = largest.fold(scale, f64::max);
                }
                assert!(
                    off <= 1e-7 * scale,
                    "{}: {frequency} Hz is off by {off} of {scale}",
                    subject.design
                );
            }
        }
        let bars = dynamics.vibrating_bars();
        for leg in 0..3 {
            let of_leg: Vec<_> = bars.iter().filter(|bar| bar.leg == leg).collect();
            let last = of_leg.last().and_then(|bar| bar.points.last()).expect("a point");
            // The bar of the platform ends at P, which moves as the platform does.
            assert!(last.place.distance(subject.pose.position) < 1e-9, "{}", subject.design);
            for (found, wanted) in [
                (last.in_plane[0], [1.0, 0.0, 0.0]),
                (last.in_plane[1], [0.0, 1.0, 0.0]),
                (last.lift, [1.0, 0.0, 0.0]),
            ] {
                let off = (0..3).map(|k| f64::abs(found[k] - wanted[k])).fold(0.0, f64::max);
                assert!(off < 1e-6, "{}: {found:?}", subject.design);
            }
            // Out of the plane, one bar goes on where the one before ends.
            for pair in of_leg.windows(2) {
                let (before, after) = (pair[0].points.last().expect("a point"), pair[1].points[0]);
                let off = (0..3)
                    .map(|k| (before.lift[k] - after.lift[k]).abs())
                    .fold(0.0, f64::max);
                let is_joined = before.place.distance(after.place) < 1e-9;
                assert!(!is_joined || off < 1e-6, "{}: {before:?} and {after:?}", subject.design);
            }
            let first = of_leg[0].points[0];
            assert!(first.lift.iter().all(|part| part.abs() < 1e-9), "{}", subject.design);
        }
    });
}
