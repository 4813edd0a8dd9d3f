//! The closed form reduced to `k_xy`, `k_z` and `k_φz`, at several poses at once (docs/model.md, sections 4.3 to 4.5).

use super::blocks::{add_bar, in_plane_block, vertical_schur};
use super::{BarCompliance, StiffnessDefinition, StiffnessModel};
use crate::kinematics::Jacobian;
use crate::lanes::{Planar, Real};
use crate::mechanism::LegLanes;
use crate::spatial::{LEGS, smaller_eigenvalue};

/// Sliders on rails that bend, if there are any. This is known when a loop is compiled, so that nothing of rails is compiled into the
/// others.
pub(crate) trait Sliders<V: Real> {
    /// Whether there are any.
    const ON_BENDING_RAILS: bool;

    /// Returns the distances of the slider of a leg from both ends of its rail \[m\], if there are any.
    fn of(&self, leg: usize) -> Option<[V; 2]>;
}

/// No sliders on rails that bend.
pub(crate) struct NoSliders;

impl<V: Real> Sliders<V> for NoSliders {
    const ON_BENDING_RAILS: bool = false;

    #[inline(always)]
    fn of(&self, _leg: usize) -> Option<[V; 2]> {
        None
    }
}

impl<V: Real> Sliders<V> for [[V; 2]; LEGS] {
    const ON_BENDING_RAILS: bool = true;

    #[inline(always)]
    fn of(&self, leg: usize) -> Option<[V; 2]> {
        Some(self[leg])
    }
}

impl StiffnessModel {
    /// Returns the compliances of the bars of the legs and of the platform.
    pub(crate) fn bars_of_design(&self) -> [BarCompliance; 2] {
        [self.leg_bar, self.platform_bar]
    }

    /// Returns the compliance of an actuator \[m/N or rad/(N·m)\].
    pub(crate) fn actuator_compliance(&self) -> f64 {
        self.actuator
    }

    /// Returns whether the legs are on rails that bend.
    #[inline(always)]
    pub(crate) fn is_on_bending_rails(&self) -> bool {
        self.rail.is_some()
    }

    /// Computes `k_xy`, `k_z` and `k_φz` according to `definition`; valid in the lanes where all legs reach the pose.
    #[inline(always)]
    pub(crate) fn stiffness_value_lanes<V: Real, S: Sliders<V>>(
        &self,
        definition: StiffnessDefinition,
        legs: &[LegLanes<V>; LEGS],
        arms: &[Planar<V>; LEGS],
        sliders: &S,
        jacobian: &Jacobian<V>,
    ) -> [V; 3] {
        let like = jacobian.ux[0];
        let reduced = &self.reduced;
        let c = [
            self.along_line(&legs[0], sliders, 0),
            self.along_line(&legs[1], sliders, 1),
            self.along_line(&legs[2], sliders, 2),
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
                let [n0, d0] = self.vertical_lanes(&legs[0], arms[0], sliders, 0);
                let [n1, d1] = self.vertical_lanes(&legs[1], arms[1], sliders, 1);
                let [n2, d2] = self.vertical_lanes(&legs[2], arms[2], sliders, 2);
                // A single division gives the sum of the three quotients.
                let sum = n0 * (d1 * d2) + d0 * (n1 * d2 + n2 * d1);
                let k_z = like.splat(1.0 / reduced.bend_unit) * sum / (d0 * (d1 * d2));
                [smaller_eigenvalue(xx, xy, yy), k_z, mm]
            }
            StiffnessDefinition::Compliance => {
                // The legs are written out, because an array indexed in a loop would be kept in memory.
                let in_plane = in_plane_block(jacobian, &stiffness);
                let k0 = V::symmetric_inverse(&self.bending_lanes(&legs[0], arms[0], sliders, 0));
                let k1 = V::symmetric_inverse(&self.bending_lanes(&legs[1], arms[1], sliders, 1));
                let k2 = V::symmetric_inverse(&self.bending_lanes(&legs[2], arms[2], sliders, 2));
                let mut k = k0;
                for entry in 0..k.len() {
                    k[entry] = k0[entry] + k1[entry] + k2[entry];
                }
                let (k_xy, k_phi_z) = Self::in_plane_stiffness_values(&in_plane, definition);
                [k_xy, vertical_schur(&k), k_phi_z]
            }
        }
    }

    /// Computes `c_i`, the compliances along the lines of the legs \[m/N\], and `S_out,i`, their compliances out of the plane at `P` in
    /// base axes, as upper triangles.
    #[inline(always)]
    pub(crate) fn leg_compliance_lanes<V: Real, S: Sliders<V>>(
        &self,
        legs: &[LegLanes<V>; LEGS],
        arms: &[Planar<V>; LEGS],
        sliders: &S,
    ) -> ([V; LEGS], [[V; 6]; LEGS]) {
        let unit = legs[0].moment.splat(self.reduced.along_unit);
        let along = [
            unit * self.along_line(&legs[0], sliders, 0),
            unit * self.along_line(&legs[1], sliders, 1),
            unit * self.along_line(&legs[2], sliders, 2),
        ];
        let bending = [
            self.bending_lanes(&legs[0], arms[0], sliders, 0),
            self.bending_lanes(&legs[1], arms[1], sliders, 1),
            self.bending_lanes(&legs[2], arms[2], sliders, 2),
        ];
        (along, bending)
    }

    /// Computes `k_xy` by compliance, whatever definition the study uses: the reciprocal of the largest displacement per unit of
    /// force in the plane \[N/m\].
    #[inline(always)]
    pub(crate) fn compliant_k_xy_lanes<V: Real, S: Sliders<V>>(
        &self,
        legs: &[LegLanes<V>; LEGS],
        sliders: &S,
        jacobian: &Jacobian<V>,
    ) -> V {
        let like = jacobian.ux[0];
        let reduced = &self.reduced;
        let along = |compliance: V| like.splat(1.0 / reduced.along_unit) / compliance;
        let stiffness = [
            along(self.along_line(&legs[0], sliders, 0)),
            along(self.along_line(&legs[1], sliders, 1)),
            along(self.along_line(&legs[2], sliders, 2)),
        ];
        let in_plane = in_plane_block(jacobian, &stiffness);
        Self::in_plane_stiffness_values(&in_plane, StiffnessDefinition::Compliance).0
    }

    /// Computes the compliance along the line of leg `index`, in multiples of `along_unit`.
    #[inline(always)]
    fn along_line<V: Real, S: Sliders<V>>(&self, leg: &LegLanes<V>, sliders: &S, index: usize) -> V {
        let of_bars = self.reduced.along_line(leg, index);
        if !S::ON_BENDING_RAILS {
            return of_bars;
        }
        let chain = &leg.chain;
        match (&self.rail, sliders.of(index), chain.guides[0]) {
            (Some(rail), Some(slider), Some(axis)) => {
                // In the distal axes the line of the leg has the direction (1, 0), unless it is not that of the distal bar.
                let (across, moment) = match &leg.loads {
                    Some(loads) => {
                        let u = Planar::new(chain.tangent.dot(leg.u), chain.tangent.cross(leg.u));
                        (axis.cross(u), loads.proximal.moments[1])
                    }
                    None => (-axis.y, of_bars.splat(0.0)),
                };
                let of_rail = rail.at(slider).under(across, moment);
                of_bars + of_rail * of_bars.splat(1.0 / self.reduced.along_unit)
            }
            _ => of_bars,
        }
    }

    /// Computes `det S_φφ` and `det S` of leg `index`, whose quotient is its `K_zz` in multiples of 1/`bend_unit`.
    #[inline(always)]
    fn vertical_lanes<V: Real, S: Sliders<V>>(
        &self,
        leg: &LegLanes<V>,
        arm: Planar<V>,
        sliders: &S,
        index: usize,
    ) -> [V; 2] {
        if !S::ON_BENDING_RAILS {
            return self.reduced.vertical(leg, index);
        }
        let scale = leg.moment.splat(1.0 / self.reduced.bend_unit);
        let s = self.bending_lanes(leg, arm, sliders, index);
        let [zz, zx, zy] = [s[0] * scale, s[1] * scale, s[2] * scale];
        let [xx, xy, yy] = [s[3] * scale, s[4] * scale, s[5] * scale];
        let minor = xx * yy - xy * xy;
        let tilt = zx * (zx * yy - xy * zy) - zy * (zx * xy - xx * zy);
        [minor, zz * minor - tilt]
    }

    /// Computes the upper triangle of the out-of-plane compliance of one leg at `P` in base axes.
    #[inline(always)]
    fn bending_lanes<V: Real, S: Sliders<V>>(
        &self,
        leg: &LegLanes<V>,
        arm: Planar<V>,
        sliders: &S,
        index: usize,
    ) -> [V; 6] {
        let like = leg.moment;
        let zero = like.splat(0.0);
        let mut s = [zero; 6];
        let chain = &leg.chain;
        let platform = &self.reduced.platform[index];
        let radius = like.splat(platform.length);
        let platform_axis = arm.scaled(like.splat(-1.0 / platform.length));
        add_bar(
            &mut s,
            &self.platform_bar,
            platform_axis,
            [radius; 2],
            Planar::new(zero, zero),
        );
        let to_p = Planar::new(-arm.x, -arm.y);
        let tangent = chain.tangent;
        let lengths = [chain.beam, chain.signed_beam];
        add_bar(&mut s, &self.leg_bar, tangent, lengths, to_p);
        if let Some(bar) = &chain.proximal {
            let direction = bar.direction;
            let axis = tangent.scaled(direction.x).plus(tangent.perp().scaled(direction.y));
            let to_p = tangent.scaled(chain.signed_beam).minus(arm);
            let signed = bar.share * like.splat(self.reduced.proximal_length);
            add_bar(&mut s, &self.leg_bar, axis, [bar.length, signed], to_p);
        }
        if S::ON_BENDING_RAILS
            && let (Some(rail), Some(slider), Some(axis)) = (&self.rail, sliders.of(index), chain.guides[0])
        {
            let axis = tangent.scaled(axis.x).plus(tangent.perp().scaled(axis.y));
            let to_p = tangent.scaled(chain.offset).minus(arm);
            rail.at(slider).add_to(&mut s, axis, to_p);
        }
        s
    }
}
