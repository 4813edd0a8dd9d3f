//! The compliances of one design in the form that the evaluation of several poses at once needs (docs/model.md, sections 4.3 and 4.4).
//!
//! Where a leg's line is that of its distal bar, the compliance along it depends only on the leg's transmission, on the moment of the
//! line about `P` and, for a telescopic leg, on the length of the leg; otherwise also on the moments about the ends of the bars. Out of
//! the plane, `K_zz` of a leg is `det S_φφ / det S`, where `S` is the sum of the compliances of its bars and `S_φφ` the block of the
//! rotations. Neither determinant depends on the reference point or on the axes. They are therefore computed at `C_i` in axes along the
//! distal bar; for a leg with two bars (platform bar included) they are polynomials in the cosine of the angle between the bars. On
//! rails that bend, they are computed from the matrix.

use super::BarCompliance;
use crate::lanes::Real;
use crate::mechanism::{BarLoads, Design, Geometry, LegLanes};
use crate::spatial::LEGS;

/// Compliances of one design divided by two reference compliances, so that their products do not overflow or underflow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reduced {
    /// Reference for the compliances along a leg's line \[m/N\].
    pub along_unit: f64,
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
    pub bend_unit: f64,
    /// Bending and torsional compliance of a leg bar, per metre of its length.
    leg: [f64; 2],
    /// Platform bars of the legs.
    pub platform: [ReducedPlatformBar; LEGS],
    /// `L_a` \[m\].
    pub proximal_length: f64,
}

/// Compliances of one platform bar, divided by the two reference compliances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ReducedPlatformBar {
    /// Length `r_i` \[m\].
    pub length: f64,
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

/// Returns three times the mean square of a moment that varies linearly between the ends of a bar.
#[inline(always)]
fn sum_of_squares<V: Real>([first, second]: [V; 2]) -> V {
    first * first + first * second + second * second
}

impl Reduced {
    pub fn new(
        design: &Design,
        geometry: &Geometry,
        leg: &BarCompliance,
        platform: &BarCompliance,
        actuator: f64,
    ) -> Self {
        let (r, link, proximal) = (design.platform_radius(), design.link_length(), design.proximal_length());
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
            platform: geometry.arrangement().platform_radii.map(|multiple| {
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
    pub fn along_line<V: Real>(&self, leg: &LegLanes<V>, index: usize) -> V {
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
    pub fn vertical<V: Real>(&self, leg: &LegLanes<V>, index: usize) -> [V; 2] {
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
