//! The general form: a 6×6 virtual-joint model of each leg (docs/model.md, section 4.2).
//!
//! `S_i = Σ J_k C_k J_kᵀ` is the sum over the springs of the chain, mapped to `P`. `K_i` is the upper-left 6×6 block of
//! the inverse of `[[S_i, J_q], [J_qᵀ, 0]]`; the paper prints `J_q` where its transpose belongs. This form does not use
//! the decoupling of the in-plane and out-of-plane blocks, so the tests check the closed form against it.

use glam::DVec2;
use nalgebra::{Matrix3, Matrix6, SMatrix, Vector3, Vector6};

use super::{BarCompliance, StiffnessModel};
use crate::mechanism::{Architecture, JointKind, JointPoint, LegPosture, Posture};

/// Computes `K` of the manipulator at `P`, linear first, in base axes. Returns `None` if a leg's system is singular.
///
/// The entries of the bordered system range in magnitude from L/(EA) to L³/(3EI). For bars with a radius below 5 mm the
/// inverse loses digits, and the closed form is more accurate.
pub fn stiffness(model: &StiffnessModel, architecture: Architecture, posture: &Posture) -> Option<Matrix6<f64>> {
    let mut total = Matrix6::zeros();
    for leg in &posture.legs {
        total += leg_stiffness(model, architecture, leg)?;
    }
    Some(total)
}

/// Computes `K_i` of a leg from its chain alone: the springs of its bars, the actuated joint as a spring, and the passive joints as
/// free motions. Returns `None` if its system is singular.
pub fn leg_stiffness(model: &StiffnessModel, architecture: Architecture, posture: &LegPosture) -> Option<Matrix6<f64>> {
    let chain = &posture.chain;
    // All positions are relative to P.
    let p = DVec2::ZERO;
    let c = posture.arm;
    let [a, b] = [chain.a, chain.b].map(|point| point - chain.c + c);
    let twist = |joint: usize| {
        let description = architecture.chain();
        match (description.joints[joint], chain.guides[joint]) {
            (JointKind::Prismatic, Some(d)) => Vector6::new(d.x, d.y, 0.0, 0.0, 0.0, 0.0),
            _ => revolute(match description.points[joint] {
                JointPoint::A => a,
                JointPoint::B => b,
                JointPoint::C => c,
            }),
        }
    };

    let driven = architecture.driven();
    let mut s = twist(driven) * twist(driven).transpose() * model.actuator;
    // A bar of length 0 is rigid.
    if let Some(bar) = chain.proximal.filter(|bar| bar.offset != 0.0) {
        s += spring(&model.leg_bar, bar.direction * bar.offset, bar.offset.abs(), b);
    }
    if chain.beam > 0.0 {
        let direction = chain.distal.direction * chain.distal.offset;
        s += spring(&model.leg_bar, direction, chain.beam, c);
    }
    s += spring(&model.platform_bar, -c, c.length(), p);
    if let (Some(rail), Some(slider), Some(axis)) = (&model.rail, chain.slider, chain.guides[0]) {
        s += moved_to_p(rail.at(slider).matrix(), axis, b);
    }

    let mut bordered = SMatrix::<f64, 8, 8>::zeros();
    bordered.fixed_view_mut::<6, 6>(0, 0).copy_from(&s);
    let passive = (0..3).filter(|&joint| joint != driven);
    for (column, joint) in passive.enumerate() {
        let twist = twist(joint);
        bordered.fixed_view_mut::<6, 1>(0, 6 + column).copy_from(&twist);
        bordered
            .fixed_view_mut::<1, 6>(6 + column, 0)
            .copy_from(&twist.transpose());
    }
    let inverse = bordered.full_piv_lu().try_inverse()?;
    Some(inverse.fixed_view::<6, 6>(0, 0).into_owned())
}

/// Returns the compliance at `P` of a bar along `direction` whose tip is at `tip` (relative to `P`).
fn spring(section: &BarCompliance, direction: DVec2, length: f64, tip: DVec2) -> Matrix6<f64> {
    moved_to_p(section.matrix(length), direction / direction.length(), tip)
}

/// Returns a compliance in axes along the unit vector `x`, at `tip` (relative to `P`), as one at `P` in base axes.
fn moved_to_p(compliance: Matrix6<f64>, x: DVec2, tip: DVec2) -> Matrix6<f64> {
    let rotation = Matrix3::from_columns(&[Vector3::new(x.x, x.y, 0.0), Vector3::new(-x.y, x.x, 0.0), Vector3::z()]);
    // The Jacobian gives the twist at P of a rigid body whose point `tip` moves with the spring:
    // v_P = v + ω × (P − tip).
    let lever = Vector3::new(-tip.x, -tip.y, 0.0);
    let mut jacobian = Matrix6::zeros();
    jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(&rotation);
    jacobian.fixed_view_mut::<3, 3>(3, 3).copy_from(&rotation);
    jacobian
        .fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&(-lever.cross_matrix() * rotation));
    jacobian * compliance * jacobian.transpose()
}

/// Returns the twist at `P` of a unit rotation about the z axis through `joint` (relative to `P`).
fn revolute(joint: DVec2) -> Vector6<f64> {
    Vector6::new(joint.y, -joint.x, 0.0, 0.0, 0.0, 1.0)
}
