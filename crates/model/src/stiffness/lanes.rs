//! The closed form reduced to `k_xy`, `k_z` and `k_φz`, at several poses at once (docs/model.md, sections 4.3 to 4.5).
//!
//! Where a leg's line is that of its distal bar, the compliance along it depends only on the leg's transmission, on the moment of the
//! line about `P` and, for a telescopic leg, on the length of the leg; otherwise also on the moments about the ends of the bars. Out of
//! the plane, `K_zz` of a leg is `det S_φφ / det S`, where `S` is the sum of the compliances of its bars and `S_φφ` the block of the
//! rotations. Neither determinant depends on the reference point or on the axes. They are therefore computed at `C_i` in axes along the
//! distal bar; for a leg with two bars (platform bar included) they are polynomials in the cosine of the angle between the bars. On
//! rails that bend, they are computed from the matrix.

use super::planar::{add_bar, in_plane_block, inverse, vertical_schur};
use super::{BarCompliance, StiffnessDefinition, StiffnessModel};
use crate::kinematics::Jacobian;
use crate::lanes::{Planar, Real};
use crate::mechanism::{BarLoads, Design, Geometry, LegLanes};
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
    /// A third of the bending compliance of a leg bar, per metre of its length.
    leg_bending: f64,
    /// Axial compliance of a proximal bar of length `L_a`, per square of its component along the line.
    proximal_axial: f64,
    /// Bending compliance of a proximal bar of length `L_a`, per square of its component normal to the line.
    proximal_bending: f64,
    /// Reference for the bending and torsional compliances \[1/(N·m²)\].
    bend_unit: f64,
    /// Bending and torsional compliance of a leg bar, per metre of its length.
    leg: [f64; 2],
    /// Platform bars of the legs.
    platform: [ReducedPlatformBar; LEGS],
    /// `L_a` \[m\].
    proximal_length: f64,
}

/// Compliances of one platform bar, divided by the two reference compliances.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ReducedPlatformBar {
    /// Length `r_i` \[m\].
    length: f64,
    /// Axial compliance, divided by the length: per square of `u · (C − P)`.
    axial: f64,
    /// A third of the bending compliance.
    bending: f64,
    /// Compliance if the leg's line passes through `C` and `P`.
    base: f64,
    /// Additional compliance per squared moment about `P` of a line through `C`.
    moment: f64,
    /// Bending and torsional compliance out of the plane.
    vertical: [f64; 2],
}

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

/// Returns three times the mean square of a moment that varies linearly between the ends of a bar.
#[inline(always)]
fn sum_of_squares<V: Real>([first, second]: [V; 2]) -> V {
    first * first + first * second + second * second
}

impl Reduced {
    pub(super) fn new(
        design: &Design,
        geometry: &Geometry,
        leg: &BarCompliance,
        platform: &BarCompliance,
        actuator: f64,
    ) -> Self {
        let (r, link, proximal) = (design.platform_radius, design.link_length, design.proximal_length);
        let along_unit = actuator + link * leg.axial + r * platform.axial;
        let bend_unit = leg.bending.max(platform.bending);
        Self {
            along_unit,
            actuator: actuator / along_unit,
            leg_axial: leg.axial / along_unit,
            leg_bending: leg.bending / 3.0 / along_unit,
            proximal_axial: leg.axial / proximal / along_unit,
            proximal_bending: leg.bending * proximal / 3.0 / along_unit,
            bend_unit,
            leg: [leg.bending / bend_unit, leg.torsion / bend_unit],
            platform: geometry.platform_radii.map(|multiple| {
                let r = multiple * r;
                ReducedPlatformBar {
                    length: r,
                    axial: platform.axial / r / along_unit,
                    bending: r * platform.bending / 3.0 / along_unit,
                    base: r * platform.axial / along_unit,
                    moment: (r / 3.0 * platform.bending - platform.axial / r) / along_unit,
                    vertical: [r * platform.bending / bend_unit, r * platform.torsion / bend_unit],
                }
            }),
            proximal_length: proximal,
        }
    }

    /// Computes the compliance along the line of leg `index`, in multiples of `along_unit`.
    #[inline(always)]
    fn along_line<V: Real>(&self, leg: &LegLanes<V>, index: usize) -> V {
        let like = leg.moment;
        let actuator = leg.transmission * leg.transmission * like.splat(self.actuator);
        let (chain, platform) = (&leg.chain, &self.platform[index]);
        let Some(loads) = &leg.loads else {
            let compliance = actuator
                + chain.beam * like.splat(self.leg_axial)
                + like.splat(platform.base)
                + leg.moment * leg.moment * like.splat(platform.moment);
            return match chain.proximal {
                Some(bar) => {
                    compliance
                        + bar.vector.x * bar.vector.x * like.splat(self.proximal_axial)
                        + bar.vector.y * bar.vector.y * like.splat(self.proximal_bending)
                }
                None => compliance,
            };
        };
        let of_platform = loads.platform.force * loads.platform.force * like.splat(platform.axial)
            + sum_of_squares(loads.platform.moments) * like.splat(platform.bending);
        let compliance = actuator + self.of_bar(&loads.distal, chain.beam) + of_platform;
        match &chain.proximal {
            Some(bar) => compliance + self.of_bar(&loads.proximal, bar.length),
            None => compliance,
        }
    }

    /// Computes the compliance of a bar of a leg along the line, in multiples of `along_unit`.
    #[inline(always)]
    fn of_bar<V: Real>(&self, load: &BarLoads<V>, length: V) -> V {
        length
            * (load.force * load.force * length.splat(self.leg_axial)
                + sum_of_squares(load.moments) * length.splat(self.leg_bending))
    }

    /// Computes `det S_φφ` and `det S` of leg `index`, whose quotient is its `K_zz` in multiples of 1/`bend_unit`.
    #[inline(always)]
    fn vertical<V: Real>(&self, leg: &LegLanes<V>, index: usize) -> [V; 2] {
        let like = leg.moment;
        let chain = &leg.chain;
        let platform = &self.platform[index];
        let radius = platform.length;
        let ([b1, t1], [b2, t2]) = (self.leg, platform.vertical);
        // Direction of the platform bar, from C to P, in the axes of the distal bar.
        let to_unit = like.splat(1.0 / radius);
        let cosine = -(chain.along * to_unit);
        let length = chain.beam;
        let (bend, twist) = (length * like.splat(b1), length * like.splat(t1));
        let half = like.splat(0.5);
        let lift = like.splat(b2 * radius * radius / 3.0) + bend * length * length * like.splat(1.0 / 3.0);
        let (p, q) = (half * bend * chain.signed_beam, like.splat(0.5 * b2 * radius));
        let (b2, t2) = (like.splat(b2), like.splat(t2));
        let square = cosine * cosine;
        match &chain.proximal {
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
                let sine = chain.across * to_unit;
                let (x, y) = (bar.direction.x, bar.direction.y);
                let unit = like.splat(self.proximal_length);
                // Where the distal bar ends, as multiples of L_a in the axes of the proximal bar, and the middle of that bar.
                let (ahead, aside) = (bar.distal_share * x, bar.distal_share * y);
                let middle = ahead + half * bar.share;
                let (bend_a, twist_a) = (bar.length * like.splat(b1), bar.length * like.splat(t1));
                let lift = lift
                    + unit
                        * unit
                        * (bend_a * (middle * middle + bar.share * bar.share * like.splat(1.0 / 12.0))
                            + twist_a * aside * aside);
                let tilt_x = unit * y * ((bend_a - twist_a) * ahead + half * bar.share * bend_a) - q * sine;
                let tilt_y = q * cosine - p - unit * (twist_a * y * aside + bend_a * middle * x);
                let xx = twist_a * x * x + bend_a * y * y + twist + t2 * square + b2 * sine * sine;
                let xy = (twist_a - bend_a) * x * y + (t2 - b2) * cosine * sine;
                let yy = twist_a * y * y + bend_a * x * x + bend + t2 * sine * sine + b2 * square;
                let minor = xx * yy - xy * xy;
                let tilt = tilt_x * tilt_x * yy - tilt_x * tilt_y * xy * like.splat(2.0) + tilt_y * tilt_y * xx;
                [minor, lift * minor - tilt]
            }
        }
    }
}

impl StiffnessModel {
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
                let k0 = inverse(&self.bending_lanes(&legs[0], arms[0], sliders, 0));
                let k1 = inverse(&self.bending_lanes(&legs[1], arms[1], sliders, 1));
                let k2 = inverse(&self.bending_lanes(&legs[2], arms[2], sliders, 2));
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
