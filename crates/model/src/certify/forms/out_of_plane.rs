//! Forms of the constraint on the stiffness out of the plane, g5 (docs/model.md, section 13.3).

use super::rails::RailForms;
use super::{Enclosures, Forms};
use crate::enclosure::{Interval, PlanarModel, TaylorModel, dot, sum as sum_of};
use crate::evaluation::PoseScalar;
use crate::mechanism::LegEnclosure;
use crate::spatial::LEGS;

/// The upper triangle of a symmetric 3×3 matrix, row by row.
type Symmetric = [TaylorModel; 6];

impl Forms<'_> {
    /// g5 for the entry of `K`, unless the stiffness of one leg or of two legs suffices: those of the others are positive, and no
    /// quotient is needed. Where the distal bar of a leg has almost no length, its own stiffness is enclosed badly.
    pub(super) fn enclose_vertical(&self, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
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
    pub(super) fn enclose_vertical_reciprocal(&self, legs: &[LegEnclosure; LEGS], found: &mut Enclosures) {
        let mut stiffness = [TaylorModel::exactly(0.0); 6];
        for (index, leg) in legs.iter().enumerate() {
            let compliance = self.bending(leg, index);
            let cofactors = cofactors(&compliance);
            let to_inverse = determinant(&compliance, &cofactors).reciprocal();
            add(&mut stiffness, cofactors.map(|cofactor| cofactor * to_inverse));
        }
        let cofactors = cofactors(&stiffness);
        let whole = determinant(&stiffness, &cofactors);
        // The first cofactor is the determinant of the block of the rotations.
        let taken = cofactors[0].scaled(self.compliance.vertical);
        found.push(PoseScalar::StiffnessZ, whole - taken);
    }

    /// Encloses the compliance of a leg out of the plane at `P` in base axes: displacement along z, then the rotations, with lengths
    /// in units of `L_b`.
    fn bending(&self, leg: &LegEnclosure, index: usize) -> Symmetric {
        let tangent = leg.chain.tangent;
        let normal = perp(tangent);
        let zero = TaylorModel::exactly(0.0);
        let [along, across] = self.platform_bar(leg, index);
        let radius = self.compliance.platform[index].radius;
        let c = [-along.scaled(radius), -across.scaled(radius)];
        let of_distal = |[along, across]: PlanarModel| [0, 1].map(|k| tangent[k] * along + normal[k] * across);
        self.bending_in(leg, index, [[zero; 2], c, tangent], of_distal, |axis| axis)
    }

    /// Encloses the same compliance in the axes of the distal bar at a point that is fixed in them, relative to `C_i`.
    pub(super) fn bending_in_distal_axes(&self, leg: &LegEnclosure, index: usize, at: [f64; 2]) -> Symmetric {
        let tangent = leg.chain.tangent;
        let c = at.map(|part| TaylorModel::exactly(-part));
        let radius = self.compliance.platform[index].radius;
        let to_p = self.platform_bar(leg, index).map(|part| part.scaled(radius));
        let distal = [TaylorModel::exactly(1.0), TaylorModel::exactly(0.0)];
        let of_base = |axis: PlanarModel| [dot(axis, tangent), dot(axis, perp(tangent))];
        self.bending_in(leg, index, [sum_of(c, to_p), c, distal], |vector| vector, of_base)
    }

    /// Encloses the unit vector along the platform bar, from `C_i` to `P`, in the axes of the distal bar: it is against the arm
    /// `along t − across t⊥`.
    fn platform_bar(&self, leg: &LegEnclosure, index: usize) -> PlanarModel {
        let per_multiple = self.compliance.platform[index].per_multiple;
        [-leg.along.scaled(per_multiple), leg.across.scaled(per_multiple)]
    }

    /// Encloses the compliance of a leg out of the plane at a point, in axes into which vectors in the axes of the distal bar and in those
    /// of the base are turned. Given are `P` relative to that point, `C_i` relative to it in the axes of the distal bar, and the unit
    /// vector along that bar.
    fn bending_in(
        &self,
        leg: &LegEnclosure,
        index: usize,
        [p, c, distal]: [PlanarModel; 3],
        of_distal: impl Fn(PlanarModel) -> PlanarModel,
        of_base: impl Fn(PlanarModel) -> PlanarModel,
    ) -> Symmetric {
        let compliance = &self.compliance;
        let platform = &compliance.platform[index];
        let chain = &leg.chain;
        let of_leg = |length: TaylorModel| compliance.leg.map(|part| length.scaled(part));
        let mut sum = [TaylorModel::exactly(0.0); 6];
        let to_p = of_distal(self.platform_bar(leg, index));
        let radius = TaylorModel::constant(platform.radius);
        add_bar(
            &mut sum,
            platform.vertical.map(TaylorModel::constant),
            (to_p, radius),
            p,
        );
        let beam = (distal, chain.signed_beam);
        add_bar(&mut sum, of_leg(chain.beam), beam, of_distal(c));
        let elbow = || of_distal([c[0] - chain.offset, c[1]]);
        if let Some(bar) = &chain.proximal {
            let way = (of_distal(bar.direction), bar.offset);
            add_bar(&mut sum, of_leg(bar.length), way, elbow());
        }
        if let Some((rail, forms)) = self.rail(leg, index) {
            let axis = self.frames[index].rail.axis().map(TaylorModel::constant);
            add_rail(&mut sum, &forms.scaled(rail.vertical), of_base(axis), elbow());
        }
        sum
    }

    /// Encloses `det S_φφ` and `det S` of a leg out of the plane in axes along the distal bar, with lengths in units of `L_b` (docs/model.md,
    /// section 4.4): at `C_i`, or on a rail that bends where force and moment are almost decoupled.
    fn vertical(&self, leg: &LegEnclosure, index: usize) -> [TaylorModel; 2] {
        if self.compliance.rail.is_none() {
            return self.vertical_of_bars(leg, index);
        }
        // The entry for a displacement without a rotation is the same at every point and in all axes.
        let (_, compliance) = self.decoupled_bending(leg, index);
        let cofactors = cofactors(&compliance);
        [cofactors[0], determinant(&compliance, &cofactors)]
    }

    /// Encloses the determinants of the bars alone, at `C_i`.
    fn vertical_of_bars(&self, leg: &LegEnclosure, index: usize) -> [TaylorModel; 2] {
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

/// Adds the compliance of a bar at `P`: of its bending and its torsional compliance, `L/(EI)` and `L/(GI_x)`, of a unit vector along it
/// with the distance along this vector to its tip, and of the tip relative to `P`.
///
/// The bending moment at the distance `s` from the tip, at `q`, due to a force `F` along z and a moment `m` at `P`, is `m + F q⊥`: its
/// part along the bar is constant, and that along the normal grows by `F` per length.
fn add_bar(
    sum: &mut Symmetric,
    [bend, twist]: [TaylorModel; 2],
    (direction, length): (PlanarModel, TaylorModel),
    tip: PlanarModel,
) {
    let [x, y] = direction;
    let [nx, ny] = perp(direction);
    let lever = perp(tip);
    let along = dot(lever, direction);
    // At the middle of the bar, force and moment are decoupled.
    let middle = dot(lever, [nx, ny]) - length.times(0.5);
    let twelfth = Interval::exactly(1.0) / Interval::exactly(12.0);
    let (by_twist, by_bend) = (twist * along, bend * middle);
    let parts = [
        by_twist * along + by_bend * middle + bend * length.squared().scaled(twelfth),
        by_twist * x + by_bend * nx,
        by_twist * y + by_bend * ny,
        twist * x.squared() + bend * nx.squared(),
        twist * (x * y) + bend * (nx * ny),
        twist * y.squared() + bend * ny.squared(),
    ];
    add(sum, parts);
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
    add(sum, parts);
}

fn add(sum: &mut Symmetric, parts: Symmetric) {
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
