//! The closed form reduced to `k_xy`, `k_z` and `k_φz`, at several poses at once (docs/model.md, sections 4.3 to 4.5).
//!
//! The compliance along a leg's line depends only on the leg's transmission, on the moment of that line about `P` and,
//! for a telescopic leg, on the length of the leg. Out of the plane, `K_zz` of a leg is `det S_φφ / det S`, where `S`
//! is the sum of the compliances of its bars and `S_φφ` the block of the rotations. Neither determinant depends on the
//! reference point or on the axes. They are therefore computed at `C_i` in axes along `u_i`; for a leg with two bars
//! (platform bar included) they are polynomials in the cosine of the angle between the bars.

use super::planar::{add_bar, in_plane_block, inverse, vertical_schur};
use super::{BarCompliance, StiffnessDefinition, StiffnessModel};
use crate::kinematics::Jacobian;
use crate::lanes::{Planar, Real};
use crate::mechanism::{Design, LegLanes};
use crate::spatial::{LEGS, smaller_eigenvalue};

/// Compliances of one design divided by two reference compliances, so that their products do not overflow or underflow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reduced {
    /// Reference for the compliances along a leg's line \[m/N\].
    along_unit: f64,
    /// Compliance of the actuator, per squared transmission.
    actuator: f64,
    /// Axial compliance of a leg bar, per metre of its length.
    leg_axial: f64,
    /// Axial compliance of a proximal bar, per square of its component along the line.
    proximal_axial: f64,
    /// Bending compliance of a proximal bar, per square of its component normal to the line.
    proximal_bending: f64,
    /// Compliance of the platform bar if the line passes through `P`.
    platform_base: f64,
    /// Additional compliance of the platform bar, per squared moment of the line about `P`.
    platform_moment: f64,
    /// Reference for the bending and torsional compliances \[1/(N·m²)\].
    bend_unit: f64,
    /// Bending and torsional compliance of a leg bar, per metre of its length.
    leg: [f64; 2],
    /// Bending and torsional compliance of the platform bar of length `r`.
    platform: [f64; 2],
    platform_radius: f64,
    /// 1/L_b \[1/m\].
    to_link: f64,
}

impl Reduced {
    pub(super) fn new(design: &Design, leg: &BarCompliance, platform: &BarCompliance, actuator: f64) -> Self {
        let (r, link) = (design.platform_radius, design.link_length);
        let along_unit = actuator + link * leg.axial + r * platform.axial;
        let bend_unit = leg.bending.max(platform.bending);
        Self {
            along_unit,
            actuator: actuator / along_unit,
            leg_axial: leg.axial / along_unit,
            proximal_axial: leg.axial / link / along_unit,
            proximal_bending: leg.bending * link / 3.0 / along_unit,
            platform_base: r * platform.axial / along_unit,
            platform_moment: (r / 3.0 * platform.bending - platform.axial / r) / along_unit,
            bend_unit,
            leg: [leg.bending / bend_unit, leg.torsion / bend_unit],
            platform: [r * platform.bending / bend_unit, r * platform.torsion / bend_unit],
            platform_radius: r,
            to_link: 1.0 / link,
        }
    }

    /// Computes the compliance along the line of a leg, in multiples of `along_unit`.
    #[inline(always)]
    fn along_line<V: Real>(&self, leg: &LegLanes<V>) -> V {
        let like = leg.moment;
        let compliance = leg.transmission * leg.transmission * like.splat(self.actuator)
            + leg.distal * like.splat(self.leg_axial)
            + like.splat(self.platform_base)
            + leg.moment * leg.moment * like.splat(self.platform_moment);
        match leg.proximal {
            Some(bar) => {
                compliance
                    + bar.x * bar.x * like.splat(self.proximal_axial)
                    + bar.y * bar.y * like.splat(self.proximal_bending)
            }
            None => compliance,
        }
    }

    /// Computes `det S_φφ` and `det S` of a leg, whose quotient is its `K_zz` in multiples of 1/`bend_unit`.
    #[inline(always)]
    fn vertical<V: Real>(&self, leg: &LegLanes<V>) -> [V; 2] {
        let like = leg.moment;
        let radius = self.platform_radius;
        let ([b1, t1], [b2, t2]) = (self.leg, self.platform);
        // Direction of the platform bar, from C to P, in the axes of the distal bar.
        let to_unit = like.splat(1.0 / radius);
        let cosine = -(leg.along * to_unit);
        let length = leg.distal;
        let (bend, twist) = (length * like.splat(b1), length * like.splat(t1));
        let half = like.splat(0.5);
        let lift = like.splat(b2 * radius * radius / 3.0) + bend * length * length * like.splat(1.0 / 3.0);
        let (p, q) = (half * bend * length, like.splat(0.5 * b2 * radius));
        let (b2, t2) = (like.splat(b2), like.splat(t2));
        let square = cosine * cosine;
        match leg.proximal {
            None => {
                // Coefficients of the polynomials in the cosine, independent of the pose for bars of constant length.
                let two = like.splat(2.0);
                let minor = [(twist + b2) * (bend + t2), (twist - bend) * (b2 - t2)];
                let tilt = [
                    p * p * (twist + b2) + q * q * (t2 + bend),
                    two * p * q * (twist + t2),
                    p * p * (t2 - b2) + q * q * (twist - bend),
                ];
                [
                    minor[0] + square * minor[1],
                    (lift * minor[0] - tilt[0]) + cosine * tilt[1] + square * (lift * minor[1] - tilt[2]),
                ]
            }
            Some(bar) => {
                let sine = leg.moment * to_unit;
                let to_unit = like.splat(self.to_link);
                let (x, y) = (bar.x * to_unit, bar.y * to_unit);
                let middle = x + half;
                let lift = lift + length * length * (bend * (middle * middle + like.splat(1.0 / 12.0)) + twist * y * y);
                let tilt_x = length * y * ((bend - twist) * x + half * bend) - q * sine;
                let tilt_y = q * cosine - p - length * (twist * y * y + bend * middle * x);
                let xx = twist * x * x + bend * y * y + twist + t2 * square + b2 * sine * sine;
                let xy = (twist - bend) * x * y + (t2 - b2) * cosine * sine;
                let yy = twist * y * y + bend * x * x + bend + t2 * sine * sine + b2 * square;
                let minor = xx * yy - xy * xy;
                let tilt = tilt_x * tilt_x * yy - tilt_x * tilt_y * xy * like.splat(2.0) + tilt_y * tilt_y * xx;
                [minor, lift * minor - tilt]
            }
        }
    }
}

impl StiffnessModel {
    /// Computes `k_xy`, `k_z` and `k_φz` according to `definition`; valid in the lanes where all legs reach the pose.
    #[inline(always)]
    pub(crate) fn stiffness_value_lanes<V: Real>(
        &self,
        definition: StiffnessDefinition,
        legs: &[LegLanes<V>; LEGS],
        arms: &[Planar<V>; LEGS],
        jacobian: &Jacobian<V>,
    ) -> [V; 3] {
        let like = jacobian.ux[0];
        let reduced = &self.reduced;
        let c = [
            reduced.along_line(&legs[0]),
            reduced.along_line(&legs[1]),
            reduced.along_line(&legs[2]),
        ];
        // A single division gives the three reciprocals.
        let pairs = [c[1] * c[2], c[2] * c[0], c[0] * c[1]];
        let one = like.splat(1.0 / reduced.along_unit) / (c[0] * pairs[0]);
        let stiffness = [pairs[0] * one, pairs[1] * one, pairs[2] * one];
        match definition {
            StiffnessDefinition::Stiffness => {
                let zero = like.splat(0.0);
                let (mut xx, mut xy, mut yy, mut mm) = (zero, zero, zero, zero);
                for i in 0..LEGS {
                    let (x, y, m) = (jacobian.ux[i], jacobian.uy[i], jacobian.moment[i]);
                    let (kx, ky) = (x * stiffness[i], y * stiffness[i]);
                    xx = xx + x * kx;
                    xy = xy + x * ky;
                    yy = yy + y * ky;
                    mm = mm + m * m * stiffness[i];
                }
                let [n0, d0] = reduced.vertical(&legs[0]);
                let [n1, d1] = reduced.vertical(&legs[1]);
                let [n2, d2] = reduced.vertical(&legs[2]);
                // A single division gives the sum of the three quotients.
                let sum = n0 * (d1 * d2) + d0 * (n1 * d2 + n2 * d1);
                let k_z = like.splat(1.0 / reduced.bend_unit) * sum / (d0 * (d1 * d2));
                [smaller_eigenvalue(xx, xy, yy), k_z, mm]
            }
            StiffnessDefinition::Compliance => {
                // The legs are written out, because an array indexed in a loop would be kept in memory.
                let in_plane = in_plane_block(jacobian, &stiffness);
                let k0 = inverse(&self.bending_lanes(&legs[0], arms[0]));
                let k1 = inverse(&self.bending_lanes(&legs[1], arms[1]));
                let k2 = inverse(&self.bending_lanes(&legs[2], arms[2]));
                let mut k = k0;
                for entry in 0..k.len() {
                    k[entry] = k0[entry] + k1[entry] + k2[entry];
                }
                let (k_xy, k_phi_z) = Self::in_plane_stiffness_values(&in_plane, definition);
                [k_xy, vertical_schur(&k), k_phi_z]
            }
        }
    }

    /// Computes `k_xy` by compliance, whatever definition the study uses: the reciprocal of the largest displacement per unit of
    /// force in the plane \[N/m\].
    #[inline(always)]
    pub(crate) fn compliant_k_xy_lanes<V: Real>(&self, legs: &[LegLanes<V>; LEGS], jacobian: &Jacobian<V>) -> V {
        let like = jacobian.ux[0];
        let reduced = &self.reduced;
        let along = |compliance: V| like.splat(1.0 / reduced.along_unit) / compliance;
        let stiffness = [
            along(reduced.along_line(&legs[0])),
            along(reduced.along_line(&legs[1])),
            along(reduced.along_line(&legs[2])),
        ];
        let in_plane = in_plane_block(jacobian, &stiffness);
        Self::in_plane_stiffness_values(&in_plane, StiffnessDefinition::Compliance).0
    }

    /// Computes the upper triangle of the out-of-plane compliance of one leg at `P` in base axes.
    #[inline(always)]
    fn bending_lanes<V: Real>(&self, leg: &LegLanes<V>, arm: Planar<V>) -> [V; 6] {
        let like = leg.moment;
        let zero = like.splat(0.0);
        let mut s = [zero; 6];
        let radius = like.splat(self.platform_radius);
        let platform_axis = arm.scaled(like.splat(-1.0 / self.platform_radius));
        add_bar(
            &mut s,
            &self.platform_bar,
            platform_axis,
            radius,
            Planar::new(zero, zero),
        );
        let to_p = Planar::new(-arm.x, -arm.y);
        add_bar(&mut s, &self.leg_bar, leg.u, leg.distal, to_p);
        if let Some(bar) = leg.proximal {
            let axis = leg.u.scaled(bar.x).plus(leg.u.perp().scaled(bar.y));
            let axis = axis.scaled(like.splat(self.reduced.to_link));
            let to_p = leg.u.scaled(leg.distal).minus(arm);
            add_bar(&mut s, &self.leg_bar, axis, leg.distal, to_p);
        }
        s
    }
}
