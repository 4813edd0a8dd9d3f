//! Forms of the constraints on stiffness, g4, g5 and g6 (docs/model.md, section 13.3).

use super::rails::{RailCompliances, RailForms};
use super::{Enclosures, Forms, others, turn};
use crate::enclosure::{Interval, PlanarModel, TaylorModel, dot, sum as sum_of};
use crate::evaluation::PoseScalar;
use crate::mechanism::LegEnclosure;
use crate::spatial::LEGS;
use crate::stiffness::StiffnessDefinition;

/// The upper triangle of a symmetric 3×3 matrix, row by row.
type Symmetric = [TaylorModel; 6];

/// What the forms in the plane have in common: with `γ_i` the compliances along the lines of the legs, `γ_j γ_k` for each leg and
/// `γ_1 γ_2 γ_3`.
struct AlongLines {
    one: [TaylorModel; LEGS],
    pairs: [TaylorModel; LEGS],
    product: TaylorModel,
}

impl Forms<'_> {
    /// g4, g5 and g6, as the study defines the stiffness values.
    pub(super) fn enclose_stiffness(&self, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        let definition = self.model.settings().stiffness_definition;
        let in_plane = [
            PoseScalar::StiffnessXy,
            PoseScalar::StiffnessPhiZ,
            PoseScalar::Displacement,
        ];
        if in_plane.iter().any(|&scalar| self.is_required(scalar, found)) {
            let one = [0, 1, 2].map(|i| self.along_line(&legs[i], i));
            let pairs = [one[1] * one[2], one[2] * one[0], one[0] * one[1]];
            let along = AlongLines {
                one,
                pairs,
                product: one[0] * pairs[0],
            };
            match definition {
                StiffnessDefinition::Stiffness => self.enclose_entries(legs, &along, found),
                StiffnessDefinition::Compliance => self.enclose_reciprocals(legs, &along, found),
            }
            if self.is_required(PoseScalar::Displacement, found) {
                self.enclose_compliant_xy(
                    legs,
                    &along,
                    (PoseScalar::Displacement, self.compliance.yielding),
                    found,
                );
            }
        }
        if self.is_required(PoseScalar::StiffnessZ, found) {
            match definition {
                StiffnessDefinition::Stiffness => self.enclose_vertical(legs, found),
                StiffnessDefinition::Compliance => self.enclose_vertical_reciprocal(legs, found),
            }
        }
    }

    /// Whether a scalar has a threshold that is not proved yet.
    fn is_required(&self, scalar: PoseScalar, found: &Enclosures) -> bool {
        self.limit(scalar) > 0.0 && found.needs(scalar)
    }

    /// g4 and g6 for the entries of `K`. With `T` the threshold, `k_xy > T` where `(λ₁ − T)(λ₂ − T) > 0` and `λ₁ + λ₂ > 2T`.
    fn enclose_entries(&self, legs: &[LegEnclosure; LEGS], along: &AlongLines, found: &mut Enclosures) {
        let product = along.product;
        if self.is_required(PoseScalar::StiffnessXy, found) {
            let sum = along.pairs[0] + along.pairs[1] + along.pairs[2];
            let threshold = self.compliance.in_plane;
            let determinant = sum_of_legs(|i| along.one[i] * turn(legs, i).squared()) - sum.scaled(threshold)
                + product.scaled(threshold.square());
            let excess = sum - product.times(2.0).scaled(threshold);
            let part = |i: usize| (along.pairs[i], legs[i].u);
            push_smaller_eigenvalue(found, PoseScalar::StiffnessXy, [determinant, excess], part);
        }
        if self.is_required(PoseScalar::StiffnessPhiZ, found) {
            let moments = sum_of_legs(|i| legs[i].moment.squared() * along.pairs[i]);
            found.push(
                PoseScalar::StiffnessPhiZ,
                moments - product.scaled(self.compliance.rotation),
            );
        }
    }

    /// The least stiffness in the plane of a platform that is free to turn, as the limit of a scalar. Let `S = K_xy − k k^T/K_φφ`, with
    /// `k` the column of the rotation, whose inverse is the block of `K⁻¹`. Multiplied by `γ_1 γ_2 γ_3 K_φφ/r²`, its determinant is
    /// `D²`, its trace `Σ γ_i (μ_j² + μ_k² − 2 μ_j μ_k C_i)`, and 1 is `Σ μ_i² γ_j γ_k`.
    fn enclose_compliant_xy(
        &self,
        legs: &[LegEnclosure; LEGS],
        along: &AlongLines,
        (scalar, threshold): (PoseScalar, Interval),
        found: &mut Enclosures,
    ) {
        let square = sum_of_legs(|i| legs[i].moment * turn(legs, i)).squared();
        let trace = sum_of_legs(|i| {
            let [a, b] = others(i).map(|leg| legs[leg]);
            let mixed = (a.moment * b.moment * dot(a.u, b.u)).times(2.0);
            along.one[i] * (a.moment.squared() + b.moment.squared() - mixed)
        });
        let whole = sum_of_legs(|i| legs[i].moment.squared() * along.pairs[i]);
        let determinant = square - trace.scaled(threshold) + whole.scaled(threshold.square());
        let excess = trace - whole.times(2.0).scaled(threshold);
        let part = |i: usize| {
            let [a, b] = others(i).map(|leg| legs[leg]);
            let part = |k: usize| a.moment * b.u[k] - b.moment * a.u[k];
            (along.one[i], [part(0), part(1)])
        };
        push_smaller_eigenvalue(found, scalar, [determinant, excess], part);
    }

    /// g4 and g6 for the reciprocals of entries of `K⁻¹`. That for the rotation is `r² D²/Σ γ_i w_i²`.
    fn enclose_reciprocals(&self, legs: &[LegEnclosure; LEGS], along: &AlongLines, found: &mut Enclosures) {
        if self.is_required(PoseScalar::StiffnessXy, found) {
            self.enclose_compliant_xy(legs, along, (PoseScalar::StiffnessXy, self.compliance.in_plane), found);
        }
        if self.is_required(PoseScalar::StiffnessPhiZ, found) {
            let square = sum_of_legs(|i| legs[i].moment * turn(legs, i)).squared();
            let turns = sum_of_legs(|i| along.one[i] * turn(legs, i).squared());
            found.push(
                PoseScalar::StiffnessPhiZ,
                square - turns.scaled(self.compliance.rotation),
            );
        }
    }

    /// g5 for the entry of `K`, unless the stiffness of one leg or of two legs suffices: those of the others are positive, and no
    /// quotient is needed. Where the distal bar of a leg has almost no length, its own stiffness is enclosed badly.
    fn enclose_vertical(&self, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        let threshold = self.compliance.vertical;
        let suffices = |[minor, determinant]: &[TaylorModel; 2]| (*minor - determinant.scaled(threshold)).is_positive();
        let first = self.vertical(&legs[0], 0);
        if suffices(&first) {
            return;
        }
        let all = [first, self.vertical(&legs[1], 1), self.vertical(&legs[2], 2)];
        if all[1..].iter().any(suffices) {
            return;
        }
        let mut stiffness = TaylorModel::constant(-threshold);
        for [minor, determinant] in all {
            stiffness = stiffness + minor * determinant.reciprocal();
        }
        if !stiffness.is_positive() {
            let pairs = [[0, 1], [1, 2], [2, 0]].map(|pair| {
                let [[minor, determinant], [other_minor, other]] = pair.map(|leg| all[leg]);
                [minor * other + other_minor * determinant, determinant * other]
            });
            if pairs.iter().any(suffices) {
                return;
            }
        }
        found.push(PoseScalar::StiffnessZ, stiffness);
    }

    /// g5 for the reciprocal of the entry of `K⁻¹`, which is `det K/det K_φφ` of the block out of the plane. `K` is the sum of the
    /// inverses of the compliances of the legs, and positive definite.
    fn enclose_vertical_reciprocal(&self, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        if self.limit(PoseScalar::StiffnessZ) > 0.0 {
            let mut stiffness = [TaylorModel::exactly(0.0); 6];
            for (index, leg) in legs.iter().enumerate() {
                let compliance = self.bending(leg, index);
                let cofactors = cofactors(&compliance);
                let to_inverse = determinant(&compliance, &cofactors).reciprocal();
                for (sum, cofactor) in stiffness.iter_mut().zip(cofactors) {
                    *sum = *sum + cofactor * to_inverse;
                }
            }
            let cofactors = cofactors(&stiffness);
            let whole = determinant(&stiffness, &cofactors);
            // The first cofactor is the determinant of the block of the rotations.
            found.push(
                PoseScalar::StiffnessZ,
                whole - cofactors[0].scaled(self.compliance.vertical),
            );
        }
    }

    /// Encloses the compliance of a leg out of the plane at `P` in base axes: displacement along z, then the rotations, with lengths
    /// in units of `L_b`.
    fn bending(&self, leg: &LegEnclosure, index: usize) -> Symmetric {
        let compliance = &self.compliance;
        let platform = &compliance.platform[index];
        let zero = TaylorModel::exactly(0.0);
        let chain = &leg.chain;
        let normal = perp(chain.tangent);
        let from_leg = |along: TaylorModel, across: TaylorModel| -> PlanarModel {
            [0, 1].map(|k| chain.tangent[k] * along + normal[k] * across)
        };
        let mut sum = [zero; 6];
        // The platform bar runs from C to P, against the arm `along t − across t⊥`.
        let [along, across] = [leg.along, leg.across].map(|part| part.scaled(platform.per_multiple));
        add_bar(
            &mut sum,
            &BentBar {
                section: platform.vertical.map(TaylorModel::constant),
                direction: from_leg(-along, across),
                length: TaylorModel::constant(platform.radius),
                tip: [zero, zero],
            },
        );
        let (along, across) = (along.scaled(platform.radius), -across.scaled(platform.radius));
        add_bar(
            &mut sum,
            &BentBar {
                section: compliance.leg.map(|part| chain.beam.scaled(part)),
                direction: chain.tangent,
                length: chain.signed_beam,
                tip: from_leg(along, across),
            },
        );
        if let Some(bar) = &chain.proximal {
            let [x, y] = bar.direction;
            add_bar(
                &mut sum,
                &BentBar {
                    section: compliance.leg.map(|part| bar.length.scaled(part)),
                    direction: from_leg(x, y),
                    length: bar.offset,
                    tip: from_leg(along - chain.offset, across),
                },
            );
        }
        if let Some((rail, forms)) = self.rail(leg, index) {
            let axis = self.frames[index].rail.axis().map(TaylorModel::constant);
            let tip = from_leg(along - chain.offset, across);
            add_rail(&mut sum, &forms.scaled(rail.vertical), axis, tip);
        }
        sum
    }

    /// Encloses the same compliance in the axes of the distal bar at a point that is fixed in them, relative to `C_i`.
    pub(super) fn bending_in_distal_axes(&self, leg: &LegEnclosure, index: usize, at: [f64; 2]) -> Symmetric {
        let compliance = &self.compliance;
        let platform = &compliance.platform[index];
        let (zero, one) = (TaylorModel::exactly(0.0), TaylorModel::exactly(1.0));
        let chain = &leg.chain;
        let mut sum = [zero; 6];
        let [along, across] = [leg.along, leg.across].map(|part| part.scaled(platform.per_multiple));
        let to_platform = [-along, across];
        let c = at.map(|part| TaylorModel::exactly(-part));
        let to_p = to_platform.map(|part| part.scaled(platform.radius));
        add_bar(
            &mut sum,
            &BentBar {
                section: platform.vertical.map(TaylorModel::constant),
                direction: to_platform,
                length: TaylorModel::constant(platform.radius),
                tip: sum_of(c, to_p),
            },
        );
        add_bar(
            &mut sum,
            &BentBar {
                section: compliance.leg.map(|part| chain.beam.scaled(part)),
                direction: [one, zero],
                length: chain.signed_beam,
                tip: c,
            },
        );
        let elbow = [c[0] - chain.offset, c[1]];
        if let Some(bar) = &chain.proximal {
            add_bar(
                &mut sum,
                &BentBar {
                    section: compliance.leg.map(|part| bar.length.scaled(part)),
                    direction: bar.direction,
                    length: bar.offset,
                    tip: elbow,
                },
            );
        }
        if let Some((rail, forms)) = self.rail(leg, index) {
            let axis = self.frames[index].rail.axis().map(TaylorModel::constant);
            let [x, y] = chain.tangent;
            let in_distal_axes = [dot(axis, [x, y]), dot(axis, [-y, x])];
            add_rail(&mut sum, &forms.scaled(rail.vertical), in_distal_axes, elbow);
        }
        sum
    }

    /// Encloses the compliance along the line of a leg.
    pub(super) fn along_line(&self, leg: &LegEnclosure, index: usize) -> TaylorModel {
        let of_bars = self.along_bars(leg, index);
        let Some((rail, forms)) = self.rail(leg, index) else {
            return of_bars;
        };
        let across = self.frames[index].rail.enter(leg.u)[1];
        let mut of_rail = across.squared() * forms.force;
        if let Some(loads) = &leg.loads {
            let [_, _, moment] = loads.proximal;
            of_rail = of_rail + (across * moment * forms.coupling).times(2.0) + moment.squared() * forms.moment;
        }
        of_bars + of_rail.scaled(rail.in_plane)
    }

    /// Returns the rail of a leg and what a unit load does to it, if it bends.
    fn rail(&self, leg: &LegEnclosure, index: usize) -> Option<(&RailCompliances, RailForms)> {
        let (rail, slider) = (self.compliance.rail.as_ref()?, leg.chain.slider?);
        Some((rail, rail.forms(&self.frames[index], slider)))
    }

    /// Encloses the part of the actuator and the bars.
    fn along_bars(&self, leg: &LegEnclosure, index: usize) -> TaylorModel {
        let compliance = &self.compliance;
        let platform = &compliance.platform[index];
        let chain = &leg.chain;
        let actuator = leg.transmission_square.scaled(compliance.actuator);
        let Some(loads) = &leg.loads else {
            let sum = actuator
                + chain.beam.scaled(compliance.leg_axial)
                + leg.moment.squared().scaled(platform.moment).plus(platform.base);
            return match &chain.proximal {
                Some(bar) => {
                    let [x, y] = bar.vector.map(|part| part.squared());
                    sum + x.scaled(compliance.proximal_axial) + y.scaled(compliance.proximal_bending)
                }
                None => sum,
            };
        };
        let of_bar = |[force, first, second]: [TaylorModel; 3], axial: Interval, bending: Interval| {
            let squares = first.squared() + first * second + second.squared();
            force.squared().scaled(axial) + squares.scaled(bending)
        };
        let of_leg = |load| of_bar(load, compliance.leg_axial, compliance.leg_bending);
        let sum =
            actuator + chain.beam * of_leg(loads.distal) + of_bar(loads.platform, platform.axial, platform.bending);
        match &chain.proximal {
            Some(bar) => sum + bar.length * of_leg(loads.proximal),
            None => sum,
        }
    }

    /// Encloses `det S_φφ` and `det S` of a leg out of the plane in axes along the distal bar, with lengths in units of `L_b` (docs/model.md,
    /// section 4.4): at `C_i`, or on a rail that bends where force and moment are almost decoupled.
    fn vertical(&self, leg: &LegEnclosure, index: usize) -> [TaylorModel; 2] {
        if self.compliance.rail.is_some() {
            // The entry for a displacement without a rotation is the same at every point and in all axes.
            let (_, compliance) = self.decoupled_bending(leg, index);
            let cofactors = cofactors(&compliance);
            return [cofactors[0], determinant(&compliance, &cofactors)];
        }
        let compliance = &self.compliance;
        let platform = &compliance.platform[index];
        let chain = &leg.chain;
        let ([b1, t1], [b2, t2], radius) = (compliance.leg, platform.vertical, platform.radius);
        let third = Interval::exactly(1.0) / Interval::exactly(3.0);
        let half = Interval::exactly(0.5);
        let constant = TaylorModel::constant;
        // Direction of the platform bar, from C to P, in the axes of the distal bar.
        let (cosine, sine) = (
            -leg.along.scaled(platform.per_multiple),
            leg.across.scaled(platform.per_multiple),
        );
        let length = chain.beam;
        let (bend, twist) = (length.scaled(b1), length.scaled(t1));
        let lift = (bend * length.squared())
            .scaled(third)
            .plus(b2 * radius.square() * third);
        let p = (bend * chain.signed_beam).times(0.5);
        let q = constant(half * b2 * radius);
        let square = cosine.squared();
        let (bend2, twist2) = (constant(b2), constant(t2));
        match &chain.proximal {
            None => {
                let minor = [(twist + bend2) * (bend + twist2), (twist - bend) * (bend2 - twist2)];
                let (pp, qq) = (p.squared(), q.squared());
                let tilt = [
                    pp * (twist + bend2) + qq * (twist2 + bend),
                    (p * q).times(2.0) * (twist + twist2),
                    pp * (twist2 - bend2) + qq * (twist - bend),
                ];
                [
                    minor[0] + square * minor[1],
                    lift * minor[0] - tilt[0] + cosine * tilt[1] + square * (lift * minor[1] - tilt[2]),
                ]
            }
            Some(bar) => {
                let [x, y] = bar.direction;
                // Where the distal bar ends, in the axes of the proximal bar, and the middle of that bar.
                let (ahead, aside) = (chain.signed_beam * x, chain.signed_beam * y);
                let half_bar = bar.offset.times(0.5);
                let middle = ahead + half_bar;
                let twelfth = Interval::exactly(1.0) / Interval::exactly(12.0);
                let (bend_a, twist_a) = (bar.length.scaled(b1), bar.length.scaled(t1));
                let (xx_bar, yy_bar, xy_bar) = (x.squared(), y.squared(), x * y);
                let (long, wide, both) = (square, sine.squared(), cosine * sine);
                let lift = lift
                    + bend_a * (middle.squared() + bar.offset.squared().scaled(twelfth))
                    + twist_a * aside.squared();
                let tilt_x = y * ((bend_a - twist_a) * ahead + half_bar * bend_a) - q * sine;
                let tilt_y = q * cosine - p - (twist_a * y * aside + bend_a * middle * x);
                let xx = twist_a * xx_bar + bend_a * yy_bar + twist + twist2 * long + bend2 * wide;
                let xy = (twist_a - bend_a) * xy_bar + (twist2 - bend2) * both;
                let yy = twist_a * yy_bar + bend_a * xx_bar + bend + twist2 * wide + bend2 * long;
                let minor = xx * yy - xy.squared();
                let tilt = tilt_x.squared() * yy - (tilt_x * tilt_y * xy).times(2.0) + tilt_y.squared() * xx;
                [minor, lift * minor - tilt]
            }
        }
    }
}

/// A bar that bends out of the plane.
struct BentBar {
    /// Bending and torsional compliance, `L/(EI)` and `L/(GI_x)`.
    section: [TaylorModel; 2],
    /// Unit vector along it.
    direction: PlanarModel,
    /// Distance along this vector to its tip.
    length: TaylorModel,
    /// Tip, relative to `P`.
    tip: PlanarModel,
}

/// Adds the forms of a limit `T` of the smaller eigenvalue of `Σ w_i v_i v_i^T`: the determinant of the matrix less `T`, and the trace less
/// `2T`. Neither is needed where the deviator proves the limit and the forms do not.
fn push_smaller_eigenvalue(
    found: &mut Enclosures,
    scalar: PoseScalar,
    [determinant, excess]: [TaylorModel; 2],
    part: impl Fn(usize) -> (TaylorModel, PlanarModel),
) {
    let is_proved = determinant.is_positive() && excess.is_positive();
    if is_proved || !exceeds_deviator(&excess, part) {
        found.push(scalar, determinant);
        found.push(scalar, excess);
    }
}

/// Whether the smaller eigenvalue of `Σ w_i v_i v_i^T` is above `T` on the whole box, where `excess` is the trace less `2T`: it is where the excess
/// is above the norm of the deviator `Σ w_i (v_x² − v_y², 2 v_x v_y)`, the difference of the eigenvalues. Where both eigenvalues are near
/// `T`, as in the centre of a symmetric manipulator, the determinant of the matrix less `T` is small of second order and decides nothing.
fn exceeds_deviator(excess: &TaylorModel, part: impl Fn(usize) -> (TaylorModel, PlanarModel)) -> bool {
    let [least, _] = excess.range();
    // Where the excess is not positive, or is not a number, the deviator proves nothing.
    if least.is_nan() || least <= 0.0 {
        return false;
    }
    let zero = TaylorModel::exactly(0.0);
    let mut deviator = [zero; 2];
    for i in 0..LEGS {
        let (weight, [x, y]) = part(i);
        deviator[0] = deviator[0] + weight * (x.squared() - y.squared());
        deviator[1] = deviator[1] + weight * (x * y).times(2.0);
    }
    let squares = deviator.map(|part| {
        let [lower, upper] = part.range();
        Interval::exactly(upper.max(-lower)).square()
    });
    let margin = Interval::exactly(least).square() - (squares[0] + squares[1]);
    deviator.iter().all(|part| !part.range()[0].is_nan()) && margin.lower() > 0.0
}

/// Adds the compliance of a bar at `P`. The bending moment at the distance `s` from the tip, at `q`, due to a force `F` along z and
/// a moment `m` at `P`, is `m + F q⊥`: its part along the bar is constant, and that along the normal grows by `F` per length.
fn add_bar(sum: &mut Symmetric, bar: &BentBar) {
    let [bend, twist] = bar.section;
    let [x, y] = bar.direction;
    let [nx, ny] = perp(bar.direction);
    let lever = perp(bar.tip);
    let along = dot(lever, bar.direction);
    // At the middle of the bar, force and moment are decoupled.
    let middle = dot(lever, [nx, ny]) - bar.length.times(0.5);
    let twelfth = Interval::exactly(1.0) / Interval::exactly(12.0);
    let (by_twist, by_bend) = (twist * along, bend * middle);
    let parts = [
        by_twist * along + by_bend * middle + bend * bar.length.squared().scaled(twelfth),
        by_twist * x + by_bend * nx,
        by_twist * y + by_bend * ny,
        twist * x.squared() + bend * nx.squared(),
        twist * (x * y) + bend * (nx * ny),
        twist * y.squared() + bend * ny.squared(),
    ];
    for (entry, part) in sum.iter_mut().zip(parts) {
        *entry = *entry + part;
    }
}

/// Adds the compliance of a rail with the direction `axis` under a slider at `tip` (relative to `P`). A force `F` along z and a moment
/// `m` at `P` twist it by the part of `m + F tip⊥` along it, and bend it by the part across it, against the slope under the force.
fn add_rail(sum: &mut Symmetric, rail: &RailForms, axis: PlanarModel, tip: PlanarModel) {
    let [x, y] = axis;
    let normal = perp(axis);
    let lever = perp(tip);
    let (along, across) = (dot(lever, axis), dot(lever, normal));
    let lift = rail.force - (rail.coupling * across).times(2.0)
        + rail.moment * across.squared()
        + rail.torsion * along.squared();
    let (twisted, bent) = (rail.torsion * along, rail.moment * across - rail.coupling);
    let parts = [
        lift,
        twisted * x + bent * normal[0],
        twisted * y + bent * normal[1],
        rail.torsion * x.squared() + rail.moment * normal[0].squared(),
        rail.torsion * (x * y) + rail.moment * (normal[0] * normal[1]),
        rail.torsion * y.squared() + rail.moment * normal[1].squared(),
    ];
    for (entry, part) in sum.iter_mut().zip(parts) {
        *entry = *entry + part;
    }
}

/// The vector turned by 90°.
fn perp([x, y]: PlanarModel) -> PlanarModel {
    [-y, x]
}

/// The upper triangle of the matrix of cofactors.
fn cofactors(&[a, b, c, d, e, f]: &Symmetric) -> Symmetric {
    [
        d * f - e.squared(),
        c * e - b * f,
        b * e - c * d,
        a * f - c.squared(),
        b * c - a * e,
        a * d - b.squared(),
    ]
}

fn determinant(matrix: &Symmetric, cofactors: &Symmetric) -> TaylorModel {
    matrix[0] * cofactors[0] + matrix[1] * cofactors[1] + matrix[2] * cofactors[2]
}

fn sum_of_legs(term: impl Fn(usize) -> TaylorModel) -> TaylorModel {
    let mut sum = term(0);
    for i in 1..LEGS {
        sum = sum + term(i);
    }
    sum
}
