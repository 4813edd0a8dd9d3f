//! The mass of vibrations from a frame of bars whose energy is minimised.

use glam::DVec2;
use kinefront_model::mechanism::{ChainDescription, JointKind, LegPosture, MemberKind};
use kinefront_model::spatial::Rotation;
use kinefront_model::stiffness::BarCompliance;
use nalgebra::{DMatrix, Matrix6, SMatrix, Vector6};

use super::{DRIVES, PAYLOAD, Subject, for_all};

/// Directions of the axes of the base.
pub const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A bar of a leg in the frame: relative to `P`, from the base.
pub struct FrameBar {
    pub base: DVec2,
    pub axis: DVec2,
    pub length: f64,
    /// From, to, and mass per length of each piece along the axis.
    pub pieces: Vec<(f64, f64, f64)>,
    pub compliance: BarCompliance,
    pub gyration: f64,
    pub is_telescopic: bool,
}

impl FrameBar {
    /// Directions along the bar, across it in the plane, and out of the plane.
    pub fn axes(&self) -> [[f64; 3]; 3] {
        let normal = self.axis.perp();
        [[self.axis.x, self.axis.y, 0.0], [normal.x, normal.y, 0.0], AXES[2]]
    }

    /// How `P` moves with the displacements of the tip in the axes of the bar.
    fn moves_by_tip(&self) -> Matrix6<f64> {
        let tip = self.base + self.axis * self.length;
        let mut matrix = Matrix6::zeros();
        for (k, axis) in self.axes().into_iter().enumerate() {
            for (row, part) in axis.into_iter().enumerate() {
                matrix[(row, k)] = part;
                matrix[(3 + row, 3 + k)] = part;
            }
            // A rotation at the tip moves P.
            matrix[(0, 3 + k)] = axis[2] * tip.y;
            matrix[(1, 3 + k)] = -axis[2] * tip.x;
            matrix[(2, 3 + k)] = -axis[0] * tip.y + axis[1] * tip.x;
        }
        matrix
    }
}

/// A point of a leg relative to `P`.
pub fn about_p(leg: &LegPosture, point: DVec2) -> DVec2 {
    point - leg.chain.c + leg.arm
}

/// How a joint of a leg moves what follows it, as a twist at `P`.
pub fn joint_twist(leg: &LegPosture, chain: &ChainDescription, joint: usize) -> Vector6<f64> {
    match (chain.joints[joint], leg.chain.guides[joint]) {
        (JointKind::Prismatic, Some(d)) => Vector6::new(d.x, d.y, 0.0, 0.0, 0.0, 0.0),
        _ => {
            let at = about_p(
                leg,
                [leg.chain.a, leg.chain.b, leg.chain.c][chain.points[joint] as usize],
            );
            Vector6::new(at.y, -at.x, 0.0, 0.0, 0.0, 1.0)
        }
    }
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
    pub fn frame_bars(&self, leg: &LegPosture) -> Vec<FrameBar> {
        let settings = self.model.settings();
        let chain = self.design.architecture().chain();
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
            let pieces = match chain.proximal {
                Some(MemberKind::TurningGuide) => guide(self.design.proximal_length(), sign, 0.0),
                _ => vec![(0.0, length, density)],
            };
            let base = about_p(leg, leg.chain.a);
            bars.push(self.frame_bar(MemberKind::Link, base, bar.direction * sign, length, pieces));
        }
        let offset = leg.chain.distal.offset;
        let (sign, length) = (1f64.copysign(offset), offset.abs());
        let whole = self.design.link_length();
        let tube = settings.legs.tube_length(whole);
        let pieces = match chain.distal {
            MemberKind::TelescopicLeg => {
                vec![(0.0, tube, density), (length - (whole - tube), length, density)]
            }
            MemberKind::Guide if chain.joints[2] == JointKind::Prismatic => guide(whole, -sign, length),
            MemberKind::Guide => guide(whole, sign, 0.0),
            _ => vec![(0.0, length, density)],
        };
        let axis = leg.chain.distal.direction * sign;
        bars.push(self.frame_bar(chain.distal, about_p(leg, leg.chain.b), axis, length, pieces));
        let (axis, length) = (-leg.arm.normalize(), leg.arm.length());
        let pieces = vec![(0.0, length, self.density(MemberKind::PlatformBar))];
        bars.push(self.frame_bar(MemberKind::PlatformBar, leg.arm, axis, length, pieces));
        bars
    }

    fn frame_bar(
        &self,
        kind: MemberKind,
        base: DVec2,
        axis: DVec2,
        length: f64,
        pieces: Vec<(f64, f64, f64)>,
    ) -> FrameBar {
        let (section, radius) = self.section(kind);
        let compliance = BarCompliance::new(&self.model.settings().material, section, radius);
        FrameBar {
            base,
            axis,
            length,
            pieces,
            compliance: compliance.expect("stiff"),
            gyration: radius * radius / 4.0,
            is_telescopic: kind == MemberKind::TelescopicLeg,
        }
    }

    /// The mass that a leg opposes to a displacement of the platform: the displacement is shared between joints and bars so that the
    /// elastic energy is least.
    fn frame_mass(&self, leg: &LegPosture) -> Matrix6<f64> {
        let bars = self.frame_bars(leg);
        let architecture = self.design.architecture();
        let chain = architecture.chain();
        let twists = [0, 1, 2].map(|joint| joint_twist(leg, chain, joint));
        let into: Vec<Matrix6<f64>> = bars.iter().map(FrameBar::moves_by_tip).collect();
        let solution = self.shared_displacement(&bars, &twists, &into);
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
            while joint < 3 && chain.points[joint] as usize <= place + first {
                let change = twists[joint] * rates.row(joint);
                let change = change.fixed_view::<6, 6>(0, 0).into_owned();
                if bar.is_telescopic && chain.joints[joint] == JointKind::Prismatic {
                    slide = change;
                } else {
                    twist += change;
                    if joint == 0 && chain.is_on_rails() {
                        for direction in AXES {
                            let row = moved(about_p(leg, leg.chain.b), &twist, direction, false);
                            add(row, DRIVES.slider_mass);
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

    /// The rates of the joints and the end displacements of the bars with which the platform moves, for each of its displacements.
    fn shared_displacement(
        &self,
        bars: &[FrameBar],
        twists: &[Vector6<f64>; 3],
        into: &[Matrix6<f64>],
    ) -> DMatrix<f64> {
        let architecture = self.design.architecture();
        // Unknowns: the joints, the end displacements of each bar in its axes, and the reactions.
        let count = 3 + 6 * bars.len();
        let mut system = DMatrix::<f64>::zeros(count + 6, count + 6);
        let actuator = self.model.settings().actuators.of(architecture.actuator());
        system[(architecture.driven(), architecture.driven())] = actuator;
        for (place, bar) in bars.iter().enumerate() {
            let stiffness = bar.compliance.matrix(bar.length).try_inverse().expect("stiff");
            system
                .view_mut((3 + 6 * place, 3 + 6 * place), (6, 6))
                .copy_from(&stiffness);
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
        scaled_solution(system, right)
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
    let [lengthwise, sideways, upwards] = bar.axes();
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
                let across = across + rigid(sideways, false);
                let turn = turn + rigid(upwards, true);
                let (up, lift) = bend(local(2), -local(4));
                let up = up + rigid(upwards, false);
                let lift = lift - rigid(sideways, true);
                let mut along = rigid(lengthwise, false);
                along += match (bar.is_telescopic, piece) {
                    (false, _) => local(0) * s,
                    (true, 0) => Vector6::zeros(),
                    // The rod moves along the leg as its end does.
                    (true, _) => local(0) + moved(at, slide, lengthwise, false),
                };
                let twisted = local(3) * s + rigid(lengthwise, true);
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
        for direction in AXES {
            add(moved(centre, &Matrix6::identity(), direction, false), PAYLOAD.mass);
        }
        for (row, share) in [(3, 0.5), (4, 0.5), (5, 1.0)] {
            add(
                Matrix6::identity().row(row).transpose().into_owned(),
                share * PAYLOAD.inertia,
            );
        }
        let report = subject.report_at(&subject.pose);
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
