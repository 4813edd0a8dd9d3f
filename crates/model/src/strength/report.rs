//! The strength of one pose in full: every member, joint and drive.

use super::buckling::Column;
use super::path::BARS;
use super::resultants::LoadedLeg;
use super::{StrengthInputs, StrengthModel, StrengthSet, StrengthValue};
use crate::clearance::MemberId;
use crate::mechanism::JointKind;
use crate::spatial::LEGS;

/// Strength of a bar at a pose: the worst of the set of wrenches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemberStrength {
    /// The bar.
    pub member: MemberId,
    /// Largest equivalent stress \[Pa\].
    pub stress: f64,
    /// Where it is, from 0 at the base to 1 at the platform.
    pub share: f64,
    /// Least and largest force along the bar, positive in tension \[N\].
    pub axial: [f64; 2],
    /// Largest magnitude of the bending moment about z \[N·m\].
    pub moment_in_plane: f64,
    /// Largest magnitude of the bending moment about the normal of the bar in the plane \[N·m\].
    pub moment_out_of_plane: f64,
    /// Largest magnitude of the torsion \[N·m\].
    pub torsion: f64,
    /// `N_E`: Euler's load with pinned ends \[N\].
    pub euler: f64,
    /// Effective length in units of the length, in the plane and out of it; `None` on rails that bend.
    pub effective_lengths: Option<[f64; 2]>,
    /// Factor by which the loads have to grow until the bar buckles, were it alone compressed; `None` on rails that bend.
    pub buckling_factor: Option<f64>,
}

/// What a joint holds at a pose: the worst of the set of wrenches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointStrength {
    /// Index of the leg, from 0.
    pub leg: usize,
    /// Place of the joint in the leg, from the base, from 0.
    pub place: usize,
    /// Kind.
    pub kind: JointKind,
    /// Whether it is driven.
    pub is_driven: bool,
    /// Force in the plane, of a prismatic joint across its direction \[N\].
    pub radial: f64,
    /// Force along z \[N\].
    pub axial: f64,
    /// Both together \[N\].
    pub force: f64,
    /// Tilting moment, of a prismatic joint all of the moment \[N·m\].
    pub moment: f64,
}

/// Strength of a design at a pose.
#[derive(Debug, Clone, PartialEq)]
pub struct StrengthReport {
    /// Bars of the legs and of the platform, leg by leg from the base; a guide whose carriage is at its joint is left out.
    pub members: Vec<MemberStrength>,
    /// Joints, leg by leg from the base.
    pub joints: Vec<JointStrength>,
    /// Force or torque of each drive \[N or N·m\]: by the drive and positive along the joint value under a single wrench, the largest
    /// magnitude under a set.
    pub actuators: [f64; LEGS],
    /// Largest stress of any bar \[Pa\].
    pub stress: f64,
    /// Yield strength divided by that stress, at most 10⁶; `None` without a yield strength.
    pub safety_factor: Option<f64>,
    /// Factor against buckling of the manipulator, a lower bound, at most 10⁶; `None` on rails that bend.
    pub buckling_factor: Option<f64>,
    /// Largest force of any joint \[N\].
    pub joint_force: f64,
    /// Largest moment of any joint \[N·m\].
    pub joint_moment: f64,
}

impl JointStrength {
    /// Returns the name, for example `leg1_joint2`.
    pub fn name(&self) -> String {
        format!("leg{}_joint{}", self.leg + 1, self.place + 1)
    }
}

impl StrengthReport {
    /// Returns the largest force or torque of the drives of a kind \[N or N·m\]; `None` if the drives are of another kind.
    pub fn largest_effort(&self, kind: JointKind) -> Option<f64> {
        let is_of_kind = self.joints.iter().any(|joint| joint.is_driven && joint.kind == kind);
        is_of_kind.then(|| self.actuators.iter().fold(0.0, |most, effort| effort.abs().max(most)))
    }
}

impl StrengthModel {
    /// Returns the strength at a pose; `None` at a singular one.
    pub fn report(&self, inputs: &StrengthInputs<f64>) -> Option<StrengthReport> {
        let paths = self.paths_at(inputs);
        let legs = self.legs(inputs, &paths);
        let loaded = self.loaded(&legs);
        let columns = self.columns(&loaded, inputs);
        let mut members = Vec::new();
        let mut joints = Vec::new();
        for (index, leg) in loaded.legs.iter().enumerate() {
            for bar in self.first()..BARS {
                if leg.path.bars[bar].length == 0.0 {
                    continue;
                }
                members.push(self.member(leg, (index, bar), &columns[index][bar]));
            }
            for (place, joint) in self.paths[index].joints.iter().enumerate() {
                let held = self.joint_loads(leg, index, place);
                joints.push(JointStrength {
                    leg: index,
                    place,
                    kind: joint.kind,
                    is_driven: joint.is_driven,
                    radial: held.radial,
                    axial: held.axial,
                    force: held.force,
                    moment: held.moment,
                });
            }
        }
        let all = StrengthValue::ALL
            .into_iter()
            .fold(StrengthSet::default(), StrengthSet::with);
        let values = self.values(&loaded, inputs, all);
        let value = |value: StrengthValue| Some(values[value as usize]).filter(|value| value.is_finite());
        let is_single = self.loads.range == [0.0; 6];
        Some(StrengthReport {
            members,
            joints,
            actuators: [0, 1, 2].map(|index| {
                let leg = &loaded.legs[index];
                match is_single {
                    true => -leg.transmission * leg.line.value,
                    false => leg.transmission.abs() * leg.line.most(),
                }
            }),
            stress: value(StrengthValue::Stress)?,
            safety_factor: value(StrengthValue::SafetyFactor),
            buckling_factor: value(StrengthValue::BucklingFactor),
            joint_force: value(StrengthValue::JointForce)?,
            joint_moment: value(StrengthValue::JointMoment)?,
        })
    }

    /// Returns the strength of a bar, given by its leg and its place in the leg.
    fn member(&self, leg: &LoadedLeg<'_, f64>, (index, bar): (usize, usize), column: &Column<f64>) -> MemberStrength {
        let buckles = !self.is_on_bending_rails;
        let mut member = MemberStrength {
            member: MemberId {
                leg: index,
                kind: self.paths[index].members[bar],
            },
            stress: 0.0,
            share: 0.0,
            axial: [f64::INFINITY, f64::NEG_INFINITY],
            moment_in_plane: 0.0,
            moment_out_of_plane: 0.0,
            torsion: 0.0,
            euler: 1.0 / column.per_euler,
            effective_lengths: buckles.then(|| column.effective_lengths()),
            buckling_factor: buckles.then(|| column.factor()),
        };
        let loads = self.bar_loads(leg, bar);
        for section in 0..self.sections() {
            let carried = self.section_loads(leg, bar, &loads, section);
            let stress = self.squared_stress(bar, &carried).sqrt();
            if stress > member.stress {
                member.stress = stress;
                member.share = section as f64 / (self.sections() - 1) as f64;
            }
            member.axial[0] = member.axial[0].min(carried.axial.value - carried.axial.range);
            member.axial[1] = member.axial[1].max(carried.axial.value + carried.axial.range);
            member.moment_in_plane = member.moment_in_plane.max(carried.in_plane.most());
            member.moment_out_of_plane = member.moment_out_of_plane.max(carried.out_of_plane.most());
            member.torsion = member.torsion.max(carried.torsion.most());
        }
        member
    }
}
