//! The strength of a design at a pose as JSON. Keys are a contract: new ones may be added, none may be renamed.

use serde::Serialize;

use kinefront_model::mechanism::JointKind;
use kinefront_model::strength::{JointStrength, MemberStrength, StrengthReport};

/// The strength in the output of `kinefront pose --json`.
#[derive(Debug, Serialize)]
pub struct StrengthJson {
    stress_max_pa: f64,
    safety_factor_min: Option<f64>,
    buckling_factor_min: Option<f64>,
    joint_force_max_n: f64,
    joint_moment_max_nm: f64,
    actuator_force_max_n: Option<f64>,
    actuator_torque_max_nm: Option<f64>,
    members: Vec<MemberJson>,
    joints: Vec<JointJson>,
    /// Force or torque of each drive \[N or N·m\].
    actuators: [f64; 3],
}

#[derive(Debug, Serialize)]
struct MemberJson {
    name: String,
    stress_pa: f64,
    /// Where the stress is largest, from 0 at the base to 1 at the platform.
    share: f64,
    axial_min_n: f64,
    axial_max_n: f64,
    moment_in_plane_nm: f64,
    moment_out_of_plane_nm: f64,
    torsion_nm: f64,
    euler_n: f64,
    k_in_plane: Option<f64>,
    k_out_of_plane: Option<f64>,
    buckling_factor: Option<f64>,
}

#[derive(Debug, Serialize)]
struct JointJson {
    name: String,
    /// `R` or `P`.
    kind: &'static str,
    driven: bool,
    radial_n: f64,
    axial_n: f64,
    force_n: f64,
    moment_nm: f64,
}

impl From<&MemberStrength> for MemberJson {
    fn from(member: &MemberStrength) -> Self {
        let [axial_min_n, axial_max_n] = member.axial;
        let (k_in_plane, k_out_of_plane) = member.effective_lengths.map(<(f64, f64)>::from).unzip();
        Self {
            name: member.member.to_string(),
            stress_pa: member.stress,
            share: member.share,
            axial_min_n,
            axial_max_n,
            moment_in_plane_nm: member.moment_in_plane,
            moment_out_of_plane_nm: member.moment_out_of_plane,
            torsion_nm: member.torsion,
            euler_n: member.euler,
            k_in_plane,
            k_out_of_plane,
            buckling_factor: member.buckling_factor,
        }
    }
}

impl From<&JointStrength> for JointJson {
    fn from(joint: &JointStrength) -> Self {
        Self {
            name: joint.name(),
            kind: joint.kind.letter(),
            driven: joint.is_driven,
            radial_n: joint.radial,
            axial_n: joint.axial,
            force_n: joint.force,
            moment_nm: joint.moment,
        }
    }
}

impl From<&StrengthReport> for StrengthJson {
    fn from(report: &StrengthReport) -> Self {
        Self {
            stress_max_pa: report.stress,
            safety_factor_min: report.safety_factor,
            buckling_factor_min: report.buckling_factor,
            joint_force_max_n: report.joint_force,
            joint_moment_max_nm: report.joint_moment,
            actuator_force_max_n: report.largest_effort(JointKind::Prismatic),
            actuator_torque_max_nm: report.largest_effort(JointKind::Revolute),
            members: report.members.iter().map(MemberJson::from).collect(),
            joints: report.joints.iter().map(JointJson::from).collect(),
            actuators: report.actuators,
        }
    }
}
