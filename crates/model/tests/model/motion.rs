//! The motion of all architectures, compared with what other routes give: kinetic energy from the bodies of the legs, forces from
//! Lagrange's equations, and the mass of vibrations from a frame of bars whose energy is minimised.

use glam::DVec2;
use kinefront_model::dynamics::{DriveInertia, DynamicsSettings, Motion, Payload};
use kinefront_model::evaluation::Model;
use kinefront_model::mechanism::{
    AnyLeg, Architecture, BarLength, CrossSection, Design, JointKind, JointPoint, LegPart, LegPosture, Manipulator,
    MemberKind,
};
use kinefront_model::spatial::{Pose, Rotation};
use kinefront_model::stiffness::{BarCompliance, RailSettings, RailSupports};
use kinefront_testkit::numbers as random_numbers;
use nalgebra::{DMatrix, DVector, Matrix6, Matrix6xX, SMatrix, Vector6};

use super::legs::{cases, model as model_of};
use super::reference::{design, pose as pose_of};

const DRIVES: DriveInertia = DriveInertia {
    slider_mass: 1.5,
    prismatic: 0.7,
    revolute: 0.3,
};

const PAYLOAD: Payload = Payload {
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
            .is_ok_and(|found| found.values[kinefront_model::evaluation::PoseScalar::Dexterity] > 0.02);
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

    fn density(&self, kind: MemberKind) -> f64 {
        let settings = self.model.settings();
        match kind {
            MemberKind::PlatformBar => settings
                .sections
                .platform
                .mass_per_length(settings.material.density, self.design.platform_bar_radius()),
            _ => settings
                .sections
                .legs
                .mass_per_length(settings.material.density, self.design.leg_bar_radius()),
        }
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

    fn rigid_mass(&self, pose: &Pose) -> [[f64; 3]; 3] {
        let posed = self.model.posed(&self.design);
        posed
            .dynamics_at(pose)
            .expect("reached")
            .expect("stiff")
            .report()
            .expect("regular")
            .rigid_mass
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

/// A bar of a leg in the frame: relative to `P`, from the base.
struct FrameBar {
    base: DVec2,
    axis: DVec2,
    length: f64,
    /// From, to, and mass per length of each piece along the axis.
    pieces: Vec<(f64, f64, f64)>,
    compliance: BarCompliance,
    gyration: f64,
    is_telescopic: bool,
}

/// Motion of a rigid body about `P`, linear first.
fn moved(at: DVec2, twist: &SMatrix<f64, 6, 6>, direction: [f64; 3], rotation: bool) -> Vector6<f64> {
    let [x, y, z] = direction;
    if rotation {
        return (twist.row(3) * x + twist.row(4) * y + twist.row(5) * z).transpose();
    }
    let u = twist.row(0) - twist.row(5) * at.y;
    let v = twist.row(1) + twist.row(5) * at.x;
    let w = twist.row(2) + twist.row(3) * at.y - twist.row(4) * at.x;
    (u * x + v * y + w * z).transpose()
}

impl Subject {
    /// The bars of a leg from its posture, with what lies on them.
    fn frame_bars(&self, leg: &LegPosture) -> Vec<FrameBar> {
        let settings = self.model.settings();
        let chain = self.design.architecture().chain();
        let compliance = |section, radius| BarCompliance::new(&settings.material, section, radius).expect("stiff");
        let of_leg = compliance(&settings.sections.legs, self.design.leg_bar_radius());
        let of_platform = compliance(&settings.sections.platform, self.design.platform_bar_radius());
        let to_p = |point: DVec2| point - leg.chain.c + leg.arm;
        let radius = self.design.leg_bar_radius();
        let density = self.density(MemberKind::Link);
        let guide = |length: f64, sign: f64, offset: f64| {
            let [from, to] = settings.legs.geometry.arrangement().guide.map(|share| share * length);
            let ends = [offset + sign * from, offset + sign * to];
            vec![(
                ends[0].min(ends[1]),
                ends[0].max(ends[1]),
                density * length / (to - from),
            )]
        };
        let mut bars = Vec::new();
        if let Some(bar) = leg.chain.proximal {
            let sign = 1f64.copysign(bar.offset);
            let length = bar.offset.abs();
            bars.push(FrameBar {
                base: to_p(leg.chain.a),
                axis: bar.direction * sign,
                length,
                pieces: match chain.proximal {
                    Some(MemberKind::TurningGuide) => guide(self.design.proximal_length(), sign, 0.0),
                    _ => vec![(0.0, length, density)],
                },
                compliance: of_leg,
                gyration: radius * radius / 4.0,
                is_telescopic: false,
            });
        }
        let offset = leg.chain.distal.offset;
        let (sign, length) = (1f64.copysign(offset), offset.abs());
        let tube = settings.legs.tube_length(self.design.link_length());
        let is_telescopic = chain.distal == MemberKind::TelescopicLeg;
        bars.push(FrameBar {
            base: to_p(leg.chain.b),
            axis: leg.chain.distal.direction * sign,
            length,
            pieces: match chain.distal {
                MemberKind::TelescopicLeg => {
                    vec![
                        (0.0, tube, density),
                        (length - (self.design.link_length() - tube), length, density),
                    ]
                }
                MemberKind::Guide if chain.joints[2] == JointKind::Prismatic => {
                    guide(self.design.link_length(), -sign, length)
                }
                MemberKind::Guide => guide(self.design.link_length(), sign, 0.0),
                _ => vec![(0.0, length, density)],
            },
            compliance: of_leg,
            gyration: radius * radius / 4.0,
            is_telescopic,
        });
        let radius = self.design.platform_bar_radius();
        bars.push(FrameBar {
            base: leg.arm,
            axis: -leg.arm.normalize(),
            length: leg.arm.length(),
            pieces: vec![(0.0, leg.arm.length(), self.density(MemberKind::PlatformBar))],
            compliance: of_platform,
            gyration: radius * radius / 4.0,
            is_telescopic: false,
        });
        bars
    }

    /// The mass that a leg opposes to a displacement of the platform: the displacement is shared between joints and bars so that the
    /// elastic energy is least.
    fn frame_mass(&self, leg: &LegPosture) -> Matrix6<f64> {
        let bars = self.frame_bars(leg);
        let architecture = self.design.architecture();
        let chain = architecture.chain();
        let to_p = |point: DVec2| point - leg.chain.c + leg.arm;
        let twists: Vec<Vector6<f64>> = (0..3)
            .map(|joint| match (chain.joints[joint], leg.chain.guides[joint]) {
                (JointKind::Prismatic, Some(d)) => Vector6::new(d.x, d.y, 0.0, 0.0, 0.0, 0.0),
                _ => {
                    let at = to_p(match chain.points[joint] {
                        JointPoint::A => leg.chain.a,
                        JointPoint::B => leg.chain.b,
                        JointPoint::C => leg.chain.c,
                    });
                    Vector6::new(at.y, -at.x, 0.0, 0.0, 0.0, 1.0)
                }
            })
            .collect();
        // Unknowns: the joints, the end displacements of each bar in its axes, and the reactions.
        let count = 3 + 6 * bars.len();
        let mut system = DMatrix::<f64>::zeros(count + 6, count + 6);
        let actuator = self.model.settings().actuators.of(architecture.actuator());
        system[(architecture.driven(), architecture.driven())] = actuator;
        let mut into: Vec<Matrix6<f64>> = Vec::new();
        for (place, bar) in bars.iter().enumerate() {
            let stiffness = bar.compliance.matrix(bar.length).try_inverse().expect("stiff");
            system
                .view_mut((3 + 6 * place, 3 + 6 * place), (6, 6))
                .copy_from(&stiffness);
            let tip = bar.base + bar.axis * bar.length;
            let normal = bar.axis.perp();
            let mut matrix = Matrix6::zeros();
            for (k, axis) in [
                [bar.axis.x, bar.axis.y, 0.0],
                [normal.x, normal.y, 0.0],
                [0.0, 0.0, 1.0],
            ]
            .into_iter()
            .enumerate()
            {
                for (row, part) in axis.into_iter().enumerate() {
                    matrix[(row, k)] = part;
                    matrix[(3 + row, 3 + k)] = part;
                }
                // A rotation at the tip moves P.
                matrix[(0, 3 + k)] = axis[2] * tip.y;
                matrix[(1, 3 + k)] = -axis[2] * tip.x;
                matrix[(2, 3 + k)] = -axis[0] * tip.y + axis[1] * tip.x;
            }
            into.push(matrix);
        }
        for (joint, twist) in twists.iter().enumerate() {
            system.view_mut((joint, count), (1, 6)).copy_from(&twist.transpose());
            system.view_mut((count, joint), (6, 1)).copy_from(twist);
        }
        for (place, matrix) in into.iter().enumerate() {
            system
                .view_mut((3 + 6 * place, count), (6, 6))
                .copy_from(&matrix.transpose());
            system.view_mut((count, 3 + 6 * place), (6, 6)).copy_from(matrix);
        }
        let mut right = DMatrix::<f64>::zeros(count + 6, 6);
        right.view_mut((count, 0), (6, 6)).copy_from(&Matrix6::identity());
        // Stiffnesses of metres and of joints differ by far: the system is scaled by its rows.
        let solution = scaled_solution(system, right);
        let rates = solution.rows(0, 3).into_owned();
        let mut mass = Matrix6::<f64>::zeros();
        let mut add = |row: Vector6<f64>, by: f64| mass += row * row.transpose() * by;
        add(
            rates
                .row(architecture.driven())
                .transpose()
                .fixed_rows::<6>(0)
                .into_owned(),
            DRIVES.of(architecture.actuator()),
        );
        let mut twist = Matrix6::<f64>::zeros();
        let mut joint = 0;
        let first = 3 - bars.len();
        for (place, bar) in bars.iter().enumerate() {
            let mut slide = Matrix6::zeros();
            while joint < 3 {
                let before = match chain.points[joint] {
                    JointPoint::A => 0,
                    JointPoint::B => 1,
                    JointPoint::C => 2,
                };
                if before > place + first {
                    break;
                }
                let change = twists[joint] * rates.row(joint);
                let change = change.fixed_view::<6, 6>(0, 0).into_owned();
                if bar.is_telescopic && chain.joints[joint] == JointKind::Prismatic {
                    slide = change;
                } else {
                    twist += change;
                    if joint == 0 && chain.is_on_rails() {
                        for direction in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
                            add(moved(to_p(leg.chain.b), &twist, direction, false), DRIVES.slider_mass);
                        }
                    }
                }
                joint += 1;
            }
            let strain = solution.rows(3 + 6 * place, 6).into_owned();
            let strain = strain.fixed_view::<6, 6>(0, 0).into_owned();
            add_bar(bar, &twist, &strain, &slide, &mut add);
            twist += into[place] * strain + slide;
        }
        mass
    }
}

fn scaled_solution(mut system: DMatrix<f64>, mut right: DMatrix<f64>) -> DMatrix<f64> {
    for row in 0..system.nrows() {
        let most = system.row(row).amax();
        system.row_mut(row).scale_mut(1.0 / most);
        right.row_mut(row).scale_mut(1.0 / most);
    }
    system.full_piv_lu().solve(&right).expect("a regular system")
}

/// Adds the mass of a bar that moves with `twist` and is deformed by the displacements of its tip, by Simpson's rule.
fn add_bar(
    bar: &FrameBar,
    twist: &Matrix6<f64>,
    strain: &Matrix6<f64>,
    slide: &Matrix6<f64>,
    add: &mut impl FnMut(Vector6<f64>, f64),
) {
    const INTERVALS: usize = 400;
    let length = bar.length;
    let normal = bar.axis.perp();
    let local = |row: usize| strain.row(row).transpose();
    for (piece, &(from, to, density)) in bar.pieces.iter().enumerate() {
        let mut cuts = vec![from, to];
        cuts.extend([0.0, length].into_iter().filter(|cut| from < *cut && *cut < to));
        cuts.sort_by(f64::total_cmp);
        for pair in cuts.windows(2) {
            let step = (pair[1] - pair[0]) / INTERVALS as f64;
            for k in 0..=INTERVALS {
                let x = pair[0] + step * k as f64;
                let weight = step / 3.0 * [1.0, 4.0, 2.0][if k == 0 || k == INTERVALS { 0 } else { 2 - k % 2 }];
                let mass = density * weight;
                // Beyond the ends the bar goes on straight.
                let (inside, beyond) = (x.clamp(0.0, length), x - x.clamp(0.0, length));
                let s = if length > 0.0 { inside / length } else { 0.0 };
                let bend = |tip: Vector6<f64>, slope: Vector6<f64>| {
                    let value = tip * (s * s * (3.0 - 2.0 * s)) + slope * (length * s * s * (s - 1.0));
                    let turn = tip * (6.0 * s * (1.0 - s) / length) + slope * (s * (3.0 * s - 2.0));
                    (value + turn * beyond, turn)
                };
                let at = bar.base + bar.axis * x;
                let rigid = |direction: [f64; 3], rotation: bool| moved(at, twist, direction, rotation);
                let (across, turn) = bend(local(1), local(5));
                let across = across + rigid([normal.x, normal.y, 0.0], false);
                let turn = turn + rigid([0.0, 0.0, 1.0], true);
                let (up, lift) = bend(local(2), -local(4));
                let up = up + rigid([0.0, 0.0, 1.0], false);
                let lift = lift - rigid([normal.x, normal.y, 0.0], true);
                let mut along = rigid([bar.axis.x, bar.axis.y, 0.0], false);
                along += match (bar.is_telescopic, piece) {
                    (false, _) => local(0) * s,
                    (true, 0) => Vector6::zeros(),
                    // The rod moves along the leg as its end does.
                    (true, _) => local(0) + moved(at, slide, [bar.axis.x, bar.axis.y, 0.0], false),
                };
                let twisted = local(3) * s + rigid([bar.axis.x, bar.axis.y, 0.0], true);
                for row in [along, across, up] {
                    add(row, mass);
                }
                add(turn, mass * bar.gyration);
                add(lift, mass * bar.gyration);
                add(twisted, 2.0 * mass * bar.gyration);
            }
        }
    }
}

#[test]
fn the_mass_of_vibrations_is_that_of_a_frame() {
    for_all([0.0; 3], |subject| {
        let posture = subject.manipulator.posture(&subject.pose).expect("reached");
        let mut wanted: Matrix6<f64> = posture.legs.iter().map(|leg| subject.frame_mass(leg)).sum();
        let mut add = |row: Vector6<f64>, by: f64| wanted += row * row.transpose() * by;
        let centre = Rotation::new(subject.pose.phi).apply(PAYLOAD.centre.into());
        for direction in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            add(moved(centre, &Matrix6::identity(), direction, false), PAYLOAD.mass);
        }
        for (row, share) in [(3, 0.5), (4, 0.5), (5, 1.0)] {
            add(
                Matrix6::identity().row(row).transpose().into_owned(),
                share * PAYLOAD.inertia,
            );
        }
        let posed = subject.model.posed(&subject.design);
        let dynamics = posed.dynamics_at(&subject.pose).expect("reached").expect("stiff");
        let report = dynamics.report().expect("regular");
        for (rows, found) in [([0, 1, 5], report.mass_in_plane), ([2, 3, 4], report.mass_out_of_plane)] {
            for i in 0..3 {
                for k in 0..3 {
                    let scale = (wanted[(rows[i], rows[i])] * wanted[(rows[k], rows[k])]).sqrt();
                    let off = (found[i][k] - wanted[(rows[i], rows[k])]).abs() / scale;
                    assert!(
                        off < 1e-8,
                        "{} entry {i}{k}: {} instead of {}, off by {off:e}",
                        subject.design,
                        found[i][k],
                        wanted[(rows[i], rows[k])]
                    );
                }
            }
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

/// How the ends of an element move, as twists at `P` for a unit of each coordinate.
struct FrameElement<'a> {
    bar: &'a FrameBar,
    from: f64,
    to: f64,
    base: Matrix6xX<f64>,
    tip: Matrix6xX<f64>,
}

/// Returns the displacement of a place in a direction, or the rotation about it, as a row over all coordinates.
fn row_of(twist: &Matrix6xX<f64>, at: DVec2, direction: [f64; 3], rotation: bool) -> DVector<f64> {
    let lever = [DVec2::new(0.0, 0.0), at][usize::from(!rotation)];
    let offset = if rotation { 3 } else { 0 };
    let mut row = DVector::zeros(twist.ncols());
    for (k, part) in direction.into_iter().enumerate() {
        row += twist.row(offset + k).transpose() * part;
    }
    if !rotation {
        let [x, y, z] = direction;
        row += twist.row(5).transpose() * (y * lever.x - x * lever.y);
        row += (twist.row(3) * lever.y - twist.row(4) * lever.x).transpose() * z;
    }
    row
}

impl FrameElement<'_> {
    /// Displacements and rotations of an end in the axes of the bar, and those that deform the element.
    fn local(&self, twist: &Matrix6xX<f64>, at: f64) -> [DVector<f64>; 6] {
        let bar = self.bar;
        let (place, normal) = (bar.base + bar.axis * at, bar.axis.perp());
        let axes = [
            [bar.axis.x, bar.axis.y, 0.0],
            [normal.x, normal.y, 0.0],
            [0.0, 0.0, 1.0],
        ];
        std::array::from_fn(|k| row_of(twist, place, axes[k % 3], k >= 3))
    }

    fn add(&self, stiffness: &mut DMatrix<f64>, mass: &mut DMatrix<f64>, own: &[Option<DVector<f64>>]) {
        /// Gauss's rule with five points.
        const RULE: [[f64; 2]; 5] = [
            [-0.906_179_845_938_664, 0.236_926_885_056_189_08],
            [-0.538_469_310_105_683, 0.478_628_670_499_366_47],
            [0.0, 0.568_888_888_888_888_9],
            [0.538_469_310_105_683, 0.478_628_670_499_366_47],
            [0.906_179_845_938_664, 0.236_926_885_056_189_08],
        ];
        let length = self.to - self.from;
        let (rigid, tip) = (self.local(&self.base, self.to), self.local(&self.tip, self.to));
        let strain: Vec<DVector<f64>> = tip.iter().zip(&rigid).map(|(tip, rigid)| tip - rigid).collect();
        let elastic = self.bar.compliance.matrix(length).try_inverse().expect("stiff");
        for i in 0..6 {
            for k in 0..6 {
                if elastic[(i, k)] != 0.0 {
                    *stiffness += &strain[i] * strain[k].transpose() * elastic[(i, k)];
                }
            }
        }
        for (piece, &(from, to, density)) in self.bar.pieces.iter().enumerate() {
            let (from, to) = (from.max(self.from), to.min(self.to));
            if to <= from {
                continue;
            }
            for [abscissa, weight] in RULE {
                let x = 0.5 * (from + to) + 0.5 * (to - from) * abscissa;
                let of_place = 0.5 * (to - from) * weight * density;
                let s = (x - self.from) / length;
                let [along, across, up, about, pitch, turn] = self.local(&self.base, x);
                let (value, slope) = (s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / length);
                let (of_turn, slope_of_turn) = (length * s * s * (s - 1.0), s * (3.0 * s - 2.0));
                let rows = [
                    (own[piece].clone().unwrap_or_else(|| along + &strain[0] * s), of_place),
                    (across + &strain[1] * value + &strain[5] * of_turn, of_place),
                    (up + &strain[2] * value - &strain[4] * of_turn, of_place),
                    (about + &strain[3] * s, 2.0 * of_place * self.bar.gyration),
                    (
                        pitch - &strain[2] * slope + &strain[4] * slope_of_turn,
                        of_place * self.bar.gyration,
                    ),
                    (
                        turn + &strain[1] * slope + &strain[5] * slope_of_turn,
                        of_place * self.bar.gyration,
                    ),
                ];
                for (row, by) in rows {
                    *mass += &row * row.transpose() * by;
                }
            }
        }
    }
}

impl Subject {
    /// Natural frequencies of the whole frame in space, with all bars divided into so many elements, in increasing order.
    fn frequencies_of_elements(&self, count: usize) -> Vec<f64> {
        let posture = self.manipulator.posture(&self.pose).expect("reached");
        let architecture = self.design.architecture();
        let chain = architecture.chain();
        // The coordinates of the platform, and then those of each leg: joints, and ends of elements.
        let bars: Vec<Vec<FrameBar>> = posture.legs.iter().map(|leg| self.frame_bars(leg)).collect();
        let stretches = |bar: &FrameBar| {
            let before = bar.pieces.iter().any(|piece| piece.0 < 0.0);
            let beyond = bar.pieces.iter().any(|piece| piece.1 > bar.length);
            1 + usize::from(before) + usize::from(beyond)
        };
        let stretches: usize = bars.iter().flatten().map(stretches).sum();
        let total = 6 + 3 * 3 + 6 * count * stretches;
        let (mut stiffness, mut mass) = (DMatrix::zeros(total, total), DMatrix::zeros(total, total));
        let mut used = 6;
        let mut free = |columns: usize| {
            used += columns;
            used - columns
        };
        let unit = |first: usize| {
            let mut twist = Matrix6xX::zeros(total);
            twist.view_mut((0, first), (6, 6)).copy_from(&Matrix6::identity());
            twist
        };
        let mut driven = Vec::new();
        for (leg, bars) in posture.legs.iter().zip(&bars) {
            let to_p = |point: DVec2| point - leg.chain.c + leg.arm;
            let mut body = Matrix6xX::zeros(total);
            let mut joint = 0;
            let first = 3 - bars.len();
            for (place, bar) in bars.iter().enumerate() {
                let held = body.clone();
                while joint < 3 {
                    let (before, at) = match chain.points[joint] {
                        JointPoint::A => (0, leg.chain.a),
                        JointPoint::B => (1, leg.chain.b),
                        JointPoint::C => (2, leg.chain.c),
                    };
                    if before > place + first {
                        break;
                    }
                    let coordinate = free(1);
                    let at = to_p(at);
                    let twist = match (chain.joints[joint], leg.chain.guides[joint]) {
                        (JointKind::Prismatic, Some(d)) => Vector6::new(d.x, d.y, 0.0, 0.0, 0.0, 0.0),
                        _ => Vector6::new(at.y, -at.x, 0.0, 0.0, 0.0, 1.0),
                    };
                    let mut column = body.column_mut(coordinate);
                    column += twist;
                    if joint == architecture.driven() {
                        driven.push(coordinate);
                    }
                    if joint == 0 && chain.is_on_rails() {
                        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
                            let row = row_of(&body, to_p(leg.chain.b), axis, false);
                            mass += &row * row.transpose() * DRIVES.slider_mass;
                        }
                    }
                    joint += 1;
                }
                let tip = if place + 1 == bars.len() {
                    unit(0)
                } else {
                    unit(free(6))
                };
                let along = |twist: &Matrix6xX<f64>, at: f64| {
                    row_of(twist, bar.base + bar.axis * at, [bar.axis.x, bar.axis.y, 0.0], false)
                };
                let own = match bar.is_telescopic {
                    true => vec![Some(along(&held, 0.0)), Some(along(&tip, bar.length))],
                    false => vec![None; bar.pieces.len()],
                };
                let first = bar.pieces.iter().fold(0.0, |least: f64, piece| piece.0.min(least));
                let last = bar.pieces.iter().fold(bar.length, |most: f64, piece| piece.1.max(most));
                for (from, to, base, tip) in [
                    (first, 0.0, None, Some(&body)),
                    (0.0, bar.length, Some(&body), Some(&tip)),
                    (bar.length, last, Some(&tip), None),
                ] {
                    if to - from < 1e-9 {
                        continue;
                    }
                    let mut ends = vec![base.cloned().unwrap_or_else(|| unit(free(6)))];
                    ends.extend((1..count).map(|_| unit(free(6))));
                    ends.push(tip.cloned().unwrap_or_else(|| unit(free(6))));
                    for (k, pair) in ends.windows(2).enumerate() {
                        let at = |k: usize| from + (to - from) * k as f64 / count as f64;
                        let element = FrameElement {
                            bar,
                            from: at(k),
                            to: at(k + 1),
                            base: pair[0].clone(),
                            tip: pair[1].clone(),
                        };
                        element.add(&mut stiffness, &mut mass, &own);
                    }
                }
                body = tip;
            }
        }
        let actuator = self.model.settings().actuators.of(architecture.actuator());
        for coordinate in driven {
            stiffness[(coordinate, coordinate)] += actuator;
            mass[(coordinate, coordinate)] += DRIVES.of(architecture.actuator());
        }
        let centre = Rotation::new(self.pose.phi).apply(PAYLOAD.centre.into());
        let platform = unit(0);
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let row = row_of(&platform, centre, axis, false);
            mass += &row * row.transpose() * PAYLOAD.mass;
        }
        for (k, share) in [(3, 0.5), (4, 0.5), (5, 1.0)] {
            mass[(k, k)] += share * PAYLOAD.inertia;
        }
        let (stiffness, mass) = (
            stiffness.view((0, 0), (used, used)).into_owned(),
            mass.view((0, 0), (used, used)).into_owned(),
        );
        let factor = stiffness.cholesky().expect("no mechanism").l();
        let half = factor.solve_lower_triangular(&mass).expect("regular");
        let compliance = factor.solve_lower_triangular(&half.transpose()).expect("regular");
        let compliance = (&compliance + compliance.transpose()) * 0.5;
        let mut found: Vec<f64> = compliance.symmetric_eigenvalues().iter().copied().collect();
        found.sort_by(|a, b| b.total_cmp(a));
        found.truncate(12);
        let tau = 2.0 * std::f64::consts::PI;
        found.into_iter().map(|value| 1.0 / (value.sqrt() * tau)).collect()
    }
}

#[test]
fn the_frequencies_of_the_frame_are_those_of_its_elements() {
    let mut seen = std::collections::BTreeSet::new();
    for_all([0.0; 3], |subject| {
        if !seen.insert(subject.design.architecture().name()) {
            return;
        }
        let posed = subject.model.posed(&subject.design);
        let dynamics = posed.dynamics_at(&subject.pose).expect("reached").expect("stiff");
        let found = dynamics.frame_frequencies().expect("regular");
        let wanted = subject.frequencies_of_elements(3);
        let lowest = found[0].min(found[1]);
        for (plane, found) in found.iter().enumerate() {
            let is_wanted = wanted.iter().any(|wanted| (found / wanted - 1.0).abs() < 1e-5);
            assert!(
                is_wanted,
                "{} plane {plane}: {found} Hz is none of {wanted:?}",
                subject.design
            );
        }
        assert!((lowest / wanted[0] - 1.0).abs() < 1e-5, "{}", subject.design);
        // More elements change next to nothing.
        if seen.len() <= 4 {
            let finer = subject.frequencies_of_elements(5)[0];
            assert!((lowest / finer - 1.0).abs() < 1e-3, "{}: {finer} Hz", subject.design);
        }
    });
    assert_eq!(seen.len(), Architecture::ALL.len());
}

/// Returns the lowest frequencies in the plane and out of it, of the condensed mass and of the frame.
fn lowest_of_both(model: &Model, subject: &Subject) -> [[f64; 2]; 2] {
    let posed = model.posed(&subject.design);
    let dynamics = posed.dynamics_at(&subject.pose).expect("reached").expect("stiff");
    let [in_plane, out_of_plane] = dynamics.report().expect("regular").frequencies.expect("rigid rails");
    let frame = dynamics.frame_frequencies().expect("regular");
    [[in_plane[0], out_of_plane[0]], frame]
}

#[test]
fn the_frequencies_of_the_frame_are_below_those_of_its_condensed_mass() {
    let mut ratios = Vec::new();
    for_all([0.0; 3], |subject| {
        let [condensed, frame] = lowest_of_both(&subject.model, subject);
        for (condensed, frame) in condensed.iter().zip(frame) {
            let ratio = condensed / frame;
            assert!(ratio > 1.0 - 1e-9, "{}: {ratio}", subject.design);
            ratios.push(ratio);
        }
        // Beside a heavy payload the bars weigh nothing, and both are what their stiffness makes them.
        for telescopic_bar in [BarLength::Current, BarLength::Longest] {
            let mut settings = subject.model.settings().clone();
            settings.legs.telescopic_bar = telescopic_bar;
            settings.dynamics.payload = Payload {
                mass: 1e10,
                inertia: 1e10,
                ..PAYLOAD
            };
            let model = Model::new(settings).expect("a model");
            let [condensed, frame] = lowest_of_both(&model, subject);
            for (condensed, frame) in condensed.iter().zip(frame) {
                let ratio = condensed / frame;
                assert!((ratio - 1.0).abs() < 1e-5, "{}: {ratio}", subject.design);
            }
        }
    });
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    // What docs/model.md says of them.
    assert!((median - 1.009).abs() < 5e-4, "{median}");
    let above = ratios.iter().filter(|ratio| **ratio > 1.1).count() as f64 / ratios.len() as f64;
    assert!((above - 0.21).abs() < 5e-3, "{above}");
    assert!(ratios[ratios.len() - 1] < 2.45, "{ratios:?}");
}

#[test]
fn rails_that_bend_have_no_frequencies_of_a_frame() {
    let design = parsed("3-PRR R=3 r=1.2 Lb=1.8 rj=0.03 rp=0.05");
    let model = super::strategies::model(|model| {
        model.rails = Some(RailSettings {
            section: CrossSection::Round,
            radius: 0.05,
            supports: RailSupports::Pinned,
        });
    });
    let posed = model.posed(&design);
    let dynamics = posed
        .dynamics_at(&Pose::new(0.0, 0.0, 0.6))
        .expect("reached")
        .expect("stiff");
    assert_eq!(dynamics.frame_frequencies(), None);
    assert_eq!(dynamics.report().expect("regular").frequencies, None);
}
