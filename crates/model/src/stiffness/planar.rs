//! The closed form, to which the general form reduces if every joint axis is normal to the plane (docs/model.md,
//! sections 4.3 and 4.4).
//!
//! In the plane, a leg with two passive joints transmits only a force along one line, so its stiffness is `w wᵀ / c`, where `w`
//! holds the direction `u_i` of the line and its moment about `P`, and `c` is the compliance along that line. Out of the plane, the
//! joints have no effect, and the stiffness of the leg is the inverse of the 3×3 sum of its bars' compliances.

use glam::DVec2;
use nalgebra::Matrix6;

use super::blocks::{add_bar, first_of_inverse, in_plane_block, symmetric, vertical_schur};
use super::rail::{LoadedRail, RailBeam};
use super::reduced::Reduced;
use super::{BarCompliance, Material, RailSettings, StiffnessDefinition, StiffnessValues};
use crate::kinematics::Jacobian;
use crate::lanes::Real;
use crate::mechanism::{CrossSections, Design, Geometry, JointKind, LegPosture, Posture};
use crate::spatial::{cross, smaller_eigenvalue};

/// Compliances of the bars and actuators of one design. An infinitely compliant design is represented by `None`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StiffnessModel {
    pub(super) leg_bar: BarCompliance,
    pub(super) platform_bar: BarCompliance,
    /// Compliance of the actuator \[m/N or rad/(N·m)\].
    pub(super) actuator: f64,
    /// Rails of the base; `None` if they are rigid, or if the chain has none.
    pub(super) rail: Option<RailBeam>,
    /// Compliances in the form that the evaluation of several poses at once needs.
    pub(super) reduced: Reduced,
}

/// Stiffness of the actuators, which the paper does not give (docs/model.md, section 11).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActuatorStiffness {
    /// `K_act` of prismatic actuators \[N/m\].
    pub prismatic: f64,
    /// `K_act` of revolute actuators \[N·m/rad\].
    pub revolute: f64,
}

impl ActuatorStiffness {
    /// Returns the stiffness of the given kind of actuator \[N/m or N·m/rad\].
    pub fn of(&self, actuator: JointKind) -> f64 {
        match actuator {
            JointKind::Prismatic => self.prismatic,
            JointKind::Revolute => self.revolute,
        }
    }
}

/// Stiffness at a pose as two decoupled blocks, at `P` in base axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarStiffness {
    /// Upper triangle of the `(x, y, φz)` block: xx, xy, xφ, yy, yφ, φφ.
    pub in_plane: [f64; 6],
    /// Upper triangle of the `(z, φx, φy)` block: zz, zφx, zφy, φxφx, φxφy, φyφy.
    pub out_of_plane: [f64; 6],
}

/// Bar of a leg at a posture.
pub(super) struct Bar<'a> {
    section: &'a BarCompliance,
    /// Unit vector along the bar.
    axis: DVec2,
    /// Distance from its proximal to its distal end along `axis`, in the beam model \[m\].
    length: f64,
    /// Vector from its distal end to `P` \[m\].
    to_p: DVec2,
    /// Moments of the leg's line about both ends \[m\].
    moments: [f64; 2],
}

impl Bar<'_> {
    /// Adds the out-of-plane compliance of the bar at `P` to `s`.
    #[inline]
    pub(super) fn add_to(&self, s: &mut [f64; 6]) {
        let (length, signed) = (self.length.abs(), self.length);
        add_bar(s, self.section, self.axis.into(), [length, signed], self.to_p.into());
    }

    /// Computes the compliance of the bar to a unit force along the line of its leg \[m/N\]: axial, and bending under moments that
    /// vary linearly between its ends.
    fn line_compliance(&self, u: DVec2) -> f64 {
        let along = u.dot(self.axis);
        let [first, second] = self.moments;
        let bending = (first * first + first * second + second * second) / 3.0;
        self.length.abs() * (along * along * self.section.axial + bending * self.section.bending)
    }
}

impl StiffnessModel {
    /// Creates the model of `design`, whose chain may have `rails` that bend. Returns `None` if a bar or a rail is infinitely compliant ([`BarCompliance::new`] returns
    /// `None`), which makes every stiffness 0.
    pub fn new(
        design: &Design,
        geometry: &Geometry,
        material: &Material,
        sections: &CrossSections,
        actuators: &ActuatorStiffness,
        rails: Option<&RailSettings>,
    ) -> Option<Self> {
        let leg_bar = BarCompliance::new(material, &sections.legs, design.leg_bar_radius())?;
        let platform_bar = BarCompliance::new(material, &sections.platform, design.platform_bar_radius())?;
        let actuator = 1.0 / actuators.of(design.architecture().actuator());
        let rail = match rails {
            Some(rails) => Some(RailBeam {
                section: BarCompliance::new(material, &rails.section, rails.radius)?,
                supports: rails.supports,
            }),
            None => None,
        };
        Some(Self {
            leg_bar,
            platform_bar,
            actuator,
            rail,
            reduced: Reduced::new(design, geometry, &leg_bar, &platform_bar, actuator),
        })
    }

    /// Computes `c_i`, the compliance along the line of a leg \[m/N\]: the sum of the actuator's compliance, of the axial and bending
    /// compliance of the bars, and of the bending compliance of the rail.
    #[inline]
    fn line_compliance(&self, posture: &LegPosture) -> f64 {
        let [actuator, distal, platform, proximal] = self.line_compliances(posture);
        actuator + distal + platform + proximal
    }

    /// Computes the terms of `c_i` \[m/N\]: actuator, distal bar, platform bar, and proximal bar or rail (0 if there is neither).
    #[inline]
    pub(super) fn line_compliances(&self, posture: &LegPosture) -> [f64; 4] {
        let [platform, distal, proximal] = self.bars(posture);
        let of = |bar: &Bar<'_>| bar.line_compliance(posture.u);
        [
            posture.transmission * posture.transmission * self.actuator,
            distal.as_ref().map_or(0.0, of),
            platform.as_ref().map_or(0.0, of),
            match self.loaded_rail(posture) {
                Some(rail) => rail.line_compliance(posture.u),
                None => proximal.as_ref().map_or(0.0, of),
            },
        ]
    }

    /// Computes the upper triangle of the in-plane block at a posture, ordered as in [`PlanarStiffness::in_plane`].
    #[inline]
    pub fn in_plane(&self, posture: &Posture, jacobian: &Jacobian) -> [f64; 6] {
        let stiffness = posture.legs.map(|leg| 1.0 / self.line_compliance(&leg));
        in_plane_block(jacobian, &stiffness)
    }

    /// Computes the out-of-plane compliance of one leg at `P`, the sum over its bars and its rail; upper triangle, ordered as in
    /// [`PlanarStiffness::out_of_plane`].
    #[inline]
    fn bending_compliance(&self, posture: &LegPosture) -> [f64; 6] {
        let mut s = [0.0; 6];
        for bar in self.bars(posture).into_iter().flatten() {
            bar.add_to(&mut s);
        }
        if let Some(rail) = self.loaded_rail(posture) {
            rail.add_to(&mut s);
        }
        s
    }

    /// Returns the bars of one leg: the platform bar, the distal bar, and the proximal bar if there is one.
    #[inline]
    pub(super) fn bars(&self, posture: &LegPosture) -> [Option<Bar<'_>>; 3] {
        let (arm, chain) = (posture.arm, &posture.chain);
        let [about_a, about_b, about_c] = posture.about;
        let radius = arm.length();
        let beam = chain.beam.copysign(chain.distal.offset);
        // The tip of the platform bar is P itself.
        let platform = Bar {
            section: &self.platform_bar,
            axis: -arm / radius,
            length: radius,
            to_p: DVec2::ZERO,
            moments: [about_c, posture.moment],
        };
        let distal = Bar {
            section: &self.leg_bar,
            axis: chain.distal.direction,
            length: beam,
            to_p: -arm,
            // A telescopic leg whose beam is longer than the leg begins behind `B_i`.
            moments: [about_c + beam * cross(chain.distal.direction, posture.u), about_c],
        };
        let proximal = chain.proximal.map(|bar| Bar {
            section: &self.leg_bar,
            axis: bar.direction,
            length: bar.offset,
            to_p: chain.distal.direction * chain.distal.offset - arm,
            moments: [about_a, about_b],
        });
        [Some(platform), Some(distal), proximal]
    }

    /// Returns the rail of one leg, if it bends.
    #[inline]
    pub(super) fn loaded_rail(&self, posture: &LegPosture) -> Option<LoadedRail> {
        let chain = &posture.chain;
        let (rail, slider, axis) = (self.rail.as_ref()?, chain.slider?, chain.guides[0]?);
        Some(LoadedRail {
            compliance: rail.at(slider),
            axis,
            to_p: chain.c - posture.arm - chain.b,
            moment: posture.about[1],
        })
    }

    /// Computes `K_zz` alone \[N/m\], which is `k_z` in the default definition.
    #[inline]
    pub fn vertical(&self, posture: &Posture) -> f64 {
        posture
            .legs
            .iter()
            .fold(0.0, |sum, leg| sum + first_of_inverse(&self.bending_compliance(leg)))
    }

    /// Computes both blocks of the stiffness at a posture.
    pub fn stiffness(&self, posture: &Posture, jacobian: &Jacobian) -> PlanarStiffness {
        let mut out_of_plane = [0.0; 6];
        for leg in &posture.legs {
            let s = self.bending_compliance(leg);
            for (sum, entry) in out_of_plane.iter_mut().zip(f64::symmetric_inverse(&s)) {
                *sum += entry;
            }
        }
        PlanarStiffness {
            in_plane: self.in_plane(posture, jacobian),
            out_of_plane,
        }
    }

    /// Computes `k_xy` and `k_φz` according to `definition` from the upper triangle of an in-plane block.
    #[inline(always)]
    pub fn in_plane_stiffness_values<V: Real>(k: &[V; 6], definition: StiffnessDefinition) -> (V, V) {
        let [xx, xy, xm, yy, ym, mm] = *k;
        match definition {
            StiffnessDefinition::Stiffness => (smaller_eigenvalue(xx, xy, yy), mm),
            StiffnessDefinition::Compliance => {
                // The inverse of a block of K⁻¹ is a Schur complement in K: the other displacements are free.
                let (zero, two) = (xx.splat(0.0), xx.splat(2.0));
                let planar = xx * yy - xy * xy;
                let rotational = mm - (xm * xm * yy - two * xm * ym * xy + ym * ym * xx) / planar;
                let translational = smaller_eigenvalue(xx - xm * xm / mm, xy - xm * ym / mm, yy - ym * ym / mm);
                (
                    translational.larger(zero).select(mm.exceeds(zero), zero),
                    rotational.larger(zero).select(planar.exceeds(zero), zero),
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

    /// Computes `k_xy`, `k_z` and `k_φz` according to `definition`.
    pub fn stiffness_values(&self, definition: StiffnessDefinition) -> StiffnessValues {
        let (k_xy, k_phi_z) = StiffnessModel::in_plane_stiffness_values(&self.in_plane, definition);
        let k_z = match definition {
            StiffnessDefinition::Stiffness => self.out_of_plane[0],
            StiffnessDefinition::Compliance => vertical_schur(&self.out_of_plane),
        };
        StiffnessValues { k_xy, k_z, k_phi_z }
    }

    /// Returns the full 6×6 matrix, linear first, at `P` in base axes.
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
