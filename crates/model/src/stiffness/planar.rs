//! The closed planar form: what the general form reduces to when every joint axis is normal to the plane.
//!
//! In the plane a leg with two passive revolutes carries only a force along `u_i`, so its stiffness is
//! `w wᵀ / c` with `w = (u_i, (C_i − P) × u_i)` and `c` the compliance along that line. Out of the plane the revolutes
//! do not act, and the leg is the 3×3 inverse of its bars' summed compliance.

use glam::DVec2;
use nalgebra::{Matrix3, Matrix6};

use super::lanes::Reduced;
use super::{BarCompliance, Material, Rigidity, StiffnessDefinition};
use crate::kinematics::Jacobian;
use crate::lanes::{Planar, Real};
use crate::mechanism::{Actuator, Design, Leg, LegPosture, Manipulator, Posture};
use crate::spatial::{LEGS, cross, smaller_eigenvalue};

/// Compliances of one design's bars and actuators; `None` in place of it stands for an infinitely compliant design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StiffnessModel {
    pub(super) leg_bar: BarCompliance,
    pub(super) platform_bar: BarCompliance,
    pub(super) platform_radius: f64,
    /// Compliance of the actuator \[m/N or rad/(N·m)\].
    pub(super) actuator: f64,
    /// The same, prepared for several poses at once.
    pub(super) reduced: Reduced,
}

/// Stiffness of the actuators (SPEC section 8, no. 4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActuatorStiffness {
    /// `K_act` of prismatic actuators \[N/m\].
    pub prismatic: f64,
    /// `K_act` of revolute actuators \[N·m/rad\].
    pub revolute: f64,
}

impl ActuatorStiffness {
    /// That of a kind of actuator \[N/m or N·m/rad\].
    pub fn of(&self, actuator: Actuator) -> f64 {
        match actuator {
            Actuator::Prismatic => self.prismatic,
            Actuator::Revolute => self.revolute,
        }
    }
}

/// The stiffness at a pose in its two decoupled blocks, at `P`, base axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarStiffness {
    /// `(x, y, φz)` block, upper triangle: xx, xy, xφ, yy, yφ, φφ.
    pub in_plane: [f64; 6],
    /// `(z, φx, φy)` block, upper triangle: zz, zφx, zφy, φxφx, φxφy, φyφy.
    pub out_of_plane: [f64; 6],
}

/// A bar of a leg at a posture.
pub(super) struct Bar<'a> {
    section: &'a BarCompliance,
    /// Unit vector towards its tip.
    axis: DVec2,
    length: f64,
    /// From its tip to `P`.
    to_p: DVec2,
}

impl Bar<'_> {
    /// Adds its out-of-plane compliance at `P`.
    #[inline]
    pub(super) fn add_to(&self, s: &mut [f64; 6]) {
        add_bar(s, self.section, self.axis.into(), self.length, self.to_p.into());
    }
}

impl StiffnessModel {
    /// The model of `design`; `None` when a bar is infinitely compliant, which makes every stiffness 0.
    pub fn new<L: Leg>(design: &Design, material: &Material, actuators: &ActuatorStiffness) -> Option<Self> {
        let leg_bar = BarCompliance::new(material, design.leg_bar_radius)?;
        let platform_bar = BarCompliance::new(material, design.platform_bar_radius)?;
        let actuator = 1.0 / actuators.of(L::ACTUATOR);
        Some(Self {
            leg_bar,
            platform_bar,
            platform_radius: design.platform_radius,
            actuator,
            reduced: Reduced::new(design, &leg_bar, &platform_bar, actuator),
        })
    }

    /// `c_i`: compliance along the line of leg `index` \[m/N\]: actuator, axial, and bending of the bars that the
    /// line is not along.
    #[inline]
    fn line_compliance<L: Leg>(&self, leg: &L, posture: &LegPosture, arm: DVec2) -> f64 {
        let [actuator, distal, platform, proximal] = self.line_compliances(leg, posture, arm);
        actuator + distal + platform + proximal
    }

    /// Its parts: actuator, last bar, platform's bar, and the bar before the last, 0 where there is none.
    #[inline]
    pub(super) fn line_compliances<L: Leg>(&self, leg: &L, posture: &LegPosture, arm: DVec2) -> [f64; 4] {
        let u = posture.u;
        let proximal = leg.proximal_bar(posture).map_or(0.0, |bar| {
            along_line(&self.leg_bar, u, bar.to - bar.from, posture.length)
        });
        [
            posture.drive * posture.drive * self.actuator,
            leg.distal_length(posture) * self.leg_bar.axial,
            along_line(&self.platform_bar, u, arm, self.platform_radius),
            proximal,
        ]
    }

    /// The in-plane block at a posture, upper triangle as in [`PlanarStiffness::in_plane`].
    #[inline]
    pub fn in_plane<L: Leg>(&self, manipulator: &Manipulator<L>, posture: &Posture, jacobian: &Jacobian) -> [f64; 6] {
        let stiffness = [0, 1, 2].map(|i| {
            let compliance = self.line_compliance(&manipulator.legs[i], &posture.legs[i], posture.arms[i]);
            1.0 / compliance
        });
        in_plane_block(jacobian, &stiffness)
    }

    /// Out-of-plane compliance of one leg at `P`: what its bars give way, upper triangle as in
    /// [`PlanarStiffness::out_of_plane`].
    #[inline]
    fn bending_compliance<L: Leg>(&self, leg: &L, posture: &LegPosture, arm: DVec2) -> [f64; 6] {
        let mut s = [0.0; 6];
        for bar in self.bars(leg, posture, arm).into_iter().flatten() {
            bar.add_to(&mut s);
        }
        s
    }

    /// The bars of one leg: the platform's, the last one, and the one before it.
    #[inline]
    pub(super) fn bars<L: Leg>(&self, leg: &L, posture: &LegPosture, arm: DVec2) -> [Option<Bar<'_>>; 3] {
        // The tip of the platform bar is P itself.
        let platform = Bar {
            section: &self.platform_bar,
            axis: -arm / self.platform_radius,
            length: self.platform_radius,
            to_p: DVec2::ZERO,
        };
        let distal = Bar {
            section: &self.leg_bar,
            axis: posture.u,
            length: leg.distal_length(posture),
            to_p: -arm,
        };
        let proximal = leg.proximal_bar(posture).map(|bar| Bar {
            section: &self.leg_bar,
            axis: (bar.to - bar.from) / posture.length,
            length: posture.length,
            to_p: posture.u * posture.length - arm,
        });
        [Some(platform), Some(distal), proximal]
    }

    /// `K_zz` alone \[N/m\]: all that the default definition of `k_z` needs.
    #[inline]
    pub fn vertical<L: Leg>(&self, manipulator: &Manipulator<L>, posture: &Posture) -> f64 {
        let mut k_z = 0.0;
        for i in 0..LEGS {
            let s = self.bending_compliance(&manipulator.legs[i], &posture.legs[i], posture.arms[i]);
            k_z += first_of_inverse(&s);
        }
        k_z
    }

    /// Both blocks at a posture.
    pub fn stiffness<L: Leg>(
        &self,
        manipulator: &Manipulator<L>,
        posture: &Posture,
        jacobian: &Jacobian,
    ) -> PlanarStiffness {
        let mut out_of_plane = [0.0; 6];
        for i in 0..LEGS {
            let s = self.bending_compliance(&manipulator.legs[i], &posture.legs[i], posture.arms[i]);
            for (sum, entry) in out_of_plane.iter_mut().zip(inverse(&s)) {
                *sum += entry;
            }
        }
        PlanarStiffness {
            in_plane: self.in_plane(manipulator, posture, jacobian),
            out_of_plane,
        }
    }

    /// `k_xy` and `k_φz` by `definition` from an in-plane block.
    #[inline(always)]
    pub fn in_plane_rigidity<V: Real>(k: &[V; 6], definition: StiffnessDefinition) -> (V, V) {
        let [xx, xy, xm, yy, ym, mm] = *k;
        match definition {
            StiffnessDefinition::Stiffness => (smaller_eigenvalue(xx, xy, yy), mm),
            StiffnessDefinition::Compliance => {
                // Schur complements: the inverse of a block of K⁻¹ is what is left of K when the rest is free.
                let (zero, two) = (xx.splat(0.0), xx.splat(2.0));
                let planar = xx * yy - xy * xy;
                let rotational = mm - (xm * xm * yy - two * xm * ym * xy + ym * ym * xx) / planar;
                let translational = smaller_eigenvalue(xx - xm * xm / mm, xy - xm * ym / mm, yy - ym * ym / mm);
                (
                    translational.larger(zero).where_set(mm.exceeds(zero), zero),
                    rotational.larger(zero).where_set(planar.exceeds(zero), zero),
                )
            }
        }
    }
}

impl PlanarStiffness {
    /// The stiffness of an infinitely compliant design.
    pub const ZERO: PlanarStiffness = PlanarStiffness {
        in_plane: [0.0; 6],
        out_of_plane: [0.0; 6],
    };

    /// `k_xy`, `k_z` and `k_φz` by `definition`.
    pub fn rigidity(&self, definition: StiffnessDefinition) -> Rigidity {
        let (k_xy, k_phi_z) = StiffnessModel::in_plane_rigidity(&self.in_plane, definition);
        let k_z = match definition {
            StiffnessDefinition::Stiffness => self.out_of_plane[0],
            StiffnessDefinition::Compliance => vertical_schur(&self.out_of_plane),
        };
        Rigidity { k_xy, k_z, k_phi_z }
    }

    /// The full matrix, linear first, at `P`, base axes.
    pub fn matrix(&self) -> Matrix6<f64> {
        let mut k = Matrix6::zeros();
        for (rows, block) in [([0, 1, 5], &self.in_plane), ([2, 3, 4], &self.out_of_plane)] {
            let block = symmetric(block);
            for i in 0..3 {
                for j in 0..3 {
                    k[(rows[i], rows[j])] = block[(i, j)];
                }
            }
        }
        k
    }
}

/// `Σ w wᵀ k`, `w` the rows of the direct Jacobian and `k` the stiffness along the legs' lines, upper triangle as in
/// [`PlanarStiffness::in_plane`].
#[inline(always)]
pub(super) fn in_plane_block<V: Real>(jacobian: &Jacobian<V>, stiffness: &[V; LEGS]) -> [V; 6] {
    let mut k = [stiffness[0].splat(0.0); 6];
    for i in 0..LEGS {
        let (x, y, m) = (jacobian.ux[i], jacobian.uy[i], jacobian.moment[i]);
        let (kx, ky, km) = (x * stiffness[i], y * stiffness[i], m * stiffness[i]);
        k[0] = k[0] + x * kx;
        k[1] = k[1] + x * ky;
        k[2] = k[2] + x * km;
        k[3] = k[3] + y * ky;
        k[4] = k[4] + y * km;
        k[5] = k[5] + m * km;
    }
    k
}

/// Displacement along `u` per unit of force on a line along `u` through one end of a bar whose other end is clamped.
#[inline]
fn along_line(section: &BarCompliance, u: DVec2, bar: DVec2, length: f64) -> f64 {
    // Dot and cross with the bar's full vector carry one power of its length each.
    let along = u.dot(bar);
    let across = cross(u, bar);
    (along * along * section.axial + across * across * (length * length / 3.0) * section.bending) / length
}

/// Adds to `s`, the out-of-plane compliance at `P`, a bar of direction `axis` whose tip lies at `P − to_p`.
#[inline(always)]
pub(super) fn add_bar<V: Real>(s: &mut [V; 6], section: &BarCompliance, axis: Planar<V>, length: V, to_p: Planar<V>) {
    let (half, twelfth) = (length.splat(0.5), length.splat(1.0 / 12.0));
    let bend = length * length.splat(section.bending);
    let twist = length * length.splat(section.torsion);
    let normal = axis.perp();
    // A rotation ω at the tip lifts P by ωx·dy − ωy·dx = lever·ω; in the bar's axes that lever has these parts.
    let lever = Planar::new(to_p.y, -to_p.x);
    let lever_x = lever.dot(axis);
    let lever_y = lever.dot(normal);
    // Bending seen from the bar's middle: a rotation L/EI there and a lift of L³/12EI, no coupling.
    let arm = lever_y - half * length;
    s[0] = s[0] + bend * (length * length * twelfth + arm * arm) + twist * lever_x * lever_x;
    let (x, y) = (twist * lever_x, bend * arm);
    s[1] = s[1] + x * axis.x + y * normal.x;
    s[2] = s[2] + x * axis.y + y * normal.y;
    s[3] = s[3] + twist * axis.x * axis.x + bend * normal.x * normal.x;
    s[4] = s[4] + twist * axis.x * axis.y + bend * normal.x * normal.y;
    s[5] = s[5] + twist * axis.y * axis.y + bend * normal.y * normal.y;
}

pub(super) fn symmetric(k: &[f64; 6]) -> Matrix3<f64> {
    Matrix3::new(k[0], k[1], k[2], k[1], k[3], k[4], k[2], k[4], k[5])
}

/// First entry of the inverse of a symmetric positive definite 3×3 matrix.
#[inline]
fn first_of_inverse(s: &[f64; 6]) -> f64 {
    let minor = s[3] * s[5] - s[4] * s[4];
    let determinant = s[0] * minor - s[1] * (s[1] * s[5] - s[4] * s[2]) + s[2] * (s[1] * s[4] - s[3] * s[2]);
    minor / determinant
}

/// Inverse of a symmetric positive definite 3×3 matrix, upper triangle.
#[inline(always)]
pub(super) fn inverse<V: Real>(s: &[V; 6]) -> [V; 6] {
    let [a, b, c, d, e, f] = *s;
    let cofactors = [
        d * f - e * e,
        c * e - b * f,
        b * e - c * d,
        a * f - c * c,
        b * c - a * e,
        a * d - b * b,
    ];
    let one = a.splat(1.0) / (a * cofactors[0] + b * cofactors[1] + c * cofactors[2]);
    [
        cofactors[0] * one,
        cofactors[1] * one,
        cofactors[2] * one,
        cofactors[3] * one,
        cofactors[4] * one,
        cofactors[5] * one,
    ]
}

/// What is left of `K_zz` when the rotations are free: `1/(K⁻¹)_zz`.
#[inline(always)]
pub(super) fn vertical_schur<V: Real>(k: &[V; 6]) -> V {
    let (zero, two) = (k[0].splat(0.0), k[0].splat(2.0));
    let minor = k[3] * k[5] - k[4] * k[4];
    let taken = (k[1] * k[1] * k[5] - two * k[1] * k[2] * k[4] + k[2] * k[2] * k[3]) / minor;
    (k[0] - taken).larger(zero).where_set(minor.exceeds(zero), zero)
}
